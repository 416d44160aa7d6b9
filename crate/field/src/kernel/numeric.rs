//! Fields by adaptive quadrature: those of kernels without closed forms, and what closed forms are
//! held to. Slow: in double precision, lane by lane, with 10³ to 10⁵ values of the kernel each.
//!
//! All work in the bone's own frame, as closed forms do. G and G′ are functions of the squared
//! distance q.
use super::falloff::{Falloff, Tail};
use crate::bone::{Arc, Bone, Edge, Segment};
use crate::integral::{integral, of_one_panel};
use crate::{Jet, Real, curve, heap_sort};
use core::f64::consts::{PI, TAU};

/// Relative error of integrals.
const TOLERANCE: f64 = 1e-13;
/// Relative error of integrals over a face's edges, whose integrands are integrals and differences
/// themselves: less would be their noise, which bisection does not end in.
const OVER_EDGES: f64 = 1e-10;
/// Distance at which kernels that never end, and fall faster than u⁻¹, are over.
const FAR: f64 = 1e6;

/// Computes G and G′.
fn pair<K: Falloff>(q: f64) -> [f64; 2] {
    let [value, slope, ..] = K::derivatives(q);
    [value, slope]
}

/// Returns the square of the distance within which G is smooth, next to the smallest q.
fn softening<K: Falloff>() -> f64 {
    match K::TAIL {
        Tail::Power { softening, .. } => softening,
        Tail::Compact | Tail::Fast => 1.0,
    }
}

/// Returns the distance at which the kernel is over.
fn end<K: Falloff>() -> f64 {
    if K::TAIL == Tail::Compact { 1.0 } else { FAR }
}

/// Integrates functions from a to b that vary over the length `grain` around 0, and over longer
/// ones further away; `kinks` are places on either side where a derivative jumps.
fn around_0<const N: usize>(
    [a, b]: [f64; 2],
    grain: f64,
    kinks: impl Iterator<Item = f64>,
    tolerance: f64,
    f: impl Fn(f64) -> [f64; N],
) -> [f64; N] {
    let mut breaks = vec![a, b, 0.0];
    breaks.extend(kinks.flat_map(|t| [-t, t]));
    let mut step = grain;
    while step < a.abs().max(b.abs()) {
        breaks.extend([-step, step]);
        step *= 2.0;
    }
    breaks.retain(|t| (a..=b).contains(t));
    heap_sort(&mut breaks, |a, b| a < b);
    core::array::from_fn(|i| integral(&mut |t| f(t)[i], &breaks, tolerance))
}

/// Integrates functions of t and of the squared distance q = rest + t².
fn on_line<K: Falloff, const N: usize>(
    rest: f64,
    ends: [f64; 2],
    tolerance: f64,
    f: impl Fn(f64, f64) -> [f64; N],
) -> [f64; N] {
    let kinks = K::KINKS.iter().map(|u| (u * u - rest).max(0.0).sqrt());
    let grain = (softening::<K>() + rest).sqrt();
    around_0(ends, grain, kinks, tolerance, |t| f(t, rest + t * t))
}

/// Computes [`Falloff::jet`]: of points, planes and curves for all kernels, of other bones for
/// those that have no closed form.
#[inline(always)]
pub(crate) fn jet<K: Falloff, R: Real>(bone: &Bone<R::Scalar>, p: [R; 3]) -> Jet<R> {
    let [x, y, z] = p;
    match bone {
        // The kernel itself (thesis 2.20), `f = G(|p|²)`, `∇f = 2G′·p`.
        Bone::Point => {
            let (value, fall) = K::falling(x * x + y * y + z * z);
            let twice = R::splat(-2.0) * fall;
            Jet {
                value,
                gradient: [twice * x, twice * y, twice * z],
            }
        }
        // A function of the height z alone (thesis 2.24), `f(z) = π·∫ G(q) dq` from z² on.
        Bone::Plane => {
            let (value, slope) = K::plane(z);
            let zero = R::splat(0.0);
            Jet {
                value,
                gradient: [zero, zero, R::splat(-2.0 * PI) * z * slope],
            }
        }
        Bone::Curve(bone) => curve::jet::<K, R>(bone, p),
        Bone::Segment(bone) => segment::<K, R>(bone, p),
        Bone::Arc(bone) => arc::<K, R>(bone, p),
        Bone::Triangle(bone) => face::<K, R>(&bone.edges, p),
        Bone::Polygon(bone) => face::<K, R>(&bone.edges, p),
    }
}

/// Computes [`Falloff::along`].
pub(super) fn along<K: Falloff>(u: f64) -> f64 {
    on_line::<K, 2>(0.0, [0.0, u], TOLERANCE, |_, q| pair::<K>(q))[0]
}

/// Computes [`Falloff::over_ring`].
pub(super) fn ring<K: Falloff>(p: f64, q: f64) -> f64 {
    let kinks = K::KINKS.iter().map(|u| u * u - p);
    around_0([0.0, q - p], softening::<K>() + p, kinks, TOLERANCE, |t| {
        pair::<K>(p + t)
    })[0]
}

/// Computes [`Falloff::line`].
pub(super) fn line<K: Falloff>(distance: f64) -> f64 {
    let ends = [0.0, end::<K>()];
    2.0 * on_line::<K, 2>(distance * distance, ends, TOLERANCE, |_, q| pair::<K>(q))[0]
}

/// Computes [`Falloff::plane`].
pub(super) fn plane<K: Falloff, R: Real>(z: R) -> (R, R) {
    let value = R::from_lanes(|i| {
        let q = z.lane(i) * z.lane(i);
        PI * K::over_ring(q, end::<K>().powi(2).max(q))
    });
    (value, K::falling(z * z).0)
}

