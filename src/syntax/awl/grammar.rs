//! Recursive descent over the tokens of a unit.
//!
//! Recovery: a fault costs its statement. What cannot be read goes, up to the `;` or the end of the line, into one
//! `Error` node with one message; the next statement is read as if nothing had happened.

use rowan::{TextRange, TextSize};

use super::instruction::{self, Op, OperandRule};
use crate::syntax::packed::{Index, index};
use crate::syntax::{Mnemonics, Parser, SyntaxKind};

use SyntaxKind::*;

pub(super) fn root(p: &mut Parser<'_>, mnemonics: Mnemonics) {
    let mut grammar = Grammar { p, mnemonics };
    while !grammar.p.at_end() {
        if grammar.p.eat(Semicolon) {
            continue;
        }
        match grammar.block_kind() {
            Some(kind) => grammar.block(kind),
            None => grammar.listing(),
        }
    }
}

/// Reports the comment that swallowed the last `len` bytes of the text.
pub(super) fn unclosed_comment(p: &mut Parser<'_>, text: usize, len: u32) {
    let end = u32::try_from(text).unwrap_or(u32::MAX);
    let start = TextSize::new(end.saturating_sub(len));
    p.error_at(TextRange::at(start, TextSize::new(2.min(len))), "this comment is not closed: expected `*)`");
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum BlockKind {
    Organization,
    Function,
    FunctionBlock,
    Data,
    Type,
}

impl BlockKind {
    const ALL: [Self; 5] = [Self::Organization, Self::Function, Self::FunctionBlock, Self::Data, Self::Type];

    fn of(word: &str) -> Option<Self> {
        let is = |keyword: &str| word.eq_ignore_ascii_case(keyword);
        match word.len() {
            4 if is("TYPE") => Some(Self::Type),
            8 if is("FUNCTION") => Some(Self::Function),
            10 if is("DATA_BLOCK") => Some(Self::Data),
            14 if is("FUNCTION_BLOCK") => Some(Self::FunctionBlock),
            18 if is("ORGANIZATION_BLOCK") => Some(Self::Organization),
            _ => None,
        }
    }

    fn of_end(word: &str) -> Option<Self> {
        let head = word.get(..4)?;
        if head.eq_ignore_ascii_case("END_") { Self::of(&word[4..]) } else { None }
    }

    fn keyword(self) -> &'static str {
        match self {
            Self::Organization => "ORGANIZATION_BLOCK",
            Self::Function => "FUNCTION",
            Self::FunctionBlock => "FUNCTION_BLOCK",
            Self::Data => "DATA_BLOCK",
            Self::Type => "TYPE",
        }
    }

    fn has_code(self) -> bool {
        !matches!(self, Self::Data | Self::Type)
    }
}

/// A keyword that starts a line of a block but no instruction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Keyword {
    Block(BlockKind),
    EndBlock(BlockKind),
    Begin,
    Network,
    /// Only with a number after it.
    PrintedNetwork,
    Title,
    Var,
    EndVar,
    Struct,
    EndStruct,
    /// AUTHOR, FAMILY, NAME, VERSION: with a value.
    Property,
    /// KNOW_HOW_PROTECT and its like.
    Flag,
}

/// Every keyword but those of the blocks.
const WORDS: [(&str, Keyword); 29] = [
    ("BEGIN", Keyword::Begin),
    ("NETWORK", Keyword::Network),
    // As the editor prints a block, in its own language.
    ("NETZWERK", Keyword::PrintedNetwork),
    ("RÉSEAU", Keyword::PrintedNetwork),
    ("RéSEAU", Keyword::PrintedNetwork),
    ("SEGMENT", Keyword::PrintedNetwork),
    ("SEGMENTO", Keyword::PrintedNetwork),
    ("TITLE", Keyword::Title),
    ("VAR", Keyword::Var),
    ("VAR_INPUT", Keyword::Var),
    ("VAR_OUTPUT", Keyword::Var),
    ("VAR_IN_OUT", Keyword::Var),
    ("VAR_TEMP", Keyword::Var),
    ("VAR_STAT", Keyword::Var),
    ("CONST", Keyword::Var),
    ("END_VAR", Keyword::EndVar),
    ("END_CONST", Keyword::EndVar),
    ("STRUCT", Keyword::Struct),
    ("END_STRUCT", Keyword::EndStruct),
    ("AUTHOR", Keyword::Property),
    ("FAMILY", Keyword::Property),
    ("NAME", Keyword::Property),
    ("VERSION", Keyword::Property),
    ("CODE_VERSION1", Keyword::Flag),
    ("KNOW_HOW_PROTECT", Keyword::Flag),
    ("STANDARD", Keyword::Flag),
    ("UNLINKED", Keyword::Flag),
    ("READ_ONLY", Keyword::Flag),
    ("NON_RETAIN", Keyword::Flag),
];

