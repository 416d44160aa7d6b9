//! The Cauchy kernel over a triangle (thesis 2.23, without its split into right triangles and with
//! 1/(2qs⁴) where the print has 1/(2qs)).
//!
//! The triangle lies in the plane z = 0, its corners counter-clockwise. Let q be the foot of the
//! perpendicular from the point, `c² = 1+z²`, Dᵢ = c² + squared distance of q from corner i. For an
//! edge of length l let h be the signed distance of q from its line (positive inside), t₀ and
//! `t₁ = t₀+l` the edge's interval measured from q's foot on that line, `w² = c²+h²` and θ in [0,
//! π] the angle between (w, t₀) and (w, t₁). Green's theorem gives the sum over the edges
//!
//! `f = 1/(2c²) · Σ kθ`, k = h/w. (1)
//!
//! Outside a triangle its terms have both signs and cancel, the more the farther or smaller it is.
//! But (1) is an area: stereographic projection maps the plane to a sphere, 4f c² is the area of
//! the triangle's image there, and edges become arcs of circles through the pole. That area is the
//! spherical triangle with the same corners less three slivers between arcs and great circles:
//!
//! `f = 1/(2c²) · [Ω/2 − Σ V]`, `V = arctan(k tan θ) − kθ`, (2)
//! `tan(Ω/2) = 2c²(2F·D₀ − g·(q−v₀)) / (2D₀D₁D₂ − c²(l₀²D₀+l₁²D₁+l₂²D₂))`,
//!
//! where F is the triangle's area, lᵢ the edge opposite corner i and `g = |e₁|²e₂^⊥ …` a constant.
//! Of (1) and (2) each lane takes the one whose terms are smaller.
//!
//! Gradient: in the plane `Σ n·∫dt/(w²+t²)²` over inward normals n, where each integral is that of
//! a [segment](super::segment); across it `∂f/∂z = −z/c²·(2f + Σ h·∫dt/(w²+t²)²)`. The parts of
//! these sums that cancel (Σ l·n = 0) are removed symbolically.
use crate::angle::{angle, direction, sliver};
use crate::bone::Triangle;
use crate::{Jet, Real};

/// Value and gradient at a local position.
#[inline(always)]
pub fn jet<R: Real>(triangle: &Triangle<R::Scalar>, [x, y, z]: [R; 3]) -> Jet<R> {
    let zero = R::splat(0.0);
    let one = R::splat(1.0);
    let two = R::splat(2.0);
    let c2 = one + z * z;
    let from = triangle
        .corners
        .map(|[cx, cy]| [x - R::lift(cx), y - R::lift(cy)]);
    let d = from.map(|[dx, dy]| c2 + dx * dx + dy * dy);
    let i = d.map(|d| one / d);
    let double_area = R::lift(triangle.double_area);

    let mut plain = zero;
    let mut plain_size = zero;
    let mut slivers = zero;
    let mut slivers_size = zero;
    let mut sphere_angle = zero;
    let mut chords = zero;
    let mut steepest = one;
    let mut in_plane = [zero; 2];
    let mut across = zero;
    for k in 0..3 {
        let edge = &triangle.edges[k];
        let [ax, ay] = edge.along.map(R::lift);
        let length = R::lift(edge.length);
        let t0 = R::lift(edge.start) - (ax * x + ay * y);
        let t1 = t0 + length;
        let h = ax * y - ay * x - R::lift(edge.offset);
        let w2 = c2 + h * h;
        let w = w2.sqrt();
        // A single division for 1/w and 1/(w+|h|): 1−|k| = c²/(w(w+|h|)).
        let rim = w + h.abs();
        let i_both = one / (w * rim);
        let iw = i_both * rim;
        let ii = i[(k + 1) % 3] * i[(k + 2) % 3];
        let root = ii.sqrt();
        let sine = w * length * root;
        let cosine = (w2 + t0 * t1) * root;
        let turn = angle(sine, cosine);

        let ratio = h * iw;
        let size = ratio.abs();
        plain = plain + ratio * turn.theta;
        plain_size = plain_size + size * turn.theta;
        let part = sliver(&turn, sine, cosine, c2 * i_both);
        slivers = slivers + ratio.sign_to(part.half_area);
        slivers_size = slivers_size + part.half_area.abs();
        sphere_angle = sphere_angle + ratio.sign_to(turn.theta - part.shortfall);
        chords = chords + length * length * ii;
        steepest = steepest.min(one - c2 * iw * iw * sine * sine);

        let cubic = turn.sin2 * iw * iw * iw;
        in_plane = [in_plane[0] - ay * cubic, in_plane[1] + ax * cubic];
        across = across + h * cubic;
        if k > 0 {
            // Dₖ − D₀, of which the sums over edges l·n·D and l·h·D are made.
            let [sx, sy] = [
                R::lift(triangle.corners[k][0]) - R::lift(triangle.corners[0][0]),
                R::lift(triangle.corners[k][1]) - R::lift(triangle.corners[0][1]),
            ];
            let step = -(sx * (from[0][0] + from[k][0]) + sy * (from[0][1] + from[k][1]));
            let weight = step * length * i[0] * i[1] * i[2];
            in_plane = [in_plane[0] - ay * weight, in_plane[1] + ax * weight];
            across = across + h * weight;
        }
    }
    across = across + double_area * i[1] * i[2];

    let [gx, gy] = triangle.circum.map(R::lift);
    let numerator =
        (double_area * d[0] - gx * from[0][0] - gy * from[0][1]) * i[0] * (two * c2 * i[1]) * i[2];
    let half_sphere = direction(numerator, two - c2 * chords);
    // (2) is wrong by a multiple of π where Ω/2 leaves (−π, π], and unstable where two corners'
    // images are nearly opposite. There (1) has no cancellation.
    let sound = R::both(
        (half_sphere - sphere_angle).abs().lt(one),
        R::splat(0.25).lt(steepest),
    );
    let smaller = (half_sphere.abs() + slivers_size).lt(plain_size);
    let sum = R::select(R::both(sound, smaller), half_sphere - slivers, plain);
    let ic2 = one / c2;
    let value = R::splat(0.5) * ic2 * sum;
    Jet {
        value,
        gradient: [in_plane[0], in_plane[1], -z * ic2 * (two * value + across)],
    }
}
