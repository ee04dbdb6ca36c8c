//! `textDocument/codeAction`: fixes of findings, and ways to live with them.

use std::path::Path;

use lsp_types::{
    CodeAction, CodeActionKind, CodeActionParams, CodeActionRequest, CodeActionResponse, Edit, Position, Range,
    SnippetTextEdit, StringValue, TextEdit,
};
use rowan::{TextRange, TextSize};
use rustc_hash::{FxHashMap, FxHashSet};
use serde::Deserialize;
use toml::Spanned;

use super::{Answer, Handle};
use crate::db::{self, FileFinding, FilePlace};
use crate::lint::settings::{Folders, Overrides};
use crate::lint::{Applicability, Fix, Rule, Settings};
use crate::load;
use crate::server::cursor::InUnit;
use crate::server::diagnostics;
use crate::server::edits::Edits;
use crate::server::snapshot::{InFile, Snapshot};
use crate::source::detect::Detected;
use crate::source::line_index::LineIndex;
use crate::syntax::{self, Language, SyntaxKind};

pub(super) struct Handler;

impl Handle for Handler {
    type Request = CodeActionRequest;

    fn handle(snapshot: &Snapshot, params: CodeActionParams) -> Answer<Self::Request> {
        let Some(it) = snapshot.file(&params.text_document.uri) else { return Ok(None) };
        if it.file.detected(it.db) == Detected::Stx {
            return Ok(None);
        }
        let only = params.context.only.as_deref();
        let findings = db::file_findings(it.db, it.file);
        let mut actions = Vec::new();
        if wants(only, &CodeActionKind::QuickFix) {
            let range = it.text_range(params.range);
            let touched =
                findings.iter().filter(|it| it.suppressed.is_none() && touches(it.finding.place.range, range));
            let mut disabled: FxHashSet<&str> = FxHashSet::default();
            // Each asks the grammar: once for each line, of a unit.
            let (lines, layout) = (db::lines(it.db, it.file), db::layout(it.db, it.file));
            let mut above: FxHashMap<_, Option<Above>> = FxHashMap::default();
            for finding in touched {
                let rule = finding.finding.rule;
                actions.extend(fixes(&it, finding));
                let start = finding.finding.place.range.start();
                let line = (lines.line_col(start).line, db::unit_at(layout, start));
                let above = above.entry(line).or_insert_with(|| Above::new(&it, start));
                actions.extend(above.iter().flat_map(|above| suppress(&it, finding, above)));
                if disabled.insert(rule.code) {
                    actions.extend(disable(&it, rule));
                }
            }
        }
        if wants(only, &CodeActionKind::SourceFixAll) {
            actions.extend(fix_all(&it, findings));
        }
        Ok(Some(actions.into_iter().map(CodeActionResponse::CodeAction).collect()))
    }
}

/// Whether the client wants actions of a kind, or of a kind that this one is part of.
fn wants(only: Option<&[CodeActionKind]>, kind: &CodeActionKind) -> bool {
    let Some(only) = only else { return true };
    let kind = String::from(kind.clone());
    only.iter().any(|it| {
        let wanted = String::from(it.clone());
        wanted.is_empty() || kind.strip_prefix(&wanted).is_some_and(|it| it.is_empty() || it.starts_with('.'))
            // `source.fixAll.plclint` is what editors ask of one server.
            || wanted.strip_prefix(&kind).is_some_and(|it| it == ".plclint")
    })
}

fn touches(a: TextRange, b: TextRange) -> bool {
    a.start() <= b.end() && b.start() <= a.end()
}

fn quick_fix(it: &InFile<'_>, finding: &FileFinding, title: String, edits: Edits) -> CodeAction {
    CodeAction {
        title,
        kind: Some(CodeActionKind::QuickFix),
        diagnostics: Some(vec![diagnostics::diagnostic(it.snapshot, it.root, None, finding)]),
        edit: Some(edits.finish(it.snapshot)),
        ..Default::default()
    }
}

fn fixes(it: &InFile<'_>, finding: &FileFinding) -> Vec<CodeAction> {
    let action = |fix: &Fix<FilePlace>| {
        let mut edits = Edits::default();
        edits.fix(it.snapshot, it.root, fix);
        let title = match fix.applicability {
            Applicability::Safe => fix.title.clone(),
            Applicability::Unsafe => format!("{} (may change what the program does)", fix.title),
        };
        let is_safe = fix.applicability == Applicability::Safe;
        CodeAction { is_preferred: is_safe.then_some(true), ..quick_fix(it, finding, title, edits) }
    };
    finding.finding.fixes.iter().map(action).collect()
}

