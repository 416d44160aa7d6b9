//! SCENE: lights, what is behind everything, and the picture itself.

use crate::commands::build::{clay, idle, row, run};
use crate::commands::options as o;
use crate::commands::parameter::{Kind, Names, colour, parameter, word};
use crate::commands::spec::{CommandSpec, Routine};

/// The commands.
#[rustfmt::skip]
pub static SCENE: &[CommandSpec] = &[
    row("light", "make a light", run(Routine::Light))
        .takes(&[colour("Color", "the light's colour")])
        .options(o::LIGHT)
        .details("A scene without lights and without a `sky` is lit evenly. Light does not fade with distance, as in the published datasets. A spot shines fully within its angle less its edge, and fades to nothing at its angle. A light with a `size` has soft shadows where `penumbra` is on.")
        .example("surface Clay, diffuse SandyBrown, specular Gray50, shine 40\nsurface Floor, diffuse Gray70\neyep 0 5 12\nlight White, spot, position 6 8 4, direction -6 -9 -4, angle 18, edge 6\nlight SkyBlue, distant, direction 1 -1 -1, intensity 0.2, noshadow\nsphere Clay 2, 0 0 0\nplane Floor <0 -2 0> <0 1 0>"),
    row("fog", "fog over everything", run(Routine::Fog))
        .takes(&[colour("Color", "the fog's colour")])
        .options(o::FOG)
        .default("none")
        .details("Of light that comes from the distance x the share e^(−x/d) is left; the rest is the fog's own colour. With a `height` it lies low: thinner the higher, and as dense below 0 as at 0. What is high is said by `vup`. One fog at a time: the last one counts.")
        .example(clay!("fog LightSteelBlue, distance 12\nbackground LightSteelBlue\neyep 0 2 9\nfor i = 0 to 5 { sphere Clay 1, 3-2*i, 0, 3-4*i }")),
    row("background", "what is behind everything: a colour, colours or an image", run(Routine::Background))
        .takes(&[parameter("Color|fn", Kind::Backdrop, "the background's colour, or the name of an image")])
        .options(o::BACKGROUND)
        .default("a dark slate, or the `sky`")
        .details("With `to` it goes from the first colour, above, to the last, below; they change over around the horizon. An image lies around the scene: the whole way round across, its middle towards −z, from straight up to straight down. It is seen in mirrors and through glass, but it gives no light: `sky` does. What is above is said by `vup`.")
        .example(clay!("background SteelBlue to White to SaddleBrown\nsurface Chrome, diffuse Gray10, reflective 80%\nsphere Chrome 2, 0 0 0\nsphere Clay 0.7, 2.4 -1 2")),
    row("cloud", "a cloud of light, or a halo", run(Routine::Cloud))
        .takes(&[colour("Color", "the cloud's colour")])
        .options(o::CLOUD)
        .default("none")
        .details("A glowing ball of mist without a surface: it hides nothing and casts no shadow. At the distance r from its middle its density is k·(1 − (r/radius)²)², and a ray gets the integral of that along its way, in units of the radius, times the colour.")
        .example(clay!("background Black\nobject LAMP\n  sphere Clay 0.6, 0 1 0\nclose\ncloud Gold, object LAMP, radius 2.5\ncloud SlateBlue, position -2 -1 0, radius 2, density 0.5")),
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
