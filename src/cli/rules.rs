//! `plclint rules`: the list of rules.

use std::io::{self, Write};

use clap::ValueEnum;
use serde::Serialize;

use super::{Exit, Failure, print};
use crate::lint::{Rule, rules};

#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// How to write the list
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Format {
    /// A line for each rule
    Text,
    /// An array, for other programs
    Json,
    /// A table for each group
    Markdown,
}

pub(super) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    print(|out| write(arguments.format, rules(), out))?;
    Ok(Exit::Clean)
}

fn write(format: Format, rules: &[Rule], out: &mut dyn Write) -> io::Result<()> {
    match format {
        Format::Text => text(rules, out),
        Format::Json => json(rules, out),
        Format::Markdown => markdown(rules, out),
    }
}

fn text(rules: &[Rule], out: &mut dyn Write) -> io::Result<()> {
    let width = rules.iter().map(|it| it.name.len()).max().unwrap_or(0);
    for rule in rules {
        let severity = rule.severity.as_str();
        let off = if rule.default { "" } else { " (off by default)" };
        writeln!(out, "{}  {:width$}  {severity:7}  {}{off}", rule.code, rule.name, rule.summary)?;
    }
    Ok(())
}

#[derive(Serialize)]
struct View<'a> {
    code: &'a str,
    name: &'a str,
    group: &'a str,
    summary: &'a str,
    severity: &'a str,
    default: bool,
    dialects: &'a [&'a str],
    sources: &'a [&'a str],
}

fn json(rules: &[Rule], out: &mut dyn Write) -> io::Result<()> {
    let views: Vec<View<'_>> = rules
        .iter()
        .map(|it| View {
            code: it.code,
            name: it.name,
            group: it.group,
            summary: it.summary,
            severity: it.severity.as_str(),
            default: it.default,
            dialects: it.dialects,
            sources: it.sources,
        })
        .collect();
    serde_json::to_writer_pretty(&mut *out, &views).map_err(io::Error::from)?;
    writeln!(out)
}

fn markdown(rules: &[Rule], out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "# Rules")?;
    let mut group = "";
    for rule in rules {
        if rule.group != group {
            group = rule.group;
            writeln!(out, "\n## {group}\n\n| code | name | severity | for | what |\n|---|---|---|---|---|")?;
        }
        let severity = rule.severity.as_str();
        let off = if rule.default { "" } else { ", off by default" };
        let summary = rule.summary.replace('|', "\\|");
        let dialects = rule.dialects.join(" ");
        writeln!(out, "| {} | {} | {severity}{off} | {dialects} | {summary} |", rule.code, rule.name)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lint::testing::RULES;

    fn render(format: Format) -> String {
        let mut out = Vec::new();
        write(format, RULES, &mut out).unwrap();
        String::from_utf8(out).unwrap()
    }

    #[test]
    fn a_rule_is_a_line() {
        insta::assert_snapshot!(render(Format::Text), @r"
        I004  unbalanced-parentheses  error    Parentheses do not match.
        J001  duplicate-label         error    A label is defined twice.
        J005  unused-label            note     No jump targets a label. (off by default)
        W001  single-write            warning  A bit is driven in several places.
        X003  unused-suppression      warning  A comment suppresses nothing.
        ");
    }

    #[test]
    fn a_group_is_a_table() {
        insta::assert_snapshot!(render(Format::Markdown), @r"
        # Rules

        ## lists

        | code | name | severity | for | what |
        |---|---|---|---|---|
        | I004 | unbalanced-parentheses | error | all | Parentheses do not match. |

        ## jumps

        | code | name | severity | for | what |
        |---|---|---|---|---|
        | J001 | duplicate-label | error | all | A label is defined twice. |
        | J005 | unused-label | note, off by default | all | No jump targets a label. |

        ## writes

        | code | name | severity | for | what |
        |---|---|---|---|---|
        | W001 | single-write | warning | all | A bit is driven in several places. |

        ## reading

        | code | name | severity | for | what |
        |---|---|---|---|---|
        | X003 | unused-suppression | warning | all | A comment suppresses nothing. |
        ");
    }

    #[test]
    fn programs_get_every_key() {
        let rules: serde_json::Value = serde_json::from_str(&render(Format::Json)).unwrap();
        assert_eq!(rules[3]["name"], "single-write");
        assert_eq!(rules[3]["sources"], serde_json::json!(["PL72:1878", "PL7:1463"]));
        assert_eq!(rules.as_array().map(Vec::len), Some(RULES.len()));
    }
}
