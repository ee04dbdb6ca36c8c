//! Trees of both languages, as one line: nodes in parentheses, tokens as their text.

use std::fmt::Write as _;

use crate::syntax::AstNode;
use proptest::prelude::*;

use super::ast::{BinOp, BracketContent, Expr, IlOperand, LiteralValue, Root, Sentence, Stmt, UnaryOp};
use super::instructions::IlOp;
use super::*;
use crate::syntax::{Parse, SyntaxElement, SyntaxKind, SyntaxNode};

fn write(node: SyntaxNode<'_>, out: &mut String) {
    write!(out, "({:?}", node.kind()).unwrap();
    for child in node.children_with_tokens() {
        match child {
            SyntaxElement::Node(it) => {
                out.push(' ');
                write(it, out);
            }
            SyntaxElement::Token(it) if it.kind().is_trivia() => {}
            SyntaxElement::Token(it) => write!(out, " {}", it.text()).unwrap(),
        }
    }
    out.push(')');
}

fn shape(parse: &Parse) -> String {
    let mut out = String::new();
    for child in parse.syntax().children_with_tokens() {
        match child {
            SyntaxElement::Node(it) => write(it, &mut out),
            SyntaxElement::Token(it) if it.kind().is_trivia() => continue,
            SyntaxElement::Token(it) => out.push_str(it.text()),
        }
        out.push(' ');
    }
    out.trim_end().to_owned()
}

/// Errors as `text it points at: message`.
fn errors(parse: &Parse) -> Vec<String> {
    let text = parse.syntax().text().into_owned();
    parse.errors().iter().map(|it| format!("{}: {}", &text[it.range], it.message)).collect()
}

#[track_caller]
fn legal(parse: Parse) -> Parse {
    assert_eq!(errors(&parse), [""; 0], "{}", parse.syntax().text());
    assert!(parse.syntax().descendants().all(|it| it.kind() != SyntaxKind::Error));
    parse
}

/// Shape of the one sentence, without the frame of the sentence.
#[track_caller]
fn il(text: &str) -> String {
    inner(&shape(&legal(parse_il(text))))
}

#[track_caller]
fn st(text: &str) -> String {
    inner(&shape(&legal(parse_st(text))))
}

#[track_caller]
fn inner(shape: &str) -> String {
    shape.strip_prefix("(Sentence ").and_then(|it| it.strip_suffix(')')).expect("one sentence").to_owned()
}

fn sentence(parse: &Parse) -> Sentence<'_> {
    Root::cast(parse.syntax()).and_then(|it| it.sentences().next()).expect("a sentence")
}

/// Trees of tests live as long as the tests.
fn keep(parse: Parse) -> &'static Parse {
    Box::leak(Box::new(parse))
}

fn statement(text: &str) -> Stmt<'static> {
    sentence(keep(legal(parse_st(text)))).statements().next().expect("a statement")
}

fn expr(text: &str) -> Expr<'static> {
    match statement(&format!("%M0:={text};")) {
        Stmt::Assign(it) => it.value().expect("a value"),
        other => panic!("{other:?}"),
    }
}

fn text<'t>(node: &impl AstNode<'t>) -> String {
    node.syntax().text().into_owned()
}

/// The expression with a pair of parentheses around every operation.
fn grouped(expr: &Expr) -> String {
    let side = |it: Option<Expr>| it.map_or("?".into(), |it| grouped(&it));
    match expr {
        Expr::Bin(it) => format!("({} {} {})", side(it.lhs()), it.operator().unwrap().text(), side(it.rhs())),
        Expr::Unary(it) => format!("({} {})", it.operator().unwrap().text(), side(it.operand())),
        Expr::Paren(it) => side(it.expr()),
        other => text(other),
    }
}

mod seed {
    //! Listings of the PL7 manual, with the line of each.
    use super::*;

    #[test]
    fn instruction_list() {
        for (line, text) in [
            (
                2998,
                "%L0 :\n    LD      %M40\n    JMPC   %L10\n\n!(*Attente de séchage*)\n%L2 :\n    LD      %I1.0\n    AND    %M10\n    ST     %Q2.5\n...\n%L10 :\n    LD      %I3.5\n    ANDN   %Q4.3\n    OR     %M20\n    ST     %Q2.5",
            ),
            (3038, "!(*Attente de séchage*)\n%L2 :\nLD        %I1.0\nAND       %M10\nST        %Q2.5"),
            (3124, "LD[.....] AND[.....] OR[.....]"),
            (3124, "LD[%MW10<1000]"),
            (3125, "[.....]"),
            (3125, "[%MW10:=%MW0+100]"),
            (3147, "LD\t%I1.0\nAND\t%I1.1\nOR\t%I1.2\nST\t%Q2.0"),
            (3154, "LD\t%I1.0\nAND (\t%I1.1\nOR\t%I1.2\n)\nST\t%Q2.0"),
            (3166, "LD\t%I1.0\nAND\t%I1.1\nOR (N\t%I1.2\nAND\t%I1.3\n)\nST\t%Q2.0"),
            (3181, "LD %M0 OR ([%MW0>100] )"),
            (3197, "LD      %I1.0\nAND (   %I1.1\nOR (N   %I1.2\nAND     %M3\n)\n)\nST      %Q2.0"),
            (
                3209,
                "LD      %I1.1\nAND (   %I1.2\nAND     %I1.3\nOR (N   %I1.5\nAND     %I1.6\n)\nAND     %I1.4\nOR (N   %I1.7\nAND     %I1.8\n)\n)\nST      %Q2.0",
            ),
            (
                3251,
                "LD      %I1.0\nAND     %M0\nMPS\nAND     %I1.1\nST      %Q2.0\nMRD\nAND     %I1.2\nST      %Q2.1\nMPP\nAND     %I1.4\nST      %Q2.3",
            ),
            (3282, "CU %C8"),
            (3340, "LD    %I1.1\nAND   %M0\nOR (   %M10\nAND   %I1.2\n)\nST    %Q2.0"),
            (
                3352,
                "!    LD      %M0\n      JMPC   %L10\n!    LD      %I1.1\n      AND   %M10\n      ST    %Q2.0\n!    %L10:\n      LD      %I1.3\n      AND   %M20\n      . . . . .",
            ),
            (4720, "!\tLD\t%I2.1\n\tAND\t[%MW10<20]"),
        ] {
            let parse = parse_il(text);
            assert_eq!(errors(&parse), [""; 0], "line {line}");
            assert_eq!(parse.syntax().text(), text);
        }
    }

