//! Refined curves against the closed forms of their limits, and graphs of every shape.
use glam::{DVec3, DVec4};
use skeleton::{Error, MOST_CURVES, MOST_NODES, MOST_SEGMENTS, Node, Polyline, Scheme, Skeleton};
use trials::{Random, count};

const SCHEMES: [Scheme; 3] = [Scheme::Cubic, Scheme::Chaikin, Scheme::FourPoint];

fn node(random: &mut Random) -> Node {
    Node {
        position: random.vector(2.0),
        radius: random.range(0.1, 1.1),
    }
}

fn nodes(random: &mut Random, count: usize) -> Vec<Node> {
    (0..count).map(|_| node(random)).collect()
}

fn polyline(nodes: &[Node], curves: &[&[usize]], scheme: Scheme, levels: u32) -> Polyline {
    let skeleton = Skeleton {
        nodes: nodes.to_vec(),
        curves: curves.iter().map(|curve| curve.to_vec()).collect(),
    };
    skeleton.polyline(scheme, levels).expect("a polyline")
}

/// The points of a curve, in order.
fn points(polyline: &Polyline, curve: usize) -> Vec<DVec4> {
    let own: Vec<_> = polyline
        .segments
        .iter()
        .filter(|s| s.curve == curve)
        .collect();
    let at = |vertex: usize| {
        let vertex = polyline.vertices[vertex];
        vertex.position.extend(vertex.radius)
    };
    let mut points = vec![at(own[0].ends[0])];
    points.extend(own.iter().map(|segment| at(segment.ends[1])));
    points
}

fn close(a: DVec4, b: DVec4) -> bool {
    (a - b).length() < 1e-12
}

/// Returns a uniform B-spline's basis function of a degree, on the knots 0, 1, …, degree+1 (de
/// Boor's recursion).
fn basis(degree: u32, t: f64) -> f64 {
    if degree == 0 {
        return f64::from(u8::from((0.0..1.0).contains(&t)));
    }
    let d = f64::from(degree);
    t / d * basis(degree - 1, t) + (d + 1.0 - t) / d * basis(degree - 1, t - 1.0)
}

/// The spline of a degree with these control points at t, where the first full span begins at t =
/// 0.
fn spline(degree: u32, control: &[DVec4], t: f64) -> DVec4 {
    let mut sum = DVec4::ZERO;
    for (i, point) in control.iter().enumerate() {
        sum += *point * basis(degree, t + f64::from(degree) - i as f64);
    }
    sum
}

fn four(node: &Node) -> DVec4 {
    node.position.extend(node.radius)
}

#[test]
fn cubic_is_the_cubic_b_spline() {
    let mut random = Random::new(1);
    for count in 2..8 {
        let nodes = nodes(&mut random, count);
        let all: Vec<usize> = (0..count).collect();
        // Mirrored at the ends.
        let mut control: Vec<DVec4> = nodes.iter().map(four).collect();
        control.insert(0, 2.0 * control[0] - control[1]);
        control.push(2.0 * control[count] - control[count - 1]);
        for levels in 0..=6 {
            let points = points(&polyline(&nodes, &[&all], Scheme::Cubic, levels), 0);
            assert_eq!(points.len(), ((count - 1) << levels) + 1);
            for (i, &point) in points.iter().enumerate().take(points.len() - 1) {
                let want = spline(3, &control, i as f64 / f64::from(1 << levels));
                // Radii of mirrored ends may leave the nodes' range, where they are held.
                assert!(
                    (point - want).truncate().length() < 1e-12,
                    "{count} {levels} {i}"
                );
                let [low, high] = [f64::min, f64::max]
                    .map(|f| nodes.iter().map(|n| n.radius).reduce(f).expect("nodes"));
                assert!((point.w - want.w.clamp(low, high)).abs() < 1e-12);
            }
            assert!(close(points[points.len() - 1], four(&nodes[count - 1])));
        }
    }
}

