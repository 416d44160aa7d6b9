//! 3MF: the triangles of a package.
//!
//! Triangles of all objects that are to be built are read, each where its item and its components
//! put it, in millimetres; of the materials base materials and groups of colours.

use crate::error::{Error, fail};
use crate::formats::package::{Object, Package, Part, Property};
use crate::limits::MAX_MATERIALS;
use crate::triangle_mesh::{Group, Material, TriangleMesh};
use glam::DAffine3;
use std::collections::HashMap;

pub(super) fn read(bytes: &[u8]) -> Result<TriangleMesh, Error> {
    let package = Package::read(bytes)?;
    let mut has_colors = false;
    let mut has_beams = false;
    for part in &package.parts {
        let objects = part.objects.values();
        has_beams |= objects.clone().any(|object| object.lattice.is_some());
        let mut properties = objects
            .flat_map(|object| &object.triangles)
            .flat_map(|(_, properties)| properties.iter().flatten());
        has_colors |= properties.any(|(group, _)| part.colors.contains_key(group));
    }
    let mut mesh = TriangleMesh {
        colors: has_colors.then(Vec::new),
        ..TriangleMesh::default()
    };
    let millimetres = package.millimetres();
    package.visit(|part, object, place| add(part, object, place, millimetres, &mut mesh))?;
    if mesh.triangles.is_empty() && has_beams {
        return fail("there are no triangles in this file but beams: read it as a skeleton");
    }
    Ok(mesh)
}

/// Adds the triangles of an object.
fn add(
    part: &Part,
    object: &Object,
    place: &DAffine3,
    millimetres: f64,
    mesh: &mut TriangleMesh,
) -> Result<(), Error> {
    let is_mirrored = place.matrix3.determinant() < 0.0;
    // A vertex becomes one for each colour it has.
    let mut vertices: HashMap<(u32, Option<Property>), u32> = HashMap::new();
    let mut group: Option<(Option<&Material>, u32)> = None;
    for (corners, properties) in &object.triangles {
        let material = properties[0].and_then(|(id, index)| {
            part.materials
                .get(&id)
                .and_then(|list| list.get(index as usize))
        });
        let start = mesh.triangles.len() as u32;
        if let Some((own, since)) = group
            && own != material
        {
            mesh.groups.push(new_group(object, own, since..start));
            group = None;
        }
        group = group.or(Some((material, start)));
        let mut triangle = [0; 3];
        for (own, (corner, property)) in triangle.iter_mut().zip(corners.iter().zip(properties)) {
            let property = property.filter(|(id, _)| part.colors.contains_key(id));
            if let Some(known) = vertices.get(&(*corner, property)) {
                *own = *known;
                continue;
            }
            let Some(position) = object.positions.get(*corner as usize) else {
                return fail(format!(
                    "a triangle of this 3MF file has vertex {corner} (from 0) of {}",
                    object.positions.len()
                ));
            };
            *own = mesh.add_vertex(place.transform_point3(*position) * millimetres)?;
            if let Some(colors) = &mut mesh.colors {
                colors.push(color_of(part, property, material));
            }
            vertices.insert((*corner, property), *own);
        }
        if is_mirrored {
            triangle.swap(1, 2);
        }
        mesh.add_triangle(triangle)?;
    }
    if let Some((own, since)) = group {
        mesh.groups
            .push(new_group(object, own, since..mesh.triangles.len() as u32));
    }
    if mesh.groups.len() > MAX_MATERIALS {
        return fail(format!(
            "this 3MF file has more than {MAX_MATERIALS} groups"
        ));
    }
    Ok(())
}

fn color_of(part: &Part, property: Option<Property>, material: Option<&Material>) -> [f32; 3] {
    let own = property.and_then(|(id, i)| part.colors.get(&id)?.get(i as usize));
    own.copied()
        .or(material.map(|m| m.color))
        .unwrap_or([1.0; 3])
}

fn new_group(
    object: &Object,
    material: Option<&Material>,
    triangles: core::ops::Range<u32>,
) -> Group {
    Group {
        name: object.name.clone(),
        material: material.cloned(),
        triangles,
    }
}
