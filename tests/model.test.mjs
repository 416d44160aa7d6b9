// The model as a mesh: the dialog on desk and phone, a file of each format, and what another program makes of it.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { PATIENCE, example, launch, until } from './page.mjs';
import { colours, decode } from './pictures.mjs';
import { viewer } from './viewer.mjs';

const SIZES = {
  desk: { viewport: { width: 1280, height: 800 } },
  phone: { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true },
};

/** The pictures do not matter here. */
const SMALL = [32, 24];

/** Two drops of two colours that melt into each other. */
const DROPS = `framesize 64 48
eyep 0 0 9
light White point, position 4 6 8
surface red, diffuse Red, blob -2
surface blue, diffuse Blue, blob -2
sphere red 1, -0.8 0 0
sphere blue 0.7, 0.9 0 0
`;

/** An arm whose hand rises. */
const ARM = `framesize 64 48
eyep 2 0 9
light White point, position 4 6 8
var y = 0 += 0.25
surface s, kernel cauchy, blobbiness -2, diffuse Gold, radius 0.4
skeleton s, ARM { node A <0 0 0> node B <2 0 0> node C <4 y 0> curve A B C }
`;

let browser;
/** The page of a desk. */
let desk;
before(async () => {
  // The page draws with the processor, three.js with what it takes for a graphics card.
  browser = await launch('webgl2', { free: true });
});
after(() => browser?.close());

/** Opens the dialog as a person does. */
async function show(sinew, size) {
  await sinew.click(size === 'phone' ? 'more' : 'download');
  await sinew.click('download mesh');
  await sinew.place('mesh view');
}

/** Waits until the mesh that was asked for is there, and gives what the page tells of it. */
async function made(sinew) {
  const { mesh } = await sinew.until(({ mesh }) => mesh && !mesh.running && (mesh.bytes || mesh.said));
  return mesh;
}

/** Saves the mesh, and gives the bytes of the file of a name; OBJ has a second file. */
async function save(sinew, name) {
  const predicate = (file) => file.suggestedFilename() === name;
  const coming = sinew.page.waitForEvent('download', { predicate, timeout: PATIENCE });
  await sinew.click('save mesh');
  return readFile(await (await coming).path());
}

/** Opens a text. */
async function open(sinew, text) {
  await sinew.load(text);
  await sinew.until(({ errors, elements, fresh }) => errors === 0 && elements > 0 && fresh);
}

/** What the page itself reads of a file: the triangles of a mesh. */
async function read(sinew, name, bytes) {
  await sinew.load(`surface s, diffuse Red\nmesh s ${name}\n`);
  await sinew.take({ [name]: bytes });
  const { elements, errors } = await sinew.until(({ fresh, elements }) => fresh && elements > 0);
  assert.equal(errors, 0);
  return elements;
}

/** Bytes of a mesh that a script asks for. */
async function mesh(sinew, order) {
  const base64 = await sinew.page.evaluate(async (order) => {
    const bytes = await sinew.mesh(order);
    let text = '';
    for (let i = 0; i < bytes.length; i += 4096) text += String.fromCharCode(...bytes.subarray(i, i + 4096));
    return btoa(text);
  }, order);
  return Buffer.from(base64, 'base64');
}

async function keep(page, name) {
  const path = join(process.env.SINEW_SCREENSHOTS, `${name}.png`);
  return decode(await page.screenshot({ path }));
}

