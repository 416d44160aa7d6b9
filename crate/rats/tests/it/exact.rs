//! Materials that are `exact`, and the note on those that would have to be.

use crate::softened::{read, scene, value};
use field::{Kernel, THRESHOLD};
use glam::DVec3;
use rats::Severity;
use scene::Scene;

/// Asserts that a surface goes through places.
fn assert_through(text: &str, places: &[DVec3]) {
    let scene = scene(text);
    for &place in places {
        let value = value(&scene, place);
        assert!((value - THRESHOLD).abs() < 1e-6, "{text}\n{place}: {value}");
    }
}

#[test]
fn middle_and_tips_of_a_bone_stand_at_the_radius() {
    for kernel in Kernel::ALL {
        for (half, blobbiness) in [(1.0, 0.1), (1.0, 0.5), (1.0, 4.0), (0.25, 0.5), (9.0, 2.0)] {
            let text = format!(
                "surface S radius 0.5 blobbiness -{blobbiness} kernel {} exact\n\
                 cylinder S 0.5 <{} 0 0> <{half} 0 0>\n",
                kernel.name(),
                -half
            );
            let tip = DVec3::X * (half + 0.5);
            assert_through(&text, &[DVec3::Y * 0.5, DVec3::Z * 0.5, tip, -tip]);
        }
    }
}

/// Bones in pieces are what they are whole, so that joints do not bulge.
#[test]
fn a_chain_counts_as_one_bone() {
    let material = "surface S radius 0.5 blobbiness -1 exact\n";
    let whole = scene(&format!("{material}cylinder S 0.5 <-1 0 0> <1 0 0>\n"));
    let pieces = scene(&format!(
        "{material}for i = 0 to 7 {{ cylinder S 0.5 <i/4-1 0 0> <(i+1)/4-1 0 0> }}\n"
    ));
    for i in 0..40 {
        let (sine, cosine) = libm::sincos(f64::from(i));
        let place = DVec3::new(f64::from(i) / 13.0 - 1.5, 0.6 * sine, 0.6 * cosine);
        let [a, b] = [&whole, &pieces].map(|scene| value(scene, place));
        assert!((a - b).abs() < 1e-6, "{place}: {a} {b}");
    }
}

#[test]
fn arcs_rings_forks_and_triangles_stand_at_their_radius() {
    let material = "surface S radius 0.3 blobbiness -0.5 exact\n";
    let high = DVec3::Z * 0.3;
    let half = format!("{material}arc S 1 0.3 <0 0 0> <0 0 1> 0 180\n");
    let tips = [DVec3::new(1.0, -0.3, 0.0), DVec3::new(-1.0, -0.3, 0.0)];
    assert_through(&half, &[DVec3::Y + high, tips[0], tips[1]]);
    let ring = format!("{material}torus S 1 0.3 <0 0 0> <0 0 1>\n");
    assert_through(&ring, &[DVec3::X + high, DVec3::Y - high]);
    let fork = format!(
        "{material}cylinder S 0.3 <0 0 0> <2 0 0>\ncylinder S 0.3 <2 0 0> <3 1 0>\n\
         cylinder S 0.3 <2 0 0> <3 -1 0>\n"
    );
    let arm = DVec3::new(1.0, 1.0, 0.0).normalize() * 0.3;
    let tips = [DVec3::X * -0.3, DVec3::new(3.0, 1.0, 0.0) + arm];
    assert_through(&fork, &[DVec3::X + high, tips[0], tips[1]]);
    let face = format!("{material}triangle S <-1 -1 0> <1 -1 0> <0 2 0>\n");
    assert_through(&face, &[high, -high]);
}

/// A figure magnified with its radii is the same figure.
#[test]
fn exact_flesh_moves_and_grows_with_its_object() {
    let bone = "surface S radius 0.5 blobbiness -0.5 exact\n\
        object A\ncylinder S 0.5 <-1 0 0> <1 0 0>\nclose\n";
    let text = format!("{bone}scale 2 2 2\nrotate 0 0 1 90\ntranslate 5 0 0\n");
    let middle = DVec3::new(5.0, 0.0, 0.0);
    let tip = DVec3::Y * 3.0;
    assert_through(
        &text,
        &[
            middle + DVec3::X,
            middle + DVec3::Z,
            middle + tip,
            middle - tip,
        ],
    );
}

/// The default stays: without the word nothing changes, and a note says what comes out.
#[test]
fn a_note_names_the_radius_that_comes_out() {
    let bone = "cylinder S 0.5 <-1 0 0> <1 0 0>\n";
    let told = read(&format!(
        "surface S radius 0.5 blobbiness -1 kernel inverse\n{bone}"
    ));
    let [note] = &told.diagnostics[..] else {
        panic!("{:?}", told.diagnostics);
    };
    assert_eq!(note.severity, Severity::Note);
    let message = "the surface stands 0.100 from the middle of this bone, not 0.500: it is short \
        for its blobbiness";
    assert_eq!(note.message, message);
    // The field is the threshold there.
    let value = value(&told.scene, DVec3::Y * 0.1);
    assert!((value - THRESHOLD).abs() < 0.01, "{value}");
    for text in [
        // Not off by a tenth.
        format!("surface S radius 0.5 blobbiness -4\n{bone}"),
        // Meant to be stronger.
        format!("surface S radius 0.5 blobbiness -0.5 strength 2\n{bone}"),
        // Exact.
        format!("surface S radius 0.5 blobbiness -0.5 exact\n{bone}"),
        // Made by a loop.
        format!(
            "surface S radius 0.5 blobbiness -0.5\nfor i = 1 to 1 {{ {} }}\n",
            bone.trim()
        ),
        // Not by itself.
        format!(
            "surface S radius 0.5 blobbiness -0.5\n{bone}cylinder S 0.5 <0 -3 0.2> <0 3 0.2>\n"
        ),
    ] {
        assert_eq!(read(&text).diagnostics, [], "{text}");
    }
}

