//! Gradient noise on the integer lattice, with the same bits on every machine: 32-bit integer
//! hashes, `f64` additions and multiplications, no fused ones.
//!
//! At each lattice point stands one of the twelve vectors from a cube's middle to its edges, chosen
//! by a hash. The noise is their scalar products with the offsets, mixed over a cell by the
//! polynomial 6t⁵ − 15t⁴ + 10t³, so that value, gradient and second derivatives are continuous
//! (Perlin, *Improving Noise*, 2002).

use glam::{DMat3, DVec3};

/// Coordinates are cut to ± this, so that sums of octaves stay finite.
const LIMIT: f64 = (1_u64 << 30) as f64;

/// The largest number of octaves that is summed.
pub const MAX_OCTAVES: f64 = 32.0;

/// Makes the noise's extremes ±1: products of the lattice's vectors with offsets, mixed, reach
/// ±1.0364.
const NORM: f64 = 1.0 / 1.0364;

/// Turns each octave against the one before, so that the lattices' planes do not coincide.
/// Orthonormal.
const TURN: DMat3 = DMat3::from_cols_array(&[
    2.0 / 3.0,
    2.0 / 3.0,
    -1.0 / 3.0,
    -1.0 / 3.0,
    2.0 / 3.0,
    2.0 / 3.0,
    2.0 / 3.0,
    -1.0 / 3.0,
    2.0 / 3.0,
]);

/// Shifts each octave, so that the origin is not a zero of all.
const SHIFT: DVec3 = DVec3::new(17.31, -9.73, 5.19);

/// Returns a point with finite coordinates: NaN becomes 0, and magnitudes are cut to 2³⁰.
#[must_use]
pub fn sane(p: DVec3) -> DVec3 {
    DVec3::from_array(p.to_array().map(|x| {
        if x.is_nan() {
            0.0
        } else {
            x.clamp(-LIMIT, LIMIT)
        }
    }))
}

/// Mixes the bits of a number.
#[must_use]
pub fn scramble(mut h: u32) -> u32 {
    h ^= h >> 16;
    h = h.wrapping_mul(0x7feb_352d);
    h ^= h >> 15;
    h = h.wrapping_mul(0x846c_a68b);
    h ^ (h >> 16)
}

/// Returns a hash of a lattice point.
#[must_use]
pub fn lattice(cell: [i32; 3], seed: u32) -> u32 {
    let [x, y, z] = cell.map(i32::cast_unsigned);
    let h = scramble(seed ^ x.wrapping_mul(0x9e37_79b1));
    let h = scramble(h ^ y.wrapping_mul(0x85eb_ca77));
    scramble(h ^ z.wrapping_mul(0xc2b2_ae3d))
}

/// Returns a number in [0, 1) from a hash.
#[must_use]
pub fn unit(hash: u32) -> f64 {
    f64::from(hash) / 4_294_967_296.0
}

/// The lattice cell of a point (modulo 2³²) and the position in it, in [0, 1)³.
pub(crate) fn cell(p: DVec3) -> ([i32; 3], DVec3) {
    let floor = p.floor();
    (
        floor.to_array().map(|x| (x as i64) as i32),
        (p - floor).clamp(DVec3::ZERO, DVec3::ONE),
    )
}

/// Neighbour of a lattice cell.
pub(crate) fn offset(cell: [i32; 3], by: [i32; 3]) -> [i32; 3] {
    [0, 1, 2].map(|i| cell[i].wrapping_add(by[i]))
}

/// The vector at a lattice point: of length √2, to the middle of an edge of the cube [−1, 1]³.
fn arrow(hash: u32) -> DVec3 {
    let [a, b] = [hash, hash >> 1].map(|bits| if bits & 1 == 0 { 1.0 } else { -1.0 });
    match (hash >> 8) % 3 {
        0 => DVec3::new(a, b, 0.0),
        1 => DVec3::new(a, 0.0, b),
        _ => DVec3::new(0.0, a, b),
    }
}

/// 6t⁵ − 15t⁴ + 10t³ and its derivative.
fn fade(t: f64) -> (f64, f64) {
    let s = t * t;
    (
        s * t * (t * (t * 6.0 - 15.0) + 10.0),
        30.0 * s * (t * (t - 2.0) + 1.0),
    )
}

/// Gradient noise: a smooth random function with features about 1 wide, in [−1, 1], 0 at lattice
/// points. Coordinates that are not finite count as 0 or as the largest number.
///
/// ```
/// use glam::DVec3;
/// assert_eq!(texture::noise(DVec3::new(3.0, -2.0, 7.0)), 0.0);
/// assert!(texture::noise(DVec3::new(3.4, -2.3, 7.7)).abs() <= 1.0);
/// ```
#[must_use]
pub fn noise(p: DVec3) -> f64 {
    noise_jet(p).0
}

