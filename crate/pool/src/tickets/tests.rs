//! Jobs of threads, and of workers that cannot be started.

use super::*;
use crate::platform::{Outlet, run_job};
use std::sync::atomic::AtomicU64;
use std::sync::mpsc::Receiver;
use std::time::{Duration, Instant};
use tools::{CoatScene, ReadMesh, Work};

/// Carries out jobs, but panics or sleeps if the name of a mesh to be read says so.
fn serve(inbox: &Receiver<Vec<u8>>, wanted: &AtomicU64, send: &Outlet<'_>) {
    send(Answer::Started.to_bytes());
    for request in inbox {
        if let Ok(Request { work, .. }) = postcard::from_bytes(&request)
            && let Work::ReadMesh(job) = work
        {
            match job.name.as_str() {
                "panic.obj" => panic!("on purpose"),
                "slow.obj" => std::thread::sleep(Duration::from_millis(400)),
                _ => {}
            }
        }
        run_job(request, wanted, send);
    }
}

fn unreliable() -> Tools {
    let program = Program { serve, ..TOOLS };
    Tools::with(program, || {})
}

fn read(name: &str) -> ReadMesh {
    ReadMesh {
        name: name.into(),
        bytes: "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".into(),
    }
}

/// Waits until a job is over.
fn result<T>(ticket: &mut Ticket<T>) -> Result<T, String> {
    let deadline = Instant::now() + Duration::from_secs(60);
    loop {
        if let Some(result) = ticket.result() {
            return result;
        }
        assert!(Instant::now() < deadline);
        std::thread::sleep(Duration::from_millis(1));
    }
}

#[test]
fn job_that_panics_fails_and_the_next_one_is_run() {
    let tools = unreliable();
    let mut bad = tools.submit(read("panic.obj"));
    let mut good = tools.submit(read("a.obj"));
    assert!(result(&mut bad).unwrap_err().contains("on purpose"));
    assert!(result(&mut good).is_ok());
    assert!(good.fraction().is_some() && good.result().is_none());
}

#[test]
fn next_job_does_not_wait_for_a_cancelled_one() {
    let tools = unreliable();
    let slow = tools.submit(read("slow.obj"));
    let mut quick = tools.submit(read("a.obj"));
    std::thread::sleep(Duration::from_millis(50));
    assert_eq!(quick.fraction(), None);
    let news = slow.news.clone();
    drop(slow);
    let begin = Instant::now();
    assert!(result(&mut quick).is_ok());
    assert!(begin.elapsed() < Duration::from_millis(350));
    std::thread::sleep(Duration::from_millis(500));
    assert_eq!(quick.result(), None);
    assert!(news.borrow().result.is_none(), "the slow job was heard of");
}

#[test]
fn long_job_keeps_no_hand_waiting() {
    let tools = unreliable();
    let mut long = tools.submit(CoatScene {
        scene: std::sync::Arc::default(),
        bound: -1.0,
        coatings: Vec::new(),
    });
    let slow = tools.submit(read("slow.obj"));
    assert!(result(&mut long).unwrap_err().contains("positive"));
    drop(slow);
}

#[test]
fn worker_does_not_fail_at_a_broken_file() {
    let tools = Tools::new(|| {});
    let mut ticket = tools.submit(ReadMesh {
        name: "a.ply".into(),
        bytes: b"no".to_vec(),
    });
    let message = result(&mut ticket).unwrap_err();
    assert!(message.contains("PLY"), "{message}");
}

/// A worker that is never started.
struct Refused(u32);

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
    let mut jobs = Jobs::new(Refused(0));
    jobs.note_program(Ok(()), 0.0);
    // The second job has one more attempt.
    for attempts in [crate::life::ATTEMPTS, crate::life::ATTEMPTS + 1] {
        let (_, news) = jobs.submit(read("a.obj"), 0.0);
        let result = news.borrow_mut().result.take();
        assert!(
            matches!(&result, Some(Err(reason)) if reason.contains("no memory")),
            "{result:?}"
        );
        assert_eq!(jobs.workers.0, attempts);
    }
    assert!(jobs.sent.is_empty() && !jobs.is_busy());
}

#[test]
fn jobs_fail_if_the_tools_cannot_be_loaded() {
    let mut jobs = Jobs::new(Refused(0));
    let (_, news) = jobs.submit(read("a.obj"), 0.0);
    assert!(news.borrow().result.is_none() && !jobs.is_busy());
    jobs.note_program(Err(String::from("offline")), 0.0);
    let result = news.borrow_mut().result.take();
    assert!(
        matches!(&result, Some(Err(reason)) if reason.contains("offline")),
        "{result:?}"
    );
    assert_eq!(jobs.workers.0, 0);
}
