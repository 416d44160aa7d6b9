//! A scene's blobs, prepared for lists of nearby blobs.
use crate::beam::Beam;
use crate::hierarchy::Hierarchy;
use crate::nearby::{Extent, NearBlob, Nearby, Other};
use field::{Blob, ChainBlob, Cut, Primitive, THRESHOLD};
use glam::DVec3;
use std::ops::Range;

/// Largest sum, in T, of the fields that slabs leave out of their lists: below the accuracy of root
/// isolation, which uses those lists.
pub const NEXT_TO_NOTHING: f64 = 1e-10;

/// Field, as a fraction of T divided by the number of primitives, at which a blob's reach ends.
const BLOBS_LEFT_OUT: f64 = 2e-6;

/// [`NearBlob::lead`] in kernel widths. At a Gaussian's own surface −F″ ≤ 2T; with h = 0.6, `h²·2T`
/// is about what the march's proof allows ([`blob_march`](crate::blob_march)).
const LEAD: f64 = 0.6;

/// The blobs of each of a scene's primitives: itself, its blob chain, or none.
#[derive(Default)]
pub struct BlobSet {
    items: Vec<Item>,
    /// End of each primitive's items; they start at the end of the primitive before it.
    ends: Vec<u32>,
    /// Field of a blob below which it is negligible.
    least: f64,
}

/// A blob with the place of its middle in the world, and its extent.
struct Item {
    middle: DVec3,
    near: NearBlob,
    extent: Extent<f32>,
}

/// Most primitives in a list that are no blobs; with more of them nearly every packet meets one.
const MOST_OTHERS: usize = 16;

/// Number of points in a scene's blob chains after which no more chains are made.
const MOST_CHAINED: usize = 1 << 17;

impl BlobSet {
    /// Collects the blobs of a scene's primitives, given their finishes and the bodies' ranges of
    /// primitives.
    #[must_use]
    pub fn new(primitives: &[Primitive], finish: &[u32], bodies: &[Range<u32>]) -> Self {
        let mut chained = 0;
        let mut chains: Vec<(usize, Vec<ChainBlob>)> = Vec::new();
        for (i, p) in primitives.iter().enumerate() {
            if chained >= MOST_CHAINED {
                break;
            }
            if let Some(chain) = p.blob_chain() {
                chained += chain.len();
                chains.push((i, chain));
            }
        }
        let left_out = BLOBS_LEFT_OUT * THRESHOLD / (primitives.len() + chained).max(1) as f64;
        let mut blob_set = Self {
            items: Vec::with_capacity(primitives.len() + chained),
            ends: Vec::with_capacity(primitives.len()),
            least: NEXT_TO_NOTHING / BLOBS_LEFT_OUT * left_out,
        };
        let mut body = 0;
        for (i, p) in primitives.iter().enumerate() {
            while bodies[body as usize].end as usize <= i {
                body += 1;
            }
            let item = |blob: Blob<f32>, middle: DVec3, square: f64, core: f64, part: bool| Item {
                middle,
                near: NearBlob {
                    blob,
                    middle: [0.0; 3],
                    square: square as f32,
                    // Slightly inside, whatever the rounding.
                    core: core as f32 - 1e-4,
                    part,
                    lead: (LEAD / blob.ceiling().scale) as f32,
                    steep: blob.steepness(core) as f32,
                    finish: finish[i],
                    body,
                    from: 0.0,
                },
                extent: Extent::of(&blob, blob.radius(square)),
            };
            if let Some(blob) = p.blob::<f32>() {
                let square = blob.reach(left_out);
                let core = blob.core(square, left_out);
                blob_set
                    .items
                    .push(item(blob, p.blob_middle(), square, core, false));
            } else if let Ok(at) = chains.binary_search_by_key(&i, |chain| chain.0) {
                let chain = &chains[at].1;
                let blobs: Option<Vec<_>> = chain.iter().map(ChainBlob::blob).collect();
                for (blob, point) in blobs.into_iter().flatten().zip(chain) {
                    // The bone's surface, as if its field at the point were that of a Gaussian.
                    let value = p.value(point.center.to_array());
                    let square = blob.reach(left_out);
                    let core = libm::log(value / THRESHOLD).min(square);
                    blob_set
                        .items
                        .push(item(blob, point.center, square, core, true));
                }
            }
            blob_set.ends.push(blob_set.items.len() as u32);
        }
        blob_set
    }

    /// Returns the blobs of a primitive.
    fn of(&self, primitive: usize) -> &[Item] {
        let start = primitive
            .checked_sub(1)
            .map_or(0, |before| self.ends[before]);
        &self.items[start as usize..self.ends[primitive] as usize]
    }

    /// Returns a ball (middle, radius) that holds a primitive's reach; `None` if it has no blobs.
    #[must_use]
    pub fn ball(&self, primitive: usize) -> Option<(DVec3, f64)> {
        let items = self.of(primitive);
        let middle = items.iter().map(|item| item.middle).sum::<DVec3>() / items.len() as f64;
        let reaches = items
            .iter()
            .map(|item| item.middle.distance(middle) + f64::from(item.extent.radius));
        Some((middle, reaches.reduce(f64::max)?))
    }

