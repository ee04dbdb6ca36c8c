//! B007: a STEP 5 block without `BE`.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::syntax::Language;
use crate::syntax::awl::ast::Instr;
use crate::syntax::awl::instruction::Op;
use crate::syntax::step5::instruction::op;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    let Language::Step5(mnemonics) = cx.model.language else { return };
    let Some(kind) = cx.model.entity.block_kind().filter(|it| !it.is_data()) else { return };
    let instrs: Vec<Instr<'_>> = cx.instrs().collect();
    // It stands last, where it is not missing.
    let ends = instrs.into_iter().rev().any(|it| op(it, mnemonics) == Some(Op::BlockEnd));
    if !ends && !cx.parse.syntax().has_error() {
        sink.report(cx.model.heading(), format!("this {} has no `BE`", kind.as_str()));
    }
}
