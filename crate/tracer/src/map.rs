//! The map of costs (`map on`): the work of each pixel.
//!
//! The unit of cost is one evaluation of one primitive's field at one point; each ray, to the eye
//! or to a light, counts as one more. Rays of a packet share the evaluations that are made for all
//! of them at once; those that are made for the packets of a whole square, or of a patch in the
//! light, are not counted, as it depends on the tile which packet asks for them first. A pixel
//! shows the mean of its rays. Work is counted and not timed, so that a map is the same wherever it
//! is made.
//!
//! White is the cost of the most expensive pixel. As tiles are traced independently, each
//! determines it from the same sample, one packet in every 16×16 pixels; even more expensive pixels
//! are white as well.
use crate::area::Area;
use crate::layout::PACKET_SIZE;
use crate::sample::Sample;
use crate::sample_cache::SampleCache;
use crate::sampler::Sampler;
use crate::stats::Stats;
use crate::workspace::Workspace;
use glam::Vec3;
use std::sync::OnceLock;

/// Distance of sampled packets, in pixels.
const APART: u32 = 16;

/// Conversion of costs to grey.
#[derive(Debug)]
pub(crate) struct Map {
    power: f32,
    dearest: OnceLock<f32>,
}

impl Map {
    /// Returns the conversion that raises costs, as shares of the largest, to 1/gamma.
    pub fn new(gamma: f32) -> Self {
        Self {
            power: if gamma > 0.0 { 1.0 / gamma } else { 1.0 },
            dearest: OnceLock::new(),
        }
    }

    /// Returns the cost that is shown as white. `None` if `stop` returned true before it was
    /// determined.
    pub fn dearest(&self, sampler: &Sampler, stop: &dyn Fn() -> bool) -> Option<f32> {
        if let Some(dearest) = self.dearest.get() {
            return Some(*dearest);
        }
        let mut dearest = 1.0_f32;
        let (cache, mut work) = (SampleCache::default(), Workspace::default());
        let [width, height] = sampler.view.size;
        for top in (0..height).step_by(APART as usize) {
            for left in (0..width).step_by(APART as usize) {
                let area = Area {
                    left,
                    top,
                    right: (left + PACKET_SIZE[0]).min(width),
                    bottom: (top + PACKET_SIZE[1]).min(height),
                };
                let stats = &mut Stats::default();
                let samples = sampler.sample(area, 1, &cache, stop, &mut work, stats)?;
                let costs = area.pixels().map(|(x, y)| samples.get(x, y).cost);
                dearest = costs.fold(dearest, f32::max);
            }
        }
        Some(*self.dearest.get_or_init(|| dearest))
    }

    /// Returns the grey of a sample.
    pub fn grey(&self, sample: &Sample, dearest: f32) -> Vec3 {
        let share = (sample.cost / dearest).clamp(0.0, 1.0);
        Vec3::splat(if self.power == 1.0 {
            share
        } else {
            libm::powf(share, self.power)
        })
    }
}
