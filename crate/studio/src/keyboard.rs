//! Keeps keys in order when many come in one frame.
//!
//! Some keys (Enter, Tab, undo …) are handled by us before egui's text field sees the rest. When a
//! slow frame brings "a", Enter, "b" at once, Enter must come after "a" and before "b". So a frame
//! gets at most one such key, and only at its beginning; what follows waits for the next frame.

use egui::{Context, Event, Key, Modifiers};

/// Events that wait for the next frame.
#[derive(Default)]
pub struct Keyboard {
    waiting: Vec<Event>,
}

impl Keyboard {
    /// Sorts the events of this frame. Call it before any widget is shown.
    pub fn order(&mut self, ctx: &Context) {
        ctx.input_mut(|input| {
            if self.waiting.is_empty() && !input.events.iter().any(is_ours) {
                return;
            }
            let mut events = std::mem::take(&mut self.waiting);
            events.append(&mut input.events);
            let (now, later) = split(events);
            input.events = now;
            self.waiting = later;
        });
        if !self.waiting.is_empty() {
            ctx.request_repaint();
        }
    }
}

/// What this frame may see, and what must wait.
fn split(events: Vec<Event>) -> (Vec<Event>, Vec<Event>) {
    let (mut now, mut later) = (Vec::new(), Vec::new());
    let mut written = false;
    for event in events {
        if !writes(&event) {
            now.push(event);
        } else if !later.is_empty() || (written && is_ours(&event)) {
            later.push(event);
        } else {
            written = true;
            now.push(event);
        }
    }
    (now, later)
}

/// Whether an event can change a text or move its cursor.
fn writes(event: &Event) -> bool {
    matches!(
        event,
        Event::Text(_)
            | Event::Paste(_)
            | Event::Cut
            | Event::Copy
            | Event::Ime(_)
            | Event::Key { pressed: true, .. }
    )
}

/// Whether it is a key that we handle before the text field does.
fn is_ours(event: &Event) -> bool {
    if is_brace(event) {
        return true;
    }
    let Event::Key {
        key,
        pressed: true,
        modifiers,
        ..
    } = event
    else {
        return false;
    };
    match key {
        Key::Enter | Key::Tab | Key::Escape => true,
        // What they are about stands where the arrow keys before them went.
        Key::F1 | Key::F2 | Key::F8 | Key::F12 => true,
        Key::Z | Key::Y | Key::S | Key::F | Key::Slash | Key::Space => {
            modifiers.contains(Modifiers::COMMAND) || modifiers.command || modifiers.ctrl
        }
        _ => false,
    }
}

/// Whether a closing brace is typed, which the editor indents.
#[must_use]
pub fn is_brace(event: &Event) -> bool {
    matches!(event, Event::Text(text) if text == "}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(text: &str) -> Event {
        Event::Text(text.to_owned())
    }

    fn key(key: Key) -> Event {
        Event::Key {
            key,
            physical_key: None,
            pressed: true,
            repeat: false,
            modifiers: Modifiers::NONE,
        }
    }

    #[test]
    fn our_keys_come_first_in_a_frame_and_one_at_a_time() {
        let pointer = Event::PointerGone;
        let events = vec![
            text("a"),
            key(Key::A),
            key(Key::Enter),
            pointer.clone(),
            text("b"),
            key(Key::Enter),
        ];
        let (now, later) = split(events);
        assert_eq!(now, [text("a"), key(Key::A), pointer]);
        let (now, later) = split(later);
        assert_eq!(now, [key(Key::Enter), text("b")]);
        assert_eq!(split(later), (vec![key(Key::Enter)], vec![]));
    }
}
