//! The handles of an element, made once.

use assist::handles::{self, Handle};
use document::session::Session;
use scene::Camera;
use sketch::Sight;

/// The handles of an element for a revision of the text and a frame of the film, seen by a camera.
#[derive(Default)]
pub struct Handles {
    all: Vec<Handle>,
    /// Key of the handles: revision, frame of the film, element; and the camera.
    made: Option<((u64, u32, usize), Camera)>,
}

impl Handles {
    /// Forgets them.
    pub fn clear(&mut self) {
        *self = Self::default();
    }

    /// Returns the handles of an element. While a hand holds something they stay as they are on the
    /// shape, whatever the camera: making them anew costs as much as compiling.
    pub fn of(
        &mut self,
        session: &Session,
        sight: &Sight,
        element: usize,
        is_held: bool,
    ) -> &[Handle] {
        let key = (session.revision(), session.film_frame(), element);
        let camera = session.camera();
        let is_fresh = self
            .made
            .is_some_and(|(made, from)| made == key && (is_held || from == camera));
        if !is_fresh {
            self.all = handles::handles(
                session.project(),
                session.assets(),
                session.film_frame(),
                session.compilation(),
                element,
                &sight.projection.world_from_view,
            );
            self.made = Some((key, camera));
        }
        &self.all
    }
}
