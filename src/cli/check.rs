//! `plclint check`: the main job.

use std::fs;
use std::io::{self, BufWriter, Write};
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::ValueEnum;
use rustc_hash::FxHashMap;

use super::config::Configured;
use super::read::{self, Group};
use super::{Colour, Exit, Failure, print};
use crate::db;
use crate::lint::settings::Overrides;
use crate::lint::{Diagnostic, Location, Outcome, Severity, SourceView};
use crate::load::Loader;
use crate::report::{self, Format, Options, Summary};
use crate::source::detect::Dialect;

#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// Files and folders to check, or `-` for standard input [default: the current folder]
    #[arg(value_name = "PATH")]
    paths: Vec<PathBuf>,
    #[command(flatten)]
    reading: read::Reading,
    /// Number of threads [default: one for each processor]
    #[arg(long, value_name = "N")]
    threads: Option<NonZeroUsize>,

    /// How to write findings
    #[arg(long, value_enum, default_value_t = Format::Human, help_heading = "Output")]
    format: Format,
    /// Write to a file: `FILE` takes the place of standard output, `sarif=FILE` writes another format besides; may be
    /// given more than once
    #[arg(long, short, value_name = "[FORMAT=]FILE", help_heading = "Output", value_parser = output)]
    output: Vec<Output>,
    /// Count findings by rule
    #[arg(long, help_heading = "Output")]
    statistics: bool,
    /// Leave out the last line
    #[arg(long, short, help_heading = "Output", conflicts_with = "verbose")]
    quiet: bool,
    /// Say of each file what it was read as
    #[arg(long, short, help_heading = "Output")]
    verbose: bool,
    /// Exit with 0 even when there are findings
    #[arg(long, help_heading = "Output")]
    exit_zero: bool,
    /// Exit with 0 when there are no errors and at most N warnings
    #[arg(long, value_name = "N", help_heading = "Output")]
    max_warnings: Option<usize>,

    /// Rules to run instead of those that the configuration selects: codes, names, groups, `default`, `all`
    #[arg(long, value_name = "RULES", value_delimiter = ',', help_heading = "Rules")]
    select: Option<Vec<String>>,
    /// Rules to run besides
    #[arg(long, value_name = "RULES", value_delimiter = ',', help_heading = "Rules")]
    extend_select: Vec<String>,
    /// Rules not to run
    #[arg(long, value_name = "RULES", value_delimiter = ',', help_heading = "Rules")]
    ignore: Vec<String>,
    /// Severity of a rule or group: `single-write=error`; may be given more than once
    #[arg(long, value_name = "RULE=LEVEL", help_heading = "Rules", value_parser = severity)]
    severity: Vec<(String, Severity)>,

    #[command(flatten)]
    configured: Configured,
}

fn severity(text: &str) -> Result<(String, Severity), String> {
    let (rule, level) = text.split_once('=').ok_or("write it as RULE=LEVEL: `single-write=error`")?;
    let level =
        Severity::parse(level).ok_or_else(|| format!("`{level}` is no severity: write error, warning or note"))?;
    Ok((rule.to_owned(), level))
}

/// A file to write a report to.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Output {
    /// `None` is the format of `--format`.
    format: Option<Format>,
    path: PathBuf,
}

fn output(text: &str) -> Result<Output, String> {
    if text.is_empty() {
        return Err("a file is needed".to_owned());
    }
    if let Some((format, path)) = text.split_once('=')
        && let Ok(format) = Format::from_str(format, true)
    {
        if path.is_empty() {
            return Err("a file is needed after the `=`".to_owned());
        }
        return Ok(Output { format: Some(format), path: path.into() });
    }
    Ok(Output { format: None, path: text.into() })
}

/// Reads and checks; each group is checked on its own.
fn lint(groups: Vec<Group>, dialect: Dialect, threads: Option<NonZeroUsize>) -> Result<Outcome, Failure> {
    let start = Instant::now();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.map_or(0, NonZeroUsize::get)).build();
    let pool = pool.map_err(|it| Failure::Usage(format!("the threads do not start: {it}")))?;
    let check = |group: Group| {
        let files = group.read(dialect);
        db::check_beside(files.inputs, files.unread, group.settings)
    };
    let outcomes = pool.install(|| groups.into_iter().map(check).collect());
    let mut outcome = merge(outcomes);
    outcome.unread.sort_by(|l, r| l.path.cmp(&r.path));
    outcome.unread.dedup_by(|l, r| l.path == r.path);
    outcome.elapsed = start.elapsed();
    Ok(outcome)
}

