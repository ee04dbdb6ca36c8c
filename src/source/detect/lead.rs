//! Words that lines start with.

use std::sync::LazyLock;

use rustc_hash::FxHashMap;

use crate::syntax::pl7::ladder_words;

/// What the languages make of a word that a line starts with.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Lead(u32);

impl Lead {
    /// Instructions of PL7 with an operand, and those without; its statements on objects.
    pub(super) const PL7_OPERAND: u32 = 1;
    pub(super) const PL7_BARE: u32 = 1 << 1;
    pub(super) const PL7_STATEMENT: u32 = 1 << 2;
    /// Words that only DFB types have, and those that have another operand there.
    pub(super) const DFB: u32 = 1 << 3;
    pub(super) const DFB_OPERAND: u32 = 1 << 4;
    /// The frame of a rung, and an element of it. Words without an underscore are words of other languages too.
    pub(super) const RUNG: u32 = 1 << 5;
    pub(super) const CELL: u32 = 1 << 6;
    pub(super) const PAGE: u32 = 1 << 7;
    pub(super) const CHART: u32 = 1 << 8;
    /// If the rest of the line agrees.
    pub(super) const CHART_LINE: u32 = 1 << 9;
    pub(super) const GRAPH: u32 = 1 << 10;
    pub(super) const IEC: u32 = 1 << 11;
    pub(super) const SECTION: u32 = 1 << 12;
    pub(super) const STEP7: u32 = 1 << 13;
    pub(super) const SCL: u32 = 1 << 14;
    /// Instructions of STEP 7 by what they want behind them: an operand or a parenthesis; these or nothing; an operand; an
    /// operand or nothing; nothing; a label; a block; a parenthesis.
    pub(super) const CHECK: u32 = 1 << 15;
    pub(super) const OR: u32 = 1 << 16;
    pub(super) const OPERAND: u32 = 1 << 17;
    pub(super) const OPTIONAL: u32 = 1 << 18;
    pub(super) const ALONE: u32 = 1 << 19;
    pub(super) const JUMP: u32 = 1 << 20;
    pub(super) const CALL: u32 = 1 << 21;
    pub(super) const OPEN: u32 = 1 << 22;

    const WORDS: &[(u32, &str)] = &[
        (
            Self::PL7_OPERAND,
            "LD LDN LDR LDF AND ANDN ANDR ANDF OR ORN ORR ORF XOR XORN XORR XORF ST STN S R JMP JMPC JMPCN IN CU \
             CD BLK",
        ),
        (Self::PL7_BARE, "MPS MRD MPP RETC RETCN ENDC ENDCN END_BLK OUT_BLK"),
        (Self::PL7_STATEMENT, "IF ELSIF ELSEIF WHILE FOR UNTIL SET RESET INC DEC"),
        (Self::DFB, "VAR_PUBLIC VAR_PRIVATE FTON FTOF FTP FPULSOR"),
        (Self::DFB_OPERAND, "SET RESET INC DEC"),
        (Self::RUNG, "RUNG END_RUNG"),
        (
            Self::PAGE,
            "NB_PAGES END_PAGE T_S_OR_LINK S_T_OR_LINK T_S_AND_LINK S_T_AND_LINK SOURCE_CONNECTOR DEST_CONNECTOR",
        ),
        (Self::CHART, "INITIAL_STEP END_STEP END_TRANSITION MACRO_STEP IN_STEP OUT_STEP"),
        (Self::CHART_LINE, "STEP TRANSITION ACTION END_ACTION PAGE"),
        (Self::GRAPH, "SEQUENCE END_SEQUENCE GRAPH7"),
        (Self::IEC, "VAR_GLOBAL PROGRAM END_PROGRAM CONFIGURATION VAR_EXTERNAL"),
        (Self::SECTION, "VAR VAR_INPUT VAR_OUTPUT VAR_IN_OUT END_VAR"),
        (Self::STEP7, "VAR_TEMP STRUCT END_STRUCT BEGIN NETWORK TITLE VERSION AUTHOR FAMILY KNOW_HOW_PROTECT"),
        (Self::SCL, "IF ELSIF ELSE END_IF CASE END_CASE FOR END_FOR WHILE END_WHILE REPEAT END_REPEAT REGION"),
        (Self::CHECK, "U UN A AN ON X XN"),
        (Self::OR, "O"),
        (Self::OPERAND, "S R FP FN L T SI SV SE SS SA SP SD SF FR ZV ZR CU CD LC AUF OPN INC DEC NOP BLD"),
        (
            Self::JUMP,
            "SPA SPB SPBN SPBB SPBNB SPBI SPBIN SPL SPM SPMZ SPN SPO SPP SPPZ SPS SPU SPZ JU JC JCN JCB JNB JBI \
             JNBI JL JM JMZ JN JO JP JPZ JOS JUO JZ LOOP",
        ),
        (Self::CALL, "CALL UC CC"),
        (Self::OPTIONAL, "UW OW XOW UD OD XOD AW AD SSI SSD SLW SRW SLD SRD RLD RRD LAR1 LAR2 TAR1 TAR2"),
        (
            Self::ALONE,
            "BE BEA BEB BEU BEC SET CLR NOT SAVE TAK ENT LEAVE INVI INVD NEGI NEGD NEGR BTI ITB BTD DTB ITD DTR \
             RND TRUNC TAW TAD CAW CAD TAR CAR TDB CDB MCRA MCRD MOD RLDA RRDA",
        ),
        (Self::OPEN, "MCR"),
    ];

    /// Of a word in capitals.
    pub(super) fn of(word: &str) -> Self {
        static LEADS: LazyLock<FxHashMap<&str, Lead>> = LazyLock::new(|| {
            let mut leads: FxHashMap<&str, Lead> = FxHashMap::default();
            let groups = Lead::WORDS.iter().flat_map(|(mark, words)| words.split(' ').map(move |it| (it, *mark)));
            let cells = ladder_words::all().iter().map(|it| (it.text, Lead::CELL)).filter(|it| it.0.contains('_'));
            groups.chain(cells).for_each(|(word, mark)| leads.entry(word).or_default().0 |= mark);
            leads
        });
        if word.is_empty() { Self::default() } else { LEADS.get(word).copied().unwrap_or_default() }
    }

    pub(super) fn is(self, mark: u32) -> bool {
        self.0 & mark != 0
    }
}
