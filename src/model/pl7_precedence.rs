//! Expressions of PL7 whose grouping is easily misread, for lack of parentheses (PL7:4048-4088).

use rowan::TextRange;

use super::pl7_kinds::Kinds;
use crate::syntax::AstNode as _;
use crate::syntax::pl7::ast::{BinExpr, BinOp, Expr, UnaryOp};

/// An expression that lacks parentheses.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Doubt {
    pub whole: TextRange,
    /// What is done first, sorted: parentheses belong around each.
    pub first: Vec<TextRange>,
    /// The operators that take part, as written in upper case.
    pub operators: Vec<String>,
}

impl Doubt {
    /// The text of the whole with its parentheses, in one line. `slice` gives the text of a place.
    pub fn regrouped<'t>(&self, slice: impl Fn(TextRange) -> &'t str) -> String {
        let mut edges: Vec<_> = self.first.iter().flat_map(|it| [(it.start(), '('), (it.end(), ')')]).collect();
        edges.sort_by_key(|it| it.0);
        let mut text = String::new();
        let mut at = self.whole.start();
        for (edge, parenthesis) in edges {
            text += slice(TextRange::new(at, edge.max(at)));
            text.push(parenthesis);
            at = edge.max(at);
        }
        text += slice(TextRange::new(at, self.whole.end().max(at)));
        text.split_whitespace().collect::<Vec<_>>().join(" ")
    }
}

/// `NOT a = b`, `NOT a + b`: the `NOT` belongs to `a` alone.
pub fn negated_operand(expr: BinExpr<'_>) -> Option<Doubt> {
    let Expr::Unary(negation) = expr.lhs()? else { return None };
    let (op, operator) = expr.operation()?;
    let is_doubtful = negation.op() == Some(UnaryOp::Not) && op != BinOp::Assign && !op.is_logical();
    is_doubtful.then_some(Doubt {
        whole: expr.syntax().text_range(),
        first: vec![negation.syntax().text_range()],
        operators: vec![operator.text().to_ascii_uppercase()],
    })
}

/// All that should stand in parentheses under one outermost logical operator.
pub fn logical_chain<'t>(kinds: &Kinds<'t>, whole: BinExpr<'t>) -> Option<Doubt> {
    let mut first = Vec::new();
    let mut operators: Vec<String> = Vec::new();
    let mut stack = vec![whole];
    while let Some(expr) = stack.pop() {
        let Some((op, operator)) = expr.operation().filter(|it| it.0.is_logical()) else { continue };
        let (lhs, rhs) = expr.operands();
        for inner in [lhs, rhs] {
            let Some(Expr::Bin(inner)) = inner else { continue };
            if is_doubtful(kinds, expr, op, inner) {
                first.push(inner.syntax().text_range());
                for word in inner.operator().iter().chain([&operator]).map(|it| it.text().to_ascii_uppercase()) {
                    if !operators.contains(&word) {
                        operators.push(word);
                    }
                }
            }
            stack.push(inner);
        }
    }
    first.sort_by_key(|it| (it.start(), it.end()));
    (!first.is_empty()).then(|| Doubt { whole: whole.syntax().text_range(), first, operators })
}

/// Whether an operand of a logical operator should stand in parentheses: it has another logical operator, or is a
/// comparison while the other operand is a number.
fn is_doubtful<'t>(kinds: &Kinds<'t>, whole: BinExpr<'t>, op: BinOp, operand: BinExpr<'t>) -> bool {
    let Some(inner) = operand.op() else { return false };
    if inner.is_logical() {
        return inner != op;
    }
    let (lhs, rhs) = whole.operands();
    inner.is_comparison() && lhs.into_iter().chain(rhs).any(|it| kinds.of(it).is_integer())
}
