//! The scene that the commands so far have made, checked: what cannot be drawn is left out with a
//! warning.

use super::model::Part;
use super::state::Evaluator;
use crate::Severity;
use crate::compiled::Placement;
use crate::limits::MAX_MAGNITUDE;
use field::local::LocalError;
use glam::DVec3;
use scene::{Body, Element, Finish, Frame, Scene, Settings, Shape};
use std::collections::HashMap;

/// What `sample` is by itself where colours are means over a lens, the shutter, a light or the sky.
const MEAN_SAMPLES: u32 = 4;

impl Evaluator<'_> {
    /// The settings, with as many samples as a picture of this kind needs if the text does not say
    /// how many.
    fn sampled_settings(&self) -> Settings {
        let sized = || self.lights.iter().any(|light| light.size > 0.0);
        let has_means = self.lens.aperture > 0.0
            || self.animated && self.shutter > 0.0
            || self.settings.penumbra && sized()
            || self.air.sky.is_some();
        let mut settings = self.settings;
        if has_means && !self.sampled {
            settings.samples = MEAN_SAMPLES;
        }
        settings
    }

    /// The scene of these shapes as all else is now, and how its elements came there.
    pub(super) fn picture(&mut self, parts: Vec<Part>) -> (Scene, Vec<Placement>) {
        let surfaces = self.palette.surfaces.iter();
        let dark = self.air.sky.is_some();
        let finishes = surfaces.clone().map(|surface| Finish {
            ambient: match surface.colours.ambient {
                None if dark => [0.0; 3],
                _ => surface.finish.ambient,
            },
            ..surface.finish.clone()
        });
        let finishes = finishes.collect();
        let flesh = surfaces.map(|surface| surface.flesh.clone()).collect();
        let camera = self.settled_camera();
        let mut scene = Scene {
            elements: Vec::with_capacity(parts.len()),
            bodies: [Body::default()]
                .into_iter()
                .chain(self.model.bodies.iter().cloned())
                .collect(),
            contacts: self.model.contacts.clone(),
            flesh,
            finishes,
            frames: vec![Frame::WORLD],
            lights: self.lights.clone(),
            background: self.air.background(),
            sky: self.air.sky.map(|(sky, _)| sky),
            ground: self.air.ground,
            fog: self.air.fog(camera.eye.distance(camera.target)),
            clouds: self.air.clouds.clone(),
            up: camera.up.try_normalize().unwrap_or(DVec3::Y),
            images: self.images.all.clone(),
            camera,
            lens: self.lens,
            moments: Vec::new(),
            settings: self.sampled_settings(),
        };
        let mut placements = Vec::with_capacity(parts.len());
        if scene.finishes.is_empty() {
            scene.finishes.push(Finish::default());
        }
        scene.elements.reserve_exact(parts.len());
        let mut frames = HashMap::new();
        let mut warned = false;
        for mut part in parts.into_iter().filter(|part| !part.removed) {
            let fault = if is_in_bounds(&part) {
                part.element.frame = frame_of(&part, &mut scene.frames, &mut frames);
                fault(&scene, &part.element)
            } else {
                Some((too_far as fn() -> String, None))
            };
            let element = part.element;
            let origin = element.origin;
            let span = origin.start as usize..origin.end as usize;
            match fault {
                None => {
                    if !warned && ignores_profile(&scene, &element) {
                        warned = true;
                        self.say_at(origin.file as usize, Severity::Warning, span, || {
                            (
                                String::from(
                                    "a texture of the strength does nothing on polygons and curves \
                                     in this version",
                                ),
                                None,
                            )
                        });
                    }
                    scene.elements.push(element);
                    placements.push(Placement {
                        to_world: part.moved.as_deref().copied().unwrap_or_default(),
                        growth: part.growth,
                        repeated: part.repeated,
                    });
                }
                Some((message, hint)) => {
                    self.say_at(origin.file as usize, Severity::Warning, span, || {
                        (message(), hint)
                    });
                }
            }
        }
        if scene.camera.eye == scene.camera.target {
            let (place, span) = self.aimed_at.clone();
            self.say_at(place, Severity::Warning, span, || {
                (
                    String::from("the eye is at the view reference point, so it looks nowhere"),
                    Some(String::from("set `eyep` and `vrp` to different points")),
                )
            });
        }
        (scene, placements)
    }
}

