//! The pool's decisions as a state machine without workers or clocks.
//!
//! Events go in (a worker started, answered, died; time passed), [`Command`]s come out. Rules:
//!
//! - Tiles are assigned pass by pass, the coarse pass to all in turn. From then on each worker has
//!   its part of the picture ([`partition`](crate::partition::partition)) and makes smooth what it
//!   has sampled; an idle worker helps the others where that pays, and else starts its own tiles of
//!   the next pass. A worker holds the tile it traces and some more, about
//!   [`AHEAD`](crate::assign::AHEAD) seconds of work, so that it need not wait for a page that is
//!   busy drawing. It drops those itself when a new picture begins.
//! - A worker that is still at an older picture [`PATIENCE`] seconds after a new one began is
//!   replaced, so a slow tile never delays the new picture.
//! - A worker that dies, or that gives no sign of life for its time limit, is replaced (see
//!   [`Life`]) and the tiles it held are done again, each alone, as any of them may have been the
//!   cause. A tile with which [`ATTEMPTS`] workers failed is given up, so nothing is tried forever.
//!   The same holds for preparing a scene.

use crate::life::{Deadline, Life, Stage};
use crate::progress::Progress;
use crate::run::{ATTEMPTS, Plan, Run};
use std::collections::VecDeque;
use tracer::Stats;
use worker::Order;

/// Seconds after which a worker that is still at an older picture is replaced.
pub const PATIENCE: f64 = 0.25;
/// Seconds a worker may take to prepare a scene.
pub const PREPARE_LIMIT: f64 = 60.0;

/// An action of the pool. Workers are numbered from 0.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// End this worker if it runs, and start a new one in its place.
    Restart(usize),
    /// End this worker.
    End(usize),
    /// Send this worker the scene.
    Begin(usize),
    /// Send this worker tiles.
    Trace(usize, Vec<Order>),
    /// Tell this worker to forget its picture.
    Stop(usize),
}

#[derive(Clone, Debug, Default)]
struct Slot {
    life: Life,
    /// Tasks it holds; the first is being traced.
    holds: VecDeque<usize>,
    /// Whether it was sent the present scene, and whether it has prepared it.
    begun: bool,
    prepared: bool,
    /// Time at which it was told to leave its picture, until it confirms that.
    stale: Option<f64>,
}

impl Slot {
    fn is_busy(&self) -> bool {
        self.begun && !self.prepared || !self.holds.is_empty()
    }

    /// Takes its work away.
    fn clear_work(&mut self) {
        self.holds.clear();
        self.begun = false;
        self.prepared = false;
    }
}

/// The state of the pool.
#[derive(Debug)]
pub struct Scheduler {
    slots: Vec<Slot>,
    run: Option<Run>,
    /// Rises with every picture, so that answers to an older one are known as such even if the
    /// caller uses a number twice.
    number: u64,
    launched: bool,
    restarted: u32,
    error: Option<String>,
    commands: Vec<Command>,
}

impl Scheduler {
    /// Creates a pool of `workers` workers, none of which runs before [`Scheduler::launch`].
    #[must_use]
    pub fn new(workers: usize) -> Self {
        Self {
            slots: vec![Slot::default(); workers],
            run: None,
            number: 0,
            launched: false,
            restarted: 0,
            error: None,
            commands: Vec::new(),
        }
    }

    /// Takes the commands to carry out now, in this order.
    pub fn commands(&mut self) -> Vec<Command> {
        std::mem::take(&mut self.commands)
    }

    /// Returns the number of the present picture in the messages of the workers.
    #[must_use]
    pub fn number(&self) -> u64 {
        self.number
    }

    /// Returns the caller's number of the present picture.
    #[must_use]
    pub fn generation(&self) -> Option<u64> {
        self.run.as_ref().map(|run| run.plan.generation)
    }

    /// Returns the number of complete passes of the present picture. The app is woken when it
    /// rises; single tiles are shown when the app draws anyway.
    #[must_use]
    pub fn complete_passes(&self) -> usize {
        self.run.as_ref().map_or(0, Run::complete_passes)
    }

