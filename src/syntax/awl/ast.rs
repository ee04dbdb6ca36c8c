//! Typed views of the tree. Every accessor returns `Option` or an iterator: a faulty text lacks anything.

use rowan::TextRange;
use rowan::ast::{AstNode, support};
use smol_str::SmolStr;

use super::instruction::{self, Op};
use crate::syntax::{Mnemonics, Plc, SyntaxKind, SyntaxNode, SyntaxToken};

macro_rules! nodes {
    ($($(#[$meta:meta])* $name:ident),* $(,)?) => {$(
        $(#[$meta])*
        #[derive(Debug, Clone, PartialEq, Eq, Hash)]
        pub struct $name(SyntaxNode);

        impl AstNode for $name {
            type Language = Plc;

            fn can_cast(kind: SyntaxKind) -> bool {
                kind == SyntaxKind::$name
            }

            fn cast(node: SyntaxNode) -> Option<Self> {
                Self::can_cast(node.kind()).then_some(Self(node))
            }

            fn syntax(&self) -> &SyntaxNode {
                &self.0
            }
        }

        impl $name {
            /// From the first to the last token, without the blanks and comments around.
            pub fn range(&self) -> TextRange {
                trimmed_range(&self.0)
            }
        }
    )*};
}

nodes! {
    /// The whole unit.
    Root,
    Block,
    Listing,
    BlockHeader,
    BlockName,
    TitleLine,
    BlockAttribute,
    VarSection,
    VarDecl,
    VarName,
    TypeRef,
    StructType,
    ArrayType,
    InitValue,
    DataInit,
    Network,
    NetworkHeader,
    Instr,
    Label,
    Operand,
    ArgList,
    Arg,
}

fn tokens(node: &SyntaxNode) -> impl Iterator<Item = SyntaxToken> {
    node.children_with_tokens().filter_map(rowan::NodeOrToken::into_token).filter(|it| !it.kind().is_trivia())
}

fn token(node: &SyntaxNode, kind: SyntaxKind) -> Option<SyntaxToken> {
    tokens(node).find(|it| it.kind() == kind)
}

fn first_token(node: &SyntaxNode) -> Option<SyntaxToken> {
    tokens(node).next()
}

/// The builder puts blanks and comments before the node whose first token they precede, so that a node's own range has
/// none at its ends.
fn trimmed_range(node: &SyntaxNode) -> TextRange {
    node.text_range()
}

/// The text between quotes, or all of it.
fn unquoted(text: &str) -> &str {
    let inner = text.strip_prefix('#').unwrap_or(text);
    [('"', '"'), ('«', '»'), ('“', '”')]
        .into_iter()
        .find_map(|(open, close)| inner.strip_prefix(open)?.strip_suffix(close))
        .map_or(inner, |it| it.trim_matches([' ', '\t', '\u{A0}', '\u{202F}']))
}

impl Root {
    pub fn blocks(&self) -> impl Iterator<Item = Block> + use<> {
        support::children(&self.0)
    }

    pub fn listings(&self) -> impl Iterator<Item = Listing> + use<> {
        support::children(&self.0)
    }
}

impl Block {
    pub fn header(&self) -> Option<BlockHeader> {
        support::child(&self.0)
    }

    pub fn title(&self) -> Option<TitleLine> {
        support::child(&self.0)
    }

    pub fn attributes(&self) -> impl Iterator<Item = BlockAttribute> + use<> {
        support::children(&self.0)
    }

    /// The declarations; the `STRUCT` of a data block or type is one of them.
    pub fn sections(&self) -> impl Iterator<Item = VarSection> + use<> {
        support::children(&self.0)
    }

    /// Of a data block: the UDT or function block whose data it holds. Of a function: the type of its return value.
    pub fn type_ref(&self) -> Option<TypeRef> {
        support::child(&self.0).or_else(|| self.header()?.return_type())
    }

    pub fn data_inits(&self) -> impl Iterator<Item = DataInit> + use<> {
        support::children(&self.0)
    }

    pub fn networks(&self) -> impl Iterator<Item = Network> + use<> {
        support::children(&self.0)
    }
}

impl Listing {
    /// `Bloc FC1 :`
    pub fn header(&self) -> Option<BlockHeader> {
        support::child(&self.0)
    }

    pub fn networks(&self) -> impl Iterator<Item = Network> + use<> {
        support::children(&self.0)
    }
}

impl BlockHeader {
    pub fn keyword(&self) -> Option<SyntaxToken> {
        token(&self.0, SyntaxKind::Ident)
    }

    pub fn name(&self) -> Option<BlockName> {
        support::child(&self.0)
    }

    pub fn return_type(&self) -> Option<TypeRef> {
        support::child(&self.0)
    }
}

impl BlockName {
    /// `FC 1`, or a symbol without its quotes.
    pub fn text(&self) -> SmolStr {
        let mut name = tokens(&self.0);
        match (name.next(), name.next()) {
            (Some(word), Some(number)) => smol_str::format_smolstr!("{} {}", word.text(), number.text()),
            (Some(word), None) => unquoted(word.text()).into(),
            _ => SmolStr::default(),
        }
    }

    pub fn is_symbol(&self) -> bool {
        token(&self.0, SyntaxKind::QuotedSymbol).is_some()
    }
}

impl TitleLine {
    pub fn text(&self) -> Option<SyntaxToken> {
        token(&self.0, SyntaxKind::FreeText)
    }
}

impl BlockAttribute {
    /// `AUTHOR`, `KNOW_HOW_PROTECT`; nothing for `{...}`.
    pub fn keyword(&self) -> Option<SyntaxToken> {
        token(&self.0, SyntaxKind::Ident)
    }

    pub fn value(&self) -> Option<SyntaxToken> {
        token(&self.0, SyntaxKind::FreeText)
    }

    /// `{S7_attr := '...'}`
    pub fn system_attributes(&self) -> Option<SyntaxToken> {
        token(&self.0, SyntaxKind::Attribute)
    }
}

impl VarSection {
    /// `VAR_INPUT`, `STRUCT`
    pub fn keyword(&self) -> Option<SyntaxToken> {
        token(&self.0, SyntaxKind::Ident)
    }

    pub fn decls(&self) -> impl Iterator<Item = VarDecl> + use<> {
        support::children(&self.0)
    }
}

impl VarDecl {
    pub fn names(&self) -> impl Iterator<Item = VarName> + use<> {
        support::children(&self.0)
    }

    pub fn type_ref(&self) -> Option<TypeRef> {
        support::child(&self.0)
    }

    pub fn struct_type(&self) -> Option<StructType> {
        support::child(&self.0)
    }

    pub fn array_type(&self) -> Option<ArrayType> {
        support::child(&self.0)
    }

    pub fn init(&self) -> Option<InitValue> {
        support::child(&self.0)
    }

    /// `x AT y`: what the variable is a view of.
    pub fn view_of(&self) -> Option<Operand> {
        support::child(&self.0)
    }
}

impl VarName {
    pub fn token(&self) -> Option<SyntaxToken> {
        first_token(&self.0)
    }

    /// Without quotes and `#`.
    pub fn text(&self) -> SmolStr {
        self.token().map_or_else(SmolStr::default, |it| unquoted(it.text()).into())
    }
}

impl TypeRef {
    /// As written, without the blanks around: `INT`, `UDT 1`, `STRING [10]`, `"valve"`.
    pub fn text(&self) -> String {
        self.0.text().slice(self.range() - self.0.text_range().start()).to_string()
    }

    /// The name of the type, its number and length apart.
    pub fn token(&self) -> Option<SyntaxToken> {
        first_token(&self.0)
    }

    /// `10` of `STRING [10]`.
    pub fn length(&self) -> Option<SyntaxToken> {
        tokens(&self.0)
            .skip_while(|it| it.kind() != SyntaxKind::LBrack)
            .nth(1)
            .filter(|it| it.kind() != SyntaxKind::RBrack)
    }
}

impl StructType {
    pub fn decls(&self) -> impl Iterator<Item = VarDecl> + use<> {
        support::children(&self.0)
    }
}

impl ArrayType {
    /// Lower and upper bound of each dimension, as written.
    pub fn bounds(&self) -> Vec<(String, String)> {
        let mut bounds = Vec::new();
        let (mut low, mut current) = (None, String::new());
        for token in tokens(&self.0).skip_while(|it| it.kind() != SyntaxKind::LBrack).skip(1) {
            match token.kind() {
                SyntaxKind::DotDot => low = Some(std::mem::take(&mut current)),
                kind @ (SyntaxKind::Comma | SyntaxKind::RBrack) => {
                    if let Some(low) = low.take() {
                        bounds.push((low, std::mem::take(&mut current)));
                    }
                    if kind == SyntaxKind::RBrack {
                        break;
                    }
                }
                _ => current.push_str(token.text()),
            }
        }
        bounds
    }

    pub fn type_ref(&self) -> Option<TypeRef> {
        support::child(&self.0)
    }

    pub fn struct_type(&self) -> Option<StructType> {
        support::child(&self.0)
    }

    pub fn array_type(&self) -> Option<ArrayType> {
        support::child(&self.0)
    }
}

impl InitValue {
    /// The tokens after the `:=`: constants, signs, commas and the parentheses of repetitions.
    pub fn tokens(&self) -> impl Iterator<Item = SyntaxToken> {
        tokens(&self.0).skip(1)
    }
}

impl DataInit {
    pub fn target(&self) -> Option<Operand> {
        support::child(&self.0)
    }

    pub fn value(&self) -> Option<InitValue> {
        support::child(&self.0)
    }
}

impl Network {
    pub fn header(&self) -> Option<NetworkHeader> {
        support::child(&self.0)
    }

    pub fn title(&self) -> Option<TitleLine> {
        support::child(self.header()?.syntax())
    }

    pub fn instrs(&self) -> impl Iterator<Item = Instr> + use<> {
        support::children(&self.0)
    }

    /// Whether the author left code out of this network (`...`).
    pub fn is_elided(&self) -> bool {
        token(&self.0, SyntaxKind::Elision).is_some()
    }
}

impl NetworkHeader {
    pub fn title(&self) -> Option<TitleLine> {
        support::child(&self.0)
    }
}

/// A mnemonic as [`instruction::lookup`] knows it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Mnemonic {
    /// In upper case and without blanks: `U(`, `)MCR`, `NOP`.
    pub text: SmolStr,
    pub range: TextRange,
}

impl Instr {
    pub fn label(&self) -> Option<Label> {
        support::child(&self.0)
    }

    /// The tokens of the mnemonic. Empty for a label alone on its line.
    pub fn mnemonic_tokens(&self) -> impl Iterator<Item = SyntaxToken> {
        tokens(&self.0).take_while(|it| {
            matches!(it.kind(), SyntaxKind::Ident | SyntaxKind::Operator | SyntaxKind::LParen | SyntaxKind::RParen)
        })
    }

    /// `None` for a label alone on its line.
    pub fn mnemonic(&self) -> Option<Mnemonic> {
        let mut found = self.mnemonic_tokens();
        let first = found.next()?;
        let mut range = first.text_range();
        let mut text = smol_str::SmolStrBuilder::new();
        first.text().chars().for_each(|it| text.push(it.to_ascii_uppercase()));
        for token in found {
            range = range.cover(token.text_range());
            token.text().chars().for_each(|it| text.push(it.to_ascii_uppercase()));
        }
        Some(Mnemonic { text: text.finish(), range })
    }

    /// `None` for a label alone and for an unknown mnemonic.
    pub fn op(&self, mnemonics: Mnemonics) -> Option<Op> {
        let mut found = self.mnemonic_tokens();
        let first = found.next()?;
        // Nearly always the mnemonic is one word.
        match found.next() {
            None => instruction::lookup(first.text(), mnemonics),
            Some(_) => instruction::lookup(&self.mnemonic()?.text, mnemonics),
        }
    }

    pub fn operand(&self) -> Option<Operand> {
        support::child(&self.0)
    }

    /// One operand; for a `CALL` with an instance data block two.
    pub fn operands(&self) -> impl Iterator<Item = Operand> + use<> {
        support::children(&self.0)
    }

    pub fn arg_list(&self) -> Option<ArgList> {
        support::child(&self.0)
    }

    /// The parameters of a `CALL`.
    pub fn args(&self) -> impl Iterator<Item = Arg> + use<> {
        self.arg_list().into_iter().flat_map(|it| it.args())
    }
}

impl Label {
    pub fn name(&self) -> Option<SyntaxToken> {
        token(&self.0, SyntaxKind::Ident)
    }
}

impl Operand {
    /// All tokens of the operand in order, those of its indices included, without blanks.
    pub fn tokens(&self) -> impl Iterator<Item = SyntaxToken> {
        let tokens = self.0.descendants_with_tokens().filter_map(rowan::NodeOrToken::into_token);
        tokens.filter(|it| !it.kind().is_trivia())
    }

    /// As written, without the blanks around.
    pub fn text(&self) -> String {
        self.0.text().slice(self.range() - self.0.text_range().start()).to_string()
    }

    /// The operands in brackets, of all dimensions.
    pub fn indices(&self) -> impl Iterator<Item = Operand> + use<> {
        support::children(&self.0)
    }

    /// The first token: what tells a constant from an address, a symbol or a local name.
    pub fn first_token(&self) -> Option<SyntaxToken> {
        first_token(&self.0)
    }
}

impl ArgList {
    pub fn args(&self) -> impl Iterator<Item = Arg> + use<> {
        support::children(&self.0)
    }
}

impl Arg {
    pub fn name(&self) -> Option<SyntaxToken> {
        first_token(&self.0)
    }

    /// `None` for a parameter that is left open.
    pub fn value(&self) -> Option<Operand> {
        support::child(&self.0)
    }
}
