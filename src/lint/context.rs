//! What a rule is given.

use std::cell::OnceCell;

use rowan::TextRange;

use super::settings::Settings;
use super::suppress::Leftover;
use crate::analysis::counts::{self, Numbered};
use crate::analysis::program::{ObjectUses, ProgramIndex};
use crate::analysis::reach::Study;
use crate::analysis::sequences::Sequences;
use crate::model::UnitModel;
use crate::model::object::{Class, Type};
use crate::model::pl7_kinds::Kinds;
use crate::syntax::awl::ast::Instr;
use crate::syntax::{AstNode as _, Parse, SyntaxElement, SyntaxKind, SyntaxNode};
use crate::target::Target;

/// Nodes with their parents, in the order of the text, and comments.
struct NodesByKind<'a> {
    comments: Vec<TextRange>,
    nodes: Vec<(SyntaxNode<'a>, SyntaxNode<'a>)>,
    /// Indices into `nodes`, those of a kind together and in order.
    order: Vec<u32>,
    /// Where in `order` those of each kind end; they begin where the kind before ends.
    ends: [u32; 256],
}

impl<'a> NodesByKind<'a> {
    fn new(nodes: Vec<(SyntaxNode<'a>, SyntaxNode<'a>)>, comments: Vec<TextRange>) -> Self {
        let mut starts = [0_u32; 256];
        for (_, node) in &nodes {
            starts[node.kind() as usize] += 1;
        }
        let mut sum = 0;
        for start in &mut starts {
            sum += std::mem::replace(start, sum);
        }
        let mut ends = starts;
        let mut order = vec![0; nodes.len()];
        for (at, (_, node)) in (0..).zip(&nodes) {
            let end = &mut ends[node.kind() as usize];
            order[*end as usize] = at;
            *end += 1;
        }
        Self { comments, nodes, order, ends }
    }

    fn of(&self, kind: SyntaxKind) -> impl Iterator<Item = (SyntaxNode<'a>, SyntaxNode<'a>)> {
        let start = (kind as usize).checked_sub(1).map_or(0, |it| self.ends[it] as usize);
        let order = &self.order[start..self.ends[kind as usize] as usize];
        order.iter().map(|it| self.nodes[*it as usize])
    }
}

/// What stands below a node. The tree's height is limited by the parser.
fn gather<'a>(
    parent: SyntaxNode<'a>,
    nodes: &mut Vec<(SyntaxNode<'a>, SyntaxNode<'a>)>,
    comments: &mut Vec<TextRange>,
) {
    let mut children = parent.children_with_tokens();
    while let Some(element) = children.next_node_or(|it| it == SyntaxKind::Comment) {
        let node = match element {
            SyntaxElement::Node(node) => node,
            SyntaxElement::Token(comment) => {
                comments.push(comment.text_range());
                continue;
            }
        };
        // Leaves are by far the most, and no rule asks for all of them.
        match node.kind() {
            SyntaxKind::ObjectRef
            | SyntaxKind::NameRef
            | SyntaxKind::Literal
            | SyntaxKind::IlInstr
            | SyntaxKind::Instr => {}
            _ => nodes.push((parent, node)),
        }
        if !node.is_leaf() {
            gather(node, nodes, comments);
        }
    }
}

/// One unit: its model, its tree, its text. Places are ranges relative to the unit.
pub struct UnitCx<'a> {
    pub model: &'a UnitModel,
    pub parse: &'a Parse,
    pub text: &'a str,
    pub settings: &'a Settings,
    pub target: &'a Target,
    nodes: OnceCell<NodesByKind<'a>>,
    kinds: Kinds<'a>,
}

impl<'a> UnitCx<'a> {
    pub(crate) fn new(
        model: &'a UnitModel,
        parse: &'a Parse,
        text: &'a str,
        settings: &'a Settings,
        target: &'a Target,
    ) -> Self {
        Self { model, parse, text, settings, target, nodes: OnceCell::new(), kinds: Kinds::new(model) }
    }

    /// Every node of a kind, in the order of the text; none for objects, names, literals and instructions. The tree is
    /// walked once for all rules.
    pub fn nodes(&self, kind: SyntaxKind) -> impl Iterator<Item = SyntaxNode<'a>> {
        self.nodes_in(kind).map(|it| it.1)
    }

    /// As [`Self::nodes`], each behind the node that it is a child of.
    pub fn nodes_in(&self, kind: SyntaxKind) -> impl Iterator<Item = (SyntaxNode<'a>, SyntaxNode<'a>)> {
        self.index().of(kind)
    }

    /// The instructions of a statement list, in the order of the text.
    pub fn instrs(&self) -> impl Iterator<Item = Instr<'a>> {
        self.parse.syntax().outermost(SyntaxKind::Instr).filter_map(Instr::cast)
    }

    /// The comments that are closed, in the order of the text.
    pub fn comments(&self) -> &[TextRange] {
        &self.index().comments
    }

    fn index(&self) -> &NodesByKind<'a> {
        self.nodes.get_or_init(|| {
            let size = self.text.len();
            let (mut nodes, mut comments) = (Vec::with_capacity(size / 16), Vec::with_capacity(size / 64));
            gather(self.parse.syntax(), &mut nodes, &mut comments);
            NodesByKind::new(nodes, comments)
        })
    }

    /// Whether the author left parts of the unit out (`...`), as listings in documents do.
    pub fn leaves_out(&self) -> bool {
        self.parse.syntax().descendant_tokens().any(|it| it.kind() == SyntaxKind::Elision)
    }

    /// Kinds of values of PL7 expressions.
    pub fn kinds(&self) -> &Kinds<'a> {
        &self.kinds
    }

    /// Text of a place; empty when the range is not one.
    pub fn text_of(&self, range: TextRange) -> &'a str {
        self.text.get(usize::from(range.start())..usize::from(range.end())).unwrap_or_default()
    }
}

