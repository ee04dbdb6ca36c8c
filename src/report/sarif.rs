//! SARIF 2.1.0, with everything that GitHub code scanning reads.
//!
//! The document holds no time and no machine name: the same input gives the same bytes in the same folder.

use std::collections::BTreeMap;
use std::io;
use std::path::Path;

use rustc_hash::FxHashMap;
use serde_json::{Value, json};
use serde_sarif::sarif::{
    Artifact, ArtifactChange, ArtifactContent, ArtifactLocation, Fix, Invocation, Location, LogicalLocation, Message,
    MultiformatMessageString, Notification, PhysicalLocation, PropertyBag, Region, Replacement, ReportingConfiguration,
    ReportingDescriptor, ReportingDescriptorReference, Result as SarifResult, ResultLevel, Run, RunAutomationDetails,
    Sarif, Suppression, Tool, ToolComponent,
};

use super::fingerprint::{Fingerprints, length};
use super::position::{Entry, Positions, Span, clamp};
use super::{Options, citation};
use crate::lint::{self, Applicability, Diagnostic, Outcome, Rule, Severity, UnreadReason};

const SCHEMA: &str = "https://json.schemastore.org/sarif-2.1.0.json";
/// What relative paths are relative to.
const ROOT: &str = "%SRCROOT%";
/// Longest description that code scanning takes.
const DESCRIPTION_LIMIT: usize = 1024;
/// Longest place that is quoted, in bytes.
const SNIPPET_LIMIT: usize = 400;
/// Most places of one finding that code scanning takes.
const RELATED_LIMIT: usize = 1000;

pub(super) fn write(outcome: &Outcome, options: &Options, out: &mut dyn io::Write) -> io::Result<()> {
    let log = Sarif::builder().schema(SCHEMA).version(json!("2.1.0")).runs(vec![run(outcome, options)]).build();
    serde_json::to_writer_pretty(&mut *out, &log).map_err(io::Error::from)?;
    writeln!(out)
}

struct Cx<'a> {
    outcome: &'a Outcome,
    positions: Positions<'a>,
    root: Option<&'a Path>,
    /// Index of each rule in the driver's list, by code.
    rules: FxHashMap<&'static str, i64>,
    fingerprints: FxHashMap<u32, Fingerprints>,
}

fn run(outcome: &Outcome, options: &Options) -> Run {
    let rules = rules(outcome);
    let mut cx = Cx {
        outcome,
        positions: Positions::new(outcome),
        root: options.root.as_deref(),
        rules: rules.iter().zip(0..).map(|(rule, index)| (rule.code, index)).collect(),
        fingerprints: FxHashMap::default(),
    };
    let results: Vec<SarifResult> = outcome.diagnostics.iter().filter_map(|it| cx.result(it)).collect();
    let artifacts: Vec<Artifact> = (0..).zip(&outcome.files).map(|(index, _)| cx.artifact(index)).collect();
    let mut driver = ToolComponent::builder()
        .name(env!("CARGO_PKG_NAME"))
        .version(env!("CARGO_PKG_VERSION"))
        .semantic_version(env!("CARGO_PKG_VERSION"))
        .rules(rules.into_iter().map(descriptor).collect::<Vec<_>>())
        .notifications(notification_kinds())
        .build();
    driver.information_uri = home().map(str::to_owned);
    let mut root = ArtifactLocation::builder().description(message("The folder that the run was started in.")).build();
    root.uri = cx.root.map(folder_uri);
    Run::builder()
        .tool(Tool::builder().driver(driver).build())
        .column_kind(json!("unicodeCodePoints"))
        .automation_details(RunAutomationDetails::builder().id(concat!(env!("CARGO_PKG_NAME"), "/")).build())
        .original_uri_base_ids(BTreeMap::from([(ROOT.to_owned(), root)]))
        .invocations(vec![cx.invocation()])
        .artifacts(artifacts)
        .results(results)
        .build()
}

/// The rules that were switched on, and those of the findings, in the order of codes.
fn rules(outcome: &Outcome) -> Vec<&'static Rule> {
    let of_findings = outcome.diagnostics.iter().map(|it| it.finding.rule);
    let by_code: BTreeMap<&str, &'static Rule> =
        outcome.active.iter().copied().chain(of_findings).map(|it| (it.code, it)).collect();
    by_code.into_values().collect()
}

