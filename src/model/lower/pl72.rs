//! Operands, comparisons and operations of PL7-2 to the model (PL72:945-1109).

use rowan::TextRange;
use smol_str::SmolStr;

use super::pl7::{Kind, Pl7};
use crate::model::expr::{Comparison, ExprId, ObjectId, Operator};
use crate::model::object::{AddressError, AddressErrorKind, Class, Object, Type, pl72};
use crate::model::unit::{DemandKind, Index, IndexKind, OddityKind, Pin};
use crate::syntax::AstNode as _;
use crate::syntax::pl7::ast::{AssignStmt, BinExpr, BinOp, CallExpr, Expr};
use crate::target::pl72::{ASCII_WORDS, BIT_STRING, Operand, Operation, TRANSFERS};

/// The pin that the name of an input means, by the symbol of the block.
pub(super) fn pin(block: &str, input: &str) -> Pin {
    match (block, input) {
        (_, "R") => Pin::Reset,
        ("T", "E") | ("M" | "TXT", "S") => Pin::Start,
        ("T" | "FC", "C") => Pin::Enable,
        (_, "P") => Pin::Preset,
        ("C", "D") => Pin::Down,
        ("C", "U") => Pin::Up,
        ("D", "U") => Pin::Advance,
        ("R", "I") => Pin::Store,
        ("R", "O") => Pin::Retrieve,
        _ => Pin::Whole,
    }
}

/// What is wrong with a name that can only be meant as an address: `AB5`, and `TMP` which is none.
pub(super) fn mistaken_name(name: &str) -> Option<AddressError> {
    let (letters, number) = name.split_at(name.find(|it: char| it.is_ascii_digit())?);
    let is_address = (1..=3).contains(&letters.len())
        && letters.bytes().all(|it| it.is_ascii_alphabetic())
        && number.bytes().all(|it| it.is_ascii_digit());
    let error = pl72::parse(name).err().filter(|_| is_address)?;
    (error.kind == AddressErrorKind::Malformed).then_some(error)
}

/// What an operand is, as far as operations tell operands apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Form {
    Word,
    Value,
    Indexed,
    /// A string of that many bits.
    Bits(u32),
    /// A table of that many words.
    Words(u32),
    /// Nothing that an operation takes.
    Other,
    /// Reported already, or a name.
    Unknown,
}

impl Form {
    pub(super) fn of(object: &Object) -> Self {
        match (object.class, object.ty) {
            (Class::Indirect | Class::Symbol, _) => Self::Unknown,
            _ if object.indexed => Self::Indexed,
            (_, Type::Word) => Self::Word,
            (_, Type::BitTable(length)) => Self::Bits(length),
            (_, Type::WordTable(length)) => Self::Words(length),
            _ => Self::Other,
        }
    }

    /// Whether it may stand where the table of transfers has the operand.
    fn is(self, operand: Operand) -> bool {
        match operand {
            Operand::Word => self == Self::Word,
            Operand::Value => self == Self::Value,
            Operand::Indexed => self == Self::Indexed,
            Operand::Bits16 => self == Self::Bits(BIT_STRING.last),
            Operand::BitsShort => matches!(self, Self::Bits(length) if length < BIT_STRING.last),
            Operand::Bits => matches!(self, Self::Bits(_)),
            Operand::Words => matches!(self, Self::Words(_)),
        }
    }

    fn describe(self) -> String {
        match self {
            Self::Word => "a word".to_owned(),
            Self::Value => "a value".to_owned(),
            Self::Indexed => "an indexed word".to_owned(),
            Self::Bits(length) => format!("a string of {length} bits"),
            Self::Words(length) => format!("a table of {length} words"),
            Self::Other | Self::Unknown => "neither word nor string".to_owned(),
        }
    }

    /// Whether what a transfer takes has the length of what it fills. Words fill strings of any length.
    fn fits(self, target: Self) -> bool {
        match (self, target) {
            (Self::Bits(a), Self::Bits(b)) | (Self::Words(a), Self::Words(b)) => a == b,
            _ => true,
        }
    }
}