    #[test]
    fn structured_text() {
        for (line, text) in [
            (
                422,
                "ST : MAST - SR10\n!\n(* Recherche du premier élément non nul *)\n\nIF %M0 THEN\n  FOR %MW 99 := 0 TO 31 DO\n    IF %MW100 [%MW99]<> 0 THEN\n      %MW 10 := %MW100 [%MW99];\n      %MW 11 := %MW 99;\n      %M1 := TRUE;\n      EXIT;      (*Sortie de la boucle FOR*)\n    ELSE\n      %M1 := FALSE;\n    END_IF;\n  END_FOR;\nELSE\n  %M1 := FALSE;\nEND_IF;\n",
            ),
            (
                3497,
                "!      %L20 :\n      (*Attente de séchage*)\n      SET %M0;\n      %MW4 := %MW2 + %MW9;\n      (*calcul de pression*)\n      %MF12 := SQRT (%MF14);",
            ),
            (3532, "!      %L20      (*Attente de séchage*)\n      SET %M0;\n"),
            (
                3838,
                "! (*Action conditionnelle IF (forme simple)*)\nIF %M0 AND %M12 THEN\n    RESET %M0;\n    INC %MW4;\n    %MW10:=%MW8+%MW9;\nEND_IF;",
            ),
            (
                3855,
                "IF %M0 AND %M1 THEN\n    %MW5 := %MW3 + %MW4;\n    SET %M10;\nELSEIF %M0 OR %M1 THEN\n    SET %M11;\nELSE\n    RESET %M10;\n    RESET %M11;\nEND_IF;",
            ),
            (3891, "! (*WHILE*)\nWHILE %MW4<12 DO\n    INC %MW4;\n    SET %M25[%MW4];\nEND_WHILE;"),
            (3920, "! (*REPEAT*)\nREPEAT\n    INC %MW4;\n    SET %M25[%MW4];\nUNTIL %MW4>12 END_REPEAT;"),
            (3948, "! (*FOR*)\nFOR %MW4=0 TO %MW23+12 DO\n    SET %M25[%MW4];\nEND_FOR;"),
            (
                3986,
                "!\n  WHILE %MW1<124 DO\n    %MW2:=0;\n    %MW3:=%MW100 [%MW1];\n    REPEAT\n      %MW500 [%MW2] :=%MW3+%MW500 [%MW2];\n      IF (%MW500 [%MW2]>32700) THEN\n        EXIT;\n      END_IF;\n      INC %MW2;\n    UNTIL %MW2>25 END_REPEAT;\n    INC %MW1;\n  END_WHILE;",
            ),
            (4602, "%L1 :\nINC %MW10 ; %MW0 := 0 ; %MW25 := 0 ;"),
            (4655, "MAST - Peinture - CHART - PAGE 0 %X(0) --> %X(1)\n! %M0"),
            (4681, "! X3.T>=150"),
            (4756, "! %I2.1 AND [%MW10<20]"),
            (5227, "! IF (%X2.T > 100 AND %X2) THEN SET %Q4.0 ;END_IF ;"),
            (
                5513,
                "CHR_200:=CHR_100;\nRESET DEMARRE;\n(*On incremente*)\nFOR CHR_102:=1 TO 80 DO\n    INC CHR_100;\n    WHILE((CHR_104-CHR_114)<100)DO\n        IF(CHR_104>400) THEN\nEXIT;\n            END_IF;\n            INC CHR_104;\n            REPEAT\n                IF(CHR_106>300) THEN\nEXIT;\n                    END_IF;\n                    INC CHR_106;\n                    UNTIL ((CHR_100-CHR_116)>100)\n                    END_REPEAT;\n                    END_WHILE;\n                    (* On boucle tant que CHR_106)\n                    IF (CHR_106=CHR_116)\n                    THEN EXIT;\nEND_FOR;",
            ),
            (
                5731,
                "!(*Programmation du DFB Cpt_pieces*)\nIF RE Raz THEN\n    V_cour:=0;\nEND_IF;\nIF (V_cour>=Presel) THEN\n    SET Done;\nELSE\n    RESET Done;\nEND_IF;",
            ),
        ] {
            let parse = parse_st(text);
            assert_eq!(errors(&parse), [""; 0], "line {line}");
            assert_eq!(parse.syntax().text(), text);
        }
    }

    /// PL7:5111 is cut off: what is missing is said once, at its end.
    #[test]
    fn cut_listing() {
        let parse = parse_st("! IF %I4.2 AND %T3.D THEN\n%SW22:=16#AF8F;\n%SW25:=16#FFFF;\nSET %S24\n");
        assert_eq!(errors(&parse), ["%S24: expected `END_IF` after this"]);
    }

    /// The operands of PL7:560-1260 in both languages.
    #[test]
    fn objects() {
        for object in [
            "%I23.5",
            "%MW10:X5",
            "%X5.9",
            "%NW2.3",
            "%NW{2.3}1",
            "%I.5",
            "%I102.MOD.ERR",
            r"%I\0.2.1\0.7",
            r"%Q3.0\4.3",
            "%M10:6",
            "%X12.T:8",
            "%X20[%MW5]",
            "%X20 .T[%MW5]",
            "%MW50[%MW5]:10",
            "%KD80[%MW5]:10",
            "%MW10[%MW2]:X4",
            "%MW108[%MW2+1]",
            "%C8 .D",
            "%MW 99",
            "%MD6[%MW100]",
            "%X2.OUT.T",
        ] {
            let tree = format!("{:?}", SyntaxKind::ObjectRef);
            assert!(st(&format!("%M0:={object};")).contains(&tree), "{object}");
            assert!(il(&format!("LD {object}\nST %M0")).contains(&tree), "{object}");
        }
        for name in [
            "MW108[%MW2]",
            "X3.T",
            "I1.0",
            "Température:12",
            "Température[Four_1]",
            "Etat_pompe:X1",
            "Tempo_four.D",
            "Controle.Ecart",
            "BRULEUR_1",
            "Ésÿ",
        ] {
            assert!(st(&format!("%M0:={name};")).contains("NameRef"), "{name}");
            assert!(il(&format!("LD {name}\nST %M0")).contains("NameRef"), "{name}");
        }
    }
}

mod list {
    use super::*;

    #[test]
    fn tests_and_actions() {
        assert_eq!(
            il("LD %I1.0\nANDN %M1\nORR Pump\nLD TRUE\nST %Q2.0"),
            "(IlInstr LD (ObjectRef %I1.0)) (IlInstr ANDN (ObjectRef %M1)) (IlInstr ORR (NameRef Pump)) \
             (IlInstr LD (Literal TRUE)) (IlInstr ST (ObjectRef %Q2.0))"
        );
    }

    #[test]
    fn every_instruction_of_the_table() {
        for instruction in instructions::all() {
            let operand = match instruction.operand {
                instructions::Operand::None => "",
                instructions::Operand::Test | instructions::Operand::Bit => "%M1",
                instructions::Operand::BitOrBlock => "%M1",
                instructions::Operand::Input | instructions::Operand::Block => "%C8",
                instructions::Operand::Label => "%L10",
                instructions::Operand::Subroutine => "5",
            };
            let text = format!("LD %M0\n{} {operand}\nN\n", instruction.mnemonic);
            let parse = legal(parse_il(&text));
            let instr = sentence(&parse).instructions().nth(1).expect("the instruction");
            assert_eq!(instr.op(), Some(instruction.op));
            assert_eq!(instr.operand().is_some(), !operand.is_empty(), "{text}");
            if !operand.is_empty() {
                let parse = parse_il(&text.replace(operand, ""));
                assert_eq!(parse.errors().len(), 1, "{text}");
            }
        }
    }

    #[test]
    fn parentheses_and_modifiers() {
        let parse = legal(parse_il("LD %I1.0\nOR (N %I1.2\nAND([%MW0>100]\nAND(F%M1\n)\n)\n)\nST %Q2.0"));
        assert_eq!(
            inner(&shape(&parse)),
            "(IlInstr LD (ObjectRef %I1.0)) (IlInstr OR ( N (ObjectRef %I1.2)) \
             (IlInstr AND ( (Bracket [ (BinExpr (ObjectRef %MW0) > (Literal 100)) ])) \
             (IlInstr AND ( F (ObjectRef %M1)) (IlInstr )) (IlInstr )) (IlInstr )) (IlInstr ST (ObjectRef %Q2.0))"
        );
        let instructions: Vec<_> = sentence(&parse).instructions().collect();
        assert_eq!(instructions[1].modifier().map(|it| it.text().to_owned()).as_deref(), Some("N"));
        assert!(instructions[1].open_parenthesis().is_some() && instructions[0].open_parenthesis().is_none());
        assert!(instructions[2].modifier().is_none());
        assert!(instructions[4].close_parenthesis().is_some() && instructions[4].op().is_none());
        // Without an operand on its line, `R` behind the parenthesis is a name, not a modifier.
        assert_eq!(il("BLK %MN0 OUT_BLK LD Q AND(R\n)\nEND_BLK").matches("(NameRef R)").count(), 1);
        assert_eq!(errors(&parse_il("LD %M0\nXOR(%M1\n)\nST %M2")), ["(: only `AND` and `OR` open a parenthesis"]);
    }

