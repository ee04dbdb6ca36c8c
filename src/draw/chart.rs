//! Grafcet charts: what a chart holds to be drawn, read from its units.
//!
//! A drawing shows one graph, the main one of a section or the expansion of a macro-step, with all its pages. A page whose
//! elements all have cells of their own is drawn as it stands; anything else is laid out.

mod paint;
mod sequence;

use std::ops::Range;

pub(super) use sequence::sequences;

use rustc_hash::{FxHashMap, FxHashSet};
use smol_str::SmolStr;

use super::graph::{Graph as TextGraph, GraphArc, GraphNode, Look};
use super::scene::Scene;
use super::{Mark, Unit, layers, words};
use crate::model::chart::{
    self, ActionKind, Cell, Chart, CodeLanguage, ConnectorKind, Graph, Node, Piece, Receptivity, StepKind, StepName,
};
use crate::model::entity::{Entity, Part, Task};
use crate::syntax::pl7::ast::{Rung, Sentence};
use crate::syntax::pl7::chart::ast;
use crate::syntax::{AstNode as _, SyntaxElement, SyntaxKind, SyntaxNode};

/// A graph of a section, to be drawn.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Picture {
    pub title: String,
    pages: Vec<Page>,
    /// Findings about no element.
    marks: Vec<Mark>,
}

/// A page, or a whole textual chart.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
struct Page {
    number: Option<u32>,
    items: Vec<Item>,
    /// Pairs of items, each once.
    arcs: Vec<(u32, u32)>,
    /// Comments that stand nowhere in particular.
    comments: Vec<String>,
}

#[derive(Debug, Clone, PartialEq, Eq)]
struct Item {
    kind: ItemKind,
    cell: Option<(u32, u32)>,
    comment: Option<String>,
    marks: Vec<Mark>,
    /// Steps and transitions whose lines to here are not drawn.
    entries: Vec<String>,
}

#[derive(Debug, Clone, PartialEq, Eq)]
enum ItemKind {
    Step {
        kind: StepKind,
        name: String,
        actions: Vec<Action>,
    },
    Transition {
        /// `0→1`.
        name: String,
        /// `None`: not programmed.
        receptivity: Option<String>,
    },
    /// Names the step where one comes from, and the page of that.
    Origin(String, Option<u32>),
    /// Names the step where one goes.
    Destination(String, Option<u32>),
    Comment(String),
}

#[derive(Debug, Clone, PartialEq, Eq)]
struct Action {
    /// `P1`, `N`.
    qualifier: String,
    text: String,
}

/// When an action runs, as its text says: the first such word in parentheses. Without any, as long as its step is active.
fn qualifier(node: SyntaxNode<'_>) -> String {
    let tokens = node.tokens().skip_while(|it| it.kind() != SyntaxKind::LParen);
    let mut words = tokens.take_while(|it| it.kind() != SyntaxKind::RParen).map(|it| it.text());
    words.find(|it| ActionKind::of(it).is_some()).unwrap_or("N").to_uppercase()
}

/// The code of the actions of a unit.
struct Codes<'t> {
    /// Actions that steps name, by their names in lower case.
    named: FxHashMap<String, ast::ChartAction<'t>>,
    /// Places that the ladder of an action names, by where the action begins.
    of_ladder: FxHashMap<rowan::TextSize, Range<u32>>,
    /// What the rungs of the unit do.
    rungs: Vec<(u32, String)>,
}

type Key<'a> = (Task, Option<&'a SmolStr>, Graph);

fn key<'a>(entity: &'a Entity, graph: Graph) -> Key<'a> {
    match entity {
        Entity::Pl7 { task, section, .. } => (*task, section.as_ref(), graph),
        _ => (Task::Mast, None, graph),
    }
}

