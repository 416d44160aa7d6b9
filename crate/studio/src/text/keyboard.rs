//! Keeps input in order when much of it comes in one frame.
//!
//! A slow frame may bring a click, arrow keys, F2, "a" and Enter at once, and each of them is meant
//! for the state after the one before. Widgets see a frame's events all together, though, and some
//! keys (Enter, Tab, undo …) are handled by us before egui's text field sees the rest. So
//! - such a key comes first in its frame, and keys after it wait for the next frame;
//! - so do keys after a click or a key that may move the focus, and they wait a frame more, in
//!   which a field that has opened takes the focus;
//! - keys wait while the focus is new: a widget says only then which arrow keys it keeps. Those
//!   that come before go from widget to widget, and take the focus along.
//!
//! Everything that comes after a waiting key waits with it.
//!
//! Tab goes on from a widget that Escape has left, as a text in which Tab indents. Without that it
//! would begin at the top again, and never come past the text.

use egui::{Context, Event, Id, Key, Modifiers, RawInput};

/// Events that wait for the next frame. A plugin, as egui moves the focus by arrow keys and Tab
/// before any widget is shown.
#[derive(Default)]
pub struct Keyboard {
    waiting: Vec<Event>,
    /// The widget that had the focus when the last frame began.
    focused: Option<Id>,
    /// Whether the last frame had an event that may move the focus.
    moved: bool,
    /// Whether the last frame had an Escape.
    escaped: bool,
    /// The widget that Escape has left, as long as no other one has the focus.
    left: Option<Id>,
}

impl egui::Plugin for Keyboard {
    fn debug_name(&self) -> &'static str {
        "keyboard"
    }

    fn input_hook(&mut self, ctx: &Context, input: &mut RawInput) {
        let mut events = std::mem::take(&mut self.waiting);
        events.append(&mut input.events);
        let focused = ctx.memory(|memory| memory.focused());
        let is_new = focused.is_some() && focused != self.focused;
        self.left = match focused {
            Some(_) => None,
            None if self.escaped => self.focused.or(self.left),
            None => self.left,
        };
        self.focused = focused;
        let focus = match focused {
            _ if is_new || self.moved => Focus::Moves,
            Some(_) => Focus::Stays,
            None => Focus::Nowhere,
        };
        self.waiting = events.split_off(count(&events, focus));
        self.moved = events.iter().any(moves_focus);
        self.escaped = presses(&events, Key::Escape);
        if events.iter().any(is_click) {
            self.left = None;
        }
        let from = presses(&events, Key::Tab).then(|| self.left.take());
        let from = from.flatten();
        if let Some(left) = from {
            ctx.memory_mut(|memory| memory.request_focus(left));
        }
        ctx.data_mut(|data| data.insert_temp(passing(), from.is_some()));
        input.events = events;
        if !self.waiting.is_empty() {
            ctx.request_repaint();
        }
    }
}

/// The receiver of keys.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Focus {
    /// A widget that may have had the focus too shortly.
    Moves,
    /// A widget.
    Stays,
    /// The app itself: each key is a command.
    Nowhere,
}

/// Returns the number of events that this frame gets.
fn count(events: &[Event], focus: Focus) -> usize {
    let mut closed = focus == Focus::Moves;
    let mut written = false;
    for (i, event) in events.iter().enumerate() {
        if writes(event) && (closed || written && is_ours(event)) {
            return i;
        }
        written |= writes(event);
        let wishes = focus == Focus::Nowhere && matches!(event, Event::Key { pressed: true, .. });
        closed |= is_ours(event) || moves_focus(event) || wishes;
    }
    events.len()
}

fn passing() -> Id {
    Id::unique("focus passes")
}

/// Whether a Tab of this frame goes on from a widget that Escape has left, which has the focus for
/// as long as that takes and is not meant by it.
pub fn passes(ctx: &Context) -> bool {
    ctx.data(|data| data.get_temp(passing()).unwrap_or(false))
}

/// Whether a key goes down.
fn presses(events: &[Event], wanted: Key) -> bool {
    events
        .iter()
        .any(|event| matches!(event, Event::Key { key, pressed: true, .. } if *key == wanted))
}

fn is_click(event: &Event) -> bool {
    matches!(event, Event::PointerButton { .. })
}

/// Whether a widget may take the focus because of an event, now or in the next frame.
fn moves_focus(event: &Event) -> bool {
    match event {
        event if is_click(event) => true,
        Event::Key {
            key, pressed: true, ..
        } => matches!(
            key,
            Key::Enter | Key::Tab | Key::Escape | Key::F1 | Key::F2 | Key::F12
        ),
        _ => false,
    }
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

/// Whether an event is a key that we handle before the text field does.
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

    fn press(key: Key, modifiers: Modifiers) -> Event {
        Event::Key {
            key,
            physical_key: None,
            pressed: true,
            repeat: false,
            modifiers,
        }
    }

    fn key(key: Key) -> Event {
        press(key, Modifiers::NONE)
    }

    fn click(pressed: bool) -> Event {
        Event::PointerButton {
            pos: egui::Pos2::ZERO,
            button: egui::PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        }
    }

    #[test]
    fn our_keys_come_first_in_a_frame_and_one_at_a_time() {
        let events = [
            text("a"),
            key(Key::A),
            undo(),
            Event::PointerGone,
            text("b"),
            undo(),
        ];
        assert_eq!(count(&events, Focus::Stays), 2);
        assert_eq!(count(&events[2..], Focus::Stays), 2);
        assert_eq!(count(&events[4..], Focus::Stays), 1);
        assert_eq!(count(&events[5..], Focus::Stays), 1);
    }

    fn undo() -> Event {
        press(Key::Z, Modifiers::COMMAND)
    }

    #[test]
    fn keys_after_a_click_wait_for_the_widget_that_was_clicked() {
        let events = [
            text("a"),
            click(true),
            click(false),
            key(Key::ArrowUp),
            text("b"),
        ];
        assert_eq!(count(&events, Focus::Stays), 3);
        assert_eq!(count(&events[3..], Focus::Moves), 0);
        assert_eq!(count(&events[3..], Focus::Stays), 2);
    }

    #[test]
    fn what_comes_after_a_key_that_waits_waits_too() {
        let up = Event::Key {
            key: Key::Enter,
            physical_key: None,
            pressed: false,
            repeat: false,
            modifiers: Modifiers::NONE,
        };
        let events = [text("a"), key(Key::Enter), up, click(true)];
        assert_eq!(count(&events, Focus::Stays), 1);
        assert_eq!(count(&events[1..], Focus::Stays), 3);
    }

    #[test]
    fn without_a_focus_each_key_is_a_command() {
        let events = [text("g"), key(Key::G), text("x"), key(Key::X)];
        assert_eq!(count(&events, Focus::Stays), 4);
        assert_eq!(count(&events, Focus::Nowhere), 2);
    }
}
