//! The shapes that `transform` holds still while a shutter stays open.

use super::model::{Model, Part};
use glam::DAffine3;
use scene::Shape;
use std::ops::Range;

/// Shapes as `transform` commands found them, command by command.
#[derive(Clone, Debug, Default)]
pub struct Frozen {
    /// The shapes that the commands of this run have found.
    found: Vec<Vec<Still>>,
    /// The shapes that those of the frame's own run found, to which shapes go back.
    given: Option<Vec<Vec<Still>>>,
}

/// Shape and its place.
#[derive(Clone, Debug)]
struct Still {
    shape: Shape,
    moved: Option<Box<DAffine3>>,
    growth: f64,
}

impl Still {
    fn of(part: &Part) -> Self {
        Self {
            shape: part.element.shape.clone(),
            moved: part.moved.clone(),
            growth: part.growth,
        }
    }
}

impl Frozen {
    /// Makes the shapes for another moment of a frame whose own run froze these.
    pub fn of_frame(&self) -> Self {
        Self {
            found: Vec::new(),
            given: Some(self.found.clone()),
        }
    }

    /// Holds these shapes still: notes their places in the run of a frame, and puts them back there
    /// in that of another moment.
    pub fn hold(&mut self, model: &mut Model<'_>, range: Range<usize>) {
        let parts = &mut model.parts[range];
        let number = self.found.len();
        let Some(given) = &self.given else {
            self.found.push(parts.iter().map(Still::of).collect());
            return;
        };
        self.found.push(Vec::new());
        // Other shapes than in the frame itself: there is nothing to go back to.
        let Some(still) = given.get(number).filter(|still| still.len() == parts.len()) else {
            return;
        };
        for (part, still) in parts.iter_mut().zip(still) {
            part.element.shape = still.shape.clone();
            part.moved.clone_from(&still.moved);
            part.growth = still.growth;
        }
    }
}
