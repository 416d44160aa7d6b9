//! Scenes: random ones over all kernels and primitives, and the examples, judged by others.
//!
//! By default a small sample. `SINEW_MESHES=all` meshes all examples and 200 random scenes,
//! `SINEW_MESHES=NAME` one example, `SINEW_MESHES=NUMBER` one random scene with the care of the
//! sample, `SINEW_MESHES=NUMBER-NUMBER` some of the 200, and prints a line for each:
//! `SINEW_MESHES=all cargo test --release -p mesher --test it scenes:: -- --nocapture`.
//! `SINEW_TOLERANCE=2e-3` asks for another tolerance, as a share of the model's size, than 1e-2 for
//! random scenes and 1e-3 for examples. Meshes of the 200 scenes and of all examples that take
//! longer than a minute of a processor, or the seconds that `SINEW_SECONDS` says, are given up;
//! they are told, and are not taken for wrong.

use crate::judges::{Distances, crossings, manifold, of_mesh, on_surface};
use field::Kernel;
use glam::DVec3;
use mesh::{Topology, TriangleMesh, self_intersections};
use mesher::{MeshError, Model, Progress, Step, Tolerance, Wishes, mesh_scene};
use oracle::Reference;
use oracle::reference::Near;
use scene::{Scene, Surface};
use std::ops::ControlFlow;
use std::path::Path;
use std::time::Instant;
use trials::scenes::{self, KINDS};
use trials::{Random, count};

/// How much is asked of a scene.
#[derive(Clone, Copy)]
struct Care {
    relative: f64,
    samples: usize,
    rays: usize,
    genus: bool,
    threads: usize,
    /// Whether the mesh is made with proofs.
    prove: bool,
    /// Seconds after which a mesh is given up; infinity for none.
    limit: f64,
}

/// What was found; an error is a promise that was broken.
#[derive(Default)]
struct Row {
    triangles: usize,
    /// Triangles before they were made fewer.
    raw: usize,
    /// Parts that were made with proofs though none were asked for.
    proved: usize,
    undecided: usize,
    unproved: usize,
    /// Largest distances that the mesher sampled where nothing is proved, in tolerances.
    measured: [f64; 2],
    /// Of sampled points, in tolerances.
    off: [f64; 2],
    unknown: usize,
    seconds: f64,
    empty: bool,
    /// The mesh was given up.
    late: bool,
    /// The finer mesh was given up that has the same genus.
    genus_late: bool,
}

fn mesh_with(scene: &Scene, relative: f64, care: Care) -> Result<Model, MeshError> {
    let wishes = Wishes {
        tolerance: Tolerance::Relative(relative),
        max_triangles: 600_000,
        threads: care.threads,
        prove: care.prove,
        ..Wishes::default()
    };
    let (clock, mut phases) = (Clock::new(), Vec::new());
    let mut report = |step: Step| {
        if phases.last().is_none_or(|(phase, _)| *phase != step.phase) {
            phases.push((step.phase, clock.seconds()));
        }
        if clock.is_beyond(care.limit) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    };
    let result = mesh_scene(scene, &wishes, &mut Progress::new(&mut report));
    let begun = phases
        .iter()
        .map(|(phase, s)| format!("{} {s:.1} s", phase.name()));
    let begun = begun.collect::<Vec<String>>().join(", ");
    match &result {
        Ok(model) => println!(
            "  {} evaluations; {begun}; {}",
            model.evaluations,
            model.notes.join("; ")
        ),
        Err(why) => println!("  {why}; {begun}"),
    }
    result
}