/// A value that an operation reads.
struct Source {
    value: ExprId,
    form: Form,
    range: TextRange,
    text: SmolStr,
}

impl Pl7 {
    /// An object of PL7-2. The read of its index is recorded.
    pub(super) fn word_object(&mut self, address: &str, range: TextRange) -> (ObjectId, TextRange) {
        if let Some(id) = self.b.model.address(address) {
            return (id, range);
        }
        let found = match pl72::parse(address) {
            Ok(found) => found,
            Err(error) => return (self.address_error(error, range, address), range),
        };
        let id = self.b.object(found.object);
        if let Some(index) = found.index {
            let index = self.b.object(index);
            self.b.read(index, range);
            let anchor = self.b.anchor(range);
            self.b.model.indexes.push(Index { what: IndexKind::Object(index), anchor });
        }
        (id, range)
    }

    /// `W5 > 10`: two words, or a word and a value (PL72:956-958).
    pub(super) fn word_comparison(&mut self, it: &BinExpr<'_>) -> ExprId {
        let op = match it.op() {
            Some(BinOp::Eq) => Comparison::Eq,
            Some(BinOp::Ne) => Comparison::Ne,
            Some(BinOp::Lt) => Comparison::Lt,
            Some(BinOp::Le) => Comparison::Le,
            Some(BinOp::Gt) => Comparison::Gt,
            _ => Comparison::Ge,
        };
        let (Some(lhs), Some(rhs)) = (it.lhs(), it.rhs()) else { return self.b.exprs().opaque() };
        let (lhs, rhs) = (self.source(&lhs), self.source(&rhs));
        self.takes(&lhs, false, "the first operand of a comparison", "PL72:956");
        self.takes(&rhs, true, "the second operand of a comparison", "PL72:958");
        self.b.exprs().compare(op, lhs.value, rhs.value)
    }

    /// `W1 + W2 -> W3`, `BTA W0 -> W10`, `127 -> W10`.
    pub(super) fn word_operation(&mut self, it: &AssignStmt<'_>) {
        let range = it.syntax().text_range();
        let Some(value) = it.value() else { return };
        let (value, from, length) = match &value {
            Expr::Bin(operation) => (self.calculation(operation), None, 1),
            Expr::Call(operation) => {
                let is_text = operation.name().is_some_and(|it| it.text().eq_ignore_ascii_case("BTA"));
                (self.conversion(operation), None, if is_text { ASCII_WORDS.value } else { 1 })
            }
            value => {
                let source = self.source(value);
                (source.value, Some(source), 1)
            }
        };
        let Some((object, at)) = it.target().and_then(|it| self.place(&it)) else { return };
        let to = Form::of(self.b.model.object(object));
        let text = self.b.model.object(object).text.clone();
        match from {
            Some(from) => self.transfers(&from, to, &text, at),
            None if !matches!(to, Form::Word | Form::Indexed | Form::Unknown) => {
                let message = format!("the result of a calculation is a word, and `{text}` is {}", to.describe());
                self.b.oddity(OddityKind::OperandType(message), at, text);
            }
            None => {}
        }
        let object = self.table(object, length);
        self.assign(object, value, Kind::Number, at, range);
    }

