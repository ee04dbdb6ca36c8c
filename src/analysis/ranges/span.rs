//! Ranges of whole numbers, and what operations make of them.

use crate::model::expr::{Comparison, Operator};
use crate::model::object::{Class, Object, Type};

/// The values that a number can have: none lies outside, though not each inside need occur.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Span {
    pub first: i64,
    pub last: i64,
    /// Whether the code itself says that numbers go so far: by a constant, a guard, a loop, a mask. Else it is what the width
    /// of the number allows.
    pub tells_first: bool,
    pub tells_last: bool,
    /// Not 0, though 0 lies between.
    pub not_zero: bool,
    /// Place of the store or loop that says so.
    pub by: Option<u32>,
}

impl Span {
    pub const fn exactly(value: i64) -> Self {
        Self { first: value, last: value, tells_first: true, tells_last: true, not_zero: false, by: None }
    }

    /// What a width allows.
    pub const fn any(first: i64, last: i64) -> Self {
        Self { first, last, tells_first: false, tells_last: false, not_zero: false, by: None }
    }

    pub const fn is_one(&self) -> bool {
        self.first == self.last
    }

    pub fn contains(&self, value: i64) -> bool {
        (self.first..=self.last).contains(&value) && !(value == 0 && self.not_zero)
    }

    pub const fn is_within(&self, first: i64, last: i64) -> bool {
        first <= self.first && self.last <= last
    }

    /// Without an end that is 0 and is not meant.
    fn trimmed(mut self) -> Option<Self> {
        if self.not_zero {
            self.first += i64::from(self.first == 0);
            self.last -= i64::from(self.last == 0);
            self.not_zero = self.first < 0 && self.last > 0;
        }
        (self.first <= self.last).then_some(self)
    }

    /// The values of either.
    pub fn join(self, other: Self) -> Self {
        let ends = |it: Self| (it.first, it.tells_first);
        let (first, tells_first) = if ends(self).0 <= ends(other).0 { ends(self) } else { ends(other) };
        let (last, tells_last) =
            if self.last >= other.last { (self.last, self.tells_last) } else { (other.last, other.tells_last) };
        let not_zero = first < 0 && last > 0 && !self.contains(0) && !other.contains(0);
        Self { first, last, tells_first, tells_last, not_zero, by: self.by.or(other.by) }
    }

    /// The values that compare so with some value of another; `None` when none does.
    pub fn narrowed(self, op: Comparison, other: Self) -> Option<Self> {
        let mut it = self;
        let mut at_most = |most: i64, tells: bool| {
            if most < it.last {
                (it.last, it.tells_last) = (most, tells);
            }
        };
        match op {
            Comparison::Lt => at_most(other.last.saturating_sub(1), other.tells_last),
            Comparison::Le | Comparison::Eq => at_most(other.last, other.tells_last),
            _ => {}
        }
        let mut at_least = |least: i64, tells: bool| {
            if least > it.first {
                (it.first, it.tells_first) = (least, tells);
            }
        };
        match op {
            Comparison::Gt => at_least(other.first.saturating_add(1), other.tells_first),
            Comparison::Ge | Comparison::Eq => at_least(other.first, other.tells_first),
            _ => {}
        }
        if op == Comparison::Ne && other.is_one() {
            it.first += i64::from(it.first == other.first);
            it.last -= i64::from(it.last == other.last);
            it.not_zero |= other.first == 0;
        }
        it.trimmed()
    }
}

/// How many bits an operation works on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Width {
    /// A constant takes that of the other operand.
    Constant,
    Word,
    Double,
    Unknown,
}

impl Width {
    /// Every value of it. Numbers of an unknown width may have a sign or not.
    pub const fn all(self) -> Span {
        match self {
            Self::Word => Span::any(i16::MIN as i64, i16::MAX as i64),
            Self::Double => Span::any(i32::MIN as i64, i32::MAX as i64),
            Self::Constant | Self::Unknown => Span::any(i32::MIN as i64, u32::MAX as i64),
        }
    }

    /// PL7:4100-4114: an operation with a double word is one of double words, and so is one of two constants.
    const fn with(self, other: Self) -> Self {
        match (self, other) {
            (Self::Unknown, _) | (_, Self::Unknown) => Self::Unknown,
            (Self::Double, _) | (_, Self::Double) | (Self::Constant, Self::Constant) => Self::Double,
            (Self::Word, _) | (_, Self::Word) => Self::Word,
        }
    }
}

/// A number with its width.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Number {
    pub span: Span,
    pub width: Width,
}

/// The largest number whose sign no width takes for another.
const SURE: i64 = i16::MAX as i64;

impl Number {
    pub const UNKNOWN: Self = Self::all(Width::Unknown);

