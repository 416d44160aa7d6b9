//! PLY: vertices, and the element `edge` with `vertex1` and `vertex2`.

use super::Reading;
use super::radii::{find, list};
use crate::draft::{Draft, UNKNOWN};
use crate::error::{Error, fail, shorten};
use crate::graph::{Cap, Graph, Limb};
use crate::limits::{MAX_LISTED, MAX_POINTS};
use glam::DVec3;
use mesh::formats::ply::{Element, Row, elements, visit};

/// Edge between two vertices, with a radius of its own or [`UNKNOWN`].
type Edge = ([u32; 2], f64);

/// Reads a PLY file; `None` if it has no edges.
pub(super) fn read(bytes: &[u8], reading: &Reading<'_>) -> Result<Option<Graph>, Error> {
    let elements = elements(bytes)?;
    if !elements.iter().any(|element| element.name == "edge") {
        return Ok(None);
    }
    for (name, most) in [("vertex", MAX_POINTS), ("edge", MAX_LISTED)] {
        let count = elements
            .iter()
            .find(|e| e.name == name)
            .map_or(0, |e| e.count);
        if count > most as u64 {
            return fail(format!(
                "this file has {count} of `{name}`, more than the {most} that are taken"
            ));
        }
    }
    check_radii(&elements, reading)?;
    let mut draft = Draft::new(None);
    let group = draft.group("", None)?;
    let mut edges: Vec<Edge> = Vec::new();
    visit(bytes, |element, row| {
        let added = match element.name {
            "vertex" => add_vertex(element, row, reading, &mut draft),
            "edge" => edge(element, row, reading).map(|edge| edges.push(edge)),
            _ => Ok(()),
        };
        added.map_err(|Error(text)| element.wrong(row.index, &text))
    })?;
    let faces = elements.iter().filter(|element| element.name == "face");
    let faces: u64 = faces.map(|element| element.count).sum();
    let text = "faces are left out: this file is read as a skeleton";
    draft.remark_count(faces as usize, text);
    for (i, (ends, radius)) in edges.into_iter().enumerate() {
        if let Some(beyond) = ends.iter().find(|end| **end as usize >= draft.count()) {
            let count = draft.count();
            return fail(format!(
                "`edge` {i} (from 0): it has vertex {beyond} (from 0) of {count}"
            ));
        }
        let radii = match radius {
            UNKNOWN => ends.map(|end| draft.radius(end)),
            radius => [radius; 2],
        };
        draft.add(Limb {
            ends,
            radii,
            group,
            caps: [Cap::Round; 2],
            clip: None,
        })?;
    }
    draft.weld();
    draft.finish(reading.radius).map(Some)
}

/// Checks that there is the property of radii that is asked for.
fn check_radii(elements: &[Element<'_>], reading: &Reading<'_>) -> Result<(), Error> {
    let Some(wanted) = reading.radii else {
        return Ok(());
    };
    let elements = elements
        .iter()
        .filter(|e| matches!(e.name, "vertex" | "edge"));
    let names = elements
        .flat_map(|element| &element.properties)
        .map(|p| p.name);
    match find(names.clone(), Some(wanted)) {
        Some(_) => Ok(()),
        None => fail(format!(
            "this file has no property `{}`; its properties are {}",
            shorten(wanted),
            list(names)
        )),
    }
}

/// Returns the radius in a row; [`UNKNOWN`] without one.
fn radius(element: &Element<'_>, row: &Row, reading: &Reading<'_>) -> f64 {
    let names = element.properties.iter().map(|property| property.name);
    find(names, reading.radii).map_or(UNKNOWN, |radii| row.values[radii.index] * radii.factor)
}

fn add_vertex(
    element: &Element<'_>,
    row: &Row,
    reading: &Reading<'_>,
    draft: &mut Draft,
) -> Result<(), Error> {
    let [Some(x), Some(y), Some(z)] = ["x", "y", "z"].map(|name| element.column(&[name])) else {
        return fail("it has no x, y and z");
    };
    let position = DVec3::from([x, y, z].map(|column| row.values[column]));
    draft.node(position, radius(element, row, reading), 0)?;
    Ok(())
}

fn edge(element: &Element<'_>, row: &Row, reading: &Reading<'_>) -> Result<Edge, Error> {
    let columns = [
        &["vertex1", "vertex_1", "v1"][..],
        &["vertex2", "vertex_2", "v2"],
    ];
    let ends = match columns.map(|names| element.column(names)) {
        [Some(a), Some(b)] => [a, b].map(|column| row.values[column]),
        _ => match row
            .lists
            .iter()
            .find(|list| !list.is_empty())
            .map(|list| &list[..])
        {
            Some(&[a, b]) => [a, b],
            _ => return fail("it has no `vertex1` and `vertex2`"),
        },
    };
    for end in ends {
        if !(0.0..f64::from(u32::MAX)).contains(&end) || end != end.trunc() {
            return fail("a vertex is no whole number from 0");
        }
    }
    Ok((
        ends.map(|end| end as u32),
        radius(element, row, reading).max(UNKNOWN),
    ))
}
