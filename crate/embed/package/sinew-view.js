// <sinew-view src="model.rat" alt="A seahorse"></sinew-view>: a picture that can be turned.
//
// `src` is the address of a text; `files` names, apart by blanks, the files beside it that it reads. A text may
// stand inside the element instead. Drag or arrow keys turn it, wheel with Ctrl or + and - bring it nearer.
import { compile, turned, zoomed } from './sinew.js';

/** Share of the sides of a picture while it is being turned. */
const COARSE = 0.25;
/** Milliseconds without a key after which the picture is traced in full. */
const REST = 200;
/** Share of the view by which an arrow key turns. */
const STEP = 0.05;

const STYLE = `:host { display: block; position: relative; aspect-ratio: 4 / 3; overflow: hidden; touch-action: pan-y }
  canvas:focus-visible { outline: 3px solid Highlight; outline-offset: -3px }
  canvas { position: absolute; inset: 0; width: 100%; height: 100%; object-fit: contain; cursor: grab }
  p { position: absolute; inset: auto 0 0 0; margin: 0; padding: 0.4em 0.7em; font: 13px/1.4 system-ui, sans-serif;
    white-space: pre-wrap; color: #fff; background: #a3231fe0 }
  p:empty { display: none }`;

class SinewView extends HTMLElement {
  static observedAttributes = ['src', 'files', 'alt'];

  #canvas = document.createElement('canvas');
  #words = document.createElement('p');
  #model = null;
  #camera = null;
  #running = null;
  #dragging = null;
  /** Whether it is connected, and has begun to load. */
  #begun = false;
  /** Words about the text. */
  #mistake = '';
  /** Whether coarse pictures are being traced, and whether the camera has moved since the last was begun. */
  #following = false;
  #moved = false;
  #rest = undefined;
  #loading = null;
  #watch = new ResizeObserver(() => this.#draw());

