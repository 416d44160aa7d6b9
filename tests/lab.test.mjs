// The lab: each lesson by its own link, on a desk and on a phone, with something taken hold of, and
// the way back to the editor.
import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { PATIENCE, example, launch } from './page.mjs';
import { colours } from './pictures.mjs';

const SIZES = {
  desk: { viewport: { width: 1440, height: 900 } },
  phone: { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true },
};
const LESSONS = [
  'kernels', 'convolution', 'slice', 'grid', 'profiles', 'chart', 'superposition', 'spans', 'contact', 'sculpting', 'fitting',
  'textures',
];
/** A text of the visitor's own. */
const OWN = '# mine\nframesize 64 48\nsurface s diffuse Gold, blobbiness -2\nsphere s 1 0 0 0\n';

/** The state of the lab, or null in the editor. */
const lab = (sinew) => sinew.page.evaluate(() => sinew.lab());

/** Waits until the lab is as wanted. */
async function until(sinew, wanted, timeout = PATIENCE) {
  const deadline = Date.now() + timeout;
  for (;;) {
    const state = await lab(sinew);
    if (wanted(state)) return state;
    assert.ok(Date.now() < deadline, `${wanted} never came true: ${JSON.stringify(state)}`);
    await sinew.page.waitForTimeout(50);
  }
}

/** Follows a link within the page. */
async function follow(sinew, lesson) {
  await sinew.page.evaluate((hash) => {
    location.hash = hash;
  }, `#lab=${lesson}`);
  return until(sinew, (state) => state?.lesson === lesson);
}

/** Waits until a widget no longer moves. */
async function still(sinew, name) {
  let last;
  for (let now = await sinew.place(name); now.y !== last?.y; now = await sinew.place(name)) {
    last = now;
    await sinew.page.waitForTimeout(400);
  }
}

/** Drags from the middle of a widget by so many pixels. */
async function drag(sinew, name, [dx, dy]) {
  const { x, y, w, h } = await sinew.place(name);
  const { mouse } = sinew.page;
  await mouse.move(x + w / 2, y + h / 2);
  await mouse.down();
  for (let step = 1; step <= 6; step++) {
    await mouse.move(x + w / 2 + (dx * step) / 6, y + h / 2 + (dy * step) / 6);
    await sinew.page.waitForTimeout(40);
  }
  await mouse.up();
}

/** What is dragged in a lesson, and the reading that must change. */
const TOUCH = {
  kernels: ['lab slider Radius R', [40, 0], 'radius'],
  convolution: ['lab grip iso-value', [0, -40], 'iso'],
  superposition: ['lab grip cut', [45, 0], 'cut'],
  contact: ['lab grip right drop', [30, 0], 'apart'],
  fitting: ['lab grip point 3', [20, -30], 'triangular'],
};

