//! Flesh that stands at its radius, however short its bones are (`exact`).
//!
//! A kernel's height is that of an endless line or plane ([`field::Shaping::height`]), so that a
//! bone can be cut without a bulge. The flesh of short ones is thinner than its radius, then, and
//! its tips lie within the bones. Where a material is `exact`, bones that are joined count as one:
//! a common factor on their fields and an extension of their free ends are solved such that the
//! middle of their longest run and their tips stand at the radius, as long as nothing else is
//! near. Points and planes stand there anyway.

use field::{Primitive, Shaping, Skeleton, THRESHOLD};
use glam::{DVec3, I64Vec3};
use scene::{Element, Ends, Flesh, Scene, Shape};
use std::collections::HashMap;

/// Share of the radius within which ends are joined.
const TOUCHING: f64 = 1e-6;
/// Longest extension in radii.
const LONGEST: f64 = 64.0;
/// Rounds of solving one end after the other.
const ROUNDS: usize = 40;
/// Evaluations as which the preparation of an extension counts.
const PREPARATION: usize = 30;
/// Evaluations that the exact flesh of one text may cost, a tenth of a second or so.
pub const MOST_EVALUATIONS: usize = 2_000_000;

/// Bones that are joined, by themselves.
pub struct Joined {
    /// The elements, by their indices in the scene.
    pub elements: Vec<usize>,
    /// Radius that all of them have.
    pub radius: f64,
    /// A place on a bone in the middle, and the unit vector from there to the surface.
    pub middle: (DVec3, DVec3),
    primitives: Vec<Primitive>,
    shaping: Shaping,
    tips: Vec<Tip>,
}

/// A free end.
struct Tip {
    /// Index of the element.
    element: usize,
    /// Whether it is the bone's second end.
    is_last: bool,
    place: DVec3,
    /// Unit vector out of the bone.
    way: DVec3,
}

/// Factor on the field, and the lengths by which the tips are extended.
#[derive(Clone, Debug)]
pub struct Solution {
    factor: f64,
    extensions: Vec<f64>,
}

/// Bones that are joined have this in common: body, material, frame, kernel, dimension and
/// radius.
type Key = (u32, u32, u32, &'static str, u8, u64);

/// Returns whether an element's flesh can be made exact: it is of one radius, along a segment or
/// an arc, or on a triangle.
pub fn is_fit(scene: &Scene, element: &Element) -> bool {
    let Some(flesh) = flesh_of(scene, element) else {
        return false;
    };
    let is_even = flesh.end_radius.is_none() && flesh.end_blobbiness.is_none();
    let is_plain = flesh.profile.is_none() && flesh.restriction == 0.0 && flesh.strength > 0.0;
    let is_bone = element.shape.bone().is_some_and(|bone| {
        let is_known = matches!(
            bone.skeleton,
            Skeleton::Segment { .. } | Skeleton::Arc { .. } | Skeleton::Triangle { .. }
        );
        is_known && bone.end_radius.is_none() && bone.soft_ends == [Ends::Round; 2]
    });
    is_even && is_plain && is_bone
}

/// Returns the softness of an element that is drawn soft.
fn flesh_of<'a>(scene: &'a Scene, element: &Element) -> Option<&'a Flesh> {
    let flesh = scene.flesh.get(element.flesh? as usize)?;
    scene.is_soft(element).then_some(flesh)
}

/// Finds the bones that are joined among some elements, each of which [`is_fit`].
pub fn join(scene: &Scene, elements: &[usize]) -> Vec<Joined> {
    let mut nodes = Nodes::default();
    let mut groups: Vec<Vec<usize>> = Vec::new();
    let mut group_of_node: Vec<usize> = Vec::new();
    let mut corners = Vec::with_capacity(elements.len());
    for (order, &index) in elements.iter().enumerate() {
        let element = &scene.elements[index];
        let Some(skeleton) = element.shape.skeleton() else {
            corners.push(Vec::new());
            continue;
        };
        let radius = scene.radius(element);
        let kernel = kernel_of(scene, element);
        let dimension = skeleton.dimension();
        let flesh = element.flesh.unwrap_or(0);
        let key = (
            element.body,
            flesh,
            element.frame,
            kernel,
            dimension,
            radius.to_bits(),
        );
        let own: Vec<usize> = ends_of(skeleton)
            .into_iter()
            .map(|place| nodes.find(key, place, TOUCHING * radius))
            .collect();
        // Smaller groups that the bone joins become one with the first of them.
        let mut target = groups.len();
        groups.push(vec![order]);
        for &node in &own {
            if node >= group_of_node.len() {
                group_of_node.resize(node + 1, usize::MAX);
            }
            let other = group_of_node[node];
            if other == usize::MAX || other == target {
                group_of_node[node] = target;
                continue;
            }
            let (from, to) = match groups[other].len() < groups[target].len() {
                true => (other, target),
                false => (target, other),
            };
            let moved = std::mem::take(&mut groups[from]);
            for node in moved.iter().filter_map(|&bone| corners.get(bone)).flatten() {
                let node: &usize = node;
                group_of_node[*node] = to;
            }
            groups[to].extend(moved);
            target = to;
            group_of_node[node] = to;
        }
        for &node in &own {
            group_of_node[node] = target;
        }
        corners.push(own);
    }
    let mut groups: Vec<Vec<usize>> = groups.into_iter().filter(|g| !g.is_empty()).collect();
    for group in &mut groups {
        group.sort_unstable();
    }
    groups.sort_unstable_by_key(|group| group[0]);
    groups
        .iter()
        .filter_map(|group| Joined::new(scene, elements, &corners, group))
        .collect()
}

