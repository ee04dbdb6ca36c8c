//! How the command line says where settings come from.

use std::path::PathBuf;

use crate::load::Source;

/// What says where settings come from.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Configuration")]
pub(super) struct Configured {
    /// Configuration file, instead of the nearest `plclint.toml` upwards from each path
    #[arg(long, value_name = "FILE", conflicts_with = "isolated")]
    config: Option<PathBuf>,
    /// Read no configuration file
    #[arg(long)]
    isolated: bool,
}

impl Configured {
    pub(super) fn source(&self) -> Source {
        match (&self.config, self.isolated) {
            (Some(file), _) => Source::File(file.clone()),
            (None, true) => Source::Isolated,
            (None, false) => Source::Discover,
        }
    }
}
