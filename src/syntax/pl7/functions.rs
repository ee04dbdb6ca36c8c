//! The functions and operators of PL7 (PL7:3556-3820).
//!
//! The first volume of the manual names the functions and says what they do; where it leaves the arguments open and
//! general PL7 usage does not settle them, the entry is open too, and no rule can complain about a number of arguments.

use crate::syntax::packed::{Index, index};

/// How a function stands in a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Form {
    /// `SQRT(%MF14)`, `SORT_ARW(1,%MW0:10)`.
    Call,
    /// `%MW0 REM 6`.
    Infix,
    /// `RE %I1.0`.
    Prefix,
    /// `INC %MW4;`.
    Statement,
    /// `HALT`: changes where the program goes on, and has no operand that is an object.
    Flow,
}

/// What kind of value an argument or a result is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Kind {
    Bit,
    /// 16 bits.
    Word,
    /// 32 bits.
    Double,
    Float,
    /// A word or a double word.
    Integer,
    /// A word, a double word or a float.
    Number,
    BitTable,
    WordTable,
    DoubleTable,
    /// A table of words or of double words.
    IntegerTable,
    FloatTable,
    /// A string of characters: `%MB10:5` or `'abc'`.
    Text,
    /// A function block: `%C8`.
    Block,
    BitOrBlock,
    /// A channel of a module: `%CH3.0`.
    Channel,
    /// As the operands have it.
    Any,
}

/// What a function does with an argument.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Access {
    Read,
    Write,
    ReadWrite,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Parameter {
    pub kind: Kind,
    pub access: Access,
}

impl Parameter {
    pub fn is_written(&self) -> bool {
        self.access != Access::Read
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Function {
    pub name: &'static str,
    /// Other spellings that the manual prints.
    pub also: &'static [&'static str],
    pub form: Form,
    /// The arguments or operands that are known, in order.
    pub parameters: &'static [Parameter],
    /// Whether more arguments than the known ones may follow.
    pub is_open: bool,
    /// Kind of the value; `None` if the function is a statement of its own.
    pub result: Option<Kind>,
    /// Line of the PL7 manual that gives the function; 0 if only another volume does.
    pub line: u16,
}

impl Function {
    const fn call(name: &'static str, parameters: &'static [Parameter], result: Option<Kind>, line: u16) -> Self {
        Self::operator(name, Form::Call, parameters, result, line)
    }

    const fn operator(
        name: &'static str,
        form: Form,
        parameters: &'static [Parameter],
        result: Option<Kind>,
        line: u16,
    ) -> Self {
        Self { name, also: &[], form, parameters, is_open: false, result, line }
    }

    const fn also(mut self, also: &'static [&'static str]) -> Self {
        self.also = also;
        self
    }

    const fn open(mut self) -> Self {
        self.is_open = true;
        self
    }
}

const fn read(kind: Kind) -> Parameter {
    Parameter { kind, access: Access::Read }
}

const fn write(kind: Kind) -> Parameter {
    Parameter { kind, access: Access::Write }
}

const fn change(kind: Kind) -> Parameter {
    Parameter { kind, access: Access::ReadWrite }
}

