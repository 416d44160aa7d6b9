//! 3MF: the beam lattices of a package.

use super::Reading;
use crate::draft::Draft;
use crate::error::{Error, fail};
use crate::graph::{Cap, Clip, Graph, Limb, Side, growth};
use glam::{DAffine3, DVec3};
use mesh::TriangleMesh;
use mesh::formats::package::{Lattice, Object, Package, Part, Property};
use mesh::limits::MAX_TRIANGLES;
use std::collections::HashMap;

/// Share by which a map's scales may differ along its axes before radii are said to be rough.
const UNEVEN: f64 = 1e-6;

/// Reads a 3MF file, in millimetres; `None` if it has no beams.
pub(super) fn read(bytes: &[u8], reading: &Reading<'_>) -> Result<Option<Graph>, Error> {
    let package = Package::read(bytes)?;
    let millimetres = package.millimetres();
    let mut draft = Draft::new(Some(1.0));
    let mut counts = Counts::default();
    package.visit(|part, object, place| {
        let place = DAffine3::from_scale(DVec3::splat(millimetres)) * *place;
        counts.triangles += object.triangles.len();
        let Some(lattice) = &object.lattice else {
            return Ok(());
        };
        add(
            &package,
            (part, object),
            lattice,
            &place,
            &mut draft,
            &mut counts,
        )
        .map_err(|Error(text)| mesh::Error(text))
    })?;
    if draft.is_bare() {
        return Ok(None);
    }
    let text = "beams are shorter than the lattice allows and are left out";
    draft.remark_count(counts.short, text);
    let text = "lattices are scaled unevenly: radii are scaled by the mean";
    draft.remark_count(counts.uneven, text);
    let text = "triangles beside the beams are left out: this file is read as a skeleton";
    draft.remark_count(counts.triangles, text);
    let text = "lattices have a mesh that clips them, which pictures leave out";
    draft.remark_count(counts.clips, text);
    draft.weld();
    draft.finish(reading.radius).map(Some)
}

/// Numbers of what there are remarks about.
#[derive(Default)]
struct Counts {
    short: usize,
    uneven: usize,
    triangles: usize,
    clips: usize,
    /// Triangles or vertices of the meshes that clip.
    clipping: usize,
}

/// Adds a lattice at a place, in millimetres.
fn add(
    package: &Package,
    (part, object): (&Part, &Object),
    lattice: &Lattice,
    place: &DAffine3,
    draft: &mut Draft,
    counts: &mut Counts,
) -> Result<(), Error> {
    let growth = growth(place);
    let scales = place
        .matrix3
        .to_cols_array_2d()
        .map(|axis| DVec3::from(axis).length());
    let is_uneven = scales
        .iter()
        .any(|scale| (scale - growth).abs() > UNEVEN * growth);
    counts.uneven += usize::from(is_uneven);
    let clip = clip(package, part, lattice, place, &mut counts.clipping)?;
    counts.clips += usize::from(clip.is_some());
    let clip = clip.map(|clip| draft.clip(clip));
    // The node of each vertex that is used.
    let mut nodes: HashMap<u32, u32> = HashMap::new();
    for beam in &lattice.beams {
        let places = beam.ends.map(|end| position(object, end));
        let [a, b] = [places[0].clone()?, places[1].clone()?];
        if a.distance(b) < lattice.least_length {
            counts.short += 1;
            continue;
        }
        let (name, color) = kind(part, object, beam.property);
        let group = draft.group(name, color)?;
        let radii = beam.radii.map(|radius| radius * growth);
        let mut ends = [0; 2];
        for ((own, end), (at, radius)) in ends
            .iter_mut()
            .zip(beam.ends)
            .zip([a, b].into_iter().zip(radii))
        {
            *own = match nodes.get(&end) {
                Some(node) => *node,
                None => {
                    let node = draft.node(place.transform_point3(at), radius, group)?;
                    nodes.insert(end, node);
                    node
                }
            };
            draft.widen(*own, radius);
            if let Some(radius) = lattice.ball_everywhere {
                draft.widen(*own, radius * growth);
                draft.ball(*own);
            }
        }
        draft.add(Limb {
            ends,
            radii,
            group,
            caps: beam
                .is_flat
                .map(|is_flat| if is_flat { Cap::Flat } else { Cap::Round }),
            clip,
        })?;
    }
    for (vertex, radius) in &lattice.balls {
        let at = place.transform_point3(position(object, *vertex)?);
        let (name, color) = kind(part, object, object.property);
        let group = draft.group(name, color)?;
        let node = match nodes.get(vertex) {
            Some(node) => *node,
            None => draft.node(at, 0.0, group)?,
        };
        nodes.insert(*vertex, node);
        draft.widen(node, radius * growth);
        draft.ball(node);
    }
    Ok(())
}

fn position(object: &Object, vertex: u32) -> Result<DVec3, Error> {
    match object.positions.get(vertex as usize) {
        Some(position) => Ok(*position),
        None => fail(format!(
            "a beam of this 3MF file has vertex {vertex} (from 0) of {}",
            object.positions.len()
        )),
    }
}

/// Returns the name of a kind of beams and its colour: the material's, else the object's name.
fn kind<'a>(
    part: &'a Part,
    object: &'a Object,
    property: Option<Property>,
) -> (&'a str, Option<[f32; 3]>) {
    let material = property.and_then(|(id, i)| part.materials.get(&id)?.get(i as usize));
    let color = property.and_then(|(id, i)| part.colors.get(&id)?.get(i as usize));
    match material {
        Some(material) => (&material.name, Some(material.color)),
        None => (&object.name, color.copied()),
    }
}

/// Returns the mesh that a lattice is clipped by, at its place: an object's, with those of its
/// components. Adds its size to a total, which is bounded.
fn clip(
    package: &Package,
    part: &Part,
    lattice: &Lattice,
    place: &DAffine3,
    total: &mut usize,
) -> Result<Option<Clip>, Error> {
    let Some((is_inside, id)) = lattice.clip else {
        return Ok(None);
    };
    let mut mesh = TriangleMesh::default();
    package.visit_object(part, id, place, |_, object, place| {
        let (first, count) = (mesh.positions.len(), object.positions.len());
        *total += object.triangles.len().max(count);
        if *total > MAX_TRIANGLES {
            return Err(mesh::Error(format!(
                "the meshes that clip lattices have more than {MAX_TRIANGLES} triangles or vertices"
            )));
        }
        let is_mirror = place.matrix3.determinant() < 0.0;
        for (corners, _) in &object.triangles {
            if let Some(beyond) = corners.iter().find(|i| **i as usize >= count) {
                return Err(mesh::Error(format!(
                    "a triangle of this 3MF file has vertex {beyond} (from 0) of {count}"
                )));
            }
            let [a, b, c] = corners.map(|i| first as u32 + i);
            mesh.triangles.push(match is_mirror {
                true => [a, c, b],
                false => [a, b, c],
            });
        }
        let positions = object.positions.iter();
        mesh.positions
            .extend(positions.map(|p| place.transform_point3(*p)));
        Ok(())
    })?;
    Ok(Some(Clip {
        side: if is_inside {
            Side::Inside
        } else {
            Side::Outside
        },
        mesh,
    }))
}
