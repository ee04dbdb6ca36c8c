//! Versions of the software, and what each can do (PL72:569-594).

use std::fmt;
use std::str::FromStr;

use super::Series;
use crate::target::Limit;

/// A version of the software: `V3` is 3.0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Version {
    pub major: u8,
    pub minor: u8,
}

impl Version {
    pub const fn new(major: u8, minor: u8) -> Self {
        Self { major, minor }
    }
}

impl fmt::Display for Version {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "V{}", self.major)?;
        if self.minor > 0 { write!(f, ".{}", self.minor) } else { Ok(()) }
    }
}

/// Text that names no version.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnknownVersion(pub String);

impl fmt::Display for UnknownVersion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "unknown version \"{}\", expected a number such as \"V3\" or \"V3.1\"", self.0)
    }
}

impl std::error::Error for UnknownVersion {}

/// Reads `V3`, `v3.1`, `3`.
impl FromStr for Version {
    type Err = UnknownVersion;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let unknown = || UnknownVersion(text.to_owned());
        let number = |it: &str| {
            let is_number = !it.is_empty() && it.bytes().all(|it| it.is_ascii_digit());
            if is_number { it.parse::<u8>().map_err(|_| unknown()) } else { Err(unknown()) }
        };
        let body = text.trim();
        let body = body.strip_prefix(['V', 'v']).unwrap_or(body).trim_start();
        let (major, minor) = body.split_once('.').unwrap_or((body, "0"));
        Ok(Self { major: number(major)?, minor: number(minor)? })
    }
}

/// What the software of a controller may be able to do (PL72:574-586).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Feature {
    PeriodicFastTask,
    EventFastTask,
    /// Bits of words as operands.
    WordBits,
    WordTables,
    AsciiConversion,
    SimpleText,
    CompleteText,
    /// TELWAY, on a TSX 17-20 FIPWAY.
    Network,
    UniTelway,
    /// Intelligent couplers, `IWxy,i` and `OWxy,i`.
    Couplers,
}

impl Feature {
    #[cfg(test)]
    pub const ALL: [Self; 10] = [
        Self::PeriodicFastTask,
        Self::EventFastTask,
        Self::WordBits,
        Self::WordTables,
        Self::AsciiConversion,
        Self::SimpleText,
        Self::CompleteText,
        Self::Network,
        Self::UniTelway,
        Self::Couplers,
    ];

    /// What a program that needs it uses: completes "this is" or "`W5,A` is".
    pub const fn describe(self) -> &'static str {
        match self {
            Self::PeriodicFastTask => "a fast task",
            Self::EventFastTask => "a fast task that events start",
            Self::WordBits => "a bit of a word",
            Self::WordTables => "a table of words",
            Self::AsciiConversion => "a conversion of characters",
            Self::SimpleText => "of the simple text block",
            Self::CompleteText => "of the complete text block",
            Self::Network => "a word of the network",
            Self::UniTelway => "of UNI-TELWAY",
            Self::Couplers => "a word of an intelligent module",
        }
    }

    /// The row of the table.
    pub const fn source(self) -> &'static str {
        match self {
            Self::PeriodicFastTask => "PL72:574",
            Self::EventFastTask => "PL72:575",
            Self::WordBits => "PL72:576",
            Self::WordTables => "PL72:579",
            Self::AsciiConversion => "PL72:580",
            Self::SimpleText => "PL72:581",
            Self::CompleteText => "PL72:582",
            Self::Network => "PL72:583",
            Self::UniTelway => "PL72:584",
            Self::Couplers => "PL72:585",
        }
    }
}

/// A column of the table of versions (PL72:571-573).
#[derive(Debug, PartialEq, Eq)]
pub struct Release {
    pub name: &'static str,
    pub series: Series,
    /// First version.
    pub from: Version,
    /// First version of the next release.
    pub before: Option<Version>,
    pub features: &'static [Feature],
    /// `Wi`.
    pub words: Limit,
    /// `CWi`.
    pub constants: Limit,
}

