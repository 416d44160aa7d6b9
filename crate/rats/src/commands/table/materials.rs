//! MATERIALS: what shapes are made of.

use crate::commands::build::{row, run};
use crate::commands::options as o;
use crate::commands::parameter::{Kind, Names, parameter, word};
use crate::commands::spec::{CommandSpec, Routine};

/// The commands.
#[rustfmt::skip]
pub static MATERIALS: &[CommandSpec] = &[
    row("surface", "make a material", run(Routine::Surface))
        .takes(&[
            parameter("alias", Kind::New(Names::Material), "the material's name"),
            parameter("= old", Kind::Copy(Names::Material), "the name of the old material").optional(""),
        ])
        .options(o::SURFACE)
        .details("All fields are optional; braces around them let them run over several lines. A material with a blobbiness is soft: its shapes are skeletons, and their flesh melts together. `surface new = old` copies a material; options behind it change the copy (ours).")
        .example("light White, position 4 8 10\nsurface { Red, body OrangeRed\n  specular 50%, shine 40\n  radius 0.8, blobbiness -1 }\nsurface Blue = Red, diffuse RoyalBlue\nsphere Red 1, -1 0 0\nsphere Blue 1, 1 0 0"),
    row("texture", "make a texture", run(Routine::Texture))
        .takes(&[
            parameter("alias", Kind::New(Names::Texture), "the texture's name"),
            parameter("= old", Kind::Copy(Names::Texture), "the name of the old texture").optional(""),
            word("Target", o::TARGETS, "what the texture changes, such as `strength`"),
            parameter("Method", Kind::Method, "how to texture: a solid such as `wood`, two waves such as `sin one`, a colour or an image"),
        ])
        .options(o::TEXTURE)
        .details("A method is a solid (`wood`), a pair of waves along u and v (`sin one`), a colour, or an image (`face.png plain`). With the target `strength` the waves are a profile: they model the flesh along the skeleton (thesis, section 3.4). `texture new = old` copies a texture; options behind it change the copy (ours).")
        .example("light White, position 4 8 10\ntexture Rings, strength sin one, bounds 0.5 0.5 0.5 1 1 1, scale 6 1 1\nsurface Flesh, diffuse SandyBrown, radius 0.8, blobbiness -4, texture Rings\ncylinder Flesh 1, <-3 0 0>, <3 0 0>"),
];
