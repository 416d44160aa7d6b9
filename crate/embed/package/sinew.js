// Sinew for other pages: models of texts, their pictures, meshes and fields. Types: sinew.d.ts.
//
//   import { compile } from 'sinew';
//   const model = await compile('surface s diffuse Gold blobbiness -1\nsphere s 1, <0 0 0>');
//   context.putImageData(await model.trace({ width: 320, height: 240 }), 0, 0);
import init, { Engine, iso_value, turn, zoom } from './embed.js';

/** Milliseconds between two looks at work that brings no news. */
const PAUSE = 100;

let starting;
/** What waits for news. */
const waiting = new Set();

function wake() {
  const all = [...waiting];
  waiting.clear();
  // Not at once: the program is still at the message that brought the news.
  for (const go of all) queueMicrotask(go);
}

function news(signal) {
  return new Promise((go) => {
    const once = () => {
      clearTimeout(timer);
      waiting.delete(once);
      signal?.removeEventListener('abort', once);
      go();
    };
    const timer = setTimeout(once, PAUSE);
    waiting.add(once);
    signal?.addEventListener('abort', once);
  });
}

/** Loads the program, once. Its files lie in a folder of the page's own origin: beside this one if none is named. */
export function load({ folder = new URL('.', import.meta.url) } = {}) {
  starting ??= (async () => {
    const place = new URL(folder, document.baseURI);
    if (!place.pathname.endsWith('/')) place.pathname += '/';
    await init({ module_or_path: new URL('embed_bg.wasm', place) });
    return new Engine(place.href, wake);
  })();
  starting.catch(() => {
    // The next call tries again.
    starting = undefined;
  });
  return starting;
}

/** Looks again and again until there is something, which is not undefined; a signal ends it. */
async function until(look, signal) {
  for (;;) {
    signal?.throwIfAborted();
    const there = look();
    if (there !== undefined) return there;
    await news(signal);
  }
}

const encoder = new TextEncoder();

async function bytesOf(content) {
  if (typeof content === 'string') return encoder.encode(content);
  if (content instanceof Blob) return new Uint8Array(await content.arrayBuffer());
  if (content instanceof ArrayBuffer) return new Uint8Array(content);
  if (ArrayBuffer.isView(content)) return new Uint8Array(content.buffer, content.byteOffset, content.byteLength);
  throw new TypeError('a file is a string, a Blob, an ArrayBuffer or a view of one');
}

/** Makes a model of a text, or of files by their names. */
export async function compile(files, { signal } = {}) {
  const all = Object.entries(typeof files === 'string' ? { 'main.rat': files } : files);
  const contents = await Promise.all(all.map(([, content]) => bytesOf(content)));
  const engine = await load();
  const inner = engine.open(all.map(([name]) => name), contents);
  const model = new Model(engine, inner);
  try {
    await model.settle(signal);
  } catch (reason) {
    model.free();
    throw reason;
  }
  return model;
}

/** The result of a promise, unless a signal comes first. */
function unless(signal, promise) {
  if (!signal) return promise;
  return new Promise((yes, no) => {
    const give = () => no(signal.reason);
    promise.then(yes, no).finally(() => signal.removeEventListener('abort', give));
    if (signal.aborted) give();
    else signal.addEventListener('abort', give);
  });
}

/** Pictures are traced one after the other. */
let last = Promise.resolve();

/** A model that a text makes. */
class Model {
  #engine;
  #inner;

  constructor(engine, inner) {
    this.#engine = engine;
    this.#inner = inner;
  }

  /** Waits until the text is compiled. */
  async settle(signal) {
    await until(() => this.#inner.tick() || undefined, signal);
    this.diagnostics = JSON.parse(this.#inner.diagnostics());
    this.ok = this.#inner.errors() === 0;
    this.elements = this.#inner.elements();
    this.animated = this.#inner.is_animated();
    const [width, height] = this.#inner.size();
    this.size = { width, height };
    this.camera = JSON.parse(this.#inner.camera());
  }

  /** Shows another frame of a film. */
  async frame(number, { signal } = {}) {
    this.#inner.set_frame(number);
    await this.settle(signal);
  }

  /** Traces a picture. */
  trace({ width = this.size.width, height = this.size.height, camera, signal, onProgress, onPicture } = {}) {
    const seen = camera && JSON.stringify({ ...this.camera, ...camera });
    const image = () => {
      const pixels = this.#engine.pixels();
      return pixels && new ImageData(new Uint8ClampedArray(pixels), width, height);
    };
    const trace = async () => {
      signal?.throwIfAborted();
      this.#engine.trace(this.#inner, width, height, seen);
      let told = -1;
      const look = () => {
        const progress = JSON.parse(this.#engine.look());
        if (progress.error) throw new Error(progress.error);
        if (progress.finished) return image();
        onProgress?.(progress);
        if (onPicture && progress.fraction > told) {
          const shown = image();
          if (shown) {
            told = progress.fraction;
            onPicture(shown);
          }
        }
        return undefined;
      };
      try {
        return await until(look, signal);
      } catch (reason) {
        this.#engine.cancel();
        throw reason;
      }
    };
    const traced = last.then(trace);
    last = traced.catch(() => {});
    return unless(signal, traced);
  }

  async #mesh(order, file, { signal, onProgress } = {}) {
    const meshing = this.#engine.mesh(this.#inner, JSON.stringify(order), file);
    try {
      await until(() => {
        if (meshing.look()) return true;
        onProgress?.({ fraction: meshing.fraction() });
        return undefined;
      }, signal);
      const facts = JSON.parse(meshing.facts());
      if (file) return meshing.file();
      const parts = meshing.names().map((name, part) => ({
        name,
        positions: new Float32Array(meshing.positions(part)),
        normals: meshing.normals(part) ?? null,
        colors: meshing.colors(part) ?? null,
        indices: new Uint32Array(meshing.indices(part)),
      }));
      return { parts, facts };
    } finally {
      // A mesh that is not there is given up by this.
      meshing.free();
    }
  }

  /** Makes a mesh. */
  mesh({ tolerance, union, prove, ...options } = {}) {
    return this.#mesh({ tolerance, union, prove }, false, options);
  }

  /** Makes a mesh's file. */
  file({ format = 'glb', tolerance, size, union, prove, ...options } = {}) {
    return this.#mesh({ format, tolerance, size, union, prove }, true, options);
  }

  /** Computes the field at points: x, y, z, x … */
  values(points) {
    return this.#inner.values(Float64Array.from(points));
  }

  /** Gives the model's memory back. */
  free() {
    this.#inner.free();
  }
}

/** The field's value at the surface. */
export async function isoValue() {
  await load();
  return iso_value();
}

/** Turns a camera about its target by shares of the picture's width and height. */
export async function turned(camera, across, down) {
  await load();
  return JSON.parse(turn(JSON.stringify(camera), across, down));
}

/** Brings a camera to a multiple of its distance from the target. */
export async function zoomed(camera, factor) {
  await load();
  return JSON.parse(zoom(JSON.stringify(camera), factor));
}
