//! Kernels h(r): the contribution of a point of the skeleton to the field at a distance.
//!
//! In units of the kernel's width (lengths times [`Shaping::width`](crate::Shaping::width)) every
//! kernel is a fixed function of u, the distance, and best written as a function G of the *square*
//! q = u²: its derivatives by q are all that values, gradients and bounds need.
//!
//! A kernel is a file in this folder, where all that is known of it stands: an implementation of
//! [`Falloff`], named in the list [`each_kernel`](crate::each_kernel). Its closed forms are in the
//! folder of its name, a file a bone.
use crate::bone::Bone;
use crate::envelope::Roughness;
use crate::{Jet, Real};
use cells::{ALONG, AROUND, EDGE, HEIGHT, WINDOWED, cell};
pub use cells::{Cell, Cells};
use falloff::Falloff;
pub use falloff::Tail;
use serde::{Deserialize, Serialize};

mod cells;
pub(crate) mod falloff;
mod numeric;
pub(crate) mod polynomial;

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
/// Half-length, in radii, of the finite lines and planes that stand for infinite ones where those
/// have no finite field: around the foot of the perpendicular, so that they are still the same
/// everywhere.
pub const WINDOW: f64 = 10.0;

impl Default for Kernel {
    fn default() -> Self {
        Self::ALL[0]
    }
}

