// Loading: nothing from elsewhere, and words where the program cannot run.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { chromium } from 'playwright-core';
import { launch } from './page.mjs';
import { serve } from './server.mjs';

let browser;
let server;
before(async () => {
  browser = await chromium.launch({ executablePath: process.env.CHROMIUM, args: ['--no-sandbox'] });
  server = await serve(process.env.SINEW_PAGE);
});
after(async () => {
  await browser?.close();
  server?.close();
});

test('without JavaScript the page says what it needs', async () => {
  const context = await browser.newContext({ javaScriptEnabled: false });
  const page = await context.newPage();
  await page.goto(server.address);
  assert.match(await page.innerText('body'), /needs JavaScript/);
  await context.close();
});

test('a program that does not come is reported in words', async () => {
  const page = await browser.newPage();
  await page.route('**/studio_bg.wasm', (route) => route.fulfill({ status: 404, body: 'gone' }));
  await page.goto(server.address);
  await page.waitForSelector('#loading.failed');
  assert.match(await page.innerText('#message'), /could not start/);
  await page.close();
});

for (const [file, words] of [
  ['tracer_bg.wasm', /tracer could not be loaded/i],
  ['worker.js', /no worker could be kept running/i],
]) {
  test(`without ${file} the page says so, and the editor works`, async () => {
    const own = await launch('webgl2');
    try {
      const sinew = await own.open({ before: (page) => page.route(`**/${file}`, (route) => route.abort()) });
      const status = await sinew.until((status) => status.failure);
      assert.match(status.failure, words);
      await sinew.load('surface s diffuse Gold\nsphere s 1 0 0 0\n');
      await sinew.until((status) => status.errors === 0 && status.failure);
      await sinew.keep(`without ${file}`);
      // Once it comes, all is well.
      await sinew.page.unroute(`**/${file}`);
      await sinew.page.evaluate(() => sinew.render());
      const { failure } = await sinew.finished();
      assert.equal(failure, null);
      await sinew.close();
    } finally {
      await own.close();
    }
  });
}

test('a graphics card that is only pretended does not draw the window', async () => {
  const own = await launch('webgl2', { free: true });
  try {
    const sinew = await own.open();
    const { backend, failure } = await sinew.finished();
    assert.deepEqual([backend, failure], ['none', null]);
    await sinew.close();
  } finally {
    await own.close();
  }
});

test('everything comes from the page’s own folder', async () => {
  const page = await browser.newPage();
  const strangers = [];
  page.on('request', (request) => {
    const url = request.url();
    if (!url.startsWith(server.address) && !/^(data|blob):/.test(url)) strangers.push(url);
  });
  await page.goto(server.address);
  await page.waitForFunction(() => globalThis.sinew?.ready);
  await page.evaluate(() => sinew.ready);
  await page.waitForTimeout(1000);
  assert.deepEqual(strangers, []);
  await page.close();
});
