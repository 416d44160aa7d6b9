//! Finds colours that are written in a command. An editor shows them and lets them be chosen.

use crate::index::Index;
use crate::place;
use crate::slots::What;
use rats::commands::Kind;
use rats::{Project, colours};
use std::ops::Range;

/// A colour in the text.
#[derive(Clone, Debug, PartialEq)]
pub struct Tint {
    /// The bytes: a name, three numbers or `rgb(…)` with three numbers. Another colour can be
    /// written there.
    pub span: Range<usize>,
    /// Red, green and blue.
    pub colour: [f32; 3],
}

/// Finds the colours that the command at a byte names outright, in their order; those that are
/// computed are left out.
///
/// ```
/// let text = "surface Clay, diffuse SandyBrown, specular <0.5 0.5 0.5>, shine 40";
/// let found = assist::tints(&rats::Project::single(text), 0, 10);
/// assert_eq!(found.len(), 2);
/// assert_eq!(&text[found[0].span.clone()], "SandyBrown");
/// assert_eq!(found[1].colour, [0.5; 3]);
/// ```
#[must_use]
pub fn tints(project: &Project, file: usize, byte: usize) -> Vec<Tint> {
    let Some(text) = project.files.get(file).map(|file| file.text.as_str()) else {
        return Vec::new();
    };
    if !place::is_in(text, byte) || place::in_comment(text, byte) {
        return Vec::new();
    }
    let index = Index::at(project, Some((file, byte)));
    let Some(here) = &index.here else {
        return Vec::new();
    };
    let mut found = Vec::new();
    // The numbers of a triple that has begun: where, how many and which.
    let mut begun: Option<(usize, Vec<f32>)> = None;
    for (span, slot) in &here.operands {
        let kind = slot.parameter.map(|parameter| parameter.kind);
        // Bounds of a texture are vectors, but colours as well.
        let is_bound = slot.option.is_some_and(|option| option.name == "bounds");
        let takes_colours = matches!(
            kind,
            Some(Kind::Colour | Kind::Backdrop | Kind::Share | Kind::Value)
        ) || is_bound;
        let written = text.get(span.clone()).unwrap_or_default();
        match slot.what {
            What::Number(part) if takes_colours => {
                let Ok(number) = written.parse::<f32>() else {
                    begun = None;
                    continue;
                };
                match (&mut begun, part) {
                    (_, 0) => begun = Some((span.start, vec![number])),
                    (Some((_, numbers)), part) if numbers.len() == usize::from(part) => {
                        numbers.push(number);
                    }
                    _ => begun = None,
                }
                if let Some((start, numbers)) = &begun
                    && let [r, g, b] = numbers[..]
                {
                    found.push(Tint {
                        span: *start..span.end,
                        colour: [r, g, b],
                    });
                    begun = None;
                }
            }
            What::Triple if takes_colours => {
                begun = None;
                if let Some(colour) = colours::find(written).or_else(|| rgb(written)) {
                    found.push(Tint {
                        span: span.clone(),
                        colour,
                    });
                }
            }
            _ => begun = None,
        }
    }
    found
}

/// Reads the colour of `rgb(r, g, b)` with three numbers.
fn rgb(text: &str) -> Option<[f32; 3]> {
    let inner = text.strip_prefix("rgb(")?.strip_suffix(')')?;
    let mut parts = inner.split(',').map(|part| part.trim().parse());
    let colour = [
        parts.next()?.ok()?,
        parts.next()?.ok()?,
        parts.next()?.ok()?,
    ];
    parts.next().is_none().then_some(colour)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn colours_of(text: &str) -> Vec<(&str, [f32; 3])> {
        let tints = tints(&Project::single(text), 0, 2);
        let spans = tints.into_iter();
        spans.map(|t| (&text[t.span], t.colour)).collect()
    }

    #[test]
    fn names_numbers_and_rgb_are_found() {
        assert_eq!(
            colours_of("light White, position 1 2 3"),
            [("White", [1.0; 3])]
        );
        assert_eq!(
            colours_of("light 0.5 0.25 1 point, position 1 2 3"),
            [("0.5 0.25 1", [0.5, 0.25, 1.0])]
        );
        assert_eq!(
            colours_of("background rgb(0.1, 0.2, 0.3) to Black"),
            [("rgb(0.1, 0.2, 0.3)", [0.1, 0.2, 0.3]), ("Black", [0.0; 3])]
        );
        assert_eq!(
            colours_of("texture T, pigment wood, bounds <0.1 0.2 0.3> Wheat, replace").len(),
            2
        );
    }

    #[test]
    fn what_is_no_colour_is_left_out() {
        assert_eq!(colours_of("sphere Clay 1, 0 0 0"), []);
        assert_eq!(colours_of("eyep 1 2 3"), []);
        assert_eq!(colours_of("surface S, specular 50%, shine 40"), []);
        assert_eq!(colours_of("light Lamp*0.5, position 1 2 3"), []);
        assert_eq!(colours_of("# light White"), []);
        // Not finished yet.
        assert_eq!(colours_of("light 0.5 0.5"), []);
    }

    #[test]
    fn a_colour_written_in_its_place_is_found_again() {
        let text = "surface Clay, diffuse 0.1 0.2 0.3, specular White";
        let first = &tints(&Project::single(text), 0, 2)[0];
        let value = rats::HotValue::Colour([0.25, 0.5, 0.75]);
        let text = rats::hot::set(text, first.span.clone(), &value);
        let again = tints(&Project::single(text.as_str()), 0, 2);
        assert_eq!(again[0].colour, [0.25, 0.5, 0.75]);
        assert_eq!(again[1].colour, [1.0; 3]);
    }
}
