//! OBJECTS: groups of shapes, and how they are moved.

use crate::commands::build::{clay, flesh, row, run};
use crate::commands::parameter::{Kind, Names, Parameter, degrees, direction, parameter, vector};
use crate::commands::spec::{CommandSpec, Routine};

/// The object that a transform is for.
const OBJECT: Parameter =
    parameter("object", Kind::Known(Names::Object), "an object's name").optional("the last one");

/// The commands.
#[rustfmt::skip]
pub static OBJECTS: &[CommandSpec] = &[
    row("chain", "begin shapes of one material, whose name they leave out", run(Routine::Chain))
        .takes(&[
            parameter("material", Kind::Known(Names::Material), "the material's name"),
            parameter("name", Kind::New(Names::Object), "the chain's name"),
        ])
        .example(flesh!("chain Flesh, LINKS\n  sphere 0.6, -1 0 0\n  sphere 0.6, 0 0 0\n  sphere 0.6, 1 0 0\nclose")),
    row("object", "begin an object", run(Routine::Object))
        .takes(&[parameter("name", Kind::New(Names::Object), "the object's name")])
        .details("Objects can stand inside each other, 16 deep at most.")
        .example(clay!("object PAIR\n  sphere Clay 1, -1.5 0 0\n  sphere Clay 1, 1.5 0 0\nclose\nrotate 0 0 1 30, PAIR")),
    row("close", "end an object or chain", run(Routine::Close))
        .takes(&[parameter("name", Kind::Known(Names::Object), "the object's name").optional("the one that is open")])
        .example(clay!("object BALL\n  sphere Clay 2, 0 0 0\nclose BALL")),
    row("instance", "copy an object", run(Routine::Instance))
        .takes(&[
            parameter("name", Kind::Known(Names::Object), "the object's name"),
            parameter("copy", Kind::New(Names::Object), "the copy's name").optional("the same name"),
        ])
        .example(clay!("object BALL\n  sphere Clay 1, -1.5 0 0\nclose\ninstance BALL, OTHER\ntranslate 3 0 0, OTHER")),
    row("translate", "move an object", run(Routine::Translate))
        .takes(&[vector("x y z", "the shift"), OBJECT])
        .example(clay!("sphere Clay 1, 0 0 0\ntranslate 1 1 0")),
    row("rotate", "turn an object about an axis through the origin", run(Routine::Rotate))
        .takes(&[direction("x y z", "the axis"), degrees("angle", "the angle"), OBJECT])
        .example(clay!("cylinder Clay 0.6, <-2 0 0>, <2 0 0>\nrotate 0 0 1 30")),
    row("scale", "scale an object", run(Routine::Scale))
        .takes(&[parameter("x y z", Kind::Vector, "the scale"), OBJECT])
        .details("Radii grow by the mean of the three factors: round shapes stay round.")
        .example(clay!("sphere Clay 1, 0 0 0\nscale 2 2 2")),
    row("explode", "move the parts of an object apart", run(Routine::Explode))
        .takes(&[parameter("x y z", Kind::Vector, "the shares"), OBJECT])
        .details("Each shape moves away from the middle of the object, by the share x, y, z of its distance along each axis: 0 leaves it, 1 doubles the distance.")
        .example(clay!("object PARTS\n  sphere Clay 0.8, -0.5 0 0\n  sphere Clay 0.8, 0.5 0 0\n  sphere Clay 0.8, 0 0.8 0\nclose\nexplode 2 2 0, PARTS")),
    row("transform", "hold an object still while the shutter is open", run(Routine::Transform))
        .takes(&[OBJECT])
        .details("Transforms are applied at once. What variables that change with every frame have done to the object so far is then the same for the whole time of the `shutter`; what comes after this is blurred.")
        .example(clay!("var x = -1.5 += 3\nshutter 1\nsample 3\nobject STILL\n  sphere Clay 1, x 1.2 0\nclose\ntransform STILL\nobject MOVING\n  sphere Clay 1, x -1.2 0\nclose")),
];
