//! Which declaration a word of a program goes by: a symbol of its tables and variables, or a parameter, variable or
//! component of a block or of a DFB, wherever the word stands: in code, in a call, behind a point, in the initial values of
//! a data block.

use rowan::{TextRange, TextSize};
use rustc_hash::{FxHashMap, FxHashSet};
use smol_str::SmolStr;

use super::cursor::{InUnit, What, key_in_code};
use crate::analysis::symbols::SymbolTable;
use crate::db::{self, FilePlace, Program, RootDatabase, Unit};
use crate::model::UnitModel;
use crate::model::entity::{BlockName, Entity};
use crate::model::layout::{DataType, Field};
use crate::model::object::{Area, Class, step7};
use crate::model::symbols::key;
use crate::model::unit::{Call, Callee};
use crate::syntax::{Language, SyntaxKind, SyntaxNode, SyntaxToken};

/// What gives a word its meaning. It is the same in all programs that share the declaration.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Declared<'s> {
    /// In lower case.
    Symbol(SmolStr),
    /// The unit and the place of the name in it, an index into the anchors of its model.
    Field(Unit<'s>, u32),
}

/// A word that a declaration gives its meaning.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Word<'s> {
    /// Of the name in the unit, without the marks around it.
    pub(super) range: TextRange,
    pub(super) declared: Declared<'s>,
    /// Whether marks around it say what kind of name it is.
    pub(super) marked: bool,
}

/// The names of a program.
pub(super) struct Names<'s> {
    db: &'s RootDatabase,
    units: &'s [Unit<'s>],
    table: &'s SymbolTable,
    /// Blocks by number where it is known.
    blocks: FxHashMap<BlockName, Unit<'s>>,
    /// Types of DFBs.
    dfbs: FxHashMap<SmolStr, Unit<'s>>,
    /// The types of what has a symbol and no address, by the symbol.
    instances: FxHashMap<SmolStr, SmolStr>,
}

/// Fields with the unit that declares them.
type Scope<'s> = (Unit<'s>, &'s [Field]);

/// Types that stand for types, further than anybody goes.
const MOST_NESTED: usize = 16;

/// What stands around names to say what kind they are.
const MARKS: [char; 8] = ['#', '-', '"', '«', '»', ' ', '\u{a0}', '\u{202f}'];

/// The word at a place.
pub(super) fn word_at<'s>(cursor: &InUnit<'s>) -> Option<Word<'s>> {
    let name = key_of(cursor.token()?);
    let names = Names::new(cursor.it.db, cursor.program()?.0);
    names.words(cursor.unit, &name).into_iter().find(|it| {
        it.range.contains_inclusive(cursor.at) || {
            // The cursor may stand before the mark.
            it.marked && it.range.start().checked_sub(TextSize::new(1)) == Some(cursor.at)
        }
    })
}

/// Where the name at a place is declared: a field, or the block that a symbol names before one of its fields.
pub(super) fn declaration_at(cursor: &InUnit<'_>) -> Option<FilePlace> {
    let word = word_at(cursor)?;
    let db = cursor.it.db;
    match word.declared {
        Declared::Field(unit, anchor) => Some(place_in(db, unit, db::model(db, unit).place(anchor))),
        Declared::Symbol(name) => {
            let range = cursor.target().filter(|it| matches!(it.what, What::Object(_)))?.range;
            let behind = cursor.text(TextRange::new(word.range.end(), range.end().max(word.range.end())));
            let is_part = behind.trim_start_matches(MARKS).starts_with('.');
            if !is_part {
                return None;
            }
            let names = Names::new(db, cursor.program()?.0);
            match names.block(&BlockName::Symbol(name.clone())) {
                Some(block) => Some(place_in(db, block, db::model(db, block).heading())),
                None => names.declaration(&name).map(|(unit, range)| place_in(db, unit, range)),
            }
        }
    }
}

/// A range of a unit, in its file.
pub(super) fn place_in(db: &RootDatabase, unit: Unit<'_>, range: TextRange) -> FilePlace {
    let file = unit.file(db);
    let offset = db::layout(db, file).iter().find(|it| it.0 == unit).map_or(0, |it| it.1);
    FilePlace { file, range: range + TextSize::new(offset) }
}

