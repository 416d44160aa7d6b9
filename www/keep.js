// Keeps the user's works. Their texts are in local storage, where a write is done before the page can be closed. What is large
// (undo steps, versions, images and meshes), and texts that local storage has no room for, are in IndexedDB. The program reads
// and writes without waiting: what is large is fetched before a work is opened. One tab writes a work: it holds a lock on it.

const CURRENT = 'sinew/current';
const DOCUMENT = 'sinew/document/';
const LARGE = ['history', 'versions', 'assets'].map((kind) => `sinew/${kind}/`);

/** Texts that are in IndexedDB, as far as they were fetched; without any storage, all of them. */
const texts = new Map();
let database = null;
let writes = 0;
/** Tells the program of something: its kind, and the work or a sentence that it is about. */
let tell = () => {};

const storage = (name) => {
  try {
    return globalThis[name];
  } catch {
    return null; // refused by the browser's settings
  }
};
const local = storage('localStorage');
const session = storage('sessionStorage');

const isLarge = (key) => LARGE.some((kind) => key.startsWith(kind));

const answer = (asked) =>
  new Promise((done, fail) => {
    asked.onsuccess = () => done(asked.result);
    asked.onerror = () => fail(asked.error);
  });

const objects = (mode) => database.transaction('texts', mode).objectStore('texts');

/** Opens the storage. Where the browser has no IndexedDB, local storage has to do. */
export async function open() {
  try {
    const asked = indexedDB.open('sinew', 1);
    asked.onupgradeneeded = () => asked.result.createObjectStore('texts');
    // It never answers in some browsers.
    const late = new Promise((_, fail) => setTimeout(fail, 3000, new Error('IndexedDB does not answer')));
    database = await Promise.race([answer(asked), late]);
    database.onclose = () => {
      database = null;
    };
    database.onversionchange = () => {
      database.close();
      database = null;
    };
    await move();
    const range = IDBKeyRange.bound(DOCUMENT, `${DOCUMENT}\uffff`);
    const [names, values] = await Promise.all([
      answer(objects('readonly').getAllKeys(range)),
      answer(objects('readonly').getAll(range)),
    ]);
    names.forEach((name, i) => {
      // Of two the younger one counts.
      if (saved(values[i]) > saved(local?.getItem(name))) texts.set(name, values[i]);
      else write(name);
    });
    const id = get(CURRENT);
    if (id) await fetchWork(id);
  } catch (reason) {
    console.warn('Works are kept in local storage only:', reason);
    database = null;
  }
}

/** The time at which a work was written, milliseconds since 1970. */
function saved(text) {
  return Number(/"saved":([\d.eE+]+)/.exec(text ?? '')?.[1] ?? 0);
}

/** Moves to IndexedDB what is large and was kept in local storage. */
async function move() {
  const large = Object.keys(local ?? {}).filter(isLarge);
  for (const key of large) {
    const value = local.getItem(key);
    await answer(objects('readwrite').put(value, key));
    if (local.getItem(key) === value) local.removeItem(key);
  }
}

/** Writes a text to IndexedDB, or removes it. */
function write(key, value, done) {
  const refuse = (reason) => {
    console.warn(key, reason);
    const what = key.startsWith(DOCUMENT) ? 'your latest changes' : 'all undo steps, versions, images and meshes of this work';
    tell('refused', `The browser's storage is full or refused, so ${what} live in this tab only. Delete old works, or save the project as a file.`);
  };
  try {
    const all = objects('readwrite');
    const order = all.transaction;
    writes += 1;
    order.oncomplete = () => {
      writes -= 1;
      done?.();
    };
    order.onabort = () => {
      writes -= 1;
      refuse(order.error);
    };
    if (value === undefined) all.delete(key);
    else all.put(value, key);
  } catch (reason) {
    refuse(reason);
  }
}

/** The text under a key. Each tab has a current work of its own; a new one begins with that of the last. */
export function get(key) {
  if (key === CURRENT) return session?.getItem(key) ?? local?.getItem(key) ?? undefined;
  return texts.get(key) ?? local?.getItem(key) ?? undefined;
}

