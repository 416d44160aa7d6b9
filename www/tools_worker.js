// A web worker that runs tools, such as reading a mesh. The page sends the compiled module first; from then on
// all messages are handled in Rust (crate/tools/src/entry.rs).
import { initSync, serve } from './tools.js';

self.onmessage = ({ data }) => {
  initSync({ module: data });
  serve();
};
