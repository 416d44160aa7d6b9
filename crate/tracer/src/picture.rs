//! A scene prepared for tracing, in passes and tiles.
use crate::area::{Area, Samples};
use crate::cast::Cast;
use crate::exposure::Exposure;
use crate::layout::{BLOCK, SQUARE};
use crate::map::Map;
use crate::ray::Ray;
use crate::root_finder::RootFinder;
use crate::sample_cache::SampleCache;
use crate::sampler::Sampler;
use crate::shade;
use crate::stats::Stats;
use crate::tile::{Pass, Tile};
use crate::view::View;
use crate::workspace::Workspace;
use crate::world::World;
use field::Implicit;
use glam::{DVec3, Vec3};
use scene::{Scene, Settings};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A point where a ray crosses a surface.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Hit {
    /// Ray parameter (distance, as directions are unit vectors).
    pub t: f64,
    /// The point.
    pub position: DVec3,
    /// Outward unit normal.
    pub normal: DVec3,
    /// The scene's body whose surface it is; `None` for a hard element.
    pub body: Option<u32>,
    /// The scene's element whose surface it is; on a soft surface the one that adds most to the
    /// field there. `None` on the surface of an added function.
    pub element: Option<u32>,
}

impl Hit {
    /// Whether a ray of this direction enters the body or the closed shape here.
    #[must_use]
    pub fn enters(&self, direction: DVec3) -> bool {
        self.normal.dot(direction) < 0.0
    }
}

/// A scene prepared for tracing at one size.
///
/// ```
/// use glam::DVec3;
/// use scene::{Element, Scene, Shape};
/// use tracer::{Pass, Picture, Stats, Tile};
///
/// let mut scene = Scene::default();
/// let center = scene.camera.target;
/// scene.elements.push(Element::new(Shape::sphere(center, 1.0)));
/// let picture = Picture::new(&scene, [8, 8]);
/// let whole = Tile { x: 0, y: 0, width: 8, height: 8 };
/// let rgba = picture.trace(whole, Pass::Full, &|| false, &mut Stats::default());
/// assert_eq!(rgba.expect("nobody asked to stop").len(), 4 * 8 * 8);
/// ```
pub struct Picture {
    pub(crate) sampler: Sampler,
    gamma: f32,
    /// The map of costs, if they are shown instead of colours.
    map: Option<Map>,
    /// Side of the blocks of pixels that one ray is sent for.
    block: u32,
}

impl Picture {
    /// Prepares a scene, whose convolution surfaces are found in the certified way, whatever its
    /// settings say ([`Picture::find_with`]). `size` is the picture's width and height in pixels,
    /// each > 0.
    #[must_use]
    pub fn new(scene: &Scene, size: [u32; 2]) -> Self {
        let size = size.map(|n| n.max(1));
        let settings = scene.settings;
        let world = World::new(scene);
        let view = View::of(scene, &world.unit, size);
        let rich = world.rich.as_ref();
        let mut sampler = Sampler {
            view,
            exposure: Exposure::of(scene, &world.unit, size),
            soft_light: rich.is_some_and(|rich| rich.has_soft_light(&world.lights)),
            world,
            samples: match settings.block {
                ..=1 => settings.samples.clamp(1, Settings::MAX_SAMPLES),
                _ => 1,
            },
            contrast: Vec3::from(settings.contrast),
        };
        sampler.world.soft.pixel = view.pixel();
        Self {
            sampler,
            gamma: settings.gamma,
            map: settings.map.map(Map::new),
            block: settings
                .block
                .clamp(1, Settings::MAX_BLOCK)
                .next_power_of_two(),
        }
    }

    /// Whether [`Picture::follow`] makes the picture of a slightly different scene sooner.
    #[must_use]
    pub fn can_be_followed(&self) -> bool {
        self.sampler.world.soft.has_far_cells()
    }

    /// Moves the far fields of an earlier scene's picture into this one, before it is traced. Where
    /// few elements differ its first tiles are traced sooner; all pixels stay the same.
    pub fn follow(&mut self, before: &mut Self) {
        let soft = &mut self.sampler.world.soft;
        soft.take_over(&mut before.sampler.world.soft);
    }

    /// Adds a body whose surface is that of any implicit function, in the world's coordinates, and
    /// returns its number among the scene's bodies. `finish` holds the finish, an index into
    /// [`Scene::finishes`], of each of the function's elements.
    pub fn add_function(&mut self, function: Arc<dyn Implicit>, finish: Vec<u32>) -> u32 {
        self.sampler.world.add(function, finish)
    }

