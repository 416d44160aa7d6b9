//! The entry point of a web worker that has the root finders for comparison.

use wasm_bindgen::prelude::*;
use worker::Engine;

/// Takes over the worker's messages; `www/digger_worker.js` calls it once.
///
/// # Errors
/// Outside a dedicated worker.
#[wasm_bindgen]
pub fn serve() -> Result<(), JsValue> {
    worker::entry::serve(Engine::new(crate::prepare))
}
