// While a hand turns the model or drags a part of it, a mesh of the true surface stands in for the traced picture: made by the tools worker,
// whose wasm is fetched then and not before.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { example, launch } from './page.mjs';
import { meanDeltaE } from './pictures.mjs';

const SIZES = {
  desk: { viewport: { width: 1200, height: 760 } },
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
before(async () => {
  browser = await launch('webgl2');
});
after(() => browser?.close());

/** Turns the model to and fro by a mouse, until something is so; the button is still held then. */
async function turn(sinew, until) {
  const { x, y, w, h } = await sinew.place('picture');
  const { mouse } = sinew.page;
  await mouse.move(x + 0.12 * w, y + 0.2 * h);
  await mouse.down();
  const deadline = Date.now() + 60_000;
  for (let i = 1; ; i++) {
    await mouse.move(x + 0.12 * w + 12 * Math.sin(i / 3), y + 0.2 * h);
    await sinew.page.waitForTimeout(30);
    const status = await sinew.status();
    if (until(status, i)) return;
    assert.ok(Date.now() < deadline, `${until} never came true: ${JSON.stringify(status)}`);
  }
}

for (const [size, options] of Object.entries(SIZES)) {
  test(`a turn shows a mesh of the true surface on a ${size}`, async () => {
    // A narrow page has no buttons for it, and where the processor draws the page it traces this text sooner than it drafts it.
    const drafted = () => localStorage.setItem('sinew/settings', JSON.stringify({ show: 'draft' }));
    const before = size === 'phone' ? (page) => page.addInitScript(drafted) : undefined;
    const sinew = await browser.open({ ...options, before });
    const fetched = [];
    sinew.page.on('request', (request) => fetched.push(new URL(request.url()).pathname.split('/').pop()));
    await sinew.load(MELTED);
    await sinew.finished();
    if (size === 'desk') await sinew.click('show draft');
    await sinew.page.waitForTimeout(500);
    assert.ok(!fetched.includes('tools_bg.wasm'), 'nothing needs it yet');
    if (size === 'desk') await sinew.until(({ standIn }) => standIn === 'draft');

    // In a frame or two the draft is there, soon after it the mesh.
    await turn(sinew, ({ standIn }) => standIn === 'mesh');
    assert.ok(fetched.includes('tools_bg.wasm'));
    await sinew.keep(`live ${size}`);
    const mesh = await sinew.screen('picture');
    await sinew.page.mouse.up();
    if (size === 'desk') {
      await sinew.click('show traced');
      await sinew.finished();
      await sinew.page.mouse.move(5, 5);
      await sinew.page.waitForTimeout(400);
      const traced = await sinew.screen('picture');
      await sinew.keep('live traced');
      const difference = meanDeltaE(mesh, traced);
      assert.ok(difference < 3, `the mesh looks as the traced picture: ΔE ${difference}`);
      await sinew.click('show auto');
    }
    const { errors } = await sinew.finished();
    assert.equal(errors, 0);
    assert.deepEqual(sinew.troubles, []);
    await sinew.close();
  });
}

test('while a bone is dragged the mesh follows, and a text that it cannot follow is drafted', async () => {
  const sinew = await browser.open(SIZES.desk);
  await sinew.load(MELTED);
  await sinew.finished();
  await sinew.click('show draft');
  const { x, y, w, h } = await sinew.place('picture');
  // A click on the red ball shows its handles.
  await sinew.page.mouse.click(x + 0.31 * w, y + 0.5 * h);
  const { x: hx, y: hy, w: hw, h: hh } = await sinew.place('hand the centre');
  const { mouse } = sinew.page;
  await mouse.move(hx + hw / 2, hy + hh / 2);
  await mouse.down();
  const seen = new Set();
  for (let i = 1; i <= 30; i++) {
    await mouse.move(hx + hw / 2 - 2 * i, hy + hh / 2 + i);
    await sinew.page.waitForTimeout(40);
    seen.add((await sinew.status()).standIn);
  }
  await sinew.keep('live dragged');
  await mouse.up();
  await sinew.until(({ standIn }) => standIn === 'mesh');
  assert.ok(seen.has('mesh'), `while it is dragged: ${[...seen]}`);

  // A plane has no end, so there is no mesh of it.
  await sinew.load(`${MELTED}surface soil diffuse Gray50, radius 0.4, blobbiness -2\nplane soil, <0 -4 0>, <0 1 0>\n`);
  await turn(sinew, (_, moves) => moves === 12);
  await mouse.up();
  assert.equal((await sinew.status()).standIn, 'draft');
  assert.deepEqual(sinew.troubles, []);
  await sinew.close();
});

test('larger models are seen as meshes, too', async () => {
  const sinew = await browser.open(SIZES.desk);
  for (const name of ['snail', 'tide']) {
    await sinew.load(await example(name));
    await sinew.finished();
    await sinew.click('show draft');
    await sinew.page.waitForTimeout(300);
    await sinew.keep(`live ${name} draft`);
    const begun = Date.now();
    await turn(sinew, ({ standIn }) => standIn === 'mesh');
    console.log(`${name}: ${Date.now() - begun} ms to the first mesh`);
    await sinew.page.mouse.up();
    await sinew.page.waitForTimeout(300);
    await sinew.keep(`live ${name} mesh`);
    await sinew.click('show auto');
  }
  assert.deepEqual(sinew.troubles, []);
  await sinew.close();
});
