//! Lists of blobs near a beam of rays, and their restriction to narrower beams.
//!
//! Lists are in order of the distance at which a blob may first be met. Positions are relative to a
//! point in the beam, so that single precision suffices; eight blobs are tested at a time. The
//! distance of a blob's bone from the beam bounds its field there: blobs with a negligible bound
//! are left out, and a beam in which all bounds add up to less than T meets no surface.
use crate::beam::Beam;
use field::{Blob, Ceiling, Cut};
use glam::DVec3;
use wide::f32x8;

/// A list of blobs near a beam, each within a ball.
#[derive(Clone, Debug, Default)]
pub struct Nearby {
    /// Origin of the blobs' positions.
    pub middle: DVec3,
    /// Origin of ray parameters.
    pub base: f64,
    blobs: Vec<NearBlob>,
    /// Primitives near the beam that are no blobs.
    pub others: Vec<Other>,
    blocks: Vec<Block>,
    /// Whether any of the blobs is a segment.
    has_segments: bool,
}

/// A primitive that is no blob, within a ball.
#[derive(Clone, Copy, Debug)]
pub struct Other {
    /// Number of the primitive.
    pub primitive: u32,
    /// Middle of the ball.
    pub center: DVec3,
    /// Radius of the ball.
    pub radius: f64,
    /// Distance from the bone at which the primitive's reach ends.
    pub reach: f64,
}

/// A blob in a list.
#[derive(Clone, Copy, Debug)]
pub struct NearBlob {
    /// The blob's field.
    pub blob: Blob<f32>,
    /// Position of the blob's middle.
    pub middle: [f32; 3],
    /// Squared distance from the bone, in kernel widths, at which the blob's reach ends.
    pub square: f32,
    /// Squared distance, in kernel widths, of the surface that the blob would have alone, or for a
    /// point of a chain, that the chain's bone would have.
    pub core: f32,
    /// Whether the blob is a point of a chain.
    pub part: bool,
    /// Distance before the blob's own surface from which a ray is well outside of it.
    pub lead: f32,
    /// Largest slope, about, of the blob's field where the whole field is T, in T per unit of
    /// length.
    pub steep: f32,
    /// Number of the blob's finish.
    pub finish: u32,
    /// The blob's body, numbered among the soft ones.
    pub body: u32,
    /// Least parameter at which a ray of the list's beam may meet it.
    pub from: f32,
}

/// Bounds on a blob: its ball and its field; `R` is one number, or those of eight blobs.
#[derive(Clone, Copy, Debug)]
pub struct Extent<R> {
    /// Radius of the ball around its middle that holds its reach.
    pub radius: R,
    /// Vector from the middle to an end of its bone.
    half: [R; 3],
    peak: R,
    scale: R,
    compact: R,
}

/// Eight blobs side by side.
#[derive(Clone, Copy, Debug)]
struct Block {
    middle: [[f32; 8]; 3],
    extent: Extent<[f32; 8]>,
}

/// Radius of a ball that no beam meets.
const NOWHERE: f32 = -1e30;

/// Largest relative error of squared distances, as positions are rounded to single precision.
const SQUARE_ROUNDING: f32 = 2e-6;

/// Squared sine of the angle between a segment and a beam below which the segment counts as
/// parallel: its nearest point is then not computed.
const ALONG: f32 = 1e-4;

/// Bound on the field below which there is no surface: T less rounding.
const BELOW: f32 = 0.999;

impl Extent<f32> {
    /// Returns the bounds on a blob, given the radius of its ball.
    #[must_use]
    pub fn of(blob: &Blob<f32>, radius: f64) -> Self {
        let Ceiling {
            peak,
            scale,
            compact,
        } = blob.ceiling();
        Self {
            // Rounded outwards.
            radius: radius as f32 * (1.0 + 1e-6),
            half: blob.half().as_vec3().to_array(),
            peak: peak as f32 * (1.0 + 1e-6),
            scale: scale as f32 * (1.0 - 1e-6),
            compact: compact as f32,
        }
    }
}

