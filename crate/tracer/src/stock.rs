//! A scene's lumps, ready to be listed: what lists say of each is computed once.
use crate::beam::Beam;
use crate::hierarchy::Hierarchy;
use crate::nearby::{Extent, Near, Nearby, Other};
use crate::soft::NEXT_TO_NOTHING;
use field::{Bead, Cut, Lump, Primitive, THRESHOLD};
use glam::DVec3;
use std::collections::BTreeMap;
use std::ops::Range;

/// Each lump is followed until its field is below this much of T, divided by the scene's number of primitives.
const LEFT_OUT: f64 = 2e-6;

/// In kernel widths. At a Gaussian's own surface −F″ ≤ 2T; with h = 0.6, `h²·2T` is about what the climb
/// allows ([`climb`](mod@crate::climb)).
const LEAD: f64 = 0.6;

/// Of each of a scene's primitives what lists of lumps say of it, if it is one, or is as good as a sum of them.
#[derive(Default)]
pub struct Stock {
    items: Vec<Item>,
    /// Where each primitive's items end; they start where those of the primitive before it do.
    ends: Vec<u32>,
    /// Less than this of each lump is next to nothing.
    least: f64,
}

struct Item {
    middle: DVec3,
    near: Near,
    extent: Extent<f32>,
}

/// Where there are more primitives that are no lumps, most packets meet one.
const MOST_OTHERS: usize = 16;

/// Bones are cut into beads until there are this many in a scene.
const MOST_BEADS: usize = 1 << 17;

impl Stock {
    /// The lumps among a scene's primitives, given with their finishes and the bodies' ranges of primitives.
    #[must_use]
    pub fn new(primitives: &[Primitive], finish: &[u32], bodies: &[Range<u32>]) -> Self {
        let mut beads = 0;
        let strings: BTreeMap<usize, Vec<Bead>> = primitives
            .iter()
            .enumerate()
            .filter_map(|(i, p)| {
                let own = (beads < MOST_BEADS).then(|| p.beads()).flatten()?;
                beads += own.len();
                Some((i, own))
            })
            .collect();
        let left_out = LEFT_OUT * THRESHOLD / (primitives.len() + beads).max(1) as f64;
        let mut stock = Self {
            items: Vec::with_capacity(primitives.len() + beads),
            ends: Vec::with_capacity(primitives.len()),
            least: NEXT_TO_NOTHING / LEFT_OUT * left_out,
        };
        let mut body = 0;
        for (i, p) in primitives.iter().enumerate() {
            while bodies[body as usize].end as usize <= i {
                body += 1;
            }
            let item = |lump: Lump<f32>, middle: DVec3, square: f64, core: f64, part: bool| Item {
                middle,
                near: Near {
                    lump,
                    middle: [0.0; 3],
                    square: square as f32,
                    // A little inside, so that rounding does not put it outside.
                    core: core as f32 - 1e-4,
                    part,
                    lead: (LEAD / lump.ceiling().scale) as f32,
                    steep: lump.steepness(core) as f32,
                    finish: finish[i],
                    body,
                    from: 0.0,
                },
                extent: Extent::of(&lump, lump.radius(square)),
            };
            if let Some(lump) = p.lump::<f32>() {
                let square = lump.reach(left_out);
                let core = lump.core(square, left_out);
                stock
                    .items
                    .push(item(lump, p.lump_middle(), square, core, false));
            } else if let Some(beads) = strings.get(&i) {
                let lumps: Option<Vec<_>> = beads.iter().map(Bead::lump).collect();
                let own = lumps.into_iter().flatten().zip(beads).map(|(lump, bead)| {
                    // Where the bone has its surface if it goes on as it is there.
                    let value = p.value(bead.center.to_array());
                    let square = lump.reach(left_out);
                    let core = libm::log(value / THRESHOLD).min(square);
                    item(lump, bead.center, square, core, true)
                });
                stock.items.extend(own);
            }
            stock.ends.push(stock.items.len() as u32);
        }
        stock
    }

    /// The items of a primitive.
    fn of(&self, primitive: usize) -> &[Item] {
        let start = primitive
            .checked_sub(1)
            .map_or(0, |before| self.ends[before]);
        &self.items[start as usize..self.ends[primitive] as usize]
    }

