//! Questions of many atoms: a SAT solver finds values of the atoms, which are then explained by values of the objects. What
//! no values explain is a clause more, and the solver goes on.

use batsat::{Callbacks, ClauseKind, Lit, Solver, SolverInterface as _, SolverOpts, Var, lbool};
use rustc_hash::FxHashMap;

use super::problem::{Atom, Gate, Problem, Subject};
use super::{Answer, Question};
use crate::model::expr::ExprId;

/// So many candidates of the solver are refuted before the question is given up.
const MAX_ROUNDS: usize = 1000;

/// The dead ends of the solver on its way through a question, and so many are the most: what somebody meant has few.
#[derive(Default)]
struct Effort(u32);

const MAX_DEAD_ENDS: u32 = 20_000;

impl Callbacks for Effort {
    fn on_new_clause(&mut self, _: &[Lit], _: ClauseKind) {
        self.0 = self.0.saturating_add(1);
    }

    fn stop(&self) -> bool {
        self.0 > MAX_DEAD_ENDS
    }
}

/// A solver with the conditions that it was told of.
///
/// **Invariant:** its clauses are what conditions are made of, and laws of their atoms, never what a question wants: they
/// hold for every question about the same space.
pub(super) struct Told {
    solver: Solver<Effort>,
    nodes: FxHashMap<ExprId, Var>,
    /// Whether both conditions of a pair hold.
    pairs: FxHashMap<[ExprId; 2], Var>,
    /// Atoms between which laws may be.
    alike: FxHashMap<Subject, Vec<(Var, Atom)>>,
    clause: Vec<Lit>,
}

impl Default for Told {
    fn default() -> Self {
        Self {
            solver: Solver::new(SolverOpts::default(), Effort::default()),
            nodes: FxHashMap::default(),
            pairs: FxHashMap::default(),
            alike: FxHashMap::default(),
            clause: Vec::new(),
        }
    }
}

impl std::fmt::Debug for Told {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Told").field("nodes", &self.nodes).field("pairs", &self.pairs).finish_non_exhaustive()
    }
}

impl Told {
    fn add(&mut self, lits: &[Lit]) {
        self.clause.clear();
        self.clause.extend_from_slice(lits);
        self.solver.add_clause_reuse(&mut self.clause);
    }

    /// Takes in what a question is about. A solver gives a value to all that it was told of: where that is much more than
    /// the question is about, it forgets it first.
    fn tell(&mut self, problem: &Problem<'_, '_>) -> Vec<Var> {
        if self.nodes.len() > problem.gates.len() * 16 + 2048 {
            *self = Self::default();
        }
        let mut vars: Vec<Var> = Vec::with_capacity(problem.gates.len());
        for (&id, gate) in problem.ids.iter().zip(&problem.gates) {
            if let Some(&var) = self.nodes.get(&id) {
                vars.push(var);
                continue;
            }
            // The values of the atoms say those of all other nodes.
            let is_atom = matches!(gate, Gate::Atom(_));
            let var = self.solver.new_var(lbool::UNDEF, is_atom);
            self.nodes.insert(id, var);
            vars.push(var);
            self.define(gate, var, &vars);
            if let Gate::Atom(at) = *gate {
                self.obey_laws(problem, var, &problem.atoms[at].1);
            }
        }
        vars
    }

    /// Whether a question has no answer by what the solver was told of already, all that the question is about.
    pub(super) fn refutes(&mut self, question: &Question<'_>) -> bool {
        /// With more, it is better to see first what the question is about.
        const MOST: usize = 4096;
        if self.nodes.len() > MOST {
            return false;
        }
        let node = |id: ExprId| self.nodes.get(&id).copied();
        let wanted: Option<Vec<Lit>> = question.wanted.iter().map(|it| Some(Lit::new(node(it.0)?, it.1))).collect();
        let pairs: Option<Vec<[Var; 2]>> = question.never.iter().map(|&[a, b]| Some([node(a)?, node(b)?])).collect();
        let (Some(mut assumptions), Some(pairs)) = (wanted, pairs) else { return false };
        for (&pair, vars) in question.never.iter().zip(pairs) {
            assumptions.push(Lit::new(self.both(pair, vars), false));
        }
        *self.solver.cb_mut() = Effort::default();
        self.solver.solve_limited(&assumptions) == lbool::FALSE
    }

