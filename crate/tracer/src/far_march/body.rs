//! Bodies of very many points, with the hierarchies of their fields.
use super::points::Points;
use super::query::FarQuery;
use field::{FarField, Primitive};
use glam::DVec3;
use std::sync::Arc;

/// Fewest points for which this way pays.
const FEWEST: usize = 64;
/// Most finishes in a body.
const MOST_FINISHES: usize = 64;
/// Half the side of the hierarchy's cube, over the radius of the ball that holds the surface.
pub const ROOM: f64 = 1.25;

/// The points of a body with their hierarchy.
pub(crate) struct FarBody {
    pub field: FarField,
    pub points: Points,
    /// Number of the body's first primitive.
    pub first: usize,
    /// Number of its primitives.
    pub count: usize,
    /// The finishes; if there are several, each with the field of those of its primitives that add
    /// to the body's.
    pub finishes: Vec<(u32, Option<FarField>)>,
    /// Ball that holds the surface.
    pub center: DVec3,
    pub radius: f64,
}

impl FarBody {
    /// Prepares a body of primitives numbered from `first` on, with the radius of a ball outside
    /// which the field is below T. `None` if it is no body of many points of one endless kernel
    /// that add to the field. Those cells of an earlier body that still hold are taken over.
    pub fn new(
        primitives: &[Primitive],
        finishes: &[u32],
        first: usize,
        (center, radius): (DVec3, f64),
        earlier: Option<&Self>,
    ) -> Option<Self> {
        // A field that falls as 1/r is so large where there are many elements that its rounding
        // leaves nothing to save.
        if !primitives.iter().all(|p| p.kernel.is_finite_over(1)) {
            return None;
        }
        if primitives.len() < FEWEST || !(radius > 0.0 && radius < f64::INFINITY) {
            return None;
        }
        let points = Points::of(primitives)?;
        let (middle, half) = cube(center, radius);
        let changed = earlier.and_then(|earlier| points.changes_from(&earlier.points));
        let earlier = earlier.filter(|_| changed.is_some());
        let changed: Arc<[u32]> = changed.unwrap_or_default().into();
        let field = FarField::new(primitives, middle, half).surface_only();
        let field = field.after(earlier.map(|earlier| &earlier.field), &changed);
        let mut members = finishes.to_vec();
        members.sort_unstable();
        members.dedup();
        if members.len() > MOST_FINISHES {
            return None;
        }
        let mut fields = Vec::new();
        for &finish in &members {
            let own = (members.len() > 1).then(|| {
                let field = field.of_positive(|i| finishes[i as usize] == finish);
                let before = earlier.and_then(|earlier| {
                    let mut finishes = earlier.finishes.iter();
                    finishes.find(|(other, _)| *other == finish)?.1.as_ref()
                });
                field.after(before, &changed)
            });
            fields.push((finish, own));
        }
        Some(Self {
            points,
            field,
            first,
            count: primitives.len(),
            finishes: fields,
            center,
            radius,
        })
    }

    /// Returns the body's primitives.
    pub fn primitives<'a>(&self, query: &FarQuery<'a>) -> &'a [Primitive] {
        &query.sight.primitives[self.first..self.first + self.count]
    }
}

/// Returns the middle and half the side of the hierarchy's cube, given the ball that holds the
/// surface. Both are multiples of a step of 1/32 to 1/16 of the radius, so that small edits leave
/// the cube where it is.
fn cube(center: DVec3, radius: f64) -> (DVec3, f64) {
    let step = libm::exp2(libm::floor(libm::log2(radius))) / 16.0;
    let middle = center.to_array().map(|x| libm::round(x / step) * step);
    (
        middle.into(),
        libm::ceil(ROOM * radius / step) * step + step,
    )
}