/// The keywords of a source, as they are spelt.
pub(in crate::syntax) fn keywords() -> impl Iterator<Item = &'static str> {
    BlockKind::ALL.iter().map(|it| it.keyword()).chain(WORDS.iter().map(|it| it.0))
}

impl Keyword {
    fn of(word: &str) -> Option<Self> {
        static INDEX: Index<{ WORDS.len() }> = index!(WORDS, 0);
        if !(3..=22).contains(&word.len()) {
            return None;
        }
        if let Some(at) = INDEX.find(word) {
            return Some(WORDS[at].1);
        }
        BlockKind::of(word).map(Self::Block).or_else(|| BlockKind::of_end(word).map(Self::EndBlock))
    }
}

/// What became of an operand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Read {
    Done,
    /// No token of an operand stands here; nothing was consumed or reported.
    Absent,
    /// Reported; the caller skips the rest of the statement.
    Faulty,
}

struct Grammar<'p, 't> {
    p: &'p mut Parser<'t>,
    mnemonics: Mnemonics,
}

impl Grammar<'_, '_> {
    // Statements and recovery.

    fn at_statement_end(&self) -> bool {
        self.p.newline_before() || self.p.at(Semicolon)
    }

    /// Puts the rest of the statement into an error node.
    fn skip_statement(&mut self) {
        self.skip_while(|_| true);
    }

    fn skip_while(&mut self, wanted: impl Fn(SyntaxKind) -> bool) {
        let goes_on = |grammar: &Self| !grammar.at_statement_end() && grammar.p.current().is_some_and(&wanted);
        if !goes_on(self) {
            return;
        }
        let error = self.p.start();
        while goes_on(self) {
            self.p.bump();
        }
        self.p.complete(error, Error);
    }

    /// Reports and skips a statement by its first token.
    fn bad_statement(&mut self, message: impl Into<String>) {
        match self.p.current() {
            Some(Unknown) => self.p.error(unknown_token(self.p.current_text())),
            _ => self.p.error(message),
        }
        let error = self.p.start();
        self.p.bump();
        while !self.at_statement_end() {
            self.p.bump();
        }
        self.p.eat(Semicolon);
        self.p.complete(error, Error);
    }

    /// The `;` or the end of the line; what stands before it is reported and skipped.
    fn end_statement(&mut self, what: &str) {
        if !self.at_statement_end() {
            self.p.error(format!("expected the end of the {what}"));
            self.skip_statement();
        }
        self.p.eat(Semicolon);
    }

    /// Reports a missing item on the token that stands in its place, or else on the one before it.
    fn missing(&mut self, message: impl Into<String>) {
        let range = if self.at_statement_end() { self.p.previous_range() } else { self.p.current_range() };
        self.p.error_at(range, message);
    }

    /// [`missing`](Self::missing), and the statement is given up.
    fn missing_in_statement(&mut self, message: impl Into<String>) {
        self.missing(message);
        self.skip_statement();
        self.p.eat(Semicolon);
    }

    // Blocks.

    fn keyword(&self) -> Option<Keyword> {
        if !self.p.at(Ident) {
            return None;
        }
        let keyword = Keyword::of(self.p.current_text())?;
        match (keyword, self.p.nth(1)) {
            (Keyword::PrintedNetwork, Some(Number)) => Some(Keyword::Network),
            (Keyword::PrintedNetwork, _) => None,
            (Keyword::Property, Some(Colon)) => Some(keyword),
            // A declaration, label or assignment of that name.
            (_, Some(Colon | Assign | Dot | LBrack)) if !self.p.nth_newline_before(1) => None,
            _ => Some(keyword),
        }
    }

    fn block_kind(&self) -> Option<BlockKind> {
        self.block_kind_of(self.keyword())
    }

    /// The block that the keyword at hand opens.
    fn block_kind_of(&self, keyword: Option<Keyword>) -> Option<BlockKind> {
        match keyword {
            Some(Keyword::Block(kind)) if matches!(self.p.nth(1), Some(Ident | Address | QuotedSymbol)) => Some(kind),
            _ => None,
        }
    }

    /// Whether the unit's current block or listing ends here, at this keyword.
    fn is_block_boundary(&self, keyword: Option<Keyword>) -> bool {
        self.p.at_end() || matches!(keyword, Some(Keyword::EndBlock(_))) || self.block_kind_of(keyword).is_some()
    }

