//! State of the picture being traced: which tiles are done, left or given up in each pass.

use crate::forecast::{Forecast, Task, work_left};
use crate::job::{SMALL_TILE, TILE};
use crate::progress::{Costs, Progress};
use std::collections::{HashMap, HashSet, VecDeque};
use tracer::{Pass, Stats, Tile};
use worker::Order;

/// Failures after which a tile, a scene or a worker is given up.
pub const ATTEMPTS: u32 = 3;
/// Least time limit of a tile, seconds.
pub const TILE_LIMIT: f64 = 20.0;
/// Time limit of a tile as a multiple of the slowest tile of its pass so far.
pub const SLACK: f64 = 20.0;
/// Factor on the time limit after each failure.
pub const RETRY: f64 = 4.0;
/// Most seconds of any time limit.
pub const LONGEST_LIMIT: f64 = 600.0;

/// A picture as the scheduler sees it.
#[derive(Clone, Copy, Debug)]
pub struct Plan {
    /// The caller's number for it.
    pub generation: u64,
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// Square root of the most rays a pixel; with 1 there is no [`Pass::Smooth`].
    pub samples: u32,
    /// Whether only the last pass is wanted, in one go.
    pub small: bool,
    /// Whether workers share first samples.
    pub shared: bool,
}

/// The picture being traced.
#[derive(Debug)]
pub struct Run {
    pub plan: Plan,
    pub(super) tiles: Vec<Tile>,
    pub(super) passes: &'static [Pass],
    /// Tiles never assigned, for each pass, in the order of the tiles. A task is a tile in a pass,
    /// numbered pass · number of tiles + tile.
    pub(super) left: Vec<VecDeque<usize>>,
    /// Work of the coarse pass at each tile (rays and field evaluations), 0 while unknown.
    pub(super) effort: Vec<u64>,
    /// Sum of the known efforts, and their number.
    pub(super) known_effort: (u64, u64),
    /// Seconds and [`Stats::edges`] of the full pass at each tile, where known.
    pub(super) full: Vec<Option<(f64, u64)>>,
    /// Whether each worker takes requests at present.
    pub awake: Vec<bool>,
    /// Worker that should trace each tile in the full pass.
    pub(super) home: Vec<usize>,
    /// Worker that was given each tile last, other than in the coarse pass: it has the tile's first
    /// samples unless it was restarted.
    pub(super) holder: Vec<Option<usize>>,
    /// Tasks of workers that failed, to be repeated, each alone.
    pub again: Vec<usize>,
    failures: HashMap<usize, u32>,
    pub(super) failed_tiles: HashSet<usize>,
    pub failed_preparations: u32,
    /// Whether each task is done or given up.
    pub(super) over: Vec<bool>,
    /// Number of tasks done or given up in each pass.
    pub(super) completed: [usize; 3],
    pass_seconds: [Option<f64>; 3],
    pub(super) costs: Costs,
    /// Seconds that each finished task took.
    taken: Vec<Option<f64>>,
    forecast: Forecast,
    begun: f64,
    pub ended: Option<f64>,
    fraction: f64,
    stats: Stats,
}

