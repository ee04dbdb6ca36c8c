//! Addresses of PL7-2 objects, as PL72:84-310 and the pages of the blocks define them.
//!
//! Numbers that only some controller lacks are not judged here, nor whether a word is reached directly (PL72:289): that is
//! the business of [`crate::target`].

use smol_str::{SmolStr, format_smolstr};

use super::address::{Cursor, LONGEST_SUGGESTION_SOURCE, Number, Place, malformed, out_of_range, upper_case};
use super::{AddressError, AddressErrorKind, Area, Class, Object, Rights, Type};
use crate::target::Range;
use crate::target::pl72::{self as target, Writer};

/// PL72:263.
const LAST_BIT: u32 = 255;
/// PL72:264.
const LAST_SYSTEM_BIT: u32 = 23;
/// PL72:276-277.
const LAST_WORD: u32 = 1023;
/// PL72:278.
const LAST_SYSTEM_WORD: u32 = 63;
/// Stations of common words, and words of a station (PL72:279-280).
const LAST_STATION: u32 = 15;
const LAST_COMMON_WORD: u32 = 3;
/// The bits of an extracted word are numbered in hexadecimal (PL72:372, PL72:376).
const LAST_RANK: u32 = 15;
/// The rack that is not written (PL72:214, PL72:1073-1076 beside PL72:194-198).
const RACK_0: u32 = 0;
/// What an address names, and the word that is added to its number.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Address {
    pub object: Object,
    /// `W10` of `W5(W10)`.
    pub index: Option<Object>,
}

/// Reads an address without blanks, in either case: `I0,05`, `W5,A`, `T0,P`, `B5[10]`, `W0[60]`, `W5(W10)`. The percent
/// sign of PL7 may stand before it, except where PL7 means something else by the rest: `%M5` is a bit there.
///
/// # Errors
/// [`AddressErrorKind::Malformed`] with the nearest valid form where there is one; [`AddressErrorKind::OutOfRange`] for
/// a number that no controller has.
pub fn parse(address: &str) -> Result<Address, AddressError> {
    let upper = upper_case(address);
    match read(&upper) {
        Ok((place, index)) => {
            let index = index.map(|(text, place)| place.object(text.into(), BLOCK_BITS));
            let indexed = index.is_some();
            Ok(Address { object: Object { indexed, ..place.object(address.into(), BLOCK_BITS) }, index })
        }
        Err(mut error) => {
            if error.suggestion.is_none() && error.kind == AddressErrorKind::Malformed {
                error.suggestion = nearest(&upper);
            }
            Err(error)
        }
    }
}

/// What an address names; `None` when the text is none. What would be one instead is not looked for.
pub fn class_of(text: &str) -> Option<Class> {
    read(&upper_case(text)).ok().map(|(place, _)| place.class)
}

/// Whether an object is the preset of a function block: `T0,P`.
pub fn is_preset(object: &Object) -> bool {
    let block = match object.footprint.area {
        Area::Block(symbol, _) => BLOCKS.iter().find(|it| it.symbol == symbol),
        _ => None,
    };
    let is_own = |it: &Item| it.start == object.footprint.start && it.class == object.class && it.name == "P";
    block.is_some_and(|it| it.items.iter().any(is_own))
}

/// Whether an object is the number of the step that a drum is in: `D1,S`.
pub fn is_drum_step(object: &Object) -> bool {
    matches!(object.footprint.area, Area::Block("D", _))
        && object.class == Class::BlockWord
        && object.footprint.start == 0
}

/// Values that a word of a function block takes, presets left aside: the step of a drum, the length, partner and station of a text
/// block.
pub fn word_range(object: &Object) -> Option<Range> {
    let Area::Block(symbol, _) = object.footprint.area else { return None };
    if is_drum_step(object) {
        return Some(target::DRUM_STEP);
    }
    let items = BLOCKS.iter().find(|it| it.symbol == symbol)?.items;
    let item = items.iter().find(|it| it.start == object.footprint.start && it.class == object.class)?;
    match (symbol, item.name) {
        ("TXT", "L") => Some(target::TEXT_BYTES),
        ("TXT", "T") => Some(target::TEXT_PARTNERS),
        ("TXT", "A") => Some(target::TEXT_STATIONS),
        _ => None,
    }
}

/// Where a bit or word of a module is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Channel {
    pub is_output: bool,
    /// Whether the rack is written: `I01,3`, which only a TSX 47 has.
    pub has_rack: bool,
    pub rack: u32,
    pub module: u32,
    pub item: ChannelItem,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ChannelItem {
    /// A bit by its number of two decimal digits, as a TSX 17-20 has it: `I0,05`.
    Decimal(u32),
    /// A bit by one hexadecimal digit, as a TSX 27 or 47 has it: `I1,A`.
    Hexadecimal(u32),
    /// `O2,S`.
    Fault,
    /// A register word: `IW1,3`, or a bit of it.
    Word(u32),
}

/// The channel that an address of inputs or outputs, as [`parse`] reads it, starts with, string or extracted bit left aside;
/// `None` for others.
pub fn channel(address: &str) -> Option<Channel> {
    let upper = upper_case(address);
    let mut at = Cursor { rest: &upper };
    let (is_output, is_word) = match at.letters() {
        "I" => (false, false),
        "O" => (true, false),
        "IW" => (false, true),
        "OW" => (true, true),
        _ => return None,
    };
    if is_word { read_word_channel(&mut at, is_output) } else { read_channel(&mut at, is_output) }.ok()
}

impl Place {
    /// `W5,A`, where the table of extracted bits has the word (PL72:299-310).
    fn extracted_bit(self, at: &mut Cursor<'_>, rights: Rights) -> Result<Self, AddressError> {
        let rank = at.hexadecimal("the bit of a word is one digit from 0 to F (PL72:372, PL72:376)")?;
        Ok(Self {
            ty: Type::Bool,
            start: self.start + rank.min(LAST_RANK),
            extracted: true,
            rights,
            room: None,
            ..self
        })
    }

    /// `[n]`.
    fn string(self, length: Number<'_>) -> Result<Self, AddressError> {
        let Some(room) = self.room else {
            return Err(malformed("strings are of bits B, I and O, tables of words W and CW (PL72:988, PL72:1001)"));
        };
        let ty = if self.ty == Type::Bool {
            let longest = target::BIT_STRING;
            let length = length.within("length of a bit string", longest.first..=longest.last, longest.source)?;
            if length > room {
                return Err(out_of_range(format!(
                    "a string of {length} bits does not fit: from here there are {room}"
                )));
            }
            Type::BitTable(length)
        } else {
            Type::WordTable(length.within("length of a table", 1..=room, "PL72:1092-1103")?)
        };
        Ok(Self { ty, room: None, ..self })
    }
}

