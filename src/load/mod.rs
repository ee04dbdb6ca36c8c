//! What is checked: finding and reading `plclint.toml`, and the files of programs. The command line and the language
//! server both read through here, so that they check the same.

mod config;
mod read;

pub use config::{Loader, Source, Wrong, WrongConfig, text};
pub use read::{Files, from_bytes, from_text, read, read_file, shown};
