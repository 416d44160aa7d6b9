//! PRIMITIVES: shapes made of a material.

use super::curves::{LIMB_OPTIONS, POINT_OPTIONS, ends_of};
use super::implicit_mesh::{self, MESH_OPTIONS};
use super::model::Part;
use super::state::{Evaluator, Flow};
use super::tints;
use crate::Severity;
use crate::commands::build::{by_itself, clay, flesh, options, plain, reads, row, takes, word_of};
use crate::commands::slot::{
    Named, SN, Slot, degrees, direction, file, length, number, triple, vector,
};
use crate::commands::{CommandSpec, OptionSpec, Role, Routine};
use crate::geometry::{self, ThreePoints, Transform};
use crate::given::Options;
use crate::limits::MAX_CORNERS;
use crate::problem::{Outcome, Problem};
use crate::reader::Name;
use crate::strokes::{self, Sculpted};
use crate::syntax::Command;
use crate::{Asset, assets, is_strokes};
use field::Kernel;
use field::Skeleton;
use glam::{DMat3, DVec3};
use mesh::TriangleMesh;
use scene::{Element, Ends, Quadric, Shape};
use std::ops::Range;
use std::rc::Rc;

/// Makes the form of a command that makes one shape: the function that adds the shape, the shape,
/// and the operands behind the material:
/// `makes!(add, |radius, center| Shape::sphere(center, radius), …)`. The list of options of limbs
/// may stand before the shape, in brackets.
macro_rules! makes {
    ($add:ident $(($kernel:expr))?, |$($value:ident),+| $shape:expr, $($slot:expr),+ $(,)?) => {
        makes!($add $(($kernel))?, [&[]], |$($value),+| $shape, $($slot),+)
    };
    (
        $add:ident $(($kernel:expr))?, [$options:expr],
        |$($value:ident),+| $shape:expr, $($slot:expr),+ $(,)?
    ) => {
        by_itself(
            |run, command| {
                let given = run.read_given(command)?;
                let mut values = given.values();
                let sn = values.take(|| SN)?;
                let ($($value,)+) = ($(values.take(|| $slot)?,)+);
                let shape = with_ends(run, &given.options, &sn, $shape)?;
                let first = run.model.parts.len();
                let flow = $add(run, command, &sn, $($kernel,)? shape)?;
                run.keep_depth(command, &given.options, first);
                Ok(flow)
            },
            plain![SN, $($slot),+],
            $options,
        )
    };
}

/// Adds a shape of a material.
fn add<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    sn: &Name<'a>,
    shape: Shape,
) -> Outcome<Flow> {
    let material = run.material(sn)?;
    run.add_of(command, material, shape, Kernel::Cauchy)
}

/// Share of a line's length within which its ends are at one place, so that it has none.
const CLOSED: f64 = 1e-9;

/// Returns a shape with the ends that the options ask for. They are for soft lines that are not
/// closed.
fn with_ends(
    run: &mut Evaluator<'_>,
    options: &Options<'_>,
    sn: &Name<'_>,
    mut shape: Shape,
) -> Outcome<Shape> {
    let ends = ends_of(options);
    if ends == Ends::Round {
        return Ok(shape);
    }
    let material = run.material(sn)?;
    if !run.palette.surfaces[material].flesh.is_soft() {
        let message = format_args!("`ends` is for soft limbs, and `{}` is hard", sn.text);
        let hint = "a hard cylinder has lids, a hard pipe none";
        run.warn(&sn.span, message, hint);
    } else if let Shape::Bone(bone) = &mut shape {
        let line = &bone.skeleton;
        let gap = line.at(0.0).distance(line.at(1.0));
        if gap > CLOSED * line.measure() {
            bone.soft_ends = [ends; 2];
        }
    }
    Ok(shape)
}

fn triangle(a: DVec3, b: DVec3, c: DVec3) -> Shape {
    let (corners, radius) = ([a, b, c], 0.0);
    Shape::triangle(corners, radius)
}

