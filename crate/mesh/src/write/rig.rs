//! Rigs: joints that move the vertices of a mesh, in GLB files.

use crate::error::{Error, fail};
use glam::{DQuat, DVec3};

/// The most joints of a rig.
const MOST_JOINTS: usize = 4096;
/// The most poses of all joints in all frames.
const MOST_POSES: usize = 4_000_000;

/// Joint's number and its weight for a vertex.
pub type Share = (u16, f32);

/// Joint. At rest it is not turned.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// Name; may be empty.
    pub name: String,
    /// The joint that it hangs on, one of those before it; `None` for a root.
    pub parent: Option<usize>,
    /// Place at rest, in units of the mesh.
    pub place: DVec3,
}

/// Place of a joint, and its rotation from rest; both in the coordinates of the mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Place of the joint.
    pub place: DVec3,
    /// Rotation from rest, a unit quaternion.
    pub turn: DQuat,
}

/// Joints, the vertices that they take along, and how they move.
///
/// A vertex v goes to `Σ wᵢ (pᵢ + Rᵢ(v − rᵢ))`, where joint i has the weight wᵢ, is at rest at rᵢ,
/// and in the frame at pᵢ with the turn Rᵢ.
///
/// ```
/// use glam::{DQuat, DVec3};
/// use mesh::{Export, Joint, Part, Pose, Rig, TriangleMesh};
///
/// let mesh = TriangleMesh::new(vec![DVec3::ZERO, DVec3::X, DVec3::Y], vec![[0, 1, 2]]);
/// let export = Export {
///     name: "flag".into(),
///     parts: vec![Part { name: "cloth".into(), mesh }],
///     millimetres: 1000.0,
/// };
/// let joint = Joint { name: "pole".into(), parent: None, place: DVec3::ZERO };
/// let at = |x| vec![Pose { place: DVec3::X * x, turn: DQuat::IDENTITY }];
/// let rig = Rig {
///     joints: vec![joint],
///     shares: vec![vec![[(0, 1.0), (0, 0.0), (0, 0.0), (0, 0.0)]; 3]],
///     frames: vec![at(0.0), at(1.0)],
///     rate: 25.0,
/// };
/// let file = export.write_rigged(&rig)?;
/// assert_eq!(file.name, "flag.glb");
/// # Ok::<(), mesh::Error>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rig {
    /// The joints, parents first.
    pub joints: Vec<Joint>,
    /// Shares of each vertex of each part of the export that has triangles: the joints that
    /// move it. Weights add up to 1.
    pub shares: Vec<Vec<[Share; 4]>>,
    /// The poses of all joints in each frame; no animation is written of fewer than two frames.
    pub frames: Vec<Vec<Pose>>,
    /// Frames per second.
    pub rate: f64,
}

impl Rig {
    /// The poses at rest.
    #[must_use]
    pub fn rest(&self) -> Vec<Pose> {
        let joints = self.joints.iter();
        joints
            .map(|joint| Pose {
                place: joint.place,
                turn: DQuat::IDENTITY,
            })
            .collect()
    }

    /// Returns the place to which the joints take a vertex: `Σ wᵢ (pᵢ + Rᵢ(v − rᵢ))`.
    #[must_use]
    pub fn skin(&self, vertex: DVec3, shares: &[Share; 4], frame: &[Pose]) -> DVec3 {
        shares.iter().fold(DVec3::ZERO, |sum, &(joint, weight)| {
            let (pose, rest) = (&frame[joint as usize], self.joints[joint as usize].place);
            sum + (pose.place + pose.turn * (vertex - rest)) * f64::from(weight)
        })
    }

    /// Computes each joint's translation, millimetres, and rotation from its parent's coordinates.
    pub(super) fn local(&self, frame: &[Pose], millimetres: f64) -> Vec<([f32; 3], [f32; 4])> {
        let joints = self.joints.iter().zip(frame);
        joints
            .map(|(joint, pose)| {
                let (place, turn) = match joint.parent {
                    Some(parent) => {
                        let back = frame[parent].turn.conjugate();
                        (back * (pose.place - frame[parent].place), back * pose.turn)
                    }
                    None => (pose.place, pose.turn),
                };
                let place = (place * millimetres).to_array().map(|x| x as f32);
                (place, turn.to_array().map(|x| x as f32))
            })
            .collect()
    }

    pub(super) fn check(&self, vertices: &[usize]) -> Result<(), Error> {
        let joints = self.joints.len();
        if joints == 0 || joints > MOST_JOINTS {
            return fail(format!(
                "a rig has 1 to {MOST_JOINTS} joints, this one has {joints}"
            ));
        }
        if !self
            .joints
            .iter()
            .enumerate()
            .all(|(i, joint)| joint.parent.is_none_or(|p| p < i))
        {
            return fail("a joint stands before the one that it hangs on");
        }
        if self.frames.len().saturating_mul(joints) > MOST_POSES {
            return fail("this rig has too many frames; write fewer");
        }
        let numbers = self.shares.iter().map(Vec::len);
        if !numbers.eq(vertices.iter().copied()) {
            return fail("a rig has shares for as many vertices as there are");
        }
        let mut shares = self.shares.iter().flatten().flatten();
        if !shares.all(|(joint, weight)| (*joint as usize) < joints && (0.0..=1.0).contains(weight))
        {
            return fail("a rig has a share of no joint, or out of range");
        }
        let mut poses = self.frames.iter().flatten();
        if self.frames.iter().any(|frame| frame.len() != joints)
            || !poses.all(|pose| pose.place.is_finite() && pose.turn.is_normalized())
        {
            return fail("a rig has a frame without a sound pose for each joint");
        }
        let sound = self.rate > 0.0 && self.rate.is_finite();
        if !sound || !self.joints.iter().all(|joint| joint.place.is_finite()) {
            return fail("a rig has a number that is not finite");
        }
        Ok(())
    }
}
