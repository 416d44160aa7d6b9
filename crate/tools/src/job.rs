//! Running jobs.

use crate::fitting;
use crate::message::{
    CoatJob, Coated, Job, MeshFacts, MeshJob, Meshed, Output, RigJob, WriteJob, Written,
};
use crate::view;
use core::ops::ControlFlow;
use mesh::limits::MILLIMETRES;
use mesh::{Aabb, Export, Format, Part, TriangleMesh};

/// Progress of a running job.
pub struct Progress<'a> {
    report: Option<&'a mut dyn FnMut(f32)>,
    pass: Option<&'a mut dyn FnMut(Output)>,
    is_over: Option<&'a mut dyn FnMut() -> bool>,
}

impl<'a> Progress<'a> {
    /// Progress that is passed on to `report`, as a fraction from 0 to 1.
    pub fn new(report: &'a mut dyn FnMut(f32)) -> Self {
        Self {
            report: Some(report),
            pass: None,
            is_over: None,
        }
    }

    /// Results before the end are passed on to `pass`, too.
    #[must_use]
    pub fn passing(self, pass: &'a mut dyn FnMut(Output)) -> Self {
        Self {
            pass: Some(pass),
            ..self
        }
    }

    /// The job ends with an error soon after `is_over` says so. It is asked with every report, at least every tenth of a second or so
    /// while a scene is meshed.
    #[must_use]
    pub fn until(self, is_over: &'a mut dyn FnMut() -> bool) -> Self {
        Self {
            is_over: Some(is_over),
            ..self
        }
    }

    /// Whether the job is to go on.
    pub(crate) fn goes_on(&mut self) -> ControlFlow<()> {
        if self.is_over.as_mut().is_some_and(|is_over| is_over()) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }

    /// Passes on what there is so far.
    pub fn pass(&mut self, output: Output) {
        if let Some(pass) = &mut self.pass {
            pass(output);
        }
    }

    /// Reports the fraction done, 0 … 1. A job that takes more than a few seconds must call this
    /// every few seconds, or its worker is taken for one that hangs.
    pub fn report(&mut self, fraction: f32) {
        if let Some(report) = &mut self.report {
            report(fraction.clamp(0.0, 1.0));
        }
    }

    /// Progress that is not passed on.
    #[must_use]
    pub fn silent() -> Self {
        Self {
            report: None,
            pass: None,
            is_over: None,
        }
    }
}

/// Runs a job to its end.
///
/// # Errors
/// An error message for the user, such as what is wrong with a file.
pub fn run(job: Job, progress: &mut Progress<'_>) -> Result<Output, String> {
    progress.report(0.0);
    match job {
        Job::ReadMesh { name, bytes } => {
            let mesh = mesh::read(&name, &bytes).map_err(|error| error.to_string())?;
            progress.report(0.9);
            Ok(Output::Mesh(mesh))
        }
        Job::ReadMeasured { name, bytes } => {
            let is_outline = bytes.trim_ascii_start().first() == Some(&b'[');
            let read = if is_outline {
                fit::outlines(&bytes).map(|outlines| fit::Observations {
                    points: Vec::new(),
                    sights: fit::sights(&outlines),
                })
            } else {
                fit::cloud(&name, &bytes).map(|points| fit::Observations {
                    points,
                    sights: Vec::new(),
                })
            };
            read.map(Output::Measured)
                .map_err(|error| error.to_string())
        }
        Job::Fit(wanted) => fitting::run(*wanted, progress).map_err(|error| error.to_string()),
        Job::Coat(job) => {
            let CoatJob {
                scene,
                bound,
                mut coatings,
            } = *job;
            let is_sound = bound > 0.0 && bound.is_finite();
            if !is_sound {
                return Err("the bound must be a positive number".into());
            }
            let mut report = |step: mesher::Step| {
                progress.report(step.fraction);
                progress.goes_on()
            };
            let told = &mut mesher::Progress::new(&mut report);
            let bodies = mesher::coat_scene(&scene, bound, &mut coatings, told)
                .map_err(|error| error.to_string())?;
            let parts = bodies.into_iter().map(|body| (body.name, body.coat.mesh));
            Ok(Output::Coated(Box::new(Coated {
                parts: parts.collect(),
                coatings,
            })))
        }
        Job::Mesh(job) => mesh_scene(*job, progress).map(|meshed| Output::Meshed(Box::new(meshed))),
        Job::Write(job) => write(*job).map(Output::Written),
        Job::View(job) => view::run(*job, progress).map(|view| Output::View(Box::new(view))),
    }
}

