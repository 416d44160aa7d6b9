//! Fields by quadrature: those of kernels without closed forms, and what closed forms are held to.
//! In double precision, lane by lane, with 10² to 10³ values of the kernel each.
//!
//! All work in the bone's own frame, as closed forms do. G and G′ are functions of the squared
//! distance q. Integrals are cut where the kernel has a kink and, in between, into pieces that are
//! no longer than their distance from the integrand's singularities: on each the Gauss–Legendre
//! rule with 16 nodes is right to 10⁻¹⁰ of itself, and mostly to the last digits. Nothing is
//! halved until it is right, so that the work has a bound.
use super::falloff::{Falloff, Tail};
use crate::bone::{Arc, Bone, Edge, Segment};
use crate::kernel::WINDOW;
use crate::{Jet, Real, curve, legendre};
use core::f64::consts::{PI, TAU};

/// Nodes and weights of a piece.
const RULE: [(f64, f64); 8] = legendre::pairs();
/// Distance at which infinite kernels are over if they have a finite integral.
const FAR: f64 = 1e16;
/// Largest place on an axis; its square is not a number.
const LARGEST: f64 = 1e300;

/// Computes G and G′.
fn pair<K: Falloff>(q: f64) -> [f64; 2] {
    let [value, slope, ..] = K::derivatives(q);
    [value, slope]
}

/// Returns the square of the length over which G varies at squared distances from `rest` on.
fn grain<K: Falloff>(rest: f64) -> f64 {
    match K::TAIL {
        Tail::Compact => K::KINKS.first().map_or(1.0, |u| u * u),
        Tail::Power { softening, .. } => softening + rest,
        Tail::Fast => 1.0,
    }
}

/// Returns the distance at which the kernel's integral over a line (1) or a plane (2) ends.
fn reach<K: Falloff>(dimension: i32) -> f64 {
    match K::TAIL {
        Tail::Power { exponent, .. } if exponent <= dimension => WINDOW,
        _ => FAR,
    }
}

/// Integrates functions from a to b that vary over the length `grain` > 0 around 0, and over longer
/// ones further away. `place` is the distance from 0 at which the kernel's argument is u.
fn integral<K: Falloff, const N: usize>(
    grain: f64,
    place: impl Fn(f64) -> f64,
    [a, b]: [f64; 2],
    f: impl Fn(f64) -> [f64; N],
) -> [f64; N] {
    let end = if K::TAIL == Tail::Compact {
        place(1.0)
    } else {
        LARGEST
    };
    let mut sum = [0.0; N];
    for (side, low, high) in [(-1.0, -b, -a), (1.0, a, b)] {
        let (mut low, high) = (low.max(0.0), high.min(end));
        while low < high {
            let kink = K::KINKS.iter().map(|u| place(*u)).find(|t| *t > low);
            let next = (low + low.max(grain)).min(high).min(kink.unwrap_or(high));
            let half = 0.5 * (next - low);
            for (node, weight) in RULE {
                for node in [-node, node] {
                    let values = f(side * (low + half * (1.0 + node)));
                    sum = core::array::from_fn(|i| sum[i] + weight * half * values[i]);
                }
            }
            low = next;
        }
    }
    sum
}

