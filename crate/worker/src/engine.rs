//! A worker's desk: takes requests at any time, does one step of work when asked.

use crate::{Answer, Kind, Order, Request};
use scene::{Digger, Scene};
use std::collections::VecDeque;
use std::sync::Arc;
use tracer::{Known, Pass, Picture, SampleCache, Stats, Tile};

/// Rows of a tile that are traced in one step, but for the coarse pass, which is quick: between two
/// steps the worker sees what has come in.
const ROWS: u32 = 32;

/// Squares of pixels of which a worker keeps the first samples, 100 kB each: those of a picture
/// that fits a screen (`studio::size::FIT_PIXELS`). Where a worker is given more, it takes some
/// samples twice. In pictures of more squares workers do not hear of each other's, as the page
/// would have to keep them all.
pub const KEPT: usize = 320;
/// Side of those squares, pixels.
const SQUARE: u32 = 64;

/// Makes a scene ready for what is wanted of it, or says why this worker cannot.
pub type Prepare = fn(&Scene, [u32; 2], Kind) -> Result<Prepared, String>;

/// The picture a worker is busy with, and the tiles it still has to trace.
pub struct Engine {
    prepare: Prepare,
    generation: u64,
    /// Whether the generation is new and the page not yet told that we know.
    new: bool,
    /// Set until the scene has been prepared.
    wanted: Option<(Arc<Scene>, [u32; 2], Kind)>,
    /// Whether other workers want to hear of first samples.
    shared: bool,
    prepared: Option<Prepared>,
    /// The last scene's picture, kept for [`Picture::follow`] until the next scene is prepared.
    before: Option<Box<Picture>>,
    /// First samples that others took, at most [`KEPT`], until the scene is prepared.
    learnt: Vec<Known>,
    queue: VecDeque<Order>,
    begun: Option<Begun>,
}

/// A tile of which not all rows are traced.
struct Begun {
    order: Order,
    /// The next row.
    next: u32,
    pixels: Vec<u8>,
    stats: Stats,
    seconds: f64,
}

impl Begun {
    fn new(order: Order) -> Self {
        Self {
            order,
            next: order.tile.y,
            pixels: Vec::new(),
            stats: Stats::default(),
            seconds: 0.0,
        }
    }

    /// The rows that are traced next.
    fn part(&self) -> Tile {
        let tile = self.order.tile;
        let left = tile.y + tile.height - self.next;
        let most = if self.order.pass == Pass::Coarse {
            left
        } else {
            ROWS
        };
        Tile {
            y: self.next,
            height: left.min(most),
            ..tile
        }
    }
}

/// Traces a tile of four bytes a pixel; gives it up when the function, asked now and then, says
/// true.
pub type Tracer = dyn Fn(Tile, &dyn Fn() -> bool) -> Option<Vec<u8>>;

/// A scene made ready for what is wanted of it.
pub enum Prepared {
    /// The picture with the first samples of its pixels, for the tiles that are made smooth.
    Colours(Box<Picture>, SampleCache),
    /// Something else than colours.
    Other(Box<Tracer>),
}

impl Prepared {
    /// Returns a picture without samples.
    #[must_use]
    pub fn colours(picture: Picture) -> Self {
        let cache = picture.cache(KEPT);
        Self::Colours(Box::new(picture), cache)
    }
}

/// Prepares a scene of which convolution surfaces are found in the tracer's own way.
fn prepare(scene: &Scene, size: [u32; 2], kind: Kind) -> Result<Prepared, String> {
    if scene.settings.digger != Digger::Hermite || kind != Kind::Colours {
        return Err(String::from("this worker has no other root finders"));
    }
    Ok(Prepared::colours(Picture::new(scene, size)))
}

impl Default for Engine {
    /// Returns an engine that finds convolution surfaces in the tracer's own way, and refuses other
    /// scenes.
    fn default() -> Self {
        Self::new(prepare)
    }
}

/// Outcome of a step.
#[derive(Debug, PartialEq)]
pub enum Step {
    /// Nothing was to be done.
    Idle,
    /// A part of a tile was traced.
    Part,
    /// A tile was given up.
    Dropped,
    /// Something to send.
    Answer(Answer),
}

impl Engine {
    /// Returns an idle engine.
    #[must_use]
    pub fn new(prepare: Prepare) -> Self {
        Self {
            prepare,
            generation: 0,
            new: false,
            wanted: None,
            shared: false,
            prepared: None,
            before: None,
            learnt: Vec::new(),
            queue: VecDeque::new(),
            begun: None,
        }
    }

