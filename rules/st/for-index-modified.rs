//! T004: the index of a `FOR` is written inside its own loop.

use rowan::TextRange;
use rustc_hash::{FxHashMap, FxHashSet};

use crate::lint::{Sink, UnitCx};
use crate::model::unit::{LoopKind, Mode};

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    let model = cx.model;
    // Writes of the index, by loop. The nesting of loops is limited by the grammar.
    let mut writes: FxHashMap<u32, Vec<TextRange>> = FxHashMap::default();
    let surely_writes = |mode: Mode| mode.writes() && mode != Mode::InOut;
    for access in model.accesses.iter().filter(|it| surely_writes(it.mode) && model.object(it.object).is_fixed()) {
        let mut around = model.statement(access).and_then(|it| it.in_loop);
        while let Some((id, it)) = around.and_then(|id| Some((id, model.loops.get(id as usize)?))) {
            around = it.parent;
            let written = &model.object(access.object).footprint;
            if it.kind == LoopKind::For
                && it.body.contains(&access.statement)
                && it.index.is_some_and(|index| model.object(index).footprint.overlaps(written))
            {
                writes.entry(id).or_default().push(model.place(access.anchor));
            }
        }
    }
    let indices: FxHashSet<TextRange> = model.loops.iter().filter_map(|it| it.index_range).collect();
    for (id, it) in (0..).zip(&model.loops) {
        let (Some(places), Some(index)) = (writes.get(&id), it.index_range) else { continue };
        let Some((&first, others)) = places.split_first() else { continue };
        let text = cx.text_of(index);
        let is_shared = indices.contains(&first);
        let message = if is_shared {
            format!("the index `{text}` of the loop around this one counts here too")
        } else {
            format!("the index `{text}` is written inside its own loop")
        };
        sink.report(first, message)
            .related(index, "the loop counts with it")
            .related_all(others.iter().map(|&it| (it, "and written here".to_owned())));
    }
}
