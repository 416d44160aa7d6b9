//! The first samples that workers have told, and who knows which.
//!
//! A worker that makes a tile smooth needs the first samples of all of it and of its neighbours' edges. Those that it has
//! not taken itself are sent with the order, or as soon as they are told, so that few are taken twice.

use tracer::{Known, Pass, Tile, around};
use worker::Order;

/// What was told of the present picture.
#[derive(Debug, Default)]
pub struct Hearsay {
    /// Whether workers are to hear of each other's samples at all.
    shared: bool,
    /// The picture's width and height, pixels.
    size: [u32; 2],
    told: Vec<Told>,
    /// Which worker has which tile to make smooth.
    orders: Vec<(usize, Tile)>,
}

/// The samples of a tile.
#[derive(Debug)]
struct Told {
    known: Known,
    /// Which workers have all of them.
    to: Vec<usize>,
}

impl Hearsay {
    /// Of a new picture nothing is known.
    pub fn begin(&mut self, size: [u32; 2], shared: bool) {
        *self = Self {
            shared,
            size,
            ..Self::default()
        };
    }

    /// A worker tells the samples of a tile that it had to trace. Gives what of it others wait for. What a worker that is well
    /// would not tell is not listened to.
    pub fn hear(&mut self, worker: usize, order: &Order, known: Known) -> Vec<(usize, Known)> {
        let tile = known.tile();
        let sound = order.pass == Pass::Full && order.tile == tile && known.is_of(self.size);
        if !self.shared || !sound {
            return Vec::new();
        }
        let mut to = vec![worker];
        for &(other, ordered) in &self.orders {
            if ordered == tile && !to.contains(&other) {
                to.push(other);
            }
        }
        let mut news: Vec<_> = to[1..].iter().map(|&to| (to, known.clone())).collect();
        for &(other, ordered) in &self.orders {
            if !to.contains(&other) {
                let part = known.part(around(ordered, self.size));
                news.extend(part.map(|part| (other, part)));
            }
        }
        match self.told.iter_mut().find(|told| told.known.tile() == tile) {
            Some(told) => told.to.extend(to),
            None => self.told.push(Told { known, to }),
        }
        news
    }

    /// A worker was ended, and with it what it knew.
    pub fn forget(&mut self, worker: usize) {
        for told in &mut self.told {
            told.to.retain(|other| *other != worker);
        }
        self.orders.retain(|(other, _)| *other != worker);
    }

    /// A worker is given a tile to make smooth: what it does not know but should.
    pub fn order(&mut self, worker: usize, tile: Tile) -> Vec<Known> {
        if !self.shared {
            return Vec::new();
        }
        self.orders.push((worker, tile));
        let wanted = around(tile, self.size);
        let mut unknown = Vec::new();
        for told in &mut self.told {
            if told.to.contains(&worker) {
                continue;
            }
            unknown.extend(told.known.part(wanted));
            if told.known.tile() == tile {
                told.to.push(worker);
            }
        }
        unknown
    }

    /// Whether nothing is known, and nobody waits.
    #[cfg(test)]
    pub fn is_empty(&self) -> bool {
        self.told.is_empty() && self.orders.is_empty()
    }

    /// How many tiles are being made smooth.
    #[cfg(test)]
    pub fn waiting(&self) -> usize {
        self.orders.len()
    }