/// What a function block lets a program reach.
struct BlockSymbol {
    symbol: &'static str,
    /// Largest number; `None` for the one block without a number.
    last: Option<u32>,
    source: &'static str,
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

/// PL72:265: no program writes the bits of blocks.
const fn bit(name: &'static str, start: u32) -> Item {
    Item { name, class: Class::BlockBit, start: BLOCK_BIT_ITEMS + start, rights: Rights::ReadOnly("PL72:265") }
}

/// Words from bit 0, bits after the seven words of a text block, the step words `Di,Wj` last.
const BLOCK_BIT_ITEMS: u32 = 7 * 16;
const DRUM_WORDS: u32 = BLOCK_BIT_ITEMS + 16;
const BLOCK_BITS: u32 = DRUM_WORDS + 16 * DRUM_STEPS;
/// PL72:877.
const DRUM_STEPS: u32 = 16;

const fn read_only(source: &'static str) -> Rights {
    Rights::ReadOnly(source)
}

const BLOCKS: &[BlockSymbol] = &[
    BlockSymbol {
        symbol: "T",
        last: Some(31),
        source: "PL72:653",
        items: &[word("P", 0, Rights::ReadWrite), word("V", 16, read_only("PL72:669")), bit("D", 0), bit("R", 1)],
    },
    BlockSymbol {
        symbol: "C",
        last: Some(30),
        source: "PL72:732",
        items: &[
            word("P", 0, Rights::ReadWrite),
            word("V", 16, read_only("PL72:749")),
            bit("E", 0),
            bit("D", 1),
            bit("F", 2),
        ],
    },
    BlockSymbol {
        symbol: "FC",
        last: None,
        source: "PL72:446",
        items: &[
            word("P", 0, Rights::ReadWrite),
            word("V", 16, read_only("PL72:800")),
            bit("E", 0),
            bit("D", 1),
            bit("F", 2),
        ],
    },
    // The document lacks the page of the monostable: PL72:265, PL72:281-282 name its objects.
    BlockSymbol {
        symbol: "M",
        last: Some(7),
        source: "PL72:441",
        items: &[word("P", 0, Rights::ReadWrite), word("V", 16, read_only("PL72:282")), bit("R", 0)],
    },
    BlockSymbol {
        symbol: "R",
        last: Some(3),
        source: "PL72:698",
        items: &[word("I", 0, Rights::ReadWrite), word("O", 16, Rights::ReadWrite), bit("F", 0), bit("E", 1)],
    },
    BlockSymbol {
        symbol: "D",
        last: Some(7),
        source: "PL72:878",
        items: &[word("S", 0, Rights::ReadWrite), word("V", 16, read_only("PL72:896")), bit("F", 0)],
    },
    // `L`, `T`, `A`, `M`, `C` are modified by program or terminal (PL72:1147, 1191, 1202-1203, 1216-1217).
    BlockSymbol {
        symbol: "TXT",
        last: Some(7),
        source: "PL72:1165",
        items: &[
            word("L", 0, Rights::ReadWrite),
            word("S", 16, read_only("PL72:1189")),
            word("T", 32, Rights::ReadWrite),
            word("A", 48, Rights::ReadWrite),
            word("M", 64, Rights::ReadWrite),
            word("C", 80, Rights::ReadWrite),
            word("R", 96, read_only("PL72:1218")),
            bit("D", 0),
            bit("E", 1),
        ],
    },
];

impl Cursor<'_> {
    /// One digit from 0 to F.
    fn hexadecimal(&mut self, form: &'static str) -> Result<u32, AddressError> {
        let text = self.take_while(|it| it.is_ascii_alphanumeric());
        let mut chars = text.chars();
        match (chars.next().and_then(|it| it.to_digit(16)), chars.next()) {
            (Some(value), None) => Ok(value),
            _ => Err(malformed(form)),
        }
    }
}

type Indexed<'a> = (Place, Option<(&'a str, Place)>);

/// Reads an address in upper case. The index comes with its text.
fn read(text: &str) -> Result<Indexed<'_>, AddressError> {
    let is_bit_of_pl7 =
        !text.contains(',') && matches!(text.as_bytes(), [b'%', b'M' | b'S', digit, ..] if digit.is_ascii_digit());
    let text = if is_bit_of_pl7 { text } else { text.strip_prefix('%').unwrap_or(text) };
    if !text.is_ascii() {
        return Err(malformed("an address has neither accents nor other special characters (PL72:253-310)"));
    }
    let mut at = Cursor { rest: text };
    let mut place = base(&mut at)?;
    let mut index = None;
    if at.eat('[') {
        place = place.string(at.need_number("length")?)?;
        at.need(']')?;
    } else if at.eat('(') {
        if !matches!(place.class, Class::Memory | Class::Constant) || place.ty != Type::Word {
            return Err(malformed("only the words W and CW can be indexed (PL72:994)"));
        }
        let start = at.rest;
        let word = base(&mut at)?;
        if word.class != Class::Memory || word.ty != Type::Word {
            return Err(malformed("the index is a word W (PL72:995)"));
        }
        let length = start.len() - at.rest.len();
        index = Some((start.get(..length).unwrap_or_default(), word));
        at.need(')')?;
        place.room = None;
    }
    if at.rest.is_empty() {
        Ok((place, index))
    } else {
        Err(malformed("the end of the address is not part of its form"))
    }
}

