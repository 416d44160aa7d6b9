//! Messages between the page and the tools worker: plain data, packed as bytes.

use fit::{Observations, Options};
use glam::DVec3;
use mesh::{ExportedFile, Format, TriangleMesh};
use mesher::{Coating, Wishes};
use scene::Scene;
use serde::{Deserialize, Serialize, de::DeserializeOwned};

/// Work for the tools worker.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Job {
    /// Read a mesh from an OBJ, PLY, STL or GLB file.
    ReadMesh {
        /// The file's name, whose ending says the format where the content does not.
        name: String,
        /// The file's content.
        // Copied as a whole, not byte by byte.
        #[serde(with = "serde_bytes")]
        bytes: Vec<u8>,
    },
    /// Read measured points from a PLY or XYZ file, or outlines from a JSON file.
    ReadMeasured {
        /// The file's name.
        name: String,
        /// The file's content.
        #[serde(with = "serde_bytes")]
        bytes: Vec<u8>,
    },
    /// Fit a mesh to measured points and outlines. Every iteration passes on an [`Output::Fit`].
    Fit(Box<FitJob>),
    /// Mesh a scene.
    Mesh(Box<MeshJob>),
    /// Write a mesh that was made before to a file.
    Write(Box<WriteJob>),
    /// Coat the skeletons of a scene.
    Coat(Box<CoatJob>),
    /// Mesh the soft surfaces of a scene for the eye.
    View(Box<ViewJob>),
}

/// A mesh to fit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FitJob {
    /// The mesh's vertices.
    pub positions: Vec<DVec3>,
    /// Its triangles.
    pub triangles: Vec<[u32; 3]>,
    /// Its control points.
    pub controls: Controls,
    /// What it is fitted to.
    pub observations: Observations,
    /// How.
    pub options: Options,
}

/// The control points of a fit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Controls {
    /// These, each with the move that the fit begins with.
    Given(Vec<[DVec3; 2]>),
    /// About so many around the mesh.
    Around(u32),
}

/// A moment of a fit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FitStep {
    /// Iterations done.
    pub iteration: u32,
    /// As [`fit::Progress::residual`].
    pub residual: f64,
    /// As [`fit::Progress::outliers`].
    pub outliers: f64,
    /// The lines of a text that carry the fit out.
    pub text: String,
}

/// A scene whose skeletons are to be coated, while a hand drags them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CoatJob {
    /// The scene.
    pub scene: Scene,
    /// Largest |f − T| in the middle of an edge.
    pub bound: f64,
    /// What the last job gave, to start from; empty at first.
    pub coatings: Vec<Coating>,
}

/// The coatings of a scene.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Coated {
    /// A mesh for each body with its name, in units of the scene.
    pub parts: Vec<(String, TriangleMesh)>,
    /// For the next job.
    pub coatings: Vec<Coating>,
}

/// The closeness of the mesh of a [`ViewJob`] to the surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Detail {
    /// As near as can be had while a hand moves.
    Coarse,
    /// As near as the eye sees.
    Fine,
}

/// A scene whose soft surfaces are to be seen while a hand moves.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ViewJob {
    /// The scene.
    pub scene: Scene,
    /// For each of its finishes the parameters that the view shows, 0 … 1, which are mixed by the shares of the elements: ambient,
    /// diffuse and specular colours, and the shine.
    pub looks: Vec<[f32; 10]>,
    /// The closeness wanted.
    pub detail: Detail,
}

/// A mesh for the eye: bytes as a GPU takes them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ViewMesh {
    /// The origin of the vertices' positions in the scene.
    pub origin: DVec3,
    /// Length of a unit of their positions.
    pub unit: f64,
    /// [`ViewMesh::VERTEX`] bytes each: position (three `f32`), normal (four `i16`, parts of 32767, the last one 0), then parts of 255:
    /// the ambient colour and the shine, the diffuse colour and 1, the specular colour and 1.
    #[serde(with = "serde_bytes")]
    pub vertices: Vec<u8>,
    /// Three `u32` a triangle.
    #[serde(with = "serde_bytes")]
    pub triangles: Vec<u8>,
}

impl ViewMesh {
    /// Bytes of a vertex.
    pub const VERTEX: usize = 32;
}

