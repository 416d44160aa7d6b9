//! Shapes: bones with radii, boxes, quadrics and functions. The geometry of bones is that of
//! [`field::skeleton`], a file for each.

use crate::{Curves, Function, Quadric};
use field::Skeleton;
use field::skeleton::{Map, cross, fits};
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Shape, in the world's coordinates.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Shape {
    /// A bone with a radius.
    Bone(Bone),
    /// Box that may be turned and sheared. It has no skeleton and stays hard.
    Box(Cuboid),
    /// Piece of a surface of the second degree. It has no skeleton and stays hard.
    Quadric(Box<Quadric>),
    /// Function of space, soft without any flesh. It has no skeleton.
    Function(Box<Function>),
}

/// Bone with a radius. When soft, the bone is convolved; when hard, its offset surface is drawn: a
/// ball, a tube, a prism, a slab.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bone {
    /// The bone itself.
    pub skeleton: Skeleton,
    /// Radius of the ball or tube, half the thickness of a face, ≥ 0. 0: a face without thickness,
    /// or the flesh's radius counts.
    pub radius: f64,
    /// Radius at the other end of a line, along which it varies evenly. Then both are the shape's
    /// own, whatever the flesh says; at least one is > 0.
    pub end_radius: Option<f64>,
    /// Ends of a line.
    pub ends: Ends,
    /// First and last end of a line that is soft: where one is not round its surface ends in a
    /// plane.
    pub soft_ends: [Ends; 2],
    /// Normals that light sees at the corners of a triangle without thickness (Phong's
    /// interpolation); any length but 0.
    pub normals: Option<Box<[DVec3; 3]>>,
}

/// Ends of a tube.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Ends {
    /// Half balls.
    Round,
    /// Flat lids.
    Lids,
    /// Nothing: the tube is a wall. Pictures of soft ones show the plane; meshes have a hole there.
    Open,
}

/// Points `center + Σ sᵢ·axisᵢ`, −1 ≤ sᵢ ≤ 1.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cuboid {
    /// Middle.
    pub center: DVec3,
    /// Vectors from the middle to the middles of three faces; they span a volume.
    pub axes: [DVec3; 3],
}

impl Bone {
    /// Returns the radii at both ends if `radius` counts for the shape; radii of its own that vary
    /// count before it.
    #[must_use]
    pub fn radii(&self, radius: f64) -> [f64; 2] {
        self.end_radius
            .map_or([radius; 2], |end| [self.radius, end])
    }

    /// Returns the noun for the shape.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match (&self.skeleton, self.ends, self.end_radius) {
            (Skeleton::Point { .. }, ..) => "sphere",
            (Skeleton::Segment { .. }, _, Some(_)) => "cone",
            (Skeleton::Segment { .. }, Ends::Open, _) => "pipe",
            (Skeleton::Segment { .. }, ..) => "cylinder",
            (other, ..) => other.name(),
        }
    }
}

impl Cuboid {
    /// Returns the lowest and the highest corner of the box around it.
    #[must_use]
    pub fn bounds(&self) -> (DVec3, DVec3) {
        let [x, y, z] = self.axes.map(DVec3::abs);
        let reach = x + y + z;
        (self.center - reach, self.center + reach)
    }

    /// Returns its edges.
    fn edges(&self) -> Vec<Vec<DVec3>> {
        let mut edges = Vec::with_capacity(12);
        for k in 0..3 {
            let [u, v, w] = [0, 1, 2].map(|i| self.axes[(k + i) % 3]);
            for (a, b) in [(1.0, 1.0), (1.0, -1.0), (-1.0, -1.0), (-1.0, 1.0)] {
                let middle = self.center + v * a + w * b;
                edges.push(vec![middle - u, middle + u]);
            }
        }
        edges
    }

    fn transform(&self, map: &dyn Map) -> Self {
        Self {
            center: map.point(self.center),
            axes: self.axes.map(|axis| map.vector(axis)),
        }
    }
}

impl Shape {
    /// Makes a shape of a bone that has a radius.
    #[must_use]
    pub fn new(skeleton: Skeleton, radius: f64, ends: Ends) -> Self {
        Self::Bone(Bone {
            skeleton,
            radius,
            end_radius: None,
            ends,
            soft_ends: [Ends::Round; 2],
            normals: None,
        })
    }