for (const [size, options] of Object.entries(SIZES)) {
  describe(`the lab on a ${size}`, () => {
    let browser;
    // One page for all lessons, as a page takes seconds to start here. The first lesson's link opens it.
    let sinew;
    before(async () => {
      browser = await launch('webgl2');
      sinew = await browser.open({ fragment: `#lab=${LESSONS[0]}`, ...options });
    });
    after(() => browser?.close());

    test('finished() is refused while the lab keeps the picture waiting', async () => {
      await until(sinew, (state) => state?.lesson === LESSONS[0]);
      const told = await sinew.page.evaluate(() => sinew.finished().then(() => 'finished', (error) => error.message));
      assert.match(told, /The lab is open/);
    });

    for (const lesson of LESSONS) {
      test(`${lesson} opens by its link`, async () => {
        const colorScheme = LESSONS.indexOf(lesson) % 2 ? 'light' : 'dark';
        await sinew.page.emulateMedia({ colorScheme });
        if (lesson !== LESSONS[0]) await follow(sinew, lesson);
        // A lesson has readings once its first frame is drawn.
        const drawn = (state) => Object.keys(state.readings).length > 0;
        const state = await until(sinew, (state) => state?.lesson === lesson && state.waiting === 0 && drawn(state));
        assert.equal(state.refused, 0, 'everything is drawn');
        if (lesson === 'grid') assert.equal(state.drawn, 16);
        if (lesson === 'profiles') assert.equal(state.drawn, 4);
        if (lesson === 'slice') await until(sinew, ({ readings }) => readings.finished === 1);
        if (lesson === 'chart') {
          // Cells are timed first and then traced, row by row; a row is enough.
          await until(sinew, ({ readings, drawn, refused }) => readings.timed === 63 && drawn >= 7 && refused === 0);
        }
        await sinew.keep(`lab ${lesson} ${size}`);
        assert.ok(colours(await sinew.screen()) > 100, 'the window is not blank');
        if (TOUCH[lesson]) {
          const [widget, by, reading] = TOUCH[lesson];
          const place = await sinew.place(widget);
          if (place.y + place.h > options.viewport.height - 20) {
            // Below the fold of a phone.
            await sinew.page.mouse.move(180, 300);
            await sinew.page.mouse.wheel(0, place.y - 400);
            await still(sinew, widget);
          }
          await drag(sinew, widget, by);
          await until(sinew, (after) => after.readings[reading] !== state.readings[reading]);
        }
        const { overflow, places } = await sinew.page.evaluate(() => ({
          overflow: document.documentElement.scrollWidth - innerWidth,
          places: sinew.debug.rects(),
        }));
        assert.ok(overflow <= 0, 'nothing sticks out');
        for (const name of ['lab back', 'lab share', 'lab dataset', 'lab figure']) {
          const { x, w } = places[name];
          assert.ok(x >= 0 && x + w <= options.viewport.width + 1, `${name} is on the screen`);
        }
        // Leaving leads to the editor, with what a first visit shows there.
        await sinew.click('lab back');
        await sinew.page.waitForFunction(() => sinew.lab() === null);
        assert.equal(await sinew.text(), await example('tide'));
        assert.deepEqual(sinew.troubles, []);
      });
    }

    test('the way there and back, and what it leaves alone', async () => {
      const sinew = await browser.open(options);
      await sinew.load(OWN);
      await sinew.finished();
      const { revision } = await sinew.status();
      await sinew.click('lab');
      await until(sinew, (state) => state?.lesson === 'kernels');
      assert.equal(new URL(sinew.page.url()).hash, '#lab=kernels');
      await sinew.page.waitForTimeout(300);
      await sinew.click('lab lesson convolution');
      await until(sinew, (state) => state?.lesson === 'convolution');
      await sinew.page.goBack();
      await until(sinew, (state) => state?.lesson === 'kernels');
      await sinew.page.goBack();
      await until(sinew, (state) => state === null);
      assert.equal(await sinew.text(), OWN);
      const status = await sinew.status();
      assert.equal(status.revision, revision, 'nothing was opened anew');
      assert.ok(status.fresh && status.phase === 'done', 'the picture is still there');
      await sinew.page.goForward();
      await until(sinew, (state) => state?.lesson === 'kernels');
      await sinew.reload();
      await until(sinew, (state) => state?.lesson === 'kernels');

      // A dataset of the lab opens beside the work; the way back leads to the lesson.
      await sinew.click('lab dataset');
      await sinew.page.waitForFunction(() => sinew.lab() === null && sinew.text().includes('lesson 1'));
      const opened = await sinew.until((status) => status.phase !== 'idle');
      assert.deepEqual(opened.diagnostics, []);
      await sinew.page.goBack();
      await until(sinew, (state) => state?.lesson === 'kernels');
      assert.deepEqual(sinew.troubles, []);
      await sinew.close();
    });
  });
}

test('a link to the lab leaves saved work alone', async () => {
  const browser = await launch('none');
  try {
    const sinew = await browser.open();
    const editor = await sinew.place('editor');
    await sinew.page.mouse.click(editor.x + editor.w / 2, editor.y + editor.h / 2);
    await sinew.page.keyboard.press('Control+A');
    await sinew.page.keyboard.type('# mine');
    await sinew.page.waitForFunction(() => sinew.text() === '# mine');
    await sinew.until((status) => status.saved);
    await follow(sinew, 'superposition');
    await sinew.keep('lab superposition');
    assert.ok(colours(await sinew.screen()) > 100, 'the window is not blank');
    await sinew.reload();
    await until(sinew, (state) => state?.lesson === 'superposition');
    assert.equal(await sinew.text(), '# mine');
    await sinew.click('lab back');
    await until(sinew, (state) => state === null);
    assert.equal(await sinew.text(), '# mine');
    assert.equal(new URL(sinew.page.url()).hash, '');
    assert.deepEqual(sinew.troubles, []);
  } finally {
    await browser.close();
  }
});
