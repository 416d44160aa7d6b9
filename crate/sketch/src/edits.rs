//! Gestures made into texts: the beginning of a stroke, its way through space, and the edits that
//! it makes.

use crate::Sight;
use crate::drawn::{Drawn, Spot, node_at, spot_at};
use crate::page;
use crate::{Limb, Sample, Start, Stroke};
use emath::{Pos2, Vec2, pos2};
use glam::{DAffine3, DVec3};
use rats::{Asset, Compiled, Diagnostic, Project, Severity, TextEdit};
use scene::Rgb;
use skeleton::Node;

/// Thickness of a long stroke at its free end, as a share of that at its root. A short one is a
/// head or a paw, and equally thick all along.
const TIP: f64 = 0.6;
/// Lengths in radii up to which a stroke is short, and from which it is long.
const SHORT: [f64; 2] = [3.5, 9.0];
/// Thickness of the ends of a stroke that begins in the air, as a share of that of its middle.
const ENDS: f64 = 0.75;
/// Least distances of the limbs of a pair from the mirror, in radii of the brush and of the flesh
/// that they grow from.
const APART: [f64; 2] = [1.2, 0.85];
/// A short stroke from an end is a head or a paw, thicker than the end: lengths in radii at which
/// that begins, is greatest and is over, and the greatest factor.
const EGG: ([f64; 3], f64) = ([1.5, 6.0, 14.0], 1.8);
/// Most radius of an end that is a neck or an ankle, in radii of the brush.
const THIN: f64 = 1.3;
/// Most distance from the ground at which a leg ends on it, as a share of its root's height above
/// the ground: in a view from above, feet drawn at one height of the picture are not at one height.
const STEP: f64 = 0.45;
/// Radius at no and at full pressure of a pen, as shares of the brush's.
const PRESSURE: [f64; 2] = [0.3, 1.5];
/// Least cosine of the angle between the line of sight and the mirror's normal at which strokes are
/// drawn on the mirror itself.
const FACING: f64 = 0.6;

/// The brush of strokes.
#[derive(Clone, Copy, Debug)]
pub struct Brush {
    /// Radius, points of the screen.
    pub radius: f32,
    /// Whether strokes are mirrored at x = 0 of the model.
    pub mirror: bool,
    /// The colour; `None` for the root's.
    pub colour: Option<Rgb>,
    /// Whether fingers are likely.
    pub touch: bool,
}

/// The part of a skeleton that a stroke grows from.
#[derive(Clone, Copy, Debug)]
pub enum Root {
    /// None: the stroke begins in the air, or on a shape that is no skeleton.
    Free,
    /// A node: indices of skeleton and node.
    Node(usize, usize),
    /// An open end whose curve goes on: indices of skeleton and node.
    End(usize, usize),
    /// A place of a curve.
    Spot(Spot),
}

/// The beginning of a stroke.
#[derive(Clone, Copy, Debug)]
pub struct Beginning {
    /// The root.
    pub root: Root,
    /// The place at which the curve begins, if it grows from something.
    pub place: Option<DVec3>,
    /// A point of the plane that the stroke is drawn on, and the normal.
    pub plane: (DVec3, DVec3),
    /// Radius of the brush there.
    pub radius: f64,
    /// Whether the mirrored stroke is drawn as well.
    pub pair: bool,
    /// Whether it goes on from an end that is hardly thicker than the brush: then a short stroke is
    /// a head or a paw.
    pub tip: bool,
    /// Map to the world from the model's own coordinates, in which the mirror is x = 0.
    pub to_world: DAffine3,
}

/// Hints about a stroke whose beginning is looked for.
#[derive(Clone, Copy, Debug, Default)]
pub struct Intent {
    /// Direction on the screen; `None` while the stroke is too short to have one.
    pub heading: Option<Vec2>,
    /// Whether it should be one of a pair; `None` to decide that by beginning and heading.
    pub pair: Option<bool>,
}

