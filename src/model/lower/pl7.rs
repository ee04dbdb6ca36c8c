//! What the languages of PL7 share: operands, expressions, numeric operations, calls.

use crate::syntax::AstNode as _;
use rowan::TextRange;
use smol_str::SmolStr;

use super::builder::{Builder, index};
use super::dfb;
use crate::model::entity::Entity;
use crate::model::expr::{Comparison, ExprId, Exprs, ObjectId, Operator};
use crate::model::literal::{self, Value};
use crate::model::object::{self, AddressErrorKind, Area, Class, Footprint, Object, Rights, Type};
use crate::model::pl7_kinds;
use crate::model::unit::{
    Actual, Call, Callee, Constant, DeadCause, DemandKind, Formal, Given, Index, IndexKind, Leave, Mode, OddityKind,
    Pin, Slot, StatementKind,
};
use crate::syntax::pl7::ast::{self, BinOp, Expr, UnaryOp};
use crate::syntax::pl7::functions::{self, Function};
use crate::syntax::{Language, SyntaxKind, SyntaxNode, WalkEvent};

/// What kind of value an expression has, as far as it shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Bit,
    /// Word, double word or table of them; also what is some number.
    Number,
    /// Floating-point number, or table of them.
    Float,
    Unknown,
}

impl Kind {
    pub(super) fn is_number(self) -> bool {
        matches!(self, Self::Number | Self::Float)
    }

    /// Whether a floating-point number meets another, so that someone has to look.
    fn may_mix(self, other: Self) -> bool {
        matches!((self, other), (Self::Float, Self::Number) | (Self::Number, Self::Float))
    }
}

pub(super) struct Pl7 {
    /// In a box, because a chart hands it from piece of code to piece of code.
    pub(super) b: Box<Builder>,
    /// The interface of a DFB type, by its names; empty elsewhere.
    pub(super) items: dfb::Items,
}

/// The heading line, else the first sentence's first token.
fn heading(node: SyntaxNode<'_>) -> TextRange {
    let root = ast::Root::cast(node);
    let heading = root.as_ref().and_then(|it| it.headings().next()).map(|it| it.syntax().text_range());
    let rung = || Some(root.as_ref()?.rungs().next()?.keyword()?.text_range());
    let first = || {
        let sentence = root.as_ref()?.sentences().next()?;
        let mut tokens = sentence.syntax().descendant_tokens();
        Some(tokens.find(|it| !it.kind().is_trivia())?.text_range())
    };
    let token = || node.descendant_tokens().find(|it| !it.kind().is_trivia()).map(|it| it.text_range());
    heading.or_else(first).or_else(rung).or_else(token).unwrap_or_default()
}

impl Pl7 {
    pub(super) fn new(root: SyntaxNode<'_>, entity: Entity, language: Language) -> Self {
        let b = Box::new(Builder::new(entity, language, heading(root), root.text_range().len()));
        let mut pl7 = Self { b, items: dfb::Items::default() };
        dfb::enter(&mut pl7, root);
        pl7
    }

    /// Whether operands are those of PL7-2.
    pub(super) fn is_pl7_2(&self) -> bool {
        self.b.model.language.is_pl7_2()
    }

    /// A direct object, as an address without index names it.
    pub(super) fn address(&self, text: &str) -> Result<Object, object::AddressError> {
        if self.is_pl7_2() { object::pl72::parse(text).map(|it| it.object) } else { object::pl7::parse(text) }
    }

    pub(super) fn address_error(&mut self, error: object::AddressError, range: TextRange, text: &str) -> ObjectId {
        self.b.oddity(OddityKind::Address(error), range, text);
        self.b.object(Object {
            text: text.into(),
            class: Class::Indirect,
            ty: Type::Unknown,
            footprint: Footprint::new(Area::Indirect, 0, 1),
            rights: Rights::Unknown,
            extracted: false,
            indexed: false,
        })
    }

