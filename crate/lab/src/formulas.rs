//! The chart in words: the formula of the field of a kernel on a primitive, and the method by which
//! it is computed (see `field`, `form.rs`).

use field::Kernel;

/// The primitives of the chart.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Bone {
    /// A point.
    Point,
    /// A segment.
    Line,
    /// A circular arc.
    Arc,
    /// A triangle.
    Triangle,
    /// A planar polygon.
    Polygon,
    /// An endless plane.
    Plane,
    /// A cubic curve.
    Curve,
}

/// The primitives, in the order of the chart.
pub const BONES: [Bone; 7] = [
    Bone::Point,
    Bone::Line,
    Bone::Arc,
    Bone::Triangle,
    Bone::Polygon,
    Bone::Plane,
    Bone::Curve,
];

impl Bone {
    /// Returns the name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Point => "point",
            Self::Line => "line",
            Self::Arc => "arc",
            Self::Triangle => "triangle",
            Self::Polygon => "polygon",
            Self::Plane => "plane",
            Self::Curve => "curve",
        }
    }

    /// Returns the name in a sentence.
    #[must_use]
    pub fn with_article(self) -> String {
        let article = if self == Self::Arc { "an" } else { "a" };
        format!("{article} {}", self.name())
    }
}

/// Returns the method by which a cell is computed, in a word.
#[must_use]
pub fn way(kernel: Kernel, bone: Bone) -> &'static str {
    match (kernel, bone) {
        (_, Bone::Point) => "closed",
        (_, Bone::Curve) => "Gauss–Legendre",
        (Kernel::Inverse | Kernel::Squared, Bone::Plane) => "windowed",
        (_, Bone::Plane) => "closed",
        (Kernel::Gauss, Bone::Line) => "error function",
        (Kernel::Gauss, Bone::Arc) => "Gauss–Legendre",
        (Kernel::Gauss, Bone::Triangle | Bone::Polygon) => "Owen's T",
        (Kernel::Inverse | Kernel::Cubed, Bone::Arc) => "Carlson",
        (Kernel::Squared, Bone::Triangle | Bone::Polygon) => "dilogarithm",
        (Kernel::Metaballs, Bone::Arc | Bone::Triangle | Bone::Polygon) => "Gauss–Legendre",
        _ => "closed",
    }
}

/// Returns the formula of a kernel, with u the distance in its widths.
#[must_use]
pub fn kernel(kernel: Kernel) -> &'static str {
    match kernel {
        Kernel::Cauchy => "h(u) = 1/(1+u²)²",
        Kernel::Gauss => "h(u) = exp(−u²)",
        Kernel::Inverse => "h(u) = 1/u",
        Kernel::Squared => "h(u) = 1/u²",
        Kernel::Metaballs => "h(u) = 1−3u² up to u = ⅓, then 3/2·(1−u)² up to 1",
        Kernel::Soft => "h(u) = 1 − 4/9·u⁶ + 17/9·u⁴ − 22/9·u² up to u = 1",
        Kernel::Quartic => "h(u) = (1−u²)² up to u = 1",
        Kernel::Compact6 => "h(u) = (1−u²)³ up to u = 1",
        Kernel::Cubed => "h(u) = 1/u³",
    }
}

