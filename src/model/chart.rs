//! Charts: steps, transitions, actions, connectors and links, whatever form they were written in.
//!
//! A unit holds one page of a chart, or a whole textual chart. Vertical neighbours of a page are joined without a link;
//! links join the rest. What goes on in another page is named by a connector: [`crate::analysis::chart`] joins the pages.

use std::fmt;
use std::ops::Range;

use rowan::TextRange;
use smol_str::SmolStr;

use super::entity::{Entity, Part};
use super::expr::ExprId;
pub use crate::syntax::pl7::chart::ast::{ActionKind, CodeLanguage, ConnectorKind, LinkKind, StepKind};

/// The graph that a step belongs to: numbers are unique in each.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Graph {
    Main,
    /// The expansion of a macro-step.
    Macro(u32),
}

/// What a step is called in its graph.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum StepName {
    Number(u32),
    /// First and last step of an expansion.
    In,
    Out,
    /// `M3`: the macro-step whose expansion is graph 3.
    Macro(u32),
    /// In lower case.
    Symbol(SmolStr),
}

impl StepName {
    /// Reads `3`, `X3`, `%X2.3`, `IN`, `M3`, `XM3`, `Init`.
    pub fn parse(text: &str) -> Option<Self> {
        let bare = text.trim().trim_start_matches('%');
        let upper = bare.to_ascii_uppercase();
        // Of `X2.3`, the graph is known already.
        let name = match upper.strip_prefix('X') {
            Some(rest) if rest.starts_with(|it: char| it.is_ascii_digit() || it == 'M') => {
                rest.rsplit('.').next().unwrap_or(rest)
            }
            _ => &upper,
        };
        let number = |digits: &str| -> Option<u32> {
            let is_number = !digits.is_empty() && digits.bytes().all(|it| it.is_ascii_digit());
            is_number.then(|| digits.parse().unwrap_or(u32::MAX))
        };
        if let Some(number) = number(name) {
            return Some(Self::Number(number));
        }
        match name {
            "" => None,
            "IN" => Some(Self::In),
            "OUT" => Some(Self::Out),
            _ => match name.strip_prefix('M').and_then(number) {
                Some(number) => Some(Self::Macro(number)),
                None => Some(Self::Symbol(bare.to_lowercase().into())),
            },
        }
    }

    /// The bit that is 1 while the step is active: `%X3`, `%X2.3`, `%XM3`; of a step with a name, `Name.X`.
    pub fn bit(&self, graph: Graph) -> SmolStr {
        let number = match self {
            Self::Number(number) => number.to_string(),
            Self::In => "IN".to_owned(),
            Self::Out => "OUT".to_owned(),
            Self::Macro(number) => return format!("%XM{number}").into(),
            Self::Symbol(name) => return format!("{name}.X").into(),
        };
        match graph {
            Graph::Main => format!("%X{number}").into(),
            Graph::Macro(of) => format!("%X{of}.{number}").into(),
        }
    }
}

impl fmt::Display for StepName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => write!(f, "{number}"),
            Self::In => f.write_str("IN"),
            Self::Out => f.write_str("OUT"),
            Self::Macro(number) => write!(f, "M{number}"),
            Self::Symbol(name) => f.write_str(name),
        }
    }
}

/// A cell of a page: column and line from 0, as the exchange form counts them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Cell {
    /// Number of the page, where the text says one.
    pub page: Option<u32>,
    pub column: u32,
    pub line: u32,
}

impl Cell {
    fn below(self) -> Option<Self> {
        Some(Self { line: self.line.checked_add(1)?, ..self })
    }
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Step {
    /// `None` where the text lacks it.
    pub name: Option<StepName>,
    /// As written.
    pub text: SmolStr,
    pub kind: StepKind,
    pub cell: Option<Cell>,
    /// Place of the name, else of the keyword.
    pub range: TextRange,
    pub anchor: u32,
    /// Whether a comment stands in it.
    pub commented: bool,
}

/// What stands before or behind a transition.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum Node {
    /// Index into [`Chart::steps`].
    Step(u32),
    /// Index into [`Chart::connectors`].
    Connector(u32),
    /// A step that the unit does not hold.
    Named(StepName),
}

