//! Anti-aliasing: more rays for the pixels that need them.
//!
//! Every pixel has had one ray. A pixel that differs from a neighbour is sampled again on a regular
//! grid of n×n, whose mean replaces the single sample. That depends on the first samples only, so
//! it does not matter in which order, or in which tile, pixels are treated. If lights have a size,
//! or there is a sky, all pixels that see a surface get more rays; behind a lens or an open shutter
//! all do (`exposure`).
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

/// Numbers of packets across and down a square.
const PACKETS: [u32; 2] = [SQUARE / PACKET_SIZE[0], SQUARE / PACKET_SIZE[1]];

/// The hits of the rays of one packet's pixels.
#[derive(Default)]
struct Closer {
    /// Packets of rays, of which the first are in use, as many as there are owners.
    seen: Vec<Seen>,
    /// Numbers of each packet in use: of its pixel, of its first ray in the pixel, and of its rays
    /// in use.
    owners: Vec<(usize, u32, usize)>,
}

impl Sampler {
    /// Replaces the samples of an area's pixels that differ from a neighbour by the mean of n×n.
    /// The area consists of whole packets, and `samples` must hold the pixels around it too. `None`
    /// if `stop` returned true.
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
                    let still = (&self.view, &self.world);
                    means.extend(exposure.trace(still, packet, self.samples, work, stats));
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
                let [start, end] = [[packet.left, packet.top], [packet.right, packet.bottom]]
                    .map(|[x, y]| self.view.ray(f64::from(x), f64::from(y)).direction);
                let across = start.distance(end);
                let seen = &seen[..owners.len()];
                match &self.world.rich {
                    Some(rich) if rich.is_direct && !self.soft_light => {
                        self.world.shine_in_air(rich, seen, across, work, stats);
                    }
                    Some(rich) => {
                        self.world.illuminate(
                            rich,
                            seen,
                            &|packet, lane| {
                                let (owner, first, _) = owners[packet];
                                let (x, y, ..) = means[owner];
                                self.draw([x, y], first + lane as u32)
                            },
                            work,
                            stats,
                        );
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

    /// Sends a pixel's n×n rays, eight by eight. Packets with a hit are added to `closer`; for the
    /// others the sums of their rays' colours and costs are returned.
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
            // The place of a ray in the pixel; lanes not in use repeat the last ray.
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
            let exact = || {
                core::array::from_fn(|i| {
                    let [across, down] = part(i);
                    self.view.ray(f64::from(x) + across, f64::from(y) + down)
                })
            };
            let rays = PacketRays {
                fan: &|lens: &Lens| {
                    let half = 0.5 * f64::from(SQUARE);
                    let at = [x - block.left, y - block.top].map(|c| f64::from(c) - half);
                    let places = [0, 1].map(|k| f32x8::from_lanes(|lane| at[k] + part(lane)[k]));
                    let middle = [0, 1].map(|k| at[k] + 0.5 * (part(0)[k] + part(PACKET - 1)[k]));
                    lens.fan(places, middle)
                },
                exact: &exact,
            };
            self.world
                .meet(square, [column, row], &rays, seen, work, stats);
            let count = count as usize;
            let rich = self.needs_more_light(seen).is_some();
            if rich && !seen.has_hit() {
                seen.rays = exact();
            }
            if rich || seen.has_hit() {
                // Lanes not in use have no hits.
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

    /// Whether a pixel needs more rays than one.
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

    /// Whether a pixel with this first sample needs more rays whatever its neighbours are.
    fn is_spread(&self, sample: &Sample) -> bool {
        self.exposure.is_some() || self.soft_light && sample.key != 0
    }

    /// Returns the sample that a ray of a pixel belongs to, for the places on lights where rays
    /// end.
    fn draw(&self, pixel: [u32; 2], number: u32) -> Draw {
        if self.soft_light {
            Draw::Sample { pixel, number }
        } else {
            Draw::Middle
        }
    }

    /// Counts the pixels of an area that differ from the next one on the right or below: about half
    /// of those for which [`Sampler::refine`] will take more rays, at a quarter of the cost of
    /// counting those.
    pub fn edges(&self, samples: &Samples) -> u64 {
        let area = samples.area();
        let slope = self.slope();
        let mut count = 0;
        for y in area.top..area.bottom {
            let row = samples.part(y, area.left..area.right);
            let below = samples.part((y + 1).min(area.bottom - 1), area.left..area.right);
            for (x, here) in row.iter().enumerate() {
                let mut others = [row.get(x + 1).unwrap_or(here), &below[x]].into_iter();
                let is_edge =
                    self.is_spread(here) || others.any(|other| self.differ(here, other, slope));
                count += u64::from(is_edge);
            }
        }
        count
    }

    /// Returns the bound on the slope, difference of distance by distance, of neighbours on one
    /// surface: on a plane seen at 80° from its normal, neighbouring pixels' distances differ by
    /// tan 80° times the pixel's size.
    fn slope(&self) -> f32 {
        5.7 * self.view.pixel() as f32
    }

    /// Whether two neighbouring pixels need more rays, given [`Sampler::slope`].
    fn differ(&self, here: &Sample, other: &Sample, slope: f32) -> bool {
        let jump = slope * here.depth.at_most(other.depth);
        differ(here, other, self.contrast, jump)
    }
}
