//! Warnings of scenes that are probably not meant: shapes outside the picture, an eye inside the
//! surface, flesh too weak to be seen.
//!
//! Lints are about the finished scene, so they are looked for only when the text has no errors.
//! Those that evaluate the field are left out in large scenes: an edit must not wait for them.

use super::state::Evaluator;
use super::{exact, later};
use crate::compiled::Placement;
use crate::problem::Problem;
use crate::{Severity, TextEdit};
use field::{Primitive, THRESHOLD};
use glam::DVec3;
use scene::{Element, Scene, SoftSurface, Surface};
use std::collections::BTreeSet;

/// Weight of the scene up to which the field is evaluated (see [`crate::limits::CURVE_WEIGHT`]):
/// limbs that taper take a millisecond each to prepare.
const MOST_WEIGHT: usize = 1000;
/// Contacts up to which bulges are looked at.
const MOST_CONTACTS: usize = 50;
/// Evaluations of one element's field that the lints may cost.
const MOST_EVALUATIONS: usize = 40_000;
/// Field of other bones below which a bone is by itself.
const NEARLY_ALONE: f64 = 0.02;
/// Largest share by which flesh may miss its radius without a note.
const MOST_OFF: f64 = 0.1;

impl Evaluator<'_> {
    /// Looks at the finished scene.
    pub(super) fn lint(&mut self, scene: &Scene, placements: &[Placement]) {
        if self.report.has_errors() || self.report.no_warnings {
            return;
        }
        self.lint_view(scene);
        self.lint_blob_scale(scene);
        if self.model.weight() <= MOST_WEIGHT && scene.settings.soft {
            self.lint_field(scene, placements);
            self.lint_contacts(scene);
        }
    }

    /// Warns of bulges that wrap the body that raises them.
    fn lint_contacts(&mut self, scene: &Scene) {
        if scene.contacts.len() > MOST_CONTACTS || scene.contacts.is_empty() {
            return;
        }
        let surfaces = scene.surfaces_apart();
        let contacts = scene.contacts.iter().zip(self.model.contact_places.clone());
        for (contact, (file, span)) in contacts {
            let [a, b] = contact.bodies;
            if a == b {
                continue;
            }
            let [Some(own), Some(other)] =
                [a, b].map(|body| surfaces.iter().find(|surface| surface.body() == body))
            else {
                let message = "one of these bodies has no soft shapes";
                let hint = "only soft shapes touch: give a material a `blobbiness`";
                self.say_at(file, Severity::Warning, &span, message, hint);
                continue;
            };
            let coated = [(own, other, b), (other, own, a)]
                .into_iter()
                .find(|(own, other, _)| {
                    contact::coats(own.function(), other.function(), &contact.bulge)
                });
            if let Some((_, _, body)) = coated {
                let name = scene.bodies[body as usize].name.clone();
                let message = format_args!("the bulge of this contact coats `{name}`");
                let hint = "let it begin nearer, with a larger c, or make it lower";
                self.say_at(file, Severity::Warning, &span, message, hint);
            }
        }
    }

    /// Warns of radii and blobbiness that go together as |B|·R² ≈ const where the text does not say
    /// how blobbiness is read, or of blobbiness that makes sense only if it is absolute: so are
    /// those of the published datasets, which read as relative make what is thin the crispest.
    fn lint_blob_scale(&mut self, scene: &Scene) {
        let soft = scene.elements.iter().filter_map(|element| element.flesh);
        let used: BTreeSet<u32> = soft.collect();
        let flesh = used.iter().map(|&index| &scene.flesh[index as usize]);
        let pairs = flesh.filter_map(|flesh| Some([flesh.radius, flesh.blobbiness?]));
        let pairs: Vec<_> = pairs.filter(|[radius, _]| *radius > 0.0).collect();
        let message = match &pairs[..] {
            _ if self.scaled => return,
            pairs if goes_with_square(pairs) => {
                "radii and blobbiness of this text go together as |B|·R² ≈ const, as where \
                 blobbiness is absolute"
            }
            pairs if would_be_soft(pairs) => {
                "blobbiness of 64 and more is as crisp as a hard shape, and with these radii it \
                 would be soft if it were absolute"
            }
            _ => return,
        };
        let surfaces = &self.palette.surfaces;
        let soft = scene
            .elements
            .iter()
            .filter(|element| element.flesh.is_some());
        let first = soft.map(|element| element.finish).min();
        let Some(surface) = first.and_then(|index| surfaces.get(index as usize)) else {
            return;
        };
        let (file, name) = surface.origin.clone();
        let source = &self.sources.all[file];
        let command = later::find(&source.syntax.block, &|command| {
            command.span.contains(&name.start)
        });
        let start = command.map_or(name.start, |command| command.span.start);
        let line = source.text[..start].rfind('\n').map_or(0, |at| at + 1);
        let problem = Problem::new(&name, message)
            .hint("add `blobscale absolute`, or `blobscale relative` if it is meant so")
            .fix(TextEdit::new(file, line..line, "blobscale absolute\n"));
        self.file = file;
        if self.is_own() && self.is_news(Severity::Warning, &name) {
            self.tell(Severity::Warning, problem);
        }
    }

    /// Notes what lies outside the picture.
    fn lint_view(&mut self, scene: &Scene) {
        let [width, height] = scene.settings.frame;
        let projection = scene.camera.projection(width, height);
        let outside: Vec<&Element> = scene
            .elements
            .iter()
            .filter(|element| {
                ball(scene, element).is_some_and(|(c, r)| is_outside(&projection, c, r))
            })
            .collect();
        let Some(first) = outside.first() else { return };
        let count = outside.len();
        let origin = first.origin;
        if count == scene.elements.len() {
            let message = "nothing of the model is in the picture";
            let hint = "look at it with `eyep` and `vrp`, or press “See the whole model”";
            self.warn_of(origin, message, hint);
        } else {
            let more = match count - 1 {
                0 => String::new(),
                1 => String::from(", and so is one more"),
                n => format!(", and so are {n} more"),
            };
            let message = format_args!("this shape is outside the picture{more}");
            self.say_of(origin, Severity::Note, message, "");
        }
    }

    /// Warns of an eye inside the surface and of flesh that never reaches the threshold.
    fn lint_field(&mut self, scene: &Scene, placements: &[Placement]) {
        let surfaces = scene.surfaces();
        if surfaces
            .iter()
            .any(|s| s.function().jet(scene.camera.eye).value >= THRESHOLD)
        {
            let (file, span) = self.aimed_at.clone();
            self.say_at(
                file,
                Severity::Warning,
                &span,
                "the eye is inside the surface",
                "move `eyep` away from the model",
            );
        }
        let mut left = MOST_EVALUATIONS;
        self.lint_radii(scene, placements, &surfaces, &mut left);
        for surface in &surfaces {
            // Functions that are no sums make flesh visible, or hide it, in ways of their own.
            if let Surface::Sum(surface) = surface
                && !self.lint_body(scene, surface, &mut left)
            {
                return;
            }
        }
    }

    /// Notes bones by themselves whose flesh does not stand at its radius, once a material. What
    /// loops, the library and `instance` make has radii that nobody wrote down.
    fn lint_radii(
        &mut self,
        scene: &Scene,
        placements: &[Placement],
        surfaces: &[Surface],
        left: &mut usize,
    ) {
        let elements = scene.elements.iter().zip(placements).enumerate();
        let written = elements.filter(|(_, (_, placement))| !placement.repeated);
        let written = written.map(|(index, (element, _))| (index, element));
        let plain = written.filter(|(_, element)| {
            let flesh = element
                .flesh
                .and_then(|index| scene.flesh.get(index as usize));
            let is_exact = self.palette.surfaces.get(element.finish as usize);
            let is_exact = is_exact.is_none_or(|surface| surface.exact);
            !is_exact
                && flesh.is_some_and(|flesh| flesh.strength == 1.0)
                && exact::is_fit(scene, element)
        });
        let plain: Vec<usize> = plain.map(|(index, _)| index).collect();
        let mut told = BTreeSet::new();
        for joined in exact::join(scene, &plain) {
            let element = &scene.elements[joined.elements[0]];
            let body = surfaces
                .iter()
                .find(|surface| surface.body() == element.body);
            let Some(Surface::Sum(body)) = body.filter(|_| !told.contains(&element.finish)) else {
                continue;
            };
            let terms = &body.sum.primitives;
            let Some(rest) = left.checked_sub(terms.len() + 32 * joined.len()) else {
                return;
            };
            *left = rest;
            let (middle, across) = joined.middle;
            let place = middle + across * joined.radius;
            let others = value(terms, place) - joined.value(place);
            let Some(radius) = joined.measure().filter(|_| others.abs() < NEARLY_ALONE) else {
                continue;
            };
            if (radius / joined.radius - 1.0).abs() > MOST_OFF {
                told.insert(element.finish);
                let [is, wanted] = [radius, joined.radius].map(round_off);
                let (why, hint) = match radius < joined.radius {
                    true => (
                        "it is short for its blobbiness",
                        "add `exact` to its material, or join it to others",
                    ),
                    false => (
                        "more of its limb is near",
                        "add `exact` to its material, or make it crisper",
                    ),
                };
                let message = format_args!(
                    "the surface stands {is} from the middle of this bone, not {wanted}: {why}"
                );
                self.say_of(element.origin, Severity::Note, message, hint);
            }
        }
    }

    /// Warns of flesh of one body that never reaches the threshold. Returns `false` when `left`,
    /// the evaluations that may still be made, is used up.
    fn lint_body(&mut self, scene: &Scene, surface: &SoftSurface, left: &mut usize) -> bool {
        let terms = &surface.sum.primitives;
        let mut term = 0;
        while term < terms.len() {
            let index = surface.element[term];
            let element = &scene.elements[index as usize];
            let first = term;
            while surface.element.get(term) == Some(&index) {
                term += 1;
            }
            let own = &terms[first..term];
            let flesh = element.flesh.map(|flesh| &scene.flesh[flesh as usize]);
            // Pieces of a bone may be as weak as its texture says.
            let surface = self.palette.surfaces.get(element.finish as usize);
            let is_piece = surface.is_some_and(|surface| surface.pattern.is_some());
            if is_piece || flesh.is_none_or(|flesh| flesh.strength <= 0.0) {
                continue;
            }
            // Most are strong enough by themselves, which is soon seen.
            let points = element.shape.samples();
            if points.iter().rev().any(|p| value(own, *p) >= THRESHOLD) {
                continue;
            }
            let Some(rest) = left.checked_sub(points.len() * terms.len()) else {
                return false;
            };
            *left = rest;
            if points.iter().all(|p| value(terms, *p) < THRESHOLD) {
                self.warn_of(
                    element.origin,
                    "this soft shape cannot be seen: its field never reaches the threshold",
                    "raise the `strength` or `radius` of its material, make it larger, or put it \
                     nearer to others",
                );
            }
        }
        true
    }
}