/// Integrates functions of t and of the squared distance q = rest + t², which bend no nearer to
/// t = 0 than at ±i·bend.
fn on_line<K: Falloff, const N: usize>(
    rest: f64,
    bend: f64,
    ends: [f64; 2],
    f: impl Fn(f64, f64) -> [f64; N],
) -> [f64; N] {
    let grain = grain::<K>(rest).sqrt().min(bend);
    integral::<K, N>(
        grain,
        |u| (u * u - rest).max(0.0).sqrt(),
        ends,
        |t| f(t, rest + t * t),
    )
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

/// Computes [`Falloff::between`].
pub(super) fn between<K: Falloff>(a: f64, b: f64) -> f64 {
    on_line::<K, 1>(0.0, f64::INFINITY, [a, b], |_, q| [pair::<K>(q)[0]])[0]
}

/// Computes `∫ G` and `∫ G′` from q on, over a width.
pub(super) fn ring<K: Falloff>(q: f64, width: f64) -> [f64; 2] {
    integral::<K, 2>(
        grain::<K>(q),
        |u| u * u - q,
        [0.0, width],
        |t| pair::<K>(q + t),
    )
}

/// Computes [`Falloff::line`].
pub(super) fn line<K: Falloff>(distance: f64) -> f64 {
    let ends = [0.0, reach::<K>(1)];
    let rest = distance * distance;
    2.0 * on_line::<K, 1>(rest, f64::INFINITY, ends, |_, q| [pair::<K>(q)[0]])[0]
}

/// Computes [`Falloff::plane`].
pub(super) fn plane<K: Falloff, R: Real>(z: R) -> (R, R) {
    let reach = reach::<K>(2);
    let square = z * z;
    let value = R::from_lanes(|i| {
        let q = square.lane(i);
        // Far away the kernel goes on for as many times the distance.
        let far = if reach == WINDOW { 1.0 } else { 1.0 + q };
        PI * ring::<K>(q, reach * reach * far)[0]
    });
    let (mut slope, _) = K::falling(square);
    if reach == WINDOW {
        slope = slope - K::falling(square + R::splat(WINDOW * WINDOW)).0;
    }
    (value, slope)
}

/// Computes [`Falloff::width`]: 1 with a pole, where the unit of length is the radius; else the
/// distance at which the kernel has the logarithmic slope that a Gaussian of this blobbiness has at
/// its radius, `−qG′/G = B`; with a tail that is a power, whose slope is not so steep for all B,
/// the Gaussian's own `√B`.
pub(super) fn width<K: Falloff>(blobbiness: f64) -> f64 {
    match K::TAIL {
        Tail::Power { .. } if K::TAIL.has_pole() => return 1.0,
        Tail::Power { .. } => return blobbiness.sqrt(),
        Tail::Compact | Tail::Fast => {}
    }
    let end = if K::TAIL == Tail::Compact { 1.0 } else { 1e6 };
    let (mut low, mut high) = (0.0, end);
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
        let ends = [-half - x, half - x];
        on_line::<K, 4>(y * y + z * z, f64::INFINITY, ends, |t, q| {
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
        // The point as seen from the centre, with the arc's middle on the axis x.
        let x = side * (x + radius);
        let (azimuth, rho) = (libm::atan2(y, x), (x * x + y * y).sqrt());
        let rest = (rho - radius) * (rho - radius) + z * z;
        let reach = 4.0 * rho * radius;
        let grain = 2.0 * (grain::<K>(rest) / reach).sqrt().min(0.25);
        let mut sum = [0.0; 4];
        // The arc goes both ways round, so that its nearest place is at 0.
        for turn in [-TAU, 0.0, TAU] {
            let ends = [-half, half].map(|end| (end + turn - azimuth).clamp(-PI, PI));
            let part = integral::<K, 4>(
                grain,
                |u| 2.0 * libm::asin(((u * u - rest) / reach).clamp(0.0, 1.0).sqrt()),
                ends,
                |angle| {
                    let sine = libm::sin(0.5 * angle);
                    let [value, slope] = pair::<K>(rest + reach * sine * sine);
                    let (sine, cosine) = libm::sincos(azimuth + angle);
                    let by = [x - radius * cosine, y - radius * sine, z].map(|d| 2.0 * d * slope);
                    [value, by[0], by[1], by[2]]
                },
            );
            sum = core::array::from_fn(|i| sum[i] + radius * part[i]);
        }
        let [value, x, y, z] = sum;
        [value, side * x, y, z]
    })
}

/// An edge as seen from a point in the plane.
struct EdgeView {
    /// Unit direction.
    along: [f64; 2],
    /// Distance of the point from the edge's line, positive inside.
    h: f64,
    /// The ends on the line, from the foot of the perpendicular.
    ends: [f64; 2],
}

impl EdgeView {
    /// Returns the edge as it is seen from (x, y).
    fn new<S: Real>(edge: &Edge<S>, [x, y]: [f64; 2]) -> Self {
        let [ax, ay] = edge.along.map(|a| a.lane(0));
        let start = edge.start.lane(0) - (ax * x + ay * y);
        Self {
            along: [ax, ay],
            h: ax * y - ay * x - edge.offset.lane(0),
            ends: [start, start + edge.length.lane(0)],
        }
    }

    /// Computes the angle at which the point sees the part of the edge's line between two places,
    /// on the same side of the foot.
    fn angle(&self, t: f64, end: f64) -> f64 {
        libm::atan2(self.h * (end - t), self.h * self.h + t * end)
    }

    /// Returns the parts on either side of the foot: the nearer and the further end of each.
    fn sides(&self) -> impl Iterator<Item = [f64; 2]> {
        let [a, b] = self.ends;
        let sides = [[a.max(0.0), b], [(-b).max(0.0), -a]];
        sides.into_iter().filter(|[near, far]| near < far)
    }
}

/// Returns the ends of an edge.
fn ends<S: Real>(edge: &Edge<S>) -> [[f64; 2]; 2] {
    let [ax, ay] = edge.along.map(|a| a.lane(0));
    let [start, inward, length] = [edge.start, edge.offset, edge.length].map(|x| x.lane(0));
    [start, start + length].map(|along| [along * ax - inward * ay, along * ay + inward * ax])
}

/// Computes the field of a face on which G is a parabola, from the middles of the sides of
/// triangles over its edges: a sum over the edges as seen from a point would have lost the digits
/// of so small a face. `None` if it is larger.
fn speck<K: Falloff, S: Real>(edges: &[Edge<S>], [x, y, z]: [f64; 3]) -> Option<[f64; 4]> {
    let [[ox, oy], _] = ends(edges.first()?);
    let [dx, dy] = [x - ox, y - oy];
    let most = 1e-10 * grain::<K>(dx * dx + dy * dy + z * z);
    let mut sum = [0.0; 4];
    for edge in edges {
        let [a, b] = ends(edge).map(|[x, y]| [x - ox, y - oy]);
        if a[0] * a[0] + a[1] * a[1] > most {
            return None;
        }
        let third = (a[0] * b[1] - a[1] * b[0]) / 6.0;
        for [px, py] in [a, b, [a[0] + b[0], a[1] + b[1]]] {
            let away = [dx - 0.5 * px, dy - 0.5 * py, z];
            let [value, slope] = pair::<K>(away.iter().map(|d| d * d).sum());
            sum[0] += third * value;
            for (sum, d) in sum[1..].iter_mut().zip(away) {
                *sum += third * 2.0 * slope * d;
            }
        }
    }
    Some(sum)
}

/// Computes the field of a triangle or a polygon, as a sum over its edges (Green's theorem): with
/// the foot of the perpendicular at the distance h from an edge's line, `ρ² = h²+t²`, and R(ρ) the
/// integral of G over q from z² to z²+ρ², `f = ½ Σ h ∫ R/ρ² dt`, or with the angle φ from t to the
/// end, from a place t = a nearest to the foot on,
///
/// `f = Σ ½(R(ρₐ) − R(ρ₀))·φₐ + ∫ G·t·φ dt`, both of whose terms are positive for h > 0. The
/// distance ρ₀ may be any from which all of the polygon, or nothing of it is further away: 0 from
/// inside, where the sum of all φₐ is a turn, and the nearest edge's from outside. `∂f/∂z` is 2z
/// times the same with G′ in place of G, and `Σ n ∫ G dt` the gradient in the plane, over inward
/// normals n.
fn face<K: Falloff, R: Real>(edges: &[Edge<R::Scalar>], p: [R; 3]) -> Jet<R> {
    by_lanes(p, |[x, y, z]| {
        if let Some(jet) = speck::<K, R::Scalar>(edges, [x, y, z]) {
            return jet;
        }
        let height = z * z;
        let (mut turn, mut nearest) = (0.0, f64::INFINITY);
        for edge in edges {
            let seen = EdgeView::new(edge, [x, y]);
            for [near, far] in seen.sides() {
                turn += seen.angle(near, far);
                nearest = nearest.min(seen.h * seen.h + near * near);
            }
        }
        if turn.abs() > PI {
            nearest = 0.0;
        }
        let mut sum = [0.0; 4];
        for edge in edges {
            let seen = EdgeView::new(edge, [x, y]);
            let h = seen.h;
            let rest = height + h * h;
            for [near, far] in seen.sides() {
                let within = ring::<K>(height + nearest, h * h + near * near - nearest);
                let angle = 0.5 * seen.angle(near, far);
                let [mut value, mut slope] = within.map(|g| g * angle);
                // φ bends at ±ih, but so near to the foot there is nothing.
                let bend = h.abs().max(1e-13 * far);
                let own = on_line::<K, 3>(rest, bend, [near, far], |t, q| {
                    let [value, slope] = pair::<K>(q);
                    let moment = t * seen.angle(t, far);
                    [moment * value, moment * slope, value]
                });
                value += own[0];
                slope += own[1];
                let [ax, ay] = seen.along.map(|a| a * own[2]);
                let terms = [value, -ay, ax, 2.0 * z * slope];
                sum = core::array::from_fn(|i| sum[i] + terms[i]);
            }
        }
        sum
    })
}
