//! The pool of the page: one web worker per core, each with an instance of `tracer_bg.wasm`, or of
//! `digger_bg.wasm` from the first scene on that asks for what only that build has.
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

/// A build of the tracing worker.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Build {
    /// The script of a worker, relative to the page.
    script: &'static str,
    /// Its wasm, relative to the page.
    wasm: &'static str,
    /// Its name in messages.
    name: &'static str,
}

const CERTIFIED: Build = Build {
    script: "./worker.js",
    wasm: "./tracer_bg.wasm",
    name: "The tracer",
};

/// The same with the root finders for comparison.
const COMPARING: Build = Build {
    script: "./digger_worker.js",
    wasm: "./digger_bg.wasm",
    name: "The root finders for comparison (`digger`)",
};

struct Inner {
    build: Build,
    core: Core<WebWorkers>,
    repaint: Rc<dyn Fn()>,
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
    /// Starts the workers of a build.
    fn start(build: Build, repaint: Rc<dyn Fn()>) -> Rc<RefCell<Self>> {
        let cores = window().map_or(1.0, |window| window.navigator().hardware_concurrency());
        let count = worker_count(cores as usize);
        let inner = Rc::new_cyclic(|pool: &Weak<RefCell<Self>>| {
            let pool = pool.clone();
            let workers = WebWorkers::new(build.script, count, move |index, message| {
                Self::receive(&pool, index, message);
            });
            RefCell::new(Self {
                build,
                core: Core::new(count, workers),
                repaint,
                timer: None,
                loading: false,
            })
        });
        Self::load(&inner);
        inner
    }

    /// Whether the workers can trace what needs this build: the larger build, once it is there,
    /// does all that the other one does.
    fn serves(&self, build: Build) -> bool {
        self.build == build || self.build == COMPARING && self.core.workers.has_module()
    }

    fn receive(pool: &Weak<RefCell<Self>>, index: usize, message: Message) {
        let Some(pool) = pool.upgrade() else { return };
        let inner = &mut *pool.borrow_mut();
        if inner.core.answers(index, answers(message), now()) {
            (inner.repaint)();
        }
    }

    /// Fetches the workers' wasm, unless that was done.
    fn load(pool: &Rc<RefCell<Self>>) {
        let build = {
            let inner = &mut *pool.borrow_mut();
            if inner.loading || inner.core.workers.has_module() {
                return;
            }
            inner.loading = true;
            inner.build
        };
        let pool = Rc::downgrade(pool);
        spawn_local(async move {
            let module = load(build.wasm).await;
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
                            "{} could not be loaded: {}. Check the connection and render again.",
                            build.name,
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
    repaint: Rc<dyn Fn()>,
}

impl Pool {
    /// Starts the workers. `repaint` is called when a pass is complete, and
    /// when it is known whether there can be a picture at all.
    #[must_use]
    pub fn new(repaint: impl Fn() + Send + Sync + 'static) -> Self {
        let repaint: Rc<dyn Fn()> = Rc::new(repaint);
        Self {
            inner: Inner::start(CERTIFIED, repaint.clone()),
            repaint,
        }
    }

    /// Begins a picture and forgets the one before.
    pub fn start(&mut self, job: Job<'_>) {
        let build = if job.compares() { COMPARING } else { CERTIFIED };
        if !self.inner.borrow().serves(build) {
            self.inner = Inner::start(build, self.repaint.clone());
        }
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