/// All safe fixes of a file at once. Of two that change the same place, the first is made.
fn fix_all(it: &InFile<'_>, findings: &[FileFinding]) -> Option<CodeAction> {
    let shown = findings.iter().filter(|it| it.suppressed.is_none());
    let safe = shown.filter_map(|it| it.finding.fixes.iter().find(|it| it.applicability == Applicability::Safe));
    let mut made: Vec<FilePlace> = Vec::new();
    let mut edits = Edits::default();
    for fix in safe.filter(|fix| fix.edits.iter().all(|edit| edit.place.file == it.file)) {
        let is_free = |place: &FilePlace| !made.iter().any(|it| touches(it.range, place.range));
        if fix.edits.iter().all(|edit| is_free(&edit.place)) {
            made.extend(fix.edits.iter().map(|edit| edit.place));
            edits.fix(it.snapshot, it.root, fix);
        }
    }
    (!edits.is_empty()).then(|| CodeAction {
        title: "Make all safe fixes of plclint".to_owned(),
        kind: Some(CodeActionKind::SourceFixAll),
        edit: Some(edits.finish(it.snapshot)),
        ..Default::default()
    })
}

/// Comments that suppress the finding where it stands, and its rule in the whole file.
fn suppress(it: &InFile<'_>, finding: &FileFinding, above: &Above) -> Vec<CodeAction> {
    let rule = finding.finding.rule;
    let action = |verb: &str, where_: &str| {
        let mut edits = Edits::default();
        edits.add(it.path(), above.comment(it, verb, rule));
        let title = format!("Suppress {} ({}) {where_} with a comment", rule.code, rule.name);
        quick_fix(it, finding, title, edits)
    };
    vec![action("allow", "here"), action("allow-file", "in this file")]
}

/// Where a comment may stand on a line of its own above a place.
struct Above {
    at: TextSize,
    indent: String,
    line_break: &'static str,
    is_statement_list: bool,
}

impl Above {
    /// `None` where no comment may stand, as the grammar says.
    fn new(it: &InFile<'_>, place: TextSize) -> Option<Self> {
        let source = it.file.text(it.db);
        let lines = db::lines(it.db, it.file);
        let line = lines.line_range(lines.line_col(place).line)?;
        let content = source.get(std::ops::Range::<usize>::from(line))?;
        let cursor = InUnit::at(*it, place)?;
        let language = cursor.unit.language(it.db);
        if language.declares_symbols() || language == Language::Pl7Xref {
            return None;
        }
        // On the first line of a unit, the line may begin in another one.
        let at = line.start().max(cursor.offset);
        let blanks = content.find(|it| it != ' ' && it != '\t').unwrap_or(0);
        let line_break = if content.ends_with("\r\n") || source.contains("\r\n") { "\r\n" } else { "\n" };
        let indent = content.get(..blanks)?.to_owned();
        let above = Self { at, indent, line_break, is_statement_list: language.is_statement_list() };
        let text = "plclint: allow(rule)";
        let unit = cursor.unit.text(it.db);
        let relative = at.checked_sub(cursor.offset)?;
        let (before, behind) = unit.split_at_checked(relative.into())?;
        let parse = syntax::parse(language, &format!("{before}{}{behind}", above.line(text)));
        let start = relative + TextSize::of(above.indent.as_str());
        let is_comment = parse
            .syntax()
            .descendant_tokens()
            .any(|it| it.kind() == SyntaxKind::Comment && it.text_range().contains(start) && it.text().contains(text));
        let is_no_worse = parse.errors().len() <= db::tree(it.db, cursor.unit).errors().len();
        (is_comment && is_no_worse).then_some(above)
    }

    fn line(&self, text: &str) -> String {
        let Self { indent, line_break, .. } = self;
        match self.is_statement_list {
            true => format!("{indent}// {text}{line_break}"),
            false => format!("{indent}(* {text} *){line_break}"),
        }
    }

    /// With a reason that the user writes next, where the client leaves room for it.
    fn comment(&self, it: &InFile<'_>, verb: &str, rule: &Rule) -> Edit {
        let (range, name) = (it.range(TextRange::empty(self.at)), rule.name);
        if it.snapshot.abilities.snippets {
            let value = self.line(&format!("plclint: {verb}({name}: ${{1:reason}})"));
            return SnippetTextEdit { range, snippet: StringValue { value }, annotation_id: None }.into();
        }
        TextEdit { range, new_text: self.line(&format!("plclint: {verb}({name})")) }.into()
    }
}

