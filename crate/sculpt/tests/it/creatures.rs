//! The creatures of the gallery, made by strokes: as many vertices and faces as those of Bill and
//! Lodha (1995), within a fifth.

use sculpt::{Clay, Script, Stroke, replay};

/// Name, text, printed vertices and faces.
const CREATURES: [(&str, &str, [usize; 2]); 4] = [
    (
        "dog",
        include_str!("../../../../www/examples/dog.strokes"),
        [2523, 4746],
    ),
    (
        "fish",
        include_str!("../../../../www/examples/fish.strokes"),
        [525, 966],
    ),
    (
        "slug",
        include_str!("../../../../www/examples/slug.strokes"),
        [1036, 1966],
    ),
    (
        "triceratops",
        include_str!("../../../../www/examples/triceratops.strokes"),
        [1700, 3181],
    ),
];

/// Carries out a text. Returns the clay and the number of stages.
fn make(text: &str) -> (Clay, usize) {
    let script: Script = text.parse().expect("a text of strokes");
    let stages = script
        .strokes
        .iter()
        .filter(|stroke| matches!(stroke, Stroke::Stage(_)))
        .count();
    let load = &mut |name: &str| Err(format!("there is no {name}"));
    let clay =
        replay(&script, load, 20_000_000, |_, _, _| ()).expect("strokes that can be carried out");
    (clay, stages)
}

#[test]
fn creatures_have_the_printed_size() {
    for (name, text, printed) in CREATURES {
        let (clay, stages) = make(text);
        let mesh = clay.mesh();
        mesh.validate().expect(name);
        assert!(mesh.is_closed() && mesh.shells().len() == 1, "{name}");
        for (own, printed) in [mesh.vertex_count(), mesh.face_count()]
            .into_iter()
            .zip(printed)
        {
            let ratio = own as f64 / printed as f64;
            assert!((0.8..=1.2).contains(&ratio), "{name}: {own} of {printed}");
        }
        assert!(stages >= 3, "{name}");
    }
    assert_eq!(make(CREATURES[0].1).1, 6, "a dog in six stages");
}

#[test]
fn the_smoothed_dog_has_four_times_the_faces() {
    let (mut clay, _) = make(CREATURES[0].1);
    let faces = clay.mesh().face_count();
    clay.smooth_loop(1).expect("room enough");
    // Figure 5 has 19,850 faces.
    assert_eq!(clay.mesh().face_count(), 4 * faces);
    assert!(
        (0.8..1.2).contains(&(4.0 * faces as f64 / 19_850.0)),
        "{faces}"
    );
}
