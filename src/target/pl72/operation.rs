//! Operation blocks: comparisons, calculations, conversions, transfers (PL72:943-1109).

use super::{Feature, Series};
use crate::target::{Limit, Range};

/// What may stand at a place of an operation block.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Operand {
    /// Any object word (PL72:977).
    Word,
    /// Decimal, `L'..'`, `H'..'` or `M'..'` (PL72:979-984).
    Value,
    /// `W5(W10)`.
    Indexed,
    /// A bit string of 16 bits.
    Bits16,
    /// A bit string of fewer than 16 bits.
    BitsShort,
    /// A bit string of 1 to 16 bits.
    Bits,
    /// `W0[60]`.
    Words,
}

/// Columns that a comparison block takes, and an operation block, whose last one is the column of coils.
pub const COMPARE_COLUMNS: Limit = Limit::new(2, "PL72:954");
pub const OPERATE_COLUMNS: Limit = Limit::new(3, "PL72:973");

/// Longest bit string (PL72:989).
pub const BIT_STRING: Range = Range::new(1, 16, "PL72:989");

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum OperationKind {
    Arithmetic,
    Logic,
    Conversion,
    Rotation,
}

/// Values that an operand may have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct OperandRange {
    pub first: i32,
    pub last: i32,
    pub source: &'static str,
}

/// A calculation, conversion or rotation.
#[derive(Debug, PartialEq, Eq)]
pub struct Operation {
    pub code: &'static str,
    pub kind: OperationKind,
    /// `OP1 OP OP2 -> result`; else `OP OP2 -> result`.
    pub binary: bool,
    /// Controllers that have it.
    pub series: &'static [Series],
    pub feature: Option<Feature>,
    /// By series: TSX 17-20, TSX 27, TSX 47.
    pub ranges: [Option<OperandRange>; 3],
    /// The result is one of `Wi` and `COMi,j`; else also `Ti,P` and its like, and `OWxy,i` (PL72:1020, PL72:1045-1047).
    pub result_is_plain_word: bool,
    pub source: &'static str,
}

impl Operation {
    pub fn range(&self, series: Series) -> Option<OperandRange> {
        self.ranges[series.index()]
    }

    /// The operation of a code, in either case.
    pub fn of_code(code: &str) -> Option<&'static Self> {
        OPERATIONS.iter().find(|it| it.code.eq_ignore_ascii_case(code))
    }
}

/// The values of 16 bits with a sign.
pub const ARITHMETIC: OperandRange = OperandRange { first: -32_768, last: 32_767, source: "PL72:1023" };
const MULTIPLY_17: OperandRange = OperandRange { source: "PL72:1024", ..ARITHMETIC };
const REMAINDER_17: OperandRange = OperandRange { source: "PL72:1025", ..ARITHMETIC };
const MULTIPLY_27_47: OperandRange = OperandRange { first: 0, last: 255, source: "PL72:1024" };
const TO_BCD: OperandRange = OperandRange { first: 0, last: 9999, source: "PL72:1056" };

/// Largest value that a conversion to BCD takes.
pub const BCD_MAX: Limit = Limit::new(9999, "PL72:1056");
/// A conversion between binary and ASCII has so many digits, in so many words.
pub const ASCII_DIGITS: Limit = Limit::new(5, "PL72:1057");
pub const ASCII_WORDS: Limit = Limit::new(3, "PL72:1057");
/// Bits of a rotation.
pub const SHIFT: Range = Range::new(0, 15, "PL72:1053");

const BASE: Operation = Operation {
    code: "",
    kind: OperationKind::Arithmetic,
    binary: true,
    series: &Series::ALL,
    feature: None,
    ranges: [None; 3],
    result_is_plain_word: false,
    source: "",
};

const fn binary(code: &'static str, source: &'static str, ranges: [Option<OperandRange>; 3]) -> Operation {
    Operation { code, ranges, source, ..BASE }
}

const fn logic(code: &'static str) -> Operation {
    Operation { code, kind: OperationKind::Logic, source: "PL72:1026", ..BASE }
}

const fn conversion(code: &'static str, source: &'static str, range: Option<OperandRange>) -> Operation {
    Operation { code, kind: OperationKind::Conversion, binary: false, ranges: [range; 3], source, ..BASE }
}

const fn ascii(code: &'static str) -> Operation {
    Operation {
        feature: Some(Feature::AsciiConversion),
        result_is_plain_word: true,
        ..conversion(code, "PL72:1052", None)
    }
}

const fn rotation(code: &'static str) -> Operation {
    Operation { code, kind: OperationKind::Rotation, binary: false, source: "PL72:1053", ..BASE }
}

const MULTIPLY: [Option<OperandRange>; 3] = [Some(MULTIPLY_17), Some(MULTIPLY_27_47), Some(MULTIPLY_27_47)];

