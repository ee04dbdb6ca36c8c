//! What a unit tells of its bits and words: who writes them in which order, under which conditions.
//!
//! **Invariant:** no position. Conditions keep the versions of what they read, so that two reads with one value stay one.

use rustc_hash::FxHashMap;

use crate::model::UnitModel;
use crate::model::entity::Entity;
use crate::model::expr::{Expr, ExprId, Exprs, ObjectId, Operator, Places, Pool};
use crate::model::object::Class;
use crate::model::unit::{Pin, StatementKind};

/// The code of a unit that may be part of a sequence, or of a table of steps.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CodeFacts {
    /// In the order of execution.
    pub acts: Box<[Act]>,
    /// What their conditions and values are made of.
    pub pool: Pool,
    /// Whether a bit is set and another one reset under one condition, several bits are set, or a word is combined with
    /// another one.
    pub may_evolve: bool,
    /// Whether it sets a bit of its own and resets it: each of its calls may be a step.
    pub may_be_step: bool,
}

/// Conditions and values are places in the pool, objects indices into the unit's objects.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Act {
    Write {
        how: How,
        object: u32,
        anchor: u32,
        network: u32,
        path: u32,
        /// The condition of a set or reset, else what is written; `None` for what is not understood.
        value: Option<u32>,
    },
    /// A timer is started, or not, by a condition.
    Start { timer: u32, path: u32, when: u32 },
    /// A bit keeps a result, for the edge that comes with the next scan.
    Remember { memory: u32, path: u32, of: u32, pulse: u32, rising: bool },
    /// A condition decides how the program goes on.
    Test(u32),
    /// Index of the call.
    Call { call: u32, path: u32, when: u32 },
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum How {
    Set,
    Reset,
    Assign,
    Store,
}

impl CodeFacts {
    /// How much there is to do when it runs.
    pub fn size(&self) -> usize {
        self.acts.len() + self.pool.len()
    }

    pub fn new(model: &UnitModel) -> Option<Box<Self>> {
        if !matches!(model.entity, Entity::Block { .. } | Entity::Listing) || model.statements.is_empty() {
            return None;
        }
        let mut acts: Vec<Drawn> = Vec::new();
        let mut pulses = model.pulses.iter().peekable();
        for (at, statement) in (0..).zip(&model.statements) {
            while let Some(it) = pulses.next_if(|it| it.statement <= at) {
                acts.push(Drawn::Remember(it.memory.0, it.path, it.of, it.value, it.rising));
            }
            let path = statement.path;
            if path == Exprs::FALSE {
                continue;
            }
            let write = |how, access: u32, value| {
                let access = model.accesses.get(access as usize)?;
                let object = model.object(access.object);
                // Outputs are no steps, and conditions seldom read them.
                let is_kept = matches!(
                    object.class,
                    Class::Memory
                        | Class::Data
                        | Class::InstanceData
                        | Class::Symbol
                        | Class::LocalName
                        | Class::LocalData
                );
                is_kept.then_some(Drawn::Write(how, access.object.0, access.anchor, statement.network, path, value))
            };
            let act = match statement.kind {
                StatementKind::Set { access, when } => write(How::Set, access, Some(when)),
                StatementKind::Reset { access, when } => write(How::Reset, access, Some(when)),
                StatementKind::Assign { access, value } => write(How::Assign, access, Some(value)),
                StatementKind::Store { access, value } => {
                    let is_read = matches!(
                        model.exprs.get(value),
                        Expr::Int(_) | Expr::Read { .. } | Expr::Binary(..) | Expr::Text(_)
                    );
                    write(How::Store, access, Some(value).filter(|_| is_read))
                }
                StatementKind::Drive { access, pin: Pin::Start, when, .. } => {
                    model.accesses.get(access as usize).map(|it| Drawn::Start(it.object.0, path, when))
                }
                StatementKind::Jump(_) | StatementKind::Return { .. } => model.condition(statement).map(Drawn::Test),
                StatementKind::Call(call) => model.condition(statement).map(|it| Drawn::Call(call, path, it)),
                _ => None,
            };
            acts.extend(act.filter(|it| !matches!(it, Drawn::Test(Exprs::TRUE))));
        }
        // What only tests does nothing.
        if acts.iter().all(|it| matches!(it, Drawn::Test(_) | Drawn::Remember(..) | Drawn::Start(..))) {
            return None;
        }
        let (pool, places) = model.exprs.cut_all(acts.iter().flat_map(Drawn::conditions));
        let may_evolve = may_evolve(model, &acts);
        let may_be_step = may_be_step(model, &acts);
        let acts = acts.iter().map(|it| it.place(&places)).collect();
        Some(Box::new(Self { acts, pool, may_evolve, may_be_step }))
    }
}