    #[test]
    fn several_on_a_line() {
        assert_eq!(
            il("LD %M0 [%MW0:=%MW1] AND %M1 [INC %MW3] JMPC %L3 SR5 %SR6 R %C8 LD R ST %M2"),
            "(IlInstr LD (ObjectRef %M0)) \
             (IlInstr (Bracket [ (AssignStmt (ObjectRef %MW0) := (ObjectRef %MW1)) ])) \
             (IlInstr AND (ObjectRef %M1)) (IlInstr (Bracket [ (CallStmt INC (ObjectRef %MW3)) ])) \
             (IlInstr JMPC %L3) (IlInstr SR5) (IlInstr %SR6) (IlInstr R (ObjectRef %C8)) \
             (IlInstr LD (NameRef R)) (IlInstr ST (ObjectRef %M2))"
        );
        assert_eq!(il("LD %MW100[%MW9]:X4 ST %M0").matches("Index").count(), 1);
        assert_eq!(il("LD %MW100 [%MW9]:X4 ST %M0").matches("Index").count(), 1);
    }

    #[test]
    fn accessors() {
        let parse = legal(parse_il("%L4:\nLD [%MW10<1000]\nSR 7\nJMP %L12\n[%M0:=%M1]\nANDR Foo.Bar\n%sr3"));
        let sentence = sentence(&parse);
        assert_eq!(sentence.label().and_then(|it| it.number()), Some(4));
        let instructions: Vec<_> = sentence.instructions().collect();
        assert_eq!(instructions[0].op(), Some(IlOp::Ld));
        assert!(matches!(instructions[0].operand(), Some(IlOperand::Bracket(it)) if text(&it) == "[%MW10<1000]"));
        assert!(matches!(instructions[0].bracket().and_then(|it| it.content()), Some(BracketContent::Expr(_))));
        assert!(!instructions[0].is_operation());
        assert_eq!(instructions[1].subroutine(), Some(7));
        assert!(matches!(instructions[2].operand(), Some(IlOperand::Label(it)) if it.text() == "%L12"));
        assert!(instructions[3].is_operation() && instructions[3].operand().is_none());
        assert!(matches!(instructions[3].bracket().and_then(|it| it.content()), Some(BracketContent::Assign(_))));
        assert!(matches!(instructions[4].operand(), Some(IlOperand::Name(it)) if it.path() == "Foo.Bar"));
        assert_eq!(instructions[5].op(), Some(IlOp::Sr));
        assert_eq!(instructions[5].subroutine(), Some(3));
    }

    #[test]
    fn blocks_in_structured_form() {
        assert_eq!(
            il("BLK %C8\nLD %I1.1\nR\nLD %I1.2\nCU\nOUT_BLK\nLD D\nST %Q2.0\nLD R\nST %M1\nEND_BLK"),
            "(IlInstr BLK (ObjectRef %C8)) (IlInstr LD (ObjectRef %I1.1)) (IlInstr R) \
             (IlInstr LD (ObjectRef %I1.2)) (IlInstr CU) (IlInstr OUT_BLK) (IlInstr LD (NameRef D)) \
             (IlInstr ST (ObjectRef %Q2.0)) (IlInstr LD (NameRef R)) (IlInstr ST (ObjectRef %M1)) (IlInstr END_BLK)"
        );
        assert_eq!(il("BLK %C8 LD %M0 R LD %M1 CU OUT_BLK LD D ST %M2 END_BLK").matches("IlInstr").count(), 9);
        assert_eq!(
            errors(&parse_il("LD %M0\nR\nLD %M1\nCU")),
            ["R: expected an operand after this", "CU: expected an operand after this"]
        );
    }

    #[test]
    fn one_error_an_instruction() {
        let parse =
            parse_il("LD + 3 ) 7\nFOO %M3 BAR\nAND\nST %M1 %M2\nJMP\n%L3 : LD %M4;\n[%MW0:=\nLD %M5\nS [%MW1\nR %M6");
        assert_eq!(
            errors(&parse),
            [
                "+: expected an operand, found `+`",
                "7: expected the next instruction, found `7`",
                "FOO: `FOO` is no instruction",
                "AND: expected an operand after this",
                "%M2: expected the next instruction, found `%M2`",
                "JMP: expected a label after this",
                ";: expected the next instruction, found `;`",
                ":=: expected an operand after this",
                "%MW1: expected `]` after this",
            ]
        );
        let instructions = parse.syntax().descendants().filter_map(ast::IlInstr::cast);
        let ops: Vec<_> = instructions.map(|it| it.op()).collect();
        let [ld, and, st, jmp, s, r] = [IlOp::Ld, IlOp::And, IlOp::St, IlOp::Jmp, IlOp::S, IlOp::R].map(Some);
        assert_eq!(ops, [ld, None, and, st, jmp, ld, None, ld, s, r]);
    }

    #[test]
    fn operand_is_not_taken_from_the_next_instruction() {
        assert_eq!(errors(&parse_il("LD AND %M1")), ["AND: expected an operand, found `AND`"]);
        assert_eq!(errors(&parse_il("LD\n[%MW0:=1]")), ["LD: expected an operand after this"]);
        assert_eq!(il("LD\n%M1"), "(IlInstr LD (ObjectRef %M1))");
    }
}

mod frame {
    use super::*;

    #[test]
    fn exchange_form() {
        let parse = legal(parse_il(
            "PROGRAM MAST'SR1'\n(*PHRASE*) (*a*) %L1: LD %M0 ST %M1 (*END_PHRASE*)\n(*PHRASE*)LD %M2(*END_PHRASE*)\n\
             END_PROGRAM\n",
        ));
        assert_eq!(
            shape(&parse),
            "PROGRAM MAST 'SR1' (Sentence (*PHRASE*) (LabelDef %L1 :) (IlInstr LD (ObjectRef %M0)) \
             (IlInstr ST (ObjectRef %M1)) (*END_PHRASE*)) \
             (Sentence (*PHRASE*) (IlInstr LD (ObjectRef %M2)) (*END_PHRASE*)) END_PROGRAM"
        );
        assert_eq!(sentence(&parse).marker().map(|it| it.kind()), Some(SyntaxKind::SentenceStart));
        for program in ["PROGRAM", "PROGRAMMAST'Chart'", "PROGRAM MAST 'SR1", "program FAST'MAIN'"] {
            let parse = legal(parse_st(&format!("{program}\n(*PHRASE*) %M0:=%M1; (*END_PHRASE*) END_PROGRAM")));
            assert_eq!(shape(&parse).matches("Sentence").count(), 1, "{program}");
        }
    }

