//! Parts checked and rounded: what all writers start from.

use super::export::{Export, Part};
use crate::error::{Error, fail};
use crate::limits::{MAX_EXPORT_TRIANGLES, MAX_MATERIALS};
use crate::triangle_mesh::{Material, TriangleMesh};
use core::ops::Range;
use glam::DVec3;

/// Part whose indices are in range and whose lists are as long as its positions.
pub(super) struct Prepared<'a> {
    pub(super) name: &'a str,
    pub(super) mesh: &'a TriangleMesh,
    /// Millimetres from the files' origin.
    pub(super) positions: Vec<[f32; 3]>,
    /// Normals of length 1.
    pub(super) normals: Option<Vec<[f32; 3]>>,
    /// Ranges of triangles of one material, which hold all triangles.
    pub(super) segments: Vec<Segment<'a>>,
}

/// Triangles of one material.
pub(super) struct Segment<'a> {
    pub(super) name: &'a str,
    /// Index into [`materials`].
    pub(super) material: Option<usize>,
    pub(super) triangles: Range<usize>,
}

impl Segment<'_> {
    /// Returns triangles without a name and a material.
    fn bare(triangles: Range<usize>) -> Self {
        Self {
            name: "",
            material: None,
            triangles,
        }
    }
}

impl Prepared<'_> {
    /// Vertex colours: the mesh's, else the materials' of the first triangles, else white.
    pub(super) fn colors(&self, materials: &[&Material]) -> Vec<[f32; 3]> {
        if let Some(colors) = &self.mesh.colors {
            return colors.clone();
        }
        let mut colors = vec![None; self.positions.len()];
        for segment in &self.segments {
            let Some(material) = segment.material else {
                continue;
            };
            for i in self.mesh.triangles[segment.triangles.clone()].as_flattened() {
                colors[*i as usize].get_or_insert(materials[material].color);
            }
        }
        colors.into_iter().map(|c| c.unwrap_or([1.0; 3])).collect()
    }

    /// `true` if there is a colour to write.
    pub(super) fn is_colored(&self) -> bool {
        self.mesh.colors.is_some() || self.segments.iter().any(|s| s.material.is_some())
    }
}

impl Export {
    /// The meshes as every format has them: in millimetres from [`Export::shift`], rounded to 32
    /// bits. Proofs about a file (that nothing intersects, say) are to be made for these.
    ///
    /// # Errors
    /// Fails as [`Export::write`] does.
    pub fn round(&self) -> Result<Vec<TriangleMesh>, Error> {
        let parts = prepare(self)?;
        Ok(parts
            .iter()
            .map(|part| TriangleMesh {
                positions: part
                    .positions
                    .iter()
                    .map(|p| DVec3::from(p.map(f64::from)))
                    .collect(),
                ..part.mesh.clone()
            })
            .collect())
    }
}

/// The different materials of all parts, in the order of their first use.
pub(super) fn materials(export: &Export) -> Vec<&Material> {
    let mut materials: Vec<&Material> = Vec::new();
    for material in export.parts.iter().flat_map(|part| &part.mesh.groups) {
        let material = material.material.as_ref();
        materials.extend(material.filter(|m| !materials.contains(m)));
    }
    materials
}

/// Checks and rounds all parts.
pub(super) fn prepare(export: &Export) -> Result<Vec<Prepared<'_>>, Error> {
    if !(export.millimetres.is_finite() && export.millimetres > 0.0) {
        return fail("the length of a unit must be a positive number of millimetres");
    }
    let count: usize = export.parts.iter().map(|p| p.mesh.triangles.len()).sum();
    if count == 0 {
        return fail("there are no triangles to write");
    }
    if count > MAX_EXPORT_TRIANGLES {
        return fail(format!(
            "{count} triangles are more than the {MAX_EXPORT_TRIANGLES} that a file may have; \
             choose a larger tolerance or simplify the mesh"
        ));
    }
    let groups: usize = export.parts.iter().map(|p| p.mesh.groups.len() + 1).sum();
    if groups > MAX_MATERIALS {
        return fail(format!("more than {MAX_MATERIALS} parts and groups"));
    }
    let materials = materials(export);
    let shift = export.shift();
    export
        .parts
        .iter()
        .filter(|part| !part.mesh.triangles.is_empty())
        .map(|part| prepare_part(part, (export.millimetres, shift), &materials))
        .collect()
}

