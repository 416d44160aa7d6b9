//! `sinew mesh`: a dataset's surfaces as triangles in a file.

use crate::{Outcome, files, report, whole};
use clap::Args;
use mesh::limits::MILLIMETRES;
use mesh::{Export, Format, Level, Part, Topology, TriangleMesh};
use mesher::{Model, ModelPart, Phase, Progress, Step, Tolerance, Wishes, coat_scene, mesh_scene};
use serde_json::{Value, json};
use std::io::{IsTerminal, Write};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

/// Fewest triangles of a level of detail.
const LEAST: usize = 64;

/// `sinew mesh FILE -o OUT.{glb,3mf,stl,obj,ply} …`.
#[derive(Args)]
pub struct Mesh {
    /// The dataset
    file: PathBuf,
    /// The file to write; its ending tells the format: glb, 3mf, stl, obj or ply
    #[arg(short, long)]
    output: PathBuf,
    /// Largest distance between mesh and surface, in the dataset's unit
    #[arg(long, value_name = "E", conflicts_with = "relative")]
    tolerance: Option<f64>,
    /// Tolerance as a share of the diagonal of the model's box
    #[arg(long, value_name = "R", default_value_t = 1e-3)]
    relative: f64,
    /// Length of the model's longest side in the file, millimetres
    #[arg(long, value_name = "MM", default_value_t = 100.0)]
    size: f64,
    /// Infinite elements are cut off by the box of all finite elements, times this
    #[arg(long = "box", value_name = "S", default_value_t = 2.0)]
    box_scale: f64,
    /// Join all closed parts to one by a boolean union
    #[arg(long)]
    union: bool,
    /// Leave out cavities, which nobody sees from outside
    #[arg(long)]
    outer: bool,
    /// Prove what can be proved of topology and error, which takes about ten times as long; without
    /// it the error is measured
    #[arg(long)]
    prove: bool,
    /// Name of the body that is meshed alone
    #[arg(long, value_name = "NAME")]
    body: Option<String>,
    /// Write so many coarser levels of detail beside, as NAME-1, NAME-2 …: each has a quarter of
    /// the triangles
    #[arg(long, value_name = "N", default_value_t = 0)]
    lod: usize,
    /// Instead of a mesh within a tolerance a quick coating of the soft elements' skeletons: closed
    /// shells that overlap, whose edges are split where the field in their middle is off its
    /// threshold by more than B
    #[arg(
        long,
        value_name = "B",
        conflicts_with_all = ["tolerance", "relative", "union", "outer", "prove", "body", "lod"]
    )]
    coat: Option<f64>,
    /// Write the skeletons as joints, each vertex's shares in them as weights, and what moves as an
    /// animation: for .glb
    #[arg(long, conflicts_with_all = ["union", "lod", "coat"])]
    rig: bool,
    /// Frames of the rig's animation; default: four seconds of a dataset that moves
    #[arg(long, value_name = "N", requires = "rig")]
    frames: Option<u32>,
    /// Threads; default: as many as the machine has cores
    #[arg(long, value_name = "N")]
    threads: Option<usize>,
    /// Print what is known of the mesh as JSON on the standard output
    #[arg(long)]
    json: bool,
}

