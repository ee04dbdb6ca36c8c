//! N003: a section whose name is too long.

use rustc_hash::FxHashSet;

use crate::analysis::Site;
use crate::analysis::program::ProgramIndex;
use crate::lint::{ProgramCx, Severity, Sink};
use crate::model::entity::Entity;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let Some((longest, in_editor)) = cx.target.section_name_length() else { return };
    // A section of a chart is several units: its processing before and after, and the chart.
    let mut seen = FxHashSet::default();
    for unit in (0..).take(cx.program.units.len()) {
        let Entity::Pl7 { task, section: Some(name), .. } = cx.program.entity(unit) else { continue };
        let length = name.chars().count();
        if length <= in_editor.value as usize || !seen.insert((task, name)) {
            continue;
        }
        let is_too_long = length > longest.value as usize;
        let limit = if is_too_long { longest } else { in_editor };
        let takes = if is_too_long { "a section's name has" } else { "the program editor takes" };
        let message = format!("`{name}` has {length} characters, and {takes} {} at most", limit.value);
        let found = sink.report(ProgramIndex::heading(unit), message);
        let found = found.note(format!("the length is given in {}", limit.source));
        if !is_too_long {
            found.severity(Severity::Advice);
        }
    }
}
