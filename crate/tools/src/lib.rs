//! Jobs of the tools workers, which take long and draw nothing: reading a mesh from a file, meshing
//! a scene, for files or for the eye, coating its skeletons, fitting a mesh to measured points.
//!
//! A [`Job`] is a type: its data, the type of its result, and how it is carried out stand together
//! in one file. The page sends a [`Request`] with the job and a number for it; the worker carries
//! it out with [`serve`] and sends [`Answer`]s: progress, and in the end the result. Native builds
//! run the same code on a thread. The part for web workers is in `entry`, which is compiled only
//! into the worker's own wasm (feature `entry`).
//!
//! ```
//! use tools::{Job, Progress, ReadMesh};
//! let job = ReadMesh {
//!     name: "triangle.obj".into(),
//!     bytes: "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".into(),
//! };
//! let (mesh, remarks) = job.run(&mut Progress::silent())?;
//! assert_eq!(mesh.triangles, [[0, 1, 2]]);
//! assert!(remarks.is_empty());
//! # Ok::<(), String>(())
//! ```

mod cells;
mod coating;
#[cfg(all(target_arch = "wasm32", feature = "entry"))]
mod entry;
mod fitting;
mod job;
mod meshing;
pub mod message;
mod reading;
mod work;

pub use self::cells::PackScene;
pub use coating::{CoatScene, Coated};
pub use fitting::{Controls, FitMesh, FitStep};
pub use job::{Job, News, Pace, Progress};
pub use meshing::{MeshFacts, MeshScene, Meshed, Poses, WriteMesh, Written};
pub use message::Answer;
pub use reading::{ReadMeasured, ReadMesh, ReadSkeleton};

pub use work::{Request, Work, serve};
