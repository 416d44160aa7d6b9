//! The hierarchy of far fields: its polynomials and lists add up to the field within the stated
//! bounds, and it is as large as the number of primitives asks for.
use field::far_field::{Cell, MOST_ERROR};
use field::{
    Ball, BlobScale, FarField, Implicit, Kernel, Primitive, Shaping, Skeleton, Slack, Sum,
};
use glam::DVec3;
use std::sync::Arc;
use trials::{Random, count};

const ENDLESS: [Kernel; 4] = [
    Kernel::Cauchy,
    Kernel::Inverse,
    Kernel::Squared,
    Kernel::Cubed,
];

fn primitive(kernel: Kernel, kind: usize, size: f64, n: &mut Random) -> Primitive {
    let a = n.vector(1.0);
    let [b, c] = [0, 1].map(|_| a + n.vector(1.0) * size * 4.0);
    let skeleton = match kind {
        0 => Skeleton::Point { center: a },
        1 => Skeleton::Segment { base: a, apex: b },
        2 => Skeleton::Triangle { corners: [a, b, c] },
        _ => Skeleton::Arc {
            center: a,
            u: DVec3::X,
            v: n.vector(1.0),
            radius: size * 3.0,
            angle: 1.0 + 4.0 * n.unit(),
        },
    };
    let shaping = Shaping {
        kernel,
        radius: size * (0.3 + n.unit()),
        blobbiness: 1.0 + 3.0 * n.unit(),
        blob_scale: BlobScale::Relative,
        strength: if n.unit() < 0.2 { -0.5 } else { 1.0 },
        influence: 1e-3,
        taper: None,
    };
    Primitive::new(skeleton, &shaping, None).expect("flesh")
}

/// Returns a cell at a depth around a place.
fn descend<'c>(
    field: &'c FarField,
    primitives: &[Primitive],
    place: DVec3,
    depth: u32,
) -> &'c Arc<Cell> {
    (0..depth).fold(field.root(primitives), |cell, _| {
        field.part(primitives, cell, cell.part_of(place))
    })
}

/// Sums in double precision of all primitives that are not near.
fn far(primitives: &[Primitive], cell: &Cell, place: DVec3) -> f64 {
    (0..)
        .zip(primitives)
        .filter(|(i, _)| cell.near.binary_search(i).is_err())
        .map(|(_, p)| p.value(place.to_array()))
        .sum()
}

#[test]
fn polynomials_are_within_their_bounds() {
    let mut n = Random::new(7);
    let (mut checked, mut tightest, mut listed, mut all) = (0, 0.0f64, 0, 0);
    for case in 0..48 {
        let kernel = ENDLESS[case % 4];
        let kind = case / 4 % 4;
        let number = [30, 200, 600][case / 16];
        // The more there are the smaller, so that the field is about T somewhere.
        let size = 0.5 / f64::from(number).sqrt();
        let primitives: Vec<Primitive> = (0..number)
            .map(|i| primitive(kernel, if i % 8 == 0 { 0 } else { kind }, size, &mut n))
            .collect();
        let field = FarField::new(&primitives, DVec3::ZERO, 4.0);
        for _ in 0..count(12) {
            let depth = 2 + n.below(6) as u32;
            let cell = descend(&field, &primitives, 1.5 * n.vector(1.0), depth);
            assert!(cell.error.is_finite());
            listed += cell.near.len();
            all += primitives.len();
            if cell.near.len() == primitives.len() {
                continue;
            }
            for _ in 0..12 {
                let local = n.vector(1.0);
                let place = cell.center + local * cell.reach();
                let want = far(&primitives, cell, place);
                let told = cell.expansion.jet(local.to_array(), f64::from).value;
                let off = (told - want).abs();
                assert!(
                    off <= cell.error,
                    "{kernel:?} {kind} {depth}: {off} {}",
                    cell.error
                );
                assert!(want <= cell.far_most);
                let whole: f64 = primitives.iter().map(|p| p.value(place.to_array())).sum();
                assert!(whole <= cell.most);
                tightest = tightest.max(off / cell.error);
                checked += 1;
            }
        }
    }
    assert!(
        checked > count(2000) && tightest > 0.02,
        "{checked} {tightest}"
    );
    assert!(listed * 3 < all * 2, "{listed} of {all}");
}