    /// Whether there is no picture, or nothing more will come of the present one.
    #[must_use]
    pub fn is_over(&self) -> bool {
        self.run.as_ref().is_none_or(|run| run.ended.is_some())
    }

    /// Notes that workers can be started from now on.
    pub fn launch(&mut self, now: f64) {
        self.launched = true;
        self.wake(now);
    }

    /// Notes that workers cannot be started at all, for this reason.
    pub fn unavailable(&mut self, reason: &str, now: f64) {
        self.fail(reason.to_owned(), now);
    }

    /// Begins a picture; the present one is forgotten.
    pub fn start(&mut self, plan: Plan, now: f64) {
        self.clear_work(now);
        self.number += 1;
        self.error = None;
        self.run = Some(Run::new(plan, self.slots.len(), now));
        self.wake(now);
        for index in 0..self.slots.len() {
            self.begin(index, now);
        }
        self.deal(now);
    }

    /// Assigns the whole coarse pass, a tile to each worker in turn: tracing it takes less time
    /// than asking a page that is busy drawing for more. Waits until all workers are awake, as the
    /// first would get all of it.
    fn deal(&mut self, now: f64) {
        if self.slots.iter().any(|slot| !slot.life.is_awake()) {
            return;
        }
        let mut enough = 1;
        while self.run.as_ref().is_some_and(Run::is_coarse) {
            enough += 1;
            let before = self.count_held();
            for index in 0..self.slots.len() {
                // The partition for the next pass is not known yet.
                if self.run.as_ref().is_some_and(Run::is_coarse) {
                    self.give(index, Some(enough), false, now);
                }
            }
            // Nobody is awake.
            if self.count_held() == before {
                return;
            }
        }
    }

    /// Returns the number of tasks that workers hold.
    fn count_held(&self) -> usize {
        self.slots.iter().map(|slot| slot.holds.len()).sum()
    }

    /// Ends the present picture.
    pub fn cancel(&mut self, now: f64) {
        self.clear_work(now);
        self.number += 1;
        for (index, slot) in self.slots.iter().enumerate() {
            if slot.life.is_awake() {
                self.commands.push(Command::Stop(index));
            }
        }
        if let Some(run) = &mut self.run {
            run.ended.get_or_insert(now);
        }
    }

    /// Notes that a worker takes requests.
    pub fn note_start(&mut self, index: usize, now: f64) {
        if self.slots[index].life.awake(now) {
            self.begin(index, now);
        }
    }

    /// Notes that a worker knows of the picture of this number.
    pub fn note_picture(&mut self, index: usize, number: u64, now: f64) {
        self.slots[index].life.hear(now);
        if number == self.number {
            self.slots[index].stale = None;
        }
    }

    /// Notes that a worker has prepared the picture of this number.
    pub fn note_preparation(&mut self, index: usize, number: u64, now: f64) {
        self.slots[index].life.hear(now);
        if number == self.number && self.slots[index].begun {
            self.slots[index].prepared = true;
            self.fill(index, now);
        }
    }

    /// Notes that a worker has traced a tile. Returns whether the tile is wanted.
    pub fn take_tile(
        &mut self,
        index: usize,
        order: Order,
        stats: &Stats,
        seconds: f64,
        now: f64,
    ) -> bool {
        self.slots[index].life.hear(now);
        let number = self.number;
        let (Some(run), slot) = (&mut self.run, &mut self.slots[index]) else {
            return false;
        };
        let Some(&task) = slot.holds.front() else {
            return false;
        };
        if run.order(task, number) != order {
            return false;
        }
        slot.holds.pop_front();
        slot.life.succeed();
        let complete = run.complete_passes();
        run.finish(task, stats, seconds, now);
        let news = run.complete_passes() > complete;
        self.fill(index, now);
        for other in 0..self.slots.len() {
            // Each pass gives better costs, by which an idle worker may now help.
            if self.slots[other].prepared && (news || self.slots[other].holds.is_empty()) {
                self.fill(other, now);
            }
        }
        true
    }

