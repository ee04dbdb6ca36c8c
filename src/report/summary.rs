//! The last line of a run: what was read, how much of it was understood, what was found.

use std::fmt::Write as _;
use std::io;
use std::time::Duration;

use rustc_hash::FxHashMap;

use super::position::count_lines;
use crate::lint::{Outcome, Rule, Severity, UnreadReason};
use crate::model::entity::Family;

/// The counts of a run.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Summary {
    pub files: usize,
    /// Programs and blocks.
    pub entities: usize,
    pub lines: usize,
    /// Bytes of decoded text.
    pub bytes: usize,
    /// Bytes in units of a language that is not read yet, or that the syntax could not place.
    pub not_understood: usize,
    pub errors: usize,
    pub warnings: usize,
    pub notes: usize,
    /// Findings that a comment or a baseline suppresses; not among the three above.
    pub suppressed: usize,
    /// Files that the operating system did not let us read.
    pub unreadable: usize,
    /// PLC files of kinds that are not read, by name and number, in the order of names.
    pub unsupported: Vec<(String, usize)>,
    /// Files that are no PLC programs.
    pub not_plc: usize,
    pub internal_errors: usize,
    /// PL7 projects, of which the tables are read and the code is not, and those among them without a cross-reference.
    pub projects: usize,
    /// Files that were checked one by one, because they define the same parts as others of their folder.
    pub variants: usize,
    pub without_reference: usize,
    /// Families that were checked for no controller in particular, though some rule would find more for one.
    pub untargeted: Vec<Family>,
}

impl Summary {
    pub fn of(outcome: &Outcome) -> Self {
        let mut it = Self {
            internal_errors: outcome.internal_errors.len(),
            untargeted: outcome.untargeted.clone(),
            ..Self::default()
        };
        for file in outcome.files.iter().filter(|it| !it.is_configuration) {
            it.files += 1;
            it.entities += file.entities;
            it.variants += usize::from(file.is_variant);
            if let Some(made_of) = file.made_of {
                it.projects += 1;
                it.without_reference += usize::from(!made_of.cross_reference);
            } else {
                it.lines += count_lines(&file.text);
            }
            it.bytes += file.text.len();
            it.not_understood += file.not_understood.min(file.text.len());
        }
        for diagnostic in &outcome.diagnostics {
            let count = match (&diagnostic.suppressed, diagnostic.finding.severity) {
                (Some(_), _) => &mut it.suppressed,
                (None, Severity::Error) => &mut it.errors,
                (None, Severity::Warning) => &mut it.warnings,
                (None, Severity::Advice) => &mut it.notes,
            };
            *count += 1;
        }
        let mut unsupported: FxHashMap<&str, usize> = FxHashMap::default();
        for unread in &outcome.unread {
            match &unread.reason {
                UnreadReason::Io(_) => it.unreadable += 1,
                UnreadReason::Unsupported(kind) => *unsupported.entry(kind).or_default() += 1,
                UnreadReason::NotPlc => it.not_plc += 1,
            }
        }
        it.unsupported = unsupported.into_iter().map(|(kind, count)| (kind.to_owned(), count)).collect();
        it.unsupported.sort();
        it
    }

    /// Share of the text that was understood, in tenths of a percent, rounded down: 1000 means every byte. `None`
    /// when nothing was read.
    pub fn understood_permille(&self) -> Option<usize> {
        let understood = self.bytes.saturating_sub(self.not_understood);
        (self.bytes > 0).then(|| (understood as u128 * 1000 / self.bytes as u128) as usize)
    }

    /// One sentence without an end of line. `elapsed` is left out when it would make a report differ between runs.
    pub fn line(&self, elapsed: Option<Duration>) -> String {
        let mut out = format!(
            "{}, {}, {} read",
            count(self.files, "file", "files"),
            count(self.entities, "program or block", "programs and blocks"),
            count(self.lines, "line", "lines"),
        );
        if let Some(elapsed) = elapsed {
            put(&mut out, format_args!(" in {:.2} s", elapsed.as_secs_f64()));
        }
        if let Some(permille) = self.understood_permille() {
            match permille % 10 {
                0 => put(&mut out, format_args!(", {} % understood", permille / 10)),
                tenth => put(&mut out, format_args!(", {}.{tenth} % understood", permille / 10)),
            }
        }
        let found =
            [(self.errors, "error", "errors"), (self.warnings, "warning", "warnings"), (self.notes, "note", "notes")];
        let found: Vec<String> = found.into_iter().filter(|it| it.0 > 0).map(|it| count(it.0, it.1, it.2)).collect();
        put(&mut out, format_args!("; {}", if found.is_empty() { "no findings".to_owned() } else { found.join(", ") }));
        if self.suppressed > 0 {
            put(&mut out, format_args!(" ({} suppressed)", grouped(self.suppressed)));
        }
        let mut left_out = Vec::new();
        if self.unreadable > 0 {
            left_out.push(format!("{} unreadable", grouped(self.unreadable)));
        }
        left_out.extend(self.unsupported.iter().map(|(kind, count)| format!("{} × {kind}", grouped(*count))));
        if self.not_plc > 0 {
            left_out.push(format!("{} not PLC programs", grouped(self.not_plc)));
        }
        if !left_out.is_empty() {
            put(&mut out, format_args!("; left out: {}", left_out.join(", ")));
        }
        if self.projects > 0 {
            let projects = count(self.projects, "PL7 project", "PL7 projects");
            put(&mut out, format_args!("; of {projects} the cross-reference is read, not the code"));
            if self.without_reference > 0 {
                put(&mut out, format_args!(" (not available in {})", grouped(self.without_reference)));
            }
        }
        if self.variants > 0 {
            let files = count(self.variants, "file defines", "files define");
            put(
                &mut out,
                format_args!("; {files} what others of the folder define too, and each was checked by itself"),
            );
        }
        if !self.untargeted.is_empty() {
            let families: Vec<&str> = self.untargeted.iter().map(|it| it.as_str()).collect();
            put(
                &mut out,
                format_args!(
                    "; no controller given for {}: only limits that all share were checked",
                    families.join(" and ")
                ),
            );
        }
        if self.internal_errors > 0 {
            let errors = count(self.internal_errors, "internal error", "internal errors");
            put(&mut out, format_args!("; {errors}"));
        }
        out
    }
}

