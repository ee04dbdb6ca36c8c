//! Constants and their values.

/// The value of a constant, with what its spelling says of its type.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    Bool(bool),
    /// A whole number: plain, or with a base or width prefix.
    Int { value: i64, ty: IntType },
    Real(f64),
    /// `S5T#1M_35S_6MS`, in milliseconds, as written.
    S5Time { milliseconds: u64 },
    /// `T#...`, in milliseconds.
    Time { milliseconds: i64 },
    /// `C#3`.
    Count(u32),
    /// `'abc'`.
    Text(String),
    /// A date, time of day, pointer or other constant whose value no rule needs.
    Other,
}

/// What the spelling of a whole number says.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum IntType {
    /// Decimal without a prefix.
    Plain,
    /// `L#-5`.
    Long,
    /// `B#16#..`, `W#16#..`, `DW#16#..`, `2#...`, `16#...`: a pattern of that many bits (0 when the spelling does not say).
    Bits(u8),
}

/// Why a constant is not one.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LiteralError {
    /// One sentence without a final stop, with the allowed range and its source where there is one.
    pub message: String,
    /// Whether the constant is a time of STEP 7 (rule C001), or any other (rule V001).
    pub is_s5time: bool,
}