#[test]
fn chaikin_is_the_quadratic_b_spline() {
    let mut random = Random::new(2);
    for count in 2..8 {
        let nodes = nodes(&mut random, count);
        let all: Vec<usize> = (0..count).collect();
        // The ends twice.
        let mut control: Vec<DVec4> = nodes.iter().map(four).collect();
        control.insert(0, control[0]);
        control.push(control[count]);
        for levels in 0..=6 {
            let points = points(&polyline(&nodes, &[&all], Scheme::Chaikin, levels), 0);
            assert_eq!(points.len(), (count << levels) + 1);
            for (i, &point) in points.iter().enumerate().take(points.len() - 1) {
                let want = spline(2, &control, i as f64 / f64::from(1 << levels));
                assert!(close(point, want), "{count} {levels} {i}: {point} {want}");
            }
        }
    }
}

#[test]
fn four_point_interpolates_and_reproduces_cubics() {
    let mut random = Random::new(3);
    let nodes = nodes(&mut random, 7);
    let all: Vec<usize> = (0..7).collect();
    let points_of = |nodes: &[Node]| points(&polyline(nodes, &[&all], Scheme::FourPoint, 5), 0);
    let refined = points_of(&nodes);
    for (i, node) in nodes.iter().enumerate() {
        assert_eq!(refined[i << 5], four(node));
    }
    let mut coefficients = || node(&mut random).position;
    let [a, b, c, d] = core::array::from_fn(|_| coefficients());
    let cubic = |t: f64| a + t * (b + t * (c + t * d));
    let on_cubic: Vec<Node> = (0..7)
        .map(|i| Node {
            position: cubic(f64::from(i) / 6.0),
            radius: 1.0,
        })
        .collect();
    let refined = points_of(&on_cubic);
    assert_eq!(refined.len(), 6 * 32 + 1);
    for (i, point) in refined.iter().enumerate() {
        let want = cubic(i as f64 / 192.0);
        assert!((point.truncate() - want).length() < 1e-12, "{i}");
    }
}

/// Levels are polygons of one curve: each has the points of the level before.
#[test]
fn levels_have_the_points_of_those_before() {
    let mut random = Random::new(4);
    let nodes = nodes(&mut random, 8);
    let curves: [&[usize]; 3] = [&[0, 1, 2, 3, 4], &[2, 5, 6], &[3, 6, 7, 3]];
    for scheme in SCHEMES {
        for levels in 0..6 {
            let coarse = polyline(&nodes, &curves, scheme, levels);
            let fine = polyline(&nodes, &curves, scheme, levels + 1);
            for curve in 0..3 {
                let (coarse, fine) = (points(&coarse, curve), points(&fine, curve));
                for (i, point) in coarse.iter().enumerate() {
                    assert!(
                        close(*point, fine[2 * i]),
                        "{scheme:?} {levels} {curve} {i}"
                    );
                }
            }
            let (a, b) = (coarse.lengths[0], fine.lengths[0]);
            assert!(a <= b * (1.0 + 1e-12), "{a} {b}");
        }
    }
}