impl Mesh {
    /// Meshes the scene and writes the files. With errors in the dataset the mesh is made of what
    /// could be understood, and the result is false.
    pub fn run(&self) -> Outcome {
        let name = self.output.to_string_lossy();
        let format = Format::of_name(&name)
            .ok_or_else(|| format!("{name}: the name must end in one of {}", Format::ENDINGS))?;
        let is_sound = MILLIMETRES.contains(&self.size);
        if !is_sound {
            return Err(format!(
                "--size must be a number of millimetres from {:e} to {:e}",
                MILLIMETRES.start(),
                MILLIMETRES.end()
            ));
        }
        if self.rig && format != Format::Glb {
            return Err(
                "--rig takes a name that ends in .glb: other formats have no joints".into(),
            );
        }
        if self
            .frames
            .is_some_and(|n| !(1..=motion::MOST_FRAMES).contains(&n))
        {
            return Err(format!("--frames takes 1 to {}", motion::MOST_FRAMES));
        }
        if self.threads == Some(0) {
            return Err("--threads takes 1 or more".into());
        }
        let loaded = files::load(&self.file)?;
        let clean = report::to_stderr(&loaded);
        if let Some(bound) = self.coat {
            return self.coat(&loaded, format, bound).map(|()| clean);
        }
        let threads = self
            .threads
            .unwrap_or_else(|| std::thread::available_parallelism().map_or(1, usize::from));
        let wishes = Wishes {
            tolerance: self
                .tolerance
                .map_or(Tolerance::Relative(self.relative), Tolerance::Absolute),
            box_scale: self.box_scale,
            body: self.body.clone(),
            union: self.union,
            outer: self.outer,
            prove: self.prove,
            threads: threads.clamp(1, 256),
            ..Wishes::default()
        };
        let start = Instant::now();
        let mut progress = Bar::new();
        let mut clock = Clock::new();
        let model = mesh_scene(
            &loaded.compiled.scene,
            &wishes,
            &mut Progress::new(&mut |step: Step| {
                clock.enter(step.phase);
                progress.show(step.fraction)
            }),
        );
        progress.clear();
        let model = model.map_err(|error| format!("{}: {error}", self.file.display()))?;
        let mesh_seconds = start.elapsed().as_secs_f64();
        let phases = clock.stop();

        let start = Instant::now();
        let longest = model.bounds().size().max_element();
        let levels = self.levels(&model)?;
        let lod_seconds = start.elapsed().as_secs_f64();
        let start = Instant::now();
        let stem = self.output.with_extension("");
        let mut written = Vec::new();
        for (i, parts) in levels.iter().enumerate() {
            let path = if i == 0 {
                stem.clone()
            } else {
                PathBuf::from(format!("{}-{i}", stem.display()))
            };
            if self.rig {
                written.push(self.write_rigged(&loaded, &path, &parts.0, self.size / longest)?);
            } else {
                written.extend(write(&path, format, &parts.0, self.size / longest)?);
            }
        }
        let write_seconds = start.elapsed().as_secs_f64();
        let shift = mesh::shift_of(&model.bounds(), self.size / longest);
        let notes = model
            .notes
            .iter()
            .cloned()
            .chain(mesh::describe_shift(shift));
        let notes: Vec<String> = notes.collect();
        for note in &notes {
            eprintln!("{note}");
        }
        if self.json {
            let summary = json!({
                "diagnostics": loaded.compiled.diagnostics,
                "notes": notes,
                "shift": shift.to_array(),
                "tolerance": model.tolerance,
                "millimetres": self.size / longest,
                "evaluations": model.evaluations,
                "parts": model.parts.iter().map(summary).collect::<Vec<_>>(),
                "levels": levels[1..].iter().map(|(parts, error)| json!({
                    "triangles": count(parts),
                    "error": error,
                })).collect::<Vec<_>>(),
                "files": sizes(&written),
                "threads": wishes.threads,
                "seconds": {
                    "compile": loaded.compile_seconds,
                    "mesh": mesh_seconds,
                    "phases": phases,
                    "levels": lod_seconds,
                    "write": write_seconds,
                },
            });
            println!("{summary}");
        } else {
            eprintln!(
                "{}: {} ({:.2} s on {} threads)",
                self.output.display(),
                words(&model, self.size / longest),
                mesh_seconds,
                wishes.threads,
            );
        }
        Ok(clean)
    }

    /// Writes the file with its rig.
    fn write_rigged(
        &self,
        loaded: &files::Loaded,
        stem: &Path,
        parts: &[Part],
        millimetres: f64,
    ) -> Result<(String, usize), String> {
        let rate = loaded.compiled.rate.unwrap_or(25.0);
        let usual = if loaded.compiled.animated {
            (4.0 * rate).clamp(2.0, 1000.0) as u32
        } else {
            1
        };
        let scenes: Vec<scene::Scene> = (0..self.frames.unwrap_or(usual))
            .map(|frame| {
                let frame = f64::from(frame);
                Arc::unwrap_or_clone(rats::compile_at(&loaded.project, &loaded.assets, frame).scene)
            })
            .collect();
        let scene = &loaded.compiled.scene;
        let meshes: Vec<(Option<u32>, &TriangleMesh)> = parts
            .iter()
            .map(|part| (rig::body_of(scene, &part.name), &part.mesh))
            .collect();
        let rig = rig::rig(&scenes, rate, &meshes)?;
        let name = stem.file_name().unwrap_or_default().to_string_lossy();
        let export = Export {
            name: name.into_owned(),
            parts: parts.to_vec(),
            millimetres,
        };
        let file = export
            .write_rigged(&rig)
            .map_err(|error| error.to_string())?;
        let path = stem.with_file_name(&file.name);
        whole::write(&path, |out| {
            out.write_all(&file.bytes)
                .map_err(|error| error.to_string())
        })?;
        eprintln!(
            "{} joints, {} frames at {rate} a second",
            rig.joints.len(),
            rig.frames.len()
        );
        Ok((path.display().to_string(), file.bytes.len()))
    }

