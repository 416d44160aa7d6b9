//! `texture`: layers of patterns on a material, and profiles of a field's strength.

use super::palette::Texture;
use super::state::{Evaluator, Flow};
use crate::commands::build::{by_itself, choice, option, options, plain, row, word_of};
use crate::commands::slot::{
    Named, Slot, copy, existing, new, number, triple, unread, vector, whole, word,
};
use crate::commands::{CommandSpec, Kind, Names, OptionSpec};
use crate::given::{Chosen, One};
use crate::problem::{Outcome, Problem};
use crate::reader::{Name, Reader};
use crate::suggest;
use crate::syntax::Command;
use field::Profile;
use glam::DVec3;
use texture::{Fault, Mapping, Region, Solid, Target};

/// Ways in which an image lies on a surface.
pub static MAPPINGS: &[OptionSpec] = &[
    word_of("plain", "by u and v, over the whole shape"),
    option(
        "region",
        "",
        "on points in a box whose normals pass through a rectangle",
        plain![
            vector("MIN", "the region's lowest corner"),
            vector("MAX", "the region's highest corner"),
            vector("P1", "the rectangle's lower left corner"),
            vector("P2", "the rectangle's lower right corner"),
            vector("P3", "the rectangle's upper right corner"),
            vector("P4", "the rectangle's upper left corner")
        ],
    ),
];

/// The waves of the method `Fu Fv`, along a shape's u and v.
pub static WAVES: &[OptionSpec] = &[
    word_of("one", "1 everywhere"),
    word_of("x", "from 0 to 1"),
    word_of("saw", "from 0 to 1 again and again"),
    word_of("hat", "up and down in straight lines"),
    word_of("step", "0, then 1"),
    word_of("sin", "a sine between 0 and 1"),
    word_of("cos", "a cosine between 0 and 1"),
    word_of("sin^2", "a squared sine"),
    word_of("cos^2", "a squared cosine"),
];

/// Solid textures.
pub static SOLIDS: &[OptionSpec] = &[
    word_of("marble", "marble"),
    word_of("agate", "agate"),
    word_of("granite", "granite"),
    word_of("moon", "craters"),
    word_of("onion", "shells"),
    word_of("wood", "rings"),
    word_of("ripples", "waves"),
    word_of("sandal", "sandal wood"),
    word_of("checker", "checkers"),
    word_of("paint", "paint"),
];

/// Waves of the table, for profiles and for textures.
#[rustfmt::skip]
const WAVE_KINDS: [(field::Wave, texture::Wave); 9] = [
    (field::Wave::One, texture::Wave::One),
    (field::Wave::X, texture::Wave::X),
    (field::Wave::Saw, texture::Wave::Saw),
    (field::Wave::Hat, texture::Wave::Hat),
    (field::Wave::Step, texture::Wave::Step),
    (field::Wave::Sin, texture::Wave::Sin),
    (field::Wave::Cos, texture::Wave::Cos),
    (field::Wave::Sin2, texture::Wave::Sin2),
    (field::Wave::Cos2, texture::Wave::Cos2),
];

const WHAT: &str =
    "how to texture: a solid such as `wood`, two waves such as `sin one`, a colour or an image";

fn index_of(list: &[OptionSpec], word: &str) -> Option<usize> {
    list.iter()
        .position(|one| one.name.eq_ignore_ascii_case(word))
}

/// Returns the target of a word; `None` is `strength`.
fn target(name: &str) -> Option<Target> {
    Some(match name {
        "diffuse" => Target::Diffuse,
        "ambient" => Target::Ambient,
        "specular" => Target::Specular,
        "reflective" => Target::Reflective,
        "transparent" => Target::Transparent,
        "index" => Target::Index,
        "shine" => Target::Shine,
        "pigment" => Target::Pigment,
        "normal" => Target::Normal,
        _ => return None,
    })
}

/// Layers of textures, joined by `+`.
pub const LAYERS: Slot<Vec<Named>> = existing("t1 +", Names::Texture, "the texture's name").many();

