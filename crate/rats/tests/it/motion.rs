//! `motion`: a pure function of the text and the frame.

use glam::DVec3;
use rats::{Compiled, Project, Severity, compile_at};

fn run(text: &str, moment: f64) -> Compiled {
    compile_at(&Project::single(text), &[], moment)
}

/// The nodes of the skeleton of this number, where they are.
#[track_caller]
fn nodes(compiled: &Compiled, number: usize) -> Vec<DVec3> {
    let skeletons = compiled.scene.elements.iter();
    let mut skeletons = skeletons.filter_map(|e| e.shape.curves());
    let curves = skeletons.nth(number).expect("a skeleton");
    curves.skeleton.nodes.iter().map(|n| n.position).collect()
}

fn errors(compiled: &Compiled) -> Vec<&str> {
    let all = compiled.diagnostics.iter();
    all.filter(|d| d.severity == Severity::Error)
        .map(|d| d.message.as_str())
        .collect()
}

const TAIL: &str = "\
surface s, diffuse Red, radius 0.3
skeleton s, TAIL {
  node ROOT <0 3 0> node A <1 3.2 0> node B <2 3 0> node TIP <3 3 0> radius 0.2
  curve ROOT A B TIP
}
";

#[test]
fn frame_0_is_the_text() {
    let still = run(TAIL, 0.0);
    let moving = run(&format!("{TAIL}motion {{ }}"), 0.0);
    assert_eq!(errors(&moving), Vec::<&str>::new());
    assert_eq!(
        still.scene.elements[0].shape,
        moving.scene.elements[0].shape
    );
    assert!(!still.animated && moving.animated);
}

#[test]
fn frames_follow_the_laws_of_motion() {
    let text = format!("{TAIL}motion TAIL {{ gravity 0 -10 0, damping 0, rate 10, steps 10 }}");
    // −g h² n(n + 1)/2 after n steps of h.
    for frame in [1.0, 4.0] {
        let fell = nodes(&run(&text, frame), 0)[1].y - 3.2;
        let n = frame * 10.0;
        let expected = -10.0 * 1e-4 * n * (n + 1.0) / 2.0;
        assert!((fell - expected).abs() < 1e-9, "{fell} {expected}");
    }
    // Moments between frames are between them.
    let [before, between, behind] = [2.0, 2.25, 3.0].map(|m| nodes(&run(&text, m), 0));
    for i in 0..4 {
        assert!(between[i].distance(before[i].lerp(behind[i], 0.25)) < 1e-12);
    }
}

#[test]
fn a_frame_is_the_same_in_whatever_order_frames_are_asked_for() {
    let text = format!(
        "var t = 0 += 0.3\n{TAIL}translate 0 sin(t) 0, TAIL\n\
         motion TAIL {{ pin ROOT, floor <0 2 0> <0 1 0> }}"
    );
    let forwards: Vec<_> = (0..30)
        .map(|f| nodes(&run(&text, f64::from(f)), 0))
        .collect();
    // Another text in between, and an edit that changes nothing of the motion: from the start
    // again.
    run(&format!("{TAIL}motion TAIL {{ }}"), 5.0);
    let edited = format!("{text}\n# edited");
    for frame in [29, 3, 17, 0, 28] {
        let again = nodes(&run(&edited, f64::from(frame)), 0);
        assert_eq!(again, forwards[frame as usize], "{frame}");
    }
    // In a thread of its own nothing is kept.
    let fresh = std::thread::spawn(move || nodes(&run(&text, 21.0), 0)).join();
    assert_eq!(fresh.expect("no panic"), forwards[21]);
}

#[test]
fn nodes_follow_the_text_where_pinned_and_the_rest_lags_behind() {
    let text =
        format!("var x = 0 += 0.1\n{TAIL}translate x 0 0\nmotion {{ gravity 0 0 0, pin ROOT }}");
    let now = nodes(&run(&text, 20.0), 0);
    // In coordinates of the skeleton's own, which is moved by 2.
    assert!(
        now[0].distance(DVec3::new(0.0, 3.0, 0.0)) < 1e-9,
        "{}",
        now[0]
    );
    assert!(now[3].x < 3.0, "{}", now[3]);
    let still = format!("{TAIL}motion {{ pin ROOT TIP }}");
    let now = nodes(&run(&still, 30.0), 0);
    assert_eq!(now[0], DVec3::new(0.0, 3.0, 0.0));
    assert_eq!(now[3], DVec3::new(3.0, 3.0, 0.0));
    assert!(now[1].y < 3.0);
}

#[test]
fn skeletons_are_moved_in_the_world() {
    // Scaled by 2 and turned over: down in the world is up in its own coordinates.
    let text = format!(
        "{TAIL}scale 2 2 2\nrotate 0 0 1 180\n\
         motion TAIL {{ gravity 0 -10 0, damping 0, rate 10, steps 10, stiffness 0 }}"
    );
    let now = nodes(&run(&text, 2.0), 0);
    let fell = 10.0 * 1e-4 * 20.0 * 21.0 / 2.0;
    assert!((now[0].y - (3.0 + fell / 2.0)).abs() < 1e-9, "{}", now[0]);
}

