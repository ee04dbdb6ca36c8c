//! PL7 instruction list to the model: the Boolean result, parentheses, the MPS stack, structured blocks.
//!
//! Each sentence starts with an `LD` or an unconditional instruction (PL7:3319), so that no result passes from one
//! sentence to another, and none along a jump.

use crate::syntax::AstNode as _;
use rowan::TextRange;
use smol_str::SmolStr;

use super::builder::index;
use super::chart;
use super::pl7::{self, Kind, Pl7};
use crate::model::UnitModel;
use crate::model::entity::{Entity, Part};
use crate::model::expr::{ExprId, Exprs, ObjectId};
use crate::model::object::{self, Class, Object, Type};
use crate::model::unit::{Leave, Mode, Oddity, OddityKind, Pin};
use crate::syntax::pl7::ast::{self, BracketContent, IlOperand};
use crate::syntax::pl7::instructions::{self, IlOp};
use crate::syntax::{Language, SyntaxElement, SyntaxKind, SyntaxNode, SyntaxToken};
use crate::target;
use crate::target::pl7::block;

pub(super) fn lower(root: SyntaxNode<'_>, text: &str, entity: Entity) -> UnitModel {
    // A receptivity is a list of tests alone (PL7:4713-4749).
    let tests_only = matches!(&entity, Entity::Pl7 { part: Part::Chart(rest), .. } if rest.contains("-->"))
        || is_bare_receptivity(root);
    let mut pl7 = Pl7::new(root, entity, Language::Pl7Il);
    chart::enter_piece(&mut pl7);
    pl7.b.set_back_targets(pl7::back_targets(root, text, Language::Pl7Il));
    let all = ast::Root::cast(root).into_iter().flat_map(ast::Root::sentences);
    sentences(pl7, all, tests_only).0.b.finish()
}

/// Lowers sentences, and gives the lowering back with the result of the last one.
pub(super) fn sentences<'t>(
    pl7: Pl7,
    sentences: impl IntoIterator<Item = ast::Sentence<'t>>,
    tests_only: bool,
) -> (Pl7, Option<ExprId>) {
    let mut lowering = Lowering {
        pl7,
        tests_only,
        result: None,
        test: None,
        parentheses: Vec::new(),
        inside: Vec::new(),
        stack_inside: None,
        stack: Vec::new(),
        mismatches: Vec::new(),
        block: None,
        forgotten: false,
    };
    for sentence in sentences {
        lowering.sentence(&sentence);
    }
    lowering.close_block(None);
    (lowering.pl7, lowering.result)
}

/// One sentence of tests without a heading: what documents print of a receptivity.
fn is_bare_receptivity(root: SyntaxNode<'_>) -> bool {
    let Some(root) = ast::Root::cast(root) else { return false };
    let mut sentences = root.sentences();
    let (Some(only), None) = (sentences.next(), sentences.next()) else { return false };
    root.headings().next().is_none()
        && only
            .instructions()
            .all(|it| !it.is_operation() && it.op().is_none_or(|op| op.info().class == instructions::Class::Test))
}

struct Parenthesis {
    op: IlOp,
    before: Option<ExprId>,
    range: TextRange,
}

/// A `BLK ... OUT_BLK ... END_BLK`.
struct Block {
    /// `None` where the operand is missing or no block.
    object: Option<ObjectId>,
    text: SmolStr,
    range: TextRange,
    outputs: bool,
}

struct Lowering {
    pl7: Pl7,
    tests_only: bool,
    /// The Boolean result; `None` where the sentence has not made one yet.
    result: Option<ExprId>,
    /// Tests whose result nothing has used yet.
    test: Option<TextRange>,
    parentheses: Vec<Parenthesis>,
    /// What stands inside the outermost parenthesis and must not. Reported when it is closed: in one that is not, only
    /// the missing `)` is wrong.
    inside: Vec<Oddity>,
    /// The first of them that uses the stack.
    stack_inside: Option<usize>,
    stack: Vec<(ExprId, TextRange)>,
    /// Jumps that leave values on the stack, with the number of them that were there. Of values that stay there to the
    /// end of the sentence, only that is reported.
    mismatches: Vec<(usize, Oddity)>,
    block: Option<Block>,
    /// Part of the sentence was not understood, or its author left it out: what is missing may be there.
    forgotten: bool,
}

impl Lowering {
    fn sentence(&mut self, sentence: &ast::Sentence) {
        self.pl7.b.next_network();
        self.result = None;
        self.forgotten = false;
        for label in sentence.labels() {
            self.pl7.label(&label);
        }
        for child in sentence.syntax().children_with_tokens() {
            match child {
                SyntaxElement::Token(it) if it.kind() == SyntaxKind::Elision => self.forget(),
                SyntaxElement::Token(_) => {}
                SyntaxElement::Node(it) if it.kind() == SyntaxKind::Error => self.forget(),
                SyntaxElement::Node(it) => {
                    if let Some(instr) = ast::IlInstr::cast(it) {
                        self.instruction(&instr);
                    } else if let Some(label) = ast::LabelDef::cast(it) {
                        let text = label.token().map(|it| SmolStr::new(it.text())).unwrap_or_default();
                        self.in_parentheses(OddityKind::LabelInParentheses, label.syntax().text_range(), &text);
                    }
                }
            }
        }
        self.end_of_sentence();
    }