/// Writes functions of [`Kernel`] that return the constants of its [`Falloff`].
macro_rules! constants {
    ($($(#[$doc:meta])* $visibility:vis $function:ident = $NAME:ident: $Type:ty;)*) => {
        impl Kernel {$(
            $(#[$doc])*
            #[must_use]
            $visibility const fn $function(self) -> $Type {
                of!(self, K => K::$NAME)
            }
        )*}
    };
}

constants! {
    /// Returns the name in the dataset language.
    pub name = NAME: &'static str;
    /// Returns the meaning in a few words.
    pub meaning = MEANING: &'static str;
    /// Returns the definition, with u the distance in its widths.
    pub formula = FORMULA: &'static str;
    /// Returns the formulas of its fields and the methods of computing them, for people.
    pub cells = CELLS: Cells;
    /// Returns the way in which it goes to 0.
    pub tail = TAIL: Tail;
    /// Returns the places u at which a derivative of the kernel jumps, in increasing order.
    pub kinks = KINKS: &'static [f64];
    /// Returns the number of derivatives of `h` along a line that are continuous everywhere;
    /// `usize::MAX` for smooth kernels.
    pub smoothness = SMOOTHNESS: usize;
    /// Returns bounds inside a compact kernel's support ([`Falloff::INSIDE`]).
    pub(crate) inside = INSIDE: [f64; 2];
    /// Whether G has no singularity ([`Falloff::ENTIRE`]).
    pub(crate) is_entire = ENTIRE: bool;
    /// Whether tapered segments have a closed form.
    pub(crate) has_cones = HAS_CONES: bool;
}

/// Writes functions of [`Kernel`] that call those of its [`Falloff`].
macro_rules! forward {
    ($(
        $(#[$attribute:meta])*
        $visibility:vis fn $function:ident$(<$R:ident>)?($($value:ident: $Type:ty),*)
            -> $Output:ty;
    )*) => {
        impl Kernel {$(
            $(#[$attribute])*
            #[must_use]
            $visibility fn $function$(<$R: Real>)?(self, $($value: $Type),*) -> $Output {
                of!(self, K => K::$function($($value),*))
            }
        )*}
    };
}

forward! {
    /// Computes G and its first four derivatives by q ≥ 0; at a kink those of the inner piece.
    pub fn derivatives(q: f64) -> [f64; 5];
    /// Computes `∫₀ᵘ h`, along a line through the point.
    pub fn along(u: f64) -> f64;
    /// Computes `∫ₐᵇ h` along a line through the point, 0 ≤ a ≤ b.
    pub fn between(a: f64, b: f64) -> f64;
    /// Computes `∫ G` from p to q, 0 ≤ p ≤ q: over a ring around the point, of area π(q−p), the
    /// kernel's integral is π times this.
    pub fn over_ring(p: f64, q: f64) -> f64;
    /// Computes the field of an infinite line, by which segments, arcs and curves are normalised
    /// (fields.md, section 3.4), at a distance in kernel widths: `∫ h(√(x²+t²)) dt` over all t; for
    /// the inverse kernel, whose integral diverges, over |t| ≤ 10.
    pub fn line(distance: f64) -> f64;
    pub(crate) fn square_of(ratio: f64) -> f64;
    pub(crate) fn width(blobbiness: f64) -> f64;
    pub(crate) fn arc_at_most(length: f64, radius: f64, d: f64) -> f64;
    #[inline]
    pub(crate) fn at_most(u: f64) -> f64;
    #[inline]
    pub(crate) fn line_at_most(distance: f64, point: f64) -> f64;
    #[inline(always)]
    pub(crate) fn falling<R>(q: R) -> (R, R);
    #[inline(always)]
    pub(crate) fn falling_at_most<R>(q: R) -> (R, R);
    #[inline(always)]
    pub(crate) fn plane<R>(z: R) -> (R, R);
    #[inline(always)]
    pub(crate) fn jet<R>(bone: &Bone<R::Scalar>, p: [R; 3]) -> Jet<R>;
    #[inline(always)]
    pub(crate) fn roughness(u: f64) -> Option<Roughness>;
    #[inline(always)]
    pub(crate) fn value_and_roughness(u: f64) -> Option<(f64, f64)>;
}

impl Kernel {
    /// Returns the kernel of that name, `None` if there is none.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kernel| kernel.name() == name)
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

    /// Computes the value at a distance u ≥ 0.
    #[must_use]
    pub fn value(self, u: f64) -> f64 {
        self.derivatives(u * u)[0]
    }
}

/// Computes `factor·g·iⁿ` with the factor of n, for n from 0 to 4.
fn powers(g: f64, i: f64, factors: [f64; 5]) -> [f64; 5] {
    core::array::from_fn(|n| (0..n).fold(factors[n] * g, |power, _| power * i))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bone::{Arc, Segment, Triangle};

    /// A kernel's formulas are what its derivatives give.
    #[test]
    fn formulas_are_the_defaults() {
        let faults = Kernel::ALL
            .map(|kernel| of!(kernel, K => faults::<K>()))
            .concat();
        assert!(faults.is_empty(), "{faults:#?}");
    }

    /// Returns the formulas that are off: kernel, name, value, and value by default.
    fn faults<K: Falloff>() -> Vec<(&'static str, &'static str, f64, f64)> {
        let mut faults = Vec::new();
        let mut near = |name: &'static str, got: f64, want: f64, relative: f64, size: f64| {
            let error = (got - want).abs();
            if error.is_nan() || error > relative * (want.abs() + size) {
                faults.push((K::NAME, name, got, want));
            }
        };
        for u in [0.1, 0.2, 0.45, 0.9, 1.3, 3.0] {
            let q: f64 = u * u;
            let here = K::derivatives(q);
            let (value, fall) = K::falling(q);
            near("value", value, here[0], 1e-15, 0.0);
            near("fall", fall, -here[1], 1e-14, 0.0);
            if value > 0.0 {
                near("square", K::square_of(1.0 / value), q, 1e-9, 0.0);
            }
            // From 0.1 on, clear of the poles.
            let between = numeric::between::<K>(0.1, u);
            near("between", K::between(0.1, u), between, 1e-11, 0.0);
            let along = numeric::between::<K>(0.0, u);
            near("along", K::along(u), along, 1e-9, 0.0);
            let [ring, _] = numeric::ring::<K>(0.005, q - 0.005);
            near("ring", K::over_ring(0.005, q), ring, 1e-9, 0.0);
            near("line", K::line(u), numeric::line::<K>(u), 1e-9, 0.0);
            let (plane, want) = (K::plane(u), numeric::plane::<K, f64>(u));
            near("plane", plane.0, want.0, 1e-9, 0.0);
            near("slope", plane.1, want.1, 1e-9, 0.0);
            near("width", K::width(u), numeric::width::<K>(u), 1e-9, 0.0);
        }
        let arcs = [1.0, 4.0].map(|angle| Bone::Arc(Arc::new(0.8, angle)));
        let [short, long] = &arcs;
        let triangle = Triangle::new([[-0.6, -0.4], [0.9, -0.3], [-0.2, 0.8]]);
        let faces = Bone::Triangle(Box::new(triangle));
        for p in [
            [0.3, 0.4, 0.2],
            [0.05, -0.1, 0.15],
            [1.1, 0.2, -0.3],
            [-0.7, 0.6, 0.5],
        ] {
            for bone in [&Bone::Segment(Segment { half: 0.7 }), short, long, &faces] {
                let (got, want) = (K::jet(bone, p), numeric::jet::<K, f64>(bone, p));
                near("field", got.value, want.value, 1e-9, 1e-6);
                for (got, want) in got.gradient.into_iter().zip(want.gradient) {
                    near("gradient", got, want, 1e-9, 1.0);
                }
            }
        }
        faults
    }
}