/// [`noise`] and its gradient.
#[must_use]
#[inline]
pub fn noise_jet(p: DVec3) -> (f64, DVec3) {
    let (base, t) = cell(sane(p));
    let (fx, dx) = fade(t.x);
    let (fy, dy) = fade(t.y);
    let (fz, dz) = fade(t.z);
    let mut value = 0.0;
    let mut gradient = DVec3::ZERO;
    for corner in 0..8 {
        let by = [corner & 1, corner >> 1 & 1, corner >> 2 & 1];
        let arrow = arrow(lattice(offset(base, by), 0));
        let at = t - DVec3::new(f64::from(by[0]), f64::from(by[1]), f64::from(by[2]));
        let [(wx, sx), (wy, sy), (wz, sz)] = [(by[0], fx, dx), (by[1], fy, dy), (by[2], fz, dz)]
            .map(|(by, f, d)| if by == 0 { (1.0 - f, -d) } else { (f, d) });
        let dot = arrow.dot(at);
        let weight = wx * wy * wz;
        value += weight * dot;
        gradient += weight * arrow + dot * DVec3::new(sx * wy * wz, wx * sy * wz, wx * wy * sz);
    }
    (NORM * value, NORM * gradient)
}

/// The sum of octaves of `signal(noise)`: each has half the amplitude and half the size of the one
/// before; of a fractional number of octaves the last counts as that fraction.
fn octaves(p: DVec3, octaves: f64, signal: impl Fn(f64) -> f64) -> f64 {
    let mut left = if octaves.is_nan() {
        0.0
    } else {
        octaves.min(MAX_OCTAVES)
    };
    let (mut p, mut amplitude, mut sum) = (sane(p), 1.0, 0.0);
    while left > 0.0 {
        sum += amplitude * left.min(1.0) * signal(noise(p));
        p = TURN * p * 2.0 + SHIFT;
        amplitude *= 0.5;
        left -= 1.0;
    }
    sum
}

/// Fractal sum of noise: `Σ 2⁻ᵏ noise(2ᵏ p)`, in (−2, 2). A fractional number of octaves fades the
/// last one.
///
/// ```
/// use glam::DVec3;
/// let p = DVec3::new(0.3, 0.4, 0.5);
/// assert_eq!(texture::fractal(p, 1.0), texture::noise(p));
/// assert_eq!(texture::fractal(p, 0.25), 0.25 * texture::noise(p));
/// ```
#[must_use]
pub fn fractal(p: DVec3, octaves: f64) -> f64 {
    self::octaves(p, octaves, |x| x)
}

/// Turbulence: `Σ 2⁻ᵏ |noise(2ᵏ p)|`, in [0, 2). It has creases where an octave is 0.
#[must_use]
pub fn turbulence(p: DVec3, octaves: f64) -> f64 {
    self::octaves(p, octaves, f64::abs)
}

/// Returns three independent fractal sums, for shifting points.
pub(crate) fn warp(p: DVec3, octaves: f64) -> DVec3 {
    DVec3::new(
        fractal(p, octaves),
        fractal(p + DVec3::new(31.7, 11.3, -7.9), octaves),
        fractal(p + DVec3::new(-13.1, 47.9, 23.3), octaves),
    )
}

/// Scatters a random point into each unit cell: calls `visit` with a hash and the point's position
/// for the cell of `p` and its 26 neighbours, in a fixed order. Points that were not visited are at
/// least 1 away.
pub(crate) fn scatter(p: DVec3, seed: u32, mut visit: impl FnMut(u32, DVec3)) {
    let p = sane(p);
    let (base, at) = cell(p);
    let corner = p - at;
    for z in -1..=1 {
        for y in -1..=1 {
            for x in -1..=1 {
                let hash = lattice(offset(base, [x, y, z]), seed);
                let (hy, hz) = (scramble(hash ^ 0x68bc_21eb), scramble(hash ^ 0x02e5_be93));
                let jitter = DVec3::new(unit(hash), unit(hy), unit(hz));
                let shift = DVec3::new(f64::from(x), f64::from(y), f64::from(z));
                visit(scramble(hash ^ 0x967a_889b), corner + shift + jitter);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The largest value that any choice of the lattice's vectors gives, on a grid: the norm's
    /// reason.
    #[test]
    fn extremes_are_one() {
        let steps = 40;
        let mut worst = 0.0_f64;
        for i in 0..=steps {
            for j in 0..=steps {
                for k in 0..=steps {
                    let t = DVec3::new(f64::from(i), f64::from(j), f64::from(k)) / f64::from(steps);
                    let mut most = 0.0;
                    for corner in 0..8 {
                        let by = DVec3::new(
                            f64::from(corner & 1),
                            f64::from(corner >> 1 & 1),
                            f64::from(corner >> 2 & 1),
                        );
                        let weights = [0, 1, 2].map(|i| {
                            let t: f64 = t[i];
                            let f = t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
                            if by[i] == 0.0 { 1.0 - f } else { f }
                        });
                        let d = (t - by).abs();
                        // The two longest of three offsets.
                        let dot = d.x + d.y + d.z - d.min_element();
                        most += weights.iter().product::<f64>() * dot;
                    }
                    worst = worst.max(most);
                }
            }
        }
        assert!(
            (0.99..=1.0).contains(&(worst * NORM)),
            "{worst}: the norm is off"
        );
    }

    #[test]
    fn octaves_are_turned_and_not_stretched() {
        assert!((TURN * TURN.transpose()).abs_diff_eq(DMat3::IDENTITY, 1e-15));
        assert!((TURN.determinant() - 1.0).abs() < 1e-15);
    }
}
