//! The pool of tracing workers.

use crate::core::Core;
use crate::job::{PictureJob, TileDone, worker_count};
use crate::platform::{Crew, DIGGER, PlatformWorkers, Program, TRACER, cores};
use crate::progress::Progress;
use std::sync::Arc;

/// Traces pictures with all cores; see the [crate](crate).
pub struct Pool {
    crew: Crew<Core<PlatformWorkers>>,
    /// Whether the crew has the root finders for comparison.
    compares: bool,
    repaint: Repaint,
}

type Repaint = Arc<dyn Fn() + Send + Sync>;

impl Pool {
    /// Starts the workers. `repaint` is called when the app should draw: when a pass is complete,
    /// and when it is known whether there can be a picture at all. Native builds call it from any
    /// thread, with every answer.
    #[must_use]
    pub fn new(repaint: impl Fn() + Send + Sync + 'static) -> Self {
        let repaint: Repaint = Arc::new(repaint);
        Self {
            crew: start(TRACER, repaint.clone()),
            compares: false,
            repaint,
        }
    }

    /// Begins a picture and forgets the one before. The first one that needs the root finders for
    /// comparison loads the program that has them; once loaded, that traces all pictures.
    pub fn start(&mut self, job: PictureJob<'_>) {
        let compares = job.compares() || self.compares && self.crew.is_loaded();
        if self.compares != compares {
            let program = if compares { DIGGER } else { TRACER };
            self.crew = start(program, self.repaint.clone());
            self.compares = compares;
        }
        self.crew.order(|core, now| core.start(job, now));
    }

    /// Ends the present picture.
    pub fn cancel(&mut self) {
        self.crew.order(Core::cancel);
    }

    /// Returns the tiles of the present picture that were finished since the last call.
    pub fn poll(&mut self) -> Vec<TileDone> {
        self.crew.catch_up();
        self.crew.ask(|core, _| core.take())
    }

    /// Returns the progress of the present picture.
    #[must_use]
    pub fn progress(&self) -> Progress {
        self.crew.ask(|core, now| core.progress(now))
    }

    /// Ends a worker without the scheduler's knowledge. For tests. Returns whether there was such a
    /// worker.
    pub fn kill_worker(&mut self, index: usize) -> bool {
        self.crew.ask(|core, _| core.workers.kill(index))
    }
}

/// Starts a crew with a worker for each core.
fn start(program: Program, repaint: Repaint) -> Crew<Core<PlatformWorkers>> {
    let count = worker_count(cores());
    let crew = Crew::new(
        program,
        count,
        move || repaint(),
        |workers| Core::new(count, workers),
    );
    crew.load();
    crew
}
