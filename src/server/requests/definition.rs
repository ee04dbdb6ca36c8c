//! `textDocument/definition`: where what stands at a position is declared.

use lsp_types::{Definition, DefinitionParams, DefinitionRequest, DefinitionResponse, Location};

use super::{Answer, Handle};
use crate::analysis::Site;
use crate::analysis::program::ProgramIndex;
use crate::db::FilePlace;
use crate::model::object::{Area, Class, Object};
use crate::model::unit::Callee;
use crate::server::cursor::{self, Called, InProgram, InUnit, Named, Target, What};
use crate::server::names;
use crate::server::snapshot::Snapshot;

pub(super) struct Handler;

impl Handle for Handler {
    type Request = DefinitionRequest;

    fn handle(snapshot: &Snapshot, params: DefinitionParams) -> Answer<Self::Request> {
        let position = params.text_document_position_params;
        let Some(it) = snapshot.file(&position.text_document.uri) else { return Ok(None) };
        let Some(cursor) = InUnit::at(it, it.offset(position.position)) else { return Ok(None) };
        let target = cursor.target();
        let found = match target {
            Some(Target { what: What::Label { name, part }, .. }) => {
                let labels = cursor.model.labels.iter().filter(|it| it.name == name && it.part == part);
                labels.map(|label| FilePlace { file: it.file, range: cursor.in_file(label.range) }).collect()
            }
            target => match cursor.program() {
                Some((program, unit)) => match (names::declaration_at(&cursor), target) {
                    (Some(place), _) => vec![place],
                    (None, Some(target)) => {
                        let program = InProgram::new(it, program);
                        places(&cursor, &target, &program, &program.index(), unit)
                    }
                    (None, None) => Vec::new(),
                },
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
    let here = |anchor| FilePlace { file: cursor.it.file, range: cursor.in_file(cursor.model.place(anchor)) };
    let heading = |unit: u32| program.places().of(Site { unit, anchor: 0 });
    if let Some(called) = Called::new(cursor, target, unit, index) {
        let mut found = match &called.callee {
            Some(Callee::LocalInstance(name)) => {
                let name = name.trim_start_matches('#').to_lowercase();
                cursor.model.fields().iter().filter(|it| it.name == *name).map(|it| here(it.anchor)).collect()
            }
            Some(Callee::Instance(name)) => {
                cursor::symbol_places(program, index, &Object { text: name.clone(), ..Object::symbol(name) })
            }
            _ => Vec::new(),
        };
        found.extend(called.unit.and_then(heading));
        return found;
    }
    let Some(named) = Named::new(cursor, target, unit, index) else { return Vec::new() };
    let object = &named.object;
    match object.class {
        Class::LocalName | Class::Symbol if named.only_in.is_some() => {
            if let Some(declared) = cursor::declaration(cursor.model, object) {
                return vec![here(declared.anchor)];
            }
            let items = cursor.model.interface.iter().flat_map(|it| &it.items);
            return items.filter(|it| cursor::is_named(object, &it.name)).map(|it| here(it.anchor)).collect();
        }
        Class::Step | Class::StepTime | Class::MacroStep => return steps(object, program, index),
        Class::Symbol => {
            if let Some((site, _)) = cursor::member(object, index) {
                return program.places().of(site).into_iter().collect();
            }
        }
        Class::CodeBlock | Class::Data => {
            if let Some((site, _)) = cursor::field(object, index) {
                return program.places().of(site).into_iter().collect();
            }
            if let Area::CodeBlock(name) | Area::Data(name) = &object.footprint.area {
                let units = (0..).zip(&index.units).filter(|it| it.1.entity.name() == Some(name));
                return units.filter_map(|it| heading(it.0)).collect();
            }
            return Vec::new();
        }
        _ => {}
    }
    cursor::symbol_places(program, index, object)
}

/// Steps whose bit, or whose time, an object is.
fn steps(of: &Object, program: &InProgram<'_>, index: &ProgramIndex<'_>) -> Vec<FilePlace> {
    let mut places = program.places();
    let mut found = Vec::new();
    // Bits and times of steps are numbered alike.
    let number = if of.class == Class::StepTime { of.footprint.start / STEP_TIME_BITS } else { of.footprint.start };
    let is_macro = of.class == Class::MacroStep;
    for (unit, facts) in (0..).zip(&index.units) {
        let Some(chart) = facts.chart.as_ref().filter(|it| it.defines) else { continue };
        for step in &chart.steps {
            let bit = step.name.as_ref().and_then(|it| cursor::step_bit(it, chart.graph, index.family));
            if bit.is_some_and(|it| it.footprint.start == number && (it.class == Class::MacroStep) == is_macro) {
                found.extend(places.of(Site { unit, anchor: step.anchor }));
            }
        }
    }
    found
}

/// See [`Area::StepTimes`].
const STEP_TIME_BITS: u32 = 16;
