//! Kernels h(r): the contribution of a point of the skeleton to the field at a distance.
//!
//! In units of the kernel's width (lengths times [`Shaping::width`](crate::Shaping::width)) every
//! kernel is a fixed function of u, the distance, and best written as a function G of the *square*
//! q = u²: its derivatives by q are all that values, gradients and bounds need.
//!
//! A kernel is a file in this folder, where all that is known of it stands: an implementation of
//! [`Falloff`], named in the list [`each_kernel`](crate::each_kernel). Its closed forms are in the
//! folder of its name, a file a bone.
use crate::bone::{Arc, Curve, Polygon, Segment, Triangle};
use crate::envelope::Roughness;
use crate::{Jet, Real};
pub use cells::{Cell, Cells};
use falloff::Falloff;
pub use falloff::Tail;
use serde::{Deserialize, Serialize};

mod cells;
pub(crate) mod falloff;
mod numeric;
pub(crate) mod polynomial;
mod taylor;

mod cauchy;
mod compact6;
pub(crate) mod cubed;
pub(crate) mod gauss;
mod inverse;
mod metaballs;
mod quartic;
mod soft;
mod squared;

/// Calls a macro with the list of all kernels, in the order of the chart, behind what else it is
/// given.
#[macro_export]
macro_rules! each_kernel {
    ($callback:ident! $given:tt) => {
        $callback! { $given
            cauchy: Cauchy;
            gauss: Gauss;
            inverse: Inverse;
            squared: Squared;
            metaballs: Metaballs;
            soft: Soft;
            quartic: Quartic;
            compact6: Compact6;
            cubed: Cubed;
        }
    };
}

/// Writes the type [`Kernel`].
macro_rules! kernel {
    (() $($module:ident: $kernel:ident;)*) => {
        /// A kernel: a decreasing function of distance (thesis, section 2.3; `compact6` and `cubed`
        /// are ours).
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
        pub enum Kernel {
            $(
                #[doc = concat!("See `kernel/", stringify!($module), ".rs`.")]
                $kernel,
            )*
        }

        impl Kernel {
            /// The kernels in the order of the chart.
            pub const ALL: [Self; [$(Self::$kernel),*].len()] = [$(Self::$kernel),*];
        }
    };
}
each_kernel!(kernel!());

/// Evaluates an expression with the [`Falloff`] of a kernel.
macro_rules! of {
    ((@ $value:expr, $Falloff:ident, $expression:expr) $($module:ident: $kernel:ident;)*) => {
        match $value {
            $(Kernel::$kernel => {
                type $Falloff = $module::$kernel;
                $expression
            })*
        }
    };
    ($kernel:expr, $Falloff:ident => $expression:expr) => {
        each_kernel!(of!(@ $kernel, $Falloff, $expression))
    };
}

/// Square of the distance (in radii) by which the poles of the inverse, the squared and the cubed
/// kernel are rounded off. At a radius from the skeleton that changes the field by 5·10⁻¹¹ of
/// itself (cubed: 1.5·10⁻¹⁰).
pub const POLE2: f64 = 1e-10;

/// G(q) and its derivatives by q.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Derivatives(pub [f64; 5]);

impl Default for Kernel {
    fn default() -> Self {
        Self::ALL[0]
    }
}

