//! `textDocument/hover`: what stands at a position.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use lsp_types::{Contents, Hover, HoverParams, HoverRequest, MarkupContent, MarkupKind};
use rowan::TextRange;
use rustc_hash::FxHashSet;

use super::{Answer, Handle};
use crate::analysis::program::ProgramIndex;
use crate::db;
use crate::model::dfb::{Item, Role};
use crate::model::entity::BlockKind;
use crate::model::object::{Class, Object};
use crate::model::unit::{Callee, Mode, Section};
use crate::server::cursor::{self, Called, InProgram, InUnit, Named, Target, What};
use crate::server::describe;
use crate::server::names::{self, Declared};
use crate::server::snapshot::{InFile, Snapshot};
use crate::syntax::{Language, SyntaxKind};

pub(super) struct Handler;

impl Handle for Handler {
    type Request = HoverRequest;

    fn handle(snapshot: &Snapshot, params: HoverParams) -> Answer<Self::Request> {
        let position = params.text_document_position_params;
        let Some(it) = snapshot.file(&position.text_document.uri) else { return Ok(None) };
        let at = it.offset(position.position);
        let mut parts = Vec::new();
        let mut range: Option<TextRange> = None;
        if let Some(cursor) = InUnit::at(it, at) {
            let target = cursor.target();
            let text = match &target {
                Some(target) => of_target(&cursor, target),
                None => None,
            };
            match (text, target) {
                (Some(text), Some(target)) => {
                    range = Some(cursor.in_file(target.range));
                    parts.push(text);
                }
                _ => {
                    if let Some((here, text)) = of_word(&cursor).or_else(|| of_instruction(&cursor)) {
                        range = Some(cursor.in_file(here));
                        parts.push(text);
                    }
                }
            }
        }
        parts.extend(rules(&it, at));
        let range = range.map(|range| it.range(range));
        let value = parts.join("\n\n---\n\n");
        Ok((!value.is_empty()).then_some(Hover {
            contents: Contents::MarkupContent(MarkupContent { kind: MarkupKind::Markdown, value }),
            range,
        }))
    }
}

/// The pages of the rules whose findings stand at a place, without their examples.
fn rules(it: &InFile<'_>, at: rowan::TextSize) -> Vec<String> {
    let mut seen: FxHashSet<&str> = FxHashSet::default();
    let findings = db::file_findings(it.db, it.file).iter().filter(|it| it.suppressed.is_none());
    let here = findings.filter(|it| it.finding.place.range.contains_inclusive(at)).map(|it| it.finding.rule);
    let here = here.filter(|it| seen.insert(it.code));
    let page = |rule: &'static crate::lint::Rule| {
        format!(
            "**{} ({})**: {}\n\n{}\n\n**Why**: {}\n\n**Instead**: {}",
            rule.code,
            rule.name,
            rule.summary,
            rule.what(),
            rule.why(),
            rule.help()
        )
    };
    here.map(page).collect()
}

/// A name that a declaration gives its meaning, where no object is meant: a parameter in a call, the field that a data block
/// gives a value.
fn of_word(cursor: &InUnit<'_>) -> Option<(TextRange, String)> {
    let word = names::word_at(cursor)?;
    let Declared::Field(unit, anchor) = word.declared else { return None };
    let (db, text) = (cursor.it.db, cursor.text(word.range));
    let (model, of) = (db::model(db, unit), unit.entity(db).to_string());
    let item = model.interface.iter().flat_map(|it| &it.items).find(|it| it.anchor == anchor);
    let (what, ty) = match (item, names::field(model.fields(), anchor)) {
        (Some(item), _) => (item.role.describe(), item.ty.describe().to_string()),
        (None, Some(field)) => {
            let what = match unit.entity(db).block_kind() {
                Some(BlockKind::Udt) => "component",
                Some(it) if it.is_data() => "field",
                _ => described(field.section),
            };
            (what, field.ty.to_string())
        }
        (None, None) => return None,
    };
    Some((word.range, format!("**{text}**: {what} of type `{ty}` of `{of}`")))
}

fn of_instruction(cursor: &InUnit<'_>) -> Option<(TextRange, String)> {
    let token = cursor.token()?;
    let (language, range) = (cursor.unit.language(cursor.it.db), token.text_range());
    let tree = db::tree(cursor.it.db, cursor.unit);
    let mut instructions = tree.syntax().descendants().filter(|it| it.kind() == SyntaxKind::Instr);
    let mut is_mnemonic = || instructions.any(|it| it.tokens().any(|it| it.text_range() == range));
    // The names of parameters and fields are words of the language, too.
    let is_one = !language.is_statement_list() || is_mnemonic();
    let text = describe::instruction(token.text(), language).filter(|_| is_one)?;
    Some((range, text))
}

