//! Option `--tolerance`: the maximum push-angle error.

use super::arguments;
use super::failure::{Failure, message};
use clap::Args;
use whiskmap::Side;
use whiskmap::accuracy::{Accuracy, BOUNDED, TOLERANCE_DEG};
use whiskmap::compute::{self, Error};
use whiskmap::scene::{Scene, digits};

#[derive(Debug, Default, Args)]
pub struct ToleranceArgs {
    /// Maximum push-angle error, such as 1e-6deg; selects the cheapest steps or expansions that meet it
    /// [default: the finest steps, without an estimate]
    ///
    /// The tolerance bounds the push angle of states and detachments, and the relative error of the distance, in radians. It
    /// does not bound contact angles, arclengths, forces and moments: next to a fold, they change with the square root of the
    /// remaining push angle.
    #[arg(long, value_name = "ANGLE", value_parser = degrees)]
    tolerance: Option<f64>,
}

/// Factor after which a number, rounded to two digits, is not below its former value.
const ROUNDED_UP: f64 = 1.06;

fn degrees(text: &str) -> Result<f64, String> {
    match arguments::angle(text)? {
        degrees if TOLERANCE_DEG.contains(&degrees) => Ok(degrees),
        _ => {
            let [least, most] =
                [TOLERANCE_DEG.start(), TOLERANCE_DEG.end()].map(|end| digits(*end));
            Err(format!("must be between {least}deg and {most}deg"))
        }
    }
}

impl ToleranceArgs {
    pub const fn degrees(&self) -> Option<f64> {
        self.tolerance
    }

    /// Returns the accuracy that meets the tolerance on `sides` of the scene; `None` without a tolerance.
    pub fn find(&self, scene: &Scene, sides: &[Side]) -> Result<Option<Accuracy>, Failure> {
        Ok(compute::accuracy(scene, self.tolerance, sides)?)
    }

    /// Prints the accuracy that was found.
    pub fn report(&self, found: Option<Accuracy>) {
        if let Some((tolerance_deg, found)) = self.tolerance.zip(found) {
            message(&format!(
                "accuracy: {} steps of order 8 at the fold, fewer below; estimated error {:.1e} deg of {tolerance_deg:.1e} \
                 allowed in {BOUNDED}",
                found.resolution.least, found.error_deg
            ));
        }
    }
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        match error {
            Error::Plan(error) => error.into(),
            Error::Engine(error) => error.into(),
            Error::Tolerance { tolerance_deg, least } => Self::Input(format!(
                "--tolerance {tolerance_deg:e}deg: must be at least {:.1e}deg, the estimated error of the finest steps and \
                 of the residual of Newton's method",
                ROUNDED_UP * least
            )),
            error => Self::Input(error.to_string()),
        }
    }
}
