//! Variables: the numbers by which detachments and states are differentiated.

use crate::input::did_you_mean;
use crate::scene::{Parameter, Scene, derivative_columns};
use std::fmt;

/// Variable of a derivative: a parameter of the scene, the distance, the push angle, or one measured radius.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Variable {
    /// Parameter of the scene, with all other parameters fixed. The radius at the base varies at a fixed radius at the tip, and the taper
    /// at a fixed radius at the base.
    Parameter(Parameter),
    /// Distance from the base to the contact at first touch, in mm.
    DistanceMm,
    /// Push angle of a state, in degrees. Detachments do not depend on it.
    PushAngleDeg,
    /// Measured radius of this row of the whisker's profile, in um, before the factor of the radii. Where two neighbouring rows are equal,
    /// the derivative is the mean of the derivatives on both sides.
    ProfileRadiusUm(usize),
}

impl From<Parameter> for Variable {
    fn from(parameter: Parameter) -> Self {
        Self::Parameter(parameter)
    }
}

impl Variable {
    /// Returns the name of the variable, with its unit at the end.
    #[must_use]
    pub fn name(self) -> String {
        match self {
            Self::Parameter(parameter) => parameter.name().to_owned(),
            Self::DistanceMm => "distance_mm".to_owned(),
            Self::PushAngleDeg => "push_angle_deg".to_owned(),
            Self::ProfileRadiusUm(row) => format!("profile_radius_um[{row}]"),
        }
    }

    /// Returns the unit of the variable; `1` for a ratio.
    #[must_use]
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Parameter(parameter) => parameter.unit(),
            Self::DistanceMm => "mm",
            Self::PushAngleDeg => "deg",
            Self::ProfileRadiusUm(_) => "um",
        }
    }

    /// Returns the names of the columns with [`Derivatives::columns`](super::Derivatives::columns) by the variable, such as `d_push_d_taper`.
    #[must_use]
    pub const fn columns(self) -> [&'static str; 6] {
        match self {
            Self::Parameter(parameter) => parameter.derivative_columns(),
            Self::DistanceMm => derivative_columns!("distance_mm"),
            Self::PushAngleDeg => derivative_columns!("push_angle_deg"),
            Self::ProfileRadiusUm(_) => derivative_columns!("profile_radius_um"),
        }
    }

    /// Returns the value of the variable in the scene, in its unit: a parameter, or the radius of a row. `None` if the scene does not give
    /// it, and for numbers of a push.
    #[must_use]
    pub fn value(self, scene: &Scene) -> Option<f64> {
        match self {
            Self::Parameter(parameter) => parameter.value(scene),
            Self::ProfileRadiusUm(row) => match scene.smooth_radii() {
                Some(smooth) => Some(smooth.rows.get(row)?[1]),
                None => Some(scene.measured_rows()?.get(row)?[1]),
            },
            Self::DistanceMm | Self::PushAngleDeg => None,
        }
    }

    /// Returns the variables of detachments of `scene`, `[variable]`: the parameters that it gives, but for the length of a measured profile, then
    /// the distance.
    #[must_use]
    pub fn of_detachments(scene: &Scene) -> Vec<Self> {
        let given = Parameter::ALL.into_iter().filter(|parameter| parameter.has_derivative(scene));
        given.map(Self::Parameter).chain([Self::DistanceMm]).collect()
    }
}

impl fmt::Display for Variable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.name())
    }
}

impl std::str::FromStr for Variable {
    type Err = String;

    /// Reads the name of a parameter, `distance_mm` or `push_angle_deg`.
    fn from_str(name: &str) -> Result<Self, String> {
        let others = [Self::DistanceMm, Self::PushAngleDeg];
        let all = Parameter::ALL.into_iter().map(Self::Parameter);
        let all: Vec<Self> = all.chain(others).collect();
        let found = all.iter().find(|variable| variable.name() == name);
        found.copied().ok_or_else(|| {
            let names: Vec<String> = all.iter().map(|variable| variable.name()).collect();
            let similar = || did_you_mean(name, names.iter().map(String::as_str));
            let hint = Parameter::suggested(name).unwrap_or_else(similar);
            format!("must be one of {}{hint}", names.join(", "))
        })
    }
}
