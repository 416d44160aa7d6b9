//! Creases in cells: where two or three smooth parts of the surface meet, as at the rim of a sheet
//! on which bodies touch.
//!
//! The planes that touch the surface where edges of a cell cross it meet on the crease, or in its
//! corner (Ju, Losasso, Schaefer and Warren 2002).

use crate::certify::Vertex;
use glam::{DMat3, DVec3};

/// Largest cosine of the angle between normals in a cell at which there may be a crease.
pub const TURNED: f64 = 0.8;
/// Weight of the distance from the mean of places, for each of them, where planes do not tell.
const MEAN: f64 = 1e-3;

/// Returns the point for which the squares of the distances from the planes that touch the surface
/// at some places have the least sum: of those that have nearly the same, one that is near the mean
/// of the places. It is not finite where a normal is not.
pub fn meet(places: &[Vertex]) -> DVec3 {
    let count = places.len() as f64;
    let mean = places.iter().map(|own| own.position).sum::<DVec3>() / count;
    let mut matrix = DMat3::from_diagonal(DVec3::splat(MEAN * count));
    let mut right = DVec3::ZERO;
    for own in places {
        let normal = own.normal();
        matrix += DMat3::from_cols(normal * normal.x, normal * normal.y, normal * normal.z);
        right += normal * normal.dot(own.position - mean);
    }
    mean + matrix.inverse() * right
}

/// Whether normals at some places differ so much that there may be a crease between them.
pub fn is_turned(places: &[Vertex]) -> bool {
    places.iter().enumerate().any(|(i, one)| {
        let mut before = places[..i].iter();
        before.any(|other| one.normal().dot(other.normal()) < TURNED)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use trials::{Random, count};

    /// Places on the faces of a random corner or edge, with their normals.
    #[test]
    fn planes_meet_on_edges_and_in_corners() {
        let mut random = Random::new(21);
        for _ in 0..count(2000) {
            let at = random.vector(2.0);
            let faces = 2 + random.below(2);
            let normals: Vec<DVec3> = (0..faces).map(|_| random.direction()).collect();
            let volume = match normals[..] {
                [a, b] => a.cross(b).length(),
                [a, b, c] => a.cross(b).dot(c).abs(),
                _ => unreachable!("there are two or three"),
            };
            if volume < 0.5 {
                continue;
            }
            let places: Vec<Vertex> = (0..4 * faces)
                .map(|i| {
                    let normal = normals[i % faces];
                    let way = random.vector(0.5);
                    Vertex {
                        position: at + way - normal * normal.dot(way),
                        value: 0.0,
                        gradient: -normal * random.range(0.1, 10.0),
                    }
                })
                .collect();
            let found = meet(&places);
            for normal in normals {
                let off = normal.dot(found - at).abs();
                assert!(off < 0.01, "{off} of {faces} faces, {volume}");
            }
        }
    }

    /// Places of one plane: the point stays among them.
    #[test]
    fn flat_parts_keep_their_middle() {
        let places = [DVec3::X, DVec3::Y, -DVec3::X, -DVec3::Y].map(|way| Vertex {
            position: DVec3::Z + way,
            value: 0.0,
            gradient: DVec3::Z,
        });
        assert!(!is_turned(&places));
        assert!(meet(&places).distance(DVec3::Z) < 1e-12);
    }
}
