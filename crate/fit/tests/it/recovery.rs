//! Known shapes found again from measurements of which many are wrong.

use fit::recovery::{NOISE, Outcome, Trial, Way};
use fit::{
    Controls, Deformation, Disturbance, Fitted, Kind, Loss, Options, Rigid, cage, shapes, trial,
};
use glam::{DMat3, DVec3};
use mesh::TriangleMesh;

const SHELLS: Kind = Kind::Triangular { thickness: 0.0 };
const POINTS: [bool; 2] = [true, false];
const OUTLINES: [bool; 2] = [false, true];

/// Noise that grows from a fifth to nearly twice of the usual along x, and no points in a quarter.
const UNEVEN: Disturbance = Disturbance {
    noise: NOISE,
    uneven: 0.8,
    outliers: 0.4,
    gap: 0.25,
    seed: 8,
};

/// Returns a shape deformed by its cage, and measured.
fn measure(model: &TriangleMesh, points: usize, disturbance: Disturbance) -> Trial {
    let cage = cage(&model.positions, &model.triangles, 60);
    let deformation = Deformation::new(&model.positions, &cage.positions).unwrap();
    let moves = trial::moves(&cage.positions, 0.05 * model.bounds().size().z, 11);
    let moved = deformation.apply(&model.positions, &moves);
    let truth = TriangleMesh::new(moved, model.triangles.clone());
    Trial::of(&truth, cage, points, disturbance)
}

/// A turn by 20° and a shift by a tenth of the size.
fn motion(model: &TriangleMesh) -> Rigid {
    let (sine, cosine) = libm::sincos(20_f64.to_radians());
    let about_z = DMat3::from_cols(
        DVec3::new(cosine, sine, 0.0),
        DVec3::new(-sine, cosine, 0.0),
        DVec3::Z,
    );
    Rigid {
        turn: about_z,
        shift: 0.1 * model.bounds().size().z * DVec3::new(2.0, -1.0, 2.0) / 3.0,
    }
}

fn run(trial: &Trial, model: &TriangleMesh, kind: Kind, data: [bool; 2]) -> (Fitted, Outcome) {
    let options = Options {
        kind,
        ..Options::default()
    };
    trial.run_with(model, options, data).unwrap()
}

#[test]
fn forty_percent_of_outliers_a_gap_and_a_turned_start_are_borne() {
    for model in [shapes::ball(0.2), shapes::hand(0.08), shapes::vase(0.12)] {
        let trial = measure(&model, 2000, UNEVEN).turn(&motion(&model));
        assert!(trial.start(&model)[0] > 10.0);
        // The fit turns the mesh without being asked to, as it comes much nearer so.
        let (fitted, found) = run(&trial, &model, SHELLS, POINTS);
        assert!(found.mesh < 1.5, "{found:?}");
        assert_eq!(fitted.failure, None);
        let share = fitted.left_out.len() as f64 / trial.points().len() as f64;
        assert!((0.32..0.48).contains(&share), "{share}");
    }
}

#[test]
fn thick_shells_have_their_own_surface_on_the_points() {
    let model = shapes::ball(0.2);
    for outliers in [0.0, 0.4] {
        let disturbance = Disturbance {
            noise: NOISE,
            outliers,
            seed: 5,
            ..Disturbance::default()
        };
        let trial = measure(&model, 1000, disturbance);
        for thickness in [2.0 * NOISE, 8.0 * NOISE] {
            let (_, found) = run(&trial, &model, Kind::Triangular { thickness }, POINTS);
            assert!(
                found.surface < 1.5 && !found.failed,
                "{thickness} {found:?}"
            );
            assert!(found.mesh > thickness / NOISE, "{found:?}");
        }
    }
}

#[test]
fn mesh_of_balls_is_on_the_points() {
    let model = shapes::ball(0.2);
    let trial = measure(&model, 1000, UNEVEN);
    let (_, found) = run(&trial, &model, Kind::Spherical, POINTS);
    assert!(found.mesh < 3.0 && !found.failed, "{found:?}");
}

#[test]
fn outlines_alone_suffice() {
    let model = trial::head(800);
    let trial = measure(&model, 1000, UNEVEN);
    for kind in [Kind::Explicit, SHELLS] {
        let (fitted, found) = run(&trial, &model, kind, OUTLINES);
        assert!(found.mesh < 3.0 && !found.failed, "{found:?}");
        assert!(fitted.left_out.is_empty());
    }
}

