//! PL7 structured text to the model.

use rowan::TextRange;
use rowan::ast::AstNode as _;

use super::builder::index;
use super::pl7::{self, Pl7};
use crate::model::UnitModel;
use crate::model::entity::Entity;
use crate::model::expr::{ExprId, Exprs};
use crate::model::object::Rights;
use crate::model::unit::{DeadCause, Leave, Loop, LoopKind, StatementKind};
use crate::syntax::pl7::ast::{self, Stmt};
use crate::syntax::{Language, SyntaxNode};

pub(super) fn lower(root: &SyntaxNode, entity: Entity) -> UnitModel {
    let mut lowering = Lowering { pl7: Pl7::new(root, entity, Language::Pl7St) };
    lowering.pl7.b.set_back_targets(pl7::back_targets(root));
    if let Some(root) = ast::Root::cast(root.clone()) {
        for sentence in root.sentences() {
            lowering.pl7.b.next_network();
            for label in sentence.labels() {
                lowering.pl7.label(&label);
            }
            for statement in sentence.statements() {
                lowering.statement(&statement);
            }
        }
    }
    lowering.pl7.b.finish()
}

struct Lowering {
    pl7: Pl7,
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
                    self.pl7.expr(&expr);
                }
            }
        }
    }

    /// Evaluates a condition under the current path, and notes that the program branches on it.
    fn condition(&mut self, condition: Option<ast::Expr>) -> (ExprId, TextRange) {
        match condition {
            Some(it) => {
                let range = it.syntax().text_range();
                let (value, _) = self.pl7.expr(&it);
                self.pl7.b.statement(StatementKind::Branch { condition: value }, range);
                (value, range)
            }
            None => (self.pl7.b.exprs().opaque(), TextRange::default()),
        }
    }

    fn if_statement(&mut self, it: &ast::IfStmt) {
        let mut open = self.pl7.b.path();
        let mut ends = Vec::new();
        for arm in it.arms() {
            let (condition, at) = self.condition(arm.condition());
            let cut = (open != Exprs::FALSE).then_some((DeadCause::FalseCondition, at));
            let taken = self.pl7.b.exprs().and(open, condition);
            self.pl7.b.enter(taken, cut);
            self.list(arm.body());
            ends.push(self.pl7.b.path());
            let not = self.pl7.b.exprs().not(condition);
            open = self.pl7.b.exprs().and(open, not);
            self.pl7.b.enter(open, cut);
        }
        if let Some(arm) = it.else_arm() {
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
        self.pl7.b.open_loop(Loop {
            kind,
            keyword,
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
        let (condition, at) = self.condition(it.condition());
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
        let (condition, at) = self.condition(it.condition());
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
        if let Some(end) = it.end() {
            self.pl7.expr(&end);
        }
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
        }
        // The body may not run at all.
        let runs = self.pl7.b.exprs().opaque();
        let inside = self.pl7.b.exprs().and(before, runs);
        self.pl7.b.enter(inside, None);
        self.list(it.body());
        self.pl7.b.close_loop();
        self.pl7.b.enter(before, None);
    }
}

/// Range of the keyword that a control structure starts with.
fn keyword(node: &SyntaxNode) -> TextRange {
    let mut tokens = node.children_with_tokens().filter_map(rowan::NodeOrToken::into_token);
    tokens.find(|it| !it.kind().is_trivia()).map_or_else(|| node.text_range(), |it| it.text_range())
}