/// Errors stay below the limit where rounding does not count, and the slope of the polynomial is
/// that of the field.
#[test]
fn balls_have_small_errors_and_true_slopes() {
    let mut n = Random::new(3);
    for kernel in ENDLESS {
        let primitives: Vec<Primitive> = (0..400)
            .map(|_| primitive(kernel, 0, 0.02, &mut n))
            .collect();
        let field = FarField::new(&primitives, DVec3::ZERO, 2.0);
        let mut far_ones = 0;
        for _ in 0..count(30) {
            let cell = descend(&field, &primitives, n.vector(1.0), 4);
            let rounding = 2e-4 * cell.far_most.abs().max(0.1);
            assert!(cell.error <= MOST_ERROR + rounding, "{}", cell.error);
            far_ones += primitives.len() - cell.near.len();
            let local = n.vector(1.0) * 0.6;
            let place = cell.center + local * cell.reach();
            let slope = (0..)
                .zip(&primitives)
                .filter(|(i, _)| cell.near.binary_search(i).is_err())
                .fold(DVec3::ZERO, |sum, (_, p)| {
                    sum + DVec3::from_array(p.jet(place.to_array()).gradient)
                });
            let told = cell.expansion.jet(local.to_array(), f64::from).gradient;
            let told = DVec3::from_array(told) / cell.reach();
            // Markov's inequality: a polynomial of degree 5 with this error has at most 25 times
            // its slope.
            let most = 40.0 * cell.error / cell.reach();
            assert!(told.distance(slope) <= most, "{kernel:?} {told} {slope}");
        }
        // A field that falls as 1/r is far larger than T here, and needs as many more digits.
        let least = if kernel == Kernel::Inverse { 100 } else { 200 };
        assert!(far_ones > count(30) * least, "{kernel:?} {far_ones}");
    }
}

/// Lists get short, and the work that all cells around the primitives take grows about as their
/// number.
#[test]
fn work_is_about_linear() {
    let mut work = Vec::new();
    for count in [500u32, 4000] {
        let mut n = Random::new(11);
        let size = 0.4 / libm::cbrt(f64::from(count));
        let primitives: Vec<Primitive> = (0..count)
            .map(|_| primitive(Kernel::Cauchy, 0, size, &mut n))
            .collect();
        let field = FarField::new(&primitives, DVec3::ZERO, 1.0);
        let mut stack = vec![field.root(&primitives)];
        let (mut candidates, mut cells) = (0usize, 0usize);
        while let Some(cell) = stack.pop() {
            cells += 1;
            if cell.half < 2.0 * size {
                continue;
            }
            for number in 0..8 {
                candidates += cell.near.len();
                stack.push(field.part(&primitives, cell, number));
            }
        }
        work.push([candidates as f64, cells as f64].map(|w| w / f64::from(count)));
    }
    let [few, many] = [work[0], work[1]];
    // Eight times as many: more levels, of which each costs the same for every primitive.
    assert!(many[0] < 3.0 * few[0], "{few:?} {many:?}");
    assert!(many[1] < 2.0 * few[1], "{few:?} {many:?}");
}

/// Cells that are left empty where only the surface counts have a field below T, and most of
/// space is such.
#[test]
fn empty_cells_hold_no_surface() {
    let mut n = Random::new(9);
    let (mut empty, mut highest) = (0, 0.0f64);
    for kernel in ENDLESS {
        let primitives: Vec<Primitive> = (0..100)
            .map(|i| primitive(kernel, i % 2, 0.02, &mut n))
            .collect();
        let field = FarField::new(&primitives, DVec3::ZERO, 2.0).surface_only();
        for _ in 0..count(200) {
            let place = 2.0 * n.vector(1.0);
            let cell = descend(&field, &primitives, place, 6);
            if !cell.is_empty {
                continue;
            }
            empty += 1;
            for _ in 0..20 {
                let within = (cell.center + n.vector(1.0) * cell.reach()).to_array();
                let value: f64 = primitives.iter().map(|p| p.value(within)).sum();
                assert!(value <= cell.most && cell.most < 1.0, "{kernel:?} {value}");
                highest = highest.max(value);
            }
        }
    }
    assert!(empty > count(200) && highest > 0.3, "{empty} {highest}");
}

