//! What a network of PL7-2 is made of, as the tables of times and sizes tell elements apart (PL72:1915-1974).

use std::ops::Range;

use crate::target::pl72::Element;

/// When the code around a network is scanned.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum CodeKind {
    /// In each scan of its task.
    Section,
    /// While a step is active (PL72:1434).
    Action,
    /// While a step before the transition is active (PL72:1487).
    Receptivity,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Network {
    pub kind: CodeKind,
    /// Number of the piece of code that it belongs to: a section, an action, a receptivity.
    pub piece: u32,
    /// Elements, each with the quantity that its time grows with; 0 where it does not, or where no text of the program tells.
    pub elements: Vec<(Element, u32)>,
    /// Elements that the tables do not have, or that are not understood.
    pub unlisted: u32,
    /// Characters of its comment.
    pub comment: u32,
    /// Its own, as indexes into those of the unit.
    pub labels: Range<u32>,
    pub jumps: Range<u32>,
}
