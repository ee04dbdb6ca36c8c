//! Typed views of a PL7 tree. Every accessor returns `None` where the text lacks the part.

use std::borrow::Cow;

use smol_str::SmolStr;

use super::functions::{self, Function};
use super::instructions::IlOp;
use super::ladder_words::{self, Element};
use super::word::{self, Keyword};
use rowan::TextRange;

use crate::syntax::node::{choices, nodes};
use crate::syntax::{AstChildren, AstNode as _, SyntaxElement, SyntaxKind, SyntaxNode, SyntaxToken};

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
    /// A rung of ladder: label and rows. Its comment stands behind `RUNG`.
    Rung,
    RungRow,
    Cell,
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

    fn of(token: SyntaxToken<'_>) -> Option<Self> {
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
    fn of(token: SyntaxToken<'_>) -> Option<Self> {
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

impl<'t> Root<'t> {
    pub fn sentences(self) -> AstChildren<'t, Sentence<'t>> {
        self.children()
    }

    pub fn headings(self) -> AstChildren<'t, Heading<'t>> {
        self.children()
    }

    pub fn rungs(self) -> AstChildren<'t, Rung<'t>> {
        self.children()
    }
}

impl<'t> Sentence<'t> {
    /// `(*PHRASE*)` or, in the pasted form, `!`.
    pub fn marker(self) -> Option<SyntaxToken<'t>> {
        self.0.tokens().find(|it| matches!(it.kind(), SyntaxKind::SentenceStart | SyntaxKind::Bang))
    }

    /// The first label; a sentence with a misplaced one has more.
    pub fn label(self) -> Option<LabelDef<'t>> {
        self.child()
    }

    pub fn labels(self) -> AstChildren<'t, LabelDef<'t>> {
        self.children()
    }

    pub fn instructions(self) -> AstChildren<'t, IlInstr<'t>> {
        self.children()
    }

    /// The statements of the outermost level.
    pub fn statements(self) -> AstChildren<'t, Stmt<'t>> {
        self.children()
    }
}

impl<'t> Rung<'t> {
    /// `RUNG`.
    pub fn keyword(self) -> Option<SyntaxToken<'t>> {
        self.child_token(SyntaxKind::Ident)
    }

    pub fn label(self) -> Option<LabelDef<'t>> {
        self.child()
    }

    pub fn rows(self) -> AstChildren<'t, RungRow<'t>> {
        self.children()
    }
}

impl<'t> RungRow<'t> {
    pub fn cells(self) -> AstChildren<'t, Cell<'t>> {
        self.children()
    }
}

impl<'t> Cell<'t> {
    /// `OPEN_CONTACT`; `None` for a cell that could not be read.
    pub fn word(self) -> Option<SyntaxToken<'t>> {
        self.0.tokens().find(|it| !it.kind().is_trivia())
    }

    pub fn element(self) -> Option<Element> {
        Some(ladder_words::lookup(self.word()?.text())?.element)
    }

    /// The bit of a contact or coil, the block of `BLOCK(...)`.
    pub fn operand(self) -> Option<Expr<'t>> {
        self.child()
    }

    /// Number of cells or rows; 1 where none is written, `None` where it is no number.
    pub fn count(self) -> Option<u32> {
        match self.operand() {
            Some(Expr::Literal(it)) => it.token()?.text().parse().ok(),
            Some(_) => None,
            None => Some(1),
        }
    }

    /// `%L10` of a jump.
    pub fn label(self) -> Option<SyntaxToken<'t>> {
        self.child_token(SyntaxKind::LabelAddress)
    }

    /// `SR5` of a call, with its number.
    pub fn subroutine(self) -> Option<(SyntaxToken<'t>, u32)> {
        self.0.tokens().find_map(|it| Some((it, word::subroutine(it.text())?)))
    }

    /// The condition of `COMPARE ... END_BLOCK`.
    pub fn comparison(self) -> Option<Expr<'t>> {
        self.child()
    }

    /// What stands between the word of a block and its `END_BLOCK`.
    pub fn block_text(self) -> Option<TextRange> {
        let end = self.0.tokens().filter(|it| Keyword::of(it.text()) == Some(Keyword::EndBlock)).last()?;
        let word = self.word()?.text_range();
        (word.end() <= end.text_range().start()).then(|| TextRange::new(word.end(), end.text_range().start()))
    }

    /// The statements of `OPERATE ... END_BLOCK`.
    pub fn operations(self) -> AstChildren<'t, Stmt<'t>> {
        self.children()
    }
}

