//! The interface of a DFB type: its parameters and variables (PL7:5350-5450).
//!
//! It holds no position: places are anchors, so that it may leave the unit.

use smol_str::SmolStr;

use super::object::Type;
use super::symbols::key;
use super::unit::Slot;

#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Interface {
    /// Place of the name; that of the heading where it has none.
    pub anchor: u32,
    /// In the order of the declarations.
    pub items: Vec<Item>,
}

/// One parameter or variable.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Item {
    /// As written.
    pub name: SmolStr,
    pub role: Role,
    pub ty: ItemType,
    /// Initial value as written, and its place.
    pub initial: Option<(SmolStr, u32)>,
    /// Place of the name.
    pub anchor: u32,
    /// Place of the type; that of the name where there is none.
    pub ty_anchor: u32,
}

/// How code inside and outside of the DFB sees an item (PL7:5409-5440).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Role {
    Input,
    InOut,
    Output,
    Public,
    Private,
}

impl Role {
    /// Of the word that begins the part of the interface.
    pub fn of_section(word: &str) -> Option<Self> {
        Some(match word.to_ascii_uppercase().as_str() {
            "VAR_INPUT" => Self::Input,
            "VAR_IN_OUT" => Self::InOut,
            "VAR_OUTPUT" => Self::Output,
            "VAR_PUBLIC" => Self::Public,
            "VAR_PRIVATE" | "VAR" => Self::Private,
            _ => return None,
        })
    }

    pub fn describe(self) -> &'static str {
        match self {
            Self::Input => "input",
            Self::InOut => "in/out parameter",
            Self::Output => "output",
            Self::Public => "public variable",
            Self::Private => "private variable",
        }
    }

    /// Whether the object that a call gives must be one that can be written (PL7:5660-5661).
    pub fn is_written(self) -> bool {
        matches!(self, Self::InOut | Self::Output)
    }
}

/// Type of an item (PL7:5376-5391).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ItemType {
    /// Keeps no former state.
    Bool,
    /// Knows its edges.
    Ebool,
    Word,
    Double,
    Real,
    /// `AR_X`, `AR_W`, `AR_D`, `AR_R`: the type of its elements, and how many.
    Array(Element, Option<u32>),
    Text(Option<u32>),
    Unknown,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Element {
    Bit,
    Word,
    Double,
    Real,
}

impl ItemType {
    /// Reads a type without the blanks in it: `EBOOL`, `AR_W:20`, `AR_W[20]`, `STRING[8]`.
    pub fn parse(text: &str) -> Self {
        let end = text.find([':', '[', '(']).unwrap_or(text.len());
        let (word, length) = text.split_at_checked(end).unwrap_or((text, ""));
        let length = length.trim_matches([':', '[', ']', '(', ')']).parse().ok();
        match word.to_ascii_uppercase().as_str() {
            "BOOL" => Self::Bool,
            "EBOOL" => Self::Ebool,
            "WORD" | "INT" => Self::Word,
            "DWORD" | "DINT" => Self::Double,
            "REAL" => Self::Real,
            "AR_X" => Self::Array(Element::Bit, length),
            "AR_W" => Self::Array(Element::Word, length),
            "AR_D" => Self::Array(Element::Double, length),
            "AR_R" => Self::Array(Element::Real, length),
            "STRING" => Self::Text(length),
            _ => Self::Unknown,
        }
    }

    pub fn is_bit(self) -> bool {
        matches!(self, Self::Bool | Self::Ebool)
    }

    /// The word of the type.
    pub fn describe(self) -> &'static str {
        match self {
            Self::Bool => "BOOL",
            Self::Ebool => "EBOOL",
            Self::Word => "WORD",
            Self::Double => "DWORD",
            Self::Real => "REAL",
            Self::Array(Element::Bit, _) => "AR_X",
            Self::Array(Element::Word, _) => "AR_W",
            Self::Array(Element::Double, _) => "AR_D",
            Self::Array(Element::Real, _) => "AR_R",
            Self::Text(_) => "STRING",
            Self::Unknown => "another type",
        }
    }

    /// Whether an object of that type may be the actual of a parameter (PL7:5589), whatever the lengths of tables. An
    /// object or item of unknown type may.
    pub fn takes(self, ty: Type) -> bool {
        match (self, ty) {
            // An address has no single bytes: those of a program are parts of strings.
            (Self::Unknown, _) | (_, Type::Unknown | Type::Byte) => true,
            (Self::Bool | Self::Ebool, Type::Bool) | (Self::Word, Type::Word) => true,
            (Self::Double, Type::Double) | (Self::Real, Type::Float) | (Self::Text(_), Type::Text(_)) => true,
            (Self::Array(Element::Bit, _), Type::BitTable(_)) => true,
            (Self::Array(Element::Word, _), Type::WordTable(_)) => true,
            (Self::Array(Element::Double, _), Type::DoubleTable(_)) => true,
            (Self::Array(Element::Real, _), Type::FloatTable(_)) => true,
            _ => false,
        }
    }

    /// Whether the item is a table: the manual counts strings among them (PL7:5388-5391).
    pub fn is_array(self) -> bool {
        matches!(self, Self::Array(..) | Self::Text(_))
    }

    /// The length that the declaration gives, of a table.
    pub fn length(self) -> Option<u32> {
        match self {
            Self::Array(_, length) | Self::Text(length) => length,
            _ => None,
        }
    }

    /// What the code makes of it. A table without a length is one of unknown length.
    pub fn to_type(self) -> Type {
        match self {
            Self::Bool | Self::Ebool => Type::Bool,
            Self::Word => Type::Word,
            Self::Double => Type::Double,
            Self::Real => Type::Float,
            Self::Array(Element::Bit, Some(length)) => Type::BitTable(length),
            Self::Array(Element::Word, Some(length)) => Type::WordTable(length),
            Self::Array(Element::Double, Some(length)) => Type::DoubleTable(length),
            Self::Array(Element::Real, Some(length)) => Type::FloatTable(length),
            Self::Text(Some(length)) => Type::Text(length),
            Self::Array(_, None) | Self::Text(None) | Self::Unknown => Type::Unknown,
        }
    }

    /// What an element of it is, or the item itself.
    pub fn element(self) -> Type {
        match self {
            Self::Array(Element::Bit, _) => Type::Bool,
            Self::Array(Element::Word, _) => Type::Word,
            Self::Array(Element::Double, _) => Type::Double,
            Self::Array(Element::Real, _) => Type::Float,
            Self::Text(_) => Type::Byte,
            other => other.to_type(),
        }
    }
}

