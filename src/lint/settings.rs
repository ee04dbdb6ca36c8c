//! `plclint.toml` and what the command line says on top of it, as one value.
//!
//! This module reads text; finding and opening the file is the command line's affair.

use std::collections::BTreeMap;
use std::fmt;
use std::ops::Range;
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

use ignore::gitignore::{Gitignore, GitignoreBuilder};
use rowan::TextRange;
use serde::Deserialize;
use smol_str::SmolStr;
use toml::Spanned;

use super::finding::Severity;
use super::rule::{Rule, rules};
use super::select::{Selection, Selector};
use crate::analysis::Site;
use crate::analysis::program::Context;
use crate::model::entity::{Entity, Family, Part, Task};
use crate::model::object::{self, Class, Object};
use crate::source::decode::Encoding;
use crate::source::entity_from_address;
use crate::source::walk::WalkOptions;
use crate::target::pl7::MODULE_CHANNELS;
use crate::target::pl72::Series;
use crate::target::{Counted, CountedBy, Target};

/// Name of the configuration file.
pub const FILE_NAME: &str = "plclint.toml";

/// Everything that a run is configured with. A clone is cheap; two settings are equal when they were read from the
/// same words in the same folder.
#[derive(Clone)]
pub struct Settings(Arc<Inner>);

struct Inner {
    folders: Folders,
    source: ConfigSource,
    file: File,
    overrides: Overrides,
    base: Selection,
    per_file: Vec<PerFileRules>,
    active: Vec<&'static Rule>,
    entities: Vec<(Gitignore, usize)>,
    encoding: Option<Encoding>,
}

/// The file that settings were read from: findings may stand in it.
#[derive(Debug, Clone, Default)]
pub struct ConfigSource {
    /// As reports show it, with forward slashes.
    pub path: String,
    pub text: Arc<str>,
    /// Keys and values, by bytes of the text, sorted.
    places: Box<[(u32, u32)]>,
}

impl ConfigSource {
    fn new(text: &str, path: &Path) -> Self {
        let number = |it: usize| u32::try_from(it).unwrap_or(u32::MAX);
        let mut places = Vec::new();
        let mut open = Vec::new();
        // What is no TOML has no settings.
        let table = toml::de::DeTable::parse(text).map(Spanned::into_inner).unwrap_or_default();
        let mut keep = |it: Range<usize>| places.push((number(it.start), number(it.end)));
        let mut tables = vec![table];
        while let Some(table) = tables.pop() {
            for (key, value) in table {
                keep(key.span());
                open.push(value);
                while let Some(value) = open.pop() {
                    keep(value.span());
                    match value.into_inner() {
                        toml::de::DeValue::Array(items) => open.extend(items),
                        toml::de::DeValue::Table(table) => tables.push(table),
                        _ => {}
                    }
                }
            }
        }
        places.sort_unstable();
        places.dedup();
        Self { path: path.display().to_string().replace('\\', "/"), text: text.into(), places: places.into() }
    }
}

struct PerFileRules {
    glob: Gitignore,
    select: Vec<Selector>,
    ignore: Vec<Selector>,
}

impl PartialEq for Settings {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
            || (self.0.folders == other.0.folders
                && self.0.file == other.0.file
                // Places are no part of a value.
                && (&self.0.source.path, &self.0.source.text) == (&other.0.source.path, &other.0.source.text)
                && self.0.overrides == other.0.overrides
                && self.0.base == other.0.base)
    }
}

impl Eq for Settings {}

impl fmt::Debug for Settings {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Settings").field("file", &self.0.file).field("overrides", &self.0.overrides).finish()
    }
}

impl Default for Settings {
    fn default() -> Self {
        let file = File::default();
        let mut base = Selection::none(rules());
        base.select(&[Selector::Default]);
        let active = active(&base, &[]);
        Self(Arc::new(Inner {
            folders: Folders::default(),
            source: ConfigSource::default(),
            file,
            overrides: Overrides::default(),
            base,
            per_file: Vec::new(),
            active,
            entities: Vec::new(),
            encoding: None,
        }))
    }
}

/// Where the globs of a configuration start, and where relative paths do. Both absolute.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Folders {
    /// Folder of the configuration file.
    pub root: PathBuf,
    /// Working folder of the process.
    pub current: PathBuf,
}

/// What the command line says. It is a layer above the file: `select` takes the place of the file's whole selection,
/// the rest adds to it.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Overrides {
    pub select: Option<Vec<String>>,
    pub extend_select: Vec<String>,
    pub ignore: Vec<String>,
    /// In the order given: the last word wins.
    pub severity: Vec<(String, Severity)>,
    pub controller: Option<String>,
    pub encoding: Option<String>,
}

#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
struct File {
    target: TargetConfig,
    objects: BTreeMap<Spanned<String>, Spanned<u32>>,
    chart: ChartConfig,
    files: Files,
    entity: Vec<EntityHint>,
    task: Vec<TaskConfig>,
    event: Vec<EventConfig>,
    section: Vec<SectionConfig>,
    module: Vec<ModuleConfig>,
    program: Program,
    rules: Rules,
    per_file: Vec<PerFile>,
}

/// The controller that programs are for.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
struct TargetConfig {
    /// `TSX 37-22`, `CPU 314`.
    controller: Option<Spanned<String>>,
    /// `V3`, where the documents distinguish versions.
    version: Option<Spanned<String>>,
    /// Of a TSX 17-20: `I0,00` commands it to run and to stop.
    run_stop_input: Option<Spanned<bool>>,
    /// Of a TSX 17-20: `O0,00` tells that it runs.
    security_output: Option<Spanned<bool>>,
    /// Bytes of memory that a PL7-2 program may take.
    program_memory: Option<Spanned<u32>>,
}

/// How much of a chart the controller keeps at once.
#[derive(Debug, Clone, Default, PartialEq, Eq, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct ChartConfig {
    pub active_steps: Option<Spanned<u32>>,
    pub valid_transitions: Option<Spanned<u32>>,
}

#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct Files {
    include: Vec<Spanned<String>>,
    exclude: Vec<Spanned<String>>,
    encoding: Option<Spanned<String>>,
}

/// Says what a file holds that does not say so itself.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct EntityHint {
    path: Spanned<String>,
    address: String,
}