/// Curves meet at their branch nodes, in one vertex, and go on without a corner.
#[test]
fn curves_pass_smoothly_through_branches() {
    let mut random = Random::new(5);
    let (mut sharp, mut all) = (0, 0);
    for _ in 0..count(20) {
        let nodes = nodes(&mut random, 9);
        // Two branches side by side; a node in the middle of two curves; a loop.
        let curves: [&[usize]; 4] = [&[0, 1, 2, 3, 4], &[2, 5], &[6, 3, 7], &[8, 1, 5, 8]];
        for scheme in SCHEMES {
            let coarse = polyline(&nodes, &curves, scheme, 2);
            for branch in [1, 2, 3, 5, 8] {
                let at = |v: &skeleton::Vertex| v.node == Some(branch);
                assert_eq!(coarse.vertices.iter().filter(|v| at(v)).count(), 1);
                let vertex = coarse.vertices.iter().position(at).expect("a vertex");
                assert_eq!(coarse.vertices[vertex].position, nodes[branch].position);
                assert_eq!(coarse.vertices[vertex].radius, nodes[branch].radius);
            }
            // The corner halves with each level.
            let corner = |levels: u32, curve: usize, node: usize| {
                let polyline = polyline(&nodes, &curves, scheme, levels);
                let points = points(&polyline, curve);
                let i = points
                    .iter()
                    .position(|p| p.truncate() == nodes[node].position)
                    .expect("on the curve");
                let way = |a: DVec4, b: DVec4| (b - a).truncate().normalize();
                // The loop's seam is at its ends.
                let before = if i == 0 { points.len() - 2 } else { i - 1 };
                way(points[before], points[i]).angle_between(way(points[i], points[i + 1]))
            };
            for (curve, node) in [(0, 1), (0, 2), (0, 3), (2, 3), (3, 1), (3, 8)] {
                let [a, b] = [5, 6].map(|levels| corner(levels, curve, node));
                assert!(b < 0.75 * a + 1e-9, "{scheme:?} {curve} {node}: {a} {b}");
                all += 1;
                sharp += usize::from(b > 1.2);
            }
        }
    }
    // Curves that turn nearly back have a corner for longer.
    assert!(50 * sharp <= all, "{sharp} of {all}");
}

#[test]
fn graphs_know_their_lengths_and_neighbours() {
    let mut random = Random::new(6);
    let nodes = nodes(&mut random, 6);
    let curves: [&[usize]; 3] = [&[0, 1, 2], &[1, 3, 4], &[4, 5]];
    for scheme in SCHEMES {
        let graph = polyline(&nodes, &curves, scheme, 3);
        let mut lengths = [0.0; 3];
        for (index, segment) in graph.segments.iter().enumerate() {
            let [a, b] = segment.ends.map(|end| graph.vertices[end].position);
            assert!((segment.length - a.distance(b)).abs() < 1e-12);
            assert_eq!(segment.start, lengths[segment.curve]);
            lengths[segment.curve] += segment.length;
            assert!(segment.span + 1 < curves[segment.curve].len());
            for end in 0..2 {
                assert!(graph.around(segment.ends[end]).contains(&index));
                for other in graph.neighbours(index, end) {
                    assert!(other != index);
                    assert!(graph.segments[other].ends.contains(&segment.ends[end]));
                }
            }
        }
        assert_eq!(graph.lengths, lengths);
        // Of every span there is a part, in order.
        for (number, curve) in curves.iter().enumerate() {
            let own = graph.segments.iter().filter(|s| s.curve == number);
            let mut spans: Vec<usize> = own.map(|s| s.span).collect();
            assert!(spans.is_sorted());
            spans.dedup();
            assert_eq!(spans, (0..curve.len() - 1).collect::<Vec<_>>());
        }
        assert_eq!(
            [0, 1, 2, 4, 5].map(|node| {
                let vertex = graph.vertices.iter().position(|v| v.node == Some(node));
                graph.around(vertex.expect("a vertex")).len()
            }),
            [1, 3, 1, 2, 1]
        );
        let total: usize = (0..graph.vertices.len())
            .map(|v| graph.around(v).len())
            .sum();
        assert_eq!(total, 2 * graph.segments.len());
    }
}

