//! Datasets that show the skeleton of a file.

use glam::DVec3;
use limbs::{Graph, Recipe};
use rats::{Asset, File, Project};
use std::fmt::Write as _;
use std::path::Path;

/// Returns the lines of a text that frame and light a skeleton and define the material `Flesh`.
pub fn write(graph: &Graph) -> String {
    let mut low = DVec3::INFINITY;
    let mut high = DVec3::NEG_INFINITY;
    for node in &graph.nodes {
        low = low.min(node.position - node.radius);
        high = high.max(node.position + node.radius);
    }
    let middle = 0.5 * (low + high);
    let reach = 0.5 * low.distance(high);
    let mut text = format!("# {} limbs\n", graph.limbs.len());
    let [eye, light] = [DVec3::new(0.3, 0.35, 1.0), DVec3::new(-0.6, 1.2, 1.0)]
        .map(|way| middle + way.normalize() * (3.2 * reach));
    for (word, place) in [
        ("light White, position", light),
        ("eyep", eye),
        ("vrp", middle),
    ] {
        // Writing to a string does not fail.
        let _ = writeln!(text, "{word} {} {} {}", place.x, place.y, place.z);
    }
    text + "fov 40\nsurface Flesh, diffuse SandyBrown, specular Gray50, shine 40, radius 1, \
        kernel compact6, blobbiness -8\n"
}

/// Makes a project that draws the skeleton of a file, given its bytes.
///
/// # Errors
/// If the file holds no limbs.
pub fn make_project(path: &Path, bytes: Vec<u8>) -> Result<(Project, Asset), String> {
    let ending = path.extension().unwrap_or_default().to_string_lossy();
    let (shown, recipe) = (path.display(), Recipe::default());
    let graph = recipe
        .make(&shown.to_string(), &bytes)
        .map_err(|error| format!("{shown}: {error}"))?;
    // A name that the language can write, whatever the file is called.
    let asset = Asset::new(format!("skeleton.{}", ending.to_lowercase()), bytes);
    let text = write(&graph) + &format!("skeleton Flesh, SKELETON {}\n", asset.name);
    asset.keep_skeleton(recipe, Ok(graph));
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let name = format!("{stem}.rat");
    let files = vec![File { name, text }];
    Ok((Project { files }, asset))
}
