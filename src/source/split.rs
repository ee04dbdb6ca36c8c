//! A file's text into units: blocks, listings, sections, subroutines, chart pieces, and the blocks of an exchange file.
//!
//! One cheap pass over the lines, run on every edit, so that an edit re-parses one unit. A unit starts after the last
//! code of the one before: blank lines and comments belong to what they precede.
//!
//! **Invariant:** the units tile the text, in order, and there is at least one; their keys differ, and hang on the
//! unit's own heading and on earlier units of the same name only.

use std::ops::Range;

use rowan::{TextRange, TextSize};
use rustc_hash::{FxHashMap, FxHashSet};
use smol_str::{SmolStr, format_smolstr};

use super::detect::{Detected, Pl7Text, operands_of, pl7_text, unsupported};
use super::edit::difference;
use super::heading::{
    Heading, HeadingLanguage, block_end, block_header, exchange_block, listing_name, pl7_2_entity, pl7_address,
    pl7_heading, step5_code, step5_heading, strip_prefix_ignore_case, word,
};
use super::scan::{Comments, Lines};
use crate::model::entity::{Entity, Family, Part, Task};
use crate::syntax::{self, Language, Mnemonics};

/// A piece of a file that is parsed and checked by itself.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct UnitSpan {
    /// Unique in the file; the same before and after an edit elsewhere in it.
    pub key: SmolStr,
    pub entity: Entity,
    /// Says nothing if the unit is unsupported.
    pub language: Language,
    /// Bytes of the file's text.
    pub range: TextRange,
    /// The name of the form that the unit is in, if it is one that is not read: the unit must be reported, not parsed.
    pub unsupported: Option<&'static str>,
    /// Whether a heading, a header or the configuration says what the unit is, of pages that of their chart; else it may be
    /// a listing out of something larger.
    pub is_named: bool,
}

/// What the configuration says of a file that does not say it itself.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Default)]
pub struct SplitHint {
    /// What code without a heading is.
    pub entity: Option<Entity>,
    /// The mnemonics of STEP 7 code; without, they are found by vote.
    pub mnemonics: Option<Mnemonics>,
}

/// Cuts a text into units. Total and linear for every text; of a text beyond 4 GiB the ranges are cut short.
pub fn split(text: &str, detected: Detected, hint: &SplitHint) -> Vec<UnitSpan> {
    let mut units = Units { text, drafts: Vec::new(), code_end: 0 };
    match detected {
        Detected::Step7 => step7(&mut units, hint),
        Detected::Step5 => step5(&mut units, hint),
        Detected::Step5Symbols => units.push(0, Draft::new(Entity::Container, Some(Language::Step5Symbols))),
        Detected::Pasted(default) => pasted(&mut units, || default, Family::Pl7, hint),
        Detected::Exchange => exchange(&mut units, Family::Pl7),
        Detected::Pl72Exchange => exchange(&mut units, Family::Pl72),
        Detected::Step7Symbols => units.push(0, Draft::new(Entity::Container, Some(Language::SymbolTable))),
        Detected::Stx => project(&mut units),
        Detected::Pl72 => pasted(&mut units, || pl7_2_text(text), Family::Pl72, hint),
        Detected::Unsupported { what: form } | Detected::Unreadable { why: form } => {
            units.push(0, Draft { unsupported: Some(form), ..Draft::container() });
        }
        Detected::NotPlc => units.push(0, Draft { unsupported: Some("not a PLC program"), ..Draft::container() }),
    }
    units.finish()
}

/// What [`split`] makes of `new`, found without reading all of it: an edit inside of one unit leaves the cuts around it
/// where they are. `None` when that is not sure; `spans` is what [`split`] made of `old`.
///
/// The edited unit is cut again together with the next one, whose text is the same: where both come out as they were,
/// the text behind them starts in the same state as before.
pub fn resplit(
    old: &str,
    spans: &[UnitSpan],
    new: &str,
    detected: Detected,
    hint: &SplitHint,
) -> Option<Vec<UnitSpan>> {
    let is_own = |it: &UnitSpan| match detected {
        Detected::Step7 | Detected::Step5 => matches!(it.entity, Entity::Block { .. }),
        Detected::Pasted(_) | Detected::Pl72 => true,
        _ => false,
    };
    let (changed, changed_end) = difference(old, new);
    let start = |it: &UnitSpan| usize::from(it.range.start());
    let end = |it: &UnitSpan| usize::from(it.range.end());
    let at = spans.partition_point(|it| end(it) <= changed).min(spans.len().checked_sub(1)?);
    let (unit, next) = (&spans[at], spans.get(at + 1));
    // Of a unit that starts within a line, the blanks before it are the one's before.
    let starts_line = at == 0 || old[..start(unit)].ends_with(['\n', '\r']);
    if changed_end > end(unit) || !starts_line || !is_own(unit) || next.is_some_and(|it| !is_own(it)) {
        return None;
    }
    let moved = |offset: usize| (offset + new.len()).checked_sub(old.len());
    let part = new.get(start(unit)..moved(next.map_or(end(unit), end))?)?;
    let mut hint = hint.clone();
    if let (Detected::Step7, Language::Awl(before)) | (Detected::Step5, Language::Step5(before)) =
        (detected, unit.language)
    {
        let vote = if detected == Detected::Step5 { syntax::step5::vote } else { mnemonics };
        if hint.mnemonics.is_none() && vote(new) != before {
            return None;
        }
        hint.mnemonics = Some(before);
    }
    let cut = split(part, detected, &hint);
    let same = |a: &UnitSpan, b: &UnitSpan| {
        let kind = |it: &UnitSpan| (it.language, it.unsupported, it.is_named);
        a.entity == b.entity && kind(a) == kind(b)
    };
    let expected: Vec<&UnitSpan> = [unit].into_iter().chain(next).collect();
    let is_same = cut.len() == expected.len() && cut.iter().zip(expected).all(|(a, b)| same(a, b));
    // Without a heading of its own, only the first unit is what the hint says.
    let is_named = at == 0 || heading_of(part, detected);
    let border = moved(end(unit))?;
    if !is_same || !is_named || cut.first().is_none_or(|it| start(unit) + end(it) != border) {
        return None;
    }
    let offset = |at: usize| TextSize::try_from(at).ok();
    let mut result = spans[..at].to_vec();
    result.push(UnitSpan { range: TextRange::new(unit.range.start(), offset(border)?), ..unit.clone() });
    for it in &spans[at + 1..] {
        result.push(UnitSpan {
            range: TextRange::new(offset(moved(start(it))?)?, offset(moved(end(it))?)?),
            ..it.clone()
        });
    }
    Some(result)
}

/// Whether the first line of code in a unit's text is what names the unit.
fn heading_of(part: &str, detected: Detected) -> bool {
    if detected == Detected::Step5 {
        return part.split(['\n', '\r']).map(step5_code).find(|it| !it.is_empty()).and_then(step5_heading).is_some();
    }
    let comments = if detected == Detected::Step7 { Comments::Step7 } else { Comments::Pl7 };
    let mut codes = Lines::new(part, comments).map(|it| it.code).filter(|it| !it.is_empty() && !it.starts_with("//"));
    codes.next().is_some_and(|it| match detected {
        Detected::Step7 => block_header(it).is_some(),
        _ => pl7_heading(it).is_some() || dfb_header(it).is_some(),
    })
}

/// The first line of code in the text of a PL7 unit, by bytes.
pub fn first_code(text: &str) -> Option<Range<usize>> {
    let line = Lines::new(text, Comments::Pl7).find(|it| !it.code.is_empty())?;
    Some(line.code_start..line.code_start + line.code.trim_end().len())
}

/// A unit whose end is not known yet.
#[derive(Debug, Clone)]
struct Draft {
    start: usize,
    /// What the key is made of, where the entity does not tell units apart.
    label: Option<SmolStr>,
    entity: Entity,
    /// `None` is PL7, in the language that the text looks like.
    language: Option<Language>,
    unsupported: Option<&'static str>,
    is_named: bool,
}

impl Draft {
    fn container() -> Self {
        Self::new(Entity::Container, Some(Language::Exchange))
    }

