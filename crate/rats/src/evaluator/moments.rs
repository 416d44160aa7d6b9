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
    /// The shapes that the frame's own run has frozen.
    pub frozen: Frozen,
    /// The steps that this run took, times the number of pictures that need others.
    pub steps: u64,
}

impl<'s, 'a: 's> Exposure<'s, 'a> {
    /// Makes the scenes of the picture of a number at the middles of equal shares of the time for
    /// which its shutter is open, `length` in frames: as many as the samples of a pixel if that is
    /// not too much work. None if nothing moves.
    pub fn moments(&self, number: usize, frame: &Scene, length: f64) -> Vec<Scene> {
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
            .map(|i| self.from + length * (i as f64 + 0.5) / count as f64)
            .map(|moment| self.at(moment, number).unwrap_or_else(|| frame.clone()))
            .collect();
        if scenes.iter().all(|scene| scene == frame) {
            return Vec::new();
        }
        scenes
    }

    /// Makes the scene of the picture of a number at a moment; `None` if there is none then.
    fn at(&self, moment: f64, number: usize) -> Option<Scene> {
        let scope = Scope::new(self.symbols.clone());
        let mut state = Evaluator::new(self.sources, self.assets, moment, scope);
        state.frozen = self.frozen.of_frame();
        let shot = state.run_all().into_iter().nth(number)?;
        Some(shot.scene)
    }
}
