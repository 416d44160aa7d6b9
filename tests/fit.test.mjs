// Measured points dropped on the page: the panel fits a mesh to them in the tools worker, the text's deform converges as one
// undo step, and control points are handles on the picture.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { after, before, test } from 'node:test';
import { launch, until } from './page.mjs';

const TEXT = `framesize 240 240
eyep 3 -9 1
vrp 0 0 -0.1
vup 0 0 1
fov 30
light White, position -6 -9 8, intensity 0.9
surface Skin, diffuse NavajoWhite
mesh Skin head.obj
`;

const SIZES = {
  desk: { viewport: { width: 1280, height: 800 } },
  phone: { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true },
};

/** The middles of the head's facets, bent: what a scanner of a head that leans might give. */
function cloud(obj) {
  const [corners, facets] = [[], []];
  for (const line of obj.split('\n')) {
    const [word, ...rest] = line.split(' ');
    if (word === 'v') corners.push(rest.map(Number));
    if (word === 'f') facets.push(rest.map((i) => corners[i - 1]));
  }
  const lines = facets.map(([a, b, c]) => {
    const [x, y, z] = [0, 1, 2].map((i) => (a[i] + b[i] + c[i]) / 3);
    return `${x + 0.25 * Math.sin(z)} ${y - 0.1 * z} ${z}`;
  });
  return `# a scan\n${lines.join('\n')}\n`;
}

let browser;
before(async () => {
  browser = await launch();
});
after(async () => {
  await browser?.close();
});

for (const [size, options] of Object.entries(SIZES)) {
  test(`a mesh is fitted to dropped points on a ${size}`, async () => {
    const head = await readFile(new URL('../www/examples/head.obj', import.meta.url), 'utf8');
    const sinew = await browser.open({ size: [120, 120], ...options });
    await sinew.page.evaluate(([text, head]) => sinew.take({ 'main.rat': text, 'head.obj': head }), [TEXT, head]);
    await sinew.until(({ assets, errors, elements }) => assets.includes('head.obj') && errors === 0 && elements > 400);
    const before = await sinew.text();
    await sinew.page.evaluate((points) => sinew.take({ 'scan.xyz': points }), cloud(head));
    await sinew.until(({ fit }) => fit?.points === 420);
    await sinew.place('fit panel');
    await sinew.click('fit facets');
    await sinew.click('fit start');
    const { fit, errors } = await sinew.until(({ fit }) => fit.iteration > 0 && !fit.running);
    assert.equal(fit.said, 'Done.');
    assert.equal(errors, 0);
    assert.ok(fit.residual < 0.03, `it lies on the points: ${fit.residual}`);
    const text = JSON.stringify(await sinew.text());
    assert.match(text, /mesh Skin head\.obj\\ndeform \{\\n {2}control </);
    await sinew.place('fit plot');
    await sinew.finished();
    await sinew.keep(`fit ${size}`);

    // A click on the mesh shows its control points; one is dragged, and the text follows.
    const { x, y, w, h } = await sinew.place('picture');
    const { mouse } = sinew.page;
    await mouse.click(x + w / 2, y + h / 2);
    const knobs = async () => {
      await sinew.still();
      const places = Object.entries(await sinew.places());
      return places.filter(([name]) => name.startsWith('hand control')).map(([, place]) => place);
    };
    const all = await until(knobs, (knobs) => knobs.length > 0);
    assert.ok(all.length > 20, `${all.length} knobs`);
    await sinew.keep(`fit cage ${size}`);
    // The one that is highest on the screen has no other above it.
    const top = all.reduce((best, place) => (place.y < best.y ? place : best));
    const fitted = await sinew.text();
    await mouse.move(top.x + top.w / 2, top.y + top.h / 2);
    await mouse.down();
    await mouse.move(top.x + top.w / 2 + 14, top.y + top.h / 2 + 8, { steps: 4 });
    await sinew.still();
    await mouse.up();
    await sinew.still();
    assert.notEqual(await sinew.text(), fitted, 'the move is in the text');
    await sinew.click('undo');
    await sinew.still();
    assert.equal(await sinew.text(), fitted, 'one step back');

    // The whole fit is one step, too.
    await sinew.click('fit back');
    await sinew.still();
    assert.equal(await sinew.text(), before);

    // What is no cloud is told of.
    await sinew.page.evaluate(() => sinew.take({ 'bad.xyz': '1 2\n' }));
    const bad = await sinew.until(({ fit }) => fit.said?.includes('bad.xyz'));
    assert.match(bad.fit.said, /line 1: three numbers are expected/);
    assert.deepEqual(sinew.troubles, []);
    await sinew.close();
  });
}
