//! OPTIONS: settings of the whole picture.

use super::state::{Evaluator, Flow};
use crate::commands::build::{choice, clay, flesh, idle, plain, row, sets, takes, word_of};
use crate::commands::slot::{ON_OFF, colour, new_file, number, text, whole, word};
use crate::commands::{CommandSpec, OptionSpec, Unit};
use crate::problem::{Outcome, Problem};
use crate::reader::Name;
use crate::syntax::Command;
use field::BlobScale;
use scene::{Digger, Fragile, Settings, Tone};
use std::ops::Range;

const SAVING: &str = "the picture is named and saved by whoever draws it";
const PACKING: &str = "shapes are sorted as suits them best";
const REPORTS: &str = "the page and the program report what they do";
const WINDOWS: &str = "there are no windows here";

/// `indicator`.
pub static INDICATORS: &[OptionSpec] = &[
    word_of("none", "nothing"),
    word_of("all", "all of these"),
    word_of("bar", "a bar"),
    word_of("text", "words"),
    word_of("pixel", "every pixel"),
    word_of("line", "every line"),
    word_of("ETA", "the time that is left"),
];

/// `pack`.
pub static PACKINGS: &[OptionSpec] = &[
    word_of("none", "a list"),
    choice!(
        "grid",
        "",
        "a grid of cells",
        whole("X Y Z", 1, 1024, "the cells of the grid").any()
    )
    .plain,
];

/// `echo on|off`: nothing is echoed anyway, and every published dataset says it, so nothing is
/// said.
pub static ECHO: CommandSpec = row("echo", "echo commands")
    .with(takes!(silent_switch, ON_OFF))
    .default("on")
    .example("echo off");

fn silent_switch<'a>(_: &mut Evaluator<'a>, _: &'a Command, _: bool) -> Outcome<Flow> {
    Ok(Flow::Next)
}

pub static WARNING: CommandSpec = row("warning", "show warnings")
    .with(sets!(|run, is_on| run.report.no_warnings = !is_on, ON_OFF))
    .default("on")
    .example("warning off");

pub static VERBOSE: CommandSpec = row("verbose", "show notes")
    .with(sets!(|run, is_on| run.report.no_notes = !is_on, ON_OFF))
    .default("on")
    .example("verbose off");

pub static SOFT: CommandSpec = row("soft", "blend soft shapes; off draws their offset surfaces")
    .with(sets!(|run, is_on| run.settings.soft = is_on, ON_OFF))
    .default("on")
    .example(flesh!(
        "soft off\nsphere Flesh 0.6, -0.6 0 0\nsphere Flesh 0.6, 0.6 0 0"
    ));

pub static DOUBLE: CommandSpec = row("double", "draw both sides of faces")
    .with(sets!(
        |run, is_on| run.settings.double_sided = is_on,
        ON_OFF
    ))
    .default("on")
    .details(
        "Off hides the faces of triangles, polygons, patches and meshes that are seen from \
         behind; the front of a face is the side from which its corners run counterclockwise. \
         RATS had `double` off unless a dataset said otherwise; here it is on.",
    )
    .example(clay!(
        "double off\ntriangle Clay, <-2 -1 0> <2 -1 0> <0 2 0>"
    ));

pub static GAMMA: CommandSpec = row("gamma", "gamma correction")
    .with(sets!(
        |run, value| run.settings.gamma = value as f32,
        number("value", "gamma").from(0.1, 10.0)
    ))
    .default("1")
    .example(clay!("gamma 1.8\nsphere Clay 2, 0 0 0"));

pub static FRAMESIZE: CommandSpec = row("framesize", "size of the picture")
    .with(sets!(
        |run, width, height| run.settings.frame = [width, height],
        whole("w", 1, Settings::MAX_FRAME, "the width").unit(Unit::Pixels),
        whole("h", 1, Settings::MAX_FRAME, "the height").unit(Unit::Pixels)
    ))
    .default("128 128")
    .example(clay!("framesize 320 200\nsphere Clay 2, 0 0 0"));

