import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { languages, scopes } from './tokens.mjs';

const cases = {
  'plc-step7-awl': [
    ['      U     E 0.0; // on', ['U: keyword.control.instruction', 'E 0.0: variable.other.address', '// on: comment.line.double-slash']],
    ['      A     "Start button"', ['A: keyword.control.instruction', '"Start button": variable.other.symbol']],
    ['m001: SPBN  m002;', ['m001: entity.name.label', ':: punctuation.separator.label', 'SPBN: keyword.control.instruction', 'm002: entity.name.label']],
    ['      L     S5T#2S', ['L: keyword.control.instruction', 'S5T#2S: constant.numeric.typed']],
    ['      L     P#M 10.0', ['L: keyword.control.instruction', 'P#M 10.0: constant.numeric.pointer']],
    ['      ==I   ', ['==I: keyword.control.instruction']],
    ['      U(    ', ['U(: keyword.control.instruction']],
    ['      =     DB5.DBX 2.0', ['=: keyword.control.instruction', 'DB5.DBX 2.0: variable.other.address']],
    ['      T     #speed', ['T: keyword.control.instruction', '#speed: variable.parameter.local']],
    ['FUNCTION FC 1 : VOID', ['FUNCTION: keyword.other.block', 'FC 1: entity.name.function', 'VOID: storage.type']],
    ['TITLE = U E 0.0', ['TITLE: keyword.other', '=: keyword.operator', 'U E 0.0: string.unquoted.title']],
    ['VAR_INPUT\nspeed : INT := 5;\nEND_VAR', ['VAR_INPUT: keyword.other.declaration', 'speed: variable.parameter', 'INT: storage.type', ':=: keyword.operator', '5: constant.numeric', 'END_VAR: keyword.other.declaration']],
    ['(* U\nE *)', ['(* U: comment.block', 'E *): comment.block']],
  ],
  'plc-step5-awl': [
    ['PB 12', ['PB: keyword.other.block', '12: entity.name.function']],
    ['      :U   E 1.0   ; open', [':: punctuation.separator', 'U: keyword.control.instruction', 'E 1.0: variable.other.address', '; open: comment.line.semicolon']],
    ['M001  :L   KF +5', ['M001: entity.name.label', ':: punctuation.separator', 'L: keyword.control.instruction', 'KF +5: constant.numeric.typed']],
    ['SPA= M001', ['SPA=: keyword.control.instruction', 'M001: variable.parameter.formal']],
    ['***', ['***: keyword.other.network']],
  ],
  'plc-pl7-il': [
    ['! %L10: LD %I1.0', ['%L10: entity.name.label', ':: punctuation.separator.label', 'LD: keyword.control.instruction', '%I1.0: variable.other.address']],
    ['ANDN(%M3', ['ANDN(: keyword.control.instruction', '%M3: variable.other.address']],
    ['[%MW10:=%MW2+5]', ['%MW10: variable.other.address', ':=: keyword.operator', '%MW2: variable.other.address', '+: keyword.operator', '5: constant.numeric']],
    ['(*PHRASE*) (*text*)', ['(*PHRASE*): keyword.other.sentence', '(*text*): comment.block']],
    ['LANGUAGE_MOTEUR', []],
  ],
  'plc-pl7-st': [
    ['IF RE %I1.0 AND NOT Marche THEN', ['IF: keyword.control', 'RE: keyword.control', '%I1.0: variable.other.address', 'AND: keyword.control', 'NOT: keyword.control', 'THEN: keyword.control']],
    ['SET %M1;', ['SET: support.function', '%M1: variable.other.address']],
    ['SR10;', ['SR10: entity.name.function']],
    ['%MW20:12:=T#2s;', ['%MW20:12: variable.other.address', ':=: keyword.operator', 'T#2s: constant.numeric.typed']],
    ['IL : MAST - SR1\nLD %M1', ['IL: storage.type.language', ':: punctuation.separator', 'MAST - SR1: entity.name.section', 'LD: keyword.control.instruction', '%M1: variable.other.address']],
  ],
  'plc-pl7-ld': [
    ['RUNG (*fill*) %L10:', ['RUNG: keyword.other.rung', '(*fill*): comment.block', '%L10: entity.name.label', ':: punctuation.separator.label']],
    ['OPEN_CONTACT(%I1.0),H_LINK(9),SET_COIL(%Q2.0);', ['OPEN_CONTACT: keyword.control.element', '%I1.0: variable.other.address', 'H_LINK: keyword.control.element', '9: constant.numeric', 'SET_COIL: keyword.control.element', '%Q2.0: variable.other.address']],
    ['OPERATE W30 -> M2,P END_BLOCK', ['OPERATE: keyword.control.element', 'W30: variable.other.address', '->: keyword.operator', 'M2,P: variable.other.address', 'END_BLOCK: keyword.other.rung']],
  ],
  'plc-pl7-gr7': [
    ['INITIAL_STEP 0 AT (C 2,L 1) :', ['INITIAL_STEP: keyword.other.chart', '0: entity.name.section.step', 'AT: keyword.other.chart', 'C: storage.modifier', '2: constant.numeric', 'L: storage.modifier', '1: constant.numeric']],
    ['ACTION (P1,IL) :\nLD %M1\nEND_ACTION', ['ACTION: keyword.other.chart', 'P1: storage.modifier', 'IL: storage.type.language', 'LD: keyword.control.instruction', '%M1: variable.other.address', 'END_ACTION: keyword.other.chart']],
    ['TRANSITION (*go*) (ST) AT (C 2,L 2) :\nRE %I1.0\nEND_TRANSITION\nSTEP 1', ['TRANSITION: keyword.other.chart', '(*go*): comment.block', 'ST: storage.type.language', 'AT: keyword.other.chart', 'C: storage.modifier', '2: constant.numeric', 'L: storage.modifier', '2: constant.numeric', 'RE: keyword.control', '%I1.0: variable.other.address', 'END_TRANSITION: keyword.other.chart', 'STEP: keyword.other.chart', '1: entity.name.section.step']],
  ],
  'plc-pl7': [
    ["[SOURCE_UNIT]\nLANGUAGE = IL\nADDRESS = MAST SR1\nPROGRAM\nLD %M1\n[DATA_UNIT]", ['[SOURCE_UNIT]: entity.name.tag.exchange', 'LANGUAGE: keyword.other.exchange', '=: keyword.operator', 'IL: storage.type.language', 'ADDRESS: keyword.other.exchange', '=: keyword.operator', 'MAST SR1: string.unquoted.exchange', 'PROGRAM: keyword.other.program', 'LD: keyword.control.instruction', '%M1: variable.other.address', '[DATA_UNIT]: entity.name.tag.exchange']],
    ['VAR_GLOBAL\nPompe AT %Q2.0 : EBOOL (*pump*);\nEND_VAR', ['VAR_GLOBAL: keyword.other.declaration', 'Pompe: variable.parameter', 'AT: keyword.other', '%Q2.0: variable.other.address', ':: punctuation.separator', 'EBOOL: storage.type', '(*pump*): comment.block', 'END_VAR: keyword.other.declaration']],
  ],
};

for (const [language, examples] of Object.entries(cases)) {
  test(`${language} has colours`, async () => {
    for (const [text, expected] of examples) {
      assert.deepEqual(await scopes(language, text), expected, text);
    }
  });
}

test('every language has a grammar, examples and a configuration', () => {
  assert.deepEqual(Object.keys(cases).sort(), languages.map((it) => it.id).sort());
  for (const it of languages) {
    const configuration = JSON.parse(readFileSync(new URL(`../${it.configuration}`, import.meta.url), 'utf8'));
    const { pattern, flags } = configuration.wordPattern;
    assert.ok(new RegExp(pattern, flags).test('été_2'));
    for (const rule of Object.values(configuration.indentationRules ?? {})) {
      new RegExp(rule.pattern, rule.flags);
    }
    assert.ok(configuration.comments);
  }
});
