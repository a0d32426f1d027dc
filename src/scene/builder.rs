//! Numbers of a scene before they are checked.

use super::axis::AxisValues;
use super::error::SceneFault;
use super::grid::{Coordinate, SweepPlace};
use super::parameter::Parameter;
use super::smooth::MeasuredRadii;
use super::surface::Surface;
use super::table::WhiskerRow;
use crate::traced::TracedShape;
use std::sync::Arc;

/// Standard deviations of the numbers of a scene. The numbers vary independently of each other.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Deviations {
    /// Parameters that the scene gives, `[parameter]`, each with its standard deviation in the parameter's unit.
    pub parameters: Vec<(Parameter, f64)>,
    /// Standard deviation of the radius of every row of `whisker.profile`, in micrometres; `None` without a profile.
    pub profile_radius_um: Option<f64>,
    /// Standard deviations of what a frame of a film measures.
    pub frames: FrameDeviations,
}

/// Standard deviations of what a frame of a film measures. `None` for what is exact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrameDeviations {
    /// Standard deviation of the curvature, in 1/mm.
    pub curvature_per_mm: Option<f64>,
    /// Standard deviation of each coordinate of the contact, in mm.
    pub contact_mm: Option<f64>,
    /// Standard deviation of the angle of the tangent at the contact, in degrees.
    pub angle_deg: Option<f64>,
}

impl FrameDeviations {
    /// Names of the standard deviations in the table `[uncertainty]`, in the order of [`FrameDeviations::values`].
    pub const NAMES: [&str; 3] = ["curvature_sd_per_mm", "contact_sd_mm", "angle_sd_deg"];

    /// Returns the standard deviations by the names of [`FrameDeviations::NAMES`].
    #[must_use]
    pub const fn values(&self) -> [Option<f64>; 3] {
        [self.curvature_per_mm, self.contact_mm, self.angle_deg]
    }

    /// Sets the standard deviation of this name. Returns false for another name.
    pub fn set(&mut self, name: &str, deviation: f64) -> bool {
        let values = [&mut self.curvature_per_mm, &mut self.contact_mm, &mut self.angle_deg];
        let named = Self::NAMES.into_iter().zip(values);
        let mut found = named.filter(|(known, _)| *known == name);
        found.next().is_some_and(|(_, value)| {
            *value = Some(deviation);
            true
        })
    }
}

/// Given numbers of a scene, by parameter: `[parameter]`, each in its unit; `None` for a number that is not given.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Numbers([Option<f64>; Parameter::ALL.len()]);

impl Numbers {
    pub fn get(&self, parameter: Parameter) -> Option<f64> {
        self.0[parameter as usize]
    }

    /// Sets a number of the scene, in its unit. A taper replaces the radius at the tip, and the reverse.
    pub fn set(&mut self, parameter: Parameter, value: f64) {
        match parameter {
            Parameter::Taper => self.0[Parameter::TipRadiusUm as usize] = None,
            Parameter::TipRadiusUm => self.0[Parameter::Taper as usize] = None,
            _ => {}
        }
        self.0[parameter as usize] = Some(value);
    }

    /// Removes a number of the scene.
    pub fn clear(&mut self, parameter: Parameter) {
        self.0[parameter as usize] = None;
    }

    /// Returns the numbers of the whisker at a place of the sweep.
    pub fn at(mut self, place: &SweepPlace) -> Self {
        for (parameter, value) in place.values() {
            self.set(parameter, value);
        }
        self
    }

    /// Returns the radius at the tip, in micrometres, as given or from a taper; `None` if neither is given.
    pub fn tip_radius_um(&self) -> Option<f64> {
        let base = self.get(Parameter::BaseRadiusUm);
        let tapered =
            base.zip(self.get(Parameter::Taper)).map(|(base, taper)| base * (1.0 - taper));
        tapered.or(self.get(Parameter::TipRadiusUm))
    }
}