    fn new(entity: Entity, language: Option<Language>) -> Self {
        Self { start: 0, label: None, entity, language, unsupported: None, is_named: true }
    }

    fn name(&self) -> SmolStr {
        self.label.clone().unwrap_or_else(|| format_smolstr!("{}", self.entity))
    }
}

struct Units<'t> {
    text: &'t str,
    drafts: Vec<Draft>,
    /// After the last line with code.
    code_end: usize,
}

impl Units<'_> {
    /// A page of the chart that the last draft belongs to: the draft itself when it has no page yet. `pages` counts them.
    fn page(&mut self, page: u32, pages: &mut u32) {
        *pages += 1;
        let at = self.code_end;
        let Some(last) = self.drafts.last_mut() else { return };
        if *pages == 1 {
            name_page(&mut last.entity, page);
        } else {
            let mut draft = last.clone();
            name_page(&mut draft.entity, page);
            self.push(at, draft);
        }
    }

    /// Whether the last draft is of a chart.
    fn in_chart(&self) -> bool {
        self.drafts.last().is_some_and(|it| matches!(it.language, Some(Language::Pl7Gr7 | Language::Pl72Gr7)))
    }

    /// Of the first drafts, which no heading names in a text with headings: their own operands say whose they are.
    fn let_operands_decide(&mut self, count: usize, family: Family) {
        let family = operands_of(self.text.get(..self.code_end).unwrap_or_default()).unwrap_or(family);
        for draft in self.drafts.iter_mut().take(count) {
            draft.language = draft.language.map(|it| of_family(it, family));
        }
    }

    fn push(&mut self, start: usize, draft: Draft) {
        self.drafts.push(Draft { start, ..draft });
    }

    fn finish(mut self) -> Vec<UnitSpan> {
        if let Some(first) = self.drafts.first_mut() {
            first.start = 0;
        }
        let offset = |at: usize| TextSize::new(u32::try_from(at).unwrap_or(u32::MAX));
        let ends: Vec<_> = self.drafts.iter().skip(1).map(|draft| draft.start).chain([self.text.len()]).collect();
        let mut keys = Keys::default();
        let span = |(draft, end): (Draft, usize)| {
            let (language, unsupported) = match draft.language {
                Some(language) => (language, draft.unsupported),
                None => {
                    let text = self.text.get(draft.start..end).unwrap_or_default();
                    let is_dfb = matches!(draft.entity, Entity::Dfb { .. });
                    (if is_dfb { dfb_language(text) } else { pl7_language(pl7_text(text)) }, draft.unsupported)
                }
            };
            UnitSpan {
                key: keys.unique(draft.name()),
                entity: draft.entity,
                language,
                range: TextRange::new(offset(draft.start), offset(end)),
                unsupported,
                is_named: draft.is_named,
            }
        };
        self.drafts.into_iter().zip(ends).map(span).collect()
    }
}

/// Makes the second unit of a name `name#2`.
#[derive(Default)]
struct Keys {
    used: FxHashSet<SmolStr>,
    repeats: FxHashMap<SmolStr, u32>,
}

impl Keys {
    fn unique(&mut self, name: SmolStr) -> SmolStr {
        if self.used.insert(name.clone()) {
            return name;
        }
        let repeat = self.repeats.entry(name.clone()).or_insert(1);
        // A unit may be called `name#2` itself. Each miss uses up such a unit, so the time stays linear.
        loop {
            *repeat += 1;
            let key = format_smolstr!("{name}#{repeat}");
            if self.used.insert(key.clone()) {
                return key;
            }
        }
    }
}

fn pl7_language(text: Pl7Text) -> Language {
    match text {
        Pl7Text::Il => Language::Pl7Il,
        Pl7Text::St => Language::Pl7St,
        Pl7Text::Ld => Language::Pl7Ld,
        Pl7Text::Gr7 => Language::Pl7Gr7,
        Pl7Text::Sfc => Language::Sfc,
    }
}

/// The language of the code of a DFB type that does not say it.
fn dfb_language(text: &str) -> Language {
    let code = text.lines().skip_while(|it| !word(it.trim_start()).0.eq_ignore_ascii_case("END_VAR"));
    if code.clone().any(|it| word(it.trim_start()).0.eq_ignore_ascii_case("RUNG")) {
        return Language::Pl7Ld;
    }
    let is_code = |it: &&str| !word(it.trim_start()).0.to_ascii_uppercase().contains("VAR");
    match pl7_text(&code.filter(is_code).collect::<Vec<_>>().join("\n")) {
        Pl7Text::Il => Language::Pl7Il,
        _ => Language::Pl7St,
    }
}

/// `PAGE 3`, the line that starts a page of a chart: its number.
fn page_line(code: &str) -> Option<u32> {
    if !code.starts_with(['P', 'p']) {
        return None;
    }
    let (first, rest) = word(code);
    let number = word(rest.trim_start()).0;
    first.eq_ignore_ascii_case("PAGE").then(|| number.parse().ok())?
}

/// Names a unit of a chart after its page.
fn name_page(entity: &mut Entity, page: u32) {
    if let Entity::Pl7 { part: part @ (Part::Chart(_) | Part::Main), .. } = entity {
        let graph = match &*part {
            Part::Chart(rest) => rest.split(' ').next().filter(|it| !it.is_empty()).unwrap_or("CHART").to_owned(),
            _ => "CHART".to_owned(),
        };
        *part = Part::Chart(format_smolstr!("{graph} - PAGE {page}"));
    }
}

/// STEP 7: block headers, and names of bare listings where no block is open.
fn step7(units: &mut Units<'_>, hint: &SplitHint) {
    let text = units.text;
    let language = Language::Awl(hint.mnemonics.unwrap_or_else(|| mnemonics(text)));
    let draft = |entity| Draft::new(entity, Some(language));
    /// What the next line of code belongs to.
    #[derive(PartialEq)]
    enum Open {
        Nothing,
        Listing,
        Block,
    }
    let mut open = Open::Nothing;
    let mut has_headers = false;
    for line in Lines::new(text, Comments::Step7) {
        let mut code = line.code;
        if code.is_empty() {
            continue;
        }
        let mut start = units.code_end;
        if open == Open::Block
            && let Some(rest) = block_end(code)
        {
            // The header of the next block may share the line.
            open = Open::Nothing;
            code = rest.trim_start_matches(|c: char| c.is_whitespace() || c == ';');
            start = line.code_start + (line.code.len() - code.len());
        }
        if code.is_empty() || code.starts_with("//") {
            // Nothing is left of the line.
        } else if let Some(entity) = block_header(code) {
            units.push(start, draft(entity));
            open = Open::Block;
            has_headers = true;
        } else if open != Open::Block
            && let Some(entity) = listing_name(code)
        {
            units.push(start, draft(entity));
            open = Open::Listing;
        } else if open == Open::Nothing {
            units.push(start, draft(Entity::Container));
            open = Open::Listing;
        }
        units.code_end = line.end;
    }
    if units.drafts.is_empty() {
        units.push(0, draft(Entity::Container));
    }
    if !has_headers {
        // Without a header anywhere, code that nothing names is a program, not text around one.
        let unnamed = hint.entity.clone().unwrap_or(Entity::Listing);
        for draft in &mut units.drafts {
            if draft.entity == Entity::Container {
                draft.entity = unnamed.clone();
            }
        }
    }
}

/// STEP 5: headings of blocks, and code before the first one.
fn step5(units: &mut Units<'_>, hint: &SplitHint) {
    let text = units.text;
    let language = Language::Step5(hint.mnemonics.unwrap_or_else(|| syntax::step5::vote(text)));
    let mut end = 0;
    for line in text.split_inclusive(['\n', '\r']) {
        end += line.len();
        let code = step5_code(line);
        if code.is_empty() {
            continue;
        }
        if let Some(entity) = step5_heading(code) {
            units.push(units.code_end, Draft::new(entity, Some(language)));
        } else if units.drafts.is_empty() {
            units.push(0, Draft::new(Entity::Container, Some(language)));
        }
        units.code_end = end;
    }
    match units.drafts.as_mut_slice() {
        [] => units.push(0, Draft::new(Entity::Container, Some(language))),
        // Code that nothing names is a program, not text around one.
        [only] if only.entity == Entity::Container => only.entity = hint.entity.clone().unwrap_or(Entity::Listing),
        _ => {}
    }
}

