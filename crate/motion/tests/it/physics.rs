//! Motion against what is known of it: conservation, periods, sags, slopes, blows; and that nothing
//! passes through anything.

use glam::DVec3;
use motion::{Body, Obstacle, Settings, Setup, Simulation};
use skeleton::{Node, Scheme, Skeleton};
use trials::{Random, count};

fn node(x: f64, y: f64, z: f64, radius: f64) -> Node {
    Node {
        position: DVec3::new(x, y, z),
        radius,
    }
}

fn body(nodes: Vec<Node>, curves: Vec<Vec<usize>>) -> Body {
    Body {
        skeleton: Skeleton { nodes, curves },
        scheme: Scheme::Cubic,
        pinned: Vec::new(),
    }
}

/// Returns a straight chain along x.
fn chain(count: usize, spacing: f64, radius: f64) -> Body {
    let nodes = (0..count).map(|i| node(i as f64 * spacing, 0.0, 0.0, radius));
    body(nodes.collect(), vec![(0..count).collect()])
}

/// Returns a spine with two limbs on each side, not in a plane.
fn animal() -> Body {
    let nodes = vec![
        node(0.0, 0.0, 0.0, 0.4),
        node(1.0, 0.2, 0.1, 0.5),
        node(2.0, 0.1, -0.1, 0.5),
        node(3.0, 0.5, 0.0, 0.3),
        node(0.9, -1.0, 1.0, 0.2),
        node(0.9, -1.0, -1.0, 0.2),
        node(2.1, -1.0, 1.0, 0.2),
        node(2.1, -1.0, -1.0, 0.2),
    ];
    let curves = vec![
        vec![0, 1, 2, 3],
        vec![1, 4],
        vec![1, 5],
        vec![2, 6],
        vec![2, 7],
    ];
    body(nodes, curves)
}

fn ring() -> Body {
    let nodes = [(2.0, 0.0), (0.0, 2.0), (-2.0, 0.0), (0.0, -2.0)];
    let nodes = nodes.map(|(x, y)| node(x, y, 0.3, 0.2));
    body(nodes.to_vec(), vec![vec![0, 1, 2, 3, 0]])
}

/// Without air, and without gravity.
fn free() -> Settings {
    Settings {
        gravity: DVec3::ZERO,
        damping: 0.0,
        ..Settings::default()
    }
}

fn simulation(bodies: Vec<Body>, obstacles: Vec<Obstacle>, settings: Settings) -> Simulation {
    let setup = Setup {
        bodies,
        obstacles,
        settings,
    };
    Simulation::new(&setup).unwrap()
}

/// Gives each node a random velocity.
fn stir(simulation: &mut Simulation, mut random: Random, speed: f64) {
    for i in 0..simulation.positions().len() {
        simulation.set_velocity(i, random.vector(speed));
    }
}

fn floor(y: f64) -> Obstacle {
    Obstacle::Plane {
        point: DVec3::Y * y,
        normal: DVec3::Y,
    }
}

/// Pushes that are kept: after about one in a hundred others the energy grows, by a tenth on
/// soft springs, where limbs go deep into flesh, and by a fifth on the stiffest.
#[test]
fn energy_does_not_grow_in_ten_thousand_steps() {
    for stiffness in [10.0, 1000.0, 1e6] {
        for (name, body) in [
            ("chain", chain(8, 1.0, 0.2)),
            ("animal", animal()),
            ("ring", ring()),
        ] {
            for seed in 0..3 {
                let settings = Settings {
                    stiffness,
                    ..free()
                };
                let mut simulation = simulation(vec![body.clone()], vec![], settings);
                stir(&mut simulation, Random::fixed(seed), 1.0);
                let first = simulation.energy().total();
                let mut most = first;
                for _ in 0..10_000 / settings.steps {
                    simulation.advance(&[]);
                    most = most.max(simulation.energy().total());
                }
                assert!(
                    most <= 1.01 * first,
                    "{name} {stiffness} {seed}: {most} of {first}"
                );
            }
        }
    }
}

