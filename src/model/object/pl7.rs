//! Addresses of PL7 objects, as PL7:540-1240 defines them.
//!
//! Numbers that only some controller lacks are not judged here: that is the business of [`crate::target`].

use crate::target::{Range, pl7 as target};

use smol_str::{SmolStr, format_smolstr};

use super::address::{Cursor, LONGEST_SUGGESTION_SOURCE, Number, Place, malformed, upper_case};
use super::{AddressError, AddressErrorKind, Area, Class, Object, Rights, Type};

/// Object numbers above this one exist on no controller. The largest counts of the manual are 32634 bits (PL7:1691) and
/// 30.5 K words (PL7:1705); a configured count is the business of the target.
const LAST_NUMBER: u32 = 65_535;
/// Largest count of one kind of function block is 255 (PL7:976-994).
const LAST_BLOCK: u32 = 254;
/// PL7:1592, PL7:4282.
const LAST_STEP: u32 = 1023;
/// A macro-step has at most 250 steps (PL7:4281).
const LAST_MACRO_STEP_STEP: u32 = 249;
/// First number of the steps of macro-step 0 in [`Area::Steps`]; macro-step n starts n strides later.
const MACRO_STRIDE: u32 = 1024;
const STEP_IN: u32 = 1000;
const STEP_OUT: u32 = 1001;
/// The number that stands for the channel `MOD`.
const MOD: u32 = 1000;
/// Bits of rank 1 and above follow those of the channels: `%I3.0.1` is not `%I3.1`.
const RANKED_BITS: u32 = 1024;
/// Ranks go to 255 (PL7:811), so a channel takes 256 bits, or 256 words and room for the tail of a double word.
const RANKS: u32 = 256;
const CHANNEL_WORDS: u32 = 2 * RANKS * 16;
/// Reads an address without blanks, in either case: `%MW10:X4`, `%I\0.2.1\0.7`, `%TM8.Q`.
///
/// # Errors
/// [`AddressErrorKind::Malformed`] with the nearest valid form where there is one; [`AddressErrorKind::OutOfRange`] for
/// a number that no controller has.
pub fn parse(address: &str) -> Result<Object, AddressError> {
    let upper = upper_case(address);
    match read(&upper) {
        Ok(place) => Ok(place.object(address.into(), BLOCK_BITS)),
        Err(error) => Err(with_suggestion(error, &upper)),
    }
}

/// Reads an indexed address: `base` is what stands before the index (`%MW50`, `%X20.T`) and `suffix` what stands after it
/// (`:10`, `:X4`, `.T`). The object's text shows the index as `[..]`; who knows the index replaces it.
///
/// # Errors
/// As [`parse`]; an object that has no index (PL7:1098-1119) is malformed.
pub fn parse_indexed(base: &str, suffix: Option<&str>) -> Result<Object, AddressError> {
    let suffix = suffix.unwrap_or_default();
    let upper =
        if suffix.is_empty() { upper_case(base) } else { format!("{base}{suffix}").to_ascii_uppercase().into() };
    let place = match read(&upper) {
        Ok(place) => place,
        Err(mut error) => {
            error = with_suggestion(error, &upper);
            // The suggestion has lost the index, so it cannot replace what the user wrote.
            error.suggestion = None;
            return Err(error);
        }
    };
    if base.contains(':') || !(suffix.is_empty() || suffix.starts_with(':') || suffix.eq_ignore_ascii_case(".T")) {
        return Err(malformed("an index stands after the number of the object, before `:` and the length or bit"));
    }
    let Some(rights) = place.indexed_rights() else {
        return Err(malformed(format!("`{base}` cannot be indexed: the objects that can are listed in PL7:1102-1119")));
    };
    let text = format_smolstr!("{base}[..]{suffix}");
    Ok(Object { indexed: true, rights, ..place.object(text, BLOCK_BITS) })
}

/// The address that a bare name seems to be: `%MW108` for `MW108`, `%X3.T` for `X3.T`. `None` when the name does not look
/// like one, or already is one.
pub fn suggest(name: &str) -> Option<String> {
    if name.len() > LONGEST_SUGGESTION_SOURCE || name.starts_with('%') {
        return None;
    }
    let upper = format!("%{}", name.to_ascii_uppercase());
    match read(&upper) {
        Ok(_) => Some(upper),
        Err(_) => nearest(&upper),
    }
}

/// Symbol of the function block that an object belongs to, and its number: `TM` and 8 for `%TM8.Q`.
pub fn block_of(object: &Object) -> Option<(&'static str, u32)> {
    match object.footprint.area {
        Area::Block(symbol, number) => Some((symbol, number)),
        _ => None,
    }
}

/// Whether an object is the preset of a function block: `%TM2.P`.
pub fn is_preset(object: &Object) -> bool {
    let item = block_of(object).and_then(|(symbol, _)| {
        let block = BLOCKS.iter().find(|it| it.symbol == symbol)?;
        block.items.iter().find(|it| it.start == object.footprint.start && it.class == object.class)
    });
    !object.extracted && item.is_some_and(|it| it.name == "P")
}

/// Whether a step belongs to a macro-step, and to which: 5 for `%X5.9`, `%X5.IN` and their times.
pub fn macro_step_of(object: &Object) -> Option<u32> {
    let index = match object.footprint.area {
        Area::Steps => object.footprint.start,
        Area::StepTimes => object.footprint.start / 16,
        _ => return None,
    };
    (index / MACRO_STRIDE).checked_sub(1)
}

impl Place {
    /// `:X4`. PL7:631 allows it for single words alone.
    fn bit(self, rank: Number<'_>) -> Result<Self, AddressError> {
        if self.ty != Type::Word {
            return Err(malformed("only a single word has bits to extract (PL7:631)"));
        }
        let rank = rank.of("extracted bit", target::WORD_BITS)?;
        Ok(Self { ty: Type::Bool, start: self.start + rank, extracted: true, room: None, ..self })
    }

    /// `:L`.
    fn table(self, length: Number<'_>) -> Result<Self, AddressError> {
        let Some(room) = self.room else {
            return Err(malformed("this object has no tables: those that have are listed in PL7:1009-1061"));
        };
        let length = length.within("table length", 1..=room.max(1), "PL7:1017-1045")?;
        let (ty, rights) = match (self.ty, self.class) {
            (Type::Bool, Class::Input) => (Type::BitTable(length), Rights::ReadOnly("PL7:1012")),
            (Type::Bool, _) => (Type::BitTable(length), self.rights),
            (Type::Word, Class::Constant) => (Type::WordTable(length), Rights::ReadOnly("PL7:1036")),
            (Type::Word, Class::StepTime) => (Type::WordTable(length), Rights::ReadOnly("PL7:1039")),
            (Type::Word, _) => (Type::WordTable(length), self.rights),
            (Type::Double, Class::Constant) => (Type::DoubleTable(length), Rights::ReadOnly("PL7:1037")),
            (Type::Double, _) => (Type::DoubleTable(length), self.rights),
            (Type::Float, Class::Constant) => (Type::FloatTable(length), Rights::ReadOnly("PL7:1038")),
            (Type::Float, _) => (Type::FloatTable(length), self.rights),
            (Type::Byte, _) => (Type::Text(length), self.rights),
            _ => return Err(malformed("this object has no tables: those that have are listed in PL7:1009-1061")),
        };
        Ok(Self { ty, rights, room: None, ..self })
    }

