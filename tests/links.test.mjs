// Bad and hostile links: a clear message, a page that works, and the user's own work untouched.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { deflateRawSync, deflateSync } from 'node:zlib';
import { launch, until } from './page.mjs';

const OWN = '# my own work\nsurface s diffuse Gold\nsphere s 1 0 0 0\n';

let browser;
let sinew;
/** The link of another work. */
let theirs;
before(async () => {
  browser = await launch();
  sinew = await browser.open();
  await sinew.load('# theirs\nsurface s diffuse Red\nsphere s 1 0 0 0\n');
  theirs = await sinew.link();
  await sinew.click('editor');
  await sinew.page.keyboard.press('Control+A');
  await sinew.page.keyboard.type(OWN);
  await sinew.written((text) => text === OWN);
});
after(() => browser?.close());

/** A good link's fragment, to be broken in many ways. */
async function good() {
  const link = await sinew.link();
  return link.slice(link.indexOf('#') + 1);
}

const base64url = (bytes) => Buffer.from(bytes).toString('base64url');
const zeros = Buffer.alloc(300 << 20);
const bombs = [deflateRawSync(zeros, { level: 9 }), deflateSync(zeros, { level: 9 })];

const HOSTILE = {
  'of no sense': async () => 'nonsense%%%',
  'cut off': async () => (await good()).slice(0, -12),
  'with a wrong letter': async () => {
    const link = await good();
    return `${link.slice(0, 20)}!${link.slice(21)}`;
  },
  'of an unknown version': async () => base64url(Buffer.concat([Buffer.from([250]), deflateRawSync('x')])),
  'that unfolds to 300 MB': async () => {
    // The version byte of a good link, and then a bomb.
    const version = Buffer.from(await good(), 'base64url').subarray(0, 1);
    return base64url(Buffer.concat([version, bombs[0]]));
  },
  'that unfolds to 300 MB, with a header of zlib': async () => {
    const version = Buffer.from(await good(), 'base64url').subarray(0, 1);
    return base64url(Buffer.concat([version, bombs[1]]));
  },
  'of a megabyte': async () => 'A'.repeat(1 << 20),
  'with a script': async () => '<script>alert(1)</script><img src=x onerror=alert(1)>',
};

/** Closes the message. */
async function close() {
  const { x, y, w, h } = await sinew.place('notice');
  await sinew.page.mouse.click(x + w - 26, y + h / 2);
  await until(() => sinew.places(), ({ notice }) => !notice);
}

/** Those that are opened anew. */
const OPENED = ['cut off', 'that unfolds to 300 MB', 'with a script'];

for (const [name, fragment] of Object.entries(HOSTILE)) {
  test(`a link ${name} does no harm`, async () => {
    const hostile = await fragment();
    // Following a link in the open page …
    await sinew.page.evaluate((hash) => {
      location.hash = hash;
    }, hostile);
    await sinew.place('notice');
    assert.equal(await sinew.text(), OWN);
    await sinew.keep(`link ${name}`);
    // … and opening it anew, in the same profile: read as in the open page, so some kinds are enough.
    await close();
    if (!OPENED.includes(name)) return;
    await sinew.reload();
    await sinew.place('notice');
    assert.equal(await sinew.text(), OWN);
    const { errors } = await sinew.finished();
    assert.equal(errors, 0);
    await close();
  });
}

test('without the link the own work is there', async () => {
  await sinew.page.evaluate(() => {
    history.replaceState(null, '', location.pathname);
  });
  await sinew.reload();
  assert.equal(await sinew.text(), OWN);
});

test('a good link opens beside the own work, not in its place', async () => {
  const link = await good();
  await sinew.page.evaluate((hash) => {
    location.hash = hash;
  }, theirs.slice(theirs.indexOf('#')));
  await sinew.written((text) => text.startsWith('# theirs'));
  await sinew.page.evaluate((hash) => {
    location.hash = hash;
  }, link);
  await sinew.written((text) => text === OWN);
});

test('hostile texts do not stop the page', async () => {
  const texts = [
    'for '.repeat(50_000),
    '{'.repeat(100_000),
    'var a = ' + '('.repeat(50_000),
    'for i = 1, 1000000000 { sphere s 1 0 0 0 }',
    'surface s diffuse Red\nsphere s 1e308 1e308 1e308 1e308\nsphere s nan inf -inf 0',
    '\u0000\uffff\ud83d\ude00'.repeat(1000),
    'framesize 100000000 100000000\nsample 100000\nsurface s\nsphere s 1 0 0 0',
    'read "main.rat"',
  ];
  for (const text of texts) {
    await sinew.load(text).catch(() => {}); // too long texts are refused
    await sinew.still();
  }
  await sinew.load(OWN);
  await sinew.until((status) => status.errors === 0);
  await sinew.finished();
  assert.deepEqual(sinew.troubles, []);
});

test('whatever the pages and their scripts name is there', async () => {
  const base = new URL('.', sinew.page.url());
  const get = async (name) => {
    const response = await sinew.page.request.get(new URL(name, base).href);
    assert.equal(response.status(), 200, name);
    return response.text();
  };
  const names = new Set(['index.html', 'reference.html', 'figures.html', 'neurons.html', 'worker.js', 'tools_worker.js']);
  // The set grows while it is gone through.
  for (const name of names) {
    const text = await get(name);
    if (!/\.(html|js)$/.test(name)) continue;
    const named = text.matchAll(/(?:href|src)="([^"]+)"|from '([^']+)'|new URL\('([^']+)', import\.meta\.url\)/g);
    for (const [, link, script, file] of named) {
      const { href } = new URL(link ?? script ?? file, new URL(name, base));
      if (!href.startsWith(base.href)) continue;
      const [path, fragment] = href.slice(base.href.length).split('#');
      names.add(path || 'index.html');
      const example = /^example=([a-z0-9-]+)$/.exec(fragment ?? '')?.[1];
      if (example) names.add(`examples/${example}.rat`);
    }
  }
  for (const name of ['studio_bg.wasm', 'tracer_bg.wasm', 'tools_bg.wasm', 'figures/coral-tree.png']) {
    assert.ok(names.has(name), `${name} is among ${[...names].length} names`);
  }
});
