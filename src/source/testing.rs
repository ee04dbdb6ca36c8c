//! What tests of PL7 projects build, those of this module and those of whole projects.

/// A dBase III table: names and widths of its fields, then its records.
pub(super) fn table(fields: &[(&str, u8)], rows: &[&[&str]]) -> Vec<u8> {
    let record = 1 + fields.iter().map(|it| u16::from(it.1)).sum::<u16>();
    let header = u16::try_from(32 + 32 * fields.len() + 1).expect("few fields");
    let mut out = vec![3, 116, 1, 1];
    out.extend(u32::try_from(rows.len()).expect("few rows").to_le_bytes());
    out.extend(header.to_le_bytes());
    out.extend(record.to_le_bytes());
    out.resize(32, 0);
    for (name, width) in fields {
        let mut field = [0; 32];
        field[..name.len()].copy_from_slice(name.as_bytes());
        field[11] = b'C';
        field[16] = *width;
        out.extend(field);
    }
    out.push(0x0D);
    for row in rows {
        out.push(b' ');
        for (value, (_, width)) in row.iter().zip(fields) {
            // The tables are in Windows-1252.
            let mut cell: Vec<u8> = value.chars().map(|it| u8::try_from(u32::from(it)).expect("Latin-1")).collect();
            cell.resize(usize::from(*width), b' ');
            out.extend(cell);
        }
    }
    out.push(0x1A);
    out
}
