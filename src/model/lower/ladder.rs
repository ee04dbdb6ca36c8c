//! Ladder of PL7 and PL7-2 to the model.
//!
//! In PL7, in each connected network the controller takes the state of the contacts, then executes functions, blocks and
//! subroutines, then writes the coils, then leaves (PL7:2874-2884). A coil is therefore not seen by a contact of its own
//! network.
//!
//! PL7-2 scans a network column by column, and executes a block when it meets the left end of it (PL72:626-630). The coils
//! are in the last column. That the jumps of a network are taken behind its coils is assumed.

use rowan::TextRange;
use rustc_hash::{FxHashMap, FxHashSet};
use smol_str::{SmolStr, ToSmolStr as _};

use super::pl7::{self, Kind, Pl7};
use super::pl72;
use super::work::Elements;
use crate::model::UnitModel;
use crate::model::entity::{Entity, Part};
use crate::model::expr::{self, ExprId, Exprs, ObjectId};
use crate::model::ladder::{BlockShape, Flaw, Grid, Layout, Placed, Wire};
use crate::model::object::{self, Class, Object};
use crate::model::symbols::{Remark, RemarkKind};
use crate::model::unit::{Actual, Fork, Given, Leave, Mode, OddityKind, Pin, Slot, StatementKind};
use crate::model::work::{CodeKind, Network};
use crate::syntax::pl7::ast::{self, Expr, Stmt};
use crate::syntax::pl7::ladder_words::Element;
use crate::syntax::{AstNode as _, Language, SyntaxKind, SyntaxNode};

pub(super) fn lower(root: SyntaxNode<'_>, text: &str, entity: Entity, language: Language) -> UnitModel {
    let is_transition = matches!(&entity, Entity::Pl7 { part: Part::Chart(rest), .. } if rest.contains("-->"))
        || is_bare_receptivity(root);
    let mut pl7 = Pl7::new(root, entity, language);
    super::chart::enter_piece(&mut pl7);
    pl7.b.set_back_targets(pl7::back_targets(root, text, language));
    let code = ast::Root::cast(root).into_iter().flat_map(ast::Root::rungs);
    let (mut pl7, receptivity, _) = rungs(pl7, code, is_transition);
    if let Some(condition) = receptivity {
        pl7.b.statement(StatementKind::Branch { condition, of: Fork::Receptivity }, root.text_range());
    }
    pl7.b.finish()
}

/// The rungs of a section, an action or a transition. Gives what the `(#)` of a transition takes, and of its last rung what
/// [`Grid::link_before_end`] does.
pub(super) fn rungs<'t>(
    pl7: Pl7,
    rungs: impl IntoIterator<Item = ast::Rung<'t>>,
    is_transition: bool,
) -> (Pl7, Option<ExprId>, Option<(TextRange, u32)>) {
    let layout = Layout::of(pl7.b.model.language);
    let is_section =
        !pl7.b.model.language.is_chart() && !matches!(pl7.b.model.entity, Entity::Pl7 { part: Part::Chart(_), .. });
    let kind = match is_transition {
        true => CodeKind::Receptivity,
        false if is_section => CodeKind::Section,
        false => CodeKind::Action,
    };
    let piece = pl7.b.model.networks.last().map_or(0, |it| it.piece + 1);
    let mut lowering = Lowering { pl7, layout, is_transition, piece, kind, receptivity: None, link: None };
    for rung in rungs {
        lowering.rung(rung);
    }
    (lowering.pl7, lowering.receptivity, lowering.link)
}

/// One rung with a `(#)` and nothing that says what it belongs to: what documents print of a receptivity.
fn is_bare_receptivity(root: SyntaxNode<'_>) -> bool {
    let Some(root) = ast::Root::cast(root) else { return false };
    let mut rungs = root.rungs();
    let (Some(only), None) = (rungs.next(), rungs.next()) else { return false };
    // A heading, or the `PROGRAM` of an exchange file.
    let is_named = root.headings().next().is_some() || root.syntax().tokens().any(|it| !it.kind().is_trivia());
    !is_named && only.rows().flat_map(|it| it.cells()).any(|it| it.element() == Some(Element::HashCoil))
}

struct Lowering {
    pl7: Pl7,
    layout: Layout,
    is_transition: bool,
    /// Of the networks of PL7-2.
    piece: u32,
    kind: CodeKind,
    /// What the hash coils have taken.
    receptivity: Option<ExprId>,
    /// The link before the end of a receptivity.
    link: Option<(TextRange, u32)>,
}

/// A rung while it is executed. Its connected networks share no wire but the rail.
struct Run {
    /// Whether each wire has power.
    power: Vec<ExprId>,
    /// Conditions of contacts and comparisons, by element.
    tests: Vec<Option<ExprId>>,
    /// Calls of DFBs, by the place of the block.
    instances: FxHashMap<TextRange, u32>,
    /// Whether all of the rung was understood, once that was asked.
    is_read: Option<bool>,
}