    pub const fn all(width: Width) -> Self {
        Self { span: width.all(), width }
    }

    pub fn constant(value: i64) -> Self {
        let width = if i16::try_from(value).is_ok() { Width::Constant } else { Width::Double };
        Self { span: Span::exactly(value), width }
    }

    /// What an object can hold by its type; `None` for what is no whole number.
    pub fn of(object: &Object) -> Option<Self> {
        let times = crate::target::pl7::STEP_TIMES;
        Some(match (object.class, object.ty) {
            (Class::StepTime, Type::Word) => {
                Self { span: Span::any(times.first.into(), times.last.into()), width: Width::Word }
            }
            (_, Type::Byte) => Self { span: Span::any(0, u8::MAX.into()), width: Width::Word },
            (_, Type::Word) => Self::all(Width::Word),
            (_, Type::Double) => Self::all(Width::Double),
            // A symbol may be of any type.
            (_, Type::Unknown) => Self::UNKNOWN,
            _ => return None,
        })
    }

    /// What an object holds that took it: its low bits.
    pub fn stored_in(self, place: Self) -> Self {
        let limits = place.span;
        let keeps = match place.width {
            // What is wider than a word may lose bits there.
            Width::Unknown => self.span.is_within(i16::MIN.into(), SURE),
            _ => self.span.is_within(limits.first, limits.last),
        };
        if keeps {
            return Self { span: self.span, width: place.width };
        }
        let bits = match place.width {
            Width::Word if limits.first < 0 => 16,
            Width::Double => 32,
            _ => return place,
        };
        if !self.span.is_one() {
            return place;
        }
        let unused = 64 - bits;
        let value = (self.span.first << unused) >> unused;
        Self { span: Span { by: self.span.by, ..Span::exactly(value) }, width: place.width }
    }

    /// A result with ends that may lie anywhere: where it does not fit, any value.
    fn result(width: Width, first: i128, last: i128, tells: (bool, bool), by: Option<u32>) -> Self {
        let all = width.all();
        let (low, high) = match width {
            Width::Unknown => (i16::MIN.into(), SURE),
            _ => (all.first, all.last),
        };
        match (i64::try_from(first), i64::try_from(last)) {
            (Ok(first), Ok(last)) if low <= first && last <= high => {
                let (tells_first, tells_last) = tells;
                Self { span: Span { first, last, tells_first, tells_last, not_zero: false, by }, width }
            }
            _ => Self::all(width),
        }
    }

    /// `by_blocks`: of Siemens code, where nothing here tells on how many bits an operation works.
    pub fn binary(self, operator: Operator, other: Self, by_blocks: bool) -> Self {
        let width = if by_blocks { Width::Unknown } else { self.width.with(other.width) };
        let is_sure = |it: &Self| it.span.is_within(0, SURE);
        if by_blocks && !(is_sure(&self) && is_sure(&other)) {
            return Self::UNKNOWN;
        }
        // `16#FF00` is -256 where words are combined; where they are computed with, who knows.
        if self.may_be_pattern_beside(other) || other.may_be_pattern_beside(self) {
            return match operator {
                Operator::And | Operator::Or | Operator::Xor => Self::all(Width::Word),
                _ => Self::UNKNOWN,
            };
        }
        let (a, b) = (self.span, other.span);
        let by = a.by.or(b.by);
        let wide = |it: Span| (i128::from(it.first), i128::from(it.last));
        let ((a1, a2), (b1, b2)) = (wide(a), wide(b));
        match operator {
            Operator::Add => {
                let tells = (a.tells_first && b.tells_first, a.tells_last && b.tells_last);
                Self::result(width, a1 + b1, a2 + b2, tells, by)
            }
            Operator::Sub => {
                let tells = (a.tells_first && b.tells_last, a.tells_last && b.tells_first);
                Self::result(width, a1 - b2, a2 - b1, tells, by)
            }
            Operator::Mul => {
                let ends = [a1 * b1, a1 * b2, a2 * b1, a2 * b2];
                let (first, last) = min_max(&ends);
                Self::result(width, first, last, scaled(a, b), by)
            }
            Operator::Div => divided(width, a, b),
            Operator::Rem => remainder(width, a, b),
            Operator::And => masked(width, a, b),
            Operator::Or | Operator::Xor if a.first >= 0 && b.first >= 0 => {
                let most = a.last.max(b.last);
                let bits = 64 - most.leading_zeros();
                let last = (1_i128 << bits) - 1;
                Self::result(width, 0, last, (false, a.tells_last && b.tells_last), by)
            }
            _ => Self::all(width),
        }
    }

    /// Whether it is a constant of 16 bits without sign, which may stand for a negative word.
    fn may_be_pattern_beside(self, other: Self) -> bool {
        let is_pattern = self.span.is_one() && (SURE + 1..=u16::MAX.into()).contains(&self.span.first);
        is_pattern && other.width == Width::Word
    }

