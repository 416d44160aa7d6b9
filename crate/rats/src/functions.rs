//! The functions of expressions. Angles are in radians; `rad` and `deg` convert.

use crate::random;
use crate::value::Value;
use glam::DVec3;

/// A function of expressions.
#[derive(Clone, Copy, Debug)]
pub struct Function {
    /// Name, in lower case.
    pub name: &'static str,
    /// Form and result: `sin(x): sine`.
    pub meaning: &'static str,
    /// The computation.
    pub run: Run,
}

/// The computation of a function on its arguments.
#[derive(Clone, Copy, Debug)]
pub enum Run {
    /// Number to number; each number of a triple.
    One(fn(f64) -> f64),
    /// Pair of numbers (or of triples, number by number) to one.
    Two(fn(f64, f64) -> f64),
    /// List of numbers, folded from the left.
    Fold(fn(f64, f64) -> f64),
    /// Triple of numbers to a vector.
    Vector,
    /// Triple of numbers to a colour.
    Colour,
    /// Pair of vectors to a number.
    Dot,
    /// Pair of vectors to a vector.
    Cross,
    /// Vector to its length.
    Length,
    /// Vector to the unit vector.
    Unit,
    /// List of numbers, possibly empty, to a random number.
    Random,
    /// List of one to three numbers, or a vector, to smooth noise.
    Noise,
}

const fn function(name: &'static str, meaning: &'static str, run: Run) -> Function {
    Function { name, meaning, run }
}

/// The functions.
pub static FUNCTIONS: &[Function] = &[
    function("sin", "sin(x): sine", Run::One(libm::sin)),
    function("cos", "cos(x): cosine", Run::One(libm::cos)),
    function("tan", "tan(x): tangent", Run::One(libm::tan)),
    function("asin", "asin(x): inverse sine", Run::One(libm::asin)),
    function("acos", "acos(x): inverse cosine", Run::One(libm::acos)),
    function("atan", "atan(x): inverse tangent", Run::One(libm::atan)),
    function(
        "atan2",
        "atan2(y, x): angle of (x, y)",
        Run::Two(libm::atan2),
    ),
    function(
        "rad",
        "rad(x): degrees to radians",
        Run::One(f64::to_radians),
    ),
    function(
        "deg",
        "deg(x): radians to degrees",
        Run::One(f64::to_degrees),
    ),
    function("sqrt", "sqrt(x): square root", Run::One(libm::sqrt)),
    function("exp", "exp(x): e^x", Run::One(libm::exp)),
    function("ln", "ln(x): natural logarithm", Run::One(libm::log)),
    function("abs", "abs(x): magnitude", Run::One(f64::abs)),
    function("sign", "sign(x): −1, 0 or 1", Run::One(sign)),
    function("floor", "floor(x): round down", Run::One(f64::floor)),
    function("ceil", "ceil(x): round up", Run::One(f64::ceil)),
    function(
        "round",
        "round(x): to the nearest whole number",
        Run::One(f64::round),
    ),
    function(
        "mod",
        "mod(x, y): remainder of x/y, with the sign of y",
        Run::Two(modulo),
    ),
    function("min", "min(a, b, …): the least", Run::Fold(f64::min)),
    function("max", "max(a, b, …): the greatest", Run::Fold(f64::max)),
    function("vec", "vec(x, y, z): a vector", Run::Vector),
    function("rgb", "rgb(r, g, b): a colour", Run::Colour),
    function("dot", "dot(U, V): scalar product", Run::Dot),
    function("cross", "cross(U, V): vector product", Run::Cross),
    function("length", "length(V): length of a vector", Run::Length),
    function("unit", "unit(V): the vector at length 1", Run::Unit),
    function(
        "rand",
        "rand: next random number in [0, 1) of the stream started by `seed`; rand(a, …): a random \
         number that depends on a, … alone",
        Run::Random,
    ),
    function(
        "noise",
        "noise(x, y, z) or noise(P): smooth noise from −1 to 1, 0 at whole numbers; y and z may be \
         left out",
        Run::Noise,
    ),
];

/// Finds a function by its name, ignoring case.
#[must_use]
pub fn find(name: &str) -> Option<&'static Function> {
    FUNCTIONS.iter().find(|f| f.name.eq_ignore_ascii_case(name))
}

/// Finds a constant by its name, ignoring case.
#[must_use]
pub fn constant(name: &str) -> Option<f64> {
    name.eq_ignore_ascii_case("pi")
        .then_some(std::f64::consts::PI)
}

fn sign(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { x.signum() }
}

fn modulo(x: f64, y: f64) -> f64 {
    x - y * (x / y).floor()
}