/// A bit that a connected network of a rung uses.
struct Use {
    object: ObjectId,
    network: usize,
    range: TextRange,
}

impl Lowering {
    fn rung(&mut self, rung: ast::Rung<'_>) {
        self.pl7.b.next_network();
        let marks = self.marks();
        if let Some(label) = rung.label() {
            self.pl7.label(&label);
        }
        let mut length = 0;
        if self.layout == Layout::Pl72 {
            let comment = rung.syntax().tokens().find(|it| it.kind() == SyntaxKind::Comment);
            // What speaks to the linter is no text of the program.
            if let Some(it) = comment.filter(|it| !it.text().contains("plclint:")) {
                let remark = Remark::new(RemarkKind::Network, it.text(), it.text_range());
                length = remark.characters;
                self.pl7.b.model.remarks.push(remark);
            }
        }
        let grid = Grid::new(rung, self.layout);
        // The power at the end of a receptivity of PL7-2 is what the transition takes.
        let is_open = self.layout == Layout::Pl72 && self.is_transition;
        let last = self.layout.columns() - 1;
        let ends = grid.placed.iter().filter(|it| is_open && it.end() >= last).map(Placed::range);
        let ends: FxHashSet<TextRange> = ends.collect();
        let is_end = |flaw: Flaw, range: TextRange| flaw == Flaw::LeadsNowhere && ends.contains(&range);
        let mut flaws = grid.flaws();
        flaws.retain(|it| !is_end(it.0, it.1));
        if !flaws.is_empty() && !grid.is_read() {
            // The other cells may stand elsewhere than they seem to.
            flaws.clear();
        }
        for (flaw, range, related) in flaws {
            self.flaw(flaw, range).related.extend(related.map(|it| (it, "this wire goes round it")));
        }
        self.link = if self.is_transition { grid.link_before_end() } else { None };
        let networks = grid.networks();
        let mut contacts = Vec::new();
        let mut coils = Vec::new();
        let power = vec![Exprs::FALSE; grid.wire_count()];
        let tests = vec![None; grid.placed.len()];
        let mut run = Run { power, tests, instances: FxHashMap::default(), is_read: None };
        run.power[Grid::index(Wire::RAIL)] = Exprs::TRUE;
        for (number, elements) in networks.iter().enumerate() {
            self.network(&grid, elements, number, &mut run, &mut contacts, &mut coils);
        }
        self.read_before_driven(&contacts, &coils);
        for it in &grid.placed {
            self.allowed_in_transition(it);
        }
        if self.layout == Layout::Pl72 {
            let Elements { listed, unlisted, .. } = Elements::of(rung, &self.pl7.b.model);
            let ends = self.marks();
            self.pl7.b.model.networks.push(Network {
                kind: self.kind,
                piece: self.piece,
                elements: listed,
                unlisted,
                comment: length,
                labels: marks.0..ends.0,
                jumps: marks.1..ends.1,
            });
        }
    }

    /// Labels and jumps of the unit so far.
    fn marks(&self) -> (u32, u32) {
        let model = &self.pl7.b.model;
        (super::builder::index(model.labels.len()), super::builder::index(model.jumps.len()))
    }

    fn flaw(&mut self, flaw: Flaw, range: TextRange) -> &mut crate::model::unit::Oddity {
        self.pl7.b.oddity(OddityKind::Ladder(flaw), range, "")
    }

    fn network(
        &mut self,
        grid: &Grid<'_>,
        elements: &[usize],
        number: usize,
        run: &mut Run,
        contacts: &mut Vec<Use>,
        coils: &mut Vec<Use>,
    ) {
        if self.layout == Layout::Pl72 {
            return self.columns(grid, elements, run);
        }
        for &index in elements {
            let it = &grid.placed[index];
            if !matches!(it.element, Some(Element::HLink | Element::ShortCircuit)) {
                self.pl7.b.instruction(it.range());
            }
            run.tests[index] = self.test(it, |object, range| contacts.push(Use { object, network: number, range }));
        }
        for &index in elements {
            self.conduct(grid, index, run);
        }
        for &index in elements {
            let it = &grid.placed[index];
            if let Some((object, range)) = self.coil(it, run.at(grid, it)) {
                coils.push(Use { object, network: number, range });
            }
        }
        for &index in elements {
            let it = &grid.placed[index];
            self.leave(it, run.at(grid, it));
        }
    }

