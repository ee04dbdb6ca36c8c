//! Kinds of values of PL7 expressions, as far as addresses, constants and the table of functions tell.

use crate::syntax::AstNode as _;
use std::cell::RefCell;

use rustc_hash::FxHashMap;

use super::literal::{self, Value};
use super::object::{self, Type};
use super::unit::UnitModel;
use crate::syntax::pl7::ast::{BinOp, Expr, Literal, UnaryOp};
use crate::syntax::pl7::functions;
use crate::syntax::{SyntaxKind, SyntaxNode};

/// What kind of value an expression has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Kind {
    Bit,
    Word,
    Double,
    /// A whole number whose width its spelling does not say.
    Integer,
    Float,
    BitTable,
    /// Words or double words.
    IntegerTable,
    FloatTable,
    Text,
    Block,
    /// A symbol, an operand with a mistake, or a mixture of kinds.
    Unknown,
}

impl Kind {
    /// Kind of an object.
    pub fn of_type(ty: Type) -> Self {
        match ty {
            Type::Bool => Self::Bit,
            Type::Byte | Type::Word => Self::Word,
            Type::Double => Self::Double,
            Type::Float => Self::Float,
            Type::BitTable(_) => Self::BitTable,
            Type::WordTable(_) | Type::DoubleTable(_) => Self::IntegerTable,
            Type::FloatTable(_) => Self::FloatTable,
            Type::Text(_) => Self::Text,
            Type::Block => Self::Block,
            Type::Unknown => Self::Unknown,
        }
    }

    fn of_parameter(kind: functions::Kind) -> Self {
        match kind {
            functions::Kind::Bit => Self::Bit,
            functions::Kind::Word => Self::Word,
            functions::Kind::Double => Self::Double,
            functions::Kind::Integer => Self::Integer,
            functions::Kind::Float => Self::Float,
            functions::Kind::BitTable => Self::BitTable,
            functions::Kind::WordTable | functions::Kind::DoubleTable | functions::Kind::IntegerTable => {
                Self::IntegerTable
            }
            functions::Kind::FloatTable => Self::FloatTable,
            functions::Kind::Text => Self::Text,
            functions::Kind::Block => Self::Block,
            functions::Kind::Number | functions::Kind::BitOrBlock | functions::Kind::Channel | functions::Kind::Any => {
                Self::Unknown
            }
        }
    }

    /// A float, or a table of them.
    pub fn is_float(self) -> bool {
        matches!(self, Self::Float | Self::FloatTable)
    }

    /// A word or double word, or a table of them.
    pub fn is_integer(self) -> bool {
        matches!(self, Self::Word | Self::Double | Self::Integer | Self::IntegerTable)
    }

    fn is_table(self) -> bool {
        matches!(self, Self::IntegerTable | Self::FloatTable)
    }

    /// Whether one is a float and the other a whole number: nothing converts between them (PL7:4094).
    pub fn mixes_with(self, other: Self) -> bool {
        self.is_float() && other.is_integer() || self.is_integer() && other.is_float()
    }

    pub fn describe(self) -> &'static str {
        match self {
            Self::Bit => "a bit",
            Self::Word => "a word",
            Self::Double => "a double word",
            Self::Integer => "a whole number",
            Self::Float => "a floating-point number",
            Self::BitTable => "a table of bits",
            Self::IntegerTable => "a table of words",
            Self::FloatTable => "a table of floating-point numbers",
            Self::Text => "a character string",
            Self::Block => "a function block",
            Self::Unknown => "of another type",
        }
    }
}

/// Kinds of the expressions of a tree, as they are asked for.
#[derive(Debug)]
pub struct Kinds<'t> {
    model: &'t UnitModel,
    /// Of operations: those of a chain are asked for one by one.
    known: RefCell<FxHashMap<SyntaxNode<'t>, Kind>>,
    /// Of objects whose address alone does not tell: several rules ask for each.
    types: RefCell<FxHashMap<SyntaxNode<'t>, Option<Type>>>,
}

impl<'t> Kinds<'t> {
    /// Of the tree that the model was made from.
    pub fn new(model: &'t UnitModel) -> Self {
        Self { model, known: RefCell::default(), types: RefCell::default() }
    }

    /// The tree's height is limited by the parser.
    pub fn of(&self, expr: Expr<'t>) -> Kind {
        match expr {
            Expr::Name(_) => Kind::Unknown,
            Expr::Literal(it) => literal_kind(it),
            Expr::Object(_) => self.type_of(expr).map_or(Kind::Unknown, Kind::of_type),
            Expr::Paren(it) => self.operand(it.expr()),
            Expr::Unary(it) => match it.op() {
                Some(UnaryOp::Re | UnaryOp::Fe) => Kind::Bit,
                _ => self.operand(it.operand()),
            },
            Expr::Bin(it) => match it.op() {
                Some(op) if op.is_comparison() => Kind::Bit,
                Some(BinOp::Assign) | None => Kind::Unknown,
                Some(_) => {
                    if let Some(kind) = self.known.borrow().get(&it.syntax()) {
                        return *kind;
                    }
                    let (a, b) = it.operands();
                    let kind = join(self.operand(a), self.operand(b));
                    self.known.borrow_mut().insert(it.syntax(), kind);
                    kind
                }
            },
            Expr::Call(it) => {
                let Some(function) = it.function() else { return Kind::Unknown };
                match function.result {
                    // The result is of the operand's kind: `SQRT`, `ABS`, `SHL` (PL7:3603-3642).
                    Some(functions::Kind::Number | functions::Kind::Integer) => {
                        match self.operand(it.arguments().into_iter().next().flatten()) {
                            kind @ (Kind::Word | Kind::Double | Kind::Integer | Kind::Float) => kind,
                            Kind::IntegerTable => Kind::Integer,
                            _ => Kind::Unknown,
                        }
                    }
                    Some(result) => Kind::of_parameter(result),
                    None => Kind::Unknown,
                }
            }
        }
    }

