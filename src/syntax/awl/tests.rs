use std::fmt::Write as _;
use std::ops::Range;

use crate::syntax::AstNode as _;
use proptest::prelude::*;

use super::ast::{Block, Instr, Listing, Root, VarDecl, VarSection};
use super::instruction::{Op, OperandRule, lookup};
use super::{parse, vote};
use crate::syntax::{Mnemonics, Parse, SyntaxElement, SyntaxKind, SyntaxNode};

use Mnemonics::{English, German};

/// The tree without trivia: `(Instr U (Operand E 0.0) ;)`.
fn shape(node: SyntaxNode<'_>) -> String {
    let mut out = format!("({:?}", node.kind());
    for child in node.children_with_tokens() {
        match child {
            SyntaxElement::Node(node) => write!(out, " {}", shape(node)).unwrap(),
            SyntaxElement::Token(token) if token.kind().is_trivia() => {}
            SyntaxElement::Token(token) => write!(out, " {}", token.text()).unwrap(),
        }
    }
    out.push(')');
    out
}

fn messages(text: &str, parse: &Parse) -> Vec<(String, String)> {
    parse.errors().iter().map(|it| (text[Range::<usize>::from(it.range)].to_owned(), it.message.clone())).collect()
}

/// Trees of tests live as long as the tests.
fn keep(parse: Parse) -> &'static Parse {
    Box::leak(Box::new(parse))
}

/// Parses a text that must be faultless.
fn clean(text: &str, mnemonics: Mnemonics) -> Root<'static> {
    let parse = keep(parse(text, mnemonics));
    assert_eq!(messages(text, parse), [], "{text}");
    assert_eq!(parse.syntax().text(), text);
    Root::cast(parse.syntax()).unwrap()
}

fn root_of(text: &str, mnemonics: Mnemonics) -> (Root<'static>, Vec<(String, String)>) {
    let parse = keep(parse(text, mnemonics));
    assert_eq!(parse.syntax().text(), text);
    (Root::cast(parse.syntax()).unwrap(), messages(text, parse))
}

fn only_listing<'t>(root: &Root<'t>) -> Listing<'t> {
    let mut listings = root.listings();
    let listing = listings.next().unwrap();
    assert!(listings.next().is_none() && root.blocks().next().is_none());
    listing
}

fn instrs<'t>(root: &Root<'t>) -> Vec<Instr<'t>> {
    root.syntax().descendants().filter_map(Instr::cast).collect()
}

/// Shapes of the instructions of a faultless listing.
fn code(text: &str, mnemonics: Mnemonics) -> Vec<String> {
    let root = clean(text, mnemonics);
    only_listing(&root);
    instrs(&root).iter().map(|it| shape(it.syntax())).collect()
}

fn one(text: &str, mnemonics: Mnemonics) -> String {
    let mut all = code(text, mnemonics);
    assert_eq!(all.len(), 1, "{text}: {all:?}");
    all.pop().unwrap()
}

fn only_block(text: &str, mnemonics: Mnemonics) -> Block<'static> {
    let root = clean(text, mnemonics);
    let blocks: Vec<_> = root.blocks().collect();
    let [block] = blocks.as_slice() else { panic!("{}", shape(root.syntax())) };
    *block
}

fn decls<'t>(section: &VarSection<'t>) -> Vec<VarDecl<'t>> {
    section.decls().collect()
}

// Blocks and their headers.

#[test]
fn header_of_a_function() {
    let block = only_block(
        "FUNCTION FC 1 : VOID\nTITLE =Start // up\n// comment\n{ S7_m_c := 'true' ;\n  x := '1' }\nAUTHOR : A. Name // who\n\
         FAMILY:'W/9'\nNAME : INIT;\nVERSION : 0.1\nKNOW_HOW_PROTECT\n\nVAR_INPUT\n  a : INT ;\nEND_VAR\nBEGIN\n\
         NETWORK\nTITLE =First\n      NOP   0;\nEND_FUNCTION\n",
        German,
    );
    let header = block.header().unwrap();
    assert_eq!(header.keyword().unwrap().text(), "FUNCTION");
    assert_eq!(header.name().unwrap().text(), "FC 1");
    assert_eq!(header.return_type().unwrap().text(), "VOID");
    assert_eq!(block.title().unwrap().text().unwrap().text(), "Start // up");
    let attributes: Vec<_> = block
        .attributes()
        .map(|it| (it.keyword().map(|it| it.text().to_owned()), it.value().map(|it| it.text().to_owned())))
        .collect();
    let pair = |key: &str, value: Option<&str>| (Some(key.to_owned()), value.map(str::to_owned));
    assert_eq!(
        attributes,
        [
            (None, None),
            pair("AUTHOR", Some("A. Name")),
            pair("FAMILY", Some("'W/9'")),
            pair("NAME", Some("INIT")),
            pair("VERSION", Some("0.1")),
            pair("KNOW_HOW_PROTECT", None),
        ]
    );
    assert!(block.attributes().next().unwrap().system_attributes().unwrap().text().ends_with("'1' }"));
    let network = block.networks().next().unwrap();
    assert_eq!(network.title().unwrap().text().unwrap().text(), "First");
    assert_eq!(network.instrs().count(), 1);
}

#[test]
fn header_on_one_line_and_in_lower_case() {
    let block = only_block(
        "function fc1:void author : me version : 0.1 var_temp x : bool; end_var begin network u e 0.0; = #x; end_function",
        German,
    );
    assert_eq!(block.attributes().count(), 2);
    assert_eq!(block.attributes().next().unwrap().value().unwrap().text(), "me");
    assert_eq!(block.sections().count(), 1);
    assert_eq!(block.networks().next().unwrap().instrs().count(), 2);
}