    fn block(&mut self, kind: BlockKind) {
        let block = self.p.start();
        let opening = self.p.current_range();
        let header = self.p.start();
        self.p.bump();
        self.block_name();
        if kind == BlockKind::Function {
            if self.p.eat(Colon) {
                self.type_ref();
            } else {
                self.missing("expected `:` and the type of the return value, such as `: VOID`");
            }
        }
        self.p.complete(header, BlockHeader);

        let mut in_body = false;
        loop {
            let keyword = self.keyword();
            if self.is_block_boundary(keyword) {
                break;
            }
            let before = self.p.position();
            match keyword {
                Some(Keyword::Begin) if !in_body => {
                    self.p.bump();
                    in_body = true;
                }
                _ if in_body && kind.has_code() => self.network(false),
                _ if in_body => self.data_init(),
                Some(Keyword::Title) => self.title_line(),
                Some(Keyword::Property) => self.block_property(),
                Some(Keyword::Flag) => self.block_flag(),
                Some(Keyword::Var | Keyword::Struct) => self.var_section(),
                Some(Keyword::Network) if kind.has_code() => {
                    in_body = true;
                    self.network(false);
                }
                _ => in_body |= self.block_item(kind),
            }
            debug_assert!(self.p.position() > before, "an item of a block consumes a token");
        }
        match self.keyword() {
            Some(Keyword::EndBlock(end)) => {
                if end != kind {
                    self.p.error(format!("expected `END_{}`", kind.keyword()));
                }
                self.p.bump();
                self.p.eat(Semicolon);
            }
            _ => {
                let message = format!("this `{0}` is not closed: expected `END_{0}`", kind.keyword());
                self.p.error_at(opening, message);
            }
        }
        self.p.complete(block, Block);
    }

    /// Between the header of a block and its body, where no keyword stands. Whether that was code.
    fn block_item(&mut self, kind: BlockKind) -> bool {
        match self.p.current() {
            Some(Attribute) => self.block_flag(),
            Some(Semicolon | Elision) => self.p.bump(),
            Some(Ident) if self.p.at_text("ARRAY") && !kind.has_code() => {
                self.array_type();
                self.p.eat(Semicolon);
            }
            Some(Ident | Address | QuotedSymbol)
                if kind == BlockKind::Data && self.keyword().is_none() && self.p.nth(1) != Some(Colon) =>
            {
                self.type_ref();
                // `BEGIN` may follow on the same line.
                if self.keyword().is_none() {
                    self.end_statement("type of the data block");
                }
            }
            Some(_) if kind.has_code() && (self.op_here().is_some() || self.at_label()) => {
                self.p.error("expected `BEGIN` before the code of the block");
                self.network(false);
                return true;
            }
            _ => self.bad_statement("expected a declaration or `BEGIN`"),
        }
        false
    }

    fn block_name(&mut self) {
        let name = self.p.start();
        let word = self.p.current_text();
        let is_kind = super::lexer::is_area(word.as_bytes())
            || ["UDT", "SFB", "SFC"].iter().any(|it| it.eq_ignore_ascii_case(word));
        let numbered = self.p.at(Ident) && is_kind;
        if matches!(self.p.current(), Some(Ident | Address | QuotedSymbol)) {
            self.p.bump();
        }
        if numbered {
            if self.p.at(Number) && !self.p.newline_before() {
                self.p.bump();
            } else {
                self.missing("expected the number of the block");
            }
        }
        self.p.complete(name, BlockName);
    }

    fn title_line(&mut self) {
        let title = self.p.start();
        self.p.bump();
        if self.p.eat(Eq) {
            self.p.eat(FreeText);
        } else {
            self.missing_in_statement("expected `=` and the title");
        }
        self.p.complete(title, TitleLine);
    }

    fn block_property(&mut self) {
        let attribute = self.p.start();
        self.p.bump();
        if self.p.eat(Colon) {
            self.p.eat(FreeText);
            self.p.eat(Semicolon);
        } else {
            self.missing_in_statement("expected `:` and a value");
        }
        self.p.complete(attribute, BlockAttribute);
    }

    fn block_flag(&mut self) {
        let attribute = self.p.start();
        self.p.bump();
        self.p.eat(Semicolon);
        self.p.complete(attribute, BlockAttribute);
    }

    // Declarations.

    fn var_section(&mut self) {
        let section = self.p.start();
        let is_struct = self.keyword() == Some(Keyword::Struct);
        let opening = self.p.current_range();
        let keyword = self.p.current_text();
        self.p.bump();
        while self.at_retention() {
            self.p.bump();
        }
        self.declarations();
        let (end, text) = if is_struct { (Keyword::EndStruct, "END_STRUCT") } else { (Keyword::EndVar, "END_VAR") };
        if self.keyword() == Some(end) {
            self.p.bump();
            self.p.eat(Semicolon);
        } else {
            self.p.error_at(opening, format!("this `{keyword}` is not closed: expected `{text}`"));
        }
        self.p.complete(section, VarSection);
    }

    /// `VAR RETAIN`: on the line of the keyword.
    fn at_retention(&self) -> bool {
        !self.p.newline_before()
            && !matches!(self.p.nth(1), Some(Colon | Comma))
            && ["RETAIN", "NON_RETAIN", "CONSTANT"].into_iter().any(|it| self.p.at_text(it))
    }