    /// Takes a request. This is quick: the work is done by [`Engine::step`].
    pub fn accept(&mut self, request: Request) {
        match request {
            Request::Begin {
                generation,
                mut scene,
                camera,
                size,
                kind,
                shared,
            } => {
                self.forget(generation);
                let across = size.map(|side| u64::from(side.div_ceil(SQUARE)));
                self.shared = shared && across[0] * across[1] <= KEPT as u64;
                if let Some(camera) = camera {
                    Arc::make_mut(&mut scene).camera = camera;
                }
                self.wanted = Some((scene, size, kind));
            }
            Request::Learn { generation, known } => {
                let wanted = self.shared && generation == self.generation;
                match &mut self.prepared {
                    Some(Prepared::Colours(_, cache)) if wanted => {
                        known.iter().for_each(|known| cache.learn(known));
                    }
                    None if wanted => {
                        let size = self.wanted.as_ref().map_or([0; 2], |wanted| wanted.1);
                        let room = KEPT.saturating_sub(self.learnt.len());
                        let sound = known.into_iter().filter(|known| known.is_of(size));
                        self.learnt.extend(sound.take(room));
                    }
                    _ => {}
                }
            }
            Request::Trace(orders) => {
                let generation = self.generation;
                let orders = orders.into_iter();
                self.queue
                    .extend(orders.filter(|order| order.generation == generation));
            }
            Request::Stop { generation } => self.forget(generation),
        }
    }

    /// Whether [`Engine::step`] would find nothing to do.
    #[must_use]
    pub fn is_idle(&self) -> bool {
        !self.new && self.wanted.is_none() && self.begun.is_none() && self.queue.is_empty()
    }

    /// Whether a tile of this pass is traced next.
    #[must_use]
    pub fn goes_on_with(&self, pass: Pass) -> bool {
        let begun = self.begun.as_ref().map(|begun| &begun.order);
        let next = begun.or(self.queue.front());
        next.is_some_and(|order| order.pass == pass)
    }

    /// Takes note of a new picture, prepares it if that was not done yet, or traces the next tile
    /// or some rows of it.
    ///
    /// `stop` is asked while tracing; when it says true the tile is given up. `clock` tells seconds
    /// since some fixed moment.
    pub fn step(&mut self, stop: &dyn Fn() -> bool, clock: &dyn Fn() -> f64) -> Step {
        if std::mem::take(&mut self.new) {
            return Step::Answer(Answer::Noted {
                generation: self.generation,
            });
        }
        if let Some((scene, size, kind)) = self.wanted.take() {
            let mut prepared = match (self.prepare)(&scene, size, kind) {
                Ok(prepared) => prepared,
                Err(reason) => return Step::Answer(Answer::Failed(reason)),
            };
            if let Prepared::Colours(picture, cache) = &mut prepared {
                if let Some(mut before) = self.before.take() {
                    picture.follow(&mut before);
                }
                self.learnt.drain(..).for_each(|known| cache.learn(&known));
            }
            self.prepared = Some(prepared);
            return Step::Answer(Answer::Prepared {
                generation: self.generation,
            });
        }
        let next = self.begun.take();
        let next = next.or_else(|| self.queue.pop_front().map(Begun::new));
        let (Some(prepared), Some(mut tile)) = (&mut self.prepared, next) else {
            // Tiles without a picture cannot come in (`accept` compares generations).
            return Step::Idle;
        };
        let since = clock();
        let (part, pass) = (tile.part(), tile.order.pass);
        let traced = match prepared {
            Prepared::Colours(picture, cache) => {
                picture.trace_with(part, pass, cache, stop, &mut tile.stats)
            }
            Prepared::Other(trace) => trace(part, stop),
        };
        let Some(pixels) = traced else {
            return Step::Dropped;
        };
        tile.pixels.extend(pixels);
        tile.seconds += clock() - since;
        tile.next += part.height;
        if tile.next < tile.order.tile.y + tile.order.tile.height {
            self.begun = Some(tile);
            return Step::Part;
        }
        let known = match prepared {
            Prepared::Colours(_, cache) if self.shared && pass == Pass::Full => {
                cache.tell(tile.order.tile)
            }
            _ => None,
        };
        Step::Answer(Answer::Traced {
            order: tile.order,
            pixels: tile.pixels,
            stats: tile.stats,
            seconds: tile.seconds,
            known,
        })
    }