    /// Notes that a worker died, or reported that it cannot continue.
    pub fn note_death(&mut self, index: usize, reason: &str, now: f64) {
        match self.slots[index].life.die() {
            None => return,
            Some(true) => self.blame(index, reason, now),
            Some(false) => {}
        }
        self.restarted += 1;
        let given_up = self.slots[index].life.stage() == Stage::GivenUp;
        let is_wanted = self.run.as_ref().is_some_and(|run| run.ended.is_none());
        if is_wanted && !given_up {
            self.restart(index, now);
        } else {
            // Without work to do, it could die again and again; it is started with the next
            // picture.
            self.end(index);
        }
        let mut stages = self.slots.iter().map(|slot| slot.life.stage());
        if given_up && stages.all(|stage| stage == Stage::GivenUp) {
            self.fail(format!("No worker could be kept running: {reason}"), now);
        }
        self.fill_all(now);
    }

    /// Takes back what a worker that died was holding, and counts its death against what it was at.
    fn blame(&mut self, index: usize, reason: &str, now: f64) {
        let slot = &mut self.slots[index];
        let mut held = std::mem::take(&mut slot.holds);
        let Some(run) = &mut self.run else { return };
        // A stale worker died of an older picture.
        if slot.stale.is_none() {
            if slot.begun && !slot.prepared {
                run.failed_preparations += 1;
                if run.failed_preparations >= ATTEMPTS {
                    self.fail(format!("The scene could not be prepared: {reason}"), now);
                    return;
                }
            } else {
                held.retain(|task| {
                    let give_up = run.fail(*task);
                    if give_up {
                        self.error = Some(format!("A part of the picture is missing: {reason}"));
                    }
                    !give_up
                });
            }
        }
        run.again.extend(held.into_iter().rev());
        run.update(now);
    }

    /// Notes that time has passed: replaces workers that hang or are too long at an older picture.
    pub fn tick(&mut self, now: f64) {
        for index in 0..self.slots.len() {
            let work = self.deadline(index);
            let slot = &mut self.slots[index];
            let Some(trouble) = slot.life.overdue(now, work) else {
                continue;
            };
            if slot.stale.is_none() {
                self.note_death(index, trouble, now);
                continue;
            }
            let held = std::mem::take(&mut slot.holds);
            if let Some(run) = &mut self.run {
                run.again.extend(held.into_iter().rev());
            }
            self.restart(index, now);
            self.fill_all(now);
        }
    }

    /// Returns the deadline of the work of a worker that is awake.
    fn deadline(&self, index: usize) -> Option<Deadline> {
        let slot = &self.slots[index];
        let since = slot.life.since();
        if let Some(stale) = slot.stale {
            return Some((stale + PATIENCE, "it is at an older picture"));
        }
        if slot.begun && !slot.prepared {
            return Some((since + PREPARE_LIMIT, "it took too long"));
        }
        let (run, task) = (self.run.as_ref()?, slot.holds.front()?);
        Some((since + run.limit(*task), "a tile took too long"))
    }

