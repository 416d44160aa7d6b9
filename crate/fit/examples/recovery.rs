//! Recovers a head from points and outlines whose true shape is known, seen in three ways.
//!
//! `cargo run --release -p fit --example recovery`

use fit::{Disturbance, Kind, Observations, Options, Outline, Problem, trial};
use glam::DVec3;
use mesh::{Aabb, Bvh, Ray, closest_point};
use std::time::Instant;

const NOISE: f64 = 0.01;

/// A mesh to measure distances from.
struct Surface {
    facets: Vec<[DVec3; 3]>,
    bvh: Bvh,
}

impl Surface {
    fn new(positions: &[DVec3], triangles: &[[u32; 3]]) -> Self {
        let corners = |t: &[u32; 3]| t.map(|i| positions[i as usize]);
        let facets: Vec<_> = triangles.iter().map(corners).collect();
        let boxes: Vec<_> = facets.iter().map(|f| Aabb::of_points(*f)).collect();
        Self {
            facets,
            bvh: Bvh::new(&boxes),
        }
    }

    fn distance(&self, p: DVec3) -> f64 {
        let square = |i: u32| closest_point(&self.facets[i as usize], p).distance_squared(p);
        let found = self.bvh.nearest(p, f64::INFINITY, square);
        found.map_or(f64::INFINITY, |(_, square)| square.sqrt())
    }

    fn is_met(&self, origin: DVec3, direction: DVec3) -> bool {
        let mut met = false;
        let ray = Ray::new(origin, direction);
        self.bvh.along_ray(&ray, f64::INFINITY, |i, far| {
            let [a, b, c] = self.facets[i as usize].map(|p| p - origin);
            let sides = [(a, b), (b, c), (c, a)].map(|(p, q)| p.cross(q).dot(direction));
            met |= sides.iter().all(|s| *s >= 0.0) || sides.iter().all(|s| *s <= 0.0);
            if met { -1.0 } else { far }
        });
        met
    }
}

fn outlines(truth: &Surface) -> Vec<Outline> {
    (0..6)
        .map(|i| {
            let angle = core::f64::consts::PI / 6.0 * f64::from(i);
            let mut outline = Outline {
                eye: [9.0 * libm::sin(angle), -9.0 * libm::cos(angle), 0.4],
                target: [0.0, 0.0, -0.1],
                up: [0.0, 0.0, 1.0],
                fov: 32.0,
                size: [640.0, 640.0],
                lines: Vec::new(),
            };
            outline.trace(16.0, &mut |eye, way| truth.is_met(eye, way));
            outline
        })
        .collect()
}

fn main() {
    let argument = |i: usize| std::env::args().nth(i).and_then(|a| a.parse::<f64>().ok());
    let facets = argument(1).unwrap_or(2000.0) as usize;
    let k_edge = argument(2).unwrap_or(20.0);
    let smooth = argument(3).unwrap_or(0.02);
    let head = trial::head(facets);
    let cage = trial::cage();
    let deformation = fit::Deformation::new(&head.positions, &cage.positions).expect("a cage");
    let moves = trial::moves(&cage.positions, 0.16, 11);
    let truth = deformation.apply(&head.positions, &moves);
    let surface = Surface::new(&truth, &head.triangles);
    let points = trial::sample(&truth, &head.triangles, 6667, 3);
    let disturbance = Disturbance {
        noise: NOISE,
        outliers: 0.1,
        gap: 0.25,
        seed: 8,
    };
    let cloud = disturbance.apply(&points);
    let outlines = outlines(&surface);
    let sights = fit::sights(&outlines);
    println!(
        "{} facets, {} controls, {} points, {} lines of sight, noise {NOISE}",
        head.triangles.len(),
        cage.positions.len(),
        cloud.len(),
        sights.len(),
    );
    // The gap's border, along its direction.
    let toward = disturbance.toward();
    let mut along: Vec<f64> = points.iter().map(|p| p.dot(toward)).collect();
    along.sort_by(f64::total_cmp);
    let border = along[along.len() * 3 / 4];
    let probes = trial::sample(&truth, &head.triangles, 4000, 77);
    let error = |positions: &[DVec3]| {
        let fitted = Surface::new(positions, &head.triangles);
        let mut sums = [(0.0, 0.0); 2];
        for p in &probes {
            let (sum, count) = &mut sums[usize::from(p.dot(toward) > border)];
            *sum += fitted.distance(*p).powi(2);
            *count += 1.0;
        }
        sums.map(|(sum, count): (f64, f64)| (sum / count).sqrt() / NOISE)
    };
    let [near, gap] = error(&head.positions);
    println!("at the start: {near:.2} σ, in the gap {gap:.2} σ");
    let edge = fit::mean_edge(&head.positions, &head.triangles);
    println!("| kind | error, σ | in the gap, σ | points' residual, σ | iterations | seconds |");
    println!("|---|---|---|---|---|---|");
    let thickness = argument(4).unwrap_or(0.0);
    let kinds = [
        ("explicit", Kind::Explicit),
        ("spherical", Kind::Spherical),
        ("triangular", Kind::Triangular { thickness }),
    ];
    for with_outlines in [true, false] {
        println!(
            "{}",
            if with_outlines {
                "points and outlines"
            } else {
                "points only"
            }
        );
        for (name, kind) in kinds {
            let observations = Observations {
                points: cloud.clone(),
                sights: if with_outlines {
                    sights.clone()
                } else {
                    Vec::new()
                },
            };
            let options = Options {
                kind,
                smooth,
                slope: Some(k_edge / edge),
                ..Options::default()
            };
            let problem = Problem::new(&head, &cage, observations, options).expect("a problem");
            let start = Instant::now();
            let mut tell = |_: &fit::Progress| true;
            let fitted = fit::fit(&problem, &mut tell).expect("a fit");
            let seconds = start.elapsed().as_secs_f64();
            let [near, gap] = error(&fitted.positions);
            println!(
                "| {name} | {near:.2} | {gap:.2} | {:.2} | {} | {seconds:.2} |",
                fitted.last.residual / NOISE,
                fitted.last.iteration,
            );
        }
    }
}