/// Returns the formula of a cell's field in units of the kernel's width, and the meaning of its
/// letters.
#[must_use]
pub fn field(kernel: Kernel, bone: Bone) -> (&'static str, &'static str) {
    use Kernel::{Cauchy, Cubed, Gauss, Inverse, Metaballs, Squared};
    const EDGE: &str = "a sum over the edges: h is the distance of \
        the foot of the point from the edge's line, t runs along \
        the edge, z is the height over the plane";
    const ALONG: &str = "x runs along the line from the foot of the point \
        to the ends x₁, x₂; ρ is the distance from the line";
    const AROUND: &str = "r₀ is the arc's radius, φ the angle from the \
        point's azimuth, ρ and z the point's distance from the axis and from the plane";
    match (kernel, bone) {
        (_, Bone::Point) => ("F = h(|p − q|)", "q is the point of the skeleton"),
        (_, Bone::Curve) => (
            "F = Σ w · h(|p − c(t)|) · |dc/dt|  over the nodes t",
            "the curve is cut into spans that are short in kernel widths, and \
             each is summed at the nodes and with the weights w of Gauss and Legendre",
        ),
        (Cauchy, Bone::Line) => (
            "F = [ x/(2p²(p²+x²)) + atan(x/p)/(2p³) ] from x₁ to x₂,   p² = 1+ρ²",
            ALONG,
        ),
        (Gauss, Bone::Line) => ("F = √π/2 · exp(−ρ²) · (erf x₂ − erf x₁)", ALONG),
        (Inverse, Bone::Line) => ("F = asinh(x₂/ρ) − asinh(x₁/ρ)", ALONG),
        (Squared, Bone::Line) => ("F = (atan(x₂/ρ) − atan(x₁/ρ)) / ρ", ALONG),
        (Cubed, Bone::Line) => ("F = [ x/√(ρ²+x²) ] / ρ² from x₁ to x₂", ALONG),
        (Metaballs, Bone::Line) => (
            "F = ∫ 3/2·(1−√(ρ²+x²))² dx, inside u < ⅓ replaced by ∫ (1−3(ρ²+x²)) dx",
            "both integrals are elementary; the line is cut \
             where it enters and leaves the two spheres",
        ),
        (_, Bone::Line) => (
            "F = ∫ (polynomial in 1−ρ²−x²) dx between the ends, cut to x² ≤ 1−ρ²",
            ALONG,
        ),
        (Cauchy, Bone::Arc) => (
            "F = r₀ ∫ dφ/(A − B cos φ)²,   A = 1+r₀²+ρ²+z²,   B = 2r₀ρ",
            "the integral is elementary; its angle δ runs from 0 to π without a branch",
        ),
        (Gauss, Bone::Arc) => (
            "F = r₀ · exp(−(r₀−ρ)²−z²) · ∫ exp(−2r₀ρ(1−cos φ)) dφ",
            "the last integral by Gauss–Legendre where the arc is within reach",
        ),
        (Inverse, Bone::Arc) => (
            "F = r₀ ∫ dφ/√(A − B cos φ), an elliptic integral of the first kind",
            "computed as Carlson's R_F",
        ),
        (Squared, Bone::Arc) => (
            "F = r₀ ∫ dφ/(A − B cos φ),   A = r₀²+ρ²+z²,   B = 2r₀ρ",
            AROUND,
        ),
        (Cubed, Bone::Arc) => (
            "F = r₀ ∫ dφ/√(A − B cos φ)³, elliptic integrals of the first and the second kind",
            "computed as Carlson's R_D",
        ),
        (Metaballs, Bone::Arc) => (
            "F = r₀ ∫ 3/2·(1−√(A − B cos φ))² dφ, an elliptic integral of the second kind",
            "by Gauss–Legendre; the arc is cut where it enters and leaves the two spheres",
        ),
        (_, Bone::Arc) => (
            "F = r₀ ∫ (polynomial in 1 − A + B cos φ) dφ, cut to where it is positive",
            AROUND,
        ),
        (Cauchy, Bone::Triangle | Bone::Polygon) => (
            "F = 1/(2c²) · Σ (h/w) · [atan(t/w)] along each edge,   c² = 1+z²,   w² = c²+h²",
            EDGE,
        ),
        (Gauss, Bone::Triangle | Bone::Polygon) => (
            "F = exp(−z²)/2 · Σ ∫ (1 − exp(−h²−t²)) · h/(h²+t²) dt",
            "a sum over the edges, h and t as seen from the \
             point's foot in the plane, z its height; each integral \
             is an angle less Owen's T function",
        ),
        (Inverse, Bone::Triangle | Bone::Polygon) => (
            "F = Σ [ h·asinh(t/k) − |z|·atan2(ht, k²+|z|r) ] along each edge,   k² = h²+z²",
            EDGE,
        ),
        (Squared, Bone::Triangle | Bone::Polygon) => {
            ("F = ½ · Σ ∫ ln(1 + (h²+t²)/z²) · h/(h²+t²) dt", EDGE)
        }
        (Cubed, Bone::Triangle | Bone::Polygon) => (
            "F = ( 2πw − Σ [ atan2(zt, h√(h²+t²+z²)) ] along each edge ) / z",
            "the solid angle at which the polygon is seen, over the height \
             z; w is the number of times the edges run around the foot \
             of the point, h its distance from the edge's line, and t runs along the edge",
        ),
        (_, Bone::Triangle | Bone::Polygon) => (
            "F = Σ h·[P(t)] along the part of each edge inside \
             the disc, and G·(angle) along the rest",
            "the disc is where the kernel's sphere meets the \
             plane; P is a polynomial, G the field of the whole disc",
        ),
        (Cauchy, Bone::Plane) => ("F = π/(1+d²)", "d is the distance from the plane"),
        (Gauss, Bone::Plane) => ("F = π · exp(−d²)", "d is the distance from the plane"),
        (Inverse, Bone::Plane) => (
            "F = 2π·(√(d²+w²) − d)",
            "over the whole plane the integral is infinite; \
             it is taken over a window of radius w around the foot of the point",
        ),
        (Squared, Bone::Plane) => (
            "F = π·ln(1 + w²/d²)",
            "over the whole plane the integral is infinite; \
             it is taken over a window of radius w around the foot of the point",
        ),
        (Cubed, Bone::Plane) => ("F = 2π/d", "d is the distance from the plane"),
        (Kernel::Quartic, Bone::Plane) => ("F = π/3 · (1−d²)³", "d is the distance from the plane"),
        (Kernel::Compact6, Bone::Plane) => {
            ("F = π/4 · (1−d²)⁴", "d is the distance from the plane")
        }
        (Kernel::Soft, Bone::Plane) => (
            "F = π · (5/27·(1−d²)³ + 1/9·(1−d²)⁴)",
            "d is the distance from the plane",
        ),
        (Metaballs, Bone::Plane) => (
            "F = 2π ∫ h(u) u du from u = d to 1",
            "elementary; d is the distance from the plane",
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::{Context, FontId, RawInput};

    #[test]
    fn the_fonts_have_every_letter_of_the_formulas() {
        let mut all = String::from("T−·^×∞½¼²³…‹–|°");
        for kernel in Kernel::ALL {
            all.push_str(self::kernel(kernel));
            for bone in BONES {
                let (formula, letters) = field(kernel, bone);
                all.extend([formula, letters, way(kernel, bone)]);
            }
        }
        let context = Context::default();
        context.set_fonts(widgets::fonts::definitions());
        let mut missing = String::new();
        let output = context.run_ui(RawInput::default(), |ui| {
            ui.ctx().fonts_mut(|fonts| {
                let font = FontId::proportional(14.0);
                missing = all
                    .chars()
                    .filter(|c| !fonts.has_glyph(&font, *c))
                    .collect();
            });
        });
        output.drop_without_applying_deltas();
        assert_eq!(missing, "");
    }
}
