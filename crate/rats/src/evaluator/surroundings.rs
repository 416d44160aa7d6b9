//! The surroundings of the shapes, as far as the text has given them.

use scene::{Background, Cloud, Fog, Ground, Rgb, Sky};

/// The surroundings as the text has given them.
#[derive(Clone, Debug, Default)]
pub struct Air {
    /// `background`
    pub background: Option<Background>,
    /// `sky`: its light, and the colours in which it is seen, above and at the horizon.
    pub sky: Option<(Sky, [Rgb; 2])>,
    /// `ground`
    pub ground: Option<Ground>,
    /// `fog`, and whether the text gives its distance.
    pub fog: Option<(Fog, bool)>,
    /// `cloud`
    pub clouds: Vec<Cloud>,
}

impl Air {
    /// Returns the background: the sky, if the text gives none.
    #[must_use]
    pub fn background(&self) -> Background {
        match (&self.background, &self.sky) {
            (Some(background), _) => background.clone(),
            (None, Some((_, colours))) => Background::Gradient(colours.to_vec()),
            (None, None) => Background::default(),
        }
    }

    /// Returns the fog, which without a distance of its own has twice that of the view reference
    /// point.
    #[must_use]
    pub fn fog(&self, to_target: f64) -> Option<Fog> {
        let (fog, is_given) = self.fog?;
        let distance = if is_given {
            fog.distance
        } else {
            2.0 * to_target
        };
        Some(Fog {
            distance: distance.max(1e-9),
            ..fog
        })
    }
}
