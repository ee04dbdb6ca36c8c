//! Typed views of a PL7 tree. Every accessor returns `None` where the text lacks the part.

use rowan::ast::{AstChildren, AstNode, support};
use smol_str::SmolStr;

use super::functions::{self, Function};
use super::instructions::IlOp;
use super::word::{self, Keyword};
use crate::syntax::{Plc, SyntaxElement, SyntaxKind, SyntaxNode, SyntaxToken};

macro_rules! nodes {
    ($($(#[$meta:meta])* $name:ident),* $(,)?) => { $(
        $(#[$meta])*
        #[derive(Debug, Clone, PartialEq, Eq, Hash)]
        pub struct $name {
            syntax: SyntaxNode,
        }

        impl AstNode for $name {
            type Language = Plc;

            fn can_cast(kind: SyntaxKind) -> bool {
                kind == SyntaxKind::$name
            }

            fn cast(syntax: SyntaxNode) -> Option<Self> {
                Self::can_cast(syntax.kind()).then_some(Self { syntax })
            }

            fn syntax(&self) -> &SyntaxNode {
                &self.syntax
            }
        }
    )* };
}

macro_rules! choices {
    ($($(#[$meta:meta])* $name:ident { $($variant:ident($node:ident)),* $(,)? })*) => { $(
        $(#[$meta])*
        #[derive(Debug, Clone, PartialEq, Eq, Hash)]
        pub enum $name { $($variant($node)),* }

        impl AstNode for $name {
            type Language = Plc;

            fn can_cast(kind: SyntaxKind) -> bool {
                $($node::can_cast(kind))||*
            }

            fn cast(syntax: SyntaxNode) -> Option<Self> {
                $(if $node::can_cast(syntax.kind()) {
                    return $node::cast(syntax).map(Self::$variant);
                })*
                None
            }

            fn syntax(&self) -> &SyntaxNode {
                match self { $(Self::$variant(it) => it.syntax()),* }
            }
        }
    )* };
}

nodes! {
    /// A whole unit.
    Root,
    /// `ST : MAST - SR10`.
    Heading,
    /// A sentence: label and instructions or statements. The comment in front of a sentence without a marker stands
    /// before the node.
    Sentence,
    /// `%L20 :`.
    LabelDef,
    /// One instruction of a list: mnemonic and operand, or a bracket alone, or `)`.
    IlInstr,
    /// `[...]` in a list.
    Bracket,
    /// The statements in one part of a control structure.
    StmtList,
    AssignStmt,
    CallStmt,
    IfStmt,
    IfArm,
    ElseArm,
    WhileStmt,
    RepeatStmt,
    ForStmt,
    ExitStmt,
    JumpStmt,
    ReturnStmt,
    HaltStmt,
    EmptyStmt,
    /// An expression alone: a receptivity.
    ExprStmt,
    BinExpr,
    UnaryExpr,
    ParenExpr,
    CallExpr,
    Literal,
    ObjectRef,
    NameRef,
    Index,
}

choices! {
    /// An expression.
    Expr {
        Bin(BinExpr),
        Unary(UnaryExpr),
        Paren(ParenExpr),
        Call(CallExpr),
        Literal(Literal),
        Object(ObjectRef),
        Name(NameRef),
    }

    /// A statement.
    Stmt {
        Assign(AssignStmt),
        Call(CallStmt),
        If(IfStmt),
        While(WhileStmt),
        Repeat(RepeatStmt),
        For(ForStmt),
        Exit(ExitStmt),
        Jump(JumpStmt),
        Return(ReturnStmt),
        Halt(HaltStmt),
        Empty(EmptyStmt),
        Expr(ExprStmt),
    }

    /// What a bracket in a list holds: an action, or the comparison that a test reads.
    BracketContent {
        Assign(AssignStmt),
        Call(CallStmt),
        Expr(Expr),
    }
}

/// Operator between two operands, weakest first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum BinOp {
    /// `:=` where an expression stands: always a mistake.
    Assign,
    Or,
    Xor,
    And,
    Eq,
    Ne,
    Lt,
    Le,
    Gt,
    Ge,
    Add,
    Sub,
    Mul,
    Div,
    Rem,
}

impl BinOp {
    pub fn is_comparison(self) -> bool {
        matches!(self, Self::Eq | Self::Ne | Self::Lt | Self::Le | Self::Gt | Self::Ge)
    }

    pub fn is_logical(self) -> bool {
        matches!(self, Self::Or | Self::Xor | Self::And)
    }

    fn of(token: &SyntaxToken) -> Option<Self> {
        Some(match token.kind() {
            SyntaxKind::Assign => Self::Assign,
            SyntaxKind::Eq => Self::Eq,
            SyntaxKind::Ne => Self::Ne,
            SyntaxKind::Lt => Self::Lt,
            SyntaxKind::Le => Self::Le,
            SyntaxKind::Gt => Self::Gt,
            SyntaxKind::Ge => Self::Ge,
            SyntaxKind::Plus => Self::Add,
            SyntaxKind::Minus => Self::Sub,
            SyntaxKind::Star => Self::Mul,
            SyntaxKind::Slash => Self::Div,
            SyntaxKind::Ident => match Keyword::of(token.text())? {
                Keyword::Or => Self::Or,
                Keyword::Xor => Self::Xor,
                Keyword::And => Self::And,
                Keyword::Rem => Self::Rem,
                _ => return None,
            },
            _ => return None,
        })
    }
}

/// Operator before one operand.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum UnaryOp {
    Not,
    Minus,
    Plus,
    /// Rising edge.
    Re,
    /// Falling edge.
    Fe,
}

impl UnaryOp {
    fn of(token: &SyntaxToken) -> Option<Self> {
        Some(match token.kind() {
            SyntaxKind::Minus => Self::Minus,
            SyntaxKind::Plus => Self::Plus,
            SyntaxKind::Ident => match Keyword::of(token.text())? {
                Keyword::Not => Self::Not,
                Keyword::Re => Self::Re,
                Keyword::Fe => Self::Fe,
                _ => return None,
            },
            _ => return None,
        })
    }
}

fn tokens(syntax: &SyntaxNode) -> impl Iterator<Item = SyntaxToken> + use<> {
    syntax.children_with_tokens().filter_map(SyntaxElement::into_token)
}

fn token(syntax: &SyntaxNode, kind: SyntaxKind) -> Option<SyntaxToken> {
    support::token(syntax, kind)
}

fn nth_expr(syntax: &SyntaxNode, n: usize) -> Option<Expr> {
    support::children(syntax).nth(n)
}

impl Root {
    pub fn sentences(&self) -> AstChildren<Sentence> {
        support::children(&self.syntax)
    }

    pub fn headings(&self) -> AstChildren<Heading> {
        support::children(&self.syntax)
    }
}

impl Sentence {
    /// `(*PHRASE*)` or, in the pasted form, `!`.
    pub fn marker(&self) -> Option<SyntaxToken> {
        tokens(&self.syntax).find(|it| matches!(it.kind(), SyntaxKind::SentenceStart | SyntaxKind::Bang))
    }

    /// The first label; a sentence with a misplaced one has more.
    pub fn label(&self) -> Option<LabelDef> {
        support::child(&self.syntax)
    }

    pub fn labels(&self) -> AstChildren<LabelDef> {
        support::children(&self.syntax)
    }

    pub fn instructions(&self) -> AstChildren<IlInstr> {
        support::children(&self.syntax)
    }

    /// The statements of the outermost level.
    pub fn statements(&self) -> AstChildren<Stmt> {
        support::children(&self.syntax)
    }
}

impl LabelDef {
    /// `%L20`.
    pub fn token(&self) -> Option<SyntaxToken> {
        token(&self.syntax, SyntaxKind::LabelAddress)
    }

    pub fn number(&self) -> Option<u32> {
        label_number(self.token()?.text())
    }
}

/// Number of `%L20`, or of `L20` whose `%` is missing.
pub fn label_number(text: &str) -> Option<u32> {
    let digits = text.strip_prefix('%').unwrap_or(text).strip_prefix(['L', 'l'])?;
    digits.bytes().all(|it| it.is_ascii_digit()).then(|| digits.parse().ok())?
}

/// What an instruction works on.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum IlOperand {
    Object(ObjectRef),
    Name(NameRef),
    Literal(Literal),
    /// `%L20`.
    Label(SyntaxToken),
    Bracket(Bracket),
}

impl IlInstr {
    /// The mnemonic; `None` for `)` and for a bracket alone.
    pub fn mnemonic(&self) -> Option<SyntaxToken> {
        tokens(&self.syntax).find(|it| !it.kind().is_trivia()).filter(|it| it.kind() == SyntaxKind::Ident)
    }

    pub fn op(&self) -> Option<IlOp> {
        IlOp::of_word(self.mnemonic()?.text())
    }

    /// `(` of `AND(` and `OR(`.
    pub fn open_parenthesis(&self) -> Option<SyntaxToken> {
        token(&self.syntax, SyntaxKind::LParen)
    }

    /// `N`, `R` or `F` behind the parenthesis.
    pub fn modifier(&self) -> Option<SyntaxToken> {
        tokens(&self.syntax).skip_while(|it| it.kind() != SyntaxKind::LParen).find(|it| it.kind() == SyntaxKind::Ident)
    }

    /// `)`, which is an instruction of its own.
    pub fn close_parenthesis(&self) -> Option<SyntaxToken> {
        token(&self.syntax, SyntaxKind::RParen)
    }

    pub fn operand(&self) -> Option<IlOperand> {
        let is_bare = self.mnemonic().is_none();
        self.syntax.children_with_tokens().find_map(|it| match it {
            SyntaxElement::Node(node) => match node.kind() {
                SyntaxKind::ObjectRef => ObjectRef::cast(node).map(IlOperand::Object),
                SyntaxKind::NameRef => NameRef::cast(node).map(IlOperand::Name),
                SyntaxKind::Literal => Literal::cast(node).map(IlOperand::Literal),
                SyntaxKind::Bracket if !is_bare => Bracket::cast(node).map(IlOperand::Bracket),
                _ => None,
            },
            SyntaxElement::Token(it) => (it.kind() == SyntaxKind::LabelAddress).then_some(IlOperand::Label(it)),
        })
    }

    /// The bracket, whether it is the operand of a test or an action of its own.
    pub fn bracket(&self) -> Option<Bracket> {
        support::child(&self.syntax)
    }

    /// Whether the instruction is a numeric operation: `[%MW10:=%MW0+100]`.
    pub fn is_operation(&self) -> bool {
        self.mnemonic().is_none() && self.bracket().is_some()
    }

    /// Number of the subroutine that `SR5`, `%SR5` or `SR 5` calls.
    pub fn subroutine(&self) -> Option<u32> {
        let mnemonic = self.mnemonic()?;
        word::subroutine(mnemonic.text()).or_else(|| match self.operand()? {
            IlOperand::Literal(it) if self.op() == Some(IlOp::Sr) => it.token()?.text().parse().ok(),
            _ => None,
        })
    }
}

impl Bracket {
    pub fn content(&self) -> Option<BracketContent> {
        support::child(&self.syntax)
    }

    /// The comparison of a test.
    pub fn expr(&self) -> Option<Expr> {
        support::child(&self.syntax)
    }
}

impl StmtList {
    pub fn statements(&self) -> AstChildren<Stmt> {
        support::children(&self.syntax)
    }
}

impl AssignStmt {
    pub fn target(&self) -> Option<Expr> {
        self.syntax
            .children_with_tokens()
            .take_while(|it| !matches!(it.kind(), SyntaxKind::Assign | SyntaxKind::Eq))
            .find_map(|it| Expr::cast(it.into_node()?))
    }

    /// `:=`, or the `=` that stands in its place.
    pub fn operator(&self) -> Option<SyntaxToken> {
        tokens(&self.syntax).find(|it| matches!(it.kind(), SyntaxKind::Assign | SyntaxKind::Eq))
    }

    pub fn value(&self) -> Option<Expr> {
        self.syntax
            .children_with_tokens()
            .skip_while(|it| !matches!(it.kind(), SyntaxKind::Assign | SyntaxKind::Eq))
            .find_map(|it| Expr::cast(it.into_node()?))
    }
}

/// Arguments in order, one entry a position; `None` where a position is empty.
fn arguments(syntax: &SyntaxNode) -> Vec<Option<Expr>> {
    let mut list = Vec::new();
    let mut current = None;
    let mut is_open = false;
    for element in syntax.children_with_tokens() {
        match element {
            SyntaxElement::Token(it) if it.kind() == SyntaxKind::LParen => is_open = true,
            SyntaxElement::Token(it) if it.kind() == SyntaxKind::Comma && is_open => list.push(current.take()),
            SyntaxElement::Node(it) if is_open => current = current.or_else(|| Expr::cast(it)),
            _ => {}
        }
    }
    if current.is_some() || !list.is_empty() {
        list.push(current);
    }
    list
}

impl CallStmt {
    /// `SET`, `SR5`, `MASKEVT`, the name of a DFB instance.
    pub fn callee(&self) -> Option<SyntaxToken> {
        token(&self.syntax, SyntaxKind::Ident)
    }

    /// The function or operator that is called, if it is one of the language.
    pub fn function(&self) -> Option<&'static Function> {
        functions::lookup(self.callee()?.text())
    }

    /// Operand of `SET %M0`; `None` for a call with parentheses.
    pub fn operand(&self) -> Option<Expr> {
        self.syntax
            .children_with_tokens()
            .take_while(|it| it.kind() != SyntaxKind::LParen)
            .find_map(|it| Expr::cast(it.into_node()?))
    }

    pub fn has_parentheses(&self) -> bool {
        token(&self.syntax, SyntaxKind::LParen).is_some()
    }

    /// Arguments between the parentheses, one entry a position; `None` where a position is empty.
    pub fn arguments(&self) -> Vec<Option<Expr>> {
        arguments(&self.syntax)
    }

    /// Number of the subroutine that `SR5;`, `%SR5;` or `SR 5;` calls.
    pub fn subroutine(&self) -> Option<u32> {
        let callee = self.callee()?;
        word::subroutine(callee.text()).or_else(|| match self.operand()? {
            Expr::Literal(it) if callee.text().eq_ignore_ascii_case("SR") => it.token()?.text().parse().ok(),
            _ => None,
        })
    }
}