#[test]
fn all_kinds_of_blocks_in_one_text() {
    let root = clean(
        "ORGANIZATION_BLOCK \"Main\"\nBEGIN\nEND_ORGANIZATION_BLOCK\n\
         FUNCTION_BLOCK FB 1\nBEGIN\nEND_FUNCTION_BLOCK;\n\
         FUNCTION \"f\" : UDT 4\nBEGIN\nEND_FUNCTION\n\
         DATA_BLOCK DB_FAULTS\n STRUCT \n x : BOOL ;\n END_STRUCT ;\nBEGIN\nEND_DATA_BLOCK\n\
         TYPE UDT 1\n  STRUCT\n x : INT;\n END_STRUCT\nEND_TYPE\n",
        English,
    );
    let names: Vec<_> = root
        .blocks()
        .map(|it| (it.header().unwrap().keyword().unwrap().text().to_owned(), it.header().unwrap().name().unwrap()))
        .map(|(keyword, name)| (keyword, name.text().to_string(), name.is_symbol()))
        .collect();
    let expected = [
        ("ORGANIZATION_BLOCK", "Main", true),
        ("FUNCTION_BLOCK", "FB 1", false),
        ("FUNCTION", "f", true),
        ("DATA_BLOCK", "DB_FAULTS", false),
        ("TYPE", "UDT 1", false),
    ];
    assert_eq!(names, expected.map(|(keyword, name, is_symbol)| (keyword.to_owned(), name.to_owned(), is_symbol)));
}

#[test]
fn data_block_of_a_type() {
    for (text, of) in [
        ("DATA_BLOCK DB 2 FB 1 BEGIN END_DATA_BLOCK", "FB 1"),
        ("DATA_BLOCK DB 2\n FB 1\nTITLE = x\nBEGIN\nEND_DATA_BLOCK", "FB 1"),
        ("DATA_BLOCK DB 2\nVERSION : 0.1\n UDT 7\nBEGIN\nEND_DATA_BLOCK", "UDT 7"),
        ("DATA_BLOCK \"d\"\nNON_RETAIN\n \"valve\"\nBEGIN\nEND_DATA_BLOCK", "\"valve\""),
        ("DATA_BLOCK DB 2\nSFB4;\nBEGIN\nEND_DATA_BLOCK", "SFB4"),
    ] {
        assert_eq!(only_block(text, German).type_ref().unwrap().text(), of, "{text}");
    }
}

#[test]
fn data_block_with_values() {
    let block = only_block(
        "DATA_BLOCK DB 5\nREAD_ONLY\nUNLINKED\nSTANDARD\nSTRUCT\n a : INT;\nEND_STRUCT\nBEGIN\n   a := 5;\n   A.b[1, 2].c := W#16#0\n \
         \"x y\" := TRUE;\n T1 := -1.5e3; d := B#(1,2,3,4); s := 'a$'b;';\nEND_DATA_BLOCK",
        German,
    );
    assert_eq!(block.attributes().count(), 3);
    let values: Vec<_> = block.data_inits().map(|it| shape(it.syntax())).collect();
    assert_eq!(
        values,
        [
            "(DataInit (Operand a) (InitValue := 5) ;)",
            "(DataInit (Operand A . b [ (Operand 1) , (Operand 2) ] . c) (InitValue := W#16#0))",
            "(DataInit (Operand \"x y\") (InitValue := TRUE) ;)",
            "(DataInit (Operand T1) (InitValue := - 1.5e3) ;)",
            "(DataInit (Operand d) (InitValue := B#(1,2,3,4)) ;)",
            "(DataInit (Operand s) (InitValue := 'a$'b;') ;)",
        ]
    );
    assert_eq!(block.data_inits().next().unwrap().target().unwrap().text(), "a");
    assert_eq!(block.data_inits().next().unwrap().value().unwrap().tokens().count(), 1);
}

// Declarations.

#[test]
fn sections_and_types() {
    let block = only_block(
        "FUNCTION_BLOCK FB 1\nVAR_INPUT\n  a, b {S7_x := '1'} : BOOL := TRUE; // first\n  t : TIMER;\nEND_VAR\n\
         VAR_OUTPUT\n  s : STRING [10] := 'x';\nEND_VAR\nVAR_IN_OUT\n  p : ANY;\nEND_VAR\n\
         VAR\n  m : FB 2;\n  n : \"motor\";\n  u : UDT 3;\n  NAME : STRING\n  TITLE : INT;\n  version: REAL := -1.0\nEND_VAR\n\
         VAR RETAIN\n x AT y : WORD;\nEND_VAR\nVAR CONSTANT\n k : INT := 1;\nEND_VAR\nVAR_TEMP\nEND_VAR\nBEGIN\nEND_FUNCTION_BLOCK",
        German,
    );
    let sections: Vec<_> = block.sections().collect();
    let keywords: Vec<_> = sections.iter().map(|it| it.keyword().unwrap().text().to_owned()).collect();
    assert_eq!(keywords, ["VAR_INPUT", "VAR_OUTPUT", "VAR_IN_OUT", "VAR", "VAR", "VAR", "VAR_TEMP"]);
    let first = &decls(&sections[0])[0];
    assert_eq!(first.names().map(|it| it.text().to_string()).collect::<Vec<_>>(), ["a", "b"]);
    assert_eq!(first.type_ref().unwrap().text(), "BOOL");
    assert_eq!(shape(first.init().unwrap().syntax()), "(InitValue := TRUE)");
    let string = decls(&sections[1])[0].type_ref().unwrap();
    assert_eq!((string.text().as_str(), string.length().unwrap().text()), ("STRING [10]", "10"));
    let types: Vec<_> = decls(&sections[3]).iter().map(|it| it.type_ref().unwrap().text()).collect();
    assert_eq!(types, ["FB 2", "\"motor\"", "UDT 3", "STRING", "INT", "REAL"]);
    assert_eq!(decls(&sections[4])[0].view_of().unwrap().text(), "y");
}