/// The mnemonic set of a file.
fn mnemonics(text: &str) -> Mnemonics {
    crate::syntax::awl::vote(text).unwrap_or(if memchr::memmem::find(text.as_bytes(), "«".as_bytes()).is_some() {
        // Only French documents quote symbols so, and they use the German set.
        Mnemonics::German
    } else {
        Mnemonics::English
    })
}

/// PL7 and PL7-2 as they are pasted in documents: headings, and code before the first one. Each heading says whose part
/// follows; `default` and `family` are of code that no heading names. Most texts have none, so that nobody asks.
fn pasted(units: &mut Units<'_>, default: impl Fn() -> Pl7Text, family: Family, hint: &SplitHint) {
    let unnamed = |family| {
        let language = of_family(pl7_language(default()), family);
        let graph = if family == Family::Pl72 { "SEQ" } else { "CHART" };
        let part = if language.is_chart() { Part::Chart(graph.into()) } else { Part::Main };
        let main = Entity::Pl7 { task: Task::Mast, section: None, part };
        let draft = Draft::new(hint.entity.clone().unwrap_or(main), Some(language));
        Draft { is_named: hint.entity.is_some(), ..draft }
    };
    let mut pages = 0;
    // Drafts of the code before the first heading.
    let mut before_headings = Some(0);
    // Within a DFB type; behind one, where code that no heading names is a unit of its own.
    let (mut in_dfb, mut after_dfb) = (false, false);
    for line in Lines::new(units.text, Comments::Pl7) {
        if line.code.is_empty() {
            continue;
        }
        let was_dfb = in_dfb;
        in_dfb &= !ends_program(line.code);
        if let Some(name) = dfb_header(line.code).filter(|_| family == Family::Pl7) {
            before_headings = None;
            units.push(units.code_end, Draft::new(Entity::Dfb { name: name.into() }, None));
            (in_dfb, after_dfb) = (true, false);
        } else if let Some(heading) = pl7_heading(line.code) {
            (in_dfb, after_dfb) = (false, false);
            let draft = headed(heading, family);
            if let Some(count) = before_headings.take() {
                units.let_operands_decide(count, family);
            }
            units.push(units.code_end, draft);
            pages = 0;
        } else if units.drafts.is_empty() || after_dfb {
            units.push(units.code_end, unnamed(family));
            after_dfb = false;
        } else if was_dfb && !in_dfb {
            after_dfb = true;
        }
        if units.in_chart()
            && let Some(page) = page_line(line.code)
        {
            units.page(page, &mut pages);
        }
        if let Some(count) = &mut before_headings {
            *count = units.drafts.len();
        }
        units.code_end = line.end;
    }
    if units.drafts.is_empty() {
        units.push(0, unnamed(family));
    }
}

/// The unit that a heading names. PL7-2 has ladder and Grafcet alone: what is in another language is PL7's, unless its
/// heading says otherwise.
fn headed(heading: Heading, family: Family) -> Draft {
    let (language, has_older) = match heading.language {
        HeadingLanguage::Il => (Language::Pl7Il, false),
        HeadingLanguage::St => (Language::Pl7St, false),
        HeadingLanguage::Ladder => (Language::Pl7Ld, true),
        HeadingLanguage::Grafcet => (Language::Pl7Gr7, true),
    };
    if heading.pl7_2 && !has_older {
        let draft = Draft::new(heading.entity, Some(Language::Pl72Ld));
        return Draft { unsupported: Some(unsupported::PL7_2_LANGUAGE), ..draft };
    }
    let is_older = heading.pl7_2 || family == Family::Pl72 && has_older;
    Draft::new(heading.entity, Some(if is_older { of_family(language, Family::Pl72) } else { language }))
}

/// A language of ladder or charts with the operands of a family; other languages as they are.
fn of_family(language: Language, family: Family) -> Language {
    match (language, family) {
        (Language::Pl7Ld, Family::Pl72) => Language::Pl72Ld,
        (Language::Pl7Gr7, Family::Pl72) => Language::Pl72Gr7,
        (Language::Sfc, Family::Pl72) => Language::Pl72Sfc,
        (Language::Pl72Ld, Family::Pl7) => Language::Pl7Ld,
        (Language::Pl72Gr7, Family::Pl7) => Language::Pl7Gr7,
        (Language::Pl72Sfc, Family::Pl7) => Language::Sfc,
        _ => language,
    }
}

/// The language of PL7-2 that text without a heading is in.
fn pl7_2_text(text: &str) -> Pl7Text {
    match pl7_text(text) {
        it @ (Pl7Text::Gr7 | Pl7Text::Sfc) => it,
        Pl7Text::Ld | Pl7Text::Il | Pl7Text::St => Pl7Text::Ld,
    }
}

/// An exchange file: each block in brackets, and the program in each source unit.
fn exchange(units: &mut Units<'_>, family: Family) {
    #[derive(PartialEq)]
    enum State {
        /// Between blocks, or in one without a program.
        Other,
        /// In the keys of a source unit, whose draft is the last one.
        Keys,
        Program,
        Ended,
    }
    let mut state = State::Ended;
    let mut keys = SourceUnit::default();
    let mut pages = 0;
    let mut lines = Lines::new(units.text, Comments::Pl7);
    while let Some(line) = lines.next() {
        if line.code.is_empty() {
            continue;
        }
        let mut code = line.code;
        if let Some((block, rest)) = exchange_block(code) {
            units.push(units.code_end, Draft { label: Some(block.into()), ..Draft::container() });
            keys = SourceUnit::default();
            state = if block == "[SOURCE_UNIT]" { State::Keys } else { State::Other };
            if block == "[VENDOR]" {
                // What looks like a comment in there need not be one.
                units.code_end = next_block(units.text, line.code_start + line.code.len());
                lines.skip_to(units.code_end);
                continue;
            }
            code = rest;
        } else if state == State::Ended {
            units.push(units.code_end, Draft::container());
            state = State::Other;
        }
        match state {
            State::Keys => {
                if let Some(program) = keys.read(code) {
                    let at = line.code_start + (line.code.len() - program.len());
                    let draft = match keys.family(units.text.get(at..).unwrap_or_default()).unwrap_or(family) {
                        Family::Pl72 => keys.pl7_2_program(program),
                        _ => keys.program(program),
                    };
                    if let Some(header) = units.drafts.last_mut() {
                        header.label = Some(format_smolstr!("[SOURCE_UNIT] {}", draft.name()));
                    }
                    let start = if at == line.code_start { units.code_end } else { at };
                    units.push(start, draft);
                    state = State::Program;
                    pages = 0;
                }
            }
            State::Program if ends_program(code) => state = State::Ended,
            State::Program if units.in_chart() => {
                if let Some(page) = page_line(code) {
                    units.page(page, &mut pages);
                }
            }
            _ => {}
        }
        units.code_end = line.end;
    }
    if units.drafts.is_empty() {
        units.push(0, Draft::container());
    }
}

/// Start of the first line after an offset that begins a block; the end of the text without one.
fn next_block(text: &str, from: usize) -> usize {
    let mut at = from;
    for line in text.get(from..).unwrap_or_default().split_inclusive(['\n', '\r']) {
        if at > from && exchange_block(line.trim_start()).is_some() {
            return at;
        }
        at += line.len();
    }
    text.len()
}

/// The listing of a PL7 project: blocks in brackets, of which those of the cross-reference name what they belong to.
fn project(units: &mut Units<'_>) {
    let mut start = 0;
    for line in units.text.split_inclusive('\n') {
        let code = line.trim_end();
        if let Some(address) = code.strip_prefix("[XREF] ") {
            units.push(start, Draft::new(project_entity(address), Some(Language::Pl7Xref)));
        } else if code.starts_with('[') || start == 0 {
            let label = (!code.is_empty()).then(|| code.into());
            units.push(start, Draft { label, ..Draft::container() });
        }
        start += line.len();
    }
    if units.drafts.is_empty() {
        units.push(0, Draft::container());
    }
}

