//! Texts of the lessons: a few words for the list, and three sentences.

use crate::lesson::Lesson;

/// The words of one lesson.
pub struct Words {
    /// A few words for the list.
    pub about: &'static str,
    /// Three sentences.
    pub sentences: &'static str,
}

/// The words of a lesson.
pub fn of(lesson: Lesson) -> Words {
    match lesson {
        Lesson::Kernels => Words {
            about: "how flesh thins with distance",
            sentences: "A kernel says how much flesh a point of the skeleton gives at a distance r. \
                        Whatever the kernel, it is scaled so that a lone point has its surface exactly \
                        at the radius R, where its field equals the threshold T = 1. What differs is \
                        the way down: some kernels fade for ever, others end at a certain depth and \
                        see nothing beyond it.",
        },
        Lesson::Convolution => Words {
            about: "geometry × kernel = field",
            sentences: "Slide the kernel along the line: the field at a place is the area that kernel \
                        and geometry have in common there. The surface lies where this field crosses \
                        the iso-value, so bars that come near each other grow together. A kernel that \
                        ends is a window: what lies outside it does not count, so a long bar looks \
                        the same in its middle however much longer it grows.",
        },
        Lesson::Slice => Words {
            about: "your dataset, seen from inside",
            sentences: "Here is the field of the dataset in your editor, cut by a plane. The surface \
                        that the picture shows is one of these lines, F = T, and the other lines show \
                        where it would go with another threshold. Move the plane and point at a place \
                        to read the field there.",
        },
        Lesson::Grid => Words {
            about: "the numbers behind a joint",
            sentences: "Two bars make a T, and only two numbers change from picture to picture. The \
                        radius says how thick a bar is by itself; the blobbiness says how freely its \
                        flesh runs together with its neighbour's. Choose a picture to go on with it in \
                        the editor.",
        },
        Lesson::Profiles => Words {
            about: "strength along a bone",
            sentences: "A profile multiplies the field of a bone by a function along it, here drawn \
                        below each picture. Where the function is large the flesh swells, where it is \
                        small the flesh thins out or is gone. It is the field that is multiplied, not \
                        the radius, so the outline does not copy the curve.",
        },
        Lesson::Chart => Words {
            about: "nine kernels × seven primitives",
            sentences: "Every kernel can be convolved with every primitive; this is the whole table, \
                        traced just now. Some cells have a closed formula, some need an elliptic \
                        integral, some a small numerical one, and that shows in the time they take. \
                        Choose a cell to see how its field is computed.",
        },
        Lesson::Superposition => Words {
            about: "why a cut bone shows no seam",
            sentences: "Cut the bone wherever you like: an integral over the whole is the sum of the \
                        integrals over its parts, so a convolution surface does not notice. Next to it \
                        the same parts give flesh by their distance instead, and near the cut both \
                        parts count in full, so the surface bulges. That is why bones may be put \
                        together from many pieces here.",
        },
        Lesson::Spans => Words {
            about: "cubics along a ray, and errors",
            sentences: "Along each ray a few cubics stand in for a bone's field, and what a picture shows \
                        is their surface, not the field's. Two spans a bone, as first published, give way \
                        where a ray runs along a bar, and four are better. The tracer here places spans \
                        by a proven bound on their error, so there is no number to choose.",
        },
        Lesson::Contact => Words {
            about: "pressed flat, with a bulge",
            sentences: "Where two drops would overlap, what the other's field is above T is taken from each \
                        drop's own, so that both end on the sheet where their fields are equal. Just outside \
                        a small bulge is added instead, which leaves the surface smooth and gives back \
                        some of the volume. Take hold of the drops, of where the bulge begins and of its \
                        crest.",
        },
        Lesson::Sculpting => Words {
            about: "a dog of a box, stroke by stroke",
            sentences: "A virtual tool touches a mesh and pushes or pulls the vertices that it meets, and \
                        their neighbours follow by a decay function. Where detail is wanted, a region is \
                        chosen and divided, and smoothed again. Each stroke is a line of a text, so the \
                        whole animal can be made again, step by step.",
        },
        Lesson::Fitting => Words {
            about: "implicit meshes that fit points",
            sentences: "One coarse mesh, cut by a plane, becomes a soft surface in two ways: with a ball \
                        around each facet, or with a thin shell. Both are fitted to the same measured \
                        points, and the mesh follows its surface. Balls are as thick as facets are large, \
                        so the mesh ends where it should not; shells are as thin as you like.",
        },
        Lesson::Textures => Words {
            about: "patterns that cross-dissolve",
            sentences: "Each element has its own map of u and v, so two balls that blend have two patterns. At \
                        a point of the surface each is looked up for itself, and the results are mixed by the \
                        shares of the field that the elements have there. A solid texture fills space and needs \
                        no map, so it runs through both as through one block.",
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_lesson_says_three_sentences() {
        for lesson in Lesson::ALL {
            let words = of(lesson);
            assert_eq!(
                words.sentences.matches(". ").count(),
                2,
                "{}",
                lesson.title()
            );
            assert!(words.sentences.ends_with('.'), "{}", lesson.title());
            assert!(!words.sentences.contains("  "), "{}", lesson.title());
        }
    }
}