impl IfStmt {
    /// The `IF` arm and every `ELSIF` arm, in order.
    pub fn arms(&self) -> AstChildren<IfArm> {
        support::children(&self.syntax)
    }

    pub fn else_arm(&self) -> Option<ElseArm> {
        support::child(&self.syntax)
    }
}

impl IfArm {
    /// `IF`, `ELSIF` or `ELSEIF`.
    pub fn keyword(&self) -> Option<SyntaxToken> {
        token(&self.syntax, SyntaxKind::Ident)
    }

    pub fn condition(&self) -> Option<Expr> {
        support::child(&self.syntax)
    }

    pub fn body(&self) -> Option<StmtList> {
        support::child(&self.syntax)
    }
}

impl ElseArm {
    pub fn body(&self) -> Option<StmtList> {
        support::child(&self.syntax)
    }
}

impl WhileStmt {
    pub fn condition(&self) -> Option<Expr> {
        support::child(&self.syntax)
    }

    pub fn body(&self) -> Option<StmtList> {
        support::child(&self.syntax)
    }
}

impl RepeatStmt {
    pub fn body(&self) -> Option<StmtList> {
        support::child(&self.syntax)
    }

    /// The condition behind `UNTIL`, which ends the loop.
    pub fn condition(&self) -> Option<Expr> {
        support::child(&self.syntax)
    }
}

