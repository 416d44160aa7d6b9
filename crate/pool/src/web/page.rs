//! The page that workers are started by: its timers, and the loading of wasm.

use js_sys::WebAssembly;
use std::sync::OnceLock;
use wasm_bindgen::prelude::*;
use wasm_bindgen_futures::JsFuture;
use web_sys::{Response, Window};

/// Milliseconds between two searches for hanging workers while something is being done.
const TICK: i32 = 120;

/// The folder of the workers' files.
static FOLDER: OnceLock<String> = OnceLock::new();

/// Sets the folder that holds the files of workers, an address that ends with a slash, before the
/// first crew is made. Without it they are beside the page. It is set once.
pub fn set_folder(address: &str) {
    let _ = FOLDER.set(String::from(address));
}

/// Returns the address of a file of workers.
pub fn address(file: &str) -> String {
    format!("{}{file}", FOLDER.get().map_or("./", |folder| folder))
}

/// Returns the page's window.
pub fn window() -> Option<Window> {
    web_sys::window()
}

/// Fetches and compiles a wasm module, a file of workers.
pub async fn load(wasm: &str) -> Result<WebAssembly::Module, JsValue> {
    let window = window().ok_or("no window")?;
    let response: Response = JsFuture::from(window.fetch_with_str(&address(wasm)))
        .await?
        .unchecked_into();
    if !response.ok() {
        return Err(format!("{wasm} could not be loaded: {}", response.status()).into());
    }
    // Not compileStreaming: it wants a MIME type that not every static host sends.
    let bytes = JsFuture::from(response.array_buffer()?).await?;
    Ok(JsFuture::from(WebAssembly::compile(&bytes))
        .await?
        .unchecked_into())
}

/// Calls a function every [`TICK`] until it is dropped.
pub struct Timer {
    id: i32,
    _callback: Closure<dyn FnMut()>,
}

impl Timer {
    /// Starts a timer; `None` if the browser refuses.
    pub fn new(callback: impl FnMut() + 'static) -> Option<Self> {
        let callback = Closure::<dyn FnMut()>::new(callback);
        let id = window()?
            .set_interval_with_callback_and_timeout_and_arguments_0(
                callback.as_ref().unchecked_ref(),
                TICK,
            )
            .ok()?;
        Some(Self {
            id,
            _callback: callback,
        })
    }
}

impl Drop for Timer {
    fn drop(&mut self) {
        if let Some(window) = window() {
            window.clear_interval_with_handle(self.id);
        }
    }
}
