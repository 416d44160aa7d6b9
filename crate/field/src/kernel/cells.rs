//! The words of the chart: how the fields of a kernel are computed.

/// The entries of the chart in which kernels differ. A point's field is the kernel itself; along
/// curves it is a sum over nodes.
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
    /// The method of computing it, in a word.
    pub way: &'static str,
    /// The field in units of the kernel's width.
    pub formula: &'static str,
    /// The meaning of the formula's letters.
    pub letters: &'static str,
}

/// Makes an entry.
pub(crate) const fn cell(way: &'static str, formula: &'static str, letters: &'static str) -> Cell {
    Cell {
        way,
        formula,
        letters,
    }
}

/// The usual letters of a segment's formula.
pub(crate) const ALONG: &str = "x runs along the line from the foot of the point to the ends x₁, \
    x₂; ρ is the distance from the line";
/// The usual letters of an arc's formula.
pub(crate) const AROUND: &str = "r₀ is the arc's radius, φ the angle from the point's azimuth, \
    ρ and z the point's distance from the axis and from the plane";
/// The usual letters of a face's formula.
pub(crate) const EDGE: &str = "a sum over the edges: h is the distance of the foot of the point \
    from the edge's line, t runs along the edge, z is the height over the plane";
/// The usual letters of a plane's formula.
pub(crate) const HEIGHT: &str = "d is the distance from the plane";
/// The letters of a plane whose field is infinite.
pub(crate) const WINDOWED: &str = "over the whole plane the integral is infinite; \
    it is taken over a window of radius w around the foot of the point";

/// The entries of a kernel without closed forms.
pub(crate) const NUMERIC: Cells = Cells {
    segment: cell("quadrature", "F = ∫ h(√(ρ²+x²)) dx from x₁ to x₂", ALONG),
    arc: cell(
        "quadrature",
        "F = r₀ ∫ h(√(A − B cos φ)) dφ,   A = r₀²+ρ²+z²,   B = 2r₀ρ",
        AROUND,
    ),
    face: cell(
        "quadrature",
        "F = Σ ∫ (∫ h(u) u du from |z| to √(z²+h²+t²)) · h/(h²+t²) dt",
        EDGE,
    ),
    plane: cell("quadrature", "F = 2π ∫ h(u) u du from u = d on", HEIGHT),
};
