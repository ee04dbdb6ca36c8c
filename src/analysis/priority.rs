//! What makes one receptivity wait for others: the text of `AND NOT (first)`, where it has a place for it.
//!
//! What the others ask is written anew from their meaning, so that each may be in another language.

use super::Site;
use super::conditions::{Answer, Space};
use super::reach::{Guarded, Net};
use crate::model::chart::Room;
use crate::model::expr::{Expr, ExprId, Operator};

/// Conditions nested deeper than this are not written.
const DEEPEST: u32 = 16;

/// Texts to put in the place of others, after which a transition is crossed only when none of the others is. `None` where
/// that cannot be written at its place, or the transition would never be crossed.
pub fn give_way(net: &Net<'_, '_>, crossing: usize, others: &[usize]) -> Option<Vec<(Site, String)>> {
    let guard = |at: usize| match net.crossings.get(at)?.guard {
        Guarded::By(guard) => Some(guard),
        Guarded::Never | Guarded::Unknown => None,
    };
    let space = net.space();
    let own = guard(crossing)?;
    let others: Vec<ExprId> = others.iter().map(|it| guard(*it)).collect::<Option<_>>()?;
    let wanted: Vec<(ExprId, bool)> = [(own, true)].into_iter().chain(others.iter().map(|it| (*it, false))).collect();
    if !matches!(space.solve(&wanted), Answer::Possible(_)) {
        return None;
    }
    let transition = net.transition(crossing);
    let site = |anchor: u32| Site { unit: transition.unit, anchor };
    Some(match transition.it.room? {
        Room::Expression { before, behind, binds } => {
            let terms: Option<String> =
                others.iter().map(|it| Some(format!(" AND NOT {}", operand(space, *it)?))).collect();
            let (terms, behind) = (terms?, site(behind));
            if binds {
                vec![(behind, terms)]
            } else {
                vec![(site(before), "(".to_owned()), (behind, format!("){terms}"))]
            }
        }
        Room::List { behind } => {
            let mut text = String::new();
            for it in &others {
                instructions(&Tests::new(space, *it, false, DEEPEST)?, &mut text)?;
            }
            vec![(site(behind), text)]
        }
        Room::Link { at, cells } => {
            let mut contacts = Vec::new();
            for it in &others {
                series(&Tests::new(space, *it, false, DEEPEST)?, &mut contacts)?;
            }
            let left = cells.checked_sub(u32::try_from(contacts.len()).ok()?)?;
            match left {
                0 => {}
                1 => contacts.push("H_LINK".to_owned()),
                _ => contacts.push(format!("H_LINK({left})")),
            }
            vec![(site(at), contacts.join(","))]
        }
    })
}

/// An expression of structured text, in parentheses where it is more than an object.
fn operand(space: Space<'_>, id: ExprId) -> Option<String> {
    let text = expression(space, id, DEEPEST)?;
    Some(if matches!(space.exprs.get(id), Expr::Read { .. } | Expr::Int(_)) { text } else { format!("({text})") })
}

fn expression(space: Space<'_>, id: ExprId, deepest: u32) -> Option<String> {
    let deepest = deepest.checked_sub(1)?;
    let operand = |id: ExprId| {
        let text = expression(space, id, deepest)?;
        Some(if matches!(space.exprs.get(id), Expr::Read { .. } | Expr::Int(_)) { text } else { format!("({text})") })
    };
    // A chain is written without parentheses.
    let link = |id: ExprId, is_same: fn(&Expr) -> bool| {
        if is_same(space.exprs.get(id)) { expression(space, id, deepest) } else { operand(id) }
    };
    let is_and: fn(&Expr) -> bool = |it| matches!(it, Expr::And(..));
    let is_or: fn(&Expr) -> bool = |it| matches!(it, Expr::Or(..));
    Some(match *space.exprs.get(id) {
        Expr::Read { object, .. } => space.objects.get(object)?.text.to_string(),
        Expr::Edge { object, rising, .. } => {
            format!("{} {}", if rising { "RE" } else { "FE" }, space.objects.get(object)?.text)
        }
        // What is a pattern of bits beyond this is not written in decimal.
        Expr::Int(value) => i16::try_from(value).ok()?.to_string(),
        Expr::Not(a) => format!("NOT {}", operand(a)?),
        Expr::And(a, b) => format!("{} AND {}", link(a, is_and)?, link(b, is_and)?),
        Expr::Or(a, b) => format!("{} OR {}", link(a, is_or)?, link(b, is_or)?),
        Expr::Xor(a, b) => format!("{} XOR {}", operand(a)?, operand(b)?),
        Expr::Compare(op, a, b) => format!("{} {} {}", operand(a)?, op.as_str(), operand(b)?),
        Expr::Binary(op, a, b) => {
            let op = match op {
                Operator::Add => "+",
                Operator::Sub => "-",
                Operator::Mul => "*",
                Operator::Div => "/",
                _ => return None,
            };
            format!("{} {op} {}", operand(a)?, operand(b)?)
        }
        _ => return None,
    })
}

