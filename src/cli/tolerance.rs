//! `--tolerance`: how exact is exact enough.

use super::failure::{Failure, say};
use super::numbers;
use clap::Args;
use whiskmap::accuracy::{Accuracy, BOUNDED, cheapest};
use whiskmap::rod::Side;
use whiskmap::scene::Scene;

/// The option.
#[derive(Debug, Args)]
pub struct Tolerance {
    /// Largest error of push angles, such as 1e-6deg; takes the cheapest steps that the program's own estimate allows
    /// [default: the finest steps, without an estimate]
    ///
    /// It bounds where states stand in front of their pole (the push angle, and the distance, of which a part counts as
    /// that many radians) and where they detach. It does not bound contact angles, arclengths, forces and moments: next
    /// to a fold they change with the square root of the push angle that is left.
    #[arg(long, value_name = "ANGLE", value_parser = degrees)]
    tolerance: Option<f64>,
}

/// Below, rounding is all that is left; above, a map says nothing.
const RANGE: std::ops::RangeInclusive<f64> = 1e-10..=1.0;

/// Makes two digits no less than the number.
const ROUNDED_UP: f64 = 1.06;

fn degrees(text: &str) -> Result<f64, String> {
    match numbers::angle(text)? {
        degrees if RANGE.contains(&degrees) => Ok(degrees),
        _ => Err("must be between 1e-10deg and 1deg".to_owned()),
    }
}

impl Tolerance {
    /// The largest error, if one was given.
    pub const fn degrees(&self) -> Option<f64> {
        self.tolerance
    }

    /// What is enough for `sides` of the scene, if that was asked; said on standard error.
    pub fn choose(&self, scene: &Scene, sides: &[Side]) -> Result<Option<Accuracy>, Failure> {
        let Some(tolerance_deg) = self.tolerance else {
            return Ok(None);
        };
        let found = cheapest(scene, sides, tolerance_deg).map_err(|finest| {
            Failure::Input(format!(
                "--tolerance {tolerance_deg:e}deg: must be at least {:.1e}deg, which the finest steps and the residual of \
                 Newton's method leave by the program's own estimate",
                ROUNDED_UP * finest.error_deg
            ))
        })?;
        say(&format!(
            "accuracy: {} steps of order 8 at the fold, fewer below; estimated error {:.1e} deg of {tolerance_deg:.1e} allowed \
             in {BOUNDED}",
            found.resolution.least, found.error_deg
        ));
        Ok(Some(found))
    }
}
