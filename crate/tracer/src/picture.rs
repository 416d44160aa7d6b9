//! A scene made ready for tracing.
use crate::area::{Area, Samples};
use crate::beam::Beam;
use crate::beams::Beams;
use crate::digger::{self, Digger};
use crate::hard::Crossing;
use crate::map::Map;
use crate::nearby::Nearby;
use crate::packet::{Near, Seen, Workspace};
use crate::ray::Ray;
use crate::sample::Sample;
use crate::sample_cache::SampleCache;
use crate::shade::{self, Finish};
use crate::slabs::Slabs;
use crate::soft::{PACKET, Soft};
use crate::solids::Solids;
use crate::square::{Lumps, Square};
use crate::unit::Unit;
use crate::{Pass, Tile};
use field::Real;
use glam::{DVec3, Vec3};
use scene::{Light, Projection, Scene, Settings};
use serde::{Deserialize, Serialize};
use wide::f32x8;

/// Counts of work done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Stats {
    /// Rays from the eye.
    pub primary_rays: u64,
    /// Rays towards lights.
    pub shadow_rays: u64,
    /// Evaluations of one primitive's field at one point.
    pub field_evaluations: u64,
    /// Pixels of a full pass that differ from the next one on the right or below, if there is a smooth pass: it takes more
    /// rays for about twice as many.
    pub edges: u64,
}

impl std::ops::AddAssign for Stats {
    fn add_assign(&mut self, other: Self) {
        self.primary_rays += other.primary_rays;
        self.shadow_rays += other.shadow_rays;
        self.field_evaluations += other.field_evaluations;
        self.edges += other.edges;
    }
}

/// A point where a ray crosses a surface.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Hit {
    /// Ray parameter (distance, as directions are unit vectors).
    pub t: f64,
    /// The point.
    pub position: DVec3,
    /// Outward unit normal.
    pub normal: DVec3,
}

/// A scene made ready for tracing at one size.
pub struct Picture {
    pub(crate) size: [u32; 2],
    pub(crate) unit: Unit,
    pub(crate) projection: Projection,
    pub(crate) soft: Soft,
    pub(crate) solids: Solids,
    pub(crate) finishes: Vec<Finish>,
    pub(crate) lights: Vec<Light>,
    pub(crate) background: Vec3,
    pub(crate) samples: u32,
    pub(crate) contrast: Vec3,
    gamma: f32,
    /// What finds the soft surface, if it is not the picture's own certified digger.
    pub(crate) digger: Option<Box<dyn Digger>>,
    /// Whether and how costs are shown instead of colours.
    map: Option<Map>,
}

/// Side of the squares of pixels that share a beam. Squares and packets are laid out from the picture's
/// corner, whatever the tiles, and a packet is always traced whole: so a pixel's value does not depend on
/// how the picture is cut into tiles.
pub(crate) const SQUARE: u32 = 64;
/// Side of the blocks of pixels that have one ray at first.
pub(crate) const BLOCK: u32 = 8;
/// Rays a block apart hit so far from each other that a beam from all their hits to a light would be wide all along: only hits
/// within this part of the packet's width share one. Measured: the coarse pass takes 0.6 of the time that it took with 1 for
/// hermite-crab and coral-crab, 0.8 for generators; 1.1 for shell-3.
const SPARSE: f64 = 0.25;
/// Pixels of a packet.
pub(crate) const PACKET_SIZE: [u32; 2] = [4, 2];

impl Picture {
    /// Prepares a scene. `size` is the picture's width and height in pixels, each > 0.
    #[must_use]
    pub fn new(scene: &Scene, size: [u32; 2]) -> Self {
        let (unit, scene) = Unit::fit(scene);
        let size = size.map(|n| n.max(1));
        let projection = scene.camera.projection(size[0], size[1]);
        let solids = Solids::new(&scene);
        let finishes = scene.materials.iter().map(Finish::of).collect();
        let (lights, settings) = (scene.lights.clone(), scene.settings);
        let background = Vec3::from(scene.background);
        let mut soft = Soft::new(scene);
        soft.pixel = 2.0 * projection.half_width / f64::from(size[0]);
        Self {
            size,
            unit,
            projection,
            soft,
            solids,
            finishes,
            lights,
            background,
            samples: settings.samples.clamp(1, Settings::MAX_SAMPLES),
            contrast: Vec3::from(settings.contrast),
            gamma: settings.gamma,
            digger: match settings.digger {
                scene::Digger::Hermite => None,
                other => Some(digger::of(other)),
            },
            map: settings.map.map(Map::new),
        }
    }

