//! Charts to the model: structure, then the code of receptivities and actions in the order in which the controller runs it.
//!
//! A receptivity is looked at while the steps before its transition are active (PL7:4649); then come the actions at
//! deactivation, those at activation, and the continuous ones (PL7:4565-4569). Between two pieces of code those of other
//! pages may run, so that no value is known from one to the next.

use rowan::{TextRange, TextSize};
use rustc_hash::{FxHashMap, FxHashSet};
use smol_str::SmolStr;

use super::builder::{Builder, index};
use super::pl7::{self, Pl7};
use super::{il, ladder, st};
use crate::model::UnitModel;
use crate::model::chart::{
    self, Action, ActionKind, Cell, Chart, CodeLanguage, Connector, ConnectorKind, Graph, Link, LinkKind, Node, Piece,
    Receptivity, Room, Segment, Step, StepKind, StepName, Transition,
};
use crate::model::entity::Entity;
use crate::model::expr::{ExprId, Exprs, ObjectId};
use crate::model::object::{self, Class, Object};
use crate::model::unit::{Fork, Mode, StatementKind};
use crate::syntax::pl7::ast::{BinOp, Expr, IlInstr, Rung, Sentence, Stmt};
use crate::syntax::pl7::chart::ast;
use crate::syntax::pl7::instructions::IlOp;
use crate::syntax::{AstNode as _, Language, SyntaxKind, SyntaxNode, SyntaxToken};

pub(super) fn lower(root: SyntaxNode<'_>, text: &str, entity: Entity, language: Language) -> UnitModel {
    let place = chart::place(&entity);
    let graph = place.as_ref().map_or(Graph::Main, |it| it.graph);
    let mut lowering = Lowering {
        text,
        pl7: Some(Pl7::new(root, entity, language)),
        chart: Chart::new(graph),
        bits: FxHashMap::default(),
        codes: Vec::new(),
        named: Vec::new(),
        named_at: FxHashMap::default(),
        associations: Vec::new(),
        receptivities: Vec::new(),
    };
    lowering.collect(root, place.and_then(|it| it.page));
    lowering.chart.join();
    lowering.name_ends();
    lowering.receptivities();
    lowering.name_actions();
    for phase in [ActionKind::Deactivation, ActionKind::Activation] {
        lowering.actions(|kind| kind == Some(phase));
    }
    lowering.actions(|kind| !matches!(kind, Some(ActionKind::Deactivation | ActionKind::Activation)));
    lowering.bit_actions();
    let Lowering { pl7, mut chart, .. } = lowering;
    chart.actions.sort_by_key(|it| it.anchors.start);
    // The lowering gives it back after each piece of code.
    let Some(pl7) = pl7 else {
        return Builder::new(Entity::Container, language, TextRange::default(), TextSize::new(0)).finish();
    };
    let mut model = pl7.b.finish();
    model.chart = Some(Box::new(chart));
    model
}

/// Of a unit that is one action or receptivity by its heading: the condition under which it runs is where its code starts.
pub(super) fn enter_piece(pl7: &mut Pl7) {
    let Some(place) = chart::place(&pl7.b.model.entity) else { return };
    let mut chart = Chart::new(place.graph);
    let heading = pl7.b.model.anchors.first().copied().unwrap_or_default();
    let path = match place.what {
        Piece::Chart => return,
        Piece::Action { step, kind } => {
            let bit = step_bit(pl7, &step, place.graph);
            let path = guard(pl7, kind, bit);
            chart.steps.push(Step {
                text: SmolStr::from(step.to_string()),
                kind: kind_of(&step),
                name: Some(step),
                cell: None,
                range: heading,
                anchor: 0,
                commented: false,
            });
            chart.actions.push(Action {
                steps: vec![0],
                kind: Some(kind),
                language: None,
                path,
                anchors: 0..u32::MAX,
                range: heading,
            });
            path
        }
        Piece::Receptivity { from, .. } => {
            let bit = step_bit(pl7, &from, place.graph);
            peek(pl7, bit)
        }
    };
    pl7.b.enter(path, None);
    // A step that a heading names is defined elsewhere, if at all.
    let is_action = !chart.actions.is_empty();
    pl7.b.model.chart = is_action.then(|| Box::new(chart));
}

fn kind_of(name: &StepName) -> StepKind {
    match name {
        StepName::In => StepKind::In,
        StepName::Out => StepKind::Out,
        StepName::Macro(_) => StepKind::Macro,
        StepName::Number(_) | StepName::Symbol(_) => StepKind::Simple,
    }
}

/// The bit of a step; `None` where no controller has it.
fn step_bit(pl7: &mut Pl7, name: &StepName, graph: Graph) -> Option<ObjectId> {
    let text = name.bit(graph);
    let object = match name {
        StepName::Symbol(_) => Object::symbol(&text),
        _ if pl7.is_pl7_2() => object::pl72::parse(text.trim_start_matches('%')).ok()?.object,
        _ => object::pl7::parse(&text).ok()?,
    };
    Some(pl7.b.object(object))
}

