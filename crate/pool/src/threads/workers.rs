//! Threads as workers.

use crate::workers::{Message, Workers};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};

/// Sends a packed answer. Returns whether it is taken.
pub type Outlet<'a> = dyn Fn(Vec<u8>) -> bool + 'a;

/// The program that threads run.
#[derive(Clone, Copy)]
pub struct Program {
    /// Serves requests until its inbox is closed or its answers are not taken any more. The number
    /// is that of the work wanted from it, as the last request said; it changes when the present
    /// work is given up.
    pub serve: fn(&Receiver<Vec<u8>>, &AtomicU64, &Outlet<'_>),
    /// Reads the number of the work that a packed request wants.
    pub number: fn(&[u8]) -> Option<u64>,
}

struct Thread {
    requests: Sender<Vec<u8>>,
    wanted: Arc<AtomicU64>,
    /// Number that no other thread has.
    incarnation: u64,
}

/// A message with the index of its thread and its [`Thread::incarnation`].
type Report = (usize, u64, Message);

/// Number of no work.
pub const NONE: u64 = u64::MAX;

/// Threads that run the same program.
pub struct Threads {
    program: Program,
    slots: Vec<Option<Thread>>,
    started: u64,
    outbox: Sender<Report>,
    inbox: Receiver<Report>,
    repaint: Arc<dyn Fn() + Send + Sync>,
}

impl Threads {
    /// Creates places for `count` threads. `repaint` is called with every message, from its thread.
    pub fn new(program: Program, count: usize, repaint: impl Fn() + Send + Sync + 'static) -> Self {
        let (outbox, inbox) = channel();
        Self {
            program,
            slots: (0..count).map(|_| None).collect(),
            started: 0,
            outbox,
            inbox,
            repaint: Arc::new(repaint),
        }
    }

    /// Returns the next message with the index of its thread; `None` if no more have come.
    pub fn message(&mut self) -> Option<(usize, Message)> {
        self.inbox
            .try_iter()
            .find_map(|(index, incarnation, message)| {
                let thread = self.slots[index].as_ref();
                let is_present = thread.is_some_and(|thread| thread.incarnation == incarnation);
                is_present.then_some((index, message))
            })
    }

    /// Ends a thread as if it had crashed without a message. Returns whether there was such a
    /// thread.
    pub fn kill(&mut self, index: usize) -> bool {
        let Some(Some(thread)) = self.slots.get_mut(index) else {
            return false;
        };
        thread.wanted.store(NONE, Ordering::Relaxed);
        thread.requests = channel().0;
        true
    }
}

impl Workers for Threads {
    fn restart(&mut self, index: usize) -> Result<(), String> {
        self.end(index);
        self.started += 1;
        let (requests, inbox) = channel();
        let wanted = Arc::new(AtomicU64::new(0));
        let incarnation = self.started;
        let (outbox, repaint) = (self.outbox.clone(), self.repaint.clone());
        let (serve, shared) = (self.program.serve, wanted.clone());
        std::thread::Builder::new()
            .name(format!("worker {index}"))
            .spawn(move || {
                let send = |message| {
                    let sent = outbox.send((index, incarnation, message)).is_ok();
                    repaint();
                    sent
                };
                let outcome = catch_unwind(AssertUnwindSafe(|| {
                    serve(&inbox, &shared, &|bytes| send(Message::Bytes(bytes)));
                }));
                if let Err(panic) = outcome {
                    let reason = panic
                        .downcast_ref::<String>()
                        .cloned()
                        .or_else(|| panic.downcast_ref::<&str>().map(|s| (*s).to_owned()))
                        .unwrap_or_else(|| String::from("a worker panicked"));
                    send(Message::Failed(reason));
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
        // Its inbox is closed with this, so it ends once it gives up the present work.
        if let Some(thread) = self.slots[index].take() {
            thread.wanted.store(NONE, Ordering::Relaxed);
        }
    }

    fn send(&mut self, index: usize, request: &[u8]) {
        if let Some(thread) = &self.slots[index] {
            if let Some(number) = (self.program.number)(request) {
                thread.wanted.store(number, Ordering::Relaxed);
            }
            // A thread that is gone has reported why, or is found hanging.
            let _ = thread.requests.send(request.to_vec());
        }
    }
}
