//! Primitives: bones with kernels, each of them a term of the field.
use crate::bone::Bone;
use crate::real::Scalar;
use crate::term::{Evaluate, Prepared, Term, curve_with_taper, place};
use crate::waves::Waves;
use crate::{AlongRay, Kernel, Profile, Real, Shaping, Skeleton, THRESHOLD};
use crate::{influence, reach};
use glam::DVec3;

/// A value and its gradient.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet<R> {
    /// The value.
    pub value: R,
    /// Derivatives along x, y and z.
    pub gradient: [R; 3],
}

impl<R: Real> Jet<R> {
    /// Jet of the zero function.
    #[inline(always)]
    #[must_use]
    pub fn zero() -> Self {
        Self {
            value: R::splat(0.0),
            gradient: [R::splat(0.0); 3],
        }
    }

    /// Jet of the sum of two functions.
    #[inline(always)]
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            gradient: core::array::from_fn(|i| self.gradient[i] + other.gradient[i]),
        }
    }

    /// Jet of a multiple of the function.
    #[inline(always)]
    #[must_use]
    pub fn times(self, factor: R) -> Self {
        Self {
            value: self.value * factor,
            gradient: self.gradient.map(|g| g * factor),
        }
    }
}

/// Term of the field: a skeleton convolved with a kernel.
///
/// `f(p) = height · ∫ h(|p−q|) dq` over the skeleton (for a point: `height·h`), times the profile.
/// With a [`Taper`](crate::Taper) height and width depend on q.
#[derive(Clone, Debug, PartialEq)]
pub struct Primitive {
    /// The bone.
    pub skeleton: Skeleton,
    /// The kernel.
    pub kernel: Kernel,
    /// The kernel's width parameter s, an inverse length; the largest, if it varies.
    pub width: f64,
    /// The factor on the whole: normalisation times strength; at the start, if it varies.
    pub height: f64,
    /// Depth of influence: beyond this distance from the skeleton |f| < ε·T.
    pub influence: f64,
    /// The profile, if any.
    pub profile: Option<Box<Profile>>,
    /// The shaping, if width and height vary along the skeleton.
    pub tapered: Option<Box<Shaping>>,
    pub(crate) prepared: Prepared,
}

/// Largest coordinate of a skeleton and largest size in kernel widths, so that fourth powers of
/// them are numbers of single precision.
const LARGEST_SIZE: f64 = 1e8;

/// Largest size, in kernel widths, of curves and bones that taper, which are integrated
/// numerically ([cones](Shaping::is_cone) are not).
pub const LONGEST: f64 = 1e4;

/// Returns the largest width parameter along a tapered bone: at an end, unless radius and
/// blobbiness change it in opposite directions; then the largest sample is near enough, as it is
/// smooth. `None` if the shaping is invalid somewhere.
fn largest_width(shaping: &Shaping) -> Option<f64> {
    (0..=64).try_fold(0.0, |largest: f64, i| {
        Some(largest.max(shaping.at(f64::from(i) / 64.0).width()?))
    })
}

impl Primitive {
    /// Prepares a primitive. `None` if the shaping gives no surface: radius, blobbiness or strength
    /// zero or not finite, the radius negative, the skeleton not finite, or larger than 10⁸ kernel
    /// widths ([`LONGEST`], if it is a curve or tapers).
    #[must_use]
    pub fn new(skeleton: Skeleton, shaping: &Shaping, profile: Option<Profile>) -> Option<Self> {
        let tapered = shaping.varies_along(&skeleton).then_some(*shaping);
        let (width, height) = match tapered {
            None => (shaping.width()?, shaping.height(&skeleton)?),
            Some(shaping) => (largest_width(&shaping)?, shaping.at(0.0).height(&skeleton)?),
        };
        let peak = profile.map_or(1.0, |p| p.largest());
        let usable = skeleton.is_finite() && peak.is_finite() && height != 0.0;
        let size = skeleton.size();
        let is_cone = shaping.is_cone(&skeleton);
        let numeric = tapered.is_some() && !is_cone || skeleton.is_numeric();
        if numeric && shaping.widths_along(skeleton.measure()) > LONGEST {
            return None;
        }
        if !usable || size * width > LARGEST_SIZE {
            return None;
        }
        let (frame, mut form) = place(&skeleton, shaping.kernel, width);
        let amplitude = match skeleton.dimension() {
            0 => height,
            1 => height / width,
            _ => height / (width * width),
        };
        if !amplitude.is_finite() {
            return None;
        }
        // A profile's parameters come from the untapered form, also for tapered bones.
        let waves = profile.map(|profile| Box::new(Waves::new(&profile, &form.bone)));
        if let Some(shaping) = tapered {
            let curve =
                curve_with_taper(&skeleton, &frame, (shaping.kernel, is_cone), &|fraction| {
                    let here = shaping.at(fraction);
                    let (s, h) = (here.width(), here.height(&skeleton));
                    let thin = s.unwrap_or(width) / width;
                    [h.unwrap_or(height) / height, thin * thin]
                });
            form.bone = Bone::Curve(Box::new(curve));
        }
        let level = THRESHOLD * shaping.influence.max(f64::MIN_POSITIVE);
        let influence = influence::depth(&form, amplitude.abs() * peak, level) / width;
        Some(Self {
            skeleton,
            kernel: shaping.kernel,
            width,
            height,
            influence,
            profile: profile.map(Box::new),
            tapered: tapered.map(Box::new),
            prepared: Prepared::new(Term {
                frame,
                form,
                amplitude,
                waves,
            }),
        })
    }

