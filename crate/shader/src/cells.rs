//! The cells of the chart, each recorded from an element of its kind.
use crate::layout::{Layout, Source};
use crate::recorded::{Recorded, record};
use crate::write::function;
use field::{BlobScale, Kernel, Primitive, Profile, Shaping, Skeleton, Taper, Term};
use glam::DVec3;
use std::cell::Cell as Counter;

/// A cell of the chart, or the factor of profiles of a kind, as a function in WGSL.
#[derive(Clone, Debug)]
pub struct Cell {
    /// Name of the function, `KERNEL_BONE` or `profile_COURSE`.
    pub name: String,
    /// The constants that it loads.
    pub layout: Layout,
    /// The function.
    pub code: String,
}

impl Cell {
    /// Returns the text of the function's file.
    #[must_use]
    pub fn file(&self) -> String {
        format!("// {}\n{}", self.layout, self.code)
    }
}

/// Records all cells. A polygon is a sum of triangles, and has none.
#[must_use]
pub fn all() -> Vec<Cell> {
    let bones = Kernel::ALL.into_iter().flat_map(elements);
    let shaped = elements(Kernel::Quartic).into_iter().map(with_profile);
    let mut cells: Vec<Cell> = Vec::new();
    for primitive in bones.chain(shaped) {
        let term = primitive.term();
        let name = term.course().map_or_else(
            || term.cell().join("_"),
            |course| format!("profile_{course}"),
        );
        if cells.iter().all(|cell| cell.name != name) {
            cells.push(record_cell(name, term));
        }
    }
    cells
}

/// Records the factor of a term's profile, or the field of a term that has none.
fn record_cell(name: String, term: &Term<f32>) -> Cell {
    let (tape, results) = record(|| {
        let term = with_recorded_constants(term);
        let jet = term.factor(position());
        let jet = jet.unwrap_or_else(|| term.plain_jet(position()));
        let [x, y, z] = jet.gradient;
        [jet.value, x, y, z]
    });
    let total = Counter::new(0);
    term.cast(|_| total.set(total.get() + 1), |_| ());
    let (layout, code) = function(&name, &tape, &results, total.get());
    let open = layout.lists.last().is_some_and(|list| list.count.is_none());
    let in_pieces = name.ends_with("_curve") || name.ends_with("_taper");
    assert_eq!(open, in_pieces, "{name}: its element has too few pieces");
    Cell { name, layout, code }
}

/// Returns a term whose constants are recorded.
fn with_recorded_constants(term: &Term<f32>) -> Term<Recorded> {
    let [bone, profile] = [0; 2].map(Counter::new);
    term.cast(
        |_| Recorded::constant(Source::Bone, take(&bone)),
        |_| Recorded::constant(Source::Profile, take(&profile)),
    )
}

/// Returns the number that a counter has, and counts on.
fn take(counter: &Counter<u32>) -> u32 {
    counter.replace(counter.get() + 1)
}

fn position() -> [Recorded; 3] {
    [0, 1, 2].map(Recorded::coordinate)
}

fn shaping(kernel: Kernel) -> Shaping {
    Shaping {
        kernel,
        radius: 0.3,
        blobbiness: 1.0,
        blob_scale: BlobScale::Relative,
        strength: 1.0,
        influence: 1e-3,
        taper: None,
    }
}

/// Returns an element of each cell of a kernel. Curves have several pieces, so that their loops are
/// seen to be loops.
fn elements(kernel: Kernel) -> Vec<Primitive> {
    let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z];
    let segment = Skeleton::Segment { base: -x, apex: x };
    let arc = Skeleton::Arc {
        center: DVec3::ZERO,
        u: x,
        v: y,
        radius: 1.0,
        angle: 2.0,
    };
    let straight = [
        Skeleton::Point {
            center: DVec3::ZERO,
        },
        segment.clone(),
        arc.clone(),
        Skeleton::Triangle { corners: [x, y, z] },
        Skeleton::Plane {
            point: DVec3::ZERO,
            normal: z,
        },
        Skeleton::Curve {
            control: [-x, y, x + z, 2.0 * y],
        },
    ];
    let plain = shaping(kernel);
    let tapered = Shaping {
        taper: Some(Taper {
            radius: 0.2,
            blobbiness: 1.0,
        }),
        ..plain
    };
    let straight = straight.map(|skeleton| (skeleton, plain));
    let bent = [arc, segment].map(|skeleton| (skeleton, tapered));
    (straight.into_iter().chain(bent))
        .map(|(skeleton, shaping)| {
            Primitive::new(skeleton, &shaping, None).expect("an element of the usual size")
        })
        .collect()
}

/// Returns the element with a profile.
fn with_profile(primitive: Primitive) -> Primitive {
    let profile = Profile::default();
    let shaping = shaping(primitive.kernel);
    Primitive::new(primitive.skeleton.clone(), &shaping, Some(profile)).unwrap_or(primitive)
}
