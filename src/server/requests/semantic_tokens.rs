//! `textDocument/semanticTokens/full`: what each word is.

use lsp_types::{SemanticToken, SemanticTokenTypes, SemanticTokens, SemanticTokensParams, SemanticTokensRequest};
use rowan::{TextRange, TextSize};

use super::{Answer, Handle};
use crate::db;
use crate::server::snapshot::{InFile, Snapshot};
use crate::source::detect::Detected;
use crate::syntax::{SyntaxKind, WalkEvent};

pub(super) struct Handler;

/// The kinds of words, by number.
const TYPES: [SemanticTokenTypes; 9] = [
    SemanticTokenTypes::Comment,
    SemanticTokenTypes::Keyword,
    SemanticTokenTypes::Variable,
    SemanticTokenTypes::Parameter,
    SemanticTokenTypes::Number,
    SemanticTokenTypes::String,
    SemanticTokenTypes::Operator,
    SemanticTokenTypes::Function,
    // Labels: `label` itself is known since version 3.18 of the protocol only.
    SemanticTokenTypes::EnumMember,
];

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Type {
    Comment,
    Keyword,
    Variable,
    Parameter,
    Number,
    String,
    Operator,
    Function,
    Label,
}

pub(in crate::server) fn legend() -> Vec<String> {
    TYPES.into_iter().map(String::from).collect()
}

impl Handle for Handler {
    type Request = SemanticTokensRequest;
    const RETRY: bool = true;

    fn handle(snapshot: &Snapshot, params: SemanticTokensParams) -> Answer<Self::Request> {
        let Some(it) = snapshot.file(&params.text_document.uri) else { return Ok(None) };
        if it.file.detected(it.db) == Detected::Stx {
            return Ok(None);
        }
        let mut writer = Writer { it, line: 0, start: 0, data: Vec::new() };
        for &(unit, offset) in db::layout(it.db, it.file) {
            let mut open: Vec<SyntaxKind> = Vec::new();
            for event in db::tree(it.db, unit).syntax().walk() {
                match event {
                    WalkEvent::Enter(node) => open.push(node.kind()),
                    WalkEvent::Leave(_) => {
                        open.pop();
                    }
                    WalkEvent::Token(token) => {
                        if let Some(ty) = ty(token.kind(), &open) {
                            writer.write(token.text_range() + TextSize::new(offset), ty);
                        }
                    }
                }
            }
        }
        Ok(Some(SemanticTokens { result_id: None, data: writer.data }))
    }
}

fn ty(token: SyntaxKind, open: &[SyntaxKind]) -> Option<Type> {
    use SyntaxKind as K;
    let parent = open.last().copied().unwrap_or(K::Root);
    if parent == K::Heading {
        return None;
    }
    Some(match token {
        K::Comment | K::UnclosedComment => Type::Comment,
        K::Number | K::TypedConstant | K::PointerConstant => Type::Number,
        K::CharString | K::FreeText | K::Attribute => Type::String,
        K::QuotedSymbol | K::Address | K::ObjectAddress | K::ObjectSuffix => match parent {
            K::BlockName => Type::Function,
            _ => Type::Variable,
        },
        K::LocalName => Type::Parameter,
        K::LabelAddress => Type::Label,
        K::Ident => match parent {
            K::NameRef | K::DataInit | K::KeyValue => Type::Variable,
            K::Operand => Type::Variable,
            K::VarName | K::Arg => Type::Parameter,
            K::Label | K::LabelDef => Type::Label,
            K::CallExpr | K::BlockName => Type::Function,
            K::StepName => Type::Variable,
            K::Error => return None,
            _ => Type::Keyword,
        },
        K::Operator | K::Assign | K::Eq | K::Ne | K::Lt | K::Le | K::Gt | K::Ge => Type::Operator,
        K::Plus | K::Minus | K::Star | K::Slash | K::Arrow => Type::Operator,
        K::SentenceStart | K::SentenceEnd | K::BlockMark => Type::Keyword,
        _ => return None,
    })
}

/// Writes each token relative to the one before it.
struct Writer<'s> {
    it: InFile<'s>,
    line: u32,
    start: u32,
    data: Vec<SemanticToken>,
}

impl Writer<'_> {
    /// A token of several lines becomes several: few clients know others.
    fn write(&mut self, range: TextRange, ty: Type) {
        let lines = db::lines(self.it.db, self.it.file);
        let text = self.it.file.text(self.it.db);
        let encoding = self.it.snapshot.encoding();
        let last = lines.line_col(range.end()).line;
        for number in lines.line_col(range.start()).line..=last {
            let (Some(line), Some(content)) = (lines.line_range(number), lines.line_text(text, number)) else { break };
            let content = TextRange::at(line.start(), TextSize::of(content));
            let Some(part) = range.intersect(content).filter(|it| !it.is_empty()) else { continue };
            let Some(text) = text.get(std::ops::Range::<usize>::from(part)) else { continue };
            let at = encoding.position(lines, part.start());
            let delta_line = at.line - self.line;
            let delta_start = if delta_line == 0 { at.character - self.start } else { at.character };
            (self.line, self.start) = (at.line, at.character);
            self.data.push(SemanticToken {
                delta_line,
                delta_start,
                length: encoding.length(text),
                token_type: ty as u32,
                token_modifiers_bitset: 0,
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_legend_has_every_type() {
        assert_eq!(legend().len(), Type::Label as usize + 1);
        assert_eq!(legend()[Type::Number as usize], "number");
        assert_eq!(legend()[Type::Function as usize], "function");
    }
}
