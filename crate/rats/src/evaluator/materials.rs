//! `surface` and its synonym `material`.

use super::palette::{Colours, Surface};
use super::state::{Evaluator, Flow};
use super::textures::LAYERS;
use crate::Severity;
use crate::commands::build::{Form, options, row, takes, word_of};
use crate::commands::slot::{Named, Placed, Word, colour, copy, length, new, number, share, word};
use crate::commands::{CommandSpec, Names, OptionSpec};
use crate::given::Options;
use crate::operands::Share;
use crate::problem::{Outcome, Problem};
use crate::reader::Name;
use crate::syntax::Command;
use field::Kernel;
use scene::{Finish, Flesh, Rgb};

/// The kernels: how a skeleton's flesh fades with distance (fields.md §1).
const KERNELS: &[OptionSpec] = &{
    let mut words = [const { word_of("", "") }; Kernel::ALL.len()];
    let mut i = 0;
    while i < words.len() {
        words[i] = word_of(Kernel::ALL[i].name(), Kernel::ALL[i].meaning());
        i += 1;
    }
    words
};

/// Rays that `skip` names.
const RAYS: &[OptionSpec] = &[
    word_of("pixel", "rays from the eye"),
    word_of("shadow", "rays to the lights"),
    word_of("reflected", "mirrored rays"),
    word_of("transmitted", "rays let through"),
];

options! {
    /// Options of `surface` and `material`.
    SURFACE_OPTIONS:
    BODY: Rgb = ("body", "as diffuse", "main colour, of which `N%` are taken",
        colour("RGB", "the body's colour"));
    AMBIENT: Share = ("ambient", "15% of diffuse", "light given off", share("the ambient colour"));
    DIFFUSE: Share = ("diffuse", "as body", "light scattered evenly", share("the diffuse colour"));
    SPECULAR: Share = ("specular", "0 0 0", "colour of the highlight",
        share("the specular colour"));
    REFLECTIVE: Share = ("reflective", "0 0 0", "light reflected as by a mirror",
        share("the share of light mirrored"));
    TRANSPARENT: Share = ("transparent", "0 0 0", "light let through",
        share("the share of light let through"));
    INDEX: f64 = ("index", "1", "index of refraction",
        number("k", "the index of refraction").from(0.01, 100.0));
    DISPERSION: f64 = ("dispersion", "0", "how the index varies with colour",
        number("d", "the dispersion").from(0.0, 100.0));
    SHINE: f64 = ("shine", "0", "Phong's exponent: the larger, the smaller the highlight",
        number("p", "the shine").from(0.0, 1e6));
    RADIUS: (Placed<f64>, Option<f64>) = ("radius", "0",
        "radius in isolation of soft shapes; a second one at the other \
         end of lines, arcs, curves (ours)",
        length("r", "the radius").at_least(0.0).with_place(),
        length("end", "the radius at the other end").at_least(0.0).optional(""));
    BLOBBINESS: (f64, Option<Placed<f64>>) = ("blobbiness", "0",
        "softness: negative; near 0 is blobby, far from 0 crisp; 0 is hard; \
         a second one at the other end (ours)",
        number("b", "the blobbiness"),
        number("end", "the blobbiness at the other end").with_place().optional(""));
    DEPTH: f64 = ("depth", "0", "depth of influence, from which the radius follows (ours)",
        length("d", "the depth").at_least(0.0));
    STRENGTH: f64 = ("strength", "1", "multiplies the field; negative carves",
        number("s", "the strength"));
    RESTRICTION: f64 = ("restriction", "0",
        "share of a triangle's field taken away at its edges: 1 creases a mesh (ours)",
        number("f", "the restriction").from(0.0, 1.0));
    SKIP: Vec<Word> = ("skip", "", "rays that do not see it",
        word("RAYTYPE", RAYS, "`pixel`, `shadow`, `reflected` or `transmitted`").many());
    TEXTURE: Vec<Named> = ("texture", "", "layers of textures", LAYERS);
    KERNEL: Word = ("kernel", "the command's own: cauchy, or as it says",
        "the kernel of soft shapes (ours)",
        word("name", KERNELS, "the kernel's name"));
    EXACT: () = ("exact", "", "short bones stand at their radius, too, and so do tips (ours)");
}

/// `surface`, `material`.
const FORM: Form = takes!(
    surface,
    [SURFACE_OPTIONS],
    new("alias", Names::Material, "the material's name"),
    copy("= old", Names::Material, "the name of the old material").optional(""),
);

