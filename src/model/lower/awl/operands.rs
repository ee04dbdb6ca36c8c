//! Declarations, addresses and constants.

use rowan::TextRange;
use smol_str::SmolStr;

use super::Machine;
use crate::model::expr::{ExprId, Exprs, ObjectId};
use crate::model::literal::{self, Value};
use crate::model::object::{self, Class, Footprint, Object, Rights, Type};
use crate::model::unit::{Constant, Declaration, OddityKind, Section};
use crate::syntax::awl::ast;
use crate::syntax::{AstNode as _, Language, Mnemonics, SyntaxKind, SyntaxNode};

#[derive(Debug, Clone)]
pub(super) enum Operand {
    Object(ObjectId),
    /// The constant, and how it was written.
    Constant(ExprId),
    /// A word that is neither: a label, a block.
    Other,
}

impl Machine {
    pub(super) fn declarations(&mut self, block: SyntaxNode<'_>) {
        for section in block.children().filter_map(ast::VarSection::cast) {
            let Some(keyword) = section.keyword() else { continue };
            let kind = match keyword.text().to_ascii_uppercase().as_str() {
                "VAR_INPUT" => Section::Input,
                "VAR_OUTPUT" => Section::Output,
                "VAR_IN_OUT" => Section::InOut,
                "VAR_TEMP" => Section::Temp,
                _ => Section::Static,
            };
            for decl in section.decls() {
                let ty: String = match decl.type_ref() {
                    Some(ty) => ty.text().split_whitespace().collect(),
                    None if decl.array_type().is_some() => "ARRAY".to_owned(),
                    None => "STRUCT".to_owned(),
                };
                self.initial_value(decl.init());
                let (kind, ty) = match self.is_step5() {
                    true => {
                        let (section, ty) = Self::formal_operand(decl);
                        (section, ty.to_owned())
                    }
                    false => (kind, ty),
                };
                for name in decl.names() {
                    let range = name.range();
                    let name = SmolStr::new(name.text().to_lowercase());
                    self.declared.insert(name.clone(), declared_type(&ty));
                    let ty = SmolStr::new(&ty);
                    self.b.model.declarations.push(Declaration { name, section: kind, ty, range });
                }
            }
        }
    }

    /// Reads the constant of `:= S5T#1S`. Repetitions and lists of array elements are left alone.
    pub(super) fn initial_value(&mut self, value: Option<ast::InitValue>) {
        let Some(value) = value else { return };
        let mut text = smol_str::SmolStrBuilder::new();
        let mut range: Option<TextRange> = None;
        for token in value.tokens() {
            if !matches!(
                token.kind(),
                SyntaxKind::Number | SyntaxKind::TypedConstant | SyntaxKind::Plus | SyntaxKind::Minus
            ) {
                return;
            }
            text.push_str(token.text());
            range = Some(range.map_or(token.text_range(), |it| it.cover(token.text_range())));
        }
        if let Some(range) = range {
            self.constant(&text.finish(), range);
        }
    }

