//! The option words of the commands that have them.

use super::parameter::{
    Kind, Names, OptionSpec, Parameter, Unit, colour, degrees, direction, length, number,
    parameter, vector, word,
};

const fn option(
    name: &'static str,
    parameters: &'static [Parameter],
    default: &'static str,
    meaning: &'static str,
) -> OptionSpec {
    OptionSpec {
        name,
        parameters,
        meaning,
        default,
    }
}

/// A word that is all there is to it.
const fn plain(name: &'static str, meaning: &'static str) -> OptionSpec {
    option(name, &[], "", meaning)
}

const fn share(meaning: &'static str) -> Parameter {
    parameter("RGB|N%", Kind::Share, meaning)
}

const LAYERS: &[Parameter] =
    &[parameter("t1 +", Kind::Known(Names::Texture), "the texture's name").many()];

/// `surface`, `material`.
pub static SURFACE: &[OptionSpec] = &[
    option(
        "body",
        &[colour("RGB", "the body's colour")],
        "as diffuse",
        "main colour, of which `N%` are taken",
    ),
    option(
        "ambient",
        &[share("the ambient colour")],
        "15% of diffuse",
        "light given off",
    ),
    option(
        "diffuse",
        &[share("the diffuse colour")],
        "as body",
        "light scattered evenly",
    ),
    option(
        "specular",
        &[share("the specular colour")],
        "0 0 0",
        "colour of the highlight",
    ),
    option(
        "reflective",
        &[share("the share of light mirrored")],
        "0 0 0",
        "light reflected as by a mirror",
    ),
    option(
        "transparent",
        &[share("the share of light let through")],
        "0 0 0",
        "light let through",
    ),
    option(
        "index",
        &[number("k", "the index of refraction").from(0.01, 100.0)],
        "1",
        "index of refraction",
    ),
    option(
        "dispersion",
        &[number("d", "the dispersion").from(0.0, 100.0)],
        "0",
        "how the index varies with colour",
    ),
    option(
        "shine",
        &[number("p", "the shine").from(0.0, 1e6)],
        "0",
        "Phong's exponent: the larger, the smaller the highlight",
    ),
    option(
        "radius",
        &[
            length("r", "the radius").at_least(0.0),
            length("end", "the radius at the other end")
                .at_least(0.0)
                .optional(""),
        ],
        "0",
        "radius in isolation of soft shapes; a second one at the other end of lines, arcs, curves (ours)",
    ),
    option(
        "blobbiness",
        &[
            number("b", "the blobbiness"),
            number("end", "the blobbiness at the other end").optional(""),
        ],
        "0",
        "softness: negative; near 0 is blobby, far from 0 crisp; 0 is hard; a second one at the other end (ours)",
    ),
    option(
        "depth",
        &[length("d", "the depth").at_least(0.0)],
        "0",
        "depth of influence, from which the radius follows (ours)",
    ),
    option(
        "strength",
        &[number("s", "the strength")],
        "1",
        "multiplies the field; negative carves",
    ),
    option(
        "restriction",
        &[number("f", "the restriction").from(0.0, 1.0)],
        "0",
        "share of a triangle's field taken away at its edges: 1 creases a mesh (ours)",
    ),
    option(
        "skip",
        &[word(
            "RAYTYPE",
            RAYS,
            "`pixel`, `shadow`, `reflected` or `transmitted`",
        )
        .many()],
        "",
        "rays that do not see it",
    ),
    option("texture", LAYERS, "", "layers of textures"),
    option(
        "kernel",
        &[word("name", KERNELS, "the kernel's name")],
        "the command's own: cauchy, or as it says",
        "the kernel of soft shapes (ours)",
    ),
];

/// Rays that `skip` names.
pub static RAYS: &[OptionSpec] = &[
    plain("pixel", "rays from the eye"),
    plain("shadow", "rays to the lights"),
    plain("reflected", "mirrored rays"),
    plain("transmitted", "rays let through"),
];

