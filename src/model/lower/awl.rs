//! STEP 7 AWL to the model: symbolic execution of the RLO, the nesting stack, the accumulators and the data block
//! registers, instruction by instruction.
//!
//! Facts about the machine (S7-300/400, two accumulators: S7:364-366): a logic string starts with a *first check*,
//! which overwrites the RLO; `=`, `S`, `R`, timer and counter instructions, conditional jumps and block calls end it,
//! and after them the RLO stays readable. `L`, `T` and arithmetic neither read nor change it (S7:357). `SET`, `CLR` and
//! comparisons overwrite it (S7:447). A conditional jump or block end leaves RLO 1 behind.

use crate::syntax::AstNode as _;
use rowan::TextRange;
use rustc_hash::{FxHashMap, FxHashSet};
use smol_str::SmolStr;

use super::builder::{Builder, index};
use super::interface;
use super::width::Data;
use crate::model::UnitModel;
use crate::model::entity::{BlockKind, BlockName, Entity};
use crate::model::expr::{Comparison, ExprId, Exprs, ObjectId, Operator};
use crate::model::layout::{Elementary, Field, Layout, Layouts};
use crate::model::literal::{self, IntType, Value};
use crate::model::object::{self, Class, Footprint, Object, Rights, Type};
use crate::model::unit::{
    Argument, Call, Callee, Constant, DeadCause, Formal, Hollow, HollowKind, Leave, LoopKind, Mode, OddityKind, Passed,
    Pin, Section, StatementKind,
};
use crate::syntax::awl::ast;
use crate::syntax::awl::instruction::{ArithOp, JumpIf, LogicOp, NumberType, Op, Relation, Shift};
use crate::syntax::{Language, Mnemonics, SyntaxElement, SyntaxKind, SyntaxNode};
use crate::target;

