//! The database: salsa inputs and queries, the only place that ties the layers together.
//!
//! `file -> units -> analysis -> facts -> program -> findings`. A unit's tree, model and own findings hang on its text
//! alone and are made in one go. What crosses units goes through [`facts`], which hold no position and are compared for
//! equality, so that an edit which changes no fact stops there.

mod memory;
mod names;

use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::rc::Rc;
use std::sync::{Arc, Mutex};
use std::time::Instant;

use rayon::prelude::*;
use rowan::{TextRange, TextSize};
use rustc_hash::{FxHashMap, FxHashSet};
use salsa::{Durability, Setter as _};
use smol_str::SmolStr;

use crate::analysis::Site;
use crate::analysis::facts::UnitFacts;
use crate::analysis::program::{ProgramIndex, Skeleton};
use crate::analysis::repeats::Forms;
use crate::analysis::symbols::SymbolTable;
use crate::draw::{self, Drawing, Mark};
use crate::lint::settings::{ProgramScope, Settings};
use crate::lint::suppress::{Code, Comment, Suppressions};
use crate::lint::{
    Check, Diagnostic, FileCx, Finding, Location, MadeOf, Outcome, ProgramCx, Rule, SourceView, UnitCx, Unread,
    UnreadReason,
};
use crate::model::entity::{Entity, Family};
use crate::model::symbols::RemarkKind;
use crate::model::{UnitModel, lower};
use crate::source::decode::{Encoding, SourceText};
use crate::source::detect::{self, Detected, Dialect, FileHint};
use crate::source::edit::difference;
use crate::source::entity_from_address;
use crate::source::line_index::LineIndex;
use crate::source::split::{self, SplitHint, UnitSpan};
use crate::source::stx;
use crate::syntax::{self, Language, Parse, SyntaxKind, WalkEvent};
use crate::target::Target;
use memory::Memory;
pub use names::Facts;
use names::Resolved;

/// A file as it was read.
#[salsa::input(debug)]
pub struct SourceFile {
    /// As findings show it, with forward slashes.
    #[returns(deref)]
    pub path: String,
    #[returns(ref)]
    content: Content,
    #[returns(copy)]
    pub detected: Detected,
}

/// The text of a file, with what is known of it.
#[derive(Debug, Clone)]
pub struct Content {
    text: Arc<str>,
    /// The units of the text, where an edit tells them from those before it.
    spans: Option<(SplitHint, Arc<[UnitSpan]>)>,
    /// Where its lines start, likewise.
    lines: Option<Arc<LineIndex>>,
}

impl From<Arc<str>> for Content {
    fn from(text: Arc<str>) -> Self {
        Self { text, spans: None, lines: None }
    }
}

impl SourceFile {
    pub fn text(self, db: &dyn Db) -> &Arc<str> {
        &self.content(db).text
    }
}

/// The one project: all files of a run, and what they are checked against.
#[salsa::input(debug)]
pub struct Project {
    #[returns(deref)]
    pub files: Vec<SourceFile>,
    /// Folders that also hold code of a kind that is not read: what lies there is no whole program.
    #[returns(deref)]
    pub partly_read: Vec<String>,
    #[returns(ref)]
    pub settings: Settings,
    /// The file of the settings, in which findings may stand.
    #[returns(copy)]
    pub configuration: SourceFile,
}

#[salsa::db]
pub trait Db: salsa::Database {
    /// Set once, never swapped: salsa does not track this handle.
    fn project(&self) -> Project;

    /// What saves time, and changes no answer: salsa does not track it.
    fn memory(&self) -> &Memory;
}

/// A block, section, subroutine or listing. Its identity is its file and key; its text may change.
#[salsa::tracked(debug)]
pub struct Unit<'db> {
    #[returns(copy)]
    pub file: SourceFile,
    /// Unique in the file: `FC1`, `MAST - SR10#1`.
    #[returns(ref)]
    pub key: SmolStr,
    #[tracked]
    #[returns(ref)]
    pub text: Arc<str>,
    #[tracked]
    #[returns(copy)]
    pub language: Language,
    #[tracked]
    #[returns(ref)]
    pub entity: Entity,
    /// Name of the language when it is one that is not read.
    #[tracked]
    #[returns(copy)]
    pub unsupported: Option<&'static str>,
    /// Whether something says what the unit is; else it may be a listing out of something larger.
    #[tracked]
    #[returns(copy)]
    pub is_named: bool,
}

/// Units of a file with their offsets in bytes. They tile the text.
#[salsa::tracked(returns(deref), no_eq)]
pub fn layout<'db>(db: &'db dyn Db, file: SourceFile) -> Box<[(Unit<'db>, u32)]> {
    let text = file.text(db);
    let units = spans(db, file).iter().map(|span| {
        let part: Arc<str> = text.get(std::ops::Range::<usize>::from(span.range)).unwrap_or_default().into();
        let (key, entity) = (span.key.clone(), span.entity.clone());
        let unit = Unit::new(db, file, key, part, span.language, entity, span.unsupported, span.is_named);
        (unit, u32::from(span.range.start()))
    });
    units.collect()
}

/// How the text of a file is cut into units.
#[salsa::tracked(no_eq)]
fn spans(db: &dyn Db, file: SourceFile) -> Arc<[UnitSpan]> {
    let hint = split_hint(db, file);
    match &file.content(db).spans {
        Some((of, known)) if *of == hint => known.clone(),
        _ => split::split(file.text(db), file.detected(db), &hint).into(),
    }
}

fn split_hint(db: &dyn Db, file: SourceFile) -> SplitHint {
    let entity = db.project().settings(db).entity_address(file.path(db)).and_then(entity_from_address);
    SplitHint { entity, mnemonics: None }
}

/// Units of a file, without their places.
#[salsa::tracked(returns(deref))]
pub fn units<'db>(db: &'db dyn Db, file: SourceFile) -> Box<[Unit<'db>]> {
    layout(db, file).iter().map(|it| it.0).collect()
}

/// The lossless tree of a unit, for those who look at one: [`analysis`] makes its own and drops it.
#[salsa::tracked(no_eq, lru = 256)]
pub fn tree<'db>(db: &'db dyn Db, unit: Unit<'db>) -> Parse {
    parse(db, unit)
}

thread_local! {
    /// What the units that a thread reads have in common. A tree is the same with any.
    static MEMO: RefCell<syntax::Memo> = RefCell::default();
}

fn parse(db: &dyn Db, unit: Unit<'_>) -> Parse {
    let text = unit.text(db);
    match unit.unsupported(db) {
        None => MEMO.with_borrow_mut(|memo| memo.parse(unit.language(db), text)),
        // A file of nothing else is one that is not read.
        Some(detect::unsupported::PL7_2_LANGUAGE) if unread_form(db, unit.file(db)).is_none() => {
            let message =
                "PL7-2 has ladder and Grafcet: this part says that it is in another language, and is not read";
            syntax::opaque(text, Some((first_line(text), message)))
        }
        Some(_) => syntax::opaque(text, None),
    }
}

/// The model of a unit, for those who look at one, as with [`tree`].
#[salsa::tracked(no_eq, lru = 32)]
pub fn model<'db>(db: &'db dyn Db, unit: Unit<'db>) -> Arc<UnitModel> {
    let (entity, language) = (unit.entity(db).clone(), unit.language(db));
    Arc::new(lower::lower(tree(db, unit).syntax(), unit.text(db), entity, language))
}