/// Returns the name of the kernel of an element.
fn kernel_of(scene: &Scene, element: &Element) -> &'static str {
    let own = flesh_of(scene, element).and_then(|flesh| flesh.kernel);
    own.unwrap_or(element.kernel).name()
}

/// Returns the ends of a line, or the corners of a triangle.
fn ends_of(skeleton: &Skeleton) -> Vec<DVec3> {
    match skeleton {
        Skeleton::Triangle { corners } => corners.to_vec(),
        line => vec![line.at(0.0), line.at(1.0)],
    }
}

/// Places where bones end.
#[derive(Default)]
struct Nodes {
    places: Vec<DVec3>,
    cells: HashMap<(Key, I64Vec3), Vec<usize>>,
}

impl Nodes {
    /// Returns the number of the node at a place, a new one if there is none so near.
    fn find(&mut self, key: Key, place: DVec3, near: f64) -> usize {
        let size = 4.0 * near;
        let [low, own, high] =
            [place - near, place, place + near].map(|place| (place / size).floor().as_i64vec3());
        for x in low.x..=high.x {
            for y in low.y..=high.y {
                for z in low.z..=high.z {
                    let known = self.cells.get(&(key, I64Vec3::new(x, y, z)));
                    let mut known = known.into_iter().flatten();
                    if let Some(node) = known.find(|&&n| self.places[n].distance(place) <= near) {
                        return *node;
                    }
                }
            }
        }
        self.places.push(place);
        let node = self.places.len() - 1;
        self.cells.entry((key, own)).or_default().push(node);
        node
    }
}

impl Joined {
    /// Makes a group of bones; `None` if they have no field.
    fn new(
        scene: &Scene,
        elements: &[usize],
        corners: &[Vec<usize>],
        group: &[usize],
    ) -> Option<Self> {
        let first = &scene.elements[elements[group[0]]];
        let radius = scene.radius(first);
        let flesh = scene.flesh_in_world(first)?;
        let shaping = Shaping {
            strength: 1.0,
            ..scene.shaping(first, &flesh, radius)
        };
        let bones: Vec<&Skeleton> = group
            .iter()
            .filter_map(|&order| scene.elements[elements[order]].shape.skeleton())
            .collect();
        let primitives: Option<Vec<_>> = bones
            .iter()
            .map(|&bone| Primitive::new(bone.clone(), &shaping, None))
            .collect();
        let nodes: Vec<&[usize]> = group.iter().map(|&order| &corners[order][..]).collect();
        let is_line = bones[0].dimension() == 1;
        let mut degrees = HashMap::new();
        for &node in nodes.iter().copied().flatten() {
            *degrees.entry(node).or_insert(0_usize) += 1;
        }
        let mut tips = Vec::new();
        for (number, (bone, own)) in bones.iter().zip(&nodes).enumerate().filter(|_| is_line) {
            for (end, node) in own.iter().enumerate() {
                let way = bone.tangent(end as f64);
                if let (1, Some(way)) = (degrees[node], way) {
                    tips.push(Tip {
                        element: elements[group[number]],
                        is_last: end == 1,
                        place: bone.at(end as f64),
                        way: if end == 1 { way } else { -way },
                    });
                }
            }
        }
        let middle = match is_line {
            true => middle_of_lines(&bones, &nodes, &degrees)?,
            false => middle_of_faces(&bones)?,
        };
        Some(Self {
            elements: group.iter().map(|&order| elements[order]).collect(),
            radius,
            middle,
            primitives: primitives?,
            shaping,
            tips,
        })
    }

    /// Returns the number of bones.
    pub fn len(&self) -> usize {
        self.primitives.len()
    }

    /// Returns the field of the bones at a place, with a strength of 1.
    pub fn value(&self, place: DVec3) -> f64 {
        field::sum(&self.primitives, place.to_array()).value
    }

