// Sculpting in the page: mouse, pen and touch; what is done becomes a text and is seen in the traced picture.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { launch, until as untilAnswer } from './page.mjs';
import { colours } from './pictures.mjs';

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser?.close());

const sculpture = (sinew) => sinew.page.evaluate(() => sinew.sculpture());
const strokes = (sinew) => sinew.page.evaluate(() => sinew.files()['sculpture.strokes']);

/** Waits until the sculpture is as wanted, and gives it. */
const until = (sinew, wanted) => untilAnswer(() => sculpture(sinew), wanted);

/** Begins with a ball, and gives the middle of the place. */
async function begin(sinew, narrow = false) {
  if (narrow) await sinew.click('more');
  await sinew.click('sculpt');
  await sinew.click('begin ball');
  await until(sinew, (now) => now?.name === 'sculpture.strokes');
  const { x, y, w, h } = await sinew.place('sculpture');
  await sinew.still();
  return { at: [x + w / 2, y + h / 2], side: Math.min(w, h) };
}

async function drag(sinew, [x, y], [dx, dy], steps = 6) {
  const { mouse } = sinew.page;
  await mouse.move(x, y);
  await sinew.still();
  await mouse.down();
  for (let i = 1; i <= steps; i += 1) {
    await mouse.move(x + (dx * i) / steps, y + (dy * i) / steps);
    await sinew.still();
  }
  await mouse.up();
}

test('mouse and keys pull, push, smooth and undo, and the picture shows it', async () => {
  const sinew = await browser.open({ viewport: { width: 1200, height: 760 } });
  const { page } = sinew;
  const { at, side } = await begin(sinew);
  assert.deepEqual((await sculpture(sinew)).counts, [10_002, 20_000]);
  const whole = await sinew.screen('sculpture');
  assert.ok(colours(whole) > 200, 'the ball is shaded');

  await drag(sinew, [at[0] + 0.1 * side, at[1] - 0.1 * side], [0.25 * side, -0.2 * side]);
  await until(sinew, ({ depth }) => depth[0] === 1);
  assert.match(await strokes(sinew), /^strokes 1\nstart sphere 50\npull sphere [\d. ]+ bell [\d.]+ : [-\d., ]+\n$/);
  await sinew.keep('sculpt pulled');

  await page.keyboard.press('p');
  await drag(sinew, [at[0] - 0.15 * side, at[1] + 0.05 * side], [0.1 * side, 0.15 * side]);
  await until(sinew, ({ depth }) => depth[0] === 2);
  await page.keyboard.down('Shift');
  await drag(sinew, [at[0] - 0.1 * side, at[1]], [0.1 * side, 0.05 * side]);
  await page.keyboard.up('Shift');
  await until(sinew, ({ depth }) => depth[0] === 3);
  const text = await strokes(sinew);
  assert.match(text, /\npush sphere .*\nsmooth sphere /);

  await page.keyboard.press('Control+z');
  await page.keyboard.press('Control+z');
  await until(sinew, ({ depth }) => depth[0] === 1 && depth[1] === 2);
  await page.keyboard.press('Control+Shift+z');
  await page.keyboard.press('Control+Shift+z');
  await until(sinew, ({ depth }) => depth[0] === 3);
  assert.equal(await strokes(sinew), text);

  // G grabs without a button; Escape gives it up.
  await page.mouse.move(at[0], at[1]);
  await sinew.still();
  await page.keyboard.press('g');
  await page.mouse.move(at[0] + 0.1 * side, at[1], { steps: 4 });
  await sinew.still();
  await page.keyboard.press('Escape');
  await sinew.still();
  assert.equal(await strokes(sinew), text);

  // Beside the mesh the view turns, which is no stroke; W shows the edges.
  await drag(sinew, [at[0] - 0.47 * side, at[1] - 0.45 * side], [0.2 * side, 0.1 * side]);
  await page.mouse.wheel(0, -200);
  await page.keyboard.press('w');
  await page.keyboard.press('d');
  await until(sinew, ({ counts }) => counts[1] === 80_000);
  await sinew.still();
  await sinew.keep('sculpt refined');
  assert.equal((await sculpture(sinew)).depth[0], 4);

  // Back in the editor the traced picture is of the same mesh.
  await sinew.click('sculpt back');
  await until(sinew, (now) => now === null);
  const status = await sinew.finished();
  assert.deepEqual([status.errors, status.elements], [0, 80_000]);
  assert.ok(colours(await sinew.image()) > 200, 'the sculpture is traced');
  await sinew.keep('sculpt traced');
  // The link carries the strokes.
  const link = await sinew.link();
  assert.ok(link.length < 2600, `${link.length} characters`);
  assert.deepEqual(sinew.troubles, []);
  await sinew.close();
});

