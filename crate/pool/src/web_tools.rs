//! The tools of the page: a web worker with an instance of `tools_bg.wasm`, fetched for the first job.

use crate::tool_jobs::{ToolEvent, ToolsCore};
use crate::web_workers::{DIFFERENT_VERSIONS, Message, Timer, WebWorkers, describe, load, now};
use std::cell::RefCell;
use std::rc::{Rc, Weak};
use tools::message::unpack;
use tools::{Answer, Job};
use wasm_bindgen_futures::spawn_local;

/// The script of the worker, and its wasm, relative to the page.
const SCRIPT: &str = "./tools_worker.js";
const WASM: &str = "./tools_bg.wasm";

struct Inner {
    core: ToolsCore<WebWorkers>,
    repaint: Box<dyn Fn()>,
    timer: Option<Timer>,
    loading: bool,
}

fn answer(message: Message) -> Answer {
    match message {
        Message::Bytes(bytes) => {
            unpack(&bytes).unwrap_or_else(|_| Answer::Failed(DIFFERENT_VERSIONS.to_owned()))
        }
        Message::Failed(reason) => Answer::Failed(reason),
    }
}

impl Inner {
    fn receive(tools: &Weak<RefCell<Self>>, message: Message) {
        let Some(tools) = tools.upgrade() else { return };
        let inner = &mut *tools.borrow_mut();
        if inner.core.answer(answer(message), now()) {
            (inner.repaint)();
        }
    }

    /// Fetches the worker's wasm, unless that was done.
    fn load(tools: &Rc<RefCell<Self>>) {
        {
            let inner = &mut *tools.borrow_mut();
            if inner.loading || inner.core.workers.has_module() {
                return;
            }
            inner.loading = true;
        }
        let tools = Rc::downgrade(tools);
        spawn_local(async move {
            let module = load(WASM).await;
            let Some(tools) = tools.upgrade() else { return };
            {
                let inner = &mut *tools.borrow_mut();
                inner.loading = false;
                match module {
                    Ok(module) => {
                        inner.core.workers.set_module(module);
                        inner.core.launch(now());
                    }
                    Err(error) => {
                        let reason = format!(
                            "they could not be loaded: {}. Check the connection and try again.",
                            describe(error)
                        );
                        inner.core.supervisor.unavailable(&reason);
                    }
                }
                if inner.core.tick(now()) {
                    (inner.repaint)();
                }
            }
            Self::watch(&tools);
        });
    }

    /// Looks for a hanging worker from time to time, while there is one.
    fn watch(tools: &Rc<RefCell<Self>>) {
        if tools.borrow().timer.is_some() {
            return;
        }
        let weak = Rc::downgrade(tools);
        let timer = Timer::new(move || {
            let Some(tools) = weak.upgrade() else { return };
            let inner = &mut *tools.borrow_mut();
            if inner.core.tick(now()) {
                (inner.repaint)();
            }
            if !inner.core.supervisor.is_busy() {
                inner.timer = None;
            }
        });
        tools.borrow_mut().timer = timer;
    }
}

/// Runs jobs that take long apart from the page's thread; see [`ToolEvent`].
pub struct Tools {
    inner: Rc<RefCell<Inner>>,
}

impl Tools {
    /// Prepares the tools; their wasm is fetched and their worker started with the first job.
    /// `repaint` is called when there is something to [`Tools::poll`].
    #[must_use]
    pub fn new(repaint: impl Fn() + Send + Sync + 'static) -> Self {
        let inner = Rc::new_cyclic(|tools: &Weak<RefCell<Inner>>| {
            let tools = tools.clone();
            let workers = WebWorkers::new(SCRIPT, 1, move |_, message| {
                Inner::receive(&tools, message);
            });
            RefCell::new(Inner {
                core: ToolsCore::new(workers),
                repaint: Box::new(repaint),
                timer: None,
                loading: false,
            })
        });
        Self { inner }
    }

    /// Queues a job and returns its number.
    pub fn submit(&mut self, job: Job) -> u64 {
        Inner::load(&self.inner);
        let id = self.inner.borrow_mut().core.submit(job, now());
        Inner::watch(&self.inner);
        id
    }

    /// Forgets a job; no event of it follows.
    pub fn cancel(&mut self, id: u64) {
        self.inner.borrow_mut().core.cancel(id, now());
    }

    /// Returns the events since the last call, with the numbers of their jobs.
    pub fn poll(&mut self) -> Vec<(u64, ToolEvent)> {
        self.inner.borrow_mut().core.take()
    }

    /// Ends the worker without telling the supervisor. For tests. Returns whether there was a worker.
    pub fn kill_worker(&mut self) -> bool {
        self.inner.borrow().core.workers.kill(0)
    }
}
