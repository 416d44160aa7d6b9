//! The table itself, in the order of appendix C.

use super::options as o;
use super::{Action, CommandSpec, Group, OptionSpec, Run};
use crate::evaluator::{
    camera, materials, objects, options, primitives, run, scene_commands as scene, textures,
    variables,
};

const fn command(
    group: Group,
    name: &'static str,
    arguments: &'static str,
    meaning: &'static str,
    action: Action,
) -> CommandSpec {
    CommandSpec {
        name,
        group,
        arguments,
        meaning,
        default: "",
        options: &[],
        action,
    }
}

const fn run(
    group: Group,
    name: &'static str,
    arguments: &'static str,
    meaning: &'static str,
    function: Run,
) -> CommandSpec {
    command(group, name, arguments, meaning, Action::Run(function))
}

const fn later(
    group: Group,
    name: &'static str,
    arguments: &'static str,
    meaning: &'static str,
) -> CommandSpec {
    command(group, name, arguments, meaning, Action::Later)
}

const fn idle(
    group: Group,
    name: &'static str,
    arguments: &'static str,
    meaning: &'static str,
    reason: &'static str,
) -> CommandSpec {
    command(group, name, arguments, meaning, Action::NoEffect(reason))
}

const fn structure(
    name: &'static str,
    arguments: &'static str,
    meaning: &'static str,
) -> CommandSpec {
    command(
        Group::Extensions,
        name,
        arguments,
        meaning,
        Action::Structure,
    )
}

impl CommandSpec {
    const fn default(mut self, default: &'static str) -> Self {
        self.default = default;
        self
    }

    const fn options(mut self, options: &'static [OptionSpec]) -> Self {
        self.options = options;
        self
    }
}

use Group::{Camera, Extensions, Materials, Objects, Options, Primitives, Scene, Tools};

const SAVING: &str = "the picture is named and saved by whoever draws it";
const PACKING: &str = "shapes are sorted as suits them best";
const REPORTS: &str = "the page and the program report what they do";
const WINDOWS: &str = "there are no windows here";

