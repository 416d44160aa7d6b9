//! Names that files give to their radii.

/// Names of arrays and properties that hold radii, in small letters and without other characters:
/// those of centreline tools first.
const RADII: [&str; 6] = [
    "maximuminscribedsphereradius",
    "radius",
    "radii",
    "r",
    "misr",
    "thickness",
];

/// Array or property of radii among those of a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Radii {
    /// Index of the name.
    pub(super) index: usize,
    /// Factor that makes radii of its values: a half for diameters.
    pub(super) factor: f64,
}

/// Finds the name of radii among some names: the wanted one, or else the most usual. A name that
/// speaks of a diameter counts a half.
pub(super) fn find<'a>(
    names: impl Iterator<Item = &'a str>,
    wanted: Option<&str>,
) -> Option<Radii> {
    let names = names.map(plain).enumerate();
    let ranked = names.filter_map(|(index, name)| {
        let rank = match wanted {
            Some(wanted) => (plain(wanted) == name).then_some(0),
            None => rank(&name),
        };
        let factor = if name.ends_with("diameter") { 0.5 } else { 1.0 };
        rank.map(|rank| (rank, Radii { index, factor }))
    });
    ranked.min_by_key(|(rank, _)| *rank).map(|(_, radii)| radii)
}

/// Returns how unusual a plain name of radii is; `None` if it is none.
fn rank(name: &str) -> Option<usize> {
    let usual = RADII.iter().position(|usual| *usual == name);
    usual.or_else(|| match name {
        _ if name.ends_with("radius") => Some(RADII.len()),
        _ if name.ends_with("diameter") => Some(RADII.len() + 1),
        _ => None,
    })
}

/// Returns the letters and digits of a name, in small letters.
pub(super) fn plain(name: &str) -> String {
    let kept = name.chars().filter(|c| c.is_alphanumeric());
    kept.flat_map(char::to_lowercase).collect()
}

/// Returns a list of names for a sentence.
pub(super) fn list<'a>(names: impl Iterator<Item = &'a str>) -> String {
    let names: Vec<String> = names
        .take(40)
        .map(|name| format!("`{}`", crate::error::shorten(name)))
        .collect();
    match names.is_empty() {
        true => "none".into(),
        false => names.join(", "),
    }
}