/// Applies a function to its arguments.
///
/// # Errors
/// A sentence if the number or kind of the arguments is wrong.
pub fn apply(function: &Function, arguments: &[Value]) -> Result<Value, String> {
    let name = function.name;
    let count = arguments.len();
    let wanted = match function.run {
        Run::One(_) | Run::Length | Run::Unit => Some(1),
        Run::Two(_) | Run::Dot | Run::Cross => Some(2),
        Run::Vector | Run::Colour => Some(3),
        Run::Fold(_) | Run::Random | Run::Noise => None,
    };
    if let Some(wanted) = wanted.filter(|wanted| *wanted != count) {
        let s = if wanted == 1 { "" } else { "s" };
        return Err(format!("`{name}` takes {wanted} argument{s}, not {count}"));
    }
    let misfit = || format!("the arguments of `{name}` do not fit together");
    match function.run {
        Run::One(f) => Ok(arguments[0].map(f)),
        Run::Two(f) => arguments[0].zip(arguments[1], f).ok_or_else(misfit),
        Run::Fold(f) => {
            let (first, rest) = arguments
                .split_first()
                .ok_or_else(|| format!("`{name}` takes at least one argument"))?;
            rest.iter()
                .try_fold(*first, |value, next| value.zip(*next, f))
                .ok_or_else(misfit)
        }
        Run::Vector | Run::Colour => {
            let [x, y, z] = [0, 1, 2].map(|i| scalar(name, &arguments[i]));
            let triple = DVec3::new(x?, y?, z?);
            Ok(match function.run {
                Run::Vector => Value::Vector(triple),
                _ => Value::Colour(triple),
            })
        }
        Run::Dot => {
            let (u, v) = (vector(name, &arguments[0])?, vector(name, &arguments[1])?);
            Ok(Value::Scalar(u.dot(v)))
        }
        Run::Cross => {
            let (u, v) = (vector(name, &arguments[0])?, vector(name, &arguments[1])?);
            Ok(Value::Vector(u.cross(v)))
        }
        Run::Length => Ok(Value::Scalar(vector(name, &arguments[0])?.length())),
        Run::Unit => vector(name, &arguments[0])?
            .try_normalize()
            .map(Value::Vector)
            .ok_or_else(|| String::from("a vector of length 0 has no direction")),
        Run::Noise => {
            let mut point = [0.0; 3];
            match arguments {
                [Value::Vector(v) | Value::Colour(v)] => point = v.to_array(),
                [_] | [_, _] | [_, _, _] => {
                    for (slot, argument) in point.iter_mut().zip(arguments) {
                        *slot = scalar(name, argument)?;
                    }
                }
                _ => {
                    let takes = "takes 1 to 3 numbers or a vector";
                    return Err(format!("`{name}` {takes}, not {count} arguments"));
                }
            }
            // Beyond this, neighbouring numbers are whole.
            if point.iter().any(|x| x.abs() > 1e15) {
                return Ok(Value::Scalar(0.0));
            }
            Ok(Value::Scalar(random::noise(point)))
        }
        Run::Random => {
            let mut numbers = Vec::with_capacity(arguments.len());
            for argument in arguments {
                numbers.push(scalar(name, argument)?);
            }
            Ok(Value::Scalar(random::hash(&numbers)))
        }
    }
}

fn scalar(name: &str, value: &Value) -> Result<f64, String> {
    match value {
        Value::Scalar(x) => Ok(*x),
        _ => Err(format!("`{name}` takes numbers, not {}", value.kind())),
    }
}

fn vector(name: &str, value: &Value) -> Result<DVec3, String> {
    match value {
        Value::Vector(v) | Value::Colour(v) => Ok(*v),
        Value::Scalar(_) | Value::Name(_) => {
            Err(format!("`{name}` takes vectors, not {}", value.kind()))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signs_and_remainders() {
        assert_eq!(sign(-0.0), 0.0);
        assert_eq!(sign(-3.0), -1.0);
        assert_eq!(modulo(-1.0, 3.0), 2.0);
        assert_eq!(modulo(7.5, 2.0), 1.5);
    }

    #[test]
    fn wrong_arguments_are_named() {
        let vector = Value::Vector(DVec3::X);
        let one = Value::Scalar(1.0);
        assert!(apply(find("sin").unwrap(), &[]).is_err());
        assert!(apply(find("max").unwrap(), &[]).is_err());
        assert!(apply(find("max").unwrap(), &[one, vector]).is_err());
        assert!(apply(find("cross").unwrap(), &[one, vector]).is_err());
        assert!(apply(find("unit").unwrap(), &[Value::Vector(DVec3::ZERO)]).is_err());
    }
}
