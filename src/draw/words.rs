//! Code in a few words, as it stands beside a step or a transition.

use std::fmt::Write as _;

use crate::model::UnitModel;
use crate::model::expr::{Expr, ExprId, Exprs, ObjectId, Operator};
use crate::model::unit::{Pin, StatementKind};
use crate::syntax::pl7::ast::Sentence;
use crate::syntax::{AstNode as _, SyntaxKind, SyntaxNode};

/// The text of a comment, without what encloses it.
pub(super) fn comment(text: &str) -> Option<&str> {
    let text = text.trim_start_matches("(*").trim_end_matches("*)").trim();
    (!text.is_empty()).then_some(text)
}

/// The first comment among a node's own tokens.
pub(super) fn own_comment(node: SyntaxNode<'_>) -> Option<&str> {
    node.tokens().filter(|it| it.kind() == SyntaxKind::Comment).find_map(|it| comment(it.text()))
}

/// The code of a node, comments left out, each line with single blanks.
pub(super) fn code(node: SyntaxNode<'_>) -> String {
    let mut out = String::new();
    let mut is_start = true;
    let mut has_blank = false;
    for token in node.descendant_tokens() {
        match token.kind() {
            SyntaxKind::Newline => is_start = true,
            // What begins a sentence says nothing here.
            SyntaxKind::SentenceStart | SyntaxKind::SentenceEnd | SyntaxKind::Bang => has_blank = true,
            kind if kind.is_trivia() => has_blank = true,
            _ => {
                if is_start && !out.is_empty() {
                    out.push('\n');
                } else if has_blank && !is_start {
                    out.push(' ');
                }
                (is_start, has_blank) = (false, false);
                out.push_str(token.text());
            }
        }
    }
    out
}

/// The code of sentences, one under the other.
pub(super) fn sentences<'t>(sentences: impl Iterator<Item = Sentence<'t>>) -> String {
    let texts = sentences.map(|it| code(it.syntax()));
    texts.filter(|it| !it.is_empty()).collect::<Vec<_>>().join("\n")
}

/// What statements of rungs do, with the anchors that say where, in their order.
pub(super) fn statements(model: &UnitModel) -> Vec<(u32, String)> {
    let mut found = Vec::new();
    for it in &model.statements {
        let access = match it.kind {
            StatementKind::Assign { access, .. }
            | StatementKind::Set { access, .. }
            | StatementKind::Reset { access, .. }
            | StatementKind::Store { access, .. }
            | StatementKind::Drive { access, .. } => model.accesses.get(access as usize),
            _ => None,
        };
        let name = || access.map_or_else(String::new, |it| model.object(it.object).text.to_string());
        let when = |text: String, when: ExprId| match model.exprs.get(when) {
            Expr::Bool(true) => text,
            _ => format!("{text} when {}", condition(model, when)),
        };
        let (anchor, text) = match it.kind {
            StatementKind::Assign { value, .. } | StatementKind::Store { value, .. } => {
                (access.map(|it| it.anchor), format!("{} := {}", name(), condition(model, value)))
            }
            StatementKind::Set { when: it, .. } => (access.map(|it| it.anchor), when(format!("SET {}", name()), it)),
            StatementKind::Reset { when: it, .. } => {
                (access.map(|it| it.anchor), when(format!("RESET {}", name()), it))
            }
            StatementKind::Drive { pin, when: it, .. } => {
                let pin = if pin == Pin::Whole { String::new() } else { format!(" {}", pin.describe()) };
                (access.map(|it| it.anchor), when(format!("{}{pin}", name()), it))
            }
            StatementKind::Call(at) => match model.calls.get(at as usize) {
                Some(call) => (Some(call.anchor), when(call.text.to_string(), call.when)),
                None => continue,
            },
            _ => continue,
        };
        found.extend(anchor.map(|it| (it, text)));
    }
    found.sort_by_key(|it| it.0);
    found
}

/// A condition or value, written out as far as it is short.
pub(super) fn condition(model: &UnitModel, id: ExprId) -> String {
    all_of(&model.exprs, &|it| model.object(it).text.as_str(), &[id])
}

/// Conditions that are to hold together, written as one. `name`: what an object is called.
pub(super) fn all_of<'n>(exprs: &Exprs, name: &dyn Fn(ObjectId) -> &'n str, parts: &[ExprId]) -> String {
    let mut writer = Writer { exprs, name, out: String::new(), left: MOST };
    let strength = if parts.len() > 1 { AND } else { 0 };
    for (at, part) in parts.iter().enumerate() {
        if at > 0 {
            writer.out.push_str(" AND ");
        }
        writer.write(*part, strength, 0);
    }
    writer.out
}

/// Parts of an expression that are written, and how deep they may lie.
const MOST: u32 = 80;
const DEEPEST: u32 = 40;