/// What stands before `[` and `(`.
fn base(at: &mut Cursor<'_>) -> Result<Place, AddressError> {
    let letters = at.letters();
    if let Some(block) = BLOCKS.iter().find(|it| it.symbol == letters) {
        return block_object(block, at);
    }
    match letters {
        "B" => {
            let number = at.need_number("number of the bit")?.within("bit", 0..=LAST_BIT, "PL72:263")?;
            let place = Place::new(Class::Memory, Type::Bool, Area::Bits, number, Rights::ReadWrite);
            Ok(place.with_room(LAST_BIT - number + 1))
        }
        "SY" => {
            let number = at.need_number("number of the system bit")?;
            let number = number.within("system bit", 0..=LAST_SYSTEM_BIT, "PL72:264")?;
            let rights = system_rights(target::system_bit(number));
            Ok(Place::new(Class::System, Type::Bool, Area::SystemBits, number, rights))
        }
        "W" => words(at, Class::Memory, Area::Words, Rights::ReadWrite, Rights::ReadWrite),
        "CW" => words(at, Class::Constant, Area::Constants, read_only("PL72:277"), read_only("PL72:302")),
        "SW" => {
            let number = at.need_number("number of the system word")?;
            let number = number.within("system word", 0..=LAST_SYSTEM_WORD, "PL72:278")?;
            let rights = system_rights(target::system_word(number));
            let place = Place::new(Class::System, Type::Word, Area::SystemWords, number * 16, rights);
            if at.eat(',') { place.extracted_bit(at, rights) } else { Ok(place) }
        }
        "COM" => common_word(at),
        "X" => step(at),
        "S" => module_fault(at),
        "I" => input_or_output(at, false),
        "O" => input_or_output(at, true),
        "IW" => register_word(at, false),
        "OW" => register_word(at, true),
        // Strings of eleven words with date and time; which access they allow is not said.
        "DT" | "DTP" => {
            let words = target::CLOCK_WORDS.value;
            let symbol = if letters == "DT" { "DT" } else { "DTP" };
            let ty = Type::WordTable(words);
            Ok(Place::new(Class::System, ty, Area::Block(symbol, 0), 0, Rights::Unknown))
        }
        "L" => Err(malformed("`L` is a label, not an object (PL72:418, PL72:600)")),
        _ => Err(malformed(
            "no object has these letters: PL7-2 has I O B SY X S W CW SW COM IW OW and the function blocks (PL72:253-310)",
        )),
    }
}

fn system_rights(row: Option<&target::SystemObject>) -> Rights {
    match row.map(|it| it.writer) {
        Some(Writer::Program) => Rights::ReadWrite,
        Some(Writer::NotProgram(source)) => Rights::ReadOnly(source),
        None => Rights::Unknown,
    }
}

/// `W5`, `CW7`, `W5,A`.
fn words(
    at: &mut Cursor<'_>,
    class: Class,
    area: Area,
    rights: Rights,
    bit_rights: Rights,
) -> Result<Place, AddressError> {
    let number = at.need_number("number of the word")?.within("word", 0..=LAST_WORD, "PL72:276-277")?;
    let place = Place::new(class, Type::Word, area, number * 16, rights);
    if at.eat(',') { place.extracted_bit(at, bit_rights) } else { Ok(place.with_room(LAST_WORD - number + 1)) }
}

/// `COM2,1`, `COM2,1,A`. A program writes those of its own station only, which no program says.
fn common_word(at: &mut Cursor<'_>) -> Result<Place, AddressError> {
    let station = at.need_number("station number")?.within("station", 0..=LAST_STATION, "PL72:279-280")?;
    at.need(',')?;
    let number = at.need_number("number of the common word")?;
    let number = number.within("common word", 0..=LAST_COMMON_WORD, "PL72:279-280")?;
    let area = Area::Network(0, station);
    let place = Place::new(Class::NetworkWord, Type::Word, area, number * 16, Rights::Unknown);
    if at.eat(',') { place.extracted_bit(at, Rights::Unknown) } else { Ok(place) }
}

/// `X3`, `X3,V`.
fn step(at: &mut Cursor<'_>) -> Result<Place, AddressError> {
    let steps = target::STEP_NUMBERS;
    let number = at.need_number("number of the step")?.within("step", steps.first..=steps.last, steps.source)?;
    if !at.eat(',') {
        return Ok(Place::new(Class::Step, Type::Bool, Area::Steps, number, Rights::ReadWrite));
    }
    if at.letters() != "V" {
        return Err(malformed("a step has a bit and a time `,V` only (PL72:422-424)"));
    }
    Ok(Place::new(Class::StepTime, Type::Word, Area::StepTimes, number * 16, read_only("PL72:283")))
}

/// `S1,3`: fault j of module x of a TSX 17-20 (PL72:1742-1765).
fn module_fault(at: &mut Cursor<'_>) -> Result<Place, AddressError> {
    let module = at.need_number("number of the module")?.within("module", 0..=3, "PL72:1744-1747")?;
    at.need(',')?;
    let fault = at.need_number("number of the fault")?.within("fault", 0..=7, "PL72:1749-1765")?;
    let area = Area::Faults(format_smolstr!("S{module}"));
    Ok(Place::new(Class::Fault, Type::Bool, area, fault, read_only("PL72:267")))
}

/// The digits before the comma: the module, or rack and module.
struct ModuleNumber<'a> {
    has_rack: bool,
    rack: u32,
    module: Number<'a>,
}

impl<'a> ModuleNumber<'a> {
    /// `y`: module 0 to 7 of rack 0 or of a controller without racks; `xy`: rack 0 or 1 and module 0 to 7.
    fn read(at: &mut Cursor<'a>) -> Result<Self, AddressError> {
        let number = at.need_number("number of the module")?;
        let part = |value| Number { text: number.text, value };
        let has_rack = number.text.len() > 1;
        if number.text.len() > 2 {
            return Err(number.missing("module", "rack 0 or 1, module 0 to 7 (PL72:196-198)"));
        }
        let rack = if has_rack { part(number.value / 10).within("rack in module", 0..=1, "PL72:196")? } else { RACK_0 };
        let module = part(number.value % 10);
        module.within("module", 0..=7, "PL72:198")?;
        Ok(Self { has_rack, rack, module })
    }

    /// One name a module: `I01,3` is `I1,3`.
    fn name(rack: u32, module: u32) -> SmolStr {
        let rack = (rack != RACK_0).then_some(rack);
        rack.into_iter().chain([module]).filter_map(|it| char::from_digit(it, 10)).collect()
    }
}