impl<'s> Names<'s> {
    pub(super) fn new(db: &'s RootDatabase, program: Program<'s>) -> Self {
        let (units, table) = (db::program_units(db, program), &**db::symbol_table(db, program));
        let mut it = Self {
            db,
            units,
            table,
            blocks: FxHashMap::default(),
            dfbs: FxHashMap::default(),
            instances: FxHashMap::default(),
        };
        for &unit in units {
            match unit.entity(db) {
                Entity::Dfb { name } => {
                    it.dfbs.insert(key(name), unit);
                }
                entity => {
                    let number = |name: &BlockName| table.block(name).unwrap_or_else(|| name.clone());
                    it.blocks.extend(entity.name().map(|name| (number(name), unit)));
                }
            }
            if unit.language(db).declares_symbols() {
                let instances = db::facts(db, unit).symbols.iter().filter(|it| it.object.is_none());
                it.instances.extend(instances.map(|it| (key(&it.name), key(&it.ty))));
            }
        }
        it
    }

    /// Where the tables and variables of the program declare a symbol.
    fn declaration(&self, symbol: &SmolStr) -> Option<(Unit<'s>, TextRange)> {
        self.units.iter().filter(|it| it.language(self.db).declares_symbols()).find_map(|&unit| {
            let model = self.model(unit);
            let found = model.symbols.iter().find(|it| key(&it.name) == *symbol)?;
            Some((unit, model.place(found.anchor)))
        })
    }