/// A scene to be meshed, and what is wanted of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MeshJob {
    /// The scene.
    pub scene: Scene,
    /// Tolerance, union and the like.
    pub wishes: Wishes,
    /// Format of the file; `None` if only the preview is wanted.
    pub format: Option<Format>,
    /// Name of the file without its ending.
    pub name: String,
    /// Length of the model's longest side in the file, millimetres.
    pub size: f64,
    /// Joints for the file, if it is GLB.
    pub rig: Option<RigJob>,
}

/// The scenes that joints and their motion come from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RigJob {
    /// The scene that was meshed, and those of the frames after it, of which [`rig::skeletons_of`] is enough.
    pub scenes: Vec<Scene>,
    /// Frames of a second.
    pub rate: f64,
}

/// A mesh to be written to a file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct WriteJob {
    /// The parts with their names, as [`Meshed::parts`].
    pub parts: Vec<(String, TriangleMesh)>,
    /// Format of the file.
    pub format: Format,
    /// Name of the file without its ending.
    pub name: String,
    /// Length of the longest side of all parts' box in the file, millimetres.
    pub size: f64,
    /// Joints for the file, if it is GLB.
    pub rig: Option<RigJob>,
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
    /// Largest proved distance between mesh and surface, millimetres.
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

/// Result of a [`Job`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Output {
    /// Of [`Job::ReadMesh`].
    Mesh(TriangleMesh),
    /// Of [`Job::ReadMeasured`].
    Measured(Observations),
    /// Of [`Job::Fit`].
    Fit(FitStep),
    /// Of [`Job::Mesh`].
    Meshed(Box<Meshed>),
    /// Of [`Job::Write`].
    Written(Written),
    /// Of [`Job::Coat`].
    Coated(Box<Coated>),
    /// Of [`Job::View`].
    View(Box<ViewMesh>),
}

/// A message to the worker. Jobs run one after the other, in the order of their messages; the page
/// cancels a running one by ending the worker.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Request {
    /// Number of the job, given back with its answers.
    pub id: u64,
    /// The job.
    pub job: Job,
}

/// A message from the worker.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Answer {
    /// The worker runs and takes requests. Sent once.
    Started,
    /// A job is being worked at. Also a sign of life: a worker that is silent for long is replaced.
    Progress {
        /// Number of the job.
        id: u64,
        /// Fraction done, 0 … 1.
        fraction: f32,
    },
    /// What a job has so far.
    Partial {
        /// Number of the job.
        id: u64,
        /// The result as far as it is.
        output: Output,
    },
    /// A job is over.
    Done {
        /// Number of the job.
        id: u64,
        /// Its result, or an error message for the user.
        result: Result<Output, String>,
    },
    /// The worker cannot continue, for this reason. The page replaces it.
    Failed(String),
}

/// Packs a message.
///
/// # Errors
/// Only if memory runs out while writing.
pub fn pack<T: Serialize>(message: &T) -> Result<Vec<u8>, postcard::Error> {
    postcard::to_allocvec(message)
}

/// Unpacks a message of the same build.
///
/// # Errors
/// If the bytes are not such a message, as happens when page and worker are of different builds.
pub fn unpack<T: DeserializeOwned>(bytes: &[u8]) -> Result<T, postcard::Error> {
    postcard::from_bytes(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_survive_packing_and_other_bytes_are_refused() {
        let request = Request {
            id: 7,
            job: Job::ReadMesh {
                name: String::from("a.obj"),
                bytes: vec![1, 2, 3],
            },
        };
        assert_eq!(unpack(&pack(&request).unwrap()), Ok(request));
        let mesh = TriangleMesh {
            positions: vec![DVec3::new(0.1, -2.0, 1e12), DVec3::ZERO],
            normals: Some(vec![DVec3::X, DVec3::NEG_Z]),
            triangles: vec![[0, 1, 200_000]],
            ..TriangleMesh::default()
        };
        let answer = Answer::Done {
            id: 7,
            result: Ok(Output::Mesh(mesh)),
        };
        assert_eq!(unpack(&pack(&answer).unwrap()), Ok(answer));
        assert!(unpack::<Request>(&[9, 9, 9]).is_err());
        assert!(unpack::<Answer>(&[]).is_err());
    }
}