    /// `W1 + W2` (PL72:1013-1034).
    fn calculation(&mut self, it: &BinExpr<'_>) -> ExprId {
        let (Some(lhs), Some(rhs)) = (it.lhs(), it.rhs()) else { return self.b.exprs().opaque() };
        let (lhs, rhs) = (self.source(&lhs), self.source(&rhs));
        self.takes(&lhs, false, "the first operand of a calculation", "PL72:1017");
        self.takes(&rhs, true, "the second operand of a calculation", "PL72:1019");
        let operator = match it.op() {
            Some(BinOp::Add) => Operator::Add,
            Some(BinOp::Sub) => Operator::Sub,
            Some(BinOp::Mul) => Operator::Mul,
            Some(BinOp::Div) => Operator::Div,
            Some(BinOp::Rem) => Operator::Rem,
            Some(BinOp::And) => Operator::And,
            Some(BinOp::Or) => Operator::Or,
            Some(BinOp::Xor) => Operator::Xor,
            _ => return self.b.exprs().opaque(),
        };
        if !matches!(operator, Operator::And | Operator::Or | Operator::Xor) {
            self.b.computes(it.syntax().text_range());
        }
        if matches!(operator, Operator::Div | Operator::Rem) {
            self.b.demand(DemandKind::Divisor, rhs.value, rhs.range);
        }
        self.b.exprs().binary(operator, lhs.value, rhs.value)
    }

    /// `CPL W1`, `BTA W0`, `SLC 3 W1` (PL72:1027, PL72:1036-1057).
    fn conversion(&mut self, it: &CallExpr<'_>) -> ExprId {
        let Some(name) = it.name() else { return self.b.exprs().opaque() };
        let code = name.text().trim_end_matches(|it: char| it.is_ascii_digit()).to_ascii_uppercase();
        let mut operands: Vec<Expr<'_>> = it.operands().collect();
        let Some(operand) = operands.pop() else { return self.b.exprs().opaque() };
        let mut values: Vec<ExprId> = operands.iter().map(|it| self.expr(it).0).collect();
        if let Ok(bits) = name.text()[code.len()..].parse::<u32>() {
            let bits = self.b.exprs().int(i64::from(bits));
            values.push(bits);
        }
        let source = if code == "ATB" { self.text_source(&operand) } else { self.source(&operand) };
        // The complement takes the second operand of a calculation, which may be a value.
        let takes_value = code == "CPL";
        let line = Operation::of_code(&code).map_or("PL72:1045", |it| it.source);
        self.takes(&source, takes_value, &format!("`{code}`"), line);
        values.push(source.value);
        if code == "CPL" { self.b.exprs().call("NOT", values) } else { self.b.exprs().call(&code, values) }
    }

    /// The words whose characters `ATB` reads, from the first one on (PL72:1057).
    fn text_source(&mut self, expr: &Expr<'_>) -> Source {
        let range = expr.syntax().text_range();
        match self.place(expr) {
            Some((object, at)) => {
                let data = self.b.model.object(object);
                let (form, text) = (Form::of(data), data.text.clone());
                let object = self.table(object, ASCII_WORDS.value);
                Source { value: self.read(object, at), form, range, text }
            }
            None => self.source(expr),
        }
    }

    /// The table of so many words that starts with a word; the word itself where there is none.
    fn table(&mut self, object: ObjectId, words: u32) -> ObjectId {
        let data = self.b.model.object(object);
        if words == 1 || Form::of(data) != Form::Word {
            return object;
        }
        match pl72::parse(&format!("{}[{words}]", data.text)) {
            Ok(table) => self.b.object(table.object),
            Err(_) => object,
        }
    }

    fn source(&mut self, expr: &Expr<'_>) -> Source {
        let range = expr.syntax().text_range();
        let text = SmolStr::new(expr.syntax().text());
        match self.place(expr) {
            Some((object, at)) => {
                let form = Form::of(self.b.model.object(object));
                Source { value: self.read(object, at), form, range, text }
            }
            None => {
                let form = if matches!(expr, Expr::Literal(_) | Expr::Unary(_)) { Form::Value } else { Form::Unknown };
                Source { value: self.expr(expr).0, form, range, text }
            }
        }
    }

    /// Notes an operand that is no word, nor a value where one may stand.
    fn takes(&mut self, it: &Source, or_value: bool, what: &str, source: &str) {
        let is_word = matches!(it.form, Form::Word | Form::Indexed | Form::Unknown);
        if !(is_word || or_value && it.form == Form::Value) {
            let wanted = if or_value { "a word or a value" } else { "a word" };
            let message = format!("{what} is {wanted} ({source}), and `{}` is {}", it.text, it.form.describe());
            self.b.oddity(OddityKind::OperandType(message), it.range, it.text.clone());
        }
    }

