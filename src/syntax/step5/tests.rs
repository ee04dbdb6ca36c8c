use proptest::prelude::*;

use Mnemonics::{English, German};

use super::instruction;
use crate::syntax::awl::ast::{Instr, Listing, Network, Root};
use crate::syntax::awl::instruction::{ArithOp, JumpIf, NumberType, Op, Relation};
use crate::syntax::{AstNode as _, Mnemonics, Parse, SyntaxKind, SyntaxNode};

use super::parse;

/// The nodes and tokens below a node, blanks apart.
fn shape(node: SyntaxNode<'_>) -> String {
    let mut out = format!("({:?}", node.kind());
    for element in node.children_with_tokens() {
        match (element.into_node(), element.into_token()) {
            (Some(node), _) => out += &format!(" {}", shape(node)),
            (None, Some(token)) if !token.kind().is_trivia() => out += &format!(" {}", token.text()),
            _ => {}
        }
    }
    out + ")"
}

fn errors(parse: &Parse) -> Vec<String> {
    let text = parse.syntax().text().into_owned();
    parse
        .errors()
        .iter()
        .map(|it| format!("{}: {}", &text[std::ops::Range::<usize>::from(it.range)], it.message))
        .collect()
}

fn clean(text: &str) -> Parse {
    let parse = parse(text, German);
    assert_eq!(errors(&parse), [""; 0], "{text}");
    assert_eq!(parse.syntax().text(), text);
    parse
}

fn ops(text: &str, mnemonics: Mnemonics) -> Vec<Option<Op>> {
    let parse = parse(text, mnemonics);
    assert_eq!(errors(&parse), [""; 0], "{text}");
    parse.syntax().descendants().filter_map(Instr::cast).map(|it| instruction::op(it, mnemonics)).collect()
}

fn instructions(text: &str) -> Vec<String> {
    clean(text).syntax().descendants().filter(|it| it.kind() == SyntaxKind::Instr).map(shape).collect()
}

#[test]
fn with_and_without_colons() {
    let with = instructions("     :U    E   0.0\n     :UN   M 10.7\n     :=    A   4.0\n     :***\n");
    assert_eq!(with[0], "(Instr (Label :) U (Operand E   0.0))");
    assert_eq!(with[2], "(Instr (Label :) = (Operand A   4.0))");
    let without = instructions("U E0.0\nUN M 10.7\n= A 4.0\n***\n");
    assert_eq!(without, ["(Instr U (Operand E0.0))", "(Instr UN (Operand M 10.7))", "(Instr = (Operand A 4.0))"]);
    let printed = instructions("0005      :L     KT 200.1\n000A M001 :SV    T 3\n");
    assert_eq!(printed[0], "(Instr (Label 0005 :) L (Operand KT 200.1))");
    assert_eq!(printed[1], "(Instr (Label 000A M001 :) SV (Operand T 3))");
}

#[test]
fn instructions_of_both_sets() {
    let german =
        "U E 0.0\nSPA PB 10\nSPB FB 5\nSPA= M1\nSPB =M1\nM1 :BEB\nA DB 5\nL KF -1\n+F\n!= F\n:F\nxF\nKEW\nBE\n";
    let english = "A I 0.0\nJU PB 10\nJC FB 5\nJU= M1\nJC =M1\nM1 :BEC\nC DB 5\nL KF -1\n+F\n!=F\n:F\nXF\nCFW\nBE\n";
    assert_eq!(ops(german, German), ops(english, English));
    let found = ops(german, German);
    assert_eq!(
        found[1..5],
        [Op::CallUnconditional, Op::CallConditional, Op::Jump(JumpIf::Always), Op::Jump(JumpIf::Rlo)].map(Some)
    );
    let (int, add, div) = (NumberType::Int, ArithOp::Add, ArithOp::Div);
    assert_eq!(
        found[8..11],
        [Op::Arithmetic(add, int), Op::Compare(Relation::Eq, int), Op::Arithmetic(div, int)].map(Some)
    );
}

#[test]
fn instructions_that_share_a_line() {
    // GRF:222, 259.
    assert_eq!(instructions("U t3 U X2 S X1 R X3 ***").len(), 4);
    assert_eq!(
        instructions("U (U t2 O t3) R X1 ***"),
        ["(Instr U ()", "(Instr U (Operand t2))", "(Instr O (Operand t3))", "(Instr ))", "(Instr R (Operand X1))"]
    );
    assert_eq!(instructions("L Tt\nL KH0000\n!= F = M 1.0").len(), 4);
}

