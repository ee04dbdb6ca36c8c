//! Charts as text: pages of PL7 Grafcet in the exchange form, and sequential function charts of IEC 61131-3.
//!
//! One grammar reads both, for they share their words. The vendor has published no grammar of the exchange form, only
//! an example: what is read beyond that example is marked in [`word`], where every spelling stands.

pub mod ast;
mod grammar;
pub(super) mod word;

/// Every spelling of the words of a chart.
pub(in crate::syntax) fn words() -> impl Iterator<Item = &'static str> {
    word::WORDS.iter().map(|it| it.0)
}

pub(super) use grammar::stops;

#[cfg(test)]
mod tests;
