// The page in a real browser: starting it, aiming at its widgets, asking its handle.
import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { mkdtemp, readFile, readdir, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
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
 * A browser of one kind and a server of the page. With `free` the page itself chooses what it draws with.
 */
export async function launch(kind, { free = false } = {}) {
  const asked = free ? '' : (ASKED[kind] ?? '');
  const browser = await chromium.launch({
    executablePath: setting('CHROMIUM'),
    args: ['--no-sandbox', ...KINDS[kind]],
  });
  const server = await serve(setting('SINEW_PAGE'));
  return {
    kind,
    version: () => browser.version(),
    /** Opens the page in a new profile. `fragment` ends the address; `before` may prepare the tab. */
    async open({ fragment = '', before, viewport = { width: 1200, height: 760 }, ...options } = {}) {
      const context = await browser.newContext({
        viewport,
        colorScheme: 'dark',
        permissions: ['clipboard-read', 'clipboard-write'],
        ...options,
      });
      const page = await context.newPage();
      await before?.(page);
      const sinew = new Sinew(page, kind);
      await sinew.goto(server.address + asked + fragment);
      return sinew;
    },
    async close() {
      await browser.close();
      server.close();
    },
  };
}

/** An open page. */
export class Sinew {
  /** What the page wrote to the console as errors, and exceptions. */
  troubles = [];

  constructor(page, kind) {
    this.page = page;
    this.kind = kind;
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
  }

  async reload() {
    await this.page.reload();
    await this.ready();
  }

  async close() {
    await this.page.context().close();
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
  async until(wanted, timeout = PATIENCE) {
    const deadline = Date.now() + timeout;
    for (;;) {
      const status = await this.status();
      if (wanted(status)) return status;
      assert.ok(Date.now() < deadline, `${wanted} never came true: ${JSON.stringify(status)}`);
      await this.page.waitForTimeout(50);
    }
  }

  /** The status when the picture of the present text is finished. */
  async finished() {
    return this.until((status) => status.fresh && status.phase === 'done');
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

  /** Fixes the size of the traced picture, and waits for such a picture to be finished. */
  async resize(width, height) {
    await this.page.evaluate(([w, h]) => sinew.debug.pictureSize(w, h), [width, height]);
    await this.until(({ picture }) => picture?.width === width && picture?.height === height);
    await this.finished();
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

  /** Where a widget is, in CSS pixels. */
  async place(name) {
    await this.page.waitForFunction((name) => sinew.debug.rects()[name], name, { timeout: 60_000 });
    return this.page.evaluate(async (name) => {
      const frame = () => new Promise((done) => requestAnimationFrame(done));
      const now = () => sinew.debug.rects()[name];
      let last = now();
      // In the frame in which a menu opens, or grows, its rows may be elsewhere than in the next one.
      for (let [still, frames] = [0, 0]; still < 3 && frames < 60; frames++) {
        await frame();
        const { x, y, w, h } = now() ?? last;
        still = x === last.x && y === last.y && w === last.w && h === last.h ? still + 1 : 0;
        last = { x, y, w, h };
      }
      return last;
    }, name);
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
