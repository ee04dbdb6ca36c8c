//! What the parameters of STEP 7 blocks take, by kind and size.

use crate::model::layout::Elementary;
use crate::model::object::{Class, Object, Type};

/// Whether a constant can be given to a parameter. Numbers and patterns are not told apart.
pub fn accepts(takes: Elementary, constant: Elementary) -> bool {
    use Elementary::{Bool, Byte, Char, Counter, Date, DoubleInt, Int, Real, S5Time, Time, TimeOfDay, Timer, Word};
    let number = matches!(constant, Int | DoubleInt | Byte | Word | Elementary::Double);
    match takes {
        Bool | Real => constant == takes,
        Timer | Counter | Elementary::Block => false,
        S5Time => constant == S5Time || number && constant.bits() <= 16,
        Time | TimeOfDay => constant == Time || number,
        Byte | Char | Word | Int | Date => number && constant.bits() <= takes.bits().max(16),
        _ => number || constant == Time,
    }
}

/// Whether an object can be given to a parameter: its kind and size.
pub fn fits(takes: Elementary, object: &Object) -> bool {
    match (takes, object.class) {
        // What is not resolved, and what the caller was given itself, may be anything of that size.
        (_, Class::Symbol | Class::Indirect) | (Elementary::DateAndTime, _) => true,
        (Elementary::Timer, class) => class == Class::Timer || is_own_block(object),
        (Elementary::Counter, class) => class == Class::Counter || is_own_block(object),
        (Elementary::Block, class) => class == Class::CodeBlock || is_own_block(object),
        _ if object.ty == Type::Unknown => true,
        _ => object.ty.bits() == Some(takes.bits()),
    }
}

fn is_own_block(object: &Object) -> bool {
    object.class == Class::LocalName && matches!(object.ty, Type::Block | Type::Unknown)
}

/// An object by kind and size, for a message.
pub fn described(object: &Object) -> String {
    match (object.class, object.ty.bits()) {
        (Class::Timer, _) => "a timer".to_owned(),
        (Class::Counter, _) => "a counter".to_owned(),
        (Class::CodeBlock, _) => "a block".to_owned(),
        (_, Some(1)) => "a bit".to_owned(),
        (_, Some(bits)) => format!("a place of {bits} bits"),
        (_, None) => "of another type".to_owned(),
    }
}