    /// Notes a transfer that the table does not have (PL72:1072-1084).
    fn transfers(&mut self, from: &Source, to: Form, text: &str, at: TextRange) {
        if from.form == Form::Unknown || to == Form::Unknown {
            return;
        }
        let is_listed = TRANSFERS.iter().any(|it| from.form.is(it.from) && to.is(it.to));
        let message = if !is_listed {
            format!(
                "nothing transfers `{}`, {}, to `{text}`, {} (PL72:1072-1084)",
                from.text,
                from.form.describe(),
                to.describe()
            )
        } else if !from.form.fits(to) {
            format!("`{}` is {}, and `{text}` {}", from.text, from.form.describe(), to.describe())
        } else {
            return;
        };
        self.b.oddity(OddityKind::OperandType(message), at, text);
    }
}

#[cfg(test)]
mod tests {
    use crate::model::UnitModel;
    use crate::model::chart::Receptivity;
    use crate::model::entity::{Entity, Part, Task};
    use crate::model::lower::testing::{self, show};
    use crate::model::unit::{Mode, OddityKind, StatementKind};
    use crate::syntax::{self, Language};

    fn model(rows: &str) -> UnitModel {
        let text = format!("RUNG L1:\n{rows}\nEND_RUNG");
        let parse = syntax::parse(Language::Pl72Ld, &text);
        assert_eq!(parse.errors(), [], "{text}");
        let entity = Entity::Pl7 { task: Task::Mast, section: None, part: Part::Main };
        super::super::lower(parse.syntax(), &text, entity, Language::Pl72Ld)
    }

    fn statements(rows: &str) -> Vec<String> {
        testing::statements(&model(rows))
    }

    fn operation(operation: &str) -> Vec<String> {
        statements(&format!("H_LINK(7),OPERATE {operation} END_BLOCK;"))
    }

    fn mistakes(rows: &str) -> Vec<String> {
        let message = |it: OddityKind| match it {
            OddityKind::OperandType(message) => message,
            other => format!("{other:?}"),
        };
        model(rows).oddities.into_iter().map(|it| message(it.kind)).collect()
    }

    #[test]
    fn contacts_and_coils() {
        assert_eq!(
            statements(
                "OPEN_CONTACT(I0,05),SHORT_CIRCUIT,CLOSED_CONTACT(W5,A),H_LINK(6),COIL(O1,03);\n\
                 OPEN_CONTACT(X3),CLOSED_CONTACT(SY21),EMPTY_CELL(7),SET_COIL(B12);\n\
                 OPEN_CONTACT(T0,D),H_LINK(8),SAVE_COIL(B13);\nOPEN_CONTACT(%B1),H_LINK(8),JUMP_COIL(L20);"
            ),
            ["O1,03 := ((I0,05 | (X3 & !SY21)) & !W5,A)", "set B12 when false", "B13 := T0,D", "jump when %B1"]
        );
    }

