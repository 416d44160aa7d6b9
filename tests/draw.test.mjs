// Not run by `cargo xtask test` yet: it takes more than three minutes on two cores.
// An animal with four legs, a head and a tail, drawn by mouse and by finger, as someone would who has read nothing.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { example, launch } from './page.mjs';

let browser;
before(async () => {
  browser = await launch('webgl2');
});
after(() => browser?.close());

const DESKTOP = { viewport: { width: 1200, height: 760 } };
const PHONE = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true };

for (const [size, options] of [['desktop', DESKTOP], ['phone', PHONE]]) {
  test(`an animal is drawn, ${size}`, async () => {
    const sinew = await browser.open(options);
    const touch = size === 'phone';
    const hand = await Hand.on(sinew, touch);
    let shot = 0;
    const keep = () => sinew.keep(`draw ${size} ${String(++shot).padStart(2, '0')}`);
    await sinew.until(({ phase }) => phase !== 'idle');
    await keep();
    await hand.press('draw');
    await sinew.until(({ drawing }) => drawing === 'draw');
    await sinew.page.waitForTimeout(1500);
    await keep();
    const settle = async () => {
      await sinew.page.waitForTimeout(400);
      await keep();
    };
    // Body, neck, head.
    await hand.stroke([0.34, 0.46], [0.5, 0.43], [0.65, 0.45]);
    await settle();
    await hand.stroke([0.65, 0.45], [0.7, 0.4], [0.73, 0.31]);
    await settle();
    await hand.stroke([0.73, 0.31], [0.76, 0.31], [0.81, 0.335]);
    await settle();
    // Legs in pairs.
    await hand.stroke([0.62, 0.5], [0.63, 0.62], [0.615, 0.76]);
    await settle();
    await hand.stroke([0.38, 0.5], [0.35, 0.6], [0.375, 0.76]);
    await settle();
    // Tail, ears, eyes.
    await hand.stroke([0.34, 0.46], [0.27, 0.42], [0.23, 0.3], [0.19, 0.24]);
    await settle();
    await hand.stroke([0.735, 0.29], [0.725, 0.25], [0.72, 0.21]);
    await settle();
    await hand.tap([0.772, 0.3]);
    await settle();
    const text = await sinew.text();
    // A body that goes on to the head and the tail; two pairs of legs, a pair of ears, two eyes.
    assert.equal(text.match(/^ *curve /gm)?.length, 7, text);
    assert.equal(text.match(/^sphere /gm)?.length, 2, text);
    assert.equal((await sinew.status()).errors, 0);
    assert.ok(hand.gestures <= 30);
    await sinew.finished();
    await keep();
    assert.deepEqual(sinew.troubles, []);
    await sinew.close();
  });
}

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
  const sinew = await browser.open({ ...DESKTOP, before: clock });
  const hand = await Hand.on(sinew, false);
  const { mouse } = sinew.page;
  const median = (times) => [...times].sort((a, b) => a - b)[Math.floor(times.length / 2)];
  /** Moves the pointer so often, a frame each, and gives the frames' median. */
  const move = async ([x, y], count) => {
    await sinew.page.evaluate(() => (window.frames_ = []));
    for (let i = 1; i <= count; i++) {
      await mouse.move(x + 30 * Math.sin(i / 4), y - 20 * Math.sin(i / 3));
      await sinew.page.evaluate(() => new Promise((done) => requestAnimationFrame(done)));
    }
    return median(await sinew.page.evaluate(() => window.frames_.filter((time) => time > 0.3)));
  };
  await sinew.load('');
  await hand.press('draw');
  await sinew.until(({ drawing }) => drawing === 'draw');
  const empty = await move(await hand.at([0.5, 0.5]), 30);
  await sinew.load(await example('snail'));
  await hand.press('tool move');
  const { x, y, w, h } = await sinew.place('node HEAD/1');
  const { revision } = await sinew.status();
  await mouse.move(x + w / 2, y + h / 2);
  await mouse.down();
  const held = await move([x + w / 2, y + h / 2], 30);
  await mouse.up();
  const { revision: after } = await sinew.status();
  assert.ok(after >= revision + 10, 'the text follows the hand');
  console.log(`a frame while a node is dragged: ${held.toFixed(1)} ms, on the empty page ${empty.toFixed(1)} ms`);
  await sinew.keep('draw snail');
  assert.deepEqual(sinew.troubles, []);
  await sinew.close();
});