const FUNCTIONS: &[Function] = &[
    // Bits (PL7:3558-3592).
    Function::operator("OR", Form::Infix, &[read(Kind::Any), read(Kind::Any)], Some(Kind::Any), 3564),
    Function::operator("AND", Form::Infix, &[read(Kind::Any), read(Kind::Any)], Some(Kind::Any), 3565),
    Function::operator("XOR", Form::Infix, &[read(Kind::Any), read(Kind::Any)], Some(Kind::Any), 3566),
    Function::operator("NOT", Form::Prefix, &[read(Kind::Any)], Some(Kind::Any), 3567),
    Function::operator("RE", Form::Prefix, &[read(Kind::Bit)], Some(Kind::Bit), 3568),
    Function::operator("FE", Form::Prefix, &[read(Kind::Bit)], Some(Kind::Bit), 3569),
    Function::operator("SET", Form::Statement, &[write(Kind::Bit)], None, 3570),
    Function::operator("RESET", Form::Statement, &[write(Kind::BitOrBlock)], None, 3571),
    Function::call("COPY_BIT", &[read(Kind::BitTable)], Some(Kind::BitTable), 3583),
    Function::call("AND_ARX", &[read(Kind::BitTable), read(Kind::BitTable)], Some(Kind::BitTable), 3584),
    Function::call("OR_ARX", &[read(Kind::BitTable), read(Kind::BitTable)], Some(Kind::BitTable), 3585),
    Function::call("XOR_ARX", &[read(Kind::BitTable), read(Kind::BitTable)], Some(Kind::BitTable), 3586),
    Function::call("NOT_ARX", &[read(Kind::BitTable)], Some(Kind::BitTable), 3587),
    Function::call(
        "BIT_W",
        &[read(Kind::BitTable), read(Kind::Word), read(Kind::Word), read(Kind::Word), write(Kind::WordTable)],
        None,
        3588,
    ),
    Function::call(
        "BIT_D",
        &[read(Kind::BitTable), read(Kind::Word), read(Kind::Word), read(Kind::Word), write(Kind::DoubleTable)],
        None,
        3589,
    ),
    Function::call(
        "W_BIT",
        &[read(Kind::WordTable), read(Kind::Word), read(Kind::Word), read(Kind::Word), write(Kind::BitTable)],
        None,
        3590,
    ),
    Function::call(
        "D_BIT",
        &[read(Kind::DoubleTable), read(Kind::Word), read(Kind::Word), read(Kind::Word), write(Kind::BitTable)],
        None,
        3591,
    ),
    Function::call("LENGHT_ARX", &[read(Kind::BitTable)], Some(Kind::Word), 3592).also(&["LENGTH_ARX"]),
    // Arithmetic and logic (PL7:3596-3645).
    Function::operator("REM", Form::Infix, &[read(Kind::Integer), read(Kind::Integer)], Some(Kind::Integer), 3602),
    Function::call("SQRT", &[read(Kind::Number)], Some(Kind::Number), 3603),
    Function::call("ABS", &[read(Kind::Number)], Some(Kind::Number), 3604),
    Function::operator("INC", Form::Statement, &[change(Kind::Integer)], None, 3605),
    Function::operator("DEC", Form::Statement, &[change(Kind::Integer)], None, 3606),
    Function::call("TRUNC", &[read(Kind::Float)], Some(Kind::Float), 3616),
    Function::call("LOG", &[read(Kind::Float)], Some(Kind::Float), 3617),
    Function::call("LN", &[read(Kind::Float)], Some(Kind::Float), 3618),
    Function::call("EXP", &[read(Kind::Float)], Some(Kind::Float), 3619),
    Function::call("EXPT", &[read(Kind::Float), read(Kind::Float)], Some(Kind::Float), 3620),
    Function::call("COS", &[read(Kind::Float)], Some(Kind::Float), 3621),
    Function::call("SIN", &[read(Kind::Float)], Some(Kind::Float), 3622),
    Function::call("TAN", &[read(Kind::Float)], Some(Kind::Float), 3623),
    Function::call("ACOS", &[read(Kind::Float)], Some(Kind::Float), 3624),
    Function::call("ASIN", &[read(Kind::Float)], Some(Kind::Float), 3625),
    Function::call("ATAN", &[read(Kind::Float)], Some(Kind::Float), 3626),
    Function::call("DEG_TO_RAD", &[read(Kind::Float)], Some(Kind::Float), 3627),
    Function::call("RAD_TO_DEG", &[read(Kind::Float)], Some(Kind::Float), 3628),
    Function::call("SHL", &[read(Kind::Integer), read(Kind::Word)], Some(Kind::Integer), 3639),
    Function::call("SHR", &[read(Kind::Integer), read(Kind::Word)], Some(Kind::Integer), 3640),
    Function::call("ROL", &[read(Kind::Integer), read(Kind::Word)], Some(Kind::Integer), 3641),
    Function::call("ROR", &[read(Kind::Integer), read(Kind::Word)], Some(Kind::Integer), 3642),
    // Tables of words and double words (PL7:3664-3688).
    Function::call("SUM", &[read(Kind::IntegerTable)], Some(Kind::Integer), 3673),
    Function::call("EQUAL", &[read(Kind::IntegerTable), read(Kind::IntegerTable)], Some(Kind::Word), 3674),
    Function::call("FIND_EQW", &[read(Kind::WordTable), read(Kind::Word)], Some(Kind::Word), 3678),
    Function::call("FIND_EQD", &[read(Kind::DoubleTable), read(Kind::Double)], Some(Kind::Word), 3678),
    Function::call("FIND_GTW", &[read(Kind::WordTable), read(Kind::Word)], Some(Kind::Word), 3679),
    Function::call("FIND_GTD", &[read(Kind::DoubleTable), read(Kind::Double)], Some(Kind::Word), 3679),
    Function::call("FIND_LTW", &[read(Kind::WordTable), read(Kind::Word)], Some(Kind::Word), 3680),
    Function::call("FIND_LTD", &[read(Kind::DoubleTable), read(Kind::Double)], Some(Kind::Word), 3680),
    Function::call("MAX_ARW", &[read(Kind::WordTable)], Some(Kind::Word), 3681),
    Function::call("MAX_ARD", &[read(Kind::DoubleTable)], Some(Kind::Double), 3681),
    Function::call("MIN_ARW", &[read(Kind::WordTable)], Some(Kind::Word), 3682),
    Function::call("MIN_ARD", &[read(Kind::DoubleTable)], Some(Kind::Double), 3682),
    Function::call("OCCUR_ARW", &[read(Kind::WordTable), read(Kind::Word)], Some(Kind::Word), 3683),
    Function::call("OCCUR_ARD", &[read(Kind::DoubleTable), read(Kind::Double)], Some(Kind::Word), 3683),
    Function::call("SORT_ARW", &[read(Kind::Word), change(Kind::WordTable)], None, 3684),
    Function::call("SORT_ARD", &[read(Kind::Word), change(Kind::DoubleTable)], None, 3684),
    Function::call("ROL_ARW", &[read(Kind::Word), change(Kind::WordTable)], None, 3685),
    Function::call("ROL_ARD", &[read(Kind::Word), change(Kind::DoubleTable)], None, 3685),
    Function::call("ROR_ARW", &[read(Kind::Word), change(Kind::WordTable)], None, 3686),
    Function::call("ROR_ARD", &[read(Kind::Word), change(Kind::DoubleTable)], None, 3686),
    Function::call("FIND_EQWP", &[read(Kind::WordTable), read(Kind::Word), read(Kind::Word)], Some(Kind::Word), 3687),
    Function::call(
        "FIND_EQDP",
        &[read(Kind::DoubleTable), read(Kind::Double), read(Kind::Word)],
        Some(Kind::Word),
        3687,
    ),
    Function::call("LENGTH_ARW", &[read(Kind::WordTable)], Some(Kind::Word), 3688),
    Function::call("LENGTH_ARD", &[read(Kind::DoubleTable)], Some(Kind::Word), 3688),
    // Tables of floats (PL7:3690-3708).
    Function::call("SUM_ARR", &[read(Kind::FloatTable)], Some(Kind::Float), 3697),
    Function::call("EQUAL_ARR", &[read(Kind::FloatTable), read(Kind::FloatTable)], Some(Kind::Word), 3698),
    Function::call("FIND_EQR", &[read(Kind::FloatTable), read(Kind::Float)], Some(Kind::Word), 3699),
    Function::call("FIND_GTR", &[read(Kind::FloatTable), read(Kind::Float)], Some(Kind::Word), 3700),
    Function::call("FIND_LTR", &[read(Kind::FloatTable), read(Kind::Float)], Some(Kind::Word), 3701),
    Function::call("MAX_ARR", &[read(Kind::FloatTable)], Some(Kind::Float), 3702),
    Function::call("MIN_ARR", &[read(Kind::FloatTable)], Some(Kind::Float), 3703),
    Function::call("OCCUR_ARR", &[read(Kind::FloatTable), read(Kind::Float)], Some(Kind::Word), 3704),
    Function::call("SORT_ARR", &[read(Kind::Word), change(Kind::FloatTable)], None, 3705),
    Function::call("ROL_ARR", &[read(Kind::Word), change(Kind::FloatTable)], None, 3706),
    Function::call("ROR_ARR", &[read(Kind::Word), change(Kind::FloatTable)], None, 3707),
    Function::call("LENGTH_ARR", &[read(Kind::FloatTable)], Some(Kind::Word), 3708),
    // Strings (PL7:3712-3733).
    Function::call("STRING_TO_INT", &[read(Kind::Text)], Some(Kind::Word), 3717),
    Function::call("STRING_TO_DINT", &[read(Kind::Text)], Some(Kind::Double), 3718),
    Function::call("INT_TO_STRING", &[read(Kind::Word)], Some(Kind::Text), 3719),
    Function::call("DINT_TO_STRING", &[read(Kind::Double)], Some(Kind::Text), 3720),
    Function::call("STRING_TO_REAL", &[read(Kind::Text)], Some(Kind::Float), 3721),
    Function::call("REAL_TO_STRING", &[read(Kind::Float)], Some(Kind::Text), 3722),
    Function::call("FIND", &[read(Kind::Text), read(Kind::Text)], Some(Kind::Word), 3724),
    Function::call("EQUAL_STR", &[read(Kind::Text), read(Kind::Text)], Some(Kind::Word), 3725),
    Function::call("LEN", &[read(Kind::Text)], Some(Kind::Word), 3726),
    Function::call("MID", &[read(Kind::Text), read(Kind::Word), read(Kind::Word)], Some(Kind::Text), 3727),
    Function::call("INSERT", &[read(Kind::Text), read(Kind::Text), read(Kind::Word)], Some(Kind::Text), 3728),
    Function::call("DELETE", &[read(Kind::Text), read(Kind::Word), read(Kind::Word)], Some(Kind::Text), 3729),
    Function::call("CONCAT", &[read(Kind::Text), read(Kind::Text)], Some(Kind::Text), 3730),
    Function::call(
        "REPLACE",
        &[read(Kind::Text), read(Kind::Text), read(Kind::Word), read(Kind::Word)],
        Some(Kind::Text),
        3731,
    ),
    Function::call("LEFT", &[read(Kind::Text), read(Kind::Word)], Some(Kind::Text), 3732),
    Function::call("RIGHT", &[read(Kind::Text), read(Kind::Word)], Some(Kind::Text), 3733),
    // Conversions (PL7:3739-3757).
    Function::call("BCD_TO_INT", &[read(Kind::Word)], Some(Kind::Word), 3744),
    Function::call("INT_TO_BCD", &[read(Kind::Word)], Some(Kind::Word), 3745),
    Function::call("GRAY_TO_INT", &[read(Kind::Word)], Some(Kind::Word), 3746),
    Function::call("INT_TO_REAL", &[read(Kind::Word)], Some(Kind::Float), 3747),
    Function::call("DINT_TO_REAL", &[read(Kind::Double)], Some(Kind::Float), 3748),
    Function::call("REAL_TO_INT", &[read(Kind::Float)], Some(Kind::Word), 3749),
    Function::call("REAL_TO_DINT", &[read(Kind::Float)], Some(Kind::Double), 3750),
    Function::call("DBCD_TO_DINT", &[read(Kind::Double)], Some(Kind::Double), 3751),
    Function::call("DINT_TO_DBCD", &[read(Kind::Double)], Some(Kind::Double), 3752),
    Function::call("DBCD_TO_INT", &[read(Kind::Double)], Some(Kind::Word), 3753),
    Function::call("INT_TO_DBCD", &[read(Kind::Word)], Some(Kind::Double), 3754),
    Function::call("LW", &[read(Kind::Double)], Some(Kind::Word), 3755),
    Function::call("HW", &[read(Kind::Double)], Some(Kind::Word), 3756),
    Function::call("CONCATW", &[read(Kind::Word), read(Kind::Word)], Some(Kind::Double), 3757).also(&["COCATW"]),
    // Program (PL7:3763-3773).
    Function::operator("HALT", Form::Flow, &[], None, 3768),
    Function::operator("JUMP", Form::Flow, &[], None, 3769),
    Function::operator("RETURN", Form::Flow, &[], None, 3771),
    Function::call("MASKEVT", &[], None, 3772),
    Function::call("UNMASKEVT", &[], None, 3773),
    // Time (PL7:3775-3796).
    Function::call(
        "SCHEDULE",
        &[
            read(Kind::Word),
            read(Kind::Word),
            read(Kind::Word),
            read(Kind::Double),
            read(Kind::Double),
            write(Kind::Bit),
        ],
        None,
        3780,
    ),
    Function::call("RRTC", &[write(Kind::WordTable)], None, 3781),
    Function::call("WRTC", &[read(Kind::WordTable)], None, 3782),
    Function::call("PTC", &[write(Kind::WordTable)], None, 3783),
    Function::call("ADD_TOD", &[read(Kind::Double), read(Kind::Double)], Some(Kind::Double), 3784),
    Function::call("ADD_DT", &[read(Kind::WordTable), read(Kind::Double)], Some(Kind::WordTable), 3785),
    Function::call("DELTA_TOD", &[read(Kind::Double), read(Kind::Double)], Some(Kind::Double), 3786),
    Function::call("DELTA_D", &[read(Kind::Double), read(Kind::Double)], Some(Kind::Double), 3787),
    Function::call("DELTA_DT", &[read(Kind::WordTable), read(Kind::WordTable)], Some(Kind::Double), 3788),
    Function::call("SUB_TOD", &[read(Kind::Double), read(Kind::Double)], Some(Kind::Double), 3789),
    Function::call("SUB_DT", &[read(Kind::WordTable), read(Kind::Double)], Some(Kind::WordTable), 3790),
    Function::call("DAY_OF_WEEK", &[], Some(Kind::Word), 3791),
    Function::call("TRANS_TIME", &[read(Kind::Double)], Some(Kind::Double), 3792),
    Function::call("DATE_TO_STRING", &[read(Kind::Double)], Some(Kind::Text), 3793),
    Function::call("TOD_TO_STRING", &[read(Kind::Double)], Some(Kind::Text), 3794),
    Function::call("DT_TO_STRING", &[read(Kind::WordTable)], Some(Kind::Text), 3795),
    Function::call("TIME_TO_STRING", &[read(Kind::Double)], Some(Kind::Text), 3796),
    // Orphée (PL7:3798-3809): the manual gives no argument.
    Function::call("WSHL_RBIT", &[], Some(Kind::Any), 3804).open(),
    Function::call("DSHL_RBIT", &[], Some(Kind::Any), 3804).open(),
    Function::call("WSHR_RBIT", &[], Some(Kind::Any), 3805).open(),
    Function::call("DSHR_RBIT", &[], Some(Kind::Any), 3805).open(),
    Function::call("WSHRZ_C", &[], Some(Kind::Any), 3806).open(),
    Function::call("DSHRZ_C", &[], Some(Kind::Any), 3806).open(),
    Function::call("SCOUNT", &[], Some(Kind::Any), 3807).open(),
    Function::call("ROLW", &[], Some(Kind::Word), 3808).open(),
    Function::call("ROLD", &[], Some(Kind::Double), 3808).open(),
    Function::call("RORW", &[], Some(Kind::Word), 3809).open(),
    Function::call("RORD", &[], Some(Kind::Double), 3809).open(),
    // Timing inside DFBs (PL7:3811-3820).
    Function::call(
        "FTON",
        &[read(Kind::Bit), read(Kind::Word), write(Kind::Bit), write(Kind::Word), change(Kind::Double)],
        None,
        3817,
    ),
    Function::call(
        "FTOF",
        &[read(Kind::Bit), read(Kind::Word), write(Kind::Bit), write(Kind::Word), change(Kind::Double)],
        None,
        3818,
    ),
    Function::call(
        "FTP",
        &[read(Kind::Bit), read(Kind::Word), write(Kind::Bit), write(Kind::Word), change(Kind::Double)],
        None,
        3819,
    ),
    Function::call(
        "FPULSOR",
        &[
            read(Kind::Bit),
            read(Kind::Word),
            read(Kind::Word),
            write(Kind::Bit),
            write(Kind::Word),
            change(Kind::Double),
        ],
        None,
        3820,
    ),
    // Explicit exchanges with modules, named where DFBs may not use them (PL7:5489).
    Function::operator("READ_STS", Form::Statement, &[read(Kind::Channel)], None, 5489),
    Function::operator("SMOVE", Form::Statement, &[read(Kind::Channel)], None, 5489).open(),
    // What the other volumes of the manual give: known by name, so that no rule calls them unknown.
    Function::operator("READ_PARAM", Form::Statement, &[read(Kind::Channel)], None, 0),
    Function::operator("WRITE_PARAM", Form::Statement, &[read(Kind::Channel)], None, 0),
    Function::operator("SAVE_PARAM", Form::Statement, &[read(Kind::Channel)], None, 0),
    Function::operator("RESTORE_PARAM", Form::Statement, &[read(Kind::Channel)], None, 0),
    Function::operator("WRITE_CMD", Form::Statement, &[read(Kind::Channel)], None, 0),
    Function::operator("XMOVE", Form::Statement, &[read(Kind::Channel)], None, 0).open(),
    Function::operator("START", Form::Statement, &[read(Kind::Block)], None, 0),
    Function::operator("STOP", Form::Statement, &[read(Kind::Block)], None, 0),
    Function::operator("UP", Form::Statement, &[read(Kind::Block)], None, 0),
    Function::operator("DOWN", Form::Statement, &[read(Kind::Block)], None, 0),
    Function::operator("PUT", Form::Statement, &[read(Kind::Block)], None, 0),
    Function::operator("GET", Form::Statement, &[read(Kind::Block)], None, 0),
    Function::operator("PRESET", Form::Statement, &[read(Kind::Block)], None, 0),
    Function::call("READ_VAR", &[], None, 0).open(),
    Function::call("WRITE_VAR", &[], None, 0).open(),
    Function::call("SEND_REQ", &[], None, 0).open(),
    Function::call("PRINT_CHAR", &[], None, 0).open(),
    Function::call("INPUT_CHAR", &[], None, 0).open(),
    Function::call("OUT_IN_CHAR", &[], None, 0).open(),
    Function::call("DATA_EXCH", &[], None, 0).open(),
    Function::call("SEND_TLG", &[], None, 0).open(),
    Function::call("RCV_TLG", &[], None, 0).open(),
    Function::call("CANCEL", &[], None, 0).open(),
    Function::call("READ_GDATA", &[], None, 0).open(),
    Function::call("WRITE_GDATA", &[], None, 0).open(),
    Function::call("PID", &[], None, 0).open(),
    Function::call("PWM", &[], None, 0).open(),
    Function::call("SERVO", &[], None, 0).open(),
    Function::call("PID_MMI", &[], None, 0).open(),
    Function::call("SWAP", &[], Some(Kind::Any), 0).open(),
    Function::call("ROR1_ARB", &[], Some(Kind::Any), 0).open(),
];

