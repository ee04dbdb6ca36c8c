//! Which mnemonic set a file is written in.

use super::instruction;
use crate::syntax::Mnemonics;

/// Lead at which the vote is over.
const ENOUGH: i32 = 16;

/// Decides by majority over the words that one set alone has, and over the memory areas of operands (`E 0.0` or
/// `I 0.0`). `None` if nothing speaks for either set, or as much for one as for the other.
///
/// Reads no more of the text than it needs. Comments, strings and declarations have no vote.
pub fn vote(text: &str) -> Option<Mnemonics> {
    let mut scan = Scan { bytes: text.as_bytes(), at: 0 };
    // Above zero: German leads.
    let mut lead = 0_i32;
    while scan.at < scan.bytes.len() && lead.abs() < ENOUGH {
        lead += scan.statement();
    }
    match lead {
        1.. => Some(Mnemonics::German),
        0 => None,
        ..0 => Some(Mnemonics::English),
    }
}

struct Scan<'t> {
    bytes: &'t [u8],
    at: usize,
}

impl<'t> Scan<'t> {
    /// The votes of the statement that starts here; moves past its end.
    fn statement(&mut self) -> i32 {
        let votes = self.instruction();
        self.skip_statement();
        votes
    }

    fn instruction(&mut self) -> i32 {
        self.blanks();
        let mut word = self.word();
        self.blanks();
        if self.peek() == Some(b':') && self.bytes.get(self.at + 1) != Some(&b'=') {
            self.at += 1;
            self.blanks();
            word = self.word();
            self.blanks();
        }
        let operator = word.is_empty() && self.peek() == Some(b'=');
        if operator {
            self.at += 1;
            self.blanks();
        } else if !instruction::is_mnemonic(word) {
            return 0;
        }
        // `A : INT`, `A := 1`, `A.b := 1`, `A, B : INT` are not instructions.
        if matches!(self.peek(), Some(b':' | b'.' | b',' | b'[')) {
            return 0;
        }
        let mnemonic = match instruction::only_in(word) {
            Some(Mnemonics::German) => 1,
            Some(Mnemonics::English) => -1,
            None => 0,
        };
        mnemonic + self.operand()
    }

    fn operand(&mut self) -> i32 {
        let word = self.word();
        let letters = word.iter().take_while(|it| it.is_ascii_alphabetic()).count();
        if letters == 0 || !word[letters..].iter().all(u8::is_ascii_digit) {
            return 0;
        }
        if letters == word.len() {
            self.blanks();
            if !self.peek().is_some_and(|it| it.is_ascii_digit() || it == b'[') {
                return 0;
            }
        }
        let first = word[usize::from(letters == 3)].to_ascii_uppercase();
        let is_area = match letters {
            1 => true,
            2 => matches!(word[1].to_ascii_uppercase(), b'B' | b'W' | b'D'),
            3 => {
                matches!(word[0].to_ascii_uppercase(), b'P')
                    && matches!(word[2].to_ascii_uppercase(), b'B' | b'W' | b'D')
            }
            _ => false,
        };
        match first {
            b'E' | b'A' if is_area => 1,
            b'I' | b'Q' if is_area => -1,
            b'Z' if letters == 1 => 1,
            b'C' if letters == 1 => -1,
            _ => 0,
        }
    }

    /// To the character after the next `;` or line break, over comments and strings.
    fn skip_statement(&mut self) {
        while let Some(byte) = self.peek() {
            self.at += 1;
            match byte {
                b';' | b'\n' | b'\r' => return,
                b'/' if self.peek() == Some(b'/') => self.skip_line(),
                b'"' | b'\'' => self.quoted(byte),
                _ => {}
            }
        }
    }

    fn quoted(&mut self, quote: u8) {
        let rest = &self.bytes[self.at..];
        if let Some(end) = memchr::memchr3(quote, b'\n', b'\r', rest) {
            self.at += if rest[end] == quote { end + 1 } else { end };
        } else {
            self.at = self.bytes.len();
        }
    }

    fn skip_line(&mut self) {
        let rest = &self.bytes[self.at..];
        self.at += memchr::memchr2(b'\n', b'\r', rest).unwrap_or(rest.len());
    }

    fn peek(&self) -> Option<u8> {
        self.bytes.get(self.at).copied()
    }

    fn blanks(&mut self) {
        while matches!(self.peek(), Some(b' ' | b'\t')) {
            self.at += 1;
        }
    }

    fn word(&mut self) -> &'t [u8] {
        let start = self.at;
        while self.peek().is_some_and(|it| it.is_ascii_alphanumeric() || it == b'_' || it >= 0x80) {
            self.at += 1;
        }
        &self.bytes[start..self.at]
    }
}
