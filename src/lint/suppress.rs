//! Suppression comments: `plclint: allow(single-write)` and `plclint: allow-file(W001: reason)`.
//!
//! A language hands over its comments and says where its code stands; nothing here knows a language. An `allow` covers
//! its own line when code stands there. Alone on its line, it covers the next line that has code, and the whole
//! statement when that line begins one. An `allow-file` covers the file from wherever it stands.

use std::ops::Range;

use rowan::{TextRange, TextSize};
use rustc_hash::FxHashMap;

use super::rule::Rule;
use super::select::Selector;

/// A comment of any language, with or without its delimiters.
#[derive(Debug, Clone, Copy)]
pub struct Comment<'a> {
    pub text: &'a str,
    /// Offset of the text in its file.
    pub start: TextSize,
    /// Lines of its first and last character, counted as in [`Code`].
    pub lines: (u32, u32),
}

/// Where the code of a file stands. Lines count from any base, the same everywhere.
#[derive(Debug, Clone, Default)]
pub struct Code {
    /// Lines that hold code, rising.
    pub lines: Vec<u32>,
    /// First and last line of statements that a comment above them covers as a whole (a PL7 sentence, a rung), rising and
    /// apart from one another. May be empty.
    pub statements: Vec<(u32, u32)>,
}

impl Code {
    fn has(&self, line: u32) -> bool {
        self.lines.binary_search(&line).is_ok()
    }

    fn next(&self, after: u32) -> Option<u32> {
        self.lines.get(self.lines.partition_point(|&it| it <= after)).copied()
    }

    /// The statement around a line, when no earlier line of it has code.
    fn statement_begun_at(&self, line: u32) -> Option<(u32, u32)> {
        let statement = self.statement(line)?;
        let first = self.lines.get(self.lines.partition_point(|&it| it < statement.0)).copied();
        (first == Some(line)).then_some(statement)
    }

    fn statement(&self, line: u32) -> Option<(u32, u32)> {
        let at = self.statements.partition_point(|it| it.1 < line);
        self.statements.get(at).copied().filter(|it| it.0 <= line)
    }

    /// The lines that a comment covers.
    fn covered(&self, (first, last): (u32, u32)) -> Option<(u32, u32)> {
        for line in [first, last] {
            if self.has(line) {
                return Some((line, line));
            }
        }
        let next = self.next(last)?;
        Some(self.statement_begun_at(next).unwrap_or((next, next)))
    }
}

/// One `allow(...)` or `allow-file(...)`. Ranges are those of the comment's text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Directive {
    pub range: TextRange,
    pub kind: DirectiveKind,
    /// The words before the colon, trimmed, none of them empty.
    pub names: Vec<(TextRange, String)>,
    /// The text after the colon; empty when there is none.
    pub reason: String,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DirectiveKind {
    Allow,
    AllowFile,
    /// `plclint:` with something else behind it, or without a closing parenthesis.
    Malformed,
}

/// Reads what a comment says to the linter. Empty for nearly every comment.
pub fn parse(comment: &str) -> Vec<Directive> {
    const PREFIX: &str = "plclint:";
    let bytes = comment.as_bytes();
    let mut directives = Vec::new();
    let mut at = 0;
    while let Some(colon) = memchr::memchr(b':', bytes.get(at..).unwrap_or_default()).map(|it| at + it) {
        at = colon + 1;
        let Some(start) = at.checked_sub(PREFIX.len()) else { continue };
        let word = bytes.get(start..at).unwrap_or_default();
        let inside_a_word = start > 0 && bytes.get(start - 1).is_some_and(u8::is_ascii_alphanumeric);
        if inside_a_word || !word.eq_ignore_ascii_case(PREFIX.as_bytes()) {
            continue;
        }
        let (directive, end) = directive(comment, start, at);
        let mut ok = directive.kind != DirectiveKind::Malformed;
        directives.push(directive);
        at = end;
        // Several may follow one prefix: `plclint: allow(W001) allow(J001: shared)`.
        while ok {
            let next = skip(bytes, at, |it| it.is_ascii_whitespace() || it == b',');
            if !bytes.get(next..).is_some_and(|it| it.len() >= 5 && it[..5].eq_ignore_ascii_case(b"allow")) {
                break;
            }
            let (directive, end) = self::directive(comment, next, next);
            ok = directive.kind != DirectiveKind::Malformed;
            if ok {
                directives.push(directive);
                at = end;
            }
        }
    }
    directives
}

fn skip(bytes: &[u8], from: usize, while_: impl Fn(u8) -> bool) -> usize {
    let rest = bytes.get(from..).unwrap_or_default();
    from + rest.iter().position(|&it| !while_(it)).unwrap_or(rest.len())
}

