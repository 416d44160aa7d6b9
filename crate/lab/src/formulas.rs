//! The chart in words: the formula of the field of a kernel on a primitive, and the method by which
//! it is computed (see `field`, `kernel.rs`).

use field::Kernel;
use field::kernel::Cell;

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

/// Returns the formula of a cell of the chart, and the method by which it is computed.
#[must_use]
pub fn cell(kernel: Kernel, bone: Bone) -> Cell {
    let cells = kernel.cells();
    match bone {
        Bone::Point => Cell {
            way: "closed",
            formula: "F = h(|p − q|)",
            letters: "q is the point of the skeleton",
        },
        Bone::Curve => Cell {
            way: "Gauss–Legendre",
            formula: "F = Σ w · h(|p − c(t)|) · |dc/dt|  over the nodes t",
            letters: "the curve is cut into spans that are short in kernel widths, and each is \
                      summed at the nodes and with the weights w of Gauss and Legendre",
        },
        Bone::Line => cells.segment,
        Bone::Arc => cells.arc,
        Bone::Triangle | Bone::Polygon => cells.face,
        Bone::Plane => cells.plane,
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
            all.push_str(kernel.formula());
            for bone in BONES {
                let cell = cell(kernel, bone);
                all.extend([cell.formula, cell.letters, cell.way]);
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