    /// A direct object. Reads of its index are recorded.
    pub(super) fn object_ref(&mut self, it: &ast::ObjectRef) -> (ObjectId, TextRange) {
        let range = it.syntax().text_range();
        let address = it.address();
        if self.is_pl7_2() {
            return self.word_object(&address, range);
        }
        let index = if it.syntax().is_leaf() { None } else { it.index() };
        if index.is_none()
            && let Some(id) = self.b.model.address(&address)
        {
            return (id, range);
        }
        let mut added = None;
        let parsed = match index {
            Some(index) => {
                added = self.index(index);
                object::pl7::parse_indexed(&address, it.suffix().as_deref()).map(|mut object| {
                    object.text = it.syntax().text().into_owned().split_whitespace().collect::<String>().into();
                    object
                })
            }
            None => object::pl7::parse(&address),
        };
        let id = match parsed {
            Ok(object) => self.b.object(object),
            Err(error) => return (self.address_error(error, range, &address), range),
        };
        if let Some(value) = added {
            self.b.demand(DemandKind::Index(id), value, range);
        }
        (id, range)
    }

    /// Records an index and its reads, and gives its value.
    fn index(&mut self, index: ast::Index<'_>) -> Option<ExprId> {
        let expr = index.expr()?;
        let (what, value) = match self.place(&expr) {
            Some((object, range)) => (IndexKind::Object(object), self.read(object, range)),
            None => {
                let (value, _) = self.expr(&expr);
                let what = match *self.b.exprs().get(value) {
                    crate::model::expr::Expr::Int(value) => IndexKind::Constant(value),
                    _ => IndexKind::Computed,
                };
                (what, value)
            }
        };
        let anchor = self.b.anchor(expr.syntax().text_range());
        self.b.model.indexes.push(Index { what, anchor });
        Some(value)
    }

    /// A symbol or an item of a DFB instance.
    pub(super) fn name_ref(&mut self, it: &ast::NameRef) -> (ObjectId, TextRange) {
        let range = it.syntax().text_range();
        let path = it.path();
        let indexed = it.index();
        let added = indexed.and_then(|it| self.index(it));
        let own = dfb::object(&self.items, &path, indexed.is_some());
        if self.is_pl7_2()
            && let Some(error) = super::pl72::mistaken_name(&path)
        {
            return (self.address_error(error, range, &path), range);
        }
        if own.is_none()
            && let Some(suggestion) = object::pl7::suggest(&path).filter(|_| !self.is_pl7_2())
        {
            let message = format!("`{path}` lacks its percent sign");
            let error =
                object::AddressError { kind: AddressErrorKind::Malformed, message, suggestion: Some(suggestion) };
            return (self.address_error(error, range, &path), range);
        }
        let mut object = own.unwrap_or_else(|| Object::symbol(&path));
        if indexed.is_some() {
            object.indexed = true;
            object.text = it.syntax().text().into_owned().split_whitespace().collect::<String>().into();
        }
        if let Some(suffix) = it.suffix() {
            object.extracted = suffix.to_ascii_uppercase().starts_with(":X");
            if object.extracted {
                object.ty = Type::Bool;
            }
        }
        let id = self.b.object(object);
        if let Some(value) = added {
            self.b.demand(DemandKind::Index(id), value, range);
        }
        (id, range)
    }

    pub(super) fn ty(&self, object: ObjectId) -> Type {
        self.b.model.object(object).ty
    }

    pub(super) fn kind(&self, object: ObjectId) -> Kind {
        match self.ty(object) {
            Type::Bool => Kind::Bit,
            Type::Unknown => Kind::Unknown,
            Type::Float | Type::FloatTable(_) => Kind::Float,
            _ => Kind::Number,
        }
    }

    /// Records a read of an object.
    pub(super) fn read(&mut self, object: ObjectId, range: TextRange) -> ExprId {
        if self.b.model.object(object).class == Class::Indirect {
            return self.b.exprs().opaque();
        }
        self.b.read(object, range)
    }

    /// The object that an expression is, when it is nothing else.
    pub(super) fn place(&mut self, expr: &Expr) -> Option<(ObjectId, TextRange)> {
        match expr {
            Expr::Object(it) => Some(self.object_ref(it)),
            Expr::Name(it) => Some(self.name_ref(it)),
            Expr::Paren(it) => self.place(&it.expr()?),
            _ => None,
        }
    }

