//! Typed views of the tree. Every accessor returns `Option` or an iterator: a faulty text lacks anything.

use rowan::TextRange;
use smol_str::SmolStr;

use super::instruction::{self, Op, Words};
use crate::syntax::node::nodes;
use crate::syntax::{AstNode as _, Mnemonics, SyntaxElement, SyntaxKind, SyntaxToken};

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

/// The text between quotes, or all of it.
fn unquoted(text: &str) -> &str {
    let inner = text.strip_prefix('#').unwrap_or(text);
    [('"', '"'), ('«', '»'), ('“', '”')]
        .into_iter()
        .find_map(|(open, close)| inner.strip_prefix(open)?.strip_suffix(close))
        .map_or(inner, |it| it.trim_matches([' ', '\t', '\u{A0}', '\u{202F}']))
}

impl<'t> Block<'t> {
    pub fn header(self) -> Option<BlockHeader<'t>> {
        self.child()
    }

    /// Of a data block: the UDT or function block whose data it holds. Of a function: the type of its return value.
    pub fn type_ref(self) -> Option<TypeRef<'t>> {
        self.child().or_else(|| self.header()?.return_type())
    }

    pub fn attributes(self) -> impl Iterator<Item = BlockAttribute<'t>> + use<'t> {
        self.children()
    }
}

impl<'t> BlockAttribute<'t> {
    /// `{S7_attr := '...'}`
    pub fn system_attributes(self) -> Option<SyntaxToken<'t>> {
        self.child_token(SyntaxKind::Attribute)
    }
}

impl<'t> BlockHeader<'t> {
    pub fn keyword(self) -> Option<SyntaxToken<'t>> {
        self.child_token(SyntaxKind::Ident)
    }

    pub fn return_type(self) -> Option<TypeRef<'t>> {
        self.child()
    }
}

impl<'t> VarSection<'t> {
    /// `VAR_INPUT`, `STRUCT`
    pub fn keyword(self) -> Option<SyntaxToken<'t>> {
        self.child_token(SyntaxKind::Ident)
    }

    pub fn decls(self) -> impl Iterator<Item = VarDecl<'t>> + use<'t> {
        self.children()
    }
}

impl<'t> VarDecl<'t> {
    pub fn names(self) -> impl Iterator<Item = VarName<'t>> + use<'t> {
        self.children()
    }

    pub fn type_ref(self) -> Option<TypeRef<'t>> {
        self.child()
    }

    /// Of a formal operand of STEP 5: its kind and its size.
    pub fn type_refs(self) -> impl Iterator<Item = TypeRef<'t>> + use<'t> {
        self.children()
    }

    pub fn struct_type(self) -> Option<StructType<'t>> {
        self.child()
    }

    pub fn array_type(self) -> Option<ArrayType<'t>> {
        self.child()
    }

    pub fn init(self) -> Option<InitValue<'t>> {
        self.child()
    }

    /// `x AT y`: what the variable is a view of.
    pub fn view_of(self) -> Option<Operand<'t>> {
        self.child()
    }
}

impl<'t> VarName<'t> {
    pub fn token(self) -> Option<SyntaxToken<'t>> {
        self.significant().next()
    }

    /// Without quotes and `#`.
    pub fn text(self) -> SmolStr {
        self.token().map_or_else(SmolStr::default, |it| unquoted(it.text()).into())
    }
}

impl<'t> TypeRef<'t> {
    /// As written, without the blanks around: `INT`, `UDT 1`, `STRING [10]`, `"valve"`.
    pub fn text(self) -> String {
        self.0.text().into_owned()
    }
}

impl<'t> StructType<'t> {
    pub fn decls(self) -> impl Iterator<Item = VarDecl<'t>> + use<'t> {
        self.children()
    }
}

impl<'t> ArrayType<'t> {
    /// Lower and upper bound of each dimension, as written.
    pub fn bounds(self) -> Vec<(String, String)> {
        let mut bounds = Vec::new();
        let (mut low, mut current) = (None, String::new());
        for token in self.significant().skip_while(|it| it.kind() != SyntaxKind::LBrack).skip(1) {
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

    pub fn type_ref(self) -> Option<TypeRef<'t>> {
        self.child()
    }

    pub fn struct_type(self) -> Option<StructType<'t>> {
        self.child()
    }

    pub fn array_type(self) -> Option<ArrayType<'t>> {
        self.child()
    }
}

impl<'t> InitValue<'t> {
    /// The tokens after the `:=`: constants, signs, commas and the parentheses of repetitions.
    pub fn tokens(self) -> impl Iterator<Item = SyntaxToken<'t>> + use<'t> {
        self.significant().skip(1)
    }
}