impl Block {
    const EMPTY: Self = Self {
        middle: [[0.0; 8]; 3],
        extent: Extent {
            radius: [NOWHERE; 8],
            half: [[0.0; 8]; 3],
            peak: [0.0; 8],
            scale: [0.0; 8],
            compact: [0.0; 8],
        },
    };

    #[inline(always)]
    fn set(&mut self, lane: usize, middle: [f32; 3], one: &Extent<f32>) {
        let all = &mut self.extent;
        for (row, x) in self.middle.iter_mut().zip(middle) {
            row[lane] = x;
        }
        for (row, x) in all.half.iter_mut().zip(one.half) {
            row[lane] = x;
        }
        all.radius[lane] = one.radius;
        all.peak[lane] = one.peak;
        all.scale[lane] = one.scale;
        all.compact[lane] = one.compact;
    }

    #[inline(always)]
    fn extent(&self, lane: usize) -> Extent<f32> {
        let all = &self.extent;
        Extent {
            radius: all.radius[lane],
            half: all.half.map(|row| row[lane]),
            peak: all.peak[lane],
            scale: all.scale[lane],
            compact: all.compact[lane],
        }
    }
}

/// The blobs of a list that a beam may meet: a bit each, eight blobs a number.
pub type Marks = Vec<u8>;

/// Iterates over the marked indices, in order.
pub fn indices_of(marks: &Marks) -> impl Iterator<Item = usize> {
    marks.iter().enumerate().flat_map(|(block, &bits)| {
        let mut bits = bits;
        core::iter::from_fn(move || {
            (bits != 0).then(|| {
                let lane = bits.trailing_zeros() as usize;
                bits &= bits - 1;
                block * 8 + lane
            })
        })
    })
}

impl Nearby {
    /// Clears the list and sets the origins of its positions and parameters.
    pub fn begin(&mut self, middle: DVec3, base: f64) {
        (self.middle, self.base) = (middle, base);
        self.blobs.clear();
        self.others.clear();
        self.has_segments = false;
        self.blocks.clear();
    }

    /// Adds a blob, its position relative to [`Nearby::middle`].
    #[inline(always)]
    pub fn push(&mut self, near: NearBlob, extent: &Extent<f32>) {
        self.has_segments |= extent.half != [0.0; 3];
        let lane = self.blobs.len() % 8;
        if lane == 0 {
            self.blocks.push(Block::EMPTY);
        }
        if let Some(last) = self.blocks.last_mut() {
            last.set(lane, near.middle, extent);
        }
        self.blobs.push(near);
    }

    /// Returns the number of blobs.
    #[must_use]
    pub fn len(&self) -> usize {
        self.blobs.len()
    }

    /// Returns a blob.
    #[inline(always)]
    #[must_use]
    pub fn get(&self, index: usize) -> &NearBlob {
        &self.blobs[index]
    }

    /// Copies the blobs that a ray of a beam may meet into another list, leaving out no more than
    /// `left_out` of the field in all. The list stays empty if they cannot add up to T. The beam's
    /// parameters start at [`Nearby::base`].
    pub fn narrow(&self, beam: &Beam, left_out: f32, into: &mut Self) {
        into.begin(self.middle, self.base);
        let mut marks = Marks::new();
        if self.mark(beam, left_out, &mut marks) {
            for index in indices_of(&marks) {
                into.push(*self.get(index), &self.blocks[index / 8].extent(index % 8));
            }
        }
    }

    /// Marks the blobs that a ray of a beam may meet, leaving out no more than `left_out` of the
    /// field in all. Returns false, and no marks, if they cannot add up to T.
    pub fn mark(&self, beam: &Beam, left_out: f32, marks: &mut Marks) -> bool {
        if self.has_segments {
            self.mark_blocks::<true>(beam, left_out, marks)
        } else {
            self.mark_blocks::<false>(beam, left_out, marks)
        }
    }

