import { homedir } from 'node:os';
import {
  type ExtensionContext,
  type LogOutputChannel,
  type QuickPickItem,
  type Uri as UriType,
  Uri,
  commands,
  languages,
  window,
  workspace,
} from 'vscode';
import { LanguageClient, type LanguageClientOptions, RevealOutputChannelOn, State, TransportKind } from 'vscode-languageclient/node';
import { RESTARTING, type Settings, advice, languagesOf, pageOf, program, selector } from './options';

/** The user is told once that the server does not start, by `tell`; the library would say so too. */
class Client extends LanguageClient {
  override error(message: string, data?: unknown, showNotification?: boolean | 'force'): void {
    super.error(message, data, this.state === State.Running ? showNotification : false);
  }
}

let client: Client | undefined;
/** Starts and stops follow one another. */
let queue: Promise<void> = Promise.resolve();

export async function activate(context: ExtensionContext): Promise<void> {
  const log = window.createOutputChannel('plclint', { log: true });
  const restart = () => inTurn(async () => {
    await stop();
    await start(context, log);
  });
  context.subscriptions.push(
    log,
    commands.registerCommand('plclint.restartServer', restart),
    commands.registerCommand('plclint.showRule', showRule),
    commands.registerCommand('plclint.showLog', () => { log.show(); }),
    workspace.onDidChangeConfiguration(async (event) => {
      if (RESTARTING.some((it) => event.affectsConfiguration(it))) {
        await restart();
      }
    }),
    workspace.onDidGrantWorkspaceTrust(restart),
  );
  await restart();
}

export async function deactivate(): Promise<void> {
  await inTurn(stop);
}

function inTurn(work: () => Promise<void>): Promise<void> {
  queue = queue.then(work, work);
  return queue;
}

function settings(): Settings {
  const it = workspace.getConfiguration('plclint');
  return {
    enable: it.get('enable', true),
    path: it.get('server.path', 'plclint'),
    extraArgs: it.get('server.extraArgs', []),
    extraEnv: it.get('server.extraEnv', {}),
  };
}

async function start(context: ExtensionContext, log: LogOutputChannel): Promise<void> {
  const current = settings();
  if (!current.enable) {
    log.info('plclint is switched off');
    return;
  }
  const folder = workspace.workspaceFolders?.[0]?.uri.fsPath;
  const { command, args, env } = program(current, { home: homedir(), folder, env: process.env });
  log.info(`${command} ${args.join(' ')}`);
  const options: LanguageClientOptions = {
    documentSelector: selector(languagesOf(context.extension.packageJSON)),
    outputChannel: log,
    revealOutputChannelOn: RevealOutputChannelOn.Never,
    // The user is told once, below.
    initializationFailedHandler: () => false,
  };
  const server = { command, transport: TransportKind.stdio, options: { env } };
  const next = new Client('plclint', 'plclint', { ...server, args }, options);
  client = next;
  try {
    await next.start();
  } catch (error) {
    client = undefined;
    const reason = error instanceof Error ? error.message : String(error);
    log.error(reason);
    void tell(advice(command, reason), log);
  }
}

async function stop(): Promise<void> {
  const last = client;
  client = undefined;
  if (last?.needsStop()) {
    await last.dispose();
  }
}

async function tell(message: string, log: LogOutputChannel): Promise<void> {
  const answer = await window.showErrorMessage(message, 'Open settings', 'Show log');
  if (answer === 'Open settings') {
    await commands.executeCommand('workbench.action.openSettings', 'plclint.server.path');
  } else if (answer === 'Show log') {
    log.show();
  }
}

/** Of the findings at the cursor, else of those on its line; a code may be typed where there are none. */
async function showRule(): Promise<void> {
  const found = rulesAtCursor();
  const page = found.length > 1 ? (await window.showQuickPick(found, { title: 'plclint: page of a rule' }))?.page
    : (found[0]?.page ?? (await askForPage()));
  if (!page) {
    return;
  }
  try {
    const document = await workspace.openTextDocument(page);
    await languages.setTextDocumentLanguage(document, 'markdown');
    await commands.executeCommand('markdown.showPreview', page);
  } catch (error) {
    void window.showErrorMessage(`plclint: ${error instanceof Error ? error.message : String(error)}`);
  }
}

interface RulePick extends QuickPickItem {
  readonly page: UriType;
}

/** Each rule once. */
function rulesAtCursor(): RulePick[] {
  const editor = window.activeTextEditor;
  if (!editor) {
    return [];
  }
  const cursor = editor.selection.active;
  const own = languages.getDiagnostics(editor.document.uri).filter((it) => it.source === 'plclint');
  const here = own.filter((it) => it.range.contains(cursor));
  const near = here.length > 0 ? here : own.filter((it) => it.range.intersection(editor.document.lineAt(cursor).range));
  const found = new Map<string, RulePick>();
  for (const { code, message } of near) {
    if (typeof code === 'object' && !found.has(String(code.value))) {
      found.set(String(code.value), { label: String(code.value), description: message.split('\n', 1)[0] ?? '', page: code.target });
    }
  }
  return [...found.values()];
}

async function askForPage(): Promise<UriType | undefined> {
  const code = await window.showInputBox({
    title: 'plclint: page of a rule',
    prompt: 'Code of the rule',
    placeHolder: 'W001',
    validateInput: (it) => (it.trim() === '' || pageOf(it) ? undefined : 'A code is a letter and three digits'),
  });
  const page = code && pageOf(code);
  return page ? Uri.parse(page) : undefined;
}