    /// Something unread stands here: it may use the result, make another, close what is open.
    fn forget(&mut self) {
        self.forgotten = true;
        self.test = None;
        self.result = Some(self.pl7.b.exprs().opaque());
        self.parentheses.clear();
        self.inside.clear();
        self.stack_inside = None;
        self.stack.clear();
        self.mismatches.clear();
    }

    fn end_of_sentence(&mut self) {
        let unclosed = std::mem::take(&mut self.parentheses);
        let inside = std::mem::take(&mut self.inside);
        self.stack_inside = None;
        for it in &unclosed {
            let oddity = self.pl7.b.oddity(OddityKind::UnclosedParenthesis, it.range, "(");
            let first = inside.partition_point(|inner| inner.range.start() < it.range.end());
            if let Some(action) = inside.get(first) {
                oddity.related.push((action.range, "this must not stand inside"));
            }
        }
        let left = self.stack.len();
        for (_, mismatch) in std::mem::take(&mut self.mismatches).into_iter().filter(|it| it.0 > left) {
            self.pl7.b.model.oddities.push(mismatch);
        }
        if let Some(&(_, range)) = self.stack.last() {
            self.pl7.b.oddity(OddityKind::StackLeft(index(left)), range, "MPS");
            self.stack.clear();
        }
        // The tests of a block's inputs may stand in several sentences.
        self.unused_test();
    }

    fn unused_test(&mut self) {
        if let Some(range) = self.test.take()
            && !self.tests_only
            && self.pl7.b.is_reachable()
        {
            self.pl7.b.oddity(OddityKind::TestWithoutAction, range, "");
        }
    }

    /// An unconditional instruction ignores the test before it.
    fn ignored_test(&mut self, by: TextRange) {
        let reported = self.pl7.b.model.oddities.len();
        self.unused_test();
        if let Some(oddity) = self.pl7.b.model.oddities.get_mut(reported) {
            oddity.related.push((by, "this does not depend on it"));
        }
    }

    /// Reports an instruction that uses a result which the sentence has not made (PL7:3319).
    fn needs_result(&mut self, range: TextRange, text: &str) {
        if self.result.is_none() && self.parentheses.is_empty() {
            if self.pl7.b.is_reachable() {
                self.pl7.b.oddity(OddityKind::SentenceStart, range, text);
            }
            self.result = Some(self.pl7.b.exprs().opaque());
        }
    }

    fn instruction(&mut self, instr: &ast::IlInstr) {
        let range = instr.syntax().text_range();
        self.pl7.b.instruction(range);
        let mnemonic = instr.mnemonic();
        if mnemonic.is_none() && instr.close_parenthesis().is_some() {
            self.close(range);
            return;
        }
        if mnemonic.is_none() && instr.bracket().is_some() {
            self.operation(instr, range);
            return;
        }
        let text = mnemonic.map_or("", SyntaxToken::text);
        let Some(op) = IlOp::of_word(text) else {
            // Not understood: it may have made a result, and used one.
            self.result = Some(self.pl7.b.exprs().opaque());
            self.test = None;
            return;
        };
        if !op.info().starts_sequence() && op != IlOp::OutBlk {
            self.needs_result(range, text);
        }
        match op {
            // The grammar has reported it; it is closed all the same.
            IlOp::Ld | IlOp::LdN | IlOp::LdR | IlOp::LdF if instr.open_parenthesis().is_some() => {
                self.combine(op, instr, range);
            }
            IlOp::Ld | IlOp::LdN | IlOp::LdR | IlOp::LdF => {
                if self.parentheses.is_empty() {
                    self.unused_test();
                }
                let value = self.test_operand(op, instr);
                self.result = Some(value);
                self.test = Some(range);
            }
            IlOp::And
            | IlOp::AndN
            | IlOp::AndR
            | IlOp::AndF
            | IlOp::Or
            | IlOp::OrN
            | IlOp::OrR
            | IlOp::OrF
            | IlOp::Xor
            | IlOp::XorN
            | IlOp::XorR
            | IlOp::XorF => self.combine(op, instr, range),
            IlOp::N => {
                let result = self.result();
                let negated = self.pl7.b.exprs().not(result);
                self.result = Some(negated);
                self.test = Some(self.test.map_or(range, |it| it.cover(range)));
            }
            IlOp::Mps | IlOp::Mrd | IlOp::Mpp => self.stack_instruction(op, range, text),
            IlOp::St | IlOp::StN | IlOp::S | IlOp::R => self.store(op, instr, range, text),
            IlOp::In | IlOp::Cu | IlOp::Cd | IlOp::I | IlOp::O | IlOp::U => self.drive(op, instr, range, text),
            IlOp::Blk => self.open_block(instr, range),
            IlOp::OutBlk => match &mut self.block {
                Some(block) => block.outputs = true,
                None => self.structure(range, text, "`OUT_BLK` stands without `BLK`"),
            },
            IlOp::EndBlk => {
                if self.block.take().is_none() {
                    self.structure(range, text, "`END_BLK` stands without `BLK`");
                }
            }
            IlOp::Jmp => {
                self.ignored_test(range);
                self.jump(Exprs::TRUE, instr, range, text);
            }
            IlOp::JmpC | IlOp::JmpCN => {
                let when = self.used(op == IlOp::JmpCN);
                self.jump(when, instr, range, text);
            }
            IlOp::Sr => {
                self.in_parentheses(OddityKind::JumpInParentheses, range, text);
                if let Some(number) = instr.subroutine() {
                    self.pl7.subroutine(number, text, Exprs::TRUE, range, range);
                }
                self.test = None;
                self.result = Some(self.pl7.b.exprs().opaque());
            }
            IlOp::Ret => {
                self.ignored_test(range);
                self.leave(Exprs::TRUE, Leave::Subroutine, range);
            }
            IlOp::RetC | IlOp::RetCN => {
                let when = self.used(op == IlOp::RetCN);
                self.leave(when, Leave::Subroutine, range);
            }
            IlOp::End => {
                self.ignored_test(range);
                self.leave(Exprs::TRUE, Leave::Unit, range);
            }
            IlOp::EndC | IlOp::EndCN => {
                let when = self.used(op == IlOp::EndCN);
                self.leave(when, Leave::Unit, range);
            }
            IlOp::Halt => {
                let when = self.result.unwrap_or(Exprs::TRUE);
                self.test = None;
                self.pl7.halt(when, range);
            }
        }
    }

