//! `textDocument/documentSymbol`: units with their networks, labels, steps and declarations.

use lsp_types::{DocumentSymbol, DocumentSymbolParams, DocumentSymbolRequest, DocumentSymbolResponse, SymbolKind};
use rowan::{TextRange, TextSize};

use super::{Answer, Handle};
use crate::db::{self, Unit};
use crate::model::UnitModel;
use crate::model::entity::{BlockKind, Entity, Part};
use crate::server::snapshot::{InFile, Snapshot};
use crate::source::detect::Detected;
use crate::syntax::SyntaxKind;

pub(super) struct Handler;

impl Handle for Handler {
    type Request = DocumentSymbolRequest;
    const RETRY: bool = true;

    fn handle(snapshot: &Snapshot, params: DocumentSymbolParams) -> Answer<Self::Request> {
        let Some(it) = snapshot.file(&params.text_document.uri) else { return Ok(None) };
        if it.file.detected(it.db) == Detected::Stx {
            return Ok(None);
        }
        let mut symbols = Vec::new();
        for &(unit, offset) in db::layout(it.db, it.file) {
            let found = Found { it, model: db::model(it.db, unit), offset: TextSize::new(offset) };
            let inner = found.inner(unit);
            // Text around programs has no name: what it declares stands for itself.
            if *unit.entity(it.db) == Entity::Container {
                symbols.extend(inner);
                continue;
            }
            let range = TextRange::up_to(TextSize::of(&**unit.text(it.db)));
            let name = unit.entity(it.db).to_string();
            symbols.push(found.symbol(name, None, kind(unit.entity(it.db)), range, found.model.heading(), inner));
        }
        Ok(Some(DocumentSymbolResponse::DocumentSymbolList(symbols)))
    }
}

pub(super) fn kind(entity: &Entity) -> SymbolKind {
    match entity {
        Entity::Block { kind: BlockKind::Db | BlockKind::Udt, .. } => SymbolKind::Struct,
        Entity::Dfb { .. } | Entity::Block { kind: BlockKind::Fb | BlockKind::Sfb, .. } => SymbolKind::Class,
        Entity::Block { .. } | Entity::Pl7 { part: Part::Subroutine(_), .. } => SymbolKind::Function,
        Entity::Pl7 { part: Part::Event, .. } => SymbolKind::Event,
        Entity::Pl7 { .. } | Entity::Listing | Entity::Container => SymbolKind::Module,
    }
}

struct Found<'s> {
    it: InFile<'s>,
    model: &'s UnitModel,
    offset: TextSize,
}

impl Found<'_> {
    fn symbol(
        &self,
        name: String,
        detail: Option<String>,
        kind: SymbolKind,
        range: TextRange,
        selection: TextRange,
        children: Vec<DocumentSymbol>,
    ) -> DocumentSymbol {
        // The client refuses a selection that leaves its range, and an empty name.
        let selection = selection.intersect(range).unwrap_or(TextRange::empty(range.start()));
        let in_file = |it: TextRange| self.it.range(it.checked_add(self.offset).unwrap_or(it));
        #[expect(deprecated, reason = "the field is there and has no default")]
        DocumentSymbol {
            name: if name.trim().is_empty() { "?".to_owned() } else { name },
            detail,
            kind,
            tags: None,
            deprecated: None,
            range: in_file(range),
            selection_range: in_file(selection),
            children: (!children.is_empty()).then_some(children),
        }
    }

    fn leaf(&self, name: String, detail: Option<String>, kind: SymbolKind, range: TextRange) -> DocumentSymbol {
        self.symbol(name, detail, kind, range, range, Vec::new())
    }

    /// What a unit holds, in the order of the text.
    fn inner(&self, unit: Unit<'_>) -> Vec<DocumentSymbol> {
        let model = self.model;
        let mut found: Vec<(TextSize, DocumentSymbol)> = Vec::new();
        let mut push = |at: TextRange, symbol: DocumentSymbol| found.push((at.start(), symbol));
        for it in &model.labels {
            push(it.range, self.leaf(it.text.to_string(), Some("label".to_owned()), SymbolKind::Key, it.range));
        }
        for it in model.fields() {
            let range = model.place(it.anchor);
            let name = unit.text(self.it.db).get(std::ops::Range::<usize>::from(range)).unwrap_or(&it.name);
            push(range, self.leaf(name.to_owned(), Some(it.ty.to_string()), SymbolKind::Field, range));
        }
        for it in &model.symbols {
            let range = model.place(it.anchor);
            let detail = it.object.as_ref().map_or(it.ty.to_string(), |it| it.text.to_string());
            push(range, self.leaf(it.name.to_string(), Some(detail), SymbolKind::Variable, range));
        }
        for it in model.interface.iter().flat_map(|it| &it.items) {
            let range = model.place(it.anchor);
            let detail = it.role.describe().to_owned();
            push(range, self.leaf(it.name.to_string(), Some(detail), SymbolKind::Field, range));
        }
        for it in model.chart.iter().flat_map(|it| &it.steps) {
            let name = it.name.as_ref().map_or_else(|| it.text.to_string(), ToString::to_string);
            push(it.range, self.leaf(format!("step {name}"), None, SymbolKind::Object, it.range));
        }
        let tree = db::tree(self.it.db, unit);
        let networks = tree.syntax().descendants().filter(|it| it.kind() == SyntaxKind::Network);
        for (number, network) in (1..).zip(networks) {
            let title = network.children().find(|it| it.kind() == SyntaxKind::TitleLine);
            let title = title.map(|it| it.text().split_once(['=', ':']).map_or("", |it| it.1).trim().to_owned());
            let head = network.children().find(|it| it.kind() == SyntaxKind::NetworkHeader);
            let range = head.map_or(network.text_range(), |it| it.text_range());
            let detail = title.filter(|it| !it.is_empty());
            push(range, self.leaf(format!("network {number}"), detail, SymbolKind::Namespace, range));
        }
        found.sort_by_key(|it| it.0);
        found.into_iter().map(|it| it.1).collect()
    }
}
