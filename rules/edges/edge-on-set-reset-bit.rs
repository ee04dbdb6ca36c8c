//! E001: the edge of a bit that set or reset drives.

use crate::analysis::Site;
use crate::analysis::program::GlobalUse;
use crate::lint::{ProgramCx, Sink};
use crate::model::unit::Mode;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for uses in cx.program.objects.iter().filter(|it| it.has_mode(Mode::is_edge) && it.object.is_fixed()) {
        let mut edges = uses.with_mode(Mode::is_edge);
        let drives: Vec<&GlobalUse<'_>> = uses.with_mode(|it| matches!(it, Mode::Set | Mode::Reset)).collect();
        let (Some(edge), [_, ..]) = (edges.next(), drives.as_slice()) else { continue };
        let name = &uses.object.text;
        sink.report(edge.site(), format!("the edge of `{name}` is tested, which set or reset drives"))
            .related_all(drives.iter().map(|it| (it.site(), format!("{} here", it.mode.verb()))))
            .related_all(edges.map(|it| (it.site(), format!("also {} here", it.mode.verb()))));
    }
}
