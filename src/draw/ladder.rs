//! Rungs of ladder, as the screens of the programming tools show them (PL7:2700-2767): power rails on both sides, contacts
//! in the columns of tests, coils in the last one.

use super::scene::{Anchor, Fill, Group, Point, Rect, Scene, Shape, Stroke, Style, Tags, clean, cut, wrap};
use super::{Mark, Unit, heading, words};
use crate::analysis::program::ProgramIndex;
use crate::model::dfb::Interface;
use crate::model::ladder::{Grid, Layout, Placed, Row, Wire};
use crate::model::unit::Slot;
use crate::syntax::pl7::ast;
use crate::syntax::pl7::chart::ast as chart;
use crate::syntax::pl7::ladder_words::Element;
use crate::syntax::{AstNode as _, Language, SyntaxKind};

/// The rungs of a unit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Picture {
    pub title: String,
    columns: u32,
    rungs: Vec<Rung>,
    /// Findings about no rung.
    marks: Vec<Mark>,
}

#[derive(Debug, Clone, PartialEq, Eq)]
struct Rung {
    /// The action or receptivity that it is part of, where it begins one.
    owner: Option<String>,
    label: String,
    comment: String,
    rows: u32,
    cells: Vec<Cell>,
    /// Rows whose point at the left edge of a column is joined with the one below.
    vertical: Vec<(u32, u32)>,
    /// Findings about no cell.
    marks: Vec<Mark>,
}

#[derive(Debug, Clone, PartialEq, Eq)]
struct Cell {
    row: u32,
    column: u32,
    width: u32,
    rows: u32,
    element: Option<Element>,
    /// The operand, the code of a block.
    text: String,
    /// Names of inputs and outputs, one a row.
    pins: [Vec<String>; 2],
    marks: Vec<Mark>,
}

/// The rungs of a unit, those of its actions and receptivities included; `None` if it has none.
pub(super) fn picture(unit: &Unit<'_>, index: &ProgramIndex<'_>) -> Option<Picture> {
    let is_ladder = matches!(unit.language, Language::Pl7Ld | Language::Pl72Ld) || unit.language.is_chart();
    if !is_ladder && !unit.tree.descendants().any(|it| it.kind() == SyntaxKind::Rung) {
        return None;
    }
    let layout = Layout::of(unit.language);
    let mut picture = Picture {
        title: unit.model.entity.to_string(),
        columns: layout.columns(),
        rungs: Vec::new(),
        marks: Vec::new(),
    };
    let mut owner = None;
    let mut step = String::new();
    let mut ranges = Vec::new();
    for node in unit.tree.descendants() {
        if let Some(it) = chart::ChartStep::cast(node) {
            step = it.name().map(chart::StepName::text).unwrap_or_default();
        } else if let Some(it) = chart::ChartAction::cast(node) {
            let name = it.name().map_or_else(|| format!("step {step}"), |it| it.text().to_owned());
            owner = Some(format!("Action of {name}"));
        } else if let Some(it) = chart::Transition::cast(node) {
            owner = Some(receptivity(unit, it));
        } else if let Some(it) = ast::Rung::cast(node) {
            ranges.push(node.text_range());
            picture.rungs.push(rung(it, layout, owner.take(), index));
        }
    }
    if picture.rungs.is_empty() {
        return None;
    }
    mark(unit, &ranges, &mut picture);
    Some(picture)
}

/// What a transition's code is called.
fn receptivity(unit: &Unit<'_>, it: chart::Transition<'_>) -> String {
    let keyword = it.keyword().map(|it| it.text_range());
    let chart = unit.model.chart.as_deref();
    // Transitions stand in the order of the text.
    let transition = chart.zip(keyword).and_then(|(chart, range)| {
        let at = chart.transitions.binary_search_by_key(&range.start(), |it| it.range.start()).ok()?;
        Some((chart, chart.transitions.get(at)?))
    });
    let Some((chart, it)) = transition else { return "Receptivity".to_owned() };
    let names = |nodes: &[crate::model::chart::Node]| {
        let names: Vec<String> = nodes.iter().filter_map(|it| Some(chart.name_of(it)?.to_string())).collect();
        names.join(",")
    };
    format!("Receptivity {}→{}", names(&it.sources), names(&it.targets))
}