/// The condition of a transition.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Receptivity {
    /// Not programmed: always false (PL7:4651).
    Missing,
    /// Its value while the transition is valid.
    Value(ExprId),
    /// In a form that is not understood.
    Unread,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Transition {
    pub sources: Vec<Node>,
    pub targets: Vec<Node>,
    pub cell: Option<Cell>,
    pub receptivity: Receptivity,
    /// Of the receptivity, where it says one.
    pub language: Option<CodeLanguage>,
    /// Where another condition can be asked as well.
    pub room: Option<Room>,
    /// Place of the keyword.
    pub range: TextRange,
    pub anchor: u32,
}

/// Where a receptivity can be made to ask another condition as well, by anchors.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Room {
    /// Before and behind the expression of structured text. `binds`: an `AND` behind it takes in the whole of it.
    Expression { before: u32, behind: u32, binds: bool },
    /// Behind the last test of a list.
    List { behind: u32 },
    /// A horizontal link of so many cells, through which all power of the rung goes to its end.
    Link { at: u32, cells: u32 },
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Connector {
    pub kind: ConnectorKind,
    /// The step that it names.
    pub name: Option<StepName>,
    /// As written.
    pub text: SmolStr,
    pub cell: Option<Cell>,
    /// Steps of the unit that an origin connector leads to, as indices.
    pub steps: Vec<u32>,
    /// Place of the name, else of the keyword.
    pub range: TextRange,
    pub anchor: u32,
}

/// A link as it is drawn.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Link {
    pub kind: LinkKind,
    pub from: Vec<Cell>,
    pub to: Vec<Cell>,
    pub segments: Vec<Segment>,
    /// Whether it joins a step, or a connector in its place, with a transition.
    pub is_joined: bool,
    /// Place of the keyword.
    pub range: TextRange,
}

/// A straight part of a link.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Segment {
    /// Along a line of the page.
    pub is_horizontal: bool,
    pub from: Cell,
    pub to: Cell,
}

/// The code of one action.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Action {
    /// Steps that run it, as indices: one, unless several steps name it.
    pub steps: Vec<u32>,
    /// `None` where steps run it in different ways, or the text does not say how.
    pub kind: Option<ActionKind>,
    pub language: Option<CodeLanguage>,
    /// Condition under which its code starts.
    pub path: ExprId,
    /// Places that its code names.
    pub anchors: Range<u32>,
    pub range: TextRange,
}

/// What a unit holds of a chart.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Chart {
    pub graph: Graph,
    /// Number of pages that the text announces.
    pub page_count: Option<u32>,
    pub steps: Vec<Step>,
    pub transitions: Vec<Transition>,
    pub connectors: Vec<Connector>,
    pub links: Vec<Link>,
    /// In the order in which their code runs.
    pub actions: Vec<Action>,
    /// Some of what stands between the elements was not understood.
    pub has_gaps: bool,
}

/// A divergence or convergence with its branches, as they are joined.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Junction {
    pub kind: LinkKind,
    /// Where it is: the step, connector or transition that the branches leave or reach.
    pub at: TextRange,
    pub branches: Vec<TextRange>,
}

/// An element that stands in a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Element {
    Step(u32),
    Transition(u32),
    Connector(u32),
}

impl Chart {
    pub fn new(graph: Graph) -> Self {
        Self {
            graph,
            page_count: None,
            steps: Vec::new(),
            transitions: Vec::new(),
            connectors: Vec::new(),
            links: Vec::new(),
            actions: Vec::new(),
            has_gaps: false,
        }
    }

    /// The action whose code names a place.
    pub fn action_at(&self, anchor: u32) -> Option<&Action> {
        let after = self.actions.partition_point(|it| it.anchors.start <= anchor);
        self.actions[..after].last().filter(|it| it.anchors.contains(&anchor))
    }

