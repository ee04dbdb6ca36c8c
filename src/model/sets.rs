//! Disjoint sets of numbers, joined two at a time.

/// Each number below the length is in a set of its own at first.
pub struct Sets(Vec<usize>);

impl Sets {
    pub fn new(len: usize) -> Self {
        Self((0..len).collect())
    }

    /// The lowest number of a set.
    pub fn find(&mut self, mut at: usize) -> usize {
        while self.0[at] != at {
            self.0[at] = self.0[self.0[at]];
            at = self.0[at];
        }
        at
    }

    pub fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.find(a), self.find(b));
        self.0[a.max(b)] = a.min(b);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn joined_from_both_ends() {
        let mut sets = Sets::new(6);
        for (a, b) in [(0, 3), (1, 2), (2, 3)] {
            sets.join(a, b);
        }
        let lowest: Vec<usize> = (0..6).map(|it| sets.find(it)).collect();
        assert_eq!(lowest, [0, 0, 0, 0, 4, 5]);
    }
}