    fn result(&mut self) -> ExprId {
        match self.result {
            Some(result) => result,
            None => {
                let value = self.pl7.b.exprs().opaque();
                self.result = Some(value);
                value
            }
        }
    }

    /// The result that an action uses.
    fn used(&mut self, negated: bool) -> ExprId {
        self.test = None;
        let result = self.result();
        if negated { self.pl7.b.exprs().not(result) } else { result }
    }

    fn in_parentheses(&mut self, kind: OddityKind, range: TextRange, text: &str) {
        if let Some(open) = self.parentheses.first().map(|it| it.range) {
            let related = vec![(open, "opened here")];
            self.inside.push(Oddity { kind, range, text: text.into(), related });
        }
    }

    fn operand_type(&mut self, message: String, at: TextRange, text: impl Into<SmolStr>) {
        self.pl7.b.oddity(OddityKind::OperandType(message), at, text);
    }

    fn structure(&mut self, range: TextRange, text: &str, message: &str) {
        self.pl7.b.oddity(OddityKind::BlockStructure(message.to_owned()), range, text);
    }

    // Tests.

    fn test_operand(&mut self, op: IlOp, instr: &ast::IlInstr) -> ExprId {
        let modifier = instr.modifier();
        let is_modifier = |letter: &str| modifier.is_some_and(|it| it.text().eq_ignore_ascii_case(letter));
        let edge = match op {
            IlOp::LdR | IlOp::AndR | IlOp::OrR | IlOp::XorR => Some(true),
            IlOp::LdF | IlOp::AndF | IlOp::OrF | IlOp::XorF => Some(false),
            _ if is_modifier("R") => Some(true),
            _ if is_modifier("F") => Some(false),
            _ => None,
        };
        let negated = matches!(op, IlOp::LdN | IlOp::AndN | IlOp::OrN | IlOp::XorN) || is_modifier("N");
        let value = match instr.operand() {
            Some(IlOperand::Object(it)) => {
                let (object, at) = self.pl7.object_ref(&it);
                self.test_object(object, edge, at, op)
            }
            Some(IlOperand::Name(it)) => {
                let (object, at) = self.block_output(&it).unwrap_or_else(|| self.pl7.name_ref(&it));
                self.test_object(object, edge, at, op)
            }
            Some(IlOperand::Literal(it)) => match self.pl7.literal(&it) {
                (value, Kind::Bit) => value,
                // `LD 1` is the immediate bit (PL7:577).
                (value, _) => match self.pl7.b.exprs().get(value) {
                    crate::model::expr::Expr::Int(0) => Exprs::FALSE,
                    crate::model::expr::Expr::Int(1) => Exprs::TRUE,
                    _ => {
                        let at = it.syntax().text_range();
                        let text = it.syntax().text().into_owned();
                        let message =
                            format!("`{}` takes a bit or a comparison, and `{text}` is neither", op.info().mnemonic);
                        self.operand_type(message, at, text);
                        self.pl7.b.exprs().opaque()
                    }
                },
            },
            Some(IlOperand::Bracket(it)) => match it.expr() {
                Some(expr) => match self.pl7.expr(&expr) {
                    (_, Kind::Number | Kind::Float) if !is_elided(&expr) => {
                        let at = it.syntax().text_range();
                        let message =
                            format!("`{}` takes a comparison in its brackets, not a number", op.info().mnemonic);
                        self.operand_type(message, at, it.syntax().text().into_owned());
                        self.pl7.b.exprs().opaque()
                    }
                    (value, _) => value,
                },
                None => self.pl7.b.exprs().opaque(),
            },
            Some(IlOperand::Label(_)) | None => self.pl7.b.exprs().opaque(),
        };
        if negated { self.pl7.b.exprs().not(value) } else { value }
    }

    fn test_object(&mut self, object: ObjectId, edge: Option<bool>, at: TextRange, op: IlOp) -> ExprId {
        if self.pl7.kind(object).is_number() {
            self.takes_a_bit(object, at, op);
            return self.pl7.b.exprs().opaque();
        }
        match edge {
            Some(rising) => self.pl7.b.edge(object, rising, at),
            None => self.pl7.read(object, at),
        }
    }

    fn takes_a_bit(&mut self, object: ObjectId, at: TextRange, op: IlOp) {
        let data = self.pl7.b.model.object(object);
        let message = format!("`{}` takes a bit, and `{}` is {}", op.info().mnemonic, data.text, describe(data.ty));
        let text = data.text.clone();
        self.operand_type(message, at, text);
    }