    /// Whether the program declares a symbol, or uses one that nothing declares.
    pub(super) fn has_symbol(&self, symbol: &SmolStr) -> bool {
        let declared = Declared::Symbol(symbol.clone());
        let uses = |unit: &Unit<'s>| {
            may_name(unit.text(self.db), symbol) && self.words(*unit, symbol).iter().any(|it| it.declared == declared)
        };
        self.declaration(symbol).is_some() || self.units.iter().any(uses)
    }

    /// Whether a word that a unit writes without marks has a meaning.
    pub(super) fn knows(&self, unit: Unit<'s>, word: &SmolStr) -> bool {
        let is_own = || self.fields(unit).is_some_and(|it| it.1.iter().any(|it| it.name == *word));
        is_own() || self.words(unit, word).iter().any(|it| !it.marked)
    }

    /// All words of the program that one declaration gives their meaning, with their units.
    pub(super) fn all(&self, name: &SmolStr, declared: &Declared<'s>) -> Vec<(Unit<'s>, Word<'s>)> {
        let mut found = Vec::new();
        for &unit in self.units.iter().filter(|it| may_name(it.text(self.db), name)) {
            let words = self.words(unit, name);
            found.extend(words.into_iter().filter(|it| it.declared == *declared).map(|it| (unit, it)));
        }
        found
    }

    /// The words of a unit that are a name, in lower case, and that something declares.
    pub(super) fn words(&self, unit: Unit<'s>, name: &SmolStr) -> Vec<Word<'s>> {
        let (model, root) = (self.model(unit), db::tree(self.db, unit).syntax());
        let mut found = Vec::new();
        if matches!(unit.language(self.db), Language::SymbolTable | Language::Step5Symbols) {
            let symbols = model.symbols.iter().filter(|it| key(&it.name) == *name);
            found.extend(symbols.map(|it| Word {
                range: model.place(it.anchor),
                declared: Declared::Symbol(name.clone()),
                marked: true,
            }));
            return found;
        }
        if !unit.language(self.db).is_statement_list() {
            self.words_of_pl7(unit, name, &mut found);
            return found;
        }
        self.symbols(model, root, name, &mut found);
        let mut own = FxHashMap::default();
        each_field(model.fields(), &mut |it| {
            own.insert(model.place(it.anchor).start(), it.anchor);
        });
        let jumps: FxHashSet<TextSize> = model.jumps.iter().map(|it| it.range.start()).collect();
        for node in root.descendants() {
            match node.kind() {
                SyntaxKind::VarName => {
                    let token = node.tokens().next().filter(|it| key_of(*it) == *name);
                    let anchor = own.get(&node.text_range().start());
                    found.extend(token.zip(anchor).map(|(it, anchor)| Word {
                        range: inner(it),
                        declared: Declared::Field(unit, *anchor),
                        marked: true,
                    }));
                }
                // A label may have the name of a variable.
                SyntaxKind::Operand if !jumps.contains(&node.text_range().start()) => {
                    self.path(unit, node, name, &mut found);
                }
                _ => {}
            }
        }
        for call in &model.calls {
            self.arguments(unit, call, name, &mut found);
        }
        found.sort_by_key(|it| it.range.start());
        found.dedup_by_key(|it| it.range);
        found
    }

    fn words_of_pl7(&self, unit: Unit<'s>, name: &SmolStr, found: &mut Vec<Word<'s>>) {
        let (model, root) = (self.model(unit), db::tree(self.db, unit).syntax());
        let is_dfb = matches!(unit.entity(self.db), Entity::Dfb { .. });
        let item = |unit: Unit<'s>| {
            let items = self.model(unit).interface.iter().flat_map(|it| &it.items);
            let item = items.into_iter().find(|it| key(&it.name) == *name)?;
            Some(Declared::Field(unit, item.anchor))
        };
        let own = item(unit).filter(|_| is_dfb);
        let mut push = |token: SyntaxToken<'_>, declared: Option<Declared<'s>>| {
            found.extend(declared.map(|declared| Word { range: token.text_range(), declared, marked: true }));
        };
        for node in root.descendants().filter(|it| matches!(it.kind(), SyntaxKind::NameRef | SyntaxKind::VarName)) {
            let mut tokens = node.tokens().filter(|it| !it.kind().is_trivia());
            let Some(first) = tokens.next() else { continue };
            if own.is_some() && key(first.text()) == *name {
                push(first, own.clone());
            }
            let point = tokens.next().filter(|it| it.kind() == SyntaxKind::Dot);
            let behind = point.and(tokens.next()).filter(|it| key(it.text()) == *name);
            if let Some(behind) = behind.filter(|_| !is_dfb) {
                let ty = self.instances.get(&key(first.text()));
                push(behind, ty.and_then(|it| self.dfbs.get(it)).and_then(|it| item(*it)));
            }
        }
        // A DFB sees its own names alone (PL7:5350-5450).
        if is_dfb {
            return;
        }
        let symbols = model.symbols.iter().map(|it| model.place(it.anchor));
        let objects = model.accesses.iter().filter(|it| model.object(it.object).class == Class::Symbol);
        let calls = model.calls.iter().filter(|it| matches!(it.callee, Callee::Instance(_)));
        let mut ranges: Vec<TextRange> = symbols
            .chain(objects.map(|it| model.place(it.anchor)))
            .chain(calls.map(|it| model.place(it.anchor)))
            .collect();
        ranges.sort_unstable_by_key(|it| (it.start(), it.end()));
        // Ranges may hold one another: of those that start before the word, the longest decides.
        let mut reach = TextSize::new(0);
        let mut next = ranges.iter().peekable();
        let mut last = None;
        for token in root.descendant_tokens().filter(|it| !it.kind().is_trivia()) {
            let range = token.text_range();
            let is_behind_point = last.replace(token.kind()) == Some(SyntaxKind::Dot);
            if is_behind_point || token.kind() != SyntaxKind::Ident || key(token.text()) != *name {
                continue;
            }
            while let Some(range) = next.next_if(|it| it.start() <= token.text_range().start()) {
                reach = reach.max(range.end());
            }
            if range.end() <= reach {
                push(token, Some(Declared::Symbol(name.clone())));
            }
        }
    }

    /// Symbols in marks, and those without that the model takes for symbols.
    fn symbols(&self, model: &UnitModel, root: SyntaxNode<'s>, name: &SmolStr, found: &mut Vec<Word<'s>>) {
        let mut bare: Vec<TextSize> = Vec::new();
        let symbols = model.accesses.iter().filter(|it| model.object(it.object).class == Class::Symbol);
        bare.extend(symbols.map(|it| model.place(it.anchor).start()));
        let is_symbol = |it: &&Call| matches!(&it.callee, Callee::Block(BlockName::Symbol(_)));
        bare.extend(model.calls.iter().filter(is_symbol).map(|it| model.place(it.anchor).start()));
        bare.sort_unstable();
        for token in root.descendant_tokens() {
            let marked = token.kind() == SyntaxKind::QuotedSymbol;
            let is_it = || {
                marked || token.kind() == SyntaxKind::Ident && bare.binary_search(&token.text_range().start()).is_ok()
            };
            if is_it() && key_of(token) == *name {
                found.push(Word { range: inner(token), declared: Declared::Symbol(name.clone()), marked });
            }
        }
    }

    /// The fields that an operand names: `#motor.speed`, `"Data".poids`, `DB10.table[2].x`.
    fn path(&self, unit: Unit<'s>, operand: SyntaxNode<'s>, name: &SmolStr, found: &mut Vec<Word<'s>>) {
        let is_step5 = matches!(unit.language(self.db), Language::Step5(_));
        let in_block = |name: BlockName| self.fields(self.block(&name)?);
        let mut tokens = operand.tokens().filter(|it| !it.kind().is_trivia()).peekable();
        tokens.next_if(|it| it.kind() == SyntaxKind::PointerConstant);
        // The letters of an address of STEP 5 are a word, too.
        let is_formal = tokens.next_if(|it| it.kind() == SyntaxKind::Eq).is_some() || !is_step5;
        let Some(first) = tokens.next() else { return };
        let own = || {
            let (owner, fields) = self.fields(unit).filter(|_| is_formal)?;
            Some((owner, fields.iter().find(|it| it.name == key_of(first))?))
        };
        let mut push = |token: SyntaxToken<'_>, (owner, field): (Unit<'s>, &'s Field), marked| {
            if field.name == *name {
                found.push(Word { range: inner(token), declared: Declared::Field(owner, field.anchor), marked });
            }
            self.within(owner, &field.ty)
        };
        let mut scope = match first.kind() {
            SyntaxKind::LocalName => own().and_then(|it| push(first, it, true)),
            SyntaxKind::Ident => match own() {
                Some(it) => push(first, it, is_step5),
                // A symbol without marks.
                None => in_block(BlockName::Symbol(key_of(first))),
            },
            SyntaxKind::QuotedSymbol => in_block(BlockName::Symbol(key_of(first))),
            SyntaxKind::Address => address(first.text()).and_then(in_block),
            _ => None,
        };
        for token in tokens.filter(|it| it.kind() == SyntaxKind::Ident) {
            let Some((owner, fields)) = scope else { return };
            let Some(field) = fields.iter().find(|it| it.name == key_of(token)) else { return };
            scope = push(token, (owner, field), true);
        }
    }

    /// The parameters that a call names.
    fn arguments(&self, unit: Unit<'s>, call: &Call, name: &SmolStr, found: &mut Vec<Word<'s>>) {
        let mut named =
            call.arguments.iter().filter(|it| it.name.as_ref().is_some_and(|it| key(it) == *name)).peekable();
        if named.peek().is_none() {
            return;
        }
        let scope = match &call.callee {
            Callee::Block(block) => self.block(block).and_then(|it| self.fields(it)),
            Callee::LocalInstance(instance) => self.instance(unit, instance),
            _ => None,
        };
        let Some((owner, fields)) = scope else { return };
        let Some(field) = fields.iter().find(|it| it.name == *name) else { return };
        found.extend(named.map(|it| Word {
            range: self.model(unit).place(it.anchor),
            declared: Declared::Field(owner, field.anchor),
            marked: true,
        }));
    }

    /// The fields of an instance that a block holds: `#motor`, `#group.motor`.
    fn instance(&self, unit: Unit<'s>, path: &str) -> Option<Scope<'s>> {
        let mut scope = self.fields(unit)?;
        for part in path.trim_start_matches('#').split('.') {
            let name = key(part.trim());
            let field = scope.1.iter().find(|it| it.name == name)?;
            scope = self.within(scope.0, &field.ty)?;
        }
        Some(scope)
    }

    fn model(&self, unit: Unit<'s>) -> &'s UnitModel {
        db::model(self.db, unit)
    }

    fn block(&self, name: &BlockName) -> Option<Unit<'s>> {
        let known = self.table.block(name);
        self.blocks.get(known.as_ref().unwrap_or(name)).copied()
    }

    /// The fields of a unit: an instance has those of its function block, a data block of a type those of the type.
    fn fields(&self, unit: Unit<'s>) -> Option<Scope<'s>> {
        let mut unit = unit;
        for _ in 0..MOST_NESTED {
            match self.model(unit).declared.as_ref()? {
                DataType::Struct(fields) => return Some((unit, fields)),
                DataType::Named(of) => unit = self.block(of)?,
                _ => return None,
            }
        }
        None
    }

    /// The fields of what is of a type, an element of an array too.
    fn within(&self, unit: Unit<'s>, ty: &'s DataType) -> Option<Scope<'s>> {
        match ty {
            DataType::Array(_, of) => self.within(unit, of),
            DataType::Struct(fields) => Some((unit, fields)),
            DataType::Named(name) => self.fields(self.block(name)?),
            DataType::Elementary(_) | DataType::Text(_) | DataType::Unknown => None,
        }
    }
}

