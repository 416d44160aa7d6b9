//! Skeletons as the language asks for them, and those that are built limb by limb.

use glam::DVec3;
use limbs::{Builder, Cap, Recipe};

const BENT: &str = "1 3 0 0 0 1 -1\n2 3 5 0.01 0 1 1\n3 3 10 0 0 1 2\n";

#[test]
fn recipe_does_what_the_operations_do() {
    let recipe = Recipe {
        simplify: Some(0.1),
        ..Recipe::default()
    };
    assert_eq!(
        recipe.make("n.swc", BENT.as_bytes()).unwrap().limbs.len(),
        1
    );
    let twice = "0 0 0\n";
    let error = Recipe::default()
        .make("n.xyz", twice.as_bytes())
        .unwrap_err();
    assert!(error.to_string().contains("no limbs"), "{error}");
}

#[test]
fn radii_that_no_file_gives_are_known_as_such() {
    let lines = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nl 1 2 3\n";
    let mut graph = Recipe::default().make("n.obj", lines).unwrap();
    assert!(graph.nodes.iter().all(|node| node.is_guessed));
    graph.give_radius(0.25);
    let radii = graph.limbs.iter().flat_map(|limb| limb.radii);
    assert!(radii.into_iter().all(|radius| radius == 0.25));
    let mut graph = Recipe::default().make("n.swc", BENT.as_bytes()).unwrap();
    graph.give_radius(0.25);
    assert_eq!(graph.limbs[0].radii, [1.0; 2], "the file's own");
}

#[test]
fn free_ends_go_on_along_their_limbs() {
    let mut builder = Builder::default();
    let [a, b, c] = [0.0, 4.0, 8.0].map(|x| DVec3::X * x);
    builder.limb([a, b], [1.0, 2.0], "x").unwrap();
    builder.limb([b, c], [2.0, 2.0], "x").unwrap();
    let mut graph = builder.finish().unwrap();
    assert_eq!(graph.nodes.len(), 3, "the limbs share a node");
    graph.lengthen_free_ends(|cap| if cap == Cap::Round { 0.4 } else { 9.0 });
    // 0.4 radii outward, with the taper going on.
    assert!(graph.nodes[0].position.distance(DVec3::X * -0.4) < 1e-12);
    assert!((graph.limbs[0].radii[0] - 0.9).abs() < 1e-12);
    assert_eq!(graph.nodes[1].position, b);
    assert!(graph.nodes[2].position.distance(DVec3::X * 8.8) < 1e-12);
    // Back by a quarter of the limb at most.
    graph.lengthen_free_ends(|_| -100.0);
    assert!((graph.nodes[2].position.x - (8.8 - 0.25 * 4.8)).abs() < 1e-12);
}

#[test]
fn names_are_cut() {
    let mut builder = Builder::default();
    let name = "ä".repeat(1_000_000);
    builder.ball(DVec3::ZERO, 1.0, &name).unwrap();
    let graph = builder.finish().unwrap();
    assert_eq!(
        graph.groups[0].name,
        "ä".repeat(limbs::limits::MAX_NAME / 2)
    );
}

#[test]
fn builder_refuses_what_is_no_limb() {
    let mut builder = Builder::default();
    assert!(builder.limb([DVec3::NAN, DVec3::X], [1.0; 2], "x").is_err());
    assert!(Builder::default().finish().is_err(), "nothing");
}

#[test]
fn caps_are_chosen_at_free_ends() {
    let mut builder = Builder::default();
    let [a, b, c] = [0.0, 4.0, 8.0].map(|x| DVec3::X * x);
    builder.limb([a, b], [1.0, 1.0], "x").unwrap();
    builder.limb([b, c], [1.0, 1.0], "x").unwrap();
    builder.ball(c, 2.0, "x").unwrap();
    let mut graph = builder.finish().unwrap();
    assert_eq!(graph.choose_caps(false), 0);
    assert_eq!(
        graph.choose_caps(true),
        1,
        "neither at a ball nor where a limb goes on"
    );
    assert_eq!(graph.limbs[0].caps, [Cap::Flat, Cap::Round]);
    assert_eq!(graph.choose_caps(false), 1, "that of the graph");
}
