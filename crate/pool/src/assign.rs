//! Choice of the next task of a worker.
//!
//! A tile is traced in each pass by the worker that keeps its samples, as far as that is known:
//! from the full pass on each worker has its part of the picture ([`partition`]). The cost of a
//! tile is predicted from the passes before. A worker is given work ahead, because a page that is
//! drawing answers late, but not so much that the others have nothing left to help with.

use crate::partition::partition;
use crate::run::Run;
use std::collections::VecDeque;
use tracer::{Pass, Tile};

/// Seconds of work that a worker is given ahead.
pub const AHEAD: f64 = 0.25;
/// Seconds of work that a worker is given ahead in the full pass until the partition is known.
const EARLY: f64 = 0.05;
/// Most tiles a worker is given ahead.
pub const MOST_AHEAD: usize = 64;
/// Number of its tiles among which a worker looks for the most expensive one; a picture may have
/// very many.
const CANDIDATES: usize = 256;
/// Time of an additional ray at an edge pixel relative to a typical ray of its tile. Measured over
/// all of seahorse, cowrie and sphereflake: 2.2, 1.9 and 1.0.
const EDGE_RAY: f64 = 1.5;
/// Seconds by which helping must bring the end of the picture forward, for each second it takes.
const HELP_GAIN: f64 = 0.25;

