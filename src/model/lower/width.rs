//! What the accumulators of STEP 7 hold, as far as loads and operations tell: how wide it is, and whether a number is a
//! floating-point one (S7:385-449).

use smol_str::SmolStr;

use crate::model::expr::{Expr, ExprId, Exprs};
use crate::model::layout::Elementary;
use crate::model::object::{Class, Object, Type};
use crate::syntax::awl::instruction::{ArithOp, Conversion, NumberType};

#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Data {
    bits: u32,
    kind: Kind,
    /// As written; empty for what was computed.
    text: SmolStr,
    /// The result of a sum, difference or product of numbers of which one is at least a word.
    sum_of_words: bool,
    constant: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// Nothing says which number it is, or whether it is one.
    Pattern,
    Integer,
    Real,
}

impl Data {
    fn new(bits: u32, kind: Kind, text: SmolStr) -> Self {
        Self { bits, kind, text, sum_of_words: false, constant: false }
    }

    fn typed(ty: Elementary, text: SmolStr) -> Option<Self> {
        let kind = match ty {
            Elementary::Real => Kind::Real,
            Elementary::Int | Elementary::DoubleInt | Elementary::Time | Elementary::S5Time => Kind::Integer,
            Elementary::Byte | Elementary::Char | Elementary::Word | Elementary::Double => Kind::Pattern,
            _ => return None,
        };
        Some(Self::new(ty.bits(), kind, text))
    }

    /// What is loaded from an object. `declared`: its type, where the block declares it.
    pub(super) fn loaded(object: &Object, declared: Option<Elementary>) -> Option<Self> {
        let text = object.text.clone();
        match (declared, object.class, object.ty) {
            (Some(ty), ..) => Self::typed(ty, text),
            // What a symbol or a pointer names may be of any type.
            (None, Class::Symbol | Class::LocalName | Class::Indirect | Class::Status, _) => None,
            (None, Class::Timer | Class::Counter, _) => Some(Self::new(16, Kind::Integer, text)),
            (None, _, Type::Byte) => Some(Self::new(8, Kind::Pattern, text)),
            (None, _, Type::Word) => Some(Self::new(16, Kind::Pattern, text)),
            (None, _, Type::Double) => Some(Self::new(32, Kind::Pattern, text)),
            _ => None,
        }
    }

    /// A constant. 0 is 0 in every type.
    pub(super) fn constant(exprs: &Exprs, value: ExprId, ty: Option<Elementary>, text: SmolStr) -> Option<Self> {
        match *exprs.get(value) {
            Expr::Int(0) => None,
            // Without a prefix, what does not fit 16 bits has 32.
            Expr::Int(value) if ty == Some(Elementary::Int) && i16::try_from(value).is_err() => {
                Some(Self::new(32, Kind::Integer, text))
            }
            _ => Self::typed(ty?, text),
        }
        .map(|it| Self { constant: true, ..it })
    }

    /// The result of an operation on two numbers.
    pub(super) fn computed(op: ArithOp, ty: NumberType, operands: [&Option<Self>; 2]) -> Self {
        let (bits, kind) = match ty {
            NumberType::Int => (16, Kind::Integer),
            NumberType::Dint => (32, Kind::Integer),
            NumberType::Real => (32, Kind::Real),
        };
        let is_wide = |it: &Self| it.sum_of_words || it.bits >= 16 && !it.text.is_empty() && !it.constant;
        let sum_of_words = op != ArithOp::Div && operands.into_iter().flatten().any(is_wide);
        Self { sum_of_words, ..Self::new(bits, kind, SmolStr::default()) }
    }

    /// The result of a conversion.
    pub(super) fn converted(by: Conversion, operand: Option<&Self>) -> Option<Self> {
        let (bits, kind) = match by {
            Conversion::BcdToInt | Conversion::NegateInt => (16, Kind::Integer),
            // Four digits, of which `BTI` takes three: no more than 9999.
            Conversion::BcdToDint if operand.is_some_and(|it| it.bits <= 16) => (16, Kind::Integer),
            Conversion::BcdToDint | Conversion::IntToDint | Conversion::NegateDint => (32, Kind::Integer),
            Conversion::Round | Conversion::RoundUp | Conversion::RoundDown | Conversion::Truncate => {
                (32, Kind::Integer)
            }
            Conversion::DintToReal | Conversion::NegateReal => (32, Kind::Real),
            _ => return None,
        };
        Some(Self::new(bits, kind, SmolStr::default()))
    }

    /// What two ways that meet agree on.
    pub(super) fn meet(&self, other: &Self) -> Option<Self> {
        (self == other).then(|| self.clone())
    }

    fn shown(&self) -> String {
        if self.text.is_empty() { "the result before it".to_owned() } else { format!("`{}`", self.text) }
    }

    fn described(&self) -> &'static str {
        match (self.kind, self.bits) {
            (Kind::Real, _) => "is a floating-point number",
            (_, 32) => "has 32 bits",
            (Kind::Integer, _) => "is a whole number",
            (Kind::Pattern, 8) => "is a byte",
            (Kind::Pattern, _) => "is a word",
        }
    }

    /// Why an operation of a type does not take it, as the end of a sentence.
    pub(super) fn misfit(&self, ty: NumberType) -> Option<String> {
        let (wrong, takes) = match ty {
            NumberType::Int => (self.bits == 32, "works on 16 bits"),
            NumberType::Dint => (self.kind == Kind::Real, "works on whole numbers"),
            NumberType::Real => (self.kind == Kind::Integer || self.bits < 32, "works on floating-point numbers"),
        };
        wrong.then(|| format!("{takes}, and {} {}", self.shown(), self.described()))
    }

    /// Why it should not be stored in a place of a size and type, as the end of a sentence.
    pub(super) fn misplaced(&self, place: &Object, declared: Option<Elementary>) -> Option<String> {
        let bits = place.ty.bits().filter(|_| place.class != Class::Symbol)?;
        let takes = match declared {
            _ if self.kind == Kind::Real && bits < 32 => format!("takes {bits} bits"),
            Some(Elementary::DoubleInt | Elementary::Time) if self.kind == Kind::Real => {
                "takes a whole number".to_owned()
            }
            Some(Elementary::Real) if self.kind == Kind::Integer => "takes a floating-point number".to_owned(),
            _ if bits == 8 && self.sum_of_words => {
                return Some(
                    "takes the low byte of a word: the sum, difference or product of words before it needs 16 bits"
                        .to_owned(),
                );
            }
            _ => return None,
        };
        Some(format!("{takes}, and {} {}", self.shown(), self.described()))
    }
}
