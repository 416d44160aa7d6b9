//! Fields by adaptive quadrature: those of kernels without closed forms, and what closed forms are
//! held to. Slow: in double precision, lane by lane, with hundreds to 10⁵ values of the kernel
//! each.
//!
//! All work in the bone's own frame, as closed forms do. G and G′ are functions of the squared
//! distance q.
use super::falloff::{Falloff, Tail};
use crate::bone::{Arc, Edge, Segment};
use crate::integral::{integral, of_one_panel};
use crate::{Jet, Real, heap_sort};
use core::f64::consts::{FRAC_PI_2, PI};

/// Relative error of integrals.
const TOLERANCE: f64 = 1e-13;
/// Distance at which kernels that never end, and fall faster than u⁻⁴, are over.
const FAR: f64 = 1e6;

/// Computes G and G′.
fn pair<K: Falloff + ?Sized>(q: f64) -> [f64; 2] {
    let [value, slope, ..] = K::derivatives(q);
    [value, slope]
}

/// Returns the square of the distance within which G is smooth, next to the smallest q.
fn softening<K: Falloff + ?Sized>() -> f64 {
    match K::TAIL {
        Tail::Power { softening, .. } => softening,
        Tail::Compact | Tail::Fast => 1.0,
    }
}

/// Computes `∫ f(t) dt` from a to b, for an f that varies over the length `grain` around 0, over
/// longer ones further out, and has kinks at ± some places.
fn around_0(
    mut f: impl FnMut(f64) -> f64,
    [a, b]: [f64; 2],
    grain: f64,
    kinks: impl Iterator<Item = f64>,
) -> f64 {
    let mut places = vec![a, b, 0.0];
    places.extend(kinks.flat_map(|t| [-t, t]));
    let mut step = grain;
    while step < a.abs().max(b.abs()) {
        places.extend([-step, step]);
        step *= 2.0;
    }
    places.retain(|t| (a..=b).contains(t));
    heap_sort(&mut places, |a, b| a < b);
    integral(&mut f, &places, TOLERANCE)
}

/// Computes `∫ f(q(t), t) dt` from a to b, with q = rest + t².
fn over_line<K: Falloff + ?Sized>(f: impl Fn(f64, f64) -> f64, rest: f64, ends: [f64; 2]) -> f64 {
    let kinks = K::KINKS
        .iter()
        .map(|kink| (kink * kink - rest).max(0.0).sqrt());
    let grain = (softening::<K>() + rest).sqrt();
    around_0(|t| f(rest + t * t, t), ends, grain, kinks)
}

/// Computes [`Falloff::along`].
pub(super) fn along<K: Falloff + ?Sized>(u: f64) -> f64 {
    over_line::<K>(|q, _| pair::<K>(q)[0], 0.0, [0.0, u])
}

/// Computes [`Falloff::over_ring`].
pub(super) fn ring<K: Falloff + ?Sized>(p: f64, q: f64) -> f64 {
    let kinks = K::KINKS.iter().map(|kink| kink * kink - p);
    around_0(
        |more| pair::<K>(p + more)[0],
        [0.0, q - p],
        softening::<K>() + p,
        kinks,
    )
}

/// Computes [`Falloff::line`].
pub(super) fn line<K: Falloff + ?Sized>(distance: f64) -> f64 {
    let end = if matches!(K::TAIL, Tail::Compact) {
        (1.0 - distance * distance).max(0.0).sqrt()
    } else {
        FAR
    };
    2.0 * over_line::<K>(|q, _| pair::<K>(q)[0], distance * distance, [0.0, end])
}

/// Computes [`Falloff::plane`].
pub(super) fn plane<K: Falloff + ?Sized, R: Real>(z: R) -> (R, R) {
    let end = if matches!(K::TAIL, Tail::Compact) {
        1.0
    } else {
        FAR * FAR
    };
    let value = R::from_lanes(|i| {
        let q = z.lane(i) * z.lane(i);
        PI * ring::<K>(q, end.max(q))
    });
    (value, K::falling(z * z).0)
}

