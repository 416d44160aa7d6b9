// The editor that teaches, in a real browser: completing, renaming, laying out, the reference, and
// editing by hand in the picture.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { launch } from './page.mjs';

const TEXT = `framesize 200 160
eyep 0 0 8
light White point, position 4 3 5
surface Clay diffuse SandyBrown
sphere Clay 1, -1 0 0
sphere Clay 0.8, 1.5 0 0   # the second one
`;

let browser;
let sinew;
before(async () => {
  browser = await launch();
  sinew = await browser.open({ size: [200, 160] });
  await sinew.load(TEXT);
  await sinew.finished();
});
after(async () => {
  await sinew?.close();
  await browser?.close();
});

/** Puts the caret at the end of the text. */
async function toTheEnd() {
  const { x, y, w } = await sinew.place('editor');
  await sinew.page.mouse.click(x + w / 2, y + 60);
  await sinew.page.keyboard.press('Control+End');
}

/** Where a point of the world is on the screen, in CSS pixels. */
async function onScreen([x, y, z]) {
  const picture = await sinew.place('picture');
  // The eye is at 0 0 8, looking at 0 0 0, 45 degrees wide.
  const half = Math.tan(Math.PI / 8) * (8 - z);
  const across = x / half;
  const up = y / half;
  return [picture.x + (picture.w * (1 + across)) / 2, picture.y + picture.h / 2 - (picture.w * up) / 2];
}

const written = (wanted) => sinew.written((text) => text.includes(wanted));

test('a command is completed as it is typed', async () => {
  await toTheEnd();
  await sinew.page.keyboard.type('tor');
  await sinew.place('completions');
  await sinew.keep('completions');
  await sinew.page.keyboard.press('Enter');
  await written('\ntorus');
  await sinew.page.keyboard.type(' Cl');
  await sinew.place('completions');
  await sinew.page.keyboard.press('Tab');
  await written('torus Clay');
  await sinew.page.keyboard.type(' 2, 0.2, 0 0 0, ');
  await sinew.place('signature');
  await sinew.keep('signature');
  await sinew.page.keyboard.type('0 0 1\n');
  await sinew.until((status) => status.errors === 0);
});

test('a name is renamed wherever it stands', async () => {
  await sinew.load(TEXT);
  await sinew.finished();
  await toTheEnd();
  // Up to the last sphere, onto its material.
  await sinew.page.keyboard.press('ArrowUp');
  await sinew.page.keyboard.press('Home');
  for (let i = 0; i < 9; i++) await sinew.page.keyboard.press('ArrowRight');
  await sinew.page.keyboard.press('F2');
  await sinew.place('rename');
  await sinew.page.keyboard.press('Control+A');
  await sinew.page.keyboard.type('Flesh');
  await sinew.keep('rename');
  await sinew.page.keyboard.press('Enter');
  await written('surface Flesh');
  assert.equal(await sinew.text(), TEXT.replaceAll('Clay', 'Flesh'));
  await sinew.page.keyboard.press('Control+Z');
  await written('surface Clay');
  assert.equal(await sinew.text(), TEXT, 'one step back');
});

test('a click on the surface goes to its line, and its handle moves the numbers', async () => {
  await sinew.load(TEXT);
  await sinew.finished();
  await sinew.page.mouse.click(...(await onScreen([1.5, 0.3, 0.5])));
  const { x, y, w, h } = await sinew.place('hand the centre');
  await sinew.keep('chosen');
  await sinew.page.mouse.move(x + w / 2, y + h / 2);
  await sinew.page.mouse.down();
  await sinew.page.mouse.move(x + w / 2, y + h / 2 - 10, { steps: 4 });
  await sinew.page.mouse.move(x + w / 2, y + h / 2 - 40, { steps: 8 });
  await sinew.keep('dragging');
  await sinew.page.mouse.up();
  await sinew.still();
  const moved = await sinew.text();
  const line = moved.split('\n')[5];
  const numbers = /^sphere Clay 0.8, (\S+) (\S+) (\S+)   # the second one$/.exec(line);
  assert.ok(numbers, line);
  assert.ok(Math.abs(Number(numbers[1]) - 1.5) < 0.1, line);
  assert.ok(Number(numbers[2]) > 0.2, line);
  assert.equal(moved.split('\n').toSpliced(5, 1).join(), TEXT.split('\n').toSpliced(5, 1).join(), 'nothing else changed');
  await sinew.page.keyboard.press('Control+Z');
  await sinew.written((text) => text === TEXT);
});

test('the text is laid out anew', async () => {
  await sinew.load('object A\nsphere Clay 1,0 0 0\nclose\n');
  await sinew.click('lay out');
  await written('  sphere Clay 1, 0 0 0');
});

test('files that are dropped join the work', async () => {
  await sinew.load(TEXT);
  await sinew.page.evaluate(() => {
    const data = new DataTransfer();
    data.items.add(new File(['v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n'], 'corner.obj'));
    const canvas = document.querySelector('canvas');
    for (const kind of ['dragover', 'drop']) {
      canvas.dispatchEvent(new DragEvent(kind, { dataTransfer: data, bubbles: true, cancelable: true }));
    }
  });
  await sinew.place('tab corner.obj');
  await sinew.load(`${TEXT}mesh Clay corner.obj\n`);
  await sinew.keep('dropped');
});

test('the reference is there', async () => {
  const response = await sinew.page.request.get(new URL('reference.html', sinew.page.url()).href);
  assert.equal(response.status(), 200);
  const tab = await sinew.page.context().newPage();
  await tab.goto(new URL('reference.html#torus', sinew.page.url()).href);
  const link = await tab.locator('#torus a').first().getAttribute('href');
  assert.match(link, /^\.\/#/);
  await tab.close();
});

test('nothing went wrong on the way', () => {
  assert.deepEqual(sinew.troubles, []);
});
