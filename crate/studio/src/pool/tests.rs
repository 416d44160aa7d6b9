//! The pool of threads, with real pictures.

use super::core::{Core, Workers};
use super::*;
use std::collections::HashMap;
use std::time::{Duration, Instant};
use worker::message::unpack;
use worker::{Answer, Engine, Request, Step};

fn finish(pool: &mut Pool) -> Vec<TileDone> {
    let deadline = Instant::now() + Duration::from_secs(120);
    let mut done = Vec::new();
    loop {
        done.extend(pool.poll());
        let progress = pool.progress();
        if progress.finished {
            return done;
        }
        assert!(Instant::now() < deadline, "{progress:?}");
        std::thread::sleep(Duration::from_millis(1));
    }
}

fn scene() -> Scene {
    let mut scene = Scene::default();
    scene.settings.samples = 2;
    scene
}

#[test]
fn a_picture_comes_complete_and_a_new_one_replaces_it() {
    let mut pool = Pool::new(|| {});
    let scene = scene();
    let job = |generation| Job {
        scene: &scene,
        size: [100, 70],
        generation,
        kind: Kind::Colours,
        small: false,
    };
    pool.start(job(1));
    pool.start(job(2));
    let done = finish(&mut pool);
    assert!(done.iter().all(|tile| tile.generation == 2));
    let mut covered: HashMap<Pass, u32> = HashMap::new();
    for tile in &done {
        *covered.entry(tile.pass).or_default() += tile.tile.width * tile.tile.height;
        assert_eq!(
            tile.pixels.len(),
            (tile.tile.width * tile.tile.height * 4) as usize
        );
    }
    for pass in [Pass::Coarse, Pass::Full, Pass::Smooth] {
        assert_eq!(covered[&pass], 100 * 70, "{pass:?}");
    }
    assert_eq!(pool.progress().restarted, 0);
}

#[test]
fn a_killed_worker_is_missed_and_the_picture_still_completes() {
    let mut pool = Pool::new(|| {});
    assert!(!pool.kill_worker(MAX_WORKERS + 1));
    assert!(pool.kill_worker(0));
    let scene = scene();
    let job = Job {
        scene: &scene,
        size: [64, 64],
        generation: 1,
        kind: Kind::Colours,
        small: false,
    };
    pool.start(job);
    // It takes the time limit of starting or preparing to notice; a new picture is quicker, as a
    // worker that does not take note of it is replaced soon.
    std::thread::sleep(Duration::from_millis(20));
    pool.poll();
    pool.start(job);
    finish(&mut pool);
}

/// Workers that do a step when they are told to.
struct Desks(Vec<Engine>);

impl Workers for Desks {
    fn restart(&mut self, index: usize) -> Result<(), String> {
        self.0[index] = Engine::default();
        Ok(())
    }

    fn end(&mut self, _: usize) {}

    fn send(&mut self, index: usize, request: &[u8]) {
        self.0[index].accept(unpack(request).unwrap());
    }
}

/// Notes whether they are asked to tell what they sample.
struct Asked(Option<bool>);

impl Workers for Asked {
    fn restart(&mut self, _: usize) -> Result<(), String> {
        Ok(())
    }

    fn end(&mut self, _: usize) {}

    fn send(&mut self, _: usize, request: &[u8]) {
        if let Ok(Request::Begin { shared, .. }) = unpack(request) {
            self.0 = Some(shared);
        }
    }
}