/// A task of the application, and the channels that it exchanges.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TaskConfig {
    /// `MAST`, `FAST`.
    pub name: String,
    /// `20ms`.
    pub period: Option<Spanned<Milliseconds>>,
    /// `250ms`.
    pub watchdog: Option<Spanned<Milliseconds>>,
    /// `%I3.8:8`.
    #[serde(default)]
    pub io: Vec<Spanned<Channels>>,
}

impl TaskConfig {
    pub fn context(&self) -> Option<Context> {
        match self.name.to_ascii_uppercase().as_str() {
            "MAST" => Some(Context::Cyclic),
            "FAST" => Some(Context::Fast),
            _ => None,
        }
    }
}

/// A time in milliseconds, written `20ms`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Deserialize)]
#[serde(try_from = "String")]
pub struct Milliseconds(pub u32);

impl TryFrom<String> for Milliseconds {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        let digits = text.trim().strip_suffix("ms").map(str::trim_end);
        let value = digits.and_then(|it| it.parse().ok());
        value.map(Self).ok_or_else(|| format!("`{text}` is no time in milliseconds, such as `20ms`"))
    }
}

/// One channel of a module or several: `%I1.0`, `%Q4.0:8`, `%IW3.0`; of PL7-2 `I0,05`, `O0,00[8]`.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Deserialize)]
#[serde(try_from = "String")]
pub struct Channels(pub Object);

impl TryFrom<String> for Channels {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        let text = text.trim();
        if let Ok(it) = object::pl72::parse(text)
            && matches!(it.object.class, Class::Input | Class::Output)
            && it.index.is_none()
        {
            return Ok(Self(it.object));
        }
        match object::pl7::parse(text) {
            Ok(it) if matches!(it.class, Class::Input | Class::Output) => Ok(Self(it)),
            Ok(_) => Err(format!("`{text}` is no input or output, such as `%I1.0`")),
            Err(error) => Err(format!("`{text}` is no input or output: {}", error.message)),
        }
    }
}

/// An event and the channel that raises it.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EventConfig {
    /// i of EVTi.
    pub number: Spanned<u16>,
    /// `%I1.0`.
    pub trigger: Option<Spanned<Channels>>,
}

/// A section that runs under a condition.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct SectionConfig {
    address: Spanned<SectionAddress>,
    condition: Spanned<ConditionBit>,
}

/// A section as headings name it: `MAST - Peinture`, `FAST - MAIN`.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(try_from = "String")]
struct SectionAddress {
    task: Task,
    /// `None`: the one section of a task that has one.
    name: Option<SmolStr>,
}

impl TryFrom<String> for SectionAddress {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        // PL7-2 has no sections.
        let is_older = text.trim_start().get(..5).is_some_and(|it| it.eq_ignore_ascii_case("PL7-2"));
        match entity_from_address(&text).filter(|_| !is_older) {
            Some(Entity::Pl7 { task, section, part: Part::Main }) => Ok(Self { task, name: section }),
            _ => Err(format!("`{text}` is no section, such as `MAST - Pump`, or `MAST - MAIN` where it has no name")),
        }
    }
}

impl SectionAddress {
    /// Whether a unit belongs to the section. Subroutines belong to the task (PL7:1966).
    fn holds(&self, entity: &Entity) -> bool {
        let Entity::Pl7 { task, section, part } = entity else { return false };
        let same = |a: &SmolStr, b: &SmolStr| a.to_lowercase() == b.to_lowercase();
        let is_named = match (&self.name, section) {
            (Some(a), Some(b)) => same(a, b),
            (None, None) => true,
            _ => false,
        };
        *task == self.task && is_named && !matches!(part, Part::Subroutine(_) | Part::Event)
    }
}

/// What a section's condition is said to be: any object of PL7, for rule P001 tells which may be one.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(try_from = "String")]
struct ConditionBit(Object);

impl TryFrom<String> for ConditionBit {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        let bare: String = text.split_whitespace().collect();
        let parsed = match bare.split_once('[').and_then(|(base, rest)| Some((base, rest.rsplit_once(']')?))) {
            Some((base, (index, suffix))) => {
                object::pl7::parse(index).map_err(|it| format!("`{text}` is no object: {}", it.message))?;
                object::pl7::parse_indexed(base, Some(suffix).filter(|it| !it.is_empty()))
            }
            None => object::pl7::parse(&bare),
        };
        match parsed {
            Ok(object) => Ok(Self(Object { text: bare.into(), ..object })),
            Err(error) => Err(format!("`{text}` is no object: {}", error.message)),
        }
    }
}

/// A module in the rack and the discrete channels that it has.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct ModuleConfig {
    /// As addresses name it: 2 of `%Q2.0`, 104 of `%Q104.0`.
    position: Spanned<u32>,
    #[serde(default)]
    inputs: Channel,
    #[serde(default)]
    outputs: Channel,
}

/// A number of channels.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(try_from = "u32")]
struct Channel(u32);

impl TryFrom<u32> for Channel {
    type Error = String;

    fn try_from(count: u32) -> Result<Self, String> {
        let most = MODULE_CHANNELS;
        if count > most.value {
            return Err(format!("a module has {} channels at most ({}), not {count}", most.value, most.source));
        }
        Ok(Self(count))
    }
}

#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct Program {
    scope: ProgramScope,
}

/// Which files make up one program.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ProgramScope {
    /// As the files themselves suggest.
    #[default]
    Auto,
    /// Each file is a program.
    File,
    /// The files of one folder are a program.
    Folder,
}

#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
struct Rules {
    select: Option<Vec<Spanned<String>>>,
    extend_select: Vec<Spanned<String>>,
    ignore: Vec<Spanned<String>>,
    severity: BTreeMap<Spanned<String>, Spanned<String>>,
    options: BTreeMap<Spanned<String>, toml::Table>,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct PerFile {
    path: Spanned<String>,
    #[serde(default)]
    select: Vec<Spanned<String>>,
    #[serde(default)]
    ignore: Vec<Spanned<String>>,
}

/// A configuration that cannot be used, and where.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ConfigError {
    pub origin: Origin,
    pub message: String,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Origin {
    /// A place in a file; line and column (in characters) count from 1.
    File { path: PathBuf, line: usize, column: usize },
    /// An option of the command line: `--select`.
    Option(&'static str),
}

impl fmt::Display for ConfigError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.origin {
            Origin::File { path, line, column } => write!(f, "{}:{line}:{column}: ", path.display())?,
            Origin::Option(name) => write!(f, "{name}: ")?,
        }
        f.write_str(&self.message)
    }
}