    /// Makes a ball; soft, a point.
    #[must_use]
    pub fn sphere(center: DVec3, radius: f64) -> Self {
        Self::new(Skeleton::Point { center }, radius, Ends::Round)
    }

    /// Makes a cylinder with flat lids; soft, a segment.
    #[must_use]
    pub fn cylinder(base: DVec3, apex: DVec3, radius: f64) -> Self {
        Self::new(Skeleton::Segment { base, apex }, radius, Ends::Lids)
    }

    /// Makes the wall of a cylinder, without lids; soft, a segment.
    #[must_use]
    pub fn pipe(base: DVec3, apex: DVec3, radius: f64) -> Self {
        Self::new(Skeleton::Segment { base, apex }, radius, Ends::Open)
    }

    /// Makes a cone cut off at both ends, with flat lids; soft, a segment whose radius in isolation
    /// varies evenly.
    #[must_use]
    pub fn cone(base: DVec3, base_radius: f64, apex: DVec3, apex_radius: f64) -> Self {
        Self::Bone(Bone {
            skeleton: Skeleton::Segment { base, apex },
            radius: base_radius,
            end_radius: Some(apex_radius),
            ends: Ends::Lids,
            soft_ends: [Ends::Round; 2],
            normals: None,
        })
    }

    /// Makes a piece of a torus with flat lids, around an arc (see [`Skeleton::Arc`]) of the radius
    /// `sweep`.
    #[must_use]
    pub fn arc(center: DVec3, [u, v]: [DVec3; 2], sweep: f64, angle: f64, radius: f64) -> Self {
        let skeleton = Skeleton::Arc {
            center,
            u,
            v,
            radius: sweep,
            angle,
        };
        Self::new(skeleton, radius, Ends::Lids)
    }

    /// Makes a tube around a cubic Bézier curve, round at its ends.
    #[must_use]
    pub fn curve(control: [DVec3; 4], radius: f64) -> Self {
        Self::new(Skeleton::Curve { control }, radius, Ends::Round)
    }

    /// Makes a triangle; with a radius, a prism of thickness `2·radius`.
    #[must_use]
    pub fn triangle(corners: [DVec3; 3], radius: f64) -> Self {
        Self::new(Skeleton::Triangle { corners }, radius, Ends::Lids)
    }

    /// Makes a flat triangle that is lit as if it were curved, by the normals at its corners.
    #[must_use]
    pub fn patch(corners: [DVec3; 3], normals: [DVec3; 3]) -> Self {
        Self::Bone(Bone {
            skeleton: Skeleton::Triangle { corners },
            radius: 0.0,
            end_radius: None,
            ends: Ends::Lids,
            soft_ends: [Ends::Round; 2],
            normals: Some(Box::new(normals)),
        })
    }

    /// Makes a polygon with holes (see [`Skeleton::Polygon`]); with a radius, a prism of thickness
    /// `2·radius`.
    #[must_use]
    pub fn polygon(rings: Vec<Vec<DVec3>>, radius: f64) -> Self {
        Self::new(Skeleton::Polygon { rings }, radius, Ends::Lids)
    }

    /// Makes a plane; with a radius, a slab of thickness `2·radius`.
    #[must_use]
    pub fn plane(point: DVec3, normal: DVec3, radius: f64) -> Self {
        Self::new(Skeleton::Plane { point, normal }, radius, Ends::Lids)
    }

    /// Makes a box.
    #[must_use]
    pub fn cuboid(center: DVec3, axes: [DVec3; 3]) -> Self {
        Self::Box(Cuboid { center, axes })
    }

    /// Returns the bone with its radius, if the shape is one.
    #[must_use]
    pub fn bone(&self) -> Option<&Bone> {
        match self {
            Self::Bone(bone) => Some(bone),
            Self::Box(_) | Self::Quadric(_) | Self::Function(_) => None,
        }
    }

