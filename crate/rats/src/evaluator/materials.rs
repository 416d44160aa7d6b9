//! `surface` and its synonym `material`.

use super::palette::Surface;
use super::{Evaluator, Flow};
use crate::Severity;
use crate::commands::options::{RAYS, SURFACE};
use crate::limits::MAX_MAGNITUDE;
use crate::operands::Share;
use crate::problem::{Outcome, Problem};
use crate::reader::{Name, Reader};
use crate::suggest;
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
    let mut read = run.reader(command);
    let name = read.name("the material's name")?;
    let old = if read.sign(b'=') {
        Some(read.name("the name of the old material")?)
    } else {
        None
    };
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
    let mut read = run.reader(command);
    read.name("the material's name")?;
    if read.sign(b'=') {
        read.name("the name of the old material")?;
    }
    let mut fields = Fields::default();
    while let Some((option, span)) = read.option(SURFACE)? {
        field(&mut read, option.name, span, &mut surface, &mut fields)?;
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

fn field<'a>(
    read: &mut Reader<'_, 'a>,
    option: &'static str,
    span: Range<usize>,
    surface: &mut Surface,
    fields: &mut Fields<'a>,
) -> Outcome<()> {
    let material = &mut surface.material;
    match option {
        "body" => fields.body = Some(read.colour("the body's colour")?),
        "ambient" => fields.ambient = Some(read.share("the ambient colour")?),
        "diffuse" => fields.diffuse = Some(read.share("the diffuse colour")?),
        "specular" => fields.specular = Some(read.share("the specular colour")?),
        "reflective" | "transparent" => {
            let share = read.share("the share of light")?;
            if !matches!(share, Share::Percent(0.0) | Share::Colour([0.0, 0.0, 0.0])) {
                fields.not_drawn.push((option, span));
            }
        }
        // These say how light that is let through bends; `transparent` has warned already.
        "index" => _ = read.number_in("the index of refraction", 0.01, 100.0)?,
        "dispersion" => _ = read.number_in("the dispersion", 0.0, 100.0)?,
        "shine" => material.shine = read.number_in("the shine", 0.0, 1e6)? as f32,
        "radius" => {
            material.radius = read.number_in("the radius", 0.0, MAX_MAGNITUDE)?;
            material.end_radius = None;
            if read.is_number_next(SURFACE) {
                let what = "the radius at the other end";
                material.end_radius = Some(read.number_in(what, 0.0, MAX_MAGNITUDE)?);
            }
        }
        "blobbiness" => {
            material.blobbiness = read.number("the blobbiness")?;
            material.end_blobbiness = None;
            if read.is_number_next(SURFACE) {
                let start = read.start();
                let end = read.number("the blobbiness at the other end")?;
                if end == 0.0 || material.blobbiness == 0.0 {
                    return Err(Problem::new(
                        read.since(start),
                        "a blobbiness that varies must not be 0 at an end",
                    )
                    .hint("0 makes a material hard; near 0 is blobby, far from 0 crisp"));
                }
                material.end_blobbiness = Some(end);
            }
        }
        "restriction" => {
            material.restriction = read.number_in("the restriction", 0.0, 1.0)?;
        }
        "depth" => material.depth = read.number_in("the depth", 0.0, MAX_MAGNITUDE)?,
        "strength" => material.strength = read.number("the strength")?,
        "skip" => skip(read, span, fields)?,
        "texture" => {
            fields.textures.push(read.name("the texture's name")?);
            while read.sign(b'+') {
                fields.textures.push(read.name("the texture's name")?);
            }
        }
        _ => material.kernel = Some(kernel(read)?),
    }
    Ok(())
}

/// `skip RAYTYPE …`
fn skip<'a>(read: &mut Reader<'_, 'a>, span: Range<usize>, fields: &mut Fields<'a>) -> Outcome<()> {
    let is_ray = |read: &mut Reader<'_, 'a>| {
        read.peek_word().is_some_and(|(_, word)| {
            RAYS.iter().any(|ray| {
                ray.name
                    .get(..word.len())
                    .is_some_and(|start| start.eq_ignore_ascii_case(word))
            })
        })
    };
    if !is_ray(read) {
        return Err(read.expected("`pixel`, `shadow`, `reflected` or `transmitted`"));
    }
    while is_ray(read) {
        read.at += 1;
    }
    fields.not_drawn.push(("skip", span));
    Ok(())
}

fn kernel(read: &mut Reader<'_, '_>) -> Outcome<Kernel> {
    let name = read.name("the kernel's name")?;
    let lower = name.text.to_ascii_lowercase();
    Kernel::named(&lower).ok_or_else(|| {
        let names = Kernel::ALL.map(Kernel::name);
        let hint = suggest::hint(&lower, names)
            .unwrap_or_else(|| format!("kernels are {}", names.join(", ")));
        Problem::new(name.span, format!("there is no kernel `{}`", name.text)).hint(hint)
    })
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
