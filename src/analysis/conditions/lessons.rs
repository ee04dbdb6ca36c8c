//! What questions about one space teach.

use std::cell::RefCell;

use rustc_hash::FxHashMap;

use super::cases::Cases;
use super::problem::Problem;
use super::solver::Told;
use super::{Answer, Question, Verdict};
use crate::model::expr::ExprId;

/// What was learnt from questions about one space, for those who ask many about the same conditions. It changes no answer
/// but those that would be [`Verdict::NotDecided`].
#[derive(Debug, Default)]
pub struct Lessons {
    pub(super) cases: RefCell<Cases>,
    /// `None` before the first question for a solver.
    told: RefCell<Option<Told>>,
    /// The questions for which no possible case was known: what several objects are written under is one question.
    answers: RefCell<FxHashMap<Asked, Verdict>>,
}

/// A [`Question`] that is kept.
#[derive(Debug, PartialEq, Eq, Hash)]
pub(super) struct Asked {
    wanted: Box<[(ExprId, bool)]>,
    never: Box<[[ExprId; 2]]>,
}

impl Lessons {
    /// What a question can be answered with; else the question, to be kept with its answer.
    pub(super) fn answer(&self, question: &Question<'_>) -> Result<Verdict, Asked> {
        if self.cases.borrow().answer(question) {
            return Ok(Verdict::Possible);
        }
        let asked = Asked { wanted: question.wanted.into(), never: question.never.into() };
        if let Some(verdict) = self.answers.borrow().get(&asked) {
            return Ok(*verdict);
        }
        if self.told.borrow_mut().as_mut().is_some_and(|it| it.refutes(question)) {
            self.keep(asked, Verdict::Never);
            return Ok(Verdict::Never);
        }
        Err(asked)
    }

    pub(super) fn keep(&self, asked: Asked, verdict: Verdict) {
        const MOST_KEPT: usize = 1 << 16;
        let mut answers = self.answers.borrow_mut();
        if answers.len() < MOST_KEPT {
            answers.insert(asked, verdict);
        }
    }

    /// The answer of a solver to a question of which all terms have types, which learns from it.
    pub(super) fn solve(&self, problem: &Problem<'_, '_>, question: &Question<'_>) -> Answer {
        let (answer, values) = problem.solve(question, true, self.told.borrow_mut().get_or_insert_default());
        if let Answer::Possible(witness) = &answer {
            self.cases.borrow_mut().add(problem, &values, witness);
        }
        answer
    }
}
