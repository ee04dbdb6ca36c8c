//! PL7 structured text to the model.

use crate::syntax::AstNode as _;
use rowan::TextRange;

use super::builder::index;
use super::chart;
use super::pl7::{self, Pl7};
use crate::model::UnitModel;
use crate::model::entity::Entity;
use crate::model::expr::{ExprId, Exprs};
use crate::model::object::Rights;
use crate::model::unit::{Counting, DeadCause, Fork, Hollow, HollowKind, Leave, Loop, LoopKind, StatementKind};
use crate::syntax::pl7::ast::{self, Stmt};
use crate::syntax::{Language, SyntaxElement, SyntaxKind, SyntaxNode, SyntaxToken};

pub(super) fn lower(root: SyntaxNode<'_>, text: &str, entity: Entity) -> UnitModel {
    let mut pl7 = Pl7::new(root, entity, Language::Pl7St);
    chart::enter_piece(&mut pl7);
    pl7.b.set_back_targets(pl7::back_targets(root, text, Language::Pl7St));
    let all = ast::Root::cast(root).into_iter().flat_map(ast::Root::sentences);
    sentences(pl7, all).0.b.finish()
}

/// Lowers sentences, and gives the lowering back with the value of the last one that is an expression.
pub(super) fn sentences<'t>(pl7: Pl7, sentences: impl IntoIterator<Item = ast::Sentence<'t>>) -> (Pl7, Option<ExprId>) {
    let mut lowering = Lowering { pl7, value: None };
    for sentence in sentences {
        lowering.pl7.b.next_network();
        for label in sentence.labels() {
            lowering.pl7.label(&label);
        }
        for statement in sentence.statements() {
            lowering.statement(&statement);
        }
    }
    (lowering.pl7, lowering.value)
}

struct Lowering {
    pl7: Pl7,
    /// Of an expression that stands alone, as a receptivity does.
    value: Option<ExprId>,
}

impl Lowering {
    fn list(&mut self, list: Option<ast::StmtList>) {
        for statement in list.into_iter().flat_map(|it| it.statements()) {
            self.statement(&statement);
        }
    }

    fn statement(&mut self, statement: &Stmt) {
        let range = statement.syntax().text_range();
        if !matches!(statement, Stmt::Empty(_)) {
            self.pl7.b.instruction(range);
        }
        match statement {
            Stmt::Assign(it) => self.pl7.assignment(it),
            Stmt::Call(it) => self.pl7.call_stmt(it),
            Stmt::If(it) => self.if_statement(it),
            Stmt::While(it) => self.while_statement(it),
            Stmt::Repeat(it) => self.repeat_statement(it),
            Stmt::For(it) => self.for_statement(it),
            Stmt::Exit(_) => {
                self.pl7.b.statement(StatementKind::Exit, range);
                self.pl7.b.mark_exit();
                self.pl7.b.leave(Exprs::TRUE, DeadCause::Jump, range);
            }
            Stmt::Jump(it) => {
                if let Some(label) = it.label() {
                    self.pl7.jump(label.text(), label.text_range(), Exprs::TRUE, range);
                } else if let Some(name) = it.name().and_then(|it| it.name()) {
                    self.pl7.jump(name.text(), name.text_range(), Exprs::TRUE, range);
                }
            }
            Stmt::Return(_) => self.pl7.leave(Exprs::TRUE, Leave::Subroutine, range),
            Stmt::Halt(_) => self.pl7.halt(Exprs::TRUE, range),
            Stmt::Empty(_) => {}
            Stmt::Expr(it) => {
                if let Some(expr) = it.expr() {
                    self.value = Some(self.pl7.expr(&expr).0);
                }
            }
        }
    }

    /// Evaluates a condition under the current path, and notes that the program branches on it.
    fn condition(&mut self, condition: Option<ast::Expr>, of: Fork) -> (ExprId, TextRange) {
        match condition {
            Some(it) => {
                let range = it.syntax().text_range();
                let (value, _) = self.pl7.expr(&it);
                self.pl7.b.statement(StatementKind::Branch { condition: value, of }, range);
                (value, range)
            }
            None => (self.pl7.b.exprs().opaque(), TextRange::default()),
        }
    }

