//! What a unit of PL7-2 uses and its controller, or the version of its software, does not have.

use std::collections::BTreeMap;

use rowan::TextRange;

use crate::model::UnitModel;
use crate::model::entity::Task;
use crate::model::expr::{Expr, Operator};
use crate::model::object::{Area, Class, Type};
use crate::model::unit::{Access, Mode, Pin, StatementKind};
use crate::target::pl72::{Feature, Model, Operation, TEXT_KINDS};

/// What a controller may lack.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub enum Missing {
    /// A row of the table of versions.
    Feature(Feature),
    /// A code of the table of operations.
    Operation(&'static str),
    /// An item that only one type of text block has: `T`.
    TextItem(String),
    SystemBit(u32),
    /// The clock: its blocks, its strings.
    Clock,
}

/// Where it is used, in order, and the text of the first place.
#[derive(Debug, Default)]
pub struct Uses {
    pub text: String,
    pub places: Vec<TextRange>,
}

#[derive(Debug)]
pub struct Features<'m> {
    unit: &'m UnitModel,
    /// Of the unit.
    text: &'m str,
    target: Model,
    pub missing: BTreeMap<Missing, Uses>,
}

impl<'m> Features<'m> {
    /// What the unit tells. Clock blocks, which have no objects, are the caller's to add.
    pub fn new(unit: &'m UnitModel, text: &'m str, target: Model) -> Self {
        let mut found = Self { unit, text, target, missing: BTreeMap::new() };
        let has_fast_task = target.has(Feature::PeriodicFastTask) || target.has(Feature::EventFastTask);
        if unit.entity.task() == Some(Task::Fast) && !unit.networks.is_empty() && !has_fast_task {
            found.add(Missing::Feature(Feature::PeriodicFastTask), unit.heading(), "");
        }
        for (at, access) in (0..).zip(&unit.accesses) {
            if let Some(missing) = found.of_access(at, access) {
                found.add(missing, unit.place(access.anchor), &unit.object(access.object).text);
            }
        }
        for statement in &unit.statements {
            let StatementKind::Store { value, .. } = statement.kind else { continue };
            let code = match unit.exprs.get(value) {
                Expr::Call(code, _) => code.as_str(),
                Expr::Binary(Operator::Rem, ..) => "REM",
                _ => continue,
            };
            let Some(operation) = Operation::of_code(code).filter(|it| !target.has_operation(it)) else { continue };
            let missing = match operation.feature {
                Some(feature) if !target.has(feature) => Missing::Feature(feature),
                _ => Missing::Operation(operation.code),
            };
            found.add(missing, statement.range, operation.code);
        }
        found
    }

    pub fn add(&mut self, missing: Missing, place: TextRange, text: &str) {
        let uses = self.missing.entry(missing).or_default();
        if uses.places.is_empty() {
            text.clone_into(&mut uses.text);
        }
        if uses.places.last() != Some(&place) {
            uses.places.push(place);
        }
    }

    /// `at`: number of the access.
    fn of_access(&self, at: u32, access: &Access) -> Option<Missing> {
        let object = self.unit.object(access.object);
        let lacks = |feature: Feature| (!self.target.has(feature)).then_some(Missing::Feature(feature));
        match (&object.footprint.area, object.class) {
            (Area::ModuleWords(_), _) if !self.target.has(Feature::Couplers) => lacks(Feature::Couplers),
            (Area::Network(..), _) if !self.target.has(Feature::Network) => lacks(Feature::Network),
            (Area::SystemBits, _) => {
                let number = object.footprint.start;
                (self.target.has_system_bit(number) == Some(false)).then_some(Missing::SystemBit(number))
            }
            (Area::Block("DT" | "DTP", _), _) => (!self.target.has_clock()).then_some(Missing::Clock),
            (Area::Block("TXT", _), Class::BlockWord) => {
                let item = object.text.rsplit(',').next().unwrap_or_default().to_ascii_uppercase();
                let is_of_complete = TEXT_KINDS.iter().any(|it| it.items.contains(&item.as_str()));
                if is_of_complete && !self.target.has(Feature::CompleteText) {
                    return lacks(Feature::CompleteText);
                }
                (!self.target.has_text_item(&item)).then_some(Missing::TextItem(item))
            }
            // Emission and reception: the simple block has neither input.
            (Area::Block("TXT", _), Class::Block) if access.mode == Mode::Drive(Pin::Whole) => {
                let statement = self.unit.statements.get(access.statement as usize)?;
                let is_wired = matches!(statement.kind, StatementKind::Drive { access, .. } if access == at);
                lacks(Feature::CompleteText).filter(|_| is_wired)
            }
            _ if object.extracted => lacks(Feature::WordBits),
            (Area::Words | Area::Constants, _) if matches!(object.ty, Type::WordTable(_)) => {
                // What a conversion reads or writes is a table too, and written as a word.
                let range: std::ops::Range<usize> = self.unit.place(access.anchor).into();
                let is_written_so = self.text.get(range).is_some_and(|it| it.contains('['));
                lacks(Feature::WordTables).filter(|_| is_written_so)
            }
            _ => None,
        }
    }
}