/// `MAST - module 0`, `MAST - CHART - PAGE 0 %X1`, `task 516 - SR3`.
fn project_entity(address: &str) -> Entity {
    if let Some(entity) = pl7_address(address) {
        return entity;
    }
    let (task, rest) = address.split_once(" - ").unwrap_or((address, ""));
    let named = pl7_address(task).and_then(|it| it.task());
    let number = task.strip_prefix("task ").and_then(|it| it.parse().ok());
    let task = named.or(number.map(Task::Numbered)).unwrap_or(Task::Mast);
    if rest.starts_with("CHART") {
        return Entity::Pl7 { task, section: None, part: Part::Chart(rest.into()) };
    }
    Entity::Pl7 { task, section: Some(rest.into()), part: Part::Main }
}

/// `FUNCTION_BLOCK Cpt_pieces`: the name.
fn dfb_header(code: &str) -> Option<&str> {
    if !code.starts_with(['F', 'f']) {
        return None;
    }
    let (keyword, rest) = word(code);
    let name = word(rest.trim_start()).0;
    (keyword.eq_ignore_ascii_case("FUNCTION_BLOCK") && !name.is_empty()).then_some(name)
}

fn ends_program(code: &str) -> bool {
    ["END_PROGRAM", "END_FUNCTION_BLOCK"].iter().any(|end| strip_prefix_ignore_case(code, end).is_some())
}

/// The keys of a source unit that say what its program is.
#[derive(Debug, Default)]
struct SourceUnit<'t> {
    name: Option<&'t str>,
    language: Option<&'t str>,
    address: Option<&'t str>,
    program_language: Option<&'t str>,
}

/// Keys of a source unit. Longer before shorter, as blanks before a key may be missing.
const KEYS: [&str; 12] = [
    "PROG_LANGUAGE",
    "PROG_LANGAGE",
    "LANGUAGE",
    "STANDARD",
    "SU_TYPE",
    "ADDRESS",
    "VERSION",
    "COMMENT",
    "SENDER",
    "BODY",
    "NAME",
    "DATE",
];

impl<'t> SourceUnit<'t> {
    /// Reads one line of keys. The rest of the line if it starts the program.
    ///
    /// A value ends with its quote, before the next key, or with the line, for closing quotes may be missing.
    fn read(&mut self, line: &'t str) -> Option<&'t str> {
        let mut rest = line.trim_start();
        loop {
            if starts_program(rest) {
                return Some(rest);
            }
            let key = next_key(rest)?;
            let value = rest.get(key.end..).unwrap_or_default();
            // The value of the body, if it has one, is the program.
            let end = if key.name == "BODY" { 0 } else { next_key(value).map_or(value.len(), |next| next.start) };
            let (text, after) = value.split_at_checked(end).unwrap_or((value, ""));
            let text = text.trim();
            let text = match text.strip_prefix(['\'', '"']) {
                Some(quoted) => quoted.split(['\'', '"']).next().unwrap_or_default(),
                None => text,
            };
            let text = (!text.is_empty()).then(|| text.trim_end_matches([';', ' ', '\t']));
            match key.name {
                "NAME" => self.name = text,
                "LANGUAGE" => self.language = text,
                "ADDRESS" => self.address = text,
                "PROG_LANGAGE" | "PROG_LANGUAGE" => self.program_language = text,
                _ => {}
            }
            rest = after.trim_start();
        }
    }

    /// The unit of the program that starts with `line`: `PROGRAM`, perhaps with its address after it.
    fn program(&self, line: &str) -> Draft {
        if let Some(rest) = strip_prefix_ignore_case(line, "FUNCTION_BLOCK") {
            let name = Some(word(rest.trim_start()).0).filter(|name| !name.is_empty()).or(self.name);
            let entity = Entity::Dfb { name: name.unwrap_or_default().into() };
            let language = match self.language.unwrap_or_default().to_ascii_uppercase().as_str() {
                "IL" => Some(Language::Pl7Il),
                "ST" => Some(Language::Pl7St),
                "LD" => Some(Language::Pl7Ld),
                _ => None,
            };
            return Draft::new(entity, language);
        }
        let repeated = strip_prefix_ignore_case(line, "PROGRAM").unwrap_or_default();
        let address = self.address.into_iter().chain([repeated]).find_map(pl7_address);
        let mut entity = address.unwrap_or(Entity::Pl7 { task: Task::Mast, section: None, part: Part::Main });
        self.name_section(&mut entity);
        let language = self.language.unwrap_or_default().to_ascii_uppercase();
        let program_language = self.program_language.unwrap_or_default().to_ascii_uppercase();
        let (language, unsupported) = match (language.as_str(), program_language.as_str()) {
            ("IL", _) => (Some(Language::Pl7Il), None),
            ("ST", _) => (Some(Language::Pl7St), None),
            ("LD", _) => (Some(Language::Pl7Ld), None),
            (_, "GR7") | ("GR7", _) => (Some(Language::Pl7Gr7), None),
            ("" | "OTHERS", "") if matches!(entity, Entity::Pl7 { part: Part::Chart(_), .. }) => {
                (Some(Language::Pl7Gr7), None)
            }
            ("", _) => (None, None),
            _ => (Some(Language::Exchange), Some(unsupported::OTHER_LANGUAGE)),
        };
        Draft { unsupported, ..Draft::new(entity, language) }
    }

    /// Whose program it is, by its keys or by its operands; `text` starts with it. DFB types, and languages other than
    /// ladder and Grafcet, are PL7's.
    fn family(&self, text: &str) -> Option<Family> {
        let is_older = |it: &str| strip_prefix_ignore_case(it, "PL7-2").is_some();
        let is =
            |it: Option<&str>, names: &[&str]| it.is_some_and(|it| names.iter().any(|n| n.eq_ignore_ascii_case(it)));
        if self.address.is_some_and(is_older) {
            return Some(Family::Pl72);
        }
        if is(self.language, &["IL", "ST"]) || strip_prefix_ignore_case(text, "FUNCTION_BLOCK").is_some() {
            return Some(Family::Pl7);
        }
        let mut end = 0;
        for line in text.split_inclusive(['\n', '\r']) {
            if ends_program(line.trim_start()) || exchange_block(line.trim_start()).is_some() {
                break;
            }
            end += line.len();
        }
        operands_of(text.get(..end).unwrap_or_default())
    }

    /// As [`Self::program`], of PL7-2, which has no sections.
    fn pl7_2_program(&self, line: &str) -> Draft {
        let repeated = strip_prefix_ignore_case(line, "PROGRAM").unwrap_or_default();
        let entity = self.address.into_iter().chain([repeated]).find_map(|it| {
            let module = strip_prefix_ignore_case(it, "PL7-2").unwrap_or(it);
            pl7_2_entity(module).or_else(|| pl7_address(module.trim_start()))
        });
        let entity = entity.unwrap_or(Entity::Pl7 { task: Task::Mast, section: None, part: Part::Main });
        let language = self.language.unwrap_or_default().to_ascii_uppercase();
        let (language, unsupported) = match language.as_str() {
            "LD" => (Language::Pl72Ld, None),
            "IL" | "ST" => (Language::Pl72Ld, Some(unsupported::PL7_2_LANGUAGE)),
            "" if !matches!(entity, Entity::Pl7 { part: Part::Chart(_), .. }) => (Language::Pl72Ld, None),
            _ => (Language::Pl72Gr7, None),
        };
        Draft { unsupported, ..Draft::new(entity, Some(language)) }
    }

    /// Names the section after the unit, unless the unit's name only repeats its address: `MAST_SR1`, `MAST_Chart`.
    fn name_section(&self, entity: &mut Entity) {
        let Entity::Pl7 { task, section: section @ None, part } = entity else { return };
        let module = match part {
            Part::Main => "MAIN",
            Part::Preliminary => "PRL",
            Part::Posterior => "POST",
            Part::Chart(chart) => chart.split(' ').next().unwrap_or_default(),
            Part::Subroutine(_) | Part::Event => return,
        };
        let Some(name) = self.name else { return };
        let task = task.to_string();
        let name = strip_prefix_ignore_case(name, &task).map_or(name, |name| name.trim_start_matches(['_', ' ', '-']));
        let base = name.len().checked_sub(module.len()).and_then(|at| name.split_at_checked(at));
        let name = match base {
            Some((base, end)) if end.eq_ignore_ascii_case(module) => base.trim_end_matches(['_', ' ', '-']),
            _ => name,
        };
        if !name.is_empty() {
            *section = Some(name.into());
        }
    }
}

/// Whether a line starts a program rather than a key: blanks after the word may be missing (`PROGRAMMAST'Chart'`).
fn starts_program(line: &str) -> bool {
    ["PROGRAM", "FUNCTION_BLOCK"].iter().any(|start| {
        strip_prefix_ignore_case(line, start).is_some_and(|rest| !word(rest).1.trim_start().starts_with('='))
    })
}

/// A key and its equals sign on a line.
struct Key {
    name: &'static str,
    start: usize,
    end: usize,
}

/// The first key of a line.
fn next_key(line: &str) -> Option<Key> {
    memchr::memchr_iter(b'=', line.as_bytes()).find_map(|equals| {
        let before = line.get(..equals)?.trim_end();
        KEYS.into_iter().find_map(|name| {
            let start = before.len().checked_sub(name.len())?;
            let (prefix, found) = before.split_at_checked(start)?;
            if !found.eq_ignore_ascii_case(name) {
                return None;
            }
            let word = prefix.rfind(|c: char| !c.is_ascii_alphanumeric() && c != '_').map_or(0, |at| at + 1);
            // `PROGNAME = 'x'` is the value of the key before, and the next one.
            let glued = prefix.get(word..).unwrap_or_default();
            let is_value =
                ["", "PROG", "LD", "IL", "ST", "GR7", "OTHERS"].iter().any(|v| v.eq_ignore_ascii_case(glued));
            is_value.then_some(Key { name, start, end: equals + 1 })
        })
    })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    #[test]
    fn step5_blocks() {
        let text = "; machine 7\nOB 1\n:SPA PB 10\n:BE\n\n; graph\nBAUSTEIN : PB 10\n:U E 0.0\n:= A 4.0\n:BE\nFB5 LAE=22\nNAME :X\n:BE\n\
                    DB 3\n0: KH = 0000;\n";
        let units = split(text, Detected::Step5, &SplitHint::default());
        let keys: Vec<&str> = units.iter().map(|it| it.key.as_str()).collect();
        assert_eq!(keys, ["OB1", "PB10", "FB5", "DB3"]);
        assert!(units.iter().all(|it| it.language == Language::Step5(Mnemonics::German)));
        assert_eq!(usize::from(units[1].range.start()), text.find("\n; graph").expect("there"));
        let edited = text.replace("E 0.0", "E 0.12");
        let again = resplit(text, &units, &edited, Detected::Step5, &SplitHint::default());
        assert_eq!(again, Some(split(&edited, Detected::Step5, &SplitHint::default())));
        let listing = split("A I 0.0\n= Q 4.0\n***\n", Detected::Step5, &SplitHint::default());
        assert_eq!((&listing[0].entity, listing[0].language), (&Entity::Listing, Language::Step5(Mnemonics::English)));
        assert_eq!(split("", Detected::Step5, &SplitHint::default()).len(), 1);
    }

    use super::super::detect::{FileHint, detect};
    use super::*;
    use crate::model::entity::{BlockKind, BlockName};

    const GERMAN: Language = Language::Awl(Mnemonics::German);
    const ST: Language = Language::Pl7St;
    const LD: Language = Language::Pl7Ld;
    const IL: Language = Language::Pl7Il;
    const GR7: Language = Language::Pl7Gr7;
    const KEYS: Language = Language::Exchange;

    /// Keys, languages and texts of the units, the form of unsupported ones instead of their language.
    #[track_caller]
    fn check(detected: Detected, text: &str, expected: &[(&str, Language, &str)]) -> Vec<UnitSpan> {
        let units = split(text, detected, &SplitHint::default());
        assert_tiles(text, &units);
        let found: Vec<_> = units.iter().map(|unit| (unit.key.as_str(), unit.language, &text[unit.range])).collect();
        assert_eq!(found, expected);
        units
    }

    #[track_caller]
    fn assert_tiles(text: &str, units: &[UnitSpan]) {
        let mut end = TextSize::new(0);
        let mut keys = FxHashSet::default();
        for unit in units {
            assert_eq!(unit.range.start(), end);
            end = unit.range.end();
            assert!(text.is_char_boundary(end.into()));
            assert!(keys.insert(unit.key.clone()), "{} twice", unit.key);
        }
        assert_eq!(end, TextSize::of(text));
        assert!(!units.is_empty());
    }

    fn unsupported(units: &[UnitSpan]) -> Vec<Option<&'static str>> {
        units.iter().map(|unit| unit.unsupported).collect()
    }

