//! A node that is held: it follows the pointer, and so does its mirrored one.

use crate::stage::handles::Handles;
use crate::wish::{TextWish, Wishes};
use assist::handles::{self, Editable, Handle, Kind};
use document::session::Session;
use egui::Pos2;
use glam::DVec3;
use rats::TextEdit;
use sketch::Drawn;
use sketch::Sight;

/// Returns the handle of a skeleton's node, and that of its radius if it has one of its own.
fn of_node(all: &[Handle], node: usize) -> Option<(&Handle, Option<&Handle>)> {
    let handles = all.iter().enumerate();
    let mut points = handles.filter(|(_, handle)| handle.kind == Kind::Point);
    let (index, point) = points.nth(node)?;
    let radius = all.get(index + 1).filter(|next| next.kind == Kind::Length);
    let radius = radius.filter(|radius| !radius.label.contains("material"));
    Some((point, radius))
}

/// A node that is held.
pub struct Grip {
    drawn: usize,
    node: usize,
    twin: Option<usize>,
    /// Whether it stays on the mirror.
    flat: bool,
    /// The place in the world to which it is dragged.
    target: DVec3,
    at: Pos2,
}

/// Returns the node on the other side of the mirror x = 0.
#[must_use]
pub fn twin(drawn: &Drawn, node: usize) -> Option<usize> {
    let own = drawn.skeleton.nodes[node];
    let there = own.position * DVec3::new(-1.0, 1.0, 1.0);
    if drawn.is_flat(node) {
        return None;
    }
    drawn
        .node_near(there, 0.15 * own.radius)
        .filter(|other| *other != node)
}

impl Grip {
    /// Takes hold of a node.
    #[must_use]
    pub fn new(all: &[Drawn], (index, node): (usize, usize), mirror: bool, at: Pos2) -> Self {
        let drawn = &all[index];
        let place = drawn.skeleton.nodes[node].position;
        Self {
            drawn: index,
            node,
            twin: if mirror { twin(drawn, node) } else { None },
            flat: mirror && drawn.is_flat(node),
            target: drawn.to_world.transform_point3(place),
            at,
        }
    }

    /// Moves the node with the pointer. Returns a reason if it cannot be moved.
    pub fn drag(
        &mut self,
        all: &[Drawn],
        handles: &mut Handles,
        session: &Session,
        sight: &Sight,
        at: Pos2,
        wishes: &mut Wishes,
    ) -> Option<String> {
        let drawn = all.get(self.drawn)?;
        let factor = drawn.knobs.get(self.node)?.1 as f32;
        let by = (at - self.at) * factor;
        if by == egui::Vec2::ZERO {
            return None;
        }
        self.at = at;
        let before = self.target;
        self.target = sight.drag(before, by, false);
        if self.flat {
            // In the mirror, and still under the pointer unless the mirror is seen from its edge.
            let mirror = drawn.to_world.matrix3.inverse().transpose() * DVec3::X;
            let eye = sight.projection.eye;
            let ray = (self.target - eye).normalize_or_zero();
            let slope = ray.dot(mirror.normalize_or_zero());
            if slope.abs() > 0.3 {
                let far = (before - eye).dot(mirror.normalize_or_zero()) / slope;
                self.target = eye + ray * far;
            }
            let mut own = drawn.to_own(self.target);
            own.x = 0.0;
            self.target = drawn.to_world.transform_point3(own);
        }
        let own = drawn.to_own(self.target);
        let other = drawn
            .to_world
            .transform_point3(own * DVec3::new(-1.0, 1.0, 1.0));
        let handles = handles.of(session, sight, drawn.element, true);
        let grain = 0.5 * sight.point(self.target);
        let (point, _) = of_node(handles, self.node)?;
        if let Editable::Fixed { why } = &point.edit {
            return Some(format!("This node stays: it {why}."));
        }
        let mut edits = handles::drag(point, self.target, grain);
        if let Some(twin) = self.twin.and_then(|twin| of_node(handles, twin)) {
            add_apart(&mut edits, handles::drag(twin.0, other, grain));
        }
        write(edits, wishes);
        None
    }
}

/// Makes nodes thicker by a factor. Returns a reason if one cannot be.
pub fn widen(
    drawn: &Drawn,
    nodes: &[usize],
    handles: &mut Handles,
    session: &Session,
    sight: &Sight,
    factor: f64,
    wishes: &mut Wishes,
) -> Option<String> {
    let handles = handles.of(session, sight, drawn.element, true);
    let mut edits = Vec::new();
    for &node in nodes {
        let (point, radius) = of_node(handles, node)?;
        let now = drawn.radius(node);
        // A radius of 0 would stay there for ever.
        let wanted = (now * factor).max(0.5 * sight.point(point.place));
        let grain = 0.01 * wanted;
        match radius {
            Some(radius) => {
                if let Editable::Fixed { why } = &radius.edit {
                    return Some(format!("This radius stays: it {why}."));
                }
                let out = (radius.place - point.place).try_normalize()?;
                let to = point.place + out * wanted;
                add_apart(&mut edits, handles::drag(radius, to, grain));
            }
            None => {
                let growth = drawn.growth.max(f64::MIN_POSITIVE);
                let text = session.text(drawn.file);
                let new = sketch::widen(
                    text,
                    drawn.span.clone(),
                    node,
                    wanted / growth,
                    grain / growth,
                )?;
                // The mirrored one follows next time, when its number stands in the text.
                wishes.push(TextWish::edit(TextEdit::whole(drawn.file, new)));
                return None;
            }
        }
    }
    write(edits, wishes);
    None
}

/// Adds edits that overlap none of those before.
fn add_apart(edits: &mut Vec<TextEdit>, more: Vec<TextEdit>) {
    for edit in more {
        let overlaps = edits.iter().any(|other| {
            other.file == edit.file
                && other.span.start < edit.span.end
                && edit.span.start < other.span.end
        });
        if !overlaps {
            edits.push(edit);
        }
    }
}

/// Makes edits that do not overlap.
fn write(mut edits: Vec<TextEdit>, wishes: &mut Wishes) {
    edits.sort_by_key(|edit| (edit.file, edit.span.start));
    wishes.push(TextWish::Edit { edits, step: false });
}