fn mesh_scene(job: MeshJob, progress: &mut Progress<'_>) -> Result<Meshed, String> {
    let MeshJob {
        scene,
        wishes,
        format,
        name,
        size,
        rig,
    } = job;
    check(size, format, rig.as_ref())?;
    let mut report = |step: mesher::Step| {
        progress.report(0.95 * step.fraction);
        progress.goes_on()
    };
    let model = mesher::mesh_scene(&scene, &wishes, &mut mesher::Progress::new(&mut report))
        .map_err(|error| error.to_string())?;
    let sides = model.bounds().size();
    let millimetres = size / sides.max_element();
    let mut facts = MeshFacts {
        sides: (sides * millimetres).to_array(),
        tolerance: model.tolerance,
        is_closed: model.parts.iter().all(|part| part.is_closed),
        notes: model.notes,
        ..MeshFacts::default()
    };
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
    if progress.goes_on().is_break() {
        return Err(mesher::MeshError::Cancelled.to_string());
    }
    let parts = model.parts.into_iter().map(|part| (part.name, part.mesh));
    let parts: Vec<(String, TriangleMesh)> = parts.collect();
    let (written, parts) = match format {
        None => (Written::default(), parts),
        Some(format) => {
            let export = Export {
                name,
                parts: named(parts),
                millimetres,
            };
            let written = write_export(&export, format, rig.as_ref())?;
            let parts = export.parts.into_iter().map(|part| (part.name, part.mesh));
            (written, parts.collect())
        }
    };
    progress.report(1.0);
    Ok(Meshed {
        written,
        parts,
        facts,
    })
}

