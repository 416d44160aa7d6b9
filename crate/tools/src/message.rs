//! Messages from a tools worker to the page: plain data, packed as bytes.

use serde::{Deserialize, Serialize};

/// The trouble of a page and a worker that do not understand each other.
pub const DIFFERENT_VERSIONS: &str = "page and worker are of different versions; reload the page";

/// A message from a worker. Behind a [`Answer::Part`] or [`Answer::Done`] follows an output of the
/// job's type.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Answer {
    /// The worker runs and takes requests. Sent once.
    Started,
    /// A job is being carried out. Also a sign of life: a worker that is silent for long is
    /// replaced.
    Progress {
        /// Number of the job.
        id: u64,
        /// Fraction done, 0 … 1.
        fraction: f32,
    },
    /// A job has a part of its result, which follows.
    Part {
        /// Number of the job.
        id: u64,
    },
    /// A job is over, and its result follows.
    Done {
        /// Number of the job.
        id: u64,
    },
    /// A job is over without a result.
    Refused {
        /// Number of the job.
        id: u64,
        /// A message for the user.
        trouble: String,
    },
    /// The worker cannot continue, for this reason. The page replaces it.
    Failed(String),
}

impl Answer {
    /// Packs an answer that nothing follows.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        // It is empty if memory runs out; then the page says that it does not understand it.
        pack(self, &()).unwrap_or_default()
    }
}

/// Packs an answer and the output that follows it.
///
/// # Errors
/// Only if memory runs out while writing.
pub fn pack<T: Serialize>(answer: &Answer, output: &T) -> Result<Vec<u8>, postcard::Error> {
    postcard::to_extend(output, postcard::to_allocvec(answer)?)
}

/// Unpacks an answer of the same build. Returns it with the bytes that follow.
///
/// # Errors
/// If the bytes are not such a message, as happens when page and worker are of different builds.
pub fn unpack_answer(bytes: &[u8]) -> Result<(Answer, &[u8]), postcard::Error> {
    postcard::take_from_bytes(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ReadMesh, Request, Work};
    use glam::DVec3;
    use mesh::TriangleMesh;

    #[test]
    fn messages_survive_packing_and_other_bytes_are_refused() {
        let job = ReadMesh {
            name: String::from("a.obj"),
            bytes: vec![1, 2, 3],
        };
        let request = Request {
            id: 7,
            work: job.clone().into(),
        };
        let packed = postcard::to_allocvec(&request).unwrap();
        let Ok(Request { id: 7, work }) = postcard::from_bytes(&packed) else {
            panic!("{packed:?}");
        };
        assert!(matches!(work, Work::ReadMesh(again) if *again == job));
        let mesh = TriangleMesh {
            positions: vec![DVec3::new(0.1, -2.0, 1e12), DVec3::ZERO],
            normals: Some(vec![DVec3::X, DVec3::NEG_Z]),
            triangles: vec![[0, 1, 200_000]],
            ..TriangleMesh::default()
        };
        let packed = pack(&Answer::Done { id: 7 }, &mesh).unwrap();
        let (answer, output) = unpack_answer(&packed).unwrap();
        assert_eq!(answer, Answer::Done { id: 7 });
        assert_eq!(postcard::from_bytes(output), Ok(mesh));
        assert!(postcard::from_bytes::<Request>(&[9, 9, 9]).is_err());
        assert!(unpack_answer(&[]).is_err());
    }
}