    /// Returns the bone that is convolved. Shapes without one stay as they are with any material.
    #[must_use]
    pub fn skeleton(&self) -> Option<&Skeleton> {
        self.bone().map(|bone| &bone.skeleton)
    }

    /// The shape's own radius (its tube, ball or half thickness; of a cone, the larger one). 0 for
    /// what has none.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.bone().map_or(0.0, |bone| {
            let [start, end] = bone.radii(bone.radius);
            start.max(end)
        })
    }

    /// The shape's curves, if it is a skeleton of such.
    #[must_use]
    pub fn curves(&self) -> Option<&Curves> {
        match self {
            Self::Function(function) => function.curves(),
            Self::Bone(_) | Self::Box(_) | Self::Quadric(_) => None,
        }
    }

    /// Returns the lowest and the highest corner of a box around the shape, if `radius` counts for
    /// its bone; `None` for a plane. NaN if a coordinate is NaN.
    #[must_use]
    pub fn bounds(&self, radius: f64) -> Option<(DVec3, DVec3)> {
        match self {
            Self::Bone(bone) => bone.skeleton.bounds(radius),
            Self::Box(cuboid) => Some(cuboid.bounds()),
            Self::Quadric(quadric) => Some(quadric.cuboid().bounds()),
            Self::Function(function) => Some(function.corners()),
        }
    }

    /// Returns a ball (centre, radius) that holds the bone or the shape; `None` for a plane.
    #[must_use]
    pub fn bounding_sphere(&self) -> Option<(DVec3, f64)> {
        match self {
            Self::Bone(bone) => bone.skeleton.bounding_sphere(),
            Self::Box(Cuboid { center, axes }) => {
                Some((*center, axes.iter().map(|axis| axis.length()).sum()))
            }
            Self::Quadric(quadric) => Self::Box(quadric.cuboid()).bounding_sphere(),
            Self::Function(function) => {
                let (low, high) = function.corners();
                Some((0.5 * (low + high), 0.5 * low.distance(high)))
            }
        }
    }

    /// Returns the middle of the bone or the shape.
    #[must_use]
    pub fn middle(&self) -> DVec3 {
        match self {
            Self::Bone(bone) => bone.skeleton.middle(),
            Self::Box(cuboid) => cuboid.center,
            Self::Quadric(quadric) => quadric.center,
            Self::Function(function) => function.middle(),
        }
    }

    /// Returns the places by which a person knows the shape, with their names.
    #[must_use]
    pub fn landmarks(&self) -> Vec<(DVec3, &'static str)> {
        match self {
            Self::Bone(bone) => bone.skeleton.landmarks(),
            Self::Box(_) | Self::Quadric(_) => vec![(self.middle(), "the centre")],
            Self::Function(_) => vec![(self.middle(), "the middle")],
        }
    }

    /// Returns points of the bone, as many as suit a quick look at its field.
    #[must_use]
    pub fn samples(&self) -> Vec<DVec3> {
        match self {
            Self::Bone(bone) => bone.skeleton.samples(),
            Self::Box(_) | Self::Quadric(_) => vec![self.middle()],
            Self::Function(function) => function.axis(),
        }
    }

    /// Returns the lines that draw the bone, each through some points. `size` is the length of
    /// lines for what has no size: a piece of a plane; a cross is 0.3 times as long.
    #[must_use]
    pub fn lines(&self, size: f64) -> Vec<Vec<DVec3>> {
        match self {
            Self::Bone(bone) => bone.skeleton.lines(size),
            Self::Box(cuboid) => cuboid.edges(),
            Self::Function(function) if function.curves().is_some() => {
                let pieces = function.curves().into_iter().flat_map(Curves::pieces);
                let to_world = &function.to_world;
                pieces
                    .map(|ends| ends.map(|(p, _)| to_world.transform_point3(p)).to_vec())
                    .collect()
            }
            Self::Quadric(_) | Self::Function(_) => cross(self.middle(), size),
        }
    }

    /// Whether no coordinate or length is larger than a limit, or not finite.
    #[must_use]
    pub fn is_within(&self, limit: f64) -> bool {
        let is_placed = match self {
            Self::Bone(bone) => bone.skeleton.is_within(limit),
            Self::Box(Cuboid {
                center,
                axes: [x, y, z],
            }) => [center, x, y, z].iter().all(|p| fits(**p, limit)),
            Self::Quadric(quadric) => Self::Box(quadric.cuboid()).is_within(limit),
            Self::Function(function) => {
                let (low, high) = function.corners();
                fits(low, limit) && fits(high, limit)
            }
        };
        is_placed && self.radius().abs() <= limit
    }

    /// Returns why the shape cannot be drawn, as a sentence; `None` if its geometry allows it.
    #[must_use]
    pub fn fault(&self) -> Option<String> {
        let reason = match self {
            Self::Bone(bone) => format!("this {}{}", bone.name(), bone.skeleton.fault()?),
            Self::Box(cuboid) if crate::quadric::inverse(cuboid.axes).is_none() => {
                "this box has no volume".into()
            }
            Self::Quadric(quadric) if !quadric.is_surface() => {
                "this quadric is no surface, or its box has no volume".into()
            }
            Self::Function(own) if own.curves().is_none() && own.implicit().is_none() => {
                "this function's numbers cannot be computed with".into()
            }
            Self::Box(_) | Self::Quadric(_) | Self::Function(_) => return None,
        };
        Some(reason + ", so it is left out")
    }

    /// Maps the shape. If the map is not uniform, round shapes stay round.
    #[must_use]
    pub fn transform(&self, map: &dyn Map) -> Self {
        match self {
            Self::Bone(bone) => Self::Bone(Bone {
                skeleton: bone.skeleton.transform(map),
                radius: map.length(bone.radius),
                end_radius: bone.end_radius.map(|radius| map.length(radius)),
                ends: bone.ends,
                soft_ends: bone.soft_ends,
                normals: (bone.normals.as_ref())
                    .map(|normals| Box::new(normals.map(|normal| map.normal(normal)))),
            }),
            Self::Box(cuboid) => Self::Box(cuboid.transform(map)),
            Self::Quadric(quadric) => {
                let Cuboid { center, axes } = quadric.cuboid().transform(map);
                Self::Quadric(Box::new(Quadric {
                    center,
                    axes,
                    ..**quadric
                }))
            }
            Self::Function(function) => Self::Function(Box::new(function.moved(&map.affine()))),
        }
    }
}

