//! The lab in the page: opens its lessons, and carries out its wishes (crate `lab`).

pub mod wish;

use crate::page::{Moment, Page};
use crate::panel::Panel;
use crate::render::Phase;
use crate::wish::{LabWish, Setting, Wish, Wishes, WorkWish};
use document::examples;
use egui::{Context, Ui};
use lab::{Dataset, Lab, Lesson};

/// The lab.
pub struct Lessons(pub Lab);

impl Lessons {
    /// Carries out a wish.
    pub fn act(&mut self, wish: LabWish, _page: &mut Page, at: &Moment<'_>) {
        let Self(lab) = self;
        match wish {
            LabWish::Open(lesson) => open(lab, lesson),
            LabWish::Show => open(lab, lab.lesson()),
            LabWish::Close => {
                browser::push_hash(lab.came_from());
                lab.close();
            }
            LabWish::Follow(Some(lesson)) => lab.open(lesson, ""),
            LabWish::Follow(None) => lab.close(),
            LabWish::Share => {
                let link = format!("{}{}", browser::page(), lab.lesson().hash());
                at.ctx.copy_text(link);
                lab.say("Link to this lesson copied.", at.now);
            }
        }
    }
}

fn open(lab: &mut Lab, lesson: Lesson) {
    lab.open(lesson, &browser::hash());
    browser::push_hash(&lesson.hash());
}

impl Panel for Lessons {
    fn show(&mut self, page: &Page, ui: &mut Ui, wishes: &mut Wishes) {
        let (session, renderer) = (&page.work.session, &page.renderer);
        let is_busy = renderer.phase() == Phase::Tracing;
        let frame = lab::Frame {
            dataset: Dataset {
                generation: session.generation(),
                scene: session.scene().map(AsRef::as_ref),
                camera: session.camera(),
            },
            tracing: is_busy.then(|| renderer.progress().fraction),
            theme: page.settings.theme,
            now: browser::now(ui.ctx()),
        };
        let mut commands = Vec::new();
        lab::show(&mut self.0, &frame, ui, &mut commands);
        wishes.extend(commands.into_iter().filter_map(wish));
    }

    fn forget(&mut self, _page: &mut Page, _ctx: &Context) {
        self.0.close();
    }
}

/// Returns the wish that carries out a command of the lab; `None` if the example to open does not
/// exist.
fn wish(command: lab::Command) -> Option<Wish> {
    Some(match command {
        lab::Command::Open(lesson) => LabWish::Open(lesson).into(),
        lab::Command::Close => LabWish::Close.into(),
        lab::Command::Share => LabWish::Share.into(),
        lab::Command::SetTheme(choice) => Setting::Theme(choice).into(),
        lab::Command::OpenText { name, text } => WorkWish::OpenText { name, text }.into(),
        lab::Command::OpenExample { file } => {
            let mut all = examples::ALL.iter();
            let index = all.position(|example| example.name == file)?;
            WorkWish::OpenExample(index).into()
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_example_that_the_lab_offers_is_there() {
        let found = open("tshape.rat");
        assert!(matches!(found, Some(Wish::Work(WorkWish::OpenExample(_)))));
        assert_eq!(open("nothing.rat"), None);
    }

    fn open(file: &'static str) -> Option<Wish> {
        wish(lab::Command::OpenExample { file })
    }
}