/// The project's page, when its manifest names one.
fn home() -> Option<&'static str> {
    option_env!("CARGO_PKG_REPOSITORY").filter(|it| !it.is_empty())
}

fn level(severity: Severity) -> ResultLevel {
    match severity {
        Severity::Error => ResultLevel::Error,
        Severity::Warning => ResultLevel::Warning,
        Severity::Advice => ResultLevel::Note,
    }
}

fn message(text: impl Into<String>) -> Message {
    Message::builder().text(text).build()
}

fn short(text: &str) -> String {
    match text.char_indices().nth(DESCRIPTION_LIMIT) {
        Some(_) => text.chars().take(DESCRIPTION_LIMIT - 1).chain(['…']).collect(),
        None => text.to_owned(),
    }
}

/// The first text that says something.
fn first<'a>(texts: &[&'a str]) -> &'a str {
    texts.iter().copied().find(|it| !it.trim().is_empty()).unwrap_or("-")
}

fn multiformat(text: impl Into<String>) -> MultiformatMessageString {
    MultiformatMessageString::builder().text(text).build()
}

fn descriptor(rule: &'static Rule) -> ReportingDescriptor {
    let summary = first(&[rule.summary, rule.name]);
    let sources: Vec<String> = rule.sources.iter().map(|it| citation(it)).collect();
    let mut help = first(&[rule.help(), summary]).to_owned();
    if !sources.is_empty() {
        help = format!("{help}\n\nSource: {}.", sources.join("; "));
    }
    let markdown = format!("# {} {}\n\n{summary}\n\n{}", rule.code, rule.name, rule.body());
    let severity = match rule.severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Advice => "recommendation",
    };
    // What a source forbids is so; what it warns against may be meant.
    let precision = match rule.severity {
        Severity::Error => "very-high",
        Severity::Warning | Severity::Advice => "high",
    };
    let mut tags = vec![rule.group.to_owned()];
    // A tag stands once: the groups `il` and `st` are named after their dialects.
    let dialects = rule.dialects.iter().filter(|&&it| it != "all" && it != rule.group);
    tags.extend(dialects.map(|it| (*it).to_owned()));
    let properties = PropertyBag::builder()
        .tags(tags)
        .additional_properties(BTreeMap::from([
            ("precision".to_owned(), json!(precision)),
            ("problem.severity".to_owned(), json!(severity)),
        ]))
        .build();
    let mut descriptor = ReportingDescriptor::builder()
        .id(rule.code)
        .name(rule.name)
        .short_description(multiformat(short(summary)))
        .full_description(multiformat(short(first(&[rule.what(), summary]))))
        .help(MultiformatMessageString::builder().text(help).markdown(markdown).build())
        .default_configuration(
            ReportingConfiguration::builder().enabled(rule.default).level(json!(rule.severity.as_str())).build(),
        )
        .properties(properties)
        .build();
    descriptor.help_uri = home().map(|it| format!("{it}/blob/main/rules/{}/{}.md", rule.group, rule.name));
    descriptor
}

/// The module of a project and the entry in it.
fn logical_of(entry: &Entry<'_>) -> Vec<LogicalLocation> {
    let name = entry.text;
    vec![LogicalLocation::builder().name(name).fully_qualified_name(entry.to_string()).kind("member").build()]
}

const UNREADABLE: &str = "unreadable-file";
const UNSUPPORTED: &str = "unsupported-file";
const INTERNAL: &str = "internal-error";

fn notification_kinds() -> Vec<ReportingDescriptor> {
    let kind = |id: &str, name: &str, level: &str, text: &str, help: &str| {
        ReportingDescriptor::builder()
            .id(id)
            .name(name)
            .short_description(multiformat(text))
            .full_description(multiformat(text))
            .help(multiformat(help))
            .default_configuration(ReportingConfiguration::builder().level(json!(level)).build())
            .build()
    };
    vec![
        kind(
            UNREADABLE,
            "UnreadableFile",
            "warning",
            "The operating system did not let the program read a file.",
            "Let the user who runs the program read the file, or exclude it in plclint.toml.",
        ),
        kind(
            UNSUPPORTED,
            "UnsupportedFile",
            "note",
            "A PLC file is of a kind that the program does not read.",
            "Export the program in a form that is read, or exclude the file in plclint.toml.",
        ),
        kind(
            INTERNAL,
            "InternalError",
            "error",
            "A rule failed; the run went on without it.",
            "Report the failure with the file that was checked.",
        ),
    ]
}

