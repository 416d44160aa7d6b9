//! Which task a worker is given next.
//!
//! A tile is done in each pass by the worker that keeps its samples, as far as that is known: from the full pass on each
//! has its part of the picture ([`shares`]). What a tile costs is foretold by what the passes before came to. A worker is
//! given work ahead, as a page that draws takes its time to answer, but not so much that the others have nothing left to
//! help with.

use super::run::Run;
use super::share::shares;
use std::collections::VecDeque;
use tracer::{Pass, Tile};

/// Seconds of work a worker is given ahead.
pub const AHEAD: f64 = 0.25;
/// The same of the full pass, as long as it is not known who should have what.
const EARLY: f64 = 0.05;
/// Most tiles a worker is given ahead.
pub const MOST_AHEAD: usize = 64;
/// Among so many of its tiles a worker looks for the one that takes longest: a picture may have very many.
const LOOKED_AT: usize = 256;
/// A pixel that gets more rays takes so many times longer for each than a typical one of its tile: edges are dear. Measured
/// over all of seahorse, cowrie and sphereflake: 2.2, 1.9 and 1.0.
const EDGE_RAY: f64 = 1.5;
/// Seconds that the picture must be done earlier by, for each second that help costs.
const WORTH: f64 = 0.25;

impl Run {
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

    /// Says who should have each tile, by what is known of them: little when the first tiles of the full pass are handed out,
    /// all when the coarse pass is complete.
    pub(super) fn part(&mut self) {
        let known = self.effort.iter().copied().filter(|effort| *effort > 0);
        let least = known.min().unwrap_or(1);
        let cost = |effort: &u64| (*effort).max(least) as f64;
        let costs: Vec<f64> = self.effort.iter().map(cost).collect();
        self.home = shares(&self.tiles, &costs, self.awake.len());
    }

    /// A task never handed out, of the first pass that has one for this worker. Each has its tiles, and makes smooth what it
    /// has sampled, as it keeps most samples that it needs for that. When it is idle soon it helps the others, if that is
    /// worth it.
    fn draw(&mut self, worker: usize, idle: bool) -> Option<usize> {
        for pass in 0..self.passes.len() {
            let left = self.left[pass].len();
            if self.passes[pass] == Pass::Full && left == self.tiles.len() {
                self.part();
            }
            let place = self.own(pass, worker);
            let place = place.or_else(|| idle.then(|| self.worth_taking(pass, worker))?);
            if let Some(tile) = place.and_then(|place| self.left[pass].remove(place)) {
                return Some(pass * self.tiles.len() + tile);
            }
        }
        None
    }

    /// The place among those of a pass never handed out of the tile that a worker should do next: its own, or nobody's.
    fn own(&self, pass: usize, worker: usize) -> Option<usize> {
        let places = self.left[pass].iter().enumerate();
        if self.passes[pass] != Pass::Smooth {
            let mut places = places;
            let mine = |tile| {
                self.keeper(pass, tile)
                    .is_none_or(|keeper| keeper == worker)
            };
            return places.position(|(_, tile)| mine(*tile));
        }
        // What takes long comes first, so that all are done at about the same time.
        let sampled = self.left[..pass].iter().all(VecDeque::is_empty);
        let mine = |tile| match self.keeper(pass, tile) {
            Some(keeper) => keeper == worker,
            None => sampled,
        };
        places
            .filter(|(_, tile)| mine(**tile))
            .take(LOOKED_AT)
            .map(|(place, tile)| (place, self.cost(pass, *tile).0))
            // The first of equals.
            .min_by(|a, b| b.1.total_cmp(&a.1))
            .map(|(place, _)| place)
    }

    /// Who should do a tile in a pass; `None` if it is as good as any other.
    fn keeper(&self, pass: usize, tile: usize) -> Option<usize> {
        let keeper = match self.passes[pass] {
            Pass::Coarse => None,
            Pass::Full => Some(self.holder[tile].unwrap_or(self.home[tile])),
            Pass::Smooth => self.holder[tile],
        };
        keeper.filter(|worker| self.awake[*worker])
    }

