//! What a run of a unit can pass by: writes that leave an object as it was, edge tests and blocks that a jump skips.

use rustc_hash::FxHashMap;

use super::conditions::{Space, Verdict};
use crate::model::UnitModel;
use crate::model::expr::{ExprId, Exprs};
use crate::model::unit::{Access, Mode, Statement, StatementKind};

/// More writes of one object than this are not compared with one another: what they leave out is not known.
const MAX_WRITES: usize = 32;

/// Runs of a unit in which it writes an object, or drives a block.
#[derive(Debug)]
pub struct Writes {
    /// Of each place, the conditions that hold together when it is executed.
    places: Vec<[ExprId; 2]>,
    /// Some place lies in a loop, or there are too many: they are not looked into.
    is_open: bool,
}

impl Writes {
    /// Whether some run of the unit, in which the condition holds and none of the exits is taken, passes all places by
    /// for certain.
    pub fn leave_out(&self, space: Space<'_>, given: ExprId, exits: &[[ExprId; 2]]) -> bool {
        if self.is_open {
            return false;
        }
        let places: Vec<[ExprId; 2]> = self.places.iter().chain(exits).copied().collect();
        space.without(&[given], &places) == Verdict::Possible
    }

    /// The condition of the first place.
    pub fn first(&self) -> ExprId {
        self.places.first().map_or(Exprs::TRUE, |it| it[0])
    }
}

/// Whether a place gives an object a value, or evaluates an input of a block, whenever it is reached.
fn is_given(mode: Mode) -> bool {
    mode.assigns() || mode == Mode::Store || matches!(mode, Mode::Drive(_))
}

/// The writes of each object that the unit writes, and may not write in every run.
pub fn writes(model: &UnitModel) -> FxHashMap<u32, Writes> {
    let mut found: FxHashMap<u32, Writes> = FxHashMap::default();
    let when = |access: &Access| match model.statement(access).map(|it| &it.kind) {
        Some(StatementKind::Call(call)) => model.calls.get(*call as usize).map_or(Exprs::TRUE, |it| it.when),
        _ => Exprs::TRUE,
    };
    // Most objects are written in every run.
    let mut is_sure = vec![false; model.objects.len()];
    for access in model.accesses.iter().filter(|it| is_given(it.mode) && it.path == Exprs::TRUE) {
        is_sure[access.object.0 as usize] |= when(access) == Exprs::TRUE;
    }
    for access in model.accesses.iter().filter(|it| is_given(it.mode) && it.path != Exprs::FALSE) {
        if is_sure[access.object.0 as usize] || !model.object(access.object).is_fixed() {
            continue;
        }
        let (statement, when) = (model.statement(access), when(access));
        let writes = found.entry(access.object.0).or_insert_with(|| Writes { places: Vec::new(), is_open: false });
        writes.is_open |= statement.is_some_and(|it| it.in_loop.is_some()) || writes.places.len() >= MAX_WRITES;
        if !writes.is_open {
            writes.places.push([access.path, when]);
        }
    }
    found
}

/// Conditions under which a run ends early, goes back, or jumps to a label that is not there: what it passes by then is
/// not left out by an `IF` or a jump past it.
pub fn exits(model: &UnitModel) -> Vec<[ExprId; 2]> {
    let exit = |statement: &Statement| match statement.kind {
        StatementKind::Return { when, .. } => Some([statement.path, when]),
        StatementKind::Halt => Some([statement.path, Exprs::TRUE]),
        // Outside of a loop it leaves nothing.
        StatementKind::Exit if statement.in_loop.is_none() => Some([statement.path, Exprs::TRUE]),
        StatementKind::Jump(jump) => {
            let jump = model.jumps.get(jump as usize)?;
            let target = jump.target.and_then(|it| model.labels.get(it as usize));
            let is_forward = target.is_some_and(|it| it.statement > jump.statement);
            (!is_forward).then_some([statement.path, jump.when])
        }
        _ => None,
    };
    // The end of the last part is no early one.
    let ends = |it: &&Statement| matches!(it.kind, StatementKind::Return { when: Exprs::TRUE, .. });
    let last = model.statements.len() - usize::from(model.statements.last().as_ref().is_some_and(ends));
    model.statements.iter().take(last).filter_map(exit).take(MAX_WRITES).collect()
}

/// For each statement, the jump that can skip it: the one before it that leads furthest. An index into the jumps.
pub fn skips(model: &UnitModel) -> Vec<Option<u32>> {
    if model.jumps.is_empty() {
        return Vec::new();
    }
    let mut skips = vec![None; model.statements.len()];
    // Jumps stand in the order of their statements.
    let mut jumps = (0..).zip(&model.jumps).peekable();
    let mut furthest: Option<(u32, u32)> = None;
    for (at, skip) in (0..).zip(&mut skips) {
        while let Some((index, jump)) = jumps.next_if(|it| it.1.statement < at) {
            let end = jump.target.and_then(|it| model.labels.get(it as usize)).map_or(0, |it| it.statement);
            let reached = model.statements.get(jump.statement as usize).is_some_and(|it| it.path != Exprs::FALSE);
            if reached && jump.when != Exprs::FALSE && furthest.is_none_or(|it| it.1 <= at || it.1 < end) {
                furthest = Some((index, end));
            }
        }
        *skip = furthest.filter(|it| it.1 > at).map(|it| it.0);
    }
    skips
}

