//! `deform`: objects that follow control points.

use super::model::{Model, Part};
use super::objects::target;
use super::state::{Evaluator, Flow};
use super::watch::literals;
use crate::commands::build::{clay, options, row, takes};
use crate::commands::slot::{Placed, existing, vector};
use crate::commands::{CommandSpec, Names};
use crate::compiled::{Control, Deform};
use crate::given::Options;
use crate::limits::{MAX_CONTROL_OPERANDS, MAX_DEFORMED, STEPS_PER_VERTEX};
use crate::problem::{Outcome, Problem};
use crate::reader::Name;
use crate::syntax::Command;
use field::Skeleton;
use fit::Deformation;
use glam::DVec3;
use scene::{Form, ImplicitMesh, Shape};
use std::cell::RefCell;
use std::collections::HashMap;
use std::ops::Range;
use std::rc::Rc;
use std::sync::Arc;

/// Most deformations that are kept: a text is compiled at every keystroke, and while a control
/// point is dragged only its move changes.
const KEPT: usize = 4;
/// Most deformations that a run reports: a loop may carry out many.
const MOST_KEPT: usize = 64;

/// Coordinates of vertices with respect to controls.
struct Kept {
    vertices: Vec<DVec3>,
    controls: Vec<DVec3>,
    made: Result<Rc<Deformation>, fit::Error>,
}

thread_local! {
    static CACHE: RefCell<Vec<Kept>> = const { RefCell::new(Vec::new()) };
}

/// Computes the deformation of these vertices, or finds it where it is kept.
fn deformation(vertices: &[DVec3], controls: &[DVec3]) -> Result<Rc<Deformation>, fit::Error> {
    CACHE.with_borrow_mut(|cache| {
        let mut all = cache.iter();
        let found = all.position(|kept| kept.controls == controls && kept.vertices == vertices);
        if let Some(index) = found {
            cache[index..].rotate_left(1);
        } else {
            if cache.len() >= KEPT {
                cache.remove(0);
            }
            cache.push(Kept {
                vertices: vertices.to_vec(),
                controls: controls.to_vec(),
                made: Deformation::new(vertices, controls).map(Rc::new),
            });
        }
        cache[cache.len() - 1].made.clone()
    })
}

options! {
    /// Options of `deform`.
    DEFORM_OPTIONS:
    CONTROL: Placed<DVec3> = ("control", "", "a control point",
        vector("XYZ", "the control point").with_place());
    MOVE: Placed<DVec3> = ("move", "0 0 0", "by how much it moves what is near",
        vector("XYZ", "the way").with_place());
}

pub static DEFORM: CommandSpec = row("deform", "bend a mesh by control points")
    .with(takes!(
        deform,
        [DEFORM_OPTIONS],
        existing("object", Names::Object, "an object's name").optional("the last one")
    ))
    .newer()
    .most_operands(MAX_CONTROL_OPERANDS)
    .details(
        "Control points may lie anywhere, at most 4096; each takes along what is near when it \
         moves, and one without `move` holds it. All that is between follows smoothly (by natural \
         neighbours), and far away nothing moves. Triangles, patches and meshes can be deformed, \
         soft surfaces around meshes too.",
    )
    .example(clay!(
        "eyep 3 4 3\nfov 30\nvup 0 0 1\nmesh Clay gem.obj\n\
         deform { control <0 0 1> move <0.4 0 0.6>\n  control <0 0 0>\n  \
         control <0 0 -1> move <-0.4 0 0> }"
    ));

