//! STEP 5: program blocks as listings print them, which an organization block calls.

use std::fmt::Write as _;

use super::{DEVICES, Random, STATES};

/// Blocks of a kind that a controller has.
const MOST_BLOCKS: u64 = 255;

/// A program of some `bytes`, of German mnemonics. One of more than 100 KB has blocks of one number.
pub fn step5(bytes: usize, seed: u64) -> String {
    let mut random = Random::new(seed);
    let mut text = String::with_capacity(bytes + 4096);
    let mut count = 0;
    while text.len() + 400 < bytes {
        block(&mut text, &mut random, count % MOST_BLOCKS + 1).expect("a string");
        count += 1;
    }
    text.push_str("OB 1                      ; Programme cyclique\n");
    for number in 1..=count.min(MOST_BLOCKS) {
        writeln!(text, "     :SPA  PB {number}").expect("a string");
    }
    text.push_str("     :BE\n");
    text
}

fn block(text: &mut String, random: &mut Random, number: u64) -> std::fmt::Result {
    writeln!(text, "PB {number}                      ; {}", random.pick(DEVICES))?;
    writeln!(text, "     :A    DB {}", number % 250 + 3)?;
    for segment in 0..6 + random.below(20) {
        if segment > 0 {
            writeln!(text, "     :***")?;
        }
        let state = random.pick(STATES);
        let mut input = || format!("E {}.{}", random.below(64), random.below(8));
        let (first, second, third) = (input(), input(), input());
        // Each is driven in one segment of a program of 50 KB.
        let output = (number * 26 + segment) % 1024;
        let output = format!("A {}.{}", output / 8, output % 8);
        match random.below(6) {
            0 | 1 => writeln!(
                text,
                "     :U    {first}              ; {state}\n     :UN   {second}\n     :O    {third}\n     :=    {output}"
            )?,
            2 => writeln!(
                text,
                "     :U(\n     :O    {first}\n     :O    {second}\n     :)\n     :UN   {third}\n     :=    {output}"
            )?,
            3 => writeln!(
                text,
                "     :U    {first}\n     :S    {output}\n     :UN   {second}\n     :R    {output}              ; {state}"
            )?,
            4 => {
                let constant = random.below(900);
                writeln!(text, "     :L    DW {segment}\n     :L    KF +{constant}\n     :>F\n     :=    {output}")?;
            }
            _ => {
                let (from, to) = (random.below(60), 100 + segment);
                writeln!(text, "     :L    EW {from}              ; {state}\n     :T    DW {to}")?;
                writeln!(text, "     :U    {first}\n     :=    {output}")?;
            }
        }
    }
    writeln!(text, "     :BE\n")
}
