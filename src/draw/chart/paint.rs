//! Charts in the manuals' shapes (PL7:4181-4199, 4813; GRF:132): a step is a square, an initial step a double one, a
//! macro-step has two horizontal lines, a transition is a bar, what is done together parts and meets at double bars.

use super::{Item, ItemKind, Page, Picture};
use crate::draw::route::{self, Bar, Line, Metrics, Node, Routed};
use crate::draw::scene::{Anchor, Fill, Group, Point, Rect, Scene, Stroke, Style, Tags, clean, cut, wrap};
use crate::draw::{Mark, heading};
use crate::model::chart::StepKind;

const METRICS: Metrics = Metrics { gap: 18, track: 12, lane: 12, gutter: 22, pitch: 60, overhang: 12 };
const MARGIN: i32 = 24;
/// Height of the square of a step.
const STEP: i32 = 40;
/// Half the bar of a transition.
const HALF_BAR: i32 = 14;
/// Columns and lines of code beside a step or transition.
const CODE_COLUMNS: usize = 34;
const CODE_LINES: usize = 8;
/// Height of what says where lines come from that are not drawn.
const ENTRY: i32 = 18;
const CONNECTOR: i32 = 32;

pub(super) fn scene(picture: &Picture) -> Scene {
    let mut scene = Scene { role: "Grafcet chart", title: picture.title.clone(), ..Scene::default() };
    let mut y = heading(&mut scene, &picture.marks, MARGIN);
    let is_paged = picture.pages.iter().any(|it| it.number.is_some());
    for page in &picture.pages {
        let mut group = Group::default();
        if let (Some(number), true) = (page.number, is_paged) {
            group.text(Style::Name, Anchor::Start, Point::new(MARGIN, y + 13), format!("Page {number}"));
            y += 24;
        }
        for it in &page.comments {
            y = group.lines(Style::Comment, Anchor::Start, MARGIN, y, &wrap(&clean(it), 100, 4)) + 4;
        }
        if !group.shapes.is_empty() {
            scene.groups.push(group);
        }
        let views: Vec<View<'_>> = page.items.iter().map(View::new).collect();
        let routed = layout(page, &views);
        paint(page, &views, &routed, Point::new(MARGIN, y), &mut scene);
        scene.width = scene.width.max(routed.width + 2 * MARGIN);
        y += routed.height + MARGIN;
    }
    scene.height = y;
    scene
}

/// Positions of a page's items, and the lines between them.
pub(super) fn layout(page: &Page, views: &[View<'_>]) -> Routed {
    let nodes: Vec<Node> = page
        .items
        .iter()
        .zip(views)
        .map(|(item, view)| {
            let (column, row) = item.cell.unwrap_or_default();
            Node { column, row, left: view.left, right: view.right, height: view.height, port: view.port }
        })
        .collect();
    route::route(&nodes, &page.arcs, &METRICS)
}

/// An item with its texts broken into lines, and its size.
pub(super) struct View<'a> {
    item: &'a Item,
    tags: Tags,
    /// Of each action, or of the receptivity.
    codes: Vec<Vec<String>>,
    comment: String,
    /// Height of what stands above the square of a step.
    top: i32,
    half: i32,
    left: i32,
    right: i32,
    height: i32,
    port: i32,
}

fn code_lines(text: &str) -> Vec<String> {
    let lines: Vec<String> = text.lines().map(clean).collect();
    wrap(&lines.join("\n"), CODE_COLUMNS, CODE_LINES)
}

fn size(count: usize) -> i32 {
    i32::try_from(count).unwrap_or(i32::MAX / 4096)
}

fn widest(lines: &[String], style: Style) -> i32 {
    lines.iter().map(|it| style.width(it)).max().unwrap_or(0)
}

