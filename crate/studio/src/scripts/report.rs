//! The page's state as scripts read it.

use document::{fitting, mesh_export};
use rats::{Diagnostic, Project};
use scene::Camera;
use serde::Serialize;
use std::cell::RefCell;
use std::rc::Rc;

/// The state after a tick.
#[derive(Clone, Debug, Default, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Report {
    /// `idle`, `waiting`, `tracing`, `done` or `cancelled`.
    pub phase: &'static str,
    /// Share of the picture's work that is done, 0 … 1.
    pub progress: f64,
    /// `coarse`, `full` or `smooth` while tracing.
    pub pass: Option<&'static str>,
    /// Seconds until the picture is finished, once there is an estimate.
    pub remaining: Option<f64>,
    /// `webgpu`, `webgl2` or `none`.
    pub backend: &'static str,
    /// Workers that run.
    pub workers: usize,
    /// Workers replaced since the page was opened.
    pub replaced: u32,
    /// The reason why tracing does not work.
    pub failure: Option<String>,
    /// Whether the picture on the screen is of the present text and camera, and that has no errors.
    pub fresh: bool,
    /// Number of diagnostics that are errors.
    pub errors: usize,
    /// The stand-in for the picture on the screen: `draft` or `made before`.
    pub stand_in: Option<&'static str>,
    /// Number of elements of the scene that the text makes.
    pub elements: usize,
    /// Messages of the compiler.
    pub diagnostics: Vec<Diagnostic>,
    /// Milestones of the picture.
    pub timings: Timings,
    /// Size of the picture on the screen.
    pub picture: Option<Size>,
    /// Counts of work for the picture.
    pub stats: Stats,
    /// Names of the variables marked `hot`.
    pub hot: Vec<String>,
    /// Names of the images and meshes.
    pub assets: Vec<String>,
    /// Name of the mesh that is being read.
    pub reading: Option<String>,
    /// The fit of a mesh that runs, or ran last.
    pub fit: Option<fitting::Report>,
    /// The mesh of the dialog, once one was asked for.
    pub mesh: Option<mesh_export::Report>,
    /// The frame on show of an animated work.
    pub frame: Option<u32>,
    /// The tool for drawing that is in hand: `draw`, `move` or `cut`.
    pub drawing: Option<&'static str>,
    /// Rises when the text changes.
    pub revision: u64,
    /// Name of the open work.
    pub name: String,
    /// Whether all changes are written to the browser's storage.
    pub saved: bool,
    /// Whether another tab writes the open work.
    pub theirs: bool,
}

/// Seconds from the start of the picture.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Timings {
    /// The coarse picture is complete.
    pub coarse: Option<f64>,
    /// The picture is finished.
    pub done: Option<f64>,
    /// Seconds that compiling the text took.
    pub compile: f64,
}

/// Pixels.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Size {
    /// Width.
    pub width: u32,
    /// Height.
    pub height: u32,
}

/// Counts of work.
#[derive(Clone, Copy, Debug, Default, Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Stats {
    /// Rays from the eye.
    pub primary_rays: u64,
    /// Rays towards lights.
    pub shadow_rays: u64,
    /// Evaluations of one primitive's field at one point.
    pub field_evaluations: u64,
}

/// State that scripts can read at any time.
#[derive(Clone, Default)]
pub struct Outbox {
    /// The state.
    pub report: Report,
    /// The texts.
    pub project: Rc<Project>,
    /// The camera chosen by the user.
    pub chosen: Option<Camera>,
    /// The camera in use.
    pub camera: Camera,
    /// The open lesson of the lab.
    pub lab: Option<lab::Report>,
    /// The open sculpture.
    pub sculpture: Option<Sculpture>,
    /// Places of the widgets, in points.
    pub places: crate::places::Places,
}

/// The open sculpture.
#[derive(Clone, Debug, Serialize)]
pub struct Sculpture {
    /// Name of the text.
    pub name: String,
    /// Vertices and faces.
    pub counts: [usize; 2],
    /// Numbers of strokes that can be undone and redone.
    pub depth: [usize; 2],
}

/// The outbox, shared by the app and the page handle.
pub type Shared = Rc<RefCell<Outbox>>;