/// Where the lines of a file start.
#[salsa::tracked(returns(deref), no_eq, lru = 256)]
pub fn lines(db: &dyn Db, file: SourceFile) -> Arc<LineIndex> {
    let content = file.content(db);
    content.lines.clone().unwrap_or_else(|| Arc::new(LineIndex::new(&content.text)))
}

/// What outlives the tree and the model of a unit.
#[derive(Debug)]
pub struct UnitAnalysis {
    facts: Arc<UnitFacts>,
    /// Of the rules that look at one unit, with ranges relative to it.
    findings: Ran<Finding<TextRange>>,
    /// Places that the facts name.
    anchors: Box<[TextRange]>,
    /// Bytes of text that the syntax could not place.
    not_understood: usize,
}

/// Parses and lowers a unit, runs the rules that look at it, and keeps what came of it. Tree and model are many times
/// larger than that, so they go at once.
#[salsa::tracked(no_eq)]
pub fn analysis<'db>(db: &'db dyn Db, unit: Unit<'db>) -> UnitAnalysis {
    let (text, language) = (unit.text(db), unit.language(db));
    let tree = parse(db, unit);
    let model = lower::lower(tree.syntax(), text, unit.entity(db).clone(), language);
    let mut facts = UnitFacts::new(&model);
    facts.has_gaps |= unit.unsupported(db).is_some() || !tree.errors().is_empty() || ends_open(tree.syntax());
    facts.is_fragment = is_fragment(db, unit);
    let settings = db.project().settings(db);
    let family = unit_family(db, unit).unwrap_or(Family::Pl7);
    if let Some(condition) = settings.condition_of(unit.entity(db)).filter(|_| family == Family::Pl7) {
        facts.run_under(condition);
    }
    facts.commented = is_commented(tree.syntax(), &model);
    if settings.active().iter().any(|it| it.name == "duplicate-code") {
        facts.forms = Some(Box::new(Forms::new(&model)));
    }
    let target = settings.target_or(family, *named_controller(db, unit.file(db)));
    let cx = UnitCx::new(&model, &tree, text, settings, &target);
    let findings = run_rules(settings, |rule, findings| match rule.check {
        Check::Unit(check) if rule.is_for_unit(language, &model.entity) => {
            crate::lint::run(rule, findings, |sink| check(&cx, sink));
        }
        _ => {}
    });
    let not_understood = if unit.unsupported(db).is_some() { text.len() } else { not_understood(language, &tree) };
    UnitAnalysis { facts: Arc::new(facts), findings, anchors: model.anchors.into_boxed_slice(), not_understood }
}

/// Firewall: what the unit tells its program, without places.
#[salsa::tracked]
pub fn facts<'db>(db: &'db dyn Db, unit: Unit<'db>) -> Arc<UnitFacts> {
    analysis(db, unit).facts.clone()
}

/// Whether a comment that nobody closes has swallowed the rest of a unit. What looks like one in the vendor's own block need
/// not be one.
fn ends_open(root: syntax::SyntaxNode<'_>) -> bool {
    if syntax::exchange::Block::all(root).last().is_some_and(|it| it.is_called("VENDOR")) {
        return false;
    }
    let mut last = root.children_with_tokens().last();
    while let Some(node) = last.and_then(|it| it.into_node()) {
        last = node.children_with_tokens().last();
    }
    last.and_then(|it| it.into_token()).is_some_and(|it| it.kind() == SyntaxKind::UnclosedComment)
}

fn is_commented(root: syntax::SyntaxNode<'_>, model: &UnitModel) -> bool {
    match model.language {
        Language::Exchange => model.remarks.iter().any(|it| it.kind == RemarkKind::Module && it.characters > 0),
        Language::Awl(_) if root.descendants().any(|it| it.kind() == SyntaxKind::TitleLine) => true,
        _ => root.descendant_tokens().any(|it| matches!(it.kind(), SyntaxKind::Comment | SyntaxKind::UnclosedComment)),
    }
}

/// Whether the unit is text that does not say what it is: a listing shown in a document, part of something unread.
fn is_fragment(db: &dyn Db, unit: Unit<'_>) -> bool {
    *unit.entity(db) != Entity::Container && !unit.is_named(db)
}

/// The first line of code of a unit, which names it.
fn first_line(text: &str) -> TextRange {
    split::first_code(text)
        .and_then(|it| Some(TextRange::new(it.start.try_into().ok()?, it.end.try_into().ok()?)))
        .unwrap_or_default()
}

/// Files that make up one program, in path order. The key is the folder, or the file when it stands alone.
#[salsa::tracked(debug)]
pub struct Program<'db> {
    #[returns(ref)]
    pub key: String,
    #[returns(copy)]
    pub family: Family,
    #[tracked]
    #[returns(deref)]
    pub files: Vec<SourceFile>,
    /// Files of variables that several programs use, which are a program of their own: what a rule says of them comes from
    /// there.
    #[tracked]
    #[returns(deref)]
    pub variables: Vec<SourceFile>,
    /// Whether its file stands alone only because others of the folder define what it does.
    #[tracked]
    #[returns(copy)]
    pub is_variant: bool,
}

/// Whose controllers a unit is for: code by its language, what stands around code as its file.
fn unit_family(db: &dyn Db, unit: Unit<'_>) -> Option<Family> {
    Family::of(unit.language(db)).or_else(|| family(unit.file(db).detected(db)))
}

/// Families of the units of a file, of its code only where it has any: parts of PL7 and of PL7-2 may share a text.
#[salsa::tracked(returns(deref))]
fn families(db: &dyn Db, file: SourceFile) -> Box<[Family]> {
    let units = units(db, file);
    let is_code = |it: &&Unit<'_>| *it.entity(db) != Entity::Container;
    let has_code = units.iter().any(|it| is_code(&it));
    let is_wanted = |it: &&Unit<'_>| !has_code || is_code(it);
    let mut families: Vec<Family> = units.iter().filter(is_wanted).filter_map(|&it| unit_family(db, it)).collect();
    families.extend(family(file.detected(db)).filter(|_| *declares_variables(db, file)));
    families.sort_unstable();
    families.dedup();
    families.into_boxed_slice()
}

/// What of a file says which program of a family it belongs to.
#[salsa::tracked(returns(deref))]
fn named_entities(db: &dyn Db, file: SourceFile, family: Family) -> Box<[Entity]> {
    let units = units(db, file).iter().filter(|&&it| unit_family(db, it) == Some(family));
    units.map(|it| it.entity(db)).filter(|it| **it != Entity::Container).cloned().collect()
}

/// Whether a file is a whole application (`.FEF`), by its content: it holds the variables as well as the code.
fn is_application(db: &dyn Db, file: SourceFile, family: Family) -> bool {
    !named_entities(db, file, family).is_empty() && *declares_variables(db, file)
}

/// Whether a file declares variables beside or without code: it belongs to the code around it.
#[salsa::tracked]
fn declares_variables(db: &dyn Db, file: SourceFile) -> bool {
    let mut declaring = units(db, file).iter().filter(|it| it.language(db).declares_symbols());
    declaring.any(|&it| !facts(db, it).symbols.is_empty())
}

