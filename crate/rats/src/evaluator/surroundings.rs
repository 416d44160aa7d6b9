//! What is around the shapes, as far as the text has given it.

use scene::{Background, Cloud, Fog, Ground, Rgb, Sky};

/// The surroundings as the text has given them.
#[derive(Clone, Debug, Default)]
pub struct Air {
    /// `background`
    pub background: Option<Background>,
    /// `sky`: its light, and the colours that are seen of it, above and at the horizon.
    pub sky: Option<(Sky, [Rgb; 2])>,
    /// `ground`
    pub ground: Option<Ground>,
    /// `fog`; its distance is still to be found where the text gives none.
    pub fog: Option<(Fog, bool)>,
    /// `cloud`
    pub clouds: Vec<Cloud>,
}

impl Air {
    /// What is seen behind everything: the sky, if the text gives no background.
    #[must_use]
    pub fn background(&self) -> Background {
        let seen = || {
            let (_, colours) = self.sky.as_ref()?;
            Some(Background::Gradient(colours.to_vec()))
        };
        self.background.clone().or_else(seen).unwrap_or_default()
    }

    /// The fog; without a distance of its own, one of twice this.
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
