//! A whole picture at once, on several threads.
use crate::tile::{Pass, Tile, tiles};
use crate::{Picture, Stats};
use scene::Scene;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Sides of the tiles handed to the threads. What is around a tile is sampled with it when a picture is made smooth, so that
/// larger ones are less work; but each thread should have some.
const SIDES: [u32; 3] = [256, 128, 64];
/// So many tiles there should be for each thread but the first.
const TILES: usize = 8;

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
    let tiles = shared_out(width, height, threads);
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

/// The largest tiles of which there are enough for so many threads; else the smallest.
fn shared_out(width: u32, height: u32, threads: usize) -> Vec<Tile> {
    let mut all = Vec::new();
    for side in SIDES {
        all = tiles(width, height, side);
        if all.len() >= TILES * threads.saturating_sub(1) {
            break;
        }
    }
    all
}

impl std::ops::AddAssign for Stats {
    fn add_assign(&mut self, other: Self) {
        self.primary_rays += other.primary_rays;
        self.shadow_rays += other.shadow_rays;
        self.field_evaluations += other.field_evaluations;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg_attr(target_arch = "wasm32", wasm_bindgen_test::wasm_bindgen_test)]
    #[cfg_attr(not(target_arch = "wasm32"), test)]
    fn every_thread_has_tiles() {
        for (threads, count) in [(1, 4), (2, 16), (3, 16), (4, 64), (1000, 64)] {
            assert_eq!(shared_out(512, 512, threads).len(), count, "{threads}");
        }
        assert!(shared_out(0, 9, 2).is_empty());
    }
}
