//! The tools: jobs that take long and draw nothing, and tickets for their results.

use crate::platform::{Crew, PlatformWorkers, Program, TOOLS};
use crate::queue::{Command, Queue};
use crate::workers::{Manager, Message, Workers};
use std::cell::RefCell;
use std::collections::{BTreeMap, VecDeque};
use std::rc::Rc;
use tools::message::{DIFFERENT_VERSIONS, unpack_answer};
use tools::{Answer, Job, Pace, Request, Work};

/// Carries out jobs apart from the app, in one worker for each [`Pace`]. Clones share the workers.
///
/// ```
/// # #[cfg(not(target_arch = "wasm32"))] {
/// let tools = pool::Tools::new(|| {});
/// let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
/// let mut ticket = tools.submit(tools::ReadMesh {
///     name: "triangle.obj".into(),
///     bytes: text.into(),
/// });
/// let read = loop {
///     if let Some(result) = ticket.result() {
///         break result;
///     }
/// };
/// assert_eq!(read.unwrap().0.positions.len(), 3);
/// # }
/// ```
#[derive(Clone)]
pub struct Tools {
    crew: Crew<Jobs<PlatformWorkers>>,
}

impl Tools {
    /// Prepares the tools; a worker is started with the first job for it. `repaint` is called when
    /// there is news for a [`Ticket`]; native builds call it from any thread.
    #[must_use]
    pub fn new(repaint: impl Fn() + Send + Sync + 'static) -> Self {
        Self::with(TOOLS, repaint)
    }

    fn with(program: Program, repaint: impl Fn() + Send + Sync + 'static) -> Self {
        Self {
            crew: Crew::new(program, Pace::ALL.len(), repaint, Jobs::new),
        }
    }

    /// Submits a job. It is carried out after those of its [`Pace`] that were submitted before.
    #[must_use = "a job whose ticket is dropped is cancelled"]
    pub fn submit<J: Job + Into<Work>>(&self, job: J) -> Ticket<J::Output> {
        let (id, news) = self.crew.order(|jobs, now| jobs.submit(job, now));
        Ticket {
            crew: self.crew.clone(),
            id,
            news,
        }
    }
}

/// News of a job that have not been taken yet.
struct News<T> {
    /// The fraction done, once it has begun.
    fraction: Option<f32>,
    parts: VecDeque<T>,
    result: Option<Result<T, String>>,
}

/// A job that was submitted. Dropping it cancels the job.
pub struct Ticket<T> {
    crew: Crew<Jobs<PlatformWorkers>>,
    id: u64,
    news: Rc<RefCell<News<T>>>,
}

impl<T> Ticket<T> {
    /// Returns the fraction done, 0 … 1; `None` while the job waits for its turn.
    #[must_use]
    pub fn fraction(&self) -> Option<f32> {
        self.crew.catch_up();
        self.news.borrow().fraction
    }

    /// Takes the next part of the result that the job has passed on before its end.
    pub fn part(&mut self) -> Option<T> {
        self.crew.catch_up();
        self.news.borrow_mut().parts.pop_front()
    }

    /// Takes the result, or an error message for the user, once the job is over.
    pub fn result(&mut self) -> Option<Result<T, String>> {
        self.crew.catch_up();
        self.news.borrow_mut().result.take()
    }
}

impl<T> Drop for Ticket<T> {
    fn drop(&mut self) {
        self.crew.ask(|jobs, now| jobs.cancel(self.id, now));
    }
}

