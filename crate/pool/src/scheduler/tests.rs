//! The scheduler against a crowd of imagined workers and an imagined clock.

use super::*;
use crate::assign::MOST_AHEAD;
use crate::run::{LONGEST_LIMIT, RETRY, SLACK, TILE_LIMIT};
use std::collections::{HashMap, HashSet, VecDeque};
use tracer::{Pass, Tile};
use trials::{Random, count};

const STATS: Stats = Stats {
    primary_rays: 1,
    shadow_rays: 2,
    secondary_rays: 0,
    field_evaluations: 3,
    // As many as make smoothing take as long as the first samples do.
    edges: 150,
};

fn plan(generation: u64) -> Plan {
    Plan {
        generation,
        size: [256, 192],
        samples: 3,
        small: false,
        shared: false,
    }
}

/// Workers that do what they are told when [`Crowd::work`] is called, unless they hang.
struct Crowd {
    scheduler: Scheduler,
    now: f64,
    /// Queued messages to the page of each worker, first the one that comes first.
    desks: Vec<VecDeque<Job>>,
    /// Tiles at which a worker dies.
    deadly: HashSet<Order>,
    /// Workers that answer nothing.
    hanging: HashSet<usize>,
    /// Evaluations that a tile takes.
    effort: fn(&Tile) -> u64,
    /// Number of a tile's pixels that get more rays.
    edges: fn(&Tile) -> u64,
    restarts: usize,
    done: Vec<Order>,
}

#[derive(Clone, Copy, Debug)]
enum Job {
    Start,
    Note(u64),
    Prepare(u64),
    Tile(Order),
}

impl Crowd {
    fn new(workers: usize) -> Self {
        let mut crowd = Self {
            scheduler: Scheduler::new(workers),
            now: 0.0,
            desks: vec![VecDeque::new(); workers],
            deadly: HashSet::new(),
            hanging: HashSet::new(),
            effort: |_| STATS.field_evaluations,
            edges: |_| STATS.edges,
            restarts: 0,
            done: Vec::new(),
        };
        crowd.scheduler.launch(0.0);
        crowd.obey();
        crowd
    }

    fn obey(&mut self) {
        for command in self.scheduler.commands() {
            let number = self.scheduler.number();
            match command {
                Command::Restart(i) => {
                    self.restarts += 1;
                    self.hanging.remove(&i);
                    self.desks[i] = VecDeque::from([Job::Start]);
                }
                Command::End(i) => self.desks[i].clear(),
                Command::Begin(i) => {
                    self.desks[i].retain(|job| matches!(job, Job::Start));
                    self.desks[i].extend([Job::Note(number), Job::Prepare(number)]);
                }
                Command::Trace(i, orders) => {
                    self.desks[i].extend(orders.into_iter().map(Job::Tile));
                }
                Command::Stop(i) => {
                    self.desks[i].clear();
                    self.desks[i].push_back(Job::Note(number));
                }
            }
        }
    }

    /// Returns workers that have done some jobs each for the first picture.
    fn at_work(workers: usize, jobs: usize) -> Self {
        let mut crowd = Self::new(workers);
        crowd.start(1);
        for _ in 0..jobs {
            crowd.work();
        }
        crowd
    }

    fn start(&mut self, generation: u64) {
        self.scheduler.start(plan(generation), self.now);
        self.obey();
    }

    /// Lets every worker do one job, which takes a millisecond. Returns whether anyone had one.
    fn work(&mut self) -> bool {
        let mut any = false;
        self.now += 1e-3;
        for i in 0..self.desks.len() {
            if self.hanging.contains(&i) {
                continue;
            }
            any |= self.work_one(i).is_some();
        }
        any
    }