    /// A network of PL7-2, whose elements come in the order in which they are met.
    fn columns(&mut self, grid: &Grid<'_>, elements: &[usize], run: &mut Run) {
        for &index in elements {
            let it = &grid.placed[index];
            if !matches!(it.element, Some(Element::HLink | Element::ShortCircuit)) {
                self.pl7.b.instruction(it.range());
            }
            run.tests[index] = self.test(it, |_, _| ());
            self.conduct(grid, index, run);
            self.coil(it, run.at(grid, it));
        }
        for &index in elements {
            let it = &grid.placed[index];
            self.leave(it, run.at(grid, it));
            if self.is_transition && it.end() + 1 >= self.layout.columns() {
                for &wire in grid.outputs(it).iter().filter(|it| !grid.is_used(**it)) {
                    self.take(run.power[Grid::index(wire)]);
                }
            }
        }
    }

    /// What lets the transition be crossed.
    fn take(&mut self, when: ExprId) {
        self.receptivity = Some(match self.receptivity {
            Some(other) => self.pl7.b.exprs().or(other, when),
            None => when,
        });
    }

    /// State of a contact or comparison.
    fn test(&mut self, it: &Placed<'_>, mut contact: impl FnMut(ObjectId, TextRange)) -> Option<ExprId> {
        let element = it.element?;
        if element == Element::Compare {
            return Some(match it.cell.comparison() {
                Some(Expr::Bin(expr)) if self.layout == Layout::Pl72 => self.pl7.word_comparison(&expr),
                Some(expr) => match self.pl7.expr(&expr) {
                    // What was not read may have made it a comparison.
                    (_, Kind::Number | Kind::Float) if it.is_broken() => self.pl7.b.exprs().opaque(),
                    (_, Kind::Number | Kind::Float) => {
                        let message = "a comparison block takes a comparison, not a number".to_owned();
                        self.operand_type(message, &expr)
                    }
                    (value, _) => value,
                },
                None => self.pl7.b.exprs().opaque(),
            });
        }
        if !element.is_test() || element == Element::Block {
            return None;
        }
        let value = match it.cell.operand() {
            Some(Expr::Literal(literal)) => {
                let (value, kind) = self.pl7.literal(&literal);
                match (kind, self.pl7.b.exprs().get(value)) {
                    (Kind::Bit, _) => value,
                    (_, expr::Expr::Int(0)) => Exprs::FALSE,
                    (_, expr::Expr::Int(1)) => Exprs::TRUE,
                    _ => self.takes_a_bit("a contact", &Expr::Literal(literal)),
                }
            }
            Some(operand) => match self.pl7.place(&operand) {
                Some((object, _)) if self.pl7.kind(object).is_number() => self.takes_a_bit("a contact", &operand),
                Some((object, at)) => {
                    contact(object, at);
                    match element {
                        Element::Rising => self.pl7.b.edge(object, true, at),
                        Element::Falling => self.pl7.b.edge(object, false, at),
                        _ => self.pl7.read(object, at),
                    }
                }
                None => self.pl7.expr(&operand).0,
            },
            None => self.pl7.b.exprs().opaque(),
        };
        Some(if element == Element::Closed { self.pl7.b.exprs().not(value) } else { value })
    }

    fn takes_a_bit(&mut self, what: &str, operand: &Expr<'_>) -> ExprId {
        let text = operand.syntax().text();
        self.operand_type(format!("{what} takes a bit, and `{text}` is none"), operand)
    }

    fn operand_type(&mut self, message: String, operand: &Expr<'_>) -> ExprId {
        let text = operand.syntax().text().into_owned();
        self.pl7.b.oddity(OddityKind::OperandType(message), operand.syntax().text_range(), text);
        self.pl7.b.exprs().opaque()
    }

    /// Lets power through an element, and executes blocks, operations and calls.
    fn conduct(&mut self, grid: &Grid<'_>, index: usize, run: &mut Run) {
        let it = &grid.placed[index];
        let before = run.at(grid, it);
        let through = match it.element {
            Some(Element::HLink | Element::ShortCircuit) => before,
            Some(Element::Actual) => return,
            Some(Element::Block) => return self.block(grid, it, run),
            Some(Element::Operate) => return self.operate(it, before),
            Some(Element::Call) => {
                if let Some((token, number)) = it.cell.subroutine() {
                    self.pl7.subroutine(number, token.text(), before, token.text_range(), it.range());
                }
                return;
            }
            Some(element) if element.is_action() => return,
            _ => {
                let value = run.tests[index].unwrap_or_else(|| self.pl7.b.exprs().opaque());
                self.pl7.b.exprs().and(before, value)
            }
        };
        for &wire in grid.outputs(it) {
            run.join(&mut self.pl7, wire, through);
        }
    }