    #[test]
    fn pasted_form() {
        let parse = legal(parse_st("! %M0:=%M1;\n!%L2: ;\n! (*only a comment*)\n!"));
        assert_eq!(
            shape(&parse),
            "(Sentence ! (AssignStmt (ObjectRef %M0) := (ObjectRef %M1) ;)) \
             (Sentence ! (LabelDef %L2 :) (EmptyStmt ;)) (Sentence !) (Sentence !)"
        );
        for heading in ["ST : MAST - SR10", "IL : MAST - Peinture - PRL", "ST : EVT3", "ST:FAST - MAIN"] {
            let parse = legal(parse_il(&format!("\n{heading}\n! LD %M0")));
            let root = Root::cast(parse.syntax()).unwrap();
            assert_eq!(root.headings().map(|it| text(&it)).collect::<Vec<_>>(), [heading]);
            assert_eq!(root.sentences().count(), 1);
        }
        // No unit starts at the second one.
        let parse = parse_st("ST : MAST - A\n%M0:=1;\nST : SR4\n%M1:=1;");
        assert_eq!(errors(&parse), ["ST: this heading names no part of a program"]);
        assert_eq!(shape(&parse).matches("Heading").count(), 2);
    }

    #[test]
    fn a_label_opens_a_sentence() {
        let parse = legal(parse_st("%M0:=1;\n%L3: %M1:=1;\n%L4 %M2:=1;"));
        let labels = Root::cast(parse.syntax()).unwrap().sentences().map(|it| it.label().and_then(|it| it.number()));
        assert_eq!(labels.collect::<Vec<_>>(), [None, Some(3), Some(4)]);
        // `L5:` is a label whose `%` is missing.
        assert_eq!(st("L5: %M1:=1;"), "(LabelDef L5 :) (AssignStmt (ObjectRef %M1) := (Literal 1) ;)");
        // Inside parentheses of a list it stays where it is: a rule of its own reports it.
        assert_eq!(il("LD %M0 AND(%M1\n%L3: OR %M2\n)").matches("LabelDef").count(), 1);
        assert_eq!(
            errors(&parse_st("(*PHRASE*) %M0:=1; %L3: %M1:=1; (*END_PHRASE*)")),
            ["%L3: a label stands at the beginning of its sentence"]
        );
        assert_eq!(
            errors(&parse_st("IF %M0 THEN %L3: SET %M1; END_IF;")),
            ["%L3: a label stands at the beginning of a sentence, not inside a structure"]
        );
    }

    #[test]
    fn missing_and_stray_marks() {
        assert_eq!(
            errors(&parse_st("(*PHRASE*) %M0:=1;\n(*PHRASE*) %M1:=1; (*END_PHRASE*)")),
            [";: expected `(*END_PHRASE*)` after this"]
        );
        assert_eq!(
            errors(&parse_st("%M0:=1; (*END_PHRASE*) %M1:=1;")),
            ["(*END_PHRASE*): `(*END_PHRASE*)` without `(*PHRASE*)`"]
        );
    }

    #[test]
    fn comments() {
        // The rest of the unit is a comment: what is missing may be in it.
        assert_eq!(errors(&parse_st("(*PHRASE*) IF %M0 THEN %M1 := (* never closed ; END_IF;")), [""; 0]);
        assert_eq!(errors(&parse_il("LD (* never closed")), [""; 0]);
        // A comment ends at the first `*)`.
        assert_eq!(errors(&parse_st("(* a (* b *) c *) %M0:=1;\n%M1:=%M2;")).len(), 1);
        assert_eq!(shape(&parse_st("(* a (* b *) c *)\n%M0:=1;")).matches("AssignStmt").count(), 1);
    }

    #[test]
    fn empty_units() {
        for text in ["", " \n", "(*x*)", "\u{FEFF}"] {
            assert_eq!(shape(&legal(parse_il(text))), "");
            assert_eq!(shape(&legal(parse_st(text))), "");
        }
    }
}

mod text {
    use super::*;

    #[test]
    fn assignments() {
        assert_eq!(st("%MW0:=%MW1+2;"), "(AssignStmt (ObjectRef %MW0) := (BinExpr (ObjectRef %MW1) + (Literal 2)) ;)");
        assert_eq!(st("%MW0:12:=%KW0:12;"), "(AssignStmt (ObjectRef %MW0:12) := (ObjectRef %KW0:12) ;)");
        assert_eq!(st("%MB10:5:='abc';"), "(AssignStmt (ObjectRef %MB10:5) := (Literal 'abc') ;)");
        assert_eq!(
            st("Tab[Index_1+1]:X4:=%MW10[%MW2]:X4;"),
            "(AssignStmt (NameRef Tab (Index [ (BinExpr (NameRef Index_1) + (Literal 1)) ]) :X4) := \
             (ObjectRef %MW10 (Index [ (ObjectRef %MW2) ]) :X4) ;)"
        );
        // The manual's `=` reads as what was meant (rule T018).
        assert_eq!(st("%M1:=%M2; %M0 = TRUE;").matches("AssignStmt").count(), 2);
        assert_eq!(st("%M0 = TRUE;"), "(AssignStmt (ObjectRef %M0) = (Literal TRUE) ;)");
        let Stmt::Assign(assign) = statement("%C8 .P := %MW 99;") else { panic!() };
        assert!(matches!(assign.target(), Some(Expr::Object(it)) if it.address() == "%C8.P"));
        assert!(matches!(assign.value(), Some(Expr::Object(it)) if it.address() == "%MW99"));
        assert_eq!(assign.operator().map(|it| it.kind()), Some(SyntaxKind::Assign));
        assert_eq!(
            errors(&parse_st("5:=%MW0; SQRT(%MF0):=%MF1;")),
            [":=: `:=` needs an object on its left", ":=: `:=` needs an object on its left"]
        );
    }

    #[test]
    fn calls_and_jumps() {
        assert_eq!(
            st("SET %M0; DEC Pump; SR1; %SR2; SR 3; MASKEVT(); JUMP %L3; RETURN; HALT; EXIT; ; READ_STS %CH3.0;"),
            "(CallStmt SET (ObjectRef %M0) ;) (CallStmt DEC (NameRef Pump) ;) (CallStmt SR1 ;) (CallStmt %SR2 ;) \
             (CallStmt SR (Literal 3) ;) (CallStmt MASKEVT ( ) ;) (JumpStmt JUMP %L3 ;) (ReturnStmt RETURN ;) \
             (HaltStmt HALT ;) (ExitStmt EXIT ;) (EmptyStmt ;) (CallStmt READ_STS (ObjectRef %CH3.0) ;)"
        );
        assert_eq!(st("SMOVE %CH3.0 (1,2);"), "(CallStmt SMOVE (ObjectRef %CH3.0) ( (Literal 1) , (Literal 2) ) ;)");
        for (text, number) in [("SR1;", 1), ("%SR2;", 2), ("SR 3;", 3)] {
            assert!(matches!(statement(text), Stmt::Call(it) if it.subroutine() == Some(number)), "{text}");
        }
        let Stmt::Call(call) = statement("Cpt(a,%MW0+1,,c);") else { panic!() };
        let arguments: Vec<_> = call.arguments().iter().map(|it| it.as_ref().map(text_of)).collect();
        assert_eq!(arguments, [Some("a".into()), Some("%MW0+1".into()), None, Some("c".into())]);
        let count = |text: &str| match statement(text) {
            Stmt::Call(it) => it.arguments().len(),
            _ => 99,
        };
        assert_eq!(
            [count("F();"), count("F(a);"), count("F(,);"), count("F(a,);"), count("SET %M0;")],
            [0, 1, 2, 2, 0]
        );
        let Stmt::Call(call) = statement("SORT_ARW(1,%MW0:10);") else { panic!() };
        assert_eq!(call.function().map(|it| it.parameters[1].is_written()), Some(true));
        let Stmt::Call(call) = statement("INC %MW4;") else { panic!() };
        assert!(!call.has_parentheses() && matches!(call.operand(), Some(Expr::Object(_))));
        let Stmt::Jump(jump) = statement("JUMP %L12;") else { panic!() };
        assert_eq!(jump.label().and_then(|it| ast::label_number(it.text())), Some(12));
    }