/// `0,05`, `11,A`, `2,S`.
fn read_channel(at: &mut Cursor<'_>, is_output: bool) -> Result<Channel, AddressError> {
    let ModuleNumber { has_rack, rack, module } = ModuleNumber::read(at)?;
    if !at.eat(',') {
        return Err(malformed("the channel is missing: `Ix,i` (PL72:92-100, PL72:194-200)"));
    }
    let text = at.take_while(|it| it.is_ascii_alphanumeric());
    let item = match text.as_bytes() {
        b"S" => ChannelItem::Fault,
        [digit] if digit.is_ascii_hexdigit() => {
            ChannelItem::Hexadecimal(char::from(*digit).to_digit(16).unwrap_or_default())
        }
        [tens, units] if tens.is_ascii_digit() && units.is_ascii_digit() && !has_rack => {
            let number = Number { text, value: u32::from(tens - b'0') * 10 + u32::from(units - b'0') };
            let module = module.within("module in front of a channel of two digits", 0..=3, "PL72:96")?;
            // The event inputs are on the base unit alone.
            let (last, source) = match (is_output, module) {
                (true, _) => (15, "PL72:100"),
                (false, 0) => (25, "PL72:99-104"),
                (false, _) => (23, "PL72:99"),
            };
            ChannelItem::Decimal(number.within("channel", 0..=last, source)?)
        }
        _ => {
            return Err(malformed(
                "the channel is two digits on a TSX 17-20, one digit from 0 to F on a TSX 27 or 47, or `S` (PL72:98-100, \
                 PL72:176-202)",
            ));
        }
    };
    Ok(Channel { is_output, has_rack, rack, module: module.value, item })
}

fn input_or_output(at: &mut Cursor<'_>, is_output: bool) -> Result<Place, AddressError> {
    let channel = read_channel(at, is_output)?;
    let module = ModuleNumber::name(channel.rack, channel.module);
    let (number, last, rights) = match channel.item {
        ChannelItem::Fault => {
            let (name, source) = if is_output { ("O", "PL72:268-270") } else { ("I", "PL72:269") };
            let area = Area::Faults(format_smolstr!("{name}{module}"));
            return Ok(Place::new(Class::Fault, Type::Bool, area, 0, read_only(source)));
        }
        ChannelItem::Decimal(number @ 24..) => {
            // Neither of the two event inputs is counted with the others (PL72:259-262).
            return Ok(input(module, number, read_only("PL72:261-262")));
        }
        ChannelItem::Decimal(number) => (number, if is_output { 15 } else { 23 }, read_only("PL72:259")),
        ChannelItem::Hexadecimal(number) | ChannelItem::Word(number) => (number, 15, read_only("PL72:257")),
    };
    let place = if is_output {
        Place::new(Class::Output, Type::Bool, Area::OutputChannels(module), number, Rights::ReadWrite)
    } else {
        input(module, number, rights)
    };
    Ok(place.with_room(last - number + 1))
}

fn input(module: SmolStr, number: u32, rights: Rights) -> Place {
    Place::new(Class::Input, Type::Bool, Area::InputChannels(module), number, rights)
}

/// `1,3`, `03,7`: module 0 to 3 of rack 0 (PL72:160-162, PL72:239-243).
fn read_word_channel(at: &mut Cursor<'_>, is_output: bool) -> Result<Channel, AddressError> {
    let number = at.need_number("number of the module")?;
    let has_rack = number.text.len() > 1;
    let module = number.within("module with register words", 0..=3, "PL72:160, PL72:239-243")?;
    if number.text.len() > 2 {
        return Err(malformed("the number of the module has one or two digits (PL72:196-198)"));
    }
    if !at.eat(',') {
        return Err(malformed("the number of the word is missing: `IWx,i` (PL72:156-162)"));
    }
    let word = at.need_number("number of the register word")?.within("register word", 0..=7, "PL72:162, PL72:241")?;
    Ok(Channel { is_output, has_rack, rack: RACK_0, module, item: ChannelItem::Word(word) })
}

/// `IW1,3`, `OW1,3,F`.
fn register_word(at: &mut Cursor<'_>, is_output: bool) -> Result<Place, AddressError> {
    let channel = read_word_channel(at, is_output)?;
    let word = if let ChannelItem::Word(word) = channel.item { word } else { 0 };
    let (class, letters, rights, bit_rights) = if is_output {
        (Class::Output, "OW", Rights::ReadWrite, Rights::ReadWrite)
    } else {
        (Class::Input, "IW", read_only("PL72:284-286"), read_only("PL72:307-309"))
    };
    let area = Area::ModuleWords(format_smolstr!("{letters}{}", channel.module));
    let place = Place::new(class, Type::Word, area, word * 16, rights);
    if at.eat(',') { place.extracted_bit(at, bit_rights) } else { Ok(place) }
}

/// `T0`, `T0,D`, `FC,V`, `D1,W3`.
fn block_object(block: &BlockSymbol, at: &mut Cursor<'_>) -> Result<Place, AddressError> {
    let number = match block.last {
        Some(last) => {
            let number = at.need_number("number of the block")?;
            if block.symbol == "C" && number.value == last + 1 {
                // Only the terminal reaches the fast counter by this number.
                let message = format!("counter {} is the fast counter, in a program `FC` (PL72:869)", number.value);
                let suggestion = format!("FC{}", at.rest);
                let suggestion = read(&suggestion).is_ok().then_some(suggestion);
                return Err(AddressError { suggestion, ..out_of_range(message) });
            }
            number.within("function block", 0..=last, block.source)?
        }
        None => 0,
    };
    let area = Area::Block(block.symbol, number);
    if !at.eat(',') {
        return Ok(Place::new(Class::Block, Type::Block, area, 0, Rights::Unknown));
    }
    let name = at.letters();
    if block.symbol == "D" && name == "W" {
        let step = at.need_number("number of the drum step")?.within("drum step", 0..=DRUM_STEPS - 1, "PL72:893")?;
        let start = DRUM_WORDS + 16 * step;
        return Ok(Place::new(Class::BlockWord, Type::Word, area, start, read_only("PL72:894")));
    }
    let Some(item) = block.items.iter().find(|it| it.name == name) else {
        let mut names: Vec<_> = block.items.iter().map(|it| format!(",{}", it.name)).collect();
        if block.symbol == "D" {
            names.push(",Wj".to_owned());
        }
        let names = names.join(" ");
        return Err(malformed(format!(
            "a `{}` block has the objects {names} only (PL72:265, PL72:281-282)",
            block.symbol
        )));
    };
    let ty = if item.class == Class::BlockBit { Type::Bool } else { Type::Word };
    Ok(Place::new(item.class, ty, area, item.start, item.rights))
}

/// The nearest valid address of one that is malformed: the first of the usual slips whose repair gives an address.
fn nearest(upper: &str) -> Option<String> {
    if upper.len() > LONGEST_SUGGESTION_SOURCE || !upper.is_ascii() {
        return None;
    }
    slips(upper).into_iter().find(|it| it != upper && read(it).is_ok())
}