    /// PL72:1022-1057.
    #[test]
    fn operations() {
        assert_eq!(operation("127 -> W10"), ["W10 := 127"]);
        assert_eq!(operation("-5 -> T1,P"), ["T1,P := -5"]);
        assert_eq!(operation("W1 + W2 -> W3"), ["W3 := Add(W1, W2)"]);
        assert_eq!(operation("W1 REM H'10' -> W3"), ["W3 := Rem(W1, 16)"]);
        assert_eq!(operation("W1 XOR L'101' -> COM2,1"), ["COM2,1 := Xor(W1, 5)"]);
        assert_eq!(operation("CPL W1 -> OW1,3"), ["OW1,3 := NOT(W1)"]);
        assert_eq!(operation("BCD W1 -> W2"), ["W2 := BCD(W1)"]);
        assert_eq!(operation("BTA W0 -> W10"), ["W10[3] := BTA(W0)"]);
        assert_eq!(operation("ATB W0 -> W10"), ["W10 := ATB(W0[3])"]);
        assert_eq!(operation("SLC 3 W1 -> W1"), ["W1 := SLC(3, W1)"]);
        assert_eq!(operation("SRC15 W1 -> W2"), ["W2 := SRC(15, W1)"]);
        // PL72:1073-1084.
        for it in [
            "I1,0[16] -> W4",
            "I1,0[16] -> W4(W50)",
            "I1,0[8] -> B0[8]",
            "W3 -> O4,5[5]",
            "W30 -> M2,P",
            "W5 -> W100(W50)",
            "CW5(W0) -> W30",
            "CW10(W0) -> W10(W1)",
            "W512[60] -> W0[60]",
            "51 -> O1,5[8]",
            "127 -> W10(W50)",
        ] {
            assert_eq!(operation(it).len(), 1, "{it}");
            assert_eq!(mistakes(&format!("H_LINK(7),OPERATE {it} END_BLOCK;")), [""; 0], "{it}");
        }
    }

    #[test]
    fn operations_that_the_tables_lack() {
        let count = |it: &str| mistakes(&format!("H_LINK(7),OPERATE {it} END_BLOCK;")).len();
        for it in [
            "B5 -> W3",
            "B0[16] -> B16[16]",
            "B0[8] -> W3",
            "B0[8] -> B16[4]",
            "W0[60] -> W100[20]",
            "W0[5] -> W3",
            "5 -> W0[5]",
            "W0[5] + W1 -> W3",
            "5 + W1 -> W3",
            "W1 + W2 -> B0[8]",
            "BIN 5 -> W1",
            "W1 -> B3",
        ] {
            assert_eq!(count(it), 1, "{it}: {:?}", mistakes(&format!("H_LINK(7),OPERATE {it} END_BLOCK;")));
        }
        assert_eq!(mistakes("COMPARE 5 > W1 END_BLOCK,H_LINK(7),COIL(B0);").len(), 1);
        assert_eq!(mistakes("COMPARE W1 > = 5 END_BLOCK,H_LINK(7),COIL(B0);"), [""; 0]);
        assert_eq!(mistakes("OPEN_CONTACT(B0[8]),H_LINK(8),COIL(B0);").len(), 1);
    }

    #[test]
    fn an_index_is_read_each_time() {
        let it = model("H_LINK(7),OPERATE W5(W10) -> W1 END_BLOCK;\nH_LINK(7),OPERATE W5(W10) -> W2 END_BLOCK;");
        let reads = it.accesses.iter().filter(|a| a.mode == Mode::Read && it.object(a.object).text == "W10");
        assert_eq!((reads.count(), it.indexes.len()), (2, 2));
    }

    /// PL72:626-630: what stands further left is executed before what stands further right in any row.
    #[test]
    fn networks_are_scanned_column_by_column() {
        assert_eq!(
            statements(
                "OPEN_CONTACT(B0),BLOCK(T0),H_LINK(6),COIL(B1);\nEMPTY_CELL(9),EMPTY_CELL;\n\
                 OPEN_CONTACT(B2),BLOCK(C0),H_LINK(6),COIL(B3);\nOPEN_CONTACT(B4),EMPTY_CELL(9);"
            ),
            ["start of T0 when B0", "reset of C0 when B2", "preset of C0 when B4", "B1 := T0,D", "B3 := C0,E"]
        );
        let exposed = |rows: &str, name: &str| -> Vec<bool> {
            let it = model(rows);
            let reads = it.accesses.iter().filter(|a| a.mode == Mode::Read && it.object(a.object).text == name);
            reads.map(|it| it.exposed).collect()
        };
        // A coil is behind all contacts of its network.
        let rows = "OPEN_CONTACT(B0),H_LINK(8),COIL(B5);\nOPEN_CONTACT(B5),H_LINK(8),COIL(B6);";
        assert_eq!(exposed(rows, "B5"), [true]);
        // An operation starts in the eighth column, where a contact of the ninth finds its result.
        let rows = "H_LINK(7),OPERATE 5 -> W0 END_BLOCK;\nH_LINK(8),OPEN_CONTACT(W0,1),COIL(B6);";
        assert_eq!(exposed(rows, "W0,1"), [false]);
        let rows = "H_LINK(7),OPERATE 5 -> W0 END_BLOCK;\nH_LINK(6),OPEN_CONTACT(W0,1),H_LINK(2),COIL(B6);";
        assert_eq!(exposed(rows, "W0,1"), [true]);
    }

