//! Pictures of textures and lights, drawn by our own renderer: files of the folder `reference`
//! beside the page. An editor shows them beside words, and the reference page all of them.

#[cfg(test)]
use rats::commands::OptionSpec;
use rats::commands::options;
use std::fmt::Write;

/// Makes a table of words and the addresses of their pictures, beside the page.
macro_rules! table {
    ($($word:literal $file:literal)*) => {
        &[$(($word, concat!("reference/", $file, ".png"))),*]
    };
}

/// Words of `texture` and their pictures.
static TEXTURES: &[(&str, &str)] = table! {
    "marble" "texture-marble" "agate" "texture-agate" "granite" "texture-granite"
    "moon" "texture-moon" "onion" "texture-onion" "wood" "texture-wood"
    "ripples" "texture-ripples" "sandal" "texture-sandal" "checker" "texture-checker"
    "paint" "texture-paint"
    "one" "wave-one" "x" "wave-x" "saw" "wave-saw" "hat" "wave-hat" "step" "wave-step"
    "sin" "wave-sin" "cos" "wave-cos" "sin^2" "wave-sin2" "cos^2" "wave-cos2"
};

/// Words of `light` and their pictures.
static LIGHTS: &[(&str, &str)] = table! {
    "point" "light-point" "distant" "light-distant" "spot" "light-spot"
    "noshadow" "light-noshadow" "size" "light-size"
};

/// Finds the address, relative to the page, of the picture of a word behind a command: of a method
/// of `texture`, or of an option of `light`. `None` if it has none.
///
/// ```
/// use assist::swatches::picture;
/// assert_eq!(picture("texture", "marble"), Some("reference/texture-marble.png"));
/// assert_eq!(picture("light", "spot"), Some("reference/light-spot.png"));
/// assert_eq!(picture("sphere", "marble"), None);
/// ```
#[must_use]
pub fn picture(command: &str, word: &str) -> Option<&'static str> {
    let table = match command {
        "texture" => TEXTURES,
        "light" => LIGHTS,
        _ => return None,
    };
    let found = table.iter().find(|(name, _)| *name == word);
    found.map(|(_, path)| *path)
}

/// A picture of the reference page that belongs to no command's example.
pub struct Swatch {
    /// The file's name without extension.
    pub name: String,
    /// The line on the page.
    pub title: String,
    /// The text that is drawn.
    pub text: String,
}

/// The solids with the colours that suit them: the lowest and the highest value.
const SOLIDS: [(&str, &str); 10] = [
    ("marble", "bounds <0.22 0.27 0.33> <0.98 0.96 0.93>, "),
    ("agate", "bounds <0.32 0.07 0.03> <0.98 0.83 0.62>, "),
    ("granite", "bounds <0.20 0.17 0.18> <0.88 0.82 0.80>, "),
    ("moon", "bounds <0.26 0.25 0.25> <0.80 0.78 0.74>, "),
    (
        "onion",
        "bounds <0.40 0.15 0.05> <0.86 0.50 0.20>, scale 1 0.6 1, turbulence 2, ",
    ),
    ("wood", "bounds <0.30 0.13 0.05> <0.80 0.52 0.27>, "),
    ("ripples", "bounds <0.05 0.22 0.38> <0.70 0.90 0.95>, "),
    ("sandal", "bounds <0.42 0.25 0.14> <0.86 0.66 0.42>, "),
    ("checker", "scale 2 2 2, bounds Gray15 Wheat, "),
    ("paint", ""),
];

const STUDIO: &str = "eyep 0 1.2 5\nfov 34\ntone filmic\n\
    light White, position -4 6 7, intensity 0.9\n\
    light SlateBlue, position 6 0 4, intensity 0.4, noshadow\n\
    background 0.30 0.33 0.38 to 0.12 0.13 0.16\n";

