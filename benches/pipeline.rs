//! Speed of each stage on generated programs of 1, 10 and 100 MB, and of an edit in a 1 MB file.
//!
//! `cargo bench --bench pipeline` measures all; `cargo bench --bench pipeline -- parse` one group. The table of
//! `docs/performance.md` is made from it.

mod generator;

use std::cell::LazyCell;
use std::hint::black_box;
use std::path::Path;

use criterion::{BatchSize, BenchmarkId, Criterion, SamplingMode, Throughput, criterion_group};
use plclint::db::{self, Input, RootDatabase};
use plclint::lint::settings::{FILE_NAME, Folders, Overrides, Settings};
use plclint::source::detect::{Detected, Dialect};
use plclint::source::split::{self, SplitHint};
use plclint::syntax;

#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

const SIZES: [(&str, usize); 3] = [("1 MB", 1_000_000), ("10 MB", 10_000_000), ("100 MB", 100_000_000)];

/// A generated program, made when a benchmark that is selected first needs it.
struct Text {
    name: &'static str,
    /// All programs in one text.
    text: LazyCell<String, Box<dyn FnOnce() -> String>>,
    detected: Detected,
    make: fn(usize, u64) -> String,
    seed: u64,
    /// A controller holds no program that is larger.
    largest: usize,
}

impl Text {
    fn programs(&self, bytes: usize) -> Vec<String> {
        programs(self.make, self.seed, self.largest, bytes)
    }
}

/// Programs that can exist: of more bytes than one controller holds, several.
fn programs(make: fn(usize, u64) -> String, seed: u64, largest: usize, bytes: usize) -> Vec<String> {
    let number = bytes.div_ceil(largest).max(1);
    (seed..).take(number).map(|seed| make(bytes / number, seed)).collect()
}

fn texts(bytes: usize) -> [Text; 6] {
    let detected = |text: &str| Input::from_text("bench.txt", text, Dialect::Auto).detected;
    let pl7 = Input::from_text("bench.txt", &generator::pl7(10_000, 7), Dialect::Pl7).detected;
    let text = |name, make: fn(usize, u64) -> String, seed, detected, largest| {
        let lazy: Box<dyn FnOnce() -> String> = Box::new(move || programs(make, seed, largest, bytes).concat());
        Text { name, text: LazyCell::new(lazy), detected, make, seed, largest }
    };
    [
        text("step7", generator::step7, 42, Detected::Step7, usize::MAX),
        text("step5", generator::step5, 5, detected(&generator::step5(10_000, 5)), 50_000),
        text("pl7", generator::pl7, 7, pl7, 1_000_000),
        text("ladder", generator::ladder, 11, detected(&generator::ladder(10_000, 11)), 1_000_000),
        text("grafcet", generator::grafcet, 13, detected(&generator::grafcet(10_000, 13)), 25_000),
        text("pl7-2", generator::pl7_2, 17, detected(&generator::pl7_2(10_000, 17)), 23_000),
    ]
}

/// Lexing, parsing and building the trees of all units of a file.
fn parse(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("lex and parse");
    group.sample_size(10).sampling_mode(SamplingMode::Flat);
    for (size, bytes) in SIZES {
        for Text { name, text, detected, .. } in texts(bytes) {
            group.throughput(Throughput::Bytes(bytes as u64));
            group.bench_function(BenchmarkId::new(name, size), |bencher| {
                let text = text.as_str();
                let units = split::split(text, detected, &SplitHint::default());
                bencher.iter_with_large_drop(|| {
                    let mut memo = syntax::Memo::default();
                    let mut parse = |range: std::ops::Range<usize>, language| memo.parse(language, &text[range]);
                    units.iter().map(|it| parse(it.range.into(), it.language)).collect::<Vec<_>>()
                });
            });
        }
    }
    group.finish();
}

/// Finding the units of a file: what runs over the whole text at each edit.
fn split(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("split");
    group.sample_size(10).sampling_mode(SamplingMode::Flat);
    for Text { name, text, detected, .. } in texts(10_000_000) {
        group.throughput(Throughput::Bytes(10_000_000));
        group.bench_function(BenchmarkId::new(name, "10 MB"), |bencher| {
            let text = text.as_str();
            bencher.iter(|| split::split(black_box(text), detected, &SplitHint::default()).len());
        });
    }
    group.finish();
}

