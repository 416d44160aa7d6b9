//! PRIMITIVES: shapes, and the skeletons of soft ones.

use crate::commands::build::{clay, flesh, row, run};
use crate::commands::options as o;
use crate::commands::parameter::{
    Kind, Names, Parameter, degrees, direction, length, number, parameter, vector,
};
use crate::commands::spec::{CommandSpec, Routine};

/// Of every primitive the first, which a `chain` leaves out.
const SN: Parameter = parameter("sn", Kind::Known(Names::Material), "the material's name");

/// The commands.
#[rustfmt::skip]
pub static PRIMITIVES: &[CommandSpec] = &[
    row("arc", "arc of a circle", run(Routine::Arc))
        .takes(&[
            SN,
            length("a", "the sweep radius"),
            length("b", "the tube radius"),
            vector("P", "the centre"),
            direction("N", "the normal"),
            degrees("a1", "the start angle"),
            degrees("a2", "the width, an angle"),
        ])
        .details("Angles run from the local x axis (the world's, made perpendicular to the normal) towards normal × x; so they run clockwise when the normal points away. Soft: the arc itself is the skeleton.")
        .example(flesh!("arc Flesh 2, 0.6, <0 0 0>, <0 0 1>, 30 240")),
    row("arch", "arc through three points", run(Routine::Arch))
        .takes(&[
            SN,
            length("b", "the tube radius"),
            vector("P1", "the first point"),
            vector("P2", "the second point"),
            vector("P3", "the third point"),
        ])
        .example(flesh!("arch Flesh 0.6, <-2 -1 0>, <0 1.5 0>, <2 -1 0>")),
    row("box", "box between two corners", run(Routine::Box))
        .takes(&[SN, vector("PMIN", "one corner"), vector("PMAX", "the opposite corner")])
        .details("A box is always hard: it is no skeleton.")
        .example(clay!("eyep 6 5 8\nbox Clay, <-2 -1 -1>, <2 1 1>")),
    row("brick", "box around the origin", run(Routine::Brick))
        .takes(&[
            SN,
            length("x", "the width").at_least(0.0),
            length("y", "the height").at_least(0.0),
            length("z", "the depth").at_least(0.0),
        ])
        .details("A brick is always hard: it is no skeleton.")
        .example(clay!("eyep 6 5 8\nbrick Clay, 4 1 2")),
    row("cone", "cone with lids", run(Routine::Cone))
        .takes(&[
            SN,
            length("b", "the radius at the base").at_least(0.0),
            vector("BASE", "the base"),
            length("a", "the radius at the apex").at_least(0.0),
            vector("APEX", "the apex"),
        ])
        .details("Soft: a line segment whose flesh tapers with the cone.")
        .example(clay!("cone Clay 1.5, <0 -2 0>, 0.2, <0 2 0>")),
    row("cylinder", "cylinder with lids; a line segment when soft", run(Routine::Cylinder))
        .takes(&[SN, length("r", "the radius"), vector("BASE", "the base"), vector("APEX", "the apex")])
        .example(flesh!("cylinder Flesh 0.6, <-2 -1 0>, <2 1 0>")),
    row("pipe", "cylinder without lids", run(Routine::Pipe))
        .takes(&[SN, length("r", "the radius"), vector("BASE", "the base"), vector("APEX", "the apex")])
        .example(clay!("eyep 3 3 9\npipe Clay 1, <-2 0 0>, <2 0 1>")),
    row("dot", "point with a polynomial kernel", run(Routine::Dot))
        .takes(&[SN, vector("POS", "the position")])
        .example(flesh!("dot Flesh, -0.5 0 0\ndot Flesh, 0.5 0 0")),
    row("gauss", "point with a Gaussian kernel", run(Routine::Gauss))
        .takes(&[SN, vector("POS", "the position")])
        .example(flesh!("gauss Flesh, -0.6 0 0\ngauss Flesh, 0.6 0 0")),
    row("line", "line segment with a Gaussian kernel", run(Routine::Line))
        .takes(&[SN, vector("BASE", "the base"), vector("APEX", "the apex")])
        .example(flesh!("line Flesh, <-2 0 0>, <2 0 0>\nline Flesh, <0 0 0>, <0 2 0>")),
    row("sphere", "sphere; a point when soft", run(Routine::Sphere))
        .takes(&[SN, length("r", "the radius"), vector("POS", "the centre")])
        .example(flesh!("sphere Flesh 0.6, -0.6 0 0\nsphere Flesh 0.6, 0.6 0 0")),
    row("triangle", "flat triangle; a Cauchy triangle when soft", run(Routine::Triangle))
        .takes(&[SN, vector("V1", "the first corner"), vector("V2", "the second corner"), vector("V3", "the third corner")])
        .example(flesh!("triangle Flesh, <-2 -1.5 0>, <2 -1.5 0>, <0 2 0>")),
    row("triad", "triangle with the Newtonian kernel", run(Routine::Triad))
        .takes(&[SN, vector("V1", "the first corner"), vector("V2", "the second corner"), vector("V3", "the third corner")])
        .details("The potential of a flat mass. Its flesh is as thick as the radius only where the triangle is many radii wide; smaller ones need more `strength`.")
        .example("light White, position 4 8 10\nsurface Flesh, diffuse SandyBrown, specular Gray50, shine 40, radius 0.4, blobbiness -2, strength 3\ntriad Flesh, <-2 -1.5 0>, <2 -1.5 0>, <0 2 0>"),
    row("plane", "infinite plane", run(Routine::Plane))
        .takes(&[SN, vector("POS", "a point of the plane"), direction("NORM", "the normal")])
        .example(clay!("plane Clay, <0 -2 0>, <0 1 0>")),
    row("polygon", "planar polygon, with holes", run(Routine::Polygon))
        .takes(&[SN, vector("V1", "a corner").many()])
        .options(o::POLYGON)
        .details("At least three corners, at most 800 with those of the holes; edges must not cross. (RATS stopped at 128; holes are ours.)")
        .example(clay!("polygon Clay, <-2 -2 0> <2 -2 0> <2 2 0> <-2 2 0> hole <-1 -1 0> <-1 1 0> <1 1 0> <1 -1 0>")),
    row("patch", "triangle shaded as if it were curved", run(Routine::Patch))
        .takes(&[
            SN,
            vector("V1", "the first corner"), direction("N1", "the first normal"),
            vector("V2", "the second corner"), direction("N2", "the second normal"),
            vector("V3", "the third corner"), direction("N3", "the third normal"),
        ])
        .details("Phong's shading: the normal varies between the corners. Soft: a triangle.")
        .example(clay!("patch Clay, <-2 -1.5 0> <-1 0 1>, <2 -1.5 0> <1 0 1>, <0 2 0> <0 1 1>")),
    row("torus", "ring of a round tube", run(Routine::Torus))
        .takes(&[
            SN,
            length("a", "the sweep radius"),
            length("b", "the tube radius"),
            vector("POS", "the centre"),
            direction("NORM", "the normal"),
        ])
        .example(flesh!("torus Flesh 2, 0.6, <0 0 0>, <0 1 2>")),
    row("quadric", "quadric surface", run(Routine::Quadric))
        .takes(&[
            SN,
            number("a", "the factor of x²"), number("b", "the factor of y²"), number("c", "the factor of z²"),
            number("d", "the factor of xy"), number("e", "the factor of yz"), number("f", "the factor of zx"),
            number("g", "the factor of x"), number("h", "the factor of y"), number("i", "the factor of z"),
            number("j", "the constant"),
        ])
        .options(o::QUADRIC)
        .details("The points where ax² + by² + cz² + dxy + eyz + fzx + gx + hy + iz + j = 0 in local coordinates, cut off at the box `bounds`. The printed table leaves its operands open; these are ours. A quadric is always hard.")
        .example(clay!("eyep 4 4 8\nquadric Clay, 1 -1 1  0 0 0  0 0 0  -0.2, scale 2 2 2")),
    row("terra", "height field from an image", run(Routine::Terra))
        .takes(&[
            SN,
            parameter("fn", Kind::File, "the image's name"),
            vector("PMIN", "one corner"),
            vector("PMAX", "the opposite corner"),
        ])
        .details("A PNG image of the project (`hills.png` is built in): black lies at the lowest z of the box between the two corners, white at the highest; the image lies along x and y. The printed table leaves its operands open; these are ours.")
        .example(clay!("eyep 4 -5 5\nvup 0 0 1\nterra Clay hills.png, <-3 -3 0> <3 3 1.5>")),
];
