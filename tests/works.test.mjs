// The user's works: one tab writes each, nothing is lost, and what was is found again.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { launch, until } from './page.mjs';

const OWN = '# my own work\nsurface s diffuse Gold\nsphere s 1 0 0 0\n';

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser?.close());

/** Types at the end of the text, and waits until it is kept. */
async function type(sinew, text) {
  await sinew.click('editor');
  await sinew.page.keyboard.press('Control+End');
  await sinew.page.keyboard.type(text);
  await sinew.written((now) => now.endsWith(text));
  await sinew.until(({ saved }) => saved);
}

/** A tab with a work of the user's. */
async function own(options) {
  const sinew = await browser.open(options);
  await sinew.load(OWN);
  await type(sinew, '# mine');
  return sinew;
}

test('one tab writes a work; another one makes a copy or takes it over, and each reload opens its own', async () => {
  const first = await own();
  const { name } = await first.status();
  const second = await first.beside();
  await second.until(({ theirs }) => theirs);
  await second.place('take over');
  await second.keep('two tabs');
  assert.equal((await first.status()).theirs, false);
  // What is changed there becomes a copy.
  await type(second, ' and yours');
  const copy = await second.until(({ theirs }) => !theirs);
  assert.equal(copy.name, `${name} copy`);
  assert.ok((await first.text()).endsWith('# mine'));
  await first.reload();
  assert.ok((await first.text()).endsWith('# mine'));
  await second.reload();
  assert.ok((await second.text()).endsWith('# mine and yours'));
  for (const sinew of [first, second]) {
    await sinew.page.waitForTimeout(800);
    assert.equal((await sinew.status()).theirs, false, 'each has its own');
  }

  // The last work that was opened is the first one a new tab opens.
  const third = await second.beside();
  assert.equal((await third.until(({ theirs }) => theirs)).name, copy.name);
  await second.click('editor');
  await second.page.keyboard.press('Control+End');
  await second.page.keyboard.type(', at once');
  await second.written((text) => text.endsWith('at once'));
  await third.click('take over');
  await third.until(({ theirs }) => !theirs);
  assert.ok((await third.text()).endsWith('at once'), 'with what was typed there just before');
  await second.until(({ theirs }) => theirs);
  await type(third, ', here');
  await second.click('make a copy');
  const again = await second.until(({ theirs }) => !theirs);
  assert.equal(again.name, `${copy.name} copy`);
  for (const sinew of [first, second, third]) assert.deepEqual(sinew.troubles, []);
  await first.close();
});


test('a busy page does not take its own work for that of another tab', async () => {
  const sinew = await own();
  const tab = await sinew.page.context().newPage();
  await tab.goto(new URL('icon.svg', sinew.page.url()).href);
  const told = await tab.evaluate(async (keeper) => {
    const { claim, listen } = await import(keeper);
    const told = [];
    listen((kind, about) => told.push(`${kind} ${about}`));
    const pause = (milliseconds) => new Promise((done) => setTimeout(done, milliseconds));
    claim('own');
    const end = performance.now() + 1500;
    while (performance.now() < end);
    await pause(1000);
    // The program starts anew.
    claim('own');
    await pause(1000);
    return told;
  }, new URL('keep.js', sinew.page.url()).href);
  assert.deepEqual(told, ['mine own', 'mine own']);
  await sinew.close();
});

test('a tab that does not answer is not waited for', async () => {
  const deaf = () => {
    BroadcastChannel.prototype.addEventListener = () => {};
  };
  const first = await own({ before: (page) => page.addInitScript(deaf) });
  const second = await first.beside();
  await second.until(({ theirs }) => theirs);
  await second.click('take over');
  await second.until(({ theirs }) => !theirs);
  await first.until(({ theirs }) => theirs);
  await first.close();
});

test('where the browser has no locks, a second writer is told of its copy', async () => {
  const before = (page) => page.addInitScript(() => Object.defineProperty(Navigator.prototype, 'locks', { get: () => undefined }));
  const first = await own({ before });
  const second = await first.beside(before);
  await type(second, ' too');
  await type(first, ' first');
  const status = await first.until(({ name }) => name.endsWith(' copy'));
  await first.place('notice');
  assert.equal(status.theirs, false);
  assert.ok((await second.text()).endsWith('# mine too'));
  assert.ok((await first.text()).endsWith('# mine first'));
  await first.close();
});

test('undo steps, versions and files of any size are there again', async () => {
  const sinew = await own();
  const mesh = Buffer.concat([
    Buffer.from('v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n'),
    Buffer.alloc(6 << 20, '#\n'),
  ]);
  await sinew.take({ 'large.obj': mesh });
  await sinew.until(({ saved }) => saved);
  // All of it is deleted, and kept so.
  await sinew.reload();
  await sinew.click('editor');
  await sinew.page.keyboard.press('Control+A');
  await sinew.page.keyboard.press('Delete');
  await sinew.written((text) => text === '');
  await type(sinew, `# ${'other '.repeat(60)}`);
  await sinew.reload();
  assert.deepEqual((await sinew.status()).assets, ['large.obj']);
  const large = await sinew.page.evaluate(() => Object.entries(localStorage).filter(([, value]) => value.length > 20_000));
  assert.deepEqual(large, [], 'what is large is elsewhere');
  await sinew.click('work');
  await sinew.keep('work menu');
  await sinew.click('work versions…');
  await sinew.place('version 0');
  await sinew.keep('versions');
  const { x, y, w, h } = await sinew.place('version 0');
  await sinew.page.mouse.click(x + w / 2, y + h / 2);
  await sinew.written((text) => text === OWN);
  await sinew.click('undo');
  await sinew.written((text) => text.startsWith('# other'));
  await sinew.click('undo');
  await sinew.written((text) => text !== OWN && !text.startsWith('# other'));
  assert.deepEqual(sinew.troubles, []);
  await sinew.close();
});

