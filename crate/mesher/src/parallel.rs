//! A map over a slice by several threads, with the same result for any number of them.

use crate::options::{MeshError, Progress};

/// Items between two reports: each of them takes some ten evaluations.
const BATCH: usize = 1024;

/// Items between two reports that take some hundred evaluations each.
pub const LARGE: usize = 128;

/// The same as [`map`], with reports of the last progress in between, so that a long computation
/// can be cancelled.
///
/// # Errors
/// If the caller cancels.
pub fn map_told<T: Sync, R: Send>(
    threads: usize,
    items: &[T],
    progress: &mut Progress<'_>,
    f: impl Fn(&T) -> R + Sync,
) -> Result<Vec<R>, MeshError> {
    map_by(BATCH, threads, items, progress, f)
}

/// The same, with a report after so many items.
///
/// # Errors
/// If the caller cancels.
pub fn map_by<T: Sync, R: Send>(
    batch: usize,
    threads: usize,
    items: &[T],
    progress: &mut Progress<'_>,
    f: impl Fn(&T) -> R + Sync,
) -> Result<Vec<R>, MeshError> {
    let mut results = Vec::with_capacity(items.len());
    for batch in items.chunks(batch) {
        progress.again()?;
        results.extend(map(threads, batch, &f));
    }
    Ok(results)
}

/// Items below which no threads are started.
const FEW: usize = 64;

/// Calls a pure function with each item, on so many threads, and returns the results in the order
/// of the items. With one thread, and always in wasm, none is started.
pub fn map<T: Sync, R: Send>(threads: usize, items: &[T], f: impl Fn(&T) -> R + Sync) -> Vec<R> {
    if threads <= 1 || items.len() < FEW || cfg!(target_arch = "wasm32") {
        return items.iter().map(f).collect();
    }
    // Several chunks a thread, as their costs differ.
    let size = items.len().div_ceil(threads * 8).max(1);
    let chunks: Vec<&[T]> = items.chunks(size).collect();
    let next = std::sync::atomic::AtomicUsize::new(0);
    let work = || {
        let mut done = Vec::new();
        loop {
            let i = next.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
            let Some(chunk) = chunks.get(i) else {
                return done;
            };
            done.push((i, chunk.iter().map(&f).collect::<Vec<R>>()));
        }
    };
    let mut parts = std::thread::scope(|scope| {
        let workers: Vec<_> = (1..threads).map(|_| scope.spawn(work)).collect();
        let mut parts = work();
        for worker in workers {
            match worker.join() {
                Ok(part) => parts.extend(part),
                Err(panic) => std::panic::resume_unwind(panic),
            }
        }
        parts
    });
    parts.sort_by_key(|(i, _)| *i);
    parts.into_iter().flat_map(|(_, part)| part).collect()
}
