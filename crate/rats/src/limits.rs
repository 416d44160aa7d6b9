//! The limits that keep any text harmless: none can hang, exhaust memory or overflow the stack.
//!
//! Each limit has its own clear error; the command that steps over it is dropped and what was built
//! before stays. The original program stopped at 128 nested files, 512 operands a command, 12
//! layers a texture and 16 levels of objects (thesis, appendix C, "Bugs and restrictions").

/// Bytes of all texts of a project together.
pub const MAX_TEXT: usize = 1024 * 1024;
/// Files in a project, as many as RATS read from one another.
pub const MAX_FILES: usize = 128;
/// Commands run plus operands evaluated, with heavier work charged more. A step takes 50
/// nanoseconds or so, so that all take a fifteenth of a second.
pub const MAX_STEPS: u64 = 1_320_000;
/// Steps that one turn of a loop costs, besides its commands.
pub const STEPS_PER_TURN: u64 = 2;
/// Steps that a look into the table of commands costs (`help`, `man`, `test`).
pub const STEPS_PER_LOOKUP: u64 = 8;
/// Steps that the call of a defined command costs, besides its arguments and its body.
pub const STEPS_PER_CALL: u64 = 12;
/// Steps that one error costs, so that a loop of errors ends soon too.
pub const STEPS_PER_ERROR: u64 = 4200;
/// Operands in its file for which an error costs one step more, as some hints look through the
/// text. (Operands, not bytes: how a text is laid out must not matter.)
pub const OPERANDS_PER_STEP: usize = 20;
/// Steps that reading a command's operands costs, besides one for each: lists are made of them.
pub const STEPS_PER_OPERANDS: u64 = 5;
/// Words, numbers and signs of a `deform`: enough for all control points that are taken.
pub const MAX_CONTROL_OPERANDS: usize = 65_536;
/// Steps that the coordinates of a vertex cost that is deformed.
pub const STEPS_PER_VERTEX: u64 = 12;
/// Vertices that the deformations of one text may move together: their coordinates take a tenth of
/// a millisecond each at first.
pub const MAX_DEFORMED: usize = 60_000;
/// Files read from files.
pub const MAX_NESTED_FILES: usize = 128;
/// Calls of defined commands inside each other.
pub const MAX_NESTED_CALLS: usize = 128;
/// Files, calls and blocks inside each other while running, all together.
pub const MAX_NESTED: usize = 384;
/// Blocks inside each other in the text.
pub const MAX_NESTED_BLOCKS: usize = 64;
/// Parentheses, signs and powers inside each other in one expression.
pub const MAX_NESTED_EXPRESSIONS: usize = 64;
/// Words, numbers and signs of one command.
pub const MAX_OPERANDS: usize = 4096;
/// Words, numbers and signs of a `skeleton` with its block: as many as a text can hold.
pub const MAX_BLOCK_OPERANDS: usize = MAX_TEXT;
/// Skeletons of files in a text, those that differ in the file or in how they are made of it: no
/// more than are kept between two compilations.
pub const MAX_SKELETON_FILES: usize = 20;
/// Shapes in a scene.
pub const MAX_ELEMENTS: usize = 200_000;
/// Faces of the mesh that strokes in a model start from.
pub const MAX_STROKES_FACES: usize = 200_000;
/// Vertices that the strokes of one text may visit together in a model, a second or so.
pub const MAX_STROKES_WORK: u64 = 20_000_000;
/// Corners of a polygon with its holes. (The original stopped at 128.)
pub const MAX_CORNERS: usize = 800;
/// Number of shapes as which a curve counts, or a limb that tapers: it is integrated piece by
/// piece.
pub const CURVE_WEIGHT: usize = 64;
/// Objects and chains in a scene.
pub const MAX_OBJECTS: usize = 100_000;
/// Contacts of bodies.
pub const MAX_CONTACTS: usize = 1000;
/// Operations of all motions of a text, up to the frame that is shown. They take a second or two at
/// first; then the frames are kept.
pub const MAX_MOTION_WORK: u64 = 150_000_000;
/// Motions of a text.
pub const MAX_MOTIONS: usize = 32;
/// Steps of the runs that find where pinned nodes are in the frames before.
pub const MAX_PIN_STEPS: u64 = 4 * MAX_STEPS;
/// Objects inside each other.
pub const MAX_NESTED_OBJECTS: usize = 16;
/// Materials in a scene.
pub const MAX_MATERIALS: usize = 10_000;
/// Textures on one material or texture.
pub const MAX_LAYERS: usize = 12;
/// Lights in a scene.
pub const MAX_LIGHTS: usize = 256;
/// Clouds of light in a scene.
pub const MAX_CLOUDS: usize = 256;
/// Colours of a background.
pub const MAX_BACKDROPS: usize = 16;
/// Pixels of all images of a scene together.
pub const MAX_IMAGE_PIXELS: u64 = 1 << 23;
/// Moments of a shutter that is open.
pub const MAX_MOMENTS: usize = 16;
/// Largest magnitude of a number given to a command, so that squares and cubes of it stay finite.
pub const MAX_MAGNITUDE: f64 = 1e12;
/// Smallest magnitude of a number given to a command that is not 0; what is smaller counts as 0, as
/// its square's inverse would not be finite in single precision.
pub const MIN_MAGNITUDE: f64 = 1e-15;
/// Pictures that one text may take with `shoot`.
pub const MAX_SHOTS: usize = 128;
/// Shapes, materials, lights and objects of all these pictures together, beyond those of the first.
pub const MAX_SHOT_WEIGHT: usize = 2 * MAX_ELEMENTS;
/// Messages about one project.
pub const MAX_DIAGNOSTICS: usize = 200;
/// Pauses, logs and times that one text may ask for.
pub const MAX_INTERLUDES: usize = 1000;
/// Jobs on files that one text may ask for.
pub const MAX_TOOLS: usize = 1000;