    /// [`Nearby::mark`], with or without segments.
    #[inline(always)]
    fn mark_blocks<const SEGMENTS: bool>(
        &self,
        beam: &Beam,
        left_out: f32,
        marks: &mut Marks,
    ) -> bool {
        marks.clear();
        let zero = f32x8::splat(0.0);
        let offset = (beam.axis.origin - self.middle).as_vec3();
        let axis = beam.axis.direction.as_vec3();
        let [ox, oy, oz] = offset.to_array().map(f32x8::splat);
        let [ax, ay, az] = axis.to_array().map(f32x8::splat);
        // Beams of pictures are much narrower than the limit 0.5.
        let grow = f32x8::splat((beam.spread / (1.0 - beam.spread.at_most(0.5))) as f32 * 1.001);
        let wide = f32x8::splat(beam.radius as f32 * 1.001 + 1e-7);
        let all = beam.spread >= 0.5;
        let least = f32x8::splat(left_out / self.blobs.len().max(1) as f32);
        let mut most = zero;
        for Block { middle, extent } in &self.blocks {
            let [x, y, z] = middle.map(f32x8::new);
            let (x, y, z) = (x - ox, y - oy, z - oz);
            let radius = f32x8::new(extent.radius);
            let there = radius.simd_ge(zero);
            let square = x * x + y * y + z * z;
            let along = x * ax + y * ay + z * az;
            // A ray's point at t is within radius + spread·t of the axis' point, so in the ball t
            // is at most (along + reach)/(1 − spread).
            let ahead = along + radius + wide;
            let mut across = square - along * along;
            let mut slack = wide + grow * ahead.fast_max(zero);
            let mut room = square;
            if SEGMENTS {
                // The bone's point nearest to the axis is middle + share·half.
                let [ux, uy, uz] = extent.half.map(f32x8::new);
                let length = ux * ux + uy * uy + uz * uz;
                let turn = ux * ax + uy * ay + uz * az;
                let lean = x * ux + y * uy + z * uz - along * turn;
                let tilt = length - turn * turn;
                let runs = (length * f32x8::splat(ALONG)).simd_lt(tilt);
                let one = f32x8::splat(1.0);
                let share = runs.select(-lean / tilt, zero);
                let share = share.fast_max(-one).fast_min(one);
                across += share * (lean + lean + share * tilt);
                let loose = runs.select(zero, length * f32x8::splat(1.01 * ALONG));
                slack += loose.sqrt();
                room += length;
            }
            let across = across - room * f32x8::splat(SQUARE_ROUNDING);
            let apart = across.fast_max(zero).sqrt() - slack;
            let ceiling = Ceiling {
                peak: f32x8::new(extent.peak),
                scale: f32x8::new(extent.scale),
                compact: f32x8::new(extent.compact),
            };
            let bound = ceiling.at(apart.fast_max(zero));
            let near = there & ahead.simd_ge(zero) & least.simd_lt(bound);
            most += near.select(bound, zero);
            let bits = if all { there } else { near };
            marks.push(bits.to_bitmask() as u8);
        }
        let most: f32 = most.to_array().iter().sum();
        if most < BELOW && !all {
            marks.clear();
            return false;
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ray::Ray;
    use field::{Kernel, Primitive, Shaping, Skeleton};
    use trials::{Random, count};

    /// Field of an infinite kernel at the edge of its ball.
    const BEYOND: f64 = 1e-9;

    /// Returns small blobs around a place.
    fn primitives(
        random: &mut Random,
        middle: DVec3,
        count: usize,
        strength: f64,
    ) -> Vec<Primitive> {
        let kernels = [
            Kernel::Gauss,
            Kernel::Gauss,
            Kernel::Quartic,
            Kernel::Metaballs,
        ];
        (0..count)
            .filter_map(|i| {
                let center = middle + 3.0 * random.vector(1.0);
                let along = random.vector(1.0) * random.unit();
                let skeleton = if i % 4 == 1 {
                    Skeleton::Segment {
                        base: center - along,
                        apex: center + along,
                    }
                } else {
                    Skeleton::Point { center }
                };
                let shaping = Shaping {
                    kernel: kernels[i % kernels.len()],
                    radius: 0.005 + 0.1 * random.unit(),
                    blobbiness: 4.0,
                    blob_scale: field::BlobScale::Relative,
                    strength: strength * (0.2 + random.unit()),
                    influence: 1e-3,
                    taper: None,
                };
                Primitive::new(skeleton, &shaping, None)
            })
            .filter(|p| p.blob::<f32>().is_some())
            .collect()
    }

    #[test]
    fn blobs_left_out_add_next_to_nothing_and_most_are_left_out() {
        const LEFT_OUT: f32 = 1e-5;
        let mut random = Random::new(17);
        let (mut kept, mut all, mut empty, mut largest) = (0, 0, 0, 0.0f64);
        for case in 0..count(60) {
            // Far from the origin, where single precision needs an origin amid the blobs.
            let middle = random.vector(1.0) * 1e4;
            // In half of the lists no blob has a surface of its own.
            let strength = if case % 2 == 0 { 1.0 } else { 0.15 };
            let primitives = primitives(&mut random, middle, 3 + case * 37 % 60 * 4, strength);
            let mut list = Nearby::default();
            list.begin(middle, 0.0);
            for (i, primitive) in primitives.iter().enumerate() {
                let blob = primitive.blob::<f32>().expect("a blob");
                let square = blob.reach(BEYOND);
                let place = primitive.blob_middle() - middle;
                let near = NearBlob {
                    blob,
                    middle: place.as_vec3().to_array(),
                    square: square as f32,
                    core: 1.0,
                    part: false,
                    lead: 0.0,
                    steep: 0.0,
                    finish: i as u32,
                    body: 0,
                    from: 0.0,
                };
                list.push(near, &Extent::of(&blob, blob.radius(square)));
            }
            let origin = middle + random.vector(4.0);
            let direction = (middle + random.vector(2.0) - origin).normalize();
            let beam = Beam {
                axis: Ray { origin, direction },
                radius: 0.02 * random.unit(),
                spread: 0.1 * random.unit() * random.unit(),
                ahead: 0.0,
            };
            let mut narrow = Nearby::default();
            list.narrow(&beam, LEFT_OUT, &mut narrow);
            let found: Vec<u32> = (0..narrow.len()).map(|i| narrow.get(i).finish).collect();
            let nowhere = found.is_empty();
            empty += usize::from(nowhere);
            kept += found.len();
            all += primitives.len();
            for _ in 0..20 {
                let offset = random.direction() * beam.radius * 0.999;
                let turn = random.direction() * beam.spread * 0.999;
                let (origin, direction) = (beam.axis.origin + offset, beam.axis.direction + turn);
                for i in 0..300 {
                    let t = 0.03 * f64::from(i);
                    let point = (origin + direction * t).to_array();
                    let lost = (0..primitives.len()).filter(|i| !found.contains(&(*i as u32)));
                    let lost: f64 = lost.map(|i| primitives[i].value(point)).sum();
                    if nowhere {
                        assert!(lost < 1.0, "{beam:?} {t}: {lost}");
                        largest = largest.max(lost);
                    } else {
                        let most = f64::from(LEFT_OUT) + BEYOND * primitives.len() as f64;
                        assert!(lost <= most, "{beam:?} {t}: {lost}");
                    }
                }
            }
        }
        assert!(kept * 3 < all, "{kept} of {all}");
        assert!((1..count(60)).contains(&empty), "{empty}");
        // Few cases may all be clear.
        assert!(count(60) < 60 || largest > 1e-3, "{largest}");
    }
}