const V0: Version = Version::new(0, 0);
const V3: Version = Version::new(3, 0);
const V4: Version = Version::new(4, 0);

const fn words(count: u32) -> Limit {
    Limit::new(count, "PL72:577")
}

const fn constants(count: u32) -> Limit {
    Limit::new(count, "PL72:578")
}

pub(super) static TSX_27_V2: Release = Release {
    name: "TSX 27 before V3",
    series: Series::Tsx27,
    from: V0,
    before: Some(V3),
    features: &[Feature::SimpleText],
    words: words(128),
    constants: constants(128),
};

pub(super) static TSX_27_V3: Release = Release {
    name: "TSX 27 V3",
    series: Series::Tsx27,
    from: V3,
    before: None,
    features: &[
        Feature::PeriodicFastTask,
        Feature::WordBits,
        Feature::WordTables,
        Feature::AsciiConversion,
        Feature::CompleteText,
    ],
    words: words(128),
    constants: constants(1024),
};

pub(super) static TSX_47_V2: Release = Release {
    name: "TSX 47 before V3",
    series: Series::Tsx47,
    from: V0,
    before: Some(V3),
    features: &[Feature::SimpleText, Feature::Network],
    words: words(128),
    constants: constants(128),
};

pub(super) static TSX_47_10_V3: Release = Release {
    name: "TSX 47-J, TSX 47-10 V3",
    series: Series::Tsx47,
    from: V3,
    before: None,
    features: &[
        Feature::PeriodicFastTask,
        Feature::WordBits,
        Feature::WordTables,
        Feature::AsciiConversion,
        Feature::CompleteText,
        Feature::Network,
    ],
    words: words(1024),
    constants: constants(1024),
};

pub(super) static TSX_47_20_V3: Release = Release {
    name: "TSX 47-20 V3",
    series: Series::Tsx47,
    from: V3,
    before: Some(V4),
    features: &[
        Feature::PeriodicFastTask,
        Feature::WordBits,
        Feature::WordTables,
        Feature::AsciiConversion,
        Feature::CompleteText,
        Feature::Network,
        Feature::Couplers,
    ],
    words: words(1024),
    constants: constants(1024),
};

pub(super) static TSX_47_20_V4: Release = Release {
    name: "TSX 47-20 V4",
    series: Series::Tsx47,
    from: V4,
    before: None,
    features: &[
        Feature::PeriodicFastTask,
        Feature::WordBits,
        Feature::WordTables,
        Feature::AsciiConversion,
        Feature::CompleteText,
        Feature::Network,
        Feature::UniTelway,
        Feature::Couplers,
    ],
    words: words(1024),
    constants: constants(1024),
};

pub(super) static TSX_17_20: Release = Release {
    name: "TSX 17-20",
    series: Series::Tsx17,
    from: V0,
    before: None,
    features: &[
        Feature::EventFastTask,
        Feature::WordBits,
        Feature::WordTables,
        Feature::AsciiConversion,
        Feature::CompleteText,
        Feature::Network,
        Feature::UniTelway,
        Feature::Couplers,
    ],
    words: words(1024),
    constants: constants(1024),
};

/// Every column of the table of versions.
pub static RELEASES: [&Release; 7] =
    [&TSX_27_V2, &TSX_27_V3, &TSX_47_V2, &TSX_47_10_V3, &TSX_47_20_V3, &TSX_47_20_V4, &TSX_17_20];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions() {
        let read = |text: &str| text.parse::<Version>().map(|it| (it.major, it.minor)).map_err(|it| it.0);
        for (text, expected) in [("V3", (3, 0)), ("v3.1", (3, 1)), (" 4 ", (4, 0)), ("V 2.0", (2, 0))] {
            assert_eq!(read(text), Ok(expected), "{text}");
        }
        for text in ["", "V<3", "V", "V3.", "V3.1.2", "V256", "+3", "V-1", "Vé"] {
            assert_eq!(read(text), Err(text.to_owned()));
        }
        assert_eq!((Version::new(3, 0).to_string(), Version::new(3, 1).to_string()), ("V3".into(), "V3.1".into()));
    }
}
