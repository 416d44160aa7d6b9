//! Contacts: bodies that press each other flat where they meet.

use crate::{ComposedSurface, Scene, Surface};
use contact::{Bulge, Squashed};
use field::Implicit;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Contact of two bodies, which touch and do not overlap. If a body is named twice, the folds of
/// its locally convolved skeletons do so.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Contact {
    /// Indices into [`Scene::bodies`].
    pub bodies: [u32; 2],
    /// Swelling of the bodies beside the contact.
    pub bulge: Bulge,
}

impl Scene {
    /// The bulge of a body whose folds touch.
    #[must_use]
    pub fn fold(&self, body: u32) -> Option<Bulge> {
        self.contacts
            .iter()
            .rev()
            .find(|c| c.bodies == [body; 2] && c.bulge.is_usable())
            .map(|contact| contact.bulge)
    }

    /// Returns the partners and bulges of each body that touches others.
    #[must_use]
    pub fn partners(&self) -> BTreeMap<u32, BTreeMap<u32, Bulge>> {
        let mut partners: BTreeMap<u32, BTreeMap<u32, Bulge>> = BTreeMap::new();
        for contact in self.contacts.iter().filter(|c| c.bulge.is_usable()) {
            let [a, b] = contact.bodies;
            if a != b {
                partners.entry(a).or_default().insert(b, contact.bulge);
                partners.entry(b).or_default().insert(a, contact.bulge);
            }
        }
        partners
    }

    /// The surfaces of the bodies, given without contacts, as they press each other.
    pub(crate) fn in_contact(&self, surfaces: Vec<Surface>) -> Vec<Surface> {
        let partners = self.partners();
        if partners.is_empty() {
            return surfaces;
        }
        // Those without a partner stay as they are; of the others each is its own and its partners'
        // function.
        let shared: Vec<Result<Surface, ComposedSurface>> = surfaces
            .into_iter()
            .map(|surface| match partners.contains_key(&surface.body()) {
                false => Ok(surface),
                true => Err(surface.composed()),
            })
            .collect();
        let functions: BTreeMap<u32, Arc<dyn Implicit>> = shared
            .iter()
            .filter_map(|surface| surface.as_ref().err())
            .map(|surface| (surface.body, Arc::clone(&surface.function)))
            .collect();
        let squashed = shared.into_iter().map(|surface| match surface {
            Ok(alone) => alone,
            Err(mut touching) => {
                let others = partners[&touching.body].iter().filter_map(|(body, bulge)| {
                    let function = functions.get(body)?;
                    Some((Arc::clone(function), *bulge))
                });
                let others: Vec<_> = others.collect();
                touching.function = Arc::new(Squashed::new(touching.function, others));
                Surface::Composed(touching)
            }
        });
        squashed.collect()
    }
}