/// Meshes a scene and checks all that is promised of it.
fn judge(scene: &Scene, care: Care) -> Result<Row, String> {
    let clock = Clock::new();
    let mut row = Row::default();
    let model = match mesh_with(scene, care.relative, care) {
        Ok(model) => model,
        Err(MeshError::Cancelled) => {
            row.late = true;
            return Ok(row);
        }
        Err(MeshError::Nothing | MeshError::AllInside | MeshError::Unbounded) => {
            row.empty = true;
            return is_empty(scene).map(|()| row);
        }
        Err(other) => return Err(other.to_string()),
    };
    row.seconds = clock.seconds();
    let surfaces = scene.surfaces();
    for part in &model.parts {
        let mesh = &part.mesh;
        let name = &part.name;
        row.triangles += mesh.triangles.len();
        row.raw += part.raw_triangles;
        if !care.prove {
            row.proved += usize::from(!part.is_measured && part.raw_triangles > 0);
        }
        row.undecided += part.undecided.len();
        row.unproved += part.unproved;
        let measured = part
            .measured
            .largest
            .map(|distance| distance / model.tolerance);
        row.measured = [0, 1].map(|i| row.measured[i].max(measured[i]));
        if !part.is_closed {
            continue;
        }
        manifold(mesh).map_err(|why| format!("{name}: {why}"))?;
        let is_hard = part.name.ends_with("hard");
        if !is_hard {
            let crossings = self_intersections(mesh, 10).map_err(|error| error.to_string())?;
            if !crossings.is_free() || part.crossings > 0 {
                return Err(format!("{name}: it cuts itself {crossings:?}"));
            }
        }
        if part.error > model.tolerance {
            return Err(format!(
                "{name}: error {} of {}",
                part.error, model.tolerance
            ));
        }
    }
    let mut seen: Vec<&str> = Vec::new();
    for surface in &surfaces {
        let body = scene.bodies.get(surface.body() as usize);
        let body = body.map_or("", |body| body.name.as_str());
        let name = if body.is_empty() { "model" } else { body };
        // Bodies may share a name; their meshes have the same order.
        let before = seen.iter().filter(|own| **own == name).count();
        seen.push(name);
        let own = |part: &&mesher::ModelPart| part.name == name;
        let Some(part) = model.parts.iter().filter(own).nth(before) else {
            continue;
        };
        distances(surface, &part.mesh, &model, care, &mut row)
            .map_err(|why| format!("{name}: {why}"))?;
    }
    if care.genus && row.undecided == 0 && row.unproved == 0 {
        let finer = match mesh_with(scene, 0.5 * care.relative, care) {
            Ok(finer) => finer,
            Err(MeshError::Cancelled) => {
                row.genus_late = true;
                return Ok(row);
            }
            Err(other) => return Err(other.to_string()),
        };
        let genera = |model: &Model| {
            let closed = model.parts.iter().filter(|part| part.is_closed);
            let mut all: Vec<u64> = closed
                .flat_map(|part| Topology::of(&part.mesh).map_or(Vec::new(), |t| t.genera))
                .collect();
            all.sort_unstable();
            all
        };
        let is_sure = finer.parts.iter().all(|part| part.undecided.is_empty());
        let [own, other] = [&model, &finer].map(genera);
        if is_sure && own != other {
            return Err(format!("genus {own:?}, at twice the resolution {other:?}"));
        }
    }
    Ok(row)
}

/// Random rays meet no surface.
fn is_empty(scene: &Scene) -> Result<(), String> {
    let mut random = Random::new(3);
    for surface in scene.surfaces() {
        let function = surface.function();
        let Some(ball) = function.support().filter(|ball| ball.radius > 0.0) else {
            continue;
        };
        for _ in 0..20 {
            let from = ball.center + random.vector(1.0) * ball.radius;
            let to = ball.center + random.vector(1.0) * ball.radius;
            let (length, direction) = (from.distance(to), (to - from).normalize_or(DVec3::X));
            let met = crossings(function, from, direction, length, 1e-6 * ball.radius);
            if !met.is_empty() {
                return Err(format!("no mesh, but a ray meets a surface at {met:?}"));
            }
        }
    }
    Ok(())
}

