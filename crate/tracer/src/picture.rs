//! A scene made ready for tracing.
use crate::{Pass, Tile};
use glam::DVec3;
use scene::Scene;
use serde::{Deserialize, Serialize};

/// Counts of work done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Stats {
    /// Rays from the eye.
    pub primary_rays: u64,
    /// Rays towards lights.
    pub shadow_rays: u64,
    /// Evaluations of one primitive's field at one point.
    pub field_evaluations: u64,
}

/// A point where a ray crosses a surface.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Hit {
    /// Ray parameter (distance, as directions are unit vectors).
    pub t: f64,
    /// The point.
    pub position: DVec3,
    /// Outward unit normal.
    pub normal: DVec3,
}

/// A scene made ready for tracing at one size.
pub struct Picture {}

impl Picture {
    /// Prepares a scene. `size` is the picture's width and height in pixels, each > 0.
    #[must_use]
    pub fn new(scene: &Scene, size: [u32; 2]) -> Self {
        let _ = (scene, size);
        todo!()
    }

    /// Traces one tile and writes RGBA bytes (`4·width·height`, rows from the top, alpha 255).
    ///
    /// `stop` is asked now and then; when it says true the tile is given up and `None` comes back.
    #[must_use]
    pub fn trace(
        &self,
        tile: Tile,
        pass: Pass,
        stop: &dyn Fn() -> bool,
        stats: &mut Stats,
    ) -> Option<Vec<u8>> {
        let _ = (tile, pass, stop, stats);
        todo!()
    }

    /// All crossings of a ray with surfaces, soft and hard, in order of t > 0.
    #[must_use]
    pub fn hits(&self, origin: DVec3, direction: DVec3) -> Vec<Hit> {
        let _ = (origin, direction);
        todo!()
    }
}