/// Number of spellings.
const SPELLINGS: usize = {
    let mut count = 0;
    let mut at = 0;
    while at < FUNCTIONS.len() {
        count += 1 + FUNCTIONS[at].also.len();
        at += 1;
    }
    count
};

/// Every spelling with the place of its function in [`FUNCTIONS`].
const SPELT: [(&str, usize); SPELLINGS] = {
    let mut spelt = [("", 0); SPELLINGS];
    let mut filled = 0;
    let mut at = 0;
    while at < FUNCTIONS.len() {
        let mut spelling = 0;
        while spelling <= FUNCTIONS[at].also.len() {
            let name = if spelling == 0 { FUNCTIONS[at].name } else { FUNCTIONS[at].also[spelling - 1] };
            spelt[filled] = (name, at);
            filled += 1;
            spelling += 1;
        }
        at += 1;
    }
    spelt
};

/// Function of that name, in any case and any of its printed spellings. `SRi` is not in the table.
pub fn lookup(name: &str) -> Option<&'static Function> {
    static INDEX: Index<SPELLINGS> = index!(SPELT, 0);
    INDEX.find(name).map(|it| &FUNCTIONS[SPELT[it].1])
}

pub fn all() -> &'static [Function] {
    FUNCTIONS
}

/// Whether the word is the operator of a statement that has its operand after it: `SET`, `INC`, `READ_STS`.
pub(super) fn is_statement_word(text: &str) -> bool {
    lookup(text).is_some_and(|it| it.form == Form::Statement)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_spelling_is_found_in_any_case() {
        for function in all() {
            for name in std::iter::once(&function.name).chain(function.also) {
                assert!(name.len() <= 16, "{name}");
                assert_eq!(lookup(name), Some(function), "{name}");
                assert_eq!(lookup(&name.to_ascii_lowercase()), Some(function), "{name}");
            }
        }
        let is_first = |(at, it): (usize, &(&str, usize))| SPELT[..at].iter().all(|before| before.0 != it.0);
        assert!(SPELT.iter().enumerate().all(is_first), "two functions share a spelling");
    }

    #[test]
    fn other_names_are_not_found() {
        for name in ["", "SR1", "SQRTX", "LENGTH_AR", "É", "DATE_TO_STRING_AND_MORE"] {
            assert_eq!(lookup(name), None, "{name}");
        }
    }

    #[test]
    fn both_printed_spellings() {
        assert_eq!(lookup("LENGHT_ARX"), lookup("LENGTH_ARX"));
        assert_eq!(lookup("COCATW"), lookup("CONCATW"));
    }

    #[test]
    fn written_positions() {
        let written = |name| {
            let function = lookup(name)?;
            let all = (0..).zip(function.parameters);
            Some(all.filter(|it| it.1.is_written()).map(|it| it.0).collect::<Vec<usize>>())
        };
        assert_eq!(written("BIT_W"), Some(vec![4]));
        assert_eq!(written("SORT_ARW"), Some(vec![1]));
        assert_eq!(written("FTON"), Some(vec![2, 3, 4]));
        assert_eq!(written("RRTC"), Some(vec![0]));
        assert_eq!(written("WRTC"), Some(vec![]));
    }
}
