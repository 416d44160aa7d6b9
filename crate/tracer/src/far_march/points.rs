//! Near points of one kernel that add to the field: blobs, or spans where those are exact enough.
use super::piece::{Known, Piece};
use super::query::{FarWork, ROUNDING};
use crate::blob_march::{RayBlob, RayInterval, mask};
use crate::spans::Node;
use field::far_field::{decay, power};
use field::{Blob, Primitive, THRESHOLD};
use glam::DVec3;
use wide::f32x8;

/// Largest error of all spans in a cell together, in T.
const OF_SPANS: f64 = 3e-5 * THRESHOLD;
/// Largest number of changed points with which a hierarchy is taken over.
const MOST_CHANGED: usize = 64;
/// Rounding of one addition near T.
const ADDITION: f64 = 6e-8 * THRESHOLD;
/// Field of a point where it begins to be strong ([`RayBlob::strong`]).
const STRONG: f64 = 0.6 * THRESHOLD;
/// Distance from a point's own surface at which a ray is well outside, in kernel widths.
const LEAD: f64 = 0.3;

/// The points of a body.
pub struct Points {
    pub each: Vec<Point>,
    /// The kernel's exponent and softening.
    power: i32,
    softening: f32,
}

/// A point, prepared for marching.
pub struct Point {
    center: DVec3,
    pub blob: Blob<f32>,
    scale: f32,
    amplitude: f32,
    /// Squared distance, in kernel widths, of the point's own surface.
    core: f32,
    /// Squared distance, in kernel widths, up to which the point is strong.
    strong: f32,
    /// Distance from the point's own surface at which a ray is well outside.
    lead: f32,
}

impl Points {
    /// Prepares primitives; `None` unless all are points of one kernel that never ends.
    pub fn of(primitives: &[Primitive]) -> Option<Self> {
        let kernel = primitives.first()?.kernel;
        let (power, softening) = power(kernel)?;
        let mut each = Vec::with_capacity(primitives.len());
        for p in primitives {
            let blob: Blob<f32> = p.endless_point()?;
            if p.kernel != kernel {
                return None;
            }
            let [scale, amplitude] = blob.scale_and_amplitude();
            each.push(Point {
                center: p.blob_middle(),
                blob,
                scale,
                amplitude,
                core: blob.square_of(THRESHOLD) as f32,
                strong: blob.square_of(STRONG) as f32,
                lead: (LEAD / p.width) as f32,
            });
        }
        Some(Self {
            each,
            power,
            softening: softening as f32,
        })
    }

    /// Returns the numbers of the points that differ from those of others, in ascending order.
    /// `None` if more than [`MOST_CHANGED`] differ, or the kernel or the number of points does.
    pub fn changes_from(&self, others: &Self) -> Option<Vec<u32>> {
        if self.power != others.power || self.each.len() != others.each.len() {
            return None;
        }
        let mut changed = Vec::new();
        for (i, (own, other)) in self.each.iter().zip(&others.each).enumerate() {
            if own.center != other.center
                || own.scale != other.scale
                || own.amplitude != other.amplitude
            {
                if changed.len() == MOST_CHANGED {
                    return None;
                }
                changed.push(i as u32);
            }
        }
        Some(changed)
    }

