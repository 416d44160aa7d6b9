// The page opens and draws in each kind of browser; and the way of a person through it: edit, make a mistake,
// drag a slider, share, lose a worker, reload.
import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { KINDS, example, launch, native, until } from './page.mjs';
import { colours, countNear, meanDeltaE, shareThatDiffers, shrink } from './pictures.mjs';

/** Size of the pictures that are compared, pixels. */
const SIZE = [240, 180];
/** A mean difference (CIE76) that nobody can see. */
const UNSEEN = 0.1;
/** What a screenshot may differ from the picture it shows: it is scaled to the window. */
const SEEN_ON_SCREEN = 6;
/** What a draft may differ from the traced picture on the screen. */
const AS_A_DRAFT = 6;
/** Red of the underlines of errors (crate/widgets/src/theme.rs). */
const ERROR_RED = [0xff, 0x6b, 0x6b];

/** A small model with a slider. */
const MODEL = `framesize 240 180
eyep 0 -0.4 5
vrp 0 -0.4 0
light White point, position 4 3 5, intensity 1
var size = 0.4 hot
surface flesh diffuse SummerSky, specular White, shine 40, blob -2
sphere flesh size 0 0 0
sphere flesh 0.4 0 -0.9 0
`;

/** Two balls that overlap. */
const BODIES = `framesize 240 180
eyep 0 0 8
background White
light White point, position 4 3 9
surface Left diffuse Tomato, ambient Gray30, blobbiness -2
surface Right diffuse SteelBlue, ambient Gray30, blobbiness -2
body LEFT
sphere Left 1.1, -0.9 0 0
close
body RIGHT
sphere Right 1.1, 0.9 0 0
close
`;

for (const kind of Object.keys(KINDS)) {
  test(`the page opens and draws with ${kind}`, async () => {
    const browser = await launch(kind);
    try {
      const sinew = await browser.open({ size: SIZE, viewport: { width: 1000, height: 640 } });
      await sinew.page.waitForSelector('#loading', { state: 'detached' });
      const status = await sinew.finished();
      await sinew.keep('opened');
      assert.equal(status.backend, kind);
      assert.equal(status.errors, 0);
      assert.equal(status.failure, null);
      assert.ok(status.workers >= 1);
      const text = await sinew.text();
      assert.equal(text, await example('tide'));
      assert.ok(colours(await sinew.screen()) > 100, 'the window is not blank');

      const [traced, expected] = [await sinew.image(), await native(text, SIZE)];
      const difference = meanDeltaE(traced, expected);
      assert.ok(difference < UNSEEN, `ΔE ${difference}`);
      // The measure sees a difference where there is one.
      assert.ok(meanDeltaE(traced, await native(MODEL, SIZE)) > 10 * UNSEEN);

      // One sees that picture, and where there is a graphics card its draft.
      const seen = async () => shrink(await sinew.screen('picture'), ...SIZE);
      const shown = meanDeltaE(await seen(), expected);
      assert.ok(shown < SEEN_ON_SCREEN, `ΔE ${shown} on the screen`);
      await sinew.load(BODIES);
      await sinew.finished();
      await sinew.still();
      const bodies = await seen();
      let drafted = bodies;
      if (kind !== 'none') {
        await sinew.click('show draft');
        await sinew.until(({ standIn }) => standIn === 'draft');
        await sinew.page.mouse.move(5, 5);
        await sinew.still();
        await sinew.keep('draft');
        drafted = await seen();
        const change = meanDeltaE(drafted, bodies);
        assert.ok(change < AS_A_DRAFT, `ΔE ${change} of the draft`);
        assert.ok(shareThatDiffers(drafted, bodies, 2) > 0, 'the draft is another picture');
      }
      // Both balls are there.
      for (const picture of [bodies, drafted]) {
        const [red, blue] = [[255, 99, 71], [70, 130, 180]].map((colour) => countNear(picture, colour, 90));
        assert.ok(red > 1000 && blue > 1000, `${red} red pixels, ${blue} blue ones`);
      }
      assert.deepEqual(sinew.troubles, []);
    } finally {
      await browser.close();
    }
  });
}