/// The index of a part's frame: shapes that were moved alike share one.
fn frame_of(
    part: &Part,
    frames: &mut Vec<Frame>,
    known: &mut HashMap<([u64; 12], u64), u32>,
) -> u32 {
    let Some(moved) = &part.moved else {
        return 0;
    };
    let bits = moved.to_cols_array().map(f64::to_bits);
    *known
        .entry((bits, part.growth.to_bits()))
        .or_insert_with(|| {
            frames.push(Frame {
                to_world: **moved,
                growth: part.growth,
            });
            frames.len() as u32 - 1
        })
}

/// Whether an element's flesh has a profile that its shape has no parameters for.
fn ignores_profile(scene: &Scene, element: &Element) -> bool {
    let has_no_parameters = matches!(element.shape, Shape::Polygon { .. } | Shape::Curve { .. })
        || element.shape.curves().is_some();
    has_no_parameters
        && scene.is_soft(element)
        && element
            .flesh
            .is_some_and(|flesh| scene.flesh[flesh as usize].profile.is_some())
}

type Fault = (fn() -> String, Option<String>);

/// Why an element cannot be drawn, if so.
fn fault(scene: &Scene, element: &Element) -> Option<Fault> {
    let hint = |text: &str| Some(text.to_owned());
    let radius = scene.radius(element);
    let is_soft = element.flesh.is_some() && element.shape.has_skeleton();
    let needs_radius = is_soft
        || matches!(
            element.shape,
            Shape::Sphere { .. }
                | Shape::Cylinder { .. }
                | Shape::Cone { .. }
                | Shape::Pipe { .. }
                | Shape::Arc { .. }
                | Shape::Curve { .. }
        );
    if needs_radius && radius <= 0.0 {
        return Some(if is_soft {
            (
                || String::from("this soft shape has no radius, so it is left out"),
                hint("give its material a `radius` above 0"),
            )
        } else {
            (
                || String::from("this shape's radius is not above 0, so it is left out"),
                hint("give it a radius above 0"),
            )
        });
    }
    let degenerate = match element.shape {
        Shape::Sphere { .. } | Shape::Plane { .. } => false,
        Shape::Cylinder { base, apex, .. }
        | Shape::Pipe { base, apex, .. }
        | Shape::Cone { base, apex, .. } => base == apex,
        Shape::Arc { sweep, angle, .. } => sweep <= 0.0 || angle <= 0.0,
        Shape::Triangle {
            corners: [a, b, c], ..
        }
        | Shape::Patch {
            corners: [a, b, c], ..
        } => {
            let (ab, ac) = (b - a, c - a);
            ab.cross(ac).length() <= 1e-12 * ab.length() * ac.length()
        }
        Shape::Polygon { ref rings, .. } => !has_area(rings),
        Shape::Curve {
            control: [a, b, c, d],
            ..
        } => a == b && b == c && c == d,
        Shape::Box { axes, .. } => scene::quadric::inverse(axes).is_none(),
        Shape::Quadric(ref quadric) => !quadric.is_surface(),
        Shape::Function(ref function) => {
            function.curves().is_none() && function.implicit().is_none()
        }
    };
    if (is_soft || element.shape.curves().is_some()) && scene.is_too_long(element) {
        return Some((
            || {
                String::from(
                    "this curve or tapering limb is more than 10,000 kernel widths long, so it is \
                     left out",
                )
            },
            hint("give it a larger radius, or cut it into pieces"),
        ));
    }
    if let Shape::Function(function) = &element.shape {
        match scene.local(element, function) {
            Some(Err(LocalError::Reach)) => {
                return Some((
                    || {
                        String::from(
                            "too many pieces of this skeleton are within its `local` length, so it is left out",
                        )
                    },
                    hint("make `local` shorter, or `subdivide` less"),
                ));
            }
            Some(Err(LocalError::Unusable)) => {
                return Some((
                    || String::from("a skeleton with `local` adds flesh, so this one is left out"),
                    hint("give its material a `strength` above 0, or take `local` out"),
                ));
            }
            Some(Ok(_)) | None => {}
        }
    }
    degenerate.then(|| {
        let message: fn() -> String = match element.shape {
            Shape::Cylinder { .. } => {
                || String::from("this cylinder's ends are the same point, so it is left out")
            }
            Shape::Pipe { .. } => {
                || String::from("this pipe's ends are the same point, so it is left out")
            }
            Shape::Cone { .. } => {
                || String::from("this cone's ends are the same point, so it is left out")
            }
            Shape::Box { .. } => || String::from("this box has no volume, so it is left out"),
            Shape::Quadric(_) => || {
                String::from(
                    "this quadric is no surface, or its box has no volume, so it is left out",
                )
            },
            Shape::Function(_) => || {
                String::from("this function's numbers cannot be computed with, so it is left out")
            },
            Shape::Arc { .. } => || {
                String::from("this arc has no length (sweep radius or width 0), so it is left out")
            },
            Shape::Curve { .. } => {
                || String::from("this curve's points are all the same, so it is left out")
            }
            Shape::Polygon { .. } => || String::from("this polygon has no area, so it is left out"),
            _ => || String::from("this triangle has no area, so it is left out"),
        };
        (message, None)
    })
}