    fn block(&mut self, grid: &Grid<'_>, it: &Placed<'_>, run: &mut Run) {
        if let Some(shape) = self.layout.block_of(it.cell).filter(|it| it.letters().is_empty()) {
            return self.clock(grid, it, shape, run);
        }
        let place = it.cell.operand().and_then(|it| self.pl7.place(&it));
        let is_block = place.is_some_and(|(object, _)| self.pl7.b.model.object(object).class == Class::Block);
        match (place, self.layout.block_of(it.cell)) {
            (Some((object, at)), Some(block)) if is_block => {
                let mut is_driven = false;
                for (&wire, name) in grid.inputs(it).iter().zip(block.inputs()) {
                    // An input without a wire is 0 (PL7:2813).
                    if grid.is_fed(wire) {
                        is_driven = true;
                        let when = run.power[Grid::index(wire)];
                        let pin = match self.layout {
                            Layout::Pl7 => pl7::pin(block.letters(), name),
                            Layout::Pl72 => pl72::pin(block.letters(), name),
                        };
                        self.pl7.b.drive(object, pin, when, None, at, it.range());
                    }
                }
                if !is_driven {
                    self.pl7.b.touch(object, Mode::Drive(Pin::Whole), at);
                }
                for (row, &wire) in grid.outputs(it).iter().enumerate().filter(|it| grid.is_used(*it.1)) {
                    let value = match block.outputs().get(row) {
                        Some(name) => self.output(object, name, at),
                        None => Exprs::FALSE,
                    };
                    run.join(&mut self.pl7, wire, value);
                }
            }
            (place, _) => {
                if let (Some((object, at)), Some(operand)) = (place, it.cell.operand()) {
                    let data = self.pl7.b.model.object(object);
                    if data.class == Class::Symbol {
                        let name = data.text.clone();
                        self.instance(grid, it, &name, at, run);
                    } else if data.class != Class::Indirect {
                        let text = operand.syntax().text();
                        self.operand_type(format!("`{text}` is no function block"), &operand);
                    }
                }
                for &wire in grid.outputs(it).iter().filter(|it| grid.is_used(**it)) {
                    let value = self.pl7.b.exprs().opaque();
                    run.join(&mut self.pl7, wire, value);
                }
            }
        }
    }

    /// The clock of PL7-2, which has no objects: what it says is known to nobody.
    fn clock(&mut self, grid: &Grid<'_>, it: &Placed<'_>, shape: BlockShape, run: &mut Run) {
        if let Some(Expr::Call(call)) = it.cell.operand() {
            for parameter in call.operands() {
                self.pl7.expr(&parameter);
            }
        }
        for (_, &wire) in shape.outputs().iter().zip(grid.outputs(it)).filter(|it| grid.is_used(*it.1)) {
            let value = self.pl7.b.exprs().opaque();
            run.join(&mut self.pl7, wire, value);
        }
    }

    fn output(&mut self, object: ObjectId, name: &str, at: TextRange) -> ExprId {
        let block = &self.pl7.b.model.object(object).text;
        let (address, parsed) = match self.layout {
            Layout::Pl7 => {
                let address = format!("{block}.{name}");
                let parsed = object::pl7::parse(&address);
                (address, parsed)
            }
            Layout::Pl72 => {
                let address = format!("{block},{name}");
                let parsed = object::pl72::parse(&address).map(|it| it.object);
                (address, parsed)
            }
        };
        let output = parsed.unwrap_or_else(|_| Object::symbol(&address));
        let output = self.pl7.b.object(output);
        self.pl7.read(output, at)
    }

    /// A block under a symbol: an instance of a DFB, as far as it shows. It is called in each scan of the rung.
    fn instance(&mut self, grid: &Grid<'_>, it: &Placed<'_>, name: &str, at: TextRange, run: &mut Run) {
        let mut actuals = Vec::new();
        let is_read = *run.is_read.get_or_insert_with(|| grid.is_read());
        let wired = if is_read { Given::Wire } else { Given::Unknown };
        for (row, &wire) in (0..).zip(grid.inputs(it)) {
            if let Some(operand) = grid.input_actual(wire).and_then(|it| it.cell.operand()) {
                actuals.push(self.pl7.actual(Slot::Left(row), &operand));
            } else if grid.is_fed(wire) && (row == 0 || wire != Wire::RAIL) {
                // A block beside the rail hangs on it by its first row alone.
                let anchor = self.pl7.b.anchor(at);
                actuals.push(Actual { slot: Slot::Left(row), anchor, given: wired });
            }
        }
        for (row, &wire) in (0..).zip(grid.outputs(it)) {
            if let Some(operand) = grid.output_actual(wire).and_then(|it| it.cell.operand()) {
                actuals.push(self.pl7.actual(Slot::Right(row), &operand));
            } else if grid.is_used(wire) {
                let anchor = self.pl7.b.anchor(at);
                actuals.push(Actual { slot: Slot::Right(row), anchor, given: wired });
            }
        }
        let call = self.pl7.instance(name, at, it.range(), actuals, is_read);
        run.instances.insert(it.range(), call);
        if let Some(&before) = grid.too_close(it).and_then(|it| run.instances.get(&it.range())) {
            self.pl7.b.model.calls[call as usize].too_close = Some(before);
        }
    }