    /// Joins vertical neighbours, and what links join.
    pub fn join(&mut self) {
        let steps = self.steps.iter().map(|it| it.cell).zip((0..).map(Element::Step));
        let transitions = self.transitions.iter().map(|it| it.cell).zip((0..).map(Element::Transition));
        let connectors = self.connectors.iter().map(|it| it.cell).zip((0..).map(Element::Connector));
        let elements = self.steps.len() + self.transitions.len() + self.connectors.len();
        let mut grid = rustc_hash::FxHashMap::with_capacity_and_hasher(elements, rustc_hash::FxBuildHasher);
        for (cell, element) in steps.chain(transitions).chain(connectors) {
            // Of two elements in one cell, which is a mistake, the first counts.
            if let Some(cell) = cell {
                grid.entry(cell).or_insert(element);
            }
        }
        let mut pairs: Vec<(Element, Element)> = Vec::new();
        for (&cell, &element) in &grid {
            if let Some(below) = cell.below().and_then(|it| grid.get(&it)) {
                pairs.push((element, *below));
            }
        }
        // The order of a hash table means nothing.
        pairs.sort_by_key(|it| (key(it.0), key(it.1)));
        let mut joined = rustc_hash::FxHashSet::with_capacity_and_hasher(pairs.len(), rustc_hash::FxBuildHasher);
        for (above, below) in pairs {
            if self.connect(above, below) {
                joined.insert((key(above), key(below)));
            }
        }
        for at in 0..self.links.len() {
            let link = &self.links[at];
            let mut pairs = Vec::new();
            // A link has one cell at one of its ends; of a grid of both, no more than so many are joined.
            const MOST: usize = 64;
            for from in link.from.iter().take(MOST) {
                for to in link.to.iter().take(MOST) {
                    pairs.push((grid.get(from).copied(), grid.get(to).copied()));
                }
            }
            let mut is_joined = !pairs.is_empty();
            for pair in pairs {
                is_joined &= match pair {
                    (Some(from), Some(to)) if joined.contains(&(key(from), key(to))) => true,
                    (Some(from), Some(to)) => self.connect(from, to) && joined.insert((key(from), key(to))),
                    _ => false,
                };
            }
            self.links[at].is_joined = is_joined;
        }
    }

    /// Joins two elements that are not joined yet, the first before the second; false if they do not go together.
    fn connect(&mut self, from: Element, to: Element) -> bool {
        let kind = |it: u32| self.connectors.get(it as usize).map(|it| it.kind);
        match (from, to) {
            (Element::Step(step), Element::Transition(at)) => {
                self.transitions[at as usize].sources.push(Node::Step(step));
            }
            (Element::Transition(at), Element::Step(step)) => {
                self.transitions[at as usize].targets.push(Node::Step(step));
            }
            (Element::Connector(it), Element::Transition(at)) if kind(it) == Some(ConnectorKind::Origin) => {
                self.transitions[at as usize].sources.push(Node::Connector(it));
            }
            (Element::Transition(at), Element::Connector(it)) if kind(it) == Some(ConnectorKind::Destination) => {
                self.transitions[at as usize].targets.push(Node::Connector(it));
            }
            (Element::Connector(it), Element::Step(step)) if kind(it) == Some(ConnectorKind::Origin) => {
                self.connectors[it as usize].steps.push(step);
            }
            _ => return false,
        }
        true
    }

    /// The name that a node leads to or comes from.
    pub fn name_of<'a>(&'a self, node: &'a Node) -> Option<&'a StepName> {
        match node {
            Node::Step(at) => self.steps.get(*at as usize)?.name.as_ref(),
            Node::Connector(at) => self.connectors.get(*at as usize)?.name.as_ref(),
            Node::Named(name) => Some(name),
        }
    }