for (const [size, options] of Object.entries(SIZES)) {
  test(`the dialog shows the mesh and saves it: ${size}`, async () => {
    const sinew = await browser.open({ size: SMALL, ...options });
    if (size === 'desk') desk = sinew;
    const { page } = sinew;
    await open(sinew, DROPS);
    await show(sinew, size);
    const first = await made(sinew);
    assert.equal(first.shown, first.triangles);
    assert.ok(first.triangles > 500, `${first.triangles} triangles`);
    assert.equal(first.bytes, 84 + 50 * first.triangles);
    await sinew.keep(`model ${size}`);
    const places = await page.evaluate(() => sinew.debug.rects());
    const { width, height } = options.viewport;
    for (const name of ['close mesh', 'mesh view', 'mesh size', 'mesh detail', 'mesh wireframe', 'save mesh']) {
      const place = places[name];
      const inside = place && place.x >= 0 && place.y >= 0 && place.x + place.w <= width + 1 && place.y + place.h <= height + 1;
      assert.ok(inside, `${name} is on the screen: ${JSON.stringify(place)}`);
    }
    const plain = await sinew.screen('mesh view');
    assert.ok(colours(plain) > 300, 'the mesh is shaded');

    // The triangles are seen, and the mesh turns under the pointer.
    const changes = (before) => until(() => sinew.screen('mesh view'), (now) => !now.data.equals(before.data));
    await sinew.click('mesh wireframe');
    await changes(plain);
    await sinew.keep(`model wires ${size}`);
    const { x, y, w, h } = places['mesh view'];
    const wires = await sinew.screen('mesh view');
    await page.mouse.move(x + w / 2, y + h / 2);
    await page.mouse.down();
    await page.mouse.move(x + w / 2 + 60, y + h / 2 + 30, { steps: 4 });
    await page.mouse.up();
    await changes(wires);

    // A lower detail gives fewer triangles; in the dark half of the slider.
    const slider = places['mesh detail'];
    await page.mouse.click(slider.x + 0.3 * slider.w, slider.y + slider.h / 2);
    await sinew.until(({ mesh }) => mesh.triangles && mesh.triangles < first.triangles);

    const saved = {};
    for (const format of ['STL', '3MF', 'GLB', 'OBJ', 'PLY']) {
      const before = (await sinew.status()).mesh;
      await sinew.click(`mesh format ${format}`);
      if (format !== 'STL') await sinew.until(({ mesh }) => mesh.bytes && mesh.bytes !== before.bytes);
      saved[format] = await save(sinew, `Main.${format.toLowerCase()}`);
    }
    const { triangles } = await made(sinew);
    assert.equal(saved.STL.readUInt32LE(80), triangles);
    assert.equal(saved['3MF'].subarray(0, 2).toString(), 'PK');
    assert.equal(saved.GLB.subarray(0, 4).toString(), 'glTF');
    assert.equal(saved.OBJ.toString().split('\n').filter((line) => line.startsWith('f ')).length, triangles);
    assert.match(saved.PLY.subarray(0, 400).toString(), new RegExp(`element face ${triangles}\n`));
    await sinew.click('close mesh');
    await sinew.until(({ mesh }) => mesh === null);
    assert.equal(await read(sinew, 'again.ply', saved.PLY), triangles);
    assert.deepEqual(sinew.troubles, []);
    if (size === 'phone') await sinew.close();
  });
}

test('a long mesh shows a coat first, leaves the page its frames, and is stopped', async () => {
  const sinew = desk;
  const { page } = sinew;
  await sinew.load(await example('seahorse'));
  await sinew.until(({ errors, elements }) => errors === 0 && elements > 40);
  await page.evaluate(() => sinew.cancel());
  await show(sinew, 'desk');
  await sinew.place('mesh progress');
  const { mesh: coat } = await sinew.until(({ mesh }) => mesh.shown > 0);
  assert.ok(coat.running && !coat.triangles, JSON.stringify(coat));
  // Were it made in the page's thread, there would be no frame until it is there.
  const frames = await page.evaluate(async () => {
    let frames = 0;
    while (frames < 20 && sinew.status().mesh.running) {
      await new Promise((done) => requestAnimationFrame(done));
      frames += 1;
    }
    return frames;
  });
  assert.equal(frames, 20);
  assert.ok(colours(await sinew.screen('mesh view')) > 300, 'the coat is shaded');
  await sinew.keep('model coat');
  await sinew.click('stop mesh');
  const { mesh: stopped } = await sinew.until(({ mesh }) => mesh.said);
  assert.match(stopped.said, /^Stopped/);
  await sinew.place('mesh again');
  await sinew.keep('model stopped');
  await sinew.click('mesh again');
  await sinew.until(({ mesh }) => mesh.running);
  await sinew.click('close mesh');
  await sinew.until(({ mesh }) => mesh === null);
  assert.deepEqual(sinew.troubles, []);
});

