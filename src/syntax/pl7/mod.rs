//! PL7 instruction list and structured text, in the exchange form and as pasted in documents.

use super::{Parse, Parser, Token};

pub fn parse_il(text: &str) -> Parse {
    let tokens: &[Token] = &[];
    Parser::new(text, tokens).finish()
}

pub fn parse_st(text: &str) -> Parse {
    parse_il(text)
}