impl ForStmt {
    fn part(&self, after: impl Fn(&SyntaxElement) -> bool, before: impl Fn(&SyntaxElement) -> bool) -> Option<Expr> {
        self.syntax
            .children_with_tokens()
            .skip_while(|it| !after(it))
            .skip(1)
            .take_while(|it| !before(it))
            .find_map(|it| Expr::cast(it.into_node()?))
    }

    pub fn index(&self) -> Option<Expr> {
        self.part(|it| is_word(it, Keyword::For), is_assignment)
    }

    /// `:=`, or the `=` that stands in its place.
    pub fn operator(&self) -> Option<SyntaxToken> {
        tokens(&self.syntax).find(|it| matches!(it.kind(), SyntaxKind::Assign | SyntaxKind::Eq))
    }

    pub fn start(&self) -> Option<Expr> {
        self.part(is_assignment, |it| is_word(it, Keyword::To))
    }

    pub fn end(&self) -> Option<Expr> {
        self.part(|it| is_word(it, Keyword::To), |it| is_word(it, Keyword::Do))
    }

    pub fn body(&self) -> Option<StmtList> {
        support::child(&self.syntax)
    }
}

fn is_word(element: &SyntaxElement, keyword: Keyword) -> bool {
    element.as_token().is_some_and(|it| it.kind() == SyntaxKind::Ident && Keyword::of(it.text()) == Some(keyword))
}

