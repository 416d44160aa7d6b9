//! The pool of threads, with real pictures.

use crate::Pool;
use crate::core::Core;
use crate::job::{MAX_WORKERS, PictureJob, TILE, TileDone};
use crate::workers::{Manager, Workers};
use scene::{Digger, Scene, Settings};
use std::collections::HashMap;
use std::sync::Arc;
use std::time::{Duration, Instant};
use tracer::{Pass, Tile};
use worker::{Answer, Engine, Kind, Request, Step};

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

fn scene() -> Arc<Scene> {
    let mut scene = Scene::default();
    scene.settings.samples = 2;
    Arc::new(scene)
}

#[test]
fn picture_is_complete_and_replaced_by_a_new_one() {
    let mut pool = Pool::new(|| {});
    let scene = scene();
    let job = |generation| PictureJob {
        scene: &scene,
        camera: None,
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
fn picture_completes_without_a_killed_worker() {
    let mut pool = Pool::new(|| {});
    assert!(!pool.kill_worker(MAX_WORKERS + 1));
    assert!(pool.kill_worker(0));
    let scene = scene();
    let job = PictureJob {
        scene: &scene,
        camera: None,
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

#[test]
fn root_finders_for_comparison_are_there_where_they_are_asked_for() {
    let mut pool = Pool::new(|| {});
    let mut scene = Scene::clone(&scene());
    scene.flesh.push(scene::Flesh {
        blobbiness: Some(1.0),
        ..Default::default()
    });
    for x in [-0.6, 0.6] {
        let center = [x, 0.0, 0.0].into();
        scene.elements.push(scene::Element {
            flesh: Some(0),
            ..scene::Element::new(scene::Shape::sphere(center, 0.5))
        });
    }
    let mut means = Vec::new();
    for (generation, digger) in [(1, Digger::Hermite), (2, Digger::Spans(2))] {
        scene.settings.digger = digger;
        let shared = Arc::new(scene.clone());
        let tiles = [Kind::Colours, Kind::Errors].map(|kind| {
            let job = PictureJob {
                scene: &shared,
                camera: None,
                size: [40, 32],
                generation,
                kind,
                small: true,
            };
            assert_eq!(job.compares(), (generation, kind) != (1, Kind::Colours));
            pool.start(job);
            finish(&mut pool).pop().expect("a tile")
        });
        let [TileDone { tile, pixels, .. }, errors] = tiles;
        let stats = &mut tracer::Stats::default();
        let picture = digger::picture(&scene, [40, 32]);
        assert!(picture.trace(tile, Pass::Smooth, &|| false, stats) == Some(pixels));
        let pixels = digger::errors::unpack(&errors.pixels);
        let distances = pixels.into_iter().filter_map(|pixel| match pixel {
            digger::errors::Pixel::Off(distance) => Some(f64::from(distance)),
            _ => None,
        });
        let distances: Vec<f64> = distances.collect();
        means.push(distances.iter().sum::<f64>() / distances.len() as f64);
    }
    assert!(means[0] < 1e-4 && means[1] > 1e-3, "{means:?}");
}

/// Lets an engine do one step, by a clock that gains a millisecond whenever it is read.
fn step(engine: &mut Engine) -> Step {
    let time = std::cell::Cell::new(0.0);
    engine.step(&|| false, &|| time.replace(time.get() + 1e-3))
}

/// Workers that run single steps on request.
struct Desks(Vec<Engine>);

impl Workers for Desks {
    fn restart(&mut self, index: usize) -> Result<(), String> {
        self.0[index] = Engine::default();
        Ok(())
    }

    fn end(&mut self, _: usize) {}

    fn send(&mut self, index: usize, request: &[u8]) {
        self.0[index].accept(postcard::from_bytes(request).unwrap());
    }
}

/// Records whether workers are asked to report their samples.
struct Asked(Option<bool>);

impl Workers for Asked {
    fn restart(&mut self, _: usize) -> Result<(), String> {
        Ok(())
    }

    fn end(&mut self, _: usize) {}

    fn send(&mut self, _: usize, request: &[u8]) {
        if let Ok(Request::Begin { shared, .. }) = postcard::from_bytes(request) {
            self.0 = Some(shared);
        }
    }
}

/// Traces a picture with a number of workers that take turns, which share their samples if `tells`.
/// With `fails` the first one fails in the middle. Returns the picture's last pixels, tile by tile,
/// and the number of rays.
fn take_turns(
    scene: &Arc<Scene>,
    workers: usize,
    tells: bool,
    fails: bool,
) -> (HashMap<Tile, Vec<u8>>, u64) {
    let engines = (0..workers).map(|_| Engine::default()).collect();
    let mut core = Core::new(workers, Desks(engines));
    core.note_program(Ok(()), 0.0);
    let job = PictureJob {
        scene,
        camera: None,
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
            let Step::Answer(mut answer) = step(&mut core.workers.0[index]) else {
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
fn several_workers_share_samples() {
    // Most of the edges are on one side.
    let scene = balls(["<-0.9 0.3 0>", "<-0.8 -0.6 0>"]);
    let (pixels, rays) = take_turns(&scene, 1, true, false);
    for workers in [2, 3, 7] {
        // A worker that starts a tile before its neighbour's samples arrive takes them again.
        let [told, untold] = [true, false].map(|tells| {
            let (same, its) = take_turns(&scene, workers, tells, false);
            assert!(same == pixels, "{workers}");
            its - rays
        });
        assert!(2 * told < untold, "{workers}: {told} {untold}");
        let (same, its) = take_turns(&scene, workers, true, true);
        assert!(same == pixels, "{workers}, one of which fails");
        // The worker in its place is sent the samples that the failed one had.
        assert!(its - rays <= told + 4096, "{workers}: {its} {rays} {told}");
    }
}

/// Returns a scene of two balls.
fn balls(at: [&str; 2]) -> Arc<Scene> {
    let [a, b] = at;
    let text = format!(
        "surface flesh diffuse Coral, blobbiness -2\nsphere flesh 0.5 {a}\nsphere flesh 0.4 {b}"
    );
    let file = rats::File {
        name: "main.rat".into(),
        text,
    };
    let compiled = rats::compile(&rats::Project { files: vec![file] });
    assert_eq!(compiled.diagnostics, []);
    let mut scene = compiled.scene;
    Arc::make_mut(&mut scene).settings.samples = 3;
    scene
}

/// Pictures of two scenes follow each other while answers to the one before are on their way: each
/// must show its own scene, and no samples may be left when it is over, however it ends.
#[test]
fn picture_shows_nothing_of_an_older_one() {
    let size = [260, 200];
    // One is full of edges, also where squares meet.
    let mut scenes = [
        ["<-0.9 0.3 0>", "<-0.8 -0.6 0>"],
        ["<0.5 0.3 0>", "<0.2 -0.6 0>"],
    ]
    .map(balls);
    for i in 0..24 {
        let mut ball = scenes[1].elements[0].clone();
        let place = [f64::from(i % 6) - 2.5, f64::from(i / 6) - 1.5];
        ball.shape = scene::Shape::sphere([0.7 * place[0], 0.7 * place[1], 0.0].into(), 0.2);
        Arc::make_mut(&mut scenes[1]).elements.push(ball);
    }
    let truth = scenes.each_ref().map(|scene| {
        let picture = tracer::Picture::new(scene, size);
        let mut stats = tracer::Stats::default();
        let tiles = tracer::tiles(size[0], size[1], TILE).into_iter();
        let tiles = tiles.map(|tile| {
            let pixels = picture.trace(tile, Pass::Smooth, &|| false, &mut stats);
            (tile, pixels.unwrap())
        });
        tiles.collect::<HashMap<_, _>>()
    });
    // Answers that were lost, pictures of which something was known when they were broken off,
    // tiles that were waited for.
    let (mut lost, mut told, mut waiting) = (0, 0, 0);
    for workers in [2, 3, 5] {
        let engines = (0..workers).map(|_| Engine::default()).collect();
        let mut core = Core::new(workers, Desks(engines));
        core.note_program(Ok(()), 0.0);
        let mut late: Vec<Vec<Answer>> = vec![Vec::new(); workers];
        let mut now = 0.0;
        for picture in 0..60 {
            // Every other one is broken off, each later than the one before, and the first one
            // cancelled.
            let breaks = (picture % 2 == 0).then_some(2 * picture);
            let which = picture % 2;
            let job = PictureJob {
                scene: &scenes[which],
                camera: None,
                size,
                generation: picture as u64,
                kind: Kind::Colours,
                small: false,
            };
            core.start(job, now);
            if picture == 0 {
                for index in 0..workers {
                    core.answers(index, vec![Answer::Started], now);
                }
                core.cancel(now);
                assert!(core.shared_samples.is_empty());
            }
            let mut steps = 0;
            while !core.progress(now).finished && breaks.is_none_or(|breaks| steps < breaks) {
                steps += 1;
                for (index, late) in late.iter_mut().enumerate() {
                    now += 1e-4;
                    // Its earlier answers arrive now.
                    for answer in late.drain(..) {
                        let present = core.scheduler.number();
                        let stale = matches!(&answer, Answer::Traced { order, known, .. }
                            if order.generation != present && known.is_some());
                        let nothing = core.shared_samples.is_empty();
                        core.answers(index, vec![answer], now);
                        if stale && nothing {
                            lost += 1;
                            assert!(core.shared_samples.is_empty(), "a stale answer was taken");
                        }
                    }
                    if let Step::Answer(answer) = step(&mut core.workers.0[index]) {
                        late.push(answer);
                    }
                }
                waiting = waiting.max(core.shared_samples.waiting());
                assert!(now < 100.0, "endless");
            }
            told += usize::from(!core.shared_samples.is_empty());
            let own = core.take().into_iter();
            let own = own.filter(|done| done.generation == picture as u64);
            let smooth = own.filter(|done| done.pass == Pass::Smooth);
            let seen: HashMap<_, _> = smooth.map(|done| (done.tile, done.pixels)).collect();
            if breaks.is_none() {
                assert!(seen == truth[which], "{workers} workers, picture {picture}");
                assert!(core.shared_samples.is_empty());
            }
        }
    }
    assert!(lost > 5 && told > 5, "{lost} {told}");
    // Of 20 tiles.
    assert!((2..18).contains(&waiting), "{waiting}");
}

/// Workers that are started one by one, none of which ever makes a certain tile smooth.
struct Stuck(Desks, Vec<usize>, Tile);

impl Workers for Stuck {
    fn restart(&mut self, index: usize) -> Result<(), String> {
        self.1.push(index);
        self.0.restart(index)
    }

    fn end(&mut self, index: usize) {
        self.0.end(index);
    }

    fn send(&mut self, index: usize, request: &[u8]) {
        let mut request = postcard::from_bytes(request).unwrap();
        if let Request::Trace(orders) = &mut request {
            orders.retain(|order| order.pass != Pass::Smooth || order.tile != self.2);
        }
        self.0.0[index].accept(request);
    }
}

/// Samples must be dropped too if a picture ends because no worker answers.
#[test]
fn samples_of_a_failed_picture_are_dropped() {
    let scene = balls(["<-0.9 0.3 0>", "<-0.8 -0.6 0>"]);
    let desks = Desks((0..2).map(|_| Engine::default()).collect());
    let tile = tracer::tiles(260, 200, TILE)[0];
    let mut core = Core::new(2, Stuck(desks, Vec::new(), tile));
    core.note_program(Ok(()), 0.0);
    let job = PictureJob {
        scene: &scene,
        camera: None,
        size: [260, 200],
        generation: 1,
        kind: Kind::Colours,
        small: false,
    };
    core.start(job, 0.0);
    let (mut now, mut heard) = (0.0, false);
    while !core.progress(now).finished {
        now += 1e-3;
        for index in std::mem::take(&mut core.workers.1) {
            core.answers(index, vec![Answer::Started], now);
        }
        for index in 0..2 {
            if let Step::Answer(answer) = step(&mut core.workers.0.0[index]) {
                core.answers(index, vec![answer], now);
            }
        }
        heard |= !core.shared_samples.is_empty();
        if core.workers.0.0.iter().all(Engine::is_idle) {
            now += 30.0;
            core.tick(now);
        }
        assert!(now < 1e5, "endless");
    }
    assert!(heard && core.shared_samples.is_empty());
}

#[test]
fn samples_are_shared_only_where_useful() {
    let mut scene = scene();
    let mut shared = |workers, change: fn(&mut Settings, &mut PictureJob<'_>)| {
        let plain = Arc::default();
        let settings = &mut Arc::make_mut(&mut scene).settings;
        settings.samples = 2;
        let mut job = PictureJob {
            scene: &plain,
            camera: None,
            size: [300, 260],
            generation: 1,
            kind: Kind::Colours,
            small: false,
        };
        change(settings, &mut job);
        let mut core = Core::new(workers, Asked(None));
        core.note_program(Ok(()), 0.0);
        core.start(
            PictureJob {
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
    assert!(!shared(2, |settings, _| settings.samples = 1));
    assert!(!shared(2, |_, job| job.kind = Kind::Errors));
    assert!(!shared(2, |_, job| job.small = true));
    assert!(!shared(2, |_, job| job.size = [64, 64 * 321]));
}