    #[test]
    fn blocks_of_a_source() {
        check(
            Detected::Step7,
            "// head\nFUNCTION FC 1 : VOID\r\nBEGIN\n(*\nFUNCTION FC 9\n*)\n // FUNCTION FC 8\nU E 0.0\nEND_FUNCTION // x\n\
             // of FB 1\n\nfunction_block \"Pump\"\nEND_FUNCTION_BLOCK DATA_BLOCK DB 1 \"Pump\"\nBEGIN\nEND_DATA_BLOCK\n\n",
            &[
                (
                    "FC1",
                    GERMAN,
                    "// head\nFUNCTION FC 1 : VOID\r\nBEGIN\n(*\nFUNCTION FC 9\n*)\n // FUNCTION FC 8\nU E 0.0\n\
                     END_FUNCTION // x\n",
                ),
                ("FB \"pump\"", GERMAN, "// of FB 1\n\nfunction_block \"Pump\"\nEND_FUNCTION_BLOCK "),
                ("DB1", GERMAN, "DATA_BLOCK DB 1 \"Pump\"\nBEGIN\nEND_DATA_BLOCK\n\n"),
            ],
        );
    }

    #[test]
    fn text_around_blocks() {
        check(
            Detected::Step7,
            "U E 0.0\n// of FC 1\nFUNCTION FC 1 : VOID\nU E 0.1\nTYPE : INT;\nTYPE UDT 1\nEND_TYPE\nstray\n\n\
             FUNCTION FC 1 : VOID\n",
            &[
                ("file", GERMAN, "U E 0.0\n"),
                ("FC1", GERMAN, "// of FC 1\nFUNCTION FC 1 : VOID\nU E 0.1\nTYPE : INT;\n"),
                ("UDT1", GERMAN, "TYPE UDT 1\nEND_TYPE\n"),
                ("file#2", GERMAN, "stray\n"),
                ("FC1#2", GERMAN, "\nFUNCTION FC 1 : VOID\n"),
            ],
        );
    }

    #[test]
    fn listings() {
        check(Detected::Step7, "\r U E 0.0\r= A 4.0\r", &[("listing", GERMAN, "\r U E 0.0\r= A 4.0\r")]);
        check(
            Detected::Step7,
            "U «a»\n\nBloc FC1 :\nS «X0»\nBE\n// OB1 :\nBlock OB 1:\nCALL FC1\n",
            &[
                ("listing", GERMAN, "U «a»\n"),
                ("FC1", GERMAN, "\nBloc FC1 :\nS «X0»\nBE\n"),
                ("OB1", GERMAN, "// OB1 :\nBlock OB 1:\nCALL FC1\n"),
            ],
        );
        let hint = SplitHint {
            entity: Some(Entity::Block { kind: BlockKind::Ob, name: BlockName::Number(BlockKind::Ob, 35) }),
            mnemonics: Some(Mnemonics::English),
        };
        let units = split("= M 0.0", Detected::Step7, &hint);
        assert_eq!((units[0].key.as_str(), units[0].language), ("OB35", Language::Awl(Mnemonics::English)));
    }

