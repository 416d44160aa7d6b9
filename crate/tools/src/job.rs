//! Jobs, and carrying them out in a worker.

use crate::coating::CoatScene;
use crate::fitting::FitMesh;
use crate::meshing::{MeshScene, WriteMesh};
use crate::message::{Answer, DIFFERENT_VERSIONS, Request, pack};
use crate::reading::{ReadMeasured, ReadMesh, ReadSkeleton};
use crate::view::ViewScene;
use core::ops::ControlFlow;
use serde::{Deserialize, Serialize, de::DeserializeOwned};

/// Work for a tools worker.
///
/// A job depends on nothing but its own data, so that another worker can repeat it.
pub trait Job: Into<Work> {
    /// The result, and the parts of it that are passed on before the end.
    type Output: Serialize + DeserializeOwned + 'static;
    /// The time it takes, and so the worker that does it.
    const PACE: Pace;

    /// Carries it out.
    ///
    /// # Errors
    /// A message for the user, such as the fault of a file.
    fn run(self, progress: &mut Progress<'_, Self::Output>) -> Result<Self::Output, String>;
}

/// The time a job takes. Each pace has a worker of its own, as no job can be interrupted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pace {
    /// Moments, for which the user waits.
    Quick,
    /// Seconds to minutes.
    Long,
}

impl Pace {
    /// Every pace, in the order of the declaration.
    pub const ALL: [Self; 2] = [Self::Quick, Self::Long];
}

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
    ViewScene,
    CoatScene,
    MeshScene,
    WriteMesh,
    FitMesh
);

/// Sender of packed answers, which returns whether the job is to go on.
type Outlet<'a> = dyn FnMut(Vec<u8>) -> ControlFlow<()> + 'a;

/// News of a running job.
#[derive(Clone, Debug, PartialEq)]
pub enum News<T> {
    /// The fraction done, 0 … 1.
    Fraction(f32),
    /// A part of the result, or what is known of it so far.
    Part(T),
}

/// Reporter of a running job's progress.
pub struct Progress<'a, T> {
    tell: Option<&'a mut dyn FnMut(News<T>) -> ControlFlow<()>>,
}

impl<'a, T> Progress<'a, T> {
    /// Creates one that tells all news to `tell`, which returns whether the job is to go on.
    pub fn new(tell: &'a mut dyn FnMut(News<T>) -> ControlFlow<()>) -> Self {
        Self { tell: Some(tell) }
    }

    /// Creates one that tells nobody.
    #[must_use]
    pub fn silent() -> Self {
        Self { tell: None }
    }

    fn tell(&mut self, news: News<T>) -> ControlFlow<()> {
        match &mut self.tell {
            Some(tell) => tell(news),
            None => ControlFlow::Continue(()),
        }
    }

    /// Tells the fraction done, 0 … 1. Returns whether the job is to go on.
    ///
    /// A job that takes more than a few seconds must call this every few seconds, or its worker is
    /// taken for one that hangs.
    pub fn report(&mut self, fraction: f32) -> ControlFlow<()> {
        self.tell(News::Fraction(fraction.clamp(0.0, 1.0)))
    }

    /// Passes on what there is of the result. Returns whether the job is to go on.
    pub fn pass(&mut self, part: T) -> ControlFlow<()> {
        self.tell(News::Part(part))
    }
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
