//! `textDocument/definition`: where what stands at a position is declared.

use lsp_types::{Definition, DefinitionParams, DefinitionRequest, DefinitionResponse, Location};

use super::{Answer, Handle};
use crate::analysis::Site;
use crate::analysis::program::ProgramIndex;
use crate::db::FilePlace;
use crate::model::entity::Entity;
use crate::model::object::{Area, Class};
use crate::model::symbols::key;
use crate::model::unit::Callee;
use crate::server::cursor::{self, InProgram, InUnit, Named, Target, What};
use crate::server::requests::references;
use crate::server::snapshot::Snapshot;

pub(super) struct Handler;

impl Handle for Handler {
    type Request = DefinitionRequest;

    fn handle(snapshot: &Snapshot, params: DefinitionParams) -> Answer<Self::Request> {
        let position = params.text_document_position_params;
        let Some(it) = snapshot.file(&position.text_document.uri) else { return Ok(None) };
        let Some(cursor) = InUnit::at(it, it.offset(position.position)) else { return Ok(None) };
        let Some(target) = cursor.target() else { return Ok(None) };
        let found = match &target.what {
            What::Label { name, part } => {
                let labels = cursor.model.labels.iter().filter(|it| it.name == *name && it.part == *part);
                labels.map(|label| FilePlace { file: it.file, range: cursor.in_file(label.range) }).collect()
            }
            _ => match cursor.program() {
                Some((program, unit)) => {
                    let program = InProgram::new(it, program);
                    places(&cursor, &target, &program, &program.index(), unit)
                }
                None => Vec::new(),
            },
        };
        let locations: Vec<Location> = found.into_iter().filter_map(|it_| it.root.location(snapshot, it_)).collect();
        Ok((!locations.is_empty()).then_some(DefinitionResponse::Definition(Definition::LocationList(locations))))
    }
}

/// Places that declare what stands at a place.
pub(super) fn places(
    cursor: &InUnit<'_>,
    target: &Target,
    program: &InProgram<'_>,
    index: &ProgramIndex<'_>,
    unit: u32,
) -> Vec<FilePlace> {
    let here = |range| FilePlace { file: cursor.it.file, range: cursor.in_file(range) };
    if let Some(callee) = references::callee(cursor, target) {
        return of_callee(&callee, cursor, program, index, unit);
    }
    let Some(named) = Named::new(cursor, target, unit, index) else { return Vec::new() };
    let object = &named.object;
    match object.class {
        Class::LocalName | Class::Symbol if named.only_in.is_some() => {
            if let Some(declared) = cursor::declaration(cursor.model, object) {
                return vec![here(cursor.model.place(declared.anchor))];
            }
            let items = cursor.model.interface.iter().flat_map(|it| &it.items);
            let name = key(object.text.split(['.', '[', ':']).next().unwrap_or_default());
            return items.filter(|it| key(&it.name) == name).map(|it| here(cursor.model.place(it.anchor))).collect();
        }
        Class::Step | Class::StepTime | Class::MacroStep => return steps(object.text.as_str(), program, index),
        Class::CodeBlock | Class::Data => {
            let (Area::CodeBlock(name) | Area::Data(name)) = &object.footprint.area else { return Vec::new() };
            let is_it = |it: &Entity| it.name() == Some(name);
            return headings(program, index, is_it);
        }
        _ => {}
    }
    cursor::symbol_places(program, index, object)
}

fn headings(program: &InProgram<'_>, index: &ProgramIndex<'_>, is_it: impl Fn(&Entity) -> bool) -> Vec<FilePlace> {
    let mut places = program.places();
    let units = (0..).zip(&index.units).filter(|it| is_it(&it.1.entity));
    units.filter_map(|(unit, _)| places.of(Site { unit, anchor: 0 })).collect()
}

fn of_callee(
    callee: &Callee,
    cursor: &InUnit<'_>,
    program: &InProgram<'_>,
    index: &ProgramIndex<'_>,
    unit: u32,
) -> Vec<FilePlace> {
    match callee {
        Callee::Subroutine(number) => {
            // A task calls its own subroutines.
            let task = index.units.get(unit as usize).and_then(|it| it.entity.task());
            headings(program, index, |it| it.subroutine() == Some(*number) && it.task() == task)
        }
        Callee::Block(name) => headings(program, index, |it| it.name() == Some(name)),
        Callee::LocalInstance(name) => {
            let name = name.trim_start_matches('#').to_lowercase();
            let declared = cursor.model.fields().iter().filter(|it| it.name == *name);
            declared
                .map(|it| FilePlace { file: cursor.it.file, range: cursor.in_file(cursor.model.place(it.anchor)) })
                .collect()
        }
        Callee::Instance(name) => {
            let mut places = program.places();
            let mut found = Vec::new();
            for (unit, facts) in (0..).zip(&index.units) {
                for symbol in facts.symbols.iter().filter(|it| it.object.is_none() && key(&it.name) == *name) {
                    found.extend(places.of(Site { unit, anchor: symbol.anchor }));
                    let ty = key(&symbol.ty);
                    found.extend(headings(program, index, |it| matches!(it, Entity::Dfb { name } if key(name) == ty)));
                }
            }
            found
        }
        Callee::Function(_) | Callee::Unknown => Vec::new(),
    }
}

/// Steps whose bit, or whose time, an address is.
fn steps(address: &str, program: &InProgram<'_>, index: &ProgramIndex<'_>) -> Vec<FilePlace> {
    let bit = address.strip_suffix(".T").unwrap_or(address);
    let mut places = program.places();
    let mut found = Vec::new();
    for (unit, facts) in (0..).zip(&index.units) {
        let Some(chart) = facts.chart.as_ref().filter(|it| it.defines) else { continue };
        for step in &chart.steps {
            if step.name.as_ref().is_some_and(|it| it.bit(chart.graph).eq_ignore_ascii_case(bit)) {
                found.extend(places.of(Site { unit, anchor: step.anchor }));
            }
        }
    }
    found
}