    /// What may be done with the object when it is indexed; `None` when it cannot be (PL7:1102-1119, PL7:4240, PL7:4253;
    /// the bits of an indexed word: PL7:640).
    fn indexed_rights(&self) -> Option<Rights> {
        Some(match (self.class, self.ty) {
            (Class::Input, Type::Bool) if !self.extracted => Rights::ReadOnly("PL7:1103"),
            (Class::Output, Type::Bool) if !self.extracted => Rights::ReadWrite,
            (Class::Memory | Class::Step | Class::MacroStep, Type::Bool) => Rights::ReadWrite,
            (Class::Memory, Type::Word | Type::Double | Type::Float) => Rights::ReadWrite,
            (Class::Memory, Type::WordTable(_) | Type::DoubleTable(_) | Type::FloatTable(_)) => Rights::ReadWrite,
            (Class::Constant, Type::Word | Type::Bool) => Rights::ReadOnly("PL7:1111"),
            (Class::Constant, Type::Double) => Rights::ReadOnly("PL7:1112"),
            (Class::Constant, Type::Float) => Rights::ReadOnly("PL7:1113"),
            (Class::Constant, Type::WordTable(_)) => Rights::ReadOnly("PL7:1118"),
            (Class::Constant, Type::DoubleTable(_) | Type::FloatTable(_)) => Rights::ReadOnly("PL7:1119"),
            (Class::StepTime, Type::Word | Type::Bool) => Rights::ReadOnly("PL7:1114"),
            _ => return None,
        })
    }
}

/// What a function block lets a program reach (PL7:975-997).
struct BlockSymbol {
    symbol: &'static str,
    items: &'static [Item],
}

struct Item {
    name: &'static str,
    class: Class,
    /// First bit in the area of the block.
    start: u32,
    rights: Rights,
}

const fn word(name: &'static str, start: u32, rights: Rights) -> Item {
    Item { name, class: Class::BlockWord, start, rights }
}

const fn bit(name: &'static str, start: u32, rights: Rights) -> Item {
    Item { name, class: Class::BlockBit, start, rights }
}

/// Words at 0, 16 and 32, bits from 48, the step words `%DRi.Wj` from 64.
const BLOCK_BITS: u32 = DRUM_WORDS + 16 * DRUM_STEPS;
const DRUM_WORDS: u32 = 64;
/// A drum has 16 steps (PL72:445, the vendor's general documentation for PL7).
const DRUM_STEPS: u32 = 16;

const BLOCKS: &[BlockSymbol] = &[
    BlockSymbol {
        symbol: "TM",
        items: &[
            word("V", 0, Rights::ReadOnly("PL7:976")),
            word("P", 16, Rights::ReadWrite),
            bit("Q", 48, Rights::ReadOnly("PL7:978")),
        ],
    },
    BlockSymbol {
        symbol: "C",
        items: &[
            word("V", 0, Rights::ReadOnly("PL7:979")),
            word("P", 16, Rights::ReadWrite),
            bit("E", 48, Rights::ReadOnly("PL7:981")),
            bit("D", 49, Rights::ReadOnly("PL7:982")),
            // Counting over: the vendor's general documentation; PL7:576 for the right of every block output.
            bit("F", 50, Rights::ReadOnly("PL7:576")),
        ],
    },
    BlockSymbol {
        symbol: "MN",
        items: &[
            word("V", 0, Rights::ReadOnly("PL7:983")),
            word("P", 16, Rights::ReadWrite),
            bit("R", 48, Rights::ReadOnly("PL7:985")),
        ],
    },
    BlockSymbol {
        symbol: "R",
        items: &[
            word("I", 0, Rights::ReadWrite),
            word("O", 16, Rights::ReadWrite),
            bit("F", 48, Rights::ReadOnly("PL7:988")),
            bit("E", 49, Rights::ReadOnly("PL7:989")),
        ],
    },
    BlockSymbol {
        symbol: "DR",
        items: &[
            word("S", 0, Rights::ReadWrite),
            word("V", 16, Rights::ReadOnly("PL7:992")),
            bit("F", 48, Rights::ReadOnly("PL7:993")),
        ],
    },
    BlockSymbol {
        symbol: "T",
        items: &[
            word("V", 0, Rights::ReadOnly("PL7:994")),
            word("P", 16, Rights::ReadWrite),
            bit("R", 48, Rights::ReadOnly("PL7:996")),
            bit("D", 49, Rights::ReadOnly("PL7:997")),
        ],
    },
];

impl Number<'_> {
    fn object_number(self) -> Result<u32, AddressError> {
        self.within("object number", 0..=LAST_NUMBER, "no controller has more, PL7:1584-1728")
    }
}

/// Reads an address in upper case.
fn read(text: &str) -> Result<Place, AddressError> {
    if !text.is_ascii() {
        return Err(malformed("an address has neither accents nor other special characters (PL7:611)"));
    }
    let Some(body) = text.strip_prefix('%') else {
        return Err(malformed("an address starts with `%` (PL7:611)"));
    };
    let mut at = Cursor { rest: body };
    let mut place = base(&mut at)?;
    if at.eat(':') {
        place = if at.eat('X') {
            place.bit(at.need_number("rank of the extracted bit")?)?
        } else {
            place.table(at.need_number("length of the table, or the rank of the bit (`:X4`)")?)?
        };
    }
    if at.rest.is_empty() { Ok(place) } else { Err(malformed("the end of the address is not part of its form")) }
}

/// What stands before `:`.
fn base(at: &mut Cursor<'_>) -> Result<Place, AddressError> {
    let letters = at.letters();
    let initial = letters.as_bytes().first();
    if let Some(block) = BLOCKS.iter().find(|it| it.symbol.as_bytes().first() == initial && it.symbol == letters) {
        return block_object(block, at);
    }
    match letters {
        "X" => step(at),
        "XM" => {
            let number = at.need_number("number of the macro-step")?;
            let number = number.of("macro-step", target::MACRO_STEPS)?;
            Ok(Place::new(Class::MacroStep, Type::Bool, Area::MacroSteps, number, Rights::ReadWrite))
        }
        "NW" => network_word(at),
        "CH" => channel(at),
        "L" => Err(malformed("`%L` is a label, not an object (PL7:2676)")),
        "SR" => Err(malformed("`%SR` is a subroutine, not an object (PL7:2004)")),
        "EVT" => Err(malformed("`%EVT` is an event, not an object (PL7:2060)")),
        _ => {
            let mut chars = letters.chars();
            let (kind, format) = (chars.next(), chars.next());
            if chars.next().is_some() {
                return Err(unknown_kind());
            }
            let ty = match format {
                None | Some('X') => Type::Bool,
                Some('B') => Type::Byte,
                Some('W') => Type::Word,
                Some('D') => Type::Double,
                Some('F') => Type::Float,
                Some(_) => return Err(unknown_kind()),
            };
            match kind {
                Some('S') if format != Some('X') => system(ty, at),
                Some(kind @ ('I' | 'Q')) if ty != Type::Byte => module_object(kind, ty, at),
                Some(kind @ ('M' | 'K')) => internal_or_module(kind, format, ty, at),
                _ => Err(unknown_kind()),
            }
        }
    }
}

fn unknown_kind() -> AddressError {
    malformed(
        "no object has these letters: PL7 has %M %S %X %I %Q %MW %KW %SW %NW and the function blocks (PL7:607-997)",
    )
}

