//! Drawing: gestures on the picture become curves in the text.

use crate::driver::Window;
use egui::{Event, Key, Modifiers, Pos2, vec2};
use scene::{Form, Shape};
use skeleton::Skeleton;
use studio::places;

/// Opens a page to draw on.
fn page() -> Window {
    let mut window = Window::open(1000.0, 700.0);
    let draw = window.place("draw").center();
    window.click(draw);
    window.steps(3);
    assert_eq!(window.parts.outbox.borrow().report.drawing, Some("draw"));
    assert_eq!(window.errors(), 0);
    assert!(window.text().contains("surface Skin"), "{}", window.text());
    window
}

/// Returns a point of the picture by shares of its sides.
fn at(window: &Window, x: f32, y: f32) -> Pos2 {
    let rect = window.place("picture");
    rect.min + vec2(x * rect.width(), y * rect.height())
}

fn stroke(window: &mut Window, places: &[(f32, f32)]) {
    let points: Vec<Pos2> = places.iter().map(|(x, y)| at(window, *x, *y)).collect();
    window.harness.event(Event::PointerMoved(points[0]));
    window.steps(1);
    window.press(points[0], true);
    window.steps(1);
    for ends in points.windows(2) {
        for step in 1..=8 {
            let at = ends[0] + (ends[1] - ends[0]) * (step as f32 / 8.0);
            window.harness.event(Event::PointerMoved(at));
        }
        window.steps(1);
    }
    window.press(points[points.len() - 1], false);
    window.steps(3);
}

/// Returns the skeletons that a text makes.
fn skeletons(text: &str) -> Vec<Skeleton> {
    let compiled = rats::compile(&rats::Project::single(text));
    // A material that no shape has yet is worth a note.
    let mut diagnostics = compiled.diagnostics.iter();
    assert!(
        diagnostics.all(|diagnostic| diagnostic.severity == rats::Severity::Note),
        "{:?}\n{text}",
        compiled.diagnostics
    );
    let mut skeletons = Vec::new();
    for element in &compiled.scene.elements {
        if let Shape::Function(function) = &element.shape
            && let Form::Skeleton(curves) = &function.form
        {
            skeletons.push(curves.skeleton.clone());
        }
    }
    skeletons
}

fn body() -> Window {
    let mut window = page();
    stroke(&mut window, &[(0.3, 0.5), (0.7, 0.5)]);
    window
}

