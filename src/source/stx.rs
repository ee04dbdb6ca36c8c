//! A PL7 project (`.STX`) as text.
//!
//! A project is an archive of binary code and of tables (known, measured on real projects). The code cannot be read; the
//! tables hold the symbols and a cross-reference, which says where each object is used and how. [`listing`] writes both as
//! one text, which then goes the way of all texts:
//!
//! ```text
//! [STATION]
//! PROCESSOR = 'TSX 57103   V5.1'
//! [DATA_UNIT]
//! VAR_GLOBAL
//! Pump AT %Q2.0 (*north tank*);
//! END_VAR
//! [XREF] MAST - module 0
//! @20
//! %I1.0 R
//! %Q2.0 W
//! ```
//!
//! A module is named by its number alone, because its name stands in the binary code. `@20` is the number of a place in
//! it: a rung, or the whole text of a module. The letters are R (read), W (written, in whatever way), E (executed), O
//! (written by a function), V (read and written by a function).
//!
//! **Invariant:** what is read of an archive is bounded, whatever the archive says of itself.

use std::fmt::Write as _;
use std::io::{Cursor, Read};

use rustc_hash::{FxHashMap, FxHashSet};
use zip::ZipArchive;

use super::dbf::{Row, Table};
use super::decode::{Encoding, SourceText, decode};

/// Why a project is not read, as the end of "not read: ".
pub const NO_PROJECT: &str = "archive without the tables of a PL7 project";
pub const DAMAGED: &str = "damaged archive";
pub const TOO_LARGE: &str = "archive that unpacks to more than 64 MiB";

/// Files of an archive that are looked at, and bytes that are unpacked.
const MOST_FILES: usize = 4096;
const MOST_BYTES: u64 = 64 << 20;

/// Whether bytes begin like an archive.
pub fn is_archive(bytes: &[u8]) -> bool {
    bytes.starts_with(b"PK\x03\x04") || bytes.starts_with(b"PK\x05\x06")
}

/// The text of a project.
///
/// # Errors
/// The archive is damaged, too large, or none of a project.
pub fn listing(bytes: &[u8], encoding: Option<Encoding>) -> Result<SourceText, &'static str> {
    let mut files = Files::open(bytes)?;
    let station = files.read("STATION.INI")?;
    let symbols = files.read("PL7.DBF")?;
    let references = files.read("XREF.DBF")?;
    if station.is_none() && symbols.is_none() && references.is_none() {
        return Err(NO_PROJECT);
    }
    let encoding = encoding.unwrap_or(Encoding::Windows1252);
    let mut out = Listing { text: String::new(), encoding };
    out.station(&station.unwrap_or_default());
    out.text.push_str("[DATA_UNIT]\nVAR_GLOBAL\n");
    let comments = files.read("PL7CMT.DBF")?;
    let comments = table(comments.as_deref(), "the table PL7CMT.DBF is damaged")?;
    if let Some(table) = table(symbols.as_deref(), "the table PL7.DBF is damaged")? {
        out.symbols(&table, comments.as_ref());
    }
    let instances = files.read("INSTANCE.DBF")?;
    if let Some(table) = table(instances.as_deref(), "the table INSTANCE.DBF is damaged")? {
        out.instances(&table);
    }
    out.text.push_str("END_VAR\n");
    let chart = files.read("XRG7.DBF")?;
    let chart = table(chart.as_deref(), "the table XRG7.DBF is damaged")?;
    if let Some(table) = table(references.as_deref(), "the table XREF.DBF is damaged")? {
        out.references(&table, chart.as_ref());
    }
    Ok(SourceText { text: out.text.into(), encoding, bom: false, malformed: false, mixed: false })
}

/// The controller that the text of a project names: `TSX 57103`.
pub fn controller(listing: &str) -> Option<&str> {
    let head = listing.strip_prefix("[STATION]\n")?;
    let line = head.lines().take_while(|it| !it.starts_with('[')).find_map(|it| it.strip_prefix("PROCESSOR = '"))?;
    let name = line.strip_suffix('\'')?;
    // The version stands behind the name.
    let end = name.match_indices(" V").map(|it| it.0).last().unwrap_or(name.len());
    name.get(..end).map(str::trim).filter(|it| !it.is_empty())
}

fn table<'b>(bytes: Option<&'b [u8]>, damaged: &'static str) -> Result<Option<Table<'b>>, &'static str> {
    bytes.filter(|it| !it.is_empty()).map(|it| Table::read(it).ok_or(damaged)).transpose()
}

/// Files of an archive by their name without folders, in upper case.
struct Files<'b> {
    archive: ZipArchive<Cursor<&'b [u8]>>,
    names: FxHashMap<String, usize>,
    /// Bytes that may yet be unpacked.
    left: u64,
}

