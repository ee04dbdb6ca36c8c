//! `textDocument/inlayHint`: the symbol behind an address, the address behind a symbol.

use lsp_types::{InlayHint, InlayHintParams, InlayHintRequest, Label};
use rowan::{TextRange, TextSize};

use super::{Answer, Handle};
use crate::db;
use crate::model::object::Class;
use crate::server::cursor;
use crate::server::snapshot::Snapshot;
use crate::source::detect::Detected;

pub(super) struct Handler;

impl Handle for Handler {
    type Request = InlayHintRequest;

    fn handle(snapshot: &Snapshot, params: InlayHintParams) -> Answer<Self::Request> {
        let Some(it) = snapshot.file(&params.text_document.uri) else { return Ok(None) };
        if it.file.detected(it.db) == Detected::Stx {
            return Ok(None);
        }
        let wanted = it.text_range(params.range);
        let mut hints: Vec<(TextRange, String)> = Vec::new();
        for &(unit, offset) in db::layout(it.db, it.file) {
            let all = TextRange::at(offset.into(), TextSize::of(&**unit.text(it.db)));
            if all.intersect(wanted).is_none() {
                continue;
            }
            let Some((program, _)) = cursor::program_with(it, unit) else { continue };
            let table = db::symbol_table(it.db, program);
            if table.is_empty() {
                continue;
            }
            let model = db::model(it.db, unit);
            for access in &model.accesses {
                let object = model.object(access.object);
                let range = model.place(access.anchor) + TextSize::new(offset);
                if object.indexed || !wanted.contains_range(range) {
                    continue;
                }
                // The place of a block may be that of its pins as well.
                let text = it.file.text(it.db).get(std::ops::Range::<usize>::from(range)).unwrap_or_default();
                let other = match object.class {
                    Class::Symbol => table.address(text),
                    _ => table.symbol(text),
                };
                hints.extend(other.map(|it| (range, it.to_string())));
            }
        }
        hints.sort_by_key(|it| (it.0.start(), it.0.end()));
        hints.dedup();
        let hints = hints.into_iter().map(|(range, name)| InlayHint {
            position: it.range(range).end,
            label: Label::String(name),
            kind: None,
            text_edits: None,
            tooltip: None,
            padding_left: Some(true),
            padding_right: None,
            data: None,
        });
        Ok(Some(hints.collect()))
    }
}
