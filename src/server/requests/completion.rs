//! `textDocument/completion`: words that may stand at a position.

use lsp_types::{
    CompletionItem, CompletionItemKind, CompletionItemTextEdit, CompletionList, CompletionParams, CompletionRequest,
    CompletionResponse, TextEdit,
};
use rowan::{TextRange, TextSize};
use rustc_hash::FxHashSet;

use super::{Answer, Handle};
use crate::analysis::program::ProgramIndex;
use crate::db;
use crate::model::dfb::Role;
use crate::model::entity::{BlockName, Entity};
use crate::model::object::Class;
use crate::model::symbols::key;
use crate::model::unit::{Section, StatementKind};
use crate::server::cursor::{InProgram, InUnit};
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
        let is_comment =
            |kind| matches!(kind, SyntaxKind::Comment | SyntaxKind::UnclosedComment | SyntaxKind::CharString);
        if cursor.token().is_some_and(|it| is_comment(it.kind()) && it.text_range().start() < cursor.at) {
            return Ok(None);
        }
        let typed = Typed::at(&cursor);
        let mut found = Found { items: Vec::new(), seen: FxHashSet::default() };
        if let Some((program, _)) = cursor.program() {
            let program = InProgram::new(it, program);
            let index = program.index();
            let is_member = typed.owner.is_some_and(|owner| found.members(owner, &index));
            if !is_member {
                found.parameters(&cursor, &index);
                found.of_unit(&cursor, &typed);
                found.of_program(&cursor, &typed, &index);
            }
        }
        if typed.owner.is_none() && typed.is_word {
            found.words(cursor.unit.language(it.db));
        }
        let range = it.range(cursor.in_file(typed.range));
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

/// What is typed already.
struct Typed<'s> {
    /// What an item takes the place of.
    range: TextRange,
    /// The name before a dot.
    owner: Option<&'s str>,
    /// Whether a word may stand here, not only an operand.
    is_word: bool,
    is_local: bool,
}

impl<'s> Typed<'s> {
    fn at(cursor: &InUnit<'s>) -> Self {
        let before = cursor.text(TextRange::up_to(cursor.at));
        let is_part = |it: char| it.is_alphanumeric() || matches!(it, '_' | '%' | '#' | '"' | '.' | ':' | '\\');
        let mut text = before.trim_end_matches(is_part);
        text = before.get(text.len()..).unwrap_or_default();
        // An assignment, or the end of a label, begins another word.
        if let Some((_, rest)) =
            text.rsplit_once(':').filter(|it| !it.1.starts_with(|it: char| it == 'X' || it.is_ascii_digit()))
        {
            text = rest;
        }
        let mut owner = None;
        if !text.starts_with(['%', '#', '"'])
            && let Some((name, rest)) = text.rsplit_once('.')
            && name.starts_with(char::is_alphabetic)
        {
            (owner, text) = (Some(name), rest);
        }
        let start = cursor.at.checked_sub(TextSize::of(text)).unwrap_or(cursor.at);
        let is_word = !text.starts_with(['%', '#', '"']);
        Self { range: TextRange::new(start, cursor.at), owner, is_word, is_local: text.starts_with('#') }
    }
}

struct Found {
    items: Vec<CompletionItem>,
    seen: FxHashSet<String>,
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

    /// What a block has behind a dot. `false` when the name is no instance.
    fn members(&mut self, owner: &str, index: &ProgramIndex<'_>) -> bool {
        let symbols = index.units.iter().flat_map(|it| &it.symbols);
        let Some(instance) = symbols.filter(|it| it.object.is_none()).find(|it| key(&it.name) == key(owner)) else {
            return false;
        };
        let ty = key(&instance.ty);
        let dfbs = index.units.iter().filter(|it| matches!(&it.entity, Entity::Dfb { name } if key(name) == ty));
        for item in dfbs.flat_map(|it| &it.interface).flat_map(|it| &it.items).filter(|it| it.role != Role::Private) {
            self.add(&item.name, CompletionItemKind::Field, Some(item.role.describe().to_owned()));
        }
        true
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
    fn of_program(&mut self, cursor: &InUnit<'_>, typed: &Typed<'_>, index: &ProgramIndex<'_>) {
        let table = cursor.program().map(|it| db::symbol_table(cursor.it.db, it.0));
        if typed.is_local {
            return;
        }
        let sees_symbols = !matches!(cursor.unit.entity(cursor.it.db), Entity::Dfb { .. });
        for it in index.units.iter().flat_map(|it| &it.symbols).filter(|_| sees_symbols) {
            let detail = it.object.as_ref().map_or(it.ty.to_string(), |it| it.text.to_string());
            self.add(&it.name, CompletionItemKind::Variable, Some(detail));
        }
        for it in &index.objects {
            let is_address =
                !matches!(it.object.class, Class::Symbol | Class::CodeBlock | Class::Indirect) && it.object.is_fixed();
            if is_address {
                // An object goes by the first name that the program uses for it, which may be its symbol.
                let address = table.and_then(|table| table.address(&it.object.text));
                let label = address.as_ref().unwrap_or(&it.object.text);
                self.add(label, CompletionItemKind::Variable, Some(describe::kind(it.object)));
            }
        }
        for it in &index.units {
            match &it.entity {
                Entity::Block { name: BlockName::Number(kind, number), .. } if typed.is_word => {
                    self.add(&format!("{} {number}", kind.as_str()), CompletionItemKind::Function, None);
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
