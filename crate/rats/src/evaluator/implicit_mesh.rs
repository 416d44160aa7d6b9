//! `mesh … metaballs`: meshes as soft shapes.

use super::state::{Evaluator, Flow};
use crate::commands::build::options;
use crate::commands::slot::{length, number};
use crate::given::Options;
use crate::problem::{Outcome, Problem};
use crate::reader::Name;
use crate::syntax::Command;
use field::Kernel;
use glam::DAffine3;
use mesh::{Topology, TriangleMesh};
use metaballs::Kind;
use scene::{Form, Function, ImplicitMesh, Shape};
use std::ops::Range;
use std::sync::Arc;

/// Least product of k and the mean edge: below it the balls of many facets add up, and the surface
/// bulges.
const LEAST: f64 = 10.0;

options! {
    /// `mesh` as an implicit surface.
    MESH_OPTIONS:
    METABALLS: () = ("metaballs", "",
        "a soft surface around the mesh, of one metaball a facet: `spherical` \
         or `triangular` (ours)");
    SPHERICAL: f64 = ("spherical", "", "of balls around the circumcircles of the facets",
        number("k", "how sharply the field falls"));
    TRIANGULAR: (f64, f64) = ("triangular", "", "of shells of this thickness around the facets",
        length("d0", "the thickness").at_least(0.0), number("k", "how sharply the field falls"));
}

/// Returns the surroundings of the facets, k, and the place of the two in the text; `None` if the
/// mesh is to be drawn as it is.
///
/// # Errors
/// If `metaballs` has no kind, or two, or a kind stands alone.
pub fn metaballs(options: &Options<'_>) -> Outcome<Option<(Kind, f64, Range<usize>)>> {
    let (spherical, triangular) = (options.find(&SPHERICAL), options.find(&TRIANGULAR));
    let Some(word) = options.find(&METABALLS) else {
        return match spherical.or(triangular) {
            None => Ok(None),
            Some(chosen) => {
                let kind = chosen.option.name;
                Err(Problem::new(
                    &chosen.span,
                    format!("`{kind}` is a kind of `metaballs`, which is missing"),
                )
                .hint(format!("write `metaballs {kind}`")))
            }
        };
    };
    if let (Some(_), Some(second)) = (spherical, triangular) {
        return Err(Problem::new(
            &second.span,
            "metaballs are spherical or triangular, not both",
        ));
    }
    if let Some((chosen, k)) = spherical.and_then(|c| Some((c, SPHERICAL.of(c)?))) {
        return Ok(Some((Kind::Spherical, k, chosen.span.clone())));
    }
    if let Some((chosen, (thickness, k))) = triangular.and_then(|c| Some((c, TRIANGULAR.of(c)?))) {
        return Ok(Some((
            Kind::Triangular { thickness },
            k,
            chosen.span.clone(),
        )));
    }
    let problem = Problem::new(&word.span, "expected the kind of metaballs behind this");
    Err(problem.hint("write `metaballs triangular d0 k` or `metaballs spherical k`"))
}

/// Adds the implicit surface of a mesh as one soft shape.
pub fn add<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    name: &Name<'a>,
    topology: Option<Topology>,
    mesh: &TriangleMesh,
    (kind, k, span): (Kind, f64, Range<usize>),
) -> Outcome<Flow> {
    let material = run.material(name)?;
    run.scope
        .step(mesh.triangles.len() as u64, &command.word_span)?;
    if k <= 0.0 {
        return Err(Problem::new(
            &span,
            format!("k must be a number above 0, not {k}"),
        ));
    }
    let own = ImplicitMesh::new(mesh.positions.clone(), mesh.triangles.clone(), kind, k);
    let function = Function {
        form: Form::Mesh(Arc::new(own)),
        to_world: DAffine3::IDENTITY,
    };
    warn_of_bulges(run, mesh, k, &span);
    note_topology(run, topology, &command.span);
    let shape = Shape::Function(Box::new(function));
    run.add_of(command, material, shape, Kernel::Cauchy)
}

/// Warns where k is small for the mesh.
fn warn_of_bulges(run: &mut Evaluator<'_>, mesh: &TriangleMesh, k: f64, span: &Range<usize>) {
    let edge = fit::mean_edge(&mesh.positions, &mesh.triangles);
    let product = k * edge;
    if product < LEAST && edge > 0.0 {
        let bulges = format_args!("below {LEAST} the surface bulges where facets are small");
        let message = format_args!("k times the mean edge is {product:.2}: {bulges}");
        let hint = format_args!("a k of {} would do", round_up(LEAST / edge));
        run.warn(span, message, hint);
    }
}

/// Notes what an open mesh, or one that is no manifold, looks like.
fn note_topology(run: &mut Evaluator<'_>, topology: Option<Topology>, span: &Range<usize>) {
    let Some(topology) = topology.filter(|t| !t.is_closed_manifold()) else {
        return;
    };
    let edges = topology.boundary_edges;
    if edges > 0 {
        let open = format_args!("this mesh is open ({edges} edges have one facet only)");
        let shell = "its soft surface is a shell with a rim, not a solid";
        run.note(span, format_args!("{open}, so {shell}"), "");
    } else {
        let around = "its soft surface is around all of its facets all the same";
        run.note(span, format_args!("this mesh is no manifold; {around}"), "");
    }
}

/// Rounds a number up to two digits.
fn round_up(value: f64) -> f64 {
    let mut unit = 1.0;
    while unit * 10.0 <= value {
        unit *= 10.0;
    }
    while unit > value {
        unit /= 10.0;
    }
    let digits = (value * 10.0 / unit - 1e-9).ceil();
    // Divided by a whole number where that is exact.
    if unit >= 10.0 {
        digits * (unit / 10.0)
    } else {
        digits / (10.0 / unit).round()
    }
}

#[cfg(test)]
mod tests {
    use super::round_up;

    #[test]
    fn numbers_are_rounded_up_to_two_digits() {
        for (value, up) in [
            (12.01, 13.0),
            (123.4, 130.0),
            (0.0511, 0.052),
            (9.99, 10.0),
            (20.0, 20.0),
        ] {
            assert_eq!(round_up(value), up);
        }
    }
}
