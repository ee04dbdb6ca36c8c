//! B005: data addressed beyond its block, or across the fields that the block declares.

use crate::analysis::Site;
use crate::analysis::program::ProgramIndex;
use crate::lint::{ProgramCx, Sink};
use crate::model::entity::{BlockKind, BlockName};
use crate::model::layout::{Layout, Place};
use crate::model::object::{Area, Class, Footprint, step7};

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let program = cx.program;
    for it in &program.objects {
        let Area::Data(block) = &it.object.footprint.area else { continue };
        let by_address = it.uses.iter().filter(|it| step7::is_data_address(program.text_of(it)));
        let mut sites = by_address.map(|it| (it.site(), program.text_of(it)));
        if let Some((first, text)) = sites.next().filter(|_| it.object.is_fixed()) {
            let others: Vec<Site> = sites.map(|it| it.0).collect();
            judge(program, block, (&it.object.footprint, text), first, &others, sink);
        }
    }
    // A function block's own instance, whichever that is.
    for (unit, facts) in program.judged_units() {
        let own = facts.entity.name().filter(|_| facts.entity.block_kind() == Some(BlockKind::Fb));
        let Some(own) = own.filter(|_| !facts.opens_instance) else { continue };
        for (at, fact) in (0..).zip(&facts.objects) {
            let is_address = fact.object.class == Class::InstanceData && fact.object.is_fixed();
            let mut uses = facts.uses.iter().filter(|it| it.object == at).map(|it| Site { unit, anchor: it.anchor });
            if let Some(first) = uses.next().filter(|_| is_address && step7::is_data_address(&fact.object.text)) {
                let others: Vec<Site> = uses.collect();
                judge(program, own, (&fact.object.footprint, &fact.object.text), first, &others, sink);
            }
        }
    }
}

fn judge(
    program: &ProgramIndex<'_>,
    block: &BlockName,
    (access, text): (&Footprint, &str),
    site: Site,
    others: &[Site],
    sink: &mut Sink<'_, Site>,
) {
    let Some(layout) = program.layouts().of(block) else { return };
    let Some((message, field)) = flaw(layout, block, access, text) else { return };
    let declared =
        field.and_then(|it| Some((program.declaration(block, &it)?, format!("`{}` is declared here", it.path))));
    let declared =
        declared.or_else(|| Some((ProgramIndex::heading(program.unit_named(block)?), "the block".to_owned())));
    sink.report(site, message)
        .related_all(declared)
        .related_all(others.iter().map(|it| (*it, "also used here".to_owned())));
}

/// What is wrong with an address, and the field that it cuts.
fn flaw(layout: &Layout, block: &BlockName, access: &Footprint, text: &str) -> Option<(String, Option<Place>)> {
    if let Some(bits) = layout.bits.filter(|it| access.end() > *it) {
        let message = match bits {
            0 => format!("`{text}` lies in `{block}`, which declares nothing"),
            _ => format!("`{text}` lies behind the end of `{block}`, whose last byte is {}", bits / 8 - 1),
        };
        return Some((message, None));
    }
    let last = access.end() - 1;
    let (first, behind) = (layout.at(access.start), layout.at(last));
    let within = |it: &Place| it.start <= access.start && access.end() <= it.start + it.bits;
    match (&first, &behind) {
        // Bits that nothing declares; where a type is not known, the fields behind it have no place.
        (None, None) if layout.bits.is_some() && access.bits == 1 => {
            Some((format!("`{text}` lies in no field of `{block}`"), None))
        }
        (Some(it), _) if within(it) => {
            // Halves of a number are what parts of it are meant to be: not the two bytes in its middle.
            let is_off =
                access.bits == 16 && it.bits == 32 && it.ty.is_some() && !(access.start - it.start).is_multiple_of(16);
            is_off.then(|| {
                (format!("`{text}` is the middle of `{}`, which has {} bits", it.path, it.bits), first.clone())
            })
        }
        _ => {
            let cut = |it: &&Place| it.bits > 8 && (it.start < access.start || it.start + it.bits > access.end());
            let it = first.as_ref().filter(cut).or_else(|| behind.as_ref().filter(cut))?;
            let other = if first.as_ref() == Some(it) { &behind } else { &first };
            let part = match other {
                Some(other) if other.path != it.path => format!("parts of `{}` and `{}`", it.path, other.path),
                _ => format!("part of `{}` and what lies beside it", it.path),
            };
            Some((format!("`{text}` holds {part}"), Some(it.clone())))
        }
    }
}
