//! Where the fields of STEP 7 blocks lie: the types that blocks declare, and their offsets.
//!
//! STEP 7 gives the addresses by itself (S7:1071). How, the source manual shows by example (S7:1059-1069); the rules are the
//! vendor's general documentation: single bits share a byte; bytes and characters lie on any byte; everything else begins
//! on an even one; arrays and structures fill their last word; the parts of an interface each begin on an even byte.
//!
//! Sizes and offsets are in bits, bit 0 of byte 0 first, as in [`Footprint`](super::object::Footprint).

use std::fmt;
use std::sync::Arc;

use rustc_hash::FxHashMap;
use smol_str::{SmolStr, format_smolstr};

use super::entity::{BlockKind, BlockName};
use super::object::Type;
use super::unit::Section;

/// A type as a block declares it.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum DataType {
    Elementary(Elementary),
    /// `STRING[20]`: the longest text.
    Text(u32),
    /// Bounds of each dimension.
    Array(Box<[(i32, i32)]>, Box<DataType>),
    Struct(Box<[Field]>),
    /// `UDT 1`, `FB 2`, `"valve"`.
    Named(BlockName),
    Unknown,
}

/// Types without parts, and the pointers to others.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Elementary {
    Bool,
    Byte,
    Char,
    Word,
    Int,
    S5Time,
    Date,
    Double,
    DoubleInt,
    Real,
    Time,
    TimeOfDay,
    DateAndTime,
    Timer,
    Counter,
    /// `BLOCK_DB` and its like.
    Block,
    Pointer,
    Any,
}

impl Elementary {
    const ALL: [(Self, &[&str]); 18] = [
        (Self::Bool, &["BOOL"]),
        (Self::Byte, &["BYTE"]),
        (Self::Char, &["CHAR"]),
        (Self::Word, &["WORD"]),
        (Self::Int, &["INT"]),
        (Self::S5Time, &["S5TIME"]),
        (Self::Date, &["DATE"]),
        (Self::Double, &["DWORD"]),
        (Self::DoubleInt, &["DINT"]),
        (Self::Real, &["REAL"]),
        (Self::Time, &["TIME"]),
        (Self::TimeOfDay, &["TIME_OF_DAY", "TOD"]),
        (Self::DateAndTime, &["DATE_AND_TIME", "DT"]),
        (Self::Timer, &["TIMER"]),
        (Self::Counter, &["COUNTER"]),
        (Self::Block, &["BLOCK_DB", "BLOCK_FB", "BLOCK_FC", "BLOCK_SDB"]),
        (Self::Pointer, &["POINTER"]),
        (Self::Any, &["ANY"]),
    ];

    pub fn parse(name: &str) -> Option<Self> {
        Self::ALL.iter().find(|it| it.1.iter().any(|it| it.eq_ignore_ascii_case(name))).map(|it| it.0)
    }

    pub fn name(self) -> &'static str {
        Self::ALL.iter().find(|it| it.0 == self).and_then(|it| it.1.first()).copied().unwrap_or_default()
    }

    pub fn bits(self) -> u32 {
        match self {
            Self::Bool => 1,
            Self::Byte | Self::Char => 8,
            Self::Word | Self::Int | Self::S5Time | Self::Date | Self::Timer | Self::Counter | Self::Block => 16,
            Self::Double | Self::DoubleInt | Self::Real | Self::Time | Self::TimeOfDay => 32,
            Self::Pointer => 48,
            Self::DateAndTime => 64,
            Self::Any => 80,
        }
    }

    /// As an operand of that size, where there is one.
    pub fn operand(self) -> Type {
        match self {
            Self::Timer | Self::Counter | Self::Block => Type::Block,
            Self::Real => Type::Float,
            other => match other.bits() {
                1 => Type::Bool,
                8 => Type::Byte,
                16 => Type::Word,
                32 => Type::Double,
                _ => Type::Unknown,
            },
        }
    }
}