test("a pen's pressure is written", async () => {
  const sinew = await browser.open({ viewport: { width: 1000, height: 700 } });
  const { page } = sinew;
  const { at, side } = await begin(sinew);
  await page.keyboard.press('p');
  const [x, y] = at;
  await page.mouse.move(x, y);
  await sinew.still();
  await sinew.pen('pointermove', [x, y], 0);
  await sinew.pen('pointerdown', [x, y], 0.25);
  for (let i = 1; i <= 5; i += 1) {
    await sinew.still();
    await sinew.pen('pointermove', [x + 0.04 * side * i, y], 0.25 + 0.1 * i);
  }
  await sinew.still();
  await sinew.pen('pointerup', [x + 0.2 * side, y], 0);
  await until(sinew, ({ depth }) => depth[0] === 1);
  const line = (await strokes(sinew)).split('\n')[2];
  const points = line.split(' : ')[1].split(', ').map((point) => point.split(' ').map(Number));
  const pressures = points.map((point) => point[3] ?? 1);
  assert.ok(pressures[0] >= 0.2 && pressures[0] <= 0.3, line);
  assert.ok(Math.max(...pressures) > 0.5 && Math.max(...pressures) <= 0.8, line);
  assert.deepEqual(sinew.troubles, []);
  await sinew.close();
});

test('a finger sculpts and two fingers turn, on a phone', async () => {
  const sinew = await browser.open({ viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true });
  const { page } = sinew;
  const { at, side } = await begin(sinew, true);
  const cdp = await page.context().newCDPSession(page);
  const touch = async (type, points) => {
    await cdp.send('Input.dispatchTouchEvent', {
      type,
      touchPoints: points.map(([x, y], id) => ({ x, y, id })),
    });
    if (type === 'touchMove') await sinew.still();
  };
  const [x, y] = at;
  await touch('touchStart', [[x, y]]);
  for (let i = 1; i <= 5; i += 1) await touch('touchMove', [[x + 0.05 * side * i, y - 0.04 * side * i]]);
  await touch('touchEnd', []);
  await until(sinew, ({ depth }) => depth[0] === 1);
  await sinew.still();
  await sinew.keep('sculpt phone');

  const before = await sinew.page.screenshot();
  // One soon after the other, however slow the frames are.
  await Promise.all([touch('touchStart', [[x - 60, y]]), touch('touchStart', [[x - 60, y], [x + 60, y]])]);
  for (let i = 1; i <= 5; i += 1) await touch('touchMove', [[x - 60 - 6 * i, y + 5 * i], [x + 60 + 6 * i, y + 5 * i]]);
  await touch('touchEnd', []);
  await sinew.still();
  assert.equal((await sculpture(sinew)).depth[0], 1, 'two fingers make no stroke');
  assert.ok(!before.equals(await sinew.page.screenshot()), 'they turn and zoom');
  await sinew.click('sculpt more');
  await sinew.still();
  await sinew.keep('sculpt phone more');
  const places = await sinew.page.evaluate(() => sinew.debug.rects());
  for (const name of ['sculpt back', 'sculpt undo', 'sculpt more', 'sculpt pull', 'sculpture']) {
    const place = places[name];
    assert.ok(place && place.x >= 0 && place.x + place.w <= 391, `${name}: ${JSON.stringify(place)}`);
  }

  await page.keyboard.press('Escape');
  await sinew.click('sculpt back');
  await until(sinew, (now) => now === null);
  const status = await sinew.finished();
  assert.deepEqual([status.errors, status.elements], [0, 20_000]);
  assert.ok(colours(await sinew.image()) > 200, 'the sculpture is traced');
  await sinew.keep('sculpt phone traced');
  assert.deepEqual(sinew.troubles, []);
  await sinew.close();
});

