//! The tools of drawing.

/// A tool of drawing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tool {
    /// Strokes become limbs.
    #[default]
    Draw,
    /// Nodes are moved, and made thicker or thinner.
    Move,
    /// Limbs are cut, nodes and curves removed.
    Cut,
}

impl Tool {
    /// The tools in the order of the strip.
    pub const ALL: [Self; 3] = [Self::Draw, Self::Move, Self::Cut];

    /// Returns the name in the page handle's status.
    #[must_use]
    pub fn id(self) -> &'static str {
        match self {
            Self::Draw => "draw",
            Self::Move => "move",
            Self::Cut => "cut",
        }
    }
}
