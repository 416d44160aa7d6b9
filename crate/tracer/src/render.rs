//! Rendering of a whole picture on several threads.
use crate::area::Area;
use crate::layout::SQUARE;
use crate::picture::Picture;
use crate::sample_cache::SampleCache;
use crate::stats::Stats;
use crate::tile::{Pass, Tile, tiles};
use crate::workspace::Workspace;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Side in pixels of the parts of a picture whose smooth passes run one after the other; the first
/// samples of one take 100 MB.
const SHEET: u32 = 2048;

/// Renders a picture with several threads and returns RGBA bytes (rows from the top).
///
/// `progress` is called from any thread after each tile with the share done, 0 … 1.
#[must_use]
pub fn render(
    picture: &Picture,
    threads: usize,
    pass: Pass,
    progress: &(dyn Fn(f64) + Sync),
) -> (Vec<u8>, Stats) {
    let sampler = &picture.sampler;
    let [width, height] = sampler.view.size;
    let row = 4 * width as usize;
    let mut rgba = vec![0; row * height as usize];
    let mut show = |tile: Tile, pixels: Vec<u8>| {
        let lines = pixels.chunks_exact(4 * tile.width as usize);
        for (y, line) in (tile.y as usize..).zip(lines) {
            let at = y * row + 4 * tile.x as usize;
            rgba[at..at + line.len()].copy_from_slice(line);
        }
    };
    let smooth = pass == Pass::Smooth && sampler.samples > 1;
    let steps = tiles(width, height, SQUARE).len() * if smooth { 2 } else { 1 };
    let done = AtomicUsize::new(0);
    let step = || progress((done.fetch_add(1, Ordering::Relaxed) + 1) as f64 / steps as f64);
    let mut stats = Stats::default();
    for sheet in tiles(width, height, SHEET) {
        let tiles = parts(sheet);
        if !smooth {
            stats += share_out(
                &tiles,
                threads,
                |tile, work, stats| {
                    let mut none = SampleCache::default();
                    picture.trace_in(tile, pass, &mut none, &|| false, work, stats)
                },
                &mut show,
                &step,
            );
            continue;
        }
        // The first samples of all pixels come first, so that only those at the borders of sheets
        // are traced twice, whatever the number of threads.
        let mut cache = picture.cache(tiles.len());
        let none = SampleCache::default();
        stats += share_out(
            &tiles,
            threads,
            |tile, work, stats| sampler.sample(Area::from(tile), 1, &none, &|| false, work, stats),
            |tile, samples| cache.keep(&samples, Area::from(tile)),
            &step,
        );
        stats += share_out(
            &tiles,
            threads,
            |tile, work, stats| {
                let area = Area::from(tile);
                let around = area.around(sampler.view.size);
                let samples = sampler.sample(around, 1, &cache, &|| false, work, stats)?;
                picture.smooth(area, samples, &|| false, work, stats)
            },
            &mut show,
            &step,
        );
    }
    (rgba, stats)
}

/// Runs a job for each tile on several threads, and consumes the results.
fn share_out<T: Send>(
    tiles: &[Tile],
    threads: usize,
    work: impl Fn(Tile, &mut Workspace, &mut Stats) -> Option<T> + Sync,
    take: impl FnMut(Tile, T) + Send,
    step: &(dyn Fn() + Sync),
) -> Stats {
    let next = AtomicUsize::new(0);
    let whole = Mutex::new((take, Stats::default()));
    let thread = || {
        let (mut space, mut stats) = (Workspace::default(), Stats::default());
        while let Some(&tile) = tiles.get(next.fetch_add(1, Ordering::Relaxed)) {
            if let Some(done) = work(tile, &mut space, &mut stats) {
                let mut whole = whole.lock().unwrap_or_else(|e| e.into_inner());
                (whole.0)(tile, done);
            }
            step();
        }
        whole.lock().unwrap_or_else(|e| e.into_inner()).1 += stats;
    };
    std::thread::scope(|scope| {
        for _ in 1..threads.max(1) {
            scope.spawn(thread);
        }
        thread();
    });
    whole.into_inner().unwrap_or_else(|e| e.into_inner()).1
}

/// Returns the squares of a sheet, those nearest to its centre first.
fn parts(sheet: Tile) -> Vec<Tile> {
    let mut parts = tiles(sheet.width, sheet.height, SQUARE);
    for part in &mut parts {
        part.x += sheet.x;
        part.y += sheet.y;
    }
    parts
}