/// A path as a URI reference, its parts percent-encoded.
fn encode(path: &str) -> String {
    let mut uri = String::with_capacity(path.len());
    for byte in path.bytes() {
        match byte {
            b'A'..=b'Z' | b'a'..=b'z' | b'0'..=b'9' | b'-' | b'.' | b'_' | b'~' | b'/' => uri.push(byte as char),
            b'\\' if cfg!(windows) => uri.push('/'),
            _ => {
                const HEX: &[u8; 16] = b"0123456789ABCDEF";
                uri.push('%');
                uri.push(HEX[usize::from(byte >> 4)] as char);
                uri.push(HEX[usize::from(byte & 15)] as char);
            }
        }
    }
    uri
}

/// `file:///...` of an absolute path.
fn file_uri(path: &str) -> String {
    let encoded = encode(path);
    // `C:/x` becomes `file:///C:/x`.
    let encoded = encoded.replacen("%3A", ":", 1);
    if encoded.starts_with('/') { format!("file://{encoded}") } else { format!("file:///{encoded}") }
}

fn folder_uri(path: &Path) -> String {
    let mut uri = file_uri(&path.to_string_lossy());
    if !uri.ends_with('/') {
        uri.push('/');
    }
    uri
}

fn is_absolute(path: &str) -> bool {
    path.starts_with('/') || path.as_bytes().get(1) == Some(&b':')
}

