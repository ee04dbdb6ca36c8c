//! O007: memory that is read and never written, or written and never read.

use crate::analysis::Site;
use crate::analysis::program::{GlobalUse, ObjectUses};
use crate::lint::{ProgramCx, Severity, Sink};
use crate::model::object::{Area, Class};
use crate::model::unit::Mode;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let program = cx.program;
    let configured = Configured::new(cx);
    // A place computed at run time, or a symbol that nothing resolves, may be the missing use.
    let given = bytes_given(cx);
    let mut unwritten = one_sided(cx, |it| it.is_read(), |it| it.is_written());
    unwritten.retain(|&it| {
        let (uses, unseen) = (&program.objects[it as usize], program.unseen(&program.objects[it as usize]));
        !configured.writes(uses)
            && !given.iter().any(|byte| covers(*byte, uses))
            && unseen.is_complete()
            && !unseen.has_unresolved(Mode::writes)
            && !unseen.is_written()
    });
    for group in unwritten.chunk_by(|&a, &b| same_byte(cx, a, b)) {
        let others = if program.family.has_blocks() {
            "no operator panel, other station or clock byte of the CPU"
        } else {
            "no operator panel or other station"
        };
        report(cx, group, "read", "written", sink).note(format!("this assumes that {others} writes it"));
    }
    // An output that nobody wants has to go somewhere: what only takes such outputs is a waste basket.
    let is_given = |it: &ObjectUses<'_>| it.with_mode(|it| it.writes() && it != Mode::Output).next().is_some();
    let mut unread = one_sided(cx, is_given, |it| it.is_read() || configured.reads(it));
    unread.retain(|&it| {
        let unseen = program.unseen(&program.objects[it as usize]);
        unseen.is_complete() && !unseen.has_unresolved(Mode::reads) && !unseen.is_read()
    });
    for group in unread.chunk_by(|&a, &b| same_byte(cx, a, b)) {
        report(cx, group, "written", "read", sink)
            .severity(Severity::Advice)
            .note("this assumes that no operator panel or other station reads it");
    }
}

/// What blocks do with memory that their configuration names and the program does not: a drum writes its order bits
/// (PL72:895), a text block of PL7-2 receives into one table of words and sends another (PL72:1186-1188).
struct Configured {
    drum: bool,
    text: bool,
}

impl Configured {
    fn new(cx: &ProgramCx<'_>) -> Self {
        let has = |symbols: &[&str]| {
            cx.program.objects.iter().any(|it| match it.object.footprint.area {
                Area::Block(symbol, _) => symbols.contains(&symbol),
                _ => false,
            })
        };
        Self { drum: has(&["DR", "D"]), text: has(&["TXT"]) }
    }

    fn writes(&self, it: &ObjectUses<'_>) -> bool {
        match it.object.footprint.area {
            Area::Bits => self.drum,
            Area::Words => self.text,
            _ => false,
        }
    }

    fn reads(&self, it: &ObjectUses<'_>) -> bool {
        self.text && it.object.footprint.area == Area::Words
    }
}

/// Memory that has the one kind of use, while neither it nor any address that shares its memory has the other.
fn one_sided(
    cx: &ProgramCx<'_>,
    has: impl Fn(&ObjectUses<'_>) -> bool,
    lacks: impl Fn(&ObjectUses<'_>) -> bool,
) -> Vec<u32> {
    let objects = &cx.program.objects;
    let around = |at: u32| cx.neighbours(at).iter().map(|&it| &objects[it as usize]);
    let all = (0..).zip(objects);
    let found = all.filter(|&(at, it)| {
        let memory = it.object.class == Class::Memory && it.object.is_fixed();
        memory && has(it) && !lacks(it) && !around(at).any(&lacks)
    });
    found.map(|it| it.0).collect()
}

/// Whether two objects lie in one byte or word: they go together, and are missed together.
fn same_byte(cx: &ProgramCx<'_>, a: u32, b: u32) -> bool {
    let (a, b) = (&cx.program.objects[a as usize].object.footprint, &cx.program.objects[b as usize].object.footprint);
    a.overlaps(b) || (a.area == Area::Words && a.area == b.area && a.start / 8 == b.start / 8)
}

fn report<'s>(
    cx: &ProgramCx<'_>,
    group: &[u32],
    done: &str,
    missing: &str,
    sink: &'s mut Sink<'_, Site>,
) -> crate::lint::Reported<'s, Site> {
    let mut uses: Vec<(&ObjectUses<'_>, GlobalUse<'_>)> = Vec::new();
    for &member in group {
        let object = &cx.program.objects[member as usize];
        uses.extend(object.uses.iter().map(|it| (object, *it)));
    }
    uses.sort_by_key(|(_, it)| (cx.program.order[it.unit as usize], it.it.anchor));
    let (object, first) = uses[0];
    let others = uses[1..]
        .iter()
        .map(|(object, it)| (it.site(), format!("`{}` is {} here", object.object.text, it.mode.verb())));
    sink.report(first.site(), format!("`{}` is {done} and never {missing}", object.object.text)).related_all(others)
}

/// Bytes of M that the CPU writes by itself, by the option `clock-bytes`.
fn bytes_given(cx: &ProgramCx<'_>) -> Vec<u32> {
    let option = cx.settings.options("read-never-written").and_then(|it| it.get("clock-bytes"));
    let bytes = option.and_then(|it| it.as_array()).into_iter().flatten();
    bytes.filter_map(|it| u32::try_from(it.as_integer()?).ok()).collect()
}

fn covers(byte: u32, uses: &ObjectUses<'_>) -> bool {
    let place = &uses.object.footprint;
    place.area == Area::Words && place.start / 8 <= byte && byte <= place.end().saturating_sub(1) / 8
}
