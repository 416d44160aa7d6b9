//! Checks of a way of finding surfaces: against the reference, on random rays through random
//! scenes.
//!
//! No hit is further from the surface than the tolerance of pictures, none is missed where the
//! surface is thicker than that, and none is invented. Each check panics where that does not hold.

use crate::rays::{Method, Row, Trial, check};
use field::Kernel;
use trials::count;
use trials::scenes::Kind;

/// Judges some scenes of each kind, with the kernels in turn. Returns the counts and a line for
/// each fault.
pub fn judge(
    kernels: &[Kernel],
    kinds: &[Kind],
    scenes: usize,
    packets: usize,
    method: Method<'_>,
) -> (Row, String) {
    let mut faults = String::new();
    let mut total = Row::default();
    for &kind in kinds {
        let many = matches!(kind, Kind::Cluster | Kind::Cloud | Kind::Patch);
        let packets = if many { 2 } else { packets };
        for (seed, &kernel) in (7_000_000..).zip(kernels.iter().cycle().take(count(scenes))) {
            // The seeds differ from those of the large run.
            let trial = Trial::new(kernel, kind, seed, packets);
            total.add(&check(trial, method, &mut faults));
        }
    }
    (total, faults)
}

/// Compact kernels, whose fields are not cut off.
const COMPACT: [Kernel; 4] = [
    Kernel::Metaballs,
    Kernel::Soft,
    Kernel::Quartic,
    Kernel::Compact6,
];

/// Kernels that never end, or are cut off.
const ENDLESS: [Kernel; 5] = [
    Kernel::Cauchy,
    Kernel::Gauss,
    Kernel::Inverse,
    Kernel::Squared,
    Kernel::Cubed,
];

/// Checks that no hit is inaccurate and no surface is missed, except surfaces of kernels that never
/// end that rays graze, as next to the poles of squared polygons: at most this share of rays.
fn certify(kinds: &[Kind], most_grazed: f64, method: Method<'_>) {
    let (mut all, mut faults) = judge(&COMPACT, kinds, 4, 4, method);
    assert!(all.faults() == 0, "{all:?}\n{faults}");
    let (endless, more) = judge(&ENDLESS, kinds, 5, 4, method);
    all.add(&endless);
    faults += &more;
    let scenes = ((count(4) + count(5)) * kinds.len()) as u64;
    assert!(all.rays > 14 * scenes && all.hits > 8 * scenes, "{all:?}");
    assert!(all.uncertain * 100 < all.rays, "{all:?}");
    assert!(all.missed == 0 && all.invented == 0, "{all:?}\n{faults}");
    let grazed = all.grazed as f64 / all.rays as f64;
    assert!(grazed <= most_grazed, "{all:?}\n{faults}");
}

/// Checks that points whose largest field on a ray has a closed form have no fault at all.
pub fn blobs(method: Method<'_>) {
    let kernels = [&[Kernel::Gauss][..], &COMPACT].concat();
    let (row, faults) = judge(&kernels, &[Kind::Point], 30, 6, method);
    assert!(row.faults() == 0, "{row:?}\n{faults}");
    assert!(row.hits > count(500) as u64, "{row:?}");
}

/// Checks points, segments, arcs, curves and tapered limbs.
pub fn points_and_lines(method: Method<'_>) {
    let lines = [Kind::Segment, Kind::Arc, Kind::Curve, Kind::Taper];
    certify(&lines, 0.002, method);
    certify(&[Kind::Point], 0.0, method);
}

/// Checks triangles, polygons and planes.
pub fn faces(method: Method<'_>) {
    let faces = [Kind::Triangle, Kind::Polygon, Kind::Plane, Kind::Restricted];
    certify(&faces, 0.002, method);
}

/// Checks profiles, smooth ones and those with kinks and jumps.
pub fn profiles(method: Method<'_>) {
    certify(&[Kind::Waves, Kind::Kinks], 0.0, method);
}

/// Checks mixtures of all, and clusters of hundreds.
pub fn mixtures_and_clusters(method: Method<'_>) {
    certify(&[Kind::Mixed], 0.002, method);
    certify(&[Kind::Cluster], 0.0, method);
}