fn deform<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    options: &Options<'a>,
    object: Option<Name<'a>>,
) -> Outcome<Flow> {
    let range = target(run, command, object.as_ref())?;
    let text = run.sources.all[run.file].text;
    let points = controls(text, options)?;
    if points.is_empty() {
        return Err(
            Problem::new(&command.span, "there are no control points to deform with")
                .hint("write them as `deform { control <0 0 0> move <0 0 1> }`"),
        );
    }
    let vertices = Vertices::of(&run.model, range.clone(), &command.word_span)?;
    let work = vertices.places.len() as u64 * STEPS_PER_VERTEX + range.len() as u64;
    run.scope.step(work, &command.word_span)?;
    run.deformed += vertices.places.len();
    if run.deformed > MAX_DEFORMED {
        return Err(Problem::new(
            &command.word_span,
            format!("the deformations move more than {MAX_DEFORMED} vertices together"),
        )
        .hint("deform a mesh of fewer triangles, or fewer objects"));
    }
    let controls: Vec<DVec3> = points.iter().map(|control| control.place).collect();
    let moves: Vec<DVec3> = points.iter().map(|control| control.way).collect();
    let deformation = deformation(&vertices.places, &controls)
        .map_err(|error| Problem::new(&command.span, error.to_string()))?;
    let moved = deformation.apply(&vertices.places, &moves);
    let triangles = vertices.triangles(&run.model.parts[range.clone()]);
    let mut of: Vec<_> = run.model.parts[range.clone()]
        .iter()
        .map(|part| part.element.origin)
        .collect();
    of.dedup();
    vertices.put(&mut run.model.parts[range], &moved);
    if run.deforms.len() < MOST_KEPT {
        run.deforms.push(Deform {
            origin: run.origin(command),
            repeated: run.repeating > 0 || !run.is_own(),
            of,
            controls: points,
            positions: vertices.places.into(),
            triangles: triangles.into(),
        });
    }
    Ok(Flow::Next)
}

/// Reads the control points with their moves; points without one stay.
fn controls(text: &str, options: &Options<'_>) -> Outcome<Vec<Control>> {
    let mut controls: Vec<Control> = Vec::new();
    for chosen in options.iter() {
        if let Some((place, span)) = CONTROL.of(chosen) {
            controls.push(Control {
                place,
                way: DVec3::ZERO,
                span: with_brackets(text, span),
                way_span: None,
                is_literal: true,
            });
        }
        let Some((way, span)) = MOVE.of(chosen) else {
            continue;
        };
        let span = with_brackets(text, span);
        if let Some(last) = controls.last_mut().filter(|c| c.way_span.is_none()) {
            last.way = way;
            last.is_literal =
                literals(text, span.clone()).is_some_and(|numbers| numbers.len() == 3);
            last.way_span = Some(span);
        } else {
            return Err(Problem::new(
                &chosen.span,
                if controls.is_empty() {
                    "there is no control point before this `move`"
                } else {
                    "the control point before this `move` has been moved already"
                },
            )
            .hint("each move stands behind its point: `control <0 0 0> move <0 0 1>`"));
        }
    }
    Ok(controls)
}

/// Widens the range of a vector in a text to the signs that open and close it, where they are
/// written.
fn with_brackets(text: &str, span: Range<usize>) -> Range<usize> {
    let parts = (
        text.get(..span.start),
        text.get(span.clone()),
        text.get(span.end..),
    );
    let (Some(before), Some(inner), Some(after)) = parts else {
        return span;
    };
    let start = match before.trim_end() {
        _ if inner.starts_with('<') => span.start,
        opened if opened.ends_with('<') => opened.len() - 1,
        _ => return span,
    };
    let rest = after.trim_start();
    if inner.ends_with('>') {
        start..span.end
    } else if rest.starts_with('>') {
        start..text.len() - rest.len() + 1
    } else {
        span
    }
}

/// Vertices of some shapes, each once.
struct Vertices {
    places: Vec<DVec3>,
    /// The numbers of the corners of each shape, in turn.
    numbers: Vec<u32>,
}

impl Vertices {
    /// Collects the vertices of shapes.
    ///
    /// # Errors
    /// If a shape has none that could be moved.
    fn of(model: &Model<'_>, range: Range<usize>, span: &Range<usize>) -> Outcome<Self> {
        let (mut places, mut numbers) = (Vec::new(), Vec::new());
        let mut known = HashMap::new();
        for part in &model.parts[range] {
            let corners = corners(&part.element.shape).ok_or_else(|| {
                Problem::new(
                    span,
                    "only triangles, patches and meshes can be deformed, and this object has \
                     other shapes",
                )
                .hint("put the mesh into an object of its own")
            })?;
            for corner in corners {
                let bits = corner.to_array().map(f64::to_bits);
                let number = *known.entry(bits).or_insert_with(|| {
                    places.push(corner);
                    places.len() as u32 - 1
                });
                numbers.push(number);
            }
        }
        Ok(Self { places, numbers })
    }

