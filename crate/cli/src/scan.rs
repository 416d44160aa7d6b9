//! `sinew scan`: a scene sampled as a scanner would, for `sinew fit`.

use crate::{Outcome, files, report, whole};
use clap::Args;
use fit::{Disturbance, Numbers, Outline};
use glam::DVec3;
use scene::Scene;
use serde_json::json;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use tracer::Picker;

/// Lines that are tried for each point, as few of them meet a thin scene.
const TRIES: usize = 400;
/// Largest noise, a millionth of the largest coordinate that is read in point clouds.
const MOST_NOISE: f64 = 1e6;
/// Most points and views.
const MOST_POINTS: usize = 200_000;
const MOST_VIEWS: u32 = 36;
/// Pixels between the rays that look for an outline.
const SPACING: f64 = 8.0;

/// `sinew scan FILE [-o CLOUD] [--outlines FILE] [--noise S] …`.
#[derive(Args)]
pub struct Scan {
    /// The dataset
    file: PathBuf,
    /// File for the points: .ply or .xyz
    #[arg(short, long, required_unless_present = "outlines")]
    output: Option<PathBuf>,
    /// Number of points to measure, before the gap is left out
    #[arg(long, default_value_t = 5000, value_name = "N")]
    points: usize,
    /// File for the outlines: .json
    #[arg(long, value_name = "FILE")]
    outlines: Option<PathBuf>,
    /// Cameras of the outlines: the dataset's, and others around what it looks at
    #[arg(long, default_value_t = 6, value_name = "N")]
    views: u32,
    /// Standard deviation of each coordinate, in the dataset's units
    #[arg(long, default_value_t = 0.0, value_name = "S")]
    noise: f64,
    /// Share of the points that lie anywhere, 0 to 1
    #[arg(long, default_value_t = 0.0, value_name = "R")]
    outliers: f64,
    /// Share of the points that is missing, 0 to 1: those furthest in one direction
    #[arg(long, default_value_t = 0.0, value_name = "R")]
    gap: f64,
    /// Seed of all that is random
    #[arg(long, default_value_t = 1, value_name = "N")]
    seed: u64,
}

impl Scan {
    /// Measures and writes. False if the dataset has errors.
    pub fn run(&self) -> Outcome {
        self.check()?;
        let loaded = files::load(&self.file)?;
        let clean = report::to_stderr(&loaded);
        let scene = &loaded.compiled.scene;
        let (middle, radius) = place(scene)
            .ok_or("there is nothing in this scene that has an end, so nothing to measure")?;
        let picker = Picker::new(scene);
        let disturbance = Disturbance {
            noise: self.noise,
            outliers: self.outliers,
            gap: self.gap,
            seed: self.seed,
            ..Disturbance::default()
        };
        if let Some(path) = &self.output {
            let points = sample(&picker, middle, radius, self.points, self.seed)?;
            let points = disturbance.apply(&points);
            if points.is_empty() {
                return Err(String::from(
                    "the gap leaves out all points: ask for more `--points`, or a smaller `--gap`",
                ));
            }
            let bytes = if ends_with(path, "ply") {
                ply(&points)
            } else {
                xyz(&points)
            };
            put(path, &bytes)?;
            eprintln!("{}: {} points", path.display(), points.len());
        }
        if let Some(path) = &self.outlines {
            let views = self.views(scene, middle)?;
            let mut outlines = Vec::new();
            let mut numbers = Numbers::new(self.seed ^ 0x6f75_746c);
            for (number, mut view) in (1..).zip(views) {
                view.trace(SPACING, &mut |eye, way| picker.pick(eye, way).is_some());
                if view.lines.is_empty() {
                    return Err(format!(
                        "view {number} has no outline: the scene is outside of the picture, or \
                         fills it; change the dataset's eyep, vrp or fov"
                    ));
                }
                disturb(&mut view, &disturbance, &mut numbers);
                outlines.push(view);
            }
            let places: usize = outlines.iter().flat_map(|o| &o.lines).map(Vec::len).sum();
            put(path, json!(outlines).to_string().as_bytes())?;
            eprintln!(
                "{}: {} views, {places} places of outlines",
                path.display(),
                outlines.len()
            );
        }
        Ok(clean)
    }

    fn check(&self) -> Result<(), String> {
        let shares = 0.0..1.0;
        if !(0.0..=MOST_NOISE).contains(&self.noise) {
            return Err(format!("--noise must be a number from 0 to {MOST_NOISE:e}"));
        }
        if !shares.contains(&self.outliers) || !shares.contains(&self.gap) {
            return Err(String::from(
                "--outliers and --gap are shares, from 0 to less than 1",
            ));
        }
        if !(1..=MOST_POINTS).contains(&self.points) {
            return Err(format!("--points must be from 1 to {MOST_POINTS}"));
        }
        if !(1..=MOST_VIEWS).contains(&self.views) {
            return Err(format!("--views must be from 1 to {MOST_VIEWS}"));
        }
        if let Some(path) = &self.output
            && !ends_with(path, "ply")
            && !ends_with(path, "xyz")
        {
            return Err(format!(
                "{}: points are written to a .ply or .xyz file",
                path.display()
            ));
        }
        Ok(())
    }

