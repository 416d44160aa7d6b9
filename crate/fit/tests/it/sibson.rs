//! Sibson's coordinates: sums, linear precision, volumes, degenerate configurations.

use fit::{Deformation, MAX_CONTROLS, Sibson};
use glam::DVec3;
use mesh::Aabb;
use trials::{Random, count};

/// Controls of one of several kinds.
fn controls(kind: usize, random: &mut Random) -> Vec<DVec3> {
    let many = 1 + random.below(40);
    let mut made: Vec<DVec3> = match kind {
        // A lattice, cospherical in eights.
        4 => {
            let lattice = (0..27).map(|i| {
                DVec3::new(
                    f64::from(i % 3) - 1.0,
                    f64::from(i / 3 % 3) - 1.0,
                    f64::from(i / 9) - 1.0,
                )
            });
            lattice.map(|p| p * 0.7).collect()
        }
        // A regular octahedron and its middle.
        5 => [DVec3::X, DVec3::Y, DVec3::Z]
            .iter()
            .flat_map(|p| [*p, -*p])
            .chain([DVec3::ZERO])
            .map(|p| p * 0.9)
            .collect(),
        _ => {
            let one = (0..many).map(|_| match kind {
                0 => random.vector(1.0),
                // Cospherical.
                1 => random.direction() * 0.8,
                // Coplanar.
                2 => random.vector(1.0) * DVec3::new(1.0, 1.0, 0.0),
                // Collinear.
                3 => random.vector(1.0) * DVec3::X,
                // Close together, far from all else.
                6 => DVec3::splat(0.3) + random.vector(1.0) * 1e-5,
                // Outside the box, some of them beyond the far corners.
                7 => random.vector(1.0) * 8.0,
                // Nearly coplanar.
                _ => random.vector(1.0) * DVec3::new(1.0, 1.0, 1e-11),
            });
            one.collect()
        }
    };
    let mut apart: Vec<DVec3> = Vec::new();
    for p in made.drain(..) {
        if apart.iter().all(|q| q.distance(p) > 2e-9) {
            apart.push(p);
        }
    }
    apart
}

/// Returns a point in general or in special position.
fn point(kind: usize, controls: &[DVec3], random: &mut Random) -> DVec3 {
    let [a, b, c] = [(); 3].map(|()| controls[random.below(controls.len())]);
    let at = match kind {
        0 | 1 => random.vector(1.0),
        2 => a,
        3 => 0.5 * (a + b),
        4 => (a + b + c) / 3.0,
        // Nearer and nearer to a control.
        5 => a + random.direction() * libm::exp(-30.0 * random.unit()),
        _ => DVec3::ZERO,
    };
    at.clamp(-DVec3::ONE, DVec3::ONE)
}

const BOX: Aabb = Aabb {
    min: DVec3::NEG_ONE,
    max: DVec3::ONE,
};

#[test]
fn weights_sum_to_one_and_give_the_point_back() {
    let mut random = Random::new(1);
    let mut worst: f64 = 0.0;
    for i in 0..count(1000) {
        let controls = controls(i % 9, &mut random);
        let sibson = Sibson::new(&controls, &BOX).expect("controls that are apart");
        for kind in 0..7 {
            let point = point(kind, &controls, &mut random);
            let row = sibson.coordinates(point).expect("a point of the box");
            let sum: f64 = row.iter().map(|(_, weight)| weight).sum();
            let sites = sibson.sites();
            let mean: DVec3 = row.iter().map(|(k, w)| sites[*k as usize] * *w).sum();
            assert!((sum - 1.0).abs() < 1e-12);
            assert!(row.iter().all(|(_, weight)| *weight > 0.0));
            let error = mean.distance(point);
            worst = worst.max(error);
            assert!(error < 1e-9, "configuration {i}, point {kind}: {error:e}");
        }
    }
    println!("worst error of linear precision: {worst:e}");
}

#[test]
fn weights_are_the_stolen_volumes() {
    let mut random = Random::new(2);
    for i in 0..count(18) {
        let controls = controls(i % 6, &mut random);
        let sibson = Sibson::new(&controls, &BOX).expect("controls that are apart");
        let point = point(i % 2, &controls, &mut random) * 0.7;
        let row = sibson.coordinates(point).expect("a point of the box");
        // Samples of the cell: a direction, and a distance up to the cell's wall; each stands for a
        // volume.
        let sites = sibson.sites();
        let mut samples = Vec::new();
        for _ in 0..40_000 {
            let direction = random.direction();
            let wall = sites
                .iter()
                .map(|site| *site - point)
                .filter(|way| way.dot(direction) > 0.0);
            let wall = wall.map(|way| 0.5 * way.length_squared() / way.dot(direction));
            let wall = wall.fold(f64::INFINITY, f64::min);
            let sample = point + direction * wall * libm::cbrt(random.unit());
            let nearest = (0..sites.len())
                .min_by(|a, b| {
                    let [a, b] = [a, b].map(|k| sites[*k].distance_squared(sample));
                    a.total_cmp(&b)
                })
                .expect("there are sites");
            samples.push((nearest, wall.powi(3)));
        }
        let all: f64 = samples.iter().map(|(_, volume)| volume).sum();
        let squares: f64 = samples.iter().map(|(_, volume)| volume * volume).sum();
        for k in 0..sites.len() {
            let weight = row
                .iter()
                .find(|(j, _)| *j as usize == k)
                .map_or(0.0, |(_, w)| *w);
            let own = samples.iter().filter(|(nearest, _)| *nearest == k);
            let part = own.map(|(_, volume)| volume).sum::<f64>() / all;
            let error = (part - weight).abs();
            let spread = (weight * (1.0 - weight) * squares).sqrt() / all;
            assert!(error < 4.5 * spread + 1e-3, "{i}: {weight} {part}");
        }
    }
}

