//! Jobs of the tools worker, which take long and draw nothing: reading a mesh from a file, meshing a scene, for files or
//! for the eye, coating its skeletons, fitting a mesh to measured points.
//!
//! The page sends a [`Request`] with the job's number; the worker runs it with [`run`] and sends
//! [`Answer`]s: progress, and in the end the result. A job is a function of its request alone, so
//! that it can be repeated by another worker. Native builds run the same code on a thread. The part
//! for web workers is in `entry`, which is compiled only into the worker's own wasm (feature `entry`).
//!
//! ```
//! use tools::{Job, Output, Progress};
//! let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
//! let job = Job::ReadMesh {
//!     name: "triangle.obj".into(),
//!     bytes: text.into(),
//! };
//! let Output::Mesh(mesh) = tools::run(job, &mut Progress::silent())? else {
//!     unreachable!()
//! };
//! assert_eq!(mesh.triangles, [[0, 1, 2]]);
//! # Ok::<(), String>(())
//! ```

#[cfg(all(target_arch = "wasm32", feature = "entry"))]
mod entry;
mod fitting;
mod job;
pub mod message;
mod track;
mod view;

pub use job::{Progress, run};
pub use message::{
    Answer, CoatJob, Coated, Controls, Detail, FitJob, FitStep, Job, MeshFacts, MeshJob, Meshed,
    Output, Request, RigJob, ViewJob, ViewMesh, WriteJob, Written,
};