    /// Elements that are joined because one stands below the other: both cells, and a place that names them.
    pub fn vertical_joins(&self) -> Vec<(Cell, Cell, TextRange)> {
        let cell = |node: &Node| match node {
            Node::Step(at) => self.steps.get(*at as usize)?.cell,
            Node::Connector(at) => self.connectors.get(*at as usize)?.cell,
            Node::Named(_) => None,
        };
        let mut joins = Vec::new();
        let mut join = |above: Option<Cell>, below: Option<Cell>, range: TextRange| {
            if let (Some(above), Some(below)) = (above, below)
                && above.below() == Some(below)
            {
                joins.push((above, below, range));
            }
        };
        for it in &self.transitions {
            it.sources.iter().for_each(|source| join(cell(source), it.cell, it.range));
            it.targets.iter().for_each(|target| join(it.cell, cell(target), it.range));
        }
        for it in &self.connectors {
            it.steps.iter().for_each(|&step| join(it.cell, cell(&Node::Step(step)), it.range));
        }
        joins
    }

    /// Every place where branches part or meet, in the order of the elements.
    pub fn junctions(&self) -> Vec<Junction> {
        let range = |node: &Node| match node {
            Node::Step(at) => self.steps.get(*at as usize).map(|it| it.range),
            Node::Connector(at) => self.connectors.get(*at as usize).map(|it| it.range),
            Node::Named(_) => None,
        };
        let mut leaving: rustc_hash::FxHashMap<&Node, Vec<TextRange>> = rustc_hash::FxHashMap::default();
        let mut reaching: rustc_hash::FxHashMap<&Node, Vec<TextRange>> = rustc_hash::FxHashMap::default();
        let mut found = Vec::new();
        for transition in &self.transitions {
            for source in &transition.sources {
                leaving.entry(source).or_default().push(transition.range);
            }
            for target in &transition.targets {
                reaching.entry(target).or_default().push(transition.range);
            }
            for (kind, nodes) in
                [(LinkKind::AndDivergence, &transition.targets), (LinkKind::AndConvergence, &transition.sources)]
            {
                if nodes.len() > 1 {
                    let branches = nodes.iter().map(|it| range(it).unwrap_or(transition.range)).collect();
                    found.push(Junction { kind, at: transition.range, branches });
                }
            }
        }
        // A step is also reached from other pages, through origin connectors.
        let mut arriving: rustc_hash::FxHashMap<u32, Vec<TextRange>> = rustc_hash::FxHashMap::default();
        for connector in &self.connectors {
            for &step in &connector.steps {
                arriving.entry(step).or_default().push(connector.range);
            }
        }
        let steps = (0..).zip(&self.steps).map(|(at, it)| (Node::Step(at), it.range, arriving.get(&at)));
        let connectors = (0..).zip(&self.connectors).map(|(at, it)| (Node::Connector(at), it.range, None));
        for (node, at, arriving) in steps.chain(connectors) {
            let from = leaving.get(&node).cloned().unwrap_or_default();
            let mut to = reaching.get(&node).cloned().unwrap_or_default();
            to.extend(arriving.into_iter().flatten());
            for (kind, branches) in [(LinkKind::OrDivergence, from), (LinkKind::OrConvergence, to)] {
                if branches.len() > 1 {
                    found.push(Junction { kind, at, branches });
                }
            }
        }
        found.sort_by_key(|it| it.at.start());
        found
    }
}

fn key(element: Element) -> (u8, u32) {
    match element {
        Element::Step(at) => (0, at),
        Element::Transition(at) => (1, at),
        Element::Connector(at) => (2, at),
    }
}