    /// Declarations, up to a keyword that closes them or that none can start with.
    fn declarations(&mut self) {
        loop {
            match self.keyword() {
                None | Some(Keyword::Title | Keyword::Property | Keyword::Flag) => {}
                Some(Keyword::Block(_)) if self.block_kind().is_none() => {}
                Some(_) => return,
            }
            match self.p.current() {
                None => return,
                Some(Ident | QuotedSymbol | LocalName | Address) => self.var_decl(),
                Some(Semicolon | Elision | Attribute) => self.p.bump(),
                Some(_) => self.bad_statement("expected the declaration of a variable"),
            }
        }
    }

    fn var_decl(&mut self) {
        let decl = self.p.start();
        self.var_name();
        while self.p.at(Comma) && matches!(self.p.nth(1), Some(Ident | QuotedSymbol | LocalName | Address)) {
            self.p.bump();
            self.var_name();
        }
        if self.p.at_text("AT") && !self.p.newline_before() {
            self.p.bump();
            self.operand();
        }
        if !self.p.eat(Colon) {
            self.missing_in_statement("expected `:` and the type of the variable");
        } else if self.data_type() {
            while self.p.eat(Attribute) {}
            if !self.p.at(Assign) || self.init_value() {
                self.end_statement("declaration");
            } else {
                self.skip_statement();
                self.p.eat(Semicolon);
            }
        } else {
            self.skip_statement();
            self.p.eat(Semicolon);
        }
        self.p.complete(decl, VarDecl);
    }

    fn var_name(&mut self) {
        let name = self.p.start();
        if self.p.at(Address) {
            self.p.bump_as(Ident);
        } else {
            self.p.bump();
        }
        while self.p.eat(Attribute) {}
        self.p.complete(name, VarName);
    }

    /// Whether a type could be read; if not, that is reported.
    fn data_type(&mut self) -> bool {
        let mnemonics = self.mnemonics;
        let read = if self.p.at_text("STRUCT") {
            self.p.nested(|p| Grammar { p, mnemonics }.struct_type())
        } else if self.p.at_text("ARRAY") {
            self.p.nested(|p| Grammar { p, mnemonics }.array_type())
        } else {
            Some(self.type_ref())
        };
        read.unwrap_or_else(|| {
            self.skip_type();
            true
        })
    }

    /// A type that is nested too deep: over its structures without recursion.
    fn skip_type(&mut self) {
        let error = self.p.start();
        // Structures that are open; the keyword of one stands behind a colon or `OF`, or starts its line.
        let mut open = usize::from(self.p.at_text("STRUCT"));
        self.p.bump();
        while !self.p.at_end() {
            match self.keyword() {
                Some(Keyword::EndVar | Keyword::Begin | Keyword::EndBlock(_)) => break,
                Some(Keyword::EndStruct) if open == 0 => break,
                Some(Keyword::EndStruct) if open == 1 => {
                    self.p.bump();
                    break;
                }
                Some(Keyword::EndStruct) => open -= 1,
                _ if self.p.at(Ident) && self.p.at_text("STRUCT") => open += 1,
                _ if open == 0 && self.at_statement_end() => break,
                _ => {}
            }
            self.p.bump();
        }
        self.p.complete(error, Error);
    }

    fn struct_type(&mut self) -> bool {
        let structure = self.p.start();
        let opening = self.p.current_range();
        self.p.bump();
        self.declarations();
        if self.keyword() == Some(Keyword::EndStruct) {
            self.p.bump();
        } else {
            self.p.error_at(opening, "this `STRUCT` is not closed: expected `END_STRUCT`");
        }
        self.p.complete(structure, StructType);
        true
    }

    fn array_type(&mut self) -> bool {
        let array = self.p.start();
        self.p.bump();
        let read = self.array_bounds() && self.data_type();
        self.p.complete(array, ArrayType);
        read
    }

    /// `[1 .. 2, 0 .. 7] OF`
    fn array_bounds(&mut self) -> bool {
        if !self.p.eat(LBrack) {
            self.missing("expected `[` and the bounds of the array");
            return false;
        }
        while let Some(
            Number | TypedConstant | Ident | LocalName | QuotedSymbol | DotDot | Comma | Plus | Minus | Star,
        ) = self.p.current()
        {
            if self.p.newline_before() {
                break;
            }
            self.p.bump();
        }
        if !self.p.eat(RBrack) {
            self.missing("expected bounds such as `1 .. 10`, and `]`");
            return false;
        }
        if !self.p.at_text("OF") {
            self.missing("expected `OF` and the type of the elements");
            return false;
        }
        self.p.bump();
        true
    }