    /// About how many seconds a tile takes in a pass the worker that should do it, and any other.
    fn cost(&self, pass: usize, tile: usize) -> (f64, f64) {
        let usual = self.costs.expected(pass);
        match self.passes[pass] {
            Pass::Coarse => (usual, usual),
            Pass::Full => {
                let (sum, count) = self.known_effort;
                let known = Some(self.effort[tile]).filter(|effort| *effort > 0);
                let share = known.map_or(1.0, |effort| effort as f64 * count as f64 / sum as f64);
                (usual * share, usual * share)
            }
            // Another one takes the first samples again unless it hears of them.
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

    /// The place among those of a pass never handed out of a tile of another worker that one without work should do: of the
    /// one that has most to do, the tile with which both are done earliest; none if that one is done earlier without help.
    fn worth_taking(&self, pass: usize, worker: usize) -> Option<usize> {
        let first = pass * self.tiles.len();
        let mut load = vec![0.0; self.awake.len()];
        for tile in (0..self.tiles.len()).filter(|tile| !self.over[first + tile]) {
            if let Some(keeper) = self.keeper(pass, tile) {
                load[keeper] += self.cost(pass, tile).0;
            }
        }
        let others = self.left[pass].iter().enumerate();
        let others =
            others.filter_map(|(place, tile)| Some((place, *tile, self.keeper(pass, *tile)?)));
        let others = others.filter(|(.., keeper)| *keeper != worker);
        let (.., most) = others
            .clone()
            .max_by(|a, b| load[a.2].total_cmp(&load[b.2]))?;
        let gain = |tile: usize| {
            let (own, strange) = self.cost(pass, tile);
            let done = (load[worker] + strange).max(load[most] - own);
            (load[most] - done, strange)
        };
        others
            .filter(|(.., keeper)| *keeper == most)
            .map(|(place, tile, _)| (place, gain(tile)))
            .filter(|(_, (gained, cost))| *gained > WORTH * cost)
            .max_by(|a, b| a.1.0.total_cmp(&b.1.0))
            .map(|(place, _)| place)
    }

    /// Whether a worker, one of so many, that holds these tasks should be given one more: so that it need not wait for the
    /// page, but that in the end none has much more than the others.
    pub fn is_too_little(&self, holds: &VecDeque<usize>, workers: usize) -> bool {
        let untaken: usize = self.left.iter().map(VecDeque::len).sum();
        if untaken == 0 || holds.len() >= MOST_AHEAD {
            return false;
        }
        // One is traced while the next one waits.
        if holds.len() < 2.min(untaken.div_ceil(workers.max(1))) {
            return true;
        }
        let tiles = self.tiles.len();
        let seconds = |task: &usize| self.cost(task / tiles, task % tiles).0;
        let held: f64 = holds.iter().map(seconds).sum();
        let coarse = self.settled[0] < tiles && self.left[0].is_empty();
        if held >= if coarse { EARLY } else { AHEAD } {
            return false;
        }
        // No more is added up than it takes to know, as a picture may have very many tiles.
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

    /// Whether tiles of the coarse pass were never handed out.
    pub fn is_coarse(&self) -> bool {
        self.passes[0] == Pass::Coarse && !self.left[0].is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pool::run::Plan;
    use tracer::Stats;

    /// A picture of so many pixels for so many workers, all awake.
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
    fn parts_are_as_large_as_the_coarse_pass_says_that_they_take_equally_long() {
        // The tiles on the left are dear.
        let effort = |tile: &Tile| if tile.x < 128 { 100 } else { 1 };
        for workers in [2, 3, 5] {
            for early in [0, 7] {
                let mut run = run([640, 512], workers);
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

    #[test]
    fn who_would_not_speed_up_a_pass_goes_on_with_his_own_tiles_of_the_next() {
        let mut run = run([128, 128], 2);
        let stats = Stats {
            field_evaluations: 10,
            edges: 150,
            ..Stats::default()
        };
        let (tiles, mut done) = (4, 0.0);
        let mut finish = |run: &mut Run, task| {
            done += 1e-3;
            run.done(task, &stats, 1e-3, done);
        };
        while run.is_coarse() {
            let task = run.take(0, false, false).unwrap();
            finish(&mut run, task);
        }
        let full: Vec<usize> = (0..2).map(|_| run.take(1, false, false).unwrap()).collect();
        let first = run.take(0, false, false).unwrap();
        assert!(full.iter().chain([&first]).all(|task| task / tiles == 1));
        // Each has two tiles of the full pass left, one of the first worker's was never handed out.
        let next = run.take(1, true, false).unwrap();
        assert_eq!(next / tiles, 2, "its own of the smooth pass");
        assert!(full.contains(&(next - tiles)));
        for task in full {
            finish(&mut run, task);
        }
        // Now help is worth it.
        let next = run.take(1, true, false).unwrap();
        assert_eq!(next / tiles, 1);
        assert_eq!(run.take(0, true, false).map(|task| task / tiles), Some(2));
    }

    #[test]
    fn help_to_make_smooth_is_worth_more_where_samples_are_told() {
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
                run.done(task, &stats, 1e-3, 0.0);
            }
            run.awake[1] = true;
            let (own, strange) = run.cost(2, 0);
            assert!((own - 1e-3).abs() < 1e-4, "{own}");
            assert!((strange - if shared { own } else { own + 1e-3 }).abs() < 1e-9);
            // With samples taken again both would be done no earlier.
            assert_eq!(run.take(1, true, false).is_some(), shared);
        }
    }

    #[test]
    fn a_worker_holds_little_as_long_as_it_is_not_known_who_should_have_what() {
        let mut run = run([1024, 768], 2);
        let fill = |run: &mut Run| {
            let mut holds = VecDeque::new();
            while run.is_too_little(&holds, 2) {
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
            run.done(task, &stats, 1e-4, 0.0);
        }
        // 3 ms each, as far as can be foretold.
        let early = fill(&mut run).len();
        assert!((10..=18).contains(&early), "{early}");
        run.done(last[0], &stats, 1e-4, 0.0);
        assert!(fill(&mut run).len() > 3 * early);
    }
}
