//! Bodies whose surface is that of any implicit function. Rays find it in [`cells`](crate::cells).
use crate::body::Body;
use crate::cells::search::Search;
use crate::cells::{Cells, search_in};
use crate::ray::Ray;
use crate::walk::Quest;
use core::sync::atomic::AtomicUsize;
use field::{Ball, Implicit};
use glam::DVec3;
use scene::{ComposedSurface, Scene, Unit};
use std::sync::Arc;

/// Length below which pieces of rays are not halved, in units of the scene's size.
const RESOLUTION: f64 = 5e-7;
/// Distance up to which surfaces without a support are followed, in units of the scene's size.
const FURTHEST: f64 = 1e4;
/// Offset of rays to the lights above a hit at t, over 1 + t.
const LIFT: f64 = 1e-6;

/// The surface of an implicit function as a body of a picture.
#[derive(Debug)]
pub(crate) struct FunctionBody {
    /// The body's number in the scene.
    pub number: u32,
    /// The function, in coordinates of its own.
    pub function: Arc<dyn Implicit>,
    /// Finish of each of the function's elements.
    pub finish: Vec<u32>,
    /// The scene's element that each of the function's elements came from; empty for a function
    /// that was added.
    pub element: Vec<u32>,
    /// Ball outside which there is no surface, in the function's coordinates.
    support: Option<Ball>,
    /// Cells of that ball.
    cells: Option<Cells>,
    /// The map from the function's coordinates to those of the unit scene.
    pub unit: Unit,
}

impl FunctionBody {
    /// Prepares the function of a body, given the finish of each of its elements and the scene's
    /// element that it came from, if any, in coordinates from which `unit` leads to those of the
    /// unit scene. `bytes` counts those of the cells of a whole world.
    pub fn new(
        number: u32,
        function: Arc<dyn Implicit>,
        (finish, element): (Vec<u32>, Vec<u32>),
        unit: Unit,
        bytes: &Arc<AtomicUsize>,
    ) -> Self {
        let support = function.support();
        let bounded = support.filter(|ball| ball.radius > 0.0 && ball.radius.is_finite());
        Self {
            number,
            support,
            cells: bounded.map(|ball| Cells::new(ball, bytes.clone())),
            finish,
            function,
            element,
            unit,
        }
    }

    /// Returns the function of a body of the unit scene.
    pub fn of(surface: ComposedSurface, scene: &Scene, bytes: &Arc<AtomicUsize>) -> Self {
        let elements = surface.element.iter();
        let finish = elements.map(|&e| scene.elements[e as usize].finish);
        let finish = finish.collect();
        Self::new(
            surface.body,
            surface.function,
            (finish, surface.element),
            Unit::IDENTITY,
            bytes,
        )
    }

    /// Calls `tell` with each crossing of a ray of the unit scene, and whether the ray enters
    /// there, until `tell` returns false; if it asks for entries alone, not with where they are
    /// exactly. Returns the number of evaluations.
    fn search(
        &self,
        ray: &Ray,
        limit: f64,
        entries: bool,
        tell: &mut dyn FnMut(f64, bool) -> bool,
    ) -> u64 {
        let scale = self.unit.length(1.0);
        let ray = Ray {
            origin: self.unit.world(ray.origin),
            direction: ray.direction,
        };
        let Some(range) = range(self.support, &ray, limit * scale, FURTHEST * scale) else {
            return 0;
        };
        let asked = (RESOLUTION * scale, entries);
        search_in(
            self.cells.as_ref(),
            Search::new(&*self.function, ray, asked, &mut |t, enters| {
                tell(t / scale, enters)
            }),
            range,
        )
    }
}

impl Body for FunctionBody {
    fn number(&self) -> u32 {
        self.number
    }

    fn first(&self, ray: &Ray, limit: f64, quest: Quest) -> (Option<f64>, u64) {
        let mut found = None;
        let evaluations = self.search(ray, limit, quest == Quest::Entry, &mut |t, _| {
            found = Some(t);
            false
        });
        (found, evaluations)
    }

    fn all(&self, ray: &Ray) -> Vec<(f64, DVec3)> {
        let mut found = Vec::new();
        self.search(ray, f64::INFINITY, false, &mut |t, _| {
            found.push((t, self.gradient(ray, t)));
            true
        });
        found
    }

    fn gradient(&self, ray: &Ray, t: f64) -> DVec3 {
        let jet = self.function.jet(self.unit.world(ray.at(t)));
        DVec3::from_array(jet.gradient)
    }

    fn shares(&self, point: DVec3, shares: &mut Vec<(u32, u32, f64)>) {
        let mut own = Vec::new();
        self.function.shares(self.unit.world(point), &mut own);
        let first = self.finish.first();
        shares.extend(own.into_iter().filter_map(|(number, share)| {
            let element = self.element.get(number as usize).unwrap_or(&u32::MAX);
            let finish = self.finish.get(number as usize).or(first)?;
            Some((*element, *finish, share))
        }));
    }

    fn lift(&self, t: f64) -> f64 {
        LIFT * (1.0 + t)
    }
}

/// Returns the range of a ray, up to a limit, within a surface's ball; `None` if the ray misses it.
/// Without a ball the range ends at `furthest`.
pub(crate) fn range(
    support: Option<Ball>,
    ray: &Ray,
    limit: f64,
    furthest: f64,
) -> Option<[f64; 2]> {
    let [near, far] = match support {
        None => [0.0, furthest],
        Some(Ball { center, radius }) => {
            let offset = center - ray.origin;
            let along = offset.dot(ray.direction);
            let across = (offset - ray.direction * along).length_squared();
            let square = radius * radius * (1.0 + 1e-9) - across;
            if square < 0.0 {
                return None;
            }
            let half = square.sqrt();
            [(along - half).max(0.0), along + half]
        }
    };
    let far = far.min(limit);
    (near < far).then_some([near, far])
}
