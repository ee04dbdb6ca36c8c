//! O001: an address that the dialect does not have.

use rowan::TextRange;

use crate::lint::{Applicability, Sink, UnitCx};
use crate::model::object::AddressErrorKind;
use crate::model::unit::OddityKind;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for oddity in &cx.model.oddities {
        let OddityKind::Address(error) = &oddity.kind else { continue };
        if error.kind != AddressErrorKind::Malformed {
            continue;
        }
        let finding = sink.report(oddity.range, format!("`{}` is no address: {}", oddity.text, error.message));
        if let Some(nearest) = &error.suggestion {
            finding.replace(format!("Write `{nearest}`"), Applicability::Unsafe, oddity.range, nearest.clone());
        }
    }
}