options! {
    /// Options of `texture`.
    TEXTURE_OPTIONS:
    TRANSLATE: DVec3 = ("translate", "0 0 0",
        "moves the texture, in units of the object; of waves and images in shares of u and v",
        vector("XYZ", "the shift"));
    SCALE: DVec3 = ("scale", "1 1 1", "factors on the place: the larger, the finer the texture",
        triple("XYZ", "the scale"));
    TIMES: DVec3 = ("times", "1 1 1", "scales its values, and the height of bumps",
        triple("RGB", "the factor"));
    BOUNDS: (DVec3, DVec3) = ("bounds", "0 0 0 1 1 1",
        "its lowest and highest value: two colours between which it goes",
        triple("RGB", "the lowest value"), triple("RGB", "the highest value"));
    TURBULENCE: f64 = ("turbulence", "1", "noise of solids: 0 is none",
        number("t", "the turbulence").at_least(0.0));
    OCTAVES: f64 = ("octaves", "5", "detail of the noise of solids",
        number("r", "the octaves").from(0.0, 32.0));
    MASK: Vec<u32> = ("mask", "",
        "tiles shown (1) and left out (0), row by row: as many as the scale \
         has tiles along x, times those along y",
        whole("1 0", 0, 1, "an entry of the mask").many());
    REPLACE: () = ("replace", "", "values take the place of the target's, instead of scaling them");
    UPON: Vec<Named> = ("texture", "", "layers of other textures, upon this one", LAYERS);
}

/// Properties of a material that a texture changes.
pub static TARGETS: &[OptionSpec] = &[
    word_of("diffuse", "the diffuse colour"),
    word_of("ambient", "the ambient colour"),
    word_of("specular", "the highlight"),
    word_of("reflective", "the mirror's colour"),
    word_of("transparent", "the colour let through"),
    word_of("index", "the index of refraction"),
    word_of("shine", "the highlight's size"),
    word_of("pigment", "diffuse and ambient"),
    word_of("normal", "bumps"),
    word_of("strength", "the field: a profile"),
    choice!("texture", "", "layers of other textures", LAYERS).plain,
];

/// `texture { alias target method option … }`, `texture new = old`
///
/// Of our own: `texture new = old option …` changes the copy.
pub static TEXTURE: CommandSpec = row("texture", "make a texture")
    .with(by_itself(
        texture,
        plain![
            new("alias", Names::Texture, "the texture's name"),
            copy("= old", Names::Texture, "the name of the old texture").optional(""),
            word(
                "Target",
                TARGETS,
                "what the texture changes, such as `pigment`"
            ),
            unread("Method", Kind::Method, WHAT),
        ],
        TEXTURE_OPTIONS,
    ))
    .mark_failed(insert_broken)
    .details(
        "A method is a solid (`wood`), which fills the space of the object; a pair of waves along \
         u and v (`sin one`; their x is u or v times the scale, in radians for sines); a colour; \
         or an image (`face.png plain`). Its values go from the first of the `bounds` to the \
         second, and scale the target: black leaves nothing of it, white all. Textures move, turn \
         and scale with their object. `normal` makes bumps. u and v run from 0 to 1: along a limb \
         and around it, around a ball and up; each shape of a blend is textured by itself, and \
         the results are mixed. With the target `strength` waves are a profile: they model the \
         flesh along the skeleton (thesis, section 3.4); a solid or an image says the strength of \
         pieces of it, up to 64 of a bone (ours). `texture t1 + t2` puts layers upon each \
         other, at most 12; `texture new = old` copies a texture. Options behind these change \
         each of the layers (ours).",
    )
    .example(
        "light White, position 4 8 10\nlight White, position -8 2 6, intensity 0.3, noshadow\n\
         texture Rings, pigment wood, scale 2 2 1, bounds SaddleBrown BurlyWood, replace\n\
         texture Veins, pigment marble, bounds SteelBlue White\n\
         texture Dimples, normal ripples, scale 1.5 1.5 1.5\n\
         surface Wood, diffuse White, texture Rings\nsurface Stone, diffuse White, specular \
         Gray50, shine 60, radius 0.8, blobbiness -3, texture Veins + Dimples\n\
         sphere Wood 1.2, -1.8 0 0\nsphere Stone 1, 1.2 0.7 0\nsphere Stone 1, 2 -0.7 0",
    );

fn texture<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<Flow> {
    make(run, command)?;
    Ok(Flow::Next)
}

/// Keeps the name of a texture that could not be made.
fn insert_broken<'a>(run: &mut Evaluator<'a>, command: &'a Command) {
    if let Ok(name) = run.reader(command).new_name("the texture's name") {
        run.palette.insert_broken(name.text);
    }
}

/// Source of a texture's values, as the text gives it.
#[derive(Debug)]
enum Method<'a> {
    /// Waves along u and v, by their indices in [`WAVE_KINDS`].
    Waves([usize; 2]),
    Colour(DVec3),
    Solid(Solid),
    Image(Name<'a>, Mapping),
}