/// A condition in which only tests are negated.
enum Tests {
    /// A bit: its text, and whether it is tested for 1.
    Bit(String, bool),
    /// The letter behind the instruction, and the bit.
    Edge(char, String),
    Comparison(String),
    All(Vec<Self>),
    Any(Vec<Self>),
}

impl Tests {
    /// `value`: whether the condition is to hold.
    fn new(space: Space<'_>, id: ExprId, value: bool, deepest: u32) -> Option<Self> {
        let deepest = deepest.checked_sub(1)?;
        let text = |object| Some(space.objects.get(object)?.text.to_string());
        Some(match *space.exprs.get(id) {
            Expr::Not(a) => Self::new(space, a, !value, deepest)?,
            Expr::Read { object, .. } => Self::Bit(text(object)?, value),
            // There is no test for the absence of an edge.
            Expr::Edge { object, rising, .. } if value => Self::Edge(if rising { 'R' } else { 'F' }, text(object)?),
            Expr::Compare(op, a, b) => {
                let op = if value { op } else { op.negated() };
                Self::Comparison(format!("[{} {} {}]", operand(space, a)?, op.as_str(), operand(space, b)?))
            }
            Expr::And(a, b) | Expr::Or(a, b) => {
                let is_and = matches!(space.exprs.get(id), Expr::And(..)) == value;
                let mut parts = Vec::new();
                for it in [a, b] {
                    match (Self::new(space, it, value, deepest)?, is_and) {
                        (Self::All(inner), true) | (Self::Any(inner), false) => parts.extend(inner),
                        (other, _) => parts.push(other),
                    }
                }
                if is_and { Self::All(parts) } else { Self::Any(parts) }
            }
            _ => return None,
        })
    }

    fn is_one(&self) -> bool {
        !matches!(self, Self::All(_) | Self::Any(_))
    }

    /// A test of a list: `AND` with what follows it; in parentheses that it opens.
    fn instruction(&self, name: &str, opens: bool) -> Option<String> {
        let (modifier, operand) = match self {
            Self::Bit(text, true) => (String::new(), text),
            Self::Bit(text, false) => ("N".to_owned(), text),
            Self::Edge(letter, text) => (letter.to_string(), text),
            Self::Comparison(text) => (String::new(), text),
            Self::All(_) | Self::Any(_) => return None,
        };
        Some(if opens { format!(" {name}({modifier} {operand}") } else { format!(" {name}{modifier} {operand}") })
    }
}

/// Instructions behind a list that ask for the tests as well. A list is evaluated from left to right: inside of parentheses,
/// what stands first takes in no more than itself.
fn instructions(tests: &Tests, out: &mut String) -> Option<()> {
    match tests {
        Tests::All(parts) => parts.iter().try_for_each(|it| instructions(it, out))?,
        Tests::Any(parts) => {
            let tests_of = |it: &'_ Tests| -> Option<Vec<String>> {
                let list = match it {
                    Tests::All(inner) => inner.iter().collect(),
                    other => vec![other],
                };
                list.iter().enumerate().map(|(at, it)| it.instruction("AND", at == 0)).collect()
            };
            let (singles, chains): (Vec<&Tests>, Vec<&Tests>) = parts.iter().partition(|it| it.is_one());
            let mut chains = chains.into_iter();
            let mut singles = singles.into_iter();
            let first = chains.next().or_else(|| singles.next())?;
            out.push_str(&tests_of(first)?.concat());
            for it in singles {
                out.push_str(&it.instruction("OR", false)?);
            }
            for chain in chains {
                let inner = tests_of(chain)?.concat();
                out.push_str(&inner.replacen(" AND(", " OR(", 1));
                out.push_str(" )");
            }
            out.push_str(" )");
        }
        one => out.push_str(&one.instruction("AND", false)?),
    }
    Some(())
}

/// Contacts in series that ask for the tests.
fn series(tests: &Tests, out: &mut Vec<String>) -> Option<()> {
    match tests {
        Tests::All(parts) => parts.iter().try_for_each(|it| series(it, out)),
        Tests::Bit(text, value) => {
            out.push(format!("{}({text})", if *value { "OPEN_CONTACT" } else { "CLOSED_CONTACT" }));
            Some(())
        }
        Tests::Edge(..) | Tests::Comparison(_) | Tests::Any(_) => None,
    }
}
