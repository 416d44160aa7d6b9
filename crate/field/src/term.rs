//! Primitives made ready for evaluation: a closed form, and the frame in which it is written.
use crate::bone::curve::Law;
use crate::bone::{Bone, Curve};
use crate::form::Form;
use crate::kernel::cubed::cone::Cone;
use crate::skeleton::cubic;
use crate::waves::Waves;
use crate::{Jet, Kernel, Real, Skeleton};
use glam::{DMat3, DVec3};

/// Local coordinates: `axes·(p − origin)`; the axes are orthogonal and as long as the kernel's
/// width parameter s, so that local lengths are in units of the kernel's width.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Frame<S> {
    pub origin: [S; 3],
    pub axes: [[S; 3]; 3],
}

impl<S: Copy> Frame<S> {
    #[inline(always)]
    pub fn local<R: Real<Scalar = S>>(&self, p: [R; 3]) -> [R; 3] {
        let [x, y, z] = self.origin.map(R::lift);
        let d = [p[0] - x, p[1] - y, p[2] - z];
        self.axes.map(|axis| {
            let [ax, ay, az] = axis.map(R::lift);
            ax * d[0] + ay * d[1] + az * d[2]
        })
    }

    /// Transforms a gradient (a covector) from local to world coordinates.
    #[inline(always)]
    pub fn world<R: Real<Scalar = S>>(&self, g: [R; 3]) -> [R; 3] {
        core::array::from_fn(|i| {
            R::lift(self.axes[0][i]) * g[0]
                + R::lift(self.axes[1][i]) * g[1]
                + R::lift(self.axes[2][i]) * g[2]
        })
    }

    fn cast<Q>(&self, f: impl Fn(S) -> Q) -> Frame<Q> {
        Frame {
            origin: self.origin.map(&f),
            axes: self.axes.map(|axis| axis.map(&f)),
        }
    }
}

impl Frame<f64> {
    pub fn local_point(&self, p: DVec3) -> DVec3 {
        DVec3::from_array(self.local(p.to_array()))
    }

    pub fn local_vector(&self, v: DVec3) -> DVec3 {
        let [x, y, z] = self.axes.map(|axis| DVec3::from_array(axis).dot(v));
        DVec3::new(x, y, z)
    }
}

/// A number type in which fields are evaluated: `f64`, `f32` or `f32x8`. The chart's formulas are
/// too long to be compiled again wherever one is used, so they are compiled once for each of these,
/// in this crate.
pub trait Evaluate: Real {
    /// Selects the precision of a term prepared in both.
    #[doc(hidden)]
    fn term_of(term: &Prepared) -> &Term<Self::Scalar>;
    /// Computes a term's value and local gradient at a local position, with its profile or without.
    #[doc(hidden)]
    fn evaluate(term: &Term<Self::Scalar>, profiled: bool, local: [Self; 3]) -> Jet<Self>;
    /// Value and gradient of a point primitive at a position in world coordinates, see [`Term`].
    #[doc(hidden)]
    fn evaluate_point(term: &Term<Self::Scalar>, position: [Self; 3]) -> Jet<Self>;
}

/// Frame, form and factor.
#[derive(Clone, Debug, PartialEq)]
pub struct Term<S> {
    pub(crate) frame: Frame<S>,
    pub(crate) form: Form<S>,
    /// Factor on the form.
    pub(crate) amplitude: S,
    /// The profile, if any; boxed, since few primitives have one and it would be most of a
    /// primitive's size.
    pub(crate) waves: Option<Box<Waves<S>>>,
}

impl<S: Copy> Term<S> {
    /// Converts the constants, those of the profile apart, one by one in an order that is the same
    /// for all terms of a cell of the chart; a curve's pieces, of which there are more or fewer,
    /// come last.
    pub fn cast<Q>(
        &self,
        f: impl Fn(S) -> Q + Copy,
        of_profile: impl Fn(S) -> Q + Copy,
    ) -> Term<Q> {
        Term {
            frame: self.frame.cast(f),
            amplitude: f(self.amplitude),
            form: self.form.cast(f),
            waves: (self.waves.as_ref()).map(|waves| Box::new(waves.cast(of_profile))),
        }
    }

    /// Returns the names of the kernel and of the kind of bone: together the cell of the chart.
    #[must_use]
    pub fn cell(&self) -> [&'static str; 2] {
        let bone = match &self.form.bone {
            Bone::Point => "point",
            Bone::Segment(_) => "segment",
            Bone::Arc(_) => "arc",
            Bone::Triangle(_) => "triangle",
            Bone::Polygon(_) => "polygon",
            Bone::Plane => "plane",
            Bone::Curve(curve) if curve.cone.is_some() => "cone",
            Bone::Curve(curve) if curve.tapered => "taper",
            Bone::Curve(_) => "curve",
        };
        [self.form.kernel.name(), bone]
    }

