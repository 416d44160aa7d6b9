// A graphics card that is lost while the page runs, and one that is not there: the page says so, goes on without it, and loses nothing.
import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { PATIENCE, launch, until } from './page.mjs';
import { shareThatDiffers } from './pictures.mjs';

const TEXT = `framesize 160 120
eyep 0 0 9
light White point, position 4 6 8
surface a diffuse Tomato, blobbiness -0.6
sphere a 0.9, -1.2 0 0
sphere a 0.9, 1.2 0 0
`;

let browser;
let free;
before(async () => {
  browser = await launch('webgl2');
  // Where the page itself looks for what there is.
  free = await launch('webgl2', { free: true });
});
after(() => Promise.all([browser?.close(), free?.close()]));

/** Types at the end of the text. */
async function type(sinew, words) {
  await sinew.click('editor');
  await sinew.page.keyboard.press('Control+End');
  await sinew.page.keyboard.type(words);
  await sinew.written((text) => text.endsWith(words));
}

/** Moves a mouse over the picture, its button down, and lets go. */
async function turn(sinew) {
  const { x, y, w, h } = await sinew.place('picture');
  const { mouse } = sinew.page;
  await mouse.move(x + 0.1 * w, y + 0.2 * h);
  await mouse.down();
  for (let i = 1; i <= 5; i++) {
    await mouse.move(x + (0.1 + 0.02 * i) * w, y + 0.2 * h);
    await sinew.frame();
  }
  await mouse.up();
}

/** Has the browser take the window's context away, some milliseconds after the start, and waits for the next window. */
async function lose(sinew, after) {
  const old = await sinew.page.evaluateHandle((after) => {
    const canvas = document.querySelector('canvas');
    const now = Date.now();
    Date.now = () => now + after;
    canvas.getContext('webgl2').getExtension('WEBGL_lose_context').loseContext();
    return canvas;
  }, after);
  await sinew.page.waitForFunction((old) => document.querySelector('canvas') !== old, old, { timeout: PATIENCE });
  await sinew.ready();
}

/** The words of the page. */
const words = ({ page }) => page.evaluate(() => document.querySelector('#voice')?.textContent ?? '');

/** Checks that a page without a card works. */
async function check(sinew, text) {
  await until(() => words(sinew), (words) => words.includes('no GPU'));
  await sinew.pictureSize(...sinew.size);
  const { errors, failure } = await sinew.finished();
  assert.deepEqual([errors, failure], [0, null]);
  const picture = await sinew.image();
  await turn(sinew);
  await until(async () => shareThatDiffers(await sinew.image(), picture, 8), (share) => share > 0.05);
  await type(sinew, '# on');
  assert.equal(await sinew.text(), `${text}# on`);
  await sinew.finished();
}

describe('a card that is lost', () => {
  const opened = async () => {
    // A clock that stands still, so that it does not matter how quick the machine is.
    const stop = () => {
      const now = Date.now();
      Date.now = () => now;
    };
    const sinew = await browser.open({ before: (page) => page.addInitScript(stop) });
    await sinew.load(TEXT);
    await type(sinew, '# mine');
    await sinew.finished();
    return sinew;
  };

  test('soon after the start is gone without, and nothing is lost', async () => {
    const sinew = await opened();
    const { name } = await sinew.until(({ saved }) => saved);
    await sinew.click('show draft');
    await sinew.until(({ standIn }) => standIn === 'draft');
    await type(sinew, ' and more');
    await lose(sinew, 0);
    await sinew.until(({ backend }) => backend === 'none');
    await sinew.place('notice');
    await sinew.keep('lost card');
    assert.match(await words(sinew), /graphics card was lost; the processor draws now/);
    const text = `${TEXT}# mine and more`;
    assert.equal(await sinew.text(), text);
    await check(sinew, text);
    assert.equal((await sinew.until(({ saved }) => saved)).name, name, 'it is no copy');
    await sinew.reload();
    assert.equal(await sinew.text(), `${text}# on`);
    assert.deepEqual(sinew.troubles, []);
    await sinew.close();
  });

  test('after it has worked for long is tried once more', async () => {
    const sinew = await opened();
    await lose(sinew, 3_600_000);
    await sinew.until(({ backend }) => backend === 'webgl2');
    await sinew.place('notice');
    assert.equal(await sinew.text(), `${TEXT}# mine`);
    await sinew.finished();
    await lose(sinew, 3_600_000);
    await sinew.until(({ backend }) => backend === 'none');
    await check(sinew, `${TEXT}# mine`);
    assert.deepEqual(sinew.troubles, []);
    await sinew.close();
  });
});

const ABSENT = {
  'no WebGPU and no WebGL2': () => {
    Object.defineProperty(Navigator.prototype, 'gpu', { get: () => undefined });
  },
  'a WebGPU without an adapter': () => {
    const gpu = { requestAdapter: async () => null, getPreferredCanvasFormat: () => 'rgba8unorm' };
    Object.defineProperty(Navigator.prototype, 'gpu', { get: () => gpu });
  },
  'a WebGPU that never answers': () => {
    const gpu = { requestAdapter: () => new Promise(() => {}), getPreferredCanvasFormat: () => 'rgba8unorm' };
    Object.defineProperty(Navigator.prototype, 'gpu', { get: () => gpu });
  },
};
for (const [what, absent] of Object.entries(ABSENT)) {
  test(`with ${what} the page works, and says what it draws with`, async () => {
    const before = async (page) => {
      await page.addInitScript(absent);
      await page.addInitScript(() => {
        for (const canvas of [HTMLCanvasElement, OffscreenCanvas]) {
          const { getContext } = canvas.prototype;
          canvas.prototype.getContext = function (kind, ...rest) {
            return kind.startsWith('webgl') ? null : getContext.call(this, kind, ...rest);
          };
        }
      });
    };
    const sinew = await free.open({ before });
    assert.equal((await sinew.status()).backend, 'none');
    await sinew.load(TEXT);
    await check(sinew, TEXT);
    await sinew.keep('absent card');
    assert.equal((await sinew.places()).notice, undefined);
    assert.deepEqual(sinew.troubles, []);
    await sinew.close();
  });
}
