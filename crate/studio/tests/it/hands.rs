//! Editing by hand: a click on the picture finds the place in the text, and a drag changes its
//! numbers.

use crate::driver::Window;
use assist::handles::Editable;
use document::examples;
use egui::{Key, Modifiers, Pos2, Rect, TextEdit, vec2};
use egui_kittest::kittest::Queryable;
use sketch::Sight;
use std::time::Instant;
use studio::places;
use tracer::Picker;

/// A text with a ball on the left, and three on the right from a loop.
const TEXT: &str = "\
framesize 64 48
eyep 0 0 10
surface flesh, diffuse Coral, blobbiness -4
surface clay, diffuse White
sphere flesh 0.5, <-2 0 0> # left
for i = 0 to 2 {
  sphere clay 0.4, <2 i - 1 0>
}
";

/// Returns the line of the cursor, from 1.
fn line(window: &Window) -> usize {
    let state = TextEdit::load_state(&window.harness.ctx, egui::Id::unique("editor"));
    let range = state.and_then(|state| state.cursor.char_range()).unwrap();
    let text: String = window.text().chars().take(range.primary.index.0).collect();
    text.matches('\n').count() + 1
}

/// Projects a place of the model's plane z = 0 to the screen.
fn project(window: &Window, x: f32, y: f32) -> Pos2 {
    let rect = window.place("picture");
    // The eye is 10 away, and half of the width is seen at an angle of 45°/2.
    let unit = 0.5 * rect.width() / (10.0 * libm::tanf(22.5_f32.to_radians()));
    rect.center() + vec2(x, -y) * unit
}

fn knobs(window: &Window) -> Vec<String> {
    let places = places::all(&window.harness.ctx);
    let hands = places.keys().filter(|name| name.starts_with("hand "));
    hands.cloned().collect()
}

#[test]
fn a_click_finds_the_line_and_a_click_beside_lets_go() {
    let mut window = Window::with_text(TEXT);
    assert!(knobs(&window).is_empty());
    let ball = project(&window, -2.0, 0.1);
    window.click(ball);
    assert_eq!(line(&window), 5);
    assert_eq!(knobs(&window), ["hand the centre", "hand the radius"]);
    // A shape of a loop cannot be moved alone, and its knob says why; all can be made wider.
    let ball = project(&window, 2.0, 1.0);
    window.click(ball);
    assert_eq!(line(&window), 7);
    let shared = "hand the radius; of all that are made here";
    assert_eq!(knobs(&window), ["hand the centre", shared]);
    window.harness.get_by_label("the centre: is made in a loop");
    let nothing = project(&window, 0.0, 2.0);
    window.click(nothing);
    assert!(knobs(&window).is_empty());
    assert_eq!(window.text(), TEXT);
}