/// The programs of the project.
///
/// Files of one folder and family are one program, unless two of them define the same entity (two variants of one
/// machine side by side) or hold code that does not say what it is: those stand alone. Where whole applications lie beside
/// exports of their parts, each application is a program, and the other files are one, to which files of variables belong.
/// Among variants, the files of variables serve each.
/// Of a STEP 7 project, the sources of each program may lie in a folder of their own.
#[salsa::tracked(returns(deref))]
pub fn programs<'db>(db: &'db dyn Db) -> Box<[Program<'db>]> {
    let project = db.project();
    let scope = project.settings(db).scope();
    let mut folders: Vec<(String, Family, Vec<SourceFile>)> = Vec::new();
    let mut alone: Vec<(Family, SourceFile, Vec<SourceFile>, bool)> = Vec::new();
    let mut index: FxHashMap<(String, Family), usize> = FxHashMap::default();
    let parts = project.files(db).iter().flat_map(|&file| families(db, file).iter().map(move |&family| (family, file)));
    for (family, file) in parts {
        let entities = named_entities(db, file, family);
        let is_part = !entities.is_empty() || *declares_variables(db, file);
        // A project is a whole program, whatever exports of it lie beside it.
        let is_project = file.detected(db) == Detected::Stx;
        if scope == ProgramScope::File || is_project || !is_part || entities.contains(&Entity::Listing) {
            alone.push((family, file, Vec::new(), false));
            continue;
        }
        let folder = folder_of(file.path(db)).to_owned();
        let at = *index.entry((folder.clone(), family)).or_insert_with(|| {
            folders.push((folder, family, Vec::new()));
            folders.len() - 1
        });
        folders[at].2.push(file);
    }
    let mut programs = Vec::new();
    for (folder, family, files) in folders {
        if scope != ProgramScope::Auto || !clash(db, &files, family) {
            programs.push(Program::new(db, folder, family, files, Vec::new(), false));
            continue;
        }
        if family == Family::Step7 {
            let (tables, code): (Vec<SourceFile>, Vec<SourceFile>) =
                files.into_iter().partition(|&it| it.detected(db) == Detected::Step7Symbols);
            let parent = |it: &SourceFile| parent_of(it.path(db));
            for files in code.chunk_by(|a, b| parent(a) == parent(b)) {
                match files.first() {
                    Some(first) if files.len() < code.len() && !clash(db, files, family) => {
                        let key = parent(first).to_owned();
                        programs.push(Program::new(db, key, family, files.to_vec(), tables.clone(), false));
                    }
                    _ => alone.extend(files.iter().map(|&file| (family, file, Vec::new(), true))),
                }
            }
            alone.extend(tables.into_iter().map(|file| (family, file, Vec::new(), false)));
            continue;
        }
        let (whole, parts): (Vec<SourceFile>, Vec<SourceFile>) =
            files.into_iter().partition(|&it| is_application(db, it, family));
        let is_clash = clash(db, &whole, family);
        alone.extend(whole.into_iter().map(|file| (family, file, Vec::new(), is_clash)));
        if !parts.is_empty() && !clash(db, &parts, family) {
            programs.push(Program::new(db, folder, family, parts, Vec::new(), false));
            continue;
        }
        let (code, variables): (Vec<SourceFile>, Vec<SourceFile>) =
            parts.into_iter().partition(|&it| !named_entities(db, it, family).is_empty());
        alone.extend(code.into_iter().map(|file| (family, file, variables.clone(), true)));
        alone.extend(variables.into_iter().map(|file| (family, file, Vec::new(), false)));
    }
    let is_table = |it: &SourceFile| it.detected(db) == Detected::Step7Symbols;
    let tables: Vec<SourceFile> = project.files(db).iter().copied().filter(is_table).collect();
    for (family, file, variables, is_variant) in alone {
        let is_code = file.detected(db) == Detected::Step7;
        let variables = if is_code { own_tables(db, file, &tables) } else { variables };
        programs.push(Program::new(db, file.path(db).to_owned(), family, vec![file], variables, is_variant));
    }
    programs.into_boxed_slice()
}

/// The symbol tables of a file of STEP 7 that is a program by itself: of those beside it that of its own name, else all.
fn own_tables(db: &dyn Db, file: SourceFile, tables: &[SourceFile]) -> Vec<SourceFile> {
    let (stem, folder) = (|it: SourceFile| Path::new(it.path(db)).file_stem(), |it: SourceFile| folder_of(it.path(db)));
    let beside: Vec<SourceFile> = tables.iter().copied().filter(|&it| folder(it) == folder(file)).collect();
    let own: Vec<SourceFile> = beside.iter().copied().filter(|&it| stem(it) == stem(file)).collect();
    if own.is_empty() { beside } else { own }
}

/// Whether two files define the same entity. One that repeats its own is judged by itself.
fn clash(db: &dyn Db, files: &[SourceFile], family: Family) -> bool {
    let mut seen = FxHashSet::default();
    files.iter().any(|&file| {
        let own: FxHashSet<&Entity> = named_entities(db, file, family).iter().collect();
        own.into_iter().filter(|it| !seen.insert(*it)).count() > 0
    })
}

fn parent_of(path: &str) -> &str {
    path.rsplit_once('/').map_or("", |it| it.0)
}

/// The folders of a STEP 7 project in which its sources, its symbols and its blocks lie.
const PROJECT_FOLDERS: [&str; 3] = ["s7asrcom", "YDBs", "ombstx"];

/// The folder that a file belongs to: of a STEP 7 project, that of the project.
fn folder_of(path: &str) -> &str {
    let folder = parent_of(path);
    let mut start = 0;
    for part in folder.split('/') {
        if PROJECT_FOLDERS.iter().any(|it| it.eq_ignore_ascii_case(part)) {
            return folder.get(..start).unwrap_or_default().trim_end_matches('/');
        }
        start += part.len() + 1;
    }
    folder
}

/// The vendor family of a file that is linted.
pub fn family(detected: Detected) -> Option<Family> {
    match detected {
        Detected::Exchange | Detected::Pasted(_) | Detected::Stx => Some(Family::Pl7),
        Detected::Pl72 | Detected::Pl72Exchange => Some(Family::Pl72),
        Detected::Step5 | Detected::Step5Symbols => Some(Family::Step5),
        Detected::Step7 | Detected::Step7Symbols => Some(Family::Step7),
        _ => None,
    }
}

/// The programs that a file belongs to: one of each family of its units.
#[salsa::tracked(returns(deref))]
pub fn programs_of<'db>(db: &'db dyn Db, file: SourceFile) -> Box<[Program<'db>]> {
    programs(db).iter().copied().filter(|it| it.files(db).contains(&file)).collect()
}

/// The programs that know what a file declares: those it belongs to, and those that share its variables.
pub fn programs_with<'db>(db: &'db dyn Db, file: SourceFile) -> impl Iterator<Item = Program<'db>> {
    let knows = move |it: &Program<'db>| it.files(db).contains(&file) || it.variables(db).contains(&file);
    programs(db).iter().copied().filter(knows)
}

/// Units of a program: file order, then order in the file; those of shared variables last.
#[salsa::tracked(returns(deref))]
pub fn program_units<'db>(db: &'db dyn Db, program: Program<'db>) -> Box<[Unit<'db>]> {
    let files = program.files(db).iter().chain(program.variables(db));
    let units = files.flat_map(|&file| units(db, file).iter().copied());
    units.filter(|&it| unit_family(db, it) == Some(program.family(db))).collect()
}

