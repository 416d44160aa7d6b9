//! Colours and gloss, as files write them.

/// An 8-bit sRGB channel for a linear one (IEC 61966-2-1), rounded to nearest. Values outside 0 … 1
/// are cut off; NaN becomes 0.
///
/// ```
/// assert_eq!(mesh::srgb_from_linear(0.2158605), 128);
/// assert_eq!(mesh::srgb_from_linear(mesh::linear_from_srgb(77)), 77);
/// ```
#[must_use]
pub fn srgb_from_linear(linear: f32) -> u8 {
    (encode(linear) * 255.0 + 0.5) as u8
}

/// The linear value of an 8-bit sRGB channel.
#[must_use]
pub fn linear_from_srgb(srgb: u8) -> f32 {
    decode(f64::from(srgb) / 255.0)
}

/// An sRGB channel, 0 … 1.
pub(crate) fn encode(linear: f32) -> f64 {
    let x = f64::from(linear).clamp(0.0, 1.0);
    if x <= 0.003_130_8 {
        12.92 * x
    } else if x > 0.0 {
        1.055 * libm::pow(x, 1.0 / 2.4) - 0.055
    } else {
        // NaN.
        0.0
    }
}

/// The linear value of an sRGB channel from 0 to 1.
pub(crate) fn decode(srgb: f64) -> f32 {
    let linear = if srgb <= 0.040_45 {
        srgb / 12.92
    } else {
        libm::pow((srgb + 0.055) / 1.055, 2.4)
    };
    linear as f32
}

/// Roughness of glTF's model with highlights as wide as those of a Phong exponent ≥ 0:
/// (2 / (exponent + 2))^¼.
///
/// ```
/// assert_eq!(mesh::roughness_from_phong(0.0), 1.0);
/// assert!((mesh::roughness_from_phong(30.0) - 0.5).abs() < 1e-6);
/// assert!((mesh::phong_from_roughness(0.5) - 30.0).abs() < 1e-4);
/// ```
#[must_use]
pub fn roughness_from_phong(exponent: f64) -> f32 {
    let square = (2.0 / (exponent.max(0.0) + 2.0)).sqrt();
    square.sqrt() as f32
}

/// The Phong exponent for a roughness of glTF's model: 2 / roughness⁴ − 2, at most a million.
#[must_use]
pub fn phong_from_roughness(roughness: f32) -> f64 {
    let square = f64::from(roughness) * f64::from(roughness);
    (2.0 / (square * square).max(1e-12) - 2.0).clamp(0.0, 1e6)
}