/// A field of cells depends on the primitives alone, not on the order in which cells are asked for.
#[test]
fn cells_are_the_same_in_any_order() {
    let mut n = Random::new(5);
    let primitives: Vec<Primitive> = (0..300)
        .map(|_| primitive(Kernel::Cauchy, 0, 0.03, &mut n))
        .collect();
    let places: Vec<DVec3> = (0..20).map(|_| n.vector(1.0)).collect();
    let [a, b] = [0, 1].map(|_| FarField::new(&primitives, DVec3::ZERO, 2.0));
    for place in places.iter().rev() {
        descend(&b, &primitives, *place, 5);
    }
    for place in &places {
        let [x, y] = [&a, &b].map(|field| descend(field, &primitives, *place, 5));
        assert_eq!(x.near, y.near);
        let value = |cell: &Cell| cell.expansion.jet([0.3, -0.2, 0.5], f64::from).value;
        assert_eq!(value(x).to_bits(), value(y).to_bits());
    }
}

/// After an edit of few primitives a hierarchy takes over most of an earlier one's cells, and has
/// the same bits as one made anew.
#[test]
fn edits_give_the_bits_of_a_fresh_hierarchy() {
    let mut n = Random::new(17);
    for case in 0..9 {
        let kinds = [1, 2, 4][case % 3];
        let mut primitives: Vec<Primitive> = (0..500)
            .map(|i| primitive(Kernel::Cauchy, i % kinds, 0.02, &mut n))
            .collect();
        let make = |primitives: &[Primitive]| {
            let field = FarField::new(primitives, DVec3::ZERO, 2.0);
            match case / 3 {
                0 => field,
                1 => field.surface_only(),
                _ => field.with_derivatives(),
            }
        };
        let mut places: Vec<DVec3> = (0..30).map(|_| n.vector(1.0)).collect();
        let mut field = make(&primitives);
        for place in &places {
            descend(&field, &primitives, *place, 7);
        }
        for _ in 0..count(4) {
            let moved = n.below(500);
            primitives[moved] = primitive(Kernel::Cauchy, 0, 0.02, &mut n);
            places[0] = primitives[moved].blob_middle();
            let changed: Arc<[u32]> = [moved as u32].into();
            let [old, fresh] = [field, make(&primitives)];
            field = make(&primitives).after(Some(&old), &changed);
            let (mut taken, mut all) = (0, 0);
            for place in &places {
                for depth in 0..=7 {
                    let [own, new] =
                        [&field, &fresh].map(|field| descend(field, &primitives, *place, depth));
                    assert_eq!(own.near, new.near);
                    let bits = |cell: &Cell| {
                        let bounds = [cell.error, cell.far_least, cell.far_most, cell.most];
                        let jet = cell.expansion.jet([0.3, -0.2, 0.5], f64::from);
                        let all = bounds
                            .into_iter()
                            .chain([jet.value, cell.smooth.slope_error]);
                        let all = all.chain(jet.gradient).chain(cell.smooth.derivatives);
                        all.map(f64::to_bits).collect::<Vec<_>>()
                    };
                    assert_eq!(bits(own), bits(new));
                    let before = descend(&old, &primitives, *place, depth);
                    taken += usize::from(own.has_part_of(before));
                    all += usize::from(!own.is_empty);
                }
            }
            // Few small cells are not empty if the surface alone is looked for.
            let least = if case / 3 == 1 { 20 } else { 4 };
            assert!(taken * least > all, "case {case}: {taken} of {all}");
        }
    }
}

