//! The jobs of meshing a scene for files, and of writing the mesh to them.

use crate::job::{Job, Pace, Progress};
use mesh::limits::MILLIMETRES;
use mesh::{Aabb, Export, ExportedFile, Format, Part, TriangleMesh};
use mesher::{Model, Wishes};
use scene::Scene;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Share of meshing in the time of a [`MeshScene`]; the rest is writing the file.
const MESHING: f32 = 0.95;

/// Meshes a scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MeshScene {
    /// The scene.
    pub scene: Arc<Scene>,
    /// Tolerance, union and the like.
    pub wishes: Wishes,
    /// Format of the file; `None` if only the preview is wanted.
    pub format: Option<Format>,
    /// Name of the file without its ending.
    pub name: String,
    /// Length of the model's longest side in the file, millimetres; 0: a unit of the scene is one.
    pub size: f64,
    /// Joints for the file, if it is GLB.
    pub rig: Option<Poses>,
}

/// The scenes that joints and their motion come from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Poses {
    /// The scene that is meshed, and those of the frames after it, of which [`rig::skeletons_of`]
    /// is enough.
    pub scenes: Vec<Scene>,
    /// Frames of a second.
    pub rate: f64,
}

/// Writes a mesh that was made before to a file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct WriteMesh {
    /// The parts with their names, as [`Meshed::parts`].
    pub parts: Vec<(String, TriangleMesh)>,
    /// Format of the file.
    pub format: Format,
    /// Name of the file without its ending.
    pub name: String,
    /// Length of the longest side of all parts' box in the file, millimetres; 0: a unit of the
    /// scene is one.
    pub size: f64,
    /// Joints for the file, if it is GLB.
    pub rig: Option<Poses>,
}

/// The files of a mesh.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Written {
    /// The files: one, or two for OBJ with materials.
    pub files: Vec<ExportedFile>,
    /// Joints of the rig.
    pub joints: usize,
    /// Frames of its motion.
    pub frames: usize,
}

/// A scene's mesh as files and for the eye.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Meshed {
    /// The files; none if no format was wanted.
    pub written: Written,
    /// The parts with their names, in units of the scene.
    pub parts: Vec<(String, TriangleMesh)>,
    /// Facts of all parts together.
    pub facts: MeshFacts,
}

/// Facts of a mesh.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MeshFacts {
    /// Number of triangles.
    pub triangles: usize,
    /// Number of vertices.
    pub vertices: usize,
    /// Whether all parts are closed.
    pub is_closed: bool,
    /// Connected shells of the closed parts.
    pub shells: usize,
    /// Volume of the closed parts, cubic millimetres; parts that overlap count twice.
    pub volume: f64,
    /// Lengths of the box's sides, millimetres.
    pub sides: [f64; 3],
    /// Tolerance that was asked for, in units of the scene.
    pub tolerance: f64,
    /// Whether the error of some part was only measured.
    pub is_measured: bool,
    /// Largest distance between mesh and surface, millimetres: proved, but for the triangles that
    /// are not, or measured.
    pub error: f64,
    /// Largest distance that samples found, either way, millimetres.
    pub measured: f64,
    /// Number of those samples.
    pub samples: usize,
    /// Cells in which the topology is not proved.
    pub undecided: usize,
    /// Triangles whose distance is not proved.
    pub unproved: usize,
    /// Pairs of triangles that cut each other.
    pub crossings: usize,
    /// Sentences for the user.
    pub notes: Vec<String>,
}

impl MeshFacts {
    /// Returns the facts of a model whose unit of length is `millimetres` long in the file.
    fn of(model: &Model, millimetres: f64) -> Self {
        let mut facts = Self {
            sides: (model.bounds().size() * millimetres).to_array(),
            tolerance: model.tolerance,
            is_closed: model.parts.iter().all(|part| part.is_closed),
            is_measured: model.parts.iter().any(|part| part.is_measured),
            notes: model.notes.clone(),
            ..Self::default()
        };
        let shift = mesh::shift_of(&model.bounds(), millimetres);
        facts.notes.extend(mesh::describe_shift(shift));
        for part in &model.parts {
            facts.triangles += part.mesh.triangles.len();
            facts.vertices += part.mesh.positions.len();
            facts.error = facts.error.max(part.error * millimetres);
            let [there, back] = part.measured.largest;
            facts.measured = facts.measured.max(there.max(back) * millimetres);
            facts.samples += part.measured.samples.iter().sum::<usize>();
            facts.undecided += part.undecided.len();
            facts.unproved += part.unproved;
            facts.crossings += part.crossings;
            if part.is_closed {
                let growth = millimetres * millimetres * millimetres;
                facts.volume += part.mesh.signed_volume() * growth;
                facts.shells += mesh::Topology::of(&part.mesh).map_or(0, |t| t.genera.len());
            }
        }
        facts
    }
}