/// The middle of the box around shapes, and the radius of the ball around that middle which holds
/// it. Planes are left out, as they are endless; `None` if nothing else is there.
#[must_use]
pub fn extent<'s>(shapes: impl Iterator<Item = &'s Shape>) -> Option<(DVec3, f64)> {
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for (a, b) in shapes.filter_map(|shape| shape.bounds(shape.radius())) {
        (low, high) = (low.min(a), high.max(b));
    }
    let size = high - low;
    (size.is_finite() && size.min_element() >= 0.0)
        .then(|| (0.5 * (low + high), 0.5 * size.length()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn box_around_balls() {
        let [one, other] = [1.0, 3.0].map(|x| Shape::sphere(DVec3::X * x, 1.0));
        let plane = Shape::plane(DVec3::ZERO, DVec3::Y, 0.0);
        let (middle, radius) = extent([&one, &plane, &other].into_iter()).expect("balls");
        assert_eq!(middle, DVec3::new(2.0, 0.0, 0.0));
        assert_eq!(radius, DVec3::new(2.0, 1.0, 1.0).length());
        assert_eq!(extent([&plane].into_iter()), None);
    }

    #[test]
    fn lines_end_where_their_shapes_end() {
        let axes = [DVec3::X, DVec3::Y];
        let arc = Shape::arc(DVec3::ZERO, axes, 2.0, core::f64::consts::PI, 0.1);
        let line = &arc.lines(1.0)[0];
        assert_eq!(line[0], DVec3::X * 2.0);
        assert!(line[line.len() - 1].distance(DVec3::X * -2.0) < 1e-12);
        let edges = Shape::cuboid(DVec3::ONE, [DVec3::X, DVec3::Y, DVec3::Z]).lines(1.0);
        assert_eq!(edges.len(), 12);
        assert!(edges.iter().all(|edge| edge[0].distance(edge[1]) == 2.0));
    }
}
