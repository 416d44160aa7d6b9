//! The media that a ray is in, one within the other, by the order of its crossings.
use texture::refraction::dispersed;

/// Most media that lie within each other; further ones change nothing.
const MOST: usize = 8;

/// Air and the bodies around a point of a ray, the innermost last.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Media {
    inner: [Medium; MOST],
    count: usize,
}

/// The substance that fills a body.
#[derive(Clone, Copy, Debug, Default)]
struct Medium {
    key: u32,
    /// Indices of refraction for red, green and blue.
    index: [f64; 3],
}

/// The way a ray crosses a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Way {
    /// Inward.
    In,
    /// Outward.
    Out,
    /// Inward if the ray is not yet inside, else outward.
    Turn,
}

/// Media and indices on both sides of a surface that a ray crosses.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sides {
    /// The media behind it.
    pub beyond: Media,
    /// The index before it over that behind it, for red, green and blue.
    pub ratio: [f64; 3],
}

impl Media {
    /// Whether the point is in air.
    pub fn is_air(&self) -> bool {
        self.count == 0
    }

    /// Crosses the surface of a body, told from others by its key, which is made of a substance of
    /// this index and dispersion.
    pub fn cross(&self, key: u32, way: Way, index: f32, dispersion: f32) -> Sides {
        let place = self.inner[..self.count].iter().position(|m| m.key == key);
        let own = dispersed(f64::from(index), f64::from(dispersion));
        let mut beyond = *self;
        let [before, behind] = match (way, place) {
            (Way::In | Way::Turn, None) => {
                if self.count == MOST {
                    [self.index(); 2]
                } else {
                    beyond.inner[beyond.count] = Medium { key, index: own };
                    beyond.count += 1;
                    [self.index(), own]
                }
            }
            // Inside already: two parts of one body.
            (Way::In, Some(_)) => [self.index(); 2],
            (Way::Out | Way::Turn, Some(place)) => {
                beyond.inner.copy_within(place + 1..self.count, place);
                beyond.count -= 1;
                [self.index(), beyond.index()]
            }
            // The eye was inside.
            (Way::Out, None) => [own, self.index()],
        };
        Sides {
            beyond,
            ratio: [0, 1, 2].map(|i| before[i] / behind[i]),
        }
    }

    /// Returns the indices of the innermost medium, for red, green and blue.
    fn index(&self) -> [f64; 3] {
        match self.count {
            0 => [1.0; 3],
            count => self.inner[count - 1].index,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bodies_nest_by_the_order_of_crossings() {
        let air = Media::default();
        let glass = air.cross(1, Way::In, 1.5, 0.0);
        assert_eq!(glass.ratio, [1.0 / 1.5; 3]);
        let water = glass.beyond.cross(2, Way::In, 1.25, 0.0);
        assert_eq!(water.ratio, [1.5 / 1.25; 3]);
        // Out of the glass while in the water: nothing changes for the ray.
        let left = water.beyond.cross(1, Way::Out, 1.5, 0.0);
        assert_eq!(left.ratio, [1.0; 3]);
        let out = left.beyond.cross(2, Way::Out, 1.25, 0.0);
        assert_eq!(out.ratio, [1.25; 3]);
        assert!(out.beyond.is_air());
        // From inside, where the eye is.
        assert_eq!(air.cross(1, Way::Out, 1.5, 0.0).ratio, [1.5; 3]);
        // Sheets turn by turn.
        let first = air.cross(7, Way::Turn, 2.0, 0.0);
        let second = first.beyond.cross(7, Way::Turn, 2.0, 0.0);
        assert_eq!(second.ratio, [2.0; 3]);
        assert!(second.beyond.is_air());
        let mut deep = air;
        for key in 0..20 {
            deep = deep.cross(key, Way::In, 1.5, 0.1).beyond;
        }
        assert_eq!(deep.cross(99, Way::In, 3.0, 0.0).ratio, [1.0; 3]);
    }
}
