// PL7 and PL7-2: instruction list, structured text, ladder and Grafcet as text, and the exchange files that hold them.
import { END, START, keywords, oneOf, words } from './words.mjs';

const BLANK = '[ \\t\\u00A0]';
const LANGUAGES = ['il', 'st', 'ld', 'gr7'];
/** As headings and exchange files write a language. */
const NAMES = { il: 'IL', st: 'ST', ld: 'LD', gr7: 'GR7' };

/** @param {string} language */
const scopeOf = (language) => `source.plc.pl7.${language}`;

const common = {
  comment: {
    patterns: [
      // The frame of a sentence has the form of a comment.
      { name: 'keyword.other.sentence.plc', match: '(?i)\\(\\*(?:END_)?PHRASE\\*\\)' },
      { name: 'comment.block.plc', begin: '\\(\\*', end: '\\*\\)' },
    ],
  },
  label: {
    match: `(%L\\p{Alnum}+)(?:${BLANK}*(:)(?!=))?`,
    captures: {
      1: { name: 'entity.name.label.plc' },
      2: { name: 'punctuation.separator.label.plc' },
    },
  },
  value: {
    patterns: [
      { name: 'string.quoted.single.plc', match: "'(?:[^'$]|\\$.)*'?" },
      {
        name: 'constant.numeric.typed.plc',
        match: `(?i)${START}(?:(?:DATE_AND_TIME|TIME_OF_DAY|DATE|TOD|DT|D)#[0-9][0-9_.:-]*|ADR#[0-9A-Z_.{}\\\\]+|[A-Z][A-Z_]*#-?[0-9A-Z_.]+|\\d+#[0-9A-Z_]+|[HLM]'[^']*')`,
      },
      {
        name: 'variable.other.address.plc',
        match: '%(?![Ll]\\d)\\p{Alnum}+(?:\\{[\\d.]*\\}\\p{Alnum}*)?(?:[.\\\\]\\p{Alnum}+)*(?::[Xx]?\\d+)?',
      },
      // Operands of PL7-2: `I0,05`, `W5`, `T0,D`.
      {
        name: 'variable.other.address.plc',
        match: `${START}(?:[IO]W?|B|X|[CS]?W|SY|S|T|C|M|R|F|D)\\d+(?:,(?:\\d+|[A-Z]))?(?:\\[\\d+\\])?${END}`,
      },
      { name: 'constant.language.plc', match: `(?i)${START}(TRUE|FALSE)${END}` },
      { name: 'constant.numeric.plc', match: `(?<![\\p{L}\\p{N}_%])\\d[\\d_]*(?:\\.\\d+)?(?:[eE][+-]?\\d+)?` },
      { name: 'keyword.operator.plc', match: ':=|->|=>|<=|>=|<>|[=<>+*/-]' },
    ],
  },
  functions: {
    patterns: [
      {
        match: `(?i)${START}(%?SR\\d+)${END}`,
        name: 'entity.name.function.plc',
      },
      keywords('support.function.plc', words('pl7-functions').filter((it) => it.length > 2)),
    ],
  },
  // A part of the interface of a DFB type, and declarations of variables.
  declarations: {
    patterns: [
      {
        match: `(?i)${START}(FUNCTION_BLOCK)${END}${BLANK}+([\\p{L}_][\\p{L}\\p{N}_]*)`,
        captures: {
          1: { name: 'keyword.other.block.plc' },
          2: { name: 'entity.name.function.plc' },
        },
      },
      {
        begin: `(?i)${START}(${oneOf([...words('pl7-dfb').filter((it) => it.startsWith('VAR')), 'VAR_GLOBAL'])})`,
        beginCaptures: { 1: { name: 'keyword.other.declaration.plc' } },
        end: `(?i)${START}(END_VAR)${END}|(?=^${BLANK}*\\[)`,
        endCaptures: { 1: { name: 'keyword.other.declaration.plc' } },
        patterns: [
          { include: '#comment' },
          {
            match: `(?i)([\\p{L}_][\\p{L}\\p{N}_]*)(?=${BLANK}+AT${END}|${BLANK}*:(?!=))`,
            name: 'variable.parameter.plc',
          },
          { match: `(?i)${START}(AT)${END}`, name: 'keyword.other.plc' },
          {
            match: `(:)(?!=)${BLANK}*([\\p{L}_][\\p{L}\\p{N}_]*)`,
            captures: {
              1: { name: 'punctuation.separator.plc' },
              2: { name: 'storage.type.plc' },
            },
          },
          { include: '#value' },
        ],
      },
      keywords('keyword.other.block.plc', words('pl7-dfb').filter((it) => it.startsWith('END'))),
    ],
  },
};

