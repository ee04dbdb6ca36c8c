//! Scenes as SVG: one element a shape, colours by class, text as text.

use std::io;

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesEnd, BytesStart, BytesText, Event};

use super::Theme;
use super::scene::{Anchor, Fill, Group, Point, Scene, Shape, Stroke, Style};
use crate::lint::Severity;

/// Name, light and dark colour.
const COLOURS: &[(&str, &str, &str)] = &[
    ("paper", "#ffffff", "#15181d"),
    ("ink", "#1f2328", "#e3e6ea"),
    ("muted", "#59636e", "#9aa4b0"),
    ("error", "#c4232b", "#ff8078"),
    ("error-soft", "#fdecec", "#3b1d20"),
    ("warning", "#8f5500", "#e9b24c"),
    ("warning-soft", "#fff3d9", "#372b14"),
    ("note", "#0b5cad", "#7ab8ff"),
    ("note-soft", "#e6f1fc", "#152a42"),
];

/// Selectors, colours of properties, other declarations.
type Rule = (&'static str, &'static [(&'static str, &'static str)], &'static str);

const RULES: &[Rule] = &[
    (".page", &[("fill", "paper")], ""),
    (".link", &[("stroke", "ink")], "fill:none;stroke-width:1.5"),
    (".heavy", &[("stroke", "ink")], "fill:none;stroke-width:3"),
    (".head", &[("fill", "ink")], ""),
    (".box", &[("fill", "paper"), ("stroke", "ink")], "stroke-width:1.5"),
    (".open", &[("stroke", "ink")], "fill:none;stroke-width:1.5"),
    (".absent", &[("fill", "paper"), ("stroke", "muted")], "stroke-width:1.5;stroke-dasharray:4 3"),
    (
        "text",
        &[("fill", "ink")],
        "font:12px ui-monospace,'DejaVu Sans Mono',Menlo,Consolas,'Liberation Mono',monospace",
    ),
    (".name", &[], "font-size:13px;font-weight:600"),
    (".comment", &[("fill", "muted")], "font-style:italic"),
    (".small", &[("fill", "muted")], "font-size:10px"),
    (".heading", &[], "font-size:15px;font-weight:600"),
    (".tagged", &[("fill", "paper")], "font-size:10px;font-weight:600"),
    (".error .link,.error .heavy", &[("stroke", "error")], ""),
    (".error .box,.error .absent", &[("fill", "error-soft"), ("stroke", "error")], ""),
    (".error .open", &[("stroke", "error")], ""),
    (".error .tag", &[("fill", "error")], ""),
    (".warning .link,.warning .heavy", &[("stroke", "warning")], ""),
    (".warning .box,.warning .absent", &[("fill", "warning-soft"), ("stroke", "warning")], ""),
    (".warning .open", &[("stroke", "warning")], ""),
    (".warning .tag", &[("fill", "warning")], ""),
    (".note .link,.note .heavy", &[("stroke", "note")], ""),
    (".note .box,.note .absent", &[("fill", "note-soft"), ("stroke", "note")], ""),
    (".note .open", &[("stroke", "note")], ""),
    (".note .tag", &[("fill", "note")], ""),
];

/// The style sheet. Each colour is given twice, for viewers that do not know variables.
fn style(theme: Theme) -> String {
    let is_dark = theme == Theme::Dark;
    let variables = |dark: bool| -> String {
        COLOURS.iter().map(|it| format!("--{}:{};", it.0, if dark { it.2 } else { it.1 })).collect()
    };
    let plain = |name: &str| {
        let colour = COLOURS.iter().find(|it| it.0 == name);
        colour.map_or("", |it| if is_dark { it.2 } else { it.1 })
    };
    let mut text = format!("\n.plclint{{{}}}\n", variables(is_dark));
    if theme == Theme::Auto {
        text.push_str(&format!("@media (prefers-color-scheme:dark){{.plclint{{{}}}}}\n", variables(true)));
    }
    for (selectors, colours, rest) in RULES {
        let selectors: Vec<String> = selectors.split(',').map(|it| format!(".plclint {it}")).collect();
        let colours: String =
            colours.iter().map(|it| format!("{0}:{1};{0}:var(--{2});", it.0, plain(it.1), it.1)).collect();
        text.push_str(&format!("{}{{{colours}{rest}}}\n", selectors.join(",")));
    }
    text
}

/// Prints a scene.
pub(super) fn write(scene: &Scene, theme: Theme) -> String {
    let mut writer = Writer::new(Vec::new());
    // Writing to memory does not fail.
    let _ = document(&mut writer, scene, theme);
    String::from_utf8(writer.into_inner()).unwrap_or_default()
}

type Out = Writer<Vec<u8>>;

fn document(out: &mut Out, scene: &Scene, theme: Theme) -> io::Result<()> {
    let (width, height) = (scene.width.max(1).to_string(), scene.height.max(1).to_string());
    out.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    out.get_mut().push(b'\n');
    let title = legal(&scene.title);
    let root = BytesStart::new("svg").with_attributes([
        ("xmlns", "http://www.w3.org/2000/svg"),
        ("class", "plclint"),
        ("viewBox", &format!("0 0 {width} {height}")),
        ("width", &width),
        ("height", &height),
        ("role", "graphics-document"),
        ("aria-roledescription", scene.role),
        ("aria-label", &title),
    ]);
    out.write_event(Event::Start(root))?;
    element(out, "title", &[], Some(&title))?;
    element(out, "style", &[], Some(&style(theme)))?;
    out.get_mut().push(b'\n');
    element(out, "rect", &[("class", "page"), ("width", &width), ("height", &height)], None)?;
    for it in &scene.groups {
        out.get_mut().push(b'\n');
        group(out, it)?;
    }
    out.get_mut().push(b'\n');
    out.write_event(Event::End(BytesEnd::new("svg")))?;
    out.get_mut().push(b'\n');
    Ok(())
}

fn group(out: &mut Out, group: &Group) -> io::Result<()> {
    let mut start = BytesStart::new("g");
    if let Some(severity) = group.severity {
        start.push_attribute(("class", severity_class(severity)));
    }
    out.write_event(Event::Start(start))?;
    if let Some(title) = &group.title {
        element(out, "title", &[], Some(title))?;
    }
    for it in &group.shapes {
        shape(out, it)?;
    }
    out.write_event(Event::End(BytesEnd::new("g")))
}

fn severity_class(severity: Severity) -> &'static str {
    match severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Advice => "note",
    }
}

