//! Numbers as a text gives them, short.

/// Returns the largest power of ten that is not above `x`.
pub fn power(x: f64) -> f64 {
    let exponent = libm::floor(libm::log10(x) + 1e-9);
    libm::pow(10.0, exponent.clamp(-15.0, 12.0))
}

/// Writes a number rounded to a multiple of a power of ten, as short as possible.
pub fn write(x: f64, grain: f64) -> String {
    let decimals = -libm::round(libm::log10(grain));
    if decimals <= 0.0 {
        let rounded = (x / grain).round() * grain + 0.0;
        return format!("{rounded:.0}");
    }
    let mut text = format!("{x:.*}", decimals as usize);
    text.truncate(text.trim_end_matches('0').trim_end_matches('.').len());
    if text == "-0" {
        text.remove(0);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        for (x, grain, text) in [
            (0.123_456, 0.01, "0.12"),
            (-0.001, 0.01, "0"),
            (2.0, 0.001, "2"),
            (1.25, 0.01, "1.25"),
            (1234.0, 100.0, "1200"),
            (-3.7, 1.0, "-4"),
            (0.30000000000000004, 1e-6, "0.3"),
        ] {
            assert_eq!(write(x, grain), text);
        }
        assert_eq!(power(0.013), 0.01);
        assert_eq!(power(0.01), 0.01);
        assert_eq!(power(250.0), 100.0);
    }
}