fn peek(pl7: &mut Pl7, bit: Option<ObjectId>) -> ExprId {
    match bit {
        Some(bit) => pl7.b.peek(bit),
        None => pl7.b.exprs().opaque(),
    }
}

/// When an action of a step runs.
fn guard(pl7: &mut Pl7, kind: ActionKind, bit: Option<ObjectId>) -> ExprId {
    let Some(bit) = bit else { return pl7.b.exprs().opaque() };
    match kind {
        ActionKind::Continuous => pl7.b.peek(bit),
        ActionKind::Activation => pl7.b.peek_edge(bit, true),
        ActionKind::Deactivation => pl7.b.peek_edge(bit, false),
        ActionKind::Stored | ActionKind::Reset => pl7.b.exprs().opaque(),
        ActionKind::Timed => {
            let (active, in_time) = (pl7.b.peek(bit), pl7.b.exprs().opaque());
            pl7.b.exprs().and(active, in_time)
        }
    }
}

/// `Fill(N)` in a step.
struct Association<'t> {
    step: u32,
    target: SyntaxToken<'t>,
    kind: Option<ActionKind>,
    range: TextRange,
}

/// An action that steps name.
struct Named {
    /// In lower case.
    name: SmolStr,
    /// Index into [`Chart::actions`].
    action: usize,
    /// Who runs it how.
    users: Vec<(u32, ActionKind)>,
}

struct Lowering<'t> {
    text: &'t str,
    /// Taken while the lowering of a language has it.
    pl7: Option<Pl7>,
    chart: Chart,
    /// Bits of the steps.
    bits: FxHashMap<u32, Option<ObjectId>>,
    /// The code of [`Chart::actions`], one each.
    codes: Vec<ast::ChartAction<'t>>,
    /// Actions that steps name.
    named: Vec<Named>,
    /// Index into `named` of each of [`Chart::actions`] that is one.
    named_at: FxHashMap<usize, usize>,
    associations: Vec<Association<'t>>,
    /// The code of [`Chart::transitions`], one each.
    receptivities: Vec<ast::Transition<'t>>,
}

impl<'t> Lowering<'t> {
    fn collect(&mut self, root: SyntaxNode<'t>, page: Option<u32>) {
        for node in root.children() {
            if let Some(it) = ast::Page::cast(node) {
                let page = it.number().or(page);
                for node in node.children() {
                    self.element(node, page);
                }
            } else if let Some(it) = ast::PageCount::cast(node) {
                self.chart.page_count = self.chart.page_count.or(it.count());
            } else {
                self.element(node, page);
            }
        }
    }