impl<'a> Evaluator<'a> {
    /// Adds a shape of a material and a kernel.
    pub(super) fn add_of(
        &mut self,
        command: &'a Command,
        material: usize,
        shape: Shape,
        kernel: Kernel,
    ) -> Outcome<Flow> {
        let flesh = &self.palette.surfaces[material].flesh;
        let part = Part {
            limbs: 0,
            tapers: shape.bone().is_some_and(|bone| match bone.skeleton {
                _ if bone.end_radius.is_some() => flesh.is_soft(),
                Skeleton::Segment { .. } | Skeleton::Arc { .. } => {
                    flesh.end_radius.is_some() || flesh.end_blobbiness.is_some()
                }
                _ => false,
            }),
            element: Element {
                flesh: flesh.is_soft().then_some(material as u32),
                finish: material as u32,
                body: self.model.body(),
                kernel,
                origin: self.origin(command),
                ..Element::new(shape)
            },
            depth: None,
            growth: 1.0,
            moved: None,
            repeated: self.repeating > 0 || !self.is_own(),
            removed: false,
            nodes: None,
            moves: false,
        };
        self.model.push(part, &command.span)?;
        self.palette.surfaces[material].used = true;
        Ok(Flow::Next)
    }
}

pub static SPHERE: CommandSpec = row("sphere", "sphere; a point when soft")
    .with(makes!(
        add,
        [POINT_OPTIONS],
        |radius, center| Shape::sphere(center, radius),
        length("r", "the radius").role(Role::Radius),
        vector("POS", "the centre")
    ))
    .example(flesh!(
        "sphere Flesh 0.6, -0.6 0 0\nsphere Flesh 0.6, 0.6 0 0"
    ));

pub static CYLINDER: CommandSpec = row("cylinder", "cylinder with lids; a line segment when soft")
    .with(makes!(
        add,
        [LIMB_OPTIONS],
        |radius, base, apex| Shape::cylinder(base, apex, radius),
        length("r", "the radius").role(Role::Radius),
        vector("BASE", "the base"),
        vector("APEX", "the apex")
    ))
    .example(flesh!("cylinder Flesh 0.6, <-2 -1 0>, <2 1 0>"));

pub static PIPE: CommandSpec = row("pipe", "cylinder without lids")
    .with(makes!(
        add,
        [LIMB_OPTIONS],
        |radius, base, apex| Shape::pipe(base, apex, radius),
        length("r", "the radius").role(Role::Radius),
        vector("BASE", "the base"),
        vector("APEX", "the apex")
    ))
    .example(clay!("eyep 3 3 9\npipe Clay 1, <-2 0 0>, <2 0 1>"));

pub static ARC: CommandSpec = row("arc", "arc of a circle")
    .with(takes!(
        arc,
        [LIMB_OPTIONS],
        SN,
        length("a", "the sweep radius").role(Role::Sweep),
        length("b", "the tube radius").role(Role::Radius),
        vector("P", "the centre"),
        direction("N", "the normal"),
        degrees("a1", "the start angle").role(Role::Start),
        degrees("a2", "the width, an angle")
            .role(Role::Width)
            .with_place()
    ))
    .details(
        "Angles run from the local x axis (the world's, made perpendicular to the normal) towards \
         normal × x; so they run clockwise when the normal points away. Soft: the arc itself is \
         the skeleton.",
    )
    .example(flesh!("arc Flesh 2, 0.6, <0 0 0>, <0 0 1>, 30 240"));

#[expect(clippy::too_many_arguments, reason = "the operands of the command")]
fn arc<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    options: &Options<'a>,
    sn: Name<'a>,
    sweep: f64,
    tube: f64,
    center: DVec3,
    normal: DVec3,
    start: f64,
    (width, span): (f64, Range<usize>),
) -> Outcome<Flow> {
    if width.abs() > 360.0 {
        let message = format_args!("an arc of {width} degrees is a full circle");
        let hint = "the last number is the arc's width, not its last angle; 360 is the most";
        run.warn(&span, message, hint);
    }
    let shape = geometry::arc(center, normal, sweep, tube, start, width);
    let shape = with_ends(run, options, &sn, shape)?;
    let first = run.model.parts.len();
    add(run, command, &sn, shape)?;
    run.keep_depth(command, options, first);
    Ok(Flow::Next)
}

