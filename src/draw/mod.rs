//! Drawings of programs: Grafcet charts, ladder networks, the graph of calls, each with the findings in it.
//!
//! Three steps, each on its own: what is to be drawn is read from trees and models ([`chart`], [`ladder`], [`calls`]);
//! layouts put it into places ([`layers`] and [`route`]); a printer writes it ([`svg`], or [`graph`] for other programs).
//!
//! **Invariant:** the same program gives the same bytes. Time is linear in what is drawn, but for sorting.

mod calls;
mod chart;
mod graph;
mod ladder;
mod layers;
mod route;
mod scene;
mod svg;
mod words;

#[cfg(test)]
mod tests;

use rowan::TextRange;

use crate::analysis::program::ProgramIndex;
use crate::lint::Severity;
use crate::model::UnitModel;
use crate::syntax::{Language, SyntaxNode};
use scene::{Anchor, Group, Point, Scene, Style, Tags};

/// A finding as drawings show it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Mark {
    pub code: &'static str,
    pub severity: Severity,
    pub message: String,
}

/// A unit of a program.
#[derive(Debug, Clone, Copy)]
pub struct Unit<'a> {
    pub language: Language,
    /// Tree and model of its text.
    pub tree: SyntaxNode<'a>,
    pub model: &'a UnitModel,
    /// Findings with their primary places, relative to the unit.
    pub marks: &'a [(TextRange, Mark)],
}

/// What is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    Chart,
    Ladder,
    Calls,
}

/// Colours of a drawing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Theme {
    /// As whoever shows the drawing wants it.
    Auto,
    Light,
    Dark,
}

/// One drawing, not yet laid out.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Drawing {
    content: Content,
}

#[derive(Debug, Clone, PartialEq, Eq)]
enum Content {
    Chart(chart::Picture),
    Ladder(ladder::Picture),
    Calls(graph::Graph),
}

impl Drawing {
    /// In the vendor's own addressing: `MAST - Chart - CHART`.
    pub fn title(&self) -> &str {
        match &self.content {
            Content::Chart(it) => &it.title,
            Content::Ladder(it) => &it.title,
            Content::Calls(it) => &it.title,
        }
    }

    pub fn kind(&self) -> Kind {
        match self.content {
            Content::Chart(_) => Kind::Chart,
            Content::Ladder(_) => Kind::Ladder,
            Content::Calls(_) => Kind::Calls,
        }
    }

    /// A document of its own, in UTF-8.
    pub fn svg(&self, theme: Theme) -> String {
        let scene = match &self.content {
            Content::Chart(it) => it.scene(),
            Content::Ladder(it) => it.scene(),
            Content::Calls(it) => calls::scene(it),
        };
        svg::write(&scene, theme)
    }

    /// Text for Graphviz; `None` for rungs, which are no graph.
    pub fn dot(&self) -> Option<String> {
        self.graph().map(|it| it.dot())
    }

    /// A flowchart of Mermaid; `None` for rungs.
    pub fn mermaid(&self) -> Option<String> {
        self.graph().map(|it| it.mermaid())
    }

    fn graph(&self) -> Option<std::borrow::Cow<'_, graph::Graph>> {
        match &self.content {
            Content::Chart(it) => Some(std::borrow::Cow::Owned(it.graph())),
            Content::Calls(it) => Some(std::borrow::Cow::Borrowed(it)),
            Content::Ladder(_) => None,
        }
    }
}

/// All drawings of a program: charts, those recovered from code behind those that are drawn, rungs, calls. `units` are those of the index, in its order; `name` is what the
/// program as a whole is called.
pub fn drawings(name: &str, units: &[Unit<'_>], index: &ProgramIndex<'_>) -> Vec<Drawing> {
    let charts = chart::pictures(units).into_iter().chain(chart::sequences(units, index)).map(Content::Chart);
    let rungs = units.iter().filter_map(|it| ladder::picture(it, index)).map(Content::Ladder);
    let calls = calls::graph(name, units, index).map(Content::Calls);
    charts.chain(rungs).chain(calls).map(|content| Drawing { content }).collect()
}

/// Writes the title of a drawing, with the findings that belong to nothing in it. Returns where the rest begins.
fn heading(scene: &mut Scene, marks: &[Mark], margin: i32) -> i32 {
    let marks: Vec<&Mark> = marks.iter().collect();
    let tags = Tags::new(&marks);
    let mut group = Group::default();
    if !marks.is_empty() {
        group.mark(scene.title.clone(), &marks);
    }
    let title = scene::cut(&scene::clean(&scene.title), 80);
    let width = Style::Heading.width(&title);
    group.text(Style::Heading, Anchor::Start, Point::new(margin, margin + 14), title);
    group.tags(&tags, Anchor::Start, margin + width + 12, margin + 9);
    scene.groups.push(group);
    scene.width = margin + width + 12 + tags.width() + margin;
    margin + 18.max(9 + tags.height() / 2) + 16
}
