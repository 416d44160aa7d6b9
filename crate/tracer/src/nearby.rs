//! The lumps near a beam of rays, and those of them near a narrower one.
//!
//! Lists are in order of the distance at which a lump can first be met, their places relative to a point in
//! the beam, so that single precision is enough for them; eight are judged at a time.
use crate::beam::Beam;
use field::Lump;
use glam::DVec3;
use wide::f32x8;

/// Lumps, each within a ball.
#[derive(Clone, Debug, Default)]
pub struct Nearby {
    /// Places are counted from here …
    pub middle: DVec3,
    /// … and ray parameters from this one.
    pub base: f64,
    lumps: Vec<Near>,
    /// Centre and radius: x, y, z, radius of eight lumps at a time.
    balls: Vec<[[f32; 8]; 4]>,
}

/// A lump in a list.
#[derive(Clone, Copy, Debug)]
pub struct Near {
    /// Its field.
    pub lump: Lump<f32>,
    /// Its place.
    pub middle: [f32; 3],
    /// It is followed up to this square of the distance from its bone, in kernel widths.
    pub square: f32,
    /// Alone it would have its surface there.
    pub core: f32,
    /// Its material.
    pub material: u32,
}

/// A ball that no beam meets.
const NOWHERE: f32 = -1e30;

/// Places are rounded to single precision: squares of distances are off by no more than this part of them.
const ROUNDING: f32 = 1e-6;

impl Nearby {
    /// Begins a list that is counted from a beam's axis at a parameter.
    pub fn begin(&mut self, middle: DVec3, base: f64) {
        (self.middle, self.base) = (middle, base);
        self.lumps.clear();
        self.balls.clear();
    }

    /// Adds a lump with the radius of its ball; its place is counted from [`Nearby::middle`].
    pub fn push(&mut self, near: Near, radius: f64) {
        let [x, y, z] = near.middle;
        self.add(near, [x, y, z, radius as f32]);
    }

    #[inline(always)]
    fn add(&mut self, near: Near, ball: [f32; 4]) {
        let lane = self.lumps.len() % 8;
        if lane == 0 {
            self.balls
                .push([[0.0; 8], [0.0; 8], [0.0; 8], [NOWHERE; 8]]);
        }
        if let Some(last) = self.balls.last_mut() {
            for (all, one) in last.iter_mut().zip(ball) {
                all[lane] = one;
            }
        }
        self.lumps.push(near);
    }

