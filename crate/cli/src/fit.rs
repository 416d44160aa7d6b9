//! `sinew fit`: a mesh brought onto measured points and outlines.

use crate::{Outcome, files, whole};
use clap::{ArgGroup, Args, ValueEnum};
use fit::{Controls, Fitted, Kind, Observations, Options, Problem};
use glam::DVec3;
use mesh::{Aabb, Export, Format, Part, TriangleMesh};
use serde_json::json;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Largest file of points or outlines, bytes.
const MAX_BYTES: u64 = 64 * 1024 * 1024;

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Seen {
    /// By its nearest facet
    Explicit,
    /// As balls around its facets
    Spherical,
    /// As shells around its facets
    Triangular,
}

/// `sinew fit MESH --control CAGE --points CLOUD -o OUT`.
#[derive(Args)]
#[command(group(ArgGroup::new("measured").required(true).multiple(true)))]
pub struct Fit {
    /// The mesh
    #[arg(help = format!("The mesh: {}", Format::ENDINGS))]
    mesh: PathBuf,
    /// A mesh around it whose vertices are the control points
    #[arg(long, value_name = "CAGE", required_unless_present_any = ["lattice", "vertices"])]
    control: Option<PathBuf>,
    /// Move it by a lattice in its box instead, with these numbers of nodes along x, y and z
    #[arg(long, value_name = "X,Y,Z", value_parser = three)]
    #[arg(conflicts_with_all = ["control", "vertices"])]
    lattice: Option<[usize; 3]>,
    /// Move each of its vertices by itself instead
    #[arg(long, conflicts_with = "control")]
    vertices: bool,
    /// Measured points: .ply or .xyz
    #[arg(long, value_name = "CLOUD", group = "measured")]
    points: Option<PathBuf>,
    /// Outlines in pictures, as `sinew scan` writes them: .json
    #[arg(long, value_name = "FILE", group = "measured")]
    silhouettes: Option<PathBuf>,
    /// Implicit surface of the mesh
    #[arg(long, default_value = "triangular")]
    kind: Seen,
    /// Thickness of triangular shells, in the mesh's units; the default is a tenth of 1/k
    #[arg(long, value_name = "D")]
    thickness: Option<f64>,
    /// k of the implicit surface at the end; the default is 20 over the mean edge
    #[arg(long, value_name = "K")]
    slope: Option<f64>,
    /// Weight of smoothness; at 1 it counts as much as all measurements
    #[arg(long, default_value_t = 0.02, value_name = "L")]
    smooth: f64,
    /// Weight of the outlines beside the points
    #[arg(long, default_value_t = 1.0, value_name = "W")]
    outlines: f64,
    /// First turn and move the whole mesh onto the points; without it this is tried where the fit
    /// fails, or comes much nearer so
    #[arg(long)]
    align: bool,
    /// Most iterations
    #[arg(long, default_value_t = 100, value_name = "N")]
    iterations: usize,
    /// The files to write
    #[arg(short, long, required = true, value_name = "OUT", help = format!(
        "The file to write: a dataset with `deform` lines (.rat) or the deformed mesh ({}); \
         may be given for each",
        Format::ENDINGS
    ))]
    output: Vec<PathBuf>,
    /// Print numbers of the fit as JSON on the standard output
    #[arg(long)]
    json: bool,
}