    fn text_of(expr: &Expr) -> String {
        text(expr)
    }

    #[test]
    fn structures() {
        assert_eq!(
            st("IF %M0 THEN SET %M1; ELSIF %M2 THEN ; ELSE EXIT; END_IF;"),
            "(IfStmt (IfArm IF (ObjectRef %M0) THEN (StmtList (CallStmt SET (ObjectRef %M1) ;))) \
             (IfArm ELSIF (ObjectRef %M2) THEN (StmtList (EmptyStmt ;))) \
             (ElseArm ELSE (StmtList (ExitStmt EXIT ;))) END_IF ;)"
        );
        let Stmt::If(it) = statement("IF a THEN ; ELSEIF b THEN ; ELSE ; END_IF;") else { panic!() };
        let conditions = it.arms().map(|it| it.condition().map(|it| text(&it))).collect::<Vec<_>>();
        assert_eq!(conditions, [Some("a".into()), Some("b".into())]);
        assert!(it.else_arm().is_some_and(|it| it.body().is_some()));
        let Stmt::For(it) = statement("FOR %MW4=%MW1 TO %MW23+12 DO INC %MW5; END_FOR;") else { panic!() };
        let part = |it: Option<Expr>| it.map(|it| text(&it));
        assert_eq!(part(it.index()).as_deref(), Some("%MW4"));
        assert_eq!(part(it.start()).as_deref(), Some("%MW1"));
        assert_eq!(part(it.end()).as_deref(), Some("%MW23+12"));
        assert_eq!(it.operator().map(|it| it.kind()), Some(SyntaxKind::Eq));
        assert_eq!(it.body().map(|it| it.statements().count()), Some(1));
        let Stmt::While(it) = statement("WHILE a DO b:=1; END_WHILE;") else { panic!() };
        assert_eq!(part(it.condition()).as_deref(), Some("a"));
        assert_eq!(it.body().map(|it| it.statements().count()), Some(1));
        let Stmt::Repeat(it) = statement("REPEAT b:=1; UNTIL a END_REPEAT;") else { panic!() };
        assert_eq!(part(it.condition()).as_deref(), Some("a"));
        assert_eq!(it.body().map(|it| it.statements().count()), Some(1));
    }

    /// PL7:4056-4088 and the examples at 4041, 4052 and 4073.
    #[test]
    fn priorities() {
        for (text, expected) in [
            ("NOT %MW3 * 25 AND %MW10 + %MW12", "(((NOT %MW3) * 25) AND (%MW10 + %MW12))"),
            ("%MW34 * 2 REM 6", "((%MW34 * 2) REM 6)"),
            ("(%MW10+%MW11)*%MW12", "((%MW10 + %MW11) * %MW12)"),
            ("NOT %MW2 <> %MW4 + %MW6", "((NOT %MW2) <> (%MW4 + %MW6))"),
            ("a OR b XOR c AND d", "(a OR (b XOR (c AND d)))"),
            ("a = b < c", "(a = (b < c))"),
            ("a - b - c", "((a - b) - c)"),
            ("a AND b OR c AND d", "((a AND b) OR (c AND d))"),
            ("-a * -b", "((- a) * (- b))"),
            ("RE a AND NOT FE b", "((RE a) AND (NOT (FE b)))"),
            ("a AND [b < 3]", "(a AND (b < 3))"),
        ] {
            assert_eq!(grouped(&expr(text)), expected);
        }
        let Expr::Bin(it) = expr("a<=b") else { panic!() };
        assert_eq!(it.op(), Some(BinOp::Le));
        let Expr::Unary(it) = expr("fe a") else { panic!() };
        assert_eq!(it.op(), Some(UnaryOp::Fe));
        let Expr::Paren(it) = expr("[a<b]") else { panic!() };
        assert!(matches!(it.expr(), Some(Expr::Bin(_))));
        let Expr::Call(it) = expr("LENGHT_ARX(%M0:4)") else { panic!() };
        assert_eq!(it.function().map(|it| it.also), Some(&["LENGTH_ARX"][..]));
        assert_eq!(it.arguments().len(), 1);
    }

    #[test]
    fn literals() {
        let value = |text: &str| match expr(text) {
            Expr::Literal(it) => it.value(),
            other => panic!("{other:?}"),
        };
        assert_eq!(value("10"), Some(LiteralValue::Integer(10)));
        assert_eq!(value("2#1010"), Some(LiteralValue::Integer(10)));
        assert_eq!(value("16#AB"), Some(LiteralValue::Integer(0xAB)));
        assert_eq!(value("1.5E3"), Some(LiteralValue::Real(1500.0)));
        assert_eq!(value("TRUE"), Some(LiteralValue::Bool(true)));
        assert_eq!(value("'a$'b'"), Some(LiteralValue::Text("a$'b".into())));
        assert_eq!(value("T#5s"), Some(LiteralValue::Other("T#5s".into())));
        assert_eq!(value("2#102"), None);
        assert_eq!(value("99999999999999999999"), None);
        assert_eq!(grouped(&expr("-1.32E12")), "(- 1.32E12)");
        assert_eq!(errors(&parse_st("%MB0:4:='abc;\n%M0:=1;")), ["'abc;: the text has no closing quote"]);
        assert_eq!(errors(&parse_st("%MB0:4:='abc$';")), ["'abc$';: the text has no closing quote"]);
    }

    #[test]
    fn objects_and_names() {
        let Expr::Object(it) = expr("%MW 100 [%MW99+1] :10") else { panic!() };
        assert_eq!((&*it.address(), it.suffix().as_deref()), ("%MW100", Some(":10")));
        assert_eq!(it.index().and_then(|it| it.expr()).map(|it| text(&it)).as_deref(), Some("%MW99+1"));
        let Expr::Object(it) = expr("%X20 .T[%MW5]") else { panic!() };
        assert_eq!((&*it.address(), it.suffix()), ("%X20.T", None));
        let Expr::Object(it) = expr("% MW 10 :X4") else { panic!() };
        assert_eq!(it.address(), "%MW10:X4");
        let Expr::Name(it) = expr("MW108[%MW2]:10") else { panic!() };
        assert_eq!((&*it.path(), it.suffix().as_deref()), ("MW108", Some(":10")));
        assert!(it.index().is_some());
        let Expr::Name(it) = expr("I102.MOD.ERR") else { panic!() };
        assert_eq!(it.path(), "I102.MOD.ERR");
        assert_eq!(it.name().map(|it| it.text().to_owned()).as_deref(), Some("I102"));
        let Expr::Name(it) = expr("Température:12") else { panic!() };
        assert_eq!((&*it.path(), it.suffix().as_deref()), ("Température:12", Some(":12")));
    }