#[test]
fn structures_and_arrays() {
    let block = only_block(
        "DATA_BLOCK DB 1\nSTRUCT\n  f : ARRAY  [0 .. 9, -1..+1 ] OF //ten\n  INT := 3(0), 1, 2 (5, 3(6)),\n 7;\n\
         \x20 g : STRUCT \t\n    h : ARRAY [1..2] OF STRUCT\n i : BOOL;\n END_STRUCT\n    j : REAL ;\n  END_STRUCT ;\n\
         \x20 k : ARRAY[1..2] OF ARRAY [3..4] OF CHAR := 'a', 'b';\nEND_STRUCT;\nBEGIN\nEND_DATA_BLOCK",
        German,
    );
    let section = block.sections().next().unwrap();
    assert_eq!(section.keyword().unwrap().text(), "STRUCT");
    let all = decls(&section);
    let [f, g, k] = all.as_slice() else { panic!("{}", shape(section.syntax())) };
    let array = f.array_type().unwrap();
    let bound = |low: &str, high: &str| (low.to_owned(), high.to_owned());
    assert_eq!(array.bounds(), [bound("0", "9"), bound("-1", "+1")]);
    assert_eq!(array.type_ref().unwrap().text(), "INT");
    assert_eq!(shape(f.init().unwrap().syntax()), "(InitValue := 3 ( 0 ) , 1 , 2 ( 5 , 3 ( 6 ) ) , 7)");
    let inner: Vec<_> = g.struct_type().unwrap().decls().collect();
    assert_eq!(inner.len(), 2);
    assert_eq!(inner[0].array_type().unwrap().struct_type().unwrap().decls().count(), 1);
    assert_eq!(k.array_type().unwrap().array_type().unwrap().bounds(), [bound("3", "4")]);
}

// Networks, statements, labels.

#[test]
fn networks() {
    let root = clean(
        "U E 0.0\nNETWORK\nTITLE =\n// only a comment\nNETWORK 3 : Motor (on)\n= A 4.0\nNetzwerk 4 : Pumpe\nNETWORK TITLE=x\nNOP 0\n\
         Réseau 5\nO M 0.0",
        German,
    );
    let networks: Vec<_> = only_listing(&root).networks().collect();
    let seen: Vec<_> =
        networks.iter().map(|it| (it.header().is_some(), it.title().is_some(), it.instrs().count())).collect();
    assert_eq!(
        seen,
        [(false, false, 1), (true, true, 0), (true, false, 1), (true, false, 0), (true, true, 1), (true, false, 1)]
    );
    assert_eq!(shape(networks[2].header().unwrap().syntax()), "(NetworkHeader NETWORK 3 : Motor (on))");
}

#[test]
fn statements_end_at_semicolon_or_newline() {
    let text = "U E 0.0; UN E 0.1;O M 0.0\n\n= A 4.0 ; // done\r\n;;\rSET\rS M 1.0;";
    assert_eq!(
        code(text, German),
        [
            "(Instr U (Operand E 0.0) ;)",
            "(Instr UN (Operand E 0.1) ;)",
            "(Instr O (Operand M 0.0))",
            "(Instr = (Operand A 4.0) ;)",
            "(Instr SET)",
            "(Instr S (Operand M 1.0) ;)",
        ]
    );
}

#[test]
fn labels() {
    assert_eq!(
        code("M001: A I 0.0;\nETI : BEU\nalone:\nlast: ;\n_001: NOP 0\nset: SET\nm1: m2: L 5", English),
        [
            "(Instr (Label M001 :) A (Operand I 0.0) ;)",
            "(Instr (Label ETI :) BEU)",
            "(Instr (Label alone :))",
            "(Instr (Label last :) ;)",
            "(Instr (Label _001 :) NOP (Operand 0))",
            "(Instr (Label set :) SET)",
            "(Instr (Label m1 :))",
            "(Instr (Label m2 :) L (Operand 5))",
        ]
    );
    let instr = instrs(&clean("alone:", English)).pop().unwrap();
    assert_eq!((instr.mnemonic(), instr.op(English)), (None, None));
    assert_eq!(instr.label().unwrap().name().unwrap().text(), "alone");
}

#[test]
fn parentheses() {
    assert_eq!(
        code("U(\nO E 0.0\n)\nUN (;ON( ; O(;X(;XN(;) ;\nMCR(\n)MCR\n) MCR;", German),
        [
            "(Instr U ()",
            "(Instr O (Operand E 0.0))",
            "(Instr ))",
            "(Instr UN ( ;)",
            "(Instr ON ( ;)",
            "(Instr O ( ;)",
            "(Instr X ( ;)",
            "(Instr XN ( ;)",
            "(Instr ) ;)",
            "(Instr MCR ()",
            "(Instr ) MCR)",
            "(Instr ) MCR ;)",
        ]
    );
    let root = clean("a: u (\n) mcr", German);
    let seen: Vec<_> =
        instrs(&root).iter().map(|it| (it.mnemonic().unwrap().text.to_string(), it.op(German).unwrap())).collect();
    assert_eq!(seen, [("U(".to_owned(), Op::AndOpen), (")MCR".to_owned(), Op::McrClose)]);
}

#[test]
fn elisions_are_kept_visible() {
    let root = clean("...\nABCD: ...\n.....  (suite identique)\nU E 0.0 // ...\n… // suite", German);
    let network = only_listing(&root).networks().next().unwrap();
    assert!(network.is_elided());
    assert_eq!(
        shape(network.syntax()),
        "(Network ... (Instr (Label ABCD :)) ... .....  (suite identique) (Instr U (Operand E 0.0)) …)"
    );
    assert!(!only_listing(&clean("U E 0.0", German)).networks().next().unwrap().is_elided());
}

#[test]
fn heading_of_a_listing() {
    let root = clean("// x\nBloc FC1 :\n\nS «X0»\nBE\nBloc « init » :\nBE", German);
    let names: Vec<_> = root.listings().map(|it| it.header().unwrap().name().unwrap().text().to_string()).collect();
    assert_eq!(names, ["FC1", "init"]);
}

#[test]
fn listing_with_symbol_information() {
    assert_eq!(
        code("A     \"start\"       I     0.4     -- start; button\nR \"alm\".x DB202.DBX102.1", English),
        ["(Instr A (Operand \"start\") I     0.4)", "(Instr R (Operand \"alm\" . x) DB202.DBX102.1)"]
    );
}

// Operands.

fn operand(text: &str) -> String {
    let listing = format!("L {text}");
    let shape = one(&listing, German);
    shape.strip_prefix("(Instr L (Operand ").unwrap().strip_suffix("))").unwrap().to_owned()
}

