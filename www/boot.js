// Loads the program, and says so in words if it cannot run. Nearly everything else is Rust.
import { open } from './keep.js';
import { renew } from './renew.js';
import init from './studio.js';

const loading = document.getElementById('loading');
const message = document.getElementById('message');

function fail(reason) {
  console.error(reason);
  loading.className = 'failed';
  message.textContent =
    `Sinew could not start: ${reason?.message ?? reason}\n` +
    'It needs a browser with WebAssembly SIMD (every one since 2023). What you wrote here before is kept.';
}

try {
  await open();
  await init();
  await window.sinew.ready;
  loading.className = 'done';
  setTimeout(() => loading.remove(), 300);
  // The first picture goes before files that are not needed yet.
  setTimeout(renew, 3000);
} catch (reason) {
  fail(reason);
}
