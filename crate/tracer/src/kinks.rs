//! Kinks of the primitives' profiles.
use field::{Kink, Primitive};

/// Kinks of primitives with profiles; not collected in bodies of more than [`MOST_PRIMITIVES`].
#[derive(Debug, Default)]
pub struct Kinks(Vec<(u32, Vec<Kink>)>);

/// Most primitives of a body whose kinks are collected: crossings of a ray that meets one are
/// isolated with all primitives.
const MOST_PRIMITIVES: usize = 16;

impl Kinks {
    /// Collects the kinks of some primitives, given with their numbers, which ascend.
    pub fn new<'a>(primitives: impl ExactSizeIterator<Item = (u32, &'a Primitive)>) -> Self {
        if primitives.len() > MOST_PRIMITIVES {
            return Self::default();
        }
        Self(
            primitives
                .filter(|(_, p)| p.profile.is_some())
                .map(|(i, p)| (i, field::kinks::of(p)))
                .collect(),
        )
    }

    /// Returns the kinks of a primitive.
    #[must_use]
    pub fn of(&self, primitive: u32) -> &[Kink] {
        let own = self.0.binary_search_by_key(&primitive, |own| own.0);
        own.map_or(&[], |own| &self.0[own].1)
    }

    /// Whether there are no kinks.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}