/// `%M10`, `%MW10`, `%KD26`, or the words that a module exchanges at the program's request: `%MW2.0.3`.
fn internal_or_module(kind: char, format: Option<char>, ty: Type, at: &mut Cursor<'_>) -> Result<Place, AddressError> {
    let start = at.rest;
    if ty != Type::Byte && at.at('\\') {
        return module_object(kind, ty, at);
    }
    let number = at.need_number("number of the object")?;
    if ty != Type::Byte && at.at('.') {
        at.rest = start;
        return module_object(kind, ty, at);
    }
    let (class, area, rights) = match kind {
        'M' => (Class::Memory, Area::Words, Rights::ReadWrite),
        _ => (Class::Constant, Area::Constants, Rights::ReadOnly("PL7:588")),
    };
    match ty {
        Type::Bool if kind == 'M' && format.is_none() => {
            let number = number.object_number()?;
            let room = LAST_NUMBER - number + 1;
            Ok(Place::new(class, ty, Area::Bits, number, rights).with_room(room))
        }
        Type::Bool => Err(unknown_kind()),
        Type::Byte => {
            let last = 2 * LAST_NUMBER + 1;
            let number = number.within("byte", 0..=last, "no controller has more words, PL7:1584-1728")?;
            Ok(Place::new(class, ty, area, number * 8, rights).with_room(last - number + 1))
        }
        _ => {
            let number = number.object_number()?;
            let words = if ty == Type::Word { 1 } else { 2 };
            let room = (LAST_NUMBER - number + 1) / words;
            Ok(Place::new(class, ty, area, number * 16, rights).with_room(room))
        }
    }
}

/// `%S20`, `%SW30`. What the system manages is described in volume 2; volume 1 says of some that a program writes them.
fn system(ty: Type, at: &mut Cursor<'_>) -> Result<Place, AddressError> {
    let number = at.need_number("number of the object")?;
    match ty {
        Type::Bool => {
            let number = number.within("system bit", 0..=127, "PL7:575")?;
            // PL7:1148, 1787, 1828, 2401-2403, 5007-5089, 5456-5460.
            let written = matches!(number, 0 | 1 | 20..=24 | 30 | 31 | 38 | 94 | 95);
            let rights = if written { Rights::ReadWrite } else { Rights::Unknown };
            Ok(Place::new(Class::System, ty, Area::SystemBits, number, rights))
        }
        Type::Byte => Err(malformed("the byte format is for strings of internal and constant words (PL7:885, 1057)")),
        _ => {
            let number = number.object_number()?;
            // PL7:1040, 2031, 2298, 2517, 5102.
            let written = matches!(number, 0 | 1 | 22..=25 | 48 | 50..=53);
            let rights = if written { Rights::ReadWrite } else { Rights::Unknown };
            let words = if ty == Type::Word { 1 } else { 2 };
            let room = (LAST_NUMBER - number + 1) / words;
            Ok(Place::new(Class::System, ty, Area::SystemWords, number * 16, rights).with_room(room))
        }
    }
}

/// `%X3`, `%X5.9`, `%X5.IN`, and their times with `.T` (PL7:1156-1182).
fn step(at: &mut Cursor<'_>) -> Result<Place, AddressError> {
    let first = at.need_number("number of the step")?;
    let mut time = false;
    let (index, room) = if at.rest.starts_with(".T") || !at.at('.') {
        let step = first.within("step", 0..=LAST_STEP, "PL7:1592")?;
        (step, LAST_STEP - step + 1)
    } else {
        let macro_step = first.of("macro-step", target::MACRO_STEPS)?;
        at.need('.')?;
        let base = MACRO_STRIDE * (macro_step + 1);
        match at.letters() {
            "IN" => (base + STEP_IN, 0),
            "OUT" => (base + STEP_OUT, 0),
            "" => {
                let step = at.need_number("number of the step")?;
                let step = step.within("step of a macro-step", 0..=LAST_MACRO_STEP_STEP, "PL7:4281")?;
                (base + step, LAST_MACRO_STEP_STEP - step + 1)
            }
            _ => return Err(malformed("a step of a macro-step is a number, `IN` or `OUT` (PL7:1163-1165)")),
        }
    };
    if at.eat('.') {
        if at.letters() != "T" {
            return Err(malformed("a step has a bit and a time `.T` only (PL7:1156-1180)"));
        }
        time = true;
    }
    let place = if time {
        Place::new(Class::StepTime, Type::Word, Area::StepTimes, index * 16, Rights::ReadWrite)
    } else {
        Place::new(Class::Step, Type::Bool, Area::Steps, index, Rights::ReadWrite)
    };
    Ok(if room > 0 { place.with_room(room) } else { place })
}

/// `%NW{2.3}1` (PL7:910-912). `%NW2.3`, as PL7:591 prints it, is station and word of network 0.
fn network_word(at: &mut Cursor<'_>) -> Result<Place, AddressError> {
    let (network, station, word) = if at.eat('{') {
        let network = at.need_number("network number")?.of("network", target::NETWORKS)?;
        at.need('.')?;
        let station = at.need_number("station number")?;
        at.need('}')?;
        (network, station, at.need_number("word number")?)
    } else {
        let station = at.need_number("station number")?;
        at.need('.')?;
        (0, station, at.need_number("word number")?)
    };
    let station = station.of("station", target::NETWORK_STATIONS)?;
    let word = word.of("common word", target::NETWORK_WORDS)?;
    Ok(Place::new(Class::NetworkWord, Type::Word, Area::Network(network, station), word * 16, Rights::ReadWrite))
}

/// `%CH3.0`: the channel itself, operand of the explicit exchanges (PL7:1264, 1287).
fn channel(at: &mut Cursor<'_>) -> Result<Place, AddressError> {
    let place = ModulePlace::read(at)?;
    if place.bus == Bus::AsI || place.rank != Rank::None {
        return Err(malformed("a channel is written `%CHxy.i`, without rank (PL7:1264)"));
    }
    let area = Area::ModuleWords(format_smolstr!("CH{}", place.module));
    Ok(Place::new(Class::ModuleWord, Type::Block, area, place.channel, Rights::Unknown))
}

