//! What STEP 5 has of its own (the vendor's general documentation, where nothing else is said).
//!
//! The machine is the one of STEP 7, with accumulators of 16 bits: an RLO with first check, `=`, `S`, `R` and conditional
//! jumps that end the logic string, comparisons that overwrite the RLO (GRF:549-552), `L` and `T` that ignore it. A called
//! block finds the data block of its caller open, and the caller its own again. Block calls take no instance.

use rowan::TextRange;
use smol_str::{SmolStr, StrExt as _};

use super::operands::{Operand, bare_text};
use super::rlo::First;
use super::{Machine, mnemonic_text};
use crate::model::expr::{ExprId, Exprs, ObjectId};
use crate::model::layout::{DataType, Elementary, Field};
use crate::model::object::{self, AddressError, Area, Class, Footprint, Object, Type};
use crate::model::unit::{OddityKind, Section, StatementKind};
use crate::syntax::awl::ast;
use crate::syntax::awl::instruction::Op;
use crate::syntax::{AstNode as _, Language, Mnemonics, SyntaxKind, SyntaxNode, SyntaxToken};

/// Whether the first mnemonic is in capitals.
pub(super) fn writes_capitals(root: SyntaxNode<'_>) -> bool {
    let first = root.descendants().filter_map(ast::Instr::cast).find_map(|it| {
        it.mnemonic_tokens().next().filter(|it| it.text().starts_with(|it: char| it.is_ascii_alphabetic()))
    });
    first.is_none_or(|it| !it.text().contains(|it: char| it.is_ascii_lowercase()))
}

impl Machine {
    pub(super) fn is_step5(&self) -> bool {
        matches!(self.language, Language::Step5(_))
    }

    /// What a function block of STEP 5 declares.
    pub(super) fn formal_operands(&mut self, block: SyntaxNode<'_>) -> DataType {
        let mut fields = Vec::new();
        for decl in block.children().filter_map(ast::VarSection::cast).flat_map(ast::VarSection::decls) {
            let (section, ty) = Self::formal_operand(decl);
            for name in decl.names() {
                let anchor = self.b.anchor(name.range());
                let ty = DataType::Elementary(ty);
                fields.push(Field { name: name.text().to_lowercase().into(), section, ty, anchor });
            }
        }
        DataType::Struct(fields.into())
    }

    /// Section and type of a formal operand, by the letters for its kind and its size.
    fn formal_operand(decl: ast::VarDecl<'_>) -> (Section, Elementary) {
        let mut letters = decl.type_refs().map(|it| it.text().to_ascii_uppercase());
        let kind = letters.next().unwrap_or_default();
        let size = letters.next().unwrap_or_default();
        let section = match kind.as_str() {
            "A" | "Q" => Section::Output,
            "T" | "Z" | "C" => Section::InOut,
            _ => Section::Input,
        };
        let ty = match (kind.as_str(), size.as_str()) {
            ("T", _) => Elementary::Timer,
            ("Z" | "C", _) => Elementary::Counter,
            ("B", _) => Elementary::Block,
            (_, "BI") => Elementary::Bool,
            (_, "BY") => Elementary::Byte,
            (_, "D" | "DW") => Elementary::Double,
            _ => Elementary::Word,
        };
        (section, ty)
    }

