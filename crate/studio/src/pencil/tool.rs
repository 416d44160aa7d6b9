//! What a hand does with the pencil.

/// What the hand does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tool {
    /// Strokes become limbs.
    #[default]
    Draw,
    /// Nodes are moved, and made thicker or thinner.
    Move,
    /// Limbs are cut, nodes and curves taken away.
    Cut,
}

impl Tool {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Draw, Self::Move, Self::Cut];

    /// Its name in the page handle's status.
    #[must_use]
    pub fn id(self) -> &'static str {
        match self {
            Self::Draw => "draw",
            Self::Move => "move",
            Self::Cut => "cut",
        }
    }
}