    #[test]
    fn receptivities() {
        assert_eq!(st("! %MW10 = 3"), "! (ExprStmt (BinExpr (ObjectRef %MW10) = (Literal 3)))");
        assert_eq!(st("(*PHRASE*) Ready (*END_PHRASE*)"), "(*PHRASE*) (ExprStmt (NameRef Ready)) (*END_PHRASE*)");
        assert_eq!(st("NOT %M0").matches("ExprStmt").count(), 1);
        // Elsewhere an expression is half an assignment.
        assert_eq!(errors(&parse_st("%M0:=1; %M1 AND %M2; %M3:=1;")), [";: expected `:=` or `(`, found `;`"]);
        assert_eq!(errors(&parse_st("IF %M0 THEN Pump; END_IF;")), [";: expected `:=` or `(`, found `;`"]);
    }

    #[test]
    fn assignment_in_a_condition_is_a_rule_s_affair() {
        assert_eq!(
            st("WHILE %MW0:=3 AND %M1 DO ; END_WHILE;"),
            "(WhileStmt WHILE (BinExpr (ObjectRef %MW0) := (BinExpr (Literal 3) AND (ObjectRef %M1))) DO \
             (StmtList (EmptyStmt ;)) END_WHILE ;)"
        );
        let Stmt::While(it) = statement("WHILE %MW0:=3 DO ; END_WHILE;") else { panic!() };
        assert!(matches!(it.condition(), Some(Expr::Bin(it)) if it.op() == Some(BinOp::Assign)));
    }

    #[test]
    fn one_error_a_statement() {
        let parse = parse_st(
            "%MW0 := + ) 3;\n%MW1 := 2\n%MW3 := 4; END_IF; IF %M0 SET %M1; END_IF;\nFOO %M1;\n%MW4 := (%MW5 + ;\n\
             %MW6 := F(1 2, 3);\nWHILE %M0 %M1 := 1; END_WHILE;\nSET ; INC;\nFOR 3 TO DO ; END_FOR;\n%MW7 := §;\n%MW8 := 9;",
        );
        assert_eq!(
            errors(&parse),
            [
                "): expected an operand, found `)`",
                "2: expected `;` after this",
                "END_IF: `END_IF` belongs to nothing that is open",
                "SET: expected `THEN`, found `SET`",
                "%M1: expected `:=` or `(`, found `%M1`",
                ";: expected an operand, found `;`",
                "2: expected `,` or `)`, found `2`",
                "%M1: expected `DO`, found `%M1`",
                ";: expected an operand, found `;`",
                ";: expected an operand, found `;`",
                "TO: expected `:=`, found `TO`",
                "§: expected an operand, found `§`",
            ]
        );
        // The right ones are all there: %MW1, %MW3, SET %M1, %MW8 and more.
        let targets = parse.syntax().descendants().filter_map(ast::AssignStmt::cast);
        let targets: Vec<_> = targets.filter_map(|it| it.target()).map(|it| text(&it)).collect();
        assert_eq!(targets, ["%MW0", "%MW1", "%MW3", "%MW4", "%MW6", "%M1", "%MW7", "%MW8"]);
    }

    #[test]
    fn a_missing_end_does_not_take_the_outer_one() {
        let parse = parse_st("IF %M0 THEN WHILE %M1 DO SET %M2; END_IF; SET %M3;");
        assert_eq!(errors(&parse), ["END_IF: expected `END_WHILE`, found `END_IF`"]);
        assert_eq!(sentence(&parse).statements().count(), 2);
        let parse = parse_st("! IF %M0 THEN SET %M2;\n! SET %M3;");
        assert_eq!(errors(&parse), [";: expected `END_IF` after this"]);
        let parse = parse_st("IF a THEN ; ELSE ; ELSE ; END_IF; b:=1;");
        assert_eq!(errors(&parse), ["ELSE: nothing but `END_IF` follows the `ELSE` part"]);
    }
}

mod hostile {
    use super::*;
    use crate::syntax::MAX_DEPTH;

    /// Both trees are the text, and no higher than the stack of a walker bears.
    #[track_caller]
    fn survives(text: &str) -> [usize; 2] {
        [parse_il(text), parse_st(text)].map(|parse| {
            assert_eq!(parse.syntax().text().len(), text.len());
            let mut depth = 0_u32;
            let mut highest = 0;
            for event in parse.syntax().walk() {
                match event {
                    crate::syntax::WalkEvent::Enter(_) => depth += 1,
                    crate::syntax::WalkEvent::Leave(_) => depth -= 1,
                    crate::syntax::WalkEvent::Token(_) => {}
                }
                highest = highest.max(depth);
            }
            assert!(highest < 4 * MAX_DEPTH + u32::from(expr::MAX_HEIGHT), "{highest} levels");
            parse.errors().len()
        })
    }

    #[test]
    fn nesting() {
        const N: usize = 100_000;
        for (text, errors_in_st) in [
            (format!("%M0:={}%M1{};%M2:=1;", "(".repeat(N), ")".repeat(N)), 1),
            (format!("%M0:={}%M1;%M2:=1;", "(".repeat(N)), 1),
            (format!("%M0:={}%M1;%M2:=1;", "NOT ".repeat(N)), 1),
            (format!("%M0:={}%M1;%M2:=1;", "-".repeat(N)), 1),
            (format!("%M0:={}1;%M2:=1;", "%MW0[".repeat(N)), 1),
            (format!("%M0:={}1;%M2:=1;", "F(".repeat(N)), 1),
            (format!("%M0:={}1;%M2:=1;", "%M1+".repeat(N)), 1),
            (format!("%M0:={}1;%M2:=1;", "%M1+(".repeat(N)), 1),
            (format!("%M0:={}1;%M2:=1;", "%M1 OR %M2 AND %M3=".repeat(N)), 1),
            (format!("{}{};%M2:=1;", "IF %M0 THEN ".repeat(N), "END_IF; ".repeat(N)), 1),
        ] {
            let [_, errors] = survives(&text);
            assert_eq!(errors, errors_in_st, "{}", &text[..40]);
            let parse = parse_st(&text);
            let last = sentence(&parse).statements().filter(|it| matches!(it, Stmt::Assign(_))).last();
            assert_eq!(last.map(|it| super::text(&it)).as_deref(), Some("%M2:=1;"), "{}", &text[..40]);
        }
        survives(&"AND(%M0 ".repeat(N));
        survives(&"[".repeat(N));
        survives(&"IF ".repeat(N));
        survives(&"WHILE REPEAT FOR ".repeat(N));
        survives(&"ELSE END_IF ".repeat(N));
    }

    /// A chain of the length that the limit allows has a tree, left to right.
    #[test]
    fn long_chains() {
        let chain = |n: usize| format!("%M0:=%M1{};", " OR %M2".repeat(n));
        legal(parse_st(&chain(usize::from(expr::MAX_HEIGHT) - 1)));
        assert_eq!(parse_st(&chain(usize::from(expr::MAX_HEIGHT) + 1)).errors().len(), 1);
    }

    #[test]
    fn ten_megabytes() {
        const N: usize = 10_000_000;
        for piece in [
            "\0",
            "x",
            " ",
            "'",
            "(",
            ")",
            ";",
            "!",
            "(*",
            "(*PHRASE*)",
            "%",
            "%MW0 ",
            "1",
            ".",
            ". ",
            "[",
            "]",
            ":",
            "a b ",
            "a=b\n",
            "ST : A\n%M0=1\n",
            "PROGRAM\n%M0=1\n",
            "%L1 %M0=1 ",
            "LD ",
            "LD\n",
            "é",
            "%NW{1",
            "T#",
            "1E",
            "IF\n",
            "%M0:=\n",
            "*)",
            "a.",
            "F(,",
            "$'",
            "\r",
        ] {
            let text = piece.repeat(N / piece.len() / if cfg!(debug_assertions) { 100 } else { 1 });
            survives(&text);
        }
    }
}

