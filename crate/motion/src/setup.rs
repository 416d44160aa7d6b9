//! The data of a motion.

use crate::obstacle::{Obstacle, fits};
use crate::{LARGEST, MOST_NODES, MOST_OBSTACLES, MOST_STEPS};
use glam::DVec3;
use skeleton::{Scheme, Skeleton};

/// Skeleton that moves.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// Nodes where they are at first, which is also the shape that the springs pull back to.
    pub skeleton: Skeleton,
    /// Subdivision of the curves.
    pub scheme: Scheme,
    /// The nodes that do not move by themselves, in increasing order.
    pub pinned: Vec<usize>,
}

/// Forces and time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Acceleration of all that falls, lengths per second².
    pub gravity: DVec3,
    /// The share of the velocity that is lost in a second, as long as that is small:
    /// `v′ = −damping·v`. At least 0.
    pub damping: f64,
    /// The force that stretches a curve to twice its length, for a mean mass of 1 a node. At least
    /// 0.
    pub stiffness: f64,
    /// The share of the stiffness with which curves resist bending and twisting. At least 0.
    pub bending: f64,
    /// The share of the speed that is left after a floor is hit, from 0 to 1.
    pub bounce: f64,
    /// Coulomb's coefficient of friction, at least 0.
    pub friction: f64,
    /// Steps of a frame, at least 1.
    pub steps: u32,
    /// Frames of a second, above 0.
    pub rate: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            gravity: DVec3::new(0.0, -9.81, 0.0),
            damping: 0.2,
            stiffness: 1000.0,
            bending: 0.2,
            bounce: 0.0,
            friction: 0.4,
            steps: 16,
            rate: 25.0,
        }
    }
}

/// Bodies that move, what stands in their way, and the forces.
#[derive(Clone, Debug, PartialEq)]
pub struct Setup {
    /// Bodies that move.
    pub bodies: Vec<Body>,
    /// Obstacles, which stand still.
    pub obstacles: Vec<Obstacle>,
    /// Forces and time.
    pub settings: Settings,
}

/// Setup that cannot move.
#[derive(Clone, Debug, PartialEq)]
pub enum Error {
    /// More nodes than [`MOST_NODES`].
    Nodes(usize),
    /// More obstacles than [`MOST_OBSTACLES`].
    Obstacles(usize),
    /// Skeleton that has no polyline.
    Skeleton(skeleton::Error),
    /// Number that is not finite, too large or out of its range; its name.
    Number(&'static str),
}

impl std::fmt::Display for Error {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Nodes(count) => write!(
                f,
                "{count} nodes are to move together; {MOST_NODES} is the limit"
            ),
            Self::Obstacles(count) => write!(
                f,
                "{count} shapes stand in the way of a motion; {MOST_OBSTACLES} is the limit"
            ),
            Self::Skeleton(error) => error.fmt(f),
            Self::Number(name) => write!(f, "the {name} of a motion is no usable number"),
        }
    }
}

impl std::error::Error for Error {}

fn is_positive(number: f64) -> bool {
    (0.0..=LARGEST).contains(&number)
}

impl Setup {
    /// The first thing that is wrong, if any.
    pub(crate) fn check(&self) -> Result<(), Error> {
        let nodes = self.bodies.iter().map(|b| b.skeleton.nodes.len()).sum();
        if nodes > MOST_NODES {
            return Err(Error::Nodes(nodes));
        }
        if self.obstacles.len() > MOST_OBSTACLES {
            return Err(Error::Obstacles(self.obstacles.len()));
        }
        let s = &self.settings;
        let numbers = [
            ("gravity", fits(&s.gravity)),
            ("damping", is_positive(s.damping)),
            ("stiffness", is_positive(s.stiffness)),
            ("bending", is_positive(s.bending)),
            ("bounce", (0.0..=1.0).contains(&s.bounce)),
            ("friction", is_positive(s.friction)),
            ("number of steps", (1..=MOST_STEPS).contains(&s.steps)),
            ("rate", (1e-6..=1e6).contains(&s.rate)),
            (
                "obstacle",
                self.obstacles.iter().all(|obstacle| obstacle.is_usable()),
            ),
            (
                "place",
                self.bodies.iter().all(|body| {
                    let mut nodes = body.skeleton.nodes.iter();
                    nodes.all(|node| fits(&node.position) && is_positive(node.radius))
                }),
            ),
        ];
        match numbers.into_iter().find(|(_, is_usable)| !is_usable) {
            Some((name, _)) => Err(Error::Number(name)),
            None => Ok(()),
        }
    }
}
