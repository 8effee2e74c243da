// What is set by users, and refused where it is not what it should be.
import { refuse, said } from '../errors.js';
import { reading } from '../memory.js';

/** Options of these names alone; none where none were given. */
export function readOptions<T extends object>(what: string, given: T | null | undefined, names: (keyof T & string)[]): Partial<T> {
  if (given == null) return {};
  if (typeof given !== 'object') refuse(`${what}: options of ${said(given)}, expected an object`);
  const options = reading(what, () => ({ ...given }));
  const other = Object.keys(options).find((name) => !names.includes(name as keyof T & string));
  if (other !== undefined) refuse(`${what}: an option named ${other}, expected ${names.join(' or ')}`);
  return options;
}