    pub fn negated(self) -> Self {
        let Span { first, last, tells_first, tells_last, by, .. } = self.span;
        let width = if self.width == Width::Constant { Width::Double } else { self.width };
        Self::result(width, -i128::from(last), -i128::from(first), (tells_last, tells_first), by)
    }

    /// `NOT`: each bit inverted.
    pub fn complemented(self) -> Self {
        let Span { first, last, tells_first, tells_last, by, .. } = self.span;
        match self.width {
            Width::Word | Width::Double => {
                Self::result(self.width, -1 - i128::from(last), -1 - i128::from(first), (tells_last, tells_first), by)
            }
            Width::Constant | Width::Unknown => Self::UNKNOWN,
        }
    }

    pub fn absolute(self) -> Self {
        let Span { first, last, by, .. } = self.span;
        let (first, last) = (i128::from(first), i128::from(last));
        if first >= 0 {
            return self;
        }
        let most = (-first).max(last);
        let tells = if -first > last { self.span.tells_first } else { self.span.tells_last };
        Self::result(self.width, 0.max(-last), most, (false, tells), by)
    }

    /// `SHR`: zeros come in from the left.
    pub fn shifted_right(self, count: Self) -> Self {
        let bits = match self.width {
            Width::Word => 16,
            Width::Double => 32,
            Width::Constant | Width::Unknown => return Self::UNKNOWN,
        };
        let Some(by) = u32::try_from(count.span.first).ok().filter(|it| count.span.is_one() && *it < bits) else {
            return Self::all(self.width);
        };
        let Span { first, last, tells_last, .. } = self.span;
        let (first, last, tells) = match (by, first) {
            (0, _) => return self,
            (_, 0..) => (first >> by, last >> by, tells_last),
            _ => (0, ((1_i64 << bits) - 1) >> by, true),
        };
        Self::result(self.width, first.into(), last.into(), (false, tells), self.span.by)
    }
}

fn min_max(ends: &[i128]) -> (i128, i128) {
    ends.iter().fold((i128::MAX, i128::MIN), |(min, max), it| (min.min(*it), max.max(*it)))
}

/// Which ends of a product or quotient the code tells: those of a number times a positive one, or all.
fn scaled(a: Span, b: Span) -> (bool, bool) {
    let tells = |it: Span| it.tells_first && it.tells_last;
    let is_factor = |it: Span| it.is_one() && it.first > 0 && tells(it);
    if is_factor(b) {
        (a.tells_first, a.tells_last)
    } else if is_factor(a) {
        (b.tells_first, b.tells_last)
    } else {
        (tells(a) && tells(b), tells(a) && tells(b))
    }
}

fn divided(width: Width, a: Span, b: Span) -> Number {
    if b.contains(0) {
        return Number::all(width);
    }
    let mut ends = Vec::with_capacity(8);
    for divisor in [b.first, b.last, -1, 1] {
        if divisor != 0 && b.contains(divisor) {
            ends.extend([a.first, a.last].map(|it| i128::from(it) / i128::from(divisor)));
        }
    }
    // Numbers of both signs have quotients on both sides of 0.
    if a.first < 0 && a.last > 0 {
        ends.push(0);
    }
    let (first, last) = min_max(&ends);
    let tells = if b.is_one() && b.first > 0 { (a.tells_first, a.tells_last) } else { scaled(a, b) };
    Number::result(width, first, last, tells, a.by.or(b.by))
}

/// The remainder has the sign of what is divided.
fn remainder(width: Width, a: Span, b: Span) -> Number {
    if b.contains(0) {
        return Number::all(width);
    }
    let most = b.first.unsigned_abs().max(b.last.unsigned_abs());
    let most = i64::try_from(most).unwrap_or(i64::MAX) - 1;
    let by = a.by.or(b.by);
    let tells = b.tells_first && b.tells_last;
    let (last, tells_last) = match a.last {
        ..0 => (0, false),
        it if it <= most => (it, a.tells_last),
        _ => (most, tells),
    };
    let (first, tells_first) = match a.first {
        0.. => (0, false),
        it if it >= -most => (it, a.tells_first),
        _ => (-most, tells && a.tells_first),
    };
    Number::result(width, first.into(), last.into(), (tells_first, tells_last), by)
}

/// `AND` with a number without sign leaves no more than that.
fn masked(width: Width, a: Span, b: Span) -> Number {
    let by = a.by.or(b.by);
    let most = [a, b].into_iter().filter(|it| it.first >= 0).min_by_key(|it| it.last);
    match most {
        Some(it) => Number::result(width, 0, it.last.into(), (false, it.tells_last), by),
        None => Number::all(width),
    }
}