/// Gradients are no further off than the bound, derivatives no larger than theirs, and both bounds
/// are of use.
#[test]
fn slopes_are_within_their_bounds() {
    let mut n = Random::new(31);
    for case in 0..16 {
        let kernel = ENDLESS[case % 4];
        let kind = case / 4;
        let primitives: Vec<Primitive> = (0..300)
            .map(|_| primitive(kernel, kind, 0.02, &mut n))
            .collect();
        let field = FarField::new(&primitives, DVec3::ZERO, 2.0).with_derivatives();
        let (mut checked, mut worst, mut steepest) = (0, 0.0f64, 0.0f64);
        for _ in 0..count(40) {
            let center = n.vector(1.0);
            let radius = 0.05 * n.unit();
            let cell = field
                .around(&primitives, center, radius)
                .expect("in the cube");
            if cell.near.len() == primitives.len() {
                continue;
            }
            for _ in 0..8 {
                let place = center + n.vector(1.0).clamp_length_max(1.0) * radius;
                let of =
                    |p: &Primitive, at: DVec3| DVec3::from_array(p.jet(at.to_array()).gradient);
                let far = |at: DVec3| {
                    (0..)
                        .zip(&primitives)
                        .filter(|(i, _)| cell.near.binary_search(i).is_err())
                        .fold(DVec3::ZERO, |sum, (_, p)| sum + of(p, at))
                };
                let want = far(place);
                let told = DVec3::from_array(cell.jet(place).gradient);
                let [slope, curvature, third] = cell.smooth.derivatives;
                let off = told.distance(want);
                assert!(off <= cell.smooth.slope_error, "{kernel:?} {kind}: {off}");
                assert!(want.length() <= slope, "{kernel:?} {kind}: {want} {slope}");
                let along = n.vector(1.0).normalize();
                let h = 1e-3 * cell.half;
                let [a, b] = [-h, h].map(|h| far(place + along * h).dot(along));
                let bend = (b - a) / (2.0 * h);
                assert!(bend.abs() <= curvature * 1.001, "{kernel:?} {bend}");
                let twist = (a + b - 2.0 * want.dot(along)) / (h * h);
                assert!(twist.abs() <= third * 1.1 + 1e-3, "{kernel:?} {twist}");
                worst = worst.max(off / cell.smooth.slope_error);
                steepest = steepest.max(want.length() / slope);
                checked += 1;
            }
        }
        // Bounds add up where slopes cancel, and rounding of coordinates is bounded for the worst.
        let [least, steep] = [1e-5, 0.01];
        assert!(
            checked > count(60) && worst > least && steepest > steep,
            "{kernel:?} {kind}: {checked} {worst} {steepest}"
        );
    }
}

/// The cell for a ball holds it in its loose cube; outside the hierarchy's cube there is none.
#[test]
fn cells_around_balls_hold_them() {
    let mut n = Random::new(77);
    let primitives: Vec<Primitive> = (0..500)
        .map(|_| primitive(Kernel::Cauchy, 0, 0.02, &mut n))
        .collect();
    let field = FarField::new(&primitives, DVec3::ZERO, 2.0);
    let mut sizes = Vec::new();
    for _ in 0..count(200) {
        let (center, radius) = (n.vector(1.0), n.unit() * n.unit() * 0.3);
        let cell = field.around(&primitives, center, radius).expect("a cell");
        let reach = (center - cell.center).abs().max_element() + radius;
        assert!(reach <= cell.reach());
        sizes.push(cell.half);
    }
    assert!(sizes.iter().any(|half| *half < 0.2) && sizes.iter().any(|half| *half > 0.4));
    let nowhere = [DVec3::X * 2.1, DVec3::splat(f64::NAN)];
    for center in nowhere {
        assert!(field.around(&primitives, center, 0.0).is_none());
    }
    assert!(
        field
            .around(&primitives, DVec3::ZERO, f64::INFINITY)
            .is_none()
    );
}