    /// How many there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.lumps.len()
    }

    /// A lump.
    #[inline(always)]
    #[must_use]
    pub fn get(&self, index: usize) -> &Near {
        &self.lumps[index]
    }

    /// Puts those lumps whose balls a ray of a beam may meet into another list. The beam's parameters start
    /// at [`Nearby::base`].
    pub fn narrow(&self, beam: &Beam, into: &mut Self) {
        into.begin(self.middle, self.base);
        self.each_near(beam, |list, index| {
            let ball = list.balls[index / 8].map(|row| row[index % 8]);
            into.add(*list.get(index), ball);
        });
    }

    /// Calls `found` with the index of each lump that a ray of a beam may meet.
    #[inline(always)]
    pub fn each_near(&self, beam: &Beam, mut found: impl FnMut(&Self, usize)) {
        let offset = (beam.axis.origin - self.middle).as_vec3();
        let axis = beam.axis.direction.as_vec3();
        let [ox, oy, oz] = offset.to_array().map(f32x8::splat);
        let [ax, ay, az] = axis.to_array().map(f32x8::splat);
        // Every beam of a picture is much narrower than this.
        let grow = f32x8::splat((beam.spread / (1.0 - beam.spread.min(0.5))) as f32 * 1.001);
        let wide = f32x8::splat(beam.radius as f32 * 1.001 + 1e-7);
        let all = beam.spread >= 0.5;
        for (block, [x, y, z, radius]) in self.balls.iter().enumerate() {
            let [x, y, z] = [
                f32x8::new(*x) - ox,
                f32x8::new(*y) - oy,
                f32x8::new(*z) - oz,
            ];
            let radius = f32x8::new(*radius);
            let square = x * x + y * y + z * z;
            let along = x * ax + y * ay + z * az;
            let across = square - along * along;
            // A ray's point at t is within radius + spread·t of the axis' point, so in the ball t is at most
            // (along + reach)/(1 − spread).
            let reach = radius + wide;
            let ahead = along + reach;
            let widest = reach + grow * ahead.fast_max(f32x8::splat(0.0));
            let near = across.simd_le(widest * widest + square * f32x8::splat(ROUNDING))
                & ahead.simd_ge(f32x8::splat(0.0))
                & radius.simd_ge(f32x8::splat(0.0));
            let mut bits = near.to_bitmask();
            if all {
                bits = radius.simd_ge(f32x8::splat(0.0)).to_bitmask();
            }
            while bits != 0 {
                let lane = bits.trailing_zeros() as usize;
                bits &= bits - 1;
                found(self, block * 8 + lane);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ray::Ray;
    use field::{Kernel, Primitive, Shaping, Skeleton};

    #[cfg_attr(target_arch = "wasm32", wasm_bindgen_test::wasm_bindgen_test)]
    #[cfg_attr(not(target_arch = "wasm32"), test)]
    fn no_lump_that_a_ray_meets_is_left_out_and_most_others_are() {
        let mut state = 17u64;
        let mut next = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(99);
            (state >> 33) as f64 / f64::from(1u32 << 31) * 2.0 - 1.0
        };
        let shaping = Shaping {
            kernel: Kernel::Gauss,
            radius: 0.1,
            blobbiness: -4.0,
            blob_scale: field::BlobScale::Relative,
            strength: 1.0,
            influence: 1e-3,
            taper: None,
        };
        let point = Skeleton::Point {
            center: DVec3::ZERO,
        };
        let primitive = Primitive::new(point, &shaping, None).expect("flesh");
        let lump = primitive.lump().expect("a lump");
        let (mut kept, mut all) = (0, 0);
        for _ in 0..60 {
            // Far from the origin, where single precision would not do without a place amid the lumps.
            let middle = DVec3::new(next(), next(), next()) * 1e4;
            let mut list = Nearby::default();
            list.begin(middle, 0.0);
            let balls: Vec<(DVec3, f64)> = (0..300)
                .map(|_| {
                    (
                        middle + 3.0 * DVec3::new(next(), next(), next()),
                        0.2 * next().abs(),
                    )
                })
                .collect();
            for (i, &(center, radius)) in balls.iter().enumerate() {
                let near = Near {
                    lump,
                    middle: (center - middle).as_vec3().to_array(),
                    square: 1.0,
                    core: 1.0,
                    material: i as u32,
                };
                list.push(near, radius);
            }
            let beam = Beam {
                axis: Ray {
                    origin: middle + 4.0 * DVec3::new(next(), next(), next()),
                    direction: DVec3::new(next(), next(), next()).normalize(),
                },
                radius: 0.02 * next().abs(),
                spread: 0.1 * next().abs(),
            };
            let mut narrow = Nearby::default();
            list.narrow(&beam, &mut narrow);
            let found: Vec<u32> = (0..narrow.len()).map(|i| narrow.get(i).material).collect();
            kept += found.len();
            all += balls.len();
            for _ in 0..200 {
                let offset = DVec3::new(next(), next(), next()).normalize() * beam.radius * 0.999;
                let turn = DVec3::new(next(), next(), next()).normalize() * beam.spread * 0.999;
                let (origin, direction) = (beam.axis.origin + offset, beam.axis.direction + turn);
                for (i, &(center, radius)) in balls.iter().enumerate() {
                    let t = (center - origin).dot(direction).max(0.0) / direction.length_squared();
                    if (origin + direction * t).distance(center) < radius * (1.0 - 1e-6) {
                        assert!(found.contains(&(i as u32)), "{beam:?} {center} {radius}");
                    }
                }
            }
        }
        assert!(kept * 5 < all, "{kept} of {all}");
    }
}