/// Builder of a scene: its description before the checks.
///
/// Required are the length, Young's modulus, the radii at base and tip (or [`SceneBuilder::profile`]), push angles and distances.
/// A curvature, a pole radius and a friction that are left out are 0; a modulus ratio and an arc stretch are 1.
///
/// ```
/// use whiskmap::scene::{AxisValues, Parameter, Scene};
///
/// let scene = Scene::builder("A cone in front of a thin pole")
///     .set(Parameter::LengthMm, 20.0)
///     .set(Parameter::BaseRadiusUm, 30.0)
///     .set(Parameter::Taper, 0.95)
///     .set(Parameter::YoungsModulusGpa, 3.0)
///     .set(Parameter::PoleRadiusMm, 0.25)
///     .push_angle_deg(AxisValues::linear(-70.0, 70.0, 512))
///     .distance_mm([10.0, 12.5, 15.0])
///     .sweep(Parameter::ParabolaPerMm, [0.0, 0.02])
///     .build()?;
/// assert_eq!(scene.whisker_count(), 2);
/// let why = scene.to_builder().set(Parameter::LengthMm, -1.0).build().unwrap_err();
/// assert!(why.to_string().contains("whisker.length_mm = -1: must be between 0.001 and 100000"));
/// # Ok::<(), whiskmap::scene::SceneError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SceneBuilder {
    pub(super) title: String,
    pub(super) numbers: Numbers,
    /// Measured rows; `None` without a profile.
    pub(super) measured: Option<MeasuredRadii>,
    /// Shape at rest through traced points; `None` without them.
    pub(super) traced: Option<Arc<TracedShape>>,
    /// True if the length is the length of the curve through the traced points, because no length was set before them.
    pub(super) is_length_traced: bool,
    /// Table of whiskers, the first sweep axis; `None` without one.
    pub(super) table: Option<Arc<[WhiskerRow]>>,
    /// Fault of the first number that was set although a column of the table gives it; `None` without one.
    pub(super) refused: Option<SceneFault>,
    pub(super) push_angle_deg: AxisValues,
    pub(super) distance_mm: AxisValues,
    pub(super) sweep: Vec<(Parameter, AxisValues)>,
    pub(super) uncertainty: Option<Deviations>,
    pub(super) surface: Option<Surface>,
    /// Largest bending strain that the whiskers bear elastically; `None` if it is not known.
    pub(super) yield_strain: Option<f64>,
    /// Stem of the names of the output files; `None` if the scene does not give it.
    pub(super) name: Option<String>,
    /// Stem of the names of the output files if the scene does not give one.
    pub(super) stem: String,
}

impl SceneBuilder {
    /// Sets the title of the scene: one line of text.
    #[must_use]
    pub fn title(mut self, title: impl Into<String>) -> Self {
        self.title = title.into();
        self
    }

    /// Sets a number of the scene, in the unit of the parameter. A number that a column of the table of whiskers gives is refused when the
    /// scene is built, because it would have no effect.
    #[must_use]
    pub fn set(mut self, parameter: Parameter, value: f64) -> Self {
        let refused = self.refuse_number(parameter, value).err();
        self.refused = self.refused.or(refused);
        self.numbers.set(parameter, value);
        self
    }

    /// Returns a given number of the scene, in the unit of the parameter; `None` if it is not given, or by a table of whiskers alone.
    #[must_use]
    pub fn number(&self, parameter: Parameter) -> Option<f64> {
        self.numbers.get(parameter)
    }

    /// Sets measured radii instead of those at base and tip: arclength in millimetres and radius in micrometres, `[row][arclength,
    /// radius]`. The rows of a scene that smooths its rows are smoothed, too.
    #[must_use]
    pub fn profile(mut self, rows: impl Into<Vec<[f64; 2]>>) -> Self {
        let smooth = self.measured.is_some_and(|radii| radii.smooth);
        let rows = rows.into();
        self.measured = Some(MeasuredRadii { rows, smooth });
        self
    }

    /// Sets whether a polynomial through the measured rows replaces their radii, see [`SmoothRadii`](super::SmoothRadii). Without rows, it
    /// does nothing.
    #[must_use]
    pub fn smooth_profile(mut self, smooth: bool) -> Self {
        if let Some(radii) = &mut self.measured {
            radii.smooth = smooth;
        }
        self
    }

    /// Sets a traced shape at rest instead of a parabola or a spiral. If no length is set, the whisker has the length of the curve, which
    /// must then be between 1 and 200 mm; otherwise it has the shape at its own scale.
    #[must_use]
    pub fn traced(self, shape: TracedShape) -> Self {
        self.with_traced(Arc::new(shape))
    }

