//! Hot variables: sliders, drag pads and colours, moved as a user moves them.

use crate::driver::Window;
use egui::{Event, Key, Modifiers, MouseWheelUnit, pos2, vec2};

const TEXT: &str = "\
framesize 64 48
eyep 0 0 6
surface flesh, diffuse Coral, blobbiness -2
var C = 0.5 0.5 0 hot
sphere flesh 0.5, C
";

fn vector(window: &Window) -> [f64; 3] {
    let text = window.text();
    let rest = text.split("C = ").nth(1).unwrap();
    let mut numbers = rest.split(' ').map(|word| word.parse().unwrap());
    std::array::from_fn(|_| numbers.next().unwrap())
}

#[test]
fn a_drag_on_a_pad_moves_a_vector_and_is_one_undo_step() {
    for size in [[1000.0, 700.0], [390.0, 844.0]] {
        let mut window = Window::open(size[0], size[1]);
        window.load(TEXT);
        // The status of a traced picture moves the layout on a phone.
        window.finish();
        if size[0] < 700.0 {
            let tab = window.place("tab sliders").center();
            window.click(tab);
            window.steps(4);
        }
        let pad = window.place("pad C");
        assert!(pad.width() >= 70.0, "{pad:?}");
        // The square reaches from −1 to 1: twice the largest number.
        let at = |x: f32, y: f32| pos2(pad.left() + x * pad.width(), pad.top() + y * pad.height());
        window.drag(at(0.75, 0.25), at(0.25, 0.75));
        let [x, y, z] = vector(&window);
        assert!((x + 0.5).abs() < 0.03 && (y + 0.5).abs() < 0.03, "{x} {y}");
        assert_eq!((z, window.errors()), (0.0, 0));

        window.finish();
        window.steps(4);
        let rail = window.place("slider C z");
        window.drag(rail.center(), rail.center_top());
        assert!(
            vector(&window)[2] > 0.5,
            "{size:?} {rail:?} {:?} {:?}",
            vector(&window),
            window.parts.outbox.borrow().report.diagnostics
        );
        window.key(Modifiers::COMMAND, Key::Z);
        assert_eq!(vector(&window)[2], 0.0);
        window.key(Modifiers::COMMAND, Key::Z);
        assert_eq!(window.text(), TEXT);
    }
}

#[test]
fn keys_and_wheel_move_the_pad() {
    let mut window = Window::with_text(TEXT);
    let pad = window.place("pad C");
    let dot = pos2(
        pad.left() + 0.75 * pad.width(),
        pad.top() + 0.25 * pad.height(),
    );
    window.click(dot);
    let before = vector(&window);
    window.key(Modifiers::NONE, Key::ArrowRight);
    window.key(Modifiers::NONE, Key::ArrowUp);
    window.key(Modifiers::NONE, Key::PageDown);
    let after = vector(&window);
    assert!(after[0] > before[0] && after[1] > before[1], "{after:?}");
    assert!(after[2] < 0.0, "{after:?}");
    window.harness.event(Event::MouseWheel {
        unit: MouseWheelUnit::Point,
        delta: vec2(0.0, 300.0),
        phase: egui::TouchPhase::Move,
        source: egui::MouseWheelSource::Wheel,
        modifiers: Modifiers::NONE,
    });
    window.steps(20);
    assert!(vector(&window)[2] > after[2] + 0.2, "{:?}", vector(&window));
}

#[test]
fn many_sliders_leave_room_for_the_text() {
    let mut text = String::from(TEXT);
    for index in 0..30 {
        text.push_str(&format!("var C{index} = 1 2 3 hot\n"));
    }
    let window = Window::with_text(&text);
    assert!(window.place("editor").height() > 150.0);
    assert!(window.place("sliders").height() > 80.0);
}

const PRESETS: &str = "\
framesize 64 48
eyep 0 0 6
surface flesh, diffuse Coral, blobbiness -2
var r = 0.5 hot
var C = 0.5 0.5 0 hot
preset small, set C 0 -1 0, set r 0.25
sphere flesh r, C
";

/// A preset's button is one undo step, and the values that are kept come back by another button.
#[test]
fn presets_set_all_their_sliders_at_once() {
    let mut window = Window::with_text(PRESETS);
    let keep = window.place("keep preset").center();
    window.click(keep);
    let kept = "hot\npreset set1, set r 0.5, set C 0.5 0.5 0\npreset small";
    assert!(window.text().contains(kept), "{}", window.text());
    let with_both = window.text();
    let small = window.place("preset small").center();
    window.click(small);
    let text = window.text();
    assert!(
        text.contains("var r = 0.25 hot\nvar C = 0 -1 0 hot\n"),
        "{text}"
    );
    let own = window.place("preset set1").center();
    window.click(own);
    assert_eq!(window.text(), with_both);
    window.key(Modifiers::COMMAND, Key::Z);
    assert_eq!(window.text(), text);
    assert_eq!(window.errors(), 0);
}

#[test]
fn presets_have_buttons_on_a_phone() {
    let mut window = Window::open(390.0, 844.0);
    window.load(PRESETS);
    let tab = window.place("tab sliders").center();
    window.click(tab);
    let small = window.place("preset small").center();
    window.click(small);
    assert!(window.text().contains("var r = 0.25 hot"));
}
