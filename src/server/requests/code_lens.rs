//! `textDocument/codeLens`: how often blocks are called and steps are used.

use lsp_types::{CodeLens, CodeLensParams, CodeLensRequest, Command};
use rowan::{TextRange, TextSize};

use super::{Answer, Handle};
use crate::db;
use crate::model::object::Object;
use crate::server::cursor::{self, InProgram, Named};
use crate::server::snapshot::Snapshot;
use crate::source::detect::Detected;

pub(super) struct Handler;

impl Handle for Handler {
    type Request = CodeLensRequest;
    const RETRY: bool = true;

    fn handle(snapshot: &Snapshot, params: CodeLensParams) -> Answer<Self::Request> {
        let Some(it) = snapshot.file(&params.text_document.uri) else { return Ok(None) };
        if it.file.detected(it.db) == Detected::Stx {
            return Ok(None);
        }
        let mut lenses = Vec::new();
        for &program in db::programs_of(it.db, it.file) {
            let program = InProgram::new(it, program);
            let index = program.index();
            let units = db::program_units(it.db, program.program);
            let mut lens = |range: TextRange, title: String| {
                let command = Command { title, ..Default::default() };
                lenses.push(CodeLens { range: it.range(range), command: Some(command), data: None });
            };
            for &(unit, offset) in db::layout(it.db, it.file) {
                let Some(at) = units.iter().position(|other| *other == unit) else { continue };
                let Some(facts) = index.units.get(at) else { continue };
                let model = db::model(it.db, unit);
                let place = |range: TextRange| range + TextSize::new(offset);
                if cursor::is_called(unit.entity(it.db)) {
                    let calls = index.callers.get(at).map_or(0, |it| it.len());
                    lens(place(model.heading()), format!("{} in the program", counted(calls, "call")));
                }
                let Some(chart) = facts.chart.as_ref().filter(|it| it.defines) else { continue };
                for step in &chart.steps {
                    let bit = step.name.as_ref();
                    let bit = bit.and_then(|it| cursor::step_bit(it, chart.graph, index.family));
                    let Some(object) = bit else { continue };
                    let range = place(model.place(step.anchor));
                    let title = uses(object, &index);
                    lens(range, title);
                }
            }
        }
        Ok(Some(lenses))
    }
}

fn uses(object: Object, index: &crate::analysis::program::ProgramIndex<'_>) -> String {
    let name = object.text.clone();
    let uses = Named { object, only_in: None }.uses(index);
    let reads = uses.iter().filter(|it| it.1.mode.reads()).count();
    let writes = uses.iter().filter(|it| cursor::writes(it.1.mode)).count();
    format!("{name}: {}, {}", counted(reads, "read"), counted(writes, "write"))
}

fn counted(number: usize, what: &str) -> String {
    format!("{number} {what}{}", if number == 1 { "" } else { "s" })
}
