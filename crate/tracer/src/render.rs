//! A whole picture at once, on several threads.
use crate::tile::{Pass, tiles};
use crate::{Picture, Stats};
use scene::Scene;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Side of the tiles handed to the threads.
const TILE: u32 = 64;

/// Renders a scene with several threads and returns RGBA bytes (rows from the top).
///
/// `progress` is called from any thread after each tile with the share done, 0 … 1.
#[must_use]
pub fn render(
    scene: &Scene,
    size: [u32; 2],
    threads: usize,
    pass: Pass,
    progress: &(dyn Fn(f64) + Sync),
) -> (Vec<u8>, Stats) {
    render_picture(&Picture::new(scene, size), threads, pass, progress)
}

/// The same of a picture that is made ready already.
#[must_use]
pub fn render_picture(
    picture: &Picture,
    threads: usize,
    pass: Pass,
    progress: &(dyn Fn(f64) + Sync),
) -> (Vec<u8>, Stats) {
    let [width, height] = picture.size;
    let tiles = tiles(width, height, TILE);
    let next = AtomicUsize::new(0);
    let done = AtomicUsize::new(0);
    let whole = Mutex::new((
        vec![0u8; 4 * width as usize * height as usize],
        Stats::default(),
    ));
    let work = || {
        let mut stats = Stats::default();
        while let Some(&tile) = tiles.get(next.fetch_add(1, Ordering::Relaxed)) {
            let Some(pixels) = picture.trace(tile, pass, &|| false, &mut stats) else {
                continue;
            };
            let row = 4 * tile.width as usize;
            {
                let mut whole = whole.lock().unwrap_or_else(|e| e.into_inner());
                for (y, line) in (tile.y..).zip(pixels.chunks_exact(row)) {
                    let at = 4 * (y as usize * width as usize + tile.x as usize);
                    whole.0[at..at + row].copy_from_slice(line);
                }
            }
            let done = done.fetch_add(1, Ordering::Relaxed) + 1;
            progress(done as f64 / tiles.len() as f64);
        }
        let mut whole = whole.lock().unwrap_or_else(|e| e.into_inner());
        whole.1 += stats;
    };
    std::thread::scope(|scope| {
        for _ in 1..threads.max(1) {
            scope.spawn(work);
        }
        work();
    });
    whole.into_inner().unwrap_or_else(|e| e.into_inner())
}

impl std::ops::AddAssign for Stats {
    fn add_assign(&mut self, other: Self) {
        self.primary_rays += other.primary_rays;
        self.shadow_rays += other.shadow_rays;
        self.field_evaluations += other.field_evaluations;
    }
}