    /// Lets a worker do one job. Returns that job, if there was one.
    fn work_one(&mut self, i: usize) -> Option<Job> {
        let job = self.desks[i].pop_front()?;
        match job {
            Job::Start => self.scheduler.note_start(i, self.now),
            Job::Note(number) => self.scheduler.note_picture(i, number, self.now),
            Job::Prepare(number) => self.scheduler.note_preparation(i, number, self.now),
            Job::Tile(order) if self.deadly.contains(&order) => {
                self.scheduler.note_death(i, "deadly", self.now);
            }
            Job::Tile(order) => {
                let stats = Stats {
                    field_evaluations: (self.effort)(&order.tile),
                    edges: (self.edges)(&order.tile),
                    ..STATS
                };
                if self.scheduler.take_tile(i, order, &stats, 1e-3, self.now) {
                    self.done.push(order);
                }
            }
        }
        self.obey();
        Some(job)
    }

    fn work_off(&mut self) {
        while self.work() {
            assert!(self.now < 1e4, "endless");
        }
    }

    /// Lets time pass without any work; the pool looks at the clock now and then.
    fn wait(&mut self, seconds: f64) {
        let end = self.now + seconds;
        while self.now < end {
            self.now += 0.1;
            self.scheduler.tick(self.now);
            self.obey();
        }
    }

    fn progress(&self) -> Progress {
        self.scheduler.progress(self.now)
    }
}

#[test]
fn each_tile_is_traced_once_per_pass_from_the_centre() {
    let mut crowd = Crowd::new(3);
    crowd.start(7);
    let mut fraction = 0.0;
    while crowd.work() {
        let progress = crowd.progress();
        assert!(progress.fraction >= fraction, "the bar fell");
        fraction = progress.fraction;
    }
    let tiles = tracer::tile::tiles(256, 192, crate::job::TILE);
    assert_eq!(crowd.done.len(), 3 * tiles.len());
    assert_eq!(
        crowd.done.iter().collect::<HashSet<_>>().len(),
        3 * tiles.len()
    );
    assert_eq!(
        (crowd.done[0].tile, crowd.done[0].pass),
        (tiles[0], Pass::Coarse)
    );
    // Passes may overlap by what the workers hold ahead, not more.
    let last_coarse = crowd.done.iter().rposition(|o| o.pass == Pass::Coarse);
    assert!(last_coarse.unwrap() < tiles.len() + 3 * MOST_AHEAD);
    let progress = crowd.progress();
    assert!(progress.finished && progress.fraction == 1.0 && progress.pass.is_none());
    assert_eq!(progress.generation, Some(7));
    assert_eq!(progress.stats.field_evaluations, 3 * 3 * tiles.len() as u64);
    assert!(progress.pass_seconds.iter().all(Option::is_some));
    assert_eq!((progress.restarted, progress.error), (0, None));
    assert!(!crowd.scheduler.is_busy());
}

#[test]
fn coarse_pass_is_assigned_round_robin() {
    let mut crowd = Crowd::new(3);
    crowd.work();
    crowd.scheduler.start(plan(1), 0.0);
    let tiles = tracer::tile::tiles(256, 192, crate::job::TILE);
    let mut dealt = vec![None; tiles.len()];
    for command in crowd.scheduler.commands() {
        let Command::Trace(worker, orders) = command else {
            continue;
        };
        for order in orders {
            assert_eq!(order.pass, Pass::Coarse);
            let at = tiles.iter().position(|tile| *tile == order.tile);
            dealt[at.unwrap()] = Some(worker);
        }
    }
    let wanted: Vec<_> = (0..tiles.len()).map(|i| Some(i % 3)).collect();
    assert_eq!(dealt, wanted);
}