/// Traces a picture with so many workers that take turns, each of which may tell others what it sampled. The first one fails
/// in the middle if that is wanted. Gives the picture's last pixels, tile by tile, and the rays.
fn taking_turns(
    scene: &Scene,
    workers: usize,
    tells: bool,
    fails: bool,
) -> (HashMap<Tile, Vec<u8>>, u64) {
    let engines = (0..workers).map(|_| Engine::default()).collect();
    let mut core = Core::new(workers, Desks(engines));
    core.launch(0.0);
    let job = Job {
        scene,
        size: [300, 260],
        generation: 1,
        kind: Kind::Colours,
        small: false,
    };
    core.start(job, 0.0);
    for index in 0..workers {
        core.answers(index, vec![Answer::Started], 0.0);
    }
    let (mut now, mut rays, mut fails) = (0.0, 0, fails);
    while !core.progress(now).finished {
        for index in 0..workers {
            now += 1e-4;
            let time = std::cell::Cell::new(0.0);
            let clock = || time.replace(time.get() + 1e-3);
            let Step::Answer(mut answer) = core.workers.0[index].step(&|| false, &clock) else {
                continue;
            };
            if let Answer::Traced {
                stats,
                known,
                order,
                ..
            } = &mut answer
            {
                rays += stats.primary_rays;
                known.take_if(|_| !tells);
                if fails && index == 0 && order.pass == Pass::Smooth {
                    fails = false;
                    core.answers(0, vec![Answer::Failed("on purpose".into())], now);
                    core.answers(0, vec![Answer::Started], now);
                    continue;
                }
            }
            core.answers(index, vec![answer], now);
        }
        assert!(now < 100.0, "endless");
    }
    let smooth = core.take().into_iter();
    let smooth = smooth.filter(|done| done.pass == Pass::Smooth);
    (smooth.map(|done| (done.tile, done.pixels)).collect(), rays)
}

#[test]
fn several_workers_hardly_take_more_samples_than_one() {
    // Most of the edges are on one side.
    let text = "surface flesh diffuse Coral, blobbiness -2\n\
        sphere flesh 0.5 <-0.9 0.3 0>\nsphere flesh 0.4 <-0.8 -0.6 0>";
    let file = rats::File {
        name: "main.rat".into(),
        text: text.into(),
    };
    let compiled = rats::compile(&rats::Project { files: vec![file] });
    assert_eq!(compiled.diagnostics, []);
    let mut scene = compiled.scene;
    scene.settings.samples = 3;
    let (pixels, rays) = taking_turns(&scene, 1, true, false);
    for workers in [2, 3, 7] {
        let more = |tells| {
            let (same, its) = taking_turns(&scene, workers, tells, false);
            assert!(same == pixels, "{workers}");
            its - rays
        };
        // Who is at a tile before its neighbour's samples come takes them again.
        let (told, untold) = (more(true), more(false));
        assert!(2 * told < untold, "{workers}: {told} {untold}");
        let (same, its) = taking_turns(&scene, workers, true, true);
        assert!(same == pixels, "{workers}, one of which fails");
        // The one in its place is told what that one knew.
        assert!(its - rays <= told + 4096, "{workers}: {its} {rays} {told}");
    }
}

#[test]
fn workers_tell_only_what_others_can_use() {
    let mut scene = scene();
    let mut shared = |workers, change: fn(&mut Scene, &mut Job<'_>)| {
        scene.settings.samples = 2;
        let mut job = Job {
            scene: &Scene::default(),
            size: [300, 260],
            generation: 1,
            kind: Kind::Colours,
            small: false,
        };
        change(&mut scene, &mut job);
        let mut core = Core::new(workers, Asked(None));
        core.launch(0.0);
        core.start(
            Job {
                scene: &scene,
                ..job
            },
            0.0,
        );
        core.answers(0, vec![Answer::Started], 0.0);
        core.workers.0.expect("it was begun")
    };
    assert!(shared(2, |_, _| {}));
    assert!(!shared(1, |_, _| {}));
    assert!(!shared(2, |scene, _| scene.settings.samples = 1));
    assert!(!shared(2, |_, job| job.kind = Kind::Errors));
    assert!(!shared(2, |_, job| job.small = true));
    assert!(!shared(2, |_, job| job.size = [64, 64 * 321]));
    // Whatever fits a screen.
    for aspect in 1..=16 {
        let aspect = f64::from(aspect);
        let high = (crate::size::FIT_PIXELS / aspect).sqrt();
        let tiles = |side: f64| (side as usize).div_ceil(TILE as usize);
        assert!(
            tiles(high) * tiles(aspect * high) <= worker::engine::KEPT,
            "{aspect}"
        );
    }
}
