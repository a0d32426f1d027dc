//! Scenes with other values of their parameters, and the values that they accept.

use super::checked::Scene;
use super::error::SceneError;
use super::limits::digits;
use super::parameter::Parameter;

impl Parameter {
    /// Its value, if the text of the scene gives it.
    #[must_use]
    pub fn value(self, scene: &Scene) -> Option<f64> {
        let given = self.number_in(&toml::from_str(&scene.text).ok()?)?;
        Some(match self {
            Self::Taper => scene.whisker.taper(),
            _ => given,
        })
    }

    /// The names of those that the scene gives, with commas between them.
    pub(crate) fn given(scene: &Scene) -> String {
        let all = Self::ALL.into_iter();
        let given = all.filter(|own| own.value(scene).is_some());
        given.map(Self::name).collect::<Vec<_>>().join(", ")
    }

    /// The least and the greatest value that the scene accepts around its own, everything else as it is.
    ///
    /// Without a value of its own the scene accepts none: the range is empty, of two NaN.
    #[must_use]
    pub fn range(self, scene: &Scene) -> [f64; 2] {
        let Some(own) = self.value(scene) else {
            return [f64::NAN; 2];
        };
        let accepts = |value: f64| scene.with_parameters(&[(self, value)]).is_ok();
        [f64::MIN, f64::MAX].map(|beyond| {
            let [mut inside, mut outside] = [own, beyond].map(rank);
            while inside.abs_diff(outside) > 1 {
                let middle = inside.midpoint(outside);
                if accepts(of_rank(middle)) {
                    inside = middle;
                } else {
                    outside = middle;
                }
            }
            of_rank(inside)
        })
    }
}

impl Scene {
    /// The same scene with other values of some parameters, as if its file had said so.
    ///
    /// # Errors
    ///
    /// If the scene would be refused with them, or a taper is not between 0 and 1.
    pub fn with_parameters(&self, values: &[(Parameter, f64)]) -> Result<Self, SceneError> {
        // Next to the ends of this range, the rounding of the tip's radius would hide what lies beyond.
        let is_taper = |(parameter, value): &(Parameter, f64)| {
            *parameter != Parameter::Taper || (0.0..=1.0).contains(value)
        };
        if let Some((_, value)) = values.iter().find(|own| !is_taper(own)) {
            let must = format!("{} is not between 0 and 1", digits(*value));
            return Err(SceneError::whole(Parameter::Taper.name(), must));
        }
        let base = values.iter().rev();
        let base = base
            .copied()
            .find(|(parameter, _)| *parameter == Parameter::BaseRadiusUm);
        let base = base.map_or(self.whisker.base_radius_um, |(_, base)| base);
        self.with_each(values.iter().map(|(parameter, value)| {
            let value = match parameter {
                Parameter::Taper => base * (1.0 - value),
                _ => *value,
            };
            (parameter.key(), value)
        }))
    }
}

/// The place of a number among all floating-point numbers, so that halves of a range are found in 64 steps.
fn rank(value: f64) -> i64 {
    let bits = value.to_bits().cast_signed();
    if bits < 0 { i64::MIN - bits } else { bits }
}

/// The number of that place.
fn of_rank(rank: i64) -> f64 {
    let bits = if rank < 0 { i64::MIN - rank } else { rank };
    f64::from_bits(bits.cast_unsigned())
}
