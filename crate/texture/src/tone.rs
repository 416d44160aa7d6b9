//! Tone mapping: light without limit → a display's 0 to 1.

use glam::Vec3;

/// Light up to here stays as it is.
const KNEE: f32 = 0.6;

/// Compresses light with a shoulder like film's: light up to 0.6 stays as it is; above, with t = (x
/// − 0.6)/0.4, it becomes `0.6 + 0.4·t/(1 + t)`, which goes on with the same slope and tends to 1.
/// Each channel by itself, so that very bright colours turn white. Negative and undefined light
/// becomes 0.
///
/// ```
/// use glam::Vec3;
/// assert_eq!(texture::tone::filmic(Vec3::new(0.3, 1.0, f32::INFINITY)), Vec3::new(0.3, 0.8, 1.0));
/// ```
#[must_use]
pub fn filmic(light: Vec3) -> Vec3 {
    Vec3::from_array(light.to_array().map(|x| {
        if x > KNEE {
            let t = (x - KNEE) / (1.0 - KNEE);
            // 1 − 1/(1 + t), which is finite where t is not.
            KNEE + (1.0 - KNEE) * (1.0 - 1.0 / (1.0 + t))
        } else {
            x.max(0.0)
        }
    }))
}