fn rung(it: ast::Rung<'_>, layout: Layout, owner: Option<String>, index: &ProgramIndex<'_>) -> Rung {
    let grid = Grid::new(it, layout);
    let label = it.label().and_then(ast::LabelDef::token).map_or_else(String::new, |it| it.text().to_owned());
    let comment = words::own_comment(it.syntax()).unwrap_or_default().to_owned();
    let cells: Vec<Cell> = grid.placed.iter().map(|it| cell(it, &grid, index)).collect();
    let last = cells.iter().map(|it| it.row + it.rows).max().unwrap_or(0);
    Rung {
        owner,
        label,
        comment,
        rows: Row::used(&grid.rows).max(last).max(1),
        cells,
        vertical: grid.vertical.clone(),
        marks: Vec::new(),
    }
}

fn cell(it: &Placed<'_>, grid: &Grid<'_>, index: &ProgramIndex<'_>) -> Cell {
    let mut pins = [Vec::new(), Vec::new()];
    let mut rows = 1;
    let operand = it.cell.operand().map(|it| words::code(it.syntax()));
    let text = match it.element {
        Some(Element::Jump) => it.cell.label().map(|it| it.text().to_owned()),
        Some(Element::Call) => it.cell.subroutine().map(|it| it.0.text().to_owned()),
        Some(Element::Compare) => it.cell.comparison().map(|it| words::code(it.syntax())),
        Some(Element::Operate) => {
            let statements = it.cell.operations().map(|it| words::code(it.syntax()));
            Some(statements.collect::<Vec<_>>().join("\n"))
        }
        Some(Element::Block) => {
            let block = grid.layout.block_of(it.cell);
            let height = grid.inputs(it).len();
            let interface = operand.as_deref().and_then(|it| index.dfb_of(it)).map(|it| it.1);
            match (block, interface) {
                (Some(block), _) => {
                    pins = [
                        block.inputs().map(str::to_owned).collect(),
                        block.outputs().iter().map(|it| (*it).to_owned()).collect(),
                    ];
                }
                (None, Some(interface)) => pins = dfb_pins(interface, height),
                (None, None) => {
                    let is_given = |it: &Wire| grid.is_fed(*it) || grid.input_actual(*it).is_some();
                    let is_taken = |it: &Wire| grid.is_used(*it) || grid.output_actual(*it).is_some();
                    let is_wired = |row: usize| {
                        grid.inputs(it).get(row).is_some_and(is_given)
                            || grid.outputs(it).get(row).is_some_and(is_taken)
                    };
                    rows = (0..height).rev().find(|it| is_wired(*it)).map_or(1, |it| it + 1);
                }
            }
            rows = rows.max(pins[0].len()).max(pins[1].len()).min(height.max(1));
            operand
        }
        Some(_) => operand,
        None => Some(words::code(it.cell.syntax())),
    };
    Cell {
        row: it.row,
        column: it.column,
        width: it.width,
        rows: u32::try_from(rows).unwrap_or(1),
        element: it.element,
        text: text.unwrap_or_default(),
        pins,
        marks: Vec::new(),
    }
}

/// Parameters of a DFB by side and row.
fn dfb_pins(interface: &Interface, rows: usize) -> [Vec<String>; 2] {
    [Slot::Left, Slot::Right].map(|side| {
        let rows = 0..u32::try_from(rows).unwrap_or(0);
        let mut names: Vec<String> =
            rows.map(|row| interface.parameter(side(row)).map_or_else(String::new, |it| it.name.to_string())).collect();
        names.truncate(names.iter().rposition(|it| !it.is_empty()).map_or(0, |it| it + 1));
        names
    })
}

