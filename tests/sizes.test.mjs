// The page in windows of any size: everything within reach, the picture with its half, and nothing that moves by itself.
import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { example, launch, until } from './page.mjs';
import { meanDeltaE, shareThatDiffers } from './pictures.mjs';

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser?.close());

/** Widgets that are there at each size, if they are at all, and stand side by side. */
const WIDGETS = ['work', 'examples', 'lab', 'sculpt', 'undo', 'more', 'share', 'download', 'picture', 'editor', 'status', 'problems',
  'sliders', 'tab text', 'tab sliders', 'tab problems'];

/** Checks that nothing is cut or lies over something else, and that the picture has its half. */
async function check(sinew, width, height) {
  await sinew.still();
  const places = await sinew.places();
  const there = WIDGETS.filter((name) => places[name]);
  for (const name of there) {
    const { x, y, w, h } = places[name];
    assert.ok(x >= -1 && y >= -1 && x + w <= width + 1 && y + h <= height + 1, `${name} is cut: ${JSON.stringify(places[name])}`);
    for (const other of there) {
      if (other === name) continue;
      const o = places[other];
      const across = Math.min(x + w, o.x + o.w) - Math.max(x, o.x);
      const down = Math.min(y + h, o.y + o.h) - Math.max(y, o.y);
      assert.ok(across < 1 || down < 1, `${name} lies over ${other}: ${JSON.stringify([places[name], o])}`);
    }
  }
  const { w, h } = places.picture;
  const [halfWidth, halfHeight] = [0.5 * width - 20, 0.5 * (height - 100)];
  assert.ok(
    width > height ? w >= 0.9 * halfWidth || h >= 1.4 * halfHeight : w >= 0.9 * width || h >= 0.9 * halfHeight,
    `the picture has its half: ${w} × ${h} of ${width} × ${height}`,
  );
  return places;
}

const SIZES = [[1440, 900], [800, 600], [720, 450], [600, 400], [390, 844], [320, 568]];

for (const colorScheme of ['dark', 'light']) {
  test(`the page is usable at all sizes, ${colorScheme}`, async () => {
    const sinew = await browser.open({ colorScheme, size: null, viewport: { width: 1440, height: 900 } });
    await sinew.load((await example('tshape')) + '\nvar a = 1 hot\n');
    for (const [width, height] of SIZES) {
      await sinew.page.setViewportSize({ width, height });
      await sinew.finished();
      await check(sinew, width, height);
      await sinew.keep(`size ${width}x${height} ${colorScheme}`);
      const { 'tab sliders': sliders, 'tab problems': problems } = await sinew.places();
      if (!sliders) continue;
      for (const tab of ['tab sliders', 'tab problems', 'tab text']) {
        await sinew.click(tab);
        await check(sinew, width, height);
      }
    }
    assert.deepEqual(sinew.troubles, []);
    await sinew.close();
  });
}

test('a menu that is higher than the window is reached to its end, and sliders keep to their place', async () => {
  const sinew = await browser.open({ viewport: { width: 390, height: 844 } });
  await sinew.load('light White point, position 4 3 5\nsurface s diffuse Gold\nvar C = 0 0 0 hot\nvar a_rather_long_name = 1 hot\nsphere s a_rather_long_name, C\n');
  await sinew.finished();
  for (const [width, height] of [[720, 450], [320, 568]]) {
    await sinew.page.setViewportSize({ width, height });
    await sinew.click('more');
    const { x, y, w, h } = await sinew.place('work draw');
    await sinew.page.mouse.move(x + w / 2, y + h / 2);
    await sinew.page.mouse.wheel(0, 2000);
    await sinew.still();
    await sinew.keep(`menu ${width}x${height}`);
    const { 'download project': last, more } = await sinew.places();
    assert.ok(last.y >= more.y + more.h - 1 && last.y + last.h <= height, `${width}×${height}: ${JSON.stringify([last, more])}`);
    await sinew.page.keyboard.press('Escape');
    await sinew.click('tab sliders');
    await sinew.still();
    await sinew.keep(`pad ${width}x${height}`);
    const { 'pad C': pad, 'slider C z': rail, sliders } = await sinew.places();
    assert.ok(pad.x + pad.w <= rail.x && rail.x + rail.w + 40 <= sliders.x + sliders.w + 1, JSON.stringify([pad, rail, sliders]));
    await sinew.click('tab text');
  }
  assert.deepEqual(sinew.troubles, []);
  await sinew.close();
});

test('a low window shows as many rows of the menu as fit', async () => {
  for (const [width, height] of [[720, 450], [320, 568]]) {
    const sinew = await browser.open({ viewport: { width, height } });
    await sinew.click('more');
    await sinew.still();
    await sinew.keep(`menu opened ${width}x${height}`);
    const { x, y } = await sinew.place('work new');
    const screen = await sinew.screen();
    // The menu's ground, left of its rows.
    const ground = (row) => screen.data.slice(4 * (row * screen.width + Math.round(x) - 3)).slice(0, 3).join();
    assert.equal(ground(height - 60), ground(Math.round(y)), `${width}×${height}`);
    await sinew.close();
  }
});

