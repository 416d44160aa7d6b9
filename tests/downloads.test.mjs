// Files that the page gives: films that players play, and a whole work in one archive that the page takes back.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { after, before, test } from 'node:test';
import { PNG } from 'pngjs';
import { launch } from './page.mjs';

const SIZE = [64, 48];
const FRAMES = 8;
/** A ball that crosses the picture. */
const MODEL = `framesize 64 48
eyep 0 0 6
background White
light White point, position 4 6 8
surface ball, diffuse Red, ambient Red
var x = -1.2
var x += 0.3
sphere ball 0.6, x 0 0
`;

let browser;
let sinew;
before(async () => {
  browser = await launch();
  sinew = await browser.open({ size: SIZE });
  await sinew.load(MODEL);
  await sinew.click('film length');
  await sinew.page.keyboard.type(`${FRAMES}`);
  await sinew.page.keyboard.press('Enter');
});
after(async () => {
  await sinew?.close();
  await browser?.close();
});

/** Clicks through a menu and gives the file that comes: its name and bytes. */
async function download(menu, item) {
  await sinew.click(menu);
  const { x, y, w, h } = await sinew.place(item);
  const coming = sinew.page.waitForEvent('download', { timeout: 60_000 });
  await sinew.page.mouse.click(x + w / 2, y + h / 2);
  const file = await coming;
  return { name: file.suggestedFilename(), bytes: await readFile(await file.path()) };
}

/** Where the ball is in a picture: the middle of what is red, as a share of the width; null without. */
function middle({ width, data }) {
  let [sum, count] = [0, 0];
  for (let i = 0; i < data.length; i += 4) {
    if (data[i] > data[i + 1] + 60) {
      sum += (i / 4) % width;
      count += 1;
    }
  }
  return count ? sum / count / width : null;
}

/** Has the browser show a video at some seconds, and gives its length and its pictures. */
async function play(bytes, type, seconds) {
  // Sinew's own page plays nothing.
  const page = await sinew.page.context().newPage();
  const played = await page.evaluate(async ([base64, type, seconds]) => {
    const video = document.createElement('video');
    video.muted = true;
    const event = (name) => new Promise((resolve, reject) => {
      video.addEventListener(name, resolve, { once: true });
      video.addEventListener('error', () => reject(new Error(video.error.message)), { once: true });
    });
    const loaded = event('loadeddata');
    video.src = `data:${type};base64,${base64}`;
    await loaded;
    const [width, height] = [video.videoWidth, video.videoHeight];
    const canvas = new OffscreenCanvas(width, height);
    const context = canvas.getContext('2d', { willReadFrequently: true });
    const frames = [];
    for (const second of seconds) {
      // A frame may reach the video only after the seek has ended; one that was there already is not shown anew.
      const shown = new Promise((resolve) => { video.requestVideoFrameCallback(resolve); });
      const there = event('seeked');
      video.currentTime = second;
      await there;
      await Promise.race([shown, new Promise((resolve) => { setTimeout(resolve, 2000); })]);
      context.drawImage(video, 0, 0);
      frames.push({ width, data: Array.from(context.getImageData(0, 0, width, height).data) });
    }
    return { duration: video.duration, width, height, frames };
  }, [bytes.toString('base64'), type, seconds]);
  await page.close();
  return played;
}

test('a film is saved as pictures', async () => {
  const film = await download('save film', 'download png');
  assert.match(film.name, /-film\.png$/);
  assert.ok(film.bytes.includes('acTL'), 'it is animated');
  const first = PNG.sync.read(film.bytes);
  assert.deepEqual([first.width, first.height], SIZE);
  await sinew.finished();
  assert.ok(Math.abs(middle(first) - middle(await sinew.image())) < 0.01, 'it begins with the first frame');
  const gif = await download('save film', 'download gif');
  assert.equal(gif.bytes.subarray(0, 6).toString(), 'GIF89a');
  assert.ok(gif.bytes.includes('NETSCAPE'), 'it repeats');
});

for (const [format, type] of [['webm', 'video/webm'], ['mp4', 'video/mp4']]) {
  test(`a film is saved as ${format} and played`, async (t) => {
    await sinew.click('save film');
    await sinew.place('download gif');
    const places = await sinew.places();
    await sinew.page.keyboard.press('Escape');
    if (!places[`download ${format}`]) {
      t.skip(`${await browser.version()} encodes none`);
      return;
    }
    const film = await download('save film', `download ${format}`);
    const rate = 12;
    const at = [0, 2, 4, 7].map((frame) => (frame + 0.5) / rate);
    const played = await play(film.bytes, type, at);
    assert.deepEqual([played.width, played.height], SIZE);
    assert.ok(Math.abs(played.duration - FRAMES / rate) < 0.02, `${played.duration} s`);
    const middles = played.frames.map(middle);
    // As far to the right with each frame.
    const step = (middles[2] - middles[0]) / 4;
    assert.ok(step > 0.01, `it moves: ${middles}`);
    for (const [index, frame] of [2, 7].entries()) {
      const expected = middles[0] + frame * step;
      const found = middles[[1, 3][index]];
      assert.ok(Math.abs(found - expected) < 0.02, `frame ${frame}: ${found}, not ${expected}`);
    }
  });
}

test('saving a film can be stopped', async () => {
  await sinew.pictureSize(640, 480);
  await sinew.click('save film');
  await sinew.click('download gif');
  await sinew.place('stop film');
  await sinew.keep('film saving');
  await sinew.click('stop film');
  await sinew.place('slider frame');
  await sinew.resize(...SIZE);
});

test('a work is one archive, which the page takes back', async () => {
  const mesh = 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n';
  const texts = { 'main.rat': `${MODEL}read leg.rat\n`, 'leg.rat': '# a leg\n' };
  await sinew.page.evaluate((texts) => sinew.load(texts), texts);
  await sinew.page.evaluate((mesh) => sinew.take({ 'bone.obj': mesh }), mesh);
  await sinew.until(({ assets }) => assets.length === 1);
  await sinew.page.evaluate(() => sinew.setCamera({ ...sinew.camera(), eye: [1, 2, 5] }));
  const saved = await download('download', 'download project');
  assert.equal(saved.name, 'Main.zip');

  await sinew.load('# another work\n');
  await sinew.page.evaluate((base64) => {
    const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
    sinew.take({ 'Main.zip': bytes });
  }, saved.bytes.toString('base64'));
  await sinew.until(({ assets, name }) => assets.length === 1 && name === 'Main');
  assert.deepEqual(await sinew.page.evaluate(() => sinew.files()), texts);
  assert.deepEqual(await sinew.page.evaluate(() => sinew.camera().eye), [1, 2, 5]);
  assert.deepEqual(sinew.troubles, []);
});
