// Two bodies in one work: traced, drafted, picked, sliced and shared.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { PATIENCE, launch, native } from './page.mjs';
import { countNear, meanDeltaE, shareThatDiffers, shrink } from './pictures.mjs';

const SIZE = [240, 180];
/** Two balls that overlap. The eye is at 0 0 8, looking at 0 0 0, 45 degrees wide. */
const balls = ([before, between, after]) => `framesize 240 180
eyep 0 0 8
background White
light White point, position 4 3 9
surface Left diffuse Tomato, ambient Gray30, blobbiness -2
surface Right diffuse SteelBlue, ambient Gray30, blobbiness -2
${before}sphere Left 1.1, -0.9 0 0
${between}sphere Right 1.1, 0.9 0 0
${after}`;
const BODIES = balls(['body LEFT\n', 'close\nbody RIGHT\n', 'close\n']);
const BLENDED = balls(['', '', '']);

let browser;
let sinew;
before(async () => {
  browser = await launch('webgl2');
  sinew = await browser.open();
});
after(() => browser?.close());

async function show(text) {
  await sinew.load(text);
  await sinew.finished();
  assert.deepEqual((await sinew.status()).diagnostics, []);
}

/** How many pixels of the middle third of the middle row are neither red nor blue: where one colour goes over into the other. */
function between({ data, width, height }) {
  let count = 0;
  for (let x = Math.round(width / 3); x < (2 * width) / 3; x++) {
    const at = 4 * (x + width * Math.floor(height / 2));
    if (Math.abs(data[at] - data[at + 2]) < 40) count += 1;
  }
  return count;
}

/** What is seen of the picture on the page, as large as the traced one. */
const seen = async () => shrink(await sinew.screen('picture'), ...SIZE);

test('bodies are traced without blending, as by the program', async () => {
  await show(BODIES);
  await sinew.resize(...SIZE);
  const apart = await sinew.image();
  assert.equal(shareThatDiffers(apart, await native(BODIES, SIZE), 0), 0);
  await show(BLENDED);
  const together = await sinew.image();
  assert.ok(shareThatDiffers(apart, together, 8) > 0.02, 'blending shows');
  const counts = [apart, together].map(between);
  // Where bodies meet only the shade is neither.
  assert.ok(3 * counts[0] < counts[1], `${counts} pixels between the colours`);
});

test('the draft shows the same two bodies', async () => {
  await show(BODIES);
  await sinew.page.evaluate(() => sinew.debug.pictureSize());
  await sinew.finished();
  await sinew.click('show traced');
  await sinew.page.mouse.move(5, 5);
  await sinew.page.waitForTimeout(600);
  const traced = await seen();
  await sinew.keep('bodies traced');
  await sinew.click('show draft');
  await sinew.page.mouse.move(5, 5);
  await sinew.page.waitForTimeout(600);
  const draft = await seen();
  await sinew.keep('bodies draft');
  await sinew.click('show auto');
  const difference = meanDeltaE(traced, draft);
  assert.ok(difference < 6, `ΔE ${difference}`);
  assert.ok(shareThatDiffers(traced, draft, 2) > 0, 'the draft is another picture');
  // Both balls are there.
  for (const picture of [traced, draft]) {
    const [red, blue] = [[255, 99, 71], [70, 130, 180]].map((colour) => countNear(picture, colour, 90));
    assert.ok(red > 1000 && blue > 1000, `${red} red pixels, ${blue} blue ones`);
  }
});

test('a click picks the element of the body that is seen', async () => {
  await show(BODIES);
  const half = 8 * Math.tan(Math.PI / 8);
  const centre = () => sinew.page.evaluate(() => {
    const hand = Object.entries(sinew.debug.rects()).find(([name]) => /^hand .*centre/.test(name));
    return hand ? hand[1].x + hand[1].w / 2 : null;
  });
  for (const x of [-1.1, 1.1, 0.15, -0.15]) {
    const picture = await sinew.place('picture');
    const middle = picture.x + picture.w / 2;
    await sinew.page.mouse.click(middle + (picture.w * x) / 2 / half, picture.y + picture.h / 2);
    // The knob of the chosen ball stands at its centre.
    await sinew.page.waitForFunction(
      () => Object.keys(sinew.debug.rects()).some((name) => /^hand .*centre/.test(name)),
      undefined,
      { timeout: 30_000 },
    );
    assert.equal(Math.sign((await centre()) - middle), Math.sign(x), `at ${x}`);
    if (x === 0.15) await sinew.keep('bodies picked');
    await sinew.page.keyboard.press('Escape');
    await sinew.page.waitForFunction(() => !Object.keys(sinew.debug.rects()).some((name) => name.startsWith('hand ')));
  }
});

/** The state of the lab when its slice is finished. */
async function sliced() {
  await sinew.page.evaluate(() => {
    location.hash = '#lab=slice';
  });
  await sinew.page.waitForFunction(() => sinew.lab()?.readings.finished === 1, undefined, { timeout: PATIENCE });
  const { x, y, w, h } = await sinew.place('lab figure');
  await sinew.page.mouse.move(x + w / 2, y + h / 2);
  await sinew.page.waitForFunction(() => sinew.lab().readings.value !== undefined);
  const { readings } = await sinew.page.evaluate(() => sinew.lab());
  return readings;
}

test('a slice shows the larger of two fields, not their sum', async () => {
  await show(BLENDED);
  const together = await sliced();
  await sinew.keep('bodies blended sliced');
  await sinew.click('lab back');
  await show(BODIES);
  const apart = await sliced();
  await sinew.keep('bodies sliced');
  await sinew.click('lab back');
  assert.deepEqual([together.primitives, apart.primitives], [2, 2]);
  const ratio = together.value / apart.value;
  assert.ok(Math.abs(ratio - 2) < 0.1, `${together.value} and ${apart.value} in the middle`);
});

test('a link carries the bodies', async () => {
  await show(BODIES);
  await sinew.resize(...SIZE);
  const picture = await sinew.image();
  const link = await sinew.link();
  const other = await browser.open({ fragment: link.slice(link.indexOf('#')) });
  assert.equal(await other.text(), BODIES);
  await other.resize(...SIZE);
  assert.equal(shareThatDiffers(await other.image(), picture, 0), 0);
  assert.deepEqual(other.troubles, []);
  await other.close();
  assert.deepEqual(sinew.troubles, []);
});
