//! The files of a project that are no texts.

use crate::reads::is_mesh;
use limbs::{Graph, Recipe};
use mesh::{Error, Format, Topology, TriangleMesh};
use std::fmt;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// A reader of mesh files, as [`mesh::read_with_remarks`].
type Reader = fn(&str, &[u8]) -> Result<(TriangleMesh, Vec<String>), Error>;

/// A maker of skeletons, as [`Recipe::make`].
type Maker = fn(&Recipe, &str, &[u8]) -> Result<Graph, limbs::Error>;

/// Skeletons that are kept of a file, each made otherwise.
const KEPT: usize = 24;

/// A file that is no text: an image, a mesh or a skeleton. Links do not carry it.
///
/// A mesh or a skeleton is read once, for all copies of the asset: by the asset itself, or
/// elsewhere, as by a worker of the page, whose program has no readers. Two assets are equal if
/// their names and contents are.
#[derive(Clone)]
pub struct Asset {
    /// The name, by which commands find it.
    pub name: String,
    /// The content.
    pub bytes: Arc<[u8]>,
    reader: Option<Reader>,
    maker: Option<Maker>,
    read: Arc<Read>,
}

/// Skeleton of a file, or why there is none, and how it was made.
type Made = (Recipe, Result<Arc<Graph>, Error>);

/// The mesh or the skeletons of a file.
#[derive(Default)]
struct Read {
    /// The last ones that were made.
    skeletons: Mutex<Vec<Made>>,
    mesh: OnceLock<Result<(Arc<TriangleMesh>, Vec<String>), Error>>,
    topology: OnceLock<Result<Topology, Error>>,
}

impl Asset {
    /// Makes an asset that reads its mesh when that is asked for.
    ///
    /// ```
    /// let asset = rats::Asset::new("a.obj", *b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    /// assert_eq!(asset.mesh()?.triangles, [[0, 1, 2]]);
    /// # Ok::<(), mesh::Error>(())
    /// ```
    #[must_use]
    pub fn new(name: impl Into<String>, bytes: impl Into<Arc<[u8]>>) -> Self {
        Self {
            reader: Some(mesh::read_with_remarks),
            maker: Some(Recipe::make),
            ..Self::await_mesh(name, bytes)
        }
    }

    /// Makes an asset that awaits its mesh or skeleton: it is read elsewhere, and given to
    /// [`Asset::keep_mesh`] or [`Asset::keep_skeleton`].
    ///
    /// ```
    /// let asset = rats::Asset::await_mesh("a.obj", *b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    /// let copy = asset.clone();
    /// assert!(copy.is_unread() && copy.mesh().is_err());
    /// let read = mesh::read_with_remarks(&asset.name, &asset.bytes);
    /// asset.keep_mesh(read.map_err(|error| error.0));
    /// assert_eq!(copy.mesh()?.triangles, [[0, 1, 2]]);
    /// # Ok::<(), mesh::Error>(())
    /// ```
    #[must_use]
    pub fn await_mesh(name: impl Into<String>, bytes: impl Into<Arc<[u8]>>) -> Self {
        Self {
            name: name.into(),
            bytes: bytes.into(),
            reader: None,
            maker: None,
            read: Arc::default(),
        }
    }

    /// Whether [`Asset::mesh`] waits for [`Asset::keep_mesh`].
    #[must_use]
    pub fn is_unread(&self) -> bool {
        self.reader.is_none() && is_mesh(&self.name) && self.read.mesh.get().is_none()
    }

    /// Keeps the mesh that was read elsewhere with the remarks about it, or the error message of
    /// its reader, for all copies of the asset. It must be what [`mesh::read_with_remarks`] gives.
    /// The first one stays.
    pub fn keep_mesh(&self, read: Result<(TriangleMesh, Vec<String>), String>) {
        let read = read.map(|(mesh, remarks)| (Arc::new(mesh), remarks));
        let _ = self.read.mesh.set(read.map_err(Error));
    }

    /// Returns sentences about what was left out of a mesh file that has been read.
    #[must_use]
    pub fn remarks(&self) -> &[String] {
        match self.read.mesh.get() {
            Some(Ok((_, remarks))) => remarks,
            _ => &[],
        }
    }

    /// Returns the triangles of a mesh file.
    ///
    /// # Errors
    /// A sentence on what is wrong with the file, or that it is not read yet.
    pub fn mesh(&self) -> Result<Arc<TriangleMesh>, Error> {
        if let Some(read) = self.reader
            && self.read.mesh.get().is_none()
        {
            self.keep_mesh(read(&self.name, &self.bytes).map_err(|Error(text)| text));
        }
        match self.read.mesh.get() {
            Some(Ok((mesh, _))) => Ok(Arc::clone(mesh)),
            Some(Err(error)) => Err(error.clone()),
            None if is_mesh(&self.name) => Err(Error(String::from("this mesh is not read yet"))),
            None => Err(Format::refuse()),
        }
    }

    /// Returns the skeleton of a file; `None` if it is to be read elsewhere, and has not been.
    ///
    /// # Errors
    /// A sentence on what is wrong with the file.
    #[must_use]
    pub fn skeleton(&self, recipe: &Recipe) -> Option<Result<Arc<Graph>, Error>> {
        let made = self.read.skeletons.lock();
        let made = made.unwrap_or_else(PoisonError::into_inner);
        let known = made.iter().find(|(own, _)| own == recipe);
        if let Some((_, skeleton)) = known {
            return Some(skeleton.clone());
        }
        drop(made);
        let make = self.maker?;
        let skeleton = make(recipe, &self.name, &self.bytes);
        Some(self.keep(recipe.clone(), skeleton.map_err(|error| error.to_string())))
    }

    /// Keeps a skeleton that was made elsewhere, or the error message of its maker, for all copies
    /// of the asset. It must be what [`Recipe::make`] gives.
    pub fn keep_skeleton(&self, recipe: Recipe, skeleton: Result<Graph, String>) {
        let _ = self.keep(recipe, skeleton);
    }

    fn keep(&self, recipe: Recipe, skeleton: Result<Graph, String>) -> Result<Arc<Graph>, Error> {
        let skeleton = skeleton.map(Arc::new).map_err(Error);
        let made = self.read.skeletons.lock();
        let mut made = made.unwrap_or_else(PoisonError::into_inner);
        made.retain(|(own, _)| *own != recipe);
        if made.len() >= KEPT {
            drop(made.remove(0));
        }
        made.push((recipe, skeleton.clone()));
        skeleton
    }

    /// Returns the topology of the mesh.
    ///
    /// # Errors
    /// If there is no mesh, or its topology cannot be told.
    pub fn topology(&self) -> Result<&Topology, Error> {
        let mesh = self.mesh()?;
        let topology = self.read.topology.get_or_init(|| Topology::of(&mesh));
        topology.as_ref().map_err(Clone::clone)
    }
}

impl PartialEq for Asset {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name && self.bytes == other.bytes
    }
}

impl Eq for Asset {}

impl fmt::Debug for Asset {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let bytes = self.bytes.len();
        write!(f, "Asset({:?}, {bytes} bytes)", self.name)
    }
}