#[test]
fn absolute_operands_are_one_token() {
    for text in [
        "M 0.0",
        "M0.0",
        "E 1.0",
        "A4.7",
        "I 0.0",
        "Q124.0",
        "MW 4",
        "MW4",
        "MB\t0",
        "MD 10",
        "EB0",
        "PEW 256",
        "PAD 0",
        "PIW 4",
        "L 20.0",
        "LW 2",
        "LD12",
        "T 5",
        "T1",
        "Z 3",
        "C3",
        "DBX 0.0",
        "DBW 10",
        "DBD4",
        "DIB 3",
        "DB5.DBW0",
        "DB5.DBW 0",
        "DB 5.DBX 0.7",
        "db1.dbx0.0",
        "DI 3.DIW 2",
        "DB 10",
        "FC 1",
        "SFB4",
    ] {
        let root = clean(&format!("U {text} // x"), German);
        let operand = instrs(&root)[0].operand().unwrap();
        assert_eq!(operand.tokens().count(), 1, "{text}");
        let token = operand.first_token().unwrap();
        assert_eq!((token.kind(), token.text()), (SyntaxKind::Address, text));
        assert_eq!(operand.text(), text);
    }
}

#[test]
fn symbolic_operands() {
    for (text, expected) in [
        ("\"DB\".field[3].x", "\"DB\" . field [ (Operand 3) ] . x"),
        ("\"DB\".\"my field\"", "\"DB\" . \"my field\""),
        ("#local.sub[2]", "#local . sub [ (Operand 2) ]"),
        ("#\"a b\"", "#\"a b\""),
        ("« entrée_auxi »", "« entrée_auxi »"),
        ("«\u{A0}X0\u{A0}»", "«\u{A0}X0\u{A0}»"),
        ("“X0”", "“X0”"),
        ("DB1.moment", "DB1 . moment"),
        ("DB 1.a.T1", "DB 1 . a . T1"),
        ("#a[#i, -1].b", "#a [ (Operand #i) , (Operand - 1) ] . b"),
        ("temp1", "temp1"),
        ("%MW10", "% MW10"),
        ("STW", "STW"),
        ("DBLG", "DBLG"),
    ] {
        assert_eq!(operand(text), expected);
    }
}

#[test]
fn indirect_operands() {
    for (text, expected) in [
        ("M [AR1,P#0.0]", "M [ (Operand AR1) , (Operand P#0.0) ]"),
        ("DIX[AR2,P#12.4]", "DIX [ (Operand AR2) , (Operand P#12.4) ]"),
        ("[AR2, P#2.0]", "[ (Operand AR2) , (Operand P#2.0) ]"),
        ("W [AR1,P#0.0]", "W [ (Operand AR1) , (Operand P#0.0) ]"),
        ("DBW [MD 10]", "DBW [ (Operand MD 10) ]"),
        ("T [MW 4]", "T [ (Operand MW 4) ]"),
        ("DB [#nr]", "DB [ (Operand #nr) ]"),
        ("DB5.DBW [MD 10]", "DB5 . DBW [ (Operand MD 10) ]"),
    ] {
        assert_eq!(operand(text), expected);
    }
    let root = clean("AUF DB [MW 2]", German);
    assert_eq!(instrs(&root)[0].operand().unwrap().indices().next().unwrap().text(), "MW 2");
}

#[test]
fn constants_are_one_token() {
    let typed = [
        "L#1",
        "L#-1100",
        "#1",
        "C#3",
        "S5T#10S",
        "S5T#1M_35S_6MS",
        "s5time#0h_0m",
        "T#1D_2H",
        "T#-1s100ms",
        "TIME#1.5s",
        "D#2004-05-28",
        "DATE#1990-1-1",
        "TOD#13:37:13.37",
        "TIME_OF_DAY#0:0:0",
        "DT#04-5-28-10:12:25.3567",
        "DT#04-5-28-10 :12 :25:3567",
        "2#0101_1111",
        "2#1111.1111.1111.1111",
        "16#FF",
        "B#16#5",
        "W#16#0FFF",
        "dw#16#DEADBEEF",
        "B#(1,2,3,4)",
        "B#(1, 2)",
        "WORD#16#A",
        "INT#-5",
        "REAL#1.0e-3",
    ];
    let numbers = ["5", "0", "1.5", "1.22e+01", "0.000000e+000", "1E3", "1.35 E+02"];
    let pointers = [
        "P#0.0",
        "P#12.7",
        "P#M 0.0",
        "P#M0.0",
        "P#DBX 0.0",
        "P#E 10.0",
        "P#P 1.1",
        "P#DB1.DBX0.0 BYTE 10",
        "P#DB 1.DBX 0.0 BYTE 10",
        "p#m 50.0 word 3",
        "P#L 0.0",
        "P#I1000.0 BYTE 12",
        "P#T 3",
    ];
    let all = typed.iter().map(|it| (it, SyntaxKind::TypedConstant));
    let all = all.chain(numbers.iter().map(|it| (it, SyntaxKind::Number)));
    for (text, kind) in all.chain(pointers.iter().map(|it| (it, SyntaxKind::PointerConstant))) {
        let root = clean(&format!("L {text}; // x"), German);
        let operand = instrs(&root)[0].operand().unwrap();
        let tokens: Vec<_> = operand.tokens().map(|it| (it.kind(), it.text().to_owned())).collect();
        assert_eq!(tokens, [(kind, (*text).to_owned())]);
    }
    assert_eq!(operand("'ab$'c'"), "'ab$'c'");
    assert_eq!(operand("-5"), "- 5");
    assert_eq!(operand("+5"), "+ 5");
    assert_eq!(operand("P##x.y[1]"), "P# #x . y [ (Operand 1) ]");
    assert_eq!(operand("P#\"Data\".v"), "P# \"Data\" . v");
    assert_eq!(operand("P#DB42.ARR1[1].V1"), "P# DB42 . ARR1 [ (Operand 1) ] . V1");
}

#[test]
fn status_bits() {
    for bit in ["==0", "<>0", ">0", "<0", ">=0", "<=0", "BR", "BIE", "OV", "OS", "UO"] {
        assert_eq!(one(&format!("A {bit}"), English), format!("(Instr A (Operand {bit}))"));
    }
}