fn is_assignment(element: &SyntaxElement) -> bool {
    matches!(element.kind(), SyntaxKind::Assign | SyntaxKind::Eq)
}

impl JumpStmt {
    /// `%L20`.
    pub fn label(&self) -> Option<SyntaxToken> {
        token(&self.syntax, SyntaxKind::LabelAddress)
    }

    /// The word that stands in place of a label: `L20`.
    pub fn name(&self) -> Option<NameRef> {
        support::child(&self.syntax)
    }
}

impl ExprStmt {
    pub fn expr(&self) -> Option<Expr> {
        support::child(&self.syntax)
    }
}

impl BinExpr {
    pub fn lhs(&self) -> Option<Expr> {
        nth_expr(&self.syntax, 0)
    }

    pub fn operator(&self) -> Option<SyntaxToken> {
        tokens(&self.syntax).find(|it| BinOp::of(it).is_some())
    }

    pub fn op(&self) -> Option<BinOp> {
        BinOp::of(&self.operator()?)
    }

    pub fn rhs(&self) -> Option<Expr> {
        nth_expr(&self.syntax, 1)
    }
}

impl UnaryExpr {
    pub fn operator(&self) -> Option<SyntaxToken> {
        tokens(&self.syntax).find(|it| UnaryOp::of(it).is_some())
    }

