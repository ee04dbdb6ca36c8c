//! Words that the language reserves, told apart without allocation and regardless of case.

macro_rules! words {
    ($(#[$meta:meta])* $vis:vis enum $name:ident { $($word:ident = $text:literal),* $(,)? }) => {
        $(#[$meta])*
        $vis enum $name { $($word),* }

        impl $name {
            /// Every word, in the order of the variants.
            #[allow(dead_code, reason = "some tables have lists of their own")]
            pub(super) const WORDS: &[&str] = &[$($text),*];

            $vis fn of(text: &str) -> Option<Self> {
                const ALL: &[$name] = &[$($name::$word),*];
                static INDEX: crate::syntax::packed::Index<{ ALL.len() }> =
                    crate::syntax::packed::Index::new([$($text),*]);
                INDEX.find(text).and_then(|it| ALL.get(it).copied())
            }
        }
    };
}
pub(super) use words;

words! {
    /// Words that structure a text or an expression and are therefore no operands.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub(super) enum Keyword {
        If = "IF",
        Then = "THEN",
        Elsif = "ELSIF",
        Elseif = "ELSEIF",
        Else = "ELSE",
        EndIf = "END_IF",
        While = "WHILE",
        Do = "DO",
        EndWhile = "END_WHILE",
        Repeat = "REPEAT",
        Until = "UNTIL",
        EndRepeat = "END_REPEAT",
        For = "FOR",
        To = "TO",
        EndFor = "END_FOR",
        Exit = "EXIT",
        Jump = "JUMP",
        Return = "RETURN",
        Halt = "HALT",
        And = "AND",
        Or = "OR",
        Xor = "XOR",
        Not = "NOT",
        Rem = "REM",
        Re = "RE",
        Fe = "FE",
        True = "TRUE",
        False = "FALSE",
        Program = "PROGRAM",
        EndProgram = "END_PROGRAM",
        Rung = "RUNG",
        EndRung = "END_RUNG",
        EndBlock = "END_BLOCK",
    }
}

impl Keyword {
    /// Whether the word is one only where rungs stand: elsewhere it may be a symbol.
    pub(super) fn is_of_ladder(self) -> bool {
        matches!(self, Self::Rung | Self::EndRung | Self::EndBlock)
    }
}

/// Number of the subroutine that `SR5` or `%SR5` calls; `None` for any other word.
pub(super) fn subroutine(text: &str) -> Option<u32> {
    let text = text.strip_prefix('%').unwrap_or(text);
    let (word, number) = text.split_at_checked(2)?;
    if word.eq_ignore_ascii_case("SR") && number.bytes().all(|it| it.is_ascii_digit()) {
        return number.parse().ok();
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_ignore_case_and_nothing_else() {
        assert_eq!(Keyword::of("end_While"), Some(Keyword::EndWhile));
        for text in ["", "END_WHILE_", "ENDWHILE", "IFF", "é", "A_WORD_BEYOND_SIXTEEN_BYTES"] {
            assert_eq!(Keyword::of(text), None, "{text}");
        }
    }

    #[test]
    fn subroutines() {
        assert_eq!(subroutine("SR12"), Some(12));
        assert_eq!(subroutine("%sr0"), Some(0));
        for text in ["SR", "%SR", "SRi", "SR99999999999", "S", "é", "SR+1"] {
            assert_eq!(subroutine(text), None, "{text}");
        }
    }
}
