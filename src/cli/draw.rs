//! `plclint draw`: charts, rungs and calls as pictures.

use std::fs;
use std::path::{Path, PathBuf};

use clap::ValueEnum;
use rustc_hash::{FxHashMap, FxHashSet};

use super::config::Configured;
use super::{Exit, Failure, complain, print, read};
use crate::db::{self, ProgramDrawing};
use crate::draw::{self, Drawing, Kind};
use crate::lint::settings::Overrides;
use crate::lint::{Unread, UnreadReason};
use crate::load::Loader;

#[derive(Debug, clap::Args)]
#[command(
    after_help = "Without --output, one drawing goes to standard output; several need a folder.\n\nExit codes: 0 drawn, 2 nothing to draw, wrong usage or configuration, 3 internal error. Findings do not change it."
)]
pub(super) struct Arguments {
    /// File or folder to draw, or `-` for standard input
    #[arg(value_name = "PATH")]
    path: PathBuf,
    #[command(flatten)]
    reading: read::Reading,

    /// How to write drawings
    #[arg(long, value_enum, default_value_t = Format::Svg, help_heading = "Output")]
    format: Format,
    /// What to draw; may be given more than once [default: all that there is]
    #[arg(long, value_enum, value_name = "WHAT", value_delimiter = ',', help_heading = "Output")]
    only: Vec<Only>,
    /// Draw what has this in its title: `MACRO1`, `MAST - SR3`
    #[arg(long, value_name = "NAME", help_heading = "Output")]
    unit: Option<String>,
    /// File to write one drawing to, or folder for one file each
    #[arg(long, short, value_name = "FILE|FOLDER", help_heading = "Output")]
    output: Option<PathBuf>,
    /// Colours of SVG
    #[arg(long, value_enum, default_value_t = Theme::Auto, help_heading = "Output")]
    theme: Theme,
    /// Do not mark findings
    #[arg(long, help_heading = "Output")]
    no_findings: bool,