/// An act with its conditions as they are in the unit.
enum Drawn {
    Write(How, u32, u32, u32, ExprId, Option<ExprId>),
    Start(u32, ExprId, ExprId),
    Remember(u32, ExprId, ExprId, ExprId, bool),
    Test(ExprId),
    Call(u32, ExprId, ExprId),
}

impl Drawn {
    fn conditions(&self) -> impl Iterator<Item = ExprId> {
        let all = match *self {
            Self::Write(_, _, _, _, path, value) => [Some(path), value, None],
            Self::Start(_, path, when) | Self::Call(_, path, when) => [Some(path), Some(when), None],
            Self::Remember(_, path, of, pulse, _) => [Some(path), Some(of), Some(pulse)],
            Self::Test(when) => [Some(when), None, None],
        };
        all.into_iter().flatten()
    }

    fn place(&self, places: &Places) -> Act {
        let at = |it: ExprId| places.of(it);
        match *self {
            Self::Write(how, object, anchor, network, path, value) => {
                Act::Write { how, object, anchor, network, path: at(path), value: value.map(at) }
            }
            Self::Start(timer, path, when) => Act::Start { timer, path: at(path), when: at(when) },
            Self::Remember(memory, path, of, pulse, rising) => {
                Act::Remember { memory, path: at(path), of: at(of), pulse: at(pulse), rising }
            }
            Self::Test(when) => Act::Test(at(when)),
            Self::Call(call, path, when) => Act::Call { call, path: at(path), when: at(when) },
        }
    }
}

/// See [`CodeFacts::may_be_step`].
fn may_be_step(model: &UnitModel, acts: &[Drawn]) -> bool {
    let own = |wanted: How| {
        let is_own = move |object: u32| model.object(ObjectId(object)).class == Class::LocalName;
        acts.iter().filter_map(move |it| match *it {
            Drawn::Write(how, object, ..) if how == wanted && is_own(object) => Some(object),
            _ => None,
        })
    };
    own(How::Set).any(|set| own(How::Reset).any(|it| it == set))
}

/// See [`CodeFacts::may_evolve`].
fn may_evolve(model: &UnitModel, acts: &[Drawn]) -> bool {
    /// A chain that resets a step by the next one has at least so many.
    const FEWEST_SETS: usize = 3;
    let mut done: FxHashMap<(ExprId, ExprId), [bool; 2]> = FxHashMap::default();
    let mut sets = 0;
    acts.iter().any(|it| match *it {
        Drawn::Write(_, _, _, _, Exprs::TRUE, Some(Exprs::TRUE)) => false,
        Drawn::Write(how @ (How::Set | How::Reset), _, _, _, path, Some(when)) => {
            let found = done.entry((path, when)).or_default();
            found[usize::from(how == How::Set)] = true;
            sets += usize::from(how == How::Set);
            *found == [true; 2] || sets >= FEWEST_SETS
        }
        Drawn::Write(How::Store, _, _, _, _, Some(value)) => {
            matches!(model.exprs.get(value), Expr::Binary(Operator::And | Operator::Or, ..) | Expr::Read { .. })
        }
        _ => false,
    })
}
