//! The packages that commands treat in a special way.

/// A wasm file of the page.
#[derive(Clone, Copy, Debug)]
pub struct Module {
    /// The package that it is compiled from.
    pub package: &'static str,
    /// Features of that package, separated by commas.
    pub features: &'static str,
    /// The profile of a release; modules that have one in common share what is compiled.
    pub profile: &'static str,
    /// Name of the files `NAME.js` and `NAME_bg.wasm`.
    pub name: &'static str,
    /// Most bytes of the wasm after brotli.
    pub budget: usize,
}

/// The wasm files of the page. Each is compiled apart from the others, as features of one must not
/// reach another.
pub const MODULES: [Module; 4] = [
    Module {
        package: "studio",
        features: "",
        profile: "page",
        name: "studio",
        budget: 2_500_000,
    },
    Module {
        package: "worker",
        features: "entry",
        profile: "worker",
        name: "tracer",
        // 400 kB is the aim. Made small but for the field and the tracer it was at 395; local
        // convolution, motion, far fields and implicit meshes took it to 450. Cells add 8, and 14
        // went with the words that told functions. A quarter of it, before compression, are the
        // formulas of the chart in two precisions; what only comparisons need are 27.
        budget: 450_000,
    },
    // The same worker with the root finders for comparison, fetched when a text first says
    // `digger`.
    Module {
        package: "digger",
        features: "entry",
        profile: "worker",
        name: "digger",
        budget: 1_500_000,
    },
    Module {
        package: "tools",
        features: "entry",
        profile: "worker",
        name: "tools",
        budget: 1_500_000,
    },
];

/// The wasm file of the npm package, beside those of the page's workers.
pub const EMBED: Module = Module {
    package: "embed",
    features: "",
    profile: "page",
    name: "embed",
    budget: 1_500_000,
};

/// The packages with tests that also run as wasm, as their results must be the same in the page.
pub const TESTED_AS_WASM: [&str; 6] = ["field", "motion", "rats", "sculpt", "texture", "worker"];

/// The packages that pictures depend on: a change in one of them may change the pins.
pub const PICTURES: [&str; 14] = [
    "contact",
    "field",
    "fit",
    "mesh",
    "metaballs",
    "motion",
    "picture",
    "rats",
    "scene",
    "sculpt",
    "skeleton",
    "texture",
    "tracer",
    "worker",
];
