//! The scene at the moments of a shutter that stays open.

use super::frozen::Frozen;
use super::state::Evaluator;
use crate::asset::Asset;
use crate::limits::{MAX_ELEMENTS, MAX_MOMENTS, MAX_STEPS};
use crate::scope::Scope;
use crate::sources::Sources;
use crate::symbol::Symbols;
use scene::Scene;

/// Fewest moments that show a movement.
const FEWEST: usize = 4;

/// A frame whose shutter stays open.
pub struct Exposure<'s, 'a> {
    pub sources: &'s Sources<'a>,
    pub assets: &'s [Asset],
    pub symbols: Symbols<'a>,
    /// The time when the shutter opens, in frames.
    pub from: f64,
    /// The time for which it is open, in frames.
    pub length: f64,
    /// The shapes that the frame's own run has frozen.
    pub frozen: Frozen,
    /// The steps that this run took.
    pub steps: u64,
}

impl<'s, 'a: 's> Exposure<'s, 'a> {
    /// Makes the scenes at the middles of equal shares of the exposure: as many as the samples of a
    /// pixel if that is not too much work. None if nothing moves.
    pub fn moments(self, frame: &Scene) -> Vec<Scene> {
        let rays = (frame.settings.samples * frame.settings.samples) as usize;
        let in_time = 4 * MAX_STEPS / self.steps.max(1);
        let in_room = 2 * MAX_ELEMENTS / frame.elements.len().max(1);
        let count = rays
            .clamp(FEWEST, MAX_MOMENTS)
            .min(in_time as usize)
            .min(in_room);
        if count < 2 {
            return Vec::new();
        }
        let scenes: Vec<Scene> = (0..count)
            .map(|i| self.at(self.from + self.length * (i as f64 + 0.5) / count as f64))
            .collect();
        if scenes.iter().all(|scene| scene == frame) {
            return Vec::new();
        }
        scenes
    }

    /// Makes the scene at a moment.
    fn at(&self, moment: f64) -> Scene {
        let scope = Scope::new(self.symbols.clone());
        let mut state = Evaluator::new(self.sources, self.assets, moment, scope);
        state.frozen = self.frozen.of_frame();
        state.run_all().0
    }
}