test('the pencil’s tools stand side by side', async () => {
  for (const [width, height] of [[1440, 900], [720, 450], [390, 844], [320, 568]]) {
    const sinew = await browser.open({ viewport: { width, height } });
    await sinew.click('draw');
    await sinew.until(({ drawing }) => drawing === 'draw');
    await sinew.still();
    await sinew.keep(`draw ${width}x${height}`);
    const places = await sinew.places();
    const names = ['tool draw', 'tool move', 'tool cut', 'draw mirror', 'draw colour', 'draw thickness', 'draw done'];
    const tools = names.map((name) => places[name]);
    for (const [i, tool] of tools.entries()) {
      const next = tools[i + 1]?.x ?? width;
      assert.ok(tool.x + tool.w <= next + 1, `${width}×${height}: ${names[i]} ${JSON.stringify([tool, next])}`);
    }
    await sinew.close();
  }
});

test('the split keeps its share, and the way back leads to the same', async () => {
  const sinew = await browser.open({ viewport: { width: 1440, height: 900 } });
  const share = async (width, height) => {
    await sinew.page.setViewportSize({ width, height });
    const { editor } = await check(sinew, width, height);
    return editor.w / width;
  };
  const wide = await share(1440, 900);
  const narrow = await share(800, 600);
  assert.ok(Math.abs(narrow - wide) < 0.02, `${wide} of 1440, ${narrow} of 800`);
  assert.ok(Math.abs((await share(1440, 900)) - wide) < 0.01);
  await sinew.close();
});

describe('while the text has errors', () => {
  let sinew;
  before(async () => {
    sinew = await browser.open({ viewport: { width: 1200, height: 760 } });
    await sinew.load('surface s diffuse Gold\nlight White point, position 4 3 5\nvar r = 1 hot\nsphere s r, 0 0 0\n');
    await sinew.finished();
    await sinew.still();
  });
  after(() => sinew?.close());

  test('a word that is being typed is none; the editor stays where it is, and the picture says that it is old', async () => {
    const [places, good] = [await sinew.places(), await sinew.screen('picture')];
    await sinew.click('editor');
    const { keyboard } = sinew.page;
    await keyboard.press('Control+End');
    // Letter by letter, as a person types: what is shown is looked at in each frame.
    await sinew.page.evaluate(() => {
      globalThis.seen = [];
      const look = () => {
        globalThis.seen.push([sinew.text().split('\n').at(-1), Boolean(sinew.debug.rects().problems)]);
        globalThis.looks = requestAnimationFrame(look);
      };
      look();
    });
    await keyboard.type('sphree', { delay: 60 });
    await sinew.written((text) => text.endsWith('sphree'));
    const typed = await sinew.page.evaluate(() => globalThis.seen);
    assert.ok(typed.some(([line]) => line === 'sph'), JSON.stringify(typed));
    assert.deepEqual(typed.filter(([line, isTold]) => isTold && line !== 'sphree'), [], 'a word that is typed is no mistake');
    // A second later it is one.
    await sinew.place('problems');
    const { errors, fresh } = await sinew.status();
    assert.deepEqual([errors, fresh], [1, false]);
    const told = await sinew.places();
    assert.ok(told['old picture'], 'the picture says that it is old');
    assert.deepEqual([told.editor, told.sliders], [places.editor, places.sliders], 'nothing moves');
    const dimmed = await sinew.screen('picture');
    assert.ok(meanDeltaE(dimmed, good) > 5, 'it is dimmed');
    await sinew.keep('old picture');
    for (let i = 0; i < 6; i++) await keyboard.press('Backspace');
    await sinew.until(({ errors, fresh }) => errors === 0 && fresh);
    await until(() => sinew.places(), (places) => !places['old picture'] && !places.problems);
    // It is there at once when the caret leaves the word.
    await keyboard.type('sphree ');
    const from = Date.now();
    await sinew.place('problems');
    assert.ok(Date.now() - from < 900, 'before the second is over');
    for (let i = 0; i < 7; i++) await keyboard.press('Backspace');
    await sinew.finished();
    await sinew.page.mouse.move(5, 5);
    await sinew.still();
    assert.ok(shareThatDiffers(await sinew.screen('picture'), good, 8) < 0.02, 'and bright again');
  });

  test('a shape at the end of the text is seen, with materials on offer behind its command', async () => {
    await sinew.load(await example('tide'));
    const { elements } = await sinew.until(({ elements, errors }) => elements > 0 && errors === 0);
    await sinew.click('editor');
    const { keyboard } = sinew.page;
    await keyboard.press('Control+End');
    await keyboard.press('Enter');
    await keyboard.type('sphere ');
    await sinew.place('completions');
    await sinew.keep('materials');
    await keyboard.type('Chalk 0.2, 0.95 -2.1 0');
    const status = await sinew.until((status) => status.elements === elements + 1);
    assert.deepEqual(status.diagnostics.filter(({ severity }) => severity === 'error'), []);
    const text = await example('tide');
    assert.match(text.split('\n').find((line) => line && !line.startsWith('#')), /^var /, 'the first line teaches');
    await sinew.load(`${await example('seahorse')}\nsurface New diffuse Red\nsphere New 0.1, 0 0 0\n`);
    await sinew.until(({ errors }) => errors === 0);
    assert.deepEqual(sinew.troubles, []);
  });
});
