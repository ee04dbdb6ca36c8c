//! T014: a division by 0.

use crate::analysis::Site;
use crate::analysis::ranges::demands::{self, Accepted};
use crate::lint::{ProgramCx, Severity, Sink};
use crate::model::entity::Family;
use crate::model::unit::DemandKind;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let overflow = match cx.program.family {
        Family::Pl7 => "`%S18`",
        Family::Pl72 => "`SY18`",
        Family::Step5 | Family::Step7 => return,
    };
    let found = demands::unmet(cx.program, |_, it| (it.what == DemandKind::Divisor).then_some(Accepted::NOT_ZERO));
    for it in found {
        let what = it.name().map_or_else(|| "the divisor".to_owned(), |name| format!("`{name}`"));
        let (verb, severity) = if it.always { ("is", Severity::Error) } else { ("can be", Severity::Warning) };
        let report = sink
            .report(it.site, format!("{what} {verb} 0, and divides"))
            .severity(severity)
            .related_all(it.because)
            .note(format!("the result is undefined; {overflow} tells of it (PL72:1031)"));
        if it.assumes_writes {
            report.note("assumed: no terminal, operator panel or message writes it");
        }
    }
}