#[test]
fn energy_of_folds_that_meet_does_not_grow() {
    // The ends fly at each other and the chain folds together. These are kept ones, too: one in
    // fifty gains a fifteenth of its energy.
    let mut pressed = 0.0f64;
    for seed in 0..5 {
        let settings = Settings {
            bending: 0.01,
            friction: 0.0,
            ..free()
        };
        let mut above = animal();
        for node in &mut above.skeleton.nodes {
            node.position += DVec3::Y * 2.5;
        }
        let mut simulation = simulation(vec![chain(10, 0.5, 0.2), above], vec![], settings);
        stir(&mut simulation, Random::fixed(seed), 3.0);
        // Each body as a whole: the upper one comes down at 1.
        for (range, down) in [(0..10, 0.0), (10..18, 1.0)] {
            let mean =
                simulation.velocities()[range.clone()].iter().sum::<DVec3>() / range.len() as f64;
            for i in range {
                let velocity = simulation.velocities()[i] - mean - DVec3::Y * down;
                simulation.set_velocity(i, velocity);
            }
        }
        let first = simulation.energy().total();
        let mut most = first;
        for _ in 0..10_000 / settings.steps {
            simulation.advance(&[]);
            most = most.max(simulation.energy().total());
            pressed = pressed.max(simulation.pressed());
        }
        assert!(most <= 1.01 * first, "{seed}: {most} of {first}");
    }
    assert!(pressed > 1.0, "they hardly meet: {pressed}");
}

#[test]
fn a_pendulum_swings_in_its_period_and_does_not_rise() {
    // A stiff rod of one edge, pinned at one end and let go at 0.1 from straight down.
    let length: f64 = 2.0;
    let mut pendulum = body(
        vec![
            node(0.0, 0.0, 0.0, 0.1),
            node(length * libm::sin(0.1), -length * libm::cos(0.1), 0.0, 0.1),
        ],
        vec![vec![0, 1]],
    );
    pendulum.pinned = vec![0];
    let settings = Settings {
        gravity: DVec3::Y * -10.0,
        damping: 0.0,
        stiffness: 1e7,
        steps: 20,
        ..Settings::default()
    };
    let mut simulation = simulation(vec![pendulum], vec![], settings);
    let energy = |simulation: &mut Simulation| {
        // From the lowest place: m g l = 1·10·2, for masses of 1.
        simulation.energy().total() + 20.0
    };
    let first = energy(&mut simulation);
    let (mut crossings, mut before, mut most) = (Vec::new(), 1.0f64, first);
    for frame in 0..500 {
        simulation.advance(&[]);
        let x = simulation.positions()[1].x;
        if before > 0.0 && x <= 0.0 {
            crossings.push(f64::from(frame) + before / (before - x));
        }
        before = x;
        most = most.max(energy(&mut simulation));
    }
    let count = crossings.len() - 1;
    let period = (crossings[count] - crossings[0]) / count as f64 / settings.rate;
    // 2π√(l/g)(1 + θ²/16)
    let expected = 2.0 * std::f64::consts::PI * (length / 10.0f64).sqrt() * (1.0 + 0.01 / 16.0);
    assert!(
        (period / expected - 1.0).abs() < 2e-3,
        "{period} {expected}"
    );
    assert!(most <= 1.01 * first, "{most} of {first}");
}

#[test]
fn two_masses_on_a_spring_swing_in_their_period() {
    // T = 2π√(m/2k) with the spring's constant k = stiffness/length, for masses of 1.
    let settings = Settings {
        stiffness: 40.0,
        steps: 50,
        ..free()
    };
    let mut simulation = simulation(vec![chain(2, 2.0, 0.1)], vec![], settings);
    simulation.set_velocity(0, DVec3::X * -0.5);
    simulation.set_velocity(1, DVec3::X * 0.5);
    let (mut crossings, mut before) = (Vec::new(), 0.0f64);
    for frame in 0..400 {
        simulation.advance(&[]);
        let [a, b] = [0, 1].map(|i| simulation.positions()[i]);
        let stretch = a.distance(b) - 2.0;
        if before < 0.0 && stretch >= 0.0 {
            crossings.push(f64::from(frame) + before / (before - stretch));
        }
        before = stretch;
    }
    let count = crossings.len() - 1;
    let period = (crossings[count] - crossings[0]) / count as f64 / settings.rate;
    let expected = 2.0 * std::f64::consts::PI * (1.0 / (2.0 * 20.0f64)).sqrt();
    assert!(
        (period / expected - 1.0).abs() < 5e-3,
        "{period} {expected}"
    );
}

