//! Writing a recorded formula as a function in WGSL.
use crate::layout::{Layout, List};
use crate::order::Order;
use crate::tape::{Expression, Loop, One, Place, Tape, Two};
use std::collections::{BTreeSet, HashMap};
use std::fmt::Write;
use std::rc::Rc;

/// Bytes of the longest line.
const WIDE: usize = 100;

/// Writes a function of a recorded formula, `total` being the number of the bone's constants.
pub fn function(name: &str, tape: &Tape, results: &[Place], total: u32) -> (Layout, String) {
    let order = Order::new(tape, results);
    let layout = layout(tape, &order, total);
    let mut writer = Writer {
        tape,
        order: &order,
        layout: &layout,
        name,
        text: String::new(),
        tables: String::new(),
        names: HashMap::new(),
        made: 0,
    };
    let vectors = layout.fixed.len().div_ceil(4);
    for i in 0..vectors {
        let _ = writeln!(writer.text, "    let c{i} = constant(at + {i}u);");
    }
    writer.block(0, 1);
    let results: Vec<String> = results.iter().map(|place| writer.operand(*place)).collect();
    let _ = writeln!(writer.text, "    return vec4<f32>({});", results.join(", "));
    let text = format!(
        "{}fn {name}(at: u32, count: u32, p: vec3<f32>) -> vec4<f32> {{\n{}}}\n",
        writer.tables, writer.text
    );
    (layout, text)
}

fn layout(tape: &Tape, order: &Order, total: u32) -> Layout {
    let mut fixed = BTreeSet::new();
    let mut records = BTreeSet::new();
    for place in order.block_of.keys() {
        match tape.at(*place) {
            Expression::Constant(source, place) => {
                fixed.insert((*source, *place));
            }
            Expression::Record {
                first,
                stride,
                count,
                ..
            } => {
                records.insert((*first, *stride, *count));
            }
            _ => {}
        }
    }
    let mut lists: Vec<List> = Vec::new();
    for (first, stride, count) in records {
        match lists.last_mut() {
            Some(list) if first < list.base + list.stride => list.reads.push(first - list.base),
            _ => {
                // Nothing comes after the list whose length differs.
                let base = total.checked_sub(stride * count);
                let base = base.filter(|base| (*base..base + stride).contains(&first));
                lists.push(List {
                    base: base.unwrap_or(first),
                    stride,
                    count: base.is_none().then_some(count),
                    reads: vec![first - base.unwrap_or(first)],
                });
            }
        }
    }
    Layout {
        fixed: fixed.into_iter().collect(),
        lists,
    }
}

struct Writer<'a> {
    tape: &'a Tape,
    order: &'a Order,
    layout: &'a Layout,
    name: &'a str,
    text: String,
    tables: String,
    /// The texts that stand for expressions.
    names: HashMap<Place, String>,
    /// Number of names made.
    made: usize,
}