// Instructions.

#[test]
fn signs_are_mnemonics_or_operands() {
    assert_eq!(
        code("+ 5\n+ -5\n+ L#5\n+5\n+I\n-D\n*R\n/I\n==I\n<>R\n>=D\n+AR1 P#1.0\n+AR2\n=M0.0\n= #x", German),
        [
            "(Instr + (Operand 5))",
            "(Instr + (Operand - 5))",
            "(Instr + (Operand L#5))",
            "(Instr + (Operand 5))",
            "(Instr +I)",
            "(Instr -D)",
            "(Instr *R)",
            "(Instr /I)",
            "(Instr ==I)",
            "(Instr <>R)",
            "(Instr >=D)",
            "(Instr +AR1 (Operand P#1.0))",
            "(Instr +AR2)",
            "(Instr = (Operand M0.0))",
            "(Instr = (Operand #x))",
        ]
    );
}

#[test]
fn optional_operands() {
    assert_eq!(
        code(
            "O\nSLW 5\nSLW\nUW\nUW W#16#0FFF\nLAR1\nLAR1 AR2\nTAR1 MD 0\nNOP 0\nNOP0\nBLD 103\nRND+\nINC 1\nL T 1",
            German
        )
        .len(),
        13 + 1
    );
}

#[test]
fn every_instruction_in_both_sets() {
    let pairs = "A/U A(/U( AN/UN AN(/UN( OPN/AUF BEU/BEA BEC/BEB CU/ZV CD/ZR SP/SI SE/SV SD/SE SS/SS SF/SA JU/SPA JC/SPB \
                 JCN/SPBN JCB/SPBB JNB/SPBNB JBI/SPBI JNBI/SPBIN JL/SPL JM/SPM JMZ/SPMZ JN/SPN JO/SPO JP/SPP JPZ/SPPZ \
                 JOS/SPS JUO/SPU JZ/SPZ AW/UW AD/UD CAD/TAD CAR/TAR CAW/TAW CDB/TDB";
    let both = "O O( ON ON( X X( XN XN( ) = S R NOT SET CLR SAVE FP FN L LC T FR ==I <>I >I <I >=I <=I ==D <>D >D <D >=D <=D \
                ==R <>R >R <R >=R <=R +I -I *I /I +D -D *D /D +R -R *R /R + MOD LOOP CALL UC CC BE MCR( )MCR MCRA MCRD OW XOW \
                OD XOD SSI SSD SLW SRW SLD SRD RLD RRD RLDA RRDA BTI ITB BTD DTB ITD DTR RND RND+ RND- TRUNC INVI INVD NEGI \
                NEGD NEGR ABS SQR SQRT EXP LN SIN COS TAN ASIN ACOS ATAN TAK PUSH POP ENT LEAVE INC DEC LAR1 LAR2 TAR1 TAR2 \
                +AR1 +AR2 NOP NOP0 NOP1 BLD";
    let pairs = pairs.split_whitespace().map(|it| it.split_once('/').unwrap());
    for (english, german) in pairs.chain(both.split_whitespace().map(|it| (it, it))) {
        let op = lookup(english, English).unwrap_or_else(|| panic!("{english}"));
        assert_eq!(lookup(german, German), Some(op), "{german}");
        assert_eq!(lookup(&german.to_lowercase(), German), Some(op));
        for (word, mnemonics) in [(english, English), (german, German)] {
            let is_nop0 = word.starts_with("NOP") && word != "NOP";
            let needs_operand = matches!(op.operand(), OperandRule::Required(_)) && !is_nop0;
            let operand = if needs_operand { " M 0.0" } else { "" };
            let root = clean(&format!("x: {word}{operand};"), mnemonics);
            let instr = instrs(&root).pop().unwrap();
            assert_eq!(instr.mnemonic().unwrap().text, word);
            assert_eq!(instr.op(mnemonics), Some(op), "{word}");
            assert_eq!(instr.operands().count(), usize::from(!operand.is_empty()));
        }
    }
    for (word, english, german) in
        [("SE", true, true), ("A", true, false), ("U", false, true), ("XYZ", false, false), ("", false, false)]
    {
        assert_eq!((lookup(word, English).is_some(), lookup(word, German).is_some()), (english, german), "{word}");
    }
    assert_ne!(lookup("SE", English), lookup("SE", German));
    assert_eq!(lookup("LONGER_THAN_ANY", German), None);
}

#[test]
fn calls() {
    for (text, expected) in [
        ("CALL FC2", "(Instr CALL (Operand FC2))"),
        ("CALL FB1, DB3", "(Instr CALL (Operand FB1) , (Operand DB3))"),
        ("CALL \"x\" , \"y\";", "(Instr CALL (Operand \"x\") , (Operand \"y\") ;)"),
        ("CALL #multi", "(Instr CALL (Operand #multi))"),
        (
            "CALL FC1 ( a := 1, b := MW0 );",
            "(Instr CALL (Operand FC1) (ArgList ( (Arg a := (Operand 1)) , (Arg b := (Operand MW0)) )) ;)",
        ),
        (
            "CALL SFC 47(\n  WT:= 0\t, // INT\n T1 := #x\n out := \"db\".y[2],\n)",
            "(Instr CALL (Operand SFC 47) (ArgList ( (Arg WT := (Operand 0)) , (Arg T1 := (Operand #x)) \
             (Arg out := (Operand \"db\" . y [ (Operand 2) ])) , )))",
        ),
        (
            "CALL \"f\"\n   (  p := #In1,\n      S := P#M 0.0 BYTE 4\n   );",
            "(Instr CALL (Operand \"f\") (ArgList ( (Arg p := (Operand #In1)) , (Arg S := (Operand P#M 0.0 BYTE 4)) )) ;)",
        ),
        (
            "AA :  CALL FB1, DB1\n  tem   :=T1\n  duree :=S5T#1S\n\n  etape := « X0 »",
            "(Instr (Label AA :) CALL (Operand FB1) , (Operand DB1) (ArgList (Arg tem := (Operand T1)) \
             (Arg duree := (Operand S5T#1S)) (Arg etape := (Operand « X0 »))))",
        ),
        (
            "CALL \"BLKMOV\"\n SRC:=P#DB1.DBX0.0 WORD 1,\n EN :=\n DST:=M 0.0;",
            "(Instr CALL (Operand \"BLKMOV\") (ArgList (Arg SRC := (Operand P#DB1.DBX0.0 WORD 1)) , (Arg EN :=) \
             (Arg DST := (Operand M 0.0))) ;)",
        ),
        (
            "CALL FB 1 , DB 2 (a :=\n  DB1.x, b := , c := A 1.0)",
            "(Instr CALL (Operand FB 1) , (Operand DB 2) (ArgList ( (Arg a := (Operand DB1 . x)) , (Arg b :=) , \
             (Arg c := (Operand A 1.0)) )))",
        ),
    ] {
        assert_eq!(one(text, German), expected);
    }
    let root = clean("CALL FB1, DB3 (\n a := 1,\n b :=\n)\nU E 0.0", German);
    let all = instrs(&root);
    assert_eq!(all.len(), 2);
    assert_eq!(all[0].operands().map(|it| it.text()).collect::<Vec<_>>(), ["FB1", "DB3"]);
    let args: Vec<_> =
        all[0].args().map(|it| (it.name().unwrap().text().to_owned(), it.value().map(|it| it.text()))).collect();
    assert_eq!(args, [("a".to_owned(), Some("1".to_owned())), ("b".to_owned(), None)]);
}