    /// Returns the name of the place that the profile's waves run along; `None` without a profile.
    #[must_use]
    pub fn course(&self) -> Option<&'static str> {
        self.waves.as_ref().map(|waves| waves.course())
    }

    /// Computes value and gradient at a position in the world, without the profile.
    pub fn plain_jet<R: Real<Scalar = S>>(&self, p: [R; 3]) -> Jet<R> {
        if matches!(self.form.bone, Bone::Point) {
            return self.point_jet_inline(p);
        }
        let jet = self.form.jet(self.frame.local(p));
        let amplitude = R::lift(self.amplitude);
        Jet {
            value: amplitude * jet.value,
            gradient: self.frame.world(jet.gradient.map(|g| amplitude * g)),
        }
    }

    /// Computes the profile's factor and its gradient at a position in the world.
    pub fn factor<R: Real<Scalar = S>>(&self, p: [R; 3]) -> Option<Jet<R>> {
        let factor = self.waves.as_ref()?.jet(self.frame.local(p));
        Some(Jet {
            value: factor.value,
            gradient: self.frame.world(factor.gradient),
        })
    }

    /// Value and local gradient at a local position.
    #[inline(always)]
    pub(crate) fn local_jet<R: Evaluate<Scalar = S>>(&self, p: [R; 3]) -> Jet<R> {
        R::evaluate(self, true, p)
    }

    #[inline(always)]
    pub(crate) fn local_jet_inline<R: Real<Scalar = S>>(
        &self,
        profiled: bool,
        p: [R; 3],
    ) -> Jet<R> {
        let jet = self.form.jet(p);
        let amplitude = R::lift(self.amplitude);
        let jet = Jet {
            value: amplitude * jet.value,
            gradient: jet.gradient.map(|g| amplitude * g),
        };
        match self.waves.as_ref().filter(|_| profiled) {
            None => jet,
            Some(waves) => {
                let factor = waves.jet(p);
                Jet {
                    value: jet.value * factor.value,
                    gradient: core::array::from_fn(|i| {
                        jet.gradient[i] * factor.value + jet.value * factor.gradient[i]
                    }),
                }
            }
        }
    }

    /// Value and gradient of a point without a profile, whose frame is a mere scale, at a position
    /// in world coordinates.
    #[inline(always)]
    pub(crate) fn point_jet_inline<R: Real<Scalar = S>>(&self, p: [R; 3]) -> Jet<R> {
        let scale = R::lift(self.frame.axes[0][0]);
        let origin = self.frame.origin.map(R::lift);
        let horizon = R::splat(R::HORIZON);
        let local = core::array::from_fn(|i| {
            let x = (p[i] - origin[i]) * scale;
            x.min(horizon).max(-horizon)
        });
        let jet = self.form.kernel.jet(&Bone::Point, local);
        let amplitude = R::lift(self.amplitude);
        let steep = amplitude * scale;
        Jet {
            value: amplitude * jet.value,
            gradient: jet.gradient.map(|g| steep * g),
        }
    }

    /// Returns an upper bound on the value between two positions in the world, as a factor on the
    /// value without the profile.
    #[inline(always)]
    pub(crate) fn factor_between<R: Real<Scalar = S>>(&self, ends: [[R; 3]; 2]) -> R {
        let Some(waves) = &self.waves else {
            return R::splat(1.0);
        };
        waves.most_between(ends.map(|p| self.frame.local(p)))
    }

    /// Value and gradient at a position in the world.
    #[inline(always)]
    pub(crate) fn jet<R: Evaluate<Scalar = S>>(&self, p: [R; 3]) -> Jet<R> {
        if matches!(self.form.bone, Bone::Point) && self.waves.is_none() {
            return R::evaluate_point(self, p);
        }
        let local = self.local_jet(self.frame.local(p));
        Jet {
            value: local.value,
            gradient: self.frame.world(local.gradient),
        }
    }
}

/// Term in both precisions.
#[derive(Clone, Debug, PartialEq)]
pub struct Prepared {
    pub(crate) double: Term<f64>,
    pub(crate) single: Term<f32>,
}

impl Prepared {
    pub fn new(double: Term<f64>) -> Self {
        let round = |value: f64| value as f32;
        Self {
            single: double.cast(round, round),
            double,
        }
    }
}

/// The local frame and closed form of a skeleton, for the kernel's width parameter s.
pub(crate) fn place(skeleton: &Skeleton, kernel: Kernel, s: f64) -> (Frame<f64>, Form<f64>) {
    let (frame, bone) = skeleton.place(kernel, s);
    (frame, Form { kernel, bone })
}

/// Prepares a segment, an arc or a curve in its local frame, with a width and a height that vary
/// along it. `is_cone`: see [`crate::Shaping::is_cone`].
pub(crate) fn curve_with_taper(
    skeleton: &Skeleton,
    frame: &Frame<f64>,
    (kernel, is_cone): (Kernel, bool),
    law: Law<'_>,
) -> Curve<f64> {
    let cubics = |s: f64| -> Vec<_> {
        let cubics = skeleton.cubics(s).into_iter();
        let local = cubics.map(|control| cubic(control.map(|p| frame.local_point(p))));
        local.collect()
    };
    let fine = cubics(0.0);
    if let (true, Skeleton::Segment { base, apex }) = (kernel.has_cones(), skeleton)
        && (is_cone || !kernel.is_compact())
    {
        let half = 0.5 * frame.local_vector(*apex - *base).length();
        // A kernel's width parameter is 1/R.
        let radii = [0.0, 1.0].map(|end| 1.0 / law(end)[1].sqrt());
        if is_cone {
            return Curve::cone(Cone::of_support(half, radii));
        }
        if let Some(cone) = Cone::new(half, radii) {
            return Curve::straight(kernel, cone, fine[0], law);
        }
    }
    let scale = DVec3::from_array(frame.axes[0]).length();
    Curve::new(kernel, &fine, &cubics(scale), Some(law))
}

/// Makes a frame of unit axes.
pub(crate) fn frame(origin: DVec3, axes: DMat3, s: f64) -> Frame<f64> {
    Frame {
        origin: origin.to_array(),
        axes: [
            (axes.x_axis * s).to_array(),
            (axes.y_axis * s).to_array(),
            (axes.z_axis * s).to_array(),
        ],
    }
}