/// A parameter, variable or component.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Field {
    /// In lower case.
    pub name: SmolStr,
    /// Of a component, that of the whole.
    pub section: Section,
    pub ty: DataType,
    /// Place of the name, an index into the anchors of the unit's model.
    pub anchor: u32,
}

/// As a declaration has it, the parts of a structure left out.
impl fmt::Display for DataType {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Elementary(it) => f.write_str(it.name()),
            Self::Text(longest) => write!(f, "STRING[{longest}]"),
            Self::Array(bounds, of) => {
                f.write_str("ARRAY[")?;
                for (at, (first, last)) in bounds.iter().enumerate() {
                    write!(f, "{}{first}..{last}", if at > 0 { ", " } else { "" })?;
                }
                write!(f, "] OF {of}")
            }
            Self::Struct(_) => f.write_str("STRUCT"),
            Self::Named(name) => name.fmt(f),
            Self::Unknown => f.write_str("?"),
        }
    }
}

impl DataType {
    /// What the block declares by itself, in order.
    pub fn fields(&self) -> &[Field] {
        match self {
            Self::Struct(fields) => fields,
            _ => &[],
        }
    }

    /// The type when it has no parts.
    pub fn elementary(&self) -> Option<Elementary> {
        match self {
            Self::Elementary(it) => Some(*it),
            _ => None,
        }
    }

    /// The types that it goes by, those of its parts too.
    pub fn each_named<'a>(&'a self, each: &mut impl FnMut(&'a BlockName)) {
        match self {
            Self::Named(name) => each(name),
            Self::Array(_, of) => of.each_named(each),
            Self::Struct(fields) => fields.iter().for_each(|it| it.ty.each_named(each)),
            Self::Elementary(_) | Self::Text(_) | Self::Unknown => {}
        }
    }

    /// The same, to give them other names.
    pub fn each_named_mut(&mut self, each: &mut impl FnMut(&mut BlockName)) {
        match self {
            Self::Named(name) => each(name),
            Self::Array(_, of) => of.each_named_mut(each),
            Self::Struct(fields) => fields.iter_mut().for_each(|it| it.ty.each_named_mut(each)),
            Self::Elementary(_) | Self::Text(_) | Self::Unknown => {}
        }
    }

    /// The type that a name stands for, blanks or not: `INT`, `UDT 1`, `STRING [10]`, `"valve"`.
    pub fn parse(text: &str) -> Self {
        let text: String = if text.trim_start().starts_with(['"', '«']) {
            text.trim().to_owned()
        } else {
            text.split_whitespace().collect()
        };
        if let Some(it) = Elementary::parse(&text) {
            return Self::Elementary(it);
        }
        let upper = text.to_ascii_uppercase();
        if let Some(rest) = upper.strip_prefix("STRING") {
            let length = rest.strip_prefix('[').and_then(|it| it.strip_suffix(']'));
            return match (rest, length.map(str::parse)) {
                // Without a length, a text has the longest (the vendor's general documentation).
                ("", _) => Self::Text(254),
                (_, Some(Ok(length))) if length <= 254 => Self::Text(length),
                _ => Self::Unknown,
            };
        }
        block_name(&text, &upper).map_or(Self::Unknown, Self::Named)
    }
}

fn block_name(text: &str, upper: &str) -> Option<BlockName> {
    let quoted = text.strip_prefix('"').and_then(|it| it.strip_suffix('"'));
    let quoted = quoted.or_else(|| text.strip_prefix('«').and_then(|it| it.strip_suffix('»')));
    if let Some(symbol) = quoted {
        return Some(BlockName::Symbol(symbol.trim().to_lowercase().into()));
    }
    let kinds = [("UDT", BlockKind::Udt), ("SFB", BlockKind::Sfb), ("FB", BlockKind::Fb)];
    kinds
        .into_iter()
        .find_map(|(letters, kind)| Some(BlockName::Number(kind, upper.strip_prefix(letters)?.parse().ok()?)))
}

/// A field with its place in what it is part of.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Placed {
    pub name: SmolStr,
    pub section: Section,
    pub anchor: u32,
    pub start: u32,
    pub shape: Shape,
}

