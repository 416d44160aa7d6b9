//! The first shape: a text that a newcomer writes in five steps.

/// A step: what is written, and words about it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Step {
    /// The title.
    pub title: &'static str,
    /// An explanation.
    pub words: &'static str,
    /// The lines to write at the end of the text; empty if the hands do something else.
    pub code: &'static str,
}

/// The text before the first step.
pub const START: &str = "\
# My first shape
eyep 1 2 9
vrp 0.5 -0.3 0
light White point, position 4 6 8
surface clay, diffuse Coral, specular Gray50, shine 40, blobbiness -2
";

/// The steps.
pub const STEPS: [Step; 5] = [
    Step {
        title: "A ball",
        words: "A text is a list of shapes. A ball: its material, its radius, its centre.",
        code: "sphere clay 0.8, -1 0 0\n",
    },
    Step {
        title: "A bar",
        words: "From one place to another. Where soft shapes come near, they melt together.",
        code: "cylinder clay 0.4, -1 0 0, 2 0 0\n",
    },
    Step {
        title: "A slider",
        words: "A number with a name; hot gives it a slider. Move it.",
        code: "var r = 0.6 hot\nsphere clay r, 2 0 0\n",
    },
    Step {
        title: "Many at once",
        words: "A loop repeats what stands in braces, and numbers can be computed.",
        code: "for i = 0 to 3 { cylinder clay 0.2, i-1 0 0, i-1 -1.6 0.4 }\n",
    },
    Step {
        title: "It is yours",
        words: "Drag the picture to turn it. Change any number. Share makes a link that carries \
            it all.",
        code: "",
    },
];

#[cfg(test)]
mod tests {
    use super::*;
    use rats::Project;

    #[test]
    fn each_step_compiles_and_adds_to_the_picture() {
        let mut text = String::from(START);
        let mut counts = vec![0];
        for step in STEPS {
            text += step.code;
            let compiled = rats::compile(&Project::single(&text));
            let mut told = compiled.diagnostics.iter();
            assert!(
                told.all(|told| told.severity == rats::Severity::Note),
                "{}",
                step.title
            );
            counts.push(compiled.scene.elements.len());
            assert_eq!(compiled.hot.len(), usize::from(text.contains("hot")));
        }
        assert_eq!(counts, [0, 1, 2, 3, 7, 7]);
    }
}