#[test]
fn jump_list() {
    let text = "L MB 0\nSPL def\nSPA m0\nSPA m1\ndef: SPA m1\nm0: NOP 0\nm1: BE";
    let labels: Vec<_> =
        instrs(&clean(text, German)).iter().filter_map(|it| it.operand().map(|it| it.text())).collect();
    assert_eq!(labels, ["MB 0", "def", "m0", "m1", "m1", "0"]);
}

#[test]
fn mnemonic_range_and_node_range() {
    let text = "  a: U ( // x\n";
    let instr = instrs(&clean(text, German)).pop().unwrap();
    assert_eq!(&text[instr.mnemonic().unwrap().range], "U (");
    assert_eq!(&text[instr.range()], "a: U (");
}

#[test]
fn block_comment() {
    assert_eq!(code("U (* and\n U E 9.9 *) E 0.0", German), ["(Instr U (Operand E 0.0))"]);
}

// Faults.

/// The faults of a text, each as `place: message`.
fn faults(text: &str, mnemonics: Mnemonics) -> Vec<String> {
    root_of(text, mnemonics).1.into_iter().map(|(place, message)| format!("{place}: {message}")).collect()
}

#[test]
fn one_fault_for_each_faulty_statement() {
    for (text, expected) in [
        ("XYZ 5, 3", "XYZ: unknown instruction `XYZ`"),
        ("__ASSERT==\t__ACCU 1,\t11", "__ASSERT: unknown instruction `__ASSERT`"),
        (
            "AN I 0.0",
            "AN: unknown instruction `AN`; it is an international mnemonic, and this program is read with the German \
             (SIMATIC) ones",
        ),
        ("U", "U: `U` needs a bit as its operand"),
        ("x: SPA ;", "SPA: `SPA` needs a jump label as its operand"),
        ("U := 5", ":=: `U` needs a bit as its operand"),
        ("SET M 0.0", "M 0.0: `SET` takes no operand"),
        ("NOP0 1", "1: `NOP0` takes no operand"),
        ("U E 0.0 E 0.1 foo", "E 0.1: expected the end of the instruction"),
        ("L DBW [MD 10", "10: expected `]`"),
        ("L #a[,1]", ",: expected an index or address"),
        ("L #a.", ".: expected a name after `.`"),
        ("L P# ;", "P#: expected an address or a name after `P#`"),
        ("L \"abc", "\"abc: this name is not closed: expected `\"`"),
        ("L 'abc", "'abc: this text is not closed: expected `'`"),
        ("\"abc\"", "\"abc\": expected an instruction"),
        ("== M 0.0", "==: unknown instruction `==`"),
        ("§§ U", "§§: this is not a character of the language"),
        ("tem := T1", "tem: the parameter `tem` belongs to no `CALL`"),
        ("CALL FB 1,", ",: expected the instance data block after `,`"),
        ("CALL FB 1 DB 1 (a := 1)", "DB 1: expected the parameters or the end of the instruction"),
        ("CALL FC 1 (a := 1 2, b := 3)", "2: expected `,` or the end of the parameter"),
        ("CALL FC 1 (5, b := 3)", "5: expected a parameter such as `name := value`"),
        ("CALL FC 1 (a := ], b := 3)", "]: expected the value of the parameter"),
        ("CALL FC 1 (a := 3;", "(: the parameters of this `CALL` are not closed: expected `)`"),
        ("END_FUNCTION", "END_FUNCTION: `END_FUNCTION` without `FUNCTION`"),
        ("BEGIN", "BEGIN: `BEGIN` is not allowed in code"),
        ("END_VAR;", "END_VAR: `END_VAR` is not allowed in code"),
        ("VAR\n a : INT;\nEND_VAR", "VAR: declarations are not allowed in code"),
        ("TITLE = late", "TITLE: a title stands right after its `NETWORK`"),
    ] {
        let whole = format!("SET\n{text}\nU E 0.0\n");
        let (root, found) = root_of(&whole, German);
        let found: Vec<_> = found.iter().map(|(place, message)| format!("{place}: {message}")).collect();
        let expected = expected.replace("10: expected `]`", "MD 10: expected `]`");
        assert_eq!(found, [expected], "{text}");
        let last = instrs(&root).pop().unwrap();
        assert_eq!(shape(last.syntax()), "(Instr U (Operand E 0.0))", "{text}");
    }
}

#[test]
fn unclosed_parameters_do_not_swallow_the_code() {
    let (root, found) = root_of("CALL FC 1 (\n a := 1,\nU E 0.0\n= A 4.0", German);
    assert_eq!(found.len(), 1);
    assert_eq!(instrs(&root).len(), 3);
}