    /// In the output part of a block, `LD D` reads the block's own output.
    fn block_output(&mut self, it: &ast::NameRef) -> Option<(ObjectId, TextRange)> {
        let block = self.block.as_ref().filter(|it| it.outputs)?;
        let id = block.object?;
        let name = it.name()?;
        let at = name.text_range();
        let is_output = OUTPUTS.iter().any(|output| name.text().eq_ignore_ascii_case(output));
        if !is_output || it.path().len() != name.text().len() {
            return None;
        }
        let address = format!("{}.{}", block.text, name.text());
        let object = match object::pl7::parse(&address) {
            Ok(object) => object,
            Err(_) if self.pl7.b.model.object(id).class == Class::Block => {
                let message = format!("`{}` has no output `{}`", block.text, name.text());
                self.structure(at, name.text(), &message);
                Object::symbol(name.text())
            }
            // The block is named by a symbol.
            Err(_) => Object::symbol(&address),
        };
        Some((self.pl7.b.object(object), at))
    }

    fn combine(&mut self, op: IlOp, instr: &ast::IlInstr, range: TextRange) {
        if instr.open_parenthesis().is_some() {
            let before = self.result;
            self.parentheses.push(Parenthesis { op, before, range });
            let depth = index(self.parentheses.len());
            if depth > target::pl7::PARENTHESIS_DEPTH.value {
                self.in_parentheses(OddityKind::ParenthesisDepth(depth), range, "(");
            }
            self.result = instr.operand().map(|_| self.test_operand(op, instr));
        } else {
            let value = self.test_operand(op, instr);
            let before = self.result();
            self.result = Some(self.apply(op, before, value));
        }
        self.test = Some(self.test.map_or(range, |it| it.cover(range)));
    }

    fn apply(&mut self, op: IlOp, a: ExprId, b: ExprId) -> ExprId {
        let exprs = self.pl7.b.exprs();
        match op {
            IlOp::Or | IlOp::OrN | IlOp::OrR | IlOp::OrF => exprs.or(a, b),
            IlOp::Xor | IlOp::XorN | IlOp::XorR | IlOp::XorF => exprs.xor(a, b),
            _ => exprs.and(a, b),
        }
    }

    fn close(&mut self, range: TextRange) {
        let Some(open) = self.parentheses.pop() else {
            if !self.forgotten {
                self.pl7.b.oddity(OddityKind::UnopenedParenthesis, range, ")");
            }
            return;
        };
        if self.parentheses.is_empty() {
            self.pl7.b.model.oddities.append(&mut self.inside);
            self.stack_inside = None;
        }
        let inner = self.result();
        // The modifier behind the parenthesis belongs to the first operand, not to the whole.
        self.result = Some(match (open.op, open.before) {
            (IlOp::Ld | IlOp::LdN | IlOp::LdR | IlOp::LdF, _) => inner,
            (op, Some(before)) => self.apply(op, before, inner),
            (_, None) => self.pl7.b.exprs().opaque(),
        });
        self.test = Some(self.test.map_or(range, |it| it.cover(range)));
    }

    fn stack_instruction(&mut self, op: IlOp, range: TextRange, text: &str) {
        match self.stack_inside.and_then(|it| self.inside.get_mut(it)) {
            Some(first) => first.related.push((range, "and here")),
            None if self.parentheses.is_empty() => {}
            None => {
                self.stack_inside = Some(self.inside.len());
                self.in_parentheses(OddityKind::StackInParentheses, range, text);
            }
        }
        if op == IlOp::Mps {
            let result = self.result();
            self.stack.push((result, range));
            let depth = index(self.stack.len());
            if depth > target::pl7::STACK_DEPTH.value {
                self.pl7.b.oddity(OddityKind::StackDepth(depth), range, text);
            }
            self.test = None;
            return;
        }
        self.unused_test();
        let top = if op == IlOp::Mpp { self.stack.pop() } else { self.stack.last().copied() };
        self.result = Some(match top {
            Some((value, _)) => value,
            None => {
                if !self.forgotten {
                    self.pl7.b.oddity(OddityKind::StackUnderflow, range, text);
                }
                self.pl7.b.exprs().opaque()
            }
        });
    }

    // Actions.

    fn store(&mut self, op: IlOp, instr: &ast::IlInstr, range: TextRange, text: &str) {
        self.in_parentheses(OddityKind::StoreInParentheses, range, text);
        let place = match instr.operand() {
            Some(IlOperand::Object(it)) => Some(self.pl7.object_ref(&it)),
            Some(IlOperand::Name(it)) => Some(self.pl7.name_ref(&it)),
            Some(IlOperand::Literal(it)) => {
                let at = it.syntax().text_range();
                let text = it.syntax().text().into_owned();
                let message = format!("`{}` writes a bit, and `{text}` is a constant", op.info().mnemonic);
                self.operand_type(message, at, text);
                let _ = self.used(false);
                return;
            }
            Some(IlOperand::Bracket(_) | IlOperand::Label(_)) | None => None,
        };
        let when = self.used(false);
        let Some((object, at)) = place else {
            // `R` and `S` alone drive the inputs of the block that is open.
            let pin = if op == IlOp::R { Pin::Reset } else { Pin::Preset };
            self.drive_open_block(op, pin, when, range, text);
            return;
        };
        let data = self.pl7.b.model.object(object);
        if data.class == Class::Indirect {
            return;
        }
        if data.class == Class::Block && matches!(op, IlOp::S | IlOp::R) {
            let letters = block::of_address(&data.text).map_or("", |it| it.letters);
            let pin = pl7::pin(letters, op.info().mnemonic);
            self.check_pin(object, op, range, text);
            self.pl7.b.drive(object, pin, when, None, at, range);
            return;
        }
        if self.pl7.kind(object).is_number() {
            self.takes_a_bit(object, at, op);
            return;
        }
        if let Some(block) = self.block.as_ref().filter(|it| !it.outputs) {
            let message = format!("`{text}` stands before `OUT_BLK` of `{}`", block.text);
            self.structure(range, text, &message);
        }
        match op {
            IlOp::St => self.pl7.b.assign(object, false, when, at, range),
            IlOp::StN => {
                let value = self.pl7.b.exprs().not(when);
                self.pl7.b.assign(object, true, value, at, range);
            }
            IlOp::S => self.pl7.b.set(object, when, at, range),
            _ => self.pl7.b.reset(object, when, at, range),
        }
    }