    pub(super) fn operand(&mut self, node: &ast::Operand) -> Operand {
        let text = bare_text(node);
        if let Some(known) = self.operands.get(&text) {
            return known.clone();
        }
        if let Language::Step5(mnemonics) = self.language {
            let operand = self.step5_operand(node, &text, mnemonics);
            if let Operand::Object(object) = operand
                && !self.modified
                && !self.is_place_dependent(object)
            {
                self.operands.insert(text, operand.clone());
            }
            return operand;
        }
        let range = node.range();
        let first = first_kind(node);
        let has_index = is_indexed(node);
        let operand = match first {
            Some(
                SyntaxKind::Number | SyntaxKind::TypedConstant | SyntaxKind::CharString | SyntaxKind::PointerConstant,
            )
            | Some(SyntaxKind::Plus | SyntaxKind::Minus | SyntaxKind::Hash) => return self.constant(&text, range),
            Some(SyntaxKind::LocalName) => Operand::Object(self.local(&text, has_index)),
            Some(SyntaxKind::QuotedSymbol) => {
                let mut object = Object::symbol(&text);
                object.indexed = has_index;
                Operand::Object(self.b.object(object))
            }
            Some(SyntaxKind::LBrack) => Operand::Object(self.indirect(&text, Type::Unknown)),
            Some(_) if has_index => {
                for inner in node.indices() {
                    if let Operand::Object(object) = self.operand(&inner) {
                        self.b.read(object, inner.range());
                    }
                }
                // Not cached: the index is read each time.
                let ty = indirect_type(&text);
                return Operand::Object(self.indirect(&text, ty));
            }
            Some(_) => match text.to_ascii_uppercase().as_str() {
                "TRUE" => Operand::Constant(Exprs::TRUE),
                "FALSE" => Operand::Constant(Exprs::FALSE),
                "AR1" | "AR2" => Operand::Other,
                // Not cached when it is none: each place is reported.
                _ => match self.address(&text, range) {
                    Ok(object) => Operand::Object(object),
                    Err(object) => return Operand::Object(object),
                },
            },
            None => Operand::Other,
        };
        if !matches!(operand, Operand::Other) {
            self.operands.insert(text, operand.clone());
        }
        operand
    }

    /// Whether the same text may be another object, or is to be reported, at another place.
    fn is_place_dependent(&self, object: ObjectId) -> bool {
        let class = self.b.model.objects[object.0 as usize].class;
        matches!(class, Class::Indirect | Class::PeripheralInput | Class::PeripheralOutput)
    }

    pub(super) fn indirect(&mut self, text: &str, ty: Type) -> ObjectId {
        self.b.object(Object {
            text: text.into(),
            class: Class::Indirect,
            ty,
            footprint: Footprint::new(object::Area::Indirect, 0, 1),
            rights: Rights::Unknown,
            extracted: false,
            indexed: false,
        })
    }

    pub(super) fn local(&mut self, text: &str, indexed: bool) -> ObjectId {
        let name = text.trim_start_matches('#').replace('"', "").to_lowercase();
        let root = name.split(['.', '[']).next().unwrap_or_default();
        let ty = if root == name { self.declared.get(root).copied().unwrap_or(Type::Unknown) } else { Type::Unknown };
        self.b.object(Object {
            text: text.into(),
            class: Class::LocalName,
            ty,
            footprint: Footprint::new(object::Area::LocalName(name.as_str().into()), 0, 1),
            rights: Rights::Unknown,
            extracted: false,
            indexed,
        })
    }

    /// `Err`: what stands for a text that is no address.
    pub(super) fn address(&mut self, text: &str, range: TextRange) -> Result<ObjectId, ObjectId> {
        let root = text.split(['.', '[']).next().unwrap_or_default().to_lowercase();
        if self.declared.contains_key(root.as_str()) {
            return Ok(self.local(text, false));
        }
        let Language::Awl(mnemonics) = self.language else { return Ok(self.b.object(Object::symbol(text))) };
        match object::step7::parse(text, mnemonics) {
            Ok(object) => Ok(self.b.object(object)),
            Err(error) if error.suggestion.is_none() && is_bare_symbol(text, mnemonics) => {
                Ok(self.b.object(Object::symbol(text)))
            }
            Err(error) => Err(self.no_address(text, error, range)),
        }
    }

    pub(super) fn constant(&mut self, text: &SmolStr, range: TextRange) -> Operand {
        let read = if self.is_step5() { literal::parse_step5(text) } else { literal::parse_step7(text) };
        let value = match read {
            Ok(value) => value,
            Err(error) => {
                self.b.oddity(OddityKind::Literal(error), range, text.clone());
                return Operand::Constant(self.b.exprs().opaque());
            }
        };
        let expr = match &value {
            Value::Bool(value) => Exprs::bool(*value),
            Value::Int { value, .. } => self.b.exprs().int(*value),
            Value::Count(value) => self.b.exprs().int(i64::from(*value)),
            Value::Real(value) => self.b.exprs().float(*value),
            Value::S5Time { .. } | Value::Time { .. } | Value::Text(_) | Value::Other => self.b.exprs().text(text),
        };
        if matches!(value, Value::S5Time { .. } | Value::Time { .. }) {
            self.b.model.constants.push(Constant { value, range, text: text.clone() });
        }
        Operand::Constant(expr)
    }