impl Writer<'_> {
    fn new_name(&mut self) -> String {
        self.made += 1;
        format!("t{}", self.made)
    }

    fn line(&mut self, indent: usize, text: &str) {
        let _ = writeln!(self.text, "{}{text}", "    ".repeat(indent));
    }

    /// Writes the expressions of a block.
    fn block(&mut self, block: usize, indent: usize) {
        let order = self.order;
        for place in &order.places[block] {
            self.statement(*place, indent);
        }
    }

    fn statement(&mut self, place: Place, indent: usize) {
        match self.tape.at(place).clone() {
            Expression::Sum { of, count, terms } => {
                let sums = self.declare(place, terms.len(), indent);
                let i = self.new_name();
                let steps = self.order.inner(place)[0];
                let count = self.count(of, count);
                self.line(
                    indent,
                    &format!("for (var {i} = 0u; {i} < {count}; {i}++) {{"),
                );
                self.records(of, &i, indent + 1);
                self.block(steps, indent + 1);
                for (sum, term) in sums.iter().zip(terms.iter()) {
                    let term = self.operand(*term);
                    self.line(indent + 1, &format!("{sum} += {};", bare(&term)));
                }
                self.line(indent, "}");
            }
            Expression::Branch { on, arms } => {
                let names = self.declare(place, arms[0].len(), indent);
                let blocks = self.order.inner(place).to_vec();
                let on = self.operand(on);
                self.line(indent, &format!("if ({}) {{", bare(&on)));
                self.arm(&names, blocks[0], &arms[0], indent + 1);
                self.line(indent, "} else {");
                self.arm(&names, blocks[1], &arms[1], indent + 1);
                self.line(indent, "}");
            }
            Expression::Switch { on, arms } => {
                let names = self.declare(place, arms[0].len(), indent);
                let blocks = self.order.inner(place).to_vec();
                let on = self.operand(on);
                self.line(indent, &format!("switch u32({on} + 0.5) {{"));
                for (i, (block, arm)) in blocks.iter().zip(arms.iter()).enumerate() {
                    let case = if i + 1 < blocks.len() {
                        format!("case {i}u: {{")
                    } else {
                        "default: {".into()
                    };
                    self.line(indent + 1, &case);
                    self.arm(&names, *block, arm, indent + 2);
                    self.line(indent + 1, "}");
                }
                self.line(indent, "}");
            }
            // They were named at the start of the loop.
            Expression::Record { .. } | Expression::Table { .. } => {}
            expression => {
                let text = self.expression(&expression);
                let simple = matches!(
                    expression,
                    Expression::Number(_)
                        | Expression::Truth(_)
                        | Expression::Coordinate(_)
                        | Expression::Constant(..)
                        | Expression::Part(..)
                );
                if simple || self.joins(place, &text, indent) {
                    self.names.insert(place, text);
                } else {
                    let name = self.new_name();
                    self.line(indent, &format!("let {name} = {};", bare(&text)));
                    self.names.insert(place, name);
                }
            }
        }
    }

    /// Whether an expression is written where it is used: there is one use, by an expression of the
    /// same block, and the line does not become too long.
    fn joins(&self, place: Place, text: &str, indent: usize) -> bool {
        self.order.uses[&place] == 1
            && 4 * indent + text.len() < WIDE / 2
            && self.is_used_beside(place)
    }

    fn is_used_beside(&self, place: Place) -> bool {
        let block = self.order.block_of[&place];
        self.order.places[block].iter().any(|user| {
            let plain = !matches!(
                self.tape.at(*user),
                Expression::Sum { .. } | Expression::Branch { .. } | Expression::Switch { .. }
            );
            plain && self.tape.at(*user).operands().contains(&place)
        })
    }

    /// Declares variables for the values of an expression.
    fn declare(&mut self, place: Place, count: usize, indent: usize) -> Vec<String> {
        let name = self.new_name();
        let names: Vec<String> = (0..count).map(|i| format!("{name}_{i}")).collect();
        for name in &names {
            self.line(indent, &format!("var {name} = 0.0;"));
        }
        self.names.insert(place, name);
        names
    }

    fn arm(&mut self, names: &[String], block: usize, results: &Rc<[Place]>, indent: usize) {
        self.block(block, indent);
        for (name, result) in names.iter().zip(results.iter()) {
            let result = self.operand(*result);
            if result != "0.0" {
                self.line(indent, &format!("{name} = {result};"));
            }
        }
    }

    /// The lists that a loop runs over, by their places in the layout.
    fn lists_of(&self, of: Loop) -> Vec<usize> {
        let mut lists = BTreeSet::new();
        for place in self.order.block_of.keys() {
            if let Expression::Record {
                of: other, first, ..
            } = self.tape.at(*place)
                && *other == of
            {
                lists.insert(self.list_of(*first));
            }
        }
        lists.into_iter().collect()
    }

    fn list_of(&self, first: u32) -> usize {
        let after = (self.layout.lists).partition_point(|list| list.base <= first);
        after - 1
    }

    fn count(&self, of: Loop, count: u32) -> String {
        let varies =
            (self.lists_of(of).into_iter()).any(|list| self.layout.lists[list].count.is_none());
        if varies {
            "count".into()
        } else {
            format!("{count}u")
        }
    }

    /// Writes the loads of records at the start of a loop's steps.
    fn records(&mut self, of: Loop, i: &str, indent: usize) {
        for index in self.lists_of(of) {
            let before = &self.layout.lists[..index];
            let start = self.layout.fixed.len().div_ceil(4) as u32
                + (before.iter())
                    .map(|list| list.vectors() * list.count.unwrap_or(0))
                    .sum::<u32>();
            let list = &self.layout.lists[index];
            let (vectors, reads) = (list.vectors(), list.reads.clone());
            let base = list.base;
            let mut needed = BTreeSet::new();
            let mut texts = Vec::new();
            for place in self.order.block_of.keys() {
                if let Expression::Record {
                    of: other, first, ..
                } = self.tape.at(*place)
                    && *other == of
                    && self.list_of(*first) == index
                {
                    let slot = reads.partition_point(|read| *read < first - base);
                    needed.insert(slot / 4);
                    texts.push((*place, slot));
                }
            }
            for vector in needed {
                let place = start + vector as u32;
                let text = format!(
                    "let {i}_{index}_{vector} = constant(at + {place}u + {vectors}u * {i});"
                );
                self.line(indent, &text);
            }
            for (place, slot) in texts {
                let text = format!("{i}_{index}_{}.{}", slot / 4, axis(slot));
                self.names.insert(place, text);
            }
        }
        // Tables are read where they are used.
        let mut tables: Vec<(Place, Rc<[u32]>)> = (self.order.block_of.keys())
            .filter_map(|place| match self.tape.at(*place) {
                Expression::Table { of: other, numbers } if *other == of => {
                    Some((*place, numbers.clone()))
                }
                _ => None,
            })
            .collect();
        tables.sort_unstable_by_key(|(place, _)| *place);
        for (place, numbers) in tables {
            let table = self.table(&numbers);
            self.names.insert(place, format!("{table}[{i}]"));
        }
    }

    /// Writes a table of numbers, once, and returns its name.
    fn table(&mut self, numbers: &[u32]) -> String {
        let texts: Vec<String> = numbers.iter().map(|bits| literal(*bits)).collect();
        let rest = format!("= array<f32, {}>({});\n", texts.len(), texts.join(", "));
        let known = self
            .tables
            .lines()
            .position(|line| rest.starts_with(&line[line.find('=').unwrap_or(0)..]));
        let index = known.unwrap_or_else(|| self.tables.lines().count());
        let name = format!("{}_{index}", self.name);
        if known.is_none() {
            self.tables += &format!("const {name} {rest}");
        }
        name
    }

    fn operand(&self, place: Place) -> String {
        match self.names.get(&place) {
            Some(name) => name.clone(),
            None => panic!("{:?} is used before it is computed", self.tape.at(place)),
        }
    }

    fn expression(&self, expression: &Expression) -> String {
        match expression {
            Expression::Number(bits) => literal(*bits),
            Expression::Truth(known) => known.to_string(),
            Expression::Coordinate(i) => format!("p.{}", axis(*i as usize)),
            Expression::Constant(source, place) => {
                let slot = (self.layout.fixed).partition_point(|other| *other < (*source, *place));
                format!("c{}.{}", slot / 4, axis(slot))
            }
            Expression::One(One::Negate, a) => format!("(-{})", self.operand(*a)),
            Expression::One(One::Root, a) => format!("sqrt({})", self.operand(*a)),
            Expression::One(One::Size, a) => format!("abs({})", self.operand(*a)),
            Expression::One(One::Floor, a) => format!("floor({})", self.operand(*a)),
            Expression::Two(Two::Min, [a, b]) => {
                format!("min({}, {})", self.operand(*a), self.operand(*b))
            }
            Expression::Two(Two::Max, [a, b]) => {
                format!("max({}, {})", self.operand(*a), self.operand(*b))
            }
            Expression::Two(operation, [a, b]) => {
                let sign = match operation {
                    Two::Add => "+",
                    Two::Subtract => "-",
                    Two::Multiply => "*",
                    Two::Divide => "/",
                    Two::Less => "<",
                    _ => "&&",
                };
                format!("({} {sign} {})", self.operand(*a), self.operand(*b))
            }
            Expression::Select([on, yes, no]) => {
                format!(
                    "select({}, {}, {})",
                    self.operand(*no),
                    self.operand(*yes),
                    self.operand(*on)
                )
            }
            Expression::Call(name, operands) => {
                let operands: Vec<String> =
                    operands.iter().map(|place| self.operand(*place)).collect();
                format!("{name}({})", operands.join(", "))
            }
            Expression::Part(whole, i) => match self.tape.at(*whole) {
                Expression::Call(..) => format!("{}.{}", self.operand(*whole), axis(*i as usize)),
                _ => format!("{}_{i}", self.operand(*whole)),
            },
            other => panic!("{other:?} is no expression of one number"),
        }
    }
}

/// Removes parentheses around all of a text.
fn bare(text: &str) -> &str {
    let Some(inner) = text
        .strip_prefix('(')
        .and_then(|text| text.strip_suffix(')'))
    else {
        return text;
    };
    let mut depth = 0;
    let closes = inner.chars().any(|letter| {
        depth += i32::from(letter == '(') - i32::from(letter == ')');
        depth < 0
    });
    if closes { text } else { inner }
}

fn axis(i: usize) -> char {
    ['x', 'y', 'z', 'w'][i % 4]
}

/// Writes a number so that it is read as the same one.
fn literal(bits: u32) -> String {
    let number = f32::from_bits(bits);
    let text = format!("{:?}", number.abs());
    if number.is_sign_negative() {
        format!("(-{text})")
    } else {
        text
    }
}
