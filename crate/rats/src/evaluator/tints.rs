//! Colours of a mesh's vertices: each triangle gets them as paint, and a tint of the mesh's
//! material for what cannot mix colours within a triangle. Tints are rounded, so that a painted
//! mesh needs few materials.

use super::palette::Palette;
use crate::problem::Outcome;
use crate::reader::Name;
use mesh::TriangleMesh;
use scene::{Paint, Rgb};
use std::collections::{BTreeMap, BTreeSet};

/// Numbers of steps of a channel. A mesh with too many tints in the first is rounded to the next.
const STEPS: [f32; 3] = [32.0, 16.0, 8.0];
/// Most tints of a mesh; with the last of [`STEPS`] there are no more.
const MOST: usize = 1000;

/// Colour in steps of the channels' square roots, which are about as even to the eye.
type Tint = [u8; 3];

/// Rounds the mean colour of each triangle; `None` if there are more than [`MOST`] tints.
fn round(mesh: &TriangleMesh, colors: &[Rgb], steps: f32) -> Option<Vec<Tint>> {
    let mut seen = BTreeSet::new();
    let mut tints = Vec::with_capacity(mesh.triangles.len());
    for triangle in &mesh.triangles {
        let corners = triangle.map(|i| colors.get(i as usize).copied().unwrap_or([1.0; 3]));
        let tint = [0, 1, 2].map(|k| {
            let sum: f32 = corners.iter().map(|color| color[k]).sum();
            // A number that is none counts as 0.
            ((sum / 3.0).clamp(0.0, 1.0).sqrt() * steps).round() as u8
        });
        seen.insert(tint);
        if seen.len() > MOST {
            return None;
        }
        tints.push(tint);
    }
    Some(tints)
}

/// Makes the material of each triangle of a mesh with colours; `None` if it has none, or nothing
/// but white.
///
/// # Errors
/// If there are too many materials.
pub fn materials(
    palette: &mut Palette<'_>,
    name: &Name<'_>,
    material: usize,
    mesh: &TriangleMesh,
) -> Outcome<Option<Vec<usize>>> {
    let Some(colors) = &mesh.colors else {
        return Ok(None);
    };
    let found = STEPS
        .into_iter()
        .find_map(|steps| Some((steps, round(mesh, colors, steps)?)));
    let Some((steps, tints)) = found else {
        return Ok(None);
    };
    let white = [steps as u8; 3];
    if tints.iter().all(|tint| *tint == white) {
        return Ok(None);
    }
    let mut made = BTreeMap::from([(white, material)]);
    let mut all = Vec::with_capacity(tints.len());
    for tint in tints {
        let index = match made.get(&tint) {
            Some(index) => *index,
            None => {
                let color = tint.map(|step| {
                    let root = f32::from(step) / steps;
                    root * root
                });
                let index = palette.add_tint(name, material, color)?;
                made.insert(tint, index);
                index
            }
        };
        all.push(index);
    }
    Ok(Some(all))
}

/// Returns the colours at a triangle's corners, which multiply those of a material.
pub fn paint(material: usize, mesh: &TriangleMesh, triangle: usize) -> Option<Box<Paint>> {
    let colors = mesh.colors.as_ref()?;
    Some(Box::new(Paint {
        finish: material as u32,
        corners: mesh.triangles[triangle].map(|corner| {
            let color = colors.get(corner as usize).copied().unwrap_or([1.0; 3]);
            // A number that is none counts as 0.
            color.map(|channel| if channel > 0.0 { channel.min(1.0) } else { 0.0 })
        }),
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn many_colours_are_rounded_to_few() {
        let count = 40_000u32;
        let mut mesh = TriangleMesh::new(
            vec![DVec3::ZERO; count as usize],
            (0..count).map(|i| [i; 3]).collect(),
        );
        let colors: Vec<Rgb> = (0..count)
            .map(|i| [i % 34, i / 34 % 35, i / (34 * 35) % 36].map(|step| step as f32 / 36.0))
            .collect();
        assert!(round(&mesh, &colors, STEPS[0]).is_none());
        assert!(round(&mesh, &colors, STEPS[2]).is_some());
        mesh.triangles.truncate(3);
        let strange = [[f32::NAN, 2.0, -1.0], [1.0; 3], [0.25; 3]];
        let tints = round(&mesh, &strange, 32.0).unwrap();
        assert_eq!(tints, [[0, 32, 0], [32; 3], [16; 3]]);
    }
}
