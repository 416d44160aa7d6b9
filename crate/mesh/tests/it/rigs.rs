//! Rigged GLB files, read by another reader and skinned as the format says.

use glam::{DQuat, DVec3, Mat4, Quat, Vec3};
use mesh::{Export, Joint, Part, Pose, Rig, TriangleMesh};

/// Returns a bar of three squares along x, with a joint at each end and one in the middle.
fn bar() -> (Export, Rig) {
    let mut positions = Vec::new();
    for i in 0..4 {
        positions.push(DVec3::new(f64::from(i), -0.5, 0.2));
        positions.push(DVec3::new(f64::from(i), 0.5, 0.2));
    }
    let triangles = (0..3).flat_map(|i| {
        [
            [2 * i, 2 * i + 2, 2 * i + 1],
            [2 * i + 1, 2 * i + 2, 2 * i + 3],
        ]
    });
    let shares = positions.iter().map(|p| {
        let along = (p.x / 1.5) as f32;
        if along <= 1.0 {
            [(0, 1.0 - along), (1, along), (0, 0.0), (0, 0.0)]
        } else {
            [(1, 2.0 - along), (2, along - 1.0), (0, 0.0), (0, 0.0)]
        }
    });
    let shares = vec![shares.collect()];
    let mesh = TriangleMesh::new(positions, triangles.collect());
    let joint = |name: &str, parent, x| Joint {
        name: name.into(),
        parent,
        place: DVec3::X * x,
    };
    let joints = vec![
        joint("A", None, 0.0),
        joint("B", Some(0), 1.5),
        joint("C", Some(1), 3.0),
    ];
    let frames = (0..5).map(|i| {
        let t = f64::from(i) * 0.2;
        let pose = |x: f64, turn: f64| Pose {
            place: DVec3::new(x, t * x, -t),
            turn: DQuat::from_rotation_z(turn * t) * DQuat::from_rotation_x(0.3 * t),
        };
        vec![pose(0.0, 1.0), pose(1.5, 0.5), pose(3.0, -1.0)]
    });
    let rig = Rig {
        joints,
        shares,
        frames: frames.collect(),
        rate: 25.0,
    };
    let export = Export {
        name: "bar".into(),
        parts: vec![Part {
            name: "bar".into(),
            mesh,
        }],
        millimetres: 20.0,
    };
    (export, rig)
}

/// The floats of an accessor.
fn floats(accessor: &gltf::Accessor<'_>, bytes: &[u8]) -> Vec<f32> {
    let view = accessor.view().expect("a view");
    let start = view.offset() + accessor.offset();
    let count = accessor.count() * accessor.dimensions().multiplicity();
    let numbers = bytes[start..].chunks_exact(4).take(count);
    numbers
        .map(|b| f32::from_le_bytes(b.try_into().unwrap()))
        .collect()
}

#[test]
fn another_reader_moves_the_vertices_as_the_rig_does() {
    let (export, rig) = bar();
    let file = export.write_rigged(&rig).unwrap();
    let glb = gltf::Gltf::from_slice(&file.bytes).expect("a valid file");
    let bytes = glb.blob.clone().expect("numbers");
    let skin = glb.skins().next().expect("a skin");
    let inverse = floats(&skin.inverse_bind_matrices().unwrap(), &bytes);
    let inverse: Vec<Mat4> = inverse.chunks(16).map(Mat4::from_cols_slice).collect();
    let joints: Vec<usize> = skin.joints().map(|joint| joint.index()).collect();
    assert_eq!(
        skin.joints()
            .map(|j| j.name().unwrap().to_owned())
            .collect::<Vec<_>>(),
        ["A", "B", "C"]
    );
    let primitive = glb.meshes().next().unwrap().primitives().next().unwrap();
    let reader = primitive.reader(|_| Some(&bytes));
    let positions: Vec<[f32; 3]> = reader.read_positions().unwrap().collect();
    let numbers: Vec<[u16; 4]> = reader.read_joints(0).unwrap().into_u16().collect();
    let weights: Vec<[f32; 4]> = reader.read_weights(0).unwrap().into_f32().collect();
    let animation = glb.animations().next().expect("an animation");
    assert_eq!(animation.channels().count(), 6);
    for (number, frame) in rig.frames.iter().enumerate() {
        // The local transforms of all nodes, those of the animation put in.
        let mut local: Vec<Mat4> = glb
            .nodes()
            .map(|node| Mat4::from_cols_array_2d(&node.transform().matrix()))
            .collect();
        for node in &joints {
            let (mut place, mut turn) = (Vec3::ZERO, Quat::IDENTITY);
            for channel in animation
                .channels()
                .filter(|c| c.target().node().index() == *node)
            {
                let times = floats(&channel.sampler().input(), &bytes);
                assert!((times[number] - number as f32 / 25.0).abs() < 1e-6);
                let values = floats(&channel.sampler().output(), &bytes);
                match channel.target().property() {
                    gltf::animation::Property::Translation => {
                        place = Vec3::from_slice(&values[3 * number..]);
                    }
                    _ => turn = Quat::from_slice(&values[4 * number..]),
                }
            }
            local[*node] = Mat4::from_rotation_translation(turn, place);
        }
        let mut global = local.clone();
        let mut stack: Vec<(gltf::Node<'_>, Mat4)> = glb
            .scenes()
            .next()
            .unwrap()
            .nodes()
            .map(|n| (n, Mat4::IDENTITY))
            .collect();
        while let Some((node, above)) = stack.pop() {
            global[node.index()] = above * local[node.index()];
            stack.extend(node.children().map(|child| (child, global[node.index()])));
        }
        for (i, position) in positions.iter().enumerate() {
            let mut moved = Vec3::ZERO;
            for k in 0..4 {
                let joint = numbers[i][k] as usize;
                let matrix = global[joints[joint]] * inverse[joint];
                moved += matrix.transform_point3(Vec3::from(*position)) * weights[i][k];
            }
            // Metres: 20 mm a unit.
            let own = export.parts[0].mesh.positions[i];
            let expected = rig.skin(own, &rig.shares[0][i], frame) * 0.02;
            assert!(
                moved.as_dvec3().distance(expected) < 1e-6,
                "{number} {i}: {moved} {expected}"
            );
        }
    }
    // At rest the reader of our own finds the plain mesh.
    let plain = mesh::read("bar.glb", &file.bytes).unwrap();
    assert_eq!(plain.triangles.len(), 6);
}

#[test]
fn rigs_that_do_not_fit_are_refused() {
    let (export, rig) = bar();
    let refused = |change: &dyn Fn(&mut Rig)| {
        let mut rig = rig.clone();
        change(&mut rig);
        assert!(export.write_rigged(&rig).is_err());
    };
    refused(&|rig| rig.joints.clear());
    refused(&|rig| rig.joints[0].parent = Some(2));
    refused(&|rig| rig.joints[1].place = DVec3::NAN);
    refused(&|rig| rig.shares.clear());
    refused(&|rig| _ = rig.shares[0].pop());
    refused(&|rig| rig.shares[0][0][0] = (3, 1.0));
    refused(&|rig| rig.shares[0][0][0] = (0, f32::NAN));
    refused(&|rig| _ = rig.frames[1].pop());
    refused(&|rig| rig.frames[1][0].turn = DQuat::from_xyzw(0.0, 0.0, 0.0, 2.0));
    refused(&|rig| rig.rate = 0.0);
}
