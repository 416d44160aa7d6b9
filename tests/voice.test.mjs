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
  await button('How it works').evaluate((element) => element.click());
  await button('Your first shape').waitFor({ state: 'attached' });
  await audit('the help');
  await button('Close').first().evaluate((element) => element.click());
  await until(() => sinew.places(), ({ dialog }) => !dialog);
  await sinew.page.setViewportSize({ width: 390, height: 844 });
  await sinew.still();
  await audit('the page on a phone');
  await sinew.page.setViewportSize({ width: 1200, height: 760 });
  await sinew.still();
});

test('axe finds nothing serious in the pages beside it', async () => {
  const axe = await readFile(new URL('./node_modules/axe-core/axe.min.js', import.meta.url), 'utf8');
  for (const colorScheme of ['dark', 'light']) {
    const page = await browser.blank({ colorScheme });
    for (const name of ['reference', 'figures', 'neurons', 'lattices', 'metaballs']) {
      await page.goto(new URL(`${name}.html`, browser.address).href);
      await page.evaluate(axe);
      const found = await page.evaluate(async () => {
        const { violations } = await globalThis.axe.run(document);
        return violations.map(({ id, impact, nodes }) => ({ id, impact, html: nodes.slice(0, 3).map((node) => node.html.slice(0, 200)) }));
      });
      const serious = found.filter(({ impact }) => impact === 'serious' || impact === 'critical');
      assert.deepEqual(serious, [], `${name}, ${colorScheme}`);
    }
    await page.close();
  }
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
  // A mistake is written and heard, and then taken back.
  await tabTo('Text of the model');
  const before = await sinew.text();
  await keyboard.press('Control+End');
  await keyboard.press('Enter');
  await keyboard.type('sphree s 1');
  await sinew.written((text) => text.includes('sphree'));
  const said = () => sinew.page.locator('#voice [aria-live]').allTextContents();
  await until(said, (said) => said.some((words) => /sphree/.test(words)));
  await keyboard.press('Home');
  await keyboard.press('Shift+End');
  await keyboard.press('Delete');
  await keyboard.press('Backspace');
  await sinew.written((text) => text === before);
  await sinew.finished();
  // Tab indents in the text; Escape leaves it, and Tab goes on from there.
  await keyboard.press('Escape');
  await tabTo('Download');
  await keyboard.press('Enter');
  await tabTo('Picture\n');
  const coming = sinew.page.waitForEvent('download', { timeout: 60_000 });
  await keyboard.press('Enter');
  assert.match((await coming).suggestedFilename(), /\.png$/);
  assert.deepEqual(sinew.troubles, []);
});

test('more contrast is painted where it is asked for, and nothing moves where that is', async () => {
  const ask = async (options) => {
    const asked = await browser.open({ viewport: { width: 720, height: 500 }, before: (tab) => tab.emulateMedia(options) });
    await asked.load(TEXT);
    await asked.finished();
    await asked.still();
    const screen = await asked.screen('status');
    await asked.close();
    return screen;
  };
  const weak = await ask({ colorScheme: 'dark', contrast: 'no-preference' });
  const sharp = await ask({ colorScheme: 'dark', contrast: 'more' });
  const forced = await ask({ colorScheme: 'dark', forcedColors: 'active' });
  const calm = await ask({ colorScheme: 'dark', contrast: 'no-preference', reducedMotion: 'reduce' });
  // The brightest and the mean tell the palette.
  const sum = ({ data }) => data.reduce((sum, value) => sum + value, 0);
  assert.ok(sum(sharp) > 1.005 * sum(weak), `${sum(sharp)} ${sum(weak)}`);
  assert.ok(sum(forced) > 1.005 * sum(weak), `${sum(forced)} ${sum(weak)}`);
  assert.ok(Math.abs(sum(calm) - sum(weak)) < 0.003 * sum(weak));
});