impl std::error::Error for ConfigError {}

/// The text of a configuration file, for errors.
struct Text<'a> {
    path: &'a Path,
    text: &'a str,
}

impl Text<'_> {
    fn error(&self, span: Option<Range<usize>>, message: impl Into<String>) -> ConfigError {
        let offset = span.map_or(0, |it| it.start);
        let before = self.text.get(..offset).unwrap_or(self.text);
        let start = before.rfind('\n').map_or(0, |it| it + 1);
        let origin = Origin::File {
            path: self.path.to_owned(),
            line: before.matches('\n').count() + 1,
            column: before[start..].chars().count() + 1,
        };
        ConfigError { origin, message: message.into() }
    }

    fn selectors(&self, registry: &'static [Rule], words: &[Spanned<String>]) -> Result<Vec<Selector>, ConfigError> {
        words.iter().map(|it| self.selector(registry, it)).collect()
    }

    fn selector(&self, registry: &'static [Rule], word: &Spanned<String>) -> Result<Selector, ConfigError> {
        Selector::parse(registry, word.get_ref()).map_err(|it| self.error(Some(word.span()), it.to_string()))
    }

    fn glob(&self, glob: &Spanned<String>) -> Result<Gitignore, ConfigError> {
        let mut builder = GitignoreBuilder::new("");
        let built = builder.add_line(None, glob.get_ref()).and_then(|it| it.build());
        built.map_err(|it| self.error(Some(glob.span()), it.to_string()))
    }
}

impl Settings {
    /// Settings from the text of a configuration file, which `path` names in errors, and from the command line.
    pub fn parse(text: &str, path: &Path, folders: Folders, overrides: Overrides) -> Result<Self, ConfigError> {
        Self::parse_with(rules(), text, path, folders, overrides)
    }

    /// Settings without a configuration file.
    pub fn without_file(folders: Folders, overrides: Overrides) -> Result<Self, ConfigError> {
        Self::parse("", Path::new(FILE_NAME), folders, overrides)
    }

    pub(crate) fn parse_with(
        registry: &'static [Rule],
        text: &str,
        path: &Path,
        folders: Folders,
        overrides: Overrides,
    ) -> Result<Self, ConfigError> {
        let text = Text { path, text: text.strip_prefix('\u{feff}').unwrap_or(text) };
        let mut file: File = toml::from_str(text.text).map_err(|it| text.error(it.span(), it.message().trim()))?;
        let mut forced = None;
        if let Some(name) = &file.files.encoding {
            forced = encoding(name.get_ref()).map_err(|it| text.error(Some(name.span()), it))?;
        }
        if let Some(name) = &overrides.encoding {
            forced = encoding(name).map_err(|message| ConfigError { origin: Origin::Option("--encoding"), message })?;
        }
        if let Some(name) = &file.target.controller {
            controller(name.get_ref()).map_err(|it| text.error(Some(name.span()), it))?;
        }
        if let Some(name) = &overrides.controller {
            controller(name).map_err(|message| ConfigError { origin: Origin::Option("--target"), message })?;
        }
        counts(&text, &file, &overrides)?;
        of_pl7_2(&text, &file.target)?;
        if let (Some(controller), Some(version)) = (&file.target.controller, &file.target.version) {
            let target = controller.get_ref().parse::<crate::target::Target>();
            if let Some(Err(error)) = target.ok().map(|it| it.with_version(Some(version.get_ref()))) {
                return Err(text.error(Some(version.span()), error.to_string()));
            }
        }
        let base = selection(registry, &text, &file.rules, &overrides)?;
        let mut per_file = Vec::new();
        for it in &file.per_file {
            per_file.push(PerFileRules {
                glob: text.glob(&it.path)?,
                select: text.selectors(registry, &it.select)?,
                ignore: text.selectors(registry, &it.ignore)?,
            });
        }
        let mut options = BTreeMap::new();
        for (word, table) in std::mem::take(&mut file.rules.options) {
            let Selector::Rule(code) = text.selector(registry, &word)? else {
                let message = format!("`{}` is not one rule: options belong to a rule", word.get_ref());
                return Err(text.error(Some(word.span()), message));
            };
            let name = registry.iter().find(|it| it.code == code).map_or(code, |it| it.name);
            options.insert(Spanned::new(word.span(), name.to_owned()), table);
        }
        file.rules.options = options;
        for (at, section) in file.section.iter().enumerate() {
            let address = section.address.get_ref();
            if file.section[..at].iter().any(|it| it.address.get_ref() == address) {
                return Err(text.error(Some(section.address.span()), "this section has a condition already"));
            }
        }
        for (at, module) in file.module.iter().enumerate() {
            let position = module.position.get_ref();
            if file.module[..at].iter().any(|it| it.position.get_ref() == position) {
                let message = format!("the module at position {position} is there already");
                return Err(text.error(Some(module.position.span()), message));
            }
        }
        let mut entities = Vec::new();
        for (index, hint) in file.entity.iter().enumerate() {
            entities.push((text.glob(&hint.path)?, index));
        }
        // The walk of folders compiles them again; here, an error has a place.
        for globs in [&file.files.include, &file.files.exclude] {
            globs.iter().try_for_each(|it| text.glob(it).map(drop))?;
        }
        let source = ConfigSource::new(text.text, path);
        let active = active(&base, &per_file);
        Ok(Self(Arc::new(Inner {
            folders,
            source,
            file,
            overrides,
            base,
            per_file,
            active,
            entities,
            encoding: forced,
        })))
    }

    /// The file that the settings are from; its text is empty when there is none.
    pub fn source(&self) -> &ConfigSource {
        &self.0.source
    }

    /// Where a key or value stands, for findings of rules that look at programs.
    pub fn site<T>(&self, value: &Spanned<T>) -> Site {
        let span = value.span();
        let span = (u32::try_from(span.start).unwrap_or(u32::MAX), u32::try_from(span.end).unwrap_or(u32::MAX));
        let at = self.0.source.places.binary_search(&span).unwrap_or_default();
        Site::configured(u32::try_from(at).unwrap_or_default())
    }