/// The names of what stands beside a field or an item of a DFB, in lower case.
pub(super) fn beside(db: &RootDatabase, unit: Unit<'_>, anchor: u32) -> Vec<SmolStr> {
    let model = db::model(db, unit);
    let items = model.interface.iter().flat_map(|it| &it.items).map(|it| (key(&it.name), it.anchor));
    let fields = siblings(model.fields(), anchor).unwrap_or_default().iter().map(|it| (it.name.clone(), it.anchor));
    items.chain(fields).filter(|it| it.1 != anchor).map(|it| it.0).collect()
}

/// A field by the place of its name.
pub(super) fn field(fields: &[Field], anchor: u32) -> Option<&Field> {
    siblings(fields, anchor)?.iter().find(|it| it.anchor == anchor)
}

/// The fields that stand beside one, it among them.
fn siblings(fields: &[Field], anchor: u32) -> Option<&[Field]> {
    if fields.iter().any(|it| it.anchor == anchor) {
        return Some(fields);
    }
    fields.iter().find_map(|it| siblings(parts(&it.ty), anchor))
}

fn each_field<'m>(fields: &'m [Field], each: &mut impl FnMut(&'m Field)) {
    for it in fields {
        each(it);
        each_field(parts(&it.ty), each);
    }
}

/// What a type declares by itself.
fn parts(ty: &DataType) -> &[Field] {
    match ty {
        DataType::Array(_, of) => parts(of),
        other => other.fields(),
    }
}

