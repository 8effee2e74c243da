// How what lies in the module's memory is given back.
import { SightlineError } from '../errors.js';

/** Gives each of them back; once the module has ended there is nothing to give back. */
export function release(...all: ({ dispose(): void } | null | undefined)[]): void {
  for (const one of all) {
    try {
      one?.dispose();
    } catch (error) {
      if (!(error instanceof SightlineError && error.code === 'ended')) throw error;
    }
  }
}
