//! Sums of primitives at the nodes of a box, with bounds on their rounding.
use super::expansion::{ALL, LEBESGUE, NODES, Series, VECTORS, axis};
use super::source::{Seen, Source};
use super::{MISPLACED, decay};
use crate::{Cut, Primitive};
use glam::DVec3;
use wide::f32x8;

/// Number of values in a partial sum of single precision.
const PARTIAL_SUM: usize = 32;
/// Rounding of a primitive's value in single precision, relative to it, and of one addition.
const ROUNDING: [f64; 2] = [2e-6, 6e-8];

/// Sums of primitives at the nodes of a box.
pub struct NodeSums<'f> {
    nodes: &'f [[f32x8; 3]; VECTORS],
    center: DVec3,
    half: f64,
    whole: [f64; ALL],
    /// Sums of points, of which eight are added at a time, in single precision.
    partial: [f32x8; ALL],
    blocks: usize,
    waiting: Waiting,
    /// Sum of the bounds on the primitives' sizes.
    pub size: f64,
    /// Bound on the effect of rounded places.
    loss: f64,
}

/// Points of one kernel that wait to be added, up to eight.
#[derive(Default)]
struct Waiting {
    count: usize,
    power: i32,
    softening: f32,
    /// The box's middle as seen from each, and half the box's side, in kernel widths.
    away: [[f32; 8]; 3],
    half: [f32; 8],
    amplitude: [f32; 8],
}

impl<'f> NodeSums<'f> {
    pub fn new(nodes: &'f [[f32x8; 3]; VECTORS], center: DVec3, half: f64) -> Self {
        Self {
            nodes,
            center,
            half,
            whole: [0.0; ALL],
            partial: [f32x8::splat(0.0); ALL],
            blocks: 0,
            waiting: Waiting::default(),
            size: 0.0,
            loss: 0.0,
        }
    }

    pub fn add(&mut self, source: &Source, primitive: &Primitive, seen: &Seen) {
        self.size += seen.magnitude;
        let coordinates = self.center.abs().max_element() + self.half;
        self.loss += seen.magnitude * (MISPLACED * coordinates * seen.steep).at_most(1.0);
        if let Some(amplitude) = source.point {
            self.add_point(source, amplitude);
            return;
        }
        let half = f32x8::splat(self.half as f32);
        let center = self.center.as_vec3().to_array();
        for (eight, node) in self.whole.chunks_mut(8).zip(self.nodes) {
            let place = core::array::from_fn(|i| f32x8::splat(center[i]) + node[i] * half);
            let values = primitive.value::<f32x8>(place).to_array();
            for (sum, value) in eight.iter_mut().zip(values) {
                *sum += f64::from(value);
            }
        }
    }

    fn add_point(&mut self, source: &Source, amplitude: f32) {
        if self.waiting.count == 8 || self.waiting.power != source.power {
            self.add_waiting();
        }
        let waiting = &mut self.waiting;
        (waiting.power, waiting.softening) = (source.power, source.softening as f32);
        // Relative to the box, in kernel widths: single precision then has its digits whatever the
        // place.
        let scale = source.finest;
        let away = ((self.center - source.center) * scale).as_vec3().to_array();
        let lane = waiting.count;
        for (row, x) in waiting.away.iter_mut().zip(away) {
            row[lane] = x;
        }
        waiting.half[lane] = (self.half * scale) as f32;
        waiting.amplitude[lane] = amplitude;
        waiting.count += 1;
    }

    /// Adds the points that wait.
    fn add_waiting(&mut self) {
        let waiting = core::mem::take(&mut self.waiting);
        if waiting.count == 0 {
            return;
        }
        let (half, amplitude) = (f32x8::new(waiting.half), f32x8::new(waiting.amplitude));
        let nodes = axis();
        let squares = waiting.away.map(|away| {
            let away = f32x8::new(away);
            nodes.map(|node| {
                let place = away + f32x8::splat(node) * half;
                place * place
            })
        });
        let softening = f32x8::splat(waiting.softening);
        let one = f32x8::splat(1.0);
        let rows = self.partial.chunks_exact_mut(NODES);
        for (at, row) in rows.enumerate() {
            let base = softening + squares[1][at % NODES] + squares[2][at / NODES];
            for (sum, x) in row.iter_mut().zip(squares[0]) {
                *sum += amplitude * decay(waiting.power, one / (base + x));
            }
        }
        self.blocks += 1;
        if self.blocks.is_multiple_of(PARTIAL_SUM) {
            self.carry();
        }
    }

    /// Adds the partial sums to the whole.
    fn carry(&mut self) {
        for (whole, partial) in self.whole.iter_mut().zip(&mut self.partial) {
            for value in partial.to_array() {
                *whole += f64::from(value);
            }
            *partial = f32x8::splat(0.0);
        }
    }

    /// Bound on the rounding of the sums, as the interpolant's error.
    pub fn rounding(&self) -> f64 {
        let [own, addition] = ROUNDING;
        LEBESGUE * (self.size * (own + addition * PARTIAL_SUM as f64) + self.loss)
    }

    /// Returns the interpolant of the sums.
    pub fn fit(mut self) -> Series {
        self.add_waiting();
        self.carry();
        Series::fit(&self.whole)
    }
}
