// Tokens as an editor makes them: the grammars in dist/ under the editor's own engine.
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';

const require = createRequire(import.meta.url);
const oniguruma = require('vscode-oniguruma');
const { INITIAL, Registry, parseRawGrammar } = require('vscode-textmate');

const manifest = JSON.parse(readFileSync(new URL('../package.json', import.meta.url), 'utf8'));
const grammars = manifest.contributes.grammars;

let registry;
async function open() {
  if (!registry) {
    await oniguruma.loadWASM(readFileSync(require.resolve('vscode-oniguruma/release/onig.wasm')).buffer);
    registry = new Registry({
      onigLib: Promise.resolve({
        createOnigScanner: (patterns) => new oniguruma.OnigScanner(patterns),
        createOnigString: (text) => new oniguruma.OnigString(text),
      }),
      loadGrammar: async (scopeName) => {
        const it = grammars.find((it) => it.scopeName === scopeName);
        const path = new URL(`../${it.path}`, import.meta.url);
        return parseRawGrammar(readFileSync(path, 'utf8'), path.pathname);
      },
    });
  }
  return registry;
}

export const languages = manifest.contributes.languages;

/** The language that an editor gives to a file of that name. */
export function languageOf(path) {
  const name = path.toLowerCase();
  return languages.find((it) => it.extensions.some((extension) => name.endsWith(extension)))?.id;
}

/**
 * The tokens of each line: where they begin and end, and their innermost scope without the name of the language.
 * @returns {Promise<{ start: number, end: number, scope: string }[][]>}
 */
export async function tokens(language, text) {
  const { scopeName } = grammars.find((it) => it.language === language);
  const grammar = await (await open()).loadGrammar(scopeName);
  let state = INITIAL;
  return text.split(/\r\n|\r|\n/).map((line) => {
    const result = grammar.tokenizeLine(line, state, 20000);
    if (result.stoppedEarly) {
      throw new Error(`too slow: ${line}`);
    }
    state = result.ruleStack;
    return result.tokens.map(({ startIndex, endIndex, scopes }) => ({
      start: startIndex,
      end: endIndex,
      scope: scopes.length > 1 ? scopes[scopes.length - 1] : '',
    }));
  });
}

/** The scope of each piece of a text that has one, as `piece: scope`. */
export async function scopes(language, text) {
  const lines = text.split('\n');
  const found = await tokens(language, text);
  return found.flatMap((line, at) => {
    const pieces = [];
    for (const it of line) {
      const last = pieces.at(-1);
      if (last?.scope === it.scope && last.end === it.start) {
        last.end = it.end;
      } else {
        pieces.push({ ...it });
      }
    }
    return pieces
      .map((it) => [lines[at].slice(it.start, it.end).trim(), it.scope.replace(/\.plc$/, '')])
      .filter(([piece, scope]) => piece && scope)
      .map((it) => it.join(': '));
  });
}
