//! The convolution surfaces of a scene: which elements are soft, and the field that those of each
//! body make together.

use crate::{Curves, Element, Ends, Flesh, Frame, Function, Scene, Shape};
use crate::{curves, limbs};
use field::shaping::SLIMMEST;
use field::{Primitive, Skeleton, Sum};

/// The convolution surface of a body, and which element each of its primitives came from.
#[derive(Clone, Debug, Default)]
pub struct SoftSurface {
    /// Index of the body in [`Scene::bodies`].
    pub body: u32,
    /// The sum of the soft elements' fields; the surface is where it equals [`field::THRESHOLD`].
    pub sum: Sum,
    /// Index in [`Scene::elements`] of the element of each primitive of the sum.
    pub element: Vec<u32>,
}

impl Scene {
    /// Whether an element belongs to the soft surface of its body under the present settings.
    #[must_use]
    pub fn is_soft(&self, element: &Element) -> bool {
        let drawn = (element.finish as usize) < self.finishes.len();
        let is_function = drawn && matches!(element.shape, Shape::Function(_));
        self.settings.soft && (is_function || self.flesh_of(element).is_some())
    }

    /// Whether an element adds primitives to the soft surface of its body.
    fn is_convolved(&self, element: &Element) -> bool {
        self.settings.soft
            && self.flesh_of(element).is_some()
            && element.shape.curves().is_none_or(|c| c.local.is_none())
    }

    /// The flesh of an element that has a skeleton and a finish, whether or not soft elements are
    /// drawn soft. Skeletons of curves are soft with any flesh.
    fn flesh_of(&self, element: &Element) -> Option<&Flesh> {
        let flesh = self.flesh.get(element.flesh? as usize)?;
        let is_soft = match element.shape.curves() {
            Some(_) => true,
            None => element.shape.skeleton().is_some() && flesh.is_soft(),
        };
        let drawn = (element.finish as usize) < self.finishes.len();
        (drawn && is_soft).then_some(flesh)
    }

    /// Returns an element's flesh in lengths of the world; `None` if it has none.
    #[must_use]
    pub fn flesh_in_world(&self, element: &Element) -> Option<Flesh> {
        let flesh = self.flesh_of(element)?;
        Some(flesh.scaled(self.frame(element).growth, self.settings.blob_scale))
    }

    /// The frame of an element.
    #[must_use]
    pub fn frame(&self, element: &Element) -> Frame {
        let frame = self.frames.get(element.frame as usize);
        frame.copied().unwrap_or_default()
    }

    /// The radius that counts for an element: for soft elements that of the flesh where
    /// `fragile` says so and it is given, else the shape's. With `soft off` the offset surface of
    /// such an element is drawn at the same radius. A cone keeps its own two radii; this is the
    /// larger one.
    #[must_use]
    pub fn radius(&self, element: &Element) -> f64 {
        let own = element.shape.radius();
        self.radius_of_flesh(element).unwrap_or(own)
    }

    /// The radius of a soft element's flesh; `None` if the shape's own radius counts.
    #[must_use]
    pub fn radius_of_flesh(&self, element: &Element) -> Option<f64> {
        let bone = element.shape.bone()?;
        let flesh = self.flesh_in_world(element)?;
        let fragile = self.settings.fragile;
        let overruled = match (&bone.skeleton, bone.ends) {
            _ if bone.end_radius.is_some() => return None,
            (Skeleton::Point { .. }, _) => fragile.sphere,
            (Skeleton::Segment { .. }, Ends::Open) => fragile.pipe,
            (Skeleton::Segment { .. }, _) => fragile.cylinder,
            // Faces have no radius of their own in the language.
            (line_or_face, _) => fragile.arc || line_or_face.dimension() == 2,
        };
        // Some commands write shapes without a radius (`dot`, `line`).
        if !overruled && bone.radius != 0.0 {
            return None;
        }
        let given = if flesh.depth > 0.0 {
            let dimension = bone.skeleton.dimension();
            self.shaping(element, &flesh, 1.0)
                .radius_of_depth(flesh.depth, dimension)
                .unwrap_or(0.0)
        } else {
            // A tip may be at the start.
            let end = flesh.end_radius.unwrap_or(0.0);
            flesh.radius.max(SLIMMEST * end)
        };
        (given > 0.0).then_some(given)
    }

