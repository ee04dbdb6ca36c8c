//! Findings and the rules that make them: registry, selection, severity, suppression.
//!
//! **Invariant:** findings are returned values, sorted; a rule names no output format and no dialect token that its
//! page does not say it is for.

mod context;
mod finding;
mod outcome;
mod rule;

pub use crate::analysis::Site;
pub use context::{FileCx, ProgramCx, UnitCx};
pub use finding::{Applicability, Edit, Finding, Fix, Location, Related, Reported, Severity, Sink};
pub use outcome::{Diagnostic, Outcome, SourceView, Unread, UnreadReason};
#[expect(unused_imports, reason = "used by the database")]
pub(crate) use rule::run;
pub use rule::{Check, Rule, find, rules};