    /// Writes a coating of the skeletons.
    fn coat(&self, loaded: &files::Loaded, format: Format, bound: f64) -> Result<(), String> {
        let is_sound = bound > 0.0 && bound.is_finite();
        if !is_sound {
            return Err("--coat takes a positive number".into());
        }
        let start = Instant::now();
        let mut bar = Bar::new();
        let bodies = coat_scene(
            &loaded.compiled.scene,
            bound,
            &mut Vec::new(),
            &mut Progress::new(&mut |step| bar.show(step.fraction)),
        );
        bar.clear();
        let bodies = bodies.map_err(|error| format!("{}: {error}", self.file.display()))?;
        let seconds = start.elapsed().as_secs_f64();
        if bodies.is_empty() {
            return Err(format!(
                "{}: there is no skeleton to coat: nothing is soft",
                self.file.display()
            ));
        }
        let parts = bodies.iter().map(|body| Part {
            name: body.name.clone(),
            mesh: body.coat.mesh.clone(),
        });
        let parts: Vec<Part> = parts.collect();
        let all = parts.iter().fold(mesh::Aabb::EMPTY, |all, part| {
            all.union(&part.mesh.bounds())
        });
        let millimetres = self.size / all.size().max_element();
        let written = write(&self.output.with_extension(""), format, &parts, millimetres)?;
        let evaluations: u64 = bodies.iter().map(|body| body.coat.evaluations).sum();
        for body in bodies.iter().filter(|body| body.coat.left_out > 0) {
            eprintln!(
                "{}: {} pieces of the skeleton have no coat, as that would take too long; \
                 a larger B may help",
                body.name, body.coat.left_out
            );
        }
        let notes: Vec<&String> = bodies.iter().flat_map(|body| &body.notes).collect();
        for note in &notes {
            eprintln!("{note}");
        }
        if self.json {
            let summary = json!({
                "notes": notes,
                "bound": bound,
                "millimetres": millimetres,
                "evaluations": evaluations,
                "parts": bodies.iter().map(|body| json!({
                    "name": body.name,
                    "vertices": body.coat.mesh.positions.len(),
                    "triangles": body.coat.mesh.triangles.len(),
                    "buried": body.coat.buried,
                    "excess": body.coat.excess,
                    "left_out": body.coat.left_out,
                })).collect::<Vec<_>>(),
                "files": sizes(&written),
                "seconds": { "compile": loaded.compile_seconds, "mesh": seconds },
            });
            println!("{summary}");
        } else {
            eprintln!(
                "{}: {} triangles, {evaluations} evaluations, {seconds:.3} s",
                self.output.display(),
                count(&parts),
            );
        }
        Ok(())
    }

    /// The meshes of the file, and of those of coarser levels with their distances from the first.
    fn levels(&self, model: &Model) -> Result<Vec<(Vec<Part>, f64)>, String> {
        let first = model.parts.iter().map(|p| part(p, p.mesh.clone()));
        let mut levels = vec![(first.collect(), 0.0)];
        if self.lod == 0 {
            return Ok(levels);
        }
        let coarser = model.parts.iter().map(|p| {
            if !p.is_closed {
                return Ok(Vec::new());
            }
            mesh::levels_of_detail(&p.mesh, LEAST).map_err(|error| error.to_string())
        });
        let coarser: Vec<Vec<Level>> = coarser.collect::<Result<_, _>>()?;
        for i in 0..self.lod {
            if coarser.iter().all(|levels| i >= levels.len()) {
                eprintln!("there are {i} coarser levels: fewer triangles would not show the shape");
                break;
            }
            let mut error = 0.0_f64;
            let parts = model.parts.iter().zip(&coarser).map(|(p, levels)| {
                // The coarsest there is.
                match levels.get(i).or(levels.last()) {
                    Some(level) => {
                        error = error.max(level.error);
                        let mut mesh = level.mesh.clone();
                        mesh.groups = whole_group(&p.mesh, &mesh);
                        part(p, mesh)
                    }
                    None => part(p, p.mesh.clone()),
                }
            });
            let parts = parts.collect();
            levels.push((parts, error));
        }
        Ok(levels)
    }
}

/// The material of a mesh that has one only, for a coarser one.
fn whole_group(from: &TriangleMesh, to: &TriangleMesh) -> Vec<mesh::Group> {
    let [group] = &from.groups[..] else {
        return Vec::new();
    };
    vec![mesh::Group {
        triangles: 0..to.triangles.len() as u32,
        ..group.clone()
    }]
}

/// The names of files with their sizes.
fn sizes(written: &[(String, usize)]) -> Vec<Value> {
    let sizes = written
        .iter()
        .map(|(path, bytes)| json!({ "name": path, "bytes": bytes }));
    sizes.collect()
}

fn count(parts: &[Part]) -> usize {
    parts.iter().map(|part| part.mesh.triangles.len()).sum()
}

