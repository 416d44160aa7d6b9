//! `sinew plot`: curves of kernels, and the field of a dataset along a line or on a plane, as a
//! drawing (SVG) or as numbers (CSV).

use crate::files::Loaded;
use crate::{Outcome, files, report, whole};
use clap::Args;
use field::{Kernel, THRESHOLD};
use glam::DVec3;
use picture::contour::Grid;
use scene::Surface;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};

/// Values along a curve.
const SAMPLES: usize = 400;
/// Values along a side of a plane.
const SIDE: usize = 240;
/// Levels of the lines on a plane, in thresholds; the surface is at 1.
const LEVELS: [f32; 7] = [0.1, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0];
/// Most that is drawn of kernels, some of which are endless at 0, and of a field, in thresholds.
const TOPS: [f64; 2] = [1.2, 8.0];
/// Colours of curves.
const COLOURS: [&str; 9] = [
    "#c97a00", "#2288c4", "#007f5c", "#8f8200", "#3b47b8", "#c2410c", "#a33e7a", "#3a424c",
    "#6b4423",
];
/// Width and height of a drawing, and the margins at its left, top, right and bottom.
const SIZE: [f64; 2] = [640.0, 440.0];
const MARGINS: [f64; 4] = [64.0, 16.0, 16.0, 44.0];

/// `sinew plot --kernels [NAME …] | FILE --line X Y Z X Y Z | FILE --plane z=0 -o OUT.svg|OUT.csv`.
#[derive(Args)]
pub struct Plot {
    /// The dataset, or a skeleton's file
    #[arg(required_unless_present = "kernels")]
    file: Option<PathBuf>,
    /// Drawing (.svg) or table of numbers (.csv) to write
    #[arg(short, long)]
    output: PathBuf,
    /// Plot kernels, all nine or these, over the distance in their widths
    #[arg(long, num_args = 0.., value_name = "NAME", conflicts_with = "file")]
    kernels: Option<Vec<String>>,
    /// Plot each body's field along the line between two points
    #[arg(long, num_args = 6, value_names = ["X", "Y", "Z", "X", "Y", "Z"],
        allow_negative_numbers = true, conflicts_with_all = ["kernels", "plane"])]
    line: Option<Vec<f64>>,
    /// Draw lines of equal field on a plane: x=, y= or z= and a number
    #[arg(long, value_name = "z=0", conflicts_with = "kernels")]
    plane: Option<String>,
    /// The part of the plane: its lower left and its upper right corner; default: around the model
    #[arg(long, num_args = 4, value_names = ["U", "V", "U", "V"],
        allow_negative_numbers = true, requires = "plane")]
    window: Option<Vec<f64>>,
}

/// Numbers to plot: each column has a name, and each row a value of all of them.
struct Table {
    names: Vec<String>,
    rows: Vec<Vec<f64>>,
}

impl Plot {
    /// Writes the plot. False if the dataset has errors.
    pub fn run(&self) -> Outcome {
        let ending = self.output.extension().unwrap_or_default();
        let is_table = ending.eq_ignore_ascii_case("csv");
        if !is_table && !ending.eq_ignore_ascii_case("svg") {
            let name = self.output.display();
            return Err(format!(
                "{name}: the name of a plot must end in .svg or .csv"
            ));
        }
        let numbers = self.line.iter().chain(&self.window).flatten();
        if numbers.clone().any(|number| !number.is_finite()) {
            return Err(String::from("places are finite numbers"));
        }
        if let Some(names) = &self.kernels {
            let table = tabulate_kernels(names)?;
            let text = match is_table {
                true => table.write(),
                false => table.draw("distance ÷ width", "kernel", TOPS[0], None),
            };
            return self.save(&text, true);
        }
        let loaded = files::load(self.file.as_deref().unwrap_or(Path::new(files::INPUT)))?;
        let clean = report::to_stderr(&loaded);
        let surfaces = loaded.compiled.scene.surfaces();
        if surfaces.is_empty() {
            return Err(String::from(
                "there is no field: nothing in the dataset is soft",
            ));
        }
        let text = match (&self.line, &self.plane) {
            (Some(ends), _) => {
                let table = tabulate_line(&loaded, &surfaces, ends);
                match is_table {
                    true => table.write(),
                    false => {
                        let top = TOPS[1] * THRESHOLD;
                        table.draw("distance along the line", "field", top, Some(THRESHOLD))
                    }
                }
            }
            (None, Some(plane)) => {
                let plane = Plane::read(plane, self.window.as_deref(), &loaded)?;
                let grid = plane.sample(&surfaces);
                match is_table {
                    true => plane.tabulate(&grid).write(),
                    false => plane.draw(&grid),
                }
            }
            (None, None) => {
                let why = "say where: `--line 0 0 0 1 0 0`, `--plane z=0`, or `--kernels`";
                return Err(String::from(why));
            }
        };
        self.save(&text, clean)
    }

