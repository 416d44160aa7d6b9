//! `sinew sculpt`: the strokes of a text, carried out to a mesh.

use crate::{Outcome, files, whole};
use clap::Args;
use codespan_reporting::diagnostic::{Diagnostic as Shown, Label};
use codespan_reporting::files::SimpleFile;
use codespan_reporting::term::{Config, emit_to_string};
use mesh::{Export, Format, Part, TriangleMesh};
use sculpt::{Clay, Diagnostic, Script, Stroke, limits, replay};
use std::io::Write as _;
use std::path::{Path, PathBuf};

/// `sinew sculpt FILE.strokes [-o OUT] [--stages] [--until STAGE] [--size MM]`.
#[derive(Args)]
pub struct Sculpt {
    /// The strokes
    file: PathBuf,
    /// File for the mesh
    #[arg(short, long, help = format!("File for the mesh: {}", Format::ENDINGS))]
    output: Option<PathBuf>,
    /// Write a mesh for each stage, too: OUT-1.ply, OUT-2.ply …
    #[arg(long, requires = "output")]
    stages: bool,
    /// Stop at the stage of this name or number
    #[arg(long, value_name = "STAGE")]
    until: Option<String>,
    /// Length of the mesh's longest side, millimetres
    #[arg(long, default_value_t = 100.0, value_name = "MM")]
    size: f64,
}

impl Sculpt {
    /// Replays the strokes, tells each stage, and writes the mesh. False if the text has errors.
    pub fn run(&self) -> Outcome {
        if !(self.size.is_finite() && self.size > 0.0) {
            return Err(String::from("--size must be more than 0 millimetres"));
        }
        let output = self.output.as_deref().map(Output::new).transpose()?;
        let text = files::read(&self.file)?;
        let mut script = match Script::parse(&text) {
            Ok(script) => script,
            Err(problems) => {
                problems
                    .iter()
                    .for_each(|problem| self.show(&text, problem));
                return Ok(false);
            }
        };
        if let Some(stage) = &self.until {
            stop_at(&mut script, stage)?;
        }
        let mut stages = Vec::new();
        let load = &mut |name: &str| self.load(name);
        let replayed = replay(&script, load, limits::MAX_WORK, |_, stroke, clay| {
            if let Stroke::Stage(name) = stroke {
                tell(&format!("{}. {name}", stages.len() + 1), clay);
                let kept = self.stages.then(|| clay.to_triangles());
                stages.push(kept.transpose());
            }
        });
        let clay = match replayed {
            Ok(clay) => clay,
            Err(problem) => {
                self.show(&text, &problem);
                return Ok(false);
            }
        };
        tell("the mesh", &clay);
        let Some(output) = output else {
            return Ok(true);
        };
        let mesh = clay.to_triangles().map_err(|error| error.to_string())?;
        // All stages are to the same scale.
        let millimetres = self.size / longest_side(&mesh);
        for (number, stage) in (1..).zip(stages) {
            if let Some(stage) = stage.map_err(|error| error.to_string())? {
                output.write(&format!("-{number}"), stage, millimetres)?;
            }
        }
        output.write("", mesh, millimetres)?;
        Ok(true)
    }

    /// The mesh of a file in the folder of the strokes.
    fn load(&self, name: &str) -> Result<TriangleMesh, String> {
        let folder = self.file.parent().unwrap_or(Path::new(""));
        let path = files::inside(folder, name)
            .ok_or_else(|| format!("`{name}` is not in the folder of the strokes"))?;
        let size =
            std::fs::metadata(&path).map_err(|error| format!("cannot open {name}: {error}"))?;
        if size.len() > mesh::limits::MAX_BYTES as u64 {
            return Err(format!("{name} has {} bytes, too many", size.len()));
        }
        let bytes = std::fs::read(&path).map_err(|error| format!("cannot read {name}: {error}"))?;
        mesh::read(name, &bytes).map_err(|error| format!("{name}: {error}"))
    }

    fn show(&self, text: &str, problem: &Diagnostic) {
        let file = SimpleFile::new(self.file.display().to_string(), text);
        let label = Label::primary((), problem.span.clone());
        let shown = Shown::error()
            .with_message(&problem.message)
            .with_labels(vec![label]);
        let mut words = String::new();
        match emit_to_string(&mut words, &Config::default(), &file, &shown) {
            Ok(()) => eprint!("{words}"),
            Err(_) => eprintln!("{}: {problem}", self.file.display()),
        }
    }
}

/// Leaves out the strokes after a stage.
fn stop_at(script: &mut Script, stage: &str) -> Result<(), String> {
    let wanted = stage.parse::<usize>().ok();
    let mut number = 0;
    let at = script.strokes.iter().position(|stroke| match stroke {
        Stroke::Stage(name) => {
            number += 1;
            name == stage || wanted == Some(number)
        }
        _ => false,
    });
    let Some(at) = at else {
        return Err(format!("there is no stage `{stage}`; there are {number}"));
    };
    script.strokes.truncate(at + 1);
    Ok(())
}

fn tell(name: &str, clay: &Clay) {
    let mesh = clay.mesh();
    let holes = match mesh.boundary_loops().len() {
        0 => String::from("closed"),
        1 => String::from("1 hole"),
        count => format!("{count} holes"),
    };
    let bounds = mesh::Aabb::of_points(mesh.vertices().map(|v| mesh.position(v)));
    let [x, y, z] =
        [0, 1, 2].map(|axis| format!("{:.3} … {:.3}", bounds.min[axis], bounds.max[axis]));
    eprintln!(
        "{name}: {} vertices, {} faces, {} edges, {holes}; x {x}, y {y}, z {z}",
        mesh.vertex_count(),
        mesh.face_count(),
        mesh.edge_count(),
    );
}

fn longest_side(mesh: &TriangleMesh) -> f64 {
    let bounds = mesh::Aabb::of_points(mesh.positions.iter().copied());
    (bounds.max - bounds.min)
        .max_element()
        .max(f64::MIN_POSITIVE)
}

/// The files to which meshes are written.
struct Output<'a> {
    path: &'a Path,
    format: Format,
}

impl<'a> Output<'a> {
    fn new(path: &'a Path) -> Result<Self, String> {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let format = Format::of_name(&name)
            .ok_or_else(|| format!("{name}: a mesh is written to a file {}", Format::ENDINGS))?;
        Ok(Self { path, format })
    }

    /// Writes a mesh under the path's name with something added.
    fn write(&self, added: &str, mesh: TriangleMesh, millimetres: f64) -> Result<(), String> {
        let stem = self.path.file_stem().unwrap_or_default().to_string_lossy();
        let name = format!("{stem}{added}");
        let export = Export {
            name: name.clone(),
            parts: vec![Part { name, mesh }],
            millimetres,
        };
        let written = export
            .write(self.format)
            .map_err(|error| error.to_string())?;
        for file in written {
            let path = self.path.with_file_name(&file.name);
            whole::write(&path, |out| {
                out.write_all(&file.bytes)
                    .map_err(|error| error.to_string())
            })?;
        }
        Ok(())
    }
}
