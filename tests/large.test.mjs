// A work of very many elements opens in the page, is drawn there and can be changed, like any other.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { launch, native } from './page.mjs';
import { colours, meanDeltaE } from './pictures.mjs';

/** Size of the pictures that are compared, pixels. */
const SIZE = [100, 80];
/** A mean difference (CIE76) that nobody can see. */
const UNSEEN = 0.1;

/** A hundred thousand Gaussian points, strewn in a cube. */
const COUNT = 100_000;
const MODEL = `eyep 2.2 1.6 2.6
vrp 0.5 0.5 0.5
fov 40
light White point, position 4 5 6, intensity 1
surface dust diffuse Coral, specular White, shine 30, kernel gauss
for i = 1 to ${COUNT} { sphere dust 0.006 <rand rand rand> }
`;

let browser;
before(async () => {
  browser = await launch();
});
after(async () => {
  await browser?.close();
});

test('a hundred thousand elements open, and are those that the program draws', async () => {
  const sinew = await browser.open({ size: SIZE });
  await sinew.load(MODEL);
  const status = await sinew.finished();
  assert.equal(status.errors, 0);
  assert.equal(status.failure, null);
  assert.equal(status.elements, COUNT);
  await sinew.keep('large');
  const [traced, expected] = [await sinew.image(), await native(MODEL, SIZE)];
  assert.ok(colours(traced) > 100, 'the picture is not blank');
  const difference = meanDeltaE(traced, expected);
  assert.ok(difference < UNSEEN, `ΔE ${difference}`);
  // It can be worked on.
  await sinew.load(MODEL.replace('Coral', 'SteelBlue'));
  assert.equal((await sinew.finished()).elements, COUNT);
  const blue = await sinew.image();
  assert.ok(meanDeltaE(blue, expected) > 10 * UNSEEN, 'the picture has changed');
  assert.deepEqual(sinew.troubles, []);
  await sinew.close();
});