#[test]
fn a_drag_changes_the_numbers_and_is_one_undo_step() {
    let mut window = Window::with_text(TEXT);
    let ball = project(&window, -2.0, 0.1);
    window.click(ball);
    let from = window.place("hand the centre").center();
    assert!((from - project(&window, -2.0, 0.0)).length() < 1.0);
    let to = project(&window, -1.0, 0.5);
    window.drag(from, to);
    let text = window.text();
    let written = text.split(['<', '>']).nth(1).unwrap();
    let numbers: Vec<f32> = written.split(' ').map(|n| n.parse().unwrap()).collect();
    assert!((numbers[0] + 1.0).abs() < 0.03, "{written}");
    assert!((numbers[1] - 0.5).abs() < 0.03, "{written}");
    assert_eq!(numbers[2], 0.0);
    // Nothing else changed, and the numbers are short.
    assert_eq!(text.replace(written, "-2 0 0"), TEXT);
    assert!(written.len() < 14, "{written}");
    let now = window.place("hand the centre").center();
    assert!((now - to).length() < 2.0, "{now} {to}");
    window.key(Modifiers::COMMAND, Key::Z);
    assert_eq!(window.text(), TEXT);
    window.key(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert_eq!(window.text(), text);
}

#[test]
fn the_radius_follows_its_knob() {
    let mut window = Window::with_text(TEXT);
    let ball = project(&window, -2.0, 0.1);
    window.click(ball);
    let from = window.place("hand the radius").center();
    window.drag(
        from,
        from + (project(&window, 0.25, 0.0) - project(&window, 0.0, 0.0)),
    );
    let text = window.text();
    let radius: f32 = text
        .split("sphere flesh ")
        .nth(1)
        .and_then(|rest| rest.split(',').next())
        .unwrap()
        .parse()
        .unwrap();
    assert!((radius - 0.75).abs() < 0.02, "{radius}");
}

#[test]
fn the_caret_chooses_and_escape_lets_go() {
    let mut window = Window::with_text(TEXT);
    window.edit();
    assert!(knobs(&window).is_empty());
    // Lines may take several rows.
    let go = |window: &mut Window, key, to| {
        while line(window) != to {
            window.key(Modifiers::NONE, key);
        }
    };
    go(&mut window, Key::ArrowDown, 5);
    assert_eq!(knobs(&window).len(), 2);
    go(&mut window, Key::ArrowDown, 6);
    assert!(knobs(&window).is_empty());
    go(&mut window, Key::ArrowUp, 5);
    assert_eq!(knobs(&window).len(), 2);
    // The first one closes the editor's line about the command.
    window.key(Modifiers::NONE, Key::Escape);
    window.key(Modifiers::NONE, Key::Escape);
    assert!(knobs(&window).is_empty());
}

#[test]
fn arrow_keys_nudge_a_knob() {
    let mut window = Window::with_text(TEXT);
    let ball = project(&window, -2.0, 0.1);
    window.click(ball);
    let knob = window.harness.get_by_label("the centre");
    knob.focus();
    window.steps(2);
    window.key(Modifiers::NONE, Key::ArrowRight);
    let text = window.text();
    let x = text.split(['<', ' ']).find_map(|word| {
        let x: f64 = word.parse().ok()?;
        (x < -1.0 && x > -2.0).then_some(x)
    });
    assert!(x.is_some(), "{text}");
    assert!(text.contains(" 0 0> # left"), "{text}");
    // Away from the eye.
    window.key(Modifiers::NONE, Key::PageUp);
    let text = window.text();
    assert!(!text.contains(" 0 0> # left"), "{text}");
}

#[test]
fn while_the_text_has_errors_nothing_can_be_held() {
    let mut window = Window::with_text(TEXT);
    let ball = project(&window, -2.0, 0.1);
    window.click(ball);
    assert_eq!(knobs(&window).len(), 2);
    window.edit();
    window.write("nonsense\n");
    assert!(knobs(&window).is_empty());
    let ball = project(&window, -2.0, 0.1);
    window.click(ball);
    assert!(knobs(&window).is_empty());
}

#[test]
fn a_phone_has_knobs_for_fingers() {
    let mut window = Window::open(390.0, 844.0);
    window.load(TEXT);
    let ball = project(&window, -2.0, 0.1);
    window.click(ball);
    let knob = window.place("hand the centre");
    assert!(knob.width() >= 40.0 && knob.height() >= 40.0);
    let to = project(&window, -1.0, -0.5);
    window.drag(knob.center(), to);
    assert!(!window.text().contains("<-2 0 0>"));
}

#[test]
fn every_example_has_shapes_to_pick_with_handles() {
    // Examples with images and meshes show nothing without them.
    let all = examples::ALL.iter().filter(|e| e.files.is_empty());
    let www = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../www");
    for example in all {
        let text = std::fs::read_to_string(www.join(example.path)).unwrap();
        let project = example.project(&text);
        let compiled = rats::compile(&project);
        let scene = &compiled.scene;
        let begin = Instant::now();
        let picker = Picker::new(scene);
        let preparation = begin.elapsed();
        let [width, height] = scene.settings.frame.map(|side| side as f32);
        let rect = Rect::from_min_size(Pos2::ZERO, vec2(width, height));
        let sight = Sight::new(&scene.camera, rect);
        let eye = sight.projection.eye;
        let mut elements = Vec::new();
        let begin = Instant::now();
        for i in 0..9 {
            for j in 0..9 {
                let at = rect.lerp_inside(vec2(i as f32 + 0.5, j as f32 + 0.5) / 9.0);
                let hit = picker.pick(eye, sight.direction(at));
                elements.extend(hit.and_then(|hit| hit.element));
            }
        }
        let click = begin.elapsed() / 81;
        assert!(!elements.is_empty(), "{}", example.title);
        let mut movable = 0;
        let begin = Instant::now();
        for element in elements.iter().take(6).map(|&element| element as usize) {
            let view = &sight.projection.world_from_view;
            let handles = assist::handles::handles(&project, &[], 0, &compiled, element, view);
            assert!(!handles.is_empty(), "{}", example.title);
            movable += handles
                .iter()
                .filter(|handle| matches!(handle.edit, Editable::Literal { .. }))
                .count();
        }
        let handles = begin.elapsed() / elements.len().min(6) as u32;
        println!(
            "{}: ready in {preparation:?}, a click {click:?}, its handles {handles:?}, \
                {movable} to move",
            example.title
        );
        assert!(click.as_secs_f64() < 1.0 && preparation.as_secs_f64() < 5.0);
    }
}