/// The hierarchy of some of the primitives sums these alone.
#[test]
fn parts_of_the_sum_have_hierarchies() {
    let mut n = Random::new(15);
    let primitives: Vec<Primitive> = (0..400)
        .map(|i| primitive(Kernel::Squared, i % 2, 0.02, &mut n))
        .collect();
    let all = FarField::new(&primitives, DVec3::ZERO, 2.0);
    let odd = all.of_positive(|i| i % 2 == 1);
    let mut largest = 0.0f64;
    for _ in 0..count(100) {
        let place = n.vector(1.0);
        let cell = odd.around(&primitives, place, 0.0).expect("a cell");
        let of = |p: &Primitive| p.value(place.to_array());
        let near: f64 = cell.near.iter().map(|i| of(&primitives[*i as usize])).sum();
        let chosen = primitives.iter().skip(1).step_by(2);
        let want: f64 = chosen.map(of).filter(|value| *value > 0.0).sum();
        let off = (near + cell.jet(place).value - want).abs();
        assert!(off <= cell.error + 1e-12 * want, "{off}");
        assert!(cell.near.iter().all(|i| i % 2 == 1));
        largest = largest.max(off);
    }
    assert!(largest > 0.0);
}

/// Sums use their hierarchy where the caller bears its error, and only there.
#[test]
fn sums_are_as_exact_as_is_asked() {
    let mut n = Random::new(8);
    let kernel = Kernel::Cauchy;
    let primitives: Vec<Primitive> = (0..2000)
        .map(|i| primitive(kernel, i % 3, 0.008, &mut n))
        .collect();
    let sum = Sum::new(primitives);
    let (mut shortened, mut largest) = (0, 0.0f64);
    for _ in 0..count(200) {
        let ball = Ball {
            center: n.vector(1.0),
            radius: 0.02 * n.unit(),
        };
        let point = ball.center + n.vector(1.0).clamp_length_max(1.0) * ball.radius;
        let want = sum.jet(point);
        let error = 2e-4;
        let [exact, slack] = [0.0, error].map(|far| Slack {
            left_out: 1e-9,
            far,
        });
        assert!(
            sum.narrow(ball, None, exact)
                .is_none_or(|part| part.far.is_none())
        );
        let Some(part) = sum.narrow(ball, None, slack) else {
            continue;
        };
        assert!(part.error()[0] <= error && part.far.is_some());
        let told = sum.jet_of(&part, point);
        let off = (told.value - want.value).abs();
        assert!(off <= part.error()[0] + 1e-9);
        largest = largest.max(off);
        let lanes = point.to_array().map(|x| wide::f32x8::splat(x as f32));
        let eight = sum.jet8_of(&part, lanes);
        for lane in [0, 7] {
            let off = f64::from(eight.value.to_array()[lane]) - told.value;
            assert!(off.abs() <= 1e-4, "{off}");
            for (slope, eight) in told.gradient.iter().zip(eight.gradient) {
                let off = f64::from(eight.to_array()[lane]) - slope;
                assert!(
                    off.abs() <= 1e-3 * (1.0 + DVec3::from_array(told.gradient).length()),
                    "{off}"
                );
            }
        }
        let bounds = sum.variation(Some(&part), ball).range;
        assert!(bounds.value[0] <= want.value && want.value <= bounds.value[1]);
        assert!(DVec3::from_array(want.gradient).length() <= bounds.slope);
        shortened += usize::from(part.terms.len() < 300);
        // A part of the part.
        let inner = Ball {
            radius: 0.3 * ball.radius,
            ..ball
        };
        if let Some(smaller) = sum.narrow(inner, Some(&part), slack) {
            let want = sum.jet(ball.center);
            let told = sum.jet_of(&smaller, ball.center);
            assert!((told.value - want.value).abs() <= smaller.error()[0] + 2e-9);
        }
    }
    assert!(
        shortened > count(150) && largest > 1e-9,
        "{shortened} {largest}"
    );
}
