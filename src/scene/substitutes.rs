//! What takes the place of a number of a whisker: another number, measured radii or traced points.

use super::builder::SceneBuilder;
use super::error::SceneFault;
use super::grid::SweepVariable;
use super::limits::digits;
use super::parameter::Parameter;
use super::profile::IS_MEASURED;
use super::shape::IS_TRACED;
use super::table::WhiskerRow;
use super::toml::{TAPER_KEY, YIELD_KEY, YIELD_STRAIN};

/// Reason why a radius at the tip is refused beside an axis of tapers.
pub(super) const HAS_TAPERS: &str =
    "must be left out: grid.taper gives every whisker of the sweep its tip";

/// Reason why a parabola is refused beside a spiral.
const IS_SPIRAL: &str = "must be left out: the whisker is an Euler spiral";

/// Part of a whisker that takes the place of some of its numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Substitute {
    /// Another number.
    Number(Parameter),
    /// Measured radii.
    Profile,
    /// Traced points of the resting whisker.
    Rest,
}

use Substitute::{Number, Profile, Rest};

impl Substitute {
    /// Returns the column of a table of whiskers that gives the substitute.
    pub const fn column(self) -> &'static str {
        match self {
            Number(parameter) => parameter.name(),
            Profile => "profile",
            Rest => "rest_points",
        }
    }

    /// Returns why a sweep axis is refused in a scene that gives the substitute to all whiskers; `None` if the scene does not.
    pub fn of_scene(self, scene: &SceneBuilder) -> Option<&'static str> {
        use Parameter::{SpiralPerMm, SpiralPerMm2, Taper};
        match self {
            Profile => scene.measured.as_ref().map(|_| IS_MEASURED),
            Rest => scene.traced.as_ref().map(|_| IS_TRACED),
            Number(Taper) => scene.sweeps(Taper).then_some(HAS_TAPERS),
            Number(spiral @ (SpiralPerMm | SpiralPerMm2)) => {
                scene.number(spiral).map(|_| IS_SPIRAL)
            }
            Number(_) => None,
        }
    }
}

impl Parameter {
    /// Returns what takes the place of the parameter: a whisker with one of these has no such number.
    pub(super) const fn substitutes(self) -> &'static [Substitute] {
        match self {
            Self::BaseRadiusUm => &[Profile],
            Self::TipRadiusUm => &[Number(Self::Taper), Profile],
            Self::Taper => &[Number(Self::TipRadiusUm), Profile],
            Self::ParabolaPerMm | Self::VertexMm => {
                &[Rest, Number(Self::SpiralPerMm), Number(Self::SpiralPerMm2)]
            }
            Self::SpiralPerMm | Self::SpiralPerMm2 => {
                &[Rest, Number(Self::ParabolaPerMm), Number(Self::VertexMm)]
            }
            _ => &[],
        }
    }
}

impl WhiskerRow {
    /// Returns true if the row gives the part of the whisker: not as a missing number.
    pub(super) fn gives(&self, part: Substitute) -> bool {
        match part {
            Number(parameter) => self.number(parameter).is_some(),
            Profile => self.profile.is_some(),
            Rest => self.rest.is_some(),
        }
    }
}

impl SceneBuilder {
    /// Returns true if the table gives bases of whiskers, but no tips. Then a taper of the scene is not the taper of the rows.
    pub(super) fn has_bases_of_rows(&self) -> bool {
        self.column_of(Parameter::Taper) == Some(Parameter::BaseRadiusUm.name())
    }

    /// Returns the column of the table that leaves a number of the scene without effect, because it gives the parameter or takes its place.
    ///
    /// A taper of the scene gives the tip of the scene's own base, so it has no place beside a column of bases.
    pub(super) fn column_of(&self, parameter: Parameter) -> Option<&'static str> {
        let base = Number(Parameter::BaseRadiusUm);
        let base = Some(base).filter(|_| parameter == Parameter::Taper);
        self.column(parameter, base)
    }

    /// Refuses a number of the scene that a column of the table leaves without effect.
    pub(super) fn refuse_number(&self, parameter: Parameter, value: f64) -> Result<(), SceneFault> {
        let fault = |column| {
            let key = match parameter {
                Parameter::Taper => TAPER_KEY,
                _ => parameter.key(),
            };
            SceneFault::of_value(key, digits(value), must(column))
        };
        self.column_of(parameter).map_or(Ok(()), |column| Err(fault(column)))
    }

    /// Refuses a yield strain of the scene that a column of the table leaves without effect.
    pub(super) fn refuse_yield_strain(&self) -> Result<(), SceneFault> {
        let mut rows = self.table.iter().flat_map(|rows| rows.iter());
        match rows.any(|row| row.yield_strain.is_some()) {
            true => Err(SceneFault::new(YIELD_KEY, must(YIELD_STRAIN))),
            false => Ok(()),
        }
    }

    /// Refuses sweep axes of parameters that a column of the table gives, or of which it takes the place.
    ///
    /// An axis of bases leaves the tip of each row where it is, so it has no place beside a column of tapers.
    pub(super) fn refuse_axes_of_columns(&self) -> Result<(), SceneFault> {
        for (parameter, _) in &self.sweep {
            let taper = Number(Parameter::Taper);
            let taper = Some(taper).filter(|_| *parameter == Parameter::BaseRadiusUm);
            if let Some(column) = self.column(*parameter, taper) {
                return Err(SceneFault::new(parameter.axis_key(), must(column)));
            }
        }
        Ok(())
    }

    /// Returns the column of the table that gives the parameter, a substitute of the parameter, or the `other` part.
    fn column(&self, parameter: Parameter, other: Option<Substitute>) -> Option<&'static str> {
        let rows = self.table.as_deref()?;
        let substitutes = parameter.substitutes().iter().copied();
        let parts = [Number(parameter)].into_iter().chain(substitutes);
        let mut parts = parts.chain(other);
        let part = parts.find(|part| rows.iter().any(|row| row.gives(*part)))?;
        Some(part.column())
    }
}

fn must(column: &str) -> String {
    let table = SweepVariable::TABLE;
    format!("must be left out: {table} has the column {column}")
}
