// A web worker that traces tiles with the root finders for comparison. The page sends the compiled
// module first; from then on all messages are handled in Rust (crate/worker/src/entry.rs).
import { initSync, serve } from './digger.js';

self.onmessage = ({ data }) => {
  initSync({ module: data });
  serve();
};
