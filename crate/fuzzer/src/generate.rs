//! Random datasets that are nearly right: commands of the table with operands of the kinds that it
//! names, now and then one too many, one too few or of another kind. They reach much deeper than
//! random bytes.

use rats::commands::{self, Arity, CommandSpec, Kind, Names, Parameter};
use rats::library;
use trials::arbitrary::{Result, Unstructured};

/// Deepest blocks and expressions. The tests of limits go deeper.
const DEPTH: usize = 5;
/// Longest text, bytes.
const LENGTH: usize = 20_000;

const FUNCTIONS: &[&str] = &[
    "sin", "cos", "tan", "asin", "acos", "atan", "atan2", "rad", "deg", "sqrt", "exp", "ln", "abs",
    "sign", "floor", "ceil", "round", "mod", "min", "max", "vec", "rgb", "dot", "cross", "length",
    "unit", "rand", "noise",
];
const NUMBERS: &[&str] = &[
    "0", "1", "-1", "2", "0.5", ".25", "1e-3", "-0", "90", "360", "-720", "1e-9", "1e-300", "1e9",
    "1e12", "-1e12", "1e13", "1e300", "1e308", "1e400", "5e-324", "0.1", "3", "100", "4096",
];
const JUNK: &[&str] = &[
    "wibble", "=", "==", "+=", "*=", "(", ")", "{", "}", "<", ">", "%", "@", "!", "^", "/", "-",
    "🐚", "−1", "#", "\u{0}", "1.2.3", "2nd", "a.b", "hot", "to", "step", "not", "and", "\\",
    "\"x\"", "\u{feff}", "\r", "read", "close", "else", "define",
];

/// A random text.
pub fn dataset(u: &mut Unstructured<'_>) -> Result<String> {
    let mut writer = Writer {
        text: String::new(),
        depth: 0,
    };
    if u.ratio(7, 8)? {
        // Names that commands can use.
        writer.text += "surface m0 diff Red blob -2 rad .3\nsurface m1 spec White\n\
            texture t0 { pigment Red, scale 2 2 1 }\n\
            var v0 = 1\nvar V1 = 1 2 3\nvar c2 = Gold\nobject o0\nsphere m0 1 0 0 0\nclose\n";
    }
    writer.block(u)?;
    Ok(writer.text)
}

struct Writer {
    text: String,
    depth: usize,
}

impl Writer {
    fn word(&mut self, word: &str) {
        self.text += word;
        self.text.push(' ');
    }

    fn choose(&mut self, u: &mut Unstructured<'_>, words: &[&str]) -> Result<()> {
        let word = u.choose(words)?;
        self.word(word);
        Ok(())
    }

    fn block(&mut self, u: &mut Unstructured<'_>) -> Result<()> {
        while !u.is_empty() && self.text.len() < LENGTH && u.ratio(19, 20)? {
            self.line(u)?;
        }
        Ok(())
    }

    fn line(&mut self, u: &mut Unstructured<'_>) -> Result<()> {
        match u.int_in_range(0..=19)? {
            0 if self.depth < DEPTH => {
                self.text += "for ";
                self.name(u, Names::Variable)?;
                self.text += "= ";
                self.expression(u, 0)?;
                self.text += "to ";
                self.choose(u, &["1", "3", "10", "v0", "1000", "1e9", "-1e12"])?;
                if u.ratio(1, 4)? {
                    self.text += "step ";
                    self.expression(u, 0)?;
                }
                self.braces(u)?;
            }
            1 if self.depth < DEPTH => {
                self.text += "if ";
                self.condition(u)?;
                self.braces(u)?;
                if u.ratio(1, 2)? {
                    self.text += "else ";
                    self.braces(u)?;
                }
            }
            2 if self.depth < DEPTH => {
                self.text += "define ";
                self.choose(u, &["f0", "f1", "f2(", "f3("])?;
                for _ in 0..u.int_in_range(0..=3)? {
                    self.choose(u, &["a", "b", "P", "surface s", "r = 1", "k = a*2", ","])?;
                }
                self.text += ")";
                self.braces(u)?;
            }
            3 => {
                self.choose(u, &["f0", "f1", "f2", "f3"])?;
                for _ in 0..u.int_in_range(0..=4)? {
                    match u.int_in_range(0..=2)? {
                        0 => self.choose(u, &["m0", "m1", "r =", "k =", "a ="])?,
                        _ => self.expression(u, 0)?,
                    }
                }
            }
            4 => {
                self.text += "var ";
                self.name(u, Names::Variable)?;
                self.choose(u, &["=", "=", "=", "+=", "*="])?;
                self.value(u)?;
                if u.ratio(1, 4)? {
                    self.choose(u, &["hot", "hot 0 1", "hot 0 1 0.1", "hot 1 0"])?;
                }
            }
            5 => {
                for _ in 0..u.int_in_range(0..=6)? {
                    self.choose(u, JUNK)?;
                }
            }
            _ => {
                let all: Vec<&CommandSpec> = commands::all().collect();
                let spec = *u.choose(&all)?;
                self.command(u, spec)?;
            }
        }
        self.text.push('\n');
        Ok(())
    }

