//! `textDocument/completion`: words that may stand at a position.

use std::sync::Arc;

use lsp_types::{
    CompletionItem, CompletionItemKind, CompletionItemTextEdit, CompletionList, CompletionParams, CompletionRequest,
    CompletionResponse, TextEdit,
};
use rowan::{TextRange, TextSize};
use rustc_hash::FxHashSet;

use super::{Answer, Handle};
use crate::analysis::program::ProgramIndex;
use crate::analysis::symbols::SymbolTable;
use crate::db;
use crate::model::dfb::Role;
use crate::model::entity::{BlockKind, BlockName, Entity, Family};
use crate::model::layout::Field;
use crate::model::object::{Class, step7};
use crate::model::symbols::key;
use crate::model::unit::{Section, StatementKind};
use crate::server::cursor::{self, InProgram, InUnit};
use crate::server::describe;
use crate::server::snapshot::Snapshot;
use crate::syntax::awl::instruction as awl;
use crate::syntax::pl7::{functions, instructions};
use crate::syntax::step5::instruction as step5;
use crate::syntax::{Language, SyntaxKind};

pub(super) struct Handler;

/// Words of structured text that are no functions.
const KEYWORDS: [&str; 22] = [
    "IF",
    "THEN",
    "ELSIF",
    "ELSE",
    "END_IF",
    "WHILE",
    "DO",
    "END_WHILE",
    "REPEAT",
    "UNTIL",
    "END_REPEAT",
    "FOR",
    "TO",
    "END_FOR",
    "EXIT",
    "JUMP",
    "RETURN",
    "HALT",
    "REM",
    "NOT",
    "TRUE",
    "FALSE",
];

impl Handle for Handler {
    type Request = CompletionRequest;

    fn handle(snapshot: &Snapshot, params: CompletionParams) -> Answer<Self::Request> {
        let position = params.text_document_position_params;
        let Some(it) = snapshot.file(&position.text_document.uri) else { return Ok(None) };
        let Some(cursor) = InUnit::at(it, it.offset(position.position)) else { return Ok(None) };
        let language = cursor.unit.language(it.db);
        if matches!(language, Language::SymbolTable | Language::Step5Symbols) {
            return Ok(None);
        }
        let is_comment =
            |kind| matches!(kind, SyntaxKind::Comment | SyntaxKind::UnclosedComment | SyntaxKind::CharString);
        if cursor.token().is_some_and(|it| is_comment(it.kind()) && it.text_range().start() < cursor.at) {
            return Ok(None);
        }
        let before = cursor.text(TextRange::up_to(cursor.at));
        let typed = if language.is_statement_list() {
            Typed::in_list(before, language)
        } else {
            Typed::in_words(before, language)
        };
        let mut found = Found { items: Vec::new(), seen: FxHashSet::default(), of_owner: false };
        if let Some((program, _)) = cursor.program() {
            let program = InProgram::new(it, program);
            let index = program.index();
            let own = cursor.model.fields();
            let table = db::symbol_table(it.db, program.program);
            let is_member = typed.owner.is_some_and(|owner| found.members(owner, own, table, &index));
            if !is_member {
                found.parameters(&cursor, &index);
                if typed.is_operand {
                    found.of_unit(&cursor, &typed);
                    found.of_program(&cursor, &typed, &program, &index);
                }
            }
        }
        if typed.owner.is_none() && typed.is_word {
            found.words(language);
        }
        let start = if found.of_owner { typed.behind_owner } else { typed.start };
        let start = TextSize::try_from(start).unwrap_or(cursor.at).min(cursor.at);
        let range = it.range(cursor.in_file(TextRange::new(start, cursor.at)));
        let items = found.items.into_iter().map(|item| {
            let new_text = item.insert_text.clone().unwrap_or_else(|| item.label.clone());
            CompletionItem {
                text_edit: Some(CompletionItemTextEdit::TextEdit(TextEdit { range, new_text })),
                insert_text: None,
                ..item
            }
        });
        let items = items.collect();
        Ok(Some(CompletionResponse::CompletionList(CompletionList { items, ..Default::default() })))
    }
}

/// What is typed already. Offsets are in the text before the cursor.
#[derive(Debug, Default, PartialEq, Eq)]
struct Typed<'s> {
    /// Where what an item takes the place of begins.
    start: usize,
    /// The name before a dot.
    owner: Option<&'s str>,
    /// Where its member begins.
    behind_owner: usize,
    /// Whether an instruction or a word of the language may stand here.
    is_word: bool,
    is_operand: bool,
    is_local: bool,
    /// What stands between the letters and the number of an operand; one blank where it is not typed yet.
    gap: &'s str,
}

