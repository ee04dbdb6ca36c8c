//! Rules for tests of selection, suppression and reports: fixed, so that a new rule changes no snapshot.

use super::finding::Severity;
use super::rule::{Check, Rule};

const PAGE: &str = "\
# the-title (T001)

## What it does

Finds a bit that several places drive by assignment.

## Why

Only the place that is scanned last holds.

## What to do instead

Drive the bit in one place, with the `OR` of the conditions.

## Limits

None.
";

const fn rule(
    code: &'static str,
    name: &'static str,
    group: &'static str,
    summary: &'static str,
    severity: Severity,
    default: bool,
    sources: &'static [&'static str],
) -> Rule {
    let check = Check::Unit(|_, _| ());
    let by_controller = false;
    Rule {
        code,
        name,
        group,
        summary,
        severity,
        default,
        by_controller,
        dialects: &["all"],
        sources,
        page: PAGE,
        check,
    }
}

pub(crate) static RULES: &[Rule] = &[
    rule("I004", "unbalanced-parentheses", "lists", "Parentheses do not match.", Severity::Error, true, &["PL7:3139"]),
    rule("J001", "duplicate-label", "jumps", "A label is defined twice.", Severity::Error, true, &["S7:315"]),
    rule("J005", "unused-label", "jumps", "No jump targets a label.", Severity::Advice, false, &["PL7:2686"]),
    rule(
        "W001",
        "single-write",
        "writes",
        "A bit is driven in several places.",
        Severity::Warning,
        true,
        &["PL72:1878", "PL7:1463"],
    ),
    rule("X003", "unused-suppression", "reading", "A comment suppresses nothing.", Severity::Warning, true, &[]),
];
