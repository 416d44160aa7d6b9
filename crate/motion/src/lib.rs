//! Motion of skeletons: nodes are masses, curves are springs, and floors, obstacles, other
//! skeletons and a skeleton's own folds push back.
//!
//! A [`Setup`] says all; a [`Simulation`] made of it goes on frame by frame from the places that
//! the setup gives, at a fixed step. Nothing else has a say: the same setup gives the same bits on
//! every platform, as only `+ − × ÷ √` are used.
//!
//! ```
//! use glam::DVec3;
//! use motion::{Body, Obstacle, Settings, Setup, Simulation};
//! use skeleton::{Node, Scheme, Skeleton};
//!
//! let node = |x, y| Node { position: DVec3::new(x, y, 0.0), radius: 0.3 };
//! let nodes = vec![node(0.0, 3.0), node(1.0, 3.5), node(2.0, 4.0)];
//! let worm = Skeleton { nodes, curves: vec![vec![0, 1, 2]] };
//! let floor = Obstacle::Plane { point: DVec3::ZERO, normal: DVec3::Y };
//! let setup = Setup {
//!     bodies: vec![Body { skeleton: worm, scheme: Scheme::Cubic, pinned: vec![] }],
//!     obstacles: vec![floor],
//!     settings: Settings::default(),
//! };
//! let mut simulation = Simulation::new(&setup)?;
//! for _ in 0..100 {
//!     simulation.advance(&[]);
//! }
//! // It lies on the floor.
//! assert!(simulation.positions().iter().all(|p| (0.1..0.6).contains(&p.y)));
//! # Ok::<(), motion::Error>(())
//! ```
//!
//! # How it works
//!
//! Extended position-based dynamics (Macklin, Müller, Chentanez 2016; small steps: Macklin et al.
//! 2019): in each step nodes fly freely, then each constraint in turn moves its nodes by
//! `−C/(Σ w|∇C|² + α/h²)·w∇C`, w being inverse masses, α the compliance (the inverse of a spring's
//! constant) and h the step, and the velocities follow from the moves. This is stable at any
//! stiffness and loses energy rather than gaining it.
//!
//! - `links`: edges of the control polygons, bending at their corners, twist along their edges.
//! - `touch`: samples of the flesh, taken from the curves refined once, against obstacles (which do
//!   not give way) and against stretches of curves through their field (a penalty: a spring that
//!   pushes when the flesh is pressed in).
//! - `thickness`: the radius of the flesh of curves; `field`: the field of the kernel 1/d³ on
//!   segments, and the distance it stands for.
//! - `simulation`: the step.
//!
//! A general engine of rigid bodies would serve less: what touches here are convolution surfaces on
//! subdivision curves, whose samples are weighted means of several masses, so that shapes, contacts
//! and constraints would all be ours; it would weigh more than all of the page's own geometry, and
//! its results are the same everywhere only in a slower mode.

mod field;
mod links;
mod obstacle;
mod setup;
mod simulation;
mod thickness;
mod touch;

pub use field::{distance, line};
pub use obstacle::Obstacle;
pub use setup::{Body, Error, Settings, Setup};
pub use simulation::{Energy, Simulation};

/// The most nodes of all bodies that move together.
pub const MOST_NODES: usize = 200;
/// The most obstacles.
pub const MOST_OBSTACLES: usize = 256;
/// The most frames.
pub const MOST_FRAMES: u32 = 3000;
/// The most steps of a frame.
pub const MOST_STEPS: u32 = 200;
/// The largest coordinate, radius, and number of a setting.
pub const LARGEST: f64 = 1e12;