/// The jump that can skip an access, an index into the jumps.
pub fn skip(skips: &[Option<u32>], access: &Access) -> Option<u32> {
    let is_reached = access.path != Exprs::TRUE && access.path != Exprs::FALSE;
    skips.get(access.statement as usize).copied().flatten().filter(|_| is_reached)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::entity::Entity;
    use crate::model::lower;
    use crate::syntax::{self, Language, Mnemonics};

    fn model(language: Language, text: &str) -> UnitModel {
        let parse = syntax::parse(language, text);
        assert_eq!(parse.errors(), [], "{text}");
        lower::lower(parse.syntax(), text, Entity::Listing, language)
    }

    /// Objects that some run of the unit leaves as they are.
    fn left_out(language: Language, text: &str) -> Vec<String> {
        let model = model(language, text);
        let (writes, exits) = (writes(&model), exits(&model));
        let is_left = |at: &u32| writes.get(at).is_some_and(|it| it.leave_out(Space::of(&model), Exprs::TRUE, &exits));
        let objects = (0..).zip(&model.objects).filter(|it| is_left(&it.0));
        objects.map(|it| it.1.text.to_string()).collect()
    }

    fn skipped(text: &str) -> Vec<String> {
        let model = model(Language::Awl(Mnemonics::German), text);
        let skips = skips(&model);
        let accesses = model.accesses.iter().filter(|it| it.mode == Mode::Assign);
        let by = |it: &Access| Some(model.jumps[skip(&skips, it)? as usize].text.to_string());
        accesses.filter_map(|it| Some(format!("{} by {}", model.object(it.object).text, by(it)?))).collect()
    }

    #[test]
    fn what_no_run_leaves_out() {
        let st = |text| left_out(Language::Pl7St, text);
        assert_eq!(st("! IF %M0 THEN %M5 := %M1; END_IF;"), ["%M5"]);
        assert_eq!(st("! IF %M0 THEN %M5 := %M1; ELSIF %M2 THEN %M5 := %M3; ELSE %M5 := %M4; END_IF;"), [""; 0]);
        assert_eq!(st("! IF %M0 THEN %M5 := %M1; ELSIF %M2 THEN %M5 := %M3; END_IF;"), ["%M5"]);
        assert_eq!(st("! IF %M0 THEN %M5 := %M1; END_IF; IF NOT %M0 THEN %M5 := %M2; END_IF;"), [""; 0]);
        // Between the two the bit has another value.
        assert_eq!(st("! IF %M0 THEN %M5 := %M1; END_IF; %M0 := %M7; IF NOT %M0 THEN %M5 := %M2; END_IF;"), ["%M5"]);
        assert_eq!(st("! IF %MW0 < 5 THEN %M5 := %M1; END_IF; IF %MW0 >= 3 THEN %M5 := %M2; END_IF;"), [""; 0]);
        assert_eq!(st("! FOR %MW0 := 0 TO 3 DO %M5 := %M1; END_FOR;"), [""; 0], "loops are not looked into");
        assert_eq!(st("! IF %M0 THEN RETURN; END_IF; %M5 := %M1;"), [""; 0], "an end is no gap");
        assert_eq!(st("! IF %M0 THEN RETURN; END_IF; IF %M1 THEN %M5 := %M2; END_IF;"), ["%M5"]);
    }

    #[test]
    fn a_loop_by_a_jump_is_no_gap() {
        let awl = |text| left_out(Language::Awl(Mnemonics::German), text);
        assert_eq!(awl("A1: U E0.0\n= M0.0\nU E0.1\nSPB A1\nU E0.2\n= A4.0"), [""; 0]);
        assert_eq!(awl("U E0.1\nSPB A1\nU E0.2\n= A4.0\nA1: U E0.3\n= A4.1"), ["A4.0"]);
    }

    #[test]
    fn the_jump_that_leads_furthest_skips() {
        let text = "U E0.0\nSPB A1\nU E0.1\nSPB A2\nU E1.0\n= M0.0\nA1: U E1.1\n= M0.1\nA2: U E1.2\n= M0.2";
        assert_eq!(skipped(text), ["M0.0 by A2", "M0.1 by A2"]);
        assert_eq!(skipped("U E0.0\nSPB A1\nA1: U E1.0\n= M0.0"), [""; 0]);
        assert_eq!(skipped("A1: U E1.0\n= M0.0\nU E0.0\nSPB A1\nU E1.1\n= M0.1"), [""; 0], "a jump back");
    }
}
