//! Scenes that have passed every check.

use std::ops::Deref;
use std::path::PathBuf;
use std::sync::Arc;

use super::builder::SceneBuilder;
use super::data::SceneData;
use super::error::{SceneError, SceneFault};
use super::limits::digits;
use super::parameter::Parameter;
use super::profile::IS_MEASURED;
use super::smooth::SmoothRadii;
use super::table::WhiskerRow;
use super::toml::{SceneText, TAPER_KEY};
use crate::traced::TracedShape;

/// A scene that has passed every check. It dereferences to its [`SceneData`], which only a new scene changes.
///
/// ```
/// use whiskmap::scene::{Parameter, Scene};
///
/// let cone = Scene::parse(include_str!("../../scenes/cone.toml"), "cone.toml")?;
/// let thick = cone.with(Parameter::PoleRadiusMm, 0.5)?;
/// assert_eq!((cone.pole.radius_mm, thick.pole.radius_mm), (0.25, 0.5));
/// assert!(cone.with(Parameter::PoleRadiusMm, -1.0).is_err());
/// let few = cone.to_builder().distance_mm([5.0, 10.0]).build()?;
/// assert_eq!(few.grid.distance_mm.len(), 2);
/// # Ok::<(), whiskmap::scene::SceneError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    pub(super) data: SceneData,
    pub(super) builder: Arc<SceneBuilder>,
    pub(super) csv_files: Vec<PathBuf>,
    pub(super) notes: Vec<String>,
}

impl Deref for Scene {
    type Target = SceneData;

    fn deref(&self) -> &SceneData {
        &self.data
    }
}

impl SceneBuilder {
    /// Checks the description and builds the scene.
    ///
    /// # Errors
    /// If a number is missing, out of its range, or contradicts another one. The error names its key in a scene file.
    pub fn build(self) -> Result<Scene, SceneError> {
        let refused = |fault| SceneError::of_fault("", "", fault);
        if let Some(fault) = self.refused {
            return Err(refused(fault));
        }
        let builder = Arc::new(self.with_tip_of_taper().map_err(refused)?);
        let text = SceneText::of_numbers(Arc::clone(&builder));
        let data = builder.checked(text).map_err(refused)?;
        Ok(Scene { data, builder, csv_files: Vec::new(), notes: Vec::new() })
    }
}

impl Scene {
    /// Creates the builder of a scene with this title. Its outputs are called `scene` unless it names them.
    #[must_use]
    pub fn builder(title: impl Into<String>) -> SceneBuilder {
        SceneBuilder { title: title.into(), stem: "scene".to_owned(), ..SceneBuilder::default() }
    }

    /// Returns the builder with the description from which this scene was built.
    #[must_use]
    pub fn to_builder(&self) -> SceneBuilder {
        SceneBuilder::clone(&self.builder)
    }

    /// Returns the measured rows as the scene gives them, `[row][arclength_mm, radius_um]`; `None` without a profile.
    #[must_use]
    pub fn measured_rows(&self) -> Option<&[[f64; 2]]> {
        Some(&self.builder.measured.as_ref()?.rows)
    }

    /// Returns the smoothed radii that replace the measured ones; `None` unless the scene smooths them.
    #[must_use]
    pub fn smooth_radii(&self) -> Option<SmoothRadii> {
        // The rows of a scene have passed the checks.
        self.builder.measured.as_ref()?.smoothed().ok().flatten()
    }

    /// Returns the traced shape at rest with the fit to its points; `None` without points.
    #[must_use]
    pub fn traced(&self) -> Option<&TracedShape> {
        self.builder.traced.as_deref()
    }

    /// Returns the yield strain that the scene gives all whiskers; `None` without one. Rows of a table may have their own.
    #[must_use]
    pub fn given_yield_strain(&self) -> Option<f64> {
        self.builder.yield_strain
    }

