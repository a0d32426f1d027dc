//! Tables of whiskers: a row for each whisker, with its name and the numbers in which it differs from the whisker of the scene.

use std::sync::Arc;

use super::error::SceneFault;
use super::parameter::Parameter;
use super::whisker::{Pole, Whisker};
use crate::traced::TracedShape;

/// Row of a table of whiskers: a name, and the numbers that replace the numbers of the scene's whisker.
///
/// ```
/// use whiskmap::scene::{Parameter, Scene, WhiskerRow};
///
/// let cone = Scene::parse(include_str!("../../scenes/cone.toml"), "cone.toml")?;
/// let rows = [("C1", 25.0), ("C2", f64::NAN)];
/// let rows = rows.map(|(name, length_mm)| WhiskerRow::new(name).set(Parameter::LengthMm, length_mm));
/// let table = cone.to_builder().whiskers(rows).build()?;
/// let whiskers: Vec<_> = table.whiskers().collect();
/// assert_eq!(whiskers[0].as_ref().map(|swept| swept.whisker.length_mm), Ok(25.0));
/// let refused = whiskers[1].as_ref().unwrap_err();
/// assert_eq!((&*refused.name, &*refused.reason), ("C2", "length_mm is missing"));
/// # Ok::<(), whiskmap::scene::SceneError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WhiskerRow {
    pub(super) name: String,
    /// Numbers of the whisker, `[column]`; NaN is a missing one.
    pub(super) numbers: Vec<(Parameter, f64)>,
    /// Measured rows, `[row][arclength_mm, radius_um]`.
    pub(super) profile: Option<Vec<[f64; 2]>>,
    pub(super) rest: Option<RestShape>,
    /// Yield strain of the whisker; NaN if it is not known, `None` without a column.
    pub(super) yield_strain: Option<f64>,
}

/// Traced points in millimetres, `[point][x, y]`, with the shape through them, or the reason why there is none.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct RestShape {
    pub points_mm: Vec<[f64; 2]>,
    pub shape: Result<Arc<TracedShape>, SceneFault>,
}

impl WhiskerRow {
    /// Creates the row of the whisker `name`.
    #[must_use]
    pub fn new(name: impl Into<String>) -> Self {
        Self { name: name.into(), ..Self::default() }
    }

    /// Sets a number of the whisker, in the unit of the parameter. A row with a missing number, NaN, has no whisker.
    #[must_use]
    pub fn set(mut self, parameter: Parameter, value: f64) -> Self {
        self.numbers.push((parameter, value));
        self
    }

    /// Sets the largest bending strain that the whisker bears elastically, dimensionless; NaN for a whisker without marks. A row without this
    /// number has the yield strain of the scene.
    #[must_use]
    pub fn yield_strain(mut self, strain: f64) -> Self {
        self.yield_strain = Some(strain);
        self
    }

    /// Sets measured radii of the whisker: arclength in millimetres and radius in micrometres, `[row][arclength, radius]`.
    #[must_use]
    pub fn profile(mut self, rows: impl Into<Vec<[f64; 2]>>) -> Self {
        self.profile = Some(rows.into());
        self
    }

    /// Sets traced points of the whisker at rest in millimetres, `[point][x, y]`, to which a shape is fitted.
    #[must_use]
    pub fn rest_points(mut self, points_mm: impl Into<Vec<[f64; 2]>>) -> Self {
        let points_mm = points_mm.into();
        let shape = TracedShape::fit(points_mm.clone(), None);
        self.rest = Some(RestShape {
            points_mm,
            shape: shape.map(Arc::new).map_err(SceneFault::of_traced),
        });
        self
    }

    /// Returns the name of the whisker.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the numbers of the whisker, `[column]`, each in the unit of its parameter; NaN is a missing one.
    #[must_use]
    pub fn numbers(&self) -> &[(Parameter, f64)] {
        &self.numbers
    }

    /// Returns the yield strain of the whisker; NaN if it is not known, `None` if the row does not give it.
    #[must_use]
    pub const fn given_yield_strain(&self) -> Option<f64> {
        self.yield_strain
    }

    /// Returns the measured radii of the whisker, `[row][arclength_mm, radius_um]`; `None` without them.
    #[must_use]
    pub fn measured_rows(&self) -> Option<&[[f64; 2]]> {
        self.profile.as_deref()
    }

    /// Returns the traced points of the whisker at rest in millimetres, `[point][x, y]`; `None` without them.
    #[must_use]
    pub fn points_mm(&self) -> Option<&[[f64; 2]]> {
        self.rest.as_ref().map(|rest| &*rest.points_mm)
    }

    /// Returns the number of the whisker, in the unit of the parameter; `None` if the row does not give it.
    pub(super) fn number(&self, parameter: Parameter) -> Option<f64> {
        let mut numbers = self.numbers.iter();
        let found = numbers.find(|(given, value)| *given == parameter && !value.is_nan());
        found.map(|(_, value)| *value)
    }

    /// Returns true if another column of the row gives what `parameter` would.
    pub(super) fn replaces(&self, parameter: Parameter) -> bool {
        let has_length = parameter == Parameter::LengthMm && self.rest.is_some();
        let mut substitutes = parameter.substitutes().iter();
        has_length || substitutes.any(|part| self.gives(*part))
    }
}

/// Whisker of a table, in front of its pole.
#[derive(Clone, Debug, PartialEq)]
pub struct TableWhisker {
    /// Name of the whisker.
    pub name: String,
    /// Whisker and pole of the row, the first ones of its sweep; otherwise the reason why the row has no whisker.
    pub found: Result<(Whisker, Pole), String>,
}