/// Cosine of the angle between an end's direction and a stroke's below which the stroke has a curve
/// of its own, so that the flesh keeps its corner.
const STRAIGHT: f32 = 0.6;
/// Cosine of that angle below which a stroke that goes down from an end is a leg, and not the end's
/// continuation.
const SIDEWAYS: f32 = 0.4;
/// Cosine of that angle below which any stroke goes back, and grows beside the end.
const BACK: f32 = -0.3;

/// The way in which a stroke leaves an open end.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Departure {
    /// A continuation along the end's curve.
    On,
    /// A new curve, round a corner.
    Corner,
    /// A limb of its own, which grows beside the end.
    Beside,
}

/// Returns the way in which a stroke with a heading leaves an open end.
fn departure(drawn: &Drawn, node: usize, sight: &Sight, heading: Option<Vec2>) -> Departure {
    let screen = |node: usize| {
        let position = drawn.skeleton.nodes[node].position;
        sight.screen(drawn.to_world.transform_point3(position))
    };
    // The end's direction, from the middle of its curve: the very end of a body often hangs down.
    let out = drawn.before(node).and_then(|before| {
        let along = drawn.skeleton.curves.iter().find(|along| {
            along
                .windows(2)
                .any(|ends| ends == [node, before] || ends == [before, node])
        })?;
        let places: Vec<Pos2> = along.iter().filter_map(|node| screen(*node)).collect();
        let sum = places
            .iter()
            .fold(Vec2::ZERO, |sum, place| sum + place.to_vec2());
        let out = screen(node)?.to_vec2() - sum / places.len() as f32;
        (out.length() > 1.0).then(|| out.normalized())
    });
    let (Some(out), Some(heading)) = (out, heading) else {
        return Departure::On;
    };
    let heading = heading.normalized();
    let cosine = out.dot(heading);
    let is_flat = drawn.is_flat(node);
    if cosine < BACK || is_flat && cosine < SIDEWAYS && heading.y > 0.5 {
        Departure::Beside
    } else if cosine < STRAIGHT {
        Departure::Corner
    } else {
        Departure::On
    }
}

/// Returns the skeleton of a stroke without a root: the last one that drawing can change, of the
/// brush's colour if it has one.
#[must_use]
pub fn target(all: &[Drawn], colour: Option<Rgb>) -> Option<usize> {
    all.iter()
        .rposition(|drawn| drawn.block.is_some() && is_colour(drawn.colour, colour))
}

/// Whether a colour is nearly the wanted one, if there is one.
fn is_colour(own: Rgb, wanted: Option<Rgb>) -> bool {
    wanted.is_none_or(|wanted| own.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 2e-3))
}