    /// Returns the distance of the surface from the middle; `None` if there is none up to four
    /// radii.
    pub fn measure(&self) -> Option<f64> {
        let (middle, across) = self.middle;
        let (mut low, mut high) = (1e-6 * self.radius, 4.0 * self.radius);
        let [inside, outside] = [low, high].map(|way| self.value(middle + across * way));
        if inside < THRESHOLD || outside > THRESHOLD {
            return None;
        }
        for _ in 0..30 {
            let half = 0.5 * (low + high);
            if self.value(middle + across * half) > THRESHOLD {
                low = half;
            } else {
                high = half;
            }
        }
        Some(low)
    }

    /// Returns the field of an extension of a tip.
    fn extension(&self, tip: usize, length: f64, place: DVec3) -> f64 {
        if length <= 0.0 {
            return 0.0;
        }
        let Tip {
            place: base, way, ..
        } = self.tips[tip];
        let apex = base + way * length;
        Primitive::new(Skeleton::Segment { base, apex }, &self.shaping, None)
            .map_or(0.0, |primitive| primitive.value(place.to_array()))
    }

    /// Finds the factor and the extensions; `None` if there are none, or `left`, the evaluations
    /// that may still be made, does not suffice.
    fn solve(&self, left: &mut usize) -> Option<Solution> {
        let (middle, across) = self.middle;
        let count = self.tips.len();
        let mut places: Vec<DVec3> = self
            .tips
            .iter()
            .map(|tip| tip.place + tip.way * self.radius)
            .collect();
        places.push(middle + across * self.radius);
        *left = left.checked_sub(self.len() * places.len())?;
        let fixed: Vec<f64> = places.iter().map(|&place| self.value(place)).collect();
        let mut extensions = vec![0.0; count];
        // The field of each extension at each place.
        let mut shares = vec![vec![0.0; count + 1]; count];
        for _ in 0..ROUNDS {
            let mut change: f64 = 0.0;
            for tip in 0..count {
                *left = left.checked_sub(40 * PREPARATION + 2 * count)?;
                let [at_tip, at_middle] = [tip, count].map(|place| {
                    let others = (0..count).filter(|&other| other != tip);
                    fixed[place] + others.map(|other| shares[other][place]).sum::<f64>()
                });
                let length = root(self.radius, |length| {
                    let [own, far] = [places[tip], places[count]]
                        .map(|place| self.extension(tip, length, place));
                    at_tip + own - at_middle - far
                })?;
                change = change.max((length - extensions[tip]).abs());
                extensions[tip] = length;
                if length > 0.0 {
                    *left = left.checked_sub(PREPARATION * (count + 1))?;
                }
                for (place, share) in places.iter().zip(&mut shares[tip]) {
                    *share = self.extension(tip, length, *place);
                }
            }
            if change <= 1e-10 * self.radius {
                break;
            }
        }
        let field = fixed[count] + shares.iter().map(|share| share[count]).sum::<f64>();
        let factor = THRESHOLD / field;
        (factor.is_finite() && factor > 0.0).then_some(Solution { factor, extensions })
    }

    /// Makes the flesh of these bones exact; returns the elements that are to be added, each with
    /// the index of the one that it extends. `None` if that cannot be done, or takes too long.
    /// `known` holds solutions for other pictures of the text.
    pub fn settle(
        &self,
        scene: &mut Scene,
        left: &mut usize,
        known: &mut HashMap<String, Solution>,
    ) -> Option<Vec<(usize, Element)>> {
        let bones = self.primitives.iter().map(|primitive| &primitive.skeleton);
        let key = format!("{:?} {:?}", self.shaping, bones.collect::<Vec<_>>());
        let solution = match known.get(&key) {
            Some(solution) => solution.clone(),
            None => known.entry(key).or_insert(self.solve(left)?).clone(),
        };
        let Solution { factor, extensions } = solution;
        let flesh = scene.elements[self.elements[0]].flesh?;
        let mut flesh = scene.flesh.get(flesh as usize)?.clone();
        flesh.strength *= factor;
        let own = scene.flesh.len() as u32;
        scene.flesh.push(flesh);
        for &index in &self.elements {
            scene.elements[index].flesh = Some(own);
        }
        let mut added = Vec::new();
        for (tip, length) in self.tips.iter().zip(extensions).filter(|(_, l)| *l > 0.0) {
            let element = &mut scene.elements[tip.element];
            let Shape::Bone(bone) = &mut element.shape else {
                continue;
            };
            let end = tip.place + tip.way * length;
            match &mut bone.skeleton {
                Skeleton::Segment { apex, .. } if tip.is_last => *apex = end,
                Skeleton::Segment { base, .. } => *base = end,
                _ => {
                    let shape = Shape::cylinder(tip.place, end, bone.radius);
                    let Shape::Bone(mut piece) = shape else {
                        continue;
                    };
                    piece.ends = bone.ends;
                    let shape = Shape::Bone(piece);
                    added.push((
                        tip.element,
                        Element {
                            shape,
                            ..element.clone()
                        },
                    ));
                }
            }
        }
        Some(added)
    }
}

