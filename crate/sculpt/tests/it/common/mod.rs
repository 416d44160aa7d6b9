//! Random strokes, and what must hold after each.

use glam::DVec3;
use mesh::VertexId;
use sculpt::{
    Action, Choice, Clay, Constraint, Decay, Deletion, Form, MaskChange, PathPoint, Refinement,
    RegionChange, Script, Sculpture, Stroke, Sweep, Tool, replay,
};

/// SplitMix64.
pub struct Random(pub u64);

impl Random {
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = self.0;
        let z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    pub fn below(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }

    /// From 0 to 1.
    pub fn share(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.share()
    }

    pub fn point(&mut self, reach: f64) -> DVec3 {
        DVec3::from([(); 3].map(|()| self.between(-reach, reach)))
    }

    pub fn of<T: Copy>(&mut self, list: &[T]) -> T {
        list[self.below(list.len())]
    }
}

pub fn tool(random: &mut Random) -> Tool {
    let mut tool = Tool::new(random.of(&Form::ALL), random.point(0.2).abs() + 0.1);
    if random.below(3) == 0 {
        tool.exponents = [(); 2].map(|()| random.between(0.05, 2.0));
    }
    if random.below(3) == 0 {
        tool.turn = random.point(180.0);
    }
    tool
}

pub fn sweep(random: &mut Random, action: Action) -> Sweep {
    let mut sweep = Sweep::new(action, tool(random));
    if random.below(3) > 0 {
        sweep.decay = random.of(&Decay::ALL);
        sweep.range = random.between(0.05, 0.8);
    }
    sweep.constraint = random.of(&[
        None,
        None,
        Some(Constraint::Normal),
        Some(Constraint::Tangent),
    ]);
    sweep.only_region = random.below(4) == 0;
    let mut p = random.point(1.0);
    for _ in 0..=random.below(4) {
        sweep.path.push(PathPoint {
            position: p,
            pressure: if random.below(2) == 0 {
                1.0
            } else {
                random.share()
            },
        });
        p += random.point(0.3);
    }
    sweep
}

/// A stroke for a mesh of so many faces; it keeps meshes small.
pub fn stroke(random: &mut Random, faces: usize) -> Stroke {
    if faces > 500 {
        return match random.below(8) {
            0 => Stroke::Delete(random.of(&Deletion::ALL)),
            1 | 2 => Stroke::Region(RegionChange::All),
            _ => Stroke::Simplify(random.between(0.1, 0.6)),
        };
    }
    match random.below(32) {
        0..6 => Stroke::Sweep(sweep(random, Action::Push)),
        6..11 => Stroke::Sweep(sweep(random, Action::Pull)),
        11 => Stroke::Sweep(sweep(random, Action::Smooth)),
        12 => {
            let value = random.of(&[0.0, 0.5, 1.0, 1.0]);
            Stroke::Sweep(sweep(random, Action::Mask(value)))
        }
        13 => {
            let color = [(); 3].map(|()| random.share());
            Stroke::Sweep(sweep(random, Action::Paint(color)))
        }
        14..19 => {
            let choice = random.of(&Choice::ALL);
            Stroke::Sweep(sweep(random, Action::Region(choice)))
        }
        19 => Stroke::Region(random.of(&[
            RegionChange::All,
            RegionChange::All,
            RegionChange::None,
            RegionChange::Invert,
            RegionChange::Grow(1),
            RegionChange::Shrink(1),
        ])),
        20 => Stroke::Masks(random.of(&[
            MaskChange::Clear,
            MaskChange::Clear,
            MaskChange::Clear,
            MaskChange::Invert,
        ])),
        21 | 22 => Stroke::Refine(random.of(&Refinement::ALL)),
        23 => Stroke::Loop(1),
        24 => Stroke::Average(1 + random.below(3) as u32, random.share()),
        25..27 => Stroke::Fill,
        27..29 => Stroke::Delete(random.of(&Deletion::ALL)),
        29 => Stroke::Simplify(random.between(0.3, 1.0)),
        30 => Stroke::Symmetry([(); 3].map(|()| random.below(3) == 0)),
        _ => Stroke::Stage(String::from("here")),
    }
}

/// The vertices that must stay.
pub fn held(clay: &Clay) -> Vec<(VertexId, [u64; 3])> {
    let vertices = clay.mesh().vertices().filter(|v| clay.mask(*v) == 1.0);
    vertices
        .map(|v| (v, bits(clay.mesh().position(v))))
        .collect()
}

pub fn bits(p: DVec3) -> [u64; 3] {
    p.to_array().map(f64::to_bits)
}

