//! The words of the languages, by what they are: for editors that colour a text without reading it.

use super::pl7::{chart, functions, instructions, ladder_words};
use super::{Mnemonics, awl, pl7, step5};

/// Words of one kind, in upper case and in alphabetical order; case does not matter in any language.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct List {
    pub name: &'static str,
    pub words: Vec<&'static str>,
}

/// The words of all languages.
pub fn lists() -> Vec<List> {
    let german_and_english = [Mnemonics::German, Mnemonics::English];
    let functions = functions::all().iter().flat_map(|it| std::iter::once(it.name).chain(it.also.iter().copied()));
    vec![
        list("pl7-keywords", pl7::keywords()),
        list("pl7-il-instructions", instructions::all().iter().map(|it| it.mnemonic)),
        list("pl7-functions", functions),
        list("pl7-ladder", ladder_words::all().iter().map(|it| it.text)),
        list("pl7-charts", chart::words()),
        list("pl7-dfb", pl7::dfb_words()),
        list("pl7-2-operations", pl7::operation_codes()),
        list("step7-keywords", awl::keywords()),
        list("step7-instructions", german_and_english.into_iter().flat_map(awl::instruction::all)),
        list("step5-instructions", german_and_english.into_iter().flat_map(step5::instruction::all)),
    ]
}

fn list(name: &'static str, words: impl Iterator<Item = &'static str>) -> List {
    let mut words: Vec<&'static str> = words.collect();
    words.sort_unstable();
    words.dedup();
    List { name, words }
}
