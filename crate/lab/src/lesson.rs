//! The lessons of the lab: their titles and links.

/// A lesson of the lab.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Lesson {
    /// The nine kernels.
    #[default]
    Kernels,
    /// Geometry times kernel, in one dimension.
    Convolution,
    /// The field of the open dataset on a plane.
    Slice,
    /// Blobbiness against radius.
    Grid,
    /// Strength that varies along a bone.
    Profiles,
    /// Kernels against primitives.
    Chart,
    /// Why a cut bone shows no seam.
    Superposition,
    /// Effect of the number of Hermite spans.
    Spans,
    /// Two drops that touch and do not melt.
    Contact,
    /// Strokes of virtual tools.
    Sculpting,
    /// Implicit meshes that fit points.
    Fitting,
    /// Textures that mix where flesh does.
    Textures,
}

/// Start of a fragment that leads to a lesson.
const PREFIX: &str = "#lab";

impl Lesson {
    /// All lessons, in the order of the list.
    pub const ALL: [Self; 12] = [
        Self::Kernels,
        Self::Convolution,
        Self::Slice,
        Self::Grid,
        Self::Profiles,
        Self::Chart,
        Self::Superposition,
        Self::Spans,
        Self::Contact,
        Self::Sculpting,
        Self::Fitting,
        Self::Textures,
    ];

    /// The word in its link.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Kernels => "kernels",
            Self::Convolution => "convolution",
            Self::Slice => "slice",
            Self::Grid => "grid",
            Self::Profiles => "profiles",
            Self::Chart => "chart",
            Self::Superposition => "superposition",
            Self::Spans => "spans",
            Self::Contact => "contact",
            Self::Sculpting => "sculpting",
            Self::Fitting => "fitting",
            Self::Textures => "textures",
        }
    }

    /// The fragment that leads here.
    #[must_use]
    pub fn hash(self) -> String {
        format!("{PREFIX}={}", self.word())
    }

    /// The lesson a fragment leads to; the first one if it names an unknown lesson, `None` if it does not lead
    /// to the lab.
    #[must_use]
    pub fn of_hash(hash: &str) -> Option<Self> {
        let rest = hash.strip_prefix(PREFIX)?;
        if rest.is_empty() {
            return Some(Self::default());
        }
        let word = rest.strip_prefix('=')?;
        let known = Self::ALL.into_iter().find(|lesson| lesson.word() == word);
        Some(known.unwrap_or_default())
    }

    /// Its title.
    #[must_use]
    pub fn title(self) -> &'static str {
        match self {
            Self::Kernels => "Kernels",
            Self::Convolution => "Convolution in one dimension",
            Self::Slice => "A slice through the field",
            Self::Grid => "Radius and blobbiness",
            Self::Profiles => "Profiles",
            Self::Chart => "The chart",
            Self::Superposition => "Superposition",
            Self::Spans => "How many spans?",
            Self::Contact => "Drops that do not melt",
            Self::Sculpting => "Sculpting by strokes",
            Self::Fitting => "Balls or thin shells?",
            Self::Textures => "Textures over blends",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_lead_to_lessons() {
        for lesson in Lesson::ALL {
            assert_eq!(Lesson::of_hash(&lesson.hash()), Some(lesson));
        }
        assert_eq!(Lesson::of_hash("#lab"), Some(Lesson::Kernels));
        assert_eq!(Lesson::of_hash("#lab=nothing"), Some(Lesson::Kernels));
        assert_eq!(Lesson::of_hash(""), None);
        assert_eq!(Lesson::of_hash("#"), None);
        assert_eq!(Lesson::of_hash("#laboratory"), None);
        assert_eq!(Lesson::of_hash("#AXicq1YqzVSyUkrLz1eyMjIw"), None);
    }
}
