//! The grid of a rung: where its elements stand, what is wired to what, and in which order it is evaluated.
//!
//! A *wire* is a set of points that links join without an element between them. Power comes from the left rail and flows
//! along a row from left to right only, along vertical links both ways (PL7:2785-2788), so that the elements form a graph
//! without cycles.
//!
//! **Invariant:** time and memory are linear in the text of the rung, whatever numbers it holds.

use rowan::TextRange;
use rustc_hash::{FxHashMap, FxHashSet};

use super::sets::Sets;
use crate::syntax::pl7::ast::{Cell, Expr, Rung, RungRow};
use crate::syntax::pl7::ladder_words::Element;
use crate::syntax::{AstNode as _, Language};
use crate::target::{pl7, pl72};

/// Whose rungs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Layout {
    Pl7,
    Pl72,
}

impl Layout {
    /// Of the rungs of a unit, or of the actions and receptivities in it.
    pub fn of(language: Language) -> Self {
        if language.is_pl7_2() { Self::Pl72 } else { Self::Pl7 }
    }

    /// Columns, that of the actions included.
    pub fn columns(self) -> u32 {
        match self {
            Self::Pl7 => pl7::LADDER_COLUMNS.value,
            Self::Pl72 => pl72::LADDER_COLUMNS.value,
        }
    }

    /// Lines of the controller that has the most.
    fn lines(self) -> u32 {
        match self {
            Self::Pl7 => pl7::Series::Premium.ladder_lines().value,
            Self::Pl72 => pl72::LADDER_LINES.value,
        }
    }

    /// Cells that one word makes are counted up to this.
    fn most_cells(self) -> u32 {
        self.columns() + 1
    }

    /// The same of rows.
    fn most_lines(self) -> u32 {
        self.lines() + 1
    }

    /// The function block that a cell names.
    pub fn block_of(self, cell: Cell<'_>) -> Option<BlockShape> {
        match (self, cell.operand()?) {
            (Self::Pl7, Expr::Object(it)) => pl7::block::of_address(&it.address()).map(BlockShape::Pl7),
            (Self::Pl72, Expr::Object(it)) => pl72::of_address(&it.address()).map(BlockShape::Pl72),
            (Self::Pl72, Expr::Name(it)) => pl72::of_address(&it.path()).map(BlockShape::Pl72),
            (Self::Pl72, Expr::Call(it)) => pl72::of_address(it.name()?.text()).map(BlockShape::Pl72),
            _ => None,
        }
    }

    fn width_of(self, element: Element, cell: Cell<'_>) -> u32 {
        match (self, element) {
            (Self::Pl7, Element::Compare) => pl7::COMPARE_COLUMNS.value,
            (Self::Pl72, Element::Compare) => pl72::COMPARE_COLUMNS.value,
            (Self::Pl7, Element::Operate) => pl7::OPERATE_COLUMNS.value,
            (Self::Pl72, Element::Operate) => pl72::OPERATE_COLUMNS.value,
            (_, Element::Block) => self.block_of(cell).and_then(BlockShape::columns).unwrap_or(self.block_columns()),
            _ => 1,
        }
    }

    /// Whether no source tells the size of the block in a cell.
    fn is_assumed(self, cell: Cell<'_>) -> bool {
        match self {
            Self::Pl7 => self.width_of(Element::Block, cell) == pl7::block::COLUMNS.value,
            Self::Pl72 => self.block_of(cell).and_then(BlockShape::columns).is_none(),
        }
    }

    /// Columns of a block whose size is not known.
    fn block_columns(self) -> u32 {
        match self {
            Self::Pl7 => pl7::block::COLUMNS.value,
            Self::Pl72 => pl72::BLOCK_COLUMNS.value,
        }
    }
}

/// Size and pins of a function block.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BlockShape {
    Pl7(&'static pl7::block::Block),
    Pl72(&'static pl72::Block),
}

impl BlockShape {
    /// Letters of its address; none for the clock of PL7-2.
    pub fn letters(self) -> &'static str {
        match self {
            Self::Pl7(it) => it.letters,
            Self::Pl72(it) => it.symbol.unwrap_or_default(),
        }
    }

    /// Names of its inputs, from top to bottom.
    pub fn inputs(self) -> impl ExactSizeIterator<Item = &'static str> {
        let count = match self {
            Self::Pl7(it) => it.inputs.len(),
            Self::Pl72(it) => it.inputs.len(),
        };
        (0..count).map(move |at| match self {
            Self::Pl7(it) => it.inputs[at],
            Self::Pl72(it) => it.inputs[at].name,
        })
    }

    /// Names of its outputs, from top to bottom.
    pub fn outputs(self) -> &'static [&'static str] {
        match self {
            Self::Pl7(it) => it.outputs,
            Self::Pl72(it) => it.outputs,
        }
    }

    fn columns(self) -> Option<u32> {
        match self {
            Self::Pl7(it) => Some(it.columns.value),
            Self::Pl72(it) => it.columns.map(|it| it.value),
        }
    }
}

/// Index of a wire.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Wire(u32);

impl Wire {
    /// The left rail.
    pub const RAIL: Self = Self(0);
}

