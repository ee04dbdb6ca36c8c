//! Findings and the rules that make them: registry, selection, severity, suppression.
//!
//! **Invariant:** findings are returned values, sorted; a rule names no output format and no dialect token that its
//! page does not say it is for.

mod context;
mod finding;
mod nearest;
mod outcome;
mod rule;
mod select;
pub mod settings;
pub mod suppress;
#[cfg(test)]
pub(crate) mod testing;

pub use crate::analysis::Site;
pub use context::{FileCx, ProgramCx, UnitCx};
pub use finding::{Applicability, Edit, Finding, Fix, Location, Related, Reported, Severity, Sink};
pub use nearest::nearest;
pub use outcome::{Diagnostic, MadeOf, Outcome, SourceView, Unread, UnreadReason};
pub(crate) use rule::run;
pub use rule::{Check, Rule, find, rules};
pub use select::{Selection, Selector, UnknownRule};
pub use settings::Settings;