/// Gives each rung and cell the findings that lie in it.
fn mark(unit: &Unit<'_>, ranges: &[rowan::TextRange], picture: &mut Picture) {
    if unit.marks.is_empty() {
        return;
    }
    let mut cells: Vec<Vec<rowan::TextRange>> = Vec::new();
    for node in unit.tree.descendants().filter_map(ast::Rung::cast) {
        let grid = Grid::new(node, Layout::of(unit.language));
        cells.push(grid.placed.iter().map(Placed::range).collect());
    }
    for (range, mark) in unit.marks {
        let at = ranges.partition_point(|it| it.start() <= range.start());
        let rung = at.checked_sub(1).filter(|it| ranges[*it].end() > range.start());
        let Some((rung, cells)) = rung.and_then(|it| picture.rungs.get_mut(it).zip(cells.get(it))) else {
            // What concerns a chart is marked in its own drawing.
            if !unit.language.is_chart() {
                picture.marks.push(mark.clone());
            }
            continue;
        };
        let before = cells.partition_point(|it| it.start() <= range.start());
        let cell = before.checked_sub(1).filter(|it| cells[*it].end() > range.start());
        match cell.and_then(|it| rung.cells.get_mut(it)) {
            Some(cell) => cell.marks.push(mark.clone()),
            None => rung.marks.push(mark.clone()),
        }
    }
}

const MARGIN: i32 = 24;
/// Least width of a column, and height of a row with one line of text over its wire.
const COLUMN: i32 = 66;
const ROW: i32 = 54;
/// From the top of a row to its wire.
const WIRE: i32 = 32;
/// Half the height and width of a contact.
const CONTACT: (i32, i32) = (9, 5);
/// Half the height of a coil.
const COIL: i32 = 9;
/// Columns of text over a contact or coil.
const OPERAND: usize = 20;
const BLOCK_LINES: usize = 12;

/// Places of columns and rows.
struct Places {
    columns: Vec<i32>,
    rows: Vec<i32>,
}

impl Places {
    fn x(&self, column: u32) -> i32 {
        let last = self.columns.last().copied().unwrap_or(0);
        self.columns.get(column as usize).copied().unwrap_or(last)
    }

    fn top(&self, row: u32) -> i32 {
        let last = self.rows.last().copied().unwrap_or(0);
        self.rows.get(row as usize).copied().unwrap_or(last)
    }

    fn wire(&self, row: u32) -> i32 {
        self.top(row) + WIRE
    }
}

impl Cell {
    /// Lines of a comparison or operation in a width of pixels.
    fn lines(&self, width: i32) -> Vec<String> {
        let columns = usize::try_from((width - 20) * 100 / (Style::Code.size() * 61)).unwrap_or(8).max(8);
        let text: Vec<String> = self.text.lines().map(clean).collect();
        wrap(&text.join("\n"), columns, BLOCK_LINES)
    }

    fn is_box(&self) -> bool {
        matches!(self.element, Some(Element::Compare | Element::Operate) | None)
    }

    fn is_plain_link(&self) -> bool {
        matches!(self.element, Some(Element::HLink | Element::ShortCircuit)) && self.marks.is_empty()
    }

    fn tags(&self) -> Tags {
        Tags::new(&self.marks.iter().collect::<Vec<_>>())
    }

    /// Least width of each of its columns.
    fn column_width(&self) -> i32 {
        let text = match self.element {
            Some(Element::HLink | Element::ShortCircuit | Element::Compare | Element::Operate) | None => 0,
            Some(Element::Return | Element::Halt) => Style::Code.width("<RETURN>") + 24,
            Some(Element::Block) => {
                let widest = |it: &[String]| it.iter().map(|it| Style::Small.width(&cut(it, 14))).max().unwrap_or(0);
                let pins = widest(&self.pins[0]) + widest(&self.pins[1]) + 40;
                pins.max(Style::Code.width(&cut(&clean(&self.text), OPERAND)) + 24)
            }
            Some(_) => Style::Code.width(&cut(&clean(&self.text), OPERAND)) + 12 + self.tags().width(),
        };
        let width = i32::try_from(self.width).unwrap_or(1).max(1);
        (text + width - 1) / width
    }
}