#[test]
fn worker_smooths_its_own_tiles_then_helps() {
    let size = [1024, 768];
    let run = |workers: usize, slow: Option<usize>| {
        let mut crowd = Crowd::new(workers);
        let mut by = HashMap::new();
        crowd.scheduler.start(Plan { size, ..plan(1) }, 0.0);
        crowd.obey();
        for round in 0.. {
            assert!(round < 10_000, "endless");
            for worker in 0..workers {
                if slow == Some(worker) && round % 10 != 0 {
                    continue;
                }
                if let Some(Job::Tile(order)) = crowd.work_one(worker) {
                    by.insert((order.tile, order.pass), worker);
                }
            }
            if crowd.progress().finished {
                break;
            }
        }
        by
    };
    let tiles = tracer::tile::tiles(size[0], size[1], crate::job::TILE);
    for workers in [1, 2, 3] {
        let by = run(workers, None);
        // Only the last tiles, with which a finished worker helps, change hands.
        let moved = tiles
            .iter()
            .filter(|tile| by[&(**tile, Pass::Full)] != by[&(**tile, Pass::Smooth)])
            .count();
        assert!(
            16 * moved <= tiles.len() && (workers > 1 || moved == 0),
            "{moved}"
        );
    }
    // Adjacent tiles go to one worker.
    let by = run(2, None);
    let parted = tiles.iter().filter(|tile| {
        let right = tiles
            .iter()
            .find(|other| (other.x, other.y) == (tile.x + 64, tile.y));
        right.is_some_and(|right| by[&(*right, Pass::Full)] != by[&(**tile, Pass::Full)])
    });
    let parted = parted.count();
    assert!(parted <= 18, "{parted}");
    // A slow worker is helped.
    let by = run(2, Some(0));
    let slow = by
        .iter()
        .filter(|((_, pass), worker)| *pass != Pass::Coarse && **worker == 0);
    assert!(slow.count() < tiles.len() / 2 + 2);
}

/// Returns the number of tiles made smooth by another worker than the one that has sampled them,
/// with two workers and a picture of which each has a half.
fn count_help(edges: fn(&Tile) -> u64) -> usize {
    let mut crowd = Crowd::new(2);
    crowd.edges = edges;
    // Both are awake.
    crowd.work();
    let size = [512, 512];
    crowd.scheduler.start(Plan { size, ..plan(1) }, 0.0);
    crowd.obey();
    let (mut by, mut busy) = (HashMap::new(), [0; 2]);
    while !crowd.progress().finished {
        crowd.now += 1e-3;
        for (worker, busy) in busy.iter_mut().enumerate() {
            // Tiles without edges take no time, the others as long as the scheduler predicts.
            if *busy > 0 {
                *busy -= 1;
                continue;
            }
            if let Some(Job::Tile(order)) = crowd.work_one(worker) {
                by.insert((order.tile, order.pass), worker);
                if order.pass == Pass::Smooth {
                    *busy = edges(&order.tile) / STATS.edges;
                }
            }
        }
    }
    let smooth = by.iter().filter(|((_, pass), _)| *pass == Pass::Smooth);
    smooth
        .filter(|((tile, _), worker)| by[&(*tile, Pass::Full)] != **worker)
        .count()
}

#[test]
fn idle_worker_helps_only_where_it_pays() {
    // Nothing would be gained with tiles that take a tenth of the time of their samples, …
    assert_eq!(count_help(|tile| if tile.x < 256 { 15 } else { 0 }), 0);
    // … but much with those that take ten times as long.
    let many = count_help(|tile| if tile.x < 256 { 1500 } else { 0 });
    assert!((10..=16).contains(&many), "{many} of 32");
}

#[test]
fn tiles_of_a_lost_worker_go_to_the_others() {
    for edges in [|_: &Tile| 0, |_: &Tile| 1500] {
        // Whenever it dies.
        for after in 0..60 {
            let mut crowd = Crowd::new(2);
            crowd.edges = edges;
            crowd.start(1);
            for _ in 0..after {
                crowd.work();
            }
            crowd.hanging.insert(0);
            while crowd.scheduler.slots[0].life.is_running() {
                crowd.scheduler.note_death(0, "gone", crowd.now);
                crowd.obey();
            }
            crowd.work_off();
            assert!(crowd.progress().finished, "after {after}");
        }
    }
}

#[test]
fn expensive_tiles_are_smoothed_first() {
    // In the order of the tiles they are neither the first nor the last of the first worker's.
    fn is_dear(tile: &Tile) -> bool {
        [(64, 0), (0, 64)].contains(&(tile.x, tile.y))
    }
    let mut crowd = Crowd::new(2);
    crowd.edges = |tile| if is_dear(tile) { 1000 } else { 1 };
    // Both are awake.
    crowd.work();
    crowd.start(1);
    crowd.work_off();
    let smooth = crowd.done.iter().filter(|order| order.pass == Pass::Smooth);
    let left: Vec<Tile> = smooth.map(|o| o.tile).filter(|tile| tile.x < 128).collect();
    assert_eq!(left.len(), 6);
    assert!(is_dear(&left[0]) && is_dear(&left[1]), "{left:?}");
}

