//! Decisions about the tools worker as a state machine without worker or clock.
//!
//! Events go in (a job was submitted or cancelled, the worker started, answered, died; time passed), [`Command`]s come
//! out. Rules:
//!
//! - Jobs run one at a time in the order of their submission. The worker is started for the first one and ended after
//!   [`IDLE_LIMIT`] seconds without a job, because a wasm's memory never shrinks.
//! - Cancelling the running job ends the worker: a job may compute for seconds without looking at messages.
//! - A worker that dies, or gives no sign of life for [`SILENCE_LIMIT`] seconds, is replaced and its job repeated. A job
//!   at which [`ATTEMPTS`] workers failed has failed. If [`ATTEMPTS`] workers in a row cannot be started, all waiting jobs
//!   have failed; the next job is tried all the same.

use std::collections::VecDeque;

/// Failures after which a job or starting a worker is given up.
pub const ATTEMPTS: u32 = 2;
/// Seconds that a worker may take to start.
pub const START_LIMIT: f64 = 30.0;
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

#[derive(Clone, Copy, Debug, PartialEq)]
enum Life {
    Asleep,
    Starting,
    Awake,
}

#[derive(Debug)]
struct Job {
    id: u64,
    failures: u32,
}

/// State of the tools worker and its jobs.
#[derive(Debug)]
pub struct Supervisor {
    life: Life,
    /// Whether workers can be started.
    launched: bool,
    queue: VecDeque<Job>,
    running: Option<Job>,
    /// Last sign of life, or when the worker became idle.
    since: f64,
    /// Whether the last tick found the worker late. Its answer may only wait for a busy page, so it gets until the next.
    suspected: bool,
    failed_starts: u32,
    commands: Vec<Command>,
}

impl Default for Supervisor {
    fn default() -> Self {
        Self {
            life: Life::Asleep,
            launched: false,
            queue: VecDeque::new(),
            running: None,
            since: 0.0,
            suspected: false,
            failed_starts: 0,
            commands: Vec::new(),
        }
    }
}

impl Supervisor {
    /// Takes the commands to carry out now, in this order.
    pub fn commands(&mut self) -> Vec<Command> {
        std::mem::take(&mut self.commands)
    }

    /// Notes that workers can be started from now on.
    pub fn launch(&mut self, now: f64) {
        self.launched = true;
        self.next(now);
    }

    /// Fails all jobs, because workers cannot be started at all for this reason.
    pub fn unavailable(&mut self, reason: &str) {
        self.end();
        let jobs = self.running.take().into_iter().chain(self.queue.drain(..));
        let fail = |job: Job| Command::Fail(job.id, reason.to_owned());
        self.commands.extend(jobs.map(fail));
    }

    /// Adds a job. Numbers must be unique.
    pub fn submit(&mut self, id: u64, now: f64) {
        self.queue.push_back(Job { id, failures: 0 });
        self.next(now);
    }

    /// Forgets a job.
    pub fn cancel(&mut self, id: u64, now: f64) {
        self.queue.retain(|job| job.id != id);
        if self.running.take_if(|job| job.id == id).is_some() {
            self.end();
            self.next(now);
        }
    }

    /// Notes that the worker takes requests.
    pub fn started(&mut self, now: f64) {
        if self.life == Life::Starting {
            self.life = Life::Awake;
            self.failed_starts = 0;
            self.heard(now);
            self.next(now);
        }
    }

    /// Notes progress of a job. Returns whether it is the running one.
    pub fn progress(&mut self, id: u64, now: f64) -> bool {
        self.heard(now);
        self.is_running(id)
    }

    /// Notes the end of a job. Returns whether it is the running one, so that its result is wanted.
    pub fn done(&mut self, id: u64, now: f64) -> bool {
        self.heard(now);
        let wanted = self.running.take_if(|job| job.id == id).is_some();
        self.next(now);
        wanted
    }

    /// Notes that the worker died, or said that it cannot continue.
    pub fn died(&mut self, reason: &str, now: f64) {
        match self.life {
            Life::Asleep => return,
            Life::Starting => self.failed_starts += 1,
            Life::Awake => {
                if let Some(mut job) = self.running.take() {
                    job.failures += 1;
                    if job.failures < ATTEMPTS {
                        self.queue.push_front(job);
                    } else {
                        self.commands.push(Command::Fail(job.id, reason.to_owned()));
                    }
                }
            }
        }
        self.end();
        if self.failed_starts >= ATTEMPTS {
            self.failed_starts = 0;
            self.unavailable(&format!("No worker could be started: {reason}"));
        }
        self.next(now);
    }

    /// Notes that time has passed: replaces a worker that hangs, ends one without a job.
    pub fn tick(&mut self, now: f64) {
        let waited = now - self.since;
        let late = match self.life {
            Life::Asleep => None,
            Life::Starting => (waited > START_LIMIT).then_some("the worker took too long to start"),
            Life::Awake if self.running.is_some() => {
                (waited > SILENCE_LIMIT).then_some("it took too long")
            }
            Life::Awake => {
                if waited > IDLE_LIMIT {
                    self.end();
                }
                None
            }
        };
        match late {
            Some(reason) if self.suspected => self.died(reason, now),
            late => self.suspected = late.is_some(),
        }
    }