    pub fn op(&self) -> Option<UnaryOp> {
        UnaryOp::of(&self.operator()?)
    }

    pub fn operand(&self) -> Option<Expr> {
        support::child(&self.syntax)
    }
}

impl ParenExpr {
    pub fn expr(&self) -> Option<Expr> {
        support::child(&self.syntax)
    }

    /// `[%MW10<20]` rather than `(%MW10<20)`.
    pub fn is_square(&self) -> bool {
        token(&self.syntax, SyntaxKind::LBrack).is_some()
    }
}

impl CallExpr {
    pub fn name(&self) -> Option<SyntaxToken> {
        token(&self.syntax, SyntaxKind::Ident)
    }

    /// The function that is called, if it is one of the language.
    pub fn function(&self) -> Option<&'static Function> {
        functions::lookup(self.name()?.text())
    }

    /// Arguments, one entry a position; `None` where a position is empty.
    pub fn arguments(&self) -> Vec<Option<Expr>> {
        arguments(&self.syntax)
    }
}

/// Value of a literal.
#[derive(Debug, Clone, PartialEq)]
pub enum LiteralValue {
    Bool(bool),
    /// In base 10, or as `2#`, `8#`, `16#` say.
    Integer(u64),
    Real(f64),
    /// Text without its quotes, escapes as written.
    Text(SmolStr),
    /// A duration, date or address: `T#5s`, as written.
    Other(SmolStr),
}

impl Literal {
    pub fn token(&self) -> Option<SyntaxToken> {
        tokens(&self.syntax).find(|it| !it.kind().is_trivia())
    }

    /// `None` for a number that no 64 bits hold, for a digit that its base does not have, and for an elision.
    pub fn value(&self) -> Option<LiteralValue> {
        let token = self.token()?;
        let text = token.text();
        Some(match token.kind() {
            SyntaxKind::Ident => LiteralValue::Bool(Keyword::of(text) == Some(Keyword::True)),
            SyntaxKind::Number if text.contains(['.', 'e', 'E']) => {
                LiteralValue::Real(text.replace('_', "").parse().ok()?)
            }
            SyntaxKind::Number => LiteralValue::Integer(integer(text, 10)?),
            SyntaxKind::TypedConstant => match text.split_once('#')? {
                ("2", digits) => LiteralValue::Integer(integer(digits, 2)?),
                ("8", digits) => LiteralValue::Integer(integer(digits, 8)?),
                ("16", digits) => LiteralValue::Integer(integer(digits, 16)?),
                _ => LiteralValue::Other(text.into()),
            },
            SyntaxKind::CharString => {
                let inner = text.strip_prefix('\'').unwrap_or(text);
                LiteralValue::Text(inner.strip_suffix('\'').unwrap_or(inner).into())
            }
            _ => return None,
        })
    }
}

