//! Animals as a newcomer draws them: stroke by stroke on the page, through the same edits as in the
//! page.

use emath::{Pos2, Rect, pos2, vec2};
use rats::{Compiled, Project, compile};
use sketch::edits::{self, Base, Brush, Intent};
use sketch::{Drawn, Mark, Sight, Stroke, page};

/// The strokes of a newcomer, as shares of the picture: body, neck, head, two pairs of legs, tail.
const STROKES: [&[[f32; 2]]; 6] = [
    &[[0.3, 0.5], [0.5, 0.47], [0.68, 0.5]],
    &[[0.68, 0.48], [0.74, 0.42], [0.77, 0.36]],
    &[[0.77, 0.36], [0.81, 0.36], [0.87, 0.37]],
    &[[0.64, 0.52], [0.65, 0.6], [0.64, 0.67]],
    &[[0.33, 0.52], [0.32, 0.6], [0.33, 0.67]],
    &[[0.3, 0.5], [0.22, 0.47], [0.15, 0.4]],
];

/// A page that is drawn on.
struct Paper {
    project: Project,
    compiled: Compiled,
    rect: Rect,
}

impl Paper {
    fn new(width: f32, height: f32) -> Self {
        let project = Project::single(page::fresh(f64::from(height / width)));
        Self {
            compiled: compile(&project),
            project,
            rect: Rect::from_min_size(Pos2::ZERO, vec2(width, height)),
        }
    }

    fn all(&self) -> Vec<Drawn> {
        Drawn::all(&self.project, &self.compiled)
    }

    /// Draws a stroke through places of the page, shares of its sides.
    fn draw(&mut self, places: &[[f32; 2]]) {
        let all = self.all();
        let camera = self.compiled.scene.camera;
        let sight = Sight::new(&camera, self.rect);
        let thick = if all.is_empty() { 36.0 } else { 14.0 };
        let brush = Brush {
            radius: thick * self.rect.width() / 640.0,
            mirror: true,
            colour: None,
            touch: false,
        };
        let marks = places.windows(2).flat_map(|ends| {
            (0..=8).map(move |i| {
                let t = i as f32 / 8.0;
                [0, 1].map(|k| ends[0][k] + (ends[1][k] - ends[0][k]) * t)
            })
        });
        let marks = marks.map(|[x, y]| Mark {
            at: [x * self.rect.width(), y * self.rect.height()],
            pressure: None,
        });
        let mut marks = marks.into_iter();
        let mut stroke = Stroke::begin(marks.next().expect("a place"));
        marks.for_each(|mark| stroke.push(mark));
        let [x, y] = stroke.marks()[0].at;
        let intent = Intent {
            heading: edits::heading(&stroke),
            pair: None,
        };
        let home = camera.target;
        let begin = edits::begin(&all, &sight, pos2(x, y), &brush, intent, home, || None);
        let (begin, stroke) = edits::orient(&all, &sight, &brush, begin, &stroke, None, home);
        let samples = begin.samples(&sight, &stroke);
        let point = sight.point(begin.plane.0);
        let change = edits::draw(&self.project, &all, &begin, &samples, &brush, point);
        let base = Base {
            project: &self.project,
            assets: &[],
            frame: 0.0,
            compiled: &self.compiled,
        };
        let (_, project, compiled) =
            edits::check(&base, change.expect("a limb")).expect("no mistake");
        (self.project, self.compiled) = (project, compiled);
    }

    /// The heights of curves' ends above the lowest flesh, as shares of the animal's size.
    fn ends(&self) -> Vec<f64> {
        let all = self.all();
        let points: Vec<_> = all.iter().flat_map(Drawn::limbs).flatten().collect();
        let sides = [0, 1, 2].map(|axis| {
            let low = points.iter().map(|(p, r)| p[axis] - r);
            let high = points.iter().map(|(p, r)| p[axis] + r);
            [
                low.fold(f64::INFINITY, f64::min),
                high.fold(f64::NEG_INFINITY, f64::max),
            ]
        });
        let size = sides
            .map(|[low, high]| high - low)
            .into_iter()
            .fold(0.0, f64::max);
        let skeleton = &all[0].skeleton;
        let ends = skeleton.curves.iter().filter_map(|along| along.last());
        ends.map(|node| {
            let node = skeleton.nodes[*node];
            (node.position.y - node.radius - sides[1][0]) / size
        })
        .collect()
    }
}

#[test]
fn the_feet_of_a_newcomers_animal_stand_on_the_ground() {
    // No hand ends where it means to.
    let errors = [-0.015, 0.0, 0.015];
    let slips = errors
        .iter()
        .flat_map(|fore| errors.map(|hind| [*fore, hind]));
    for [fore, hind] in slips {
        for (width, height) in [(828.0, 621.0), (390.0, 640.0)] {
            let mut paper = Paper::new(width, height);
            for (number, stroke) in STROKES.iter().enumerate() {
                let mut places = stroke.to_vec();
                places[stroke.len() - 1][1] += match number {
                    3 => fore,
                    4 => hind,
                    _ => 0.0,
                };
                paper.draw(&places);
            }
            let mut ends = paper.ends();
            ends.sort_by(f64::total_cmp);
            assert!(ends[3] < 0.02, "{ends:?}\n{}", paper.project.files[0].text);
            assert!(ends[4] > 0.2, "{ends:?}\n{}", paper.project.files[0].text);
        }
    }
}

#[test]
fn a_limb_that_hangs_in_the_air_stays_there() {
    let mut paper = Paper::new(828.0, 621.0);
    for stroke in &STROKES[..4] {
        paper.draw(stroke);
    }
    let before = paper.ends();
    paper.draw(&[[0.45, 0.5], [0.45, 0.54], [0.45, 0.56]]);
    let after = paper.ends();
    assert_eq!(
        after.len(),
        before.len() + 2,
        "{}",
        paper.project.files[0].text
    );
    assert!(
        after[before.len()..].iter().all(|end| *end > 0.1),
        "{after:?}"
    );
}