/// Computes [`Falloff::width`]: the distance at which a compact or a fast kernel has the
/// logarithmic slope that a Gaussian of this blobbiness has at its radius, `−qG′/G = B`.
pub(super) fn width<K: Falloff + ?Sized>(blobbiness: f64) -> f64 {
    let (mut low, mut high) = match K::TAIL {
        Tail::Compact => (0.0, 1.0),
        Tail::Power { .. } | Tail::Fast => (0.0, FAR),
    };
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

/// Computes a jet lane by lane.
fn by_lanes<R: Real>(p: [R; 3], jet: impl Fn([f64; 3]) -> Jet<f64>) -> Jet<R> {
    let mut lanes = [Jet::<f64>::zero(); 8];
    for (i, lane) in lanes.iter_mut().enumerate().take(R::LANES) {
        *lane = jet(p.map(|x| x.lane(i)));
    }
    Jet {
        value: R::from_lanes(|i| lanes[i].value),
        gradient: core::array::from_fn(|k| R::from_lanes(|i| lanes[i].gradient[k])),
    }
}

/// Computes a segment's field.
pub(super) fn segment<K: Falloff + ?Sized, R: Real>(
    bone: &Segment<R::Scalar>,
    p: [R; 3],
) -> Jet<R> {
    let half = bone.half.lane(0);
    by_lanes(p, |[x, y, z]| {
        let rest = y * y + z * z;
        let (a, b) = (-half - x, half - x);
        let [value, slope] = [0, 1].map(|i| over_line::<K>(|q, _| pair::<K>(q)[i], rest, [a, b]));
        let ends = [a, b].map(|t| pair::<K>(rest + t * t)[0]);
        Jet {
            value,
            gradient: [ends[0] - ends[1], 2.0 * y * slope, 2.0 * z * slope],
        }
    })
}

/// Computes an arc's field. Around the angle of the point, at an angle w, it is
/// `q = d² + 4ρr·sin²(w/2)`, d the distance from the circle.
pub(super) fn arc<K: Falloff + ?Sized, R: Real>(bone: &Arc<R::Scalar>, p: [R; 3]) -> Jet<R> {
    let [radius, side, half] = [bone.radius, bone.side, bone.half_angle].map(|x| x.lane(0));
    by_lanes(p, |[x, y, z]| {
        // From the centre, with the arc's middle on the axis x.
        let x = side * (x + radius);
        let rho = (x * x + y * y).sqrt();
        let azimuth = libm::atan2(y, x);
        let rest = (rho - radius) * (rho - radius) + z * z;
        let reach = 4.0 * rho * radius;
        let grain = ((softening::<K>() + rest) / (rho * radius)).sqrt();
        let kinks = || {
            K::KINKS.iter().map(|kink| {
                let sine = ((kink * kink - rest) / reach).clamp(0.0, 1.0).sqrt();
                2.0 * libm::asin(sine)
            })
        };
        // Both ways round, so that the nearest place is at 0.
        let over = |f: &dyn Fn(f64, f64) -> f64| {
            let turns = [-2.0 * PI, 0.0, 2.0 * PI].map(|turn| {
                let [a, b] = [-half, half].map(|end| (end + turn - azimuth).clamp(-PI, PI));
                if a < b {
                    let g = |w: f64| {
                        let sine = libm::sin(0.5 * w);
                        f(rest + reach * sine * sine, w)
                    };
                    around_0(g, [a, b], grain.min(FRAC_PI_2), kinks())
                } else {
                    0.0
                }
            });
            radius * turns.iter().sum::<f64>()
        };
        let slope = |of: &dyn Fn(f64) -> f64| over(&|q, w| 2.0 * pair::<K>(q)[1] * of(w));
        Jet {
            value: over(&|q, _| pair::<K>(q)[0]),
            gradient: [
                side * slope(&|w| x - radius * libm::cos(w + azimuth)),
                slope(&|w| y - radius * libm::sin(w + azimuth)),
                z * slope(&|_| 1.0),
            ],
        }
    })
}

/// Computes the field of a triangle or a polygon, as a sum over its edges (Green's theorem): with
/// the foot of the perpendicular at the distance h from an edge's line, `ρ² = h²+t²`,
///
/// `f = ½ Σ h ∫ M dt`, `M = ∫ G / ρ²` over q from z² to z²+ρ²; `∂f/∂z = z Σ h ∫ ΔG/ρ² dt` with the
/// difference ΔG of G there, and `Σ n ∫ G(z²+ρ²) dt` in the plane, over inward normals n.
pub(super) fn face<K: Falloff + ?Sized, R: Real>(edges: &[Edge<R::Scalar>], p: [R; 3]) -> Jet<R> {
    by_lanes(p, |[x, y, z]| {
        let height = z * z;
        let mut sum = Jet::zero();
        for edge in edges {
            let [ax, ay] = edge.along.map(|a| a.lane(0));
            let start = edge.start.lane(0) - (ax * x + ay * y);
            let ends = [start, start + edge.length.lane(0)];
            let h = ax * y - ay * x - edge.offset.lane(0);
            let over = |f: &dyn Fn(f64, f64) -> f64| {
                over_line::<K>(|q, t| f(q, h * h + t * t), height + h * h, ends)
            };
            // Near the foot, where differences lose their digits, the mean by quadrature.
            let near = softening::<K>() + height;
            let mean_of = |i: usize, square: f64| {
                of_one_panel(
                    &mut |s| pair::<K>(height + s * square)[i],
                    0.0,
                    1.0,
                    TOLERANCE,
                )
            };
            let mean = over(&|q, square| {
                if square < near {
                    mean_of(0, square)
                } else {
                    K::over_ring(height, q) / square
                }
            });
            let rise = over(&|q, square| {
                if square < near {
                    mean_of(1, square)
                } else {
                    (pair::<K>(q)[0] - pair::<K>(height)[0]) / square
                }
            });
            let line = over(&|q, _| pair::<K>(q)[0]);
            sum = sum.plus(Jet {
                value: 0.5 * h * mean,
                gradient: [-ay * line, ax * line, z * h * rise],
            });
        }
        sum
    })
}