fn prepare_part<'a>(
    part: &'a Part,
    (millimetres, shift): (f64, DVec3),
    materials: &[&Material],
) -> Result<Prepared<'a>, Error> {
    let mesh = &part.mesh;
    let count = mesh.positions.len();
    let wrong = |what: &str| fail(format!("the part `{}` {what}", part.name));
    if mesh
        .triangles
        .as_flattened()
        .iter()
        .any(|i| *i as usize >= count)
    {
        return wrong("has a triangle with a vertex that does not exist");
    }
    if count > 3 * MAX_EXPORT_TRIANGLES {
        return wrong("has more vertices than triangles can use");
    }
    let lengths = [
        mesh.normals.as_ref().map(Vec::len),
        mesh.colors.as_ref().map(Vec::len),
    ];
    if lengths.into_iter().flatten().any(|length| length != count) {
        return wrong("has not as many normals or colours as vertices");
    }
    let positions: Vec<[f32; 3]> = mesh
        .positions
        .iter()
        .map(|p| (*p * millimetres - shift).to_array().map(|x| x as f32))
        .collect();
    if positions.as_flattened().iter().any(|x| !x.is_finite()) {
        return wrong("has a vertex that is too far away");
    }
    let mut segments = Vec::new();
    let mut end = 0;
    for group in &mesh.groups {
        let range = group.triangles.start as usize..group.triangles.end as usize;
        if range.start < end || range.end < range.start || range.end > mesh.triangles.len() {
            return wrong("has groups that overlap or go beyond its triangles");
        }
        if range.start > end {
            segments.push(Segment::bare(end..range.start));
        }
        end = range.end;
        let own = group.material.as_ref();
        if own.is_some_and(|m| !m.color.iter().all(|x| x.is_finite()) || !m.roughness.is_finite()) {
            return wrong("has a material whose colour or roughness is no number");
        }
        if !range.is_empty() {
            segments.push(Segment {
                name: &group.name,
                material: own.and_then(|own| materials.iter().position(|m| *m == own)),
                triangles: range,
            });
        }
    }
    if end < mesh.triangles.len() {
        segments.push(Segment::bare(end..mesh.triangles.len()));
    }
    Ok(Prepared {
        name: &part.name,
        mesh,
        positions,
        normals: mesh.normals.as_ref().map(|n| unit_normals(mesh, n)),
        segments,
    })
}

fn is_missing(normal: &DVec3) -> bool {
    normal.normalize_or_zero() == DVec3::ZERO
}

/// Normals of length 1: where there is none, the mean of the triangles' around, by area.
fn unit_normals(mesh: &TriangleMesh, normals: &[DVec3]) -> Vec<[f32; 3]> {
    let mut own = vec![DVec3::ZERO; normals.len()];
    if normals.iter().any(is_missing) {
        for (i, triangle) in mesh.triangles.iter().enumerate() {
            let [a, b, c] = mesh.corners(i);
            for v in triangle {
                own[*v as usize] += (b - a).cross(c - a);
            }
        }
    }
    normals
        .iter()
        .zip(&own)
        .map(|(given, own)| {
            let normal = if is_missing(given) { own } else { given };
            normal.normalize_or(DVec3::Z).to_array().map(|x| x as f32)
        })
        .collect()
}

/// The means of the normals of the triangles around each vertex, by area.
pub(super) fn mean_normals(mesh: &TriangleMesh) -> Vec<[f32; 3]> {
    unit_normals(mesh, &vec![DVec3::ZERO; mesh.positions.len()])
}

/// Returns a name on one line, without characters that would end it in a text format; `other` if
/// none is left.
pub(super) fn line_name(name: &str, other: &str) -> String {
    let kept: String = name
        .chars()
        .filter(|c| !c.is_control() && !matches!(c, '#' | '\\'))
        .take(100)
        .collect();
    match kept.trim() {
        "" => other.into(),
        kept => kept.into(),
    }
}

/// Numbers as 32-bit floats, lowest byte first.
pub(super) fn put_floats(bytes: &mut Vec<u8>, numbers: &[f32]) {
    for x in numbers {
        bytes.extend(x.to_le_bytes());
    }
}