pub static ARCH: CommandSpec = row("arch", "arc through three points")
    .with(takes!(
        arch,
        [LIMB_OPTIONS],
        SN,
        length("b", "the tube radius").role(Role::Radius),
        vector("P1", "the first point"),
        vector("P2", "the second point"),
        vector("P3", "the third point")
    ))
    .example(flesh!("arch Flesh 0.6, <-2 -1 0>, <0 1.5 0>, <2 -1 0>"));

#[expect(clippy::too_many_arguments, reason = "the operands of the command")]
fn arch<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    options: &Options<'a>,
    sn: Name<'a>,
    radius: f64,
    a: DVec3,
    b: DVec3,
    c: DVec3,
) -> Outcome<Flow> {
    let shape = match geometry::through(a, b, c, radius) {
        ThreePoints::Arc(shape) => shape,
        ThreePoints::Line(base, apex) => {
            let message = "the three points lie on a line: a straight cylinder is drawn";
            run.warn(&command.span, message, "");
            Shape::cylinder(base, apex, radius)
        }
        ThreePoints::Same => {
            let message = "an arch needs three different points";
            return Err(Problem::new(&command.span, message));
        }
    };
    let shape = with_ends(run, options, &sn, shape)?;
    let first = run.model.parts.len();
    add(run, command, &sn, shape)?;
    run.keep_depth(command, options, first);
    Ok(Flow::Next)
}

pub static TORUS: CommandSpec = row("torus", "ring of a round tube")
    .with(makes!(
        add,
        |sweep, tube, center, normal| geometry::arc(center, normal, sweep, tube, 0.0, 360.0),
        length("a", "the sweep radius").role(Role::Sweep),
        length("b", "the tube radius").role(Role::Radius),
        vector("POS", "the centre"),
        direction("NORM", "the normal")
    ))
    .example(flesh!("torus Flesh 2, 0.6, <0 0 0>, <0 1 2>"));

pub static TRIANGLE: CommandSpec = row("triangle", "flat triangle; a Cauchy triangle when soft")
    .with(makes!(
        add,
        |a, b, c| triangle(a, b, c),
        vector("V1", "the first corner"),
        vector("V2", "the second corner"),
        vector("V3", "the third corner")
    ))
    .example(flesh!("triangle Flesh, <-2 -1.5 0>, <2 -1.5 0>, <0 2 0>"));

pub static PLANE: CommandSpec = row("plane", "infinite plane")
    .with(makes!(
        add,
        |point, normal| Shape::plane(point, normal, 0.0),
        vector("POS", "a point of the plane"),
        direction("NORM", "the normal")
    ))
    .example(clay!("plane Clay, <0 -2 0>, <0 1 0>"));

options! {
    /// Options of `polygon`.
    POLYGON_OPTIONS:
    HOLE: Vec<DVec3> = ("hole", "", "a hole in it (ours)",
        vector("W1", "a corner of the hole").many());
}

pub static POLYGON: CommandSpec = row("polygon", "planar polygon, with holes")
    .with(takes!(
        polygon,
        [POLYGON_OPTIONS],
        SN,
        vector("V1", "a corner").many()
    ))
    .details(
        "At least three corners, at most 800 with those of the holes; edges must not cross. (RATS \
         stopped at 128; holes are ours.)",
    )
    .example(clay!(
        "polygon Clay, <-2 -2 0> <2 -2 0> <2 2 0> <-2 2 0> hole <-1 -1 0> <-1 1 0> <1 1 0> <1 -1 \
         0>"
    ));

