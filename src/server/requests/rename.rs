//! `textDocument/rename`: another name for a symbol, a label, or what a block declares, wherever it stands.

use std::path::Path;

use lsp_types::{RenameParams, RenameRequest};
use rowan::{TextRange, TextSize};
use rustc_hash::FxHashSet;
use smol_str::SmolStr;

use super::{Answer, Fault, Handle};
use crate::db::{self, FilePlace, Program, SourceFile, Unit};
use crate::model::entity::{BlockName, Family};
use crate::model::layout::Elementary;
use crate::model::object::step7;
use crate::model::symbols::key;
use crate::server::cursor::{InUnit, What, key_in_code};
use crate::server::edits::Edits;
use crate::server::names::{self, Declared, Names, place_in};
use crate::server::snapshot::{InFile, Snapshot};
use crate::source::decode::decode;
use crate::source::detect::Detected;
use crate::source::{symlist, walk};
use crate::syntax::{Language, SyntaxKind, pl7};
use crate::target::{Limit, Target};

pub(super) struct Handler;

impl Handle for Handler {
    type Request = RenameRequest;

    fn handle(snapshot: &Snapshot, params: RenameParams) -> Answer<Self::Request> {
        let position = params.text_document_position_params;
        let Some(it) = snapshot.file(&position.text_document.uri) else { return Ok(None) };
        let Some(renamed) = renamed(it, it.offset(position.position)) else {
            return Err(Fault::Refused("only labels and names that the program declares can be renamed".to_owned()));
        };
        let changes = renamed.changes(it, params.new_name.trim()).map_err(Fault::Refused)?;
        let mut edits = Edits::default();
        let mut seen = FxHashSet::default();
        for (place, by) in changes.into_iter().filter(|it| seen.insert(it.0)) {
            edits.replace(snapshot, it.root, place, &by);
        }
        Ok(Some(edits.finish(snapshot)))
    }
}

/// What can be renamed at a place.
pub(super) struct Renamed<'s> {
    /// Of the name, in the file.
    pub(super) range: TextRange,
    pub(super) text: String,
    kind: Kind<'s>,
}

enum Kind<'s> {
    /// Declared by the programs of a family that share it.
    Symbol {
        family: Family,
        programs: Vec<Program<'s>>,
        name: SmolStr,
        declared_in: Vec<SourceFile>,
    },
    /// A parameter, variable or component that a block declares.
    Field {
        unit: Unit<'s>,
        anchor: u32,
        name: SmolStr,
    },
    Label {
        places: Vec<FilePlace>,
        language: Language,
        others: Vec<SmolStr>,
    },
}

/// What is written in place of a name.
type Change = (FilePlace, String);

