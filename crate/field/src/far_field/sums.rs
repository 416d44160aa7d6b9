//! Sums of primitives at the nodes of a box, in single precision, with bounds on their rounding.
use super::expansion::{Expansion, Fitted, LEBESGUE, VECTORS};
use super::source::{Seen, Source};
use super::{Cell, FarField, MISPLACED};
use crate::{Cut, Kernel, Primitive};
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
    whole: [f32x8; VECTORS],
    partial: [f32x8; VECTORS],
    pub count: usize,
    /// Sum of the bounds on the primitives' sizes.
    pub size: f64,
    /// Bound on the effect of rounded places.
    loss: f64,
}

impl<'f> NodeSums<'f> {
    pub fn new(field: &'f FarField, center: DVec3, half: f64) -> Self {
        Self {
            nodes: &field.nodes,
            center,
            half,
            whole: [f32x8::splat(0.0); VECTORS],
            partial: [f32x8::splat(0.0); VECTORS],
            count: 0,
            size: 0.0,
            loss: 0.0,
        }
    }

    pub fn add(&mut self, source: &Source, primitive: &Primitive, seen: &Seen) {
        self.size += seen.magnitude;
        let coordinates = self.center.abs().max_element() + self.half;
        self.loss += seen.magnitude * (MISPLACED * coordinates * seen.steep).at_most(1.0);
        self.count += 1;
        if let Some(amplitude) = source.point {
            // Relative to the box, in kernel widths: single precision then has its digits whatever the place.
            let scale = source.finest;
            let away = ((self.center - source.center) * scale).as_vec3();
            self.add_point(
                source.kernel,
                away.to_array(),
                (self.half * scale) as f32,
                amplitude,
            );
        } else {
            let half = f32x8::splat(self.half as f32);
            let center = self.center.as_vec3().to_array();
            for (sum, node) in self.partial.iter_mut().zip(self.nodes) {
                let place = core::array::from_fn(|i| f32x8::splat(center[i]) + node[i] * half);
                *sum += primitive.value::<f32x8>(place);
            }
        }
        if self.count.is_multiple_of(PARTIAL_SUM) {
            for (whole, partial) in self.whole.iter_mut().zip(&mut self.partial) {
                *whole += *partial;
                *partial = f32x8::splat(0.0);
            }
        }
    }

    fn add_point(&mut self, kernel: Kernel, away: [f32; 3], half: f32, amplitude: f32) {
        let [x, y, z] = away.map(f32x8::splat);
        let (half, amplitude) = (f32x8::splat(half), f32x8::splat(amplitude));
        let mut all = |value: &dyn Fn(f32x8) -> f32x8| {
            for (sum, node) in self.partial.iter_mut().zip(self.nodes) {
                let [dx, dy, dz] = [x + node[0] * half, y + node[1] * half, z + node[2] * half];
                *sum += amplitude * value(dx * dx + dy * dy + dz * dz);
            }
        };
        if kernel == Kernel::Cauchy {
            let one = f32x8::splat(1.0);
            return self.add_cauchy([x, y, z], half, amplitude, one);
        }
        all(&|square| kernel.falling(square).0);
    }

    /// [`NodeSums::add_point`] for the most common kernel, as a loop without calls.
    #[inline(always)]
    fn add_cauchy(&mut self, [x, y, z]: [f32x8; 3], half: f32x8, amplitude: f32x8, one: f32x8) {
        for (sum, node) in self.partial.iter_mut().zip(self.nodes) {
            let [dx, dy, dz] = [x + node[0] * half, y + node[1] * half, z + node[2] * half];
            let base = one + dx * dx + dy * dy + dz * dz;
            *sum += amplitude / (base * base);
        }
    }

    /// Bound on the rounding of the sums, as the interpolant's error.
    pub fn rounding(&self) -> f64 {
        let [own, addition] = ROUNDING;
        let additions = (PARTIAL_SUM + self.count / PARTIAL_SUM + 2) as f64;
        LEBESGUE * (self.size * (own + addition * additions) + self.loss)
    }

    /// Returns the polynomial of the sums and of the parent's.
    pub fn fit(self, parent: Option<&Cell>) -> Fitted {
        let all: [f32x8; VECTORS] = core::array::from_fn(|i| self.whole[i] + self.partial[i]);
        let more = parent.map(|parent| {
            let outer = 1.0 / parent.reach();
            let shift = ((self.center - parent.center) * outer).to_array();
            parent.expansion.moved(shift, self.half * outer)
        });
        Expansion::fit(&all, more.as_ref())
    }
}
