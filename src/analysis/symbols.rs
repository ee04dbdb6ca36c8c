//! Symbols of a program: which address each names, and the facts of units with addresses in place of symbols.
//!
//! In PL7 a symbol stands for an address; in STEP 7 also for a block, and `"Data".DBW0` for a place in one.
//!
//! Resolution comes between the facts of units and [`ProgramIndex`](super::program::ProgramIndex): after it, `Pump` and
//! `%M0` are one object. A unit that uses no symbol is passed on as it is.

use std::borrow::Cow;

use rustc_hash::{FxHashMap, FxHashSet};
use smol_str::{SmolStr, format_smolstr};

use super::facts::{FactObject, UnitFacts};
use crate::model::entity::{BlockKind, BlockName, Entity, Family};
use crate::model::object::{Area, Class, Footprint, Object, Type, pl7, pl72, step5, step7};
use crate::model::symbols::key;
use crate::model::unit::{Callee, Mode, Pin};
use crate::syntax::Mnemonics;

/// The symbols of a program, by [`key`], and the symbols of addresses.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SymbolTable {
    /// Whose addresses symbols name.
    family: Family,
    addresses: FxHashMap<SmolStr, Meaning>,
    /// Symbol of an address in upper case, in each mnemonic set.
    names: FxHashMap<SmolStr, SmolStr>,
}

#[derive(Debug, Clone, PartialEq, Eq)]
enum Meaning {
    Address(SmolStr),
    /// An instance of a DFB, or a symbol that two declarations give to two objects.
    Unknown,
}

