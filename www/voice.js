// Elements over the canvas that tell assistive technology what is painted there, with name, role, state and place, and hand on
// what is done with them. They are seen by nobody, and the pointer goes through them.

const FIELD = '\u001f';
const ELEMENT = '\u001e';
const TAGS = { textarea: 'textarea', textbox: 'input', slider: 'input', spinbutton: 'input', text: 'span', dialog: 'div', img: 'div', progressbar: 'div' };

/** The elements by their numbers. */
const elements = new Map();
let act = () => {};
let layer = null;

function makeLayer() {
  layer = document.createElement('div');
  layer.id = 'voice';
  document.querySelector('#canvas').after(layer);
  // The field that takes the keys for the canvas.
  for (const field of document.querySelectorAll('body > input')) field.setAttribute('aria-label', 'Keys for the page');
}

/** Sets the function that is told what is done with an element: its number, the deed, and a value. */
export function listenToElements(listener) {
  act = listener;
}

function make(id, role) {
  const element = document.createElement(TAGS[role] ?? 'button');
  element.id = `voice-${id}`;
  element.tabIndex = -1;
  if (role === 'slider') element.type = 'range';
  else if (role === 'spinbutton') element.type = 'number';
  else if (role === 'textbox') element.type = 'text';
  else if (element.tagName === 'BUTTON') element.type = 'button';
  if (role === 'textarea') element.spellcheck = false;
  else if (!['button', 'text', 'textbox', 'slider', 'spinbutton', 'combobox', 'option', 'tab', 'menuitem'].includes(role)) element.setAttribute('role', role);
  if (element.tagName === 'INPUT' || element.tagName === 'TEXTAREA') {
    element.addEventListener('input', () => act(String(id), role === 'slider' || role === 'spinbutton' ? 'number' : 'text', element.value));
    element.addEventListener('focus', () => act(String(id), 'focus', ''));
  } else if (element.tagName === 'BUTTON') {
    element.addEventListener('click', () => act(String(id), 'click', ''));
    element.addEventListener('focus', () => act(String(id), 'focus', ''));
  }
  // Keys are typed here or there, not in both.
  for (const name of ['keydown', 'keyup', 'keypress', 'beforeinput', 'paste', 'cut', 'copy']) {
    element.addEventListener(name, (event) => event.stopPropagation());
  }
  return element;
}

const set = (element, name, value) => {
  if (value === null) element.removeAttribute(name);
  else if (element.getAttribute(name) !== value) element.setAttribute(name, value);
};

function update(element, role, [name, value, low, high, state], [x, y, w, h]) {
  Object.assign(element.style, { left: `${x}px`, top: `${y}px`, width: `${w}px`, height: `${h}px` });
  if (role === 'text') {
    const text = value || name;
    if (element.textContent !== text) element.textContent = text;
  } else {
    set(element, 'aria-label', role === 'textarea' ? 'Text of the model' : name || (role === 'dialog' ? 'Window' : value || role));
    if (role === 'spinbutton') set(element, 'step', 'any');
    if (role === 'slider') {
      set(element, 'min', low || '0');
      set(element, 'max', high || '1');
      set(element, 'step', 'any');
    }
    if ('value' in element && element.tagName !== 'BUTTON') {
      if (element.value !== value) element.value = value;
    } else if (role === 'progressbar') {
      set(element, 'aria-valuenow', value || '0');
    } else if (role === 'combobox') {
      set(element, 'aria-label', `${name} ${value}`.trim());
    }
  }
  if ('disabled' in element) element.disabled = state.includes('d');
  const toggled = { t: 'true', f: 'false', m: 'mixed' }[state.replace(/[dl]/g, '')] ?? null;
  if (role === 'checkbox' || role === 'radio') set(element, 'aria-checked', toggled ?? 'false');
  else if (element.tagName === 'BUTTON') set(element, 'aria-pressed', toggled);
  set(element, 'aria-live', state.includes('l') ? 'polite' : null);
  if (role === 'dialog') set(element, 'aria-modal', 'true');
}

/** Brings the elements up to date with a description (crate/browser/src/voice.rs). */
export function showElements(text) {
  if (!layer?.isConnected) makeLayer();
  const [focus, ...lines] = text.split(ELEMENT);
  const seen = new Set();
  /** Places of the dialogs, as places of elements count from them. */
  const corners = new Map();
  /** The element behind which the next one of each parent stands. */
  const last = new Map();
  for (const line of lines) {
    if (!line) continue;
    const [id, dialog, role, ...fields] = line.split(FIELD);
    const key = `${id} ${role}`;
    if (seen.has(key)) continue;
    seen.add(key);
    let element = elements.get(key);
    if (!element) {
      element = make(id, role);
      elements.set(key, element);
    }
    const [x, y, w, h] = fields.splice(5).map(Number);
    const [left, top] = corners.get(dialog) ?? [0, 0];
    if (role === 'dialog') corners.set(id, [x, y]);
    update(element, role, fields, [x - left, y - top, w, h]);
    const parent = elements.get(`${dialog} dialog`) ?? layer;
    const before = last.get(parent);
    const place = before ? before.nextSibling : parent.firstChild;
    if (element !== place || element.parentNode !== parent) parent.insertBefore(element, place);
    last.set(parent, element);
  }
  for (const [key, element] of elements) {
    if (seen.has(key)) continue;
    element.remove();
    elements.delete(key);
  }
  const canvas = document.querySelector('#canvas');
  set(canvas, 'aria-activedescendant', document.getElementById(`voice-${focus}`) ? `voice-${focus}` : null);
}
