//! Anti-aliasing: more rays for the pixels that need them.
//!
//! Every pixel has had one ray. A pixel that differs from a neighbour is sampled again on a regular
//! grid of n×n, whose mean replaces the single sample. Which pixels those are depends on the first
//! samples only, so it does not matter in which order, or in which tile, pixels are treated. Where
//! lights have a size, or there is a sky, all pixels that see a surface get them; behind a lens or
//! an open shutter all do (`exposure`).
use crate::area::{Area, Samples};
use crate::lamps::Draw;
use crate::layout::{PACKET, PACKET_SIZE, SQUARE};
use crate::lens::Lens;
use crate::meet::{PacketRays, Seen};
use crate::sample::{Sample, differ};
use crate::sampler::Sampler;
use crate::square::Square;
use crate::stats::Stats;
use crate::workspace::Workspace;
use field::{Cut, Real};
use glam::Vec3;
use wide::f32x8;

/// Packets of a square.
const PACKETS: [u32; 2] = [SQUARE / PACKET_SIZE[0], SQUARE / PACKET_SIZE[1]];

/// What the rays of one packet's pixels hit.
#[derive(Default)]
struct Closer {
    /// The first of these are in use: as many as there are owners.
    seen: Vec<Seen>,
    /// The number of each one's pixel, the first ray's number in it, and how many of the rays
    /// count.
    owners: Vec<(usize, u32, usize)>,
}

impl Sampler {
    /// Replaces the samples of an area's pixels that differ from a neighbour by the mean of n×n.
    /// The area consists of whole packets, and `samples` must hold the pixels around it too. `None`
    /// when asked to stop.
    pub fn refine(
        &self,
        area: Area,
        samples: &mut Samples,
        stop: &dyn Fn() -> bool,
        work: &mut Workspace,
        stats: &mut Stats,
    ) -> Option<()> {
        let mut means = Vec::new();
        let mut closer = Closer::default();
        for block in area.blocks([SQUARE; 2]) {
            if stop() {
                return None;
            }
            let mut square = None;
            for packet in block.meet(area).blocks(PACKET_SIZE) {
                if let Some(exposure) = &self.exposure {
                    if stop() {
                        return None;
                    }
                    means.extend(self.expose(exposure, packet, work, stats));
                    continue;
                }
                let wanted = packet
                    .pixels()
                    .filter(|&(x, y)| self.needs_more(samples, x, y));
                for (x, y) in wanted {
                    // The pixels' rays run in the same beams as the packets that they belong to.
                    let square = square.get_or_insert_with(|| self.square(block, PACKETS));
                    let owner = means.len();
                    let (colour, cost) =
                        self.look_closer(block, square, [x, y], (owner, &mut closer), work, stats);
                    means.push((x, y, colour, cost));
                }
                let Closer { seen, owners } = &mut closer;
                if owners.is_empty() {
                    continue;
                }
                let corner = |x, y| self.view.ray(f64::from(x), f64::from(y)).direction;
                let across =
                    corner(packet.left, packet.top).distance(corner(packet.right, packet.bottom));
                let seen = &seen[..owners.len()];
                match &self.world.rich {
                    Some(rich) if rich.is_direct && !self.soft_light => {
                        self.world.shine_in_air(rich, seen, across, work, stats);
                    }
                    Some(rich) => {
                        let draw = |packet: usize, lane: usize| {
                            let (owner, first, _) = owners[packet];
                            let (x, y, ..) = means[owner];
                            self.draw([x, y], first + lane as u32)
                        };
                        self.world.illuminate(rich, seen, &draw, work, stats);
                    }
                    None => self.world.shine(seen, across, work, stats),
                }
                for (found, &(owner, _, count)) in work.samples.iter().zip(&*owners) {
                    let (_, _, sum, cost) = &mut means[owner];
                    *sum += found[..count].iter().map(|s| s.colour).sum::<Vec3>();
                    *cost += found[..count].iter().map(|s| s.cost).sum::<f32>();
                }
                owners.clear();
                if stop() {
                    return None;
                }
            }
            if let Some(square) = square {
                square.leave(&mut work.scratch, stats);
            }
        }
        let all = (self.samples * self.samples) as f32;
        for (x, y, colour, cost) in means {
            let mut sample = *samples.get(x, y);
            (sample.colour, sample.cost) = (colour / all, cost / all);
            samples.set(x, y, sample);
        }
        Some(())
    }

