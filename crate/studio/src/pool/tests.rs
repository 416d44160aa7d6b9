//! The pool of threads, with real pictures.

use super::core::{Core, Workers};
use super::*;
use std::collections::HashMap;
use std::time::{Duration, Instant};
use worker::message::unpack;
use worker::{Answer, Engine, Step};

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

/// Traces a picture with so many workers that take turns. Gives its pixels after the last pass, tile by tile, and the rays.
fn taking_turns(scene: &Scene, workers: usize) -> (HashMap<Tile, Vec<u8>>, u64) {
    let engines = (0..workers).map(|_| Engine::default()).collect();
    let mut core = Core::new(workers, Desks(engines));
    core.launch(0.0);
    core.start(
        Job {
            scene,
            size: [300, 260],
            generation: 1,
            kind: Kind::Colours,
            small: false,
        },
        0.0,
    );
    for index in 0..workers {
        core.answers(index, vec![Answer::Started], 0.0);
    }
    let (mut now, mut rays) = (0.0, 0);
    while !core.progress(now).finished {
        for index in 0..workers {
            now += 1e-4;
            let clock = std::cell::Cell::new(0.0);
            let clock = || clock.replace(clock.get() + 1e-3);
            if let Step::Answer(answer) = core.workers.0[index].step(&|| false, &clock) {
                if let Answer::Traced { stats, .. } = &answer {
                    rays += stats.primary_rays;
                }
                core.answers(index, vec![answer], now);
            }
        }
        assert!(now < 100.0, "endless");
    }
    let smooth = core.take().into_iter();
    let smooth = smooth.filter(|done| done.pass == Pass::Smooth);
    (smooth.map(|done| (done.tile, done.pixels)).collect(), rays)
}

#[test]
fn several_workers_take_as_many_samples_as_one() {
    // Something is seen everywhere, but most of the edges are on one side.
    let text = "surface flesh diffuse Coral, blobbiness -2\nsurface wall diffuse White\n\
        sphere flesh 0.5 <-0.9 0.3 0>\nsphere flesh 0.4 <-0.8 -0.6 0>\nsphere wall 50 <0 0 -60>";
    let file = rats::File {
        name: "main.rat".into(),
        text: text.into(),
    };
    let compiled = rats::compile(&rats::Project { files: vec![file] });
    assert_eq!(compiled.diagnostics, []);
    let mut scene = compiled.scene;
    scene.settings.samples = 3;
    let (pixels, rays) = taking_turns(&scene, 1);
    for workers in [2, 3, 7] {
        let (same, its) = taking_turns(&scene, workers);
        assert!(same == pixels, "{workers}");
        // Who is at a tile before its neighbour's samples come takes them again. Without telling it would be 4 to 11 % more.
        assert!(its as f64 <= 1.04 * rays as f64, "{workers}: {its} {rays}");
    }
}
