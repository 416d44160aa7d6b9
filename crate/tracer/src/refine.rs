//! Anti-aliasing: more rays for the pixels that need them.
//!
//! Every pixel has had one ray. A pixel that differs from a neighbour is sampled again on a regular
//! grid of n×n, whose mean replaces the single sample. Which pixels those are depends on the first
//! samples only, so it does not matter in which order, or in which tile, pixels are treated.
use crate::area::{Area, Samples};
use crate::packet::{Near, Workspace};
use crate::picture::{PACKET_SIZE, Picture, SQUARE, Stats};
use crate::sample::{Sample, differ};
use crate::soft::PACKET;
use field::Real;
use glam::Vec3;
use wide::f32x8;

impl Picture {
    /// Replaces the samples of an area's pixels that differ from a neighbour by the mean of n×n.
    /// `samples` must hold the pixels around the area too. `None` when asked to stop.
    pub(crate) fn refine(
        &self,
        area: Area,
        samples: &mut Samples,
        stop: &dyn Fn() -> bool,
        work: &mut Workspace,
        stats: &mut Stats,
    ) -> Option<()> {
        let mut means = Vec::new();
        for block in area.blocks([SQUARE; 2]) {
            if stop() {
                return None;
            }
            let mut wanted = block
                .meet(area)
                .pixels()
                .filter(|&(x, y)| self.needs_more(samples, x, y))
                .peekable();
            if wanted.peek().is_none() {
                continue;
            }
            // The pixels' rays run in the same beams as the packets that they belong to.
            let packets = [SQUARE / PACKET_SIZE[0], SQUARE / PACKET_SIZE[1]];
            let mut square = self.square(block, packets, work);
            for (x, y) in wanted {
                let column = (x - block.left) / PACKET_SIZE[0];
                let row = (y - block.top) / PACKET_SIZE[1];
                let n = self.samples;
                let (mut sum, mut cost) = (Vec3::ZERO, 0.0);
                for first in (0..n * n).step_by(PACKET) {
                    let count = (n * n - first).min(PACKET as u32);
                    // Where in the pixel; the last one again where there are no more.
                    let part = |i: usize| {
                        let i = first + (i as u32).min(count - 1);
                        [i % n, i / n].map(|k| (f64::from(k) + 0.5) / f64::from(n))
                    };
                    stats.primary_rays += u64::from(count);
                    let near = square.near([column, row], packets);
                    let quick = match near {
                        Near::Lumps(near, Some(lens)) if self.solids.is_empty() => {
                            let half = 0.5 * f64::from(SQUARE);
                            let at = [x - block.left, y - block.top].map(|c| f64::from(c) - half);
                            let place = |k: usize| f32x8::from_lanes(|lane| at[k] + part(lane)[k]);
                            let middle =
                                |k: usize| at[k] + 0.5 * (part(0)[k] + part(PACKET - 1)[k]);
                            let places = [place(0), place(1)];
                            let fan = lens.fan(places, [middle(0), middle(1)]);
                            self.lump_packet(lens, &fan, near, work, stats)
                        }
                        _ => None,
                    };
                    let found = quick.unwrap_or_else(|| {
                        let rays = core::array::from_fn(|i| {
                            let [across, down] = part(i);
                            self.ray(f64::from(x) + across, f64::from(y) + down)
                        });
                        self.packet(&rays, near, work, stats)
                    });
                    let found = &found[..count as usize];
                    sum += found.iter().map(|s| s.colour).sum::<Vec3>();
                    cost += found.iter().map(|s| s.cost).sum::<f32>();
                }
                let all = (n * n) as f32;
                means.push((x, y, sum / all, cost / all));
            }
            square.leave(work);
        }
        for (x, y, colour, cost) in means {
            let mut sample = *samples.get(x, y);
            (sample.colour, sample.cost) = (colour, cost);
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
}
