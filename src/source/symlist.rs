//! The symbol table of a STEP 7 project (`YDBs/<number>/SYMLIST.DBF`) as text, in the form that the symbol editor exports:
//! `"Motor","Q 4.0","BOOL","conveyor"`.
//!
//! The table has the address in both mnemonic sets (known, measured on a real project): `_OPIEC` in the English one,
//! `_OPHIST` in the German one.

use std::path::Path;

use super::dbf::Table;
use super::decode::{Encoding, SourceText, decode};

/// Why a table is not read, as the end of "not read: ".
pub const DAMAGED: &str = "damaged table";

/// Whether a file is such a table, by its name.
pub fn is_table(path: &Path) -> bool {
    path.file_name().is_some_and(|it| it.eq_ignore_ascii_case("SYMLIST.DBF"))
}

/// The text of a table.
///
/// # Errors
/// The bytes are no table, or one without symbols and addresses.
pub fn listing(bytes: &[u8], encoding: Option<Encoding>) -> Result<SourceText, &'static str> {
    let encoding = encoding.filter(|it| it.is_single_byte()).unwrap_or(Encoding::Windows1252);
    let table = Table::read(bytes).ok_or(DAMAGED)?;
    let name = table.column("_SKZ").ok_or(DAMAGED)?;
    let addresses: Vec<_> = ["_OPIEC", "_OPHIST"].iter().filter_map(|it| table.column(it)).collect();
    let others = ["_DATATYP", "_COMMENT"].map(|it| table.column(it));
    if addresses.is_empty() {
        return Err(DAMAGED);
    }
    let mut text = String::new();
    for row in table.rows() {
        let field = |bytes: &[u8]| -> String {
            let text = decode(bytes, Some(encoding)).text;
            text.chars().map(|it| if it.is_control() { ' ' } else { it }).filter(|it| *it != '"').collect()
        };
        let blanks = |text: String| text.split_whitespace().collect::<Vec<_>>().join(" ");
        let address = addresses.iter().map(|it| row.text(*it)).find(|it| !it.is_empty()).unwrap_or_default();
        let [ty, comment] = others.map(|it| it.map_or_else(String::new, |it| field(row.text(it))));
        text.push_str(&format!(
            "\"{}\",\"{}\",\"{}\",\"{comment}\"\n",
            field(row.text(name)),
            blanks(field(address)),
            blanks(ty)
        ));
    }
    Ok(SourceText { text: text.into(), encoding, bom: false, malformed: false, mixed: false })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::testing::table;

    const FIELDS: [(&str, u8); 5] = [("_SKZ", 24), ("_OPIEC", 12), ("_OPHIST", 12), ("_DATATYP", 10), ("_COMMENT", 80)];

    #[test]
    fn rows_become_lines() {
        let bytes = table(
            &FIELDS,
            &[
                &["MAIN_CONTACTOR", "Q       4.0", "A       4.0", "BOOL", "Main \"K1\""],
                &["Old", "", "A       4.1", "BOOL", ""],
                &["Motor", "FB      1", "FB      1", "FB      1", ""],
            ],
        );
        let text = listing(&bytes, None).unwrap().text;
        let expected = "\"MAIN_CONTACTOR\",\"Q 4.0\",\"BOOL\",\"Main K1\"\n\"Old\",\"A 4.1\",\"BOOL\",\"\"\n\
                        \"Motor\",\"FB 1\",\"FB 1\",\"\"\n";
        assert_eq!(&*text, expected);
        assert_eq!(listing(&bytes[..bytes.len() / 2], None).err(), Some(DAMAGED));
        assert_eq!(listing(&table(&[("_SKZ", 24)], &[]), None).err(), Some(DAMAGED));
        assert!(is_table(Path::new("p/YDBs/3/symlist.dbf")) && !is_table(Path::new("p/YDBs/SYMLISTS.DBF")));
    }
}