    /// `IN %TM1`, `CU %C8`, and the same without operand inside a structured block.
    fn drive(&mut self, op: IlOp, instr: &ast::IlInstr, range: TextRange, text: &str) {
        self.in_parentheses(OddityKind::StoreInParentheses, range, text);
        let pin = pl7::pin("", op.info().mnemonic);
        let place = match instr.operand() {
            Some(IlOperand::Object(it)) => Some(self.pl7.object_ref(&it)),
            Some(IlOperand::Name(it)) => Some(self.pl7.name_ref(&it)),
            _ => None,
        };
        let when = self.used(false);
        match place {
            Some((object, at)) => {
                if !self.is_block(object, op, at) {
                    return;
                }
                self.check_pin(object, op, range, text);
                self.pl7.b.drive(object, pin, when, None, at, range);
            }
            None => self.drive_open_block(op, pin, when, range, text),
        }
    }

    fn drive_open_block(&mut self, op: IlOp, pin: Pin, when: ExprId, range: TextRange, text: &str) {
        let Some(block) = &self.block else { return };
        // Behind `OUT_BLK` the operand is missing, and the grammar has said so.
        let Some(object) = block.object.filter(|_| !block.outputs) else { return };
        let starts = block.text.to_ascii_uppercase().starts_with("%MN");
        let pin = if pin == Pin::Preset && starts { Pin::Start } else { pin };
        self.check_pin(object, op, range, text);
        self.pl7.b.drive(object, pin, when, None, range, range);
    }

    /// Whether an operand is a function block, as far as it shows; reports one that is not.
    fn is_block(&mut self, object: ObjectId, op: IlOp, at: TextRange) -> bool {
        let data = self.pl7.b.model.object(object);
        match data.class {
            Class::Block | Class::Symbol => return true,
            Class::Indirect => return false,
            _ => {}
        }
        let text = data.text.clone();
        let message = format!("`{}` takes a function block, and `{text}` is {}", op.info().mnemonic, describe(data.ty));
        self.operand_type(message, at, text);
        false
    }

    /// Reports an input that the block does not have.
    fn check_pin(&mut self, object: ObjectId, op: IlOp, range: TextRange, text: &str) {
        let data = self.pl7.b.model.object(object);
        let Some(inputs) = inputs_of(&data.text) else { return };
        if !inputs.contains(&op.info().mnemonic) {
            let message = format!("`{}` has no input `{}`", data.text, op.info().mnemonic);
            self.structure(range, text, &message);
        }
    }

    fn open_block(&mut self, instr: &ast::IlInstr, range: TextRange) {
        self.close_block(Some(range));
        let place = match instr.operand() {
            Some(IlOperand::Object(it)) => Some(self.pl7.object_ref(&it)),
            Some(IlOperand::Name(it)) => Some(self.pl7.name_ref(&it)),
            _ => None,
        };
        let place = place.filter(|&(object, at)| self.is_block(object, IlOp::Blk, at));
        let text = place.map_or_else(SmolStr::default, |it| self.pl7.b.model.object(it.0).text.clone());
        if let Some((object, at)) = place {
            self.pl7.b.touch(object, Mode::Drive(Pin::Whole), at);
        }
        self.block = Some(Block { object: place.map(|it| it.0), text, range, outputs: false });
    }

    /// A block that is still open where another starts, or where the unit ends.
    fn close_block(&mut self, next: Option<TextRange>) {
        if let Some(block) = self.block.take() {
            let message = "`BLK` is not closed by `END_BLK`".to_owned();
            let oddity = self.pl7.b.oddity(OddityKind::BlockStructure(message), block.range, "BLK");
            oddity.related.extend(next.map(|it| (it, "another block starts here")));
        }
    }

    /// `[%MW10:=%MW0+100]`: done when the result is 1.
    fn operation(&mut self, instr: &ast::IlInstr, range: TextRange) {
        self.needs_result(range, "[");
        self.in_parentheses(OddityKind::StoreInParentheses, range, "[");
        let when = self.used(false);
        let before = self.pl7.b.path();
        let inside = self.pl7.b.exprs().and(before, when);
        self.pl7.b.enter(inside, None);
        match instr.bracket().and_then(|it| it.content()) {
            Some(BracketContent::Assign(it)) => self.pl7.assignment(&it),
            Some(BracketContent::Call(it)) => self.pl7.call_stmt(&it),
            Some(BracketContent::Expr(it)) => {
                self.pl7.expr(&it);
            }
            None => {}
        }
        self.pl7.b.enter(before, None);
    }

