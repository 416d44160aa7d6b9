//! The scene that the commands so far have made, checked: what cannot be drawn is left out with a
//! warning.

use super::model::Part;
use super::state::Evaluator;
use super::{exact, pattern};
use crate::Severity;
use crate::compiled::Placement;
use crate::limits::MAX_MAGNITUDE;
use field::local::LocalError;
use field::{Kernel, Primitive, Skeleton};
use glam::{DAffine3, DMat3, DVec3};
use scene::{Body, Element, Finish, Form, Frame, Function, Quadric, Scene, Settings, Shape};
use std::borrow::Cow;
use std::collections::HashMap;
use std::iter;
use std::sync::Arc;

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
                if let Some(depth) = part.depth {
                    set_depth(&scene, &mut part.element, depth * part.growth);
                }
                stretch(&scene, &mut part);
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
        self.thicken_meshes(&mut scene, &mut placements);
        self.settle_exact(&mut scene, &mut placements);
        self.settle_patterns(&mut scene, &mut placements);
        if scene.camera.eye == scene.camera.target {
            let (place, span) = self.aimed_at.clone();
            let message = "the eye is at the view reference point, so it looks nowhere";
            let hint = "set `eyep` and `vrp` to different points";
            self.say_at(place, Severity::Warning, &span, message, hint);
        }
        (scene, placements)
    }
}

impl Evaluator<'_> {
    /// Whether a shape is soft and of a material that is `exact`, or a `triad` whose strength is
    /// not given.
    fn is_exact(&self, scene: &Scene, element: &Element) -> bool {
        let surface = self.palette.surfaces.get(element.finish as usize);
        let is_exact = surface.is_some_and(|surface| {
            surface.exact || !surface.has_strength && is_triad(scene, element)
        });
        is_exact && scene.is_soft(element)
    }

    /// Returns the solid or image that says the strength of a soft shape, if any.
    pub(super) fn pattern_of(&self, element: &Element) -> Option<&texture::Texture> {
        let surface = self.palette.surfaces.get(element.finish as usize)?;
        surface.pattern.as_ref().filter(|_| element.flesh.is_some())
    }

    /// Makes the flesh of materials that are `exact` stand at its radius.
    fn settle_exact(&mut self, scene: &mut Scene, placements: &mut Vec<Placement>) {
        let elements = scene.elements.iter().enumerate();
        let elements = elements.filter(|(_, element)| self.is_exact(scene, element));
        let (fit, others): (Vec<_>, Vec<_>) =
            elements.partition(|(_, element)| exact::is_fit(scene, element));
        let other = others.iter().find(|(_, element)| {
            let stays = match &element.shape {
                Shape::Bone(bone) => {
                    matches!(
                        bone.skeleton,
                        Skeleton::Point { .. } | Skeleton::Plane { .. }
                    )
                }
                Shape::Function(function) => function.curves().is_none(),
                _ => true,
            };
            !stays && !is_triad(scene, element)
        });
        let other = other.map(|(_, element)| element.origin);
        let fit: Vec<usize> = fit.into_iter().map(|(index, _)| index).collect();
        if let Some(origin) = other {
            let message = "`exact` is for segments, arcs and triangles of one radius: this shape \
                           stays as it is";
            self.say_of(origin, Severity::Note, message, "");
        }
        let mut groups = exact::join(scene, &fit);
        // Those that are dear must not keep cheap ones from being settled.
        groups.sort_by_key(exact::Joined::len);
        let mut is_told = false;
        for joined in groups {
            match joined.settle(scene, &mut self.exact_left, &mut self.exact_known) {
                Some(added) => {
                    for (index, element) in added {
                        let placement = placements[index];
                        scene.elements.push(element);
                        placements.push(placement);
                    }
                }
                None if is_told => {}
                None => {
                    is_told = true;
                    let origin = scene.elements[joined.elements[0]].origin;
                    let message = "this cannot be made `exact`, or takes too long: it stays as it \
                                   is, and perhaps others do";
                    self.warn_of(origin, message, "make fewer shapes of this material");
                }
            }
        }
    }
}

