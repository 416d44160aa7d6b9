//! First samples shared between workers: which were reported, and which worker has which.
//!
//! The smooth pass of a tile needs the first samples of the tile and of its neighbours' edges.
//! Samples that a worker has not taken itself are sent with its order, or as soon as another worker
//! reports them, so that few are taken twice.

use tracer::{Known, Pass, Tile, around};
use worker::Order;

/// The samples reported for the present picture.
#[derive(Debug, Default)]
pub struct SharedSamples {
    /// Whether samples are shared for this picture.
    shared: bool,
    /// The picture's width and height, pixels.
    size: [u32; 2],
    reported: Vec<Reported>,
    /// Smooth-pass tiles being traced: worker and tile.
    orders: Vec<(usize, Tile)>,
}

/// The samples of a tile.
#[derive(Debug)]
struct Reported {
    known: Known,
    /// Workers that have all of them.
    holders: Vec<usize>,
}

impl SharedSamples {
    /// Starts a new picture, of which no samples are known.
    pub fn begin(&mut self, size: [u32; 2], shared: bool) {
        *self = Self {
            shared,
            size,
            ..Self::default()
        };
    }

    /// Takes the samples that a worker reports with a finished tile, and returns the parts that
    /// other workers wait for. Ignores reports that a sound worker would not send.
    pub fn receive(&mut self, worker: usize, order: &Order, known: Known) -> Vec<(usize, Known)> {
        let tile = known.tile();
        let sound = order.pass == Pass::Full && order.tile == tile && known.is_of(self.size);
        if !self.shared || !sound {
            return Vec::new();
        }
        let mut holders = vec![worker];
        for &(other, ordered) in &self.orders {
            if ordered == tile && !holders.contains(&other) {
                holders.push(other);
            }
        }
        let mut news: Vec<_> = holders[1..]
            .iter()
            .map(|&holder| (holder, known.clone()))
            .collect();
        for &(other, ordered) in &self.orders {
            if !holders.contains(&other) {
                let part = known.part(around(ordered, self.size));
                news.extend(part.map(|part| (other, part)));
            }
        }
        match self
            .reported
            .iter_mut()
            .find(|reported| reported.known.tile() == tile)
        {
            Some(reported) => reported.holders.extend(holders),
            None => self.reported.push(Reported { known, holders }),
        }
        news
    }

    /// Forgets a worker that was ended, and with it the samples it held.
    pub fn forget_worker(&mut self, worker: usize) {
        for reported in &mut self.reported {
            reported.holders.retain(|other| *other != worker);
        }
        self.orders.retain(|(other, _)| *other != worker);
    }

    /// Notes that a worker traces the smooth pass of a tile, and returns the samples it needs and
    /// does not have.
    pub fn assign(&mut self, worker: usize, tile: Tile) -> Vec<Known> {
        if !self.shared {
            return Vec::new();
        }
        self.orders.push((worker, tile));
        let wanted = around(tile, self.size);
        let mut missing = Vec::new();
        for reported in &mut self.reported {
            if reported.holders.contains(&worker) {
                continue;
            }
            missing.extend(reported.known.part(wanted));
            if reported.known.tile() == tile {
                reported.holders.push(worker);
            }
        }
        missing
    }

    /// Whether no samples are kept and no worker waits for any.
    #[cfg(test)]
    pub fn is_empty(&self) -> bool {
        self.reported.is_empty() && self.orders.is_empty()
    }

    /// Returns the number of tiles whose smooth pass is being traced.
    #[cfg(test)]
    pub fn waiting(&self) -> usize {
        self.orders.len()
    }