    pub(super) fn literal(&mut self, it: &ast::Literal) -> (ExprId, Kind) {
        let Some(token) = it.token() else { return (self.b.exprs().opaque(), Kind::Unknown) };
        let range = token.text_range();
        let value = if self.is_pl7_2() && token.kind() != SyntaxKind::Ident {
            literal::parse_pl72(token.text())
        } else {
            literal::parse_pl7(token.text())
        };
        match value {
            Ok(Value::Bool(value)) => (Exprs::bool(value), Kind::Bit),
            Ok(Value::Int { value, .. }) => (self.b.exprs().int(value), Kind::Number),
            Ok(Value::Real(value)) => (self.b.exprs().float(value), Kind::Float),
            Ok(Value::Count(value)) => (self.b.exprs().int(i64::from(value)), Kind::Number),
            Ok(value) => {
                let text = SmolStr::new(token.text());
                let expr = self.b.exprs().text(&text);
                if matches!(value, Value::Time { .. } | Value::S5Time { .. }) {
                    self.b.model.constants.push(Constant { value, range, text });
                }
                (expr, Kind::Number)
            }
            Err(error) => {
                self.b.oddity(OddityKind::Literal(error), range, token.text());
                (self.b.exprs().opaque(), Kind::Unknown)
            }
        }
    }

    /// Evaluates an expression: records its reads, gives its value. The tree's depth is limited by the parser.
    pub(super) fn expr(&mut self, expr: &Expr) -> (ExprId, Kind) {
        match expr {
            Expr::Literal(it) => self.literal(it),
            Expr::Object(it) => {
                let (object, range) = self.object_ref(it);
                (self.read(object, range), self.kind(object))
            }
            Expr::Name(it) => {
                let (object, range) = self.name_ref(it);
                (self.read(object, range), self.kind(object))
            }
            Expr::Paren(it) => match it.expr() {
                Some(inner) => self.expr(&inner),
                None => (self.b.exprs().opaque(), Kind::Unknown),
            },
            Expr::Unary(it) => self.unary(it),
            Expr::Bin(it) => self.binary(it),
            Expr::Call(it) => self.call_expr(it),
        }
    }

    fn optional(&mut self, expr: Option<Expr>) -> (ExprId, Kind) {
        match expr {
            Some(expr) => self.expr(&expr),
            None => (self.b.exprs().opaque(), Kind::Unknown),
        }
    }

    fn unary(&mut self, it: &ast::UnaryExpr) -> (ExprId, Kind) {
        let Some(operand) = it.operand() else { return (self.b.exprs().opaque(), Kind::Unknown) };
        match it.op() {
            Some(UnaryOp::Re | UnaryOp::Fe) => {
                let rising = it.op() == Some(UnaryOp::Re);
                match self.place(&operand) {
                    Some((object, range)) => (self.b.edge(object, rising, range), Kind::Bit),
                    None => {
                        self.expr(&operand);
                        (self.b.exprs().opaque(), Kind::Bit)
                    }
                }
            }
            Some(UnaryOp::Not) => {
                let (value, kind) = self.expr(&operand);
                match kind {
                    Kind::Number | Kind::Float => (self.b.exprs().call("NOT", vec![value]), kind),
                    _ => (self.b.exprs().not(value), kind),
                }
            }
            Some(UnaryOp::Minus) => {
                // `-32768` is one constant: its digits alone are out of range.
                if let Expr::Literal(literal) = &operand
                    && let Some(token) = literal.token()
                    && let Ok(Value::Int { value, .. }) = literal::parse_pl7(&format!("-{}", token.text()))
                {
                    return (self.b.exprs().int(value), Kind::Number);
                }
                let (value, kind) = self.expr(&operand);
                (self.b.exprs().negate(value), if kind == Kind::Float { kind } else { Kind::Number })
            }
            Some(UnaryOp::Plus) | None => self.expr(&operand),
        }
    }

