//! A scene made ready for tracing.
use crate::beam::Beam;
use crate::hard::Crossing;
use crate::packet::Workspace;
use crate::ray::Ray;
use crate::sample::{Sample, differ};
use crate::shade::{Finish, bytes};
use crate::slabs::Slabs;
use crate::soft::{PACKET, Soft};
use crate::solids::Solids;
use crate::unit::Unit;
use crate::{Pass, Tile};
use glam::{DVec3, Vec3};
use scene::{Light, Projection, Scene, Settings};
use serde::{Deserialize, Serialize};

/// Counts of work done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Stats {
    /// Rays from the eye.
    pub primary_rays: u64,
    /// Rays towards lights.
    pub shadow_rays: u64,
    /// Evaluations of one primitive's field at one point.
    pub field_evaluations: u64,
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
    size: [u32; 2],
    unit: Unit,
    projection: Projection,
    pub(crate) soft: Soft,
    pub(crate) solids: Solids,
    pub(crate) finishes: Vec<Finish>,
    pub(crate) lights: Vec<Light>,
    pub(crate) background: Vec3,
    samples: u32,
    contrast: Vec3,
    gamma: f32,
}

/// Blocks of pixels that share a beam. Blocks and packets are laid out from the picture's corner,
/// whatever the tiles, and a packet is always traced whole: so a pixel's value does not depend on
/// how the picture is cut into tiles.
const BLOCK: u32 = 8;
/// Pixels of a packet.
const PACKET_SIZE: [u32; 2] = [4, 2];

