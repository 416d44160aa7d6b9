//! Counts of the work of tracing.
use serde::{Deserialize, Serialize};

/// Counts of the work of tracing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Stats {
    /// Rays from the eye.
    pub primary_rays: u64,
    /// Rays towards lights.
    pub shadow_rays: u64,
    /// Reflected and refracted rays.
    pub secondary_rays: u64,
    /// Evaluations of one primitive's field at one point.
    pub field_evaluations: u64,
    /// Pixels of a full pass that differ from the next one on the right or below, if there is a
    /// smooth pass: it takes more rays for about twice as many.
    pub edges: u64,
}

impl std::ops::AddAssign for Stats {
    fn add_assign(&mut self, other: Self) {
        self.primary_rays += other.primary_rays;
        self.shadow_rays += other.shadow_rays;
        self.secondary_rays += other.secondary_rays;
        self.field_evaluations += other.field_evaluations;
        self.edges += other.edges;
    }
}
