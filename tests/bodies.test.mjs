// Two bodies in one work: traced, picked, sliced and shared.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { launch, native, until } from './page.mjs';
import { shareThatDiffers } from './pictures.mjs';

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
  browser = await launch();
  sinew = await browser.open({ size: SIZE });
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

test('bodies are traced without blending, as by the program', async () => {
  await show(BODIES);
  const apart = await sinew.image();
  assert.equal(shareThatDiffers(apart, await native(BODIES, SIZE), 0), 0);
  await show(BLENDED);
  const together = await sinew.image();
  assert.ok(shareThatDiffers(apart, together, 8) > 0.02, 'blending shows');
  const counts = [apart, together].map(between);
  // Where bodies meet only the shade is neither.
  assert.ok(3 * counts[0] < counts[1], `${counts} pixels between the colours`);
});

test('a click picks the element of the body that is seen', async () => {
  await show(BODIES);
  const half = 8 * Math.tan(Math.PI / 8);
  for (const x of [-1.1, 1.1, 0.15, -0.15]) {
    const picture = await sinew.place('picture');
    const middle = picture.x + picture.w / 2;
    await sinew.page.mouse.click(middle + (picture.w * x) / 2 / half, picture.y + picture.h / 2);
    // The knob of the chosen ball stands at its centre.
    const knob = await sinew.place('hand the centre');
    assert.equal(Math.sign(knob.x + knob.w / 2 - middle), Math.sign(x), `at ${x}`);
    if (x === 0.15) await sinew.keep('bodies picked');
    await sinew.page.keyboard.press('Escape');
    await until(() => sinew.places(), (places) => !places['hand the centre']);
  }
});

/** The state of the lab when its slice is finished. */
async function sliced() {
  await sinew.page.evaluate(() => {
    location.hash = '#lab=slice';
  });
  const lab = () => sinew.page.evaluate(() => sinew.lab());
  await until(lab, (state) => state?.readings.finished === 1);
  const { x, y, w, h } = await sinew.place('lab figure');
  await sinew.page.mouse.move(x + w / 2, y + h / 2);
  const { readings } = await until(lab, (state) => state.readings.value !== undefined);
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
  const picture = await sinew.image();
  const link = await sinew.link();
  const other = await browser.open({ size: SIZE, fragment: link.slice(link.indexOf('#')) });
  assert.equal(await other.text(), BODIES);
  await other.finished();
  assert.equal(shareThatDiffers(await other.image(), picture, 0), 0);
  assert.deepEqual(other.troubles, []);
  await other.close();
  assert.deepEqual(sinew.troubles, []);
});