test('works that were kept before are found', async () => {
  const file = (text) => ({ files: [{ name: 'main.rat', text }] });
  const before = async (page) => {
    const history = { past: [file('# before\n')], future: [] };
    const kept = { project: file(OWN), camera: null, history };
    const record = `a.1\n${JSON.stringify({ version: 1, name: 'Old', saved: 1, kept })}`;
    const image = 'iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg==';
    const assets = JSON.stringify([{ name: 'dot.png', bytes: image }]);
    await page.addInitScript(
      ([record, assets]) => {
        // Only once, and not with each reload.
        if (sessionStorage.getItem('given')) return;
        sessionStorage.setItem('given', 'yes');
        localStorage.setItem('sinew/document/x', record);
        localStorage.setItem('sinew/assets/x', assets);
        localStorage.setItem('sinew/current', 'x');
      },
      [record, assets],
    );
  };
  const sinew = await browser.open({ before });
  for (let round = 0; round < 2; round++) {
    assert.equal(await sinew.text(), OWN);
    const { name, assets } = await sinew.status();
    assert.deepEqual([name, assets], ['Old', ['dot.png']]);
    assert.equal(await sinew.page.evaluate(() => localStorage.getItem('sinew/assets/x')), null);
    await sinew.click('undo');
    await sinew.written((text) => text === '# before\n');
    await sinew.page.keyboard.press('Control+Y');
    await sinew.written((text) => text === OWN);
    await sinew.until(({ saved }) => saved);
    await sinew.reload();
  }
  assert.deepEqual(sinew.troubles, []);
  await sinew.close();
});

/** Fills what local storage has room for. */
const fill = () => {
  for (let size = 1 << 20; size > 0; size >>= 1) {
    try {
      for (let i = 0; ; i++) localStorage.setItem(`junk${size}.${i}`, 'x'.repeat(size));
    } catch {
      // It is full.
    }
  }
};

test('a full storage loses nothing', async () => {
  const sinew = await own();
  await sinew.page.evaluate(fill);
  await type(sinew, ` and ${'more '.repeat(50)}`);
  await sinew.reload();
  assert.ok((await sinew.text()).endsWith('more '));
  assert.equal((await sinew.places()).notice, undefined);
  assert.deepEqual(sinew.troubles, []);
  await sinew.close();
});

test('a refused storage is said', async () => {
  const before = (page) =>
    page.addInitScript(() => {
      indexedDB.open = () => {
        throw new Error('not here');
      };
    });
  const sinew = await own({ before });
  await sinew.page.evaluate(fill);
  await sinew.click('editor');
  await sinew.page.keyboard.press('Control+End');
  await sinew.page.keyboard.type(` and ${'more '.repeat(50)}`);
  await sinew.written((text) => text.endsWith('more '));
  await sinew.place('notice');
  await sinew.keep('refused');
  assert.equal((await sinew.status()).saved, false);
  await sinew.page.evaluate(() => localStorage.clear());
  await type(sinew, '.');
  await sinew.reload();
  assert.ok((await sinew.text()).endsWith('more .'), 'it is kept as soon as there is room');
  await sinew.close();
});

test('own work comes first, and the search has the focus', async () => {
  const sinew = await own();
  await sinew.click('work');
  await sinew.click('work my work…');
  await sinew.place('search examples');
  await sinew.keep('my work');
  const places = await sinew.places();
  assert.ok(places['my work'].y < places['examples heading'].y);
  await sinew.page.keyboard.type('zzz');
  await until(() => sinew.places(), (places) => !places['my work']);
  await sinew.page.keyboard.press('Escape');
  await until(() => sinew.places(), ({ dialog }) => !dialog);
  await sinew.close();
});

test('a word is found, replaced, and a line gone to', async () => {
  const sinew = await own();
  const { keyboard } = sinew.page;
  await sinew.click('editor');
  await keyboard.press('Control+Home');
  await keyboard.press('Control+f');
  await sinew.place('find');
  await keyboard.type('gold');
  await keyboard.press('Enter');
  await sinew.still();
  await sinew.keep('find');
  await keyboard.press('Escape');
  await until(() => sinew.places(), ({ find }) => !find);
  await keyboard.type('Tan');
  await sinew.written((text) => text.includes('diffuse Tan'));
  await keyboard.press('Control+h');
  await sinew.place('replace with');
  await keyboard.press('Control+A');
  await keyboard.type('s');
  await sinew.click('replace with');
  await keyboard.type('clay');
  await sinew.click('replace all');
  await sinew.written((text) => /clayphere clay 1/.test(text));
  await sinew.click('undo');
  await sinew.written((text) => text.includes('sphere s 1'));
  await keyboard.press('Control+g');
  await sinew.place('find field');
  await keyboard.type('3');
  await keyboard.press('Enter');
  await until(() => sinew.places(), ({ find }) => !find);
  await keyboard.type('# here ');
  await sinew.written((text) => text.split('\n')[2].startsWith('# here sphere'));
  assert.deepEqual(sinew.troubles, []);
  await sinew.close();
});
