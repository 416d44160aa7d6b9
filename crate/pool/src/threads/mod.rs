//! The crews of native builds, for tests: one thread per worker.

mod workers;

use crate::workers::Manager;
use core::ops::ControlFlow;
use std::cell::RefCell;
use std::rc::Rc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError};
use std::time::Instant;
use worker::{Answer, Engine, Request, Step};

pub use workers::{Outlet, Program, Threads as PlatformWorkers};

/// The program of tracing workers that have the root finders for comparison, as all have here.
pub const DIGGER: Program = TRACER;

/// The program of tracing workers.
pub const TRACER: Program = Program {
    serve: trace,
    number: generation,
};

/// The program of tools workers.
pub const TOOLS: Program = Program {
    serve: run_jobs,
    number: |_| None,
};

/// Returns the number of the picture that a request begins or ends.
fn generation(request: &[u8]) -> Option<u64> {
    match postcard::from_bytes(request) {
        Ok(Request::Begin { generation, .. } | Request::Stop { generation }) => Some(generation),
        _ => None,
    }
}

/// Runs a tracing worker's engine.
fn trace(inbox: &Receiver<Vec<u8>>, wanted: &AtomicU64, send: &Outlet<'_>) {
    let clock = Instant::now();
    let answer = |answer| postcard::to_allocvec(&[answer].as_slice()).is_ok_and(send);
    let mut engine = Engine::new(digger::prepare);
    let mut listened = answer(Answer::Started);
    let mut generation = 0;
    while listened {
        let message = if engine.is_idle() {
            inbox.recv().map_err(|_| TryRecvError::Disconnected)
        } else {
            inbox.try_recv()
        };
        match message {
            Ok(bytes) => match postcard::from_bytes(&bytes) {
                Ok(request) => {
                    if let Request::Begin { generation: n, .. } | Request::Stop { generation: n } =
                        request
                    {
                        generation = n;
                    }
                    engine.accept(request);
                }
                Err(error) => listened = answer(Answer::Failed(error.to_string())),
            },
            Err(TryRecvError::Empty) => {
                let step = engine.step(&|| wanted.load(Ordering::Relaxed) != generation, &|| {
                    clock.elapsed().as_secs_f64()
                });
                if let Step::Answer(message) = step {
                    listened = answer(message);
                }
            }
            Err(TryRecvError::Disconnected) => return,
        }
    }
}

/// Carries out the jobs of a tools worker.
fn run_jobs(inbox: &Receiver<Vec<u8>>, wanted: &AtomicU64, send: &Outlet<'_>) {
    send(tools::Answer::Started.to_bytes());
    for request in inbox {
        run_job(request, wanted, send);
    }
}

/// Carries out a job of a tools worker. It is given up when the worker is ended.
pub fn run_job(request: Vec<u8>, wanted: &AtomicU64, send: &Outlet<'_>) {
    tools::serve(request, &mut |answer| {
        if send(answer) && wanted.load(Ordering::Relaxed) != workers::NONE {
            ControlFlow::Continue(())
        } else {
            ControlFlow::Break(())
        }
    });
}

/// Returns the number of the processor's cores.
pub fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// Workers with their manager, shared by all that have work for them.
pub struct Crew<M> {
    inner: Rc<Inner<M>>,
}

struct Inner<M> {
    manager: RefCell<M>,
    clock: Instant,
}

impl<M> Clone for Crew<M> {
    fn clone(&self) -> Self {
        Self {
            inner: self.inner.clone(),
        }
    }
}

impl<M: Manager<Workers = PlatformWorkers>> Crew<M> {
    /// Creates a crew of `count` workers, none of which is started yet. `repaint` is called when
    /// the app should draw, from any thread.
    pub fn new(
        program: Program,
        count: usize,
        repaint: impl Fn() + Send + Sync + 'static,
        manager: impl FnOnce(PlatformWorkers) -> M,
    ) -> Self {
        let mut manager = manager(PlatformWorkers::new(program, count, repaint));
        manager.note_program(Ok(()), 0.0);
        let inner = Inner {
            manager: RefCell::new(manager),
            clock: Instant::now(),
        };
        Self {
            inner: Rc::new(inner),
        }
    }

    /// Loads the workers' program; a thread has it.
    pub fn load(&self) {}

    /// Whether the workers' program is there, as it always is.
    pub fn is_loaded(&self) -> bool {
        true
    }

    /// Asks the manager.
    pub fn ask<T>(&self, question: impl FnOnce(&mut M, f64) -> T) -> T {
        let now = self.inner.clock.elapsed().as_secs_f64();
        question(&mut self.inner.manager.borrow_mut(), now)
    }

    /// Gives the manager work.
    pub fn order<T>(&self, order: impl FnOnce(&mut M, f64) -> T) -> T {
        self.ask(order)
    }

    /// Takes the messages that have come.
    pub fn catch_up(&self) {
        self.ask(|manager, now| {
            while let Some((index, message)) = manager.workers().message() {
                manager.receive(index, message, now);
            }
            if manager.is_busy() {
                manager.tick(now);
            }
        });
    }
}