/// Repairs of the usual slips, the likeliest first.
fn slips(text: &str) -> Vec<String> {
    // PL72:1639 prints `I0.00`, PL72:884-896 blanks after the comma.
    let compact = text.replace([' ', '\t', '\u{a0}'], "").replace(['.', ';'], ",");
    let mut out = Vec::new();
    let text = compact.as_str();
    if let Some(pl7) = text.strip_prefix('%') {
        out.extend(from_pl7(pl7));
    }
    out.push(compact.trim_end_matches([',', ':']).trim_start_matches('%').to_owned());
    let end = text.bytes().position(|it| !it.is_ascii_uppercase()).unwrap_or(text.len());
    let (letters, tail) = text.split_at(end);
    // Letters of PL7 and of the other vendor.
    let other = match letters {
        "MW" => "W",
        "KW" => "CW",
        "Q" | "A" => "O",
        "E" => "I",
        "QW" | "AW" => "OW",
        "EW" => "IW",
        "TM" => "T",
        "MN" => "M",
        "DR" => "D",
        // PL72:914 prints zeros for the letter O.
        "" if tail.starts_with('0') => "O",
        _ => letters,
    };
    out.push(format!("{other}{}", if letters.is_empty() { tail.trim_start_matches('0') } else { tail }));
    // `W5,12`: the bit is hexadecimal. `I01,12`: so is the channel of a TSX 47.
    if let Some((head, rank)) = text.rsplit_once(',')
        && let Ok(rank @ 10..=LAST_RANK) = rank.parse::<u32>()
    {
        out.push(format!("{head},{rank:X}"));
    }
    // `W5:X4`, `B5:10`, `W5(10)`, `W5[W10]`.
    if let Some((head, rank)) = text.split_once(":X").and_then(|(head, rank)| Some((head, rank.parse::<u32>().ok()?))) {
        out.push(format!("{head},{rank:X}"));
    }
    let (from, to): (&[char], _) = if text.contains("[W") { (&['[', ']'], "()") } else { (&['(', ')', ':'], "[]") };
    let mut parts = text.split(from);
    if let (Some(head), Some(inner), None | Some("")) = (parts.next(), parts.next(), parts.next()) {
        let (open, close) = to.split_at(1);
        out.push(format!("{head}{open}{inner}{close}"));
    }
    // `T0,Q`, `M2,Q`.
    if let Some(head) = text.strip_suffix(",Q") {
        out.extend([format!("{head},D"), format!("{head},R")]);
    }
    // `X3,T`.
    if let Some(head) = text.strip_suffix(",T") {
        out.push(format!("{head},V"));
    }
    // An item glued to its number or block: `T0D`, `FCP`.
    if let Some(at) = tail.bytes().position(|it| it.is_ascii_uppercase()) {
        let (number, item) = tail.split_at(at);
        out.push(format!("{letters}{number},{item}"));
    }
    if let Some(item) = text.strip_prefix("FC") {
        out.push(format!("FC,{item}"));
    }
    // The channel is missing.
    if matches!(letters, "I" | "O" | "IW" | "OW") {
        out.push(format!("{text},0"));
    }
    out
}

