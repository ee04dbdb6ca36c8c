//! J007: a jump that can skip a timer, counter or other block.

use rowan::TextRange;

use crate::analysis::conditions::{Lessons, Space};
use crate::analysis::gaps;
use crate::lint::{Sink, UnitCx};
use crate::model::expr::Exprs;
use crate::model::object::Object;
use crate::model::unit::{Access, Mode, Pin};

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    let model = cx.model;
    if model.jumps.is_empty() {
        return;
    }
    let lessons = Lessons::default();
    let space = Space::of(model).learning(&lessons);
    let (skips, writes, exits) = (gaps::skips(model), gaps::writes(model), gaps::exits(model));
    let mut skipped: Vec<(u32, &Object, &Access)> = Vec::new();
    for access in model.accesses.iter().filter(|it| is_scanned(it.mode)) {
        let missed = writes.get(&access.object.0).is_some_and(|it| it.leave_out(space, Exprs::TRUE, &exits));
        let object = model.object(access.object);
        if let Some(jump) = gaps::skip(&skips, access).filter(|_| missed)
            && !skipped.iter().rev().take_while(|it| it.0 == jump).any(|it| it.1 == object)
        {
            skipped.push((jump, object, access));
        }
    }
    skipped.sort_by_key(|it| it.0);
    for group in skipped.chunk_by(|a, b| a.0 == b.0) {
        let Some(jump) = model.jumps.get(group[0].0 as usize) else { continue };
        let more = match group.len() - 1 {
            0 => String::new(),
            1 => " and one more block".to_owned(),
            more => format!(" and {more} more blocks"),
        };
        sink.report(jump.range, format!("this jump can skip `{}`{more}", group[0].1.text))
            .related_all(group.iter().map(|it| (model.place(it.2.anchor), "not evaluated then".to_owned())));
    }
}

/// Inputs whose former state the block keeps, or that make it run.
fn is_scanned(mode: Mode) -> bool {
    matches!(mode, Mode::Drive(pin) if !matches!(pin, Pin::Reset | Pin::Enable))
}
