// The page and the program draw the same pictures, to the last bit, with any number of workers and threads.
import assert from 'node:assert/strict';
import { readFileSync, readdirSync } from 'node:fs';
import { after, before, test } from 'node:test';
import { example, filesOf, launch, native } from './page.mjs';
import { colours, decode, shareThatDiffers } from './pictures.mjs';
import { readFile } from 'node:fs/promises';

/** Width of the pictures; heights follow the frames of the datasets. */
const WIDTH = 160;
/** Widths of those that take long: folds that press each other flat are traced one ray at a time. */
const NARROW = { coils: 64 };

const folder = new URL('../www/examples/', import.meta.url);
const names = readdirSync(folder)
  .filter((name) => name.endsWith('.rat'))
  .map((name) => name.slice(0, -4))
  // Those with meshes or strokes of their own are no texts alone.
  .filter((name) => !/^\s*mesh\s+\S+\s+\S+\.(obj|strokes)/m.test(readFileSync(new URL(`${name}.rat`, folder), 'utf8')));

let browser;
let sinew;
before(async () => {
  browser = await launch('webgl2');
  sinew = await browser.open();
});
after(() => browser?.close());

test('there are examples, also with files', async () => {
  assert.ok(names.length >= 6, names.join());
  assert.deepEqual(Object.keys(await filesOf(await example('heads'))), ['head.obj']);
});

for (const name of names) {
  test(`${name} is the same in the page and from the program`, async () => {
    const text = await example(name);
    const files = await filesOf(text);
    // The thumbnail has the proportions of the frame.
    const thumbnail = decode(await readFile(new URL(`${name}.png`, folder)));
    assert.ok(colours(thumbnail) > 50, 'the thumbnail shows something');
    const width = NARROW[name] ?? WIDTH;
    const size = [width, Math.round((width * thumbnail.height) / thumbnail.width)];
    await sinew.load(text);
    if (Object.keys(files).length) await sinew.take(files);
    await sinew.resize(...size);
    assert.equal((await sinew.status()).errors, 0);
    const page = await sinew.image();
    assert.ok(colours(page) > 50, 'the picture shows something');
    for (const threads of ['1', '2']) {
      const program = await native(text, size, ['--threads', threads], files);
      assert.equal(shareThatDiffers(page, program, 0), 0, `the share of pixels that differ, ${threads} threads`);
    }
  });
}