fn shape(out: &mut Out, shape: &Shape) -> io::Result<()> {
    match shape {
        Shape::Line { points, stroke } => {
            let class = match stroke {
                Stroke::Link => "link",
                Stroke::Heavy => "heavy",
            };
            element(out, "path", &[("class", class), ("d", &path(points))], None)
        }
        Shape::Box { area, fill } => {
            let class = match fill {
                Fill::Paper => "box",
                Fill::None => "open",
                Fill::Dashed => "absent",
                Fill::Tag => "tag",
            };
            let [x, y, width, height] = [area.x, area.y, area.width, area.height].map(|it| it.to_string());
            let mut attributes =
                vec![("class", class), ("x", &*x), ("y", &*y), ("width", &*width), ("height", &*height)];
            if *fill == Fill::Tag {
                attributes.push(("rx", "2"));
            }
            element(out, "rect", &attributes, None)
        }
        Shape::Text { at, anchor, style, text } => {
            let [x, y] = [at.x, at.y].map(|it| it.to_string());
            let mut attributes = vec![("x", &*x), ("y", &*y)];
            let class = match style {
                Style::Code => None,
                Style::Name => Some("name"),
                Style::Comment => Some("comment"),
                Style::Small => Some("small"),
                Style::Tag => Some("tagged"),
                Style::Heading => Some("heading"),
            };
            attributes.extend(class.map(|it| ("class", it)));
            match anchor {
                Anchor::Start => {}
                Anchor::Middle => attributes.push(("text-anchor", "middle")),
                Anchor::End => attributes.push(("text-anchor", "end")),
            }
            element(out, "text", &attributes, Some(text))
        }
        Shape::Arc { from, to, radius } => {
            let d = format!("M{} {}A{radius} {radius} 0 0 1 {} {}", from.x, from.y, to.x, to.y);
            element(out, "path", &[("class", "link"), ("d", &d)], None)
        }
        Shape::Head { points } => element(out, "path", &[("class", "head"), ("d", &(path(points) + "Z"))], None),
    }
}

fn path(points: &[Point]) -> String {
    let mut d = String::new();
    for (at, it) in points.iter().enumerate() {
        d.push_str(&format!("{}{} {}", if at == 0 { "M" } else { "L" }, it.x, it.y));
    }
    d
}

fn element(out: &mut Out, name: &str, attributes: &[(&str, &str)], text: Option<&str>) -> io::Result<()> {
    let start = BytesStart::new(name).with_attributes(attributes.iter().copied());
    match text {
        None => out.write_event(Event::Empty(start)),
        Some(text) => {
            out.write_event(Event::Start(start))?;
            out.write_event(Event::Text(BytesText::new(&legal(text))))?;
            out.write_event(Event::End(BytesEnd::new(name)))
        }
    }
}

/// A text without the characters that XML has no way to write.
fn legal(text: &str) -> String {
    let is_legal = |it: char| matches!(it, '\t' | '\n' | ' '..='\u{d7ff}' | '\u{e000}'..='\u{fffd}' | '\u{10000}'..);
    text.chars().map(|it| if is_legal(it) { it } else { '\u{fffd}' }).collect()
}