    /// Lets another root finder find the convolution surfaces from now on, ray by ray. Its hits are
    /// taken as they are, errors and all.
    pub fn find_with(&mut self, finder: &Arc<dyn RootFinder>) {
        self.sampler.world.find_with(finder);
    }

    /// Follows each soft primitive by itself from now on, without groups and without interpolants
    /// that rays share: slower, for comparison.
    pub fn forgo_hierarchy(&mut self) {
        self.sampler.world.soft.precision.shared = 0.0;
    }

    /// Traces one tile and writes RGBA bytes (`4·width·height`, rows from the top, alpha 255).
    ///
    /// Returns `None` soon after `stop`, which is called now and then, has returned true.
    #[must_use]
    pub fn trace(
        &self,
        tile: Tile,
        pass: Pass,
        stop: &dyn Fn() -> bool,
        stats: &mut Stats,
    ) -> Option<Vec<u8>> {
        self.trace_with(tile, pass, &mut SampleCache::default(), stop, stats)
    }

    /// Traces one tile ([`Picture::trace`]) with a cache of this picture's first samples
    /// ([`Picture::cache`]): those that it has are not taken again, others are kept in it. A cache
    /// for another size, or for a tile that reaches beyond the picture, is not used.
    #[must_use]
    pub fn trace_with(
        &self,
        tile: Tile,
        pass: Pass,
        cache: &mut SampleCache,
        stop: &dyn Fn() -> bool,
        stats: &mut Stats,
    ) -> Option<Vec<u8>> {
        let mut work = Workspace::default();
        let (area, size) = (Area::from(tile), self.sampler.view.size);
        if cache.size() != size || area.right > size[0] || area.bottom > size[1] {
            let mut none = SampleCache::default();
            return self.trace_in(tile, pass, &mut none, stop, &mut work, stats);
        }
        self.trace_in(tile, pass, cache, stop, &mut work, stats)
    }

    /// Traces one tile ([`Picture::trace_with`]) in a given working space.
    pub(crate) fn trace_in(
        &self,
        tile: Tile,
        pass: Pass,
        cache: &mut SampleCache,
        stop: &dyn Fn() -> bool,
        work: &mut Workspace,
        stats: &mut Stats,
    ) -> Option<Vec<u8>> {
        let area = Area::from(tile);
        let sampler = &self.sampler;
        if pass == Pass::Smooth && sampler.samples > 1 {
            let samples =
                sampler.sample(area.around(sampler.view.size), 1, cache, stop, work, stats)?;
            cache.keep(&samples, area);
            return self.smooth(area, samples, stop, work, stats);
        }
        let mut pixels = Pixels::new(self, area, stop)?;
        let block = match pass {
            Pass::Coarse => self.block.max(BLOCK),
            _ => self.block,
        };
        if block > 1 {
            let blocks = Area {
                left: area.left / block,
                top: area.top / block,
                right: area.right.div_ceil(block),
                bottom: area.bottom.div_ceil(block),
            };
            let samples = sampler.sample(blocks, block, cache, stop, work, stats)?;
            pixels.show(block, area, &samples);
            return Some(pixels.rgba);
        }
        // Square by square, so that samples need little memory.
        for square in area.blocks([SQUARE; 2]) {
            let part = square.meet(area);
            let samples = sampler.sample(part, 1, cache, stop, work, stats)?;
            cache.keep(&samples, part);
            if sampler.samples > 1 {
                stats.edges += sampler.edges(&samples);
            }
            pixels.show(1, part, &samples);
        }
        Some(pixels.rgba)
    }

    /// Returns a cache for this picture's first samples that keeps at most `room` squares of 64×64
    /// pixels, 100 kB each; none if no pass needs samples of an earlier one.
    #[must_use]
    pub fn cache(&self, room: usize) -> SampleCache {
        let room = if self.sampler.samples > 1 { room } else { 0 };
        SampleCache::new(self.sampler.view.size, room)
    }

    /// Takes more samples where the first ones of an area and its surroundings differ, and writes
    /// the area's RGBA bytes.
    pub(crate) fn smooth(
        &self,
        area: Area,
        mut samples: Samples,
        stop: &dyn Fn() -> bool,
        work: &mut Workspace,
        stats: &mut Stats,
    ) -> Option<Vec<u8>> {
        let packets = area.packets(self.sampler.view.size);
        self.sampler
            .refine(packets, &mut samples, stop, work, stats)?;
        let mut pixels = Pixels::new(self, area, stop)?;
        pixels.show(1, area, &samples);
        Some(pixels.rgba)
    }