/// Finds the beginning of a stroke from a place of the screen. From an open end it goes on, unless
/// it goes down or back from there; from elsewhere on flesh that the mirror cuts it is one of a
/// pair. `meets` returns the place at which the ray from the eye meets a shape that is no skeleton;
/// `home` is a place at the depth of strokes on an empty page.
#[must_use]
pub fn begin(
    all: &[Drawn],
    sight: &Sight,
    at: Pos2,
    brush: &Brush,
    intent: Intent,
    home: DVec3,
    meets: impl FnOnce() -> Option<DVec3>,
) -> Beginning {
    let ahead = -sight.projection.world_from_view.z_axis;
    let (end_reach, extra) = if brush.touch {
        (20.0, 8.0)
    } else {
        (12.0, 4.0)
    };
    let single = !brush.mirror || intent.pair == Some(false);
    let end = node_at(all, sight, at, end_reach, true).and_then(|(index, node)| {
        let departure = departure(&all[index], node, sight, intent.heading);
        let is_beside = match intent.pair {
            Some(pair) if all[index].is_flat(node) => pair,
            _ => departure == Departure::Beside,
        };
        (!is_beside).then_some((index, node, departure == Departure::On))
    });
    let spot = if end.is_none() {
        spot_at(all, sight, at, extra).or_else(|| spot_at(all, sight, at, end_reach))
    } else {
        None
    };
    let model = end
        .map(|(drawn, ..)| drawn)
        .or(spot.map(|spot| spot.drawn))
        .or_else(|| target(all, brush.colour).or_else(|| target(all, None)));
    let (to_world, growth) = model.map_or((DAffine3::IDENTITY, 1.0), |index| {
        (all[index].to_world, all[index].growth)
    });
    let own = |place: DVec3| to_world.inverse().transform_point3(place);
    let mirror = to_world.matrix3.inverse().transpose() * DVec3::X;
    let mirror = mirror.try_normalize().unwrap_or(DVec3::X);
    let faces = mirror.dot(ahead).abs() >= FACING;
    let radius = |place: DVec3| f64::from(brush.radius) * sight.point(place);
    let is_middle = |place: DVec3| own(place).x.abs() * growth <= 0.2 * radius(place);
    let make = |root, place: Option<DVec3>, through: DVec3, pair, on_mirror: bool| Beginning {
        root,
        place,
        plane: (through, if on_mirror { mirror } else { -ahead }),
        radius: radius(through),
        pair,
        tip: false,
        to_world,
    };
    if let Some((index, node, goes_on)) = end {
        let place = all[index].knobs[node].0;
        let flat = brush.mirror && faces && is_middle(place);
        let root = if goes_on {
            Root::End(index, node)
        } else {
            Root::Node(index, node)
        };
        let begin = make(root, Some(place), place, !single && !flat, flat);
        let tip = all[index].radius(node) <= THIN * begin.radius;
        return Beginning { tip, ..begin };
    }
    if let Some(spot) = spot {
        let drawn = &all[spot.drawn];
        let root = match drawn.node_at_spot(&spot) {
            Some(node) => Root::Node(spot.drawn, node),
            None => Root::Spot(spot),
        };
        let place = match root {
            Root::Node(index, node) => all[index].knobs[node].0,
            _ => spot.place,
        };
        // Within the flesh, but near the eye's side, so that the limbs of a pair stand apart.
        let mut through = spot.place.lerp(spot.surface, 0.6);
        let flat = single && brush.mirror && faces && is_middle(place);
        if flat {
            let mut inside = own(place);
            inside.x = 0.0;
            through = to_world.transform_point3(inside);
        } else if !single && faces {
            let apart = (APART[0] * radius(through)).max(APART[1] * spot.radius);
            let least = (apart / growth).max(1e-9);
            let mut inside = own(through);
            if inside.x.abs() < least {
                let side = if inside.x.abs() > 0.2 * least {
                    inside.x
                } else {
                    own(sight.projection.eye).x
                };
                inside.x = least.copysign(side);
                through = to_world.transform_point3(inside);
            }
        }
        // If the mirror is seen from the side, both limbs keep their distance from it.
        let along = brush.mirror && faces;
        let mut begin = make(root, Some(place), through, !single, along);
        if drawn.block.is_none() {
            begin.root = Root::Free;
        }
        return begin;
    }
    if let Some(met) = meets() {
        let inside = met + ahead * (0.4 * radius(met));
        return make(Root::Free, Some(inside), inside, !single, false);
    }
    let middle = model.map_or(home, |index| all[index].middle());
    let flat = brush.mirror && faces;
    let mut through = middle;
    if flat {
        let mut inside = own(middle);
        inside.x = 0.0;
        through = to_world.transform_point3(inside);
    }
    make(Root::Free, None, through, !single && !flat, flat)
}

impl Beginning {
    /// Returns the place at which a ray through a place of the screen meets the plane that the
    /// stroke is drawn on; `None` if that is behind the eye, too far away or seen from the edge.
    #[must_use]
    pub fn on_plane(&self, sight: &Sight, at: Pos2) -> Option<DVec3> {
        let (through, normal) = self.plane;
        let ray = sight.direction(at);
        let eye = sight.projection.eye;
        let slope = ray.dot(normal);
        let t = (through - eye).dot(normal) / slope;
        let far = 30.0 * eye.distance(through);
        let place = eye + ray * t;
        (slope.abs() > 0.05 && t > 0.0 && t < far && place.is_finite()).then_some(place)
    }