pub(super) fn renamed(it: InFile<'_>, at: TextSize) -> Option<Renamed<'_>> {
    let cursor = InUnit::at(it, at)?;
    let target = cursor.target();
    if let Some(What::Label { name, part }) = target.as_ref().map(|it| &it.what) {
        let model = cursor.model;
        let is_it = |of: &SmolStr, in_part: u32| of == name && in_part == *part;
        let labels = model.labels.iter().filter(|it| is_it(&it.name, it.part)).map(|it| it.range);
        let jumps = model.jumps.iter().filter(|it| is_it(&it.label, it.part)).map(|it| it.range);
        let place = |range| FilePlace { file: it.file, range: cursor.in_file(range) };
        let mut others: Vec<SmolStr> =
            model.labels.iter().filter(|it| it.part == *part && it.name != *name).map(|it| it.name.clone()).collect();
        // A jump that leads nowhere would lead there.
        others.extend(model.jumps.iter().filter(|it| it.part == *part && it.label != *name).map(|it| it.label.clone()));
        let range = target.as_ref()?.range;
        return Some(Renamed {
            range: cursor.in_file(range),
            text: cursor.text(range).to_owned(),
            kind: Kind::Label {
                places: labels.chain(jumps).map(place).collect(),
                language: cursor.unit.language(it.db),
                others,
            },
        });
    }
    let program = cursor.program()?.0;
    let word = names::word_at(&cursor)?;
    let (range, name) = (word.range, key(cursor.text(word.range)));
    let kind = match word.declared {
        Declared::Symbol(name) => symbol(it, program, name)?,
        Declared::Field(unit, anchor) => {
            // What a function returns has a name of its own.
            let declared = place_in(it.db, unit, db::model(it.db, unit).place(anchor));
            let text = unit.file(it.db).text(it.db).get(std::ops::Range::<usize>::from(declared.range))?;
            (key_in_code(text.trim_start_matches('#')) == name).then_some(Kind::Field { unit, anchor, name })?
        }
    };
    Some(Renamed { range: cursor.in_file(range), text: cursor.text(range).to_owned(), kind })
}

/// A symbol that a program declares, with all programs that see the same declaration.
fn symbol<'s>(it: InFile<'s>, program: Program<'s>, name: SmolStr) -> Option<Kind<'s>> {
    let mut programs = vec![program];
    let mut declared_in = Vec::new();
    for &unit in db::program_units(it.db, program) {
        let is_block = matches!(unit.entity(it.db).name(), Some(BlockName::Symbol(of)) if *of == name);
        if is_block || db::facts(it.db, unit).symbols.iter().any(|it| key(&it.name) == name) {
            declared_in.push(unit.file(it.db));
            programs.extend(db::programs_with(it.db, unit.file(it.db)));
        }
    }
    let family = program.family(it.db);
    let mut seen = FxHashSet::default();
    programs.retain(|it_| it_.family(it.db) == family && seen.insert(*it_));
    (!declared_in.is_empty()).then_some(Kind::Symbol { family, programs, name, declared_in })
}

impl<'s> Renamed<'s> {
    /// All that changes with the name, or why it cannot be the new one.
    fn changes(&self, it: InFile<'s>, new: &str) -> Result<Vec<Change>, String> {
        if let Kind::Symbol { declared_in, .. } = &self.kind {
            declared_in.iter().try_for_each(|&file| is_text(it, file))?;
        }
        let changes: Vec<Change> = match &self.kind {
            Kind::Label { places, language, others } => {
                let new = label(new, *language, others)?;
                places.iter().map(|place| (*place, new.clone())).collect()
            }
            Kind::Symbol { family, programs, name, .. } => {
                let new = unmarked(*family, new);
                let is_other = key(new) != *name;
                if is_other {
                    is_symbol(*family, new)?;
                    is_read(it, name, false)?;
                }
                let mut changes = Vec::new();
                for &program in programs {
                    let names = Names::new(it.db, program);
                    if is_other && names.has_symbol(&key(new)) {
                        return Err(format!("`{new}` is a symbol of the program already"));
                    }
                    changes.extend(of_declaration(it, &names, name, &Declared::Symbol(name.clone()), new)?);
                }
                changes
            }
            Kind::Field { unit, anchor, name } => {
                let family = Family::of(unit.language(it.db)).unwrap_or(Family::Pl7);
                let new = unmarked(family, new);
                let is_other = key(new) != *name;
                if is_other {
                    is_field(family, new)?;
                    is_read(it, name, true)?;
                }
                if names::beside(it.db, *unit, *anchor).iter().any(|it| *it == key(new)) {
                    return Err(format!("`{new}` is declared there already"));
                }
                let mut changes = Vec::new();
                for program in db::programs_with(it.db, unit.file(it.db)) {
                    let names = Names::new(it.db, program);
                    // PL7:5371
                    if family == Family::Pl7 && is_other && names.has_symbol(&key(new)) {
                        return Err(format!("`{new}` is a symbol of the program, which no name of a DFB may be"));
                    }
                    changes.extend(of_declaration(it, &names, name, &Declared::Field(*unit, *anchor), new)?);
                }
                changes
            }
        };
        changes.iter().try_for_each(|change| is_text(it, change.0.file))?;
        Ok(changes)
    }
}

/// All words of a program that a declaration gives their meaning.
fn of_declaration<'s>(
    it: InFile<'s>,
    names: &Names<'s>,
    name: &SmolStr,
    declared: &Declared<'s>,
    new: &str,
) -> Result<Vec<Change>, String> {
    let words = names.all(name, declared).into_iter();
    let change = |(unit, word): (Unit<'s>, names::Word<'s>)| {
        if !word.marked {
            is_bare(it, names, unit, name, new)?;
        }
        in_unit(it, unit, word.range, new)
    };
    words.map(change).collect()
}

