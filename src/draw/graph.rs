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
            let (first, rest) = node.label.split_first().map_or(("", &[][..]), |it| (it.0.as_str(), it.1));
            let label = quoted_lines(node.label.iter().map(String::as_str), "\\n");
            let mut attributes = match node.look {
                Look::Step | Look::Code => format!("label={label}"),
                Look::InitialStep | Look::Entry => format!("label={label}, peripheries=2"),
                Look::MacroStep => format!("label={label}, shape=Msquare"),
                Look::Connector => format!("label={label}, shape=plaintext"),
                Look::Absent => format!("label={label}, style=dashed"),
                // A bar, with the receptivity beside it.
                Look::Transition => {
                    let lines = std::iter::once(first).chain(rest.iter().map(String::as_str));
                    let label = quoted_lines(lines, "\\l");
                    format!("label=\"\", xlabel={label}, style=filled, fillcolor=black, height=0.05, width=0.6, fixedsize=true")
                }
            };
            if let Some(severity) = node.marks.iter().map(|it| it.severity).max() {
                let (_, colour, soft) = look(severity);
                write!(attributes, ", color=\"{colour}\"")?;
                match node.look {
                    Look::Transition => write!(attributes, ", fillcolor=\"{colour}\", fontcolor=\"{colour}\"")?,
                    _ => write!(attributes, ", style=filled, fillcolor=\"{soft}\"")?,
                }
                let messages = node.marks.iter().map(|it| format!("{}: {}", it.code, it.message));
                let messages: Vec<String> = messages.collect();
                let tooltip = quoted_lines(messages.iter().map(String::as_str), "\\n");
                write!(attributes, ", tooltip={tooltip}")?;
                if node.look != Look::Transition {
                    write!(attributes, ", xlabel={}", quoted(&codes(&node.marks)))?;
                }
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

/// Lines, each followed by an escape that ends it; the one between lines where it only parts them.
fn quoted_lines<'a>(lines: impl Iterator<Item = &'a str>, end: &str) -> String {
    let lines: Vec<String> = lines.map(|it| clean(it).replace('\\', "\\\\").replace('"', "\\\"")).collect();
    match end {
        "\\l" => format!("\"{}\"", lines.iter().map(|it| format!("{it}\\l")).collect::<String>()),
        _ => format!("\"{}\"", lines.join(end)),
    }
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
