// A page at rest: the browser is asked for few frames, and for one at once when something happens.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { example, launch } from './page.mjs';

let browser;
let sinew;
before(async () => {
  browser = await launch();
  const count = () => {
    // One worker, so that a picture takes long on any machine.
    Object.defineProperty(Navigator.prototype, 'hardwareConcurrency', { get: () => 1 });
    globalThis.asked = 0;
    const request = globalThis.requestAnimationFrame;
    globalThis.requestAnimationFrame = (callback) => {
      globalThis.asked += 1;
      return request(callback);
    };
  };
  sinew = await browser.open({ before: (page) => page.addInitScript(count) });
  await sinew.load('surface s diffuse Gold\nsphere s 1 0 0 0\n');
  const { workers } = await sinew.finished();
  assert.equal(workers, 1);
});
after(() => browser?.close());

/** Frames that the browser is asked for in two seconds, once the page has come to rest. */
async function atRest() {
  for (let attempt = 0; ; attempt++) {
    const asked = await sinew.page.evaluate(async () => {
      const before = globalThis.asked;
      await new Promise((done) => setTimeout(done, 2000));
      return globalThis.asked - before;
    });
    // What has just happened may still be fading.
    if (asked <= 16 || attempt === 4) return asked;
  }
}

test('few frames while nothing happens', async () => {
  const asked = await atRest();
  // At 60 Hz they would be 120. A few come in any case, should an event have been missed.
  assert.ok(asked >= 2 && asked <= 16, `${asked} in two seconds`);
});

const HAPPENINGS = {
  'an event': () => document.querySelector('canvas').dispatchEvent(new MouseEvent('mousemove')),
  'a script': () => sinew.load('surface s diffuse Gold\nsphere s 1 0.1 0 0\n'),
};
for (const [what, happens] of Object.entries(HAPPENINGS)) {
  test(`${what} is answered with a frame at once`, async () => {
    let asked = 0;
    // A frame may be on its way already.
    for (let attempt = 0; attempt < 5 && asked === 0; attempt++) {
      await atRest();
      asked = await sinew.page.evaluate(`(() => {
        const before = globalThis.asked;
        (${happens})();
        return globalThis.asked - before;
      })()`);
    }
    assert.equal(asked, 1);
    await sinew.finished();
  });
}

test('whoever asks for a frame gets it, unless he takes that back', async () => {
  await atRest();
  const came = await sinew.page.evaluate(async () => {
    const came = [];
    requestAnimationFrame(() => came.push('first'));
    cancelAnimationFrame(requestAnimationFrame(() => came.push('held back')));
    await new Promise((done) => setTimeout(done, 1000));
    // Given by the browser, but not come.
    globalThis.dispatchEvent(new Event('mousemove'));
    cancelAnimationFrame(requestAnimationFrame(() => came.push('given')));
    requestAnimationFrame(() => came.push('last'));
    await new Promise((done) => setTimeout(done, 1000));
    return came;
  });
  assert.deepEqual(came, ['first', 'last']);
  assert.deepEqual(sinew.troubles, []);
});

test('where each frame keeps the tracer waiting, few are drawn for what can wait, and one at once for the rest', async () => {
  await sinew.resize(1400, 1400);
  const told = await sinew.page.evaluate(async (text) => {
    const pause = (milliseconds) => new Promise((done) => setTimeout(done, milliseconds));
    sinew.load(text);
    for (let wait = 0; wait < 500 && sinew.status().phase !== 'tracing'; wait++) await pause(10);
    // The pointer that was last here is forgotten.
    await pause(800);
    const before = globalThis.asked;
    const end = performance.now() + 1000;
    while (performance.now() < end) {
      globalThis.dispatchEvent(new KeyboardEvent('keyup', { key: 'Shift' }));
      await pause(5);
    }
    const paced = globalThis.asked - before;
    let atOnce = false;
    // A frame may be on its way already.
    for (let attempt = 0; attempt < 20 && !atOnce; attempt++) {
      await pause(37);
      const before = globalThis.asked;
      globalThis.dispatchEvent(new KeyboardEvent('keydown', { key: 'Shift' }));
      atOnce = globalThis.asked > before;
    }
    return { paced, atOnce, phase: sinew.status().phase };
  }, (await example('seahorse')).replace(/^shoot$/m, ''));
  assert.equal(told.phase, 'tracing');
  // One in 100 ms, and those of the workers; at 60 Hz there would be 60, and 20 on a slow machine.
  assert.ok(told.paced >= 2 && told.paced <= 16, `${told.paced} frames in a second`);
  assert.ok(told.atOnce);
  assert.deepEqual(sinew.troubles, []);
});
