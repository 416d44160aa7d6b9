//! `sinew probe` of bodies in contact, against the formulas written out here.

use crate::common::{Folder, sinew, stdout};
use serde_json::Value;

/// A Cauchy ball's field: `((1+|B|)/(1+|B|r²/R²))²`.
fn ball(center: [f64; 3], radius: f64, point: [f64; 3]) -> f64 {
    let square: f64 = (0..3).map(|i| (point[i] - center[i]).powi(2)).sum();
    let field = 2.5 / (1.0 + 1.5 * square / (radius * radius));
    field * field
}

/// g of the largest of the others' fields, for `height 0.2 0.65 0.25`.
fn deformation(f: f64) -> f64 {
    if f >= 1.0 {
        1.0 - f
    } else if f >= 0.65 {
        let x = (f - 0.65) / 0.35;
        0.25 + ((0.35 - 0.75) + (0.5 - 0.35) * x) * x * x
    } else if f >= 0.2 {
        let x = (f - 0.2) / 0.45;
        0.25 * x * x * (3.0 - 2.0 * x)
    } else {
        0.0
    }
}

#[test]
fn contact_is_what_the_formulas_say() {
    let folder = Folder::new("contact");
    let balls = [
        ("A", [-0.8, 0.0, 0.1], 1.0),
        ("B", [0.8, -0.1, 0.0], 1.1),
        ("C", [0.1, 1.3, 0.0], 0.8),
    ];
    let mut text = String::from("surface m diffuse White blob -1.5 kernel cauchy\n");
    for (name, [x, y, z], radius) in balls {
        text += &format!("body {name}\n  sphere m {radius} <{x} {y} {z}>\nclose\n");
    }
    for pair in ["A B", "A C", "B C"] {
        text += &format!("contact {pair} height 0.2 0.65 0.25\n");
    }
    let file = folder.write("balls.rat", &text);
    let mut random = trials::Random::new(3);
    let points: Vec<[f64; 3]> = (0..300)
        .map(|_| {
            let [x, y, z] = random.vector(2.0).to_array();
            [x, y + 0.4, 0.5 * z]
        })
        .collect();
    let input: String = points
        .iter()
        .map(|[x, y, z]| format!("{x} {y} {z}\n"))
        .collect();
    let output = sinew(&["probe", &file, "--points", "-"], &input);
    let mut pressed = [0; 3];
    for (point, line) in points.iter().zip(stdout(&output).lines()) {
        let line: Value = serde_json::from_str(line).expect("JSON");
        let bodies = line["bodies"].as_array().expect("a list");
        for (i, (name, center, radius)) in balls.into_iter().enumerate() {
            let body = bodies.iter().find(|b| b["name"] == name).expect("the body");
            let others = (0..3).filter(|k| *k != i);
            let most = others.map(|k| ball(balls[k].1, balls[k].2, *point));
            let most = most.fold(0.0, f64::max);
            let want = ball(center, radius, *point) + deformation(most);
            let value = body["field"].as_f64().expect("a number");
            assert!(
                (value - want).abs() <= 1e-9 * want.abs().max(1.0),
                "{value} {want}"
            );
            pressed[i] += u32::from(deformation(most) != 0.0);
        }
    }
    assert!(pressed.iter().all(|n| *n > 50), "{pressed:?}");
}
