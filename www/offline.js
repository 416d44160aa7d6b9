// The service worker: it keeps the files of the page in the browser, so that all of it works without a net after the first
// visit. A release writes the list of its files below; with an empty list (`cargo xtask serve`) the worker removes itself.

/** Checksums of the page's files, by their paths. */
const FILES = {};

const CACHE = 'sinew';

/** Files that are fetched at the same time. */
const AT_ONCE = 6;

/** The address under which a file is kept. A file that did not change has the same one in the next release. */
const address = (path) => new URL(`${path}?${FILES[path]}`, registration.scope).href;

/** Fetches the files that are not kept yet. If one is missing, the release before stays. */
async function fetchFiles() {
  const cache = await caches.open(CACHE);
  const paths = Object.keys(FILES);
  const fetchNext = async () => {
    for (let path = paths.pop(); path !== undefined; path = paths.pop()) {
      if (await cache.match(address(path))) continue;
      const asked = path === 'index.html' ? './' : path;
      const response = await fetch(asked, { cache: 'no-cache' });
      if (!response.ok) throw new Error(`${path}: ${response.status}`);
      // A new response, as one that was redirected may not be shown as a page.
      const headers = { 'Content-Type': response.headers.get('Content-Type') ?? '' };
      await cache.put(address(path), new Response(response.body, { headers }));
    }
  };
  await Promise.all(Array.from({ length: AT_ONCE }, fetchNext));
}

/** Forgets the files of other releases. */
async function tidy() {
  const cache = await caches.open(CACHE);
  const wanted = new Set(Object.keys(FILES).map(address));
  const kept = await cache.keys();
  await Promise.all(kept.filter(({ url }) => !wanted.has(url)).map((request) => cache.delete(request)));
  await clients.claim();
}

async function remove() {
  await caches.delete(CACHE);
  await registration.unregister();
}

const isRelease = Object.keys(FILES).length > 0;

addEventListener('install', (event) => event.waitUntil(isRelease ? fetchFiles() : skipWaiting()));

addEventListener('activate', (event) => event.waitUntil(isRelease ? tidy() : remove()));

addEventListener('message', ({ data }) => {
  if (data === 'renew') skipWaiting();
});

addEventListener('fetch', (event) => {
  const { request } = event;
  const { origin, pathname } = new URL(request.url);
  const scope = new URL(registration.scope);
  if (request.method !== 'GET' || origin !== scope.origin || !pathname.startsWith(scope.pathname)) return;
  const path = pathname.slice(scope.pathname.length) || 'index.html';
  if (Object.hasOwn(FILES, path)) event.respondWith(answer(request, path));
});

async function answer(request, path) {
  const cache = await caches.open(CACHE);
  return (await cache.match(address(path))) ?? fetch(request);
}
