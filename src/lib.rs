//! plclint reads PLC programs as they lie on disk and reports what the manual forbids or warns against.
//!
//! A tour, in the order in which a program travels: [`source`] turns bytes into text and text into units; [`syntax`]
//! turns a unit into a lossless tree; [`model`] says what the tree means, in one dialect-neutral form; [`analysis`]
//! draws facts from models; the rules, found under `rules/`, draw findings from facts through [`lint`]; [`report`]
//! renders findings; [`cli`] is the command line, [`server`] the language server; both read through [`load`]. `db` ties
//! the layers together with salsa.

pub mod analysis;
pub mod cli;
pub mod db;
pub mod draw;
pub mod lint;
pub mod load;
pub mod model;
pub mod report;
pub mod server;

pub mod source;
pub mod syntax;
pub mod target;