impl<'t> DataInit<'t> {
    pub fn value(self) -> Option<InitValue<'t>> {
        self.child()
    }
}

impl<'t> Network<'t> {
    pub fn header(self) -> Option<NetworkHeader<'t>> {
        self.child()
    }

    pub fn instrs(self) -> impl Iterator<Item = Instr<'t>> + use<'t> {
        self.children()
    }
}

/// A mnemonic as [`instruction::lookup`] knows it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Mnemonic {
    /// In upper case and without blanks: `U(`, `)MCR`, `NOP`.
    pub text: SmolStr,
    pub range: TextRange,
}

/// Where an instruction stands, and whether all of it was understood.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Extent {
    /// From the mnemonic to the last operand.
    pub range: TextRange,
    pub has_error: bool,
}

impl<'t> Instr<'t> {
    /// It stands first.
    pub fn label(self) -> Option<Label<'t>> {
        Label::cast(self.0.children_with_tokens().next()?.into_node()?)
    }

    /// The tokens of the mnemonic: what stands before the first operand. Empty for a label alone on its line.
    pub fn mnemonic_tokens(self) -> impl Iterator<Item = SyntaxToken<'t>> + use<'t> {
        let mut rest = self.0.children_with_tokens();
        let after_label = std::iter::from_fn(move || {
            loop {
                match rest.next_node_or(|it| !it.is_trivia())? {
                    SyntaxElement::Node(it) if it.kind() == SyntaxKind::Label => {}
                    other => return other.into_token(),
                }
            }
        });
        after_label.take_while(|it| is_part_of_mnemonic(it.kind()))
    }

    /// `None` for a label alone on its line.
    pub fn extent(self) -> Option<Extent> {
        let mut range: Option<TextRange> = None;
        let (mut in_mnemonic, mut has_error) = (true, false);
        let mut rest = self.0.children_with_tokens();
        while let Some(element) = rest.next_node_or(|it| in_mnemonic && !it.is_trivia()) {
            match element {
                SyntaxElement::Token(it) => {
                    in_mnemonic = is_part_of_mnemonic(it.kind());
                    if in_mnemonic {
                        let own = it.text_range();
                        range = Some(range.map_or(own, |before| before.cover(own)));
                    }
                }
                SyntaxElement::Node(it) => match it.kind() {
                    SyntaxKind::Operand | SyntaxKind::ArgList => {
                        in_mnemonic = false;
                        range = range.map(|before| before.cover(it.text_range()));
                    }
                    SyntaxKind::Error => has_error = true,
                    _ => {}
                },
            }
        }
        range.map(|range| Extent { range, has_error })
    }

    /// `None` for a label alone on its line.
    pub fn mnemonic(self) -> Option<Mnemonic> {
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
    pub fn op(self, mnemonics: Mnemonics) -> Option<Op> {
        self.op_in(&instruction::WORDS, mnemonics)
    }

    /// As [`Self::op`], by the mnemonics of a language.
    pub(in crate::syntax) fn op_in(self, words: &Words, mnemonics: Mnemonics) -> Option<Op> {
        let mut found = self.mnemonic_tokens();
        let first = found.next()?;
        if first.kind() == SyntaxKind::Operator && first.text().contains([' ', '\t']) {
            // `!= F`
            let bare: String = first.text().split([' ', '\t']).collect();
            return words.lookup(&bare, mnemonics);
        }
        // Nearly always the mnemonic is one word.
        match found.next() {
            None => words.lookup(first.text(), mnemonics),
            Some(_) => words.lookup(&self.mnemonic()?.text, mnemonics),
        }
    }

    pub fn operand(self) -> Option<Operand<'t>> {
        self.child()
    }

    /// One operand; for a `CALL` with an instance data block two.
    pub fn operands(self) -> impl Iterator<Item = Operand<'t>> + use<'t> {
        self.children()
    }

    pub fn arg_list(self) -> Option<ArgList<'t>> {
        self.child()
    }

    /// The parameters of a `CALL`.
    pub fn args(self) -> impl Iterator<Item = Arg<'t>> + use<'t> {
        self.arg_list().into_iter().flat_map(|it| it.args())
    }
}

fn is_part_of_mnemonic(kind: SyntaxKind) -> bool {
    matches!(kind, SyntaxKind::Ident | SyntaxKind::Operator | SyntaxKind::LParen | SyntaxKind::RParen)
}

impl<'t> Label<'t> {
    pub fn name(self) -> Option<SyntaxToken<'t>> {
        self.child_token(SyntaxKind::Ident)
    }
}