impl SymbolTable {
    pub fn new<'a>(family: Family, units: impl IntoIterator<Item = &'a UnitFacts>) -> Self {
        let mut table = Self { family, addresses: FxHashMap::default(), names: FxHashMap::default() };
        for symbol in units.into_iter().flat_map(|it| &it.symbols) {
            let meaning = match &symbol.object {
                Some(object) => {
                    let address = table.spelling(&object.text);
                    let name = table.shown(&symbol.name);
                    if family == Family::Step7 {
                        for it in [Mnemonics::German, Mnemonics::English] {
                            let other = step7::translated(&address, it).map(SmolStr::from);
                            table.names.extend(other.map(|it| (it, name.clone())));
                        }
                    }
                    table.names.entry(address.clone()).or_insert(name);
                    Meaning::Address(address)
                }
                None => Meaning::Unknown,
            };
            let known = table.addresses.entry(key(&symbol.name)).or_insert_with(|| meaning.clone());
            if *known != meaning {
                *known = Meaning::Unknown;
            }
        }
        table
    }

    /// An address as the table has it. The percent sign is no part of those of PL7-2.
    fn spelling(&self, address: &str) -> SmolStr {
        let upper = SmolStr::from(address.to_ascii_uppercase());
        let bare = upper.strip_prefix('%').filter(|_| self.family == Family::Pl72);
        bare.map(SmolStr::from).unwrap_or(upper)
    }

    /// A symbol as code writes it.
    fn shown(&self, name: &str) -> SmolStr {
        if self.family == Family::Step7 { format_smolstr!("\"{name}\"") } else { name.into() }
    }

    pub fn is_empty(&self) -> bool {
        self.addresses.is_empty()
    }

    /// The address of a symbol. An item or bit that has no symbol of its own goes by that of its object: `Etat:X1`,
    /// `Tempo.Q`, a table by that of its first word (PL7:1234-1242).
    pub fn address(&self, symbol: &str) -> Option<SmolStr> {
        // STEP 5 marks symbols in code.
        let symbol = symbol.strip_prefix('-').unwrap_or(symbol);
        let (name, rest) = self.parts(symbol)?;
        match self.addresses.get(&key(name))? {
            Meaning::Address(address) if rest.is_empty() => Some(address.clone()),
            Meaning::Address(address) => Some(format_smolstr!("{address}{rest}")),
            Meaning::Unknown => None,
        }
    }

    /// A symbol, without its quotes, and what stands behind it. That of STEP 7 may itself have a point in it.
    fn parts<'s>(&self, symbol: &'s str) -> Option<(&'s str, &'s str)> {
        for (open, close) in [('"', '"'), ('«', '»')] {
            if let Some((name, rest)) = symbol.strip_prefix(open).and_then(|it| it.split_once(close)) {
                return Some((name.trim_matches([' ', '\u{a0}', '\u{202f}']), rest));
            }
        }
        let base = symbol.find(['.', ':', ',']).filter(|_| !self.addresses.contains_key(&key(symbol)));
        symbol.split_at_checked(base.unwrap_or(symbol.len()))
    }

    /// The number of a block that a program names by a symbol.
    pub fn block(&self, name: &BlockName) -> Option<BlockName> {
        let BlockName::Symbol(symbol) = name else { return None };
        match self.addresses.get(&key(symbol))? {
            Meaning::Address(address) => match step7::parse_either(address).ok()?.footprint.area {
                Area::CodeBlock(name) => Some(name),
                _ => None,
            },
            Meaning::Unknown => None,
        }
    }

    /// The symbol of an address as written, in the form in which items of an object inherit it.
    pub fn symbol(&self, address: &str) -> Option<SmolStr> {
        self.symbol_of(&self.spelling(address)).or_else(|| {
            // Code of Siemens has blanks in its addresses.
            let is_spaced = matches!(self.family, Family::Step7 | Family::Step5) && !address.contains(['"', '«', '-']);
            let bare = is_spaced.then(|| address.split_whitespace().collect::<String>())?;
            self.symbol_of(&self.spelling(&bare))
        })
    }

    fn symbol_of(&self, address: &str) -> Option<SmolStr> {
        if let Some(name) = self.names.get(address) {
            return Some(name.clone());
        }
        let base = address.rfind([':', '.', ','])?;
        let (object, rest) = address.split_at_checked(base)?;
        let is_item = rest.starts_with(':') || rest.get(1..).is_some_and(|it| it.starts_with(char::is_alphabetic));
        let name = self.names.get(object).filter(|_| is_item)?;
        Some(format_smolstr!("{name}{rest}"))
    }

    /// A message with the symbol behind each address that it names, and the address behind each symbol: every object
    /// once.
    pub fn annotate(&self, message: &str) -> String {
        let parts: Vec<&str> = message.split('`').collect();
        let mut out = String::with_capacity(message.len() + 16);
        let mut done: FxHashSet<&str> = FxHashSet::default();
        for (at, part) in parts.iter().enumerate() {
            if at > 0 {
                out.push('`');
            }
            out.push_str(part);
            // The odd parts stand between two of the quotes, but for one behind an unpaired quote.
            let is_closed = at % 2 == 0 && at > 1;
            let Some(name) = parts.get(at.wrapping_sub(1)).filter(|_| is_closed) else { continue };
            let other = self.symbol(name).or_else(|| self.address(name));
            // A rule about symbols names them without the quotes that code puts around them.
            let is_named = |it: &str| [it, it.trim_matches('"')].iter().any(|it| message.contains(&format!("`{it}`")));
            if let Some(other) = other.filter(|it| !is_named(it) && done.insert(name)) {
                out.truncate(out.len() - part.len());
                out.push_str(" (`");
                out.push_str(&other);
                out.push_str("`)");
                out.push_str(part);
            }
        }
        out
    }

    /// What a symbol used in code names, under the text that the code gives it.
    fn resolve(&self, object: &Object) -> Option<Object> {
        let text = object.text.as_str();
        match (&object.footprint.area, object.class) {
            (_, Class::Symbol) => {}
            (Area::Data(block), _) => {
                let area = Area::Data(self.block(block)?);
                return Some(Object { footprint: Footprint { area, ..object.footprint.clone() }, ..object.clone() });
            }
            (Area::Symbol(_), _) => {
                let (block, path) = step7::field(object)?;
                let area = step7::field_area(&self.block(&block)?, &path);
                return Some(Object { footprint: Footprint::new(area, 0, 1), ..object.clone() });
            }
            _ => return None,
        }
        let resolved = if self.family == Family::Step5 {
            step5::parse_any(&self.address(text)?)
        } else if self.family == Family::Pl72 {
            pl72::parse(&self.address(text)?).map(|it| it.object)
        } else if self.family == Family::Step7 {
            step7::parse_either(&self.address(text)?)
        } else if object.indexed {
            let (name, rest) = text.split_once('[')?;
            let suffix = rest.rsplit_once(']').map(|it| it.1).filter(|it| !it.is_empty());
            pl7::parse_indexed(&self.address(name)?, suffix)
        } else {
            pl7::parse(&self.address(text)?)
        };
        let resolved = resolved.ok()?;
        // An array of a data block that is indexed is none of its first element.
        Some(Object { text: object.text.clone(), indexed: object.indexed, ..resolved })
    }
}