test('what cannot be meshed is told', async () => {
  const sinew = desk;
  await sinew.load('surface s, diffuse Red\n');
  await show(sinew, 'desk');
  const { said } = await made(sinew);
  assert.match(said, /no surface/);
  await sinew.keep('model nothing');
  const refusal = (order) => sinew.page.evaluate((order) => sinew.mesh(order).then(() => null, String), order);
  assert.match(await refusal({ tolerance: -1 }), /tolerance/);
  assert.match(await refusal({ format: 'stl', rig: true }), /Only GLB/);
  assert.match(await refusal({ format: 'glb', rig: true }), /no skeleton/);
  assert.deepEqual(sinew.troubles, []);
});

test('the seahorse as GLB is opened by three.js', async () => {
  const sinew = desk;
  await open(sinew, await example('seahorse'));
  const bytes = await mesh(sinew, { format: 'glb', tolerance: 4e-3, size: 80 });
  const other = await viewer(sinew);
  const model = await other.load(bytes);
  assert.ok(model.triangles > 1000, `${model.triangles}`);
  assert.ok(model.coloured, 'it has colours');
  // glTF's unit is the metre.
  assert.ok(Math.abs(Math.max(...model.size) - 0.08) < 1e-4, `${model.size}`);
  const picture = await keep(other.page, 'three seahorse');
  assert.ok(colours(picture) > 300, 'it is drawn');
  assert.deepEqual([...other.troubles, ...sinew.troubles], []);
  await other.page.close();
});

test('joints and motion are played by three.js', async () => {
  const sinew = desk;
  await open(sinew, ARM);
  await show(sinew, 'desk');
  const { bytes: stl } = await made(sinew);
  await sinew.click('mesh format GLB');
  const { mesh: plain } = await sinew.until(({ mesh }) => mesh.bytes && mesh.bytes !== stl);
  await sinew.click('mesh rig');
  await sinew.until(({ mesh }) => mesh.bytes > plain.bytes);
  await sinew.keep('model rig');
  const bytes = await save(sinew, 'Main.glb');
  const other = await viewer(sinew);
  const model = await other.load(bytes);
  assert.ok(model.skinned);
  assert.deepEqual(model.bones, ['still', 'skeleton1.1', 'skeleton1.2', 'skeleton1.3'].map((name) => name.replace('.', '')));
  // Two seconds of twelve frames.
  assert.equal(model.clips.length, 1);
  assert.ok(Math.abs(model.clips[0].duration - 23 / 12) < 1e-3, `${model.clips[0].duration}`);
  const rest = await other.at(0);
  // In frame 12 the hand is 3 units higher. The arm is 4.8 units long, which are 0.1 m.
  const later = await other.at(1);
  const unit = 0.1 / (Math.max(...rest.map(([x]) => x)) - Math.min(...rest.map(([x]) => x)));
  const span = (points, axis) => Math.max(...points.map((p) => p[axis])) - Math.min(...points.map((p) => p[axis]));
  assert.ok(Math.abs(unit - 1) < 1e-3, 'its longest side is 100 mm');
  const moves = rest.map((p, i) => Math.hypot(...p.map((x, k) => later[i][k] - x)));
  const most = rest.reduce((best, p, i) => (p[0] > rest[best][0] ? i : best), 0);
  const least = rest.reduce((best, p, i) => (p[0] < rest[best][0] ? i : best), 0);
  const length = span(rest, 0) / 4.8;
  assert.ok(moves[most] > 2 * length && moves[most] < 4 * length, `the hand rises: ${moves[most] / length}`);
  assert.ok(moves[least] < 0.4 * length, `the shoulder stays: ${moves[least] / length}`);
  await keep(other.page, 'three arm');
  // A bone that is moved by hand takes its vertices along, and no others.
  await other.at(0);
  const pushed = await other.push('skeleton13', [0, 0, 20]);
  const pulls = rest.map((p, i) => Math.hypot(...p.map((x, k) => pushed[i][k] - x)));
  assert.ok(pulls[most] > 0.012, `${pulls[most]} m`);
  assert.ok(pulls[least] < 0.002, `${pulls[least]} m`);
  assert.deepEqual([...other.troubles, ...sinew.troubles], []);
  await other.page.close();
});