    /// Returns the rows of the table of whiskers as they are given, `[row]`; empty without one.
    #[must_use]
    pub fn table_rows(&self) -> &[WhiskerRow] {
        self.builder.table.as_deref().unwrap_or_default()
    }

    /// Returns the column of the table of whiskers that leaves the scene's own number without effect; `None` without one.
    #[cfg(feature = "fit")]
    pub(crate) fn column_of(&self, parameter: Parameter) -> Option<&'static str> {
        self.builder.column_of(parameter)
    }

    /// Returns the paths of the CSV files that the scene names, of radii and of traced points: `[file]`.
    #[must_use]
    pub fn csv_files(&self) -> &[PathBuf] {
        &self.csv_files
    }

    /// Returns the messages that name unused columns of the CSV files: `[file]`.
    #[must_use]
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Returns the scene of whisker `index` of the sweep, in the order of [`SceneData::whiskers`], without sweep axes. Indices are taken
    /// modulo [`SceneData::whisker_count`]. A scene without sweep axes stays as it is.
    ///
    /// # Errors
    /// If the whisker's row in the table of whiskers has no whisker.
    pub fn of_whisker(&self, index: usize) -> Result<Self, SceneError> {
        if !self.is_sweep() {
            return Ok(self.clone());
        }
        let (mut builder, place) = (self.to_builder(), self.grid.place(index));
        if let Some((rows, row)) = builder.table.clone().zip(place.row()) {
            let one = builder.of_row(&rows[row]);
            builder = one.map_err(|fault| SceneError::of_fault("", "", fault))?;
        }
        builder.numbers = builder.numbers.at(&place);
        builder.sweep.clear();
        builder.build()
    }

    /// Returns the scene with another value of a parameter, in the parameter's unit.
    ///
    /// # Errors
    /// If the scene would be refused with it, or a taper is not between 0 and 1.
    pub fn with(&self, parameter: Parameter, value: f64) -> Result<Self, SceneError> {
        self.with_parameters(&[(parameter, value)])
    }

    /// Returns the scene with other values of some parameters, in their units. A taper refers to the new radius at the base.
    ///
    /// # Errors
    /// If the scene would be refused with them, or a taper is not between 0 and 1.
    pub fn with_parameters(&self, values: &[(Parameter, f64)]) -> Result<Self, SceneError> {
        let mut builder = self.to_builder();
        for (parameter, value) in values {
            builder = builder.set(*parameter, *value);
        }
        builder.build()
    }

    /// Returns the scene with at most `lines` push angles and distances, and at most `values` of each sweep axis, from all over the axis; at
    /// least one of each.
    /// The new scene keeps the text of the whole scene.
    #[must_use]
    pub fn thinned(&self, lines: usize, values: usize) -> Self {
        self.thinned_to([lines, lines], values)
    }

    /// Returns the scene with at most these numbers of push angles and distances, and at most `values` of each sweep axis; at least one of
    /// each.
    #[must_use]
    pub fn thinned_to(&self, [push_angles, distances]: [usize; 2], values: usize) -> Self {
        let mut thinned = self.clone();
        let grid = &mut thinned.data.grid;
        thin(&mut grid.push_angle_deg, push_angles);
        thin(&mut grid.distance_mm, distances);
        for axis in &mut grid.sweep {
            thin(&mut axis.values, values);
        }
        thinned
    }
}

/// Keeps the middles of at most `most` equal parts, and at least one value.
fn thin(values: &mut Vec<f64>, most: usize) {
    let (all, kept) = (values.len(), values.len().min(most.max(1)));
    *values = (0..kept).map(|i| values[(2 * i + 1) * all / (2 * kept)]).collect();
}

