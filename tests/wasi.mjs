#!/usr/bin/env -S node --no-warnings
// Runs a program for WASI, which may read the files of the current folder: `node wasi.mjs FILE.wasm ARGUMENTS`.
import { readFile } from 'node:fs/promises';
import { WASI } from 'node:wasi';

const [file, ...args] = process.argv.slice(2);
const { env } = process;
const wasi = new WASI({ version: 'preview1', args: [file, ...args], env, preopens: { '.': '.' } });
const module = await WebAssembly.compile(await readFile(file));
const instance = await WebAssembly.instantiate(module, wasi.getImportObject());
// Not process.exit(): node may crash in it while it still compiles functions anew in the background.
process.exitCode = wasi.start(instance);