/// The graphs of a program, in the order of their first units.
pub(super) fn pictures(units: &[Unit<'_>]) -> Vec<Picture> {
    let mut order: Vec<Key<'_>> = Vec::new();
    let mut of_key: FxHashMap<Key<'_>, Vec<usize>> = FxHashMap::default();
    let mut pieces: Vec<&Unit<'_>> = Vec::new();
    for (at, unit) in units.iter().enumerate() {
        match unit.model.chart.as_deref().filter(|_| unit.language.is_chart()) {
            Some(chart) => {
                let key = key(&unit.model.entity, chart.graph);
                let list = of_key.entry(key).or_insert_with(|| {
                    order.push(key);
                    Vec::new()
                });
                list.push(at);
            }
            None if matches!(unit.model.entity, Entity::Pl7 { part: Part::Chart(_), .. }) => pieces.push(unit),
            None => {}
        }
    }
    let mut pictures = Vec::new();
    for key in order {
        let mut picture = Picture { title: String::new(), pages: Vec::new(), marks: Vec::new() };
        for unit in of_key.get(&key).into_iter().flatten().filter_map(|it| units.get(*it)) {
            if picture.title.is_empty() {
                picture.title = title(&unit.model.entity, key.2);
            }
            let Some(chart) = unit.model.chart.as_deref() else { continue };
            Reader::new(unit, chart).read(&mut picture);
        }
        for unit in &pieces {
            if let Some(place) = chart::place(&unit.model.entity)
                && self::key(&unit.model.entity, place.graph) == key
            {
                picture.add_piece(unit, &place.what);
            }
        }
        picture.pages.retain(|it| !it.items.is_empty() || !it.comments.is_empty());
        picture.pages.sort_by_key(|it| it.number);
        picture.name_pages();
        if picture.pages.iter().any(|it| !it.items.is_empty()) {
            pictures.push(picture);
        }
    }
    pictures
}

/// What a graph is called: as its units are, without the page.
fn title(entity: &Entity, graph: Graph) -> String {
    let Entity::Pl7 { task, section, part } = entity else { return entity.to_string() };
    let section = section.as_ref().map_or_else(String::new, |it| format!(" - {it}"));
    match (graph, part) {
        (Graph::Macro(number), _) => format!("{task}{section} - MACRO{number}"),
        (Graph::Main, Part::Chart(rest)) => {
            let first = rest.split(|it: char| it.is_whitespace() || it == '-').next().unwrap_or("CHART");
            format!("{task}{section} - {first}")
        }
        (Graph::Main, _) => entity.to_string(),
    }
}

struct Reader<'u, 't> {
    unit: &'u Unit<'t>,
    chart: &'u Chart,
    /// The trees of the chart's elements, in its order, with the comments that precede them.
    steps: Vec<(SyntaxNode<'t>, Option<&'t str>)>,
    transitions: Vec<(SyntaxNode<'t>, Option<&'t str>)>,
    connectors: Vec<SyntaxNode<'t>>,
    comments: Vec<(String, Option<Cell>)>,
    links: Vec<SyntaxNode<'t>>,
    actions: Vec<ast::ChartAction<'t>>,
}

impl<'u, 't> Reader<'u, 't> {
    fn new(unit: &'u Unit<'t>, chart: &'u Chart) -> Self {
        let mut reader = Self {
            unit,
            chart,
            steps: Vec::new(),
            transitions: Vec::new(),
            connectors: Vec::new(),
            comments: Vec::new(),
            links: Vec::new(),
            actions: Vec::new(),
        };
        let page = chart::place(&unit.model.entity).and_then(|it| it.page);
        reader.collect(unit.tree, page, true);
        reader
    }

    /// The elements in the order in which the model has them.
    fn collect(&mut self, node: SyntaxNode<'t>, page: Option<u32>, is_root: bool) {
        let mut comment = None;
        for it in node.children_with_tokens() {
            let node = match it {
                SyntaxElement::Node(node) => node,
                SyntaxElement::Token(token) => {
                    if token.kind() == SyntaxKind::Comment {
                        comment = words::comment(token.text());
                    }
                    continue;
                }
            };
            let before = std::mem::take(&mut comment);
            if let Some(it) = ast::Page::cast(node).filter(|_| is_root) {
                self.collect(node, it.number().or(page), false);
            } else if let Some(it) = ast::ChartStep::cast(node) {
                self.steps.push((node, words::own_comment(node).or(before)));
                self.actions.extend(it.actions());
            } else if let Some(it) = ast::ChartAction::cast(node) {
                self.actions.push(it);
            } else if ast::Transition::can_cast(node.kind()) {
                self.transitions.push((node, words::own_comment(node).or(before)));
            } else if ast::Connector::can_cast(node.kind()) {
                self.connectors.push(node);
            } else if ast::ChartLink::can_cast(node.kind()) {
                self.links.push(node);
            } else if let Some(it) = ast::ChartComment::cast(node) {
                let place = it.child::<ast::PageCell<'_>>().and_then(ast::PageCell::place);
                let cell = place.map(|(column, line)| Cell { page, column, line });
                if let Some(text) = words::own_comment(node) {
                    self.comments.push((text.to_owned(), cell));
                }
            }
        }
    }

    fn read(&self, picture: &mut Picture) {
        let mut items: Vec<(Item, Option<Cell>)> = Vec::new();
        // Where each element is found, by its place in the text.
        let mut places: Vec<(rowan::TextRange, usize)> = Vec::new();
        let item = |kind, comment: Option<&str>| Item {
            kind,
            cell: None,
            comment: comment.map(str::to_owned),
            marks: Vec::new(),
            entries: Vec::new(),
        };
        let codes = self.codes();
        for (step, (node, comment)) in self.chart.steps.iter().zip(&self.steps) {
            let name = match &step.name {
                Some(StepName::Symbol(_)) | None => step.text.to_string(),
                Some(name) => name.to_string(),
            };
            let actions = ast::ChartStep::cast(*node).map(|it| self.actions(it, &codes)).unwrap_or_default();
            places.push((node.text_range(), items.len()));
            items.push((item(ItemKind::Step { kind: step.kind, name, actions }, *comment), step.cell));
        }
        let first_transition = items.len();
        for (transition, (node, comment)) in self.chart.transitions.iter().zip(&self.transitions) {
            let names = |nodes: &[Node]| {
                let names = nodes.iter().map(|it| self.name(it));
                names.collect::<Vec<_>>().join(",")
            };
            let name = format!("{}→{}", names(&transition.sources), names(&transition.targets));
            let receptivity = ast::Transition::cast(*node).and_then(|it| self.receptivity(it, transition.receptivity));
            places.push((node.text_range(), items.len()));
            items.push((item(ItemKind::Transition { name, receptivity }, *comment), transition.cell));
        }
        let first_connector = items.len();
        for (connector, node) in self.chart.connectors.iter().zip(&self.connectors) {
            let name = connector.name.as_ref().map_or_else(|| connector.text.to_string(), StepName::to_string);
            let kind = match connector.kind {
                ConnectorKind::Origin => ItemKind::Origin(name, None),
                ConnectorKind::Destination => ItemKind::Destination(name, None),
            };
            places.push((node.text_range(), items.len()));
            items.push((item(kind, None), connector.cell));
        }
        let mut arcs: Vec<(usize, usize)> = Vec::new();
        let mut has_named = false;
        for (at, transition) in (first_transition..).zip(&self.chart.transitions) {
            for (nodes, is_source) in [(&transition.sources, true), (&transition.targets, false)] {
                for node in nodes {
                    let other = match node {
                        Node::Step(step) => *step as usize,
                        Node::Connector(it) => first_connector + *it as usize,
                        Node::Named(name) => {
                            has_named = true;
                            let name = name.to_string();
                            let kind = match is_source {
                                true => ItemKind::Origin(name, None),
                                false => ItemKind::Destination(name, None),
                            };
                            items.push((item(kind, None), None));
                            items.len() - 1
                        }
                    };
                    arcs.push(if is_source { (other, at) } else { (at, other) });
                }
            }
        }
        for (at, connector) in (first_connector..).zip(&self.chart.connectors) {
            arcs.extend(connector.steps.iter().map(|it| (at, *it as usize)));
        }
        let mut seen = FxHashSet::default();
        arcs.retain(|it| it.0 != it.1 && seen.insert(*it));
        self.mark(&mut items, &mut places, first_transition, picture);
        for (text, cell) in &self.comments {
            items.push((item(ItemKind::Comment(text.clone()), None), *cell));
        }
        pages(items, &arcs, has_named, picture);
    }

    fn name(&self, node: &Node) -> String {
        match node {
            Node::Step(at) => match self.chart.steps.get(*at as usize) {
                Some(step) if matches!(step.name, None | Some(StepName::Symbol(_))) => step.text.to_string(),
                Some(step) => step.name.as_ref().map_or_else(String::new, StepName::to_string),
                None => String::new(),
            },
            _ => self.chart.name_of(node).map_or_else(String::new, StepName::to_string),
        }
    }

    fn codes(&self) -> Codes<'t> {
        let named = self.actions.iter().filter_map(|it| Some((it.name()?.text().to_lowercase(), *it)));
        let of_ladder = self.chart.actions.iter().filter(|it| it.language == Some(CodeLanguage::Ladder));
        Codes {
            // Of two actions of one name the first counts.
            named: named.collect::<Vec<_>>().into_iter().rev().collect(),
            of_ladder: of_ladder.map(|it| (it.range.start(), it.anchors.clone())).collect(),
            rungs: words::statements(self.unit.model),
        }
    }

    /// The actions of a step, in the order of the text.
    fn actions(&self, step: ast::ChartStep<'t>, codes: &Codes<'t>) -> Vec<Action> {
        let mut actions = Vec::new();
        for node in step.syntax().children() {
            let (words, name, text) = if let Some(it) = ast::ChartAction::cast(node) {
                (it.syntax(), None, self.code(it, codes))
            } else if let Some(it) = ast::Association::cast(node) {
                let Some(target) = it.target() else { continue };
                let code = codes.named.get(target.text().to_lowercase().as_str());
                (it.syntax(), Some(target.text()), code.map(|it| self.code(*it, codes)).unwrap_or_default())
            } else {
                continue;
            };
            let lines: Vec<&str> = name.into_iter().chain(Some(&*text).filter(|it| !it.is_empty())).collect();
            actions.push(Action { qualifier: qualifier(words), text: lines.join("\n") });
        }
        actions
    }

    fn code(&self, it: ast::ChartAction<'t>, codes: &Codes<'t>) -> String {
        let range = it.name().map_or(it.range(), |it| it.text_range());
        match codes.of_ladder.get(&range.start()) {
            Some(anchors) => {
                let from = codes.rungs.partition_point(|rung| rung.0 < anchors.start);
                let own = codes.rungs[from..].iter().take_while(|rung| rung.0 < anchors.end);
                own.map(|it| it.1.as_str()).collect::<Vec<_>>().join("\n")
            }
            None => words::sentences(it.sentences()),
        }
    }

    fn receptivity(&self, it: ast::Transition<'t>, value: Receptivity) -> Option<String> {
        let text = code_text(self.unit, it.sentences(), it.rungs(), value);
        // A statement ends so, a condition does not.
        let text = text.trim_end_matches(|it: char| it == ';' || it.is_whitespace());
        Some(text.to_owned()).filter(|it| !it.is_empty())
    }

    /// Gives each element the findings that lie in it.
    fn mark(
        &self,
        items: &mut [(Item, Option<Cell>)],
        places: &mut Vec<(rowan::TextRange, usize)>,
        first_transition: usize,
        picture: &mut Picture,
    ) {
        // What is wrong with a link is shown where it begins or ends.
        let mut by_cell: FxHashMap<Cell, usize> = FxHashMap::default();
        for (at, (_, cell)) in items.iter().enumerate() {
            by_cell.extend(cell.map(|it| (it, at)));
        }
        for (link, node) in self.chart.links.iter().zip(&self.links) {
            let end = link.to.iter().chain(&link.from).find_map(|it| by_cell.get(it));
            places.extend(end.map(|it| (node.text_range(), *it)));
        }
        let users: FxHashMap<rowan::TextSize, u32> =
            self.chart.actions.iter().filter_map(|it| Some((it.range.start(), *it.steps.first()?))).collect();
        for it in &self.actions {
            let step = it.name().and_then(|it| users.get(&it.text_range().start()));
            places.extend(step.map(|step| (it.range(), *step as usize)).filter(|it| it.1 < first_transition));
        }
        places.sort_by_key(|it| (it.0.start(), it.0.end()));
        for (range, mark) in self.unit.marks {
            let at = places.partition_point(|it| it.0.start() <= range.start());
            let place = at.checked_sub(1).and_then(|it| places.get(it));
            let item = place.filter(|it| it.0.end() > range.start() || it.0 == *range);
            match item.and_then(|it| items.get_mut(it.1)) {
                Some((item, _)) => item.marks.push(mark.clone()),
                None => picture.marks.push(mark.clone()),
            }
        }
    }
}