fn polygon<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    options: &Options<'a>,
    sn: Name<'a>,
    corners: Vec<DVec3>,
) -> Outcome<Flow> {
    let mut rings = vec![corners];
    rings.extend(options.all(&HOLE));
    let corners: usize = rings.iter().map(Vec::len).sum();
    if corners > MAX_CORNERS {
        return Err(Problem::new(
            &command.span,
            format!("a polygon can have {MAX_CORNERS} corners at most, this one has {corners}"),
        ));
    }
    if rings.iter().any(|ring| ring.len() < 3) {
        return Err(Problem::new(
            &command.span,
            "a polygon, and each hole of it, needs at least three corners",
        ));
    }
    // Each pair of edges is looked at.
    run.scope
        .step((corners * corners / 50) as u64, &command.word_span)?;
    let off = geometry::flatten(&mut rings);
    if geometry::crosses_itself(&rings) {
        return Err(
            Problem::new(&command.span, "edges of this polygon cross each other").hint(
                "list the corners in order around it; holes lie inside, apart from each other",
            ),
        );
    }
    if off > 1e-3 {
        let message = "the corners do not lie in one plane: they are moved onto it";
        let percent = format_args!("{:.1}%", 100.0 * off);
        let hint = format_args!("the furthest is {percent} of the polygon's size away from it");
        run.warn(&command.span, message, hint);
    }
    add(run, command, &sn, Shape::polygon(rings, 0.0))
}

/// `curve sn b P1 P2 P3 P4 [P …]`: cubic Bézier curves, each beginning where the last one ends.
pub static CURVE: CommandSpec = row("curve", "cubic Bézier curve")
    .with(takes!(
        curve,
        [LIMB_OPTIONS],
        SN,
        length("b", "the tube radius").role(Role::Radius),
        vector("P1", "the first control point"),
        vector("P2", "the second control point"),
        vector("P3", "the third control point"),
        vector("P4", "the end point"),
        vector("P", "a further control point").any()
    ))
    .details("More points, three at a time, join more curves: each begins where the last one ends.")
    .example(flesh!(
        "curve Flesh 0.6, <-3 -1 0> <-1 3 0> <1 -3 0> <3 1 0>"
    ));

#[expect(clippy::too_many_arguments, reason = "the operands of the command")]
fn curve<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    options: &Options<'a>,
    sn: Name<'a>,
    radius: f64,
    a: DVec3,
    b: DVec3,
    c: DVec3,
    d: DVec3,
    more: Vec<DVec3>,
) -> Outcome<Flow> {
    let mut points = vec![a, b, c, d];
    points.extend(more);
    if points.len() % 3 != 1 {
        let missing = 3 - (points.len() - 1) % 3;
        return Err(Problem::new(
            &command.span,
            format!("the last curve lacks {missing} of its three points"),
        )
        .hint("each curve after the first takes two control points and an end point"));
    }
    let last = points.len() - 4;
    let first = run.model.parts.len();
    let (start, end) = (points[0], points[last + 3]);
    let size = points
        .iter()
        .map(|point| point.distance(start))
        .fold(0.0, f64::max);
    let is_closed = start.distance(end) <= CLOSED * size;
    for i in (0..=last).step_by(3) {
        let control = [points[i], points[i + 1], points[i + 2], points[i + 3]];
        let mut shape = with_ends(run, options, &sn, Shape::curve(control, radius))?;
        if let Shape::Bone(bone) = &mut shape {
            // Only the first curve's start and the last one's end are free, unless they meet.
            for (end, is_free) in bone.soft_ends.iter_mut().zip([i == 0, i == last]) {
                if !is_free || is_closed {
                    *end = Ends::Round;
                }
            }
        }
        add(run, command, &sn, shape)?;
    }
    run.keep_depth(command, options, first);
    Ok(Flow::Next)
}

/// Adds a shape of a kernel that the opcode names. It has no radius of its own: its material's
/// counts.
fn of_kernel<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    sn: &Name<'a>,
    kernel: Kernel,
    mut shape: Shape,
) -> Outcome<Flow> {
    let material = run.material(sn)?;
    let flesh = &run.palette.surfaces[material].flesh;
    if !flesh.is_soft() {
        // Drawn as an offset surface, which has a radius.
        if let Shape::Bone(bone) = &mut shape
            && bone.skeleton.dimension() < 2
        {
            bone.radius = flesh.radius;
        }
    }
    run.add_of(command, material, shape, kernel)
}