impl Run {
    /// Returns the next task of a worker, from those never assigned or, with `again`, from those to
    /// be repeated. `None` if there is none for it.
    pub fn take(&mut self, worker: usize, idle: bool, again: bool) -> Option<usize> {
        loop {
            let task = if again {
                self.again.pop()?
            } else {
                self.next_new(worker, idle)?
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

    /// Recomputes the partition from the known costs: few are known when the first tiles of the
    /// full pass are assigned, all when the coarse pass is complete.
    pub(super) fn repartition(&mut self) {
        let known = self.effort.iter().copied().filter(|effort| *effort > 0);
        let least = known.min().unwrap_or(1);
        let costs = self.effort.iter().map(|effort| (*effort).max(least) as f64);
        self.home = partition(&self.tiles, &costs.collect::<Vec<_>>(), self.awake.len());
    }

    /// Returns a task never assigned, of the first pass that has one for this worker. Each worker
    /// has its own tiles and makes smooth those it has sampled, as it keeps most samples needed for
    /// that. A worker that is about to become idle helps the others if that pays.
    fn next_new(&mut self, worker: usize, idle: bool) -> Option<usize> {
        for pass in 0..self.passes.len() {
            let left = self.left[pass].len();
            if self.passes[pass] == Pass::Full && left == self.tiles.len() {
                self.repartition();
            }
            let index = self.next_own(pass, worker);
            let index = index.or_else(|| idle.then(|| self.tile_to_help_with(pass, worker))?);
            if let Some(tile) = index.and_then(|index| self.left[pass].remove(index)) {
                return Some(pass * self.tiles.len() + tile);
            }
        }
        None
    }

    /// Returns the index, among the unassigned tiles of a pass, of the tile that a worker should do
    /// next: one of its own, or one without a keeper.
    fn next_own(&self, pass: usize, worker: usize) -> Option<usize> {
        let is_smooth = self.passes[pass] == Pass::Smooth;
        // In the smooth pass, tiles without a keeper wait until all are sampled.
        let is_free = !is_smooth || self.left[..pass].iter().all(VecDeque::is_empty);
        let mut tiles = self.left[pass].iter().enumerate().filter(|(_, tile)| {
            self.keeper(pass, **tile)
                .map_or(is_free, |keeper| keeper == worker)
        });
        if !is_smooth {
            return tiles.next().map(|(index, _)| index);
        }
        // Expensive tiles come first, so that all workers finish at about the same time.
        tiles
            .take(CANDIDATES)
            .map(|(index, tile)| (index, self.cost(pass, *tile).0))
            // The first of equals.
            .min_by(|a, b| b.1.total_cmp(&a.1))
            .map(|(index, _)| index)
    }

    /// Returns the worker that should do a tile in a pass; `None` if any will do.
    fn keeper(&self, pass: usize, tile: usize) -> Option<usize> {
        let keeper = match self.passes[pass] {
            Pass::Coarse => None,
            Pass::Full => Some(self.holder[tile].unwrap_or(self.home[tile])),
            Pass::Smooth => self.holder[tile],
        };
        keeper.filter(|worker| self.awake[*worker])
    }

    /// Returns the expected seconds of a tile in a pass: for the worker that should do it, and for
    /// any other.
    pub(super) fn cost(&self, pass: usize, tile: usize) -> (f64, f64) {
        let usual = self.costs.estimate(pass);
        match self.passes[pass] {
            Pass::Coarse => (usual, usual),
            Pass::Full => {
                let (sum, count) = self.known_effort;
                let known = Some(self.effort[tile]).filter(|effort| *effort > 0);
                let share = known.map_or(1.0, |effort| effort as f64 * count as f64 / sum as f64);
                (usual * share, usual * share)
            }
            // Another worker takes the first samples again unless they are shared.
            Pass::Smooth => {
                let Some((seconds, edges)) = self.full[tile] else {
                    return (usual, 2.0 * usual);
                };
                let Tile { width, height, .. } = self.tiles[tile];
                let rays = 2.0 * edges as f64 * f64::from(self.plan.samples).powi(2);
                let pixels = f64::from(width) * f64::from(height);
                let own = EDGE_RAY * seconds * rays / pixels.max(1.0);
                let again = if self.plan.shared { 0.0 } else { seconds };
                (own, own + again)
            }
        }
    }

    /// Returns the index, among the unassigned tiles of a pass, of another worker's tile that an
    /// idle worker should do: of the worker with the most left to do, the tile with which both
    /// finish earliest. `None` if helping does not pay.
    fn tile_to_help_with(&self, pass: usize, worker: usize) -> Option<usize> {
        let first = pass * self.tiles.len();
        let mut load = vec![0.0; self.awake.len()];
        for tile in (0..self.tiles.len()).filter(|tile| !self.over[first + tile]) {
            if let Some(keeper) = self.keeper(pass, tile) {
                load[keeper] += self.cost(pass, tile).0;
            }
        }
        let others = self.left[pass].iter().enumerate();
        let others =
            others.filter_map(|(index, tile)| Some((index, *tile, self.keeper(pass, *tile)?)));
        let others = others.filter(|(.., keeper)| *keeper != worker);
        let (.., most) = others
            .clone()
            .max_by(|a, b| load[a.2].total_cmp(&load[b.2]))?;
        others
            .filter(|(.., keeper)| *keeper == most)
            .filter_map(|(index, tile, _)| {
                let (own, other) = self.cost(pass, tile);
                let end = (load[worker] + other).max(load[most] - own);
                let gain = load[most] - end;
                (gain > HELP_GAIN * other).then_some((index, gain))
            })
            .max_by(|a, b| a.1.total_cmp(&b.1))
            .map(|(index, _)| index)
    }

    /// Whether a worker that holds these tasks should be given one more: enough not to wait for the
    /// page, but not so much that it has much more left than the others when the picture ends.
    /// `workers`: the number of those awake.
    pub fn needs_more(&self, holds: &VecDeque<usize>, workers: usize) -> bool {
        let untaken: usize = self.left.iter().map(VecDeque::len).sum();
        if untaken == 0 || holds.len() >= MOST_AHEAD {
            return false;
        }
        // One is traced while the next one waits.
        if holds.len() < 2.min(untaken.div_ceil(workers.max(1))) {
            return true;
        }
        let tiles = self.tiles.len();
        let costs = holds
            .iter()
            .map(|task| self.cost(task / tiles, task % tiles).0);
        let held: f64 = costs.sum();
        let coarse = self.completed[0] < tiles && self.left[0].is_empty();
        if held >= if coarse { EARLY } else { AHEAD } {
            return false;
        }
        // Stops adding as soon as the answer is known, as a picture may have very many tiles.
        let enough = held * (2 * workers.max(1)) as f64;
        let mut left = 0.0;
        for pass in 0..self.passes.len() {
            for tile in &self.left[pass] {
                left += self.cost(pass, *tile).0;
                if left > enough {
                    return true;
                }
            }
        }
        false
    }

    /// Whether tiles of the coarse pass are still unassigned.
    pub fn is_coarse(&self) -> bool {
        self.passes[0] == Pass::Coarse && !self.left[0].is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::Plan;
    use tracer::Stats;

    /// Returns a picture for a number of workers, all awake.
    fn run(size: [u32; 2], workers: usize) -> Run {
        let plan = Plan {
            generation: 1,
            size,
            samples: 3,
            small: false,
            shared: false,
        };
        let mut run = Run::new(plan, workers, 0.0);
        run.awake.fill(true);
        run
    }

    #[test]
    fn parts_take_equally_long_by_the_costs_of_the_coarse_pass() {
        // The tiles on the left are expensive.
        fn effort(tile: &Tile) -> u64 {
            if tile.x < 128 { 100 } else { 1 }
        }
        for workers in [2, 3, 5] {
            for early in [0, 7] {
                let mut run = run([640, 512], workers);
                let tiles = run.tiles.clone();
                let finish_coarse = |run: &mut Run, tasks: std::ops::Range<usize>| {
                    for task in tasks {
                        let stats = Stats {
                            field_evaluations: effort(&tiles[task]),
                            ..Stats::default()
                        };
                        run.finish(task, &stats, 1e-3, 0.0);
                    }
                };
                for task in 0..tiles.len() {
                    assert_eq!(run.take(0, false, false), Some(task));
                }
                // Some tiles of the full pass are assigned while only these costs are known.
                finish_coarse(&mut run, 0..10);
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
                finish_coarse(&mut run, 10..tiles.len());
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

    #[test]
    fn idle_worker_starts_the_next_pass() {
        let mut run = run([128, 128], 2);
        let stats = Stats {
            field_evaluations: 10,
            edges: 150,
            ..Stats::default()
        };
        let (tiles, mut done) = (4, 0.0);
        let mut finish = |run: &mut Run, task| {
            done += 1e-3;
            run.finish(task, &stats, 1e-3, done);
        };
        while run.is_coarse() {
            let task = run.take(0, false, false).unwrap();
            finish(&mut run, task);
        }
        let full: Vec<usize> = (0..2).map(|_| run.take(1, false, false).unwrap()).collect();
        let first = run.take(0, false, false).unwrap();
        assert!(full.iter().chain([&first]).all(|task| task / tiles == 1));
        // Each has two tiles of the full pass left, one of the first worker's is unassigned.
        let next = run.take(1, true, false).unwrap();
        assert_eq!(next / tiles, 2, "its own of the smooth pass");
        assert!(full.contains(&(next - tiles)));
        for task in full {
            finish(&mut run, task);
        }
        // Now helping pays.
        let next = run.take(1, true, false).unwrap();
        assert_eq!(next / tiles, 1);
        assert_eq!(run.take(0, true, false).map(|task| task / tiles), Some(2));
    }

    #[test]
    fn helping_pays_more_where_samples_are_shared() {
        for shared in [false, true] {
            let mut run = run([128, 64], 2);
            run.plan.shared = shared;
            // Making smooth takes as long as the first samples did.
            let stats = Stats {
                field_evaluations: 10,
                edges: 152,
                ..Stats::default()
            };
            // Both tiles are the first worker's.
            run.awake[1] = false;
            for _ in 0..4 {
                let task = run.take(0, false, false).unwrap();
                run.finish(task, &stats, 1e-3, 0.0);
            }
            run.awake[1] = true;
            let (own, other) = run.cost(2, 0);
            assert!((own - 1e-3).abs() < 1e-4, "{own}");
            assert!((other - if shared { own } else { own + 1e-3 }).abs() < 1e-9);
            // With samples taken again both would be done no earlier.
            assert_eq!(run.take(1, true, false).is_some(), shared);
        }
    }

    #[test]
    fn worker_holds_few_tiles_until_the_partition_is_known() {
        let mut run = run([1024, 768], 2);
        let fill = |run: &mut Run| {
            let mut holds = VecDeque::new();
            while run.needs_more(&holds, 2) {
                let task = run.take(0, false, false);
                holds.extend(task);
                if task.is_none() {
                    break;
                }
            }
            holds
        };
        let stats = Stats {
            field_evaluations: 10,
            ..Stats::default()
        };
        let mut coarse = Vec::new();
        while run.is_coarse() {
            coarse.extend(run.take(0, false, false));
        }
        let last = coarse.split_off(coarse.len() - 1);
        for task in coarse {
            run.finish(task, &stats, 1e-4, 0.0);
        }
        // Predicted to take 3 ms each.
        let early = fill(&mut run).len();
        assert!((10..=18).contains(&early), "{early}");
        run.finish(last[0], &stats, 1e-4, 0.0);
        assert!(fill(&mut run).len() > 3 * early);
    }
}
