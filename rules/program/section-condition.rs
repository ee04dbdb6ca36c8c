//! P001: a section's condition that cannot be one.

use crate::analysis::Site;
use crate::analysis::program::ProgramIndex;
use crate::lint::{ProgramCx, Sink};
use crate::model::object::{Class, Object};

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for section in cx.program.conditional_sections() {
        if let Some(&first) = section.units.first()
            && !can_condition(section.condition)
        {
            let message = format!("`{}` cannot be the condition of a section", section.condition.text);
            let Some(place) = cx.settings.condition_site(cx.program.entity(first)) else { continue };
            sink.report(place, message)
                .related(ProgramIndex::heading(first), "the section")
                .note("a bit %M, %S, %X, %I or %Q can, or one of a word, or an indexed one (PL7:1984)");
        }
    }
}

/// The fault bits of channels and modules are among the bits that the manual names (PL7:1984).
fn can_condition(object: &Object) -> bool {
    let is_named = matches!(
        object.class,
        Class::Memory | Class::System | Class::Step | Class::MacroStep | Class::Input | Class::Output | Class::Fault
    );
    object.is_bit() && (object.extracted || is_named)
}
