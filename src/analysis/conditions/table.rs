//! Questions of few atoms: a truth table, one bit a row, in machine words.

use super::problem::{Gate, Problem};
use super::{Answer, Question, Verdict};

/// Truth tables have at most 2^12 rows, 64 machine words.
const MAX_ATOMS: usize = 12;

/// For each node of the conditions the rows in which it is true.
pub(super) struct Table<'p, 's, 'a> {
    problem: &'p Problem<'s, 'a>,
    /// Machine words of a column.
    words: usize,
    /// The columns of the nodes, one behind the other.
    columns: Vec<u64>,
    /// The rows that the laws between atoms allow.
    lawful: Vec<u64>,
}

impl<'p, 's, 'a> Table<'p, 's, 'a> {
    /// `None` when the problem is too large.
    pub(super) fn new(problem: &'p Problem<'s, 'a>) -> Option<Self> {
        if problem.atoms.len() > MAX_ATOMS {
            return None;
        }
        let rows = 1_usize << problem.atoms.len();
        let words = rows.div_ceil(64);
        let mut lawful = vec![u64::MAX; words];
        if rows < 64 {
            lawful[0] = (1 << rows) - 1;
        }
        let mut table = Self { problem, words, columns: Vec::with_capacity(words * problem.gates.len()), lawful };
        table.obey_laws()?;
        table.fill();
        Some(table)
    }

    fn fill(&mut self) {
        for gate in &self.problem.gates {
            for word in 0..self.words {
                let of = |node: usize| self.columns[node * self.words + word];
                self.columns.push(match *gate {
                    Gate::Constant(true) => u64::MAX,
                    Gate::Constant(false) => 0,
                    Gate::Not(a) => !of(a),
                    Gate::And(a, b) => of(a) & of(b),
                    Gate::Or(a, b) => of(a) | of(b),
                    Gate::Xor(a, b) => of(a) ^ of(b),
                    Gate::Atom(at) => atom(at, word, true),
                });
            }
        }
    }

    fn obey_laws(&mut self) -> Option<()> {
        for [(a, x), (b, y)] in self.problem.edge_laws() {
            for (word, row) in self.lawful.iter_mut().enumerate() {
                *row &= !(atom(a, word, x) & atom(b, word, y));
            }
        }
        for tie in self.problem.ties()? {
            for (word, row) in self.lawful.iter_mut().enumerate() {
                let is_case = |case: &u32| {
                    let values = tie.atoms.iter().enumerate();
                    values.fold(u64::MAX, |row, (at, &it)| row & atom(it, word, case >> at & 1 == 1))
                };
                *row &= tie.cases.iter().map(is_case).fold(0, |law, row| law | row);
            }
        }
        Some(())
    }

    /// Rows that answer the question.
    fn rows(&self, question: &Question<'_>) -> Vec<u64> {
        let column = |id| {
            let node = self.problem.node(id);
            &self.columns[node * self.words..(node + 1) * self.words]
        };
        let mut rows = self.lawful.clone();
        for &(id, value) in question.wanted {
            rows.iter_mut().zip(column(id)).for_each(|(row, it)| *row &= if value { *it } else { !it });
        }
        for &[a, b] in question.never {
            rows.iter_mut().zip(column(a)).zip(column(b)).for_each(|((row, a), b)| *row &= !(a & b));
        }
        rows
    }

    pub(super) fn decide(&self, question: &Question<'_>) -> Verdict {
        if self.rows(question).iter().any(|it| *it != 0) { Verdict::Possible } else { Verdict::Never }
    }

    /// With the values of the first row that answers the question.
    pub(super) fn answer(&self, question: &Question<'_>) -> Answer {
        let rows = self.rows(question);
        let Some((word, bits)) = rows.iter().enumerate().find(|it| *it.1 != 0) else { return Answer::Never };
        let row = word * 64 + bits.trailing_zeros() as usize;
        let mut values: Vec<_> = (0..self.problem.atoms.len()).map(|it| Some(row >> it & 1 == 1)).collect();
        self.problem.witness(&mut values, question).map_or(Answer::NotDecided, Answer::Possible)
    }
}

/// Rows in which the n-th atom has a value: a word of its column.
fn atom(n: usize, word: usize, value: bool) -> u64 {
    const PATTERN: [u64; 6] = [
        0xAAAA_AAAA_AAAA_AAAA,
        0xCCCC_CCCC_CCCC_CCCC,
        0xF0F0_F0F0_F0F0_F0F0,
        0xFF00_FF00_FF00_FF00,
        0xFFFF_0000_FFFF_0000,
        0xFFFF_FFFF_0000_0000,
    ];
    let row = match PATTERN.get(n) {
        Some(pattern) => *pattern,
        None if word >> (n - 6) & 1 == 1 => u64::MAX,
        None => 0,
    };
    if value { row } else { !row }
}
