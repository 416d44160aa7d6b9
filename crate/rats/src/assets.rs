//! Height fields and images made of a project's files, kept while the files are: a text is compiled
//! at every keystroke, a large file should be read once.

use crate::asset::Asset;
use crate::limits::MAX_IMAGE_PIXELS;
use glam::DVec3;
use mesh::{Error, TriangleMesh};
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

/// A height field or image made of some bytes.
struct Kept<T> {
    bytes: Weak<[u8]>,
    how: How,
    made: Made<T>,
}

impl<T> Kept<T> {
    fn is_of(&self, asset: &Asset, how: &How) -> bool {
        let bytes = self.bytes.upgrade();
        self.how == *how && bytes.is_some_and(|bytes| Arc::ptr_eq(&bytes, &asset.bytes))
    }
}

/// The last [`KEPT`] results, in the order of their use.
struct Cache<T>(Vec<Kept<T>>);

impl<T: Clone> Cache<T> {
    /// Returns what was made of a file before, which becomes the last one to be dropped.
    fn find(&mut self, asset: &Asset, how: &How) -> Option<Made<T>> {
        let index = self.0.iter().position(|kept| kept.is_of(asset, how))?;
        self.0[index..].rotate_left(1);
        self.0.last().map(|kept| kept.made.clone())
    }

    fn keep(&mut self, asset: &Asset, how: How, made: Made<T>) {
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

    fn get(&mut self, asset: &Asset, how: How, read: impl FnOnce(&[u8]) -> Made<T>) -> Made<T> {
        self.find(asset, &how).unwrap_or_else(|| {
            let made = read(&asset.bytes);
            self.keep(asset, how, made.clone());
            made
        })
    }
}

thread_local! {
    static TERRAS: RefCell<Cache<Rc<TriangleMesh>>> = const { RefCell::new(Cache(Vec::new())) };
    static IMAGES: RefCell<Cache<Arc<Rgb8>>> = const { RefCell::new(Cache(Vec::new())) };
}

/// Makes a height field of a PNG image, which fills a box of this size from the origin.
///
/// # Errors
/// A sentence on what is wrong with the file.
pub fn terra(asset: &Asset, size: DVec3) -> Made<Rc<TriangleMesh>> {
    TERRAS.with_borrow_mut(|cache| {
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

#[cfg(test)]
mod tests {
    use super::*;

    fn asset(name: &str) -> Asset {
        Asset::new(name, *b"broken")
    }

    fn is_kept(asset: &Asset) -> bool {
        let how = (asset.name.clone(), Some(DVec3::ONE));
        TERRAS.with_borrow_mut(|cache| cache.find(asset, &how).is_some())
    }

    #[test]
    fn height_field_in_use_is_not_dropped_for_others() {
        let used = asset("used.png");
        assert!(!is_kept(&used));
        let _ = terra(&used, DVec3::ONE);
        let others: Vec<Asset> = (0..2 * KEPT).map(|_| asset("other.png")).collect();
        for other in &others {
            let _ = terra(other, DVec3::ONE);
            assert!(is_kept(&used));
        }
        // Other bytes of the same content are another file.
        assert!(!is_kept(&asset("used.png")) && !is_kept(&others[0]));
        assert!(TERRAS.with_borrow(|cache| cache.0.len() <= KEPT));
    }
}