#[test]
fn what_cannot_be_exact_stays_as_it_is_and_says_so() {
    let material = "surface S radius 0.5 blobbiness -0.5 exact\n";
    for (shape, count) in [
        ("sphere S 0.5 <0 0 0>", 0),
        ("sphere S 0.5 <0 0 0>\nscale 1 2 1", 0),
        ("curve S 0.5 <0 0 0> <1 1 0> <2 -1 0> <3 0 0>", 1),
        ("cone S 0.5 <0 0 0> 0.2 <3 0 0>", 1),
    ] {
        let told = read(&format!("{material}{shape}\n"));
        assert_eq!(told.diagnostics.len(), count, "{:?}", told.diagnostics);
        let plain = read(&format!("{}{shape}\n", material.replace(" exact", "")));
        let [own, other] = [&told, &plain].map(|read| {
            let element = &read.scene.elements[0];
            (element.shape.clone(), read.scene.flesh[0].clone())
        });
        assert_eq!(own, other);
    }
}

/// Very many exact bones are left as they are, soon.
#[test]
fn exact_flesh_has_a_limit() {
    let text = "surface S radius 0.1 blobbiness -0.5 exact\n\
        for i = 0 to 4000 { cylinder S 0.1 <i 0 0> <i+0.5 rand 0> }\n";
    let told = read(text);
    let said = told
        .diagnostics
        .iter()
        .any(|told| told.message.contains("takes too long"));
    assert!(said, "{:?}", told.diagnostics.first());
    assert_eq!(told.scene.elements.len(), 4001);
}

/// Bones that were settled for one picture are settled for all.
#[test]
fn exact_flesh_is_the_same_in_all_pictures() {
    let mut text = String::from("surface S radius 0.1 blobbiness -0.5 exact\n");
    for i in 0..5 {
        text += &format!("cylinder S 0.1 <{i} 0 0> <{i}.5 0.{i} 0>\n");
    }
    text += &"shoot\n".repeat(60);
    let told = read(&text);
    let said = told.diagnostics.iter().map(|told| &told.message[..]);
    assert!(
        said.clone().all(|said| !said.contains("too long")),
        "{said:?}"
    );
    let last = strengths(&told.scene);
    assert!(last.iter().all(|strength| *strength != 1.0_f64.to_bits()));
    for picture in &told.earlier {
        assert_eq!(strengths(&picture.scene), last);
    }
}

/// Returns the bits of the strengths of all flesh of a scene.
fn strengths(scene: &Scene) -> Vec<u64> {
    let own = scene.elements.iter().filter_map(|element| element.flesh);
    own.map(|flesh| scene.flesh[flesh as usize].strength.to_bits())
        .collect()
}

/// Bones that are too dear leave others as they should be, and are told of once.
#[test]
fn dear_bones_keep_no_others_from_being_exact() {
    let text = "surface S radius 0.1 blobbiness -0.5 exact\nsurface T radius 0.5 blobbiness -1\n\
        for i = 0 to 4000 { cylinder S 0.1 <i 50 0> <i+0.5 50+rand 0> }\n\
        triad T <-2 -2 0> <2 -2 0> <0 4 0>\n";
    let told = read(text);
    let said = told
        .diagnostics
        .iter()
        .filter(|told| told.message.contains("takes too long"));
    assert_eq!(said.count(), 1);
    let triad = told
        .scene
        .elements
        .last()
        .and_then(|element| element.flesh)
        .unwrap();
    assert!(told.scene.flesh[triad as usize].strength > 1.0);
}

/// A note says why a surface is not where its radius says.
#[test]
fn a_note_knows_thin_flesh_from_thick() {
    let torus = read("surface S radius 0.5 blobbiness -0.3\ntorus S 1 0.5 <0 0 0> <0 0 1>\n");
    let [note] = &torus.diagnostics[..] else {
        panic!("{:?}", torus.diagnostics);
    };
    assert!(
        note.message.contains("more of its limb is near"),
        "{}",
        note.message
    );
}

/// A triad is seen without a strength of its own.
#[test]
fn a_triad_stands_at_its_radius_by_itself() {
    let triad = "triad S <-2 -2 0> <2 -2 0> <0 4 0>\n";
    let text = format!("surface S radius 0.5 blobbiness -1\n{triad}");
    assert_through(&text, &[DVec3::Z * 0.5, DVec3::Z * -0.5]);
    let strong = read(&format!(
        "surface S radius 0.5 blobbiness -1 strength 1\n{triad}"
    ));
    assert_eq!(strong.scene.flesh[0].strength, 1.0);
    assert!(value(&strong.scene, DVec3::Z * 0.01) < THRESHOLD);
}
