//! The picture being traced: which tiles in which passes are to be done, are done, or were given up.

use super::progress::{Costs, Progress, add_stats};
use super::scheduler::ATTEMPTS;
use std::collections::{HashMap, HashSet};
use tracer::{Pass, Stats, Tile};
use worker::Order;

/// Seconds of work a worker is given ahead.
pub const AHEAD: f64 = 0.25;
/// Most tiles a worker is given ahead.
pub const MOST_AHEAD: usize = 64;
/// Least seconds a tile may take.
pub const TILE_LIMIT: f64 = 20.0;
/// A tile may take so many times longer than the slowest of its pass so far, …
pub const SLACK: f64 = 20.0;
/// … and so many times longer again after each failure, …
pub const RETRY: f64 = 4.0;
/// … but never longer than so many seconds.
pub const LONGEST_LIMIT: f64 = 600.0;

/// A picture as the scheduler sees it.
#[derive(Clone, Copy, Debug)]
pub struct Plan {
    /// The caller's number for it.
    pub generation: u64,
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// At most n×n rays a pixel; with 1 there is no [`Pass::Smooth`].
    pub samples: u32,
    /// Whether only the last pass is wanted, in one go.
    pub small: bool,
}

/// The picture being traced.
#[derive(Debug)]
pub struct Run {
    pub plan: Plan,
    tiles: Vec<Tile>,
    passes: &'static [Pass],
    /// The first task never handed out. A task is a tile in a pass: pass · number of tiles + tile.
    next: usize,
    /// Tasks handed out before, to be done again, each alone.
    pub again: Vec<usize>,
    failures: HashMap<usize, u32>,
    failed_tiles: HashSet<usize>,
    pub failed_preparations: u32,
    /// Tasks of each pass that are done or given up.
    settled: [usize; 3],
    pass_seconds: [Option<f64>; 3],
    costs: Costs,
    begun: f64,
    pub ended: Option<f64>,
    fraction: f64,
    stats: Stats,
}

impl Run {
    /// Cuts a picture into tasks. One without pixels is finished at once.
    pub fn new(plan: Plan, now: f64) -> Self {
        let passes: &'static [Pass] = if plan.samples > 1 {
            &[Pass::Coarse, Pass::Full, Pass::Smooth]
        } else {
            &[Pass::Coarse, Pass::Full]
        };
        let (passes, side) = if plan.small {
            (&passes[passes.len() - 1..], super::SMALL_TILE)
        } else {
            (passes, super::TILE)
        };
        let mut run = Self {
            plan,
            tiles: tracer::tile::tiles(plan.size[0], plan.size[1], side),
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
        run
    }

    fn tasks(&self) -> usize {
        self.tiles.len() * self.passes.len()
    }

    pub fn order(&self, task: usize, generation: u64) -> Order {
        Order {
            generation,
            tile: self.tiles[task % self.tiles.len()],
            pass: self.passes[task / self.tiles.len()],
        }
    }

    /// The next task, from those never handed out or from those to be done again.
    pub fn take(&mut self, again: bool) -> Option<usize> {
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
    pub fn enough(&self, workers: usize) -> usize {
        if self.next >= self.tasks() {
            return 0;
        }
        let pass = self.next / self.tiles.len();
        let ahead = (AHEAD / self.costs.expected(pass)).clamp(2.0, MOST_AHEAD as f64) as usize;
        let share = (self.tasks() - self.next).div_ceil(2 * workers.max(1));
        ahead.min(share)
    }

    /// Whether tiles of the coarse pass were never handed out.
    pub fn is_coarse(&self) -> bool {
        self.passes[0] == Pass::Coarse && self.next < self.tiles.len()
    }

    /// How many passes are complete.
    pub fn complete_passes(&self) -> usize {
        self.pass_seconds.iter().flatten().count()
    }

    /// Seconds a task may take. After each failure it gets more, as a tile may be slow for good
    /// reasons.
    pub fn limit(&self, task: usize) -> f64 {
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
    pub fn settle(&mut self, now: f64) {
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

    /// A task is done.
    pub fn done(&mut self, task: usize, stats: &Stats, seconds: f64, now: f64) {
        let pass = task / self.tiles.len();
        self.settled[pass] += 1;
        self.costs.add(pass, seconds.max(0.0));
        add_stats(&mut self.stats, stats);
        self.settle(now);
    }

    /// A worker died or hung while it held a task. Says whether the task is given up.
    pub fn failed(&mut self, task: usize) -> bool {
        let failures = self.failures.entry(task).or_insert(0);
        *failures += 1;
        let give_up = *failures >= ATTEMPTS;
        if give_up {
            let tiles = self.tiles.len();
            self.failed_tiles.insert(task % tiles);
            self.settled[task / tiles] += 1;
        }
        give_up
    }

    /// Hands out nothing more.
    pub fn abandon(&mut self) {
        self.again.clear();
        self.next = self.tasks();
    }

    /// Writes down how far the picture has come. The number of workers must be there already.
    pub fn tell(&self, progress: &mut Progress, now: f64) {
        let complete = |pass: usize| self.settled[pass] == self.tiles.len();
        progress.generation = Some(self.plan.generation);
        progress.fraction = self.fraction;
        progress.finished = (0..self.passes.len()).all(complete);
        progress.seconds = self.ended.unwrap_or(now) - self.begun;
        progress.pass_seconds = self.pass_seconds;
        progress.failed_tiles = self.failed_tiles.len() as u32;
        progress.stats = self.stats;
        if self.ended.is_none() {
            progress.pass = (0..self.passes.len())
                .find(|pass| !complete(*pass))
                .map(|pass| self.passes[pass]);
            progress.remaining_seconds = (self.costs.enough() && progress.workers > 0)
                .then(|| self.expected().1 / progress.workers as f64);
        }
    }
}