/// Computes [`Falloff::width`]: 1 with a pole, where the unit of length is the radius; else the
/// distance at which the kernel has the logarithmic slope that a Gaussian of this blobbiness has at
/// its radius, `−qG′/G = B`.
pub(super) fn width<K: Falloff>(blobbiness: f64) -> f64 {
    if K::TAIL.has_pole() {
        return 1.0;
    }
    let (mut low, mut high) = (0.0, end::<K>());
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        let [value, slope] = pair::<K>(middle * middle);
        if -middle * middle * slope < blobbiness * value {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// Computes value and gradient lane by lane.
fn by_lanes<R: Real>(p: [R; 3], jet: impl Fn([f64; 3]) -> [f64; 4]) -> Jet<R> {
    let mut lanes = [[0.0; 4]; 8];
    for (i, lane) in lanes.iter_mut().enumerate().take(R::LANES) {
        *lane = jet(p.map(|x| x.lane(i)));
    }
    let [value, gradient @ ..] = [0, 1, 2, 3].map(|k| R::from_lanes(|i| lanes[i][k]));
    Jet { value, gradient }
}

/// Computes a segment's field.
fn segment<K: Falloff, R: Real>(bone: &Segment<R::Scalar>, p: [R; 3]) -> Jet<R> {
    let half = bone.half.lane(0);
    by_lanes(p, |[x, y, z]| {
        on_line::<K, 4>(y * y + z * z, [-half - x, half - x], TOLERANCE, |t, q| {
            let [value, slope] = pair::<K>(q);
            [value, -2.0 * t * slope, 2.0 * y * slope, 2.0 * z * slope]
        })
    })
}

/// Computes an arc's field. Around the point's azimuth, at an angle w, it is
/// `q = d² + 4ρr·sin²(w/2)`, d the distance from the circle.
fn arc<K: Falloff, R: Real>(bone: &Arc<R::Scalar>, p: [R; 3]) -> Jet<R> {
    let [radius, side, half] = [bone.radius, bone.side, bone.half_angle].map(|x| x.lane(0));
    by_lanes(p, |[x, y, z]| {
        // From the centre, with the arc's middle on the axis x.
        let x = side * (x + radius);
        let (azimuth, rho) = (libm::atan2(y, x), (x * x + y * y).sqrt());
        let rest = (rho - radius) * (rho - radius) + z * z;
        let reach = 4.0 * rho * radius;
        let grain = ((softening::<K>() + rest) / reach).sqrt().min(0.5);
        let mut sum = [0.0; 4];
        // Both ways round, so that the nearest place is at 0.
        for turn in [-TAU, 0.0, TAU] {
            let [a, b] = [-half, half].map(|end| (end + turn - azimuth).clamp(-PI, PI));
            if a >= b {
                continue;
            }
            let kinks = K::KINKS.iter().map(|u| {
                let square = ((u * u - rest) / reach).clamp(0.0, 1.0);
                2.0 * libm::asin(square.sqrt())
            });
            let part = around_0([a, b], 2.0 * grain, kinks, TOLERANCE, |angle| {
                let sine = libm::sin(0.5 * angle);
                let [value, slope] = pair::<K>(rest + reach * sine * sine);
                let (sine, cosine) = libm::sincos(azimuth + angle);
                let by = [x - radius * cosine, y - radius * sine, z].map(|d| 2.0 * d * slope);
                [value, by[0], by[1], by[2]]
            });
            sum = core::array::from_fn(|i| sum[i] + radius * part[i]);
        }
        let [value, x, y, z] = sum;
        [value, side * x, y, z]
    })
}

/// Computes the field of a triangle or a polygon, as a sum over its edges (Green's theorem): with
/// the foot of the perpendicular at the distance h from an edge's line, `ρ² = h²+t²`,
///
/// `f = ½ Σ h ∫ M dt`, `M = ∫ G / ρ²` over q from z² to z²+ρ²; `∂f/∂z = z Σ h ∫ ΔG/ρ² dt` with the
/// difference ΔG of G there, and `Σ n ∫ G(z²+ρ²) dt` in the plane, over inward normals n.
fn face<K: Falloff, R: Real>(edges: &[Edge<R::Scalar>], p: [R; 3]) -> Jet<R> {
    by_lanes(p, |[x, y, z]| {
        let mut sum = [0.0; 4];
        // Nearer to the foot differences lose their digits: there M and ΔG/ρ² are means.
        let near = 1e-3 * (softening::<K>() + z * z);
        for edge in edges {
            let [ax, ay] = edge.along.map(|a| a.lane(0));
            let start = edge.start.lane(0) - (ax * x + ay * y);
            let h = ax * y - ay * x - edge.offset.lane(0);
            let ends = [start, start + edge.length.lane(0)];
            let own = on_line::<K, 4>(z * z + h * h, ends, OVER_EDGES, |t, q| {
                let (height, square) = (z * z, h * h + t * t);
                let [mean, rise] = if square < near {
                    [0, 1].map(|i| {
                        of_one_panel(
                            &mut |share| pair::<K>(height + share * square)[i],
                            0.0,
                            1.0,
                            TOLERANCE,
                        )
                    })
                } else {
                    let rise = pair::<K>(q)[0] - pair::<K>(height)[0];
                    [K::over_ring(height, q), rise].map(|x| x / square)
                };
                let value = pair::<K>(q)[0];
                [0.5 * h * mean, -ay * value, ax * value, z * h * rise]
            });
            sum = core::array::from_fn(|i| sum[i] + own[i]);
        }
        sum
    })
}