/// The kernels: how a skeleton's flesh fades with distance (fields.md §1).
pub static KERNELS: &[OptionSpec] = &[
    plain(
        "cauchy",
        "1/(1+s²r²)²: wide and smooth, closed forms for every primitive",
    ),
    plain("gauss", "exp(−a²r²): falls fast"),
    plain("inverse", "1/r: the Newtonian potential, very wide"),
    plain("squared", "1/r²"),
    plain("metaballs", "piecewise quadratic, nothing beyond r = 1"),
    plain(
        "soft",
        "the soft objects' polynomial of degree 6, nothing beyond r = 1",
    ),
    plain("quartic", "(1−r²)², nothing beyond r = 1"),
    plain("compact6", "(1−r²)³, nothing beyond r = 1"),
    plain("cubed", "1/r³: no width, so the blobbiness is ignored"),
];

/// Properties of a material that a texture changes.
pub static TARGETS: &[OptionSpec] = &[
    plain("diffuse", "the diffuse colour"),
    plain("ambient", "the ambient colour"),
    plain("specular", "the highlight"),
    plain("reflective", "the mirror's colour"),
    plain("transparent", "the colour let through"),
    plain("index", "the index of refraction"),
    plain("shine", "the highlight's size"),
    plain("pigment", "diffuse and ambient"),
    plain("normal", "bumps"),
    plain("strength", "the field: a profile"),
    option("texture", LAYERS, "", "layers of other textures"),
];

/// Solid textures.
pub static SOLIDS: &[OptionSpec] = &[
    plain("marble", "marble"),
    plain("agate", "agate"),
    plain("granite", "granite"),
    plain("moon", "craters"),
    plain("onion", "shells"),
    plain("wood", "rings"),
    plain("ripples", "waves"),
    plain("sandal", "sandal wood"),
    plain("checker", "checkers"),
    plain("paint", "paint"),
];

/// The waves of the method `Fu Fv`, along a shape's u and v.
pub static WAVES: &[OptionSpec] = &[
    plain("one", "1 everywhere"),
    plain("x", "from 0 to 1"),
    plain("saw", "from 0 to 1 again and again"),
    plain("hat", "up and down in straight lines"),
    plain("step", "0, then 1"),
    plain("sin", "a sine between 0 and 1"),
    plain("cos", "a cosine between 0 and 1"),
    plain("sin^2", "a squared sine"),
    plain("cos^2", "a squared cosine"),
];

/// `texture`.
pub static TEXTURE: &[OptionSpec] = &[
    option(
        "translate",
        &[vector("XYZ", "the shift")],
        "0 0 0",
        "moves the texture, in units of the object; of waves and images in shares of u and v",
    ),
    option(
        "scale",
        &[parameter("XYZ", Kind::Vector, "the scale")],
        "1 1 1",
        "factors on the place: the larger, the finer the texture",
    ),
    option(
        "times",
        &[parameter("RGB", Kind::Vector, "the factor")],
        "1 1 1",
        "scales its values, and the height of bumps",
    ),
    option(
        "bounds",
        &[
            parameter("RGB", Kind::Vector, "the lowest value"),
            parameter("RGB", Kind::Vector, "the highest value"),
        ],
        "0 0 0 1 1 1",
        "its lowest and highest value: two colours between which it goes",
    ),
    option(
        "turbulence",
        &[number("t", "the turbulence").at_least(0.0)],
        "1",
        "noise of solids: 0 is none",
    ),
    option(
        "octaves",
        &[number("r", "the octaves").from(0.0, 32.0)],
        "5",
        "detail of the noise of solids",
    ),
    option(
        "mask",
        &[super::parameter::whole("1 0", 0, 1, "an entry of the mask").many()],
        "",
        "tiles shown (1) and left out (0), row by row: as many as the scale has tiles along x, times those along y",
    ),
    plain(
        "replace",
        "values take the place of the target's, instead of scaling them",
    ),
    option(
        "texture",
        LAYERS,
        "",
        "layers of other textures, upon this one",
    ),
];

