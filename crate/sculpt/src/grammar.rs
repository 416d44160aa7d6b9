//! The grammar of texts of strokes: one table for messages and the manual.

/// Command: a kind of line in a text of strokes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Command {
    /// First word of the line.
    pub name: &'static str,
    /// Forms of the line; what is in brackets may be left out, `|` is between choices.
    pub forms: &'static [&'static str],
    /// Effect, in one line.
    pub meaning: &'static str,
    /// Details; may be empty.
    pub details: &'static str,
}

/// Meaning of TOOL in [`Command::forms`].
pub const TOOL: &str = "box|cylinder|sphere sx sy sz [e1 e2] [turn ax ay az]";
/// Meaning of DECAY.
pub const DECAY: &str = "[goo|bell|cusp|cone|flat range] [normal|tangent] [only]";
/// Meaning of PATH.
pub const PATH: &str = "x y z [pressure], x y z [pressure], …";

/// The commands, in the order of the manual.
pub const COMMANDS: [Command; 16] = [
    Command {
        name: "strokes",
        forms: &["strokes 1"],
        meaning: "begins the text; 1 is the version of the grammar",
        details: "",
    },
    Command {
        name: "start",
        forms: &[
            "start plane|sphere|tetrahedron|cylinder|box n [sx sy sz]",
            "start file NAME",
        ],
        meaning: "the mesh that is sculpted",
        details: "A shape of size −1 … 1 whose edges are divided n times, stretched by sx, sy and \
                  sz: a plane z = 0 of 2n² triangles, a sphere of 8n², a tetrahedron of 4n², a \
                  cylinder along z or a box of 12n². Or the mesh of a file of the project (OBJ, \
                  PLY, STL, GLB); one that is no manifold is repaired.",
    },
    Command {
        name: "stage",
        forms: &["stage TEXT"],
        meaning: "names what has been reached, to go back to",
        details: "",
    },
    Command {
        name: "symmetry",
        forms: &["symmetry x|y|z …", "symmetry off"],
        meaning: "tools are mirrored in the planes x = 0, y = 0, z = 0 from here on",
        details: "",
    },
    Command {
        name: "push",
        forms: &["push TOOL DECAY : PATH"],
        meaning: "drives vertices inside the tool out, along the ray from its centre onto its \
                  surface",
        details: "From outside it dents, from inside it swells. Neighbours within the range, \
                  measured along edges, take the decay function's share of the motion.",
    },
    Command {
        name: "pull",
        forms: &["pull TOOL DECAY : PATH"],
        meaning: "vertices inside the tool at the start of its path follow it",
        details: "Neighbours within the range, measured along edges, take the decay function's \
                  share.",
    },
    Command {
        name: "smooth",
        forms: &["smooth TOOL DECAY : PATH"],
        meaning: "moves vertices inside the tool to the mean of their neighbours",
        details: "",
    },
    Command {
        name: "mask",
        forms: &["mask value TOOL DECAY : PATH", "mask clear|invert"],
        meaning: "gives vertices inside the tool a mask: 0 is free, 1 neither moved nor removed",
        details: "Masks stay with the vertices when the mesh is refined; new vertices get the \
                  mean.",
    },
    Command {
        name: "paint",
        forms: &["paint red green blue TOOL DECAY : PATH"],
        meaning: "gives vertices inside the tool a colour; channels are from 0 to 1 (sRGB)",
        details: "",
    },
    Command {
        name: "region",
        forms: &[
            "region [add|remove] TOOL : PATH",
            "region all|none|invert",
            "region grow|shrink [n]",
        ],
        meaning: "chooses the faces with a vertex inside the tool, for the commands below",
        details: "At the start the region is all. The parts of faces that are divided stay in it.",
    },
    Command {
        name: "refine",
        forms: &["refine [propagate|local|polygons|centers]"],
        meaning: "divides the faces of the region",
        details: "Triangles become four, polygons get a centre vertex. With `propagate`, which is \
                  usual, faces beside the region are divided so that all are triangles; with \
                  `local` they only gain vertices. `polygons` leaves triangles as they are; \
                  `centers` gives every face a centre vertex.",
    },
    Command {
        name: "loop",
        forms: &["loop [n]"],
        meaning: "smooths the region by Loop's subdivision, n times",
        details: "",
    },
    Command {
        name: "average",
        forms: &["average [n [share]]"],
        meaning: "smooths the region without subdivision: vertices go a share of the way (1 unless \
                  told) to the mean of their neighbours, n times",
        details: "",
    },
    Command {
        name: "fill",
        forms: &["fill"],
        meaning: "closes the holes beside the region by triangles about a centre vertex",
        details: "",
    },
    Command {
        name: "delete",
        forms: &["delete face|hole"],
        meaning: "replaces each connected part of the region by one face, or by a hole",
        details: "Faces with a vertex whose mask is 1 stay. After `delete hole` the region is all.",
    },
    Command {
        name: "simplify",
        forms: &["simplify share"],
        meaning: "collapses edges of the region until a share of its faces is left, those first \
                  that change the shape least",
        details: "Vertices with faces outside the region or a mask of 1 stay.",
    },
];