    /// Sets a traced shape as [`SceneBuilder::traced`] does.
    pub(super) fn with_traced(mut self, shape: Arc<TracedShape>) -> Self {
        self.is_length_traced = self.numbers.get(Parameter::LengthMm).is_none();
        if self.is_length_traced {
            self.numbers.set(Parameter::LengthMm, shape.length_mm);
        }
        self.traced = Some(shape);
        self
    }

    /// Sets the push angles of the scene's grid, in degrees: negative CF, positive CB.
    #[must_use]
    pub fn push_angle_deg(mut self, values: impl Into<AxisValues>) -> Self {
        self.push_angle_deg = values.into();
        self
    }

    /// Sets the distances from the base to the contact at first touch, in millimetres.
    #[must_use]
    pub fn distance_mm(mut self, values: impl Into<AxisValues>) -> Self {
        self.distance_mm = values.into();
        self
    }

    /// Sets the sweep axis along which whiskers differ in `parameter`, one of [`Parameter::SWEPT`]; a new axis is the last one.
    #[must_use]
    pub fn sweep(mut self, parameter: Parameter, values: impl Into<AxisValues>) -> Self {
        let values = values.into();
        match self.sweep.iter_mut().find(|(swept, _)| *swept == parameter) {
            Some((_, axis)) => *axis = values,
            None => self.sweep.push((parameter, values)),
        }
        self
    }

    /// Sets the only value of the axis of this name: of push angles, of distances, of a sweep, or the name of a whisker of the table. Other
    /// axes and names change nothing.
    #[must_use]
    pub fn fixed(mut self, axis: &str, value: &Coordinate) -> Self {
        let mut swept = Parameter::SWEPT.into_iter();
        match (value, axis) {
            (Coordinate::Name(name), _) => {
                let rows = self.table.iter().flat_map(|rows| rows.iter());
                let named: Vec<WhiskerRow> =
                    rows.filter(|row| row.name == *name).cloned().collect();
                self.table = self.table.map(|_| named.into());
                self
            }
            (Coordinate::Number(value), "push_angle_deg") => self.push_angle_deg([*value]),
            (Coordinate::Number(value), "distance_mm") => self.distance_mm([*value]),
            (Coordinate::Number(value), _) => {
                match swept.find(|parameter| parameter.axis() == axis) {
                    Some(parameter) => self.sweep(parameter, [*value]),
                    None => self,
                }
            }
        }
    }

    /// Returns the name and the values of each axis as they are given: push angles, distances, and the sweep in order.
    pub fn axes(&self) -> impl Iterator<Item = (&'static str, &AxisValues)> {
        let inside = [("push_angle_deg", &self.push_angle_deg), ("distance_mm", &self.distance_mm)];
        let sweep = self.sweep.iter();
        let sweep = sweep.map(|(parameter, values)| (parameter.axis(), values));
        inside.into_iter().chain(sweep)
    }

    /// Returns true if the scene has a sweep axis along which whiskers differ in `parameter`.
    pub(super) fn sweeps(&self, parameter: Parameter) -> bool {
        self.sweep.iter().any(|(swept, _)| *swept == parameter)
    }

    /// Sets the standard deviations of the numbers of the scene.
    #[must_use]
    pub fn uncertainty(mut self, deviations: Deviations) -> Self {
        self.uncertainty = Some(deviations);
        self
    }

    /// Sets the rough surface, over which the whisker sweeps.
    #[must_use]
    pub const fn surface(mut self, surface: Surface) -> Self {
        self.surface = Some(surface);
        self
    }

    /// Sets the largest bending strain at the surface that the whiskers bear elastically: more than 0 and at most 1. States beyond it are
    /// marked, and not changed. `None` marks none. A yield strain beside a table with a column `yield_strain` is refused when the scene is built.
    #[must_use]
    pub fn yield_strain(mut self, strain: impl Into<Option<f64>>) -> Self {
        let refused = self.refuse_yield_strain().err();
        self.refused = self.refused.or(refused);
        self.yield_strain = strain.into();
        self
    }

    /// Sets the stem of the output files; `scene` by default.
    #[must_use]
    pub fn name(mut self, name: impl Into<String>) -> Self {
        self.name = Some(name.into());
        self
    }
}
