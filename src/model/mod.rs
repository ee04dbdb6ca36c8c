//! What a program *is*, whatever language it was written in.
//!
//! **Invariant:** this module knows no rule.

pub mod chart;
pub mod dfb;
pub mod entity;
pub mod expr;
pub mod granules;
pub mod ladder;
pub mod layout;
pub mod literal;
pub mod lower;
pub mod object;
pub mod pl7_kinds;
pub mod pl7_precedence;
pub mod pl7_tables;
pub mod sets;
pub mod step_times;
pub mod symbols;
pub mod unit;
pub mod work;

pub use unit::UnitModel;