/// `%TM8`, `%TM8.Q`, `%DR0.W3`.
fn block_object(block: &BlockSymbol, at: &mut Cursor<'_>) -> Result<Place, AddressError> {
    let number = at.need_number("number of the block")?;
    let number = number.within("function block", 0..=LAST_BLOCK, "PL7:976-994")?;
    let area = Area::Block(block.symbol, number);
    if !at.eat('.') {
        return Ok(Place::new(Class::Block, Type::Block, area, 0, Rights::Unknown));
    }
    let name = at.letters();
    if block.symbol == "DR" && name == "W" {
        let step = at.need_number("number of the drum step")?;
        let step = step.within("drum step", 0..=DRUM_STEPS - 1, "PL72:445")?;
        let start = DRUM_WORDS + 16 * step;
        return Ok(Place::new(Class::BlockWord, Type::Word, area, start, Rights::ReadOnly("PL7:991")));
    }
    let Some(item) = block.items.iter().find(|it| it.name == name) else {
        let mut names: Vec<_> = block.items.iter().map(|it| format!(".{}", it.name)).collect();
        if block.symbol == "DR" {
            names.push(".Wj".to_owned());
        }
        let names = names.join(" ");
        return Err(malformed(format!("a `%{}` block has the objects {names} only (PL7:975-997)", block.symbol)));
    };
    let ty = if item.class == Class::BlockBit { Type::Bool } else { Type::Word };
    Ok(Place::new(item.class, ty, area, item.start, item.rights))
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Bus {
    Rack,
    Fipio,
    AsI,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Rank {
    None,
    Number(u32),
    Err,
}

/// Where a module's object lies: module, channel, rank.
struct ModulePlace {
    bus: Bus,
    module: SmolStr,
    channel: u32,
    rank: Rank,
}

impl ModulePlace {
    fn read(at: &mut Cursor<'_>) -> Result<Self, AddressError> {
        if !at.eat('\\') {
            return Self::in_rack(at);
        }
        let first = at.need_number("position")?;
        at.need('.')?;
        let second = at.need_number("channel")?;
        if at.eat('.') { Self::fipio(first, second, at) } else { Self::as_i(first, second, at) }
    }

    /// `3.5`, `102.MOD.ERR`, `2.0.3` (PL7:647-768).
    fn in_rack(at: &mut Cursor<'_>) -> Result<Self, AddressError> {
        let Some(position) = at.number() else {
            return Err(malformed("the position of the module is missing: `%Ixy.i` (PL7:732)"));
        };
        if !at.eat('.') {
            return Err(malformed("the channel of the module is missing: `%Ixy.i` (PL7:732)"));
        }
        let channel = at.rest;
        if at.number().is_some() && at.at('\\') {
            // `%I3.0\2.1`, as PL7:862 prints it; the form of PL7:840 starts with a backslash.
            let channel = Cursor { rest: channel }.need_number("channel")?;
            return Self::as_i(position, channel, at);
        }
        at.rest = channel;
        let module = rack_position(position)?;
        let channel = read_channel(at)?;
        let rank = read_rank(at, target::RANKS)?;
        Ok(Self { bus: Bus::Rack, module, channel, rank })
    }

    /// `\0.2.1\0.7` (PL7:783-822): processor position, FIPIO channel, connection point, module, channel.
    fn fipio(position: Number<'_>, link: Number<'_>, at: &mut Cursor<'_>) -> Result<Self, AddressError> {
        let position = position.of("processor position", target::FIPIO_POSITIONS)?;
        link.of("FIPIO channel", target::FIPIO_LINK)?;
        let point = at.need_number("connection point")?.of("connection point", target::FIPIO_POINTS)?;
        at.need('\\')?;
        let module = at.need_number("module")?.of("module", target::FIPIO_MODULES)?;
        at.need('.')?;
        let module = format_smolstr!("\\{position}.2.{point}\\{module}");
        let channel = read_channel(at)?;
        let rank = read_rank(at, target::FIPIO_RANKS)?;
        Ok(Self { bus: Bus::Fipio, module, channel, rank })
    }

    /// `3.0\2.1` (PL7:836-863): coupler, its only channel, slave, rank of the bit.
    fn as_i(position: Number<'_>, channel: Number<'_>, at: &mut Cursor<'_>) -> Result<Self, AddressError> {
        let coupler = rack_position(position)?;
        channel.of("channel of an AS-i coupler", target::ASI_CHANNELS)?;
        at.need('\\')?;
        let slave = at.need_number("slave")?.of("AS-i slave", target::ASI_SLAVES)?;
        at.need('.')?;
        let rank = at.need_number("rank")?.of("AS-i rank", target::ASI_RANKS)?;
        let module = format_smolstr!("\\{coupler}.0\\{slave}");
        Ok(Self { bus: Bus::AsI, module, channel: rank, rank: Rank::None })
    }

    /// First bit in [`Area::InputChannels`]: rank 0 is the channel's own bit, left out in writing.
    fn bit(&self) -> u32 {
        match self.rank {
            Rank::Number(rank @ 1..) => RANKED_BITS + self.channel * RANKS + rank,
            _ => self.channel,
        }
    }

    /// First bit in [`Area::ModuleWords`].
    fn word(&self) -> u32 {
        let rank = if let Rank::Number(rank) = self.rank { rank } else { 0 };
        self.channel * CHANNEL_WORDS + rank * 16
    }
}

/// Rack and position as PL7:749-750 code them: the position alone on rack 0, else the rack and a position of two digits.
/// PL7:573, 586 and 1012-1013 print `%I23.5`, `%QW51.1`, so rack and a position of one digit pass too.
fn rack_position(number: Number<'_>) -> Result<SmolStr, AddressError> {
    let rack = |value| Number { text: number.text, value }.within("rack in module address", 0..=7, "PL7:749");
    if number.text.len() > 1 && number.text.starts_with('0') {
        return Err(malformed("the module address of rack 0 has no leading zeros (PL7:750)"));
    }
    match (number.text.len(), number.value) {
        (1..=2, 0..=14) => {}
        (1..=2, value) => {
            rack(value / 10)?;
        }
        (3, value) => {
            rack(value / 100)?;
            let position = Number { text: number.text, value: value % 100 };
            position.within("position in module address", 0..=14, "PL7:750")?;
        }
        _ => {
            rack(u32::MAX)?;
        }
    }
    Ok(number.text.into())
}

fn read_channel(at: &mut Cursor<'_>) -> Result<u32, AddressError> {
    if let Some(number) = at.number() {
        return number.of("channel", target::CHANNELS);
    }
    if at.letters() == "MOD" { Ok(MOD) } else { Err(malformed("the channel is a number or `MOD` (PL7:755)")) }
}

fn read_rank(at: &mut Cursor<'_>, range: Range) -> Result<Rank, AddressError> {
    if !at.eat('.') {
        return Ok(Rank::None);
    }
    if let Some(number) = at.number() {
        return number.of("rank", range).map(Rank::Number);
    }
    if at.letters() == "ERR" { Ok(Rank::Err) } else { Err(malformed("the rank is a number or `ERR` (PL7:756)")) }
}

/// `%I3.5`, `%IW3.5`, `%MW2.0.3`, `%I5.MOD.ERR`, on rack, FIPIO or AS-i.
fn module_object(kind: char, ty: Type, at: &mut Cursor<'_>) -> Result<Place, AddressError> {
    let place = ModulePlace::read(at)?;
    let is_process = matches!(kind, 'I' | 'Q');
    if place.bus == Bus::AsI && !(is_process && ty == Type::Bool) {
        return Err(malformed("AS-i objects are bits of inputs and outputs (PL7:840)"));
    }
    let input_rights = Rights::ReadOnly(if ty == Type::Bool { "PL7:573" } else { "PL7:586" });
    let rights = match kind {
        'I' => input_rights,
        'K' if place.bus == Bus::Fipio => Rights::ReadOnly("PL7:801"),
        'K' => Rights::ReadOnly("PL7:744"),
        _ => Rights::ReadWrite,
    };
    if place.rank == Rank::Err {
        if !(is_process && ty == Type::Bool) {
            return Err(malformed("a fault is a bit: `%Ixy.i.ERR`, `%Ixy.MOD.ERR` (PL7:767-768)"));
        }
        // The manual gives no right for the faults of outputs (PL7:822).
        let rights = if kind == 'I' { rights } else { Rights::Unknown };
        return Ok(Place::new(Class::Fault, ty, Area::Faults(place.module), place.channel, rights));
    }
    if is_process && ty == Type::Bool {
        let (start, channel) = (place.bit(), place.channel);
        let has_table = place.rank == Rank::None && channel < MOD;
        let last = if place.bus == Bus::AsI { target::ASI_RANKS.last } else { target::CHANNELS.last };
        let (class, area) = match kind {
            'I' => (Class::Input, Area::InputChannels(place.module)),
            _ => (Class::Output, Area::OutputChannels(place.module)),
        };
        let object = Place::new(class, ty, area, start, rights);
        return Ok(if has_table { object.with_room(last - channel + 1) } else { object });
    }
    let start = place.word();
    let class = match kind {
        'I' => Class::Input,
        'Q' => Class::Output,
        _ => Class::ModuleWord,
    };
    let prefix = match ty {
        // `%MX2.0.3`, which PL7:743-745 allows, is no part of a word that the manual names.
        Type::Bool => 'X',
        _ => 'W',
    };
    let area = Area::ModuleWords(format_smolstr!("{kind}{prefix}{}", place.module));
    Ok(Place::new(class, ty, area, start, rights))
}

fn with_suggestion(mut error: AddressError, upper: &str) -> AddressError {
    if error.kind == AddressErrorKind::Malformed {
        error.suggestion = nearest(upper);
    }
    error
}

/// The nearest valid address of one that is malformed: the first of the usual slips whose repair gives an address.
fn nearest(upper: &str) -> Option<String> {
    if upper.len() > LONGEST_SUGGESTION_SOURCE || !upper.is_ascii() {
        return None;
    }
    let body = upper.strip_prefix('%').unwrap_or(upper);
    let with_percent = format!("%{body}");
    slips(&with_percent).into_iter().find(|it| it != upper && read(it).is_ok())
}

/// Repairs of the usual slips, the likeliest first.
fn slips(text: &str) -> Vec<String> {
    let mut out = vec![text.to_owned()];
    let body = text.strip_prefix('%').unwrap_or(text);
    let letters: &str = &body[..body.bytes().position(|it| !it.is_ascii_uppercase()).unwrap_or(body.len())];
    let tail = &body[letters.len()..];

    out.push(text.replace(',', "."));
    out.push(text.trim_end_matches(['.', ':', ',', ';']).to_owned());
    // `%MW10.X4`, as PL7:5381 prints it.
    out.push(text.replacen(".X", ":X", 1));
    // A bit of a bit, or a bit of a double word or byte.
    if let Some((number, rank)) =
        tail.split_once([':', '.']).and_then(|(number, rank)| Some((number, rank.strip_prefix('X')?)))
    {
        out.extend(extraction(letters, number, rank));
    }
    // The manual prints `%TM0.D` too (PL7:1242).
    let (from, to): (&str, &[&str]) = match letters {
        "TM" | "MN" => (".D", &[".Q", ".R"]),
        "T" | "C" => (".Q", &[".D"]),
        _ => ("", &[]),
    };
    if let Some(head) = text.strip_suffix(from).filter(|_| !from.is_empty()) {
        out.extend(to.iter().map(|it| format!("{head}{it}")));
    }
    // `%MN1.Q`; `%X3.T3`, as PL7:1176 prints it; `%X3T`.
    if let Some(head) = text.strip_suffix(".Q") {
        out.push(format!("{head}.R"));
    }
    if letters == "X" {
        if let Some((head, rest)) = text.split_once('T').filter(|(head, _)| !head.ends_with(['U', '.'])) {
            out.push(format!("{head}.T{rest}"));
        }
        if let Some((head, _)) = text.rsplit_once(".T") {
            out.push(format!("{head}.T"));
        }
    }
    // Format letters that bits do not have, and those of the other vendor.
    let other = match letters {
        "MX" => "M",
        "SX" => "S",
        "E" | "EX" => "I",
        "A" | "AX" | "O" => "Q",
        "EW" => "IW",
        "AW" | "OW" => "QW",
        "ED" => "ID",
        "AD" | "OD" => "QD",
        "Z" => "C",
        _ => letters,
    };
    out.push(format!("%{other}{tail}"));
    // `%I03.5`: no leading zeros on rack 0.
    if tail.starts_with('0') {
        let trimmed = tail.trim_start_matches('0');
        let zero = if trimmed.starts_with(|it: char| it.is_ascii_digit()) { "" } else { "0" };
        out.push(format!("%{letters}{zero}{trimmed}"));
    }
    // `%I.5` of PL7:686 is channel 5 of the module at position 1; `%I3` has no channel.
    if matches!(letters, "I" | "Q" | "IW" | "QW" | "ID" | "QD" | "CH") {
        if tail.starts_with('.') {
            out.push(format!("%{letters}1{tail}"));
        }
        out.push(format!("{text}.0"));
    }
    // A block item glued to its number, `%TM8Q`.
    if let Some(at) = tail.bytes().position(|it| it.is_ascii_uppercase()) {
        out.push(format!("%{letters}{}.{}", &tail[..at], &tail[at..]));
    }
    out
}

/// `%M1:X3` and `%MW10.X4` name a bit of a word; bit 20 of `%MD0` is bit 4 of `%MW1`, bit 3 of `%MB5` bit 11 of `%MW2`.
fn extraction(letters: &str, number: &str, rank: &str) -> Option<String> {
    let (number, rank): (u32, u32) = (number.parse().ok()?, rank.parse().ok()?);
    let kind = letters.chars().next()?;
    let (word, rank) = match letters.get(1..)? {
        "" | "W" => (number, rank),
        "D" | "F" => (number.checked_add(rank / 16)?, rank % 16),
        "B" if rank < 8 => (number / 2, rank + number % 2 * 8),
        _ => return None,
    };
    Some(format!("%{kind}W{word}:X{rank}"))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    type IndexedCase = (&'static str, Option<&'static str>, Class, Type, u32, Rights);

    fn object(address: &str) -> Object {
        parse(address).unwrap_or_else(|error| panic!("{address}: {error:?}"))
    }

    fn error(address: &str) -> AddressError {
        match parse(address) {
            Ok(object) => panic!("{address} is {object:?}"),
            Err(error) => error,
        }
    }

    fn read_only(source: &'static str) -> Rights {
        Rights::ReadOnly(source)
    }

    #[test]
    fn memory_constants_and_system() {
        use Rights::{ReadWrite, Unknown};
        let cases: &[(&str, Class, Type, Area, u32, Rights)] = &[
            ("%M25", Class::Memory, Type::Bool, Area::Bits, 25, ReadWrite),
            ("%m200", Class::Memory, Type::Bool, Area::Bits, 200, ReadWrite),
            ("%M10:6", Class::Memory, Type::BitTable(6), Area::Bits, 10, ReadWrite),
            ("%M50:20", Class::Memory, Type::BitTable(20), Area::Bits, 50, ReadWrite),
            ("%S20", Class::System, Type::Bool, Area::SystemBits, 20, ReadWrite),
            ("%S10", Class::System, Type::Bool, Area::SystemBits, 10, Unknown),
            ("%S127", Class::System, Type::Bool, Area::SystemBits, 127, Unknown),
            ("%SW30", Class::System, Type::Word, Area::SystemWords, 480, Unknown),
            ("%SW50:4", Class::System, Type::WordTable(4), Area::SystemWords, 800, ReadWrite),
            ("%SW10:X0", Class::System, Type::Bool, Area::SystemWords, 160, Unknown),
            ("%SD18", Class::System, Type::Double, Area::SystemWords, 288, Unknown),
            ("%MW15", Class::Memory, Type::Word, Area::Words, 240, ReadWrite),
            ("%MW50:20", Class::Memory, Type::WordTable(20), Area::Words, 800, ReadWrite),
            ("%MD45", Class::Memory, Type::Double, Area::Words, 720, ReadWrite),
            ("%MD30:10", Class::Memory, Type::DoubleTable(10), Area::Words, 480, ReadWrite),
            ("%MF20", Class::Memory, Type::Float, Area::Words, 320, ReadWrite),
            ("%MF100:20", Class::Memory, Type::FloatTable(20), Area::Words, 1600, ReadWrite),
            ("%MB1", Class::Memory, Type::Byte, Area::Words, 8, ReadWrite),
            ("%MB10:5", Class::Memory, Type::Text(5), Area::Words, 80, ReadWrite),
            ("%MW10:X4", Class::Memory, Type::Bool, Area::Words, 164, ReadWrite),
            ("%mw10:x5", Class::Memory, Type::Bool, Area::Words, 165, ReadWrite),
            ("%KW30", Class::Constant, Type::Word, Area::Constants, 480, read_only("PL7:588")),
            ("%KW10:5", Class::Constant, Type::WordTable(5), Area::Constants, 160, read_only("PL7:1036")),
            ("%KD26", Class::Constant, Type::Double, Area::Constants, 416, read_only("PL7:588")),
            ("%KD30:10", Class::Constant, Type::DoubleTable(10), Area::Constants, 480, read_only("PL7:1037")),
            ("%KF100:20", Class::Constant, Type::FloatTable(20), Area::Constants, 1600, read_only("PL7:1038")),
            ("%KB20:6", Class::Constant, Type::Text(6), Area::Constants, 160, read_only("PL7:588")),
            ("%KW3:X15", Class::Constant, Type::Bool, Area::Constants, 63, read_only("PL7:588")),
            ("%NW{2.3}1", Class::NetworkWord, Type::Word, Area::Network(2, 3), 16, ReadWrite),
            ("%NW{127.31}3:X15", Class::NetworkWord, Type::Bool, Area::Network(127, 31), 63, ReadWrite),
            ("%NW2.3", Class::NetworkWord, Type::Word, Area::Network(0, 2), 48, ReadWrite),
        ];
        check(cases);
    }

    #[test]
    fn steps_and_their_times() {
        use Rights::ReadWrite;
        let cases: &[(&str, Class, Type, Area, u32, Rights)] = &[
            ("%X21", Class::Step, Type::Bool, Area::Steps, 21, ReadWrite),
            ("%X0", Class::Step, Type::Bool, Area::Steps, 0, ReadWrite),
            ("%X5.9", Class::Step, Type::Bool, Area::Steps, 6 * 1024 + 9, ReadWrite),
            ("%X5.IN", Class::Step, Type::Bool, Area::Steps, 6 * 1024 + 1000, ReadWrite),
            ("%x5.out", Class::Step, Type::Bool, Area::Steps, 6 * 1024 + 1001, ReadWrite),
            ("%XM3", Class::MacroStep, Type::Bool, Area::MacroSteps, 3, ReadWrite),
            ("%X50:30", Class::Step, Type::BitTable(30), Area::Steps, 50, ReadWrite),
            ("%X2.3:4", Class::Step, Type::BitTable(4), Area::Steps, 3 * 1024 + 3, ReadWrite),
            ("%X5.T", Class::StepTime, Type::Word, Area::StepTimes, 80, ReadWrite),
            ("%X0.IN.T", Class::StepTime, Type::Word, Area::StepTimes, 16 * 2024, ReadWrite),
            ("%X0.OUT.T", Class::StepTime, Type::Word, Area::StepTimes, 16 * 2025, ReadWrite),
            ("%X2.3.T", Class::StepTime, Type::Word, Area::StepTimes, 16 * (3 * 1024 + 3), ReadWrite),
            ("%X12.T:8", Class::StepTime, Type::WordTable(8), Area::StepTimes, 192, read_only("PL7:1039")),
            ("%X2.3.T:8", Class::StepTime, Type::WordTable(8), Area::StepTimes, 49200, read_only("PL7:1039")),
            ("%X5.T:X3", Class::StepTime, Type::Bool, Area::StepTimes, 83, ReadWrite),
        ];
        check(cases);
    }

    #[test]
    fn modules() {
        use Rights::{ReadWrite, Unknown};
        let inputs = |module: &str| Area::InputChannels(module.into());
        let outputs = |module: &str| Area::OutputChannels(module.into());
        let words = |module: &str| Area::ModuleWords(module.into());
        let faults = |module: &str| Area::Faults(module.into());
        let cases: &[(&str, Class, Type, Area, u32, Rights)] = &[
            ("%I3.6", Class::Input, Type::Bool, inputs("3"), 6, read_only("PL7:573")),
            ("%IX3.6", Class::Input, Type::Bool, inputs("3"), 6, read_only("PL7:573")),
            ("%I3.6.0", Class::Input, Type::Bool, inputs("3"), 6, read_only("PL7:573")),
            ("%I3.0.1", Class::Input, Type::Bool, inputs("3"), 1025, read_only("PL7:573")),
            ("%I23.5", Class::Input, Type::Bool, inputs("23"), 5, read_only("PL7:573")),
            ("%Q51.2", Class::Output, Type::Bool, outputs("51"), 2, ReadWrite),
            ("%Q4.2", Class::Output, Type::Bool, outputs("4"), 2, ReadWrite),
            ("%I714.127", Class::Input, Type::Bool, inputs("714"), 127, read_only("PL7:573")),
            ("%I25.1:8", Class::Input, Type::BitTable(8), inputs("25"), 1, read_only("PL7:1012")),
            ("%Q34.0:16", Class::Output, Type::BitTable(16), outputs("34"), 0, ReadWrite),
            ("%IW23.5", Class::Input, Type::Word, words("IW23"), 5 * 8192, read_only("PL7:586")),
            ("%QW51.1", Class::Output, Type::Word, words("QW51"), 8192, ReadWrite),
            ("%QW5.1:X10", Class::Output, Type::Bool, words("QW5"), 8202, ReadWrite),
            ("%IW102.3:X1", Class::Input, Type::Bool, words("IW102"), 3 * 8192 + 1, read_only("PL7:586")),
            ("%ID3.0", Class::Input, Type::Double, words("IW3"), 0, read_only("PL7:586")),
            ("%ID3.0.4", Class::Input, Type::Double, words("IW3"), 64, read_only("PL7:586")),
            ("%MW2.0.3", Class::ModuleWord, Type::Word, words("MW2"), 48, ReadWrite),
            ("%MW103.0.3", Class::ModuleWord, Type::Word, words("MW103"), 48, ReadWrite),
            ("%MW103.MOD.2:X6", Class::ModuleWord, Type::Bool, words("MW103"), 1000 * 8192 + 38, ReadWrite),
            ("%KW2.0.3", Class::ModuleWord, Type::Word, words("KW2"), 48, read_only("PL7:744")),
            ("%CH3.0", Class::ModuleWord, Type::Block, words("CH3"), 0, Unknown),
            ("%I5.MOD.ERR", Class::Fault, Type::Bool, faults("5"), 1000, read_only("PL7:573")),
            ("%I102.MOD.ERR", Class::Fault, Type::Bool, faults("102"), 1000, read_only("PL7:573")),
            ("%I204.3.ERR", Class::Fault, Type::Bool, faults("204"), 3, read_only("PL7:573")),
            (r"%MW\0.2.1\0.5.2", Class::ModuleWord, Type::Word, words(r"MW\0.2.1\0"), 5 * 8192 + 32, ReadWrite),
            (r"%KW\0.2.1\0.5.255", Class::ModuleWord, Type::Word, words(r"KW\0.2.1\0"), 45040, read_only("PL7:801")),
            (r"%I\0.2.1\0.7", Class::Input, Type::Bool, inputs(r"\0.2.1\0"), 7, read_only("PL7:573")),
            (r"%Q\0.2.1\1.2", Class::Output, Type::Bool, outputs(r"\0.2.1\1"), 2, ReadWrite),
            (r"%I\0.2.2\0.MOD.ERR", Class::Fault, Type::Bool, faults(r"\0.2.2\0"), 1000, read_only("PL7:573")),
            (r"%Q\1.2.3\0.0.ERR", Class::Fault, Type::Bool, faults(r"\1.2.3\0"), 0, Unknown),
            (r"%I3.0\2.1", Class::Input, Type::Bool, inputs(r"\3.0\2"), 1, read_only("PL7:573")),
            (r"%Q3.0\4.3", Class::Output, Type::Bool, outputs(r"\3.0\4"), 3, ReadWrite),
            (r"%I\103.0\31.0", Class::Input, Type::Bool, inputs(r"\103.0\31"), 0, read_only("PL7:573")),
        ];
        check(cases);
    }

    #[test]
    fn function_blocks() {
        use Class::{Block, BlockBit, BlockWord};
        use Rights::{ReadWrite, Unknown};
        let cases: &[(&str, Class, Type, Area, u32, Rights)] = &[
            ("%TM8.Q", BlockBit, Type::Bool, Area::Block("TM", 8), 48, read_only("PL7:978")),
            ("%TM2.P", BlockWord, Type::Word, Area::Block("TM", 2), 16, ReadWrite),
            ("%TM2.V", BlockWord, Type::Word, Area::Block("TM", 2), 0, read_only("PL7:976")),
            ("%C4.V", BlockWord, Type::Word, Area::Block("C", 4), 0, read_only("PL7:979")),
            ("%C4.P", BlockWord, Type::Word, Area::Block("C", 4), 16, ReadWrite),
            ("%C4.E", BlockBit, Type::Bool, Area::Block("C", 4), 48, read_only("PL7:981")),
            ("%C8.D", BlockBit, Type::Bool, Area::Block("C", 8), 49, read_only("PL7:982")),
            ("%C8.F", BlockBit, Type::Bool, Area::Block("C", 8), 50, read_only("PL7:576")),
            ("%MN0.V", BlockWord, Type::Word, Area::Block("MN", 0), 0, read_only("PL7:983")),
            ("%MN0.P", BlockWord, Type::Word, Area::Block("MN", 0), 16, ReadWrite),
            ("%MN0.R", BlockBit, Type::Bool, Area::Block("MN", 0), 48, read_only("PL7:985")),
            ("%R3.I", BlockWord, Type::Word, Area::Block("R", 3), 0, ReadWrite),
            ("%R3.O", BlockWord, Type::Word, Area::Block("R", 3), 16, ReadWrite),
            ("%R3.F", BlockBit, Type::Bool, Area::Block("R", 3), 48, read_only("PL7:988")),
            ("%R3.E", BlockBit, Type::Bool, Area::Block("R", 3), 49, read_only("PL7:989")),
            ("%DR1.S", BlockWord, Type::Word, Area::Block("DR", 1), 0, ReadWrite),
            ("%DR1.W15", BlockWord, Type::Word, Area::Block("DR", 1), 304, read_only("PL7:991")),
            ("%DR1.V", BlockWord, Type::Word, Area::Block("DR", 1), 16, read_only("PL7:992")),
            ("%DR1.F", BlockBit, Type::Bool, Area::Block("DR", 1), 48, read_only("PL7:993")),
            ("%T3.D", BlockBit, Type::Bool, Area::Block("T", 3), 49, read_only("PL7:997")),
            ("%T3.R", BlockBit, Type::Bool, Area::Block("T", 3), 48, read_only("PL7:996")),
            ("%T3.V:X2", BlockWord, Type::Bool, Area::Block("T", 3), 2, read_only("PL7:994")),
            ("%TM8", Block, Type::Block, Area::Block("TM", 8), 0, Unknown),
            ("%tm254", Block, Type::Block, Area::Block("TM", 254), 0, Unknown),
        ];
        check(cases);
        assert!(object("%DR1").footprint.contains(&object("%DR1.W15").footprint));
    }

    fn check(cases: &[(&str, Class, Type, Area, u32, Rights)]) {
        for (address, class, ty, area, start, rights) in cases {
            let object = object(address);
            let found = (object.class, object.ty, &object.footprint.area, object.footprint.start, object.rights);
            assert_eq!(found, (*class, *ty, area, *start, *rights), "{address}");
            assert_eq!(object.text, *address);
            assert_eq!(object.extracted, address.to_ascii_uppercase().contains(":X"), "{address}");
            assert!(!object.indexed && object.is_fixed());
            if let Some(bits) = ty.bits() {
                assert_eq!(object.footprint.bits, bits, "{address}");
            }
        }
    }

    #[test]
    fn overlaps_of_the_manual() {
        let pairs = [
            ("%MD0", "%MW0"),
            ("%MD0", "%MW1"),
            ("%MW3", "%MB7"),
            ("%MW3", "%MB6"),
            ("%KD543", "%KW543"),
            ("%KD543", "%KW544"),
            ("%MF10", "%MW11"),
            ("%MW10", "%MW10:X4"),
            ("%MW0:12", "%MW11"),
            ("%M4:8", "%M7"),
            (r"%I3.0\2.1", r"%I\3.0\2.1"),
        ];
        for (left, right) in pairs {
            assert!(object(left).footprint.overlaps(&object(right).footprint), "{left} {right}");
        }
        let apart = [
            ("%MD0", "%MW2"),
            ("%MW3", "%MB8"),
            ("%MW3", "%MB5"),
            ("%KD543", "%MW543"),
            ("%M4:8", "%M12"),
            ("%MW0:12", "%MW12"),
            ("%I3.1", "%I3.0.1"),
            ("%I3.1", "%Q3.1"),
            ("%I103.1", "%I3.1"),
            ("%X5.9", "%X9"),
            ("%X5.9", "%X59"),
            ("%TM8.Q", "%TM8.V"),
            ("%T8.V", "%TM8.V"),
            ("%ID3.0.127", "%IW3.1"),
        ];
        for (left, right) in apart {
            assert!(!object(left).footprint.overlaps(&object(right).footprint), "{left} {right}");
        }
    }

    #[test]
    fn malformed_with_the_nearest_form() {
        let cases = [
            ("X3.T", Some("%X3.T")),
            ("MW10", Some("%MW10")),
            ("mw108", Some("%MW108")),
            ("%TM1.D", Some("%TM1.Q")),
            ("%T1.Q", Some("%T1.D")),
            ("%MN1.Q", Some("%MN1.R")),
            ("%C1.Q", Some("%C1.D")),
            ("%TM8Q", Some("%TM8.Q")),
            ("%M1.X3", Some("%MW1:X3")),
            ("%M1:X3", Some("%MW1:X3")),
            ("%MW10.X4", Some("%MW10:X4")),
            ("%MD0:X3", Some("%MW0:X3")),
            ("%MD0:X20", Some("%MW1:X4")),
            ("%MB5:X3", Some("%MW2:X11")),
            ("%MX10", Some("%M10")),
            ("%X3.T3", Some("%X3.T")),
            ("%X3T", Some("%X3.T")),
            ("%I1,0", Some("%I1.0")),
            ("%E1.0", Some("%I1.0")),
            ("%A4.0", Some("%Q4.0")),
            ("%I.5", Some("%I1.5")),
            ("%I3", Some("%I3.0")),
            ("%I03.5", Some("%I3.5")),
            ("%I002.5", Some("%I2.5")),
            ("%MW10.", Some("%MW10")),
            ("%MW", None),
            ("%", None),
            ("", None),
            ("%L10", None),
            ("%SR3", None),
            ("%XY3", None),
            ("%MWW3", None),
            ("%MW10:", Some("%MW10")),
            ("%MW10:X", None),
            ("%MW10:5:2", None),
            ("%MW2:X4:3", None),
            ("%TM8:4", None),
            ("%XM3:4", None),
            ("%S3:4", None),
            ("%X5.IN:3", None),
            ("%X5.9.9", None),
            ("%X5.ON", None),
            ("%IW3.0:4", None),
            ("%KW1.2.ERR", None),
            (r"%IW\3.0\2.1", None),
            (r"%I\0.2.1.7", None),
            (r"%MW3.0\2.1", None),
            ("%SB3", None),
            ("%K3", None),
            ("%NW{2}1", None),
            ("%NW{2.3", None),
            ("%CH3.0.1", None),
            ("%DR1.W", None),
            ("%DR1.Q", None),
            ("%MW10é", None),
            ("%I3.٣", None),
        ];
        for (address, suggestion) in cases {
            let error = error(address);
            assert_eq!(error.kind, AddressErrorKind::Malformed, "{address}: {error:?}");
            assert_eq!(error.suggestion.as_deref(), suggestion, "{address}");
            assert!(!error.message.is_empty() && !error.message.ends_with('.'), "{address}");
        }
    }

    #[test]
    fn out_of_range_with_the_source() {
        let cases = [
            ("%I800.0", "PL7:749"),
            ("%I80.0", "PL7:749"),
            ("%I1000.0", "PL7:749"),
            ("%I115.0", "PL7:750"),
            ("%I3.128", "PL7:755"),
            ("%I3.0.128", "PL7:756"),
            ("%MW3.0.128", "PL7:756"),
            (r"%I\2.2.1\0.7", "PL7:806"),
            (r"%I\0.1.1\0.7", "PL7:807"),
            (r"%I\0.2.0\0.7", "PL7:808"),
            (r"%I\0.2.128\0.7", "PL7:808"),
            (r"%I\0.2.1\2.7", "PL7:809"),
            (r"%I\0.2.1\0.128", "PL7:755"),
            (r"%I\0.2.1\0.7.256", "PL7:811"),
            (r"%I3.1\2.1", "PL7:852"),
            (r"%I3.0\32.1", "PL7:853"),
            (r"%I3.0\2.4", "PL7:854"),
            ("%NW{128.3}1", "PL7:912"),
            ("%NW{2.32}1", "PL7:912"),
            ("%NW{2.3}4", "PL7:912"),
            ("%MW10:X16", "PL7:631"),
            ("%S128", "PL7:575"),
            ("%XM64", "PL7:4215"),
            ("%X64.1", "PL7:4215"),
            ("%X3.250", "PL7:4281"),
            ("%X1024", "PL7:1592"),
            ("%TM255", "PL7:976"),
            ("%DR1.W16", "PL72:445"),
            ("%M65536", "PL7:1584"),
            ("%MW99999999999999999999", "PL7:1584"),
            ("%MW0:0", "PL7:1017"),
            ("%MW65535:2", "PL7:1017"),
            ("%MD65534:2", "PL7:1017"),
            ("%I3.120:9", "PL7:1017"),
            ("%X1020:5", "PL7:1017"),
        ];
        for (address, source) in cases {
            let error = error(address);
            assert_eq!(error.kind, AddressErrorKind::OutOfRange, "{address}: {error:?}");
            assert!(error.message.contains(source), "{address}: {}", error.message);
            assert_eq!(error.suggestion, None);
        }
        for address in ["%I714.127.127", "%MW10:X15", "%I3.120:8", "%X1020:4", "%MW65534:2", "%X63.249", r"%I3.0\31.3"]
        {
            object(address);
        }
    }

    #[test]
    fn indexed() {
        let cases: &[IndexedCase] = &[
            ("%I21.3", None, Class::Input, Type::Bool, 3, read_only("PL7:1103")),
            ("%Q32.4", None, Class::Output, Type::Bool, 4, Rights::ReadWrite),
            ("%M10", None, Class::Memory, Type::Bool, 10, Rights::ReadWrite),
            ("%X20", None, Class::Step, Type::Bool, 20, Rights::ReadWrite),
            ("%X2.3", None, Class::Step, Type::Bool, 3075, Rights::ReadWrite),
            ("%XM2", None, Class::MacroStep, Type::Bool, 2, Rights::ReadWrite),
            ("%MW30", None, Class::Memory, Type::Word, 480, Rights::ReadWrite),
            ("%MD15", None, Class::Memory, Type::Double, 240, Rights::ReadWrite),
            ("%MF15", None, Class::Memory, Type::Float, 240, Rights::ReadWrite),
            ("%KW50", None, Class::Constant, Type::Word, 800, read_only("PL7:1111")),
            ("%KD50", None, Class::Constant, Type::Double, 800, read_only("PL7:1112")),
            ("%KF50", None, Class::Constant, Type::Float, 800, read_only("PL7:1113")),
            ("%X20", Some(".T"), Class::StepTime, Type::Word, 320, read_only("PL7:1114")),
            ("%X20.T", None, Class::StepTime, Type::Word, 320, read_only("PL7:1114")),
            ("%X2.3", Some(".t"), Class::StepTime, Type::Word, 49200, read_only("PL7:1114")),
            ("%MW50", Some(":10"), Class::Memory, Type::WordTable(10), 800, Rights::ReadWrite),
            ("%MD40", Some(":10"), Class::Memory, Type::DoubleTable(10), 640, Rights::ReadWrite),
            ("%KW70", Some(":20"), Class::Constant, Type::WordTable(20), 1120, read_only("PL7:1118")),
            ("%KD80", Some(":10"), Class::Constant, Type::DoubleTable(10), 1280, read_only("PL7:1119")),
            ("%MW10", Some(":X4"), Class::Memory, Type::Bool, 164, Rights::ReadWrite),
        ];
        for (base, suffix, class, ty, start, rights) in cases {
            let object = parse_indexed(base, *suffix).unwrap_or_else(|error| panic!("{base}: {error:?}"));
            assert_eq!((object.class, object.ty, object.footprint.start), (*class, *ty, *start), "{base}");
            assert_eq!(object.rights, *rights, "{base}");
            assert!(object.indexed && !object.is_fixed());
            assert_eq!(object.text, format!("{base}[..]{}", suffix.unwrap_or_default()));
        }
        let malformed = [
            ("%S5", None),
            ("%SW5", None),
            ("%TM8", None),
            ("%TM8", Some(".Q")),
            ("%I5.MOD.ERR", None),
            ("%MB4", None),
            ("%M4", Some(":8")),
            ("%MW10:X4", None),
            ("%MW10:4", None),
            ("%X2", Some(".3")),
            ("%MD4", Some(":X2")),
            ("%MW", Some("4")),
            ("%MW1", Some("4")),
            ("MW10", None),
        ];
        for (base, suffix) in malformed {
            let error = parse_indexed(base, suffix).expect_err(base);
            assert_eq!((error.kind, error.suggestion), (AddressErrorKind::Malformed, None), "{base}{suffix:?}");
        }
        assert_eq!(parse_indexed("%MW10", Some(":X16")).map_err(|it| it.kind), Err(AddressErrorKind::OutOfRange));
    }

    #[test]
    fn bare_names() {
        let cases = [
            ("MW108", Some("%MW108")),
            ("X3.T", Some("%X3.T")),
            ("TM1.D", Some("%TM1.Q")),
            ("mw10.x4", Some("%MW10:X4")),
            ("Pompe", None),
            ("Mw", None),
            ("Vanne_1", None),
            ("%MW10", None),
            ("", None),
            ("é", None),
        ];
        for (name, address) in cases {
            assert_eq!(suggest(name).as_deref(), address, "{name}");
        }
    }

    proptest! {
        #[test]
        fn any_text_is_an_object_or_an_error(text in r"\PC{0,20}") {
            holds(&text)?;
        }

        #[test]
        fn any_likely_address_is_an_object_or_an_error(
            text in r"%?[MKSXIQCTDRNWFBH]{0,3}[0-9.:X\\{}TMODERINPVQ]{0,16}",
            suffix in proptest::option::of(r"[.:]?[XT]?[0-9]{0,4}"),
        ) {
            holds(&text)?;
            if let Ok(object) = parse_indexed(&text, suffix.as_deref()) {
                prop_assert!(object.indexed && object.footprint.bits > 0);
            }
        }

        #[test]
        fn case_does_not_matter(text in r"%[MKSXIQTRNW]{1,2}[0-9]{1,4}[.:][X0-9]{1,4}") {
            let lower = text.to_lowercase();
            prop_assert_eq!(
                parse(&text).map(|it| it.footprint).map_err(|it| it.kind),
                parse(&lower).map(|it| it.footprint).map_err(|it| it.kind)
            );
        }
    }

    fn holds(text: &str) -> Result<(), TestCaseError> {
        match parse(text) {
            Ok(object) => {
                prop_assert!(object.footprint.bits > 0);
                prop_assert!(object.footprint.end() > object.footprint.start);
                prop_assert_eq!(suggest(text), None);
            }
            Err(error) => {
                prop_assert!(!error.message.is_empty());
                if let Some(suggestion) = error.suggestion {
                    prop_assert!(parse(&suggestion).is_ok(), "{} -> {}", text, suggestion);
                }
            }
        }
        if let Some(address) = suggest(text) {
            prop_assert!(parse(&address).is_ok());
        }
        Ok(())
    }
}