/// An element where it stands. A link over several cells is one element, unless a vertical link meets it between them: then
/// it is one up to there, and another one behind.
#[derive(Debug, Clone)]
pub struct Placed<'t> {
    pub cell: Cell<'t>,
    /// `None`: a word that is not known.
    pub element: Option<Element>,
    /// Row and column of its upper left cell, from 0.
    pub row: u32,
    pub column: u32,
    /// Cells.
    pub width: u32,
    /// Its place among the elements of the grid.
    index: u32,
}

impl Placed<'_> {
    pub fn range(&self) -> TextRange {
        self.cell.syntax().text_range()
    }

    /// Whether a part of the cell was not understood.
    pub fn is_broken(&self) -> bool {
        self.cell.syntax().has_error()
    }

    fn is_link(&self) -> bool {
        matches!(self.element, Some(Element::HLink | Element::ShortCircuit))
    }

    fn is_action(&self) -> bool {
        self.element.is_some_and(Element::is_action)
    }

    fn is_block(&self) -> bool {
        self.element == Some(Element::Block)
    }

    fn is_actual(&self) -> bool {
        self.element == Some(Element::Actual)
    }

    /// The column behind its last one, from 0.
    pub fn end(&self) -> u32 {
        self.column + self.width
    }
}

/// What breaks the rules of a rung (PL7:2769-2836).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Flaw {
    /// A test in the column of actions; its last column, from 1.
    TestInActionZone(u32),
    /// An action that does not end in the column of actions; its last column, from 1.
    ActionInTestZone(u32),
    /// No power can come to the element.
    NotFed,
    /// The same of a function or operation block.
    BlockNotFed,
    /// What the element lets through goes nowhere.
    LeadsNowhere,
    /// What a pin of a DFB is given, in a cell beside which there is none.
    FacesNoPin,
    /// A vertical link that ends at nothing.
    OpenLink,
    /// A wire goes round the element.
    Bypassed,
    /// `(#)` where no transition is.
    HashOutsideTransition,
    /// Another coil in a transition.
    CoilInTransition,
    /// What a transition must not hold besides.
    ElementInTransition,
    /// A contact reads a bit that a later connected network of the rung drives.
    ReadBeforeDriven,
}

#[derive(Debug)]
pub struct Grid<'t> {
    pub layout: Layout,
    /// Row by row, each from left to right. Empty cells are left out.
    pub placed: Vec<Placed<'t>>,
    /// Cells of each row. Of a number beyond all limits, as many as show that it is.
    pub rows: Vec<Row<'t>>,
    /// Vertical links: each leads from a row to the one below, at the left edge of a column; both from 0.
    pub vertical: Vec<(u32, u32)>,
    /// Of each element.
    inputs: Lists<Wire>,
    outputs: Lists<Wire>,
    /// Of each wire, the elements on its left and on its right, by index into [`Self::placed`]. Through what a pin of a DFB
    /// is given nothing flows: it is on neither side.
    left: Lists<u32>,
    right: Lists<u32>,
    /// What pins of DFBs are given, by the wire of the pin.
    input_actuals: FxHashMap<Wire, u32>,
    output_actuals: FxHashMap<Wire, u32>,
    open_links: Vec<TextRange>,
}

/// Lists in one allocation.
#[derive(Debug)]
struct Lists<T> {
    items: Vec<T>,
    /// Where each list ends that is finished.
    ends: Vec<usize>,
}

impl<T> Default for Lists<T> {
    fn default() -> Self {
        Self { items: Vec::new(), ends: Vec::new() }
    }
}

impl<T: Copy + Default> Lists<T> {
    /// `count` lists, of items that come with the number of their list; in each they keep their order.
    fn sorted(count: usize, items: impl Iterator<Item = (usize, T)> + Clone) -> Self {
        let mut next = vec![0; count + 1];
        items.clone().for_each(|it| next[it.0 + 1] += 1);
        for at in 1..next.len() {
            next[at] += next[at - 1];
        }
        let mut sorted = vec![T::default(); next[count]];
        for (list, item) in items {
            sorted[next[list]] = item;
            next[list] += 1;
        }
        // Each list has grown from its start to its end.
        next.truncate(count);
        Self { items: sorted, ends: next }
    }
}

impl<T> Lists<T> {
    fn with_capacity(lists: usize, items: usize) -> Self {
        Self { items: Vec::with_capacity(items), ends: Vec::with_capacity(lists) }
    }

    /// Finishes a list, which has what was added to `items` since the last one.
    fn finish(&mut self) {
        self.ends.push(self.items.len());
    }

    fn len(&self) -> usize {
        self.ends.len()
    }

    fn start(&self, list: usize) -> usize {
        list.checked_sub(1).and_then(|it| self.ends.get(it)).copied().unwrap_or(0)
    }

    /// Length of the list that is not finished.
    fn open_len(&self) -> usize {
        self.items.len() - self.start(self.len())
    }

    fn open(&self) -> &[T] {
        self.items.get(self.start(self.len())..).unwrap_or_default()
    }

    fn get(&self, list: usize) -> Option<&[T]> {
        self.items.get(self.start(list)..*self.ends.get(list)?)
    }

    fn of(&self, list: usize) -> &[T] {
        self.get(list).unwrap_or_default()
    }
}

#[derive(Debug, Clone, Copy)]
pub struct Row<'t> {
    pub columns: u32,
    /// The cell that goes beyond the last column.
    pub excess: Option<Cell<'t>>,
    /// The width of some block of it is not documented.
    pub is_assumed: bool,
    is_empty: bool,
    pub range: TextRange,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Unit {
    Empty,
    Link,
    /// Part of another element, which the number tells from those beside it.
    Part(u32),
}

