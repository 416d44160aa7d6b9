//! Bodies whose surfaces rays meet one at a time.
use crate::ray::Ray;
use crate::walk::Quest;
use glam::DVec3;

/// A body whose surface rays meet one at a time, in units of the scene's size.
pub(crate) trait Body: Send + Sync {
    /// Returns the body's number in the scene.
    fn number(&self) -> u32;

    /// Returns the parameter, > 0 and < `limit`, of a ray's first crossing that the quest asks for,
    /// [`Quest::First`] or [`Quest::Entry`], and the number of evaluations.
    fn first(&self, ray: &Ray, limit: f64, quest: Quest) -> (Option<f64>, u64);

    /// Returns all crossings of a ray, in order, found exactly, with the gradient there.
    fn all(&self, ray: &Ray) -> Vec<(f64, DVec3)>;

    /// Returns the gradient where a ray is at t. It points inwards.
    fn gradient(&self, ray: &Ray, t: f64) -> DVec3;

    /// Appends what the elements add to the field at a point: the element's number (`u32::MAX` if
    /// it is not in the scene), its finish, and its share.
    fn shares(&self, point: DVec3, shares: &mut Vec<(u32, u32, f64)>);

    /// Returns how far above the surface rays to the lights start from a hit at t.
    fn lift(&self, t: f64) -> f64;
}