    /// The ball (middle, radius) beyond which a primitive is not followed, if it is a lump or some.
    #[must_use]
    pub fn ball(&self, primitive: usize) -> Option<(DVec3, f64)> {
        let items = self.of(primitive);
        let middle = items.iter().map(|item| item.middle).sum::<DVec3>() / items.len() as f64;
        let reach = |item: &Item| item.middle.distance(middle) + f64::from(item.extent.radius);
        let radius = items.iter().map(reach).reduce(f64::max)?;
        Some((middle, radius))
    }

    /// The balls beyond which each primitive is next to nothing, given those beyond which it is not followed.
    #[must_use]
    pub fn reaches(&self, tree: &Hierarchy) -> Hierarchy {
        tree.enlarged(|i, center, radius| {
            let reach = |item: &Item| {
                let lump = &item.near.lump;
                item.middle.distance(center) + lump.radius(lump.reach(self.least))
            };
            let items = self.of(i as usize).iter();
            items.map(reach).fold(radius, Cut::at_least)
        })
    }

    /// Whether a primitive that is a lump, or some, can be more than `level` in a ball; others are taken to be.
    #[must_use]
    pub fn counts(&self, primitive: usize, center: DVec3, radius: f64, level: f64) -> bool {
        let items = self.of(primitive);
        let more = |item: &Item| {
            let (away, half) = (center - item.middle, item.near.lump.half());
            let share = away.dot(half) / half.length_squared().max(f64::MIN_POSITIVE);
            let apart = (away - half * share.clamp(-1.0, 1.0)).length();
            item.near.lump.ceiling().at((apart - radius).max(0.0)) > level
        };
        items.is_empty() || items.iter().any(more)
    }

    /// Lists the lumps near a beam, up to a parameter, and the few other primitives there. False if those are more than a few.
    /// `tree` holds the balls of all primitives, `reach` tells how far from its bone one is followed, given its ball's radius.
    pub fn list(
        &self,
        tree: &Hierarchy,
        beam: &Beam,
        limit: f64,
        reach: impl Fn(u32, f64) -> f64,
        list: &mut Nearby,
    ) -> bool {
        let mut found = Vec::new();
        let mut others = core::mem::take(&mut list.others);
        others.clear();
        tree.search(beam, |i, center, radius| {
            if beam.reach(center, radius)[0] >= limit || others.len() > MOST_OTHERS {
                return;
            }
            let items = self.of(i as usize);
            if items.is_empty() {
                others.push(Other {
                    primitive: i,
                    center,
                    radius,
                    reach: reach(i, radius),
                });
            }
            let first = self.ends[i as usize] as usize - items.len();
            for (k, item) in items.iter().enumerate() {
                let radius = f64::from(item.extent.radius);
                let near = beam.reach(item.middle, radius)[0];
                if near < limit && (items.len() == 1 || beam.meets(item.middle, radius)) {
                    found.push(key(near, (first + k) as u32));
                }
            }
        });
        if others.len() > MOST_OTHERS {
            list.others = others;
            return false;
        }
        found.sort_unstable();
        let base = found.first().map_or(0.0, |&first| unkey(first).0);
        list.begin(beam.axis.at(base), base);
        list.others = others;
        for (near, i) in found.into_iter().map(unkey) {
            let item = &self.items[i as usize];
            let middle = (item.middle - list.middle).as_vec3().to_array();
            let from = (near - base) as f32;
            list.push(
                Near {
                    middle,
                    // Rounded down.
                    from: from - from * 1e-6,
                    ..item.near
                },
                &item.extent,
            );
        }
        true
    }
}

/// A parameter ≥ 0, rounded down to single precision, and an index, as one number that is larger for a larger parameter, or, if these
/// are the same, a larger index: such are sorted quickly.
fn key(parameter: f64, index: u32) -> u64 {
    // Not −0.
    let parameter = parameter + 0.0;
    let nearest = parameter as f32;
    let below = if f64::from(nearest) > parameter {
        nearest.next_down()
    } else {
        nearest
    };
    u64::from(below.to_bits()) << 32 | u64::from(index)
}

