//! Web workers that run one wasm module.
//!
//! The module is fetched and compiled once and sent to each worker, whose script instantiates it.

use super::page::address;
use crate::workers::{Message, Workers};
use js_sys::{Array, Uint8Array, WebAssembly};
use std::rc::Rc;
use wasm_bindgen::prelude::*;
use web_sys::{ErrorEvent, MessageEvent, Worker, WorkerOptions, WorkerType};

/// Called with the worker's index.
type Receiver = Rc<dyn Fn(usize, Message)>;

struct Slot {
    worker: Worker,
    // Dropped after the worker was ended, so that none of its events is handled any more.
    _listeners: [Closure<dyn FnMut(JsValue)>; 3],
}

impl Drop for Slot {
    fn drop(&mut self) {
        self.worker.set_onmessage(None);
        self.worker.set_onmessageerror(None);
        self.worker.set_onerror(None);
        self.worker.terminate();
    }
}

/// Web workers with the same script and module.
pub struct WebWorkers {
    script: &'static str,
    slots: Vec<Option<Slot>>,
    module: Option<WebAssembly::Module>,
    receiver: Receiver,
}

impl WebWorkers {
    /// Creates places for `count` workers with this script, a file of workers. None can
    /// be started before [`WebWorkers::set_module`].
    pub fn new(
        script: &'static str,
        count: usize,
        receiver: impl Fn(usize, Message) + 'static,
    ) -> Self {
        Self {
            script,
            slots: (0..count).map(|_| None).collect(),
            module: None,
            receiver: Rc::new(receiver),
        }
    }

    /// Sets the module that the workers run.
    pub fn set_module(&mut self, module: WebAssembly::Module) {
        self.module = Some(module);
    }

    /// Whether there is a module.
    pub fn has_module(&self) -> bool {
        self.module.is_some()
    }

    /// Terminates a worker as if it had crashed without a message. For tests. Returns whether there
    /// was such a worker.
    pub fn kill(&self, index: usize) -> bool {
        let slot = self.slots.get(index).and_then(Option::as_ref);
        slot.inspect(|slot| slot.worker.terminate()).is_some()
    }

    fn listener(
        &self,
        index: usize,
        read: impl Fn(&JsValue) -> Message + 'static,
    ) -> Closure<dyn FnMut(JsValue)> {
        let receiver = self.receiver.clone();
        Closure::new(move |event: JsValue| receiver(index, read(&event)))
    }
}

impl Workers for WebWorkers {
    fn restart(&mut self, index: usize) -> Result<(), String> {
        self.end(index);
        let module = self.module.as_ref().ok_or("its wasm is not loaded")?;
        let options = WorkerOptions::new();
        options.set_type(WorkerType::Module);
        let script = self.script;
        let worker = Worker::new_with_options(&address(script), &options).map_err(describe)?;
        let listeners = [
            self.listener(index, |event| {
                let data = event.unchecked_ref::<MessageEvent>().data();
                Message::Bytes(Uint8Array::new(&data).to_vec())
            }),
            self.listener(index, move |event| Message::Failed(reason(event, script))),
            self.listener(index, |_| {
                Message::Failed(String::from("a message was lost"))
            }),
        ];
        let [message, error, lost] = &listeners;
        worker.set_onmessage(Some(message.as_ref().unchecked_ref()));
        worker.set_onerror(Some(error.as_ref().unchecked_ref()));
        worker.set_onmessageerror(Some(lost.as_ref().unchecked_ref()));
        let slot = Slot {
            worker,
            _listeners: listeners,
        };
        slot.worker.post_message(module).map_err(describe)?;
        self.slots[index] = Some(slot);
        Ok(())
    }

    fn end(&mut self, index: usize) {
        self.slots[index] = None;
    }

    fn send(&mut self, index: usize, request: &[u8]) {
        if let Some(slot) = &self.slots[index] {
            let buffer = Uint8Array::from(request).buffer();
            // A worker that misses a message is found hanging and replaced.
            let _ = slot
                .worker
                .post_message_with_transfer(&buffer, &Array::of1(&buffer));
        }
    }
}

/// Returns the message of an error event. A worker whose script cannot be loaded sends one without
/// a message.
fn reason(event: &JsValue, script: &str) -> String {
    event
        .dyn_ref::<ErrorEvent>()
        .map(ErrorEvent::message)
        .filter(|message| !message.is_empty())
        .unwrap_or_else(|| format!("{script} could not be loaded"))
}

/// Returns the message of an exception.
pub fn describe(error: JsValue) -> String {
    error.dyn_ref::<js_sys::Error>().map_or_else(
        || format!("{error:?}"),
        |error| String::from(error.message()),
    )
}