#[test]
fn a_floor_a_box_and_another_skeleton_stand_in_the_way() {
    let under = |text: &str| {
        let compiled = run(text, 60.0);
        assert_eq!(errors(&compiled), Vec::<&str>::new(), "{text}");
        nodes(&compiled, 0)
            .iter()
            .map(|p| p.y)
            .fold(f64::INFINITY, f64::min)
    };
    assert!(under(&format!("{TAIL}motion {{ }}")) < -5.0);
    assert!(under(&format!("{TAIL}motion {{ floor <0 1 0> <0 3 0> }}")) > 1.1);
    let boxed = format!(
        "{TAIL}surface h, diffuse Red\nobject B\nbox h, <-9 0 -9> <9 1 9>\nclose\n\
         motion TAIL {{ against B }}"
    );
    assert!(under(&boxed) > 1.1);
    let other = format!(
        "{TAIL}skeleton s, BED {{ node A <-3 1 0> node B <6 1 0> curve A B }}\n\
         skeleton s, OTHER {{ node A <1.5 1 -3> node B <1.5 1 3> curve A B }}\n\
         motion TAIL {{ against BED OTHER }}"
    );
    // It lies on the rods, or hangs over them.
    assert!(under(&other) > -2.5);
    let both = format!(
        "{TAIL}skeleton s, BED {{ node C <-3 1 0> node D <6 1 0> curve C D }}\n\
         motion TAIL BED {{ pin C D, bending 0, gravity 0 -3 0 }}"
    );
    assert!(under(&both) > -2.5);
}

#[test]
fn an_open_shutter_sees_the_motion() {
    let text = format!("shutter 0.5\nsample 4\n{TAIL}motion {{ }}");
    let compiled = run(&text, 10.0);
    assert_eq!(compiled.scene.moments.len(), 16);
    let of = |i: usize| {
        compiled.scene.moments[i].elements[0]
            .shape
            .curves()
            .map(|c| c.skeleton.nodes[0].position.y)
    };
    assert!(of(0) > of(8) && of(8) > of(15));
}

#[test]
fn too_much_is_refused_or_stops_with_words() {
    // 201 nodes.
    let many: String = (0..201).map(|i| format!("node n{i} <{i} 0 0> ")).collect();
    let along: String = (0..201).map(|i| format!("n{i} ")).collect();
    let text = format!(
        "surface s, diffuse Red, radius 0.3\nskeleton s, A {{ {many} curve {along} }}\nmotion {{ }}"
    );
    assert_eq!(
        errors(&run(&text, 0.0)),
        ["201 nodes are to move together; 200 is the limit"]
    );
    // A long time.
    let text = format!("{TAIL}motion {{ }}");
    let far = run(&text, 1e9);
    assert!(
        far.diagnostics
            .iter()
            .any(|d| d.message.contains("stops in frame 3000")),
        "{:?}",
        far.diagnostics
    );
    assert_eq!(nodes(&far, 0), nodes(&run(&text, 3000.0), 0));
    // Many nodes and steps: it stops before.
    let nodes: String = (0..150).map(|i| format!("node n{i} <{i} 0 0> ")).collect();
    let along: String = (0..150).map(|i| format!("n{i} ")).collect();
    let text = format!(
        "surface s, diffuse Red, radius 0.3\nskeleton s, A {{ {nodes} curve {along} }}\n\
         motion {{ steps 200 }}"
    );
    let far = run(&text, 2999.0);
    let stopped = far.diagnostics.iter();
    let mut stopped = stopped.filter(|d| d.message.contains("too much work"));
    assert!(stopped.next().is_some(), "{:?}", far.diagnostics);
    // Too many motions.
    let text = TAIL.to_owned() + &"instance TAIL T\nmotion T { }\n".repeat(40);
    assert_eq!(
        errors(&run(&text, 3.0)),
        vec!["there are more than 32 motions"; 8]
    );
}

#[test]
fn extreme_numbers_are_harmless() {
    for options in [
        "gravity 0 -1e12 0",
        "stiffness 1e12",
        "stiffness 0",
        "damping 1e12",
        "friction 1000, bounce 1",
        "rate 0.1, steps 1",
        "floor <0 9 0> <0 1 0>",
    ] {
        let text = format!("{TAIL}motion {{ floor <0 0 0> <0 1 0>, {options} }}");
        let compiled = run(&text, 20.0);
        assert_eq!(errors(&compiled), Vec::<&str>::new(), "{options}");
        assert!(
            nodes(&compiled, 0).iter().all(|p| p.is_finite()),
            "{options}"
        );
    }
    let compiled = run(&format!("{TAIL}motion {{ gravity 0 -1e300 0 }}"), 3.0);
    assert_eq!(
        errors(&compiled),
        ["the acceleration is too large: the limit is 1e12"]
    );
}
