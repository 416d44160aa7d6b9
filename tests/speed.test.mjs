// How long a person waits for the picture after a keystroke, by the page's own clock, with one worker
// and with two, in turn. What is asserted holds on any machine; with SINEW_FIGURES set the figures are
// written to that file as JSON (`cargo xtask bench browser`).
import assert from 'node:assert/strict';
import { writeFile } from 'node:fs/promises';
import { after, before, test } from 'node:test';
import { example, launch } from './page.mjs';

/** The kind of browser: with a GPU interface, as nearly all have, but drawn by software here, which the page may notice. */
const KIND = 'webgl2';
/** Whether it is measured. Else the least is done that shows that it works. */
const MEASURES = Boolean(process.env.SINEW_FIGURES);
const SIZE = MEASURES ? [512, 512] : [64, 64];
const MODELS = MEASURES ? ['seahorse', 'cowrie'] : ['cowrie'];
const WORKERS = MEASURES ? [1, 2] : [2];
/** Keystrokes of which the quickest counts: the browser compiles hot code anew during the first ones. */
const ROUNDS = MEASURES ? 25 : 1;

let browser;
before(async () => {
  browser = await launch(KIND, { free: true });
});
after(() => browser?.close());

/** A page that believes the machine to have so many cores. */
function open(cores) {
  const pretend = (cores) =>
    Object.defineProperty(Navigator.prototype, 'hardwareConcurrency', { get: () => cores });
  return browser.open({ size: SIZE, before: (page) => page.addInitScript(pretend, cores) });
}

/** Puts the caret at the text's end, and types a digit. */
async function reachEditor(sinew) {
  const { revision } = await sinew.status();
  await sinew.click('editor');
  await sinew.page.keyboard.press('Control+End');
  await sinew.page.keyboard.press('1');
  await sinew.until((status) => status.revision > revision);
  await sinew.finished();
}

/** Types a key and gives the milliseconds until each pass is on the screen. */
async function keystroke(sinew, key) {
  const times = sinew.page.evaluate(() => {
    const { revision } = sinew.status();
    return new Promise((resolve, reject) => {
      const asked = performance.now();
      let pressed = Infinity;
      const press = () => {
        pressed = performance.now();
      };
      addEventListener('keydown', press, { capture: true, once: true });
      const times = {};
      let begun = false;
      const look = () => {
        const status = sinew.status();
        const since = performance.now() - pressed;
        if (performance.now() - asked > 120_000) {
          reject(new Error(`no picture: ${JSON.stringify(status)}`));
          return;
        }
        // The old picture counts as finished until the new text is compiled.
        begun ||= status.revision > revision && status.phase !== 'done';
        if (begun && status.fresh) {
          times.coarse ??= since;
          if (status.pass === 'smooth' || status.phase === 'done') times.full ??= since;
          if (status.phase === 'done') {
            times.smooth = since;
            times.compile = 1000 * status.timings.compile;
            times.tracing = 1000 * status.timings.done;
            resolve(times);
            return;
          }
        }
        // Not with each frame: the page has none while nothing is to be drawn. Looking takes the processor's time, too.
        setTimeout(look, times.coarse === undefined ? 4 : 25);
      };
      look();
    });
  });
  // The page must be looking before the key comes.
  await sinew.page.evaluate(() => new Promise((done) => setTimeout(done)));
  await sinew.page.keyboard.press(key);
  return times;
}

const figures = [];
/** What the page draws its window with. */
let backend;
for (const name of MODELS) {
  test(`${name}: from a keystroke to the picture`, async () => {
    const pages = [];
    for (const workers of WORKERS) {
      const sinew = await open(workers);
      // Digits behind it change the picture a little.
      const text = (await example(name)).replace(/^shoot$/m, '');
      await sinew.load(`${text}\ngamma 1.0`);
      const status = await sinew.finished();
      assert.equal(status.workers, workers);
      backend = status.backend;
      await reachEditor(sinew);
      pages.push({ sinew, best: { workers } });
    }
    // In turn: a machine may be half as quick a minute later.
    for (let round = 0; round < ROUNDS; round++) {
      for (const { sinew, best } of pages) {
        await sinew.page.bringToFront();
        const times = await keystroke(sinew, round % 2 === 0 ? '1' : 'Backspace');
        assert.ok(times.tracing <= times.smooth, JSON.stringify(times));
        for (const [key, time] of Object.entries(times)) {
          best[key] = Math.min(best[key] ?? Infinity, time);
        }
      }
    }
    const runs = [];
    for (const { sinew, best } of pages) {
      const image = await sinew.image();
      assert.deepEqual([image.width, image.height], SIZE);
      assert.deepEqual(sinew.troubles, []);
      await sinew.close();
      runs.push(best);
    }
    console.log(`${name}: ${JSON.stringify(runs)}`);
    figures.push({ name, runs });
  });
}

test('the figures are kept', async (t) => {
  if (!MEASURES) return t.skip('SINEW_FIGURES is not set');
  assert.equal(figures.length, MODELS.length);
  const version = await browser.version();
  const kept = { browser: `Chromium ${version}, ${KIND} by software, window drawn by: ${backend}`, rounds: ROUNDS, models: figures };
  await writeFile(process.env.SINEW_FIGURES, JSON.stringify(kept, null, 1));
});
