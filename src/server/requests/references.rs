//! `textDocument/references`: the places that use what stands at a position, and what shares memory with it.

use lsp_types::{Location, ReferenceParams, ReferencesRequest};
use rustc_hash::FxHashSet;

use super::{Answer, Handle};
use crate::analysis::Site;
use crate::analysis::program::ProgramIndex;
use crate::db::{self, FilePlace, Program};
use crate::model::symbols::key;
use crate::model::unit::Mode;
use crate::server::cursor::{Called, InProgram, InUnit, Named, Target, What};
use crate::server::names::{self, Declared, Names};
use crate::server::requests::definition;
use crate::server::snapshot::Snapshot;

pub(super) struct Handler;

impl Handle for Handler {
    type Request = ReferencesRequest;

    fn handle(snapshot: &Snapshot, params: ReferenceParams) -> Answer<Self::Request> {
        let position = params.text_document_position_params;
        let Some(it) = snapshot.file(&position.text_document.uri) else { return Ok(None) };
        let found = found(InUnit::at(it, it.offset(position.position)), params.context.include_declaration);
        let locations: Vec<Location> =
            found.into_iter().filter_map(|found| it.root.location(snapshot, found.place)).collect();
        Ok((!locations.is_empty()).then_some(locations))
    }
}

/// A use, or a declaration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Found {
    pub(super) place: FilePlace,
    /// `None` for a declaration.
    pub(super) mode: Option<Mode>,
}

/// Uses of what stands at a place, each place once; declarations first.
pub(super) fn found(cursor: Option<InUnit<'_>>, with_declarations: bool) -> Vec<Found> {
    let Some(cursor) = cursor else { return Vec::new() };
    let target = cursor.target();
    let mut found = Vec::new();
    if let Some(What::Label { name, part }) = target.as_ref().map(|it| &it.what) {
        let model = cursor.model;
        let place = |range| FilePlace { file: cursor.it.file, range: cursor.in_file(range) };
        if with_declarations {
            let labels = model.labels.iter().filter(|it| it.name == *name && it.part == *part);
            found.extend(labels.map(|it| Found { place: place(it.range), mode: None }));
        }
        let jumps = model.jumps.iter().filter(|it| it.label == *name && it.part == *part);
        found.extend(jumps.map(|it| Found { place: place(it.range), mode: Some(Mode::Read) }));
        return found;
    }
    let Some((program, unit)) = cursor.program() else { return found };
    let is_object = matches!(target, Some(Target { what: What::Object(_), .. }));
    if let Some(target) = target {
        let program = InProgram::new(cursor.it, program);
        let index = program.index();
        if with_declarations {
            let declared = definition::places(&cursor, &target, &program, &index, unit);
            found.extend(declared.into_iter().map(|place| Found { place, mode: None }));
        }
        let mut seen: FxHashSet<FilePlace> = found.iter().map(|it| it.place).collect();
        let mut places = program.places();
        for (site, mode) in uses(&cursor, &target, &index, unit) {
            let place = places.of(site).filter(|it| seen.insert(*it));
            found.extend(place.map(|place| Found { place, mode: Some(mode) }));
        }
    }
    // An object is in one place, and what names the same field may be in another.
    if !is_object {
        named(&cursor, program, with_declarations, &mut found);
    }
    found
}

/// Where what a block declares is named and no object is meant: in calls, and where a data block gives it a value.
fn named(cursor: &InUnit<'_>, program: Program<'_>, with_declarations: bool, found: &mut Vec<Found>) {
    let Some(word) = names::word_at(cursor) else { return };
    let Declared::Field(of, anchor) = word.declared else { return };
    let db = cursor.it.db;
    let declaration = names::place_in(db, of, db::model(db, of).place(anchor));
    let name = key(cursor.text(word.range));
    for (unit, word) in Names::new(db, program).all(&name, &word.declared) {
        let place = names::place_in(db, unit, word.range);
        let holds = |it: FilePlace| it.file == place.file && it.range.contains_range(place.range);
        let is_declaration = holds(declaration);
        let is_known = |it: &Found| holds(it.place);
        if (with_declarations || !is_declaration) && !found.iter().any(is_known) {
            found.push(Found { place, mode: (!is_declaration).then_some(Mode::Read) });
        }
    }
}

fn uses(cursor: &InUnit<'_>, target: &Target, index: &ProgramIndex<'_>, unit: u32) -> Vec<(Site, Mode)> {
    if let Some(called) = Called::new(cursor, target, unit, index) {
        return called.calls(index).map(|it| (it.site(), Mode::Read)).collect();
    }
    let Some(named) = Named::new(cursor, target, unit, index) else { return Vec::new() };
    named.uses(index).into_iter().map(|(_, it)| (it.site(), it.mode)).collect()
}