/// The whole cold check with all rules, on one thread.
fn check(criterion: &mut Criterion) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("one thread can be had");
    let mut group = criterion.benchmark_group("check, one thread");
    group.sample_size(10).sampling_mode(SamplingMode::Flat);
    for (size, bytes) in SIZES {
        for it in texts(bytes) {
            let programs = it.programs(bytes);
            group.throughput(Throughput::Bytes(programs.iter().map(|it| it.len() as u64).sum()));
            group.bench_function(BenchmarkId::new(it.name, size), |bencher| {
                let input = |(number, text): (usize, String)| {
                    let mut input = Input::from_text(&format!("{number}/bench.txt"), "", Dialect::Step7);
                    input.source.text = text.into();
                    input.detected = it.detected;
                    input
                };
                let inputs: Vec<Input> = programs.iter().cloned().enumerate().map(input).collect();
                bencher.iter_batched(
                    || inputs.clone(),
                    |inputs| pool.install(|| db::check(inputs, Settings::default()).diagnostics.len()),
                    BatchSize::PerIteration,
                );
            });
        }
    }
    group.finish();
}

fn chart_texts() -> [(&'static str, String); 2] {
    [("241 steps, 40 divergences", generator::chart(40)), ("1000 steps in 40 charts", generator::charts(40, 4))]
}

/// Charts, with the rules about them alone, on one thread.
fn charts(criterion: &mut Criterion) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("one thread can be had");
    let mut group = criterion.benchmark_group("charts");
    group.sample_size(20);
    for (name, text) in chart_texts() {
        let input = Input::from_text("bench.sfc", &text, Dialect::Sfc);
        let overrides = || Overrides { select: Some(vec!["grafcet".to_owned()]), ..Overrides::default() };
        let settings = || Settings::parse("", Path::new(FILE_NAME), Folders::default(), overrides());
        let found = db::check(vec![input.clone()], settings().expect("no configuration")).diagnostics.len();
        eprintln!("{name}: {found} findings");
        group.bench_function(name, |bencher| {
            bencher.iter_batched(
                || (vec![input.clone()], settings().expect("no configuration")),
                |(inputs, settings)| pool.install(|| db::check(inputs, settings).diagnostics.len()),
                BatchSize::PerIteration,
            );
        });
    }
    group.finish();
}

/// One network of a 1 MB file is edited; all findings of the file are asked for again.
fn edit(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("edit to findings");
    for Text { name, text, detected, .. } in
        texts(1_000_000).into_iter().filter(|it| ["step7", "pl7"].contains(&it.name))
    {
        group.bench_function(BenchmarkId::new(name, "1 MB file"), |bencher| {
            let text = text.as_str();
            let (from, others) = match name {
                "step7" => ("U     E ", ["U     E 1", "UN    E "]),
                _ => ("INC %MW", ["INC %MW1", "DEC %MW"]),
            };
            let middle = text.len() / 2 + text[text.len() / 2..].find(from).expect("the text has such a place");
            let (before, after) = (&text[..middle], &text[middle + from.len()..]);
            let variants = others.map(|to| format!("{before}{to}{after}"));
            let mut db = RootDatabase::new(Settings::default(), None);
            let mut input = Input::from_text("bench.awl", "", Dialect::Step7);
            input.source.text = text.into();
            input.detected = detected;
            let file = db.set_files([input])[0];
            eprintln!("{name}: {} findings", db::file_findings(&db, file).len());
            let mut turn = 0;
            bencher.iter(|| {
                turn = 1 - turn;
                db.set_text(file, variants[turn].as_str());
                db::file_findings(&db, file).len()
            });
        });
    }
    group.finish();
}

criterion_group!(benches, split, parse, edit, charts, check);

fn main() {
    // Writes the generated programs instead, to time the command itself on them.
    if let Some(folder) = std::env::var_os("PLCLINT_BENCH_WRITE") {
        for (size, bytes) in SIZES {
            for it in texts(bytes) {
                for (number, program) in it.programs(bytes).into_iter().enumerate() {
                    let folder = std::path::Path::new(&folder).join(size.replace(' ', "")).join(it.name);
                    let folder = folder.join(number.to_string());
                    std::fs::create_dir_all(&folder).expect("the folder can be written to");
                    std::fs::write(folder.join("program.txt"), program).expect("the folder can be written to");
                }
            }
        }
        for (name, text) in chart_texts() {
            let file = std::path::Path::new(&folder).join(format!("{}.sfc", name.replace([' ', ','], "")));
            std::fs::write(file, text).expect("the folder can be written to");
        }
        return;
    }
    benches();
    Criterion::default().configure_from_args().final_summary();
}
