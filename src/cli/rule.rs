//! `plclint rule W001`: the page of a rule, for a terminal.

use std::io::{self, Write};

use anstyle::{AnsiColor, Style};

use super::{Colour, Exit, Failure, print};
use crate::lint::{Rule, find, nearest, rules};
use crate::report::citation;

#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// Code or name: `W001`, `single-write`
    rule: String,
}

pub(super) fn run(arguments: &Arguments, colour: Colour) -> Result<Exit, Failure> {
    let word = arguments.rule.trim();
    let Some(rule) = find(word) else {
        let names = rules().iter().flat_map(|it| [it.name, it.code]);
        return Err(Failure::Usage(match nearest(word, names) {
            Some(nearest) => format!("no rule is called `{word}`; did you mean `{nearest}`?"),
            None => format!("no rule is called `{word}`; `plclint rules` lists them"),
        }));
    };
    let styles = if colour.stdout() { Styles::coloured() } else { Styles::default() };
    print(|out| write(rule, &styles, out))?;
    Ok(Exit::Clean)
}

#[derive(Default)]
struct Styles {
    title: Style,
    heading: Style,
    code: Style,
    strong: Style,
    dim: Style,
}

impl Styles {
    fn coloured() -> Self {
        Self {
            title: Style::new().bold().underline(),
            heading: Style::new().bold(),
            code: AnsiColor::Cyan.on_default(),
            strong: Style::new().bold(),
            dim: Style::new().dimmed(),
        }
    }
}

fn write(rule: &Rule, styles: &Styles, out: &mut dyn Write) -> io::Result<()> {
    let Styles { title, dim, .. } = styles;
    writeln!(out, "{title}{} {}{title:#}", rule.code, rule.name)?;
    writeln!(out)?;
    writeln!(out, "{}", inline(rule.summary, styles))?;
    let off = if rule.default { "" } else { ", off by default" };
    let group = rule.group;
    writeln!(out, "{dim}{}{off}, group {group}, for {}{dim:#}", rule.severity.as_str(), rule.dialects.join(", "))?;
    for source in rule.sources {
        writeln!(out, "{dim}source: {}{dim:#}", citation(source))?;
    }
    writeln!(out)?;
    page(rule.body(), styles, out)
}

/// The Markdown of a page: headings, code and stress get a style, fenced code is set in.
fn page(text: &str, styles: &Styles, out: &mut dyn Write) -> io::Result<()> {
    let Styles { heading, code, dim, .. } = styles;
    let mut fence: Option<&str> = None;
    for line in text.trim().lines() {
        let trimmed = line.trim_start();
        if let Some(open) = fence {
            if trimmed.trim_end() == open {
                fence = None;
            } else {
                writeln!(out, "    {code}{line}{code:#}")?;
            }
        } else if trimmed.starts_with("```") {
            let ticks = trimmed.len() - trimmed.trim_start_matches('`').len();
            let (ticks, info) = trimmed.split_at(ticks);
            fence = Some(ticks);
            match info.trim().split_once(',') {
                Some((language, "bad")) => writeln!(out, "    {dim}{language}, a finding:{dim:#}")?,
                Some((language, "good")) => writeln!(out, "    {dim}{language}, no finding:{dim:#}")?,
                _ => {}
            }
        } else if line.starts_with('#') {
            writeln!(out, "{heading}{}{heading:#}", line.trim_start_matches('#').trim())?;
        } else {
            writeln!(out, "{}", inline(line, styles))?;
        }
    }
    Ok(())
}

/// `code` and **stress** of one line. Marks without a partner stay as they are.
fn inline(line: &str, styles: &Styles) -> String {
    let Styles { code, strong, .. } = styles;
    let plain = *code == Style::new();
    let mut out = String::with_capacity(line.len());
    let mut rest = line;
    while let Some(at) = rest.find(['`', '*']) {
        let (before, mark) = rest.split_at(at);
        out.push_str(before);
        let (delimiter, style) = if mark.starts_with('`') {
            ("`", code)
        } else if mark.starts_with("**") {
            ("**", strong)
        } else {
            out.push('*');
            rest = &mark[1..];
            continue;
        };
        let inner = &mark[delimiter.len()..];
        let Some(end) = inner.find(delimiter) else {
            out.push_str(delimiter);
            rest = inner;
            continue;
        };
        let text = &inner[..end];
        if plain {
            // Without colour the backticks say what is code.
            let quote = if delimiter == "`" { "`" } else { "" };
            out.push_str(&format!("{quote}{text}{quote}"));
        } else {
            out.push_str(&format!("{style}{text}{style:#}"));
        }
        rest = &inner[end + delimiter.len()..];
    }
    out.push_str(rest);
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lint::testing::RULES;

    #[test]
    fn a_page_is_read_in_a_terminal() {
        let mut out = Vec::new();
        write(&RULES[3], &Styles::default(), &mut out).unwrap();
        insta::assert_snapshot!(String::from_utf8(out).unwrap());
    }

    #[test]
    fn markdown_is_rendered_lightly() {
        let mut out = Vec::new();
        let text = "## Head\n- a `b` **c** * d `e\n```awl,bad\n# U E 0.0\n```\nend";
        page(text, &Styles::default(), &mut out).unwrap();
        assert_eq!(
            String::from_utf8(out).unwrap(),
            "Head\n- a `b` c * d `e\n    awl, a finding:\n    # U E 0.0\nend\n"
        );
        let coloured = inline("a `b` **c**", &Styles::coloured());
        assert_eq!(coloured, "a \u{1b}[36mb\u{1b}[0m \u{1b}[1mc\u{1b}[0m");
    }
}
