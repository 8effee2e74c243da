/** Gives an object its own property back, or none. */
export function restore(object: object, name: string, own: PropertyDescriptor | undefined): void {
  if (own) Object.defineProperty(object, name, own);
  else delete (object as Record<string, unknown>)[name];
}