#[test]
fn idle_worker_is_reconsidered_when_costs_are_known() {
    let mut crowd = Crowd::new(2);
    crowd.edges = |tile| if tile.x == 0 { 1500 } else { 0 };
    crowd.work();
    let size = [128, 192];
    crowd.scheduler.start(Plan { size, ..plan(1) }, 0.0);
    crowd.obey();
    while crowd.progress().pass_seconds[0].is_none() {
        crowd.work();
    }
    // The second one does all that it is given; then it is the first one's turn.
    while crowd.work_one(1).is_some() {}
    let before = crowd.done.len();
    while crowd.desks[1].is_empty() && crowd.work_one(0).is_some() {}
    assert!(crowd.done.len() > before && !crowd.progress().finished);
    assert!(matches!(crowd.desks[1].front(), Some(Job::Tile(order)) if order.tile.x == 0));
    crowd.work_off();
    assert!(crowd.progress().finished);
}

#[test]
fn every_picture_ends() {
    const EDGES: [fn(&Tile) -> u64; 3] = [|_| 0, |tile| 9 * tile.x as u64, |_| 2000];
    let mut random = Random::new(1);
    for case in 0..count(3000) {
        let workers = 1 + random.below(4);
        let mut crowd = Crowd::new(workers);
        crowd.edges = EDGES[random.below(3)];
        let size = [
            64 * (1 + random.below(4)) as u32,
            64 * (1 + random.below(3)) as u32,
        ];
        let samples = 1 + random.below(3) as u32;
        let small = random.below(8) == 0;
        let plan = Plan {
            size,
            samples,
            small,
            ..plan(1)
        };
        for _ in 0..random.below(6) {
            crowd.work();
        }
        crowd.scheduler.start(plan, crowd.now);
        crowd.obey();
        let tiles = tracer::tile::tiles(size[0], size[1], crate::job::TILE);
        for tile in tiles {
            for pass in [Pass::Coarse, Pass::Full, Pass::Smooth] {
                if random.below(12) == 0 {
                    let generation = crowd.scheduler.number();
                    crowd.deadly.insert(Order {
                        generation,
                        tile,
                        pass,
                    });
                }
            }
        }
        for step in 0.. {
            assert!(step < 100_000, "endless: {case}");
            let worker = random.below(workers);
            if random.below(200) == 0 {
                crowd.scheduler.note_death(worker, "by chance", crowd.now);
                crowd.obey();
            }
            crowd.now += 1e-3;
            let _ = crowd.work_one(worker);
            if crowd.desks.iter().all(VecDeque::is_empty) {
                break;
            }
        }
        let progress = crowd.progress();
        assert!(
            progress.finished || progress.error.is_some(),
            "{case}: {progress:?}"
        );
        assert!(!crowd.scheduler.is_busy(), "{case}");
    }
}

#[test]
fn one_ray_per_pixel_has_no_smooth_pass() {
    let mut crowd = Crowd::new(2);
    let samples = 1;
    crowd.scheduler.start(Plan { samples, ..plan(1) }, 0.0);
    crowd.obey();
    crowd.work_off();
    assert!(crowd.progress().finished);
    assert!(crowd.done.iter().all(|order| order.pass != Pass::Smooth));
}

#[test]
fn small_picture_has_only_the_last_pass() {
    let mut crowd = Crowd::new(2);
    let small = true;
    crowd.scheduler.start(Plan { small, ..plan(1) }, 0.0);
    crowd.obey();
    assert_eq!(crowd.scheduler.complete_passes(), 0);
    crowd.work_off();
    assert!(crowd.progress().finished);
    assert_eq!(crowd.scheduler.complete_passes(), 1);
    assert!(!crowd.done.is_empty());
    assert!(crowd.done.iter().all(|order| order.pass == Pass::Smooth));
}