    /// Whether [`Scheduler::tick`] must be called: a worker is starting, busy or at an older
    /// picture.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.slots.iter().any(|slot| {
            slot.life.stage() == Stage::Starting || slot.stale.is_some() || slot.is_busy()
        })
    }

    /// Returns the progress of the picture.
    #[must_use]
    pub fn progress(&self, now: f64) -> Progress {
        let workers = self
            .slots
            .iter()
            .filter(|slot| slot.life.is_running())
            .count();
        let mut progress = Progress {
            workers,
            restarted: self.restarted,
            error: self.error.clone(),
            ..Progress::default()
        };
        if let Some(run) = &self.run {
            run.report(&mut progress, now);
        }
        progress
    }

    /// Starts the workers that are not running.
    fn wake(&mut self, now: f64) {
        if !self.launched {
            return;
        }
        for index in 0..self.slots.len() {
            if !self.slots[index].life.is_running() {
                self.restart(index, now);
            }
        }
    }

    /// Starts a worker, in the place of the old one if there is one.
    fn restart(&mut self, index: usize, now: f64) {
        let slot = &mut self.slots[index];
        slot.clear_work();
        slot.stale = None;
        slot.life.start(now);
        self.commands.push(Command::Restart(index));
    }

    /// Ends a worker that died.
    fn end(&mut self, index: usize) {
        let slot = &mut self.slots[index];
        slot.clear_work();
        slot.stale = None;
        self.commands.push(Command::End(index));
    }

    /// Ends the picture with an error.
    fn fail(&mut self, error: String, now: f64) {
        self.cancel(now);
        self.error = Some(error);
    }

    /// Takes all work from all workers.
    fn clear_work(&mut self, now: f64) {
        for slot in &mut self.slots {
            if slot.life.is_awake() && slot.is_busy() {
                slot.stale.get_or_insert(now);
            }
            slot.clear_work();
        }
        if let Some(run) = &mut self.run {
            run.abandon();
        }
    }

    /// Sends the scene to a worker, and its first tile.
    fn begin(&mut self, index: usize, now: f64) {
        let wanted = self.run.as_ref().is_some_and(|run| run.ended.is_none());
        let slot = &mut self.slots[index];
        if wanted && slot.life.is_awake() && !slot.begun {
            slot.begun = true;
            slot.life.hear(now);
            self.commands.push(Command::Begin(index));
            self.fill(index, now);
        }
    }

    fn fill_all(&mut self, now: f64) {
        for index in 0..self.slots.len() {
            self.fill(index, now);
        }
    }

    /// Gives a worker tiles until it has enough.
    fn fill(&mut self, index: usize, now: f64) {
        let Some(run) = &self.run else { return };
        let again = !run.again.is_empty();
        // A repeated tile is traced alone, so the worker first finishes the tiles it holds.
        let enough = (again || !self.slots[index].prepared).then_some(1);
        let complete = run.complete_passes();
        self.give(index, enough, again, now);
        let (Some(run), slot) = (&self.run, &self.slots[index]) else {
            return;
        };
        // A tile that was given up may have been the last of a pass, or the last to be repeated.
        if run.complete_passes() > complete {
            self.fill_all(now);
        } else if again && run.again.is_empty() && slot.holds.is_empty() {
            self.fill(index, now);
        }
    }

    /// Gives a worker tiles until it holds `enough`, or by [`Run::needs_more`], from those never
    /// assigned or, with `again`, from those to be repeated.
    fn give(&mut self, index: usize, enough: Option<usize>, again: bool, now: f64) {
        let (Some(run), slot) = (&mut self.run, &self.slots[index]) else {
            return;
        };
        if !slot.life.is_awake() || !slot.begun {
            return;
        }
        run.awake = self.slots.iter().map(|slot| slot.life.is_awake()).collect();
        let slot = &mut self.slots[index];
        let mut orders = Vec::new();
        let workers = run.awake.iter().filter(|awake| **awake).count();
        while enough.map_or_else(
            || run.needs_more(&slot.holds, workers),
            |enough| slot.holds.len() < enough,
        ) {
            let Some(task) = run.take(index, slot.holds.len() < 2, again) else {
                break;
            };
            if slot.holds.is_empty() {
                slot.life.hear(now);
            }
            slot.holds.push_back(task);
            orders.push(run.order(task, self.number));
        }
        // Tiles given up in an earlier pass may have been the last ones.
        run.update(now);
        if orders.is_empty() {
            return;
        }
        let mine = self
            .commands
            .iter_mut()
            .rev()
            .find_map(|command| match command {
                Command::Trace(worker, before) if *worker == index => Some(before),
                _ => None,
            });
        match mine {
            Some(before) => before.extend(orders),
            None => self.commands.push(Command::Trace(index, orders)),
        }
    }
}

#[cfg(test)]
mod tests;
