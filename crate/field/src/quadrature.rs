//! Numerical integration: the reference that the closed forms are tested against.
//!
//! [`value`] integrates the kernel over the skeleton adaptively, and shares nothing with the closed
//! forms but the definition of the field. It is slow (10² to 10⁵ kernel evaluations).
use crate::{Field, Kernel, Primitive, Profile, Skeleton, Wave};
use glam::DVec3;

/// Nodes in [0, 1) and weights of Kronrod's 15-point rule, and weights of the 7-point Gauss rule
/// within it (0 at nodes it lacks).
const NODES: [(f64, f64, f64); 8] = [
    (0.0, 0.209_482_141_084_727_82, 0.417_959_183_673_469_4),
    (0.207_784_955_007_898_48, 0.204_432_940_075_298_89, 0.0),
    (
        0.405_845_151_377_397_2,
        0.19035057806478541,
        0.381_830_050_505_118_9,
    ),
    (0.586_087_235_467_691_1, 0.169_004_726_639_267_9, 0.0),
    (
        0.741_531_185_599_394_5,
        0.140_653_259_715_525_92,
        0.279_705_391_489_276_64,
    ),
    (0.864_864_423_359_769_1, 0.104_790_010_322_250_19, 0.0),
    (
        0.949_107_912_342_758_5,
        0.063_092_092_629_978_56,
        0.129_484_966_168_869_7,
    ),
    (0.991_455_371_120_812_6, 0.022935322010529225, 0.0),
];

/// Deepest bisection; a panel is then 2⁻⁴⁰ of the whole.
const DEPTH: u32 = 40;

/// The integral of f from the first to the last of `breaks`, by bisection of the panels between
/// them until Gauss and Kronrod agree to `tolerance` (relative to the integral of |f|).
///
/// Good to better than that where f is smooth between breaks; a jump or a kink costs time. Breaks
/// must be close enough that a first look with 15 nodes a panel finds every peak.
pub fn integral(f: &mut impl FnMut(f64) -> f64, breaks: &[f64], tolerance: f64) -> f64 {
    let panels: Vec<_> = breaks
        .windows(2)
        .map(|ends| (ends[0], ends[1], panel(f, ends[0], ends[1])))
        .collect();
    let scale: f64 = panels.iter().map(|(_, _, p)| p.size).sum();
    panels
        .into_iter()
        .map(|(low, high, p)| refine(f, low, high, p, tolerance * scale, DEPTH))
        .sum()
}

struct Panel {
    kronrod: f64,
    error: f64,
    size: f64,
}

fn panel(f: &mut impl FnMut(f64) -> f64, a: f64, b: f64) -> Panel {
    let (middle, half) = ((a + b) / 2.0, (b - a) / 2.0);
    let (mut kronrod, mut gauss, mut size) = (0.0, 0.0, 0.0);
    for (i, (x, wk, wg)) in NODES.into_iter().enumerate() {
        let high = f(middle + half * x);
        let low = if i == 0 { 0.0 } else { f(middle - half * x) };
        kronrod += wk * (high + low);
        gauss += wg * (high + low);
        size += wk * (high.abs() + low.abs());
    }
    Panel {
        kronrod: kronrod * half,
        error: ((kronrod - gauss) * half).abs(),
        size: (size * half).abs(),
    }
}

fn refine(
    f: &mut impl FnMut(f64) -> f64,
    a: f64,
    b: f64,
    whole: Panel,
    tolerance: f64,
    depth: u32,
) -> f64 {
    // The Gauss rule's error bounds the Kronrod rule's generously.
    if whole.error <= tolerance || depth == 0 {
        return whole.kronrod;
    }
    let middle = (a + b) / 2.0;
    let (left, right) = (panel(f, a, middle), panel(f, middle, b));
    refine(f, a, middle, left, tolerance, depth - 1)
        + refine(f, middle, b, right, tolerance, depth - 1)
}

/// The kernel as defined, of squared distance.
fn kernel(kernel: Kernel, s: f64, square: f64) -> f64 {
    match kernel {
        Kernel::Cauchy => {
            let q = 1.0 + s * s * square;
            1.0 / (q * q)
        }
    }
}

/// A primitive's field at a point, by integration over its skeleton.
///
/// Relative error about 10⁻¹² (triangles 10⁻¹¹).
#[must_use]
pub fn value(primitive: &Primitive, point: DVec3) -> f64 {
    let s = primitive.width;
    let h = |q: DVec3| kernel(primitive.kernel, s, q.distance_squared(point));
    let grain = |length: f64| 1.0 / (s * length);
    let integral = match primitive.skeleton {
        Skeleton::Point { center } => h(center),
        Skeleton::Segment { base, apex } => {
            let d = apex - base;
            d.length() * split(|t| h(base + d * t), near(base, d, point), grain(d.length()))
        }
        Skeleton::Arc {
            center,
            u,
            v,
            radius,
            angle,
        } => {
            let on = |t: f64| {
                let (sine, cosine) = libm::sincos(angle * t);
                center + radius * (u * cosine + v * sine)
            };
            let d = point - center;
            let azimuth = libm::atan2(d.dot(v), d.dot(u)).rem_euclid(core::f64::consts::TAU);
            radius * angle * split(|t| h(on(t)), azimuth / angle, grain(radius * angle))
        }
        Skeleton::Triangle { corners: [a, b, c] } => {
            // Strips parallel to the longest side, so that they do not become needles.
            let (a, b, c) = [(a, b, c), (b, c, a), (c, a, b)]
                .into_iter()
                .max_by(|x, y| {
                    (x.1 - x.0)
                        .length_squared()
                        .total_cmp(&(y.1 - y.0).length_squared())
                })
                .unwrap_or((a, b, c));
            let side = b - a;
            let foot = a + side * ((c - a).dot(side) / side.length_squared().max(1e-300));
            let altitude = c - foot;
            let strip = |t: f64| {
                let (p, q) = (a + (c - a) * t, b + (c - b) * t);
                let d = q - p;
                d.length() * split(|w| h(p + d * w), near(p, d, point), grain(d.length()))
            };
            altitude.length() * split(strip, near(foot, altitude, point), grain(altitude.length()))
        }
        Skeleton::Plane { point: p, normal } => {
            let d = (point - p).dot(normal.normalize());
            // Rings of radius t/(1−t)/s.
            let ring = |t: f64| {
                let r = t / (1.0 - t) / s;
                let stretch = 1.0 / ((1.0 - t) * (1.0 - t) * s);
                core::f64::consts::TAU * r * stretch * kernel(primitive.kernel, s, d * d + r * r)
            };
            split(ring, 0.5, 1.0)
        }
    };
    let factor = primitive
        .profile
        .map_or(1.0, |profile| factor(&profile, &primitive.skeleton, point));
    primitive.height * factor * integral
}

