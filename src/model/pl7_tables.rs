//! Tables of PL7: where two meet, or one meets a word, and where one can lie (PL7:1001-1061).

use super::object::{Class, Object, Type};
use super::pl7_kinds::Kinds;
use crate::syntax::pl7::ast::{AssignStmt, BinExpr, CallExpr, Expr};
use crate::syntax::pl7::functions;

/// System words that a table may lie in (PL7:1045).
const SYSTEM_TABLE: std::ops::RangeInclusive<u32> = 50..=53;

/// Why two operands do not fit one another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Misfit {
    /// Number and name of the elements of both.
    Elements((u32, &'static str), (u32, &'static str)),
    /// Name of the elements of both, and their numbers.
    Lengths(&'static str, u32, u32),
    /// Bits of a table, and of the word that it meets.
    Bits(u32, u32),
}

/// The target and the value of an assignment, where one of them is a table.
pub fn of_assignment<'t>(kinds: &Kinds<'t>, it: AssignStmt<'t>) -> Option<(Type, Type)> {
    let (Some(target), Some(value)) = it.sides() else { return None };
    let a = kinds.type_of(target)?;
    // A word takes the table itself, and not what an operation makes of it.
    if !a.is_table() && !matches!(value, Expr::Object(_) | Expr::Paren(_)) {
        return None;
    }
    let b = shape(kinds, value)?;
    (a.is_table() || b.is_table()).then_some((a, b))
}

/// Two tables that an operator joins.
pub fn of_operation<'t>(kinds: &Kinds<'t>, it: BinExpr<'t>) -> Option<(Type, Type)> {
    let a = kinds.type_of(it.lhs()?).filter(|it| it.is_table())?;
    let b = kinds.type_of(it.rhs()?).filter(|it| it.is_table())?;
    Some((a, b))
}

/// Two tables that a function takes element by element.
pub fn of_call<'t>(kinds: &Kinds<'t>, it: CallExpr<'t>) -> Option<(Type, Type)> {
    it.function().filter(|it| takes_a_pair(it))?;
    let mut tables = it.arguments().into_iter().flatten().filter_map(|it| kinds.type_of(it));
    let pair = (tables.next()?, tables.next()?);
    (tables.next().is_none() && pair.0.is_table() && pair.1.is_table()).then_some(pair)
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
fn shape<'t>(kinds: &Kinds<'t>, mut expr: Expr<'t>) -> Option<Type> {
    loop {
        expr = match expr {
            Expr::Paren(it) => it.expr()?,
            Expr::Bin(it) if it.op().is_some_and(|op| !op.is_comparison()) => it.lhs()?,
            Expr::Call(it) if matches!(it.function()?.result, Some(functions::Kind::BitTable)) => {
                it.arguments().into_iter().next()??
            }
            other => return kinds.type_of(other),
        };
    }
}

/// What the elements of a table are, and how many there are.
fn elements(ty: Type) -> Option<(u32, &'static str)> {
    Some(match ty {
        Type::BitTable(n) => (n, "bits"),
        Type::WordTable(n) => (n, "words"),
        Type::DoubleTable(n) => (n, "double words"),
        Type::FloatTable(n) => (n, "floating-point numbers"),
        _ => return None,
    })
}

/// Why two operands that meet do not fit, of which one is a table at least.
pub fn misfit(a: Type, b: Type) -> Option<Misfit> {
    if let (Some(first), Some(second)) = (elements(a), elements(b)) {
        return match (first, second) {
            ((_, what), (_, other)) if what != other => Some(Misfit::Elements(first, second)),
            ((n, what), (m, _)) if n != m => Some(Misfit::Lengths(what, n, m)),
            _ => None,
        };
    }
    let (Type::BitTable(n), word @ (Type::Word | Type::Double)) = (if a.is_table() { (a, b) } else { (b, a) }) else {
        return None;
    };
    let width = word.bits()?;
    (n > width).then_some(Misfit::Bits(n, width))
}

/// Why a table cannot lie where it does, as the end of a sentence.
pub fn misplaced(object: &Object) -> Option<&'static str> {
    let place = &object.footprint;
    let (first, last) = (place.start / 16, place.end().saturating_sub(1) / 16);
    match object.ty {
        Type::WordTable(_) if object.class == Class::System => {
            let is_allowed = SYSTEM_TABLE.contains(&first) && SYSTEM_TABLE.contains(&last);
            (!is_allowed).then_some("is no table: only `%SW50` to `%SW53` can be addressed as one (PL7:1045)")
        }
        Type::Text(_) if !place.start.is_multiple_of(16) => {
            Some("starts at an odd byte: the number of a string is even (PL7:1061)")
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::object::pl7;

    #[test]
    fn what_fits() {
        use Type::{BitTable, Double, DoubleTable, Text, Word, WordTable};

        for (a, b) in [
            (WordTable(5), WordTable(5)),
            (BitTable(16), Word),
            (Double, BitTable(32)),
            (WordTable(5), Word),
            (Text(4), Text(8)),
            (Text(4), WordTable(2)),
        ] {
            assert_eq!(misfit(a, b), None, "{a:?} {b:?}");
        }
        assert_eq!(misfit(WordTable(5), WordTable(4)), Some(Misfit::Lengths("words", 5, 4)));
        let kinds = Misfit::Elements((5, "words"), (5, "double words"));
        assert_eq!(misfit(WordTable(5), DoubleTable(5)), Some(kinds));
        assert_eq!(misfit(Word, BitTable(17)), Some(Misfit::Bits(17, 16)));
        assert_eq!(misfit(BitTable(33), Double), Some(Misfit::Bits(33, 32)));
    }

    #[test]
    fn where_tables_lie() {
        let is_misplaced = |address: &str| misplaced(&pl7::parse(address).unwrap()).is_some();
        for address in ["%SW50:4", "%MB10:3", "%MW5:3", "%M3:5"] {
            assert!(!is_misplaced(address), "{address}");
        }
        for address in ["%SW49:2", "%SW50:5", "%MB11:3"] {
            assert!(is_misplaced(address), "{address}");
        }
    }
}