fn of_target(cursor: &InUnit<'_>, target: &Target) -> Option<String> {
    let model = cursor.model;
    if let What::Label { name, part } = &target.what {
        let jumps = model.jumps.iter().filter(|it| it.label == *name && it.part == *part).count();
        let labels = model.labels.iter().filter(|it| it.name == *name && it.part == *part).count();
        let text = cursor.text(target.range);
        return Some(match labels {
            0 => format!("**{text}**: a label that is not there, with {}", count(jumps, "jump")),
            _ => format!("**{text}**: label, with {}", count(jumps, "jump")),
        });
    }
    let (program, unit) = cursor.program()?;
    let program = InProgram::new(cursor.it, program);
    let index = program.index();
    if let Some(called) = Called::new(cursor, target, unit, &index) {
        return of_called(cursor, target, &called, &index);
    }
    let named = Named::new(cursor, target, unit, &index)?;
    Some(of_object(cursor, target, &named, &program, &index))
}

fn count(number: usize, what: &str) -> String {
    format!("{number} {what}{}", if number == 1 { "" } else { "s" })
}

fn of_called(cursor: &InUnit<'_>, target: &Target, called: &Called, index: &ProgramIndex<'_>) -> Option<String> {
    let text = cursor.text(target.range);
    if let Some(Callee::Function(name)) = &called.callee {
        return describe::instruction(name, Language::Pl7St);
    }
    let calls = count(called.calls(index).count(), "place");
    let Some(unit) = called.unit.and_then(|it| index.units.get(it as usize)) else {
        return Some(format!("**{text}**: called in {calls}; the program does not hold it"));
    };
    let mut out = format!("**{text}**: ");
    let entity = unit.entity.to_string();
    if called.callee.is_some() || entity != text {
        let _ = write!(out, "`{entity}`, ");
    }
    let tasks = called.unit.map(|it| index.task_names(it)).filter(|it| !it.is_empty() && *it != entity);
    match (cursor::is_called(&unit.entity), tasks) {
        (true, None) => {
            let _ = write!(out, "called in {calls}");
        }
        (true, Some(tasks)) => {
            let _ = write!(out, "called in {calls}, runs in {tasks}");
        }
        (false, None) => out.push_str(match unit.entity.block_kind() {
            Some(BlockKind::Udt) => "type",
            Some(it) if it.is_data() => "data block",
            _ => "run by the system",
        }),
        (false, Some(tasks)) => {
            let _ = write!(out, "runs in {tasks}");
        }
    }
    let fields = unit.declared.iter().flat_map(|it| it.fields());
    for declared in fields.filter(|it| section(it.section).is_some()) {
        let word = section(declared.section).unwrap_or_default();
        let _ = write!(out, "\n- {word} `{} : {}`", declared.name, declared.ty);
    }
    for item in unit.interface.iter().flat_map(|it| &it.items).filter(|it| is_parameter(it.role)) {
        let _ = write!(out, "\n- {} `{} : {}`", item.role.describe(), item.name, item.ty.describe());
    }
    Some(out)
}

fn is_parameter(role: Role) -> bool {
    matches!(role, Role::Input | Role::InOut | Role::Output)
}

fn section(section: Section) -> Option<&'static str> {
    match section {
        Section::Input => Some("input"),
        Section::Output => Some("output"),
        Section::InOut => Some("in/out"),
        Section::Static | Section::Temp => None,
    }
}

fn of_object(
    cursor: &InUnit<'_>,
    target: &Target,
    named: &Named,
    program: &InProgram<'_>,
    index: &ProgramIndex<'_>,
) -> String {
    let object = &named.object;
    let text = cursor.text(target.range);
    let what = declared(cursor, &target.what, object, index).unwrap_or_else(|| describe::kind(object));
    let mut out = format!("**{text}**: {what}");
    let table = db::symbol_table(cursor.it.db, program.program);
    let written = object.text.split('[').next().unwrap_or(&object.text);
    if let Some(mut symbol) = table.symbol(written).filter(|it| cursor::key_in_code(it) != cursor::key_in_code(text)) {
        // The table knows addresses in capitals; names of fields are shown as they are.
        if let (Some((head, tail)), Some((_, own))) = (symbol.rsplit_once('.'), written.rsplit_once('.'))
            && tail.eq_ignore_ascii_case(own)
        {
            symbol = format!("{head}.{own}").into();
        }
        let _ = write!(out, "  \nsymbol `{symbol}`");
    } else if let Some(address) = table.address(text.split('[').next().unwrap_or(text)) {
        let _ = write!(out, "  \naddress `{address}`");
    }
    if let Some(comment) = comment(cursor.it, program, index, object) {
        let _ = write!(out, "{}{comment}", if out.contains('\n') { ": " } else { "  \n" });
    }
    if object.indexed {
        out.push_str("  \nthe address is that of index 0; an index is added when the program runs");
    }
    let lines = [describe::place(object, index.family), describe::rights(object)];
    for line in lines.into_iter().flatten() {
        let _ = write!(out, "  \n{line}");
    }
    write_uses(&mut out, named, index);
    out
}

