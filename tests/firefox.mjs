// The page in Firefox: the same pictures as the program's, to the last bit. Asked for by `cargo xtask test firefox`.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import puppeteer from 'puppeteer-core';
import { Sinew, example, native } from './page.mjs';
import { colours, shareThatDiffers } from './pictures.mjs';
import { serve } from './server.mjs';

const SIZE = [160, 120];

/** A tab of puppeteer with the methods of playwright's that `Sinew` calls. */
function adapt(page) {
  return {
    on: (event, listener) => page.on(event, listener),
    goto: (address) => page.goto(address),
    reload: () => page.reload(),
    evaluate: (script, argument) => page.evaluate(script, argument),
    waitForFunction: (script, argument, options) => page.waitForFunction(script, options, argument),
    waitForTimeout: (milliseconds) => new Promise((done) => { setTimeout(done, milliseconds); }),
    screenshot: (options) => page.screenshot(options),
    mouse: page.mouse,
    keyboard: page.keyboard,
    context: () => page.browserContext(),
  };
}

let browser;
let server;
let sinew;
before(async () => {
  server = await serve(process.env.SINEW_PAGE);
  browser = await puppeteer.launch({
    browser: 'firefox',
    executablePath: process.env.FIREFOX,
    headless: true,
    defaultViewport: { width: 1200, height: 760 },
  });
  sinew = new Sinew(adapt(await browser.newPage()), 'firefox');
  await sinew.goto(server.address);
});
after(async () => {
  await browser?.close();
  server?.close();
});

test('it is Firefox', async () => {
  assert.match(await browser.version(), /firefox/i);
});

for (const name of ['cowrie', 'seahorse', 'glass-drops', 'touching']) {
  test(`${name} is the same in Firefox and from the program`, async () => {
    const text = await example(name);
    await sinew.load(text);
    await sinew.resize(...SIZE);
    assert.equal((await sinew.status()).errors, 0);
    const page = await sinew.image();
    assert.ok(colours(page) > 50, 'the picture shows something');
    assert.equal(shareThatDiffers(page, await native(text, SIZE), 0), 0, 'the share of pixels that differ');
  });
}

test('a link opens the same text', async () => {
  const text = 'surface s diffuse Gold, blob -2\nsphere s 1 0 0 0\n';
  await sinew.load(text);
  const link = await sinew.link();
  const other = new Sinew(adapt(await browser.newPage()), 'firefox');
  await other.goto(server.address + link.slice(link.indexOf('#')));
  assert.equal(await other.text(), text);
  await other.finished();
});

test('a large mesh is read by the tools worker', async () => {
  // A wavy sheet of 20,000 triangles.
  const lines = [];
  const rows = 101;
  for (let i = 0; i < rows; i += 1) {
    for (let j = 0; j < rows; j += 1) lines.push(`v ${i / 50 - 1} ${0.1 * Math.sin(i / 6)} ${j / 50 - 1}`);
  }
  for (let i = 0; i + 1 < rows; i += 1) {
    for (let j = 1; j < rows; j += 1) {
      const corner = i * rows + j;
      lines.push(`f ${corner} ${corner + 1} ${corner + rows + 1}`, `f ${corner} ${corner + rows + 1} ${corner + rows}`);
    }
  }
  await sinew.page.evaluate((mesh) => sinew.take({
    'main.rat': 'light White point, position 0 4 3\neyep 0 2 4\nsurface s diffuse Gold\nmesh s sheet.obj\n',
    'sheet.obj': mesh,
  }), lines.join('\n'));
  const status = await sinew.until(({ fresh, phase, elements }) => fresh && phase === 'done' && elements === 20_000);
  assert.equal(status.errors, 0);
  assert.ok(colours(await sinew.image()) > 50, 'the sheet is seen');
});

test('nothing went wrong unseen', async () => {
  await sinew.keep('firefox');
  assert.deepEqual(sinew.troubles, []);
});
