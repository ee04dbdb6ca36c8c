//! What the memory of a processor holds, without a cartridge and with each (PL7:1528-1728).
//!
//! Where a cell of the tables prints two values for two groups of processors (`48K/64K`), the first is for the group that
//! the table names first: the sizes of programs beside them agree with that.

/// What a processor holds with one cartridge, or without one: a column of the tables.
#[derive(Debug, PartialEq, Eq)]
pub struct Memory {
    /// K words of the cartridge.
    pub cartridge: Option<u32>,
    /// K words of RAM, as the tables print them: for a Micro, those of the cartridge are among them.
    pub ram: u32,
    /// Words `%MW`. Without a cartridge this is a default, which takes from the program what it gains.
    pub words: u32,
    /// Words `%KW`, a default, which takes from the program what it gains. PL7:1667 prints K words; the other tables say
    /// that words are meant.
    pub constants: u32,
    /// Instructions in units of 102.4 (tenths of 1024) of a program that is Boolean to 100, 90 and 65 %; for each in
    /// ladder, instruction list and structured text.
    pub program: [[u32; 3]; 3],
}

const fn memory(cartridge: Option<u32>, ram: u32, words: u32, constants: u32, program: [[u32; 3]; 3]) -> Memory {
    Memory { cartridge, ram, words, constants, program }
}

/// TSX 37-05, 37-08: first column of PL7:1532-1550.
pub(super) const TSX_37_05: &[Memory] = &[memory(None, 9, 512, 128, [[16, 20, 13], [11, 14, 11], [9, 10, 10]])];

/// TSX 37-10: second column of PL7:1532-1550.
pub(super) const TSX_37_10: &[Memory] = &[memory(None, 14, 512, 128, [[38, 49, 33], [31, 38, 29], [22, 25, 25]])];

/// TSX 37-21: the other columns of PL7:1532-1550.
pub(super) const TSX_37_21: &[Memory] = &[
    memory(None, 20, 512, 128, [[66, 84, 56], [54, 66, 51], [40, 46, 46]]),
    memory(Some(32), 52, 17920, 256, [[137, 175, 117], [118, 143, 111], [91, 103, 103]]),
    memory(Some(64), 84, 17920, 512, [[285, 363, 242], [247, 300, 233], [189, 213, 213]]),
    memory(Some(128), 148, 17920, 512, [[582, 742, 495], [501, 610, 473], [384, 434, 434]]),
];

/// TSX 37-22: PL7:1557-1573.
pub(super) const TSX_37_22: &[Memory] = &[
    memory(None, 20, 512, 128, [[63, 81, 54], [52, 63, 49], [39, 44, 44]]),
    memory(Some(32), 52, 17920, 256, [[136, 173, 115], [116, 142, 110], [89, 101, 101]]),
    memory(Some(64), 84, 17920, 512, [[284, 361, 241], [245, 298, 232], [188, 212, 212]]),
    memory(Some(128), 148, 17920, 512, [[576, 735, 490], [500, 608, 472], [384, 434, 434]]),
];

/// TSX 57-103, 57-153: first three columns of PL7:1606-1622.
pub(super) const TSX_57_1: &[Memory] = &[
    memory(None, 32, 512, 128, [[88, 112, 76], [52, 62, 50], [36, 37, 42]]),
    memory(Some(32), 32, 26624, 256, [[123, 156, 105], [86, 103, 83], [67, 68, 79]]),
    memory(Some(64), 32, 26624, 512, [[269, 343, 229], [214, 256, 205], [167, 170, 197]]),
];

/// TSX 57-203, PCX 57-203, TSX 57-2623: PL7:1606-1622.
pub(super) const TSX_57_203: &[Memory] = &[
    memory(None, 48, 1024, 256, [[155, 197, 131], [110, 131, 105], [81, 83, 96]]),
    memory(Some(32), 48, 31232, 256, [[123, 156, 104], [86, 103, 83], [66, 68, 78]]),
    memory(Some(64), 48, 31232, 512, [[266, 339, 226], [211, 252, 202], [164, 168, 194]]),
    memory(Some(128), 48, 31232, 512, [[565, 716, 478], [469, 560, 449], [366, 375, 433]]),
];

/// TSX 57-253, 57-2823: PL7:1606-1622.
pub(super) const TSX_57_253: &[Memory] = &[
    memory(None, 64, 1024, 256, [[228, 291, 194], [174, 207, 166], [131, 134, 155]]),
    memory(Some(32), 64, 31232, 256, [[123, 156, 104], [86, 103, 83], [66, 68, 78]]),
    memory(Some(64), 64, 31232, 512, [[266, 339, 226], [211, 252, 202], [164, 168, 194]]),
    memory(Some(128), 64, 31232, 512, [[565, 716, 478], [469, 560, 449], [366, 375, 433]]),
];

/// TSX 57-303, 57-3623: PL7:1651-1667.
pub(super) const TSX_57_303: &[Memory] = &[
    memory(None, 64, 1024, 256, [[288, 367, 245], [226, 271, 217], [174, 178, 205]]),
    memory(Some(32), 80, 31232, 256, [[123, 156, 104], [86, 103, 83], [66, 68, 78]]),
    memory(Some(64), 80, 31232, 1024, [[266, 339, 226], [211, 252, 202], [164, 168, 194]]),
    memory(Some(128), 80, 31232, 1024, [[562, 716, 478], [469, 560, 449], [366, 375, 433]]),
    memory(Some(256), 80, 31232, 1024, [[1153, 1471, 980], [984, 1175, 942], [770, 788, 911]]),
    memory(Some(384), 80, 31232, 1024, [[1505, 1505, 1483], [1499, 1576, 1429], [1174, 1201, 1388]]),
];