    fn jump(&mut self, when: ExprId, instr: &ast::IlInstr, range: TextRange, text: &str) {
        self.in_parentheses(OddityKind::JumpInParentheses, range, text);
        if let Some(&(_, pushed)) = self.stack.last() {
            let related = vec![(pushed, "pushed here")];
            let oddity = Oddity { kind: OddityKind::StackMismatch, range, text: text.into(), related };
            self.mismatches.push((self.stack.len(), oddity));
        }
        match instr.operand() {
            Some(IlOperand::Label(it)) => self.pl7.jump(it.text(), it.text_range(), when, range),
            Some(IlOperand::Name(it)) => {
                if let Some(name) = it.name() {
                    self.pl7.jump(name.text(), name.text_range(), when, range);
                }
            }
            _ => {}
        }
        if when == Exprs::TRUE {
            self.result = None;
        }
    }

    fn leave(&mut self, when: ExprId, how: Leave, range: TextRange) {
        self.pl7.leave(when, how, range);
        if when == Exprs::TRUE {
            self.result = None;
        }
    }
}

/// Inputs of a function block by its address. How a list drives series 7 timers is not in the manual.
fn inputs_of(address: &str) -> Option<&'static [&'static str]> {
    block::of_address(address).filter(|it| it.letters != "T").map(|it| it.inputs)
}

/// Outputs of the blocks of PL7:977-999, by the letters of their bits.
const OUTPUTS: &[&str] = &["Q", "R", "D", "E", "F"];

/// Whether dots stand in place of an operand (PL7:3124).
fn is_elided(expr: &ast::Expr) -> bool {
    expr.syntax().descendant_tokens().any(|it| it.kind() == SyntaxKind::Elision)
}