    /// `=EIN`, `-START`, `KF +5`, `M 0.0`, `Tp[10]`.
    pub(super) fn step5_operand(&mut self, node: &ast::Operand, text: &SmolStr, mnemonics: Mnemonics) -> Operand {
        let range = node.range();
        if let Some(name) = text.strip_prefix('=') {
            return Operand::Object(self.local(&format!("#{name}"), self.modified));
        }
        if let Some(name) = text.strip_prefix('-').filter(|it| it.starts_with(char::is_alphabetic)) {
            return Operand::Object(self.b.object(Object { text: text.clone(), ..Object::symbol(name) }));
        }
        let first = node.first_token();
        let is_digit =
            |it: SyntaxToken<'_>| matches!(it.kind(), SyntaxKind::Number | SyntaxKind::Plus | SyntaxKind::Minus);
        let is_number = first.is_none_or(is_digit) && node.tokens().all(is_digit);
        let is_constant = first
            .is_some_and(|it| it.kind() == SyntaxKind::TypedConstant || crate::syntax::step5::is_constant(it.text()));
        if is_number || is_constant {
            // With the blanks, which part letters from characters.
            let is_one = node.tokens().nth(1).is_none();
            let written: SmolStr = if is_one { node.text().trim().into() } else { text.clone() };
            return self.constant(&written, range);
        }
        if self.modified {
            let ty = object::step5::parse(text, mnemonics).map_or(Type::Unknown, |it| it.ty);
            return Operand::Object(self.indirect(text, ty));
        }
        if let Some(table) = table_bit(text) {
            return Operand::Object(self.b.object(table));
        }
        let letters: &str = text.get(..text.bytes().take_while(u8::is_ascii_alphabetic).count()).unwrap_or_default();
        let is_lower = self.capitals && letters.contains(|it: char| it.is_ascii_lowercase());
        let read = if is_lower { None } else { Some(object::step5::parse(text, mnemonics)) };
        let object = match read {
            Some(Ok(mut object)) => {
                if self.writing && object.class == Class::PeripheralInput {
                    object.class = Class::PeripheralOutput;
                    object.footprint.area = Area::PeripheralOutputs;
                }
                self.b.object(object)
            }
            Some(Err(error)) if !is_symbol(text, &error) => self.no_address(text, error, range),
            _ => {
                let mut symbol = Object::symbol(text);
                if self.on_words {
                    // It may be a table, of which bits are used elsewhere.
                    symbol.footprint.bits = TABLE_BITS;
                }
                self.b.object(symbol)
            }
        };
        Operand::Object(object)
    }

    pub(super) fn no_address(&mut self, text: &str, error: AddressError, range: TextRange) -> ObjectId {
        self.b.oddity(OddityKind::Address(error), range, text);
        let mut object = Object::symbol(text);
        object.class = Class::Indirect;
        object.footprint.area = Area::Indirect;
        self.b.object(object)
    }

    pub(super) fn step5_instruction(&mut self, op: Op, instr: &ast::Instr, range: TextRange) {
        match op {
            Op::TestBit(wanted) => {
                let bit = self.object_operand(instr).map(|(object, at)| self.read(object, at));
                let bit: ExprId = bit.unwrap_or_else(|| self.b.exprs().opaque());
                let value = if wanted { bit } else { self.b.exprs().not(bit) };
                self.discard(range);
                self.or = None;
                self.first = First::Yes;
                self.overwrite(value, range);
            }
            Op::SetAlways | Op::ResetAlways => {
                self.ignores_rlo(range, instr);
                if let Some((object, at)) = self.object_operand(instr) {
                    match op {
                        Op::SetAlways => self.b.set(object, Exprs::TRUE, at, range),
                        _ => self.b.reset(object, Exprs::TRUE, at, range),
                    }
                    self.note_write(object);
                }
            }
            Op::Generate => {
                self.use_loads(0);
                self.b.statement(StatementKind::Other, range);
            }
            Op::Process => {
                if let Some((object, at)) = self.object_operand(instr) {
                    self.read(object, at);
                }
                self.processed = true;
            }
            Op::Stop => {
                self.b.statement(StatementKind::Halt, range);
            }
            Op::LoadRegister => {
                self.use_loads(0);
                self.b.model.reads_indirectly = true;
                let value = self.b.exprs().opaque();
                self.load(value, range, mnemonic_text(instr));
            }
            Op::TransferRegister => {
                self.keep_accumulators();
                self.b.model.writes_indirectly = true;
                self.b.wipe();
            }
            _ => {}
        }
    }
}

/// `Tp[10]`, `M Ts[100]`: a bit of a table, as documents write it (GRF:89, 382).
fn table_bit(text: &str) -> Option<Object> {
    let (name, index) = text.strip_suffix(']')?.split_once('[')?;
    let name = name.strip_prefix('M').filter(|it| it.starts_with('T')).unwrap_or(name);
    let index = index.parse().ok().filter(|it| *it < TABLE_BITS);
    let area = match index {
        Some(_) => Area::Symbol(name.to_lowercase_smolstr()),
        None => Area::Symbol(text.to_lowercase_smolstr()),
    };
    let symbol = Object::symbol(text);
    Some(Object { ty: Type::Bool, footprint: Footprint::new(area, index.unwrap_or(0), 1), ..symbol })
}

