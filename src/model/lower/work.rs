//! Elements of a network of PL7-2, as the tables of times and sizes have them (PL72:1915-1972).

use std::borrow::Cow;

use super::pl72::Form;
use crate::model::UnitModel;
use crate::model::ladder::{BlockShape, Layout};
use crate::model::object::pl72::{self, ChannelItem};
use crate::model::object::{Area, Class, Object};
use crate::syntax::pl7::ast::{AssignStmt, BinOp, CallExpr, Cell, Expr, Rung, Stmt};
use crate::syntax::pl7::ladder_words::Element as Word;
use crate::target::pl72::{ASCII_DIGITS, BlockKind, Element, NEAR_BITS};

pub(super) struct Elements<'m> {
    /// What the network is lowered to has its objects.
    model: &'m UnitModel,
    pub(super) listed: Vec<(Element, u32)>,
    pub(super) unlisted: u32,
}

impl<'m> Elements<'m> {
    /// `model`: has what was met so far.
    pub(super) fn of(rung: Rung<'_>, model: &'m UnitModel) -> Self {
        let mut elements = Self { model, listed: Vec::new(), unlisted: 0 };
        for cell in rung.rows().flat_map(|it| it.cells()) {
            elements.add_cell(cell);
        }
        elements
    }

    fn add(&mut self, element: Option<Element>) {
        self.add_each(element.map(|it| (it, 0)));
    }

    fn add_each(&mut self, element: Option<(Element, u32)>) {
        match element {
            Some(element) => self.listed.push(element),
            None => self.unlisted += 1,
        }
    }

    fn add_cell(&mut self, cell: Cell<'_>) {
        match cell.element() {
            Some(Word::Open | Word::Closed | Word::Rising | Word::Falling) => {
                self.add(self.operand(cell).and_then(|it| contact(&it)));
            }
            Some(Word::VLink | Word::ShortCircuit) => self.add(Some(Element::VerticalLink)),
            Some(Word::Coil | Word::SaveCoil) => self.add(self.operand(cell).and_then(|it| coil(&it))),
            Some(Word::NotCoil | Word::SetCoil | Word::ResetCoil) => {
                self.add(self.operand(cell).and_then(|it| coil(&it)));
                self.add(Some(Element::CoilSupplement));
            }
            Some(Word::Jump) => self.add(Some(Element::Jump)),
            Some(Word::Compare) => self.add(Some(Element::Comparison)),
            Some(Word::Operate) => {
                for statement in cell.operations() {
                    self.add_each(match statement {
                        Stmt::Assign(it) => self.operation(&it),
                        _ => None,
                    });
                }
            }
            Some(Word::Block) => self.add(block(cell)),
            // The tables have no row for the coil of a receptivity, which is no action.
            Some(Word::HLink | Word::EmptyCell | Word::EmptyLine | Word::HashCoil) => {}
            Some(Word::Call | Word::Return | Word::Halt | Word::Actual) | None => self.unlisted += 1,
        }
    }

