//! fidget-mesh, with the field as a tree of operations that fidget compiles for the processor.

use fidget_core::context::Tree;
use fidget_jit::JitShape;
use fidget_mesh::{Octree, Settings};
use field::Kernel;
use field::Skeleton;
use glam::DVec3;
use mesh::{Aabb, TriangleMesh};
use nalgebra::Matrix4;
use scene::{Element, Scene, Shape};

/// The field of soft balls with the quartic kernel, `c·(1 − r²/D²)²` within `D = R·√(1 + 2/|B|)`,
/// with `c` so that it is 1 at `R`.
///
/// # Errors
/// Anything else in the scene.
pub fn tree(scene: &Scene) -> Result<Tree, String> {
    let ball = |element: &Element| {
        let Some(&Skeleton::Point { center }) = element.shape.skeleton() else {
            return Err("only balls can be given to fidget");
        };
        let flesh = element.flesh.and_then(|i| scene.flesh.get(i as usize));
        let flesh = flesh.ok_or("only soft balls can be given to fidget")?;
        if flesh.kernel.unwrap_or(element.kernel) != Kernel::Quartic {
            return Err("only the quartic kernel can be given to fidget");
        }
        let radius = scene.radius(element);
        let reach = radius * (1.0 + 2.0 / flesh.blobbiness.unwrap_or(0.0)).sqrt();
        let square = |of: Tree, middle: f64| (of - middle as f32).square();
        let distance =
            square(Tree::x(), center.x) + square(Tree::y(), center.y) + square(Tree::z(), center.z);
        let rest = Tree::constant(1.0) - distance * (1.0 / (reach * reach)) as f32;
        let peak = (1.0 - (radius / reach).powi(2)).powi(-2);
        Ok(rest.max(0.0).square() * peak as f32)
    };
    let balls: Result<Vec<Tree>, _> = scene.elements.iter().map(ball).collect();
    Ok(1.0 - sum(&balls?))
}

/// A sum whose tree is no deeper than need be.
fn sum(terms: &[Tree]) -> Tree {
    match terms {
        [] => Tree::constant(0.0),
        [one] => one.clone(),
        _ => {
            let (a, b) = terms.split_at(terms.len() / 2);
            sum(a) + sum(b)
        }
    }
}

/// Makes the mesh in a box with cells of an edge length. The time for compiling the tree is part of
/// it.
///
/// # Errors
/// Fidget's.
pub fn mesh(tree: &Tree, bounds: &Aabb, edge: f64) -> Result<TriangleMesh, String> {
    let mut depth = 1;
    let mut half = edge;
    while 2.0 * half < bounds.size().max_element() {
        depth += 1;
        half *= 2.0;
    }
    let middle = bounds.center();
    let shape = JitShape::from(tree.clone());
    let shape = shape.try_into().map_err(|_| "the tree has variables")?;
    let settings = Settings {
        depth,
        world_to_model: Matrix4::new_translation(&middle.as_vec3().to_array().into())
            * Matrix4::new_scaling(half as f32),
        threads: None,
        ..Settings::default()
    };
    let octree = Octree::build(&shape, &settings).ok_or("it was cancelled")?;
    let made = octree.walk_dual();
    let position = |v: &nalgebra::Vector3<f32>| DVec3::new(v.x.into(), v.y.into(), v.z.into());
    Ok(TriangleMesh::new(
        made.vertices.iter().map(position).collect(),
        made.triangles
            .iter()
            .map(|t| [t.x, t.y, t.z].map(|i| i as u32))
            .collect(),
    ))
}