    /// What a node is, by Tseitin.
    fn define(&mut self, gate: &Gate, node: Var, vars: &[Var]) {
        let (yes, no) = (Lit::new(node, true), Lit::new(node, false));
        let lit = |of: usize, value: bool| Lit::new(vars[of], value);
        match *gate {
            Gate::Constant(value) => self.add(&[Lit::new(node, value)]),
            Gate::Not(a) => {
                self.add(&[yes, lit(a, true)]);
                self.add(&[no, lit(a, false)]);
            }
            Gate::And(a, b) => {
                self.add(&[no, lit(a, true)]);
                self.add(&[no, lit(b, true)]);
                self.add(&[yes, lit(a, false), lit(b, false)]);
            }
            Gate::Or(a, b) => {
                self.add(&[yes, lit(a, false)]);
                self.add(&[yes, lit(b, false)]);
                self.add(&[no, lit(a, true), lit(b, true)]);
            }
            Gate::Xor(a, b) => {
                self.add(&[no, lit(a, true), lit(b, true)]);
                self.add(&[no, lit(a, false), lit(b, false)]);
                self.add(&[yes, lit(a, true), lit(b, false)]);
                self.add(&[yes, lit(a, false), lit(b, true)]);
            }
            Gate::Atom(_) => {}
        }
    }

    fn obey_laws(&mut self, problem: &Problem<'_, '_>, var: Var, atom: &Atom) {
        let Some(subject) = problem.subject(atom) else { return };
        let before = self.alike.entry(subject).or_default();
        let mut laws = Vec::new();
        for (other, it) in before.iter() {
            // Of one term, whose number is another one in each problem.
            let it = match (*atom, *it) {
                (Atom::Bound(term, _), Atom::Bound(_, bound)) => Atom::Bound(term, bound),
                (_, it) => it,
            };
            laws.extend(problem.excluded(atom, &it).map(|(x, y)| [Lit::new(var, !x), Lit::new(*other, !y)]));
        }
        before.push((var, *atom));
        laws.iter().for_each(|it| self.add(it));
    }

    /// Whether both conditions of a pair hold.
    fn both(&mut self, pair: [ExprId; 2], [a, b]: [Var; 2]) -> Var {
        if let Some(&both) = self.pairs.get(&pair) {
            return both;
        }
        let both = self.solver.new_var(lbool::UNDEF, false);
        self.pairs.insert(pair, both);
        self.define(&Gate::And(0, 1), both, &[a, b]);
        both
    }
}

impl Problem<'_, '_> {
    /// Also the values of the atoms that the answer explains. `in_full`: without leaving out of the witness what does not
    /// matter, which takes long.
    pub(super) fn solve(&self, question: &Question<'_>, in_full: bool, told: &mut Told) -> (Answer, Vec<Option<bool>>) {
        let vars = told.tell(self);
        let of_atom = |atom: usize, value: bool| Lit::new(vars[self.atoms[atom].0], value);
        let mut assumptions: Vec<Lit> =
            question.wanted.iter().map(|&(id, value)| Lit::new(vars[self.node(id)], value)).collect();
        for &pair in question.never {
            let both = told.both(pair, pair.map(|it| vars[self.node(it)]));
            assumptions.push(Lit::new(both, false));
        }
        *told.solver.cb_mut() = Effort::default();
        for _ in 0..MAX_ROUNDS {
            match told.solver.solve_limited(&assumptions) {
                it if it == lbool::FALSE => return (Answer::Never, Vec::new()),
                it if it == lbool::TRUE => {}
                _ => return (Answer::NotDecided, Vec::new()),
            }
            let value = |it: usize| Some(told.solver.value_lit(of_atom(it, true)) == lbool::TRUE);
            let mut values: Vec<Option<bool>> = (0..self.atoms.len()).map(value).collect();
            if in_full && let Ok(witness) = self.explain(&values) {
                return (Answer::Possible(witness), values);
            }
            match self.witness(&mut values, question) {
                Ok(witness) => return (Answer::Possible(witness), values),
                Err(conflict) => {
                    let lits: Vec<Lit> = conflict.into_iter().map(|(atom, value)| of_atom(atom, !value)).collect();
                    told.add(&lits);
                }
            }
        }
        (Answer::NotDecided, Vec::new())
    }
}
