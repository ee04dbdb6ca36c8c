//! T015: tables that do not fit one another, and tables where there can be none.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::object::{Class, Object, Type};
use crate::model::unit::Mode;
use crate::syntax::pl7::ast::{AssignStmt, BinExpr, CallExpr, Expr};
use crate::syntax::pl7::functions;
use crate::syntax::{AstNode as _, Language, SyntaxKind};

/// System words that a table may lie in (PL7:1045).
const SYSTEM_TABLE: std::ops::RangeInclusive<u32> = 50..=53;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    let is_awl = matches!(cx.model.language, Language::Awl(_));
    if is_awl || !cx.model.objects.iter().any(|it| it.ty.is_table()) {
        return;
    }
    places(cx, sink);
    for statement in cx.nodes(SyntaxKind::AssignStmt).filter_map(AssignStmt::cast) {
        let (Some(target), Some(value)) = (statement.target(), statement.value()) else { continue };
        let Some(a) = cx.kinds().type_of(target) else { continue };
        if !a.is_table() && !matches!(value, Expr::Object(_) | Expr::Paren(_)) {
            continue;
        }
        let Some(b) = shape(cx, value) else { continue };
        let whole = statement.syntax().text_range();
        match (a.is_table(), b.is_table()) {
            (true, true) => pair(cx, sink, whole, a, b),
            (true, false) => bits(sink, whole, a, b),
            (false, true) => bits(sink, whole, b, a),
            (false, false) => {}
        }
    }
    for expr in cx.nodes(SyntaxKind::BinExpr).filter_map(BinExpr::cast) {
        let Some(a) = table(cx, expr.lhs()) else { continue };
        if let Some(b) = table(cx, expr.rhs()) {
            pair(cx, sink, expr.syntax().text_range(), a, b);
        }
    }
    for call in cx.nodes(SyntaxKind::CallExpr).filter_map(CallExpr::cast) {
        let tables: Vec<Type> =
            call.arguments().into_iter().flatten().filter_map(|it| cx.kinds().type_of(it)).collect();
        if let ([a, b], true) = (tables.as_slice(), call.function().is_some_and(takes_a_pair)) {
            pair(cx, sink, call.syntax().text_range(), *a, *b);
        }
    }
}

fn table<'a>(cx: &UnitCx<'a>, expr: Option<Expr<'a>>) -> Option<Type> {
    cx.kinds().type_of(expr?).filter(|it| it.is_table())
}

/// Whether a function compares or combines two tables, element by element.
fn takes_a_pair(function: &functions::Function) -> bool {
    use functions::Kind;
    let is_table = |it: &functions::Parameter| {
        matches!(it.kind, Kind::BitTable | Kind::WordTable | Kind::DoubleTable | Kind::IntegerTable | Kind::FloatTable)
    };
    function.parameters.len() == 2 && function.parameters.iter().all(is_table) && function.line != 0
        // Dates and times are tables of four words (PL7:3785-3789).
        && !function.name.starts_with("DELTA_")
}

/// Form of a value: of an object, of the table that an operation starts with, of what combines bits.
fn shape<'a>(cx: &UnitCx<'a>, mut expr: Expr<'a>) -> Option<Type> {
    loop {
        expr = match expr {
            Expr::Paren(it) => it.expr()?,
            Expr::Bin(it) if it.op().is_some_and(|op| !op.is_comparison()) => it.lhs()?,
            Expr::Call(it) if matches!(it.function()?.result, Some(functions::Kind::BitTable)) => {
                it.arguments().into_iter().next()??
            }
            other => return cx.kinds().type_of(other),
        };
    }
}

/// What the elements of a table are, and how many there are.
fn elements(ty: Type) -> Option<(&'static str, u32)> {
    Some(match ty {
        Type::BitTable(n) => ("bits", n),
        Type::WordTable(n) => ("words", n),
        Type::DoubleTable(n) => ("double words", n),
        Type::FloatTable(n) => ("floating-point numbers", n),
        _ => return None,
    })
}

fn pair(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>, place: TextRange, a: Type, b: Type) {
    let Some(((what, n), (other, m))) = elements(a).zip(elements(b)) else { return };
    // Of floats and whole numbers T011 speaks.
    let mixes = matches!(a, Type::FloatTable(_)) != matches!(b, Type::FloatTable(_)) && cx.model.mixes_floats;
    if what != other && !mixes {
        sink.report(place, format!("a table of {n} {what} meets one of {m} {other}"));
    } else if n != m && what == other {
        sink.report(place, format!("a table of {n} {what} meets one of {m}"))
            .note("the manual has operations of two tables, and none that says what becomes of the rest");
    }
}

/// A table of bits against a word.
fn bits(sink: &mut Sink<'_, TextRange>, place: TextRange, table: Type, word: Type) {
    let (Type::BitTable(n), Some(width)) = (table, word.bits().filter(|_| matches!(word, Type::Word | Type::Double)))
    else {
        return;
    };
    if n > width {
        sink.report(place, format!("a table of {n} bits meets an object of {width}"));
    }
}

/// Tables that start where none can.
fn places(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for access in cx.model.accesses.iter().filter(|it| !matches!(it.mode, Mode::Drive(_))) {
        let object = cx.model.object(access.object);
        if !object.ty.is_table() {
            continue;
        }
        if let Some(message) = misplaced(object) {
            sink.report(cx.model.place(access.anchor), message);
        }
    }
}

fn misplaced(object: &Object) -> Option<String> {
    let (place, text) = (&object.footprint, &object.text);
    let (first, last) = (place.start / 16, place.end().saturating_sub(1) / 16);
    let is_system = object.class == Class::System && matches!(object.ty, Type::WordTable(_));
    if is_system && !(SYSTEM_TABLE.contains(&first) && SYSTEM_TABLE.contains(&last)) {
        return Some(format!("`{text}` is no table: only `%SW50` to `%SW53` can be addressed as one (PL7:1045)"));
    }
    let is_odd = matches!(object.ty, Type::Text(_)) && place.start % 16 != 0;
    is_odd.then(|| format!("`{text}` starts at an odd byte: the number of a string is even (PL7:1061)"))
}
