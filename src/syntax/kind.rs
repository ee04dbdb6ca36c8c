//! The one `SyntaxKind` of every language: tokens first, then nodes.

macro_rules! kinds {
    ($($(#[$meta:meta])* $name:ident),* $(,)?) => {
        /// Kind of a token or node. One enum for all languages, so that one typed-AST kit serves them all.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
        #[repr(u16)]
        pub enum SyntaxKind { $($(#[$meta])* $name),* }

        /// Every kind, at the index that is its number.
        const KINDS: &[SyntaxKind] = &[$(SyntaxKind::$name),*];
    };
}

kinds! {
    // Trivia: never seen by a grammar, kept in the tree.
    /// Blanks and tabs.
    Whitespace,
    /// A line break: LF, CRLF or CR. In AWL with the blanks that indent the next line, in PL7 also with empty lines.
    Newline,
    /// A comment of the language, delimiters included.
    Comment,
    /// A comment that is not closed before the end of the unit.
    UnclosedComment,

    // Tokens that several languages share.
    /// A run of characters that no token of the language starts with.
    Unknown,
    Ident,
    /// An integer or real number without a type prefix.
    Number,
    /// A constant with a type or base prefix: `S5T#10S`, `W#16#FF`, `2#1010`, `16#AB`, `T#5s`.
    TypedConstant,
    /// Text between quotes: `'abc'`.
    CharString,
    /// A quoted symbol: `"X0"` or `« X0 »`.
    QuotedSymbol,
    Bang,
    Percent,
    Colon,
    Semicolon,
    Comma,
    Dot,
    DotDot,
    LParen,
    RParen,
    LBrack,
    RBrack,
    LBrace,
    RBrace,
    Assign,
    Eq,
    Ne,
    Lt,
    Le,
    Gt,
    Ge,
    Plus,
    Minus,
    Star,
    Slash,
    Hash,
    Arrow,

    // STEP 7 AWL tokens.
    /// `#name`: a name of the block's own declarations.
    LocalName,
    /// `{S7_attr := '...'}`.
    Attribute,
    /// An operator mnemonic: `==I`, `<>R`, `+I`, `*D`, `+AR1`, ...
    Operator,
    /// A pointer constant: `P#M 0.0`, `P#DB1.DBX 0.0 BYTE 10`.
    PointerConstant,
    /// The text of a TITLE, AUTHOR ... line after its `=` or `:`.
    FreeText,
    /// An absolute operand as one token: `M 0.0`, `MW4`, `DB5.DBW 0`, `FB 1`; also what only looks like one (a jump to
    /// the label `M001`).
    Address,
    /// `...`, to the end of its line: code that the author of a listing left out.
    Elision,
    /// `***`: the end of a STEP 5 segment.
    SegmentEnd,

    // PL7 tokens.
    /// A direct object, as one token: `%MW10:X4`, `%I\0.2.1\0.7`, `%TM8.Q`, `%NW{2.3}1`.
    ObjectAddress,
    /// What may follow an index: `:10`, `:X4`, `.T`, `.5`.
    ObjectSuffix,
    /// `%L20`.
    LabelAddress,
    /// `(*PHRASE*)` of the exchange form.
    SentenceStart,
    /// `(*END_PHRASE*)` of the exchange form.
    SentenceEnd,
    /// `[HEADER]` and its like, in the exchange form.
    BlockMark,

    // Nodes.
    /// Root of every unit.
    Root,
    /// Tokens that the grammar could not place.
    Error,

    // STEP 7 AWL nodes.
    /// One OB, FB, FC, DB or UDT with its header.
    Block,
    /// Code without a block header.
    Listing,
    BlockHeader,
    BlockName,
    /// `TITLE = ...`.
    TitleLine,
    /// `AUTHOR : ...`, `VERSION : ...`, `KNOW_HOW_PROTECT` and their like.
    BlockAttribute,
    VarSection,
    VarDecl,
    VarName,
    TypeRef,
    StructType,
    ArrayType,
    InitValue,
    /// A value assigned in the BEGIN part of a data block.
    DataInit,
    Network,
    NetworkHeader,
    Instr,
    Label,
    Operand,
    ArgList,
    Arg,

    // PL7 nodes.
    /// `ST : MAST - SR10`: the line that names what a listing belongs to.
    Heading,
    Sentence,
    LabelDef,
    IlInstr,
    /// `[%MW10:=%MW0+100]` and `LD[%MW10<1000]`: what stands in the brackets.
    Bracket,
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
    ExprStmt,
    BinExpr,
    UnaryExpr,
    ParenExpr,
    CallExpr,
    Literal,
    /// A direct object with its index and suffix.
    ObjectRef,
    /// A symbol, with an optional `.item`.
    NameRef,
    Index,
    /// `RUNG ... END_RUNG`.
    Rung,
    /// One row of a rung, with its `;`.
    RungRow,
    /// `OPEN_CONTACT(%I1.0)`, `COMPARE ... END_BLOCK`.
    Cell,

    // Chart nodes: pages of Grafcet and textual SFC.
    /// `NB_PAGES = 8`.
    PageCount,
    /// `PAGE 0 ... END_PAGE`.
    Page,
    /// `STEP 3 AT (C 4,L 3) : ... END_STEP` and the other kinds of steps.
    ChartStep,
    /// Number or name of a step.
    StepName,
    /// `ACTION (N1,LD) : ... END_ACTION`, `ACTION Fill : ... END_ACTION`.
    ChartAction,
    /// `Fill(N);` in a step.
    Association,
    Transition,
    /// The steps before or after a transition: `FROM (X1,X2)`, `TO X3`.
    TransitionEnd,
    /// `T_S_OR_LINK FROM (C 4,L 4) TO (C 4,L 3) := [...]`.
    ChartLink,
    /// `H_LINK FROM (C 4,L 4) TO (C 5,L 4)` in a link.
    Segment,
    Connector,
    ChartComment,
    /// `(C 4,L 3)`.
    PageCell,

    // Exchange container nodes.
    ExchangeBlock,
    KeyValue,

    // Cross-reference nodes.
    /// `@20`: the place in a module that the entries below stand in.
    XrefPlace,
    /// `%M10 W`.
    XrefEntry,
}

impl SyntaxKind {
    pub fn is_trivia(self) -> bool {
        matches!(self, Self::Whitespace | Self::Newline | Self::Comment | Self::UnclosedComment)
    }
}

/// The number of a kind in a green tree. A node that holds one token and nothing else is stored as that token, with the
/// kind of the node in the high byte: half of all nodes are such, and cost no memory of their own then. A token is stored
/// with the spaces behind it, where both stand in one node: blanks are two of five tokens. Its number has [`SPACED`].
pub(super) mod raw {
    use super::{KINDS, SyntaxKind};

    const _: () = assert!(KINDS.len() <= 256, "a kind fits a byte");
    const _: () = assert!(SyntaxKind::Whitespace as u16 == 0, "no node has the number that says there is none");
    const _: () = assert!(SyntaxKind::UnclosedComment as u16 == 3, "blanks and comments come first");
    const _: () = assert!((SyntaxKind::Root as u16) < SPACED, "tokens come before nodes and leave a bit free");

    /// Of a token that is stored with the spaces behind it.
    const SPACED: u16 = 0x80;

    pub(in crate::syntax) fn of(kind: SyntaxKind) -> rowan::SyntaxKind {
        rowan::SyntaxKind(kind as u16)
    }

    /// A node that holds this token and nothing else.
    pub(in crate::syntax) fn of_leaf(node: SyntaxKind, token: rowan::SyntaxKind) -> rowan::SyntaxKind {
        rowan::SyntaxKind((node as u16) << 8 | token.0)
    }

    /// Whether it is a token that is neither seen by a grammar nor a node.
    pub(in crate::syntax) fn is_trivia(raw: rowan::SyntaxKind) -> bool {
        raw.0 <= SyntaxKind::UnclosedComment as u16
    }

    /// Whether it is neither a blank, a comment nor a node, and has no spaces yet.
    pub(in crate::syntax) fn takes_spaces(raw: rowan::SyntaxKind) -> bool {
        !is_trivia(raw) && raw.0 < SPACED
    }

    /// The token together with the spaces behind it.
    pub(in crate::syntax) fn with_spaces(raw: rowan::SyntaxKind) -> rowan::SyntaxKind {
        rowan::SyntaxKind(raw.0 | SPACED)
    }

    pub(in crate::syntax) fn has_spaces(raw: rowan::SyntaxKind) -> bool {
        raw.0 & SPACED != 0
    }

    /// Kind of a node that is stored as one.
    pub(in crate::syntax) fn node(raw: rowan::SyntaxKind) -> SyntaxKind {
        KINDS.get(usize::from(raw.0)).copied().unwrap_or(SyntaxKind::Error)
    }

    /// Kind of a token.
    pub(in crate::syntax) fn token(raw: rowan::SyntaxKind) -> SyntaxKind {
        KINDS.get(usize::from(raw.0 & (SPACED - 1))).copied().unwrap_or(SyntaxKind::Error)
    }

    /// Kind of the node that is stored as its one token.
    pub(in crate::syntax) fn leaf(raw: rowan::SyntaxKind) -> Option<SyntaxKind> {
        let node = usize::from(raw.0 >> 8);
        (node != 0).then(|| KINDS.get(node).copied().unwrap_or(SyntaxKind::Error))
    }
}
