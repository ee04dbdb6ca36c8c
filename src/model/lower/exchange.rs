//! What surrounds the programs of a PL7 application: declarations of variables, comments of modules.

use rowan::{TextRange, TextSize};
use smol_str::SmolStr;

use super::builder::Builder;
use crate::model::UnitModel;
use crate::model::entity::Entity;
use crate::model::object;
use crate::model::symbols::{Remark, RemarkKind, Symbol};
use crate::model::unit::OddityKind;
use crate::syntax::{Language, SyntaxKind, SyntaxNode};

pub(super) fn lower(root: SyntaxNode<'_>, text: &str, entity: Entity) -> UnitModel {
    let mut lowering = Lowering { b: Builder::new(entity, Language::Exchange, TextRange::default()), text };
    for node in root.descendants() {
        match node.kind() {
            SyntaxKind::VarDecl => lowering.declaration(node),
            SyntaxKind::KeyValue => lowering.key_value(node),
            _ => {}
        }
    }
    lowering.b.finish()
}

struct Lowering<'t> {
    b: Builder,
    text: &'t str,
}

impl Lowering<'_> {
    fn slice(&self, range: TextRange) -> &str {
        self.text.get(std::ops::Range::<usize>::from(range)).unwrap_or_default()
    }

    /// Text without the blanks in it.
    fn joined(&self, node: SyntaxNode<'_>) -> SmolStr {
        self.slice(node.text_range()).split_whitespace().collect::<String>().into()
    }

    fn declaration(&mut self, node: SyntaxNode<'_>) {
        let child = |kind| node.children().find(|it| it.kind() == kind);
        let Some(name) = child(SyntaxKind::VarName) else { return };
        let range = name.text_range();
        let address = child(SyntaxKind::ObjectRef);
        let object = address.and_then(|it| {
            let (address, at) = (self.joined(it), it.text_range());
            match object::pl7::parse(&address) {
                Ok(object) => Some(object),
                // The generic symbol of a channel (PL7:1264) names no single object.
                Err(_) if address.get(..3).is_some_and(|it| it.eq_ignore_ascii_case("%CH")) => None,
                Err(error) => {
                    self.b.oddity(OddityKind::Address(error), at, address);
                    None
                }
            }
        });
        let comment = self.comment(node).map(|it| self.remark(RemarkKind::Symbol, it));
        let symbol = Symbol {
            name: self.slice(range).into(),
            object,
            ty: child(SyntaxKind::TypeRef).map(|it| self.joined(it)).unwrap_or_default(),
            initial: child(SyntaxKind::InitValue).map(|it| self.joined(it)),
            comment: comment.map(|it| self.slice(it).into()),
            anchor: self.b.anchor(range),
        };
        self.b.model.symbols.push(symbol);
    }

    /// `COMMENT = '...'` of a source unit.
    fn key_value(&mut self, node: SyntaxNode<'_>) {
        let token = |kind| node.tokens().find(|it| it.kind() == kind).map(|it| it.text_range());
        let Some(key) = token(SyntaxKind::Ident) else { return };
        if self.slice(key).eq_ignore_ascii_case("COMMENT")
            && let Some(value) = token(SyntaxKind::CharString)
        {
            self.remark(RemarkKind::Module, value);
        }
    }

    /// The comment of a declaration: before its semicolon, else behind it on the same line.
    fn comment(&self, node: SyntaxNode<'_>) -> Option<TextRange> {
        if let Some(it) = node.tokens().find(|it| it.kind() == SyntaxKind::Comment) {
            return Some(it.text_range());
        }
        let behind = self.text.get(usize::from(node.text_range().end())..)?;
        let start = behind.trim_start_matches([' ', '\t', '\u{a0}']);
        let length = start.strip_prefix("(*")?.find("*)")? + 4;
        let at = node.text_range().end() + (TextSize::of(behind) - TextSize::of(start));
        Some(TextRange::at(at, TextSize::of(start.get(..length)?)))
    }

    /// Notes a comment with its delimiters. Returns the range of its text.
    fn remark(&mut self, kind: RemarkKind, range: TextRange) -> TextRange {
        let whole = self.slice(range);
        let inner = ["(*", "'"].iter().find_map(|it| whole.strip_prefix(it)).unwrap_or(whole).trim_start();
        let offset = TextSize::of(whole) - TextSize::of(inner);
        let trimmed = ["*)", "'"].iter().find_map(|it| inner.strip_suffix(it)).unwrap_or(inner).trim_end();
        let text = TextRange::at(range.start() + offset, TextSize::of(trimmed));
        let characters = u32::try_from(trimmed.chars().count()).unwrap_or(u32::MAX);
        self.b.model.remarks.push(Remark { kind, characters, range });
        text
    }
}
