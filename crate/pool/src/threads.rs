//! Threads in the place of web workers, for tests.

use crate::workers::Workers;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};

/// A message from a thread: index, which thread of that index it was, answer.
pub type Report<A> = (usize, u64, A);
/// Serves requests until its inbox or the pool's is closed. The number is that of the work wanted from
/// the thread, as the last request said; it changes when the present work is given up.
type Body<A> = dyn Fn(&Receiver<Vec<u8>>, &AtomicU64, &dyn Fn(A) -> bool) + Send + Sync;

struct Thread {
    requests: Sender<Vec<u8>>,
    wanted: Arc<AtomicU64>,
    incarnation: u64,
}

/// No work has this number.
const NONE: u64 = u64::MAX;

/// Threads with answers of type `A`.
pub struct Threads<A> {
    slots: Vec<Option<Thread>>,
    started: u64,
    reports: Sender<Report<A>>,
    repaint: Arc<dyn Fn() + Send + Sync>,
    body: Arc<Body<A>>,
    failed: fn(String) -> A,
    number: fn(&[u8]) -> Option<u64>,
}

impl<A: Send + 'static> Threads<A> {
    /// Creates places for `count` threads, each of which runs `body`. `failed` makes the answer of a
    /// thread that panics, `number` reads the number of the work wanted from a packed request.
    pub fn new(
        count: usize,
        reports: Sender<Report<A>>,
        repaint: impl Fn() + Send + Sync + 'static,
        body: impl Fn(&Receiver<Vec<u8>>, &AtomicU64, &dyn Fn(A) -> bool) + Send + Sync + 'static,
        failed: fn(String) -> A,
        number: fn(&[u8]) -> Option<u64>,
    ) -> Self {
        Self {
            slots: (0..count).map(|_| None).collect(),
            started: 0,
            reports,
            repaint: Arc::new(repaint),
            body: Arc::new(body),
            failed,
            number,
        }
    }

    /// Whether a report is of the thread that has this index now.
    pub fn is_present(&self, index: usize, incarnation: u64) -> bool {
        let thread = self.slots[index].as_ref();
        thread.is_some_and(|thread| thread.incarnation == incarnation)
    }

    /// Ends a thread as if it had crashed without a message. Returns whether there was such a thread.
    pub fn kill(&mut self, index: usize) -> bool {
        let Some(Some(thread)) = self.slots.get_mut(index) else {
            return false;
        };
        thread.wanted.store(NONE, Ordering::Relaxed);
        thread.requests = channel().0;
        true
    }
}

impl<A: Send + 'static> Workers for Threads<A> {
    fn restart(&mut self, index: usize) -> Result<(), String> {
        self.end(index);
        self.started += 1;
        let (requests, inbox) = channel();
        let wanted = Arc::new(AtomicU64::new(0));
        let incarnation = self.started;
        let (outbox, repaint) = (self.reports.clone(), self.repaint.clone());
        let (body, failed, shared) = (self.body.clone(), self.failed, wanted.clone());
        std::thread::Builder::new()
            .name(format!("worker {index}"))
            .spawn(move || {
                let send = |answer| {
                    let sent = outbox.send((index, incarnation, answer)).is_ok();
                    repaint();
                    sent
                };
                let work = || body(&inbox, &shared, &send);
                if let Err(panic) = catch_unwind(AssertUnwindSafe(work)) {
                    let reason = panic
                        .downcast_ref::<String>()
                        .cloned()
                        .or_else(|| panic.downcast_ref::<&str>().map(|s| (*s).to_owned()))
                        .unwrap_or_else(|| String::from("a worker panicked"));
                    send(failed(reason));
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
            if let Some(number) = (self.number)(request) {
                thread.wanted.store(number, Ordering::Relaxed);
            }
            // A thread that is gone has reported why, or is found hanging.
            let _ = thread.requests.send(request.to_vec());
        }
    }
}