    /// The range of such a place in [`ConfigSource::text`].
    pub fn place(&self, site: Site) -> Option<TextRange> {
        let &(start, end) = self.0.source.places.get(site.anchor as usize).filter(|_| site.is_configured())?;
        Some(TextRange::new(start.into(), end.max(start).into()))
    }

    /// Which rules are on for a file.
    pub fn selection(&self, path: &str) -> Selection {
        let mut selection = self.0.base.clone();
        if !self.0.per_file.is_empty()
            && let Some(path) = self.relative(path)
        {
            for it in &self.0.per_file {
                if matches(&it.glob, &path) {
                    selection.select(&it.select);
                    selection.ignore(&it.ignore);
                }
            }
        }
        selection
    }

    /// The severity of a rule for a file; `None` when the rule is off there.
    #[cfg(test)]
    pub fn enabled(&self, rule: &Rule, path: &str) -> Option<Severity> {
        self.selection(path).severity(rule, rule.severity)
    }

    /// The rules that are on somewhere, in the order of codes.
    pub fn active(&self) -> &[&'static Rule] {
        &self.0.active
    }

    /// The controller, by a name that [`Target`] reads.
    pub fn controller(&self) -> Option<&str> {
        let file = self.0.file.target.controller.as_ref().map(|it| it.get_ref().as_str());
        self.0.overrides.controller.as_deref().or(file)
    }

    /// The family of the configured controller.
    pub fn controller_family(&self) -> Option<Family> {
        self.controller()?.parse::<Target>().ok().map(|it| it.family())
    }

    /// Whether the command line names another controller than the file, which then says nothing of it.
    fn is_another_controller(&self) -> bool {
        let parse = |it: &str| it.parse::<Target>().ok();
        let file = self.0.file.target.controller.as_ref().map(|it| it.get_ref().as_str());
        match (&self.0.overrides.controller, file) {
            (Some(controller), Some(file)) => parse(controller) != parse(file),
            _ => false,
        }
    }

    /// The controller's version; none when the command line names another controller than the file.
    pub fn version(&self) -> Option<&str> {
        let version = self.0.file.target.version.as_ref().filter(|_| !self.is_another_controller())?;
        Some(version.get_ref().as_str())
    }

    /// Where it is said that the input `I0,00` of a TSX 17-20 commands it to run and to stop.
    pub fn run_stop_input(&self) -> Option<&Spanned<bool>> {
        self.of_own_controller(self.0.file.target.run_stop_input.as_ref()).filter(|it| *it.get_ref())
    }

    /// Where it is said that the output `O0,00` of a TSX 17-20 tells that it runs.
    pub fn security_output(&self) -> Option<&Spanned<bool>> {
        self.of_own_controller(self.0.file.target.security_output.as_ref()).filter(|it| *it.get_ref())
    }

    /// Bytes of memory that a PL7-2 program may take.
    pub fn program_memory(&self) -> Option<&Spanned<u32>> {
        self.of_own_controller(self.0.file.target.program_memory.as_ref())
    }

    /// What the file says of its controller; none when the command line names another one.
    fn of_own_controller<'a, T>(&self, value: Option<&'a Spanned<T>>) -> Option<&'a Spanned<T>> {
        value.filter(|_| !self.is_another_controller())
    }

    /// Configured number of objects of a family, by its mnemonic: `M`, `MW`; none when the command line names another
    /// controller than the file.
    pub fn objects(&self, family: &str) -> Option<u32> {
        if self.is_another_controller() {
            return None;
        }
        self.0.file.objects.iter().find(|it| it.0.get_ref() == family).map(|it| *it.1.get_ref())
    }

    /// What the application configures of its charts; nothing when the command line names another controller than the file.
    pub fn chart(&self) -> ChartConfig {
        if self.is_another_controller() { ChartConfig::default() } else { self.0.file.chart.clone() }
    }

    /// What programs of a family are checked for: the configured controller with the configured counts, when it is one of
    /// that family, else what holds for every controller of the family.
    pub fn target(&self, family: Family) -> Target {
        self.target_or(family, None)
    }

    /// As [`Self::target`], for a program that names its controller itself: unless one is configured, it is that one.
    pub fn target_or(&self, family: Family, named: Option<Target>) -> Target {
        let or_any = |it: Option<Target>| it.or(named).unwrap_or(Target::any(family));
        let configured = self.controller().and_then(|it| it.parse::<Target>().ok());
        match configured.map(|it| it.with_version(self.version()).unwrap_or(it)) {
            Some(it) if it.family() != family => or_any(None),
            it if self.0.file.objects.is_empty() => or_any(it),
            it => or_any(it).with_counts(|key| self.objects(key)),
        }
    }

    pub fn tasks(&self) -> &[TaskConfig] {
        &self.0.file.task
    }

    pub fn events(&self) -> &[EventConfig] {
        &self.0.file.event
    }

    /// The task that exchanges an input or output, as far as the configuration tells. Channels that the list of the fast
    /// task lacks are the master task's, where all are unless someone moves them (PL7:2414).
    pub fn task_of(&self, object: &Object) -> Option<Context> {
        let mut fast_is_listed = false;
        for task in self.tasks() {
            let Some(context) = task.context() else { continue };
            fast_is_listed |= context == Context::Fast && !task.io.is_empty();
            if task.io.iter().any(|it| it.get_ref().0.footprint.overlaps(&object.footprint)) {
                return Some(context);
            }
        }
        fast_is_listed.then_some(Context::Cyclic)
    }

    /// The condition under which the section runs that a unit belongs to, as the configuration says.
    pub fn condition_of(&self, entity: &Entity) -> Option<&Object> {
        Some(&self.condition(entity)?.get_ref().0)
    }

    /// Where the configuration says so.
    pub fn condition_site(&self, entity: &Entity) -> Option<Site> {
        self.condition(entity).map(|it| self.site(it))
    }

    fn condition(&self, entity: &Entity) -> Option<&Spanned<ConditionBit>> {
        self.0.file.section.iter().find(|it| it.address.get_ref().holds(entity)).map(|it| &it.condition)
    }

    /// Whether the configuration says which modules there are.
    pub fn has_modules(&self) -> bool {
        !self.0.file.module.is_empty()
    }

    /// Discrete output channels of the module at a position, and where it is configured; `None` when none is.
    pub fn output_channels(&self, position: u32) -> Option<(u32, Site)> {
        let mut modules = self.0.file.module.iter();
        let module = modules.find(|it| *it.position.get_ref() == position)?;
        Some((module.outputs.0, self.site(&module.position)))
    }

    /// The input whose channel raises an event, as the configuration says.
    pub fn trigger_of(&self, event: u16) -> Option<&Object> {
        self.trigger(event).map(|it| &it.get_ref().0)
    }

    /// Where the configuration says so.
    pub fn trigger_site(&self, event: u16) -> Option<Site> {
        self.trigger(event).map(|it| self.site(it))
    }

    fn trigger(&self, event: u16) -> Option<&Spanned<Channels>> {
        self.events().iter().find(|it| *it.number.get_ref() == event)?.trigger.as_ref()
    }

    pub fn scope(&self) -> ProgramScope {
        self.0.file.program.scope
    }

    /// The encoding to read files with that carry no byte order mark.
    pub fn encoding(&self) -> Option<Encoding> {
        self.0.encoding
    }

    /// The table `[rules.options.<rule>]`, by the name of the rule.
    pub fn options(&self, rule: &str) -> Option<&toml::Table> {
        self.0.file.rules.options.get(rule)
    }

    /// The address that `[[entity]]` gives to a file; the first entry that matches counts.
    pub fn entity_address(&self, path: &str) -> Option<&str> {
        let path = self.relative(path)?;
        let (_, index) = self.0.entities.iter().find(|it| matches(&it.0, &path))?;
        self.0.file.entity.get(*index).map(|it| it.address.as_str())
    }

    /// Which files a walk of folders finds.
    pub fn walk_options(&self) -> WalkOptions {
        let words = |it: &[Spanned<String>]| it.iter().map(|it| it.get_ref().clone()).collect();
        WalkOptions {
            root: self.0.folders.root.clone(),
            include: words(&self.0.file.files.include),
            exclude: words(&self.0.file.files.exclude),
            gitignore: true,
        }
    }

    /// A path below the configuration's folder, from there.
    fn relative(&self, path: &str) -> Option<PathBuf> {
        let Folders { root, current } = &self.0.folders;
        normal(&current.join(path)).strip_prefix(normal(root)).ok().map(Path::to_owned)
    }
}

