//! The frame of a DFB type: its heading and its interface (PL7:5350-5450). The code behind them is read as any other.

use SyntaxKind::{
    Assign, Colon, Comma, Heading, Ident, InitValue, Number, Semicolon, TypeRef, VarDecl, VarName, VarSection,
};

use super::grammar::Grammar;
use crate::syntax::{Parser, SyntaxKind};

pub(super) const END: &str = "END_FUNCTION_BLOCK";

/// The words that begin a part of the interface. What the exchange format calls the private variables is not published.
pub(super) const SECTIONS: [&str; 6] = ["VAR_INPUT", "VAR_IN_OUT", "VAR_OUTPUT", "VAR_PUBLIC", "VAR_PRIVATE", "VAR"];

/// Tokens that the name of an item may consist of when it is none.
const LONGEST_NAME: usize = 6;

/// Whether a text is a DFB type.
pub(super) fn is_type(p: &Parser<'_>) -> bool {
    p.at_text("FUNCTION_BLOCK")
}

/// The tokens before which the code of a DFB type ends.
pub(super) fn stops(p: &Parser<'_>) -> Vec<bool> {
    (0..).map_while(|n| Some(p.nth(n)? == Ident && p.nth_text(n).eq_ignore_ascii_case(END))).collect()
}

impl Grammar<'_, '_> {
    /// head = 'FUNCTION_BLOCK' name [';'] section*
    pub(super) fn dfb_head(&mut self) {
        let m = self.p.start();
        self.p.bump();
        let is_named = self.p.at(Ident) && !self.p.newline_before();
        if is_named {
            self.p.bump();
            self.p.eat(Semicolon);
        } else {
            self.expected("the name of the DFB type");
        }
        self.p.complete(m, Heading);
        while self.at_section() {
            self.section();
        }
    }

    /// `END_FUNCTION_BLOCK`, and what stands behind it though nothing may.
    pub(super) fn dfb_end(&mut self) {
        self.state.muted = false;
        self.p.bump();
        self.p.eat(Semicolon);
        if !self.p.at_end() {
            self.error("nothing follows `END_FUNCTION_BLOCK`");
            let m = self.p.start();
            while !self.p.at_end() {
                self.p.bump();
            }
            self.p.complete(m, SyntaxKind::Error);
        }
    }

    fn at_section(&self) -> bool {
        self.p.at(Ident)
            && SECTIONS.iter().any(|it| self.p.at_text(it))
            && !matches!(self.p.nth(1), Some(Assign | Colon))
    }

    /// section = ('VAR_INPUT' | ... | 'VAR') declaration* 'END_VAR' [';']
    fn section(&mut self) {
        let m = self.p.start();
        self.p.bump();
        loop {
            self.state.muted = false;
            if self.p.at_text("END_VAR") {
                self.p.bump();
                self.p.eat(Semicolon);
                break;
            }
            if self.p.at_end() || self.at_section() || self.at_stop() || self.at_heading() {
                self.expected("`END_VAR`");
                break;
            }
            if !self.p.eat(Semicolon) {
                self.item();
            }
        }
        self.p.complete(m, VarSection);
    }

    /// item = name (',' name)* ':' type [':=' value] ';'
    ///
    /// Consumes at least one token.
    fn item(&mut self) {
        let m = self.p.start();
        loop {
            let name = self.p.start();
            // A name that is none is one name nevertheless: who declares it shall be told.
            let length = self.name_length();
            for _ in 0..length.max(1) {
                self.p.bump();
            }
            self.p.complete(name, VarName);
            if !self.p.eat(Comma) || self.p.at_end() {
                break;
            }
        }
        if self.p.eat(Colon) {
            if self.ends_item() || self.p.at(Assign) {
                self.expected("a type");
            } else {
                let ty = self.p.start();
                self.p.bump();
                while !(self.ends_item() || self.p.at(Assign)) {
                    self.p.bump();
                }
                self.p.complete(ty, TypeRef);
            }
        } else {
            self.expected("`:` and a type");
        }
        if self.p.eat(Assign) {
            if self.ends_item() {
                self.expected("an initial value");
            } else {
                let value = self.p.start();
                while !self.ends_item() {
                    self.p.bump();
                }
                self.p.complete(value, InitValue);
            }
        }
        if !self.p.eat(Semicolon) {
            self.expected("`;`");
            while !self.ends_item() {
                self.p.bump();
            }
        }
        self.p.complete(m, VarDecl);
    }

    /// How many tokens stand on the line before the `:` or `,` behind a name; 0 if there is none.
    fn name_length(&self) -> usize {
        let ends = |n| matches!(self.p.nth(n), Some(Colon | Comma));
        let goes_on = |n: &usize| {
            !matches!(self.p.nth(*n), None | Some(Semicolon | Assign)) && (*n == 0 || !self.p.nth_newline_before(*n))
        };
        (0..LONGEST_NAME).take_while(goes_on).find(|&n| ends(n)).unwrap_or(0)
    }

    fn ends_item(&self) -> bool {
        // `AR_W :20` goes on behind its colon.
        let is_next = self.p.newline_before()
            && self.p.at(Ident)
            && self.p.nth(1) == Some(Colon)
            && self.p.nth(2) != Some(Number);
        self.p.at_end()
            || self.p.at(Semicolon)
            || self.p.at_text("END_VAR")
            || self.at_section()
            || self.at_stop()
            || is_next
    }
}
