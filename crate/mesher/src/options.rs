//! What a mesh is asked to be, and why there is none.

use core::fmt;
use core::ops::ControlFlow;

/// Options of [`crate::polygonize`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Largest distance between mesh and surface, either way, in units of the model; > 0.
    pub tolerance: f64,
    /// Most triangles of the result.
    pub max_triangles: usize,
    /// Threads; the result does not depend on them. 1 in wasm.
    pub threads: usize,
    /// Whether all terms of the function add to it, so that its logarithm bends little where it is
    /// steep.
    pub only_adds: bool,
}

impl Options {
    /// The largest limit of triangles.
    pub const MOST_TRIANGLES: usize = 2_000_000;

    /// A tolerance, and otherwise defaults: two million triangles, one thread, terms of any sign.
    #[must_use]
    pub fn new(tolerance: f64) -> Self {
        Self {
            tolerance,
            max_triangles: Self::MOST_TRIANGLES,
            threads: 1,
            only_adds: false,
        }
    }
}

/// Why there is no mesh.
#[derive(Clone, Debug, PartialEq)]
pub enum MeshError {
    /// There is no surface.
    Nothing,
    /// All of the box is inside the surface.
    AllInside,
    /// The surface is infinite, or may be, and no box was given.
    Unbounded,
    /// The tolerance or a number of the scene is no positive, finite number.
    NotFinite(String),
    /// There would be more triangles than the limit.
    TooMany {
        /// The limit.
        limit: usize,
        /// A tolerance with which there are fewer, as far as can be told; `None` if no tolerance
        /// helps.
        fitting: Option<f64>,
    },
    /// The function is nearly its threshold throughout a region, so that no cells are fine enough.
    Flat {
        /// A point of the region.
        near: [f64; 3],
    },
    /// The caller has cancelled.
    Cancelled,
    /// Meshes could not be joined, or a file could not be made.
    Failed(String),
}

impl fmt::Display for MeshError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Nothing => {
                f.write_str("there is no surface: the field is below its threshold everywhere")
            }
            Self::AllInside => f.write_str(
                "there is no surface within the box: all of it is inside; a larger box may help",
            ),
            Self::Unbounded => f.write_str(
                "the surface is infinite, and nothing finite in the scene says how far to go; \
                 give a box",
            ),
            Self::NotFinite(what) => write!(f, "{what} must be a positive, finite number"),
            Self::TooMany { limit, fitting } => {
                write!(f, "the mesh needs more than {limit} triangles")?;
                match fitting {
                    Some(tolerance) => write!(f, "; a tolerance of {tolerance:.2e} would fit"),
                    None => f.write_str(", as the surface is very rough or its box very large"),
                }
            }
            Self::Flat { near: [x, y, z] } => write!(
                f,
                "surfaces lie on each other throughout a region, as near {x:.4} {y:.4} {z:.4}, so \
                 that no triangle is sure; move the bodies or elements there a little apart"
            ),
            Self::Cancelled => f.write_str("cancelled"),
            Self::Failed(why) => f.write_str(why),
        }
    }
}

impl core::error::Error for MeshError {}

/// What is being done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Phase {
    /// The search for the places where there is a surface.
    #[default]
    Extent,
    /// Refinement of cells until they prove the topology.
    Cells,
    /// Triangles, made fewer and better.
    Triangles,
    /// Hard shapes, and boolean unions.
    Solids,
}

impl Phase {
    /// All phases, in their order.
    pub const ALL: [Self; 4] = [Self::Extent, Self::Cells, Self::Triangles, Self::Solids];

    /// Its name in lower case.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Extent => "extent",
            Self::Cells => "cells",
            Self::Triangles => "triangles",
            Self::Solids => "solids",
        }
    }
}

/// How far a computation has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// From 0 to 1, never less than before.
    pub fraction: f32,
    /// What is done next.
    pub phase: Phase,
}

/// Progress of a long computation, with the right to end it.
pub struct Progress<'a> {
    report: &'a mut dyn FnMut(Step) -> ControlFlow<()>,
    from: f32,
    to: f32,
    phase: Phase,
    /// The last fraction reported.
    last: f32,
}

impl<'a> Progress<'a> {
    /// Progress that is reported as steps; a break cancels.
    pub fn new(report: &'a mut dyn FnMut(Step) -> ControlFlow<()>) -> Self {
        Self {
            report,
            from: 0.0,
            to: 1.0,
            phase: Phase::default(),
            last: 0.0,
        }
    }

    /// A part of the way, from one fraction of it to another.
    pub fn part(&mut self, from: f32, to: f32) -> Progress<'_> {
        let span = self.to - self.from;
        Progress {
            from: self.from + from * span,
            to: self.from + to * span,
            report: self.report,
            phase: self.phase,
            last: self.from + from * span,
        }
    }

    /// The same way, on which something else is done from now on.
    pub fn in_phase(mut self, phase: Phase) -> Self {
        self.phase = phase;
        self
    }

    /// Reports the fraction done.
    ///
    /// # Errors
    /// If the caller cancels.
    pub fn at(&mut self, fraction: f32) -> Result<(), MeshError> {
        let fraction = self.from + fraction.clamp(0.0, 1.0) * (self.to - self.from);
        self.last = self.last.max(fraction);
        self.again()
    }

    /// Reports the same fraction once more: something is being done that takes its time.
    ///
    /// # Errors
    /// If the caller cancels.
    pub fn again(&mut self) -> Result<(), MeshError> {
        let (fraction, phase) = (self.last, self.phase);
        match (self.report)(Step { fraction, phase }) {
            ControlFlow::Continue(()) => Ok(()),
            ControlFlow::Break(()) => Err(MeshError::Cancelled),
        }
    }
}
