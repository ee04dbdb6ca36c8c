//! STEP 7 AWL: sources with block headers and bare listings, German and English mnemonics.

use super::{Mnemonics, Parse, Parser, Token};

pub fn parse(text: &str, _mnemonics: Mnemonics) -> Parse {
    let tokens: &[Token] = &[];
    Parser::new(text, tokens).finish()
}
