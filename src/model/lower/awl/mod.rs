//! Statement list to the model: symbolic execution of the RLO, the nesting stack, the accumulators and the data block
//! registers, instruction by instruction. STEP 5 is read into the same machine; `step5` has what is its own.
//!
//! Facts about the machine (S7-300/400, two accumulators: S7:364-366): a logic string starts with a *first check*,
//! which overwrites the RLO; `=`, `S`, `R`, timer and counter instructions, conditional jumps and block calls end it,
//! and after them the RLO stays readable. `L`, `T` and arithmetic neither read nor change it (S7:357). `SET`, `CLR` and
//! comparisons overwrite it (S7:447). A conditional jump or block end leaves RLO 1 behind.

mod accumulators;
mod calls;
mod flow;
mod operands;
mod relay;
mod rlo;
mod step5;

use rowan::TextRange;
use rustc_hash::{FxBuildHasher, FxHashMap};
use smol_str::SmolStr;

use super::builder::{Builder, index};
use super::width::Data;
use crate::model::UnitModel;
use crate::model::entity::Entity;
use crate::model::expr::{ExprId, Exprs, Operator};
use crate::model::layout::{Elementary, Layout};
use crate::model::unit::{Counting, Hollow, HollowKind, LoopKind, Mode, OddityKind, Pin, Pulse, StatementKind};
use crate::syntax::awl::ast;
use crate::syntax::awl::instruction::{ArithOp, Conversion, JumpIf, LogicOp, NumberType, Op, Shift};
use crate::syntax::{AstNode as _, Language, SyntaxElement, SyntaxKind, SyntaxNode};
use crate::target;

use accumulators::{Accumulator, Load, comparison};
use calls::{OpenBlock, instance_of, is_of_tia_portal};
use flow::{Arrival, BackTargets, label, label_operand};
use operands::{Operand, bare_text};
use relay::Relay;
use rlo::{First, LogicString, Nest, OrStage, OrTerm, Rlo, RloState};

/// Lowers one block or listing.
pub fn lower(root: SyntaxNode<'_>, entity: Entity, language: Language) -> UnitModel {
    let heading = heading(root);
    let mut machine = Machine {
        b: Builder::new(entity, language, heading, root.text_range().len()),
        language,
        rlo: Rlo { state: RloState::FromCaller, value: Exprs::TRUE },
        first: First::Yes,
        or: None,
        nesting: Vec::new(),
        string: None,
        accumulators: [Accumulator::entry(), Accumulator::entry()],
        loads: Vec::new(),
        br: Exprs::FALSE,
        relay: Relay::default(),
        open: OpenBlock::default(),
        arrivals: FxHashMap::default(),
        counted: FxHashMap::default(),
        back_targets: BackTargets::default(),
        operands: FxHashMap::with_capacity_and_hasher(usize::from(root.text_range().len()) / 64, FxBuildHasher),
        declared: FxHashMap::default(),
        temporary: Layout::default(),
        instance: Layout::default(),
        closed: false,
        last_load: None,
        jump_list: false,
        capitals: matches!(language, Language::Step5(_)) && step5::writes_capitals(root),
        processed: false,
        modified: false,
        writing: false,
        on_words: false,
    };
    machine.br = machine.b.exprs().opaque();
    machine.rlo.value = machine.b.exprs().opaque();
    for child in root.children() {
        match child.kind() {
            SyntaxKind::Block | SyntaxKind::Listing => machine.block(child),
            _ => {}
        }
    }
    machine.finish()
}

struct Machine {
    b: Builder,
    language: Language,
    rlo: Rlo,
    /// Whether the next check is a first check.
    first: First,
    /// AND terms before an `O` without operand.
    or: Option<OrTerm>,
    nesting: Vec<Nest>,
    string: Option<LogicString>,
    accumulators: [Accumulator; 2],
    loads: Vec<Load>,
    br: ExprId,
    relay: Relay,
    open: OpenBlock,
    arrivals: FxHashMap<SmolStr, Arrival>,
    /// Of labels that jumps lead back to: what accumulator 1 holds when control comes from above, and on each turn.
    counted: FxHashMap<SmolStr, (ExprId, ExprId)>,
    back_targets: BackTargets,
    operands: FxHashMap<SmolStr, Operand>,
    /// Names that the block declares, in lower case.
    declared: FxHashMap<SmolStr, Option<Elementary>>,
    /// Where its own variables lie: in the local data, and in the instance of a function block.
    temporary: Layout,
    instance: Layout,
    /// The block's end was read, so that what is left over is really lost.
    closed: bool,
    /// The instruction before, when it was a load.
    last_load: Option<u32>,
    /// The unconditional jumps read now are the entries of a jump list.
    jump_list: bool,
    /// STEP 5: mnemonics are written in capitals, so that what is not is a symbol.
    capitals: bool,
    /// STEP 5: the instruction before adds a word to the operand of this one; of the next one.
    modified: bool,
    processed: bool,
    /// The instruction writes to its operand.
    writing: bool,
    /// The instruction works on bytes or words.
    on_words: bool,
}