#[test]
fn springs_and_folds_keep_the_momentum() {
    let settings = Settings {
        bending: 0.01,
        ..free()
    };
    let mut above = ring();
    for node in &mut above.skeleton.nodes {
        node.position += DVec3::Z;
    }
    let mut simulation = simulation(vec![chain(10, 0.5, 0.2), above], vec![], settings);
    stir(&mut simulation, Random::new(9), 0.3);
    // The ring flies at the chain.
    for i in 10..14 {
        simulation.set_velocity(i, simulation.velocities()[i] - DVec3::Z * 2.0);
    }
    let first = simulation.momentum();
    let mut pressed = 0.0f64;
    for _ in 0..200 {
        simulation.advance(&[]);
        pressed = pressed.max(simulation.pressed());
        let now = simulation.momentum();
        assert!(
            (now - first).length() < 1e-9 * (1.0 + first.length()),
            "{now} {first}"
        );
    }
    assert!(pressed > 0.0, "nothing meets");
}

#[test]
fn free_fall_is_that_of_the_step() {
    let settings = Settings {
        gravity: DVec3::Y * -9.0,
        damping: 0.0,
        steps: 10,
        rate: 20.0,
        ..Settings::default()
    };
    let mut simulation = simulation(vec![animal()], vec![], settings);
    for _ in 0..10 {
        simulation.advance(&[]);
    }
    // y(n) = −g h² n(n + 1)/2
    let h = 1.0 / 200.0;
    let expected = -9.0 * h * h * 100.0 * 101.0 / 2.0;
    let fell = simulation.positions()[0].y;
    assert!((fell - expected).abs() < 1e-9, "{fell} {expected}");
}

#[test]
fn a_chain_without_bending_stretches_as_the_manual_says() {
    let mut hanging = chain(5, 1.0, 0.2);
    for node in &mut hanging.skeleton.nodes {
        node.position = DVec3::new(0.0, -node.position.x, 0.0);
    }
    hanging.pinned = vec![0];
    let settings = Settings {
        gravity: DVec3::Y * -10.0,
        damping: 5.0,
        stiffness: 1000.0,
        bending: 0.0,
        ..Settings::default()
    };
    let mut simulation = simulation(vec![hanging], vec![], settings);
    for _ in 0..200 {
        simulation.advance(&[]);
    }
    let y = |i: usize| simulation.positions()[i].y;
    // Masses of a mean of 1: ends have half the flesh.
    let carried = [1.25 * 3.0 + 0.625, 1.25 * 2.0 + 0.625, 1.25 + 0.625, 0.625];
    for (i, mass) in carried.into_iter().enumerate() {
        let stretch = y(i) - y(i + 1) - 1.0;
        assert!(
            (stretch / (mass * 10.0 / 1000.0) - 1.0).abs() < 0.02,
            "{i}: {stretch}"
        );
    }
}

#[test]
fn friction_holds_on_a_gentle_slope_and_not_on_a_steep_one() {
    // A slope of 20°: tan is 0.364.
    let (sin, cos) = (0.342_020_143, 0.939_692_621);
    let slide = |friction: f64| {
        let normal = DVec3::new(sin, cos, 0.0);
        let along = DVec3::new(cos, -sin, 0.0);
        let mut lying = chain(4, 0.6, 0.2);
        for node in &mut lying.skeleton.nodes {
            node.position = along * node.position.x + normal * 0.19;
        }
        let plane = Obstacle::Plane {
            point: DVec3::ZERO,
            normal,
        };
        let settings = Settings {
            friction,
            damping: 0.0,
            ..Settings::default()
        };
        let mut simulation = simulation(vec![lying], vec![plane], settings);
        let place = |simulation: &Simulation| simulation.positions()[1].dot(along);
        for _ in 0..25 {
            simulation.advance(&[]);
        }
        let first = place(&simulation);
        for _ in 0..25 {
            simulation.advance(&[]);
        }
        place(&simulation) - first
    };
    assert!(slide(0.5).abs() < 1e-3, "{}", slide(0.5));
    // g(sin − μ cos): from the first to the second second 1.5 times that.
    let expected = 1.5 * 9.81 * (sin - 0.2 * cos);
    assert!(
        (slide(0.2) / expected - 1.0).abs() < 0.1,
        "{} {expected}",
        slide(0.2)
    );
}

