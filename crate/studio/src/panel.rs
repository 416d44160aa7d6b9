//! The panels of the page. Each has its state, its widgets, its wishes and what they do in a file
//! or a folder of its own.

use crate::export::MeshPanel;
use crate::film::FilmPanel;
use crate::fit::FitPanel;
use crate::help::Help;
use crate::lessons::Lessons;
use crate::page::{Moment, Page};
use crate::sculpt::SculptPanel;
use crate::sliders::Sliders;
use crate::stage::Stage;
use crate::text::TextPanel;
use crate::tray::Tray;
use crate::wish::Wishes;
use crate::works::gallery::Gallery;
use egui::{Context, Ui};

/// A part of the page with a state of its own.
pub trait Panel {
    /// Shows the panel in all of `ui`. It reads the page and adds wishes.
    fn show(&mut self, page: &Page, ui: &mut Ui, wishes: &mut Wishes);

    /// Does the work of timers and messages, also while the panel is not shown.
    fn tick(&mut self, _page: &mut Page, _at: &Moment<'_>) {}

    /// Returns the seconds until [`Panel::tick`] must be called again; `None` if it need not.
    fn wait(&self, _page: &Page, _now: f64) -> Option<f64> {
        None
    }

    /// Forgets what belonged to the work before, when another one was opened.
    fn forget(&mut self, _page: &mut Page, _ctx: &Context) {}
}

/// The panels that have a state.
pub struct Panels {
    /// The texts, images and meshes of the work.
    pub text: TextPanel,
    /// The picture.
    pub stage: Stage,
    /// The variables marked `hot`.
    pub sliders: Sliders,
    /// Fitting a mesh to measured points.
    pub fit: FitPanel,
    /// The film of an animated work.
    pub film: FilmPanel,
    /// The results of the text's jobs on pictures.
    pub tray: Tray,
    /// The model as a mesh.
    pub mesh: MeshPanel,
    /// Examples and own works.
    pub gallery: Gallery,
    /// The help and the reference.
    pub help: Help,
    /// The sculpture that is worked on.
    pub sculpt: SculptPanel,
    /// The lab.
    pub lab: Lessons,
}

impl Panels {
    /// Returns each of them.
    pub fn all(&mut self) -> [&mut dyn Panel; 11] {
        [
            &mut self.mesh,
            &mut self.fit,
            &mut self.film,
            &mut self.stage,
            &mut self.tray,
            &mut self.text,
            &mut self.sliders,
            &mut self.gallery,
            &mut self.help,
            &mut self.sculpt,
            &mut self.lab,
        ]
    }
}
