//! G023: the time of a step, compared with what it never is, or in another unit than its own.

use rowan::TextRange;
use rustc_hash::FxHashSet;

use crate::lint::{Applicability, Severity, Sink, UnitCx};
use crate::model::step_times::{self, TimeCheck};
use crate::syntax::pl7::ast::BinExpr;
use crate::syntax::{AstNode as _, SyntaxKind, SyntaxNode};

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    let Some((times, unit)) = cx.target.step_times() else { return };
    if !cx.model.objects.iter().any(step_times::is_step_time) {
        return;
    }
    let (first, last) = (i64::from(times.first), i64::from(times.last));
    let decided = |it: &TimeCheck| it.op.decided(first, last, it.constant);
    let comparisons = cx.nodes(SyntaxKind::BinExpr).filter_map(BinExpr::cast);
    for it in comparisons.filter_map(|it| step_times::check(cx.model, it)) {
        let Some(value) = decided(&it) else { continue };
        let (text, time) = (cx.text_of(it.range), cx.text_of(it.time));
        let when = if value { "always" } else { "never" };
        sink.report(it.range, format!("`{text}` is {when} true: `{time}` is {first} to {last}")).note(format!(
            "in units of {}, according to {}",
            duration(unit.value.into()),
            times.source
        ));
    }
    // A sentence within a transition is found with both.
    let mut seen: FxHashSet<TextRange> = FxHashSet::default();
    for kind in [SyntaxKind::Transition, SyntaxKind::Sentence, SyntaxKind::Rung] {
        for node in cx.nodes(kind) {
            let Some((comment, named, it)) = timed(cx, node) else { continue };
            let meant = it.constant.checked_mul(unit.value.into()).and_then(|it| u64::try_from(it).ok());
            let Some(meant) = meant.filter(|_| decided(&it).is_none() && is_in_other_unit(&it, named)) else {
                continue;
            };
            if meant == named || !seen.insert(it.range) {
                continue;
            }
            let time = cx.text_of(it.time);
            let (is, says) = (duration(meant), duration(named));
            let message = format!("`{time}` is compared with {is}, and the comment says {says}");
            let mut report = sink
                .report(it.range, message)
                .severity(Severity::Warning)
                .related(comment, "this comment")
                .note(format!("step times count in units of {} ({})", duration(unit.value.into()), unit.source));
            let wanted = named / u64::from(unit.value);
            if named.is_multiple_of(unit.value.into()) && u64::from(times.last) > wanted {
                let title = format!("Write {wanted}");
                report = report.replace(title, Applicability::Unsafe, it.constant_range, wanted.to_string());
            }
            let _ = report;
        }
    }
}

/// The one comparison of a step time in a piece of code, with the one duration that its comments name.
fn timed(cx: &UnitCx<'_>, node: SyntaxNode<'_>) -> Option<(TextRange, u64, TimeCheck)> {
    let mut named: Option<(TextRange, u64)> = None;
    for comment in node.descendant_tokens().filter(|it| it.kind() == SyntaxKind::Comment) {
        for it in step_times::durations(comment.text()) {
            if named.replace((comment.text_range(), it)).is_some() {
                return None;
            }
        }
    }
    let (comment, named) = named?;
    let comparisons = node.descendants().filter(|it| it.kind() == SyntaxKind::BinExpr).filter_map(BinExpr::cast);
    let mut checks = comparisons.filter_map(|it| step_times::check(cx.model, it));
    let only = checks.next()?;
    checks.next().is_none().then_some((comment, named, only))
}

/// Whether the number is that of the duration in some unit.
fn is_in_other_unit(it: &TimeCheck, named: u64) -> bool {
    const UNITS_MS: [u64; 5] = [1, 10, 100, 1000, 60_000];
    let number = u64::try_from(it.constant).ok().filter(|&it| it > 0);
    number.is_some_and(|number| UNITS_MS.iter().any(|unit| number.checked_mul(*unit) == Some(named)))
}

/// `1.5 s`, of milliseconds.
fn duration(ms: u64) -> String {
    if ms < 1000 {
        return format!("{ms} ms");
    }
    let part = format!("{:03}", ms % 1000);
    let part = part.trim_end_matches('0');
    if part.is_empty() { format!("{} s", ms / 1000) } else { format!("{}.{part} s", ms / 1000) }
}