/// Reads `allow(...)` at `at`, and says where it ends.
fn directive(comment: &str, start: usize, at: usize) -> (Directive, usize) {
    let bytes = comment.as_bytes();
    let verb = skip(bytes, at, |it| matches!(it, b' ' | b'\t'));
    let verb_end = skip(bytes, verb, |it| it.is_ascii_alphabetic() || it == b'-');
    let kind = match comment.get(verb..verb_end) {
        Some(it) if it.eq_ignore_ascii_case("allow") => DirectiveKind::Allow,
        Some(it) if it.eq_ignore_ascii_case("allow-file") => DirectiveKind::AllowFile,
        _ => DirectiveKind::Malformed,
    };
    let open = skip(bytes, verb_end, |it| matches!(it, b' ' | b'\t'));
    let close = if bytes.get(open) == Some(&b'(') { closing(bytes, open) } else { None };
    let (Some(close), true) = (close, kind != DirectiveKind::Malformed) else {
        let range = text_range(start..verb_end.max(at));
        let directive = Directive { range, kind: DirectiveKind::Malformed, names: Vec::new(), reason: String::new() };
        return (directive, verb_end.max(at));
    };
    let inner = comment.get(open + 1..close).unwrap_or_default();
    let (words, reason) = inner.split_once(':').unwrap_or((inner, ""));
    let mut names = Vec::new();
    let mut offset = open + 1;
    for word in words.split(',') {
        let trimmed = word.trim();
        if !trimmed.is_empty() {
            let begin = offset + (word.len() - word.trim_start().len());
            names.push((text_range(begin..begin + trimmed.len()), trimmed.to_owned()));
        }
        offset += word.len() + 1;
    }
    let kind = if names.is_empty() { DirectiveKind::Malformed } else { kind };
    let reason = reason.split_whitespace().collect::<Vec<_>>().join(" ");
    (Directive { range: text_range(start..close + 1), kind, names, reason }, close + 1)
}

/// Longest text between the parentheses, in bytes: what bounds the search for a parenthesis that never comes.
const MAX_LENGTH: usize = 1000;

/// The parenthesis that closes the one at `open`. A reason may hold pairs of its own.
fn closing(bytes: &[u8], open: usize) -> Option<usize> {
    let mut depth = 0usize;
    for (at, byte) in bytes.iter().enumerate().skip(open).take(MAX_LENGTH) {
        match byte {
            b'(' => depth += 1,
            b')' => {
                depth = depth.saturating_sub(1);
                if depth == 0 {
                    return Some(at);
                }
            }
            _ => {}
        }
    }
    None
}

fn text_range(range: Range<usize>) -> TextRange {
    let size = |it: usize| TextSize::new(u32::try_from(it).unwrap_or(u32::MAX));
    TextRange::new(size(range.start), size(range.end).max(size(range.start)))
}

/// The suppressions of one file.
#[derive(Debug, Clone, Default)]
pub struct Suppressions {
    entries: Vec<Entry>,
    by_lines: FxHashMap<(u32, u32), Vec<usize>>,
    whole_file: Vec<usize>,
    code: Code,
}

/// One word of a suppression comment.
#[derive(Debug, Clone)]
pub struct Entry {
    /// The word, in the file.
    pub range: TextRange,
    pub reason: String,
    /// Whether a finding was suppressed by it.
    pub used: bool,
    state: State,
}

#[derive(Debug, Clone)]
enum State {
    Rules(Selector),
    /// The message.
    Wrong(String),
}

/// A suppression that suppresses nothing: what rule X003 reports.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Leftover {
    /// The word of the comment, in the file.
    pub range: TextRange,
    /// A sentence without a final stop.
    pub message: String,
}