impl Cx<'_> {
    /// Where a path is. Relative paths below the root are said relative to it, others absolutely.
    fn location(&self, path: &str) -> ArtifactLocation {
        if is_absolute(path) {
            if let Some(below) =
                self.root.and_then(|root| Path::new(path).strip_prefix(root).ok()).and_then(Path::to_str)
            {
                return ArtifactLocation::builder().uri(encode(below)).uri_base_id(ROOT).build();
            }
            return ArtifactLocation::builder().uri(file_uri(path)).build();
        }
        let mut parts: Vec<&str> = Vec::new();
        let mut above = 0;
        for part in path.split('/').filter(|it| !matches!(*it, "" | ".")) {
            if part == ".." && parts.pop().is_none() {
                above += 1;
            } else if part != ".." {
                parts.push(part);
            }
        }
        let below = parts.join("/");
        if above > 0
            && let Some(folder) = self.root.and_then(|it| it.ancestors().nth(above))
        {
            return ArtifactLocation::builder().uri(folder_uri(folder) + &encode(&below)).build();
        }
        let uri = "../".repeat(above) + &encode(&below);
        ArtifactLocation::builder().uri(uri).uri_base_id(ROOT).build()
    }

    fn file(&self, file: u32) -> Option<ArtifactLocation> {
        let mut location = self.location(&self.positions.file(file)?.path);
        location.index = Some(i64::from(file));
        Some(location)
    }

    fn artifact(&self, index: u32) -> Artifact {
        let Some(file) = self.positions.file(index) else { return Artifact::builder().build() };
        let mut artifact = Artifact::builder()
            .location(self.location(&file.path))
            .encoding(file.encoding)
            .roles(vec![json!("analysisTarget")])
            .build();
        if !file.dialect.is_empty() {
            artifact.source_language = Some(file.dialect.clone());
        }
        if file.made_of.is_some() {
            // A binary file, of which the text says neither encoding nor length.
            artifact.encoding = None;
            return artifact;
        }
        artifact.length = length(file).and_then(|it| i64::try_from(it).ok());
        artifact
    }

    fn physical(&self, place: &lint::Location) -> Option<PhysicalLocation> {
        if self.positions.entry(place.file, place.range).is_some() {
            return Some(PhysicalLocation::builder().artifact_location(self.file(place.file)?).build());
        }
        let span = self.positions.span(place.file, place.range)?;
        let text = &self.positions.file(place.file)?.text;
        let mut region = region(span);
        let snippet = text.get(std::ops::Range::<usize>::from(clamp(text, place.range))).unwrap_or_default();
        if !snippet.is_empty() && snippet.len() <= SNIPPET_LIMIT {
            region.snippet = Some(ArtifactContent::builder().text(snippet).build());
        }
        Some(PhysicalLocation::builder().artifact_location(self.file(place.file)?).region(region).build())
    }

    fn result(&mut self, diagnostic: &Diagnostic) -> Option<SarifResult> {
        let finding = &diagnostic.finding;
        let span = self.positions.span(finding.place.file, finding.place.range)?;
        let mut location = Location::builder().physical_location(self.physical(&finding.place)?).build();
        let entry = self.positions.entry(finding.place.file, finding.place.range);
        if let Some(entry) = entry {
            location.logical_locations = Some(logical_of(&entry));
        } else if !diagnostic.entity.is_empty() {
            let entity = diagnostic.entity.as_str();
            let logical = LogicalLocation::builder().name(entity).fully_qualified_name(entity).kind("module").build();
            location.logical_locations = Some(vec![logical]);
        }
        let related: Vec<Location> = finding
            .related
            .iter()
            .take(RELATED_LIMIT)
            .filter_map(|it| {
                let physical = self.physical(&it.place)?;
                let mut location =
                    Location::builder().physical_location(physical).message(message(&it.message)).build();
                let entry = self.positions.entry(it.place.file, it.place.range);
                location.logical_locations = entry.map(|it| logical_of(&it));
                Some(location)
            })
            .zip(1..)
            .map(|(location, id)| Location { id: Some(id), ..location })
            .collect();
        let mut text = match entry {
            Some(entry) => format!("{} ({entry}).", finding.message),
            None => format!("{}.", finding.message),
        };
        for note in &finding.notes {
            text.push(' ');
            text.push_str(note);
            text.push('.');
        }
        let mut result = SarifResult::builder()
            .rule_id(finding.rule.code)
            .level(level(finding.severity))
            .message(message(text))
            .locations(vec![location])
            .build();
        result.rule_index = self.rules.get(finding.rule.code).copied();
        if !related.is_empty() {
            result.related_locations = Some(related);
        }
        if let Some(hash) = self.fingerprint(finding.place.file, span.start.line) {
            result.partial_fingerprints = Some(BTreeMap::from([("primaryLocationLineHash".to_owned(), hash)]));
        }
        let fixes: Vec<Fix> = finding.fixes.iter().filter_map(|it| self.fix(it)).collect();
        if !fixes.is_empty() {
            result.fixes = Some(fixes);
        }
        if let Some(reason) = &diagnostic.suppressed {
            let mut suppression = Suppression::builder().kind(json!("inSource")).status(json!("accepted")).build();
            suppression.justification = (!reason.is_empty()).then(|| reason.clone());
            result.suppressions = Some(vec![suppression]);
        }
        Some(result)
    }

    fn fingerprint(&mut self, file: u32, line: u32) -> Option<String> {
        let view = self.outcome.files.get(file as usize)?;
        // Findings come in the order of files: only the fingerprints of the last one are kept.
        if !self.fingerprints.contains_key(&file) {
            self.fingerprints.clear();
        }
        self.fingerprints.entry(file).or_insert_with(|| Fingerprints::of(view)).line(line)
    }

    fn fix(&self, fix: &lint::Fix<lint::Location>) -> Option<Fix> {
        let mut changes: BTreeMap<u32, Vec<Replacement>> = BTreeMap::new();
        for edit in &fix.edits {
            let span = self.positions.span(edit.place.file, edit.place.range)?;
            let inserted = ArtifactContent::builder().text(edit.replacement.as_str()).build();
            let replacement = Replacement::builder().deleted_region(region(span)).inserted_content(inserted).build();
            changes.entry(edit.place.file).or_default().push(replacement);
        }
        let mut artifact_changes = Vec::new();
        for (file, replacements) in changes {
            let location = self.file(file)?;
            artifact_changes
                .push(ArtifactChange::builder().artifact_location(location).replacements(replacements).build());
        }
        if artifact_changes.is_empty() {
            return None;
        }
        let applicability = match fix.applicability {
            Applicability::Safe => "safe",
            Applicability::Unsafe => "unsafe",
        };
        let properties = PropertyBag::builder()
            .additional_properties(BTreeMap::from([("applicability".to_owned(), json!(applicability))]))
            .build();
        let description = message(fix.title.as_str());
        Some(Fix::builder().description(description).artifact_changes(artifact_changes).properties(properties).build())
    }

    fn invocation(&self) -> Invocation {
        let notification = |id: &str, level: Value, text: String| {
            Notification::builder()
                .descriptor(ReportingDescriptorReference::builder().id(id).build())
                .level(level)
                .message(message(text))
                .build()
        };
        let mut notifications = Vec::new();
        for unread in &self.outcome.unread {
            let mut it = match &unread.reason {
                UnreadReason::Io(error) => {
                    notification(UNREADABLE, json!("warning"), format!("{} was not read: {error}.", unread.path))
                }
                UnreadReason::Unsupported(kind) => notification(
                    UNSUPPORTED,
                    json!("note"),
                    format!("{} was not read: {kind} is not supported.", unread.path),
                ),
                UnreadReason::NotPlc => continue,
            };
            let physical = PhysicalLocation::builder().artifact_location(self.location(&unread.path)).build();
            it.locations = Some(vec![Location::builder().physical_location(physical).build()]);
            notifications.push(it);
        }
        for error in &self.outcome.internal_errors {
            notifications.push(notification(INTERNAL, json!("error"), error.clone()));
        }
        Invocation::builder()
            .execution_successful(self.outcome.internal_errors.is_empty())
            .tool_execution_notifications(notifications)
            .build()
    }
}

