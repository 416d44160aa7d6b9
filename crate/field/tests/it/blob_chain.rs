//! Blob chains add up to the bone they stand for.

use field::{Kernel, Primitive, Real, Skeleton, THRESHOLD, Taper};
use glam::DVec3;
use oracle::evaluation::primitive;
use trials::{Random, count};

/// Gaussian bones of each kind that has a chain, from short to long in kernel widths.
fn cases() -> Vec<(Primitive, f64)> {
    let mut random = Random::new(71);
    (0..count(240))
        .map(|i| {
            let size = random.decades(-2.0, 1.0);
            let length = size * random.decades(-1.0, 1.0);
            let base = random.vector(size);
            let place = |random: &mut Random| base + random.direction() * length;
            let skeleton = match i % 4 {
                0 => {
                    let along = random.direction();
                    let u = along.any_orthonormal_vector();
                    Skeleton::Arc {
                        center: base,
                        u,
                        v: along.cross(u),
                        radius: length,
                        angle: random.range(0.1, 6.2),
                    }
                }
                1 => Skeleton::Curve {
                    control: [
                        base,
                        place(&mut random),
                        place(&mut random),
                        place(&mut random),
                    ],
                },
                // Shorter than half a kernel's width.
                2 => Skeleton::Segment {
                    base,
                    apex: base + random.direction() * 0.2 * size,
                },
                _ => Skeleton::Segment {
                    base,
                    apex: place(&mut random),
                },
            };
            let taper = (i % 4 == 3).then(|| Taper {
                radius: size * random.range(0.3, 0.9),
                blobbiness: 2.0,
            });
            let shaping = field::Shaping {
                kernel: Kernel::Gauss,
                taper,
                ..trials::skeletons::shaping(
                    size,
                    if i % 4 == 2 {
                        random.range(0.5, 16.0)
                    } else {
                        random.range(0.5, 6.0)
                    },
                )
            };
            // Nodes of curves are those of single precision.
            let exact = if i % 2 == 1 { 2e-5 } else { 1e-6 };
            (primitive(skeleton, &shaping, None), exact)
        })
        .collect()
}

#[test]
fn chains_add_up_to_the_bone() {
    let mut random = Random::new(72);
    let (mut strings, mut near) = ([0; 4], 0);
    for (i, (primitive, exact)) in cases().into_iter().enumerate() {
        let Some(chain) = primitive.blob_chain() else {
            continue;
        };
        strings[i % 4] += 1;
        for _ in 0..40 {
            let blob = random.pick(&chain);
            let away = random.direction() * random.range(0.0, 3.0) / blob.scale;
            let point = blob.center + away;
            let of = |blob: &field::ChainBlob| {
                let u = blob.scale * blob.center.distance(point);
                blob.amplitude * Real::exp(-u * u)
            };
            let sum: f64 = chain.iter().map(of).sum();
            let value = primitive.value(point.to_array());
            assert!(
                (sum - value).abs() <= exact * (value + 0.01 * THRESHOLD),
                "{:?} {:?} width {} {point}: {sum} {value}",
                primitive.skeleton,
                primitive.tapered,
                primitive.width
            );
            near += usize::from(value > 0.1 * THRESHOLD);
        }
    }
    assert!(
        strings.iter().all(|&n| n > count(30)) && near > count(2000),
        "{strings:?} {near}"
    );
}

/// Bones without a chain: long straight ones, other kernels, bones that subtract, very long bones.
#[test]
fn other_bones_have_none() {
    let bone = |kernel: Kernel, strength: f64, skeleton: Skeleton| {
        let shaping = field::Shaping {
            kernel,
            strength,
            ..trials::skeletons::shaping(1.0, 1.0)
        };
        primitive(skeleton, &shaping, None).blob_chain()
    };
    let arc = |radius: f64| Skeleton::Arc {
        center: DVec3::ZERO,
        u: DVec3::X,
        v: DVec3::Y,
        radius,
        angle: 2.0,
    };
    assert!(bone(Kernel::Gauss, 1.0, arc(2.0)).is_some());
    assert!(bone(Kernel::Gauss, 1.0, arc(1000.0)).is_none());
    assert!(bone(Kernel::Gauss, -1.0, arc(2.0)).is_none());
    assert!(bone(Kernel::Cauchy, 1.0, arc(2.0)).is_none());
    let segment = Skeleton::Segment {
        base: DVec3::ZERO,
        apex: 5.0 * DVec3::X,
    };
    assert!(bone(Kernel::Gauss, 1.0, segment).is_none());
}
