// The lab: each lesson by its own link, on a desk and on a phone, with something taken hold of, and
// the way back to the editor.
import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { example, launch, until as untilAnswer } from './page.mjs';
import { colours } from './pictures.mjs';

const SIZES = {
  desk: { viewport: { width: 1440, height: 900 } },
  phone: { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true },
};
/** A text of the visitor's own. */
const OWN = '# mine\nframesize 64 48\nsurface s diffuse Gold, blobbiness -2\nsphere s 1 0 0 0\n';

/** The state of the lab, or null in the editor. */
const lab = (sinew) => sinew.page.evaluate(() => sinew.lab());

/** Waits until the lab is as wanted. */
const until = (sinew, wanted) => untilAnswer(() => lab(sinew), wanted);

/** Follows a link within the page. */
async function follow(sinew, lesson) {
  await sinew.page.evaluate((hash) => {
    location.hash = hash;
  }, `#lab=${lesson}`);
  return until(sinew, (state) => state?.lesson === lesson);
}

/** Drags from the middle of a widget by so many pixels. */
async function drag(sinew, name, [dx, dy]) {
  const { x, y, w, h } = await sinew.place(name);
  const { mouse } = sinew.page;
  await mouse.move(x + w / 2, y + h / 2);
  await mouse.down();
  for (let step = 1; step <= 6; step++) {
    await mouse.move(x + w / 2 + (dx * step) / 6, y + h / 2 + (dy * step) / 6);
    await sinew.still();
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
  centreline: ['lab grip INLET', [20, 10], 'inlet'],
};

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser?.close());

for (const [size, options] of Object.entries(SIZES)) {
  describe(`the lab on a ${size}`, () => {
    // One page for all lessons, as a page takes seconds to start here. It opens at the first and names them all.
    let sinew;
    let lessons;
    before(async () => {
      sinew = await browser.open({ fragment: '#lab', ...options });
      lessons = (await until(sinew, (state) => state?.lessons)).lessons;
      assert.ok(lessons.length >= 12, `the lessons are ${lessons}`);
    });
    after(() => sinew?.close());

    test('finished() is refused while the lab keeps the picture waiting', async () => {
      await until(sinew, (state) => state?.lesson === lessons[0]);
      const told = await sinew.page.evaluate(() => sinew.finished().then(() => 'finished', (error) => error.message));
      assert.match(told, /The lab is open/);
    });

    test('every lesson opens by its link', async (all) => {
      for (const [index, lesson] of lessons.entries()) {
        await all.test(lesson, () => visit(index, lesson));
      }
    });

    /** Opens a lesson by its link and takes hold of its figure. */
    async function visit(index, lesson) {
      const colorScheme = index % 2 ? 'light' : 'dark';
      await sinew.page.emulateMedia({ colorScheme });
      if (index > 0) await follow(sinew, lesson);
      // A lesson has readings once its first frame is drawn. Its pictures are the same on every page.
      const drawn = ({ readings, waiting }) => Object.keys(readings).length > 0 && (size === 'phone' || waiting === 0);
      const state = await until(sinew, (state) => state?.lesson === lesson && drawn(state));
      assert.equal(state.refused, 0, 'everything is drawn');
      if (size === 'desk') await complete(lesson, state);
      await sinew.still();
      await sinew.keep(`lab ${lesson} ${size}`);
      assert.ok(colours(await sinew.screen()) > 100, 'the window is not blank');
      if (TOUCH[lesson]) await touch(lesson, state);
      const overflow = await sinew.page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
      assert.ok(overflow <= 0, 'nothing sticks out');
      const places = await sinew.places();
      for (const name of ['lab back', 'lab share', 'lab dataset', 'lab figure']) {
        const { x, w } = places[name];
        assert.ok(x >= 0 && x + w <= options.viewport.width + 1, `${name} is on the screen`);
      }
      assert.deepEqual(sinew.troubles, []);
    }

    /** Waits for what a lesson computes by and by. */
    async function complete(lesson, { drawn }) {
      if (lesson === 'grid') assert.equal(drawn, 16);
      if (lesson === 'profiles') assert.equal(drawn, 4);
      if (lesson === 'slice') await until(sinew, ({ readings }) => readings.finished === 1);
      if (lesson === 'chart') {
        // Cells are timed first and then traced, row by row; a row is enough.
        await until(sinew, ({ readings, drawn, refused }) => readings.timed === 63 && drawn >= 7 && refused === 0);
      }
    }

    /** Takes hold of a thing, and waits until what it changes is read. */
    async function touch(lesson, state) {
      const [widget, by, reading] = TOUCH[lesson];
      const place = await sinew.place(widget);
      if (place.y + place.h > options.viewport.height - 20) {
        // Below the fold of a phone.
        await sinew.page.mouse.move(180, 300);
        await sinew.page.mouse.wheel(0, place.y - 400);
      }
      await drag(sinew, widget, by);
      await until(sinew, (after) => after.readings[reading] !== state.readings[reading]);
    }

    test('leaving leads to the editor, with what a first visit shows there', async () => {
      await sinew.click('lab back');
      await until(sinew, (state) => state === null);
      assert.equal(await sinew.text(), await example('tide'));
      assert.deepEqual(sinew.troubles, []);
    });

    test('the way there and back, and what it leaves alone', async () => {
      await sinew.load(OWN);
      await sinew.finished();
      const { revision } = await sinew.status();
      // It opens at the lesson that was last there.
      const last = lessons.at(-1);
      await sinew.click('lab');
      await until(sinew, (state) => state?.lesson === last);
      assert.equal(new URL(sinew.page.url()).hash, `#lab=${last}`);
      await follow(sinew, 'kernels');
      await sinew.click('lab lesson convolution');
      await until(sinew, (state) => state?.lesson === 'convolution');
      await sinew.page.goBack();
      await until(sinew, (state) => state?.lesson === 'kernels');
      await sinew.page.goBack();
      await until(sinew, (state) => state?.lesson === last);
      await sinew.page.goBack();
      await until(sinew, (state) => state === null);
      assert.equal(await sinew.text(), OWN);
      const status = await sinew.status();
      assert.equal(status.revision, revision, 'nothing was opened anew');
      assert.ok(status.fresh && status.phase === 'done', 'the picture is still there');
      await sinew.page.goForward();
      await until(sinew, (state) => state?.lesson === last);

      // A dataset of the lab opens beside the work; the way back leads to the lesson.
      await follow(sinew, 'kernels');
      await sinew.click('lab dataset');
      await until(sinew, (state) => state === null);
      await sinew.written((text) => text.includes('lesson 1'));
      const opened = await sinew.until((status) => status.phase !== 'idle');
      assert.deepEqual(opened.diagnostics, []);
      await sinew.page.goBack();
      await until(sinew, (state) => state?.lesson === 'kernels');
      assert.deepEqual(sinew.troubles, []);
    });
  });
}

test('a link to the lab leaves saved work alone', async () => {
  const browser = await launch();
  try {
    const sinew = await browser.open();
    await sinew.click('editor');
    await sinew.page.keyboard.press('Control+A');
    await sinew.page.keyboard.type('# mine');
    await sinew.written((text) => text === '# mine');
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
