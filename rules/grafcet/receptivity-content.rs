//! G010: what a receptivity must not hold.

use rowan::TextRange;

use crate::lint::{Sink, UnitCx};
use crate::model::chart::{Piece, place};
use crate::model::ladder::Flaw;
use crate::model::unit::OddityKind;
use crate::syntax::AstNode as _;
use crate::syntax::pl7::ast::{IlInstr, Root, Sentence, Stmt};
use crate::syntax::pl7::chart::ast::Transition;
use crate::syntax::pl7::instructions::{Class, IlOp};
use crate::syntax::{SyntaxKind, SyntaxNode};

pub(crate) fn check(cx: &UnitCx<'_>, sink: &mut Sink<'_, TextRange>) {
    let is_receptivity = place(&cx.model.entity).is_some_and(|it| matches!(it.what, Piece::Receptivity { .. }));
    if is_receptivity && let Some(root) = Root::cast(cx.parse.syntax()) {
        root.sentences().for_each(|it| sentence(it, sink));
    }
    if cx.model.language.is_pl7_2() {
        for oddity in &cx.model.oddities {
            let what = match oddity.kind {
                OddityKind::Ladder(Flaw::CoilInTransition) => "a coil",
                OddityKind::Ladder(Flaw::ElementInTransition) => "an action",
                _ => continue,
            };
            sink.report(oddity.range, format!("{what} stands in a receptivity, which tests only"));
        }
    }
    for node in cx.nodes(SyntaxKind::Transition) {
        let sentences = Transition::cast(node).into_iter().flat_map(Transition::sentences);
        sentences.for_each(|it| sentence(it, sink));
    }
}

fn sentence(it: Sentence<'_>, sink: &mut Sink<'_, TextRange>) {
    let mut report = |range: TextRange, what: &str| {
        sink.report(range, format!("{what} stands in a receptivity, which tests only"));
    };
    for label in it.labels() {
        report(label.range(), "a label");
    }
    for statement in it.statements() {
        if let Some(what) = statement_kind(statement) {
            report(first_line(statement.syntax()), what);
        }
    }
    // Within a structured block, the `BLK` alone says it.
    let mut in_block = false;
    for instruction in it.instructions() {
        let op = instruction.op();
        match op {
            Some(IlOp::EndBlk) => in_block = false,
            _ if in_block => {}
            _ => {
                if let Some(what) = instruction_kind(instruction) {
                    report(instruction.range(), what);
                }
                in_block = op == Some(IlOp::Blk);
            }
        }
    }
}

fn statement_kind(it: Stmt<'_>) -> Option<&'static str> {
    Some(match it {
        Stmt::Expr(_) | Stmt::Empty(_) => return None,
        Stmt::Assign(_) => "an assignment",
        Stmt::Call(it) if it.subroutine().is_some() => "a call of a subroutine",
        Stmt::Call(_) => "an action",
        Stmt::If(_) | Stmt::While(_) | Stmt::Repeat(_) | Stmt::For(_) => "a control structure",
        Stmt::Jump(_) => "a jump",
        Stmt::Exit(_) | Stmt::Return(_) | Stmt::Halt(_) => "an action",
    })
}

fn instruction_kind(it: IlInstr<'_>) -> Option<&'static str> {
    if it.is_operation() {
        return Some("an operation");
    }
    let op = it.op()?;
    Some(match op {
        IlOp::Jmp | IlOp::JmpC | IlOp::JmpCN => "a jump",
        IlOp::Sr => "a call of a subroutine",
        IlOp::Blk | IlOp::OutBlk | IlOp::EndBlk => "a function block",
        IlOp::N | IlOp::Mps | IlOp::Mrd | IlOp::Mpp => return None,
        _ if op.info().class == Class::Test => return None,
        _ => "an action",
    })
}

/// Where a control structure starts: its first word.
fn first_line(node: SyntaxNode<'_>) -> TextRange {
    let is_structure = matches!(
        node.kind(),
        SyntaxKind::IfStmt | SyntaxKind::WhileStmt | SyntaxKind::RepeatStmt | SyntaxKind::ForStmt
    );
    let first = node.descendant_tokens().find(|it| !it.kind().is_trivia());
    first.filter(|_| is_structure).map_or(node.text_range(), |it| it.text_range())
}
