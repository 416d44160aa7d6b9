//! The first samples that workers have told, and who knows which.
//!
//! A worker that makes a tile smooth needs the first samples of all of it and of its neighbours' edges. Those that it has
//! not taken itself are sent with the order, or as soon as they are told, so that none is taken twice.

use tracer::{Known, Tile, around};

/// What was told of the present picture.
#[derive(Debug, Default)]
pub struct Hearsay {
    /// The picture's width and height, pixels.
    size: [u32; 2],
    told: Vec<Told>,
    /// Who has which tile to make smooth.
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
    pub fn begin(&mut self, size: [u32; 2]) {
        self.size = size;
        self.told.clear();
        self.orders.clear();
    }

    /// A worker tells the samples of a tile. Gives what of it others wait for.
    pub fn hear(&mut self, worker: usize, known: Known) -> Vec<(usize, Known)> {
        let tile = known.tile();
        let wanted = |(other, tile): &(usize, Tile)| {
            let part = || known.part(around(*tile, self.size));
            (*other != worker).then(part)?.map(|part| (*other, part))
        };
        let news = self.orders.iter().filter_map(wanted).collect();
        match self.told.iter_mut().find(|told| told.known.tile() == tile) {
            Some(told) => told.to.push(worker),
            None => self.told.push(Told {
                known,
                to: vec![worker],
            }),
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

    /// A worker has made a tile smooth.
    pub fn smoothed(&mut self, worker: usize, tile: Tile) {
        self.orders.retain(|order| *order != (worker, tile));
    }

    /// What a worker that is to make a tile smooth does not know but should. It is taken as told.
    pub fn tell(&mut self, worker: usize, tile: Tile) -> Vec<Known> {
        self.orders.push((worker, tile));
        let wanted = around(tile, self.size);
        let mut unknown = Vec::new();
        for told in self
            .told
            .iter_mut()
            .filter(|told| !told.to.contains(&worker))
        {
            unknown.extend(told.known.part(wanted));
            if told.known.tile() == tile {
                told.to.push(worker);
            }
        }
        unknown
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tracer::{Pass, Picture, Stats};

    const SIZE: [u32; 2] = [192, 100];

    /// The tiles of a picture that shows something everywhere, from the left, and what is known of them.
    fn known() -> Vec<(Tile, Known)> {
        let text = "surface flesh diffuse Coral\nplane flesh <0 0 1> <0 0 -9>";
        let file = rats::File {
            name: "main.rat".into(),
            text: text.into(),
        };
        let mut scene = rats::compile(&rats::Project { files: vec![file] }).scene;
        scene.settings.samples = 2;
        let picture = Picture::new(&scene, SIZE);
        let mut cache = picture.cache(100);
        let mut tiles = tracer::tiles(SIZE[0], SIZE[1], 64);
        tiles.sort_by_key(|tile| (tile.x, tile.y));
        let mut known = |tile| {
            let mut stats = Stats::default();
            let _ = picture.trace_with(tile, Pass::Full, &mut cache, &|| false, &mut stats);
            (tile, cache.tell(tile).expect("it shows something"))
        };
        tiles.into_iter().map(|tile| known(tile)).collect()
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
        hearsay.begin(SIZE);
        // The left column is one worker's, the others another's.
        for (tile, known) in &known {
            hearsay.hear(usize::from(tile.x > 0), known.clone());
        }
        let [upper, lower, middle, below, ..] = [0, 1, 2, 3, 4, 5].map(|i| known[i].0);
        assert_eq!((upper.x, middle.x), (0, 64));
        // Packets are 4×2 pixels.
        assert_eq!(
            places(&hearsay.tell(0, upper)),
            [[64, 0, 4, 64], [64, 64, 4, 2]]
        );
        assert_eq!(
            places(&hearsay.tell(1, middle)),
            [[60, 0, 4, 64], [60, 64, 4, 2]]
        );
        // Help: all of the tile, once.
        assert_eq!(
            places(&hearsay.tell(0, middle)),
            [
                [64, 0, 64, 64],
                [64, 64, 64, 2],
                [128, 0, 4, 64],
                [128, 64, 4, 2]
            ]
        );
        assert_eq!(places(&hearsay.tell(0, lower)), [[64, 64, 4, 36]]);
        // What was told is what it would be told again once it was forgotten.
        let before = hearsay.tell(1, below);
        hearsay.forget(0);
        assert_eq!(hearsay.tell(1, below), before);
        assert_eq!(places(&hearsay.tell(0, middle)).len(), 6);
        hearsay.begin(SIZE);
        assert!(hearsay.tell(0, middle).is_empty());
    }
}