/// Adds the rule to those that the configuration leaves out.
fn disable(it: &InFile<'_>, rule: &'static Rule) -> Option<CodeAction> {
    let file = it.root.config.as_deref()?;
    let path = load::shown(file);
    let mut edits = Edits::default();
    let old = match it.snapshot.documents.get(&path) {
        Some(open) => Some(open.text.to_string()),
        None => load::text(file).ok(),
    };
    let (at, inserted) = ignoring(old.as_deref().unwrap_or_default(), rule)?;
    match &old {
        Some(text) => {
            let lines = LineIndex::new(text);
            let range = it.snapshot.encoding().range(&lines, TextRange::empty(at));
            edits.add(&path, TextEdit { range, new_text: inserted });
        }
        None if it.snapshot.abilities.creates_files && it.snapshot.abilities.document_changes => {
            edits.create(it.snapshot.uri(&path)?);
            let start = Range::new(Position::default(), Position::default());
            edits.add(&path, TextEdit { range: start, new_text: inserted });
        }
        None => return None,
    }
    Some(CodeAction {
        title: format!("Disable {} ({}) in {}", rule.code, rule.name, crate::lint::settings::FILE_NAME),
        kind: Some(CodeActionKind::QuickFix),
        edit: Some(edits.finish(it.snapshot)),
        ..Default::default()
    })
}

#[derive(Deserialize, Default)]
#[serde(default)]
struct Probe {
    rules: Option<ProbeRules>,
}

#[derive(Deserialize, Default)]
#[serde(default)]
struct ProbeRules {
    ignore: Option<Spanned<Vec<Spanned<String>>>>,
}

/// What to insert where, so that a configuration leaves out a rule. `None` for a text in which that cannot be said so.
fn ignoring(text: &str, rule: &'static Rule) -> Option<(TextSize, String)> {
    let probe: Probe = toml::from_str(text).ok()?;
    let name = rule.name;
    let header = || {
        let mut offset = 0;
        text.split_inclusive('\n').find_map(|line| {
            offset += line.len();
            let bare = line.split('#').next().unwrap_or_default().trim();
            (bare == "[rules]" && line.ends_with('\n')).then_some(offset)
        })
    };
    let (at, inserted) = match probe.rules.and_then(|it| it.ignore) {
        Some(ignore) => match ignore.get_ref().last() {
            Some(last) => (last.span().end, format!(", \"{name}\"")),
            None => (ignore.span().start + 1, format!("\"{name}\"")),
        },
        None => match header() {
            Some(at) => (at, format!("ignore = [\"{name}\"]\n")),
            None => {
                let gap = if text.is_empty() {
                    ""
                } else if text.ends_with('\n') {
                    "\n"
                } else {
                    "\n\n"
                };
                (text.len(), format!("{gap}[rules]\nignore = [\"{name}\"]\n"))
            }
        },
    };
    let (before, behind) = text.split_at_checked(at)?;
    let new = format!("{before}{inserted}{behind}");
    let settings = Settings::parse(&new, Path::new(""), Folders::default(), Overrides::default()).ok()?;
    let is_off = !settings.active().iter().any(|it| it.code == rule.code);
    is_off.then_some((TextSize::try_from(at).ok()?, inserted))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_configuration_leaves_out_one_more_rule() {
        #[track_caller]
        fn check(text: &str, expected: Option<&str>) {
            let rule = crate::lint::find("single-write").unwrap();
            let new = ignoring(text, rule).map(|(at, inserted)| {
                let (before, behind) = text.split_at(at.into());
                format!("{before}{inserted}{behind}")
            });
            assert_eq!(new.as_deref(), expected);
        }
        check("", Some("[rules]\nignore = [\"single-write\"]\n"));
        check("[files]\n", Some("[files]\n\n[rules]\nignore = [\"single-write\"]\n"));
        check("[rules] # all\nselect = ['J']\n", Some("[rules] # all\nignore = [\"single-write\"]\nselect = ['J']\n"));
        check("[rules]\nignore = []\n", Some("[rules]\nignore = [\"single-write\"]\n"));
        check("[rules]\nignore = [\n  'J',\n]\n", Some("[rules]\nignore = [\n  'J', \"single-write\",\n]\n"));
        check("rules = { select = ['J'] }\n", None);
        check("[rules\n", None);
        check(
            "[rules.severity]\nJ = 'error'\n",
            Some("[rules.severity]\nJ = 'error'\n\n[rules]\nignore = [\"single-write\"]\n"),
        );
    }

    #[test]
    fn kinds_are_asked_for_by_their_beginning() {
        let fix_all = CodeActionKind::SourceFixAll;
        assert!(wants(None, &fix_all));
        assert!(wants(Some(&[CodeActionKind::Source]), &fix_all));
        assert!(wants(Some(&["source.fixAll.plclint".to_owned().into()]), &fix_all));
        assert!(!wants(Some(&["source.fixAll.other".to_owned().into()]), &fix_all));
        assert!(!wants(Some(&[CodeActionKind::QuickFix]), &fix_all));
    }
}