/// The outcomes of groups as one. Of a file that two groups read, the first one's findings count.
fn merge(mut outcomes: Vec<Outcome>) -> Outcome {
    if outcomes.len() <= 1 {
        return outcomes.pop().unwrap_or_default();
    }
    let mut files: Vec<(usize, usize, SourceView)> = Vec::new();
    for (group, outcome) in outcomes.iter_mut().enumerate() {
        files.extend(std::mem::take(&mut outcome.files).into_iter().enumerate().map(|(at, it)| (group, at, it)));
    }
    files.sort_by(|l, r| (&l.2.path, l.0).cmp(&(&r.2.path, r.0)));
    let mut merged = Outcome::default();
    // Where each file of each group went, and whether its findings count.
    let mut places: FxHashMap<(usize, usize), (u32, bool)> = FxHashMap::default();
    for (group, at, file) in files {
        let first = merged.files.last().is_none_or(|it| it.path != file.path);
        if first {
            merged.files.push(file);
        }
        let index = u32::try_from(merged.files.len().saturating_sub(1)).unwrap_or(u32::MAX);
        places.insert((group, at), (index, first));
    }
    for (group, outcome) in outcomes.into_iter().enumerate() {
        let place = |file: u32| places.get(&(group, file as usize)).copied();
        for it in outcome.diagnostics {
            if !place(it.finding.place.file).is_some_and(|it| it.1) {
                continue;
            }
            let name = |location: Location| place(location.file).map(|it| Location { file: it.0, ..location });
            let (entity, family, suppressed) = (it.entity, it.family, it.suppressed);
            let finding = it.finding.map(name);
            merged.diagnostics.extend(finding.map(|finding| Diagnostic { finding, entity, family, suppressed }));
        }
        merged.unread.extend(outcome.unread);
        merged.active.extend(outcome.active);
        merged.untargeted.extend(outcome.untargeted);
        merged.internal_errors.extend(outcome.internal_errors);
    }
    // The findings of a file all come from one group, in order.
    merged.diagnostics.sort_by_key(|it| it.finding.place.file);
    merged.untargeted.sort_unstable();
    merged.untargeted.dedup();
    merged.active.sort_by_key(|it| it.code);
    merged.active.dedup_by_key(|it| it.code);
    merged
}

pub(super) fn run(mut arguments: Arguments, colour: Colour) -> Result<Exit, Failure> {
    let overrides = Overrides {
        select: arguments.select.take(),
        extend_select: std::mem::take(&mut arguments.extend_select),
        ignore: std::mem::take(&mut arguments.ignore),
        severity: std::mem::take(&mut arguments.severity),
        controller: arguments.reading.target.take(),
        encoding: arguments.reading.encoding.take(),
    };
    let mut loader = Loader::new(arguments.configured.source(), overrides)?;
    let groups = read::groups(&arguments.paths, arguments.reading.stdin_filename.as_deref(), &mut loader)?;
    let outcome = lint(groups, arguments.reading.dialect, arguments.threads)?;
    let options = Options { colour: false, root: Some(loader.current().to_owned()) };
    report(&arguments, &outcome, &options, colour)?;
    Ok(exit(&outcome, arguments.exit_zero, arguments.max_warnings))
}

fn report(arguments: &Arguments, outcome: &Outcome, options: &Options, colour: Colour) -> Result<(), Failure> {
    for output in &arguments.output {
        let format = output.format.unwrap_or(arguments.format);
        write_file(&output.path, |out| report::write(format, outcome, options, out))?;
    }
    let on_stdout = arguments.output.iter().all(|it| it.format.is_some());
    if on_stdout {
        let options = Options { colour: colour.stdout(), ..options.clone() };
        print(|out| report::write(arguments.format, outcome, &options, out))?;
    }
    // A document for programs is kept clean of what follows it.
    if on_stdout && !arguments.format.is_text() {
        let mut out = BufWriter::new(io::stderr().lock());
        match write_tail(arguments, outcome, &mut out).and_then(|()| out.flush()) {
            Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(error.into()),
            _ => Ok(()),
        }
    } else {
        print(|out| write_tail(arguments, outcome, out))
    }
}