    /// A worker has made a tile smooth.
    pub fn smoothed(&mut self, worker: usize, tile: Tile) {
        self.orders.retain(|order| *order != (worker, tile));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use scene::Scene;
    use tracer::{Pass, Picture, Stats};

    const SIZE: [u32; 2] = [192, 100];

    /// The tiles of a picture, from the left, and what is known of them.
    fn known() -> Vec<(Tile, Known)> {
        let mut scene = Scene::default();
        scene.settings.samples = 2;
        let picture = Picture::new(&scene, SIZE);
        let mut cache = picture.cache(100);
        let mut tiles = tracer::tiles(SIZE[0], SIZE[1], 64);
        tiles.sort_by_key(|tile| (tile.x, tile.y));
        let known = |tile| {
            let mut stats = Stats::default();
            let _ = picture.trace_with(tile, Pass::Full, &mut cache, &|| false, &mut stats);
            (tile, cache.tell(tile).expect("it was sampled"))
        };
        tiles.into_iter().map(known).collect()
    }

    fn full(tile: Tile) -> Order {
        Order {
            generation: 1,
            tile,
            pass: Pass::Full,
        }
    }

    fn places(known: &[Known]) -> Vec<[u32; 4]> {
        let place = |tile: Tile| [tile.x, tile.y, tile.width, tile.height];
        let mut places: Vec<_> = known.iter().map(|known| place(known.tile())).collect();
        places.sort_unstable();
        places
    }

    #[test]
    fn a_worker_hears_of_its_tile_and_the_edges_beside_it_that_it_does_not_know() {
        let known = known();
        let mut hearsay = Hearsay::default();
        hearsay.begin(SIZE, true);
        // The left column is one worker's, the others another's.
        for (tile, known) in &known {
            let news = hearsay.hear(usize::from(tile.x > 0), &full(*tile), known.clone());
            assert!(news.is_empty(), "nobody waits");
        }
        let [upper, lower, middle, below, ..] = [0, 1, 2, 3, 4, 5].map(|i| known[i].0);
        assert_eq!((upper.x, middle.x), (0, 64));
        // Packets are 4×2 pixels.
        assert_eq!(
            places(&hearsay.order(0, upper)),
            [[64, 0, 4, 64], [64, 64, 4, 2]]
        );
        assert_eq!(
            places(&hearsay.order(1, middle)),
            [[60, 0, 4, 64], [60, 64, 4, 2]]
        );
        // Help: all of the tile, once.
        assert_eq!(
            places(&hearsay.order(0, middle)),
            [
                [64, 0, 64, 64],
                [64, 64, 64, 2],
                [128, 0, 4, 64],
                [128, 64, 4, 2]
            ]
        );
        assert_eq!(places(&hearsay.order(0, lower)), [[64, 64, 4, 36]]);
        // What was told is what it would be told again once it was forgotten.
        let before = hearsay.order(1, below);
        hearsay.forget(0);
        assert_eq!(hearsay.order(1, below), before);
        assert_eq!(places(&hearsay.order(0, middle)).len(), 6);
        hearsay.begin(SIZE, true);
        assert!(hearsay.order(0, middle).is_empty());
    }

    #[test]
    fn what_no_well_worker_would_tell_is_not_listened_to() {
        let known = known();
        let (tile, told) = &known[0];
        let hears = |shared: bool, size, order: Order| {
            let mut hearsay = Hearsay::default();
            hearsay.begin(size, shared);
            hearsay.hear(0, &order, told.clone());
            assert_eq!(hearsay.orders, []);
            !hearsay.is_empty()
        };
        assert!(hears(true, SIZE, full(*tile)));
        assert!(!hears(false, SIZE, full(*tile)));
        // Of a picture in which there is no such tile, of another tile, of another pass.
        assert!(!hears(true, [32, 32], full(*tile)));
        assert!(!hears(true, SIZE, full(known[1].0)));
        let coarse = Order {
            pass: Pass::Coarse,
            ..full(*tile)
        };
        assert!(!hears(true, SIZE, coarse));
        let mut hearsay = Hearsay::default();
        hearsay.begin(SIZE, false);
        assert!(hearsay.order(0, *tile).is_empty() && hearsay.is_empty());
    }

    #[test]
    fn a_worker_hears_of_what_is_told_after_its_order() {
        let known = known();
        let [upper, lower, middle] = [0, 1, 2].map(|i| known[i].0);
        let tell = |hearsay: &mut Hearsay, worker, tile: usize| {
            let (tile, known) = &known[tile];
            let news = hearsay.hear(worker, &full(*tile), known.clone());
            let news = news.into_iter();
            let (to, news): (Vec<_>, Vec<_>) = news.unzip();
            (to, places(&news))
        };
        let mut hearsay = Hearsay::default();
        hearsay.begin(SIZE, true);
        assert!(hearsay.order(0, upper).is_empty());
        assert_eq!(tell(&mut hearsay, 0, 1), (vec![], vec![]));
        assert_eq!(tell(&mut hearsay, 1, 2), (vec![0], vec![[64, 0, 4, 64]]));
        // All of the tile that it was given, which it then knows.
        assert_eq!(tell(&mut hearsay, 1, 0), (vec![0], vec![[0, 0, 64, 64]]));
        let strips = [[64, 0, 4, 64]];
        assert_eq!(places(&hearsay.order(0, lower)), [[64, 62, 4, 2]]);
        assert_eq!(places(&hearsay.order(0, upper)), strips);
        // A tile done again by another one.
        assert_eq!(
            tell(&mut hearsay, 2, 2),
            (
                vec![0; 3],
                vec![[64, 0, 4, 64], [64, 0, 4, 64], [64, 62, 4, 2]]
            )
        );
        assert!(!places(&hearsay.order(2, middle)).contains(&[64, 0, 64, 64]));
        hearsay.smoothed(0, upper);
        hearsay.forget(2);
        assert_eq!(tell(&mut hearsay, 1, 2), (vec![0], vec![[64, 62, 4, 2]]));
        hearsay.smoothed(0, lower);
        assert_eq!(tell(&mut hearsay, 1, 2), (vec![], vec![]));
    }
}