/// Returns whether at least three radii, the largest four times the least or more, have a
/// blobbiness that falls with their squares: the logarithm of |B|·R² varies (as the sum of squares
/// from its mean) by less than a third of that of R². One blobbiness for all, which varies as R²
/// does, is far from that. Without a large one the shapes are not crisp, however it is read.
fn goes_with_square(pairs: &[[f64; 2]]) -> bool {
    let mut radii: Vec<f64> = pairs.iter().map(|pair| pair[0]).collect();
    radii.sort_by(f64::total_cmp);
    radii.dedup();
    let crispest = pairs.iter().map(|pair| pair[1]).fold(0.0, f64::max);
    let [thinnest, _, .., widest] = radii[..] else {
        return false;
    };
    if radii.len() < 3 || widest < 4.0 * thinnest || crispest < 16.0 {
        return false;
    }
    let products = pairs.iter().map(|[radius, b]| b * radius * radius);
    let squares = pairs.iter().map(|[radius, _]| radius * radius);
    spread_of_logarithms(products) < spread_of_logarithms(squares) / 3.0
}

/// Returns whether shapes that are too crisp to be meant would be soft, all of them, if their
/// blobbiness were absolute, for at least three radii.
fn would_be_soft(pairs: &[[f64; 2]]) -> bool {
    let mut radii: Vec<f64> = pairs.iter().map(|pair| pair[0]).collect();
    radii.sort_by(f64::total_cmp);
    radii.dedup();
    let crisp = pairs.iter().filter(|pair| pair[1] >= 64.0).count();
    radii.len() >= 3 && crisp >= 2 && pairs.iter().all(|[radius, b]| b * radius * radius <= 10.0)
}

