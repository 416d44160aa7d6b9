//! Which elements are soft, and the convolution field they make together.

use crate::limbs;
use crate::{Element, Fragile, Material, Scene, Shape};
use field::shaping::SLIMMEST;
use field::{Field, Primitive, Skeleton};

/// The convolution surface of a scene: the field, and which element each primitive came from.
#[derive(Clone, Debug)]
pub struct SoftSurface {
    /// The sum of all soft elements' fields; the surface is where it equals [`field::THRESHOLD`].
    pub field: Field,
    /// For each primitive of `field`, the index of its element in [`Scene::elements`].
    pub element: Vec<usize>,
}

impl Scene {
    /// Whether an element belongs to the convolution surface under the present settings.
    #[must_use]
    pub fn is_soft(&self, element: &Element) -> bool {
        self.settings.soft && self.material_is_soft(element)
    }

    fn material_is_soft(&self, element: &Element) -> bool {
        element.shape.has_skeleton()
            && self
                .materials
                .get(element.material)
                .is_some_and(crate::Material::is_soft)
    }

    /// The radius that counts for an element: for soft materials the material's own where
    /// `fragile` says so and it is given, else the shape's. With `soft off` the offset surface of
    /// such an element is drawn at the same radius. A cone keeps its own two radii; this is the
    /// larger one.
    #[must_use]
    pub fn radius(&self, element: &Element) -> f64 {
        let own = element.shape.radius();
        if !self.material_is_soft(element) {
            return own;
        }
        let Fragile {
            arc,
            pipe,
            cylinder,
            sphere,
        } = self.settings.fragile;
        let material = &self.materials[element.material];
        let given = if material.depth > 0.0 {
            let shaping = self.shaping(element, material, 1.0);
            let dimension = match element.shape {
                Shape::Sphere { .. } => 0,
                Shape::Cylinder { .. }
                | Shape::Pipe { .. }
                | Shape::Arc { .. }
                | Shape::Curve { .. } => 1,
                Shape::Triangle { .. }
                | Shape::Patch { .. }
                | Shape::Polygon { .. }
                | Shape::Plane { .. } => 2,
                Shape::Cone { .. } | Shape::Box { .. } | Shape::Quadric(_) => return own,
            };
            let radius = shaping.radius_of_depth(material.depth, dimension);
            radius.unwrap_or(0.0)
        } else {
            // A tip may be at the start.
            let end = material.end_radius.unwrap_or(0.0);
            material.radius.max(SLIMMEST * end)
        };
        let overruled = match element.shape {
            Shape::Arc { .. } | Shape::Curve { .. } => arc,
            Shape::Cylinder { .. } => cylinder,
            Shape::Pipe { .. } => pipe,
            Shape::Sphere { .. } => sphere,
            // These have no radius of their own in the language.
            Shape::Triangle { .. }
            | Shape::Patch { .. }
            | Shape::Polygon { .. }
            | Shape::Plane { .. } => true,
            Shape::Cone { .. } | Shape::Box { .. } | Shape::Quadric(_) => return own,
        };
        // Some commands write shapes without a radius (`dot`, `line`).
        if (overruled || own == 0.0) && given > 0.0 {
            given
        } else {
            own
        }
    }

    /// Whether an element's bone is one that is integrated numerically, and too long for that.
    #[must_use]
    pub fn is_too_long(&self, element: &Element) -> bool {
        let material = &self.materials[element.material];
        let shaping = self.shaping(element, material, self.radius(element));
        let tapers = shaping.taper.is_some();
        // From above: an arc's circle, a curve's control polygon.
        let length = match &element.shape {
            Shape::Curve { control, .. } => control.windows(2).map(|w| w[0].distance(w[1])).sum(),
            Shape::Cylinder { base, apex, .. }
            | Shape::Pipe { base, apex, .. }
            | Shape::Cone { base, apex, .. }
                if tapers =>
            {
                base.distance(*apex)
            }
            Shape::Arc { sweep, angle, .. } if tapers => sweep * angle,
            _ => return false,
        };
        shaping.widths_along(length) > field::primitive::LONGEST
    }

    /// What the field is told of an element with this radius.
    fn shaping(&self, element: &Element, material: &Material, radius: f64) -> field::Shaping {
        // A cone brings its own radii, whatever its material's.
        let (radius, end_radius) = match element.shape {
            Shape::Cone {
                base_radius,
                apex_radius,
                ..
            } => {
                // A tip may be at the start.
                let start = base_radius.max(SLIMMEST * apex_radius);
                (start, (apex_radius != start).then_some(apex_radius))
            }
            _ => (radius, material.end_radius),
        };
        let tapers = end_radius.is_some() || material.end_blobbiness.is_some();
        field::Shaping {
            kernel: material.kernel.unwrap_or(element.kernel),
            radius,
            blobbiness: material.blobbiness,
            blob_scale: self.settings.blob_scale,
            strength: material.strength,
            influence: self.settings.influence,
            taper: tapers.then(|| field::Taper {
                radius: end_radius.unwrap_or(radius),
                blobbiness: material.end_blobbiness.unwrap_or(material.blobbiness),
            }),
        }
    }

    /// The field of all soft elements.
    #[must_use]
    pub fn soft_surface(&self) -> SoftSurface {
        // As many as there are, unless limbs are cut: growing lists would take up to twice the room.
        let count = self.elements.iter().filter(|e| self.is_soft(e)).count();
        let mut field = Field {
            primitives: Vec::with_capacity(count),
        };
        let mut indices = Vec::with_capacity(count);
        for (index, element) in self.elements.iter().enumerate() {
            if !self.is_soft(element) {
                continue;
            }
            let material = &self.materials[element.material];
            let skeleton = match element.shape.clone() {
                Shape::Sphere { center, .. } => Skeleton::Point { center },
                Shape::Cylinder { base, apex, .. }
                | Shape::Pipe { base, apex, .. }
                | Shape::Cone { base, apex, .. } => Skeleton::Segment { base, apex },
                Shape::Arc {
                    center,
                    u,
                    v,
                    sweep,
                    angle,
                    ..
                } => Skeleton::Arc {
                    center,
                    u,
                    v,
                    radius: sweep,
                    angle,
                },
                Shape::Triangle { corners, .. } | Shape::Patch { corners, .. } => {
                    Skeleton::Triangle { corners }
                }
                Shape::Polygon { rings, .. } => Skeleton::Polygon { rings },
                Shape::Curve { control, .. } => Skeleton::Curve { control },
                Shape::Plane { point, normal, .. } => Skeleton::Plane { point, normal },
                Shape::Box { .. } | Shape::Quadric(_) => continue,
            };
            let shaping = self.shaping(element, material, self.radius(element));
            let profile = match skeleton {
                Skeleton::Triangle { .. } => material.whole_profile(),
                // They have no parameters that a profile could follow.
                Skeleton::Polygon { .. } | Skeleton::Curve { .. } => None,
                _ => material.profile,
            };
            // A profile runs along the whole bone.
            let pieces = match profile {
                None => limbs::cut(skeleton, shaping),
                Some(_) => vec![(skeleton, shaping)],
            };
            for (bone, shaping) in pieces {
                // An element without a positive radius has no flesh; the language has said so.
                if let Some(primitive) = Primitive::new(bone, &shaping, profile) {
                    field.primitives.push(primitive);
                    indices.push(index);
                }
            }
        }
        SoftSurface {
            field,
            element: indices,
        }
    }
}
