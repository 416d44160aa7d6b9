//! Who traces what: the pool's decisions, as a state machine without workers or clocks.
//!
//! Events go in (a worker started, answered, died; time passed), [`Command`]s come out. Rules:
//!
//! - Tiles are handed out pass by pass, in the order of [`tracer::tile::tiles`]. A worker holds the
//!   tile it traces and some more, about [`AHEAD`] seconds of work, so that it need not wait for a
//!   page that is busy drawing. It drops those itself when a new picture begins.
//! - A worker that is still at an older picture [`PATIENCE`] seconds after a new one began is
//!   replaced, so a slow tile never delays the new picture.
//! - A worker that dies, or that gives no sign of life for its time limit, is replaced and the tiles
//!   it held are done again, each alone, as any of them may have been the cause. A tile with which
//!   [`ATTEMPTS`] workers failed is given up, so nothing is tried forever. The same holds for
//!   preparing a scene and for starting a worker.

use super::progress::{Costs, Progress, add_stats};
use std::collections::{HashMap, HashSet, VecDeque};
use tracer::{Pass, Stats, Tile};
use worker::Order;

/// Failures after which a tile, a scene or a worker is given up.
pub const ATTEMPTS: u32 = 3;
/// Seconds after which a worker that is still at an older picture is replaced.
pub const PATIENCE: f64 = 0.25;
/// Times in a row a worker may die without having finished a tile.
pub const DEATHS: u32 = 10;
/// Seconds of work a worker is given ahead.
pub const AHEAD: f64 = 0.25;
/// Most tiles a worker is given ahead.
pub const MOST_AHEAD: usize = 64;
/// Seconds a worker may take to start.
pub const START_LIMIT: f64 = 30.0;
/// Seconds a worker may take to prepare a scene.
pub const PREPARE_LIMIT: f64 = 60.0;
/// Least seconds a tile may take.
pub const TILE_LIMIT: f64 = 10.0;
/// A tile may take so many times longer than the slowest of its pass so far, …
pub const SLACK: f64 = 20.0;
/// … and so many times longer again after each failure, …
pub const RETRY: f64 = 4.0;
/// … but never longer than so many seconds.
pub const LONGEST_LIMIT: f64 = 600.0;

/// What the pool must do. Workers are numbered from 0.
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

/// A picture as the scheduler sees it.
#[derive(Clone, Copy, Debug)]
pub struct Plan {
    /// The caller's number for it.
    pub generation: u64,
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// At most n×n rays a pixel; with 1 there is no [`Pass::Smooth`].
    pub samples: u32,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Life {
    /// Not running, and not wanted at the moment.
    Asleep,
    /// On its way.
    Starting,
    /// Takes requests.
    Awake,
    /// Could not be started [`ATTEMPTS`] times.
    GivenUp,
}

#[derive(Clone, Debug)]
struct Slot {
    life: Life,
    /// The tiles it holds, as numbers of tasks; the first is the one it traces.
    holds: VecDeque<usize>,
    /// Whether it was sent the present scene, and whether it has prepared it.
    begun: bool,
    prepared: bool,
    /// When it was told to leave the picture it worked at, until it says that it did.
    stale: Option<f64>,
    /// Whether the last tick found it too late. Its answer may only have been waiting for a busy
    /// page, so it gets until the next tick.
    suspected: bool,
    /// Last sign of life, or when its present work began.
    since: f64,
    failed_starts: u32,
    /// Times it died since it last finished a tile.
    deaths: u32,
}

impl Slot {
    fn is_busy(&self) -> bool {
        self.begun && !self.prepared || !self.holds.is_empty()
    }