impl Picture {
    pub fn scene(&self) -> Scene {
        let mut scene = Scene { role: "Ladder diagram", title: self.title.clone(), ..Scene::default() };
        let mut y = heading(&mut scene, &self.marks, MARGIN);
        let all = || self.rungs.iter().flat_map(|it| &it.cells);
        let last = all().map(|it| it.column + it.width).max().unwrap_or(0).max(self.columns);
        let mut widths = vec![COLUMN; last as usize];
        for it in all() {
            for column in it.column..it.column + it.width {
                if let Some(width) = widths.get_mut(column as usize) {
                    *width = it.column_width().max(*width);
                }
            }
        }
        let mut columns = vec![MARGIN + 10];
        for width in widths {
            columns.push(columns.last().copied().unwrap_or(0) + width);
        }
        let right = columns.last().copied().unwrap_or(0);
        let mut places = Places { columns, rows: Vec::new() };
        for it in &self.rungs {
            y = it.paint(&mut places, y, &mut scene);
        }
        scene.width = scene.width.max(right + 10 + MARGIN);
        scene.height = y + MARGIN - 12;
        scene
    }
}

impl Rung {
    /// Returns where the next one begins.
    fn paint(&self, places: &mut Places, y: i32, scene: &mut Scene) -> i32 {
        let mut y = y;
        let mut head = Group::default();
        if let Some(owner) = &self.owner {
            head.text(Style::Name, Anchor::Start, Point::new(MARGIN, y + 13), cut(&clean(owner), 60));
            y += 24;
        }
        let tags = Tags::new(&self.marks.iter().collect::<Vec<_>>());
        let mut x = MARGIN;
        if !self.label.is_empty() {
            let label = format!("{}:", cut(&clean(&self.label), 16));
            let width = Style::Name.width(&label);
            head.text(Style::Name, Anchor::Start, Point::new(x, y + 13), label);
            x += width + 8;
        }
        if tags.width() > 0 {
            head.tags(&tags, Anchor::Start, x, y + tags.height() / 2);
            x += tags.width() + 8;
        }
        let comment = wrap(&clean(&self.comment), 90, 3);
        let below = head.lines(Style::Comment, Anchor::Start, x, y, &comment);
        let has_head = !self.label.is_empty() || tags.width() > 0 || !comment.is_empty();
        y = below.max(y + tags.height()).max(y + if has_head { Style::Name.line() } else { 0 }) + 4;
        if !self.marks.is_empty() {
            head.mark(self.subject(), &self.marks.iter().collect::<Vec<_>>());
        }
        // Rows as tall as what stands in them.
        let mut tall = vec![ROW; self.rows as usize];
        for it in self.cells.iter().filter(|it| it.element != Some(Element::Block)) {
            if let Some(tall) = tall.get_mut(it.row as usize) {
                *tall = (*tall).max(WIRE + 12 + it.tags().height() + 8);
            }
        }
        for it in self.cells.iter().filter(|it| it.is_box()) {
            let width = places.x(it.column + it.width) - places.x(it.column);
            let lines = i32::try_from(it.lines(width).len()).unwrap_or(0);
            if let Some(tall) = tall.get_mut(it.row as usize) {
                *tall = (*tall).max(WIRE - 12 + lines * Style::Code.line() + 14);
            }
        }
        places.rows = vec![y];
        for it in tall {
            y += it;
            places.rows.push(y);
        }
        if !head.shapes.is_empty() {
            scene.groups.push(head);
        }
        // Findings about the rung colour its heading alone.
        let mut frame = Group::default();
        let (top, right) = (places.top(0) + 6, places.x(u32::MAX));
        for x in [places.x(0), right] {
            frame.line(Stroke::Heavy, [Point::new(x, top), Point::new(x, y)]);
        }
        for &(row, column) in &self.vertical {
            let x = places.x(column);
            frame.line(Stroke::Link, [Point::new(x, places.wire(row)), Point::new(x, places.wire(row + 1))]);
        }
        // Links in a row are one line.
        let mut run: Option<(u32, u32, u32)> = None;
        let mut draw = |it: Option<(u32, u32, u32)>| {
            if let Some((row, from, to)) = it {
                let y = places.wire(row);
                frame.line(Stroke::Link, [Point::new(places.x(from), y), Point::new(places.x(to), y)]);
            }
        };
        for it in self.cells.iter().filter(|it| it.is_plain_link()) {
            run = match run {
                Some((row, from, to)) if row == it.row && to == it.column => Some((row, from, to + it.width)),
                before => {
                    draw(before);
                    Some((it.row, it.column, it.column + it.width))
                }
            };
        }
        draw(run);
        scene.groups.push(frame);
        scene.groups.extend(self.cells.iter().filter(|it| !it.is_plain_link()).map(|it| it.paint(places)));
        y + 22
    }

