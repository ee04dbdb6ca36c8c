//! The graph of calls: what the system runs on the left, what that calls to the right of it.

use rustc_hash::FxHashMap;
use smol_str::SmolStr;

use super::graph::{Graph, GraphArc, GraphNode, Look};
use super::route::{self, Metrics, Node};
use super::scene::{Anchor, Fill, Group, Point, Rect, Scene, Stroke, Style, Tags, clean, cut};
use super::{Mark, Unit, heading, layers};
use crate::analysis::program::ProgramIndex;
use crate::model::chart::{self, Graph as ChartGraph};
use crate::model::entity::{BlockKind, Entity, Part};
use crate::model::unit::Callee;
use crate::syntax::Language;

/// The graph of calls of a program; `None` where nothing calls anything.
pub(super) fn graph(name: &str, units: &[Unit<'_>], index: &ProgramIndex<'_>) -> Option<Graph> {
    let mut builder = Builder { graph: Graph::default(), node_of: FxHashMap::default(), arc_of: FxHashMap::default() };
    builder.graph.is_sideways = true;
    builder.graph.title = if name.is_empty() { "Calls".to_owned() } else { format!("Calls - {name}") };
    let mut nodes: Vec<Option<u32>> = Vec::with_capacity(units.len());
    for (at, unit) in (0..).zip(units) {
        let entity = &unit.model.entity;
        let is_data = entity.block_kind().is_some_and(BlockKind::is_data);
        let is_code = !matches!(entity, Entity::Container)
            && !unit.language.declares_symbols()
            && unit.language != Language::Pl7Xref
            && !is_data;
        let node = is_code.then(|| {
            let look = if index.is_entry(at) { Look::Entry } else { Look::Code };
            builder.node(label(entity), look)
        });
        if let Some(node) = node.and_then(|it| builder.graph.nodes.get_mut(it as usize)) {
            node.marks.extend(unit.marks.iter().map(|it| it.1.clone()));
        }
        nodes.push(node);
    }
    let node_at = |unit: u32| nodes.get(unit as usize).copied().flatten();
    for call in index.calls.iter().filter(|it| it.it.reachable) {
        let Some(from) = node_at(call.unit) else { continue };
        let instance = call.it.instance.as_ref().map_or_else(String::new, ToString::to_string);
        let (target, label) = match &call.it.callee {
            Callee::Function(_) | Callee::Unknown => continue,
            Callee::LocalInstance(name) => {
                let declared = index.units.get(call.unit as usize).map_or(&[][..], |it| &it.declared);
                let ty = declared.iter().find(|it| it.name.eq_ignore_ascii_case(name)).map(|it| it.ty.clone());
                (ty.map(|it| it.to_uppercase().into()), format!("#{name}"))
            }
            Callee::Instance(name) if call.target.is_some() => (None, name.to_string()),
            Callee::Subroutine(number) => (Some(SmolStr::from(format!("SR{number}"))), String::new()),
            Callee::Block(name) => (Some(SmolStr::from(name.to_string())), instance),
            Callee::Instance(name) => (Some(name.clone()), String::new()),
        };
        let to = match (call.target.and_then(node_at), target) {
            (Some(to), _) => to,
            (None, Some(name)) => builder.node(name.to_string(), Look::Absent),
            (None, None) => builder.node(label.clone(), Look::Absent),
        };
        builder.arc(from, to, label);
    }
    (!builder.graph.arcs.is_empty()).then_some(builder.graph)
}

/// What a unit is called here: all pages of a chart are one.
fn label(entity: &Entity) -> String {
    let Entity::Pl7 { task, section, part: Part::Chart(_) } = entity else { return entity.to_string() };
    let section = section.as_ref().map_or_else(String::new, |it| format!(" - {it}"));
    match chart::place(entity).map(|it| it.graph) {
        Some(ChartGraph::Macro(number)) => format!("{task}{section} - MACRO{number}"),
        _ => format!("{task}{section} - CHART"),
    }
}

struct Builder {
    graph: Graph,
    node_of: FxHashMap<String, u32>,
    arc_of: FxHashMap<(u32, u32), usize>,
}

impl Builder {
    fn node(&mut self, label: String, look: Look) -> u32 {
        if let Some(&node) = self.node_of.get(&label) {
            return node;
        }
        let node = u32::try_from(self.graph.nodes.len()).unwrap_or(u32::MAX);
        self.graph.nodes.push(GraphNode { look, label: vec![label.clone()], marks: Vec::new() });
        self.node_of.insert(label, node);
        node
    }

    fn arc(&mut self, from: u32, to: u32, label: String) {
        let at = *self.arc_of.entry((from, to)).or_insert_with(|| {
            self.graph.arcs.push(GraphArc { from, to, label: String::new() });
            self.graph.arcs.len() - 1
        });
        let Some(arc) = self.graph.arcs.get_mut(at) else { return };
        // Of many instances, the first ones.
        const MOST: usize = 48;
        let is_known = arc.label.split(' ').any(|it| it == label);
        if !label.is_empty() && !is_known && arc.label.len() < MOST {
            if !arc.label.is_empty() {
                arc.label.push(' ');
            }
            arc.label.push_str(&label);
        }
    }
}

const METRICS: Metrics = Metrics { gap: 44, track: 11, lane: 11, gutter: 14, pitch: 30, overhang: 0 };
const MARGIN: i32 = 24;
const NAME: usize = 32;

pub(super) fn scene(graph: &Graph) -> Scene {
    let mut scene = Scene { role: "Call graph", title: graph.title.clone(), ..Scene::default() };
    let top = heading(&mut scene, &[], MARGIN);
    let arcs: Vec<(u32, u32)> = graph.arcs.iter().filter(|it| it.from != it.to).map(|it| (it.from, it.to)).collect();
    let starts = (0..).zip(&graph.nodes).filter(|it| it.1.look == Look::Entry).map(|it| it.0);
    let layers = layers::assign(graph.nodes.len(), &arcs, &starts.collect::<Vec<u32>>(), &vec![0; graph.nodes.len()]);
    // Instances that a block is called with.
    let mut instances: Vec<Vec<&str>> = vec![Vec::new(); graph.nodes.len()];
    for it in graph.arcs.iter().filter(|it| !it.label.is_empty()) {
        if let Some(list) = instances.get_mut(it.to as usize) {
            list.extend(it.label.split(' '));
        }
    }
    let views: Vec<View> = graph.nodes.iter().zip(instances).map(|(node, names)| View::new(node, names)).collect();
    // Layouts run downwards: here what is below lies to the right.
    let nodes: Vec<Node> = views
        .iter()
        .zip(&layers.cells)
        .map(|(it, &(column, row))| Node {
            column,
            row,
            left: it.height / 2,
            right: it.height - it.height / 2,
            height: it.width,
            port: it.width,
        })
        .collect();
    let routed = route::route(&nodes, &arcs, &METRICS);
    let place = |it: Point| it.turned().moved(MARGIN, top);
    let mut links = Group::default();
    for bar in &routed.bars {
        let from = routed.places[bar.node];
        let edge = if bar.is_below { from.y + nodes[bar.node].port } else { from.y };
        let ends = [Point::new(from.x, edge), Point::new(from.x, bar.y)].map(place);
        links.line(Stroke::Link, ends);
        links.line(Stroke::Link, [Point::new(bar.from, bar.y), Point::new(bar.to, bar.y)].map(place));
        if !bar.is_below {
            links.head(ends[1], ends[0]);
        }
    }
    for line in &routed.lines {
        let own: Vec<Point> = line.points[line.own.0..=line.own.1].iter().copied().map(place).collect();
        if line.own.1 + 1 == line.points.len()
            && let [.., before, end] = line.points[..].iter().copied().map(place).collect::<Vec<_>>()[..]
        {
            links.head(before, end);
        }
        links.line(Stroke::Link, own);
    }
    if !links.shapes.is_empty() {
        scene.groups.push(links);
    }
    let loops: Vec<bool> = {
        let mut loops = vec![false; graph.nodes.len()];
        graph.arcs.iter().filter(|it| it.from == it.to).for_each(|it| loops[it.from as usize] = true);
        loops
    };
    for (((node, view), at), calls_itself) in graph.nodes.iter().zip(&views).zip(&routed.places).zip(loops) {
        let at = place(*at);
        let area = Rect::new(at.x, at.y - view.height / 2, view.width, view.height);
        let mut group = Group::default();
        group.mark(node.label.join(" "), &node.marks.iter().collect::<Vec<_>>());
        group.area(if node.look == Look::Absent { Fill::Dashed } else { Fill::Paper }, area);
        if node.look == Look::Entry {
            group.area(Fill::None, area.inner(3));
        }
        let mut y = area.y + 6;
        for it in &view.lines {
            y = group.lines(Style::Code, Anchor::Start, area.x + 10, y, std::slice::from_ref(it));
        }
        group.lines(Style::Small, Anchor::Start, area.x + 10, y, &view.small);
        group.tags(&view.tags, Anchor::End, area.right() - 6, at.y);
        if calls_itself {
            let (x, y) = (area.right() - 14, area.y);
            group.line(
                Stroke::Link,
                [Point::new(x, y), Point::new(x, y - 5), Point::new(x - 16, y - 5), Point::new(x - 16, y)],
            );
            group.head(Point::new(x - 16, y - 5), Point::new(x - 16, y));
        }
        scene.groups.push(group);
    }
    scene.width = scene.width.max(routed.height + 2 * MARGIN);
    scene.height = top + routed.width + MARGIN;
    scene
}

struct View {
    lines: Vec<String>,
    small: Vec<String>,
    tags: Tags,
    width: i32,
    height: i32,
}

impl View {
    fn new(node: &GraphNode, mut instances: Vec<&str>) -> Self {
        let lines: Vec<String> = node.label.iter().map(|it| cut(&clean(it), NAME)).collect();
        instances.dedup();
        let small = Some(cut(&clean(&instances.join(" ")), NAME)).filter(|it| !it.is_empty());
        let small: Vec<String> = small.into_iter().collect();
        let marks: Vec<&Mark> = node.marks.iter().collect();
        let tags = Tags::new(&marks);
        let widths = lines.iter().map(|it| Style::Code.width(it)).chain(small.iter().map(|it| Style::Small.width(it)));
        let height = i32::try_from(lines.len()).unwrap_or(1) * Style::Code.line()
            + i32::try_from(small.len()).unwrap_or(1) * Style::Small.line();
        let width = widths.max().unwrap_or(0) + 20 + tags.width() + 8 * i32::from(tags.width() > 0);
        Self { width, height: (height + 12).max(tags.height() + 8), lines, small, tags }
    }
}