/// The whole field at a point, by integration.
#[must_use]
pub fn sum(field: &Field, point: DVec3) -> f64 {
    field.primitives.iter().map(|p| value(p, point)).sum()
}

/// `∫₀¹` of a function with a peak at `peak`, of about the width `grain`: panels grow fourfold away
/// from there.
fn split(mut f: impl FnMut(f64) -> f64, peak: f64, grain: f64) -> f64 {
    let peak = if peak.is_finite() {
        peak.clamp(0.0, 1.0)
    } else {
        0.0
    };
    let grain = grain.max(1e-9);
    let mut breaks = vec![peak];
    let mut reach = grain;
    while reach < peak {
        breaks.push(peak - reach);
        reach *= 4.0;
    }
    breaks.push(0.0);
    breaks.reverse();
    reach = grain;
    while reach < 1.0 - peak {
        breaks.push(peak + reach);
        reach *= 4.0;
    }
    breaks.push(1.0);
    integral(&mut f, &breaks, 1e-13)
}

/// Where on `base + t·d` the point's perpendicular falls.
fn near(base: DVec3, d: DVec3, point: DVec3) -> f64 {
    (point - base).dot(d) / d.length_squared()
}

/// A profile's factor, from its definition in the world.
fn factor(profile: &Profile, skeleton: &Skeleton, point: DVec3) -> f64 {
    let (u, v) = match *skeleton {
        Skeleton::Point { .. } | Skeleton::Plane { .. } => (0.0, 0.0),
        Skeleton::Segment { base, apex } => (near(base, apex - base, point), 0.0),
        Skeleton::Arc {
            center,
            u,
            v,
            angle,
            ..
        } => {
            let d = point - center;
            let t = libm::atan2(d.dot(v), d.dot(u)).rem_euclid(core::f64::consts::TAU);
            // In the gap: before the start if that is nearer than the end.
            let past = t - angle;
            let before = core::f64::consts::TAU - t;
            (
                if past > 0.0 && before < past {
                    0.0
                } else {
                    t / angle
                },
                0.0,
            )
        }
        Skeleton::Triangle { corners: [a, b, c] } => {
            let (e1, e2, d) = (b - a, c - a, point - a);
            let n = e1.cross(e2);
            let area = n.length_squared();
            (n.dot(d.cross(e2)) / area, n.dot(e1.cross(d)) / area)
        }
    };
    let [low, high] = profile.bounds;
    let product = wave(profile.waves[0], profile.scale[0] * u.clamp(0.0, 1.0))
        * wave(profile.waves[1], profile.scale[1] * v.clamp(0.0, 1.0));
    let product = match *skeleton {
        Skeleton::Arc {
            center,
            u,
            v,
            radius,
            ..
        } => {
            let d = point - center;
            let q = libm::sqrt(d.dot(u) * d.dot(u) + d.dot(v) * d.dot(v)) / radius;
            let root = 2.0 * q / (1.0 + q * q);
            let mean = mean(profile);
            mean + root * root * (product - mean)
        }
        _ => product,
    };
    profile.times * (low + (high - low) * product)
}

/// The waves' mean over u, where v is 0; between two multiples of ½ every wave is smooth.
fn mean(profile: &Profile) -> f64 {
    let scale = profile.scale[0];
    if scale == 0.0 {
        return wave(profile.waves[0], 0.0) * wave(profile.waves[1], 0.0);
    }
    let pieces = (2.0 * scale.abs()).ceil().max(1.0) as u32;
    let breaks: Vec<f64> = (0..=pieces)
        .map(|i| (0.5 * f64::from(i) / scale.abs()).min(1.0))
        .collect();
    let along = integral(&mut |u| wave(profile.waves[0], scale * u), &breaks, 1e-13);
    along * wave(profile.waves[1], 0.0)
}

fn wave(wave: Wave, x: f64) -> f64 {
    let fraction = x - x.floor();
    let (sine, cosine) = libm::sincos(x);
    match wave {
        Wave::One => 1.0,
        Wave::X => x.clamp(0.0, 1.0),
        Wave::Sin => (1.0 + sine) / 2.0,
        Wave::Cos => (1.0 + cosine) / 2.0,
        Wave::Sin2 => sine * sine,
        Wave::Cos2 => cosine * cosine,
        Wave::Saw => fraction,
        Wave::Hat => 1.0 - (2.0 * fraction - 1.0).abs(),
        Wave::Step => f64::from(u8::from(fraction >= 0.5)),
    }
}
