//! Bytes to text, text to units.
//!
//! A file is found by [`walk`], turned into text by [`decode`], recognised by [`detect`] and cut into units by
//! [`split`]; [`line_index`] maps offsets of the text back to what an editor shows.
//!
//! **Invariant:** only [`walk`] touches the file system; everything else is a function of bytes or text.
//! **Invariant:** nothing here fails: bytes of every kind have a text, texts of every kind have units, and the units
//! tile the text.

mod dbf;
pub mod decode;
pub mod detect;
pub(crate) mod edit;
mod heading;
pub mod line_index;
mod scan;
pub mod split;
pub mod stx;
pub mod symlist;
#[cfg(test)]
mod testing;
pub mod walk;

pub use heading::entity_from_address;