/// `light`.
pub static LIGHT: &[OptionSpec] = &[
    plain(
        "point",
        "shines from a point; the kind of a light that names none",
    ),
    plain("distant", "shines from infinity"),
    plain("spot", "shines in a cone"),
    option(
        "position",
        &[vector("XYZ", "the light's position")],
        "",
        "where it is; a distant light shines from there to 0 0 0",
    ),
    option(
        "direction",
        &[direction("XYZ", "the light's direction")],
        "to 0 0 0",
        "where a distant light or a spot shines to",
    ),
    option(
        "intensity",
        &[number("k", "the intensity").from(0.0, 1e6)],
        "1",
        "multiplies the colour",
    ),
    plain("noshadow", "nothing stops it"),
    option(
        "angle",
        &[degrees("a", "the spot's angle").from(0.01, 180.0)],
        "30",
        "angle of a spot from its axis to the end of its light (ours)",
    ),
    option(
        "edge",
        &[degrees("e", "the spot's soft edge").from(0.0, 180.0)],
        "a quarter of the angle",
        "angle at the end of a spot over which its light fades (ours)",
    ),
    option(
        "size",
        &[length("s", "the light's radius").from(0.0, 1e6)],
        "0",
        "radius, for soft shadows with `penumbra on`; of a distant light at the distance 1 (ours)",
    ),
];

/// `fog`.
pub static FOG: &[OptionSpec] = &[
    option(
        "distance",
        &[length("d", "the distance").at_least(1e-9)],
        "twice as far as vrp",
        "where 37% of the light is left, 14% at twice that (ours)",
    ),
    option(
        "height",
        &[length("h", "the height").at_least(1e-9)],
        "as dense everywhere",
        "over which the fog thins out to 37%, upwards from 0 (ours)",
    ),
];

/// `cloud`.
pub static CLOUD: &[OptionSpec] = &[
    option(
        "position",
        &[vector("XYZ", "the cloud's middle")],
        "0 0 0",
        "its middle (ours)",
    ),
    option(
        "object",
        &[parameter(
            "name",
            Kind::Known(Names::Object),
            "the object's name",
        )],
        "",
        "an object in the middle of it, in place of a position: a halo (ours)",
    ),
    option(
        "radius",
        &[length("r", "the cloud's radius").at_least(1e-9)],
        "1; of a halo, twice the object's",
        "how far it reaches (ours)",
    ),
    option(
        "density",
        &[number("k", "the density").from(0.0, 1e6)],
        "1",
        "multiplies its light (ours)",
    ),
];

/// `background`.
pub static BACKGROUND: &[OptionSpec] = &[option(
    "to",
    &[colour("Color", "the colour below")],
    "",
    "another colour below the first: they change over around the horizon (ours)",
)];

/// `sky`.
pub static SKY: &[OptionSpec] = &[
    option(
        "to",
        &[colour("Color", "the horizon's colour")],
        "as above",
        "light from the horizon and below",
    ),
    option(
        "intensity",
        &[number("k", "the intensity").from(0.0, 1e6)],
        "1",
        "multiplies its light, not what is seen of it",
    ),
    option(
        "samples",
        &[super::parameter::whole(
            "n",
            1,
            scene::Sky::MAX_SAMPLES,
            "the number of directions",
        )],
        "4",
        "directions in which each ray looks for the sky",
    ),
];

/// `ground`.
pub static GROUND: &[OptionSpec] = &[option(
    "height",
    &[length("h", "the height")],
    "just below everything",
    "where it is, along the direction up",
)];

/// `tone`.
pub static TONES: &[OptionSpec] = &[
    plain("none", "what is brighter than the screen is cut"),
    plain("filmic", "bright light fades softly into white, as on film"),
];