/// Rows of cells while they are read.
#[derive(Default)]
struct Rows {
    units: Lists<Unit>,
    /// Vertical links: the row, the column whose right edge they stand at, the cell that draws them.
    links: Vec<(usize, usize, TextRange)>,
}

/// A cell while its row is read, at the column behind all before it.
struct Met<'t> {
    cell: Cell<'t>,
    element: Option<Element>,
    column: u32,
    /// Cells that it takes: of an empty line, those that its row still lacks.
    width: u32,
}

impl<'t> Row<'t> {
    /// The row, and those that an empty line in it adds.
    fn read(row: RungRow<'t>, layout: Layout, rows: &mut Vec<Self>, mut each: impl FnMut(Met<'t>)) {
        let range = row.syntax().text_range();
        let mut read = Row { columns: 0, excess: None, is_assumed: false, is_empty: true, range };
        let mut lines = 1;
        for cell in row.cells() {
            let element = cell.element();
            let count = || cell.count().unwrap_or(1);
            let width = match element {
                Some(Element::EmptyLine) => {
                    // An empty line is a row of its own, whatever else stands in it.
                    lines = count().clamp(1, layout.most_lines());
                    layout.columns().saturating_sub(read.columns)
                }
                Some(Element::EmptyCell | Element::HLink | Element::ShortCircuit) => count().min(layout.most_cells()),
                Some(it) => layout.width_of(it, cell),
                None => 1,
            };
            each(Met { cell, element, column: read.columns, width });
            read.columns = read.columns.saturating_add(width);
            read.is_assumed |= element == Some(Element::Block) && layout.is_assumed(cell);
            read.is_empty &= matches!(element, Some(Element::EmptyLine | Element::EmptyCell));
            if read.columns > layout.columns() {
                read.excess = read.excess.or(Some(cell));
            }
        }
        rows.push(read);
        let empty = Row { columns: layout.columns(), excess: None, is_assumed: false, is_empty: true, range };
        rows.extend((1..lines).map(|_| empty));
    }

    /// Rows down to the last one that holds something.
    pub fn used(rows: &[Self]) -> u32 {
        let last = rows.iter().rposition(|it| !it.is_empty);
        last.map_or(0, |it| number(it + 1))
    }
}

impl Rows {
    /// Adds a cell to the row that is not finished, and gives the element in it.
    fn add<'t>(&mut self, row: usize, met: &Met<'t>) -> Option<Placed<'t>> {
        let &Met { cell, element, column, width } = met;
        let unit = match element {
            Some(Element::EmptyLine | Element::EmptyCell | Element::VLink) => Unit::Empty,
            Some(Element::HLink | Element::ShortCircuit) => Unit::Link,
            _ => Unit::Part(number(self.units.items.len())),
        };
        self.units.items.extend(std::iter::repeat_n(unit, width as usize));
        if matches!(element, Some(Element::VLink | Element::ShortCircuit)) {
            self.links.push((row, self.units.open_len(), cell.syntax().text_range()));
        }
        (unit != Unit::Empty && width > 0).then(|| Placed { cell, element, row: number(row), column, width, index: 0 })
    }
}

fn number(it: usize) -> u32 {
    u32::try_from(it).unwrap_or(u32::MAX)
}

impl<'t> Grid<'t> {
    pub fn new(rung: Rung<'t>, layout: Layout) -> Self {
        let (mut grid, rows) = Self::read(rung, layout);
        grid.vertical = rows.links.iter().map(|it| (number(it.0), number(it.1))).collect();
        grid.wire(&rows);
        grid
    }

