//! P004: an event that has more channels exchanged than it may.

use std::collections::BTreeMap;

use crate::analysis::channels::{self, Exchange};
use crate::analysis::program::{Context, GlobalUse, ProgramIndex};
use crate::analysis::{Site, drives};
use crate::lint::{ProgramCx, Sink};
use crate::model::object::{Class, Object};
use crate::target::Limit;
use crate::target::pl7::Exchanges;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let Some(exchanges) = cx.target.exchanges() else { return };
    for (number, mut uses) in channels::of_events(cx.program) {
        let Some(heading) = heading(cx.program, number) else { continue };
        let trigger = cx.settings.trigger_of(number);
        uses.retain(|it| !trigger.is_some_and(|trigger| channels::comes_with(trigger, it.0)));
        // Without a configured trigger, one of the exchanges of inputs may be that of the channel that raises the event.
        let spare = u32::from(trigger.is_none());
        let mut judge = |limit: Limit, spare: u32, what: &str, of: &dyn Fn(&'_ Object) -> Vec<Exchange<'_>>| {
            let mut places: BTreeMap<Exchange<'_>, GlobalUse<'_>> = BTreeMap::new();
            for (object, it) in &uses {
                for exchange in of(object) {
                    places.entry(exchange).or_insert(*it);
                }
            }
            let count = u32::try_from(places.len()).unwrap_or(u32::MAX);
            if count > limit.value + spare {
                let mut places: Vec<GlobalUse<'_>> = places.into_values().collect();
                drives::in_order(cx.program, &mut places);
                let message = format!("EVT{number} exchanges {count} {what}, and {} are allowed", limit.value);
                let finding = sink
                    .report(heading, message)
                    .related_all(places.iter().map(|it| (it.site(), "exchanged for this".to_owned())))
                    .note(format!("the number is given in {}", limit.source));
                if spare > 0 {
                    finding.note("one of them may be that of the channel that raises the event, which does not count");
                }
            }
        };
        match exchanges {
            Exchanges::Modules { inputs, outputs } => {
                judge(inputs, spare, "modules of inputs", &|it| modules(it, Class::Input));
                judge(outputs, 0, "modules of outputs", &|it| modules(it, Class::Output));
            }
            Exchanges::Channels { discrete, analog, other } => {
                judge(discrete, spare, "groups of discrete channels", &|it| Exchange::groups(it));
                // An address does not say whether a word is of an analog module or of another.
                let words = Limit { value: analog.value + other.value, ..analog };
                judge(words, spare, "channels of analog and other modules", &|it| {
                    Exchange::word_channel(it).into_iter().collect()
                });
            }
        }
    }
}

fn modules(object: &Object, class: Class) -> Vec<Exchange<'_>> {
    Exchange::module(object).filter(|_| object.class == class).into_iter().collect()
}

fn heading(program: &ProgramIndex<'_>, event: u16) -> Option<Site> {
    let mut units = (0..).take(program.units.len());
    let is_own = |it: &u32| program.is_entry(*it) && program.tasks(*it).any(|it| it == Context::Event(event));
    units.find(is_own).map(ProgramIndex::heading)
}
