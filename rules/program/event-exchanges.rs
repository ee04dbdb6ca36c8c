//! P004: an event that has more channels exchanged than it may.

use std::collections::{BTreeMap, BTreeSet};

use crate::analysis::channels::Group;
use crate::analysis::program::{Context, GlobalUse, ProgramIndex};
use crate::analysis::{Site, drives};
use crate::lint::{ProgramCx, Sink};
use crate::model::object::{Area, Class, Footprint, Object};
use crate::target::Limit;
use crate::target::pl7::Exchanges;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let Some(exchanges) = cx.target.exchanges() else { return };
    let program = cx.program;
    let mut events: BTreeMap<u16, Vec<(&Object, GlobalUse<'_>)>> = BTreeMap::new();
    for uses in &program.objects {
        let object = uses.object;
        if !matches!(object.class, Class::Input | Class::Output) || !object.is_fixed() {
            continue;
        }
        let is_output = object.class == Class::Output;
        for it in uses.uses.iter().filter(|it| !is_output || it.mode.writes()) {
            for task in program.tasks(it.unit) {
                if let Context::Event(number) = task {
                    events.entry(number).or_default().push((object, *it));
                }
            }
        }
    }
    for (number, uses) in events {
        let Some(heading) = heading(program, number) else { continue };
        let trigger = cx.settings.trigger_of(number);
        let own = |object: &Object| trigger.is_some_and(|it| shares_exchange(it, object));
        // Without a configured trigger, one of the exchanges of inputs may be that of the channel that raises the event.
        let spare = u32::from(trigger.is_none());
        let mut judge = |limit: Limit, spare: u32, what: &str, of: &dyn Fn(&Object) -> BTreeSet<String>| {
            let mut places: BTreeMap<String, GlobalUse<'_>> = BTreeMap::new();
            for (object, it) in uses.iter().filter(|it| !own(it.0)) {
                for key in of(object) {
                    places.entry(key).or_insert(*it);
                }
            }
            let count = u32::try_from(places.len()).unwrap_or(u32::MAX);
            if count > limit.value + spare {
                let mut places: Vec<GlobalUse<'_>> = places.into_values().collect();
                drives::in_order(program, &mut places);
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
                judge(inputs, spare, "modules of inputs", &|it| module(it, Class::Input));
                judge(outputs, 0, "modules of outputs", &|it| module(it, Class::Output));
            }
            Exchanges::Channels { discrete, analog, other } => {
                let groups = |it: &Object| Group::all_of(it).map(|it| format!("{it:?}")).collect();
                judge(discrete, spare, "groups of discrete channels", &groups);
                // An address does not say whether a word is of an analog module or of another.
                let words = Limit { value: analog.value + other.value, ..analog };
                judge(words, spare, "channels of analog and other modules", &word_channel);
            }
        }
    }
}

fn heading(program: &ProgramIndex<'_>, event: u16) -> Option<Site> {
    let mut units = (0..).take(program.units.len());
    let is_own = |it: &u32| program.is_entry(*it) && program.tasks(*it).any(|it| it == Context::Event(event));
    units.find(is_own).map(ProgramIndex::heading)
}

/// Whether an object comes with the channel that raises the event.
fn shares_exchange(trigger: &Object, object: &Object) -> bool {
    let group = Group::all_of(trigger).next();
    group.is_some_and(|group| Group::all_of(object).any(|it| it == group))
        || trigger.footprint.overlaps(&object.footprint)
        || module(trigger, Class::Input).iter().any(|it| module(object, Class::Input).contains(it))
            && matches!(object.footprint.area, Area::ModuleWords(_))
}

/// The module of an input or an output, by the digits of its address.
fn module(object: &Object, class: Class) -> BTreeSet<String> {
    let module = match &object.footprint.area {
        Area::InputChannels(it) | Area::OutputChannels(it) => it.as_str(),
        Area::ModuleWords(it) => it.trim_start_matches(|it: char| it.is_ascii_alphabetic()),
        _ => return BTreeSet::new(),
    };
    if object.class == class { BTreeSet::from([module.to_owned()]) } else { BTreeSet::new() }
}

/// The channel that a word lies in.
fn word_channel(object: &Object) -> BTreeSet<String> {
    let Footprint { area: Area::ModuleWords(_), .. } = &object.footprint else { return BTreeSet::new() };
    // `%IW3.0.2` is of the channel 3.0.
    let address = object.text.split(':').next().unwrap_or_default();
    let digits = address.trim_start_matches(|it: char| !it.is_ascii_digit() && it != '\\');
    let direction = if object.class == Class::Input { "I" } else { "Q" };
    let channel: Vec<&str> = digits.rsplit('\\').next().unwrap_or_default().split('.').take(2).collect();
    BTreeSet::from([format!("{direction}{:?}{}", object.footprint.area, channel.join("."))])
}