/// What runs a unit.
fn task(unit: u32, index: &ProgramIndex<'_>) -> String {
    let tasks = index.task_names(unit);
    if !tasks.is_empty() {
        return tasks;
    }
    match index.units.get(unit as usize) {
        Some(it) if it.entity.block_kind() == Some(BlockKind::Ob) => it.entity.to_string(),
        _ if index.is_startup(unit) => "start-up".to_owned(),
        _ => "a task that is not known".to_owned(),
    }
}

/// How often the object itself is used by what, and what shares memory with it.
fn write_uses(out: &mut String, named: &Named, index: &ProgramIndex<'_>) {
    #[derive(Default)]
    struct Counts {
        reads: usize,
        writes: usize,
        edges: usize,
    }
    let mut by_task: BTreeMap<String, Counts> = BTreeMap::new();
    let mut others: Vec<&str> = Vec::new();
    let is_itself = |it: &Object| {
        it.footprint == named.object.footprint && (it.ty, it.indexed) == (named.object.ty, named.object.indexed)
    };
    for (object, used) in named.uses(index) {
        if !is_itself(object) {
            if !others.contains(&object.text.as_str()) {
                others.push(&object.text);
            }
            continue;
        }
        let counts = by_task.entry(task(used.unit, index)).or_default();
        match used.mode {
            mode if mode.is_edge() => counts.edges += 1,
            Mode::EdgeMemory => counts.edges += 1,
            mode => {
                counts.reads += usize::from(mode.reads());
                counts.writes += usize::from(cursor::writes(mode));
            }
        }
    }
    if by_task.is_empty() && others.is_empty() && named.object.class != Class::CodeBlock {
        out.push_str("\n\nnot used by the program");
    }
    for (task, it) in &by_task {
        let (reads, writes, edges) = (count(it.reads, "read"), count(it.writes, "write"), count(it.edges, "edge test"));
        let separator = if out.contains("\n\n- ") { "\n" } else { "\n\n" };
        let _ = write!(out, "{separator}- {task}: {reads}, {writes}, {edges}");
    }
    const MOST: usize = 8;
    if !others.is_empty() {
        let shown: Vec<String> = others.iter().take(MOST).map(|it| format!("`{it}`")).collect();
        let more = if others.len() > MOST { format!(" and {} more", others.len() - MOST) } else { String::new() };
        let _ = write!(out, "\n\nshares memory with {}{more}", shown.join(", "));
    }
}

fn described(of: Section) -> &'static str {
    section(of).unwrap_or(match of {
        Section::Temp => "temporary",
        _ => "static",
    })
}

/// What a name is that a block declares, or has as an instance of a DFB.
fn declared(cursor: &InUnit<'_>, what: &What, object: &Object, index: &ProgramIndex<'_>) -> Option<String> {
    if let Some(field) = cursor::declaration(cursor.model, object) {
        let word = described(field.section);
        let whole = format!("{word} of type `{}`", field.ty);
        let Some((_, path)) = object.text.split_once('.').filter(|_| !matches!(what, What::Declaration(_))) else {
            return Some(whole);
        };
        let place = index.layouts().of_names(cursor.model.fields()).place(&object.text).and_then(|it| it.ty);
        let ty = place.map_or_else(String::new, |it| format!(" of type `{}`", it.name()));
        return Some(format!("component `{path}`{ty} of `{}`, {whole}", field.name));
    }
    let own = |it: &&Item| object.class == Class::LocalName && cursor::is_named(object, &it.name);
    let own = cursor.model.interface.iter().flat_map(|it| &it.items).find(own);
    if let Some(item) = own {
        return Some(format!("{} of type `{}`", item.role.describe(), item.ty.describe()));
    }
    if object.class == Class::Data {
        let (_, place) = cursor::field(object, index)?;
        let is_whole = place.start == object.footprint.start && Some(place.bits) == object.ty.bits();
        let part = if is_whole { "" } else { "part of " };
        let ty = place.ty.map_or_else(String::new, |it| format!(" : {}", it.name()));
        return Some(format!("{part}field `{}{ty}` in {}", place.path, describe::kind(object)));
    }
    if object.class != Class::Symbol {
        return None;
    }
    let (site, item) = cursor::member(object, index)?;
    let dfb = index.units.get(site.unit as usize)?.entity.to_string();
    Some(format!("{} of type `{}` of `{dfb}`", item.role.describe(), item.ty.describe()))
}

/// The comment that the declaration of a symbol gives it.
fn comment(it: InFile<'_>, program: &InProgram<'_>, index: &ProgramIndex<'_>, object: &Object) -> Option<String> {
    let units = db::program_units(it.db, program.program);
    cursor::declaring(index, object).find_map(|(unit, declared)| {
        let symbols = &db::model(it.db, *units.get(unit as usize)?).symbols;
        let symbol = symbols.iter().find(|it| it.anchor == declared.anchor)?;
        symbol.comment.as_ref().map(ToString::to_string)
    })
}