#[test]
fn an_or_alone_has_no_operand() {
    let found = instructions("U X10\nO\nU X20\nO X3\n= M 100.7\n");
    assert_eq!((found[1].as_str(), found[3].as_str()), ("(Instr O)", "(Instr O (Operand X3))"));
    assert_eq!(instructions("O U X20")[0], "(Instr O)");
}

#[test]
fn operands() {
    for (text, operand) in [
        ("L KH 00FF", "KH 00FF"),
        ("L KH????", "KH????"),
        ("L KM 00000000 11111111", "KM 00000000 11111111"),
        ("L KY 12,34", "KY 12,34"),
        ("L KG +1234567+02", "KG +1234567+02"),
        ("L KC AB", "KC AB"),
        ("L KF+5", "KF+5"),
        ("U D 3.15", "D 3.15"),
        ("L DW 3", "DW 3"),
        ("U =EIN", "= EIN"),
        ("U -START", "-START"),
        ("U Tp[10]", "Tp [ 10 ]"),
        ("U M Ts[100]", "M Ts [ 100 ]"),
        ("S X1↑", "X1↑"),
        ("L PY 128", "PY 128"),
    ] {
        assert!(instructions(text)[0].ends_with(&format!("(Operand {operand}))")), "{text}: {:?}", instructions(text));
    }
    assert_eq!(instructions("= =AUS"), ["(Instr = (Operand = AUS))"]);
    assert_eq!(instructions(":I 1\n:D 5\n"), ["(Instr (Label :) I (Operand 1))", "(Instr (Label :) D (Operand 5))"]);
}

#[test]
fn the_set_is_found_by_vote() {
    for (text, expected) in [
        ("U E 0.0\n", German),
        ("A I 0.0\n", English),
        ("L MW 0\nL MW 2\nOW\n", German),
        ("L FW 0\nL FW 2\nOW\n", English),
        ("", German),
    ] {
        assert_eq!(super::vote(text), expected, "{text}");
    }
}

#[test]
fn comments() {
    let parse = clean("U E 0.0 ; ready\nBEB   fin de bloc\nSPA PB 3\tInitialisation du tour\n***   end\nL MW 0 // x\n");
    assert_eq!(parse.syntax().descendants().filter(|it| it.kind() == SyntaxKind::Instr).count(), 4);
    let comments = parse.syntax().descendant_tokens().filter(|it| it.kind() == SyntaxKind::Comment);
    assert_eq!(
        comments.map(|it| it.text()).collect::<Vec<_>>(),
        ["; ready", "fin", "de", "bloc", "Initialisation", "du", "tour", "end", "// x"]
    );
}

#[test]
fn blocks_and_segments() {
    let text = "PB 10\n     :U E 0.0\n     := A 4.0\n     :***\n     :U E 0.1\n     := A 4.1\n     :BE\n\
                FB 5\nNAME :INITG1\nBEZ  :EIN   E/A/D/B/T/Z: E   BI/BY/W/D: BI\nDECL :AUS A W\n     :U   =EIN\n     :BE\n";
    let parse = clean(text);
    let blocks: Vec<SyntaxNode<'_>> = parse.syntax().children().collect();
    assert_eq!(blocks.len(), 2);
    assert_eq!(blocks[0].children().filter_map(Network::cast).count(), 2);
    assert!(shape(blocks[1]).contains("(BlockAttribute NAME : INITG1)"));
    assert!(
        shape(blocks[1]).contains("(VarName EIN)") && shape(blocks[1]).contains("(TypeRef E)"),
        "{}",
        shape(blocks[1])
    );
    assert!(
        shape(blocks[1]).contains("(TypeRef BI)") && shape(blocks[1]).contains("(TypeRef W)"),
        "{}",
        shape(blocks[1])
    );
    let listing = clean("U E 0.0\n***\nU E 0.1\n***\n");
    let root = Root::cast(listing.syntax()).and_then(|it| it.listings().next());
    assert_eq!(root.map(Listing::networks).into_iter().flatten().count(), 2);
    let parse = clean("NETZWERK 1   0000\n:U E 0.0\n:***\nNETZWERK 2   0005\n:U E 0.1\n:***\n:BE\n");
    assert_eq!(parse.syntax().descendants().filter(|it| it.kind() == SyntaxKind::NetworkHeader).count(), 2);
}

