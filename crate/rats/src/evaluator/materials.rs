//! `surface` and its synonym `material`.

use super::palette::{Colours, Surface};
use super::state::{Evaluator, Flow};
use crate::Severity;
use crate::given::Chosen;
use crate::operands::Share;
use crate::problem::{Outcome, Problem};
use crate::reader::Name;
use crate::syntax::Command;
use field::Kernel;
use scene::{Finish, Flesh, Rgb};

/// `surface { alias option … }`, `surface new = old`
///
/// Of our own: `surface new = old option …` changes some fields of the copy.
pub fn surface<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    run.scope.step(8, &command.word_span)?;
    let name = run.reader(command).new_name("the material's name")?;
    make(run, command).inspect_err(|_| run.palette.insert_broken(name.text))?;
    Ok(Flow::Next)
}

fn make<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<()> {
    let given = run.given(command)?;
    let name = given.name("alias").clone();
    let old = given.maybe_name("= old").cloned();
    run.watch_material(&name, old.as_ref(), &given);
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
            colours: Colours::default(),
            origin: (0, 0..0),
            used: false,
            copied: false,
        },
    };
    (surface.used, surface.copied) = (false, false);
    surface.origin = (run.file, name.span.clone());
    let mut textures = Vec::new();
    for chosen in given.options {
        field(chosen, &mut surface, &mut textures)?;
    }
    settle_colours(&mut surface.finish, &surface.colours);
    surface.finish.name = name.text.to_owned();
    if !textures.is_empty() {
        let texture = run.palette.layers(&textures)?;
        surface.finish.layers = texture.layers;
        surface.flesh.profile = texture.profile;
    }
    if let Some(earlier) = run.palette.idle(name.text).cloned() {
        run.say_made_twice(Severity::Warning, &name, earlier, || {
            format!(
                "nothing was made of the `{0}` above: this `{0}` takes its place",
                name.text
            )
        });
    }
    run.palette.insert(&name, surface)
}

fn field<'a>(
    chosen: Chosen<'a>,
    surface: &mut Surface,
    textures: &mut Vec<Name<'a>>,
) -> Outcome<()> {
    let Chosen { name, span, given } = chosen;
    let flesh = &mut surface.flesh;
    let finish = &mut surface.finish;
    match name {
        "body" => surface.colours.body = Some(given.colour("RGB")),
        "ambient" => surface.colours.ambient = Some(given.share()),
        "diffuse" => surface.colours.diffuse = Some(given.share()),
        "specular" => finish.specular = of_light(given.share()),
        "reflective" => finish.reflective = of_light(given.share()),
        "transparent" => finish.transparent = of_light(given.share()),
        "index" => finish.index = given.number("k") as f32,
        "dispersion" => finish.dispersion = given.number("d") as f32,
        "shine" => finish.shine = given.number("p") as f32,
        "radius" => {
            flesh.radius = given.number("r");
            flesh.end_radius = given.maybe_number("end");
        }
        "blobbiness" => {
            flesh.blobbiness = given.number("b");
            flesh.end_blobbiness = given.maybe_number("end");
            if flesh.end_blobbiness == Some(0.0)
                || flesh.end_blobbiness.is_some() && flesh.blobbiness == 0.0
            {
                return Err(Problem::new(
                    given.span("end").unwrap_or(span),
                    "a blobbiness that varies must not be 0 at an end",
                )
                .hint("0 makes a material hard; near 0 is blobby, far from 0 crisp"));
            }
        }
        "restriction" => flesh.restriction = given.number("f"),
        "depth" => flesh.depth = given.number("d"),
        "strength" => flesh.strength = given.number("s"),
        "skip" => {
            for (ray, _) in given.words("RAYTYPE") {
                match ray {
                    "pixel" => finish.skip.pixel = true,
                    "shadow" => finish.skip.shadow = true,
                    "reflected" => finish.skip.reflected = true,
                    _ => finish.skip.transmitted = true,
                }
            }
        }
        "texture" => textures.extend(given.names("t1 +")),
        _ => flesh.kernel = given.word("name").and_then(Kernel::named),
    }
    Ok(())
}

/// The colours that follow from those the text gives.
fn settle_colours(finish: &mut Finish, colours: &Colours) {
    let scaled = |colour: Rgb, share: f32| colour.map(|c| c * share);
    let own = Finish::default();
    let body = colours.body.unwrap_or(match colours.diffuse {
        Some(Share::Colour(colour)) => colour,
        _ => own.diffuse,
    });
    finish.diffuse = match colours.diffuse {
        Some(Share::Colour(colour)) => colour,
        Some(Share::Percent(share)) => scaled(body, share),
        None => body,
    };
    finish.ambient = match colours.ambient {
        Some(Share::Colour(colour)) => colour,
        Some(Share::Percent(share)) => scaled(body, share),
        None => scaled(finish.diffuse, Finish::AMBIENT_SHARE),
    };
}

/// A colour, or a share of the light that comes.
fn of_light(share: Share) -> Rgb {
    match share {
        Share::Colour(colour) => colour,
        Share::Percent(share) => [share; 3],
    }
}

impl Evaluator<'_> {
    /// Notes the materials that nothing is made of, unless the reason may be an error.
    pub(super) fn note_unused_materials(&mut self) {
        if self.report.has_errors() {
            return;
        }
        let unused: Vec<_> = self
            .palette
            .unused()
            .map(|surface| (surface.origin.clone(), surface.finish.name.clone()))
            .collect();
        for ((file, span), name) in unused {
            self.file = file;
            self.say(Severity::Note, span, || {
                (format!("nothing is made of `{name}`"), None)
            });
        }
    }
}