impl<'s> Typed<'s> {
    /// In a language of words and operands without blanks in them.
    fn in_words(before: &'s str, language: Language) -> Self {
        let is_part = |it: char| it.is_alphanumeric() || matches!(it, '_' | '%' | '#' | '"' | '.' | ':' | '\\');
        let mut start = before.trim_end_matches(is_part).len();
        if language.is_pl7_2() {
            start = behind_commas(before, start);
        }
        // An assignment, or the end of a label, begins another word.
        if let Some((head, rest)) = before.get(start..).and_then(|it| it.rsplit_once(':'))
            && !rest.starts_with(|it: char| it == 'X' || it.is_ascii_digit())
        {
            start += head.len() + 1;
        }
        let text = before.get(start..).unwrap_or_default();
        let mut typed = Self { start, is_operand: true, gap: " ", ..Self::default() };
        if !text.starts_with(['%', '#', '"'])
            && let Some((name, _)) = text.rsplit_once('.')
            && name.starts_with(char::is_alphabetic)
        {
            (typed.owner, typed.behind_owner) = (Some(name), start + name.len() + 1);
        }
        typed.is_word = !text.starts_with(['%', '#', '"']);
        typed
    }

    /// In a statement list: an instruction, and behind it an operand, which may have blanks in it.
    fn in_list(before: &'s str, language: Language) -> Self {
        let line = before.rfind('\n').map_or(0, |it| it + 1);
        // What begins at `start` is an instruction until a blank follows it; nothing of it is there while it `is_blank`.
        let (mut start, mut behind_instruction, mut is_blank) = (line, false, true);
        let (mut is_quoted, mut is_declaration) = (false, false);
        // STEP 5 has a colon before each instruction, which may follow a label and blanks.
        let mut wants_colon = matches!(language, Language::Step5(_));
        for (at, char) in before.get(line..).unwrap_or_default().char_indices().map(|(at, char)| (line + at, char)) {
            let behind = at + char.len_utf8();
            match char {
                '"' => is_quoted = !is_quoted,
                '«' => is_quoted = true,
                '»' => is_quoted = false,
                _ => {}
            }
            let begins = match char {
                _ if is_quoted => false,
                ';' => {
                    (behind_instruction, is_declaration) = (false, false);
                    true
                }
                ':' if wants_colon || !behind_instruction => {
                    (wants_colon, behind_instruction) = (false, false);
                    true
                }
                ':' => {
                    is_declaration = true;
                    false
                }
                '=' if before.get(..at).is_some_and(|it| it.ends_with(':')) => {
                    (behind_instruction, is_declaration) = (true, false);
                    true
                }
                '(' | ',' | '[' => behind_instruction,
                it if it.is_whitespace() => {
                    let begins = is_blank || !behind_instruction;
                    behind_instruction |= !is_blank;
                    if !begins {
                        continue;
                    }
                    true
                }
                _ => false,
            };
            is_blank = begins;
            if begins {
                start = behind;
            }
        }
        let text = before.get(start..).unwrap_or_default();
        let is_local = text.starts_with('#');
        let mut typed = Self {
            start,
            is_local,
            is_word: !behind_instruction,
            is_operand: behind_instruction && !is_declaration,
            gap: " ",
            ..Self::default()
        };
        let letters = text.trim_start_matches(|it: char| it.is_ascii_alphabetic());
        let number = letters.trim_start();
        if letters.len() < text.len() && number.starts_with(|it: char| it.is_ascii_digit()) && !text.contains('"') {
            typed.gap = letters.get(..letters.len() - number.len()).unwrap_or_default();
        }
        let dot = text.rfind('.').filter(|&it| text.get(..it).is_some_and(has_members));
        if let Some(dot) = dot {
            (typed.owner, typed.behind_owner) = (text.get(..dot), start + dot + 1);
        }
        typed
    }
}

/// Whether a name before a dot may be that of a whole with parts: `#motor`, `"Data"`, `DB 10`. `M 10` has bits.
fn has_members(name: &str) -> bool {
    name.starts_with(['#', '«'])
        || (name.starts_with('"') && name.matches('"').count().is_multiple_of(2))
        || name.get(..2).is_some_and(|it| it.eq_ignore_ascii_case("DB"))
            && name.get(2..).is_some_and(|it| it.starts_with(|it: char| it == ' ' || it.is_ascii_digit()))
}

