//! Speed and triangles against `LevelSet` of manifold-rust at equal measured error: lines of JSON for `cargo xtask bench meshes`.
//!
//! `cargo run --release -p mesher --example peers -- tests/bench/seahorse.rat tests/bench/coral.rat tests/bench/flake-820.rat`
//!
//! `LevelSet` has the same field, evaluated by the terms that matter in each cell of a grid, which is the quickest that there is for
//! single points. Its edge length is halved between two bounds until its measured error is that of our mesh.

use field::{Ball, Implicit, Part, Slack, THRESHOLD};
use glam::DVec3;
use manifold_rust::linalg::Vec3;
use manifold_rust::manifold::Manifold;
use manifold_rust::sdf::level_set;
use manifold_rust::types::Box as Bounds;
use mesh::{Aabb, Bvh, TriangleMesh, closest_point};
use mesher::{Options, Progress, box_of, extent, polygonize};
use std::ops::ControlFlow;
use std::path::Path;
use std::time::Instant;

/// Cells of the grid along the longest side.
const GRID: f64 = 24.0;
/// The bound on terms that are left out in a cell; polynomials stand for none.
const SLACK: Slack = Slack {
    left_out: 1e-7,
    far: 0.0,
};
const SAMPLES: usize = 4000;
const SHARE: f64 = 1e-3;

fn main() -> Result<(), String> {
    for path in std::env::args().skip(1) {
        let line = measure(Path::new(&path))?;
        println!("{line}");
    }
    Ok(())
}

fn measure(path: &Path) -> Result<String, String> {
    let scene = load(path)?;
    let surfaces = scene.surfaces();
    let surface = surfaces.first().ok_or("nothing is soft")?;
    let function = surface.function();
    let domain = box_of(function.support().ok_or("it is infinite")?);
    let mut report = |_| ControlFlow::Continue(());
    let mut progress = Progress::new(&mut report);
    let told = |error: mesher::MeshError| error.to_string();
    let hull = extent(function, &domain, 1, &mut progress).map_err(told)?;
    let hull = hull.ok_or("there is no surface")?;
    let start = Instant::now();
    let options = Options::new(SHARE * hull.size().length());
    let own = polygonize(function, &domain, &options, &mut progress).map_err(told)?;
    let seconds = start.elapsed().as_secs_f64();
    let error = two_way(function, &own.mesh);

    let start = Instant::now();
    let grid = Grid::new(function, &hull);
    let prepared = start.elapsed().as_secs_f64();
    let bounds = Bounds::from_points(vector(hull.min), vector(hull.max));
    let peer = |edge: f64| {
        let start = Instant::now();
        let value = |p: Vec3| grid.value(DVec3::new(p.x, p.y, p.z)) - THRESHOLD;
        // Vertices as near to the surface as ours.
        let made = Manifold::from_impl(level_set(value, bounds, edge, 0.0, 0.05 * error));
        let seconds = prepared + start.elapsed().as_secs_f64();
        let gl = made.get_mesh_gl64(-1);
        let positions = gl.vert_properties.chunks_exact(gl.num_prop as usize);
        let triangles = gl.tri_verts.chunks_exact(3);
        let mesh = TriangleMesh::new(
            positions.map(|v| DVec3::new(v[0], v[1], v[2])).collect(),
            triangles
                .map(|t| [t[0], t[1], t[2]].map(|i| i as u32))
                .collect(),
        );
        (mesh, seconds)
    };
    let mut edge = 0.1 * hull.size().max_element();
    let (mut mesh, mut peer_seconds) = peer(edge);
    let mut peer_error = two_way(function, &mesh);
    // The error falls with the square of the edge.
    for _ in 0..8 {
        if peer_error <= 1.1 * error || mesh.triangles.len() > 20_000_000 {
            break;
        }
        edge *= (error / peer_error).sqrt().clamp(0.4, 0.95);
        (mesh, peer_seconds) = peer(edge);
        peer_error = two_way(function, &mesh);
    }
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    Ok(serde_json::json!({
        "scene": name,
        "seconds": seconds,
        "triangles": own.mesh.triangles.len(),
        "proved": own.error,
        "error": error,
        "evaluations": own.evaluations,
        "peer_seconds": peer_seconds,
        "peer_triangles": mesh.triangles.len(),
        "peer_error": peer_error,
        "peer_edge": edge,
    })
    .to_string())
}