/// How an image lies on a surface.
pub static MAPPINGS: &[OptionSpec] = &[
    plain("plain", "by u and v, over the whole shape"),
    option(
        "region",
        &[
            vector("MIN", "the region's lowest corner"),
            vector("MAX", "the region's highest corner"),
            vector("P1", "the rectangle's lower left corner"),
            vector("P2", "the rectangle's lower right corner"),
            vector("P3", "the rectangle's upper right corner"),
            vector("P4", "the rectangle's upper left corner"),
        ],
        "",
        "on points in a box whose normals pass through a rectangle",
    ),
];

/// `reset`, `report`.
pub static RESET: &[OptionSpec] = &[
    plain("all", "everything"),
    plain("data", "shapes and objects"),
    plain("model", "shapes and objects"),
    plain("surfaces", "materials"),
    plain("textures", "textures"),
    plain("lights", "lights"),
    plain("background", "the background, sky and ground"),
    plain("clouds", "clouds of light"),
    plain("fog", "fog"),
    plain("cameras", "the camera"),
    plain("options", "all settings"),
    plain("var", "variables"),
];

/// `fragile`.
pub static FRAGILE: &[OptionSpec] = &[
    plain("all", "all of these"),
    plain("arc", "arcs and arches"),
    plain("pipe", "pipes"),
    plain("cylinder", "cylinders"),
    plain("sphere", "spheres"),
    plain("none", "none of these"),
];

/// `blobscale`.
pub static BLOBSCALE: &[OptionSpec] = &[
    plain("relative", "the width is |B|/R²"),
    plain("absolute", "the width is |B|"),
];

/// `digger`.
pub static DIGGER: &[OptionSpec] = &[
    plain(
        "hermite",
        "Hermite spans as short as a certified bound of their error demands; packets of rays",
    ),
    plain(
        "hermite2",
        "equally long Hermite spans on each shape's part of the ray, two as published",
    ),
    plain("lagrange", "polynomials of degree 4 through samples"),
    plain("brent", "steps to a change of sign, then Brent's method"),
    plain("ridder", "steps to a change of sign, then Ridders' method"),
    plain("RF", "steps to a change of sign, then the regula falsi"),
    plain(
        "LG",
        "halving until Lipschitz constants settle it (Kalra and Barr)",
    ),
    plain("sphere", "sphere tracing (Hart)"),
];

/// `pack`.
pub static PACK: &[OptionSpec] = &[
    plain("none", "a list"),
    option(
        "grid",
        &[super::parameter::whole("X Y Z", 1, 1024, "the cells of the grid").any()],
        "",
        "a grid of cells",
    ),
];

/// `indicator`.
pub static INDICATOR: &[OptionSpec] = &[
    plain("none", "nothing"),
    plain("all", "all of these"),
    plain("bar", "a bar"),
    plain("text", "words"),
    plain("pixel", "every pixel"),
    plain("line", "every line"),
    plain("ETA", "the time that is left"),
];

/// `format`.
pub static FORMATS: &[OptionSpec] = &[
    plain("tif", "TIFF"),
    plain("tga", "Targa"),
    plain("mtv", "MTV: width, height and bytes"),
    plain("png", "PNG (ours)"),
];

/// `stopwatch`.
pub static STOPWATCH: &[OptionSpec] = &[
    plain("start", "begin"),
    plain("stop", "end and tell the time"),
];

/// `mesh` as RATS has it.
pub static MESH: &[OptionSpec] = &[
    plain("robust", "faces are checked"),
    plain("fast", "faces are taken as they are"),
];

/// `mesh` as an implicit surface.
pub static METABALLS: &[OptionSpec] = &[
    plain(
        "metaballs",
        "a soft surface around the mesh, of one metaball a facet: `spherical` or `triangular` (ours)",
    ),
    option(
        "spherical",
        &[number("k", "how sharply the field falls")],
        "",
        "of balls around the circumcircles of the facets",
    ),
    option(
        "triangular",
        &[
            length("d0", "the thickness").at_least(0.0),
            number("k", "how sharply the field falls"),
        ],
        "",
        "of shells of this thickness around the facets",
    ),
];

