//! The jobs of one tools worker, as a state machine without worker or clock.
//!
//! Events go in (a job was submitted or cancelled, the worker started, answered, died; time
//! passed), [`Command`]s come out. Rules:
//!
//! - Jobs run one at a time in the order of their submission. The worker is started for the first
//!   one and ended after [`IDLE_LIMIT`] seconds without a job, because a wasm's memory never
//!   shrinks.
//! - Cancelling the running job ends the worker: a job may compute for seconds without looking at
//!   messages.
//! - A worker that dies, or gives no sign of life for [`SILENCE_LIMIT`] seconds, is replaced (see
//!   [`Life`]) and its job repeated. A job at which [`ATTEMPTS`] workers failed has failed. If the
//!   worker is given up, all waiting jobs have failed.

use crate::life::{Life, Stage};
use std::collections::VecDeque;

/// Failures after which a job is given up.
pub const ATTEMPTS: u32 = 2;
/// Seconds that a running job may be silent.
pub const SILENCE_LIMIT: f64 = 60.0;
/// Seconds after which a worker without a job is ended.
pub const IDLE_LIMIT: f64 = 20.0;

/// An action of the owner of the worker.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// End the worker if it runs, and start a new one.
    Restart,
    /// End the worker.
    End,
    /// Send the worker this job.
    Run(u64),
    /// Report that this job has failed, for this reason.
    Fail(u64, String),
}

#[derive(Debug)]
struct Job {
    id: u64,
    failures: u32,
}

/// The jobs of a worker and its life.
#[derive(Debug, Default)]
pub struct Queue {
    life: Life,
    /// Whether workers can be started.
    launched: bool,
    waiting: VecDeque<Job>,
    running: Option<Job>,
    commands: Vec<Command>,
}

impl Queue {
    /// Takes the commands to carry out now, in this order.
    pub fn commands(&mut self) -> Vec<Command> {
        std::mem::take(&mut self.commands)
    }

    /// Notes that workers can be started from now on.
    pub fn launch(&mut self, now: f64) {
        self.launched = true;
        self.next(now);
    }

    /// Lets all jobs fail, as workers cannot be started at all for this reason.
    pub fn unavailable(&mut self, reason: &str) {
        self.end();
        for job in self
            .running
            .take()
            .into_iter()
            .chain(self.waiting.drain(..))
        {
            self.commands.push(Command::Fail(job.id, reason.to_owned()));
        }
    }

    /// Adds a job. Numbers must be unique.
    pub fn submit(&mut self, id: u64, now: f64) {
        self.waiting.push_back(Job { id, failures: 0 });
        self.next(now);
    }

    /// Forgets a job.
    pub fn cancel(&mut self, id: u64, now: f64) {
        self.waiting.retain(|job| job.id != id);
        if self.running.take_if(|job| job.id == id).is_some() {
            self.end();
            self.next(now);
        }
    }

    /// Notes that the worker takes requests.
    pub fn note_start(&mut self, now: f64) {
        if self.life.awake(now) {
            self.next(now);
        }
    }

    /// Notes progress of a job. Returns whether it is the running one.
    pub fn progress(&mut self, id: u64, now: f64) -> bool {
        self.life.hear(now);
        self.is_running(id)
    }

    /// Notes the end of a job. Returns whether it is the running one, so that its result is wanted.
    pub fn note_end(&mut self, id: u64, now: f64) -> bool {
        self.life.hear(now);
        let is_wanted = self.running.take_if(|job| job.id == id).is_some();
        if is_wanted {
            self.life.succeed();
        }
        self.next(now);
        is_wanted
    }

    /// Notes that the worker died, or said that it cannot continue.
    pub fn note_death(&mut self, reason: &str, now: f64) {
        if self.life.die().is_none() {
            return;
        }
        if let Some(mut job) = self.running.take() {
            job.failures += 1;
            if job.failures < ATTEMPTS {
                self.waiting.push_front(job);
            } else {
                self.commands.push(Command::Fail(job.id, reason.to_owned()));
            }
        }
        self.commands.push(Command::End);
        if self.life.stage() == Stage::GivenUp {
            self.unavailable(&format!("No worker could be started: {reason}"));
        }
        self.next(now);
    }

    /// Notes that time has passed: replaces a worker that hangs, ends one without a job.
    pub fn tick(&mut self, now: f64) {
        let since = self.life.since();
        let work = self.running.is_some();
        let work = work.then_some((since + SILENCE_LIMIT, "it took too long"));
        if let Some(reason) = self.life.overdue(now, work) {
            self.note_death(reason, now);
        } else if self.life.is_awake() && work.is_none() && now - since > IDLE_LIMIT {
            self.end();
        }
    }

