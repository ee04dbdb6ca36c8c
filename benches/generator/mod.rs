//! Plausible programs of any size: blocks of varied networks and sections of varied sentences, clean but for one
//! mistake in some hundred networks. The same size and seed always give the same text.

mod graphic;
mod step5;

use std::fmt::Write as _;

pub use graphic::{grafcet, ladder, pl7_2};
pub use step5::step5;

/// A small generator of pseudo-random numbers (xorshift): reproducible, and fast enough not to be measured.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed.max(1))
    }

    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    pub fn below(&mut self, limit: u64) -> u64 {
        self.next() % limit
    }

    fn one_in(&mut self, n: u64) -> bool {
        self.below(n) == 0
    }

    pub fn pick<'a>(&mut self, words: &[&'a str]) -> &'a str {
        words[usize::try_from(self.below(words.len() as u64)).unwrap_or(0)]
    }
}

const DEVICES: &[&str] =
    &["convoyeur", "pompe", "vanne", "table", "vis", "Rollenbahn", "Hubtisch", "Presse", "gripper"];
const STATES: &[&str] = &["pret", "en marche", "defaut", "bereit", "Störung", "running", "fermé", "ouvert", "Endlage"];

/// STEP 7 blocks in German mnemonics: some `bytes` of them, in one file.
pub fn step7(bytes: usize, seed: u64) -> String {
    let mut random = Random::new(seed);
    let mut text = String::with_capacity(bytes + 4096);
    let mut blocks = Vec::new();
    let mut number = 1;
    let mut timers = 1..250;
    while text.len() + blocks.len() * 24 < bytes {
        block(&mut text, &mut random, &mut timers, number);
        blocks.push(number);
        number += 1;
    }
    text.push_str("ORGANIZATION_BLOCK OB 1\nTITLE = Hauptprogramm\nBEGIN\n");
    for chunk in blocks.chunks(20) {
        text.push_str("NETWORK\n");
        for number in chunk {
            writeln!(text, "      CALL  FC {number};").expect("a string");
        }
    }
    text.push_str("END_ORGANIZATION_BLOCK\n");
    text
}

/// `timers`: those that nothing starts yet.
fn block(text: &mut String, random: &mut Random, timers: &mut impl Iterator<Item = u64>, number: u64) {
    let device = random.pick(DEVICES);
    writeln!(text, "FUNCTION FC {number} : VOID\nTITLE = {device} {number}\nAUTHOR : atelier\nVERSION : 1.0")
        .expect("a string");
    text.push_str("VAR_TEMP\n  valeur : INT;\n  aide : BOOL;\nEND_VAR\nBEGIN\n");
    let data = number % 16000 + 1;
    for network in 0..8 + random.below(30) {
        let state = random.pick(STATES);
        writeln!(text, "NETWORK\nTITLE = {device} {state}\n// {state}: voir schéma folio {}", random.below(300))
            .expect("a string");
        let bit = format!("DB{data}.DBX{}.{}", network, random.below(8));
        let input = format!("E {}.{}", random.below(128), random.below(8));
        match random.below(10) {
            0 | 1 => {
                writeln!(text, "      U     {input};          // {state}").expect("a string");
                writeln!(text, "      UN    E {}.{};", random.below(128), random.below(8)).expect("a string");
                writeln!(text, "      =     {bit};").expect("a string");
            }
            2 => {
                writeln!(
                    text,
                    "      U(    ;\n      O     {input};\n      O     M {}.{};",
                    random.below(200),
                    random.below(8)
                )
                .expect("a string");
                writeln!(
                    text,
                    "      )     ;\n      UN    E {}.{};\n      =     {bit};",
                    random.below(128),
                    random.below(8)
                )
                .expect("a string");
            }
            3 => {
                writeln!(text, "      U     {input};\n      S     {bit};\n      UN    {input};\n      R     {bit};")
                    .expect("a string");
            }
            4 => {
                let word = network * 2 + 100;
                writeln!(text, "      L     DB{data}.DBW{word};\n      L     {};\n      +I    ;", random.below(1000))
                    .expect("a string");
                writeln!(text, "      T     DB{data}.DBW{word};").expect("a string");
            }
            5 => {
                writeln!(
                    text,
                    "      L     EW {};\n      L     {};\n      >I    ;\n      =     {bit};",
                    random.below(60) * 2,
                    random.below(32000)
                )
                .expect("a string");
            }
            6 => {
                writeln!(
                    text,
                    "      U     {input};\n      SPBN  M{network:03};\n      L     MW {};",
                    random.below(100) * 2 + 300
                )
                .expect("a string");
                writeln!(text, "      T     DB{data}.DBW{};\nM{network:03}: NOP   0;", network * 2 + 300)
                    .expect("a string");
            }
            7 => {
                writeln!(
                    text,
                    "      U     {input};\n      FP    DB{data}.DBX{}.{};\n      =     #aide;",
                    network + 50,
                    random.below(8)
                )
                .expect("a string");
                writeln!(
                    text,
                    "      U     #aide;\n      S     {bit};\n      U     E {}.{};\n      R     {bit};",
                    random.below(128),
                    random.below(8)
                )
                .expect("a string");
            }
            8 => {
                if let Some(timer) = timers.next() {
                    let seconds = random.below(90) + 1;
                    writeln!(text, "      U     {input};\n      L     S5T#{seconds}S;\n      SE    T {timer};")
                        .expect("a string");
                }
                writeln!(text, "      U     T {};\n      =     {bit};", random.below(249) + 1).expect("a string");
            }
            _ => {
                writeln!(text, "      L     DB{data}.DBW{};\n      T     #valeur;\n      L     #valeur;", network * 2)
                    .expect("a string");
                writeln!(text, "      SLW   {};\n      T     DB{data}.DBW{};", random.below(15) + 1, network * 2 + 500)
                    .expect("a string");
            }
        }
        if random.one_in(400) {
            writeln!(text, "      L     {};\n      L     2;\n      T     DB{data}.DBW800;", random.below(9))
                .expect("a string");
        }
    }
    text.push_str("END_FUNCTION\n\n");
}

