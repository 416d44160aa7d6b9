//! Strengths that a solid or an image says: bones in pieces, each with a strength of its own.

use field::Skeleton;
use glam::{DVec2, DVec3};
use scene::{Element, Ends, Frame, Shape};
use texture::{Image, Method, Site, Solid, Texture, Uv};

/// Most pieces of a bone.
pub const MOST_PIECES: usize = 64;
/// Pieces of all bones of a picture.
pub const MOST_OF_ALL: usize = 20_000;
/// Strengths between 0 and 1 that are told apart.
const STEPS: f64 = 64.0;

/// A piece of a bone, and the factor on its strength.
pub struct Piece {
    /// The element in place of the whole bone.
    pub element: Element,
    /// The factor.
    pub factor: f64,
}

/// Returns the number of pieces of an element; `None` if it stays whole: it is no bone of one
/// radius with round ends, or a plane, a polygon or a curve.
pub fn count(element: &Element) -> Option<usize> {
    let bone = element.shape.bone()?;
    let is_even = bone.end_radius.is_none() && bone.soft_ends == [Ends::Round; 2];
    match bone.skeleton {
        Skeleton::Point { .. } => is_even.then_some(1),
        Skeleton::Segment { .. } | Skeleton::Arc { .. } | Skeleton::Triangle { .. } => {
            is_even.then_some(MOST_PIECES)
        }
        _ => None,
    }
}

/// Cuts an element into pieces ([`count`]); `None` if its shape has none.
pub fn cut(
    element: &Element,
    frame: Frame,
    pattern: &Texture,
    images: &[&dyn Image],
) -> Option<Vec<Piece>> {
    let bone = element.shape.bone()?;
    let to_own = frame.to_world.inverse();
    let pieces = pieces_of(&bone.skeleton)?;
    let pieces = pieces.into_iter().map(|(skeleton, uv)| {
        let site = Site {
            point: to_own.transform_point3(skeleton.middle()),
            normal: DVec3::Z,
            uv: Uv {
                at: uv,
                ..Uv::default()
            },
        };
        let value = pattern.value(&site, images);
        let is_coloured = matches!(
            pattern.method,
            Method::Image(..) | Method::Solid(Solid::Paint)
        );
        // The strength stays beside an image and in gaps of a texture.
        let factor = value.map_or(1.0, |value| match is_coloured {
            true => value.dot(DVec3::new(0.2126, 0.7152, 0.0722)),
            false => value.x,
        });
        let mut bone = bone.clone();
        bone.skeleton = skeleton;
        Piece {
            element: Element {
                shape: Shape::Bone(bone),
                ..element.clone()
            },
            factor: libm::round(factor * STEPS) / STEPS,
        }
    });
    Some(pieces.collect())
}

/// Returns pieces of a bone with their coordinates u and v: of lines along them, of triangles
/// similar ones; a point is one. `None` for other bones.
fn pieces_of(bone: &Skeleton) -> Option<Vec<(Skeleton, DVec2)>> {
    match bone {
        Skeleton::Point { .. } => Some(vec![(bone.clone(), DVec2::splat(0.5))]),
        Skeleton::Segment { .. } | Skeleton::Arc { .. } => {
            let numbers = (0..MOST_PIECES).map(|i| i as f64);
            numbers
                .map(|i| {
                    let [from, middle, to] = [i, i + 0.5, i + 1.0].map(|i| i / MOST_PIECES as f64);
                    Some((bone.part(from, to)?, DVec2::new(middle, 0.5)))
                })
                .collect()
        }
        Skeleton::Triangle { corners } => Some(triangles(*corners)),
        _ => None,
    }
}

/// Cuts a triangle into 8·8 similar ones.
fn triangles([a, b, c]: [DVec3; 3]) -> Vec<(Skeleton, DVec2)> {
    const ROWS: usize = 8;
    let mut pieces = Vec::with_capacity(ROWS * ROWS);
    for (u, v) in (0..ROWS).flat_map(|u| (0..ROWS - u).map(move |v| (u, v))) {
        let mut places = vec![[(u, v), (u + 1, v), (u, v + 1)]];
        if u + v + 1 < ROWS {
            places.push([(u + 1, v), (u + 1, v + 1), (u, v + 1)]);
        }
        for place in places {
            let uv = place.map(|(u, v)| DVec2::new(u as f64, v as f64) / ROWS as f64);
            let corners = uv.map(|uv| a + (b - a) * uv.x + (c - a) * uv.y);
            let middle = (uv[0] + uv[1] + uv[2]) / 3.0;
            pieces.push((Skeleton::Triangle { corners }, middle));
        }
    }
    pieces
}