    /// Whether [`Queue::tick`] must be called: there is a worker.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.life.is_running()
    }

    fn is_running(&self, id: u64) -> bool {
        self.running.as_ref().is_some_and(|job| job.id == id)
    }

    fn end(&mut self) {
        if self.life.is_running() {
            self.life.end();
            self.commands.push(Command::End);
        }
    }

    /// Starts the next job, or the worker for it.
    fn next(&mut self, now: f64) {
        if self.running.is_some() || self.waiting.is_empty() {
            return;
        }
        if self.life.is_awake() {
            self.life.hear(now);
            self.running = self.waiting.pop_front();
            let id = self.running.iter().map(|job| Command::Run(job.id));
            self.commands.extend(id);
        } else if self.launched && !self.life.is_running() {
            self.life.start(now);
            self.commands.push(Command::Restart);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use Command::{End, Fail, Restart, Run};

    /// Returns a queue with a worker that runs job 1, submitted at time 0.
    fn running() -> Queue {
        let mut queue = Queue::default();
        queue.launch(0.0);
        assert_eq!(queue.commands(), [], "no worker before the first job");
        queue.submit(1, 0.0);
        assert_eq!(queue.commands(), [Restart]);
        queue.note_start(0.0);
        assert_eq!(queue.commands(), [Run(1)]);
        queue
    }

    /// Ticks until `end`, twice a second.
    fn wait(queue: &mut Queue, from: f64, end: f64) -> Vec<Command> {
        let mut now = from;
        while now < end {
            now += 0.5;
            queue.tick(now);
        }
        queue.commands()
    }

    #[test]
    fn jobs_run_one_after_the_other() {
        let mut queue = running();
        queue.submit(2, 1.0);
        queue.submit(3, 1.0);
        assert_eq!(queue.commands(), []);
        assert!(queue.progress(1, 1.5) && !queue.progress(2, 1.5));
        assert!(!queue.note_end(2, 2.0), "it is not running");
        assert!(queue.note_end(1, 2.0));
        assert_eq!(queue.commands(), [Run(2)]);
        assert!(queue.note_end(2, 3.0));
        assert_eq!(queue.commands(), [Run(3)]);
    }

    #[test]
    fn jobs_wait_until_workers_can_be_started() {
        let mut queue = Queue::default();
        queue.submit(1, 0.0);
        assert_eq!(queue.commands(), []);
        queue.launch(1.0);
        assert_eq!(queue.commands(), [Restart]);
    }

    #[test]
    fn idle_worker_is_ended() {
        let mut queue = running();
        queue.note_end(1, 1.0);
        assert_eq!(wait(&mut queue, 1.0, IDLE_LIMIT), []);
        assert_eq!(wait(&mut queue, IDLE_LIMIT, IDLE_LIMIT + 2.0), [End]);
        assert!(!queue.is_busy());
        queue.submit(2, 60.0);
        assert_eq!(queue.commands(), [Restart]);
    }

    #[test]
    fn cancelling_a_running_job_ends_the_worker_and_others_continue() {
        let mut queue = running();
        for id in [2, 3] {
            queue.submit(id, 0.0);
        }
        queue.cancel(2, 1.0);
        assert_eq!(queue.commands(), [], "it had not begun");
        queue.cancel(1, 1.0);
        assert_eq!(queue.commands(), [End, Restart]);
        assert!(!queue.note_end(1, 1.1), "an answer that was on its way");
        queue.note_start(1.2);
        assert_eq!(queue.commands(), [Run(3)]);
        queue.cancel(3, 2.0);
        assert_eq!(queue.commands(), [End]);
        assert!(!queue.is_busy());
    }

    #[test]
    fn job_of_a_dead_worker_is_repeated_once() {
        let mut queue = running();
        queue.submit(2, 0.0);
        queue.note_death("memory", 1.0);
        assert_eq!(queue.commands(), [End, Restart]);
        queue.note_start(1.1);
        assert_eq!(queue.commands(), [Run(1)]);
        queue.note_death("memory", 2.0);
        assert_eq!(
            queue.commands(),
            [Fail(1, String::from("memory")), End, Restart]
        );
        queue.note_start(2.1);
        assert_eq!(queue.commands(), [Run(2)]);
    }

    #[test]
    fn hanging_worker_is_replaced_and_progress_is_a_sign_of_life() {
        let mut queue = running();
        queue.progress(1, 10.0);
        assert_eq!(wait(&mut queue, 10.0, 10.0 + SILENCE_LIMIT), []);
        assert_eq!(
            wait(&mut queue, 10.0 + SILENCE_LIMIT, 12.0 + SILENCE_LIMIT),
            [End, Restart]
        );
        // Starting may not take forever, either: the third failure to start fails the job.
        let commands = wait(&mut queue, 80.0, 200.0);
        assert_eq!(commands[..5], [End, Restart, End, Restart, End]);
        assert!(matches!(&commands[5], Fail(1, reason) if reason.contains("too long to start")));
        assert!(!queue.is_busy());
    }

    #[test]
    fn late_answer_saves_a_suspected_worker() {
        let mut queue = running();
        queue.tick(100.0); // the page was busy; the timer comes before the worker's message
        assert!(queue.progress(1, 100.1));
        assert_eq!(wait(&mut queue, 100.1, 150.0), []);
    }

    #[test]
    fn idle_worker_may_die_without_harm() {
        let mut queue = running();
        queue.note_end(1, 1.0);
        queue.note_death("gone", 2.0);
        assert_eq!(queue.commands(), [End]);
        queue.note_death("gone again", 2.0);
        assert_eq!(queue.commands(), []);
    }
}
