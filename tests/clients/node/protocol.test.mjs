// The client library of VS Code against the server.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { Session, lsp, place, plclint } from './session.mjs';

const FILE = 'recettes.st';

/** `W001 12` of what the command line finds in a folder, by path. */
function checked(folder) {
  const output = join(folder, 'findings.json');
  try {
    execFileSync(plclint, ['check', folder, '--format', 'json', '-o', output], { stdio: 'ignore' });
  } catch (error) {
    assert.equal(error.status, 1);
  }
  const { findings } = JSON.parse(readFileSync(output, 'utf8'));
  return findings.filter((it) => !it.suppressed).map((it) => `${it.path.slice(folder.length + 1)} ${it.code} ${it.start.line}`).sort();
}

const lines = (name, diagnostics) => diagnostics.map((it) => `${name} ${it.code} ${it.range.start.line + 1}`);
const pushing = (it) => {
  delete it.textDocument.diagnostic;
  return it;
};

test('findings are pulled, for documents and for the workspace', async (t) => {
  const session = await Session.start(t, ['programs/recettes']);
  const { capabilities } = session.result;
  assert.equal(capabilities.positionEncoding, 'utf-16');
  assert.equal(capabilities.diagnosticProvider.workspaceDiagnostics, true);
  await session.open(FILE, 'plc-pl7-st');
  const report = await session.ask(lsp.DocumentDiagnosticRequest, session.document(FILE));
  const all = await session.ask(lsp.WorkspaceDiagnosticRequest, { previousResultIds: [] });
  const found = all.items.flatMap((it) => lines(decodeURIComponent(it.uri.split('/').at(-1)), it.items)).sort();
  assert.deepEqual(found, checked(session.folder));
  assert.deepEqual(lines(FILE, report.items).sort(), found.filter((it) => it.startsWith(FILE)));
  const again = await session.ask(lsp.DocumentDiagnosticRequest, { ...session.document(FILE), previousResultId: report.resultId });
  assert.equal(again.kind, 'unchanged');

  const fixable = report.items.find((it) => it.code === 'T018');
  assert.equal(fixable.source, 'plclint');
  const page = fixable.codeDescription.href;
  assert.match(page, /^plclint-rule:\/\/\/T018\//);
  const { text } = await session.ask(lsp.TextDocumentContentRequest, { uri: page });
  assert.match(text, /^# .*\(T018\)/m);
  assert.ok(session.registered.some((it) => it.method === 'workspace/didChangeWatchedFiles'));
  assert.ok(session.progress.includes('begin') && session.progress.includes('end'));
  assert.equal(session.pushed.size, 0, 'nothing is pushed to a client that pulls');
  assert.equal(await session.stop(), 0);
  assert.equal(session.said, '');
});

test('findings are pushed, and a quick-fix mends one', async (t) => {
  const session = await Session.start(t, ['programs/recettes'], pushing);
  const text = await session.open(FILE, 'plc-pl7-st');
  const before = await session.findings(FILE, (it) => it.length > 5);
  assert.deepEqual(lines(FILE, before).sort(), checked(session.folder).filter((it) => it.startsWith(FILE)));
  const at = place(text, '%MW5:=0 THEN', 5);
  const actions = await session.ask(lsp.CodeActionRequest, {
    ...session.document(FILE), range: { start: at, end: at }, context: { diagnostics: before, only: ['quickfix'] },
  });
  const action = actions.find((it) => it.title === 'Write `=`');
  assert.ok(action?.isPreferred, JSON.stringify(actions.map((it) => it.title)));
  const [{ textDocument, edits }] = action.edit.documentChanges;
  assert.equal(textDocument.uri, session.uri(FILE));
  assert.equal(textDocument.version, 1);
  await session.connection.sendNotification(lsp.DidChangeTextDocumentNotification.type, {
    textDocument: { uri: session.uri(FILE), version: 2 },
    contentChanges: edits.map((it) => ({ range: it.range, text: it.newText })),
  });
  const line = at.line;
  await session.findings(FILE, (it) => it.every((it) => it.code !== 'T018' || it.range.start.line !== line));
  assert.equal(session.pushed.get(session.uri(FILE)).version, 2);
  assert.equal(await session.stop(), 0);
});

test('what stands at a place is told, found and completed', async (t) => {
  const session = await Session.start(t, ['programs/recettes', 'programs/convoyeur-s7']);
  const text = await session.open(FILE, 'plc-pl7-st');
  const here = { ...session.document(FILE), position: place(text, '%M0:=TRUE', 1) };
  const hover = await session.ask(lsp.HoverRequest, here);
  assert.equal(hover.contents.kind, 'markdown');
  assert.match(hover.contents.value, /%M0/);
  const references = await session.ask(lsp.ReferencesRequest, { ...here, context: { includeDeclaration: true } });
  assert.ok(references.length >= 2);
  const highlights = await session.ask(lsp.DocumentHighlightRequest, here);
  assert.ok(highlights.length >= 2);
  const symbols = await session.ask(lsp.DocumentSymbolRequest, session.document(FILE));
  assert.ok(symbols.length > 0);
  const folding = await session.ask(lsp.FoldingRangeRequest, session.document(FILE));
  assert.ok(folding.length > 0);
  const tokens = await session.ask(lsp.SemanticTokensRequest, session.document(FILE));
  assert.equal(tokens.data.length % 5, 0);
  assert.ok(tokens.data.length > 500);
  const completion = await session.ask(lsp.CompletionRequest, here);
  assert.ok((completion.items ?? completion).some((it) => it.label.startsWith('%M')));

  const code = await session.open('convoyeur.awl', 'plc-step7-awl');
  const symbol = { ...session.document('convoyeur.awl'), position: place(code, '"Marche"', 2) };
  const [definition] = [await session.ask(lsp.DefinitionRequest, symbol)].flat();
  assert.equal(definition.uri, session.uri('convoyeur.sdf'));
  const found = await session.ask(lsp.WorkspaceSymbolRequest, { query: 'Marche' });
  assert.ok(found.some((it) => it.name.startsWith('Marche ')), JSON.stringify(found));
  const all = { start: { line: 0, character: 0 }, end: { line: 10000, character: 0 } };
  const hints = await session.ask(lsp.InlayHintRequest, { ...session.document('convoyeur.awl'), range: all });
  assert.ok(Array.isArray(hints));
  const lenses = await session.ask(lsp.CodeLensRequest, session.document('convoyeur.awl'));
  assert.ok(lenses.length > 0);
  const prepared = await session.ask(lsp.PrepareRenameRequest, symbol);
  if (prepared) {
    const edit = await session.ask(lsp.RenameRequest, { ...symbol, newName: 'Depart' });
    assert.ok(edit.documentChanges.length > 0);
  }
  assert.equal(await session.stop(), 0);
});

test('a cancelled request is refused and the session goes on', async (t) => {
  const session = await Session.start(t, ['programs/recettes']);
  await session.open(FILE, 'plc-pl7-st');
  const all = await session.ask(lsp.WorkspaceDiagnosticRequest, { previousResultIds: [] });
  const previousResultIds = all.items.map((it) => ({ uri: it.uri, value: it.resultId }));
  const source = new lsp.CancellationTokenSource();
  const waits = session.ask(lsp.WorkspaceDiagnosticRequest, { previousResultIds }, source.token);
  setTimeout(() => source.cancel(), 50);
  await assert.rejects(waits, { code: lsp.LSPErrorCodes.RequestCancelled });
  await assert.rejects(session.connection.sendRequest('no/such'), { code: lsp.ErrorCodes.MethodNotFound });
  const report = await session.ask(lsp.DocumentDiagnosticRequest, session.document(FILE));
  assert.equal(report.kind, 'full');
  assert.equal(await session.stop(), 0);
});

test('a server whose client dies ends', async (t) => {
  const session = await Session.start(t, ['programs/recettes'], pushing);
  await session.open(FILE, 'plc-pl7-st');
  session.server.stdin.destroy();
  session.server.stdout.destroy();
  assert.equal(await session.ended, 1);
  assert.equal(session.said, '');
});