impl Interface {
    /// The first item of that name, in any case.
    pub fn item(&self, name: &str) -> Option<&Item> {
        let name = key(name);
        self.items.iter().find(|it| key(&it.name) == name)
    }

    pub fn count(&self, role: Role) -> usize {
        self.items.iter().filter(|it| it.role == role).count()
    }

    /// What a call gives actuals for, in its order: inputs, in/outs, outputs (PL7:5650).
    pub fn parameters(&self) -> impl Iterator<Item = &Item> {
        let of = |role| self.items.iter().filter(move |it| it.role == role);
        of(Role::Input).chain(of(Role::InOut)).chain(of(Role::Output))
    }

    /// Index among [`Self::parameters`] of the one that an actual is for; `None` where the DFB has none.
    ///
    /// A block in a rung has its inputs on the left and its outputs on the right, one a row; its in/outs go through it
    /// below both: therefore they count with the inputs as well as with the outputs (PL7:5415-5419).
    pub fn position(&self, slot: Slot) -> Option<u32> {
        let count = |role| u32::try_from(self.count(role)).unwrap_or(u32::MAX);
        let (inputs, in_outs, outputs) = (count(Role::Input), count(Role::InOut), count(Role::Output));
        let in_out = |row: u32| {
            let row = row.checked_sub(inputs.max(outputs)).filter(|it| *it < in_outs)?;
            Some(inputs + row)
        };
        match slot {
            Slot::Position(at) => (at < inputs + in_outs + outputs).then_some(at),
            Slot::Left(row) if row < inputs => Some(row),
            Slot::Right(row) if row < outputs => Some(inputs + in_outs + row),
            Slot::Left(row) | Slot::Right(row) => in_out(row),
        }
    }

    /// The parameter that an actual is for.
    pub fn parameter(&self, slot: Slot) -> Option<&Item> {
        self.parameters().nth(self.position(slot)? as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pins_of_a_block() {
        let item = |name: &str, role| Item {
            name: name.into(),
            role,
            ty: ItemType::Word,
            initial: None,
            anchor: 0,
            ty_anchor: 0,
        };
        let items = vec![
            item("q0", Role::Output),
            item("i0", Role::Input),
            item("x0", Role::InOut),
            item("q1", Role::Output),
            item("q2", Role::Output),
            item("x1", Role::InOut),
            item("p", Role::Public),
        ];
        let interface = Interface { anchor: 0, items };
        let name = |slot| interface.parameter(slot).map(|it| it.name.as_str());
        assert_eq!(
            (0..7).map(|it| name(Slot::Left(it))).collect::<Vec<_>>(),
            [Some("i0"), None, None, Some("x0"), Some("x1"), None, None]
        );
        assert_eq!(
            (0..5).map(|it| name(Slot::Right(it))).collect::<Vec<_>>(),
            [Some("q0"), Some("q1"), Some("q2"), Some("x0"), Some("x1")]
        );
        assert_eq!(
            (name(Slot::Position(0)), name(Slot::Position(2)), name(Slot::Position(5))),
            (Some("i0"), Some("x1"), Some("q2"))
        );
        assert_eq!(name(Slot::Position(6)), None);
    }

    #[test]
    fn types() {
        for (text, expected) in [
            ("ebool", ItemType::Ebool),
            ("BOOL", ItemType::Bool),
            ("AR_W:20", ItemType::Array(Element::Word, Some(20))),
            ("AR_X[8]", ItemType::Array(Element::Bit, Some(8))),
            ("AR_R", ItemType::Array(Element::Real, None)),
            ("STRING:12", ItemType::Text(Some(12))),
            ("AR_W:99999999999", ItemType::Array(Element::Word, None)),
            ("Motor", ItemType::Unknown),
            ("", ItemType::Unknown),
        ] {
            assert_eq!(ItemType::parse(text), expected, "{text}");
        }
    }
}