fn make<'a>(run: &mut Evaluator<'a>, command: &'a Command) -> Outcome<()> {
    let mut read = run.reader(command);
    let name = read.new_name("the texture's name")?;
    if read.sign(b'=') {
        let old = read.old_name("the name of the old texture")?;
        let options = read.read_options(TEXTURE_OPTIONS)?;
        read.end()?;
        let texture = run.palette.texture(&old)?.clone();
        return finish(run, &name, texture, options);
    }
    let Some((word, _)) = read.option(TARGETS)? else {
        return Err(read.missing("what the texture changes, such as `pigment`"));
    };
    let below = read.operands(word.parameters, TEXTURE_OPTIONS)?;
    let method = match word.name {
        "texture" => None,
        _ => Some(method(&mut read)?),
    };
    let options = read.read_options(TEXTURE_OPTIONS)?;
    read.end()?;
    let texture = match method {
        None => {
            let below: Vec<_> = below.iter().filter_map(Named::of).collect();
            run.palette.layers(&below)?
        }
        Some(method) => own_layer(run, target(word.name), method)?,
    };
    finish(run, &name, texture, options)
}

/// Makes a texture of one layer, or a profile where there is no target.
fn own_layer<'a>(
    run: &mut Evaluator<'a>,
    target: Option<Target>,
    method: Method<'a>,
) -> Outcome<Texture> {
    let Some(target) = target else {
        let (waves, times) = match method {
            Method::Waves(waves) => (waves.map(|index| WAVE_KINDS[index].0), 1.0),
            Method::Colour(colour) => ([field::Wave::One; 2], colour.x),
            Method::Solid(solid) => return Ok(pattern(texture::Method::Solid(solid))),
            Method::Image(name, mapping) => {
                let image = run.image(&name)?;
                return Ok(pattern(texture::Method::Image(image, mapping)));
            }
        };
        let profile = Profile {
            waves,
            scale: [1.0; 2],
            bounds: [0.0, 1.0],
            times,
            restriction: 0.0,
        };
        return Ok(Texture {
            profile: Some(profile),
            ..Texture::default()
        });
    };
    let method = match method {
        Method::Waves(waves) => texture::Method::Waves(waves.map(|index| WAVE_KINDS[index].1)),
        Method::Colour(colour) => texture::Method::Colour(colour),
        Method::Solid(solid) => texture::Method::Solid(solid),
        Method::Image(name, mapping) => texture::Method::Image(run.image(&name)?, mapping),
    };
    Ok(Texture {
        layers: vec![texture::Texture::new(target, method)],
        ..Texture::default()
    })
}

/// Returns the texture of a strength that a solid or an image says.
fn pattern(method: texture::Method) -> Texture {
    Texture {
        pattern: Some(texture::Texture::new(Target::Strength, method)),
        ..Texture::default()
    }
}

/// Applies the options to every layer, puts the other layers that they name upon them, and keeps
/// the result.
fn finish<'a>(
    run: &mut Evaluator<'a>,
    name: &Name<'a>,
    mut texture: Texture,
    options: Vec<Chosen<'a>>,
) -> Outcome<()> {
    let mut above = Vec::new();
    let mut mask = None;
    for chosen in options {
        if let Some(layers) = UPON.of(&chosen) {
            above.extend(layers);
            continue;
        }
        if MASK.is(&chosen) || SCALE.is(&chosen) {
            mask = Some(chosen.span.clone());
        }
        if let Some(message) = set(&mut texture, &chosen) {
            run.warn(&chosen.span, message, "leave it out");
        }
    }
    for layer in texture.layers.iter().chain(&texture.pattern) {
        layer.check().map_err(|fault| {
            let span = mask.clone().unwrap_or(name.span.clone());
            let problem = Problem::new(&span, fault.to_string());
            match fault {
                Fault::Mask(..) => problem.hint(format!("it has {}", layer.mask.len())),
                _ => problem,
            }
        })?;
    }
    run.palette.stack(&mut texture, &above)?;
    run.palette.insert_texture(name, texture)
}