impl Fit {
    /// Fits, prints the progress, and writes the result.
    pub fn run(&self) -> Outcome {
        let outputs: Vec<Target> = self
            .output
            .iter()
            .map(|path| Target::of(path))
            .collect::<Result<_, _>>()?;
        let mesh = read_mesh(&self.mesh)?;
        let by = match (&self.control, self.lattice) {
            (Some(cage), _) => Controls::Cage(read_mesh(cage)?),
            (None, Some(counts)) => Controls::Lattice(counts),
            (None, None) => Controls::Vertices,
        };
        let mut observations = Observations::default();
        if let Some(path) = &self.points {
            let name = path.display().to_string();
            observations.points =
                fit::cloud(&name, &read(path)?).map_err(|e| format!("{name}: {e}"))?;
        }
        let mut views = Vec::new();
        if let Some(path) = &self.silhouettes {
            views = fit::outlines(&read(path)?).map_err(|e| format!("{}: {e}", path.display()))?;
            observations.sights = fit::sights(&views);
        }
        let remarks =
            fit::remarks(&mesh).map_err(|error| format!("{}: {error}", self.mesh.display()))?;
        for remark in &remarks {
            eprintln!("{}: {remark}", self.mesh.display());
        }
        let edge = fit::mean_edge(&mesh.positions, &mesh.triangles);
        let slope = self.slope.unwrap_or(20.0 / edge);
        let thickness = self.thickness.unwrap_or(0.1 / slope);
        let options = Options {
            kind: match self.kind {
                Seen::Explicit => Kind::Explicit,
                Seen::Spherical => Kind::Spherical,
                Seen::Triangular => Kind::Triangular { thickness },
            },
            slope: Some(slope),
            smooth: self.smooth,
            outlines: self.outlines,
            align: self.align,
            iterations: self.iterations,
            ..Options::default()
        };
        let counts = [observations.points.len(), observations.sights.len()];
        let problem =
            Problem::with(&mesh, by.clone(), observations, options).map_err(|e| e.to_string())?;
        let start = Instant::now();
        let fitted = fit::fit(&problem, &mut |progress| {
            if !self.json {
                eprintln!(
                    "iteration {}: residual {:.4e}, scale {:.2e}",
                    progress.iteration, progress.residual, progress.scale
                );
            }
            true
        })
        .map_err(|error| error.to_string())?;
        let seconds = start.elapsed().as_secs_f64();
        for output in &outputs {
            match output {
                Target::Mesh(path, format) => write_mesh(path, *format, &mesh, &fitted)?,
                Target::Dataset(path) => {
                    let (name, lines) = if let Controls::Cage(cage) = &by {
                        let places = &cage.positions;
                        let lines = fit::deform_lines(None, &fitted.rigid, places, &fitted.moves);
                        (beside(path, &self.mesh)?, lines)
                    } else {
                        // The language has no such deformations: the mesh itself is written.
                        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
                        let name = plain_name(&format!("{stem}-fitted.obj"));
                        let place = path.with_file_name(&name);
                        if let (Ok(a), Ok(b)) = (place.canonicalize(), self.mesh.canonicalize())
                            && a == b
                        {
                            return Err(format!(
                                "{} would be written over: write the dataset elsewhere",
                                place.display()
                            ));
                        }
                        write_mesh(&place, Format::Obj, &mesh, &fitted)?;
                        (name, String::new())
                    };
                    let text = self.dataset(&name, &fitted, &views, [slope, thickness]) + &lines;
                    whole::write(path, |out| {
                        out.write_all(text.as_bytes()).map_err(|e| e.to_string())
                    })?;
                }
            }
        }
        if self.json {
            let (axis, angle) = fitted.rigid.axis_angle();
            let summary = json!({
                "mesh": {
                    "vertices": mesh.positions.len(),
                    "triangles": mesh.triangles.len(),
                    "mean_edge": edge,
                },
                "controls": fitted.moves.len(),
                "points": counts[0],
                "sights": counts[1],
                "remarks": remarks,
                "iterations": fitted.last.iteration,
                "residual": fitted.last.residual,
                "outliers": fitted.last.outliers,
                "left_out": fitted.left_out,
                "failure": fitted.failure,
                "turn": { "axis": axis.to_array(), "angle": angle },
                "shift": fitted.rigid.shift.to_array(),
                "moves": fitted.moves.iter().map(|m| m.to_array()).collect::<Vec<_>>(),
                "seconds": seconds,
            });
            println!("{summary}");
        } else {
            eprintln!(
                "{} points and {} lines of sight: residual {:.4e} after {} iterations, {:.0} % \
                 outliers, {seconds:.2} s",
                counts[0],
                counts[1],
                fitted.last.residual,
                fitted.last.iteration,
                100.0 * fitted.last.outliers
            );
        }
        if let Some(failure) = &fitted.failure {
            eprintln!("the fit failed: {failure}; the best that was found is written all the same");
        }
        Ok(fitted.failure.is_none())
    }

    /// The dataset: a camera and the mesh, as far as the lines that deform it.
    fn dataset(
        &self,
        name: &str,
        fitted: &Fitted,
        views: &[fit::Outline],
        [slope, thickness]: [f64; 2],
    ) -> String {
        let mut text = format!(
            "# {} fitted by `sinew fit`: residual {:.4e} after {} iterations\n\n",
            name, fitted.last.residual, fitted.last.iteration
        );
        text += &view(&fitted.positions, views);
        text += "surface Skin, diffuse NavajoWhite, specular Gray20, shine 20\n\n";
        text += &format!("mesh Skin {name}");
        match self.kind {
            Seen::Explicit => text.push('\n'),
            Seen::Spherical => text += &format!("   # metaballs spherical {slope:.4}\n"),
            Seen::Triangular => {
                text += &format!("   # metaballs triangular {thickness:.6} {slope:.4}\n");
            }
        }
        text
    }
}

/// Reads three numbers with commas between them.
fn three(text: &str) -> Result<[usize; 3], String> {
    let numbers: Result<Vec<usize>, _> = text.split(',').map(|word| word.trim().parse()).collect();
    numbers
        .ok()
        .and_then(|numbers| numbers.try_into().ok())
        .ok_or_else(|| String::from("three whole numbers are expected, such as 4,4,5"))
}

