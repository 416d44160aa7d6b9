#!/usr/bin/env -S node --no-warnings
// Runs a program for WASI, which may read the files of the current folder: `node wasi.mjs FILE.wasm ARGUMENTS`.
//
// The program runs in a process of its own that tells its exit status and is then killed: node may
// crash at its end while it still compiles functions anew in the background. Nor does it always see
// what moves when it collects garbage below a long-running program (20.20: `this` of `wasi.start` is
// stale after it), therefore all that is young is made old before the program starts.
import { fork } from 'node:child_process';
import { readFile } from 'node:fs/promises';
import { WASI } from 'node:wasi';

const [file, ...args] = process.argv.slice(2);
if (process.send) {
  const { env } = process;
  const wasi = new WASI({ version: 'preview1', args: [file, ...args], env, preopens: { '.': '.' } });
  const module = await WebAssembly.compile(await readFile(file));
  const instance = await WebAssembly.instantiate(module, wasi.getImportObject());
  globalThis.gc();
  globalThis.gc();
  process.send(wasi.start(instance));
} else {
  const child = fork(process.argv[1], [file, ...args], {
    execArgv: [...process.execArgv, '--expose-gc'],
  });
  let status;
  child.on('message', (told) => {
    status = told;
    child.kill('SIGKILL');
  });
  child.on('exit', (code, signal) => {
    if (status === undefined) console.error(`${file} ended early (${signal ?? `status ${code}`}).`);
    process.exitCode = status ?? 1;
  });
}