    /// The rows alone, without what stands in them.
    pub fn rows_of(rung: Rung<'t>, layout: Layout) -> Vec<Row<'t>> {
        let mut rows = Vec::new();
        for row in rung.rows() {
            Row::read(row, layout, &mut rows, |_| ());
        }
        rows
    }

    fn read(rung: Rung<'t>, layout: Layout) -> (Self, Rows) {
        let lines = rung.rows().count();
        let cells = lines * layout.columns() as usize;
        let mut grid = Self {
            layout,
            placed: Vec::with_capacity(cells),
            rows: Vec::with_capacity(lines),
            vertical: Vec::new(),
            inputs: Lists::default(),
            outputs: Lists::default(),
            left: Lists::default(),
            right: Lists::default(),
            input_actuals: FxHashMap::default(),
            output_actuals: FxHashMap::default(),
            open_links: Vec::new(),
        };
        let mut rows = Rows { units: Lists::with_capacity(lines, cells), links: Vec::new() };
        for row in rung.rows() {
            let at = rows.units.len();
            let before = grid.rows.len();
            Row::read(row, layout, &mut grid.rows, |it| grid.placed.extend(rows.add(at, &it)));
            rows.units.finish();
            for _ in before + 1..grid.rows.len() {
                rows.units.items.extend(std::iter::repeat_n(Unit::Empty, layout.columns() as usize));
                rows.units.finish();
            }
        }
        grid.part_links(&rows);
        for (index, it) in (0..).zip(&mut grid.placed) {
            it.index = index;
        }
        (grid, rows)
    }

    /// Parts the horizontal links that vertical ones meet.
    fn part_links(&mut self, rows: &Rows) {
        if rows.links.is_empty() {
            return;
        }
        let mut met: Vec<(u32, u32)> = Vec::with_capacity(2 * rows.links.len());
        for it in &rows.links {
            let (row, edge) = (number(it.0), number(it.1));
            met.extend([(row, edge), (row + 1, edge)]);
        }
        met.sort_unstable();
        met.dedup();
        let mut parts = Vec::with_capacity(self.placed.len() + met.len());
        for it in self.placed.drain(..) {
            let end = it.end();
            let mut rest = it;
            if rest.is_link() {
                let from = met.partition_point(|at| *at <= (rest.row, rest.column));
                for &(_, edge) in met[from..].iter().take_while(|at| **at < (rest.row, end)) {
                    parts.push(Placed { width: edge - rest.column, ..rest.clone() });
                    (rest.column, rest.width) = (edge, end - edge);
                }
            }
            parts.push(rest);
        }
        self.placed = parts;
    }

    /// Finds the wires, and what meets at them.
    fn wire(&mut self, rows: &Rows) {
        let Rows { units, links } = rows;
        // A point stands at the left edge of each cell, and at the right edge of the last one of a row.
        let first = |row: usize| units.start(row) + row;
        let points = first(units.len());
        let mut sets = Sets::new(points);
        // The left rail.
        for row in 1..units.len() {
            sets.join(0, first(row));
        }
        let unit = |row: usize, column: usize| units.get(row).and_then(|it| it.get(column)).copied();
        let is_full = |row: usize, column: usize| unit(row, column).is_some_and(|it| it != Unit::Empty);
        // Whether a link ends at a cell beside the point, or goes on.
        let mut drawn: FxHashSet<(usize, usize)> = FxHashSet::default();
        drawn.extend(links.iter().map(|it| (it.0, it.1)));
        let is_inside = |row: usize, edge: usize| {
            let before = edge.checked_sub(1).and_then(|it| unit(row, it));
            matches!((before, unit(row, edge)), (Some(Unit::Part(a)), Some(Unit::Part(b))) if a == b)
        };
        let meets = |row: usize, edge: usize| {
            !is_inside(row, edge) && (edge.checked_sub(1).is_some_and(|it| is_full(row, it)) || is_full(row, edge))
        };
        for &(row, edge, range) in links {
            let above = meets(row, edge) || row.checked_sub(1).is_some_and(|it| drawn.contains(&(it, edge)));
            let below = meets(row + 1, edge) || drawn.contains(&(row + 1, edge));
            if !above || !below {
                self.open_links.push(range);
            }
            if units.get(row + 1).is_some_and(|it| edge <= it.len()) {
                sets.join(first(row) + edge, first(row + 1) + edge);
            }
        }
        // The rows that each element has pins in, and the pins of DFBs, by row and edge: those of inputs, those of outputs.
        let mut heights = Vec::with_capacity(self.placed.len());
        let mut pins: [FxHashSet<(usize, usize)>; 2] = Default::default();
        for it in &self.placed {
            let (row, column, end) = (it.row as usize, it.column as usize, it.end() as usize);
            let is_free = |row: usize| (column..end).all(|it| unit(row, it) == Some(Unit::Empty));
            let height = (row..row + self.lines(it)).take_while(|at| *at == row || is_free(*at)).count();
            if self.is_dfb(it) {
                pins[0].extend((row..row + height).map(|it| (it, column)));
                pins[1].extend((row..row + height).map(|it| (it, end)));
            }
            heights.push(height);
        }
        self.inputs = Lists::with_capacity(heights.len(), heights.len());
        self.outputs = Lists::with_capacity(heights.len(), heights.len());
        let mut wires = WireNames { of_root: vec![None; points], count: 1 };
        if points > 0 {
            wires.of_root[sets.find(0)] = Some(Wire::RAIL);
        }
        for (it, height) in self.placed.iter().zip(heights) {
            let (row, column, end) = (it.row as usize, it.column as usize, it.end() as usize);
            // What a pin is given lies at its wire alone.
            let is_actual = it.is_actual();
            for row in row..row + height {
                let mut wire = |edge: usize| wires.name(sets.find(first(row) + edge));
                let (input, output) = (wire(column), (!it.is_action()).then(|| wire(end)));
                if !is_actual || pins[1].contains(&(row, column)) {
                    self.inputs.items.push(input);
                }
                if !is_actual || pins[0].contains(&(row, end)) {
                    self.outputs.items.extend(output);
                }
            }
            if is_actual {
                self.input_actuals.extend(self.outputs.open().iter().map(|wire| (*wire, it.index)));
                self.output_actuals.extend(self.inputs.open().iter().map(|wire| (*wire, it.index)));
            }
            self.inputs.finish();
            self.outputs.finish();
        }
        let conducting = self.placed.iter().filter(|it| !it.is_actual());
        let sides = [&self.outputs, &self.inputs].map(|of| {
            let ends = conducting
                .clone()
                .flat_map(|it| of.of(it.index as usize).iter().map(|wire| (wire.0 as usize, it.index)));
            Lists::sorted(wires.count as usize, ends)
        });
        [self.left, self.right] = sides;
    }

    /// The wire at the left edge of an element, of a function block one in each of its rows.
    pub fn inputs(&self, it: &Placed<'_>) -> &[Wire] {
        self.inputs.of(it.index as usize)
    }

    /// The wire at the right edge. What acts lets nothing through and has none.
    pub fn outputs(&self, it: &Placed<'_>) -> &[Wire] {
        self.outputs.of(it.index as usize)
    }

    /// Rows that an element takes.
    fn lines(&self, it: &Placed<'_>) -> usize {
        match it.element {
            Some(Element::Block) => match self.layout.block_of(it.cell) {
                Some(block) => block.inputs().len().max(block.outputs().len()),
                // As many as are free below, for its pins are not known.
                None => self.layout.lines() as usize,
            },
            _ => 1,
        }
    }

    /// Whether all of the rung was understood.
    pub fn is_read(&self) -> bool {
        self.placed.iter().all(|it| it.element.is_some() && !it.is_broken())
    }

    pub fn wire_count(&self) -> usize {
        self.left.len()
    }

    /// Index of a wire, below [`Self::wire_count`].
    pub fn index(wire: Wire) -> usize {
        wire.0 as usize
    }

    /// Whether some element, or the rail, stands at the left of a wire.
    pub fn is_fed(&self, wire: Wire) -> bool {
        wire == Wire::RAIL || !self.left.of(wire.0 as usize).is_empty()
    }

    /// Whether some element stands at the right of a wire.
    pub fn is_used(&self, wire: Wire) -> bool {
        !self.right.of(wire.0 as usize).is_empty()
    }

    /// The horizontal link through which all power goes to the `(#)` of a transition, and to nothing else: its place, and how
    /// many cells it has.
    pub fn link_before_end(&self) -> Option<(TextRange, u32)> {
        let mut ends = self.placed.iter().filter(|it| it.element == Some(Element::HashCoil));
        let end = ends.next().filter(|_| ends.next().is_none())?;
        let link = |wire: Wire| {
            let meets = |side: &Lists<u32>| side.of(wire.0 as usize).len();
            let is_between_two = wire != Wire::RAIL && meets(&self.left) == 1 && meets(&self.right) == 1;
            self.left_of(wire).next().filter(|it| is_between_two && it.element == Some(Element::HLink))
        };
        let last = link(*self.inputs(end).first()?)?;
        let (place, mut cells, mut at) = (last.range(), last.width, last);
        while let Some(before) = self.inputs(at).first().and_then(|it| link(*it)).filter(|it| it.range() == place) {
            (cells, at) = (cells + before.width, before);
        }
        let all: u32 = self.placed.iter().filter(|it| it.range() == place).map(|it| it.width).sum();
        (cells == all).then_some((place, cells))
    }

    /// What the input of a DFB at the right end of a wire is given.
    pub fn input_actual(&self, wire: Wire) -> Option<&Placed<'t>> {
        self.placed.get(*self.input_actuals.get(&wire)? as usize)
    }

