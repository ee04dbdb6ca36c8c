//! W005: an object that code of two tasks writes.

use rustc_hash::FxHashSet;

use crate::analysis::Site;
use crate::analysis::drives;
use crate::analysis::program::{GlobalUse, ProgramIndex};
use crate::lint::{ProgramCx, Sink};
use crate::model::object::{Area, Class, Object};
use crate::model::unit::{Mode, Pin};

/// Of more writing places of one object, only so many are compared.
const MAX_COMPARED: usize = 256;

pub(crate) fn check(cx: &ProgramCx<'_>, sink: &mut Sink<'_, Site>) {
    let program = cx.program;
    let tasks: FxHashSet<_> = (0..).zip(&program.units).flat_map(|(unit, _)| program.tasks(unit)).collect();
    if tasks.len() < 2 {
        return;
    }
    for uses in program.objects.iter().filter(|it| it.is_written() && is_the_programs(it.object)) {
        let mut writes: Vec<GlobalUse<'_>> = uses.uses.iter().filter(|it| gives(it)).copied().collect();
        if writes.len() < 2 {
            continue;
        }
        drives::in_order(program, &mut writes);
        let interrupts = |a: &GlobalUse<'_>, b: &GlobalUse<'_>| {
            program.in_other_tasks(a.unit, b.unit) && (!is_drive(a.mode) || a.mode == b.mode) && disturb(program, a, b)
        };
        let compared = &writes[..writes.len().min(MAX_COMPARED)];
        let pair = (1..compared.len())
            .find_map(|at| Some((compared[..at].iter().find(|it| interrupts(it, &compared[at]))?, compared[at])));
        let Some((first, second)) = pair else { continue };
        let tasks = (program.task_names(first.unit), program.task_names(second.unit));
        let label = |it: &GlobalUse<'_>| match program.task_names(it.unit) {
            task if task.is_empty() => format!("{} here", it.mode.verb()),
            task => format!("{} in {task} here", it.mode.verb()),
        };
        let others = writes.iter().filter(|it| it.site() != second.site());
        sink.report(second.site(), format!("`{}` is written in {} and in {}", uses.object.text, tasks.0, tasks.1))
            .label(label(&second))
            .related_all(others.map(|it| (it.site(), label(it))));
    }
}

/// Objects whose value is the program's alone, at a place that is the same in every unit.
fn is_the_programs(object: &Object) -> bool {
    let class = matches!(
        object.class,
        Class::Output
            | Class::PeripheralOutput
            | Class::Memory
            | Class::Symbol
            | Class::Data
            | Class::ModuleWord
            | Class::NetworkWord
            | Class::Block
            | Class::BlockWord
            | Class::Timer
            | Class::Counter
    );
    class && object.is_fixed() && object.footprint.area != Area::OpenData
}

/// Whether a place gives the object a value of its own, or drives an input of it. Set and reset hand something over in one
/// step, as a task does that takes note of what another told it.
fn gives(it: &GlobalUse<'_>) -> bool {
    let gives = match it.mode {
        Mode::Assign | Mode::AssignNot | Mode::Store | Mode::Output => true,
        Mode::Drive(pin) => !matches!(pin, Pin::Reset | Pin::Enable),
        _ => false,
    };
    gives && !it.it.own
}

/// Whether one of two writes undoes the other. A constant hands something over, too, unless one of the two is written in each
/// scan, or the other is made of the object's own value, so that a constant which comes in between is lost.
fn disturb(program: &ProgramIndex<'_>, a: &GlobalUse<'_>, b: &GlobalUse<'_>) -> bool {
    let is_constant = |it: &GlobalUse<'_>| it.it.constant().is_some() && !is_drive(it.mode);
    let in_each_scan =
        |it: &GlobalUse<'_>| !it.it.conditional && program.sure.get(it.unit as usize).is_some_and(|it| *it);
    match (is_constant(a), is_constant(b)) {
        (false, false) => true,
        (true, true) => false,
        (one, _) => in_each_scan(a) || in_each_scan(b) || if one { b.it.holds } else { a.it.holds },
    }
}

fn is_drive(mode: Mode) -> bool {
    matches!(mode, Mode::Drive(_))
}
