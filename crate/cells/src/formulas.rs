//! The chart's formulas in WGSL, `shaders/field/`.

use field::{Primitive, Term};
use shader::Layout;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::sync::OnceLock;

macro_rules! cells {
    ($($name:literal)*) => {
        [$((
            $name,
            include_str!(concat!(
                env!("CARGO_MANIFEST_DIR"),
                "/../../shaders/field/",
                $name,
                ".wgsl"
            )),
        )),*]
    };
}

const CELLS: [(&str, &str); 70] = cells![
    "cauchy_arc" "cauchy_curve" "cauchy_plane" "cauchy_point" "cauchy_segment" "cauchy_taper"
    "cauchy_triangle" "compact6_arc" "compact6_cone" "compact6_curve" "compact6_plane"
    "compact6_point" "compact6_segment" "compact6_taper" "compact6_triangle" "cubed_arc"
    "cubed_cone" "cubed_curve" "cubed_plane" "cubed_point" "cubed_segment" "cubed_taper"
    "cubed_triangle" "gauss_arc" "gauss_curve" "gauss_plane" "gauss_point" "gauss_segment"
    "gauss_taper" "gauss_triangle" "inverse_arc" "inverse_curve" "inverse_plane" "inverse_point"
    "inverse_segment" "inverse_taper" "inverse_triangle" "metaballs_arc" "metaballs_curve"
    "metaballs_plane" "metaballs_point" "metaballs_segment" "metaballs_taper" "metaballs_triangle"
    "profile_circle" "profile_nowhere" "profile_plane" "quartic_arc" "quartic_cone" "quartic_curve"
    "quartic_plane" "quartic_point" "quartic_segment" "quartic_taper" "quartic_triangle" "soft_arc"
    "soft_cone" "soft_curve" "soft_plane" "soft_point" "soft_segment" "soft_taper" "soft_triangle"
    "squared_arc" "squared_curve" "squared_plane" "squared_point" "squared_segment" "squared_taper"
    "squared_triangle"
];

/// Functions that formulas call.
const MATHEMATICS: &str = include_str!("../../../shaders/field/math.wgsl");

/// The formulas that a card has beside cubics.
pub trait Chart: Sync {
    /// Whether it has that of a primitive.
    fn has(&self, primitive: &Primitive) -> bool;

    /// Appends the constants of a primitive to some data, and returns its record as `term` in the
    /// program of [`code`] reads it.
    fn pack(&self, primitive: &Primitive, data: &mut Vec<[u32; 4]>) -> [u32; 4];
}

/// A chart without formulas: cubics are all.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cubics;

/// The formulas of the chart.
#[derive(Clone, Copy, Debug, Default)]
pub struct Formulas;

impl Chart for Cubics {
    fn has(&self, _: &Primitive) -> bool {
        false
    }

    fn pack(&self, _: &Primitive, _: &mut Vec<[u32; 4]>) -> [u32; 4] {
        [u32::MAX, 0, 0, 0]
    }
}

impl Chart for Formulas {
    fn has(&self, primitive: &Primitive) -> bool {
        find(primitive.term()).is_some()
    }

    // The record: the number of the formula with that of the profile's factor plus 1 times 2¹⁶,
    // where the constants of both begin, and the number of records.
    fn pack(&self, primitive: &Primitive, data: &mut Vec<[u32; 4]>) -> [u32; 4] {
        let term = primitive.term();
        let Some((plain, profile)) = find(term) else {
            return [u32::MAX, 0, 0, 0];
        };
        let (start, records) = append(plain, term, data);
        let (kind, of_profile) = match profile {
            Some(profile) => (
                plain.number | (profile.number + 1) << 16,
                append(profile, term, data).0,
            ),
            None => (plain.number, 0),
        };
        [kind, start, of_profile, records]
    }
}

/// A cell of the chart: its number, the layout of its constants, its function.
struct Formula {
    number: u32,
    layout: Layout,
    code: &'static str,
}

fn formulas() -> &'static BTreeMap<&'static str, Formula> {
    static FORMULAS: OnceLock<BTreeMap<&'static str, Formula>> = OnceLock::new();
    FORMULAS.get_or_init(|| {
        let all = (0..).zip(CELLS).filter_map(|(number, (name, text))| {
            let (layout, code) = text.strip_prefix("// ")?.split_once('\n')?;
            let layout = layout.parse().ok()?;
            let formula = Formula {
                number,
                layout,
                code,
            };
            Some((name, formula))
        });
        all.collect()
    })
}

/// Returns the formula of a term without its profile, and that of the profile; `None` if the card
/// has not all.
fn find(term: &Term<f32>) -> Option<(&'static Formula, Option<&'static Formula>)> {
    let plain = formulas().get(term.cell().join("_").as_str())?;
    let profile = match term.course() {
        Some(course) => Some(formulas().get(format!("profile_{course}").as_str())?),
        None => None,
    };
    Some((plain, profile))
}

/// Returns the records of all formulas, for [`code`].
pub fn all() -> impl Iterator<Item = u32> {
    formulas()
        .iter()
        .map(|(name, formula)| match name.starts_with("profile") {
            true => (formula.number + 1) << 16,
            false => formula.number,
        })
}

/// Appends the constants that a formula loads, and returns where they begin and the number of
/// records.
fn append(formula: &Formula, term: &Term<f32>, data: &mut Vec<[u32; 4]>) -> (u32, u32) {
    let start = data.len() as u32;
    let (constants, records) = formula.layout.pack(term);
    data.extend(constants.iter().map(|four| four.map(f32::to_bits)));
    (start, records)
}

/// Returns the functions of formulas of some records, and the function that chooses among them.
#[must_use]
pub fn code(records: &BTreeSet<u32>) -> String {
    let mut used: Vec<(u32, bool)> = Vec::new();
    for kind in records {
        used.push((kind & 0xffff, false));
        if kind >> 16 > 0 {
            used.push(((kind >> 16) - 1, true));
        }
    }
    used.sort_unstable();
    used.dedup();
    let mut text = String::from(MATHEMATICS);
    text += "fn constant(i: u32) -> vec4<f32> {\n    return four_floats(i);\n}\n";
    let mut choices = [String::new(), String::new()];
    for (number, is_profile) in used {
        let Some((name, _)) = CELLS.get(number as usize) else {
            continue;
        };
        text += formulas()[name].code;
        let case = if is_profile { number + 1 } else { number };
        let choice = &mut choices[usize::from(is_profile)];
        let _ = writeln!(
            choice,
            "        case {case}u: {{\n            return {name}(at, count, p);\n        }}"
        );
    }
    text + &choose(choices)
}

/// Returns the functions that choose among no formulas.
#[must_use]
pub fn none(_: &BTreeSet<u32>) -> String {
    choose(Default::default())
}

/// Returns the functions that choose among formulas, and among profiles.
fn choose(choices: [String; 2]) -> String {
    let mut text = String::new();
    for (name, choices) in ["plain_term", "profile_of_term"].into_iter().zip(choices) {
        let _ = write!(
            text,
            "fn {name}(kind: u32, at: u32, count: u32, p: vec3f) -> vec4f {{
    switch kind {{
{choices}        default: {{
            return vec4f(0.0);
        }}
    }}
}}
"
        );
    }
    text
}