    /// Returns all crossings, at t > 0 and in order, of a ray with surfaces, soft and hard, found
    /// exactly: no primitive is cut off, no interpolant shared.
    #[must_use]
    pub fn hits(&self, origin: DVec3, direction: DVec3) -> Vec<Hit> {
        let world = &self.sampler.world;
        let Some(ray) = world.ray(&(origin, direction)) else {
            return Vec::new();
        };
        let crossings = world.crossings(&ray);
        let hits = crossings.iter().map(|cast| self.hit(origin, &ray, cast));
        hits.collect()
    }

    /// Returns the first hit of each ray (origin, direction) at t > 0, with the arithmetic and the
    /// tolerance of pictures. Neighbouring rays of the list make packets: the nearer together they
    /// are, the faster it goes.
    #[must_use]
    pub fn cast(&self, rays: &[(DVec3, DVec3)]) -> Vec<Option<Hit>> {
        let world = &self.sampler.world;
        let found = world.cast(rays).into_iter().zip(rays);
        found
            .map(|(cast, given)| Some(self.hit(given.0, &world.ray(given)?, &cast?)))
            .collect()
    }

    /// Converts a crossing to the world's coordinates.
    fn hit(&self, origin: DVec3, ray: &Ray, cast: &Cast) -> Hit {
        let world = &self.sampler.world;
        let t = world.unit.length(cast.t);
        let (body, element) = world.owner(cast, ray);
        Hit {
            t,
            position: origin + ray.direction * t,
            normal: cast.normal.try_normalize().unwrap_or(-ray.direction),
            body,
            element,
        }
    }

    /// Returns the largest distance that a hit at `t` is meant to have from the true surface, which
    /// is also the greatest thickness, along the ray, of parts that may go unseen (for exceptions
    /// see the limits of this crate): the smaller of 10⁻⁴ of the scene's size and a fifth of the
    /// width of a pixel there; but never less than 10⁻⁶ of the scene's size.
    #[must_use]
    pub fn tolerance(&self, t: f64) -> f64 {
        // The unit scene is between 2 and 4 large.
        let scene = self.sampler.world.unit.length(2.0);
        (0.2 * self.sampler.view.pixel() * t).clamp(1e-6 * scene, 1e-4 * scene)
    }
}

/// The bytes of a tile.
struct Pixels<'a> {
    picture: &'a Picture,
    area: Area,
    /// Cost that is white in a map of costs.
    dearest: f32,
    rgba: Vec<u8>,
}

impl<'a> Pixels<'a> {
    /// Returns white bytes; `None` if `stop` returned true.
    fn new(picture: &'a Picture, area: Area, stop: &dyn Fn() -> bool) -> Option<Self> {
        let [width, height] = [area.right - area.left, area.bottom - area.top];
        let dearest = match &picture.map {
            Some(map) => map.dearest(&picture.sampler, stop)?,
            None => 1.0,
        };
        Some(Self {
            picture,
            area,
            dearest,
            rgba: vec![255; 4 * width as usize * height as usize],
        })
    }

    /// Shows samples in a part of the tile, each in a block of `block` pixels across and down, a
    /// power of 2.
    fn show(&mut self, block: u32, part: Area, samples: &Samples) {
        let level = block.ilog2();
        let width = (self.area.right - self.area.left) as usize;
        // Neighbours often have the same colour: the background's.
        let mut last = (Vec3::NAN, [0; 3]);
        for y in part.top..part.bottom {
            let row = (y - self.area.top) as usize * width;
            let start = row + (part.left - self.area.left) as usize;
            let end = row + (part.right - self.area.left) as usize;
            let bytes = self.rgba[4 * start..4 * end].chunks_exact_mut(4);
            let columns = (part.left..part.right).map(|x| x >> level);
            for (sample, pixel) in samples.row(y >> level, columns).zip(bytes) {
                let (colour, gamma) = match &self.picture.map {
                    Some(map) => (map.grey(sample, self.dearest), 1.0),
                    None => (sample.colour, self.picture.gamma),
                };
                if colour != last.0 {
                    last = (colour, shade::bytes(colour, gamma));
                }
                pixel[..3].copy_from_slice(&last.1);
            }
        }
    }
}