/// PL7 text as it is pasted: sections, subroutines in structured text and instruction list.
pub fn pl7(bytes: usize, seed: u64) -> String {
    let mut random = Random::new(seed);
    let mut text = String::with_capacity(bytes + 4096);
    let mut number = 0;
    let mut next_timer = 0;
    while text.len() < bytes {
        number += 1;
        let mut section = Section::new(number, next_timer);
        if random.one_in(3) {
            writeln!(text, "IL : MAST - Poste{number} - PRL").expect("a string");
            for _ in 0..20 + random.below(60) {
                il_sentence(&mut text, &mut random, &mut section);
            }
        } else {
            writeln!(text, "ST : MAST - Poste{number} - POST").expect("a string");
            for _ in 0..20 + random.below(60) {
                st_sentence(&mut text, &mut random, &mut section);
            }
        }
        next_timer = section.next_timer;
    }
    text
}

/// Words and bits of the largest controllers, in round numbers.
const OBJECTS: u64 = 30_000;

/// Objects of one section: a hundred words and a hundred bits of its own, as far as the address space goes. Behind that,
/// sections share words, and compute where others drive bits.
struct Section {
    first: u64,
    /// Bits and timers are driven in one place each.
    next_bit: Option<u64>,
    next_timer: u64,
}

impl Section {
    fn new(number: u64, next_timer: u64) -> Self {
        let first = number * 100;
        Self { first: first % OBJECTS, next_bit: (first < OBJECTS).then_some(0), next_timer }
    }

    /// A word that is computed with, one of thirty.
    fn word(&self, random: &mut Random) -> u64 {
        self.first + random.below(30)
    }

    /// First word of a table of eight, one of two.
    fn table(&self, random: &mut Random) -> u64 {
        self.first + 30 + 8 * random.below(2)
    }

    /// A word that the section receives.
    fn source(&self, random: &mut Random) -> u64 {
        self.first + 48 + random.below(10)
    }

    /// First word of a floating-point number.
    fn float(&self, random: &mut Random) -> u64 {
        self.first + 60 + 2 * random.below(18)
    }

    /// A bit that the section receives.
    fn request(&self, random: &mut Random) -> u64 {
        self.first + 90 + random.below(10)
    }

    /// A bit that nothing drives yet, as long as there is one.
    fn bit(&mut self) -> Option<u64> {
        let bit = self.next_bit.as_mut()?;
        *bit += 1;
        Some(self.first + *bit % 90)
    }

    /// An instruction that applies a result to a bit, or counts it.
    fn action(&mut self, mnemonic: &str, word: u64) -> String {
        match self.bit() {
            Some(bit) => format!("{mnemonic:<7} %M{bit}"),
            None => format!("[%MW{word}:=%MW{word}+1]"),
        }
    }

    /// A timer that nothing starts yet, as long as there is one.
    fn timer(&mut self) -> Option<u64> {
        let timer = self.next_timer;
        self.next_timer += 1;
        (timer < 255).then_some(timer)
    }
}

