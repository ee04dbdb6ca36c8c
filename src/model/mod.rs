//! What a program *is*, whatever language it was written in.
//!
//! **Invariant:** this module knows no rule.

pub mod entity;
pub mod literal;
pub mod object;
