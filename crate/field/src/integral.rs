//! Integrals of functions of one variable, by adaptive bisection.

/// Nodes in [0, 1) and weights of Kronrod's 15-point rule, and weights of the 7-point Gauss rule
/// within it (0 at nodes it lacks).
const NODES: [(f64, f64, f64); 8] = [
    (0.0, 0.209_482_141_084_727_82, 0.417_959_183_673_469_4),
    (0.207_784_955_007_898_48, 0.204_432_940_075_298_89, 0.0),
    (
        0.405_845_151_377_397_2,
        0.19035057806478541,
        0.381_830_050_505_118_9,
    ),
    (0.586_087_235_467_691_1, 0.169_004_726_639_267_9, 0.0),
    (
        0.741_531_185_599_394_5,
        0.140_653_259_715_525_92,
        0.279_705_391_489_276_64,
    ),
    (0.864_864_423_359_769_1, 0.104_790_010_322_250_19, 0.0),
    (
        0.949_107_912_342_758_5,
        0.063_092_092_629_978_56,
        0.129_484_966_168_869_7,
    ),
    (0.991_455_371_120_812_6, 0.022935322010529225, 0.0),
];

/// Deepest bisection; a panel is then 2⁻⁴⁰ of the whole.
const DEPTH: u32 = 40;

/// The integral of f from the first to the last of `breaks`, by bisection of the panels between
/// them until Gauss and Kronrod agree to `tolerance` (relative to the integral of |f|).
///
/// Good to better than that where f is smooth between breaks; a jump or a kink costs time. Breaks
/// must be close enough that a first look with 15 nodes a panel finds every peak.
pub fn integral(f: &mut impl FnMut(f64) -> f64, breaks: &[f64], tolerance: f64) -> f64 {
    integral_within(f, breaks, tolerance, 0.0)
}

/// Computes the integral of a function that is known within `rounding`: panels whose error is no
/// larger than that times their width are not bisected.
pub(crate) fn integral_within(
    f: &mut impl FnMut(f64) -> f64,
    breaks: &[f64],
    tolerance: f64,
    rounding: f64,
) -> f64 {
    let panels: Vec<_> = breaks
        .windows(2)
        .map(|ends| (ends[0], ends[1], panel(f, ends[0], ends[1])))
        .collect();
    let scale: f64 = panels.iter().map(|(_, _, p)| p.size).sum();
    panels
        .into_iter()
        .map(|(low, high, p)| {
            let within = (tolerance * scale).max(rounding * (high - low));
            refine(f, low, high, p, within, DEPTH)
        })
        .sum()
}

/// Computes the integral from `low` to `high`, for which one panel is mostly enough.
pub fn of_one_panel(f: &mut impl FnMut(f64) -> f64, low: f64, high: f64, tolerance: f64) -> f64 {
    let whole = panel(f, low, high);
    let tolerance = tolerance * whole.size;
    refine(f, low, high, whole, tolerance, DEPTH)
}

struct Panel {
    kronrod: f64,
    error: f64,
    size: f64,
}

fn panel(f: &mut impl FnMut(f64) -> f64, a: f64, b: f64) -> Panel {
    let (middle, half) = ((a + b) / 2.0, (b - a) / 2.0);
    let (mut kronrod, mut gauss, mut size) = (0.0, 0.0, 0.0);
    for (i, (x, wk, wg)) in NODES.into_iter().enumerate() {
        let high = f(middle + half * x);
        let low = if i == 0 { 0.0 } else { f(middle - half * x) };
        kronrod += wk * (high + low);
        gauss += wg * (high + low);
        size += wk * (high.abs() + low.abs());
    }
    Panel {
        kronrod: kronrod * half,
        error: ((kronrod - gauss) * half).abs(),
        size: (size * half).abs(),
    }
}

fn refine(
    f: &mut impl FnMut(f64) -> f64,
    a: f64,
    b: f64,
    whole: Panel,
    tolerance: f64,
    depth: u32,
) -> f64 {
    // The Gauss rule's error bounds the Kronrod rule's generously.
    if whole.error <= tolerance || depth == 0 {
        return whole.kronrod;
    }
    let middle = (a + b) / 2.0;
    let (left, right) = (panel(f, a, middle), panel(f, middle, b));
    refine(f, a, middle, left, tolerance, depth - 1)
        + refine(f, middle, b, right, tolerance, depth - 1)
}