impl<'b> Files<'b> {
    fn open(bytes: &'b [u8]) -> Result<Self, &'static str> {
        let archive = ZipArchive::new(Cursor::new(bytes)).map_err(|_| DAMAGED)?;
        let mut names = FxHashMap::default();
        for at in 0..archive.len().min(MOST_FILES) {
            let Some(Ok(name)) = archive.name_for_index(at) else { continue };
            let name = name.rsplit(['/', '\\']).next().unwrap_or_default().to_ascii_uppercase();
            names.entry(name).or_insert(at);
        }
        Ok(Self { archive, names, left: MOST_BYTES })
    }

    fn read(&mut self, name: &str) -> Result<Option<Vec<u8>>, &'static str> {
        let Some(&at) = self.names.get(name) else { return Ok(None) };
        let file = self.archive.by_index(at).map_err(|_| DAMAGED)?;
        let mut bytes = Vec::new();
        file.take(self.left + 1).read_to_end(&mut bytes).map_err(|_| DAMAGED)?;
        self.left = self.left.checked_sub(bytes.len() as u64).ok_or(TOO_LARGE)?;
        Ok(Some(bytes))
    }
}

struct Listing {
    text: String,
    encoding: Encoding,
}

impl Listing {
    /// Bytes as text on one line.
    fn decode(&self, bytes: &[u8]) -> String {
        on_one_line(&decode(bytes, Some(self.encoding)).text)
    }

    fn line(&mut self, line: std::fmt::Arguments<'_>) {
        // Writing to a string does not fail.
        let _ = self.text.write_fmt(line);
        self.text.push('\n');
    }

    fn station(&mut self, ini: &[u8]) {
        self.text.push_str("[STATION]\n");
        for (key, name) in [("REFPROCESS", "PROCESSOR"), ("NOMAPPLI", "NAME")] {
            let value = ini.split(|&it| it == b'\n').find_map(|line| {
                let at = memchr::memchr(b'=', line)?;
                let (name, value) = line.split_at_checked(at)?;
                name.trim_ascii().eq_ignore_ascii_case(key.as_bytes()).then(|| value.trim_ascii_end().get(1..))?
            });
            if let Some(value) = value.map(<[u8]>::trim_ascii).filter(|it| !it.is_empty()) {
                let value = self.decode(value).replace('\'', " ");
                self.line(format_args!("{name} = '{value}'"));
            }
        }
    }

    /// The comment of a declaration, in the form in which it stands in a text.
    fn comment(&self, parts: &[&[u8]]) -> String {
        let text: String = parts.iter().map(|it| self.decode(it)).collect();
        let text = text.trim();
        if text.is_empty() {
            return String::new();
        }
        let text = text.replace("(*", "( *").replace("*)", "* )");
        format!(" (*{text}*)")
    }

    fn symbols(&mut self, symbols: &Table<'_>, comments: Option<&Table<'_>>) {
        const KEY: [&str; 5] = ["OBJET", "IND1", "IND2", "IND3", "IND4"];
        let key = |table: &Table<'_>, row: Row<'_>| -> Vec<Vec<u8>> {
            KEY.iter().filter_map(|it| Some(row.text(table.column(it)?).to_vec())).collect()
        };
        let mut texts: FxHashMap<Vec<Vec<u8>>, String> = FxHashMap::default();
        if let Some(comments) = comments {
            let columns: Vec<_> = ["CMT1", "CMT2"].iter().filter_map(|it| comments.column(it)).collect();
            for row in comments.rows() {
                let parts: Vec<&[u8]> = columns.iter().map(|it| row.text(*it)).collect();
                texts.insert(key(comments, row), self.comment(&parts));
            }
        }
        let (Some(address), Some(symbol)) = (symbols.column("REPERE"), symbols.column("SYMBOLE")) else { return };
        for row in symbols.rows() {
            let (address, symbol) = (self.decode(row.text(address)), self.decode(row.text(symbol)));
            if !address.is_empty() && !symbol.is_empty() {
                let comment = texts.get(&key(symbols, row)).map_or("", String::as_str);
                self.line(format_args!("{symbol} AT {address}{comment};"));
            }
        }
    }

    fn instances(&mut self, instances: &Table<'_>) {
        let (Some(name), Some(ty)) = (instances.column("NOMOBJET"), instances.column("NOMTYPE")) else { return };
        let comment = instances.column("COMMENT");
        for row in instances.rows() {
            let (name, ty) = (self.decode(row.text(name)), self.decode(row.text(ty)));
            if !name.is_empty() {
                let comment = self.comment(&[comment.map(|it| row.text(it)).unwrap_or_default()]);
                self.line(format_args!("{name} : {ty}{comment};"));
            }
        }
    }

