//! The tools of native builds, for tests: a thread in the place of the tools worker.

use crate::threads::{Report, Threads};
use crate::tool_jobs::{ToolEvent, ToolsCore};
use std::sync::atomic::AtomicU64;
use std::sync::mpsc::{Receiver, channel};
use std::time::Instant;
use tools::message::unpack;
use tools::{Answer, Job, Output, Progress, Request, run};

/// How a job is run.
type Runner = fn(Job, &mut Progress<'_>) -> Result<Output, String>;

/// Runs jobs that take long apart from the app; see [`ToolEvent`].
///
/// ```
/// # #[cfg(not(target_arch = "wasm32"))] {
/// use pool::ToolEvent;
/// let mut tools = pool::Tools::new(|| {});
/// let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
/// let id = tools.submit(tools::Job::ReadMesh {
///     name: "triangle.obj".into(),
///     bytes: text.into(),
/// });
/// let done = loop {
///     if let Some((of, ToolEvent::Done(result))) = tools.poll().pop() {
///         assert_eq!(of, id);
///         break result;
///     }
/// };
/// let Ok(tools::Output::Mesh(mesh)) = done else { panic!() };
/// assert_eq!(mesh.positions.len(), 3);
/// # }
/// ```
pub struct Tools {
    core: ToolsCore<Threads<Answer>>,
    reports: Receiver<Report<Answer>>,
    clock: Instant,
}

fn serve(inbox: &Receiver<Vec<u8>>, send: &dyn Fn(Answer) -> bool, run: Runner) {
    let mut listened = send(Answer::Started);
    while listened {
        let Ok(bytes) = inbox.recv() else { return };
        match unpack(&bytes) {
            Ok(Request { id, job }) => {
                let mut report = |fraction| {
                    send(Answer::Progress { id, fraction });
                };
                let mut pass = |output| {
                    send(Answer::Partial { id, output });
                };
                let result = run(job, &mut Progress::new(&mut report).passing(&mut pass));
                listened = send(Answer::Done { id, result });
            }
            Err(error) => listened = send(Answer::Failed(error.to_string())),
        }
    }
}

impl Tools {
    /// Prepares the tools; their worker is started with the first job. `repaint` is called, from any
    /// thread, when there is something to [`Tools::poll`].
    #[must_use]
    pub fn new(repaint: impl Fn() + Send + Sync + 'static) -> Self {
        Self::with(run, repaint)
    }

    fn with(run: Runner, repaint: impl Fn() + Send + Sync + 'static) -> Self {
        let (sender, reports) = channel();
        let body =
            move |inbox: &Receiver<Vec<u8>>, _: &AtomicU64, send: &dyn Fn(Answer) -> bool| {
                serve(inbox, send, run);
            };
        let threads = Threads::new(1, sender, repaint, body, Answer::Failed, |_| None);
        let mut core = ToolsCore::new(threads);
        core.launch(0.0);
        Self {
            core,
            reports,
            clock: Instant::now(),
        }
    }

    fn now(&self) -> f64 {
        self.clock.elapsed().as_secs_f64()
    }

    /// Queues a job and returns its number.
    pub fn submit(&mut self, job: Job) -> u64 {
        self.core.submit(job, self.now())
    }

    /// Forgets a job; no event of it follows.
    pub fn cancel(&mut self, id: u64) {
        self.core.cancel(id, self.now());
    }

    /// Returns the events since the last call, with the numbers of their jobs.
    pub fn poll(&mut self) -> Vec<(u64, ToolEvent)> {
        while let Ok((index, incarnation, answer)) = self.reports.try_recv() {
            if self.core.workers.is_present(index, incarnation) {
                self.core.answer(answer, self.now());
            }
        }
        self.core.tick(self.now());
        self.core.take()
    }

    /// Ends the worker without telling the supervisor. For tests. Returns whether there was a worker.
    pub fn kill_worker(&mut self) -> bool {
        self.core.workers.kill(0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    /// Reads a mesh, but panics or sleeps if its name says so.
    fn unreliable(job: Job, progress: &mut Progress<'_>) -> Result<Output, String> {
        let Job::ReadMesh { name, .. } = &job else {
            return run(job, progress);
        };
        match name.as_str() {
            "panic.obj" => panic!("on purpose"),
            "slow.obj" => std::thread::sleep(Duration::from_millis(400)),
            _ => {}
        }
        run(job, progress)
    }

    fn read(name: &str) -> Job {
        Job::ReadMesh {
            name: name.into(),
            bytes: "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".into(),
        }
    }

    /// Polls until a job is over. Returns its number and result.
    fn next_done(tools: &mut Tools) -> (u64, Result<Output, String>) {
        let deadline = Instant::now() + Duration::from_secs(60);
        loop {
            for (id, event) in tools.poll() {
                if let ToolEvent::Done(result) = event {
                    return (id, result);
                }
            }
            assert!(Instant::now() < deadline);
            std::thread::sleep(Duration::from_millis(1));
        }
    }

    #[test]
    fn job_that_panics_fails_and_the_next_one_is_run() {
        let mut tools = Tools::with(unreliable, || {});
        let bad = tools.submit(read("panic.obj"));
        let good = tools.submit(read("a.obj"));
        let (first, result) = next_done(&mut tools);
        assert_eq!(first, bad);
        assert!(result.unwrap_err().contains("on purpose"));
        let (second, result) = next_done(&mut tools);
        assert_eq!(second, good);
        assert!(result.is_ok());
    }

    #[test]
    fn cancelled_job_gives_no_event_and_does_not_delay_the_next() {
        let mut tools = Tools::with(unreliable, || {});
        let slow = tools.submit(read("slow.obj"));
        let quick = tools.submit(read("a.obj"));
        std::thread::sleep(Duration::from_millis(50));
        let _ = tools.poll();
        tools.cancel(slow);
        let begin = Instant::now();
        assert_eq!(next_done(&mut tools).0, quick);
        assert!(begin.elapsed() < Duration::from_millis(350));
        std::thread::sleep(Duration::from_millis(500));
        assert_eq!(tools.poll(), [], "the slow job was heard of");
    }

    #[test]
    fn broken_file_is_an_error_not_a_failure_of_the_worker() {
        let mut tools = Tools::new(|| {});
        tools.submit(Job::ReadMesh {
            name: "a.ply".into(),
            bytes: b"no".to_vec(),
        });
        let message = next_done(&mut tools).1.unwrap_err();
        assert!(message.contains("PLY"), "{message}");
    }
}
