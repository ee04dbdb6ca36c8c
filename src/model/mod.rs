//! What a program *is*, whatever language it was written in.

pub mod entity;
