// Makes dist/: the bundled extension and the grammars.
import { mkdirSync, writeFileSync } from 'node:fs';
import { build } from 'esbuild';
import { pl7 } from '../grammars/pl7.mjs';
import { step5, step7 } from '../grammars/siemens.mjs';

const root = new URL('..', import.meta.url);
process.chdir(new URL('.', root).pathname);
mkdirSync('dist', { recursive: true });

const grammars = {
  step7,
  step5,
  'pl7-il': pl7.il,
  'pl7-st': pl7.st,
  'pl7-ld': pl7.ld,
  'pl7-gr7': pl7.gr7,
  pl7: pl7.exchange,
};
for (const [name, grammar] of Object.entries(grammars)) {
  writeFileSync(`dist/${name}.tmLanguage.json`, JSON.stringify(grammar));
}

const common = /** @type {const} */ ({ bundle: true, platform: 'node', format: 'cjs', target: 'node20', logLevel: 'warning' });
const minify = process.argv.includes('--minify');
await build({ ...common, entryPoints: ['src/extension.ts'], outfile: 'dist/extension.js', external: ['vscode'], minify });