    fn operand(&self, cell: Cell<'_>) -> Option<Cow<'m, Object>> {
        self.object(&cell.operand()?)
    }

    fn object(&self, expr: &Expr<'_>) -> Option<Cow<'m, Object>> {
        let Expr::Object(it) = expr else { return None };
        let address = it.address();
        match self.model.address(&address) {
            Some(id) => Some(Cow::Borrowed(self.model.object(id))),
            None => Some(Cow::Owned(pl72::parse(&address).ok()?.object)),
        }
    }

    fn form(&self, expr: &Expr<'_>) -> Form {
        match expr {
            Expr::Literal(_) | Expr::Unary(_) => Form::Value,
            _ => self.object(expr).map_or(Form::Unknown, |it| Form::of(&it)),
        }
    }

    /// PL72:1956-1971.
    fn operation(&self, it: &AssignStmt<'_>) -> Option<(Element, u32)> {
        match it.value()? {
            Expr::Bin(it) => Some((
                match it.op()? {
                    BinOp::Add | BinOp::Sub | BinOp::And | BinOp::Or | BinOp::Xor => Element::AddOrLogic,
                    BinOp::Mul => Element::Multiply,
                    BinOp::Div => Element::Divide,
                    _ => return None,
                },
                0,
            )),
            Expr::Call(it) => conversion(&it),
            value => transfer(self.form(&value), self.form(&it.target()?)),
        }
    }
}

/// PL72:1919-1924. Of a TSX 17-20, `Sx,j` is taken for a fault bit as those of the others are.
fn contact(object: &Object) -> Option<Element> {
    if object.extracted {
        return Some(Element::ContactFarBit);
    }
    Some(match object.class {
        Class::Input | Class::Output => match pl72::channel(&object.text)? {
            it if matches!(it.item, ChannelItem::Decimal(_)) && it.is_output => Element::ContactOutput17,
            it if matches!(it.item, ChannelItem::Decimal(_)) => Element::ContactInput17,
            it if it.rack == 0 => Element::ContactRack0,
            _ => Element::ContactRack1,
        },
        Class::Memory if NEAR_BITS.contains(object.footprint.start) => Element::ContactBit,
        Class::BlockBit if matches!(object.footprint.area, Area::Block("TXT", _)) => Element::ContactFarBit,
        Class::Step | Class::System | Class::BlockBit => Element::ContactBit,
        Class::Memory | Class::Fault => Element::ContactFarBit,
        _ => return None,
    })
}

/// PL72:1947-1953.
fn coil(object: &Object) -> Option<Element> {
    if object.extracted {
        return Some(Element::CoilWordBit);
    }
    Some(match object.class {
        Class::Output => match pl72::channel(&object.text)? {
            it if matches!(it.item, ChannelItem::Decimal(_)) => Element::CoilOutput17,
            it if it.rack == 0 => Element::CoilRack0,
            _ => Element::CoilRack1,
        },
        Class::Memory if NEAR_BITS.contains(object.footprint.start) => Element::CoilBit,
        Class::Memory => Element::CoilFarBit,
        Class::Step | Class::System => Element::CoilStepOrSystem,
        _ => return None,
    })
}

/// PL72:1925-1933. A text block is taken for the complete one, of which the simple one is a part.
fn block(cell: Cell<'_>) -> Option<Element> {
    let BlockShape::Pl72(block) = Layout::Pl72.block_of(cell)? else { return None };
    Some(match block.kind {
        BlockKind::Monostable => Element::Monostable,
        BlockKind::Timer => Element::Timer,
        BlockKind::Counter => Element::Counter,
        BlockKind::FastCounter => Element::FastCounter,
        BlockKind::Register => Element::Register,
        BlockKind::Drum => Element::Drum,
        BlockKind::SimpleText => Element::SimpleText,
        BlockKind::CompleteText => Element::CompleteText,
        BlockKind::Clock => Element::Clock,
    })
}

fn conversion(it: &CallExpr<'_>) -> Option<(Element, u32)> {
    let name = it.name()?.text().to_ascii_uppercase();
    let code = name.trim_end_matches(|it: char| it.is_ascii_digit());
    Some(match code {
        "CPL" => (Element::Complement, 0),
        "BIN" => (Element::BcdToBinary, 0),
        "BCD" => (Element::BinaryToBcd, 0),
        "BTA" | "ATB" => (Element::AsciiConversion, ASCII_DIGITS.value),
        "SLC" | "SRC" => {
            let glued = name.get(code.len()..).and_then(|it| it.parse().ok());
            let apart = || match it.operands().next()? {
                Expr::Literal(it) => it.token()?.text().parse().ok(),
                _ => None,
            };
            (Element::Rotate, glued.or_else(apart)?)
        }
        _ => return None,
    })
}

/// The row of a transfer, where there is none the one of the nearest: any transfer with an index counts as that of a word to
/// an indexed word, that of a word or value to a string as that of a string.
fn transfer(from: Form, to: Form) -> Option<(Element, u32)> {
    Some(match (from, to) {
        (Form::Value, Form::Word) => (Element::ValueToWord, 0),
        (Form::Word, Form::Word) => (Element::WordToWord, 0),
        (Form::Word | Form::Value | Form::Indexed, Form::Indexed) | (Form::Indexed, Form::Word) => {
            (Element::WordToIndexed, 0)
        }
        (Form::Bits(_), Form::Word | Form::Indexed) => (Element::BitsToWord, 0),
        (Form::Bits(_) | Form::Word | Form::Value, Form::Bits(length)) => (Element::BitsToBits, length),
        (Form::Words(_), Form::Words(length)) => (Element::WordsToWords, length),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::entity::{Entity, Part, Task};
    use crate::model::work::CodeKind;
    use crate::syntax::{self, Language};

    fn elements(rows: &str) -> (Vec<(Element, u32)>, u32) {
        let parse = syntax::parse(Language::Pl72Ld, &format!("RUNG L1:\n{rows}\nEND_RUNG"));
        assert_eq!(parse.errors(), [], "{rows}");
        let entity = Entity::Pl7 { task: Task::Mast, section: None, part: Part::Main };
        let mut model = super::super::lower(parse.syntax(), rows, entity, Language::Pl72Ld);
        let network = model.networks.pop().expect("a network");
        (network.elements, network.unlisted)
    }

    fn one(rows: &str) -> Option<(Element, u32)> {
        match elements(rows) {
            (listed, 0) if listed.len() == 1 => listed.first().copied(),
            _ => None,
        }
    }

    #[test]
    fn contacts_and_coils_by_object() {
        let contact = |object: &str| one(&format!("OPEN_CONTACT({object}),EMPTY_CELL(9);")).map(|it| it.0);
        for (object, expected) in [
            ("I0,05", Element::ContactInput17),
            ("I0,24", Element::ContactInput17),
            ("O1,05", Element::ContactOutput17),
            ("I1,A", Element::ContactRack0),
            ("O02,3", Element::ContactRack0),
            ("I12,3", Element::ContactRack1),
            ("B127", Element::ContactBit),
            ("B128", Element::ContactFarBit),
            ("W5,A", Element::ContactFarBit),
            ("TXT0,D", Element::ContactFarBit),
            ("O2,S", Element::ContactFarBit),
            ("T0,D", Element::ContactBit),
            ("SY6", Element::ContactBit),
            ("X3", Element::ContactBit),
        ] {
            assert_eq!(contact(object), Some(expected), "{object}");
        }
        let coil = |word: &str, object: &str| elements(&format!("H_LINK(9),{word}({object});")).0;
        assert_eq!(coil("COIL", "O0,03"), [(Element::CoilOutput17, 0)]);
        assert_eq!(coil("COIL", "O2,3"), [(Element::CoilRack0, 0)]);
        assert_eq!(coil("SAVE_COIL", "O12,3"), [(Element::CoilRack1, 0)]);
        assert_eq!(coil("SET_COIL", "B127"), [(Element::CoilBit, 0), (Element::CoilSupplement, 0)]);
        assert_eq!(coil("NOT_COIL", "B128"), [(Element::CoilFarBit, 0), (Element::CoilSupplement, 0)]);
        assert_eq!(coil("COIL", "W5,A"), [(Element::CoilWordBit, 0)]);
        assert_eq!(coil("RESET_COIL", "SY19"), [(Element::CoilStepOrSystem, 0), (Element::CoilSupplement, 0)]);
    }

    #[test]
    fn blocks_and_operations() {
        let operation = |text: &str| one(&format!("H_LINK(7),OPERATE {text} END_BLOCK;"));
        for (text, expected) in [
            ("W1 + W2 -> W3", (Element::AddOrLogic, 0)),
            ("W1 * 2 -> W3", (Element::Multiply, 0)),
            ("W1 / W2 -> W3", (Element::Divide, 0)),
            ("CPL W2 -> W3", (Element::Complement, 0)),
            ("BIN W2 -> W3", (Element::BcdToBinary, 0)),
            ("BCD W2 -> W3", (Element::BinaryToBcd, 0)),
            ("BTA W0 -> W10", (Element::AsciiConversion, 5)),
            ("SLC 3 W1 -> W1", (Element::Rotate, 3)),
            ("SRC4 W1 -> W1", (Element::Rotate, 4)),
            ("W1 -> T0,P", (Element::WordToWord, 0)),
            ("127 -> W10", (Element::ValueToWord, 0)),
            ("W5 -> W100(W50)", (Element::WordToIndexed, 0)),
            ("CW5(W0) -> W30", (Element::WordToIndexed, 0)),
            ("I1,0[16] -> W4", (Element::BitsToWord, 0)),
            ("I1,0[8] -> B0[8]", (Element::BitsToBits, 8)),
            ("51 -> O1,5[4]", (Element::BitsToBits, 4)),
            ("W512[60] -> W0[60]", (Element::WordsToWords, 60)),
        ] {
            assert_eq!(operation(text), Some(expected), "{text}");
        }
        // The table has no row for the remainder.
        assert_eq!(elements("H_LINK(7),OPERATE W1 REM W2 -> W3 END_BLOCK;"), (vec![], 1));
        let rows = "OPEN_CONTACT(B0),BLOCK(T0),SHORT_CIRCUIT,COMPARE W5 > 10 END_BLOCK,H_LINK(3),COIL(B1);\n\
                    EMPTY_CELL(3),H_LINK(6),JUMP_COIL(L20);";
        let expected = [
            Element::ContactBit,
            Element::Timer,
            Element::VerticalLink,
            Element::Comparison,
            Element::CoilBit,
            Element::Jump,
        ];
        assert_eq!(elements(rows), (expected.map(|it| (it, 0)).to_vec(), 0));
    }

    #[test]
    fn networks_of_a_unit() {
        let text = "LD : PL7-2 - MAST\nRUNG L1:\n(* pump *)\nOPEN_CONTACT(B0),H_LINK(8),JUMP_COIL(L2);\nEND_RUNG\n\
                    RUNG L2:\nOPEN_CONTACT(B0),H_LINK(8),COIL(B1);\nEND_RUNG\n";
        let parse = syntax::parse(Language::Pl72Ld, text);
        let entity = Entity::Pl7 { task: Task::Mast, section: None, part: Part::Main };
        let model = super::super::lower(parse.syntax(), text, entity, Language::Pl72Ld);
        let [first, second] = model.networks.as_slice() else { panic!("{:?}", model.networks) };
        assert_eq!((first.kind, first.piece, first.comment), (CodeKind::Section, 0, 4));
        assert_eq!((first.labels.clone(), first.jumps.clone()), (0..1, 0..1));
        assert_eq!((second.piece, second.labels.clone(), second.jumps.clone()), (0, 1..2, 1..1));
    }
}
