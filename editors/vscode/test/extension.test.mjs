import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { test } from 'node:test';
import { buildSync } from 'esbuild';

const manifest = JSON.parse(readFileSync(new URL('../package.json', import.meta.url), 'utf8'));

function load(entry) {
  const path = new URL(`../src/${entry}`, import.meta.url).pathname;
  const built = buildSync({ entryPoints: [path], bundle: true, platform: 'node', format: 'cjs', write: false });
  const module = { exports: {} };
  new Function('module', 'exports', 'require', built.outputFiles[0].text)(module, module.exports, createRequire(path));
  return module.exports;
}

const options = load('options.ts');
const around = { home: '/home/me', folder: '/work/line 3', env: { PATH: '/bin', A: '1' } };
const settings = { enable: true, path: 'plclint', extraArgs: [], extraEnv: {} };

test('the server is started as the settings say', () => {
  assert.deepEqual(options.program(settings, around), { command: 'plclint', args: ['server'], env: { PATH: '/bin', A: '1' } });
  const own = { ...settings, path: ' ~/bin/plclint ', extraArgs: ['-v'], extraEnv: { A: '2' } };
  assert.deepEqual(options.program(own, around), {
    command: '/home/me/bin/plclint', args: ['server', '-v'], env: { PATH: '/bin', A: '2' },
  });
  assert.equal(options.program({ ...settings, path: '${workspaceFolder}/plclint' }, around).command, '/work/line 3/plclint');
  assert.equal(options.program({ ...settings, path: '' }, { ...around, folder: undefined }).command, 'plclint');
  assert.equal(options.program({ ...settings, path: '~other/plclint' }, around).command, '~other/plclint');
});

test('documents are ours by their language or by their name, in any case', () => {
  const filters = options.selector(options.languagesOf(manifest));
  const own = manifest.contributes.languages.map((it) => it.id);
  assert.deepEqual(filters.filter((it) => it.language && it.scheme === 'file').map((it) => it.language), own);
  const glob = filters.find((it) => it.pattern?.includes('{')).pattern;
  const inner = glob.slice(glob.indexOf('{') + 1, glob.indexOf('}')).split(',');
  const matches = (extension) => inner.some((it) => new RegExp(`^${it}$`).test(extension));
  for (const extension of manifest.contributes.languages.flatMap((it) => it.extensions)) {
    assert.ok(matches(extension.slice(1)) && matches(extension.slice(1).toUpperCase()), extension);
  }
  assert.ok(matches('Sdf') && !matches('txt') && !matches('awls'));
  assert.deepEqual(options.languagesOf(undefined), []);
});

test('pages are asked for by their code', () => {
  assert.equal(options.pageOf(' w001 '), 'plclint-rule:///W001/W001.md');
  assert.equal(options.pageOf('W1'), undefined);
  assert.equal(options.pageOf('../../etc'), undefined);
});

test('the manifest declares what the code uses', () => {
  const code = readFileSync(new URL('../src/extension.ts', import.meta.url), 'utf8');
  const registered = [...code.matchAll(/registerCommand\('([^']+)'/g)].map((it) => it[1]);
  assert.deepEqual(registered.sort(), manifest.contributes.commands.map((it) => it.command).sort());
  const keys = Object.keys(manifest.contributes.configuration.properties);
  for (const [, key, fallback] of code.matchAll(/it\.get\('([^']+)', ([^)]+)\)/g)) {
    const declared = manifest.contributes.configuration.properties[`plclint.${key}`];
    assert.ok(declared, key);
    assert.equal(JSON.stringify(declared.default), fallback.replaceAll("'", '"'), key);
  }
  for (const prefix of options.RESTARTING) {
    assert.ok(keys.some((it) => it.startsWith(prefix)), prefix);
  }
  for (const it of [...manifest.contributes.languages, ...manifest.contributes.grammars]) {
    readFileSync(new URL(`../${it.path ?? it.configuration}`, import.meta.url));
  }
});
