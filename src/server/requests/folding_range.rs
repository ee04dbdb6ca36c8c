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
                // Comments before the heading stay in view.
                let end = offset + TextSize::of(&**unit.text(it.db));
                let heading = db::model(it.db, unit).heading().start() + offset;
                folds.extend(fold(&it, TextRange::new(heading.min(end), end), FoldingRangeKind::Region));
            }
            let mut comments: Option<TextRange> = None;
            for event in db::tree(it.db, unit).syntax().walk() {
                match event {
                    WalkEvent::Enter(node) if folds_away(node.kind()) => {
                        folds.extend(fold(&it, node.text_range() + offset, FoldingRangeKind::Region));
                    }
                    WalkEvent::Token(token) if token.kind() == SyntaxKind::Comment => {
                        let range = token.text_range() + offset;
                        comments = match comments {
                            Some(above) if follows(&it, above, range) => Some(above.cover(range)),
                            above => {
                                folds.extend(above.and_then(|above| fold(&it, above, FoldingRangeKind::Comment)));
                                Some(range)
                            }
                        };
                    }
                    _ => {}
                }
            }
            folds.extend(comments.and_then(|above| fold(&it, above, FoldingRangeKind::Comment)));
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

/// Whether only blanks and one line break stand between two comments, and only blanks before the first on its line.
fn follows(it: &InFile<'_>, above: TextRange, below: TextRange) -> bool {
    let text = it.file.text(it.db);
    let between = text.get(above.end().into()..below.start().into()).unwrap_or("?");
    let before = text.get(..above.start().into()).unwrap_or_default();
    let line = before.get(before.rfind('\n').map_or(0, |it| it + 1)..).unwrap_or_default();
    let breaks = between.matches('\n').count()
        + usize::from(
            above.end() > above.start() && text.get(..above.end().into()).is_some_and(|it| it.ends_with('\n')),
        );
    between.trim().is_empty() && breaks == 1 && line.trim().is_empty()
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
