// Regular expressions of the words in words.json, which `cargo test --test editors` compares with the lexers.
import { readFileSync } from 'node:fs';

/** @type {Record<string, string[]>} */
const lists = JSON.parse(readFileSync(new URL('../words.json', import.meta.url), 'utf8'));

/**
 * The words of some lists.
 * @param {string[]} names
 * @returns {string[]}
 */
export function words(...names) {
  const all = names.flatMap((name) => {
    const list = lists[name];
    if (!list) {
      throw new Error(`words.json has no list ${name}`);
    }
    return list;
  });
  return [...new Set(all)];
}

/** @param {string} text */
function escape(text) {
  return text.replace(/[\\^$.*+?()[\]{}|/-]/g, '\\$&');
}

/**
 * One of the words, the longest that fits. What ends with a letter ends there.
 * @param {string[]} list
 */
export function oneOf(list) {
  const sorted = [...list].sort((a, b) => b.length - a.length || (a < b ? -1 : 1));
  const isSpelt = (/** @type {string} */ it) => /[\p{L}\p{N}_]$/u.test(it);
  // Each `END` costs time when an editor reads the grammar: one for all words. `U(` and `SPA=` are before `U` and `SPA`, `==I` is before `=`.
  const signs = sorted.filter((it) => !isSpelt(it)).map(escape);
  const spelt = sorted.filter(isSpelt).map(escape);
  const [open, bare] = [true, false].map((is) => signs.filter((it) => /^\p{L}/u.test(it) === is));
  const parts = [open.join('|'), spelt.length > 0 ? `(?:${spelt.join('|')})${END}` : '', bare.join('|')];
  return `(?:${parts.filter((it) => it).join('|')})`;
}

/** No letter, digit or underscore before here. */
export const START = '(?<![\\p{L}\\p{N}_%#])';
/** No letter, digit or underscore behind here. */
export const END = '(?![\\p{L}\\p{N}_])';

/**
 * Whole words, in any case.
 * @param {string} scope
 * @param {string[]} list
 */
export function keywords(scope, list) {
  return { name: scope, match: `(?i)${START}${oneOf(list)}` };
}
