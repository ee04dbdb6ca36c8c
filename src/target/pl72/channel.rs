//! Inputs and outputs (PL72:84-245).

use crate::target::{Limit, Range};

/// The channels of the base unit of a TSX 17-20 that the configuration may make the command to run and the sign of running;
/// a program uses them for what they are configured (PL72:148-152, PL72:1655).
pub const RUN_STOP_INPUT: &str = "I0,00";
pub const SECURITY_OUTPUT: &str = "O0,00";

/// Where inputs and outputs of a controller are. Modules of the TSX 47 lie in racks, those of the others do not.
#[derive(Debug, PartialEq, Eq)]
pub struct Channels {
    /// Channels are written in two decimal digits (PL72:129-131), else in one hexadecimal digit.
    pub two_digits: bool,
    pub racks: Option<Range>,
    pub input_modules: Modules,
    pub output_modules: Modules,
    pub inputs: Range,
    pub outputs: Range,
    /// Inputs of module 0 beyond [`Channels::inputs`] that start the fast task.
    pub event_inputs: Option<Range>,
    /// Modules that may have register words `IWx,i` and `OWx,i`, in rack 0.
    pub word_modules: Option<Range>,
    /// Number of intelligent modules.
    pub word_module_count: Option<Limit>,
    /// Register words of a module.
    pub words: Option<Range>,
}

impl Channels {
    /// Why a bit of an input or output is none of this controller; `None` when it may be one. `rack` as it is written.
    pub fn misfit(&self, is_output: bool, rack: Option<u32>, module: u32, number: u32) -> Option<Misfit> {
        let (modules, channels) =
            if is_output { (self.output_modules, self.outputs) } else { (self.input_modules, self.inputs) };
        let is_event = !is_output && module == 0 && self.event_inputs.is_some_and(|it| it.contains(number));
        match (rack, self.racks) {
            (Some(_), None) => return Some(Misfit::NoRacks),
            (Some(rack), Some(racks)) if !racks.contains(rack) => return Some(Misfit::Rack(racks)),
            _ => {}
        }
        if !modules.contains(module) {
            return Some(Misfit::Module(modules));
        }
        (!is_event && !channels.contains(number)).then_some(Misfit::Channel(channels))
    }
}

/// What of an address a controller does not have, and what it has instead.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Misfit {
    NoRacks,
    Rack(Range),
    Module(Modules),
    Channel(Range),
}

/// Module numbers: all of a range, or each second one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Modules {
    pub range: Range,
    pub step: u32,
}

impl Modules {
    const fn all(range: Range) -> Self {
        Self { range, step: 1 }
    }

    const fn every_second(range: Range) -> Self {
        Self { range, step: 2 }
    }

    pub fn contains(&self, module: u32) -> bool {
        self.range.contains(module) && (module - self.range.first).is_multiple_of(self.step)
    }
}

pub(super) static CHANNELS_17: Channels = Channels {
    two_digits: true,
    racks: None,
    input_modules: Modules::all(Range::new(0, 3, "PL72:96")),
    output_modules: Modules::all(Range::new(0, 3, "PL72:96")),
    inputs: Range::new(0, 23, "PL72:99"),
    outputs: Range::new(0, 15, "PL72:100"),
    event_inputs: Some(Range::new(24, 25, "PL72:104")),
    word_modules: Some(Range::new(1, 3, "PL72:160")),
    word_module_count: Some(Limit::new(3, "PL72:112")),
    words: Some(Range::new(0, 7, "PL72:162")),
};

pub(super) static CHANNELS_27: Channels = Channels {
    two_digits: false,
    racks: None,
    input_modules: Modules::every_second(Range::new(1, 7, "PL72:182")),
    output_modules: Modules::every_second(Range::new(0, 6, "PL72:174")),
    inputs: Range::new(0, 0xB, "PL72:184"),
    outputs: Range::new(0, 7, "PL72:176"),
    event_inputs: None,
    word_modules: None,
    word_module_count: None,
    words: None,
};

const fn channels_47(racks: Range, modules: Range) -> Channels {
    Channels {
        two_digits: false,
        racks: Some(racks),
        input_modules: Modules::all(modules),
        output_modules: Modules::all(modules),
        inputs: Range::new(0, 0xF, "PL72:200"),
        outputs: Range::new(0, 0xF, "PL72:200"),
        event_inputs: None,
        word_modules: None,
        word_module_count: None,
        words: None,
    }
}

const RACKS_47: Range = Range::new(0, 1, "PL72:196");
const MODULES_47: Range = Range::new(0, 7, "PL72:198");

pub(super) static CHANNELS_47_J: Channels = channels_47(Range::new(0, 0, "PL72:206"), Range::new(0, 4, "PL72:208"));
pub(super) static CHANNELS_47_10: Channels = channels_47(RACKS_47, MODULES_47);
pub(super) static CHANNELS_47_20: Channels = Channels {
    word_modules: Some(Range::new(0, 3, "PL72:239")),
    word_module_count: Some(Limit::new(2, "PL72:243")),
    words: Some(Range::new(0, 7, "PL72:241")),
    ..channels_47(RACKS_47, MODULES_47)
};