    fn operand(&self, expr: Option<Expr<'t>>) -> Kind {
        expr.map_or(Kind::Unknown, |it| self.of(it))
    }

    /// Size and form of a direct object, behind parentheses; `None` for any other expression.
    pub fn type_of(&self, mut expr: Expr<'t>) -> Option<Type> {
        while let Expr::Paren(it) = expr {
            expr = it.expr()?;
        }
        let Expr::Object(it) = expr else { return None };
        let address = it.address();
        if it.syntax().is_leaf()
            && let Some(id) = self.model.address(&address)
        {
            return Some(self.model.object(id).ty);
        }
        *self.types.borrow_mut().entry(it.syntax()).or_insert_with(|| {
            let object = match it.index() {
                Some(_) => object::pl7::parse_indexed(&address, it.suffix().as_deref()),
                None => object::pl7::parse(&address),
            };
            object.ok().map(|it| it.ty)
        })
    }

    /// Kind that a function asks for at a position, and whether it says so in the manual we have.
    pub fn wanted(function: &functions::Function, position: usize) -> Kind {
        let parameter = function.parameters.get(position).filter(|_| function.line != 0);
        parameter.map_or(Kind::Unknown, |it| Kind::of_parameter(it.kind))
    }
}

fn literal_kind(it: Literal<'_>) -> Kind {
    it.token().map_or(Kind::Unknown, |token| match token.kind() {
        SyntaxKind::CharString => Kind::Text,
        _ => match literal::parse_pl7(token.text()) {
            Ok(Value::Bool(_)) => Kind::Bit,
            Ok(Value::Int { .. }) => Kind::Integer,
            Ok(Value::Real(_)) => Kind::Float,
            _ => Kind::Unknown,
        },
    })
}

/// Kind of an arithmetic or logical operation.
fn join(a: Kind, b: Kind) -> Kind {
    if a == Kind::Bit && b == Kind::Bit {
        return Kind::Bit;
    }
    let is_float = a.is_float() && b.is_float();
    if !(is_float || a.is_integer() && b.is_integer()) {
        return Kind::Unknown;
    }
    // An operation with a double word is done in double words (PL7:4100-4114).
    match (a.is_table() || b.is_table(), is_float) {
        (true, true) => Kind::FloatTable,
        (true, false) => Kind::IntegerTable,
        (false, true) => Kind::Float,
        (false, false) => {
            [Kind::Double, Kind::Word].into_iter().find(|it| [a, b].contains(it)).unwrap_or(Kind::Integer)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::entity::{Entity, Part, Task};
    use crate::model::lower;
    use crate::syntax::Language;
    use crate::syntax::pl7::ast;

    fn kind(value: &str) -> Kind {
        let parse = crate::syntax::pl7::parse_st(&format!("! Sym := {value};"));
        assert_eq!(parse.errors(), [], "{value}");
        let root = parse.syntax();
        let entity = Entity::Pl7 { task: Task::Mast, section: None, part: Part::Main };
        let model = lower::lower(root, &parse.syntax().text(), entity, Language::Pl7St);
        let kinds = Kinds::new(&model);
        let mut assignments = root.descendants().filter_map(ast::AssignStmt::cast);
        let statement = assignments.next().expect("an assignment");
        let value: Option<Expr> = statement.children().nth(1);
        kinds.of(value.expect("a value"))
    }

    #[test]
    fn operands_say_what_they_are() {
        for (value, wanted) in [
            ("%MW0", Kind::Word),
            ("%MD0", Kind::Double),
            ("%MF0", Kind::Float),
            ("%M0", Kind::Bit),
            ("%MW0:X3", Kind::Bit),
            ("%MW10[%MW2]", Kind::Word),
            ("%MW10[%MW2]:5", Kind::IntegerTable),
            ("%MF10:4", Kind::FloatTable),
            ("%M10:4", Kind::BitTable),
            ("%MB10:4", Kind::Text),
            ("%TM2.P", Kind::Word),
            ("'abc'", Kind::Text),
            ("12", Kind::Integer),
            ("16#FF", Kind::Integer),
            ("1.5", Kind::Float),
            ("TRUE", Kind::Bit),
            ("Speed", Kind::Unknown),
            ("T#5s", Kind::Unknown),
        ] {
            assert_eq!(kind(value), wanted, "{value}");
        }
    }

    #[test]
    fn operations_follow_their_operands() {
        for (value, wanted) in [
            ("%MW0 + %MW2 * 3", Kind::Word),
            ("%MW0 + %MD2", Kind::Double),
            ("-%MF0 / 2.0", Kind::Float),
            ("%MF0 * %MW2", Kind::Unknown),
            ("%MF0 * Speed", Kind::Unknown),
            ("%MF0 > 5.0", Kind::Bit),
            ("NOT %MW3", Kind::Word),
            ("NOT (%M0 AND %M1)", Kind::Bit),
            ("RE %I1.0", Kind::Bit),
            ("%MW0:10 + 5", Kind::IntegerTable),
            ("SQRT(%MF14)", Kind::Float),
            ("SQRT(%MW14)", Kind::Word),
            ("INT_TO_REAL(%MW1) + 1.0", Kind::Float),
            ("REAL_TO_INT(%MF1) + 1", Kind::Word),
            ("SUM(%MD0:5)", Kind::Integer),
            ("Unheard(%MW1)", Kind::Unknown),
        ] {
            assert_eq!(kind(value), wanted, "{value}");
        }
    }
}
