//! T006: a loop whose condition nothing in it can change.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::expr::{Expr, ExprId, Exprs};
use crate::model::object::{Class, Object};
use crate::model::unit::{Access, Callee, Loop, LoopKind, Mode, StatementKind};
use crate::syntax::pl7::functions;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for it in &cx.model.loops {
        let (Some(condition), Some(place)) = (it.condition, it.condition_range) else { continue };
        let runs_once = match it.kind {
            LoopKind::While => condition == Exprs::FALSE,
            LoopKind::Repeat => condition == Exprs::TRUE,
            LoopKind::For | LoopKind::Jump => continue,
        };
        if it.exits || runs_once || !is_known(&cx.model.exprs, condition) || calls_unknown(cx, it) {
            continue;
        }
        let body = cx.model.accesses_of(&it.body);
        let tested: Vec<&Access> = body.iter().filter(|it| place.contains_range(cx.model.place(it.anchor))).collect();
        let can_change = |access: &&Access| {
            let object = cx.model.object(access.object);
            access.mode != Mode::Read || is_volatile(object.class) || is_written(cx, body, object)
        };
        if tested.iter().any(can_change) {
            continue;
        }
        let message = match tested.first() {
            Some(first) => {
                format!(
                    "nothing in this loop changes `{}`, on which its end depends",
                    cx.model.object(first.object).text
                )
            }
            None => "this loop never ends: its condition is constant and nothing leaves it".to_owned(),
        };
        let found = sink.report(place, message).related(it.keyword, "the loop starts here");
        if !tested.is_empty() {
            found.note("assumed: no other task, event or operator panel changes it while the loop runs");
        }
    }
}

/// Whether the whole condition was understood. A function without arguments may ask the system.
fn is_known(exprs: &Exprs, condition: ExprId) -> bool {
    !exprs.has_part(condition, |it| match it {
        Expr::Opaque(_) => true,
        Expr::Call(name, arguments) => arguments.is_empty() || functions::lookup(name).is_none(),
        _ => false,
    })
}

/// Whether the loop calls what may write anything: a subroutine, an instance, a function with unknown arguments.
fn calls_unknown(cx: &UnitCx<'_>, it: &Loop) -> bool {
    let statements = cx.model.statements.get(it.body.start as usize..it.body.end as usize).unwrap_or_default();
    statements.iter().any(|statement| match statement.kind {
        StatementKind::Call(call) => match cx.model.calls.get(call as usize).map(|it| &it.callee) {
            Some(Callee::Function(name)) => functions::lookup(name).is_none_or(|it| it.is_open),
            _ => true,
        },
        _ => false,
    })
}

/// What changes without the program's doing while a scan runs.
fn is_volatile(class: Class) -> bool {
    !matches!(
        class,
        Class::Input | Class::Output | Class::Memory | Class::Constant | Class::Step | Class::MacroStep | Class::Symbol
    )
}

fn is_written(cx: &UnitCx<'_>, body: &[Access], tested: &Object) -> bool {
    body.iter().any(|access| {
        let written = cx.model.object(access.object);
        let same_place = written.footprint.overlaps(&tested.footprint);
        let maybe = (!written.is_fixed() || !tested.is_fixed()) && written.footprint.area == tested.footprint.area;
        let writes = access.mode.writes() || matches!(access.mode, Mode::Drive(_));
        writes && (same_place || maybe || written.class == Class::Indirect)
    })
}
