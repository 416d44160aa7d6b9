//! Bounds on points and segments of one kernel, eight at a time.
//!
//! With b the softened distance from a segment in kernel widths, its field is at most `whole·b^(−e)`, where all of it is at that
//! distance, and at most that of an infinite line, `line·b^(1−e)`; its fourth derivative along any line is at most
//! `e(e+1)(e+2)(e+3)·(s/b)⁴` times as large.
use super::piece::Piece;
use super::spans::{Judged, SINGLE};
use crate::layout::PACKET;
use crate::slabs::LARGE_TERM;
use core::f64::consts::{FRAC_PI_2, PI};
use field::far_field::power;
use field::{Bound, Primitive, Skeleton};
use glam::DVec3;
use wide::f32x8;

/// Points and segments.
pub struct Bars {
    each: Vec<Bar>,
    power: i32,
    softening: f32,
}

struct Bar {
    middle: DVec3,
    /// From the middle to an end; 0 for a point.
    half: [f32; 3],
    scale: f32,
    whole: f32,
    line: f32,
}

/// Bounds on eight primitives on a ball.
struct Eight {
    size: f32x8,
    error: f32x8,
    noise: f32x8,
}

/// Rounded upwards.
const UP: f32 = 1.0 + 1e-4;

impl Bars {
    /// `None` if some of the primitives are anything else.
    pub fn of(primitives: &[Primitive]) -> Option<Self> {
        let kernel = primitives.first()?.kernel;
        let (power, softening) = power(kernel)?;
        // Field of an infinite line, over b^(1−e).
        let factor = match power {
            4 => FRAC_PI_2,
            3 => 2.0,
            2 => PI,
            _ => return None,
        };
        let bar = |p: &Primitive| {
            let plain = p.kernel == kernel && p.profile.is_none() && p.tapered.is_none();
            let half = match p.skeleton {
                Skeleton::Point { .. } => DVec3::ZERO,
                Skeleton::Segment { base, apex } => 0.5 * (apex - base),
                _ => return None,
            };
            let [whole, width] = Bound::new(p).far();
            let length = 2.0 * half.length() * width;
            let line = if length > 0.0 {
                whole / length * factor
            } else {
                f64::INFINITY
            };
            plain.then_some(Bar {
                middle: p.frame_middle(),
                half: half.as_vec3().to_array(),
                scale: width as f32,
                whole: whole as f32,
                line: line as f32,
            })
        };
        let each: Option<Vec<Bar>> = primitives.iter().map(bar).collect();
        Some(Self {
            each: each?,
            power,
            softening: softening as f32,
        })
    }

    /// Bounds on some primitives on a piece; those with a larger error than is enough ray by ray, for rays in `alive`.
    pub fn judge(
        &self,
        piece: &Piece<'_>,
        numbers: &[u32],
        alive: u32,
        enough: f64,
        judged: &mut Vec<Judged>,
    ) {
        for block in numbers.chunks(8) {
            let radius = piece.half + piece.width;
            let whole = self.eight(block, piece.middle, radius, piece.half);
            let [size, noise] = [whole.size, whole.noise].map(f32x8::to_array);
            let mut error = whole.error.to_array();
            let first = judged.len();
            judged.extend((0..block.len()).map(|i| Judged {
                sizes: [f64::from(size[i]); PACKET],
                error: 0.0,
                noise: f64::from(noise[i]),
            }));
            // Not so for NaN.
            let is_enough = error[..block.len()].iter().all(|e| f64::from(*e) <= enough);
            if alive != 0 && !is_enough {
                error = [0.0; 8];
                for lane in (0..PACKET).filter(|i| alive >> i & 1 != 0) {
                    let own = self.eight(block, piece.middle_of(lane), piece.half, piece.half);
                    let [size, off] = [own.size, own.error].map(f32x8::to_array);
                    for i in 0..block.len() {
                        judged[first + i].sizes[lane] = f64::from(size[i]);
                        error[i] = if off[i] <= error[i] { error[i] } else { off[i] };
                    }
                }
            }
            for (own, error) in judged[first..].iter_mut().zip(error) {
                own.error = f64::from(error);
            }
        }
    }

