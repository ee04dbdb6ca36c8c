//! O001: an address that the dialect does not have.

use rowan::TextRange;

use crate::lint::{Applicability, Sink, UnitCx};
use crate::model::object::AddressErrorKind;
use crate::model::unit::OddityKind;
use crate::syntax::Language;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for oddity in &cx.model.oddities {
        let OddityKind::Address(error) = &oddity.kind else { continue };
        if error.kind != AddressErrorKind::Malformed {
            continue;
        }
        let mut finding = sink.report(oddity.range, format!("`{}` is no address: {}", oddity.text, error.message));
        if matches!(cx.model.language, Language::Awl(_)) {
            finding = finding.note("if it is a symbol, it stands in quotes");
        }
        if let Some(nearest) = &error.suggestion {
            finding.replace(format!("Write `{nearest}`"), Applicability::Unsafe, oddity.range, nearest.clone());
        }
    }
}
