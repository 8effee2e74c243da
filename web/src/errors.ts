/** What kind of thing was refused, as the library numbers it. */
export const codes = [
  'ok', 'bad_argument', 'bad_box', 'stale_handle', 'bad_view', 'buffer_too_small', 'stale_buffer', 'bad_mesh', 'too_many',
  'bad_file',
] as const;
export type Code = (typeof codes)[number] | 'not_ready' | 'unsupported' | 'disposed' | 'detached' | 'ended' | 'lost';

/** A refusal: `message` is one sentence, `index` the offending element's, where one is to blame. What was refused has
 * changed nothing. */
export class SightlineError extends Error {
  readonly code: Code;
  readonly index: number | undefined;
  constructor(code: Code, message: string, index?: number) {
    super(message);
    this.name = 'SightlineError';
    this.code = code;
    this.index = index;
  }
}

/** A value as a refusal names it: symbols and objects may have no words of their own, and 6n reads as 6. */
export const said = (value: unknown): string =>
  typeof value === 'number' || typeof value === 'string' || value == null ? `${value}` : `(${typeof value})`;

export function refuse(message: string, code: Code = 'bad_argument'): never {
  throw new SightlineError(code, message);
}

/** Of what is called on something that has not what is private to it: frameworks wrap what stands in a page's state, and methods
 * are taken off their objects. */
export const refuseProxy = (what: unknown): never => refuse(`${said(what)}: called on a Proxy or a copy of it, expected the object itself`);