    /// Notes that a worker has finished the smooth pass of a tile.
    pub fn finish(&mut self, worker: usize, tile: Tile) {
        self.orders.retain(|order| *order != (worker, tile));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use scene::Scene;
    use tracer::{Pass, Picture, Stats};

    const SIZE: [u32; 2] = [192, 100];

    /// Returns the tiles of a picture from left to right, with their samples.
    fn samples() -> Vec<(Tile, Known)> {
        let mut scene = Scene::default();
        scene.settings.samples = 2;
        let picture = Picture::new(&scene, SIZE);
        let mut cache = picture.cache(100);
        let mut tiles = tracer::tiles(SIZE[0], SIZE[1], 64);
        tiles.sort_by_key(|tile| (tile.x, tile.y));
        let samples = tiles.into_iter().map(|tile| {
            let mut stats = Stats::default();
            let _ = picture.trace_with(tile, Pass::Full, &mut cache, &|| false, &mut stats);
            (tile, cache.tell(tile).expect("it was sampled"))
        });
        samples.collect()
    }

    fn full(tile: Tile) -> Order {
        Order {
            generation: 1,
            tile,
            pass: Pass::Full,
        }
    }

    fn places(known: &[Known]) -> Vec<[u32; 4]> {
        let tiles = known.iter().map(Known::tile);
        let places = tiles.map(|tile| [tile.x, tile.y, tile.width, tile.height]);
        let mut places: Vec<_> = places.collect();
        places.sort_unstable();
        places
    }

    #[test]
    fn worker_receives_missing_samples_of_its_tile_and_adjacent_edges() {
        let known = samples();
        let mut shared_samples = SharedSamples::default();
        shared_samples.begin(SIZE, true);
        // Worker 0 has the left column, worker 1 the others.
        for (tile, known) in &known {
            let news = shared_samples.receive(usize::from(tile.x > 0), &full(*tile), known.clone());
            assert!(news.is_empty(), "no worker waits for samples");
        }
        let [upper, lower, middle, below, ..] = [0, 1, 2, 3, 4, 5].map(|i| known[i].0);
        assert_eq!((upper.x, middle.x), (0, 64));
        // Packets are 4×2 pixels.
        assert_eq!(
            places(&shared_samples.assign(0, upper)),
            [[64, 0, 4, 64], [64, 64, 4, 2]]
        );
        assert_eq!(
            places(&shared_samples.assign(1, middle)),
            [[60, 0, 4, 64], [60, 64, 4, 2]]
        );
        // A worker that takes over a tile is sent all of it, once.
        assert_eq!(
            places(&shared_samples.assign(0, middle)),
            [
                [64, 0, 64, 64],
                [64, 64, 64, 2],
                [128, 0, 4, 64],
                [128, 64, 4, 2]
            ]
        );
        assert_eq!(places(&shared_samples.assign(0, lower)), [[64, 64, 4, 36]]);
        // A replaced worker is sent everything again.
        let before = shared_samples.assign(1, below);
        shared_samples.forget_worker(0);
        assert_eq!(shared_samples.assign(1, below), before);
        assert_eq!(places(&shared_samples.assign(0, middle)).len(), 6);
        shared_samples.begin(SIZE, true);
        assert!(shared_samples.assign(0, middle).is_empty());
    }

    #[test]
    fn invalid_reports_are_ignored() {
        let known = samples();
        let (tile, told) = &known[0];
        let accepts = |shared: bool, size, order: Order| {
            let mut shared_samples = SharedSamples::default();
            shared_samples.begin(size, shared);
            shared_samples.receive(0, &order, told.clone());
            assert_eq!(shared_samples.orders, []);
            !shared_samples.is_empty()
        };
        assert!(accepts(true, SIZE, full(*tile)));
        assert!(!accepts(false, SIZE, full(*tile)));
        // The wrong picture size, the wrong tile, the wrong pass.
        assert!(!accepts(true, [32, 32], full(*tile)));
        assert!(!accepts(true, SIZE, full(known[1].0)));
        let coarse = Order {
            pass: Pass::Coarse,
            ..full(*tile)
        };
        assert!(!accepts(true, SIZE, coarse));
        let mut shared_samples = SharedSamples::default();
        shared_samples.begin(SIZE, false);
        assert!(shared_samples.assign(0, *tile).is_empty() && shared_samples.is_empty());
    }

    #[test]
    fn samples_reported_after_an_order_are_forwarded() {
        let known = samples();
        let [upper, lower, middle] = [0, 1, 2].map(|i| known[i].0);
        let tell = |shared_samples: &mut SharedSamples, worker, tile: usize| {
            let (tile, known) = &known[tile];
            let news = shared_samples.receive(worker, &full(*tile), known.clone());
            let (to, news): (Vec<_>, Vec<_>) = news.into_iter().unzip();
            (to, places(&news))
        };
        let mut shared_samples = SharedSamples::default();
        shared_samples.begin(SIZE, true);
        assert!(shared_samples.assign(0, upper).is_empty());
        assert_eq!(tell(&mut shared_samples, 0, 1), (vec![], vec![]));
        assert_eq!(
            tell(&mut shared_samples, 1, 2),
            (vec![0], vec![[64, 0, 4, 64]])
        );
        // All of the tile that worker 0 was given.
        assert_eq!(
            tell(&mut shared_samples, 1, 0),
            (vec![0], vec![[0, 0, 64, 64]])
        );
        let strips = [[64, 0, 4, 64]];
        assert_eq!(places(&shared_samples.assign(0, lower)), [[64, 62, 4, 2]]);
        assert_eq!(places(&shared_samples.assign(0, upper)), strips);
        // Another worker repeats a tile.
        assert_eq!(
            tell(&mut shared_samples, 2, 2),
            (
                vec![0; 3],
                vec![[64, 0, 4, 64], [64, 0, 4, 64], [64, 62, 4, 2]]
            )
        );
        assert!(!places(&shared_samples.assign(2, middle)).contains(&[64, 0, 64, 64]));
        shared_samples.finish(0, upper);
        shared_samples.forget_worker(2);
        assert_eq!(
            tell(&mut shared_samples, 1, 2),
            (vec![0], vec![[64, 62, 4, 2]])
        );
        shared_samples.finish(0, lower);
        assert_eq!(tell(&mut shared_samples, 1, 2), (vec![], vec![]));
    }
}