    /// Returns the stroke as samples in the world.
    #[must_use]
    pub fn samples(&self, sight: &Sight, stroke: &Stroke) -> Vec<Sample> {
        let marks = stroke.marks();
        let start = marks[0].at;
        let start = pos2(start[0], start[1]);
        let mut points: Vec<(DVec3, Option<f32>)> = Vec::with_capacity(marks.len() + 1);
        let mut leave = 0.0;
        if let Some(place) = self.place {
            points.push((place, marks[0].pressure));
            // The pointer starts beside the curve. Marks count once they are as far away from
            // there.
            let at = sight.screen(place);
            leave = at.map_or(0.0, |at| at.distance(start).clamp(4.0, 40.0));
        }
        let away = marks
            .iter()
            .position(|mark| start.distance(pos2(mark.at[0], mark.at[1])) >= leave);
        // Of a short stub the last mark counts.
        for mark in &marks[away.unwrap_or(marks.len() - 1)..] {
            if let Some(place) = self.on_plane(sight, pos2(mark.at[0], mark.at[1])) {
                points.push((place, mark.pressure));
            }
        }
        let mut along = vec![0.0];
        for pair in points.windows(2) {
            along.push(along[along.len() - 1] + pair[0].0.distance(pair[1].0));
        }
        let length = along[along.len() - 1].max(f64::MIN_POSITIVE);
        let radii = length / self.radius.max(f64::MIN_POSITIVE);
        let long = (radii - SHORT[0]) / (SHORT[1] - SHORT[0]);
        let tip = 1.0 + (TIP - 1.0) * long.clamp(0.0, 1.0);
        let egg = if self.tip { egg(radii) } else { 1.0 };
        let mut samples = Vec::with_capacity(points.len());
        for ((position, pressure), along) in points.into_iter().zip(along) {
            let share = along / length;
            let thickness = match pressure {
                Some(pressure) => {
                    PRESSURE[0] + (PRESSURE[1] - PRESSURE[0]) * f64::from(pressure.clamp(0.0, 1.0))
                }
                None if self.place.is_some() => egg * (1.0 + (tip - 1.0) * share),
                None => ENDS + (1.0 - ENDS) * libm::sin(share * std::f64::consts::PI),
            };
            samples.push(Sample {
                position,
                radius: self.radius * thickness,
            });
        }
        samples
    }

    /// Mirrors a place of the world.
    #[must_use]
    pub fn mirror(&self, place: DVec3) -> DVec3 {
        let own = self.to_world.inverse().transform_point3(place);
        self.to_world
            .transform_point3(own * DVec3::new(-1.0, 1.0, 1.0))
    }
}

/// Returns the factor on the thickness of a stroke from an end, by its length in radii.
fn egg(radii: f64) -> f64 {
    let ([none, most, long], thick) = EGG;
    let share = if radii < most {
        (radii - none) / (most - none)
    } else {
        (long - radii) / (long - most)
    };
    1.0 + (thick - 1.0) * share.clamp(0.0, 1.0)
}

/// Returns a stroke's direction on the screen, from its beginning to its middle; `None` while it is
/// short.
#[must_use]
pub fn heading(stroke: &Stroke) -> Option<Vec2> {
    let mut places = stroke.marks().iter().map(|m| pos2(m.at[0], m.at[1]));
    let start = places.next()?;
    let half = 0.5 * stroke.reach();
    let middle = places.find(|place| start.distance(*place) >= half)?;
    (half >= 6.0).then(|| middle - start)
}