    /// Whether a soft element's skeleton is integrated numerically, and too long for that.
    #[must_use]
    pub fn is_too_long(&self, element: &Element) -> bool {
        let Some(flesh) = self.flesh_in_world(element) else {
            return false;
        };
        if let Shape::Function(function) = &element.shape {
            let mut limbs = self.segments_of(element, function, &flesh);
            return limbs.any(|(skeleton, shaping)| {
                let widths = shaping.widths_along(skeleton.measure());
                let is_numeric = shaping.taper.is_some() && !shaping.is_cone(&skeleton);
                is_numeric && widths > field::primitive::LONGEST
            });
        }
        let shaping = self.shaping(element, &flesh, self.radius(element));
        element.shape.skeleton().is_some_and(|skeleton| {
            let is_line = skeleton.dimension() == 1;
            let is_taper = is_line && shaping.taper.is_some() && !shaping.is_cone(skeleton);
            let is_numeric = skeleton.is_numeric() || is_taper;
            is_numeric && shaping.widths_along(skeleton.most_length()) > field::primitive::LONGEST
        })
    }

    /// The segments of a skeleton of curves, with their shapings in lengths of the world.
    pub(crate) fn segments_of<'a>(
        &'a self,
        element: &'a Element,
        function: &'a Function,
        flesh: &'a Flesh,
    ) -> impl Iterator<Item = (Skeleton, field::Shaping)> + 'a {
        let blobbiness = flesh.blobbiness.unwrap_or(curves::BLOBBINESS);
        let growth = function.growth();
        let pieces = function.curves().into_iter().flat_map(Curves::pieces);
        pieces.map(move |[(base, start), (apex, end)]| {
            let [base, apex] = [base, apex].map(|p| function.to_world.transform_point3(p));
            let [start, end] = [start, end].map(|radius| radius * growth);
            let shaping = field::Shaping {
                kernel: flesh.kernel.unwrap_or(element.kernel),
                radius: start.max(SLIMMEST * end),
                blobbiness,
                blob_scale: self.settings.blob_scale,
                strength: flesh.strength,
                influence: self.settings.influence,
                taper: (start != end).then_some(field::Taper {
                    radius: end,
                    blobbiness,
                }),
            };
            (Skeleton::Segment { base, apex }, shaping)
        })
    }

    /// The kernel's parameters for an element with this radius and this flesh, in lengths of the
    /// world.
    #[must_use]
    pub fn shaping(&self, element: &Element, flesh: &Flesh, radius: f64) -> field::Shaping {
        let bone = element.shape.bone();
        let (radius, end_radius) = match bone.and_then(|bone| Some((bone.radius, bone.end_radius?)))
        {
            // A tip may be at the start.
            Some((start, end)) => {
                let start = start.max(SLIMMEST * end);
                (start, (end != start).then_some(end))
            }
            None => (radius, flesh.end_radius),
        };
        let blobbiness = flesh.blobbiness.unwrap_or(curves::BLOBBINESS);
        let tapers = end_radius.is_some() || flesh.end_blobbiness.is_some();
        field::Shaping {
            kernel: flesh.kernel.unwrap_or(element.kernel),
            radius,
            blobbiness,
            blob_scale: self.settings.blob_scale,
            strength: flesh.strength,
            influence: self.settings.influence,
            taper: tapers.then(|| field::Taper {
                radius: end_radius.unwrap_or(radius),
                blobbiness: flesh.end_blobbiness.unwrap_or(blobbiness),
            }),
        }
    }

    /// The primitives of all bodies that have some, in the order of [`Scene::bodies`]. A body may
    /// have functions beside them: its whole function is that of [`Scene::surfaces`].
    #[must_use]
    pub fn soft_surfaces(&self) -> Vec<SoftSurface> {
        let mut surfaces: Vec<SoftSurface> = Vec::new();
        let mut of_body = vec![None; self.bodies.len()];
        // As many primitives as there are elements, unless limbs are cut: growing lists would take
        // up to twice the room.
        let mut counts = vec![0; self.bodies.len()];
        for element in self.elements.iter().filter(|e| self.is_convolved(e)) {
            if let Some(count) = counts.get_mut(element.body as usize) {
                *count += 1;
            }
        }
        for (body, &count) in counts.iter().enumerate().filter(|(_, count)| **count > 0) {
            of_body[body] = Some(surfaces.len());
            surfaces.push(SoftSurface {
                body: body as u32,
                sum: Sum::new(Vec::with_capacity(count)),
                element: Vec::with_capacity(count),
            });
        }
        for (index, element) in self.elements.iter().enumerate() {
            let surface = of_body.get(element.body as usize).copied().flatten();
            if let (Some(surface), true) = (surface, self.is_convolved(element)) {
                let SoftSurface {
                    sum, element: of, ..
                } = &mut surfaces[surface];
                self.primitives_of(element, |primitive| {
                    sum.primitives.push(primitive);
                    of.push(index as u32);
                });
            }
        }
        surfaces.retain(|surface| !surface.sum.primitives.is_empty());
        surfaces
    }

    /// Calls `f` with each primitive of a soft element: one, or several where a long limb is cut.
    fn primitives_of(&self, element: &Element, f: impl FnMut(Primitive)) {
        let Some(flesh) = self.flesh_in_world(element) else {
            return;
        };
        if let Shape::Function(function) = &element.shape {
            let limbs = self.segments_of(element, function, &flesh);
            let is_flat = match function.curves() {
                Some(curves) if !curves.flat.is_empty() => curves.is_in_stump(),
                _ => Vec::new(),
            };
            let limbs = limbs.zip((0..).map(|i| is_flat.get(i) == Some(&true)));
            let limbs = limbs.filter(|(_, is_flat)| !is_flat).map(|(limb, _)| limb);
            let pieces = limbs.flat_map(|(skeleton, shaping)| limbs::cut(skeleton, shaping));
            pieces
                .filter_map(|(skeleton, shaping)| Primitive::new(skeleton, &shaping, None))
                .for_each(f);
            return;
        }
        let Some(skeleton) = element.shape.skeleton().cloned() else {
            return;
        };
        let shaping = self.shaping(element, &flesh, self.radius(element));
        let rest = self.between_flat_ends(element, skeleton, shaping);
        rest.into_iter()
            .flat_map(|(skeleton, shaping)| self.primitives_along(element, skeleton, shaping))
            .for_each(f);
    }

    /// Returns the primitives of a bone of an element, or of a piece of it.
    pub(crate) fn primitives_along(
        &self,
        element: &Element,
        skeleton: Skeleton,
        shaping: field::Shaping,
    ) -> impl Iterator<Item = Primitive> {
        let flesh = self.flesh_of(element);
        let profile = flesh.and_then(|flesh| match skeleton {
            Skeleton::Triangle { .. } => flesh.whole_profile(),
            // They have no parameters that a profile could follow.
            Skeleton::Polygon { .. } => None,
            ref line if line.is_numeric() => None,
            _ => flesh.profile,
        });
        // A profile runs along the whole skeleton.
        let pieces = match profile {
            None => limbs::cut(skeleton, shaping),
            Some(_) => vec![(skeleton, shaping)],
        };
        // An element without a positive radius has no flesh; the language has said so.
        pieces
            .into_iter()
            .filter_map(move |(skeleton, shaping)| Primitive::new(skeleton, &shaping, profile))
    }
}