/// Tells what is wrong with the wishes for a file.
fn check(size: f64, format: Option<Format>, rig: Option<&RigJob>) -> Result<(), String> {
    let is_sound = MILLIMETRES.contains(&size);
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

fn named(parts: Vec<(String, TriangleMesh)>) -> Vec<Part> {
    let part = |(name, mesh)| Part { name, mesh };
    parts.into_iter().map(part).collect()
}

fn write(job: WriteJob) -> Result<Written, String> {
    let WriteJob {
        parts,
        format,
        name,
        size,
        rig,
    } = job;
    check(size, Some(format), rig.as_ref())?;
    let bounds = parts.iter().map(|(_, mesh)| mesh.bounds());
    let bounds = bounds.fold(Aabb::EMPTY, |all, own| all.union(&own));
    let export = Export {
        name,
        parts: named(parts),
        millimetres: size / bounds.size().max_element(),
    };
    write_export(&export, format, rig.as_ref())
}

fn write_export(
    export: &Export,
    format: Format,
    wanted: Option<&RigJob>,
) -> Result<Written, String> {
    let Some(RigJob { scenes, rate }) = wanted else {
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

    const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";

    fn read(name: &str, text: &str) -> Job {
        Job::ReadMesh {
            name: name.into(),
            bytes: text.into(),
        }
    }

    #[test]
    fn mesh_equals_that_of_a_direct_read() {
        let mut fractions = Vec::new();
        let mut report = |fraction| fractions.push(fraction);
        let output = run(read("a.obj", SQUARE), &mut Progress::new(&mut report));
        let Ok(Output::Mesh(data)) = output else {
            panic!("{output:?}");
        };
        let direct = mesh::read("a.obj", SQUARE.as_bytes()).unwrap();
        assert_eq!(data, direct);
        assert!(fractions.is_sorted() && fractions[0] == 0.0);
    }

    fn ball(radius: f64) -> MeshJob {
        let mut scene = scene::Scene::default();
        scene.flesh.push(scene::Flesh {
            blobbiness: -2.0,
            ..scene::Flesh::default()
        });
        let center = glam::DVec3::ZERO;
        scene.elements.push(scene::Element {
            flesh: Some(0),
            ..scene::Element::new(scene::Shape::Sphere { center, radius })
        });
        MeshJob {
            scene,
            wishes: mesher::Wishes::default(),
            format: Some(mesh::Format::Glb),
            name: "ball".into(),
            size: 50.0,
            rig: None,
        }
    }

    #[test]
    fn scene_becomes_a_file_in_millimetres() {
        let mut fractions = Vec::new();
        let mut report = |fraction| fractions.push(fraction);
        let job = Job::Mesh(Box::new(ball(3.0)));
        let output = run(job, &mut Progress::new(&mut report));
        let Ok(Output::Meshed(meshed)) = output else {
            panic!("{output:?}");
        };
        assert!(fractions.is_sorted());
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
    fn meshing_ends_when_it_is_told_to() {
        let asked = |end: usize| {
            let mut count = 0;
            let mut is_over = || {
                count += 1;
                count > end
            };
            let progress = &mut Progress::silent().until(&mut is_over);
            let result = run(Job::Mesh(Box::new(ball(3.0))), progress);
            (result, count)
        };
        let (whole, all) = asked(usize::MAX);
        assert!(whole.is_ok() && all > 20, "{all}");
        for end in [0, all / 3, all / 2, all - 1] {
            let (result, count) = asked(end);
            assert_eq!(result, Err(String::from("cancelled")));
            assert_eq!(count, end + 1, "it goes on");
        }
    }

    #[test]
    fn mesh_that_is_written_later_is_the_same_file() {
        let meshed = |format| match run(
            Job::Mesh(Box::new(MeshJob {
                format,
                ..ball(3.0)
            })),
            &mut Progress::silent(),
        ) {
            Ok(Output::Meshed(meshed)) => *meshed,
            other => panic!("{other:?}"),
        };
        let (at_once, later) = (meshed(Some(Format::Stl)), meshed(None));
        assert_eq!(later.parts, at_once.parts);
        assert!(later.written.files.is_empty());
        let job = WriteJob {
            parts: later.parts,
            format: Format::Stl,
            name: "ball".into(),
            size: 50.0,
            rig: None,
        };
        let wrong = WriteJob {
            rig: Some(RigJob {
                scenes: vec![ball(3.0).scene],
                rate: 12.0,
            }),
            ..job.clone()
        };
        let written = run(Job::Write(Box::new(job)), &mut Progress::silent());
        assert_eq!(written, Ok(Output::Written(at_once.written)));
        let message = run(Job::Write(Box::new(wrong.clone())), &mut Progress::silent());
        assert!(message.unwrap_err().contains("GLB"));
        let boneless = WriteJob {
            format: Format::Glb,
            ..wrong
        };
        let message = run(Job::Write(Box::new(boneless)), &mut Progress::silent());
        assert!(message.unwrap_err().contains("no skeleton"));
    }

    #[test]
    fn skeletons_are_coated_from_the_last_coating() {
        let coat = |coatings, radius| {
            let job = CoatJob {
                scene: ball(radius).scene,
                bound: 0.02,
                coatings,
            };
            match run(Job::Coat(Box::new(job)), &mut Progress::silent()) {
                Ok(Output::Coated(coated)) => *coated,
                other => panic!("{other:?}"),
            }
        };
        let first = coat(Vec::new(), 1.0);
        let second = coat(first.coatings, 1.01);
        for (coated, radius) in [(first.parts, 1.0), (second.parts, 1.01)] {
            assert_eq!(coated.len(), 1);
            let far = |p: &glam::DVec3| (p.length() - radius).abs() < 0.01;
            assert!(coated[0].1.positions.iter().all(far));
        }
    }

    #[test]
    fn scene_without_a_surface_gives_a_sentence() {
        let mut job = ball(1.0);
        job.scene.elements.clear();
        let message = run(Job::Mesh(Box::new(job)), &mut Progress::silent()).unwrap_err();
        assert!(message.contains("no surface"), "{message}");
    }

    #[test]
    fn measured_files_are_read_by_their_content() {
        let read = |name: &str, text: &str| {
            let job = Job::ReadMeasured {
                name: name.into(),
                bytes: text.into(),
            };
            match run(job, &mut Progress::silent()) {
                Ok(Output::Measured(found)) => Ok([found.points.len(), found.sights.len()]),
                Ok(other) => panic!("{other:?}"),
                Err(message) => Err(message),
            }
        };
        assert_eq!(read("a.xyz", "0 0 1\n1 1 1\n"), Ok([2, 0]));
        let outline = r#"[{"eye":[0,-5,0],"target":[0,0,0],"up":[0,0,1],"fov":40,"size":[9,9],"lines":[[[2,5]]]}]"#;
        assert_eq!(read("a.json", outline), Ok([0, 1]));
        let message = read("a.xyz", "0 0\n").unwrap_err();
        assert!(message.contains("line 1"), "{message}");
    }

    #[test]
    fn broken_file_gives_the_message_of_its_reader() {
        let message = run(read("a.ply", "no"), &mut Progress::silent()).unwrap_err();
        assert_eq!(message, mesh::read("a.ply", b"no").unwrap_err().to_string());
    }
}