/// `deform`.
pub static DEFORM: &[OptionSpec] = &[
    option(
        "control",
        &[vector("XYZ", "the control point")],
        "",
        "a control point",
    ),
    option(
        "move",
        &[vector("XYZ", "the way")],
        "0 0 0",
        "by how much it moves what is near",
    ),
];

/// `test`.
pub static TEST: &[OptionSpec] = &[plain("print", "only show the text")];

/// `var`.
pub static VAR: &[OptionSpec] = &[
    option(
        "hot",
        &[
            number("low", "the slider's lowest value").optional(""),
            number("high", "the slider's highest value").optional(""),
            number("step", "the slider's step").optional(""),
        ],
        "",
        "a slider in the page; its range and step are ours",
    ),
    option(
        "+=",
        &[number("step", "the change with every frame")],
        "",
        "grows with every frame of an animation",
    ),
    option(
        "*=",
        &[number("factor", "the change with every frame")],
        "",
        "is multiplied with every frame of an animation",
    ),
];

/// `animate`, `play`.
pub static ANIMATE: &[OptionSpec] = &[
    plain("loop", "again and again"),
    plain("mirror", "there and back"),
    plain("dither", "fewer colours"),
];

/// `fli`.
pub static FLI: &[OptionSpec] = &[
    option(
        "speed",
        &[super::parameter::whole(
            "N",
            1,
            100,
            "the pictures in a second",
        )],
        "10",
        "pictures in a second",
    ),
    option(
        "size",
        &[
            super::parameter::whole("W", 1, 4096, "the width").unit(Unit::Pixels),
            super::parameter::whole("H", 1, 4096, "the height").unit(Unit::Pixels),
        ],
        "of the first",
        "size of the film",
    ),
];

/// `collage`.
pub static COLLAGE: &[OptionSpec] = &[
    option(
        "columns",
        &[super::parameter::whole(
            "n",
            1,
            256,
            "the number of columns",
        )],
        "as many as make it square",
        "pictures side by side",
    ),
    option(
        "gap",
        &[super::parameter::whole("p", 0, 256, "the gap").unit(Unit::Pixels)],
        "0",
        "room between pictures",
    ),
];

/// `diff`, `and`, `xor`.
pub static SAVE: &[OptionSpec] = &[option(
    "save",
    &[parameter("fn", Kind::NewFile, "the new file's name")],
    "",
    "writes the result",
)];

/// `show`.
pub static SHOW: &[OptionSpec] = &[
    option(
        "file",
        &[parameter("fn", Kind::File, "a picture's name")],
        "",
        "a picture",
    ),
    option("color", &[colour("Color", "a colour")], "", "a colour"),
    plain("palette", "all colours with a name"),
];

/// `quadric`.
pub static QUADRIC: &[OptionSpec] = &[
    option(
        "translate",
        &[vector("XYZ", "the shift")],
        "0 0 0",
        "moves it",
    ),
    option(
        "scale",
        &[parameter("XYZ", Kind::Vector, "the scale")],
        "1 1 1",
        "scales it",
    ),
    option(
        "bounds",
        &[
            vector("MIN", "the lowest corner"),
            vector("MAX", "the highest corner"),
        ],
        "-1 -1 -1 1 1 1",
        "the box it is cut off at",
    ),
];

/// `polygon`.
pub static POLYGON: &[OptionSpec] = &[option(
    "hole",
    &[vector("W1", "a corner of the hole").many()],
    "",
    "a hole in it (ours)",
)];

/// `skeleton`.
pub static SKELETON: &[OptionSpec] = &[
    option(
        "node",
        &[
            parameter("A", Kind::New(Names::Node), "the node's name"),
            vector("P", "the node's place"),
        ],
        "",
        "a node, with a name that curves call it by",
    ),
    option(
        "radius",
        &[length("r", "the radius at the node").at_least(0.0)],
        "the material's",
        "radius of the flesh at the node that stands before it",
    ),
    option(
        "curve",
        &[parameter("A B", Kind::Known(Names::Node), "the name of a node").many()],
        "",
        "a curve along nodes, two at least: from the first to the last, drawn towards those between",
    ),
    option(
        "subdivide",
        &[super::parameter::whole(
            "n",
            0,
            skeleton::MOST_LEVELS,
            "how often curves are refined",
        )],
        "3",
        "how often curves are refined: each time doubles their segments",
    ),
    option(
        "scheme",
        &[word("name", SCHEMES, "the scheme's name")],
        "cubic",
        "how curves are refined",
    ),
    option(
        "local",
        &[length("D", "the length along the curves within which flesh blends").at_least(1e-6)],
        "",
        "folds do not blend: at a point only what is within D along the curves counts",
    ),
];