    fn braces(&mut self, u: &mut Unstructured<'_>) -> Result<()> {
        self.depth += 1;
        self.text += "{\n";
        for _ in 0..u.int_in_range(0..=3)? {
            self.line(u)?;
        }
        self.depth -= 1;
        // Now and then a block is not closed.
        if u.ratio(49, 50)? {
            self.text += "}\n";
        }
        Ok(())
    }

    fn command(&mut self, u: &mut Unstructured<'_>, spec: &CommandSpec) -> Result<()> {
        if u.ratio(1, 20)? {
            self.text.push('@');
        }
        self.word(spec.name);
        let listed = u.ratio(1, 10)?;
        if listed {
            self.text += "{ ";
        }
        if spec.is_library() {
            for parameter in library::parameters(spec.name) {
                match (parameter.is_surface, u.ratio(1, 3)?) {
                    (true, _) => self.name(u, Names::Material)?,
                    (false, true) => {
                        self.word(&format!("{}=", parameter.name));
                        self.expression(u, 0)?;
                    }
                    (false, false) => {}
                }
            }
        }
        self.parameters(u, spec.parameters)?;
        if !spec.options.is_empty() {
            for _ in 0..u.int_in_range(0..=4)? {
                let option = u.choose(spec.options)?;
                let shortest = 3.min(option.name.len());
                let length = u.int_in_range(shortest..=option.name.len())?;
                self.word(option.name.get(..length).unwrap_or(option.name));
                self.parameters(u, option.parameters)?;
                if u.ratio(1, 3)? {
                    self.text += ", ";
                }
            }
        }
        if listed {
            self.text += "}";
        }
        Ok(())
    }

    fn parameters(&mut self, u: &mut Unstructured<'_>, parameters: &[Parameter]) -> Result<()> {
        for parameter in parameters {
            let slip = u.ratio(1, 30)?;
            let count = match parameter.arity {
                _ if slip => u.int_in_range(0..=2)?,
                Arity::One => 1,
                Arity::Optional => u.int_in_range(0..=1)?,
                Arity::Many if u.ratio(1, 40)? => u.int_in_range(100..=900)?,
                Arity::Many => u.int_in_range(1..=5)?,
                Arity::Any => u.int_in_range(0..=4)?,
            };
            for _ in 0..count {
                if u.ratio(1, 40)? {
                    self.choose(u, JUNK)?;
                } else {
                    self.operand(u, parameter.kind)?;
                }
            }
        }
        Ok(())
    }

    fn operand(&mut self, u: &mut Unstructured<'_>, kind: Kind) -> Result<()> {
        match kind {
            Kind::Number { low, high } => self.number_in(u, low, high),
            Kind::Whole { low, high } => self.number_in(u, low.into(), high.into()),
            Kind::Vector | Kind::Direction => self.vector(u),
            Kind::Colour => self.colour(u),
            Kind::Share if u.ratio(1, 2)? => self.choose(u, &["50%", "0 %", "1e9%", "-5%", "150%"]),
            Kind::Share => self.colour(u),
            Kind::Switch => self.choose(u, &["on", "off", "ON", "1"]),
            Kind::Value => self.value(u),
            Kind::Condition => self.condition(u),
            Kind::Word(words) => {
                let word = u.choose(words)?;
                self.word(word.name);
                Ok(())
            }
            Kind::New(names) | Kind::Known(names) => self.name(u, names),
            Kind::Copy(names) => {
                self.text += "= ";
                self.name(u, names)
            }
            Kind::Method => match u.int_in_range(0..=3)? {
                0 => self.choose(
                    u,
                    &["marble", "agate", "wood", "checker", "moon", "ripples"],
                ),
                1 => {
                    self.choose(u, &["sin", "one", "saw", "x"])?;
                    self.choose(u, &["cos", "hat", "step", "sin^2", "cos^2"])
                }
                2 => self.colour(u),
                _ => self.choose(
                    u,
                    &[
                        "img.png plain",
                        "img.png region <0 0 0 1 1 1> <0 0 0 1 0 0 1 1 0 0 1 0>",
                    ],
                ),
            },
            Kind::Backdrop if u.ratio(1, 4)? => self.choose(u, &["img.png", "a/b-c.tif"]),
            Kind::Backdrop => self.colour(u),
            Kind::File | Kind::NewFile => self.choose(
                u,
                &[
                    "main.rat",
                    "other.rat",
                    "none.rat",
                    "img.png",
                    "../up.png",
                    "shell.rat",
                    "a/b-c.tif",
                ],
            ),
            Kind::Text => {
                for _ in 0..u.int_in_range(0..=3)? {
                    self.choose(u, &["sphere", "all", "m0", "print", "on", "…", "12"])?;
                }
                Ok(())
            }
            Kind::Block => self.braces(u),
        }
    }

