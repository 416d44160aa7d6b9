//! The grip of a hand that sculpts: a stroke, the view, or a setting of the tool.

use crate::brush::{Brush, Doing};
use egui::Pos2;
use glam::DVec3;
use sculpt::PathPoint;
use std::rc::Rc;
use viewport::{Frame, Surface, View};

/// State of the hand.
#[derive(Default)]
pub struct Hand {
    /// The place where the tool is shown.
    pub shown: Option<DVec3>,
    pub doing: State,
    /// The place where a key has asked to grab the mesh.
    pub grabs: Option<Pos2>,
    /// The place where a key has asked to take a point as the centre of rotation.
    pub centers: Option<Pos2>,
}

#[derive(Default)]
pub enum State {
    #[default]
    Idle,
    Stroke(Box<Ongoing>),
    Turn(Pos2),
    Shift(Pos2),
    Modal(Box<Modal>),
    /// A gesture of two fingers; nothing begins until all are lifted.
    Fingers,
}

/// A stroke that is being made.
pub struct Ongoing {
    pub doing: Doing,
    pub reverses: bool,
    /// The image when it began: a push goes along the surface that was there, not into its own
    /// dent.
    pub seen: Option<(Frame, Rc<Surface>, View)>,
    /// The depth of the point that was taken hold of.
    pub depth: f64,
    pub grip: DVec3,
    pub normal: DVec3,
    pub axis: Option<usize>,
    pub last: PathPoint,
    pub began: f64,
    /// Whether it goes on without a button until a click.
    pub is_free: bool,
}

/// Something of the tool that is set by moving.
pub struct Modal {
    pub what: Setting,
    pub from: Pos2,
    pub before: Brush,
    pub axis: Option<usize>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Setting {
    Turn,
    Scale,
    Size,
    Range,
}

impl Hand {
    /// Whether the view turns now.
    pub fn turns(&self) -> bool {
        matches!(self.doing, State::Turn(_) | State::Fingers)
    }
}
