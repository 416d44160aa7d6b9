//! Partition of a picture's tiles among the workers.
//!
//! Each worker gets one part, nearly always a connected one: samples on a border between two parts
//! are needed by both workers in the smooth pass and must be taken twice or sent. Parts differ in
//! area but take about equally long, as far as the coarse pass predicts.

use tracer::Tile;

/// Returns for each tile the number of the worker that should trace it. `costs` are the tiles'
/// times in any unit, all positive.
#[must_use]
pub fn partition(tiles: &[Tile], costs: &[f64], workers: usize) -> Vec<usize> {
    let mut owner = vec![0; tiles.len()];
    let mut all: Vec<usize> = (0..tiles.len()).collect();
    halve(tiles, costs, &mut all, 0, workers, &mut owner);
    owner
}

/// Assigns the tiles `some` to `workers` workers from `first` on, by cutting the longer side
/// recursively.
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
    let (mut low, mut high) = ([u32::MAX; 2], [0; 2]);
    for tile in &*some {
        let Tile { x, y, .. } = tiles[*tile];
        low = [low[0].min(x), low[1].min(y)];
        high = [high[0].max(x), high[1].max(y)];
    }
    let is_wide = high[0].saturating_sub(low[0]) >= high[1].saturating_sub(low[1]);
    field::heap_sort(some, |a, b| {
        let [a, b] = [a, b].map(|tile| {
            let Tile { x, y, .. } = tiles[*tile];
            if is_wide { (x, y) } else { (y, x) }
        });
        a < b
    });
    let before = workers / 2;
    let whole: f64 = some.iter().map(|tile| costs[*tile]).sum();
    let wanted = whole * before as f64 / workers as f64;
    let (mut sum, mut cut) = (0.0, 0);
    // A tile on the cut goes to the side that has more of it.
    while let Some(tile) = some.get(cut)
        && sum + 0.5 * costs[*tile] < wanted
    {
        sum += costs[*tile];
        cut += 1;
    }
    let (left, right) = some.split_at_mut(cut);
    halve(tiles, costs, left, first, before, owner);
    halve(tiles, costs, right, first + before, workers - before, owner);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the number of tiles with a neighbour of the same worker on one of the four sides,
    /// and the number of those without.
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
    fn parts_have_equal_cost_and_are_connected() {
        let tiles = tracer::tile::tiles(512, 384, 64);
        // Expensive tiles lie on a diagonal and get more expensive along it.
        let costs = tiles.iter().map(|tile| {
            if tile.x.abs_diff(tile.y) < 100 {
                21.0 + f64::from(tile.x) * 0.05
            } else {
                1.0
            }
        });
        let costs: Vec<f64> = costs.collect();
        let dearest = costs.iter().copied().fold(0.0, f64::max);
        for workers in [1, 2, 3, 4, 7, 16] {
            let owner = partition(&tiles, &costs, workers);
            let mean = costs.iter().sum::<f64>() / workers as f64;
            for worker in 0..workers {
                let own = owner.iter().zip(&costs).filter(|(by, _)| **by == worker);
                let own: f64 = own.map(|(_, cost)| cost).sum();
                // Half a tile at each of the cuts that make a part.
                let cuts = f64::from(workers.next_power_of_two().ilog2());
                let apart = (own - mean).abs();
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
    fn more_workers_than_tiles() {
        let tiles = tracer::tile::tiles(128, 64, 64);
        let owner = partition(&tiles, &[1.0, 1.0], 16);
        assert_eq!(owner.len(), 2);
        assert!(owner.iter().all(|worker| *worker < 16) && owner[0] != owner[1]);
        assert_eq!(partition(&[], &[], 3), [0; 0]);
    }
}
