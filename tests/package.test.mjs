// The npm package in a page that is not ours: its example with three.js, and what its functions give.
import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { mkdtemp, readFile, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { promisify } from 'node:util';
import { PATIENCE, launch } from './page.mjs';
import { decode } from './pictures.mjs';
import { serve } from './server.mjs';

const THREE = new URL('node_modules/three/build/three.module.js', import.meta.url);
const CORE = new URL('node_modules/three/build/three.core.js', import.meta.url);
const TEXT = `light White Point, position 4 3 5
eyep 0 0 9
surface Flesh, diffuse Coral, specular Gray40, shine 30, blobbiness -2
cylinder Flesh 0.5, <-2 -0.5 0>, <0 0.3 0>
sphere Flesh 0.9, <0 0.9 0>
`;

let browser;
let server;
before(async () => {
  browser = await launch('webgl2');
  server = await serve(process.env.SINEW_PACKAGE);
});
after(async () => {
  server?.close();
  await browser?.close();
});

/** Opens a file of the package in a tab that reaches nothing but its folder, and three.js. */
async function open(file, options) {
  const tab = await browser.blank({ viewport: { width: 1000, height: 640 }, ...options });
  const troubles = [];
  tab.on('pageerror', (error) => troubles.push(String(error)));
  await tab.route('https://cdn.jsdelivr.net/**', async (route) => {
    const body = await readFile(route.request().url().endsWith('three.core.js') ? CORE : THREE);
    await route.fulfill({ contentType: 'text/javascript', body });
  });
  await tab.route('**/blank.html', (route) => route.fulfill({ contentType: 'text/html', body: '<!doctype html>' }));
  await tab.goto(server.address + file);
  return { tab, troubles };
}

test('the example shows a model as a picture, which turns, and as a mesh in three.js', async () => {
  for (const viewport of [{ width: 1000, height: 640 }, { width: 390, height: 844 }]) {
    const { tab, troubles } = await open('example.html', { viewport });
    await tab.evaluate(() => {
      globalThis.pictures = 0;
      document.querySelector('sinew-view').addEventListener('picture', () => (globalThis.pictures += 1));
    });
    await tab.waitForFunction(() => /\d triangles/.test(document.querySelector('#facts').textContent), undefined, { timeout: PATIENCE });
    await tab.waitForFunction(() => globalThis.pictures > 0, undefined, { timeout: PATIENCE });
    if (process.env.SINEW_SCREENSHOTS) {
      const path = join(process.env.SINEW_SCREENSHOTS, `package ${viewport.width}x${viewport.height}.png`);
      await tab.screenshot({ path });
    }
    const view = tab.locator('sinew-view');
    const shot = () => tab.evaluate(() => document.querySelector('sinew-view').shadowRoot.querySelector('canvas').toDataURL());
    const first = await shot();
    const seen = await tab.evaluate(() => globalThis.pictures);
    await view.focus();
    await tab.keyboard.press('ArrowLeft');
    await tab.waitForFunction((seen) => globalThis.pictures > seen, seen, { timeout: PATIENCE });
    assert.notEqual(await shot(), first);
    const eye = await tab.evaluate(() => document.querySelector('sinew-view').camera.eye);
    const { x, y, width, height } = await view.boundingBox();
    await tab.mouse.move(x + width / 2, y + height / 2);
    await tab.mouse.down();
    await tab.mouse.move(x + width / 2 + 60, y + height / 2, { steps: 3 });
    await tab.mouse.up();
    const moved = ([x]) => document.querySelector('sinew-view').camera.eye[0] !== x;
    await tab.waitForFunction(moved, eye, { timeout: PATIENCE });
    await tab.getByRole('img', { name: 'A ball that grows out of a bent limb' }).waitFor();
    assert.deepEqual(troubles, []);
    await tab.context().close();
  }
});

test('pictures are those of the program, meshes are closed, and the field is the threshold on them', async () => {
  const { tab, troubles } = await open('blank.html');
  const got = await tab.evaluate(async (text) => {
    const { compile, isoValue } = await import(new URL('./sinew.js', location.href));
    const model = await compile(text);
    const fractions = [];
    const image = await model.trace({ width: 96, height: 72, onProgress: ({ fraction }) => fractions.push(fraction) });
    const { parts, facts } = await model.mesh({ tolerance: 0.01 });
    const [{ positions, indices, colors, normals }] = parts;
    const glb = await model.file({ tolerance: 0.01 });
    return {
      ok: model.ok,
      elements: model.elements,
      pixels: Array.from(image.data),
      fractions,
      facts,
      parts: parts.length,
      positions: Array.from(positions),
      indices: Array.from(indices),
      lengths: [positions, normals ?? positions, colors].map(({ length }) => length),
      color: Array.from(colors.slice(0, 3)),
      values: Array.from(model.values(positions)),
      iso: await isoValue(),
      glb: Array.from(glb.slice(0, 12)),
      bytes: glb.length,
    };
  }, TEXT);
  assert.ok(got.ok && got.elements === 2 && got.parts === 1);
  const folder = await mkdtemp(join(tmpdir(), 'sinew-'));
  await writeFile(join(folder, 'model.rat'), TEXT);
  const out = join(folder, 'model.png');
  await promisify(execFile)(process.env.SINEW_PROGRAM, ['render', join(folder, 'model.rat'), '-o', out, '-r', '96', '72']);
  const { data } = decode(await readFile(out));
  await rm(folder, { recursive: true });
  assert.deepEqual(Buffer.from(got.pixels), Buffer.from(data));
  assert.ok(got.fractions.every((fraction) => fraction >= 0 && fraction <= 1));
  assert.equal(new Set(got.lengths).size, 1);
  const [red, green, blue] = got.color;
  assert.ok(red > green && green > blue, `coral: ${got.color}`);
  const sides = new Set();
  for (let i = 0; i < got.indices.length; i += 3) {
    for (let k = 0; k < 3; k += 1) {
      const side = `${got.indices[i + k]} ${got.indices[i + ((k + 1) % 3)]}`;
      assert.ok(!sides.has(side), 'a side has two triangles on one side');
      sides.add(side);
    }
  }
  for (const side of sides) assert.ok(sides.has(side.split(' ').reverse().join(' ')), 'the mesh is closed');
  assert.equal(got.facts.triangles, got.indices.length / 3);
  const most = Math.max(...got.values.map((value) => Math.abs(value / got.iso - 1)));
  assert.ok(most < 0.1, `the vertices are on the surface: ${most}`);
  assert.equal(Buffer.from(got.glb).toString('latin1', 0, 4), 'glTF');
  assert.equal(Buffer.from(got.glb).readUInt32LE(8), got.bytes);
  assert.deepEqual(troubles, []);
  await tab.context().close();
});

test('mistakes are told, work that is given up ends, and pictures follow each other', async () => {
  const { tab, troubles } = await open('blank.html');
  const got = await tab.evaluate(async (text) => {
    const { compile } = await import(new URL('./sinew.js', location.href));
    const said = async (work) => {
      try {
        await work();
        return null;
      } catch (reason) {
        return `${reason.name}: ${reason.message}`;
      }
    };
    const wrong = await compile('sphere nothing 1, <0 0 0>');
    const model = await compile({ 'main.rat': `read body.rat\n`, 'body.rat': text });
    const given = new AbortController();
    const slow = model.trace({ width: 2000, height: 1500, signal: given.signal });
    const [small, other] = [[8, 6], [16, 12]].map(([width, height]) => model.trace({ width, height }));
    given.abort();
    return {
      diagnostics: wrong.diagnostics,
      ok: [wrong.ok, model.ok],
      slow: await said(() => slow),
      sizes: [(await small).width, (await other).width],
      mesh: await said(async () => {
        const stop = new AbortController();
        const mesh = model.mesh({ tolerance: 1e-4, signal: stop.signal });
        stop.abort();
        await mesh;
      }),
      refused: [
        await said(() => compile({ 'a.exe': 'x' })),
        await said(() => compile({ 'a.rat': 5 })),
        await said(() => model.trace({ width: 1e5, height: 1e5 })),
        await said(() => model.file({ format: 'doc' })),
        await said(() => model.trace({ camera: { fov: 'wide' } })),
      ],
    };
  }, TEXT);
  assert.deepEqual(got.ok, [false, true]);
  const [{ severity, line, column, file, message }] = got.diagnostics;
  assert.deepEqual([severity, line, column, file], ['error', 1, 8, 'main.rat']);
  assert.match(message, /nothing/);
  assert.match(got.slow, /AbortError/);
  assert.match(got.mesh, /AbortError/);
  assert.deepEqual(got.sizes, [8, 16]);
  const words = [/a\.exe: Sinew takes/, /a file is a string/, /pixels/, /one of the endings/, /camera: /];
  got.refused.forEach((said, i) => assert.match(said ?? 'nothing was said', words[i]));
  assert.deepEqual(troubles, []);
  await tab.context().close();
});