describe('a person', () => {
  let browser;
  let sinew;

  before(async () => {
    browser = await launch();
    sinew = await browser.open({ size: SIZE });
  });
  after(() => browser?.close());

  test('a mistake is underlined, the old picture stays, and mending it goes on', async () => {
    await sinew.load(MODEL);
    await sinew.finished();
    const picture = await sinew.image();
    const red = countNear(await sinew.screen('editor'), ERROR_RED, 40);

    await sinew.click('editor');
    await sinew.page.keyboard.press('Control+End');
    await sinew.page.keyboard.type('sphree flesh 1 0.8 0 0');
    const status = await sinew.until(({ diagnostics }) => diagnostics.some((d) => /sphree/.test(d.message)));
    const [mistake] = status.diagnostics;
    assert.equal(mistake.line, MODEL.split('\n').length);
    assert.equal(mistake.column, 1);
    assert.match(JSON.stringify(mistake), /sphere/, 'it says what was meant');
    await sinew.place('problems');
    // The underline comes with one of the next frames.
    const reds = async () => countNear(await sinew.screen('editor'), ERROR_RED, 40);
    await until(reds, (now) => now > red + 5);
    await sinew.keep('mistake');
    assert.equal(shareThatDiffers(await sinew.image(), picture, 0), 0, 'the old picture stays');

    await sinew.page.keyboard.press('Home');
    // sphree: behind the r, which goes behind the e.
    for (let i = 0; i < 4; i++) await sinew.page.keyboard.press('ArrowRight');
    await sinew.page.keyboard.press('Backspace');
    await sinew.page.keyboard.press('ArrowRight');
    await sinew.page.keyboard.type('r');
    await sinew.until((status) => status.errors === 0);
    await sinew.finished();
    assert.ok(shareThatDiffers(await sinew.image(), picture, 8) > 0.05, 'the new picture came');
  });

  test('a dragged slider changes the text, the draft and the picture', async () => {
    await sinew.load(MODEL);
    await sinew.finished();
    const [text, picture] = [await sinew.text(), await sinew.image()];
    const slider = await sinew.place('slider size');
    const y = slider.y + slider.h / 2;
    await sinew.page.mouse.move(slider.x + slider.w / 2, y);
    await sinew.page.mouse.down();
    for (let step = 0; step <= 6; step++) {
      await sinew.page.mouse.move(slider.x + slider.w * (0.5 + 0.06 * step), y);
      await sinew.still();
    }
    await sinew.page.mouse.up();
    await sinew.until((status) => status.errors === 0);
    const dragged = await sinew.text();
    assert.notEqual(dragged, text);
    assert.match(dragged, /var size = \S+ hot/);
    await sinew.finished();
    await sinew.keep('slider');
    const now = await sinew.image();
    assert.ok(shareThatDiffers(now, picture, 8) > 0.01, 'the picture follows');
    const expected = await native(dragged, [now.width, now.height]);
    assert.ok(meanDeltaE(now, expected) < UNSEEN, 'and is that of the new text');
  });

  test('a shared link opens the same text and picture in a new profile', async () => {
    const [text, picture] = [await sinew.text(), await sinew.image()];
    await sinew.click('share');
    await sinew.page.waitForFunction(async () => /#/.test(await navigator.clipboard.readText()), undefined, { polling: 200 });
    const link = await sinew.page.evaluate(() => navigator.clipboard.readText());
    await sinew.keep('shared');
    assert.equal(link, await sinew.link());

    const other = await browser.open({ size: SIZE, fragment: link.slice(link.indexOf('#')) });
    assert.equal(await other.text(), text);
    await other.finished();
    assert.equal(shareThatDiffers(await other.image(), picture, 0), 0);
    assert.deepEqual(other.troubles, []);
    await other.close();
  });

  test('a worker that is killed is replaced, and the picture is complete', async () => {
    // Large enough that the picture is far from finished when the worker is killed.
    const size = [320, 256];
    await sinew.pictureSize(...size);
    await sinew.load(await example('cowrie'));
    await sinew.page.evaluate(async () => {
      const pause = () => new Promise((done) => setTimeout(done, 5));
      for (;;) {
        const { phase, progress } = sinew.status();
        if (phase === 'tracing' && progress > 0.02) break;
        await pause();
      }
      sinew.debug.killWorker(0);
    });
    const status = await sinew.finished();
    assert.ok(status.replaced >= 1, 'the worker was missed');
    const expected = await native(await sinew.text(), size);
    assert.ok(shareThatDiffers(await sinew.image(), expected, 1) <= 0.001);
  });

  test('nothing is lost by closing the page at once', async () => {
    await sinew.pictureSize(...SIZE);
    await sinew.load(MODEL);
    await sinew.until((status) => status.errors === 0);
    await sinew.click('editor');
    await sinew.page.keyboard.press('Control+End');
    await sinew.page.keyboard.type('# mine');
    await sinew.written((text) => text.endsWith('# mine'));
    await sinew.reload();
    assert.ok((await sinew.text()).endsWith('# mine'));
    await sinew.finished();
  });

  test('nothing went wrong unseen', () => {
    assert.deepEqual(sinew.troubles, []);
  });
});