fn integer(digits: &str, base: u32) -> Option<u64> {
    let mut value = 0_u64;
    for digit in digits.chars().filter(|it| *it != '_') {
        value = value.checked_mul(base.into())?.checked_add(digit.to_digit(base)?.into())?;
    }
    Some(value)
}

impl ObjectRef {
    /// The address without blanks, index and the suffix behind the index: `%MW10:X4`, `%MW100` of `%MW100[%MW99]`.
    pub fn address(&self) -> SmolStr {
        joined(self.pieces())
    }

    /// The tokens of the address, more than one if blanks part it: `%C8 .D`.
    pub fn pieces(&self) -> impl Iterator<Item = SyntaxToken> + use<> {
        let is_before_index = |it: &SyntaxElement| it.kind() != SyntaxKind::Index;
        self.syntax
            .children_with_tokens()
            .take_while(is_before_index)
            .filter_map(SyntaxElement::into_token)
            .filter(|it| !it.kind().is_trivia())
    }

    pub fn index(&self) -> Option<Index> {
        support::child(&self.syntax)
    }

    /// What stands behind the index, without blanks: `:10`, `:X4`, `.T`.
    pub fn suffix(&self) -> Option<SmolStr> {
        suffix_after_index(&self.syntax)
    }
}

impl NameRef {
    /// The symbol, or the DFB instance.
    pub fn name(&self) -> Option<SyntaxToken> {
        token(&self.syntax, SyntaxKind::Ident)
    }

    /// The items behind the dots: `Ecart` of `Controle.Ecart`.
    pub fn items(&self) -> impl Iterator<Item = SyntaxToken> + use<> {
        tokens(&self.syntax)
            .skip_while(|it| it.kind() != SyntaxKind::Dot)
            .filter(|it| matches!(it.kind(), SyntaxKind::Ident | SyntaxKind::Number))
    }

    /// The name with its items and the suffix before an index, without blanks: `Controle.Ecart`, `Etat_pompe:X1`.
    pub fn path(&self) -> SmolStr {
        let is_before_index = |it: &SyntaxElement| it.kind() != SyntaxKind::Index;
        let pieces = self.syntax.children_with_tokens().take_while(is_before_index);
        joined(pieces.filter_map(SyntaxElement::into_token).filter(|it| !it.kind().is_trivia()))
    }

    pub fn index(&self) -> Option<Index> {
        support::child(&self.syntax)
    }

    /// What extends the name, before or behind its index, without blanks: `:10`, `:X4`.
    pub fn suffix(&self) -> Option<SmolStr> {
        let text = joined(tokens(&self.syntax).filter(|it| it.kind() == SyntaxKind::ObjectSuffix));
        (!text.is_empty()).then_some(text)
    }
}

fn suffix_after_index(syntax: &SyntaxNode) -> Option<SmolStr> {
    let behind = syntax.children_with_tokens().skip_while(|it| it.kind() != SyntaxKind::Index);
    let text = joined(behind.filter_map(SyntaxElement::into_token).filter(|it| it.kind() == SyntaxKind::ObjectSuffix));
    (!text.is_empty()).then_some(text)
}

/// Nearly always one piece, which then is not copied to the heap.
fn joined(mut pieces: impl Iterator<Item = SyntaxToken>) -> SmolStr {
    let Some(first) = pieces.next() else { return SmolStr::default() };
    let Some(second) = pieces.next() else { return first.text().into() };
    let mut text = String::from(first.text());
    for piece in std::iter::once(second).chain(pieces) {
        text.push_str(piece.text());
    }
    text.into()
}

impl Index {
    pub fn expr(&self) -> Option<Expr> {
        support::child(&self.syntax)
    }
}