impl Job for MeshScene {
    type Output = Meshed;
    const PACE: Pace = Pace::Long;

    fn run(self, progress: &mut Progress<'_, Meshed>) -> Result<Meshed, String> {
        let Self {
            scene,
            wishes,
            format,
            name,
            size,
            rig,
        } = self;
        check(size, format, rig.as_ref())?;
        let model = mesher::mesh_scene(
            &scene,
            &wishes,
            &mut mesher::Progress::new(&mut |step| progress.report(MESHING * step.fraction)),
        )
        .map_err(|error| error.to_string())?;
        let millimetres = unit(size, &model.bounds());
        let facts = MeshFacts::of(&model, millimetres);
        if progress.report(MESHING).is_break() {
            return Err(mesher::MeshError::Cancelled.to_string());
        }
        let parts = model.parts.into_iter().map(|part| (part.name, part.mesh));
        let parts: Vec<(String, TriangleMesh)> = parts.collect();
        let (written, parts) = match format {
            None => (Written::default(), parts),
            Some(format) => {
                let export = Export {
                    name,
                    parts: file_parts(parts),
                    millimetres,
                };
                let written = write_export(&export, format, rig.as_ref())?;
                let parts = export.parts.into_iter().map(|part| (part.name, part.mesh));
                (written, parts.collect())
            }
        };
        Ok(Meshed {
            written,
            parts,
            facts,
        })
    }
}

impl Job for WriteMesh {
    type Output = Written;
    const PACE: Pace = Pace::Long;

    fn run(self, _: &mut Progress<'_, Written>) -> Result<Written, String> {
        let Self {
            parts,
            format,
            name,
            size,
            rig,
        } = self;
        check(size, Some(format), rig.as_ref())?;
        let bounds = parts.iter().map(|(_, mesh)| mesh.bounds());
        let bounds = bounds.fold(Aabb::EMPTY, |all, own| all.union(&own));
        let export = Export {
            name,
            parts: file_parts(parts),
            millimetres: unit(size, &bounds),
        };
        write_export(&export, format, rig.as_ref())
    }
}

/// Returns the millimetres of a scene's unit where its longest side has so many, or 0 for one each.
fn unit(size: f64, bounds: &Aabb) -> f64 {
    if size > 0.0 {
        size / bounds.size().max_element()
    } else {
        1.0
    }
}

/// Checks the wishes for a file.
fn check(size: f64, format: Option<Format>, rig: Option<&Poses>) -> Result<(), String> {
    let is_sound = size == 0.0 || MILLIMETRES.contains(&size);
    if !is_sound {
        return Err(format!(
            "the size must be a number of millimetres from {:e} to {:e}",
            MILLIMETRES.start(),
            MILLIMETRES.end()
        ));
    }
    if rig.is_some() && format != Some(Format::Glb) {
        return Err("joints are written to GLB files only".into());
    }
    Ok(())
}

/// Turns named meshes into the parts of a file.
fn file_parts(parts: Vec<(String, TriangleMesh)>) -> Vec<Part> {
    let parts = parts.into_iter();
    parts.map(|(name, mesh)| Part { name, mesh }).collect()
}