/// A type with the offsets of its parts.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Shape {
    Leaf(Elementary),
    Text(u32),
    /// Of each dimension its bounds, and how far its elements lie apart.
    Array(Box<[Dimension]>, Box<Shape>),
    /// What the type is called, if it has a name.
    Struct(Arc<Layout>, Option<BlockName>),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Dimension {
    pub first: i32,
    pub last: i32,
    pub step: u32,
}

/// The fields of a block or structure, in order of their addresses.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Layout {
    pub fields: Vec<Placed>,
    /// The size. `None` when a type is not known: only the fields before it are placed then.
    pub bits: Option<u32>,
    /// Indices of the fields, in the order of their names.
    by_name: Box<[u32]>,
}

/// A place in a block.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Place {
    /// `motor.speed[3]`
    pub path: String,
    pub start: u32,
    pub bits: u32,
    /// `None` for a text, or for a whole with parts.
    pub ty: Option<Elementary>,
    pub section: Section,
    /// Place of the declaration, in the unit that declares what has the field.
    pub anchor: u32,
    /// The named type that has the field; `None` when the block itself declares it.
    pub of: Option<BlockName>,
}

/// No data block of an S7-300 or S7-400 is longer than 64 KiB (the vendor's general documentation).
const MOST_BITS: u32 = 65_536 * 8;

const WORD: u32 = 16;

/// Structures of structures, further than any tool lets them nest.
const MOST_NESTED: usize = 64;

/// As a declaration has it, the parts of a structure left out.
impl fmt::Display for Shape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Leaf(it) => f.write_str(it.name()),
            Self::Text(longest) => write!(f, "STRING[{longest}]"),
            Self::Array(dimensions, of) => {
                let bounds: Vec<String> = dimensions.iter().map(|it| format!("{}..{}", it.first, it.last)).collect();
                write!(f, "ARRAY[{}] OF {of}", bounds.join(", "))
            }
            Self::Struct(_, Some(name)) => name.fmt(f),
            Self::Struct(_, None) => f.write_str("STRUCT"),
        }
    }
}

impl Shape {
    /// Size, where it is known.
    pub fn bits(&self) -> Option<u32> {
        match self {
            Self::Leaf(it) => Some(it.bits()),
            Self::Text(length) => Some((length + 2) * 8),
            Self::Array(dimensions, _) => {
                let outer = dimensions.first()?;
                let count = u32::try_from(i64::from(outer.last) - i64::from(outer.first) + 1).ok()?;
                outer.step.checked_mul(count)?.checked_next_multiple_of(WORD).filter(|it| *it <= MOST_BITS)
            }
            Self::Struct(layout, _) => layout.bits,
        }
    }

    /// What the first address must be a multiple of.
    fn alignment(&self) -> u32 {
        match self {
            Self::Leaf(Elementary::Bool) => 1,
            Self::Leaf(Elementary::Byte | Elementary::Char) => 8,
            _ => WORD,
        }
    }
}

/// The layouts of named types, as far as a program declares them.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Layouts {
    known: FxHashMap<BlockName, Option<Arc<Layout>>>,
}

