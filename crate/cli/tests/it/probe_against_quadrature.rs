//! `sinew probe` against adaptive quadrature, on random scenes written as text.
//!
//! The program parses the text, builds the scene, normalises and evaluates closed forms; the test
//! integrates the kernel over each skeleton numerically. Both the double-precision reference and
//! the single-precision forms that pictures are made with are held to the same bound.

use crate::common::{Folder, sinew, stdout};
use glam::DVec3;
use oracle::quadrature;
use serde_json::Value;
use std::fmt::Write;
use trials::{Random, count};

/// Relative error allowed between the program and the quadrature.
const BOUND: f64 = 1e-5;
const POINTS: usize = 60;

fn words(p: DVec3) -> String {
    format!("{} {} {}", p.x, p.y, p.z)
}

fn random_dataset(random: &mut Random) -> String {
    let mut text = String::new();
    for material in 0..4 {
        let strength = random.range(0.5, 2.0);
        writeln!(
            text,
            "surface m{material} diffuse White blob -{} radius {} strength {strength}",
            random.range(0.3, 6.0),
            random.range(0.1, 0.8)
        )
        .expect("text");
    }
    for _ in 0..12 {
        let material = random.below(4);
        let radius = random.range(0.05, 0.6);
        match random.below(5) {
            0 => writeln!(
                text,
                "sphere m{material} {radius} {}",
                words(random.vector(2.0))
            ),
            1 => writeln!(
                text,
                "cylinder m{material} {radius} {} {}",
                words(random.vector(2.0)),
                words(random.vector(2.0))
            ),
            2 => {
                let (start, width) = (random.range(0.0, 360.0), random.range(1.0, 360.0));
                writeln!(
                    text,
                    "arc m{material} {} {radius} {} {} {start} {width}",
                    random.range(0.2, 2.0),
                    words(random.vector(2.0)),
                    words(random.vector(1.0))
                )
            }
            3 => writeln!(
                text,
                "triangle m{material} {} {} {}",
                words(random.vector(2.0)),
                words(random.vector(2.0)),
                words(random.vector(2.0))
            ),
            _ => writeln!(
                text,
                "arch m{material} {radius} {{ {}, {}, {} }}",
                words(random.vector(2.0)),
                words(random.vector(2.0)),
                words(random.vector(2.0))
            ),
        }
        .expect("text");
    }
    if random.chance(0.5) {
        writeln!(
            text,
            "plane m0 {} {}",
            words(random.vector(2.0)),
            words(random.vector(1.0))
        )
        .expect("text");
    }
    text
}

#[test]
fn probe_agrees_with_quadrature_on_random_scenes() {
    let folder = Folder::new("quadrature");
    for seed in 0..count(6) as u64 {
        let mut random = Random::new(seed);
        let text = random_dataset(&mut random);
        let file = folder.write(&format!("{seed}.rat"), &text);
        let project = rats::Project {
            files: vec![rats::File {
                name: "random.rat".into(),
                text,
            }],
        };
        let surface = rats::compile(&project).scene.soft_surfaces().swap_remove(0);
        assert!(
            surface.sum.primitives.len() >= 12,
            "seed {seed}: the text is understood"
        );

        let points: Vec<DVec3> = (0..count(POINTS)).map(|_| random.vector(3.0)).collect();
        let input: String = points.iter().map(|&point| words(point) + "\n").collect();
        for precision in ["f64", "f32"] {
            let output = sinew(
                &["probe", &file, "--points", "-", "--precision", precision],
                &input,
            );
            let lines: Vec<Value> = stdout(&output)
                .lines()
                .map(|line| serde_json::from_str(line).expect("JSON"))
                .collect();
            assert_eq!(lines.len(), points.len());
            for (point, line) in points.iter().zip(&lines) {
                let truth: f64 = surface
                    .sum
                    .primitives
                    .iter()
                    .map(|primitive| quadrature::value(primitive, *point))
                    .sum();
                let value = line["field"].as_f64().expect("a number");
                let error = (value - truth).abs() / truth.abs();
                assert!(
                    error <= BOUND,
                    "seed {seed}, {precision}, {point}: {value} against {truth}, error {error:e}"
                );
            }
        }
    }
}

