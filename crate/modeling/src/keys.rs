//! The keys of the place.

/// Keys and gestures with their meanings, for the help.
pub const KEYS: [(&str, &str); 19] = [
    ("drag on the mesh", "use the tool; a pen's pressure counts"),
    (
        "drag beside it, middle button",
        "turn; Shift with the middle button moves",
    ),
    ("wheel, two fingers", "zoom; two fingers also turn"),
    ("Shift", "smooth instead"),
    ("Ctrl", "the reverse: swell, let go, take out"),
    ("L P M C B", "pull, push, mask, paint (colour), region"),
    (
        "G",
        "grab what is under the pointer; a click lets go, Esc gives up",
    ),
    ("R, S", "turn or scale the tool; a click takes it"),
    ("X Y Z", "along one axis only, while G, R or S"),
    ("F", "size of the tool by moving; [ and ] step by step"),
    ("Shift+F", "range of the decay by moving"),
    ("W", "wireframe"),
    (
        "D, Shift+D",
        "divide the region; smooth it by Loop's subdivision",
    ),
    ("A", "choose all faces; Alt+A: none, I: the others"),
    (". (period)", "turn about the point under the pointer"),
    (
        "1 3 7, Home",
        "look from the front, the side, above; see all",
    ),
    ("Ctrl+Z, Ctrl+Shift+Z", "undo, redo, without limit"),
    ("Esc", "give the stroke up"),
    ("Tab", "back to the text"),
];