/// `motion`.
pub static MOTION: &[OptionSpec] = &[
    option(
        "gravity",
        &[parameter("V", Kind::Vector, "the acceleration")],
        "0 -9.81 0",
        "acceleration of all that falls, lengths per second²",
    ),
    option(
        "damping",
        &[number("d", "the damping").at_least(0.0)],
        "0.2",
        "share of the speed that air takes in a second",
    ),
    option(
        "stiffness",
        &[number("k", "the stiffness").at_least(0.0)],
        "1000",
        "force that stretches a curve to twice its length, for nodes of a mean mass of 1",
    ),
    option(
        "bending",
        &[number("b", "the share").at_least(0.0)],
        "0.2",
        "share of the stiffness with which curves resist bending and twisting",
    ),
    option(
        "steps",
        &[super::parameter::whole(
            "n",
            1,
            motion::MOST_STEPS,
            "the steps of a frame",
        )],
        "16",
        "steps of a frame",
    ),
    option(
        "rate",
        &[number("f", "frames of a second").from(0.1, 1000.0)],
        "25",
        "frames of a second",
    ),
    option(
        "floor",
        &[
            vector("P", "a point of the floor"),
            parameter("N", Kind::Direction, "the floor's normal"),
        ],
        "none",
        "a floor or wall; the normal points to where there is room; there may be several",
    ),
    option(
        "bounce",
        &[number("e", "the share").from(0.0, 1.0)],
        "0",
        "share of the speed that is left after a blow",
    ),
    option(
        "friction",
        &[number("m", "the coefficient").from(0.0, 1000.0)],
        "0.4",
        "friction: 0 is ice, 1 is rubber",
    ),
    option(
        "pin",
        &[parameter("A", Kind::Known(Names::Node), "the name of a node").many()],
        "",
        "nodes that stay where the text has them, frame by frame",
    ),
    option(
        "against",
        &[parameter("object", Kind::Known(Names::Object), "an object's name").many()],
        "",
        "objects that stand in the way: boxes, spheres, cylinders, cones, pipes, planes, skeletons",
    ),
];

/// Schemes of subdivision.
pub static SCHEMES: &[OptionSpec] = &[
    plain("cubic", "the smoothest: cubic B-splines"),
    plain(
        "chaikin",
        "nearer to the nodes: corners are cut, quadratic B-splines",
    ),
    plain("fourpoint", "through every node"),
];

const BULGE_START: Parameter =
    number("c", "the other's field where the bulge begins").from(0.001, 0.999);
const BULGE_HEIGHT: Parameter = number("h", "the height of the bulge").from(0.0, 0.999);

/// `contact`.
pub static CONTACT: &[OptionSpec] = &[
    option(
        "fast",
        &[BULGE_START],
        "0.2",
        "a plain bulge, which begins where the other's field is c",
    ),
    option(
        "height",
        &[
            BULGE_START,
            number("m", "the other's field where the bulge is highest").from(0.001, 0.999),
            BULGE_HEIGHT,
        ],
        "",
        "a bulge from c on that is highest, h, where the other's field is m",
    ),
    option(
        "ripple",
        &[
            BULGE_START,
            BULGE_HEIGHT,
            super::parameter::whole(
                "n",
                0,
                contact::Bulge::MOST_RIPPLES,
                "the number of ripples",
            ),
        ],
        "",
        "a bulge of height h with n ripples outside it, from c on",
    ),
];
