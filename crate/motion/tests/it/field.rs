//! The field of segments against quadrature and differences.

use glam::DVec3;

/// Simpson's rule for `∫ ds/|p − s|³`.
fn quadrature(p: DVec3, a: DVec3, b: DVec3) -> f64 {
    let count = 20_000;
    let value = |i: usize| {
        let s = a.lerp(b, i as f64 / count as f64);
        let square = p.distance_squared(s);
        1.0 / (square * square.sqrt())
    };
    let inner: f64 = (1..count)
        .map(|i| value(i) * if i % 2 == 1 { 4.0 } else { 2.0 })
        .sum();
    (value(0) + inner + value(count)) * a.distance(b) / (3 * count) as f64
}

#[test]
fn the_field_is_the_integral() {
    let (a, b) = (DVec3::new(-0.5, 0.2, 0.1), DVec3::new(1.5, -0.4, 0.7));
    let mut count = 0;
    for i in 0..5 {
        for j in 0..5 {
            for k in 0..3 {
                let p = DVec3::new(f64::from(i) - 2.1, f64::from(j) - 1.9, f64::from(k) - 1.3);
                let (value, gradient) = motion::line(p, a, b);
                let expected = quadrature(p, a, b);
                assert!(
                    (value / expected - 1.0).abs() < 1e-6,
                    "{p}: {value} {expected}"
                );
                let step = 1e-5;
                for axis in DVec3::AXES {
                    let ahead = motion::line(p + axis * step, a, b).0;
                    let behind = motion::line(p - axis * step, a, b).0;
                    let slope = (ahead - behind) / (2.0 * step);
                    let error = (gradient.dot(axis) - slope).abs();
                    assert!(error < 1e-6 * (1.0 + gradient.length()), "{p}: {error}");
                }
                count += 1;
            }
        }
    }
    assert_eq!(count, 75);
}

#[test]
fn beyond_the_ends_on_the_axis_there_is_no_pole() {
    let (value, gradient) = motion::line(DVec3::X * 3.0, DVec3::ZERO, DVec3::X);
    // ½(1/2² − 1/3²)
    assert!((value - 0.5 * (0.25 - 1.0 / 9.0)).abs() < 1e-12, "{value}");
    assert!(
        (gradient.x + (0.125 - 1.0 / 27.0)).abs() < 1e-9,
        "{gradient}"
    );
    let (value, _) = motion::line(DVec3::X * 0.5, DVec3::ZERO, DVec3::X);
    assert!(value > 1e6 && value.is_finite());
    assert_eq!(motion::line(DVec3::ZERO, DVec3::ZERO, DVec3::X).0, 0.0);
}
