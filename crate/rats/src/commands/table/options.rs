//! OPTIONS: settings of the picture and of how it is made.

use crate::commands::build::{clay, flesh, idle, row, run};
use crate::commands::options as o;
use crate::commands::parameter::{
    Kind, Names, ON_OFF, Parameter, SWITCH, Unit, colour, number, parameter, whole, word,
};
use crate::commands::spec::{Action, CommandSpec, Routine};
use scene::Settings;

const SAVING: &str = "the picture is named and saved by whoever draws it";
const PACKING: &str = "shapes are sorted as suits them best";
const REPORTS: &str = "the page and the program report what they do";
const WINDOWS: &str = "there are no windows here";

const fn switch(
    name: &'static str,
    meaning: &'static str,
    action: Action,
    default: &'static str,
) -> CommandSpec {
    row(name, meaning, action).takes(SWITCH).default(default)
}

const FRAGILE: Parameter = word(
    "what",
    o::FRAGILE,
    "`all`, `none` or the names of primitives",
)
.many();

/// The commands.
#[rustfmt::skip]
pub static OPTIONS: &[CommandSpec] = &[
    switch("echo", "echo commands", run(Routine::SilentSwitch), "on").example("echo off"),
    switch("warning", "show warnings", run(Routine::Warning), "on").example("warning off"),
    switch("verbose", "show notes", run(Routine::Verbose), "on").example("verbose off"),
    switch("bounds", "use bounding volumes", idle(PACKING), "on").example("bounds on"),
    switch("soft", "blend soft shapes; off draws their offset surfaces", run(Routine::Soft), "on")
        .example(flesh!("soft off\nsphere Flesh 0.6, -0.6 0 0\nsphere Flesh 0.6, 0.6 0 0")),
    switch("timer", "report times", idle(REPORTS), "on").example("timer on"),
    switch("double", "draw both sides of faces", run(Routine::Double), "on")
        .details("Off hides the faces of triangles, polygons, patches and meshes that are seen from behind; the front of a face is the side from which its corners run counterclockwise. RATS had `double` off unless a dataset said otherwise; here it is on.")
        .example(clay!("double off\ntriangle Clay, <-2 -1 0> <2 -1 0> <0 2 0>")),
    switch("dither", "dither pictures for viewing", idle("screens show all colours now"), "on").example("dither on"),
    switch("compress", "compress saved pictures", idle(SAVING), "on").example("compress on"),
    switch("stat", "report statistics", idle(REPORTS), "off").example("stat on"),
    row("map", "show what each pixel costs instead of its colour", run(Routine::Map))
        .takes(&[ON_OFF, number("N", "the gamma of the map").from(0.1, 10.0).optional("1")])
        .default("off")
        .details("Black is no work, white the dearest pixel of a sample (a packet of rays in every 16×16 pixels); N above 1 lifts what is dark. Work is counted, not timed, so that a map is the same everywhere: an evaluation of one shape's field at one point counts 1, and so does each ray to the eye or to a light. Rays of a packet share the work that is done for all of them, and a pixel shows the mean of its rays.")
        .example(flesh!("map on 1.5\nsphere Flesh 0.6, -0.6 0 0\nsphere Flesh 0.6, 0.6 0 0")),
    switch("penumbra", "soft shadows", run(Routine::Penumbra), "off")
        .details("Shadows of lights that have a `size` get soft edges: a place gets the share of the light that it sees. More samples (`sample`) make them smoother.")
        .example("surface Clay, diffuse SandyBrown, specular Gray50, shine 40\npenumbra on\nsample 3\nground Gray80\neyep 0 4 9\nlight White, position 5 9 4, size 1.5\nsphere Clay 1.5, 0 0 0"),
    switch("noview", "do not display the picture", idle(WINDOWS), "off").example("noview on"),
    switch("nosave", "do not save the picture", run(Routine::Nosave), "off")
        .details("The program that runs the dataset then neither traces nor writes the picture, unless it is told a name for it with `-o`. In the page, tools do not find the picture among the files; you can still save it by hand.")
        .example("nosave on"),
    row("gamma", "gamma correction", run(Routine::Gamma))
        .takes(&[number("value", "gamma").from(0.1, 10.0)])
        .default("1")
        .example(clay!("gamma 1.8\nsphere Clay 2, 0 0 0")),
    row("framesize", "size of the picture", run(Routine::Framesize))
        .takes(&[
            whole("w", 1, Settings::MAX_FRAME, "the width").unit(Unit::Pixels),
            whole("h", 1, Settings::MAX_FRAME, "the height").unit(Unit::Pixels),
        ])
        .default("128 128")
        .example(clay!("framesize 320 200\nsphere Clay 2, 0 0 0")),
    row("filename", "name of the saved picture", run(Routine::Filename))
        .takes(&[parameter("name", Kind::NewFile, "the picture's name")])
        .default("scene")
        .details("The program saves the picture under this name, and tools such as `collage` know it by this name and its `format`: `shell.png`.")
        .example("filename shell"),
    row("format", "format of the saved picture", run(Routine::Format))
        .takes(&[word("format", o::FORMATS, "a format, such as `tif`")])
        .default("tif")
        .details("The program writes all of these; the page saves PNG whatever stands here.")
        .example("format png"),
    row("epsilon", "how far mirrored and refracted rays start from hard surfaces", run(Routine::Epsilon))
        .takes(&[number("value", "the precision").from(1e-12, 0.1)])
        .default("1e-4")
        .details("A share of the scene's size. Rays from soft surfaces start as near as their own error allows.")
        .example(clay!("epsilon 1e-4\nsurface Chrome, diffuse Gray20, reflective 70%\nsphere Chrome 1.5, -1 0 0\nsphere Clay 1, 1.5 0 1")),
    row("vanish", "least share of light that a mirrored or refracted ray must bring", run(Routine::Vanish))
        .takes(&[number("value", "the least colour").from(0.0, 1.0)])
        .default("4e-3")
        .details("A ray that would change each of red, green and blue of its pixel by less is not sent.")
        .example(clay!("vanish 0.01\nsurface Chrome, diffuse Gray20, reflective 70%\nsphere Chrome 1.5, -1 0 0\nsphere Clay 1, 1.5 0 1")),
    row("maxdepth", "how many surfaces may mirror or refract a ray, one after the other", run(Routine::Maxdepth))
        .takes(&[whole("number", 0, Settings::MAX_DEPTH, "the depth")])
        .default("5")
        .details("Light goes into a glass and out again at two surfaces, and through a hollow one at four. 0: nothing mirrors or is seen through.")
        .example(clay!("maxdepth 2\nsurface Chrome, diffuse Gray20, reflective 70%\nsphere Chrome 1.5, -1.6 0 0\nsphere Chrome 1.5, 1.6 0 0\nsphere Clay 0.6, 0 0 2")),
    row("maxmol", "largest group of soft shapes", idle("groups can have any size"))
        .takes(&[whole("number", 1, 1_000_000_000, "the number of shapes")])
        .default("300")
        .example("maxmol 300"),
    row("digger", "what finds where a ray meets the soft surface", run(Routine::Digger))
        .takes(&[
            word("name", o::DIGGER, "the digger's name"),
            whole("n", 1, Settings::MAX_SPANS, "the number of spans a shape gets from `hermite2`").optional("2"),
        ])
        .default("hermite")
        .details("Only `hermite` is certified, and it is the fastest. The others are there to compare with: they follow rays one by one, and what they miss or misplace is missing or misplaced in the picture.")
        .example(flesh!("digger hermite2 4\nsphere Flesh 0.6, -0.6 0 0\nsphere Flesh 0.6, 0.6 0 0")),
    row("contrast", "contrast above which a pixel is sampled further", run(Routine::Contrast))
        .takes(&[colour("r g b", "the contrast")])
        .default(".25 .2 .4")
        .example(clay!("contrast 0.1 0.1 0.1\nsample 4\nsphere Clay 2, 0 0 0")),
    row("pack", "how shapes are sorted", idle(PACKING))
        .takes(&[word("what", o::PACK, "`none` or `grid`")])
        .default("grid")
        .example("pack none"),
    row("indicator", "how progress is shown", idle(REPORTS))
        .takes(&[word("what", o::INDICATOR, "what to show, such as `bar`").many()])
        .default("bar")
        .example("indicator bar"),
    row("fragile", "soft shapes whose own radius is overruled by their material's", run(Routine::Fragile))
        .takes(&[FRAGILE])
        .default("none")
        .example(flesh!("fragile all\nsphere Flesh 2, -0.6 0 0\nsphere Flesh 0.1, 0.6 0 0")),
    row("sample", "at most n×n rays a pixel", run(Routine::Sample))
        .takes(&[
            whole("n", 1, Settings::MAX_SAMPLES, "the number of samples"),
            parameter("method", Kind::Text, "the method").optional(""),
        ])
        .default("1")
        .details("The first ray of each pixel makes a whole picture; more follow where neighbours differ (see `contrast`), and everywhere where a lens, the shutter, a light's size or the sky ask for many; if they do, n is 4 unless it is given.")
        .example(clay!("sample 4\nsphere Clay 2, 0 0 0")),
    row("mesh", "triangles of a file (ours), or how polygons are checked", run(Routine::Mesh))
        .takes(&[
            parameter("sn", Kind::Known(Names::Material), "the material's name"),
            parameter("fn", Kind::File, "the mesh's name"),
        ])
        .options(o::METABALLS)
        .default("robust")
        .details("`mesh sn file.obj` draws the triangles of a file of the project: OBJ, PLY, STL or GLB (`gem.obj` is built in). A text of the project with the ending `.strokes` is a mesh, too, made by strokes of tools (Sculpt writes them). Where the mesh has colours (of vertices), or is painted, they are multiplied with the material's diffuse and ambient. Soft: each triangle is a skeleton. \
            `mesh sn file.obj metaballs triangular d0 k` makes a soft surface of any material around the mesh: a shell of the thickness d0 on both sides of each facet, \
            the sharper the larger k; `metaballs spherical k` makes it of balls around the facets, good for many small and even ones. k times the mean edge should be 10 or more. `mesh robust`, as RATS has it, changes nothing here: faces are always checked.")
        .example(clay!("eyep 3 4 3\nfov 30\nvup 0 0 1\nmesh Clay gem.obj")),
];