/// The facts of a unit with every symbol that the table knows replaced by its object.
pub fn resolve<'a>(table: &SymbolTable, facts: &'a UnitFacts) -> Cow<'a, UnitFacts> {
    if table.is_empty() {
        return Cow::Borrowed(facts);
    }
    let found: Vec<Option<Object>> = facts.objects.iter().map(|it| table.resolve(&it.object)).collect();
    if found.iter().all(Option::is_none) && !names_blocks(facts) {
        return Cow::Borrowed(facts);
    }
    let mut facts = facts.clone();
    resolve_blocks(table, &mut facts);
    for it in &mut facts.uses {
        // Without its type, a symbol that takes a value is a word or a bit by what it takes.
        if let Some(Some(object)) = found.get(it.object as usize) {
            it.mode = match (it.mode, object.ty) {
                (Mode::Assign | Mode::AssignNot, ty) if ty != Type::Bool => Mode::Store,
                (Mode::Store, Type::Bool) => Mode::Assign,
                (Mode::Set, Type::Block) => Mode::Drive(Pin::Preset),
                (Mode::Reset, Type::Block) => Mode::Drive(Pin::Reset),
                (mode, _) => mode,
            };
        }
    }
    for (fact, object) in facts.objects.iter_mut().zip(found) {
        if let Some(object) = object {
            *fact = FactObject::new(&object, fact.number, fact.missed);
        }
    }
    join_aliases(&mut facts);
    Cow::Owned(facts)
}

/// Whether a unit names blocks, itself too, by symbols.
fn names_blocks(facts: &UnitFacts) -> bool {
    let is_symbol = |it: &BlockName| matches!(it, BlockName::Symbol(_));
    facts.entity.name().is_some_and(is_symbol)
        || facts.instance_of.as_ref().is_some_and(is_symbol)
        || facts.declared.as_deref().is_some_and(|it| {
            let mut found = false;
            it.each_named(&mut |it| found |= is_symbol(it));
            found
        })
        || facts.calls.iter().any(|it| {
            matches!(&it.callee, Callee::Block(name) if is_symbol(name)) || it.instance.as_ref().is_some_and(is_symbol)
        })
}

/// Puts the numbers of blocks in place of their symbols.
fn resolve_blocks(table: &SymbolTable, facts: &mut UnitFacts) {
    let replace = |name: &mut BlockName| {
        if let Some(number) = table.block(name) {
            *name = number;
        }
    };
    if let Entity::Block { kind, name } = &mut facts.entity
        && let Some(number) = table.block(name).filter(|it| matches!(it, BlockName::Number(it, _) if it == kind))
    {
        *name = number;
    }
    facts.instance_of.iter_mut().for_each(replace);
    // Code cannot tell whether the symbol is that of a type or of a function block.
    if matches!(facts.instance_of, Some(BlockName::Number(BlockKind::Udt, _))) {
        facts.instance_of = None;
    }
    if let Some(declared) = &mut facts.declared {
        declared.each_named_mut(&mut |it| replace(it));
    }
    for call in &mut facts.calls {
        if let Callee::Block(name) = &mut call.callee {
            replace(name);
        }
        call.instance.iter_mut().for_each(replace);
    }
}

