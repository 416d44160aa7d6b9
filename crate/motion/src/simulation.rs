//! The step.

use crate::links::{self, Link};
use crate::obstacle::Standing;
use crate::setup::{Error, Settings, Setup};
use crate::touch::Flesh;
use glam::DVec3;

/// The energies of a simulation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Energy {
    /// `Σ ½mv²`
    pub kinetic: f64,
    /// `−Σ m g·x`
    pub potential: f64,
    /// Energy of the springs, and of flesh that is pressed in.
    pub elastic: f64,
}

impl Energy {
    /// The sum.
    #[must_use]
    pub fn total(&self) -> f64 {
        self.kinetic + self.potential + self.elastic
    }
}

/// Bodies that move from step to step.
#[derive(Clone, Debug)]
pub struct Simulation {
    settings: Settings,
    obstacles: Vec<Standing>,
    /// The nodes of all bodies, one body after another.
    places: Vec<DVec3>,
    previous: Vec<DVec3>,
    velocities: Vec<DVec3>,
    /// Inverse masses, 0 for pinned nodes.
    inverse: Vec<f64>,
    masses: Vec<f64>,
    pinned: Vec<usize>,
    links: Vec<Link>,
    flesh: Flesh,
    /// The farthest that a node moves in a step.
    reach: f64,
    hurried: bool,
    /// Whether links are solved from the last to the first in the next step.
    backwards: bool,
}

impl Simulation {
    /// Bodies at rest, where the setup has them.
    ///
    /// # Errors
    /// If there are too many nodes or obstacles, a number is not usable, or a skeleton has no
    /// polyline.
    pub fn new(setup: &Setup) -> Result<Self, Error> {
        setup.check()?;
        let settings = setup.settings;
        let (mut links, mut masses, mut pinned) = (Vec::new(), Vec::new(), Vec::new());
        let mut places: Vec<DVec3> = Vec::new();
        for body in &setup.bodies {
            let first = places.len();
            let nodes = &body.skeleton.nodes;
            links::links(body, first, &settings, &mut links);
            masses.extend(links::masses(body));
            places.extend(nodes.iter().map(|node| node.position));
            let own = body.pinned.iter().filter(|&&node| node < nodes.len());
            pinned.extend(own.map(|node| first + node));
        }
        let flesh = Flesh::new(&setup.bodies).map_err(Error::Skeleton)?;
        let mut inverse: Vec<f64> = masses.iter().map(|mass| 1.0 / mass).collect();
        for &node in &pinned {
            inverse[node] = 0.0;
        }
        let reach = flesh
            .thinnest()
            .map_or(f64::INFINITY, |radius| 0.5 * radius);
        Ok(Self {
            settings,
            obstacles: setup.obstacles.iter().map(Standing::new).collect(),
            previous: places.clone(),
            velocities: vec![DVec3::ZERO; places.len()],
            places,
            inverse,
            masses,
            pinned,
            links,
            flesh,
            reach,
            hurried: false,
            backwards: false,
        })
    }

    /// Places of the nodes, one body after another.
    #[must_use]
    pub fn positions(&self) -> &[DVec3] {
        &self.places
    }

    /// The nodes' velocities, lengths per second.
    #[must_use]
    pub fn velocities(&self) -> &[DVec3] {
        &self.velocities
    }

    /// Sets a node's velocity.
    ///
    /// # Panics
    /// If there is no such node.
    pub fn set_velocity(&mut self, node: usize, velocity: DVec3) {
        self.velocities[node] = velocity;
    }

    /// The pinned nodes, numbered through all bodies.
    #[must_use]
    pub fn pinned(&self) -> &[usize] {
        &self.pinned
    }

    /// The highest speed at which nothing passes through anything: half the thinnest flesh in a
    /// step. What would be faster is slowed down to it.
    #[must_use]
    pub fn speed_limit(&self) -> f64 {
        self.reach * self.settings.rate * f64::from(self.settings.steps)
    }

    /// Whether something has been slowed down to the [speed limit](Self::speed_limit).
    #[must_use]
    pub fn is_hurried(&self) -> bool {
        self.hurried
    }

    /// Returns the largest depth of the flesh in an obstacle; negative if it touches none.
    #[must_use]
    pub fn deepest(&self) -> f64 {
        self.flesh.deepest(&self.places, &self.obstacles)
    }