/// More bits than any table has.
const TABLE_BITS: u32 = 4096;

/// Whether a word that is no address may be a symbol: it has not the form of one, letters and a number.
fn is_symbol(text: &str, error: &AddressError) -> bool {
    let letters = text.bytes().take_while(u8::is_ascii_alphabetic).count();
    let number = text.get(letters..).unwrap_or_default();
    let is_numbered = number.starts_with(|it: char| it.is_ascii_digit());
    // `T2f0`: an address has no letter behind its number.
    if is_numbered && number.contains(|it: char| it.is_ascii_alphabetic()) {
        return true;
    }
    // Steps and transitions of a chart, by their usual names.
    let is_named = matches!(text.get(..letters), Some("X" | "S" | "Y")) && !text.contains('.');
    error.suggestion.is_none() && !is_numbered && letters > 1 || is_named || text.contains(|it: char| !it.is_ascii())
}

/// Callee or data block of an operand: as [`bare_text`], without the mark of a symbol.
pub(super) fn block_text(operand: &ast::Operand) -> SmolStr {
    let text = bare_text(operand);
    match text.strip_prefix('-') {
        Some(name) => smol_str::format_smolstr!("\"{name}\""),
        None => text,
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::testing::statements;
    use crate::model::UnitModel;
    use crate::model::entity::{BlockKind, BlockName, Entity};
    use crate::model::layout::{DataType, Elementary};
    use crate::model::object::{Area, Footprint};
    use crate::model::unit::{Callee, OddityKind};
    use crate::syntax::{Language, Mnemonics};

    fn model(text: &str) -> UnitModel {
        let language = Language::Step5(Mnemonics::German);
        let parse = crate::syntax::parse(language, text);
        assert_eq!(parse.errors(), [], "{text}");
        let name = BlockName::Number(BlockKind::Pb, 1);
        super::super::lower(parse.syntax(), Entity::Block { kind: BlockKind::Pb, name }, language)
    }

    fn oddities(text: &str) -> Vec<String> {
        model(&format!("PB 1\n{text}\nBE\n")).oddities.iter().map(|it| format!("{:?}", it.kind)).collect()
    }

    #[test]
    fn tables_of_the_document() {
        // GRF:441-449, 470-480.
        assert_eq!(statements(&model("L Ts\nT Tp\n")), ["Tp := Ts"]);
        let model = model("U t10\nU Tp[10]\nS Ta[11]\nS Td[10]\n***\n");
        let steps = ["set Ta[11] when (t10 & Tp[10])", "set Td[10] when (t10 & Tp[10])"];
        assert_eq!(statements(&model), steps);
        let of = |text: &str| model.objects.iter().find(|it| it.text == text).map(|it| it.footprint.clone());
        assert_eq!(of("Ta[11]"), Some(Footprint::new(Area::Symbol("ta".into()), 11, 1)));
        assert_eq!(of("t10"), Some(Footprint::new(Area::Symbol("t10".into()), 0, 1)));
    }

    #[test]
    fn words_that_are_no_addresses() {
        // GRF:695: tables of the graphs 2 and 3.
        assert_eq!(oddities("L KHFFFF\nT T3f0\nU X11\nS Sto\nU mémoire\n= A 4.0"), [""; 0]);
    }

    #[test]
    fn a_table_shares_memory_with_its_bits() {
        let model = model("U Tp[3]\n= M 1.0\nL KH 0000\nT Tp\nU Tp[3]\n= M 1.1\n");
        let reads: Vec<u32> =
            model.accesses.iter().filter(|it| model.object(it.object).text == "Tp[3]").map(|it| it.version).collect();
        assert_eq!(reads.len(), 2);
        assert_ne!(reads[0], reads[1], "the store changes the bit");
    }

    #[test]
    fn timers_counters_and_comparisons() {
        // GRF:871-890, 807-830.
        let found = statements(&model("UN T2p[21]\nU T2s[21]\nL KT 200.1\nSV T3\n***\nUN T3\n= M 1.0\n"));
        assert_eq!(found, ["start of T3 when (!T2p[21] & T2s[21])", "M1.0 := !T3"]);
        let found = statements(&model("U Ts[10]\nL KZ 10\nS Z1\nU Ts[11]\nZV Z1\n"));
        assert_eq!(found.len(), 2);
        assert_eq!(statements(&model("L Tt\nL KH0000\n!= F\n= M 1.0\n")), ["M1.0 := (Tt = 0)"]);
    }

    #[test]
    fn calls_and_conditional_ends() {
        // GRF:549-560.
        let model = model("L Tt\nL KH0000\n!=F\nBEB\nSPA PB 15\nU M 1.0\nSPB FB 16\nBE\n");
        assert_eq!(statements(&model)[0], "return when (Tt = 0)");
        let callees: Vec<&Callee> = model.calls.iter().map(|it| &it.callee).collect();
        let block = |kind, number| Callee::Block(BlockName::Number(kind, number));
        assert_eq!(callees, [&block(BlockKind::Pb, 15), &block(BlockKind::Fb, 16)]);
        assert!(model.oddities.is_empty(), "{:?}", model.oddities);
    }

    #[test]
    fn jumps_split_the_path() {
        let model = model("U E 0.0\nSPB= fin\nU E 0.1\n= A 4.0\nfin : U E 0.2\n= A 4.1\nBE\n");
        let found = statements(&model);
        assert_eq!(found[1..], ["!E0.0: A4.0 := E0.1", "A4.1 := E0.2", "return when true"]);
    }

    #[test]
    fn oddities_of_the_machine() {
        // GRF:980: set from its own negation.
        assert_eq!(oddities("UN M0.0\nS M0.0\nSPA PB 10"), [""; 0]);
        assert_eq!(oddities("S M0.0"), ["RloFromCaller"]);
        assert_eq!(oddities("SPA PB 2\nS M0.0"), ["RloAfterCall"]);
        // GRF:751: one load, and a word logic with two operands.
        assert_eq!(oddities("L Tf0\nOW\nKEW\nL Ts\nUW\nL Tf1\nOW\nT Ts"), ["MissingOperand(1)"]);
        assert_eq!(oddities("L Td\nKEW\nL Tp\nUW\nL Ta\nOW\nT Ts"), [""; 0]);
        assert_eq!(oddities("SU M 1.0\nP M 1.0\n= A 4.0\nPN E 0.0\n= A 4.1"), [""; 0]);
        assert_eq!(oddities("U(\nU E 0.0\n= A 4.0"), ["UnclosedParenthesis"]);
        let kind = |text: &str| model(&format!("PB 1\n{text}\nBE\n")).oddities.pop().map(|it| it.kind);
        assert!(matches!(kind("U E 1\n= A 4.0"), Some(OddityKind::Address(_))));
        assert!(matches!(kind("U E 0.0\nL KT 10.4\nSE T 1"), Some(OddityKind::Literal(it)) if it.is_s5time));
    }

    #[test]
    fn what_is_computed_is_not_known() {
        let model = model("B MW 10\nU E 0.0\n= A 4.0\nB MW 12\nA DB 0\nL DW 3\nT MW 20\nB MW 10\nSPA PB 0\n");
        assert!(model.reads_indirectly);
        assert_eq!(model.calls[0].callee, Callee::Unknown);
        let data = model.objects.iter().find(|it| it.text == "DW3").map(|it| it.footprint.area.clone());
        assert_eq!(data, Some(Area::OpenData));
        let model = self::model("A DB 5\nL DW 3\nT MW 20\nU D 3.1\n= A 4.0\n");
        let five = Area::Data(BlockName::Number(BlockKind::Db, 5));
        assert_eq!(model.objects.iter().filter(|it| it.footprint.area == five).count(), 2);
    }

    #[test]
    fn formal_operands() {
        let text = "FB 5\nNAME :TEST\nBEZ :EIN  E/A/D/B/T/Z: E  BI/BY/W/D: BI\nBEZ :AUS A BI\n:U =EIN\n:= =AUS\n:BE\n";
        let model = model(text);
        let fields = model.declared.as_ref().map_or(&[][..], DataType::fields).iter();
        let declared: Vec<String> = fields
            .map(|it| format!("{} {:?} {}", it.name, it.section, it.ty.elementary().map_or("", Elementary::name)))
            .collect();
        assert_eq!(declared, ["ein Input BOOL", "aus Output BOOL"]);
        assert_eq!(statements(&model), ["#AUS := #EIN", "return when true"]);
    }
}
