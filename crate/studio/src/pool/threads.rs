//! The pool of native builds: one thread per worker. It serves the app's tests.

use super::core::{Core, Workers};
use super::{Job, Progress, TileDone, worker_count};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};
use std::time::Instant;
use worker::message::unpack;
use worker::{Answer, Engine, Request, Step};

/// A message from a thread: index, which thread of that index it was, answer.
type Report = (usize, u64, Answer);
/// What is called when tiles have come.
type Repaint = Arc<dyn Fn() + Send + Sync>;

struct Thread {
    requests: Sender<Vec<u8>>,
    /// The picture wanted from it; a thread that was ended is wanted for none.
    wanted: Arc<AtomicU64>,
    incarnation: u64,
}

/// No picture has this number.
const NONE: u64 = u64::MAX;

struct Threads {
    slots: Vec<Option<Thread>>,
    started: u64,
    reports: Sender<Report>,
    repaint: Repaint,
    clock: Instant,
}

impl Workers for Threads {
    fn restart(&mut self, index: usize) -> Result<(), String> {
        self.end(index);
        self.started += 1;
        let (requests, inbox) = channel();
        let wanted = Arc::new(AtomicU64::new(0));
        let incarnation = self.started;
        let (outbox, repaint, clock) = (self.reports.clone(), self.repaint.clone(), self.clock);
        let shared = wanted.clone();
        std::thread::Builder::new()
            .name(format!("tracer {index}"))
            .spawn(move || {
                let send = |answer| {
                    let sent = outbox.send((index, incarnation, answer)).is_ok();
                    repaint();
                    sent
                };
                let work = || serve(&inbox, &shared, clock, &send);
                if let Err(panic) = catch_unwind(AssertUnwindSafe(work)) {
                    let reason = panic
                        .downcast_ref::<String>()
                        .cloned()
                        .or_else(|| panic.downcast_ref::<&str>().map(|s| (*s).to_owned()))
                        .unwrap_or_else(|| String::from("a worker panicked"));
                    send(Answer::Failed(reason));
                }
            })
            .map_err(|error| error.to_string())?;
        self.slots[index] = Some(Thread {
            requests,
            wanted,
            incarnation,
        });
        Ok(())
    }

    fn end(&mut self, index: usize) {
        // Its inbox is closed with this, so it ends once it gives up the present tile.
        if let Some(thread) = self.slots[index].take() {
            thread.wanted.store(NONE, Ordering::Relaxed);
        }
    }

    fn send(&mut self, index: usize, request: &[u8]) {
        if let Some(thread) = &self.slots[index] {
            if let Ok(Request::Begin { generation, .. } | Request::Stop { generation }) =
                unpack(request)
            {
                thread.wanted.store(generation, Ordering::Relaxed);
            }
            // A thread that is gone has reported why, or will be missed.
            let _ = thread.requests.send(request.to_vec());
        }
    }
}

/// A worker's thread: ends when its inbox is closed or nobody listens to it.
fn serve(
    inbox: &Receiver<Vec<u8>>,
    wanted: &AtomicU64,
    clock: Instant,
    send: &dyn Fn(Answer) -> bool,
) {
    let mut engine = Engine::default();
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

/// Traces pictures with all cores; see the [module](super).
pub struct Pool {
    core: Core<Threads>,
    reports: Receiver<Report>,
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
        let threads = Threads {
            slots: (0..count).map(|_| None).collect(),
            started: 0,
            reports: sender,
            repaint: Arc::new(repaint),
            clock,
        };
        let mut core = Core::new(count, threads);
        core.launch(0.0);
        Self { core, reports }
    }

    fn now(&self) -> f64 {
        self.core.workers.clock.elapsed().as_secs_f64()
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
            let present = self.core.workers.slots[index]
                .as_ref()
                .is_some_and(|thread| thread.incarnation == incarnation);
            if present {
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
    /// Says whether there was such a worker.
    pub fn kill_worker(&mut self, index: usize) -> bool {
        let Some(Some(thread)) = self.core.workers.slots.get_mut(index) else {
            return false;
        };
        thread.wanted.store(NONE, Ordering::Relaxed);
        thread.requests = channel().0;
        true
    }
}