/** Keeps a text. Throws where there is no room for it. */
export function set(key, value) {
  if (key === CURRENT) {
    for (const place of [session, local]) {
      try {
        place.setItem(key, value);
      } catch {
        // A start may open another work; nothing is lost.
      }
    }
    return;
  }
  if (database && isLarge(key)) {
    texts.set(key, value);
    write(key, value);
    return;
  }
  if (!local) {
    texts.set(key, value);
    if (database) write(key, value);
    return;
  }
  try {
    local.setItem(key, value);
    if (texts.delete(key) && database) write(key);
  } catch (reason) {
    if (!database || !key.startsWith(DOCUMENT)) throw reason;
    texts.set(key, value);
    channel?.postMessage({ key, value });
    // What was kept before stays until this is.
    write(key, value, () => local.removeItem(key));
  }
}

/** Forgets a key. */
export function remove(key) {
  local?.removeItem(key);
  texts.delete(key);
  if (database) write(key);
}

/** The keys, those of what is large as far as it was fetched. */
export function keys() {
  return [...new Set([...Object.keys(local ?? {}), ...texts.keys()])];
}

/** Whether something waits to be written. */
export function isWriting() {
  return writes > 0;
}

/** Whether what is kept outlives the page. */
export function lasts() {
  return Boolean(local || database);
}

/** Fetches what is large of a work, so that it can be read without waiting, and lets go of that of other works. */
export async function fetchWork(id) {
  if (!database) return;
  for (const key of texts.keys()) {
    if (isLarge(key) && !key.endsWith(`/${id}`)) texts.delete(key);
  }
  try {
    await Promise.all(
      LARGE.map(async (kind) => {
        const value = await answer(objects('readonly').get(kind + id));
        if (value === undefined) texts.delete(kind + id);
        else texts.set(kind + id, value);
      }),
    );
  } catch (reason) {
    tell('refused', `The undo steps, versions, images and meshes of this work could not be read: ${reason?.message ?? reason}`);
  }
}

const channel = globalThis.BroadcastChannel ? new BroadcastChannel('sinew') : null;
/** The work that this tab wants to write, and how to let go of it. */
let claimed = null;

/** Asks to be the only one who writes a work, and lets go of the one before. Tells `mine`, or `theirs` while another tab is. */
export function claim(id) {
  if (claimed?.has && claimed.id === id) {
    // The program was started anew in this tab.
    tell('mine', id);
    return;
  }
  claimed?.drop();
  claimed = null;
  if (id === undefined || !navigator.locks) return;
  const abort = new AbortController();
  // After a reload the page before may still hold it.
  const mine = { id, has: false, drop: () => abort.abort() };
  const timer = setTimeout(async () => {
    // A page that was busy finds the answer behind this question's.
    await navigator.locks.query().catch(() => {});
    if (claimed === mine && !mine.has) tell('theirs', id);
  }, 600);
  claimed = mine;
  hold(mine, timer, { signal: abort.signal });
}

/** Takes a lock, and holds it until the work is dropped. */
async function hold(mine, timer, options) {
  try {
    await navigator.locks.request(`sinew/${mine.id}`, options, () => {
      clearTimeout(timer);
      if (claimed !== mine) return undefined;
      mine.has = true;
      tell('mine', mine.id);
      return new Promise((done) => {
        mine.drop = done;
      });
    });
  } catch {
    // Another tab has stolen it, as this one did not answer; or it is not asked for any more.
    if (mine.has && claimed === mine) lose(mine.id);
  }
}

/** Lets another tab go on with a work. */
function lose(id) {
  claimed?.drop();
  claimed = null;
  tell('lost', id);
  claim(id);
}

/** Takes a work over from the tab that writes it. */
export function takeOver(id) {
  channel?.postMessage({ take: id });
  const mine = claimed;
  setTimeout(() => {
    if (!mine || mine.has || claimed !== mine) return;
    // That tab sleeps, or has stopped.
    mine.drop();
    hold(mine, 0, { steal: true });
  }, 1000);
}

channel?.addEventListener('message', ({ data }) => {
  if (data.take !== undefined && data.take === claimed?.id) lose(data.take);
  if (data.key !== undefined) texts.set(data.key, data.value);
});

/** Sets the function that is told of works and of what was refused. */
export function listen(listener) {
  tell = listener;
}