/// Sums the squares of the differences of logarithms from their mean.
fn spread_of_logarithms(values: impl Iterator<Item = f64>) -> f64 {
    let logs: Vec<f64> = values.map(libm::log).collect();
    let mean = logs.iter().sum::<f64>() / logs.len() as f64;
    logs.iter().map(|log| (log - mean) * (log - mean)).sum()
}

/// Returns a number with three digits that count.
fn round_off(x: f64) -> String {
    let digits = (2.0 - libm::floor(libm::log10(1.0005 * x.max(1e-9)))).clamp(0.0, 11.0);
    format!("{x:.*}", digits as usize)
}

fn value(terms: &[Primitive], p: DVec3) -> f64 {
    field::sum(terms, p.to_array()).value
}

/// Finds a ball around a shape as it is drawn: soft flesh reaches a little farther than its radius.
/// `None` for a plane, which is everywhere.
fn ball(scene: &Scene, element: &Element) -> Option<(DVec3, f64)> {
    let (centre, reach) = element.shape.bounding_sphere()?;
    let flesh = scene.radius(element) * if scene.is_soft(element) { 1.5 } else { 1.0 };
    Some((centre, reach + flesh))
}

/// Returns whether a ball is wholly outside the pyramid that the picture shows.
fn is_outside(projection: &scene::Projection, centre: DVec3, radius: f64) -> bool {
    let view = projection.world_from_view.transpose() * (centre - projection.eye);
    let [x, y] = projection.shift;
    let (w, h) = (projection.half_width, projection.half_height);
    let sides = [
        (view.x, w + x),
        (-view.x, w - x),
        (view.y, h + y),
        (-view.y, h - y),
    ];
    view.z > radius
        || sides.iter().any(|(across, tangent)| {
            (across + tangent * view.z) / libm::sqrt(1.0 + tangent * tangent) > radius
        })
}