/// The address of PL7-2 that one of PL7 without `%`, commas for points, corresponds to.
fn from_pl7(text: &str) -> Option<String> {
    let end = text.bytes().position(|it| !it.is_ascii_uppercase()).unwrap_or(text.len());
    let (letters, tail) = text.split_at(end);
    let letters = match letters {
        "M" => "B",
        "S" => "SY",
        "MW" => "W",
        "KW" => "CW",
        "SW" | "I" | "IW" | "X" | "C" | "R" | "T" => letters,
        "Q" => "O",
        "QW" => "OW",
        "TM" => "T",
        "MN" => "M",
        "DR" => "D",
        _ => return None,
    };
    let (number, end) = match (tail.split_once(":X"), tail.split_once(':')) {
        (Some((number, rank)), _) => (number, format!(",{:X}", rank.parse::<u32>().ok()?)),
        (None, Some((number, length))) => (number, format!("[{length}]")),
        (None, None) => (tail, String::new()),
    };
    let number = match letters {
        "X" => number.replace(",T", ",V"),
        "T" => number.replace(",Q", ",D"),
        _ => number.to_owned(),
    };
    Some(format!("{letters}{number}{end}"))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn address(text: &str) -> Address {
        parse(text).unwrap_or_else(|error| panic!("{text}: {error:?}"))
    }

    fn object(text: &str) -> Object {
        address(text).object
    }

    fn error(text: &str) -> AddressError {
        match parse(text) {
            Ok(object) => panic!("{text} is {object:?}"),
            Err(error) => error,
        }
    }

    type Case = (&'static str, Class, Type, Area, u32, Rights);

    #[track_caller]
    fn check(cases: &[Case]) {
        for (text, class, ty, area, start, rights) in cases {
            let object = object(text);
            assert_eq!((object.class, object.ty), (*class, *ty), "{text}");
            assert_eq!((&object.footprint.area, object.footprint.start), (area, *start), "{text}");
            assert_eq!(object.rights, *rights, "{text}");
            assert_eq!(object.text, *text);
            if let Some(bits) = ty.bits() {
                assert_eq!(object.footprint.bits, bits, "{text}");
            }
        }
    }

    #[test]
    fn bits_and_words() {
        use Rights::{ReadWrite, Unknown};
        use Type::{BitTable, Bool, Word, WordTable};
        check(&[
            ("B0", Class::Memory, Bool, Area::Bits, 0, ReadWrite),
            ("b255", Class::Memory, Bool, Area::Bits, 255, ReadWrite),
            ("B5[10]", Class::Memory, BitTable(10), Area::Bits, 5, ReadWrite),
            ("B240[16]", Class::Memory, BitTable(16), Area::Bits, 240, ReadWrite),
            ("SY00", Class::System, Bool, Area::SystemBits, 0, ReadWrite),
            ("SY0", Class::System, Bool, Area::SystemBits, 0, ReadWrite),
            ("SY21", Class::System, Bool, Area::SystemBits, 21, ReadWrite),
            ("SY6", Class::System, Bool, Area::SystemBits, 6, read_only("PL72:330")),
            ("SY02", Class::System, Bool, Area::SystemBits, 2, Unknown),
            ("X3", Class::Step, Bool, Area::Steps, 3, ReadWrite),
            ("X95,V", Class::StepTime, Word, Area::StepTimes, 95 * 16, read_only("PL72:283")),
            ("W5", Class::Memory, Word, Area::Words, 80, ReadWrite),
            ("W1023", Class::Memory, Word, Area::Words, 16_368, ReadWrite),
            ("w5,a", Class::Memory, Bool, Area::Words, 90, ReadWrite),
            ("W512[60]", Class::Memory, WordTable(60), Area::Words, 8192, ReadWrite),
            ("W512[128]", Class::Memory, WordTable(128), Area::Words, 8192, ReadWrite),
            ("CW7", Class::Constant, Word, Area::Constants, 112, read_only("PL72:277")),
            ("CW7,F", Class::Constant, Bool, Area::Constants, 127, read_only("PL72:302")),
            ("CW5[10]", Class::Constant, WordTable(10), Area::Constants, 80, read_only("PL72:277")),
            ("SW16", Class::System, Word, Area::SystemWords, 256, ReadWrite),
            ("SW52", Class::System, Word, Area::SystemWords, 832, ReadWrite),
            ("SW58", Class::System, Word, Area::SystemWords, 928, read_only("PL72:390")),
            ("SW3,F", Class::System, Bool, Area::SystemWords, 63, read_only("PL72:376")),
            ("SW0,2", Class::System, Bool, Area::SystemWords, 2, ReadWrite),
            ("SW30", Class::System, Word, Area::SystemWords, 480, Unknown),
            ("COM15,3", Class::NetworkWord, Word, Area::Network(0, 15), 48, Unknown),
            ("COM1,2,A", Class::NetworkWord, Bool, Area::Network(0, 1), 42, Unknown),
            ("DT", Class::System, WordTable(11), Area::Block("DT", 0), 0, Unknown),
            ("DTP", Class::System, WordTable(11), Area::Block("DTP", 0), 0, Unknown),
        ]);
        assert!(object("W5,A").extracted && !object("W5").extracted);
    }

    #[test]
    fn inputs_and_outputs() {
        use Rights::ReadWrite;
        use Type::{BitTable, Bool, Word};
        let inputs = |it: &str| Area::InputChannels(it.into());
        let outputs = |it: &str| Area::OutputChannels(it.into());
        let words = |it: &str| Area::ModuleWords(it.into());
        let faults = |it: &str| Area::Faults(it.into());
        check(&[
            ("I0,05", Class::Input, Bool, inputs("0"), 5, read_only("PL72:259")),
            ("I2,03", Class::Input, Bool, inputs("2"), 3, read_only("PL72:259")),
            ("I0,24", Class::Input, Bool, inputs("0"), 24, read_only("PL72:261-262")),
            ("I0,25", Class::Input, Bool, inputs("0"), 25, read_only("PL72:261-262")),
            ("I3,23", Class::Input, Bool, inputs("3"), 23, read_only("PL72:259")),
            ("O1,05", Class::Output, Bool, outputs("1"), 5, ReadWrite),
            ("O0,00[8]", Class::Output, BitTable(8), outputs("0"), 0, ReadWrite),
            ("I0,08[16]", Class::Input, BitTable(16), inputs("0"), 8, read_only("PL72:259")),
            ("I1,B", Class::Input, Bool, inputs("1"), 11, read_only("PL72:257")),
            ("i01,b", Class::Input, Bool, inputs("1"), 11, read_only("PL72:257")),
            ("I1,0[16]", Class::Input, BitTable(16), inputs("1"), 0, read_only("PL72:257")),
            ("O4,5[5]", Class::Output, BitTable(5), outputs("4"), 5, ReadWrite),
            ("O17,F", Class::Output, Bool, outputs("17"), 15, ReadWrite),
            ("O2,S", Class::Fault, Bool, faults("O2"), 0, read_only("PL72:268-270")),
            ("I13,S", Class::Fault, Bool, faults("I13"), 0, read_only("PL72:269")),
            ("S3,7", Class::Fault, Bool, faults("S3"), 7, read_only("PL72:267")),
            ("IW1,3", Class::Input, Word, words("IW1"), 48, read_only("PL72:284-286")),
            ("IW01,3", Class::Input, Word, words("IW1"), 48, read_only("PL72:284-286")),
            ("IW1,3,F", Class::Input, Bool, words("IW1"), 63, read_only("PL72:307-309")),
            ("OW3,7", Class::Output, Word, words("OW3"), 112, ReadWrite),
            ("OW03,7,0", Class::Output, Bool, words("OW3"), 112, ReadWrite),
        ]);
    }

    #[test]
    fn channels_as_written() {
        let read = |text| channel(text).map(|it| (it.is_output, it.has_rack, it.rack, it.module, it.item));
        assert_eq!(read("I0,05"), Some((false, false, 0, 0, ChannelItem::Decimal(5))));
        assert_eq!(read("o17,f[1]"), Some((true, true, 1, 7, ChannelItem::Hexadecimal(15))));
        assert_eq!(read("O2,S"), Some((true, false, 0, 2, ChannelItem::Fault)));
        assert_eq!(read("IW03,7,A"), Some((false, true, 0, 3, ChannelItem::Word(7))));
        for text in ["B5", "I9,0", "S1,0", "", "I1,0x"] {
            assert_eq!(read(text), None, "{text}");
        }
    }

    #[test]
    fn function_blocks() {
        use Rights::{ReadWrite, Unknown};
        use Type::{Block, Bool, Word};
        let bit_rights = read_only("PL72:265");
        let (bit, word) = (Class::BlockBit, Class::BlockWord);
        check(&[
            ("T0", Class::Block, Block, Area::Block("T", 0), 0, Unknown),
            ("T31,P", word, Word, Area::Block("T", 31), 0, ReadWrite),
            ("t0,v", word, Word, Area::Block("T", 0), 16, read_only("PL72:669")),
            ("T0,D", bit, Bool, Area::Block("T", 0), 112, bit_rights),
            ("T0,R", bit, Bool, Area::Block("T", 0), 113, bit_rights),
            ("C30,V", word, Word, Area::Block("C", 30), 16, read_only("PL72:749")),
            ("C1,E", bit, Bool, Area::Block("C", 1), 112, bit_rights),
            ("C1,D", bit, Bool, Area::Block("C", 1), 113, bit_rights),
            ("C1,F", bit, Bool, Area::Block("C", 1), 114, bit_rights),
            ("FC", Class::Block, Block, Area::Block("FC", 0), 0, Unknown),
            ("FC,P", word, Word, Area::Block("FC", 0), 0, ReadWrite),
            ("FC,D", bit, Bool, Area::Block("FC", 0), 113, bit_rights),
            ("M2,R", bit, Bool, Area::Block("M", 2), 112, bit_rights),
            ("M2,P", word, Word, Area::Block("M", 2), 0, ReadWrite),
            ("R0,F", bit, Bool, Area::Block("R", 0), 112, bit_rights),
            ("R3,I", word, Word, Area::Block("R", 3), 0, ReadWrite),
            ("D1,F", bit, Bool, Area::Block("D", 1), 112, bit_rights),
            ("D1,S", word, Word, Area::Block("D", 1), 0, ReadWrite),
            ("D1,V", word, Word, Area::Block("D", 1), 16, read_only("PL72:896")),
            ("D1,W15", word, Word, Area::Block("D", 1), 368, read_only("PL72:894")),
            ("TXT7,L", word, Word, Area::Block("TXT", 7), 0, ReadWrite),
            ("TXT0,R", word, Word, Area::Block("TXT", 0), 96, read_only("PL72:1218")),
            ("TXT0,E", bit, Bool, Area::Block("TXT", 0), 113, bit_rights),
        ]);
        for block in BLOCKS {
            let number = if block.last.is_some() { "0" } else { "" };
            let whole = object(&format!("{}{number}", block.symbol)).footprint;
            let items: Vec<_> =
                block.items.iter().map(|it| object(&format!("{}{number},{}", block.symbol, it.name))).collect();
            for (index, item) in items.iter().enumerate() {
                assert!(whole.contains(&item.footprint), "{}", item.text);
                let rest = items.get(index + 1..).unwrap_or_default();
                assert!(rest.iter().all(|it| !it.footprint.overlaps(&item.footprint)), "{}", item.text);
            }
        }
        assert!(object("D0").footprint.contains(&object("D0,W15").footprint));
    }

    /// The largest numbers are those of the tables of controllers.
    #[test]
    fn numbers_agree_with_the_tables() {
        use crate::target::pl72::{Kind, Model};
        let any = Model::default();
        for block in BLOCKS {
            let count = any.block_count(block.symbol).map(|it| it.value);
            assert_eq!(count, Some(block.last.map_or(1, |it| it + 1)), "{}", block.symbol);
        }
        for (kind, last) in [
            (Kind::Bit, LAST_BIT),
            (Kind::SystemBit, LAST_SYSTEM_BIT),
            (Kind::Word, LAST_WORD),
            (Kind::Constant, LAST_WORD),
            (Kind::SystemWord, LAST_SYSTEM_WORD),
        ] {
            assert_eq!(any.count(kind).value, last + 1, "{kind:?}");
        }
    }

    #[test]
    fn footprints_that_share_memory() {
        let overlap = |a: &str, b: &str| object(a).footprint.overlaps(&object(b).footprint);
        for (a, b) in [
            ("B5[10]", "B14"),
            ("O0,00[8]", "O0,07"),
            ("I01,5", "I1,5"),
            ("I0,10", "I0,A"),
            ("W5", "W5,F"),
            ("W0[60]", "W59"),
            ("D1", "D1,S"),
            ("SW3,0", "SW3"),
            ("OW1,2", "OW01,2,0"),
            ("T0", "T0,D"),
        ] {
            assert!(overlap(a, b) && overlap(b, a), "{a} {b}");
        }
        for (a, b) in [
            ("B5[10]", "B15"),
            ("I11,5", "I1,5"),
            ("I1,5", "O1,5"),
            ("W5", "CW5"),
            ("W5", "W6,0"),
            ("IW1,0", "OW1,0"),
            ("T0,P", "T1,P"),
            ("T0,P", "C0,P"),
            ("S0,1", "O0,S"),
            ("X3", "X3,V"),
            ("B0", "SY0"),
            ("COM0,1", "COM1,1"),
        ] {
            assert!(!overlap(a, b) && !overlap(b, a), "{a} {b}");
        }
    }

    #[test]
    fn indexed() {
        for (text, class, start, index) in [
            ("W5(W10)", Class::Memory, 80, "W10"),
            ("CW10(w0)", Class::Constant, 160, "W0"),
            ("W200(W10)", Class::Memory, 3200, "W10"),
        ] {
            let found = address(text);
            assert_eq!((found.object.class, found.object.ty, found.object.footprint.start), (class, Type::Word, start));
            assert!(found.object.indexed && !found.object.is_fixed());
            assert_eq!(found.object.text, text);
            let word = found.index.unwrap_or_else(|| panic!("{text}"));
            assert_eq!((word.text.as_str(), word.class, word.indexed), (index, Class::Memory, false));
        }
        assert!(address("W5").index.is_none());
        for text in [
            "B5(W1)",
            "SW5(W1)",
            "W5,3(W1)",
            "W5(CW1)",
            "W5(B1)",
            "W5(W1",
            "W5(W1)(W2)",
            "W5(W1(W2))",
            "W5(W1)[3]",
            "W0[3](W1)",
        ] {
            assert_eq!(error(text).kind, AddressErrorKind::Malformed, "{text}");
        }
    }

    #[test]
    fn malformed_with_the_nearest_form() {
        let cases = [
            ("I0.05", Some("I0,05")),
            ("D1, F", Some("D1,F")),
            ("%M10", Some("B10")),
            ("%MW5", Some("W5")),
            ("%MW5:X12", Some("W5,C")),
            ("%MW5:10", Some("W5[10]")),
            ("%KW5", Some("CW5")),
            ("%S5", Some("SY5")),
            ("%Q1.0", Some("O1,0")),
            ("%I1.3", Some("I1,3")),
            ("%TM1.Q", Some("T1,D")),
            ("%X3.T", Some("X3,V")),
            ("%MN2.R", Some("M2,R")),
            ("MW5", Some("W5")),
            ("KW5", Some("CW5")),
            ("Q1,0", Some("O1,0")),
            ("E1,0", Some("I1,0")),
            ("A4.0", Some("O4,0")),
            ("04,5", Some("O4,5")),
            ("W5,12", Some("W5,C")),
            ("I01,12", Some("I01,C")),
            ("W5:X4", Some("W5,4")),
            ("B5:10", Some("B5[10]")),
            ("W5(10)", Some("W5[10]")),
            ("W5[W10]", Some("W5(W10)")),
            ("T0D", Some("T0,D")),
            ("T0,Q", Some("T0,D")),
            ("M2,Q", Some("M2,R")),
            ("X3V", Some("X3,V")),
            ("X3,T", Some("X3,V")),
            ("FCP", Some("FC,P")),
            ("FC.P", Some("FC,P")),
            ("I1", Some("I1,0")),
            ("W5,", Some("W5")),
            ("W5,G", None),
            ("W5,3,4", None),
            ("T0,V,3", None),
            ("SY3[4]", None),
            ("X3[4]", None),
            ("SW3[4]", None),
            ("IW1,0[4]", None),
            ("W5,3[4]", None),
            ("O2,S[4]", None),
            ("I0,24[2]", None),
            ("B5[", None),
            ("B5[10", None),
            ("B5[]", None),
            ("B5[10]x", None),
            ("L10", None),
            ("MT5", None),
            ("X3,D", None),
            ("D1,W", None),
            ("D1,Q", None),
            ("COM1", None),
            ("S1", None),
            ("I01,05", None),
            ("T", None),
            ("W", None),
            ("", None),
            ("W5é", None),
            ("W٣", None),
            ("Pompe", None),
        ];
        for (text, suggestion) in cases {
            let error = error(text);
            assert_eq!(error.kind, AddressErrorKind::Malformed, "{text}: {error:?}");
            assert_eq!(error.suggestion.as_deref(), suggestion, "{text}");
            assert!(!error.message.is_empty() && !error.message.ends_with('.'), "{text}");
        }
    }

    #[test]
    fn a_percent_sign_may_stand_before_an_address() {
        for text in ["B5", "I0,05", "W5(W10)", "X3", "X3,V", "T0,D", "SY21", "T0", "M2,R", "S1,0"] {
            let (bare, signed) = (object(text), object(&format!("%{text}")));
            assert_eq!((bare.footprint, bare.rights), (signed.footprint, signed.rights), "{text}");
        }
        // A bit of PL7, no monostable.
        assert_eq!(error("%M5").suggestion.as_deref(), Some("B5"));
        assert_eq!(error("%S1").suggestion.as_deref(), Some("SY1"));
    }

    #[test]
    fn out_of_range_with_the_source() {
        let cases = [
            ("B256", "PL72:263"),
            ("SY24", "PL72:264"),
            ("W1024", "PL72:276"),
            ("CW99999999999999999999", "PL72:276"),
            ("SW64", "PL72:278"),
            ("COM16,0", "PL72:279"),
            ("COM0,4", "PL72:279"),
            ("X96", "PL72:1409"),
            ("S4,0", "PL72:1744"),
            ("S0,8", "PL72:1749"),
            ("I8,0", "PL72:198"),
            ("I20,0", "PL72:196"),
            ("I18,0", "PL72:198"),
            ("I111,0", "PL72:196"),
            ("I0,26", "PL72:99"),
            ("I1,24", "PL72:99"),
            ("O0,16", "PL72:100"),
            ("I4,00", "PL72:96"),
            ("IW4,0", "PL72:160"),
            ("IW13,0", "PL72:239"),
            ("OW1,8", "PL72:162"),
            ("T32,D", "PL72:653"),
            ("M8,R", "PL72:441"),
            ("R4", "PL72:698"),
            ("D8,F", "PL72:878"),
            ("D1,W16", "PL72:893"),
            ("TXT8,D", "PL72:1165"),
            ("C32,V", "PL72:732"),
            ("B0[17]", "PL72:989"),
            ("B0[0]", "PL72:989"),
            ("W0[0]", "PL72:1092"),
            ("W1020[5]", "PL72:1092"),
            ("W5(W1024)", "PL72:276"),
        ];
        for (text, source) in cases {
            let error = error(text);
            assert_eq!(error.kind, AddressErrorKind::OutOfRange, "{text}: {error:?}");
            assert!(error.message.contains(source), "{text}: {}", error.message);
            assert_eq!(error.suggestion, None);
        }
        for text in ["B250[7]", "I1,8[9]", "O0,15[2]", "I0,20[5]"] {
            assert_eq!(error(text).kind, AddressErrorKind::OutOfRange, "{text}");
        }
        for text in ["B250[6]", "I1,8[8]", "O0,15[1]", "I0,20[4]", "W1020[4]", "I17,F", "IW3,7"] {
            object(text);
        }
    }

    #[test]
    fn the_fast_counter_has_its_own_name() {
        let error = error("C31,P");
        assert_eq!(error.kind, AddressErrorKind::OutOfRange);
        assert!(error.message.contains("PL72:869"));
        assert_eq!(error.suggestion.as_deref(), Some("FC,P"));
        assert_eq!(super::tests::error("C31,X").suggestion, None);
    }

    fn holds(text: &str) -> Result<(), TestCaseError> {
        match parse(text) {
            Ok(Address { object, index }) => {
                prop_assert!(object.footprint.bits > 0);
                prop_assert!(object.footprint.end() > object.footprint.start);
                prop_assert_eq!(object.indexed, index.is_some());
            }
            Err(error) => {
                prop_assert!(!error.message.is_empty());
                if let Some(suggestion) = error.suggestion {
                    prop_assert!(parse(&suggestion).is_ok(), "{} -> {}", text, suggestion);
                }
            }
        }
        channel(text);
        Ok(())
    }

    proptest! {
        #[test]
        fn any_text_is_an_object_or_an_error(text in r"\PC{0,20}") {
            holds(&text)?;
        }

        #[test]
        fn any_likely_address_is_an_object_or_an_error(
            text in r"%?[IOBSYXWCTMRDFPVL]{0,3}[0-9]{0,4}[,.:]?[0-9A-FSVPDREW]{0,3}[\[(,]?W?[0-9]{0,3}[\])]?",
        ) {
            holds(&text)?;
        }

        #[test]
        fn case_does_not_matter(text in r"(I|O|W|T|C|B|IW|CW)[0-9]{1,2}(,[0-9A-FVPS]{1,2})?(\[[0-9]\])?") {
            let lower = text.to_lowercase();
            prop_assert_eq!(
                parse(&text).map(|it| it.object.footprint).map_err(|it| it.kind),
                parse(&lower).map(|it| it.object.footprint).map_err(|it| it.kind)
            );
        }
    }
}
