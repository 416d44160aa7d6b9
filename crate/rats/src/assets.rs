//! Meshes, height fields, skeletons and images made of a project's files, kept while the files are:
//! a text is compiled at every keystroke, a large file should be read once.

use crate::limits::MAX_IMAGE_PIXELS;
use crate::project::Asset;
use glam::DVec3;
use limbs::{Graph, Recipe};
use mesh::{Error, Topology, TriangleMesh};
use picture::Format;
use scene::Shape;
use std::cell::RefCell;
use std::path::Path;
use std::rc::Rc;
use std::sync::{Arc, Weak};
use texture::Rgb8;

/// Number of results of each kind that are kept: more than a work has files.
const KEPT: usize = 24;

type Made<T> = Result<T, Error>;
/// Name of a file, and the size of a height field made of it.
type How = (String, Option<DVec3>);

/// Something made of some bytes, and how.
struct Kept<T, H> {
    bytes: Weak<[u8]>,
    how: H,
    made: Made<T>,
}

impl<T, H: PartialEq> Kept<T, H> {
    fn is_of(&self, asset: &Asset, how: &H) -> bool {
        let bytes = self.bytes.upgrade();
        self.how == *how && bytes.is_some_and(|bytes| Arc::ptr_eq(&bytes, &asset.bytes))
    }
}

/// The last [`KEPT`] results, in the order of their use.
struct Cache<T, H = How>(Vec<Kept<T, H>>);

impl<T: Clone, H: PartialEq> Cache<T, H> {
    /// Returns what was made of a file before, which becomes the last one to be dropped.
    fn find(&mut self, asset: &Asset, how: &H) -> Option<Made<T>> {
        let index = self.0.iter().position(|kept| kept.is_of(asset, how))?;
        self.0[index..].rotate_left(1);
        self.0.last().map(|kept| kept.made.clone())
    }

    fn keep(&mut self, asset: &Asset, how: H, made: Made<T>) {
        self.0.retain(|kept| kept.bytes.strong_count() > 0);
        if self.0.len() >= KEPT {
            self.0.remove(0);
        }
        self.0.push(Kept {
            bytes: Arc::downgrade(&asset.bytes),
            how,
            made,
        });
    }

    fn get(&mut self, asset: &Asset, how: H, read: impl FnOnce(&[u8]) -> Made<T>) -> Made<T> {
        self.find(asset, &how).unwrap_or_else(|| {
            let made = read(&asset.bytes);
            self.keep(asset, how, made.clone());
            made
        })
    }
}

thread_local! {
    static MESHES: RefCell<Cache<Rc<TriangleMesh>>> = const { RefCell::new(Cache(Vec::new())) };
    static TOPOLOGIES: RefCell<Cache<Rc<Topology>>> = const { RefCell::new(Cache(Vec::new())) };
    static SKELETONS: RefCell<Cache<Rc<Graph>, (String, Recipe)>> =
        const { RefCell::new(Cache(Vec::new())) };
    static IMAGES: RefCell<Cache<Arc<Rgb8>>> = const { RefCell::new(Cache(Vec::new())) };
}

/// Reads the triangles of an OBJ, PLY, STL or GLB file.
///
/// # Errors
/// A sentence on what is wrong with the file.
pub fn mesh(asset: &Asset) -> Made<Rc<TriangleMesh>> {
    MESHES.with_borrow_mut(|cache| {
        cache.get(asset, (asset.name.clone(), None), |bytes| {
            mesh::read(&asset.name, bytes).map(Rc::new)
        })
    })
}

/// Finds the topology of a mesh that [`mesh`] gives.
///
/// # Errors
/// If there is none, or it cannot be told.
pub fn topology(asset: &Asset) -> Made<Rc<Topology>> {
    let mesh = mesh(asset)?;
    TOPOLOGIES.with_borrow_mut(|cache| {
        cache.get(asset, (asset.name.clone(), None), |_| {
            Topology::of(&mesh).map(Rc::new)
        })
    })
}

/// Makes a height field of a PNG image, which fills a box of this size from the origin.
///
/// # Errors
/// A sentence on what is wrong with the file.
pub fn terra(asset: &Asset, size: DVec3) -> Made<Rc<TriangleMesh>> {
    MESHES.with_borrow_mut(|cache| {
        cache.get(asset, (asset.name.clone(), Some(size)), |bytes| {
            mesh::terra(&mesh::heights(bytes)?, size).map(Rc::new)
        })
    })
}

/// Reads the pixels of a picture; opacity does not count.
///
/// # Errors
/// A sentence on what is wrong with the file.
pub fn image(asset: &Asset) -> Made<Arc<Rgb8>> {
    IMAGES.with_borrow_mut(|cache| {
        cache.get(asset, (asset.name.clone(), None), |bytes| {
            let picture = Format::of(Path::new(&asset.name))
                .and_then(|format| picture::file::decode_at_most(bytes, format, MAX_IMAGE_PIXELS))
                .map_err(|problem| Error(problem.to_string()))?;
            Ok(Arc::new(Rgb8 {
                size: picture.size(),
                bytes: picture.rgb(),
            }))
        })
    })
}

