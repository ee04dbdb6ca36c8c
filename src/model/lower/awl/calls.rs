//! Calls, and the data blocks that are open.

use rowan::TextRange;
use smol_str::SmolStr;

use super::Machine;
use super::accumulators::Accumulator;
use super::operands::{Operand, bare_text, constant_type, first_kind, is_indexed};
use super::rlo::{First, Rlo, RloState};
use super::step5::block_text;
use crate::model::entity::{BlockKind, BlockName};
use crate::model::expr::{Exprs, ObjectId};
use crate::model::object::{self, Class};
use crate::model::unit::{Argument, Call, Callee, Formal, Mode, OddityKind, Passed, StatementKind};
use crate::syntax::awl::ast;
use crate::syntax::awl::instruction::Op;
use crate::syntax::{AstNode as _, Mnemonics, SyntaxKind, SyntaxNode};

/// What is known of the data block registers.
#[derive(Debug, Clone, Default)]
pub(super) struct OpenBlock {
    pub(super) shared: Option<Option<BlockName>>,
    pub(super) reported: bool,
}

impl Machine {
    /// An object that lies in the open data block, named by that block where it is known.
    pub(super) fn resolve(&mut self, object: ObjectId, range: TextRange) -> ObjectId {
        let data = &self.b.model.objects[object.0 as usize];
        match &data.footprint.area {
            object::Area::OpenData => match &self.open.shared {
                Some(Some(name)) => {
                    let mut data = data.clone();
                    data.footprint.area = object::Area::Data(name.clone());
                    self.b.object(data)
                }
                Some(None) => object,
                None => {
                    // A block of STEP 5 finds its caller's open; organization blocks have no caller.
                    let is_inherited = self.is_step5() && self.b.model.entity.block_kind() != Some(BlockKind::Ob);
                    let is_first = !std::mem::replace(&mut self.open.reported, true);
                    if is_first && !is_inherited && self.b.is_reachable() {
                        let text = data.text.clone();
                        self.b.oddity(OddityKind::DataBlockNotOpen, range, text);
                    }
                    object
                }
            },
            // A full address opens its block.
            object::Area::Data(name) => {
                self.open.shared = Some(Some(name.clone()));
                object
            }
            _ => {
                if let Some((name, _)) = object::step7::field(data) {
                    self.open.shared = Some(Some(name));
                }
                object
            }
        }
    }

    pub(super) fn call(&mut self, instr: &ast::Instr, op: Op, range: TextRange) {
        let when = match op {
            Op::CallConditional => {
                let when = self.use_rlo(range, instr);
                self.limit();
                when
            }
            _ => {
                self.ignores_rlo(range, instr);
                self.discard(range);
                Exprs::TRUE
            }
        };
        let mut operands = instr.operands();
        let Some(callee_node) = operands.next() else { return };
        let callee_text = block_text(&callee_node);
        let instance_node = operands.next();
        let has_index = is_indexed(&callee_node);
        let declared = self.declared.contains_key(callee_text.trim_start_matches('#').to_lowercase().as_str());
        let callee = match first_kind(&callee_node) {
            _ if has_index || self.modified => Callee::Unknown,
            Some(SyntaxKind::LocalName) => Callee::LocalInstance(callee_text.clone()),
            _ if declared => Callee::LocalInstance(callee_text.clone()),
            _ => match block_name(&callee_text) {
                Some(name) => Callee::Block(name),
                None => Callee::Unknown,
            },
        };
        let system = matches!(&callee, Callee::Block(BlockName::Number(kind, _)) if kind.is_system());
        let instance = instance_node.as_ref().and_then(|it| block_name(&bare_text(it)));
        let mut arguments = Vec::new();
        for arg in instr.args() {
            let Some(value) = arg.value() else { continue };
            let range = value.range();
            let name = arg.name().map(|it| SmolStr::new(it.text()));
            let given = match self.operand(&value) {
                Operand::Object(object) => {
                    let object = self.resolve(object, range);
                    let mode = match &name {
                        Some(name) if name.eq_ignore_ascii_case("RET_VAL") => Mode::Output,
                        _ => Mode::InOut,
                    };
                    let is_value = !matches!(self.b.model.objects[object.0 as usize].class, Class::CodeBlock);
                    if is_value {
                        let access = self.b.touch(object, mode, range);
                        self.b.model.accesses[access as usize].parameter = name.clone().map(Formal::Name);
                    }
                    Passed::Object(object)
                }
                Operand::Constant(_) | Operand::Other => {
                    let text = bare_text(&value);
                    // A pointer to an area: the called block reads or writes there, and how much is not known here.
                    if points_to_area(&text) {
                        self.b.model.reads_indirectly = true;
                        self.b.model.writes_indirectly = true;
                    }
                    constant_type(&text).map_or(Passed::Other, Passed::Constant)
                }
            };
            let anchor = self.b.anchor(arg.name().map_or(range, |it| it.text_range()));
            arguments.push(Argument { name, given, anchor, text: bare_text(&value) });
        }
        let anchor = self.b.anchor(callee_node.range());
        if let Some(node) = &instance_node {
            // Follows the callee's: see `FactCall::instance_anchor`.
            self.b.anchor(node.range());
        }
        let call = Call {
            callee,
            text: callee_text,
            statement: 0,
            anchor,
            when,
            instance,
            instance_range: instance_node.map(ast::Operand::range),
            arguments,
            actuals: Vec::new(),
            full: op == Op::Call,
            too_close: None,
        };
        let answers: Vec<ObjectId> = call
            .arguments
            .iter()
            .filter(|it| it.name.as_ref().is_some_and(|it| it.eq_ignore_ascii_case("RET_VAL")))
            .filter_map(|it| match it.given {
                Passed::Object(object) => Some(object),
                _ => None,
            })
            .collect();
        self.b.call(call, range);
        if !system {
            self.b.wipe_by_call();
        }
        if when == Exprs::TRUE {
            for object in answers {
                self.b.settle(object);
            }
        }
        self.keep_accumulators();
        self.accumulators = [Accumulator::unknown(), Accumulator::unknown()];
        let value = self.b.exprs().opaque();
        self.rlo = Rlo { state: RloState::AfterCall, value };
        self.br = self.b.exprs().opaque();
        self.first = First::Yes;
        self.or = None;
        self.string = None;
    }

