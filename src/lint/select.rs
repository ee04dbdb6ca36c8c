//! Which rules a word of the user means, and which rules that switches on.

use std::fmt;

use super::finding::Severity;
use super::nearest::nearest;
use super::rule::Rule;

/// The rules that one word of a configuration, of the command line or of a comment means.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Selector {
    /// `all`: every rule, also those that are off by default.
    All,
    /// `default`: the rules that are on when nothing is configured.
    Default,
    /// `W` or `writes`: the rules of a group. Selecting a group leaves its rules that are off by default off.
    Group(&'static str),
    /// `W001` or `single-write`: one rule, by its code.
    Rule(&'static str),
}

/// A word that means no rule.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnknownRule {
    pub word: String,
    /// A known word that it may be a misspelling of.
    pub nearest: Option<&'static str>,
}

impl fmt::Display for UnknownRule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "no rule or group is called `{}`", self.word)?;
        match self.nearest {
            Some(nearest) => write!(f, "; did you mean `{nearest}`?"),
            None => Ok(()),
        }
    }
}

impl std::error::Error for UnknownRule {}

impl Selector {
    /// Reads a word; case does not matter.
    pub fn parse(registry: &'static [Rule], word: &str) -> Result<Self, UnknownRule> {
        let word = word.trim();
        if word.eq_ignore_ascii_case("all") {
            return Ok(Self::All);
        }
        if word.eq_ignore_ascii_case("default") {
            return Ok(Self::Default);
        }
        for rule in registry {
            if word.eq_ignore_ascii_case(rule.code) || word.eq_ignore_ascii_case(rule.name) {
                return Ok(Self::Rule(rule.code));
            }
            if word.eq_ignore_ascii_case(rule.group) || word.eq_ignore_ascii_case(letter(rule)) {
                return Ok(Self::Group(rule.group));
            }
        }
        let names = registry.iter().flat_map(|it| [it.name, it.code, it.group]).chain(["all", "default"]);
        Err(UnknownRule { word: word.to_owned(), nearest: nearest(word, names) })
    }

    /// Whether the word covers the rule, be it on or off by default.
    pub fn covers(self, rule: &Rule) -> bool {
        match self {
            Self::All => true,
            Self::Default => rule.default,
            Self::Group(group) => rule.group == group,
            Self::Rule(code) => rule.code == code,
        }
    }

    /// Whether selecting the word switches the rule on.
    pub fn selects(self, rule: &Rule) -> bool {
        match self {
            Self::Group(group) => rule.group == group && rule.default,
            _ => self.covers(rule),
        }
    }
}

/// `W` of `W001`.
fn letter(rule: &Rule) -> &str {
    rule.code.trim_end_matches(|it: char| it.is_ascii_digit())
}

/// Which rules are on for a file, and at which severity.
#[derive(Debug, Clone)]
pub struct Selection {
    registry: &'static [Rule],
    on: Vec<bool>,
    severity: Vec<Option<Severity>>,
}

impl PartialEq for Selection {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self.registry, other.registry) && self.on == other.on && self.severity == other.severity
    }
}

impl Eq for Selection {}

impl Selection {
    /// Everything off.
    pub(super) fn none(registry: &'static [Rule]) -> Self {
        Self { registry, on: vec![false; registry.len()], severity: vec![None; registry.len()] }
    }

    pub(super) fn select(&mut self, selectors: &[Selector]) {
        for (on, rule) in self.on.iter_mut().zip(self.registry) {
            *on |= selectors.iter().any(|it| it.selects(rule));
        }
    }

    pub(super) fn ignore(&mut self, selectors: &[Selector]) {
        for (on, rule) in self.on.iter_mut().zip(self.registry) {
            *on &= !selectors.iter().any(|it| it.covers(rule));
        }
    }

    pub(super) fn clear(&mut self) {
        self.on.fill(false);
    }

    pub(super) fn set_severity(&mut self, selector: Selector, severity: Severity) {
        for (slot, rule) in self.severity.iter_mut().zip(self.registry) {
            if selector.covers(rule) {
                *slot = Some(severity);
            }
        }
    }

    fn index(&self, rule: &Rule) -> Option<usize> {
        // The registry is in the order of codes.
        self.registry.binary_search_by(|it| it.code.cmp(rule.code)).ok()
    }

    /// The severity to report a finding with, when the finding itself deserves `deserved`: what the user configured
    /// wins. `None` when the rule is off.
    pub fn severity(&self, rule: &Rule, deserved: Severity) -> Option<Severity> {
        let at = self.index(rule)?;
        self.on[at].then(|| self.severity[at].unwrap_or(deserved))
    }

    /// The rules that are on, in the order of codes.
    pub fn rules(&self) -> impl Iterator<Item = &'static Rule> {
        self.registry.iter().zip(&self.on).filter_map(|(rule, on)| on.then_some(rule))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lint::testing::RULES;

    fn selector(word: &str) -> Selector {
        Selector::parse(RULES, word).unwrap()
    }

    fn codes(selection: &Selection) -> Vec<&str> {
        selection.rules().map(|it| it.code).collect()
    }

    #[test]
    fn every_form_of_word_is_read() {
        assert_eq!(selector("w001"), Selector::Rule("W001"));
        assert_eq!(selector("Single-Write"), Selector::Rule("W001"));
        assert_eq!(selector("W"), Selector::Group("writes"));
        assert_eq!(selector("writes"), Selector::Group("writes"));
        assert_eq!(selector("all"), Selector::All);
        assert_eq!(selector("default"), Selector::Default);
    }

    #[test]
    fn an_unknown_word_names_its_neighbour() {
        let error = Selector::parse(RULES, "singel-write").unwrap_err();
        assert_eq!(error.to_string(), "no rule or group is called `singel-write`; did you mean `single-write`?");
        assert_eq!(Selector::parse(RULES, "zzz").unwrap_err().to_string(), "no rule or group is called `zzz`");
        assert!(Selector::parse(RULES, "").is_err());
    }

    #[test]
    fn a_group_leaves_off_what_is_off_by_default() {
        let mut selection = Selection::none(RULES);
        selection.select(&[selector("J")]);
        assert_eq!(codes(&selection), ["J001"]);
        selection.select(&[selector("unused-label")]);
        assert_eq!(codes(&selection), ["J001", "J005"]);
        selection.ignore(&[selector("J")]);
        assert!(codes(&selection).is_empty());
        selection.select(&[selector("all")]);
        assert_eq!(selection.rules().count(), RULES.len());
    }

    #[test]
    fn a_configured_severity_wins_over_the_deserved_one() {
        let mut selection = Selection::none(RULES);
        selection.select(&[selector("default")]);
        let rule = RULES.iter().find(|it| it.code == "W001").unwrap();
        assert_eq!(selection.severity(rule, Severity::Advice), Some(Severity::Advice));
        selection.set_severity(selector("W"), Severity::Error);
        assert_eq!(selection.severity(rule, Severity::Advice), Some(Severity::Error));
        selection.ignore(&[selector("W001")]);
        assert_eq!(selection.severity(rule, Severity::Advice), None);
    }
}