fn st_sentence(text: &mut String, random: &mut Random, section: &mut Section) {
    writeln!(text, "! (* {} {} *)", random.pick(DEVICES), random.pick(STATES)).expect("a string");
    let input = format!("%I{}.{}", random.below(8) + 1, random.below(16));
    let word = section.word(random);
    let source = section.source(random);
    match random.below(6) {
        0 => {
            writeln!(text, "  %MW{word} := %MW{word} / 2 + %MW{source} * 10 + %KW{};", random.below(100))
                .expect("a string");
        }
        1 => {
            let (set, reset) = match section.bit() {
                Some(bit) => (format!("    SET %M{bit};\n"), format!("    RESET %M{bit};\n")),
                None => (String::new(), String::new()),
            };
            writeln!(text, "  IF {input} AND NOT %M{} THEN", section.request(random)).expect("a string");
            writeln!(text, "    %MW{word} := %MW{word} + 1;\n{set}  ELSE").expect("a string");
            writeln!(text, "    %MW{word} := 0;\n{reset}  END_IF;").expect("a string");
        }
        2 => {
            let index = section.first + 47;
            writeln!(text, "  FOR %MW{index} := 0 TO {} DO", random.below(7)).expect("a string");
            writeln!(
                text,
                "    %MW{}[%MW{index}] := %KW{}[%MW{index}];\n  END_FOR;",
                section.table(random),
                random.below(50)
            )
            .expect("a string");
        }
        3 => {
            writeln!(text, "  %MF{} := SQRT(%MF{}) / 2.5;", section.float(random), section.float(random))
                .expect("a string");
        }
        4 => {
            let (from, to) = (section.first + 38, section.first + 30);
            writeln!(text, "  %MW{to}:8 := %MW{from}:8;\n  %MW{word} := %MW{word} + SUM(%MW{to}:8);")
                .expect("a string");
        }
        _ => {
            writeln!(text, "  IF RE {input} AND (%MW{source} >= {}) THEN INC %MW{word}; END_IF;", random.below(500))
                .expect("a string");
        }
    }
    if random.one_in(400) {
        writeln!(text, "! %M{} := %M{};", section.first, section.first + 1).expect("a string");
    }
}

fn il_sentence(text: &mut String, random: &mut Random, section: &mut Section) {
    writeln!(text, "! (* {} {} *)", random.pick(DEVICES), random.pick(STATES)).expect("a string");
    let input = format!("%I{}.{}", random.below(8) + 1, random.below(16));
    let (request, other) = (section.request(random), section.request(random));
    let spare = section.first + 46;
    match random.below(4) {
        0 => {
            writeln!(text, "      LD      {input}\n      AND(N   %M{request}").expect("a string");
            writeln!(text, "      OR      %M{other}\n      )\n      {}", section.action("ST", spare))
                .expect("a string");
        }
        1 => {
            writeln!(text, "      LD      {input}\n      MPS\n      AND     %M{request}").expect("a string");
            let (set, reset) = (section.action("S", spare), section.action("R", spare));
            writeln!(text, "      {set}\n      MPP\n      {reset}").expect("a string");
        }
        2 => {
            let source = section.source(random);
            writeln!(text, "      LD      [%MW{source}>{}]", random.below(500)).expect("a string");
            match section.timer() {
                Some(timer) => writeln!(text, "      IN      %TM{timer}").expect("a string"),
                None => writeln!(text, "      {}", section.action("ST", spare)).expect("a string"),
            }
        }
        _ => {
            let (word, source) = (section.word(random), section.source(random));
            writeln!(text, "      LD      TRUE\n      [%MW{word}:=%MW{word}+%MW{source}+{}]", random.below(50))
                .expect("a string");
        }
    }
}

/// A chart in IEC text: a loop of some divergences, every other one parallel, each with two branches of two steps. It has
/// `6 * divergences + 1` steps.
pub fn chart(divergences: usize) -> String {
    let mut text = String::new();
    ring(&mut text, "X", 0, divergences);
    text
}

/// Charts of one section that nothing connects, each of some divergences. Their steps have names: there are more of them than
/// numbers.
pub fn charts(count: usize, divergences: usize) -> String {
    let mut text = String::new();
    for at in 0..count {
        ring(&mut text, "Pas", at * (6 * divergences + 1), divergences);
    }
    text
}

/// `first`: number of the first step. Bits and words are numbered as the steps before the transitions.
fn ring(text: &mut String, name: &str, first: usize, divergences: usize) {
    let steps = 6 * divergences + 1;
    for step in first..first + steps {
        let word = if step == first { "INITIAL_STEP" } else { "STEP" };
        writeln!(text, "{word} {name}{step} : END_STEP").expect("a string");
    }
    let mut cross = |from: &[usize], to: &[usize], receptivity: String| {
        let list = |steps: &[usize]| steps.iter().map(|it| format!("{name}{it}")).collect::<Vec<_>>().join(",");
        let (from, to) = (list(from), list(to));
        writeln!(text, "TRANSITION FROM ({from}) TO ({to}) := {receptivity}; END_TRANSITION").expect("a string");
    };
    let bit = |step: usize| format!("%M{step}");
    for at in 0..divergences {
        let start = first + 6 * at;
        let ([a, b], [c, d], end) = ([start + 1, start + 2], [start + 3, start + 4], start + 5);
        if at % 2 == 0 {
            cross(&[start], &[a], format!("%MW{start} > 100 AND %M{start}"));
            cross(&[start], &[c], format!("%MW{start} <= 100 AND %M{start} OR %MW{start} > 600 AND NOT %M{start}"));
            cross(&[b], &[end], bit(b));
            cross(&[d], &[end], bit(d));
        } else {
            cross(&[start], &[a, c], bit(start));
            cross(&[b, d], &[end], "TRUE".to_owned());
        }
        cross(&[a], &[b], bit(a));
        cross(&[c], &[d], bit(c));
        cross(&[end], &[start + 6], bit(end));
    }
    cross(&[first + steps - 1], &[first], bit(first + steps - 1));
}