fn region(span: Span) -> Region {
    Region::builder()
        .start_line(i64::from(span.start.line))
        .start_column(i64::from(span.start.column))
        .end_line(i64::from(span.end.line))
        .end_column(i64::from(span.end.column))
        .build()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::testing::{diagnostic, sample, view};
    use crate::report::{Format, write};

    fn document(outcome: &Outcome) -> Value {
        let mut out = Vec::new();
        let options = Options { colour: false, root: Some("/plant/line 1".into()) };
        write(Format::Sarif, outcome, &options, &mut out).unwrap();
        serde_json::from_slice(&out).unwrap()
    }

    #[test]
    fn the_document_says_everything() {
        let document = serde_json::to_string_pretty(&document(&sample())).unwrap();
        insta::assert_snapshot!(document.replace(env!("CARGO_PKG_VERSION"), "VERSION"));
    }

    #[test]
    fn paths_become_uris() {
        let root = Path::new("/plant/line 1");
        let cx = |outcome| Cx {
            outcome,
            positions: Positions::new(outcome),
            root: Some(root),
            rules: FxHashMap::default(),
            fingerprints: FxHashMap::default(),
        };
        let outcome = Outcome::default();
        let uri = |path: &str| {
            let it = cx(&outcome).location(path);
            (it.uri.unwrap(), it.uri_base_id.is_some())
        };
        assert_eq!(uri("./a b/é:1.awl"), ("a%20b/%C3%A9%3A1.awl".into(), true));
        assert_eq!(uri("x/../a.awl"), ("a.awl".into(), true));
        assert_eq!(uri("../line2/a.awl"), ("file:///plant/line2/a.awl".into(), false));
        assert_eq!(uri("/plant/line 1/a.awl"), ("a.awl".into(), true));
        assert_eq!(uri("/x/a.awl"), ("file:///x/a.awl".into(), false));
        assert_eq!(uri("C:/x/a.awl"), ("file:///C:/x/a.awl".into(), false));
    }

    #[test]
    fn an_internal_error_is_not_success() {
        let outcome = Outcome { internal_errors: vec!["W001 failed in a.awl.".into()], ..Outcome::default() };
        let invocation = &document(&outcome)["runs"][0]["invocations"][0];
        assert_eq!(invocation["executionSuccessful"], json!(false));
        assert_eq!(invocation["toolExecutionNotifications"][0]["level"], json!("error"));
    }

    #[test]
    fn a_finding_in_no_file_is_left_out() {
        let mut outcome = sample();
        let mut finding = outcome.diagnostics[0].finding.clone();
        finding.place.file = 9;
        outcome.diagnostics = vec![diagnostic(finding)];
        outcome.files.push(view("c.awl", "", "utf-8"));
        assert_eq!(document(&outcome)["runs"][0]["results"], json!([]));
    }
}