    fn binary(&mut self, it: &ast::BinExpr) -> (ExprId, Kind) {
        let (lhs, rhs) = it.operands();
        let (a, a_kind) = self.optional(lhs);
        let (b, b_kind) = self.optional(rhs);
        let numeric = a_kind.is_number() || b_kind.is_number();
        self.b.model.mixes_floats |= a_kind.may_mix(b_kind);
        let number = if [a_kind, b_kind].contains(&Kind::Float) { Kind::Float } else { Kind::Number };
        let kind = match (a_kind, b_kind) {
            (Kind::Bit, _) | (_, Kind::Bit) => Kind::Bit,
            _ => Kind::Unknown,
        };
        let Some(op) = it.op() else { return self.optional(None) };
        if matches!(op, BinOp::Add | BinOp::Sub | BinOp::Mul | BinOp::Div) {
            self.b.computes(it.syntax().text_range());
        }
        if let (BinOp::Div | BinOp::Rem, Some(divisor)) = (op, rhs) {
            self.b.demand(DemandKind::Divisor, b, divisor.syntax().text_range());
        }
        let exprs = self.b.exprs();
        let arithmetic = |operator| (operator, number);
        let (operator, kind) = match op {
            BinOp::And if !numeric => return (exprs.and(a, b), kind),
            BinOp::Or if !numeric => return (exprs.or(a, b), kind),
            BinOp::Xor if !numeric => return (exprs.xor(a, b), kind),
            BinOp::Eq => return (exprs.compare(Comparison::Eq, a, b), Kind::Bit),
            BinOp::Ne => return (exprs.compare(Comparison::Ne, a, b), Kind::Bit),
            BinOp::Lt => return (exprs.compare(Comparison::Lt, a, b), Kind::Bit),
            BinOp::Le => return (exprs.compare(Comparison::Le, a, b), Kind::Bit),
            BinOp::Gt => return (exprs.compare(Comparison::Gt, a, b), Kind::Bit),
            BinOp::Ge => return (exprs.compare(Comparison::Ge, a, b), Kind::Bit),
            BinOp::Assign => return self.optional(None),
            BinOp::And => arithmetic(Operator::And),
            BinOp::Or => arithmetic(Operator::Or),
            BinOp::Xor => arithmetic(Operator::Xor),
            BinOp::Add => arithmetic(Operator::Add),
            BinOp::Sub => arithmetic(Operator::Sub),
            BinOp::Mul => arithmetic(Operator::Mul),
            BinOp::Div => arithmetic(Operator::Div),
            BinOp::Rem => arithmetic(Operator::Rem),
        };
        (exprs.binary(operator, a, b), kind)
    }

    fn call_expr(&mut self, it: &ast::CallExpr) -> (ExprId, Kind) {
        let function = it.function();
        let mut values = Vec::new();
        let mut first = Kind::Number;
        for (position, argument) in it.arguments().into_iter().enumerate() {
            let Some(argument) = argument else { continue };
            // What has a value is a function, known or not, and not an instance that keeps what it is given.
            let (value, kind) = match function {
                Some(_) => {
                    let (_, value, kind) = self.argument(&argument, function, position);
                    (value, kind)
                }
                None => self.expr(&argument),
            };
            if position == 0 {
                first = kind;
            }
            values.push(value);
        }
        let name = it.name().map(|it| it.text().to_ascii_uppercase()).unwrap_or_default();
        let kind = match function.and_then(|it| it.result) {
            Some(functions::Kind::Bit) => Kind::Bit,
            Some(functions::Kind::Float | functions::Kind::FloatTable) => Kind::Float,
            Some(functions::Kind::Number) if first == Kind::Float => Kind::Float,
            Some(_) => Kind::Number,
            None => Kind::Unknown,
        };
        (self.b.exprs().call(&name, values), kind)
    }