    /// Bounds on up to eight primitives in a ball, for spans of half this length.
    fn eight(&self, numbers: &[u32], center: DVec3, radius: f64, half: f64) -> Eight {
        let mut row = [[0.0f32; 8]; 9];
        for lane in 0..8 {
            let bar = &self.each[numbers[lane.min(numbers.len() - 1)] as usize];
            let [x, y, z] = (bar.middle - center).as_vec3().to_array();
            let [u, v, w] = bar.half;
            let all = [x, y, z, u, v, w, bar.scale, bar.whole, bar.line];
            for (row, own) in row.iter_mut().zip(all) {
                row[lane] = own;
            }
        }
        let [x, y, z, u, v, w, scale, whole, line] = row.map(f32x8::new);
        let (zero, one) = (f32x8::splat(0.0), f32x8::splat(1.0));
        let square = u * u + v * v + w * w;
        let along = -(x * u + y * v + z * w) / square.fast_max(f32x8::splat(f32::MIN_POSITIVE));
        let along = along.fast_max(-one).fast_min(one);
        let [x, y, z] = [x + u * along, y + v * along, z + w * along];
        let away = (x * x + y * y + z * z).sqrt();
        let length = square.sqrt();
        // Rounded downwards: the bone's place, its length and the ball's radius.
        let slack = f32x8::splat(1e-6) * (away + length);
        let ball = f32x8::splat(radius as f32 * UP);
        let apart = (away - slack - ball).fast_max(zero) * scale;
        let inverse = one / (f32x8::splat(self.softening) + apart * apart);
        let root = inverse.sqrt();
        let (point, endless) = match self.power {
            2 => (inverse, root),
            3 => (inverse * root, inverse),
            _ => (inverse * inverse, inverse * root),
        };
        let size = (whole * point).fast_min(line * endless) * f32x8::splat(UP);
        let e = self.power as f32;
        let rising = e * (e + 1.0) * (e + 2.0) * (e + 3.0);
        let long = (2.0 * half) as f32;
        let factor = rising * (long * long) * (long * long) / 384.0 * UP;
        let rate = scale * scale * inverse;
        let error = size * (rate * rate) * f32x8::splat(factor);
        let most = size.fast_min(f32x8::splat(LARGE_TERM as f32));
        // Its slope over its size is at most e·s/b.
        let misplaced = away + length + ball;
        let steep = f32x8::splat(e) * scale * root;
        let noise = most * (one + misplaced * steep) * f32x8::splat(SINGLE as f32 * UP);
        Eight { size, error, noise }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::common::Numbers;
    use field::{BlobScale, Kernel, Shaping};

    /// The bounds hold at places of the ball, and are nearly reached.
    #[cfg_attr(target_arch = "wasm32", wasm_bindgen_test::wasm_bindgen_test)]
    #[cfg_attr(not(target_arch = "wasm32"), test)]
    fn sizes_and_fourth_derivatives_are_bounded() {
        let mut n = Numbers(3);
        for kernel in [Kernel::Cauchy, Kernel::Squared, Kernel::Cubed] {
            let (mut nearest, mut roughest) = (0.0f64, 0.0f64);
            for case in 0..400 {
                let base = n.vector();
                let skeleton = if case % 3 == 0 {
                    Skeleton::Point { center: base }
                } else {
                    Skeleton::Segment {
                        base,
                        apex: base + n.vector() * n.between(0.01, 1.0),
                    }
                };
                let shaping = Shaping {
                    kernel,
                    radius: n.between(0.02, 0.4),
                    blobbiness: -2.0,
                    blob_scale: BlobScale::Relative,
                    strength: 1.0,
                    influence: 1e-3,
                    taper: None,
                };
                let primitive = Primitive::new(skeleton, &shaping, None).expect("flesh");
                let bars = Bars::of(std::slice::from_ref(&primitive)).expect("a bar");
                let (center, half) = (n.vector() * 1.5, n.between(1e-3, 0.2));
                let told = bars.eight(&[0], center, half, half);
                let [size, error] = [told.size, told.error].map(|x| f64::from(x.to_array()[0]));
                let along = n.vector().normalize();
                let value = |t: f64| primitive.value((center + along * t).to_array());
                let slope = |t: f64| primitive.along_ray(center, along, t).1;
                let [a, b] = [value(-half), value(half)];
                let [da, db] = [slope(-half), slope(half)].map(|slope| slope * half);
                for i in 0..9 {
                    let x = f64::from(i) / 4.0 - 1.0;
                    let own = value(x * half);
                    assert!(own <= size, "{kernel:?} {own} {size}");
                    nearest = nearest.max(own / size);
                    let (p, q) = (0.25 * (x - 1.0) * (x - 1.0), 0.25 * (x + 1.0) * (x + 1.0));
                    let span =
                        p * ((2.0 + x) * a + (1.0 + x) * da) + q * ((2.0 - x) * b + (x - 1.0) * db);
                    let off = (span - own).abs();
                    assert!(off <= error + 1e-12 * size, "{kernel:?} {off} {error}");
                    if error > 1e-9 {
                        roughest = roughest.max(off / error);
                    }
                }
            }
            assert!(
                nearest > 0.8 && roughest > 0.05,
                "{kernel:?} {nearest} {roughest}"
            );
        }
    }
}
