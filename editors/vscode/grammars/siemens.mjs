// Statement lists of STEP 7 and STEP 5, under both mnemonic sets.
import { END, START, keywords, oneOf, words } from './words.mjs';

const BLANK = '[ \\t\\u00A0\\u202F\\uFEFF]';
const NAME = '[\\p{L}_][\\p{L}\\p{N}_]*';

/** @param {string} scope @param {string} begin */
function toEndOfLine(scope, begin) {
  return { name: scope, match: `${begin}.*$` };
}

const step7Instructions = words('step7-instructions');
/** Instructions whose operand is a label. `SP` alone starts a timer. */
const jumps = step7Instructions.filter((it) => /^(?:SP.+|J.+|LOOP)$/.test(it));
const LABEL = `(?:(${NAME})(:)(?!=))`;

/** The blocks of a source, whose words stand at the start of a line. */
const BLOCKS = ['ORGANIZATION_BLOCK', 'FUNCTION_BLOCK', 'FUNCTION', 'DATA_BLOCK', 'TYPE'];

export const step7 = {
  name: 'STEP 7 statement list',
  scopeName: 'source.plc.step7',
  patterns: [
    { include: '#comment' },
    { include: '#block' },
    { include: '#title' },
    { include: '#property' },
    { include: '#declarations' },
    { include: '#structure' },
    { include: '#instruction' },
    { include: '#operand' },
  ],
  repository: {
    comment: {
      patterns: [
        toEndOfLine('comment.line.double-slash.plc', '//'),
        toEndOfLine('comment.line.double-dash.plc', '--'),
        { name: 'comment.block.plc', begin: '\\(\\*', end: '\\*\\)' },
      ],
    },
    block: {
      match: `(?i)^${BLANK}*(${BLOCKS.join('|')})${END}${BLANK}*((?:[A-Z]{2,3}${BLANK}*\\d+|"[^"]*"|${NAME})?)(?!${BLANK}*:=)`,
      captures: {
        1: { name: 'keyword.other.block.plc' },
        2: { name: 'entity.name.function.plc' },
      },
    },
    title: {
      match: `(?i)^${BLANK}*(TITLE)${BLANK}*(=)${BLANK}*(.*)$`,
      captures: {
        1: { name: 'keyword.other.plc' },
        2: { name: 'keyword.operator.plc' },
        3: { name: 'string.unquoted.title.plc' },
      },
    },
    property: {
      match: `(?i)^${BLANK}*(AUTHOR|FAMILY|NAME|VERSION)${BLANK}*(:)(?!=)${BLANK}*([^;/\\r\\n]*)`,
      captures: {
        1: { name: 'keyword.other.plc' },
        2: { name: 'punctuation.separator.plc' },
        3: { name: 'string.unquoted.property.plc' },
      },
    },
    // From VAR or STRUCT to its end: names, types and initial values.
    declarations: {
      begin: `(?i)${START}(VAR(?:_INPUT|_OUTPUT|_IN_OUT|_TEMP|_STAT)?|CONST|STRUCT)${END}`,
      beginCaptures: { 1: { name: 'keyword.other.declaration.plc' } },
      end: `(?i)${START}(END_VAR|END_CONST|END_STRUCT)${END}|(?=${START}(?:BEGIN|NETWORK|END_[A-Z]+_BLOCK|END_FUNCTION|END_TYPE)${END})`,
      endCaptures: { 1: { name: 'keyword.other.declaration.plc' } },
      patterns: [
        { include: '#comment' },
        { include: '#declarations' },
        {
          match: `(${NAME}|"[^"]*")(?=${BLANK}*(?:,[^:;]*)?(?:\\{[^}]*\\}${BLANK}*)?:(?!=))`,
          name: 'variable.parameter.plc',
        },
        {
          match: `(?i)${START}(ARRAY|OF|BOOL|BYTE|WORD|DWORD|CHAR|INT|DINT|REAL|TIME|S5TIME|DATE|TIME_OF_DAY|TOD|DATE_AND_TIME|DT|STRING|TIMER|COUNTER|POINTER|ANY|BLOCK_(?:FB|FC|DB|SDB))${END}`,
          name: 'storage.type.plc',
        },
        { include: '#operand' },
      ],
    },
    structure: {
      patterns: [
        {
          match: `(?i)^${BLANK}*(NETWORK|NETZWERK|RÉSEAU|SEGMENT|SEGMENTO)${END}${BLANK}*(\\d*)(?:${BLANK}*(:)${BLANK}*(.*))?`,
          captures: {
            1: { name: 'keyword.other.network.plc' },
            2: { name: 'constant.numeric.plc' },
            3: { name: 'punctuation.separator.plc' },
            4: { name: 'string.unquoted.title.plc' },
          },
        },
        keywords('keyword.other.plc', words('step7-keywords').filter((it) => it.length > 4)),
        keywords('keyword.other.plc', BLOCKS.map((it) => `END_${it}`)),
      ],
    },
    // At the start of a line, behind a label, a semicolon or a parenthesis.
    instruction: {
      patterns: [
        {
          match: `(?i)(?:^|(?<=[;(]))${BLANK}*${LABEL}?${BLANK}*(${oneOf(jumps)})${BLANK}*(${NAME})`,
          captures: {
            1: { name: 'entity.name.label.plc' },
            2: { name: 'punctuation.separator.label.plc' },
            3: { name: 'keyword.control.instruction.plc' },
            4: { name: 'entity.name.label.plc' },
          },
        },
        {
          match: `(?i)(?:^|(?<=[;(]))${BLANK}*${LABEL}?${BLANK}*(${oneOf(step7Instructions)})`,
          captures: {
            1: { name: 'entity.name.label.plc' },
            2: { name: 'punctuation.separator.label.plc' },
            3: { name: 'keyword.control.instruction.plc' },
          },
        },
        {
          match: `^${BLANK}*${LABEL}`,
          captures: {
            1: { name: 'entity.name.label.plc' },
            2: { name: 'punctuation.separator.label.plc' },
          },
        },
      ],
    },
    operand: {
      patterns: [
        { name: 'string.quoted.single.plc', match: "'(?:[^'$]|\\$.)*'?" },
        { name: 'variable.other.symbol.plc', match: '#?"[^"]*"?|«[^»]*»?|“[^”]*”?' },
        { name: 'meta.attribute.plc string.other.attribute.plc', begin: '\\{', end: '\\}' },
        {
          name: 'constant.numeric.pointer.plc',
          match: `(?i)${START}P#(?:[A-Z]{1,3}${BLANK}*)?[0-9.]*`,
        },
        {
          name: 'constant.numeric.typed.plc',
          match: `(?i)${START}(?:[A-Z][A-Z0-9_]*#[+-]?)?\\d[0-9A-Z_]*#[0-9A-Z_.]+|${START}[A-Z][A-Z0-9_]*#[+-]?\\d[0-9A-Z_.:+-]*|${START}[A-Z]+#\\([^)]*\\)`,
        },
        { name: 'variable.parameter.local.plc', match: `#${NAME}` },
        {
          name: 'variable.other.address.plc',
          match: `(?i)${START}(?:D[BI]${BLANK}*\\d+${BLANK}*\\.${BLANK}*)?[A-Z]{1,3}${BLANK}*\\d+(?:\\.\\d+)?${END}`,
        },
        { name: 'constant.language.plc', match: `(?i)${START}(TRUE|FALSE)${END}` },
        { name: 'storage.type.plc', match: `(?i)${START}VOID${END}` },
        { name: 'constant.numeric.plc', match: `(?<![\\p{L}_])[+-]?\\d[\\d_]*(?:\\.\\d+)?(?:[eE][+-]?\\d+)?` },
        { name: 'keyword.operator.plc', match: ':=|[=<>]=?|<>|[+*/-]' },
      ],
    },
  },
};