    /// An argument of a function: read, or written where the function writes it.
    fn argument(
        &mut self,
        argument: &Expr,
        function: Option<&'static Function>,
        position: usize,
    ) -> (Option<ObjectId>, ExprId, Kind) {
        use functions::Access;
        let parameter = function.and_then(|it| it.parameters.get(position));
        let wanted = match parameter.map(|it| it.kind) {
            Some(functions::Kind::Float | functions::Kind::FloatTable) => Kind::Float,
            Some(functions::Kind::Number | functions::Kind::Any) | None => Kind::Unknown,
            Some(_) => Kind::Number,
        };
        let known = parameter.map(|it| it.access);
        // An instance of a DFB, or an argument that our volume of the manual does not describe: what becomes of it is
        // not known here.
        let is_open = function.is_none_or(|it| it.is_open);
        let access = known.unwrap_or(if is_open { Access::ReadWrite } else { Access::Read });
        if access != Access::Read
            && let Some((object, range)) = self.place(argument)
        {
            let data = self.b.model.object(object);
            let (class, rights) = (data.class, data.rights);
            let kind = self.kind(object);
            self.b.model.mixes_floats |= wanted.may_mix(kind);
            if class == Class::Indirect {
                return (Some(object), self.b.exprs().opaque(), kind);
            }
            if known.is_none() && matches!(rights, Rights::ReadOnly(_)) {
                return (Some(object), self.b.read(object, range), kind);
            }
            self.b.touch(object, if access == Access::Write { Mode::Output } else { Mode::InOut }, range);
            return (Some(object), self.b.exprs().opaque(), kind);
        }
        let (value, kind) = self.expr(argument);
        self.b.model.mixes_floats |= wanted.may_mix(kind);
        (None, value, kind)
    }

    /// `target := value`.
    pub(super) fn assignment(&mut self, it: &ast::AssignStmt) {
        let range = it.syntax().text_range();
        let (target, value) = it.sides();
        let (value, kind) = self.optional(value);
        let Some((object, at)) = target.and_then(|it| self.place(&it)) else { return };
        self.assign(object, value, kind, at, range);
    }

    pub(super) fn assign(&mut self, object: ObjectId, value: ExprId, kind: Kind, at: TextRange, range: TextRange) {
        if self.b.model.object(object).class == Class::Indirect {
            return;
        }
        self.b.model.mixes_floats |= self.kind(object).may_mix(kind);
        let is_bit = match self.kind(object) {
            Kind::Bit => true,
            Kind::Number | Kind::Float => false,
            Kind::Unknown => kind == Kind::Bit,
        };
        if is_bit {
            let value = match self.b.exprs().get(value) {
                crate::model::expr::Expr::Int(0) => Exprs::FALSE,
                crate::model::expr::Expr::Int(1) => Exprs::TRUE,
                _ => value,
            };
            self.b.assign(object, false, value, at, range);
        } else {
            self.b.store(object, value, at, range);
        }
    }

    /// A statement that is not an assignment nor a control structure: an operator with its operand, a function, a
    /// subroutine, a DFB instance.
    pub(super) fn call_stmt(&mut self, it: &ast::CallStmt) {
        let range = it.syntax().text_range();
        let Some(callee) = it.callee() else { return };
        let name = SmolStr::new(callee.text().to_ascii_uppercase());
        if let Some(number) = it.subroutine() {
            self.subroutine(number, callee.text(), Exprs::TRUE, callee.text_range(), range);
            return;
        }
        if let Some(operand) = it.operand().filter(|_| !it.has_parentheses()) {
            let Some((object, at)) = self.place(&operand) else {
                self.expr(&operand);
                return;
            };
            if self.b.model.object(object).class == Class::Indirect {
                return;
            }
            let is_block = self.b.model.object(object).class == Class::Block;
            match name.as_str() {
                // PL7:3571: a block can be reset too.
                "RESET" if is_block => self.b.drive(object, Pin::Reset, Exprs::TRUE, None, at, range),
                "SET" => self.b.set(object, Exprs::TRUE, at, range),
                "RESET" => self.b.reset(object, Exprs::TRUE, at, range),
                "INC" | "DEC" => {
                    let before = self.b.read(object, at);
                    let one = self.b.exprs().int(1);
                    let operator = if name == "INC" { Operator::Add } else { Operator::Sub };
                    let value = self.b.exprs().binary(operator, before, one);
                    self.b.store(object, value, at, range);
                }
                _ => {
                    self.block_statement(&name, object, at, range);
                }
            }
            return;
        }
        let function = it.function();
        let arguments = (0..).zip(it.arguments()).filter_map(|it| Some((it.0, it.1?)));
        if function.is_none() {
            let actuals = arguments.map(|(at, it)| self.actual(Slot::Position(at), &it)).collect();
            self.instance(callee.text(), callee.text_range(), range, actuals, true);
            return;
        }
        for (position, argument) in arguments {
            self.argument(&argument, function, position as usize);
        }
        let call = Call { full: true, ..self.new_call(Callee::Function(name), callee.text(), callee.text_range()) };
        self.b.call(call, range);
    }