pub static DOT: CommandSpec = row("dot", "point with a polynomial kernel")
    .with(makes!(
        of_kernel(Kernel::Quartic),
        [POINT_OPTIONS],
        |center| Shape::sphere(center, 0.0),
        vector("POS", "the position")
    ))
    .example(flesh!("dot Flesh, -0.5 0 0\ndot Flesh, 0.5 0 0"));

pub static GAUSS: CommandSpec = row("gauss", "point with a Gaussian kernel")
    .with(makes!(
        of_kernel(Kernel::Gauss),
        [POINT_OPTIONS],
        |center| Shape::sphere(center, 0.0),
        vector("POS", "the position")
    ))
    .example(flesh!("gauss Flesh, -0.6 0 0\ngauss Flesh, 0.6 0 0"));

pub static LINE: CommandSpec = row("line", "line segment with a Gaussian kernel")
    .with(makes!(
        of_kernel(Kernel::Gauss),
        [LIMB_OPTIONS],
        |base, apex| Shape::cylinder(base, apex, 0.0),
        vector("BASE", "the base"),
        vector("APEX", "the apex")
    ))
    .example(flesh!(
        "line Flesh, <-2 0 0>, <2 0 0>\nline Flesh, <0 0 0>, <0 2 0>"
    ));

pub static TRIAD: CommandSpec = row("triad", "triangle with the Newtonian kernel")
    .with(makes!(
        of_kernel(Kernel::Inverse),
        |a, b, c| triangle(a, b, c),
        vector("V1", "the first corner"),
        vector("V2", "the second corner"),
        vector("V3", "the third corner")
    ))
    .details(
        "The potential of a flat mass. Without a `strength` in its material it is as strong as it \
         takes for its flesh to stand at the radius over its middle, where nothing else is near, \
         of those joined at corners over that of the largest. With one, its flesh is as thick as \
         the radius only where the triangle is many radii wide and the strength 1.",
    )
    .example(
        "light White, position 4 8 10\nsurface Flesh, diffuse SandyBrown, specular Gray50, shine \
         40, radius 0.4, blobbiness -2, strength 3\ntriad Flesh, <-2 -1.5 0>, <2 -1.5 0>, <0 2 0>",
    );

pub static CONE: CommandSpec = row("cone", "cone with lids")
    .with(makes!(
        add,
        [LIMB_OPTIONS],
        |base_radius, base, apex_radius, apex| Shape::cone(base, base_radius, apex, apex_radius),
        length("b", "the radius at the base")
            .role(Role::Radius)
            .at_least(0.0),
        vector("BASE", "the base"),
        length("a", "the radius at the apex")
            .role(Role::ApexRadius)
            .at_least(0.0),
        vector("APEX", "the apex")
    ))
    .details("Soft: a line segment whose flesh tapers with the cone.")
    .example(clay!("cone Clay 1.5, <0 -2 0>, 0.2, <0 2 0>"));

/// Adds a shape that has no skeleton; it stays hard where its material is soft.
fn add_hard<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    name: &Name<'a>,
    shape: Shape,
) -> Outcome<Flow> {
    let material = run.material(name)?;
    if run.palette.surfaces[material].flesh.is_soft() {
        let word = run.scope.symbols.word(command.word);
        let message = "is no skeleton: it stays hard, whatever its material";
        let hint = "give it a material without blobbiness";
        run.warn(&command.word_span, format_args!("a {word} {message}"), hint);
    }
    add(run, command, name, shape)
}

/// Returns a box around the origin.
fn brick(size: DVec3) -> Shape {
    box_between(-0.5 * size, 0.5 * size)
}

fn box_between(low: DVec3, high: DVec3) -> Shape {
    let half = (high - low).abs() * 0.5;
    Shape::cuboid(
        (low + high) * 0.5,
        [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| axis * half),
    )
}

pub static BOX: CommandSpec = row("box", "box between two corners")
    .with(makes!(
        add_hard,
        |low, high| box_between(low, high),
        vector("PMIN", "one corner"),
        vector("PMAX", "the opposite corner")
    ))
    .details("A box is always hard: it is no skeleton.")
    .example(clay!("eyep 6 5 8\nbox Clay, <-2 -1 -1>, <2 1 1>"));