/// A path without `.` and `..`, found without looking at the file system.
fn normal(path: &Path) -> PathBuf {
    let mut out = PathBuf::new();
    for component in path.components() {
        match component {
            Component::CurDir => {}
            Component::ParentDir => {
                out.pop();
            }
            other => out.push(other),
        }
    }
    out
}

fn matches(glob: &Gitignore, path: &Path) -> bool {
    !path.as_os_str().is_empty() && glob.matched_path_or_any_parents(path, false).is_ignore()
}

fn active(base: &Selection, per_file: &[PerFileRules]) -> Vec<&'static Rule> {
    let mut selection = base.clone();
    per_file.iter().for_each(|it| selection.select(&it.select));
    selection.rules().collect()
}

fn selection(
    registry: &'static [Rule],
    text: &Text<'_>,
    rules: &Rules,
    overrides: &Overrides,
) -> Result<Selection, ConfigError> {
    let option = |name: &'static str, words: &[String]| -> Result<Vec<Selector>, ConfigError> {
        let parse = |word: &String| {
            Selector::parse(registry, word)
                .map_err(|it| ConfigError { origin: Origin::Option(name), message: it.to_string() })
        };
        words.iter().map(parse).collect()
    };
    let mut selection = Selection::none(registry);
    match &rules.select {
        Some(words) => selection.select(&text.selectors(registry, words)?),
        None => selection.select(&[Selector::Default]),
    }
    selection.select(&text.selectors(registry, &rules.extend_select)?);
    selection.ignore(&text.selectors(registry, &rules.ignore)?);
    if let Some(words) = &overrides.select {
        selection.clear();
        selection.select(&option("--select", words)?);
    }
    selection.select(&option("--extend-select", &overrides.extend_select)?);
    selection.ignore(&option("--ignore", &overrides.ignore)?);

    let mut severities = Vec::new();
    for (word, level) in &rules.severity {
        let Some(severity) = Severity::parse(level.get_ref()) else {
            let message = format!("`{}` is no severity: write `error`, `warning` or `note`", level.get_ref());
            return Err(text.error(Some(level.span()), message));
        };
        severities.push((text.selector(registry, word)?, severity));
    }
    // In the file, what is said of a rule counts more than what is said of its group.
    severities.sort_by_key(|it| match it.0 {
        Selector::All => 0,
        Selector::Default => 1,
        Selector::Group(_) => 2,
        Selector::Rule(_) => 3,
    });
    for (word, severity) in &overrides.severity {
        let selector = option("--severity", std::slice::from_ref(word))?;
        severities.extend(selector.into_iter().map(|it| (it, *severity)));
    }
    for (selector, severity) in severities {
        selection.set_severity(selector, severity);
    }
    Ok(selection)
}

/// Whether the tables know a controller.
fn controller(name: &str) -> Result<(), String> {
    name.parse::<Target>().map(drop).map_err(|it| it.to_string())
}

/// Judges the keys that only controllers of PL7-2 have by the controller that they are written for.
fn of_pl7_2(text: &Text<'_>, file: &TargetConfig) -> Result<(), ConfigError> {
    if let Some(bytes) = file.program_memory.as_ref().filter(|it| *it.get_ref() == 0) {
        return Err(text.error(Some(bytes.span()), "`program-memory` is a number of bytes, such as `24576`"));
    }
    let Some(target) = file.controller.as_ref().and_then(|it| it.get_ref().parse::<Target>().ok()) else {
        return Ok(());
    };
    let name = target.controller().unwrap_or("controller of a series");
    let controller = target.pl72().and_then(|it| it.controller);
    let channels = [("run-stop-input", &file.run_stop_input), ("security-output", &file.security_output)];
    for (key, value) in channels {
        if let Some(value) = value.as_ref().filter(|_| controller.is_none_or(|it| it.series != Series::Tsx17)) {
            let message = format!("only a TSX 17-20 has `{key}` (PL72:148-152), and the controller is a {name}");
            return Err(text.error(Some(value.span()), message));
        }
    }
    if let Some(value) = file.program_memory.as_ref().filter(|_| controller.is_none()) {
        let message = format!("`program-memory` is of the controllers of PL7-2, and the controller is a {name}");
        return Err(text.error(Some(value.span()), message));
    }
    Ok(())
}