const step5Instructions = words('step5-instructions');

export const step5 = {
  name: 'STEP 5 statement list',
  scopeName: 'source.plc.step5',
  patterns: [
    { include: '#comment' },
    { include: '#heading' },
    { include: '#instruction' },
    { include: '#operand' },
  ],
  repository: {
    comment: {
      patterns: [toEndOfLine('comment.line.semicolon.plc', ';'), toEndOfLine('comment.line.double-slash.plc', '//')],
    },
    heading: {
      patterns: [
        {
          match: `(?i)^${BLANK}*(OB|PB|SB|FB|FX|DB|DX)${BLANK}*(\\d+)${BLANK}*$`,
          captures: {
            1: { name: 'keyword.other.block.plc' },
            2: { name: 'entity.name.function.plc' },
          },
        },
        {
          match: `(?i)^${BLANK}*(SEGMENT|NETZWERK|NETWORK|RÉSEAU)${BLANK}+(\\d+)`,
          captures: {
            1: { name: 'keyword.other.network.plc' },
            2: { name: 'constant.numeric.plc' },
          },
        },
        {
          match: `(?i)^${BLANK}*(NAME|NOM|NOMBRE|NOME|BEZ|DEZ|DES|DECL)${BLANK}*(:)${BLANK}*([^\\s;]*)`,
          captures: {
            1: { name: 'keyword.other.plc' },
            2: { name: 'punctuation.separator.plc' },
            3: { name: 'entity.name.function.plc' },
          },
        },
        { match: '\\*\\*\\*', name: 'keyword.other.network.plc' },
      ],
    },
    // At the start of a line, behind an address of the print, a label or a colon; or behind the instruction before it.
    instruction: {
      patterns: [
        {
          match: `(?i)^${BLANK}*(?:([0-9A-F]{4})${BLANK}*)?(?:(${NAME})${BLANK}*(?=:)(?!:=))?(:(?!=))?${BLANK}*(${oneOf(step5Instructions)})`,
          captures: {
            1: { name: 'comment.other.address.plc' },
            2: { name: 'entity.name.label.plc' },
            3: { name: 'punctuation.separator.plc' },
            4: { name: 'keyword.control.instruction.plc' },
          },
        },
        {
          match: `^${BLANK}*(${NAME})${BLANK}*(:)(?!=)`,
          captures: {
            1: { name: 'entity.name.label.plc' },
            2: { name: 'punctuation.separator.plc' },
          },
        },
      ],
    },
    operand: {
      patterns: [
        {
          name: 'constant.numeric.typed.plc',
          match: `(?i)${START}(?:K[FGHTYZBM]|DF|DH|BF)${BLANK}*[+-]?[0-9A-F?][0-9A-F?.,+-]*(?:${BLANK}+[01]{8})?|${START}K[CS]${BLANK}+(?:'[^']*'|\\S+)`,
        },
        {
          name: 'variable.other.address.plc',
          match: `(?i)${START}[A-Z]{1,2}${BLANK}*\\d+(?:\\.\\d+)?${END}`,
        },
        { name: 'variable.other.symbol.plc', match: `(?<=[ \\t])-${NAME}[\\p{L}\\p{N}_./-]*` },
        { name: 'variable.parameter.formal.plc', match: `(?<==)${BLANK}*${NAME}` },
        keywords('keyword.control.instruction.plc', step5Instructions.filter((it) => /^[\p{L}]{2}/u.test(it))),
        // Before an operand on a line that several instructions share.
        {
          name: 'keyword.control.instruction.plc',
          match: `(?i)(?<=[ \\t])${oneOf(step5Instructions.filter((it) => /^\p{L}$/u.test(it)))}(?=${BLANK}+\\p{L})`,
        },
        { name: 'constant.numeric.plc', match: `(?<![\\p{L}_])[+-]?\\d[\\d_]*(?:\\.\\d+)?` },
        { name: 'keyword.operator.plc', match: '!=|><|[=<>]=?' },
      ],
    },
  },
};