/// The code of a receptivity, or of an action under a heading of its own.
fn code_text<'t>(
    unit: &Unit<'_>,
    sentences: impl Iterator<Item = Sentence<'t>>,
    mut rungs: impl Iterator<Item = Rung<'t>>,
    value: Receptivity,
) -> String {
    match (rungs.next(), value) {
        (Some(_), Receptivity::Value(value)) => words::condition(unit.model, value),
        (Some(rung), _) => words::code(rung.syntax()),
        (None, _) => words::sentences(sentences),
    }
}

/// Cuts what a unit holds into its pages, as far as each stands by itself.
fn pages(items: Vec<(Item, Option<Cell>)>, arcs: &[(usize, usize)], has_named: bool, picture: &mut Picture) {
    let page_of: Vec<Option<u32>> = items.iter().map(|it| it.1.and_then(|it| it.page)).collect();
    let mut cells = FxHashSet::default();
    let is_sound = !has_named
        && items.iter().all(|it| it.1.is_some_and(|it| cells.insert(it)))
        && arcs.iter().all(|&(from, to)| page_of[from] == page_of[to]);
    let mut pages: Vec<Page> = Vec::new();
    let mut index: FxHashMap<Option<u32>, usize> = FxHashMap::default();
    let mut place = Vec::with_capacity(items.len());
    for ((mut item, cell), number) in items.into_iter().zip(&page_of) {
        let number = number.filter(|_| is_sound);
        let at = *index.entry(number).or_insert_with(|| {
            pages.push(Page { number, ..Page::default() });
            pages.len() - 1
        });
        item.cell = cell.map(|it| (it.column, it.line)).filter(|_| is_sound);
        let page = &mut pages[at];
        match item.kind {
            ItemKind::Comment(text) if !is_sound => page.comments.push(text),
            _ => page.items.push(item),
        }
        place.push((at, u32::try_from(page.items.len().saturating_sub(1)).unwrap_or(u32::MAX)));
    }
    for &(from, to) in arcs {
        pages[place[from].0].arcs.push((place[from].1, place[to].1));
    }
    for page in &mut pages {
        if is_sound {
            page.press();
        } else {
            page.refer();
        }
    }
    picture.pages.append(&mut pages);
}

