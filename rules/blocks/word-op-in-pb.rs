//! B008: an operation of function blocks in a program block of STEP 5.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::entity::BlockKind;
use crate::syntax::Language;
use crate::syntax::awl::instruction::{Conversion, Op};
use crate::syntax::step5::instruction::op;

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    let Language::Step5(mnemonics) = cx.model.language else { return };
    if cx.model.entity.block_kind() != Some(BlockKind::Pb) {
        return;
    }
    let mut found = cx.instrs().filter_map(|it| {
        let what = kind(op(it, mnemonics)?)?;
        Some((it.mnemonic()?, what))
    });
    let Some((first, what)) = found.next() else { return };
    sink.report(first.range, format!("`{}` is {what}, which program blocks do not have", first.text))
        .related_all(found.map(|(it, what)| (it.range, format!("`{}` is {what}", it.text))));
}

/// What only function blocks have.
fn kind(op: Op) -> Option<&'static str> {
    Some(match op {
        Op::WordLogic(..) | Op::Convert(Conversion::OnesComplementInt) => "a logic operation on words",
        Op::Arithmetic(..) | Op::AddConstant | Op::Increment | Op::Decrement | Op::Shift(_) | Op::Convert(_) => {
            "a calculation on words"
        }
        Op::Jump(_) => "a jump within the block",
        _ => return None,
    })
}