/// Units that declare symbols. Programs of one file each, as the variants of a project are, share those beside them.
#[salsa::interned]
struct Declaring<'db> {
    #[returns(copy)]
    family: Family,
    #[returns(deref)]
    units: Vec<Unit<'db>>,
}

#[salsa::tracked]
fn declaring<'db>(db: &'db dyn Db, program: Program<'db>) -> Declaring<'db> {
    let units = program_units(db, program).iter().copied();
    Declaring::new(db, program.family(db), units.filter(|it| it.language(db).declares_symbols()).collect::<Vec<_>>())
}

/// What symbols name. It has no places.
#[salsa::tracked]
fn symbols_of<'db>(db: &'db dyn Db, declaring: Declaring<'db>) -> Arc<SymbolTable> {
    Arc::new(SymbolTable::new(declaring.family(db), declaring.units(db).iter().map(|&unit| &**facts(db, unit))))
}

/// What the symbols of a program name.
pub fn symbol_table<'db>(db: &'db dyn Db, program: Program<'db>) -> &'db Arc<SymbolTable> {
    symbols_of(db, *declaring(db, program))
}

/// Findings of the rules that look at a program. A site's unit is an index into [`program_units`].
#[salsa::tracked]
pub fn program_findings<'db>(db: &'db dyn Db, program: Program<'db>) -> Ran<Arc<Finding<Site>>> {
    let project = db.project();
    let settings = project.settings(db);
    let named = program.files(db).first().and_then(|&it| *named_controller(db, it));
    let target = settings.target_or(program.family(db), named);
    let facts = program_facts(db, program);
    let whole = index(db, program, &facts);
    let key = (program.key(db).clone(), program.family(db));
    let step = db.memory().step(key, target, &facts, &whole);
    let part = step.part(&whole);
    let cx = ProgramCx::new(&whole, settings, &target);
    let part = part.as_ref().map(|it| ProgramCx::new(it, settings, &target));
    let judged = part.as_ref().unwrap_or(&cx);
    // Before the rules that look at the whole: what they ask for is not kept.
    let of_objects = run_program_rules(judged, |it| matches!(it, Check::Object(_)));
    let of_objects = db.memory().keep(step, of_objects, judged.program);
    let mut ran = run_program_rules(&cx, |it| matches!(it, Check::Program(_)));
    ran.findings.extend(of_objects.findings);
    ran.failed.extend(of_objects.failed);
    ran
}

fn run_program_rules(cx: &ProgramCx<'_>, are_wanted: impl Fn(&Check) -> bool) -> Ran<Arc<Finding<Site>>> {
    let Ran { findings, failed } = run_rules(cx.settings, |rule, findings| match rule.check {
        Check::Program(check) | Check::Object(check)
            if are_wanted(&rule.check) && rule.is_for_family(cx.program.family) =>
        {
            crate::lint::run(rule, findings, |sink| check(cx, sink));
        }
        _ => {}
    });
    Ran { findings: findings.into_iter().map(Arc::new).collect(), failed }
}

/// What the units of a file tell the program of a family.
#[salsa::tracked(returns(deref), no_eq)]
fn file_facts(db: &dyn Db, file: SourceFile, family: Family) -> Box<[Arc<UnitFacts>]> {
    let of_family = units(db, file).iter().filter(|&&it| unit_family(db, it) == Some(family));
    of_family.map(|&it| facts(db, it).clone()).collect()
}

#[salsa::tracked(no_eq)]
fn resolved<'db>(db: &'db dyn Db, program: Program<'db>) -> Arc<Resolved> {
    let family = program.family(db);
    let files = program.files(db).iter().chain(program.variables(db));
    let told: Vec<Arc<UnitFacts>> = files.flat_map(|&it| file_facts(db, it, family)).cloned().collect();
    let key = (program.key(db).clone(), family);
    db.memory().resolve(key, told.into(), symbol_table(db, program).clone())
}

/// The facts of a program's units, symbols and fields resolved, in the order of [`program_units`].
pub fn program_facts<'db>(db: &'db dyn Db, program: Program<'db>) -> Facts {
    resolved(db, program).facts().clone()
}

/// The skeleton of a program, of its [`program_facts`].
fn skeleton<'a>(db: &dyn Db, program: Program<'_>, facts: &'a [Arc<UnitFacts>]) -> Skeleton<'a> {
    let mut skeleton = Skeleton::new(program.family(db), facts.iter().map(AsRef::as_ref).collect());
    let partly_read = db.project().partly_read(db);
    if program.files(db).iter().any(|it| partly_read.iter().any(|folder| folder == folder_of(it.path(db)))) {
        skeleton.leave_incomplete();
    }
    if let Some(declarations) = resolved(db, program).declarations() {
        skeleton.know_layouts(declarations.layouts().clone());
    }
    skeleton
}

/// The index of a program, of its [`program_facts`].
pub fn index<'a>(db: &dyn Db, program: Program<'_>, facts: &'a [Arc<UnitFacts>]) -> ProgramIndex<'a> {
    ProgramIndex::of(Rc::new(skeleton(db, program, facts)))
}

/// Findings of a program whose primary place is in a file, or in the configuration.
#[salsa::tracked(returns(deref))]
fn program_findings_in<'db>(db: &'db dyn Db, program: Program<'db>, file: SourceFile) -> Vec<Arc<Finding<Site>>> {
    program_findings_by_file(db, program).get(&file).cloned().unwrap_or_default()
}

/// Findings of a program by the file of their primary place.
#[salsa::tracked(no_eq)]
fn program_findings_by_file<'db>(
    db: &'db dyn Db,
    program: Program<'db>,
) -> FxHashMap<SourceFile, Vec<Arc<Finding<Site>>>> {
    let units = program_units(db, program);
    let mut by_file: FxHashMap<SourceFile, Vec<Arc<Finding<Site>>>> = FxHashMap::default();
    for finding in &program_findings(db, program).findings {
        if finding.place.is_configured() {
            by_file.entry(db.project().configuration(db)).or_default().push(finding.clone());
        } else if let Some(unit) = units.get(finding.place.unit as usize) {
            by_file.entry(unit.file(db)).or_default().push(finding.clone());
        }
    }
    by_file
}

/// A place in a file of the database.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct FilePlace {
    pub file: SourceFile,
    pub range: TextRange,
}

/// A finding with the entity that holds it and, when suppressed, the reason given.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FileFinding {
    pub finding: Finding<FilePlace>,
    pub entity: String,
    pub family: Option<Family>,
    pub suppressed: Option<String>,
}

/// What came of a set of rules.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Ran<F> {
    pub findings: Vec<F>,
    /// Codes of rules that panicked.
    pub failed: Vec<&'static str>,
}