    /// The conditions are evaluated one after the other, until one holds; then its arm is run. No arm is run before a
    /// condition is evaluated, so all conditions come first.
    fn if_statement(&mut self, it: &ast::IfStmt) {
        let mut open = self.pl7.b.path();
        let (mut arms, mut after, mut cut) = (Vec::new(), None, None);
        for arm in it.arms() {
            let (condition, at) = self.condition(arm.condition(), Fork::Arm { after });
            after = self.pl7.b.model.statements.len().checked_sub(1).map(index).filter(|_| arm.condition().is_some());
            if open != Exprs::FALSE {
                cut = Some((DeadCause::FalseCondition, at));
            }
            let taken = self.pl7.b.exprs().and(open, condition);
            let not = self.pl7.b.exprs().not(condition);
            open = self.pl7.b.exprs().and(open, not);
            self.pl7.b.enter(open, cut);
            arms.push((arm, taken, cut));
        }
        let mut ends = Vec::with_capacity(arms.len());
        for (arm, taken, cut) in arms {
            self.pl7.b.enter(taken, cut);
            self.hollow(HollowKind::Branch, arm.syntax(), arm.body());
            self.list(arm.body());
            ends.push(self.pl7.b.path());
        }
        self.pl7.b.enter(open, cut);
        if let Some(arm) = it.else_arm() {
            self.hollow(HollowKind::Branch, arm.syntax(), arm.body());
            self.list(arm.body());
            open = self.pl7.b.path();
        }
        // From the last arm to the first, so that the parts of a split path meet again one by one.
        for end in ends.into_iter().rev() {
            open = self.pl7.b.exprs().or(end, open);
        }
        self.pl7.b.enter(open, None);
    }

    fn open_loop(&mut self, kind: LoopKind, keyword: TextRange) -> u32 {
        let first = index(self.pl7.b.model.statements.len());
        let anchor = self.pl7.b.anchor(keyword);
        self.pl7.b.open_loop(Loop {
            kind,
            keyword,
            anchor,
            counting: None,
            condition: None,
            condition_range: None,
            index: None,
            index_range: None,
            body: first..first,
            exits: false,
            parent: None,
        })
    }

    fn set_condition(&mut self, id: u32, condition: ExprId, at: TextRange) {
        if let Some(it) = self.pl7.b.model.loops.get_mut(id as usize) {
            it.condition = Some(condition);
            it.condition_range = Some(at);
        }
    }

    fn while_statement(&mut self, it: &ast::WhileStmt) {
        let before = self.pl7.b.path();
        let id = self.open_loop(LoopKind::While, keyword(it.syntax()));
        let (condition, at) = self.condition(it.condition(), Fork::Loop);
        self.set_condition(id, condition, at);
        let cut = (before != Exprs::FALSE).then_some((DeadCause::FalseCondition, at));
        let inside = self.pl7.b.exprs().and(before, condition);
        self.pl7.b.enter(inside, cut);
        self.list(it.body());
        self.pl7.b.close_loop();
        self.pl7.b.enter(before, None);
    }

    fn repeat_statement(&mut self, it: &ast::RepeatStmt) {
        let before = self.pl7.b.path();
        let id = self.open_loop(LoopKind::Repeat, keyword(it.syntax()));
        self.list(it.body());
        let after_body = self.pl7.b.path();
        self.pl7.b.enter(before, None);
        let (condition, at) = self.condition(it.condition(), Fork::Loop);
        self.set_condition(id, condition, at);
        self.pl7.b.close_loop();
        let exits = self.pl7.b.model.loops.get(id as usize).is_some_and(|it| it.exits);
        // A body that always jumps away or returns is left there, unless it is an EXIT that leaves it.
        let after = if exits || after_body != Exprs::FALSE { before } else { after_body };
        self.pl7.b.enter(after, None);
    }

