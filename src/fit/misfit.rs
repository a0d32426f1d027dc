//! Residuals of points, as a function of the free parameters of a scene.

use super::FitLoss;
use crate::least_squares::{BoundedProblem, differences};
use crate::measured::MeasuredPoints;
use crate::scene::{Parameter, Scene, SceneError};
use crate::sensitivity::Variable;
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};

/// Step of differences, in units of the parameters. Truncation and the rounding of curves take at most 5e-9 of a cone's central ones.
const STEP: f64 = 1e-5;

/// Misfit of points: their residuals as a function of parameters. Parameters are in units of [`Misfit::units`], so that all are of order
/// 1.
pub(super) struct Misfit<'a> {
    scene: &'a Scene,
    pub points: &'a MeasuredPoints,
    free: &'a [Parameter],
    /// Loss of residuals.
    loss: FitLoss,
    /// Unit of each free parameter, `[parameter]`: a power of 2 near its natural size, so that nothing is rounded by it. Parameters in
    /// this module are divided by their units.
    pub units: Vec<f64>,
    cancel: &'a AtomicBool,
}

impl<'a> Misfit<'a> {
    /// Creates the misfit. If `cancel` is true, it has neither residuals nor derivatives.
    pub fn new(
        scene: &'a Scene,
        points: &'a MeasuredPoints,
        free: &'a [Parameter],
        loss: FitLoss,
        cancel: &'a AtomicBool,
    ) -> Self {
        let first = scene.first_whisker();
        let units = free.iter().map(|parameter| parameter.size(&first.whisker));
        Self {
            scene,
            points,
            free,
            loss,
            units: units.map(|size| libm::exp2(libm::log2(size).round())).collect(),
            cancel,
        }
    }

    /// Returns true if the fit is cancelled.
    pub fn is_cancelled(&self) -> bool {
        self.cancel.load(Ordering::Relaxed)
    }

    /// Returns the scene's values of the free parameters, each divided by its unit in [`Misfit::units`]: `[parameter]`. The scene must give them all.
    pub fn start(&self) -> Vec<f64> {
        let values = self.free.iter().zip(&self.units);
        values.filter_map(|(parameter, unit)| Some(parameter.value(self.scene)? / unit)).collect()
    }

    /// Returns the range that `scene` accepts for each free parameter with all others fixed, divided by its unit in [`Misfit::units`]:
    /// `[parameter][least, greatest]`.
    pub fn ranges(&self, scene: &Scene) -> Vec<[f64; 2]> {
        let free = self.free.par_iter().zip(&self.units);
        free.map(|(parameter, unit)| parameter.range(scene).map(|end| end / unit)).collect()
    }

    /// Returns the scene with these values of the free parameters, `[parameter]`, each divided by its unit in [`Misfit::units`].
    pub fn scene(&self, parameters: &[f64]) -> Result<Scene, SceneError> {
        let values = self.free.iter().zip(&self.units).zip(parameters);
        let values: Vec<_> = values.map(|((parameter, unit), x)| (*parameter, unit * x)).collect();
        self.scene.with_parameters(&values)
    }

    /// Returns the scene with these `parameters`; `None` where it is refused, and after a cancellation.
    fn accepted(&self, parameters: &[f64]) -> Option<Scene> {
        let scene = (!self.is_cancelled()).then(|| self.scene(parameters).ok());
        scene.flatten()
    }

    /// Returns predicted less measured angles over their standard deviations, dimensionless: `[point]`. `None` where the scene refuses
    /// the parameters, or a point is out of reach or never detaches.
    pub fn residuals_at(&self, parameters: &[f64]) -> Option<Vec<f64>> {
        let scene = self.accepted(parameters)?;
        let whiskers = self.points.whiskers_in(&scene).ok()?;
        self.points.check_reach_of(&whiskers).ok()?;
        let rows = self.points.compared_with(&whiskers);
        let mut residuals = Vec::with_capacity(rows.len());
        for (row, point) in rows.iter().zip(&self.points.points) {
            residuals.push(-row.residual_deg? / point.sd_deg);
        }
        Some(residuals)
    }

    /// Returns true if a point detaches in another way with these `parameters` than was measured.
    pub fn has_other_kinds(&self, parameters: &[f64]) -> bool {
        let scene = self.scene(parameters).ok();
        let whiskers = scene.and_then(|scene| self.points.whiskers_in(&scene).ok());
        whiskers.is_some_and(|whiskers| self.points.beside_all(&whiskers).of_another_kind() > 0)
    }

    /// Returns the derivative of each point's residual by each scaled parameter, `[parameter][point]`. All are exact, or all are differences
    /// if a point has no exact one, as at first touch. `None` where the scene refuses the parameters on both sides.
    pub fn jacobian(&self, parameters: &[f64]) -> Option<Vec<Vec<f64>>> {
        self.derivatives(parameters)
            .or_else(|| differences(|x| self.residuals_at(x), parameters, STEP))
    }

    /// Returns the exact columns of the Jacobian; `None` where the scene refuses the parameters, or an end has no derivative.
    fn derivatives(&self, parameters: &[f64]) -> Option<Vec<Vec<f64>>> {
        let whiskers = self.points.whiskers_in(&*self.accepted(parameters)?).ok()?;
        let free = self.free.iter().map(|parameter| Variable::from(*parameter));
        let mut variables: Vec<Variable> = free.collect();
        // With a free taper, the radius at the tip follows the radius at the base.
        let tip_by_base = 1.0 - whiskers[0].whisker.taper();
        let has_taper = self.free.contains(&Parameter::Taper) && tip_by_base > 0.0;
        let base = self.free.iter().position(|free| *free == Parameter::BaseRadiusUm);
        let base = base.filter(|_| has_taper);
        variables.extend(base.map(|_| Variable::from(Parameter::TipRadiusUm)));
        let mut columns = self.points.derivatives_with(&whiskers, &variables)?;
        if let Some(base) = base
            && let Some(by_tip) = columns.pop()
        {
            let both = columns[base].iter_mut().zip(by_tip);
            both.for_each(|(by_base, by_tip)| *by_base += tip_by_base * by_tip);
        }
        for (column, unit) in columns.iter_mut().zip(&self.units) {
            for (derivative, point) in column.iter_mut().zip(&self.points.points) {
                *derivative *= unit / point.sd_deg;
            }
        }
        Some(columns)
    }
}

/// The residuals of the problem are the signed roots of the losses.
impl BoundedProblem for Misfit<'_> {
    fn count(&self) -> usize {
        self.points.points.len()
    }

    fn residuals(&self, x: &[f64]) -> Option<Vec<f64>> {
        let mut roots = self.residuals_at(x)?;
        roots.iter_mut().for_each(|r| *r = self.loss.root(*r));
        Some(roots)
    }

    fn jacobian(&self, x: &[f64], roots: &[f64]) -> Option<Vec<Vec<f64>>> {
        let mut columns = Misfit::jacobian(self, x)?;
        for column in &mut columns {
            let slopes = column.iter_mut().zip(roots);
            slopes.for_each(|(derivative, root)| *derivative *= self.loss.root_slope(*root));
        }
        Some(columns)
    }

    fn ranges(&self, x: &[f64]) -> Vec<[f64; 2]> {
        // Searches begin and end where the scene accepts the parameters.
        let scene = self.scene(x);
        scene.map_or_else(|_| x.iter().map(|x| [*x; 2]).collect(), |scene| self.ranges(&scene))
    }
}
