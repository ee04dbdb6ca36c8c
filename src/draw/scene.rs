//! What a drawing is made of: shapes in their places, in pixels from the upper left corner.
//!
//! Layouts make scenes, [`super::svg`] prints them. A scene holds text as it is: escaping is the printer's.

use unicode_width::{UnicodeWidthChar as _, UnicodeWidthStr as _};

use super::Mark;
use crate::lint::Severity;

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Point {
    pub x: i32,
    pub y: i32,
}

impl Point {
    pub fn new(x: i32, y: i32) -> Self {
        Self { x, y }
    }

    /// With the axes exchanged.
    pub fn turned(self) -> Self {
        Self { x: self.y, y: self.x }
    }

    pub fn moved(self, x: i32, y: i32) -> Self {
        Self { x: self.x + x, y: self.y + y }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Rect {
    pub x: i32,
    pub y: i32,
    pub width: i32,
    pub height: i32,
}

impl Rect {
    pub fn new(x: i32, y: i32, width: i32, height: i32) -> Self {
        Self { x, y, width, height }
    }

    pub fn right(self) -> i32 {
        self.x + self.width
    }

    pub fn bottom(self) -> i32 {
        self.y + self.height
    }

    /// Smaller by a margin on all sides.
    pub fn inner(self, margin: i32) -> Self {
        Self::new(self.x + margin, self.y + margin, self.width - 2 * margin, self.height - 2 * margin)
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Stroke {
    /// A link, a wire.
    Link,
    /// The bar of a transition, a power rail.
    Heavy,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Fill {
    /// A step, a block.
    Paper,
    /// Not filled.
    None,
    /// Something that the program does not hold.
    Dashed,
    /// Behind the code of a finding.
    Tag,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Style {
    /// Code, names.
    Code,
    /// The name of a step.
    Name,
    /// A comment.
    Comment,
    /// What a reader may pass over.
    Small,
    /// Code of a finding.
    Tag,
    Heading,
}

impl Style {
    /// Height of the letters in pixels.
    pub fn size(self) -> i32 {
        match self {
            Self::Heading => 15,
            Self::Name => 13,
            Self::Code | Self::Comment => 12,
            Self::Small | Self::Tag => 10,
        }
    }

    /// From one line to the next.
    pub fn line(self) -> i32 {
        self.size() + 4
    }

    /// Width of a text in a font whose letters have one width.
    pub fn width(self, text: &str) -> i32 {
        let columns = i32::try_from(text.width()).unwrap_or(i32::MAX / 4096).min(i32::MAX / 4096);
        (columns * self.size() * 61 + 99) / 100
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Shape {
    Line {
        points: Vec<Point>,
        stroke: Stroke,
    },
    Box {
        area: Rect,
        fill: Fill,
    },
    /// `at` is on the base line.
    Text {
        at: Point,
        anchor: Anchor,
        style: Style,
        text: String,
    },
    /// Part of a circle, clockwise.
    Arc {
        from: Point,
        to: Point,
        radius: i32,
    },
    /// The head of an arrow, by its corners.
    Head {
        points: [Point; 3],
    },
}

/// Shapes that belong together: a step with its actions, a cell of a rung.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct Group {
    /// What is shown when a pointer rests on it.
    pub title: Option<String>,
    /// The worst of its findings.
    pub severity: Option<Severity>,
    pub shapes: Vec<Shape>,
}

impl Group {
    pub fn line(&mut self, stroke: Stroke, points: impl IntoIterator<Item = Point>) {
        let mut points: Vec<Point> = points.into_iter().collect();
        points.dedup();
        if points.len() > 1 {
            self.shapes.push(Shape::Line { points, stroke });
        }
    }

    pub fn area(&mut self, fill: Fill, area: Rect) {
        self.shapes.push(Shape::Box { area, fill });
    }

    pub fn text(&mut self, style: Style, anchor: Anchor, at: Point, text: impl Into<String>) {
        let text = text.into();
        if !text.is_empty() {
            self.shapes.push(Shape::Text { at, anchor, style, text });
        }
    }

    /// A text centred on a point.
    pub fn centred(&mut self, style: Style, at: Point, text: impl Into<String>) {
        self.text(style, Anchor::Middle, at.moved(0, style.size() * 35 / 100), text);
    }

    /// Lines of text, the first one's upper edge at a height. Returns the lower edge of the last.
    pub fn lines(&mut self, style: Style, anchor: Anchor, x: i32, y: i32, lines: &[String]) -> i32 {
        let mut y = y;
        for it in lines {
            self.text(style, anchor, Point::new(x, y + style.size()), it.as_str());
            y += style.line();
        }
        y
    }

    /// The head of an arrow at the end of a line that comes from a point.
    pub fn head(&mut self, from: Point, to: Point) {
        const LENGTH: i32 = 7;
        const HALF: i32 = 4;
        let (x, y) = ((to.x - from.x).signum(), (to.y - from.y).signum());
        let back = to.moved(-x * LENGTH, -y * LENGTH);
        self.shapes
            .push(Shape::Head { points: [to, back.moved(y * HALF, x * HALF), back.moved(-y * HALF, -x * HALF)] });
    }

    /// Codes of findings in a column of tags, centred on a height; `x` is their left, or right, edge.
    pub fn tags(&mut self, tags: &Tags, anchor: Anchor, x: i32, y: i32) {
        let mut top = y - tags.height() / 2;
        for code in &tags.0 {
            let width = Style::Tag.width(code) + 6;
            let left = if anchor == Anchor::End { x - width } else { x };
            self.area(Fill::Tag, Rect::new(left, top, width, TAG_HEIGHT - 2));
            self.text(Style::Tag, Anchor::Start, Point::new(left + 3, top + 9), code.as_str());
            top += TAG_HEIGHT;
        }
    }

    /// Takes the findings' severity and says them in the title.
    pub fn mark(&mut self, subject: String, marks: &[&Mark]) {
        self.severity = marks.iter().map(|it| it.severity).max();
        let mut title = subject;
        for it in marks.iter().take(MOST_MESSAGES) {
            title.push_str(&format!("\n{} {}: {}", it.severity.as_str(), it.code, it.message));
        }
        if marks.len() > MOST_MESSAGES {
            title.push_str(&format!("\nand {} more", marks.len() - MOST_MESSAGES));
        }
        self.title = Some(title).filter(|it| !it.is_empty());
    }
}

/// Messages in one title.
const MOST_MESSAGES: usize = 12;
const TAG_HEIGHT: i32 = 14;

/// The codes that are shown beside an element: no more than it has room for.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct Tags(Vec<String>);

impl Tags {
    pub fn new(marks: &[&Mark]) -> Self {
        const MOST: usize = 3;
        let mut codes: Vec<String> = Vec::new();
        let mut sorted: Vec<_> = marks.iter().map(|it| (std::cmp::Reverse(it.severity), it.code)).collect();
        sorted.sort_unstable();
        sorted.dedup_by_key(|it| it.1);
        let left = sorted.len().saturating_sub(MOST);
        codes.extend(sorted.iter().take(MOST).map(|it| it.1.to_owned()));
        if left > 0 {
            codes.push(format!("+{left}"));
        }
        Self(codes)
    }

    pub fn width(&self) -> i32 {
        self.0.iter().map(|it| Style::Tag.width(it) + 6).max().unwrap_or(0)
    }

    pub fn height(&self) -> i32 {
        i32::try_from(self.0.len()).unwrap_or(0) * TAG_HEIGHT
    }
}

/// A whole drawing.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct Scene {
    /// What kind of drawing it is: `Grafcet chart`.
    pub role: &'static str,
    pub title: String,
    pub width: i32,
    pub height: i32,
    pub groups: Vec<Group>,
}

/// A text as it can be drawn: blanks for what is no letter.
pub(super) fn clean(text: &str) -> String {
    text.chars().map(|it| if it.is_control() { ' ' } else { it }).collect::<String>().trim().to_owned()
}

/// The beginning of a text, if it is longer than so many columns.
pub(super) fn cut(text: &str, columns: usize) -> String {
    if text.width() <= columns {
        return text.to_owned();
    }
    let mut width = 1;
    let fits = |it: &char| {
        width += it.width().unwrap_or(0);
        width <= columns
    };
    let mut short: String = text.chars().take_while(fits).collect();
    short.push('…');
    short
}

/// Lines of at most so many columns, broken at blanks where there are any. What goes beyond `most` lines is cut.
pub(super) fn wrap(text: &str, columns: usize, most: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for source in text.lines() {
        let mut line = String::new();
        for word in source.split_whitespace() {
            let mut word = word;
            if !line.is_empty() && line.width() + 1 + word.width() > columns {
                lines.push(std::mem::take(&mut line));
            }
            // A word longer than a line is broken where it must be.
            while line.is_empty() && word.width() > columns {
                let mut width = 0;
                let at = word.char_indices().find(|it| {
                    width += it.1.width().unwrap_or(0);
                    width > columns
                });
                let Some((at, _)) = at.filter(|it| it.0 > 0) else { break };
                let (head, tail) = word.split_at(at);
                lines.push(head.to_owned());
                word = tail;
                if lines.len() > most {
                    break;
                }
            }
            if !line.is_empty() {
                line.push(' ');
            }
            line.push_str(word);
            if lines.len() > most {
                break;
            }
        }
        if !line.is_empty() {
            lines.push(line);
        }
        if lines.len() > most {
            break;
        }
    }
    if lines.len() > most {
        lines.truncate(most);
        if let Some(last) = lines.last_mut() {
            *last = cut(&format!("{last} …"), columns);
            if !last.ends_with('…') {
                last.push('…');
            }
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_texts_are_broken_and_cut() {
        assert_eq!(wrap("%I1.0 AND NOT %I1.7", 12, 4), ["%I1.0 AND", "NOT %I1.7"]);
        assert_eq!(wrap("abcdefgh", 3, 9), ["abc", "def", "gh"]);
        assert_eq!(wrap("a b\nc", 9, 9), ["a b", "c"]);
        assert_eq!(wrap("aa bb cc dd", 2, 2), ["aa", "b…"]);
        assert_eq!(wrap(" \n ", 9, 9), [""; 0]);
        assert!(wrap(&"x".repeat(100_000), 20, 3).len() == 3);
        assert_eq!(cut("abcdef", 4), "abc…");
        assert_eq!(cut("ab", 4), "ab");
        assert_eq!(clean(" a\u{1}b\tc\n"), "a b c");
    }
}
