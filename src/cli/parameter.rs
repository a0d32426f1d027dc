//! Numbers of a scene by name.

use clap::builder::{PossibleValuesParser, TypedValueParser};
use whiskmap::scene::Parameter;

/// A parser of the names of parameters.
pub fn parameter() -> impl TypedValueParser<Value = Parameter> {
    PossibleValuesParser::new(Parameter::ALL.map(Parameter::name)).try_map(|name| {
        let unknown = || format!("there is no {name}");
        Parameter::named(&name).ok_or_else(unknown)
    })
}