    /// Takes its work away.
    fn put_down(&mut self) {
        self.holds.clear();
        self.begun = false;
        self.prepared = false;
    }
}

/// Why a worker is too late.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Late {
    /// It is still at an older picture.
    Stale,
    /// It gives no sign of life; what that means.
    Hanging(&'static str),
}

/// The picture being traced.
#[derive(Debug)]
struct Run {
    plan: Plan,
    tiles: Vec<Tile>,
    passes: &'static [Pass],
    /// The first task never handed out. A task is a tile in a pass: pass · number of tiles + tile.
    next: usize,
    /// Tasks handed out before, to be done again, each alone.
    again: Vec<usize>,
    failures: HashMap<usize, u32>,
    failed_tiles: HashSet<usize>,
    failed_preparations: u32,
    /// Tasks of each pass that are done or given up.
    settled: [usize; 3],
    pass_seconds: [Option<f64>; 3],
    costs: Costs,
    begun: f64,
    ended: Option<f64>,
    fraction: f64,
    stats: Stats,
}

impl Run {
    fn tasks(&self) -> usize {
        self.tiles.len() * self.passes.len()
    }

    fn order(&self, task: usize, generation: u64) -> Order {
        Order {
            generation,
            tile: self.tiles[task % self.tiles.len()],
            pass: self.passes[task / self.tiles.len()],
        }
    }

    /// The next task, from those never handed out or from those to be done again.
    fn take(&mut self, again: bool) -> Option<usize> {
        loop {
            let task = if again {
                self.again.pop()?
            } else {
                self.next = (self.next < self.tasks()).then_some(self.next + 1)?;
                self.next - 1
            };
            // A tile that was given up is not tried in later passes.
            if !self.failed_tiles.contains(&(task % self.tiles.len())) {
                return Some(task);
            }
            self.settled[task / self.tiles.len()] += 1;
        }
    }

    /// How many tasks never handed out a worker should hold, one of so many workers: enough not to
    /// wait for the page, but in the end no worker should have much more than the others.
    fn enough(&self, workers: usize) -> usize {
        if self.next >= self.tasks() {
            return 0;
        }
        let pass = self.next / self.tiles.len();
        let ahead = (AHEAD / self.costs.expected(pass)).clamp(2.0, MOST_AHEAD as f64) as usize;
        let share = (self.tasks() - self.next).div_ceil(2 * workers.max(1));
        ahead.min(share)
    }

    /// Seconds a task may take. After each failure it gets more, as a tile may be slow for good
    /// reasons.
    fn limit(&self, task: usize) -> f64 {
        let pass = task / self.tiles.len();
        let failures = self.failures.get(&task).copied().unwrap_or(0);
        let long = SLACK * self.costs.expected(pass).max(self.costs.slowest(pass));
        (long.max(TILE_LIMIT) * RETRY.powi(failures as i32)).min(LONGEST_LIMIT)
    }

    /// Expected seconds of all tasks, and of those left.
    fn expected(&self) -> (f64, f64) {
        let (mut all, mut left) = (0.0, 0.0);
        for pass in 0..self.passes.len() {
            let cost = self.costs.expected(pass);
            all += cost * self.tiles.len() as f64;
            left += cost * (self.tiles.len() - self.settled[pass]) as f64;
        }
        (all, left)
    }

