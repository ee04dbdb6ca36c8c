//! J008: a call of a subroutine or block that the program does not contain.

use rustc_hash::FxHashMap;

use crate::analysis::Site;
use crate::analysis::program::{GlobalCall, ProgramIndex};
use crate::lint::{ProgramCx, Sink};
use crate::model::entity::{BlockKind, BlockName};
use crate::model::unit::Callee;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    if !cx.program.has_main() {
        return;
    }
    let names = Names::new(cx.program);
    let mut missing: FxHashMap<&Callee, Vec<&GlobalCall<'_>>> = FxHashMap::default();
    let mut order = Vec::new();
    for call in cx.program.calls.iter().filter(|it| it.target.is_none() && names.would_have(&it.it.callee)) {
        let calls = missing.entry(&call.it.callee).or_default();
        if calls.is_empty() {
            order.push(&call.it.callee);
        }
        calls.push(call);
    }
    // Where more is missing than there is, the program was given in part.
    if order.len() > names.defined {
        return;
    }
    for callee in order {
        let Some((first, others)) = missing.get(callee).and_then(|it| it.split_first()) else { continue };
        sink.report(first.site(), format!("`{}` is called, and the program does not contain it", first.it.text))
            .related_all(others.iter().map(|it| (it.site(), "also called here".to_owned())))
            .note("this assumes that the files read are the whole program; a library block counts as missing");
    }
}

/// How the program names its subroutines and blocks. It may name a block by its number here and by its symbol there,
/// which only the symbol table ties.
struct Names {
    defined: usize,
    by_number: bool,
    by_symbol: bool,
}

impl Names {
    fn new(program: &ProgramIndex<'_>) -> Self {
        let mut names = Self { defined: 0, by_number: false, by_symbol: false };
        for facts in &program.units {
            let entity = &facts.entity;
            if entity.subroutine().is_some() || matches!(entity.block_kind(), Some(BlockKind::Fb | BlockKind::Fc)) {
                names.defined += 1;
                names.by_number |= matches!(entity.name(), Some(BlockName::Number(..)));
                names.by_symbol |= matches!(entity.name(), Some(BlockName::Symbol(_)));
            }
        }
        names
    }

    /// Whether the program, if it is whole, contains the callee under this very name.
    fn would_have(&self, callee: &Callee) -> bool {
        match callee {
            Callee::Subroutine(_) => true,
            Callee::Block(BlockName::Number(BlockKind::Fb | BlockKind::Fc, _)) => !self.by_symbol,
            Callee::Block(BlockName::Symbol(_)) => !self.by_number,
            _ => false,
        }
    }
}