fn describe(ty: Type) -> &'static str {
    match ty {
        Type::Bool => "a bit",
        Type::Byte => "a byte",
        Type::Word => "a word",
        Type::Double => "a double word",
        Type::Float => "a floating-point number",
        Type::BitTable(_) => "a table of bits",
        Type::WordTable(_) | Type::DoubleTable(_) | Type::FloatTable(_) => "a table of words",
        Type::Text(_) => "a character string",
        Type::Block => "a function block",
        Type::Unknown => "of another type",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::entity::Task;
    use crate::model::lower::testing::show;
    use crate::model::unit::StatementKind;

    fn part(text: &str, part: Part) -> UnitModel {
        let parse = crate::syntax::pl7::parse_il(text);
        lower(parse.syntax(), text, Entity::Pl7 { task: Task::Mast, section: None, part })
    }

    fn model(text: &str) -> UnitModel {
        assert_eq!(crate::syntax::pl7::parse_il(text).errors(), [], "{text}");
        part(text, Part::Main)
    }

    /// Oddities with the text of their places.
    fn oddities(text: &str) -> Vec<String> {
        let model = part(text, Part::Main);
        let show = |it: &Oddity| format!("{:?} at {}", it.kind, &text[std::ops::Range::<usize>::from(it.range)]);
        model.oddities.iter().map(show).collect()
    }

    /// What each statement does, with the path to it.
    fn statements(text: &str) -> Vec<String> {
        let model = model(text);
        let name = |access: u32| model.object(model.accesses[access as usize].object).text.to_string();
        let mut lines = Vec::new();
        for it in &model.statements {
            let what = match it.kind {
                StatementKind::Assign { access, value } => format!("{} := {}", name(access), show(&model, value)),
                StatementKind::Store { access, value } => format!("{} := {}", name(access), show(&model, value)),
                StatementKind::Set { access, when } => format!("set {} when {}", name(access), show(&model, when)),
                StatementKind::Reset { access, when } => format!("reset {} when {}", name(access), show(&model, when)),
                StatementKind::Drive { access, pin, when, .. } => {
                    format!("{} of {} when {}", pin.describe(), name(access), show(&model, when))
                }
                StatementKind::Jump(jump) => format!("jump when {}", show(&model, model.jumps[jump as usize].when)),
                StatementKind::Call(call) => format!("call {}", model.calls[call as usize].text),
                StatementKind::Return { when, .. } => format!("return when {}", show(&model, when)),
                _ => continue,
            };
            let path = show(&model, it.path);
            lines.push(if path == "true" { what } else { format!("{path}: {what}") });
        }
        lines
    }

    #[test]
    fn chains_are_read_from_left_to_right() {
        // PL7:3327-3345.
        assert_eq!(statements("LD %I1.1\nAND %M0\nOR %M10\nST %Q2.0"), ["%Q2.0 := ((%I1.1 & %M0) | %M10)"]);
        assert_eq!(
            statements("LD %I1.1\nAND %M0\nOR( %M10\nAND %I1.2\n)\nST %Q2.0"),
            ["%Q2.0 := ((%I1.1 & %M0) | (%M10 & %I1.2))"]
        );
        assert_eq!(statements("LDN %M0\nXOR %M1\nN\nSTN %M2"), ["%M2 := (!%M0 ^ %M1)"]);
        assert_eq!(
            statements("LDR %M0\nORF %M1\nS %M2\nR %M3"),
            ["set %M2 when (^%M0 | v%M1)", "reset %M3 when (^%M0 | v%M1)"]
        );
        assert_eq!(statements("LD TRUE\nST %M0\nLD 0\nST %M1"), ["%M0 := true", "%M1 := false"]);
    }

    #[test]
    fn modifiers_belong_to_the_first_operand() {
        // PL7:3199-3222.
        assert_eq!(
            statements("LD %I1.0\nAND ( %I1.1\nOR (N %I1.2\nAND %M3\n)\n)\nST %Q2.0"),
            ["%Q2.0 := (%I1.0 & (%I1.1 | (!%I1.2 & %M3)))"]
        );
        let code = "LD %I1.1\nAND ( %I1.2\nAND %I1.3\nOR (N %I1.5\nAND %I1.6\n)\nAND %I1.4\nOR (N %I1.7\nAND %I1.8\n)\n)\nST %Q2.0";
        assert_eq!(
            statements(code),
            ["%Q2.0 := (%I1.1 & ((((%I1.2 & %I1.3) | (!%I1.5 & %I1.6)) & %I1.4) | (!%I1.7 & %I1.8)))"]
        );
        assert_eq!(
            statements("LD %M0\nOR ([%MW0>100]\nAND (R %M1\n)\n)\nST %M2"),
            ["%M2 := (%M0 | ((%MW0 > 100) & ^%M1))"]
        );
    }

    #[test]
    fn the_stack_gives_back_what_was_pushed() {
        // PL7:3251-3267.
        let code = "LD %I1.0\nAND %M0\nMPS\nAND %I1.1\nST %Q2.0\nMRD\nAND %I1.2\nST %Q2.1\nMPP\nAND %I1.4\nST %Q2.3";
        assert_eq!(
            statements(code),
            [
                "%Q2.0 := ((%I1.0 & %M0) & %I1.1)",
                "%Q2.1 := ((%I1.0 & %M0) & %I1.2)",
                "%Q2.3 := ((%I1.0 & %M0) & %I1.4)"
            ]
        );
        assert_eq!(oddities(code), [""; 0]);
    }

    #[test]
    fn stack_oddities() {
        assert_eq!(oddities("LD %M0\nMPS\nST %M1"), ["StackLeft(1) at MPS"]);
        assert_eq!(
            oddities("! LD %M0\nMPS\nST %M1\nMPP\nST %M2\n! MRD\nST %M3"),
            ["SentenceStart at MRD", "StackUnderflow at MRD"]
        );
        assert_eq!(
            oddities("LD %M0\nMPS\nMPS\nMPS\nMPS\nST %M1\nMPP\nMPP\nMPP\nMPP\nST %M2"),
            ["StackDepth(4) at MPS"]
        );
        // A value that stays there anyhow is the cause; one that a jump alone leaves is not at the end of the sentence.
        assert_eq!(oddities("LD %M0\nMPS\nJMPC %L1\nST %M1"), ["StackLeft(1) at MPS"]);
        assert_eq!(oddities("LD %M0\nMPS\nJMPC %L1\nMPP\nST %M1"), ["StackMismatch at JMPC %L1"]);
    }

    #[test]
    fn what_must_not_stand_in_parentheses() {
        let inside = |what: &str| oddities(&format!("LD %M0\nAND( %M1\n{what}\n)\nST %M2\n! %L1:\nLD %M0\nST %M9"));
        assert_eq!(inside("OR %M5"), [""; 0]);
        assert_eq!(inside("ST %M5"), ["StoreInParentheses at ST %M5"]);
        assert_eq!(inside("[%MW0:=1]"), ["StoreInParentheses at [%MW0:=1]"]);
        assert_eq!(inside("CU %C8"), ["StoreInParentheses at CU %C8"]);
        assert_eq!(inside("JMPC %L1"), ["JumpInParentheses at JMPC %L1"]);
        assert_eq!(inside("SR5"), ["JumpInParentheses at SR5"]);
        assert_eq!(inside("%L5:\nOR %M3"), ["LabelInParentheses at %L5:"]);
        assert_eq!(inside("MPS\nMPP"), ["StackInParentheses at MPS"]);
    }

    #[test]
    fn an_unclosed_parenthesis_is_one_mistake() {
        assert_eq!(
            oddities("! LD %M0\nAND( %M1\nST %M2\nMPS\n! LD %M3\nST %M4"),
            ["UnclosedParenthesis at AND( %M1", "StackLeft(1) at MPS"]
        );
        assert_eq!(oddities("LD %M0\nAND( %M1\nOR( %M2\n)\nST %M3"), ["UnclosedParenthesis at AND( %M1"]);
        assert_eq!(oddities("LD %M0\n)\nST %M3"), ["UnopenedParenthesis at )"]);
    }

    #[test]
    fn nine_levels_are_too_many() {
        let nest = |n: usize| format!("LD %M0\n{}{}ST %M1", "AND( %M2\n".repeat(n), ")\n".repeat(n));
        assert_eq!(oddities(&nest(8)), [""; 0]);
        assert_eq!(oddities(&nest(9)), ["ParenthesisDepth(9) at AND( %M2"]);
    }

    #[test]
    fn sentences_start_with_a_result_and_end_with_an_action() {
        assert_eq!(oddities("! AND %M0\nST %M1\n! ST %M2"), ["SentenceStart at AND %M0", "SentenceStart at ST %M2"]);
        assert_eq!(oddities("! [%MW0:=1]"), ["SentenceStart at [%MW0:=1]"]);
        assert_eq!(oddities("! JMP %L1\n! %L1: SR5\n! RET"), [""; 0]);
        assert_eq!(oddities("LD %M0\nAND %M1\nLD %M2\nST %M3"), ["TestWithoutAction at LD %M0\nAND %M1"]);
        assert_eq!(oddities("LD %M0\nST %M3\nAND %M1"), ["TestWithoutAction at AND %M1"]);
        assert_eq!(oddities("LD %M0\nJMP %L1\n! %L1:\nLD %M1\nST %M2"), ["TestWithoutAction at LD %M0"]);
        assert_eq!(oddities("LD %M0\nMPS\nAND %M1\nMPP\nST %M2"), ["TestWithoutAction at AND %M1"]);
        assert_eq!(oddities("LD %M0\nSR5\n! LD %M1\nIN %TM1\n! LD %M2\nENDC"), [""; 0]);
        let receptivity = part("! LD %M0\nAND %M1", Part::Chart("CHART - PAGE 0 %X(0) --> %X(1)".into()));
        assert_eq!(receptivity.oddities, []);
    }

    #[test]
    fn what_is_not_read_is_not_judged() {
        // PL7:3351-3358 is cut off by dots.
        assert_eq!(oddities("! LD %M0\nJMPC %L10\n! %L10:\nLD %I1.3\nAND %M20\n. . . . ."), [""; 0]);
        assert_eq!(oddities("! LD %M0\nAND( %M1\nMPS\n. . . . .\nMPP\n)\nST %M2"), [""; 0]);
        assert_eq!(oddities("! FOO %M0\nST %M2"), [""; 0]);
        assert_eq!(oddities("! LD %M0\nFOO %M1\n)\nMPP\nST %M2"), [""; 0]);
        assert_eq!(oddities("! LD( %M0\nOR %M1\n)\nST %M2"), [""; 0]);
    }

    #[test]
    fn jumps_merge_at_the_label() {
        let code = "! LD %M0\nJMPC %L10\n! LD %I1.1\nST %Q2.0\n! %L10:\nLD %I1.3\nST %Q2.1";
        assert_eq!(statements(code), ["jump when %M0", "!%M0: %Q2.0 := %I1.1", "%Q2.1 := %I1.3"]);
        let model = model("! JMP %L10\n! LD %I1.1\nST %Q2.0\n! %L10:\nLD %I1.3\nST %Q2.1");
        assert_eq!(model.unreachable.len(), 1);
        let model = super::tests::model("! %L1:\nLD %M0\nST %M1\nJMPC %L1");
        assert_eq!((model.loops.len(), model.loops[0].exits), (1, true));
    }

    #[test]
    fn operations_depend_on_the_result() {
        assert_eq!(statements("LD %M0\n[%MW10:=%MW0+100]\nST %M1"), ["%M0: %MW10 := Add(%MW0, 100)", "%M1 := %M0"]);
        assert_eq!(statements("LD TRUE\n[%MW10:=%MW0+100]"), ["%MW10 := Add(%MW0, 100)"]);
        assert_eq!(statements("LD [%MW10<1000]\nAND %M5\nRETCN"), ["return when !((%MW10 < 1000) & %M5)"]);
    }

    #[test]
    fn both_forms_of_a_block() {
        assert_eq!(
            statements("LD %I1.2\nCU %C8\nLD %M0\nR %C8\nLD %M1\nS %MN2\nLD %M2\nIN %TM1"),
            ["count-up of %C8 when %I1.2", "reset of %C8 when %M0", "start of %MN2 when %M1", "start of %TM1 when %M2"]
        );
        // PL7:3295-3303.
        let code = "! BLK %C8\nLDR %I1.1\nR\nLD %I1.2\nAND %M0\nCU\nOUT_BLK\nLD D\nAND %M1\nST %Q2.4\nEND_BLK";
        assert_eq!(
            statements(code),
            ["reset of %C8 when ^%I1.1", "count-up of %C8 when (%I1.2 & %M0)", "%Q2.4 := (%C8.D & %M1)"]
        );
        assert_eq!(oddities(code), [""; 0]);
        assert_eq!(oddities("! BLK Tempo\nLD %M0\nIN\nOUT_BLK\nLD Q\nST %M1\nEND_BLK"), [""; 0]);
    }

    #[test]
    fn block_oddities() {
        let kinds = |text: &str| -> Vec<String> {
            let oddities = part(text, Part::Main).oddities;
            oddities
                .into_iter()
                .map(|it| match it.kind {
                    OddityKind::BlockStructure(message) | OddityKind::OperandType(message) => message,
                    other => format!("{other:?}"),
                })
                .collect()
        };
        assert_eq!(kinds("LD %M0\nCU %TM1"), ["`%TM1` has no input `CU`"]);
        assert_eq!(kinds("LD %M0\nCU %MW1"), ["`CU` takes a function block, and `%MW1` is a word"]);
        assert_eq!(kinds("BLK %TM1\nLD %M0\nIN\nOUT_BLK\nLD D\nST %M1\nEND_BLK"), ["`%TM1` has no output `D`"]);
        assert_eq!(kinds("BLK %C8\nLD %M0\nST %M1\nEND_BLK"), ["`ST` stands before `OUT_BLK` of `%C8`"]);
        assert_eq!(
            kinds("BLK %C8\nBLK %TM1\nEND_BLK\nEND_BLK"),
            ["`BLK` is not closed by `END_BLK`", "`END_BLK` stands without `BLK`"]
        );
        assert_eq!(kinds("OUT_BLK"), ["`OUT_BLK` stands without `BLK`"]);
        assert_eq!(kinds("BLK %MW0\nLD %M0\nIN\nEND_BLK"), ["`BLK` takes a function block, and `%MW0` is a word"]);
        assert_eq!(
            kinds("LD %MW0\nAND [%MW0+1]\nST 5"),
            [
                "`LD` takes a bit, and `%MW0` is a word",
                "`AND` takes a comparison in its brackets, not a number",
                "`ST` writes a bit, and `5` is a constant"
            ]
        );
    }
}
