//! B012: a parameter that the called block does not have, does not get, or gets in another type.

use rustc_hash::FxHashSet;

use crate::analysis::Site;
use crate::analysis::parameters::{accepts, described, fits};
use crate::analysis::program::{GlobalCall, ProgramIndex};
use crate::lint::nearest::nearest;
use crate::lint::{ProgramCx, Sink};
use crate::model::entity::{BlockKind, BlockName};
use crate::model::layout::{Elementary, Field};
use crate::model::object::step7::field;
use crate::model::object::{Area, Class, Object};
use crate::model::symbols::key;
use crate::model::unit::{Argument, Passed, Section};
use crate::syntax::Language;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let program = cx.program;
    for call in program.calls.iter().filter(|it| it.it.full) {
        let Some(target) = call.target else { continue };
        let facts = program.units[target as usize];
        let kind = facts.entity.block_kind();
        let Some(declared) = facts.declared.as_deref().filter(|_| !facts.has_gaps && !facts.is_fragment) else {
            continue;
        };
        if matches!(kind, Some(BlockKind::Fb | BlockKind::Fc)) {
            let parameters = declared.fields().iter();
            let parameters: Vec<&Field> =
                parameters.filter(|it| !matches!(it.section, Section::Static | Section::Temp)).collect();
            judge(program, call, target, &parameters, sink);
        }
    }
    if program.units.iter().any(|it| it.language == Language::SymbolTable) && !program.partial {
        unknown_symbols(program, sink);
    }
}

fn judge(
    program: &ProgramIndex<'_>,
    call: &GlobalCall<'_>,
    target: u32,
    parameters: &[&Field],
    sink: &mut Sink<'_, Site>,
) {
    let callee = &call.it.text;
    let place = |it: &Field| Site { unit: target, anchor: it.anchor };
    let site = |it: &Argument| Site { unit: call.unit, anchor: it.anchor };
    let mut given = FxHashSet::default();
    for argument in &call.it.arguments {
        let Some(name) = &argument.name else { continue };
        let Some(formal) = parameters.iter().find(|it| it.name == name.to_lowercase()) else {
            let finding = sink.report(site(argument), format!("`{callee}` has no parameter `{name}`"));
            let finding = finding.related(ProgramIndex::heading(target), "the called block");
            if let Some(meant) = nearest(name, parameters.iter().map(|it| it.name.as_str())) {
                finding.note(format!("a parameter of a similar name is `{meant}`"));
            }
            continue;
        };
        if !given.insert(&formal.name) {
            sink.report(site(argument), format!("the parameter `{name}` of `{callee}` is given twice"));
        } else if let Some(flaw) = flaw(program, call, formal, argument) {
            sink.report(site(argument), format!("the parameter `{name}` of `{callee}` {flaw}"))
                .related(place(formal), "declared here");
        }
    }
    // Of a function block, the instance keeps the value of the last call.
    if program.entity(target).block_kind() != Some(BlockKind::Fc) {
        return;
    }
    let mut missing = parameters.iter().filter(|it| !given.contains(&it.name));
    if let Some(first) = missing.next() {
        let others: Vec<String> = missing.map(|it| format!(", `{}`", it.name)).collect();
        let message = format!("this call of `{callee}` gives nothing to `{}`{}", first.name, others.concat());
        sink.report(call.site(), message).related(place(first), "declared here");
    }
}

/// What is wrong with what a parameter is given, as the end of a sentence.
fn flaw(program: &ProgramIndex<'_>, call: &GlobalCall<'_>, formal: &Field, argument: &Argument) -> Option<String> {
    let takes = formal.ty.elementary().filter(|it| !matches!(it, Elementary::Any | Elementary::Pointer));
    match argument.given {
        Passed::Constant(_) if matches!(formal.section, Section::Output | Section::InOut) && takes.is_some() => {
            Some(format!("takes a place to write to, and `{}` is a constant", argument.text))
        }
        Passed::Constant(Some(ty)) => {
            // TIA Portal writes FALSE and TRUE so.
            let is_truth = matches!(argument.text.as_str(), "0" | "1");
            let takes = takes.filter(|it| !(accepts(*it, ty) || is_truth && *it == Elementary::Bool))?;
            Some(format!("is {}, and `{}` is {}", takes.name(), argument.text, ty.name()))
        }
        Passed::Object(id) => {
            let object = &program.units.get(call.unit as usize)?.objects.get(id.0 as usize)?.object;
            let takes = takes.filter(|it| !fits(*it, object))?;
            Some(format!("is {}, and `{}` is {}", takes.name(), argument.text, described(object)))
        }
        Passed::Constant(None) | Passed::Other => None,
    }
}

/// The last of the Latin letters, some of which every code page has.
const LAST_LATIN: char = '\u{24F}';

/// Symbols in quotes that no row of the program's table has: the first use of each.
fn unknown_symbols(program: &ProgramIndex<'_>, sink: &mut Sink<'_, Site>) {
    let declared = program.units.iter().flat_map(|it| &it.symbols).map(|it| key(&it.name));
    let declared: FxHashSet<_> = declared.collect();
    // A table with no letter of the alphabet that a symbol is in was read in another encoding than its own.
    let is_foreign = |it: &str| it.chars().any(|it| it > LAST_LATIN && it.is_alphabetic());
    let reads_foreign = declared.iter().any(|it| is_foreign(it));
    // A data block that is missing is a matter of blocks.
    let data_block = |it: &'_ Object| match &it.footprint.area {
        Area::Data(BlockName::Symbol(name)) => Some(name.clone()),
        _ => match field(it)?.0 {
            BlockName::Symbol(name) => Some(name),
            BlockName::Number(..) => None,
        },
    };
    let blocks: FxHashSet<_> = program.places(|_| true).filter_map(data_block).collect();
    for it in program.objects_that(|it| it == Class::Symbol, |_| true) {
        let quoted = it.object.text.starts_with('"');
        let Area::Symbol(name) = &it.object.footprint.area else { continue };
        // Of one with two addresses, rule N001 tells.
        let is_judged = (reads_foreign || !is_foreign(name)) && !blocks.contains(name);
        if quoted && it.object.class == Class::Symbol && !declared.contains(name) && is_judged {
            let mut uses = it.uses.iter();
            let Some(first) = uses.next() else { continue };
            sink.report(first.site(), format!("`{}` is not in the symbol table", it.object.text))
                .related_all(uses.map(|it| (it.site(), "also used here".to_owned())));
        }
    }
}
