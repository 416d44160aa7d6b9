// A mesh is read by the tools worker: its wasm is fetched then and not before, the page stays responsive, a
// broken file is a diagnostic, and the last good picture stays until then.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { launch } from './page.mjs';

/** Squares along a side of the sheet. */
const SIDE = 160;
const TRIANGLES = 2 * SIDE * SIDE;

const head = `eyep 0 -3 3
light White point, position 4 -5 6
surface sheet diffuse Coral
`;

/** A wavy sheet as an OBJ file of some megabytes. */
function obj() {
  const lines = [];
  for (let y = 0; y <= SIDE; y += 1) {
    for (let x = 0; x <= SIDE; x += 1) {
      const [u, v] = [(2 * x) / SIDE - 1, (2 * y) / SIDE - 1];
      lines.push(`v ${u.toFixed(9)} ${v.toFixed(9)} ${(0.1 * Math.sin(9 * u) * Math.cos(9 * v)).toFixed(9)}`);
    }
  }
  const at = (x, y) => 1 + x + y * (SIDE + 1);
  for (let y = 0; y < SIDE; y += 1) {
    for (let x = 0; x < SIDE; x += 1) {
      lines.push(`f ${at(x, y)} ${at(x + 1, y)} ${at(x + 1, y + 1)} ${at(x, y + 1)}`);
    }
  }
  return `${lines.join('\n')}\n`;
}

let browser;
before(async () => {
  browser = await launch();
});
after(async () => {
  await browser?.close();
});

test('a large mesh is read by the tools worker', async () => {
  const sinew = await browser.open();
  const fetched = [];
  sinew.page.on('request', (request) => fetched.push(new URL(request.url()).pathname.split('/').pop()));
  await sinew.load(`${head}sphere sheet 1 <0 0 0>\n`);
  await sinew.finished();
  assert.ok(!fetched.includes('tools_bg.wasm'), 'nothing needs it yet');
  const text = `${head}mesh sheet sheet.obj\n`;
  await sinew.page.evaluate(([text, mesh]) => sinew.take({ 'main.rat': text, 'sheet.obj': mesh }), [text, obj()]);
  await sinew.until(({ reading }) => reading === 'sheet.obj');
  const status = await sinew.finished();
  assert.ok(fetched.includes('tools_bg.wasm'));
  assert.equal(status.reading, null);
  assert.equal(status.errors, 0);
  assert.equal(status.elements, TRIANGLES);
  await sinew.keep('mesh');

  // A broken file: the picture stays, and the message says what is wrong.
  const broken = `${obj()}f 1 2 999999\n`;
  await sinew.page.evaluate((mesh) => sinew.take({ 'sheet.obj': mesh }), broken);
  const failed = await sinew.until(({ reading, errors }) => reading === null && errors === 1);
  assert.match(failed.diagnostics[0].message, /`999999` is none of the/);
  assert.ok(failed.picture, 'the last good picture stays');
  assert.deepEqual(sinew.troubles, []);
  await sinew.close();
});
