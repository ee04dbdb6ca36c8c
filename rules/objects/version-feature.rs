//! O006: what the controller or its version does not have.

use std::collections::BTreeMap;

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::entity::Task;
use crate::model::object::{Area, Class, Type};
use crate::model::unit::{Access, Mode, Pin, StatementKind};
use crate::syntax::pl7::ast::{AssignStmt, BinOp, Cell, Expr};
use crate::syntax::pl7::ladder_words::Element;
use crate::syntax::{AstNode as _, SyntaxKind};
use crate::target::pl72::{self, Feature, Model, Operation};

/// What is missing, in the order of a unit's findings.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
enum Missing {
    Feature(Feature),
    /// A code of the table of operations.
    Operation(&'static str),
    TextItem(String),
    SystemBit(u32),
    Clock,
}

/// Where each is used, with the text.
type Uses = BTreeMap<Missing, Vec<(TextRange, String)>>;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    let Some(model) = cx.target.pl72() else { return };
    let Some(name) = model.name() else { return };
    let mut uses = Uses::new();
    let has_code = !cx.model.networks.is_empty();
    let is_fast = cx.model.entity.task() == Some(Task::Fast) && has_code;
    if is_fast && ![Feature::PeriodicFastTask, Feature::EventFastTask].iter().any(|it| model.has(*it)) {
        add(&mut uses, Missing::Feature(Feature::PeriodicFastTask), cx.model.heading(), "the fast task");
    }
    for (at, access) in (0..).zip(&cx.model.accesses) {
        let (text, place) = (&cx.model.object(access.object).text, cx.model.place(access.anchor));
        if let Some(missing) = of_access(cx, &model, at, access) {
            add(&mut uses, missing, place, text);
        }
    }
    of_operations(cx, &model, &mut uses);
    if !model.has_clock() {
        let blocks =
            cx.nodes(SyntaxKind::Cell).filter_map(Cell::cast).filter(|it| it.element() == Some(Element::Block));
        for word in blocks.filter_map(Cell::operand).filter_map(|it| clock_word(&it)) {
            add(&mut uses, Missing::Clock, word.0, &word.1);
        }
    }
    for (missing, mut places) in uses {
        places.dedup_by_key(|it| it.0);
        let mut places = places.into_iter();
        let Some((place, text)) = places.next() else { continue };
        let (message, source) = describe(&missing, &text, &name);
        let finding = sink
            .report(place, message)
            .related_all(places.map(|it| (it.0, "also here".to_owned())))
            .note(format!("the table is at {source}"));
        if let Missing::Feature(feature) = missing
            && let Some(version) = model.first_with(feature)
        {
            finding.note(format!("this controller has it from {version} on"));
        }
    }
}

fn add(uses: &mut Uses, missing: Missing, place: TextRange, text: &str) {
    uses.entry(missing).or_default().push((place, text.to_owned()));
}

fn describe(missing: &Missing, text: &str, name: &str) -> (String, String) {
    match missing {
        Missing::Feature(feature @ (Feature::PeriodicFastTask | Feature::EventFastTask)) => {
            (format!("a {name} has no fast task"), feature.source().to_owned())
        }
        Missing::Feature(feature) => {
            (format!("`{text}` is {}, which a {name} does not have", feature.describe()), feature.source().to_owned())
        }
        Missing::Operation(code) => {
            let source = Operation::of_code(code).map_or("", |it| it.source);
            (format!("`{code}` is an operation that a {name} does not have"), source.to_owned())
        }
        Missing::TextItem(_) => {
            (format!("`{text}` is of a type of text block that a {name} does not have"), "PL72:1156-1161".to_owned())
        }
        Missing::SystemBit(number) => {
            let source = pl72::system_bit(*number).map_or("", |it| it.source);
            (format!("`{text}` has no function on a {name}"), source.to_owned())
        }
        Missing::Clock => (format!("`{text}` is a clock block, which a {name} does not have"), "PL72:467".to_owned()),
    }
}

/// `at`: number of the access.
fn of_access(cx: &UnitCx<'_>, model: &Model, at: u32, access: &Access) -> Option<Missing> {
    let object = cx.model.object(access.object);
    let lacks = |feature: Feature| (!model.has(feature)).then_some(Missing::Feature(feature));
    match (&object.footprint.area, object.class) {
        (Area::ModuleWords(_), _) if !model.has(Feature::Couplers) => lacks(Feature::Couplers),
        (Area::Network(..), _) if !model.has(Feature::Network) => lacks(Feature::Network),
        (Area::SystemBits, _) => {
            let number = object.footprint.start;
            (model.has_system_bit(number) == Some(false)).then_some(Missing::SystemBit(number))
        }
        (Area::Block("TXT", _), Class::BlockWord) => {
            let item = object.text.rsplit(',').next().unwrap_or_default().to_ascii_uppercase();
            let is_of_complete = pl72::TEXT_KINDS.iter().any(|it| it.items.contains(&item.as_str()));
            if is_of_complete && !model.has(Feature::CompleteText) {
                return lacks(Feature::CompleteText);
            }
            (!model.has_text_item(&item)).then_some(Missing::TextItem(item))
        }
        // Emission and reception: the simple block has neither input.
        (Area::Block("TXT", _), Class::Block) if access.mode == Mode::Drive(Pin::Whole) => {
            let wired = matches!(
                cx.model.statements.get(access.statement as usize).map(|it| &it.kind),
                Some(&StatementKind::Drive { access, pin: Pin::Whole, .. }) if access == at
            );
            if wired { lacks(Feature::CompleteText) } else { None }
        }
        _ if object.extracted => lacks(Feature::WordBits),
        (Area::Words | Area::Constants, _) if matches!(object.ty, Type::WordTable(_)) => {
            // What a conversion reads or writes is a table too, and written as a word.
            if cx.text_of(cx.model.place(access.anchor)).contains('[') { lacks(Feature::WordTables) } else { None }
        }
        _ => None,
    }
}

fn of_operations(cx: &UnitCx<'_>, model: &Model, uses: &mut Uses) {
    for statement in cx.nodes(SyntaxKind::AssignStmt).filter_map(AssignStmt::cast) {
        let (code, token) = match statement.value() {
            Some(Expr::Call(it)) => {
                let Some(token) = it.name() else { continue };
                (token.text().trim_end_matches(|it: char| it.is_ascii_digit()), token)
            }
            Some(Expr::Bin(it)) if it.op() == Some(BinOp::Rem) => match it.operator() {
                Some(token) => ("REM", token),
                None => continue,
            },
            _ => continue,
        };
        let Some(operation) = Operation::of_code(code).filter(|it| !model.has_operation(it)) else { continue };
        let missing = match operation.feature {
            Some(feature) if !model.has(feature) => Missing::Feature(feature),
            _ => Missing::Operation(operation.code),
        };
        add(uses, missing, token.text_range(), token.text());
    }
}

/// `WEEK`, `YEAR` as the name of a block.
fn clock_word(operand: &Expr<'_>) -> Option<(TextRange, String)> {
    let text = match operand {
        Expr::Name(it) => it.name()?,
        Expr::Call(it) => it.name()?,
        _ => return None,
    };
    let is_clock = pl72::CLOCKS.iter().any(|it| it.eq_ignore_ascii_case(text.text()));
    is_clock.then(|| (text.text_range(), text.text().to_owned()))
}
