//! The list of the panels: all that the app does with each of them goes through it.

use crate::export::MeshPanel;
use crate::film::FilmPanel;
use crate::fit::FitPanel;
use crate::help::Help;
use crate::lessons::Lessons;
use crate::page::{Moment, Page};
use crate::panel::Panel;
use crate::sculpt::SculptPanel;
use crate::sliders::Sliders;
use crate::stage::Stage;
use crate::text::TextPanel;
use crate::tray::Tray;
use crate::wish::Wish;
use crate::works::gallery::Gallery;
use egui::Context;

/// Declares the panels, with the group of wishes that each carries out, in the order in which they
/// tick.
macro_rules! panels {
    ($($(#[$doc:meta])* $name:ident: $panel:ty $(, wishes $group:ident)?;)+) => {
        /// The panels that have a state.
        pub struct Panels {
            $($(#[$doc])* pub $name: $panel,)+
        }

        impl Panels {
            /// Does the work of timers and messages.
            pub fn tick(&mut self, page: &mut Page, at: &Moment<'_>) {
                $(self.$name.tick(page, at);)+
            }

            /// Returns the seconds until the first of them must tick again.
            #[must_use]
            pub fn wait(&self, page: &Page, now: f64) -> Option<f64> {
                let waits = [$(self.$name.wait(page, now)),+];
                waits.into_iter().flatten().min_by(f64::total_cmp)
            }

            /// Forgets what belonged to the work before, when another one was opened.
            pub fn forget(&mut self, page: &mut Page, ctx: &Context) {
                $(self.$name.forget(page, ctx);)+
            }

            /// Lets the wish's panel carry it out. Returns it if it belongs to none.
            pub fn act(&mut self, wish: Wish, page: &mut Page, at: &Moment<'_>) -> Option<Wish> {
                match wish {
                    $($(Wish::$group(wish) => self.$name.act(wish, page, at),)?)+
                    other => return Some(other),
                }
                None
            }
        }
    };
}

panels! {
    /// The model as a mesh.
    mesh: MeshPanel, wishes Mesh;
    /// Fitting a mesh to measured points.
    fit: FitPanel, wishes Fit;
    /// The picture. It makes way for measured files that are being read.
    stage: Stage, wishes View;
    /// The film of an animated work.
    film: FilmPanel, wishes Film;
    /// The results of the text's jobs on pictures.
    tray: Tray, wishes Tray;
    /// The texts, images and meshes of the work.
    text: TextPanel, wishes Text;
    /// The variables marked `hot`.
    sliders: Sliders;
    /// Examples and own works.
    gallery: Gallery, wishes Work;
    /// The help and the reference.
    help: Help;
    /// The sculpture that is worked on.
    sculpt: SculptPanel, wishes Sculpt;
    /// The lab.
    lab: Lessons, wishes Lab;
}
