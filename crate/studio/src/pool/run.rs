//! The picture being traced: which tiles in which passes are to be done, are done, or were given up.

use super::progress::{Costs, Progress};
use super::scheduler::ATTEMPTS;
use super::share::shares;
use std::collections::{HashMap, HashSet, VecDeque};
use tracer::{Pass, Stats, Tile};
use worker::Order;

/// Seconds of work a worker is given ahead.
pub const AHEAD: f64 = 0.25;
/// The same of the full pass, as long as it is not known who should have what.
pub const EARLY: f64 = 0.05;
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
/// A pixel that gets more rays takes so many times longer for each than a typical one of its tile: edges are dear. Measured
/// in seahorse, cowrie and sphereflake: 2.3, 1.5 and 1.0.
const EDGE_RAY: f64 = 1.5;
/// Seconds that the picture must be done earlier by, for each second that help costs.
const WORTH: f64 = 0.25;

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
    /// The pass whose tiles are handed out. A task is a tile in a pass: pass · number of tiles + tile.
    pass: usize,
    /// Its tiles that were never handed out, in the order in which they are.
    left: VecDeque<usize>,
    /// What the coarse pass did at each tile, 0 as long as nothing is known.
    effort: Vec<u64>,
    /// What the full pass came to at each tile, if it is known: seconds, and [`Stats::edges`].
    full: Vec<Option<(f64, u64)>>,
    /// Which workers take requests at present.
    pub awake: Vec<bool>,
    /// Who should have each tile in the full pass, …
    home: Vec<usize>,
    /// … and who was given it last, but for the coarse pass, and so has its first samples if it was not restarted since.
    holder: Vec<Option<usize>>,
    /// Tasks handed out before, to be done again, each alone.
    pub again: Vec<usize>,
    failures: HashMap<usize, u32>,
    failed_tiles: HashSet<usize>,
    pub failed_preparations: u32,
    /// Which tasks are done or given up, and how many of each pass.
    over: Vec<bool>,
    settled: [usize; 3],
    pass_seconds: [Option<f64>; 3],
    costs: Costs,
    begun: f64,
    pub ended: Option<f64>,
    fraction: f64,
    stats: Stats,
}