#[test]
fn empty_picture_is_finished_at_once() {
    let mut crowd = Crowd::new(2);
    let size = [0, 96];
    crowd.scheduler.start(Plan { size, ..plan(1) }, 0.0);
    assert!(crowd.progress().finished);
}

#[test]
fn remaining_time_is_known_once_measured() {
    let mut crowd = Crowd::new(2);
    crowd.start(1);
    assert_eq!(crowd.progress().remaining_seconds, None);
    for _ in 0..20 {
        crowd.work();
    }
    // Within the first second nothing is told.
    assert_eq!(crowd.progress().remaining_seconds, None);
    crowd.now += 1.0;
    crowd.work();
    let progress = crowd.progress();
    assert!(progress.remaining_seconds.unwrap() > 0.0);
    assert!(progress.pass.is_some());
}

#[test]
fn new_picture_replaces_the_old_one() {
    let mut crowd = Crowd::at_work(2, 6);
    let before = crowd.done.len();
    assert!(before > 0);
    crowd.start(1); // the same number again: tiles of the first run must not be mixed in
    crowd.work_off();
    let tiles = tracer::tile::tiles(256, 192, crate::job::TILE).len();
    assert_eq!(crowd.done.len(), before + 3 * tiles);
    assert!(crowd.progress().finished);
}

#[test]
fn worker_at_an_old_picture_is_replaced_without_blame() {
    let mut crowd = Crowd::at_work(2, 6);
    crowd.hanging.insert(0);
    crowd.start(2);
    let restarts = crowd.restarts;
    crowd.work();
    crowd.wait(PATIENCE + 0.2);
    assert_eq!(crowd.restarts, restarts + 1);
    crowd.work_off();
    let progress = crowd.progress();
    assert!(progress.finished);
    assert_eq!((progress.restarted, progress.failed_tiles), (0, 0));
}

#[test]
fn late_answer_saves_a_suspected_worker() {
    let mut crowd = Crowd::new(1);
    crowd.start(1);
    crowd.work();
    crowd.work();
    crowd.start(2);
    let restarts = crowd.restarts;
    crowd.now += 5.0; // the page was busy; the timer comes before the worker's message
    crowd.scheduler.tick(crowd.now);
    crowd.obey();
    crowd.work_off();
    crowd.wait(1.0);
    assert_eq!(crowd.restarts, restarts);
    assert!(crowd.progress().finished);
}

#[test]
fn cancel_ends_everything() {
    let mut crowd = Crowd::at_work(2, 6);
    crowd.scheduler.cancel(crowd.now);
    crowd.obey();
    let before = crowd.done.len();
    crowd.work_off();
    assert_eq!(crowd.done.len(), before);
    assert!(!crowd.scheduler.is_busy());
    let progress = crowd.progress();
    assert!(!progress.finished && progress.pass.is_none());
    let seconds = progress.seconds;
    crowd.wait(1.0);
    assert_eq!(crowd.progress().seconds, seconds);
}

#[test]
fn dead_worker_is_replaced_and_its_tiles_repeated() {
    let mut crowd = Crowd::at_work(3, 8);
    crowd.desks[1].clear();
    crowd.scheduler.note_death(1, "killed", crowd.now);
    crowd.obey();
    crowd.work_off();
    let progress = crowd.progress();
    assert!(progress.finished);
    assert_eq!((progress.restarted, progress.failed_tiles), (1, 0));
    assert_eq!(
        crowd.done.iter().collect::<HashSet<_>>().len(),
        3 * tracer::tile::tiles(256, 192, crate::job::TILE).len()
    );
}

#[test]
fn hanging_worker_is_replaced() {
    let mut crowd = Crowd::at_work(2, 6);
    crowd.hanging.insert(1);
    crowd.work_off();
    assert!(!crowd.progress().finished);
    crowd.wait(TILE_LIMIT - 1.0);
    assert_eq!(crowd.progress().restarted, 0);
    crowd.wait(2.0);
    crowd.work_off();
    let progress = crowd.progress();
    assert!(progress.finished);
    assert_eq!((progress.restarted, progress.failed_tiles), (1, 0));
}