    /// Whether [`Supervisor::tick`] must be called: there is a worker.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.life != Life::Asleep
    }

    /// Whether this job is being run.
    #[must_use]
    pub fn is_running(&self, id: u64) -> bool {
        self.running.as_ref().is_some_and(|job| job.id == id)
    }

    fn heard(&mut self, now: f64) {
        self.since = now;
        self.suspected = false;
    }

    fn end(&mut self) {
        if self.life != Life::Asleep {
            self.life = Life::Asleep;
            self.commands.push(Command::End);
        }
    }

    /// Starts the next job, or the worker for it.
    fn next(&mut self, now: f64) {
        if self.running.is_some() || self.queue.is_empty() {
            return;
        }
        match self.life {
            Life::Asleep if self.launched => {
                self.life = Life::Starting;
                self.heard(now);
                self.commands.push(Command::Restart);
            }
            Life::Awake => {
                self.running = self.queue.pop_front();
                let id = self.running.iter().map(|job| Command::Run(job.id));
                self.commands.extend(id);
                self.heard(now);
            }
            Life::Asleep | Life::Starting => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use Command::{End, Fail, Restart, Run};

    /// A supervisor with a worker that runs job 1, submitted at time 0.
    fn running() -> Supervisor {
        let mut supervisor = Supervisor::default();
        supervisor.launch(0.0);
        assert_eq!(supervisor.commands(), [], "no worker before the first job");
        supervisor.submit(1, 0.0);
        assert_eq!(supervisor.commands(), [Restart]);
        supervisor.started(0.0);
        assert_eq!(supervisor.commands(), [Run(1)]);
        supervisor
    }

    /// Ticks until `end`, twice a second.
    fn wait(supervisor: &mut Supervisor, from: f64, end: f64) -> Vec<Command> {
        let mut now = from;
        while now < end {
            now += 0.5;
            supervisor.tick(now);
        }
        supervisor.commands()
    }

    #[test]
    fn jobs_run_one_after_the_other() {
        let mut supervisor = running();
        supervisor.submit(2, 1.0);
        supervisor.submit(3, 1.0);
        assert_eq!(supervisor.commands(), []);
        assert!(supervisor.progress(1, 1.5) && !supervisor.progress(2, 1.5));
        assert!(!supervisor.done(2, 2.0), "it is not running");
        assert!(supervisor.done(1, 2.0));
        assert_eq!(supervisor.commands(), [Run(2)]);
        assert!(supervisor.done(2, 3.0));
        assert_eq!(supervisor.commands(), [Run(3)]);
    }

    #[test]
    fn jobs_wait_until_workers_can_be_started() {
        let mut supervisor = Supervisor::default();
        supervisor.submit(1, 0.0);
        assert_eq!(supervisor.commands(), []);
        supervisor.launch(1.0);
        assert_eq!(supervisor.commands(), [Restart]);
    }

    #[test]
    fn idle_worker_is_ended() {
        let mut supervisor = running();
        supervisor.done(1, 1.0);
        assert_eq!(wait(&mut supervisor, 1.0, IDLE_LIMIT), []);
        assert_eq!(wait(&mut supervisor, IDLE_LIMIT, IDLE_LIMIT + 2.0), [End]);
        assert!(!supervisor.is_busy());
        supervisor.submit(2, 60.0);
        assert_eq!(supervisor.commands(), [Restart]);
    }

    #[test]
    fn cancelling_a_running_job_ends_the_worker_and_others_continue() {
        let mut supervisor = running();
        for id in [2, 3] {
            supervisor.submit(id, 0.0);
        }
        supervisor.cancel(2, 1.0);
        assert_eq!(supervisor.commands(), [], "it had not begun");
        supervisor.cancel(1, 1.0);
        assert_eq!(supervisor.commands(), [End, Restart]);
        assert!(!supervisor.done(1, 1.1), "an answer that was on its way");
        supervisor.started(1.2);
        assert_eq!(supervisor.commands(), [Run(3)]);
        supervisor.cancel(3, 2.0);
        assert_eq!(supervisor.commands(), [End]);
        assert!(!supervisor.is_busy());
    }

    #[test]
    fn job_of_a_dead_worker_is_repeated_once() {
        let mut supervisor = running();
        supervisor.submit(2, 0.0);
        supervisor.died("memory", 1.0);
        assert_eq!(supervisor.commands(), [End, Restart]);
        supervisor.started(1.1);
        assert_eq!(supervisor.commands(), [Run(1)]);
        supervisor.died("memory", 2.0);
        assert_eq!(
            supervisor.commands(),
            [Fail(1, String::from("memory")), End, Restart]
        );
        supervisor.started(2.1);
        assert_eq!(supervisor.commands(), [Run(2)]);
    }

    #[test]
    fn hanging_worker_is_replaced_and_progress_is_a_sign_of_life() {
        let mut supervisor = running();
        supervisor.progress(1, 10.0);
        assert_eq!(wait(&mut supervisor, 10.0, 10.0 + SILENCE_LIMIT), []);
        assert_eq!(
            wait(&mut supervisor, 10.0 + SILENCE_LIMIT, 12.0 + SILENCE_LIMIT),
            [End, Restart]
        );
        // Nor may starting take forever: the second failure to start fails the job.
        let commands = wait(&mut supervisor, 80.0, 200.0);
        assert_eq!(commands[..3], [End, Restart, End]);
        assert!(matches!(&commands[3], Fail(1, reason) if reason.contains("too long to start")));
        assert!(!supervisor.is_busy());
    }

    #[test]
    fn late_answer_saves_a_suspected_worker() {
        let mut supervisor = running();
        supervisor.tick(100.0); // the page was busy; the timer comes before the worker's message
        assert!(supervisor.progress(1, 100.1));
        assert_eq!(wait(&mut supervisor, 100.1, 150.0), []);
    }

    #[test]
    fn idle_worker_may_die_without_harm() {
        let mut supervisor = running();
        supervisor.done(1, 1.0);
        supervisor.died("gone", 2.0);
        assert_eq!(supervisor.commands(), [End]);
        supervisor.died("gone again", 2.0);
        assert_eq!(supervisor.commands(), []);
    }
}
