// The page on a phone: everything within reach of a finger.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { example, launch, until } from './page.mjs';
import { colours } from './pictures.mjs';

const VIEWPORT = { width: 390, height: 844 };

let browser;
before(async () => {
  browser = await launch();
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
    await sinew.still();
    await sinew.keep(`phone ${colorScheme}`);
    const places = await sinew.places();
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
    await offerLight(sinew, `phone ${colorScheme}`);
    assert.deepEqual(sinew.troubles, []);
    await sinew.close();
  });
}

test('a text without light is offered one, on a desk', async () => {
  const sinew = await browser.open();
  await offerLight(sinew, 'desk');
  assert.deepEqual(sinew.troubles, []);
  await sinew.close();
});

/** Opens a text without light, and takes the one that is offered. */
async function offerLight(sinew, size) {
  const text = 'surface clay diffuse Coral, specular White, shine 40, blobbiness -2\nsphere clay 1 0 0 0\n';
  await sinew.load(text);
  await sinew.finished();
  const [picture, offer] = [await sinew.place('picture'), await sinew.place('add light')];
  assert.ok(offer.x >= picture.x && offer.x + offer.w <= picture.x + picture.w, 'it lies on the picture');
  const dark = colours(await sinew.image());
  await sinew.keep(`lamp ${size} dark`);
  await sinew.click('add light');
  await sinew.written((text) => /^light White, position/m.test(text));
  const { errors } = await sinew.finished();
  assert.equal(errors, 0);
  assert.ok(colours(await sinew.image()) > 2 * dark, 'the light is seen');
  await until(() => sinew.places(), (places) => !places['add light']);
  await sinew.keep(`lamp ${size} lit`);
}
