//! Convolution surfaces that are found by another root finder than the tracer's own.
use crate::body::Body;
use crate::ray::Ray;
use crate::soft::Soft;
use crate::walk::Quest;
use field::{Bound, Primitive};
use glam::DVec3;
use std::sync::Arc;

/// A way of finding where single rays cross convolution surfaces, in the place of the tracer's own.
pub trait RootFinder: Send + Sync {
    /// Returns the parameter, > 0 and < `limit`, of a ray's first crossing that the quest asks for,
    /// [`Quest::First`] or [`Quest::Entry`], and the number of evaluations of one primitive at one
    /// point. `terms` are the primitives of a body that the ray may meet, with their bounds.
    fn first(
        &self,
        terms: &[(&Primitive, &Bound)],
        ray: &Ray,
        limit: f64,
        quest: Quest,
    ) -> (Option<f64>, u64);
}

/// A body whose convolution surface is found by a [`RootFinder`], whose hits are taken as they are.
pub(crate) struct FoundBody {
    /// The convolution surfaces of all bodies.
    pub soft: Arc<Soft>,
    /// The body's number among them.
    pub body: u32,
    pub finder: Arc<dyn RootFinder>,
}

/// Offset of shadow rays above a hit, in units of the scene's size: about as much as the hits of
/// the crudest root finder on one surface differ by direction.
const LIFT: f64 = 1e-3;

impl Body for FoundBody {
    fn number(&self) -> u32 {
        self.soft.bodies[self.body as usize].number
    }

    fn first(&self, ray: &Ray, limit: f64, quest: Quest) -> (Option<f64>, u64) {
        let mut terms = Vec::new();
        self.soft.along(self.body, ray, |primitive, bound, _| {
            terms.push((primitive, bound));
        });
        self.finder.first(&terms, ray, limit, quest)
    }

    fn all(&self, ray: &Ray) -> Vec<(f64, DVec3)> {
        self.soft.crossings(self.body, ray)
    }

    fn gradient(&self, ray: &Ray, t: f64) -> DVec3 {
        self.soft.gradient(self.body, ray, t)
    }

    fn shares(&self, point: DVec3, shares: &mut Vec<(u32, u32, f64)>) {
        self.soft.shares(self.body, point, shares);
    }

    fn lift(&self, _: f64) -> f64 {
        LIFT
    }
}