impl Run {
    /// Cuts a picture into tasks for `workers` workers. A picture without pixels is finished at
    /// once.
    pub fn new(plan: Plan, workers: usize, now: f64) -> Self {
        let passes: &'static [Pass] = if plan.samples > 1 {
            &[Pass::Coarse, Pass::Full, Pass::Smooth]
        } else {
            &[Pass::Coarse, Pass::Full]
        };
        let (passes, side) = if plan.small {
            (&passes[passes.len() - 1..], SMALL_TILE)
        } else {
            (passes, TILE)
        };
        let tiles = tracer::tile::tiles(plan.size[0], plan.size[1], side);
        let tiles_in_passes = tiles.len() * passes.len();
        let mut run = Self {
            plan,
            left: vec![(0..tiles.len()).collect(); passes.len()],
            effort: vec![0; tiles.len()],
            known_effort: (0, 0),
            full: vec![None; tiles.len()],
            awake: vec![false; workers],
            home: Vec::new(),
            holder: vec![None; tiles.len()],
            over: vec![false; tiles_in_passes],
            tiles,
            passes,
            again: Vec::new(),
            failures: HashMap::new(),
            failed_tiles: HashSet::new(),
            failed_preparations: 0,
            completed: [0; 3],
            pass_seconds: [None; 3],
            costs: Costs::default(),
            taken: vec![None; tiles_in_passes],
            forecast: Forecast::default(),
            begun: now,
            ended: None,
            fraction: 0.0,
            stats: Stats::default(),
        };
        run.repartition();
        run.update(now);
        run
    }

    pub fn order(&self, task: usize, generation: u64) -> Order {
        Order {
            generation,
            tile: self.tiles[task % self.tiles.len()],
            pass: self.passes[task / self.tiles.len()],
        }
    }

    /// Notes that nothing more will be done for a task.
    pub(super) fn close(&mut self, task: usize) {
        self.over[task] = true;
        self.completed[task / self.tiles.len()] += 1;
    }

    /// Returns the number of complete passes.
    pub fn complete_passes(&self) -> usize {
        self.pass_seconds.iter().flatten().count()
    }

    /// Returns the time limit of a task, seconds. It grows with each failure, as a tile may be slow
    /// for good reasons.
    pub fn limit(&self, task: usize) -> f64 {
        let pass = task / self.tiles.len();
        let failures = self.failures.get(&task).copied().unwrap_or(0);
        let long = SLACK * self.costs.estimate(pass).max(self.costs.slowest(pass));
        (long.max(TILE_LIMIT) * RETRY.powi(failures as i32)).min(LONGEST_LIMIT)
    }

    /// Estimates the seconds of all tasks, and of those left.
    fn estimate(&self) -> (f64, f64) {
        let (mut all, mut left) = (0.0, 0.0);
        for pass in 0..self.passes.len() {
            let cost = self.costs.estimate(pass);
            all += cost * self.tiles.len() as f64;
            left += cost * (self.tiles.len() - self.completed[pass]) as f64;
        }
        (all, left)
    }

    /// Computes the seconds of work that is left, from what each open tile is expected to cost.
    fn work_left(&self) -> f64 {
        let count = self.tiles.len();
        let mut left = 0.0;
        for pass in 0..self.passes.len() {
            let tasks = (0..count).map(|tile| (tile, pass * count + tile));
            // A task that was given up neither tells nor takes anything.
            let tasks = tasks.filter(|(_, task)| !self.over[*task] || self.taken[*task].is_some());
            let tasks: Vec<Task> = tasks
                .map(|(tile, task)| Task {
                    expected: self.cost(pass, tile).0,
                    taken: self.taken[task],
                })
                .collect();
            left += work_left(&tasks);
        }
        left
    }

    /// Whether all tiles of a pass are done or given up.
    fn is_complete(&self, pass: usize) -> bool {
        self.completed[pass] == self.tiles.len()
    }

    /// Whether all passes are complete.
    fn is_finished(&self) -> bool {
        (0..self.passes.len()).all(|pass| self.is_complete(pass))
    }

    /// Notes complete passes and the end of the picture.
    pub fn update(&mut self, now: f64) {
        let mut coarse_is_complete = false;
        for pass in 0..self.passes.len() {
            if self.is_complete(pass) && self.pass_seconds[pass].is_none() {
                self.pass_seconds[pass] = Some(now - self.begun);
                coarse_is_complete |= self.passes[pass] == Pass::Coarse;
            }
        }
        let (all, left) = self.estimate();
        if all > 0.0 {
            self.fraction = self.fraction.max(1.0 - left / all);
        }
        if self.is_finished() {
            self.ended.get_or_insert(now);
            self.fraction = 1.0;
        }
        if coarse_is_complete {
            self.repartition();
        }
    }

    /// Notes that a task is done.
    pub fn finish(&mut self, task: usize, stats: &Stats, seconds: f64, now: f64) {
        let pass = task / self.tiles.len();
        let tile = task % self.tiles.len();
        self.close(task);
        match self.passes[pass] {
            Pass::Coarse => {
                let effort = stats.primary_rays + stats.shadow_rays + stats.field_evaluations;
                self.effort[tile] = effort;
                self.known_effort.0 += effort;
                self.known_effort.1 += u64::from(effort > 0);
            }
            Pass::Full => self.full[tile] = Some((seconds.max(0.0), stats.edges)),
            Pass::Smooth => {}
        }
        self.costs.add(pass, seconds.max(0.0));
        self.taken[task] = Some(seconds.max(0.0));
        if self.costs.enough() && self.forecast.is_due(self.begun, now) {
            let workers = self.awake.iter().filter(|awake| **awake).count();
            let left = self.work_left() / workers.max(1) as f64;
            self.forecast.note(left, now);
        }
        self.stats += *stats;
        self.update(now);
    }

    /// Notes that a worker died or hung while it held a task. Returns whether the task is given up.
    pub fn fail(&mut self, task: usize) -> bool {
        let failures = self.failures.entry(task).or_insert(0);
        *failures += 1;
        let give_up = *failures >= ATTEMPTS;
        if give_up {
            self.failed_tiles.insert(task % self.tiles.len());
            self.close(task);
        }
        give_up
    }

    /// Drops all tasks that are left.
    pub fn abandon(&mut self) {
        self.again.clear();
        self.left.iter_mut().for_each(VecDeque::clear);
    }

    /// Writes the picture's state into `progress`, whose number of workers must be set.
    pub fn report(&self, progress: &mut Progress, now: f64) {
        progress.generation = Some(self.plan.generation);
        progress.fraction = self.fraction;
        progress.finished = self.is_finished();
        progress.seconds = self.ended.unwrap_or(now) - self.begun;
        progress.pass_seconds = self.pass_seconds;
        progress.failed_tiles = self.failed_tiles.len() as u32;
        progress.stats = self.stats;
        if self.ended.is_none() {
            progress.pass = (0..self.passes.len())
                .find(|pass| !self.is_complete(*pass))
                .map(|pass| self.passes[pass]);
            let remaining = self.forecast.remaining(now);
            progress.remaining_seconds = remaining.filter(|_| progress.workers > 0);
        }
    }
}