/// Straight lines, coincident nodes, loops of two nodes, nodes visited again: numbers, and nothing
/// outside the hull by more than its size.
#[test]
fn degenerate_skeletons_have_no_nan() {
    let at = |x: f64, radius: f64| Node {
        position: DVec3::new(x, 0.0, 0.0),
        radius,
    };
    let nodes = [
        at(0.0, 0.0),
        at(1.0, 1.0),
        at(1.0, 0.5),
        at(1e100, 1e100),
        at(-1e100, 0.0),
    ];
    let curves: [&[usize]; 12] = [
        &[0, 1],
        &[1, 2],
        &[0, 0],
        &[0, 0, 0],
        &[0, 0, 1],
        &[0, 1, 0],
        &[0, 1, 0, 1, 0],
        &[0, 1, 2, 0],
        &[0, 1, 1, 0],
        &[1, 0, 2, 0, 1],
        &[3, 4],
        &[3, 4, 3, 0, 4, 3],
    ];
    for scheme in SCHEMES {
        for levels in [0, 1, 3, 6] {
            let all: Vec<&[usize]> = curves.to_vec();
            let each = curves.iter().map(core::slice::from_ref);
            for curves in each.chain([&all[..]]) {
                let graph = polyline(&nodes, curves, scheme, levels);
                for vertex in &graph.vertices {
                    assert!(vertex.position.is_finite() && vertex.position.length() < 1e101);
                    assert!((0.0..=1e100).contains(&vertex.radius));
                }
                for segment in &graph.segments {
                    assert!(segment.ends[0] != segment.ends[1]);
                    assert!(segment.length.is_finite() && segment.start.is_finite());
                }
            }
        }
    }
    // A straight curve stays straight.
    for scheme in SCHEMES {
        let graph = polyline(&nodes, &[&[0, 1]], scheme, 2);
        assert!(
            graph
                .vertices
                .iter()
                .all(|v| v.position.y == 0.0 && (0.0..=1.0).contains(&v.position.x))
        );
        assert_eq!(graph.lengths, [1.0]);
    }
    let empty = Skeleton::default()
        .polyline(Scheme::Cubic, 3)
        .expect("nothing");
    assert!(empty.vertices.is_empty() && empty.segments.is_empty());
    // A curve that stays at one node has no segments.
    assert!(
        polyline(&nodes, &[&[0, 0]], Scheme::FourPoint, 0)
            .segments
            .is_empty()
    );
}

#[test]
fn mistakes_are_told_and_limits_hold() {
    let node = Node {
        position: DVec3::ZERO,
        radius: 1.0,
    };
    let of = |nodes: Vec<Node>, curves: Vec<Vec<usize>>| Skeleton { nodes, curves };
    let two = || vec![node; 2];
    let told = |skeleton: Skeleton, levels: u32| {
        let error = skeleton
            .polyline(Scheme::Cubic, levels)
            .expect_err("a mistake");
        assert!(!error.to_string().is_empty());
        error
    };
    assert_eq!(told(of(two(), vec![vec![0]]), 3), Error::Short(0));
    assert_eq!(
        told(of(two(), vec![vec![0, 1], vec![]]), 3),
        Error::Short(1)
    );
    assert_eq!(told(of(two(), vec![vec![0, 2]]), 3), Error::Unknown(0));
    assert_eq!(told(of(two(), vec![vec![0, 1]]), 7), Error::Levels(7));
    assert_eq!(
        told(of(vec![node; MOST_NODES + 1], vec![]), 3),
        Error::Nodes(MOST_NODES + 1)
    );
    assert_eq!(
        told(of(two(), vec![vec![0, 1]; MOST_CURVES + 1]), 3),
        Error::Curves(MOST_CURVES + 1)
    );
    for bad in [f64::NAN, f64::INFINITY, -f64::INFINITY, 1e101] {
        let position = DVec3::new(0.0, bad, 0.0);
        let nodes = vec![node, Node { position, ..node }];
        assert_eq!(told(of(nodes, vec![vec![0, 1]]), 3), Error::Node(1));
        let nodes = vec![Node {
            radius: bad,
            ..node
        }];
        assert_eq!(told(of(nodes, vec![]), 3), Error::Node(0));
    }
    let negative = vec![Node {
        radius: -1.0,
        ..node
    }];
    assert_eq!(told(of(negative, vec![]), 3), Error::Node(0));
    // As many segments as there may be, and one more curve.
    let long: Vec<usize> = (0..=MOST_SEGMENTS / 64).map(|i| i % 2).collect();
    assert_eq!(long.len() - 1, MOST_SEGMENTS / 64);
    let whole = of(two(), vec![long.clone()]);
    let graph = whole
        .polyline(Scheme::FourPoint, 6)
        .expect("within the limits");
    assert_eq!(graph.segments.len(), MOST_SEGMENTS);
    assert_eq!(told(of(two(), vec![long, vec![0, 1]]), 6), Error::Segments);
}