/// Whether a file is the text that is shown of it, and no listing of its tables.
fn is_text(it: InFile<'_>, file: SourceFile) -> Result<(), String> {
    let path = file.path(it.db);
    if file.detected(it.db) == Detected::Stx || symlist::is_table(Path::new(path)) {
        return Err(format!("`{path}` has the name, too, and is no text"));
    }
    Ok(())
}

/// Whether no program that is not read has the name: code in SCL names symbols, too. `is_field`: behind a point, or as a
/// parameter that is given something.
fn is_read(it: InFile<'_>, name: &SmolStr, is_field: bool) -> Result<(), String> {
    let is_part = |it: char| it.is_alphanumeric() || it == '_';
    let marks = ['"', '#', ' '];
    let has_it = |path: &&String| {
        let bytes = walk::read(Path::new(path)).unwrap_or_default();
        if bytes.len() > LONGEST_UNREAD || bytes.contains(&0) {
            return false;
        }
        let text = decode(&bytes, None).text.to_lowercase();
        text.match_indices(name.as_str()).any(|(at, _)| {
            let (before, behind) = (&text[..at], &text[at + name.len()..]);
            let given = behind.trim_start_matches(marks);
            let is_named =
                before.trim_end_matches(marks).ends_with('.') || given.starts_with(":=") || given.starts_with("=>");
            !before.ends_with(is_part) && !behind.starts_with(is_part) && (is_named || !is_field)
        })
    };
    match it.root.unread.iter().find(has_it) {
        Some(path) => Err(format!("`{path}` has the name `{name}`, too, and is of a kind that is not read")),
        None => Ok(()),
    }
}

/// Programs that are longer are no text that anybody wrote.
const LONGEST_UNREAD: usize = 1 << 24;

/// A name of a unit by a new one. In a table, what stands behind it in its line stays where it is.
fn in_unit(it: InFile<'_>, unit: Unit<'_>, range: TextRange, new: &str) -> Result<Change, String> {
    let language = unit.language(it.db);
    if !matches!(language, Language::SymbolTable | Language::Step5Symbols) {
        return Ok((place_in(it.db, unit, range), new.to_owned()));
    }
    let text = unit.text(it.db);
    let (old, behind) = text.get(usize::from(range.start())..).unwrap_or_default().split_at(usize::from(range.len()));
    let line = behind.lines().next().unwrap_or_default();
    let blanks = line.len() - line.trim_start_matches(' ').len();
    let no_room = || format!("the table `{}` has no room for `{new}`", unit.file(it.db).path(it.db));
    if line.starts_with(',') && new.contains(',') {
        return Err(no_room());
    }
    if line.is_empty() || line.starts_with(['"', ',', '\t']) {
        return Ok((place_in(it.db, unit, range), new.to_owned()));
    }
    // Two blanks part fields of STEP 5.
    let kept = if language == Language::Step5Symbols && line.len() > blanks { 2.min(blanks) } else { 0 };
    let (had, has) = (old.chars().count(), new.chars().count());
    if has > had + blanks - kept {
        return Err(no_room());
    }
    let taken = TextSize::try_from(has.saturating_sub(had)).unwrap_or_default();
    let range = TextRange::new(range.start(), range.end() + taken);
    Ok((place_in(it.db, unit, range), format!("{new}{}", " ".repeat(had.saturating_sub(has)))))
}

/// Without the marks that code of Siemens sets on a name.
fn unmarked(family: Family, name: &str) -> &str {
    if !matches!(family, Family::Step7 | Family::Step5) {
        return name;
    }
    let quotes = [('"', '"'), ('«', '»')];
    let quoted = quotes.into_iter().find_map(|(open, close)| name.strip_prefix(open)?.strip_suffix(close));
    quoted.unwrap_or(name.trim_start_matches(['#', '-', '='])).trim()
}

fn is_word(name: &str) -> bool {
    name.starts_with(|it: char| it.is_alphabetic() || it == '_')
        && name.chars().all(|it| it.is_alphanumeric() || it == '_')
}

fn fits(new: &str, limit: Option<Limit>, what: &str) -> Result<(), String> {
    match limit.filter(|it| new.chars().count() > it.value as usize) {
        Some(it) => Err(format!("`{new}` is too long: {what} has {} characters at most ({})", it.value, it.source)),
        None => Ok(()),
    }
}