/// `DB10`, `DB 10`
fn address(text: &str) -> Option<BlockName> {
    let text: String = text.split_whitespace().collect();
    match step7::parse_either(&text).ok()?.footprint.area {
        Area::CodeBlock(name) => Some(name),
        _ => None,
    }
}

fn key_of(token: SyntaxToken<'_>) -> SmolStr {
    key_in_code(token.text().trim_start_matches('#'))
}

/// A name without its marks.
fn inner(token: SyntaxToken<'_>) -> TextRange {
    let text = token.text();
    let front = text.len() - text.trim_start_matches(MARKS).len();
    let back = text.trim_start_matches(MARKS).len() - text.trim_matches(MARKS).len();
    let (front, back) = (TextSize::try_from(front), TextSize::try_from(back));
    let range = token.text_range();
    TextRange::new(range.start() + front.unwrap_or_default(), range.end() - back.unwrap_or_default())
}

/// Whether a name, in lower case, can stand in a text.
fn may_name(text: &str, name: &str) -> bool {
    // Other letters have several forms.
    if !name.is_ascii() {
        return true;
    }
    let Some((&first, rest)) = name.as_bytes().split_first() else { return false };
    let bytes = text.as_bytes();
    memchr::memchr2_iter(first, first.to_ascii_uppercase(), bytes)
        .any(|at| bytes[at + 1..].get(..rest.len()).is_some_and(|it| it.eq_ignore_ascii_case(rest)))
}
