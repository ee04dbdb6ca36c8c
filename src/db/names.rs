//! The facts of a program's units with the names in them resolved, made from edit to edit.
//!
//! **Invariant:** what was known before saves time, and changes nothing.

use std::borrow::Cow;
use std::sync::Arc;

use crate::analysis::facts::UnitFacts;
use crate::analysis::fields::{Declaration, Declarations};
use crate::analysis::symbols::{self, SymbolTable};

/// Facts of the units of a program, in its order.
pub type Facts = Arc<[Arc<UnitFacts>]>;

#[derive(Debug)]
pub(super) struct Resolved {
    symbols: Arc<SymbolTable>,
    /// As the units tell them.
    told: Facts,
    /// With symbols resolved.
    named: Facts,
    fields: Option<Fields>,
}

/// What names mean that blocks of STEP 7 declare.
#[derive(Debug)]
struct Fields {
    of_units: Arc<[Arc<Declaration>]>,
    all: Arc<Declarations>,
    /// With symbols and fields resolved.
    placed: Facts,
}

impl Resolved {
    pub(super) fn new(told: Facts, symbols: Arc<SymbolTable>, has_fields: bool, old: Option<&Self>) -> Self {
        let symbols = match old {
            Some(old) if *old.symbols == *symbols => old.symbols.clone(),
            _ => symbols,
        };
        let old = old.map(|old| (old, Same::new(&old.told, &told)));
        let named = if symbols.is_empty() {
            told.clone()
        } else {
            let is_known = old.as_ref().is_some_and(|it| Arc::ptr_eq(&it.0.symbols, &symbols));
            let known = old.as_ref().map(|(old, same)| (&*old.named, same));
            each(&told, known, is_known, |it| symbols::resolve(&symbols, it))
        };
        let fields = has_fields.then(|| {
            let old = old.as_ref().and_then(|(old, _)| Some((old.fields.as_ref()?, Same::new(&old.named, &named))));
            Fields::new(&named, old)
        });
        Self { symbols, told, named, fields }
    }

    pub(super) fn facts(&self) -> &Facts {
        self.fields.as_ref().map_or(&self.named, |it| &it.placed)
    }

    pub(super) fn declarations(&self) -> Option<&Declarations> {
        self.fields.as_ref().map(|it| &*it.all)
    }
}

impl Fields {
    fn new(named: &Facts, old: Option<(&Self, Same)>) -> Self {
        let of_unit = |(at, facts): (usize, &Arc<UnitFacts>)| {
            let known = old.as_ref().and_then(|(old, same)| old.of_units.get(same.before(at)?));
            known.cloned().unwrap_or_else(|| Arc::new(Declaration::new(facts)))
        };
        let of_units: Arc<[Arc<Declaration>]> = named.iter().enumerate().map(of_unit).collect();
        let before = old.as_ref().map(|it| it.0);
        let all = match before.filter(|it| it.of_units == of_units) {
            Some(old) => old.all.clone(),
            None => Arc::new(Declarations::new(of_units.iter().map(AsRef::as_ref))),
        };
        let all = before.map(|it| &it.all).filter(|it| **it == all).cloned().unwrap_or(all);
        let is_known = before.is_some_and(|it| Arc::ptr_eq(&it.all, &all));
        let known = old.as_ref().map(|(old, same)| (&*old.placed, same));
        let placed = each(named, known, is_known, |it| all.resolve(Cow::Borrowed(it)));
        Self { of_units, all, placed }
    }
}

/// Resolves the facts of each unit. `known`: what came of it before; `is_valid`: what comes of the same facts is the same now.
fn each<'f>(
    facts: &'f Facts,
    known: Option<(&[Arc<UnitFacts>], &Same)>,
    is_valid: bool,
    resolve: impl Fn(&'f UnitFacts) -> Cow<'f, UnitFacts>,
) -> Facts {
    let of_unit = |(at, own): (usize, &'f Arc<UnitFacts>)| {
        let known = known.and_then(|(known, same)| known.get(same.before(at)?));
        match known.filter(|_| is_valid) {
            Some(known) => known.clone(),
            None => match resolve(own) {
                Cow::Borrowed(_) => own.clone(),
                Cow::Owned(new) => known.filter(|it| ***it == new).cloned().unwrap_or_else(|| Arc::new(new)),
            },
        }
    };
    let resolved: Vec<Arc<UnitFacts>> = facts.iter().enumerate().map(of_unit).collect();
    if resolved.iter().zip(&**facts).all(|(a, b)| Arc::ptr_eq(a, b)) { facts.clone() } else { resolved.into() }
}