impl Picture {
    /// Prepares a scene. `size` is the picture's width and height in pixels, each > 0.
    #[must_use]
    pub fn new(scene: &Scene, size: [u32; 2]) -> Self {
        let (unit, scene) = Unit::fit(scene);
        let size = size.map(|n| n.max(1));
        Self {
            size,
            unit,
            projection: scene.camera.projection(size[0], size[1]),
            soft: Soft::new(&scene),
            solids: Solids::new(&scene),
            finishes: scene.materials.iter().map(Finish::of).collect(),
            lights: scene.lights.clone(),
            background: Vec3::from(scene.background),
            samples: scene.settings.samples.clamp(1, Settings::MAX_SAMPLES),
            contrast: Vec3::from(scene.settings.contrast),
            gamma: scene.settings.gamma,
        }
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
        let area = Area {
            left: tile.x,
            top: tile.y,
            right: tile.x.saturating_add(tile.width),
            bottom: tile.y.saturating_add(tile.height),
        };
        let mut work = Workspace::default();
        match pass {
            Pass::Coarse => {
                let blocks = Area {
                    left: area.left / BLOCK,
                    top: area.top / BLOCK,
                    right: area.right.div_ceil(BLOCK),
                    bottom: area.bottom.div_ceil(BLOCK),
                };
                let samples = self.sample(blocks, BLOCK, stop, &mut work, stats)?;
                Some(self.rgba(area, |x, y| samples.get(x / BLOCK, y / BLOCK).colour))
            }
            Pass::Full => {
                let samples = self.sample(area, 1, stop, &mut work, stats)?;
                Some(self.rgba(area, |x, y| samples.get(x, y).colour))
            }
            Pass::Smooth if self.samples == 1 => self.trace(tile, Pass::Full, stop, stats),
            Pass::Smooth => {
                let wide = Area {
                    left: area.left.saturating_sub(1),
                    top: area.top.saturating_sub(1),
                    right: (area.right + 1).min(self.size[0].max(area.right)),
                    bottom: (area.bottom + 1).min(self.size[1].max(area.bottom)),
                };
                let mut samples = self.sample(wide, 1, stop, &mut work, stats)?;
                self.refine(area, &mut samples, stop, &mut work, stats)?;
                Some(self.rgba(area, |x, y| samples.get(x, y).colour))
            }
        }
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

    /// One sample at the centre of each cell of an area, in units of cells of `scale` pixels.
    fn sample(
        &self,
        area: Area,
        scale: u32,
        stop: &dyn Fn() -> bool,
        work: &mut Workspace,
        stats: &mut Stats,
    ) -> Option<Samples> {
        let mut samples = Samples::new(area);
        // A beam's cells; coarse cells are blocks already, so fewer of them share a beam.
        let block = if scale == 1 { [BLOCK; 2] } else { PACKET_SIZE };
        for top in (area.top / block[1] * block[1]..area.bottom).step_by(block[1] as usize) {
            for left in (area.left / block[0] * block[0]..area.right).step_by(block[0] as usize) {
                if stop() {
                    return None;
                }
                let rectangle = Area {
                    left: left * scale,
                    top: top * scale,
                    right: (left + block[0]) * scale,
                    bottom: (top + block[1]) * scale,
                };
                let packets = [block[0] / PACKET_SIZE[0], block[1] / PACKET_SIZE[1]];
                let mut slabs = self.slabs(rectangle, packets);
                // Column by column, as beams are divided.
                let corners = (0..packets[0]).flat_map(|i| (0..packets[1]).map(move |j| (i, j)));
                for (number, (i, j)) in corners.enumerate() {
                    let (x, y) = (left + i * PACKET_SIZE[0], top + j * PACKET_SIZE[1]);
                    let cell = |i: usize| {
                        let i = i as u32;
                        (x + i % PACKET_SIZE[0], y + i / PACKET_SIZE[0])
                    };
                    let wanted = (0..PACKET)
                        .filter(|&i| area.holds(cell(i).0, cell(i).1))
                        .count();
                    if wanted == 0 {
                        continue;
                    }
                    let rays = core::array::from_fn(|i| {
                        let (x, y) = cell(i);
                        let middle = |c: u32| (f64::from(c) + 0.5) * f64::from(scale);
                        self.ray(middle(x), middle(y))
                    });
                    stats.primary_rays += wanted as u64;
                    for (i, sample) in self
                        .packet(&rays, number, &mut slabs, work, stats)
                        .into_iter()
                        .enumerate()
                    {
                        let (x, y) = cell(i);
                        samples.set(x, y, sample);
                    }
                }
            }
        }
        Some(samples)
    }

    /// Replaces the samples of pixels that differ from a neighbour by the mean of n×n.
    fn refine(
        &self,
        area: Area,
        samples: &mut Samples,
        stop: &dyn Fn() -> bool,
        work: &mut Workspace,
        stats: &mut Stats,
    ) -> Option<()> {
        let wanted: Vec<(u32, u32)> = area
            .pixels()
            .filter(|&(x, y)| self.needs_more(samples, x, y))
            .collect();
        let mut means = Vec::with_capacity(wanted.len());
        let n = self.samples;
        for &(x, y) in &wanted {
            if stop() {
                return None;
            }
            let pixel = Area {
                left: x,
                top: y,
                right: x + 1,
                bottom: y + 1,
            };
            let mut slabs = self.slabs(pixel, [1, 1]);
            let mut sum = Vec3::ZERO;
            for first in (0..n * n).step_by(PACKET) {
                let count = (n * n - first).min(PACKET as u32);
                let rays = core::array::from_fn(|i| {
                    let i = first + (i as u32).min(count - 1);
                    let at = |c: u32, k: u32| f64::from(c) + (f64::from(k) + 0.5) / f64::from(n);
                    self.ray(at(x, i % n), at(y, i / n))
                });
                stats.primary_rays += u64::from(count);
                let found = self.packet(&rays, 0, &mut slabs, work, stats);
                sum += found[..count as usize]
                    .iter()
                    .map(|s| s.colour)
                    .sum::<Vec3>();
            }
            means.push(sum / (n * n) as f32);
        }
        for ((x, y), mean) in wanted.into_iter().zip(means) {
            let mut sample = *samples.get(x, y);
            sample.colour = mean;
            samples.set(x, y, sample);
        }
        Some(())
    }

    fn needs_more(&self, samples: &Samples, x: u32, y: u32) -> bool {
        let here = samples.get(x, y);
        // On a plane seen at 80° from its normal, neighbouring pixels' distances differ by
        // tan 80° times the pixel's size.
        let pixel = 2.0 * self.projection.half_width / f64::from(self.size[0]);
        let jump = |other: &Sample| 5.7 * pixel as f32 * here.depth.min(other.depth);
        for (dx, dy) in [
            (-1, -1),
            (0, -1),
            (1, -1),
            (-1, 0),
            (1, 0),
            (-1, 1),
            (0, 1),
            (1, 1),
        ] {
            let (Some(nx), Some(ny)) = (x.checked_add_signed(dx), y.checked_add_signed(dy)) else {
                continue;
            };
            if nx >= self.size[0] || ny >= self.size[1] {
                continue;
            }
            let other = samples.get(nx, ny);
            if differ(here, other, self.contrast, jump(other)) {
                return true;
            }
        }
        false
    }

    /// The ray through a point of the picture, in pixels.
    fn ray(&self, x: f64, y: f64) -> Ray {
        Ray {
            origin: self.projection.eye,
            direction: self
                .projection
                .direction(x / f64::from(self.size[0]), y / f64::from(self.size[1])),
        }
    }

    /// The slabs of the beam through a rectangle of pixels, divided into columns and rows (powers of
    /// two) of packets.
    fn slabs(&self, area: Area, packets: [u32; 2]) -> Option<(Slabs<'_>, f64)> {
        if self.soft.is_empty() {
            return None;
        }
        let divide = || {
            let mut beams = Vec::new();
            let mut level = vec![area];
            for across in core::iter::repeat_n(true, packets[0].ilog2() as usize)
                .chain(core::iter::repeat_n(false, packets[1].ilog2() as usize))
            {
                level = level.iter().flat_map(|a| a.halves(across)).collect();
                beams.extend(level.iter().map(|&a| self.beam(a)));
            }
            beams
        };
        self.soft.slabs(self.beam(area), divide, f64::INFINITY)
    }

    /// The beam of all rays through a rectangle of pixels.
    fn beam(&self, area: Area) -> Beam {
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
        }
    }

