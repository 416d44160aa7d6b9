//! The constants of an element as the functions in `shaders/field/` load them.
use field::Term;
use std::cell::RefCell;
use std::fmt::{Display, Formatter, Result as Written};
use std::str::FromStr;

/// The list that a constant is from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Source {
    /// The constants of an element's frame, amplitude and bone.
    Bone,
    /// The constants of its profile.
    Profile,
}

/// The constants that a function loads, in its order: four by four, each record of a list from a
/// multiple of four on.
///
/// Its text, the first line of the function's file, is `b0 b1 b4 p3 | 13+2x6: 0 1 | 25+5: 0 3`:
/// places of constants of bone and profile; then lists, each with the place where it begins, the
/// number of constants and the number of records (for the last one left out, as it differs from
/// element to element), and the places in a record.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Layout {
    /// The constants outside of lists.
    pub fixed: Vec<(Source, u32)>,
    /// Lists of records; of the last one the length may differ.
    pub lists: Vec<List>,
}

/// A list of records.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct List {
    /// Place of the first record's first constant.
    pub base: u32,
    /// Number of constants of a record.
    pub stride: u32,
    /// Number of records; `None` if there are as many as constants.
    pub count: Option<u32>,
    /// The constants that are loaded, from the start of the record.
    pub reads: Vec<u32>,
}

impl List {
    /// Returns the number of vectors of four that a record takes.
    #[must_use]
    pub fn vectors(&self) -> u32 {
        self.reads.len().div_ceil(4) as u32
    }
}

impl Layout {
    /// Returns an element's constants in vectors of four, and the number of records of the last
    /// list.
    ///
    /// # Panics
    /// If the layout is not that of the term's cell.
    #[must_use]
    pub fn pack(&self, term: &Term<f32>) -> (Vec<[f32; 4]>, u32) {
        let [bone, profile] = constants(term);
        let mut vectors = Vec::new();
        append(
            &mut vectors,
            self.fixed.iter().map(|(source, place)| match source {
                Source::Bone => bone[*place as usize],
                Source::Profile => profile[*place as usize],
            }),
        );
        let mut records = 0;
        for list in &self.lists {
            let rest = bone.len() as u32 - list.base;
            records = list.count.unwrap_or(rest / list.stride);
            for record in 0..records {
                let start = list.base + record * list.stride;
                let reads = list.reads.iter().map(|read| start + read);
                append(&mut vectors, reads.map(|place| bone[place as usize]));
            }
        }
        (vectors, records)
    }
}

/// Appends numbers in vectors of four.
fn append(vectors: &mut Vec<[f32; 4]>, numbers: impl Iterator<Item = f32>) {
    let start = vectors.len();
    for (i, number) in numbers.enumerate() {
        vectors.resize(start + i / 4 + 1, [0.0; 4]);
        vectors[start + i / 4][i % 4] = number;
    }
}

/// Reads a whole number.
fn number(text: &str) -> Result<u32, NoLayout> {
    text.trim().parse().map_err(|_| NoLayout)
}

/// Returns the constants of a term, and those of its profile.
fn constants(term: &Term<f32>) -> [Vec<f32>; 2] {
    let [bone, profile] = [0; 2].map(|_| RefCell::new(Vec::new()));
    term.cast(
        |number| bone.borrow_mut().push(number),
        |number| profile.borrow_mut().push(number),
    );
    [bone, profile].map(RefCell::into_inner)
}

impl Display for Layout {
    fn fmt(&self, f: &mut Formatter<'_>) -> Written {
        let fixed = self.fixed.iter().map(|(source, place)| match source {
            Source::Bone => format!("b{place}"),
            Source::Profile => format!("p{place}"),
        });
        f.write_str(&fixed.collect::<Vec<_>>().join(" "))?;
        for list in &self.lists {
            write!(f, " | {}+{}", list.base, list.stride)?;
            if let Some(count) = list.count {
                write!(f, "x{count}")?;
            }
            f.write_str(":")?;
            for read in &list.reads {
                write!(f, " {read}")?;
            }
        }
        Ok(())
    }
}

/// A text that is no layout.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NoLayout;

impl FromStr for Layout {
    type Err = NoLayout;

    fn from_str(text: &str) -> Result<Self, NoLayout> {
        let mut parts = text.split('|');
        let fixed = parts.next().unwrap_or_default().split_whitespace();
        let fixed = fixed.map(
            |word| match (word.strip_prefix('b'), word.strip_prefix('p')) {
                (Some(place), _) => Ok((Source::Bone, number(place)?)),
                (_, Some(place)) => Ok((Source::Profile, number(place)?)),
                _ => Err(NoLayout),
            },
        );
        let fixed = fixed.collect::<Result<_, _>>()?;
        let lists = parts.map(|part| {
            let (shape, reads) = part.split_once(':').ok_or(NoLayout)?;
            let (base, shape) = shape.split_once('+').ok_or(NoLayout)?;
            let (stride, count) = match shape.split_once('x') {
                Some((stride, count)) => (stride, Some(number(count)?)),
                None => (shape, None),
            };
            Ok(List {
                base: number(base)?,
                stride: number(stride)?,
                count,
                reads: (reads.split_whitespace())
                    .map(number)
                    .collect::<Result<_, _>>()?,
            })
        });
        let lists = lists.collect::<Result<_, _>>()?;
        Ok(Self { fixed, lists })
    }
}
