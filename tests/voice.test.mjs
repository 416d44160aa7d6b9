// The page for those who do not see it: each control is an element with name, role, state and place, and the way through the
// page needs no pointer.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { after, before, test } from 'node:test';
import { launch, until } from './page.mjs';

const TEXT = 'light White point, position 4 3 5\nsurface s diffuse Gold\nvar r = 1 hot\nsphere s r, 0 0 0\n';

let browser;
let sinew;
before(async () => {
  browser = await launch();
  sinew = await browser.open();
  await sinew.load(TEXT);
  await sinew.finished();
  await sinew.still();
});
after(() => browser?.close());

/** What axe finds that is serious. Colours are not looked at, as the elements have none. */
async function audit(what) {
  const axe = await readFile(new URL('./node_modules/axe-core/axe.min.js', import.meta.url), 'utf8');
  const found = await sinew.page.evaluate(`(async () => {
    const module = { exports: {} };
    ${axe};
    const { violations } = await (globalThis.axe ?? module.exports).run(document, { rules: { 'color-contrast': { enabled: false } } });
    return violations.map(({ id, impact, nodes }) => ({ id, impact, html: nodes.slice(0, 3).map((node) => node.html) }));
  })()`);
  const serious = found.filter(({ impact }) => impact === 'serious' || impact === 'critical');
  assert.deepEqual(serious, [], what);
}

const button = (name) => sinew.page.locator(`#voice button[aria-label^="${name}"]`);

test('controls are elements at their places, and axe finds nothing serious', async () => {
  await button('Share').waitFor({ state: 'attached' });
  const share = await sinew.place('share');
  const box = await button('Share').boundingBox();
  assert.ok(Math.abs(box.x - share.x) < 2 && Math.abs(box.width - share.w) < 2, JSON.stringify([box, share]));
  const text = sinew.page.locator('#voice textarea').first();
  await until(() => text.inputValue(), (value) => value === TEXT);
  assert.equal(await sinew.page.locator('#voice input[type=range][aria-label="r"]').count(), 1);
  await audit('the page');
  await button('Examples').evaluate((element) => element.click());
  await button('Open Cowrie').waitFor({ state: 'attached' });
  await audit('the gallery');
  await button('Close').first().evaluate((element) => element.click());
  await until(() => sinew.places(), ({ dialog }) => !dialog);
});

test('what is done with an element is done in the page', async () => {
  const range = sinew.page.locator('#voice input[type=range][aria-label="r"]');
  await range.evaluate((element) => {
    element.value = '0.5';
    element.dispatchEvent(new Event('input', { bubbles: true }));
  });
  await sinew.written((text) => /var r = 0\.5\d* hot/.test(text));
  // The text is written as in any field; a mistake is said.
  const text = sinew.page.locator('#voice textarea').first();
  await text.evaluate((element, value) => {
    element.focus();
    element.value = value;
    element.dispatchEvent(new Event('input', { bubbles: true }));
  }, `${TEXT}sphree s 1\n`);
  await sinew.written((now) => now.endsWith('sphree s 1\n'));
  const said = () => sinew.page.locator('#voice [aria-live]').allTextContents();
  await until(said, (said) => said.some((words) => /sphree/.test(words)));
  await text.evaluate((element, value) => {
    element.value = value;
    element.dispatchEvent(new Event('input', { bubbles: true }));
  }, TEXT);
  await sinew.written((now) => now === TEXT);
  await until(said, (said) => said.some((words) => /^Done/.test(words)));
  assert.deepEqual(sinew.troubles, []);
});

test('a journey by keyboard alone', async () => {
  const { keyboard } = sinew.page;
  await sinew.page.locator('#canvas').focus();
  const focused = () => sinew.page.evaluate(() => {
    const id = document.querySelector('#canvas').getAttribute('aria-activedescendant');
    return id && document.getElementById(id)?.getAttribute('aria-label');
  });
  const tabTo = async (name) => {
    for (let i = 0; i < 60; i++) {
      await keyboard.press('Tab');
      await sinew.still();
      if ((await focused())?.startsWith(name)) return;
    }
    assert.fail(`Tab does not lead to ${name}`);
  };
  await keyboard.press('Escape');
  await tabTo('Examples');
  await sinew.keep('focus');
  await keyboard.press('Enter');
  await sinew.place('search examples');
  await keyboard.type('t-shape');
  await tabTo('Open T-shape');
  await sinew.keep('card with focus');
  await keyboard.press('Enter');
  await sinew.written((text) => text.includes('object TEE'));
  assert.deepEqual(sinew.troubles, []);
});