impl Run {
    /// Cuts a picture into tasks for so many workers. One without pixels is finished at once.
    pub fn new(plan: Plan, workers: usize, now: f64) -> Self {
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
        let tiles = tracer::tile::tiles(plan.size[0], plan.size[1], side);
        let mut run = Self {
            plan,
            pass: 0,
            left: (0..tiles.len()).collect(),
            effort: vec![0; tiles.len()],
            full: vec![None; tiles.len()],
            awake: vec![false; workers],
            home: Vec::new(),
            holder: vec![None; tiles.len()],
            over: vec![false; tiles.len() * passes.len()],
            tiles,
            passes,
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
        run.part();
        run.settle(now);
        run
    }

    /// Tasks never handed out.
    fn untaken(&self) -> usize {
        self.left.len() + self.tiles.len() * (self.passes.len() - 1 - self.pass)
    }

    pub fn order(&self, task: usize, generation: u64) -> Order {
        Order {
            generation,
            tile: self.tiles[task % self.tiles.len()],
            pass: self.passes[task / self.tiles.len()],
        }
    }

    /// The next task of a worker, from those never handed out or from those to be done again.
    pub fn take(&mut self, worker: usize, idle: bool, again: bool) -> Option<usize> {
        loop {
            let task = if again {
                self.again.pop()?
            } else {
                self.draw(worker, idle)?
            };
            let (pass, tile) = (task / self.tiles.len(), task % self.tiles.len());
            // A tile that was given up is not tried in later passes.
            if !self.failed_tiles.contains(&tile) {
                if self.passes[pass] != Pass::Coarse {
                    self.holder[tile] = Some(worker);
                }
                return Some(task);
            }
            self.close(task);
        }
    }

    /// Notes that nothing more will be done for a task.
    fn close(&mut self, task: usize) {
        self.over[task] = true;
        self.settled[task / self.tiles.len()] += 1;
    }

    /// Says who should have each tile, by what is known of them: little when the first tiles of the full pass are handed out,
    /// all when the coarse pass is complete.
    fn part(&mut self) {
        let known = self.effort.iter().copied().filter(|effort| *effort > 0);
        let least = known.min().unwrap_or(1);
        let cost = |effort: &u64| (*effort).max(least) as f64;
        let costs: Vec<f64> = self.effort.iter().map(cost).collect();
        self.home = shares(&self.tiles, &costs, self.awake.len());
    }

    /// A task never handed out, of the first pass that has one. Each worker has its tiles, and makes smooth what it has
    /// sampled, as it keeps most samples that it needs for that. When it is idle soon it helps the others, if that is worth it.
    fn draw(&mut self, worker: usize, idle: bool) -> Option<usize> {
        while self.left.is_empty() {
            self.pass = (self.pass + 1 < self.passes.len()).then_some(self.pass + 1)?;
            self.left.extend(0..self.tiles.len());
            if self.passes[self.pass] == Pass::Full {
                self.part();
            }
        }
        let mine = |tile: &usize| self.keeper(*tile).is_none_or(|keeper| keeper == worker);
        let place = if self.passes[self.pass] == Pass::Smooth {
            // What takes long comes first, so that all are done at about the same time.
            let mine = self.left.iter().enumerate().filter(|(_, tile)| mine(tile));
            mine.map(|(place, tile)| (place, self.cost(*tile).0))
                .rev()
                .max_by(|a, b| a.1.total_cmp(&b.1))
                .map(|(place, _)| place)
        } else {
            self.left.iter().position(mine)
        };
        let place = place.or_else(|| idle.then(|| self.worth_taking(worker))?)?;
        let tile = self.left.remove(place)?;
        Some(self.pass * self.tiles.len() + tile)
    }

    /// Who should do a tile in the pass whose tiles are handed out; `None` if it is as good as any other.
    fn keeper(&self, tile: usize) -> Option<usize> {
        let keeper = match self.passes[self.pass] {
            Pass::Coarse => None,
            Pass::Full => Some(self.holder[tile].unwrap_or(self.home[tile])),
            Pass::Smooth => self.holder[tile],
        };
        keeper.filter(|worker| self.awake[*worker])
    }

    /// About what a tile costs in that pass the worker that should do it, and any other, in a unit that depends on the pass.
    fn cost(&self, tile: usize) -> (f64, f64) {
        if self.passes[self.pass] != Pass::Smooth {
            let effort = self.effort[tile].max(1) as f64;
            return (effort, effort);
        }
        // Another one takes the first samples again.
        let Some((seconds, edges)) = self.full[tile] else {
            let seconds = self.costs.expected(self.pass);
            return (seconds, 2.0 * seconds);
        };
        let Tile { width, height, .. } = self.tiles[tile];
        let rays = 2.0 * edges as f64 * f64::from(self.plan.samples).powi(2);
        let own = EDGE_RAY * seconds * rays / (f64::from(width) * f64::from(height)).max(1.0);
        (own, own + seconds)
    }

    /// The place among those never handed out of a tile of another worker that a worker without work should do: of the one
    /// that has most to do, the tile with which both are done earliest; none if that one is done earlier without help.
    fn worth_taking(&self, worker: usize) -> Option<usize> {
        let first = self.pass * self.tiles.len();
        let mut load = vec![0.0; self.awake.len()];
        for tile in (0..self.tiles.len()).filter(|tile| !self.over[first + tile]) {
            if let Some(keeper) = self.keeper(tile) {
                load[keeper] += self.cost(tile).0;
            }
        }
        let of_others = self.left.iter().enumerate();
        let of_others =
            of_others.filter_map(|(place, tile)| Some((place, *tile, self.keeper(*tile)?)));
        let (.., most) = of_others
            .clone()
            .max_by(|a, b| load[a.2].total_cmp(&load[b.2]))?;
        let gain = |tile: usize| {
            let (own, strange) = self.cost(tile);
            let done = (load[worker] + strange).max(load[most] - own);
            (load[most] - done, strange)
        };
        of_others
            .filter(|(.., keeper)| *keeper == most)
            .map(|(place, tile, _)| (place, gain(tile)))
            .filter(|(_, (gained, cost))| *gained > WORTH * cost)
            .max_by(|a, b| a.1.0.total_cmp(&b.1.0))
            .map(|(place, _)| place)
    }

    /// How many tasks never handed out a worker should hold, one of so many workers: enough not to
    /// wait for the page, but in the end no worker should have much more than the others.
    pub fn enough(&self, workers: usize) -> usize {
        let untaken = self.untaken();
        if untaken == 0 {
            return 0;
        }
        let pass = self.pass + usize::from(self.left.is_empty());
        let seconds = if pass > 0 && self.settled[0] < self.tiles.len() {
            EARLY
        } else {
            AHEAD
        };
        let ahead = (seconds / self.costs.expected(pass)).clamp(2.0, MOST_AHEAD as f64) as usize;
        let share = untaken.div_ceil(2 * workers.max(1));
        ahead.min(share)
    }

    /// Whether tiles of the coarse pass were never handed out.
    pub fn is_coarse(&self) -> bool {
        self.passes[self.pass] == Pass::Coarse && !self.left.is_empty()
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
        let mut parted = false;
        for pass in 0..self.passes.len() {
            if complete(pass) && self.pass_seconds[pass].is_none() {
                self.pass_seconds[pass] = Some(now - self.begun);
                parted |= self.passes[pass] == Pass::Coarse;
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
        if parted {
            self.part();
        }
    }

    /// A task is done.
    pub fn done(&mut self, task: usize, stats: &Stats, seconds: f64, now: f64) {
        let pass = task / self.tiles.len();
        let tile = task % self.tiles.len();
        self.close(task);
        match self.passes[pass] {
            Pass::Coarse => {
                self.effort[tile] =
                    stats.primary_rays + stats.shadow_rays + stats.field_evaluations;
            }
            Pass::Full => self.full[tile] = Some((seconds.max(0.0), stats.edges)),
            Pass::Smooth => {}
        }
        self.costs.add(pass, seconds.max(0.0));
        self.stats += *stats;
        self.settle(now);
    }

    /// A worker died or hung while it held a task. Says whether the task is given up.
    pub fn failed(&mut self, task: usize) -> bool {
        let failures = self.failures.entry(task).or_insert(0);
        *failures += 1;
        let give_up = *failures >= ATTEMPTS;
        if give_up {
            self.failed_tiles.insert(task % self.tiles.len());
            self.close(task);
        }
        give_up
    }

    /// Hands out nothing more.
    pub fn abandon(&mut self) {
        self.again.clear();
        self.left.clear();
        self.pass = self.passes.len() - 1;
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_as_large_as_the_coarse_pass_says_that_they_take_equally_long() {
        // The tiles on the left are dear.
        let effort = |tile: &Tile| if tile.x < 128 { 100 } else { 1 };
        for workers in [2, 3, 5] {
            for early in [0, 7] {
                let plan = Plan {
                    generation: 1,
                    size: [640, 512],
                    samples: 3,
                    small: false,
                };
                let mut run = Run::new(plan, workers, 0.0);
                run.awake.fill(true);
                let tiles = run.tiles.clone();
                let coarse = |run: &mut Run, some: std::ops::Range<usize>| {
                    for task in some {
                        let stats = Stats {
                            field_evaluations: effort(&tiles[task]),
                            ..Stats::default()
                        };
                        run.done(task, &stats, 1e-3, 0.0);
                    }
                };
                for task in 0..tiles.len() {
                    assert_eq!(run.take(0, false, false), Some(task));
                }
                // Some of the full pass are handed out before more is known than this.
                coarse(&mut run, 0..10);
                let mut full = vec![0; workers];
                let mut take = |run: &mut Run, worker: usize| {
                    let task = run.take(worker, false, false)?;
                    if task >= 2 * tiles.len() {
                        return None;
                    }
                    full[worker] += effort(&tiles[task % tiles.len()]);
                    Some(task)
                };
                for _ in 0..early {
                    take(&mut run, 0);
                }
                coarse(&mut run, 10..tiles.len());
                for worker in 0..workers {
                    while take(&mut run, worker).is_some() {}
                }
                let all: u64 = tiles.iter().map(effort).sum();
                assert_eq!(full.iter().sum::<u64>(), all);
                let mean = all as f64 / workers as f64;
                for taken in &full {
                    let apart = (*taken as f64 - mean).abs();
                    assert!(early > 0 || apart <= 200.0, "{workers}: {full:?}");
                    assert!(apart <= 500.0, "{workers}, {early} early: {full:?}");
                }
            }
        }
    }
}