/// `filename name`: an ending that is a format counts as `format` too.
pub static FILENAME: CommandSpec = row("filename", "name of the saved picture")
    .with(takes!(filename, new_file("name", "the picture's name")))
    .default("scene")
    .details(
        "The program saves the picture under this name, and tools such as `collage` know it by \
         this name and its `format`: `shell.png`.",
    )
    .example("filename shell");

fn filename<'a>(run: &mut Evaluator<'a>, _: &'a Command, name: Name<'a>) -> Outcome<Flow> {
    let name = name.text;
    let format = name.rsplit_once('.').and_then(|(stem, ending)| {
        let known = FORMATS
            .iter()
            .find(|f| f.name.eq_ignore_ascii_case(ending))?;
        Some((stem, known.name))
    });
    match format {
        Some((stem, format)) => {
            run.output.name = stem.to_owned();
            run.output.format = Some(format);
        }
        None => run.output.name = name.to_owned(),
    }
    Ok(Flow::Next)
}

/// `format`.
pub static FORMATS: &[OptionSpec] = &[
    word_of("tif", "TIFF"),
    word_of("tga", "Targa"),
    word_of("mtv", "MTV: width, height and bytes"),
    word_of("png", "PNG (ours)"),
];

pub static FORMAT: CommandSpec = row("format", "format of the saved picture")
    .with(sets!(
        |run, format| run.output.format = Some(format),
        word("format", FORMATS, "a format, such as `tif`")
    ))
    .default("png")
    .details(
        "The program writes all of these; the page saves PNG whatever stands here. RATS wrote TIFF \
         unless a text said otherwise; here that is PNG.",
    )
    .example("format png");

pub static NOSAVE: CommandSpec = row("nosave", "do not save the picture")
    .with(sets!(|run, is_on| run.output.saved = !is_on, ON_OFF))
    .default("off")
    .details(
        "The program that runs the dataset then neither traces nor writes the picture, unless it \
         is told a name for it with `-o`. In the page, tools do not find the picture among the \
         files; you can still save it by hand.",
    )
    .example("nosave on");

/// `sample`.
pub static METHODS: &[OptionSpec] = &[word_of(
    "adaptive",
    "more rays where neighbours differ, which is always so",
)];

pub static SAMPLE: CommandSpec = row("sample", "at most n×n rays a pixel")
    .with(takes!(
        sample,
        word("adaptive", METHODS, "`adaptive`").optional(""),
        number("n", "the number of samples")
            .from(
                1.0 / Settings::MAX_BLOCK as f64,
                Settings::MAX_SAMPLES as f64
            )
            .with_place()
            .optional("4 if adaptive"),
        text("method", "the method").optional("")
    ))
    .default("1")
    .details(
        "The first ray of each pixel makes a whole picture; more follow where neighbours differ \
         (see `contrast`), and everywhere where a lens, the shutter, a light's size or the sky \
         ask for many; if they do, n is 4 unless it is given. Below 1 there are fewer rays than \
         pixels: 0.5 sends one for a block of 2×2, 0.25 for 4×4, down to 1/16; other numbers \
         count as the nearest of these.",
    )
    .example(clay!("sample 4\nsphere Clay 2, 0 0 0"));

/// Rays across and down a pixel of `sample adaptive` without a number.
const ADAPTIVE: f64 = 4.0;

fn sample<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    adaptive: Option<&'static str>,
    number: Option<(f64, Range<usize>)>,
    method: Option<Range<usize>>,
) -> Outcome<Flow> {
    let (n, span) = match (number, adaptive) {
        (Some(number), _) => number,
        (None, Some(_)) => (ADAPTIVE, command.span.clone()),
        (None, None) => {
            return Err(Problem::new(
                &command.span,
                "`sample` takes the number of samples, or `adaptive`",
            )
            .hint("write `sample 4`"));
        }
    };
    if n >= 1.0 && n.fract() != 0.0 {
        return Err(Problem::new(
            &span,
            format!("the number of samples must be a whole number, or below 1, not {n}"),
        ));
    }
    run.settings.samples = n.max(1.0) as u32;
    // The nearest power of 2, in the logarithm.
    run.settings.block = 1 << libm::round(libm::log2((1.0 / n).max(1.0))) as u32;
    run.sampled = true;
    let text = run.sources.all[run.file].text;
    if let Some(span) = method
        && !text[span.clone()]
            .trim()
            .eq_ignore_ascii_case(METHODS[0].name)
    {
        let message = "the method changes nothing here: there is one, which sends more rays \
                       where neighbours differ";
        run.note(&span, message, "");
    }
    Ok(Flow::Next)
}