    fn type_ref(&mut self) -> bool {
        let next_declaration = self.p.newline_before() && self.p.nth(1) == Some(Colon);
        if next_declaration
            || self.keyword().is_some()
            || !matches!(self.p.current(), Some(Ident | Address | QuotedSymbol))
        {
            self.missing("expected a type");
            return false;
        }
        let type_ref = self.p.start();
        let is_word = self.p.at(Ident);
        let numbered = is_word && super::lexer::is_area(self.p.current_text().as_bytes());
        self.p.bump();
        if numbered && self.p.at(Number) && !self.p.newline_before() {
            self.p.bump();
        }
        let mut read = true;
        if is_word && self.p.at(LBrack) {
            self.p.bump();
            if matches!(self.p.current(), Some(Number | TypedConstant | Ident | LocalName | QuotedSymbol)) {
                self.p.bump();
            }
            if !self.p.eat(RBrack) {
                self.missing("expected the length and `]`");
                read = false;
            }
        }
        self.p.complete(type_ref, TypeRef);
        read
    }

    /// `:= 1, 3(0), TRUE`: values, and repetitions of values. Whether it could be read; if not, that is reported.
    fn init_value(&mut self) -> bool {
        let init = self.p.start();
        self.p.bump();
        let mut open = 0_usize;
        let mut wants_value = true;
        loop {
            let goes_on = wants_value || open > 0;
            if self.p.at_end() || (self.p.newline_before() && !goes_on) {
                break;
            }
            match self.p.current() {
                Some(Plus | Minus) if wants_value && self.p.nth(1) == Some(Number) => {
                    self.p.bump();
                    self.p.bump();
                    wants_value = false;
                }
                Some(Number | TypedConstant | CharString | PointerConstant | QuotedSymbol | LocalName)
                    if wants_value =>
                {
                    self.p.bump();
                    wants_value = false;
                }
                Some(Ident | Address) if wants_value && self.keyword().is_none() && !self.at_declaration() => {
                    self.p.bump();
                    wants_value = false;
                }
                Some(LParen | LBrack) if wants_value || self.p.at(LParen) => {
                    self.p.bump();
                    open += 1;
                    wants_value = true;
                }
                Some(RParen | RBrack) if open > 0 && !wants_value => {
                    self.p.bump();
                    open -= 1;
                }
                Some(Comma) if !wants_value => {
                    self.p.bump();
                    wants_value = true;
                }
                _ => break,
            }
        }
        let fault = match (wants_value, open) {
            (true, _) => Some("expected a value"),
            (false, 1..) => Some("expected `)`"),
            (false, 0) => None,
        };
        self.p.complete(init, InitValue);
        if let Some(message) = fault {
            self.missing(message);
        }
        fault.is_none()
    }

    fn at_declaration(&self) -> bool {
        self.p.newline_before() && matches!(self.p.nth(1), Some(Colon | Comma | Assign))
    }

    fn data_init(&mut self) {
        match self.p.current() {
            Some(Semicolon | Elision) => return self.p.bump(),
            Some(Ident | QuotedSymbol | LocalName | Address) if self.keyword().is_none() => {}
            _ => return self.bad_statement("expected an assignment such as `name := 5;`"),
        }
        let init = self.p.start();
        let read = match self.operand() {
            Read::Done if self.p.at(Assign) && !self.p.newline_before() => self.init_value(),
            Read::Faulty => false,
            Read::Done | Read::Absent => {
                self.missing("expected `:=` and a value");
                false
            }
        };
        if read {
            self.end_statement("assignment");
        } else {
            self.skip_statement();
            self.p.eat(Semicolon);
        }
        self.p.complete(init, DataInit);
    }

    // Code.

    /// Code without a block around it.
    fn listing(&mut self) {
        let listing = self.p.start();
        if self.at_listing_header() {
            let header = self.p.start();
            self.p.bump();
            self.block_name();
            while !self.p.at_end() && !self.p.eat(Colon) {
                self.p.bump();
            }
            self.p.complete(header, BlockHeader);
        }
        while !self.p.at_end() && self.block_kind().is_none() && !self.at_listing_header() {
            match self.keyword() {
                Some(Keyword::EndBlock(kind)) => {
                    self.bad_statement(format!("`END_{0}` without `{0}`", kind.keyword()));
                }
                _ => self.network(true),
            }
        }
        self.p.complete(listing, Listing);
    }

    /// `Bloc FC1 :` on a line of its own, which documents put above a listing (S7:826).
    fn at_listing_header(&self) -> bool {
        self.p.at(Ident)
            && self.p.newline_before()
            && matches!(self.p.nth(1), Some(Ident | Address | QuotedSymbol))
            && self.ends_listing_header(2)
            && ["BLOC", "BLOCK", "BAUSTEIN"].into_iter().any(|it| self.p.at_text(it))
    }

    /// A colon at the end of the line, with at most a short remark in parentheses before it (S7:1316).
    fn ends_listing_header(&self, from: usize) -> bool {
        const LONGEST_REMARK: usize = 12;
        if self.p.nth(from) == Some(Colon) {
            return self.p.nth_newline_before(from + 1);
        }
        if self.p.nth(from) != Some(LParen) {
            return false;
        }
        let close = (from + 1..from + LONGEST_REMARK).find(|&at| self.p.nth(at) == Some(RParen));
        close.is_some_and(|at| {
            let on_one_line = (from..=at + 1).all(|it| !self.p.nth_newline_before(it));
            on_one_line && self.p.nth(at + 1) == Some(Colon) && self.p.nth_newline_before(at + 2)
        })
    }

