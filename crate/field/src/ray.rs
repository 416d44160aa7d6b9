//! Fields of primitives along rays.
use crate::real::Scalar;
use crate::term::{Evaluate, Prepared, Term};
use glam::DVec3;

/// A primitive seen along a ray `origin + t·direction`.
///
/// The ray is brought to the primitive's frame in double precision, so that in single precision no
/// digits are lost to coordinates that are large compared to the primitive. They are still lost
/// to a large t: choose the origin near the primitive, for example at the start of
/// [`ray_interval`](crate::Primitive::ray_interval), and count t from there.
#[derive(Clone, Copy, Debug)]
pub struct AlongRay<'a, S> {
    term: &'a Term<S>,
    origin: [S; 3],
    direction: [S; 3],
}

impl<'a, S: Scalar + Evaluate> AlongRay<'a, S> {
    pub(crate) fn new(prepared: &'a Prepared, origin: DVec3, direction: DVec3) -> Self {
        let frame = &prepared.double.frame;
        let round = |v: DVec3| v.to_array().map(S::round);
        Self {
            term: S::term_of(prepared),
            origin: round(frame.local_point(origin)),
            direction: round(frame.local_vector(direction)),
        }
    }

    /// Value and derivative by t.
    #[inline]
    #[must_use]
    pub fn at<R: Evaluate<Scalar = S>>(&self, t: R) -> (R, R) {
        let [dx, dy, dz] = self.direction.map(R::lift);
        let [ox, oy, oz] = self.origin.map(R::lift);
        let jet = self.term.local_jet([ox + t * dx, oy + t * dy, oz + t * dz]);
        let [gx, gy, gz] = jet.gradient;
        (jet.value, gx * dx + gy * dy + gz * dz)
    }
}
