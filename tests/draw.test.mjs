// An animal with four legs, a head and a tail, drawn by finger and by mouse, as someone would who has read nothing.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { Hand } from './hand.mjs';
import { launch } from './page.mjs';

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser?.close());

const DESKTOP = { viewport: { width: 1200, height: 760 } };
const PHONE = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true };

/** Opens the page and takes the pencil in hand. */
async function open(options, touch) {
  const sinew = await browser.open(options);
  const hand = await Hand.on(sinew, touch);
  await hand.press('draw');
  await sinew.until(({ drawing }) => drawing === 'draw');
  return { sinew, hand };
}

/** The curves of the drawn skeleton, each as the places of its nodes. */
async function curves(sinew) {
  const text = await sinew.text();
  const nodes = new Map();
  for (const [, name, place] of text.matchAll(/^ *node (\w+) <([^>]*)>/gm)) nodes.set(name, place.split(' ').map(Number));
  return [...text.matchAll(/^ *curve (.*)$/gm)].map(([, names]) => names.trim().split(' ').map((name) => nodes.get(name)));
}

/** Whether a curve lies in the mirror. */
const isFlat = (curve) => curve.every(([x]) => x === 0);

test('an animal is drawn on a phone in eight strokes and a tap', async () => {
  const { sinew, hand } = await open(PHONE, true);
  await sinew.keep('draw phone page');
  await hand.stroke([0.3, 0.5], [0.5, 0.47], [0.68, 0.5]);
  await hand.stroke([0.68, 0.48], [0.74, 0.42], [0.77, 0.36]);
  await hand.stroke([0.77, 0.36], [0.81, 0.36], [0.87, 0.37]);
  // Legs, beside the body's ends.
  await hand.stroke([0.64, 0.52], [0.65, 0.6], [0.64, 0.67]);
  await hand.stroke([0.33, 0.52], [0.32, 0.6], [0.33, 0.67]);
  await sinew.keep('draw phone legs');
  // The tail from the end that the hind legs hang on, ears, eyes.
  await hand.stroke([0.3, 0.5], [0.22, 0.47], [0.15, 0.4]);
  await hand.stroke([0.775, 0.35], [0.76, 0.32], [0.75, 0.3]);
  await hand.tap([0.82, 0.355]);
  const all = await curves(sinew);
  const text = await sinew.text();
  const pairs = all.filter((curve) => !isFlat(curve));
  assert.ok(pairs.length === 6 || pairs.length === 4, text);
  assert.ok(all.filter(isFlat).length >= 2, text);
  // Each of a pair has the other one on the other side.
  for (const curve of pairs) {
    const mirrored = JSON.stringify(curve.map(([x, y, z]) => [-x || 0, y, z]));
    assert.ok(pairs.some((other) => JSON.stringify(other) === mirrored), text);
  }
  const feet = pairs.filter((curve) => curve.at(-1)[1] < Math.min(...all[0].map(([, y]) => y)) - 0.5);
  assert.equal(feet.length, 4, text);
  assert.equal(text.match(/^sphere /gm)?.length, 2, text);
  // It stands: the ground is under its lowest foot.
  const ground = Number(text.match(/^ground .* height (.*)$/m)[1]);
  const lowest = Math.min(...feet.map((curve) => curve.at(-1)[1]));
  assert.ok(lowest > ground && lowest < ground + 0.3, text);
  assert.ok(hand.gestures <= 30);
  const status = await sinew.finished();
  assert.equal(status.errors, 0);
  await sinew.keep('draw phone done');
  assert.deepEqual(sinew.troubles, []);
  await sinew.close();
});

test('strokes of a mouse are paired, made single, moved, cut and taken back', async () => {
  const { sinew, hand } = await open(DESKTOP, false);
  await hand.stroke([0.34, 0.46], [0.65, 0.45]);
  await hand.stroke([0.5, 0.42], [0.5, 0.25]);
  assert.equal((await curves(sinew)).length, 3);
  const pair = await sinew.text();
  await sinew.keep('draw desktop pair');
  /** Presses a widget and waits until the text is another one. */
  const press = async (name) => {
    const { revision } = await sinew.status();
    await hand.press(name);
    await sinew.until((status) => status.revision > revision);
  };
  await press('draw other');
  const single = await curves(sinew);
  assert.equal(single.length, 2);
  assert.ok(single.every(isFlat), await sinew.text());
  await press('draw other');
  assert.equal(await sinew.text(), pair);
  // A node follows the hand, in one step.
  await hand.press('tool move');
  await sinew.until(({ drawing }) => drawing === 'move');
  const { x, y, w, h } = await sinew.place('node n1');
  await hand.along([[x + w / 2, y + h / 2], [x, y + 20], [x - 20, y + 40]]);
  await sinew.until(({ fresh }) => fresh);
  assert.notEqual(await sinew.text(), pair);
  await press('undo');
  assert.equal(await sinew.text(), pair);
  await hand.press('tool cut');
  await sinew.until(({ drawing }) => drawing === 'cut');
  const before = await curves(sinew);
  await hand.stroke([0.4, 0.34], [0.6, 0.34]);
  const length = (all) => all.flat().reduce((sum, [, y]) => Math.max(sum, y), -9);
  assert.ok(length(await curves(sinew)) < length(before) - 0.1, await sinew.text());
  assert.equal((await sinew.status()).errors, 0);
  await sinew.keep('draw desktop cut');
  assert.deepEqual(sinew.troubles, []);
  await sinew.close();
});

test("a pen's pressure makes a stroke thick", async () => {
  const { sinew, hand } = await open(DESKTOP, false);
  const { page } = sinew;
  const stroke = async (height, pressures) => {
    const { revision } = await sinew.status();
    const places = await hand.at(...pressures.map((_, i) => [0.25 + (0.5 * i) / (pressures.length - 1), height]));
    await page.mouse.move(...places[0]);
    await sinew.still();
    await sinew.pen('pointermove', places[0], 0);
    await sinew.pen('pointerdown', places[0], pressures[0]);
    // Each is seen in a frame of its own.
    for (const [i, place] of places.entries()) {
      await sinew.still();
      await sinew.pen('pointermove', place, pressures[i]);
    }
    await sinew.still();
    await sinew.pen('pointerup', places.at(-1), 0);
    await sinew.until((status) => status.revision > revision);
  };
  const radii = (text) => [...text.matchAll(/^ *node \w+ <[^>]*> radius ([\d.]+)/gm)].map(([, radius]) => Number(radius));
  await stroke(0.4, [0.1, 0.2, 0.35, 0.5, 0.7, 0.85, 1]);
  const pressed = radii(await sinew.text());
  assert.ok(pressed.length >= 2, await sinew.text());
  assert.ok(pressed.at(-1) > 1.7 * pressed[0], `thin where it begins, thick where it ends: ${pressed}`);
  assert.ok(pressed.every((radius, i) => i === 0 || radius > 0.95 * pressed[i - 1]), `${pressed}`);
  await sinew.finished();
  await sinew.keep('draw pen');
  assert.equal((await sinew.status()).errors, 0);
  assert.deepEqual(sinew.troubles, []);
  await sinew.close();
});