/// Checks very many points of kernels that never end.
pub fn clouds(method: Method<'_>) {
    let endless = [
        Kernel::Cauchy,
        Kernel::Inverse,
        Kernel::Squared,
        Kernel::Cubed,
    ];
    let (row, faults) = judge(&endless, &[Kind::Cloud], 48, 4, method);
    assert!(row.faults() == 0, "{row:?}\n{faults}");
    assert!(row.hits > count(300) as u64, "{row:?}");
}

/// Checks sums of dozens of Gaussians, which packets of rays evaluate at few places.
pub fn patches(method: Method<'_>) {
    let (row, faults) = judge(&[Kernel::Gauss], &[Kind::Patch], 100, 2, method);
    assert!(row.faults() == 0, "{row:?}\n{faults}");
    assert!(row.hits > count(700) as u64, "{row:?}");
}

/// Checks that a ray that starts close to a cloud's surface is as exact as its own distance asks,
/// not that of the middle of a cell of its hierarchy.
pub fn starts_beside_a_cloud(method: Method<'_>) {
    let mut faults = String::new();
    let trial = Trial::earlier(Kernel::Cubed, Kind::Cloud, 911, 3);
    let row = check(trial, method, &mut faults);
    assert!(row.faults() == 0, "{row:?}\n{faults}");
    assert!(row.hits >= 12, "{row:?}");
}

/// Checks regressions, scenes with faults in earlier versions of the tracer: rounding, or a surface
/// along the ray, that leaves all rays in doubt; beyond the ends of Gaussian arcs; waves across a
/// needle; beside crisp Gaussian faces and a plane with a very distant crossing; a surface along
/// the ray between the kinks of profiles; grazing rays that negligible terms or rounding keep
/// outside; waves beside an arc's axis; a very thin curve whose bent-away parts counted as near;
/// crisp faces that single precision moves by more than a very fine picture's tolerance.
pub fn earlier_faults(method: Method<'_>) {
    let once = [
        (Kernel::Gauss, Kind::Arc, 89),
        (Kernel::Soft, Kind::Plane, 136),
        (Kernel::Gauss, Kind::Plane, 145),
        (Kernel::Quartic, Kind::Triangle, 121),
        (Kernel::Cauchy, Kind::Waves, 56),
        (Kernel::Gauss, Kind::Mixed, 127),
        (Kernel::Soft, Kind::Restricted, 136),
        (Kernel::Metaballs, Kind::Waves, 132),
        (Kernel::Quartic, Kind::Restricted, 56),
        (Kernel::Cauchy, Kind::Curve, 31),
        (Kernel::Cauchy, Kind::Mixed, 139),
        (Kernel::Gauss, Kind::Segment, 66),
        (Kernel::Compact6, Kind::Point, 130),
        (Kernel::Gauss, Kind::Waves, 5048),
        (Kernel::Quartic, Kind::Kinks, 108),
        (Kernel::Metaballs, Kind::Polygon, 9043),
    ];
    for (kernel, kind, seed) in once {
        recheck(kernel, kind, seed, 4, method);
    }
    // Most rays miss these.
    recheck(Kernel::Quartic, Kind::Taper, 5031, u64::MAX, method);
}

/// Checks three more regressions, whose reference takes seconds.
pub fn earlier_faults_that_are_hard_to_judge(method: Method<'_>) {
    let once = [
        (Kernel::Gauss, Kind::Polygon, 138),
        (Kernel::Inverse, Kind::Mixed, 76),
        (Kernel::Compact6, Kind::Mixed, 16),
    ];
    for (kernel, kind, seed) in once.into_iter().take(count(3)) {
        recheck(kernel, kind, seed, 4, method);
    }
}

/// Checks that a scene of an earlier fault has none, and that more than one ray in `least` hits.
fn recheck(kernel: Kernel, kind: Kind, seed: u64, least: u64, method: Method<'_>) {
    let mut faults = String::new();
    let row = check(Trial::earlier(kernel, kind, seed, 8), method, &mut faults);
    let name = format!("{kernel:?} {kind:?} {seed}");
    assert!(row.faults() == 0, "{name} {row:?}\n{faults}");
    assert!(row.hits > row.rays / least, "{name} {row:?}");
}