impl Page {
    /// Takes the columns and lines out that hold nothing.
    fn press(&mut self) {
        let ranks = |all: Vec<u32>| -> FxHashMap<u32, u32> {
            let mut all = all;
            all.sort_unstable();
            all.dedup();
            all.into_iter().zip(0..).collect()
        };
        let cells: Vec<(u32, u32)> = self.items.iter().filter_map(|it| it.cell).collect();
        let columns = ranks(cells.iter().map(|it| it.0).collect());
        let lines = ranks(cells.iter().map(|it| it.1).collect());
        for it in &mut self.items {
            it.cell = it.cell.and_then(|(column, line)| Some((*columns.get(&column)?, *lines.get(&line)?)));
        }
    }

    /// Replaces lines that would run back too far to be followed by references to their ends, as the manual does
    /// (PL7:4393-4404).
    fn refer(&mut self) {
        /// Rows of a page.
        const FAR: u32 = 14;
        let layers = self.layers();
        let row = |it: u32| layers.cells[it as usize].1;
        for (at, arc) in self.arcs.clone().into_iter().enumerate() {
            let (from, to) = arc;
            if !layers.back[at] || row(from).saturating_sub(row(to)) <= FAR {
                continue;
            }
            let kind = ItemKind::Destination(self.name(to), None);
            let exit = u32::try_from(self.items.len()).unwrap_or(u32::MAX);
            self.items.push(Item { kind, cell: None, comment: None, marks: Vec::new(), entries: Vec::new() });
            self.arcs[at].1 = exit;
            let name = match &self.items[from as usize].kind {
                // The steps before a transition tell more than its own name.
                ItemKind::Transition { name, .. } => name.split('→').next().unwrap_or_default().to_owned(),
                _ => self.name(from),
            };
            self.items[to as usize].entries.push(name);
        }
        let layers = self.layers();
        for (it, cell) in self.items.iter_mut().zip(layers.cells) {
            it.cell = Some(cell);
        }
    }

