// Skeletons that move: the strip of the film plays them, and going back and forth shows the same pictures.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { example, launch } from './page.mjs';

/** A worm that falls on a floor. */
const WORM = `framesize 64 48
eyep 0 0 8
background White
light White point, position 4 6 8
surface worm, diffuse Red, ambient Red, radius 0.5
skeleton worm, WORM { node A <-1 2 0> node B <0 2.2 0> node C <1 2 0> curve A B C }
motion { gravity 0 -10 0, floor <0 -2 0> <0 1 0> }
`;

let browser;
let sinew;
before(async () => {
  browser = await launch();
  sinew = await browser.open({ size: [64, 48] });
});
after(async () => {
  await sinew?.close();
  await browser?.close();
});

/** How high the worm is: the middle of what is red, as a share of the height from below. */
function height({ width, height, data }) {
  let [sum, count] = [0, 0];
  for (let i = 0; i < data.length; i += 4) {
    if (data[i] > data[i + 1] + 60) {
      sum += Math.floor(i / 4 / width);
      count += 1;
    }
  }
  assert.ok(count > 0, 'there is nothing red');
  return 1 - sum / count / height;
}

/** Goes to a share of the film by its slider. */
async function scrub(share) {
  const { x, y, w, h } = await sinew.place('slider frame');
  await sinew.page.mouse.click(x + 8 + (w - 16) * share, y + h / 2);
  await sinew.finished();
}

test('a skeleton falls, lies on the floor, and is back at the start', async () => {
  await sinew.load(WORM);
  await sinew.click('film length');
  await sinew.page.keyboard.type('30');
  await sinew.page.keyboard.press('Enter');
  await sinew.finished();
  const first = await sinew.image();
  await scrub(0.2);
  const falling = await sinew.image();
  await scrub(1);
  const lying = await sinew.image();
  assert.ok(height(first) > 0.7, `${height(first)}`);
  assert.ok(height(falling) < height(first) - 0.02, `${height(falling)}`);
  assert.ok(height(lying) < 0.35, `${height(lying)}`);
  await scrub(0);
  assert.deepEqual(await sinew.image(), first);
  await scrub(1);
  assert.deepEqual(await sinew.image(), lying);
  assert.deepEqual(sinew.troubles, []);
});

for (const [name, viewport] of [['desktop', undefined], ['phone', { width: 390, height: 844 }]]) {
  test(`the film of a soft creature is played: ${name}`, async () => {
    const other = viewport ? await browser.open({ viewport, size: [64, 48] }) : sinew;
    await other.load(await example('jelly'));
    await other.finished();
    await other.keep(`motion-${name}-start`);
    await other.click('play');
    // Some frames later it is on its way.
    const status = await other.until(({ frame }) => frame >= 12);
    await other.click('play');
    await other.finished();
    await other.keep(`motion-${name}-playing`);
    assert.ok(status.frame >= 12);
    assert.deepEqual(other.troubles, []);
    if (viewport) await other.close();
  });
}