    pub(super) fn object_operand(&mut self, instr: &ast::Instr) -> Option<(ObjectId, TextRange)> {
        let node = instr.operand()?;
        match self.operand(&node) {
            Operand::Object(object) => {
                let range = node.range();
                Some((self.resolve(object, range), range))
            }
            Operand::Constant(_) | Operand::Other => None,
        }
    }

    /// Records a read of a bit or word.
    pub(super) fn read(&mut self, object: ObjectId, range: TextRange) -> ExprId {
        let indirect = self.b.model.objects[object.0 as usize].class == Class::Indirect;
        self.b.model.reads_indirectly |= indirect;
        if indirect {
            self.b.read(object, range);
            return self.b.exprs().opaque();
        }
        self.b.read(object, range)
    }

    pub(super) fn note_write(&mut self, object: ObjectId) {
        if self.b.model.objects[object.0 as usize].class == Class::Indirect {
            self.b.model.writes_indirectly = true;
            self.b.wipe();
        }
    }
}

/// Whether a word that is no address may be a symbol without its quotes: it has not the form of one, letters and a
/// number, and a number is not all that it lacks.
pub(super) fn is_bare_symbol(text: &str, mnemonics: Mnemonics) -> bool {
    let letters = text.bytes().take_while(u8::is_ascii_alphabetic).count();
    let numbered = letters <= 4 && text.as_bytes().get(letters).is_some_and(u8::is_ascii_digit);
    let is_word = text.chars().all(|it| it.is_alphanumeric() || matches!(it, '_' | '.'));
    let lacks_number = || ["0", "0.0"].iter().any(|it| object::step7::parse(&format!("{text}{it}"), mnemonics).is_ok());
    is_word && !numbered && !lacks_number()
}

/// Size of a declared elementary type.
pub(super) fn declared_type(ty: &str) -> Type {
    match ty.to_ascii_uppercase().as_str() {
        "BOOL" => Type::Bool,
        "BYTE" | "CHAR" => Type::Byte,
        "WORD" | "INT" | "S5TIME" | "DATE" => Type::Word,
        "DWORD" | "DINT" | "TIME" | "TIME_OF_DAY" | "TOD" => Type::Double,
        "REAL" => Type::Float,
        "TIMER" | "COUNTER" => Type::Block,
        _ => Type::Unknown,
    }
}

/// Size of a place given by a pointer: `MW [...]`, `DBB [...]`, `M [...]`.
pub(super) fn indirect_type(text: &str) -> Type {
    let prefix = text.split('[').next().unwrap_or_default().to_ascii_uppercase();
    match prefix.as_str() {
        "T" | "C" | "Z" | "DB" | "DI" | "FB" | "FC" => Type::Block,
        it if it.len() > 1 && it.ends_with('B') => Type::Byte,
        it if it.ends_with('W') => Type::Word,
        it if it.len() > 1 && it.ends_with('D') => Type::Double,
        "" => Type::Unknown,
        _ => Type::Bool,
    }
}

/// The operand without blanks: `M0.0`, `DB5.DBW0`.
pub(super) fn bare_text(operand: &ast::Operand) -> SmolStr {
    let mut text = smol_str::SmolStrBuilder::new();
    for token in operand.tokens() {
        text.push_str(token.text());
    }
    text.finish()
}

pub(super) fn first_kind(operand: &ast::Operand) -> Option<SyntaxKind> {
    operand.first_token().map(|it| it.kind())
}

pub(super) fn is_indexed(operand: &ast::Operand) -> bool {
    operand.syntax().children_with_tokens().any(|it| it.kind() == SyntaxKind::LBrack)
}