const keywordList = words('pl7-keywords');
const frames = keywordList.filter((it) => /PROGRAM/.test(it));
const rungFrames = keywordList.filter((it) => /RUNG/.test(it));
const isControl = (/** @type {string} */ it) => !frames.includes(it) && !rungFrames.includes(it) && !['END_BLOCK', 'TRUE', 'FALSE'].includes(it);

/** What each language is made of; `#comment` and the like are those of `common`. */
const code = {
  st: [
    { include: '#comment' },
    { include: '#label' },
    keywords('keyword.control.plc', keywordList.filter(isControl)),
    { include: '#functions' },
    { include: '#value' },
  ],
  il: [
    { include: '#comment' },
    { include: '#label' },
    // What stands in square brackets is structured text.
    { begin: '\\[', end: '\\]', patterns: [{ include: '#st' }] },
    keywords('keyword.control.instruction.plc', [...words('pl7-il-instructions'), 'AND(', 'OR(', 'XOR(', 'ANDN(', 'ORN(', 'XORN(']),
    { include: '#functions' },
    { include: '#value' },
  ],
  ld: [
    { include: '#comment' },
    {
      match: `(?i)${START}(RUNG)${END}(?:${BLANK}*(L\\d+)${BLANK}*(:))?`,
      captures: {
        1: { name: 'keyword.other.rung.plc' },
        2: { name: 'entity.name.label.plc' },
        3: { name: 'punctuation.separator.label.plc' },
      },
    },
    { match: `(?i)${START}L\\d+${END}`, name: 'entity.name.label.plc' },
    keywords('keyword.other.rung.plc', [...rungFrames, 'END_BLOCK']),
    { include: '#label' },
    keywords('keyword.control.element.plc', words('pl7-ladder')),
    keywords('support.function.plc', words('pl7-2-operations')),
    { include: '#st' },
  ],
  gr7: [
    { include: '#comment' },
    ...LANGUAGES.filter((it) => it !== 'gr7').flatMap((language) => [
      // `ACTION (P1,ST) :` and `TRANSITION (*comment*) (ST) AT ...`: code in the language that the parentheses name.
      {
        begin: `(?i)${START}(ACTION)${END}(?=[^:\\r\\n]*\\([^)]*${NAMES[language]}\\))`,
        beginCaptures: { 1: { name: 'keyword.other.chart.plc' } },
        end: `(?i)${START}(END_ACTION)${END}`,
        endCaptures: { 1: { name: 'keyword.other.chart.plc' } },
        patterns: [
          {
            match: `(?i)\\(${BLANK}*([PN][01])${BLANK}*,${BLANK}*(${NAMES[language]})${BLANK}*\\)`,
            captures: {
              1: { name: 'storage.modifier.plc' },
              2: { name: 'storage.type.language.plc' },
            },
          },
          { include: `#${language}` },
        ],
      },
      {
        begin: `(?i)${START}(TRANSITION)${END}(?=.*\\(${BLANK}*${NAMES[language]}${BLANK}*\\))`,
        beginCaptures: { 1: { name: 'keyword.other.chart.plc' } },
        end: `(?i)${START}(END_TRANSITION)${END}`,
        endCaptures: { 1: { name: 'keyword.other.chart.plc' } },
        patterns: [
          {
            match: `(?i)\\(${BLANK}*(${NAMES[language]})${BLANK}*\\)`,
            captures: { 1: { name: 'storage.type.language.plc' } },
          },
          { include: '#place' },
          { include: `#${language}` },
        ],
      },
    ]),
    { include: '#place' },
    {
      match: `(?i)${START}(${oneOf(words('pl7-charts').filter((it) => /STEP/.test(it) && !/^END/.test(it)))})${BLANK}+(\\p{Alnum}[\\p{L}\\p{N}_]*)`,
      captures: {
        1: { name: 'keyword.other.chart.plc' },
        2: { name: 'entity.name.section.step.plc' },
      },
    },
    keywords('keyword.other.chart.plc', words('pl7-charts')),
    { include: '#st' },
  ],
};

/**
 * What may stand around code: the blocks of exchange files, and headings of pasted text. Behind one, the language is the
 * one that it names.
 */
