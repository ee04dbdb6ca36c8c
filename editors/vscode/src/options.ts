// What the settings mean, without the editor: this much can be tested outside of it.

export interface Settings {
  readonly enable: boolean;
  readonly path: string;
  readonly extraArgs: readonly string[];
  readonly extraEnv: Readonly<Record<string, string>>;
}

export interface Surroundings {
  readonly home: string;
  /** The first folder of the workspace. */
  readonly folder: string | undefined;
  readonly env: Readonly<Record<string, string | undefined>>;
}

export interface Program {
  readonly command: string;
  readonly args: string[];
  readonly env: Record<string, string | undefined>;
}

/** How the server is started. */
export function program(settings: Settings, around: Surroundings): Program {
  let command = settings.path.trim() || 'plclint';
  if (command === '~' || command.startsWith('~/') || command.startsWith('~\\')) {
    command = around.home + command.slice(1);
  }
  command = command.replaceAll('${workspaceFolder}', () => around.folder ?? '');
  return {
    command,
    args: ['server', ...settings.extraArgs],
    env: { ...around.env, ...settings.extraEnv },
  };
}

/** Settings whose change needs another server. */
export const RESTARTING = ['plclint.enable', 'plclint.server'] as const;

/** Extensions of the languages that package.json declares, and of symbol tables. */
const PROGRAMS = ['awl', 'stl', 's5', 'il', 'st', 'ld', 'gr7', 'sfc', 'dfb', 'fef', 'scy'];
const TABLES = ['sdf', 'asc', 'seq', 'dif'];

/** A glob that matches in any case: `*.[aA][wW][lL]`. */
function anyCase(extension: string): string {
  return extension.replace(/[a-z]/g, (it) => `[${it}${it.toUpperCase()}]`);
}

export interface Filter {
  readonly scheme: string;
  readonly language?: string;
  readonly pattern?: string;
}

/**
 * The documents that the server is told of. By language, for those that the user has given one of ours; and by name, because
 * another extension may own the language of `.st` or `.il`: the server tells by the content whether it is a program.
 */
export function selector(languages: readonly string[]): Filter[] {
  const pattern = `**/*.{${[...PROGRAMS, ...TABLES].map(anyCase).join(',')}}`;
  const filters: Filter[] = languages.flatMap((language) => [
    { scheme: 'file', language },
    { scheme: 'untitled', language },
  ]);
  return [...filters, { scheme: 'file', pattern }, { scheme: 'file', pattern: '**/plclint.toml' }];
}

/** The languages that a manifest contributes. */
export function languagesOf(manifest: unknown): string[] {
  const contributes = (manifest as { contributes?: { languages?: { id: string }[] } } | undefined)?.contributes;
  return (contributes?.languages ?? []).map((it) => it.id);
}

/** The scheme of the addresses of rule pages. */
export const PAGES = 'plclint-rule';

/** The address of a rule's page by what the user typed; nothing for what cannot be a code. */
export function pageOf(input: string): string | undefined {
  const code = input.trim().toUpperCase();
  return /^[A-Z]\d{3}$/.test(code) ? `${PAGES}:///${code}/${code}.md` : undefined;
}

/** What to do about a server that does not start. */
export function advice(command: string, reason: string): string {
  return `plclint: the server \`${command}\` does not start: ${reason}. Install plclint, or set \`plclint.server.path\`.`;
}