#[test]
fn a_blow_leaves_the_share_of_the_speed_that_is_asked_for() {
    let bounce = |bounce: f64| {
        let mut rod = chain(2, 0.3, 0.2);
        for node in &mut rod.skeleton.nodes {
            node.position.y = 2.2;
        }
        let settings = Settings {
            bounce,
            damping: 0.0,
            ..Settings::default()
        };
        let mut simulation = simulation(vec![rod], vec![floor(0.0)], settings);
        let (mut fell, mut most) = (false, 0.0f64);
        for _ in 0..60 {
            simulation.advance(&[]);
            let y = simulation.positions()[0].y;
            fell |= y < 0.5;
            if fell {
                most = most.max(y - 0.2);
            }
        }
        most
    };
    // e² of the height.
    assert!(
        (bounce(0.7) / (2.0 * 0.49) - 1.0).abs() < 0.1,
        "{}",
        bounce(0.7)
    );
    assert!(bounce(0.0) < 0.35, "{}", bounce(0.0));
}

#[test]
fn nothing_passes_through_floors_boxes_and_rods() {
    let obstacles = vec![
        floor(-3.0),
        Obstacle::Box {
            center: DVec3::new(0.0, -1.5, 0.0),
            axes: [DVec3::X * 3.0, DVec3::Y * 0.05, DVec3::Z * 3.0],
        },
        Obstacle::Rod {
            ends: [DVec3::new(-3.0, 1.0, 0.0), DVec3::new(3.0, 1.0, 0.0)],
            radii: [0.1, 0.1],
        },
    ];
    for seed in 0..count(7) as u64 {
        let mut falling = animal();
        for node in &mut falling.skeleton.nodes {
            node.position += DVec3::new(-1.5, 4.0, 0.0);
        }
        let settings = Settings {
            stiffness: 300.0,
            ..Settings::default()
        };
        let mut simulation = simulation(vec![falling], obstacles.clone(), settings);
        stir(&mut simulation, Random::new(seed), 1.0);
        // At the stated speed, straight down.
        let limit = simulation.speed_limit();
        assert!(limit > 20.0);
        for i in 0..simulation.positions().len() {
            let velocity = simulation.velocities()[i] - DVec3::Y * 0.95 * limit;
            simulation.set_velocity(i, velocity);
        }
        let mut deepest = f64::NEG_INFINITY;
        for _ in 0..150 {
            simulation.advance(&[]);
            deepest = deepest.max(simulation.deepest());
            let under = |p: &DVec3| p.x.abs() < 2.9 && p.z.abs() < 2.9 && p.y < -1.5 && p.y > -1.8;
            assert!(
                !simulation.positions().iter().any(under),
                "seed {seed}: under the thin box"
            );
        }
        // Half of the thinnest flesh at the most, on the blow.
        assert!(deepest < 0.12, "{seed}: {deepest}");
    }
}

#[test]
fn folds_and_bodies_do_not_pass_through_each_other() {
    for (seed, share) in [(1, 0.3), (2, 0.6), (3, 0.9)] {
        // A rope falls across another one that is held at its ends.
        let mut held = chain(9, 0.5, 0.25);
        for node in &mut held.skeleton.nodes {
            node.position -= DVec3::X * 2.0;
        }
        held.pinned = vec![0, 8];
        let nodes = (0..9).map(|i| node(0.1, 1.5, (f64::from(i) - 4.0) * 0.5, 0.25));
        let falling = body(nodes.collect(), vec![(0..9).collect()]);
        let mut simulation = simulation(vec![held, falling], vec![], Settings::default());
        stir(&mut simulation, Random::new(seed), 0.2);
        let limit = simulation.speed_limit();
        for i in 9..18 {
            simulation.set_velocity(i, DVec3::Y * -share * limit);
        }
        for frame in 0..40 {
            simulation.advance(&[]);
            let places = simulation.positions();
            let middle = |range: std::ops::Range<usize>| places[range].to_vec()[4].y;
            assert!(
                middle(9..18) > middle(0..9),
                "frame {frame}: they crossed at {share}"
            );
        }
    }
}

