//! How the fields of a kernel are computed, in words.

/// The entries of the chart in which kernels differ. Of points the field is the kernel itself;
/// along curves it is a sum over nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cells {
    /// Segments.
    pub segment: Cell,
    /// Circular arcs.
    pub arc: Cell,
    /// Triangles and polygons.
    pub face: Cell,
    /// Infinite planes.
    pub plane: Cell,
}

/// An entry of the chart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cell {
    /// How it is computed, in a word.
    pub way: &'static str,
    /// The field in units of the kernel's width.
    pub formula: &'static str,
    /// What the formula's letters mean.
    pub letters: &'static str,
}

impl Cell {
    /// Returns the entry with a way of its own.
    pub(crate) const fn by(self, way: &'static str) -> Self {
        Self { way, ..self }
    }

    /// Returns the entry with an explanation of its own.
    pub(crate) const fn with(self, letters: &'static str) -> Self {
        Self { letters, ..self }
    }
}

const fn closed(formula: &'static str, letters: &'static str) -> Cell {
    Cell {
        way: "closed",
        formula,
        letters,
    }
}

/// Returns the entry of a segment's closed form.
pub(crate) const fn segment(formula: &'static str) -> Cell {
    closed(
        formula,
        "x runs along the line from the foot of the point to the ends x₁, x₂; \
         ρ is the distance from the line",
    )
}

/// Returns the entry of an arc's closed form.
pub(crate) const fn arc(formula: &'static str) -> Cell {
    closed(
        formula,
        "r₀ is the arc's radius, φ the angle from the point's azimuth, \
         ρ and z the point's distance from the axis and from the plane",
    )
}

/// Returns the entry of a face's closed form.
pub(crate) const fn face(formula: &'static str) -> Cell {
    closed(
        formula,
        "a sum over the edges: h is the distance of the foot of the point from the edge's line, \
         t runs along the edge, z is the height over the plane",
    )
}

/// Returns the entry of a plane's closed form.
pub(crate) const fn plane(formula: &'static str) -> Cell {
    closed(formula, "d is the distance from the plane")
}

/// Returns the entry of a plane whose field is infinite.
pub(crate) const fn windowed(formula: &'static str) -> Cell {
    plane(formula).by("windowed").with(
        "over the whole plane the integral is infinite; \
         it is taken over a window of radius w around the foot of the point",
    )
}

/// The entries of a kernel without closed forms.
pub(crate) const NUMERIC: Cells = {
    const WAY: &str = "quadrature";
    Cells {
        segment: segment("F = ∫ h(√(ρ²+x²)) dx from x₁ to x₂").by(WAY),
        arc: arc("F = r₀ ∫ h(√(A − B cos φ)) dφ,   A = r₀²+ρ²+z²,   B = 2r₀ρ").by(WAY),
        face: face("F = Σ ∫ (∫ h(u) u du from |z| to √(z²+h²+t²)) · h/(h²+t²) dt").by(WAY),
        plane: plane("F = 2π ∫ h(u) u du from u = d on").by(WAY),
    }
};
