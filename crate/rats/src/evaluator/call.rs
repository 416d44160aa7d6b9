//! The arguments of calls of commands that a text or the library defines.

use super::state::Evaluator;
use crate::problem::{Outcome, Problem};
use crate::reader::{Name, Reader};
use crate::scope::Scope;
use crate::symbol::Symbol;
use crate::syntax::{Command, Define, Formal, Takes};
use crate::value::Value;

impl<'a> Evaluator<'a> {
    /// Reads the value that a call gives each parameter; `None` where the default is to be taken.
    pub(super) fn arguments(
        &mut self,
        command: &'a Command,
        define: &'a Define,
    ) -> Outcome<Vec<(Symbol, Option<Value>)>> {
        let mut values: Vec<(Symbol, Option<Value>)> =
            define.parameters.iter().map(|p| (p.name, None)).collect();
        let chain = self.model.chain.clone();
        let mut next = 0;
        // In a chain its material is known already.
        if let Some(chain) = chain
            && let Some(first) = define.parameters.first()
            && first.takes == Takes::Surface
            && let Some(symbol) = self.scope.symbols.find(chain.text)
        {
            values[0].1 = Some(Value::Name(symbol));
            next = 1;
        }
        let mut read = self.reader(command);
        if next == 1
            && let Some((symbol, _)) = read.peek_word()
            && matches!(read.scope.get(symbol), Some(Value::Name(_)))
        {
            read.at += 1;
        }
        let mut surfaces = Vec::new();
        let mut named = false;
        while read.more() {
            let index = match read.peek_parameter() {
                Some((symbol, word)) => {
                    named = true;
                    take_parameter(&mut read, define, &values, symbol, word)?
                }
                None if named => {
                    return Err(Problem::new(
                        &read.here(),
                        "what follows a named parameter must be named too",
                    )
                    .hint(usage(read.scope, define)));
                }
                None if next == define.parameters.len() => {
                    let end = read.end();
                    end.map_err(|problem| problem.hint(usage(read.scope, define)))?;
                    break;
                }
                None => {
                    next += 1;
                    next - 1
                }
            };
            let start = read.start();
            let value = argument(&mut read, &define.parameters[index]);
            let value = value.map_err(|problem| match problem.hint {
                None => problem.hint(usage(read.scope, define)),
                Some(_) => problem,
            })?;
            // Better refuse a material here than where the command uses it.
            if let Value::Name(symbol) = value {
                surfaces.push(Name {
                    text: read.scope.symbols.word(symbol),
                    span: read.since(start),
                });
            }
            values[index].1 = Some(value);
        }
        for (parameter, (_, value)) in define.parameters.iter().zip(&values) {
            if value.is_none() && parameter.default.is_empty() {
                return Err(read
                    .missing(&parameter.shown)
                    .hint(usage(read.scope, define)));
            }
        }
        for name in surfaces {
            self.material(&name)?;
        }
        Ok(values)
    }

    /// Sets the parameters that a call left out, in the call's own scope.
    pub(super) fn defaults(
        &mut self,
        define: &'a Define,
        values: &[(Symbol, Option<Value>)],
    ) -> Outcome<()> {
        for (parameter, (name, value)) in define.parameters.iter().zip(values) {
            if value.is_some() {
                continue;
            }
            let mut command = define.head.clone();
            command.items = parameter.default.clone();
            command.span = parameter.span.clone();
            let mut read = self.reader(&command).joining();
            let value = argument(&mut read, parameter)?;
            self.scope.set(*name, value);
        }
        Ok(())
    }
}

/// Takes `word =` and returns the index of the parameter of that name.
fn take_parameter(
    read: &mut Reader<'_, '_>,
    define: &Define,
    values: &[(Symbol, Option<Value>)],
    symbol: Symbol,
    word: &str,
) -> Outcome<usize> {
    let start = read.start();
    let span = start..start + word.len();
    let Some(index) = define.parameters.iter().position(|p| p.name == symbol) else {
        let symbols = &read.scope.symbols;
        let names = define.parameters.iter().map(|p| symbols.word(p.name));
        let hint = crate::suggest::hint(word, names).unwrap_or_else(|| usage(read.scope, define));
        let name = symbols.word(define.name);
        return Err(Problem::new(&span, format!("`{name}` has no parameter `{word}`")).hint(hint));
    };
    if values[index].1.is_some() {
        return Err(Problem::new(&span, format!("`{word}` is given twice")));
    }
    read.at += 2;
    Ok(index)
}

/// Returns a hint on how a call of a defined command is written.
fn usage(scope: &Scope<'_>, define: &Define) -> String {
    let mut usage = scope.symbols.word(define.name).to_owned();
    for parameter in &define.parameters {
        let word = scope.symbols.word(parameter.name);
        usage += &if parameter.default.is_empty() {
            format!(" {word}")
        } else {
            format!(" [{word}]")
        };
    }
    format!("it is written `{usage}`")
}

/// Reads one argument of a call.
fn argument(read: &mut Reader<'_, '_>, parameter: &Formal) -> Outcome<Value> {
    let what = parameter.shown.as_str();
    match parameter.takes {
        Takes::Number => Ok(Value::Scalar(read.number(what)?)),
        Takes::Triple => read.triple(what),
        Takes::Surface => {
            let name = read.old_name(what)?;
            match read.scope.symbols.find(name.text) {
                Some(symbol) => Ok(Value::Name(symbol)),
                None if name.text.parse::<f64>().is_ok() => Err(Problem::new(
                    &name.span,
                    format!("expected {what}, found `{}`", name.text),
                )),
                None => Err(Problem::new(
                    &name.span,
                    format!("`{}` cannot be a material's name here", name.text),
                )
                .hint("a name with `^` cannot be handed on")),
            }
        }
    }
}