    /// An operation block: done when it has power.
    fn operate(&mut self, it: &Placed<'_>, when: ExprId) {
        let before = self.pl7.b.path();
        let inside = self.pl7.b.exprs().and(before, when);
        self.pl7.b.enter(inside, None);
        for statement in it.cell.operations() {
            match statement {
                Stmt::Assign(it) if self.layout == Layout::Pl72 => self.pl7.word_operation(&it),
                Stmt::Assign(it) => self.pl7.assignment(&it),
                Stmt::Call(it) => self.pl7.call_stmt(&it),
                Stmt::Expr(it) => {
                    if let Some(expr) = it.expr() {
                        self.pl7.expr(&expr);
                    }
                }
                _ => {}
            }
        }
        self.pl7.b.enter(before, None);
    }

    /// Writes a coil; gives the bit that takes the condition.
    fn coil(&mut self, it: &Placed<'_>, when: ExprId) -> Option<(ObjectId, TextRange)> {
        let range = it.range();
        let element = it.element?;
        match element {
            Element::HashCoil => {
                self.take(when);
                return None;
            }
            Element::Coil | Element::NotCoil | Element::SetCoil | Element::ResetCoil | Element::SaveCoil => {}
            _ => return None,
        }
        let operand = it.cell.operand()?;
        let Some((object, at)) = self.pl7.place(&operand) else {
            self.takes_a_bit("a coil", &operand);
            return None;
        };
        let class = self.pl7.b.model.object(object).class;
        if class == Class::Indirect {
            return None;
        }
        if class == Class::Block || self.pl7.kind(object).is_number() {
            self.takes_a_bit("a coil", &operand);
            return None;
        }
        match element {
            Element::SetCoil => self.pl7.b.set(object, when, at, range),
            Element::ResetCoil => self.pl7.b.reset(object, when, at, range),
            Element::NotCoil => {
                let value = self.pl7.b.exprs().not(when);
                self.pl7.b.assign(object, true, value, at, range);
            }
            _ => self.pl7.b.assign(object, false, when, at, range),
        }
        matches!(element, Element::Coil | Element::NotCoil | Element::SaveCoil).then_some((object, at))
    }

    fn leave(&mut self, it: &Placed<'_>, when: ExprId) {
        let range = it.range();
        match it.element {
            Some(Element::Jump) => {
                if let Some(label) = it.cell.label() {
                    self.pl7.jump(label.text(), label.text_range(), when, range);
                }
            }
            Some(Element::Return) => self.pl7.leave(when, Leave::Subroutine, range),
            Some(Element::Halt) => self.pl7.halt(when, range),
            _ => {}
        }
    }

    /// A contact has the former value of a bit that a later network of the rung drives. Where each of two networks reads
    /// what the other one drives, no order is better.
    fn read_before_driven(&mut self, contacts: &[Use], coils: &[Use]) {
        let mut driven: FxHashMap<ObjectId, (usize, usize)> = FxHashMap::default();
        for (index, coil) in coils.iter().enumerate() {
            driven.entry(coil.object).or_insert((coil.network, index));
        }
        // Which networks read what another one drives.
        let depends: rustc_hash::FxHashSet<(usize, usize)> = contacts
            .iter()
            .filter_map(|it| Some((it.network, driven.get(&it.object)?.0)))
            .filter(|(reader, driver)| reader != driver)
            .collect();
        for contact in contacts {
            let Some(&(network, coil)) = driven.get(&contact.object) else { continue };
            let is_fixed = self.pl7.b.model.object(contact.object).is_fixed();
            if !is_fixed || network <= contact.network || depends.contains(&(network, contact.network)) {
                continue;
            }
            let text: SmolStr = self.pl7.b.model.object(contact.object).text.to_smolstr();
            let oddity = self.pl7.b.oddity(OddityKind::Ladder(Flaw::ReadBeforeDriven), contact.range, text);
            oddity.related.push((coils[coil].range, "driven here, further down in the same rung"));
        }
    }

    fn allowed_in_transition(&mut self, it: &Placed<'_>) {
        let Some(element) = it.element else { return };
        let is_coil = matches!(
            element,
            Element::Coil | Element::NotCoil | Element::SetCoil | Element::ResetCoil | Element::SaveCoil
        );
        let flaw = match element {
            Element::HashCoil if !self.is_transition => Flaw::HashOutsideTransition,
            _ if !self.is_transition || element == Element::HashCoil => return,
            _ if is_coil => Flaw::CoilInTransition,
            // All of the test zone may be used in PL7-2 (PL72:1484).
            Element::Block if self.layout == Layout::Pl72 => return,
            Element::Block => Flaw::ElementInTransition,
            _ if element.is_action() => Flaw::ElementInTransition,
            _ => return,
        };
        self.flaw(flaw, it.range());
    }
}