    fn save(&self, text: &str, clean: bool) -> Outcome {
        whole::write(&self.output, |file| {
            let written = file.write_all(text.as_bytes());
            written.map_err(|error| error.to_string())
        })?;
        eprintln!("wrote {}", self.output.display());
        Ok(clean)
    }
}

/// Returns the values of kernels over three of their widths.
///
/// # Errors
/// If there is no kernel of a name.
fn tabulate_kernels(names: &[String]) -> Result<Table, String> {
    let kernels = match names {
        [] => Kernel::ALL.to_vec(),
        _ => names
            .iter()
            .map(|name| find_kernel(name))
            .collect::<Result<_, _>>()?,
    };
    let rows = (0..=SAMPLES).map(|i| {
        let u = 3.0 * i as f64 / SAMPLES as f64;
        let values = kernels.iter().map(|kernel| kernel.value(u));
        std::iter::once(u).chain(values).collect()
    });
    let names = kernels.iter().map(|kernel| String::from(kernel.name()));
    Ok(Table {
        names: std::iter::once(String::from("u")).chain(names).collect(),
        rows: rows.collect(),
    })
}

/// Returns the kernel of a name.
///
/// # Errors
/// If there is none.
fn find_kernel(name: &str) -> Result<Kernel, String> {
    Kernel::named(name).ok_or_else(|| {
        let all = Kernel::ALL.map(Kernel::name).join(", ");
        format!("there is no kernel `{name}`; the kernels are {all}")
    })
}

/// Returns the field of each body along a line between two points.
fn tabulate_line(loaded: &Loaded, surfaces: &[Surface], ends: &[f64]) -> Table {
    let [from, to] = [0, 3].map(|i| DVec3::from_slice(&ends[i..i + 3]));
    let rows = (0..=SAMPLES).map(|i| {
        let share = i as f64 / SAMPLES as f64;
        let point = from.lerp(to, share);
        let values = surfaces.iter().map(|own| own.function().jet(point).value);
        std::iter::once(share * from.distance(to))
            .chain(values)
            .collect()
    });
    let bodies = &loaded.compiled.scene.bodies;
    let names = surfaces
        .iter()
        .map(|own| match bodies[own.body() as usize].name.as_str() {
            "" => String::from("field"),
            name => name.to_owned(),
        });
    Table {
        names: std::iter::once(String::from("distance"))
            .chain(names)
            .collect(),
        rows: rows.collect(),
    }
}

impl Table {
    /// Returns the numbers as CSV.
    fn write(&self) -> String {
        let mut text = self.names.join(",");
        for row in &self.rows {
            let row: Vec<String> = row.iter().map(f64::to_string).collect();
            text += "\n";
            text += &row.join(",");
        }
        text + "\n"
    }

    /// Returns a drawing of all columns over the first, up to `top`, with a dashed line at `line`.
    fn draw(&self, across: &str, up: &str, top: f64, line: Option<f64>) -> String {
        let values = self.rows.iter().flat_map(|row| &row[1..]).copied();
        let finite = values.filter(|value| value.is_finite());
        let most = finite.clone().chain(line).fold(0.0, f64::max).min(top);
        let least = finite.fold(0.0, f64::min).max(-top);
        let last = self.rows.last().map_or(1.0, |row| row[0]);
        let chart = Chart {
            x: [0.0, last],
            y: [least, most + 0.05 * (most - least)],
        };
        let mut text = chart.begin(across, up);
        if let Some(height) = line {
            text += &chart.path(
                &[[0.0, height], [last, height]],
                "#888",
                "stroke-dasharray=\"5 4\"",
            );
        }
        for (i, name) in self.names.iter().enumerate().skip(1) {
            let colour = COLOURS[(i - 1) % COLOURS.len()];
            let points: Vec<[f64; 2]> = self.rows.iter().map(|row| [row[0], row[i]]).collect();
            text += &chart.path(&points, colour, "");
            let y = MARGINS[1] + 16.0 * i as f64;
            let x = SIZE[0] - MARGINS[2] - 8.0;
            // Writing to a string does not fail.
            let _ = writeln!(
                text,
                "<text x=\"{x}\" y=\"{y}\" fill=\"{colour}\" text-anchor=\"end\">{}</text>",
                escape(name)
            );
        }
        text + "</svg>\n"
    }
}

/// A part of a plane across one axis.
struct Plane {
    axis: usize,
    height: f64,
    /// Lower left and upper right corner, along the two other axes.
    window: [[f64; 2]; 2],
}

