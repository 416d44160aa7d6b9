// While a node of the snail is dragged the page's own work in a frame stays near that of the empty page.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { Hand } from './hand.mjs';
import { example, launch } from './page.mjs';

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser?.close());

/** Moves of the pointer, a frame each. */
const MOVES = 16;

/** Has the page note how long each of its frames takes, milliseconds of its own thread. */
const clock = (page) =>
  page.addInitScript(() => {
    const ask = window.requestAnimationFrame.bind(window);
    window.frames_ = [];
    window.requestAnimationFrame = (draw) =>
      ask((time) => {
        const begun = performance.now();
        draw(time);
        window.frames_.push(performance.now() - begun);
      });
  });

test('a node of the snail is dragged, and the flesh follows', async () => {
  const sinew = await browser.open({ before: clock, size: [48, 48] });
  const hand = await Hand.on(sinew, false);
  const { mouse } = sinew.page;
  /** Moves the pointer about a place of the screen; gives the quickest and the median frame. */
  const move = async ([x, y]) => {
    await sinew.page.evaluate(() => (window.frames_ = []));
    for (let i = 1; i <= MOVES; i++) {
      await mouse.move(x + 30 * Math.sin(i / 4), y - 20 * Math.sin(i / 3));
      await sinew.page.evaluate(() => new Promise((done) => requestAnimationFrame(done)));
    }
    // Frames in which nothing is drawn take no time.
    const times = await sinew.page.evaluate(() => window.frames_.filter((time) => time > 0.3));
    times.sort((a, b) => a - b);
    return { least: times[0], median: times[times.length >> 1] };
  };
  await sinew.load('');
  await hand.press('draw');
  await sinew.until(({ drawing }) => drawing === 'draw');
  await sinew.finished();
  const empty = await move((await hand.at([0.5, 0.5]))[0]);
  await sinew.load(await example('snail'));
  await hand.press('tool move');
  await sinew.until(({ drawing, fresh }) => drawing === 'move' && fresh);
  const { x, y, w, h } = await sinew.place('node HEAD/1');
  const { revision } = await sinew.status();
  await mouse.move(x + w / 2, y + h / 2);
  await mouse.down();
  const held = await move([x + w / 2, y + h / 2]);
  await mouse.up();
  const status = await sinew.until((status) => status.revision >= revision + MOVES / 2);
  assert.equal(status.errors, 0);
  const said = ({ least, median }) => `${least.toFixed(1)} ms at least, ${median.toFixed(1)} ms in the middle`;
  console.log(`a frame while a node is dragged: ${said(held)}; on the empty page: ${said(empty)}`);
  // A third of a second on a machine that does ten other things is no 33 ms on a quiet one, but a scene that is traced
  // or meshed within the frame takes longer than that anywhere.
  assert.ok(held.least < 330, said(held));
  await sinew.keep('drag snail');
  assert.deepEqual(sinew.troubles, []);
  await sinew.close();
});