    /// One network; consumes a token at least, unless the block or listing ends here.
    fn network(&mut self, in_listing: bool) {
        let network = self.p.start();
        match self.keyword() {
            Some(Keyword::Network) => {
                let header = self.p.start();
                self.p.bump();
                if !self.p.newline_before() {
                    self.p.eat(Number);
                    if self.p.eat(Colon) {
                        self.p.eat(FreeText);
                    }
                }
                self.p.eat(Semicolon);
                if self.keyword() == Some(Keyword::Title) {
                    self.title_line();
                }
                self.p.complete(header, NetworkHeader);
            }
            Some(Keyword::Title) => {
                let header = self.p.start();
                self.title_line();
                self.p.complete(header, NetworkHeader);
            }
            _ => {}
        }
        while let Some(kind) = self.p.current() {
            if matches!(kind, Semicolon | Elision) {
                self.p.bump();
                continue;
            }
            if self.at_label() {
                self.labelled_instr();
                continue;
            }
            if let Some(op) = self.op_here() {
                let instr = self.p.start();
                self.known_instr(op);
                self.p.complete(instr, Instr);
                continue;
            }
            match kind {
                Ident => match self.keyword() {
                    Some(Keyword::Network | Keyword::EndBlock(_)) => break,
                    Some(Keyword::Block(_)) if self.block_kind().is_some() => break,
                    Some(Keyword::Begin) => self.bad_statement("`BEGIN` is not allowed in code"),
                    Some(Keyword::Title) => {
                        self.p.error("a title stands right after its `NETWORK`");
                        self.title_line();
                    }
                    Some(Keyword::Var | Keyword::Struct) => {
                        self.p.error("declarations are not allowed in code");
                        self.var_section();
                    }
                    Some(
                        Keyword::Block(_)
                        | Keyword::EndVar
                        | Keyword::EndStruct
                        | Keyword::Property
                        | Keyword::Flag
                        | Keyword::PrintedNetwork,
                    ) => self.bad_statement(format!("`{}` is not allowed in code", self.p.current_text())),
                    None if in_listing && self.at_listing_header() => break,
                    None => self.unknown_instr(),
                },
                Operator => self.unknown_instr(),
                _ => self.bad_statement("expected an instruction"),
            }
        }
        self.p.complete(network, Network);
    }

    fn at_label(&self) -> bool {
        self.p.at(Ident) && self.p.nth(1) == Some(Colon) && !self.p.nth_newline_before(1)
    }

    /// The instruction whose mnemonic starts here.
    fn op_here(&self) -> Option<Op> {
        let text = self.p.current_text();
        match self.p.current()? {
            Ident if self.at_open_paren() => {
                instruction::lookup_open(text, self.mnemonics).or_else(|| instruction::lookup(text, self.mnemonics))
            }
            Ident | Operator | Eq | Plus => instruction::lookup(text, self.mnemonics),
            RParen if self.at_mcr_close() => Some(Op::McrClose),
            RParen => Some(Op::Close),
            _ => None,
        }
    }

    fn at_open_paren(&self) -> bool {
        self.p.nth(1) == Some(LParen) && !self.p.nth_newline_before(1)
    }

    fn at_mcr_close(&self) -> bool {
        self.p.nth(1) == Some(Ident) && !self.p.nth_newline_before(1) && self.p.nth_text(1).eq_ignore_ascii_case("MCR")
    }

    fn labelled_instr(&mut self) {
        let instr = self.p.start();
        let label = self.p.start();
        self.p.bump();
        self.p.bump();
        self.p.complete(label, Label);
        let alone = self.at_statement_end() || self.p.at(Elision) || self.at_label() || self.keyword().is_some();
        if alone {
            self.p.eat(Semicolon);
        } else {
            match self.op_here() {
                Some(op) => self.known_instr(op),
                None => self.unknown_mnemonic(),
            }
        }
        self.p.complete(instr, Instr);
    }

    fn unknown_instr(&mut self) {
        let instr = self.p.start();
        self.unknown_mnemonic();
        self.p.complete(instr, Instr);
    }

