//! The jobs of all types, and carrying them out in a worker.

use crate::cells::PackScene;
use crate::coating::CoatScene;
use crate::fitting::FitMesh;
use crate::job::{Job, News, Progress};
use crate::meshing::{MeshScene, WriteMesh};
use crate::message::{Answer, DIFFERENT_VERSIONS, pack};
use crate::reading::{ReadMeasured, ReadMesh, ReadSkeleton};

use core::ops::ControlFlow;
use serde::{Deserialize, Serialize};

/// Declares the type of a message that can be any of these jobs.
macro_rules! jobs {
    ($($job:ident),+) => {
        /// A job of any type, as it is sent to a worker.
        #[derive(Debug, Serialize, Deserialize)]
        pub enum Work {
            $(
                #[doc = concat!("A [`", stringify!($job), "`].")]
                $job(Box<$job>),
            )+
        }

        $(
            impl From<$job> for Work {
                fn from(job: $job) -> Self {
                    Self::$job(Box::new(job))
                }
            }
        )+

        impl Work {
            /// Carries out the job. `id`: its number, which its answers have.
            fn run(self, id: u64, send: &mut Outlet<'_>) {
                match self {
                    $(Self::$job(job) => run(*job, id, send),)+
                }
            }
        }
    };
}

jobs!(
    ReadMesh,
    ReadMeasured,
    ReadSkeleton,
    PackScene,
    CoatScene,
    MeshScene,
    WriteMesh,
    FitMesh
);

/// Sender of packed answers, which returns whether the job is to go on.
type Outlet<'a> = dyn FnMut(Vec<u8>) -> ControlFlow<()> + 'a;

/// A message to a worker. Jobs run one after the other, in the order of their messages.
#[derive(Debug, Serialize, Deserialize)]
pub struct Request {
    /// Number of the job, given back with its answers.
    pub id: u64,
    /// The job.
    pub work: Work,
}

/// Carries out a packed [`Request`]. The packed answers go to `send`, the last one with the result.
pub fn serve(request: Vec<u8>, send: &mut Outlet<'_>) {
    let unpacked = postcard::from_bytes(&request);
    drop(request);
    match unpacked {
        Ok(Request { id, work }) => work.run(id, send),
        Err(_) => {
            let _ = send(Answer::Failed(DIFFERENT_VERSIONS.to_owned()).to_bytes());
        }
    }
}

fn run<J: Job>(job: J, id: u64, send: &mut Outlet<'_>) {
    // A part or a result for which there is no memory never comes, and the page replaces the
    // worker.
    let mut tell = |news: News<J::Output>| match news {
        News::Fraction(fraction) => send(Answer::Progress { id, fraction }.to_bytes()),
        News::Part(part) => {
            let packed = pack(&Answer::Part { id }, &part);
            packed.map_or(ControlFlow::Continue(()), &mut *send)
        }
    };
    // The sign that it has begun.
    if tell(News::Fraction(0.0)).is_break() {
        return;
    }
    let answer = match job.run(&mut Progress::new(&mut tell)) {
        Ok(output) => pack(&Answer::Done { id }, &output).ok(),
        Err(trouble) => Some(Answer::Refused { id, trouble }.to_bytes()),
    };
    if let Some(answer) = answer {
        let _ = send(answer);
    }
}