/// Checks the clay after a stroke.
pub fn check(clay: &Clay, stroke: &Stroke, before: &Before) {
    let mesh = clay.mesh();
    mesh.validate()
        .unwrap_or_else(|error| panic!("{stroke}: {error}"));
    let mut euler = 0;
    for shell in mesh.shells() {
        let twice = 2 - shell.boundary_loops as i64 - shell.euler_characteristic();
        assert!(twice >= 0 && twice % 2 == 0, "{stroke}: no genus");
        euler += shell.euler_characteristic();
    }
    assert_eq!(euler, mesh.euler_characteristic());
    match stroke {
        Stroke::Fill | Stroke::Delete(Deletion::Hole) => {}
        _ => assert_eq!(mesh.euler_characteristic(), before.euler, "{stroke}"),
    }
    let is_still = matches!(
        stroke,
        Stroke::Sweep(_) | Stroke::Average(..) | Stroke::Region(_) | Stroke::Masks(_)
    );
    if is_still {
        let counts = [mesh.vertex_count(), mesh.edge_count(), mesh.face_count()];
        assert_eq!(counts, before.counts, "{stroke}");
    }
    for v in mesh.vertices() {
        assert!((0.0..=1.0).contains(&clay.mask(v)), "{stroke}");
        assert!(clay.color(v).iter().all(|c| (0.0..=1.0).contains(c)));
    }
    let changes_masks = match stroke {
        Stroke::Masks(_) => true,
        Stroke::Sweep(sweep) => matches!(sweep.action, Action::Mask(_)),
        _ => false,
    };
    for (v, place) in &before.held {
        assert!(mesh.has_vertex(*v), "{stroke}: a held vertex is lost");
        assert_eq!(
            bits(mesh.position(*v)),
            *place,
            "{stroke}: a held vertex moved"
        );
        assert!(
            changes_masks || clay.mask(*v) == 1.0,
            "{stroke}: a mask is lost"
        );
    }
    if let sculpt::Region::Faces(faces) = clay.region() {
        assert!(faces.is_sorted_by(|a, b| a < b), "{stroke}");
        assert!(faces.iter().all(|f| mesh.has_face(*f)), "{stroke}");
    }
}

/// What is compared after a stroke.
pub struct Before {
    pub euler: i64,
    pub counts: [usize; 3],
    pub held: Vec<(VertexId, [u64; 3])>,
}

impl Before {
    pub fn of(clay: &Clay) -> Self {
        let mesh = clay.mesh();
        Self {
            euler: mesh.euler_characteristic(),
            counts: [mesh.vertex_count(), mesh.edge_count(), mesh.face_count()],
            held: held(clay),
        }
    }
}

/// Carries out so many random strokes, checks each, takes all back and carries them out again. Returns how many were
/// refused.
pub fn run(seed: u64, count: usize) -> usize {
    let mut random = Random(seed);
    let shape = random.of(&sculpt::Shape::ALL);
    let start = sculpt::Start::new(shape, 2 + random.below(3) as u32);
    let clay = Clay::of_shape(&start).expect("a start");
    let mut sculpture = Sculpture::new(clay.clone());
    let mut refused = 0;
    for _ in 0..count {
        let faces = sculpture.clay().mesh().face_count();
        let stroke = stroke(&mut random, faces);
        let before = Before::of(sculpture.clay());
        let digest = sculpture.clay().digest();
        match sculpture.carry_out(stroke.clone()) {
            Ok(()) => check(sculpture.clay(), &stroke, &before),
            Err(_) => {
                refused += 1;
                assert_eq!(sculpture.clay().digest(), digest, "{stroke} left something");
            }
        }
    }
    let last = sculpture.clay().digest();
    let strokes: Vec<Stroke> = sculpture.strokes().cloned().collect();
    while sculpture.undo().expect("undone").is_some() {}
    assert_eq!(sculpture.clay().digest(), clay.digest(), "the first bits");
    assert_eq!(*sculpture.clay().mesh(), *clay.mesh());
    while sculpture.redo().expect("redone").is_some() {}
    assert_eq!(sculpture.clay().digest(), last, "the last bits");
    // The text gives the same.
    let script = Script::new(sculpt::Beginning::Shape(start), strokes);
    let again: Script = script.to_string().parse().expect("its own text");
    assert_eq!(again.strokes, script.strokes);
    let replayed = replay(&again, &mut |_| Err(String::new()), u64::MAX, |_, _, _| ());
    assert_eq!(
        replayed.expect("replayed").digest(),
        last,
        "the replayed bits"
    );
    refused
}
