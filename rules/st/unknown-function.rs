//! T016: a function that PL7 does not have, or a number of arguments that it does not take.

use rowan::TextRange;
use rustc_hash::FxHashMap;

use crate::lint::{Applicability, Severity, Sink, UnitCx, nearest};
use crate::syntax::pl7::ast::{CallExpr, CallStmt, Expr};
use crate::syntax::pl7::functions::{self, Form, Function};
use crate::syntax::{AstNode as _, SyntaxKind, SyntaxToken};

/// What each unknown name is near to: a text may have it often.
type Near<'t> = FxHashMap<&'t str, Option<&'static str>>;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    let mut near = Near::default();
    for call in cx.nodes(SyntaxKind::CallExpr).filter_map(CallExpr::cast) {
        let Some(name) = call.name() else { continue };
        match call.function() {
            Some(function) => count(sink, name, function, &call.arguments()),
            // What has a value is a function: an instance of a DFB is a statement.
            None => unknown(sink, &mut near, name),
        }
    }
    for call in cx.nodes(SyntaxKind::CallStmt).filter_map(CallStmt::cast).filter(|it| it.has_parentheses()) {
        if let (Some(name), Some(function)) = (call.callee(), call.function()) {
            count(sink, name, function, &call.arguments());
        }
    }
}

fn unknown<'t>(sink: &mut Sink<'_, TextRange>, near: &mut Near<'t>, name: SyntaxToken<'t>) {
    let text = name.text();
    let near = *near.entry(text).or_insert_with(|| {
        let with_value = functions::all().iter().filter(|it| it.form == Form::Call && it.result.is_some());
        nearest(text, with_value.flat_map(|it| std::iter::once(it.name).chain(it.also.iter().copied())))
    });
    let finding = sink.report(name.text_range(), format!("PL7 has no function `{text}`"));
    match near {
        Some(near) => {
            finding.replace(format!("Write `{near}`"), Applicability::Unsafe, name.text_range(), near);
        }
        None => {
            finding.severity(Severity::Warning).note("this assumes that no other volume of the manual has it");
        }
    }
}

fn count(sink: &mut Sink<'_, TextRange>, name: SyntaxToken<'_>, function: &Function, given: &[Option<Expr<'_>>]) {
    // Only the first volume of the manual says what the arguments are, and not of all its functions.
    if function.form != Form::Call || function.line == 0 || function.is_open {
        return;
    }
    let wanted = function.parameters.len();
    let given = if given.iter().all(Option::is_none) && given.len() == 1 { 0 } else { given.len() };
    if given != wanted {
        let plural = if wanted == 1 { "" } else { "s" };
        let message = format!("`{}` takes {wanted} argument{plural}, and is given {given}", function.name);
        sink.report(name.text_range(), message).note(format!("the function is given in PL7:{}", function.line));
    }
}
