//! A scene's lumps, ready to be listed: what lists say of each is computed once.
use crate::beam::Beam;
use crate::hierarchy::Hierarchy;
use crate::nearby::{Extent, Near, Nearby};
use field::{Primitive, THRESHOLD};
use glam::DVec3;

/// Each lump is followed until its field is below this much of T, divided by the scene's number of primitives.
const LEFT_OUT: f64 = 2e-6;

/// In kernel widths. At a Gaussian's own surface −F″ ≤ 2T; with h = 0.6, `h²·2T` is about what the climb
/// allows ([`climb`](mod@crate::climb)).
const LEAD: f64 = 0.6;

/// Of each of a scene's primitives what lists of lumps say of it, if it is one.
#[derive(Default)]
pub struct Stock {
    lumps: Vec<Option<Item>>,
}

struct Item {
    middle: DVec3,
    near: Near,
    extent: Extent<f32>,
}

impl Stock {
    /// Looks at a scene's primitives, given with their materials.
    #[must_use]
    pub fn new(primitives: &[Primitive], material: &[u32]) -> Self {
        let left_out = LEFT_OUT * THRESHOLD / primitives.len().max(1) as f64;
        let item = |(p, material): (&Primitive, &u32)| {
            let lump = p.lump::<f32>()?;
            let square = lump.reach(left_out);
            Some(Item {
                middle: p.lump_middle(),
                near: Near {
                    lump,
                    middle: [0.0; 3],
                    square: square as f32,
                    // A little inside, so that rounding does not put it outside.
                    core: lump.core(square, left_out) as f32 - 1e-4,
                    lead: (LEAD / lump.ceiling().scale) as f32,
                    material: *material,
                    from: 0.0,
                },
                extent: Extent::of(&lump, lump.radius(square)),
            })
        };
        Self {
            lumps: primitives.iter().zip(material).map(item).collect(),
        }
    }

    /// The ball (middle, radius) beyond which a primitive is not followed, if it is a lump.
    #[must_use]
    pub fn ball(&self, primitive: usize) -> Option<(DVec3, f64)> {
        let item = self.lumps[primitive].as_ref()?;
        Some((item.middle, f64::from(item.extent.radius)))
    }

    /// Lists the lumps near a beam, up to a parameter; none if all together are nowhere T. False if the beam meets
    /// anything else. `tree` holds the balls of all primitives.
    pub fn list(&self, tree: &Hierarchy, beam: &Beam, limit: f64, list: &mut Nearby) -> bool {
        let mut found = Vec::new();
        let mut plain = true;
        tree.search(beam, |i, center, radius| {
            let near = beam.reach(center, radius)[0];
            if near < limit && plain {
                plain = self.lumps[i as usize].is_some();
                found.push((near, i));
            }
        });
        if !plain {
            return false;
        }
        found.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let base = found.first().map_or(0.0, |lump| lump.0);
        list.begin(beam.axis.at(base), base);
        for (near, i) in found {
            if let Some(item) = &self.lumps[i as usize] {
                let middle = (item.middle - list.middle).as_vec3().to_array();
                let from = (near - base) as f32;
                list.push(
                    Near {
                        middle,
                        // Rounded down.
                        from: from - from * 1e-6,
                        ..item.near
                    },
                    &item.extent,
                );
            }
        }
        true
    }
}