#[test]
fn faults_of_declarations() {
    for (text, expected) in [
        ("a INT;", "INT: expected `:` and the type of the variable"),
        ("a :\n c : INT;", ":: expected a type"),
        ("a : ;", ":: expected a type"),
        ("a : ARRAY 1..2] OF INT;", "1: expected `[` and the bounds of the array"),
        ("a : ARRAY [1..2 OF INT;", "INT: expected bounds such as `1 .. 10`, and `]`"),
        ("a : ARRAY [1..2] INT;", "INT: expected `OF` and the type of the elements"),
        ("a : STRING [10;", ";: expected the length and `]`"),
        ("a : INT := ;", ":=: expected a value"),
        ("a : INT := 3(0;", "0: expected `)`"),
        ("a : INT 5;", "5: expected the end of the declaration"),
        ("5 : INT;", "5: expected the declaration of a variable"),
    ] {
        let whole = format!("FUNCTION FC 1 : VOID\nVAR\n{text}\n b : INT;\nEND_VAR\nBEGIN\nU E 0.0\nEND_FUNCTION\n");
        let (root, found) = root_of(&whole, German);
        let found: Vec<_> = found.iter().map(|(place, message)| format!("{place}: {message}")).collect();
        let expected = expected.replace(";: expected the length", "10: expected the length");
        assert_eq!(found, [expected], "{text}");
        let last = decls(&root.blocks().next().unwrap().sections().next().unwrap()).pop().unwrap();
        assert_eq!(last.names().next().unwrap().text(), "b", "{text}");
        assert_eq!(instrs(&root).len(), 1);
    }
}

#[test]
fn faults_of_blocks() {
    for (text, expected) in [
        ("FUNCTION FC 1\nBEGIN\nEND_FUNCTION", "FC 1: expected `:` and the type of the return value, such as `: VOID`"),
        (
            "FUNCTION_BLOCK FB 1\nBEGIN\nSET",
            "FUNCTION_BLOCK: this `FUNCTION_BLOCK` is not closed: expected `END_FUNCTION_BLOCK`",
        ),
        ("FUNCTION_BLOCK FB 1\nBEGIN\nEND_FUNCTION", "END_FUNCTION: expected `END_FUNCTION_BLOCK`"),
        (
            "FUNCTION_BLOCK FB 1\nU E 0.0\n= A 4.0\nEND_FUNCTION_BLOCK",
            "U: expected `BEGIN` before the code of the block",
        ),
        ("FUNCTION_BLOCK FB 1\nhello world\nBEGIN\nEND_FUNCTION_BLOCK", "hello: expected a declaration or `BEGIN`"),
        ("FUNCTION FC : VOID\nBEGIN\nEND_FUNCTION", ":: expected the number of the block"),
        ("TYPE UDT\nSTRUCT\na : INT;\nEND_STRUCT;\nEND_TYPE", "UDT: expected the number of the block"),
        (
            "FUNCTION_BLOCK FB 1\nVAR\n a : INT;\nBEGIN\nSET\nEND_FUNCTION_BLOCK",
            "VAR: this `VAR` is not closed: expected `END_VAR`",
        ),
        ("DATA_BLOCK DB 1\nBEGIN\n a 5;\n b := 1;\nEND_DATA_BLOCK", "5: expected `:=` and a value"),
        ("DATA_BLOCK DB 1\nBEGIN\n := 5;\n b := 1;\nEND_DATA_BLOCK", ":=: expected an assignment such as `name := 5;`"),
        (
            "DATA_BLOCK DB 1\nSTRUCT\n a : STRUCT\n b : INT;\nEND_STRUCT;\nBEGIN\nEND_DATA_BLOCK",
            "STRUCT: this `STRUCT` is not closed: expected `END_STRUCT`",
        ),
        (
            "FUNCTION_BLOCK FB 1\n{ a := 1\nBEGIN\nSET\nEND_FUNCTION_BLOCK",
            "{: this attribute is not closed: expected `}`",
        ),
    ] {
        let whole = format!("{text}\nFUNCTION FC 9 : VOID\nBEGIN\nEND_FUNCTION");
        let (root, found) = root_of(&whole, German);
        let found: Vec<_> = found.iter().map(|(place, message)| format!("{place}: {message}")).collect();
        assert_eq!(found, [expected], "{text}");
        assert_eq!(root.blocks().count(), 2, "{text}");
    }
}

#[test]
fn unclosed_comment() {
    let (root, found) = root_of("U E 0.0\n(* no end\nU E 0.1", German);
    assert_eq!(found, [("(*".to_owned(), "this comment is not closed: expected `*)`".to_owned())]);
    assert_eq!(instrs(&root).len(), 1);
}

#[test]
fn depth_is_limited() {
    let depth = 10_000;
    let text = format!("L #a{}1{}\nU E 0.0", "[#b".repeat(depth), "]".repeat(depth));
    let (root, found) = root_of(&text, German);
    assert_eq!(found.len(), 1);
    assert_eq!(shape(instrs(&root).pop().unwrap().syntax()), "(Instr U (Operand E 0.0))");

    let text = format!(
        "DATA_BLOCK DB 1\nSTRUCT\n{}{}\nz : INT;\nEND_STRUCT\nBEGIN\nEND_DATA_BLOCK",
        "a : STRUCT\n".repeat(depth),
        "END_STRUCT;\n".repeat(depth)
    );
    let (root, found) = root_of(&text, German);
    assert_eq!(found.len(), 1);
    let section = root.blocks().next().unwrap().sections().next().unwrap();
    assert_eq!(decls(&section).pop().unwrap().names().next().unwrap().text(), "z");

    let text =
        format!("DATA_BLOCK DB 1\nSTRUCT\na : {} INT;\nEND_STRUCT\nEND_DATA_BLOCK", "ARRAY [1..2] OF ".repeat(depth));
    assert_eq!(faults(&text, German).len(), 1);
    let text = text.replace(" INT;", " INT\n b : INT\n");
    assert_eq!(faults(&text, German).len(), 1);
    let text = format!("DATA_BLOCK DB 1\nBEGIN\na := {}1{};\nEND_DATA_BLOCK", "1(".repeat(depth), ")".repeat(depth));
    assert_eq!(faults(&text, German), Vec::<String>::new());
}