/// Writes the files of a format, and returns their paths with their sizes.
fn write(
    stem: &Path,
    format: Format,
    parts: &[Part],
    millimetres: f64,
) -> Result<Vec<(String, usize)>, String> {
    let name = stem.file_name().unwrap_or_default().to_string_lossy();
    let export = Export {
        name: name.into_owned(),
        parts: parts.to_vec(),
        millimetres,
    };
    let files = export.write(format).map_err(|error| error.to_string())?;
    let mut written = Vec::new();
    for file in files {
        let path = stem.with_file_name(&file.name);
        whole::write(&path, |out| {
            out.write_all(&file.bytes)
                .map_err(|error| error.to_string())
        })?;
        written.push((path.display().to_string(), file.bytes.len()));
    }
    Ok(written)
}

/// A sentence on a model whose unit of length is `millimetres` long in the file.
fn words(model: &Model, millimetres: f64) -> String {
    let open = model.parts.iter().filter(|part| !part.is_closed).count();
    let closed = match open {
        0 => "Watertight".into(),
        _ => format!("{open} of {} meshes open", model.parts.len()),
    };
    let shells = model
        .parts
        .iter()
        .map(|part| match Topology::of(&part.mesh) {
            Ok(topology) if part.is_closed => topology.genera.len(),
            _ => 1,
        });
    let shells: usize = shells.sum();
    let error = model.parts.iter().map(|part| part.error);
    let error = error.fold(0.0, f64::max) * millimetres;
    // Two digits that say something.
    let (mut digits, mut scaled) = (1, error);
    while scaled < 1.0 && digits < 9 {
        (digits, scaled) = (digits + 1, 10.0 * scaled);
    }
    let triangles = model.parts.iter().map(|part| part.mesh.triangles.len());
    format!(
        "{closed}. {} part{}. {error:.digits$} mm. {} triangles",
        thousands(shells),
        if shells == 1 { "" } else { "s" },
        thousands(triangles.sum()),
    )
}

/// A number with commas between thousands.
fn thousands(number: usize) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// Figures of a part.
fn summary(part: &ModelPart) -> Value {
    let mesh = &part.mesh;
    let topology = Topology::of(mesh).ok();
    let bounds = mesh.bounds();
    let volume = part.is_closed.then(|| mesh.signed_volume());
    json!({
        "name": part.name,
        "level": if part.is_measured { "file" } else { "proof" },
        "closed": part.is_closed,
        "vertices": mesh.positions.len(),
        "triangles": mesh.triangles.len(),
        "shells": topology.as_ref().map(|topology| topology.genera.len()),
        "genus": topology.as_ref().map(|topology| topology.genera.clone()),
        "manifold": topology.as_ref().map(|topology| topology.repairs.is_none()),
        "volume": volume,
        "area": mesh.area(),
        "box": [bounds.min, bounds.max],
        "error": part.error,
        "measured": {
            "mesh_to_surface": part.measured.largest[0],
            "surface_to_mesh": part.measured.largest[1],
            "samples": part.measured.samples,
        },
        "undecided": part.undecided.len(),
        "unproved": part.unproved,
        "crossings": part.crossings,
        "smallest_angle": mesh.smallest_angle().map(f64::to_degrees),
        "raw_triangles": part.raw_triangles,
    })
}

/// The time that each phase has taken.
struct Clock {
    phase: Phase,
    since: Instant,
    seconds: [f64; Phase::ALL.len()],
}

impl Clock {
    fn new() -> Self {
        Self {
            phase: Phase::default(),
            since: Instant::now(),
            seconds: Default::default(),
        }
    }

    fn enter(&mut self, phase: Phase) {
        let now = Instant::now();
        self.seconds[self.phase as usize] += (now - self.since).as_secs_f64();
        (self.since, self.phase) = (now, phase);
    }

    /// The seconds by the names of the phases.
    fn stop(mut self) -> Value {
        self.enter(self.phase);
        let named = Phase::ALL.iter().zip(self.seconds);
        Value::Object(
            named
                .map(|(phase, s)| (phase.name().into(), json!(s)))
                .collect(),
        )
    }
}

/// A line with the progress, if a person is there to see it.
struct Bar {
    shown: Option<u32>,
    is_seen: bool,
}

impl Bar {
    fn new() -> Self {
        Self {
            shown: None,
            is_seen: std::io::stderr().is_terminal(),
        }
    }

    fn show(&mut self, fraction: f32) -> ControlFlow<()> {
        let percent = (100.0 * fraction) as u32;
        if self.is_seen && self.shown != Some(percent) {
            eprint!("\r{percent} %");
            self.shown = Some(percent);
        }
        ControlFlow::Continue(())
    }

    fn clear(&self) {
        if self.shown.is_some() {
            eprint!("\r     \r");
        }
    }
}

/// Returns a mesh under the name of the part of the model that it stands for.
fn part(model: &ModelPart, mesh: TriangleMesh) -> Part {
    let name = model.name.clone();
    Part { name, mesh }
}
