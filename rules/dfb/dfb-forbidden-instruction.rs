//! F006: an instruction that the code of a DFB may not hold.

use rowan::TextRange;
use rustc_hash::FxHashMap;

use crate::lint::{Sink, UnitCx};
use crate::model::entity::Entity;
use crate::model::expr::ObjectId;
use crate::model::object::Class;
use crate::model::unit::{Callee, StatementKind};
use crate::syntax::pl7::ast::CallStmt;
use crate::syntax::pl7::functions::Kind;
use crate::syntax::{AstNode as _, SyntaxKind};

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    let model = cx.model;
    if !matches!(model.entity, Entity::Dfb { .. }) {
        return;
    }
    let mut blocks: FxHashMap<ObjectId, Vec<TextRange>> = FxHashMap::default();
    for it in &model.accesses {
        if matches!(model.object(it.object).class, Class::Block | Class::BlockBit | Class::BlockWord) {
            blocks.entry(it.object).or_default().push(model.place(it.anchor));
        }
    }
    let mut blocks: Vec<_> = blocks.into_iter().collect();
    blocks.sort_by_key(|it| it.0);
    for (object, places) in blocks {
        let [first, others @ ..] = &places[..] else { continue };
        let text = &model.object(object).text;
        sink.report(*first, format!("the code of a DFB cannot use the standard function block `{text}`"))
            .related_all(others.iter().map(|it| (*it, "also here".to_owned())));
    }
    for call in &model.calls {
        let what = match call.callee {
            Callee::Subroutine(_) => "the subroutine",
            Callee::Instance(_) => "another DFB,",
            _ => continue,
        };
        sink.report(model.place(call.anchor), format!("the code of a DFB cannot call {what} `{}`", call.text));
    }
    for jump in &model.jumps {
        sink.report(jump.range, format!("the code of a DFB cannot jump, here to `{}`", jump.text));
    }
    for (at, label) in (0..).zip(&model.labels) {
        if !model.jumps.iter().any(|it| it.target == Some(at)) {
            sink.report(label.range, format!("the code of a DFB cannot have labels, such as `{}`", label.text));
        }
    }
    for it in model.statements.iter().filter(|it| matches!(it.kind, StatementKind::Halt)) {
        sink.report(it.range, "the code of a DFB cannot halt the program");
    }
    for it in cx.nodes(SyntaxKind::CallStmt).filter_map(CallStmt::cast) {
        let on_module = it.function().is_some_and(|it| it.parameters.iter().any(|it| it.kind == Kind::Channel));
        if let Some(callee) = it.callee().filter(|_| on_module) {
            let message = format!("the code of a DFB cannot exchange with modules, as `{}` does", callee.text());
            sink.report(callee.text_range(), message);
        }
    }
}
