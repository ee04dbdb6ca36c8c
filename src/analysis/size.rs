//! What a PL7 program takes of the memory of a processor (PL7:1528-1728).

use super::program::ProgramIndex;
use crate::model::entity::Entity;
use crate::syntax::Language;
use crate::target::pl7::Memory;

/// What a program takes of the memory that holds most of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Share {
    pub thousandths: u64,
    /// Elements of ladder, instructions of list, statements of text.
    pub instructions: [u64; 3],
}

/// The least share that a program takes of any of the memories; `None` when there are none. Code of charts and of DFB types,
/// whose language is not asked for, counts as that of which most fits.
pub fn share(program: &ProgramIndex<'_>, memories: &[Memory]) -> Option<Share> {
    let mut instructions = [0_u64; 3];
    let mut others = 0;
    for facts in &program.units {
        let count = u64::from(facts.instructions);
        match (facts.language, &facts.entity) {
            (_, Entity::Dfb { .. }) => others += count,
            (Language::Pl7Ld, _) => instructions[0] += count,
            (Language::Pl7Il, _) => instructions[1] += count,
            (Language::Pl7St, _) => instructions[2] += count,
            _ => others += count,
        }
    }
    let thousandths = memories.iter().map(|it| thousandths(&instructions, others, it)).min()?;
    Some(Share { thousandths, instructions })
}

/// The first row of a table is for programs that are Boolean throughout, in units of 102.4 instructions.
fn thousandths(instructions: &[u64; 3], others: u64, memory: &Memory) -> u64 {
    let [boolean, ..] = memory.program;
    let most = boolean.into_iter().max().unwrap_or(1);
    let parts = instructions.iter().copied().zip(boolean).chain([(others, most)]);
    parts.map(|(count, room)| count.saturating_mul(10_000) / (u64::from(room.max(1)) * 1024)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::target::Target;

    #[test]
    fn shares_of_a_memory() {
        let target: Target = "TSX 37-05".parse().unwrap_or_else(|it| panic!("{it}"));
        let [memory] = target.processor().map_or(&[][..], |it| it.memory) else { panic!("one column") };
        // 2 Ki of list, 1.6 Ki of ladder, 1.3 Ki of text (PL7:1535-1538).
        assert_eq!(thousandths(&[0, 2048, 0], 0, memory), 1000);
        assert_eq!(thousandths(&[0, 1024, 0], 1024, memory), 1000);
        assert_eq!(thousandths(&[1639, 0, 1332], 0, memory), 2000);
        assert!(thousandths(&[0, 0, u64::MAX], 0, memory) > 1000);
    }
}