/// Both distances, by sampling: of points of the mesh from the surface, and of crossings of rays
/// from the mesh.
fn distances(
    surface: &Surface,
    mesh: &TriangleMesh,
    model: &Model,
    care: Care,
    row: &mut Row,
) -> Result<(), String> {
    let function = surface.function();
    let mut reference = match surface {
        Surface::Sum(sum) => {
            let mut reference = Reference::new(sum.sum.primitives.clone());
            reference.patience = 3000;
            Some(reference)
        }
        Surface::Composed(_) => None,
    };
    let tolerance = model.tolerance;
    // Nothing is promised of the numbers' own rounding.
    let slack = 1e-12
        * mesh
            .bounds()
            .max
            .abs()
            .max(mesh.bounds().min.abs())
            .max_element();
    let allowed = tolerance * (1.0 + 1e-6) + slack;
    // Triangles that are not proved may be farther; they are counted.
    let may_be_off = row.unproved + row.undecided > 0;
    let mut random = Random::new(11);
    let is_cut = function.support().is_none();
    let bounds = mesh.bounds();
    let is_lid = |i: usize| {
        let corners = mesh.corners(i);
        is_cut
            && (0..3).any(|k| {
                [bounds.min[k], bounds.max[k]]
                    .iter()
                    .any(|side| corners.iter().all(|p| p[k] == *side))
            })
    };
    for _ in 0..care.samples {
        let (i, point) = of_mesh(&mut random, mesh);
        if is_lid(i) {
            continue;
        }
        match &mut reference {
            Some(reference) => match reference.surface_near(point, allowed) {
                Near::Within(distance) => row.off[0] = row.off[0].max(distance / tolerance),
                Near::Unknown => row.unknown += 1,
                Near::Beyond if may_be_off => row.unknown += 1,
                Near::Beyond => {
                    let (excess, gradient) = reference.excess(point);
                    return Err(format!(
                        "{point} is {} off",
                        excess.abs() / gradient.length()
                    ));
                }
            },
            None => match on_surface(function, point) {
                Some(found) if found.distance(point) <= allowed => {
                    row.off[0] = row.off[0].max(found.distance(point) / tolerance);
                }
                // The nearest point may be another one.
                _ => row.unknown += 1,
            },
        }
    }
    let near = Distances::new(mesh);
    let size = bounds.size();
    for _ in 0..care.rays {
        let inside = |random: &mut Random| bounds.center() + 0.5 * random.vector(1.0) * size;
        let to = inside(&mut random);
        let direction = random.direction();
        let from = to - direction * size.length();
        let limit = 2.0 * size.length();
        let resolution = 0.01 * tolerance;
        let met: Vec<f64> = match &mut reference {
            Some(reference) => {
                let found = reference.crossings(from, direction, limit, resolution);
                found.roots.iter().map(|root| root.t).collect()
            }
            None => crossings(function, from, direction, limit, resolution),
        };
        for t in met {
            let point = from + direction * t;
            let beyond = (bounds.min - point).max(point - bounds.max).max_element();
            if is_cut && beyond > 0.0 {
                continue;
            }
            let off = near.to(point);
            if off > allowed + resolution && !may_be_off {
                return Err(format!(
                    "the surface at {point} is {off} away from the mesh, allowed {allowed}"
                ));
            }
            row.off[1] = row.off[1].max(off / tolerance);
        }
    }
    Ok(())
}

fn wanted() -> Option<String> {
    std::env::var("SINEW_MESHES").ok()
}

/// The tolerance that is asked for, or else this one.
fn tolerance(usual: f64) -> f64 {
    let asked = std::env::var("SINEW_TOLERANCE").ok();
    asked.map_or(usual, |asked| asked.parse().expect("SINEW_TOLERANCE"))
}

/// Seconds after which one of many meshes is given up.
fn limit() -> f64 {
    let asked = std::env::var("SINEW_SECONDS").ok();
    asked.map_or(60.0, |asked| asked.parse().expect("SINEW_SECONDS"))
}

/// Measures how long this thread has had a processor, where the system tells, else how long it
/// took.
struct Clock {
    start: Instant,
    busy: Option<f64>,
}

impl Clock {
    fn new() -> Self {
        Self {
            start: Instant::now(),
            busy: Self::busy(),
        }
    }

    fn busy() -> Option<f64> {
        let told = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
        let nanoseconds: f64 = told.split_whitespace().next()?.parse().ok()?;
        Some(1e-9 * nanoseconds)
    }

    fn seconds(&self) -> f64 {
        let busy = self.busy.zip(Self::busy()).map(|(from, to)| to - from);
        busy.unwrap_or_else(|| self.start.elapsed().as_secs_f64())
    }

    fn is_beyond(&self, limit: f64) -> bool {
        // The question to the system takes longer.
        self.start.elapsed().as_secs_f64() > limit && self.seconds() > limit
    }
}

fn told(name: &str, result: &Result<Row, String>) -> bool {
    match result {
        Ok(row) if row.empty => println!("{name}: nothing there"),
        Ok(row) if row.late => println!("{name}: LATE: given up after {} s", limit()),
        Ok(row) => println!(
            "{name}: {} triangles of {}, {} made with proofs, {} undecided, {} unproved \
             ({:.2} {:.2}), off {:.2} {:.2}, {} unknown, {:.2} s{}",
            row.triangles,
            row.raw,
            row.proved,
            row.undecided,
            row.unproved,
            row.measured[0],
            row.measured[1],
            row.off[0],
            row.off[1],
            row.unknown,
            row.seconds,
            if row.genus_late {
                ", its finer mesh given up"
            } else {
                ""
            },
        ),
        Err(why) => println!("{name}: WRONG: {why}"),
    }
    result.is_err()
}

