//! Function blocks of PL7: the cells they take in a rung, and their pins.
//!
//! The first volume of the manual names the blocks and the bits of their outputs (PL7:976-997) and shows their pins in
//! drawings only. Names and order of the pins are those of the vendor's second volume; for the series 7 timer they are
//! those of the same block in PL7-2 (PL72:658-660).

use crate::target::Limit;

/// What a kind of block is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Block {
    /// Letters of its address: `TM` of `%TM0`.
    pub letters: &'static str,
    /// Columns of a rung.
    pub columns: Limit,
    /// Inputs and outputs from top to bottom, one a row. Outputs carry the names of their bits.
    pub inputs: &'static [&'static str],
    pub outputs: &'static [&'static str],
}

/// Columns of a block that is not a timer.
pub const COLUMNS: Limit = Limit::new(3, "PL7:2751");
/// The manual gives three columns to every block; files give two to timers.
const TIMER_COLUMNS: Limit = Limit::new(2, "exchange files of the tool; PL72:662 for PL7-2");

pub static BLOCKS: &[Block] = &[
    Block { letters: "TM", columns: TIMER_COLUMNS, inputs: &["IN"], outputs: &["Q"] },
    Block { letters: "T", columns: TIMER_COLUMNS, inputs: &["E", "C"], outputs: &["D", "R"] },
    Block { letters: "C", columns: COLUMNS, inputs: &["R", "S", "CU", "CD"], outputs: &["E", "D", "F"] },
    Block { letters: "MN", columns: COLUMNS, inputs: &["S"], outputs: &["R"] },
    Block { letters: "R", columns: COLUMNS, inputs: &["R", "I", "O"], outputs: &["E", "F"] },
    Block { letters: "DR", columns: COLUMNS, inputs: &["R", "U"], outputs: &["F"] },
];

/// The kind of block that an address names: `%TM0`, `%C8`.
pub fn of_address(address: &str) -> Option<&'static Block> {
    let letters = address.trim_start_matches('%').trim_end_matches(|it: char| it.is_ascii_digit());
    BLOCKS.iter().find(|it| it.letters.eq_ignore_ascii_case(letters))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_are_found_by_their_address() {
        let letters = |address| of_address(address).map(|it| it.letters);
        assert_eq!(letters("%TM0"), Some("TM"));
        assert_eq!(letters("%t12"), Some("T"));
        assert_eq!(letters("%MN3"), Some("MN"));
        for address in ["%MW0", "", "%", "Tempo", "%TM0.Q"] {
            assert_eq!(letters(address), None, "{address}");
        }
    }
}
