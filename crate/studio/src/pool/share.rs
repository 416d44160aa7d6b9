//! Which tiles of a picture each worker should trace.
//!
//! Each gets one part, nearly always a connected one: what lies on a border between two parts both need when the
//! picture is made smooth, so that it has to be sampled twice or sent. The parts are not equally large but take equally long, as far as the coarse pass tells.

use tracer::Tile;

/// For each tile, of which `costs` tells in any unit how long it takes, the number of the worker that should have it. All
/// costs must be positive.
#[must_use]
pub fn shares(tiles: &[Tile], costs: &[f64], workers: usize) -> Vec<usize> {
    let mut owner = vec![0; tiles.len()];
    let mut all: Vec<usize> = (0..tiles.len()).collect();
    halve(tiles, costs, &mut all, 0, workers, &mut owner);
    owner
}

/// Gives some tiles, by their numbers, to the workers from `first` on, so many: the longer side is cut, and so on.
fn halve(
    tiles: &[Tile],
    costs: &[f64],
    some: &mut [usize],
    first: usize,
    workers: usize,
    owner: &mut [usize],
) {
    if workers <= 1 {
        for tile in some {
            owner[*tile] = first;
        }
        return;
    }
    let extent = |place: fn(&Tile) -> u32| {
        let places = || some.iter().map(|tile| place(&tiles[*tile]));
        places().max().unwrap_or(0) - places().min().unwrap_or(0)
    };
    if extent(|tile| tile.x) >= extent(|tile| tile.y) {
        some.sort_by_key(|tile| (tiles[*tile].x, tiles[*tile].y));
    } else {
        some.sort_by_key(|tile| (tiles[*tile].y, tiles[*tile].x));
    }
    let before = workers / 2;
    let whole: f64 = some.iter().map(|tile| costs[*tile]).sum();
    let wanted = whole * before as f64 / workers as f64;
    let mut sum = 0.0;
    // A tile that the cut goes through goes where more of it lies.
    let in_the_first = |tile: &&usize| {
        let middle = sum + 0.5 * costs[**tile];
        sum += costs[**tile];
        middle < wanted
    };
    let cut = some.iter().take_while(in_the_first).count();
    let (left, right) = some.split_at_mut(cut);
    halve(tiles, costs, left, first, before, owner);
    halve(tiles, costs, right, first + before, workers - before, owner);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tiles of which another of the same worker lies on one of the four sides, and those without one.
    fn neighbours(tiles: &[Tile], owner: &[usize]) -> (usize, usize) {
        let mut count = (0, 0);
        for (tile, worker) in tiles.iter().zip(owner) {
            let beside = tiles.iter().zip(owner).any(|(other, by)| {
                by == worker && tile.x.abs_diff(other.x) + tile.y.abs_diff(other.y) == 64
            });
            if beside {
                count.0 += 1;
            } else {
                count.1 += 1;
            }
        }
        count
    }

    #[test]
    fn parts_take_equally_long_and_no_tile_is_alone() {
        let tiles = tracer::tile::tiles(512, 384, 64);
        // What takes long lies on a diagonal, at one end more of it.
        let cost = |tile: &Tile| {
            let near = tile.x.abs_diff(tile.y) < 100;
            1.0 + if near {
                20.0 + f64::from(tile.x) * 0.05
            } else {
                0.0
            }
        };
        let costs: Vec<f64> = tiles.iter().map(cost).collect();
        let dearest = costs.iter().copied().fold(0.0, f64::max);
        for workers in [1, 2, 3, 4, 7, 16] {
            let owner = shares(&tiles, &costs, workers);
            let of = |worker| -> f64 {
                let mine = owner.iter().zip(&costs).filter(|(by, _)| **by == worker);
                mine.map(|(_, cost)| cost).sum()
            };
            let mean = costs.iter().sum::<f64>() / workers as f64;
            for worker in 0..workers {
                // Half a tile at each of the cuts that make a part.
                let cuts = f64::from(workers.next_power_of_two().ilog2());
                let apart = (of(worker) - mean).abs();
                assert!(
                    apart <= 0.5 * dearest * cuts,
                    "{workers}: {apart} of {mean}"
                );
            }
            let (beside, alone) = neighbours(&tiles, &owner);
            assert!(workers > 4 || alone == 0, "{workers}: {alone} of {beside}");
        }
    }

    #[test]
    fn more_workers_than_tiles_leave_some_without() {
        let tiles = tracer::tile::tiles(128, 64, 64);
        let owner = shares(&tiles, &[1.0, 1.0], 16);
        assert_eq!(owner.len(), 2);
        assert!(owner.iter().all(|worker| *worker < 16) && owner[0] != owner[1]);
        assert_eq!(shares(&[], &[], 3), [0; 0]);
    }
}