/// What a unit of a chart is, by the words that the vendor names it with (PL7:4539, 4656).
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Place {
    pub graph: Graph,
    pub page: Option<u32>,
    pub what: Piece,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Piece {
    /// A page or a whole chart.
    Chart,
    /// `%X1 P1`.
    Action { step: StepName, kind: ActionKind },
    /// `%X(0) --> %X(1)`.
    Receptivity { from: StepName, to: StepName },
}

/// Reads what an entity says of its place in a chart: `CHART - PAGE 0 %X1 P1`, `MACRO2 - PAGE 3`.
pub fn place(entity: &Entity) -> Option<Place> {
    let Entity::Pl7 { part: Part::Chart(rest), .. } = entity else { return None };
    let mut words = rest.split(|it: char| it.is_whitespace()).filter(|it| !it.is_empty() && *it != "-").peekable();
    let first = words.next()?.to_ascii_uppercase();
    let graph = match first.strip_prefix("MACRO").and_then(|it| it.parse().ok()) {
        Some(number) => Graph::Macro(number),
        None => Graph::Main,
    };
    let mut page = None;
    if words.next_if(|it| it.eq_ignore_ascii_case("PAGE")).is_some() {
        page = words.next().and_then(|it| it.parse().ok());
    }
    let step = |text: &str| StepName::parse(&text.replace(['(', ')'], ""));
    // A step of PL7-2 has one action, which runs while it is active (PL72:1421-1436).
    let is_pl7_2 = first == "SEQ";
    let what = match (words.next(), words.next(), words.next()) {
        (Some(at), None, None) if is_pl7_2 => Piece::Action { step: step(at)?, kind: ActionKind::Continuous },
        (Some(from), Some("-->" | "->"), Some(to)) => Piece::Receptivity { from: step(from)?, to: step(to)? },
        (Some(at), Some(kind), None) => Piece::Action { step: step(at)?, kind: ActionKind::of(kind)? },
        _ => Piece::Chart,
    };
    Some(Place { graph, page, what })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::entity_from_address;

    #[test]
    fn names_of_steps() {
        for (text, expected) in [
            ("3", Some(StepName::Number(3))),
            ("%X3", Some(StepName::Number(3))),
            ("X2.3", Some(StepName::Number(3))),
            ("%X2.IN", Some(StepName::In)),
            ("out", Some(StepName::Out)),
            ("M12", Some(StepName::Macro(12))),
            ("%XM12", Some(StepName::Macro(12))),
            ("Init", Some(StepName::Symbol("init".into()))),
            ("Xylophone", Some(StepName::Symbol("xylophone".into()))),
            ("Main", Some(StepName::Symbol("main".into()))),
            ("99999999999", Some(StepName::Number(u32::MAX))),
            ("", None),
        ] {
            assert_eq!(StepName::parse(text), expected, "{text}");
        }
        assert_eq!(StepName::Number(3).bit(Graph::Macro(2)), "%X2.3");
        assert_eq!(StepName::In.bit(Graph::Macro(2)), "%X2.IN");
        assert_eq!(StepName::Macro(2).bit(Graph::Main), "%XM2");
    }

    #[test]
    fn places_of_units() {
        let place = |address: &str| super::place(&entity_from_address(address).unwrap_or_else(|| panic!("{address}")));
        let chart = |graph, page| Some(Place { graph, page, what: Piece::Chart });
        assert_eq!(place("MAST - Peinture - CHART"), chart(Graph::Main, None));
        assert_eq!(place("MAST - Peinture - CHART - PAGE 3"), chart(Graph::Main, Some(3)));
        assert_eq!(place("MAST - MACRO2 - PAGE 0"), chart(Graph::Macro(2), Some(0)));
        let what = |address: &str| place(address).map(|it| it.what);
        let action = Piece::Action { step: StepName::Number(1), kind: ActionKind::Activation };
        assert_eq!(what("MAST - Peinture - CHART - PAGE 0 %X1 P1"), Some(action));
        let receptivity = Piece::Receptivity { from: StepName::Number(0), to: StepName::Number(1) };
        assert_eq!(what("MAST - Peinture - CHART - PAGE 0 %X(0) --> %X(1)"), Some(receptivity));
        assert_eq!(what("MAST - Peinture - PRL"), None);
        let action = Piece::Action { step: StepName::Number(3), kind: ActionKind::Continuous };
        assert_eq!(what("PL7-2 - SEQ - X3"), Some(action));
        let receptivity = Piece::Receptivity { from: StepName::Number(3), to: StepName::Number(4) };
        assert_eq!(what("PL7-2 - SEQ - X3 --> X4"), Some(receptivity));
        assert_eq!(place("PL7-2 - SEQ"), chart(Graph::Main, None));
        assert_eq!(place("PL7-2 - SEQ - PAGE 3"), chart(Graph::Main, Some(3)));
    }
}