/// Random scenes of the first dozen that take several seconds each.
const SLOW: [usize; 6] = [4, 5, 6, 7, 8, 10];

#[test]
fn random_scenes() {
    judge_random_scenes(true);
}

#[test]
fn random_scenes_without_proofs() {
    judge_random_scenes(false);
}

fn judge_random_scenes(prove: bool) {
    let wanted = wanted();
    let some = wanted.as_deref().and_then(|wanted| {
        let (from, to) = wanted.split_once('-')?;
        Some((from.parse().ok()?, to.parse().ok()?))
    });
    let is_all = wanted.as_deref() == Some("all");
    let (from, to): (usize, usize) = some.unwrap_or((0, 199));
    let is_all = is_all || some.is_some();
    let only: Option<usize> = wanted.and_then(|wanted| wanted.parse().ok());
    let (scenes, care) = if is_all {
        (
            200,
            Care {
                relative: tolerance(1e-2),
                samples: 100,
                rays: 30,
                genus: true,
                threads: 1,
                prove,
                limit: limit(),
            },
        )
    } else {
        (
            only.map_or(count(12), |only| only + 1),
            Care {
                relative: tolerance(1e-2),
                samples: 10,
                rays: 4,
                genus: false,
                threads: 1,
                prove,
                limit: limit(),
            },
        )
    };
    let (mut wrong, mut late, mut judged) = (0, 0, 0);
    for number in 0..scenes {
        let kernel = Kernel::ALL[number % Kernel::ALL.len()];
        let kind = KINDS[(number * 5) % KINDS.len()];
        let is_wanted = only.map_or(is_all || !SLOW.contains(&number), |only| only == number);
        let is_wanted = is_wanted && (from..=to).contains(&number);
        if !is_wanted {
            continue;
        }
        let (scene, _) = scenes::scene(kernel, kind, &mut Random::new(number as u64));
        let clock = Clock::new();
        let result = judge(&scene, care);
        let seconds = clock.seconds();
        let name = format!("{number} {kernel:?} {kind:?}, {seconds:.1} s in all");
        late += usize::from(result.as_ref().is_ok_and(|row| row.late));
        judged += 1;
        wrong += usize::from(told(&name, &result));
    }
    assert_eq!(wrong, 0);
    assert!(2 * late <= judged, "{late} of {judged} were given up");
}

/// The scene of a file with the assets that it names.
fn load(path: &Path) -> Scene {
    let name = path.file_name().unwrap().to_string_lossy().into_owned();
    let text = std::fs::read_to_string(path).unwrap();
    let folder = path.parent().unwrap();
    let assets = rats::asset_names(&text).into_iter().filter_map(|name| {
        let bytes = std::fs::read(folder.join(&name)).ok()?;
        Some(rats::Asset::new(name, bytes))
    });
    let assets: Vec<rats::Asset> = assets.collect();
    let project = rats::Project {
        files: vec![rats::File { name, text }],
    };
    std::sync::Arc::unwrap_or_clone(rats::compile_at(&project, &assets, 0.0).scene)
}

#[test]
fn examples() {
    judge_examples(true);
}

#[test]
fn examples_without_proofs() {
    judge_examples(false);
}

fn judge_examples(prove: bool) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../www/examples");
    let wanted = wanted();
    let mut names: Vec<_> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "rat"))
        .collect();
    names.sort();
    let care = match &wanted {
        Some(wanted) => Care {
            relative: tolerance(1e-3),
            samples: 200,
            rays: 60,
            genus: true,
            threads: 1,
            prove,
            limit: if wanted == "all" {
                limit()
            } else {
                f64::INFINITY
            },
        },
        None => Care {
            relative: 8e-3,
            samples: 20,
            rays: 8,
            genus: false,
            threads: 2,
            prove,
            limit: f64::INFINITY,
        },
    };
    let mut wrong = 0;
    for path in names {
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        let is_wanted = match wanted.as_deref() {
            Some("all") => true,
            Some(one) => one == name,
            None => ["tshape", "starfish-a", "touching"].contains(&name.as_str()),
        };
        if !is_wanted {
            continue;
        }
        let result = judge(&load(&path), care);
        wrong += usize::from(told(&name, &result));
    }
    assert_eq!(wrong, 0);
}