/// Runs each active rule apart from the others: one that panics is lost alone. Rules never query the database, so no
/// cancellation passes through here.
fn run_rules<P>(settings: &Settings, mut run: impl FnMut(&'static Rule, &mut Vec<Finding<P>>)) -> Ran<Finding<P>> {
    let mut ran = Ran { findings: Vec::new(), failed: Vec::new() };
    for &rule in settings.active() {
        let before = ran.findings.len();
        if catch_unwind(AssertUnwindSafe(|| run(rule, &mut ran.findings))).is_err() {
            ran.findings.truncate(before);
            ran.failed.push(rule.code);
        }
    }
    ran
}

/// The controller that a project is made for.
#[salsa::tracked]
fn named_controller(db: &dyn Db, file: SourceFile) -> Option<Target> {
    let name = (file.detected(db) == Detected::Stx).then(|| stx::controller(file.text(db)))??;
    Target::of_project(name)
}

/// All findings of a file, sorted by place and code; suppressed ones are marked.
#[salsa::tracked(returns(deref))]
pub fn file_findings(db: &dyn Db, file: SourceFile) -> Box<[FileFinding]> {
    let project = db.project();
    let settings = project.settings(db);
    let selection = settings.selection(file.path(db));
    let layout = layout(db, file);
    let mut found = Vec::new();
    for &(unit, offset) in layout {
        for finding in &analysis(db, unit).findings.findings {
            let shifted =
                finding.clone().map(|it| Some(FilePlace { file, range: it.checked_add(TextSize::new(offset))? }));
            found.extend(shifted);
        }
    }
    for &program in programs_of(db, file) {
        let mut places = Places::new(db, program);
        for finding in program_findings_in(db, program, file) {
            found.extend(Finding::clone(finding).map(|site| places.of(site)));
        }
        let table = symbol_table(db, program);
        if !table.is_empty() {
            let is_of =
                |it: &Finding<FilePlace>| family_at(db, layout, it.place.range.start()) == Some(program.family(db));
            found.iter_mut().filter(|it| is_of(it)).for_each(|it| it.message = table.annotate(&it.message));
        }
    }
    if file.detected(db) == Detected::Stx {
        found.iter_mut().for_each(|it| qualify(db, it, layout));
    }
    found.retain_mut(|it| match selection.severity(it.rule, it.severity) {
        Some(severity) => {
            it.severity = severity;
            true
        }
        None => false,
    });
    let mut suppressions = suppressions(db, file);
    let lines = if suppressions.is_empty() { None } else { Some(lines(db, file)) };
    let mut findings: Vec<FileFinding> = found
        .into_iter()
        .map(|finding| {
            let line = lines.as_ref().map(|it| it.line_col(finding.place.range.start()).line);
            let suppressed = line.and_then(|it| suppressions.suppress(finding.rule, it)).map(str::to_owned);
            let at = finding.place.range.start();
            FileFinding { entity: entity_at(db, layout, at), family: family_at(db, layout, at), finding, suppressed }
        })
        .collect();
    let leftovers =
        suppressions.leftovers(crate::lint::rules(), |rule| selection.severity(rule, rule.severity).is_some());
    let cx = FileCx { text: file.text(db), leftovers: &leftovers };
    let ran = run_rules(settings, |rule, findings| {
        if let Check::File(check) = rule.check {
            crate::lint::run(rule, findings, |sink| check(&cx, sink));
        }
    });
    for finding in ran.findings {
        let Some(mut finding) = finding.map(|range| Some(FilePlace { file, range })) else { continue };
        let Some(severity) = selection.severity(finding.rule, finding.severity) else { continue };
        finding.severity = severity;
        let at = finding.place.range.start();
        let (entity, family) = (entity_at(db, layout, at), family_at(db, layout, at));
        findings.push(FileFinding { finding, entity, family, suppressed: None });
    }
    findings.sort_by(|a, b| {
        let key =
            |it: &FileFinding| (it.finding.place.range.start(), it.finding.place.range.end(), it.finding.rule.code);
        key(a).cmp(&key(b)).then_with(|| a.finding.message.cmp(&b.finding.message))
    });
    findings.into_boxed_slice()
}

/// Findings in the configuration, sorted. What several programs have wrong there is said once.
pub fn configuration_findings(db: &dyn Db) -> Vec<FileFinding> {
    let project = db.project();
    let (settings, file) = (project.settings(db), project.configuration(db));
    let selection = settings.selection(file.path(db));
    let mut findings: Vec<FileFinding> = Vec::new();
    for &program in programs(db) {
        let mut places = Places::new(db, program);
        for finding in program_findings_in(db, program, file) {
            let Some(severity) = selection.severity(finding.rule, finding.severity) else { continue };
            let Some(mut finding) = Finding::clone(finding).map(|site| places.of(site)) else { continue };
            finding.severity = severity;
            finding.message = symbol_table(db, program).annotate(&finding.message);
            let (entity, family) = ("configuration".to_owned(), Some(program.family(db)));
            findings.push(FileFinding { finding, entity, family, suppressed: None });
        }
    }
    let key = |it: &FileFinding| (it.finding.place.range.start(), it.finding.rule.code, it.finding.message.clone());
    findings.sort_by_cached_key(key);
    findings.dedup_by_key(|it| key(it));
    findings
}

/// Where the sites of a program lie.
pub struct Places<'db> {
    db: &'db dyn Db,
    units: &'db [Unit<'db>],
    /// Offsets of the units, as far as their files were asked for.
    offsets: FxHashMap<Unit<'db>, u32>,
    /// By the index of their unit.
    placed: FxHashMap<u32, Placed<'db>>,
}

/// Where the anchors of a unit lie.
#[derive(Clone, Copy)]
struct Placed<'db> {
    file: SourceFile,
    offset: TextSize,
    anchors: &'db [TextRange],
}

impl<'db> Places<'db> {
    pub fn new(db: &'db dyn Db, program: Program<'db>) -> Self {
        let units = program_units(db, program);
        Self { db, units, offsets: FxHashMap::default(), placed: FxHashMap::default() }
    }

    pub fn of(&mut self, site: Site) -> Option<FilePlace> {
        if site.is_configured() {
            let project = self.db.project();
            let range = project.settings(self.db).place(site)?;
            return Some(FilePlace { file: project.configuration(self.db), range });
        }
        let Placed { file, offset, anchors } = self.unit(site.unit)?;
        let range = anchors.get(site.anchor as usize).or(anchors.first()).copied().unwrap_or_default();
        Some(FilePlace { file, range: range.checked_add(offset)? })
    }

    fn unit(&mut self, index: u32) -> Option<Placed<'db>> {
        if let Some(known) = self.placed.get(&index) {
            return Some(*known);
        }
        let unit = *self.units.get(index as usize)?;
        let file = unit.file(self.db);
        if !self.offsets.contains_key(&unit) {
            self.offsets.extend(layout(self.db, file).iter().copied());
        }
        let offset = TextSize::new(*self.offsets.get(&unit)?);
        let placed = Placed { file, offset, anchors: &analysis(self.db, unit).anchors };
        self.placed.insert(index, placed);
        Some(placed)
    }
}

/// Says of a finding in a project what it rests on. Nobody can change the text.
fn qualify(db: &dyn Db, finding: &mut Finding<FilePlace>, layout: &[(Unit<'_>, u32)]) {
    finding.fixes.clear();
    if unit_at(layout, finding.place.range.start()).is_some_and(|it| it.language(db) == Language::Pl7Xref) {
        let note = "known by the project's cross-reference, which tells neither order nor conditions";
        finding.notes.push(note.to_owned());
    }
}

/// The unit that holds a place, of those of [`layout`].
pub fn unit_at<'db>(layout: &[(Unit<'db>, u32)], at: TextSize) -> Option<Unit<'db>> {
    let after = layout.partition_point(|it| it.1 <= u32::from(at));
    Some(layout.get(after.checked_sub(1)?)?.0)
}