impl<'a> View<'a> {
    pub fn new(item: &'a Item) -> Self {
        let marks: Vec<&Mark> = item.marks.iter().collect();
        let comment = item.comment.as_deref().map_or_else(String::new, |it| cut(&clean(it), CODE_COLUMNS));
        let mut view = Self {
            item,
            tags: Tags::new(&marks),
            codes: Vec::new(),
            comment,
            top: 0,
            half: STEP / 2,
            left: 0,
            right: 0,
            height: 0,
            port: 0,
        };
        match &item.kind {
            ItemKind::Step { name, actions, .. } => {
                view.codes = actions.iter().map(|it| code_lines(&it.text)).collect();
                view.measure_step(name);
            }
            ItemKind::Transition { name, receptivity } => {
                let text = receptivity.as_deref().unwrap_or("not programmed");
                view.codes = vec![code_lines(text)];
                view.measure_transition(name);
            }
            ItemKind::Origin(..) | ItemKind::Destination(..) => {
                let width = Style::Name.width(&view.connector_text()) / 2 + 4;
                (view.left, view.right) = (width + view.tags.width() + 4, width);
                view.height = CONNECTOR.max(view.tags.height());
                view.port = view.height;
            }
            ItemKind::Comment(text) => {
                view.codes = vec![wrap(&clean(text), 24, 6)];
                view.right = view.codes.iter().map(|it| widest(it, Style::Comment)).max().unwrap_or(0) + 8;
                view.height = view.codes.iter().map(|it| size(it.len()) * Style::Comment.line()).sum::<i32>();
                view.port = view.height;
            }
        }
        view
    }

    fn measure_step(&mut self, name: &str) {
        self.half = (Style::Name.width(&shown_name(name)) / 2 + 10).max(STEP / 2);
        self.top = if self.item.entries.is_empty() { 0 } else { ENTRY };
        let entries = if self.top > 0 { Style::Small.width(&self.entry_text()) + 26 } else { 0 };
        self.left = (self.half + self.tags.width() + 8 * i32::from(self.tags.width() > 0)).max(entries);
        let code = self.codes.iter().map(|it| widest(it, Style::Code)).max();
        let code = code.map_or(0, |it| it + QUALIFIER + 12);
        let beside = code.max(Style::Comment.width(&self.comment));
        self.right = self.half + if beside > 0 { beside + 18 } else { 0 };
        let actions: i32 = self.codes.iter().map(|it| action_height(it)).sum();
        let comment = if self.comment.is_empty() { 0 } else { Style::Comment.line() };
        self.height = self.top + STEP.max(actions + comment).max(self.tags.height());
        self.port = self.top + STEP;
    }

    fn measure_transition(&mut self, name: &str) {
        let label = Style::Small.width(&cut(name, 14));
        self.left = HALF_BAR + label.max(self.tags.width()) + 6;
        let code = self.codes.iter().map(|it| widest(it, Style::Code)).max().unwrap_or(0);
        let comment = Style::Comment.width(&self.comment);
        self.right = HALF_BAR + 8 + code.max(comment);
        let lines: i32 = self.codes.iter().map(|it| size(it.len()) * Style::Code.line()).sum();
        let comment = if self.comment.is_empty() { 0 } else { Style::Comment.line() };
        // The label stands above the bar, the tags below it.
        self.height = (lines + comment).max(20).max(2 * self.tags.height() + 4);
        self.port = self.height;
    }

    fn entry_text(&self) -> String {
        const MOST: usize = 4;
        let mut text = self.item.entries.iter().take(MOST).map(|it| cut(&clean(it), 12)).collect::<Vec<_>>().join(" ");
        if self.item.entries.len() > MOST {
            text.push_str(" …");
        }
        text
    }

    fn connector_text(&self) -> String {
        match &self.item.kind {
            ItemKind::Origin(name, page) | ItemKind::Destination(name, page) => {
                let page = page.map_or_else(String::new, |it| format!(" (page {it})"));
                format!("{}{page}", shown_name(name))
            }
            _ => String::new(),
        }
    }

    /// What the item is, in words.
    fn subject(&self) -> String {
        match &self.item.kind {
            ItemKind::Step { kind, name, .. } => {
                let kind = match kind {
                    StepKind::Initial => "Initial step",
                    StepKind::Macro => "Macro-step",
                    StepKind::Simple | StepKind::In | StepKind::Out => "Step",
                };
                let comment = self.item.comment.as_deref().map_or_else(String::new, |it| format!(": {it}"));
                format!("{kind} {name}{comment}")
            }
            ItemKind::Transition { name, receptivity } => {
                format!("Transition {name}: {}", receptivity.as_deref().unwrap_or("not programmed, always false"))
            }
            ItemKind::Origin(name, _) => format!("From step {name}"),
            ItemKind::Destination(name, _) => format!("To step {name}"),
            ItemKind::Comment(text) => text.clone(),
        }
    }
}

/// Width of the part of an action that says when it runs.
const QUALIFIER: i32 = 26;