impl Plane {
    /// Reads `x=N`, `y=N` or `z=N`. Without a window it shows all that is finite in the scene.
    ///
    /// # Errors
    /// If it is not written so, or the window is empty.
    fn read(text: &str, window: Option<&[f64]>, loaded: &Loaded) -> Result<Self, String> {
        let parts = text.split_once('=');
        let axis = parts.and_then(|(axis, _)| ["x", "y", "z"].iter().position(|own| *own == axis));
        let height = parts.and_then(|(_, height)| height.trim().parse::<f64>().ok());
        let (Some(axis), Some(height)) = (axis, height.filter(|h| h.is_finite())) else {
            return Err(format!("`--plane {text}`: write x=, y= or z= and a number"));
        };
        let window = if let Some(window) = window {
            [[window[0], window[1]], [window[2], window[3]]]
        } else {
            let shapes = loaded.compiled.scene.elements.iter().map(|own| &own.shape);
            let (middle, reach) = scene::extent(shapes).unwrap_or((DVec3::ZERO, 1.0));
            let middle = axes(axis).map(|other| middle[other]);
            let reach = 1.3 * reach
                + loaded
                    .compiled
                    .scene
                    .elements
                    .iter()
                    .fold(0.0, |most, own| {
                        f64::max(most, loaded.compiled.scene.radius(own))
                    });
            [-1.0, 1.0].map(|side| middle.map(|middle| middle + side * reach))
        };
        if (0..2).any(|i| window[1][i] - window[0][i] <= 0.0) {
            return Err(String::from(
                "--window takes the lower left corner first, then the upper right one",
            ));
        }
        Ok(Self {
            axis,
            height,
            window,
        })
    }

    fn place(&self, column: usize, row: usize) -> [f64; 2] {
        let share = [column, row].map(|i| i as f64 / (SIDE - 1) as f64);
        let [low, high] = self.window;
        [0, 1].map(|i| low[i] + share[i] * (high[i] - low[i]))
    }

    /// Computes the largest of the bodies' fields at the places of a grid.
    fn sample(&self, surfaces: &[Surface]) -> Grid {
        let axes = axes(self.axis);
        let places = (0..SIDE * SIDE).map(|i| self.place(i % SIDE, i / SIDE));
        let values = places.map(|place| {
            let mut point = DVec3::ZERO;
            point[self.axis] = self.height;
            point[axes[0]] = place[0];
            point[axes[1]] = place[1];
            let values = surfaces.iter().map(|own| own.function().jet(point).value);
            values.fold(f64::NEG_INFINITY, f64::max) as f32
        });
        Grid {
            width: SIDE,
            height: SIDE,
            values: values.collect(),
        }
    }

    fn tabulate(&self, grid: &Grid) -> Table {
        let rows = grid.values.iter().enumerate().map(|(i, value)| {
            let [u, v] = self.place(i % SIDE, i / SIDE);
            vec![u, v, f64::from(*value)]
        });
        let [u, v] = axes(self.axis).map(|axis| String::from(["x", "y", "z"][axis]));
        Table {
            names: vec![u, v, String::from("field")],
            rows: rows.collect(),
        }
    }

    /// Draws lines of equal field, the surface as a thick one.
    fn draw(&self, grid: &Grid) -> String {
        let [low, high] = self.window;
        let chart = Chart {
            x: [low[0], high[0]],
            y: [low[1], high[1]],
        }
        .with_square_units();
        let names = axes(self.axis).map(|axis| ["x", "y", "z"][axis]);
        let mut text = chart.begin(names[0], names[1]);
        let unit = [0, 1].map(|i| (high[i] - low[i]) / (SIDE - 1) as f64);
        for (level, colour) in LEVELS.into_iter().zip(COLOURS) {
            let width = if level == 1.0 { 2.5 } else { 1.0 };
            let mut path = String::new();
            for piece in grid.line(level * THRESHOLD as f32) {
                let [a, b] = piece.map(|place| {
                    chart.pixel([0, 1].map(|i| low[i] + f64::from(place[i]) * unit[i]))
                });
                let _ = write!(path, "M{:.2} {:.2}L{:.2} {:.2}", a[0], a[1], b[0], b[1]);
            }
            let _ = writeln!(
                text,
                "<path d=\"{path}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\"/>"
            );
            let y = MARGINS[1] + 16.0 * f64::from(level.log2() + 5.0);
            let _ = writeln!(
                text,
                "<text x=\"{}\" y=\"{y:.1}\" fill=\"{colour}\" \
                 text-anchor=\"end\">{level} T</text>",
                SIZE[0] - 4.0
            );
        }
        text + "</svg>\n"
    }
}

