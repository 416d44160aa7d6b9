//! Runs the commands of the parsed files, top to bottom, and builds the scene.
//!
//! From the bottom up: [`state`] holds the state of a run; `messages` adds messages about the text,
//! `lookup` and `call` read operands and arguments; the commands stand in modules by subject, each
//! a row of the table in [`crate::commands`] and the function that runs it, and `table` lists the
//! rows; `interpreter` runs files, blocks, loops and calls; this file begins and ends a run.

mod air;
mod call;
mod camera;
mod contact;
mod curves;
mod deform;
mod exact;
mod frozen;
mod image_list;
mod images;
mod implicit_mesh;
mod interpreter;
mod later;
mod lights;
mod lints;
mod lookup;
mod materials;
mod messages;
mod model;
mod moments;
mod motion;
mod objects;
mod options;
mod palette;
mod pattern;
mod picture;
pub(crate) mod presets;
mod primitives;
mod run;
mod scene_commands;
mod shots;
mod skeleton;
mod skeleton_file;
mod skeleton_radii;
pub(crate) mod state;
mod structure;
mod surroundings;
pub(crate) mod table;
pub(crate) mod textures;
mod thickened;
mod tints;
mod tools;
mod values;
pub(crate) mod variables;
mod view_plane;
mod watch;
mod watched;
mod words;

use crate::Project;
use crate::asset::Asset;
use crate::compiled::{Compiled, Picture};
use crate::provenance::Provenance;
use crate::scope::Scope;
use crate::sources::Sources;
use moments::Exposure;
use scene::Origin;
use shots::Shot;
use state::Evaluator;
use std::sync::Arc;
use watched::Watch;

/// Runs the first file of the project to the end.
#[must_use]
pub fn run<'a>(
    project: &Project,
    sources: &'a Sources<'a>,
    assets: &'a [Asset],
    moment: f64,
    scope: Scope<'a>,
) -> Compiled {
    let symbols = scope.symbols.clone();
    let mut state = Evaluator::new(sources, assets, moment, scope);
    let mut shots = state.run_all();
    // A text without shapes is one that is begun.
    if shots.iter().any(|shot| !shot.scene.elements.is_empty()) {
        state.note_unused_materials();
    }
    if let Some(last) = shots.last() {
        state.lint(&last.scene, &last.placements);
    }
    let open = shots.iter().filter(|shot| shot.shutter > 0.0).count();
    if (state.animated || state.moving.is_any()) && open > 0 && !state.report.has_errors() {
        let exposure = Exposure {
            sources,
            assets,
            symbols,
            from: moment,
            frozen: std::mem::take(&mut state.frozen),
            steps: state.scope.steps() * open as u64,
        };
        for (number, shot) in shots.iter_mut().enumerate() {
            if shot.shutter > 0.0 {
                shot.scene.moments = exposure.moments(number, &shot.scene, shot.shutter);
            }
        }
    }
    let Some(last) = shots.pop() else {
        return Compiled::default();
    };
    let earlier = shots.into_iter().map(|shot| Picture {
        scene: Arc::new(shot.scene),
        placements: shot.placements,
        output: shot.output,
        origin: shot.origin,
    });
    Compiled {
        scene: Arc::new(last.scene),
        placements: last.placements,
        earlier: earlier.collect(),
        diagnostics: state.report.finish(project),
        hot: state.hot,
        presets: state.presets,
        tools: state.tools,
        interludes: state.interludes,
        tool_origins: state.tool_origins,
        output: last.output,
        animated: state.animated || state.moving.is_any(),
        rate: state.moving.rate(),
        deforms: state.deforms,
        unread: state.unread,
    }
}

impl Evaluator<'_> {
    /// Runs the first file to its end; returns the pictures of its `shoot`s, or that of all there
    /// is at the end.
    fn run_all(&mut self) -> Vec<Shot> {
        if !self.sources.all.is_empty() {
            self.run_file(0);
        }
        if !self.report.is_cut_off() {
            self.check_open_objects();
        }
        self.check_penumbra();
        self.check_words();
        self.finish_shots()
    }
}

/// Runs the first file up to the command with this origin, a shape of the project's own texts.
/// `None` if the run does not come there.
#[must_use]
pub fn trace<'a>(
    sources: &'a Sources<'a>,
    assets: &'a [Asset],
    moment: f64,
    scope: Scope<'a>,
    target: Origin,
) -> Option<Provenance> {
    let mut state = Evaluator::new(sources, assets, moment, scope);
    state.watch = Some(Box::new(Watch::new(target)));
    if !sources.all.is_empty() {
        state.run_file(0);
    }
    state.watch.and_then(|watch| watch.seen)
}
