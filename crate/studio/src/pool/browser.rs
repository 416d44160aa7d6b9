//! The pool of the page: one web worker per core, each with an instance of `tracer_bg.wasm`.
//!
//! The module is compiled once and sent to each worker. Answers are handled as they come in, not
//! when the app draws, so that workers have work even while the page is hidden or slow.

use super::core::{Core, Workers};
use super::{Job, Progress, TileDone, worker_count};
use js_sys::{Array, Uint8Array, WebAssembly};
use std::cell::RefCell;
use std::rc::{Rc, Weak};
use wasm_bindgen::prelude::*;
use wasm_bindgen_futures::{JsFuture, spawn_local};
use web_sys::{ErrorEvent, MessageEvent, Response, Window, Worker, WorkerOptions, WorkerType};
use worker::Answer;
use worker::message::unpack;

/// The script of a worker, and its wasm, relative to the page.
const SCRIPT: &str = "./worker.js";
const WASM: &str = "./tracer_bg.wasm";
/// How often hanging workers are looked for while something is being done, milliseconds.
const TICK: i32 = 120;

struct Slot {
    worker: Worker,
    // Dropped after the worker was ended: nothing is heard of it again.
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

struct WebWorkers {
    slots: Vec<Option<Slot>>,
    module: Option<WebAssembly::Module>,
    /// The pool itself, for the listeners.
    pool: Weak<RefCell<Inner>>,
}

struct Inner {
    core: Core<WebWorkers>,
    repaint: Box<dyn Fn()>,
    timer: Option<Timer>,
    loading: bool,
}

impl Workers for WebWorkers {
    fn restart(&mut self, index: usize) -> Result<(), String> {
        self.end(index);
        let module = self.module.as_ref().ok_or("the tracer is not loaded")?;
        let options = WorkerOptions::new();
        options.set_type(WorkerType::Module);
        let worker = Worker::new_with_options(SCRIPT, &options).map_err(describe)?;

        let listen = |pool: Weak<RefCell<Inner>>, what: fn(&JsValue) -> Vec<Answer>| {
            Closure::<dyn FnMut(JsValue)>::new(move |event: JsValue| {
                if let Some(pool) = pool.upgrade() {
                    Inner::answers(&pool, index, what(&event));
                }
            })
        };
        let listeners = [
            listen(self.pool.clone(), read_answers),
            listen(self.pool.clone(), read_error),
            listen(self.pool.clone(), |_| {
                vec![Answer::Failed(String::from("a message was lost"))]
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

fn read_answers(event: &JsValue) -> Vec<Answer> {
    let data = event.unchecked_ref::<MessageEvent>().data();
    unpack(&Uint8Array::new(&data).to_vec()).unwrap_or_else(|_| {
        vec![Answer::Failed(String::from(
            "page and worker are of different versions; reload the page",
        ))]
    })
}

fn read_error(event: &JsValue) -> Vec<Answer> {
    // A worker whose script cannot be loaded sends an event without a message.
    let message = event
        .dyn_ref::<ErrorEvent>()
        .map(ErrorEvent::message)
        .filter(|message| !message.is_empty());
    let reason = message.unwrap_or_else(|| String::from("worker.js could not be loaded"));
    vec![Answer::Failed(reason)]
}

fn describe(error: JsValue) -> String {
    error.dyn_ref::<js_sys::Error>().map_or_else(
        || format!("{error:?}"),
        |error| String::from(error.message()),
    )
}

fn window() -> Option<Window> {
    web_sys::window()
}

/// Seconds since the page was opened.
fn now() -> f64 {
    window()
        .and_then(|window| window.performance())
        .map_or(0.0, |performance| performance.now() / 1000.0)
}

/// Fetches and compiles the workers' wasm.
async fn load() -> Result<WebAssembly::Module, JsValue> {
    let window = window().ok_or("no window")?;
    let response: Response = JsFuture::from(window.fetch_with_str(WASM))
        .await?
        .unchecked_into();
    if !response.ok() {
        return Err(format!("{WASM} could not be loaded: {}", response.status()).into());
    }
    // Not compileStreaming: it wants a MIME type that not every static host sends.
    let bytes = JsFuture::from(response.array_buffer()?).await?;
    Ok(JsFuture::from(WebAssembly::compile(&bytes))
        .await?
        .unchecked_into())
}

/// Calls something again and again until it is dropped.
struct Timer {
    id: i32,
    _callback: Closure<dyn FnMut()>,
}

impl Timer {
    fn new(callback: impl FnMut() + 'static) -> Option<Self> {
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

impl Inner {
    fn answers(pool: &Rc<RefCell<Self>>, index: usize, answers: Vec<Answer>) {
        let inner = &mut *pool.borrow_mut();
        if inner.core.answers(index, answers, now()) {
            (inner.repaint)();
        }
    }

    /// Fetches the workers' wasm, unless that was done.
    fn load(pool: &Rc<RefCell<Self>>) {
        {
            let inner = &mut *pool.borrow_mut();
            if inner.loading || inner.core.workers.module.is_some() {
                return;
            }
            inner.loading = true;
        }
        let pool = Rc::downgrade(pool);
        spawn_local(async move {
            let module = load().await;
            let Some(pool) = pool.upgrade() else { return };
            {
                let inner = &mut *pool.borrow_mut();
                inner.loading = false;
                match module {
                    Ok(module) => {
                        inner.core.workers.module = Some(module);
                        inner.core.launch(now());
                    }
                    Err(error) => inner.core.scheduler.unavailable(
                        &format!(
                            "The tracer could not be loaded: {}. Check the connection and render again.",
                            describe(error)
                        ),
                        now(),
                    ),
                }
                (inner.repaint)();
            }
            Self::watch(&pool);
        });
    }

    /// Looks for hanging workers from time to time, while there is something to do.
    fn watch(pool: &Rc<RefCell<Self>>) {
        if pool.borrow().timer.is_some() {
            return;
        }
        let weak = Rc::downgrade(pool);
        let timer = Timer::new(move || {
            let Some(pool) = weak.upgrade() else { return };
            let inner = &mut *pool.borrow_mut();
            inner.core.tick(now());
            if !inner.core.scheduler.is_busy() {
                inner.timer = None;
            }
        });
        pool.borrow_mut().timer = timer;
    }
}

/// Traces pictures with all cores; see the [module](super).
pub struct Pool {
    inner: Rc<RefCell<Inner>>,
}

impl Pool {
    /// Starts the workers. `repaint` is called when a pass is complete, and
    /// when it is known whether there can be a picture at all.
    #[must_use]
    pub fn new(repaint: impl Fn() + Send + Sync + 'static) -> Self {
        let cores = window().map_or(1.0, |window| window.navigator().hardware_concurrency());
        let count = worker_count(cores as usize);
        let inner = Rc::new_cyclic(|pool| {
            RefCell::new(Inner {
                core: Core::new(
                    count,
                    WebWorkers {
                        slots: (0..count).map(|_| None).collect(),
                        module: None,
                        pool: pool.clone(),
                    },
                ),
                repaint: Box::new(repaint),
                timer: None,
                loading: false,
            })
        });
        Inner::load(&inner);
        Self { inner }
    }

    /// Begins a picture and forgets the one before.
    pub fn start(&mut self, job: Job<'_>) {
        Inner::load(&self.inner);
        self.inner.borrow_mut().core.start(job, now());
        Inner::watch(&self.inner);
    }

    /// Ends the present picture.
    pub fn cancel(&mut self) {
        self.inner.borrow_mut().core.cancel(now());
        Inner::watch(&self.inner);
    }

    /// The tiles of the present picture that were finished since the last call.
    pub fn poll(&mut self) -> Vec<TileDone> {
        self.inner.borrow_mut().core.take()
    }

    /// How far the present picture has come.
    #[must_use]
    pub fn progress(&self) -> Progress {
        self.inner.borrow().core.progress(now())
    }

    /// Ends a worker without telling the scheduler, which must find out by itself. For tests.
    /// Says whether there was such a worker.
    pub fn kill_worker(&mut self, index: usize) -> bool {
        let inner = self.inner.borrow();
        let Some(Some(slot)) = inner.core.workers.slots.get(index) else {
            return false;
        };
        slot.worker.terminate();
        true
    }
}