/// Reverses a stroke that begins in the air and ends on flesh, so that it grows from there. Returns
/// its beginning and the stroke.
#[must_use]
pub fn orient(
    all: &[Drawn],
    sight: &Sight,
    brush: &Brush,
    begin: Beginning,
    stroke: &Stroke,
    pair: Option<bool>,
    home: DVec3,
) -> (Beginning, Stroke) {
    if begin.place.is_some() {
        return (begin, stroke.clone());
    }
    let reversed = stroke.reversed();
    let start = reversed.marks()[0].at;
    let intent = Intent {
        heading: heading(&reversed),
        pair,
    };
    let at = pos2(start[0], start[1]);
    let other = self::begin(all, sight, at, brush, intent, home, || None);
    if other.place.is_some() {
        (other, reversed)
    } else {
        (begin, stroke.clone())
    }
}

/// Returns the text with a new curve along samples of the world, and its mirrored one; `None` if
/// the stroke is too short. `point` is the length of a point of the screen there.
#[must_use]
pub fn draw(
    project: &Project,
    all: &[Drawn],
    begin: &Beginning,
    samples: &[Sample],
    brush: &Brush,
    point: f64,
) -> Option<TextEdit> {
    // A stroke of another colour goes into another skeleton.
    let root = match begin.root {
        Root::Node(index, _) | Root::End(index, _) => Some(index),
        Root::Spot(spot) => Some(spot.drawn),
        Root::Free => None,
    };
    let root = root.filter(|index| is_colour(all[*index].colour, brush.colour));
    let into = root.or_else(|| target(all, brush.colour));
    let (to_world, growth) = match into {
        Some(index) => (all[index].to_world, all[index].growth),
        None => (DAffine3::IDENTITY, 1.0),
    };
    let inverse = to_world.inverse();
    let growth = growth.max(f64::MIN_POSITIVE);
    let own: Vec<Sample> = samples
        .iter()
        .map(|sample| Sample {
            position: inverse.transform_point3(sample.position),
            radius: sample.radius / growth,
        })
        .collect();
    let unit = point / growth;
    let shake = if brush.touch { 5.0 } else { 3.0 };
    let mut nodes = crate::fit(&own, shake * unit)?;
    let is_leg = begin.place.is_some() && (begin.pair || !brush.mirror);
    if let Some(ground) = lowest(all).filter(|_| is_leg && has_ground(project)) {
        stand(&mut nodes, to_world, growth, ground);
    }
    let flipped: Vec<Node> = nodes
        .iter()
        .map(|node| Node {
            position: node.position * DVec3::new(-1.0, 1.0, 1.0),
            ..*node
        })
        .collect();
    let mut limbs = Vec::new();
    let start = root.map(|index| (index, start_at(&all[index], begin)));
    match start {
        Some((index, Some(start))) => {
            let drawn = &all[index];
            let twin = begin.pair.then(|| twin_start(drawn, index, &start, begin));
            limbs.push(Limb {
                start,
                nodes: nodes[1..].to_vec(),
            });
            match twin {
                Some(Some(start)) => limbs.push(Limb {
                    start,
                    nodes: flipped[1..].to_vec(),
                }),
                Some(None) => limbs.push(Limb {
                    start: Start::Free,
                    nodes: flipped,
                }),
                None => {}
            }
        }
        _ => {
            limbs.push(Limb {
                start: Start::Free,
                nodes,
            });
            if begin.pair {
                limbs.push(Limb {
                    start: Start::Free,
                    nodes: flipped,
                });
            }
        }
    }
    let grain = 0.5 * unit;
    if let Some(index) = into {
        let drawn = &all[index];
        let text = &project.files.get(drawn.file)?.text;
        let text = crate::extend(text, drawn.span.clone(), &limbs, grain)?;
        return Some(TextEdit::whole(drawn.file, text));
    }
    let colour = brush.colour.unwrap_or(page::COLOURS[0].1);
    let (text, material) = page::with_surface(project, colour, true)?;
    let name = crate::free_name(page::texts(project), "DRAWING");
    let text = crate::create(&text, &material, &name, &limbs, grain)?;
    Some(TextEdit::whole(0, text))
}

