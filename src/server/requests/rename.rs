//! `textDocument/rename`: another name for a symbol or a label, wherever it stands.

use lsp_types::{RenameParams, RenameRequest};
use rowan::{TextRange, TextSize};
use smol_str::SmolStr;

use super::{Answer, Fault, Handle};
use crate::db::{self, FilePlace, Program, Unit};
use crate::model::entity::Family;
use crate::model::object::Class;
use crate::model::symbols::key;
use crate::server::cursor::{InUnit, What};
use crate::server::edits::Edits;
use crate::server::snapshot::{InFile, Snapshot};
use crate::source::detect::Detected;
use crate::syntax::{Language, SyntaxKind};
use crate::target::{Target, pl7};

pub(super) struct Handler;

impl Handle for Handler {
    type Request = RenameRequest;

    fn handle(snapshot: &Snapshot, params: RenameParams) -> Answer<Self::Request> {
        let position = params.text_document_position_params;
        let Some(it) = snapshot.file(&position.text_document.uri) else { return Ok(None) };
        let Some(renamed) = renamed(it, it.offset(position.position)) else {
            return Err(Fault::Refused("only symbols and labels can be renamed".to_owned()));
        };
        let new_name = params.new_name.trim();
        let mut edits = Edits::default();
        match &renamed.kind {
            Kind::Symbol { program, name } => {
                is_free_symbol(it, *program, name, new_name).map_err(Fault::Refused)?;
                for place in symbol_places(it, *program, name) {
                    edits.replace(snapshot, it.root, place, new_name);
                }
            }
            Kind::Label { places, language, others } => {
                let new = label(new_name, *language, others).map_err(Fault::Refused)?;
                places.iter().for_each(|&place| edits.replace(snapshot, it.root, place, &new));
            }
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
    /// Declared by the program.
    Symbol {
        program: Program<'s>,
        name: SmolStr,
    },
    Label {
        places: Vec<FilePlace>,
        language: Language,
        others: Vec<SmolStr>,
    },
}

pub(super) fn renamed(it: InFile<'_>, at: TextSize) -> Option<Renamed<'_>> {
    // The text of a project is made of tables.
    if it.file.detected(it.db) == Detected::Stx {
        return None;
    }
    let cursor = InUnit::at(it, at)?;
    let target = cursor.target()?;
    if let What::Label { name, part } = &target.what {
        let model = cursor.model;
        let is_it = |of: &SmolStr, in_part: u32| of == name && in_part == *part;
        let labels = model.labels.iter().filter(|it| is_it(&it.name, it.part)).map(|it| it.range);
        let jumps = model.jumps.iter().filter(|it| is_it(&it.label, it.part)).map(|it| it.range);
        let place = |range| FilePlace { file: it.file, range: cursor.in_file(range) };
        let mut others: Vec<SmolStr> =
            model.labels.iter().filter(|it| it.part == *part && it.name != *name).map(|it| it.name.clone()).collect();
        // A jump that leads nowhere would lead there.
        others.extend(model.jumps.iter().filter(|it| it.part == *part && it.label != *name).map(|it| it.label.clone()));
        return Some(Renamed {
            range: cursor.in_file(target.range),
            text: cursor.text(target.range).to_owned(),
            kind: Kind::Label {
                places: labels.chain(jumps).map(place).collect(),
                language: cursor.unit.language(it.db),
                others,
            },
        });
    }
    let is_symbol = match &target.what {
        What::Symbol(_) => true,
        What::Object(object) => cursor.model.objects.get(*object as usize)?.class == Class::Symbol,
        What::Call(call) => {
            matches!(cursor.model.calls.get(*call as usize)?.callee, crate::model::unit::Callee::Instance(_))
        }
        _ => false,
    };
    let (program, _) = cursor.program()?;
    let token = cursor.token().filter(|it| is_symbol && it.kind() == SyntaxKind::Ident)?;
    let name = key(token.text());
    let is_declared = declaring(it, program).any(|facts| facts.symbols.iter().any(|it| key(&it.name) == name));
    (program.family(it.db) == Family::Pl7 && is_declared).then(|| Renamed {
        range: cursor.in_file(token.text_range()),
        text: token.text().to_owned(),
        kind: Kind::Symbol { program, name },
    })
}

fn declaring<'s>(it: InFile<'s>, program: Program<'s>) -> impl Iterator<Item = &'s crate::analysis::facts::UnitFacts> {
    db::program_units(it.db, program).iter().map(move |&unit| &**db::facts(it.db, unit))
}

/// Whether names of a unit are those of its program: a DFB sees its own alone (PL7:5350-5450).
fn sees_symbols(it: InFile<'_>, unit: Unit<'_>) -> bool {
    !matches!(unit.entity(it.db), crate::model::entity::Entity::Dfb { .. })
}

/// Every place of a symbol: its declarations, and the words of code that name it.
fn symbol_places(it: InFile<'_>, program: Program<'_>, name: &SmolStr) -> Vec<FilePlace> {
    let mut found = Vec::new();
    for &unit in db::program_units(it.db, program).iter().filter(|&&unit| sees_symbols(it, unit)) {
        let model = db::model(it.db, unit);
        let symbols = model.symbols.iter().map(|it| model.place(it.anchor));
        let objects = model.accesses.iter().filter(|it| model.object(it.object).class == Class::Symbol);
        let calls = model.calls.iter().filter(|it| matches!(it.callee, crate::model::unit::Callee::Instance(_)));
        let mut ranges: Vec<TextRange> = symbols
            .chain(objects.map(|it| model.place(it.anchor)))
            .chain(calls.map(|it| model.place(it.anchor)))
            .collect();
        ranges.sort_unstable_by_key(|it| (it.start(), it.end()));
        if ranges.is_empty() {
            continue;
        }
        let file = unit.file(it.db);
        let offset = db::layout(it.db, file).iter().find(|it| it.0 == unit).map_or(0, |it| it.1);
        let tree = db::tree(it.db, unit);
        let words = tree.syntax().descendant_tokens().filter(|it| it.kind() == SyntaxKind::Ident);
        let words = words.filter(|it| key(it.text()) == *name).map(|it| it.text_range());
        // Ranges may hold one another: of those that start before the word, the longest decides.
        let mut reach = TextSize::new(0);
        let mut next = ranges.iter().peekable();
        for word in words {
            while let Some(range) = next.next_if(|it| it.start() <= word.start()) {
                reach = reach.max(range.end());
            }
            if word.end() <= reach {
                found.push(FilePlace { file, range: word + TextSize::new(offset) });
            }
        }
    }
    found
}

fn is_free_symbol(it: InFile<'_>, program: Program<'_>, old: &SmolStr, new: &str) -> Result<(), String> {
    let limit = pl7::SYMBOL_LENGTH;
    let is_word = |it: char| it.is_alphanumeric() || it == '_';
    if !new.starts_with(char::is_alphabetic) || !new.chars().all(is_word) {
        return Err(format!("`{new}` is no symbol: it is a letter, followed by letters, digits and `_`"));
    }
    if new.chars().count() > limit.value as usize {
        return Err(format!("`{new}` is too long: a symbol has {} characters at most ({})", limit.value, limit.source));
    }
    let is_taken = declaring(it, program).any(|facts| {
        let used = facts.objects.iter().filter(|it| it.object.class == Class::Symbol).map(|it| it.object.text.as_str());
        let used = used.map(|it| it.split(['.', ':', '[']).next().unwrap_or(it));
        facts.symbols.iter().map(|it| it.name.as_str()).chain(used).any(|it| key(it) == key(new))
    });
    if is_taken && key(new) != *old {
        return Err(format!("`{new}` is a symbol of the program already"));
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