    /// From now on each soft primitive is followed by itself wherever it counts, without groups and without
    /// interpolants that rays share: slower, for comparison.
    pub fn forgo_hierarchy(&mut self) {
        self.soft.precision.shared = 0.0;
    }

    /// Traces one tile and writes RGBA bytes (`4·width·height`, rows from the top, alpha 255).
    ///
    /// `stop` is asked now and then; when it says true the tile is given up and `None` comes back.
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

    /// The same with a cache of this picture's first samples ([`Picture::cache`]): those that it has are not taken again,
    /// others are kept in it. Nothing is done with one for another size, or for a tile that reaches beyond the picture.
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
        let area = Area::from(tile);
        if cache.size() != self.size || area.right > self.size[0] || area.bottom > self.size[1] {
            let mut none = SampleCache::default();
            return self.trace_in(tile, pass, &mut none, stop, &mut work, stats);
        }
        self.trace_in(tile, pass, cache, stop, &mut work, stats)
    }

    /// The same in a given working space.
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
        if pass == Pass::Smooth && self.samples > 1 {
            let samples = self.sample(area.around(self.size), 1, cache, stop, work, stats)?;
            cache.keep(&samples, area);
            return self.smooth(area, samples, stop, work, stats);
        }
        let mut pixels = Pixels::new(self, area, stop)?;
        if pass == Pass::Coarse {
            let blocks = Area {
                left: area.left / BLOCK,
                top: area.top / BLOCK,
                right: area.right.div_ceil(BLOCK),
                bottom: area.bottom.div_ceil(BLOCK),
            };
            let samples = self.sample(blocks, BLOCK, cache, stop, work, stats)?;
            pixels.show::<BLOCK>(area, &samples);
            return Some(pixels.rgba);
        }
        // Square by square, so that samples need little memory.
        for square in area.blocks([SQUARE; 2]) {
            let part = square.meet(area);
            let samples = self.sample(part, 1, cache, stop, work, stats)?;
            cache.keep(&samples, part);
            if self.samples > 1 {
                stats.edges += self.edges(&samples);
            }
            pixels.show::<1>(part, &samples);
        }
        Some(pixels.rgba)
    }

    /// A cache for this picture's first samples that keeps at most `room` squares of 64×64 pixels, 100 kB
    /// each; none if no pass needs samples of an earlier one.
    #[must_use]
    pub fn cache(&self, room: usize) -> SampleCache {
        SampleCache::new(self.size, if self.samples > 1 { room } else { 0 })
    }

    /// Takes more samples where the first ones, of an area and of what is around it, differ, and writes the area's RGBA bytes.
    pub(crate) fn smooth(
        &self,
        area: Area,
        mut samples: Samples,
        stop: &dyn Fn() -> bool,
        work: &mut Workspace,
        stats: &mut Stats,
    ) -> Option<Vec<u8>> {
        self.refine(area.packets(self.size), &mut samples, stop, work, stats)?;
        let mut pixels = Pixels::new(self, area, stop)?;
        pixels.show::<1>(area, &samples);
        Some(pixels.rgba)
    }

    /// All crossings of a ray with surfaces, soft and hard, in order of t > 0.
    #[must_use]
    pub fn hits(&self, origin: DVec3, direction: DVec3) -> Vec<Hit> {
        let Some(direction) = direction.try_normalize() else {
            return Vec::new();
        };
        let ray = Ray {
            origin: self.unit.map(origin),
            direction,
        };
        if !ray.origin.is_finite() {
            return Vec::new();
        }
        let mut crossings = Vec::new();
        self.solids.all(&ray, &mut crossings);
        for (t, gradient) in self.soft.crossings(&ray) {
            if t > 0.0 {
                crossings.push(Crossing {
                    t,
                    normal: (-gradient).try_normalize().unwrap_or(-direction),
                });
            }
        }
        crossings.sort_by(|a, b| a.t.total_cmp(&b.t));
        crossings
            .iter()
            .map(|c| {
                let t = self.unit.length(c.t);
                Hit {
                    t,
                    position: origin + direction * t,
                    normal: c.normal,
                }
            })
            .collect()
    }

    /// One sample at the centre of each cell of an area, in units of cells of `scale` pixels. The cache, which is of single
    /// pixels, is asked first.
    pub(crate) fn sample(
        &self,
        area: Area,
        scale: u32,
        cache: &SampleCache,
        stop: &dyn Fn() -> bool,
        work: &mut Workspace,
        stats: &mut Stats,
    ) -> Option<Samples> {
        let mut samples = Samples::new(area);
        let side = SQUARE / scale;
        let [columns, rows] = [side / PACKET_SIZE[0], side / PACKET_SIZE[1]];
        let mut seen = Seen::default();
        for block in area.blocks([side; 2]) {
            if stop() {
                return None;
            }
            let known = cache.square(block).filter(|_| scale == 1);
            if known.is_some_and(|known| known.tell_all(block, &mut samples)) {
                continue;
            }
            let mut square = None;
            for (i, j) in (0..rows).flat_map(|j| (0..columns).map(move |i| (i, j))) {
                let cell = |lane: usize| {
                    let lane = lane as u32;
                    (
                        block.left + i * PACKET_SIZE[0] + lane % PACKET_SIZE[0],
                        block.top + j * PACKET_SIZE[1] + lane / PACKET_SIZE[0],
                    )
                };
                let pixels: [(u32, u32); PACKET] = core::array::from_fn(cell);
                let wanted = pixels.iter().filter(|&&(x, y)| area.holds(x, y)).count();
                if wanted == 0 || known.is_some_and(|known| known.tell([i, j], block, &mut samples))
                {
                    continue;
                }
                stats.primary_rays += wanted as u64;
                let square = square
                    .get_or_insert_with(|| self.square(block.times(scale), [columns, rows], work));
                let near = square.near([i, j], [columns, rows], work);
                let nothing = matches!(near, Near::Nothing);
                if self.solids.is_empty() && self.digger.is_none() && nothing {
                    for (x, y) in pixels {
                        samples.set(x, y, self.nothing());
                    }
                    continue;
                }
                // Places in pixels from the square's middle.
                let middle = |c: f64| (c - 0.5 * f64::from(side)) * f64::from(scale);
                let [left, top] = [i * PACKET_SIZE[0], j * PACKET_SIZE[1]].map(f64::from);
                let [wide, high] = PACKET_SIZE.map(|n| 0.5 * f64::from(n));
                let quick = match near {
                    Near::Lumps(near, Some(lens)) if self.solids.is_empty() => {
                        let x = |lane: usize| left + (lane % PACKET_SIZE[0] as usize) as f64 + 0.5;
                        let y = |lane: usize| top + (lane / PACKET_SIZE[0] as usize) as f64 + 0.5;
                        let places = [
                            f32x8::from_lanes(|lane| middle(x(lane))),
                            f32x8::from_lanes(|lane| middle(y(lane))),
                        ];
                        let fan = lens.fan(places, [middle(left + wide), middle(top + high)]);
                        self.lump_packet(lens, &fan, near, &mut seen, work, stats)
                    }
                    _ => None,
                };
                if quick.is_none() {
                    seen.rays = pixels.map(|(x, y)| {
                        let middle = |c: u32| (f64::from(c) + 0.5) * f64::from(scale);
                        self.ray(middle(x), middle(y))
                    });
                    self.packet(near, &mut seen, work, stats);
                }
                if seen.something() {
                    let [first, .., last] = &seen.rays;
                    let across = first.direction.distance(last.direction);
                    let across = if scale > 1 { SPARSE * across } else { across };
                    self.shine(core::slice::from_ref(&seen), across, work, stats);
                    for ((x, y), sample) in pixels.into_iter().zip(&work.samples[0]) {
                        samples.set(x, y, *sample);
                    }
                } else {
                    let nothing = self.nothing();
                    for ((x, y), cost) in pixels.into_iter().zip(seen.costs) {
                        samples.set(x, y, Sample { cost, ..nothing });
                    }
                }
                if stop() {
                    return None;
                }
            }
            if let Some(square) = square {
                square.leave(work, stats);
            }
        }
        Some(samples)
    }

    /// What a ray sees that hits nothing.
    pub(crate) fn nothing(&self) -> Sample {
        Sample {
            colour: shade::clamped(self.background),
            key: 0,
            depth: f32::INFINITY,
            cost: 1.0,
        }
    }

    /// The ray through a point of the picture, in pixels.
    pub(crate) fn ray(&self, x: f64, y: f64) -> Ray {
        Ray {
            origin: self.projection.eye,
            direction: self
                .projection
                .direction(x / f64::from(self.size[0]), y / f64::from(self.size[1])),
        }
    }

    /// What is known of the soft surface in a square of pixels, divided into columns and rows (powers of
    /// two) of packets.
    pub(crate) fn square(&self, area: Area, packets: [u32; 2], work: &mut Workspace) -> Square<'_> {
        if self.soft.is_empty() || self.digger.is_some() {
            return Square::Empty;
        }
        let mut near = Nearby::default();
        let beam = self.beam(area);
        if self.soft.list_lumps(&beam, f64::INFINITY, &mut near) {
            return Square::Lumps(Lumps::new(self, area, packets, &beam, near));
        }
        match self.slabs(area, packets, work) {
            Some(slabs) => Square::Slabs(slabs),
            None => Square::Empty,
        }
    }

    /// The slabs of the beam through a rectangle of pixels, divided into columns and rows (powers of
    /// two) of packets.
    pub(crate) fn slabs(
        &self,
        area: Area,
        packets: [u32; 2],
        work: &mut Workspace,
    ) -> Option<(Slabs<'_>, f64)> {
        if self.soft.is_empty() || self.digger.is_some() {
            return None;
        }
        let levels = packets[0].ilog2() + packets[1].ilog2();
        let beams = move |base: f64| {
            Beams::divided(levels, move |number| {
                self.beam(division(area, packets, number)).from(base)
            })
        };
        self.soft.slabs(
            self.beam(area),
            beams,
            f64::INFINITY,
            &mut work.scratch.spaces,
        )
    }

    /// The beam of all rays through a rectangle of pixels.
    pub(crate) fn beam(&self, area: Area) -> Beam {
        let [l, t, r, b] = [area.left, area.top, area.right, area.bottom].map(f64::from);
        let axis = self.ray(0.5 * (l + r), 0.5 * (t + b));
        // Directions of equal distance from the axis' lie on ellipses or so in the picture: the
        // furthest of a rectangle is at a corner.
        let spread = [(l, t), (r, t), (l, b), (r, b)]
            .map(|(x, y)| self.ray(x, y).direction.distance(axis.direction))
            .into_iter()
            .fold(0.0, f64::max);
        Beam {
            axis,
            radius: 0.0,
            spread: spread * (1.0 + 1e-9),
            ahead: 0.0,
        }
    }
}

