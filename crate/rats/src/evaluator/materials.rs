//! `surface` and its synonym `material`.

use super::palette::Surface;
use super::{Evaluator, Flow};
use crate::Severity;
use crate::given::Chosen;
use crate::operands::Share;
use crate::problem::{Outcome, Problem};
use crate::reader::Name;
use crate::syntax::Command;
use field::Kernel;
use scene::{Material, Rgb};
use std::ops::Range;

/// `surface { alias option … }`, `surface new = old`
///
/// Of our own: `surface new = old option …` changes some fields of the copy.
pub fn surface<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    run.scope.step(8, &command.word_span)?;
    let name = run.reader(command).name("the material's name")?;
    make(run, command).inspect_err(|_| run.palette.insert_broken(name.text))?;
    Ok(Flow::Next)
}

/// The fields as the text gives them; per cents refer to fields that may come later.
#[derive(Debug, Default)]
struct Fields<'a> {
    body: Option<Rgb>,
    ambient: Option<Share>,
    diffuse: Option<Share>,
    specular: Option<Share>,
    textures: Vec<Name<'a>>,
    not_drawn: Vec<(&'static str, Range<usize>)>,
}

fn make<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<()> {
    let given = run.given(command)?;
    let name = given.name("alias").clone();
    let old = given.maybe_name("= old").cloned();
    run.watch_material(&name, old.as_ref(), &given);
    let mut surface = match &old {
        Some(old) => run.palette.surfaces[run.material(old)?].clone(),
        None => Surface {
            material: Material::default(),
            origin: (0, 0..0),
            used: false,
        },
    };
    surface.used = false;
    surface.origin = (run.file, name.span.clone());
    let mut fields = Fields::default();
    for chosen in given.options {
        field(chosen, &mut surface, &mut fields)?;
    }
    settle_colours(&mut surface.material, &fields, old.is_some());
    surface.material.name = name.text.to_owned();
    if !fields.textures.is_empty() {
        let layers = run.palette.layers(&fields.textures)?;
        surface.material.profile = layers.profile;
    }
    for (what, span) in fields.not_drawn {
        run.say(Severity::Warning, span, || {
            (format!("`{what}` is not drawn yet"), None)
        });
    }
    run.palette.insert(&name, surface)
}

fn field<'a>(chosen: Chosen<'a>, surface: &mut Surface, fields: &mut Fields<'a>) -> Outcome<()> {
    let Chosen { name, span, given } = chosen;
    let material = &mut surface.material;
    match name {
        "body" => fields.body = Some(given.colour("RGB")),
        "ambient" => fields.ambient = Some(given.share()),
        "diffuse" => fields.diffuse = Some(given.share()),
        "specular" => fields.specular = Some(given.share()),
        "reflective" | "transparent" => {
            if !matches!(
                given.share(),
                Share::Percent(0.0) | Share::Colour([0.0, 0.0, 0.0])
            ) {
                fields.not_drawn.push((name, span));
            }
        }
        // These say how light bends that is let through: without `transparent`, which warns, none is.
        "index" | "dispersion" => {}
        "shine" => material.shine = given.number("p") as f32,
        "radius" => {
            material.radius = given.number("r");
            material.end_radius = given.maybe_number("end");
        }
        "blobbiness" => {
            material.blobbiness = given.number("b");
            material.end_blobbiness = given.maybe_number("end");
            if material.end_blobbiness == Some(0.0)
                || material.end_blobbiness.is_some() && material.blobbiness == 0.0
            {
                return Err(Problem::new(
                    given.span("end").unwrap_or(span),
                    "a blobbiness that varies must not be 0 at an end",
                )
                .hint("0 makes a material hard; near 0 is blobby, far from 0 crisp"));
            }
        }
        "restriction" => material.restriction = given.number("f"),
        "depth" => material.depth = given.number("d"),
        "strength" => material.strength = given.number("s"),
        "skip" => fields.not_drawn.push((name, span)),
        "texture" => fields.textures.extend(given.names("t1 +")),
        _ => material.kernel = given.word("name").and_then(Kernel::named),
    }
    Ok(())
}

/// The colours that follow from the fields given. A copy keeps those that are not given.
fn settle_colours(material: &mut Material, fields: &Fields<'_>, is_copy: bool) {
    let scaled = |colour: Rgb, share: f32| colour.map(|c| c * share);
    let diffuse = match fields.diffuse {
        Some(Share::Colour(colour)) => Some(colour),
        Some(Share::Percent(share)) => Some(scaled(fields.body.unwrap_or(material.diffuse), share)),
        None => fields.body,
    };
    if let Some(diffuse) = diffuse {
        material.diffuse = diffuse;
    }
    let body = fields.body.unwrap_or(material.diffuse);
    material.ambient = match fields.ambient {
        Some(Share::Colour(colour)) => colour,
        Some(Share::Percent(share)) => scaled(body, share),
        None if is_copy && diffuse.is_none() => material.ambient,
        None => scaled(material.diffuse, Material::AMBIENT_SHARE),
    };
    match fields.specular {
        Some(Share::Colour(colour)) => material.specular = colour,
        Some(Share::Percent(share)) => material.specular = [share; 3],
        None => {}
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
            .map(|surface| (surface.origin.clone(), surface.material.name.clone()))
            .collect();
        for ((file, span), name) in unused {
            self.file = file;
            self.say(Severity::Note, span, || {
                (format!("nothing is made of `{name}`"), None)
            });
        }
    }
}