impl Evaluator<'_> {
    /// Cuts bones whose strength a solid or an image says into pieces of their own strengths.
    fn settle_patterns(&mut self, scene: &mut Scene, placements: &mut Vec<Placement>) {
        if !scene
            .elements
            .iter()
            .any(|element| self.pattern_of(element).is_some())
        {
            return;
        }
        let images = scene.images.clone();
        let images: Vec<&dyn texture::Image> = images
            .iter()
            .map(|image| &**image as &dyn texture::Image)
            .collect();
        let elements = std::mem::take(&mut scene.elements);
        let places = std::mem::take(placements);
        let mut strengths = HashMap::new();
        let mut left = pattern::MOST_OF_ALL;
        let mut whole = None;
        for (element, placement) in elements.into_iter().zip(places) {
            let frame = scene.frame(&element);
            let pattern = self.pattern_of(&element);
            let pattern = pattern.filter(|_| pattern::count(&element).is_some_and(|n| n <= left));
            let pieces =
                pattern.and_then(|pattern| pattern::cut(&element, frame, pattern, &images));
            let (Some(pieces), Some(own)) = (pieces, element.flesh) else {
                if self.pattern_of(&element).is_some() {
                    whole = whole.or(Some(element.origin));
                }
                scene.elements.push(element);
                placements.push(placement);
                continue;
            };
            left -= pieces.len();
            for pattern::Piece {
                mut element,
                factor,
            } in pieces
            {
                let flesh = &mut scene.flesh;
                let index = strengths.entry((own, factor.to_bits())).or_insert_with(|| {
                    let mut piece = flesh[own as usize].clone();
                    piece.strength *= factor;
                    flesh.push(piece);
                    flesh.len() as u32 - 1
                });
                element.flesh = Some(*index);
                scene.elements.push(element);
                placements.push(placement);
            }
        }
        if let Some(origin) = whole {
            let message = "a solid or an image says no strength here: this shape stays as it is";
            let hint = "it is for points, segments, arcs and triangles of one radius with round \
                        ends, 20,000 pieces in all";
            self.say_of(origin, Severity::Note, message, hint);
        }
    }
}

/// Returns whether an element is a triangle of the command `triad`.
fn is_triad(scene: &Scene, element: &Element) -> bool {
    let flesh = element
        .flesh
        .and_then(|index| scene.flesh.get(index as usize));
    element.kernel == Kernel::Inverse
        && flesh.is_some_and(|flesh| flesh.kernel.is_none())
        && matches!(element.shape.skeleton(), Some(Skeleton::Triangle { .. }))
}

/// Gives a soft shape the radius that has a depth of influence, a length of the world.
fn set_depth(scene: &Scene, element: &mut Element, depth: f64) {
    let Some(flesh) = scene.flesh_in_world(element) else {
        return;
    };
    let shaping = scene.shaping(element, &flesh, 1.0);
    if let Shape::Bone(bone) = &mut element.shape {
        let radius = shaping.radius_of_depth(depth, bone.skeleton.dimension());
        bone.radius = radius.unwrap_or(0.0);
    }
}

/// Most that a map may stretch one direction more than another for balls to stay balls.
const EVEN: f64 = 1e-9;

/// Makes an ellipsoid of a ball that was stretched unevenly: hard, a quadric; soft, a ball whose
/// field falls exponentially, as steeply at its surface as its kernel would.
fn stretch(scene: &Scene, part: &mut Part) {
    let element = &part.element;
    let (Some(Skeleton::Point { center }), Some(moved)) =
        (element.shape.skeleton(), part.moved.as_deref())
    else {
        return;
    };
    let columns = moved.matrix3.to_cols_array_2d().map(DVec3::from_array);
    let lengths = columns.map(DVec3::length);
    let longest = lengths.into_iter().fold(0.0, f64::max);
    let is_even = (0..3).all(|i| {
        let lean = columns[i].dot(columns[(i + 1) % 3]).abs();
        longest - lengths[i] <= EVEN * longest && lean <= EVEN * longest * longest
    });
    let radius = scene.radius(element) / part.growth;
    if is_even || !(radius.is_finite() && radius > 0.0) {
        return;
    }
    let to_world = DAffine3::from_mat3_translation(moved.matrix3, *center);
    let Some(flesh) = scene.flesh_in_world(element) else {
        if element.flesh.is_none() {
            let [x, y, z] = columns;
            let ball = Quadric::new(DMat3::IDENTITY, DVec3::ZERO, -1.0, -DVec3::ONE, DVec3::ONE);
            if let Some(mut quadric) = ball {
                quadric.center = *center;
                quadric.axes = [x * radius, y * radius, z * radius];
                part.element.shape = Shape::Quadric(Box::new(quadric));
            }
        }
        return;
    };
    // Its field at its surface, as if it had not been stretched.
    let whole = radius * part.growth;
    let shaping = field::Shaping {
        strength: 1.0,
        ..scene.shaping(element, &flesh, whole)
    };
    let point = Skeleton::Point {
        center: DVec3::ZERO,
    };
    let Some(primitive) = Primitive::new(point, &shaping, None) else {
        return;
    };
    let jet = primitive.jet([whole, 0.0, 0.0]);
    let hardness = (-jet.gradient[0] / jet.value * part.growth).min(HARDEST / radius);
    let grown = radius + libm::log(flesh.strength) / hardness;
    if flesh.strength > 0.0 && hardness.is_finite() && hardness > 0.0 && grown > 0.0 {
        let form = Form::Metaballs {
            hardness,
            balls: Arc::new(vec![(DVec3::ZERO, grown)]),
        };
        part.element.shape = Shape::Function(Box::new(Function { form, to_world }));
    }
}

/// Largest hardness of a stretched ball, in inverse radii: [`field::Exponentials`] has a limit.
const HARDEST: f64 = 40.0;

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