/// News of a job, packed.
enum Event<'a> {
    Fraction(f32),
    Part(&'a [u8]),
    Over(Result<&'a [u8], String>),
}

/// A job that is not over.
struct Sent {
    /// Index of its worker.
    worker: usize,
    request: Vec<u8>,
    /// Unpacks news for the ticket.
    tell: Box<dyn FnMut(Event<'_>)>,
}

/// The manager of the tools workers.
struct Jobs<W> {
    /// The queue of each worker.
    queues: [Queue; Pace::ALL.len()],
    workers: W,
    last: u64,
    sent: BTreeMap<u64, Sent>,
    /// Whether there is news that the app was not woken for.
    has_news: bool,
}

impl<W: Workers> Jobs<W> {
    fn new(workers: W) -> Self {
        Self {
            queues: Default::default(),
            workers,
            last: 0,
            sent: BTreeMap::new(),
            has_news: false,
        }
    }

    /// Queues a job. Returns its number, and the place where its news arrive.
    fn submit<J: Job + Into<Work>>(
        &mut self,
        job: J,
        now: f64,
    ) -> (u64, Rc<RefCell<News<J::Output>>>) {
        self.last += 1;
        let id = self.last;
        let news = Rc::new(RefCell::new(News {
            fraction: None,
            parts: VecDeque::new(),
            result: None,
        }));
        let request = Request {
            id,
            work: job.into(),
        };
        match postcard::to_allocvec(&request) {
            Ok(request) => {
                let worker = J::PACE as usize;
                let place = news.clone();
                let sent = Sent {
                    worker,
                    request,
                    tell: Box::new(move |event| note::<J>(&mut place.borrow_mut(), event)),
                };
                self.sent.insert(id, sent);
                self.queues[worker].submit(id, now);
                self.carry_out(worker, now);
            }
            Err(error) => news.borrow_mut().result = Some(Err(error.to_string())),
        }
        (id, news)
    }

    /// Forgets a job, unless it is over.
    fn cancel(&mut self, id: u64, now: f64) {
        if let Some(sent) = self.sent.remove(&id) {
            self.queues[sent.worker].cancel(id, now);
            self.carry_out(sent.worker, now);
        }
    }

    fn tell(&mut self, id: u64, event: Event<'_>) {
        if let Some(sent) = self.sent.get_mut(&id) {
            (sent.tell)(event);
            self.has_news = true;
        }
    }

    fn finish(&mut self, id: u64, result: Result<&[u8], String>) {
        self.tell(id, Event::Over(result));
        self.sent.remove(&id);
    }

    /// Carries out the commands of a worker's queue. A worker that cannot be started leads to new
    /// commands, so this repeats until there are none; it is given up after some attempts.
    fn carry_out(&mut self, index: usize, now: f64) {
        loop {
            let commands = self.queues[index].commands();
            if commands.is_empty() {
                return;
            }
            for command in commands {
                match command {
                    Command::Restart => {
                        if let Err(reason) = self.workers.restart(index) {
                            self.queues[index].note_death(&reason, now);
                        }
                    }
                    Command::End => self.workers.end(index),
                    Command::Run(id) => {
                        if let Some(sent) = self.sent.get(&id) {
                            self.workers.send(index, &sent.request);
                        }
                    }
                    Command::Fail(id, reason) => {
                        self.finish(id, Err(format!("The tools stopped: {reason}")));
                    }
                }
            }
        }
    }

    /// Does something with each queue and carries out its commands.
    fn for_all(&mut self, now: f64, note: impl Fn(&mut Queue)) {
        for index in 0..self.queues.len() {
            note(&mut self.queues[index]);
            self.carry_out(index, now);
        }
    }
}

/// Unpacks news of a job.
fn note<J: Job>(news: &mut News<J::Output>, event: Event<'_>) {
    match event {
        Event::Fraction(fraction) => news.fraction = Some(fraction),
        Event::Part(bytes) => news.parts.extend(postcard::from_bytes(bytes)),
        Event::Over(result) => {
            let result = result.and_then(|bytes| {
                postcard::from_bytes(bytes).map_err(|_| DIFFERENT_VERSIONS.to_owned())
            });
            news.result = Some(result);
        }
    }
}

impl<W: Workers + 'static> Manager for Jobs<W> {
    type Workers = W;

    fn workers(&mut self) -> &mut W {
        &mut self.workers
    }

    fn note_program(&mut self, outcome: Result<(), String>, now: f64) {
        match outcome {
            Ok(()) => self.for_all(now, |queue| queue.launch(now)),
            Err(reason) => {
                let reason = format!("{reason}. Check the connection and try again.");
                self.for_all(now, |queue| queue.unavailable(&reason));
            }
        }
    }

    fn receive(&mut self, index: usize, message: Message, now: f64) -> bool {
        let (answer, output) = match &message {
            Message::Bytes(bytes) => unpack_answer(bytes)
                .unwrap_or_else(|_| (Answer::Failed(DIFFERENT_VERSIONS.to_owned()), &[])),
            Message::Failed(reason) => (Answer::Failed(reason.clone()), &[][..]),
        };
        let queue = &mut self.queues[index];
        match answer {
            Answer::Started => queue.note_start(now),
            Answer::Progress { id, fraction } => {
                if queue.progress(id, now) {
                    self.tell(id, Event::Fraction(fraction));
                }
            }
            Answer::Part { id } => {
                if queue.progress(id, now) {
                    self.tell(id, Event::Part(output));
                }
            }
            Answer::Done { id } => {
                if queue.note_end(id, now) {
                    self.finish(id, Ok(output));
                }
            }
            Answer::Refused { id, trouble } => {
                if queue.note_end(id, now) {
                    self.finish(id, Err(trouble));
                }
            }
            Answer::Failed(reason) => queue.note_death(&reason, now),
        }
        self.carry_out(index, now);
        std::mem::take(&mut self.has_news)
    }

    fn tick(&mut self, now: f64) -> bool {
        self.for_all(now, |queue| queue.tick(now));
        std::mem::take(&mut self.has_news)
    }

    fn is_busy(&self) -> bool {
        self.queues.iter().any(Queue::is_busy)
    }
}

#[cfg(all(test, not(target_arch = "wasm32")))]
mod tests;