/// What [`key`] was made of.
fn unkey(key: u64) -> (f64, u32) {
    (f64::from(f32::from_bits((key >> 32) as u32)), key as u32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use field::{BlobScale, Kernel, Shaping, Skeleton};

    /// What is said not to count in a ball is nowhere in it more than the level; and what is more there counts.
    #[cfg_attr(target_arch = "wasm32", wasm_bindgen_test::wasm_bindgen_test)]
    #[cfg_attr(not(target_arch = "wasm32"), test)]
    fn what_does_not_count_is_small_all_through_a_ball() {
        let mut state = 4u64;
        let mut next = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(99);
            (state >> 33) as f64 / f64::from(1u32 << 31) * 2.0 - 1.0
        };
        let (mut counting, mut small) = (0, 0);
        for case in 0..60 {
            let mut place = || DVec3::new(next(), next(), next());
            let (a, b, c) = (place(), place(), place());
            let skeleton = match case % 3 {
                0 => Skeleton::Point { center: a },
                1 => Skeleton::Segment { base: a, apex: b },
                // As a string of beads.
                _ => Skeleton::Curve {
                    control: [a, b, c, a * 0.5],
                },
            };
            let shaping = Shaping {
                kernel: Kernel::Gauss,
                radius: 0.2 + 0.15 * next(),
                blobbiness: -2.0 + next(),
                blob_scale: BlobScale::Relative,
                strength: 1.0,
                influence: 1e-3,
                taper: None,
            };
            let primitive = Primitive::new(skeleton, &shaping, None).expect("flesh");
            let stock = Stock::new(
                core::slice::from_ref(&primitive),
                &[0],
                core::slice::from_ref(&(0..1)),
            );
            assert!(stock.ball(0).is_some(), "{case} is no sum of lumps");
            for _ in 0..40 {
                let center = DVec3::new(next(), next(), next());
                let radius = 0.4 * next().abs();
                // Beads share what the bone has, each at its own place.
                let level = libm::exp10(-4.0 + 3.0 * next());
                let value = |p: DVec3| primitive.value(p.to_array());
                let within = (0..60).map(|_| {
                    let aside = DVec3::new(next(), next(), next());
                    center + aside.normalize_or_zero() * (radius * next().abs())
                });
                let most = within.map(value).fold(value(center), f64::max);
                let items = stock.of(0).len() as f64;
                if stock.counts(0, center, radius, level) {
                    counting += 1;
                } else {
                    small += 1;
                    assert!(
                        most <= level * items * (1.0 + 1e-3),
                        "{case}: {most} > {level} of {items}"
                    );
                }
            }
        }
        assert!(counting > 200 && small > 200, "{counting} {small}");
    }

    #[cfg_attr(target_arch = "wasm32", wasm_bindgen_test::wasm_bindgen_test)]
    #[cfg_attr(not(target_arch = "wasm32"), test)]
    fn what_is_no_lump_counts_anywhere() {
        let shaping = Shaping {
            kernel: Kernel::Cauchy,
            radius: 0.2,
            blobbiness: -2.0,
            blob_scale: BlobScale::Relative,
            strength: 1.0,
            influence: 1e-3,
            taper: None,
        };
        let corners = [DVec3::X, DVec3::Y, DVec3::Z];
        let face = Primitive::new(Skeleton::Triangle { corners }, &shaping, None).expect("flesh");
        let stock = Stock::new(&[face], &[0], core::slice::from_ref(&(0..1)));
        assert!(stock.ball(0).is_none());
        assert!(stock.counts(0, DVec3::splat(1e6), 0.1, 1.0));
    }

    #[cfg_attr(target_arch = "wasm32", wasm_bindgen_test::wasm_bindgen_test)]
    #[cfg_attr(not(target_arch = "wasm32"), test)]
    fn keys_are_in_order_and_never_above() {
        let places = [
            -0.0,
            0.0,
            1e-60,
            1e-40,
            0.1,
            1.0,
            1.0 + 1e-12,
            7.3,
            1e30,
            1e60,
        ];
        let mut before = 0;
        for (i, place) in places.into_iter().enumerate() {
            let key = key(place, i as u32);
            let (below, index) = unkey(key);
            assert_eq!(index as usize, i);
            let least = (place * (1.0 - 2e-7) - 1e-44).min(f64::from(f32::MAX));
            assert!((least..=place).contains(&below), "{place}: {below}");
            assert!(key >= before, "{place}");
            before = key;
        }
        // What single precision cannot tell apart is in the order of the indices.
        assert!(key(1.0 + 1e-12, 3) < key(1.0, 4) && key(1.0, 9) < key(1.1, 2));
    }
}
