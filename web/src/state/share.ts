// Structural sharing: what a message says again keeps its identity, so that only what shows something else is drawn anew.

// A value equal to `next`, made of parts of `old` wherever these are equal; `old` itself if all of it is. Both as JSON has them.
export function shared<T>(old: unknown, next: T): T {
  if (Object.is(old, next)) return next;
  if (typeof old !== 'object' || typeof next !== 'object' || old === null || next === null || Array.isArray(old) !== Array.isArray(next)) return next;
  const before = old as Record<string, unknown>;
  const after = next as Record<string, unknown>;
  const keys = Object.keys(after);
  let same = keys.length === Object.keys(before).length;
  for (const key of keys) {
    const value = shared(before[key], after[key]);
    if (!Object.is(value, before[key]) || !(key in before)) same = false;
    after[key] = value;
  }
  return same ? (old as T) : next;
}