impl<'t> LabelDef<'t> {
    /// `%L20`.
    pub fn token(self) -> Option<SyntaxToken<'t>> {
        self.child_token(SyntaxKind::LabelAddress)
    }

    pub fn number(self) -> Option<u32> {
        label_number(self.token()?.text())
    }
}

/// Number of `%L20`, or of `L20` whose `%` is missing.
pub fn label_number(text: &str) -> Option<u32> {
    let digits = text.strip_prefix('%').unwrap_or(text).strip_prefix(['L', 'l'])?;
    digits.bytes().all(|it| it.is_ascii_digit()).then(|| digits.parse().ok())?
}

/// What an instruction works on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum IlOperand<'t> {
    Object(ObjectRef<'t>),
    Name(NameRef<'t>),
    Literal(Literal<'t>),
    /// `%L20`.
    Label(SyntaxToken<'t>),
    Bracket(Bracket<'t>),
}

impl<'t> IlInstr<'t> {
    /// The mnemonic; `None` for `)` and for a bracket alone.
    pub fn mnemonic(self) -> Option<SyntaxToken<'t>> {
        self.0.tokens().find(|it| !it.kind().is_trivia()).filter(|it| it.kind() == SyntaxKind::Ident)
    }

    pub fn op(self) -> Option<IlOp> {
        IlOp::of_word(self.mnemonic()?.text())
    }

    /// `(` of `AND(` and `OR(`.
    pub fn open_parenthesis(self) -> Option<SyntaxToken<'t>> {
        self.child_token(SyntaxKind::LParen)
    }

    /// `N`, `R` or `F` behind the parenthesis.
    pub fn modifier(self) -> Option<SyntaxToken<'t>> {
        self.0.tokens().skip_while(|it| it.kind() != SyntaxKind::LParen).find(|it| it.kind() == SyntaxKind::Ident)
    }

    /// `)`, which is an instruction of its own.
    pub fn close_parenthesis(self) -> Option<SyntaxToken<'t>> {
        self.child_token(SyntaxKind::RParen)
    }

    pub fn operand(self) -> Option<IlOperand<'t>> {
        let is_bare = self.mnemonic().is_none();
        self.0.children_with_tokens().find_map(|it| match it {
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
    pub fn bracket(self) -> Option<Bracket<'t>> {
        self.child()
    }

    /// Whether the instruction is a numeric operation: `[%MW10:=%MW0+100]`.
    pub fn is_operation(self) -> bool {
        self.mnemonic().is_none() && self.bracket().is_some()
    }

    /// Number of the subroutine that `SR5`, `%SR5` or `SR 5` calls.
    pub fn subroutine(self) -> Option<u32> {
        let mnemonic = self.mnemonic()?;
        word::subroutine(mnemonic.text()).or_else(|| match self.operand()? {
            IlOperand::Literal(it) if self.op() == Some(IlOp::Sr) => it.token()?.text().parse().ok(),
            _ => None,
        })
    }
}

impl<'t> Bracket<'t> {
    pub fn content(self) -> Option<BracketContent<'t>> {
        self.child()
    }

    /// The comparison of a test.
    pub fn expr(self) -> Option<Expr<'t>> {
        self.child()
    }
}

impl<'t> StmtList<'t> {
    pub fn statements(self) -> AstChildren<'t, Stmt<'t>> {
        self.children()
    }
}

