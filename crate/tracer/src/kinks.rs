//! Where profiles of primitives are not smooth.
use field::{Kink, Primitive};
use std::collections::BTreeMap;

/// The places where primitives with profiles are not smooth; nothing is known of them in bodies of very many.
#[derive(Debug, Default)]
pub struct Kinks(BTreeMap<u32, Vec<Kink>>);

/// In larger bodies kinks are not looked for: a ray that meets one is settled alone, by all primitives.
const MOST_PRIMITIVES: usize = 16;

impl Kinks {
    /// Of some primitives, given with their numbers.
    pub fn new<'a>(primitives: impl ExactSizeIterator<Item = (u32, &'a Primitive)>) -> Self {
        if primitives.len() > MOST_PRIMITIVES {
            return Self::default();
        }
        let own = |(i, p): (u32, &'a Primitive)| {
            p.profile.as_ref()?;
            Some((i, field::kinks::of(p)))
        };
        Self(primitives.filter_map(own).collect())
    }

    /// Those of a primitive.
    #[must_use]
    pub fn of(&self, primitive: u32) -> &[Kink] {
        self.0.get(&primitive).map_or(&[], Vec::as_slice)
    }

    /// Whether there are none at all.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}