    /// Notes which passes are complete, and the end of the picture.
    fn settle(&mut self, now: f64) {
        let complete = |pass: usize| self.settled[pass] == self.tiles.len();
        for pass in 0..self.passes.len() {
            if complete(pass) {
                self.pass_seconds[pass].get_or_insert(now - self.begun);
            }
        }
        let (all, left) = self.expected();
        if all > 0.0 {
            self.fraction = self.fraction.max(1.0 - left / all);
        }
        if (0..self.passes.len()).all(complete) {
            self.ended.get_or_insert(now);
            self.fraction = 1.0;
        }
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
    /// A pool of so many workers, none of which runs before [`Scheduler::launch`].
    #[must_use]
    pub fn new(workers: usize) -> Self {
        let slot = Slot {
            life: Life::Asleep,
            holds: VecDeque::new(),
            begun: false,
            prepared: false,
            stale: None,
            suspected: false,
            since: 0.0,
            failed_starts: 0,
            deaths: 0,
        };
        Self {
            slots: vec![slot; workers],
            run: None,
            number: 0,
            launched: false,
            restarted: 0,
            error: None,
            commands: Vec::new(),
        }
    }

    /// What is to be done now, in this order.
    pub fn commands(&mut self) -> Vec<Command> {
        std::mem::take(&mut self.commands)
    }

    /// The number by which the workers know the present picture.
    #[must_use]
    pub fn number(&self) -> u64 {
        self.number
    }

    /// The caller's number of the present picture.
    #[must_use]
    pub fn generation(&self) -> Option<u64> {
        self.run.as_ref().map(|run| run.plan.generation)
    }

    /// Workers can be started from now on.
    pub fn launch(&mut self, now: f64) {
        self.launched = true;
        self.wake(now);
    }

    /// Workers cannot be started at all, for this reason.
    pub fn unavailable(&mut self, reason: &str, now: f64) {
        self.fail(reason.to_owned(), now);
    }

    /// Begins a picture; the present one is forgotten.
    pub fn start(&mut self, plan: Plan, now: f64) {
        self.put_down(now);
        self.number += 1;
        self.error = None;
        let passes: &[Pass] = if plan.samples > 1 {
            &[Pass::Coarse, Pass::Full, Pass::Smooth]
        } else {
            &[Pass::Coarse, Pass::Full]
        };
        let mut run = Run {
            plan,
            tiles: tracer::tile::tiles(plan.size[0], plan.size[1], super::TILE),
            passes,
            next: 0,
            again: Vec::new(),
            failures: HashMap::new(),
            failed_tiles: HashSet::new(),
            failed_preparations: 0,
            settled: [0; 3],
            pass_seconds: [None; 3],
            costs: Costs::default(),
            begun: now,
            ended: None,
            fraction: 0.0,
            stats: Stats::default(),
        };
        run.settle(now);
        self.run = Some(run);
        self.wake(now);
        for index in 0..self.slots.len() {
            self.begin(index, now);
        }
    }

    /// Ends the present picture.
    pub fn cancel(&mut self, now: f64) {
        self.put_down(now);
        self.number += 1;
        for (index, slot) in self.slots.iter().enumerate() {
            if slot.life == Life::Awake {
                self.commands.push(Command::Stop(index));
            }
        }
        if let Some(run) = &mut self.run {
            run.ended.get_or_insert(now);
        }
    }

    /// A worker takes requests.
    pub fn started(&mut self, index: usize, now: f64) {
        let slot = &mut self.slots[index];
        if slot.life == Life::Starting {
            slot.life = Life::Awake;
            slot.failed_starts = 0;
            slot.since = now;
            self.begin(index, now);
        }
    }

    /// A worker has taken note of the picture of this number.
    pub fn noted(&mut self, index: usize, number: u64, now: f64) {
        self.heard(index, now);
        if number == self.number {
            self.slots[index].stale = None;
        }
    }

    /// A worker has prepared the picture of this number.
    pub fn prepared(&mut self, index: usize, number: u64, now: f64) {
        self.heard(index, now);
        if number == self.number && self.slots[index].begun {
            self.slots[index].prepared = true;
            self.fill(index, now);
        }
    }

    /// A worker has traced a tile. Says whether the tile is wanted.
    pub fn traced(
        &mut self,
        index: usize,
        order: Order,
        stats: &Stats,
        seconds: f64,
        now: f64,
    ) -> bool {
        self.heard(index, now);
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
        slot.deaths = 0;
        let pass = task / run.tiles.len();
        run.settled[pass] += 1;
        run.costs.add(pass, seconds.max(0.0));
        add_stats(&mut run.stats, stats);
        run.settle(now);
        self.fill(index, now);
        true
    }

    /// A worker died, or said that it cannot go on.
    pub fn died(&mut self, index: usize, reason: &str, now: f64) {
        let slot = &mut self.slots[index];
        slot.deaths += 1;
        match slot.life {
            Life::Asleep | Life::GivenUp => return,
            Life::Starting => slot.failed_starts += 1,
            Life::Awake => self.blame(index, reason, now),
        }
        self.restarted += 1;
        let slot = &mut self.slots[index];
        let wanted = self.run.as_ref().is_some_and(|run| run.ended.is_none());
        if slot.failed_starts >= ATTEMPTS || slot.deaths >= DEATHS {
            self.end(index, Life::GivenUp);
            if self.slots.iter().all(|slot| slot.life == Life::GivenUp) {
                self.fail(format!("No worker could be kept running: {reason}"), now);
            }
        } else if wanted {
            self.restart(index, now);
        } else {
            // Without work to do, it could die again and again; it is started with the next picture.
            self.end(index, Life::Asleep);
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
                    let failures = run.failures.entry(*task).or_insert(0);
                    *failures += 1;
                    if *failures >= ATTEMPTS {
                        let tiles = run.tiles.len();
                        run.failed_tiles.insert(task % tiles);
                        run.settled[task / tiles] += 1;
                        self.error = Some(format!("A part of the picture is missing: {reason}"));
                        return false;
                    }
                    true
                });
            }
        }
        run.again.extend(held.into_iter().rev());
        run.settle(now);
    }

    /// Time has passed: replaces workers that hang or are too long at an older picture.
    pub fn tick(&mut self, now: f64) {
        for index in 0..self.slots.len() {
            let late = self.late(index, now);
            let slot = &mut self.slots[index];
            if late.is_none() || !slot.suspected {
                slot.suspected = late.is_some();
                continue;
            }
            match late {
                Some(Late::Stale) => {
                    let held = std::mem::take(&mut slot.holds);
                    if let Some(run) = &mut self.run {
                        run.again.extend(held.into_iter().rev());
                    }
                    self.restart(index, now);
                    self.fill_all(now);
                }
                Some(Late::Hanging(what)) => self.died(index, what, now),
                None => {}
            }
        }
    }

    /// Whether a worker has had too much time.
    fn late(&self, index: usize, now: f64) -> Option<Late> {
        let slot = &self.slots[index];
        let waited = now - slot.since;
        match slot.life {
            Life::Asleep | Life::GivenUp => None,
            Life::Starting => {
                (waited > START_LIMIT).then_some(Late::Hanging("a worker took too long to start"))
            }
            Life::Awake if slot.stale.is_some() => slot
                .stale
                .filter(|since| now - since > PATIENCE)
                .map(|_| Late::Stale),
            Life::Awake if slot.begun && !slot.prepared => {
                (waited > PREPARE_LIMIT).then_some(Late::Hanging("it took too long"))
            }
            Life::Awake => {
                let (run, task) = (self.run.as_ref()?, slot.holds.front()?);
                (waited > run.limit(*task)).then_some(Late::Hanging("a tile took too long"))
            }
        }
    }

    /// Whether time matters: something is on its way.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.slots
            .iter()
            .any(|slot| slot.life == Life::Starting || slot.stale.is_some() || slot.is_busy())
    }

    /// How far the picture has come.
    #[must_use]
    pub fn progress(&self, now: f64) -> Progress {
        let workers = self
            .slots
            .iter()
            .filter(|slot| matches!(slot.life, Life::Starting | Life::Awake))
            .count();
        let mut progress = Progress {
            workers,
            restarted: self.restarted,
            error: self.error.clone(),
            ..Progress::default()
        };
        if let Some(run) = &self.run {
            let complete = |pass: usize| run.settled[pass] == run.tiles.len();
            progress.generation = Some(run.plan.generation);
            progress.fraction = run.fraction;
            progress.finished = (0..run.passes.len()).all(complete);
            progress.seconds = run.ended.unwrap_or(now) - run.begun;
            progress.pass_seconds = run.pass_seconds;
            progress.failed_tiles = run.failed_tiles.len() as u32;
            progress.stats = run.stats;
            if run.ended.is_none() {
                progress.pass = (0..run.passes.len())
                    .find(|pass| !complete(*pass))
                    .map(|pass| run.passes[pass]);
                progress.remaining_seconds =
                    (run.costs.enough() && workers > 0).then(|| run.expected().1 / workers as f64);
            }
        }
        progress
    }

    /// Starts the workers that are not running.
    fn wake(&mut self, now: f64) {
        if !self.launched {
            return;
        }
        for index in 0..self.slots.len() {
            let slot = &mut self.slots[index];
            match slot.life {
                // One more attempt with every picture.
                Life::GivenUp => {
                    slot.failed_starts = ATTEMPTS - 1;
                    slot.deaths = DEATHS - 1;
                }
                Life::Asleep => {}
                Life::Starting | Life::Awake => continue,
            }
            self.restart(index, now);
        }
    }

    /// Starts a worker, in the place of the old one if there is one.
    fn restart(&mut self, index: usize, now: f64) {
        let slot = &mut self.slots[index];
        slot.put_down();
        slot.stale = None;
        slot.suspected = false;
        slot.life = Life::Starting;
        slot.since = now;
        self.commands.push(Command::Restart(index));
    }

    /// Ends a worker for now.
    fn end(&mut self, index: usize, life: Life) {
        let slot = &mut self.slots[index];
        slot.put_down();
        slot.stale = None;
        slot.life = life;
        self.commands.push(Command::End(index));
    }

    /// Ends the picture with an error.
    fn fail(&mut self, error: String, now: f64) {
        self.cancel(now);
        self.error = Some(error);
    }

    /// Takes all work from all workers.
    fn put_down(&mut self, now: f64) {
        for slot in &mut self.slots {
            if slot.life == Life::Awake && slot.is_busy() {
                slot.stale.get_or_insert(now);
            }
            slot.put_down();
        }
        if let Some(run) = &mut self.run {
            run.again.clear();
            run.next = run.tasks();
        }
    }

    /// A sign of life.
    fn heard(&mut self, index: usize, now: f64) {
        let slot = &mut self.slots[index];
        slot.suspected = false;
        slot.since = now;
    }

    /// Sends the scene to a worker, and its first tile.
    fn begin(&mut self, index: usize, now: f64) {
        let wanted = self.run.as_ref().is_some_and(|run| run.ended.is_none());
        let slot = &mut self.slots[index];
        if wanted && slot.life == Life::Awake && !slot.begun {
            slot.begun = true;
            slot.since = now;
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
        let workers = self
            .slots
            .iter()
            .filter(|slot| slot.life == Life::Awake)
            .count();
        let (Some(run), slot) = (&mut self.run, &mut self.slots[index]) else {
            return;
        };
        if slot.life != Life::Awake || !slot.begun {
            return;
        }
        let again = !run.again.is_empty();
        // What is done again is done alone, so let the worker first finish what it has.
        let enough = if again || !slot.prepared {
            1
        } else {
            run.enough(workers)
        };
        let mut orders = Vec::new();
        while slot.holds.len() < enough {
            let Some(task) = run.take(again) else { break };
            if slot.holds.is_empty() {
                slot.since = now;
            }
            slot.holds.push_back(task);
            orders.push(run.order(task, self.number));
        }
        // Tiles given up in an earlier pass may have been the last ones.
        run.settle(now);
        match self.commands.last_mut() {
            _ if orders.is_empty() => {}
            Some(Command::Trace(last, before)) if *last == index => before.extend(orders),
            _ => self.commands.push(Command::Trace(index, orders)),
        }
    }
}

#[cfg(test)]
#[path = "scheduler_tests.rs"]
mod tests;