/// All commands.
#[rustfmt::skip]
pub static COMMANDS: &[CommandSpec] = &[
    run(Group::Run, "read", "fn1 [fn2 …]", "run the commands of other files", run::read),
    run(Group::Run, "pause", "[message]", "show a message", run::pause),
    run(Group::Run, "return", "", "return from a file (or from a defined command)", run::return_),
    run(Group::Run, "info", "", "tell the version", run::info),
    run(Group::Run, "help", "[command]", "explain a command, or list all", run::help),
    run(Group::Run, "man", "command", "explain a command and its options", run::help),
    later(Group::Run, "test", "command [print]", "run a small étude of a command"),
    idle(Group::Run, "log", "[file]", "open or close a log", REPORTS),
    run(Group::Run, "var", "name = value [hot]", "create or change a variable; `hot` makes it a slider", variables::var),
    idle(Group::Run, "stopwatch", "start | stop", "measure time", REPORTS),
    run(Group::Run, "quit", "", "end the run", run::quit),

    run(Camera, "aperture", "radius", "radius of the lens", camera::aperture).default("0"),
    later(Camera, "focus", "distance", "distance of the focal plane").default("to vrp"),
    run(Camera, "shutter", "fraction", "how long the shutter is open", camera::shutter).default("0"),
    run(Camera, "vrp", "XYZ", "view reference point, in the middle of the picture", camera::vrp).default("0 0 0"),
    run(Camera, "vup", "XYZ", "direction that is up in the picture", camera::vup).default("0 1 0"),
    later(Camera, "cp", "x y z w", "centre of projection, view coordinates"),
    later(Camera, "vpn", "XYZ", "normal of the view plane"),
    later(Camera, "window", "x X y Y", "window, view coordinates"),
    run(Camera, "eyep", "XYZ", "position of the eye", camera::eyep).default("0 0 10"),
    run(Camera, "fov", "hor [vert]", "angle of view, degrees", camera::fov).default("45"),

    run(Materials, "surface", "{ alias option … }  or  surface new = old", "make a material", materials::surface).options(o::SURFACE),
    run(Materials, "texture", "{ alias target method option … }  or  texture new = old", "make a texture", textures::texture).options(o::TEXTURE),

    run(Primitives, "arc", "sn a b P N a1 a2", "arc: sweep and tube radius, centre, normal, start angle and width, degrees", primitives::arc),
    run(Primitives, "arch", "sn b P1 P2 P3", "arc through three points, tube radius b", primitives::arch),
    later(Primitives, "box", "sn PMIN PMAX", "box between two corners"),
    later(Primitives, "brick", "sn x y z", "box around the origin"),
    later(Primitives, "cone", "sn b BASE a APEX", "cone: radius at base, radius at apex"),
    run(Primitives, "cylinder", "sn r BASE APEX", "cylinder; a line segment when soft", primitives::cylinder),
    run(Primitives, "pipe", "sn r BASE APEX", "cylinder without lids", primitives::pipe),
    run(Primitives, "dot", "sn POS", "point with a polynomial kernel", primitives::dot),
    run(Primitives, "gauss", "sn POS", "point with a Gaussian kernel", primitives::gauss),
    run(Primitives, "line", "sn BASE APEX", "line segment with a Gaussian kernel", primitives::line),
    run(Primitives, "sphere", "sn r POS", "sphere; a point when soft", primitives::sphere),
    run(Primitives, "triangle", "sn V1 V2 V3", "flat triangle; a Cauchy triangle when soft", primitives::triangle),
    run(Primitives, "triad", "sn V1 V2 V3", "triangle with the Newtonian kernel", primitives::triad),
    run(Primitives, "plane", "sn POS NORM", "infinite plane", primitives::plane),
    run(Primitives, "polygon", "sn V1 … Vn [hole W1 … Wm …]", "planar polygon, with holes", primitives::polygon),
    later(Primitives, "patch", "sn V1 N1 V2 N2 V3 N3", "smoothly shaded triangle"),
    run(Primitives, "torus", "sn a b POS NORM", "torus: sweep and tube radius, centre, normal", primitives::torus),
    later(Primitives, "quadric", "sn …", "quadric surface"),
    later(Primitives, "terra", "sn …", "height field from an image"),

    run(Objects, "chain", "sn, name", "begin shapes of one material, whose name they leave out", objects::chain),
    run(Objects, "object", "name", "begin an object", objects::object),
    run(Objects, "close", "[name]", "end an object or chain", objects::close),
    run(Objects, "instance", "name [new name]", "copy an object", objects::instance),
    run(Objects, "translate", "x y z [object]", "move an object (by default the last)", objects::translate),
    run(Objects, "rotate", "x y z angle [object]", "turn an object about an axis, degrees", objects::rotate),
    run(Objects, "scale", "x y z [object]", "scale an object", objects::scale),
    later(Objects, "explode", "x y z [object]", "move the parts of an object apart"),
    run(Objects, "transform", "[object]", "apply transforms now", objects::transform),

    run(Options, "echo", "on | off", "echo commands", options::silent_switch).default("on"),
    run(Options, "warning", "on | off", "show warnings", options::warning).default("on"),
    run(Options, "verbose", "on | off", "show notes", options::verbose).default("on"),
    idle(Options, "bounds", "on | off", "use bounding volumes", PACKING).default("on"),
    run(Options, "soft", "on | off", "blend soft shapes; off draws their offset surfaces", options::soft).default("on"),
    idle(Options, "timer", "on | off", "report times", REPORTS).default("on"),
    idle(Options, "double", "on | off", "draw both sides of faces", "both sides are always drawn").default("on"),
    idle(Options, "dither", "on | off", "dither pictures for viewing", "screens show all colours now").default("on"),
    idle(Options, "compress", "on | off", "compress saved pictures", SAVING).default("on"),
    idle(Options, "stat", "on | off", "report statistics", REPORTS).default("off"),
    later(Options, "map", "on | off [N]", "make an image of the time spent on each pixel").default("off"),
    later(Options, "penumbra", "on | off", "soft shadows").default("off"),
    idle(Options, "noview", "on | off", "do not display the picture", WINDOWS).default("off"),
    idle(Options, "nosave", "on | off", "do not save the picture", SAVING).default("off"),
    run(Options, "gamma", "value", "gamma correction", options::gamma).default("1"),
    run(Options, "framesize", "w h", "size of the picture, pixels", options::framesize).default("128 128"),
    idle(Options, "filename", "name", "name of the saved picture", SAVING).default("scene"),
    idle(Options, "format", "tif | tga | mtv | png", "format of the saved picture", SAVING).default("tif"),
    idle(Options, "epsilon", "value", "precision of hits", "hits are found to a tolerance of the tracer's own").default("1e-4"),
    idle(Options, "vanish", "value", "least colour that counts", "no light is left out").default("4e-3"),
    idle(Options, "maxdepth", "number", "depth of the shading tree", "rays are not mirrored in this version").default("5"),
    idle(Options, "maxmol", "number", "largest group of soft shapes", "groups can have any size").default("300"),
    run(Options, "digger", "hermite | lagrange | brent | ridder | RF", "what finds the roots", options::digger).default("hermite").options(o::DIGGER),
    run(Options, "contrast", "r g b", "contrast above which a pixel is sampled further", options::contrast).default(".25 .2 .4"),
    idle(Options, "pack", "none | grid …", "how shapes are sorted", PACKING).default("grid"),
    idle(Options, "indicator", "none | all | bar | text | pixel | line | ETA", "how progress is shown", REPORTS).default("bar"),
    run(Options, "fragile", "all | arc | pipe | cylinder | sphere | none", "soft shapes whose own radius is overruled by their material's", options::fragile).default("none").options(o::FRAGILE),
    run(Options, "sample", "n", "at most n×n rays a pixel", options::sample).default("1"),
    later(Options, "mesh", "…", "polygon meshes"),

    run(Scene, "light", "Color [option …]", "make a light", scene::light).options(o::LIGHT),
    later(Scene, "fog", "Color …", "fog"),
    run(Scene, "background", "Color", "colour behind everything", scene::background),
    later(Scene, "cloud", "Color …", "clouds of light, halos"),
    run(Scene, "remove", "object", "remove an object", objects::remove),
    run(Scene, "report", "…", "tell what the scene holds", scene::report),
    run(Scene, "reset", "all | data | model | surfaces | textures | lights | …", "put things back to what they are at the start", scene::reset).options(o::RESET),
    idle(Scene, "preview", "…", "preview", "the draft is always shown"),
    run(Scene, "shoot", "", "draw the picture", scene::shoot),

    later(Tools, "animate", "fn1 … [loop | mirror | dither]", "make an animation"),
    later(Tools, "play", "fn", "play an animation"),
    later(Tools, "split", "fn [frame.fmt]", "split an animation into pictures"),
    later(Tools, "collage", "[options] fn1 fn2 …", "put pictures together"),
    later(Tools, "fli", "fn1 …", "make an animation"),
    later(Tools, "convert", "fn1 fn2", "convert a picture"),
    later(Tools, "resize", "fn x y", "resize a picture"),
    later(Tools, "diff", "fn1 fn2", "difference of two pictures"),
    later(Tools, "and", "fn1 fn2", "AND of two pictures"),
    later(Tools, "xor", "fn1 fn2", "XOR of two pictures"),
    later(Tools, "show", "…", "show a file, a colour, a palette"),
    idle(Tools, "kill", "[w1 …]", "close windows", WINDOWS),
    idle(Tools, "refresh", "[w1 …]", "draw windows again", WINDOWS),
    idle(Tools, "tile", "[options]", "arrange windows", WINDOWS),
    run(Tools, "colors", "", "list the colours by name", run::colors),
    run(Tools, "rats", "", "small talk", run::rats),
    later(Tools, "table", "v1 v2 …", "plot numbers"),
    later(Tools, "shell", "[options]", "generate a shell"),
    later(Tools, "horn", "[options]", "generate a horn"),

    run(Extensions, "material", "{ alias option … }", "the same as surface", materials::surface).options(o::SURFACE),
    run(Extensions, "blobscale", "relative | absolute", "how blobbiness is read", options::blobscale).default("relative").options(o::BLOBSCALE),
    run(Extensions, "influence", "e", "share of the threshold below which a soft shape is ignored", options::influence).default("0.001"),
    run(Extensions, "curve", "sn b P1 P2 P3 P4 [P5 P6 P7 …]", "cubic Bézier curve of tube radius b; more points join more curves", primitives::curve),
    run(Extensions, "seed", "n", "start the random numbers of `rand`", variables::seed).default("0"),
    structure("for", "i = a to b [step c] { … }", "repeat commands"),
    structure("if", "condition { … } [else { … }]", "run commands if a condition holds"),
    structure("else", "{ … }", "the other branch of if"),
    structure("define", "name(a, b, …) { … }", "make a new command; parameters in CAPITALS take triples"),
];
