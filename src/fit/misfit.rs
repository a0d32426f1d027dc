//! Residuals of points, as a function of the free parameters of a scene.

use crate::measured::MeasuredPoints;
use crate::scene::{Parameter, Scene, SceneError, SweptWhisker, Whisker};
use rayon::prelude::*;

/// Step of central differences, in units of the parameters. Truncation and the rounding of curves then take at most
/// 5e-9 of a cone's derivatives, by each of its parameters; with ten times the step, 5e-7.
const STEP: f64 = 1e-5;

/// Misfit of points: their residuals as a function of parameters. Parameters are in units of [`Misfit::units`], so that all are of order
/// 1.
pub(super) struct Misfit<'a> {
    scene: &'a Scene,
    pub points: &'a MeasuredPoints,
    free: &'a [Parameter],
    /// Unit of each free parameter, `[parameter]`: a power of 2 near its natural size, so that nothing is rounded by it. Parameters in
    /// this module are divided by their units.
    pub units: Vec<f64>,
}

impl<'a> Misfit<'a> {
    pub fn new(scene: &'a Scene, points: &'a MeasuredPoints, free: &'a [Parameter]) -> Self {
        let first = scene.first_whisker();
        let units = free.iter().map(|own| size(*own, &first.whisker));
        Self {
            scene,
            points,
            free,
            units: units
                .map(|size| libm::exp2(libm::log2(size).round()))
                .collect(),
        }
    }

    /// Returns the scene's values of the free parameters, each over its unit: `[parameter]`. The scene must give them all.
    pub fn start(&self) -> Vec<f64> {
        let values = self.free.iter().zip(&self.units);
        values
            .filter_map(|(own, unit)| Some(own.value(self.scene)? / unit))
            .collect()
    }

    /// Returns the least and the greatest value of each parameter that `scene` accepts, over its unit, with the other parameters fixed:
    /// `[parameter][end]`.
    pub fn ranges(&self, scene: &Scene) -> Vec<[f64; 2]> {
        let free = self.free.par_iter().zip(&self.units);
        free.map(|(own, unit)| own.range(scene).map(|end| end / unit))
            .collect()
    }

    /// Returns the scene with these values of the free parameters, each over its unit.
    pub fn scene(&self, parameters: &[f64]) -> Result<Scene, SceneError> {
        let values = self.free.iter().zip(&self.units).zip(parameters);
        let values: Vec<_> = values.map(|((own, unit), x)| (*own, unit * x)).collect();
        self.scene.with_parameters(&values)
    }

    /// Returns predicted less measured angles over their standard deviations, dimensionless: `[point]`. `None` where the scene refuses
    /// the parameters, or a point is out of reach or never detaches.
    pub fn residuals(&self, parameters: &[f64]) -> Option<Vec<f64>> {
        let scene = self.scene(parameters).ok()?;
        let SweptWhisker { whisker, pole, .. } = scene.first_whisker();
        self.points.check_reach(&whisker, &pole).ok()?;
        let rows = self.points.beside(&whisker, &pole).rows;
        let mut residuals = Vec::with_capacity(rows.len());
        for (row, point) in rows.iter().zip(&self.points.points) {
            residuals.push(-row.residual_deg? / point.sd_deg);
        }
        Some(residuals)
    }

    /// Returns true if a point detaches in another way than was measured.
    pub fn has_other_kinds(&self, parameters: &[f64]) -> bool {
        self.scene(parameters).is_ok_and(|scene| {
            let SweptWhisker { whisker, pole, .. } = scene.first_whisker();
            self.points.beside(&whisker, &pole).of_another_kind() > 0
        })
    }

    /// Returns the derivatives of the residuals by the parameters over their units, `[parameter][point]`; `None` where neither side has
    /// one. `here` are the residuals at `parameters`.
    pub fn jacobian(&self, parameters: &[f64], here: &[f64]) -> Option<Vec<Vec<f64>>> {
        let columns = (0..self.free.len()).into_par_iter().map(|i| {
            let beside = |step: f64| {
                let mut beside = parameters.to_vec();
                beside[i] += step;
                self.residuals(&beside)
            };
            let central = || {
                let (after, before) = (beside(STEP)?, beside(-STEP)?);
                let pairs = after.iter().zip(before);
                Some(
                    pairs
                        .map(|(after, before)| (after - before) / (2.0 * STEP))
                        .collect(),
                )
            };
            let one_sided = |step: f64| {
                let (near, far) = (beside(step)?, beside(2.0 * step)?);
                let pairs = near.iter().zip(far).zip(here);
                let slope = |((near, far), here)| (4.0 * near - far - 3.0 * here) / (2.0 * step);
                Some(pairs.map(slope).collect())
            };
            central()
                .or_else(|| one_sided(STEP))
                .or_else(|| one_sided(-STEP))
        });
        columns.collect()
    }
}

/// The change of a parameter that changes a whisker or its contact altogether.
fn size(parameter: Parameter, whisker: &Whisker) -> f64 {
    let length = whisker.length_mm;
    match parameter {
        Parameter::LengthMm
        | Parameter::TipExtensionMm
        | Parameter::VertexMm
        | Parameter::PoleRadiusMm => length,
        Parameter::BaseRadiusUm | Parameter::TipRadiusUm => whisker.base_radius_um,
        Parameter::YoungsModulusGpa => whisker.youngs_modulus_gpa,
        Parameter::ParabolaPerMm | Parameter::SpiralPerMm => 1.0 / length,
        Parameter::SpiralPerMm2 => 1.0 / (length * length),
        Parameter::Taper
        | Parameter::ProfileScale
        | Parameter::ModulusTipToBase
        | Parameter::ArcStretch
        | Parameter::Friction => 1.0,
    }
}