/// Whether one of the texts has the ground of the page.
fn has_ground(project: &Project) -> bool {
    page::texts(project).any(|text| page::ground(text).is_some())
}

/// Bends a leg so that it ends on the ground, if it goes down to it or nearly so: the farther below
/// its root, the more. `ground` is the height in the world.
fn stand(nodes: &mut [Node], to_world: DAffine3, growth: f64, ground: f64) {
    let heights = nodes.iter();
    let heights: Vec<f64> = heights
        .map(|node| to_world.transform_point3(node.position).y)
        .collect();
    let ([root, .., end], Some(last)) = (&heights[..], nodes.last()) else {
        return;
    };
    let tip = end - last.radius * growth;
    let is_lowest = heights.iter().all(|height| height >= end);
    let off = ground - tip;
    if !is_lowest || off.abs() > STEP * (root - ground) {
        return;
    }
    let up = to_world.inverse().transform_vector3(DVec3::Y * off);
    for (node, height) in nodes.iter_mut().zip(&heights) {
        node.position += up * ((root - height) / (root - end)).clamp(0.0, 1.0);
    }
}

/// Returns the start of a curve that grows from a skeleton.
fn start_at(drawn: &Drawn, begin: &Beginning) -> Option<Start> {
    drawn.block.as_ref()?;
    match begin.root {
        Root::Free => None,
        Root::Node(_, node) => Some(Start::Node(node)),
        Root::End(_, node) => Some(Start::End(node)),
        Root::Spot(spot) => Some(Start::Between {
            curve: spot.curve,
            span: spot.span,
            share: spot.share,
            node: drawn.node_of(&spot),
        }),
    }
}

/// Returns the start of the mirrored curve; `None` if the skeleton is not there.
fn twin_start(drawn: &Drawn, index: usize, start: &Start, begin: &Beginning) -> Option<Start> {
    let place = begin.place?;
    let own = drawn.to_own(place);
    let radius = match start {
        Start::Node(node) | Start::End(node) => drawn.skeleton.nodes[*node].radius,
        Start::Between { node, .. } => node.radius,
        _ => return None,
    };
    if own.x.abs() <= 0.35 * radius {
        return Some(Start::Same);
    }
    let there = own * DVec3::new(-1.0, 1.0, 1.0);
    if let Some(node) = drawn.node_near(there, 0.3 * radius) {
        return Some(match start {
            Start::End(_) => Start::End(node),
            _ => Start::Node(node),
        });
    }
    let place = drawn.to_world.transform_point3(there);
    let spot = drawn.spot_near(index, place, 1.5 * radius * drawn.growth)?;
    Some(match drawn.node_at_spot(&spot) {
        Some(node) => Start::Node(node),
        None => Start::Between {
            curve: spot.curve,
            span: spot.span,
            share: spot.share,
            node: drawn.node_of(&spot),
        },
    })
}

/// Returns the text with a bead on the flesh, and its mirrored one.
#[must_use]
pub fn bead(
    project: &Project,
    begin: &Beginning,
    at: DVec3,
    colour: Rgb,
    point: f64,
) -> Option<TextEdit> {
    let radius = 0.6 * begin.radius;
    let (mut text, material) = page::with_surface(project, colour, false)?;
    if !text.ends_with('\n') {
        text.push('\n');
    }
    let mut centers = vec![at];
    let other = begin.mirror(at);
    if begin.pair && other.distance(at) > radius {
        centers.push(other);
    }
    for center in centers {
        let [x, y, z] = center.to_array().map(|x| number(x, 0.5 * point));
        let radius = number(radius, 0.1 * point);
        text += &format!("sphere {material} {radius}, <{x} {y} {z}>\n");
    }
    Some(TextEdit::whole(0, text))
}

/// Writes a number without digits below the power of ten at or under the grain.
fn number(x: f64, grain: f64) -> String {
    let decimals = (-libm::floor(libm::log10(grain.max(1e-9)))).clamp(0.0, 9.0) as usize;
    let text = format!("{x:.decimals$}");
    let short = if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.')
    } else {
        &text
    };
    if short == "-0" { "0" } else { short }.to_owned()
}