/// Returns the two axes beside one, in their order.
fn axes(across: usize) -> [usize; 2] {
    [[1, 2], [0, 2], [0, 1]][across]
}

/// Ranges of a drawing's axes.
struct Chart {
    x: [f64; 2],
    y: [f64; 2],
}

impl Chart {
    /// Widens one range, so that a unit is as long across as it is up.
    fn with_square_units(mut self) -> Self {
        let room = [
            SIZE[0] - MARGINS[0] - MARGINS[2],
            SIZE[1] - MARGINS[1] - MARGINS[3],
        ];
        let long = [self.x[1] - self.x[0], self.y[1] - self.y[0]];
        let unit = f64::max(long[0] / room[0], long[1] / room[1]);
        for (range, room) in [(&mut self.x, room[0]), (&mut self.y, room[1])] {
            let more = 0.5 * (unit * room - (range[1] - range[0]));
            *range = [range[0] - more, range[1] + more];
        }
        self
    }

    /// Returns the place of a point in the drawing.
    fn pixel(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [left, top, right, bottom] = MARGINS;
        let share = [(x, self.x), (y, self.y)].map(|(at, [low, high])| (at - low) / (high - low));
        [
            left + share[0] * (SIZE[0] - left - right),
            SIZE[1] - bottom - share[1] * (SIZE[1] - top - bottom),
        ]
    }

    /// Begins a drawing: paper, axes with round numbers, and their names.
    fn begin(&self, across: &str, up: &str) -> String {
        let [width, height] = SIZE;
        let mut text = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" \
             font-family=\"sans-serif\" font-size=\"13\">\n\
             <rect width=\"{width}\" height=\"{height}\" fill=\"#fff\"/>\n\
             <clipPath id=\"chart\">\
             <rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/></clipPath>\n",
            MARGINS[0],
            MARGINS[1],
            width - MARGINS[0] - MARGINS[2],
            height - MARGINS[1] - MARGINS[3]
        );
        for at in round_numbers(self.x) {
            let [[x, low], [_, high]] = self.y.map(|y| self.pixel([at, y]));
            let _ = writeln!(
                text,
                "<path d=\"M{x:.1} {low:.1}V{high:.1}\" stroke=\"#ddd\"/>\
                 <text x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{at}</text>",
                low + 17.0
            );
        }
        for at in round_numbers(self.y) {
            let [[left, y], [right, _]] = self.x.map(|x| self.pixel([x, at]));
            let _ = writeln!(
                text,
                "<path d=\"M{left:.1} {y:.1}H{right:.1}\" stroke=\"#ddd\"/>\
                 <text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{at}</text>",
                left - 6.0,
                y + 4.0
            );
        }
        let [middle, end] = [0.5 * (MARGINS[0] + width), height - 8.0];
        let half = 0.5 * height;
        let _ = writeln!(
            text,
            "<text x=\"{middle}\" y=\"{end}\" text-anchor=\"middle\">{}</text>\n\
             <text transform=\"translate(16 {half}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
            escape(across),
            escape(up)
        );
        text
    }

    /// Returns a line through points; where a value is not finite it is broken.
    fn path(&self, points: &[[f64; 2]], colour: &str, more: &str) -> String {
        let mut path = String::new();
        let mut is_drawn = false;
        for point in points {
            let [x, y] = self.pixel(*point);
            if y.is_finite() {
                let letter = if is_drawn { 'L' } else { 'M' };
                let _ = write!(path, "{letter}{x:.2} {y:.2}");
            }
            is_drawn = y.is_finite();
        }
        format!(
            "<path clip-path=\"url(#chart)\" d=\"{path}\" fill=\"none\" stroke=\"{colour}\" \
             stroke-width=\"2\" {more}/>\n"
        )
    }
}

/// Returns some five round numbers in a range.
fn round_numbers([low, high]: [f64; 2]) -> Vec<f64> {
    let rough = (high - low) / 5.0;
    if !(rough > 0.0 && rough.is_finite()) {
        return Vec::new();
    }
    let power = 10.0_f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * power);
    let step = step
        .into_iter()
        .find(|step| *step >= rough)
        .unwrap_or(rough);
    let numbers = (low / step).ceil() as i64..=(high / step).floor() as i64;
    let digits = (-power.log10().floor()).max(0.0) as i32;
    let unit = 10.0_f64.powi(digits);
    // Rounded, so that 0.1 + 0.2 is written 0.3.
    numbers
        .take(50)
        .map(|i| (i as f64 * step * unit).round() / unit)
        .collect()
}

/// Returns a text as XML holds it.
fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;")
}
