//! What a failure of the mains does (PL72:1528-1546).

use super::Series;
use crate::target::Limit;

/// A failure shorter than this is no failure for a TSX 47 whose watch on the mains is on; with the supply of 24 or 48 V, 2 ms.
pub const POWER_FAILURE_MS: Limit = Limit::new(10, "PL72:1536");
pub const POWER_FAILURE_LOW_VOLTAGE_MS: Limit = Limit::new(2, "PL72:1536");
/// A TSX 17-20 without a battery keeps its data for so many hours at least.
pub const KEPT_WITHOUT_BATTERY_H: Limit = Limit::new(1, "PL72:1546");

/// How long the mains fail.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Outage {
    /// Longer than [`POWER_FAILURE_MS`], and the supply holds out.
    Short,
    /// Longer than the supply holds out.
    Long,
}

/// What the controller does then. The next start is a warm one where it saves its data (PL72:1548-1553).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct PowerFailure {
    pub outage: Outage,
    /// The watch on the mains is on, as it is when a TSX 47 is delivered. The others have none.
    pub watched: bool,
    pub stops: bool,
    pub saves: bool,
    /// Outputs go to 0 where SY8 is 1.
    pub resets_outputs: bool,
    /// The processor is without power.
    pub switches_off: bool,
    pub source: &'static str,
}

const FAILURE: PowerFailure = PowerFailure {
    outage: Outage::Short,
    watched: false,
    stops: false,
    saves: false,
    resets_outputs: false,
    switches_off: false,
    source: "PL72:1543",
};

/// PL72:1542-1544. A watched TSX 47 has stopped and saved before its supply is out.
pub static POWER_FAILURES: [PowerFailure; 4] = [
    PowerFailure { watched: true, stops: true, saves: true, resets_outputs: true, ..FAILURE },
    FAILURE,
    PowerFailure { outage: Outage::Long, watched: true, switches_off: true, source: "PL72:1544", ..FAILURE },
    PowerFailure { outage: Outage::Long, stops: true, saves: true, switches_off: true, source: "PL72:1544", ..FAILURE },
];

/// What a failure does to a controller; `None` where it cannot watch the mains.
pub fn power_failure(series: Series, watched: bool, outage: Outage) -> Option<&'static PowerFailure> {
    let has_watch = series == Series::Tsx47;
    POWER_FAILURES.iter().find(|it| it.outage == outage && it.watched == watched && (has_watch || !watched))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_controller_without_a_watch_goes_on_as_long_as_its_supply() {
        let stops = |series, watched, outage| power_failure(series, watched, outage).map(|it| it.stops);
        assert_eq!(stops(Series::Tsx47, true, Outage::Short), Some(true));
        assert_eq!(stops(Series::Tsx47, false, Outage::Short), Some(false));
        assert_eq!(stops(Series::Tsx17, false, Outage::Long), Some(true));
        assert_eq!(stops(Series::Tsx27, true, Outage::Short), None);
        // Whatever is switched off in the end, its data were saved then or before.
        for watched in [true, false] {
            let of = |outage| power_failure(Series::Tsx47, watched, outage).copied().unwrap_or(FAILURE);
            assert!(of(Outage::Long).switches_off && (of(Outage::Long).saves || of(Outage::Short).saves));
        }
    }
}