    fn name(&mut self, u: &mut Unstructured<'_>, names: Names) -> Result<()> {
        if u.ratio(1, 25)? {
            return self.choose(
                u,
                &[
                    "m0", "o0", "v0", "sphere", "sin", "Red", "sin^2", "é", "_", "9x",
                ],
            );
        }
        match names {
            Names::Material => self.choose(u, &["m0", "m0", "m1", "m2", "s"]),
            Names::Texture => self.choose(u, &["t0", "t0", "t1", "t2"]),
            Names::Object => self.choose(u, &["o0", "o0", "o1", "o2"]),
            Names::Variable => self.choose(u, &["v0", "V1", "c2", "i", "j", "a"]),
            Names::Node => self.choose(u, &["A", "A", "B", "n"]),
            Names::Preset => self.choose(u, &["small", "large"]),
            Names::Command => {
                let all: Vec<&CommandSpec> = commands::all().collect();
                let name = u.choose(&all)?.name;
                self.word(name);
                Ok(())
            }
        }
    }

    /// Writes a number, mostly of the range, at times at or beyond its ends.
    fn number_in(&mut self, u: &mut Unstructured<'_>, low: f64, high: f64) -> Result<()> {
        let (near_low, near_high) = (low.max(-5.0), high.min(5.0).max(low.max(-5.0)));
        match u.int_in_range(0..=11)? {
            0 => self.expression(u, 0),
            1 => self.choose(u, NUMBERS),
            2 => {
                self.word(&low.to_string());
                Ok(())
            }
            3 => {
                self.word(&high.to_string());
                Ok(())
            }
            4 => self.choose(u, &["v0", "i", "V1", "c2", "nobody"]),
            _ => {
                let share = f64::from(u.int_in_range(0..=100)?) / 100.0;
                let number = near_low + (near_high - near_low) * share;
                // Whole numbers are wanted as often as others.
                let number = if u.ratio(1, 2)? {
                    number.round()
                } else {
                    number
                };
                self.word(&number.to_string());
                Ok(())
            }
        }
    }

    fn vector(&mut self, u: &mut Unstructured<'_>) -> Result<()> {
        match u.int_in_range(0..=7)? {
            0 => self.choose(u, &["V1", "c2", "v0", "-V1", "V1*2", "V1 - V1", "unit(V1)"]),
            1 => self.choose(
                u,
                &[
                    "0 0 0",
                    "<0 0 0>",
                    "1e12 1e12 1e12",
                    "vec(1,2,3)",
                    "cross(V1,V1)",
                ],
            ),
            2 => {
                self.text += "<";
                for _ in 0..3 {
                    self.expression(u, 0)?;
                }
                self.text += "> ";
                Ok(())
            }
            _ => {
                for _ in 0..3 {
                    self.number_in(u, -5.0, 5.0)?;
                }
                Ok(())
            }
        }
    }

    fn colour(&mut self, u: &mut Unstructured<'_>) -> Result<()> {
        match u.int_in_range(0..=3)? {
            0 => self.vector(u),
            1 => self.choose(
                u,
                &["c2", "rgb(1, 0.5, 0)", "Gray15", "gray101", "Nocolour"],
            ),
            _ => self.choose(u, &["Red", "SummerSky", "OrangeRed", "White", "black"]),
        }
    }

    fn value(&mut self, u: &mut Unstructured<'_>) -> Result<()> {
        match u.int_in_range(0..=3)? {
            0 => self.vector(u),
            1 => self.colour(u),
            _ => self.expression(u, 0),
        }
    }

    fn condition(&mut self, u: &mut Unstructured<'_>) -> Result<()> {
        if u.ratio(1, 6)? {
            self.text += "not ";
        }
        self.expression(u, 0)?;
        if u.ratio(5, 6)? {
            self.choose(u, &["<", ">", "<=", ">=", "==", "!=", "="])?;
            self.expression(u, 0)?;
        }
        if u.ratio(1, 5)? {
            self.choose(u, &["and", "or"])?;
            self.expression(u, 0)?;
        }
        Ok(())
    }

    fn expression(&mut self, u: &mut Unstructured<'_>, depth: usize) -> Result<()> {
        if depth >= DEPTH {
            return self.choose(u, NUMBERS);
        }
        match u.int_in_range(0..=9)? {
            0 => {
                self.expression(u, depth + 1)?;
                self.choose(u, &["+", "-", "*", "/", "^"])?;
                self.expression(u, depth + 1)
            }
            1 => {
                let name = u.choose(FUNCTIONS)?;
                self.text += name;
                self.text += "(";
                for index in 0..u.int_in_range(0..=3)? {
                    if index > 0 {
                        self.text += ", ";
                    }
                    self.expression(u, depth + 1)?;
                }
                self.text += ") ";
                Ok(())
            }
            2 => {
                self.text += "(";
                self.expression(u, depth + 1)?;
                self.text += ") ";
                Ok(())
            }
            3 => {
                self.text += "-";
                self.expression(u, depth + 1)
            }
            4 => self.choose(u, &["v0", "V1", "c2", "i", "pi", "rand", "e"]),
            _ => self.choose(u, NUMBERS),
        }
    }
}