/// Sets an option of every layer and of the profile. Returns a warning if it changes nothing.
fn set(texture: &mut Texture, chosen: &Chosen<'_>) -> Option<String> {
    let name = chosen.option.name;
    let layers = &mut texture.layers;
    let has_pattern = texture.pattern.is_some();
    if let Some(profile) = &mut texture.profile {
        // A strength is one number: the first of three.
        if let Some(scale) = SCALE.of(chosen) {
            profile.scale = [scale.x, scale.y];
        } else if let Some(times) = TIMES.of(chosen) {
            profile.times = times.x;
        } else if let Some((low, high)) = BOUNDS.of(chosen) {
            profile.bounds = [low.x, high.x];
        } else if layers.is_empty() && !has_pattern && TRANSLATE.of(chosen) != Some(DVec3::ZERO) {
            return Some(format!(
                "`{name}` changes nothing about a strength: `scale`, `bounds` and `times` do"
            ));
        }
    }
    let layers = layers.iter_mut().chain(&mut texture.pattern);
    let mut layers: Vec<&mut texture::Texture> = layers.collect();
    let mut methods = layers.iter().map(|layer| layer.method);
    if (TURBULENCE.is(chosen) || OCTAVES.is(chosen))
        && !layers.is_empty()
        && !methods.any(|method| matches!(method, texture::Method::Solid(_)))
    {
        return Some(format!(
            "`{name}` says nothing here: it is the noise of solids such as `wood`"
        ));
    }
    for layer in &mut layers {
        if let Some(shift) = TRANSLATE.of(chosen) {
            layer.translate = shift;
        } else if let Some(scale) = SCALE.of(chosen) {
            layer.scale = scale;
        } else if let Some(times) = TIMES.of(chosen) {
            layer.times = times;
        } else if let Some((low, high)) = BOUNDS.of(chosen) {
            layer.bounds = [low, high];
        } else if let Some(turbulence) = TURBULENCE.of(chosen) {
            layer.grain.turbulence = turbulence;
        } else if let Some(octaves) = OCTAVES.of(chosen) {
            layer.grain.octaves = octaves;
        } else if let Some(mask) = MASK.of(chosen) {
            layer.mask = mask.into_iter().map(|entry| entry == 1).collect();
        } else if REPLACE.is(chosen) {
            layer.replace = true;
        }
    }
    None
}

/// Reads a method: a solid texture, a pair of waves, an image or a colour.
fn method<'a>(read: &mut Reader<'_, 'a>) -> Outcome<Method<'a>> {
    if read.peek_word().is_none() {
        return Ok(Method::Colour(colour(read)?));
    }
    let back = read.at;
    let word = read.file_name(WHAT)?;
    if let Some(u) = index_of(WAVES, word.text) {
        let second = read.name("the second wave, such as `one`")?;
        let v = index_of(WAVES, second.text).ok_or_else(|| {
            let names: Vec<_> = WAVES.iter().map(|wave| wave.name).collect();
            let names = names.join(", ");
            Problem::new(&second.span, format!("there is no wave `{}`", second.text))
                .hint(format!("the waves are {names}"))
        })?;
        return Ok(Method::Waves([u, v]));
    }
    if read.keyword("plain") {
        return Ok(Method::Image(word, Mapping::Plain));
    }
    if read.keyword("region") {
        return Ok(Method::Image(word, Mapping::Region(region(read)?)));
    }
    if crate::reads::is_image(word.text) {
        let names: Vec<_> = MAPPINGS.iter().map(|m| format!("`{}`", m.name)).collect();
        return Err(read
            .missing(&format!("how the image lies: {}", names.join(" or ")))
            .hint(format!("write `{} plain`", word.text)));
    }
    if let Some(index) = index_of(SOLIDS, word.text) {
        return Ok(Method::Solid(Solid::ALL[index]));
    }
    read.at = back;
    colour(read).map(Method::Colour).map_err(|problem| {
        // Names of one letter are near to any.
        let words = SOLIDS.iter().chain(WAVES).map(|word| word.name);
        match suggest::hint(word.text, words.filter(|word| word.len() > 1)) {
            Some(hint) if problem.span == word.span => problem.hint(hint),
            _ => problem,
        }
    })
}

fn colour(read: &mut Reader<'_, '_>) -> Outcome<DVec3> {
    Ok(DVec3::from_array(read.colour(WHAT)?.map(f64::from)))
}

/// Reads the box and the rectangle of an image that is thrown onto a part.
fn region(read: &mut Reader<'_, '_>) -> Outcome<Region> {
    let start = read.start();
    let mut points = [DVec3::ZERO; 6];
    for (point, parameter) in points.iter_mut().zip(MAPPINGS[1].parameters) {
        *point = read.vector(parameter.meaning)?;
    }
    let [min, max, a, b, c, d] = points;
    let region = Region {
        min,
        max,
        corners: [a, b, c, d],
    };
    if region.is_rectangle() {
        return Ok(region);
    }
    Err(
        Problem::new(&read.since(start), Fault::Region.to_string()).hint(
            "two corners of the box, then the lower left, \
            lower right, upper right and upper left corner of the rectangle",
        ),
    )
}
