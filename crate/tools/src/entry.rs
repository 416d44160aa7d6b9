//! Entry point of the tools worker: messages in, messages out.
//!
//! The script `www/tools_worker.js` receives the compiled module, instantiates it and calls [`serve`].
//! From then on each message is one packed [`Request`], which is run to its end.

use crate::job::{Progress, run};
use crate::message::{Answer, Request, pack, unpack};
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
        send(&Answer::Failed(message));
    }));
    let on_message = Closure::<dyn FnMut(MessageEvent)>::new(|event: MessageEvent| {
        let bytes = Uint8Array::new(&event.data()).to_vec();
        let Ok(Request { id, job }) = unpack(&bytes) else {
            send(&Answer::Failed(String::from(
                "page and worker are of different versions; reload the page",
            )));
            return;
        };
        drop(bytes);
        let mut report = |fraction| send(&Answer::Progress { id, fraction });
        let mut pass = |output| send(&Answer::Partial { id, output });
        let result = run(job, &mut Progress::new(&mut report).passing(&mut pass));
        send(&Answer::Done { id, result });
    });
    scope()?.set_onmessage(Some(on_message.as_ref().unchecked_ref()));
    on_message.forget(); // lives as long as the worker
    send(&Answer::Started);
    Ok(())
}

fn scope() -> Result<DedicatedWorkerGlobalScope, JsValue> {
    Ok(js_sys::global().dyn_into::<DedicatedWorkerGlobalScope>()?)
}

/// Sends an answer, transferring its memory. The page replaces a worker whose answer could not be
/// packed or sent, as it never comes.
fn send(answer: &Answer) {
    if let (Ok(scope), Ok(bytes)) = (scope(), pack(answer)) {
        let buffer = Uint8Array::from(bytes.as_slice()).buffer();
        let _ = scope.post_message_with_transfer(&buffer, &Array::of1(&buffer));
    }
}