impl Machine {
    fn block(&mut self, block: SyntaxNode<'_>) {
        self.closed = block.kind() == SyntaxKind::Block;
        self.declarations(block);
        self.b.model.instance_of = instance_of(block);
        self.b.model.of_tia_portal = is_of_tia_portal(block);
        for init in block.children().filter_map(ast::DataInit::cast) {
            self.initial_value(init.value());
        }
        self.back_targets = BackTargets::of(block, self.language);
        self.b.set_back_targets(self.back_targets.labels.keys().cloned().collect());
        for network in block.children().filter(|it| it.kind() == SyntaxKind::Network) {
            self.b.next_network();
            for element in network.children_with_tokens() {
                match element.kind() {
                    SyntaxKind::Instr => {
                        if let Some(instr) = element.into_node().and_then(ast::Instr::cast) {
                            self.instruction(&instr);
                        }
                    }
                    SyntaxKind::Error | SyntaxKind::Elision => self.forget(),
                    _ => {}
                }
            }
        }
        self.hollows(block);
    }

    /// Notes networks with nothing below their head. A remark there is part of the block.
    fn hollows(&mut self, block: SyntaxNode<'_>) {
        let code = [SyntaxKind::Instr, SyntaxKind::Error, SyntaxKind::Elision, SyntaxKind::Comment];
        // The head of the last network, while nothing was found below it.
        let mut bare: Option<TextRange> = None;
        for element in block.children_with_tokens() {
            match element {
                SyntaxElement::Token(it) if it.kind() == SyntaxKind::Comment => bare = None,
                SyntaxElement::Token(_) => {}
                SyntaxElement::Node(it) => {
                    self.hollow(bare.take());
                    let is_bare = !it.children_with_tokens().any(|it| code.contains(&it.kind()));
                    let header = ast::Network::cast(it).filter(|_| is_bare).and_then(ast::Network::header);
                    let head = header.and_then(|it| it.syntax().descendant_tokens().find(|it| !it.kind().is_trivia()));
                    bare = head.map(|it| it.text_range());
                }
            }
        }
        self.hollow(bare);
    }

    fn hollow(&mut self, head: Option<TextRange>) {
        if let Some(range) = head {
            self.b.model.hollows.push(Hollow { kind: HollowKind::Network, range });
        }
    }

    fn finish(mut self) -> UnitModel {
        let end = self.b.model.anchors.first().copied().unwrap_or_default();
        if self.closed {
            if self.b.is_reachable() {
                self.discard(end);
            }
            self.hand_over();
        } else {
            self.keep_accumulators();
        }
        for nest in &self.nesting {
            self.b.oddity(OddityKind::UnclosedParenthesis, nest.range, "(");
        }
        self.dead_loads();
        self.b.finish()
    }

    /// Something unread stands here: nothing is known any more, and nothing is lost.
    fn forget(&mut self) {
        self.string = None;
        let value = self.b.exprs().opaque();
        self.rlo = Rlo { state: RloState::Known, value };
        self.first = First::Yes;
        self.or = None;
        self.br = self.b.exprs().opaque();
        self.keep_accumulators();
        self.accumulators = [Accumulator::unknown(), Accumulator::unknown()];
        self.open.shared = Some(None);
        self.b.model.has_gaps = true;
        self.b.wipe_by_call();
        if !self.b.is_reachable() {
            // A label may be part of it.
            let path = self.b.exprs().opaque();
            self.b.enter(path, None);
        }
        self.last_load = None;
        self.jump_list = false;
    }