impl Suppressions {
    /// Reads all comments of a file.
    pub fn new<'a>(comments: impl IntoIterator<Item = Comment<'a>>, code: Code) -> Self {
        Self::with_registry(super::rules(), comments, code)
    }

    pub(crate) fn with_registry<'a>(
        registry: &'static [Rule],
        comments: impl IntoIterator<Item = Comment<'a>>,
        code: Code,
    ) -> Self {
        let mut this = Self { code, ..Self::default() };
        for comment in comments {
            for directive in parse(comment.text) {
                this.add(registry, &comment, directive);
            }
        }
        this
    }

    fn add(&mut self, registry: &'static [Rule], comment: &Comment<'_>, directive: Directive) {
        let place = |range: TextRange| range.checked_add(comment.start).unwrap_or(range);
        if directive.kind == DirectiveKind::Malformed {
            let message = "`plclint:` is followed by neither `allow(rule)` nor `allow-file(rule)`";
            self.push(place(directive.range), String::new(), State::Wrong(message.to_owned()));
            return;
        }
        let covered = self.code.covered(comment.lines);
        for (range, word) in directive.names {
            let state = match Selector::parse(registry, &word) {
                Ok(Selector::All | Selector::Default) => {
                    State::Wrong(format!("`{word}` is no rule: a comment suppresses rules or groups by name"))
                }
                Ok(selector) => State::Rules(selector),
                Err(unknown) => State::Wrong(unknown.to_string()),
            };
            let means_rules = matches!(state, State::Rules(_));
            let index = self.push(place(range), directive.reason.clone(), state);
            if !means_rules {
                continue;
            }
            if directive.kind == DirectiveKind::AllowFile {
                self.whole_file.push(index);
            } else if let Some(lines) = covered {
                self.by_lines.entry(lines).or_default().push(index);
            }
        }
    }

    fn push(&mut self, range: TextRange, reason: String, state: State) -> usize {
        self.entries.push(Entry { range, reason, used: false, state });
        self.entries.len() - 1
    }

    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// Whether a finding of the rule on this line is suppressed, and then the reason given, which may be empty. Marks
    /// the comment as used: the one of the line before the one of the statement, before the one of the file.
    pub fn suppress(&mut self, rule: &Rule, line: u32) -> Option<&str> {
        let statement = self.code.statement(line).unwrap_or((line, line));
        let of = |lines: (u32, u32)| self.by_lines.get(&lines).into_iter().flatten();
        let own = of((line, line));
        let around = of(statement).filter(|_| statement != (line, line));
        let mut candidates = own.chain(around).chain(&self.whole_file).copied();
        let entries = &self.entries;
        let index = candidates.find(|&it| matches!(entries[it].state, State::Rules(words) if words.covers(rule)))?;
        let entry = self.entries.get_mut(index)?;
        entry.used = true;
        Some(&entry.reason)
    }

    /// What suppresses nothing, in the order of the file. A suppression all of whose rules are off, as `is_on` says,
    /// is left in peace.
    pub fn leftovers(&self, registry: &'static [Rule], is_on: impl Fn(&Rule) -> bool) -> Vec<Leftover> {
        let mut leftovers = Vec::new();
        for entry in self.entries.iter().filter(|it| !it.used) {
            let message = match &entry.state {
                State::Wrong(message) => message.clone(),
                State::Rules(words) if !registry.iter().any(|it| words.covers(it) && is_on(it)) => continue,
                State::Rules(Selector::Rule(code)) => {
                    let name = registry.iter().find(|it| it.code == *code).map_or(*code, |it| it.name);
                    format!("this suppression of {code} ({name}) suppresses nothing")
                }
                State::Rules(Selector::Group(group)) => format!("this suppression of `{group}` suppresses nothing"),
                State::Rules(_) => "this suppression suppresses nothing".to_owned(),
            };
            leftovers.push(Leftover { range: entry.range, message });
        }
        leftovers.sort_by_key(|it| it.range.start());
        leftovers
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lint::testing::RULES;

    fn rule(code: &str) -> &'static Rule {
        RULES.iter().find(|it| it.code == code).unwrap()
    }

    fn names(comment: &str) -> Vec<String> {
        parse(comment).into_iter().flat_map(|it| it.names).map(|it| it.1).collect()
    }

    /// Comments are `//` to the end of the line; a line with anything else before has code.
    fn read(text: &str, statements: Vec<(u32, u32)>) -> Suppressions {
        let mut code = Code { lines: Vec::new(), statements };
        let mut comments = Vec::new();
        let mut offset = 0;
        for (line, content) in (1..).zip(text.split_inclusive('\n')) {
            let (before, comment) = match content.find("//") {
                Some(at) => (&content[..at], Some(at)),
                None => (content, None),
            };
            if !before.trim().is_empty() {
                code.lines.push(line);
            }
            if let Some(at) = comment {
                let start = TextSize::new((offset + at) as u32);
                comments.push(Comment { text: &content[at..], start, lines: (line, line) });
            }
            offset += content.len();
        }
        Suppressions::with_registry(RULES, comments, code)
    }

    fn leftovers(suppressions: &Suppressions, text: &str) -> Vec<String> {
        let all = suppressions.leftovers(RULES, |_| true);
        all.iter().map(|it| format!("{} {}", &text[it.range], it.message)).collect()
    }

    #[test]
    fn directives_are_read_out_of_comments() {
        let all = parse("(* motor; PLCLINT: Allow(W001, single-write : shared (see drawing 7)) *)");
        assert_eq!(all.len(), 1);
        assert_eq!(all[0].kind, DirectiveKind::Allow);
        assert_eq!(all[0].reason, "shared (see drawing 7)");
        assert_eq!(names("// plclint: allow(W001, single-write: x)"), ["W001", "single-write"]);
        assert_eq!(names("// plclint:allow( W )"), ["W"]);
        let two = parse("plclint: allow(W001), allow-file(J001: generated)");
        assert_eq!(two.iter().map(|it| it.kind).collect::<Vec<_>>(), [DirectiveKind::Allow, DirectiveKind::AllowFile]);
        assert!(parse("nothing here: allow(W001)").is_empty());
        assert!(parse("myplclint: allow(W001)").is_empty());
    }

    #[test]
    fn ranges_are_those_of_the_words() {
        let text = "// plclint: allow( W001 ,J001)";
        let directive = &parse(text)[0];
        let words: Vec<&str> = directive.names.iter().map(|it| &text[it.0]).collect();
        assert_eq!(words, ["W001", "J001"]);
        assert_eq!(&text[directive.range], "plclint: allow( W001 ,J001)");
    }

    #[test]
    fn what_is_malformed_is_said() {
        for text in [
            "plclint: alow(W001)",
            "plclint:",
            "plclint: allow",
            "plclint: allow(W001",
            "plclint: allow()",
            "é plclint: é",
        ] {
            let all = parse(text);
            assert_eq!(all.len(), 1, "{text}");
            assert_eq!(all[0].kind, DirectiveKind::Malformed, "{text}");
        }
    }

    #[test]
    fn a_comment_behind_code_covers_its_line() {
        let mut it = read("A\nB // plclint: allow(W001: by design)\nC\n", vec![]);
        assert_eq!(it.suppress(rule("W001"), 1), None);
        assert_eq!(it.suppress(rule("J001"), 2), None);
        assert_eq!(it.suppress(rule("W001"), 2), Some("by design"));
        assert_eq!(it.suppress(rule("W001"), 3), None);
    }

    #[test]
    fn a_comment_alone_covers_the_next_line_with_code() {
        let text = "// plclint: allow(W)\n// plclint: allow(J001)\n\nA\nB\n";
        let mut it = read(text, vec![]);
        assert_eq!(it.suppress(rule("W001"), 5), None);
        assert_eq!(it.suppress(rule("W001"), 4), Some(""));
        assert_eq!(it.suppress(rule("J001"), 4), Some(""));
        assert!(leftovers(&it, text).is_empty());
    }

    #[test]
    fn a_comment_above_a_statement_covers_it_whole() {
        let text = "// plclint: allow(W001)\nA\n// plclint: allow(J001)\nB\nC\nD\n";
        let mut it = read(text, vec![(1, 5)]);
        assert_eq!(it.suppress(rule("W001"), 5), Some(""), "the whole statement");
        assert_eq!(it.suppress(rule("J001"), 5), None, "inside the statement, one line");
        assert_eq!(it.suppress(rule("J001"), 4), Some(""));
        assert_eq!(it.suppress(rule("W001"), 6), None);
    }

    #[test]
    fn a_file_is_covered_from_anywhere() {
        let mut it = read("A\nB\n// plclint: allow-file(writes: generated)\n", vec![]);
        assert_eq!(it.suppress(rule("W001"), 1), Some("generated"));
        assert_eq!(it.suppress(rule("J001"), 1), None);
    }

    #[test]
    fn leftovers_are_reported_in_order() {
        let text = "A // plclint: allow(J001, W01, all)\n// plclint: allow(W)\nB // plclint: alow(x)\n// plclint: allow(J005)\n";
        let it = read(text, vec![]);
        assert_eq!(
            leftovers(&it, text),
            [
                "J001 this suppression of J001 (duplicate-label) suppresses nothing",
                "W01 no rule or group is called `W01`; did you mean `W001`?",
                "all `all` is no rule: a comment suppresses rules or groups by name",
                "W this suppression of `writes` suppresses nothing",
                "plclint: alow `plclint:` is followed by neither `allow(rule)` nor `allow-file(rule)`",
                "J005 this suppression of J005 (unused-label) suppresses nothing",
            ]
        );
        assert_eq!(it.leftovers(RULES, |it| it.code == "W001").len(), 4, "rules that are off are left in peace");
    }

    #[test]
    fn an_unclosed_parenthesis_takes_linear_time() {
        let text = "plclint: allow(".repeat(50_000);
        assert_eq!(parse(&text).len(), 50_000);
    }
}