pub static BRICK: CommandSpec = row("brick", "box around the origin")
    .with(makes!(
        add_hard,
        |x, y, z| brick(DVec3::new(x, y, z)),
        length("x", "the width").role(Role::Side(0)).at_least(0.0),
        length("y", "the height").role(Role::Side(1)).at_least(0.0),
        length("z", "the depth").role(Role::Side(2)).at_least(0.0)
    ))
    .details("A brick is always hard: it is no skeleton.")
    .example(clay!("eyep 6 5 8\nbrick Clay, 4 1 2"));

pub static PATCH: CommandSpec = row("patch", "triangle shaded as if it were curved")
    .with(makes!(
        add,
        |v1, n1, v2, n2, v3, n3| Shape::patch([v1, v2, v3], [n1, n2, n3]),
        vector("V1", "the first corner"),
        direction("N1", "the first normal"),
        vector("V2", "the second corner"),
        direction("N2", "the second normal"),
        vector("V3", "the third corner"),
        direction("N3", "the third normal")
    ))
    .details("Phong's shading: the normal varies between the corners. Soft: a triangle.")
    .example(clay!(
        "patch Clay, <-2 -1.5 0> <-1 0 1>, <2 -1.5 0> <1 0 1>, <0 2 0> <0 1 1>"
    ));

options! {
    /// Options of `quadric`.
    QUADRIC_OPTIONS:
    TRANSLATE: DVec3 = ("translate", "0 0 0", "moves it", vector("XYZ", "the shift"));
    SCALE: DVec3 = ("scale", "1 1 1", "scales it", triple("XYZ", "the scale"));
    BOUNDS: (DVec3, DVec3) = ("bounds", "-1 -1 -1 1 1 1", "the box it is cut off at",
        vector("MIN", "the lowest corner"), vector("MAX", "the highest corner"));
}

pub static QUADRIC: CommandSpec = row("quadric", "quadric surface")
    .with(takes!(
        quadric,
        [QUADRIC_OPTIONS],
        SN,
        number("a", "the factor of x²"),
        number("b", "the factor of y²"),
        number("c", "the factor of z²"),
        number("d", "the factor of xy"),
        number("e", "the factor of yz"),
        number("f", "the factor of zx"),
        number("g", "the factor of x"),
        number("h", "the factor of y"),
        number("i", "the factor of z"),
        number("j", "the constant")
    ))
    .details(
        "The points where ax² + by² + cz² + dxy + eyz + fzx + gx + hy + iz + j = 0 in local \
         coordinates, cut off at the box `bounds`. The printed table leaves its operands open; \
         these are ours. A quadric is always hard.",
    )
    .example(clay!(
        "eyep 4 4 8\nquadric Clay, 1 -1 1  0 0 0  0 0 0  -0.2, scale 2 2 2"
    ));

#[expect(clippy::too_many_arguments, reason = "the operands of the command")]
fn quadric<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    options: &Options<'a>,
    sn: Name<'a>,
    a: f64,
    b: f64,
    c: f64,
    d: f64,
    e: f64,
    f: f64,
    g: f64,
    h: f64,
    i: f64,
    j: f64,
) -> Outcome<Flow> {
    let square = DMat3::from_cols(
        DVec3::new(a, 0.5 * d, 0.5 * f),
        DVec3::new(0.5 * d, b, 0.5 * e),
        DVec3::new(0.5 * f, 0.5 * e, c),
    );
    let linear = DVec3::new(g, h, i) * 0.5;
    let (low, high) = options.last(&BOUNDS).unwrap_or((-DVec3::ONE, DVec3::ONE));
    let mut quadric =
        Quadric::new(square, linear, j, low.min(high), low.max(high)).ok_or_else(|| {
            Problem::new(
                &command.span,
                "this quadric is no surface: its factors are all 0, or its box has no volume",
            )
        })?;
    let scale = options.last(&SCALE).unwrap_or(DVec3::ONE);
    let shift = options.last(&TRANSLATE).unwrap_or(DVec3::ZERO);
    quadric.axes = quadric.axes.map(|axis| axis * scale);
    quadric.center = quadric.center * scale + shift;
    add_hard(run, command, &sn, Shape::Quadric(Box::new(quadric)))
}

