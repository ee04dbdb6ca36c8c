//! `textDocument/foldingRange`: what can be shown as one line.

use lsp_types::{FoldingRange, FoldingRangeKind, FoldingRangeParams, FoldingRangeRequest};
use rowan::{TextRange, TextSize};

use super::{Answer, Handle};
use crate::db;
use crate::model::entity::Entity;
use crate::server::snapshot::{InFile, Snapshot};
use crate::source::detect::Detected;
use crate::syntax::{SyntaxKind, WalkEvent};

pub(super) struct Handler;

impl Handle for Handler {
    type Request = FoldingRangeRequest;
    const RETRY: bool = true;

    fn handle(snapshot: &Snapshot, params: FoldingRangeParams) -> Answer<Self::Request> {
        let Some(it) = snapshot.file(&params.text_document.uri) else { return Ok(None) };
        if it.file.detected(it.db) == Detected::Stx {
            return Ok(None);
        }
        let mut folds = Vec::new();
        for &(unit, offset) in db::layout(it.db, it.file) {
            let offset = TextSize::new(offset);
            if *unit.entity(it.db) != Entity::Container {
                let range = TextRange::at(offset, TextSize::of(&**unit.text(it.db)));
                folds.extend(fold(&it, range, FoldingRangeKind::Region));
            }
            for event in db::tree(it.db, unit).syntax().walk() {
                let (range, kind) = match event {
                    WalkEvent::Enter(node) if folds_away(node.kind()) => (node.text_range(), FoldingRangeKind::Region),
                    WalkEvent::Token(token) if token.kind() == SyntaxKind::Comment => {
                        (token.text_range(), FoldingRangeKind::Comment)
                    }
                    _ => continue,
                };
                folds.extend(fold(&it, range + offset, kind));
            }
        }
        folds.sort_by_key(|it| (it.start_line, std::cmp::Reverse(it.end_line)));
        // Of several that begin on one line and end on one, the client shows one.
        folds.dedup_by_key(|it| (it.start_line, it.end_line));
        Ok(Some(folds))
    }
}

fn folds_away(kind: SyntaxKind) -> bool {
    use SyntaxKind as K;
    matches!(
        kind,
        K::Network
            | K::VarSection
            | K::StructType
            | K::ArgList
            | K::IfStmt
            | K::WhileStmt
            | K::RepeatStmt
            | K::ForStmt
            | K::Rung
            | K::Page
            | K::ChartStep
            | K::ChartAction
            | K::Transition
            | K::ExchangeBlock
    )
}

/// From the line where something begins to the last line that holds some of it.
fn fold(it: &InFile<'_>, range: TextRange, kind: FoldingRangeKind) -> Option<FoldingRange> {
    let lines = db::lines(it.db, it.file);
    let text = it.file.text(it.db).get(std::ops::Range::<usize>::from(range))?;
    let blanks = text.len() - text.trim_start().len();
    let start = range.start() + TextSize::try_from(blanks).ok()?;
    let end = range.start() + TextSize::of(text.trim_end());
    let (start_line, end_line) = (lines.line_col(start).line - 1, lines.line_col(end).line - 1);
    (start_line < end_line).then(|| FoldingRange { start_line, end_line, kind: Some(kind), ..Default::default() })
}