impl Layouts {
    /// `blocks`: what each data block, function block and UDT declares; functions keep nothing.
    pub fn new<'a>(blocks: impl IntoIterator<Item = (&'a BlockName, &'a DataType)>) -> Self {
        let blocks: FxHashMap<&BlockName, &DataType> = blocks.into_iter().collect();
        let mut layouts = Self::default();
        let mut names: Vec<&BlockName> = blocks.keys().copied().collect();
        names.sort_unstable();
        for name in names {
            layouts.named(&blocks, name, 0);
        }
        layouts
    }

    pub fn of(&self, name: &BlockName) -> Option<&Arc<Layout>> {
        self.known.get(name)?.as_ref()
    }

    fn named(
        &mut self,
        blocks: &FxHashMap<&BlockName, &DataType>,
        name: &BlockName,
        depth: usize,
    ) -> Option<Arc<Layout>> {
        if let Some(known) = self.known.get(name) {
            return known.clone();
        }
        // A type that holds itself has no size.
        self.known.insert(name.clone(), None);
        let layout = match blocks.get(name)? {
            DataType::Struct(fields) => Some(Arc::new(self.layout(blocks, fields, depth))),
            DataType::Named(other) => self.named(blocks, other, depth + 1),
            _ => None,
        };
        self.known.insert(name.clone(), layout.clone());
        layout
    }

    fn layout(&mut self, blocks: &FxHashMap<&BlockName, &DataType>, fields: &[Field], depth: usize) -> Layout {
        let mut layout = self.placed(blocks, fields, depth);
        let mut by_name: Vec<u32> = (0..).zip(&layout.fields).map(|it| it.0).collect();
        by_name.sort_by(|a, b| layout.fields[*a as usize].name.cmp(&layout.fields[*b as usize].name));
        layout.by_name = by_name.into();
        layout
    }

    fn placed(&mut self, blocks: &FxHashMap<&BlockName, &DataType>, fields: &[Field], depth: usize) -> Layout {
        let mut layout = Layout::default();
        let mut at = 0_u32;
        let mut section = None;
        for field in fields.iter().filter(|it| it.section != Section::Temp) {
            if section.replace(field.section) != Some(field.section) {
                at = at.next_multiple_of(WORD);
            }
            let shape =
                match self.shape(blocks, &field.ty, depth) {
                    // Of what lies elsewhere, a block keeps a pointer.
                    Some(
                        Shape::Array(..) | Shape::Struct(..) | Shape::Text(_) | Shape::Leaf(Elementary::DateAndTime),
                    ) if field.section == Section::InOut && depth == 0 => Some(Shape::Leaf(Elementary::Pointer)),
                    shape => shape,
                };
            let Some((shape, bits)) = shape.and_then(|it| it.bits().map(|bits| (it, bits))) else { return layout };
            let start = at.next_multiple_of(shape.alignment());
            at = start.saturating_add(bits);
            if at > MOST_BITS {
                return layout;
            }
            let (name, section, anchor) = (field.name.clone(), field.section, field.anchor);
            layout.fields.push(Placed { name, section, anchor, start, shape });
        }
        layout.bits = Some(at.next_multiple_of(WORD));
        layout
    }

    fn shape(&mut self, blocks: &FxHashMap<&BlockName, &DataType>, ty: &DataType, depth: usize) -> Option<Shape> {
        if depth > MOST_NESTED {
            return None;
        }
        Some(match ty {
            DataType::Elementary(it) => Shape::Leaf(*it),
            DataType::Text(length) => Shape::Text(*length),
            DataType::Array(bounds, of) => {
                let of = self.shape(blocks, of, depth + 1)?;
                Shape::Array(dimensions(bounds, &of)?, Box::new(of))
            }
            DataType::Struct(fields) => Shape::Struct(Arc::new(self.layout(blocks, fields, depth + 1)), None),
            DataType::Named(name) => Shape::Struct(self.named(blocks, name, depth + 1)?, Some(name.clone())),
            DataType::Unknown => return None,
        })
    }

    /// The local data of a block: its temporary variables.
    pub fn of_temporary(fields: &[Field]) -> Layout {
        Self::of_fields(&as_static(fields))
    }

    /// The layout of what one block declares, with no named types.
    pub fn of_fields(fields: &[Field]) -> Layout {
        Self::default().layout(&FxHashMap::default(), fields, 0)
    }

    /// What a block knows by name, whether it lasts or not, with the named types that are known. No place in it says anything.
    pub fn of_names(&self, fields: &[Field]) -> Layout {
        self.clone().layout(&FxHashMap::default(), &as_static(fields), 0)
    }
}

fn as_static(fields: &[Field]) -> Vec<Field> {
    fields.iter().map(|it| Field { section: Section::Static, ..it.clone() }).collect()
}