    /// What the output of a DFB at the left end of a wire is given.
    pub fn output_actual(&self, wire: Wire) -> Option<&Placed<'t>> {
        self.placed.get(*self.output_actuals.get(&wire)? as usize)
    }

    fn left_of(&self, wire: Wire) -> impl Iterator<Item = &Placed<'t>> {
        self.left.of(wire.0 as usize).iter().map(|&it| &self.placed[it as usize])
    }

    /// The DFB whose output leads to an input of another one with less than the columns between them that there must be.
    pub fn too_close(&self, block: &Placed<'t>) -> Option<&Placed<'t>> {
        if self.is_beyond_reason() {
            return None;
        }
        let is_before = |it: &&Placed<'t>| self.is_dfb(it) && it.end() + pl7::DFB_GAP.value > block.column;
        self.inputs(block).iter().filter(|it| **it != Wire::RAIL).find_map(|&wire| {
            let beside = self.left_of(wire).find(is_before);
            // Less than two columns: there is room for one element.
            beside.or_else(|| {
                let inner = self.left_of(wire).filter(|it| !it.is_block());
                inner.flat_map(|it| self.inputs(it)).find_map(|&wire| self.left_of(wire).find(is_before))
            })
        })
    }

    /// The connected networks, the topmost first, of the same row the leftmost first; in each, the elements in the order
    /// in which they are evaluated: row by row, and where a branch from below joins, that branch before what goes on
    /// (PL7:2838-2899). An element follows all that lie on its left.
    ///
    /// PL7-2 scans the whole network column by column (PL72:626).
    pub fn networks(&self) -> Vec<Vec<usize>> {
        if self.layout == Layout::Pl72 {
            let mut all: Vec<usize> = (0..self.placed.len()).collect();
            // What a link gives is there with its last cell.
            let column = |it: &Placed<'_>| if it.is_link() { it.end() - 1 } else { it.column };
            all.sort_by_key(|&it| (column(&self.placed[it]), self.placed[it].row));
            return vec![all];
        }
        let mut sets = Sets::new(self.placed.len());
        for wire in 1..self.wire_count() {
            let mut members = self.left.of(wire).iter().chain(self.right.of(wire));
            if let Some(&one) = members.next() {
                members.for_each(|&it| sets.join(one as usize, it as usize));
            }
        }
        let mut order = Order {
            grid: self,
            wire_seen: vec![false; self.wire_count()],
            placed_seen: vec![false; self.placed.len()],
            tasks: Vec::new(),
            out: Vec::with_capacity(self.placed.len()),
        };
        // What nothing uses is what the rest is evaluated for.
        for (index, it) in self.placed.iter().enumerate() {
            if !self.outputs(it).iter().any(|wire| self.is_used(*wire)) {
                order.visit(index);
            }
        }
        let mut network_of: Vec<Option<usize>> = vec![None; self.placed.len()];
        let mut sizes: Vec<usize> = Vec::new();
        for index in 0..self.placed.len() {
            let network = *network_of[sets.find(index)].get_or_insert(sizes.len());
            match sizes.get_mut(network) {
                Some(size) => *size += 1,
                None => sizes.push(1),
            }
        }
        let mut networks: Vec<Vec<usize>> = sizes.into_iter().map(Vec::with_capacity).collect();
        for index in order.out {
            if let Some(network) = network_of[sets.find(index)] {
                networks[network].push(index);
            }
        }
        networks
    }

    /// What breaks the rules of a rung, with its place and the other place that takes part.
    pub fn flaws(&self) -> Vec<(Flaw, TextRange, Option<TextRange>)> {
        let mut flaws = Vec::new();
        let open_links: FxHashSet<TextRange> = self.open_links.iter().copied().collect();
        for it in &self.placed {
            let Some(element) = it.element else { continue };
            let columns = self.layout.columns();
            // A row that is too long is one mistake.
            if it.end() <= columns {
                if element.is_test() && it.end() == columns {
                    flaws.push((Flaw::TestInActionZone(it.end()), it.range(), None));
                } else if element.is_action() && it.end() < columns {
                    flaws.push((Flaw::ActionInTestZone(it.end()), it.range(), None));
                }
            }
            if it.is_actual() {
                if self.inputs(it).is_empty() && self.outputs(it).is_empty() && !it.is_broken() {
                    flaws.push((Flaw::FacesNoPin, it.range(), None));
                }
                continue;
            }
            if !self.inputs(it).iter().any(|wire| self.is_fed(*wire)) {
                let is_box = matches!(element, Element::Block | Element::Operate);
                flaws.push((if is_box { Flaw::BlockNotFed } else { Flaw::NotFed }, it.range(), None));
            }
            let is_loose = flaws.last().is_some_and(|last| last.0 == Flaw::NotFed && last.1 == it.range());
            // The outputs of a block may hang in the air (PL7:2808), and the right rail is an end.
            let ends = it.end() >= columns || it.is_block() || self.outputs(it).is_empty();
            // A vertical link that ends at nothing is the mistake then.
            let is_open = open_links.contains(&it.range());
            if !ends && !is_loose && !is_open && !self.outputs(it).iter().any(|wire| self.is_used(*wire)) {
                flaws.push((Flaw::LeadsNowhere, it.range(), None));
            }
        }
        flaws.extend(self.open_links.iter().map(|it| (Flaw::OpenLink, *it, None)));
        self.bypassed(&mut flaws);
        // The cells of one link are one place.
        flaws.dedup_by(|a, b| a.0 == b.0 && a.1 == b.1);
        flaws
    }

    /// Tests that a plain wire goes round: whenever power comes to where the branch starts, the wire has it at its end.
    fn bypassed(&self, flaws: &mut Vec<(Flaw, TextRange, Option<TextRange>)>) {
        if self.is_beyond_reason() {
            return;
        }
        for index in 1..self.wire_count() {
            let left = self.left.of(index);
            if left.len() < 2 || !left.iter().any(|&it| self.placed[it as usize].is_link()) {
                continue;
            }
            // Wires that give this one power through links alone, from right to left.
            let mut sources = vec![false; self.wire_count()];
            sources[index] = true;
            let mut chain = vec![index];
            let mut at = 0;
            while let Some(&from) = chain.get(at) {
                at += 1;
                for it in self.links_left_of(from) {
                    for input in self.inputs(it) {
                        if !std::mem::replace(&mut sources[input.0 as usize], true) {
                            chain.push(input.0 as usize);
                        }
                    }
                }
            }
            // Those among them that serve nothing else.
            let mut private = vec![false; self.wire_count()];
            private[index] = true;
            for _ in 0..self.layout.columns() {
                for &it in &chain {
                    let serves = |right: &u32| {
                        let right = &self.placed[*right as usize];
                        right.is_link() && self.outputs(right).iter().all(|it| private[it.0 as usize])
                    };
                    private[it] = private[it] || it != 0 && self.right.of(it).iter().all(serves);
                }
            }
            for &end in chain.iter().filter(|it| private[**it]) {
                for &last in self.left.of(end) {
                    let it = &self.placed[last as usize];
                    let is_test = it.element.is_some_and(Element::is_test) && !it.is_block();
                    if is_test && self.comes_from(last, &sources) {
                        let wire = chain.iter().flat_map(|&it| self.links_left_of(it)).find(|link| {
                            (link.column..link.end()).contains(&it.column)
                                && self.inputs(link).iter().all(|it| sources[it.0 as usize])
                        });
                        flaws.push((Flaw::Bypassed, it.range(), wire.map(Placed::range)));
                    }
                }
            }
        }
    }

    /// Whether it is a block whose pins are not those of a standard block: that of a DFB, which PL7-2 does not have.
    fn is_dfb(&self, it: &Placed<'_>) -> bool {
        self.layout == Layout::Pl7 && it.is_block() && self.layout.block_of(it.cell).is_none()
    }

    /// Beyond all controllers' limits the rung is wrong anyway.
    fn is_beyond_reason(&self) -> bool {
        let cells: u32 = self.placed.iter().map(|it| it.width).sum();
        cells > 2 * self.layout.most_lines() * self.layout.most_cells()
    }

    fn links_left_of(&self, wire: usize) -> impl Iterator<Item = &Placed<'t>> {
        self.left.of(wire).iter().map(|&it| &self.placed[it as usize]).filter(|it| it.is_link())
    }

    /// Whether all power of an element comes through one of the wires.
    fn comes_from(&self, element: u32, wires: &[bool]) -> bool {
        let mut seen = vec![false; self.placed.len()];
        let mut open = vec![element];
        while let Some(at) = open.pop() {
            if std::mem::replace(&mut seen[at as usize], true) {
                continue;
            }
            let it = &self.placed[at as usize];
            // The output of a block is a value of its own.
            if it.is_block() || it.element.is_none() {
                return false;
            }
            for wire in self.inputs(it).iter().filter(|it| !wires[it.0 as usize]) {
                let left = self.left.of(wire.0 as usize);
                if *wire == Wire::RAIL || left.is_empty() {
                    return false;
                }
                open.extend(left);
            }
        }
        true
    }
}