    fn for_statement(&mut self, it: &ast::ForStmt) {
        let before = self.pl7.b.path();
        let start = it.start().map(|it| self.pl7.expr(&it));
        let end = it.end().map(|it| self.pl7.expr(&it));
        let place = it.index().and_then(|it| self.pl7.place(&it));
        if let Some((object, at)) = place {
            // Of an index that no program may write, rule T002 speaks: there is no write besides.
            if !matches!(self.pl7.b.model.object(object).rights, Rights::ReadOnly(_)) {
                let value = start.map_or_else(|| self.pl7.b.exprs().opaque(), |it| it.0);
                self.pl7.assign(object, value, pl7::Kind::Number, at, at);
            }
            self.pl7.read(object, at);
        }
        let id = self.open_loop(LoopKind::For, keyword(it.syntax()));
        if let (Some((object, at)), Some(it)) = (place, self.pl7.b.model.loops.get_mut(id as usize)) {
            it.index = Some(object);
            it.index_range = Some(at);
            it.counting = start.zip(end).map(|(first, last)| Counting::Up { first: first.0, last: last.0 });
        }
        // The body may not run at all.
        let runs = self.pl7.b.exprs().opaque();
        let inside = self.pl7.b.exprs().and(before, runs);
        self.pl7.b.enter(inside, None);
        self.hollow(HollowKind::Loop, it.syntax(), it.body());
        self.list(it.body());
        self.pl7.b.close_loop();
        self.pl7.b.enter(before, None);
    }

    /// Notes a body without a statement that does anything.
    fn hollow(&mut self, kind: HollowKind, node: SyntaxNode<'_>, body: Option<ast::StmtList<'_>>) {
        let is_remark = |it: SyntaxToken<'_>| it.kind() == SyntaxKind::Comment;
        let mut statements = body.into_iter().flat_map(|it| it.statements());
        let is_odd = |it: SyntaxElement<'_>| matches!(it.kind(), SyntaxKind::Error | SyntaxKind::Elision);
        if statements.all(|it| matches!(it, Stmt::Empty(_))) && !node.children_with_tokens().any(is_odd) {
            let range = keyword(node);
            if !node.descendant_tokens().any(is_remark) {
                self.pl7.b.model.hollows.push(Hollow { kind, range });
            }
        }
    }
}

