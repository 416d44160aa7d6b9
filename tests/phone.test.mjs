// The page on a phone: everything within reach of a finger.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { example, launch } from './page.mjs';
import { colours } from './pictures.mjs';

const VIEWPORT = { width: 390, height: 844 };

let browser;
before(async () => {
  browser = await launch('webgl2');
});
after(() => browser?.close());

for (const colorScheme of ['dark', 'light']) {
  test(`the page fits a phone, ${colorScheme}`, async () => {
    const sinew = await browser.open({
      viewport: VIEWPORT,
      colorScheme,
      hasTouch: true,
      // At one pixel a point: an emulated factor does not reach the size that the canvas is told.
      isMobile: true,
    });
    await sinew.finished();
    await sinew.keep(`phone ${colorScheme}`);
    const places = await sinew.page.evaluate(() => sinew.debug.rects());
    for (const name of ['share', 'examples', 'picture', 'status']) {
      const place = places[name];
      assert.ok(place, `${name} is there`);
      assert.ok(
        place.x >= 0 && place.y >= 0 && place.x + place.w <= VIEWPORT.width + 1 && place.y + place.h <= VIEWPORT.height + 1,
        `${name} is on the screen: ${JSON.stringify(place)}`,
      );
    }
    assert.ok(places.examples.x + places.examples.w <= places.share.x, 'buttons stand side by side');
    assert.ok(colours(await sinew.screen('picture')) > 100, 'the picture is seen');
    const overflow = await sinew.page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    assert.ok(overflow <= 0, 'nothing sticks out');
    assert.equal(await sinew.text(), await example('tide'));
    assert.deepEqual(sinew.troubles, []);
    await sinew.close();
  });
}