struct Order<'g, 't> {
    grid: &'g Grid<'t>,
    wire_seen: Vec<bool>,
    placed_seen: Vec<bool>,
    /// A stack of its own, for a row may be as long as the text.
    tasks: Vec<Task>,
    out: Vec<usize>,
}

enum Task {
    Enter(usize),
    Leave(usize),
}

impl Order<'_, '_> {
    /// Emits an element behind all on its left.
    fn visit(&mut self, element: usize) {
        self.tasks.push(Task::Enter(element));
        while let Some(task) = self.tasks.pop() {
            match task {
                Task::Leave(it) => self.out.push(it),
                Task::Enter(it) => {
                    if std::mem::replace(&mut self.placed_seen[it], true) {
                        continue;
                    }
                    self.tasks.push(Task::Leave(it));
                    for wire in self.grid.inputs.of(it).iter().rev() {
                        if !std::mem::replace(&mut self.wire_seen[wire.0 as usize], true) {
                            let left = self.grid.left.of(wire.0 as usize);
                            self.tasks.extend(left.iter().rev().map(|it| Task::Enter(*it as usize)));
                        }
                    }
                }
            }
        }
    }
}

struct WireNames {
    of_root: Vec<Option<Wire>>,
    count: u32,
}

impl WireNames {
    fn name(&mut self, root: usize) -> Wire {
        *self.of_root[root].get_or_insert_with(|| {
            self.count += 1;
            Wire(self.count - 1)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::syntax::pl7::ast::Root;

    /// Runs a check on the grid of the rows.
    fn with<T>(rows: &str, check: impl FnOnce(&Grid<'_>) -> T) -> T {
        let parse = crate::syntax::pl7::parse_ld(&format!("RUNG\n{rows}\nEND_RUNG"));
        assert_eq!(parse.errors(), [], "{rows}");
        let rung = Root::cast(parse.syntax()).and_then(|it| it.rungs().next()).expect("a rung");
        check(&Grid::new(rung, Layout::Pl7))
    }

    /// Operands of each connected network in the order of evaluation.
    fn order(rows: &str) -> Vec<String> {
        with(rows, |grid| {
            let name = |it: &usize| grid.placed[*it].cell.operand().map(|it| it.syntax().text().into_owned());
            let text = |it: &Vec<usize>| {
                let tests = it.iter().filter(|it| !grid.placed[**it].is_link());
                tests.filter_map(name).collect::<Vec<_>>().join(" ")
            };
            grid.networks().iter().map(text).collect()
        })
    }

    fn flaws(rows: &str) -> Vec<Flaw> {
        with(rows, |grid| grid.flaws().into_iter().map(|it| it.0).collect())
    }

    #[test]
    fn branches_are_evaluated_where_they_join() {
        // PL7:2886-2895: A, B, C; then D; then E; then F and G; then the coil H.
        let rows = "OPEN_CONTACT(A),OPEN_CONTACT(B),OPEN_CONTACT(C),SHORT_CIRCUIT,OPEN_CONTACT(E),SHORT_CIRCUIT(5),COIL(H);\n\
                    OPEN_CONTACT(D),H_LINK(3),EMPTY_CELL(5),V_LINK,EMPTY_CELL;\n\
                    OPEN_CONTACT(F),OPEN_CONTACT(G),H_LINK(8),EMPTY_CELL;";
        assert_eq!(order(rows), ["A B C D E F G H"]);
        assert_eq!(flaws(rows), []);
    }

    #[test]
    fn networks_that_no_link_joins_are_apart() {
        let rows = "OPEN_CONTACT(A),H_LINK(9),COIL(X);\nEMPTY_LINE;\n\
                    OPEN_CONTACT(B),SHORT_CIRCUIT,H_LINK(8),COIL(Y);\nOPEN_CONTACT(C),H_LINK,EMPTY_CELL(9);";
        assert_eq!(order(rows), ["A X", "B C Y"]);
        // The rails join nothing.
        assert_eq!(order("OPEN_CONTACT(A),H_LINK(9),COIL(X);\nOPEN_CONTACT(B),H_LINK(9),COIL(Y);"), ["A X", "B Y"]);
    }

    #[test]
    fn blocks_have_a_wire_for_each_pin() {
        let rows =
            "P_CONTACT(R),BLOCK(%C8),EMPTY_CELL(7);\nEMPTY_CELL(4),H_LINK(6),COIL(D);\nOPEN_CONTACT(U),EMPTY_CELL(10);";
        assert_eq!(order(rows), ["R U %C8 D"]);
        with(rows, |grid| {
            let block = grid.placed.iter().find(|it| it.is_block()).expect("a block");
            let fed: Vec<bool> = grid.inputs(block).iter().map(|it| grid.is_fed(*it)).collect();
            let used: Vec<bool> = grid.outputs(block).iter().map(|it| grid.is_used(*it)).collect();
            assert_eq!((fed, used), (vec![true, false, true], vec![false, true, false]));
        });
        assert_eq!(flaws(rows), []);
        // What stands in a row below ends the block.
        let rows = "OPEN_CONTACT(R),BLOCK(%C8),EMPTY_CELL(7);\nOPEN_CONTACT(A),H_LINK(9),COIL(X);";
        assert_eq!(with(rows, |grid| grid.inputs(&grid.placed[1]).len()), 1);
    }

    #[test]
    fn links_are_parted_where_vertical_ones_meet_them() {
        let rows = "OPEN_CONTACT(A),H_LINK,SHORT_CIRCUIT,H_LINK(7),COIL(X);\nOPEN_CONTACT(B),H_LINK(9),COIL(Y);\n\
                    OPEN_CONTACT(C),H_LINK(9),COIL(Z);";
        with(rows, |grid| {
            let links = |row: u32| -> Vec<(u32, u32)> {
                let links = grid.placed.iter().filter(|it| it.row == row && it.is_link());
                links.map(|it| (it.column, it.width)).collect()
            };
            assert_eq!(links(0), [(1, 1), (2, 1), (3, 7)]);
            assert_eq!(links(1), [(1, 2), (3, 7)]);
            assert_eq!(links(2), [(1, 9)]);
        });
        assert_eq!(order(rows), ["A B X Y", "C Z"]);
        assert_eq!(flaws(rows), []);
    }

    #[test]
    fn flaws_of_lines() {
        assert_eq!(flaws("OPEN_CONTACT(A),H_LINK(9),COIL(X);"), []);
        assert_eq!(flaws("OPEN_CONTACT(A),H_LINK(8),COIL(X),EMPTY_CELL;"), [Flaw::ActionInTestZone(10)]);
        assert_eq!(flaws("H_LINK(10),OPEN_CONTACT(A);"), [Flaw::TestInActionZone(11)]);
        assert_eq!(flaws("EMPTY_CELL,OPEN_CONTACT(A),H_LINK(8),COIL(X);"), [Flaw::NotFed]);
        assert_eq!(flaws("EMPTY_CELL,H_LINK(3),EMPTY_CELL(7);"), [Flaw::NotFed]);
        assert_eq!(flaws("OPEN_CONTACT(A),H_LINK(3),EMPTY_CELL(7);"), [Flaw::LeadsNowhere]);
        assert_eq!(flaws("OPEN_CONTACT(A),SHORT_CIRCUIT(9),COIL(X);"), [Flaw::OpenLink]);
        assert_eq!(flaws("OPEN_CONTACT(A),SHORT_CIRCUIT(3),EMPTY_CELL(7);"), [Flaw::OpenLink], "one mistake");
        assert_eq!(flaws("V_LINK,EMPTY_CELL(10);\nH_LINK(10),COIL(X);"), [Flaw::OpenLink]);
        assert_eq!(flaws("EMPTY_CELL(2),BLOCK(%TM0),EMPTY_CELL(7);"), [Flaw::BlockNotFed]);
        assert_eq!(flaws("EMPTY_CELL(7),OPERATE %MW0:=1 END_BLOCK;"), [Flaw::BlockNotFed]);
    }

    #[test]
    fn wires_that_go_round() {
        let bypassed = |rows: &str| flaws(rows).contains(&Flaw::Bypassed);
        assert!(bypassed("OPEN_CONTACT(A),SHORT_CIRCUIT,H_LINK(8),COIL(X);\nH_LINK(2),EMPTY_CELL(9);"));
        assert!(bypassed(
            "SHORT_CIRCUIT,OPEN_CONTACT(A),SHORT_CIRCUIT,H_LINK(7),COIL(X);\nEMPTY_CELL,H_LINK(2),EMPTY_CELL(8);"
        ));
        // The branch holds a contact too.
        assert!(!bypassed("OPEN_CONTACT(A),SHORT_CIRCUIT,H_LINK(8),COIL(X);\nH_LINK,OPEN_CONTACT(B),EMPTY_CELL(9);"));
        // Another line takes what the contact lets through.
        assert!(!bypassed(
            "OPEN_CONTACT(A),SHORT_CIRCUIT,OPEN_CONTACT(B),H_LINK(7),COIL(X);\nEMPTY_CELL(2),H_LINK(8),COIL(Y);"
        ));
    }

    #[test]
    fn numbers_beyond_reason_take_no_memory() {
        let rows =
            "H_LINK(4294967295),EMPTY_CELL(99999999999),COIL(X);\nEMPTY_LINE(4294967295);\nOPEN_CONTACT(A),COIL(Y);";
        with(rows, |grid| assert!(grid.rows.len() < 64 && grid.placed.len() < 64));
    }
}