/// `terra sn fn PMIN PMAX`: an image as a height field, lowest where it is black.
pub static TERRA: CommandSpec = row("terra", "height field from an image")
    .with(takes!(
        terra,
        SN,
        file("fn", "the image's name"),
        vector("PMIN", "one corner"),
        vector("PMAX", "the opposite corner")
    ))
    .details(
        "A PNG image of the project (`hills.png` is built in): black lies at the lowest z of the \
         box between the two corners, white at the highest; the image lies along x and y. The \
         printed table leaves its operands open; these are ours.",
    )
    .example(clay!(
        "eyep 4 -5 5\nvup 0 0 1\nterra Clay hills.png, <-3 -3 0> <3 3 1.5>"
    ));

fn terra<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    sn: Name<'a>,
    file: Name<'a>,
    one: DVec3,
    other: DVec3,
) -> Outcome<Flow> {
    let asset = run.asset(&file)?;
    run.scope.step(assets::cost(asset), &command.word_span)?;
    let (low, size) = (one.min(other), (other - one).abs());
    let mesh =
        assets::terra(asset, size).map_err(|error| Problem::new(&file.span, error.to_string()))?;
    let move_there = Transform::translation(low);
    add_mesh(run, command, &sn, &mesh, Some(&move_there))
}

/// Words of `mesh` as RATS has it.
pub static CHECKS: &[OptionSpec] = &[
    word_of("robust", "faces are checked"),
    word_of("fast", "faces are taken as they are"),
];

const MESH_FILE: Slot<Named> = file("fn", "the mesh's name");

/// `mesh robust|fast`, `mesh sn fn`
pub static MESH: CommandSpec = row(
    "mesh",
    "triangles of a file (ours), or how polygons are checked",
)
.with(by_itself(mesh, plain![SN, MESH_FILE], MESH_OPTIONS))
.default("robust")
.details(
    "`mesh sn file.obj` draws the triangles of a file of the project: OBJ, PLY, STL, GLB or \
     3MF (`gem.obj` is built in). A text of the project with the ending `.strokes` is a mesh, too, \
     made by strokes of tools (Sculpt writes them). Where the mesh has colours (of vertices), or \
     is painted, they are multiplied with the material's diffuse and ambient. Soft: each triangle \
     is a skeleton. `mesh sn file.obj metaballs triangular d0 k` makes a soft surface of any \
     material around the mesh: a shell of the thickness d0 on both sides of each facet, the \
     sharper the larger k; `metaballs spherical k` makes it of balls around the facets, good for \
     many small and even ones. k times the mean edge should be 10 or more. `mesh robust`, as RATS \
     has it, changes nothing here: faces are always checked.",
)
.example(clay!("eyep 3 4 3\nfov 30\nvup 0 0 1\nmesh Clay gem.obj"));

fn mesh<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    let mut read = run.reader(command);
    let is_check = read.is_whole_option_next(CHECKS);
    // A material may be called so: then a file follows.
    let is_alone = read.items.len() == read.at + 1;
    if !is_check || !is_alone {
        let draw: Routine = reads!(mesh_of_file, [MESH_OPTIONS], SN, MESH_FILE);
        return draw(run, command);
    }
    read.at += 1;
    read.end()?;
    let message = "`mesh` with this word changes nothing here: faces are always checked";
    run.note(&command.word_span, message, "");
    Ok(Flow::Next)
}

