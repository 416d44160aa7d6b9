//! Sibson's coordinates: sums, linear precision, volumes, degenerate configurations.

use fit::{Deformation, MAX_CONTROLS, Sibson};
use glam::DVec3;
use mesh::Aabb;

struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn below(&mut self, count: usize) -> usize {
        (self.next() * count as f64) as usize
    }

    fn point(&mut self) -> DVec3 {
        DVec3::from_array(core::array::from_fn(|_| 2.0 * self.next() - 1.0))
    }

    fn direction(&mut self) -> DVec3 {
        loop {
            let p = self.point();
            if p.length_squared() <= 1.0 && p.length_squared() > 1e-9 {
                return p.normalize();
            }
        }
    }
}

/// Controls of one of several kinds.
fn controls(kind: usize, numbers: &mut Numbers) -> Vec<DVec3> {
    let count = 1 + numbers.below(40);
    let mut some = |mut make: Box<dyn FnMut(&mut Numbers) -> DVec3>| -> Vec<DVec3> {
        (0..count).map(|_| make(numbers)).collect()
    };
    let mut made = match kind {
        0 => some(Box::new(Numbers::point)),
        // Cospherical.
        1 => some(Box::new(|n| n.direction() * 0.8)),
        // Coplanar.
        2 => some(Box::new(|n| n.point() * DVec3::new(1.0, 1.0, 0.0))),
        // Collinear.
        3 => some(Box::new(|n| n.point() * DVec3::X)),
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
        // Close together, far from all else.
        6 => some(Box::new(|n| DVec3::splat(0.3) + n.point() * 1e-5)),
        // Outside the box, some of them beyond the far corners.
        7 => some(Box::new(|n| n.point() * 8.0)),
        // Nearly coplanar.
        _ => some(Box::new(|n| n.point() * DVec3::new(1.0, 1.0, 1e-11))),
    };
    let mut apart: Vec<DVec3> = Vec::new();
    for p in made.drain(..) {
        if apart.iter().all(|q| q.distance(p) > 2e-9) {
            apart.push(p);
        }
    }
    apart
}

/// A point in general or in special position.
fn point(kind: usize, controls: &[DVec3], numbers: &mut Numbers) -> DVec3 {
    let mut some = || controls[numbers.below(controls.len())];
    let (a, b, c) = (some(), some(), some());
    let at = match kind {
        0 | 1 => numbers.point(),
        2 => a,
        3 => 0.5 * (a + b),
        4 => (a + b + c) / 3.0,
        // Nearer and nearer to a control.
        5 => a + numbers.direction() * libm::exp(-30.0 * numbers.next()),
        _ => DVec3::ZERO,
    };
    at.clamp(-DVec3::ONE, DVec3::ONE)
}

const BOX: Aabb = Aabb {
    min: DVec3::NEG_ONE,
    max: DVec3::ONE,
};

/// Random configurations: 1,000, or as many as SINEW_SIBSON says.
#[test]
fn weights_sum_to_one_and_give_the_point_back() {
    let asked = std::env::var("SINEW_SIBSON").ok();
    let count = asked.and_then(|n| n.parse().ok()).unwrap_or(1000);
    let mut numbers = Numbers(1);
    let mut worst: f64 = 0.0;
    for i in 0..count {
        let controls = controls(i % 9, &mut numbers);
        let sibson = Sibson::new(&controls, &BOX).expect("controls that are apart");
        for kind in 0..7 {
            let point = point(kind, &controls, &mut numbers);
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
    let mut numbers = Numbers(2);
    for i in 0..18 {
        let controls = controls(i % 6, &mut numbers);
        let sibson = Sibson::new(&controls, &BOX).expect("controls that are apart");
        let point = point(i % 2, &controls, &mut numbers) * 0.7;
        let row = sibson.coordinates(point).expect("a point of the box");
        // Samples of the cell: a direction, and a distance up to the cell's wall; each stands for a volume.
        let sites = sibson.sites();
        let mut samples = Vec::new();
        for _ in 0..40_000 {
            let direction = numbers.direction();
            let wall = sites
                .iter()
                .map(|site| *site - point)
                .filter(|way| way.dot(direction) > 0.0);
            let wall = wall.map(|way| 0.5 * way.length_squared() / way.dot(direction));
            let wall = wall.fold(f64::INFINITY, f64::min);
            let sample = point + direction * wall * libm::cbrt(numbers.next());
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
    let mut numbers = Numbers(3);
    let controls: Vec<DVec3> = (0..400).map(|_| numbers.point()).collect();
    let sibson = Sibson::new(&controls, &BOX).expect("controls that are apart");
    let dense = |point: DVec3| {
        let mut all = vec![0.0; sibson.sites().len()];
        for (k, weight) in sibson.coordinates(point).expect("a point of the box") {
            all[k as usize] = weight;
        }
        all
    };
    for _ in 0..200 {
        let point = numbers.point() * 0.5;
        let one = dense(point);
        let other = dense(point + numbers.direction() * 1e-7);
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
    // Inside a dense cage whose corners are all controls a linear field of moves moves vertices linearly.
    let mut numbers = Numbers(4);
    let mut controls: Vec<DVec3> = (0..8)
        .map(|i| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)))
        .map(|p| 12.0 * (p - DVec3::splat(0.5)))
        .collect();
    controls.extend((0..200).map(|_| numbers.point() * 2.5));
    let vertices: Vec<DVec3> = (0..200).map(|_| numbers.point() * 0.5).collect();
    let deformation = Deformation::new(&vertices, &controls).expect("controls that are apart");
    let turn = |p: DVec3| DVec3::new(0.2 * p.y + 0.1, -0.3 * p.x + p.z, p.z * 0.5);
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
    let vertices = [DVec3::ZERO, DVec3::ONE];
    let told = |controls: &[DVec3]| {
        Deformation::new(&vertices, controls)
            .expect_err("on purpose")
            .to_string()
    };
    assert_eq!(told(&[]), "there are no control points");
    assert_eq!(told(&[DVec3::NAN]), "control point 1 is no finite point");
    assert_eq!(
        told(&[DVec3::X, DVec3::Y, DVec3::X]),
        "control points 1 and 3 are in one place"
    );
    let many: Vec<DVec3> = (0..=MAX_CONTROLS).map(|i| DVec3::X * i as f64).collect();
    assert_eq!(
        told(&many),
        "there are 4097 control points, more than the 4096 that are taken"
    );
    let nowhere = Deformation::new(&[DVec3::ZERO, DVec3::NAN], &[DVec3::X]);
    assert!(nowhere.is_err());
    assert!(Deformation::new(&[], &[DVec3::X]).is_err());
    // A single vertex and many controls on a line are no error.
    assert!(Deformation::new(&[DVec3::ONE], &many[..MAX_CONTROLS]).is_ok());
}
