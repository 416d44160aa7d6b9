// Serves the built page from a sub-path, as a static host would.
import { readFile } from 'node:fs/promises';
import { createServer } from 'node:http';
import { extname, join } from 'node:path';

const TYPES = {
  '.html': 'text/html; charset=utf-8',
  '.js': 'text/javascript; charset=utf-8',
  '.webmanifest': 'application/manifest+json',
  '.css': 'text/css; charset=utf-8',
  '.svg': 'image/svg+xml',
  '.png': 'image/png',
  '.wasm': 'application/wasm',
};

const PATH = '/some/where/';

/** Serves a folder; gives the page's address and a function that ends the server. */
export async function serve(folder) {
  const server = createServer(async (request, response) => {
    // `URL` resolves `..`, so nothing outside the folder can be asked for.
    const path = new URL(request.url, 'http://host').pathname;
    const name = path === PATH ? 'index.html' : path.slice(PATH.length);
    try {
      if (!path.startsWith(PATH)) throw new Error('outside');
      const bytes = await readFile(join(folder, name));
      response.writeHead(200, { 'Content-Type': TYPES[extname(name)] ?? 'application/octet-stream' });
      response.end(bytes);
    } catch {
      response.writeHead(404).end('Not found.');
    }
  });
  await new Promise((done) => server.listen(0, '127.0.0.1', done));
  return {
    address: `http://127.0.0.1:${server.address().port}${PATH}`,
    close() {
      server.closeAllConnections();
      server.close();
    },
  };
}