/// Whether a polygon's outer ring has an area that is more than rounding.
fn has_area(rings: &[Vec<DVec3>]) -> bool {
    let Some(outer) = rings.first().filter(|ring| ring.len() >= 3) else {
        return false;
    };
    let area: DVec3 = outer
        .windows(2)
        .map(|w| (w[0] - outer[0]).cross(w[1] - outer[0]))
        .sum();
    let reach = outer.iter().map(|p| p.distance(outer[0]));
    let longest = reach.fold(0.0, f64::max);
    area.length() > 1e-12 * longest * longest
}

fn too_far() -> String {
    String::from("this shape is too far away, too large or too small, so it is left out")
}

/// Whether a shape is still within what a text may write; transforms can take it beyond.
fn is_in_bounds(part: &Part) -> bool {
    let shape = &part.element.shape;
    let fits = |v: glam::DVec3| v.abs().max_element() <= MAX_MAGNITUDE && v.is_finite();
    let places = match *shape {
        Shape::Sphere { center, .. } => fits(center),
        Shape::Cylinder { base, apex, .. }
        | Shape::Pipe { base, apex, .. }
        | Shape::Cone { base, apex, .. } => fits(base) && fits(apex),
        Shape::Arc { center, sweep, .. } => fits(center) && sweep.abs() <= MAX_MAGNITUDE,
        Shape::Triangle { corners, .. } | Shape::Patch { corners, .. } => {
            corners.into_iter().all(fits)
        }
        Shape::Box { center, axes } => fits(center) && axes.into_iter().all(fits),
        Shape::Quadric(ref quadric) => fits(quadric.center) && quadric.axes.into_iter().all(fits),
        Shape::Polygon { ref rings, .. } => rings.iter().flatten().copied().all(fits),
        Shape::Curve { control, .. } => control.into_iter().all(fits),
        Shape::Plane { point, normal, .. } => fits(point) && normal.is_finite(),
        Shape::Function(ref function) => <[glam::DVec3; 2]>::from(function.corners())
            .into_iter()
            .all(fits),
    };
    places && shape.radius().abs() <= MAX_MAGNITUDE && (1e-9..=1e9).contains(&part.growth)
}
