// Each example opens in the page, and the page shows the pictures that the program draws, to the last bit, with any number of threads.
// That all of them are drawn alike natively and as wasm is tested with the worker.
import assert from 'node:assert/strict';
import { readFile, readdir } from 'node:fs/promises';
import { after, before, test } from 'node:test';
import { example, filesOf, launch, native } from './page.mjs';
import { colours, decode, shareThatDiffers } from './pictures.mjs';

const folder = new URL('../www/examples/', import.meta.url);

let browser;
let sinew;
before(async () => {
  browser = await launch();
  sinew = await browser.open({ size: [8, 6] });
});
after(() => browser?.close());

/** Opens an example by its link, and gives its text once the worker has drawn it. */
async function open(name) {
  const text = await example(name);
  await sinew.page.evaluate((name) => {
    location.hash = `#example=${name}`;
  }, name);
  await sinew.written((now) => now === text);
  await sinew.until(({ fresh, errors }) => fresh || errors);
  const { diagnostics, errors, failure } = await sinew.status();
  assert.deepEqual([errors, failure], [0, null], `${name}: ${JSON.stringify(diagnostics)}`);
  return text;
}

test('each example opens, with its files and a thumbnail', async () => {
  const names = (await readdir(folder)).filter((name) => name.endsWith('.rat')).map((name) => name.slice(0, -4));
  assert.ok(names.length >= 50, names.join());
  for (const name of names) {
    await open(name);
    const thumbnail = await sinew.page.request.get(new URL(`examples/${name}.png`, sinew.page.url()).href);
    assert.ok(colours(decode(await thumbnail.body())) > 50, `${name}: the thumbnail shows something`);
  }
});

// Without and with files, and one with flesh in contact.
for (const name of ['cowrie', 'heads', 'touching']) {
  test(`${name} is the same in the page and from the program`, async () => {
    const text = await open(name);
    const files = await filesOf(text);
    assert.equal(Object.keys(files).length, name === 'heads' ? 1 : 0);
    const thumbnail = decode(await readFile(new URL(`${name}.png`, folder)));
    // The thumbnail has the proportions of the frame.
    const size = [120, Math.round((120 * thumbnail.height) / thumbnail.width)];
    await sinew.resize(...size);
    const page = await sinew.image();
    assert.ok(colours(page) > 50, 'the picture shows something');
    for (const threads of ['1', '2']) {
      const program = await native(text, size, ['--threads', threads], files);
      assert.equal(shareThatDiffers(page, program, 0), 0, `the share of pixels that differ, ${threads} threads`);
    }
  });
}

test('nothing went wrong unseen', () => {
  assert.deepEqual(sinew.troubles, []);
});
