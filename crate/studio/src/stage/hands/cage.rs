//! The control points of a `deform` as knobs on the picture, with the cage between them.

use super::around::Around;
use super::knob::{self, stroke};
use crate::wish::{TextWish, Wishes};
use assist::handles::{self, Handle};
use document::session::Session;
use egui::{Painter, Rect, Ui};
use glam::DVec3;
use rats::Deform;
use scene::Origin;
use sketch::Sight;
use std::collections::BTreeSet;

/// Most knobs that are shown: those nearest to the eye.
const MOST_KNOBS: usize = 240;

/// The deformation whose cage is shown.
#[derive(Default)]
pub struct Cage {
    /// Index in the compiled text's list.
    chosen: Option<usize>,
    /// The revision and the index that handles were made for, and the handles.
    made: Option<(u64, usize, Vec<Handle>)>,
    /// The control points that `edges` join.
    places: Vec<DVec3>,
    edges: Vec<[u32; 2]>,
    /// The knob that is held, and the place to which the pointer has dragged it.
    pub(super) drag: Option<(usize, DVec3)>,
}

fn contains(origin: Origin, file: usize, byte: usize) -> bool {
    origin.file as usize == file && (origin.start as usize..=origin.end as usize).contains(&byte)
}

impl Cage {
    /// Lets go: no deformation is chosen.
    pub fn let_go(&mut self) {
        self.chosen = None;
        self.drag = None;
    }

    /// Returns the deformation that is shown.
    pub fn deform<'s>(&self, session: &'s Session) -> Option<&'s Deform> {
        session.compilation().deforms.get(self.chosen?)
    }

    /// Chooses the deformation in which the caret is; elsewhere it lets go.
    pub fn follow(&mut self, session: &Session, caret: Option<(usize, usize)>) {
        let Some((file, byte)) = caret else { return };
        let deforms = &session.compilation().deforms;
        let found = deforms
            .iter()
            .position(|deform| contains(deform.origin, file, byte));
        if found.is_none() && self.drag.is_some() {
            return;
        }
        self.chosen = found;
    }

    /// Chooses the last deformation of elements that a command has made. Returns its origin.
    pub fn choose_of(&mut self, session: &Session, origin: Origin) -> Option<Origin> {
        let deforms = &session.compilation().deforms;
        self.chosen = deforms
            .iter()
            .rposition(|deform| deform.of.contains(&origin));
        Some(deforms[self.chosen?].origin)
    }

    /// Draws cage and knobs, and carries out what the user does to them.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        painter: &Painter,
        rect: Rect,
        sight: &Sight,
        around: &Around<'_>,
        wishes: &mut Wishes,
    ) {
        let session = around.session;
        let (Some(index), Some(deform)) = (self.chosen, self.deform(session)) else {
            return;
        };
        let key = (session.revision(), index);
        if self
            .made
            .as_ref()
            .is_none_or(|made| (made.0, made.1) != key)
        {
            let handles = handles::cage(deform);
            let places = deform.controls.iter().map(|control| control.place);
            if !places.clone().eq(self.places.iter().copied()) {
                self.places = places.collect();
                self.edges = edges(&self.places);
            }
            self.made = Some((key.0, key.1, handles));
        }
        let Some((.., handles)) = &self.made else {
            return;
        };
        for [a, b] in &self.edges {
            let ends = [*a, *b].map(|i| handles[i as usize].place);
            stroke(painter, sight, &ends, 0.35);
        }
        let mut order: Vec<usize> = (0..handles.len()).collect();
        // The nearest last, above the others.
        field::heap_sort(&mut order, |a, b| {
            let [near, far] = [a, b].map(|i| sight.depth(handles[*i].place));
            far.total_cmp(&near).then(a.cmp(b)).is_lt()
        });
        let first = order.len().saturating_sub(MOST_KNOBS);
        for i in order.split_off(first) {
            let handle = &handles[i];
            let Some(at) = sight.screen(handle.place).filter(|at| rect.contains(*at)) else {
                continue;
            };
            let answer = knob::show(ui, painter, rect, i, at, handle, around.touch);
            let at = (i, handle.place);
            let Some(target) = knob::follow(&answer, at, &mut self.drag, sight, wishes) else {
                continue;
            };
            let grain = sight.point(handle.place);
            if let Some(edit) = handles::pull(session.project(), deform, i, target, grain) {
                wishes.push(TextWish::edit(edit));
            }
        }
    }
}

/// Returns the lines of the cage.
fn edges(controls: &[DVec3]) -> Vec<[u32; 2]> {
    let mut edges = BTreeSet::new();
    for [a, b, c] in fit::web(controls) {
        edges.extend([[a, b], [b, c], [a, c]]);
    }
    edges.into_iter().collect()
}
