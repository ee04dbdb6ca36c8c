// What the grammars colour is what the server reads: on all programs of the corpus, the scopes of the extension's grammars
// are compared with the server's semantic tokens.
import assert from 'node:assert/strict';
import { readdirSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { Session, lsp } from './session.mjs';

const { languageOf, tokens } = await import(pathToFileURL(join(process.env.PLCLINT_MODULES, '../test/tokens.mjs')).href);

/** The scopes that stand for a kind of words of the server. */
const SCOPES = {
  comment: /^comment/,
  keyword: /^(keyword|storage|entity\.name\.(tag|function)|support\.function|constant\.language|string\.unquoted|variable\.other\.address)/,
  number: /^(constant|string|variable\.other\.address|entity\.name|comment\.other)/,
  string: /^(string|entity\.name)/,
  enumMember: /^(entity\.name\.label|variable)/,
  function: /^(entity|support|keyword|string|variable)/,
};

test('grammars agree with the server on the corpus', async (t) => {
  const session = await Session.start(t, ['programs', 'documents']);
  const { legend } = session.result.capabilities.semanticTokensProvider;
  const names = readdirSync(session.folder, { recursive: true }).filter((it) => languageOf(it)).sort();
  assert.ok(names.length > 100);
  const counts = Object.fromEntries(Object.keys(SCOPES).map((it) => [it, { all: 0, wrong: [] }]));
  for (const name of names) {
    const text = session.text(name);
    const { data } = (await session.ask(lsp.SemanticTokensRequest, session.document(name))) ?? { data: [] };
    const coloured = await tokens(languageOf(name), text);
    const lines = text.split(/\r\n|\r|\n/);
    let [line, start] = [0, 0];
    for (let at = 0; at < data.length; at += 5) {
      start = data[at] === 0 ? start + data[at + 1] : data[at + 1];
      line += data[at];
      const kind = legend.tokenTypes[data[at + 3]];
      const scope = coloured[line].find((it) => it.start <= start && start < it.end)?.scope ?? '';
      if (SCOPES[kind]) {
        counts[kind].all += 1;
        if (!SCOPES[kind].test(scope)) {
          const word = lines[line].slice(start, start + data[at + 2]);
          counts[kind].wrong.push(`${name}:${line + 1}: ${word} is ${scope || 'plain'}`);
        }
      }
    }
  }
  for (const [kind, { all, wrong }] of Object.entries(counts)) {
    if (process.env.PLCLINT_VERBOSE) {
      console.log(`${kind}: ${wrong.length} of ${all}`, wrong.slice(0, 40));
    }
    assert.ok(all > 100, kind);
    const share = wrong.length / all;
    assert.ok(share <= (kind === 'comment' ? 0 : 0.06), `${kind}: ${wrong.length} of ${all}: ${wrong.slice(0, 20).join('\n')}`);
  }
  assert.equal(await session.stop(), 0);
});