#[test]
fn nodes_that_are_pinned_go_where_they_are_taken() {
    let mut tail = chain(5, 0.5, 0.2);
    tail.pinned = vec![0];
    let mut simulation = simulation(vec![tail], vec![], Settings::default());
    for frame in 1..=50 {
        let goal = DVec3::new(0.0, f64::from(frame) * 0.1, 0.0);
        simulation.advance(&[goal]);
        assert_eq!(simulation.positions()[0], goal);
    }
    // The rest hangs behind.
    assert!(simulation.positions()[4].y > 2.0);
    simulation.advance(&[]);
    assert_eq!(simulation.positions()[0].y, 5.0);
}

#[test]
fn bad_input_is_refused_or_harmless() {
    let with = |settings: Settings| {
        Simulation::new(&Setup {
            bodies: vec![animal()],
            obstacles: vec![floor(-1.5)],
            settings,
        })
    };
    let usual = Settings::default();
    let refused = [
        Settings {
            gravity: DVec3::Y * 1e300,
            ..usual
        },
        Settings {
            gravity: DVec3::NAN,
            ..usual
        },
        Settings {
            damping: -1.0,
            ..usual
        },
        Settings {
            damping: f64::NAN,
            ..usual
        },
        Settings {
            stiffness: f64::INFINITY,
            ..usual
        },
        Settings {
            bending: f64::NAN,
            ..usual
        },
        Settings {
            bounce: 2.0,
            ..usual
        },
        Settings {
            friction: f64::NAN,
            ..usual
        },
        Settings { steps: 0, ..usual },
        Settings {
            steps: 1_000_000,
            ..usual
        },
        Settings { rate: 0.0, ..usual },
    ];
    for settings in refused {
        assert!(with(settings).is_err(), "{settings:?}");
    }
    let flat = Obstacle::Plane {
        point: DVec3::ZERO,
        normal: DVec3::ZERO,
    };
    let setup = Setup {
        bodies: vec![animal()],
        obstacles: vec![flat],
        settings: usual,
    };
    assert!(Simulation::new(&setup).is_err());
    // Extremes that are taken stay finite.
    let harsh = [
        Settings {
            gravity: DVec3::Y * -1e12,
            ..usual
        },
        Settings {
            stiffness: 1e12,
            ..usual
        },
        Settings {
            stiffness: 0.0,
            ..usual
        },
        Settings {
            damping: 1e12,
            ..usual
        },
        Settings {
            friction: 1e12,
            bounce: 1.0,
            ..usual
        },
        Settings {
            steps: 1,
            rate: 0.01,
            ..usual
        },
    ];
    for settings in harsh {
        let mut simulation = with(settings).unwrap();
        for _ in 0..20 {
            simulation.advance(&[]);
        }
        assert!(
            simulation.positions().iter().all(|p| p.is_finite()),
            "{settings:?}"
        );
        assert!(
            simulation.deepest() < 1.0,
            "{settings:?}: {}",
            simulation.deepest()
        );
    }
}

#[test]
fn springs_of_no_length_and_nodes_below_the_floor_are_harmless() {
    let twice = body(
        vec![
            node(0.0, 1.0, 0.0, 0.2),
            node(0.0, 1.0, 0.0, 0.2),
            node(1.0, 1.0, 0.0, 0.2),
            node(1.0, 1.0, 0.0, 0.0),
        ],
        vec![vec![0, 1, 2, 3, 2]],
    );
    // Apart from the other one, which it would push up as it rises.
    let mut sunk = chain(4, 1.0, 0.3);
    for node in &mut sunk.skeleton.nodes {
        node.position.z = 3.0;
    }
    let mut simulation = simulation(vec![twice, sunk], vec![floor(0.5)], Settings::default());
    assert!(simulation.deepest() > 0.7);
    for frame in 0..100 {
        simulation.advance(&[]);
        for (i, p) in simulation.positions().iter().enumerate() {
            assert!(p.is_finite() && p.y < 1.3, "{frame} {i}: {p}");
        }
    }
    assert!(simulation.deepest() < 0.02, "{}", simulation.deepest());
}

#[test]
fn a_body_with_nothing_in_it_does_nothing() {
    let mut simulation = simulation(vec![], vec![floor(0.0)], Settings::default());
    simulation.advance(&[]);
    assert!(simulation.positions().is_empty());
    let error = Simulation::new(&Setup {
        bodies: vec![chain(201, 0.1, 0.1)],
        obstacles: vec![],
        settings: Settings::default(),
    });
    assert_eq!(error.err(), Some(motion::Error::Nodes(201)));
}
