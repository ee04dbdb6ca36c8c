//! Questions of many atoms: a SAT solver finds values of the atoms, which are then explained by values of the objects. What
//! no values explain is a clause more, and the solver goes on.

use batsat::{Callbacks, ClauseKind, Lit, Solver, SolverInterface as _, SolverOpts, Var, lbool};

use super::problem::{Gate, Problem};
use super::{Answer, Question};

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

impl Problem<'_, '_> {
    /// `in_full`: without leaving out of the witness what does not matter, which takes long.
    pub(super) fn solve(&self, question: &Question<'_>, in_full: bool) -> Answer {
        let mut solver = Solver::new(SolverOpts::default(), Effort::default());
        let vars: Vec<Var> = self.gates.iter().map(|_| solver.new_var_default()).collect();
        let lit = |node: usize, value: bool| Lit::new(vars[node], value);
        let of_atom = |atom: usize, value: bool| lit(self.atoms[atom].0, value);
        let mut clause = Vec::new();
        let mut add = |solver: &mut Solver<Effort>, lits: &[Lit]| {
            clause.clear();
            clause.extend_from_slice(lits);
            solver.add_clause_reuse(&mut clause);
        };
        // What each node is, by Tseitin.
        for (at, gate) in self.gates.iter().enumerate() {
            let (yes, no) = (lit(at, true), lit(at, false));
            match *gate {
                Gate::Constant(value) => add(&mut solver, &[lit(at, value)]),
                Gate::Not(a) => {
                    add(&mut solver, &[yes, lit(a, true)]);
                    add(&mut solver, &[no, lit(a, false)]);
                }
                Gate::And(a, b) => {
                    add(&mut solver, &[no, lit(a, true)]);
                    add(&mut solver, &[no, lit(b, true)]);
                    add(&mut solver, &[yes, lit(a, false), lit(b, false)]);
                }
                Gate::Or(a, b) => {
                    add(&mut solver, &[yes, lit(a, false)]);
                    add(&mut solver, &[yes, lit(b, false)]);
                    add(&mut solver, &[no, lit(a, true), lit(b, true)]);
                }
                Gate::Xor(a, b) => {
                    add(&mut solver, &[no, lit(a, true), lit(b, true)]);
                    add(&mut solver, &[no, lit(a, false), lit(b, false)]);
                    add(&mut solver, &[yes, lit(a, true), lit(b, false)]);
                    add(&mut solver, &[yes, lit(a, false), lit(b, true)]);
                }
                Gate::Atom(_) => {}
            }
        }
        for law in self.edge_laws().into_iter().chain(self.order_laws()) {
            add(&mut solver, &law.map(|(atom, value)| of_atom(atom, !value)));
        }
        for pair in question.never {
            add(&mut solver, &pair.map(|it| lit(self.node(it), false)));
        }
        let assumptions: Vec<Lit> = question.wanted.iter().map(|&(id, value)| lit(self.node(id), value)).collect();
        for _ in 0..MAX_ROUNDS {
            match solver.solve_limited(&assumptions) {
                it if it == lbool::FALSE => return Answer::Never,
                it if it == lbool::TRUE => {}
                _ => return Answer::NotDecided,
            }
            let values = (0..self.atoms.len()).map(|it| Some(solver.value_lit(of_atom(it, true)) == lbool::TRUE));
            let values: Vec<Option<bool>> = values.collect();
            if in_full && let Ok(witness) = self.explain(&values) {
                return Answer::Possible(witness);
            }
            match self.witness(values, question) {
                Ok(witness) => return Answer::Possible(witness),
                Err(conflict) => {
                    let lits: Vec<Lit> = conflict.into_iter().map(|(atom, value)| of_atom(atom, !value)).collect();
                    add(&mut solver, &lits);
                }
            }
        }
        Answer::NotDecided
    }
}