    #[test]
    fn blocks() {
        assert_eq!(statements("OPEN_CONTACT(B0),BLOCK(M2),H_LINK(6),COIL(B1);"), ["start of M2 when B0", "B1 := M2,R"]);
        assert_eq!(statements("OPEN_CONTACT(B0),BLOCK(WEEK(W1,W2,CW3)),H_LINK(6),COIL(B1);"), ["B1 := ?"]);
        assert_eq!(statements("OPEN_CONTACT(B0),BLOCK(YEAR),H_LINK(6),COIL(B1);"), ["B1 := ?"]);
        assert_eq!(
            statements(
                "OPEN_CONTACT(B0),BLOCK(FC),H_LINK(6),COIL(B1);\nOPEN_CONTACT(B2),EMPTY_CELL(9);\n\
                 EMPTY_LINE;\nOPEN_CONTACT(B3),EMPTY_CELL(9);"
            ),
            ["reset of FC when B0", "preset of FC when B2", "enable of FC when B3", "B1 := FC,E"]
        );
        assert_eq!(
            statements("OPEN_CONTACT(B0),BLOCK(D1),H_LINK(6),COIL(B1);\nOPEN_CONTACT(B2),EMPTY_CELL(9);"),
            ["reset of D1 when B0", "advance of D1 when B2", "B1 := D1,F"]
        );
    }

    #[test]
    fn addresses_that_are_none() {
        for rows in [
            "OPEN_CONTACT(%M5),H_LINK(8),COIL(B0);",
            "OPEN_CONTACT(AB5),H_LINK(8),COIL(B0);",
            "OPEN_CONTACT(I0.05),H_LINK(8),COIL(B0);",
            "OPEN_CONTACT(B256),H_LINK(8),COIL(B0);",
        ] {
            let it = model(rows);
            assert!(matches!(it.oddities.as_slice(), [one] if matches!(one.kind, OddityKind::Address(_))), "{rows}");
        }
        assert!(model("OPEN_CONTACT(Marche),H_LINK(8),COIL(B0);").oddities.is_empty());
        assert!(model("OPEN_CONTACT(D1, F),H_LINK(8),COIL(B0);").oddities.is_empty());
    }

    fn unit(address: &str, text: &str, language: Language) -> UnitModel {
        let parse = syntax::parse(language, text);
        assert_eq!(parse.errors(), [], "{text}");
        let entity = crate::source::entity_from_address(address).unwrap_or_else(|| panic!("{address}"));
        super::super::lower(parse.syntax(), text, entity, language)
    }

    fn receptivities(model: &UnitModel) -> Vec<String> {
        let chart = model.chart.as_deref().unwrap_or_else(|| panic!("a chart"));
        let show = |it: &crate::model::chart::Transition| match it.receptivity {
            Receptivity::Value(value) => show(model, value),
            other => format!("{other:?}"),
        };
        chart.transitions.iter().map(show).collect()
    }

    /// `path: object` of each write.
    fn writes(model: &UnitModel) -> Vec<String> {
        let writes = model.accesses.iter().filter(|it| it.mode.writes());
        let path = |it| model.statement(it).map_or_else(String::new, |it| show(model, it.path));
        writes.map(|it| format!("{}: {}", path(it), model.object(it.object).text)).collect()
    }

