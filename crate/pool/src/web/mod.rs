//! The crews of the page: web workers, each with an instance of the crew's wasm.
//!
//! Messages are handled as they arrive, not when the app draws, so that workers have work even
//! while the page is hidden or slow.

mod page;
mod workers;

use crate::clock::stopwatch;
use crate::workers::{Manager, Message};
use page::{Timer, load};
use std::cell::RefCell;
use std::mem::replace;
use std::rc::{Rc, Weak};
use wasm_bindgen_futures::spawn_local;
use workers::describe;

pub use page::set_folder;
pub use workers::WebWorkers as PlatformWorkers;

/// The program that workers run: their script and its wasm, files of the folder of workers.
#[derive(Clone, Copy)]
pub struct Program {
    script: &'static str,
    wasm: &'static str,
    /// Subject of a sentence about it.
    name: &'static str,
}

/// The program of tracing workers.
pub const TRACER: Program = Program {
    script: "worker.js",
    wasm: "tracer_bg.wasm",
    name: "The tracer",
};

/// The program of tracing workers that have the root finders for comparison, too.
pub const DIGGER: Program = Program {
    script: "digger_worker.js",
    wasm: "digger_bg.wasm",
    name: "The root finders for comparison (`digger`)",
};

/// The program of tools workers.
pub const TOOLS: Program = Program {
    script: "tools_worker.js",
    wasm: "tools_bg.wasm",
    name: "they",
};

/// Returns the number of the processor's cores.
pub fn cores() -> usize {
    page::window().map_or(1.0, |window| window.navigator().hardware_concurrency()) as usize
}

/// Workers with their manager, shared by all that have work for them.
pub struct Crew<M> {
    inner: Rc<RefCell<Inner<M>>>,
}

struct Inner<M> {
    program: Program,
    manager: M,
    repaint: Box<dyn Fn()>,
    timer: Option<Timer>,
    loading: Loading,
}

/// The state of the workers' program while it is not there.
#[derive(Clone, Copy, PartialEq)]
enum Loading {
    /// Nothing is fetched.
    Idle,
    /// The program is being fetched.
    Started,
    /// The program is being fetched, and was asked for once more meanwhile: if that fetch fails,
    /// which may have been lost before, it is fetched again.
    Repeated,
}

impl<M> Clone for Crew<M> {
    fn clone(&self) -> Self {
        Self {
            inner: self.inner.clone(),
        }
    }
}

impl<M: Manager> Inner<M> {
    fn receive(&mut self, index: usize, message: Message) {
        if self.manager.receive(index, message, stopwatch()) {
            (self.repaint)();
        }
    }
}

impl<M: Manager<Workers = PlatformWorkers>> Crew<M> {
    /// Creates a crew of `count` workers, whose program is not loaded yet. `repaint` is called when
    /// the app should draw.
    pub fn new(
        program: Program,
        count: usize,
        repaint: impl Fn() + Send + Sync + 'static,
        manager: impl FnOnce(PlatformWorkers) -> M,
    ) -> Self {
        let inner = Rc::new_cyclic(|inner: &Weak<RefCell<Inner<M>>>| {
            let inner = inner.clone();
            let workers = PlatformWorkers::new(program.script, count, move |index, message| {
                if let Some(inner) = inner.upgrade() {
                    inner.borrow_mut().receive(index, message);
                }
            });
            RefCell::new(Inner {
                program,
                manager: manager(workers),
                repaint: Box::new(repaint),
                timer: None,
                loading: Loading::Idle,
            })
        });
        Self { inner }
    }

    /// Loads the workers' program, unless that was done.
    pub fn load(&self) {
        let inner = &mut *self.inner.borrow_mut();
        if inner.manager.workers().has_module() {
            return;
        }
        if inner.loading != Loading::Idle {
            inner.loading = Loading::Repeated;
            return;
        }
        inner.loading = Loading::Started;
        let Program { wasm, name, .. } = inner.program;
        let weak = Rc::downgrade(&self.inner);
        spawn_local(async move {
            let module = load(wasm).await;
            let Some(inner) = weak.upgrade() else { return };
            let crew = Self { inner };
            let loading = replace(&mut crew.inner.borrow_mut().loading, Loading::Idle);
            if module.is_err() && loading == Loading::Repeated {
                crew.load();
                return;
            }
            crew.ask(|manager, now| {
                let outcome = module.map(|module| manager.workers().set_module(module));
                let outcome = outcome
                    .map_err(|error| format!("{name} could not be loaded: {}", describe(error)));
                manager.note_program(outcome, now);
            });
            (crew.inner.borrow().repaint)();
            crew.watch();
        });
    }

    /// Whether the workers' program is there.
    pub fn is_loaded(&self) -> bool {
        self.inner.borrow_mut().manager.workers().has_module()
    }

    /// Asks the manager.
    pub fn ask<T>(&self, question: impl FnOnce(&mut M, f64) -> T) -> T {
        question(&mut self.inner.borrow_mut().manager, stopwatch())
    }

    /// Gives the manager work.
    pub fn order<T>(&self, order: impl FnOnce(&mut M, f64) -> T) -> T {
        self.load();
        let done = self.ask(order);
        self.watch();
        done
    }

    /// Takes the messages that have come; they were taken when they came.
    pub fn catch_up(&self) {}

    /// Looks for hanging workers from time to time, while there is something to do.
    fn watch(&self) {
        if self.inner.borrow().timer.is_some() {
            return;
        }
        let weak = Rc::downgrade(&self.inner);
        let timer = Timer::new(move || {
            let Some(inner) = weak.upgrade() else { return };
            let inner = &mut *inner.borrow_mut();
            if inner.manager.tick(stopwatch()) {
                (inner.repaint)();
            }
            if !inner.manager.is_busy() {
                inner.timer = None;
            }
        });
        self.inner.borrow_mut().timer = timer;
    }
}
