//! SCENE: lights, what is behind everything, and the picture itself.

use crate::commands::build::{clay, idle, later, row, run};
use crate::commands::options as o;
use crate::commands::parameter::{Kind, Names, colour, parameter, word};
use crate::commands::spec::{CommandSpec, Routine};

/// The commands.
#[rustfmt::skip]
pub static SCENE: &[CommandSpec] = &[
    row("light", "make a light", run(Routine::Light))
        .takes(&[colour("Color", "the light's colour")])
        .options(o::LIGHT)
        .details("A scene without lights is lit evenly. Spots and extended lights are drawn as points in this version, with a warning.")
        .example("surface Clay, diffuse SandyBrown, specular Gray50, shine 40\nlight White, position 4 8 10, intensity 0.8\nlight SkyBlue, distant, direction 1 0 -1, intensity 0.4, noshadow\nsphere Clay 2, 0 0 0"),
    row("fog", "fog", later())
        .takes(&[colour("Color", "the fog's colour"), parameter("options", Kind::Text, "the fog's options").optional("")])
        .example(clay!("fog Gray\nsphere Clay 2, 0 0 0")),
    row("background", "colour behind everything", run(Routine::Background))
        .takes(&[colour("Color", "the background's colour"), parameter("options", Kind::Text, "more colours").optional("")])
        .default("a dark slate")
        .example(clay!("background MidnightBlue\nsphere Clay 2, 0 0 0")),
    row("cloud", "clouds of light, halos", later())
        .takes(&[colour("Color", "the cloud's colour"), parameter("options", Kind::Text, "the cloud's options").optional("")])
        .example(clay!("cloud White\nsphere Clay 2, 0 0 0")),
    row("remove", "remove an object", run(Routine::Remove))
        .takes(&[parameter("object", Kind::Known(Names::Object), "the object's name")])
        .example(clay!("sphere Clay 2, 0 0 0\nobject EXTRA\n  sphere Clay 2, 1 0 0\nclose\nremove EXTRA")),
    row("report", "tell what the scene holds", run(Routine::Report))
        .takes(&[word("what", o::RESET, "what to report on").any()])
        .example("report"),
    row("reset", "put things back to what they are at the start", run(Routine::Reset))
        .takes(&[word("what", o::RESET, "what to reset, such as `all`").many()])
        .example(clay!("sphere Clay 2, 3 0 0\nreset data\nsphere Clay 2, 0 0 0")),
    row("preview", "preview", idle("the draft is always shown"))
        .takes(&[parameter("options", Kind::Text, "the preview's options").optional("")])
        .example("preview"),
    row("shoot", "draw the picture", run(Routine::Shoot))
        .takes(&[parameter("options", Kind::Text, "the picture's options").optional("")])
        .details("The picture shows what has been made so far. Without `shoot` it shows what there is at the end.")
        .example(clay!("sphere Clay 2, 0 0 0\nshoot")),
];