impl<'t> AssignStmt<'t> {
    pub fn target(self) -> Option<Expr<'t>> {
        self.sides().0
    }

    /// `:=`, or the `=` that stands in its place; `->` of PL7-2.
    pub fn operator(self) -> Option<SyntaxToken<'t>> {
        self.significant().find(|it| is_assignment_sign(it.kind()))
    }

    pub fn value(self) -> Option<Expr<'t>> {
        self.sides().1
    }

    /// The target and the value. In `127 -> W10` the target stands last.
    pub fn sides(self) -> (Option<Expr<'t>>, Option<Expr<'t>>) {
        let mut elements = self.0.children_with_tokens();
        let (mut before, mut behind, mut sign) = (None, None, None);
        while behind.is_none()
            && let Some(element) = elements.next_node_or(is_assignment_sign)
        {
            match element {
                SyntaxElement::Token(it) => sign = sign.or(Some(it.kind())),
                SyntaxElement::Node(it) if sign.is_some() => behind = Expr::cast(it),
                SyntaxElement::Node(it) => before = before.or_else(|| Expr::cast(it)),
            }
        }
        if sign == Some(SyntaxKind::Arrow) { (behind, before) } else { (before, behind) }
    }
}

fn is_assignment_sign(kind: SyntaxKind) -> bool {
    matches!(kind, SyntaxKind::Assign | SyntaxKind::Eq | SyntaxKind::Arrow)
}

/// Arguments in order, one entry a position; `None` where a position is empty.
fn arguments<'t>(syntax: SyntaxNode<'t>) -> Vec<Option<Expr<'t>>> {
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

impl<'t> CallStmt<'t> {
    /// `SET`, `SR5`, `MASKEVT`, the name of a DFB instance.
    pub fn callee(self) -> Option<SyntaxToken<'t>> {
        self.child_token(SyntaxKind::Ident)
    }

    /// The function or operator that is called, if it is one of the language.
    pub fn function(self) -> Option<&'static Function> {
        functions::lookup(self.callee()?.text())
    }

    /// Operand of `SET %M0`; `None` for a call with parentheses.
    pub fn operand(self) -> Option<Expr<'t>> {
        self.0
            .children_with_tokens()
            .take_while(|it| it.kind() != SyntaxKind::LParen)
            .find_map(|it| Expr::cast(it.into_node()?))
    }

    pub fn has_parentheses(self) -> bool {
        self.child_token(SyntaxKind::LParen).is_some()
    }

    /// Arguments between the parentheses, one entry a position; `None` where a position is empty.
    pub fn arguments(self) -> Vec<Option<Expr<'t>>> {
        arguments(self.0)
    }

    /// Number of the subroutine that `SR5;`, `%SR5;` or `SR 5;` calls.
    pub fn subroutine(self) -> Option<u32> {
        let callee = self.callee()?;
        word::subroutine(callee.text()).or_else(|| match self.operand()? {
            Expr::Literal(it) if callee.text().eq_ignore_ascii_case("SR") => it.token()?.text().parse().ok(),
            _ => None,
        })
    }
}

impl<'t> IfStmt<'t> {
    /// The `IF` arm and every `ELSIF` arm, in order.
    pub fn arms(self) -> AstChildren<'t, IfArm<'t>> {
        self.children()
    }

    pub fn else_arm(self) -> Option<ElseArm<'t>> {
        self.child()
    }
}

impl<'t> IfArm<'t> {
    pub fn condition(self) -> Option<Expr<'t>> {
        self.child()
    }

    pub fn body(self) -> Option<StmtList<'t>> {
        self.child()
    }
}

impl<'t> ElseArm<'t> {
    pub fn body(self) -> Option<StmtList<'t>> {
        self.child()
    }
}

impl<'t> WhileStmt<'t> {
    pub fn condition(self) -> Option<Expr<'t>> {
        self.child()
    }

    pub fn body(self) -> Option<StmtList<'t>> {
        self.child()
    }
}