  constructor() {
    super();
    const style = document.createElement('style');
    style.textContent = STYLE;
    this.#words.setAttribute('role', 'status');
    this.#canvas.setAttribute('role', 'img');
    this.#canvas.tabIndex = 0;
    this.attachShadow({ mode: 'open', delegatesFocus: true }).append(style, this.#canvas, this.#words);
    this.#canvas.addEventListener('pointerdown', (event) => this.#drag(event));
    this.addEventListener('keydown', (event) => this.#key(event));
    this.addEventListener('wheel', (event) => this.#wheel(event), { passive: false });
  }

  connectedCallback() {
    this.#begun = true;
    this.#watch.observe(this);
    this.#name();
    this.#load();
  }

  disconnectedCallback() {
    this.#begun = false;
    this.#watch.disconnect();
    clearTimeout(this.#rest);
    this.#dragging?.abort();
    this.#loading?.abort();
    this.#running?.abort();
    this.#model?.free();
    this.#model = null;
  }

  attributeChangedCallback(name) {
    if (!this.#begun) return;
    if (name === 'alt') this.#name();
    else this.#load();
  }

  /** The model that is shown, or null. */
  get model() {
    return this.#model;
  }

  /** The camera in use. */
  get camera() {
    return this.#camera;
  }

  set camera(camera) {
    this.#camera = camera && { ...this.#model?.camera, ...camera };
    this.#draw();
  }

  #name() {
    this.#canvas.setAttribute('aria-label', this.getAttribute('alt') ?? this.getAttribute('src') ?? 'Model');
  }

  #say(words) {
    this.#words.textContent = words;
  }

  async #load() {
    this.#loading?.abort();
    const { signal } = (this.#loading = new AbortController());
    try {
      const model = await compile(await this.#files(signal), { signal });
      if (signal.aborted) {
        model.free();
        return;
      }
      this.#running?.abort();
      if (this.#model) this.#camera = null;
      this.#model?.free();
      this.#model = model;
      if (this.#camera) this.#camera = { ...model.camera, ...this.#camera };
      const mistake = model.diagnostics.find(({ severity }) => severity === 'error');
      this.#mistake = mistake ? `${mistake.file}:${mistake.line}:${mistake.column}: ${mistake.message}` : '';
      this.#say(this.#mistake);
      this.dispatchEvent(new Event('load'));
      this.#draw();
    } catch (reason) {
      if (!signal.aborted) this.#fail(reason);
    }
  }

  /** The text and the files that it reads. */
  async #files(signal) {
    const src = this.getAttribute('src');
    const files = {};
    const fetched = async (address, name) => {
      const response = await fetch(address, { signal });
      if (!response.ok) throw new Error(`${name}: ${response.status}`);
      files[name] = new Uint8Array(await response.arrayBuffer());
    };
    let beside = document.baseURI;
    if (src) {
      beside = new URL(src, document.baseURI);
      await fetched(beside, decodeURIComponent(beside.pathname.split('/').pop()));
    } else {
      files['main.rat'] = this.textContent;
    }
    const names = (this.getAttribute('files') ?? '').split(/\s+/).filter(Boolean);
    await Promise.all(names.map((name) => fetched(new URL(name, beside), name)));
    return files;
  }

  #fail(reason) {
    this.#say(String(reason?.message ?? reason));
    this.dispatchEvent(new ErrorEvent('error', { error: reason, message: String(reason) }));
  }

  /** Traces the picture at the element's size; while it is being turned, coarsely. */
  async #draw(share = 1) {
    const model = this.#model;
    if (!model) return;
    this.#running?.abort();
    const { signal } = (this.#running = new AbortController());
    const { width, height } = model.size;
    const room = Math.min(this.clientWidth / width, this.clientHeight / height) * devicePixelRatio * share;
    const [w, h] = [width, height].map((side) => Math.max(1, Math.round(side * room)));
    const show = (image) => {
      if (signal.aborted) return;
      [this.#canvas.width, this.#canvas.height] = [image.width, image.height];
      this.#canvas.getContext('2d').putImageData(image, 0, 0);
    };
    try {
      const camera = this.#camera ?? undefined;
      show(await model.trace({ width: w, height: h, camera, signal, onPicture: show }));
      if (!signal.aborted) this.#say(this.#mistake);
      if (share === 1 && !signal.aborted) this.dispatchEvent(new Event('picture'));
    } catch (reason) {
      if (!signal.aborted) this.#fail(reason);
    }
  }

  /** Moves the camera, and draws what it sees: coarsely, and in full once it rests. */
  async #move(move) {
    if (!this.#model) return;
    const camera = await move(this.#camera ?? this.#model.camera);
    this.#camera = camera;
    this.#moved = true;
    clearTimeout(this.#rest);
    if (!this.#dragging) this.#rest = setTimeout(() => this.#settle(), REST);
    if (this.#following) return;
    this.#following = true;
    // One coarse picture is finished before the next is begun, or a slow one would never be seen.
    while (this.#moved && this.#begun) {
      this.#moved = false;
      await this.#draw(COARSE);
    }
    this.#following = false;
  }

  #settle() {
    this.#moved = false;
    this.#draw();
  }

  #drag(down) {
    if (down.button !== 0 || this.#dragging) return;
    this.#canvas.setPointerCapture(down.pointerId);
    let { clientX: x, clientY: y } = down;
    const ends = (this.#dragging = new AbortController());
    const on = (name, act) => {
      const own = (event) => event.pointerId === down.pointerId && act(event);
      this.#canvas.addEventListener(name, own, { signal: ends.signal });
    };
    ends.signal.addEventListener('abort', () => (this.#dragging = null));
    on('pointermove', ({ clientX, clientY }) => {
      const [across, along] = [(clientX - x) / this.clientWidth, (clientY - y) / this.clientHeight];
      [x, y] = [clientX, clientY];
      this.#move((camera) => turned(camera, across, along));
    });
    for (const name of ['pointerup', 'pointercancel']) {
      on(name, () => {
        ends.abort();
        this.#settle();
      });
    }
  }

  #key(event) {
    const turns = { ArrowLeft: [-STEP, 0], ArrowRight: [STEP, 0], ArrowUp: [0, -STEP], ArrowDown: [0, STEP] };
    const zooms = { '+': 0.9, '=': 0.9, '-': 1 / 0.9 };
    const { key } = event;
    if (event.ctrlKey || event.metaKey || event.altKey || !(key in turns || key in zooms)) return;
    event.preventDefault();
    this.#move((camera) => (key in turns ? turned(camera, ...turns[key]) : zoomed(camera, zooms[key])));
  }

  #wheel(event) {
    // Without Ctrl the page scrolls.
    if (!event.ctrlKey) return;
    event.preventDefault();
    this.#move((camera) => zoomed(camera, Math.exp(event.deltaY / 400)));
  }
}

customElements.define('sinew-view', SinewView);