    fn new_call(&mut self, callee: Callee, text: &str, at: TextRange) -> Call {
        Call {
            callee,
            text: text.into(),
            statement: 0,
            anchor: self.b.anchor(at),
            when: Exprs::TRUE,
            instance: None,
            instance_range: None,
            arguments: Vec::new(),
            actuals: Vec::new(),
            full: false,
            too_close: None,
        }
    }

    /// What is given to a parameter of a DFB. Of one on the left of a block, or in a call in text, the parameter is not
    /// known here, nor what becomes of it.
    pub(super) fn actual(&mut self, slot: Slot, argument: &Expr) -> Actual {
        let range = argument.syntax().text_range();
        let formal = Some(Formal::Slot(slot));
        let given = match (slot, self.place(argument)) {
            (_, Some((object, _))) if self.b.model.object(object).class == Class::Indirect => Given::Unknown,
            (_, Some((object, at))) => {
                let is_read_only = matches!(self.b.model.object(object).rights, Rights::ReadOnly(_));
                let mode = match slot {
                    _ if is_read_only => Mode::Read,
                    Slot::Right(_) => Mode::Output,
                    Slot::Left(_) | Slot::Position(_) => Mode::InOut,
                };
                let access = self.b.touch(object, mode, at);
                self.b.model.accesses[access as usize].parameter = formal;
                Given::Object(object)
            }
            (_, None) => {
                let kind = match self.expr(argument).1 {
                    _ if is_text(argument) => pl7_kinds::Kind::Text,
                    Kind::Bit => pl7_kinds::Kind::Bit,
                    Kind::Number => pl7_kinds::Kind::Integer,
                    Kind::Float => pl7_kinds::Kind::Float,
                    Kind::Unknown => pl7_kinds::Kind::Unknown,
                };
                if is_constant(argument) { Given::Constant(kind) } else { Given::Expression(kind) }
            }
        };
        Actual { slot, anchor: self.b.anchor(range), given }
    }

    /// The call of an instance of a DFB. `full`: all that it is given is known.
    pub(super) fn instance(
        &mut self,
        name: &str,
        at: TextRange,
        range: TextRange,
        actuals: Vec<Actual>,
        full: bool,
    ) -> u32 {
        let callee = Callee::Instance(name.to_lowercase().into());
        let call = Call { actuals, full, ..self.new_call(callee, name, at) };
        self.b.call(call, range);
        // An instance has run: its outputs and public variables, which are names here, may have other values.
        self.b.wipe();
        index(self.b.model.calls.len() - 1)
    }

    /// `START %TM1;`, `DOWN %TM1;`, `PRESET %C8;`, `UP %C8;`: a statement that drives a block.
    fn block_statement(&mut self, name: &str, object: ObjectId, at: TextRange, range: TextRange) {
        let pin = match name {
            "START" => Pin::Start,
            "PRESET" => Pin::Preset,
            "UP" => Pin::Up,
            "DOWN" => Pin::Down,
            "PUT" => Pin::Store,
            "GET" => Pin::Retrieve,
            _ => Pin::Whole,
        };
        self.b.drive(object, pin, Exprs::TRUE, None, at, range);
    }

    pub(super) fn subroutine(&mut self, number: u32, text: &str, when: ExprId, at: TextRange, range: TextRange) {
        let call = Call { when, ..self.new_call(Callee::Subroutine(number), text, at) };
        self.b.call(call, range);
        self.b.wipe_by_call();
    }