/// Returns the skeleton of a file; `None` if it has not been read, and is not to be read here.
///
/// # Errors
/// A sentence on what is wrong with the file.
pub fn skeleton(asset: &Asset, recipe: &Recipe) -> Option<Made<Rc<Graph>>> {
    let how = (asset.name.clone(), recipe.clone());
    SKELETONS.with_borrow_mut(|cache| {
        #[cfg(not(feature = "readers"))]
        return cache.find(asset, &how);
        #[cfg(feature = "readers")]
        Some(cache.get(asset, how, |bytes| {
            let made = recipe.make(&asset.name, bytes);
            made.map(Rc::new).map_err(|error| Error(error.to_string()))
        }))
    })
}

/// Whether [`keep_skeleton`] or an earlier compilation has this skeleton.
#[must_use]
pub fn is_skeleton_read(asset: &Asset, recipe: &Recipe) -> bool {
    let how = (asset.name.clone(), recipe.clone());
    SKELETONS.with_borrow_mut(|cache| cache.find(asset, &how).is_some())
}

/// Keeps the skeleton of a file that was read elsewhere, or the error message of its reader, for
/// all compilations by this thread while the file's bytes are kept. It must be what
/// [`Recipe::make`] gives.
pub fn keep_skeleton(asset: &Asset, recipe: Recipe, skeleton: Result<Graph, String>) {
    let how = (asset.name.clone(), recipe);
    SKELETONS.with_borrow_mut(|cache| {
        cache.0.retain(|kept| !kept.is_of(asset, &how));
        cache.keep(asset, how, skeleton.map(Rc::new).map_err(Error));
    });
}

/// Returns the triangles as shapes: patches where the mesh has normals, else flat ones.
pub fn shapes(mesh: &TriangleMesh) -> impl Iterator<Item = Shape> {
    mesh.triangles.iter().map(|triangle| {
        let corners = triangle.map(|i| mesh.positions[i as usize]);
        match &mesh.normals {
            Some(normals) => Shape::patch(corners, triangle.map(|i| normals[i as usize])),
            None => Shape::triangle(corners, 0.0),
        }
    })
}

/// Returns what it costs in steps to make something of a file. It may have been made before, but
/// what a text means must not depend on that.
#[must_use]
pub fn cost(asset: &Asset) -> u64 {
    let bytes = &asset.bytes;
    let pixels = match bytes.get(..24) {
        // A PNG file tells its width and height first, and a short one can hold many pixels.
        Some(&[0x89, b'P', b'N', b'G', .., a, b, c, d, e, f, g, h]) => {
            let width = u64::from(u32::from_be_bytes([a, b, c, d]));
            let height = u64::from(u32::from_be_bytes([e, f, g, h]));
            (width * height).min(mesh::limits::MAX_PIXELS as u64)
        }
        _ => 0,
    };
    1 + bytes.len() as u64 / 100 + pixels / 64
}

/// Whether [`keep_mesh`] or an earlier compilation has the mesh of this file, so that compiling
/// does not read it.
#[must_use]
pub fn is_mesh_read(asset: &Asset) -> bool {
    let how = (asset.name.clone(), None);
    MESHES.with_borrow_mut(|cache| cache.find(asset, &how).is_some())
}

/// Keeps the mesh of a file that was read elsewhere, or the error message of its reader, for all
/// compilations by this thread while the file's bytes are kept. It must be what [`mesh::read`]
/// gives.
pub fn keep_mesh(asset: &Asset, mesh: Result<TriangleMesh, String>) {
    let how = (asset.name.clone(), None);
    MESHES.with_borrow_mut(|cache| {
        cache.0.retain(|kept| !kept.is_of(asset, &how));
        cache.keep(asset, how, mesh.map(Rc::new).map_err(Error));
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    fn asset(name: &str, text: &str) -> Asset {
        Asset {
            name: name.to_owned(),
            bytes: text.as_bytes().into(),
        }
    }

    #[test]
    fn mesh_that_is_kept_is_used_in_place_of_the_file() {
        let file = asset("a.obj", "broken");
        assert!(!is_mesh_read(&file));
        keep_mesh(&file, Err(String::from("on purpose")));
        assert!(is_mesh_read(&file));
        assert_eq!(mesh(&file), Err(Error(String::from("on purpose"))));
        let triangle = mesh::read("b.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
        keep_mesh(&file, Ok(triangle.clone()));
        assert_eq!(*mesh(&file).unwrap(), triangle);
        // Other bytes of the same content are another file.
        assert!(!is_mesh_read(&asset("a.obj", "broken")));
    }

    #[test]
    fn mesh_in_use_is_not_dropped_for_others() {
        let used = asset("used.obj", "broken");
        keep_mesh(&used, Err(String::from("kept")));
        let others: Vec<Asset> = (0..2 * KEPT).map(|_| asset("other.obj", "")).collect();
        for other in &others {
            let _ = mesh(other);
            assert!(is_mesh_read(&used));
        }
        assert!(!is_mesh_read(&others[0]));
        assert!(MESHES.with_borrow(|cache| cache.0.len() <= KEPT));
    }
}