/// Where one unit uses an object by its address and by its symbol, the unit's own facts took them for two. What is not
/// known of the two together is taken so that no rule speaks without need: conditional writes count as one write, and a
/// read behind an unconditional write as one of the unit's own value.
pub(super) fn join_aliases(facts: &mut UnitFacts) {
    let mut first: FxHashMap<_, u32> = FxHashMap::default();
    let mut aliased: FxHashSet<u32> = FxHashSet::default();
    let same: Vec<u32> = (0..)
        .zip(&facts.objects)
        .map(|(at, it)| {
            let object = &it.object;
            let id = *first.entry((object.footprint.clone(), object.ty, object.indexed)).or_insert(at);
            if id != at {
                aliased.insert(id);
            }
            id
        })
        .collect();
    if aliased.is_empty() {
        return;
    }
    let mut groups: FxHashMap<u32, u32> = FxHashMap::default();
    let mut written: FxHashSet<u32> = FxHashSet::default();
    for it in &mut facts.uses {
        let Some(&id) = same.get(it.object as usize).filter(|it| aliased.contains(it)) else { continue };
        let gives = it.mode.assigns() || it.mode == Mode::Store;
        if it.mode.reads() && written.contains(&id) {
            it.exposed = false;
        }
        if gives && !it.conditional {
            written.insert(id);
        } else if gives {
            it.group = *groups.entry(id).or_insert(it.group);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::entity::{Entity, Part, Task};
    use crate::model::lower;
    use crate::syntax::{self, Language};

    fn facts(text: &str, language: Language) -> UnitFacts {
        let entity = Entity::Pl7 { task: Task::Mast, section: None, part: Part::Main };
        let parse = syntax::parse(language, text);
        assert_eq!(parse.errors(), []);
        UnitFacts::new(&lower::lower(parse.syntax(), text, entity, language))
    }

    fn table(text: &str) -> SymbolTable {
        SymbolTable::new(Family::Pl7, [&facts(text, Language::Exchange)])
    }

    const VARIABLES: &str = "VAR_GLOBAL\nPump AT %M0 : EBOOL; Etat AT %MW4 : WORD; Tempo AT %TM0 : TM;\n\
        Four AT %MW10 : WORD; Vis : Cpt_pieces; Bit AT %MW4:X2 : BOOL;\nTwice AT %M1; TWICE AT %M2;\nEND_VAR\n";

    #[test]
    fn symbols_and_what_inherits_them() {
        let table = table(VARIABLES);
        let address = |symbol| table.address(symbol).map(String::from);
        assert_eq!(address("pump").as_deref(), Some("%M0"), "case does not matter");
        assert_eq!(address("Etat:X1").as_deref(), Some("%MW4:X1"));
        assert_eq!(address("Tempo.Q").as_deref(), Some("%TM0.Q"));
        assert_eq!(address("Vis"), None);
        assert_eq!(address("Twice"), None, "it names two objects");
        assert_eq!(address("Other"), None);
        let symbol = |address| table.symbol(address).map(String::from);
        assert_eq!(symbol("%m0").as_deref(), Some("Pump"));
        assert_eq!(symbol("%MW4:X2").as_deref(), Some("Bit"));
        assert_eq!(symbol("%MW4:X3").as_deref(), Some("Etat:X3"));
        assert_eq!(symbol("%TM0.Q").as_deref(), Some("Tempo.Q"));
        assert_eq!(symbol("%I4.0"), None);
    }

    #[test]
    fn messages_name_both() {
        let table = table(VARIABLES);
        let annotate = |message| table.annotate(message);
        assert_eq!(annotate("`%M0` is set, `%M0` is reset"), "`%M0` (`Pump`) is set, `%M0` is reset");
        assert_eq!(annotate("`pump` is `read`"), "`pump` (`%M0`) is `read`");
        assert_eq!(annotate("use `Four`"), "use `Four` (`%MW10`)");
        assert_eq!(annotate("`Pump` at `%M0`"), "`Pump` at `%M0`");
        for kept in ["", "`", "``", "`%M0", "no `%M7`", "`Vis` and `Twice`"] {
            assert_eq!(annotate(kept), kept);
        }
    }

    #[test]
    fn code_uses_the_objects() {
        let table = table(VARIABLES);
        let code = facts(
            "! Pump := Tempo.Q; Etat := Four; Etat:X1 := %M3; Etat[Four] := 2; Etat:3 := 0; Other := 1;",
            Language::Pl7St,
        );
        let resolved = resolve(&table, &code);
        let shown: Vec<(&str, u32, Class)> = resolved
            .objects
            .iter()
            .map(|it| (it.object.text.as_str(), it.object.footprint.start, it.object.class))
            .collect();
        let expected = [
            ("Tempo.Q", 0, Class::BlockBit),
            ("Pump", 0, Class::Memory),
            ("Four", 160, Class::Memory),
            ("Etat", 64, Class::Memory),
            ("%M3", 3, Class::Memory),
            ("Etat:X1", 65, Class::Memory),
            ("Etat[Four]", 64, Class::Memory),
            ("Etat:3", 64, Class::Memory),
            ("Other", 0, Class::Symbol),
        ];
        assert_eq!(shown.iter().map(|it| (it.0, it.2)).collect::<Vec<_>>(), expected.map(|it| (it.0, it.2)));
        let other = facts("! %MW10 := %MW4;", Language::Pl7St);
        let same = |a: &str, b: &str| {
            let one = resolved.objects.iter().find(|it| it.object.text == a);
            let two = other.objects.iter().find(|it| it.object.text == b);
            one.zip(two).is_some_and(|(one, two)| one.is_same(two))
        };
        assert!(same("Four", "%MW10") && same("Etat", "%MW4") && !same("Etat", "%MW10"));
        for (found, expected) in shown.iter().zip(expected).filter(|it| it.0.2 == Class::Memory) {
            assert_eq!(found.1, expected.1, "{}", found.0);
        }
        assert!(matches!(resolve(&table, &facts("! %M1 := %M2;", Language::Pl7St)), Cow::Borrowed(_)));
    }

    #[test]
    fn symbols_of_pl7_2() {
        let variables = "VAR_GLOBAL\nDepart AT I0,05 : BOOL; Pompe AT %B3 : BOOL; Mot AT W10; Tempo AT T0;\nEND_VAR\n";
        let table = SymbolTable::new(Family::Pl72, [&facts(variables, Language::Exchange)]);
        assert_eq!(table.address("pompe").as_deref(), Some("B3"));
        assert_eq!(table.symbol("T0,D").as_deref(), Some("Tempo,D"));
        assert_eq!(table.symbol("i0,05").as_deref(), Some("Depart"));
        assert_eq!(table.annotate("`B3` and `mot`"), "`B3` (`Pompe`) and `mot` (`W10`)");
        let code = facts(
            "RUNG L1:\nOPEN_CONTACT(Depart),H_LINK(8),COIL(Pompe);\nOPEN_CONTACT(Autre),H_LINK(8),COIL(B4);\nEND_RUNG\n",
            Language::Pl72Ld,
        );
        let resolved = resolve(&table, &code);
        let shown: Vec<_> = resolved.objects.iter().map(|it| (it.object.text.as_str(), it.object.class)).collect();
        let expected =
            [("Depart", Class::Input), ("Autre", Class::Symbol), ("Pompe", Class::Memory), ("B4", Class::Memory)];
        assert_eq!(shown, expected);
    }

    #[test]
    fn the_type_decides_how_it_is_written() {
        let table = table(VARIABLES);
        let code = facts("! Pump := %M5; Four := Etat; IF %M2 THEN SET Pump; END_IF;", Language::Pl7St);
        let modes = |facts: &UnitFacts| -> Vec<Mode> {
            facts.uses.iter().filter(|it| it.mode.writes()).map(|it| it.mode).collect()
        };
        assert_eq!(modes(&resolve(&table, &code)), [Mode::Assign, Mode::Store, Mode::Set]);
    }

    #[test]
    fn aliases_in_one_unit() {
        let table = table(VARIABLES);
        let text = "! IF %M9 THEN Pump := TRUE; ELSE %M0 := FALSE; END_IF; Four := 1; %M8 := %MW10 > 3;";
        let code = facts(text, Language::Pl7St);
        let resolved = &resolve(&table, &code);
        let writes: Vec<u32> =
            resolved.uses.iter().filter(|it| it.conditional && it.mode.writes()).map(|it| it.group).collect();
        assert!(writes.len() == 2 && writes[0] == writes[1], "only one of the two is reached");
        let read = resolved.uses.iter().rfind(|it| it.mode == Mode::Read).unwrap();
        assert!(!read.exposed, "the word was just written under its symbol");
    }
}
