//! The pool of threads, with real pictures.

use super::*;
use std::collections::HashMap;
use std::time::{Duration, Instant};

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