    /// Sends a pixel's n×n rays, eight by eight. Those that hit something are added to `closer`; of
    /// the others the sum of what they see, and of what they cost.
    fn look_closer<'a>(
        &'a self,
        block: Area,
        square: &mut Square<'a>,
        [x, y]: [u32; 2],
        (owner, closer): (usize, &mut Closer),
        work: &mut Workspace,
        stats: &mut Stats,
    ) -> (Vec3, f32) {
        let mut sum = (Vec3::ZERO, 0.0);
        let column = (x - block.left) / PACKET_SIZE[0];
        let row = (y - block.top) / PACKET_SIZE[1];
        let n = self.samples;
        for first in (0..n * n).step_by(PACKET) {
            let count = (n * n - first).min(PACKET as u32);
            // Where in the pixel; the last one again where there are no more.
            let part = |i: usize| {
                let i = first + (i as u32).min(count - 1);
                [i % n, i / n].map(|k| (f64::from(k) + 0.5) / f64::from(n))
            };
            stats.primary_rays += u64::from(count);
            let Closer { seen, owners } = &mut *closer;
            if seen.len() == owners.len() {
                seen.push(Seen::default());
            }
            let seen = &mut seen[owners.len()];
            let fan = |lens: &Lens| {
                let half = 0.5 * f64::from(SQUARE);
                let at = [x - block.left, y - block.top].map(|c| f64::from(c) - half);
                let place = |k: usize| f32x8::from_lanes(|lane| at[k] + part(lane)[k]);
                let middle = |k: usize| at[k] + 0.5 * (part(0)[k] + part(PACKET - 1)[k]);
                lens.fan([place(0), place(1)], [middle(0), middle(1)])
            };
            let exact = || {
                core::array::from_fn(|i| {
                    let [across, down] = part(i);
                    self.view.ray(f64::from(x) + across, f64::from(y) + down)
                })
            };
            let rays = PacketRays {
                fan: &fan,
                exact: &exact,
            };
            self.world
                .meet(square, [column, row], &rays, seen, work, stats);
            let count = count as usize;
            let rich = self.needs_more_light(seen).is_some();
            if rich && !seen.something() {
                seen.rays = exact();
            }
            if rich || seen.something() {
                // The last ones are repeated.
                seen.hits[count..].fill(None);
                seen.used = count;
                owners.push((owner, first, count));
            } else {
                sum.0 += self.nothing().colour * count as f32;
                sum.1 += seen.costs[..count].iter().sum::<f32>();
            }
        }
        sum
    }

    fn needs_more(&self, samples: &Samples, x: u32, y: u32) -> bool {
        if x >= self.view.size[0] || y >= self.view.size[1] {
            return false;
        }
        let here = samples.get(x, y);
        if self.is_spread(here) {
            return true;
        }
        let slope = self.slope();
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
            if nx >= self.view.size[0] || ny >= self.view.size[1] {
                continue;
            }
            let other = samples.get(nx, ny);
            if self.differ(here, other, slope) {
                return true;
            }
        }
        false
    }

    /// Whether a pixel of this first sample is a mean of many whatever its neighbours are.
    fn is_spread(&self, sample: &Sample) -> bool {
        self.exposure.is_some() || self.soft_light && sample.key != 0
    }

    /// Where rays from what a ray of a pixel sees end on lights.
    fn draw(&self, pixel: [u32; 2], number: u32) -> Draw {
        if self.soft_light {
            Draw::Sample { pixel, number }
        } else {
            Draw::Middle
        }
    }

    /// How many pixels of an area differ from the next one on the right or below: about half of
    /// those that [`Sampler::refine`] will take more rays for, at a quarter of the cost of asking
    /// for each.
    pub fn edges(&self, samples: &Samples) -> u64 {
        let area = samples.area();
        let slope = self.slope();
        let mut count = 0;
        for y in area.top..area.bottom {
            let row = samples.part(y, area.left..area.right);
            let below = samples.part((y + 1).min(area.bottom - 1), area.left..area.right);
            for (x, here) in row.iter().enumerate() {
                let others = [row.get(x + 1).unwrap_or(here), &below[x]];
                let differ = |other: &Sample| self.differ(here, other, slope);
                count += u64::from(self.is_spread(here) || others.into_iter().any(differ));
            }
        }
        count
    }

    /// The slope, difference of distance by distance, that neighbours on one surface stay below: on
    /// a plane seen at 80° from its normal, neighbouring pixels' distances differ by tan 80° times
    /// the pixel's size.
    fn slope(&self) -> f32 {
        5.7 * self.view.pixel() as f32
    }

    fn differ(&self, here: &Sample, other: &Sample, slope: f32) -> bool {
        let jump = slope * here.depth.at_most(other.depth);
        differ(here, other, self.contrast, jump)
    }
}
