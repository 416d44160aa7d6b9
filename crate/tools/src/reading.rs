//! The jobs of reading files.

use crate::job::{Job, Pace, Progress};
use fit::Observations;
use limbs::{Graph, Recipe};
use mesh::TriangleMesh;
use serde::{Deserialize, Serialize};

/// Reads a mesh from a file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReadMesh {
    /// The file's name, whose ending says the format where the content does not.
    pub name: String,
    /// The file's content.
    // Copied as a whole, not byte by byte.
    #[serde(with = "serde_bytes")]
    pub bytes: Vec<u8>,
}

/// Mesh of a file, and sentences about what was left out of it.
type MeshAndRemarks = (TriangleMesh, Vec<String>);

impl Job for ReadMesh {
    type Output = MeshAndRemarks;
    const PACE: Pace = Pace::Quick;

    fn run(self, _: &mut Progress<'_, MeshAndRemarks>) -> Result<MeshAndRemarks, String> {
        mesh::read_with_remarks(&self.name, &self.bytes).map_err(|error| error.to_string())
    }
}

/// Makes a skeleton of a file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReadSkeleton {
    /// The file's name, whose ending says the format.
    pub name: String,
    /// The file's content.
    #[serde(with = "serde_bytes")]
    pub bytes: Vec<u8>,
    /// Way to make it.
    pub recipe: Recipe,
}

impl Job for ReadSkeleton {
    type Output = Graph;
    const PACE: Pace = Pace::Quick;

    fn run(self, _: &mut Progress<'_, Graph>) -> Result<Graph, String> {
        let made = self.recipe.make(&self.name, &self.bytes);
        made.map_err(|error| error.to_string())
    }
}

/// Reads measured points from a PLY or XYZ file, or outlines from a JSON file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReadMeasured {
    /// The file's name.
    pub name: String,
    /// The file's content.
    #[serde(with = "serde_bytes")]
    pub bytes: Vec<u8>,
}

impl Job for ReadMeasured {
    type Output = Observations;
    const PACE: Pace = Pace::Quick;

    fn run(self, _: &mut Progress<'_, Observations>) -> Result<Observations, String> {
        let Self { name, bytes } = self;
        let is_outline = bytes.trim_ascii_start().first() == Some(&b'[');
        let read = if is_outline {
            fit::outlines(&bytes).map(|outlines| Observations {
                points: Vec::new(),
                sights: fit::sights(&outlines),
            })
        } else {
            fit::cloud(&name, &bytes).map(|points| Observations {
                points,
                sights: Vec::new(),
            })
        };
        read.map_err(|error| error.to_string())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nf 1 1 2\n";

    fn read(name: &str, text: &str) -> Result<MeshAndRemarks, String> {
        let job = ReadMesh {
            name: name.into(),
            bytes: text.into(),
        };
        job.run(&mut Progress::silent())
    }

    #[test]
    fn mesh_equals_that_of_a_direct_read() {
        let direct = mesh::read_with_remarks("a.obj", SQUARE.as_bytes()).unwrap();
        assert_eq!(direct.1.len(), 1);
        assert_eq!(read("a.obj", SQUARE), Ok(direct));
    }

    #[test]
    fn content_of_a_file_says_what_was_measured() {
        fn read(name: &str, text: &str) -> Result<[usize; 2], String> {
            let job = ReadMeasured {
                name: name.into(),
                bytes: text.into(),
            };
            job.run(&mut Progress::silent())
                .map(|found| [found.points.len(), found.sights.len()])
        }
        assert_eq!(read("a.xyz", "0 0 1\n1 1 1\n"), Ok([2, 0]));
        let outline = r#"[{"eye":[0,-5,0],"target":[0,0,0],"up":[0,0,1],"fov":40,"size":[9,9],
            "lines":[[[2,5]]]}]"#;
        assert_eq!(read("a.json", outline), Ok([0, 1]));
        let message = read("a.xyz", "0 0\n").unwrap_err();
        assert!(message.contains("line 1"), "{message}");
    }

    #[test]
    fn skeleton_equals_that_of_a_direct_read() {
        let bytes = b"1 3 0 0 0 1 -1\n2 3 20 0 0 1 1\n".to_vec();
        let recipe = Recipe::default();
        let direct = recipe.make("n.swc", &bytes).unwrap();
        let name = String::from("n.swc");
        let job = ReadSkeleton {
            name,
            bytes,
            recipe,
        };
        assert_eq!(job.run(&mut Progress::silent()), Ok(direct));
    }

    #[test]
    fn message_of_a_broken_file_is_that_of_its_reader() {
        let message = read("a.ply", "no").unwrap_err();
        assert_eq!(message, mesh::read("a.ply", b"no").unwrap_err().to_string());
    }
}
