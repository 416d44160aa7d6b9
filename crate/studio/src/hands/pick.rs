//! Which element is seen in a direction: the hard shape that a ray meets first, or, on the soft
//! surface, the bone that gives most of the field there.
//!
//! The soft surface is looked for by steps along the ray and halving, in double precision, without the
//! tracer's certificates: a click needs to know whose flesh is seen, not where exactly.

use field::{Primitive, THRESHOLD};
use glam::DVec3;
use scene::Scene;
use tracer::Ray;
use tracer::hard::Solid;

/// A scene made ready for clicks.
pub struct Picker {
    primitives: Vec<Primitive>,
    /// The element of each primitive.
    owner: Vec<usize>,
    /// The hard shapes, each with its element.
    solids: Vec<(usize, Solid)>,
}

/// What was met.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Met {
    /// Index of the element in [`Scene::elements`].
    pub element: usize,
    /// How far away.
    pub distance: f64,
}

/// Steps along a ray, at most.
const MOST_STEPS: f64 = 4096.0;
/// How far planes are followed, in distances from the eye to the nearest thing that ends.
const FAR: f64 = 1e4;

impl Picker {
    /// Prepares a scene.
    #[must_use]
    pub fn new(scene: &Scene) -> Self {
        let surface = scene.soft_surface();
        let mut solids = Vec::new();
        for (index, element) in scene.elements.iter().enumerate() {
            if scene.is_soft(element) || element.material >= scene.materials.len() {
                continue;
            }
            let radius = scene.radius(element);
            for part in element.shape.parts(radius) {
                solids.extend(Solid::new(&part, radius).map(|solid| (index, solid)));
            }
        }
        Self {
            primitives: surface.field.primitives,
            owner: surface.element,
            solids,
        }
    }

    /// What a ray meets first; `direction` is a unit vector.
    #[must_use]
    pub fn pick(&self, origin: DVec3, direction: DVec3) -> Option<Met> {
        let hard = self.hard(Ray { origin, direction });
        let limit = hard.map_or(f64::INFINITY, |met| met.distance);
        self.soft(origin, direction, limit).or(hard)
    }

    fn hard(&self, ray: Ray) -> Option<Met> {
        let mut crossings = Vec::new();
        let mut nearest: Option<Met> = None;
        for (element, solid) in &self.solids {
            if let Some((center, radius)) = solid.ball() {
                let along = (center - ray.origin).dot(ray.direction);
                if (ray.at(along)).distance(center) > radius {
                    continue;
                }
            }
            crossings.clear();
            solid.crossings(&ray, &mut crossings);
            for crossing in &crossings {
                let bar = nearest.map_or(f64::INFINITY, |met| met.distance);
                if crossing.t > 0.0 && crossing.t < bar {
                    nearest = Some(Met {
                        element: *element,
                        distance: crossing.t,
                    });
                }
            }
        }
        nearest
    }

    /// The first crossing of the soft surface nearer than `limit`.
    fn soft(&self, origin: DVec3, direction: DVec3, limit: f64) -> Option<Met> {
        let mut near: Vec<(usize, [f64; 2])> = Vec::new();
        for (index, primitive) in self.primitives.iter().enumerate() {
            if let Some([from, to]) = primitive.ray_interval(origin, direction)
                && to > 0.0
                && from < limit
            {
                near.push((index, [from.max(0.0), to]));
            }
        }
        let ends = near.iter().map(|(_, [_, to])| *to);
        let furthest = ends.filter(|to| to.is_finite()).fold(0.0, f64::max);
        let end = match furthest {
            0.0 => FAR * origin.length().max(1.0),
            furthest => furthest * if limit.is_finite() { 1.0 } else { 2.0 },
        };
        let start = near.iter().map(|(_, [from, _])| *from).fold(end, f64::min);
        let end = end.min(limit);
        if start.is_nan() || start >= end {
            return None;
        }
        // Short enough for the slimmest flesh that the ray passes through its middle.
        let slimmest = near
            .iter()
            .map(|(_, [from, to])| to - from)
            .fold(f64::INFINITY, f64::min);
        let step = (slimmest / 24.0).clamp((end - start) / MOST_STEPS, (end - start) / 64.0);
        if !(step > 0.0 && step.is_finite()) {
            return None;
        }
        let value = |index: usize, t: f64| {
            let point = origin + direction * t;
            self.primitives[index].value::<f64>(point.to_array())
        };
        let excess = |t: f64| -> f64 {
            near.iter()
                .filter(|(_, [from, to])| *from <= t && t <= *to)
                .map(|(index, _)| value(*index, t))
                .sum::<f64>()
                - THRESHOLD
        };
        let steps = ((end - start) / step).ceil() as usize;
        let mut before = (start, excess(start));
        for number in 1..=steps {
            let t = (start + step * number as f64).min(end);
            let here = (t, excess(t));
            if (before.1 < 0.0) != (here.1 < 0.0) {
                let distance = halve(before, here, excess);
                let flesh = |index: usize| value(index, distance);
                let (index, _) = near
                    .iter()
                    .filter(|(_, [from, to])| *from <= distance && distance <= *to)
                    .max_by(|(a, _), (b, _)| flesh(*a).total_cmp(&flesh(*b)))?;
                return Some(Met {
                    element: self.owner[*index],
                    distance,
                });
            }
            before = here;
        }
        None
    }
}

