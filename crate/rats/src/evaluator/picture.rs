//! The scene that the commands so far have made, checked: what cannot be drawn is left out with a
//! warning.

use super::model::Part;
use super::state::Evaluator;
use crate::Severity;
use crate::compiled::Placement;
use crate::limits::MAX_MAGNITUDE;
use field::Skeleton;
use field::local::LocalError;
use glam::DVec3;
use scene::{Body, Element, Finish, Frame, Scene, Settings, Shape};
use std::borrow::Cow;
use std::collections::HashMap;
use std::iter;

/// Value of `sample`, if the text gives none, where colours are means over a lens, the shutter, a
/// light or the sky.
const MEAN_SAMPLES: u32 = 4;

const TOO_FAR: &str = "this shape is too far away, too large or too small, so it is left out";
const NO_PROFILE: &str =
    "a texture of the strength does nothing on polygons and curves in this version";

impl Evaluator<'_> {
    /// Returns the settings, with as many samples as a picture of this kind needs if the text does
    /// not say how many.
    fn settings_of_picture(&self) -> Settings {
        let has_means = self.lens.aperture > 0.0
            || self.animated && self.shutter > 0.0
            || self.settings.penumbra && self.lights.iter().any(|light| light.size > 0.0)
            || self.air.sky.is_some();
        let mut settings = self.settings;
        if has_means && !self.sampled {
            settings.samples = MEAN_SAMPLES;
        }
        settings
    }

    /// Makes the scene of these shapes with all else as it is now; returns it, and how its elements
    /// came there.
    pub(super) fn picture(&mut self, parts: Vec<Part>) -> (Scene, Vec<Placement>) {
        let surfaces = self.palette.surfaces.iter();
        let flesh = surfaces
            .clone()
            .map(|surface| surface.flesh.clone())
            .collect();
        let dark = self.air.sky.is_some();
        let finishes = surfaces.map(|surface| Finish {
            ambient: match surface.colours.ambient {
                None if dark => [0.0; 3],
                _ => surface.finish.ambient,
            },
            ..surface.finish.clone()
        });
        let finishes = finishes.collect();
        let camera = self.camera_of_picture();
        let mut scene = Scene {
            elements: Vec::with_capacity(parts.len()),
            bodies: iter::once(Body::default())
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
            settings: self.settings_of_picture(),
        };
        if scene.finishes.is_empty() {
            scene.finishes.push(Finish::default());
        }
        let mut placements = Vec::with_capacity(parts.len());
        let mut frames = HashMap::new();
        let mut warned = false;
        for mut part in parts.into_iter().filter(|part| !part.removed) {
            let fault = if is_in_bounds(&part) {
                part.element.frame = frame_of(&part, &mut scene.frames, &mut frames);
                fault(&scene, &part.element)
            } else {
                Some((TOO_FAR.into(), ""))
            };
            let element = part.element;
            if let Some((message, hint)) = fault {
                self.warn_of(element.origin, message, hint);
                continue;
            }
            if !warned && ignores_profile(&scene, &element) {
                warned = true;
                self.warn_of(element.origin, NO_PROFILE, "");
            }
            scene.elements.push(element);
            placements.push(Placement {
                to_world: part.moved.as_deref().copied().unwrap_or_default(),
                growth: part.growth,
                repeated: part.repeated,
            });
        }
        if scene.camera.eye == scene.camera.target {
            let (place, span) = self.aimed_at.clone();
            let message = "the eye is at the view reference point, so it looks nowhere";
            let hint = "set `eyep` and `vrp` to different points";
            self.say_at(place, Severity::Warning, &span, message, hint);
        }
        (scene, placements)
    }
}

/// Returns the index of a part's frame; shapes that were moved alike share one.
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
    let has_no_parameters = match element.shape.skeleton() {
        Some(bone) => bone.is_numeric() || matches!(bone, Skeleton::Polygon { .. }),
        None => element.shape.curves().is_some(),
    };
    has_no_parameters
        && scene.is_soft(element)
        && element
            .flesh
            .is_some_and(|flesh| scene.flesh[flesh as usize].profile.is_some())
}

/// Message that an element cannot be drawn, and a hint, which may be empty.
type Fault = (Cow<'static, str>, &'static str);

/// Returns why an element cannot be drawn; `None` if it can be.
fn fault(scene: &Scene, element: &Element) -> Option<Fault> {
    let radius = scene.radius(element);
    let skeleton = element.shape.skeleton();
    let is_soft = element.flesh.is_some() && skeleton.is_some();
    let needs_radius = is_soft || skeleton.is_some_and(|bone| bone.dimension() < 2);
    if needs_radius && radius <= 0.0 {
        return Some(match is_soft {
            true => (
                "this soft shape has no radius, so it is left out".into(),
                "give its material a `radius` above 0",
            ),
            false => (
                "this shape's radius is not above 0, so it is left out".into(),
                "give it a radius above 0",
            ),
        });
    }
    if (is_soft || element.shape.curves().is_some()) && scene.is_too_long(element) {
        return Some((
            "this curve or tapering limb is more than 10,000 kernel widths long, so it is left out"
                .into(),
            "give it a larger radius, or cut it into pieces",
        ));
    }
    if let Shape::Function(function) = &element.shape {
        match scene.local(element, function) {
            Some(Err(LocalError::Reach)) => {
                return Some((
                    "too many pieces of this skeleton are within its `local` \
                     length, so it is left out"
                        .into(),
                    "make `local` shorter, or `subdivide` less",
                ));
            }
            Some(Err(LocalError::Unusable)) => {
                return Some((
                    "a skeleton with `local` adds flesh, so this one is left out".into(),
                    "give its material a `strength` above 0, or take `local` out",
                ));
            }
            Some(Ok(_)) | None => {}
        }
    }
    Some((element.shape.fault()?.into(), ""))
}

/// Whether a shape is still within what a text may write; transforms can take it beyond.
fn is_in_bounds(part: &Part) -> bool {
    part.element.shape.is_within(MAX_MAGNITUDE) && (1e-9..=1e9).contains(&part.growth)
}
