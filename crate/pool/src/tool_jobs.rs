//! Jobs of the tools worker: the part that is the same for web workers and threads.

use crate::supervisor::{Command, Supervisor};
use crate::workers::Workers;
use std::collections::BTreeMap;
use tools::message::pack;
use tools::{Answer, Job, Output, Request};

/// An event of a job.
#[derive(Clone, Debug, PartialEq)]
pub enum ToolEvent {
    /// The fraction done, 0 … 1.
    Progress(f32),
    /// What there is of the result so far.
    Partial(Output),
    /// The job is over, with its result or an error message for the user. No event of it follows.
    Done(Result<Output, String>),
}

/// The tools without their worker, which has the index 0.
pub(crate) struct ToolsCore<W> {
    pub supervisor: Supervisor,
    pub workers: W,
    last: u64,
    /// Packed requests of the jobs that are not over.
    requests: BTreeMap<u64, Vec<u8>>,
    events: Vec<(u64, ToolEvent)>,
}

impl<W: Workers> ToolsCore<W> {
    pub fn new(workers: W) -> Self {
        Self {
            supervisor: Supervisor::default(),
            workers,
            last: 0,
            requests: BTreeMap::new(),
            events: Vec::new(),
        }
    }

    pub fn submit(&mut self, job: Job, now: f64) -> u64 {
        self.last += 1;
        let id = self.last;
        match pack(&Request { id, job }) {
            Ok(bytes) => {
                self.requests.insert(id, bytes);
                self.supervisor.submit(id, now);
            }
            Err(error) => self
                .events
                .push((id, ToolEvent::Done(Err(error.to_string())))),
        }
        self.carry_out(now);
        id
    }

    pub fn cancel(&mut self, id: u64, now: f64) {
        self.requests.remove(&id);
        self.events.retain(|event| event.0 != id);
        self.supervisor.cancel(id, now);
        self.carry_out(now);
    }

    pub fn launch(&mut self, now: f64) {
        self.supervisor.launch(now);
        self.carry_out(now);
    }

    /// Notes that time has passed. Returns whether there are events to take.
    pub fn tick(&mut self, now: f64) -> bool {
        self.supervisor.tick(now);
        self.carry_out(now);
        !self.events.is_empty()
    }

    /// Takes an answer of the worker. Returns whether there are events to take.
    pub fn answer(&mut self, answer: Answer, now: f64) -> bool {
        match answer {
            Answer::Started => self.supervisor.started(now),
            Answer::Progress { id, fraction } => {
                if self.supervisor.progress(id, now) {
                    self.events.push((id, ToolEvent::Progress(fraction)));
                }
            }
            Answer::Partial { id, output } => {
                if self.supervisor.progress(id, now) {
                    self.events.push((id, ToolEvent::Partial(output)));
                }
            }
            Answer::Done { id, result } => {
                if self.supervisor.done(id, now) {
                    self.finish(id, result);
                }
            }
            Answer::Failed(reason) => self.supervisor.died(&reason, now),
        }
        self.carry_out(now);
        !self.events.is_empty()
    }

    /// Returns the events since the last call, with the numbers of their jobs.
    pub fn take(&mut self) -> Vec<(u64, ToolEvent)> {
        std::mem::take(&mut self.events)
    }

    fn finish(&mut self, id: u64, result: Result<Output, String>) {
        self.requests.remove(&id);
        self.events.push((id, ToolEvent::Done(result)));
    }

    /// Carries out the supervisor's commands. A worker that cannot be started leads to new commands, so this repeats
    /// until there are none; the supervisor gives up after some attempts.
    fn carry_out(&mut self, now: f64) {
        loop {
            let commands = self.supervisor.commands();
            if commands.is_empty() {
                return;
            }
            for command in commands {
                match command {
                    Command::Restart => {
                        if let Err(reason) = self.workers.restart(0) {
                            self.supervisor.died(&reason, now);
                        }
                    }
                    Command::End => self.workers.end(0),
                    Command::Run(id) => {
                        if let Some(request) = self.requests.get(&id) {
                            self.workers.send(0, request);
                        }
                    }
                    Command::Fail(id, reason) => {
                        self.finish(id, Err(format!("The tools stopped: {reason}")));
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A worker that is never started.
    struct Refused(usize);

    impl Workers for Refused {
        fn restart(&mut self, _: usize) -> Result<(), String> {
            self.0 += 1;
            Err(String::from("no memory"))
        }

        fn end(&mut self, _: usize) {}

        fn send(&mut self, _: usize, _: &[u8]) {
            panic!("there is no worker");
        }
    }

    #[test]
    fn jobs_fail_if_no_worker_can_be_started() {
        let mut core = ToolsCore::new(Refused(0));
        core.launch(0.0);
        for attempt in 1..=2 {
            let job = Job::ReadMesh {
                name: String::new(),
                bytes: Vec::new(),
            };
            let id = core.submit(job, 0.0);
            let events = core.take();
            assert!(
                matches!(&events[..], [(of, ToolEvent::Done(Err(reason)))]
                    if *of == id && reason.contains("no memory")),
                "{events:?}"
            );
            assert_eq!(core.workers.0, 2 * attempt);
        }
        assert!(core.requests.is_empty());
    }
}