/// Judges `[objects]` by the controller that it is written for, or by every one when none is named.
fn counts(text: &Text<'_>, file: &File, overrides: &Overrides) -> Result<(), ConfigError> {
    let named = file.target.controller.as_ref().map(|it| it.get_ref()).or(overrides.controller.as_ref());
    let named = named.and_then(|it| it.parse::<Target>().ok());
    let targets: Vec<Target> = match named {
        Some(it) => vec![it],
        None => [Family::Pl7, Family::Step7].map(Target::any).into(),
    };
    for (key, count) in &file.objects {
        let numbered = |target: &Target| {
            let numbered = target.all_numbered().iter();
            numbered.clone().find(|it| it.key == key.get_ref() && !it.key.is_empty())
        };
        let known: Vec<_> = targets.iter().filter_map(|it| Some((it, numbered(it)?))).collect();
        // Of several families that know the key, it is enough when one has as many.
        let too_many = |(target, numbered): &(&Target, &crate::target::Numbered)| {
            let most = target.count(numbered.what).filter(|it| *count.get_ref() > it.value)?;
            let of = match most.by {
                CountedBy::Controller(name) => format!("a {name} has"),
                CountedBy::Family | CountedBy::Configuration => "the largest controller has".to_owned(),
            };
            Some(format!("{of} {} {} at most ({})", most.value, numbered.plural, most.source))
        };
        let errors: Vec<String> = known.iter().filter_map(too_many).collect();
        if known.is_empty() {
            let keys = targets.iter().flat_map(Target::all_numbered).map(|it| it.key).filter(|it| !it.is_empty());
            let mut keys: Vec<&str> = keys.collect();
            keys.sort_unstable();
            keys.dedup();
            let message = format!("no objects are counted as `{}`; known: {}", key.get_ref(), keys.join(", "));
            return Err(text.error(Some(key.span()), message));
        }
        if errors.len() == known.len() {
            return Err(text.error(Some(count.span()), errors.join("; ")));
        }
    }
    let configured = |what: Counted| {
        let key = Target::any(Family::Pl7).numbered(what)?.key;
        file.objects.iter().find(|it| it.0.get_ref() == key).map(|it| it.1)
    };
    if let (Some(timers), Some(old)) = (configured(Counted::Timers), configured(Counted::OldTimers))
        && let Some(most) = targets.first().and_then(Target::all_timers)
        && timers.get_ref().saturating_add(*old.get_ref()) > most.value
    {
        let sum = timers.get_ref().saturating_add(*old.get_ref());
        let message = format!("`TM` and `T` are {sum} timers, and {} are the most ({})", most.value, most.source);
        return Err(text.error(Some(old.span()), message));
    }
    Ok(())
}

