//! F003: a name that a parameter or variable of a DFB cannot have.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::syntax::pl7::is_reserved;
use crate::target::pl7::DFB_ITEM_NAME_LENGTH;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    for item in cx.model.interface.iter().flat_map(|it| &it.items) {
        if let Some(flaw) = flaw(&item.name) {
            sink.report(cx.model.place(item.anchor), format!("the {} `{}` {flaw}", item.role.describe(), item.name));
        }
    }
}

/// Why a name is none, as the end of a sentence.
fn flaw(name: &str) -> Option<String> {
    let length = name.chars().count();
    if let Some(wrong) = name.chars().find(|it| !it.is_ascii_alphanumeric() && *it != '_') {
        Some(format!("holds `{}`: letters without accent, digits and underscores are allowed", wrong.escape_debug()))
    } else if !name.starts_with(|it: char| it.is_ascii_alphabetic()) {
        Some("does not begin with a letter".to_owned())
    } else if length > DFB_ITEM_NAME_LENGTH.value as usize {
        Some(format!("has a name of {length} characters, {} are allowed", DFB_ITEM_NAME_LENGTH.value))
    } else if is_reserved(name) {
        Some("has a word of the language for a name".to_owned())
    } else {
        None
    }
}