    fn subject(&self) -> String {
        match (&*self.label, &*self.comment) {
            ("", "") => "Rung".to_owned(),
            ("", comment) => format!("Rung: {comment}"),
            (label, "") => format!("Rung {label}"),
            (label, comment) => format!("Rung {label}: {comment}"),
        }
    }
}

/// What an element is called.
fn name(element: Option<Element>) -> &'static str {
    match element {
        Some(Element::Open) => "Normally open contact",
        Some(Element::Closed) => "Normally closed contact",
        Some(Element::Rising) => "Rising edge contact",
        Some(Element::Falling) => "Falling edge contact",
        Some(Element::Coil) => "Coil",
        Some(Element::NotCoil) => "Negated coil",
        Some(Element::SetCoil) => "Set coil",
        Some(Element::ResetCoil) => "Reset coil",
        Some(Element::SaveCoil) => "Saved coil",
        Some(Element::HashCoil) => "Transition coil",
        Some(Element::Jump) => "Jump",
        Some(Element::Call) => "Call",
        Some(Element::Return) => "Return",
        Some(Element::Halt) => "Halt",
        Some(Element::Compare) => "Comparison block",
        Some(Element::Operate) => "Operation block",
        Some(Element::Block) => "Function block",
        Some(Element::Actual) => "Effective parameter",
        Some(Element::HLink | Element::ShortCircuit | Element::VLink) => "Link",
        Some(Element::EmptyCell | Element::EmptyLine) => "Empty cell",
        None => "Not understood",
    }
}