    /// Returns the formula and its constants in single precision.
    #[must_use]
    pub fn term(&self) -> &Term<f32> {
        &self.prepared.single
    }

    /// Value and gradient at a point.
    #[inline]
    #[must_use]
    pub fn jet<R: Evaluate>(&self, point: [R; 3]) -> Jet<R> {
        R::term_of(&self.prepared).jet(point)
    }

    /// Value alone.
    #[inline]
    #[must_use]
    pub fn value<R: Evaluate>(&self, point: [R; 3]) -> R {
        self.jet(point).value
    }

    /// Value without the profile.
    #[inline]
    #[must_use]
    pub fn plain_value<R: Evaluate>(&self, point: [R; 3]) -> R {
        let term = R::term_of(&self.prepared);
        R::evaluate(term, false, term.frame.local(point)).value
    }

    /// Returns an upper bound on the profile's factor between two points, at least 0; 1 without a
    /// profile.
    #[inline]
    #[must_use]
    pub fn factor_between<R: Evaluate>(&self, ends: [[R; 3]; 2]) -> R {
        R::term_of(&self.prepared).factor_between(ends)
    }

    /// Returns the ray interval outside which the primitive is beyond its depth of influence:
    /// parameters t of `origin + t·direction`, conservative. `None` if the ray misses it.
    ///
    /// The direction need not have unit length.
    #[must_use]
    pub fn ray_interval(&self, origin: DVec3, direction: DVec3) -> Option<[f64; 2]> {
        let Term { frame, form, .. } = &self.prepared.double;
        reach::interval(
            &form.bone,
            self.influence * self.width,
            frame.local_point(origin),
            frame.local_vector(direction),
        )
    }

    /// Returns a sphere (centre, radius) that holds all points within the depth of influence;
    /// `None` for a plane.
    #[must_use]
    pub fn bounding_sphere(&self) -> Option<(DVec3, f64)> {
        let (center, radius) = self.skeleton.bounding_sphere()?;
        Some((center, radius + self.influence))
    }

    /// Returns an upper bound on |f| anywhere at `distance` or more from the skeleton.
    #[must_use]
    pub fn most_beyond(&self, distance: f64) -> f64 {
        let term = &self.prepared.double;
        let peak = self.profile.as_ref().map_or(1.0, |p| p.largest());
        let distance = (distance * self.width).max(0.0);
        term.amplitude.abs() * peak * influence::most_beyond(&term.form, distance)
    }

    /// Bounds on a tapered bone, `None` for others: an upper bound on its length weighted with the
    /// height over `height`; one on that relative height; and a lower bound on the squared width
    /// parameter over `width²`.
    pub(crate) fn taper_bounds(&self) -> Option<[f64; 3]> {
        self.tapered.as_ref()?;
        let Bone::Curve(curve) = &self.prepared.double.form.bone else {
            return None;
        };
        let [mass, density, thinness] = curve.extremes();
        Some([mass / self.width, density, thinness])
    }

    /// Prepares evaluations of the field along the ray `origin + t·direction`.
    #[must_use]
    pub fn on_ray<S: Scalar + Evaluate>(&self, origin: DVec3, direction: DVec3) -> AlongRay<'_, S> {
        AlongRay::new(&self.prepared, origin, direction)
    }

    /// Value and derivative by t at `origin + t·direction`. For more than one evaluation on a ray,
    /// and for what origin to choose, see [`Primitive::on_ray`].
    #[must_use]
    pub fn along_ray<R: Evaluate<Scalar: Evaluate>>(
        &self,
        origin: DVec3,
        direction: DVec3,
        t: R,
    ) -> (R, R) {
        self.on_ray::<R::Scalar>(origin, direction).at(t)
    }
}