    fn references(&mut self, table: &Table<'_>, chart: Option<&Table<'_>>) {
        let columns = ["TACHE", "MODULE", "POSTECAT", "OBJECT", "MODE"].map(|it| table.column(it));
        let [Some(task), Some(module), Some(place), Some(object), Some(mode)] = columns else { return };
        let chart = chart.map(Chart::new).unwrap_or_default();
        // Units in the order in which they are first met; of each, its entries in the order of the table.
        let mut index: FxHashMap<Place<'_>, usize> = FxHashMap::default();
        let mut units: Vec<(String, Vec<Row<'_>>)> = Vec::new();
        for row in table.rows() {
            let of = [task, module, place].map(|it| row.text(it));
            let in_chart = chart.is_chart(of[1]);
            let key = if in_chart { of } else { [of[0], of[1], b""] };
            let at = *index.entry(key).or_insert_with(|| {
                let task = self.task(of[0]);
                let part = if in_chart { chart.part(of) } else { self.module(of[1]) };
                units.push((format!("{task} - {part}"), Vec::new()));
                units.len() - 1
            });
            units[at].1.push(row);
        }
        for (heading, rows) in units {
            self.line(format_args!("[XREF] {heading}"));
            let mut last = None;
            for row in rows {
                let at = row.text(place);
                if last != Some(at) {
                    let at = self.decode(at);
                    self.line(format_args!("@{at}"));
                }
                last = Some(at);
                let (object, mode) = (self.decode(row.text(object)), self.decode(row.text(mode)));
                if !object.is_empty() {
                    let mode = if mode.is_empty() { "?" } else { &mode };
                    self.line(format_args!("{object} {mode}"));
                }
            }
        }
    }

    /// The task of a number. Charts, which only MAST can have (PL7:4901), are in task 772.
    fn task(&self, number: &[u8]) -> String {
        match number_of(number) {
            Some(772) => "MAST".to_owned(),
            Some(number) => format!("task {number}"),
            None => self.decode(number),
        }
    }

    /// The module of a number: from 0xE000 on, they count.
    fn module(&self, number: &[u8]) -> String {
        match number_of(number) {
            Some(number @ 0xE000..) => format!("module {}", number - 0xE000),
            Some(number) => format!("module #{number}"),
            None => self.decode(number),
        }
    }
}

fn on_one_line(text: &str) -> String {
    text.chars().map(|it| if it.is_control() { ' ' } else { it }).collect()
}

/// A number of 16 bits, which the tables write with its sign.
fn number_of(text: &[u8]) -> Option<u16> {
    let number: i32 = std::str::from_utf8(text).ok()?.parse().ok()?;
    u16::try_from(number).or_else(|_| i16::try_from(number).map(i16::cast_unsigned)).ok()
}

/// Task, module and place in it, as the tables number them.
type Place<'b> = [&'b [u8]; 3];

/// What the places of a chart are.
#[derive(Default)]
struct Chart<'b> {
    modules: FxHashSet<&'b [u8]>,
    places: FxHashMap<Place<'b>, String>,
}

/// The module of the chart itself.
const CHART: u16 = 0xC300;

impl<'b> Chart<'b> {
    fn new(table: &Table<'b>) -> Self {
        let mut chart = Self::default();
        let names = ["TACHE", "MODULE", "POSTECAT", "NUMPAGE", "NUMSSMOD", "TYPSSMOD"];
        let [Some(task), Some(module), Some(place), Some(page), Some(number), Some(kind)] =
            names.map(|it| table.column(it))
        else {
            return chart;
        };
        for row in table.rows() {
            let [page, number] = [page, number].map(|it| on_one_line(&String::from_utf8_lossy(row.text(it))));
            let part = match row.text(kind) {
                b"0" => format!("CHART - PAGE {page} - transition {number}"),
                // Which of its actions the place is, no value that was seen tells.
                _ => format!("CHART - PAGE {page} %X{number}"),
            };
            let of = [task, module, place].map(|it| row.text(it));
            chart.modules.insert(of[1]);
            chart.places.insert(of, part);
        }
        chart
    }

    fn is_chart(&self, module: &[u8]) -> bool {
        number_of(module) == Some(CHART) || self.modules.contains(module)
    }

    fn part(&self, of: Place<'_>) -> String {
        let known = self.places.get(&of).cloned();
        known.unwrap_or_else(|| format!("CHART - place {}", on_one_line(&String::from_utf8_lossy(of[2]))))
    }
}