    fn rgba(&self, area: Area, colour: impl Fn(u32, u32) -> Vec3) -> Vec<u8> {
        area.pixels()
            .flat_map(|(x, y)| {
                let [r, g, b] = bytes(colour(x, y), self.gamma);
                [r, g, b, 255]
            })
            .collect()
    }
}

/// A rectangle of cells.
#[derive(Clone, Copy, Debug)]
struct Area {
    left: u32,
    top: u32,
    right: u32,
    bottom: u32,
}

impl Area {
    fn holds(&self, x: u32, y: u32) -> bool {
        (self.left..self.right).contains(&x) && (self.top..self.bottom).contains(&y)
    }

    /// The left and the right half, or the upper and the lower.
    fn halves(self, across: bool) -> [Self; 2] {
        let (x, y) = (
            self.left.midpoint(self.right),
            self.top.midpoint(self.bottom),
        );
        if across {
            [Self { right: x, ..self }, Self { left: x, ..self }]
        } else {
            [Self { bottom: y, ..self }, Self { top: y, ..self }]
        }
    }

    /// Row by row.
    fn pixels(self) -> impl Iterator<Item = (u32, u32)> {
        (self.top..self.bottom).flat_map(move |y| (self.left..self.right).map(move |x| (x, y)))
    }
}

/// The samples of an area.
struct Samples {
    area: Area,
    cells: Vec<Sample>,
}

impl Samples {
    fn new(area: Area) -> Self {
        let blank = Sample {
            colour: Vec3::ZERO,
            key: 0,
            depth: f32::INFINITY,
        };
        let width = (area.right - area.left) as usize;
        let height = (area.bottom - area.top) as usize;
        Self {
            area,
            cells: vec![blank; width * height],
        }
    }

    fn index(&self, x: u32, y: u32) -> usize {
        let width = (self.area.right - self.area.left) as usize;
        (y - self.area.top) as usize * width + (x - self.area.left) as usize
    }

    fn get(&self, x: u32, y: u32) -> &Sample {
        &self.cells[self.index(x, y)]
    }

    /// Cells outside the area are ignored.
    fn set(&mut self, x: u32, y: u32, sample: Sample) {
        if self.area.holds(x, y) {
            let index = self.index(x, y);
            self.cells[index] = sample;
        }
    }
}
