//! N001: a symbol that the vendor's tool does not take, or that two objects share.

use rustc_hash::FxHashMap;

use crate::analysis::Site;
use crate::analysis::facts::FactSymbol;
use crate::lint::{ProgramCx, Sink};
use crate::model::entity::Family;
use crate::model::symbols::key;
use crate::syntax::pl7::is_reserved;
use crate::target::pl7::SYMBOL_LENGTH;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    if cx.program.family == Family::Step7 {
        repeated(cx, sink);
    }
    let mut seen: FxHashMap<_, (Site, Option<&str>)> = FxHashMap::default();
    for (unit, facts) in (0..).zip(&cx.program.units) {
        for symbol in &facts.symbols {
            let site = Site { unit, anchor: symbol.anchor };
            if let Some(flaw) = flaw(&symbol.name).filter(|_| cx.program.family == Family::Pl7) {
                sink.report(site, format!("the symbol `{}` {flaw}", symbol.name));
            }
            let address = symbol.object.as_ref().map(|it| it.text.as_str());
            let (first, before) = *seen.entry(key(&symbol.name)).or_insert((site, address));
            let differ = match (before, address) {
                (Some(a), Some(b)) => !a.eq_ignore_ascii_case(b),
                (None, None) => false,
                _ => true,
            };
            if differ {
                let name = |it: Option<&str>| it.map_or("an object without address".to_owned(), |it| format!("`{it}`"));
                let (one, other) = (name(before), name(address));
                sink.report(site, format!("the symbol `{}` is given to two objects, {one} and {other}", symbol.name))
                    .label("again here")
                    .related(first, "first here");
            }
        }
    }
}

/// Rows of one table that repeat a symbol or an address: STEP 7 marks both, and takes neither.
fn repeated(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    for (unit, facts) in (0..).zip(&cx.program.units) {
        let mut names: FxHashMap<_, &FactSymbol> = FxHashMap::default();
        let mut places: FxHashMap<_, &FactSymbol> = FxHashMap::default();
        for symbol in &facts.symbols {
            let site = |it: &FactSymbol| Site { unit, anchor: it.anchor };
            let Some(object) = &symbol.object else { continue };
            let before = *names.entry(key(&symbol.name)).or_insert(symbol);
            let is_again = !std::ptr::eq(before, symbol);
            let is_same = |it: &FactSymbol| it.object.as_ref().is_some_and(|it| it.footprint == object.footprint);
            if is_again && is_same(before) {
                sink.report(site(symbol), format!("the symbol `{}` stands twice in this table", symbol.name))
                    .label("again here")
                    .related(site(before), "first here");
            }
            let first = *places.entry((&object.footprint, object.ty)).or_insert(symbol);
            if !is_again && !std::ptr::eq(first, symbol) {
                let message = format!("`{}` has two symbols, `{}` and `{}`", object.text, first.name, symbol.name);
                sink.report(site(symbol), message).label("again here").related(site(first), "first here");
            }
        }
    }
}

/// Why a name is no symbol, as the end of a sentence. PL7:1198-1216.
fn flaw(name: &str) -> Option<String> {
    let length = name.chars().count();
    if let Some(wrong) = name.chars().find(|&it| !is_allowed(it)) {
        return Some(format!("holds `{}`: letters, digits and underscores are allowed", wrong.escape_debug()));
    }
    if name.starts_with(|it: char| it.is_ascii_digit()) {
        Some("begins with a digit instead of a letter".to_owned())
    } else if name.starts_with('_') || name.ends_with('_') {
        Some("begins or ends with an underscore".to_owned())
    } else if length > SYMBOL_LENGTH.value as usize {
        Some(format!("has {length} characters, {} are allowed", SYMBOL_LENGTH.value))
    } else if is_reserved(name) {
        Some("is a word of the language".to_owned())
    } else {
        None
    }
}

/// The table of PL7:1211-1214. It leaves out two lower-case letters (`ñ`, `ò`) whose upper-case forms it has.
fn is_allowed(it: char) -> bool {
    it.is_ascii_alphanumeric() || it == '_' || matches!(it, 'À'..='Ö' | 'Ø'..='Þ' | 'à'..='ö' | 'ø'..='ÿ')
}