pub static PENUMBRA: CommandSpec = row("penumbra", "soft shadows")
    .with(sets!(|run, is_on| run.settings.penumbra = is_on, ON_OFF))
    .default("off")
    .details(
        "Shadows of lights that have a `size` get soft edges: a place gets the share of the light \
         that it sees. More samples (`sample`) make them smoother.",
    )
    .example(
        "surface Clay, diffuse SandyBrown, specular Gray50, shine 40\npenumbra on\nsample 3\n\
         ground Gray80\neyep 0 4 9\nlight White, position 5 9 4, size 1.5\nsphere Clay 1.5, 0 0 0",
    );

pub static EPSILON: CommandSpec = row(
    "epsilon",
    "how far mirrored and refracted rays start from hard surfaces",
)
.with(sets!(
    |run, value| run.settings.epsilon = value,
    number("value", "the precision").from(1e-12, 0.1)
))
.default("1e-4")
.details(
    "A share of the scene's size. Rays from soft surfaces start as near as their own error allows.",
)
.example(clay!(
    "epsilon 1e-4\nsurface Chrome, diffuse Gray20, reflective 70%\nsphere Chrome 1.5, -1 0 0\n\
     sphere Clay 1, 1.5 0 1"
));

pub static VANISH: CommandSpec = row(
    "vanish",
    "least share of light that a mirrored or refracted ray must bring",
)
.with(sets!(
    |run, value| run.settings.vanish = value as f32,
    number("value", "the least colour").from(0.0, 1.0)
))
.default("4e-3")
.details("A ray that would change each of red, green and blue of its pixel by less is not sent.")
.example(clay!(
    "vanish 0.01\nsurface Chrome, diffuse Gray20, reflective 70%\nsphere Chrome 1.5, -1 0 0\n\
     sphere Clay 1, 1.5 0 1"
));

pub static MAXDEPTH: CommandSpec = row(
    "maxdepth",
    "how many surfaces may mirror or refract a ray, one after the other",
)
.with(sets!(
    |run, number| run.settings.max_depth = number,
    whole("number", 0, Settings::MAX_DEPTH, "the depth")
))
.default("5")
.details(
    "Light goes into a glass and out again at two surfaces, and through a hollow one at four. 0: \
     nothing mirrors or is seen through.",
)
.example(clay!(
    "maxdepth 2\nsurface Chrome, diffuse Gray20, reflective 70%\nsphere Chrome 1.5, -1.6 0 0\n\
     sphere Chrome 1.5, 1.6 0 0\nsphere Clay 0.6, 0 0 2"
));

/// `tone`.
pub static TONES: &[OptionSpec] = &[
    word_of("none", "what is brighter than the screen is cut"),
    word_of("filmic", "bright light fades softly into white, as on film"),
];

pub static TONE: CommandSpec = row("tone", "how bright light becomes colours of the screen")
    .with(sets!(
        |run, what| run.settings.tone = if what == "filmic" {
            Tone::Filmic
        } else {
            Tone::None
        },
        word("what", TONES, "`none` or `filmic`")
    ))
    .default("none")
    .details(
        "Filmic: light up to 0.6 stays as it is; above that 0.6 + 0.4·t/(1 + t), where t = (x − \
         0.6)/0.4, so that what glares keeps its form.",
    )
    .example(clay!(
        "tone filmic\nlight White, position -4 8 10, intensity 1.5\nsphere Clay 2, 0 0 0"
    ));

pub static CONTRAST: CommandSpec = row(
    "contrast",
    "contrast above which a pixel is sampled further",
)
.with(sets!(
    |run, contrast| run.settings.contrast = contrast,
    colour("r g b", "the contrast")
))
.default(".25 .2 .4")
.example(clay!(
    "contrast 0.1 0.1 0.1\nsample 4\nsphere Clay 2, 0 0 0"
));