    fn known_instr(&mut self, op: Op) {
        let word = self.p.current_text();
        let rule = match op {
            // `NOP0`
            Op::Nop if word.len() == 4 => OperandRule::None,
            _ => op.operand(),
        };
        match self.p.current() {
            Some(Ident | RParen) => self.p.bump(),
            // `=` and `+`
            _ => self.p.bump_as(Operator),
        }
        if matches!(op, Op::McrClose) || (self.p.at(LParen) && opens(op)) {
            self.p.bump();
        }
        let read = match rule {
            OperandRule::None if self.at_statement_end() => Read::Done,
            OperandRule::None => {
                self.p.error(format!("`{word}` takes no operand"));
                Read::Faulty
            }
            OperandRule::Optional(_) if self.at_statement_end() => Read::Done,
            OperandRule::Optional(kind) | OperandRule::Required(kind) => {
                let symbolic = self.p.at(QuotedSymbol);
                let read = if self.at_statement_end() { Read::Absent } else { self.operand() };
                if read == Read::Absent {
                    self.missing(format!("`{word}` needs {} as its operand", kind.describe()));
                    Read::Faulty
                } else if read == Read::Done && op == Op::Call {
                    self.call_tail()
                } else {
                    // A listing printed with symbol information: `U "start"   E 0.0  -- start button`.
                    if symbolic && self.p.at(Address) && !self.p.newline_before() {
                        self.p.bump();
                    }
                    read
                }
            }
        };
        if read == Read::Faulty {
            self.skip_statement();
            self.p.eat(Semicolon);
        } else {
            self.end_statement("instruction");
        }
    }

    fn unknown_mnemonic(&mut self) {
        let word = self.p.current_text();
        let message = match self.p.current() {
            Some(Ident) if self.p.nth(1) == Some(Assign) => format!("the parameter `{word}` belongs to no `CALL`"),
            Some(Unknown) => unknown_token(word).to_owned(),
            Some(Ident | Operator) => {
                let hint = match (instruction::only_in(word.as_bytes()), self.mnemonics) {
                    (Some(Mnemonics::German), Mnemonics::English) => {
                        "; it is a German (SIMATIC) mnemonic, and this program is read with the international ones"
                    }
                    (Some(Mnemonics::English), Mnemonics::German) => {
                        "; it is an international mnemonic, and this program is read with the German (SIMATIC) ones"
                    }
                    _ => "",
                };
                format!("unknown instruction `{word}`{hint}")
            }
            _ => "expected an instruction".to_owned(),
        };
        self.p.error(message);
        self.p.bump();
        self.skip_statement();
        self.p.eat(Semicolon);
    }

    /// After the callee: the instance data block and the parameters.
    fn call_tail(&mut self) -> Read {
        if self.p.at(Comma) && !self.p.newline_before() {
            self.p.bump();
            let read = if self.at_statement_end() { Read::Absent } else { self.operand() };
            if read == Read::Absent {
                self.missing("expected the instance data block after `,`");
            }
            if read != Read::Done {
                return Read::Faulty;
            }
        }
        if !self.at_statement_end() && !matches!(self.p.current(), Some(LParen | Attribute)) && !self.at_argument() {
            self.p.error("expected the parameters or the end of the instruction");
            self.skip_while(|kind| kind != LParen);
        }
        // The parenthesis may stand on the next line: no instruction starts with one.
        // TIA Portal writes the type of a general block before it: `{time_type := 'Time'}`.
        while self.p.at(Attribute) {
            self.p.bump();
        }
        if self.p.at(LParen) {
            self.closed_arguments();
        } else if self.at_argument() {
            let list = self.p.start();
            while self.at_argument() {
                self.argument(false);
                self.p.eat(Comma);
            }
            self.p.complete(list, ArgList);
        }
        Read::Done
    }

    fn at_argument(&self) -> bool {
        matches!(self.p.current(), Some(Ident | Address | QuotedSymbol | LocalName)) && self.p.nth(1) == Some(Assign)
    }

    /// `( a := 1, b := MW 0 )` over any number of lines; commas are not insisted on.
    fn closed_arguments(&mut self) {
        let list = self.p.start();
        let opening = self.p.current_range();
        self.p.bump();
        loop {
            match self.p.current() {
                Some(RParen) => {
                    self.p.bump();
                    break;
                }
                Some(Comma | Elision) => self.p.bump(),
                _ if self.at_argument() => self.argument(true),
                None | Some(Semicolon) => {
                    self.p.error_at(opening, "the parameters of this `CALL` are not closed: expected `)`");
                    break;
                }
                Some(_) if self.p.newline_before() && self.at_statement() => {
                    self.p.error_at(opening, "the parameters of this `CALL` are not closed: expected `)`");
                    break;
                }
                Some(_) => {
                    self.p.error("expected a parameter such as `name := value`");
                    let error = self.p.start();
                    self.p.bump();
                    while !self.at_statement_end() && !matches!(self.p.current(), Some(Comma | RParen)) {
                        self.p.bump();
                    }
                    self.p.complete(error, Error);
                }
            }
        }
        self.p.complete(list, ArgList);
    }

    fn at_statement(&self) -> bool {
        self.at_label() || self.keyword().is_some() || self.op_here().is_some()
    }