/// The bytes of a tile.
struct Pixels<'a> {
    picture: &'a Picture,
    area: Area,
    /// What white stands for in a map of costs.
    dearest: f32,
    rgba: Vec<u8>,
}

impl<'a> Pixels<'a> {
    /// `None` if `stop` gave up.
    fn new(picture: &'a Picture, area: Area, stop: &dyn Fn() -> bool) -> Option<Self> {
        let [width, height] = [area.right - area.left, area.bottom - area.top];
        let dearest = match &picture.map {
            Some(map) => map.dearest(picture, stop)?,
            None => 1.0,
        };
        Some(Self {
            picture,
            area,
            dearest,
            rgba: vec![255; 4 * width as usize * height as usize],
        })
    }

    /// Shows samples in a part of the tile, each in a block of so many pixels across and down.
    fn show<const BLOCK: u32>(&mut self, part: Area, samples: &Samples) {
        let width = (self.area.right - self.area.left) as usize;
        // Neighbours often have the same colour, that of the background.
        let mut last = (Vec3::NAN, [0; 3]);
        for y in part.top..part.bottom {
            let row = (y - self.area.top) as usize * width;
            let start = row + (part.left - self.area.left) as usize;
            let end = row + (part.right - self.area.left) as usize;
            let bytes = self.rgba[4 * start..4 * end].chunks_exact_mut(4);
            let columns = (part.left..part.right).map(|x| x / BLOCK);
            for (sample, pixel) in samples.row(y / BLOCK, columns).zip(bytes) {
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

/// Whether a rectangle of packets is next halved across: as long as it is not taller than wide.
fn halves_across([columns, rows]: [u32; 2]) -> bool {
    columns * PACKET_SIZE[0] >= rows * PACKET_SIZE[1] && columns > 1
}

/// The part of a rectangle, divided into columns and rows of packets, that a number in the binary tree of
/// its divisions stands for: the halves of i are 2i+1 (left or upper) and 2i+2.
fn division(area: Area, mut packets: [u32; 2], number: usize) -> Area {
    let path = number + 1;
    let mut part = area;
    for level in (0..path.ilog2()).rev() {
        let across = halves_across(packets);
        part = part.halves(across)[path >> level & 1];
        packets[usize::from(!across)] /= 2;
    }
    part
}

/// The number of a packet, given its column and row, among those of the last level of that tree.
pub(crate) fn packet_number([mut column, mut row]: [u32; 2], mut packets: [u32; 2]) -> usize {
    let mut number = 0;
    while packets != [1, 1] {
        let across = halves_across(packets);
        let axis = usize::from(!across);
        packets[axis] /= 2;
        let place = if across { &mut column } else { &mut row };
        let far = *place >= packets[axis];
        if far {
            *place -= packets[axis];
        }
        number = 2 * number + usize::from(far);
    }
    number
}
