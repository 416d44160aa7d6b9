//! Materials of a mesh's triangles: each has that which is strongest in its middle.

use crate::counted::Counted;
use field::{Ball, Implicit, Part, Slack, THRESHOLD};
use glam::DVec3;
use scene::{Scene, Surface};

/// Bounds on what is left out where the strongest is looked for.
const SLACK: Slack = Slack {
    left_out: 0.05 * THRESHOLD,
    far: 0.0,
};
/// Most triangles that are looked at one by one, or all as one if the function is no sum.
const FEW: usize = 8;

/// A body and the materials of its triangles.
struct Painter<'a> {
    function: &'a Counted<'a>,
    surface: &'a Surface,
    /// The material of each term.
    finishes: Vec<u32>,
    /// The materials found.
    found: Vec<u32>,
}

/// Returns the materials of triangles by their middles.
pub(crate) fn paint(
    scene: &Scene,
    surface: &Surface,
    function: &Counted<'_>,
    middles: impl Iterator<Item = DVec3>,
) -> Vec<u32> {
    let mut middles: Vec<(u32, DVec3)> = (0..).zip(middles).collect();
    let elements = surface.element().iter();
    let finishes: Vec<u32> = elements
        .map(|element| scene.elements[*element as usize].finish)
        .collect();
    let found = vec![finishes.first().copied().unwrap_or(0); middles.len()];
    let mut painter = Painter {
        function,
        surface,
        finishes,
        found,
    };
    painter.paint(None, &mut middles);
    painter.found
}

/// Returns the material that all have, if there is one.
fn same_of(mut finishes: impl Iterator<Item = u32>) -> Option<u32> {
    let first = finishes.next()?;
    finishes.all(|finish| finish == first).then_some(first)
}

impl Painter<'_> {
    /// Finds the materials of triangles that lie together, among the terms of a part.
    fn paint(&mut self, among: Option<&Part>, middles: &mut [(u32, DVec3)]) {
        let places = middles.iter().map(|(_, place)| *place);
        let (low, high) = places.fold(
            (DVec3::INFINITY, DVec3::NEG_INFINITY),
            |(low, high), place| (low.min(place), high.max(place)),
        );
        // The terms of other functions are no elements.
        let part = match self.surface {
            Surface::Sum(_) => {
                let (center, radius) = (low.midpoint(high), 0.5 * low.distance(high));
                self.function.narrow(Ball { center, radius }, among, SLACK)
            }
            Surface::Composed(_) => None,
        };
        let among = part.as_ref().or(among);
        if let Some(only) = self.only(among) {
            self.give(middles, only);
        } else if middles.len() <= FEW {
            let alike = match self.surface {
                Surface::Sum(_) => 1,
                Surface::Composed(_) => FEW,
            };
            for group in middles.chunks(alike) {
                let strongest = self.strongest(among, group[0].1);
                self.give(group, strongest);
            }
        } else {
            let size = high - low;
            let axis = (0..3).max_by(|&i, &j| size[i].total_cmp(&size[j]));
            let axis = axis.unwrap_or(0);
            let half = middles.len() / 2;
            middles.select_nth_unstable_by(half, |(i, a), (j, b)| {
                a[axis].total_cmp(&b[axis]).then(i.cmp(j))
            });
            let (first, second) = middles.split_at_mut(half);
            self.paint(among, first);
            self.paint(among, second);
        }
    }

    fn give(&mut self, middles: &[(u32, DVec3)], finish: u32) {
        for (triangle, _) in middles {
            self.found[*triangle as usize] = finish;
        }
    }

    /// Returns the material that all terms of a part have, if there is one.
    fn only(&self, part: Option<&Part>) -> Option<u32> {
        match part {
            Some(part) => same_of(part.terms.iter().map(|i| self.finishes[*i as usize])),
            None => same_of(self.finishes.iter().copied()),
        }
    }

    /// Returns the material with the largest share of the function at a place.
    fn strongest(&self, part: Option<&Part>, place: DVec3) -> u32 {
        let mut shares = Vec::new();
        match (self.surface, part) {
            (Surface::Sum(sum), Some(part)) => {
                self.function.note(part);
                let terms = part.terms.iter();
                shares.extend(terms.map(|term| {
                    let primitive = &sum.sum.primitives[*term as usize];
                    (*term, primitive.value(place.to_array()))
                }));
            }
            _ => self.function.shares(place, &mut shares),
        }
        let mut sums: Vec<(u32, f64)> = Vec::new();
        for (term, share) in shares {
            let Some(finish) = self.finishes.get(term as usize) else {
                continue;
            };
            match sums.iter_mut().find(|(own, _)| own == finish) {
                Some((_, sum)) => *sum += share.max(0.0),
                None => sums.push((*finish, share.max(0.0))),
            }
        }
        let most = sums.into_iter().max_by(|a, b| a.1.total_cmp(&b.1));
        most.map_or(self.found[0], |(finish, _)| finish)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_have_the_strongest_material() {
        let mut text = String::new();
        for (name, colour) in [("a", "Red"), ("b", "Green"), ("c", "Blue")] {
            text += &format!("surface {name}, diffuse {colour}, blobbiness -2\n");
        }
        for i in 0..216 {
            let (x, y, z) = (i % 6, i / 6 % 6, i / 36);
            let name = ["a", "b", "c"][(x + y / 2 + z / 3) % 3];
            text += &format!("sphere {name} 0.7, {x} {y} {z}\n");
        }
        let project = rats::Project {
            files: vec![rats::File {
                name: "main.rat".into(),
                text,
            }],
        };
        let scene = rats::compile(&project).scene;
        let surfaces = scene.surfaces();
        let surface = &surfaces[0];
        let middles: Vec<DVec3> = (0..3000)
            .map(|i| {
                let steps = [0.618_034, 0.414_214, 0.732_051];
                DVec3::from_array(steps.map(|step| 7.0 * (f64::from(i) * step).fract() - 1.0))
            })
            .collect();
        let function = Counted::new(surface);
        let painted = paint(&scene, surface, &function, middles.iter().copied());
        let right = middles.iter().zip(&painted).filter(|(middle, painted)| {
            let own = scene::strongest(surface.function(), surface.element(), **middle);
            own.is_none_or(|own| scene.elements[own as usize].finish == **painted)
        });
        // Of two that are as strong either may be taken: a material's elements count together.
        let share = right.count() as f64 / painted.len() as f64;
        assert!(share > 0.9, "{share}");
    }
}