/// Reads the name of an encoding; `auto` is none.
fn encoding(name: &str) -> Result<Option<Encoding>, String> {
    Encoding::parse_option(name).map_err(|it| it.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lint::testing::RULES;

    fn folders() -> Folders {
        Folders { root: "/plant".into(), current: "/plant/line1".into() }
    }

    fn parse(text: &str) -> Result<Settings, ConfigError> {
        parse_with(text, Overrides::default())
    }

    fn parse_with(text: &str, overrides: Overrides) -> Result<Settings, ConfigError> {
        Settings::parse_with(RULES, text, Path::new(FILE_NAME), folders(), overrides)
    }

    fn on(settings: &Settings, path: &str) -> Vec<&'static str> {
        settings.selection(path).rules().map(|it| it.code).collect()
    }

    fn rule(code: &str) -> &'static Rule {
        RULES.iter().find(|it| it.code == code).unwrap()
    }

    #[test]
    fn every_table_is_read() {
        let settings = parse(
            r#"
            [target]
            controller = "TSX 37-22"
            version = "V3"
            [objects]
            M = 256
            [files]
            include = ["src/**"]
            exclude = ["old/"]
            encoding = "windows-1252"
            [[entity]]
            path = "poste1.st"
            address = "MAST SR3"
            [[task]]
            name = "FAST"
            period = "20ms"
            io = ["%I3.8:8"]
            [[event]]
            number = 1
            trigger = "%I1.0"
            [[section]]
            address = "MAST - Pump"
            condition = "%M5"
            [[module]]
            position = 4
            outputs = 8
            [program]
            scope = "folder"
            [rules]
            select = ["W"]
            extend-select = ["unused-label"]
            [rules.severity]
            W001 = "error"
            [rules.options.W001]
            limit = 3
            [[per-file]]
            path = "legacy/**"
            ignore = ["W"]
            "#,
        )
        .unwrap();
        assert_eq!((settings.controller(), settings.version()), (Some("TSX 37-22"), Some("V3")));
        assert_eq!((settings.objects("M"), settings.objects("MW")), (Some(256), None));
        assert_eq!(settings.encoding(), Some(Encoding::Windows1252));
        assert_eq!(settings.entity_address("sub/poste1.st"), Some("MAST SR3"));
        assert_eq!(settings.entity_address("poste2.st"), None);
        assert_eq!(settings.tasks()[0].io[0].get_ref().0.text, "%I3.8:8");
        let period = settings.tasks()[0].period.as_ref().unwrap();
        assert_eq!(*period.get_ref(), Milliseconds(20));
        let place = settings.place(settings.site(period)).unwrap();
        assert_eq!(&settings.source().text[place], "\"20ms\"");
        let place = settings.place(settings.site(&settings.tasks()[0].io[0])).unwrap();
        assert_eq!(&settings.source().text[place], "\"%I3.8:8\"");
        assert_eq!(settings.source().path, FILE_NAME);
        assert_eq!(settings.events()[0].trigger.as_ref().map(|it| it.get_ref().0.text.as_str()), Some("%I1.0"));
        let condition =
            |address| settings.condition_of(&entity_from_address(address).unwrap()).map(|it| it.text.as_str());
        for address in ["MAST - PUMP", "MAST - Pump - PRL", "MAST - Pump - CHART - PAGE 0 %X1 P1"] {
            assert_eq!(condition(address), Some("%M5"), "{address}");
        }
        for address in ["MAST - MAIN", "FAST - Pump", "MAST - SR1", "EVT1"] {
            assert_eq!(condition(address), None, "{address}");
        }
        assert_eq!((settings.output_channels(4).map(|it| it.0), settings.output_channels(5)), (Some(8), None));
        assert_eq!(settings.scope(), ProgramScope::Folder);
        assert_eq!(on(&settings, "a.st"), ["J005", "W001"]);
        assert_eq!(on(&settings, "../legacy/deep/a.st"), ["J005"]);
        assert_eq!(settings.enabled(rule("W001"), "a.st"), Some(Severity::Error));
        assert_eq!(settings.enabled(rule("W001"), "/plant/legacy/a.st"), None);
        assert_eq!(settings.options("single-write").unwrap()["limit"].as_integer(), Some(3));
        assert_eq!(settings.active().len(), 2);
    }

    #[test]
    fn globs_start_at_the_configuration() {
        let text =
            "[[per-file]]\npath = '/line1/old/'\nignore = ['all']\n[files]\ninclude = ['src']\nexclude = ['old/']";
        let settings = parse(text).unwrap();
        let is_on = |path: &str| settings.enabled(rule("W001"), path).is_some();
        assert!(!is_on("old/a.st") && !is_on("./x/../old/sub/a.st") && !is_on("/plant/line1/old/a.st"));
        assert!(is_on("../old/a.st") && is_on("/elsewhere/line1/old/a.st") && is_on("old"));
        let options = settings.walk_options();
        assert_eq!(
            (options.root, options.include, options.exclude),
            ("/plant".into(), vec!["src".into()], vec!["old/".into()])
        );
    }

    #[test]
    fn configuration_of_pl7_2_controllers() {
        let text = "[target]\ncontroller = 'TSX 17-20'\nrun-stop-input = true\nprogram-memory = 24576\n[[task]]\n\
                    name = 'FAST'\nio = ['I0,00[8]', 'O0,08[8]', 'O0,00']";
        let settings = parse(text).unwrap();
        assert!(settings.run_stop_input().is_some() && settings.security_output().is_none());
        assert_eq!(settings.program_memory().map(|it| *it.get_ref()), Some(24_576));
        let output = |text: &str| object::pl72::parse(text).unwrap().object;
        assert_eq!(settings.task_of(&output("O0,15")), Some(Context::Fast));
        assert_eq!(settings.task_of(&output("O0,07")), Some(Context::Cyclic));
        let other = Overrides { controller: Some("TSX 27".into()), ..Overrides::default() };
        let settings = parse_with(text, other).unwrap();
        assert!(settings.run_stop_input().is_none() && settings.program_memory().is_none());
    }

    #[test]
    fn errors_say_where() {
        let error = |text: &str| parse(text).unwrap_err().to_string();
        assert_eq!(
            error("[rules]\nignore = ['W001', 'singel-write']\n"),
            "plclint.toml:2:19: no rule or group is called `singel-write`; did you mean `single-write`?"
        );
        assert!(
            error("[rules.severity]\nÜ = 'error'").starts_with("plclint.toml:2:1: "),
            "{}",
            error("[rules.severity]\nÜ = 'error'")
        );
        assert!(error("[rules.severity]\nsingel-write = 'error'").starts_with("plclint.toml:2:1: no rule"));
        assert_eq!(
            error("[rules.severity]\nW001 = 'fatal'"),
            "plclint.toml:2:8: `fatal` is no severity: write `error`, `warning` or `note`"
        );
        assert!(error("[rules.options.W]\nx = 1").contains("is not one rule"));
        assert!(error("[rules]\nselekt = []").starts_with("plclint.toml:2:1: unknown field `selekt`"));
        assert!(error("[[per-file]]\nignore = []").contains("missing field `path`"));
        assert!(error("[target]\ncontroller = 'TSX 99'").starts_with("plclint.toml:2:14: unknown controller"));
        let message = error("[target]\ncontroller = 'TSX 27'\nversion = 'new'");
        assert!(message.starts_with("plclint.toml:3:11: unknown version"), "{message}");
        assert_eq!(
            error("[target]\ncontroller = 'TSX 27'\nrun-stop-input = true"),
            "plclint.toml:3:18: only a TSX 17-20 has `run-stop-input` (PL72:148-152), and the controller is a TSX 27"
        );
        let message = error("[target]\ncontroller = 'TSX 37-22'\nprogram-memory = 8192");
        assert!(message.starts_with("plclint.toml:3:18: `program-memory` is of the controllers of PL7-2"), "{message}");
        assert!(error("[target]\nprogram-memory = 0").starts_with("plclint.toml:2:18: "));
        assert!(error("[target]\nsecurity-output = 'yes'").starts_with("plclint.toml:2:19: "));
        assert!(error("[files]\nencoding = 'windows-1225'").starts_with("plclint.toml:2:12: unknown encoding"));
        assert!(error("[files]\nexclude = ['a{']").starts_with("plclint.toml:2:12: "));
        assert!(error("x = ").starts_with("plclint.toml:1:5: "), "{}", error("x = "));
        assert!(error("[program]\nscope = 'galaxy'").contains("unknown variant"));
        assert!(error("[[event]]\nnumber = 1\ntrigger = '%M1'").starts_with("plclint.toml:3:11: `%M1` is no input"));
        let section = |address: &str, condition: &str| {
            error(&format!("[[section]]\naddress = '{address}'\ncondition = '{condition}'"))
        };
        for address in ["MAST - SR1", "MAST - Pump - PRL", "EVT1", "OB1", "PL7-2 MAST", "Pump", ""] {
            assert!(section(address, "%M5").starts_with("plclint.toml:2:11: "), "{}", section(address, "%M5"));
        }
        for condition in ["Pump", "", "%M", "%M5[%MW1", "%M5[x]"] {
            let message = section("MAST - Pump", condition);
            assert!(message.starts_with("plclint.toml:3:13: ") && message.contains("is no object"), "{message}");
        }
        let twice = "[[section]]\naddress = 'MAST - A'\ncondition = '%M1'\n";
        assert!(error(&format!("{twice}{twice}")).starts_with("plclint.toml:5:11: this section has a condition"));
        assert!(error("[[module]]\nposition = 1\n[[module]]\nposition = 1").starts_with("plclint.toml:4:12: "));
        assert!(error("[[module]]\nposition = 1\noutputs = 129").contains("128 channels"));
        assert!(error("[[task]]\nname = 'FAST'\nperiod = '20'").contains("`20` is no time in milliseconds"));
    }

    #[test]
    fn the_command_line_is_a_layer_above_the_file() {
        let text = "[rules]\nselect = ['J']\nignore = ['J001']\n[target]\ncontroller = 'CPU 314'\nversion = 'V2'";
        let words = |it: &[&str]| it.iter().map(|it| (*it).to_owned()).collect::<Vec<_>>();
        let select = Overrides { select: Some(words(&["J001"])), ..Overrides::default() };
        assert_eq!(on(&parse_with(text, select).unwrap(), "a"), ["J001"]);
        let extend = Overrides { extend_select: words(&["all"]), ignore: words(&["W"]), ..Overrides::default() };
        assert_eq!(on(&parse_with(text, extend).unwrap(), "a"), ["I004", "J001", "J005", "X003"]);
        let target = Overrides { controller: Some("TSX 37-22".into()), ..Overrides::default() };
        let settings = parse_with(text, target).unwrap();
        assert_eq!((settings.controller(), settings.version()), (Some("TSX 37-22"), None));
        let wrong = Overrides { ignore: words(&["W01"]), ..Overrides::default() };
        assert_eq!(
            parse_with(text, wrong).unwrap_err().to_string(),
            "--ignore: no rule or group is called `W01`; did you mean `W001`?"
        );
    }

    #[test]
    fn a_rule_counts_more_than_its_group() {
        let text = "[rules.severity]\nunbalanced-parentheses = 'note'\nall = 'error'\nX = 'warning'";
        let settings = parse(text).unwrap();
        assert_eq!(settings.enabled(rule("I004"), "a"), Some(Severity::Advice));
        assert_eq!(settings.enabled(rule("X003"), "a"), Some(Severity::Warning));
        assert_eq!(settings.enabled(rule("W001"), "a"), Some(Severity::Error));
    }

    #[test]
    fn counts_are_those_of_the_controller_they_are_written_for() {
        use crate::target::Count;

        let count = |text: &str, overrides: Overrides, family: Family, what: Counted| {
            parse_with(text, overrides).unwrap().target(family).count(what)
        };
        let none = Overrides::default;
        let configured =
            |value: u32, key: &'static str| Some(Count { value, by: CountedBy::Configuration, source: key });
        let text = "[target]\ncontroller = 'TSX 37-22'\n[objects]\nMW = 1000\nTM = 32";
        assert_eq!(count(text, none(), Family::Pl7, Counted::Words), configured(1000, "MW"));
        assert_eq!(count(text, none(), Family::Pl7, Counted::Timers), configured(32, "TM"));
        let bits = count(text, none(), Family::Pl7, Counted::Bits);
        assert_eq!(bits, Some(Count { value: 256, by: CountedBy::Controller("TSX 37-22"), source: "PL7:1523" }));
        let other = count(text, none(), Family::Step7, Counted::Timers).unwrap();
        assert_eq!((other.value, other.by), (2048, CountedBy::Family), "no count of another family's controller");

        // The same controller in another spelling, and another one.
        let target = |name: &str| Overrides { controller: Some(name.into()), ..Overrides::default() };
        assert_eq!(count(text, target("tsx3722"), Family::Pl7, Counted::Words), configured(1000, "MW"));
        let words = count(text, target("TSX 57-453"), Family::Pl7, Counted::Words).unwrap();
        assert_eq!((words.value, words.by), (31_232, CountedBy::Controller("TSX 57-453")));

        // Without a controller, a key counts for each family that has it.
        let text = "[objects]\nM = 128\nT = 200\nZ = 16";
        assert_eq!(count(text, none(), Family::Pl7, Counted::Bits), configured(128, "M"));
        assert_eq!(count(text, none(), Family::Pl7, Counted::OldTimers), configured(200, "T"));
        assert_eq!(count(text, none(), Family::Step7, Counted::Bytes), configured(128, "M"));
        assert_eq!(count(text, none(), Family::Step7, Counted::Timers), configured(200, "T"));
        assert_eq!(count(text, none(), Family::Step7, Counted::Counters), configured(16, "Z"));
    }

    #[test]
    fn wrong_counts_have_a_place() {
        let error = |text: &str| parse(text).unwrap_err().to_string();
        let micro = "[target]\ncontroller = 'TSX 37-22'\n[objects]\n";
        assert_eq!(
            error(&format!("{micro}MZ = 1")),
            "plclint.toml:4:1: no objects are counted as `MZ`; known: C, DR, KW, M, MN, MW, R, T, TM, X, XM"
        );
        assert!(error("[objects]\nmw = 1").starts_with("plclint.toml:2:1: no objects are counted as `mw`; known: C,"));
        assert_eq!(
            error(&format!("{micro}M = 300")),
            "plclint.toml:4:5: a TSX 37-22 has 256 internal bits at most (PL7:1523)"
        );
        assert_eq!(
            error(&format!("{micro}XM = 1")),
            "plclint.toml:4:6: a TSX 37-22 has 0 macro-steps at most (PL7:4280)"
        );
        assert_eq!(
            error(&format!("{micro}TM = 40\nT = 30")),
            "plclint.toml:5:5: `TM` and `T` are 70 timers, and 64 are the most (PL7:999)"
        );
        assert_eq!(
            error("[objects]\nM = 32635"),
            "plclint.toml:2:5: the largest controller has 32634 internal bits at most (PL7:1691); the largest controller \
             has 16384 bytes of memory at most (the vendor's general documentation)"
        );
        assert!(error("[objects]\nTM = 300").starts_with("plclint.toml:2:6: the largest controller has 255 timers"));
        assert!(error(&format!("{micro}Z = 1")).contains("no objects are counted as `Z`"));
        assert!(error("[objects]\nM = -1").starts_with("plclint.toml:2:5: "));
        assert!(error("[objects]\nM = 'all'").starts_with("plclint.toml:2:5: "));
        // %KW has no end but the program's size, and a system's number of bits is not configured.
        assert!(parse(&format!("{micro}KW = 20000\nTM = 64")).is_ok());
        assert!(error(&format!("{micro}'' = 1")).contains("no objects are counted as ``"));
    }

    #[test]
    fn equal_words_are_equal_settings() {
        let text = "[rules]\nignore = ['W']";
        assert_eq!(parse(text).unwrap(), parse(text).unwrap());
        assert_ne!(parse(text).unwrap(), parse("").unwrap());
        assert_eq!(Settings::default(), Settings::default());
    }
}