/// Where a function changes its sign between two places.
fn halve(a: (f64, f64), b: (f64, f64), f: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (a.0, b.0);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if (f(middle) < 0.0) == (a.1 < 0.0) {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use tracer::Picture;

    fn scene(text: &str) -> Scene {
        let file = rats::File {
            name: String::from("main.rat"),
            text: text.to_owned(),
        };
        let compiled = rats::compile(&rats::Project { files: vec![file] });
        let errors = compiled.diagnostics.iter();
        assert_eq!(
            errors
                .filter(|d| d.severity == rats::Severity::Error)
                .count(),
            0
        );
        compiled.scene
    }

    #[test]
    fn the_first_shape_is_met() {
        let scene = scene(
            "surface hard, diffuse Red\nsurface flesh, diffuse Red, blobbiness -2\n\
             sphere hard 1 0 0 0\nsphere flesh 1 0 0 5\nsphere flesh 0.5 4 0 0\n\
             plane hard 0 -9 0 0 1 0\n",
        );
        let picker = Picker::new(&scene);
        let from = |x: f64, y: f64| picker.pick(DVec3::new(x, y, 20.0), DVec3::NEG_Z);
        let element = |met: Option<Met>| met.map(|met| met.element);
        assert_eq!(element(from(0.0, 0.0)), Some(1));
        assert_eq!(element(from(4.0, 0.0)), Some(2));
        assert_eq!(element(from(9.0, 0.0)), None);
        let behind = picker.pick(DVec3::new(0.0, 0.0, 2.5), DVec3::NEG_Z);
        assert_eq!(element(behind), Some(0));
        let down = DVec3::new(0.0, -1.0, -1.0).normalize();
        assert_eq!(
            element(picker.pick(DVec3::new(20.0, 0.0, 20.0), down)),
            Some(3)
        );
    }

    #[test]
    fn the_distance_is_the_tracer_s() {
        let scene = scene(
            "surface s, diffuse Red, blobbiness -1\nsphere s 0.5 0 0 0\n\
             cylinder s 0.2 -1 0 0 2 1 0\narc s 1 0.3 0 0 0 0 0 1 0 200\n\
             curve s 0.1 -2 -1 0 -1 1 0 1 -1 0 2 1 0\n",
        );
        let (picker, picture) = (Picker::new(&scene), Picture::new(&scene, [8, 8]));
        let mut hits = 0;
        for i in 0..20 {
            for j in 0..20 {
                let to = DVec3::new(0.21 * f64::from(i) - 2.0, 0.21 * f64::from(j) - 2.0, 0.0);
                let eye = DVec3::new(0.3, 0.5, 9.0);
                let direction = (to - eye).normalize();
                let first = picture.hits(eye, direction).first().map(|hit| hit.t);
                let met = picker.pick(eye, direction).map(|met| met.distance);
                // What only a grazing ray meets may be missed.
                if let (Some(a), Some(b)) = (first, met) {
                    assert!((a - b).abs() < 1e-2, "{a} {b}");
                    hits += 1;
                }
            }
        }
        assert!(hits > 60, "{hits}");
    }

    #[test]
    fn elements_far_and_near_take_no_time() {
        let mut text = String::from("surface s, diffuse Red, blobbiness -1\n");
        text += "for i = 1 to 20000 {\n sphere s 0.1 i*0.01 sin(i) cos(i)\n}\n";
        let picker = Picker::new(&scene(&text));
        let begin = std::time::Instant::now();
        assert!(picker.pick(DVec3::new(-5.0, 0.0, 1.0), DVec3::X).is_some());
        assert!(begin.elapsed().as_secs_f64() < 2.0, "{:?}", begin.elapsed());
    }
}