impl Cell {
    fn paint(&self, places: &Places) -> Group {
        let mut group = Group::default();
        let (left, right, y) = (places.x(self.column), places.x(self.column + self.width), places.wire(self.row));
        let middle = Point::new((left + right) / 2, y);
        let wire = |group: &mut Group, from: i32, to: i32| {
            group.line(Stroke::Link, [Point::new(from, y), Point::new(to, y)]);
        };
        let subject = format!("{} {}", name(self.element), clean(&self.text));
        group.mark(subject.trim_end().to_owned(), &self.marks.iter().collect::<Vec<_>>());
        let operand = |group: &mut Group| {
            group.text(Style::Code, Anchor::Middle, middle.moved(0, -15), cut(&clean(&self.text), OPERAND));
        };
        match self.element {
            Some(Element::Open | Element::Closed | Element::Rising | Element::Falling) => {
                let (height, mut half) = CONTACT;
                if matches!(self.element, Some(Element::Rising | Element::Falling)) {
                    half += 3;
                }
                wire(&mut group, left, middle.x - half);
                wire(&mut group, middle.x + half, right);
                for x in [-half, half] {
                    group.line(Stroke::Link, [middle.moved(x, -height), middle.moved(x, height)]);
                }
                match self.element {
                    Some(Element::Closed) => {
                        group.line(Stroke::Link, [middle.moved(-half - 3, height), middle.moved(half + 3, -height)]);
                    }
                    Some(Element::Rising) => group.centred(Style::Code, middle, "P"),
                    Some(Element::Falling) => group.centred(Style::Code, middle, "N"),
                    _ => {}
                }
                operand(&mut group);
            }
            Some(
                Element::Coil
                | Element::NotCoil
                | Element::SetCoil
                | Element::ResetCoil
                | Element::SaveCoil
                | Element::HashCoil
                | Element::Call,
            ) => {
                let half = COIL + 2;
                wire(&mut group, left, middle.x - half);
                wire(&mut group, middle.x + half, right);
                let (x, radius) = (COIL - 3, 2 * COIL - 2);
                group.shapes.push(Shape::Arc { from: middle.moved(-x, COIL), to: middle.moved(-x, -COIL), radius });
                group.shapes.push(Shape::Arc { from: middle.moved(x, -COIL), to: middle.moved(x, COIL), radius });
                let letter = match self.element {
                    Some(Element::NotCoil) => "/",
                    Some(Element::SetCoil) => "S",
                    Some(Element::ResetCoil) => "R",
                    Some(Element::SaveCoil) => "M",
                    Some(Element::HashCoil) => "#",
                    Some(Element::Call) => "C",
                    _ => "",
                };
                group.centred(Style::Code, middle, letter);
                operand(&mut group);
            }
            Some(Element::Jump) => {
                let text = cut(&clean(&self.text), OPERAND);
                let half = (Style::Code.width(&text) + 22) / 2;
                let start = middle.x - half;
                wire(&mut group, left, start + 12);
                group.head(Point::new(left, y), Point::new(start + 10, y));
                group.head(Point::new(left, y), Point::new(start + 17, y));
                group.text(Style::Code, Anchor::Start, Point::new(start + 21, y + 4), text);
            }
            Some(Element::Return | Element::Halt) => {
                let text = if self.element == Some(Element::Halt) { "<HALT>" } else { "<RETURN>" };
                let half = Style::Code.width(text) / 2 + 3;
                wire(&mut group, left, middle.x - half);
                wire(&mut group, middle.x + half, right);
                group.centred(Style::Code, middle, text);
            }
            Some(Element::Compare | Element::Operate) | None => {
                let lines = self.lines(right - left);
                let height = i32::try_from(lines.len()).unwrap_or(0) * Style::Code.line();
                let area = Rect::new(left + 8, y - 12, right - left - 16, (height + 8).max(24));
                wire(&mut group, left, area.x);
                wire(&mut group, area.right(), right);
                group.area(if self.element.is_some() { Fill::Paper } else { Fill::Dashed }, area);
                group.lines(Style::Code, Anchor::Start, area.x + 5, area.y + 4, &lines);
            }
            Some(Element::Block) => self.paint_block(places, &mut group),
            Some(Element::Actual) => {
                group.centred(Style::Code, middle, cut(&clean(&self.text), OPERAND));
            }
            Some(Element::HLink | Element::ShortCircuit) => wire(&mut group, left, right),
            Some(Element::VLink | Element::EmptyCell | Element::EmptyLine) => {}
        }
        let tags = self.tags();
        let y = match self.element {
            Some(Element::Block) => places.top(self.row) + 2,
            _ => y + 13 + tags.height() / 2,
        };
        group.tags(&tags, Anchor::Start, middle.x - tags.width() / 2, y);
        group
    }

    fn paint_block(&self, places: &Places, group: &mut Group) {
        let (left, right) = (places.x(self.column), places.x(self.column + self.width));
        let bottom = places.wire(self.row + self.rows.max(1) - 1) + 16;
        let area = Rect::new(left + 12, places.top(self.row) + 8, right - left - 24, 0);
        let area = Rect { height: bottom - area.y, ..area };
        group.area(Fill::Paper, area);
        let name = cut(&clean(&self.text), OPERAND);
        group.text(Style::Name, Anchor::Middle, Point::new((left + right) / 2, area.y + 15), name);
        for row in 0..self.rows {
            let y = places.wire(self.row + row);
            let pin = |side: usize| self.pins[side].get(row as usize).map(|it| cut(&clean(it), 14));
            let is_known = self.pins.iter().any(|it| !it.is_empty());
            if !is_known || pin(0).is_some_and(|it| !it.is_empty()) {
                group.line(Stroke::Link, [Point::new(left, y), Point::new(area.x, y)]);
            }
            if !is_known || pin(1).is_some_and(|it| !it.is_empty()) {
                group.line(Stroke::Link, [Point::new(area.right(), y), Point::new(right, y)]);
            }
            group.text(Style::Small, Anchor::Start, Point::new(area.x + 4, y + 4), pin(0).unwrap_or_default());
            group.text(Style::Small, Anchor::End, Point::new(area.right() - 4, y + 4), pin(1).unwrap_or_default());
        }
    }
}