// The vote.

#[test]
fn vote_by_words_and_areas() {
    for (text, expected) in [
        ("U E 0.0\n= A 4.0", Some(German)),
        ("A I 0.0\n= Q 4.0", Some(English)),
        ("O E0.0", Some(German)),
        ("L IW 4", Some(English)),
        ("T PAW 256", Some(German)),
        ("T PQW [MD 4]", Some(English)),
        ("S Z 1", Some(German)),
        ("m1: ZV Z 1", Some(German)),
        ("SET; AUF DB 1", Some(German)),
        ("u(\n)", Some(German)),
        ("_001: spbnb x", Some(German)),
        ("O M 0.0; opn DB 1", Some(English)),
        ("L 5\nT MW 0\nSE T 1", None),
        ("// U E 0.0\nL 'U;U E 0.0'\nL \"AUF;AUF DB 1\"", None),
        ("A : INT;\nU : BOOL;\nU := 5;\nA.b := 1;\nA, AN : INT", None),
        ("= A 4.0", Some(German)),
        ("=A4.0", Some(German)),
        ("L T 1 // ; U E 0.0 ; U E 0.0\nA M 0.0", Some(English)),
        ("", None),
    ] {
        assert_eq!(vote(text), expected, "{text}");
    }
}

#[test]
fn vote_stops_early() {
    let text = "U E 0.0\n".repeat(20) + &"A I 0.0\n".repeat(1000);
    assert_eq!(vote(&text), Some(German));
}

// Hostile input.

/// In quadratic time these would take minutes.
#[test]
fn hostile_input_is_kept() {
    let size = 60_000;
    for text in [
        "U(".repeat(100_000),
        "U(\n".repeat(100_000),
        "{".repeat(size),
        "(*".repeat(size),
        "\0".repeat(size),
        "'".repeat(size),
        "\"".repeat(size + 1),
        "«".repeat(size),
        "[".repeat(size),
        "L #a[".repeat(size / 5),
        "L ".to_owned() + &"9".repeat(size),
        "a:".repeat(size),
        "STRUCT\n".repeat(size / 8),
        "x : STRUCT ".repeat(size / 8),
        "VAR\n".repeat(size / 4),
        "FUNCTION FC 1 ".repeat(size / 8),
        "NETWORK TITLE =".repeat(size / 8),
        "AUTHOR : ".repeat(size / 8),
        "TYPE x NAME : ".repeat(size / 8),
        "...".repeat(size),
        "1 ".repeat(size),
        "DT#1 :1".repeat(size / 8),
        "P#".repeat(size),
        "CALL FC 1 (".repeat(size / 8),
        "é".repeat(size),
        " ".repeat(size),
    ] {
        for mnemonics in [German, English] {
            assert_eq!(parse(&text, mnemonics).syntax().text(), text.as_str());
        }
        vote(&text);
    }
}

#[test]
fn ten_megabyte_line() {
    let text = "U E 0.0 ".repeat(10 << 17);
    let parse = parse(&text, German);
    assert_eq!(parse.errors().len(), 1);
    assert_eq!(parse.syntax().text_range().len(), rowan::TextSize::of(text.as_str()));
}

const SAMPLE: &str = "FUNCTION_BLOCK FB 1\nTITLE =Test\n{ S7_m_c := 'true' }\nAUTHOR : me\nVERSION : 0.1\n\
    VAR_INPUT\n  a : BOOL := TRUE; // c\n  s : ARRAY [1 .. 2] OF STRUCT\n  x : INT := 3(0);\n  END_STRUCT\nEND_VAR\n\
    BEGIN\nNETWORK\nTITLE = one\nM001: U(;\nO E 0.0;\nON \"sym\".x[1]\n)\nL DT#04-5-28-10 :12\nL P#DB1.DBX0.0 BYTE 10\n\
    CALL FB1, DB2 (\n a := « X0 »,\n b := #c[1, 2]);\n= A4.0\n...\nSPB M001\nEND_FUNCTION_BLOCK\n\
    DATA_BLOCK DB 2\n FB 1\nBEGIN\n s[1].x := -5;\nEND_DATA_BLOCK\n";

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn any_text_is_kept(text in "\\PC*|[\\x00-\\x7f\u{80}-\u{ff}]{0,200}") {
        for mnemonics in [German, English] {
            prop_assert_eq!(keep(parse(&text, mnemonics)).syntax().text(), text.as_str());
        }
        vote(&text);
    }

    #[test]
    fn any_words_are_kept(words in proptest::collection::vec(
        prop::sample::select(SAMPLE.split_inclusive([' ', '\n', '(', ':', '[', '#', '\'', '"']).collect::<Vec<_>>()), 0..60,
    )) {
        let text = words.concat();
        let parse = parse(&text, German);
        prop_assert_eq!(parse.syntax().text(), text.as_str());
        for error in parse.errors() {
            prop_assert!(text.get(Range::<usize>::from(error.range)).is_some());
        }
    }

    #[test]
    fn mutated_code_is_kept(cut in any::<prop::sample::Index>(), len in 0_usize..12, insert in "[\\x00-\\x7f«»é]{0,3}") {
        let mut start = cut.index(SAMPLE.len());
        while !SAMPLE.is_char_boundary(start) {
            start -= 1;
        }
        let mut end = (start + len).min(SAMPLE.len());
        while !SAMPLE.is_char_boundary(end) {
            end += 1;
        }
        let text = format!("{}{insert}{}", &SAMPLE[..start], &SAMPLE[end..]);
        for mnemonics in [German, English] {
            prop_assert_eq!(keep(parse(&text, mnemonics)).syntax().text(), text.as_str());
        }
        // What was before the place of the mutation cannot be what a later cut removes.
        prop_assert_eq!(keep(parse(&SAMPLE[..start], German)).syntax().text(), &SAMPLE[..start]);
    }
}

#[test]
fn the_sample_is_faultless() {
    clean(SAMPLE, German);
}