/// Returns the height of the lowest flesh; `None` if there is none.
fn lowest(all: &[Drawn]) -> Option<f64> {
    let lows = all.iter().flat_map(Drawn::limbs).flatten();
    lows.map(|(place, radius)| place.y - radius)
        .min_by(f64::total_cmp)
        .filter(|low| low.is_finite())
}

/// Returns the text with the ground of the page moved to the lowest flesh, so that the creature
/// stands on it. Unchanged if the text has another ground.
#[must_use]
pub fn put_on_ground(text: &str, all: &[Drawn]) -> String {
    let Some(range) = page::ground(text) else {
        return text.to_owned();
    };
    let Some(low) = lowest(all) else {
        return text.to_owned();
    };
    let height = number(low, 0.01);
    format!("{}{height}{}", &text[..range.start], &text[range.end..])
}

/// The texts that a gesture changes, and what they make.
pub struct Base<'a> {
    /// The texts.
    pub project: &'a Project,
    /// The images and meshes beside them.
    pub assets: &'a [Asset],
    /// Frame of the film.
    pub frame: f64,
    /// The result of compiling them.
    pub compiled: &'a Compiled,
}

fn is_error(diagnostic: &&Diagnostic) -> bool {
    diagnostic.severity == Severity::Error
}

/// Checks that a change makes no new mistakes. Returns the change with the ground moved, the texts
/// and the result of compiling them.
///
/// # Errors
/// If it makes a mistake, with the compiler's message.
pub fn check(
    base: &Base<'_>,
    change: TextEdit,
) -> Result<(TextEdit, Project, rats::Compiled), String> {
    let file = change.file;
    let project = base.project.apply(&[change]);
    let compiled = rats::compile_at(&project, base.assets, base.frame);
    let mut errors = compiled.diagnostics.iter().filter(is_error);
    let before = &base.compiled.diagnostics;
    if errors.clone().count() > before.iter().filter(is_error).count() {
        let new = errors.find(|d| before.iter().all(|old| old.message != d.message));
        let why = new.map_or("the text would have a mistake", |d| &d.message);
        return Err(format!("This cannot be drawn here: {why}."));
    }
    let text = project.files.get(file).map_or("", |file| &file.text);
    let text = put_on_ground(text, &Drawn::all(&project, &compiled));
    Ok((TextEdit::whole(file, text), project, compiled))
}

/// Makes a change, and then the same one on the other side of the mirror, in one step. `again`
/// makes the second change from the texts and skeletons after the first.
///
/// # Errors
/// If the first change makes a mistake, as [`check`] does.
pub fn twice(
    base: &Base<'_>,
    change: TextEdit,
    again: impl FnOnce(&Project, &[Drawn]) -> Option<TextEdit>,
) -> Result<TextEdit, String> {
    let (first, project, compiled) = check(base, change)?;
    let all = Drawn::all(&project, &compiled);
    match again(&project, &all).filter(|second| second.file == first.file) {
        Some(second) => check(base, second.clone())
            .map(|(change, ..)| change)
            .or(Ok(first)),
        None => Ok(first),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A leg that is too long bends in what falls, and its foot stays level.
    #[test]
    fn a_leg_stands_on_its_whole_foot() {
        let places = [
            [0.0, 1.0],
            [0.0, 0.66],
            [0.0, 0.33],
            [0.0, 0.02],
            [0.3, 0.0],
        ];
        let mut nodes = places.map(|[x, y]| Node {
            position: DVec3::new(x, y, 0.0),
            radius: 0.0,
        });
        stand(&mut nodes, DAffine3::IDENTITY, 1.0, 0.3);
        let [root, .., heel, toe] = nodes.map(|node| node.position.y);
        assert!(root == 1.0 && (toe - 0.3).abs() < 1e-12);
        assert!(heel >= toe && heel < toe + 0.02, "{heel}");
    }
}
