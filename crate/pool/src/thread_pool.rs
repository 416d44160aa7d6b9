//! The pool of native builds, for tests: one thread per worker.

use crate::core::Core;
use crate::job::{Job, TileDone, worker_count};
use crate::progress::Progress;
use crate::threads::{Report, Threads};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::time::Instant;
use worker::message::unpack;
use worker::{Answer, Engine, Request, Step};

/// The picture that a request begins or ends.
fn generation(request: &[u8]) -> Option<u64> {
    match unpack(request) {
        Ok(Request::Begin { generation, .. } | Request::Stop { generation }) => Some(generation),
        _ => None,
    }
}

/// Runs a worker's engine until its inbox or the pool's is closed.
fn serve(
    inbox: &Receiver<Vec<u8>>,
    wanted: &AtomicU64,
    clock: Instant,
    send: &dyn Fn(Answer) -> bool,
) {
    let mut engine = Engine::new(digger::prepare);
    let mut listened = send(Answer::Started);
    let mut generation = 0;
    while listened {
        let message = if engine.is_idle() {
            inbox.recv().map_err(|_| TryRecvError::Disconnected)
        } else {
            inbox.try_recv()
        };
        match message {
            Ok(bytes) => match unpack(&bytes) {
                Ok(request) => {
                    if let Request::Begin { generation: n, .. } | Request::Stop { generation: n } =
                        request
                    {
                        generation = n;
                    }
                    engine.accept(request);
                }
                Err(error) => listened = send(Answer::Failed(error.to_string())),
            },
            Err(TryRecvError::Empty) => {
                let stop = || wanted.load(Ordering::Relaxed) != generation;
                let seconds = || clock.elapsed().as_secs_f64();
                if let Step::Answer(answer) = engine.step(&stop, &seconds) {
                    listened = send(answer);
                }
            }
            Err(TryRecvError::Disconnected) => return,
        }
    }
}

/// Traces pictures with all cores; see the [crate](crate).
pub struct Pool {
    core: Core<Threads<Answer>>,
    reports: Receiver<Report<Answer>>,
    clock: Instant,
}

impl Pool {
    /// Starts the workers. `repaint` is called, from any thread, when there is something to
    /// [`Pool::poll`].
    #[must_use]
    pub fn new(repaint: impl Fn() + Send + Sync + 'static) -> Self {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let count = worker_count(cores);
        let (sender, reports) = channel();
        let clock = Instant::now();
        let body =
            move |inbox: &Receiver<Vec<u8>>, wanted: &AtomicU64, send: &dyn Fn(Answer) -> bool| {
                serve(inbox, wanted, clock, send);
            };
        let threads = Threads::new(count, sender, repaint, body, Answer::Failed, generation);
        let mut core = Core::new(count, threads);
        core.launch(0.0);
        Self {
            core,
            reports,
            clock,
        }
    }

    fn now(&self) -> f64 {
        self.clock.elapsed().as_secs_f64()
    }

    /// Begins a picture and forgets the one before.
    pub fn start(&mut self, job: Job<'_>) {
        self.core.start(job, self.now());
    }

    /// Ends the present picture.
    pub fn cancel(&mut self) {
        self.core.cancel(self.now());
    }

    /// The tiles of the present picture that were finished since the last call.
    pub fn poll(&mut self) -> Vec<TileDone> {
        while let Ok((index, incarnation, answer)) = self.reports.try_recv() {
            if self.core.workers.is_present(index, incarnation) {
                self.core.answers(index, vec![answer], self.now());
            }
        }
        self.core.tick(self.now());
        self.core.take()
    }

    /// How far the present picture has come.
    #[must_use]
    pub fn progress(&self) -> Progress {
        self.core.progress(self.now())
    }

    /// Ends a worker without telling the scheduler, which must find out by itself. For tests.
    /// Returns whether there was such a worker.
    pub fn kill_worker(&mut self, index: usize) -> bool {
        self.core.workers.kill(index)
    }
}