    /// Collects the blobs of a piece, and the backdrop of all other points, with its error. `None`
    /// if the field is below T in the whole piece.
    pub fn prepare(&self, piece: &Piece<'_>, work: &mut FarWork) -> Option<Known> {
        let cell = piece.cell;
        let count = cell.near.len();
        let axis = piece.axis;
        let length = 2.0 * piece.half;
        // Bounds on fourth derivatives: (e)₄·s⁴·b^(−e−4).
        let rising = f64::from((self.power..self.power + 4).product::<i32>());
        let quartic = f32x8::splat((rising * length * length * length * length / 384.0) as f32);
        let share = f32x8::splat((OF_SPANS / count.max(1) as f64) as f32);
        let (half, width) = (
            f32x8::splat(piece.half as f32),
            f32x8::splat((piece.width * (1.0 + 1e-5) + 1e-7) as f32),
        );
        let zero = f32x8::splat(0.0);
        let softening = f32x8::splat(self.softening);
        let mut most = f32x8::splat(0.0);
        work.places.clear();
        work.blobs.clear();
        work.intervals.clear();
        let mut weak = [Node {
            value: zero,
            slope: zero,
        }; 2];
        let mut pending: Vec<u32> = core::mem::take(&mut work.strong);
        pending.clear();
        let mut weaker = core::mem::take(&mut work.weak);
        weaker.clear();
        let mut error = f32x8::splat(0.0);
        for (block, numbers) in cell.near.chunks(8).enumerate() {
            let mut places = [[0.0f32; 8]; 3];
            let (mut scale, mut amplitude) = ([0.0f32; 8], [0.0f32; 8]);
            for (lane, &number) in numbers.iter().enumerate() {
                let point = &self.each[number as usize];
                let place = (point.center - piece.middle).as_vec3().to_array();
                work.places.push(place);
                for (row, x) in places.iter_mut().zip(place) {
                    row[lane] = x;
                }
                (scale[lane], amplitude[lane]) = (point.scale, point.amplitude);
            }
            let [x, y, z] = places.map(f32x8::new);
            let (scale, amplitude) = (f32x8::new(scale), f32x8::new(amplitude));
            let along = x * axis[0] + y * axis[1] + z * axis[2];
            let along = along.fast_max(-half).fast_min(half);
            let [x, y, z] = [
                x - along * axis[0],
                y - along * axis[1],
                z - along * axis[2],
            ];
            let apart = ((x * x + y * y + z * z).sqrt() - width).fast_max(zero) * scale;
            let inverse = f32x8::splat(1.0) / (softening + apart * apart);
            let size = amplitude * decay(self.power, inverse);
            most += size;
            let square = scale * scale;
            let off = quartic * size * (square * square) * (inverse * inverse);
            let is_weak = off.simd_le(share).to_bitmask();
            let there = (1u32 << numbers.len()) - 1;
            error += mask(is_weak & there) & off;
            for lane in 0..numbers.len() as u32 {
                let index = 8 * block as u32 + lane;
                if is_weak >> lane & 1 != 0 {
                    weaker.push(index);
                } else {
                    pending.push(index);
                }
            }
        }
        let near_most: f32 = most.to_array().iter().sum();
        let above = f64::from(near_most) * (1.0 + 1e-5) + cell.far_most;
        let lost: f32 = error.to_array().iter().sum();
        let error = cell.error + f64::from(lost) * (1.0 + 1e-4);
        let empty = above < THRESHOLD - ROUNDING;
        if !empty {
            let ends = [-half, half].map(|t| piece.places(t));
            let power = f32x8::splat(self.power as f32);
            for &index in &weaker {
                let point = &self.each[cell.near[index as usize] as usize];
                let place = work.places[index as usize].map(f32x8::splat);
                for (sum, end) in weak.iter_mut().zip(&ends) {
                    let [x, y, z]: [f32x8; 3] = core::array::from_fn(|i| end[i] - place[i]);
                    let square = f32x8::splat(point.scale * point.scale);
                    let inverse =
                        f32x8::splat(1.0) / (softening + square * (x * x + y * y + z * z));
                    let value = f32x8::splat(point.amplitude) * decay(self.power, inverse);
                    let [dx, dy, dz] = piece.direction;
                    let pace = x * dx + y * dy + z * dz;
                    sum.value += value;
                    sum.slope -= power * value * inverse * square * pace;
                }
            }
            work.evaluations += 16 * weaker.len() as u64;
            let direction = piece.direction;
            let from = piece.origin.map(|x| -x);
            for &index in &pending {
                let point = &self.each[cell.near[index as usize] as usize];
                let place = work.places[index as usize];
                let middle = core::array::from_fn(|i| f32x8::splat(place[i]) + from[i]);
                work.intervals.push(RayInterval {
                    from: f32::NEG_INFINITY,
                    to: f32::INFINITY,
                    blob: work.blobs.len() as u32,
                });
                work.blobs.push(RayBlob {
                    on_ray: point.blob.on_ray(middle, direction),
                    strong: point.strong,
                    index,
                });
            }
        }
        (work.strong, work.weak) = (pending, weaker);
        if empty {
            return None;
        }
        let mut backdrop = piece.far();
        piece.add_span(&mut backdrop, weak);
        let added = ADDITION * count as f64;
        Some(Known {
            backdrop,
            error: error + added,
        })
    }

    /// Estimates the parameters at which rays cross: where they enter a point's own surface, and a
    /// little before.
    pub fn guess(&self, piece: &Piece<'_>, work: &FarWork) -> [f32x8; 2] {
        let far = f32x8::splat(f32::INFINITY);
        let start = f32x8::splat(-piece.half as f32);
        let (mut guess, mut first) = (far, far);
        for blob in &work.blobs {
            let point = &self.each[piece.cell.near[blob.index as usize] as usize];
            let [core, out] = blob.on_ray.within(f32x8::splat(point.core));
            let inside = start.simd_le(core) & core.simd_le(out) & core.simd_lt(guess);
            first = inside.select(core - f32x8::splat(point.lead), first);
            guess = inside.select(core, guess);
        }
        [guess, first]
    }
}