    pub(super) fn open_block(&mut self, instr: &ast::Instr, range: TextRange) {
        let Some(node) = instr.operand() else { return };
        let text = block_text(&node);
        let upper = text.to_ascii_uppercase();
        if upper.starts_with("DI") && upper[2..].starts_with(|it: char| it.is_ascii_digit() || it == '[') {
            self.b.model.opens_instance = true;
            return;
        }
        let has_index = is_indexed(&node);
        if has_index {
            for inner in node.indices() {
                if let Operand::Object(object) = self.operand(&inner) {
                    self.b.read(object, inner.range());
                }
            }
        }
        let is_local = first_kind(&node) == Some(SyntaxKind::LocalName)
            || self.declared.contains_key(text.to_lowercase().as_str());
        let name = if has_index || is_local || self.modified { None } else { block_name(&text) };
        self.open.shared = Some(name);
        self.b.statement(StatementKind::Open, range);
    }
}

/// Whether a block has the attribute that TIA Portal gives to every block that it exports. Its addresses tell too.
pub(super) fn is_of_tia_portal(block: SyntaxNode<'_>) -> bool {
    let attributes = ast::Block::cast(block).into_iter().flat_map(ast::Block::attributes);
    let has = |it: &str| it.to_ascii_lowercase().contains("s7_optimized_access");
    attributes.filter_map(ast::BlockAttribute::system_attributes).any(|it| has(it.text()))
}

/// Of a data block: the function block whose data it holds.
pub(super) fn instance_of(block: SyntaxNode<'_>) -> Option<BlockName> {
    let block = ast::Block::cast(block)?;
    if !block.header()?.keyword()?.text().eq_ignore_ascii_case("DATA_BLOCK") {
        return None;
    }
    match block_name(&block.type_ref()?.text())? {
        BlockName::Number(BlockKind::Udt, _) => None,
        name => Some(name),
    }
}

/// `P#M100.0BYTE10`, `P#DB5.DBX0.0WORD4`: a pointer that names its area, unlike `P#4.0`.
pub(super) fn points_to_area(text: &str) -> bool {
    let pointer = text.strip_prefix("P#").or_else(|| text.strip_prefix("p#"));
    pointer.is_some_and(|it| it.starts_with(|it: char| it.is_ascii_alphabetic()))
}

/// `FC1`, `DB 5`, `"Motor"`, `Motor`: a block's name. SFC and SFB included.
pub(super) fn block_name(text: &str) -> Option<BlockName> {
    let is_bare = || object::step7::quoted(text, Mnemonics::German).is_some_and(|it| it.ends_with('"'));
    if text.starts_with(['"', '«']) || is_bare() {
        let bare = text.trim_matches(['"', '«', '»', ' ', '\u{a0}']);
        return Some(BlockName::Symbol(bare.to_lowercase().into()));
    }
    let digits = text.find(|it: char| it.is_ascii_digit())?;
    let number = text[digits..].trim().parse().ok()?;
    let kind = match text[..digits].trim() {
        "DI" | "di" => BlockKind::Db,
        letters => BlockKind::of(letters)?,
    };
    Some(BlockName::Number(kind, number))
}