fn action_height(lines: &[String]) -> i32 {
    (size(lines.len()) * Style::Code.line() + 6).max(22)
}

fn shown_name(name: &str) -> String {
    cut(&clean(name), 24)
}

fn paint(page: &Page, views: &[View<'_>], routed: &Routed, origin: Point, scene: &mut Scene) {
    let at = |it: Point| it.moved(origin.x, origin.y);
    let mut links = Group::default();
    for line in &routed.lines {
        paint_line(line, page, routed, &mut links, origin);
    }
    for bar in &routed.bars {
        paint_bar(bar, page, views, routed, &mut links, origin);
    }
    if !links.shapes.is_empty() {
        scene.groups.push(links);
    }
    for (view, place) in views.iter().zip(&routed.places) {
        let mut group = Group::default();
        group.mark(view.subject(), &view.item.marks.iter().collect::<Vec<_>>());
        let place = at(*place);
        match &view.item.kind {
            ItemKind::Step { kind, name, actions } => {
                let qualifiers: Vec<&str> = actions.iter().map(|it| it.qualifier.as_str()).collect();
                paint_step(view, *kind, &shown_name(name), &qualifiers, place, &mut group);
            }
            ItemKind::Transition { name, receptivity } => {
                paint_transition(view, &cut(name, 14), receptivity.is_none(), place, &mut group);
            }
            ItemKind::Origin(..) => {
                group.centred(Style::Name, place.moved(0, 8), view.connector_text());
                group.line(Stroke::Link, [place.moved(0, 16), place.moved(0, view.height)]);
                group.head(place.moved(0, 16), place.moved(0, view.height - 4));
                group.tags(&view.tags, Anchor::End, place.x - (view.right + 2), place.y + view.height / 2);
            }
            ItemKind::Destination(..) => {
                group.line(Stroke::Link, [place, place.moved(0, 14)]);
                group.head(place, place.moved(0, 16));
                group.centred(Style::Name, place.moved(0, 24), view.connector_text());
                group.tags(&view.tags, Anchor::End, place.x - (view.right + 2), place.y + view.height / 2);
            }
            ItemKind::Comment(_) => {
                for lines in &view.codes {
                    group.lines(Style::Comment, Anchor::Start, place.x, place.y, lines);
                }
            }
        }
        scene.groups.push(group);
    }
}

/// Whether what parts or meets at an item runs together, and is drawn with double bars.
fn is_double(page: &Page, item: usize) -> bool {
    matches!(page.items.get(item).map(|it| &it.kind), Some(ItemKind::Transition { .. }))
}

/// Half the distance of the lines of a double bar.
const DOUBLE: i32 = 2;

fn paint_line(line: &Line, page: &Page, routed: &Routed, group: &mut Group, origin: Point) {
    let mut points: Vec<Point> = line.points[line.own.0..=line.own.1].to_vec();
    // A line ends at the near edge of a double bar.
    let has_bar = |node: usize, is_below: bool| {
        let found = routed.bars.binary_search_by_key(&(node, is_below), |it| (it.node, it.is_below));
        found.is_ok() && is_double(page, node)
    };
    let last = points.len() - 1;
    if last > 0 {
        let (first, second) = (points[0], points[1]);
        if line.own.0 > 0 && has_bar(line.from, true) && first.x == second.x {
            points[0].y += DOUBLE * (second.y - first.y).signum();
        }
        let (before, end) = (points[last - 1], points[last]);
        if line.own.1 + 1 < line.points.len() && has_bar(line.to, false) && before.x == end.x {
            points[last].y += DOUBLE * (before.y - end.y).signum();
        }
    }
    let points: Vec<Point> = points.into_iter().map(|it| it.moved(origin.x, origin.y)).collect();
    if line.is_back {
        // The arrow stands on the longest part that runs upwards (PL7: directed links upwards).
        let up = points.windows(2).filter(|it| it[1].y < it[0].y && it[0].x == it[1].x);
        if let Some(up) = up.max_by_key(|it| it[0].y - it[1].y) {
            let middle = Point::new(up[0].x, (up[0].y + up[1].y) / 2);
            group.head(up[0], middle);
        }
    }
    group.line(Stroke::Link, points);
}

fn paint_bar(bar: &Bar, page: &Page, views: &[View<'_>], routed: &Routed, group: &mut Group, origin: Point) {
    let place = routed.places[bar.node];
    let edge = if bar.is_below { place.y + views[bar.node].port } else { place.y };
    let is_double = is_double(page, bar.node);
    let near = if is_double { DOUBLE * (edge - bar.y).signum() } else { 0 };
    let at = |x: i32, y: i32| Point::new(x, y).moved(origin.x, origin.y);
    group.line(Stroke::Link, [at(place.x, edge), at(place.x, bar.y + near)]);
    if is_double {
        for y in [bar.y - DOUBLE, bar.y + DOUBLE] {
            group.line(Stroke::Link, [at(bar.from, y), at(bar.to, y)]);
        }
    } else {
        // A single bar ends at its outermost lines.
        group.line(Stroke::Link, [at(bar.from + METRICS.overhang, bar.y), at(bar.to - METRICS.overhang, bar.y)]);
    }
}

fn paint_step(view: &View<'_>, kind: StepKind, name: &str, qualifiers: &[&str], place: Point, group: &mut Group) {
    let square = Rect::new(place.x - view.half, place.y + view.top, 2 * view.half, STEP);
    if view.top > 0 {
        group.line(Stroke::Link, [place, place.moved(0, view.top)]);
        group.line(Stroke::Link, [place.moved(-20, 9), place.moved(0, 9)]);
        group.head(place.moved(-20, 9), place.moved(-1, 9));
        group.text(Style::Small, Anchor::End, place.moved(-23, 12), view.entry_text());
    }
    group.area(Fill::Paper, square);
    match kind {
        StepKind::Initial => group.area(Fill::None, square.inner(4)),
        StepKind::Macro => {
            for y in [square.y + 5, square.bottom() - 5] {
                group.line(Stroke::Link, [Point::new(square.x, y), Point::new(square.right(), y)]);
            }
        }
        StepKind::Simple | StepKind::In | StepKind::Out => {}
    }
    group.centred(Style::Name, Point::new(place.x, square.y + STEP / 2), name);
    group.tags(&view.tags, Anchor::End, square.x - 4, square.y + STEP / 2);
    let x = square.right() + 14;
    let mut y = square.y;
    if !view.comment.is_empty() {
        y = group.lines(Style::Comment, Anchor::Start, x, y, std::slice::from_ref(&view.comment));
    }
    let middle = square.y + STEP / 2;
    if !view.codes.is_empty() {
        group.line(Stroke::Link, [Point::new(square.right(), middle), Point::new(x, middle)]);
    }
    for (lines, qualifier) in view.codes.iter().zip(qualifiers) {
        let height = action_height(lines);
        let width = view.right - view.half - 14;
        group.area(Fill::Paper, Rect::new(x, y, width, height));
        group.line(Stroke::Link, [Point::new(x + QUALIFIER, y), Point::new(x + QUALIFIER, y + height)]);
        group.centred(Style::Code, Point::new(x + QUALIFIER / 2, y + height / 2), *qualifier);
        let text = size(lines.len()) * Style::Code.line();
        group.lines(Style::Code, Anchor::Start, x + QUALIFIER + 6, y + (height - text) / 2, lines);
        y += height;
    }
}

fn paint_transition(view: &View<'_>, name: &str, is_missing: bool, place: Point, group: &mut Group) {
    let y = place.y + view.height / 2;
    group.line(Stroke::Link, [place, place.moved(0, view.height)]);
    group.line(Stroke::Heavy, [Point::new(place.x - HALF_BAR, y), Point::new(place.x + HALF_BAR, y)]);
    let x = place.x - HALF_BAR - 5;
    let has_tags = view.tags.height() > 0;
    group.text(Style::Small, Anchor::End, Point::new(x, if has_tags { y - 3 } else { y + 4 }), name);
    group.tags(&view.tags, Anchor::End, x, y + 3 + view.tags.height() / 2);
    let x = place.x + HALF_BAR + 7;
    let comment = if view.comment.is_empty() { 0 } else { Style::Comment.line() };
    let lines: i32 = view.codes.iter().map(|it| size(it.len()) * Style::Code.line()).sum();
    let mut top = y - (lines + comment) / 2;
    if comment > 0 {
        top = group.lines(Style::Comment, Anchor::Start, x, top, std::slice::from_ref(&view.comment));
    }
    let style = if is_missing { Style::Comment } else { Style::Code };
    for lines in &view.codes {
        top = group.lines(style, Anchor::Start, x, top, lines);
    }
}
