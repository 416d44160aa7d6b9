//! Everything that rays can meet, made ready.
use crate::digger::{self, Digger};
use crate::function::FunctionBody;
use crate::shade::Finish;
use crate::soft::Soft;
use crate::solids::Solids;
use crate::unit::Unit;
use field::Implicit;
use glam::{DVec3, Vec3};
use scene::{Light, Scene, Surface};
use std::sync::Arc;

/// A scene's surfaces and lights, in units of the scene's size.
pub(crate) struct World {
    pub unit: Unit,
    /// The convolution surfaces of the bodies.
    pub soft: Soft,
    /// Bodies of other functions.
    pub functions: Vec<FunctionBody>,
    /// The hard elements.
    pub solids: Solids,
    pub finishes: Vec<Finish>,
    pub lights: Vec<Light>,
    pub background: Vec3,
    /// What finds the convolution surfaces, if it is not the certified way.
    pub digger: Option<Box<dyn Digger>>,
    /// Whether faces seen from behind are hidden.
    pub one_sided: bool,
    /// How many bodies the scene has.
    bodies: u32,
}

/// A point where a ray meets a surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SurfacePoint {
    /// The ray's parameter.
    pub t: f64,
    pub position: DVec3,
    /// Outward unit normal.
    pub normal: DVec3,
    /// How far rays to the lights must start above the surface.
    pub lift: f64,
    /// The mixture of the elements' finishes.
    pub finish: Finish,
    /// A number that tells surfaces apart: 1 and up for bodies, beyond those for hard elements.
    pub surface: u32,
}

impl SurfacePoint {
    /// The normal on the side from which a ray of this direction sees the surface.
    pub fn facing(&self, direction: DVec3) -> DVec3 {
        if self.normal.dot(direction) > 0.0 {
            -self.normal
        } else {
            self.normal
        }
    }
}

impl World {
    /// Prepares a scene.
    pub fn new(scene: &Scene) -> Self {
        let (unit, scene) = Unit::fit(scene);
        let solids = Solids::new(&scene);
        let settings = scene.settings;
        let (finishes, lights) = (
            scene.finishes.iter().map(Finish::of).collect(),
            scene.lights.clone(),
        );
        let (background, bodies) = (Vec3::from(scene.background), scene.bodies.len() as u32);
        let (mut sums, mut functions) = (Vec::new(), Vec::new());
        for surface in scene.surfaces() {
            match surface {
                Surface::Sum(sum) => sums.push(sum),
                Surface::Composed(composed) => functions.push(FunctionBody::of(composed, &scene)),
            }
        }
        let soft = Soft::new(scene, sums);
        Self {
            unit,
            soft,
            functions,
            solids,
            finishes,
            lights,
            background,
            digger: match settings.digger {
                scene::Digger::Hermite => None,
                other => Some(digger::of(other)),
            },
            one_sided: !settings.double_sided,
            bodies,
        }
    }

    /// Adds a body of an implicit function, given with the finish of each of its elements, and gives the body's number.
    pub fn add(&mut self, function: Arc<dyn Implicit>, finish: Vec<u32>) -> u32 {
        let number = self.bodies;
        self.bodies += 1;
        self.functions.push(FunctionBody {
            number,
            support: function.support(),
            function,
            finish,
            element: Vec::new(),
            unit: self.unit,
        });
        number
    }

    /// The number that tells the surface of a body, by its number in the scene, from others.
    pub fn surface_of_body(&self, number: u32) -> u32 {
        1 + number
    }

    /// The number that tells the surface of a hard element from others.
    pub fn surface_of_solid(&self, number: u32) -> u32 {
        1 + self.bodies + number
    }

    /// Whether there is nothing but convolution surfaces found in the certified way.
    pub fn only_soft(&self) -> bool {
        self.solids.is_empty() && self.functions.is_empty() && self.digger.is_none()
    }

    /// The finish mixed of those of some elements by weights ≥ 0.
    pub fn mixed(&self, weights: impl Iterator<Item = (u32, f64)> + Clone) -> Finish {
        let total: f64 = weights.clone().map(|(_, weight)| weight).sum();
        let mut finish = Finish::default();
        for (index, weight) in weights {
            let share = (weight / total) as f32;
            if share > 0.0 {
                finish.mix(&self.finishes[index as usize], share);
            }
        }
        finish
    }
}