    fn name(&self, item: u32) -> String {
        match self.items.get(item as usize).map(|it| &it.kind) {
            Some(ItemKind::Step { name, .. } | ItemKind::Transition { name, .. }) => name.clone(),
            _ => String::new(),
        }
    }

    fn layers(&self) -> layers::Layers {
        let starts = |wanted: StepKind| {
            let is_wanted =
                move |it: &&(u32, &Item)| matches!(&it.1.kind, ItemKind::Step { kind, .. } if *kind == wanted);
            (0..).zip(&self.items).collect::<Vec<_>>().iter().filter(is_wanted).map(|it| it.0).collect::<Vec<u32>>()
        };
        let mut roots = starts(StepKind::Initial);
        roots.extend(starts(StepKind::In));
        let floor: Vec<u32> =
            self.items.iter().map(|it| u32::from(matches!(it.kind, ItemKind::Transition { .. }))).collect();
        layers::assign(self.items.len(), &self.arcs, &roots, &floor)
    }
}

impl Picture {
    /// Adds the code of an action or receptivity that stands under a heading of its own.
    fn add_piece(&mut self, unit: &Unit<'_>, piece: &Piece) {
        let mut rungs = unit.tree.descendants().filter_map(Rung::cast);
        let sentences = unit.tree.descendants().filter_map(Sentence::cast);
        let marks = unit.marks.iter().map(|it| it.1.clone());
        let mut items = self.pages.iter_mut().flat_map(|it| &mut it.items);
        match piece {
            Piece::Chart => self.marks.extend(marks),
            Piece::Action { step, kind } => {
                let text = match rungs.next() {
                    Some(_) => {
                        let all = words::statements(unit.model).into_iter().map(|it| it.1);
                        all.collect::<Vec<_>>().join("\n")
                    }
                    None => words::sentences(sentences),
                };
                let is_named = |it: &&mut Item| matches!(&it.kind, ItemKind::Step { name, .. } if same(name, step));
                match items.find(is_named) {
                    Some(item) => {
                        item.marks.extend(marks);
                        if let ItemKind::Step { actions, .. } = &mut item.kind {
                            let qualifier = match kind {
                                ActionKind::Activation => "P1",
                                ActionKind::Deactivation => "P0",
                                _ => "N1",
                            };
                            actions.push(Action { qualifier: qualifier.to_owned(), text });
                        }
                    }
                    None => self.marks.extend(marks),
                }
            }
            Piece::Receptivity { from, to } => {
                let text = code_text(unit, sentences, rungs, Receptivity::Unread);
                let is_named = |it: &&mut Item| match &it.kind {
                    ItemKind::Transition { name, .. } => {
                        let (sources, targets) = name.split_once('→').unwrap_or_default();
                        let has = |list: &str, name| list.split(',').any(|it| same(it, name));
                        has(sources, from) && has(targets, to)
                    }
                    _ => false,
                };
                match items.find(is_named) {
                    Some(item) => {
                        item.marks.extend(marks);
                        if let ItemKind::Transition { receptivity: receptivity @ None, .. } = &mut item.kind {
                            *receptivity = Some(text).filter(|it| !it.is_empty());
                        }
                    }
                    None => self.marks.extend(marks),
                }
            }
        }
    }

