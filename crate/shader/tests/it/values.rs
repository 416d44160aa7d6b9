//! Values and gradients on an adapter against those of `field` in single precision.

use crate::gpu::gpu;
use field::{BlobScale, Kernel, Primitive, Profile, Shaping, THRESHOLD, Taper, Wave};
use glam::DVec3;
use shader::cells::all;
use trials::skeletons::Kind;
use trials::{Random, count};

/// Points for each element.
const EACH: usize = 100;

/// Returns a random element of a cell.
fn element(random: &mut Random, kernel: Kernel, bone: &str) -> Option<Primitive> {
    let mut taper = None;
    let blobbiness = random.decades(-1.0, 1.0);
    let kind = match bone {
        "point" => Kind::Point,
        "segment" => Kind::Segment,
        "arc" => Kind::Arc,
        "triangle" => Kind::Triangle,
        "plane" => Kind::Plane,
        "curve" => Kind::Curve,
        _ => {
            let other = random.decades(-0.7, 0.7);
            taper = Some(Taper {
                radius: random.range(0.2, 2.0),
                // Cones of compact kernels have the same all along.
                blobbiness: if bone == "cone" { blobbiness } else { other },
            });
            match bone {
                "cone" => Kind::Segment,
                _ => random.pick(&[Kind::Segment, Kind::Arc, Kind::Curve]),
            }
        }
    };
    let size = random.decades(-1.5, 1.0);
    let skeleton = random.skeleton(kind, size);
    let shaping = Shaping {
        kernel,
        radius: 1.0,
        blobbiness,
        blob_scale: BlobScale::Relative,
        strength: random.pick(&[1.0, 1.5, -1.0]),
        influence: 1e-3,
        taper,
    };
    Primitive::new(skeleton, &shaping, None)
        .filter(|primitive| primitive.term().cell() == [kernel.name(), bone])
}

/// Returns a point near an element where its field counts, and is not that of a pole.
fn point(random: &mut Random, primitive: &Primitive) -> Option<[f32; 3]> {
    let near = random.near(&primitive.skeleton, -2.0, 0.5);
    let point = near.to_array().map(|x| x as f32);
    let far_enough =
        !primitive.kernel.has_pole() || primitive.skeleton.distance(near) * primitive.width > 1e-2;
    let value = f64::from(primitive.jet(point).value);
    (far_enough && value.abs() >= THRESHOLD / 10.0).then_some(point)
}

fn vector(gradient: [f32; 3]) -> DVec3 {
    DVec3::from_array(gradient.map(f64::from))
}

#[test]
fn cells_are_as_in_single_precision() {
    let Some(gpu) = gpu() else { return };
    let (mut failed, mut tested) = (Vec::new(), 0);
    for cell in all() {
        let Some((kernel, bone)) = cell.name.split_once('_') else {
            continue;
        };
        let Some(kernel) = Kernel::named(kernel) else {
            continue;
        };
        tested += 1;
        let mut random = Random::new(45);
        let (mut elements, mut points) = (Vec::new(), Vec::new());
        while elements.len() < count(100) as usize {
            let Some(primitive) = element(&mut random, kernel, bone) else {
                continue;
            };
            let own: Vec<_> = (0..10 * EACH)
                .filter_map(|_| point(&mut random, &primitive))
                .take(EACH)
                .collect();
            if own.len() == EACH {
                points.extend(own);
                elements.push(primitive);
            }
        }
        let terms: Vec<_> = elements.iter().map(Primitive::term).collect();
        let jets = gpu.evaluate(&cell, &terms, &points);
        let (mut worst, mut worst_slope) = (0.0_f64, 0.0_f64);
        for (i, (point, jet)) in points.iter().zip(&jets).enumerate() {
            let primitive = &elements[i / EACH];
            let want = primitive.jet(*point);
            let value = f64::from(want.value);
            // Where single precision is off by more, so may be its other order of sums.
            let exact = primitive.value(point.map(f64::from));
            let off = (f64::from(jet[0]) - value).abs() - 2.0 * (value - exact).abs();
            worst = worst.max(if off.is_nan() {
                f64::INFINITY
            } else {
                off / value.abs()
            });
            let slope = vector(want.gradient);
            let off = (vector([jet[1], jet[2], jet[3]]) - slope).length();
            // Of the steepness that the field has for its value.
            worst_slope = worst_slope.max(off / (slope.length() + value.abs() * primitive.width));
        }
        println!("{}: {worst:.1e}, gradient {worst_slope:.1e}", cell.name);
        if !(worst <= 1e-4 && worst_slope <= 1e-3) {
            failed.push(cell.name);
        }
    }
    assert!(failed.is_empty(), "{failed:?}");
    // Seven kinds of bone, and cones of the cubed and of the three polynomial kernels.
    assert_eq!(tested, 7 * Kernel::ALL.len() + 4);
}

#[test]
fn profiles_are_as_in_single_precision() {
    let Some(gpu) = gpu() else { return };
    for cell in all() {
        let skeletons = match &cell.name[..] {
            "profile_plane" => [Kind::Segment, Kind::Triangle],
            "profile_circle" => [Kind::Arc; 2],
            "profile_nowhere" => [Kind::Point, Kind::Curve],
            _ => continue,
        };
        let mut random = Random::new(46);
        let mut elements = Vec::new();
        while elements.len() < count(100) as usize {
            let profile = Profile {
                waves: [random.pick(&Wave::ALL), random.pick(&Wave::ALL)],
                scale: [random.range(-9.0, 9.0), random.range(-9.0, 9.0)],
                bounds: [random.range(-1.0, 1.0), random.range(-1.0, 1.0)],
                times: random.range(0.5, 2.0),
                restriction: random.unit(),
            };
            let kind = random.pick(&skeletons);
            let skeleton = random.skeleton(kind, 1.0);
            let shaping = trials::skeletons::shaping(1.0, 1.0);
            elements.extend(Primitive::new(skeleton, &shaping, Some(profile)));
        }
        let points: Vec<[f32; 3]> = (0..elements.len() * EACH)
            .map(|i| {
                let skeleton = &elements[i / EACH].skeleton;
                random
                    .near(skeleton, -2.0, 0.5)
                    .to_array()
                    .map(|x| x as f32)
            })
            .collect();
        let terms: Vec<_> = elements.iter().map(Primitive::term).collect();
        let factors = gpu.evaluate(&cell, &terms, &points);
        let mut off = Vec::new();
        for (i, (point, factor)) in points.iter().zip(&factors).enumerate() {
            let want = terms[i / EACH].factor(*point).expect("a profile");
            off.push((factor[0] - want.value).abs());
        }
        off.sort_unstable_by(f32::total_cmp);
        // Waves that jump do so a rounding apart.
        let index = off.len() - 1 - off.len() / 1000;
        println!(
            "{}: {:.1e}, all but 1 of 1000 {:.1e}",
            cell.name,
            off[off.len() - 1],
            off[index]
        );
        assert!(off[index] <= 1e-4, "{}: {}", cell.name, off[index]);
    }
}