fn entity_at(db: &dyn Db, layout: &[(Unit<'_>, u32)], at: TextSize) -> String {
    unit_at(layout, at).map_or_else(String::new, |it| it.entity(db).to_string())
}

fn family_at(db: &dyn Db, layout: &[(Unit<'_>, u32)], at: TextSize) -> Option<Family> {
    unit_at(layout, at).and_then(|it| unit_family(db, it))
}

/// Suppression comments of a file.
fn suppressions(db: &dyn Db, file: SourceFile) -> Suppressions {
    let text = file.text(db);
    if memchr::memmem::find(text.as_bytes(), b"plclint:").is_none() {
        return Suppressions::new([], Code::default());
    }
    let lines = lines(db, file);
    let line = |at: TextSize| lines.line_col(at).line;
    let mut comments = Vec::new();
    let mut code = Code::default();
    for &(unit, offset) in layout(db, file) {
        let place = |it: TextRange| it + TextSize::new(offset);
        // The words around the rows of a rung are no code of their own, so that the rung's own comment covers all of it.
        let mut is_frame = false;
        for event in tree(db, unit).syntax().walk() {
            let token = match event {
                WalkEvent::Enter(it) | WalkEvent::Leave(it) if it.kind() == SyntaxKind::RungRow => {
                    is_frame = matches!(event, WalkEvent::Leave(_));
                    continue;
                }
                WalkEvent::Leave(it) if it.kind() == SyntaxKind::Rung => {
                    is_frame = false;
                    continue;
                }
                WalkEvent::Enter(it) if matches!(it.kind(), SyntaxKind::Sentence | SyntaxKind::Rung) => {
                    is_frame = it.kind() == SyntaxKind::Rung;
                    let range = place(it.text_range());
                    code.statements.push((line(range.start()), line(range.end())));
                    continue;
                }
                WalkEvent::Enter(_) | WalkEvent::Leave(_) => continue,
                WalkEvent::Token(it) => it,
            };
            let range = place(token.text_range());
            match token.kind() {
                SyntaxKind::Whitespace | SyntaxKind::Newline => {}
                SyntaxKind::Comment | SyntaxKind::UnclosedComment => comments.push(range),
                _ if is_frame => {}
                _ => {
                    let at = line(range.start());
                    if code.lines.last().is_none_or(|&it| it < at) {
                        code.lines.push(at);
                    }
                }
            }
        }
    }
    let comments = comments.into_iter().filter_map(|range| {
        let text = text.get(std::ops::Range::<usize>::from(range))?;
        let last = range.end().checked_sub(TextSize::new(1)).unwrap_or(range.start());
        Some(Comment { text, start: range.start(), lines: (line(range.start()), line(last)) })
    });
    Suppressions::new(comments, code)
}

/// The database. `Clone` gives a snapshot for another thread; a write waits until all are dropped.
#[salsa::db]
#[derive(Clone)]
pub struct RootDatabase {
    project: Option<Project>,
    memory: Arc<Memory>,
    storage: salsa::Storage<Self>,
}

/// Events of the database, for tests of what was run again.
pub type EventLog = Arc<Mutex<Vec<salsa::Event>>>;

impl RootDatabase {
    pub fn new(settings: Settings, events: Option<EventLog>) -> Self {
        let log = events.map(|events| -> Box<dyn Fn(salsa::Event) + Send + Sync> {
            Box::new(move |event| {
                if let Ok(mut events) = events.lock() {
                    events.push(event);
                }
            })
        });
        let mut db = Self { project: None, memory: Arc::default(), storage: salsa::Storage::new(log) };
        let source = settings.source();
        let (path, text) = (source.path.clone(), source.text.clone());
        let configuration = SourceFile::builder(path, text.into(), Detected::NotPlc);
        let configuration = configuration.durability(Durability::HIGH).new(&db);
        let project = Project::builder(Vec::new(), Vec::new(), settings, configuration);
        db.project = Some(project.durability(Durability::HIGH).new(&db));
        db
    }

    /// Adds files, in the order given.
    pub fn set_files(&mut self, inputs: impl IntoIterator<Item = Input>) -> Vec<SourceFile> {
        let files: Vec<SourceFile> = inputs.into_iter().map(|it| self.add_file(it)).collect();
        self.memory.forget();
        self.project().set_files(self).to(files.clone());
        files
    }

    /// Adds a file that is no part of the project yet. It stays until the database goes.
    pub fn add_file(&mut self, input: Input) -> SourceFile {
        SourceFile::builder(input.path, input.source.text.into(), input.detected).durability(Durability::HIGH).new(self)
    }

    /// Says that the text of a file will change often: what hangs on other files alone is not looked at then. This is an
    /// edit of the file itself.
    pub fn set_edited(&mut self, file: SourceFile) {
        let content = file.content(self).clone();
        file.set_content(self).with_durability(Durability::LOW).to(content);
    }

    /// Says which files are the project; they come in the order of their paths.
    pub fn set_project(&mut self, mut files: Vec<SourceFile>) {
        files.sort_by(|a, b| a.path(self).cmp(b.path(self)));
        if *files != *self.project().files(self) {
            self.memory.forget();
            self.project().set_files(self).to(files);
        }
    }

    pub fn set_settings(&mut self, settings: Settings) {
        let old = self.project().settings(self);
        if settings != *old || settings.source().text != old.source().text {
            self.memory.forget();
            let configuration = self.project().configuration(self);
            let source = settings.source();
            if *source.path != *configuration.path(self) {
                configuration.set_path(self).to(source.path.clone());
            }
            if source.text != *configuration.text(self) {
                configuration.set_content(self).to(source.text.clone().into());
            }
            self.project().set_settings(self).to(settings);
        }
    }

    /// Says what was left out. Code that is not read may do what that beside it does not.
    pub fn set_unread(&mut self, unread: &[Unread]) {
        let is_code =
            |it: &&Unread| matches!(&it.reason, UnreadReason::Unsupported(what) if detect::unsupported::is_code(what));
        let mut folders: Vec<String> = unread.iter().filter(is_code).map(|it| folder_of(&it.path).to_owned()).collect();
        folders.sort_unstable();
        folders.dedup();
        if folders != *self.project().partly_read(self) {
            self.memory.forget();
            self.project().set_partly_read(self).to(folders);
        }
    }

    /// Says what a file is.
    pub fn set_detected(&mut self, file: SourceFile, detected: Detected) {
        if file.detected(self) != detected {
            let text = file.text(self).clone();
            file.set_content(self).to(text.into());
            file.set_detected(self).to(detected);
        }
    }

    /// Gives a file another text; nothing happens when it is the same.
    pub fn set_text(&mut self, file: SourceFile, text: impl Into<Arc<str>>) {
        let text = text.into();
        if **file.text(self) == *text {
            return;
        }
        let (old, hint) = (file.text(self), split_hint(self, file));
        let known = split::resplit(old, spans(self, file), &text, file.detected(self), &hint);
        let spans = known.map(|it| (hint, it.into()));
        let (start, end) = difference(old, &text);
        let mut index = lines(self, file).clone();
        index.edit(start..end, text.len() + end - start - old.len(), &text);
        file.set_content(self).to(Content { text, spans, lines: Some(Arc::new(index)) });
    }

    /// Does what the next edit would have to do first, once findings are told.
    pub fn get_ready(&self) {
        self.memory.get_ready();
    }
}

#[salsa::db]
impl salsa::Database for RootDatabase {}

#[salsa::db]
impl Db for RootDatabase {
    fn project(&self) -> Project {
        match self.project {
            Some(project) => project,
            None => unreachable!("`new` sets the project before it returns"),
        }
    }

    fn memory(&self) -> &Memory {
        &self.memory
    }
}

/// Asks the database something; `None` when it was about to be written to, so that the answer would have been stale.
pub fn unless_cancelled<T>(ask: impl FnOnce() -> T) -> Option<T> {
    salsa::Cancelled::catch(AssertUnwindSafe(ask)).ok()
}

/// Names of the tracked functions that ran since the last call, such as `facts(Id(0))`.
pub fn take_executed(db: &RootDatabase, events: &EventLog) -> Vec<String> {
    use salsa::Database as _;
    let events = events.lock().map(|mut it| std::mem::take(&mut *it)).unwrap_or_default();
    db.attach(|_| {
        let executed = events.iter().filter_map(|event| match event.kind {
            salsa::EventKind::WillExecute { database_key } => Some(format!("{database_key:?}")),
            _ => None,
        });
        executed.collect()
    })
}

/// A file to check.
#[derive(Debug, Clone)]
pub struct Input {
    /// As findings shall show it.
    pub path: String,
    pub source: SourceText,
    pub detected: Detected,
}

impl Input {
    /// Text that is already decoded, recognised by its path and content unless `dialect` says what it is.
    pub fn from_text(path: &str, text: &str, dialect: Dialect) -> Self {
        let hint = FileHint { path: Some(Path::new(path)), explicit: true, dialect, family: None };
        let detected = detect::detect(hint, text);
        let source =
            SourceText { text: text.into(), encoding: Encoding::Utf8, bom: false, malformed: false, mixed: false };
        Self { path: path.to_owned(), source, detected }
    }
}

/// The files of a run in a database.
pub struct Opened {
    pub db: RootDatabase,
    /// In path order.
    pub files: Vec<SourceFile>,
    /// Of each file, the name of its encoding.
    pub encodings: Vec<&'static str>,
    /// Files that are left out.
    pub unread: Vec<Unread>,
}

/// Reads the units of files on the current rayon pool.
///
/// `unread`: what lies beside them and was left out already.
pub fn open(mut inputs: Vec<Input>, mut unread: Vec<Unread>, settings: Settings) -> Opened {
    inputs.sort_by(|a, b| a.path.cmp(&b.path));
    inputs.dedup_by(|a, b| a.path == b.path);
    let (linted, left): (Vec<Input>, Vec<Input>) = inputs.into_iter().partition(|it| family(it.detected).is_some());
    for it in left {
        let reason = match it.detected {
            Detected::Unsupported { what, .. } => UnreadReason::Unsupported(what.to_owned()),
            _ => UnreadReason::NotPlc,
        };
        unread.push(Unread { path: it.path, reason });
    }
    let encodings = linted.iter().map(|it| it.source.encoding.as_str()).collect();
    let mut db = RootDatabase::new(settings, None);
    db.set_unread(&unread);
    let files = db.set_files(linted);
    files.par_iter().for_each_with(db.clone(), |db, &file| {
        for &unit in units(db, file) {
            facts(db, unit);
        }
    });
    Opened { db, files, encodings, unread }
}

/// Checks files on the current rayon pool. The outcome is the same for any number of threads.
pub fn check(inputs: Vec<Input>, settings: Settings) -> Outcome {
    check_beside(inputs, Vec::new(), settings)
}

/// The same of files beside others that were left out: `unread`.
pub fn check_beside(inputs: Vec<Input>, unread: Vec<Unread>, settings: Settings) -> Outcome {
    let start = Instant::now();
    let active = settings.active().to_vec();
    let Opened { db, files, encodings, unread } = open(inputs, unread, settings);
    let mut outcome = Outcome { active, unread, ..Outcome::default() };
    let mut found: Vec<Vec<FileFinding>> =
        files.par_iter().map_with(db.clone(), |db, &file| file_findings(db, file).to_vec()).collect();
    found.push(configuration_findings(&db));
    let configuration = db.project().configuration(&db);
    let names = |it: &FileFinding| it.finding.names(|place| place.file == configuration);
    let mut shown_configuration = found.iter().flatten().any(names).then(|| configuration_view(&db));
    let mut indices: FxHashMap<SourceFile, u32> = FxHashMap::default();
    for (at, &file) in files.iter().enumerate() {
        for &unit in units(&db, file) {
            for code in &analysis(&db, unit).findings.failed {
                let (path, entity) = (file.path(&db), unit.entity(&db));
                outcome.internal_errors.push(format!("{path}: {entity}: rule {code} failed"));
            }
        }
        if let Some(form) = unread_form(&db, file).filter(|_| found.get(at).is_some_and(Vec::is_empty)) {
            let reason = UnreadReason::Unsupported(form.to_owned());
            outcome.unread.push(Unread { path: file.path(&db).to_owned(), reason });
            continue;
        }
        if let Some(view) = shown_configuration.take_if(|it| it.path.as_str() < file.path(&db)) {
            indices.insert(configuration, u32::try_from(outcome.files.len()).unwrap_or(u32::MAX));
            outcome.files.push(view);
        }
        indices.insert(file, u32::try_from(outcome.files.len()).unwrap_or(u32::MAX));
        let mut view = SourceView {
            path: file.path(&db).to_owned(),
            text: file.text(&db).clone(),
            encoding: encodings[at],
            dialect: dialect_name(&db, file),
            entities: 0,
            not_understood: 0,
            made_of: None,
            is_configuration: false,
            is_variant: programs_of(&db, file).iter().any(|it| it.is_variant(&db)),
        };
        if file.detected(&db) == Detected::Stx {
            let cross_reference = units(&db, file).iter().any(|it| it.language(&db) == Language::Pl7Xref);
            view.made_of = Some(MadeOf { cross_reference });
        }
        for &unit in units(&db, file) {
            if *unit.entity(&db) != Entity::Container {
                view.entities += 1;
            }
            view.not_understood += analysis(&db, unit).not_understood;
        }
        outcome.files.push(view);
    }
    if let Some(view) = shown_configuration {
        indices.insert(configuration, u32::try_from(outcome.files.len()).unwrap_or(u32::MAX));
        outcome.files.push(view);
    }
    outcome.untargeted = untargeted(&db, &files, &outcome.active);
    for &program in programs(&db) {
        for code in &program_findings(&db, program).failed {
            outcome.internal_errors.push(format!("{}: rule {code} failed", program.key(&db)));
        }
    }
    for finding in found.into_iter().flatten() {
        let name = |place: FilePlace| Some(Location { file: *indices.get(&place.file)?, range: place.range });
        if let Some(it) = finding.finding.map(name) {
            let (entity, family, suppressed) = (finding.entity, finding.family, finding.suppressed);
            outcome.diagnostics.push(Diagnostic { finding: it, entity, family, suppressed });
        }
    }
    // Those of the configuration come last, and its path may stand anywhere.
    outcome.diagnostics.sort_by_key(|it| it.finding.place.file);
    outcome.elapsed = start.elapsed();
    // Dropping all facts takes time, and the process is about to end.
    std::mem::forget(db);
    outcome
}

/// A drawing with the name of the program that it shows a part of.
#[derive(Debug, Clone)]
pub struct ProgramDrawing {
    pub program: String,
    pub drawing: Drawing,
}

impl Opened {
    /// All drawings of the programs, in their order, with the findings in them if they are wanted.
    pub fn drawings(&self, with_findings: bool) -> Vec<ProgramDrawing> {
        let db = &self.db;
        let mut marks: FxHashMap<Unit<'_>, Vec<(TextRange, Mark)>> = FxHashMap::default();
        if with_findings {
            self.files.par_iter().for_each_with(db.clone(), |db, &file| {
                file_findings(db, file);
            });
            for &file in &self.files {
                let layout = layout(db, file);
                for it in file_findings(db, file).iter().filter(|it| it.suppressed.is_none()) {
                    let it = &it.finding;
                    let after = layout.partition_point(|unit| unit.1 <= u32::from(it.place.range.start()));
                    let Some(&(unit, offset)) = after.checked_sub(1).and_then(|it| layout.get(it)) else { continue };
                    let Some(range) = it.place.range.checked_sub(TextSize::new(offset)) else { continue };
                    let mark = Mark { code: it.rule.code, severity: it.severity, message: it.message.clone() };
                    marks.entry(unit).or_default().push((range, mark));
                }
            }
        }
        programs(db).iter().flat_map(|&program| program_drawings(db, program, &marks)).collect()
    }
}

fn program_drawings<'db>(
    db: &'db RootDatabase,
    program: Program<'db>,
    marks: &FxHashMap<Unit<'db>, Vec<(TextRange, Mark)>>,
) -> Vec<ProgramDrawing> {
    let units = program_units(db, program);
    let trees: Vec<Parse> = units.iter().map(|&unit| parse(db, unit)).collect();
    let lower = |(&unit, tree): (&Unit<'db>, &Parse)| {
        lower::lower(tree.syntax(), unit.text(db), unit.entity(db).clone(), unit.language(db))
    };
    let models: Vec<UnitModel> = units.iter().zip(&trees).map(lower).collect();
    let views = units.iter().zip(&trees).zip(&models).map(|((&unit, tree), model)| draw::Unit {
        language: unit.language(db),
        tree: tree.syntax(),
        model,
        marks: marks.get(&unit).map_or(&[], Vec::as_slice),
    });
    let name = match program.files(db) {
        [only] => only.path(db),
        _ => program.key(db),
    };
    let name = Path::new(name).file_stem().map(|it| it.to_string_lossy().into_owned()).unwrap_or_default();
    let views: Vec<draw::Unit<'_>> = views.collect();
    let facts = program_facts(db, program);
    let drawings = draw::drawings(&name, &views, &index(db, program, &facts));
    drawings.into_iter().map(|drawing| ProgramDrawing { program: name.clone(), drawing }).collect()
}

/// The configuration as a file of the report.
fn configuration_view(db: &dyn Db) -> SourceView {
    let file = db.project().configuration(db);
    SourceView {
        path: file.path(db).to_owned(),
        text: file.text(db).clone(),
        encoding: Encoding::Utf8.as_str(),
        dialect: "configuration".to_owned(),
        entities: 0,
        not_understood: 0,
        made_of: None,
        is_variant: false,
        is_configuration: true,
    }
}

/// Families of code for which no controller is configured, though an active rule asks for one.
fn untargeted(db: &dyn Db, files: &[SourceFile], active: &[&Rule]) -> Vec<Family> {
    let settings = db.project().settings(db);
    let asks = |family: Family| active.iter().any(|it| it.by_controller && it.is_for_family(family));
    let read = files.iter().filter(|&&it| named_controller(db, it).is_none()).map(|&it| families(db, it));
    let mut families = vec![Family::Pl7, Family::Pl72, Family::Step5, Family::Step7];
    families.retain(|&it| {
        settings.target(it).controller().is_none() && asks(it) && read.clone().any(|of| of.contains(&it))
    });
    families
}

/// Bytes of tokens that the syntax could not place.
fn not_understood(language: Language, parse: &Parse) -> usize {
    // What is unknown between the programs of an exchange file, or in a project's listing, is no error of the syntax.
    if parse.errors().is_empty() && !matches!(language, Language::Exchange | Language::Pl7Xref) {
        return 0;
    }
    let root = parse.syntax();
    let errors = root.descendants().filter(|it| it.kind() == SyntaxKind::Error);
    errors.map(|it| usize::from(it.text_range().len())).sum()
}

/// The form of a file that holds nothing but code in forms that are not read.
fn unread_form(db: &dyn Db, file: SourceFile) -> Option<&'static str> {
    let mut code = units(db, file).iter().filter(|it| *it.entity(db) != Entity::Container).peekable();
    let form = code.peek().and_then(|it| it.unsupported(db))?;
    code.all(|it| it.unsupported(db).is_some()).then_some(form)
}

fn dialect_name(db: &dyn Db, file: SourceFile) -> String {
    if families(db, file).len() > 1 {
        let names: Vec<&str> = families(db, file).iter().map(|it| it.as_str()).collect();
        return names.join(" and ");
    }
    let language = units(db, file).iter().map(|it| it.language(db)).find(|it| *it != Language::Exchange);
    match (file.detected(db), language) {
        (Detected::Exchange, _) => "PL7 exchange file".to_owned(),
        (Detected::Step7Symbols, _) => "STEP 7 symbol table".to_owned(),
        (Detected::Stx, _) => "PL7 project, by its cross-reference".to_owned(),
        (Detected::Pl72Exchange, _) => "PL7-2 exchange file".to_owned(),
        (_, Some(Language::Pl72Ld)) => "PL7-2 ladder".to_owned(),
        (_, Some(Language::Pl72Gr7)) => "PL7-2 Grafcet".to_owned(),
        (_, Some(Language::Pl72Sfc)) => "PL7-2, textual SFC".to_owned(),
        (Detected::Pl72, _) => "PL7-2".to_owned(),
        (Detected::Step5Symbols, _) => "STEP 5 symbols".to_owned(),
        (_, Some(Language::Step5(syntax::Mnemonics::German))) => "STEP 5, German mnemonics".to_owned(),
        (_, Some(Language::Step5(syntax::Mnemonics::English))) => "STEP 5, English mnemonics".to_owned(),
        (_, Some(Language::Awl(syntax::Mnemonics::German))) => "STEP 7 AWL, German mnemonics".to_owned(),
        (_, Some(Language::Awl(syntax::Mnemonics::English))) => "STEP 7 AWL, English mnemonics".to_owned(),
        (_, Some(Language::Pl7Il)) => "PL7 instruction list".to_owned(),
        (_, Some(Language::Pl7St)) => "PL7 structured text".to_owned(),
        (_, Some(Language::Pl7Gr7)) => "PL7 Grafcet".to_owned(),
        (_, Some(Language::Sfc)) => "textual SFC".to_owned(),
        (_, Some(Language::Pl7Ld)) => "PL7 ladder".to_owned(),
        _ => "PLC text".to_owned(),
    }
}
