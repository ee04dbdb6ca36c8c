//! Symbols: the names that a program gives to its objects, as its files of variables declare them.
//!
//! PL7 writes a symbol's first letter in upper case and the others in lower case, whatever was typed (PL7:1200-1202), so
//! names are compared by their [`key`].

use rowan::TextRange;
use smol_str::SmolStr;

use super::object::Object;

/// One declaration: `Pump AT %M0 : EBOOL := TRUE (*comment*);`, or an instance of a DFB, which has no address.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Symbol {
    /// As written.
    pub name: SmolStr,
    /// What the address names. Its text is the address. `None` without an address, or with one that is none.
    pub object: Option<Object>,
    /// The type as written, blanks removed; empty when the declaration has none.
    pub ty: SmolStr,
    /// The initial value as written.
    pub initial: Option<SmolStr>,
    /// The comment without its delimiters and the blanks around it.
    pub comment: Option<SmolStr>,
    /// Place of the name, an index into the anchors of the unit's model.
    pub anchor: u32,
}

/// A comment whose length the vendor limits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Remark {
    pub kind: RemarkKind,
    /// Characters between the delimiters, blanks around the text not counted.
    pub characters: u32,
    pub range: TextRange,
}

impl Remark {
    /// Measures a comment, of which `text` is all with its delimiters.
    pub fn new(kind: RemarkKind, text: &str, range: TextRange) -> Self {
        let characters = u32::try_from(Self::inner(text).chars().count()).unwrap_or(u32::MAX);
        Self { kind, characters, range }
    }

    /// What stands between the delimiters of a comment, or of a value in quotes, without the blanks around it.
    pub fn inner(text: &str) -> &str {
        let inner = ["(*", "'"].iter().find_map(|it| text.strip_prefix(it)).unwrap_or(text);
        ["*)", "'"].iter().find_map(|it| inner.strip_suffix(it)).unwrap_or(inner).trim()
    }
}

/// What a comment belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum RemarkKind {
    Symbol,
    /// A section or subroutine, in the header of its source unit.
    Module,
    /// A parameter or variable of a DFB.
    Item,
    /// A network of PL7-2.
    Network,
}

/// What makes two spellings the same symbol.
pub fn key(name: &str) -> SmolStr {
    name.to_lowercase().into()
}
