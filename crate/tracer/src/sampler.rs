//! Samples of a picture: one ray for each cell of an area.
use crate::area::{Area, Samples};
use crate::exposure::Exposure;
use crate::lamps::Draw;
use crate::layout::{PACKET, PACKET_SIZE, SQUARE};
use crate::lens::Lens;
use crate::meet::{PacketRays, Seen};
use crate::rich::Rich;
use crate::sample::Sample;
use crate::sample_cache::SampleCache;
use crate::shade;
use crate::square::Square;
use crate::stats::Stats;
use crate::view::View;
use crate::workspace::Workspace;
use crate::world::World;
use field::Real;
use glam::Vec3;
use wide::f32x8;

/// Part of a packet's width within which hits share a beam to a light in the coarse pass: a beam
/// from all hits of rays a block apart would be wide all along. Measured: the coarse pass takes 0.6
/// of the time that it took with 1 for hermite-crab and coral-crab, 0.8 for generators; 1.1 for
/// shell-3.
const SPARSE: f64 = 0.25;

/// A scene seen by a camera.
pub(crate) struct Sampler {
    pub view: View,
    pub world: World,
    /// Lens and shutter, if rays depend on them.
    pub exposure: Option<Exposure>,
    /// Whether lights have a size or there is a sky: all pixels that see a surface need many
    /// samples.
    pub soft_light: bool,
    /// Number of samples across and down a pixel that needs more than one.
    pub samples: u32,
    /// Contrast with a neighbour, by channel, from which a pixel needs more samples.
    pub contrast: Vec3,
}

impl Sampler {
    /// Takes one sample at the centre of each cell of an area, in units of cells of `scale` pixels.
    /// Those of the cache, which is of single pixels, are not taken again. `None` if `stop`
    /// returned true.
    pub fn sample(
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
                let pixels: [(u32, u32); PACKET] = core::array::from_fn(|lane| {
                    let lane = lane as u32;
                    (
                        block.left + i * PACKET_SIZE[0] + lane % PACKET_SIZE[0],
                        block.top + j * PACKET_SIZE[1] + lane / PACKET_SIZE[0],
                    )
                });
                let wanted = pixels.iter().filter(|&&(x, y)| area.holds(x, y)).count();
                if wanted == 0 || known.is_some_and(|known| known.tell([i, j], block, &mut samples))
                {
                    continue;
                }
                stats.primary_rays += wanted as u64;
                let square =
                    square.get_or_insert_with(|| self.square(block.times(scale), [columns, rows]));
                let exact = || {
                    pixels.map(|(x, y)| {
                        let [x, y] = [x, y].map(|c| (f64::from(c) + 0.5) * f64::from(scale));
                        self.view.ray(x, y)
                    })
                };
                let rays = PacketRays {
                    fan: &|lens: &Lens| {
                        // Pixels from the square's middle.
                        let place = |c: f64| (c - 0.5 * f64::from(side)) * f64::from(scale);
                        let [left, top] = [i * PACKET_SIZE[0], j * PACKET_SIZE[1]].map(f64::from);
                        let [wide, high] = PACKET_SIZE.map(|n| 0.5 * f64::from(n));
                        let width = PACKET_SIZE[0] as usize;
                        let x = f32x8::from_lanes(|lane| place(left + (lane % width) as f64 + 0.5));
                        let y = f32x8::from_lanes(|lane| place(top + (lane / width) as f64 + 0.5));
                        lens.fan([x, y], [place(left + wide), place(top + high)])
                    },
                    exact: &exact,
                };
                self.world
                    .meet(square, [i, j], &rays, &mut seen, work, stats);
                if let Some(rich) = self.needs_more_light(&seen) {
                    if !seen.has_hit() {
                        seen.rays = exact();
                    }
                    let across = across(&seen, scale);
                    let seen = core::slice::from_ref(&seen);
                    if rich.is_direct {
                        self.world.shine_in_air(rich, seen, across, work, stats);
                    } else {
                        self.world
                            .illuminate(rich, seen, &|_, _| Draw::Middle, work, stats);
                    }
                    for ((x, y), sample) in pixels.into_iter().zip(&work.samples[0]) {
                        samples.set(x, y, *sample);
                    }
                } else if seen.has_hit() {
                    let across = across(&seen, scale);
                    let seen = core::slice::from_ref(&seen);
                    self.world.shine(seen, across, work, stats);
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
                square.leave(&mut work.scratch, stats);
            }
        }
        Some(samples)
    }

    /// Returns the scene's data beyond Phong's model, if a packet sees any of it.
    pub fn needs_more_light(&self, seen: &Seen) -> Option<&Rich> {
        let rich = self.world.rich.as_ref();
        rich.filter(|rich| seen.has_hit() || !rich.air.is_plain())
    }

    /// Returns the sample of a ray that meets nothing, if all such rays see the same.
    pub fn nothing(&self) -> Sample {
        Sample {
            colour: match &self.world.rich {
                Some(rich) => shade::clamp(rich.tone(self.world.background)),
                None => shade::clamp(self.world.background),
            },
            key: 0,
            depth: f32::INFINITY,
            cost: 1.0,
        }
    }

    /// Returns the data of a square of pixels, divided into columns and rows (powers of two) of
    /// packets.
    pub fn square(&self, area: Area, packets: [u32; 2]) -> Square<'_> {
        Square::new(&self.world, &self.view, area, packets)
    }
}

/// Returns the width of a packet's rays within which hits share a beam to a light.
fn across(seen: &Seen, scale: u32) -> f64 {
    let [first, .., last] = &seen.rays;
    let across = first.direction.distance(last.direction);
    if scale > 1 { SPARSE * across } else { across }
}
