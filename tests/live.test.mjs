// While a hand turns the model or drags a part of it, the graphics card draws the true surface in place of the traced picture, from numbers
// that the tools worker made.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { PATIENCE, example, launch } from './page.mjs';
import { meanDeltaE } from './pictures.mjs';

const SIZES = {
  desk: { viewport: { width: 1000, height: 640 } },
  phone: { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true },
};

// Balls that melt together far from where each ends, and a hard one.
const MELTED = `eyep 0 0 9
vrp 0 0 0
fov 40
framesize 480 360
background Gray30
light White point, position 4 6 8
surface red diffuse Tomato, specular White, shine 40, blobbiness -0.6
surface blue diffuse SteelBlue, blobbiness -0.6
surface hard diffuse Gold
sphere red 0.9, -1.2 0 0
sphere blue 0.9, 1.2 0 0
sphere hard 0.4, 0 -2 0
`;

let browser;
/** The page of a desk. */
let desk;
before(async () => {
  browser = await launch('webgl2');
});
after(() => browser?.close());

/** Moves a mouse to and fro, its button down, until something is so; the button is still held then. */
async function drag(sinew, [x, y], until) {
  const { mouse } = sinew.page;
  await mouse.move(x, y);
  await mouse.down();
  const deadline = Date.now() + PATIENCE;
  for (let i = 1; ; i++) {
    await mouse.move(x + 12 * Math.sin(i / 3), y);
    await sinew.frame();
    const status = await sinew.status();
    if (until(status, i)) return;
    assert.ok(Date.now() < deadline, `${until} never came true: ${JSON.stringify(status)}`);
  }
}

/** Turns the model to and fro. */
async function turn(sinew, until) {
  const { x, y, w, h } = await sinew.place('picture');
  return drag(sinew, [x + 0.12 * w, y + 0.2 * h], until);
}

for (const [size, options] of Object.entries(SIZES)) {
  test(`a turn shows the true surface on a ${size}`, async () => {
    // A narrow page has no buttons for it.
    const drafted = () => localStorage.setItem('sinew/settings', JSON.stringify({ show: 'draft' }));
    const fetched = [];
    const before = async (page) => {
      page.on('request', (request) => fetched.push(new URL(request.url()).pathname.split('/').pop()));
      if (size === 'phone') await page.addInitScript(drafted);
    };
    const sinew = await browser.open({ ...options, before, size: [240, 180] });
    await sinew.load(MELTED);
    await sinew.finished();
    if (size === 'desk') await sinew.click('show draft');
    await sinew.still();
    await turn(sinew, ({ standIn }) => standIn === 'draft');
    assert.ok(fetched.includes('tools_bg.wasm'));
    await sinew.keep(`live ${size}`);
    const draft = await sinew.screen('picture');
    await sinew.page.mouse.up();
    if (size === 'desk') {
      await sinew.click('show traced');
      await sinew.finished();
      await sinew.page.mouse.move(5, 5);
      await sinew.still();
      const traced = await sinew.screen('picture');
      await sinew.keep('live traced');
      const difference = meanDeltaE(draft, traced);
      assert.ok(difference < 3, `the draft looks as the traced picture: ΔE ${difference}`);
      await sinew.click('show auto');
    }
    const { errors } = await sinew.finished();
    assert.equal(errors, 0);
    assert.deepEqual(sinew.troubles, []);
    if (size === 'desk') desk = sinew;
    else await sinew.close();
  });
}

test('while a ball is dragged the draft follows, even beside a plane', async () => {
  const sinew = desk;
  await sinew.load(MELTED);
  await sinew.finished();
  await sinew.click('show draft');
  const { x, y, w, h } = await sinew.place('picture');
  // A click on the red ball shows its handles.
  await sinew.page.mouse.click(x + 0.31 * w, y + 0.5 * h);
  const knob = await sinew.place('hand the centre');
  await drag(sinew, [knob.x + knob.w / 2, knob.y + knob.h / 2], ({ standIn }, moves) => moves > 6 && standIn === 'draft');
  await sinew.keep('live dragged');
  await sinew.page.mouse.up();
  await sinew.until(({ standIn }) => standIn === 'draft');

  // A plane has no end.
  await sinew.load(`${MELTED}surface soil diffuse Gray50, radius 0.4, blobbiness -2\nplane soil, <0 -4 0>, <0 1 0>\n`);
  await turn(sinew, ({ standIn }, moves) => moves > 6 && standIn === 'draft');
  await sinew.page.mouse.up();
  assert.deepEqual(sinew.troubles, []);
});

test('a larger model is drafted, too', async () => {
  const sinew = desk;
  await sinew.load(await example('snail'));
  await sinew.until(({ fresh }) => fresh);
  await sinew.keep('live snail');
  const begun = Date.now();
  await turn(sinew, ({ standIn }) => standIn === 'draft');
  console.log(`${Date.now() - begun} ms to the first draft`);
  await sinew.page.mouse.up();
  await sinew.keep('live snail turned');
  assert.deepEqual(sinew.troubles, []);
});