impl Run {
    /// Power at the left edge of an element.
    fn at(&self, grid: &Grid<'_>, it: &Placed<'_>) -> ExprId {
        grid.inputs(it).first().map_or(Exprs::FALSE, |it| self.power[Grid::index(*it)])
    }

    fn join(&mut self, pl7: &mut Pl7, wire: Wire, value: ExprId) {
        let before = self.power[Grid::index(wire)];
        self.power[Grid::index(wire)] = pl7.b.exprs().or(before, value);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::entity::Task;
    use crate::model::lower::testing;

    fn part(rungs: &str, part: Part) -> UnitModel {
        let parse = crate::syntax::pl7::parse_ld(rungs);
        assert_eq!(parse.errors(), [], "{rungs}");
        lower(parse.syntax(), rungs, Entity::Pl7 { task: Task::Mast, section: None, part }, Language::Pl7Ld)
    }

    fn model(rows: &str) -> UnitModel {
        part(&format!("RUNG\n{rows}\nEND_RUNG"), Part::Main)
    }

    fn statements(rows: &str) -> Vec<String> {
        testing::statements(&model(rows))
    }

    fn flaws(model: &UnitModel) -> Vec<Flaw> {
        let flaw = |it: &crate::model::unit::Oddity| match it.kind {
            OddityKind::Ladder(flaw) => Some(flaw),
            _ => None,
        };
        model.oddities.iter().filter_map(flaw).collect()
    }

    #[test]
    fn power_flows_through_contacts_and_links() {
        assert_eq!(
            statements(
                "OPEN_CONTACT(%M0),SHORT_CIRCUIT,CLOSED_CONTACT(%M1),H_LINK(7),COIL(%M5);\n\
                 P_CONTACT(%M2),N_CONTACT(%M3),EMPTY_CELL(9);"
            ),
            ["%M5 := ((%M0 | (^%M2 & v%M3)) & !%M1)"]
        );
        // A link both ways: what comes from below serves the line above, and the other way round.
        assert_eq!(
            statements(
                "OPEN_CONTACT(%M0),SHORT_CIRCUIT,OPEN_CONTACT(%M1),H_LINK(7),COIL(%M5);\n\
                 OPEN_CONTACT(%M2),H_LINK,OPEN_CONTACT(%M3),H_LINK(7),NOT_COIL(%M6);"
            ),
            ["%M5 := ((%M0 | %M2) & %M1)", "%M6 := !((%M0 | %M2) & %M3)"]
        );
        assert_eq!(statements("EMPTY_CELL(10),COIL(%M5);"), ["%M5 := false"]);
        assert_eq!(statements("OPEN_CONTACT(1),CLOSED_CONTACT(FALSE),H_LINK(8),COIL(%M5);"), ["%M5 := true"]);
    }

    #[test]
    fn actions() {
        assert_eq!(
            statements(
                "OPEN_CONTACT(%M0),SHORT_CIRCUIT(9),SET_COIL(%M5);\nEMPTY_CELL(9),V_LINK,RESET_COIL(%M6);\n\
                 EMPTY_CELL(9),V_LINK,CALL_COIL(SR5);\nEMPTY_CELL(10),JUMP_COIL(%L10);"
            ),
            ["call SR5 when %M0", "set %M5 when %M0", "reset %M6 when %M0", "jump when %M0"]
        );
        assert_eq!(
            statements("OPEN_CONTACT(%M0),H_LINK(9),RETURN_COIL;\nOPEN_CONTACT(%M1),H_LINK(9),HALT_COIL();"),
            ["return when %M0", "!%M0: halt"]
        );
        assert_eq!(statements("OPEN_CONTACT(%M0),H_LINK(9),HASH_COIL;"), ["branch on %M0"]);
    }

    #[test]
    fn blocks() {
        assert_eq!(
            statements("OPEN_CONTACT(%M0),BLOCK(%TM1),H_LINK(7),COIL(%M5);"),
            ["start of %TM1 when %M0", "%M5 := %TM1.Q"]
        );
        assert_eq!(
            statements(
                "OPEN_CONTACT(%M0),BLOCK(%C8),H_LINK(6),COIL(%M5);\nEMPTY_CELL(4),H_LINK(6),COIL(%M6);\n\
                 OPEN_CONTACT(%M1),EMPTY_CELL(10);\nOPEN_CONTACT(%M2),EMPTY_CELL(10);"
            ),
            [
                "reset of %C8 when %M0",
                "count-up of %C8 when %M1",
                "count-down of %C8 when %M2",
                "%M5 := %C8.E",
                "%M6 := %C8.D"
            ]
        );
        assert_eq!(statements("H_LINK,BLOCK(%MN2),EMPTY_CELL(7);"), ["start of %MN2 when true"]);
        // An output wired to the input of the next.
        assert_eq!(
            statements("OPEN_CONTACT(%M0),BLOCK(%TM1),BLOCK(%TM2),H_LINK(5),COIL(%M5);"),
            ["start of %TM1 when %M0", "start of %TM2 when %TM1.Q", "%M5 := %TM2.Q"]
        );
        assert_eq!(statements("H_LINK,BLOCK(Pump),EMPTY_CELL(7);"), ["call Pump when true"]);
    }

    #[test]
    fn blocks_of_dfbs() {
        let model = model(
            "OPEN_CONTACT(%M0),H_LINK,BLOCK(Vis),H_LINK(5),COIL(%Q2.0);\n\
             EMPTY_CELL,EFFECTIVE_PARAMETER(%MW10+1),EMPTY_CELL(3),EFFECTIVE_PARAMETER(%MW20),EMPTY_CELL(5);\n\
             EMPTY_CELL,EFFECTIVE_PARAMETER(%MW30),EMPTY_CELL(9);",
        );
        let call = &model.calls[0];
        let shown: Vec<String> = call
            .actuals
            .iter()
            .map(|it| match it.given {
                Given::Object(object) => format!("{:?} {}", it.slot, model.object(object).text),
                other => format!("{:?} {other:?}", it.slot),
            })
            .collect();
        assert_eq!(
            shown,
            ["Left(0) Wire", "Left(1) Expression(Integer)", "Left(2) %MW30", "Right(0) Wire", "Right(1) %MW20"]
        );
        assert!(call.full && call.too_close.is_none());
        let modes: Vec<(Mode, &str)> =
            model.accesses.iter().map(|it| (it.mode, model.object(it.object).text.as_str())).collect();
        assert_eq!(modes[1..4], [(Mode::Read, "%MW10"), (Mode::InOut, "%MW30"), (Mode::Output, "%MW20")]);
        assert_eq!(flaws(&model), []);
    }

    #[test]
    fn what_a_block_beside_the_rail_is_given() {
        let slots = |rows| model(rows).calls[0].actuals.iter().map(|it| it.slot).collect::<Vec<_>>();
        assert_eq!(slots("BLOCK(Vis),EMPTY_CELL(8);\nEMPTY_CELL(11);"), [Slot::Left(0)]);
        let flawed =
            model("EMPTY_CELL,BLOCK(Vis),EMPTY_CELL(7);\nEMPTY_CELL(5),EFFECTIVE_PARAMETER(%MW1),EMPTY_CELL(5);");
        assert_eq!(flaws(&flawed), [Flaw::BlockNotFed, Flaw::FacesNoPin]);
    }

    #[test]
    fn dfbs_in_series() {
        let close = |rows| model(rows).calls.iter().map(|it| it.too_close).collect::<Vec<_>>();
        assert_eq!(close("OPEN_CONTACT(%M0),BLOCK(A),H_LINK,BLOCK(B),H_LINK(2),COIL(%M1);"), [None, Some(0)]);
        assert_eq!(close("OPEN_CONTACT(%M0),BLOCK(A),H_LINK(2),BLOCK(B),H_LINK,COIL(%M1);"), [None, None]);
        // A branch from the line below, around a corner.
        let branch =
            "OPEN_CONTACT(%M0),BLOCK(A),EMPTY_CELL,BLOCK(B),H_LINK(2),COIL(%M1);\nEMPTY_CELL(4),EMPTY_CELL(7);";
        assert_eq!(close(branch), [None, None], "no wire joins them");
    }

    #[test]
    fn a_call_in_a_rung_that_is_not_understood_is_not_whole() {
        let text = "RUNG\nOPEN_CONTACT(%M0),BLOCK(Vis),H_LINK(6),COIL(%M1);\nPIN(%MW10),EMPTY_CELL(10);\nEND_RUNG";
        let parse = crate::syntax::pl7::parse_ld(text);
        let errors: Vec<_> = parse.errors().iter().map(|it| it.message.to_string()).collect();
        assert_eq!(errors, ["`PIN` is no element of a rung"]);
        let entity = Entity::Pl7 { task: Task::Mast, section: None, part: Part::Main };
        let model = lower(parse.syntax(), text, entity, Language::Pl7Ld);
        assert!(!model.calls[0].full && model.calls[0].actuals.iter().all(|it| it.given == Given::Unknown));
        assert_eq!(model.statements.len(), 2, "the coil is driven all the same");
    }

    #[test]
    fn comparisons_and_operations() {
        assert_eq!(
            statements("COMPARE %MW0>5 AND %M1 END_BLOCK,H_LINK(5),OPERATE %MW1:=%MW2+1; INC %MW3 END_BLOCK;"),
            ["((%MW0 > 5) & %M1): %MW1 := Add(%MW2, 1)", "((%MW0 > 5) & %M1): %MW3 := Add(%MW3, 1)"]
        );
    }

    #[test]
    fn contacts_are_read_before_coils_are_written() {
        let versions = |rows: &str| -> Vec<bool> {
            let it = model(rows);
            let reads = it.accesses.iter().filter(|a| a.mode == Mode::Read && it.object(a.object).text == "%M5");
            reads.map(|it| it.exposed).collect()
        };
        // One network: the contact does not see the coil. Two networks: it does.
        let joined = "OPEN_CONTACT(%M0),SHORT_CIRCUIT,H_LINK(8),COIL(%M5);\nEMPTY_CELL(2),OPEN_CONTACT(%M5),H_LINK(7),COIL(%M6);";
        assert_eq!(versions(joined), [true]);
        let apart = "OPEN_CONTACT(%M0),H_LINK(9),COIL(%M5);\nOPEN_CONTACT(%M5),H_LINK(9),COIL(%M6);";
        assert_eq!(versions(apart), [false]);
    }

    #[test]
    fn order_of_networks() {
        let late = "OPEN_CONTACT(%M5),H_LINK(9),COIL(%M6);\nOPEN_CONTACT(%M0),H_LINK(9),COIL(%M5);";
        assert_eq!(flaws(&model(late)), [Flaw::ReadBeforeDriven]);
        let interlock = "OPEN_CONTACT(%M0),CLOSED_CONTACT(%M6),H_LINK(8),COIL(%M5);\n\
                         OPEN_CONTACT(%M1),CLOSED_CONTACT(%M5),H_LINK(8),COIL(%M6);";
        assert_eq!(flaws(&model(interlock)), []);
    }

    #[test]
    fn transitions() {
        let transition = || Part::Chart("CHART - PAGE 0 %X(0) --> %X(1)".into());
        let rung =
            "RUNG\nOPEN_CONTACT(%M0),BLOCK(%TM0),SHORT_CIRCUIT(7),HASH_COIL;\nEMPTY_CELL(10),COIL(%M1);\nEND_RUNG";
        assert_eq!(flaws(&part(rung, transition())), [Flaw::ElementInTransition, Flaw::CoilInTransition]);
        let receptivity = "RUNG\nH_LINK(10),HASH_COIL;\nEND_RUNG";
        assert_eq!(flaws(&part(receptivity, Part::Main)), []);
        let section = format!("LD : MAST - MAIN\n{receptivity}");
        assert_eq!(flaws(&part(&section, Part::Main)), [Flaw::HashOutsideTransition]);
    }

    /// What was not read may be why the rest stands where it does: one mistake, one finding.
    #[test]
    fn a_rung_that_was_not_read_has_no_flaws() {
        for row in [
            "OPEN_CONTACT(%M0),H_LINK(x),COIL(%M1);",
            "OPEN_CONTACT(%M0),H_LINK(3),FOO,COIL(%M1);",
            "COMPARE %MW0 => 5 END_BLOCK,H_LINK(8),COIL(%M1);",
            "OPEN_CONTACT(%M0),H_LINK(9),JUMP_COIL(L10);",
        ] {
            let text = format!("RUNG\n{row}\nEND_RUNG");
            let parse = crate::syntax::pl7::parse_ld(&text);
            let entity = Entity::Pl7 { task: Task::Mast, section: None, part: Part::Main };
            let found = lower(parse.syntax(), &text, entity, Language::Pl7Ld);
            assert_eq!((parse.errors().len(), found.oddities.len(), found.jumps.len()), (1, 0, 0), "{row}");
        }
    }

    #[test]
    fn operands_that_do_not_fit() {
        let kinds = |rows: &str| model(rows).oddities.into_iter().map(|it| it.kind).collect::<Vec<_>>();
        for rows in [
            "OPEN_CONTACT(%MW0),H_LINK(9),COIL(%M0);",
            "OPEN_CONTACT(5),H_LINK(9),COIL(%M0);",
            "OPEN_CONTACT(%M0),H_LINK(9),COIL(%TM0);",
            "COMPARE %MW0+1 END_BLOCK,H_LINK(8),COIL(%M0);",
            "H_LINK,BLOCK(%MW0),EMPTY_CELL(7);",
        ] {
            assert!(matches!(kinds(rows).as_slice(), [OddityKind::OperandType(_)]), "{rows}: {:?}", kinds(rows));
        }
        assert!(matches!(kinds("OPEN_CONTACT(%M),H_LINK(9),COIL(%M0);").as_slice(), [OddityKind::Address(_)]));
    }
}