    fn instruction(&mut self, instr: &ast::Instr) {
        if let Some((text, range)) = label(instr) {
            self.last_load = None;
            self.jump_list = false;
            self.label(&text, range);
        }
        let Some(ast::Extent { range, has_error }) = instr.extent() else { return };
        let Some(op) = op_of(instr, self.language).filter(|_| !has_error) else {
            self.b.instruction(range);
            self.forget();
            return;
        };
        match op {
            Op::Nop | Op::Display | Op::BlockEnd => self.b.idle_instruction(),
            _ => self.b.instruction(range),
        }
        if !matches!(op, Op::Load | Op::LoadBcd) {
            self.last_load = None;
        }
        self.modified = std::mem::take(&mut self.processed);
        self.writing = op == Op::Transfer;
        self.on_words = matches!(op, Op::Load | Op::Transfer);
        self.jump_list &= op == Op::Jump(JumpIf::Always);
        match op {
            Op::And | Op::AndNot | Op::OrNot | Op::Xor | Op::XorNot => self.bit_check(op, instr, range),
            Op::Or if instr.operand().is_some() => self.bit_check(op, instr, range),
            Op::Or => {
                // Where the next check is a first one, there is no term yet.
                let base = self.rlo_value();
                if self.first == First::No {
                    self.rlo.value = base;
                    self.or = Some(OrTerm { base, stage: OrStage::Open });
                }
            }
            Op::AndOpen | Op::AndNotOpen | Op::OrOpen | Op::OrNotOpen | Op::XorOpen | Op::XorNotOpen => {
                let value = self.rlo_value();
                let nest = Nest {
                    op,
                    range,
                    rlo: self.rlo,
                    first: self.first,
                    or: self.or.take(),
                    string: self.string.take(),
                };
                self.nesting.push(nest);
                self.rlo.value = value;
                let depth = index(self.nesting.len());
                if !self.is_step5() && depth > target::step7::PARENTHESIS_DEPTH.value {
                    self.b.oddity(OddityKind::ParenthesisDepth(depth), range, "(");
                }
                self.first = First::Yes;
            }
            Op::Close => self.close(range),
            Op::Assign => {
                let rlo = self.use_rlo(range, instr);
                if let Some((object, at)) = self.object_operand(instr) {
                    let value = self.under_relay(rlo);
                    self.b.assign(object, false, value, at, range);
                    self.note_write(object);
                }
                self.limit();
            }
            Op::Set | Op::Reset => self.set_or_reset(op, instr, range),
            Op::NegateRlo => {
                let rlo = self.rlo_value();
                self.rlo.value = self.b.exprs().not(rlo);
                if let Some(or) = self.or.as_mut().filter(|it| it.stage == OrStage::Term) {
                    or.stage = OrStage::Negated;
                }
            }
            Op::SetRlo | Op::ClearRlo => {
                self.discard(range);
                self.rlo = Rlo { state: RloState::Known, value: Exprs::bool(op == Op::SetRlo) };
                self.first = First::Yes;
                self.or = None;
            }
            Op::SaveRlo => {
                // SAVE after a call keeps what the called block answered: its use is the point. It touches nothing but BR:
                // the logic string goes on.
                self.br = self.rlo_value();
                self.string = None;
            }
            Op::EdgePositive | Op::EdgeNegative => {
                let was_first = self.first != First::No;
                let of = self.use_rlo(range, instr);
                let value = self.b.exprs().opaque();
                if let Some((memory, at)) = self.object_operand(instr) {
                    self.b.touch(memory, Mode::EdgeMemory, at);
                    self.note_write(memory);
                    let (statement, path) = (index(self.b.model.statements.len()), self.b.path());
                    let rising = op == Op::EdgePositive;
                    self.b.model.pulses.push(Pulse { value, of, memory, rising, statement, path });
                }
                self.or = None;
                if was_first {
                    self.string = None;
                }
                self.overwrite(value, range);
            }
            Op::Load | Op::LoadBcd => self.load_instruction(instr, range),
            Op::Transfer => {
                self.ignores_rlo(range, instr);
                let value = self.accumulator(0);
                if let Some((object, at)) = self.object_operand(instr) {
                    let declared = self.elementary(object);
                    let data = self.accumulators[0].data.as_ref();
                    let misplaced = data.and_then(|it| it.misplaced(self.b.model.object(object), declared));
                    self.note_width(misplaced, range, instr);
                    let value = self.stored_under_relay(value);
                    self.b.store(object, value, at, range);
                    self.note_write(object);
                }
            }
            Op::Timer(_) => {
                let rlo = self.use_rlo(range, instr);
                let duration = self.accumulator(0);
                if let Some((object, at)) = self.object_operand(instr) {
                    self.b.drive(object, Pin::Start, rlo, Some(duration), at, range);
                }
                self.limit();
            }
            Op::Enable | Op::CountUp | Op::CountDown => {
                let rlo = self.use_rlo(range, instr);
                let pin = match op {
                    Op::CountUp => Pin::Up,
                    Op::CountDown => Pin::Down,
                    _ => Pin::Enable,
                };
                if let Some((object, at)) = self.object_operand(instr) {
                    self.b.drive(object, pin, rlo, None, at, range);
                }
                self.limit();
            }
            Op::Compare(relation, ty) => {
                self.fit(ty, range, instr);
                let (left, right) = self.two_operands(range, instr);
                let value = self.b.exprs().compare(comparison(relation), left, right);
                self.discard(range);
                self.or = None;
                self.first = First::Yes;
                self.overwrite(value, range);
            }
            Op::Arithmetic(op, ty) => {
                self.ignores_rlo(range, instr);
                self.fit(ty, range, instr);
                let data = Data::computed(op, ty, [&self.accumulators[0].data, &self.accumulators[1].data]);
                let (left, right) = self.two_operands(range, instr);
                let operator = match op {
                    ArithOp::Add => Operator::Add,
                    ArithOp::Sub => Operator::Sub,
                    ArithOp::Mul => Operator::Mul,
                    ArithOp::Div => Operator::Div,
                };
                let value = self.b.exprs().binary(operator, left, right);
                self.result(value);
                self.accumulators[0].data = Some(data).filter(|_| !self.is_step5());
            }
            Op::Modulo => {
                self.ignores_rlo(range, instr);
                let (left, right) = self.two_operands(range, instr);
                let value = self.b.exprs().binary(Operator::Rem, left, right);
                self.result(value);
            }
            Op::AddConstant => {
                self.ignores_rlo(range, instr);
                let left = self.accumulator(0);
                let right = self.constant_operand(instr);
                let value = self.b.exprs().binary(Operator::Add, left, right);
                self.result(value);
            }
            Op::WordLogic(logic, _) => {
                self.ignores_rlo(range, instr);
                let operator = match logic {
                    LogicOp::And => Operator::And,
                    LogicOp::Or => Operator::Or,
                    LogicOp::Xor => Operator::Xor,
                };
                let (left, right) = if instr.operand().is_some() {
                    (self.accumulator(0), self.constant_operand(instr))
                } else {
                    self.two_operands(range, instr)
                };
                let value = self.b.exprs().binary(operator, left, right);
                self.result(value);
            }
            Op::Shift(shift) => {
                self.ignores_rlo(range, instr);
                if instr.operand().is_none()
                    && !matches!(shift, Shift::RotateLeftThroughCc1 | Shift::RotateRightThroughCc1)
                {
                    // How far is in accumulator 2.
                    self.want_two(range, instr);
                    self.use_loads(1);
                }
                self.opaque_result();
            }
            Op::Convert(by) => {
                self.ignores_rlo(range, instr);
                let data = Data::converted(by, self.accumulators[0].data.as_ref());
                if matches!(by, Conversion::OnesComplementInt | Conversion::OnesComplementDint) {
                    let value = self.accumulator(0);
                    let all = self.b.exprs().int(-1);
                    let value = self.b.exprs().binary(Operator::Xor, value, all);
                    self.result(value);
                } else {
                    self.opaque_result();
                }
                self.accumulators[0].data = data.filter(|_| !self.is_step5());
            }
            Op::Real(_) => {
                self.ignores_rlo(range, instr);
                let misfit = self.accumulators[0].data.as_ref().and_then(|it| it.misfit(NumberType::Real));
                self.note_width(misfit, range, instr);
                self.opaque_result();
            }
            Op::Increment | Op::Decrement => {
                self.ignores_rlo(range, instr);
                let left = self.accumulator(0);
                let right = self.constant_operand(instr);
                let operator = if op == Op::Increment { Operator::Add } else { Operator::Sub };
                let value = self.b.exprs().binary(operator, left, right);
                self.result(value);
            }
            Op::SwapAccumulators => self.accumulators.swap(0, 1),
            Op::Push => {
                self.lose(1, range);
                self.accumulators[1] = self.accumulators[0].clone();
            }
            Op::Pop => {
                self.lose(0, range);
                self.accumulators[0] = self.accumulators[1].clone();
            }
            Op::Enter | Op::Leave => {
                self.keep_accumulators();
                self.accumulators = [Accumulator::unknown(), Accumulator::unknown()];
            }
            Op::LoadAddressRegister(_) => self.address_register(instr),
            Op::AddAddressRegister(_) => self.address_register(instr),
            Op::TransferAddressRegister(_) => {
                if let Some((object, at)) = self.object_operand(instr) {
                    let value = self.b.exprs().opaque();
                    self.b.store(object, value, at, range);
                    self.note_write(object);
                } else if instr.operand().is_none() {
                    let value = self.b.exprs().opaque();
                    self.load(value, range, mnemonic_text(instr));
                    // What a register holds is there for the taking: losing it loses nothing.
                    self.use_loads(0);
                }
            }
            // What STEP 7 makes of a `CALL` stands between `BLD 1` and `BLD 2` in a print of compiled code (measured). It
            // keeps the RLO, whatever that is.
            Op::Display if self.rlo.state != RloState::Known => {
                if instr.operand().is_some_and(|it| bare_text(&it) == "1") {
                    let value = self.b.exprs().opaque();
                    self.rlo = Rlo { state: RloState::Known, value };
                }
            }
            Op::SwapAddressRegisters | Op::Nop | Op::Display => {}
            Op::Call | Op::CallUnconditional | Op::CallConditional => self.call(instr, op, range),
            Op::BlockEnd | Op::BlockEndUnconditional => {
                self.closed = true;
                self.end(Exprs::TRUE, range);
            }
            Op::BlockEndConditional => {
                let when = self.use_rlo(range, instr);
                self.limit();
                self.rlo = Rlo { state: RloState::Known, value: Exprs::TRUE };
                self.end(when, range);
            }
            Op::OpenDb => self.open_block(instr, range),
            Op::SwapDb => {
                self.open.shared = Some(None);
                self.b.model.opens_instance = true;
            }
            Op::McrOpen => {
                let rlo = self.use_rlo(range, instr);
                self.limit();
                self.open_relay(rlo);
                self.b.statement(StatementKind::Other, range);
            }
            Op::TestBit(_)
            | Op::SetAlways
            | Op::ResetAlways
            | Op::Generate
            | Op::Process
            | Op::Stop
            | Op::Control
            | Op::LoadRegister
            | Op::TransferRegister => self.step5_instruction(op, instr, range),
            Op::McrClose => {
                // The RLO stays readable; the next check is a first one.
                self.rlo.value = self.rlo_value();
                self.or = None;
                self.first = First::Yes;
                self.relay.close();
            }
            Op::McrActivate => self.relay.active = Exprs::TRUE,
            Op::McrDeactivate => self.relay.active = Exprs::FALSE,
            Op::Jump(condition) => self.jump_instruction(condition, instr, range),
            Op::JumpList => {
                self.use_loads(0);
                let when = self.b.exprs().opaque();
                self.jump(instr, when, range);
                self.jump_list = true;
            }
            Op::Loop => {
                let left = self.accumulator(0);
                self.opaque_result();
                let when = self.b.exprs().opaque();
                let before = self.b.model.loops.len();
                self.jump(instr, when, range);
                let counted = label_operand(instr).and_then(|it| self.counted.get(&it.0).copied());
                // LOOP counts down to 0, which a plain jump does not.
                for it in &mut self.b.model.loops[before..] {
                    it.kind = LoopKind::For;
                    it.counting = counted.map(|(entry, turn)| Counting::Down { entry, turn, left });
                }
            }
        }
    }
}

/// The block's header, or its first instruction.
fn heading(root: SyntaxNode<'_>) -> TextRange {
    let block = root.children().find(|it| matches!(it.kind(), SyntaxKind::Block | SyntaxKind::Listing));
    let header = block.as_ref().and_then(|it| it.children().find_map(ast::BlockHeader::cast));
    match header {
        Some(header) => header.range(),
        None => root.descendants().find_map(ast::Instr::cast).map(|it| it.range()).unwrap_or_default(),
    }
}

/// What an instruction does; `None` for a label alone and for an unknown mnemonic.
fn op_of(instr: &ast::Instr, language: Language) -> Option<Op> {
    match language {
        Language::Step5(mnemonics) => crate::syntax::step5::instruction::op(*instr, mnemonics),
        Language::Awl(mnemonics) => instr.op(mnemonics),
        _ => None,
    }
}

fn mnemonic_text(instr: &ast::Instr) -> SmolStr {
    instr.mnemonic().map(|it| it.text).unwrap_or_default()
}

#[cfg(test)]
mod testing;
#[cfg(test)]
mod tests;
