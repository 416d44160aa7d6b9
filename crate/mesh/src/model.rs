//! A mesh: corners, maybe normals, and triangles between them.

use crate::limits::{MAX_TRIANGLES, MAX_VERTICES};
use crate::{Error, fail};
use glam::DVec3;
use scene::Shape;

/// Triangles that share corners.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Where the corners are; finite.
    pub positions: Vec<DVec3>,
    /// The normal at each corner, if the file has any; finite, of any length. One of length 0 stands
    /// for the triangle's own.
    pub normals: Option<Vec<DVec3>>,
    /// Three corners each, as indices into `positions`, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// The triangles as shapes: patches where the mesh has normals, else flat ones.
    pub fn shapes(&self) -> impl Iterator<Item = Shape> {
        self.triangles.iter().map(|triangle| {
            let corners = triangle.map(|i| self.positions[i as usize]);
            match &self.normals {
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

    /// Adds a corner.
    pub(crate) fn corner(&mut self, position: DVec3) -> Result<u32, Error> {
        if self.positions.len() == MAX_VERTICES {
            return fail(format!("more than {MAX_VERTICES} corners"));
        }
        self.positions.push(position);
        Ok(self.positions.len() as u32 - 1)
    }

    /// Adds a triangle; its corners may still be to come.
    pub(crate) fn triangle(&mut self, corners: [u32; 3]) -> Result<(), Error> {
        if self.triangles.len() == MAX_TRIANGLES {
            return fail(format!(
                "more than {MAX_TRIANGLES} triangles; simplify the mesh first"
            ));
        }
        self.triangles.push(corners);
        Ok(())
    }

    /// The mesh without what cannot be drawn.
    pub(crate) fn sound(mut self) -> Result<Self, Error> {
        let count = self.positions.len();
        let last = self.triangles.iter().flatten().max();
        if let Some(last) = last.filter(|i| **i as usize >= count) {
            return fail(format!(
                "a triangle has corner {last} (from 0), but there are {count} corners"
            ));
        }
        // A mesh far from everything would come out as nothing.
        let far = |p: &DVec3| !p.is_finite() || p.abs().max_element() > 1e12;
        if let Some(i) = self.positions.iter().position(far) {
            return fail(format!("corner {i} (from 0) is not at a place within 1e12"));
        }
        let positions = &self.positions;
        self.triangles.retain(|triangle| {
            let [a, b, c] = triangle.map(|i| positions[i as usize]);
            let (ab, ac) = (b - a, c - a);
            ab.cross(ac).length() > 1e-12 * ab.length() * ac.length()
        });
        if self.triangles.is_empty() {
            return fail("there are no triangles in this file");
        }
        match &mut self.normals {
            Some(normals) if normals.len() == count => {
                for normal in normals.iter_mut().filter(|n| !n.is_finite()) {
                    *normal = DVec3::ZERO;
                }
            }
            other => *other = None,
        }
        Ok(self)
    }
}
