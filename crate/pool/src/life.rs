//! The life of one worker, tracer or tool, as a state machine without worker or clock.
//!
//! - A worker that is late, in starting or at its work, is suspected at first: its answer may only
//!   be waiting for a busy page. If it is late again at the next look it is taken for one that
//!   hangs, and treated like one that died.
//! - A worker that died is started again as long as there is work. One that could not be started
//!   [`ATTEMPTS`] times in a row, or died [`DEATHS`] times since it last finished something, is
//!   given up. It gets one more attempt with every new piece of work.

/// Times in a row a worker may fail to start.
pub const ATTEMPTS: u32 = 3;
/// Times a worker may die without having finished anything.
pub const DEATHS: u32 = 10;
/// Seconds a worker may take to start.
pub const START_LIMIT: f64 = 30.0;

/// A stage in the life of a worker.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Stage {
    /// The worker does not run, as there is no work for it.
    #[default]
    Asleep,
    /// The worker is being started.
    Starting,
    /// The worker takes requests.
    Awake,
    /// The worker does not run, as it failed too often.
    GivenUp,
}

/// The time by which a worker must give a sign of life, and the trouble if it does not.
pub type Deadline = (f64, &'static str);

/// The life of a worker.
#[derive(Clone, Debug, Default)]
pub struct Life {
    stage: Stage,
    /// Time of the last sign of life, or of the start of its present work.
    since: f64,
    /// Whether it was late at the last look.
    suspected: bool,
    failed_starts: u32,
    /// Times it died since it last finished something.
    deaths: u32,
}

impl Life {
    /// Returns the stage.
    #[must_use]
    pub fn stage(&self) -> Stage {
        self.stage
    }

    /// Whether it takes requests.
    #[must_use]
    pub fn is_awake(&self) -> bool {
        self.stage == Stage::Awake
    }

    /// Whether it takes requests, or soon will.
    #[must_use]
    pub fn is_running(&self) -> bool {
        matches!(self.stage, Stage::Starting | Stage::Awake)
    }

    /// Returns the time of its last sign of life, or of the start of its present work.
    #[must_use]
    pub fn since(&self) -> f64 {
        self.since
    }

    /// Notes that it is being started, in the place of the one before if there is one.
    pub fn start(&mut self, now: f64) {
        if self.stage == Stage::GivenUp {
            self.failed_starts = ATTEMPTS - 1;
            self.deaths = DEATHS - 1;
        }
        self.stage = Stage::Starting;
        self.hear(now);
    }

    /// Notes that it takes requests. Returns whether that was waited for.
    pub fn awake(&mut self, now: f64) -> bool {
        let was_starting = self.stage == Stage::Starting;
        if was_starting {
            self.stage = Stage::Awake;
            self.failed_starts = 0;
            self.hear(now);
        }
        was_starting
    }

    /// Notes a sign of life, or that it is given work.
    pub fn hear(&mut self, now: f64) {
        self.since = now;
        self.suspected = false;
    }

    /// Notes that it has finished something.
    pub fn succeed(&mut self) {
        self.deaths = 0;
    }

    /// Notes that it is ended for now.
    pub fn end(&mut self) {
        self.stage = Stage::Asleep;
    }

    /// Notes that it died. Returns whether it took requests; `None` if it was not running at all.
    pub fn die(&mut self) -> Option<bool> {
        if !self.is_running() {
            return None;
        }
        let was_awake = self.is_awake();
        self.failed_starts += u32::from(!was_awake);
        self.deaths += 1;
        self.stage = if self.failed_starts >= ATTEMPTS || self.deaths >= DEATHS {
            Stage::GivenUp
        } else {
            Stage::Asleep
        };
        Some(was_awake)
    }

    /// Returns the trouble if it hangs, which is found at the second look at the earliest. `work`:
    /// the deadline of its present work.
    pub fn overdue(&mut self, now: f64, work: Option<Deadline>) -> Option<&'static str> {
        let deadline = match self.stage {
            Stage::Starting => Some((self.since + START_LIMIT, "a worker took too long to start")),
            Stage::Awake => work,
            Stage::Asleep | Stage::GivenUp => None,
        };
        let late = deadline.and_then(|(time, trouble)| (now > time).then_some(trouble));
        let was_late = std::mem::replace(&mut self.suspected, late.is_some());
        late.filter(|_| was_late)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn awake() -> Life {
        let mut life = Life::default();
        life.start(0.0);
        assert!(life.awake(0.0) && life.is_awake());
        life
    }

    #[test]
    fn worker_that_cannot_be_started_is_given_up_until_there_is_new_work() {
        let mut life = Life::default();
        for attempt in 1..=ATTEMPTS {
            life.start(0.0);
            assert_eq!(life.die(), Some(false));
            assert_eq!(life.stage() == Stage::GivenUp, attempt == ATTEMPTS);
        }
        assert_eq!(life.die(), None);
        life.start(1.0);
        assert_eq!(life.die(), Some(false));
        assert_eq!(life.stage(), Stage::GivenUp, "one more attempt only");
        life.start(2.0);
        assert!(life.awake(2.0));
        assert_eq!(life.die(), Some(true));
        assert_eq!(life.stage(), Stage::GivenUp, "it has finished nothing");
    }

    #[test]
    fn deaths_count_as_long_as_nothing_is_finished() {
        let mut life = awake();
        for death in 1..=DEATHS {
            assert_eq!(life.die(), Some(true));
            assert_eq!(life.stage() == Stage::GivenUp, death == DEATHS);
            life.start(0.0);
            life.awake(0.0);
        }
        life.succeed();
        assert_eq!(life.die(), Some(true));
        assert_eq!(life.stage(), Stage::Asleep);
    }

    #[test]
    fn late_worker_is_suspected_first_and_saved_by_a_sign_of_life() {
        let mut life = Life::default();
        life.start(0.0);
        assert_eq!(life.overdue(START_LIMIT, None), None);
        assert_eq!(life.overdue(START_LIMIT + 1.0, None), None);
        let trouble = life.overdue(START_LIMIT + 2.0, None).unwrap();
        assert!(trouble.contains("too long to start"), "{trouble}");
        let mut life = awake();
        let work = Some((5.0, "it took too long"));
        assert_eq!(life.overdue(6.0, work), None);
        life.hear(6.1);
        assert_eq!(life.overdue(7.0, work), None, "suspected anew");
        assert_eq!(life.overdue(8.0, work), Some("it took too long"));
        assert!(!life.awake(9.0), "it was awake already");
    }
}