#[test]
fn strokes_become_a_body_and_limbs_in_pairs() {
    let mut window = body();
    let text = window.text();
    let skeleton = &skeletons(&text)[0];
    assert_eq!(skeleton.curves.len(), 1, "{text}");
    // On the mirror, though the eye looks from the side.
    assert!(
        skeleton.nodes.iter().all(|node| node.position.x == 0.0),
        "{text}"
    );
    let body = skeleton.nodes.len();
    stroke(&mut window, &[(0.45, 0.52), (0.44, 0.7)]);
    let text = window.text();
    let skeleton = &skeletons(&text)[0];
    assert_eq!(skeleton.curves.len(), 3, "{text}");
    let limb = &skeleton.curves[1];
    let other = &skeleton.curves[2];
    assert_eq!(limb[0], other[0]);
    let (a, b) = (limb[limb.len() - 1], other[other.len() - 1]);
    let (a, b) = (skeleton.nodes[a].position, skeleton.nodes[b].position);
    assert_eq!(a * glam::DVec3::new(-1.0, 1.0, 1.0), b);
    assert!(a.x > 0.1, "{a}");
    assert!(skeleton.nodes.len() > body + 1);
    // One step each.
    window.key(Modifiers::COMMAND, Key::Z);
    assert_eq!(skeletons(&window.text())[0].curves.len(), 1);
    window.key(Modifiers::COMMAND, Key::Z);
    assert!(skeletons(&window.text()).is_empty());
    window.key(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    window.key(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert_eq!(window.text(), text);
}

#[test]
fn a_stroke_from_an_end_goes_on_and_one_that_ends_on_flesh_grows_from_there() {
    let mut window = body();
    let count = skeletons(&window.text())[0].nodes.len();
    stroke(&mut window, &[(0.7, 0.5), (0.82, 0.42)]);
    let text = window.text();
    let skeleton = &skeletons(&text)[0];
    assert_eq!(skeleton.curves.len(), 1, "{text}");
    assert!(skeleton.nodes.len() > count);
    assert!(
        skeleton.nodes.iter().all(|node| node.position.x == 0.0),
        "{text}"
    );
    // From the foot to the body, and not in pairs.
    let pairs = window.place("draw mirror").center();
    window.click(pairs);
    stroke(&mut window, &[(0.4, 0.8), (0.41, 0.5)]);
    let text = window.text();
    let skeleton = &skeletons(&text)[0];
    assert_eq!(skeleton.curves.len(), 2, "{text}");
    assert!(
        skeleton.curves[0].contains(&skeleton.curves[1][0]),
        "{text}"
    );
}

/// Returns the height of the ground in a text.
fn ground(text: &str) -> f64 {
    let line = text
        .lines()
        .find(|line| line.starts_with("ground "))
        .unwrap();
    line.rsplit(' ').next().unwrap().parse().unwrap()
}

#[test]
fn legs_grow_beside_an_end_and_the_tail_goes_on_from_it() {
    let mut window = body();
    // Down from the end: legs, which the ground goes down with.
    let lying = ground(&window.text());
    stroke(&mut window, &[(0.305, 0.51), (0.3, 0.72)]);
    let text = window.text();
    let legs = skeletons(&text)[0].clone();
    assert_eq!(legs.curves.len(), 3, "{text}");
    let low = legs
        .nodes
        .iter()
        .map(|n| n.position.y - n.radius)
        .fold(f64::INFINITY, f64::min);
    assert!(
        ground(&text) < lying - 0.3 && (ground(&text) - low).abs() < 0.1,
        "{text}"
    );
    // Their plane is at least the body's radius away.
    let foot = legs.nodes[legs.curves[1][legs.curves[1].len() - 1]];
    assert!(
        foot.position.x.abs() > 0.8 * legs.nodes[legs.curves[0][0]].radius,
        "{text}"
    );
    // Out from the same end: a tail, in the mirror.
    stroke(&mut window, &[(0.3, 0.5), (0.2, 0.45), (0.15, 0.4)]);
    let text = window.text();
    let tail = skeletons(&text)[0].clone();
    assert_eq!(tail.curves.len(), 4, "{text}");
    for node in &tail.nodes[legs.nodes.len()..] {
        assert_eq!(node.position.x, 0.0, "{text}");
    }
    assert!(
        tail.curves
            .iter()
            .filter(|along| along.contains(&tail.curves[3][0]))
            .count()
            >= 3
    );
}

#[test]
fn a_stroke_round_a_corner_leaves_the_flesh_as_it_is() {
    let mut window = body();
    let before = skeletons(&window.text())[0].clone();
    stroke(&mut window, &[(0.7, 0.5), (0.71, 0.25)]);
    let text = window.text();
    let after = skeletons(&text)[0].clone();
    assert_eq!(after.curves.len(), 2, "{text}");
    assert_eq!(after.curves[0], before.curves[0]);
    assert_eq!(after.nodes[..before.nodes.len()], before.nodes);
    assert!(before.curves[0].contains(&after.curves[1][0]), "{text}");
    assert!(
        after.nodes.iter().all(|node| node.position.x == 0.0),
        "{text}"
    );
    // A short stroke along the last one is a head, thicker than its neck.
    let neck = after.nodes[after.nodes.len() - 1];
    stroke(&mut window, &[(0.71, 0.25), (0.713, 0.16)]);
    let head = skeletons(&window.text())[0].clone();
    let tip = head.nodes[head.nodes.len() - 1];
    assert!(tip.radius > 1.3 * neck.radius, "{}", window.text());
}

#[test]
fn the_last_stroke_is_made_a_pair_or_single() {
    let mut window = body();
    stroke(&mut window, &[(0.5, 0.5), (0.5, 0.3)]);
    let pair = window.text();
    assert_eq!(skeletons(&pair)[0].curves.len(), 3, "{pair}");
    let turn = window.place("draw other").center();
    window.click(turn);
    window.steps(3);
    let single = window.text();
    let fin = skeletons(&single)[0].clone();
    assert_eq!(fin.curves.len(), 2, "{single}");
    assert!(
        fin.nodes.iter().all(|node| node.position.x == 0.0),
        "{single}"
    );
    window.click(turn);
    window.steps(3);
    assert_eq!(window.text(), pair);
    window.click(turn);
    window.steps(3);
    assert_eq!(window.text(), single);
    // Still one step.
    window.key(Modifiers::COMMAND, Key::Z);
    window.steps(3);
    assert_eq!(skeletons(&window.text())[0].curves.len(), 1);
    // After another edit the button is gone, and the place belongs to the picture again.
    let text = window.text();
    window.press(turn, true);
    window.steps(1);
    window.press(turn, false);
    window.steps(3);
    assert_eq!(window.text(), text);
}

#[test]
fn nodes_are_moved_widened_and_bent() {
    let mut window = body();
    let before = skeletons(&window.text())[0].clone();
    let tool = window.place("tool move").center();
    window.click(tool);
    window.steps(2);
    let names: Vec<String> = places::all(&window.harness.ctx)
        .keys()
        .filter(|name| name.starts_with("node "))
        .cloned()
        .collect();
    assert_eq!(names.len(), before.nodes.len());
    let node = window.place(&names[0]).center();
    window.drag(node, node + vec2(-30.0, 12.0));
    let text = window.text();
    let now = window.place(&names[0]).center();
    assert!(
        (now - node - vec2(-30.0, 12.0)).length() < 2.5,
        "{now} {node}"
    );
    let moved = skeletons(&text)[0].clone();
    assert_eq!(moved.nodes[0].position.x, 0.0, "{text}");
    assert_ne!(moved.nodes[0].position, before.nodes[0].position);
    window.key(Modifiers::COMMAND, Key::Z);
    assert_eq!(skeletons(&window.text())[0], before);
    // The wheel over a node makes it thicker and does not zoom.
    let node = window.place(&names[0]).center();
    let eye = window.parts.outbox.borrow().camera.eye;
    window.harness.event(Event::PointerMoved(node));
    window.steps(2);
    window.harness.event(Event::MouseWheel {
        unit: egui::MouseWheelUnit::Point,
        delta: vec2(0.0, 120.0),
        phase: egui::TouchPhase::Move,
        modifiers: Modifiers::NONE,
        source: egui::MouseWheelSource::Wheel,
    });
    window.steps(12);
    let wide = skeletons(&window.text())[0].clone();
    assert!(
        wide.nodes[0].radius > 1.2 * before.nodes[0].radius,
        "{}",
        window.text()
    );
    assert_eq!(window.parts.outbox.borrow().camera.eye, eye);
    // A limb that is pulled gets a node.
    let middle = at(&window, 0.5, 0.5);
    window.drag(middle, middle + vec2(0.0, -40.0));
    let bent = skeletons(&window.text())[0].clone();
    assert_eq!(
        bent.nodes.len(),
        before.nodes.len() + 1,
        "{}",
        window.text()
    );
    let new = bent.nodes[bent.nodes.len() - 1].position;
    assert!(new.y > before.nodes[0].position.y + 0.1, "{new}");
    window.key(Modifiers::COMMAND, Key::Z);
    assert_eq!(skeletons(&window.text())[0].nodes.len(), before.nodes.len());
}

#[test]
fn limbs_are_cut_and_removed_in_pairs() {
    let mut window = body();
    stroke(&mut window, &[(0.45, 0.52), (0.44, 0.85)]);
    let whole = skeletons(&window.text())[0].clone();
    assert_eq!(whole.curves.len(), 3);
    let tool = window.place("tool cut").center();
    window.click(tool);
    stroke(&mut window, &[(0.38, 0.7), (0.47, 0.7)]);
    let text = window.text();
    let cut = skeletons(&text)[0].clone();
    assert_eq!(cut.curves.len(), 3, "{text}");
    let low = |skeleton: &Skeleton, curve: usize| {
        let along = &skeleton.curves[curve];
        skeleton.nodes[along[along.len() - 1]].position
    };
    for curve in [1, 2] {
        assert!(low(&cut, curve).y > low(&whole, curve).y + 0.2, "{text}");
    }
    assert!((low(&cut, 1).x + low(&cut, 2).x).abs() < 0.02, "{text}");
    window.key(Modifiers::COMMAND, Key::Z);
    assert_eq!(skeletons(&window.text())[0], whole);
    // A tap on the limb, between two nodes, takes both.
    let limb = at(&window, 0.4415, 0.71);
    window.click(limb);
    let text = window.text();
    assert_eq!(skeletons(&text)[0].curves.len(), 1, "{text}");
    let less = skeletons(&text)[0].clone();
    assert!(less.nodes.len() < whole.nodes.len());
}

#[test]
fn the_right_button_turns_and_a_tap_makes_beads() {
    let mut window = body();
    let text = window.text();
    let eye = window.parts.outbox.borrow().camera.eye;
    let from = at(&window, 0.5, 0.2);
    let press = |window: &Window, pos, pressed| {
        window.harness.event(Event::PointerButton {
            pos,
            button: egui::PointerButton::Secondary,
            pressed,
            modifiers: Modifiers::NONE,
        });
    };
    window.harness.event(Event::PointerMoved(from));
    window.steps(1);
    press(&window, from, true);
    window.steps(1);
    for step in 1..6 {
        window
            .harness
            .event(Event::PointerMoved(from + vec2(10.0 * step as f32, 0.0)));
        window.steps(1);
    }
    press(&window, from + vec2(50.0, 0.0), false);
    window.steps(2);
    assert_ne!(window.parts.outbox.borrow().camera.eye, eye);
    assert_eq!(window.text(), text);
    let flesh = at(&window, 0.5, 0.5);
    window.click(flesh);
    let text = window.text();
    assert!(text.contains("sphere NightBead"), "{text}");
    assert_eq!(window.errors(), 0);
    window.key(Modifiers::NONE, Key::D);
    assert_eq!(window.parts.outbox.borrow().report.drawing, None);
}

#[test]
fn two_fingers_turn_and_give_up_the_stroke() {
    let mut window = body();
    let text = window.text();
    let eye = window.parts.outbox.borrow().camera.eye;
    let touch = |window: &Window, id: u64, phase, pos| {
        window.harness.event(Event::Touch {
            device_id: egui::TouchDeviceId(0),
            id: egui::TouchId(id),
            phase,
            pos,
            force: None,
        });
    };
    let (a, b) = (at(&window, 0.4, 0.5), at(&window, 0.6, 0.6));
    window.harness.event(Event::PointerMoved(a));
    window.press(a, true);
    touch(&window, 1, egui::TouchPhase::Start, a);
    window.steps(1);
    window
        .harness
        .event(Event::PointerMoved(a + vec2(0.0, 20.0)));
    touch(&window, 1, egui::TouchPhase::Move, a + vec2(0.0, 20.0));
    window.steps(1);
    touch(&window, 2, egui::TouchPhase::Start, b);
    window.steps(1);
    for step in 1..6 {
        let by = vec2(8.0 * step as f32, 20.0);
        touch(&window, 1, egui::TouchPhase::Move, a + by);
        touch(&window, 2, egui::TouchPhase::Move, b + by);
        window.steps(1);
    }
    touch(&window, 2, egui::TouchPhase::End, b);
    touch(&window, 1, egui::TouchPhase::End, a);
    window.press(a, false);
    window.harness.event(Event::PointerGone);
    window.steps(3);
    assert_eq!(window.text(), text);
    assert_ne!(window.parts.outbox.borrow().camera.eye, eye);
}

#[test]
fn own_text_and_skeletons_of_loops_are_kept() {
    let mut window = Window::open(1000.0, 700.0);
    window.load(
        "eyep 0 0 10\nsurface a, radius 0.5, diffuse Coral, blobbiness -2\nfor i = 0 to 1 {\n  \
            skeleton a, s { node A <-2 2*i 0> node B <2 2*i 0> curve A B }\n}\n# the end",
    );
    window.edit();
    window.write(" ");
    let text = window.text();
    // The editor has the keys.
    window.key(Modifiers::NONE, Key::D);
    assert_eq!(window.parts.outbox.borrow().report.drawing, None);
    let draw = window.place("draw").center();
    window.click(draw);
    assert_eq!(window.text(), text);
    stroke(&mut window, &[(0.5, 0.5), (0.5, 0.8)]);
    let drawn = window.text();
    assert!(drawn.starts_with(&text), "{drawn}");
    assert_eq!(window.errors(), 0, "{drawn}");
    assert_eq!(skeletons(&drawn).len(), 3);
}
