//! Findings as the protocol's diagnostics.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, LazyLock};

use lsp_types::{
    Code, CodeDescription, Diagnostic, DiagnosticRelatedInformation, DiagnosticSeverity, DiagnosticTag, Message, Range,
    Uri,
};
use rowan::{TextRange, TextSize};
use rustc_hash::{FxHashMap, FxHashSet};
use serde_json::json;

use super::convert::Encoding;
use super::snapshot::{RootSnapshot, Snapshot};
use crate::db::{self, FileFinding, SourceFile};
use crate::lint::settings::{ConfigError, Origin};
use crate::lint::{Rule, Severity, rules};
use crate::load::{Wrong, WrongConfig};
use crate::report::position::Headings;
use crate::source::detect::Detected;
use crate::source::line_index::{LineCol, LineIndex};

/// Who reports.
pub(super) const SOURCE: &str = "plclint";

/// Scheme of the addresses of rule pages.
pub(super) const PAGES: &str = "plclint-rule";

/// The findings of files as the client has them, by path.
pub(super) type Known = FxHashMap<String, Arc<FileDiagnostics>>;

/// The findings of a file as they were told, and what they were made of.
#[derive(Debug)]
pub(super) struct FileDiagnostics {
    /// Equal for equal diagnostics of one file.
    pub(super) id: String,
    pub(super) items: Vec<Diagnostic>,
    /// The root whose database names the places.
    root: u32,
    findings: Box<[FileFinding]>,
    /// Texts of the file and of those that findings name besides: they say where lines begin.
    texts: Vec<Arc<str>>,
}

/// The findings of a file. When nothing changed since they were told, they are the value that was told.
pub(super) fn of_file(snapshot: &Snapshot, root: &RootSnapshot, file: SourceFile) -> Arc<FileDiagnostics> {
    static NEXT: AtomicU64 = AtomicU64::new(0);
    let db = &root.db;
    let known = snapshot.known.get(file.path(db)).filter(|it| it.root == root.id);
    let findings = db::file_findings(db, file);
    let texts = texts(root, file, findings);
    if let Some(known) = known
        && *known.findings == *findings
        && known.texts.len() == texts.len()
        && known.texts.iter().zip(&texts).all(|(a, b)| Arc::ptr_eq(a, b))
    {
        return known.clone();
    }
    let headings = (file.detected(db) == Detected::Stx).then(|| Headings::new(file.text(db)));
    let shown = findings.iter().filter(|it| it.suppressed.is_none());
    let items: Vec<Diagnostic> = shown.map(|it| diagnostic(snapshot, root, headings.as_ref(), it)).collect();
    let id = match known.filter(|it| it.items == items) {
        Some(known) => known.id.clone(),
        None => NEXT.fetch_add(1, Ordering::Relaxed).to_string(),
    };
    Arc::new(FileDiagnostics { id, items, root: root.id, findings: findings.into(), texts })
}

fn texts(root: &RootSnapshot, file: SourceFile, findings: &[FileFinding]) -> Vec<Arc<str>> {
    let (mut files, mut seen) = (vec![file], FxHashSet::from_iter([file]));
    let related = findings.iter().flat_map(|it| &it.finding.related);
    files.extend(related.map(|it| it.place.file).filter(|it| seen.insert(*it)));
    files.into_iter().map(|it| it.text(&root.db).clone()).collect()
}

/// One finding. `headings` are those of a text that was made of tables.
pub(super) fn diagnostic(
    snapshot: &Snapshot,
    root: &RootSnapshot,
    headings: Option<&Headings>,
    it: &FileFinding,
) -> Diagnostic {
    let (db, finding, abilities) = (&root.db, &it.finding, &snapshot.abilities);
    let file = finding.place.file;
    let mut message = finding.message.clone();
    for note in &finding.notes {
        message.push_str("\nnote: ");
        message.push_str(note);
    }
    let mut range = root.range(finding.place, abilities.encoding);
    if let Some(headings) = headings {
        // The text was made of tables: what stands there is said, lines and columns mean nothing.
        range = Range::default();
        let entry = headings.entry(file.text(db), finding.place.range);
        message = format!("{entry}: {message}");
    }
    let related = abilities.related_information.then(|| {
        let related = finding.related.iter().filter_map(|it| {
            let location = root.location(snapshot, it.place)?;
            Some(DiagnosticRelatedInformation { location, message: it.message.clone() })
        });
        related.collect::<Vec<_>>()
    });
    let is_dead = finding.rule.group == "dead-code";
    Diagnostic {
        range,
        severity: Some(severity(finding.severity)),
        code: Some(Code::String(finding.rule.code.to_owned())),
        code_description: page_uri(finding.rule).filter(|_| abilities.rule_pages).map(|href| CodeDescription { href }),
        source: Some(SOURCE.to_owned()),
        message: Message::String(message),
        tags: (is_dead && abilities.tags).then(|| vec![DiagnosticTag::Unnecessary]),
        related_information: related.filter(|it| !it.is_empty()),
        data: Some(json!({
            "rule": finding.rule.name,
            "fixes": finding.fixes.iter().map(|it| it.title.as_str()).collect::<Vec<_>>(),
        })),
    }
}

fn severity(severity: Severity) -> DiagnosticSeverity {
    match severity {
        Severity::Error => DiagnosticSeverity::Error,
        Severity::Warning => DiagnosticSeverity::Warning,
        Severity::Advice => DiagnosticSeverity::Information,
    }
}

/// The address of a rule's page, which the client may ask for as a document.
pub(super) fn page_uri(rule: &Rule) -> Option<Uri> {
    static PAGES_OF_RULES: LazyLock<FxHashMap<&str, Uri>> = LazyLock::new(|| {
        let page = |it: &Rule| Uri::parse(&format!("{PAGES}:///{}/{}.md", it.code, it.name)).ok();
        rules().iter().filter_map(|it| Some((it.code, page(it)?))).collect()
    });
    PAGES_OF_RULES.get(rule.code).cloned()
}

/// What is wrong with a configuration, in the text of its file.
pub(super) fn of_config(wrong: &WrongConfig, text: &str, encoding: Encoding) -> Diagnostic {
    let (place, message) = match &wrong.what {
        Wrong::Words(ConfigError { origin: Origin::File { line, column, .. }, message }) => {
            let count = |it: usize| u32::try_from(it).unwrap_or(u32::MAX);
            (LineCol { line: count(*line), column: count(*column) }, message.clone())
        }
        Wrong::Words(error) => (LineCol { line: 1, column: 1 }, error.message.clone()),
        Wrong::File(_) | Wrong::Folder(_) => (LineCol { line: 1, column: 1 }, wrong.to_string()),
    };
    let lines = LineIndex::new(text);
    let start = lines.offset(place).unwrap_or_default();
    let rest = text.get(usize::from(start)..).and_then(|it| it.lines().next()).unwrap_or_default();
    Diagnostic {
        range: encoding.range(&lines, TextRange::at(start, TextSize::of(rest))),
        severity: Some(DiagnosticSeverity::Error),
        source: Some(SOURCE.to_owned()),
        code: Some(Code::String("configuration".to_owned())),
        code_description: None,
        message: Message::String(message),
        tags: None,
        related_information: None,
        data: None,
    }
}