    /// Returns the tree of the primitives' balls, enlarged to those outside which each is
    /// negligible.
    #[must_use]
    pub fn reaches(&self, tree: &Hierarchy) -> Hierarchy {
        tree.enlarge(|i, center, radius| {
            self.of(i as usize).iter().fold(radius, |radius, item| {
                let blob = &item.near.blob;
                let reach = item.middle.distance(center) + blob.radius(blob.reach(self.least));
                radius.at_least(reach)
            })
        })
    }

    /// Whether one of a primitive's blobs may exceed `level` in a ball; true for primitives without
    /// blobs.
    #[must_use]
    pub fn counts(&self, primitive: usize, center: DVec3, radius: f64, level: f64) -> bool {
        let items = self.of(primitive);
        items.is_empty()
            || items.iter().any(|item| {
                let (away, half) = (center - item.middle, item.near.blob.half());
                let share = away.dot(half) / half.length_squared().max(f64::MIN_POSITIVE);
                let apart = (away - half * share.clamp(-1.0, 1.0)).length();
                item.near.blob.ceiling().at((apart - radius).max(0.0)) > level
            })
    }

    /// Lists the blobs near a beam, up to a parameter, and the other primitives there. Returns
    /// false if those are more than [`MOST_OTHERS`]. `tree` holds the balls of all primitives;
    /// `reach` returns the distance from its bone at which a primitive's reach ends, given its
    /// ball's radius.
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
                NearBlob {
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

/// Packs a parameter ≥ 0, rounded down to single precision, and an index into a sort key: ordered
/// by parameter, then index.
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

/// Unpacks a [`key`] into parameter and index.
fn unkey(key: u64) -> (f64, u32) {
    (f64::from(f32::from_bits((key >> 32) as u32)), key as u32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use field::{BlobScale, Kernel, Shaping, Skeleton};
    use trials::{Random, count};

    /// A primitive for which `counts` is false stays below the level in the whole ball.
    #[test]
    fn primitives_that_do_not_count_stay_below_the_level() {
        let mut random = Random::new(4);
        let (mut counting, mut small) = (0, 0);
        for case in 0..count(60) {
            let [a, b, c] = core::array::from_fn(|_| random.vector(1.0));
            let skeleton = match case % 3 {
                0 => Skeleton::Point { center: a },
                1 => Skeleton::Segment { base: a, apex: b },
                // As a blob chain.
                _ => Skeleton::Curve {
                    control: [a, b, c, a * 0.5],
                },
            };
            let shaping = Shaping {
                kernel: Kernel::Gauss,
                radius: random.range(0.05, 0.35),
                blobbiness: -random.range(-3.0, -1.0),
                blob_scale: BlobScale::Relative,
                strength: 1.0,
                influence: 1e-3,
                taper: None,
            };
            let primitive = Primitive::new(skeleton, &shaping, None).expect("flesh");
            let blob_set = BlobSet::new(
                core::slice::from_ref(&primitive),
                &[0],
                core::slice::from_ref(&(0..1)),
            );
            // Of a crisp curve no chain is made.
            if blob_set.ball(0).is_none() {
                assert!(case % 3 == 2, "{case} is no sum of blobs");
                continue;
            }
            for _ in 0..40 {
                let center = random.vector(1.0);
                let radius = 0.4 * random.unit();
                // The level counts for each of a chain's points.
                let level = random.decades(-7.0, -1.0);
                let mut most: f64 = primitive.value(center.to_array());
                for _ in 0..60 {
                    let aside = random.vector(1.0).normalize_or_zero();
                    let point = center + aside * (radius * random.unit());
                    most = most.max(primitive.value(point.to_array()));
                }
                let items = blob_set.of(0).len() as f64;
                if blob_set.counts(0, center, radius, level) {
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
        assert!(
            counting > count(200) && small > count(200),
            "{counting} {small}"
        );
    }

    #[test]
    fn primitives_without_blobs_count_everywhere() {
        let shaping = Shaping {
            kernel: Kernel::Cauchy,
            radius: 0.2,
            blobbiness: 2.0,
            blob_scale: BlobScale::Relative,
            strength: 1.0,
            influence: 1e-3,
            taper: None,
        };
        let corners = [DVec3::X, DVec3::Y, DVec3::Z];
        let face = Primitive::new(Skeleton::Triangle { corners }, &shaping, None).expect("flesh");
        let blob_set = BlobSet::new(&[face], &[0], core::slice::from_ref(&(0..1)));
        assert!(blob_set.ball(0).is_none());
        assert!(blob_set.counts(0, DVec3::splat(1e6), 0.1, 1.0));
    }

    #[test]
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
        // Parameters that are equal in single precision are ordered by index.
        assert!(key(1.0 + 1e-12, 3) < key(1.0, 4) && key(1.0, 9) < key(1.1, 2));
    }
}
