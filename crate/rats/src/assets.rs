//! Meshes and height fields made of a project's files, kept while the files are: a text is compiled at
//! every keystroke, a large file should be read once.

use crate::project::Asset;
use glam::DVec3;
use mesh::{Error, Topology, TriangleMesh};
use scene::Shape;
use std::cell::RefCell;
use std::rc::Rc;
use std::sync::{Arc, Weak};

/// How many are kept: more than a work has files.
const KEPT: usize = 24;

type Made = Result<Rc<TriangleMesh>, Error>;
/// The file's name, and the size of a height field.
type How = (String, Option<DVec3>);

/// A mesh made of some bytes.
struct Kept {
    bytes: Weak<[u8]>,
    how: How,
    made: Made,
    /// The mesh's topology, once it was asked for.
    topology: Option<Option<Rc<Topology>>>,
}

impl Kept {
    fn is_of(&self, asset: &Asset, how: &How) -> bool {
        let bytes = self.bytes.upgrade();
        self.how == *how && bytes.is_some_and(|bytes| Arc::ptr_eq(&bytes, &asset.bytes))
    }
}

thread_local! {
    static CACHE: RefCell<Vec<Kept>> = const { RefCell::new(Vec::new()) };
}

/// The triangles of an OBJ, PLY, STL or GLB file.
///
/// # Errors
/// Says what is wrong with the file.
pub fn mesh(asset: &Asset) -> Made {
    make(asset, (asset.name.clone(), None), |bytes| {
        mesh::read(&asset.name, bytes)
    })
}

/// The topology of a mesh that [`mesh`] has given; `None` if there is none, or it cannot be told.
pub fn topology(asset: &Asset) -> Option<Rc<Topology>> {
    let made = mesh(asset).ok()?;
    let how = (asset.name.clone(), None);
    CACHE.with_borrow_mut(|cache| {
        let kept = cache.iter_mut().find(|kept| kept.is_of(asset, &how))?;
        let topology = kept
            .topology
            .get_or_insert_with(|| Topology::of(&made).ok().map(Rc::new));
        topology.clone()
    })
}

/// A PNG image as a height field that fills a box of this size from the origin.
///
/// # Errors
/// Says what is wrong with the file.
pub fn terra(asset: &Asset, size: DVec3) -> Made {
    make(asset, (asset.name.clone(), Some(size)), |bytes| {
        mesh::terra(&mesh::heights(bytes)?, size)
    })
}

/// The triangles as shapes: patches where the mesh has normals, else flat ones.
pub fn shapes(mesh: &TriangleMesh) -> impl Iterator<Item = Shape> {
    mesh.triangles.iter().map(|triangle| {
        let corners = triangle.map(|i| mesh.positions[i as usize]);
        match &mesh.normals {
            Some(normals) => Shape::Patch {
                corners,
                normals: triangle.map(|i| normals[i as usize]),
            },
            None => Shape::Triangle {
                corners,
                radius: 0.0,
            },
        }
    })
}

/// What making something of a file costs in steps. It may have been made before, but what a text means
/// must not depend on that.
#[must_use]
pub fn cost(asset: &Asset) -> u64 {
    let bytes = &asset.bytes;
    let pixels = match bytes.get(..24) {
        // A PNG file tells its width and height first, and a short one can hold many pixels.
        Some(head) if head.starts_with(b"\x89PNG") => {
            let side = |at: usize| {
                head[at..at + 4]
                    .iter()
                    .fold(0, |n, &b| n << 8 | u64::from(b))
            };
            (side(16) * side(20)).min(mesh::limits::MAX_PIXELS as u64)
        }
        _ => 0,
    };
    1 + bytes.len() as u64 / 100 + pixels / 64
}

/// Whether [`keep_mesh`] or an earlier compilation has the mesh of this file, so that compiling does not
/// read it.
#[must_use]
pub fn is_mesh_read(asset: &Asset) -> bool {
    find(asset, &(asset.name.clone(), None)).is_some()
}

/// Keeps the mesh of a file that was read elsewhere, or the error message of its reader, for all
/// compilations by this thread while the file's bytes are kept. It must be what [`mesh::read`] gives.
pub fn keep_mesh(asset: &Asset, mesh: Result<TriangleMesh, String>) {
    let how = (asset.name.clone(), None);
    CACHE.with_borrow_mut(|cache| cache.retain(|kept| !kept.is_of(asset, &how)));
    keep(asset, how, mesh.map(Rc::new).map_err(Error));
}

fn make(asset: &Asset, how: How, read: impl FnOnce(&[u8]) -> Result<TriangleMesh, Error>) -> Made {
    find(asset, &how).unwrap_or_else(|| {
        let made = read(&asset.bytes).map(Rc::new);
        keep(asset, how, made.clone());
        made
    })
}

/// What was made of a file before. It becomes the last one to be dropped.
fn find(asset: &Asset, how: &How) -> Option<Made> {
    CACHE.with_borrow_mut(|cache| {
        let index = cache.iter().position(|kept| kept.is_of(asset, how))?;
        cache[index..].rotate_left(1);
        cache.last().map(|kept| kept.made.clone())
    })
}

fn keep(asset: &Asset, how: How, made: Made) {
    CACHE.with_borrow_mut(|cache| {
        cache.retain(|kept| kept.bytes.strong_count() > 0);
        if cache.len() >= KEPT {
            cache.remove(0);
        }
        cache.push(Kept {
            bytes: Arc::downgrade(&asset.bytes),
            how,
            made,
            topology: None,
        });
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
    fn kept_mesh_is_used_in_place_of_the_file() {
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
        assert!(CACHE.with_borrow(|cache| cache.len() <= KEPT));
    }
}