/// Returns a random shape of a kind of skeleton, as the language writes it.
fn shape_of(kind: &str, random: &mut Random) -> String {
    let mut point = || words(random.vector(1.0));
    match kind {
        "sphere" => format!("sphere m 0.4 {}", point()),
        "cylinder" => format!("cylinder m 0.4 {} {}", point(), point()),
        "arc" => format!(
            "arc m 0.9 0.4 {} {} 20 {}",
            point(),
            point(),
            random.range(20.0, 360.0)
        ),
        "triangle" => format!("triangle m {} {} {}", point(), point(), point()),
        "polygon" => {
            // A star with a hole, tilted.
            let center = random.vector(0.3);
            let (x, y) = (DVec3::new(1.0, 0.2, 0.1), DVec3::new(-0.1, 0.9, -0.3));
            let [outer, inner] = [(0.7, 1.2, 7), (0.2, 0.4, 4)].map(|(low, high, corners)| {
                let corners = (0..corners).map(|i| {
                    let angle = std::f64::consts::TAU * f64::from(i) / f64::from(corners);
                    let (sine, cosine) = libm::sincos(angle);
                    let corner = center + (x * cosine + y * sine) * random.range(low, high);
                    words(corner) + ", "
                });
                corners.collect::<String>()
            });
            format!("polygon {{ m {outer} hole {inner} }}")
        }
        "curve" => format!(
            "curve m 0.4 {} {} {} {}",
            point(),
            point(),
            point(),
            point()
        ),
        _ => format!("plane m {} {}", point(), point()),
    }
}

/// Every kernel on every kind of skeleton: double precision to 10⁻⁹, single to 10⁻⁴ (of the field,
/// or of what matters of it).
#[test]
fn probe_agrees_with_quadrature_in_every_cell() {
    let folder = Folder::new("chart");
    let kinds = [
        "sphere", "cylinder", "arc", "triangle", "polygon", "curve", "plane",
    ];
    for kernel in field::Kernel::ALL.map(field::Kernel::name) {
        for (number, kind) in kinds.into_iter().enumerate() {
            let mut random = Random::new(100 + number as u64);
            let text = format!(
                "surface m diffuse White blob -1.5 radius 0.4 kernel {kernel}\n{}\n",
                shape_of(kind, &mut random)
            );
            let file = folder.write(&format!("{kernel}-{kind}.rat"), &text);
            let project = rats::Project {
                files: vec![rats::File {
                    name: "chart.rat".into(),
                    text,
                }],
            };
            let surface = rats::compile(&project).scene.soft_surfaces().swap_remove(0);
            // One, but for a curve, which is cut.
            let primitives = &surface.sum.primitives;
            assert!(!primitives.is_empty() && primitives.iter().all(|p| p.kernel.name() == kernel));
            let points: Vec<DVec3> = (0..count(30)).map(|_| random.vector(1.6)).collect();
            let input: String = points.iter().map(|&point| words(point) + "\n").collect();
            for (precision, bound, least) in [("f64", 1e-9, 1e-3), ("f32", 1e-4, 0.1)] {
                let output = sinew(
                    &["probe", &file, "--points", "-", "--precision", precision],
                    &input,
                );
                for (point, line) in points.iter().zip(stdout(&output).lines()) {
                    let line: Value = serde_json::from_str(line).expect("JSON");
                    let truth = quadrature::sum(&surface.sum, *point);
                    let value = line["field"].as_f64().expect("a number");
                    let error = (value - truth).abs() / truth.abs().max(least);
                    assert!(
                        error <= bound,
                        "{kernel} {kind}, {precision}, {point}: {value} against {truth}, error \
                         {error:e}"
                    );
                }
            }
        }
    }
}
