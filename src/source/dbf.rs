//! Tables of dBase III, as PL7 stores symbols and cross-references: fields of fixed width, all read as text.
//!
//! Values are not converted, because the tables of PL7 do not keep to their own types: a field declared as a number holds
//! letters.

/// A table over the bytes of its file. Records beyond the end of the bytes are no records.
#[derive(Debug, Clone)]
pub struct Table<'b> {
    fields: Vec<Field>,
    records: std::slice::ChunksExact<'b, u8>,
}

#[derive(Debug, Clone)]
struct Field {
    name: String,
    column: Column,
}

/// Where a field lies in each record.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Column {
    start: usize,
    end: usize,
}

/// A record that is not marked as deleted.
#[derive(Debug, Clone, Copy)]
pub struct Row<'b>(&'b [u8]);

const HEADER: usize = 32;
const FIELD: usize = 32;
const NAME: usize = 11;
const END_OF_FIELDS: u8 = 0x0D;

impl<'b> Table<'b> {
    /// `None` when the bytes are no table, or one that is cut off.
    pub fn read(bytes: &'b [u8]) -> Option<Self> {
        let word = |at: usize| Some(usize::from(u16::from_le_bytes(bytes.get(at..at + 2)?.try_into().ok()?)));
        // The low bits are the version; the others say that there are memo files, which we do not need.
        if bytes.first()? & 0x07 != 3 {
            return None;
        }
        let count = u32::from_le_bytes(bytes.get(4..8)?.try_into().ok()?);
        let (header, record) = (word(8)?, word(10)?);
        let mut fields = Vec::new();
        // The first byte of a record is its deletion mark.
        let mut start = 1;
        for field in bytes.get(HEADER..header)?.chunks_exact(FIELD) {
            let name = field.get(..NAME)?;
            if name.first() == Some(&END_OF_FIELDS) {
                break;
            }
            let name = name.split(|&it| it == 0).next().unwrap_or_default();
            let end = start + usize::from(*field.get(16)?);
            let name = String::from_utf8_lossy(name).trim().to_ascii_uppercase();
            fields.push(Field { name, column: Column { start, end } });
            start = end;
        }
        if fields.is_empty() || start > record {
            return None;
        }
        let length = record.checked_mul(usize::try_from(count).ok()?)?;
        let records = bytes.get(header..)?.get(..length)?;
        Some(Self { fields, records: records.chunks_exact(record) })
    }

    /// The field of that name, in upper case.
    pub fn column(&self, name: &str) -> Option<Column> {
        self.fields.iter().find(|it| it.name == name).map(|it| it.column)
    }

    pub fn rows(&self) -> impl Iterator<Item = Row<'b>> + use<'b> {
        self.records.clone().filter(|it| it.first() != Some(&b'*')).map(Row)
    }
}

impl<'b> Row<'b> {
    /// The text of a field without the blanks around it.
    pub fn text(self, column: Column) -> &'b [u8] {
        let text = self.0.get(column.start..column.end).unwrap_or_default();
        let text = text.split(|&it| it == 0).next().unwrap_or_default();
        text.trim_ascii()
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::source::testing::table;

    #[test]
    fn records_and_their_fields() {
        let mut bytes = table(&[("OBJECT", 6), ("MODE", 1)], &[&["%M1", "R"], &["%MW12", "W"], &["x", "E"]]);
        let deleted = bytes.len() - 1 - 8;
        bytes[deleted] = b'*';
        let table = Table::read(&bytes).unwrap();
        let (object, mode) = (table.column("OBJECT").unwrap(), table.column("MODE").unwrap());
        let rows: Vec<_> = table.rows().map(|it| (it.text(object), it.text(mode))).collect();
        assert_eq!(rows, [(&b"%M1"[..], &b"R"[..]), (b"%MW12", b"W")]);
        assert_eq!(table.column("X"), None);
    }

    #[test]
    fn what_is_no_table() {
        let good = table(&[("A", 2)], &[&["ab"], &["cd"]]);
        assert!(Table::read(&good).is_some());
        for cut in 0..good.len() - 1 {
            assert!(Table::read(&good[..cut]).is_none(), "cut at {cut}");
        }
        let with = |at: usize, byte: u8| {
            let mut bytes = good.clone();
            bytes[at] = byte;
            bytes
        };
        for bytes in [with(0, 0x50), with(4, 3), with(8, 1), with(10, 0), with(10, 2), with(32 + 16, 255)] {
            assert!(Table::read(&bytes).is_none());
        }
    }

    proptest! {
        #[test]
        fn any_bytes(bytes in prop::collection::vec(any::<u8>(), 0..200), good in any::<bool>(), at in any::<prop::sample::Index>()) {
            let bytes = if good {
                let mut table = table(&[("A", 2), ("B", 30)], &[&["ab", "x"], &["cd", "y"]]);
                let at = at.index(table.len());
                let end = (at + bytes.len()).min(table.len());
                table[at..end].copy_from_slice(&bytes[..end - at]);
                table
            } else {
                bytes
            };
            if let Some(table) = Table::read(&bytes) {
                let column = table.fields[0].column;
                prop_assert!(table.rows().all(|it| it.text(column).len() <= bytes.len()));
            }
        }
    }
}
