// The way of a person through the page, in each kind of browser: open it, edit, make a mistake, drag
// a slider, share, lose a worker, reload.
import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { KINDS, example, launch, native } from './page.mjs';
import { colours, countNear, meanDeltaE, shareThatDiffers, shrink } from './pictures.mjs';

/** Size of the pictures that are compared, pixels. */
const SIZE = [200, 160];
/** A mean difference (CIE76) that nobody can see. */
const UNSEEN = 0.1;
/** What a screenshot may differ from the picture it shows: it is scaled to the window. */
const SEEN_ON_SCREEN = 6;
/** Red of the underlines of errors (crate/widgets/src/theme.rs). */
const ERROR_RED = [0xff, 0x6b, 0x6b];

/** A small model with a slider. */
const MODEL = `framesize 200 160
eyep 0 -0.4 5
vrp 0 -0.4 0
light White point, position 4 3 5, intensity 1
var size = 0.4 hot
surface flesh diffuse SummerSky, specular White, shine 40, blob -2
sphere flesh size 0 0 0
sphere flesh 0.4 0 -0.9 0
`;

for (const kind of Object.keys(KINDS)) {
  describe(`with ${kind}`, () => {
    let browser;
    let sinew;

    before(async () => {
      browser = await launch(kind);
      sinew = await browser.open();
    });
    after(async () => {
      await sinew?.close();
      await browser?.close();
    });

    test('the page opens with the still life at the tide line, drawn by what the browser has', async () => {
      await sinew.page.waitForSelector('#loading', { state: 'detached' });
      const status = await sinew.finished();
      await sinew.keep('opened');
      assert.equal(status.backend, kind);
      assert.equal(status.errors, 0);
      assert.equal(status.failure, null);
      assert.ok(status.workers >= 1);
      assert.equal(await sinew.text(), await example('tide'));
      assert.ok(colours(await sinew.screen()) > 100, 'the window is not blank');
    });

    test('the picture is the one that the program draws', async () => {
      await sinew.resize(...SIZE);
      const [traced, expected] = [await sinew.image(), await native(await sinew.text(), SIZE)];
      const difference = meanDeltaE(traced, expected);
      assert.ok(difference < UNSEEN, `ΔE ${difference}`);
      // The measure sees a difference where there is one.
      const other = await native(await example('seahorse'), SIZE);
      assert.ok(meanDeltaE(traced, other) > 10 * UNSEEN);
    });

    test('the picture is what one sees', async () => {
      const place = await sinew.place('picture');
      const size = [Math.floor(place.w / 2), Math.floor(place.h / 2)];
      const shown = shrink(await sinew.screen('picture'), ...size);
      const expected = await native(await sinew.text(), size);
      const difference = meanDeltaE(shown, expected);
      assert.ok(difference < SEEN_ON_SCREEN, `ΔE ${difference}`);
    });

    test('a mistake is underlined, the old picture stays, and mending it goes on', async () => {
      await sinew.load(MODEL);
      await sinew.finished();
      const picture = await sinew.image();
      const red = countNear(await sinew.screen('editor'), ERROR_RED, 40);

      const editor = await sinew.place('editor');
      await sinew.page.mouse.click(editor.x + editor.w / 2, editor.y + editor.h / 2);
      await sinew.page.keyboard.press('Control+End');
      await sinew.page.keyboard.type('sphree flesh 1 0.8 0 0', { delay: 20 });
      const status = await sinew.until(({ diagnostics }) => diagnostics.some((d) => /sphree/.test(d.message)));
      const [mistake] = status.diagnostics;
      assert.equal(mistake.line, MODEL.split('\n').length);
      assert.equal(mistake.column, 1);
      assert.match(JSON.stringify(mistake), /sphere/, 'it says what was meant');
      await sinew.place('problems');
      // The underline comes with one of the next frames.
      let nowRed = red;
      for (let attempt = 0; attempt < 40 && nowRed <= red + 5; attempt++) {
        await sinew.page.waitForTimeout(250);
        nowRed = countNear(await sinew.screen('editor'), ERROR_RED, 40);
      }
      await sinew.keep('mistake');
      assert.ok(nowRed > red + 5, `the underline: ${red} red pixels before, ${nowRed} after`);
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
        await sinew.page.waitForTimeout(50);
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

      const other = await browser.open({ fragment: link.slice(link.indexOf('#')) });
      assert.equal(await other.text(), text);
      await other.resize(picture.width, picture.height);
      assert.equal(shareThatDiffers(await other.image(), picture, 0), 0);
      assert.deepEqual(other.troubles, []);
      await other.close();
    });

    test('a worker that is killed is replaced, and the picture is complete', async () => {
      // Large enough that the picture is far from finished when the worker is killed.
      const size = [800, 640];
      await sinew.resize(...size);
      await sinew.load(await example('cowrie'));
      await sinew.until((status) => status.phase === 'tracing' && status.progress > 0.02);
      await sinew.page.evaluate(() => sinew.debug.killWorker(0));
      const status = await sinew.finished();
      assert.ok(status.replaced >= 1, 'the worker was missed');
      const expected = await native(await sinew.text(), size);
      assert.ok(shareThatDiffers(await sinew.image(), expected, 1) <= 0.001);
    });

    test('nothing is lost by closing the page at once', async () => {
      await sinew.load(MODEL);
      await sinew.until((status) => status.errors === 0);
      const editor = await sinew.place('editor');
      await sinew.page.mouse.click(editor.x + editor.w / 2, editor.y + editor.h / 2);
      await sinew.page.keyboard.press('Control+End');
      await sinew.page.keyboard.type('# mine');
      await sinew.page.waitForFunction(() => sinew.text().endsWith('# mine'));
      await sinew.reload();
      assert.ok((await sinew.text()).endsWith('# mine'));
      await sinew.finished();
    });

    test('nothing went wrong unseen', () => {
      assert.deepEqual(sinew.troubles, []);
    });
  });
}
