//! `workspace/symbol`: units, symbols and steps of all programs.

use lsp_types::{
    BaseSymbolInformation, SymbolKind, WorkspaceSymbol, WorkspaceSymbolLocation, WorkspaceSymbolParams,
    WorkspaceSymbolRequest, WorkspaceSymbolResponse,
};

use super::document_symbol::kind;
use super::{Answer, Handle};
use crate::analysis::Site;
use crate::db::{self, Places};
use crate::model::entity::Entity;
use crate::server::snapshot::Snapshot;
use crate::source::detect::Detected;

pub(super) struct Handler;

/// More than a list on a screen needs; a longer query finds the rest.
const MOST: usize = 1000;

impl Handle for Handler {
    type Request = WorkspaceSymbolRequest;
    const RETRY: bool = true;

    fn handle(snapshot: &Snapshot, params: WorkspaceSymbolParams) -> Answer<Self::Request> {
        let query = params.query.to_lowercase();
        let mut found = Vec::new();
        for root in &snapshot.roots {
            let db = &root.db;
            for &program in db::programs(db) {
                let mut places = Places::new(db, program);
                for (number, &unit) in (0..).zip(db::program_units(db, program)) {
                    if unit.file(db).detected(db) == Detected::Stx {
                        continue;
                    }
                    let facts = db::facts(db, unit);
                    let entity = unit.entity(db).to_string();
                    let mut names: Vec<(String, SymbolKind, u32)> = Vec::new();
                    if *unit.entity(db) != Entity::Container {
                        names.push((entity.clone(), kind(unit.entity(db)), 0));
                    }
                    names.extend(facts.symbols.iter().map(|it| {
                        let address = it.object.as_ref().map_or(it.ty.as_str(), |it| it.text.as_str());
                        (format!("{} {address}", it.name), SymbolKind::Variable, it.anchor)
                    }));
                    names.extend(facts.chart.iter().filter(|it| it.defines).flat_map(|chart| {
                        chart.steps.iter().filter_map(|it| {
                            let bit = it.name.as_ref()?.bit(chart.graph);
                            Some((format!("step {bit}"), SymbolKind::Object, it.anchor))
                        })
                    }));
                    for (name, kind, anchor) in names.into_iter().filter(|it| matches(&it.0, &query)) {
                        let place = places.of(Site { unit: number, anchor });
                        let Some(location) = place.and_then(|it| root.location(snapshot, it)) else { continue };
                        found.push(WorkspaceSymbol {
                            location: WorkspaceSymbolLocation::Location(location),
                            data: None,
                            base_symbol_information: BaseSymbolInformation {
                                container_name: (name != entity).then(|| entity.clone()),
                                name,
                                kind,
                                tags: None,
                            },
                        });
                    }
                }
            }
        }
        found.truncate(MOST);
        Ok(Some(WorkspaceSymbolResponse::WorkspaceSymbolList(found)))
    }
}

/// Whether the letters of a query, in lower case, come in a name in their order.
fn matches(name: &str, query: &str) -> bool {
    let name = name.to_lowercase();
    let mut letters = name.chars();
    query.chars().filter(|it| !it.is_whitespace()).all(|wanted| letters.any(|it| it == wanted))
}

#[cfg(test)]
mod tests {
    use super::matches;

    #[test]
    fn letters_come_in_their_order() {
        assert!(matches("MAST - SR10", "sr10") && matches("MAST - SR10", "mr1") && matches("FC1", ""));
        assert!(!matches("FC1", "1f"));
    }
}
