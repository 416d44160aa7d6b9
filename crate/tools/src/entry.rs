//! Entry point of the tools worker: messages in, messages out.
//!
//! The script `www/tools_worker.js` receives the compiled module, instantiates it and calls
//! [`serve`]. From then on each message is one packed request, which is carried out to its end.

use crate::message::Answer;
use core::ops::ControlFlow;
use js_sys::{Array, Uint8Array};
use wasm_bindgen::prelude::*;
use web_sys::{DedicatedWorkerGlobalScope, MessageEvent};

/// Takes over the worker's messages. Called once by `www/tools_worker.js`.
///
/// # Errors
/// Outside a dedicated worker.
#[wasm_bindgen]
pub fn serve() -> Result<(), JsValue> {
    std::panic::set_hook(Box::new(|panic| {
        let message = panic.to_string();
        web_sys::console::error_1(&JsValue::from_str(&message));
        send(&Answer::Failed(message).to_bytes());
    }));
    let on_message = Closure::<dyn FnMut(MessageEvent)>::new(|event: MessageEvent| {
        let bytes = Uint8Array::new(&event.data()).to_vec();
        crate::serve(bytes, &mut |answer| {
            send(&answer);
            ControlFlow::Continue(())
        });
    });
    scope()?.set_onmessage(Some(on_message.as_ref().unchecked_ref()));
    on_message.forget(); // lives as long as the worker
    send(&Answer::Started.to_bytes());
    Ok(())
}

fn scope() -> Result<DedicatedWorkerGlobalScope, JsValue> {
    Ok(js_sys::global().dyn_into::<DedicatedWorkerGlobalScope>()?)
}

/// Sends a packed answer, giving its memory away. The page replaces a worker whose answer could not
/// be packed or sent, as it never comes.
fn send(answer: &[u8]) {
    if let Ok(scope) = scope() {
        let buffer = Uint8Array::from(answer).buffer();
        let _ = scope.post_message_with_transfer(&buffer, &Array::of1(&buffer));
    }
}