#[test]
fn slow_tiles_get_more_time() {
    fn limit(seconds: f64, failures: u32) -> f64 {
        let mut crowd = Crowd::at_work(1, 3);
        let Some(Job::Tile(order)) = crowd.desks[0].pop_front() else {
            panic!("no tile");
        };
        crowd
            .scheduler
            .take_tile(0, order, &STATS, seconds, crowd.now);
        let run = crowd.scheduler.run.as_mut().unwrap();
        let last = 11; // of the coarse pass
        for _ in 0..failures {
            run.fail(last);
        }
        run.limit(last)
    }
    assert_eq!(limit(1e-3, 0), TILE_LIMIT);
    assert_eq!(limit(1e-3, 2), TILE_LIMIT * RETRY * RETRY);
    assert_eq!(limit(3.0, 0), SLACK * 3.0);
    assert_eq!(limit(100.0, 0), LONGEST_LIMIT);
}

#[test]
fn fatal_tile_is_given_up_and_reported() {
    let tiles = tracer::tile::tiles(256, 192, crate::job::TILE);
    for workers in [1, 4] {
        let mut crowd = Crowd::new(workers);
        crowd.start(1); // the first picture has the number 1
        for pass in [Pass::Full, Pass::Smooth] {
            let tile = tiles[2];
            crowd.deadly.insert(Order {
                generation: 1,
                tile,
                pass,
            });
        }
        crowd.work_off();
        let progress = crowd.progress();
        assert!(progress.finished);
        assert_eq!(progress.failed_tiles, 1);
        // A worker may have taken the tile for the next pass before it was given up in this one.
        assert!(
            (3..=6).contains(&progress.restarted),
            "{}",
            progress.restarted
        );
        assert!(progress.error.unwrap().contains("deadly"));
    }
}

#[test]
fn attempts_are_limited() {
    // Every tile kills.
    let mut crowd = Crowd::new(2);
    crowd.start(1);
    let tiles = tracer::tile::tiles(256, 192, crate::job::TILE);
    for &tile in &tiles {
        for pass in [Pass::Coarse, Pass::Full, Pass::Smooth] {
            crowd.deadly.insert(Order {
                generation: 1,
                tile,
                pass,
            });
        }
    }
    crowd.work_off();
    let progress = crowd.progress();
    assert!(progress.error.is_some() && progress.pass.is_none());
    assert!(crowd.restarts < 100);

    // No worker starts.
    let mut scheduler = Scheduler::new(2);
    scheduler.launch(0.0);
    scheduler.start(plan(1), 0.0);
    let mut restarts = 0;
    loop {
        let commands = scheduler.commands();
        if commands.is_empty() {
            break;
        }
        for command in commands {
            if let Command::Restart(i) = command {
                restarts += 1;
                scheduler.note_death(i, "no such file", 0.0);
            }
        }
    }
    assert_eq!(restarts, 2 * ATTEMPTS);
    let progress = scheduler.progress(0.0);
    assert_eq!(progress.workers, 0);
    assert!(progress.error.unwrap().contains("no such file"));

    // No worker can prepare the scene.
    let mut scheduler = Scheduler::new(1);
    scheduler.launch(0.0);
    scheduler.start(plan(1), 0.0);
    for _ in 0..ATTEMPTS {
        scheduler.note_start(0, 0.0);
        scheduler.note_death(0, "too big", 0.0);
    }
    let progress = scheduler.progress(0.0);
    assert!(progress.error.unwrap().contains("too big"));
    assert!(progress.pass.is_none());
    // The next picture is tried all the same.
    scheduler.commands();
    scheduler.start(plan(2), 0.0);
    assert!(scheduler.commands().contains(&Command::Restart(0)));
    assert_eq!(scheduler.progress(0.0).error, None);
}

#[test]
fn pictures_wait_until_workers_can_be_started() {
    let mut scheduler = Scheduler::new(1);
    scheduler.start(plan(1), 0.0);
    assert!(scheduler.commands().is_empty());
    scheduler.launch(1.0);
    assert_eq!(scheduler.commands(), [Command::Restart(0)]);
    scheduler.note_start(0, 1.1);
    assert_eq!(scheduler.commands()[0], Command::Begin(0));
}
