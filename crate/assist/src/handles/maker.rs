//! The handles of one element, from the numbers of its command.

use super::handle::{Editable, Handle, Kind, Moves, handle};
use field::Skeleton;
use glam::{DMat3, DVec3};
use rats::Placement;
use rats::commands::{Kind as Takes, Role};
use rats::provenance::{Operand, Provenance};
use scene::{Cuboid, Element, Flesh, Scene, Shape};

/// Maker of the handles of one element, from its scene, its way from its command, the axes of the
/// view, and the sources of its command's numbers.
pub struct Maker<'a> {
    pub scene: &'a Scene,
    pub element: &'a Element,
    pub placement: &'a Placement,
    pub view: &'a DMat3,
    pub seen: &'a Provenance,
}

impl Maker<'_> {
    /// Returns the handles of all operands that stand for places, radii and angles, and of the
    /// material's radius if that counts.
    pub fn handles(&self) -> Vec<Handle> {
        let mut handles = Vec::new();
        for (index, operand) in self.seen.operands.iter().enumerate() {
            let meaning = operand.parameter.meaning;
            let [number, count] = [index + 1, self.seen.operands.len()].map(|end| {
                let operands = self.seen.operands[..end].iter();
                operands.filter(|o| o.parameter.meaning == meaning).count()
            });
            let label = if count > 1 {
                format!("{meaning} ({number})")
            } else {
                meaning.to_owned()
            };
            match operand.parameter.kind {
                // A quadric's triples are factors and bounds.
                Takes::Vector if matches!(self.element.shape, Shape::Quadric(_)) => {}
                Takes::Vector => handles.push(self.point(operand, label)),
                Takes::Direction => handles.extend(self.direction(operand, label)),
                Takes::Number { .. } if operand.parameter.role == Role::NodeRadius => {
                    let node = self.seen.operands[..index].last();
                    handles.extend(node.and_then(|node| self.node_radius(node, operand, label)));
                }
                Takes::Number { .. } => handles.extend(self.number(operand, label)),
                _ => {}
            }
        }
        if self.material_decides() {
            let label = format!("the radius of the material `{}`", self.seen.material);
            let length = self.radius(0.0);
            handles.push(handle(
                Kind::Length,
                label,
                vec![self.seen.radius.clone()],
                length,
            ));
        }
        handles.retain(|handle| handle.place.is_finite());
        handles
    }

    /// Makes the knob of the radius of a shape that a loop or a defined command makes, if the
    /// number is written out or is a variable from outside: then all that is made so follows it.
    pub fn radius_of_all(&self) -> Option<Handle> {
        let mut handle = self.handles().into_iter().find(|handle| {
            let is_radius = handle.label.contains("radius") && !handle.label.contains("sweep");
            handle.kind == Kind::Length && is_radius
        })?;
        let radius = handle.numbers.first()?.value * self.placement.growth;
        let shown = self.scene.radius(self.element);
        let same = (radius - shown).abs() <= 1e-9 * shown.abs();
        if !same || matches!(handle.edit, Editable::Fixed { .. }) {
            return None;
        }
        handle.label += "; of all that are made here";
        Some(handle)
    }

    fn point(&self, operand: &Operand, label: String) -> Handle {
        let moves = Moves::Freely(self.placement.to_world);
        handle(Kind::Point, label, operand.numbers.clone(), moves)
    }

    /// Makes the knob of the radius at a skeleton's node, across the view.
    fn node_radius(&self, node: &Operand, operand: &Operand, label: String) -> Option<Handle> {
        let [x, y, z] = node.numbers.get(..3)? else {
            return None;
        };
        let place = DVec3::new(x.value, y.value, z.value);
        let moves = Moves::Along {
            anchor: self.placement.to_world.transform_point3(place),
            along: self.view.x_axis,
            growth: self.placement.growth,
        };
        Some(handle(Kind::Length, label, operand.numbers.clone(), moves))
    }

    fn direction(&self, operand: &Operand, label: String) -> Option<Handle> {
        let linear = self.placement.to_world.matrix3;
        let (anchor, linear, size) = match *self.element.shape.skeleton()? {
            Skeleton::Arc { center, radius, .. } => (center, linear, 0.75 * radius),
            // A normal stays perpendicular to what the map makes of its plane.
            Skeleton::Plane { point, .. } => {
                (point, linear.inverse().transpose(), self.placement.growth)
            }
            _ => return None,
        };
        let moves = Moves::Around {
            anchor,
            linear,
            size,
        };
        Some(handle(
            Kind::Direction,
            label,
            operand.numbers.clone(),
            moves,
        ))
    }

    /// Makes the handle of a radius or an angle of the shape, if it can be seen.
    fn number(&self, operand: &Operand, label: String) -> Option<Handle> {
        let circle = |start: bool| match *self.element.shape.skeleton()? {
            Skeleton::Arc {
                center,
                u,
                v,
                radius: sweep,
                angle,
            } => {
                let width = self
                    .seen
                    .operands
                    .iter()
                    .find(|o| o.parameter.role == Role::Width);
                let width = width.map_or(1.0, |width| width.numbers[0].value);
                // Turning a full circle changes nothing.
                let moves = Moves::Circle {
                    center,
                    u,
                    v,
                    sweep,
                    angle,
                    turns: if width < 0.0 { -1.0 } else { 1.0 },
                    start,
                };
                (!start || angle < std::f64::consts::TAU - 1e-3).then_some(moves)
            }
            _ => None,
        };
        let role = operand.parameter.role;
        let (kind, moves) = match role {
            Role::Start => (Kind::Angle, circle(true)?),
            Role::Width => (Kind::Angle, circle(false)?),
            Role::Sweep => (Kind::Length, self.sweep()?),
            Role::Side(axis) => (Kind::Length, self.side(axis)?),
            Role::Radius | Role::ApexRadius => {
                if self.material_decides() {
                    return None;
                }
                let end = if role == Role::ApexRadius { 1.0 } else { 0.0 };
                (Kind::Length, self.radius(end))
            }
            Role::None | Role::NodeRadius => return None,
        };
        Some(handle(kind, label, operand.numbers.clone(), moves))
    }

    /// Returns the element's flesh, if it is soft.
    fn flesh(&self) -> Option<&Flesh> {
        self.scene.flesh.get(self.element.flesh? as usize)
    }

    /// Returns whether the radius that counts is the material's.
    fn material_decides(&self) -> bool {
        let Some(flesh) = self.flesh() else {
            return false;
        };
        if self.element.shape.skeleton().is_none()
            || self.seen.radius.value == 0.0 && flesh.depth == 0.0
        {
            return false;
        }
        // A shape without a radius of its own (`dot`, `line`) has its material's.
        self.element.shape.radius() == 0.0 || self.scene.radius_of_flesh(self.element).is_some()
    }

    /// Places the knob of the shape's radius on the rim, across the view. `end` is the end of a
    /// cone or limb that tapers, 0 or 1.
    fn radius(&self, end: f64) -> Moves {
        let view = self.view;
        let (right, towards) = (view.x_axis, view.z_axis);
        let tapers = self.flesh().is_some_and(|flesh| flesh.end_radius.is_some())
            || self
                .element
                .shape
                .bone()
                .is_some_and(|bone| bone.end_radius.is_some());
        let share = if tapers { end } else { 0.5 };
        let across = |axis: DVec3| {
            let across = axis.cross(towards).try_normalize().unwrap_or(right);
            if across.dot(right + view.y_axis * 0.5) < 0.0 {
                -across
            } else {
                across
            }
        };
        let shape = &self.element.shape;
        let (anchor, along) = match shape.skeleton() {
            Some(line) if line.dimension() == 1 => {
                let axis = line.tangent(share).unwrap_or(right);
                (line.at(share), across(axis))
            }
            Some(face) if face.dimension() == 2 => {
                (face.middle(), face.normal().unwrap_or(towards))
            }
            _ => (shape.middle(), right),
        };
        Moves::Along {
            anchor,
            along,
            growth: self.placement.growth,
        }
    }

    /// Places the knob of a box's side along an axis in the middle of a face.
    fn side(&self, k: usize) -> Option<Moves> {
        let Shape::Box(Cuboid { center, axes }) = self.element.shape else {
            return None;
        };
        Some(Moves::Along {
            anchor: center,
            along: axes.get(k)?.try_normalize()?,
            // The side is as long as both halves.
            growth: 0.5 * self.placement.to_world.matrix3.col(k).length(),
        })
    }

    /// Places the knob of an arc's sweep radius in the middle of the arc.
    fn sweep(&self) -> Option<Moves> {
        let arc = self.element.shape.skeleton()?;
        let Skeleton::Arc { center, .. } = *arc else {
            return None;
        };
        Some(Moves::Along {
            anchor: center,
            along: (arc.at(0.5) - center).try_normalize()?,
            growth: self.placement.growth,
        })
    }
}