/// A program: the facts of all its units. Places are sites, which have no position.
pub struct ProgramCx<'a> {
    pub program: &'a ProgramIndex<'a>,
    pub settings: &'a Settings,
    pub target: &'a Target,
    overlaps: OnceCell<Vec<(u32, u32)>>,
    neighbours: OnceCell<Neighbours>,
    numbers: OnceCell<Vec<Numbered<'a>>>,
    studies: OnceCell<Vec<Study<'a, 'a>>>,
    sequence_studies: OnceCell<Vec<Study<'a, 'a>>>,
}

impl<'a> ProgramCx<'a> {
    pub(crate) fn new(program: &'a ProgramIndex<'a>, settings: &'a Settings, target: &'a Target) -> Self {
        let (overlaps, neighbours) = (OnceCell::new(), OnceCell::new());
        let (numbers, studies, sequence_studies) = (OnceCell::new(), OnceCell::new(), OnceCell::new());
        Self { program, settings, target, overlaps, neighbours, numbers, studies, sequence_studies }
    }

    /// The objects that are counted, each with its number.
    pub fn numbers(&self) -> &[Numbered<'a>] {
        self.numbers.get_or_init(|| counts::numbers(self.program))
    }

    /// The charts of the program with what they reach, made once for all rules.
    pub fn studies(&self) -> &[Study<'a, 'a>] {
        self.studies.get_or_init(|| Study::all(self.program))
    }

    /// The sequences that the program codes with bits.
    pub fn sequences(&self) -> &'a Sequences<'a> {
        self.program.sequences()
    }

    /// Those sequences with what they reach, in their order.
    pub fn sequence_studies(&self) -> &[Study<'a, 'a>] {
        self.sequence_studies.get_or_init(|| {
            let charts = self.program.sequence_charts();
            let all = self.sequences().list.iter().zip(charts);
            all.map(|(it, chart)| it.study(self.program.family, chart)).collect()
        })
    }

    /// Outputs, memory bits and bits by symbol to which no other object that the program names gives a value (no word or table
    /// that covers it). A memory bit is among them when something reads it. Of these, rules may say that a place is missing,
    /// unless it is [unseen](crate::analysis::unseen::Unseen::may_give).
    pub fn known_bits(&self) -> impl Iterator<Item = &ObjectUses<'a>> {
        let objects = (0..).zip(&self.program.objects);
        objects.filter(|&(at, it)| self.is_known_bit(at, it)).map(|it| it.1)
    }

    fn is_known_bit(&self, at: u32, uses: &ObjectUses<'_>) -> bool {
        let class = uses.object.class;
        let is_bit = uses.object.ty == Type::Bool || class == Class::Symbol;
        if !is_bit || !uses.object.is_fixed() || !matches!(class, Class::Output | Class::Memory | Class::Symbol) {
            return false;
        }
        let mut neighbours = self.neighbours(at).iter().map(|&it| &self.program.objects[it as usize]);
        let is_read = class != Class::Memory || uses.is_read() || neighbours.clone().any(ObjectUses::is_read);
        is_read && !neighbours.any(ObjectUses::is_written)
    }

    /// See [`ProgramIndex::overlaps`].
    pub fn overlaps(&self) -> &[(u32, u32)] {
        self.overlaps.get_or_init(|| self.program.overlaps())
    }

    /// Other objects that share memory with an object, all by index.
    pub fn neighbours(&self, object: u32) -> &[u32] {
        self.neighbours.get_or_init(|| Neighbours::new(self.program.objects.len(), self.overlaps())).of(object)
    }
}

/// Pairs of numbers, looked up by either of both.
struct Neighbours {
    /// Where those of each number start, and where those of the last end.
    starts: Box<[u32]>,
    all: Box<[u32]>,
}

impl Neighbours {
    fn new(numbers: usize, pairs: &[(u32, u32)]) -> Self {
        let mut starts = vec![0; numbers + 1];
        for &(a, b) in pairs {
            starts[a as usize] += 1;
            starts[b as usize] += 1;
        }
        let mut end = 0;
        for it in &mut starts {
            end += *it;
            *it = end;
        }
        let mut all = vec![0; pairs.len() * 2];
        for &(a, b) in pairs.iter().rev() {
            for (it, other) in [(b, a), (a, b)] {
                let start = &mut starts[it as usize];
                *start -= 1;
                all[*start as usize] = other;
            }
        }
        Self { starts: starts.into(), all: all.into() }
    }

    fn of(&self, number: u32) -> &[u32] {
        let at = number as usize;
        let (Some(&start), Some(&end)) = (self.starts.get(at), self.starts.get(at + 1)) else { return &[] };
        &self.all[start as usize..end as usize]
    }
}

/// A file after all rules of its units and its program ran. Places are ranges of the file.
pub struct FileCx<'a> {
    /// As it was decoded.
    pub text: &'a str,
    /// Words of suppression comments that suppressed nothing, or name no rule.
    pub leftovers: &'a [Leftover],
}
