//! O006: what the controller or its version does not have.

use rowan::TextRange;

use crate::analysis::features::{Features, Missing};
use crate::lint::{Sink, UnitCx};
use crate::syntax::pl7::ast::{Cell, Expr};
use crate::syntax::pl7::ladder_words::Element;
use crate::syntax::{AstNode as _, SyntaxKind, SyntaxToken};
use crate::target::pl72::{self, Feature, Operation};

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    let Some(model) = cx.target.pl72() else { return };
    let Some(name) = model.name() else { return };
    let mut features = Features::new(cx.model, cx.text, model);
    if !model.has_clock() {
        let blocks =
            cx.nodes(SyntaxKind::Cell).filter_map(Cell::cast).filter(|it| it.element() == Some(Element::Block));
        for word in blocks.filter_map(clock_word) {
            features.add(Missing::Clock, word.text_range(), word.text());
        }
    }
    for (missing, uses) in features.missing {
        let mut places = uses.places.into_iter();
        let Some(place) = places.next() else { continue };
        let (message, source) = describe(&missing, &uses.text, &name);
        let finding = sink
            .report(place, message)
            .related_all(places.map(|it| (it, "also here".to_owned())))
            .note(format!("the table is at {source}"));
        if let Missing::Feature(feature) = missing
            && let Some(version) = model.first_with(feature)
        {
            finding.note(format!("this controller has it from {version} on"));
        }
    }
}

fn describe(missing: &Missing, text: &str, name: &str) -> (String, &'static str) {
    match missing {
        Missing::Feature(feature @ (Feature::PeriodicFastTask | Feature::EventFastTask)) => {
            (format!("a {name} has no fast task"), feature.source())
        }
        Missing::Feature(feature) => {
            (format!("`{text}` is {}, which a {name} does not have", feature.describe()), feature.source())
        }
        Missing::Operation(code) => {
            let source = Operation::of_code(code).map_or("", |it| it.source);
            (format!("`{code}` is an operation that a {name} does not have"), source)
        }
        Missing::TextItem(_) => {
            (format!("`{text}` is of a type of text block that a {name} does not have"), "PL72:1156-1161")
        }
        Missing::SystemBit(number) => {
            let source = pl72::system_bit(*number).map_or("", |it| it.source);
            (format!("`{text}` has no function on a {name}"), source)
        }
        Missing::Clock => (format!("`{text}` is of the clock, which a {name} does not have"), "PL72:467"),
    }
}

/// `WEEK`, `YEAR` as the name of a block.
fn clock_word(cell: Cell<'_>) -> Option<SyntaxToken<'_>> {
    let word = match cell.operand()? {
        Expr::Name(it) => it.name()?,
        Expr::Call(it) => it.name()?,
        _ => return None,
    };
    pl72::CLOCKS.iter().any(|it| it.eq_ignore_ascii_case(word.text())).then_some(word)
}