/// Returns all swatches: solids as colours and as bumps, waves, lights.
#[must_use]
pub fn all() -> Vec<Swatch> {
    let mut list = Vec::new();
    for (solid, look) in SOLIDS {
        list.push(Swatch {
            name: format!("texture-{solid}"),
            title: format!("pigment {solid}"),
            text: format!(
                "{STUDIO}texture T, pigment {solid}, {look}replace\n\
                surface S, diffuse White, specular 40%, shine 50, texture T\n\
                sphere S 1.15, 0 0 0\n"
            ),
        });
    }
    for (solid, _) in SOLIDS {
        list.push(Swatch {
            name: format!("bump-{solid}"),
            title: format!("normal {solid}"),
            text: format!(
                "{STUDIO}texture T, normal {solid}\n\
                surface S, diffuse 0.78 0.72 0.66, specular 40%, shine 40, texture T\n\
                sphere S 1.15, 0 0 0\n"
            ),
        });
    }
    for wave in options::WAVES {
        // Sines take radians: as many waves around as the others have.
        let scale = if wave.name.starts_with(['s', 'c']) && !matches!(wave.name, "saw" | "step") {
            "12*pi"
        } else if matches!(wave.name, "x" | "one") {
            "1"
        } else {
            "6"
        };
        list.push(Swatch {
            name: format!("wave-{}", wave.name.replace('^', "")),
            title: format!("pigment {} one", wave.name),
            text: format!(
                "{STUDIO}texture T, pigment {} one, \
                scale {scale} 1 1, bounds DarkSlateBlue Wheat, replace\n\
                surface S, diffuse White, specular 40%, shine 50, texture T\n\
                sphere S 1.15, 0 0 0\n",
                wave.name
            ),
        });
    }
    let lights = [
        ("point", "light 1 0.95 0.85 point, position -3 4 4"),
        (
            "distant",
            "light 1 0.95 0.85 distant, direction 1 -1.2 -0.8",
        ),
        (
            "spot",
            "light 1 0.95 0.85 spot, position -3 5 4, direction 3 -5.4 -4, angle 9, edge 2",
        ),
        (
            "noshadow",
            "light 1 0.95 0.85 point, position -3 4 4, noshadow",
        ),
        (
            "size",
            "penumbra on\nlight 1 0.95 0.85 point, position -3 4 4, size 0.8",
        ),
        ("sky", "sky White to LightSteelBlue, samples 9"),
        (
            "fog",
            "light 1 0.95 0.85 point, position -3 4 4\nfog LightSteelBlue, distance 6",
        ),
        (
            "cloud",
            "light 1 0.95 0.85 point, position -3 4 4, intensity 0.5\n\
             cloud Gold, position 0 0.2 0, radius 1.8",
        ),
    ];
    for (name, light) in lights {
        list.push(Swatch {
            name: format!("light-{name}"),
            title: light.rsplit('\n').next().unwrap_or(light).to_owned(),
            text: format!(
                "eyep 0 2.2 6\nvrp 0 -0.1 0\nfov 34\nbackground 0.10 0.11 0.14\n{light}\n\
                surface Floor, diffuse 0.72 0.68 0.62\nplane Floor <0 -0.8 0> <0 1 0>\n\
                surface Clay, diffuse 0.80 0.45 0.28, specular 30%, shine 40\n\
                sphere Clay 0.8, 0 0 0\nsphere Clay 0.35, 1.3 -0.45 0.6\n"
            ),
        });
    }
    list
}

/// Writes the section of the reference page with all swatches. `link` returns the fragment that
/// opens a text in the page.
pub(crate) fn section(page: &mut String, link: impl Fn(&Swatch) -> Option<String>) {
    let parts = [
        (
            "textures",
            "Textures",
            "As colours, and as bumps of the normal.",
            &["texture-", "bump-"][..],
        ),
        (
            "waves",
            "Waves",
            "Along u, which runs around a ball. The second wave, here <code>one</code>, \
             runs along v.",
            &["wave-"],
        ),
        (
            "lights",
            "Light and air",
            "The same two balls each time.",
            &["light-"],
        ),
    ];
    let all = all();
    for (id, title, about, prefixes) in parts {
        let _ = writeln!(
            page,
            "<h2 id=\"{id}\">{title}</h2>\n<p>{about}</p>\n<div class=\"swatches\">"
        );
        for swatch in all
            .iter()
            .filter(|s| prefixes.iter().any(|p| s.name.starts_with(p)))
        {
            let picture = format!(
                "<img src=\"reference/{0}.png\" width=\"240\" height=\"180\" \
                 loading=\"lazy\" alt=\"{0}\">",
                swatch.name
            );
            let picture = match link(swatch) {
                Some(link) => format!("<a href=\"./#{link}\">{picture}</a>"),
                None => picture,
            };
            let _ = writeln!(
                page,
                "<figure>{picture}<figcaption><code>{}</code></figcaption></figure>",
                swatch.title
            );
        }
        page.push_str("</div>\n");
    }
}

/// Returns whether all words of a list have a picture.
#[cfg(test)]
fn are_pictured(command: &str, list: &[OptionSpec]) -> bool {
    list.iter()
        .all(|word| picture(command, word.name).is_some())
}

#[cfg(test)]
mod tests {
    use super::*;
    use rats::{Project, Severity};

    #[test]
    fn every_method_has_a_picture() {
        assert!(are_pictured("texture", options::SOLIDS));
        assert!(are_pictured("texture", options::WAVES));
        let names: Vec<String> = all().into_iter().map(|swatch| swatch.name).collect();
        for (_, path) in TEXTURES.iter().chain(LIGHTS) {
            let name = path
                .strip_prefix("reference/")
                .and_then(|p| p.strip_suffix(".png"));
            assert!(names.iter().any(|n| Some(n.as_str()) == name), "{path}");
        }
        for (solid, _) in SOLIDS {
            assert!(options::SOLIDS.iter().any(|word| word.name == solid));
        }
    }

    #[test]
    fn their_texts_compile() {
        for swatch in all() {
            let compiled = rats::compile(&Project::single(&swatch.text));
            let complaint = compiled
                .diagnostics
                .iter()
                .find(|d| d.severity > Severity::Note);
            assert_eq!(complaint, None, "{}", swatch.text);
            assert!(!compiled.scene.elements.is_empty());
        }
    }
}