    #[test]
    fn mnemonics_of_a_file() {
        for (text, expected) in [
            ("", Mnemonics::English),
            ("= M 0.0\n", Mnemonics::English),
            ("S « X0 »\n", Mnemonics::German),
            ("AN I 0.0\nM1: JU M1\n", Mnemonics::English),
            ("lab: SPA lab\nUN E 0.0", Mnemonics::German),
        ] {
            assert_eq!(mnemonics(text), expected, "{text}");
        }
    }

    #[test]
    fn empty_texts_have_one_unit() {
        for detected in
            [Detected::Step7, Detected::Pasted(Pl7Text::Il), Detected::Exchange, Detected::Pl72, Detected::NotPlc]
        {
            for text in ["", "\n\n", "(* only *)"] {
                let units = split(text, detected, &SplitHint::default());
                assert_tiles(text, &units);
                assert_eq!(units.len(), 1);
            }
        }
    }

    #[test]
    fn pasted_sections() {
        let st = Detected::Pasted(Pl7Text::St);
        check(st, "! %M0 := TRUE;\n", &[("MAST - MAIN", ST, "! %M0 := TRUE;\n")]);
        let units = check(
            st,
            "!\n(* ST : MAST - SR1 *)\nST : MAST - SR10\r!\rIL : MAST - Peinture - PRL\nLD %M0\n\
             ST : MAST - Peinture - CHART - PAGE 0 %X(0) --> %X(1)\n%M1\nLD : FAST - MAIN\nRUNG\nLD : PL7-2 - POST\n\
             ST : PL7-2 - PRL\nGR7 : MAST - Peinture - CHART\n",
            &[
                ("MAST - MAIN", ST, "!\n"),
                ("MAST - SR10", ST, "(* ST : MAST - SR1 *)\nST : MAST - SR10\r!\r"),
                ("MAST - Peinture - PRL", IL, "IL : MAST - Peinture - PRL\nLD %M0\n"),
                (
                    "MAST - Peinture - CHART - PAGE 0 %X(0) --> %X(1)",
                    ST,
                    "ST : MAST - Peinture - CHART - PAGE 0 %X(0) --> %X(1)\n%M1\n",
                ),
                ("FAST - MAIN", LD, "LD : FAST - MAIN\nRUNG\n"),
                ("MAST - POST", Language::Pl72Ld, "LD : PL7-2 - POST\n"),
                ("MAST - PRL", Language::Pl72Ld, "ST : PL7-2 - PRL\n"),
                ("MAST - Peinture - CHART", GR7, "GR7 : MAST - Peinture - CHART\n"),
            ],
        );
        use super::unsupported::PL7_2_LANGUAGE;
        let expected = [None, None, None, None, None, None, Some(PL7_2_LANGUAGE), None];
        assert_eq!(unsupported(&units), expected);
        assert_eq!(units.iter().map(|it| it.is_named).collect::<Vec<_>>()[..2], [false, true]);
    }

    #[test]
    fn each_heading_says_whose_part_follows() {
        let languages = |detected, text: &str| -> Vec<Language> {
            split(text, detected, &SplitHint::default()).iter().map(|it| it.language).collect()
        };
        let text =
            |before: &str| format!("{before}LD : PL7-2 - PRL\nRUNG\nLD : MAST - MAIN\nRUNG\nGR7 : PL7-2 - SEQ\n");
        let ld = Detected::Pasted(Pl7Text::Ld);
        let (older, gr7) = (Language::Pl72Ld, Language::Pl72Gr7);
        assert_eq!(languages(ld, &text("")), [older, LD, gr7]);
        assert_eq!(languages(ld, &text("RUNG\nCOIL(O0,05);\n")), [older, older, LD, gr7], "by its operands");
        assert_eq!(languages(ld, &text("RUNG\nCOIL(%Q2.0);\n")), [LD, older, LD, gr7]);
        // Who says that all of it is PL7-2's still has other languages of PL7.
        assert_eq!(languages(Detected::Pl72, &text("ST : EVT1\n")), [ST, older, older, gr7]);
    }

    #[test]
    fn pages_are_named_by_the_heading_of_their_chart() {
        let named = |text: &str| -> Vec<bool> {
            let units = split(text, Detected::Pasted(Pl7Text::Gr7), &SplitHint::default());
            units.iter().map(|it| it.is_named).collect()
        };
        assert_eq!(named("PAGE 0\nPAGE 1\n"), [false, false]);
        assert_eq!(named("GR7 : MAST - CHART\nPAGE 0\nPAGE 1\n"), [true, true]);
        assert_eq!(named("PAGE 0\nGR7 : MAST - CHART\nPAGE 1\nPAGE 2\n"), [false, true, true]);
    }

    #[test]
    fn pl7_2_programs() {
        let (ld, gr7, sfc) = (Language::Pl72Ld, Language::Pl72Gr7, Language::Pl72Sfc);
        let units = check(
            Detected::Pl72,
            "(* A *)\nLD : PL7-2 - PRL\nRUNG\nLD : PL7-2 - SEQ - X3\n\nRUNG\nLD : PL7-2 - SEQ - X3 --> X4\n\
             LD : PL7-2 - POST\nGR7 : PL7-2 - SEQ\nPAGE 1\nEND_PAGE\nPAGE 2\nLD : PL7-2 - FAST\nST : PL7-2 - MAST\n",
            &[
                ("MAST - PRL", ld, "(* A *)\nLD : PL7-2 - PRL\nRUNG\n"),
                ("MAST - SEQ - X3", ld, "LD : PL7-2 - SEQ - X3\n\nRUNG\n"),
                ("MAST - SEQ - X3 --> X4", ld, "LD : PL7-2 - SEQ - X3 --> X4\n"),
                ("MAST - POST", ld, "LD : PL7-2 - POST\n"),
                ("MAST - SEQ - PAGE 1", gr7, "GR7 : PL7-2 - SEQ\nPAGE 1\nEND_PAGE\n"),
                ("MAST - SEQ - PAGE 2", gr7, "PAGE 2\n"),
                ("FAST - MAIN", ld, "LD : PL7-2 - FAST\n"),
                ("MAST - MAIN", ld, "ST : PL7-2 - MAST\n"),
            ],
        );
        let expected: Vec<_> = units.iter().map(|it| it.unsupported.is_some()).collect();
        assert_eq!(expected, [false, false, false, false, false, false, false, true]);
        check(Detected::Pl72, "RUNG\nEND_RUNG\n", &[("MAST - MAIN", ld, "RUNG\nEND_RUNG\n")]);
        let chart = "INITIAL_STEP X0 : END_STEP\n";
        check(Detected::Pl72, chart, &[("MAST - SEQ", sfc, chart)]);
    }

    #[test]
    fn pl7_2_exchange_files() {
        let unit = |language: &str, address: &str| {
            format!(
                "[SOURCE_UNIT]\nNAME = 'POST'\nLANGUAGE = {language}\nBODY =\nADDRESS = {address}\nPROGRAM\nRUNG\nEND_PROGRAM\n"
            )
        };
        let language = |detected, text: &str| {
            let units = split(text, detected, &SplitHint::default());
            units.last().map(|it| (it.entity.to_string(), it.language, it.unsupported.is_some()))
        };
        let of = |text: &str| language(Detected::Pl72Exchange, text);
        assert_eq!(of(&unit("LD", "MAST POST")), Some(("MAST - POST".to_owned(), Language::Pl72Ld, false)));
        assert_eq!(of(&unit("LD", "PRL")), Some(("MAST - PRL".to_owned(), Language::Pl72Ld, false)));
        assert_eq!(of(&unit("LD", "PL7-2 FAST")), Some(("FAST - MAIN".to_owned(), Language::Pl72Ld, false)));
        assert_eq!(of(&unit("OTHERS", "SEQ")), Some(("MAST - SEQ".to_owned(), Language::Pl72Gr7, false)));
        assert_eq!(of(&unit("IL", "PL7-2 POST")), Some(("MAST - POST".to_owned(), Language::Pl72Ld, true)));
        assert_eq!(of(&unit("IL", "MAST POST")).map(|it| (it.1, it.2)), Some((IL, false)), "no language of PL7-2");
        let pl7 = |text: &str| language(Detected::Exchange, text).map(|it| it.1);
        assert_eq!(pl7(&unit("LD", "MAST MAIN")), Some(LD));
        // Of a file with units of both, each is what its operands say.
        let with = |operand: &str| unit("LD", "MAST MAIN").replace("RUNG\n", &format!("RUNG\nCOIL({operand});\n"));
        assert_eq!(pl7(&format!("{}{}", with("%Q2.0"), with("O0,05"))), Some(Language::Pl72Ld));
        assert_eq!(of(&with("%Q2.0")).map(|it| it.1), Some(LD));
    }

