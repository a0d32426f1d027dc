//! Parsers of argument values, and help texts about columns.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Arg, Command, Error};
use std::ffi::OsStr;
use std::fmt::Write;
use std::ops::RangeInclusive;
use whiskmap::Side;
use whiskmap::input::Quantity;
use whiskmap::plan::Channels;
use whiskmap::scene::Parameter;

/// Parses a length in millimetres, or with a unit.
pub fn length(text: &str) -> Result<f64, String> {
    Quantity::LengthMm.parse(text)
}

/// Parses an angle in degrees, or with a unit.
pub fn angle(text: &str) -> Result<f64, String> {
    Quantity::AngleDeg.parse(text)
}

/// Parses a positive time in seconds, or with a unit.
pub fn duration(text: &str) -> Result<f64, String> {
    let seconds = Quantity::TimeS.parse(text)?;
    let seconds = Some(seconds).filter(|seconds| *seconds > 0.0);
    seconds.ok_or_else(|| "must be a positive time".to_owned())
}

/// Parses a span of time, `FROM..TO` in seconds or with units.
pub fn span(text: &str) -> Result<[f64; 2], String> {
    let must = || "must be a span of time, such as 0s..0.1s".to_owned();
    let (from, to) = text.split_once("..").ok_or_else(must)?;
    let time = |text: &str| {
        let seconds = Quantity::TimeS.parse(text);
        seconds.map_err(|why| format!("{text}: {why}"))
    };
    let ends @ [from, to] = [time(from)?, time(to)?];
    (from < to).then_some(ends).ok_or_else(must)
}

/// Numbers of threads that a run can have.
pub const THREADS: RangeInclusive<u32> = 1..=1024;

/// Returns a parser of whole numbers within `range`.
pub fn whole(range: RangeInclusive<u32>) -> impl Fn(&str) -> Result<u32, String> + Clone {
    move |text| {
        let number = text.parse().ok().filter(|number| range.contains(number));
        let (least, most) = (range.start(), range.end());
        number.ok_or_else(|| format!("must be a whole number between {least} and {most}"))
    }
}

/// Returns a parser of the names of scene parameters.
pub fn parameter() -> impl TypedValueParser<Value = Parameter> {
    // The axis of a parameter may have another name, which is accepted here to suggest the parameter.
    let names = Parameter::ALL
        .map(|parameter| PossibleValue::new(parameter.name()).alias(parameter.axis()));
    PossibleValuesParser::new(names).try_map(|name| {
        let hint = || Parameter::suggested(&name).unwrap_or_default();
        Parameter::named(&name).ok_or_else(|| format!("names a sweep axis{}", hint()))
    })
}

/// Parser of a text in which names may occur. Shells complete the names, but other texts are parsed, too; with `hide_possible_values`, the help
/// does not list them.
#[derive(Clone, Debug)]
pub struct Completed<P> {
    parser: P,
    names: Vec<&'static str>,
}

/// Returns a `parser` whose values shells complete from `names`.
pub fn completed<P>(parser: P, names: impl IntoIterator<Item = &'static str>) -> Completed<P> {
    Completed { parser, names: names.into_iter().collect() }
}

impl<P: TypedValueParser> TypedValueParser for Completed<P> {
    type Value = P::Value;

    fn parse_ref(
        &self,
        command: &Command,
        argument: Option<&Arg>,
        value: &OsStr,
    ) -> Result<Self::Value, Error> {
        self.parser.parse_ref(command, argument, value)
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new(self.names.iter().map(PossibleValue::new)))
    }
}

/// Returns the names of all channels that maps can have.
pub fn all_channels() -> impl Iterator<Item = &'static str> {
    Channels::those(|_| true).names().collect::<Vec<_>>().into_iter()
}

/// Returns the names of the parameters and of `others`.
pub fn variable_names(others: &[&'static str]) -> impl Iterator<Item = &'static str> {
    Parameter::ALL.map(Parameter::name).into_iter().chain(others.iter().copied())
}

/// Returns a parser of the names of `values`, each with its text in `help`.
pub fn named<T, const N: usize>(
    values: [T; N],
    name: fn(T) -> &'static str,
    help: [&'static str; N],
) -> impl TypedValueParser<Value = T>
where
    T: Copy + Send + Sync + 'static,
{
    let names = values.map(name);
    let shown = std::array::from_fn::<_, N, _>(|i| PossibleValue::new(names[i]).help(help[i]));
    PossibleValuesParser::new(shown).try_map(move |given| {
        let mut all = values.into_iter();
        let value = all.find(|value| name(*value) == given);
        value.ok_or_else(|| format!("must be one of {}", names.join(", ")))
    })
}

/// Returns a parser of the side of the whisker that the pole is on.
pub fn side() -> impl TypedValueParser<Value = Side> {
    let help = [
        "Concave backward: the pole is on the convex side",
        "Concave forward: the pole is on the concave side",
    ];
    let name = |side| match side {
        Side::Cb => "cb",
        Side::Cf => "cf",
    };
    named([Side::Cb, Side::Cf], name, help)
}

/// Returns `examples`, followed by the columns and meanings of each titled table.
pub fn column_help(examples: &str, tables: &[(&str, &[(&str, &str)])]) -> String {
    let mut help = examples.to_owned();
    for (title, columns) in tables {
        let wide = columns.iter().map(|(name, _)| name.len()).max();
        let wide = wide.unwrap_or_default();
        // Writing to a String cannot fail.
        let _ = write!(help, "\n\n{title}:");
        for (name, meaning) in *columns {
            let _ = write!(help, "\n  {name:wide$} {meaning}");
        }
    }
    help
}