/// Where an operand of PL7-2 begins, of which the part behind its last comma begins at `start`: `I0,05`, `T0,P`.
fn behind_commas(before: &str, mut start: usize) -> usize {
    while let Some(head) = before.get(..start).and_then(|it| it.strip_suffix(',')) {
        let object = head.get(head.trim_end_matches(|it: char| it.is_ascii_alphanumeric()).len()..).unwrap_or_default();
        let number = object.trim_start_matches(|it: char| it.is_ascii_alphabetic());
        let is_object =
            !number.is_empty() && number.len() < object.len() && number.bytes().all(|it| it.is_ascii_digit());
        if !is_object {
            break;
        }
        start = head.len() - object.len();
    }
    start
}

/// An address of Siemens as listings have it, with something between its letters and its number: `M 1.3`, `DB10.DBW 2`.
fn spaced(address: &str, gap: &str) -> String {
    let number = address.trim_end_matches(|it: char| it.is_ascii_digit() || it == '.').len();
    match address.split_at_checked(number) {
        Some((letters, number)) if !number.is_empty() && letters.ends_with(|it: char| it.is_ascii_alphabetic()) => {
            format!("{letters}{gap}{number}")
        }
        _ => address.to_owned(),
    }
}

struct Found {
    items: Vec<CompletionItem>,
    seen: FxHashSet<String>,
    /// They stand behind the dot.
    of_owner: bool,
}

impl Found {
    fn add(&mut self, label: &str, kind: CompletionItemKind, detail: Option<String>) {
        self.add_as(label, None, kind, detail);
    }

    fn add_as(&mut self, label: &str, insert: Option<String>, kind: CompletionItemKind, detail: Option<String>) {
        if self.seen.insert(label.to_owned()) {
            let label = label.to_owned();
            self.items.push(CompletionItem {
                label,
                kind: Some(kind),
                detail,
                insert_text: insert,
                ..Default::default()
            });
        }
    }

    /// What a name has behind a dot, in a block that declares `own`. `false` when it has nothing that is known.
    fn members(&mut self, owner: &str, own: &[Field], table: &SymbolTable, index: &ProgramIndex<'_>) -> bool {
        if index.family == Family::Step7 {
            self.fields(owner, own, table, index);
        } else {
            let instances = index.units.iter().flat_map(|it| &it.symbols).filter(|it| it.object.is_none());
            let instance = instances.into_iter().find(|it| key(&it.name) == key(owner));
            let dfb = instance.and_then(|it| index.units.get(cursor::dfb(&it.ty, index)? as usize));
            let items = dfb.into_iter().flat_map(|it| &it.interface).flat_map(|it| &it.items);
            for item in items.filter(|it| it.role != Role::Private) {
                let detail = format!("{} : {}", item.role.describe(), item.ty.describe());
                self.add(&item.name, CompletionItemKind::Field, Some(detail));
            }
        }
        self.of_owner = !self.items.is_empty();
        self.of_owner
    }

    /// The fields of a data block, or of a variable that is a structure.
    fn fields(&mut self, owner: &str, own: &[Field], table: &SymbolTable, index: &ProgramIndex<'_>) {
        let layouts = index.layouts();
        let (layout, path) = if let Some(path) = owner.strip_prefix('#') {
            (Some(Arc::new(layouts.of_names(own))), path.to_owned())
        } else {
            // A field of the block, whatever it is called, leads to the block.
            let compact: String = if owner.starts_with(['"', '«']) {
                owner.to_owned()
            } else {
                owner.chars().filter(|it| !it.is_whitespace()).collect()
            };
            let object = step7::parse_either(&format!("{compact}.field"));
            let Some((block, path)) = object.ok().and_then(|it| step7::field(&it)) else { return };
            let path = path.strip_suffix("field").unwrap_or_default().trim_end_matches('.').to_owned();
            (layouts.of(&table.block(&block).unwrap_or(block)).cloned(), path)
        };
        let Some(layout) = layout.as_ref().and_then(|it| it.inside(&path)) else { return };
        for field in &layout.fields {
            self.add(&field.name, CompletionItemKind::Field, Some(field.shape.to_string()));
        }
    }

