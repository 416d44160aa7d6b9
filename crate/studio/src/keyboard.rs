//! Keeps keys in order when many come in one frame.
//!
//! Some keys (Enter, Tab, undo …) are handled by us before egui's text field sees the rest. When a
//! slow frame brings "a", Enter, "b" at once, Enter must come after "a" and before "b". So a frame
//! gets at most one such key, and only at its beginning; what follows waits for the next frame. So do keys
//! that come after a click: the widget that was clicked has them only from the next frame on, and until
//! then arrow keys and Tab would go from widget to widget.

use egui::{Context, Event, Key, Modifiers, RawInput};

/// Events that wait for the next frame. A plugin, as egui moves the focus by arrow keys and Tab before
/// any widget is shown.
#[derive(Default)]
pub struct Keyboard {
    waiting: Vec<Event>,
}

impl egui::Plugin for Keyboard {
    fn debug_name(&self) -> &'static str {
        "keyboard"
    }

    fn input_hook(&mut self, ctx: &Context, input: &mut RawInput) {
        let mut events = std::mem::take(&mut self.waiting);
        events.append(&mut input.events);
        (input.events, self.waiting) = split(events);
        if !self.waiting.is_empty() {
            ctx.request_repaint();
        }
    }
}

/// Splits the events into those for this frame and those that must wait.
fn split(events: Vec<Event>) -> (Vec<Event>, Vec<Event>) {
    let (mut now, mut later) = (Vec::new(), Vec::new());
    let (mut written, mut clicked) = (false, false);
    for event in events {
        let writes = writes(&event);
        let click = is_click(&event);
        // A key must not go up before it goes down.
        let in_order = writes || click || matches!(event, Event::Key { .. });
        if in_order && !later.is_empty() || writes && (clicked || written && is_ours(&event)) {
            later.push(event);
        } else {
            written |= writes;
            clicked |= click;
            now.push(event);
        }
    }
    (now, later)
}

/// Whether a button of the pointer goes down or up.
fn is_click(event: &Event) -> bool {
    matches!(event, Event::PointerButton { .. })
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
        // They act where the arrow keys before them have moved the caret.
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

    #[test]
    fn keys_after_a_click_wait_for_the_widget_that_was_clicked() {
        let click = |pressed| Event::PointerButton {
            pos: egui::Pos2::ZERO,
            button: egui::PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        };
        let events = vec![
            text("a"),
            click(true),
            click(false),
            key(Key::ArrowUp),
            text("b"),
        ];
        let (now, later) = split(events);
        assert_eq!(now, [text("a"), click(true), click(false)]);
        let again = [later, vec![click(true), text("c")]].concat();
        let (now, later) = split(again);
        assert_eq!(now, [key(Key::ArrowUp), text("b"), click(true)]);
        assert_eq!(later, [text("c")]);
    }

    #[test]
    fn a_key_goes_up_after_it_went_down() {
        let up = Event::Key {
            key: Key::Enter,
            physical_key: None,
            pressed: false,
            repeat: false,
            modifiers: Modifiers::NONE,
        };
        let (now, later) = split(vec![text("a"), key(Key::Enter), up.clone()]);
        assert_eq!(now, [text("a")]);
        assert_eq!(later, [key(Key::Enter), up]);
    }
}