/// PL72:1022-1027, PL72:1049-1053.
pub static OPERATIONS: &[Operation] = &[
    binary("+", "PL72:1023", [Some(ARITHMETIC); 3]),
    binary("-", "PL72:1023", [Some(ARITHMETIC); 3]),
    binary("*", "PL72:1024", MULTIPLY),
    binary("/", "PL72:1024", MULTIPLY),
    Operation { series: &[Series::Tsx17], ..binary("REM", "PL72:1025", [Some(REMAINDER_17), None, None]) },
    logic("AND"),
    logic("OR"),
    logic("XOR"),
    Operation { binary: false, source: "PL72:1027", ..logic("CPL") },
    conversion("BIN", "PL72:1050", None),
    conversion("BCD", "PL72:1051", Some(TO_BCD)),
    ascii("BTA"),
    ascii("ATB"),
    rotation("SLC"),
    rotation("SRC"),
];

/// A transfer that the table names. Nothing else may be transferred.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Transfer {
    pub from: Operand,
    pub to: Operand,
    pub feature: Option<Feature>,
    pub source: &'static str,
}

const fn transfer(from: Operand, to: Operand, source: &'static str) -> Transfer {
    Transfer { from, to, feature: None, source }
}

/// PL72:1072-1084. Strings of fewer than 16 bits have the length of the string they go to.
pub static TRANSFERS: &[Transfer] = &[
    transfer(Operand::Bits16, Operand::Word, "PL72:1073"),
    transfer(Operand::Bits16, Operand::Indexed, "PL72:1074"),
    transfer(Operand::BitsShort, Operand::BitsShort, "PL72:1075"),
    transfer(Operand::Word, Operand::Bits, "PL72:1076"),
    transfer(Operand::Word, Operand::Word, "PL72:1077"),
    transfer(Operand::Word, Operand::Indexed, "PL72:1078"),
    transfer(Operand::Indexed, Operand::Word, "PL72:1079"),
    transfer(Operand::Indexed, Operand::Indexed, "PL72:1080"),
    Transfer { feature: Some(Feature::WordTables), ..transfer(Operand::Words, Operand::Words, "PL72:1081") },
    transfer(Operand::Value, Operand::Bits, "PL72:1082"),
    transfer(Operand::Value, Operand::Word, "PL72:1083"),
    transfer(Operand::Value, Operand::Indexed, "PL72:1084"),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::target::pl72::{CONTROLLERS, Model, Version};

    fn model(name: &str, version: Option<Version>) -> Model {
        let controller = CONTROLLERS.iter().find(|it| it.name == name);
        assert!(controller.is_some(), "{name}");
        Model { controller, version }
    }

    fn operation(code: &str) -> &'static Operation {
        Operation::of_code(code).unwrap_or_else(|| panic!("{code}"))
    }

    #[test]
    fn operations_of_controllers() {
        let (old, new) = (model("TSX 27", Some(Version::new(2, 0))), model("TSX 27", Some(Version::new(3, 0))));
        let micro = model("TSX 17-20", None);
        assert!(!old.has_operation(operation("BTA")) && new.has_operation(operation("bta")));
        assert!(!new.has_operation(operation("REM")) && micro.has_operation(operation("REM")));
        assert!(Model::default().has_operation(operation("REM")));
        assert!(OPERATIONS.iter().all(|it| micro.has_operation(it)));
        assert_eq!(Operation::of_code("SQRT"), None);
    }

    #[test]
    fn ranges_of_operands() {
        let range =
            |name, code| model(name, None).operand_range(operation(code)).map(|it| (it.first, it.last, it.source));
        assert_eq!(range("TSX 27", "*"), Some((0, 255, "PL72:1024")));
        assert_eq!(range("TSX 17-20", "*"), Some((-32_768, 32_767, "PL72:1024")));
        assert_eq!(range("TSX 47-10", "+"), Some((-32_768, 32_767, "PL72:1023")));
        assert_eq!(range("TSX 17-20", "REM"), Some((-32_768, 32_767, "PL72:1025")));
        assert_eq!(range("TSX 47-10", "BCD"), Some((0, 9999, "PL72:1056")));
        assert_eq!(range("TSX 47-10", "XOR"), None);
        assert_eq!(Model::default().operand_range(operation("/")).map(|it| it.last), Some(32_767));
    }

    #[test]
    fn codes_and_transfers_differ() {
        for (index, it) in OPERATIONS.iter().enumerate() {
            assert!(OPERATIONS[..index].iter().all(|other| other.code != it.code), "{}", it.code);
        }
        for (index, it) in TRANSFERS.iter().enumerate() {
            assert!(TRANSFERS[..index].iter().all(|other| (other.from, other.to) != (it.from, it.to)));
        }
    }
}
