//! Declarations, addresses and constants.

use rowan::TextRange;
use smol_str::{SmolStr, StrExt as _};

use super::Machine;
use crate::model::entity::BlockKind;
use crate::model::expr::{ExprId, Exprs, ObjectId};
use crate::model::layout::{Elementary, Field, Layout, Layouts};
use crate::model::literal::{self, IntType, Value};
use crate::model::lower::interface;
use crate::model::object::{self, Class, Footprint, Object, Rights, Type};
use crate::model::unit::{Constant, OddityKind, Section};
use crate::syntax::awl::ast;
use crate::syntax::{AstNode as _, Language, SyntaxKind, SyntaxNode};

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
        let sections = block.children().filter_map(ast::VarSection::cast);
        for decl in sections.flat_map(ast::VarSection::decls) {
            self.initial_value(decl.init());
        }
        let declared = match self.is_step5() {
            true => self.formal_operands(block),
            false => interface::declared(block, &mut self.b),
        };
        let (temporary, own): (Vec<Field>, Vec<Field>) =
            declared.fields().iter().cloned().partition(|it| it.section == Section::Temp);
        for it in temporary.iter().chain(&own) {
            self.declared.insert(it.name.clone(), it.ty.elementary());
        }
        self.temporary = Layouts::of_temporary(&temporary);
        // What other blocks are given lies where their caller keeps it, and what those of STEP 5 are given, too.
        if self.b.model.entity.block_kind() == Some(BlockKind::Fb) && !self.is_step5() {
            self.instance = Layouts::of_fields(&own);
        }
        self.b.model.declared = Some(declared);
    }

    /// The type of a variable that the block declares.
    pub(super) fn elementary(&self, object: ObjectId) -> Option<Elementary> {
        let object = self.b.model.object(object);
        if object.class != Class::LocalName {
            return None;
        }
        let name = object::step7::local_name(object)?;
        let place = self.temporary.place(&name).or_else(|| self.instance.place(&name));
        place.and_then(|it| it.ty).or_else(|| self.declared.get(name.as_str()).copied().flatten())
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
        let text = if node.syntax().is_leaf() { node.syntax().text() } else { String::from(bare_text(node)).into() };
        // At once or with the image: the operand is the same.
        let text = text.strip_suffix(":P").or_else(|| text.strip_suffix(":p")).unwrap_or(&text);
        if let Some(known) = self.operands.get(text) {
            return known.clone();
        }
        let text = SmolStr::new(text);
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
        // An element of an array by its number has one place.
        let is_number = |it: ast::Operand<'_>| matches!(first_kind(&it), Some(SyntaxKind::Number | SyntaxKind::Minus));
        let is_fixed = !has_index || node.indices().all(is_number);
        let operand = match first {
            Some(
                SyntaxKind::Number | SyntaxKind::TypedConstant | SyntaxKind::CharString | SyntaxKind::PointerConstant,
            )
            | Some(SyntaxKind::Plus | SyntaxKind::Minus | SyntaxKind::Hash) => return self.constant(&text, range),
            Some(SyntaxKind::LocalName) => Operand::Object(self.local(&text, has_index)),
            Some(SyntaxKind::QuotedSymbol) if is_fixed && is_field(&text) => match self.address(&text, range) {
                Ok(object) => Operand::Object(object),
                Err(object) => return Operand::Object(object),
            },
            Some(SyntaxKind::QuotedSymbol) if !has_index => {
                let mut object = Object::symbol(&text);
                object.indexed = has_index;
                Operand::Object(self.b.object(object))
            }
            Some(SyntaxKind::LBrack) => Operand::Object(self.indirect(&text, Type::Unknown)),
            Some(_) if !is_fixed => {
                for inner in node.indices() {
                    if let Operand::Object(object) = self.operand(&inner) {
                        self.b.read(object, inner.range());
                    }
                }
                // Not cached: the index is read each time.
                let ty = self.indirect_type(&text);
                return Operand::Object(self.indirect(&text, ty));
            }
            Some(_) => match known_word(&text) {
                Some(operand) => operand,
                // Not cached when it is none: each place is reported.
                None => match self.address(&text, range) {
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

    /// What an operand holds whose place is computed; of an element of an array, its declaration knows.
    fn indirect_type(&self, text: &str) -> Type {
        match self.language {
            Language::Awl(mnemonics) => object::step7::parse(text, mnemonics).map_or(Type::Unknown, |it| it.ty),
            _ => Type::Unknown,
        }
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
        let placed = |layout: &Layout, area| Some((area, layout.place(&name)?));
        let place =
            placed(&self.temporary, object::Area::Local).or_else(|| placed(&self.instance, object::Area::OpenInstance));
        let (ty, footprint, indexed) = match place {
            Some((area, it)) => {
                let ty = it.ty.map_or(Type::Unknown, Elementary::operand);
                (ty, Footprint::new(area, it.start, it.bits), false)
            }
            None => {
                let ty = self.declared.get(name.as_str()).copied().flatten();
                let ty = ty.map_or(Type::Unknown, Elementary::operand);
                (ty, Footprint::new(object::Area::LocalName(name.as_str().into()), 0, 1), indexed)
            }
        };
        let text = text.into();
        let (rights, extracted) = (Rights::Unknown, false);
        self.b.object(Object { text, class: Class::LocalName, ty, footprint, rights, extracted, indexed })
    }

    /// `Err`: what stands for a text that is no address.
    pub(super) fn address(&mut self, text: &str, range: TextRange) -> Result<ObjectId, ObjectId> {
        if !self.declared.is_empty() {
            let end = text.bytes().position(|it| matches!(it, b'.' | b'[')).unwrap_or(text.len());
            if self.declared.contains_key(text[..end].to_lowercase_smolstr().as_str()) {
                return Ok(self.local(text, false));
            }
        }
        let Language::Awl(mnemonics) = self.language else { return Ok(self.b.object(Object::symbol(text))) };
        match object::step7::parse(text, mnemonics) {
            Ok(object) => {
                self.b.model.of_tia_portal |= text.starts_with('%');
                Ok(self.b.object(object))
            }
            Err(error) => match object::step7::quoted(text, mnemonics).filter(|_| error.suggestion.is_none()) {
                Some(quoted) if text.contains('.') => match object::step7::parse(&quoted, mnemonics) {
                    Ok(object) => Ok(self.b.object(Object { text: text.into(), ..object })),
                    Err(error) => Err(self.no_address(text, error, range)),
                },
                Some(_) => Ok(self.b.object(Object::symbol(text))),
                None => Err(self.no_address(text, error, range)),
            },
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
        let class = self.b.model.objects[object.0 as usize].class;
        self.b.model.reads_indirectly |= class == Class::Indirect;
        let read = self.b.read(object, range);
        // The status, and the number of the open data block, are others after each instruction.
        match class {
            Class::Indirect | Class::Status => self.b.exprs().opaque(),
            _ => read,
        }
    }

    pub(super) fn note_write(&mut self, object: ObjectId) {
        if self.b.model.objects[object.0 as usize].class == Class::Indirect {
            self.b.model.writes_indirectly = true;
            self.b.wipe();
        }
    }
}

/// The type that the spelling of a constant tells, `None` within where it tells none; `None` for what is no constant.
pub(super) fn constant_type(text: &str) -> Option<Option<Elementary>> {
    Some(match literal::parse_step7(text).ok()? {
        Value::Bool(_) => Some(Elementary::Bool),
        Value::Int { ty: IntType::Plain, .. } => Some(Elementary::Int),
        Value::Int { ty: IntType::Long, .. } => Some(Elementary::DoubleInt),
        Value::Int { ty: IntType::Bits(8), .. } => Some(Elementary::Byte),
        Value::Int { ty: IntType::Bits(16), .. } => Some(Elementary::Word),
        Value::Int { ty: IntType::Bits(32), .. } => Some(Elementary::Double),
        Value::Real(_) => Some(Elementary::Real),
        Value::S5Time { .. } => Some(Elementary::S5Time),
        Value::Time { .. } => Some(Elementary::Time),
        Value::Int { .. } | Value::Count(_) | Value::Text(_) => None,
        Value::Other => return None,
    })
}

/// `"Data".speed`: more than a symbol.
fn is_field(text: &str) -> bool {
    ["\".", "»."].iter().any(|it| text.contains(it))
}

/// A word that is an operand without being an object.
fn known_word(text: &str) -> Option<Operand> {
    let words = [
        ("TRUE", Operand::Constant(Exprs::TRUE)),
        ("FALSE", Operand::Constant(Exprs::FALSE)),
        ("AR1", Operand::Other),
        ("AR2", Operand::Other),
    ];
    words.into_iter().find(|it| it.0.eq_ignore_ascii_case(text)).map(|it| it.1)
}

/// The operand without blanks: `M0.0`, `DB5.DBW0`.
pub(super) fn bare_text(operand: &ast::Operand) -> SmolStr {
    if operand.syntax().is_leaf() {
        return operand.syntax().text().into();
    }
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