    /// `name := value`; the value may be absent. Inside parentheses it may stand on the next line.
    fn argument(&mut self, closed: bool) {
        let arg = self.p.start();
        if self.p.at(Address) {
            self.p.bump_as(Ident);
        } else {
            self.p.bump();
        }
        self.p.bump();
        let ends = |grammar: &Self| {
            grammar.at_statement_end() || matches!(grammar.p.current(), Some(Comma | RParen)) || grammar.at_argument()
        };
        let on_next_line = closed && self.p.newline_before() && !self.at_argument() && !self.at_statement();
        if on_next_line || !ends(self) {
            let read = self.operand();
            if read == Read::Absent && !matches!(self.p.current(), Some(Comma | RParen | Semicolon) | None) {
                self.p.error("expected the value of the parameter");
            } else if read == Read::Done && !ends(self) {
                self.p.error("expected `,` or the end of the parameter");
            }
            self.skip_while(|kind| !matches!(kind, Comma | RParen));
        }
        self.p.complete(arg, Arg);
    }

    // Operands.

    fn operand(&mut self) -> Read {
        let operand = self.p.start();
        let read = self.operand_tokens();
        if read == Read::Absent {
            self.p.abandon(operand);
        } else {
            self.p.complete(operand, Operand);
        }
        read
    }

    fn operand_tokens(&mut self) -> Read {
        match self.p.current() {
            Some(Number | TypedConstant | CharString) => {
                self.p.bump();
                Read::Done
            }
            // A status bit: `==0`.
            Some(Operator) if self.p.current_text().ends_with('0') => {
                self.p.bump();
                Read::Done
            }
            Some(Plus | Minus) if self.p.nth(1) == Some(Number) => {
                self.p.bump();
                self.p.bump();
                Read::Done
            }
            Some(PointerConstant) => {
                let symbolic = self.p.current_text().len() == 2;
                self.p.bump();
                if !symbolic {
                    return Read::Done;
                }
                if self.p.newline_before()
                    || !matches!(self.p.current(), Some(LocalName | QuotedSymbol | Ident | Address))
                {
                    self.missing("expected an address or a name after `P#`");
                    return Read::Faulty;
                }
                self.p.bump();
                self.path()
            }
            Some(Percent) if matches!(self.p.nth(1), Some(Address | Ident)) => {
                self.p.bump();
                self.p.bump();
                self.path()
            }
            Some(Address | QuotedSymbol | LocalName) => {
                self.p.bump();
                self.path()
            }
            Some(Ident) => {
                let area = super::lexer::is_area(self.p.current_text().as_bytes());
                self.p.bump();
                if area && self.p.at(Number) && !self.p.newline_before() {
                    self.p.bump();
                }
                self.path()
            }
            Some(LBrack) => self.path(),
            Some(Unknown) => {
                self.p.error(unknown_token(self.p.current_text()));
                Read::Faulty
            }
            _ => Read::Absent,
        }
    }

    /// `.field[3, #i].x`, and the register-indirect `[AR1, P#0.0]`. Of TIA Portal: `:P` behind what is read or written at once.
    fn path(&mut self) -> Read {
        while !self.p.newline_before() {
            match self.p.current() {
                Some(Dot) => {
                    self.p.bump();
                    let is_name = matches!(self.p.current(), Some(Ident | Address | QuotedSymbol | LocalName | Number));
                    if !is_name || self.p.newline_before() {
                        self.missing("expected a name after `.`");
                        return Read::Faulty;
                    }
                    self.p.bump();
                }
                Some(LBrack) => {
                    let mnemonics = self.mnemonics;
                    match self.p.nested(|p| Grammar { p, mnemonics }.index()) {
                        Some(Read::Done) => {}
                        _ => return Read::Faulty,
                    }
                }
                Some(Colon) if self.p.nth(1) == Some(Ident) && self.p.nth_text(1).eq_ignore_ascii_case("P") => {
                    self.p.bump();
                    self.p.bump();
                }
                _ => break,
            }
        }
        Read::Done
    }

    fn index(&mut self) -> Read {
        self.p.bump();
        loop {
            let read = if self.at_statement_end() { Read::Absent } else { self.operand() };
            if read == Read::Absent {
                self.missing("expected an index or address");
            }
            if read != Read::Done {
                return Read::Faulty;
            }
            if self.p.newline_before() || !self.p.eat(Comma) {
                break;
            }
        }
        if self.p.newline_before() || !self.p.eat(RBrack) {
            self.missing("expected `]`");
            return Read::Faulty;
        }
        Read::Done
    }
}

fn opens(op: Op) -> bool {
    matches!(op, Op::AndOpen | Op::AndNotOpen | Op::OrOpen | Op::OrNotOpen | Op::XorOpen | Op::XorNotOpen | Op::McrOpen)
}

fn unknown_token(text: &str) -> &'static str {
    match text.chars().next() {
        Some('"') => "this name is not closed: expected `\"`",
        Some('«') => "this name is not closed: expected `»`",
        Some('“') => "this name is not closed: expected `”`",
        Some('\'') => "this text is not closed: expected `'`",
        Some('{') => "this attribute is not closed: expected `}`",
        _ => "this is not a character of the language",
    }
}
