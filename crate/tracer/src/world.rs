//! The surfaces and lights of a scene, prepared for tracing.
use crate::body::Body;
use crate::function::FunctionBody;
use crate::rich::Rich;
use crate::root_finder::{FoundBody, RootFinder};
use crate::shade::Finish;
use crate::soft::Soft;
use crate::solids::Solids;
use core::sync::atomic::AtomicUsize;
use field::Implicit;
use glam::{DVec3, Vec3};
use scene::{Light, Scene, Surface, Unit};
use std::sync::Arc;

/// A scene's surfaces and lights, in units of the scene's size.
pub(crate) struct World {
    pub unit: Unit,
    /// The convolution surfaces of the bodies.
    pub soft: Soft,
    /// Bodies that are met ray by ray: those of other functions, and those of another root finder.
    pub others: Vec<Box<dyn Body>>,
    /// The hard elements.
    pub solids: Solids,
    pub finishes: Vec<Finish>,
    pub lights: Vec<Light>,
    pub background: Vec3,
    /// Whether faces seen from behind are hidden.
    pub one_sided: bool,
    /// Distance from a hard surface at which rays start from a hit at t, over 1 + t.
    pub hard_lift: f64,
    /// Data that only some scenes need.
    pub rich: Option<Rich>,
    /// Number of the scene's bodies.
    bodies: u32,
    /// Bytes that the cells of its functions take.
    cells: Arc<AtomicUsize>,
}

/// [`World::hard_lift`] where `epsilon` is [`EPSILON`].
const HARD_LIFT: f64 = 1e-6;
/// The default `epsilon`.
const EPSILON: f64 = 1e-4;

/// A surface that a ray meets.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Owner {
    /// The convolution surface of a body, by its number among the soft ones.
    Soft(u32),
    /// The surface of a body that is met ray by ray.
    Other(usize),
    /// The surface of a hard element.
    Solid(u32),
}

/// A point where a ray meets a surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SurfacePoint {
    /// The ray's parameter.
    pub t: f64,
    pub position: DVec3,
    /// Outward unit normal.
    pub normal: DVec3,
    /// Distance above the surface at which rays to the lights start.
    pub lift: f64,
    /// The mixture of the elements' finishes.
    pub finish: Finish,
    /// A number that tells surfaces apart: 1 and up for bodies, beyond those for hard elements.
    pub surface: u32,
}

impl SurfacePoint {
    /// Returns the normal on the side from which a ray of this direction sees the surface.
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
    pub fn new(world: &Scene) -> Self {
        Self::prepare(world, Rich::is_needed(world))
    }

    /// Prepares a scene, with or without the data that only some scenes need.
    pub fn prepare(world: &Scene, rich: bool) -> Self {
        let (unit, scene) = Unit::fit(world);
        let solids = Solids::new(&scene);
        let rich = rich.then(|| Rich::new(world, unit, &scene, &solids));
        let settings = scene.settings;
        let (finishes, lights) = (
            scene.finishes.iter().map(Finish::of).collect(),
            scene.lights.clone(),
        );
        let (background, bodies) = (
            Vec3::from(scene.background.mean()),
            scene.bodies.len() as u32,
        );
        let epsilon = settings.epsilon.clamp(1e-9, 0.1);
        let mut sums = Vec::new();
        let mut others: Vec<Box<dyn Body>> = Vec::new();
        let cells = Arc::default();
        for surface in scene.surfaces() {
            match surface {
                Surface::Sum(sum) => sums.push(sum),
                Surface::Composed(composed) => {
                    others.push(Box::new(FunctionBody::of(composed, &scene, &cells)));
                }
            }
        }
        let soft = Soft::new(scene, sums);
        Self {
            hard_lift: HARD_LIFT * (epsilon / EPSILON),
            rich: rich.map(|rich| rich.complete(&soft)),
            unit,
            soft,
            others,
            solids,
            finishes,
            lights,
            background,
            one_sided: !settings.double_sided,
            bodies,
            cells,
        }
    }

    /// Adds a body of an implicit function, given with the finish of each of its elements, and
    /// returns the body's number.
    pub fn add(&mut self, function: Arc<dyn Implicit>, finish: Vec<u32>) -> u32 {
        let number = self.bodies;
        self.bodies += 1;
        let body = FunctionBody::new(
            number,
            function,
            (finish, Vec::new()),
            self.unit,
            &self.cells,
        );
        self.others.push(Box::new(body));
        number
    }

    /// Lets another root finder find the convolution surfaces from now on, ray by ray.
    pub fn find_with(&mut self, finder: &Arc<dyn RootFinder>) {
        let nothing = Soft::new(Scene::default(), Vec::new());
        let soft = Arc::new(core::mem::replace(&mut self.soft, nothing));
        let bodies = 0..soft.bodies.len() as u32;
        let found = bodies.map(|body| -> Box<dyn Body> {
            Box::new(FoundBody {
                soft: soft.clone(),
                body,
                finder: finder.clone(),
            })
        });
        self.others.splice(0..0, found);
    }

    /// Returns the number that tells the surface of a body, by its number in the scene, from
    /// others.
    pub fn surface_of_body(&self, number: u32) -> u32 {
        1 + number
    }

    /// Returns the number that tells the surface of a hard element from others.
    pub fn surface_of_solid(&self, number: u32) -> u32 {
        1 + self.bodies + number
    }

    /// Returns the owner of the surface of a number ([`World::surface_of_body`],
    /// [`World::surface_of_solid`]).
    pub fn owner_of(&self, surface: u32) -> Owner {
        let number = surface - 1;
        if number >= self.bodies {
            return Owner::Solid(number - self.bodies);
        }
        let bodies = &self.soft.bodies;
        match bodies.binary_search_by_key(&number, |body| body.number) {
            Ok(body) => Owner::Soft(body as u32),
            Err(_) => {
                let position = self.others.iter().position(|body| body.number() == number);
                Owner::Other(position.unwrap_or(0))
            }
        }
    }

    /// Whether there is nothing but convolution surfaces, found in the certified way.
    pub fn only_soft(&self) -> bool {
        self.solids.is_empty() && self.others.is_empty()
    }

    /// Mixes finishes by weights ≥ 0.
    pub fn mix(&self, weights: impl Iterator<Item = (u32, f64)> + Clone) -> Finish {
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
