//! All hard elements of a scene.
use crate::beam::Beam;
use crate::hard::{Crossing, Solid};
use crate::hierarchy::Hierarchy;
use crate::ray::Ray;
use scene::Scene;

/// The hard elements, in a hierarchy.
pub struct Solids {
    solids: Vec<Solid>,
    material: Vec<u32>,
    tree: Hierarchy,
    /// Those without a bounding ball.
    everywhere: Vec<u32>,
}

impl Solids {
    /// Collects a scene's hard elements, and, with `soft off`, all of them.
    #[must_use]
    pub fn new(scene: &Scene) -> Self {
        let mut solids = Vec::new();
        let mut material = Vec::new();
        for element in &scene.elements {
            if scene.is_soft(element) || element.material >= scene.materials.len() {
                continue;
            }
            let radius = scene.radius(element);
            for part in element.shape.parts(radius) {
                if let Some(solid) = Solid::new(&part, radius) {
                    solids.push(solid);
                    material.push(element.material as u32);
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
            material,
            tree: Hierarchy::new(balls),
            everywhere,
        }
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.solids.is_empty()
    }

    /// The material of a solid.
    #[must_use]
    pub fn material(&self, number: u32) -> usize {
        self.material[number as usize] as usize
    }

    /// The nearest crossing with 0 < t < limit, and whose it is.
    pub fn first(
        &self,
        ray: &Ray,
        limit: f64,
        scratch: &mut Vec<Crossing>,
    ) -> Option<(u32, Crossing)> {
        let mut nearest: Option<(u32, Crossing)> = None;
        self.each(ray, |number, solid| {
            scratch.clear();
            solid.crossings(ray, scratch);
            for &crossing in scratch.iter() {
                // Equal distances go to the first element, whatever the order of the search.
                let bar = nearest.map_or((limit, u32::MAX), |(n, c)| (c.t, n));
                if crossing.t > 0.0 && (crossing.t, number) < bar && crossing.t < limit {
                    nearest = Some((number, crossing));
                }
            }
        });
        nearest
    }

    /// Adds all crossings with t > 0, in no order.
    pub fn all(&self, ray: &Ray, out: &mut Vec<Crossing>) {
        self.each(ray, |_, solid| solid.crossings(ray, out));
        out.retain(|c| c.t > 0.0);
    }

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
