//! The option words of the commands that have them.

use super::OptionSpec;

const fn option(
    name: &'static str,
    arguments: &'static str,
    default: &'static str,
    meaning: &'static str,
) -> OptionSpec {
    OptionSpec {
        name,
        arguments,
        meaning,
        default,
    }
}

/// `surface`, `material`.
pub static SURFACE: &[OptionSpec] = &[
    option(
        "body",
        "RGB",
        "diffuse",
        "main colour, of which `N%` are taken",
    ),
    option("ambient", "RGB | N%", "15% of diffuse", "light given off"),
    option("diffuse", "RGB | N%", "body", "light scattered evenly"),
    option("specular", "RGB | N%", "0 0 0", "colour of the highlight"),
    option(
        "reflective",
        "RGB | N%",
        "0 0 0",
        "light reflected as by a mirror",
    ),
    option("transparent", "RGB | N%", "0 0 0", "light let through"),
    option("index", "k", "1", "index of refraction"),
    option("dispersion", "d", "0", "how the index varies with colour"),
    option(
        "shine",
        "p",
        "0",
        "Phong's exponent: the larger, the smaller the highlight",
    ),
    option(
        "radius",
        "r [end]",
        "0",
        "radius in isolation of soft shapes; a second one at the other end of lines, arcs, curves (ours)",
    ),
    option(
        "blobbiness",
        "b [end]",
        "0",
        "softness: negative; near 0 is blobby, far from 0 crisp; 0 is hard; a second one at the other end (ours)",
    ),
    option(
        "depth",
        "d",
        "0",
        "depth of influence, from which the radius follows (ours)",
    ),
    option(
        "strength",
        "s",
        "1",
        "multiplies the field; negative carves",
    ),
    option(
        "restriction",
        "f",
        "0",
        "share of a triangle's field taken away at its edges: 1 creases a mesh (ours)",
    ),
    option(
        "skip",
        "pixel | shadow | reflected | transmitted …",
        "",
        "rays that do not see it",
    ),
    option("texture", "t1 [+ t2 …]", "", "layers of textures"),
    option(
        "kernel",
        "cauchy | gauss | inverse | squared | metaballs | soft | quartic | compact6",
        "the command's own: cauchy, or as it says",
        "the kernel of soft shapes (ours)",
    ),
];

/// What rays `skip` names.
pub static RAYS: &[OptionSpec] = &[
    option("pixel", "", "", "rays from the eye"),
    option("shadow", "", "", "rays to the lights"),
    option("reflected", "", "", "mirrored rays"),
    option("transmitted", "", "", "rays let through"),
];

/// What a texture changes.
pub static TARGETS: &[OptionSpec] = &[
    option("diffuse", "", "", "the diffuse colour"),
    option("ambient", "", "", "the ambient colour"),
    option("specular", "", "", "the highlight"),
    option("reflective", "", "", "the mirror's colour"),
    option("transparent", "", "", "the colour let through"),
    option("index", "", "", "the index of refraction"),
    option("shine", "", "", "the highlight's size"),
    option("pigment", "", "", "diffuse and ambient"),
    option("normal", "", "", "bumps"),
    option("strength", "", "", "the field: a profile"),
    option("texture", "t1 [+ t2 …]", "", "layers of other textures"),
];

/// Solid textures.
pub static SOLIDS: &[OptionSpec] = &[
    option("marble", "", "", "marble"),
    option("agate", "", "", "agate"),
    option("granite", "", "", "granite"),
    option("moon", "", "", "craters"),
    option("onion", "", "", "shells"),
    option("wood", "", "", "rings"),
    option("ripples", "", "", "waves"),
    option("sandal", "", "", "sandal wood"),
    option("checker", "", "", "checkers"),
    option("paint", "", "", "paint"),
];

/// `texture`.
pub static TEXTURE: &[OptionSpec] = &[
    option("translate", "XYZ", "0 0 0", "moves the texture"),
    option("scale", "XYZ", "1 1 1", "scales the texture"),
    option("times", "RGB", "1 1 1", "scales its values"),
    option(
        "bounds",
        "RGB RGB",
        "0 0 0 1 1 1",
        "its lowest and highest value",
    ),
    option("turbulence", "t", "1", "noise"),
    option("octaves", "r", "5", "detail of the noise"),
    option("mask", "1 0 …", "", "tiles shown and left out"),
    option(
        "replace",
        "",
        "",
        "values replace the target instead of scaling it",
    ),
    option("texture", "t1 [+ t2 …]", "", "layers of other textures"),
];

/// `light`.
pub static LIGHT: &[OptionSpec] = &[
    option("point", "", "yes", "shines from a point"),
    option("distant", "", "", "shines from infinity"),
    option("spot", "", "", "shines in a cone"),
    option("extended", "", "", "shines from a ball"),
    option(
        "position",
        "XYZ",
        "",
        "where it is; a distant light shines from there to 0 0 0",
    ),
    option("direction", "XYZ", "", "where a distant light shines to"),
    option("intensity", "k", "1", "multiplies the colour"),
    option("noshadow", "", "", "nothing stops it"),
    option("angle", "a", "", "opening of a spot, degrees"),
    option("radius", "r", "", "radius of an extended light"),
];

/// `reset`.
pub static RESET: &[OptionSpec] = &[
    option("all", "", "", "everything"),
    option("data", "", "", "shapes and objects"),
    option("model", "", "", "shapes and objects"),
    option("surfaces", "", "", "materials"),
    option("textures", "", "", "textures"),
    option("lights", "", "", "lights"),
    option("background", "", "", "the background"),
    option("clouds", "", "", "clouds"),
    option("fog", "", "", "fog"),
    option("cameras", "", "", "the camera"),
    option("options", "", "", "all settings"),
    option("var", "", "", "variables"),
];

/// `fragile`.
pub static FRAGILE: &[OptionSpec] = &[
    option("all", "", "", "all of these"),
    option("arc", "", "", "arcs and arches"),
    option("pipe", "", "", "pipes"),
    option("cylinder", "", "", "cylinders"),
    option("sphere", "", "", "spheres"),
    option("none", "", "", "none of these"),
];

/// `blobscale`.
pub static BLOBSCALE: &[OptionSpec] = &[
    option("relative", "", "", "the width is |B|/R²"),
    option("absolute", "", "", "the width is |B|"),
];

/// `digger`.
pub static DIGGER: &[OptionSpec] = &[
    option("hermite", "", "", "Hermite interpolation"),
    option("lagrange", "", "", "Lagrange interpolation"),
    option("brent", "", "", "Brent's method"),
    option("ridder", "", "", "Ridder's method"),
    option("RF", "", "", "regula falsi"),
];