    /// Returns the triangles between the vertices.
    fn triangles(&self, parts: &[Part]) -> Vec<[u32; 3]> {
        let mut triangles = Vec::new();
        let mut first = 0;
        for part in parts {
            match &part.element.shape {
                Shape::Bone(_) => {
                    triangles.push([0, 1, 2].map(|i| self.numbers[first + i]));
                    first += 3;
                }
                Shape::Function(function) => {
                    if let Form::Mesh(mesh) = &function.form {
                        let own = &self.numbers[first..];
                        triangles.extend(mesh.triangles.iter().map(|t| t.map(|i| own[i as usize])));
                        first += mesh.positions.len();
                    }
                }
                _ => {}
            }
        }
        triangles
    }

    /// Gives the shapes their vertices back, moved.
    fn put(&self, parts: &mut [Part], moved: &[DVec3]) {
        let mut places = self.numbers.iter().map(|&n| moved[n as usize]);
        let mut normals = Normals::default();
        for part in &mut *parts {
            match &mut part.element.shape {
                Shape::Bone(bone) => {
                    if let Skeleton::Triangle { corners } = &mut bone.skeleton {
                        let before = *corners;
                        *corners = corners.map(|_| places.next().unwrap_or(DVec3::ZERO));
                        if let Some(own) = &mut bone.normals {
                            normals.turn(&before, corners, own);
                        }
                    }
                }
                Shape::Function(function) => {
                    if let Form::Mesh(mesh) = &mut function.form {
                        let to_own = function.to_world.inverse();
                        let count = mesh.positions.len();
                        let positions = (0..count)
                            .map(|_| to_own.transform_point3(places.next().unwrap_or(DVec3::ZERO)));
                        *mesh = Arc::new(ImplicitMesh::new(
                            positions.collect(),
                            mesh.triangles.clone(),
                            mesh.kind,
                            mesh.sharpness,
                        ));
                    }
                }
                _ => {}
            }
        }
        for part in parts {
            if let Shape::Bone(bone) = &mut part.element.shape
                && let (Skeleton::Triangle { corners }, Some(own)) =
                    (&bone.skeleton, &mut bone.normals)
            {
                normals.mean(corners, own);
            }
        }
    }
}

/// Returns the corners of a shape that can be deformed.
fn corners(shape: &Shape) -> Option<Vec<DVec3>> {
    match shape {
        Shape::Bone(bone) => match bone.skeleton {
            Skeleton::Triangle { corners } => Some(corners.to_vec()),
            _ => None,
        },
        Shape::Function(function) => match &function.form {
            Form::Mesh(mesh) => {
                let places = mesh.positions.iter().copied();
                Some(
                    places
                        .map(|p| function.to_world.transform_point3(p))
                        .collect(),
                )
            }
            _ => None,
        },
        _ => None,
    }
}

/// Normals of patches: each patch turns them as its plane turns; patches that shared a normal at a
/// corner share the mean.
#[derive(Default)]
struct Normals {
    sums: HashMap<[u64; 6], DVec3>,
}

impl Normals {
    fn key(corner: DVec3, normal: DVec3) -> [u64; 6] {
        let [a, b, c] = corner.to_array().map(f64::to_bits);
        let [x, y, z] = normal.to_array().map(f64::to_bits);
        [a, b, c, x, y, z]
    }

    /// Turns the normals of a patch as its plane turns, and adds them to those of its corners.
    fn turn(&mut self, before: &[DVec3; 3], after: &[DVec3; 3], normals: &[DVec3; 3]) {
        let planes = [before, after].map(|[a, b, c]| (*b - *a).cross(*c - *a).try_normalize());
        // The shortest turn from one plane's normal to the other's, made of two reflections.
        let mirrors = match planes {
            [Some(from), Some(to)] => (from + to).try_normalize().map(|half| [from, half]),
            _ => None,
        };
        for (corner, normal) in after.iter().zip(normals) {
            let mut turned = *normal;
            for mirror in mirrors.iter().flatten() {
                turned -= *mirror * (2.0 * mirror.dot(turned));
            }
            *self.sums.entry(Self::key(*corner, *normal)).or_default() += turned;
        }
    }

    /// Gives a patch the mean normals of its corners.
    fn mean(&self, corners: &[DVec3; 3], normals: &mut [DVec3; 3]) {
        for (corner, normal) in corners.iter().zip(normals) {
            let mean = self.sums.get(&Self::key(*corner, *normal)).copied();
            *normal = mean.and_then(DVec3::try_normalize).unwrap_or(*normal);
        }
    }
}
