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
    let mut lowering =
        Lowering { b: Builder::new(entity, Language::Exchange, TextRange::default(), root.text_range().len()), text };
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
            match object::declared(&address) {
                Ok(object) => Some(object),
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
        let inner = Remark::inner(whole);
        let offset = whole.find(inner).and_then(|it| TextSize::try_from(it).ok()).unwrap_or_default();
        let text = TextRange::at(range.start() + offset, TextSize::of(inner));
        let remark = Remark::new(kind, whole, range);
        self.b.model.remarks.push(remark);
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::syntax::exchange;

    fn model(text: &str) -> UnitModel {
        let parse = exchange::parse(text);
        assert_eq!(parse.errors(), []);
        lower(parse.syntax(), text, Entity::Container)
    }

    /// Name, address, type, initial value and comment of each declaration.
    #[track_caller]
    fn check(text: &str, expected: &[[&str; 5]]) {
        let model = model(text);
        let found: Vec<[&str; 5]> = model
            .symbols
            .iter()
            .map(|it| {
                let place = std::ops::Range::<usize>::from(model.place(it.anchor));
                assert_eq!(text.get(place), Some(it.name.as_str()));
                let address = it.object.as_ref().map_or("", |it| it.text.as_str());
                let (initial, comment) = (it.initial.as_deref(), it.comment.as_deref());
                [it.name.as_str(), address, it.ty.as_str(), initial.unwrap_or_default(), comment.unwrap_or_default()]
            })
            .collect();
        assert_eq!(found, expected, "{text}");
    }

    #[test]
    fn declarations() {
        check(
            "[DATA_UNIT]\nVAR_GLOBAL\nPump AT %M0 : EBOOL (* a (b) *); Cpt_vis : Cpt_pieces (**);\n\
             Lim AT %KW3:WORD:=16#FF ; Tab AT %MW10:5 : AR_W : 5;\r\nÉtat AT %MW4:X2\nEND_VAR\n",
            &[
                ["Pump", "%M0", "EBOOL", "", "a (b)"],
                ["Cpt_vis", "", "Cpt_pieces", "", ""],
                ["Lim", "%KW3", "WORD", "16#FF", ""],
                ["Tab", "%MW10:5", "AR_W:5", "", ""],
                ["État", "%MW4:X2", "", "", ""],
            ],
        );
    }

    #[test]
    fn odd_declarations() {
        check(
            "VAR_GLOBAL Pump AT %M0; (* behind *)\nMotor AT %M1 : EBOOL;\n(* of the next *) Vitesse AT %MW1 : WORD\n\
             Variateur AT %M2; 2x AT %M3; Pump-1 AT %M4; at %M5; Var at %M6;\nOne AT %M7 : EBOOL Two AT %M8 : EBOOL;\nEND_VAR",
            &[
                ["Pump", "%M0", "", "", "behind"],
                ["Motor", "%M1", "EBOOL", "", ""],
                ["Vitesse", "%MW1", "WORD", "", ""],
                ["Variateur", "%M2", "", "", ""],
                ["2x", "%M3", "", "", ""],
                ["Pump-1", "%M4", "", "", ""],
                ["Var", "%M6", "", "", ""],
                ["One", "%M7", "EBOOL", "", ""],
                ["Two", "%M8", "EBOOL", "", ""],
            ],
        );
        // Nothing of the vendor's part declares anything.
        check("[VENDOR]\nPump AT %M0 : EBOOL;\n[DATA_UNIT]\nMotor AT %M1;\n", &[["Motor", "%M1", "", "", ""]]);
    }

    #[test]
    fn addresses_of_pl7_2() {
        check(
            "VAR_GLOBAL\nDepart AT I0,05 : BOOL; Pompe AT B3 : BOOL;\nMot AT W10 : WORD (*a*);Tempo AT T0; Fin AT %O0,05 ;\n\
             Bit AT W5,A : BOOL; Texte AT TXT3,2;\nSuite AT B0[16] : BOOL;\nEND_VAR",
            &[
                ["Depart", "I0,05", "BOOL", "", ""],
                ["Pompe", "B3", "BOOL", "", ""],
                ["Mot", "W10", "WORD", "", "a"],
                ["Tempo", "T0", "", "", ""],
                ["Fin", "%O0,05", "", "", ""],
                ["Bit", "W5,A", "BOOL", "", ""],
                ["Texte", "", "", "", ""],
                ["Suite", "B0[16]", "BOOL", "", ""],
            ],
        );
        // Nothing of the kind: words that happen to stand so.
        check("[APPLICATION]\nLOOK AT the pump 3, please\nMeet AT 10;\n", &[]);
    }

    #[test]
    fn addresses_that_are_none() {
        let model = model("Pump AT %MX0 : EBOOL; Axis AT %CH2.0 : BOOL; Late AT %MW3:X20 : BOOL;");
        let errors: Vec<&str> = model.oddities.iter().map(|it| it.text.as_str()).collect();
        assert_eq!(errors, ["%MX0", "%MW3:X20"], "a channel may have a symbol (PL7:1264)");
        assert_eq!(model.symbols.iter().map(|it| it.object.is_some()).collect::<Vec<_>>(), [false, true, false]);
    }

    #[test]
    fn lengths_of_comments() {
        let model = model("[SOURCE_UNIT]\nCOMMENT = 'année' NAME = 'x'\n[DATA_UNIT]\nPump AT %M0 (*  été *);");
        let found: Vec<_> = model.remarks.iter().map(|it| (it.kind, it.characters)).collect();
        assert_eq!(found, [(RemarkKind::Module, 5), (RemarkKind::Symbol, 3)]);
    }
}
