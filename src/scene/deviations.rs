//! `[uncertainty]`: standard deviations of the numbers of a scene.

use std::collections::BTreeMap;

use toml::Spanned;

use crate::input::{did_you_mean, shortened};

use super::error::Fault;
use super::limits::{Limits, Number};
use super::parameter::Parameter;
use super::whisker::Whisker;

/// The key of the radii of measured rows.
const ROWS: &str = "profile_radius_um";

/// The largest number that any key of a scene may have.
const MOST: f64 = 1e5;

/// Standard deviations of numbers of a scene, which vary independently of each other.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Deviations {
    /// Parameters that the scene gives, each with its deviation in its own unit.
    pub parameters: Vec<(Parameter, f64)>,
    /// Deviation of the radius of every row of `whisker.profile`, where there is one.
    pub profile_radius_um: Option<f64>,
}

/// The deviations of the table, for the checked `whisker` of the scene with this `text`.
pub(super) fn deviations(
    table: &Spanned<BTreeMap<String, Number>>,
    text: &str,
    whisker: &Whisker,
) -> Result<Deviations, Fault> {
    let fields = table.get_ref();
    if fields.is_empty() {
        let must = format!("must have at least one of {}", names());
        return Err(Fault::new("uncertainty", table.span(), must));
    }
    let scene: toml::Table = toml::from_str(text).unwrap_or_default();
    let mut deviations = Deviations::default();
    for (name, number) in fields {
        let key = format!("uncertainty.{}", shortened(name));
        let refuse = |must: String| Err(Fault::new(&*key, number.span(), must));
        let parameter = Parameter::named(name);
        if parameter.is_none() && name != ROWS {
            let known = Parameter::ALL.map(Parameter::name);
            let hint = did_you_mean(name, known.into_iter().chain([ROWS]));
            return refuse(format!("is not known; must be one of {}{hint}", names()));
        }
        let deviation = Limits::between(0.0, MOST).check(&key, number)?;
        let measured = whisker.profile.is_some();
        match parameter {
            None if measured => deviations.profile_radius_um = Some(deviation),
            None => return refuse("must be left out: there is no whisker.profile".into()),
            Some(Parameter::LengthMm) if measured => {
                return refuse("must be left out: whisker.profile.rows end at the length".into());
            }
            Some(Parameter::Taper) if fields.contains_key(Parameter::TipRadiusUm.name()) => {
                return refuse(
                    "must be left out beside tip_radius_um: both vary the tip's radius".into(),
                );
            }
            Some(own) if own.number_in(&scene).is_none() => {
                let at = own.key();
                return refuse(format!("must be left out: the scene does not give {at}"));
            }
            Some(own) => deviations.parameters.push((own, deviation)),
        }
    }
    Ok(deviations)
}

/// Every key of the table.
fn names() -> String {
    let names = Parameter::ALL.map(|one| format!("`{}`", one.name()));
    format!("{}, `{ROWS}`", names.join(", "))
}