/// `surface { alias option … }`, `surface new = old`
///
/// Of our own: `surface new = old option …` changes some fields of the copy.
pub static SURFACE: CommandSpec = row("surface", "make a material")
    .with(FORM)
    .mark_failed(insert_broken)
    .details(
        "All fields are optional; braces around them let them run over several lines. A material \
         with a blobbiness is soft: its shapes are skeletons, and their flesh melts together; all \
         fields are mixed where two materials meet, the index and the shine too. A colour is a \
         name, three numbers or N%: of the body's colour for `ambient` and `diffuse`, of the \
         light that comes for `specular`, `reflective` and `transparent`. Light that goes into a \
         transparent material is bent by its `index`: glass 1.5, water 1.33, diamond 2.42; it \
         colours the shadow. `dispersion` is how much larger the index is for blue than for red. \
         The flesh of a bone that is short for its blobbiness is thinner than its radius, as many \
         short ones make a long one; `exact` makes up for that: bones that are joined end to end, \
         and triangles, count as one, and a factor on their field and longer free ends let its \
         middle and its tips stand at the radius where nothing else is near. \
         `surface new = old` copies a material; options behind it change the copy (ours).",
    )
    .example(
        "light White, position 4 8 10\nbackground SteelBlue to White to SaddleBrown\n\
         surface { Red, body OrangeRed\n  specular 50%, shine 40\n  radius 0.8, blobbiness -1 }\n\
         surface Blue = Red, diffuse RoyalBlue\nsurface Glass, diffuse Black, transparent 90%, \
         reflective 10%, index 1.5, specular White, shine 200\nsphere Red 1, -1 0 0\n\
         sphere Blue 1, 1 0 0\nsphere Glass 0.8, 0 -1 3",
    );

fn surface<'a>(
    run: &mut Evaluator<'a>,
    command: &'a Command,
    options: &Options<'a>,
    name: Name<'a>,
    old: Option<Name<'a>>,
) -> Outcome<Flow> {
    run.scope.step(8, &command.word_span)?;
    let radius = options.last(&RADIUS).map(|(radius, _)| radius);
    let has_depth = options.last(&DEPTH).is_some_and(|depth| depth > 0.0);
    run.watch_material(&name, old.as_ref(), radius, has_depth);
    let mut surface = match &old {
        Some(old) => {
            let index = run.material(old)?;
            let old = &mut run.palette.surfaces[index];
            old.copied = true;
            old.clone()
        }
        None => Surface {
            finish: Finish::default(),
            flesh: Flesh::default(),
            has_strength: false,
            pattern: None,
            exact: false,
            colours: Colours::default(),
            origin: (0, 0..0),
            used: false,
            shown: false,
            copied: false,
        },
    };
    (surface.used, surface.shown, surface.copied) = (false, false, false);
    surface.origin = (run.file, name.span.clone());
    set_flesh(options, &mut surface.flesh)?;
    surface.exact |= options.has(&EXACT);
    surface.has_strength |= options.last(&STRENGTH).is_some();
    set_finish(options, &mut surface.finish, &mut surface.colours);
    // A skeleton is soft without a blobbiness; it needs a radius.
    if let Some(chosen) = options.find(&KERNEL)
        && !surface.flesh.is_soft()
        && surface.flesh.radius <= 0.0
    {
        let message = "without a blobbiness this material is hard, and its kernel does nothing";
        run.note(&chosen.span, message, "add a `blobbiness`, such as -1");
    }
    surface.finish.name = name.text.to_owned();
    let textures: Vec<Name<'a>> = options.all(&TEXTURE).flatten().collect();
    if !textures.is_empty() {
        let texture = run.palette.layers(&textures)?;
        surface.finish.layers = texture.layers;
        surface.flesh.profile = texture.profile;
        surface.pattern = texture.pattern;
    }
    if let Some(earlier) = run.palette.idle_place(name.text).cloned() {
        run.say_made_twice(Severity::Warning, &name, earlier, || {
            format!(
                "nothing was made of the `{0}` above: this `{0}` takes its place",
                name.text
            )
        });
    }
    if run.palette.keeps_old(&name, &surface) && !run.model.parts.is_empty() {
        let message = format_args!("shapes made before this keep the old `{}`", name.text);
        let hint = "what is soft, hard or tapers stays so: make them again, behind `reset data`";
        run.warn(&name.span, message, hint);
    }
    run.palette.insert(&name, surface)?;
    Ok(Flow::Next)
}

/// Keeps the name of a material that could not be made.
fn insert_broken<'a>(run: &mut Evaluator<'a>, command: &'a Command) {
    if let Ok(name) = run.reader(command).new_name("the material's name") {
        run.palette.insert_broken(name.text);
    }
}