/// TSX 57-353, PCX 57-353: PL7:1651-1667.
pub(super) const TSX_57_353: &[Memory] = &[
    memory(None, 80, 1024, 256, [[301, 384, 256], [238, 284, 227], [182, 186, 215]]),
    memory(Some(32), 96, 31232, 256, [[123, 156, 104], [86, 103, 83], [66, 68, 78]]),
    memory(Some(64), 96, 31232, 1024, [[266, 339, 226], [211, 252, 202], [164, 168, 194]]),
    memory(Some(128), 96, 31232, 1024, [[562, 716, 478], [469, 560, 449], [366, 375, 433]]),
    memory(Some(256), 96, 31232, 1024, [[1153, 1471, 980], [984, 1175, 942], [770, 788, 911]]),
    memory(Some(384), 96, 31232, 1024, [[1505, 1505, 1483], [1499, 1576, 1429], [1174, 1201, 1388]]),
];

/// TSX 57-453, 57-4823: PL7:1702-1718.
pub(super) const TSX_57_4: &[Memory] = &[
    memory(None, 96, 1024, 256, [[375, 478, 319], [302, 360, 289], [232, 237, 274]]),
    memory(Some(32), 176, 31232, 256, [[123, 156, 104], [86, 103, 83], [66, 68, 78]]),
    memory(Some(64), 176, 31232, 1024, [[266, 339, 226], [211, 252, 202], [164, 168, 194]]),
    memory(Some(128), 176, 31232, 1024, [[562, 716, 478], [469, 560, 449], [366, 375, 433]]),
    memory(Some(256), 176, 31232, 1024, [[1153, 1471, 980], [984, 1175, 942], [770, 788, 911]]),
    memory(Some(384), 176, 31232, 1024, [[1505, 1505, 1483], [1499, 1576, 1429], [1174, 1201, 1388]]),
    memory(Some(512), 176, 31232, 1024, [[1505, 1505, 1507], [1576, 1576, 1578], [1578, 1613, 1713]]),
    memory(Some(960), 176, 31232, 1024, [[1505, 1505, 1507], [1576, 1576, 1578], [1578, 1613, 1713]]),
];

#[cfg(test)]
mod tests {
    use super::*;

    /// Tables by name, with the number of cartridges.
    fn tables() -> [(&'static [Memory], usize); 10] {
        [
            (TSX_37_05, 0),
            (TSX_37_10, 0),
            (TSX_37_21, 3),
            (TSX_37_22, 3),
            (TSX_57_1, 2),
            (TSX_57_203, 3),
            (TSX_57_253, 3),
            (TSX_57_303, 5),
            (TSX_57_353, 5),
            (TSX_57_4, 7),
        ]
    }

    #[test]
    fn a_column_without_cartridge_and_one_for_each() {
        for (table, cartridges) in tables() {
            assert_eq!((table[0].cartridge, table.len()), (None, cartridges + 1));
            assert!(table.is_sorted_by_key(|it| it.cartridge));
            assert!(table.iter().all(|it| it.words <= it.ram * 1024));
            // The less of a program is Boolean, the fewer of its instructions fit; but for the largest cartridges, where
            // the number of elements is the limit (PL7:1721).
            for it in table.iter().filter(|it| it.cartridge.is_none_or(|it| it < 384)) {
                for language in 0..3 {
                    let [all, most, some] = it.program.map(|it| it[language]);
                    assert!(all >= most && most >= some, "{it:?}");
                }
            }
        }
    }

    /// Cells read from the tables by eye: first and last column, and the odd ones.
    #[test]
    fn cells_of_the_tables() {
        assert_eq!(TSX_37_05[0], memory(None, 9, 512, 128, [[16, 20, 13], [11, 14, 11], [9, 10, 10]]));
        assert_eq!(TSX_37_10[0].program, [[38, 49, 33], [31, 38, 29], [22, 25, 25]]);
        // 58,2 Ki, 74,2 Ki, 49,5 Ki: PL7:1537-1539.
        assert_eq!((TSX_37_21[3].ram, TSX_37_21[3].program[0]), (148, [582, 742, 495]));
        // 61 Ki is printed without decimals: PL7:1542.
        assert_eq!(TSX_37_21[3].program[1], [501, 610, 473]);
        assert_eq!(TSX_37_22[0], memory(None, 20, 512, 128, [[63, 81, 54], [52, 63, 49], [39, 44, 44]]));
        // 47,2Ki without a blank: PL7:1568.
        assert_eq!((TSX_37_22[3].program[1][2], TSX_37_22[3].constants), (472, 512));
        assert_eq!((TSX_57_1[2].cartridge, TSX_57_1[2].words, TSX_57_1[2].constants), (Some(64), 26_624, 512));
        assert_eq!((TSX_57_203[0].ram, TSX_57_203[0].program[0][0]), (48, 155));
        assert_eq!((TSX_57_253[0].ram, TSX_57_253[0].program[0][0]), (64, 228));
        assert_eq!((TSX_57_253[3].program[0], TSX_57_253[3].words), ([565, 716, 478], 31_232));
        assert_eq!((TSX_57_303[0].ram, TSX_57_353[0].ram, TSX_57_303[5].ram), (64, 80, 80));
        assert_eq!((TSX_57_353[0].program[0][0], TSX_57_353[5].program[2][2]), (301, 1388));
        assert_eq!((TSX_57_353[1].constants, TSX_57_353[2].constants), (256, 1024));
        // Two cartridges of 480 K words: PL7:1703.
        assert_eq!((TSX_57_4[7].cartridge, TSX_57_4[7].program[2]), (Some(960), [1578, 1613, 1713]));
        assert_eq!((TSX_57_4[0].ram, TSX_57_4[7].ram), (96, 176));
    }
}