    pub(super) fn label(&mut self, it: &ast::LabelDef) {
        let Some(token) = it.token() else { return };
        let name =
            it.number().map_or_else(|| SmolStr::new(token.text().to_ascii_uppercase()), |it| it.to_string().into());
        self.b.label(name, token.text().into(), token.text_range());
    }

    /// Jump to a label written as `%L20`, or as a word.
    pub(super) fn jump(&mut self, text: &str, at: TextRange, when: ExprId, range: TextRange) {
        let number = ast::label_number(text);
        let name = number.map_or_else(|| SmolStr::new(text.to_ascii_uppercase()), |it| it.to_string().into());
        self.b.mark_all_exits();
        self.b.jump(name, text.into(), at, when, range);
    }

    pub(super) fn leave(&mut self, when: ExprId, how: Leave, range: TextRange) {
        self.b.statement(StatementKind::Return { when, how }, range);
        self.b.mark_all_exits();
        let cause = if how == Leave::Subroutine { DeadCause::Return } else { DeadCause::End };
        self.b.leave(when, cause, range);
    }

    pub(super) fn halt(&mut self, when: ExprId, range: TextRange) {
        self.b.statement(StatementKind::Halt, range);
        self.b.mark_all_exits();
        self.b.leave(when, DeadCause::Halt, range);
    }
}

/// Whether an expression is a constant, with or without a sign.
fn is_constant(expr: &Expr<'_>) -> bool {
    match expr {
        Expr::Literal(_) => true,
        Expr::Unary(it) => {
            let sign = matches!(it.op(), Some(UnaryOp::Minus | UnaryOp::Plus));
            sign && matches!(it.operand(), Some(Expr::Literal(_)))
        }
        _ => false,
    }
}

fn is_text(expr: &Expr<'_>) -> bool {
    matches!(expr, Expr::Literal(it) if it.token().is_some_and(|it| it.kind() == SyntaxKind::CharString))
}

/// The pin that the name of an input means, by the letters of the block's address.
pub(super) fn pin(block: &str, input: &str) -> Pin {
    match input {
        "R" => Pin::Reset,
        "S" if block.eq_ignore_ascii_case("MN") => Pin::Start,
        "S" => Pin::Preset,
        "CU" => Pin::Up,
        "CD" => Pin::Down,
        "I" => Pin::Store,
        "O" => Pin::Retrieve,
        "U" => Pin::Advance,
        // The control input of a series 7 timer lets it run (PL72:659).
        "C" => Pin::Enable,
        _ => Pin::Start,
    }
}

/// How the words of jumps start in ladder.
const JUMP: &[u8] = b"JUMP";

/// Labels that a jump below them goes to, for all languages.
pub(super) fn back_targets(root: SyntaxNode<'_>, text: &str, language: Language) -> rustc_hash::FxHashSet<SmolStr> {
    let mut labels = rustc_hash::FxHashSet::default();
    let mut back = rustc_hash::FxHashSet::default();
    // Most sections have no label at all. Those of PL7-2, whose labels may lack the percent sign, have many, and few jumps.
    let bytes = text.as_bytes();
    let has_jump = || {
        let is_jump = |at: usize| bytes.get(at..at + JUMP.len()).is_some_and(|it| it.eq_ignore_ascii_case(JUMP));
        memchr::memchr2_iter(b'J', b'j', bytes).any(is_jump)
    };
    if !(if language.is_pl7_2() { has_jump() } else { text.contains("%L") || text.contains("%l") }) {
        return back;
    }
    let mut in_definition = false;
    for event in root.walk() {
        let token = match event {
            WalkEvent::Token(it) if it.kind() == SyntaxKind::LabelAddress => it,
            WalkEvent::Enter(node) => {
                in_definition = node.kind() == SyntaxKind::LabelDef;
                continue;
            }
            WalkEvent::Leave(_) => {
                in_definition = false;
                continue;
            }
            WalkEvent::Token(_) => continue,
        };
        let name: SmolStr = match ast::label_number(token.text()) {
            Some(number) => number.to_string().into(),
            None => token.text().to_ascii_uppercase().into(),
        };
        if in_definition {
            labels.insert(name);
        } else if labels.contains(&name) {
            back.insert(name);
        }
    }
    back
}
