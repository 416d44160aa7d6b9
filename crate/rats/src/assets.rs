//! Meshes and height fields made of a project's files, kept while the files are: a text is compiled at
//! every keystroke, a large file should be read once.

use crate::project::Asset;
use glam::DVec3;
use mesh::{Error, TriangleMesh};
use scene::Shape;
use std::cell::RefCell;
use std::rc::Rc;
use std::sync::{Arc, Weak};

/// How many are kept.
const KEPT: usize = 8;

type Made = Result<Rc<TriangleMesh>, Error>;

/// What was made of some bytes, and how.
struct Kept {
    bytes: Weak<[u8]>,
    how: (String, Option<DVec3>),
    made: Made,
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

fn make(
    asset: &Asset,
    how: (String, Option<DVec3>),
    read: impl FnOnce(&[u8]) -> Result<TriangleMesh, Error>,
) -> Made {
    let is_it = |kept: &Kept| {
        kept.how == how
            && kept
                .bytes
                .upgrade()
                .is_some_and(|bytes| Arc::ptr_eq(&bytes, &asset.bytes))
    };
    let known = CACHE.with_borrow(|cache| {
        let kept = cache.iter().find(|kept| is_it(kept))?;
        Some(kept.made.clone())
    });
    if let Some(made) = known {
        return made;
    }
    let made = read(&asset.bytes).map(Rc::new);
    CACHE.with_borrow_mut(|cache| {
        cache.retain(|kept| kept.bytes.strong_count() > 0);
        if cache.len() >= KEPT {
            cache.remove(0);
        }
        cache.push(Kept {
            bytes: Arc::downgrade(&asset.bytes),
            how,
            made: made.clone(),
        });
    });
    made
}
