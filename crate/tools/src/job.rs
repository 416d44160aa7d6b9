//! Jobs, and what they tell while they run.

use core::ops::ControlFlow;
use serde::{Serialize, de::DeserializeOwned};

/// Work for a tools worker.
///
/// A job depends on nothing but its own data, so that another worker can repeat it.
pub trait Job {
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