    fn element(&mut self, node: SyntaxNode<'t>, page: Option<u32>) {
        if node.kind() == SyntaxKind::Error {
            self.chart.has_gaps = true;
        } else if let Some(it) = ast::ChartStep::cast(node) {
            self.step(it, page);
        } else if let Some(it) = ast::ChartAction::cast(node) {
            self.action(it, None);
        } else if let Some(it) = ast::Transition::cast(node) {
            let range = it.keyword().map_or(node.text_range(), SyntaxToken::text_range);
            let anchor = self.anchor(range);
            self.chart.transitions.push(Transition {
                sources: Vec::new(),
                targets: Vec::new(),
                cell: it.cell().and_then(|it| cell(it, page)),
                receptivity: Receptivity::Missing,
                language: it.language(),
                room: None,
                range,
                anchor,
            });
            self.receptivities.push(it);
        } else if let Some(it) = ast::Connector::cast(node) {
            let keyword = it.keyword().map_or(node.text_range(), SyntaxToken::text_range);
            let range = it.name().map_or(keyword, ast::StepName::range);
            let text = it.name().map(|it| it.text()).unwrap_or_default();
            let anchor = self.anchor(range);
            self.chart.connectors.push(Connector {
                kind: it.kind().unwrap_or(ConnectorKind::Destination),
                name: StepName::parse(&text),
                text: text.into(),
                cell: it.cell().and_then(|it| cell(it, page)),
                steps: Vec::new(),
                range,
                anchor,
            });
        } else if let Some(it) = ast::ChartLink::cast(node) {
            let range = it.keyword().map_or(node.text_range(), SyntaxToken::text_range);
            let segment = |it: ast::Segment<'t>| {
                let end = |it: Option<ast::PageCell<'t>>| cell(it?, page);
                Some(Segment { is_horizontal: it.is_horizontal(), from: end(it.from())?, to: end(it.to())? })
            };
            self.chart.links.push(Link {
                kind: it.kind().unwrap_or(LinkKind::OrConvergence),
                from: it.from().filter_map(|it| cell(it, page)).collect(),
                to: it.to().filter_map(|it| cell(it, page)).collect(),
                segments: it.segments().filter_map(segment).collect(),
                is_joined: false,
                range,
            });
        }
    }

    fn step(&mut self, it: ast::ChartStep<'t>, page: Option<u32>) {
        let node = it.syntax();
        let kind = it.kind().unwrap_or(StepKind::Simple);
        let keyword = it.keyword().map_or(node.text_range(), SyntaxToken::text_range);
        let range = it.name().map_or(keyword, ast::StepName::range);
        let text = it.name().map(|it| it.text()).unwrap_or_default();
        let name = match (kind, StepName::parse(&text)) {
            (StepKind::Macro, Some(StepName::Number(number))) => Some(StepName::Macro(number)),
            (StepKind::In, None | Some(StepName::Number(_))) => Some(StepName::In),
            (StepKind::Out, None | Some(StepName::Number(_))) => Some(StepName::Out),
            (_, name) => name,
        };
        let anchor = self.anchor(range);
        let at = index(self.chart.steps.len());
        let cell = it.cell().and_then(|it| cell(it, page));
        let commented = node.descendant_tokens().any(|it| it.kind() == SyntaxKind::Comment);
        self.chart.steps.push(Step { name, text: text.into(), kind, cell, range, anchor, commented });
        for action in it.actions() {
            self.action(action, Some(at));
        }
        self.associations.extend(
            it.associations().filter_map(|it| {
                Some(Association { step: at, target: it.target()?, kind: it.kind(), range: it.range() })
            }),
        );
    }

    fn action(&mut self, it: ast::ChartAction<'t>, step: Option<u32>) {
        let range = it.name().map_or(it.range(), SyntaxToken::text_range);
        if let Some(name) = it.name() {
            let action = self.chart.actions.len();
            self.named_at.insert(action, self.named.len());
            self.named.push(Named { name: name.text().to_lowercase().into(), action, users: Vec::new() });
        }
        self.chart.actions.push(Action {
            steps: step.into_iter().collect(),
            kind: it.kind(),
            language: it.language(),
            path: Exprs::FALSE,
            anchors: 0..0,
            range,
        });
        self.codes.push(it);
    }

    fn anchor(&mut self, range: TextRange) -> u32 {
        self.pl7.as_mut().map_or(0, |it| it.b.anchor(range))
    }

    /// Steps that transitions name.
    fn name_ends(&mut self) {
        let mut by_name: FxHashMap<StepName, u32> = FxHashMap::default();
        for (at, step) in (0..).zip(&self.chart.steps) {
            if let Some(name) = &step.name {
                by_name.entry(name.clone()).or_insert(at);
            }
        }
        for (transition, tree) in self.chart.transitions.iter_mut().zip(&self.receptivities) {
            for end in tree.ends() {
                let list = if end.is_source() { &mut transition.sources } else { &mut transition.targets };
                let mut seen: FxHashSet<Node> = list.iter().cloned().collect();
                for name in end.names().filter_map(|it| StepName::parse(&it.text())) {
                    let node = by_name.get(&name).map_or(Node::Named(name), |&at| Node::Step(at));
                    if seen.insert(node.clone()) {
                        list.push(node);
                    }
                }
            }
        }
    }

    fn bit(&mut self, step: u32) -> Option<ObjectId> {
        if let Some(&known) = self.bits.get(&step) {
            return known;
        }
        let name = self.chart.steps.get(step as usize).and_then(|it| it.name.clone());
        let graph = self.chart.graph;
        let bit = self.pl7.as_mut().zip(name).and_then(|(pl7, name)| step_bit(pl7, &name, graph));
        self.bits.insert(step, bit);
        bit
    }

    fn receptivities(&mut self) {
        for (at, tree) in std::mem::take(&mut self.receptivities).into_iter().enumerate() {
            let path = self.validity(at);
            let Some(mut pl7) = self.begin(path) else { return };
            let language = tree.language().unwrap_or_else(|| language_of(tree.rungs().next(), tree.sentences().next()));
            let mut sentences = tree.sentences().filter(|it| has_code(*it)).peekable();
            let is_missing = sentences.peek().is_none() && tree.rungs().next().is_none();
            let value;
            let mut link = None;
            (pl7, value) = match language {
                CodeLanguage::Il => {
                    pl7.b.set_back_targets(self.back_targets(tree.syntax()));
                    il::sentences(pl7, sentences, true)
                }
                CodeLanguage::St => {
                    pl7.b.set_back_targets(self.back_targets(tree.syntax()));
                    st::sentences(pl7, sentences)
                }
                CodeLanguage::Ladder => {
                    pl7.b.set_back_targets(self.back_targets(tree.syntax()));
                    let (pl7, value, before_end) = ladder::rungs(pl7, tree.rungs(), true);
                    link = before_end;
                    (pl7, value)
                }
            };
            let receptivity = match value {
                _ if tree.has_error() => Receptivity::Unread,
                Some(value) => Receptivity::Value(value),
                None if is_missing => Receptivity::Missing,
                None => Receptivity::Unread,
            };
            if let Receptivity::Value(condition) = receptivity {
                let rung = || tree.rungs().last().map(Rung::range);
                let range = tree.sentences().last().map(Sentence::range).or_else(rung).unwrap_or(tree.range());
                pl7.b.statement(StatementKind::Branch { condition, of: Fork::Receptivity }, range);
            }
            let is_read = matches!(receptivity, Receptivity::Value(_));
            let room = if is_read { room(&mut pl7, tree, language, link) } else { None };
            if let Some(transition) = self.chart.transitions.get_mut(at) {
                transition.receptivity = receptivity;
                transition.room = room;
                transition.language = Some(language).filter(|_| !is_missing).or(transition.language);
            }
            self.pl7 = Some(pl7);
        }
    }

    /// Condition under which a transition is valid.
    fn validity(&mut self, transition: usize) -> ExprId {
        let sources = self.chart.transitions.get(transition).map(|it| it.sources.clone()).unwrap_or_default();
        let mut path = Exprs::TRUE;
        for source in sources {
            let bit = match &source {
                Node::Step(step) => self.bit(*step),
                Node::Connector(_) | Node::Named(_) => {
                    let name = self.chart.name_of(&source).cloned();
                    let graph = self.chart.graph;
                    self.pl7.as_mut().zip(name).and_then(|(pl7, name)| step_bit(pl7, &name, graph))
                }
            };
            let Some(pl7) = &mut self.pl7 else { break };
            let active = peek(pl7, bit);
            path = pl7.b.exprs().and(path, active);
        }
        path
    }

    fn back_targets(&self, code: SyntaxNode<'_>) -> FxHashSet<SmolStr> {
        let text = self.text.get(std::ops::Range::<usize>::from(code.text_range())).unwrap_or_default();
        let language = self.pl7.as_ref().map_or(Language::Pl7Gr7, |it| it.b.model.language);
        pl7::back_targets(code, text, language)
    }

    /// Starts a piece of code that runs under a condition.
    fn begin(&mut self, path: ExprId) -> Option<Pl7> {
        let mut pl7 = self.pl7.take()?;
        pl7.b.begin_part();
        pl7.b.enter(path, None);
        Some(pl7)
    }

    /// Tells the actions that steps name who runs them.
    fn name_actions(&mut self) {
        let mut by_name: FxHashMap<SmolStr, usize> = FxHashMap::default();
        for (at, it) in self.named.iter().enumerate() {
            by_name.entry(it.name.clone()).or_insert(at);
        }
        let named = &mut self.named;
        self.associations.retain(|it| {
            let name = SmolStr::from(it.target.text().to_lowercase());
            let Some(&at) = by_name.get(&name) else { return true };
            named[at].users.push((it.step, it.kind.unwrap_or(ActionKind::Timed)));
            false
        });
        for Named { action, users, .. } in &self.named {
            let Some(action) = self.chart.actions.get_mut(*action) else { continue };
            action.steps = users.iter().map(|it| it.0).collect();
            action.steps.dedup();
            action.kind = users.first().map(|it| it.1).filter(|kind| users.iter().all(|it| it.1 == *kind));
        }
    }

    fn actions(&mut self, wanted: impl Fn(Option<ActionKind>) -> bool) {
        for at in 0..self.chart.actions.len() {
            let (kind, steps) = (self.chart.actions[at].kind, self.chart.actions[at].steps.clone());
            if !wanted(kind) {
                continue;
            }
            let users: Vec<(u32, ActionKind)> = match self.named_at.get(&at).and_then(|it| self.named.get(*it)) {
                Some(named) => named.users.clone(),
                // What the text does not say runs as long as the step is active.
                None => steps.into_iter().map(|it| (it, kind.unwrap_or(ActionKind::Continuous))).collect(),
            };
            let bits: Vec<_> = users.iter().map(|it| (it.1, self.bit(it.0))).collect();
            let Some(mut pl7) = self.begin(Exprs::FALSE) else { return };
            let mut path = Exprs::FALSE;
            for (kind, bit) in bits {
                let runs = guard(&mut pl7, kind, bit);
                path = pl7.b.exprs().or(path, runs);
            }
            if users.is_empty() {
                path = pl7.b.exprs().opaque();
            }
            pl7.b.enter(path, None);
            let code = self.codes[at];
            let language = code.language().unwrap_or_else(|| language_of(code.rungs().next(), code.sentences().next()));
            let first = index(pl7.b.model.anchors.len());
            pl7.b.set_back_targets(self.back_targets(code.syntax()));
            pl7 = match language {
                CodeLanguage::Il => il::sentences(pl7, code.sentences(), false).0,
                CodeLanguage::St => st::sentences(pl7, code.sentences()).0,
                CodeLanguage::Ladder => ladder::rungs(pl7, code.rungs(), false).0,
            };
            let action = &mut self.chart.actions[at];
            action.anchors = first..index(pl7.b.model.anchors.len());
            action.language = Some(language);
            action.path = path;
            self.pl7 = Some(pl7);
        }
    }

    /// Bits that steps name where an action could stand: a bit with `N` is 1 while one of its steps is active.
    fn bit_actions(&mut self) {
        let mut groups: Vec<(ObjectId, Vec<(Association<'t>, ExprId)>)> = Vec::new();
        let mut group_of: FxHashMap<ObjectId, usize> = FxHashMap::default();
        for it in std::mem::take(&mut self.associations) {
            let step = self.bit(it.step);
            let Some(pl7) = &mut self.pl7 else { return };
            let text = it.target.text();
            let object = match it.target.kind() {
                SyntaxKind::ObjectAddress => match pl7.address(text) {
                    Ok(object) => object,
                    Err(error) => {
                        pl7.address_error(error, it.target.text_range(), text);
                        continue;
                    }
                },
                _ => Object::symbol(text),
            };
            let object = pl7.b.object(object);
            let kind = it.kind.unwrap_or(ActionKind::Timed);
            let when = match kind {
                ActionKind::Stored | ActionKind::Reset => peek(pl7, step),
                kind => guard(pl7, kind, step),
            };
            let at = *group_of.entry(object).or_insert_with(|| {
                groups.push((object, Vec::new()));
                groups.len() - 1
            });
            groups[at].1.push((it, when));
        }
        let Some(pl7) = &mut self.pl7 else { return };
        pl7.b.begin_part();
        pl7.b.enter(Exprs::TRUE, None);
        for (object, list) in groups {
            if pl7.b.model.object(object).class == Class::Indirect {
                continue;
            }
            let mut value = None;
            for (it, when) in list {
                let at = it.target.text_range();
                let first = index(pl7.b.model.anchors.len());
                match it.kind {
                    Some(ActionKind::Stored) => pl7.b.set(object, when, at, it.range),
                    Some(ActionKind::Reset) => pl7.b.reset(object, when, at, it.range),
                    Some(_) => {
                        let before = value.map_or(Exprs::FALSE, |it: (ExprId, TextRange, TextRange)| it.0);
                        let either = pl7.b.exprs().or(before, when);
                        value = Some((either, value.map_or(at, |it| it.1), value.map_or(it.range, |it| it.2)));
                        continue;
                    }
                    None => {
                        pl7.b.touch(object, Mode::Output, at);
                    }
                }
                let anchors = first..index(pl7.b.model.anchors.len());
                self.chart.actions.push(Action {
                    steps: vec![it.step],
                    kind: it.kind,
                    language: None,
                    path: Exprs::TRUE,
                    anchors,
                    range: it.range,
                });
            }
            if let Some((value, at, range)) = value {
                pl7.b.assign(object, false, value, at, range);
            }
        }
    }
}

/// The language of code that does not say it.
fn language_of(rung: Option<Rung<'_>>, sentence: Option<Sentence<'_>>) -> CodeLanguage {
    match (rung, sentence) {
        (Some(_), _) => CodeLanguage::Ladder,
        (None, Some(it)) if it.instructions().next().is_some() => CodeLanguage::Il,
        (None, _) => CodeLanguage::St,
    }
}

/// Where the receptivity of a transition can ask more: none in what holds comments, labels or several sentences. In ladder it
/// is the link before the end.
fn room(
    pl7: &mut Pl7,
    tree: ast::Transition<'_>,
    language: CodeLanguage,
    link: Option<(TextRange, u32)>,
) -> Option<Room> {
    let is_comment = |it: SyntaxToken<'_>| it.kind() == SyntaxKind::Comment;
    if language == CodeLanguage::Ladder {
        let (place, cells) = link?;
        let rung = tree.rungs().next().filter(|_| tree.rungs().nth(1).is_none())?;
        if rung.syntax().descendant_tokens().any(is_comment) {
            return None;
        }
        return Some(Room::Link { at: pl7.b.anchor(place), cells });
    }
    let mut sentences = tree.sentences().filter(|it| has_code(*it));
    let sentence = sentences.next().filter(|_| sentences.next().is_none())?;
    if sentence.label().is_some() || sentence.syntax().descendant_tokens().any(is_comment) {
        return None;
    }
    let behind = |range: TextRange| TextRange::empty(range.end());
    if language == CodeLanguage::Il {
        let is_test = |it: IlInstr<'_>| !matches!(it.op(), Some(IlOp::Mps | IlOp::Mrd | IlOp::Mpp));
        let last = sentence.instructions().last().filter(|_| sentence.instructions().all(is_test))?;
        return Some(Room::List { behind: pl7.b.anchor(behind(last.syntax().text_range())) });
    }
    let mut statements = sentence.statements().filter(|it| !matches!(it, Stmt::Empty(_)));
    let (Some(Stmt::Expr(only)), None) = (statements.next(), statements.next()) else { return None };
    let expr = only.expr()?;
    let range = expr.syntax().text_range();
    let binds = match expr {
        Expr::Object(_) | Expr::Name(_) | Expr::Paren(_) => true,
        Expr::Bin(it) => it.op() == Some(BinOp::And),
        _ => false,
    };
    let before = pl7.b.anchor(TextRange::empty(range.start()));
    Some(Room::Expression { before, behind: pl7.b.anchor(behind(range)), binds })
}

fn has_code(sentence: Sentence<'_>) -> bool {
    let is_statement = |it: Stmt<'_>| !matches!(it, Stmt::Empty(_));
    sentence.instructions().next().is_some()
        || sentence.statements().any(is_statement)
        || sentence.syntax().children().any(|it| it.kind() == SyntaxKind::Error)
}

fn cell(it: ast::PageCell<'_>, page: Option<u32>) -> Option<Cell> {
    let (column, line) = it.place()?;
    Some(Cell { page, column, line })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::lower::testing::show;
    use crate::model::unit::OddityKind;
    use crate::source::entity_from_address;
    use crate::syntax;

    fn unit(address: &str, text: &str, language: Language) -> UnitModel {
        let parse = syntax::parse(language, text);
        assert_eq!(parse.errors(), [], "{text}");
        let entity = entity_from_address(address).unwrap_or_else(|| panic!("{address}"));
        crate::model::lower::lower(parse.syntax(), text, entity, language)
    }

    fn page(text: &str) -> UnitModel {
        unit("MAST - P - CHART - PAGE 0", text, Language::Pl7Gr7)
    }

    fn chart(model: &UnitModel) -> &Chart {
        model.chart.as_deref().expect("a chart")
    }

    /// Each transition as `0,1 -> 2`; a connector in brackets.
    fn transitions(model: &UnitModel) -> Vec<String> {
        let chart = chart(model);
        let name = |node: &Node| {
            let name = chart.name_of(node).map_or_else(|| "?".to_owned(), StepName::to_string);
            if matches!(node, Node::Connector(_)) { format!("[{name}]") } else { name }
        };
        let list = |nodes: &[Node]| nodes.iter().map(name).collect::<Vec<_>>().join(",");
        chart.transitions.iter().map(|it| format!("{} -> {}", list(&it.sources), list(&it.targets))).collect()
    }

    /// Each statement that writes: `path: object mode`.
    fn writes(model: &UnitModel) -> Vec<String> {
        model
            .accesses
            .iter()
            .filter(|it| it.mode.writes())
            .map(|it| {
                let path = model.statement(it).map_or_else(String::new, |it| show(model, it.path));
                format!("{path}: {} {}", model.object(it.object).text, it.mode.verb())
            })
            .collect()
    }

    const STEP: &str = "END_STEP\n";
    const TRUE: &str = ": (*PHRASE*) %I1.0 (*END_PHRASE*) END_TRANSITION\n";

    #[test]
    fn neighbours_are_joined_without_a_link() {
        let text = format!(
            "PAGE 0\nSOURCE_CONNECTOR 9 AT (C 0,L 0)\nSTEP 1 AT (C 0,L 1) : {STEP}TRANSITION (ST) AT (C 0,L 2) {TRUE}\
             MACRO_STEP 2 AT (C 0,L 3)\nTRANSITION (ST) AT (C 0,L 4) {TRUE}DEST_CONNECTOR 5 AT (C 0,L 5)\n\
             STEP 3 AT (C 1,L 1) : {STEP}TRANSITION (ST) AT (C 2,L 2) {TRUE}END_PAGE\n"
        );
        let model = page(&text);
        assert_eq!(transitions(&model), ["1 -> M2", "M2 -> [5]", " -> "]);
        assert_eq!(chart(&model).connectors[0].steps, [0]);
    }

    #[test]
    fn links_join_what_they_reach() {
        // An OR divergence of two branches, an AND divergence, and back to the first step.
        let text = format!(
            "PAGE 0\nINITIAL_STEP 0 AT (C 0,L 1) : {STEP}TRANSITION (ST) AT (C 0,L 2) {TRUE}\
             TRANSITION (ST) AT (C 1,L 2) {TRUE}STEP 1 AT (C 0,L 3) : {STEP}STEP 2 AT (C 1,L 3) : {STEP}\
             STEP 3 AT (C 2,L 3) : {STEP}TRANSITION (ST) AT (C 0,L 4) {TRUE}\
             S_T_OR_LINK FROM (C 0,L 1) TO (C 1,L 2)\nT_S_AND_LINK FROM (C 1,L 2) TO (C 2,L 3)\n\
             T_S_OR_LINK FROM (C 0,L 4) TO (C 0,L 1) := [H_LINK FROM (C 0,L 4) TO (C 5,L 4)]\n\
             S_T_AND_LINK FROM (C 1,L 3), (C 2,L 3) TO (C 0,L 4)\nT_S_OR_LINK FROM (C 7,L 7) TO (C 0,L 1)\nEND_PAGE\n"
        );
        let model = page(&text);
        assert_eq!(transitions(&model), ["0 -> 1", "0 -> 2,3", "1,2,3 -> 0"]);
        let junctions = chart(&model).junctions();
        let kinds: Vec<_> = junctions.iter().map(|it| (it.kind, it.branches.len())).collect();
        assert_eq!(kinds, [(LinkKind::OrDivergence, 2), (LinkKind::AndDivergence, 2), (LinkKind::AndConvergence, 3)]);
        let joined: Vec<bool> = chart(&model).links.iter().map(|it| it.is_joined).collect();
        assert_eq!(joined, [true, true, true, true, false]);
    }

    #[test]
    fn actions_run_under_their_steps() {
        let text = format!(
            "PAGE 0\nSTEP 3 AT (C 0,L 1) :\nACTION (N1,ST) : ! %Q2.0 := %I1.0; END_ACTION\n\
             ACTION (P1,IL) : ! LD %I1.2 S %M5 END_ACTION\nACTION (P0,ST) : ! RESET %M5; END_ACTION\n{STEP}\
             TRANSITION (IL) AT (C 0,L 2) : ! LD %M7 AND [%MW0>5] END_TRANSITION\nEND_PAGE\n"
        );
        let model = page(&text);
        assert_eq!(writes(&model), ["v%X3: %M5 reset", "^%X3: %M5 set", "%X3: %Q2.0 assigned"]);
        let Receptivity::Value(value) = chart(&model).transitions[0].receptivity else { panic!("a value") };
        assert_eq!(show(&model, value), "(%M7 & (%MW0 > 5))");
        let rung = |coil: &str| format!("RUNG\nOPEN_CONTACT(%I1.0),CLOSED_CONTACT(%M3),H_LINK(8),{coil};\nEND_RUNG\n");
        let (action, receptivity) = (rung("COIL(%Q2.2)"), rung("HASH_COIL"));
        let model = page(&format!(
            "PAGE 0\nSTEP 3 AT (C 0,L 1) :\nACTION (N1,LD) : {action}END_ACTION\n{STEP}\
             TRANSITION (LD) AT (C 0,L 2) : {receptivity}END_TRANSITION\nEND_PAGE\n"
        ));
        assert_eq!(writes(&model), ["%X3: %Q2.2 assigned"]);
        let Receptivity::Value(value) = chart(&model).transitions[0].receptivity else { panic!("a value") };
        assert_eq!(show(&model, value), "(%I1.0 & !%M3)");
        assert_eq!(model.oddities, []);
        // Tests that no action uses are what a receptivity is.
        assert!(!model.oddities.iter().any(|it| it.kind == OddityKind::TestWithoutAction));
        // The step's bit is looked at by the controller, not by the program.
        assert!(!model.accesses.iter().any(|it| model.object(it.object).text == "%X3"));
    }

    #[test]
    fn ladder_in_a_chart_is_code_like_any_other() {
        let text = format!(
            "PAGE 0\nSTEP 3 AT (C 0,L 1) :\nACTION (N1,LD) : RUNG\nOPEN_CONTACT(%I1.0),H_LINK(9),COIL(%Q2.0);\nEND_RUNG \
             END_ACTION\nACTION (P1,LD) : RUNG\nH_LINK(10),SET_COIL(%M5);\nEND_RUNG END_ACTION\n{STEP}\
             TRANSITION (LD) AT (C 0,L 2) : RUNG\nOPEN_CONTACT(%M7),COMPARE %MW0>5 END_BLOCK,H_LINK(7),HASH_COIL;\nEND_RUNG \
             END_TRANSITION\nEND_PAGE\n"
        );
        let model = page(&text);
        assert_eq!(writes(&model), ["^%X3: %M5 set", "%X3: %Q2.0 assigned"]);
        let Receptivity::Value(value) = chart(&model).transitions[0].receptivity else { panic!("a value") };
        assert_eq!(show(&model, value), "(%M7 & (%MW0 > 5))");
        assert!(!model.has_gaps && model.oddities.is_empty());
        // A `(#)` in an action, and a block in a transition.
        let flaws = |what: &str| {
            let it = page(&format!("PAGE 0\nSTEP 3 AT (C 0,L 1) :\n{what}END_PAGE\n"));
            it.oddities.iter().map(|it| it.kind.clone()).collect::<Vec<_>>()
        };
        let hash = "RUNG\nH_LINK(10),HASH_COIL;\nEND_RUNG";
        let block = "RUNG\nH_LINK,BLOCK(%TM0),H_LINK(7),HASH_COIL;\nEND_RUNG";
        assert_eq!(
            flaws(&format!("ACTION (N1,LD) : {hash} END_ACTION\n{STEP}")),
            [OddityKind::Ladder(crate::model::ladder::Flaw::HashOutsideTransition)]
        );
        assert_eq!(
            flaws(&format!("{STEP}TRANSITION (LD) AT (C 0,L 2) : {block} END_TRANSITION\n")),
            [OddityKind::Ladder(crate::model::ladder::Flaw::ElementInTransition)]
        );
    }

    #[test]
    fn labels_belong_to_their_action() {
        let action = "ACTION (P1,ST) : (*PHRASE*) %L1: IF %M0 THEN JUMP %L2; END_IF; (*END_PHRASE*)\n\
                      (*PHRASE*) %L2: INC %MW0; (*END_PHRASE*) END_ACTION\n";
        let text =
            format!("PAGE 0\nSTEP 1 AT (C 0,L 1) :\n{action}{STEP}STEP 2 AT (C 1,L 1) :\n{action}{STEP}END_PAGE\n");
        let model = page(&text);
        let targets: Vec<_> = model.jumps.iter().map(|it| (it.part, it.target)).collect();
        assert_eq!(targets.len(), 2);
        assert!(targets.iter().all(|&(part, target)| target.is_some_and(|it| model.labels[it as usize].part == part)));
        assert_ne!(targets[0].1, targets[1].1);
        assert_eq!(model.unreachable, []);
    }

    #[test]
    fn receptivities_that_are_missing() {
        let receptivity = |code: &str| {
            let model = page(&format!("PAGE 0\nTRANSITION (ST) AT (C 0,L 2) : {code} END_TRANSITION\nEND_PAGE\n"));
            chart(&model).transitions[0].receptivity
        };
        assert_eq!(receptivity(""), Receptivity::Missing);
        assert_eq!(receptivity("(*PHRASE*) (*END_PHRASE*)"), Receptivity::Missing);
        assert_eq!(receptivity("(*PHRASE*) TRUE (*END_PHRASE*)"), Receptivity::Value(Exprs::TRUE));
        assert_eq!(receptivity("(*PHRASE*) %M0 := %M1; (*END_PHRASE*)"), Receptivity::Unread);
    }

    #[test]
    fn a_textual_chart_fills_the_same_model() {
        let text = "INITIAL_STEP X0 : END_STEP\nSTEP X1 : Fill(N); %Q2.1(N); %M3(S); END_STEP\n\
                    STEP Wait : Fill(N); %Q2.1(N); END_STEP\nTRANSITION FROM X0 TO (X1,Wait) := %MW1 = 5; END_TRANSITION\n\
                    TRANSITION FROM (X1,Wait) TO X9 : ! LD %I1.0 END_TRANSITION\nACTION Fill : %Q2.0 := TRUE; END_ACTION\n";
        let model = unit("MAST - CHART", text, Language::Sfc);
        assert_eq!(transitions(&model), ["0 -> 1,wait", "1,wait -> 9"]);
        assert_eq!(chart(&model).transitions[1].targets, [Node::Named(StepName::Number(9))]);
        let Receptivity::Value(value) = chart(&model).transitions[0].receptivity else { panic!("a value") };
        assert_eq!(show(&model, value), "(%MW1 = 5)");
        assert_eq!(writes(&model), ["(%X1 | wait.X): %Q2.0 assigned", "true: %Q2.1 assigned", "true: %M3 set"]);
        let value = model.statements.iter().find_map(|it| match it.kind {
            StatementKind::Assign { value, .. } if it.path == Exprs::TRUE => Some(show(&model, value)),
            _ => None,
        });
        assert_eq!(value.as_deref(), Some("(%X1 | wait.X)"));
    }

    #[test]
    fn a_piece_under_its_own_heading_runs_under_its_step() {
        let path = |address: &str, text: &str, language| {
            let model = unit(address, text, language);
            writes(&model).join("; ")
        };
        let heading = "MAST - P - CHART - PAGE 0 %X1 P1";
        assert_eq!(path(heading, "! %M0 := TRUE;", Language::Pl7St), "^%X1: %M0 assigned");
        assert_eq!(path(heading, "! LD %M1\nST %M0", Language::Pl7Il), "^%X1: %M0 assigned");
        assert_eq!(path(heading, "RUNG\nH_LINK(10),COIL(%M0);\nEND_RUNG", Language::Pl7Ld), "^%X1: %M0 assigned");
        assert_eq!(
            path("MAST - P - MACRO2 - PAGE 0 %X2.1 N1", "! %M0 := TRUE;", Language::Pl7St),
            "%X2.1: %M0 assigned"
        );
    }
}