/// Lowers one block or listing.
pub fn lower(root: SyntaxNode<'_>, entity: Entity, mnemonics: Mnemonics) -> UnitModel {
    let heading = heading(root);
    let mut machine = Machine {
        b: Builder::new(entity, Language::Awl(mnemonics), heading, root.text_range().len()),
        mnemonics,
        rlo: Rlo { state: RloState::FromCaller, value: Exprs::TRUE },
        fresh: true,
        or_base: None,
        nesting: Vec::new(),
        string: None,
        accumulators: [Accumulator::entry(), Accumulator::entry()],
        loads: Vec::new(),
        br: Exprs::FALSE,
        open: OpenBlock::default(),
        arrivals: FxHashMap::default(),
        back_targets: FxHashSet::default(),
        operands: FxHashMap::default(),
        declared: FxHashMap::default(),
        temporary: Layout::default(),
        instance: Layout::default(),
        closed: false,
        last_load: None,
        jump_list: false,
    };
    machine.br = machine.b.exprs().opaque();
    for child in root.children() {
        match child.kind() {
            SyntaxKind::Block | SyntaxKind::Listing => machine.block(child),
            _ => {}
        }
    }
    machine.finish()
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum RloState {
    Known,
    /// Nothing of the block set it.
    FromCaller,
    /// A called block left it.
    AfterCall,
}

#[derive(Debug, Clone, Copy)]
struct Rlo {
    state: RloState,
    value: ExprId,
}

/// A logic string whose result nothing has used yet.
#[derive(Debug, Clone)]
struct LogicString {
    /// From the first check on.
    range: TextRange,
    /// First instruction since that does not depend on the RLO.
    ignoring: Option<(TextRange, SmolStr)>,
}

#[derive(Debug, Clone)]
struct Nest {
    op: Op,
    range: TextRange,
    rlo: Rlo,
    fresh: bool,
    or_base: Option<ExprId>,
    string: Option<LogicString>,
}

/// An accumulator: its value and the loads it may stem from.
#[derive(Debug, Clone)]
struct Accumulator {
    value: Option<ExprId>,
    loads: Vec<u32>,
    /// Nothing of the block has put a value there.
    entry: bool,
    data: Option<Data>,
}

impl Accumulator {
    fn entry() -> Self {
        Self { value: None, loads: Vec::new(), entry: true, data: None }
    }

    fn unknown() -> Self {
        Self { value: None, loads: Vec::new(), entry: false, data: None }
    }

    fn computed(value: ExprId) -> Self {
        Self { value: Some(value), loads: Vec::new(), entry: false, data: None }
    }

    fn meet(&mut self, other: &Self) {
        if self.value != other.value {
            self.value = None;
        }
        for &load in &other.loads {
            if !self.loads.contains(&load) {
                self.loads.push(load);
            }
        }
        self.entry &= other.entry;
        self.data = self.data.as_ref().zip(other.data.as_ref()).and_then(|(a, b)| a.meet(b));
    }
}

struct Load {
    range: TextRange,
    text: SmolStr,
    used: bool,
    /// What overwrote it; the end of the block when nothing did.
    lost_at: Option<TextRange>,
    /// The load right before, which this one pushed out of accumulator 1.
    follows: Option<u32>,
    /// It lies in accumulator 1 where the block goes back to its caller, who may read it there.
    returned: bool,
}

/// What is known of the data block registers.
#[derive(Debug, Clone, Default)]
struct OpenBlock {
    shared: Option<Option<BlockName>>,
    reported: bool,
}

/// Of more open parentheses, or of more loads that one accumulator may stem from, jumps carry nothing along.
const MOST_CARRIED: usize = 16;

/// The machine where a jump arrives.
#[derive(Debug, Clone)]
struct Arrival {
    rlo: Rlo,
    fresh: bool,
    or_base: Option<ExprId>,
    nesting: Vec<Nest>,
    accumulators: [Accumulator; 2],
    br: ExprId,
    shared: Option<Option<BlockName>>,
}

#[derive(Debug, Clone)]
enum Operand {
    Object(ObjectId),
    /// The constant, and how it was written.
    Constant(ExprId),
    /// A word that is neither: a label, a block.
    Other,
}

struct Machine {
    b: Builder,
    mnemonics: Mnemonics,
    rlo: Rlo,
    /// The next check is a first check.
    fresh: bool,
    /// AND terms before an `O` without operand.
    or_base: Option<ExprId>,
    nesting: Vec<Nest>,
    string: Option<LogicString>,
    accumulators: [Accumulator; 2],
    loads: Vec<Load>,
    br: ExprId,
    open: OpenBlock,
    arrivals: FxHashMap<SmolStr, Arrival>,
    back_targets: FxHashSet<SmolStr>,
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
}

impl Machine {
    fn block(&mut self, block: SyntaxNode<'_>) {
        self.closed = block.kind() == SyntaxKind::Block;
        self.declarations(block);
        self.b.model.instance_of = instance_of(block);
        for init in block.children().filter_map(ast::DataInit::cast) {
            self.initial_value(init.value());
        }
        let back_targets = back_targets(block, self.mnemonics);
        self.b.set_back_targets(back_targets.clone());
        self.back_targets = back_targets;
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
                    let header = ast::Network::cast(it).and_then(ast::Network::header);
                    let head = header.and_then(|it| it.syntax().descendant_tokens().find(|it| !it.kind().is_trivia()));
                    let is_bare = !it.children_with_tokens().any(|it| code.contains(&it.kind()));
                    bare = head.filter(|_| is_bare).map(|it| it.text_range());
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

    /// Loads in a row that are lost are one finding, at the last of them.
    fn dead_loads(&mut self) {
        let mut group: Vec<TextRange> = Vec::new();
        for (at, load) in self.loads.iter().enumerate() {
            if load.used {
                continue;
            }
            let continues = self.loads.get(at + 1).is_some_and(|next| !next.used && next.follows == Some(index(at)));
            if continues {
                group.push(load.range);
                continue;
            }
            let before = std::mem::take(&mut group);
            if load.returned && before.is_empty() {
                continue;
            }
            let oddity = self.b.oddity(OddityKind::DeadLoad, load.range, load.text.clone());
            oddity.related.extend(before.into_iter().map(|it| (it, LOST_TOO)));
            oddity.related.extend(load.lost_at.map(|it| (it, "the value is lost here")));
        }
    }

    /// The block goes back to its caller, who finds the accumulators as they are. An organization block has none.
    fn hand_over(&mut self) {
        if self.b.model.entity.block_kind() == Some(BlockKind::Ob) {
            return;
        }
        for &load in &self.accumulators[0].loads {
            self.loads[load as usize].returned = true;
        }
    }

    /// Something unread stands here: nothing is known any more, and nothing is lost.
    fn forget(&mut self) {
        self.string = None;
        let value = self.b.exprs().opaque();
        self.rlo = Rlo { state: RloState::Known, value };
        self.fresh = true;
        self.or_base = None;
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

    // Declarations.

    fn declarations(&mut self, block: SyntaxNode<'_>) {
        let sections = block.children().filter_map(ast::VarSection::cast);
        for decl in sections.flat_map(ast::VarSection::decls) {
            self.initial_value(decl.init());
        }
        let declared = interface::declared(block, &mut self.b);
        let (temporary, own): (Vec<Field>, Vec<Field>) =
            declared.fields().iter().cloned().partition(|it| it.section == Section::Temp);
        for it in temporary.iter().chain(&own) {
            self.declared.insert(it.name.clone(), it.ty.elementary());
        }
        self.temporary = Layouts::of_temporary(&temporary);
        // What other blocks are given lies where their caller keeps it.
        if self.b.model.entity.block_kind() == Some(BlockKind::Fb) {
            self.instance = Layouts::of_fields(&own);
        }
        self.b.model.declared = Some(declared);
    }

    /// Reads the constant of `:= S5T#1S`. Repetitions and lists of array elements are left alone.
    fn initial_value(&mut self, value: Option<ast::InitValue>) {
        let Some(value) = value else { return };
        let mut text = smol_str::SmolStrBuilder::new();
        let mut range: Option<TextRange> = None;
        for token in value.tokens() {
            if !matches!(
                token.kind(),
                SyntaxKind::Number | SyntaxKind::TypedConstant | SyntaxKind::Plus | SyntaxKind::Minus
            ) {
                return;
            }
            text.push_str(token.text());
            range = Some(range.map_or(token.text_range(), |it| it.cover(token.text_range())));
        }
        if let Some(range) = range {
            self.constant(&text.finish(), range);
        }
    }

    // Operands.

    fn operand(&mut self, node: &ast::Operand) -> Operand {
        let text = bare_text(node);
        if let Some(known) = self.operands.get(&text) {
            return known.clone();
        }
        let range = node.range();
        let first = first_kind(node);
        let has_index = is_indexed(node);
        // An element of an array by its number has one place.
        let is_number = |it: ast::Operand<'_>| matches!(first_kind(&it), Some(SyntaxKind::Number | SyntaxKind::Minus));
        let is_fixed = !has_index || node.indices().all(is_number);
        let operand = match first {
            Some(
                SyntaxKind::Number | SyntaxKind::TypedConstant | SyntaxKind::CharString | SyntaxKind::PointerConstant,
            )
            | Some(SyntaxKind::Plus | SyntaxKind::Minus | SyntaxKind::Hash) => return self.constant(&text, range),
            Some(SyntaxKind::LocalName) => Operand::Object(self.local(&text, has_index)),
            Some(SyntaxKind::QuotedSymbol) if is_fixed && is_field(&text) => match self.address(&text, range) {
                Ok(object) => Operand::Object(object),
                Err(object) => return Operand::Object(object),
            },
            Some(SyntaxKind::QuotedSymbol) if !has_index => {
                let mut object = Object::symbol(&text);
                object.indexed = has_index;
                Operand::Object(self.b.object(object))
            }
            Some(SyntaxKind::LBrack) => Operand::Object(self.indirect(&text, Type::Unknown)),
            Some(_) if !is_fixed => {
                for inner in node.indices() {
                    if let Operand::Object(object) = self.operand(&inner) {
                        self.b.read(object, inner.range());
                    }
                }
                // Not cached: the index is read each time.
                let ty = indirect_type(&text);
                return Operand::Object(self.indirect(&text, ty));
            }
            Some(_) => match text.to_ascii_uppercase().as_str() {
                "TRUE" => Operand::Constant(Exprs::TRUE),
                "FALSE" => Operand::Constant(Exprs::FALSE),
                "AR1" | "AR2" => Operand::Other,
                // Not cached when it is none: each place is reported.
                _ => match self.address(&text, range) {
                    Ok(object) => Operand::Object(object),
                    Err(object) => return Operand::Object(object),
                },
            },
            None => Operand::Other,
        };
        if !matches!(operand, Operand::Other) {
            self.operands.insert(text, operand.clone());
        }
        operand
    }

    fn indirect(&mut self, text: &str, ty: Type) -> ObjectId {
        self.b.object(Object {
            text: text.into(),
            class: Class::Indirect,
            ty,
            footprint: Footprint::new(object::Area::Indirect, 0, 1),
            rights: Rights::Unknown,
            extracted: false,
            indexed: false,
        })
    }

    fn local(&mut self, text: &str, indexed: bool) -> ObjectId {
        let name = text.trim_start_matches('#').replace('"', "").to_lowercase();
        let placed = |layout: &Layout, area| Some((area, layout.place(&name)?));
        let place =
            placed(&self.temporary, object::Area::Local).or_else(|| placed(&self.instance, object::Area::OpenInstance));
        let (ty, footprint, indexed) = match place {
            Some((area, it)) => {
                let ty = it.ty.map_or(Type::Unknown, Elementary::operand);
                (ty, Footprint::new(area, it.start, it.bits), false)
            }
            None => {
                let ty = self.declared.get(name.as_str()).copied().flatten();
                let ty = ty.map_or(Type::Unknown, Elementary::operand);
                (ty, Footprint::new(object::Area::LocalName(name.as_str().into()), 0, 1), indexed)
            }
        };
        let text = text.into();
        let (rights, extracted) = (Rights::Unknown, false);
        self.b.object(Object { text, class: Class::LocalName, ty, footprint, rights, extracted, indexed })
    }

    /// `Err`: what stands for a text that is no address.
    fn address(&mut self, text: &str, range: TextRange) -> Result<ObjectId, ObjectId> {
        let root = text.split(['.', '[']).next().unwrap_or_default().to_lowercase();
        if self.declared.contains_key(root.as_str()) {
            return Ok(self.local(text, false));
        }
        match object::step7::parse(text, self.mnemonics) {
            Ok(object) => Ok(self.b.object(object)),
            Err(error) if error.suggestion.is_none() && is_bare_symbol(text, self.mnemonics) => {
                Ok(self.b.object(Object::symbol(text)))
            }
            Err(error) => {
                self.b.oddity(OddityKind::Address(error), range, text);
                let mut object = Object::symbol(text);
                object.class = Class::Indirect;
                object.footprint.area = object::Area::Indirect;
                Err(self.b.object(object))
            }
        }
    }

    fn constant(&mut self, text: &SmolStr, range: TextRange) -> Operand {
        let value = match literal::parse_step7(text) {
            Ok(value) => value,
            Err(error) => {
                self.b.oddity(OddityKind::Literal(error), range, text.clone());
                return Operand::Constant(self.b.exprs().opaque());
            }
        };
        let expr = match &value {
            Value::Bool(value) => Exprs::bool(*value),
            Value::Int { value, .. } => self.b.exprs().int(*value),
            Value::Count(value) => self.b.exprs().int(i64::from(*value)),
            Value::Real(value) => self.b.exprs().float(*value),
            Value::S5Time { .. } | Value::Time { .. } | Value::Text(_) | Value::Other => self.b.exprs().text(text),
        };
        if matches!(value, Value::S5Time { .. } | Value::Time { .. }) {
            self.b.model.constants.push(Constant { value, range, text: text.clone() });
        }
        Operand::Constant(expr)
    }

    /// An object that lies in the open data block, named by that block where it is known.
    fn resolve(&mut self, object: ObjectId, range: TextRange) -> ObjectId {
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
                    if !std::mem::replace(&mut self.open.reported, true) && self.b.is_reachable() {
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

    fn object_operand(&mut self, instr: &ast::Instr) -> Option<(ObjectId, TextRange)> {
        let node = instr.operand()?;
        match self.operand(&node) {
            Operand::Object(object) => {
                let range = node.range();
                Some((self.resolve(object, range), range))
            }
            Operand::Constant(_) | Operand::Other => None,
        }
    }

    /// Records a read of a bit or word.
    fn read(&mut self, object: ObjectId, range: TextRange) -> ExprId {
        let indirect = self.b.model.objects[object.0 as usize].class == Class::Indirect;
        self.b.model.reads_indirectly |= indirect;
        if indirect {
            self.b.read(object, range);
            return self.b.exprs().opaque();
        }
        self.b.read(object, range)
    }

    fn note_write(&mut self, object: ObjectId) {
        if self.b.model.objects[object.0 as usize].class == Class::Indirect {
            self.b.model.writes_indirectly = true;
            self.b.wipe();
        }
    }

    // The RLO.

    /// The value that an instruction which uses the RLO sees.
    fn rlo_value(&mut self) -> ExprId {
        match self.or_base {
            Some(base) => {
                let term = self.rlo.value;
                self.b.exprs().or(base, term)
            }
            None => self.rlo.value,
        }
    }

    /// Ends the logic string: its result was used.
    fn limit(&mut self) {
        let value = self.rlo_value();
        self.rlo.value = value;
        self.or_base = None;
        self.fresh = true;
        self.string = None;
    }

    /// An instruction acts on the RLO: reports one that nothing in the block computed.
    fn use_rlo(&mut self, range: TextRange, text: &str) -> ExprId {
        if self.fresh && self.b.is_reachable() {
            let kind = match self.rlo.state {
                RloState::Known => None,
                RloState::FromCaller => Some(OddityKind::RloFromCaller),
                RloState::AfterCall => Some(OddityKind::RloAfterCall),
            };
            if let Some(kind) = kind {
                self.b.oddity(kind, range, text);
                // One report a cause: what follows acts on the same RLO.
                let value = self.b.exprs().opaque();
                self.rlo = Rlo { state: RloState::Known, value };
            }
        }
        self.rlo_value()
    }

    /// A new value overwrites the RLO, or the block ends: a string that nothing used is lost.
    fn discard(&mut self, by: TextRange) {
        let Some(string) = self.string.take() else { return };
        if self.fresh || !self.b.is_reachable() {
            return;
        }
        match string.ignoring {
            Some((range, text)) => {
                let oddity = self.b.oddity(OddityKind::UnconditionalAfterTest, range, text);
                oddity.related.push((string.range, "the test"));
            }
            None => {
                let oddity = self.b.oddity(OddityKind::RloUnused, string.range, "");
                oddity.related.push((by, "the result is lost here"));
            }
        }
    }

    /// A check of a bit: combines it with the RLO.
    fn check(&mut self, op: Op, value: ExprId, range: TextRange) {
        let negated = matches!(op, Op::AndNot | Op::OrNot | Op::XorNot);
        let value = if negated { self.b.exprs().not(value) } else { value };
        let combined = if self.fresh {
            value
        } else {
            let left = self.rlo.value;
            match op {
                Op::Or | Op::OrNot => {
                    let left = self.rlo_value();
                    self.or_base = None;
                    self.b.exprs().or(left, value)
                }
                Op::Xor | Op::XorNot => {
                    let left = self.rlo_value();
                    self.or_base = None;
                    self.b.exprs().xor(left, value)
                }
                _ => self.b.exprs().and(left, value),
            }
        };
        if self.fresh {
            self.or_base = None;
        }
        self.overwrite(combined, range);
    }

    fn overwrite(&mut self, value: ExprId, range: TextRange) {
        match &mut self.string {
            Some(string) if !self.fresh => string.range = string.range.cover(range),
            _ => self.string = Some(LogicString { range, ignoring: None }),
        }
        self.rlo = Rlo { state: RloState::Known, value };
        self.fresh = false;
    }

    /// An instruction that neither uses nor changes the RLO stands here.
    fn ignores_rlo(&mut self, range: TextRange, instr: &ast::Instr) {
        if let Some(string) = self.string.as_mut().filter(|it| it.ignoring.is_none()) {
            string.ignoring = Some((range, mnemonic_text(instr)));
        }
    }

    // The accumulators.

    fn use_loads(&mut self, which: usize) {
        for &load in &self.accumulators[which].loads {
            self.loads[load as usize].used = true;
        }
    }

    fn keep_accumulators(&mut self) {
        self.use_loads(0);
        self.use_loads(1);
    }

    fn lose(&mut self, which: usize, at: TextRange) {
        for &load in &self.accumulators[which].loads {
            let load = &mut self.loads[load as usize];
            load.lost_at.get_or_insert(at);
        }
    }

    fn load(&mut self, value: ExprId, range: TextRange, text: SmolStr) {
        self.lose(1, range);
        let used = !self.b.is_reachable();
        let follows = self.last_load.take();
        self.loads.push(Load { range, text, used, lost_at: None, follows, returned: false });
        let load = index(self.loads.len() - 1);
        self.last_load = Some(load);
        let loaded = Accumulator { loads: vec![load], ..Accumulator::computed(value) };
        let before = std::mem::replace(&mut self.accumulators[0], loaded);
        self.accumulators[1] = before;
    }

    fn accumulator(&mut self, which: usize) -> ExprId {
        self.use_loads(which);
        match self.accumulators[which].value {
            Some(value) => value,
            None => {
                let value = self.b.exprs().opaque();
                self.accumulators[which].value = Some(value);
                value
            }
        }
    }

    /// Both operands of a two-operand instruction: accumulator 2, then 1.
    fn two_operands(&mut self, range: TextRange, instr: &ast::Instr) -> (ExprId, ExprId) {
        self.want_two(range, instr);
        let left = self.accumulator(1);
        let right = self.accumulator(0);
        (left, right)
    }

    /// The type of a variable that the block declares.
    fn elementary(&self, object: ObjectId) -> Option<Elementary> {
        let object = self.b.model.object(object);
        if object.class != Class::LocalName {
            return None;
        }
        let name = object.text.trim_start_matches('#').replace('"', "").to_lowercase();
        let place = self.temporary.place(&name).or_else(|| self.instance.place(&name));
        place.and_then(|it| it.ty).or_else(|| self.declared.get(name.as_str()).copied().flatten())
    }

    /// Reports operands of another width or kind than the operation is for: the first of them.
    fn fit(&mut self, ty: NumberType, range: TextRange, instr: &ast::Instr) {
        let mut data = self.accumulators.iter().rev().filter_map(|it| it.data.as_ref());
        let misfit = data.find_map(|it| it.misfit(ty));
        self.note_width(misfit, range, instr);
    }

    fn note_width(&mut self, flaw: Option<String>, range: TextRange, instr: &ast::Instr) {
        if let Some(flaw) = flaw.filter(|_| self.b.is_reachable()) {
            self.b.oddity(OddityKind::OperandWidth(flaw), range, mnemonic_text(instr));
        }
    }

    /// Reports an instruction that needs both accumulators where the block has not filled them.
    fn want_two(&mut self, range: TextRange, instr: &ast::Instr) {
        let missing = self.accumulators.iter().filter(|it| it.entry).count();
        // A listing may show the middle of a block; only a block's start is really one.
        if missing > 0 && self.b.is_reachable() && self.closed {
            let loaded = 2 - index(missing);
            self.b.oddity(OddityKind::MissingOperand(loaded), range, mnemonic_text(instr));
            for accumulator in &mut self.accumulators {
                accumulator.entry = false;
            }
        }
    }

    fn result(&mut self, value: ExprId) {
        self.accumulators[0] = Accumulator::computed(value);
    }

    fn opaque_result(&mut self) {
        self.use_loads(0);
        let value = self.b.exprs().opaque();
        self.result(value);
    }

    // Control flow.

    fn arrival(&self) -> Arrival {
        Arrival {
            rlo: self.rlo,
            fresh: self.fresh,
            or_base: self.or_base,
            nesting: self.nesting.clone(),
            accumulators: self.accumulators.clone(),
            br: self.br,
            shared: self.open.shared.clone(),
        }
    }

    fn label(&mut self, text: &SmolStr, range: TextRange) {
        let reachable = self.b.is_reachable();
        self.b.label(text.clone(), text.clone(), range);
        if let Some(arrival) = self.arrivals.remove(text) {
            if reachable { self.meet(arrival) } else { self.become_arrival(arrival) }
        }
        if self.back_targets.contains(text) {
            self.string = None;
            let value = self.b.exprs().opaque();
            self.rlo = Rlo { state: RloState::Known, value };
            self.or_base = None;
            self.keep_accumulators();
            self.accumulators = [Accumulator::unknown(), Accumulator::unknown()];
        }
    }

    fn become_arrival(&mut self, arrival: Arrival) {
        self.rlo = arrival.rlo;
        self.fresh = arrival.fresh;
        self.or_base = arrival.or_base;
        self.nesting = arrival.nesting;
        self.accumulators = arrival.accumulators;
        self.br = arrival.br;
        self.open.shared = arrival.shared;
        self.string = None;
    }

    fn meet(&mut self, arrival: Arrival) {
        let here = self.rlo_value();
        let there = match arrival.or_base {
            Some(base) => self.b.exprs().or(base, arrival.rlo.value),
            None => arrival.rlo.value,
        };
        self.or_base = None;
        if here != there {
            self.rlo.value = self.b.exprs().opaque();
        }
        if self.rlo.state == RloState::Known {
            self.rlo.state = arrival.rlo.state;
        }
        if self.fresh != arrival.fresh {
            self.string = None;
        }
        self.fresh |= arrival.fresh;
        for (accumulator, other) in self.accumulators.iter_mut().zip(&arrival.accumulators) {
            accumulator.meet(other);
            if accumulator.loads.len() > MOST_CARRIED {
                for load in accumulator.loads.drain(..) {
                    self.loads[load as usize].used = true;
                }
            }
        }
        if self.br != arrival.br {
            self.br = self.b.exprs().opaque();
        }
        if self.open.shared != arrival.shared {
            let either = self.open.shared.is_some() || arrival.shared.is_some();
            self.open.shared = either.then_some(None);
        }
    }

    fn jump(&mut self, instr: &ast::Instr, when: ExprId, range: TextRange) {
        let Some((text, at)) = label_operand(instr) else { return };
        if self.b.has_label(&text) || self.nesting.len() > MOST_CARRIED {
            self.keep_accumulators();
        } else {
            match self.arrivals.remove(&text) {
                Some(before) => {
                    let here = self.arrival();
                    let string = self.string.clone();
                    let reported = self.open.reported;
                    self.meet(before);
                    let met = self.arrival();
                    self.become_arrival(here);
                    self.string = string;
                    self.open.reported = reported;
                    self.arrivals.insert(text.clone(), met);
                }
                None => {
                    let arrival = self.arrival();
                    self.arrivals.insert(text.clone(), arrival);
                }
            }
        }
        self.b.jump(text.clone(), text, at, when, range);
    }

    fn conditional(&mut self, instr: &ast::Instr, range: TextRange, negated: bool, save: bool) {
        let rlo = self.use_rlo(range, &mnemonic_text(instr));
        self.limit();
        if save {
            self.br = rlo;
        }
        let when = if negated { self.b.exprs().not(rlo) } else { rlo };
        // Taken or not, the RLO is 1 afterwards.
        self.rlo = Rlo { state: RloState::Known, value: Exprs::TRUE };
        self.jump(instr, when, range);
    }

    fn end(&mut self, when: ExprId, range: TextRange) {
        if when == Exprs::TRUE {
            self.discard(range);
        }
        if self.b.is_reachable() {
            self.hand_over();
        }
        self.b.statement(StatementKind::Return { when, how: Leave::Unit }, range);
        self.b.leave(when, DeadCause::End, range);
    }

    // Calls.

    fn call(&mut self, instr: &ast::Instr, op: Op, range: TextRange) {
        let when = match op {
            Op::CallConditional => {
                let when = self.use_rlo(range, &mnemonic_text(instr));
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
        let callee_text = bare_text(&callee_node);
        let instance_node = operands.next();
        let has_index = is_indexed(&callee_node);
        let declared = self.declared.contains_key(callee_text.trim_start_matches('#').to_lowercase().as_str());
        let callee = match first_kind(&callee_node) {
            _ if has_index => Callee::Unknown,
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
        self.fresh = true;
        self.or_base = None;
        self.string = None;
    }

    // Instructions.

    fn instruction(&mut self, instr: &ast::Instr) {
        if let Some((text, range)) = label(instr) {
            self.last_load = None;
            self.jump_list = false;
            self.label(&text, range);
        }
        let Some(range) = instruction_range(instr) else { return };
        let broken = instr.syntax().children().any(|it| it.kind() == SyntaxKind::Error);
        let Some(op) = instr.op(self.mnemonics).filter(|_| !broken) else {
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
        self.jump_list &= op == Op::Jump(JumpIf::Always);
        match op {
            Op::And | Op::AndNot | Op::OrNot | Op::Xor | Op::XorNot => self.bit_check(op, instr, range),
            Op::Or if instr.operand().is_some() => self.bit_check(op, instr, range),
            Op::Or => {
                let base = self.rlo_value();
                self.or_base = Some(base);
                self.rlo.value = Exprs::TRUE;
            }
            Op::AndOpen | Op::AndNotOpen | Op::OrOpen | Op::OrNotOpen | Op::XorOpen | Op::XorNotOpen => {
                let nest = Nest {
                    op,
                    range,
                    rlo: self.rlo,
                    fresh: self.fresh,
                    or_base: self.or_base.take(),
                    string: self.string.take(),
                };
                self.nesting.push(nest);
                let depth = index(self.nesting.len());
                if depth > target::step7::PARENTHESIS_DEPTH.value {
                    self.b.oddity(OddityKind::ParenthesisDepth(depth), range, "(");
                }
                self.fresh = true;
            }
            Op::Close => self.close(range),
            Op::Assign => {
                let rlo = self.use_rlo(range, &mnemonic_text(instr));
                if let Some((object, at)) = self.object_operand(instr) {
                    self.b.assign(object, false, rlo, at, range);
                    self.note_write(object);
                }
                self.limit();
            }
            Op::Set | Op::Reset => self.set_or_reset(op, instr, range),
            Op::NegateRlo => {
                let rlo = self.rlo_value();
                self.or_base = None;
                let value = self.b.exprs().not(rlo);
                self.rlo.value = value;
            }
            Op::SetRlo | Op::ClearRlo => {
                self.discard(range);
                self.rlo = Rlo { state: RloState::Known, value: Exprs::bool(op == Op::SetRlo) };
                self.fresh = true;
                self.or_base = None;
            }
            Op::SaveRlo => {
                // SAVE after a call keeps what the called block answered: its use is the point.
                self.br = self.rlo_value();
                self.limit();
            }
            Op::EdgePositive | Op::EdgeNegative => {
                let was_fresh = self.fresh;
                self.use_rlo(range, &mnemonic_text(instr));
                if let Some((object, at)) = self.object_operand(instr) {
                    self.b.touch(object, Mode::EdgeMemory, at);
                    self.note_write(object);
                }
                let value = self.b.exprs().opaque();
                self.or_base = None;
                if was_fresh {
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
                    self.b.store(object, value, at, range);
                    self.note_write(object);
                }
            }
            Op::Timer(_) => {
                let rlo = self.use_rlo(range, &mnemonic_text(instr));
                let duration = self.accumulator(0);
                if let Some((object, at)) = self.object_operand(instr) {
                    self.b.drive(object, Pin::Start, rlo, Some(duration), at, range);
                }
                self.limit();
            }
            Op::Enable | Op::CountUp | Op::CountDown => {
                let rlo = self.use_rlo(range, &mnemonic_text(instr));
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
                self.or_base = None;
                self.fresh = true;
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
                self.accumulators[0].data = Some(data);
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
                self.opaque_result();
                self.accumulators[0].data = Data::converted(by);
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
            Op::SwapAddressRegisters | Op::Nop | Op::Display => {}
            Op::Call | Op::CallUnconditional | Op::CallConditional => self.call(instr, op, range),
            Op::BlockEnd | Op::BlockEndUnconditional => {
                self.closed = true;
                self.end(Exprs::TRUE, range);
            }
            Op::BlockEndConditional => {
                let when = self.use_rlo(range, &mnemonic_text(instr));
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
                self.use_rlo(range, "MCR(");
                self.limit();
                self.b.statement(StatementKind::Other, range);
            }
            Op::McrClose | Op::McrActivate | Op::McrDeactivate => {}
            Op::Jump(condition) => self.jump_instruction(condition, instr, range),
            Op::JumpList => {
                self.use_loads(0);
                let when = self.b.exprs().opaque();
                self.jump(instr, when, range);
                self.jump_list = true;
            }
            Op::Loop => {
                self.opaque_result();
                let when = self.b.exprs().opaque();
                let before = self.b.model.loops.len();
                self.jump(instr, when, range);
                // LOOP counts down to 0, which a plain jump does not.
                for it in &mut self.b.model.loops[before..] {
                    it.kind = LoopKind::For;
                }
            }
        }
    }

    fn bit_check(&mut self, op: Op, instr: &ast::Instr, range: TextRange) {
        let value = match instr.operand() {
            Some(node) => match self.operand(&node) {
                Operand::Object(object) => {
                    let at = node.range();
                    let object = self.resolve(object, at);
                    let status = self.b.model.objects[object.0 as usize].class == Class::Status;
                    match status {
                        true if is_binary_result(&self.b.model.objects[object.0 as usize].text) => self.br,
                        // The other bits change with every instruction.
                        true => self.b.exprs().opaque(),
                        false => self.read(object, at),
                    }
                }
                Operand::Constant(value) => value,
                Operand::Other => self.b.exprs().opaque(),
            },
            None => self.b.exprs().opaque(),
        };
        self.check(op, value, range);
    }

    fn close(&mut self, range: TextRange) {
        let Some(nest) = self.nesting.pop() else {
            self.b.oddity(OddityKind::UnopenedParenthesis, range, ")");
            return;
        };
        let inner = self.rlo_value();
        let op = match nest.op {
            Op::AndNotOpen => Op::AndNot,
            Op::OrOpen => Op::Or,
            Op::OrNotOpen => Op::OrNot,
            Op::XorOpen => Op::Xor,
            Op::XorNotOpen => Op::XorNot,
            _ => Op::And,
        };
        self.rlo = nest.rlo;
        self.fresh = nest.fresh;
        self.or_base = nest.or_base;
        self.string = nest.string;
        self.check(op, inner, nest.range.cover(range));
    }

    fn set_or_reset(&mut self, op: Op, instr: &ast::Instr, range: TextRange) {
        let rlo = self.use_rlo(range, &mnemonic_text(instr));
        if let Some((object, at)) = self.object_operand(instr) {
            let class = self.b.model.objects[object.0 as usize].class;
            let is_block = matches!(class, Class::Timer | Class::Counter)
                || self.b.model.objects[object.0 as usize].ty == Type::Block;
            match (op, is_block) {
                (Op::Set, true) => {
                    let preset = self.accumulator(0);
                    self.b.drive(object, Pin::Preset, rlo, Some(preset), at, range);
                }
                (Op::Set, false) => self.b.set(object, rlo, at, range),
                (_, true) => self.b.drive(object, Pin::Reset, rlo, None, at, range),
                (_, false) => self.b.reset(object, rlo, at, range),
            }
            self.note_write(object);
            // A symbol may be a counter, which takes its preset from the accumulator.
            if op == Op::Set && matches!(class, Class::Symbol | Class::LocalName) {
                self.use_loads(0);
            }
        }
        self.limit();
    }

    fn load_instruction(&mut self, instr: &ast::Instr, range: TextRange) {
        self.ignores_rlo(range, instr);
        let Some(node) = instr.operand() else { return };
        let at = node.range();
        let text = bare_text(&node);
        let (value, data) = match self.operand(&node) {
            Operand::Object(object) => {
                let object = self.resolve(object, at);
                let declared = self.elementary(object);
                let data = Data::loaded(self.b.model.object(object), declared);
                (self.read(object, at), data)
            }
            Operand::Constant(value) => {
                let ty = constant_type(&text).flatten();
                (value, Data::constant(self.b.exprs(), value, ty, text.clone()))
            }
            Operand::Other => (self.b.exprs().opaque(), None),
        };
        self.load(value, range, text);
        self.accumulators[0].data = data;
    }

    fn constant_operand(&mut self, instr: &ast::Instr) -> ExprId {
        let operand = instr.operand().map(|it| self.operand(&it));
        match operand {
            Some(Operand::Constant(value)) => value,
            _ => self.b.exprs().opaque(),
        }
    }

    fn address_register(&mut self, instr: &ast::Instr) {
        match instr.operand() {
            Some(node) => {
                if let Operand::Object(object) = self.operand(&node) {
                    let at = node.range();
                    let object = self.resolve(object, at);
                    self.read(object, at);
                }
            }
            None => self.use_loads(0),
        }
    }

    fn open_block(&mut self, instr: &ast::Instr, range: TextRange) {
        let Some(node) = instr.operand() else { return };
        let text = bare_text(&node);
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
        let name = if has_index || is_local { None } else { block_name(&text) };
        self.open.shared = Some(name);
        self.b.statement(StatementKind::Open, range);
    }

    fn jump_instruction(&mut self, condition: JumpIf, instr: &ast::Instr, range: TextRange) {
        match condition {
            JumpIf::Always => {
                // The RLO goes along; where it arrives is another matter.
                self.string = None;
                // The number in accumulator 1 selects one entry of a list.
                let when = if self.jump_list { self.b.exprs().opaque() } else { Exprs::TRUE };
                self.jump(instr, when, range);
            }
            JumpIf::Rlo => self.conditional(instr, range, false, false),
            JumpIf::NotRlo => self.conditional(instr, range, true, false),
            JumpIf::RloSave => self.conditional(instr, range, false, true),
            JumpIf::NotRloSave => self.conditional(instr, range, true, true),
            JumpIf::Br | JumpIf::NotBr => {
                let br = self.br;
                let when = if condition == JumpIf::Br { br } else { self.b.exprs().not(br) };
                self.limit();
                self.jump(instr, when, range);
            }
            JumpIf::Overflow
            | JumpIf::StoredOverflow
            | JumpIf::Zero
            | JumpIf::NotZero
            | JumpIf::Plus
            | JumpIf::Minus
            | JumpIf::PlusOrZero
            | JumpIf::MinusOrZero
            | JumpIf::Unordered => {
                self.ignores_rlo(range, instr);
                let when = self.b.exprs().opaque();
                // A result that is only tested is used.
                self.keep_accumulators();
                self.jump(instr, when, range);
            }
        }
    }
}

/// Part of a load in a row of lost ones.
const LOST_TOO: &str = "this value is lost too";

/// Labels that a jump below them goes to.
fn back_targets(block: SyntaxNode<'_>, mnemonics: Mnemonics) -> FxHashSet<SmolStr> {
    let mut labels: FxHashSet<SmolStr> = FxHashSet::default();
    let mut back = FxHashSet::default();
    for network in block.children().filter_map(ast::Network::cast) {
        for instr in network.instrs() {
            if let Some((text, _)) = label(&instr) {
                labels.insert(text);
            }
            if !labels.is_empty()
                && matches!(instr.op(mnemonics), Some(Op::Jump(_) | Op::JumpList | Op::Loop))
                && let Some((text, _)) = label_operand(&instr)
                && labels.contains(&text)
            {
                back.insert(text);
            }
        }
    }
    back
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

/// Of a data block: the function block whose data it holds.
fn instance_of(block: SyntaxNode<'_>) -> Option<BlockName> {
    let block = ast::Block::cast(block)?;
    if !block.header()?.keyword()?.text().eq_ignore_ascii_case("DATA_BLOCK") {
        return None;
    }
    match block_name(&block.type_ref()?.text())? {
        BlockName::Number(BlockKind::Udt, _) => None,
        name => Some(name),
    }
}

fn label(instr: &ast::Instr) -> Option<(SmolStr, TextRange)> {
    let name = instr.label()?.name()?;
    Some((name.text().into(), name.text_range()))
}

/// The target of a jump.
fn label_operand(instr: &ast::Instr) -> Option<(SmolStr, TextRange)> {
    let operand = instr.operand()?;
    Some((bare_text(&operand), operand.range()))
}

fn mnemonic_text(instr: &ast::Instr) -> SmolStr {
    instr.mnemonic().map(|it| it.text).unwrap_or_default()
}

/// From the mnemonic to the last operand; `None` for a label alone.
fn instruction_range(instr: &ast::Instr) -> Option<TextRange> {
    let start = instr.mnemonic_tokens().next()?.text_range();
    let end = instr.arg_list().map(|it| it.range()).or_else(|| Some(instr.operands().last()?.range()));
    let mnemonic = instr.mnemonic_tokens().last().map_or(start, |it| it.text_range());
    Some(start.cover(mnemonic).cover(end.unwrap_or(start)))
}

/// The operand without blanks: `M0.0`, `DB5.DBW0`.
fn bare_text(operand: &ast::Operand) -> SmolStr {
    let mut text = smol_str::SmolStrBuilder::new();
    for token in operand.tokens() {
        text.push_str(token.text());
    }
    text.finish()
}

fn first_kind(operand: &ast::Operand) -> Option<SyntaxKind> {
    operand.first_token().map(|it| it.kind())
}

fn is_indexed(operand: &ast::Operand) -> bool {
    operand.syntax().children_with_tokens().any(|it| it.kind() == SyntaxKind::LBrack)
}

fn comparison(relation: Relation) -> Comparison {
    match relation {
        Relation::Eq => Comparison::Eq,
        Relation::Ne => Comparison::Ne,
        Relation::Gt => Comparison::Gt,
        Relation::Lt => Comparison::Lt,
        Relation::Ge => Comparison::Ge,
        Relation::Le => Comparison::Le,
    }
}

/// Whether a word that is no address may be a symbol without its quotes: it has not the form of one, letters and a
/// number, and a number is not all that it lacks.
fn is_bare_symbol(text: &str, mnemonics: Mnemonics) -> bool {
    let letters = text.bytes().take_while(u8::is_ascii_alphabetic).count();
    let numbered = letters <= 4 && text.as_bytes().get(letters).is_some_and(u8::is_ascii_digit);
    let is_word = text.chars().all(|it| it.is_alphanumeric() || matches!(it, '_' | '.'));
    let lacks_number = || ["0", "0.0"].iter().any(|it| object::step7::parse(&format!("{text}{it}"), mnemonics).is_ok());
    is_word && !numbered && !lacks_number()
}

/// `"Data".speed`: more than a symbol.
fn is_field(text: &str) -> bool {
    ["\".", "»."].iter().any(|it| text.contains(it))
}

fn is_binary_result(text: &str) -> bool {
    text.eq_ignore_ascii_case("BR") || text.eq_ignore_ascii_case("BIE")
}

/// The type that the spelling of a constant tells, `None` within where it tells none; `None` for what is no constant.
fn constant_type(text: &str) -> Option<Option<Elementary>> {
    Some(match literal::parse_step7(text).ok()? {
        Value::Bool(_) => Some(Elementary::Bool),
        Value::Int { ty: IntType::Plain, .. } => Some(Elementary::Int),
        Value::Int { ty: IntType::Long, .. } => Some(Elementary::DoubleInt),
        Value::Int { ty: IntType::Bits(8), .. } => Some(Elementary::Byte),
        Value::Int { ty: IntType::Bits(16), .. } => Some(Elementary::Word),
        Value::Int { ty: IntType::Bits(32), .. } => Some(Elementary::Double),
        Value::Real(_) => Some(Elementary::Real),
        Value::S5Time { .. } => Some(Elementary::S5Time),
        Value::Time { .. } => Some(Elementary::Time),
        Value::Int { .. } | Value::Count(_) | Value::Text(_) => None,
        Value::Other => return None,
    })
}

/// Size of a place given by a pointer: `MW [...]`, `DBB [...]`, `M [...]`.
fn indirect_type(text: &str) -> Type {
    let prefix = text.split('[').next().unwrap_or_default().to_ascii_uppercase();
    match prefix.as_str() {
        "T" | "C" | "Z" | "DB" | "DI" | "FB" | "FC" => Type::Block,
        it if it.len() > 1 && it.ends_with('B') => Type::Byte,
        it if it.ends_with('W') => Type::Word,
        it if it.len() > 1 && it.ends_with('D') => Type::Double,
        "" => Type::Unknown,
        _ => Type::Bool,
    }
}

/// `P#M100.0BYTE10`, `P#DB5.DBX0.0WORD4`: a pointer that names its area, unlike `P#4.0`.
fn points_to_area(text: &str) -> bool {
    let pointer = text.strip_prefix("P#").or_else(|| text.strip_prefix("p#"));
    pointer.is_some_and(|it| it.starts_with(|it: char| it.is_ascii_alphabetic()))
}

/// `FC1`, `DB 5`, `"Motor"`: a block's name. SFC and SFB included.
fn block_name(text: &str) -> Option<BlockName> {
    if text.starts_with(['"', '«']) {
        let bare = text.trim_matches(['"', '«', '»', ' ', '\u{a0}']);
        return Some(BlockName::Symbol(bare.to_lowercase().into()));
    }
    let digits = text.find(|it: char| it.is_ascii_digit())?;
    let number = text[digits..].trim().parse().ok()?;
    let kind = match text[..digits].trim().to_ascii_uppercase().as_str() {
        "OB" => BlockKind::Ob,
        "FB" => BlockKind::Fb,
        "FC" => BlockKind::Fc,
        "DB" | "DI" => BlockKind::Db,
        "UDT" => BlockKind::Udt,
        "SFB" => BlockKind::Sfb,
        "SFC" => BlockKind::Sfc,
        _ => return None,
    };
    Some(BlockName::Number(kind, number))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::expr::Expr;
    use crate::model::unit::Mode;

    fn model(text: &str) -> UnitModel {
        let parse = crate::syntax::awl::parse(text, Mnemonics::German);
        assert_eq!(parse.errors(), [], "{text}");
        lower(parse.syntax(), Entity::Listing, Mnemonics::German)
    }

    fn block(code: &str) -> UnitModel {
        model(&format!("FUNCTION FC 1 : VOID\nBEGIN\nNETWORK\n{code}\nEND_FUNCTION\n"))
    }

    fn oddities(model: &UnitModel) -> Vec<String> {
        model.oddities.iter().map(|it| format!("{:?}@{}", it.kind, usize::from(it.range.start()))).collect()
    }

    fn names(code: &str) -> Vec<String> {
        let mut names: Vec<String> = block(code).oddities.iter().map(|it| format!("{:?}", it.kind)).collect();
        names.sort();
        names
    }

    /// Values of the bits assigned, written out.
    fn values(code: &str) -> Vec<String> {
        let model = block(code);
        let kinds = model.statements.iter().map(|it| &it.kind);
        kinds
            .filter_map(|it| match it {
                StatementKind::Assign { value, .. } => Some(show(&model, *value)),
                _ => None,
            })
            .collect()
    }

    fn show(model: &UnitModel, id: ExprId) -> String {
        match model.exprs.get(id) {
            Expr::Bool(value) => value.to_string(),
            Expr::Int(value) => value.to_string(),
            Expr::Read { object, .. } => model.object(*object).text.to_string(),
            Expr::Not(a) => format!("!{}", show(model, *a)),
            Expr::And(a, b) => format!("({} & {})", show(model, *a), show(model, *b)),
            Expr::Or(a, b) => format!("({} | {})", show(model, *a), show(model, *b)),
            Expr::Xor(a, b) => format!("({} ^ {})", show(model, *a), show(model, *b)),
            Expr::Compare(op, a, b) => format!("({} {} {})", show(model, *a), op.as_str(), show(model, *b)),
            _ => "?".to_owned(),
        }
    }

    #[test]
    fn and_before_or() {
        // S7:208-220.
        let code = "U E0.0\nU M10.0\nO\nU E0.2\nU M0.3\nO M10.1\n= A4.0";
        assert_eq!(values(code), ["(((E0.0 & M10.0) | (E0.2 & M0.3)) | M10.1)"]);
        let code = "U(\nO E0.0\nO M10.0\n)\nU(\nO E0.2\nO M10.3\n)\nU M10.1\n= A4.0";
        assert_eq!(values(code), ["(((E0.0 | M10.0) & (E0.2 | M10.3)) & M10.1)"]);
        assert_eq!(values("UN E0.0\nX E0.1\nNOT\n= A4.0\n= A4.1"), ["!(!E0.0 ^ E0.1)", "!(!E0.0 ^ E0.1)"]);
        assert_eq!(values("U E0.0\nO(\nU E0.1\nU E0.2\n)\n= A4.0"), ["(E0.0 | (E0.1 & E0.2))"]);
    }

    #[test]
    fn comparison_takes_accumulator_2_first() {
        assert_eq!(values("L MW10\nL 20\n>I\n= A4.0"), ["(MW10 > 20)"]);
        // Two conditions around a comparison need parentheses; without, the comparison overwrites the first.
        assert_eq!(names("U E0.0\nL MW10\nL 20\n>I\n= A4.0"), ["UnconditionalAfterTest"]);
        assert_eq!(values("U E0.0\nU(\nL MW10\nL 20\n>I\n)\n= A4.0"), ["(E0.0 & (MW10 > 20))"]);
        assert_eq!(names("U E0.0\nU(\nL MW10\nL 20\n>I\n)\n= A4.0"), [""; 0]);
    }

    #[test]
    fn jumps_merge_again() {
        let code = "U E0.0\nSPB A1\nU E0.1\n= A4.0\nSPA E1\nA1: U E0.2\n= A4.0\nE1: U E0.3\n= A4.1";
        let model = block(code);
        assert!(model.unreachable.is_empty());
        let last = model.statements.iter().rev().find(|it| matches!(it.kind, StatementKind::Assign { .. })).unwrap();
        assert_eq!(last.path, Exprs::TRUE, "both ways lead there");
        let facts = crate::analysis::facts::UnitFacts::new(&model);
        let writes: Vec<u32> = facts.uses.iter().filter(|it| it.mode == Mode::Assign).map(|it| it.group).collect();
        assert_eq!(writes[0], writes[1], "only one of the two arms runs");
        assert_ne!(writes[0], writes[2]);
    }

    #[test]
    fn code_after_the_end_is_unreachable_until_a_label() {
        let model = block("U E0.0\nSPB W1\nBEA\nU E0.1\n= A4.0\nW1: U E0.2\n= A4.1\nBE\nL 1\nT MW0");
        let cuts: Vec<DeadCause> = model.unreachable.iter().map(|it| it.cause).collect();
        assert_eq!(cuts, [DeadCause::End, DeadCause::End]);
        // A loop is entered by the jump below it.
        let model = block("SPA W2\nW1: L MW0\nT MW2\nW2: U E0.2\nSPB W1");
        assert!(model.unreachable.is_empty());
    }

    #[test]
    fn rlo_oddities() {
        // S7:950-958: without SET the instructions act on the caller's RLO.
        assert_eq!(names("S M0.0\nR M0.1"), ["RloFromCaller"]);
        assert_eq!(names("SET\nS M0.0\nR M0.1"), [""; 0]);
        assert_eq!(names("U E0.0\n= A4.0\nCALL FC 2\nS M0.0"), ["RloAfterCall"]);
        assert_eq!(names("U E0.0\nSET\n= A4.0"), ["RloUnused"]);
        assert_eq!(names("U E0.0\nU E0.1"), ["RloUnused"]);
        // A conditional jump leaves RLO 1.
        assert_eq!(names("U E0.0\nSPB A1\nS M0.0\nA1: NOP 0"), [""; 0]);
        // A timer's duration stands between its condition and its start.
        assert_eq!(names("U E2.1\nL S5T#10S\nSE T1\nU T1\n= A4.0"), [""; 0]);
        assert_eq!(names("U E0.0\nL 5\nT MW0\nCALL FC 2"), ["UnconditionalAfterTest"]);
        assert_eq!(names("U E0.0\nL 5\nT MW0\n= A4.0"), [""; 0]);
    }

    #[test]
    fn accumulator_oddities() {
        // S7:366: the second load pushes the first out of reach.
        assert_eq!(names("L MW0\nL MW2\nL MW4\n+I\nT MW6"), ["DeadLoad"]);
        assert_eq!(names("L MW0\nL MW2\n+I\nT MW6"), [""; 0]);
        assert_eq!(names("L MW0\n+I\nT MW6"), ["MissingOperand(1)"]);
        assert_eq!(names("L MW0\n+ 5\nT MW6"), [""; 0]);
        // Used on one of two ways is used.
        assert_eq!(names("L MW0\nU E0.0\nSPB A1\nT MW2\nA1: NOP 0"), [""; 0]);
        // S7:1228: loaded where a store was meant.
        assert_eq!(names("AUF DB5\nL 0\nL DB5.DBW0\nBE"), ["DeadLoad"]);
        // How far a shift goes is an operand, too.
        assert_eq!(names("L MW0\nSLW\nT MW2"), ["MissingOperand(1)"]);
        assert_eq!(names("L MW0\nSLW 4\nRLDA\nT MW2"), [""; 0]);
    }

    #[test]
    fn lost_loads_in_a_row_are_one_finding() {
        let model = block("L MW0\nL MW2\nL MW4\nT MW6\nSET\nL MW8\nL MW10\nL MW12\nBE");
        let dead: Vec<(&str, usize)> = model
            .oddities
            .iter()
            .map(|it| (it.text.as_str(), it.related.iter().filter(|it| it.1 == LOST_TOO).count()))
            .collect();
        // MW4 is stored, and MW2 lies under it until MW10 is loaded.
        assert_eq!(dead, [("MW2", 1), ("MW12", 2)]);
    }

    #[test]
    fn a_function_answers_in_accumulator_1() {
        assert_eq!(names("L MW0\nT MW2\nL MW4"), [""; 0]);
        assert_eq!(names("L MW0\nT MW2\nL MW4\nBE"), [""; 0]);
        let parse =
            crate::syntax::awl::parse("ORGANIZATION_BLOCK OB 1\nBEGIN\nNETWORK\nL MW4\nBE\n", Mnemonics::German);
        let name = BlockName::Number(BlockKind::Ob, 1);
        let model = lower(parse.syntax(), Entity::Block { kind: BlockKind::Ob, name }, Mnemonics::German);
        assert_eq!(model.oddities.len(), 1, "nobody called it");
    }

    #[test]
    fn every_entry_of_a_jump_list_is_reached() {
        let model = block("L MB0\nSPL E3\nSPA E1\nSPA E2\nE3: SPA E2\nE1: U E0.0\n= A4.0\nE2: NOP 0");
        assert!(model.unreachable.is_empty(), "{:?}", model.unreachable);
        // The list ends with the first instruction that is no jump.
        let model = block("L MB0\nSPL E3\nSPA E1\nNOP 0\nSPA E2\nSPA E1\nE3: NOP 0\nE1: NOP 0\nE2: NOP 0");
        assert_eq!(model.unreachable.len(), 1);
    }

    #[test]
    fn what_closes_a_block_is_no_dead_code() {
        // S7:1230-1231.
        assert!(block("U E0.0\nSPB W1\nL 0\nT MW0\nW1: BEA\nNOP 0\nBE").unreachable.is_empty());
        assert!(model("SPA W1\n...\nU E0.0\n= A4.0\nW1: NOP 0\n").unreachable.is_empty(), "a label may be left out");
    }

    #[test]
    fn initial_values_are_read() {
        let text = "FUNCTION_BLOCK FB 1\nVAR\na : S5TIME := S5T#5S_12MS;\nb : INT := 5;\nc : ARRAY [0..3] OF INT := 4(0);\n\
                    END_VAR\nBEGIN\nEND_FUNCTION_BLOCK\n";
        let texts: Vec<SmolStr> = model(text).constants.into_iter().map(|it| it.text).collect();
        assert_eq!(texts, ["S5T#5S_12MS"]);
        let text = "DATA_BLOCK DB 1\nSTRUCT\na : WORD;\nEND_STRUCT;\nBEGIN\na := W#16#12345;\nEND_DATA_BLOCK\n";
        assert_eq!(model(text).oddities.len(), 1);
    }

    #[test]
    fn words_that_are_no_addresses() {
        assert_eq!(names("U TRUE\nO FALSE\n= A4.0\nLAR1 AR2"), [""; 0]);
        assert_eq!(names("U Depart\n= Lampe_1"), [""; 0], "symbols without their quotes");
        let malformed =
            |code: &str| block(code).oddities.iter().filter(|it| matches!(it.kind, OddityKind::Address(_))).count();
        assert_eq!(malformed("U E1\n= A4.0\nU E1\n= A4.1"), 2, "each place");
        assert_eq!(malformed("L MW\nT MW2"), 1);
        assert_eq!(malformed("U I1.0\n= A4.0"), 1);
    }

    #[test]
    fn data_blocks() {
        assert_eq!(names("L DBW0\nT MW0"), ["DataBlockNotOpen"]);
        assert_eq!(names("AUF DB5\nL DBW0\nT MW0"), [""; 0]);
        assert_eq!(names("L DB5.DBW0\nT DBW2"), [""; 0]);
        let model = block("AUF DB5\nL DBW0\nT MW0\nU DBX2.1\n= A4.0");
        let texts: Vec<String> =
            model.accesses.iter().map(|it| format!("{:?}", model.object(it.object).footprint.area)).collect();
        assert!(texts.iter().filter(|it| it.contains("Data(Number(Db, 5))")).count() == 2, "{texts:?}");
    }

    #[test]
    fn scratch_bits_are_not_exposed() {
        let model = block("U E0.0\n= M0.0\nU M0.0\n= A4.0\nU M0.1\n= A4.1");
        let exposed: Vec<(String, bool)> = model
            .accesses
            .iter()
            .filter(|it| it.mode == Mode::Read)
            .map(|it| (model.object(it.object).text.to_string(), it.exposed))
            .collect();
        assert_eq!(exposed, [("E0.0".to_owned(), true), ("M0.0".to_owned(), false), ("M0.1".to_owned(), true)]);
    }

    #[test]
    fn parentheses() {
        assert_eq!(names("U(\nU E0.0\n= A4.0"), ["UnclosedParenthesis"]);
        assert_eq!(names("U E0.0\n)\n= A4.0"), ["UnopenedParenthesis"]);
        let deep = format!("{}U E0.0\n{}= A4.0", "U(\n".repeat(8), ")\n".repeat(8));
        assert_eq!(names(&deep), ["ParenthesisDepth(8)"]);
    }

    #[test]
    fn listings_end_where_the_author_stopped() {
        let model = model("U E0.0\nL MW0\n");
        assert_eq!(oddities(&model), [""; 0]);
    }
}
