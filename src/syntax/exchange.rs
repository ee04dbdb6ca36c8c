//! The blocks around the program in a PL7 exchange file.

use super::{Parse, Parser, Token};

pub fn parse(text: &str) -> Parse {
    let tokens: &[Token] = &[];
    Parser::new(text, tokens).finish()
}