/// Bits of one row follow each other; rows begin with a byte, elements of other types with theirs.
fn dimensions(bounds: &[(i32, i32)], of: &Shape) -> Option<Box<[Dimension]>> {
    let mut step = of.bits()?.checked_next_multiple_of(of.alignment())?;
    let mut dimensions = Vec::with_capacity(bounds.len());
    for &(first, last) in bounds.iter().rev() {
        let count = u32::try_from(i64::from(last) - i64::from(first) + 1).ok().filter(|it| *it > 0)?;
        dimensions.push(Dimension { first, last, step });
        step = step.checked_mul(count)?.checked_next_multiple_of(8).filter(|it| *it <= MOST_BITS)?;
    }
    dimensions.reverse();
    (!dimensions.is_empty()).then(|| dimensions.into())
}

impl Layout {
    /// The first field of a name in lower case.
    fn field(&self, name: &str) -> Option<&Placed> {
        let of = |it: u32| self.fields.get(it as usize);
        let at = self.by_name.partition_point(|it| of(*it).is_some_and(|it| it.name.as_str() < name));
        self.by_name.get(at).and_then(|it| of(*it)).filter(|it| it.name == name)
    }

    /// The place of a field: `poids`, `motor.speed[3]`. Neither blanks nor case matter.
    pub fn place(&self, path: &str) -> Option<Place> {
        let mut rest = path;
        let mut layout = self;
        let mut place =
            Place { path: path.to_owned(), start: 0, bits: 0, ty: None, section: Section::Static, anchor: 0, of: None };
        for depth in 0.. {
            let end = rest.find(['.', '[']).unwrap_or(rest.len());
            let (name, behind) = rest.split_at_checked(end)?;
            let name = name.trim_matches(['#', '"', ' ']).to_lowercase();
            let field = layout.field(&name)?;
            place.start += field.start;
            place.anchor = field.anchor;
            if depth == 0 {
                place.section = field.section;
            }
            let mut shape = &field.shape;
            rest = behind.trim_start();
            if let Some(indices) = rest.strip_prefix('[') {
                let (indices, behind) = indices.split_once(']')?;
                let Shape::Array(dimensions, of) = shape else { return None };
                let mut given = indices.split(',');
                for it in dimensions {
                    let index: i32 = given.next()?.trim().parse().ok()?;
                    let from_first = u32::try_from(i64::from(index) - i64::from(it.first)).ok()?;
                    if index > it.last {
                        return None;
                    }
                    place.start = place.start.checked_add(from_first.checked_mul(it.step)?)?;
                }
                if given.next().is_some() {
                    return None;
                }
                (shape, rest) = (of, behind.trim_start());
            }
            place.bits = shape.bits()?;
            match (shape, rest.strip_prefix('.')) {
                (Shape::Leaf(it), None) if rest.is_empty() => {
                    place.ty = Some(*it);
                    return Some(place);
                }
                (_, None) if rest.is_empty() => return Some(place),
                (Shape::Struct(inner, name), Some(behind)) => {
                    place.of = name.clone().or(place.of);
                    (layout, rest) = (inner, behind);
                }
                _ => return None,
            }
        }
        None
    }

    /// The fields of what lies behind a path; the indices of arrays are not looked at. An empty path is the whole.
    pub fn inside(&self, path: &str) -> Option<&Self> {
        let mut layout = self;
        for name in path.split('.').filter(|it| !it.is_empty()) {
            let name = name.split('[').next().unwrap_or(name).trim_matches(['#', '"', ' ']).to_lowercase();
            let mut shape = &layout.fields.iter().find(|it| it.name == name)?.shape;
            while let Shape::Array(_, of) = shape {
                shape = of;
            }
            let Shape::Struct(inner, _) = shape else { return None };
            layout = inner;
        }
        Some(layout)
    }