impl<'t> RepeatStmt<'t> {
    pub fn body(self) -> Option<StmtList<'t>> {
        self.child()
    }

    /// The condition behind `UNTIL`, which ends the loop.
    pub fn condition(self) -> Option<Expr<'t>> {
        self.child()
    }
}

impl<'t> ForStmt<'t> {
    fn part(
        self,
        after: impl Fn(SyntaxElement<'t>) -> bool,
        before: impl Fn(SyntaxElement<'t>) -> bool,
    ) -> Option<Expr<'t>> {
        self.0
            .children_with_tokens()
            .skip_while(|it| !after(*it))
            .skip(1)
            .take_while(|it| !before(*it))
            .find_map(|it| Expr::cast(it.into_node()?))
    }

    pub fn index(self) -> Option<Expr<'t>> {
        self.part(|it| is_word(it, Keyword::For), is_assignment)
    }

    /// `:=`, or the `=` that stands in its place.
    pub fn operator(self) -> Option<SyntaxToken<'t>> {
        self.0.tokens().find(|it| matches!(it.kind(), SyntaxKind::Assign | SyntaxKind::Eq))
    }

    pub fn start(self) -> Option<Expr<'t>> {
        self.part(is_assignment, |it| is_word(it, Keyword::To))
    }

    pub fn end(self) -> Option<Expr<'t>> {
        self.part(|it| is_word(it, Keyword::To), |it| is_word(it, Keyword::Do))
    }

    pub fn body(self) -> Option<StmtList<'t>> {
        self.child()
    }
}

fn is_word(element: SyntaxElement<'_>, keyword: Keyword) -> bool {
    element.into_token().is_some_and(|it| it.kind() == SyntaxKind::Ident && Keyword::of(it.text()) == Some(keyword))
}

fn is_assignment(element: SyntaxElement<'_>) -> bool {
    matches!(element.kind(), SyntaxKind::Assign | SyntaxKind::Eq)
}

impl<'t> JumpStmt<'t> {
    /// `%L20`.
    pub fn label(self) -> Option<SyntaxToken<'t>> {
        self.child_token(SyntaxKind::LabelAddress)
    }

    /// The word that stands in place of a label: `L20`.
    pub fn name(self) -> Option<NameRef<'t>> {
        self.child()
    }
}

impl<'t> ExprStmt<'t> {
    pub fn expr(self) -> Option<Expr<'t>> {
        self.child()
    }
}

impl<'t> BinExpr<'t> {
    pub fn lhs(self) -> Option<Expr<'t>> {
        self.child()
    }

    pub fn operator(self) -> Option<SyntaxToken<'t>> {
        self.operation().map(|it| it.1)
    }

    pub fn op(self) -> Option<BinOp> {
        self.operation().map(|it| it.0)
    }

    /// The operator as it is written.
    pub fn operation(self) -> Option<(BinOp, SyntaxToken<'t>)> {
        self.significant().find_map(|it| Some((BinOp::of(it)?, it)))
    }

    /// The operands, the left one first.
    pub fn operands(self) -> (Option<Expr<'t>>, Option<Expr<'t>>) {
        let mut operands = self.children();
        (operands.next(), operands.next())
    }

    pub fn rhs(self) -> Option<Expr<'t>> {
        self.children().nth(1)
    }
}

impl<'t> UnaryExpr<'t> {
    pub fn operator(self) -> Option<SyntaxToken<'t>> {
        self.significant().find(|it| UnaryOp::of(*it).is_some())
    }

    pub fn op(self) -> Option<UnaryOp> {
        self.significant().find_map(UnaryOp::of)
    }

    pub fn operand(self) -> Option<Expr<'t>> {
        self.child()
    }
}

impl<'t> ParenExpr<'t> {
    pub fn expr(self) -> Option<Expr<'t>> {
        self.child()
    }
}

