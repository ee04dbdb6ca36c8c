//! A line for each finding: `path:line:column: W001[single-write] warning: message [entity]`.

use std::io;

use super::position::Positions;
use super::{Options, human, visible};
use crate::lint::{Outcome, UnreadReason};

pub(super) fn write(outcome: &Outcome, options: &Options, out: &mut dyn io::Write) -> io::Result<()> {
    let positions = Positions::new(outcome);
    for diagnostic in outcome.diagnostics.iter().filter(|it| it.suppressed.is_none()) {
        let finding = &diagnostic.finding;
        let (Some(file), Some(span)) =
            (positions.file(finding.place.file), positions.span(finding.place.file, finding.place.range))
        else {
            continue;
        };
        let entry = positions.entry(finding.place.file, finding.place.range);
        let (at, entity) = match entry {
            Some(entry) => (String::new(), entry.to_string()),
            None => (format!("{}:{}:", span.start.line, span.start.column), diagnostic.entity.clone()),
        };
        let style = if options.colour { human::style(finding.severity) } else { anstyle::Style::new() };
        writeln!(
            out,
            "{}:{at} {style}{}[{}] {}{style:#}: {} [{}]",
            visible(&file.path),
            finding.rule.code,
            finding.rule.name,
            finding.severity.as_str(),
            visible(&finding.message),
            visible(&entity),
        )?;
    }
    for unread in &outcome.unread {
        let path = visible(&unread.path);
        match &unread.reason {
            UnreadReason::Io(error) => writeln!(out, "{path}: not read: {}", visible(error))?,
            UnreadReason::Unsupported(kind) => writeln!(out, "{path}: not read: {} is not supported", visible(kind))?,
            UnreadReason::NotPlc => {}
        }
    }
    for error in &outcome.internal_errors {
        writeln!(out, "internal error: {}", visible(error))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::report::testing::sample;
    use crate::report::{Format, Options, write};

    #[test]
    fn a_finding_is_a_line() {
        let mut out = Vec::new();
        write(Format::Concise, &sample(), &Options::default(), &mut out).unwrap();
        insta::assert_snapshot!(String::from_utf8(out).unwrap(), @r"
        line1/a b.awl:3:3: W001[single-write] warning: «Ventil» (A 4.0) is driven in 2 places [FC1]
        line1/a b.awl:4:5: J001[duplicate-label] error: label M999 is defined twice [FC1]
        line1/b.awl:4:1: J005[unused-label] note: no jump targets X0 [FC1]
        line1/b.awl:4:5: I004[unbalanced-parentheses] error: `)` closes nothing [FC1]
        line1/a.ld: not read: PL7 ladder (.LD) is not supported
        line1/c.awl: not read: permission denied
        ");
    }
}