    #[test]
    fn exchange_files() {
        let units = check(
            Detected::Exchange,
            "[HEADER]\nDATE = date#2024-03-01\n[VENDOR]\nx\n[SOURCE_UNIT]\nSU_TYPE = PROG\nNAME = 'MAST_SR1\n\
             LANGUAGE = IL\nBODY =\nADDRESS = MAST SR1\n\nPROGRAM\n(*PHRASE*) LD %M0\n(* [EOF] *)\n\
             [%MW0:=%MW1] (*END_PHRASE*)\nEND_PROGRAM\n\n[SOURCE_UNIT]\n\
             SU_TYPE=PROGNAME='Peinture'LANGUAGE=ST BODY=PROGRAM\n%M1:=%M2;\n[DATA_UNIT]\nVAR_GLOBAL\nEND_VAR\n[EOF]\n",
            &[
                ("[HEADER]", KEYS, "[HEADER]\nDATE = date#2024-03-01\n"),
                ("[VENDOR]", KEYS, "[VENDOR]\nx\n"),
                (
                    "[SOURCE_UNIT] MAST - SR1",
                    KEYS,
                    "[SOURCE_UNIT]\nSU_TYPE = PROG\nNAME = 'MAST_SR1\nLANGUAGE = IL\nBODY =\nADDRESS = MAST SR1\n",
                ),
                (
                    "MAST - SR1",
                    IL,
                    "\nPROGRAM\n(*PHRASE*) LD %M0\n(* [EOF] *)\n[%MW0:=%MW1] (*END_PHRASE*)\nEND_PROGRAM\n",
                ),
                (
                    "[SOURCE_UNIT] MAST - Peinture",
                    KEYS,
                    "\n[SOURCE_UNIT]\nSU_TYPE=PROGNAME='Peinture'LANGUAGE=ST BODY=",
                ),
                ("MAST - Peinture", ST, "PROGRAM\n%M1:=%M2;\n"),
                ("[DATA_UNIT]", KEYS, "[DATA_UNIT]\nVAR_GLOBAL\nEND_VAR\n"),
                ("[EOF]", KEYS, "[EOF]\n"),
            ],
        );
        assert_eq!(unsupported(&units), [None; 8]);
    }

    #[test]
    fn programs_of_exchange_files() {
        use super::unsupported::OTHER_LANGUAGE;
        for (keys, program, expected, language, form) in [
            ("ADDRESS = MAST SR1", "PROGRAM", "MAST - SR1", ST, None),
            ("NAME = 'FAST_MAIN' LANGUAGE = IL ADDRESS = FAST MAIN", "PROGRAM", "FAST - MAIN", IL, None),
            ("ADDRESS=EVT3 LANGUAGE=ST", "PROGRAM", "EVT3", ST, None),
            ("NAME = MAST_PRL ADDRESS = MAST PRL LANGUAGE = 'ST'", "PROGRAM", "MAST - PRL", ST, None),
            ("NAME = Peinture_POST\nADDRESS = MAST POST", "PROGRAM", "MAST - Peinture - POST", ST, None),
            (
                "LANGUAGE = OTHERS ADDRESS = MAST Chart PROG_LANGAGE = GR7 NAME = 'MAST_Chart'",
                "PROGRAM MAST 'Chart'",
                "MAST - CHART",
                GR7,
                None,
            ),
            ("LANGUAGE = OTHERS", "PROGRAMMAST'Chart'", "MAST - CHART", GR7, None),
            ("LANGUAGE = OTHERS", "PROGRAM", "MAST - MAIN", KEYS, Some(OTHER_LANGUAGE)),
            ("ADDRESS = MAST MACRO2", "PROGRAM", "MAST - MACRO2", GR7, None),
            ("LANGUAGE = LD ADDRESS = MAST MAIN NAME = 'a=b'", "PROGRAM", "MAST - a=b", LD, None),
            ("NAME = 'x'", "PROGRAM\nRUNG\nH_LINK(10),COIL(%M0);\nEND_RUNG", "MAST - x", LD, None),
            ("NAME = 'x'", "PROGRAM\n LD %M0\n ST %M1", "MAST - x", IL, None),
            ("NAME = 'x'", "FUNCTION_BLOCK Cpt", "FUNCTION_BLOCK Cpt", ST, None),
            ("NAME = 'x' LANGUAGE = LD", "FUNCTION_BLOCK", "FUNCTION_BLOCK x", LD, None),
            ("", "FUNCTION_BLOCK A\nVAR\nb : BOOL := 0;\nEND_VAR\nRUNG\nEND_RUNG", "FUNCTION_BLOCK A", LD, None),
            ("", "FUNCTION_BLOCK A\nVAR\nb : BOOL := 0;\nEND_VAR\nLD b\nST c", "FUNCTION_BLOCK A", IL, None),
            ("PROGRAM = x ADDRESS = nonsense", "PROGRAM", "MAST - MAIN", ST, None),
        ] {
            let text = format!("[SOURCE_UNIT] {keys}\n{program}\n");
            let units = split(&text, Detected::Exchange, &SplitHint::default());
            assert_tiles(&text, &units);
            let unit = units.last().unwrap();
            assert_eq!((unit.key.as_str(), unit.language, unit.unsupported), (expected, language, form), "{keys}");
            assert!(text[unit.range].starts_with(program), "{keys}");
        }
    }

    /// An edit in one page re-parses that page.
    #[test]
    fn pages_are_units() {
        check(
            Detected::Exchange,
            "[SOURCE_UNIT]\nNAME='Peinture_Chart' ADDRESS=MAST Chart PROG_LANGAGE=GR7\nPROGRAM MAST 'Chart'\nNB_PAGES = 8\n\
             PAGE 0\nSTEP 0 AT (C 0,L 1) :\nEND_STEP\nEND_PAGE\n(* next *)\nPAGE 1\nEND_PAGE\nEND_PROGRAM\n[EOF]\n",
            &[
                (
                    "[SOURCE_UNIT] MAST - Peinture - CHART",
                    KEYS,
                    "[SOURCE_UNIT]\nNAME='Peinture_Chart' ADDRESS=MAST Chart PROG_LANGAGE=GR7\n",
                ),
                (
                    "MAST - Peinture - CHART - PAGE 0",
                    GR7,
                    "PROGRAM MAST 'Chart'\nNB_PAGES = 8\nPAGE 0\nSTEP 0 AT (C 0,L 1) :\nEND_STEP\nEND_PAGE\n",
                ),
                ("MAST - Peinture - CHART - PAGE 1", GR7, "(* next *)\nPAGE 1\nEND_PAGE\nEND_PROGRAM\n"),
                ("[EOF]", KEYS, "[EOF]\n"),
            ],
        );
        check(
            Detected::Pasted(Pl7Text::St),
            "GR7 : MAST - Peinture - CHART\nPAGE 0\nPAGE 0\nGR7 : MAST - Peinture - MACRO2\nPAGE 3\nST : MAST - SR1\nPAGE 1\n",
            &[
                ("MAST - Peinture - CHART - PAGE 0", GR7, "GR7 : MAST - Peinture - CHART\nPAGE 0\n"),
                ("MAST - Peinture - CHART - PAGE 0#2", GR7, "PAGE 0\n"),
                ("MAST - Peinture - MACRO2 - PAGE 3", GR7, "GR7 : MAST - Peinture - MACRO2\nPAGE 3\n"),
                ("MAST - SR1", ST, "ST : MAST - SR1\nPAGE 1\n"),
            ],
        );
        check(Detected::Pasted(Pl7Text::Gr7), "PAGE 2\n", &[("MAST - CHART - PAGE 2", GR7, "PAGE 2\n")]);
        check(Detected::Pasted(Pl7Text::Sfc), "STEP A:", &[("MAST - CHART", Language::Sfc, "STEP A:")]);
    }