impl<'t> CallExpr<'t> {
    pub fn name(self) -> Option<SyntaxToken<'t>> {
        self.child_token(SyntaxKind::Ident)
    }

    /// The function that is called, if it is one of the language.
    pub fn function(self) -> Option<&'static Function> {
        functions::lookup(self.name()?.text())
    }

    /// Arguments, one entry a position; `None` where a position is empty.
    pub fn arguments(self) -> Vec<Option<Expr<'t>>> {
        arguments(self.0)
    }

    /// Operands without parentheses, as operations of PL7-2 have them: the bits and the word of `SLC 3 W1`.
    pub fn operands(self) -> AstChildren<'t, Expr<'t>> {
        self.children()
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

impl<'t> Literal<'t> {
    pub fn token(self) -> Option<SyntaxToken<'t>> {
        self.significant().next()
    }

    /// `None` for a number that no 64 bits hold, for a digit that its base does not have, and for an elision.
    pub fn value(self) -> Option<LiteralValue> {
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

impl<'t> ObjectRef<'t> {
    /// The address without blanks, index and the suffix behind the index: `%MW10:X4`, `%MW100` of `%MW100[%MW99]`.
    pub fn address(self) -> Cow<'t, str> {
        if self.0.is_leaf() { self.0.text() } else { joined(self.pieces()) }
    }

    /// The tokens of the address, more than one if blanks part it: `%C8 .D`.
    pub fn pieces(self) -> impl Iterator<Item = SyntaxToken<'t>> + use<'t> {
        let is_before_index = |it: &SyntaxElement<'_>| it.kind() != SyntaxKind::Index;
        self.0
            .children_with_tokens()
            .take_while(is_before_index)
            .filter_map(SyntaxElement::into_token)
            .filter(|it| !it.kind().is_trivia())
    }

    pub fn index(self) -> Option<Index<'t>> {
        self.child()
    }

    /// What stands behind the index, without blanks: `:10`, `:X4`, `.T`.
    pub fn suffix(self) -> Option<SmolStr> {
        suffix_after_index(self.0)
    }
}

impl<'t> NameRef<'t> {
    /// The symbol, or the DFB instance.
    pub fn name(self) -> Option<SyntaxToken<'t>> {
        self.child_token(SyntaxKind::Ident)
    }

    /// The name with its items and the suffix before an index, without blanks: `Controle.Ecart`, `Etat_pompe:X1`.
    pub fn path(self) -> Cow<'t, str> {
        if self.0.is_leaf() {
            return self.0.text();
        }
        let is_before_index = |it: &SyntaxElement<'_>| it.kind() != SyntaxKind::Index;
        let pieces = self.0.children_with_tokens().take_while(is_before_index);
        joined(pieces.filter_map(SyntaxElement::into_token).filter(|it| !it.kind().is_trivia()))
    }

    pub fn index(self) -> Option<Index<'t>> {
        self.child()
    }

    /// What extends the name, before or behind its index, without blanks: `:10`, `:X4`.
    pub fn suffix(self) -> Option<SmolStr> {
        let text = joined(self.0.tokens().filter(|it| it.kind() == SyntaxKind::ObjectSuffix));
        (!text.is_empty()).then(|| text.into())
    }
}

fn suffix_after_index(syntax: SyntaxNode<'_>) -> Option<SmolStr> {
    let behind = syntax.children_with_tokens().skip_while(|it| it.kind() != SyntaxKind::Index);
    let text = joined(behind.filter_map(SyntaxElement::into_token).filter(|it| it.kind() == SyntaxKind::ObjectSuffix));
    (!text.is_empty()).then(|| text.into())
}

/// Nearly always one piece, which then is not copied to the heap.
fn joined<'t>(mut pieces: impl Iterator<Item = SyntaxToken<'t>>) -> Cow<'t, str> {
    let Some(first) = pieces.next() else { return Cow::Borrowed("") };
    let Some(second) = pieces.next() else { return Cow::Borrowed(first.text()) };
    let mut text = String::from(first.text());
    for piece in std::iter::once(second).chain(pieces) {
        text.push_str(piece.text());
    }
    text.into()
}

impl<'t> Index<'t> {
    pub fn expr(self) -> Option<Expr<'t>> {
        self.child()
    }
}