/// A file to write.
enum Target<'a> {
    Dataset(&'a Path),
    Mesh(&'a Path, Format),
}

impl<'a> Target<'a> {
    fn of(path: &'a Path) -> Result<Self, String> {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        if path
            .extension()
            .is_some_and(|e| e.eq_ignore_ascii_case("rat"))
        {
            return Ok(Self::Dataset(path));
        }
        Format::of_name(&name)
            .map(|format| Self::Mesh(path, format))
            .ok_or_else(|| {
                format!(
                    "{name}: the result is a dataset (.rat) or a mesh ({})",
                    Format::ENDINGS
                )
            })
    }
}

/// A file of points or outlines.
fn read(path: &Path) -> Result<Vec<u8>, String> {
    files::read_bounded(path, MAX_BYTES)
}

fn read_mesh(path: &Path) -> Result<TriangleMesh, String> {
    let bytes = files::read_bounded(path, mesh::limits::MAX_BYTES as u64)?;
    let name = path.display().to_string();
    mesh::read(&name, &bytes).map_err(|error| format!("{name}: {error}"))
}

/// Returns a file's name as datasets write it.
fn plain_name(name: &str) -> String {
    name.replace(|c: char| !c.is_alphanumeric() && !"._-+".contains(c), "_")
}

/// Returns the name of the mesh for a dataset, which takes files from its own folder only and names
/// of letters, digits and `._-+`: a mesh of elsewhere or of another name is copied there.
fn beside(dataset: &Path, mesh: &Path) -> Result<String, String> {
    let folder = match dataset.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    };
    let name = plain_name(&mesh.file_name().unwrap_or_default().to_string_lossy());
    let place = folder.join(&name);
    if let (Ok(a), Ok(b)) = (place.canonicalize(), mesh.canonicalize())
        && a == b
    {
        return Ok(name);
    }
    if place.exists() {
        return Err(format!(
            "{} names `{name}` of its own folder, and another file of this name is there already; \
             write the dataset elsewhere",
            dataset.display()
        ));
    }
    std::fs::copy(mesh, &place).map_err(|error| {
        format!(
            "cannot copy {} to {}: {error}",
            mesh.display(),
            place.display()
        )
    })?;
    Ok(name)
}

/// Camera and lights that show what was fitted: the camera of the first outline, or one that sees
/// all of it, with its longest side upright or, if that is the x axis, across.
fn view(positions: &[DVec3], views: &[fit::Outline]) -> String {
    let bounds = Aabb::of_points(positions.iter().copied());
    let (middle, size) = (bounds.center(), bounds.size());
    let (eye, target, up, fov, frame);
    if let Some(view) = views.first() {
        (eye, target, up) = (
            DVec3::from_array(view.eye),
            DVec3::from_array(view.target),
            DVec3::from_array(view.up),
        );
        (fov, frame) = (view.fov, view.size.map(|s| s.clamp(1.0, 4096.0).round()));
    } else {
        let z_is_up = size.z >= size.y;
        up = if z_is_up { DVec3::Z } else { DVec3::Y };
        let forward = if z_is_up {
            DVec3::new(0.5, -1.0, 0.3)
        } else {
            DVec3::new(0.5, 0.3, 1.0)
        };
        let distance = 0.5 * size.length() / libm::sin(15_f64.to_radians());
        (eye, target) = (middle + forward.normalize() * distance, middle);
        (fov, frame) = (32.0, [480.0, 480.0]);
    }
    let right = (target - eye).cross(up).normalize_or(DVec3::X);
    let lamp = eye + (up - 0.7 * right) * eye.distance(target);
    let other = right + 0.3 * up;
    let [eye, target, up, lamp, direction] =
        [eye, target, up, lamp, -other].map(|v| format!("{:.4} {:.4} {:.4}", v.x, v.y, v.z));
    format!(
        "framesize {} {}\neyep {eye}\nvrp {target}\nvup {up}\nfov {fov}\n\
         background 0.06 0.07 0.09\nlight White, position {lamp}, intensity 0.9\n\
         light LightSteelBlue, distant, direction {direction}, intensity 0.35, noshadow\n\n",
        frame[0], frame[1],
    )
}

/// Writes the deformed mesh in the units of the fit.
fn write_mesh(
    path: &Path,
    format: Format,
    mesh: &TriangleMesh,
    fitted: &Fitted,
) -> Result<(), String> {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let moved = TriangleMesh {
        positions: fitted.positions.clone(),
        normals: None,
        ..mesh.clone()
    };
    let export = Export {
        name: stem.into_owned(),
        parts: vec![Part {
            name: String::from("fitted"),
            mesh: moved,
        }],
        millimetres: 1.0,
    };
    let written = export.write(format).map_err(|error| error.to_string())?;
    for file in written {
        whole::write(&path.with_file_name(&file.name), |out| {
            out.write_all(&file.bytes).map_err(|e| e.to_string())
        })?;
    }
    Ok(())
}
