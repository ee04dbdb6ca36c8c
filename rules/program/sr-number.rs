//! P007: a subroutine of a number that the language does not have, or defined twice.

use rustc_hash::FxHashMap;

use crate::analysis::Site;
use crate::analysis::program::ProgramIndex;
use crate::lint::{ProgramCx, Sink};

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let (Some(range), Some(last)) = (cx.target.subroutines(), cx.target.last_subroutine()) else { return };
    let mut first = FxHashMap::default();
    for unit in (0..).take(cx.program.units.len()) {
        let entity = cx.program.entity(unit);
        let Some(number) = entity.subroutine() else { continue };
        let heading = ProgramIndex::heading(unit);
        if number > last.value {
            let message = format!("`SR{number}` is out of range: SR{} to SR{}", range.first, range.last);
            sink.report(heading, message).note(format!("the range is given in {}", range.source));
        }
        match first.get(&(entity.task(), number)) {
            None => {
                first.insert((entity.task(), number), heading);
            }
            Some(&before) => {
                sink.report(heading, format!("`SR{number}` is defined a second time"))
                    .related(before, "first defined here");
            }
        }
    }
}
