// The page without a net: after the first visit all of it works, and a newer release says so.
import assert from 'node:assert/strict';
import { cp, mkdtemp, readFile, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { launch } from './page.mjs';
import { serve } from './server.mjs';

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser?.close());

/** Waits until the page's files are kept in the browser. */
const kept = ({ page }) => page.evaluate(() => navigator.serviceWorker.ready.then(() => caches.has('sinew')));

/** A sign of the style sheet that is in use. */
const sign = ({ page }) => page.evaluate(() => getComputedStyle(document.body).getPropertyValue('--sign'));

test('after the first visit everything works without a net', async () => {
  const sinew = await browser.open({ serviceWorkers: 'allow' });
  assert.ok(await kept(sinew));
  await sinew.page.context().setOffline(true);
  await sinew.reload();
  await sinew.load('surface s diffuse Gold\nsphere s 1 0 0 0\n');
  assert.equal((await sinew.finished()).phase, 'done');
  // What comes only when it is asked for: the workers for meshes and tools, examples, the manual.
  const closed = await sinew.page.evaluate(async () => (await sinew.mesh({ format: 'stl' })).length > 0);
  assert.ok(closed);
  await sinew.click('sculpt');
  await sinew.click('begin ball');
  await sinew.place('sculpture');
  const manual = await sinew.page.context().newPage();
  await manual.goto(new URL('reference.html', sinew.page.url()).href);
  assert.match(await manual.title(), /Sinew/);
  const broken = await manual.evaluate(async () => {
    const pictures = [...document.images];
    for (const picture of pictures) picture.loading = 'eager';
    await Promise.allSettled(pictures.map((picture) => picture.decode()));
    return [pictures.length, pictures.filter(({ naturalWidth }) => !naturalWidth).map(({ src }) => src)];
  });
  assert.ok(broken[0] > 10);
  assert.deepEqual(broken[1], []);
  assert.deepEqual(sinew.troubles, []);
  await sinew.close();
});

test('a newer release is offered, and taken when the visitor wants it', async () => {
  const folder = await mkdtemp(join(tmpdir(), 'sinew-page-'));
  await cp(process.env.SINEW_PAGE, folder, { recursive: true });
  const other = await serve(folder);
  const sinew = await browser.open({ serviceWorkers: 'allow', address: other.address });
  await kept(sinew);
  const second = await sinew.beside();
  const before = await sinew.text();

  // The next release has another style sheet.
  const [style, worker] = ['style.css', 'offline.js'].map((name) => join(folder, name));
  await writeFile(style, `${await readFile(style, 'utf8')}\nbody { --sign: newer; }\n`);
  const list = await readFile(worker, 'utf8');
  await writeFile(worker, list.replace(/"style\.css": "[0-9a-f]{8}"/, '"style.css": "00000000"'));
  await sinew.page.evaluate(() => navigator.serviceWorker.getRegistration().then((registration) => registration.update()));
  const notice = sinew.page.locator('#renew');
  await notice.getByText('A newer Sinew is here.').waitFor();
  await sinew.keep('newer');
  assert.equal(await sign(sinew), '', 'not before it is wanted');
  await notice.getByText('Later').click();
  assert.equal(await notice.count(), 0);
  await sinew.reload();
  assert.equal(await sign(sinew), '', 'nor by a reload');
  await notice.getByText('A newer Sinew is here.').waitFor();
  await Promise.all([sinew.page.waitForEvent('load'), notice.getByText('Reload').click()]);
  await sinew.ready();
  assert.equal(await sign(sinew), 'newer');
  assert.equal(await sinew.text(), before);
  await second.page.getByText('Sinew was renewed in another tab.').waitFor();

  // What did not change was not fetched again, and nothing of the old release is left.
  const stale = await sinew.page.evaluate(async () => {
    const files = await (await caches.open('sinew')).keys();
    return files.filter(({ url }) => url.includes('style.css')).map(({ url }) => new URL(url).search);
  });
  assert.deepEqual(stale, ['?00000000']);

  // A page of `cargo xtask serve`, which lists no files, removes it all.
  await writeFile(worker, await readFile(new URL('../www/offline.js', import.meta.url)));
  await sinew.page.evaluate(() => navigator.serviceWorker.getRegistration().then((registration) => registration.update()));
  await sinew.page.waitForFunction(async () => !(await caches.has('sinew')) && !(await navigator.serviceWorker.getRegistration()));
  other.close();
  await sinew.close();
  await rm(folder, { recursive: true });
});
