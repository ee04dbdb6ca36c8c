//! Graphs as text for other programs: Graphviz DOT and Mermaid flowcharts.
//!
//! DOT: <https://graphviz.org/doc/info/lang.html>. Mermaid: <https://mermaid.js.org/syntax/flowchart.html>, whose quoted
//! texts take entities by number or name with a `#`.

use std::fmt::Write as _;

use super::Mark;
use super::scene::clean;
use crate::lint::Severity;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Look {
    Step,
    InitialStep,
    MacroStep,
    Transition,
    Connector,
    /// Code that something else calls.
    Code,
    /// Code that the system runs.
    Entry,
    /// What the program does not hold.
    Absent,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct GraphNode {
    pub look: Look,
    /// One line each.
    pub label: Vec<String>,
    pub marks: Vec<Mark>,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct GraphArc {
    pub from: u32,
    pub to: u32,
    pub label: String,
}

#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct Graph {
    pub title: String,
    /// From left to right; else downwards.
    pub is_sideways: bool,
    pub nodes: Vec<GraphNode>,
    pub arcs: Vec<GraphArc>,
}

/// Of a severity: the word of its class, its colour and that of what it fills.
fn look(severity: Severity) -> (&'static str, &'static str, &'static str) {
    match severity {
        Severity::Error => ("error", "#c4232b", "#fdecec"),
        Severity::Warning => ("warning", "#8f5500", "#fff3d9"),
        Severity::Advice => ("note", "#0b5cad", "#e6f1fc"),
    }
}

/// The codes of the findings, each once.
fn codes(marks: &[Mark]) -> String {
    let mut codes: Vec<&str> = marks.iter().map(|it| it.code).collect();
    codes.sort_unstable();
    codes.dedup();
    codes.join(" ")
}

impl Graph {
    pub fn dot(&self) -> String {
        let mut out = String::new();
        let _ = self.write_dot(&mut out);
        out
    }

    fn write_dot(&self, out: &mut String) -> std::fmt::Result {
        writeln!(out, "digraph {} {{", quoted(&self.title))?;
        writeln!(out, "  label={}; labelloc=t;", quoted(&self.title))?;
        writeln!(out, "  rankdir={};", if self.is_sideways { "LR" } else { "TB" })?;
        writeln!(out, "  node [fontname=\"monospace\", fontsize=11, shape=box];")?;
        writeln!(out, "  edge [fontname=\"monospace\", fontsize=9];")?;
        for (at, node) in self.nodes.iter().enumerate() {
            let codes = codes(&node.marks);
            let lines = node.label.iter().map(String::as_str).chain(Some(&*codes).filter(|it| !it.is_empty()));
            let mut attributes = format!("label={}", quoted_lines(lines, "\\n"));
            attributes.push_str(match node.look {
                Look::Step | Look::Code => "",
                Look::InitialStep | Look::Entry => ", peripheries=2",
                Look::MacroStep => ", shape=Msquare",
                Look::Connector => ", shape=plaintext",
                // The bar of the transition.
                Look::Transition => ", shape=underline",
                Look::Absent => ", style=dashed",
            });
            if let Some(severity) = node.marks.iter().map(|it| it.severity).max() {
                let (_, colour, soft) = look(severity);
                match node.look {
                    Look::Transition => write!(attributes, ", color=\"{colour}\", fontcolor=\"{colour}\"")?,
                    _ => write!(attributes, ", color=\"{colour}\", style=filled, fillcolor=\"{soft}\"")?,
                }
                let messages = node.marks.iter().map(|it| format!("{}: {}", it.code, it.message));
                let messages: Vec<String> = messages.collect();
                write!(attributes, ", tooltip={}", quoted_lines(messages.iter().map(String::as_str), "\\n"))?;
            }
            writeln!(out, "  n{at} [{attributes}];")?;
        }
        for arc in &self.arcs {
            write!(out, "  n{} -> n{}", arc.from, arc.to)?;
            if !arc.label.is_empty() {
                write!(out, " [label={}]", quoted(&arc.label))?;
            }
            writeln!(out, ";")?;
        }
        writeln!(out, "}}")
    }

    pub fn mermaid(&self) -> String {
        let mut out = String::new();
        let _ = self.write_mermaid(&mut out);
        out
    }

    fn write_mermaid(&self, out: &mut String) -> std::fmt::Result {
        writeln!(out, "---\ntitle: {}\n---", yaml(&self.title))?;
        writeln!(out, "flowchart {}", if self.is_sideways { "LR" } else { "TB" })?;
        for (at, node) in self.nodes.iter().enumerate() {
            let mut lines: Vec<String> = node.label.iter().map(|it| entities(it)).collect();
            if !node.marks.is_empty() {
                lines.push(entities(&codes(&node.marks)));
            }
            let label = lines.join("<br/>");
            let (open, close) = match node.look {
                Look::Step | Look::Code | Look::Absent => ("[", "]"),
                Look::InitialStep | Look::Entry | Look::MacroStep => ("[[", "]]"),
                Look::Transition => ("{{", "}}"),
                Look::Connector => ("([", "])"),
            };
            let class = node.marks.iter().map(|it| it.severity).max().map(|it| look(it).0);
            let class = class.or((node.look == Look::Absent).then_some("absent"));
            let class = class.map_or_else(String::new, |it| format!(":::{it}"));
            writeln!(out, "  n{at}{open}\"{label}\"{close}{class}")?;
        }
        for arc in &self.arcs {
            if arc.label.is_empty() {
                writeln!(out, "  n{} --> n{}", arc.from, arc.to)?;
            } else {
                writeln!(out, "  n{} -->|\"{}\"| n{}", arc.from, entities(&arc.label), arc.to)?;
            }
        }
        for severity in [Severity::Error, Severity::Warning, Severity::Advice] {
            let (class, colour, soft) = look(severity);
            if self.nodes.iter().any(|it| it.marks.iter().map(|it| it.severity).max() == Some(severity)) {
                writeln!(out, "  classDef {class} stroke:{colour},fill:{soft},color:#1f2328")?;
            }
        }
        if self.nodes.iter().any(|it| it.look == Look::Absent) {
            writeln!(out, "  classDef absent stroke-dasharray:4 3")?;
        }
        Ok(())
    }
}

/// A quoted string of DOT, in which a backslash begins an escape.
fn quoted(text: &str) -> String {
    quoted_lines(std::iter::once(text), "")
}

/// Lines with an escape between them.
fn quoted_lines<'a>(lines: impl Iterator<Item = &'a str>, between: &str) -> String {
    let lines: Vec<String> = lines.map(|it| clean(it).replace('\\', "\\\\").replace('"', "\\\"")).collect();
    format!("\"{}\"", lines.join(between))
}

/// A quoted scalar of YAML.
fn yaml(text: &str) -> String {
    format!("\"{}\"", clean(text).replace('\\', "\\\\").replace('"', "\\\""))
}

/// A text inside the quotes of Mermaid: what it or HTML would take for its own is written as an entity.
fn entities(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for it in clean(text).chars() {
        match it {
            '"' | '#' | '&' | '<' | '>' | '\'' | '`' | ';' | '\\' | '*' | '_' | '~' | '%' => {
                let _ = write!(out, "#{};", u32::from(it));
            }
            other => out.push(other),
        }
    }
    out
}