/// Which units of a list were in the one before: as many as both begin and end with.
struct Same {
    start: usize,
    /// Where those at the end begin, now and before.
    end: (usize, usize),
}

impl Same {
    fn new(old: &[Arc<UnitFacts>], new: &[Arc<UnitFacts>]) -> Self {
        let is_same = |it: &(&Arc<UnitFacts>, &Arc<UnitFacts>)| Arc::ptr_eq(it.0, it.1);
        let start = new.iter().zip(old).take_while(is_same).count();
        let rest = new[start..].iter().rev().zip(old[start..].iter().rev());
        let behind = rest.take_while(is_same).count();
        Self { start, end: (new.len() - behind, old.len() - behind) }
    }

    /// Where a unit was before.
    fn before(&self, at: usize) -> Option<usize> {
        if at < self.start { Some(at) } else { Some(at.checked_sub(self.end.0)? + self.end.1) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::db::{Input, RootDatabase, program_facts, programs};
    use crate::lint::settings::Settings;
    use crate::source::detect::Dialect;

    /// A program in which names of symbols and fields are used, with a place for a symbol, a field and an instruction.
    fn files([symbol, field, code]: [&str; 3]) -> [(&'static str, String); 3] {
        let block = |number: u8, code: &str| format!("FUNCTION FC {number} : VOID\nBEGIN\n{code}END_FUNCTION\n");
        [
            ("p/s.SDF", format!("\"pump\",\"{symbol}\",\"BOOL\",\"\"\n\"belt\",\"M 1.1\",\"BOOL\",\"\"\n")),
            ("p/a.awl", block(1, "U \"pump\"\n= M 2.0\n") + &block(2, code) + &block(3, "U \"belt\"\n= DB1.weight\n")),
            (
                "p/d.awl",
                format!("DATA_BLOCK DB 1\nSTRUCT\n{field}weight : BOOL;\nEND_STRUCT;\nBEGIN\nEND_DATA_BLOCK\n"),
            ),
        ]
    }

    fn database(texts: [&str; 3]) -> RootDatabase {
        let mut db = RootDatabase::new(Settings::default(), None);
        let input = |(path, text): (&str, String)| Input::from_text(path, &text, Dialect::Auto);
        db.set_files(files(texts).map(input));
        db
    }

    #[test]
    fn what_was_known_changes_nothing() {
        let plain = ["M 1.0", "", "U E 0.0\n= A 0.0\n"];
        let steps = [
            plain,
            ["M 1.0", "", "U E 0.1\n= A 0.0\n"],
            ["M 1.0", "", "U E 0.1\n= A 0.0\nEND_FUNCTION\nFUNCTION FC 9 : VOID\nBEGIN\nU DB1.weight\n= A 1.0\n"],
            ["M 5.0", "", "U E 0.1\n= A 0.0\n"],
            ["M 5.0", "count : INT;\n", "U \"pump\"\n= DB1.weight\n"],
            plain,
        ];
        let mut db = database(plain);
        let sources = {
            use crate::db::Db as _;
            db.project().files(&db).to_vec()
        };
        let kept = |db: &RootDatabase| program_facts(db, programs(db)[0]);
        let mut before = kept(&db);
        assert_eq!(programs(&db).len(), 1);
        for (at, step) in steps.into_iter().enumerate() {
            for (path, text) in files(step) {
                let source = *sources.iter().find(|it| it.path(&db) == path).unwrap();
                db.set_text(source, text.as_str());
            }
            let (now, anew) = (kept(&db), database(step));
            assert_eq!(now, kept(&anew), "step {at}");
            let same = now.iter().filter(|it| before.iter().any(|old| Arc::ptr_eq(it, old))).count();
            // Of the symbols, the data block and three functions, those that did not change.
            assert_eq!(same, [5, 4, 5, 3, 2, 0][at], "step {at}");
            before = now;
        }
    }
}