#[test]
fn coordinates_are_continuous_and_local() {
    let mut random = Random::new(3);
    let controls: Vec<DVec3> = (0..400).map(|_| random.vector(1.0)).collect();
    let sibson = Sibson::new(&controls, &BOX).expect("controls that are apart");
    for _ in 0..count(200) {
        let point = random.vector(1.0) * 0.5;
        let [one, other] = [point, point + random.direction() * 1e-7].map(|point| {
            let mut all = vec![0.0; sibson.sites().len()];
            for (k, weight) in sibson.coordinates(point).expect("a point of the box") {
                all[k as usize] = weight;
            }
            all
        });
        let change = one
            .iter()
            .zip(&other)
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f64::max);
        assert!(change < 1e-4, "{change}");
        for (k, weight) in one.iter().enumerate().filter(|(_, w)| **w > 0.0) {
            assert!(controls[k].distance(point) < 0.7, "{k} {weight}");
        }
    }
}

#[test]
fn deformation_reproduces_affine_moves_in_the_hull() {
    fn turn(p: DVec3) -> DVec3 {
        DVec3::new(0.2 * p.y + 0.1, -0.3 * p.x + p.z, p.z * 0.5)
    }
    // Inside a dense cage whose corners are all controls a linear field of moves moves vertices
    // linearly.
    let mut random = Random::new(4);
    let mut controls: Vec<DVec3> = (0..8)
        .map(|i| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)))
        .map(|p| 12.0 * (p - DVec3::splat(0.5)))
        .collect();
    controls.extend((0..200).map(|_| random.vector(1.0) * 2.5));
    let vertices: Vec<DVec3> = (0..200).map(|_| random.vector(1.0) * 0.5).collect();
    let deformation = Deformation::new(&vertices, &controls).expect("controls that are apart");
    let moves: Vec<DVec3> = controls.iter().map(|c| turn(*c)).collect();
    let moved = deformation.apply(&vertices, &moves);
    assert!(
        (0..vertices.len())
            .all(|i| { deformation.weights(i).iter().map(|(_, w)| w).sum::<f64>() > 1.0 - 1e-12 })
    );
    for (vertex, moved) in vertices.iter().zip(moved) {
        assert!(moved.distance(*vertex + turn(*vertex)) < 1e-9);
    }
}

#[test]
fn vertex_on_a_control_moves_with_it() {
    let vertices = [DVec3::ZERO, DVec3::ONE, DVec3::new(0.3, 0.2, 0.9)];
    let controls = [vertices[2], DVec3::new(0.5, 0.4, 0.1)];
    let deformation = Deformation::new(&vertices, &controls).expect("controls that are apart");
    assert_eq!(deformation.weights(2), [(0, 1.0)]);
    let moved = deformation.apply(&vertices, &[DVec3::Y, DVec3::ZERO]);
    assert_eq!(moved[2], vertices[2] + DVec3::Y);
}

#[test]
fn bad_controls_are_told() {
    fn refusal(controls: &[DVec3]) -> String {
        Deformation::new(&[DVec3::ZERO, DVec3::ONE], controls)
            .expect_err("on purpose")
            .to_string()
    }
    assert_eq!(refusal(&[]), "there are no control points");
    assert_eq!(refusal(&[DVec3::NAN]), "control point 1 is no finite point");
    assert_eq!(
        refusal(&[DVec3::X, DVec3::Y, DVec3::X]),
        "control points 1 and 3 are in one place"
    );
    let many: Vec<DVec3> = (0..=MAX_CONTROLS).map(|i| DVec3::X * i as f64).collect();
    assert_eq!(
        refusal(&many),
        "there are 4097 control points, more than the 4096 that are taken"
    );
    let nowhere = Deformation::new(&[DVec3::ZERO, DVec3::NAN], &[DVec3::X]);
    assert!(nowhere.is_err());
    assert!(Deformation::new(&[], &[DVec3::X]).is_err());
    // A single vertex and many controls on a line are no error.
    assert!(Deformation::new(&[DVec3::ONE], &many[..MAX_CONTROLS]).is_ok());
}