test('the model becomes clay and comes back: one undo; flesh grows on it and it is fitted to points', async () => {
  // High enough for all of the place's panel.
  const sinew = await browser.open({ viewport: { width: 1280, height: 1100 } });
  const { page } = sinew;
  const text = `eyep 0 0 9
vrp 0 0 0
fov 34
framesize 320 240
light White point, position 4 6 8
surface flesh diffuse SummerSky, blobbiness -1.5
sphere flesh 0.8, -0.8 0 0
sphere flesh 0.6, 0.9 0.3 0
`;
  await sinew.load(text);
  await sinew.finished();
  const { name } = await sinew.status();
  await sinew.click('sculpt');
  await sinew.click('begin coarse');
  await sinew.click('begin this');
  const { counts } = await until(sinew, (now) => now?.name === 'sculpture.strokes');
  assert.ok(counts[1] > 7000 && counts[1] < 16_000, `${counts}`);
  const seen = await sinew.page.evaluate(() => sinew.files()['main.rat']);
  assert.match(seen, /^framesize 320 240\neyep 0 0 9\nvrp 0 0 0\nvup 0 1 0\nfov 34\n/m, 'seen as the model was');
  assert.match(await strokes(sinew), /^strokes 1\nstart file model\.ply\n$/);
  const { x, y, w, h } = await sinew.place('sculpture');
  const [at, side] = [[x + w / 2, y + h / 2], Math.min(w, h)];
  await sinew.still();
  await drag(sinew, at, [0.1 * side, -0.2 * side]);
  await until(sinew, ({ depth }) => depth[0] === 1);
  const pulled = await strokes(sinew);
  await sinew.keep('sculpt this');

  // Back beyond the first stroke is the model, forth is the clay.
  await page.keyboard.press('Control+z');
  await until(sinew, (now) => now?.depth[0] === 0);
  await page.keyboard.press('Control+z');
  await until(sinew, (now) => now === null);
  await sinew.until(({ elements, errors }) => elements === 2 && errors === 0);
  assert.equal(await sinew.text(), text);
  assert.equal((await sinew.status()).name, name);
  await sinew.finished();
  await sinew.keep('sculpt this undone');
  await page.keyboard.press('Control+Shift+z');
  await page.keyboard.press('Control+Shift+z');
  await untilAnswer(() => strokes(sinew), (now) => now === pulled);
  await sinew.until(({ elements }) => elements > 200);

  // Flesh grows on it, in the same history.
  await sinew.click('sculpt');
  await until(sinew, (now) => now?.name === 'sculpture.strokes');
  const clay = await sinew.page.evaluate(() => sinew.files()['main.rat']);
  await sinew.click('sculpt metaballs');
  await page.waitForFunction((clay) => sinew.files()['main.rat'] !== clay, clay);
  assert.match(await page.evaluate(() => sinew.files()['main.rat']), /mesh Clay sculpture\.strokes metaballs/);
  await sinew.click('sculpt a hard mesh');
  await page.waitForFunction((clay) => sinew.files()['main.rat'] === clay, clay);

  // Fitted: the clay's own vertices, moved, are what was measured.
  await sinew.click('sculpt fit this to points');
  await until(sinew, (now) => now === null);
  await sinew.place('fit panel');
  const moved = await page.evaluate(async () => {
    const bytes = new Uint8Array(await sinew.mesh({ format: 'obj', tolerance: 0.01, size: 0 }));
    const lines = new TextDecoder().decode(bytes).split('\n').filter((line) => line.startsWith('v '));
    return lines.map((line) => line.split(/\s+/).slice(1, 4).map(Number));
  });
  assert.ok(moved.length > 100, `${moved.length} vertices`);
  const size = [0, 1, 2].map((i) => Math.max(...moved.map((p) => p[i])) - Math.min(...moved.map((p) => p[i])));
  const points = moved.map(([a, b, c]) => `${a + (0.06 * c) / size[2]} ${b} ${c}`).join('\n');
  await page.evaluate((points) => sinew.take({ 'scan.xyz': points }), `${points}\n`);
  await sinew.until(({ fit }) => fit?.points === moved.length);
  const before = await page.evaluate(() => sinew.files()['main.rat']);
  await sinew.click('fit start');
  const { fit, errors } = await sinew.until(({ fit }) => fit.iteration > 0 && !fit.running);
  assert.deepEqual([fit.said, errors], ['Done.', 0]);
  assert.match(await page.evaluate(() => sinew.files()['main.rat']), /mesh Clay sculpture\.strokes\ndeform \{/);
  await sinew.finished();
  await sinew.keep('sculpt fitted');
  await sinew.click('undo');
  await page.waitForFunction((before) => sinew.files()['main.rat'] === before, before);
  assert.deepEqual(sinew.troubles, []);
  await sinew.close();
});
