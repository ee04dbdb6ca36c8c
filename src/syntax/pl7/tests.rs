//! Trees of both languages, as one line: nodes in parentheses, tokens as their text.

use super::*;
use crate::syntax::{Parse, SyntaxElement, SyntaxNode};

fn write(node: &SyntaxNode, out: &mut String) {
    out.push_str(&format!("({:?}", node.kind()));
    for child in node.children_with_tokens() {
        match child {
            SyntaxElement::Node(it) => {
                out.push(' ');
                write(&it, out);
            }
            SyntaxElement::Token(it) if it.kind().is_trivia() => {}
            SyntaxElement::Token(it) => {
                out.push(' ');
                out.push_str(it.text());
            }
        }
    }
    out.push(')');
}

fn shape(parse: &Parse) -> String {
    let mut out = String::new();
    for child in parse.syntax().children_with_tokens() {
        match child {
            SyntaxElement::Node(it) => write(&it, &mut out),
            SyntaxElement::Token(it) if it.kind().is_trivia() => continue,
            SyntaxElement::Token(it) => out.push_str(it.text()),
        }
        out.push(' ');
    }
    out.trim_end().to_owned()
}

#[test]
fn dump() {
    for t in [
        "! LD %I1.0\nAND( N %I1.1\nOR %M2\n)\nST %Q2.0\n%L3 : [%MW10:=%MW0+100] JMPC %L10 LD[%MW10<1000] SR5 R %C8 )",
        "BLK %C8\nLD %M0\nR\nCU\nOUT_BLK\nLD D\nLD R\nST %M3\nEND_BLK",
        "LD + 3\nFOO %M3\nLD %MW100 [%MW99]:X4 [%MW0:=3]\nLD",
    ] {
        let p = parse_il(t);
        println!("{}\n{:?}\n", shape(&p), p.errors());
    }
    for t in [
        "ST : MAST - SR10\n! %L20 (*x*) IF %M0 THEN SET %M1; ELSIF RE %I1.0 THEN %MW0:=%MW 99 + 3*2; ELSE INC %MW4; END_IF; FOR %MW4=0 TO 3 DO EXIT; END_FOR;",
        "! %I2.1 AND [%MW10<20]",
        "! X3.T>=150",
        "! %MW10 = 3",
        "Cpt(a,b,,c); SR1; %SR2; MASKEVT(); Name.item := -3; JUMP %L3; HALT; RETURN; SMOVE %CH3.0 (1,2); %M3 = 2;",
        "%MW0 := + ) 3;\n%MW1 := 2\n%MW3 := 4; END_IF; IF %M0 SET %M1; END_IF WHILE %M0 := 1 DO END_WHILE; IF %M0 THEN",
        "REPEAT INC %MW4; UNTIL %MW4>12 END_REPEAT;",
    ] {
        let p = parse_st(t);
        println!("{}\n{:?}\n", shape(&p), p.errors());
    }
}