    /// Tells connectors the page of the step that they name, where it is another one.
    fn name_pages(&mut self) {
        let mut page_of: FxHashMap<String, Option<u32>> = FxHashMap::default();
        for page in &self.pages {
            for item in &page.items {
                if let ItemKind::Step { name, .. } = &item.kind {
                    page_of.entry(name.clone()).or_insert(page.number);
                }
            }
        }
        for page in &mut self.pages {
            let own = page.number;
            for item in &mut page.items {
                if let ItemKind::Origin(name, on) | ItemKind::Destination(name, on) = &mut item.kind {
                    *on = page_of.get(name).copied().flatten().filter(|it| Some(*it) != own);
                }
            }
        }
    }

    pub fn scene(&self) -> Scene {
        paint::scene(self)
    }

    /// The chart over all its pages: a connector stands for the step that it names.
    pub fn graph(&self) -> TextGraph {
        let mut graph = TextGraph { title: self.title.clone(), ..TextGraph::default() };
        let mut step_of: FxHashMap<&str, u32> = FxHashMap::default();
        let mut node_of: Vec<Vec<Option<u32>>> = Vec::new();
        for page in &self.pages {
            let mut nodes = Vec::new();
            for item in &page.items {
                let (look, label) = match &item.kind {
                    ItemKind::Step { kind, name, actions } => {
                        let look = match kind {
                            StepKind::Initial => Look::InitialStep,
                            StepKind::Macro => Look::MacroStep,
                            StepKind::Simple | StepKind::In | StepKind::Out => Look::Step,
                        };
                        let mut label = vec![name.clone()];
                        label.extend(item.comment.clone());
                        let codes = actions.iter().map(|it| format!("{} {}", it.qualifier, it.text.replace('\n', " ")));
                        label.extend(codes.map(|it| super::scene::cut(it.trim(), 60)));
                        (look, label)
                    }
                    ItemKind::Transition { name, receptivity } => {
                        let text = receptivity.as_deref().unwrap_or("not programmed").replace('\n', " ");
                        let text = super::scene::cut(&text, 60);
                        (Look::Transition, vec![text, format!("({name})")])
                    }
                    ItemKind::Origin(..) | ItemKind::Destination(..) | ItemKind::Comment(_) => {
                        nodes.push(None);
                        continue;
                    }
                };
                let at = u32::try_from(graph.nodes.len()).unwrap_or(u32::MAX);
                if let ItemKind::Step { name, .. } = &item.kind {
                    step_of.entry(name).or_insert(at);
                }
                nodes.push(Some(at));
                graph.nodes.push(GraphNode { look, label, marks: item.marks.clone() });
            }
            node_of.push(nodes);
        }
        let mut absent: FxHashMap<&str, u32> = FxHashMap::default();
        let mut seen = FxHashSet::default();
        for (page, nodes) in self.pages.iter().zip(&node_of) {
            for &(from, to) in &page.arcs {
                let mut end = |it: u32| {
                    if let Some(node) = nodes.get(it as usize).copied().flatten() {
                        return Some(node);
                    }
                    let (ItemKind::Origin(name, _) | ItemKind::Destination(name, _)) =
                        &page.items.get(it as usize)?.kind
                    else {
                        return None;
                    };
                    if let Some(&step) = step_of.get(name.as_str()) {
                        return Some(step);
                    }
                    Some(*absent.entry(name).or_insert_with(|| {
                        graph.nodes.push(GraphNode {
                            look: Look::Connector,
                            label: vec![name.clone()],
                            marks: Vec::new(),
                        });
                        u32::try_from(graph.nodes.len() - 1).unwrap_or(u32::MAX)
                    }))
                };
                let (Some(from), Some(to)) = (end(from), end(to)) else { continue };
                let look = |it: u32| graph.nodes.get(it as usize).map(|it| it.look);
                // From the step that an origin connector names, a transition leads here: it is drawn where that stands.
                let is_told = look(to) != Some(Look::Transition)
                    && !matches!(look(from), Some(Look::Transition | Look::Connector));
                if !is_told && seen.insert((from, to)) {
                    graph.arcs.push(GraphArc { from, to, label: String::new() });
                }
            }
        }
        graph
    }
}

/// Whether a text is the name of a step.
fn same(text: &str, name: &StepName) -> bool {
    StepName::parse(text).is_some_and(|it| it == *name)
}