/// Whether a name can be a symbol.
fn is_symbol(family: Family, new: &str) -> Result<(), String> {
    let is_one = match family {
        // PL7:1198-1216
        Family::Pl7 | Family::Pl72 => {
            is_word(new) && !new.starts_with('_') && !new.ends_with('_') && !pl7::is_reserved(new)
        }
        Family::Step5 => {
            let is_part = |it: char| it.is_alphanumeric() || matches!(it, '_' | '-' | '.' | '/');
            new.starts_with(|it: char| it.is_alphabetic() || it == '_') && new.chars().all(is_part)
        }
        Family::Step7 => !new.is_empty() && !new.contains(|it: char| it.is_control() || matches!(it, '"' | '«' | '»')),
    };
    if !is_one {
        return Err(format!("`{new}` is no symbol"));
    }
    fits(new, Target::any(family).symbol_length(), "a symbol")
}

/// Whether a name can be one that a block or a DFB declares.
fn is_field(family: Family, new: &str) -> Result<(), String> {
    let is_one = match family {
        // PL7:5371
        Family::Pl7 | Family::Pl72 => is_word(new) && new.is_ascii() && !new.starts_with('_') && !pl7::is_reserved(new),
        Family::Step7 | Family::Step5 => is_word(new) && !is_reserved(new),
    };
    if !is_one {
        return Err(format!("`{new}` is no name: it is a letter, followed by letters, digits and `_`"));
    }
    fits(new, Target::any(family).field_length(), "a name")
}

/// Whether a word ends a declaration of STEP 7, or starts another.
fn is_reserved(word: &str) -> bool {
    let word = word.to_ascii_uppercase();
    let is_one = ["ARRAY", "BEGIN", "NETWORK", "OF", "STRING", "STRUCT", "TITLE", "VAR"].contains(&word.as_str());
    is_one || word.starts_with("END_") || word.starts_with("VAR_") || Elementary::parse(&word).is_some()
}

/// Whether a name in place of another means what it should in code of a unit that sets no marks on it.
fn is_bare(it: InFile<'_>, names: &Names<'_>, unit: Unit<'_>, old: &SmolStr, new: &str) -> Result<(), String> {
    let code = format!("L {new}");
    let parse = crate::syntax::parse(unit.language(it.db), &code);
    let operand = parse.syntax().descendants().find(|it| it.kind() == SyntaxKind::Operand);
    let is_one = operand.is_some_and(|it| it.tokens().all(|it| it.kind() == SyntaxKind::Ident && it.text() == new));
    let is_known = || step7::parse_either(new).is_ok() || key(new) != *old && names.knows(unit, &key(new));
    if !is_one || is_known() {
        return Err(format!("`{new}` would mean something else where code names it without marks"));
    }
    Ok(())
}

/// The label as the language writes it.
fn label(new: &str, language: Language, others: &[SmolStr]) -> Result<String, String> {
    let is_taken = |name: &str| others.iter().any(|it| it.eq_ignore_ascii_case(name));
    let family = Family::of(language).unwrap_or(Family::Pl7);
    if language.is_statement_list() {
        let limit = Target::any(family).label_length();
        let is_word = |it: char| it.is_ascii_alphanumeric() || it == '_';
        if !new.starts_with(|it: char| it.is_ascii_alphabetic() || it == '_') || !new.chars().all(is_word) {
            return Err(format!("`{new}` is no label: it is a letter, followed by letters and digits"));
        }
        if let Some(limit) = limit.filter(|it| new.len() > it.value as usize) {
            return Err(format!(
                "`{new}` is too long: a label has {} characters at most ({})",
                limit.value, limit.source
            ));
        }
        if is_taken(new) {
            return Err(format!("`{new}` is a label of the block already"));
        }
        return Ok(new.to_owned());
    }
    let prefix = if language.is_pl7_2() { "L" } else { "%L" };
    let digits = new.trim_start_matches('%').trim_start_matches(['L', 'l']);
    let range = Target::any(family).label_numbers();
    let number = digits.parse::<u32>().ok().filter(|it| range.is_none_or(|range| range.contains(*it)));
    let Some(number) = number else {
        let known = range.map_or_else(String::new, |it| format!(" from {} to {} ({})", it.first, it.last, it.source));
        return Err(format!("`{new}` is no label: it is `{prefix}` and a number{known}"));
    };
    if is_taken(&number.to_string()) {
        return Err(format!("`{prefix}{number}` is a label already"));
    }
    Ok(format!("{prefix}{number}"))
}
