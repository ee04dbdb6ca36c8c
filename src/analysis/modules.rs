//! Channels of PL7-2 programs against the modules that their controller may have (PL72:84-245).

use super::program::{ObjectUses, ProgramIndex};
use crate::model::object::pl72::{self, Channel, ChannelItem};
use crate::model::object::{Area, Class, Object};
use crate::target::pl72::{Channels, Controller, Kind, Misfit, Model};

/// An input, output, register word or fault that the controller does not have.
#[derive(Debug)]
pub struct Misplaced<'p, 'a> {
    pub uses: &'p ObjectUses<'a>,
    /// What is wrong with it, behind its name.
    pub reason: String,
    pub source: &'static str,
}

/// Those of a program, in the order of its objects; none without a controller.
pub fn misplaced<'p, 'a>(program: &'p ProgramIndex<'a>, model: &Model) -> Vec<Misplaced<'p, 'a>> {
    let Some(controller) = model.controller else { return Vec::new() };
    let wrong = program.objects.iter().filter_map(|uses| {
        let (reason, source) = misfit(uses.object, controller, model)?;
        Some(Misplaced { uses, reason, source })
    });
    wrong.collect()
}

fn misfit(object: &Object, controller: &Controller, model: &Model) -> Option<(String, &'static str)> {
    let name = controller.name;
    let none = |kind: Kind, what: &str| {
        let count = model.count(kind);
        (count.value == 0).then(|| (format!("a {name} has no faults of {what}"), count.source))
    };
    if matches!(&object.footprint.area, Area::Faults(it) if it.starts_with('S')) {
        return none(Kind::ModuleFault, "modules by number");
    }
    if !matches!(object.class, Class::Input | Class::Output | Class::Fault) {
        return None;
    }
    let channel = pl72::channel(&object.text)?;
    let Channel { is_output, module, .. } = channel;
    let rack = channel.has_rack.then_some(channel.rack);
    let channels = controller.channels;
    let what = if is_output { "outputs" } else { "inputs" };
    let number = match channel.item {
        ChannelItem::Decimal(number) if channels.two_digits => number,
        ChannelItem::Hexadecimal(number) if !channels.two_digits => number,
        ChannelItem::Decimal(_) => {
            return Some((format!("the channels of a {name} are one digit from 0 to F"), channels.inputs.source));
        }
        ChannelItem::Hexadecimal(_) => {
            return Some((format!("the channels of a {name} are two digits"), "PL72:129-131"));
        }
        ChannelItem::Fault => {
            let kind = if is_output { Kind::OutputFault } else { Kind::InputFault };
            return none(kind, what).or_else(|| of_module(channels, is_output, rack, module, 0, what, name));
        }
        ChannelItem::Word(_) => {
            // Of a controller without such modules, the table of versions speaks.
            let modules = channels.word_modules.filter(|it| !it.contains(module))?;
            let range = format!("{} to {}", modules.first, modules.last);
            return Some((format!("modules of a {name} with words are {range}"), modules.source));
        }
    };
    of_module(channels, is_output, rack, module, number, what, name)
}

fn of_module(
    channels: &Channels,
    is_output: bool,
    rack: Option<u32>,
    module: u32,
    number: u32,
    what: &str,
    name: &str,
) -> Option<(String, &'static str)> {
    Some(match channels.misfit(is_output, rack, module, number)? {
        Misfit::NoRacks => (format!("a {name} has no racks"), channels.input_modules.range.source),
        Misfit::Rack(racks) if racks.first == racks.last => {
            (format!("a {name} has rack {} alone", racks.first), racks.source)
        }
        Misfit::Rack(racks) => (format!("the racks of a {name} are {} to {}", racks.first, racks.last), racks.source),
        Misfit::Module(modules) => {
            let numbers: Vec<String> = (modules.range.first..=modules.range.last)
                .filter(|it| modules.contains(*it))
                .map(|it| it.to_string())
                .collect();
            (format!("modules of a {name} with {what} are {}", numbers.join(", ")), modules.range.source)
        }
        Misfit::Channel(range) => {
            let last = if channels.two_digits { format!("{:02}", range.last) } else { format!("{:X}", range.last) };
            (format!("the last one of the {what} of a module of a {name} is {last}"), range.source)
        }
    })
}
