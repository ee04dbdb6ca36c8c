//! Trees to models: one file a language.

mod builder;

pub(crate) use crate::model::unit::Pin;