/// Writes a file, with joints and their motion if there are `poses`.
fn write_export(export: &Export, format: Format, poses: Option<&Poses>) -> Result<Written, String> {
    let Some(Poses { scenes, rate }) = poses else {
        let files = export.write(format).map_err(|error| error.to_string())?;
        return Ok(Written {
            files,
            ..Written::default()
        });
    };
    let Some(first) = scenes.first() else {
        return Err("there is no scene to rig".into());
    };
    // A file has shares for the parts that have triangles.
    let parts = export.parts.iter();
    let parts = parts.filter(|part| !part.mesh.triangles.is_empty());
    let meshes: Vec<(Option<u32>, &TriangleMesh)> = parts
        .map(|part| (rig::body_of(first, &part.name), &part.mesh))
        .collect();
    let rig = rig::rig(scenes, *rate, &meshes)?;
    let file = export
        .write_rigged(&rig)
        .map_err(|error| error.to_string())?;
    Ok(Written {
        files: vec![file],
        joints: rig.joints.len(),
        frames: rig.frames.len(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::News;
    use crate::coating::ball;
    use core::ops::ControlFlow;

    fn mesh_ball() -> MeshScene {
        MeshScene {
            scene: ball(3.0),
            wishes: Wishes::default(),
            format: Some(Format::Glb),
            name: "ball".into(),
            size: 50.0,
            rig: None,
        }
    }

    #[test]
    fn scene_becomes_a_file_in_millimetres() {
        let mut fractions = Vec::new();
        let meshed = mesh_ball().run(&mut Progress::new(&mut |news| {
            if let News::Fraction(fraction) = news {
                fractions.push(fraction);
            }
            ControlFlow::Continue(())
        }));
        let meshed = meshed.unwrap();
        assert!(fractions.is_sorted() && fractions.len() > 20);
        let MeshFacts { volume, sides, .. } = meshed.facts;
        let whole = core::f64::consts::PI / 6.0 * 50.0 * 50.0 * 50.0;
        assert!((volume / whole - 1.0).abs() < 0.01, "{volume} {whole}");
        assert!(
            sides.iter().all(|side| (side - 50.0).abs() < 0.5),
            "{sides:?}"
        );
        assert!(meshed.facts.is_closed && meshed.facts.shells == 1 && meshed.facts.unproved == 0);
        assert_eq!(meshed.written.files[0].name, "ball.glb");
        let again = mesh::read("ball.glb", &meshed.written.files[0].bytes).unwrap();
        assert_eq!(again.triangles.len(), meshed.facts.triangles);
    }

    #[test]
    fn meshing_ends_on_request() {
        fn run(end: usize) -> (Result<Meshed, String>, usize) {
            let mut count = 0;
            let result = mesh_ball().run(&mut Progress::new(&mut |_| {
                count += 1;
                if count > end {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(())
                }
            }));
            (result, count)
        }
        let (whole, all) = run(usize::MAX);
        assert!(whole.is_ok() && all > 20, "{all}");
        for end in [0, all / 3, all / 2, all - 1] {
            let (result, count) = run(end);
            assert_eq!(result, Err(String::from("cancelled")));
            assert_eq!(count, end + 1, "it goes on");
        }
    }

    #[test]
    fn mesh_that_is_written_later_is_the_same_file() {
        let [at_once, later] = [Some(Format::Stl), None].map(|format| {
            let job = MeshScene {
                format,
                ..mesh_ball()
            };
            job.run(&mut Progress::silent()).unwrap()
        });
        assert_eq!(later.parts, at_once.parts);
        assert!(later.written.files.is_empty());
        let job = WriteMesh {
            parts: later.parts,
            format: Format::Stl,
            name: "ball".into(),
            size: 50.0,
            rig: None,
        };
        let wrong = WriteMesh {
            rig: Some(Poses {
                scenes: vec![Arc::unwrap_or_clone(ball(3.0))],
                rate: 12.0,
            }),
            ..job.clone()
        };
        let written = job.run(&mut Progress::silent());
        assert_eq!(written, Ok(at_once.written));
        let message = wrong.clone().run(&mut Progress::silent());
        assert!(message.unwrap_err().contains("GLB"));
        let boneless = WriteMesh {
            format: Format::Glb,
            ..wrong
        };
        let message = boneless.run(&mut Progress::silent());
        assert!(message.unwrap_err().contains("no skeleton"));
    }

    #[test]
    fn scene_without_a_surface_gives_a_sentence() {
        let mut job = mesh_ball();
        Arc::make_mut(&mut job.scene).elements.clear();
        let message = job.run(&mut Progress::silent()).unwrap_err();
        assert!(message.contains("no surface"), "{message}");
    }
}