/// Range of the keyword that a control structure starts with.
fn keyword(node: SyntaxNode<'_>) -> TextRange {
    let mut tokens = node.tokens();
    tokens.find(|it| !it.kind().is_trivia()).map_or_else(|| node.text_range(), |it| it.text_range())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::entity::{Part, Task};
    use crate::model::lower::testing::show;
    use crate::model::unit::{Callee, Mode, OddityKind};

    fn model(text: &str) -> UnitModel {
        let parse = crate::syntax::pl7::parse_st(text);
        assert_eq!(parse.errors(), [], "{text}");
        lower(parse.syntax(), text, Entity::Pl7 { task: Task::Mast, section: None, part: Part::Main })
    }

    /// What each statement does, with the path to it.
    fn statements(text: &str) -> Vec<String> {
        let model = model(text);
        let name = |access: u32| model.object(model.accesses[access as usize].object).text.to_string();
        let mut lines = Vec::new();
        for it in &model.statements {
            let what = match it.kind {
                StatementKind::Assign { access, value } | StatementKind::Store { access, value } => {
                    format!("{} := {}", name(access), show(&model, value))
                }
                StatementKind::Set { access, .. } => format!("set {}", name(access)),
                StatementKind::Reset { access, .. } => format!("reset {}", name(access)),
                StatementKind::Drive { access, pin, .. } => format!("{} of {}", pin.describe(), name(access)),
                StatementKind::Call(call) => format!("call {}", model.calls[call as usize].text),
                StatementKind::Jump(_) => "jump".to_owned(),
                StatementKind::Exit => "exit".to_owned(),
                StatementKind::Return { .. } => "return".to_owned(),
                _ => continue,
            };
            let path = show(&model, it.path);
            lines.push(if path == "true" { what } else { format!("{path}: {what}") });
        }
        lines
    }

    fn accesses(text: &str, wanted: impl Fn(Mode) -> bool) -> Vec<String> {
        let model = model(text);
        let accesses = model.accesses.iter().filter(|it| wanted(it.mode));
        accesses.map(|it| format!("{:?} {}", it.mode, model.object(it.object).text)).collect()
    }

    #[test]
    fn expressions_have_the_order_of_the_manual() {
        // PL7:4032, 4042, 4062.
        assert_eq!(
            statements("! %MW0 := NOT %MW3 * 25 AND %MW10 + %MW12;"),
            ["%MW0 := And(Mul(NOT(%MW3), 25), Add(%MW10, %MW12))"]
        );
        assert_eq!(statements("! %MW0 := %MW34 * 2 REM 6;"), ["%MW0 := Rem(Mul(%MW34, 2), 6)"]);
        assert_eq!(statements("! %MW0 := (%MW10+%MW11)*%MW12;"), ["%MW0 := Mul(Add(%MW10, %MW11), %MW12)"]);
        assert_eq!(statements("! %M0 := NOT %M1 AND %M2 OR RE %M3 XOR FALSE;"), ["%M0 := ((!%M1 & %M2) | ^%M3)"]);
        assert_eq!(
            statements("! %M0 := 1; %MW0 := -32768; %MF0 := -%MF2 * 1.5;"),
            ["%M0 := true", "%MW0 := -32768", "%MF0 := Mul(-%MF2, 1.5)"]
        );
    }

    #[test]
    fn arms_exclude_each_other_and_meet_again() {
        let code = "! IF %M0 THEN %M5 := %M10; ELSIF %M1 THEN SET %M6; ELSE RESET %M7; END_IF; %M8 := TRUE;";
        assert_eq!(
            statements(code),
            ["%M0: %M5 := %M10", "(!%M0 & %M1): set %M6", "(!%M0 & !%M1): reset %M7", "%M8 := true"]
        );
        assert_eq!(statements("! IF %M0 THEN RETURN; END_IF; %M8 := TRUE;"), ["%M0: return", "!%M0: %M8 := true"]);
        let both = model("! IF %M0 THEN RETURN; ELSE HALT; END_IF; %M8 := TRUE;");
        assert_eq!(both.unreachable.len(), 1);
        let never = model("! IF FALSE THEN %M8 := TRUE; END_IF; %M9 := TRUE;");
        let causes: Vec<DeadCause> = never.unreachable.iter().map(|it| it.cause).collect();
        assert_eq!(causes, [DeadCause::FalseCondition]);
    }

    #[test]
    fn listings_of_the_manual() {
        // PL7:3836-3844.
        let code = "! (*Action conditionnelle*) IF %M0 AND %M12 THEN RESET %M0; INC %MW4; %MW10:=%MW8+%MW9; END_IF;";
        assert_eq!(
            statements(code),
            ["(%M0 & %M12): reset %M0", "(%M0 & %M12): %MW4 := Add(%MW4, 1)", "(%M0 & %M12): %MW10 := Add(%MW8, %MW9)"]
        );
        // PL7:3853-3867: an arm of an ELSEIF has the negation of the one before.
        let code = "! IF %M0 AND %M1 THEN SET %M10; ELSEIF %M0 OR %M1 THEN SET %M11; ELSE RESET %M10; END_IF;";
        assert_eq!(
            statements(code),
            [
                "(%M0 & %M1): set %M10",
                "(!(%M0 & %M1) & (%M0 | %M1)): set %M11",
                "(!(%M0 & %M1) & !(%M0 | %M1)): reset %M10"
            ]
        );
        // PL7:3434-3450: both ways of the inner IF, one of which leaves the loop.
        let code = "! IF %M0 THEN FOR %MW99:=0 TO 31 DO IF %MW100[%MW99]<>0 THEN %MW10:=%MW100[%MW99]; %M1:=TRUE; EXIT; \
                    ELSE %M1:=FALSE; END_IF; END_FOR; ELSE %M1:=FALSE; END_IF;";
        let it = model(code);
        assert!(it.loops[0].exits && it.unreachable.is_empty());
        let writes = accesses(code, |it| it == Mode::Assign);
        assert_eq!(writes, ["Assign %M1", "Assign %M1", "Assign %M1"]);
        // PL7:3949: the misprint is read as what was meant.
        assert_eq!(model("! FOR %MW4=0 TO %MW23+12 DO SET %M25[%MW4]; END_FOR;").loops.len(), 1);
    }

    #[test]
    fn loops() {
        // PL7:3985-3999: the EXIT leaves the inner loop alone.
        let code = "! WHILE %MW1<124 DO %MW2:=0; REPEAT INC %MW2; IF %M0 THEN EXIT; END_IF; UNTIL %MW2>25 END_REPEAT; INC %MW1; END_WHILE;";
        let it = model(code);
        let loops: Vec<(LoopKind, bool, Option<u32>)> =
            it.loops.iter().map(|it| (it.kind, it.exits, it.parent)).collect();
        assert_eq!(loops, [(LoopKind::While, false, None), (LoopKind::Repeat, true, Some(0))]);
        assert!(it.unreachable.is_empty());
        let it = model("! FOR %MW4 := 0 TO %MW23+12 DO SET %M25[%MW4]; END_FOR; %M0 := TRUE;");
        let index = it.loops[0].index.map(|index| it.object(index).text.to_string());
        assert_eq!(index.as_deref(), Some("%MW4"));
        assert_eq!(it.statements.last().map(|it| it.path), Some(Exprs::TRUE), "the loop comes to an end");
        // Values that the loop may have changed are others behind it.
        let it = model("! %MW0 := %MW5; WHILE %M0 DO INC %MW5; END_WHILE; %MW1 := %MW5;");
        let versions: Vec<u32> =
            it.accesses.iter().filter(|a| it.object(a.object).text == "%MW5").map(|it| it.version).collect();
        assert!(versions.first() < versions.last());
        // An endless loop that only a RETURN leaves.
        let it = model("! WHILE TRUE DO IF %M0 THEN RETURN; END_IF; END_WHILE;");
        assert!(it.loops[0].exits);
    }

    #[test]
    fn an_index_that_cannot_be_written_is_not_written() {
        assert_eq!(accesses("! FOR %KW0 := 0 TO 5 DO ; END_FOR;", Mode::writes), [""; 0]);
        assert_eq!(accesses("! FOR %MW0 := 0 TO 5 DO ; END_FOR;", Mode::writes), ["Store %MW0"]);
    }

    #[test]
    fn jumps() {
        let it = model("! IF %M0 THEN JUMP %L5; END_IF; %M1 := TRUE; ! %L5: %M2 := TRUE;");
        assert_eq!(it.jumps[0].target, Some(0));
        assert_eq!(it.statements.last().map(|it| it.path), Some(Exprs::TRUE));
        assert!(it.loops.is_empty());
        let it = model("! %L5: INC %MW0; ! IF %M0 THEN JUMP %L5; END_IF;");
        assert_eq!(it.loops.iter().map(|it| it.kind).collect::<Vec<_>>(), [LoopKind::Jump]);
    }

    #[test]
    fn functions_write_what_they_write() {
        let writes = |text: &str| accesses(text, Mode::writes);
        assert_eq!(writes("! SORT_ARW(1, %MW0:10);"), ["InOut %MW0:10"]);
        assert_eq!(writes("! RRTC(%MW0:4);"), ["Output %MW0:4"]);
        assert_eq!(writes("! %MW0 := SQRT(%MW4);"), ["Store %MW0"]);
        // A function that has a value and is not known reads; arguments that the manual does not give may be written.
        assert_eq!(writes("! %MW0 := Unheard(%MW4);"), ["Store %MW0"]);
        assert_eq!(writes("! READ_VAR(%MW4, %KW5, %MW10:4);"), ["InOut %MW4", "InOut %MW10:4"]);
        assert_eq!(statements("! RESET %C8; START %TM1;"), ["reset of %C8", "start of %TM1"]);
    }

    #[test]
    fn instances_may_change_what_they_are_given() {
        let text = "! Pump(%I1.0, %M5); %M6 := Pump.Done; Pump(%I1.1, %M5); %M7 := Pump.Done;";
        assert_eq!(accesses(text, Mode::writes), ["InOut %M5", "Assign %M6", "InOut %M5", "Assign %M7"]);
        let it = model(text);
        assert!(it.calls.iter().all(|it| it.callee == Callee::Instance("pump".into())));
        let done: Vec<u32> =
            it.accesses.iter().filter(|a| it.object(a.object).text == "Pump.Done").map(|it| it.version).collect();
        assert!(done[0] < done[1], "the instance ran in between");
    }

    #[test]
    fn exposed_reads() {
        let exposed = |text: &str, name: &str| -> Vec<bool> {
            let it = model(text);
            let reads = it.accesses.iter().filter(|a| a.mode == Mode::Read && it.object(a.object).text == name);
            reads.map(|it| it.exposed).collect()
        };
        assert_eq!(exposed("! %M0 := %I1.0; %M1 := %M0;", "%M0"), [false]);
        assert_eq!(exposed("! IF %M5 THEN %M0 := %I1.0; END_IF; %M1 := %M0;", "%M0"), [true]);
        assert_eq!(exposed("! IF %M5 THEN %M0 := %I1.0; %M1 := %M0; END_IF;", "%M0"), [false]);
        assert_eq!(exposed("! %M0 := %I1.0; SR5; %M1 := %M0;", "%M0"), [true]);
    }

    #[test]
    fn indexed_names_differ_by_their_index() {
        let it = model("! %MW0 := Tab[%MW1] + Tab[%MW2];");
        let names: Vec<&str> =
            it.objects.iter().map(|it| it.text.as_str()).filter(|it| it.starts_with("Tab")).collect();
        assert_eq!(names, ["Tab[%MW1]", "Tab[%MW2]"]);
    }

    #[test]
    fn operands_that_are_none() {
        let kinds = |text: &str| -> Vec<OddityKind> { model(text).oddities.into_iter().map(|it| it.kind).collect() };
        assert!(matches!(kinds("! %MW0 := MW108[%MW2];").as_slice(), [OddityKind::Address(_)]));
        assert!(matches!(kinds("! %MW0 := 99999999999;").as_slice(), [OddityKind::Literal(_)]));
        assert_eq!(statements("! MW0 := 5;"), [""; 0], "what is no object is not written");
    }

    #[test]
    fn indexes_are_kept_with_what_they_are() {
        use crate::model::unit::IndexKind;

        let text = "! %MW0 := %MW5[%MW2] + %MW6[ 4 ] + %MW7[%MW1 + 1] + Table[%KW3];";
        let model = model(text);
        let indexes: Vec<_> = model
            .indexes
            .iter()
            .map(|it| {
                let what = match it.what {
                    IndexKind::Object(object) => model.object(object).text.to_string(),
                    IndexKind::Constant(value) => value.to_string(),
                    IndexKind::Computed => "computed".to_owned(),
                };
                (what, &text[std::ops::Range::<usize>::from(model.place(it.anchor))])
            })
            .collect();
        let expected = [("%MW2", "%MW2"), ("4", "4"), ("computed", "%MW1 + 1"), ("%KW3", "%KW3")];
        assert_eq!(indexes, expected.map(|it| (it.0.to_owned(), it.1)));
        let reads = model.accesses.iter().filter(|it| it.mode == Mode::Read);
        let read: Vec<_> = reads.map(|it| model.object(it.object).text.as_str()).collect();
        assert_eq!(read, ["%MW2", "%MW5[%MW2]", "%MW6[4]", "%MW1", "%MW7[%MW1+1]", "%KW3", "Table[%KW3]"]);
    }
}
