//! Strokes: what a line of a text says.

use crate::decay::Decay;
use crate::holes::Deletion;
use crate::refine::Refinement;
use crate::region::{Choice, RegionChange};
use crate::start::Start;
use crate::tool::Tool;
use glam::DVec3;

/// Mesh that a sculpture starts from.
#[derive(Clone, Debug, PartialEq)]
pub enum Beginning {
    /// Shape.
    Shape(Start),
    /// File of a mesh, by its name.
    File(String),
}

/// Stroke, in the order of the manual.
#[derive(Clone, Debug, PartialEq)]
pub enum Stroke {
    /// Name for what has been reached.
    Stage(String),
    /// Mirrors tools in the planes x = 0, y = 0, z = 0 from here on.
    Symmetry([bool; 3]),
    /// Tool's way.
    Sweep(Sweep),
    /// Change of the region.
    Region(RegionChange),
    /// Change of the masks.
    Masks(MaskChange),
    /// Refinement of the region.
    Refine(Refinement),
    /// Loop's subdivision of the region, so many times.
    Loop(u32),
    /// Averaging within the region: how often, and the share of the way.
    Average(u32, f64),
    /// Closes the holes beside the region.
    Fill,
    /// Deletes the region.
    Delete(Deletion),
    /// Simplifies the region to a share of its faces.
    Simplify(f64),
}

/// Change of all masks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MaskChange {
    /// Sets all masks to 0.
    Clear,
    /// Replaces each mask m by 1 − m.
    Invert,
}

/// Tool that is moved along a path.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    /// Effect on vertices inside the tool.
    pub action: Action,
    /// The tool.
    pub tool: Tool,
    /// Function by which motions fade over neighbours.
    pub decay: Decay,
    /// Distance that motions reach, measured along edges; 0: neighbours stay.
    pub range: f64,
    /// Limit on the direction of motions.
    pub constraint: Option<Constraint>,
    /// `true` if it touches vertices of the region only; neighbours of these may still follow.
    pub only_region: bool,
    /// The way of its centre.
    pub path: Vec<PathPoint>,
}

impl Sweep {
    /// An action of a tool on its own: no decay, no constraint, and no path yet.
    #[must_use]
    pub fn new(action: Action, tool: Tool) -> Self {
        Self {
            action,
            tool,
            decay: Decay::Flat,
            range: 0.0,
            constraint: None,
            only_region: false,
            path: Vec::new(),
        }
    }
}

/// Effect of a tool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Action {
    /// Vertices inside the tool are driven out, along the ray from its centre onto its surface.
    Push,
    /// Vertices that are inside the tool at the start of its path follow it.
    Pull,
    /// Vertices inside go towards the mean of their neighbours.
    Smooth,
    /// The masks of vertices inside go towards a value.
    Mask(f64),
    /// The colours of vertices inside go towards a colour: sRGB, 0 … 1.
    Paint([f64; 3]),
    /// Faces with a vertex inside are chosen.
    Region(Choice),
}

/// Limit on the direction of motions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Constraint {
    /// Along each vertex's normal.
    Normal,
    /// Perpendicular to the normal.
    Tangent,
}

/// Place of a tool's centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathPoint {
    /// Place of the centre.
    pub position: DVec3,
    /// Share of the effect, 0 … 1: the pressure of a pen.
    pub pressure: f64,
}

impl PathPoint {
    /// Returns a point with full pressure.
    #[must_use]
    pub fn new(position: DVec3) -> Self {
        Self {
            position,
            pressure: 1.0,
        }
    }
}