    #[test]
    fn files_that_are_not_read() {
        let units = split("x", Detected::Unsupported { what: unsupported::DFB }, &SplitHint::default());
        assert_eq!(unsupported(&units), [Some(unsupported::DFB)]);
    }

    #[test]
    fn keys_survive_edits_elsewhere() {
        let keys = |text| -> Vec<_> {
            split(text, Detected::Step7, &SplitHint::default()).into_iter().map(|unit| unit.key).collect()
        };
        let before = keys("FUNCTION FC 1 : VOID\nFUNCTION FC 2 : VOID\nFUNCTION FC 2 : VOID\n");
        let after =
            keys("FUNCTION FC 3 : VOID\nFUNCTION FC 1 : VOID\nU E 0.0\nFUNCTION FC 2 : VOID\nFUNCTION FC 2 : VOID\n");
        assert_eq!(before, ["FC1", "FC2", "FC2#2"]);
        assert_eq!(after[1..], before);
        assert_eq!(
            keys("FUNCTION \"a\" : VOID\nFUNCTION \"A\" : VOID\nFUNCTION_BLOCK \"a\"#2\nFUNCTION \"a\" : VOID\n"),
            ["FC \"a\"", "FC \"a\"#2", "FB \"a\"", "FC \"a\"#3"]
        );
    }

    /// Texts of millions of bytes: what is quadratic does not end.
    #[test]
    fn hostile_texts_take_linear_time() {
        let long = 400_000;
        let texts = [
            "U".repeat(10_000_000),
            "(*".repeat(long / 2),
            "(* *)".repeat(long / 5),
            "[HEADER]\n".repeat(100_000),
            "[HEADER]".repeat(long / 8),
            format!("[SOURCE_UNIT]\n{}", "NAME=".repeat(long / 5)),
            format!("[SOURCE_UNIT]\n{}", "a=".repeat(long / 2)),
            "[SOURCE_UNIT]\nPROGRAM\n".repeat(long / 25),
            "FUNCTION FC 1 : VOID\n".repeat(long / 20),
            "ST : EVT1\n".repeat(long / 10),
            "// (*\n".repeat(long / 6),
            "'(*'".repeat(long / 4),
            "%".repeat(long),
            "\u{a0}".repeat(long / 2),
            "\r".repeat(long),
            "END_FUNCTION ".repeat(long / 13),
        ];
        for text in &texts {
            let detected = detect(FileHint { explicit: true, ..FileHint::default() }, text);
            for detected in
                [detected, Detected::Step7, Detected::Pasted(Pl7Text::St), Detected::Exchange, Detected::Pl72]
            {
                let units = split(text, detected, &SplitHint::default());
                assert_tiles(text, &units);
            }
        }
    }

    const PIECES: &str = "\\PC{0,8}|[\r\n \t\u{a0}]{1,3}|FUNCTION FC [1-3] : VOID|FUNCTION_BLOCK \"[ab]#2\"|END_FUNCTION;?|\
        TYPE UDT 1|Bloc FC[12] :|// |\\(\\*|\\*\\)|['\"]|TITLE =|ST : MAST - SR[12]|LD : EVT1|IL : MAST - A - PRL|\
        \\[SOURCE_UNIT\\]|\\[EOF\\]|\\[HEADER|PROGRAM|END_PROGRAM|NAME = 'MAST_|ADDRESS=|LANGUAGE=|LD %M0|RUNG|%M0 := 1;";

    const EDITED: [(&str, Detected); 2] = [
        (
            "// head\nFUNCTION FC 1 : VOID\nBEGIN\n U E 0.0 // a (* b\n = A 4.0\nEND_FUNCTION\n\n// of FB 1\nFUNCTION_BLOCK \
             FB 1\nVAR\n x : INT;\nEND_VAR\nBEGIN\n(* two\n lines *) U E 0.1; = A 0.1\nEND_FUNCTION_BLOCK DATA_BLOCK DB 1 \
             FB 1\nBEGIN\nEND_DATA_BLOCK\nFUNCTION FC 1 : VOID\nBEGIN\nBE\nEND_FUNCTION\n",
            Detected::Step7,
        ),
        (
            "! %M0 := %M1; (* c *)\nST : MAST - SR1\n! (* d\n e *) %M2 := %M3;\n\n(* of SR2 *)\nIL : MAST - SR2\n! LD %M4\n \
             ST %M5\nST : MAST - SR1\n! %M6 := 'a';\nLD : MAST - SR4\nRUNG END_RUNG\nST : EVT3\n! %M7:=%M8;",
            Detected::Pasted(Pl7Text::St),
        ),
    ];

    const SNIPPETS: [&str; 17] = [
        "",
        "\n",
        " ",
        "(*",
        "*)",
        "//",
        "'",
        "x",
        "U E 0.5\n",
        "END_FUNCTION\n",
        "FUNCTION FC 7 : VOID\n",
        "TYPE UDT 3\n",
        "ST : MAST - SR1\n",
        "IL : MAST - SR9\n",
        "! %M0:=%M1;\n",
        "NETWORK\nTITLE = (* x\n",
        "A I 0.0\nA I 0.1\n",
    ];

    /// An edit inside of a unit takes the short way.
    #[test]
    fn short_way() {
        for (text, detected) in EDITED {
            let spans = split(text, detected, &SplitHint::default());
            let at = text.find(if detected == Detected::Step7 { "E 0.1" } else { "%M3" }).expect("a place");
            let edited = format!("{}9{}", &text[..at + 2], &text[at + 2..]);
            let found = resplit(text, &spans, &edited, detected, &SplitHint::default());
            assert_eq!(found, Some(split(&edited, detected, &SplitHint::default())));
        }
    }

    proptest! {
        #[test]
        fn an_edit_is_cut_as_the_whole_would_be(
            which in 0..EDITED.len(),
            from in 0..400_usize,
            length in 0..40_usize,
            snippet in 0..SNIPPETS.len(),
        ) {
            let (text, detected) = EDITED[which];
            let (from, to) = (from.min(text.len()), (from + length).min(text.len()));
            let edited = format!("{}{}{}", &text[..from], SNIPPETS[snippet], &text[to..]);
            let spans = split(text, detected, &SplitHint::default());
            if let Some(found) = resplit(text, &spans, &edited, detected, &SplitHint::default()) {
                prop_assert_eq!(found, split(&edited, detected, &SplitHint::default()));
            }
        }

        #[test]
        fn units_tile_any_text(pieces in prop::collection::vec(PIECES, 0..24)) {
            let text = pieces.concat();
            let hint = FileHint { explicit: true, ..FileHint::default() };
            for detected in [
                detect(hint, &text),
                Detected::Step7,
                Detected::Pasted(Pl7Text::Il),
                Detected::Exchange,
                Detected::NotPlc,
            ] {
                assert_tiles(&text, &split(&text, detected, &SplitHint::default()));
            }
        }

        /// Cutting a file anywhere keeps the units before the last one.
        #[test]
        fn cut_files_keep_their_units(pieces in prop::collection::vec(PIECES, 0..24), cut: prop::sample::Index) {
            let text = pieces.join("\n");
            let mut at = cut.index(text.len() + 1);
            while !text.is_char_boundary(at) {
                at -= 1;
            }
            let starts = |text: &str| -> Vec<_> {
                let units = split(text, Detected::Pasted(Pl7Text::St), &SplitHint::default());
                units.iter().map(|unit| unit.range.start()).collect()
            };
            let (whole, part) = (starts(&text), starts(&text[..at]));
            let kept = part.len().saturating_sub(1);
            prop_assert_eq!(&whole[..kept], &part[..kept]);
        }
    }
}
