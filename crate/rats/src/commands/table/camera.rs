//! CAMERA: from where and with what lens the picture is taken.

use crate::commands::build::{clay, row, run};
use crate::commands::parameter::{degrees, direction, length, number, vector};
use crate::commands::spec::{CommandSpec, Routine};

/// The commands.
#[rustfmt::skip]
pub static CAMERA: &[CommandSpec] = &[
    row("aperture", "radius of the lens", run(Routine::Aperture))
        .takes(&[length("radius", "the radius of the lens").at_least(0.0)])
        .default("0")
        .details("0 is a pinhole, which draws everything sharp. A lens draws sharp what is as far away as `focus` says, measured along the direction of view; a point at another distance z becomes a disc, of the radius radius·|focus − z|/z where it is sharp. More samples (`sample`) make the blur smoother.")
        .example(clay!("aperture 0.3\nfocus 8\nsample 3\nsphere Clay 1, -1.5 0 -3\nsphere Clay 1, 0 0 2\nsphere Clay 0.7, 1.2 0 5")),
    row("focus", "distance that the lens draws sharp", run(Routine::Focus))
        .takes(&[length("distance", "the distance of the focal plane").at_least(1e-9)])
        .default("to vrp")
        .details("It only shows when the lens has an `aperture`.")
        .example(clay!("aperture 0.3\nfocus 5\nsample 3\nsphere Clay 1, -1.5 0 -3\nsphere Clay 1, 0 0 2\nsphere Clay 0.7, 1.2 0 5")),
    row("shutter", "how long the shutter is open", run(Routine::Shutter))
        .takes(&[number("fraction", "the fraction of time").from(0.0, 1.0)])
        .default("0")
        .details("A share of the time from one frame of an animation to the next: 0 is no blur, with 1 whatever moves is blurred along its whole way. What moves is what is made of variables that change with every frame; `transform` holds an object still meanwhile. More samples (`sample`) make the blur smoother.")
        .example(clay!("var x = -1 += 2\nshutter 1\nsample 4\nsphere Clay 1, 0 1.5 0\nsphere Clay 1, x -1 0")),
    row("vrp", "view reference point, in the middle of the picture", run(Routine::Vrp))
        .takes(&[vector("XYZ", "the view reference point")])
        .default("0 0 0")
        .example(clay!("vrp 0 1 0\nsphere Clay 2, 0 0 0")),
    row("vup", "direction that is up in the picture", run(Routine::Vup))
        .takes(&[direction("XYZ", "the direction up")])
        .default("0 1 0")
        .example(clay!("vup 0 0 1\neyep 8 4 4\ncylinder Clay 1, <0 0 -2>, <0 0 2>")),
    row("cp", "centre of projection, view coordinates", run(Routine::Cp))
        .takes(&[
            length("x", "the place to the right"),
            length("y", "the place upwards"),
            length("z", "the distance before the view plane").at_least(1e-9),
            number("w", "the weight").optional("1"),
        ])
        .details("The camera of Foley et al.: the view plane goes through `vrp` with normal `vpn`; `window` is the part of it that the picture shows, seen from `cp`. The weight divides the others.")
        .example(clay!("vrp 0 0 0\nvpn 0 0 1\ncp 0 0 8\nwindow -3 3 -3 3\nsphere Clay 2, 0 0 0")),
    row("vpn", "normal of the view plane, towards the eye", run(Routine::Vpn))
        .takes(&[direction("XYZ", "the normal of the view plane")])
        .default("0 0 1")
        .example(clay!("vpn 1 1 1\ncp 0 0 8\nwindow -3 3 -3 3\nsphere Clay 2, 0 0 0")),
    row("window", "the part of the view plane that the picture shows", run(Routine::Window))
        .takes(&[
            length("x", "the left edge"),
            length("X", "the right edge"),
            length("y", "the lower edge"),
            length("Y", "the upper edge"),
        ])
        .details("In view coordinates, as for `cp`. Pixels are square: the width counts, the height follows from `framesize`.")
        .example(clay!("cp 0 0 8\nwindow -4 4 -4 4\nsphere Clay 2, 0 0 0")),
    row("eyep", "position of the eye", run(Routine::Eyep))
        .takes(&[vector("XYZ", "the eye's position")])
        .default("0 0 10")
        .example(clay!("eyep 5 5 8\nsphere Clay 2, 0 0 0")),
    row("fov", "angle of view", run(Routine::Fov))
        .takes(&[
            degrees("hor", "the horizontal angle of view").from(0.01, 179.0),
            degrees("vert", "the vertical angle of view").from(0.01, 179.0).optional("as the frame's sides"),
        ])
        .default("45")
        .details("Pixels are square, so the vertical angle follows from the horizontal one and `framesize`.")
        .example(clay!("fov 30\nsphere Clay 2, 0 0 0")),
];