impl<'t> Operand<'t> {
    /// All tokens of the operand in order, those of its indices included, without blanks.
    pub fn tokens(self) -> impl Iterator<Item = SyntaxToken<'t>> + use<'t> {
        self.0.descendant_tokens().filter(|it| !it.kind().is_trivia())
    }

    /// As written, without the blanks around.
    pub fn text(self) -> String {
        self.0.text().into_owned()
    }

    /// The operands in brackets, of all dimensions.
    pub fn indices(self) -> impl Iterator<Item = Operand<'t>> + use<'t> {
        self.children()
    }

    /// The first token: what tells a constant from an address, a symbol or a local name.
    pub fn first_token(self) -> Option<SyntaxToken<'t>> {
        self.significant().next()
    }
}

impl<'t> ArgList<'t> {
    pub fn args(self) -> impl Iterator<Item = Arg<'t>> + use<'t> {
        self.children()
    }
}

impl<'t> Arg<'t> {
    pub fn name(self) -> Option<SyntaxToken<'t>> {
        self.significant().next()
    }

    /// `None` for a parameter that is left open.
    pub fn value(self) -> Option<Operand<'t>> {
        self.child()
    }
}

/// What of the tree the tests alone look at.
#[cfg(test)]
mod testing {
    use super::*;

    impl<'t> Root<'t> {
        pub fn blocks(self) -> impl Iterator<Item = Block<'t>> + use<'t> {
            self.children()
        }

        pub fn listings(self) -> impl Iterator<Item = Listing<'t>> + use<'t> {
            self.children()
        }
    }

    impl<'t> Block<'t> {
        pub fn title(self) -> Option<TitleLine<'t>> {
            self.child()
        }

        /// The declarations; the `STRUCT` of a data block or type is one of them.
        pub fn sections(self) -> impl Iterator<Item = VarSection<'t>> + use<'t> {
            self.children()
        }

        pub fn data_inits(self) -> impl Iterator<Item = DataInit<'t>> + use<'t> {
            self.children()
        }

        pub fn networks(self) -> impl Iterator<Item = Network<'t>> + use<'t> {
            self.children()
        }
    }

    impl<'t> Listing<'t> {
        /// `Bloc FC1 :`
        pub fn header(self) -> Option<BlockHeader<'t>> {
            self.child()
        }

        pub fn networks(self) -> impl Iterator<Item = Network<'t>> + use<'t> {
            self.children()
        }
    }

    impl<'t> BlockHeader<'t> {
        pub fn name(self) -> Option<BlockName<'t>> {
            self.child()
        }
    }

    impl<'t> BlockName<'t> {
        /// `FC 1`, or a symbol without its quotes.
        pub fn text(self) -> SmolStr {
            let mut name = self.significant();
            match (name.next(), name.next()) {
                (Some(word), Some(number)) => smol_str::format_smolstr!("{} {}", word.text(), number.text()),
                (Some(word), None) => unquoted(word.text()).into(),
                _ => SmolStr::default(),
            }
        }

        pub fn is_symbol(self) -> bool {
            self.child_token(SyntaxKind::QuotedSymbol).is_some()
        }
    }

    impl<'t> TitleLine<'t> {
        pub fn text(self) -> Option<SyntaxToken<'t>> {
            self.child_token(SyntaxKind::FreeText)
        }
    }

    impl<'t> BlockAttribute<'t> {
        /// `AUTHOR`, `KNOW_HOW_PROTECT`; nothing for `{...}`.
        pub fn keyword(self) -> Option<SyntaxToken<'t>> {
            self.child_token(SyntaxKind::Ident)
        }

        pub fn value(self) -> Option<SyntaxToken<'t>> {
            self.child_token(SyntaxKind::FreeText)
        }
    }

    impl<'t> TypeRef<'t> {
        /// `10` of `STRING [10]`.
        pub fn length(self) -> Option<SyntaxToken<'t>> {
            self.significant()
                .skip_while(|it| it.kind() != SyntaxKind::LBrack)
                .nth(1)
                .filter(|it| it.kind() != SyntaxKind::RBrack)
        }
    }

    impl<'t> DataInit<'t> {
        pub fn target(self) -> Option<Operand<'t>> {
            self.child()
        }
    }

    impl<'t> Network<'t> {
        pub fn title(self) -> Option<TitleLine<'t>> {
            self.header()?.child()
        }

        /// Whether the author left code out of this network (`...`).
        pub fn is_elided(self) -> bool {
            self.child_token(SyntaxKind::Elision).is_some()
        }
    }
}