#[test]
fn calls_of_function_blocks() {
    let text = "     :SPA  FB 5\nNAME :INITG1\nEIN  :    E 0.0\nZAHL :    KF +5\nAUS  :    -LAMPE\nM001 :U E 1.0\n";
    let parse = clean(text);
    let lists: Vec<String> =
        parse.syntax().descendants().filter(|it| it.kind() == SyntaxKind::ArgList).map(shape).collect();
    assert_eq!(lists.len(), 1);
    assert!(lists[0].contains("(Arg EIN : (Operand E 0.0))") && lists[0].contains("(Arg AUS :"), "{lists:?}");
    assert!(!lists[0].contains("M001"));
    // GRF:1233-1240.
    assert_eq!(instructions("SPA FB10\nnom : initG1\nSPA FB20\nnom : initG2\nBE").len(), 3);
    // A label behind a call is one.
    assert_eq!(instructions("SPA FB 1\nM001 :T MW 5\nM002 :D 1\n").len(), 3);
}

#[test]
fn data_blocks() {
    let parse = clean("DB 10\n0:      KH = 0000;\n1:      KF = +00005;\n 2:  KC = 'AB';\n3: KH = 0000; 4711;\n");
    assert_eq!(parse.syntax().descendants().filter(|it| it.kind() == SyntaxKind::DataInit).count(), 4);
}

#[test]
fn faults_cost_their_line() {
    for (text, expected) in [
        ("XYZ E 0.0", "XYZ: unknown instruction `XYZ`"),
        ("U", "U: `U` needs a bit as its operand"),
        (
            "AN E 0.0",
            "AN: unknown instruction `AN`; it is an international mnemonic, and this program is read with the German ones",
        ),
        ("L KF", "L: `L` needs"),
        ("U E 0.0 )x", ""),
        ("BEB 5", "5: expected the end of the instruction"),
        ("%", "%: expected an instruction"),
    ] {
        let whole = format!("U E 0.0\n{text}\n= A 4.0\n");
        let parse = parse(&whole, German);
        let found = errors(&parse);
        assert!(found.len() <= 1 || text.contains(')'), "{text}: {found:?}");
        if !expected.is_empty() && !text.starts_with("L KF") {
            assert_eq!(found, [expected], "{text}");
        }
        let last = parse.syntax().descendants().filter(|it| it.kind() == SyntaxKind::Instr).last().map(shape);
        assert_eq!(last.as_deref(), Some("(Instr = (Operand A 4.0))"), "{text}");
    }
}

/// In quadratic time these would take minutes.
#[test]
fn hostile_input_is_kept() {
    let size = 60_000;
    for text in [
        "U(".repeat(size),
        "U(\n".repeat(size),
        "***".repeat(size),
        ":".repeat(size),
        "a:".repeat(size),
        "[".repeat(size),
        "U a[".repeat(size / 4),
        "PB 1\n".repeat(size / 5),
        "SPA FB 1\nx :E 0.0\n".repeat(size / 16),
        "BEZ :x E/A: E\n".repeat(size / 8),
        "DB 1\n0: KH = 0;\n".repeat(size / 8),
        "!= ".repeat(size),
        "KF ".repeat(size),
        "é".repeat(size),
        "=".repeat(size),
        " ".repeat(size),
        "U t1 ".repeat(size),
        "NAME :".repeat(size),
        ";".repeat(size),
    ] {
        for mnemonics in [German, English] {
            assert_eq!(parse(&text, mnemonics).syntax().text(), text.as_str());
        }
    }
}

const SAMPLE: &str = "FB 5\nNAME :INITG1\nBEZ  :EIN   E/A/D/B/T/Z: E   BI/BY/W/D: BI\n0005 M001 :U   =EIN\n     :U(\n     :O -X1\n\
    :)\n:L KT 200.1\n:SV T 3\n:!=F\n:SPB =M001\n:SPA FB 6\nNAME :X\nA    :  KF +5\n:***\nDB 3\n0: KH = 0000;\n:BE\n";

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn any_text_is_kept(text in "\\PC*|[\\x00-\\x7f\u{80}-\u{ff}]{0,200}") {
        for mnemonics in [German, English] {
            let parse = parse(&text, mnemonics);
            prop_assert_eq!(parse.syntax().text(), text.as_str());
        }
    }

    #[test]
    fn any_words_are_kept(words in proptest::collection::vec(
        prop::sample::select(SAMPLE.split_inclusive([' ', '\n', '(', ':', '=', '-', '.']).collect::<Vec<_>>()), 0..60,
    )) {
        let text = words.concat();
        let parse = parse(&text, German);
        prop_assert_eq!(parse.syntax().text(), text.as_str());
        for error in parse.errors() {
            prop_assert!(text.get(std::ops::Range::<usize>::from(error.range)).is_some());
        }
    }
}