    /// What lies at a bit: the innermost field. `None` in a gap and behind the end.
    pub fn at(&self, bit: u32) -> Option<Place> {
        let mut layout = self;
        let mut place =
            Place { path: String::new(), start: 0, bits: 0, ty: None, section: Section::Static, anchor: 0, of: None };
        for depth in 0.. {
            let within = bit - place.start;
            let before = layout.fields.partition_point(|it| it.start <= within);
            let field = layout.fields.get(before.checked_sub(1)?)?;
            place.path.push_str(if depth == 0 { "" } else { "." });
            place.path.push_str(&field.name);
            place.anchor = field.anchor;
            if depth == 0 {
                place.section = field.section;
            }
            place.start += field.start;
            let mut shape = &field.shape;
            if let Shape::Array(dimensions, of) = shape {
                let mut indices = Vec::with_capacity(dimensions.len());
                for it in dimensions {
                    // Elements may be structures without fields.
                    let index = (bit - place.start).checked_div(it.step)?;
                    let count = u32::try_from(i64::from(it.last) - i64::from(it.first) + 1).ok()?;
                    if index >= count {
                        return None;
                    }
                    place.start += index * it.step;
                    indices.push(format_smolstr!("{}", i64::from(it.first) + i64::from(index)));
                }
                place.path.push_str(&format!("[{}]", indices.join(",")));
                shape = of;
            }
            place.bits = shape.bits()?;
            if bit - place.start >= place.bits {
                return None;
            }
            match shape {
                Shape::Struct(inner, name) => {
                    place.of = name.clone().or(place.of);
                    layout = inner;
                }
                Shape::Leaf(it) => {
                    place.ty = Some(*it);
                    return Some(place);
                }
                // An array of arrays is one of several dimensions.
                Shape::Text(_) | Shape::Array(..) => return Some(place),
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn field(name: &str, ty: DataType) -> Field {
        Field { name: name.into(), section: Section::Static, ty, anchor: 0 }
    }

    fn simple(name: &str, ty: &str) -> Field {
        field(name, DataType::parse(ty))
    }

    fn offsets(layout: &Layout) -> Vec<String> {
        layout.fields.iter().map(|it| format!("{}.{} {}", it.start / 8, it.start % 8, it.name)).collect()
    }

    #[test]
    fn nothing_lies_in_an_array_of_nothing() {
        let empty = DataType::Struct(Box::default());
        let layout =
            Layouts::of_fields(&[simple("a", "WORD"), field("b", DataType::Array([(1, 5)].into(), empty.into()))]);
        assert_eq!(layout.bits, Some(16));
        assert_eq!(layout.at(8).map(|it| it.path), Some("a".to_owned()));
        assert_eq!((layout.at(16), layout.at(100)), (None, None));
    }

    #[test]
    fn the_table_of_the_manual() {
        // S7:1059-1069. The manual prints 19.0 for the last field: the odd address that a word never has.
        let fields = [
            ("mot1", "WORD"),
            ("poids", "WORD"),
            ("numero1", "INT"),
            ("zone", "DWORD"),
            ("passage", "DINT"),
            ("mesure1", "REAL"),
            ("bit2", "BOOL"),
            ("byte1", "BYTE"),
            ("durée", "S5TIME"),
        ];
        let layout = Layouts::of_fields(&fields.map(|it| simple(it.0, it.1)));
        let expected = [
            "0.0 mot1",
            "2.0 poids",
            "4.0 numero1",
            "6.0 zone",
            "10.0 passage",
            "14.0 mesure1",
            "18.0 bit2",
            "19.0 byte1",
            "20.0 durée",
        ];
        assert_eq!(offsets(&layout), expected, "the manual gives the REAL two bytes, and the S5TIME an odd address");
        assert_eq!(layout.bits, Some(22 * 8));
        assert_eq!(layout.place("Poids").map(|it| (it.start, it.bits)), Some((16, 16)));
    }

    #[test]
    fn bits_bytes_and_what_is_even() {
        let fields =
            ["BOOL", "BOOL", "BYTE", "BOOL", "INT", "CHAR", "STRING[3]", "BYTE", "DT", "ANY", "POINTER", "BOOL"];
        let names: Vec<String> = (0..fields.len()).map(|it| format!("f{it}")).collect();
        let fields: Vec<Field> = names.iter().zip(fields).map(|(name, ty)| simple(name, ty)).collect();
        let layout = Layouts::of_fields(&fields);
        let starts: Vec<u32> = layout.fields.iter().map(|it| it.start).collect();
        assert_eq!(starts, [0, 1, 8, 16, 32, 48, 64, 104, 112, 176, 256, 304]);
        assert_eq!(layout.bits, Some(320));
    }

    #[test]
    fn arrays_and_structures() {
        let array = |bounds: &[(i32, i32)], of: DataType| DataType::Array(bounds.into(), Box::new(of));
        let bool = || DataType::parse("BOOL");
        let point = DataType::Struct([simple("x", "INT"), simple("ok", "BOOL")].into());
        let layout = Layouts::of_fields(&[
            field("start", bool()),
            field("bits", array(&[(0, 9)], bool())),
            field("grid", array(&[(1, 2), (1, 3)], bool())),
            field("bytes", array(&[(1, 3)], DataType::parse("BYTE"))),
            field("points", array(&[(1, 4)], point)),
            field("names", array(&[(0, 1)], DataType::parse("STRING[3]"))),
            field("end", bool()),
        ]);
        let place = |path: &str| layout.place(path).map(|it| (it.start / 8, it.start % 8, it.bits));
        assert_eq!(place("bits[9]"), Some((3, 1, 1)));
        assert_eq!(place("bits[10]"), None);
        assert_eq!(place("grid[2,3]"), Some((5, 2, 1)), "a row of bits begins with a byte");
        assert_eq!(place("bytes[3]"), Some((8, 0, 8)));
        assert_eq!(place("points[2].ok"), Some((16, 0, 1)));
        assert_eq!(place("names[1]"), Some((32, 0, 40)));
        assert_eq!(place("end"), Some((38, 0, 1)));
        assert_eq!(layout.at(16 * 8).map(|it| it.path).as_deref(), Some("points[2].ok"));
        assert_eq!(layout.at(16 * 8 + 1), None, "the rest of the word is filled");
        assert_eq!(layout.at(9 * 8), None);
    }

    #[test]
    fn interfaces_and_named_types() {
        let udt = BlockName::Number(BlockKind::Udt, 1);
        let valve = DataType::Struct([simple("open", "BOOL"), simple("closed", "BOOL")].into());
        let section = |section, it: Field| Field { section, ..it };
        let fb = DataType::Struct(
            [
                section(Section::Input, simple("go", "BOOL")),
                section(Section::Output, simple("busy", "BOOL")),
                section(Section::InOut, simple("text", "STRING[20]")),
                section(Section::InOut, simple("bit", "BOOL")),
                section(Section::Temp, simple("t", "DINT")),
                section(Section::Static, field("valve", DataType::Named(udt.clone()))),
                section(Section::Static, simple("n", "INT")),
            ]
            .into(),
        );
        let (fb1, db1) = (BlockName::Number(BlockKind::Fb, 1), BlockName::Number(BlockKind::Db, 1));
        let own = BlockName::Number(BlockKind::Udt, 2);
        let endless = DataType::Struct([field("a", DataType::Named(own.clone()))].into());
        let instance = DataType::Named(fb1.clone());
        let layouts = Layouts::new([(&udt, &valve), (&fb1, &fb), (&db1, &instance), (&own, &endless)]);
        let layout = layouts.of(&db1).unwrap();
        assert_eq!(offsets(layout), ["0.0 go", "2.0 busy", "4.0 text", "10.0 bit", "12.0 valve", "14.0 n"]);
        assert_eq!(layout.place("valve.closed").map(|it| (it.start, it.of)), Some((97, Some(udt))));
        assert_eq!(layouts.of(&own).and_then(|it| it.bits), None, "it holds itself");
        let unknown = Layouts::of_fields(&[simple("a", "INT"), simple("b", "UDT 9"), simple("c", "INT")]);
        assert_eq!((unknown.fields.len(), unknown.bits), (1, None));
    }

    /// The same by counting bytes one after the other, as one does by hand: the addresses of all leaves, then the end.
    fn by_hand(ty: &DataType, path: &str, at: &mut (u32, u32), out: &mut Vec<(String, u32)>) {
        let whole_byte = |at: &mut (u32, u32)| {
            if at.1 > 0 {
                *at = (at.0 + 1, 0);
            }
        };
        let even = |at: &mut (u32, u32)| {
            whole_byte(at);
            at.0 += at.0 % 2;
        };
        match ty {
            DataType::Elementary(Elementary::Bool) => {
                out.push((path.to_owned(), at.0 * 8 + at.1));
                *at = if at.1 == 7 { (at.0 + 1, 0) } else { (at.0, at.1 + 1) };
            }
            DataType::Elementary(it) => {
                if it.bits() == 8 {
                    whole_byte(at)
                } else {
                    even(at)
                }
                out.push((path.to_owned(), at.0 * 8));
                at.0 += it.bits() / 8;
            }
            DataType::Text(length) => {
                even(at);
                out.push((path.to_owned(), at.0 * 8));
                at.0 += length + 2;
            }
            DataType::Array(bounds, of) => {
                even(at);
                let mut indices: Vec<i32> = bounds.iter().map(|it| it.0).collect();
                'all: loop {
                    let text: Vec<String> = indices.iter().map(ToString::to_string).collect();
                    by_hand(of, &format!("{path}[{}]", text.join(",")), at, out);
                    for dimension in (0..bounds.len()).rev() {
                        if indices[dimension] < bounds[dimension].1 {
                            indices[dimension] += 1;
                            continue 'all;
                        }
                        indices[dimension] = bounds[dimension].0;
                        whole_byte(at);
                    }
                    break;
                }
                even(at);
            }
            DataType::Struct(fields) => {
                even(at);
                for field in fields {
                    let path = if path.is_empty() { field.name.to_string() } else { format!("{path}.{}", field.name) };
                    by_hand(&field.ty, &path, at, out);
                }
                even(at);
            }
            DataType::Named(_) | DataType::Unknown => {}
        }
    }

    fn any_type() -> impl Strategy<Value = DataType> {
        let leaf = prop_oneof![
            (0..Elementary::ALL.len()).prop_map(|it| DataType::Elementary(Elementary::ALL[it].0)),
            Just(DataType::Elementary(Elementary::Bool)),
            (0..9_u32).prop_map(DataType::Text),
        ];
        leaf.prop_recursive(3, 24, 5, |inner| {
            let named = |list: Vec<DataType>| {
                DataType::Struct(list.into_iter().enumerate().map(|(at, ty)| field(&format!("f{at}"), ty)).collect())
            };
            let is_no_array = |it: &DataType| !matches!(it, DataType::Array(..));
            prop_oneof![
                prop::collection::vec(inner.clone(), 1..5).prop_map(named),
                (
                    prop::collection::vec((-2..3_i32, 0..4_i32), 1..3),
                    inner.prop_filter("of several dimensions", is_no_array)
                )
                    .prop_map(|(bounds, of)| {
                        let bounds: Vec<(i32, i32)> =
                            bounds.into_iter().map(|(first, more)| (first, first + more)).collect();
                        DataType::Array(bounds.into(), Box::new(of))
                    }),
            ]
        })
    }

    proptest! {
        #[test]
        fn offsets_are_those_by_hand(types in prop::collection::vec(any_type(), 1..6)) {
            let fields: Vec<Field> = types.into_iter().enumerate().map(|(at, ty)| field(&format!("g{at}"), ty)).collect();
            let layout = Layouts::of_fields(&fields);
            let (mut at, mut expected) = ((0, 0), Vec::new());
            by_hand(&DataType::Struct(fields.into()), "", &mut at, &mut expected);
            prop_assert_eq!(layout.bits, Some(at.0 * 8));
            for (path, start) in expected {
                let place = layout.place(&path);
                prop_assert_eq!(place.as_ref().map(|it| it.start), Some(start), "{}", path);
                prop_assert_eq!(layout.at(start).map(|it| it.path), Some(path));
            }
        }
    }
}
