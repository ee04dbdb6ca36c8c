//! J008: a call of a subroutine or block that the program does not contain.

use rustc_hash::{FxHashMap, FxHashSet};

use crate::analysis::Site;
use crate::analysis::program::{GlobalCall, ProgramIndex};
use crate::lint::{ProgramCx, Sink};
use crate::model::entity::{BlockKind, BlockName, Family};
use crate::model::unit::Callee;
use crate::target::step5;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    if !cx.program.has_main() || cx.program.partial {
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
    family: Family,
    defined: usize,
    /// Blocks whose instance data is there: they were there when it was made.
    instances: FxHashSet<BlockName>,
    by_number: bool,
    by_symbol: bool,
}

impl Names {
    fn new(program: &ProgramIndex<'_>) -> Self {
        let mut names = Self {
            family: program.family,
            defined: 0,
            instances: FxHashSet::default(),
            by_number: false,
            by_symbol: false,
        };
        for facts in &program.units {
            let entity = &facts.entity;
            names.instances.extend(facts.instance_of.clone());
            if entity.subroutine().is_some() || entity.block_kind().is_some_and(BlockKind::is_callable) {
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
            Callee::Block(name) if self.instances.contains(name) => false,
            Callee::Block(name) if self.family == Family::Step5 && step5::is_function(name) => false,
            Callee::Block(BlockName::Number(kind, _)) if kind.is_callable() => !self.by_symbol,
            Callee::Block(BlockName::Symbol(_)) => !self.by_number,
            _ => false,
        }
    }
}