    /// PL72:1421-1500: a network is the action of a step, another one the receptivity of a transition.
    #[test]
    fn pages() {
        let rung = |row: &str| format!("RUNG\n{row};\nEND_RUNG\n");
        let text = format!(
            "PAGE 0\nINITIAL_STEP 0 AT (C0,L1) :\nACTION (N1,LD) :\n{}END_ACTION\nEND_STEP\n\
             TRANSITION (LD) AT (C 0,L 2) :\n{}END_TRANSITION\nSTEP 3 AT (C 0,L 3) : END_STEP\n\
             TRANSITION (LD) AT (C 0,L 4) :\n{}END_TRANSITION\nDEST_CONNECTOR 0 AT (C 0,L 5)\nEND_PAGE\n",
            rung("OPEN_CONTACT(B1),H_LINK(8),COIL(O0,03)"),
            rung("OPEN_CONTACT(I0,05),SHORT_CIRCUIT(8);\nOPEN_CONTACT(X0),H_LINK(8)"),
            rung("COMPARE X3,V > 10 END_BLOCK,H_LINK(7),HASH_COIL"),
        );
        let it = unit("PL7-2 SEQ", &text, Language::Pl72Gr7);
        assert_eq!(receptivities(&it), ["(I0,05 | X0)", "(X3,V > 10)"]);
        assert_eq!(writes(&it), ["X0: O0,03"]);
        assert!(it.oddities.is_empty(), "{:?}", it.oddities);
        let chart = it.chart.as_deref().unwrap_or_else(|| panic!("a chart"));
        assert_eq!(
            chart.transitions.iter().map(|it| (it.sources.len(), it.targets.len())).collect::<Vec<_>>(),
            [(1, 1); 2]
        );
    }

    #[test]
    fn charts_as_text() {
        let text = "INITIAL_STEP X0 : END_STEP\nSTEP X1 : Fill(N); O1,03(S); END_STEP\nSTEP X2 : A1(N); END_STEP\n\
                    TRANSITION FROM X0 TO (X1,X2) := I0,05 AND NOT B3; END_TRANSITION\n\
                    TRANSITION FROM (X1,X2) TO X0 := X1,V > 10; END_TRANSITION\n\
                    ACTION Fill : O0,03 := I0,06; END_ACTION\nACTION A1 : SET B1; END_ACTION\n";
        let it = unit("PL7-2 SEQ", text, Language::Pl72Sfc);
        assert_eq!(receptivities(&it), ["(I0,05 & !B3)", "(X1,V > 10)"]);
        assert_eq!(writes(&it), ["X1: O0,03", "X2: B1", "true: O1,03"]);
        assert!(it.oddities.is_empty(), "{:?}", it.oddities);
    }

    /// Networks under headings that name a step or a transition.
    #[test]
    fn pieces() {
        let action = "LD : PL7-2 - SEQ - X3\nRUNG\nH_LINK(9),COIL(O0,03);\nEND_RUNG\n";
        assert_eq!(writes(&unit("PL7-2 - SEQ - X3", action, Language::Pl72Ld)), ["X3: O0,03"]);
        let receptivity = "LD : PL7-2 - SEQ - X3 --> X4\nRUNG\nOPEN_CONTACT(I0,05),H_LINK(8);\nEND_RUNG\n";
        let it = unit("PL7-2 - SEQ - X3 --> X4", receptivity, Language::Pl72Ld);
        let branch = it.statements.iter().find_map(|it| match it.kind {
            StatementKind::Branch { condition, .. } => Some((it.path, condition)),
            _ => None,
        });
        assert_eq!(
            branch.map(|(path, it_)| (show(&it, path), show(&it, it_))),
            Some(("X3".to_owned(), "I0,05".to_owned()))
        );
        assert!(it.oddities.is_empty(), "{:?}", it.oddities);
        // Elsewhere, a line that ends before the coils leads nowhere.
        let open = unit("PL7-2 - POST", "RUNG L1:\nOPEN_CONTACT(I0,05),H_LINK(8);\nEND_RUNG\n", Language::Pl72Ld);
        assert_eq!(open.oddities.len(), 1);
    }
}