    /// Parameters of the call that the place stands in.
    fn parameters(&mut self, cursor: &InUnit<'_>, index: &ProgramIndex<'_>) {
        let model = cursor.model;
        let is_around = |it: &&crate::model::unit::Call| {
            let statement = model.statements.get(it.statement as usize);
            model.place(it.anchor).end() < cursor.at
                && statement.is_some_and(|it| it.range.contains_inclusive(cursor.at))
        };
        let Some(call) = model.calls.iter().find(is_around) else { return };
        let same = index.calls.iter().find(|it| it.it.callee == call.callee && it.target.is_some());
        let Some(unit) = same.and_then(|it| index.units.get(it.target? as usize)) else { return };
        if !matches!(unit.language, Language::Awl(_)) {
            return;
        }
        for it in unit.declared.iter().flat_map(|it| it.fields()) {
            let role = match it.section {
                Section::Input => "input",
                Section::Output => "output",
                Section::InOut => "in/out",
                Section::Static | Section::Temp => continue,
            };
            let is_given =
                |name: &str| call.arguments.iter().any(|it| it.name.as_ref().is_some_and(|it| key(it) == key(name)));
            if !is_given(&it.name) {
                let detail = Some(format!("{role} : {}", it.ty));
                self.add_as(&it.name, Some(format!("{} := ", it.name)), CompletionItemKind::Field, detail);
            }
        }
    }

    /// Labels and names of the unit.
    fn of_unit(&mut self, cursor: &InUnit<'_>, typed: &Typed<'_>) {
        let model = cursor.model;
        for it in &model.labels {
            self.add(&it.text, CompletionItemKind::Reference, Some("label".to_owned()));
        }
        for it in model.fields() {
            let text = cursor.text(model.place(it.anchor));
            let label = if typed.is_local { format!("#{text}") } else { text.to_owned() };
            self.add(&label, CompletionItemKind::Field, Some(it.ty.to_string()));
        }
        for it in model.interface.iter().flat_map(|it| &it.items) {
            self.add(&it.name, CompletionItemKind::Field, Some(it.role.describe().to_owned()));
        }
        // What is jumped to may be written before it is there.
        let jumps = model.statements.iter().filter(|it| matches!(it.kind, StatementKind::Jump(_))).count();
        if jumps > 0 {
            for it in &model.jumps {
                self.add(&it.text, CompletionItemKind::Reference, Some("label".to_owned()));
            }
        }
    }

    /// Objects, symbols and blocks of the program.
    fn of_program(
        &mut self,
        cursor: &InUnit<'_>,
        typed: &Typed<'_>,
        program: &InProgram<'_>,
        index: &ProgramIndex<'_>,
    ) {
        if typed.is_local {
            return;
        }
        let table = db::symbol_table(cursor.it.db, program.program);
        let in_code = |address: &str| match index.family.has_blocks() {
            true => spaced(address, typed.gap),
            false => address.to_owned(),
        };
        let sees_symbols = !matches!(cursor.unit.entity(cursor.it.db), Entity::Dfb { .. });
        for it in index.units.iter().flat_map(|it| &it.symbols).filter(|_| sees_symbols) {
            let detail = it.object.as_ref().map_or(it.ty.to_string(), |it| in_code(&it.text));
            let name = match index.family {
                Family::Step7 => format!("\"{}\"", it.name),
                Family::Step5 => format!("-{}", it.name),
                Family::Pl7 | Family::Pl72 => it.name.to_string(),
            };
            self.add(&name, CompletionItemKind::Variable, Some(detail));
        }
        for it in &index.objects {
            let is_address =
                !matches!(it.object.class, Class::Symbol | Class::CodeBlock | Class::Indirect) && it.object.is_fixed();
            if is_address {
                // An object goes by the first name that the program uses for it, which may be its symbol.
                let address = table.address(&it.object.text);
                let label = in_code(address.as_ref().unwrap_or(&it.object.text));
                self.add(&label, CompletionItemKind::Variable, Some(describe::kind(it.object)));
            }
        }
        for it in &index.units {
            match &it.entity {
                Entity::Block { name: name @ BlockName::Number(kind, _), .. } if *kind != BlockKind::Ob => {
                    self.add(&in_code(&name.to_string()), CompletionItemKind::Function, None);
                }
                entity if typed.is_word => {
                    if let Some(number) = entity.subroutine() {
                        self.add(&format!("SR{number}"), CompletionItemKind::Function, Some(entity.to_string()));
                    }
                }
                _ => {}
            }
        }
    }