impl SceneBuilder {
    /// Returns the builder with the radius at the tip in place of a taper.
    pub(super) fn with_tip_of_taper(mut self) -> Result<Self, SceneFault> {
        if let Some(taper) = self.numbers.get(Parameter::Taper) {
            // Next to the ends of this range, the rounding of the tip's radius would hide what lies beyond.
            Parameter::taper_limits(taper).check(Parameter::Taper.name(), taper)?;
            if self.has_bases_of_rows() {
                self.refuse_number(Parameter::Taper, taper)?;
            }
            if self.measured.is_some() {
                let taper = digits(taper);
                return Err(SceneFault::of_value(TAPER_KEY, taper, IS_MEASURED));
            }
            let key = Parameter::BaseRadiusUm.key();
            let absent = || SceneFault::new(key, "is left out, and there is a taper");
            let tip_radius_um = self.numbers.tip_radius_um().ok_or_else(absent)?;
            self.numbers.set(Parameter::TipRadiusUm, tip_radius_um);
        }
        Ok(self)
    }

    /// Returns the given value of a parameter, in its unit, or the value in the first row of the table that has one. `None` if it is not
    /// given. A taper is given with the radius at the tip, whose value this is. In a table, the radius at the tip is given with a taper.
    pub(super) fn given(&self, parameter: Parameter) -> Option<f64> {
        let of_rows = |parameter| {
            let mut rows = self.table.iter().flat_map(|rows| rows.iter());
            rows.find_map(|row| row.number(parameter))
        };
        let number = |parameter| self.numbers.get(parameter).or_else(|| of_rows(parameter));
        match parameter {
            Parameter::Taper => number(parameter).or_else(|| number(Parameter::TipRadiusUm)),
            Parameter::TipRadiusUm => number(parameter).or_else(|| of_rows(Parameter::Taper)),
            _ => number(parameter),
        }
    }
}

impl Parameter {
    /// Returns the value of the parameter in `scene`, in its unit; `None` if the scene does not give it. In a table of whiskers, the first
    /// whisker counts.
    #[must_use]
    pub fn value(self, scene: &Scene) -> Option<f64> {
        let given = scene.builder.given(self)?;
        Some(match self {
            Self::Taper => scene.whisker.taper(),
            Self::TipRadiusUm if !scene.table.is_empty() => scene.whisker.tip_radius_um,
            _ => given,
        })
    }

    /// Returns true if detachments of the scene have derivatives by the parameter: the scene gives it, and it is not the length of measured
    /// radii.
    #[must_use]
    pub fn has_derivative(self, scene: &Scene) -> bool {
        let is_measured = scene.whisker.profile.is_some();
        self.value(scene).is_some() && !(is_measured && self == Self::LengthMm)
    }

    /// Returns the names of the parameters that the scene gives, with commas between them.
    pub(crate) fn given(scene: &Scene) -> String {
        let all = Self::ALL.into_iter();
        let given = all.filter(|parameter| parameter.value(scene).is_some());
        given.map(Self::name).collect::<Vec<_>>().join(", ")
    }

    /// Returns the range `[least, greatest]` of the parameter that the scene accepts, in its unit, with all other numbers fixed.
    ///
    /// Both are NaN if the scene does not give the parameter.
    #[must_use]
    pub fn range(self, scene: &Scene) -> [f64; 2] {
        let Some(number) = self.value(scene) else {
            return [f64::NAN; 2];
        };
        range_around(number, |value| scene.with(self, value).is_ok())
    }
}

/// Returns the range `[least, greatest]` of accepted numbers around `number`, which must be accepted.
pub(crate) fn range_around(number: f64, mut accepts: impl FnMut(f64) -> bool) -> [f64; 2] {
    [f64::MIN, f64::MAX].map(|beyond| {
        let [mut inside, mut outside] = [number, beyond].map(rank);
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

/// Rank of a number among all floating-point numbers. Halving ranks finds the end of a range in 64 steps.
fn rank(value: f64) -> i64 {
    let bits = value.to_bits().cast_signed();
    if bits < 0 { i64::MIN - bits } else { bits }
}

/// The number of a rank.
fn of_rank(rank: i64) -> f64 {
    let bits = if rank < 0 { i64::MIN - rank } else { rank };
    f64::from_bits(bits.cast_unsigned())
}