/// Code that has everything in it, to be cut and mutated.
const CODE: &str = "PROGRAM MAST'SR1'\n(*PHRASE*) (*c*) %L1: IF %M0 AND [%MW10<20] THEN %MW 99 := %MW100 [%MW99]:X4 + SQRT(%MF1); \
    ELSIF RE a.b THEN SET %M1; ELSE Cpt(a,,b); END_IF; FOR %MW4=0 TO 3 DO EXIT; END_FOR; (*END_PHRASE*)\n! LD %I1.0\n\
    AND(N %I1.1 OR %M2 )\n[%MW10:='abc'] LD[%MW10<1000] ST %Q2.0 SR5 JMPC %L1\n! REPEAT INC %MW4; UNTIL %MW4>1 END_REPEAT;";

/// Shape of the rungs, without `RUNG` and `END_RUNG`.
#[track_caller]
fn ld(cells: &str) -> String {
    let shape = shape(&legal(parse_ld(&format!("RUNG\n{cells}\nEND_RUNG\n"))));
    shape.strip_prefix("(Rung RUNG ").and_then(|it| it.strip_suffix(" END_RUNG)")).unwrap_or(&shape).to_owned()
}

fn ld_errors(cells: &str) -> Vec<String> {
    errors(&parse_ld(&format!("RUNG\n{cells}\nEND_RUNG\n")))
}

#[test]
fn rungs_are_rows_of_cells() {
    assert_eq!(
        ld("OPEN_CONTACT(%I1.0),H_LINK(3),P_CONTACT(%M7),H_LINK(5),COIL(%Q2.0);\nEMPTY_LINE;"),
        "(RungRow (Cell OPEN_CONTACT ( (ObjectRef %I1.0) )) , (Cell H_LINK ( (Literal 3) )) , \
         (Cell P_CONTACT ( (ObjectRef %M7) )) , (Cell H_LINK ( (Literal 5) )) , (Cell COIL ( (ObjectRef %Q2.0) )) ;) \
         (RungRow (Cell EMPTY_LINE) ;)"
    );
    assert_eq!(ld("H_LINK,V_LINK,\n  empty_cell ( 2 ),\n  HASH_COIL();"), {
        "(RungRow (Cell H_LINK) , (Cell V_LINK) , (Cell empty_cell ( (Literal 2) )) , (Cell HASH_COIL ( )) ;)"
    });
    assert_eq!(
        ld("JUMP_COIL(%L10);CALL_COIL(SR5);CALL_COIL(%SR5);RETURN_COIL;HALT_COIL;"),
        "(RungRow (Cell JUMP_COIL ( %L10 )) ;) (RungRow (Cell CALL_COIL ( SR5 )) ;) (RungRow (Cell CALL_COIL ( %SR5 )) ;) \
         (RungRow (Cell RETURN_COIL) ;) (RungRow (Cell HALT_COIL) ;)"
    );
    assert_eq!(
        ld("OPEN_CONTACT(%MW2:X4),CLOSE_CONTACT(%M10[%MW5]),CLOSED_CONTACT(Depart),BLOCK(%TM0),BLOCK(Tempo);"),
        "(RungRow (Cell OPEN_CONTACT ( (ObjectRef %MW2:X4) )) , \
         (Cell CLOSE_CONTACT ( (ObjectRef %M10 (Index [ (ObjectRef %MW5) ])) )) , \
         (Cell CLOSED_CONTACT ( (NameRef Depart) )) , (Cell BLOCK ( (ObjectRef %TM0) )) , (Cell BLOCK ( (NameRef Tempo) )) ;)"
    );
}

#[test]
fn blocks_hold_expressions_and_statements() {
    assert_eq!(
        ld("COMPARE %MW0 > 5 END_BLOCK,OPERATE %MW0:=%MW1+5 END_BLOCK;"),
        "(RungRow (Cell COMPARE (BinExpr (ObjectRef %MW0) > (Literal 5)) END_BLOCK) , \
         (Cell OPERATE (AssignStmt (ObjectRef %MW0) := (BinExpr (ObjectRef %MW1) + (Literal 5))) END_BLOCK) ;)"
    );
    assert_eq!(
        ld("OPERATE\n INC %MW0;\n SR1\nEND_BLOCK; OPERATE SORT_ARW(1,%MW0:10); END_BLOCK;"),
        "(RungRow (Cell OPERATE (CallStmt INC (ObjectRef %MW0)) ; (CallStmt SR1) END_BLOCK) ;) \
         (RungRow (Cell OPERATE (CallStmt SORT_ARW ( (Literal 1) , (ObjectRef %MW0:10) )) ; END_BLOCK) ;)"
    );
}

#[test]
fn rungs_have_labels_and_comments() {
    let parse = legal(parse_ld(
        "LD : MAST - SR1\nRUNG (*fill*) %L10:\nH_LINK(10),COIL(%M0);\nEND_RUNG\n\nRUNG %L2 H_LINK(10),COIL(%M1);END_RUNG\nPROGRAM \
         MAST'x'\nRUNG\nEND_RUNG\nEND_PROGRAM\n",
    ));
    let root = Root::cast(parse.syntax()).expect("a root");
    let labels: Vec<_> = root.rungs().map(|it| it.label().and_then(|it| it.number())).collect();
    assert_eq!(labels, [Some(10), Some(2), None]);
    assert_eq!(root.rungs().map(|it| it.rows().count()).collect::<Vec<_>>(), [1, 1, 0]);
}

#[test]
fn one_error_for_what_is_wrong_in_a_rung() {
    assert_eq!(
        ld_errors("TIMER_CONTACT(%M0,5),H_LINK(9),LAMP(%Q2.0);\nH_LINK(10),COIL(%M1);"),
        ["TIMER_CONTACT: `TIMER_CONTACT` is no element of a rung", "LAMP: `LAMP` is no element of a rung"]
    );
    assert_eq!(ld_errors("OPEN_CONTACT(),H_LINK(9),COIL(%Q2.0);"), ["): expected an object, found `)`"]);
    assert_eq!(ld_errors("OPEN_CONTACT,H_LINK(9),COIL(%Q2.0);"), [",: expected `(`, found `,`"]);
    assert_eq!(ld_errors("H_LINK(x),COIL(%Q2.0);"), ["x: expected a number of cells, found `x`"]);
    assert_eq!(ld_errors("H_LINK(9) COIL(%Q2.0);"), ["COIL: expected `,` or `;`, found `COIL`"]);
    assert_eq!(ld_errors("H_LINK(9),,COIL(%Q2.0);"), [",: expected an element of a rung, found `,`"]);
    assert_eq!(ld_errors("H_LINK(9),COIL(%Q2.0)"), ["): expected `;` after this"]);
    assert_eq!(ld_errors("COMPARE %MW0 >, COIL(%M0);"), [",: expected an operand, found `,`"]);
    assert_eq!(ld_errors("COMPARE %MW0 > 5, COIL(%M0);"), [",: expected `END_BLOCK`, found `,`"]);
    assert_eq!(ld_errors("OPERATE %MW0 END_BLOCK;"), ["END_BLOCK: expected `:=`, found `END_BLOCK`"]);
    assert_eq!(ld_errors("OPERATE END_BLOCK;"), ["END_BLOCK: expected an operation, found `END_BLOCK`"]);
    assert_eq!(
        errors(&parse_ld("RUNG\nH_LINK(10),COIL(%M0);\nRUNG\nH_LINK(10),COIL(%M1);\nEND_RUNG")),
        [";: expected `END_RUNG` after this"]
    );
    assert_eq!(
        errors(&parse_ld("%M0 := 5;\n! LD %M1\nRUNG\nEND_RUNG\nELSE")),
        ["%M0: expected `RUNG`, found `%M0`", "ELSE: expected `RUNG`, found `ELSE`"]
    );
    assert_eq!(ld_errors("OPEN_CONTACT %M0),COIL(%M1);"), ["%M0: expected `(`, found `%M0`"]);
    assert_eq!(ld_errors("OPEN_CONTACT %M0,COIL(%M1);"), ["%M0: expected `(`, found `%M0`"]);
    assert_eq!(ld_errors("JUMP_COIL(L10);"), ["L10: expected a label, such as `%L10`, found `L10`"]);
    assert_eq!(ld_errors("JUMP_COIL();"), ["): expected a label, such as `%L10`, found `)`"]);
    assert_eq!(
        errors(&parse_ld("LD : MAST - SR1\nRUNG\nEND_RUNG\nLD : SR2\nRUNG\nEND_RUNG")),
        ["LD: this heading names no part of a program"]
    );
}

