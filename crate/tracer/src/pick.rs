//! Picking of the element that is seen in a direction.
use crate::cells::search::Search;
use crate::cells::search_in;
use crate::function::range;
use crate::picture::Hit;
use crate::ray::Ray;
use crate::solids::Solids;
use field::Ball;
use glam::DVec3;
use scene::{Scene, Surface, Unit, surface};

/// A scene prepared for single rays.
///
/// It takes much less time and memory to prepare than a [`Picture`](crate::Picture), and more for
/// each ray.
///
/// ```
/// use glam::DVec3;
/// use scene::{Element, Scene, Shape};
/// use tracer::Picker;
///
/// let mut scene = Scene::default();
/// let ball = |x, radius| Shape::sphere(DVec3::X * x, radius);
/// scene.elements = vec![Element::new(ball(0.0, 1.0)), Element::new(ball(9.0, 1.0))];
/// let hit = Picker::new(&scene).pick(DVec3::new(9.0, 0.0, 5.0), DVec3::NEG_Z);
/// assert_eq!(hit.map(|hit| (hit.element, hit.t)), Some((Some(1), 4.0)));
/// ```
pub struct Picker {
    unit: Unit,
    solids: Solids,
    /// The soft surfaces, each with a ball that holds it.
    soft: Vec<(Surface, Option<Ball>)>,
}

/// Length, relative to the scene, below which intervals of rays are not subdivided.
const PICK_RESOLUTION: f64 = 1e-5;
/// Distance up to which surfaces without a support are followed, in units of the scene's size.
const FURTHEST: f64 = 1e4;

impl Picker {
    /// Prepares a scene.
    #[must_use]
    pub fn new(scene: &Scene) -> Self {
        let (unit, scene) = Unit::fit(scene);
        let mut soft = Vec::new();
        for surface in scene.surfaces() {
            let support = surface.function().support();
            soft.push((surface, support));
        }
        Self {
            unit,
            solids: Solids::new(&scene),
            soft,
        }
    }

    /// Returns the first crossing of a ray at t > 0. On a convolution surface the element is the
    /// one that adds most to the field there. `None` if the ray meets nothing, is not finite or has
    /// no direction.
    #[must_use]
    pub fn pick(&self, origin: DVec3, direction: DVec3) -> Option<Hit> {
        let ray = Ray {
            origin: self.unit.map(origin),
            direction: direction.try_normalize()?,
        };
        if !ray.origin.is_finite() {
            return None;
        }
        let mut nearest = None;
        let mut limit = f64::INFINITY;
        if let Some((number, crossing)) = self.solids.first(&ray, limit, false, &mut Vec::new()) {
            limit = crossing.t;
            let element = self.solids.element(number);
            nearest = Some((crossing.t, crossing.normal, None, element));
        }
        for (surface, support) in &self.soft {
            let Some(range) = range(*support, &ray, limit, FURTHEST) else {
                continue;
            };
            let mut found = None;
            let asked = (PICK_RESOLUTION, false);
            search_in(
                None,
                Search::new(surface.function(), ray, asked, &mut |t, _| {
                    found = Some(t);
                    false
                }),
                range,
            );
            if let Some(t) = found {
                limit = t;
                let point = ray.at(t);
                let function = surface.function();
                let gradient = DVec3::from_array(function.jet(point).gradient);
                let normal = (-gradient).try_normalize().unwrap_or(-ray.direction);
                let element = surface::strongest(function, surface.element(), point);
                nearest = Some((t, normal, Some(surface.body()), element.unwrap_or(0)));
            }
        }
        let (t, normal, body, element) = nearest?;
        let t = self.unit.length(t);
        Some(Hit {
            t,
            position: origin + ray.direction * t,
            normal,
            body,
            element: Some(element),
        })
    }
}
