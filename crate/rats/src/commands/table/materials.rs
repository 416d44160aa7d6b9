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
        .details("All fields are optional; braces around them let them run over several lines. A material with a blobbiness is soft: its shapes are skeletons, and their flesh melts together; all fields are mixed where two materials meet, the index and the shine too. A colour is a name, three numbers or N%: of the body's colour for `ambient` and `diffuse`, of the light that comes for `specular`, `reflective` and `transparent`. Light that goes into a transparent material is bent by its `index`: glass 1.5, water 1.33, diamond 2.42; it colours the shadow. `dispersion` is how much larger the index is for blue than for red. `surface new = old` copies a material; options behind it change the copy (ours).")
        .example("light White, position 4 8 10\nbackground SteelBlue to White to SaddleBrown\nsurface { Red, body OrangeRed\n  specular 50%, shine 40\n  radius 0.8, blobbiness -1 }\nsurface Blue = Red, diffuse RoyalBlue\nsurface Glass, diffuse Black, transparent 90%, reflective 10%, index 1.5, specular White, shine 200\nsphere Red 1, -1 0 0\nsphere Blue 1, 1 0 0\nsphere Glass 0.8, 0 -1 3"),
    row("texture", "make a texture", run(Routine::Texture))
        .takes(&[
            parameter("alias", Kind::New(Names::Texture), "the texture's name"),
            parameter("= old", Kind::Copy(Names::Texture), "the name of the old texture").optional(""),
            word("Target", o::TARGETS, "what the texture changes, such as `pigment`"),
            parameter("Method", Kind::Method, "how to texture: a solid such as `wood`, two waves such as `sin one`, a colour or an image"),
        ])
        .options(o::TEXTURE)
        .details("A method is a solid (`wood`), which fills the space of the object; a pair of waves along u and v (`sin one`; their x is u or v times the scale, in radians for sines); a colour; or an image (`face.png plain`). Its values go from the first of the `bounds` to the second, and scale the target: black leaves nothing of it, white all. Textures move, turn and scale with their object. `normal` makes bumps. u and v run from 0 to 1: along a limb and around it, around a ball and up; each shape of a blend is textured by itself, and the results are mixed. With the target `strength` waves are a profile: they model the flesh along the skeleton (thesis, section 3.4). `texture t1 + t2` puts layers upon each other, at most 12; `texture new = old` copies a texture. Options behind these change each of the layers (ours).")
        .example("light White, position 4 8 10\nlight White, position -8 2 6, intensity 0.3, noshadow\ntexture Rings, pigment wood, scale 2 2 1, bounds SaddleBrown BurlyWood, replace\ntexture Veins, pigment marble, bounds SteelBlue White\ntexture Dimples, normal ripples, scale 1.5 1.5 1.5\nsurface Wood, diffuse White, texture Rings\nsurface Stone, diffuse White, specular Gray50, shine 60, radius 0.8, blobbiness -3, texture Veins + Dimples\nsphere Wood 1.2, -1.8 0 0\nsphere Stone 1, 1.2 0.7 0\nsphere Stone 1, 2 -0.7 0"),
];
