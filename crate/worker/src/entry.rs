//! The entry point of a web worker: messages in, messages out.
//!
//! The script `www/worker.js` receives the compiled module, instantiates it and calls [`serve`].
//! From then on each message is one packed [`Request`]. Work is done in steps, each begun by a
//! message the worker sends to itself, so that requests which came in meanwhile are seen first.

use crate::{Answer, Engine, Request, Step};
use js_sys::{Array, Uint8Array};
use std::cell::RefCell;
use std::rc::Rc;
use wasm_bindgen::prelude::*;
use web_sys::{DedicatedWorkerGlobalScope, MessageChannel, MessageEvent};

/// Seconds for which finished tiles are held back to be sent together.
const TOGETHER: f64 = 0.05;

struct Desk {
    engine: Engine,
    /// Answers not sent yet.
    answers: Vec<Answer>,
    /// The time at which answers were last sent, seconds.
    sent: f64,
    /// Whether a message to ourselves is on its way.
    ticking: bool,
    channel: MessageChannel,
}

/// Takes over the worker's messages. Called once by `www/worker.js`.
///
/// # Errors
/// Outside a dedicated worker.
#[cfg(feature = "entry")]
#[wasm_bindgen(js_name = serve)]
pub fn serve_certified() -> Result<(), JsValue> {
    serve(Engine::default())
}

/// Takes over the messages of a worker with this engine.
///
/// # Errors
/// Outside a dedicated worker.
pub fn serve(engine: Engine) -> Result<(), JsValue> {
    std::panic::set_hook(Box::new(|panic| {
        let message = panic.to_string();
        web_sys::console::error_1(&JsValue::from_str(&message));
        send(&[Answer::Failed(message)]);
    }));
    let scope = scope()?;
    let desk = Rc::new(RefCell::new(Desk {
        engine,
        answers: Vec::new(),
        sent: 0.0,
        ticking: false,
        channel: MessageChannel::new()?,
    }));

    let listener = desk.clone();
    let on_tick = Closure::<dyn FnMut()>::new(move || {
        let desk = &mut *listener.borrow_mut();
        desk.ticking = false;
        match desk.engine.step(&|| false, &clock) {
            Step::Answer(answer) => desk.answer(answer),
            // Of a tile that takes long the page would hold what it has not heard of the ones
            // before against it.
            Step::Part | Step::Dropped => desk.send_old(),
            Step::Idle => {}
        }
        desk.tick();
    });
    desk.borrow()
        .channel
        .port2()
        .set_onmessage(Some(on_tick.as_ref().unchecked_ref()));
    on_tick.forget(); // lives as long as the worker

    let on_message = Closure::<dyn FnMut(MessageEvent)>::new(move |event: MessageEvent| {
        let bytes = Uint8Array::new(&event.data()).to_vec();
        let Ok(request) = postcard::from_bytes::<Request>(&bytes) else {
            send(&[Answer::Failed(String::from(
                "page and worker are of different versions; reload the page",
            ))]);
            return;
        };
        let desk = &mut *desk.borrow_mut();
        desk.engine.accept(request);
        desk.tick();
    });
    scope.set_onmessage(Some(on_message.as_ref().unchecked_ref()));
    on_message.forget(); // lives as long as the worker
    send(&[Answer::Started]);
    Ok(())
}

impl Desk {
    /// Sends an answer, a tile together with those of its pass that follow soon: the last of a pass
    /// may complete a picture.
    fn answer(&mut self, answer: Answer) {
        let can_wait =
            matches!(&answer, Answer::Traced { order, .. } if self.engine.goes_on_with(order.pass));
        self.answers.push(answer);
        if can_wait {
            self.send_old();
        } else {
            self.send_all();
        }
    }

    /// Sends what has been held back, if it has been for long.
    fn send_old(&mut self) {
        if !self.answers.is_empty() && clock() - self.sent >= TOGETHER {
            self.send_all();
        }
    }

    fn send_all(&mut self) {
        send(&self.answers);
        self.answers.clear();
        self.sent = clock();
    }

    fn tick(&mut self) {
        if !self.ticking && !self.engine.is_idle() {
            self.ticking = self
                .channel
                .port1()
                .post_message(&JsValue::UNDEFINED)
                .is_ok();
        }
    }
}

fn scope() -> Result<DedicatedWorkerGlobalScope, JsValue> {
    Ok(js_sys::global().dyn_into::<DedicatedWorkerGlobalScope>()?)
}

fn clock() -> f64 {
    scope()
        .ok()
        .and_then(|scope| scope.performance())
        .map_or(0.0, |performance| performance.now() / 1000.0)
}

/// Sends answers, giving the memory away instead of copying it again. What cannot be packed or sent
/// is missed by the page, which then replaces this worker.
fn send(answers: &[Answer]) {
    if let (Ok(scope), Ok(bytes)) = (scope(), postcard::to_allocvec(&answers)) {
        let buffer = Uint8Array::from(bytes.as_slice()).buffer();
        let _ = scope.post_message_with_transfer(&buffer, &Array::of1(&buffer));
    }
}
