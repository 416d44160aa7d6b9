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

/// Rays a block apart hit so far from each other that a beam from all their hits to a light would
/// be wide all along: only hits within this part of the packet's width share one. Measured: the
/// coarse pass takes 0.6 of the time that it took with 1 for hermite-crab and coral-crab, 0.8 for
/// generators; 1.1 for shell-3.
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
    /// Samples of a pixel where there is contrast: this many across and down.
    pub samples: u32,
    /// The contrast, a channel each, from which a pixel gets them.
    pub contrast: Vec3,
}

impl Sampler {
    /// One sample at the centre of each cell of an area, in units of cells of `scale` pixels. The
    /// cache, which is of single pixels, is asked first.
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
                let square =
                    square.get_or_insert_with(|| self.square(block.times(scale), [columns, rows]));
                // Places in pixels from the square's middle.
                let middle = |c: f64| (c - 0.5 * f64::from(side)) * f64::from(scale);
                let [left, top] = [i * PACKET_SIZE[0], j * PACKET_SIZE[1]].map(f64::from);
                let [wide, high] = PACKET_SIZE.map(|n| 0.5 * f64::from(n));
                let fan = |lens: &Lens| {
                    let x = |lane: usize| left + (lane % PACKET_SIZE[0] as usize) as f64 + 0.5;
                    let y = |lane: usize| top + (lane / PACKET_SIZE[0] as usize) as f64 + 0.5;
                    let places = [
                        f32x8::from_lanes(|lane| middle(x(lane))),
                        f32x8::from_lanes(|lane| middle(y(lane))),
                    ];
                    lens.fan(places, [middle(left + wide), middle(top + high)])
                };
                let exact = || {
                    pixels.map(|(x, y)| {
                        let middle = |c: u32| (f64::from(c) + 0.5) * f64::from(scale);
                        self.view.ray(middle(x), middle(y))
                    })
                };
                let rays = PacketRays {
                    fan: &fan,
                    exact: &exact,
                };
                self.world
                    .meet(square, [i, j], &rays, &mut seen, work, stats);
                let across = |seen: &Seen| {
                    let [first, .., last] = &seen.rays;
                    let across = first.direction.distance(last.direction);
                    if scale > 1 { SPARSE * across } else { across }
                };
                if let Some(rich) = self.needs_more_light(&seen) {
                    if !seen.something() {
                        seen.rays = exact();
                    }
                    let across = across(&seen);
                    let seen = core::slice::from_ref(&seen);
                    if rich.is_direct {
                        self.world.shine_in_air(rich, seen, across, work, stats);
                    } else {
                        let draw = |_, _| Draw::Middle;
                        self.world.illuminate(rich, seen, &draw, work, stats);
                    }
                    for ((x, y), sample) in pixels.into_iter().zip(&work.samples[0]) {
                        samples.set(x, y, *sample);
                    }
                } else if seen.something() {
                    let across = across(&seen);
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

    /// What a scene has beyond Phong's model, where a packet sees any of it.
    pub fn needs_more_light(&self, seen: &Seen) -> Option<&Rich> {
        let rich = self.world.rich.as_ref();
        rich.filter(|rich| seen.something() || !rich.air.is_plain())
    }

    /// The sample of a ray that meets nothing, where all such rays see the same.
    pub fn nothing(&self) -> Sample {
        Sample {
            colour: match &self.world.rich {
                Some(rich) => shade::clamped(rich.toned(self.world.background)),
                None => shade::clamped(self.world.background),
            },
            key: 0,
            depth: f32::INFINITY,
            cost: 1.0,
        }
    }

    /// The surroundings of a square of pixels, divided into columns and rows (powers of two) of
    /// packets.
    pub fn square(&self, area: Area, packets: [u32; 2]) -> Square<'_> {
        Square::new(&self.world, &self.view, area, packets)
    }
}