/// `mesh sn fn`, `mesh sn fn metaballs spherical k`, `mesh sn fn metaballs triangular d0 k`
fn mesh_of_file<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    options: &Options<'a>,
    name: Name<'a>,
    file: Name<'a>,
) -> Outcome<Flow> {
    if is_strokes(file.text) {
        let made = sculpt(run, command, &file)?;
        if let Some(metaballs) = implicit_mesh::metaballs(options)? {
            let topology = made.topology().cloned();
            return implicit_mesh::add(run, command, &name, topology, &made.mesh, metaballs);
        }
        return add_mesh(run, command, &name, &made.mesh, None);
    }
    let asset = run.asset(&file)?;
    run.scope.step(assets::cost(asset), &command.word_span)?;
    let mesh = asset
        .mesh()
        .map_err(|error| Problem::new(&file.span, error.to_string()))?;
    if !asset.remarks().is_empty() {
        let remarks = asset.remarks().join("; ");
        run.warn(&file.span, format_args!("{}: {remarks}", file.text), "");
    }
    note_coordinates(run, &name, &file, asset)?;
    if let Some(metaballs) = implicit_mesh::metaballs(options)? {
        let topology = asset.topology().ok().cloned();
        return implicit_mesh::add(run, command, &name, topology, &mesh, metaballs);
    }
    add_mesh(run, command, &name, &mesh, None)
}

/// Notes that texture coordinates of a file do not count, where its material shows an image.
fn note_coordinates<'a>(
    run: &mut Evaluator<'a>,
    name: &Name<'a>,
    file: &Name<'a>,
    asset: &Asset,
) -> Outcome<()> {
    let material = run.material(name)?;
    let mut layers = run.palette.surfaces[material].finish.layers.iter();
    let shows_image = layers.any(|layer| matches!(layer.method, texture::Method::Image(..)));
    let is_obj = asset.name.to_ascii_lowercase().ends_with(".obj");
    if shows_image && is_obj && asset.bytes.windows(4).any(|bytes| bytes == b"\nvt ") {
        let message = "the texture coordinates (`vt`) of this file do not count: the image is laid \
                       into each triangle";
        let hint = "a solid texture, or an image with a `region`, goes over the whole mesh";
        run.note(&file.span, message, hint);
    }
    Ok(())
}

/// Returns the mesh of a text of strokes. Reports what is wrong with that text where it stands.
fn sculpt(run: &mut Evaluator<'_>, command: &Command, name: &Name<'_>) -> Outcome<Rc<Sculpted>> {
    let file = run.strokes(name)?;
    let text = run.sources.all[file].text;
    let steps = 1 + text.len() as u64 / 100;
    run.scope.step(steps, &command.word_span)?;
    let start = match crate::start_file(text) {
        Some(wanted) => run.find_asset(file, &wanted),
        None => None,
    };
    if let Some(asset) = start {
        run.scope.step(assets::cost(asset), &command.word_span)?;
    }
    strokes::sculpt(text, start).map_err(|problems| {
        for problem in problems.iter() {
            let problem = Problem::new(&problem.span, problem.message.clone()).with_place(
                Some(run.file),
                name.span.clone(),
                "used here",
            );
            run.report.add(file, Severity::Error, problem);
        }
        Problem::follow_up(&name.span)
    })
}

/// Adds the triangles of a mesh as one object without a name, which is then the last one.
fn add_mesh<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    name: &Name<'a>,
    mesh: &TriangleMesh,
    transform: Option<&Transform>,
) -> Outcome<Flow> {
    let material = run.material(name)?;
    run.scope
        .step(mesh.triangles.len() as u64, &command.word_span)?;
    let tinted = tints::materials(&mut run.palette, name, material, mesh)?;
    let first = run.model.parts.len();
    // Each triangle is one of many from here.
    run.repeating += 1;
    let mut result = Ok(());
    for (index, shape) in assets::shapes(mesh).enumerate() {
        let own = tinted.as_ref().map_or(material, |own| own[index]);
        let shape = match transform {
            Some(transform) => shape.transform(transform),
            None => shape,
        };
        result = run.add_of(command, own, shape, Kernel::Cauchy).map(drop);
        if result.is_err() {
            break;
        }
        if tinted.is_some()
            && let Some(part) = run.model.parts.last_mut()
        {
            part.element.paint = tints::paint(material, mesh, index);
        }
    }
    run.repeating -= 1;
    run.model.group(first);
    result.map(|()| Flow::Next)
}