#[test]
fn fits_that_fail_say_so_and_keep_the_best() {
    let model = shapes::ball(0.2);
    for (outliers, points, said) in [
        (0.6, 2000, "are left out"),
        (0.97, 800, "of the mesh's size"),
    ] {
        let disturbance = Disturbance {
            outliers,
            uneven: 0.0,
            gap: 0.0,
            ..UNEVEN
        };
        let trial = measure(&model, points, disturbance);
        let (fitted, found) = run(&trial, &model, SHELLS, POINTS);
        assert!(found.failed, "{outliers} {found:?}");
        let failure = fitted.failure.unwrap();
        assert!(failure.contains(said), "{failure}");
    }
    // Few iterations with a mesh that is far away.
    let trial = measure(&model, 800, UNEVEN).turn(&Rigid {
        turn: DMat3::IDENTITY,
        shift: DVec3::X * 9.0,
    });
    let options = Options {
        iterations: 1,
        ..Options::default()
    };
    let (fitted, _) = trial.run_with(&model, options, POINTS).unwrap();
    assert!(fitted.failure.is_some());
}

#[test]
fn lattices_and_single_vertices_find_the_shape_too() {
    let model = shapes::ball(0.2);
    // A corner of its own for each facet: what is in one place stays together.
    let corners = model.triangles.iter().flatten();
    let corners: Vec<DVec3> = corners.map(|i| model.positions[*i as usize]).collect();
    let numbers = (0..model.triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]);
    let apart = TriangleMesh::new(corners.clone(), numbers.collect());
    let trial = measure(&model, 1000, UNEVEN);
    let options = Options {
        kind: Kind::Explicit,
        ..Options::default()
    };
    for (model, by, count) in [
        (&model, Controls::Lattice([4; 3]), 64),
        (&apart, Controls::Vertices, corners.len()),
    ] {
        let (fitted, found) = trial.run_by(model, by, options, POINTS).unwrap();
        assert!(found.mesh < 1.5 && !found.failed, "{count} {found:?}");
        assert_eq!(fitted.moves.len(), count);
        let first = fitted.positions.iter().zip(&model.positions);
        let same = first.filter(|(_, own)| *own == &model.positions[0]);
        let places: Vec<DVec3> = same.map(|(moved, _)| *moved).collect();
        assert!(places.iter().all(|place| *place == places[0]));
    }
}

#[test]
fn single_vertices_follow_what_no_cage_does() {
    let model = shapes::ball(0.2);
    let cage = cage(&model.positions, &model.triangles, 20);
    let mut truth = model.clone();
    for place in &mut truth.positions {
        *place *= 1.0 + 0.04 * libm::sin(7.0 * place.x) * libm::sin(7.0 * place.z);
    }
    let few = Disturbance {
        noise: 0.2 * NOISE,
        seed: 5,
        ..Disturbance::default()
    };
    let trial = Trial::of(&truth, cage.clone(), 4000, few);
    let options = Options {
        kind: Kind::Explicit,
        ..Options::default()
    };
    let ways = [Controls::Cage(cage), Controls::Vertices];
    let [by_cage, by_vertices] =
        ways.map(|by| trial.run_by(&model, by, options, POINTS).unwrap().1.mesh);
    assert!(by_vertices < 0.5 * by_cage, "{by_cage} {by_vertices}");
}

#[test]
fn losses_of_the_paper_order_the_surfaces_as_its_figure_7_does() {
    let trial = Trial::new(420, 1400, 0.1).unwrap();
    let model = trial::head(420);
    let [facets, balls, shells] = [
        (Kind::Explicit, Loss::Squares),
        (Kind::Spherical, Loss::Algebraic),
        (SHELLS, Loss::Algebraic),
    ]
    .map(|(kind, loss)| {
        let way = Way {
            kind,
            sharpness: 20.0,
            loss,
            outlines: false,
        };
        trial.run(&model, way).unwrap().mesh
    });
    let [start, _] = trial.start(&model);
    assert!(
        shells < 1.5 && balls > start,
        "{facets} {balls} {shells} {start}"
    );
    assert!(
        shells < 0.7 * facets && facets < balls,
        "{facets} {balls} {shells}"
    );
}

#[test]
fn points_and_outlines_are_judged_by_the_points() {
    let model = shapes::ball(0.2);
    let disturbance = Disturbance {
        outliers: 0.4,
        noise: NOISE,
        seed: 8,
        ..Disturbance::default()
    };
    let trial = measure(&model, 1000, disturbance);
    let (fitted, found) = run(&trial, &model, SHELLS, [true; 2]);
    assert!(found.mesh < 1.5, "{found:?}");
    assert_eq!(fitted.failure, None);
    let share = fitted.left_out.len() as f64 / trial.points().len() as f64;
    assert!((0.35..0.41).contains(&share), "{share}");
    assert!((fitted.last.outliers - share).abs() < 1e-9, "{share}");
}