impl Kernel {
    /// Name in the dataset language.
    #[must_use]
    pub const fn name(self) -> &'static str {
        of!(self, K => K::NAME)
    }

    /// Returns the kernel of that name, `None` if there is none.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kernel| kernel.name() == name)
    }

    /// Its meaning in a few words.
    #[must_use]
    pub const fn meaning(self) -> &'static str {
        of!(self, K => K::MEANING)
    }

    /// Its definition, with u the distance in its widths.
    #[must_use]
    pub const fn formula(self) -> &'static str {
        of!(self, K => K::FORMULA)
    }

    /// How its fields are computed, for people.
    #[must_use]
    pub const fn cells(self) -> Cells {
        of!(self, K => K::CELLS)
    }

    /// The way in which it goes to 0.
    #[must_use]
    pub const fn tail(self) -> Tail {
        of!(self, K => K::TAIL)
    }

    /// Whether the kernel is 0 from u = 1 on.
    #[must_use]
    pub fn is_compact(self) -> bool {
        matches!(self.tail(), Tail::Compact)
    }

    /// Whether the kernel has a pole, rounded off, at u = 0. Such kernels have no width: their unit
    /// of length is the radius.
    #[must_use]
    pub fn has_pole(self) -> bool {
        self.tail().has_pole()
    }

    /// Whether the kernel's integral over an infinite line (1) or plane (2) is finite.
    #[must_use]
    pub fn is_finite_over(self, dimension: i32) -> bool {
        !matches!(self.tail(), Tail::Power { exponent, .. } if exponent <= dimension)
    }

    /// The places u at which a derivative of the kernel jumps, in increasing order.
    #[must_use]
    pub fn kinks(self) -> &'static [f64] {
        of!(self, K => K::KINKS)
    }

    /// Number of derivatives of `h` along a line that are continuous everywhere; `usize::MAX` for
    /// smooth kernels.
    #[must_use]
    pub fn smoothness(self) -> usize {
        of!(self, K => K::SMOOTHNESS)
    }

    /// Bounds inside a compact kernel's support ([`Falloff::INSIDE`]).
    pub(crate) fn inside(self) -> [f64; 2] {
        of!(self, K => K::INSIDE)
    }

    /// Whether G has no singularity ([`Falloff::ENTIRE`]).
    pub(crate) fn is_entire(self) -> bool {
        of!(self, K => K::ENTIRE)
    }

    /// Whether tapered segments have a closed form.
    pub(crate) fn has_cones(self) -> bool {
        of!(self, K => K::HAS_CONES)
    }

    /// The value at a distance u ≥ 0.
    #[must_use]
    pub fn value(self, u: f64) -> f64 {
        self.derivatives(u * u).0[0]
    }

    /// Returns an upper bound on the value, if possible more cheaply.
    #[inline]
    pub(crate) fn at_most(self, u: f64) -> f64 {
        of!(self, K => K::at_most(u))
    }

    /// G and its first four derivatives at q ≥ 0; at a kink those of the inner piece.
    #[must_use]
    pub fn derivatives(self, q: f64) -> Derivatives {
        Derivatives(of!(self, K => K::derivatives(q)))
    }

    /// Returns the q at which G is `1/ratio`.
    #[must_use]
    pub(crate) fn square_of(self, ratio: f64) -> f64 {
        of!(self, K => K::square_of(ratio))
    }

    /// G(q) and G′(q), lane by lane.
    #[inline(always)]
    pub(crate) fn pair<R: Real>(self, q: R) -> (R, R) {
        let (value, fall) = self.falling(q);
        (value, -fall)
    }

    /// Returns upper bounds on G(q) and −G′(q), cheaper than the values.
    #[inline(always)]
    pub(crate) fn falling_at_most<R: Real>(self, q: R) -> (R, R) {
        of!(self, K => K::falling_at_most(q))
    }

    /// G(q) and −G′(q), lane by lane.
    #[inline(always)]
    pub(crate) fn falling<R: Real>(self, q: R) -> (R, R) {
        of!(self, K => K::falling(q))
    }

    /// `∫₀ᵘ h`, along a line through the point.
    #[must_use]
    pub fn along(self, u: f64) -> f64 {
        of!(self, K => K::along(u))
    }

    /// `∫ₐᵇ h` along a line through the point, 0 ≤ a ≤ b.
    #[must_use]
    pub fn between(self, a: f64, b: f64) -> f64 {
        of!(self, K => K::between(a, b))
    }

    /// `∫ G` from p to q, 0 ≤ p ≤ q: over a ring around the point, of area π(q−p), the kernel's
    /// integral is π times this.
    #[must_use]
    pub fn over_ring(self, p: f64, q: f64) -> f64 {
        of!(self, K => K::over_ring(p, q))
    }

    /// `∫₀^q G`: over a disc around the point, of area πq, the kernel's integral is π times this.
    #[must_use]
    pub fn over_disc(self, q: f64) -> f64 {
        of!(self, K => K::over_disc(q))
    }

    /// Computes the field of an infinite line, by which segments, arcs and curves are normalised
    /// (fields.md, section 3.4), at a distance in kernel widths: `∫ h(√(x²+t²)) dt` over all t; for
    /// the inverse kernel, whose integral diverges, over |t| ≤ 10.
    #[must_use]
    pub fn line(self, distance: f64) -> f64 {
        of!(self, K => K::line(distance))
    }

    /// Computes a bound on [`Kernel::line`], given [`Kernel::at_most`] at that distance.
    #[inline]
    pub(crate) fn line_at_most(self, distance: f64, point: f64) -> f64 {
        of!(self, K => K::line_at_most(distance, point))
    }

    /// Computes the field of an infinite plane, and its derivative by z over −2πz.
    #[inline(always)]
    pub(crate) fn plane<R: Real>(self, z: R) -> (R, R) {
        of!(self, K => K::plane(z))
    }

    /// Computes the width parameter, times the radius, for a blobbiness
    /// ([`Shaping::width`](crate::Shaping::width)).
    pub(crate) fn width(self, blobbiness: f64) -> f64 {
        of!(self, K => K::width(blobbiness))
    }

    /// Computes a segment's field.
    #[inline(always)]
    pub(crate) fn segment<R: Real>(self, bone: &Segment<R::Scalar>, p: [R; 3]) -> Jet<R> {
        of!(self, K => K::segment(bone, p))
    }

    /// Computes an arc's field.
    #[inline(always)]
    pub(crate) fn arc<R: Real>(self, bone: &Arc<R::Scalar>, p: [R; 3]) -> Jet<R> {
        of!(self, K => K::arc(bone, p))
    }

    /// Computes a triangle's field.
    #[inline(always)]
    pub(crate) fn triangle<R: Real>(self, bone: &Triangle<R::Scalar>, p: [R; 3]) -> Jet<R> {
        of!(self, K => K::triangle(bone, p))
    }

    /// Computes a polygon's field.
    #[inline(always)]
    pub(crate) fn polygon<R: Real>(self, bone: &Polygon<R::Scalar>, p: [R; 3]) -> Jet<R> {
        of!(self, K => K::polygon(bone, p))
    }

    /// Computes the field of a curve, or of a bone whose width varies along it.
    #[inline]
    pub(crate) fn curve<R: Real>(self, bone: &Curve<R::Scalar>, p: [R; 3]) -> Jet<R> {
        of!(self, K => K::curve(bone, p))
    }

    /// Computes a bound on the field of an arc at distance d or more from it.
    pub(crate) fn arc_at_most(self, length: f64, radius: f64, d: f64) -> f64 {
        of!(self, K => K::arc_at_most(length, radius, d))
    }

    /// Computes bounds on the highest derivative at distance u or more by formulas, if it has any.
    #[inline(always)]
    pub(crate) fn roughness(self, u: f64) -> Option<Roughness> {
        of!(self, K => K::roughness(u))
    }

    /// Computes the value and [`Roughness::point`] by formulas, if it has any.
    #[inline(always)]
    pub(crate) fn value_and_roughness(self, u: f64) -> Option<(f64, f64)> {
        of!(self, K => K::value_and_roughness(u))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integral::integral;
    use taylor::Taylor;

    /// What a kernel's file overrides is what the definition gives.
    #[test]
    fn formulas_are_the_defaults() {
        for kernel in Kernel::ALL {
            of!(kernel, K => formulas_are_the_defaults_of::<K>());
        }
    }

    fn formulas_are_the_defaults_of<K: Falloff>() {
        let near = |what: &str, got: f64, want: f64, size: f64| {
            let name = K::NAME;
            let most = 1e-9 * (want.abs() + size);
            assert!((got - want).abs() <= most, "{name}, {what}: {got} {want}");
        };
        for u in [0.1, 0.2, 0.45, 0.9, 1.3, 3.0] {
            let q: f64 = u * u;
            let Taylor(g) = K::density(Taylor::<f64, 5>::variable(q));
            let factorials = [1.0, 1.0, 2.0, 6.0, 24.0];
            for ((got, g), factorial) in K::derivatives(q).into_iter().zip(g).zip(factorials) {
                near("derivative", got, factorial * g, 0.0);
            }
            let (value, fall) = K::falling(q);
            near("value", value, g[0], 0.0);
            near("fall", -fall, g[1], 0.0);
            if g[0] > 0.0 {
                near("square", K::square_of(1.0 / g[0]), q, 0.0);
            }
            near("disc", K::over_disc(q), numeric::ring::<K>(0.0, q), 0.0);
            near(
                "ring",
                K::over_ring(0.01, q),
                numeric::ring::<K>(0.01, q),
                0.0,
            );
            near("along", K::along(u), numeric::along::<K>(u), 0.0);
            if !K::TAIL.has_pole() {
                near("line", K::line(u), numeric::line::<K>(u), 0.0);
                let (value, slope) = K::plane(u);
                let (want, want_slope) = numeric::plane::<K, f64>(u);
                near("plane", value, want, 0.0);
                near("slope", slope, want_slope, 0.0);
            }
            if !matches!(K::TAIL, Tail::Power { .. }) {
                near("width", K::width(u), numeric::width::<K>(u), 0.0);
            }
        }
        let segment = Segment { half: 0.7 };
        let arc = [1.0, 4.0].map(|angle| Arc::new(0.8, angle));
        let triangle = Triangle::new([[-0.6, -0.4], [0.9, -0.3], [-0.2, 0.8]]);
        for p in [
            [0.3, 0.4, 0.2],
            [0.05, -0.1, 0.15],
            [1.1, 0.2, -0.3],
            [-0.7, 0.6, 0.5],
        ] {
            let pairs = [
                (
                    K::segment(&segment, p),
                    numeric::segment::<K, f64>(&segment, p),
                ),
                (K::arc(&arc[0], p), numeric::arc::<K, f64>(&arc[0], p)),
                (K::arc(&arc[1], p), numeric::arc::<K, f64>(&arc[1], p)),
                (
                    K::triangle(&triangle, p),
                    numeric::face::<K, f64>(&triangle.edges, p),
                ),
            ];
            for (got, want) in pairs {
                near("field", got.value, want.value, 1e-6);
                for (got, want) in got.gradient.into_iter().zip(want.gradient) {
                    near("gradient", got, want, 1.0);
                }
            }
        }
    }

    #[test]
    fn values_as_defined() {
        for u in [0.0, 0.1, 0.3, 0.5, 0.9, 1.0, 1.5] {
            let inside = |x: f64| if u <= 1.0 { x } else { 0.0 };
            let q: f64 = u * u;
            for (kernel, want) in [
                (Kernel::Cauchy, 1.0 / (1.0 + q).powi(2)),
                (Kernel::Gauss, libm::exp(-q)),
                (Kernel::Inverse, 1.0 / (q + 1e-10).sqrt()),
                (Kernel::Squared, 1.0 / (q + 1e-10)),
                (Kernel::Cubed, 1.0 / ((q + 1e-10) * (q + 1e-10).sqrt())),
                (
                    Kernel::Metaballs,
                    if u <= 1.0 / 3.0 {
                        1.0 - 3.0 * q
                    } else {
                        inside(1.5 * (1.0 - u) * (1.0 - u))
                    },
                ),
                (
                    Kernel::Soft,
                    inside(1.0 - 4.0 / 9.0 * q.powi(3) + 17.0 / 9.0 * q * q - 22.0 / 9.0 * q),
                ),
                (Kernel::Quartic, inside((1.0 - q).powi(2))),
                (Kernel::Compact6, inside((1.0 - q).powi(3))),
            ] {
                let value = kernel.value(u);
                assert!(
                    (value - want).abs() <= 1e-15 * want.max(1.0),
                    "{kernel:?} {u}"
                );
                let (pair, slope) = kernel.pair(q);
                assert!(
                    (pair - want).abs() <= 1e-15 * want.max(1.0),
                    "{kernel:?} {u}"
                );
                let slope_want = kernel.derivatives(q).0[1];
                assert!(
                    (slope - slope_want).abs() <= 1e-14 * slope_want.abs().max(1.0),
                    "{kernel:?} {u}"
                );
            }
        }
    }

    #[test]
    fn derivatives_and_integrals() {
        for kernel in Kernel::ALL {
            for q in [0.04, 0.2, 0.5, 0.8, 2.0] {
                let h = 1e-5;
                let (low, high) = (kernel.derivatives(q - h).0, kernel.derivatives(q + h).0);
                let here = kernel.derivatives(q).0;
                let (value, slope) = kernel.pair(q);
                assert!((value - here[0]).abs() <= 1e-15, "{kernel:?} {q}");
                assert!(
                    (slope - here[1]).abs() <= 1e-14 * here[1].abs(),
                    "{kernel:?} {q}"
                );
                for order in 1..5 {
                    let slope = (high[order - 1] - low[order - 1]) / (2.0 * h);
                    let tolerance = 1e-6 * here[order].abs().max(1.0);
                    assert!(
                        (slope - here[order]).abs() <= tolerance,
                        "{kernel:?} {q} {order}"
                    );
                }
                // From 0.1 on, clear of the poles.
                let u: f64 = q.sqrt();
                let breaks = [0.1, 1.0 / 3.0, 1.0, 2.0].map(|b: f64| b.min(u.max(0.1)));
                let along = integral(&mut |u| kernel.value(u), &breaks, 1e-13);
                let want = kernel.between(0.1, u.max(0.1));
                assert!(
                    (along - want).abs() < 1e-9,
                    "{kernel:?} {u}: {along} {want}"
                );
                // To the accuracy of doubles beside the pole's part.
                let digits = 1e-15 * kernel.along(u);
                let want = kernel.along(u) - kernel.along(0.1);
                assert!(
                    (along - want).abs() < 1e-9 + digits,
                    "{kernel:?} {u}: {along} {want}"
                );
                let squares = breaks.map(|b| b * b);
                let disc = integral(&mut |q| kernel.derivatives(q).0[0], &squares, 1e-13);
                let want = kernel.over_ring(0.01, q);
                assert!((disc - want).abs() < 1e-9, "{kernel:?} {q}: {disc} {want}");
                let want = kernel.over_disc(q) - kernel.over_disc(0.01);
                assert!((disc - want).abs() < 1e-9, "{kernel:?} {q}: {disc} {want}");
            }
        }
    }
}