    #[command(flatten)]
    configured: Configured,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Format {
    /// A picture
    Svg,
    /// For Graphviz; charts and calls
    Dot,
    /// A flowchart of Mermaid; charts and calls
    Mermaid,
}

impl Format {
    fn extension(self) -> &'static str {
        match self {
            Self::Svg => "svg",
            Self::Dot => "dot",
            Self::Mermaid => "mmd",
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Only {
    /// Grafcet charts, each with its pages, and sequences coded with bits
    Charts,
    /// Rungs, those in charts included; SVG
    Ladder,
    /// What calls what
    Calls,
}

impl Only {
    fn of(kind: Kind) -> Self {
        match kind {
            Kind::Chart => Self::Charts,
            Kind::Ladder => Self::Ladder,
            Kind::Calls => Self::Calls,
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Theme {
    /// As the viewer prefers it
    Auto,
    Light,
    Dark,
}

pub(super) fn run(arguments: &Arguments) -> Result<Exit, Failure> {
    let overrides = Overrides {
        controller: arguments.reading.target.clone(),
        encoding: arguments.reading.encoding.clone(),
        ..Overrides::default()
    };
    let mut loader = Loader::new(arguments.configured.source(), overrides)?;
    let path = std::slice::from_ref(&arguments.path);
    let mut drawings = Vec::new();
    let mut unread = Vec::new();
    let mut is_read = false;
    for group in read::groups(path, arguments.reading.stdin_filename.as_deref(), &mut loader)? {
        let files = group.read(arguments.reading.dialect);
        let opened = db::open(files.inputs, files.unread, group.settings);
        is_read |= !opened.files.is_empty();
        drawings.extend(opened.drawings(!arguments.no_findings));
        unread.extend(opened.unread);
    }
    let shown = arguments.path.display();
    for Unread { path, reason } in &unread {
        if let UnreadReason::Io(why) = reason {
            complain(&format!("{path}: not read: {why}"));
        }
    }
    if drawings.is_empty() {
        let why = unread.iter().find_map(|it| match &it.reason {
            UnreadReason::Unsupported(what) => Some(format!("{what} is not supported")),
            _ => None,
        });
        let why = why.unwrap_or_else(|| match is_read {
            true => "there is no chart, no sequence, no rung and no call in it".to_owned(),
            false => "no PLC program is recognised in it".to_owned(),
        });
        return Err(Failure::Usage(format!("{shown}: nothing to draw: {why}")));
    }
    let drawings = choose(drawings, arguments)?;
    write(&drawings, arguments)?;
    Ok(Exit::Clean)
}

/// Those that were asked for, in a form that they have.
fn choose(mut drawings: Vec<ProgramDrawing>, arguments: &Arguments) -> Result<Vec<ProgramDrawing>, Failure> {
    let shown = arguments.path.display();
    if !arguments.only.is_empty() {
        drawings.retain(|it| arguments.only.contains(&Only::of(it.drawing.kind())));
        if drawings.is_empty() {
            let wanted: Vec<&str> = arguments
                .only
                .iter()
                .map(|it| match it {
                    Only::Charts => "chart or sequence",
                    Only::Ladder => "rung",
                    Only::Calls => "call",
                })
                .collect();
            let wanted = wanted.join(" and no ");
            return Err(Failure::Usage(format!("{shown}: nothing to draw: there is no {wanted} in it")));
        }
    }
    if let Some(name) = &arguments.unit {
        let wanted = name.to_lowercase();
        let titles: Vec<String> = drawings.iter().map(|it| it.drawing.title().to_owned()).collect();
        drawings.retain(|it| it.drawing.title().to_lowercase().contains(&wanted));
        if drawings.is_empty() {
            let known = list(&titles);
            return Err(Failure::Usage(format!("{shown}: no drawing has `{name}` in its title; there are: {known}")));
        }
    }
    if arguments.format != Format::Svg {
        let before = drawings.len();
        drawings.retain(|it| it.drawing.kind() != Kind::Ladder);
        let form = arguments.format.to_possible_value().map(|it| it.get_name().to_owned()).unwrap_or_default();
        if drawings.is_empty() {
            return Err(Failure::Usage(format!(
                "{shown}: rungs are no graph: {form} cannot show them, use --format svg"
            )));
        }
        if drawings.len() < before {
            complain(&format!("{} drawings of rungs are left out: {form} cannot show them", before - drawings.len()));
        }
    }
    Ok(drawings)
}

/// The first of some names.
fn list(names: &[String]) -> String {
    const MOST: usize = 12;
    let mut text = names.iter().take(MOST).map(|it| format!("`{it}`")).collect::<Vec<_>>().join(", ");
    if names.len() > MOST {
        text.push_str(&format!(" and {} more", names.len() - MOST));
    }
    text
}

fn render(it: &Drawing, arguments: &Arguments) -> String {
    let theme = match arguments.theme {
        Theme::Auto => draw::Theme::Auto,
        Theme::Light => draw::Theme::Light,
        Theme::Dark => draw::Theme::Dark,
    };
    match arguments.format {
        Format::Svg => it.svg(theme),
        // Rungs were left out.
        Format::Dot => it.dot().unwrap_or_default(),
        Format::Mermaid => it.mermaid().unwrap_or_default(),
    }
}

fn write(drawings: &[ProgramDrawing], arguments: &Arguments) -> Result<(), Failure> {
    let extension = arguments.format.extension();
    let several = || {
        let titles: Vec<String> = drawings.iter().map(|it| it.drawing.title().to_owned()).collect();
        format!("there are {} drawings: {}", drawings.len(), list(&titles))
    };
    let Some(output) = &arguments.output else {
        let [it] = drawings else {
            let hint = "name a folder with --output, or choose one with --only and --unit";
            return Err(Failure::Usage(format!("{}; {hint}", several())));
        };
        let text = render(&it.drawing, arguments);
        return print(|out| out.write_all(text.as_bytes()));
    };
    // A name without extension is that of a folder, unless there is such a file.
    let is_folder = output.is_dir()
        || output.to_string_lossy().ends_with(['/', std::path::MAIN_SEPARATOR])
        || output.extension().is_none() && !output.exists();
    if !is_folder {
        let [it] = drawings else {
            let hint = format!("name a folder, for they do not go into {}", output.display());
            return Err(Failure::Usage(format!("{}; {hint}", several())));
        };
        return write_file(output, &render(&it.drawing, arguments));
    }
    let fail = |it: std::io::Error| Failure::Usage(format!("{}: the folder cannot be made: {it}", output.display()));
    fs::create_dir_all(output).map_err(fail)?;
    let names = file_names(drawings);
    for (it, name) in drawings.iter().zip(&names) {
        write_file(&output.join(format!("{name}.{extension}")), &render(&it.drawing, arguments))?;
    }
    print(|out| {
        for (it, name) in drawings.iter().zip(&names) {
            let path = output.join(format!("{name}.{extension}"));
            writeln!(out, "{}: {}", path.display(), it.drawing.title())?;
        }
        Ok(())
    })
}

fn write_file(path: &Path, text: &str) -> Result<(), Failure> {
    fs::write(path, text)
        .map_err(|it| Failure::Usage(format!("{}: the drawing cannot be written: {it}", path.display())))
}

/// Names that all file systems take, one for each drawing: what it is, the program where there are several, the title.
fn file_names(drawings: &[ProgramDrawing]) -> Vec<String> {
    let is_one = drawings.windows(2).all(|it| it[0].program == it[1].program);
    let mut taken = FxHashSet::default();
    let mut next: FxHashMap<String, u32> = FxHashMap::default();
    let mut names = Vec::with_capacity(drawings.len());
    for it in drawings {
        let kind = match it.drawing.kind() {
            Kind::Chart => "chart",
            Kind::Ladder => "ladder",
            Kind::Calls => "calls",
        };
        let program = if is_one { "" } else { &it.program };
        let title = if it.drawing.kind() == Kind::Calls { "" } else { it.drawing.title() };
        let base = safe(&format!("{kind} {program} {title}"));
        let mut name = base.clone();
        // File systems may take upper and lower case for the same.
        while !taken.insert(name.to_lowercase()) {
            let number = next.entry(base.to_lowercase()).or_insert(2_u32);
            name = format!("{base}-{number}");
            *number += 1;
        }
        names.push(name);
    }
    names
}

fn safe(text: &str) -> String {
    const LONGEST: usize = 80;
    let mut name = String::new();
    for it in text.chars() {
        if it.is_ascii_alphanumeric() || it == '_' {
            name.push(it);
        } else if !name.ends_with('-') {
            name.push('-');
        }
    }
    name.truncate(LONGEST);
    name.trim_matches('-').to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn file_names_are_safe() {
        assert_eq!(safe("chart  MAST - Lavage - CHART"), "chart-MAST-Lavage-CHART");
        assert_eq!(safe("ladder ../a\\b:<c>|\"é\n"), "ladder-a-b-c");
        assert!(safe(&"x".repeat(1000)).len() <= 80);
    }
}