/// Replaces a field by a value, if one was given.
fn set<T>(field: &mut T, given: Option<T>) {
    if let Some(value) = given {
        *field = value;
    }
}

fn set_flesh(options: &Options<'_>, flesh: &mut Flesh) -> Outcome<()> {
    if let Some(((radius, _), end)) = options.last(&RADIUS) {
        (flesh.radius, flesh.end_radius) = (radius, end);
    }
    for (blobbiness, end) in options.all(&BLOBBINESS) {
        // The published datasets write it negative; only its magnitude counts.
        flesh.blobbiness = (blobbiness != 0.0).then(|| blobbiness.abs());
        flesh.end_blobbiness = None;
        if let Some((at_end, span)) = end {
            flesh.end_blobbiness = Some(at_end.abs());
            if at_end == 0.0 || blobbiness == 0.0 {
                return Err(Problem::new(
                    &span,
                    "a blobbiness that varies must not be 0 at an end",
                )
                .hint("0 makes a material hard; near 0 is blobby, far from 0 crisp"));
            }
        }
    }
    set(&mut flesh.restriction, options.last(&RESTRICTION));
    set(&mut flesh.depth, options.last(&DEPTH));
    set(&mut flesh.strength, options.last(&STRENGTH));
    set(&mut flesh.kernel, options.last(&KERNEL).map(Kernel::named));
    Ok(())
}

fn set_finish(options: &Options<'_>, finish: &mut Finish, colours: &mut Colours) {
    set(&mut colours.body, options.last(&BODY).map(Some));
    set(&mut colours.ambient, options.last(&AMBIENT).map(Some));
    set(&mut colours.diffuse, options.last(&DIFFUSE).map(Some));
    settle_colours(finish, colours);
    set(&mut finish.specular, options.last(&SPECULAR).map(of_light));
    set(
        &mut finish.reflective,
        options.last(&REFLECTIVE).map(of_light),
    );
    set(
        &mut finish.transparent,
        options.last(&TRANSPARENT).map(of_light),
    );
    set(&mut finish.index, options.last(&INDEX).map(|k| k as f32));
    set(
        &mut finish.dispersion,
        options.last(&DISPERSION).map(|d| d as f32),
    );
    set(&mut finish.shine, options.last(&SHINE).map(|p| p as f32));
    for ray in options.all(&SKIP).flatten() {
        match ray {
            "pixel" => finish.skip.pixel = true,
            "shadow" => finish.skip.shadow = true,
            "reflected" => finish.skip.reflected = true,
            _ => finish.skip.transmitted = true,
        }
    }
}

/// The colours that follow from those the text gives.
fn settle_colours(finish: &mut Finish, colours: &Colours) {
    let own = Finish::default();
    let body = colours.body.unwrap_or(match colours.diffuse {
        Some(Share::Colour(colour)) => colour,
        _ => own.diffuse,
    });
    finish.diffuse = match colours.diffuse {
        Some(Share::Colour(colour)) => colour,
        Some(Share::Percent(share)) => scale(body, share),
        None => body,
    };
    finish.ambient = match colours.ambient {
        Some(Share::Colour(colour)) => colour,
        Some(Share::Percent(share)) => scale(body, share),
        None => scale(finish.diffuse, Finish::AMBIENT_SHARE),
    };
}

/// Scales a colour.
fn scale(colour: Rgb, share: f32) -> Rgb {
    colour.map(|c| c * share)
}

/// A colour, or a share of the light that comes.
fn of_light(share: Share) -> Rgb {
    match share {
        Share::Colour(colour) => colour,
        Share::Percent(share) => [share; 3],
    }
}

impl Evaluator<'_> {
    /// Notes unused materials, unless an error may be the reason.
    pub(super) fn note_unused_materials(&mut self) {
        if self.report.has_errors() {
            return;
        }
        let unused: Vec<_> = self
            .palette
            .idle_surfaces()
            .map(|surface| (surface.origin.clone(), surface.finish.name.clone()))
            .collect();
        for ((file, span), name) in unused {
            self.file = file;
            self.note(&span, format_args!("nothing is made of `{name}`"), "");
        }
    }
}

pub static MATERIAL: CommandSpec = row("material", "the same as surface")
    .with(FORM)
    .mark_failed(insert_broken)
    .example(
        "light White, position 4 8 10\nmaterial Gold { diffuse Gold, specular White, shine 80 }\n\
         sphere Gold 2, 0 0 0",
    );
