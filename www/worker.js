// A web worker that traces tiles. The page sends the compiled module first; from then on all
// messages are handled in Rust (crate/worker/src/entry.rs).
import { initSync, serve } from './tracer.js';

self.onmessage = ({ data }) => {
  initSync({ module: data });
  serve();
};
