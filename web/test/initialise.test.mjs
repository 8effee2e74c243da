// `sightline-culling/wasm`: the module's bytes come from elsewhere, and may fail to come.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { initialise, ready, SightlineError, World } from 'sightline-culling/wasm';

const whole = readFileSync(new URL('../dist/whole.wasm', import.meta.url));
const other = readFileSync(new URL('../../build/web/page/strata.wasm', import.meta.url));
const refusal = (words) => (error) => {
  assert.ok(error instanceof SightlineError, error.stack);
  assert.match(error.message, words);
  return true;
};

test('the module is loaded by another try where one has failed', async () => {
  const sources = [
    [6n, /^initialise: \(bigint\), expected/], [undefined, /^initialise: undefined, expected/], [{}, /\(object\), expected/],
    [new Uint8Array(7), /could not be loaded \(.*\); try again/], [whole.subarray(0, 1000), /could not be loaded/],
    [other, /another module, expected/],
    [async () => { throw new TypeError('fetch failed'); }, /could not be loaded \(fetch failed\); try again/],
    [new Response('not here', { status: 404 }), /^sightline: the module could not be fetched \(404\)/]];
  for (const [source, words] of sources) {
    const first = ready, tried = initialise(typeof source === 'function' ? source() : source);
    assert.throws(() => initialise(whole), refusal(/loaded already/)); // one at a time
    await assert.rejects(tried, refusal(words));
    await assert.rejects(ready, refusal(words));
    assert.throws(() => new World(), refusal(/not loaded yet/));
    if (source !== sources[0][0]) assert.notEqual(ready, first);
  }
  await initialise(Promise.resolve(whole));
  await ready;
  assert.equal(new World().size, 0);
  assert.throws(() => initialise(whole), refusal(/loaded already/));
});