    /// The cameras: the dataset's, turned about the upward direction by equal parts of half a
    /// turn, as a shape has the same outline from the other side.
    fn views(&self, scene: &Scene, middle: DVec3) -> Result<Vec<Outline>, String> {
        let camera = scene.camera;
        let axis = camera
            .up
            .try_normalize()
            .ok_or("the dataset's vup is no direction")?;
        let [width, height] = scene.settings.frame.map(f64::from);
        // Sharp enough for outlines, whatever the picture's size.
        let grow = (640.0 / width.max(height)).max(1.0);
        let outlines = (0..self.views).map(|i| {
            let angle = std::f64::consts::PI * f64::from(i) / f64::from(self.views);
            let (sine, cosine) = libm::sincos(angle);
            let [eye, target] = [camera.eye, camera.target].map(|p| {
                let v = p - middle;
                let turned =
                    v * cosine + axis.cross(v) * sine + axis * (axis.dot(v) * (1.0 - cosine));
                (middle + turned).to_array()
            });
            Outline {
                eye,
                target,
                up: camera.up.to_array(),
                fov: camera.fov,
                size: [(width * grow).round(), (height * grow).round()],
                lines: Vec::new(),
            }
        });
        Ok(outlines.collect())
    }
}

fn ends_with(path: &Path, ending: &str) -> bool {
    path.extension()
        .is_some_and(|e| e.eq_ignore_ascii_case(ending))
}

/// The centre and radius of a ball around all bounded elements.
fn place(scene: &Scene) -> Option<(DVec3, f64)> {
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let shapes = scene::extent(scene.elements.iter().map(|e| &e.shape));
    let surfaces = scene.surfaces().into_iter().filter_map(|surface| {
        let ball = surface.function().support()?;
        Some((ball.center, ball.radius))
    });
    for (center, radius) in shapes.into_iter().chain(surfaces) {
        low = low.min(center - radius);
        high = high.max(center + radius);
    }
    let size = high - low;
    (size.is_finite() && size.max_element() > 0.0)
        .then(|| (0.5 * (low + high), 0.5 * size.length()))
}

/// Samples points where lines enter the scene. Lines of uniformly random directions and places meet
/// each part of a surface in proportion to its area, as far as it is seen from outside.
fn sample(
    picker: &Picker,
    middle: DVec3,
    radius: f64,
    count: usize,
    seed: u64,
) -> Result<Vec<DVec3>, String> {
    let mut numbers = Numbers::new(seed ^ 0x0073_6361_6e00);
    let mut points = Vec::with_capacity(count);
    for _ in 0..TRIES * count {
        let way = numbers.direction();
        let (u, v) = way.any_orthonormal_pair();
        let angle = std::f64::consts::TAU * numbers.uniform();
        let (sine, cosine) = libm::sincos(angle);
        let aside = radius * numbers.uniform().sqrt();
        let origin = middle + (u * cosine + v * sine) * aside - way * (2.0 * radius);
        if let Some(hit) = picker.pick(origin, way)
            && hit.position.distance(middle) <= 1.01 * radius
        {
            points.push(hit.position);
            if points.len() == count {
                return Ok(points);
            }
        }
    }
    Err(format!(
        "only {} of {count} points were found: too few lines meet anything in this scene",
        points.len()
    ))
}

/// Disturbs an outline: a gap on one side, noise as large as that of points in the middle of the
/// scene, places anywhere in the picture.
fn disturb(view: &mut Outline, disturbance: &Disturbance, numbers: &mut Numbers) {
    let [width, height] = view.size;
    let away = DVec3::from_array(view.eye).distance(DVec3::from_array(view.target));
    let pixel = away * 2.0 * libm::tan(0.5 * view.fov.to_radians()) / width;
    let noise = disturbance.noise / pixel.max(1e-12);
    let angle = std::f64::consts::TAU * numbers.uniform();
    let (sine, cosine) = libm::sincos(angle);
    let along = |p: &[f64; 2]| p[0] * cosine + p[1] * sine;
    let mut order: Vec<f64> = view.lines.iter().flatten().map(along).collect();
    order.sort_by(f64::total_cmp);
    let kept = ((1.0 - disturbance.gap) * order.len() as f64).round() as usize;
    let border = order
        .get(kept)
        .copied()
        .filter(|_| disturbance.gap > 0.0)
        .unwrap_or(f64::INFINITY);
    let mut lines = Vec::new();
    for line in &view.lines {
        for piece in line.split(|place| along(place) >= border) {
            let disturbed = piece.iter().map(|[x, y]| {
                let is_outlier = numbers.uniform() < disturbance.outliers;
                let shift = [numbers.normal(), numbers.normal()];
                if is_outlier {
                    [numbers.uniform() * width, numbers.uniform() * height]
                } else {
                    [
                        (x + noise * shift[0]).clamp(0.0, width),
                        (y + noise * shift[1]).clamp(0.0, height),
                    ]
                }
            });
            let disturbed: Vec<_> = disturbed.collect();
            if !disturbed.is_empty() {
                lines.push(disturbed);
            }
        }
    }
    view.lines = lines;
}

fn put(path: &Path, bytes: &[u8]) -> Result<(), String> {
    whole::write(path, |out| out.write_all(bytes).map_err(|e| e.to_string()))
}

/// The points as binary PLY in double precision.
fn ply(points: &[DVec3]) -> Vec<u8> {
    let mut bytes = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty double x\n\
         property double y\nproperty double z\nend_header\n",
        points.len()
    )
    .into_bytes();
    for value in points.iter().flat_map(DVec3::to_array) {
        bytes.extend(value.to_le_bytes());
    }
    bytes
}

/// The points as text, a line each.
fn xyz(points: &[DVec3]) -> Vec<u8> {
    let lines = points.iter().map(|p| format!("{} {} {}\n", p.x, p.y, p.z));
    lines.collect::<String>().into_bytes()
}