/// How strongly `AND` binds.
const AND: u8 = 3;

struct Writer<'a, 'n> {
    exprs: &'a Exprs,
    name: &'a dyn Fn(ObjectId) -> &'n str,
    out: String,
    left: u32,
}

impl Writer<'_, '_> {
    /// `strength`: how strongly the operator around it binds.
    fn write(&mut self, id: ExprId, strength: u8, depth: u32) {
        if self.left == 0 || depth > DEEPEST {
            self.out.push('…');
            return;
        }
        self.left -= 1;
        let (exprs, name) = (self.exprs, self.name);
        match exprs.get(id) {
            Expr::Bool(value) => self.out.push_str(if *value { "TRUE" } else { "FALSE" }),
            Expr::Int(value) => {
                let _ = write!(self.out, "{value}");
            }
            Expr::Float(bits) => {
                let _ = write!(self.out, "{}", f64::from_bits(*bits));
            }
            Expr::Text(text) => self.out.push_str(text),
            Expr::Read { object, .. } => self.out.push_str(name(*object)),
            Expr::Edge { object, rising, .. } => {
                self.out.push_str(if *rising { "RE " } else { "FE " });
                self.out.push_str(name(*object));
            }
            Expr::Not(it) => {
                self.out.push_str("NOT ");
                self.write(*it, 4, depth + 1);
            }
            Expr::Negate(it) => {
                self.out.push('-');
                self.write(*it, 7, depth + 1);
            }
            Expr::Or(a, b) => self.pair(" OR ", 1, strength, (*a, *b), depth),
            Expr::Xor(a, b) => self.pair(" XOR ", 2, strength, (*a, *b), depth),
            Expr::And(a, b) => self.pair(" AND ", AND, strength, (*a, *b), depth),
            Expr::Compare(comparison, a, b) => self.pair(comparison.as_str(), 5, strength, (*a, *b), depth),
            Expr::Binary(operator, a, b) => {
                let (text, own) = match operator {
                    Operator::Add => ("+", 6),
                    Operator::Sub => ("-", 6),
                    Operator::Mul => ("*", 7),
                    Operator::Div => ("/", 7),
                    Operator::Rem => (" REM ", 7),
                    Operator::And => (" AND ", 5),
                    Operator::Or => (" OR ", 5),
                    Operator::Xor => (" XOR ", 5),
                };
                // What binds as strongly is read from the left; operations on words of one kind alone need no parentheses.
                let is_same = |it: ExprId| matches!(exprs.get(it), Expr::Binary(of, ..) if of == operator);
                let is_logic = matches!(operator, Operator::And | Operator::Or | Operator::Xor);
                let left = own + u8::from(is_logic && !is_same(*a));
                let right = own + u8::from(!is_logic || !is_same(*b));
                self.enclosed(own < strength, |it| {
                    it.write(*a, left, depth + 1);
                    it.out.push_str(text);
                    it.write(*b, right, depth + 1);
                });
            }
            Expr::Call(name, arguments) => {
                self.out.push_str(name);
                self.out.push('(');
                for (at, it) in arguments.iter().enumerate() {
                    if at > 0 {
                        self.out.push(',');
                    }
                    self.write(*it, 0, depth + 1);
                }
                self.out.push(')');
            }
            Expr::Opaque(_) => self.out.push('…'),
        }
    }

    fn pair(&mut self, text: &str, own: u8, strength: u8, (a, b): (ExprId, ExprId), depth: u32) {
        self.enclosed(own < strength, |it| {
            it.write(a, own, depth + 1);
            it.out.push_str(text);
            it.write(b, own, depth + 1);
        });
    }

    fn enclosed(&mut self, is_enclosed: bool, write: impl FnOnce(&mut Self)) {
        if is_enclosed {
            self.out.push('(');
        }
        write(self);
        if is_enclosed {
            self.out.push(')');
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::entity::Entity;
    use crate::model::lower;
    use crate::syntax::{self, Language};

    #[test]
    fn values_are_written_as_they_are_read() {
        for value in [
            "%MW1-(%MW2-%MW3)",
            "%MW1-%MW2-%MW3",
            "%MW1*(%MW2/%MW3)",
            "%MW1*%MW2/%MW3",
            "(%MW1+%MW2)*%MW3",
            "%MW1 AND (%MW2 OR %MW3)",
            "(%MW1 OR %MW2) AND %MW3",
            "%MW1 AND %MW2 AND %MW3",
        ] {
            let text = format!("! %MW0 := {value};");
            let parse = syntax::parse(Language::Pl7St, &text);
            let model = lower::lower(parse.syntax(), &text, Entity::Listing, Language::Pl7St);
            let found = statements(&model);
            assert_eq!(found.first().map(|it| it.1.clone()), Some(format!("%MW0 := {value}")));
        }
    }
}