fn put(out: &mut String, text: std::fmt::Arguments<'_>) {
    // Writing to a string does not fail.
    let _ = out.write_fmt(text);
}

fn count(number: usize, one: &str, many: &str) -> String {
    format!("{} {}", grouped(number), if number == 1 { one } else { many })
}

/// `12 345`: thousands apart, from five digits on.
fn grouped(number: usize) -> String {
    let digits = number.to_string();
    if digits.len() < 5 {
        return digits;
    }
    let mut out = String::new();
    for (at, digit) in digits.chars().enumerate() {
        if at > 0 && (digits.len() - at).is_multiple_of(3) {
            out.push(' ');
        }
        out.push(digit);
    }
    out
}

/// Findings per rule, most frequent first: the table of `--statistics`. Suppressed findings do not count.
pub fn write_statistics(outcome: &Outcome, out: &mut dyn io::Write) -> io::Result<()> {
    let mut counts: FxHashMap<&str, (usize, &Rule)> = FxHashMap::default();
    for diagnostic in outcome.diagnostics.iter().filter(|it| it.suppressed.is_none()) {
        let rule = diagnostic.finding.rule;
        counts.entry(rule.code).or_insert((0, rule)).0 += 1;
    }
    let mut counts: Vec<(usize, &Rule)> = counts.into_values().collect();
    counts.sort_by(|l, r| r.0.cmp(&l.0).then_with(|| l.1.code.cmp(r.1.code)));
    let width = counts.first().map_or(0, |it| it.0.to_string().len());
    for (count, rule) in counts {
        writeln!(out, "{count:>width$}  {}  {}", rule.code, rule.name)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::testing::{empty, sample};

    #[test]
    fn a_run_is_told_in_one_line() {
        insta::assert_snapshot!(
            Summary::of(&sample()).line(Some(Duration::from_millis(1234))),
            @"2 files, 4 programs and blocks, 10 lines read in 1.23 s, 100 % understood; 2 errors, 1 warning, 1 note (1 suppressed); left out: 1 unreadable, 1 × PL7 ladder (.LD), 1 not PLC programs"
        );
        insta::assert_snapshot!(Summary::of(&empty()).line(None), @"0 files, 0 programs and blocks, 0 lines read; no findings");
    }

    #[test]
    fn it_says_when_the_controller_is_missing() {
        let summary =
            |untargeted: &[Family]| Summary { untargeted: untargeted.to_vec(), ..Summary::default() }.line(None);
        let both = summary(&[Family::Pl7, Family::Step7]);
        assert!(
            both.ends_with("; no controller given for PL7 and STEP 7: only limits that all share were checked"),
            "{both}"
        );
        assert!(summary(&[Family::Pl7]).contains(" for PL7: "));
        assert!(!summary(&[]).contains("controller"));
    }

    #[test]
    fn it_says_what_was_not_put_together() {
        let line = |variants| Summary { variants, ..Summary::default() }.line(None);
        assert!(
            line(2).ends_with("; 2 files define what others of the folder define too, and each was checked by itself")
        );
        assert!(!line(0).contains("by itself"));
    }

    #[test]
    fn one_byte_in_a_million_is_not_everything() {
        let summary = Summary { bytes: 1_000_000, not_understood: 1, ..Summary::default() };
        assert_eq!(summary.understood_permille(), Some(999));
        assert!(summary.line(None).contains("99.9 % understood"));
        assert!(Summary { bytes: 7, ..Summary::default() }.line(None).contains("100 % understood"));
    }

    #[test]
    fn thousands_stand_apart() {
        assert_eq!([0, 999, 1000, 12345, 1234567].map(grouped), ["0", "999", "1000", "12 345", "1 234 567"]);
    }

    #[test]
    fn statistics_put_the_most_frequent_first() {
        let mut out = Vec::new();
        write_statistics(&sample(), &mut out).unwrap();
        insta::assert_snapshot!(String::from_utf8(out).unwrap(), @r"
        1  I004  unbalanced-parentheses
        1  J001  duplicate-label
        1  J005  unused-label
        1  W001  single-write
        ");
    }
}
