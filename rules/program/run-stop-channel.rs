//! P009: the program uses a channel that commands the controller, or tells of it.

use crate::analysis::{Site, drives};
use crate::lint::{ProgramCx, Sink};
use crate::model::object::pl72;
use crate::target::pl72::{RUN_STOP_INPUT, SECURITY_OUTPUT, Series};

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let model = cx.target.pl72();
    if model.is_none_or(|it| it.controller.is_some_and(|it| it.series != Series::Tsx17)) {
        return;
    }
    let channels = [
        (RUN_STOP_INPUT, cx.settings.run_stop_input(), "run-stop-input", "commands the controller to run and to stop"),
        (SECURITY_OUTPUT, cx.settings.security_output(), "security-output", "tells that the controller runs"),
    ];
    for (address, configured, key, role) in channels {
        let Some(configured) = configured else { continue };
        let Ok(channel) = pl72::parse(address) else { continue };
        let uses = cx.program.objects_that(|_| true, |it| it.footprint.overlaps(&channel.object.footprint));
        for it in uses {
            let mut places = it.uses.clone();
            drives::in_order(cx.program, &mut places);
            let Some(first) = places.first() else { continue };
            let text = &it.object.text;
            let subject =
                if text == address { format!("`{text}`") } else { format!("`{address}`, which is in `{text}`,") };
            sink.report(first.site(), format!("{subject} {role}, and the program uses it"))
                .related_all(places.iter().skip(1).map(|it| (it.site(), "also here".to_owned())))
                .related(cx.settings.site(configured), format!("`{key}` says so"));
        }
    }
}