proptest! {
    #[test]
    fn trees_are_the_text(text in "\\PC*") {
        for parse in [parse_il(&text), parse_st(&text), parse_ld(&text)] {
            prop_assert_eq!(parse.syntax().text(), text.as_str());
        }
    }

    #[test]
    fn trees_of_words_are_the_text(words in prop::collection::vec(prop::sample::select(vec![
        "IF", "THEN", "ELSE", "ELSIF", "END_IF", "WHILE", "DO", "END_WHILE", "REPEAT", "UNTIL", "END_REPEAT", "FOR", "TO",
        "END_FOR", ";", ":=", "=", "%M0", "%MW1", "%L1", ":", "(", ")", "[", "]", ",", "AND", "OR", "NOT", "SET", "x", ".",
        "5", "'a", "!", "(*PHRASE*)", "(*END_PHRASE*)", "(*", "*)", "\n", "LD", "ST", "R", "N", "BLK", "SR1", "SR", "JMP",
        "PROGRAM", "END_PROGRAM", "...", "%", "-", "EXIT", "RUNG", "END_RUNG", "RUNG H_LINK(10)", "COIL(%M0)", "V_LINK",
        "COMPARE", "OPERATE", "END_BLOCK", "OPEN_CONTACT",
    ]), 0..60)) {
        let text = words.join(" ");
        for parse in [parse_il(&text), parse_st(&text), parse_ld(&text)] {
            prop_assert_eq!(parse.syntax().text(), text.as_str());
            for error in parse.errors() {
                prop_assert!(text.is_char_boundary(error.range.start().into()));
                prop_assert!(usize::from(error.range.end()) <= text.len());
            }
        }
    }

    #[test]
    fn mutated_code_is_kept(from in 0..CODE.len(), to in 0..CODE.len(), junk in "[;:=()\\[\\]a%.!' ]{0,5}") {
        let text = format!("{}{junk}{}", &CODE[..from], &CODE[to..]);
        for parse in [parse_il(&text), parse_st(&text), parse_ld(&text)] {
            prop_assert_eq!(parse.syntax().text(), text.as_str());
        }
    }

    /// What stands in another sentence is read the same, whatever is wrong in this one.
    #[test]
    fn errors_stay_in_their_sentence(junk in "[;:=()\\[\\]a%.' A-Z0-9]{0,30}") {
        // A quote takes its line, no more.
        let parse = parse_st(&format!("! {junk}\n! %M0 := %M1;"));
        let last = Root::cast(parse.syntax()).and_then(|it| it.sentences().last()).expect("a sentence");
        prop_assert_eq!(last.statements().count(), 1);
        prop_assert!(matches!(last.statements().next(), Some(Stmt::Assign(_))));
    }

    /// What stands in another rung is read the same, whatever is wrong in this one.
    #[test]
    fn errors_stay_in_their_rung(junk in "[;:=()\\[\\]a%.', A-Z0-9_]{0,30}") {
        let parse = parse_ld(&format!("RUNG\n{junk}\nRUNG\nH_LINK(10),COIL(%M1);\nEND_RUNG"));
        let last = Root::cast(parse.syntax()).and_then(|it| it.rungs().last()).expect("a rung");
        prop_assert_eq!(last.rows().flat_map(|it| it.cells()).count(), 2);
    }
}

/// The form that interfaces are read in: the vendor has not published his.
#[test]
fn dfb_types() {
    let text = "FUNCTION_BLOCK Cpt (*a*)\nVAR_INPUT\n Raz, Autre : EBOOL := FALSE;\n Tab : AR_W:20;\nEND_VAR\nVAR Mots : AR_D[4];\n\
                2x-é : WORD;\nEND_VAR\n! Raz := Tab[2] > 3;\nEND_FUNCTION_BLOCK\n";
    let found = shape(&legal(parse_st(text)));
    assert_eq!(
        found,
        "(Heading FUNCTION_BLOCK Cpt) (VarSection VAR_INPUT (VarDecl (VarName Raz) , (VarName Autre) : (TypeRef EBOOL) := \
         (InitValue FALSE) ;) (VarDecl (VarName Tab) : (TypeRef AR_W :20) ;) END_VAR) (VarSection VAR (VarDecl (VarName \
         Mots) : (TypeRef AR_D [ 4 ]) ;) (VarDecl (VarName 2 x - é) : (TypeRef WORD) ;) END_VAR) (Sentence ! (AssignStmt \
         (NameRef Raz) := (BinExpr (NameRef Tab (Index [ (Literal 2) ])) > (Literal 3)) ;)) END_FUNCTION_BLOCK"
    );
    legal(parse_ld(
        "FUNCTION_BLOCK A\nVAR_INPUT b : EBOOL; END_VAR\nRUNG\nOPEN_CONTACT(b),COIL(b);\nEND_RUNG\nEND_FUNCTION_BLOCK",
    ));
    legal(parse_il("FUNCTION_BLOCK A\n! LD b\n ST c\nEND_FUNCTION_BLOCK"));
}

#[test]
fn dfb_types_that_are_cut() {
    let check = |text: &str, expected: &[&str]| {
        assert_eq!(errors(&parse_st(text)), expected, "{text}");
    };
    check("FUNCTION_BLOCK A\n! b := 1;\n", &[";: expected `END_FUNCTION_BLOCK` after this"]);
    check("FUNCTION_BLOCK A\nVAR\nb : BOOL;\nEND_FUNCTION_BLOCK", &[";: expected `END_VAR` after this"]);
    check(
        "FUNCTION_BLOCK A\nVAR\nb : BOOL\nc : BOOL;\nEND_VAR\nEND_FUNCTION_BLOCK",
        &["BOOL: expected `;` after this"],
    );
    check("FUNCTION_BLOCK\nEND_FUNCTION_BLOCK", &["FUNCTION_BLOCK: expected the name of the DFB type after this"]);
    check("FUNCTION_BLOCK A\nEND_FUNCTION_BLOCK\nc := 1;", &["c: nothing follows `END_FUNCTION_BLOCK`"]);
    for part in ["VAR ", "a:", "END_VAR ", "FUNCTION_BLOCK ", "a,", "END_FUNCTION_BLOCK "] {
        let text = format!("FUNCTION_BLOCK A\nVAR {}", part.repeat(20_000));
        assert_eq!(parse_st(&text).syntax().text(), text.as_str());
    }
}
