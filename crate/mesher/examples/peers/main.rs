//! Speed and triangles of meshes: lines of JSON for `cargo xtask bench meshes`.
//!
//! `cargo run --release -p mesher --features fidget --example peers -- KIND FILE…`, where KIND is
//! the program that the mesher is compared with at equal measured error,
//! `level-set` (manifold-rust) or `fidget` (with the quartic kernel), or `alone` for the time of
//! the mesher only, which runs as wasm, too.
//!
//! The edge length of the others' cells is the longest one found at which the measured error is
//! that of our mesh.

#[cfg(feature = "fidget")]
mod fidget;
mod level_set;

use field::{Implicit, Kernel, THRESHOLD};
use glam::DVec3;
use mesh::{Aabb, Bvh, TriangleMesh, closest_point};
use mesher::{Options, Progress, SurfaceMesh, box_of, extent, polygonize};
use scene::Scene;
use serde_json::{Value, json};
use std::ops::ControlFlow;
use std::path::Path;
use std::time::Instant;
use trials::Random;

/// The tolerance as a share of the diagonal of the box of the surface.
const SHARE: f64 = 1e-3;
/// Places where errors are measured.
const SAMPLES: usize = 4000;

fn main() -> Result<(), String> {
    let mut arguments = std::env::args().skip(1);
    let kind = arguments.next().unwrap_or_default();
    for path in arguments {
        let path = Path::new(&path);
        let mut scene = load(path)?;
        if kind == "fidget" {
            // A sum of polynomials is the easiest for it.
            let all = scene.flesh.iter_mut();
            all.for_each(|flesh| flesh.kernel = Some(Kernel::Quartic));
        }
        let mut row = measure(&scene, &kind)?;
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        row["scene"] = json!(name);
        println!("{row}");
    }
    Ok(())
}

/// Measures the mesh of a scene's first soft surface, and those of the other program.
fn measure(scene: &Scene, kind: &str) -> Result<Value, String> {
    let surfaces = scene.surfaces();
    let surface = surfaces.first().ok_or("nothing is soft")?;
    let function = surface.function();
    let (own, seconds, hull) = own(function)?;
    let mut row = json!({
        "seconds": seconds,
        "triangles": own.mesh.triangles.len(),
        "proved": own.error,
        "evaluations": own.evaluations,
    });
    if kind == "alone" {
        return Ok(row);
    }
    let error = two_way(function, &own.mesh);
    let start = Instant::now();
    let made = match kind {
        "level-set" => {
            let grid = level_set::Grid::new(function, &hull);
            let prepared = start.elapsed().as_secs_f64();
            // Vertices as near to the surface as ours.
            let make = |edge| Ok(level_set::mesh(&grid, &hull, edge, 0.05 * error));
            at_equal_error(function, &hull, error, prepared, make)
        }
        #[cfg(feature = "fidget")]
        "fidget" => {
            let tree = fidget::tree(scene)?;
            let make = |edge| fidget::mesh(&tree, &hull, edge);
            at_equal_error(function, &hull, error, 0.0, make)
        }
        _ => Err(format!("`{kind}` is no program to compare with")),
    };
    let Made {
        triangles,
        seconds,
        error: their_error,
        edge,
    } = made?;
    row["error"] = json!(error);
    row["peer_seconds"] = json!(seconds);
    row["peer_triangles"] = json!(triangles);
    row["peer_error"] = json!(their_error);
    row["peer_edge"] = json!(edge);
    Ok(row)
}

/// Our mesh, its seconds, and the box of the surface.
fn own(function: &dyn Implicit) -> Result<(SurfaceMesh, f64, Aabb), String> {
    let domain = box_of(function.support().ok_or("it is infinite")?);
    let mut report = |_| ControlFlow::Continue(());
    let mut progress = Progress::new(&mut report);
    let told = |error: mesher::MeshError| error.to_string();
    let hull = extent(function, &domain, 1, &mut progress).map_err(told)?;
    let hull = hull.ok_or("there is no surface")?;
    let start = Instant::now();
    let options = Options::new(SHARE * hull.size().length());
    let own = polygonize(function, &domain, &options, &mut progress).map_err(told)?;
    Ok((own, start.elapsed().as_secs_f64(), hull))
}

/// A mesh of the other program.
struct Made {
    triangles: usize,
    seconds: f64,
    error: f64,
    edge: f64,
}

/// Halvings of the interval of edge lengths in which the error becomes small enough.
const HALVINGS: usize = 3;

/// Makes meshes with ever shorter edges until the measured error is at most a tenth larger than a
/// wanted one, and a few with edges between the last two; `prepared` seconds are added to the time
/// of the coarsest one that is good enough.
fn at_equal_error(
    function: &dyn Implicit,
    hull: &Aabb,
    wanted: f64,
    prepared: f64,
    make: impl Fn(f64) -> Result<TriangleMesh, String>,
) -> Result<Made, String> {
    let made = |edge: f64| -> Result<Made, String> {
        let start = Instant::now();
        let mesh = make(edge)?;
        let seconds = prepared + start.elapsed().as_secs_f64();
        Ok(Made {
            triangles: mesh.triangles.len(),
            seconds,
            error: two_way(function, &mesh),
            edge,
        })
    };
    let is_good = |made: &Made| made.error <= 1.1 * wanted;
    let mut too_long = 0.1 * hull.size().max_element();
    let mut best = made(too_long)?;
    for _ in 0..8 {
        if is_good(&best) || best.triangles > 20_000_000 {
            break;
        }
        too_long = best.edge;
        // The error falls with the square of the edge.
        best = made(too_long * (wanted / best.error).sqrt().clamp(0.4, 0.95))?;
    }
    for _ in 0..HALVINGS {
        if best.error > 0.8 * wanted {
            break;
        }
        let middle = made((too_long * best.edge).sqrt())?;
        if is_good(&middle) {
            best = middle;
        } else {
            too_long = middle.edge;
        }
    }
    Ok(best)
}

fn load(path: &Path) -> Result<Scene, String> {
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
        // Files that are not beside it are in the library.
        if let Ok(text) = text(&folder.join(&other)) {
            files.push(rats::File { name: other, text });
        }
    }
    let compiled = rats::compile_at(&rats::Project { files }, &[], 0.0);
    Ok(std::sync::Arc::unwrap_or_clone(compiled.scene))
}

/// The largest distance found between mesh and surface, either way.
fn two_way(function: &dyn Implicit, mesh: &TriangleMesh) -> f64 {
    let bvh = Bvh::new(&mesh.triangle_boxes());
    let mut random = Random::new(5);
    let mut areas: Vec<f64> = Vec::new();
    let mut all = 0.0;
    for i in 0..mesh.triangles.len() {
        let [a, b, c] = mesh.corners(i);
        all += (b - a).cross(c - a).length();
        areas.push(all);
    }
    let mut farthest = 0.0_f64;
    for _ in 0..SAMPLES {
        let place = random.range(0.0, all);
        let i = areas.partition_point(|area| *area < place);
        let i = i.min(areas.len() - 1);
        let [a, b, c] = mesh.corners(i);
        let point = random.in_triangle([a, b, c]);
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