    /// Instructions, functions and words of the language.
    fn words(&mut self, language: Language) {
        let keyword = CompletionItemKind::Keyword;
        match language {
            Language::Awl(mnemonics) => {
                for word in awl::all(mnemonics) {
                    self.add(word, keyword, describe::instruction(word, language));
                }
            }
            Language::Step5(mnemonics) => {
                for word in step5::all(mnemonics) {
                    self.add(word, keyword, describe::instruction(word, language));
                }
            }
            Language::Pl7Il => {
                for it in instructions::all() {
                    self.add(it.mnemonic, keyword, describe::instruction(it.mnemonic, language));
                }
            }
            Language::Pl7St | Language::Pl7Gr7 | Language::Sfc => {
                KEYWORDS.iter().for_each(|it| self.add(it, keyword, None));
            }
            Language::Pl7Ld | Language::Pl72Ld | Language::Pl72Gr7 | Language::Pl72Sfc => {}
            Language::Exchange | Language::SymbolTable | Language::Step5Symbols | Language::Pl7Xref => return,
        }
        if matches!(language, Language::Pl7Il | Language::Pl7St | Language::Pl7Ld | Language::Pl7Gr7 | Language::Sfc) {
            for it in functions::all() {
                self.add(it.name, CompletionItemKind::Function, describe::instruction(it.name, Language::Pl7St));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::syntax::Mnemonics;

    /// What an item takes the place of, the name before the dot, and whether an instruction or an operand is wanted.
    fn shown<'s>(typed: &Typed<'s>, before: &'s str) -> (&'s str, &'s str, &'static str) {
        let what = match (typed.is_word, typed.is_operand) {
            (true, false) => "instruction",
            (false, true) => "operand",
            (true, true) => "either",
            (false, false) => "nothing",
        };
        (&before[typed.start..], typed.owner.unwrap_or_default(), what)
    }

    #[test]
    fn an_operand_of_a_statement_list_has_blanks_in_it() {
        let german = Language::Awl(Mnemonics::German);
        let check = |before, text, owner, what| {
            assert_eq!(shown(&Typed::in_list(before, german), before), (text, owner, what), "{before:?}");
        };
        check("      U", "U", "", "instruction");
        check("      >=", ">=", "", "instruction");
        check("m001: SP", "SP", "", "instruction");
        check("      U     M 20.", "M 20.", "", "operand");
        check("      U M 0.0; =   A", "A", "", "operand");
        check("      =     \"Tapis 1", "\"Tapis 1", "", "operand");
        check("      L     \"Data\".ca", "\"Data\".ca", "\"Data\"", "operand");
        check("      L     DB 20.DBW", "DB 20.DBW", "DB 20", "operand");
        check("      L     #etat.", "#etat.", "#etat", "operand");
        check("      CALL  FB 1, DB", "DB", "", "operand");
        check("           Go := E 0.0, Count := M", "M", "", "operand");
        check("           Go", "Go", "", "instruction");
        check("  Go : BO", ": BO", "", "nothing");
        let step5 = Language::Step5(Mnemonics::German);
        let check = |before, text, what| {
            assert_eq!(shown(&Typed::in_list(before, step5), before), (text, "", what), "{before:?}");
        };
        check("     :U", "U", "instruction");
        check("M001 :U   E 0", "E 0", "operand");
        check("     :=   -KLAXO", "-KLAXO", "operand");
        assert_eq!(Typed::in_list("      U     M     2", german).gap, "     ");
        assert_eq!(Typed::in_list("      U     M2", german).gap, "");
        assert_eq!(Typed::in_list("      U     M", german).gap, " ");
    }

    #[test]
    fn a_comma_is_part_of_what_pl7_2_names() {
        let check = |before, text| assert_eq!(shown(&Typed::in_words(before, Language::Pl72Ld), before).0, text);
        check("OPEN_CONTACT(I0,0", "I0,0");
        check("OPEN_CONTACT(I0,", "I0,");
        check("OPEN_CONTACT(SY01),H_L", "H_L");
        check("BLOCK,EMPTY", "EMPTY");
        check("COMPARE [X1,V > T0,", "T0,");
    }

    #[test]
    fn addresses_are_written_as_in_listings() {
        assert_eq!(spaced("M20.0", " "), "M 20.0");
        assert_eq!(spaced("DB20.DBW14", "   "), "DB20.DBW   14");
        assert_eq!(spaced("\"Data\".speed", " "), "\"Data\".speed");
        assert_eq!(spaced("#x1.y", " "), "#x1.y");
    }
}
