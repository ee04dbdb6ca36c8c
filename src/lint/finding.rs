//! What a rule has to say: [`Finding`], generic over how a place is named.
//!
//! A rule that looks at one unit names places by ranges relative to that unit. A rule that looks at a program names
//! them by [`Site`], which holds no position, so that an edit that only moves code does not wake it. Reports name them
//! by [`Location`], in the text of a file.

use rowan::TextRange;

use super::rule::Rule;

/// How bad it is. The order is from bad to worse.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Severity {
    /// Advice, reported as a note.
    Advice,
    /// The source warns, or it is very probably a bug.
    Warning,
    /// The source forbids it, or it cannot work.
    Error,
}

impl Severity {
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Advice => "note",
            Self::Warning => "warning",
            Self::Error => "error",
        }
    }

    pub fn parse(text: &str) -> Option<Self> {
        Some(match text {
            "note" | "advice" | "info" => Self::Advice,
            "warning" => Self::Warning,
            "error" => Self::Error,
            _ => return None,
        })
    }
}

/// Whether applying a fix keeps the meaning of the program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Applicability {
    /// The meaning stays, or the text had none before.
    Safe,
    /// The meaning may change: a person must look.
    Unsafe,
}

/// Replaces the text of one place.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Edit<P> {
    pub place: P,
    pub replacement: String,
}

/// Edits that belong together, with a title in the imperative: "Write `:=`".
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Fix<P> {
    pub title: String,
    pub applicability: Applicability,
    pub edits: Vec<Edit<P>>,
}

/// Another place that takes part, with its part.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Related<P> {
    pub place: P,
    pub message: String,
}

#[derive(Debug, Clone)]
pub struct Finding<P> {
    pub rule: &'static Rule,
    /// The severity that this finding deserves; configuration may override it later.
    pub severity: Severity,
    /// One sentence without a final stop, which names the object as the user wrote it.
    pub message: String,
    pub place: P,
    /// What stands at the primary place, when the message alone does not say.
    pub label: Option<String>,
    pub related: Vec<Related<P>>,
    /// What the finding assumes or adds to the rule's own help, a sentence each.
    pub notes: Vec<String>,
    pub fixes: Vec<Fix<P>>,
}

/// Rules are compared by identity of their code.
impl<P: PartialEq> PartialEq for Finding<P> {
    fn eq(&self, other: &Self) -> bool {
        self.rule.code == other.rule.code
            && self.severity == other.severity
            && self.message == other.message
            && self.place == other.place
            && self.label == other.label
            && self.related == other.related
            && self.notes == other.notes
            && self.fixes == other.fixes
    }
}

impl<P: Eq> Eq for Finding<P> {}

impl<P> Finding<P> {
    pub fn new(rule: &'static Rule, place: P, message: impl Into<String>) -> Self {
        Self {
            rule,
            severity: rule.severity,
            message: message.into(),
            place,
            label: None,
            related: Vec::new(),
            notes: Vec::new(),
            fixes: Vec::new(),
        }
    }

    /// Whether a place of the finding is one of those asked for.
    pub fn names(&self, wanted: impl Fn(&P) -> bool) -> bool {
        wanted(&self.place) || self.related.iter().any(|it| wanted(&it.place))
    }

    /// Names every place anew; `None` when the primary place is gone.
    pub fn map<Q>(self, mut name: impl FnMut(P) -> Option<Q>) -> Option<Finding<Q>> {
        let place = name(self.place)?;
        let mut related = Vec::with_capacity(self.related.len());
        for it in self.related {
            if let Some(place) = name(it.place) {
                related.push(Related { place, message: it.message });
            }
        }
        let mut fixes = Vec::with_capacity(self.fixes.len());
        for fix in self.fixes {
            let wanted = fix.edits.len();
            let edits: Vec<Edit<Q>> = fix
                .edits
                .into_iter()
                .filter_map(|it| name(it.place).map(|place| Edit { place, replacement: it.replacement }))
                .collect();
            if edits.len() == wanted {
                fixes.push(Fix { title: fix.title, applicability: fix.applicability, edits });
            }
        }
        Some(Finding {
            rule: self.rule,
            severity: self.severity,
            message: self.message,
            place,
            label: self.label,
            related,
            notes: self.notes,
            fixes,
        })
    }
}

/// A place in the decoded text of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Location {
    /// Index of the file in the run, in path order.
    pub file: u32,
    pub range: TextRange,
}

/// Collects the findings of one rule; the returned reference lets the rule add labels, notes and fixes.
pub struct Sink<'a, P> {
    pub(super) rule: &'static Rule,
    pub(super) findings: &'a mut Vec<Finding<P>>,
}

impl<P> Sink<'_, P> {
    pub fn report(&mut self, place: P, message: impl Into<String>) -> Reported<'_, P> {
        self.findings.push(Finding::new(self.rule, place, message));
        let at = self.findings.len() - 1;
        Reported(&mut self.findings[at])
    }

    /// Adds a note to whatever is reported meanwhile.
    pub fn noting(&mut self, note: &str, report: impl FnOnce(&mut Self)) {
        let before = self.findings.len();
        report(self);
        self.findings[before..].iter_mut().for_each(|it| it.notes.push(note.to_owned()));
    }
}

/// A finding just reported, for its details.
pub struct Reported<'a, P>(&'a mut Finding<P>);

impl<P> Reported<'_, P> {
    /// Text at the primary place.
    pub fn label(self, text: impl Into<String>) -> Self {
        self.0.label = Some(text.into());
        self
    }

    /// Another place that takes part.
    pub fn related(self, place: P, message: impl Into<String>) -> Self {
        self.0.related.push(Related { place, message: message.into() });
        self
    }

    pub fn related_all(self, places: impl IntoIterator<Item = (P, String)>) -> Self {
        self.0.related.extend(places.into_iter().map(|(place, message)| Related { place, message }));
        self
    }

    /// What the finding assumes or adds: one sentence.
    pub fn note(self, text: impl Into<String>) -> Self {
        self.0.notes.push(text.into());
        self
    }

    pub fn notes(self, texts: impl IntoIterator<Item = String>) -> Self {
        self.0.notes.extend(texts);
        self
    }

    pub fn severity(self, severity: Severity) -> Self {
        self.0.severity = severity;
        self
    }

    pub fn fix(self, title: impl Into<String>, applicability: Applicability, edits: Vec<Edit<P>>) -> Self {
        self.0.fixes.push(Fix { title: title.into(), applicability, edits });
        self
    }

    /// A fix of one edit.
    pub fn replace(
        self,
        title: impl Into<String>,
        applicability: Applicability,
        place: P,
        by: impl Into<String>,
    ) -> Self {
        self.fix(title, applicability, vec![Edit { place, replacement: by.into() }])
    }
}
