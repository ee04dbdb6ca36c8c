//! What readers of addresses share: a cursor over the text, its numbers, and an object before it has a text.

use crate::target::Range;
use std::borrow::Cow;
use std::ops::RangeInclusive;

use smol_str::SmolStr;

use super::{AddressError, AddressErrorKind, Area, Class, Footprint, Object, Rights, Type};

/// A suggestion for an address longer than any valid one helps nobody.
pub(super) const LONGEST_SUGGESTION_SOURCE: usize = 40;

/// An object before it has a text.
#[derive(Debug, Clone)]
pub(super) struct Place {
    pub(super) class: Class,
    pub(super) ty: Type,
    pub(super) area: Area,
    pub(super) start: u32,
    pub(super) rights: Rights,
    pub(super) extracted: bool,
    /// Whether a length may follow, and how many elements there are from this one to the last.
    pub(super) room: Option<u32>,
}

impl Place {
    pub(super) fn new(class: Class, ty: Type, area: Area, start: u32, rights: Rights) -> Self {
        Self { class, ty, area, start, rights, extracted: false, room: None }
    }

    pub(super) fn with_room(self, room: u32) -> Self {
        Self { room: Some(room), ..self }
    }

    /// `block_bits`: what a function block as a whole covers, which is all items that any block has.
    pub(super) fn object(self, text: SmolStr, block_bits: u32) -> Object {
        let bits = self.ty.bits().unwrap_or(if self.class == Class::Block { block_bits } else { 1 });
        Object {
            text,
            class: self.class,
            ty: self.ty,
            footprint: Footprint::new(self.area, self.start, bits),
            rights: self.rights,
            extracted: self.extracted,
            indexed: false,
        }
    }
}

/// Digits and their value, which is `u32::MAX` when it does not fit.
#[derive(Clone, Copy)]
pub(super) struct Number<'a> {
    pub(super) text: &'a str,
    pub(super) value: u32,
}

impl Number<'_> {
    pub(super) fn within(self, what: &str, range: RangeInclusive<u32>, source: &str) -> Result<u32, AddressError> {
        if range.contains(&self.value) {
            return Ok(self.value);
        }
        Err(self.missing(what, &format!("from {} to {} ({source})", range.start(), range.end())))
    }

    /// As [`Self::within`], of a range of the manual.
    pub(super) fn of(self, what: &str, range: Range) -> Result<u32, AddressError> {
        self.within(what, range.first..=range.last, range.source)
    }

    /// `instead`: what exists.
    pub(super) fn missing(self, what: &str, instead: &str) -> AddressError {
        // Digits are ASCII, so any cut is a character boundary.
        let shown = self.text.get(..12).map_or_else(|| self.text.to_owned(), |head| format!("{head}..."));
        out_of_range(format!("{what} {shown} does not exist: {instead}"))
    }
}

pub(super) struct Cursor<'a> {
    pub(super) rest: &'a str,
}

impl<'a> Cursor<'a> {
    /// Whether an ASCII character is next.
    pub(super) fn at(&self, char: char) -> bool {
        self.rest.as_bytes().first().is_some_and(|it| char::from(*it) == char)
    }

    pub(super) fn eat(&mut self, char: char) -> bool {
        let found = self.at(char);
        if found {
            self.rest = self.rest.get(1..).unwrap_or_default();
        }
        found
    }

    pub(super) fn need(&mut self, char: char) -> Result<(), AddressError> {
        if self.eat(char) { Ok(()) } else { Err(malformed(format!("`{char}` is missing"))) }
    }

    pub(super) fn take_while(&mut self, accept: impl Fn(u8) -> bool) -> &'a str {
        let end = self.rest.bytes().position(|it| !accept(it)).unwrap_or(self.rest.len());
        let (head, rest) = self.rest.split_at(end);
        self.rest = rest;
        head
    }

    pub(super) fn letters(&mut self) -> &'a str {
        self.take_while(|it| it.is_ascii_uppercase())
    }

    pub(super) fn number(&mut self) -> Option<Number<'a>> {
        let text = self.take_while(|it| it.is_ascii_digit());
        if text.is_empty() {
            return None;
        }
        let value = text.bytes().fold(0u32, |sum, it| sum.saturating_mul(10).saturating_add(u32::from(it - b'0')));
        Some(Number { text, value })
    }

    pub(super) fn need_number(&mut self, what: &str) -> Result<Number<'a>, AddressError> {
        self.number().ok_or_else(|| malformed(format!("the {what} is missing")))
    }
}

/// Nearly always it is written so.
pub(super) fn upper_case(address: &str) -> Cow<'_, str> {
    if address.bytes().any(|it| it.is_ascii_lowercase()) {
        Cow::Owned(address.to_ascii_uppercase())
    } else {
        Cow::Borrowed(address)
    }
}

pub(super) fn malformed(message: impl Into<String>) -> AddressError {
    AddressError { kind: AddressErrorKind::Malformed, message: message.into(), suggestion: None }
}

pub(super) fn out_of_range(message: String) -> AddressError {
    AddressError { kind: AddressErrorKind::OutOfRange, message, suggestion: None }
}
