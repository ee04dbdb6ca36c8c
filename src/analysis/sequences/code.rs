//! What a unit tells of its bits and words: who writes them in which order, under which conditions.
//!
//! **Invariant:** no position. Conditions keep the versions of what they read, so that two reads with one value stay one.

use rustc_hash::FxHashMap;

use crate::model::UnitModel;
use crate::model::entity::Entity;
use crate::model::expr::{Expr, ExprId, Exprs, ObjectId, Operator, Places, Pool};
use crate::model::object::{Class, Object};
use crate::model::unit::{Pin, StatementKind};

/// The code of a unit that may be part of a sequence, or of a table of steps.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CodeFacts {
    /// In the order of execution.
    pub acts: Box<[Act]>,
    /// What their conditions and values are made of.
    pub pool: Pool,
    /// Which bits the values of bits ask for, or take the place of.
    pub asks: Box<[Ask]>,
    /// Whether a word is complemented, or conditions are too long to be looked into.
    pub may_evolve: bool,
    /// Bits that may hold themselves by a bit of another word.
    pub held: u32,
    /// Whether it sets a bit of its own and resets it: each of its calls may be a step.
    pub may_be_step: bool,
}

/// A bit gets a value in a way that asks for another bit; both are indices into the unit's objects.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Ask {
    pub how: How,
    pub object: u32,
    /// `None` where it asks for nothing.
    pub of: Option<u32>,
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
                is_kept(object).then_some(Drawn::Write(
                    how,
                    access.object.0,
                    access.anchor,
                    statement.network,
                    path,
                    value,
                ))
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
        let (asks, may_evolve) = asks(model, &acts);
        let held = u32::try_from(acts.iter().filter(|it| may_hold(model, it)).count()).unwrap_or(u32::MAX);
        let may_be_step = may_be_step(model, &acts);
        let acts = acts.iter().map(|it| it.place(&places)).collect();
        Some(Box::new(Self { acts, pool, asks, may_evolve, held, may_be_step }))
    }
}

/// Whether an object may be a step, or carry what a step is asked for. Outputs are no steps, and conditions seldom read them.
fn is_kept(object: &Object) -> bool {
    matches!(
        object.class,
        Class::Memory | Class::Data | Class::InstanceData | Class::Symbol | Class::LocalName | Class::LocalData
    )
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

/// See [`CodeFacts::asks`] and [`CodeFacts::may_evolve`].
fn asks(model: &UnitModel, acts: &[Drawn]) -> (Box<[Ask]>, bool) {
    /// Of a longer condition, all may be asked for.
    const LONGEST: usize = 64;
    let pulses: FxHashMap<ExprId, ExprId> = acts
        .iter()
        .filter_map(|it| match *it {
            Drawn::Remember(_, _, of, pulse, _) => Some((pulse, of)),
            _ => None,
        })
        .collect();
    let mut asks: Vec<Ask> = Vec::new();
    let mut may_evolve = false;
    let mut moved: FxHashMap<(ExprId, ExprId), [Option<u32>; 2]> = FxHashMap::default();
    let mut open: Vec<ExprId> = Vec::new();
    for it in acts {
        let Drawn::Write(how, object, _, _, path, Some(value)) = *it else { continue };
        if how == How::Store {
            open.push(value);
            for _ in 0..LONGEST {
                let Some(at) = open.pop() else { break };
                may_evolve |= matches!(model.exprs.get(at), Expr::Binary(Operator::Xor, ..));
                model.exprs.each_operand(at, |it| open.push(it));
            }
            may_evolve |= !open.is_empty();
            open.clear();
            continue;
        }
        if matches!(how, How::Set | How::Reset) && (path, value) != (Exprs::TRUE, Exprs::TRUE) {
            let of = moved.entry((path, value)).or_default();
            of[usize::from(how == How::Set)] = Some(object);
            // One takes the place of the other.
            if let [Some(reset), Some(set)] = *of
                && reset != set
            {
                asks.push(Ask { how: How::Set, object: set, of: Some(reset) });
            }
        }
        asks.push(Ask { how, object, of: None });
        open.extend([path, value]);
        for _ in 0..LONGEST {
            let Some(at) = open.pop() else { break };
            match model.exprs.get(at) {
                Expr::Read { object: read, .. } | Expr::Edge { object: read, .. } if is_kept(model.object(*read)) => {
                    asks.push(Ask { how, object, of: Some(read.0) });
                }
                _ => {}
            }
            open.extend(pulses.get(&at));
            model.exprs.each_operand(at, |it| open.push(it));
        }
        may_evolve |= !open.is_empty();
        open.clear();
    }
    asks.sort_unstable();
    asks.dedup();
    (asks.into(), may_evolve)
}

/// Whether an assigned bit may hold itself by another one: in one of several ways to be 1, a bit of the same area is asked
/// for together with the absence of something.
fn may_hold(model: &UnitModel, it: &Drawn) -> bool {
    let Drawn::Write(How::Assign, object, _, _, _, Some(value)) = *it else { return false };
    let area = &model.object(ObjectId(object)).footprint.area;
    let (mut ways, mut negates, mut reads) = (false, false, false);
    model.exprs.each_part(value, |it| match model.exprs.get(it) {
        Expr::Or(..) => ways = true,
        Expr::Not(_) => negates = true,
        Expr::Read { object: read, .. } => reads |= read.0 != object && model.object(*read).footprint.area == *area,
        _ => {}
    });
    ways && negates && reads
}
