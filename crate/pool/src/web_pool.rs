//! The pool of the page: one web worker per core, each with an instance of `tracer_bg.wasm`.
//!
//! Answers are handled as they arrive, not when the app draws, so that workers have work even while
//! the page is hidden or slow.

use crate::core::Core;
use crate::job::{Job, TileDone, worker_count};
use crate::progress::Progress;
use crate::web_workers::{
    DIFFERENT_VERSIONS, Message, Timer, WebWorkers, describe, load, now, window,
};
use std::cell::RefCell;
use std::rc::{Rc, Weak};
use wasm_bindgen_futures::spawn_local;
use worker::Answer;
use worker::message::unpack;

/// The script of a worker, and its wasm, relative to the page.
const SCRIPT: &str = "./worker.js";
const WASM: &str = "./tracer_bg.wasm";

struct Inner {
    core: Core<WebWorkers>,
    repaint: Box<dyn Fn()>,
    timer: Option<Timer>,
    loading: bool,
}

fn answers(message: Message) -> Vec<Answer> {
    let failed = |reason: String| vec![Answer::Failed(reason)];
    match message {
        Message::Bytes(bytes) => {
            unpack(&bytes).unwrap_or_else(|_| failed(DIFFERENT_VERSIONS.to_owned()))
        }
        Message::Failed(reason) => failed(reason),
    }
}

impl Inner {
    fn receive(pool: &Weak<RefCell<Self>>, index: usize, message: Message) {
        let Some(pool) = pool.upgrade() else { return };
        let inner = &mut *pool.borrow_mut();
        if inner.core.answers(index, answers(message), now()) {
            (inner.repaint)();
        }
    }

    /// Fetches the workers' wasm, unless that was done.
    fn load(pool: &Rc<RefCell<Self>>) {
        {
            let inner = &mut *pool.borrow_mut();
            if inner.loading || inner.core.workers.has_module() {
                return;
            }
            inner.loading = true;
        }
        let pool = Rc::downgrade(pool);
        spawn_local(async move {
            let module = load(WASM).await;
            let Some(pool) = pool.upgrade() else { return };
            {
                let inner = &mut *pool.borrow_mut();
                inner.loading = false;
                match module {
                    Ok(module) => {
                        inner.core.workers.set_module(module);
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

/// Traces pictures with all cores; see the [crate](crate).
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
        let inner = Rc::new_cyclic(|pool: &Weak<RefCell<Inner>>| {
            let pool = pool.clone();
            let workers = WebWorkers::new(SCRIPT, count, move |index, message| {
                Inner::receive(&pool, index, message);
            });
            RefCell::new(Inner {
                core: Core::new(count, workers),
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
    /// Returns whether there was such a worker.
    pub fn kill_worker(&mut self, index: usize) -> bool {
        self.inner.borrow().core.workers.kill(index)
    }
}