    /// The momentum, `Σ mv`.
    #[must_use]
    pub fn momentum(&self) -> DVec3 {
        let all = self.velocities.iter().zip(&self.masses);
        all.fold(DVec3::ZERO, |sum, (v, m)| sum + *v * *m)
    }

    /// Computes the energy of flesh that is pressed into other flesh, or into its own folds.
    pub fn pressed(&mut self) -> f64 {
        self.flesh.energy(&self.places, self.settings.stiffness)
    }

    /// Operations of a frame, roughly: each takes some nanoseconds.
    #[must_use]
    pub fn work(&self) -> u64 {
        let step = 4 * self.places.len() as u64
            + 4 * self.links.len() as u64
            + self.flesh.work(self.obstacles.len());
        step * u64::from(self.settings.steps)
    }

    /// The energies now.
    pub fn energy(&mut self) -> Energy {
        let kinetic = self.velocities.iter().zip(&self.masses);
        let potential = self.places.iter().zip(&self.masses);
        let springs: f64 = self.links.iter().map(|l| l.energy(&self.places)).sum();
        Energy {
            kinetic: kinetic.map(|(v, m)| 0.5 * m * v.length_squared()).sum(),
            potential: -potential
                .map(|(x, m)| m * self.settings.gravity.dot(*x))
                .sum::<f64>(),
            elastic: springs + self.pressed(),
        }
    }

    /// Advances by a frame. Pinned nodes go evenly to `targets`, in the order of [`Self::pinned`];
    /// those without one stay.
    pub fn advance(&mut self, targets: &[DVec3]) {
        let steps = self.settings.steps;
        let from: Vec<DVec3> = self.pinned.iter().map(|&node| self.places[node]).collect();
        for number in 1..=steps {
            let share = f64::from(number) / f64::from(steps);
            let goals = from.iter().zip(targets);
            let goals: Vec<DVec3> = goals.map(|(a, b)| a.lerp(*b, share)).collect();
            self.step(&goals);
        }
    }

    /// Advances by a step; pinned nodes are put to `goals`.
    fn step(&mut self, goals: &[DVec3]) {
        let settings = self.settings;
        let h = 1.0 / (settings.rate * f64::from(settings.steps));
        let drag = 1.0 / (1.0 + settings.damping * h);
        self.previous.copy_from_slice(&self.places);
        for i in 0..self.places.len() {
            if self.inverse[i] <= 0.0 {
                continue;
            }
            let velocity = (self.velocities[i] + settings.gravity * h) * drag;
            let (velocity, slowed) = limit(velocity, self.reach / h);
            self.hurried |= slowed;
            self.velocities[i] = velocity;
            self.places[i] += velocity * h;
        }
        for (&node, goal) in self.pinned.iter().zip(goals) {
            self.places[node] = *goal;
            self.velocities[node] = (*goal - self.previous[node]) / h;
        }
        let (places, inverse) = (&mut self.places[..], &self.inverse[..]);
        if self.backwards {
            let links = self.links.iter().rev();
            links.for_each(|link| link.solve(places, inverse, h));
        } else {
            self.links
                .iter()
                .for_each(|link| link.solve(places, inverse, h));
        }
        self.backwards = !self.backwards;
        self.flesh
            .solve_folds(places, &self.previous, inverse, &settings, h);
        self.flesh.solve_obstacles(
            places,
            &mut self.previous,
            &self.velocities,
            inverse,
            &self.obstacles,
            settings.friction,
        );
        for i in 0..self.places.len() {
            if !self.places[i].is_finite() {
                self.places[i] = self.previous[i];
            }
            if self.inverse[i] > 0.0 {
                self.velocities[i] = (self.places[i] - self.previous[i]) / h;
            }
        }
        // A speed that gravity gives in two steps is no blow.
        let least = 2.0 * settings.gravity.length() * h;
        self.flesh
            .rebound(&mut self.velocities, &self.inverse, settings.bounce, least);
    }
}

/// Shortens a velocity to a length of at most `most`; also returns whether it was longer.
fn limit(velocity: DVec3, most: f64) -> (DVec3, bool) {
    let speed = velocity.length();
    if speed > most {
        (velocity * (most / speed), true)
    } else {
        (velocity, false)
    }
}
