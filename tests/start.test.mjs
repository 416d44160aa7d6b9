// Loading: nothing from elsewhere, and words where the program cannot run.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { launch } from './page.mjs';

/** The page itself chooses what it draws with. */
let own;
before(async () => {
  own = await launch('webgl2', { free: true });
});
after(() => own?.close());

test('without JavaScript the page says what it needs', async () => {
  const page = await own.blank({ javaScriptEnabled: false });
  await page.goto(own.address);
  assert.match(await page.innerText('body'), /needs JavaScript/);
  await page.context().close();
});

test('a program that does not come is reported in words', async () => {
  const page = await own.blank();
  await page.route('**/studio_bg.wasm', (route) => route.fulfill({ status: 404, body: 'gone' }));
  await page.goto(own.address);
  await page.waitForSelector('#loading.failed');
  assert.match(await page.innerText('#message'), /could not start/);
  await page.context().close();
});

for (const [file, words] of [
  ['tracer_bg.wasm', /tracer could not be loaded/i],
  ['worker.js', /no worker could be kept running/i],
]) {
  test(`without ${file} the page says so, and the editor works`, async () => {
    const sinew = await own.open({ before: (page) => page.route(`**/${file}`, (route) => route.abort()) });
    const status = await sinew.until((status) => status.failure);
    assert.match(status.failure, words);
    await sinew.load('surface s diffuse Gold\nsphere s 1 0 0 0\n');
    await sinew.until((status) => status.errors === 0 && status.failure);
    await sinew.keep(`without ${file}`);
    // Once it comes, all is well: also for who asks while the last fetch is still failing.
    await sinew.page.unroute(`**/${file}`);
    let fail;
    const failing = new Promise((resolve) => { fail = resolve; });
    const started = new Promise((resolve) => {
      sinew.page.route(`**/${file}`, async (route) => {
        resolve();
        await failing;
        await route.abort();
      }, { times: 1 });
    });
    await sinew.page.evaluate(() => sinew.render());
    await started;
    await sinew.page.evaluate(() => sinew.render());
    fail();
    const { failure } = await sinew.finished();
    assert.equal(failure, null);
    await sinew.close();
  });
}

test('without digger_bg.wasm the page says so, and draws all that does not ask for it', async () => {
  const file = 'digger_bg.wasm';
  const fetched = [];
  const before = (page) => {
    page.on('request', (request) => fetched.push(request.url()));
    return page.route(`**/${file}`, (route) => route.abort());
  };
  const sinew = await own.open({ before });
  const text = 'surface s diffuse Gold, blobbiness -2\nsphere s 1 0 0 0\n';
  await sinew.load(text);
  assert.equal((await sinew.finished()).failure, null);
  const asked = () => fetched.some((url) => url.endsWith(file));
  assert.ok(!asked());
  await sinew.load(`digger brent\n${text}`);
  const { failure } = await sinew.until((status) => status.failure);
  assert.match(failure, /root finders for comparison .* could not be loaded/i);
  assert.ok(asked());
  await sinew.load(text);
  assert.equal((await sinew.finished()).failure, null);
  // Once it comes, all is well.
  await sinew.page.unroute(`**/${file}`);
  await sinew.load(`digger brent\n${text}`);
  assert.equal((await sinew.finished()).failure, null);
  await sinew.close();
});

test('a graphics card that is only pretended does not draw the window, and all comes from the page’s own folder', async () => {
  const strangers = [];
  const watch = (page) => page.on('request', (request) => {
    const url = request.url();
    if (!url.startsWith(own.address) && !/^(data|blob):/.test(url)) strangers.push(url);
  });
  const sinew = await own.open({ before: watch });
  const { backend, failure } = await sinew.finished();
  assert.deepEqual([backend, failure], ['none', null]);
  assert.deepEqual(strangers, []);
  await sinew.close();
});