/// `fragile`.
pub static FRAGILE_WORDS: &[OptionSpec] = &[
    word_of("all", "all of these"),
    word_of("arc", "arcs and arches"),
    word_of("pipe", "pipes"),
    word_of("cylinder", "cylinders"),
    word_of("sphere", "spheres"),
    word_of("none", "none of these"),
];

/// `fragile all|none|arc|…`: what it names, and nothing else.
pub static FRAGILE: CommandSpec = row(
    "fragile",
    "soft shapes whose own radius is overruled by their material's",
)
.with(takes!(
    fragile,
    word(
        "what",
        FRAGILE_WORDS,
        "`all`, `none` or the names of primitives"
    )
    .many()
))
.default("none")
.example(flesh!(
    "fragile all\nsphere Flesh 2, -0.6 0 0\nsphere Flesh 0.1, 0.6 0 0"
));

fn fragile<'a>(run: &mut Evaluator<'a>, _: &'a Command, what: Vec<&'static str>) -> Outcome<Flow> {
    let mut fragile = Fragile::default();
    for name in what {
        match name {
            "all" => fragile = Fragile::ALL,
            "none" => fragile = Fragile::default(),
            "arc" => fragile.arc = true,
            "pipe" => fragile.pipe = true,
            "cylinder" => fragile.cylinder = true,
            _ => fragile.sphere = true,
        }
    }
    run.settings.fragile = fragile;
    Ok(Flow::Next)
}

/// `blobscale`.
pub static BLOB_SCALES: &[OptionSpec] = &[
    word_of("relative", "the width is |B|/R²"),
    word_of("absolute", "the width is |B|"),
];

pub static BLOBSCALE: CommandSpec = row("blobscale", "how blobbiness is read")
    .with(takes!(
        blobscale,
        word("what", BLOB_SCALES, "`relative` or `absolute`")
    ))
    .default("relative")
    .details(
        "relative: a² = |B|/R²; absolute: a² = |B|, as the published datasets read. A text whose \
         radii and blobbiness go together as |B|·R² ≈ const is asked which of them it means.",
    )
    .example(flesh!("blobscale absolute\nsphere Flesh 0.6, 0 0 0"));

fn blobscale<'a>(run: &mut Evaluator<'a>, _: &'a Command, what: &'static str) -> Outcome<Flow> {
    run.settings.blob_scale = match what {
        "absolute" => BlobScale::Absolute,
        _ => BlobScale::Relative,
    };
    run.scaled = true;
    Ok(Flow::Next)
}

pub static INFLUENCE: CommandSpec = row(
    "influence",
    "share of the threshold below which the draft ignores a soft shape",
)
.with(sets!(
    |run, e| run.settings.influence = e,
    number("e", "the share of the threshold").from(1e-9, 0.5)
))
.default("0.001")
.details(
    "Counts for the draft and for every digger but hermite: traced pictures ignore nothing that \
     could be seen.",
)
.example(flesh!("influence 1e-4\nsphere Flesh 0.6, 0 0 0"));

/// `digger`.
pub static DIGGERS: &[OptionSpec] = &[
    word_of(
        "hermite",
        "Hermite spans as short as a certified bound of their error demands; packets of rays",
    ),
    word_of(
        "hermite2",
        "equally long Hermite spans on each shape's part of the ray, two as published",
    ),
    word_of("lagrange", "polynomials of degree 4 through samples"),
    word_of("brent", "steps to a change of sign, then Brent's method"),
    word_of("ridder", "steps to a change of sign, then Ridders' method"),
    word_of("RF", "steps to a change of sign, then the regula falsi"),
    word_of(
        "LG",
        "halving until Lipschitz constants settle it (Kalra and Barr)",
    ),
    word_of("sphere", "sphere tracing (Hart)"),
];

