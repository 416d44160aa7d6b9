// The way of a newcomer: the first shape in five steps, from the reference into the page, at all sizes; what examples that take
// long show meanwhile; presets of sliders.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { launch, until } from './page.mjs';

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser?.close());

const SIZES = [[1440, 900], [720, 450], [390, 844], [320, 568]];

for (const colorScheme of ['dark', 'light']) {
  test(`the reference leads to the first shape, which stands at all sizes, ${colorScheme}`, async () => {
    const tab = await browser.blank({ colorScheme });
    await tab.goto(new URL('reference.html', browser.address).href);
    const first = await tab.locator('h2').first().textContent();
    assert.equal(first, 'Your first shape');
    const [lead] = await tab.locator('a[href="./#first"]').all();
    assert.equal(new URL(await lead.getAttribute('href'), tab.url()).href, new URL('#first', browser.address).href);
    await tab.close();
    const sinew = await browser.open({ colorScheme, fragment: '#first', viewport: { width: 1440, height: 900 } });
    await sinew.place('first shape');
    const write = async () => {
      const before = await sinew.text();
      await sinew.page.locator('#voice button[aria-label="Write it"]').evaluate((element) => element.click());
      await sinew.written((text) => text.length > before.length);
      const next = sinew.page.locator('#voice button[aria-label="Next"]');
      await next.evaluate((element) => element.click());
      await sinew.still();
    };
    await sinew.still();
    for (const [index, [width, height]] of SIZES.entries()) {
      await sinew.page.setViewportSize({ width, height });
      await sinew.still();
      const { 'first shape': card, editor } = await sinew.places();
      assert.ok(card.x >= 0 && card.x + card.w <= width && card.y + card.h <= editor.y + 1, JSON.stringify([card, editor]));
      assert.ok(editor.h > 60, `${width}×${height}: ${editor.h}`);
      await sinew.keep(`first shape ${index + 1} ${width}x${height} ${colorScheme}`);
      await write();
    }
    await sinew.page.setViewportSize({ width: 1440, height: 900 });
    await sinew.finished();
    await sinew.keep(`first shape done ${colorScheme}`);
    assert.match(await sinew.text(), /for i = 0 to 3/);
    assert.deepEqual(sinew.troubles, []);
    await sinew.close();
  });
}

test('an example that takes long shows what was made before, at once, until its own picture is there', async () => {
  for (const [width, height] of [[1440, 900], [390, 844]]) {
    const sinew = await browser.open({ size: null, fragment: '#example=still-life', viewport: { width, height } });
    await until(() => sinew.status(), ({ standIn }) => standIn === 'made before');
    await sinew.keep(`made before ${width}x${height}`);
    const { pass, phase } = await sinew.until(({ standIn, picture }) => !standIn && picture);
    assert.ok(pass === 'smooth' || phase === 'done', `${pass} ${phase}`);
    assert.deepEqual(sinew.troubles, []);
    await sinew.close();
  }
});

test('presets stand above their sliders', async () => {
  const text = `light White point, position 4 3 5
surface s diffuse Gold
var r = 1 hot 0 2
var C = 0 0 0 hot
preset small, set r 0.4, set C 0 1 0
preset large, set r 1.6, set C 0 0 0
sphere s r, C
`;
  for (const [width, height] of SIZES) {
    const sinew = await browser.open({ viewport: { width, height } });
    await sinew.load(text);
    await sinew.finished();
    if (width < 800) await sinew.click('tab sliders');
    await sinew.click('preset small');
    await sinew.written((text) => text.includes('var r = 0.4 hot 0 2\nvar C = 0 1 0 hot'));
    await sinew.finished();
    await sinew.keep(`presets ${width}x${height}`);
    assert.deepEqual(sinew.troubles, []);
    await sinew.close();
  }
});