    fn forget(&mut self, generation: u64) {
        self.generation = generation;
        self.new = true;
        self.wanted = None;
        if let Some(Prepared::Colours(picture, _)) = self.prepared.take()
            && picture.can_be_followed()
        {
            self.before = Some(picture);
        }
        self.learnt.clear();
        self.queue.clear();
        self.begun = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn begin(generation: u64) -> Request {
        Request::Begin {
            generation,
            scene: Arc::default(),
            camera: None,
            size: [8, 8],
            kind: Kind::Colours,
            shared: false,
        }
    }

    fn orders(generation: u64, tiles: &[Tile], pass: Pass) -> Vec<Order> {
        let tiles = tiles.iter();
        tiles
            .map(|&tile| Order {
                generation,
                tile,
                pass,
            })
            .collect()
    }

    fn order(generation: u64) -> Order {
        Order {
            generation,
            tile: Tile {
                x: 0,
                y: 0,
                width: 8,
                height: 8,
            },
            pass: Pass::Full,
        }
    }

    fn step(engine: &mut Engine) -> Step {
        engine.step(&|| false, &|| 0.0)
    }

    #[test]
    fn a_tile_is_traced_once_its_scene_is_prepared() {
        let mut engine = Engine::default();
        assert_eq!(step(&mut engine), Step::Idle);
        engine.accept(begin(1));
        engine.accept(Request::Trace(vec![order(1)]));
        assert_eq!(
            step(&mut engine),
            Step::Answer(Answer::Noted { generation: 1 })
        );
        assert_eq!(
            step(&mut engine),
            Step::Answer(Answer::Prepared { generation: 1 })
        );
        let Step::Answer(Answer::Traced {
            order: done,
            pixels,
            ..
        }) = step(&mut engine)
        else {
            panic!("no tile");
        };
        assert_eq!((done, pixels.len()), (order(1), 8 * 8 * 4));
        assert!(engine.is_idle() && !engine.goes_on_with(Pass::Full));
        engine.accept(Request::Trace(vec![order(1)]));
        assert!(engine.goes_on_with(Pass::Full) && !engine.goes_on_with(Pass::Coarse));
    }

    #[test]
    fn a_high_tile_is_traced_in_parts_and_is_then_the_same() {
        for (pass, parts) in [(Pass::Coarse, 1), (Pass::Full, 3), (Pass::Smooth, 3)] {
            let text = "surface flesh diffuse Coral, blobbiness -2\nsphere flesh 1 <0.2 -0.3 0>";
            let file = rats::File {
                name: "main.rat".into(),
                text: text.into(),
            };
            let compiled = rats::compile(&rats::Project { files: vec![file] });
            assert_eq!(compiled.diagnostics, []);
            let scene = compiled.scene;
            let (size, tile) = ([90, 80], [5, 8, 70, 70]);
            let [x, y, width, height] = tile;
            let tile = Tile {
                x,
                y,
                width,
                height,
            };
            let mut engine = Engine::default();
            engine.accept(Request::Begin {
                generation: 1,
                scene: scene.clone(),
                camera: None,
                size,
                kind: Kind::Colours,
                shared: false,
            });
            engine.accept(Request::Trace(vec![Order {
                generation: 1,
                tile,
                pass,
            }]));
            let (mut taken, mut traced) = (1, None);
            while traced.is_none() {
                assert!(!engine.is_idle());
                match step(&mut engine) {
                    Step::Part => taken += 1,
                    Step::Answer(Answer::Traced { pixels, .. }) => traced = Some(pixels),
                    _ => {}
                }
            }
            assert!(engine.is_idle());
            assert_eq!(taken, parts, "{pass:?}");
            let whole =
                Picture::new(&scene, size).trace(tile, pass, &|| false, &mut Stats::default());
            assert_eq!(traced, whole, "{pass:?}");
        }
    }

    #[test]
    fn smooth_tiles_do_not_depend_on_earlier_tiles_or_pictures() {
        let size = [150, 100];
        let mut engine = Engine::default();
        for (generation, x) in [(1, 0.2), (2, -0.2)] {
            let text =
                format!("surface flesh diffuse Coral, blobbiness -2\nsphere flesh 1 <{x} -0.3 0>");
            let file = rats::File {
                name: "main.rat".into(),
                text,
            };
            let compiled = rats::compile(&rats::Project { files: vec![file] });
            assert_eq!(compiled.diagnostics, []);
            let mut scene = compiled.scene;
            Arc::make_mut(&mut scene).settings.samples = 3;
            let tiles = tracer::tile::tiles(size[0], size[1], 64);
            engine.accept(Request::Begin {
                generation,
                scene: scene.clone(),
                camera: None,
                size,
                kind: Kind::Colours,
                shared: false,
            });
            let both = [Pass::Full, Pass::Smooth].map(|pass| orders(generation, &tiles, pass));
            engine.accept(Request::Trace(both.concat()));
            let (mut rays, mut alone) = (0, Stats::default());
            while !engine.is_idle() {
                let Step::Answer(Answer::Traced {
                    order,
                    pixels,
                    stats,
                    ..
                }) = step(&mut engine)
                else {
                    continue;
                };
                let picture = Picture::new(&scene, size);
                let wanted = picture.trace(order.tile, order.pass, &|| false, &mut alone);
                assert_eq!(Some(pixels), wanted, "{order:?}");
                rays += stats.primary_rays;
            }
            assert!(rays > 15_000 && rays + 15_000 < alone.primary_rays);
        }
    }

    /// Carries orders out; returns the samples told to other workers, the pixels and the rays.
    fn work(engine: &mut Engine, orders: Vec<Order>) -> (Vec<Known>, Vec<Vec<u8>>, u64) {
        engine.accept(Request::Trace(orders));
        let (mut told, mut seen, mut rays) = (Vec::new(), Vec::new(), 0);
        while !engine.is_idle() {
            if let Step::Answer(Answer::Traced {
                pixels,
                stats,
                known,
                ..
            }) = step(engine)
            {
                seen.push(pixels);
                told.extend(known);
                rays += stats.primary_rays;
            }
        }
        (told, seen, rays)
    }

    fn learn(generation: u64, known: &[Known]) -> Request {
        Request::Learn {
            generation,
            known: known.to_vec(),
        }
    }

    /// A ball that is made smooth.
    fn ball() -> Arc<Scene> {
        let text = "surface flesh diffuse Coral, blobbiness -2\nsphere flesh 1 <0.2 -0.3 0>";
        let file = rats::File {
            name: "main.rat".into(),
            text: text.into(),
        };
        let mut scene = rats::compile(&rats::Project { files: vec![file] }).scene;
        Arc::make_mut(&mut scene).settings.samples = 3;
        scene
    }

    #[test]
    fn samples_of_other_workers_are_not_traced_again() {
        let size = [150, 100];
        let tiles = tracer::tile::tiles(size[0], size[1], 64);
        let worker = |shared| {
            let mut engine = Engine::default();
            engine.accept(Request::Begin {
                generation: 1,
                scene: ball(),
                camera: None,
                size,
                kind: Kind::Colours,
                shared,
            });
            engine
        };
        let mut first = worker(true);
        let (told, _, all) = work(&mut first, orders(1, &tiles, Pass::Full));
        assert_eq!((told.len(), all), (tiles.len(), 15_000));
        let (none, smooth, rays) = work(&mut first, orders(1, &tiles, Pass::Smooth));
        assert_eq!(none, []);
        // Before the scene is prepared, as a worker that starts late is told.
        let mut second = worker(true);
        second.accept(learn(1, &told));
        assert_eq!(
            work(&mut second, orders(1, &tiles, Pass::Smooth)),
            (Vec::new(), smooth.clone(), rays)
        );
        // Samples of another picture are ignored.
        let mut third = worker(true);
        third.accept(learn(2, &told));
        let (_, same, alone) = work(&mut third, orders(1, &tiles, Pass::Smooth));
        assert!(same == smooth);
        assert!(alone >= rays + all, "{alone} {rays}");
        // Without sharing, samples are neither reported nor taken.
        let mut fourth = worker(false);
        fourth.accept(learn(1, &told));
        let (none, _, rays) = work(&mut fourth, orders(1, &tiles, Pass::Full));
        assert!(none.is_empty() && rays == all);
        // Nonsense does no harm.
        let mut fifth = worker(true);
        let nonsense = |tile: Tile, bytes: Vec<u8>| -> Known {
            postcard::from_bytes(&postcard::to_allocvec(&(tile, bytes)).unwrap()).unwrap()
        };
        let far = Tile {
            x: u32::MAX - 3,
            ..tiles[0]
        };
        let huge = Tile {
            width: u32::MAX,
            height: u32::MAX,
            ..tiles[0]
        };
        let flat = Tile {
            height: 0,
            ..tiles[0]
        };
        let beyond = Tile { x: 140, ..tiles[0] };
        let large = Tile {
            width: 65,
            height: 1,
            ..tiles[0]
        };
        // Some have as many bytes as there should be, or those of one sample for all.
        let bad = [25, 24, 24 * 64 * 64].map(|bytes| {
            let places = [far, huge, flat, beyond, large];
            places.map(|tile| nonsense(tile, vec![7; bytes]))
        });
        let bad = [&bad.concat()[..], &[nonsense(tiles[0], vec![7; 25])]].concat();
        assert!(bad.iter().all(|known| !known.is_of(size)));
        fifth.accept(learn(1, &bad));
        assert!(fifth.learnt.is_empty());
        let (_, same, again) = work(&mut fifth, orders(1, &tiles, Pass::Smooth));
        assert!(same == smooth && again == alone);
    }

    #[test]
    fn samples_of_an_older_picture_are_forgotten_and_no_more_kept_than_a_picture_has() {
        let size = [150, 100];
        let tiles = tracer::tile::tiles(size[0], size[1], 64);
        let begin = |generation, scene: &Arc<Scene>, size| Request::Begin {
            generation,
            scene: scene.clone(),
            camera: None,
            size,
            kind: Kind::Colours,
            shared: true,
        };
        let mut other = ball();
        Arc::make_mut(&mut other).elements.clear();
        let mut engine = Engine::default();
        engine.accept(begin(1, &ball(), size));
        let (told, ..) = work(&mut engine, orders(1, &tiles, Pass::Full));
        let mut alone = Engine::default();
        alone.accept(begin(2, &other, size));
        let (_, truth, _) = work(&mut alone, orders(2, &tiles, Pass::Smooth));
        // Learnt before the scene was prepared, which then another one took the place of.
        let mut engine = Engine::default();
        engine.accept(begin(1, &ball(), size));
        engine.accept(learn(1, &vec![told[0].clone(); KEPT + 9]));
        assert_eq!(engine.learnt.len(), KEPT);
        engine.accept(begin(2, &other, size));
        assert!(work(&mut engine, orders(2, &tiles, Pass::Smooth)).1 == truth);
        // Without a picture, or with one of more squares, nothing is kept.
        engine.accept(Request::Stop { generation: 3 });
        engine.accept(learn(3, &told[..1]));
        assert!(engine.learnt.is_empty());
        engine.accept(begin(4, &other, [150, 64 * KEPT as u32]));
        engine.accept(learn(4, &told[..1]));
        assert!(engine.learnt.is_empty());
    }

    #[test]
    fn older_pictures_are_dropped_unbegun() {
        let mut engine = Engine::default();
        engine.accept(begin(1));
        engine.accept(Request::Trace(vec![order(1)]));
        engine.accept(begin(2));
        engine.accept(Request::Trace(vec![order(1)]));
        assert_eq!(
            step(&mut engine),
            Step::Answer(Answer::Noted { generation: 2 })
        );
        engine.accept(Request::Stop { generation: 3 });
        assert_eq!(
            step(&mut engine),
            Step::Answer(Answer::Noted { generation: 3 })
        );
        assert_eq!(step(&mut engine), Step::Idle);
    }

    #[test]
    fn scenes_for_other_root_finders_are_refused() {
        let mut scene = Scene::default();
        scene.settings.digger = Digger::Lg;
        for (scene, kind) in [(scene, Kind::Colours), (Scene::default(), Kind::Errors)] {
            let mut engine = Engine::default();
            engine.accept(Request::Begin {
                generation: 1,
                scene: Arc::new(scene),
                camera: None,
                size: [8, 8],
                kind,
                shared: false,
            });
            step(&mut engine);
            let answer = step(&mut engine);
            assert!(
                matches!(answer, Step::Answer(Answer::Failed(_))),
                "{answer:?}"
            );
        }
    }

    #[test]
    fn messages_survive_packing_and_other_bytes_are_refused() {
        let request = begin(7);
        let bytes = postcard::to_allocvec(&request).unwrap();
        assert_eq!(postcard::from_bytes::<Request>(&bytes), Ok(request));
        assert!(postcard::from_bytes::<Request>(&[9, 9, 9]).is_err());
        assert!(postcard::from_bytes::<Request>(&[]).is_err());
    }
}