pub static DIGGER: CommandSpec = row("digger", "what finds where a ray meets the soft surface")
    .with(takes!(
        digger,
        word("name", DIGGERS, "the digger's name"),
        whole(
            "n",
            1,
            Settings::MAX_SPANS,
            "the number of spans a shape gets from `hermite2`"
        )
        .with_place()
        .optional("2")
    ))
    .default("hermite")
    .details(
        "Only `hermite` is certified, and it is the fastest. The others are there to compare \
         with: they follow rays one by one, and what they miss or misplace is missing or \
         misplaced in the picture.",
    )
    .example(flesh!(
        "digger hermite2 4\nsphere Flesh 0.6, -0.6 0 0\nsphere Flesh 0.6, 0.6 0 0"
    ));

fn digger<'a>(
    run: &mut Evaluator<'a>,
    _: &'a Command,
    name: &'static str,
    spans: Option<(u32, Range<usize>)>,
) -> Outcome<Flow> {
    run.settings.digger = match name {
        "hermite2" => Digger::Spans(spans.as_ref().map_or(2, |(n, _)| *n)),
        "lagrange" => Digger::Lagrange,
        "brent" => Digger::Brent,
        "ridder" => Digger::Ridder,
        "RF" => Digger::RegulaFalsi,
        "LG" => Digger::Lg,
        "sphere" => Digger::Sphere,
        _ => Digger::Hermite,
    };
    if let Some((_, span)) = spans
        && !matches!(run.settings.digger, Digger::Spans(_))
    {
        run.warn(
            &span,
            "only `hermite2` has a number of spans",
            "leave the number out",
        );
    }
    Ok(Flow::Next)
}

pub static MAP: CommandSpec = row("map", "show what each pixel costs instead of its colour")
    .with(sets!(
        |run, is_on, gamma| {
            run.settings.map = is_on.then_some(gamma.unwrap_or(1.0) as f32);
        },
        ON_OFF,
        number("N", "the gamma of the map")
            .from(0.1, 10.0)
            .optional("1")
    ))
    .default("off")
    .details(
        "Black is no work, white the dearest pixel of a sample (a packet of rays in every 16×16 \
         pixels); N above 1 lifts what is dark. Work is counted, not timed, so that a map is the \
         same everywhere: an evaluation of one shape's field at one point counts 1, and so does \
         each ray to the eye or to a light. Rays of a packet share the work that is done for all \
         of them, and a pixel shows the mean of its rays.",
    )
    .example(flesh!(
        "map on 1.5\nsphere Flesh 0.6, -0.6 0 0\nsphere Flesh 0.6, 0.6 0 0"
    ));

pub static BOUNDS: CommandSpec = row("bounds", "use bounding volumes")
    .with(idle(PACKING, plain![ON_OFF]))
    .default("on")
    .example("bounds on");

pub static TIMER: CommandSpec = row("timer", "report times")
    .with(idle(REPORTS, plain![ON_OFF]))
    .default("on")
    .example("timer on");

pub static DITHER: CommandSpec = row("dither", "dither pictures for viewing")
    .with(idle("screens show all colours now", plain![ON_OFF]))
    .default("on")
    .example("dither on");

pub static COMPRESS: CommandSpec = row("compress", "compress saved pictures")
    .with(idle(SAVING, plain![ON_OFF]))
    .default("on")
    .example("compress on");

pub static STAT: CommandSpec = row("stat", "report statistics")
    .with(idle(REPORTS, plain![ON_OFF]))
    .default("off")
    .example("stat on");

pub static NOVIEW: CommandSpec = row("noview", "do not display the picture")
    .with(idle(WINDOWS, plain![ON_OFF]))
    .default("off")
    .example("noview on");

pub static MAXMOL: CommandSpec = row("maxmol", "largest group of soft shapes")
    .with(idle(
        "groups can have any size",
        plain![whole("number", 1, 1_000_000_000, "the number of shapes")],
    ))
    .default("300")
    .example("maxmol 300");

pub static PACK: CommandSpec = row("pack", "how shapes are sorted")
    .with(idle(
        PACKING,
        plain![word("what", PACKINGS, "`none` or `grid`")],
    ))
    .default("grid")
    .example("pack none");

pub static INDICATOR: CommandSpec = row("indicator", "how progress is shown")
    .with(idle(
        REPORTS,
        plain![word("what", INDICATORS, "what to show, such as `bar`").many()],
    ))
    .default("bar")
    .example("indicator bar");