fn vector(p: DVec3) -> Vec3 {
    Vec3::new(p.x, p.y, p.z)
}

fn load(path: &Path) -> Result<scene::Scene, String> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let name = path
        .file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned();
    let text =
        |path: &Path| std::fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()));
    let mut files = vec![rats::File {
        name,
        text: text(path)?,
    }];
    for other in rats::reads(&files[0].text) {
        // What is not beside it is in the library.
        if let Ok(text) = text(&folder.join(&other)) {
            files.push(rats::File { name: other, text });
        }
    }
    Ok(rats::compile_at(&rats::Project { files }, &[], 0.0).scene)
}

/// A grid of the terms that matter in each of its cells.
struct Grid<'a> {
    function: &'a dyn Implicit,
    low: DVec3,
    size: f64,
    counts: [usize; 3],
    parts: Vec<Option<Part>>,
}

impl<'a> Grid<'a> {
    fn new(function: &'a dyn Implicit, bounds: &Aabb) -> Self {
        let size = bounds.size().max_element() / GRID;
        let counts = (bounds.size() / size)
            .ceil()
            .to_array()
            .map(|n| n as usize + 1);
        let mut parts = Vec::new();
        for z in 0..counts[2] {
            for y in 0..counts[1] {
                for x in 0..counts[0] {
                    let at = DVec3::new(x as f64, y as f64, z as f64) + 0.5;
                    let ball = Ball {
                        center: bounds.min + at * size,
                        radius: 0.87 * size,
                    };
                    parts.push(function.narrow(ball, None, SLACK));
                }
            }
        }
        Self {
            function,
            low: bounds.min,
            size,
            counts,
            parts,
        }
    }

    fn value(&self, point: DVec3) -> f64 {
        let at = ((point - self.low) / self.size).floor().to_array();
        let inside = (0..3).all(|i| at[i] >= 0.0 && at[i] < self.counts[i] as f64);
        let index = || {
            let [x, y, z] = at.map(|x| x as usize);
            (z * self.counts[1] + y) * self.counts[0] + x
        };
        match inside.then(|| self.parts[index()].as_ref()).flatten() {
            Some(part) => self.function.jet_of(part, point).value,
            None => self.function.jet(point).value,
        }
    }
}

/// The largest distance found between mesh and surface, either way.
fn two_way(function: &dyn Implicit, mesh: &TriangleMesh) -> f64 {
    let bvh = Bvh::new(&mesh.triangle_boxes());
    let mut state = 5_u64;
    let mut random = || {
        state = state
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (state >> 33) as f64 / (1_u64 << 31) as f64
    };
    let mut areas: Vec<f64> = Vec::new();
    let mut all = 0.0;
    for i in 0..mesh.triangles.len() {
        let [a, b, c] = mesh.corners(i);
        all += (b - a).cross(c - a).length();
        areas.push(all);
    }
    let mut farthest = 0.0_f64;
    for _ in 0..SAMPLES {
        let place = random() * all;
        let i = areas.partition_point(|area| *area < place);
        let i = i.min(areas.len() - 1);
        let [a, b, c] = mesh.corners(i);
        let (mut u, mut v) = (random(), random());
        if u + v > 1.0 {
            (u, v) = (1.0 - u, 1.0 - v);
        }
        let point = a + (b - a) * u + (c - a) * v;
        let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
        let Some(found) = on_surface(function, point, longest) else {
            continue;
        };
        let closest =
            |i: u32| closest_point(&mesh.corners(i as usize), found).distance_squared(found);
        let back = bvh
            .nearest(found, f64::INFINITY, closest)
            .map_or(0.0, |(_, d)| d.sqrt());
        farthest = farthest.max(found.distance(point)).max(back);
    }
    farthest
}

/// The point of the surface that Newton's steps lead to, if it is near.
fn on_surface(function: &dyn Implicit, start: DVec3, reach: f64) -> Option<DVec3> {
    let mut point = start;
    for _ in 0..20 {
        let jet = function.jet(point);
        let gradient = DVec3::from_array(jet.gradient);
        let step = gradient * ((THRESHOLD - jet.value) / gradient.length_squared());
        point += step;
        if point.distance(start) > reach || !point.is_finite() {
            return None;
        }
        if step.length() < 1e-9 * reach {
            return Some(point);
        }
    }
    None
}
