//! Graphs of limbs that come from elsewhere than a file.

use crate::draft::Draft;
use crate::error::Error;
use crate::graph::{Cap, Graph, Limb};
use glam::DVec3;

/// Graph to which limbs and balls are added one by one, by their places.
#[derive(Default)]
pub struct Builder {
    draft: Draft,
}

impl Builder {
    /// Adds a limb between two places, with a radius at either, and the name of its kind.
    ///
    /// # Errors
    /// If a number is no place or radius, or there are too many limbs.
    pub fn limb(&mut self, ends: [DVec3; 2], radii: [f64; 2], kind: &str) -> Result<(), Error> {
        let group = self.draft.group(kind, None)?;
        let [a, b] = [0, 1].map(|side| self.draft.node(ends[side], radii[side], group));
        self.draft.add(Limb {
            ends: [a?, b?],
            radii,
            group,
            caps: [Cap::Round; 2],
            clip: None,
        })
    }

    /// Adds a ball.
    ///
    /// # Errors
    /// As [`Self::limb`].
    pub fn ball(&mut self, center: DVec3, radius: f64, kind: &str) -> Result<(), Error> {
        let group = self.draft.group(kind, None)?;
        let node = self.draft.node(center, radius, group)?;
        self.draft.ball(node);
        Ok(())
    }

    /// Returns the graph, in which limbs that end at the very same place share a node.
    ///
    /// # Errors
    /// If there are none, or too many.
    pub fn finish(mut self) -> Result<Graph, Error> {
        self.draft.weld();
        self.draft.finish(None)
    }
}
