// The page in a real browser: starting it, aiming at its widgets, asking its handle.
import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { mkdtemp, readFile, readdir, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { setTimeout } from 'node:timers/promises';
import { promisify } from 'node:util';
import { chromium } from 'playwright-core';
import { decode } from './pictures.mjs';
import { serve } from './server.mjs';

const setting = (name) => {
  const value = process.env[name];
  assert.ok(value, `${name} is not set: run the tests with cargo xtask test e2e`);
  return value;
};

/** Flags of browsers with WebGPU, drawn by software, with WebGL2 only, likewise, and with neither. */
export const KINDS = {
  // Without all of these, screenshots of WebGPU are blank.
  webgpu: ['--enable-unsafe-webgpu', '--use-angle=swiftshader', '--enable-features=Vulkan', '--use-vulkan=swiftshader'],
  webgl2: [],
  none: ['--disable-3d-apis'],
};

/** What is to be asked for, as the page would not draw with what is only pretended to be a graphics card. */
const ASKED = { webgl2: '?backend=webgl' };

/** How long a picture may take here, milliseconds: two slow cores, and a page drawn by software. */
export const PATIENCE = 180_000;

/**
 * A browser of one kind and a server of the page. With `free` the page itself chooses what it draws with. Without a kind the
 * processor draws the window: forty times as quick here as a graphics card that it pretends to be. What cards draw is tested
 * in the journey, and how the mesh of the surface stands in for the picture.
 */
export async function launch(kind = 'none', { free = false } = {}) {
  const asked = free ? '' : (ASKED[kind] ?? '');
  const browser = await chromium.launch({
    executablePath: setting('CHROMIUM'),
    args: ['--no-sandbox', ...KINDS[kind]],
  });
  const server = await serve(setting('SINEW_PAGE'));
  return {
    kind,
    /** Where the page is. */
    address: server.address,
    version: () => browser.version(),
    /** An empty tab in a new profile. */
    blank: async (options) => (await browser.newContext(options)).newPage(),
    /**
     * Opens the page in a new profile, at its own `address` or another one. `fragment` ends the address; `before` may prepare the tab. Pictures are traced at
     * `size`, small as few tests are about one; null: as large as the window shows them.
     */
    async open({
      fragment = '',
      before,
      size = [160, 120],
      viewport = { width: 1200, height: 760 },
      address = server.address,
      ...options
    } = {}) {
      const context = await browser.newContext({
        viewport,
        colorScheme: 'dark',
        permissions: ['clipboard-read', 'clipboard-write'],
        // It fetches all files; its own test allows it.
        serviceWorkers: 'block',
        ...options,
      });
      const page = await context.newPage();
      await before?.(page);
      const sinew = new Sinew(page, kind, size);
      await sinew.goto(address + asked + fragment);
      return sinew;
    },
    async close() {
      await browser.close();
      server.close();
    },
  };
}

/** Asks again and again, until the answer is as wanted, and gives it. */
export async function until(ask, wanted) {
  const deadline = Date.now() + PATIENCE;
  for (;;) {
    const answer = await ask();
    if (wanted(answer)) return answer;
    assert.ok(Date.now() < deadline, `${wanted} never came true: ${JSON.stringify(answer)?.slice(0, 2000)}`);
    await setTimeout(30);
  }
}

/** An open page. */
export class Sinew {
  /** What the page wrote to the console as errors, and exceptions. */
  troubles = [];

  constructor(page, kind, size = null) {
    this.page = page;
    this.kind = kind;
    this.size = size;
    page.on('pageerror', (error) => this.troubles.push(String(error)));
    page.on('console', (message) => {
      if (message.type() === 'error') this.troubles.push(message.text());
    });
  }

  async goto(address) {
    await this.page.goto(address);
    await this.ready();
  }

  async ready() {
    const isThere = () => Boolean(globalThis.sinew?.ready) || document.querySelector('#loading.failed');
    await this.page.waitForFunction(isThere, undefined, { timeout: PATIENCE });
    const failure = await this.page.evaluate(() => document.querySelector('#loading.failed')?.innerText);
    assert.equal(failure, undefined, 'the page could not start');
    await this.page.evaluate(() => sinew.ready);
    if (this.size) await this.pictureSize(...this.size);
  }

  async reload() {
    await this.page.reload();
    await this.ready();
  }

  async close() {
    await this.page.context().close();
  }

  /** Opens the page in another tab of the same profile. */
  async beside(before) {
    const page = await this.page.context().newPage();
    await before?.(page);
    const sinew = new Sinew(page, this.kind, this.size);
    await sinew.goto(new URL('.', this.page.url()).href);
    return sinew;
  }

  text() {
    return this.page.evaluate(() => sinew.text());
  }

  load(text) {
    return this.page.evaluate((text) => sinew.load(text), text);
  }

  /** Puts files beside the texts, as if they were dropped on the page, and waits until they are there and read. */
  async take(files) {
    const names = Object.keys(files);
    const encoded = names.map((name) => [name, Buffer.from(files[name]).toString('base64')]);
    await this.page.evaluate((encoded) => {
      const decode = (base64) => Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
      sinew.take(Object.fromEntries(encoded.map(([name, base64]) => [name, decode(base64)])));
    }, encoded);
    await this.until(({ assets, reading }) => names.every((name) => assets.includes(name)) && !reading);
  }

  status() {
    return this.page.evaluate(() => sinew.status());
  }

  link() {
    return this.page.evaluate(() => sinew.link());
  }

  /** Waits until the status is as wanted, and gives it. */
  until(wanted) {
    return until(() => this.status(), wanted);
  }

  /** Waits until the text of the first file is as wanted. */
  written(wanted) {
    return until(() => this.text(), wanted);
  }

  /** The status when the picture of the present text is finished, at the size that it is to have. */
  finished() {
    return this.until(({ fresh, phase, picture }) => {
      const [width, height] = this.size ?? [picture?.width, picture?.height];
      return fresh && phase === 'done' && picture.width === width && picture.height === height;
    });
  }

  /** The traced picture, decoded. */
  async image() {
    const base64 = await this.page.evaluate(async () => {
      const bytes = new Uint8Array(await (await sinew.image()).arrayBuffer());
      let text = '';
      for (let i = 0; i < bytes.length; i += 4096) {
        text += String.fromCharCode(...bytes.subarray(i, i + 4096));
      }
      return btoa(text);
    });
    return decode(Buffer.from(base64, 'base64'));
  }

  /** Fixes the size of the traced picture; without numbers it is as large as the window shows it. */
  pictureSize(...size) {
    this.size = size.length ? size : null;
    return this.page.evaluate(([width, height]) => sinew.debug.pictureSize(width, height), size);
  }

  /** Fixes the size of the traced picture, and waits for such a picture to be finished. */
  async resize(width, height) {
    await this.pictureSize(width, height);
    return this.finished();
  }

  /** Tells the page what a pen tells, events of a pointer and of the mouse, as Chromium's own tools make no pen events. */
  pen(type, [x, y], pressure) {
    return this.page.evaluate(
      ([type, x, y, pressure]) => {
        const about = { clientX: x, clientY: y, pressure, pointerType: 'pen', pointerId: 9, bubbles: true, isPrimary: true };
        const canvas = document.querySelector('canvas');
        canvas.dispatchEvent(new PointerEvent(type, about));
        if (type === 'pointermove') canvas.dispatchEvent(new MouseEvent('mousemove', about));
      },
      [type, x, y, pressure],
    );
  }

  /** Waits until the page has drawn what has come so far, and nothing in it moves. */
  still() {
    return this.page.evaluate(() => sinew.debug.still());
  }

  /** Waits for the page's next frame. */
  frame() {
    return this.page.evaluate(() => new Promise((done) => requestAnimationFrame(done)));
  }

  /** Where widgets are, in CSS pixels. */
  places() {
    return this.page.evaluate(() => sinew.debug.rects());
  }

  /** Where a widget is once it is there and no longer moves. */
  async place(name) {
    const deadline = Date.now() + 60_000;
    for (;;) {
      const place = await this.page.evaluate(async (name) => {
        if (!sinew.debug.rects()[name]) return null;
        await sinew.debug.still();
        return sinew.debug.rects()[name];
      }, name);
      if (place) return place;
      assert.ok(Date.now() < deadline, `there is no ${name}`);
      await setTimeout(30);
    }
  }

  /** Clicks the middle of a widget. */
  async click(name) {
    const { x, y, w, h } = await this.place(name);
    await this.page.mouse.click(x + w / 2, y + h / 2);
  }

  /** What the screen shows, all of it or one widget, decoded. */
  async screen(name) {
    let clip;
    if (name) {
      const { x, y, w, h } = await this.place(name);
      clip = { x, y, width: w, height: h };
    }
    return decode(await this.page.screenshot({ clip }));
  }

  /** Keeps a screenshot for people to look at. */
  async keep(name) {
    const path = join(setting('SINEW_SCREENSHOTS'), `${name}-${this.kind}.png`);
    await this.page.screenshot({ path });
  }
}

/** The picture that the program `sinew` draws of a text, decoded. `options` are further arguments, `files` what the text names: their bytes. */
export async function native(text, [width, height], options = [], files = {}) {
  const folder = await mkdtemp(join(tmpdir(), 'sinew-'));
  try {
    const [dataset, picture] = [join(folder, 'main.rat'), join(folder, 'main.png')];
    await writeFile(dataset, text);
    for (const [name, bytes] of Object.entries(files)) {
      await writeFile(join(folder, name), bytes);
    }
    await promisify(execFile)(setting('SINEW_PROGRAM'), [
      'render', dataset, '-o', picture, '-r', String(width), String(height), ...options,
    ]);
    return decode(await readFile(picture));
  } finally {
    await rm(folder, { recursive: true });
  }
}

const EXAMPLES = new URL('../www/examples/', import.meta.url);

/** The text of an example. */
export function example(name) {
  return readFile(new URL(`${name}.rat`, EXAMPLES), 'utf8');
}

/** The images and meshes that the text of an example names: their bytes. */
export async function filesOf(text) {
  const all = await readdir(EXAMPLES);
  const isThumbnail = (name) => name.endsWith('.png') && all.includes(name.replace(/png$/, 'rat'));
  const words = new Set(text.split(/[\s,"]+/));
  const named = all.filter((name) => words.has(name) && !name.endsWith('.rat') && !isThumbnail(name));
  const bytes = await Promise.all(named.map((name) => readFile(new URL(name, EXAMPLES))));
  return Object.fromEntries(named.map((name, i) => [name, bytes[i]]));
}
