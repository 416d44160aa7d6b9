//! The hard elements of a scene.
use crate::beam::Beam;
use crate::hard::{Crossing, Solid};
use crate::hierarchy::Hierarchy;
use crate::ray::Ray;
use scene::{Scene, Shape};

/// The hard elements, in a hierarchy.
pub struct Solids {
    solids: Vec<Solid>,
    /// Finishes of the solids, with the scene's elements that they came from.
    of: Vec<[u32; 2]>,
    tree: Hierarchy,
    /// Solids without a bounding ball.
    everywhere: Vec<u32>,
}

impl Solids {
    /// Collects a scene's hard elements, and, with `soft off`, all of them.
    #[must_use]
    pub fn new(scene: &Scene) -> Self {
        let mut solids = Vec::new();
        let mut of = Vec::new();
        for (number, element) in (0..).zip(&scene.elements) {
            if scene.is_soft(element) || element.finish as usize >= scene.finishes.len() {
                continue;
            }
            let radius = scene.radius(element);
            for part in element.shape.parts(radius) {
                let radius = match element.shape {
                    Shape::Function(_) => part.radius(),
                    _ => radius,
                };
                if let Some(solid) = Solid::new(&part, radius) {
                    solids.push(solid);
                    of.push([element.finish, number]);
                }
            }
        }
        let mut balls = Vec::new();
        let mut everywhere = Vec::new();
        for (i, solid) in solids.iter().enumerate() {
            match solid.ball() {
                Some((center, radius)) => balls.push((i as u32, center, radius)),
                None => everywhere.push(i as u32),
            }
        }
        Self {
            solids,
            of,
            tree: Hierarchy::new(balls),
            everywhere,
        }
    }

    /// Whether there are no solids.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.solids.is_empty()
    }

    /// Returns the number of solids.
    #[must_use]
    pub fn len(&self) -> u32 {
        self.solids.len() as u32
    }

    /// Returns the finish of a solid.
    #[must_use]
    pub fn finish(&self, number: u32) -> usize {
        self.of[number as usize][0] as usize
    }

    /// Returns the scene's element that a solid came from.
    #[must_use]
    pub fn element(&self, number: u32) -> u32 {
        self.of[number as usize][1]
    }

    /// Returns the solid of the nearest crossing with 0 < t < limit, and the crossing; `None` if
    /// there is none. If `front_only`, back faces do not count.
    pub fn first(
        &self,
        ray: &Ray,
        limit: f64,
        front_only: bool,
        scratch: &mut Vec<Crossing>,
    ) -> Option<(u32, Crossing)> {
        let mut nearest: Option<(u32, Crossing)> = None;
        self.each(ray, |number, solid| {
            scratch.clear();
            solid.crossings(ray, scratch);
            for &crossing in scratch.iter() {
                if front_only && crossing.normal.dot(ray.direction) > 0.0 {
                    continue;
                }
                // Equal distances go to the first element, whatever the order of the search.
                let bar = nearest.map_or((limit, u32::MAX), |(n, c)| (c.t, n));
                if crossing.t > 0.0 && (crossing.t, number) < bar && crossing.t < limit {
                    nearest = Some((number, crossing));
                }
            }
        });
        nearest
    }

    /// Returns all crossings with t > 0, each with its solid, in no order.
    #[must_use]
    pub fn all(&self, ray: &Ray) -> Vec<(u32, Crossing)> {
        let (mut all, mut own) = (Vec::new(), Vec::new());
        self.each(ray, |number, solid| {
            own.clear();
            solid.crossings(ray, &mut own);
            let ahead = own.iter().filter(|c| c.t > 0.0);
            all.extend(ahead.map(|c| (number, *c)));
        });
        all
    }

    /// Calls `f` with each solid that a ray may meet, and its number.
    fn each(&self, ray: &Ray, mut f: impl FnMut(u32, &Solid)) {
        if self.solids.is_empty() {
            return;
        }
        for &i in &self.everywhere {
            f(i, &self.solids[i as usize]);
        }
        self.tree.search(&Beam::of_ray(*ray), |i, _, _| {
            f(i, &self.solids[i as usize])
        });
    }
}