/// What follows the findings.
fn write_tail(arguments: &Arguments, outcome: &Outcome, out: &mut dyn Write) -> io::Result<()> {
    if arguments.verbose {
        for file in &outcome.files {
            let understood = file.text.len().saturating_sub(file.not_understood);
            let percent = (understood * 100).checked_div(file.text.len()).unwrap_or(100);
            writeln!(out, "{}: {}, {}, {percent} % understood", file.path, file.dialect, file.encoding)?;
        }
    }
    if arguments.statistics {
        report::write_statistics(outcome, out)?;
    }
    if !arguments.quiet {
        writeln!(out, "{}", Summary::of(outcome).line(Some(outcome.elapsed)))?;
    }
    Ok(())
}

fn write_file(path: &Path, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), Failure> {
    let fail = |it: io::Error| Failure::Usage(format!("{}: the report cannot be written: {it}", path.display()));
    let mut out = BufWriter::new(fs::File::create(path).map_err(fail)?);
    write(&mut out).and_then(|()| out.flush()).map_err(fail)
}

fn exit(outcome: &Outcome, exit_zero: bool, max_warnings: Option<usize>) -> Exit {
    if !outcome.internal_errors.is_empty() {
        return Exit::Internal;
    }
    let summary = Summary::of(outcome);
    if !exit_zero && (summary.errors > 0 || summary.warnings > max_warnings.unwrap_or(0)) {
        Exit::Findings
    } else {
        Exit::Clean
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::testing::sample;

    #[test]
    fn an_output_is_a_file_with_or_without_a_format() {
        let format = |text: &str| output(text).map(|it| (it.format, it.path.display().to_string()));
        assert_eq!(format("sarif=out.sarif"), Ok((Some(Format::Sarif), "out.sarif".into())));
        assert_eq!(format("a=b.txt"), Ok((None, "a=b.txt".into())), "not a format");
        assert_eq!(format("out.json"), Ok((None, "out.json".into())));
        assert!(format("json=").is_err() && format("").is_err());
    }

    #[test]
    fn a_severity_belongs_to_a_rule() {
        assert_eq!(severity("single-write=error"), Ok(("single-write".into(), Severity::Error)));
        assert!(severity("single-write").is_err());
        assert!(severity("single-write=fatal").is_err());
    }

    #[test]
    fn the_exit_code_says_what_was_found() {
        let mut outcome = sample();
        assert_eq!(exit(&outcome, false, None), Exit::Findings);
        assert_eq!(exit(&outcome, true, None), Exit::Clean);
        assert_eq!(exit(&outcome, false, Some(9)), Exit::Findings, "errors fail whatever the warnings");
        outcome.diagnostics.retain(|it| it.finding.severity == Severity::Warning);
        assert_eq!(exit(&outcome, false, None), Exit::Findings);
        assert_eq!(exit(&outcome, false, Some(1)), Exit::Clean);
        assert_eq!(exit(&outcome, false, Some(0)), Exit::Findings);
        outcome.diagnostics = sample().diagnostics;
        outcome.diagnostics.retain(|it| it.finding.severity == Severity::Advice);
        assert_eq!(exit(&outcome, false, None), Exit::Clean, "advice does not fail");
        outcome.internal_errors.push("J001".into());
        assert_eq!(exit(&outcome, true, None), Exit::Internal);
        assert_eq!(exit(&Outcome::default(), false, None), Exit::Clean);
    }

    #[test]
    fn groups_are_reported_as_one() {
        let one = sample();
        let mut other = sample();
        other.files[1].path = "line0/z.awl".into();
        let merged = merge(vec![sample(), other]);
        let paths: Vec<&str> = merged.files.iter().map(|it| it.path.as_str()).collect();
        assert_eq!(paths, ["line0/z.awl", "line1/a b.awl", "line1/b.awl"]);
        let places: Vec<u32> = merged.diagnostics.iter().map(|it| it.finding.place.file).collect();
        assert_eq!(places, [0, 0, 0, 1, 1, 2, 2, 2], "a file that both have counts once");
        assert_eq!(merged.diagnostics[3].finding.related[0].place.file, 2);
        assert_eq!(merged.active.len(), one.active.len());
    }

    #[test]
    fn a_suppressed_finding_does_not_fail() {
        let mut outcome = sample();
        for it in &mut outcome.diagnostics {
            it.suppressed = Some(String::new());
        }
        assert_eq!(exit(&outcome, false, None), Exit::Clean);
    }
}