const frame = [
  { include: '#comment' },
  ...LANGUAGES.map((language) => ({
    begin: `(?i)^${BLANK}*(${NAMES[language]})${BLANK}*(:)${BLANK}*((?:MAST|FAST|EVT|PL7-2|[A-Z]+${BLANK}*-).*)$`,
    beginCaptures: {
      1: { name: 'storage.type.language.plc' },
      2: { name: 'punctuation.separator.plc' },
      3: { name: 'entity.name.section.plc' },
    },
    end: `(?i)(?=^${BLANK}*(?:IL|ST|LD|GR7)${BLANK}*:(?!=)|^${BLANK}*\\[(?:SOURCE_UNIT|DATA_UNIT|EOF|HEADER)\\])`,
    patterns: [{ include: '#program' }, { include: '#declarations' }, { include: `#${language}` }],
  })),
  ...LANGUAGES.map((language) => ({
    // `LANGUAGE = OTHERS` is followed by `PROG_LANGAGE = GR7`.
    begin: `(?i)^${BLANK}*(${language === 'gr7' ? 'PROG_LANGU?AGE' : 'LANGUAGE'})${BLANK}*(=)${BLANK}*(${NAMES[language]})${END}`,
    beginCaptures: {
      1: { name: 'keyword.other.exchange.plc' },
      2: { name: 'keyword.operator.plc' },
      3: { name: 'storage.type.language.plc' },
    },
    end: `(?i)(?=^${BLANK}*\\[(?:SOURCE_UNIT|DATA_UNIT|EOF|HEADER)\\])`,
    patterns: [{ include: '#exchange' }, { include: '#program' }, { include: '#declarations' }, { include: `#${language}` }],
  })),
  { include: '#exchange' },
  { include: '#program' },
  { include: '#declarations' },
];

const repository = {
  ...common,
  ...Object.fromEntries(LANGUAGES.map((language) => [language, { patterns: code[language] }])),
  exchange: {
    patterns: [
      {
        match: `(?i)^${BLANK}*(\\[(?:HEADER|APPLICATION|VENDOR|SOURCE_UNIT|DATA_UNIT|EOF)\\])`,
        captures: { 1: { name: 'entity.name.tag.exchange.plc' } },
      },
      {
        match: `(?i)^${BLANK}*(DATE|STANDARD|SENDER|NAME|VERSION|SU_TYPE|LANGUAGE|PROG_LANGU?AGE|BODY|ADDRESS)${BLANK}*(=)(.*)$`,
        captures: {
          1: { name: 'keyword.other.exchange.plc' },
          2: { name: 'keyword.operator.plc' },
          3: { name: 'string.unquoted.exchange.plc' },
        },
      },
    ],
  },
  program: {
    patterns: [
      {
        match: `(?i)^${BLANK}*(PROGRAM)(?:${BLANK}*((?:MAST|FAST|EVT|AUX).*))?$`,
        captures: {
          1: { name: 'keyword.other.program.plc' },
          2: { name: 'entity.name.section.plc' },
        },
      },
      keywords('keyword.other.program.plc', frames),
    ],
  },
  // `AT (C 4,L 3)`, `FROM (C 4,L 4) TO (C 4,L 3)`, and the parts of a link.
  place: {
    patterns: [
      { match: `(?i)${START}(AT|FROM|TO)${END}`, name: 'keyword.other.chart.plc' },
      {
        match: `(?i)\\(${BLANK}*(C)${BLANK}*(\\d+)${BLANK}*,${BLANK}*(L)${BLANK}*(\\d+)${BLANK}*\\)`,
        captures: {
          1: { name: 'storage.modifier.plc' },
          2: { name: 'constant.numeric.plc' },
          3: { name: 'storage.modifier.plc' },
          4: { name: 'constant.numeric.plc' },
        },
      },
    ],
  },
};

/**
 * @param {string} name
 * @param {string} scopeName
 * @param {string} language what a text without heading is
 */
function grammar(name, scopeName, language) {
  return { name, scopeName, patterns: [...frame, { include: `#${language}` }], repository };
}

export const pl7 = {
  il: grammar('PL7 instruction list', scopeOf('il'), 'il'),
  st: grammar('PL7 structured text', scopeOf('st'), 'st'),
  ld: grammar('PL7 ladder', scopeOf('ld'), 'ld'),
  gr7: grammar('PL7 Grafcet', scopeOf('gr7'), 'gr7'),
  exchange: grammar('PL7 exchange file', 'source.plc.pl7', 'st'),
};
