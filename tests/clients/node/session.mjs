// A session with the server through the client library of VS Code.
import { spawn } from 'node:child_process';
import { cpSync, mkdtempSync, readFileSync, realpathSync, rmSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';

// The modules of the extension, wherever they are installed.
const require = createRequire(join(process.env.PLCLINT_MODULES, 'here.js'));
export const lsp = require('vscode-languageserver-protocol/node');

export const root = new URL('../../..', import.meta.url).pathname;
export const plclint = process.env.PLCLINT;

/** What VS Code says of itself, in what matters here. */
const capabilities = {
  general: { positionEncodings: ['utf-16'] },
  workspace: {
    configuration: true,
    didChangeWatchedFiles: { dynamicRegistration: true },
    workspaceEdit: { documentChanges: true, resourceOperations: ['create', 'rename', 'delete'] },
    diagnostics: { refreshSupport: true },
    codeLens: { refreshSupport: true },
    inlayHint: { refreshSupport: true },
    semanticTokens: { refreshSupport: true },
    textDocumentContent: { dynamicRegistration: true },
    workspaceFolders: true,
  },
  textDocument: {
    publishDiagnostics: {
      relatedInformation: true, versionSupport: true, codeDescriptionSupport: true, dataSupport: true,
      tagSupport: { valueSet: [1, 2] },
    },
    diagnostic: { dynamicRegistration: true, relatedDocumentSupport: false, relatedInformation: true, codeDescriptionSupport: true },
    hover: { contentFormat: ['markdown', 'plaintext'] },
    codeAction: { codeActionLiteralSupport: { codeActionKind: { valueSet: ['', 'quickfix', 'source'] } } },
  },
  window: { workDoneProgress: true },
};

export class Session {
  /** A session that ends with the test `t`. */
  static async start(t, programs, change = (it) => it) {
    const folder = realpathSync(mkdtempSync(join(tmpdir(), 'plclint-')));
    for (const it of programs) {
      cpSync(join(root, 'corpus', it), folder, { recursive: true });
    }
    const session = new Session(folder);
    t.after(() => session.close());
    const uri = pathToFileURL(folder).href;
    const { connection } = session;
    session.result = await connection.sendRequest(lsp.InitializeRequest.type, {
      processId: process.pid, rootUri: uri, capabilities: change(structuredClone(capabilities)),
      workspaceFolders: [{ uri, name: 'corpus' }],
    });
    await connection.sendNotification(lsp.InitializedNotification.type, {});
    return session;
  }

  constructor(folder) {
    this.folder = folder;
    this.server = spawn(plclint, ['server', '--stdio'], { stdio: ['pipe', 'pipe', 'pipe'] });
    this.said = '';
    this.server.stderr.on('data', (it) => { this.said += it; });
    this.ended = new Promise((resolve) => this.server.on('exit', (code, signal) => resolve(signal ?? code)));
    this.connection = lsp.createProtocolConnection(
      new lsp.StreamMessageReader(this.server.stdout), new lsp.StreamMessageWriter(this.server.stdin),
    );
    this.pushed = new Map();
    this.waiting = [];
    this.registered = [];
    this.progress = [];
    this.refreshes = 0;
    this.connection.onNotification(lsp.PublishDiagnosticsNotification.type, (it) => {
      this.pushed.set(it.uri, it);
      this.waiting = this.waiting.filter((check) => !check());
    });
    this.connection.onNotification(lsp.LogMessageNotification.type, () => {});
    this.connection.onNotification('$/progress', (it) => this.progress.push(it.value.kind));
    this.connection.onRequest(lsp.RegistrationRequest.type, (it) => { this.registered.push(...it.registrations); });
    this.connection.onRequest(lsp.WorkDoneProgressCreateRequest.type, () => {});
    for (const it of [lsp.DiagnosticRefreshRequest, lsp.CodeLensRefreshRequest, lsp.InlayHintRefreshRequest, lsp.SemanticTokensRefreshRequest]) {
      this.connection.onRequest(it.type, () => { this.refreshes += 1; });
    }
    this.connection.listen();
  }

  uri(name) {
    return pathToFileURL(join(this.folder, name)).href;
  }

  document(name) {
    return { textDocument: { uri: this.uri(name) } };
  }

  text(name) {
    return readFileSync(join(this.folder, name), 'utf8');
  }

  async open(name, languageId) {
    const text = this.text(name);
    await this.connection.sendNotification(lsp.DidOpenTextDocumentNotification.type, {
      textDocument: { uri: this.uri(name), languageId, version: 1, text },
    });
    return text;
  }

  ask(request, params, token) {
    return this.connection.sendRequest(request.type, params, token);
  }

  /** Until the pushed findings of a file are as wanted. */
  findings(name, isSo) {
    return new Promise((resolve) => {
      const check = () => {
        const it = this.pushed.get(this.uri(name));
        const is = it !== undefined && isSo(it.diagnostics);
        if (is) {
          resolve(it.diagnostics);
        }
        return is;
      };
      if (!check()) {
        this.waiting.push(check);
      }
    });
  }

  async stop() {
    await this.connection.sendRequest(lsp.ShutdownRequest.type);
    await this.connection.sendNotification(lsp.ExitNotification.type);
    return this.ended;
  }

  close() {
    this.connection.dispose();
    this.server.kill();
    rmSync(this.folder, { recursive: true });
  }
}

/** The place of a piece of a text, as the protocol counts it. */
export function place(text, piece, within = 0) {
  const at = text.indexOf(piece);
  if (at < 0) {
    throw new Error(`no ${piece}`);
  }
  const before = text.slice(0, at + within).split(/\r\n|\r|\n/);
  return { line: before.length - 1, character: before.at(-1).length };
}
