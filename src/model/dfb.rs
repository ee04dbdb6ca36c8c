//! The interface of a DFB type: its parameters and variables (PL7:5350-5450).
//!
//! It holds no position: places are anchors, so that it may leave the unit.

use smol_str::SmolStr;

use super::object::Type;
use super::symbols::key;

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

    /// Whether a call gives the item an actual.
    pub fn is_parameter(self) -> bool {
        matches!(self, Self::Input | Self::InOut | Self::Output)
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
}

#[cfg(test)]
mod tests {
    use super::*;

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
