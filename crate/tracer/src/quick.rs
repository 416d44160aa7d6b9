//! The quick way to the soft surface, where it is made of lumps alone: points and Gaussian segments.
//!
//! The lumps near a square of pixels are listed once, those near each of its parts when a packet in it asks, those near
//! the packet anew for each; then [`climb`](mod@crate::climb) follows the packet's rays.
use crate::beam::Beam;
use crate::climb::{Climbed, Lump, Way, climb};
use crate::nearby::Nearby;
use crate::ray::Ray;
use crate::soft::{PACKET, Soft};
use field::{Kernel, Primitive, Real};
use glam::DVec3;
use wide::f32x8;

/// Each lump is followed until its field is below this much of T, divided by their number: all that is left out
/// is at most this.
pub const LEFT_OUT: f64 = 1e-4;

/// A lump is said to be strong up to this part of the way from its own surface to where its reach ends, as
/// squares of distances.
const STRONG: f32 = 0.15;

/// Working space of one thread.
#[derive(Default)]
pub struct Quick {
    lumps: Vec<Lump>,
    /// The primitives that a packet's hits depend on.
    pub numbers: Vec<u32>,
}

/// Rays of a packet, counted from a list's base.
struct Rays {
    origin: [f32x8; 3],
    direction: [f32x8; 3],
    beam: Beam,
}

impl Rays {
    fn new(rays: &[Ray; PACKET], near: &Nearby) -> Self {
        let start = rays.map(|ray| ray.at(near.base) - near.middle);
        let origin = core::array::from_fn(|k| f32x8::from_lanes(|i| start[i][k]));
        let direction = core::array::from_fn(|k| f32x8::from_lanes(|i| rays[i].direction[k]));
        let (offset, radius) = around(origin);
        let (axis, spread) = around(direction);
        let beam = Beam {
            axis: Ray {
                origin: near.middle + offset,
                direction: axis,
            },
            radius,
            spread,
        };
        Self {
            origin,
            direction,
            beam,
        }
    }
}

/// A place amid eight, and how far they are from it at most.
fn around(places: [f32x8; 3]) -> (DVec3, f64) {
    let middle = places.map(|x| x.reduce_add() / PACKET as f32);
    let [x, y, z]: [f32x8; 3] = core::array::from_fn(|i| places[i] - f32x8::splat(middle[i]));
    let square = (x * x + y * y + z * z).to_array();
    let widest = square.into_iter().fold(0.0, f32::max);
    (
        DVec3::from_array(middle.map(f64::from)),
        f64::from(widest).sqrt() * 1.001 + 1e-7,
    )
}

impl Soft {
    /// Finds the first crossing, from outside to inside, of the rays of a packet. `None` if this is not the way
    /// to find it.
    pub fn quick(
        &self,
        near: &Nearby,
        rays: &[Ray; PACKET],
        limits: &[f64; PACKET],
        alive: u32,
        work: &mut Quick,
    ) -> Option<Climbed> {
        let lanes = Rays::new(rays, near);
        let nothing = Climbed {
            t: f32x8::splat(0.0),
            met: 0,
            evaluations: 0,
        };
        let far = f32x8::splat(f32::INFINITY);
        let (mut from, mut to, mut guess) = (far, -far, far);
        let mut evaluations = 0;
        work.lumps.clear();
        let limit = f32x8::from_lanes(|i| (limits[i] - near.base).min(1e30));
        near.each_near(&lanes.beam, |list, index| {
            let (number, center, radius) = list.get(index);
            let primitive = &self.primitives[number as usize];
            let square = primitive.lump_square(radius);
            let course = primitive.course(center.map(f32x8::splat), lanes.origin, lanes.direction);
            let [enters, leaves] = course.within(f32x8::splat(square));
            let enters = enters.fast_max(f32x8::splat(0.0));
            let leaves = leaves.fast_min(limit);
            let meets = enters.simd_le(leaves);
            evaluations += 8;
            if meets.to_bitmask() & alive == 0 {
                return;
            }
            let lump_from = meets.select(enters, far);
            let lump_to = meets.select(leaves, -far);
            from = from.fast_min(lump_from);
            to = to.fast_max(lump_to);
            let core = self.core(primitive, square);
            let strong = course.within(f32x8::splat(core + STRONG * (square - core)));
            let [core, out] = course.within(f32x8::splat(core));
            let inside = meets & enters.simd_le(core) & core.simd_le(out);
            guess = guess.fast_min(inside.select(core, far));
            work.lumps.push(Lump {
                course,
                from: least(lump_from),
                to: -least(-lump_to),
                strong,
                number,
            });
        });
        if work.lumps.is_empty() {
            return Some(nothing);
        }
        work.lumps.sort_by(|a, b| a.from.total_cmp(&b.from));
        let alive = alive & from.simd_le(to).to_bitmask();
        let way = Way {
            from,
            to,
            guess,
            alive,
            tolerance: 5e-5,
        };
        let mut climbed = climb(&work.lumps, &way)?;
        climbed.evaluations += evaluations;
        work.numbers.clear();
        if climbed.met != 0 {
            let met = climbed.met;
            let at = climbed.t.to_array();
            let hits = || (0..PACKET).filter(|i| met >> i & 1 != 0).map(|i| at[i]);
            let (first, last) =
                hits().fold((f32::INFINITY, 0.0f32), |(a, b), t| (a.min(t), b.max(t)));
            let numbers = work
                .lumps
                .iter()
                .filter(|lump| lump.from <= last && first <= lump.to)
                .map(|lump| lump.number);
            work.numbers.extend(numbers);
            work.numbers.sort_unstable();
        }
        Some(climbed)
    }

    /// Where a lump alone would have its surface: the square of the distance in kernel widths, or a guess at it.
    fn core(&self, primitive: &Primitive, square: f32) -> f32 {
        if primitive.kernel == Kernel::Gauss {
            // amplitude·e^(−square) is what is left out.
            square + self.left_out_logarithm
        } else {
            0.4 * square
        }
    }
}

/// The least of eight numbers.
fn least(x: f32x8) -> f32 {
    x.to_array().into_iter().fold(f32::INFINITY, f32::min)
}