/// Returns where a function that grows crosses 0, not below 0; `None` if that is too far.
fn root(radius: f64, excess: impl Fn(f64) -> f64) -> Option<f64> {
    let (mut low, mut at_low) = (0.0, excess(0.0));
    if at_low >= 0.0 {
        return Some(0.0);
    }
    let (mut high, mut at_high) = (0.5 * radius, excess(0.5 * radius));
    while at_high < 0.0 {
        (low, at_low) = (high, at_high);
        high *= 2.0;
        at_high = excess(high);
        if high > LONGEST * radius {
            return None;
        }
    }
    // The regula falsi, with the Illinois rule.
    let mut side = 0;
    for _ in 0..60 {
        if high - low <= 1e-13 * radius {
            break;
        }
        let share = at_low / (at_low - at_high);
        let share = if share.is_finite() {
            share.clamp(0.01, 0.99)
        } else {
            0.5
        };
        let middle = low + (high - low) * share;
        let value = excess(middle);
        if value == 0.0 {
            return Some(middle);
        }
        if value < 0.0 {
            (low, at_low) = (middle, value);
            at_high *= if side < 0 { 0.5 } else { 1.0 };
            side = -1;
        } else {
            (high, at_high) = (middle, value);
            at_low *= if side > 0 { 0.5 } else { 1.0 };
            side = 1;
        }
    }
    Some(0.5 * (low + high))
}

/// Returns the middle of the longest run of lines between ends and forks, and the way from there
/// to the surface: out of the plane of the lines, if they lie in one.
fn middle_of_lines(
    bones: &[&Skeleton],
    nodes: &[&[usize]],
    degrees: &HashMap<usize, usize>,
) -> Option<(DVec3, DVec3)> {
    let mut at_node: HashMap<usize, Vec<(usize, usize)>> = HashMap::new();
    for (bone, own) in nodes.iter().enumerate() {
        for (end, node) in own.iter().enumerate() {
            at_node.entry(*node).or_default().push((bone, end));
        }
    }
    let mut seen = vec![false; bones.len()];
    let mut longest: (f64, Vec<(usize, usize)>) = (0.0, Vec::new());
    // Runs that begin at ends and forks; then those that close.
    for closes in [false, true] {
        for start in (0..bones.len()).flat_map(|bone| [(bone, 0), (bone, 1)]) {
            if seen[start.0] || !closes && degrees[&nodes[start.0][start.1]] == 2 {
                continue;
            }
            let (mut bone, mut end) = start;
            let mut run = Vec::new();
            let mut length = 0.0;
            loop {
                seen[bone] = true;
                run.push((bone, end));
                length += bones[bone].measure();
                let node = nodes[bone][1 - end];
                // A fork may have very many bones.
                let mut others = at_node[&node].iter().filter(|_| degrees[&node] == 2);
                let Some(&next) = others.find(|(next, _)| !seen[*next]) else {
                    break;
                };
                (bone, end) = next;
            }
            if length > longest.0 {
                longest = (length, run);
            }
        }
    }
    let (length, run) = longest;
    let mut rest = 0.5 * length;
    for (bone, from) in run {
        let own = bones[bone].measure();
        if rest > own {
            rest -= own;
            continue;
        }
        let share = (rest / own).clamp(0.0, 1.0);
        let share = if from == 0 { share } else { 1.0 - share };
        let along = bones[bone].tangent(share)?;
        let mut others = bones
            .iter()
            .flat_map(|other| [0.0, 0.3, 1.0].map(|s| other.tangent(s)));
        let across = others.find_map(|other| {
            let across = along.cross(other?);
            (across.length() > 1e-6).then(|| across.normalize())
        });
        let across = across.unwrap_or_else(|| along.any_orthonormal_vector());
        return Some((bones[bone].at(share), across));
    }
    None
}

/// Returns the middle of the largest of some triangles, and its normal.
fn middle_of_faces(bones: &[&Skeleton]) -> Option<(DVec3, DVec3)> {
    let largest = bones.iter().fold(bones[0], |largest, bone| {
        match bone.measure() > largest.measure() {
            true => bone,
            false => largest,
        }
    });
    let Skeleton::Triangle { corners: [a, b, c] } = *largest else {
        return None;
    };
    Some(((a + b + c) / 3.0, (b - a).cross(c - a).try_normalize()?))
}
