//! Residuals of points, as a function of the free parameters of a scene.

use super::FitLoss;
use crate::least_squares::{BoundedProblem, differences};
use crate::measured::{MeasuredPoints, Residuals};
use crate::scene::{Parameter, Scene, SceneError, SweptWhisker};
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

    /// Returns the whiskers of the points with these `parameters`; `None` where the scene refuses them, and after a cancellation.
    fn whiskers(&self, parameters: &[f64]) -> Option<Vec<SweptWhisker>> {
        let scene = (!self.is_cancelled()).then(|| self.scene(parameters).ok());
        self.points.whiskers_in(&*scene.flatten()?).ok()
    }

    /// Returns the residuals at these `parameters`, with their exact derivatives. `None` where the scene refuses the parameters, or a point is out of
    /// reach or never detaches.
    pub fn place(&self, parameters: &[f64]) -> Option<MisfitPlace> {
        let whiskers = self.whiskers(parameters)?;
        let free = self.free.iter().map(|parameter| Variable::from(*parameter));
        let mut variables: Vec<Variable> = free.collect();
        // With a free taper, the radius at the tip follows the radius at the base.
        let tip_by_base = 1.0 - whiskers[0].whisker.taper();
        let has_taper = self.free.contains(&Parameter::Taper) && tip_by_base > 0.0;
        let base = self.free.iter().position(|free| *free == Parameter::BaseRadiusUm);
        let base = base.filter(|_| has_taper);
        variables.extend(base.map(|_| Variable::from(Parameter::TipRadiusUm)));
        let Residuals { values: residuals, by } = self.points.residuals(&whiskers, &variables)?;
        let exact = by.map(|mut columns| {
            if let Some(base) = base
                && let Some(by_tip) = columns.pop()
            {
                let both = columns[base].iter_mut().zip(by_tip);
                both.for_each(|(by_base, by_tip)| *by_base += tip_by_base * by_tip);
            }
            for (column, unit) in columns.iter_mut().zip(&self.units) {
                column.iter_mut().for_each(|derivative| *derivative *= unit);
            }
            columns
        });
        let roots = residuals.iter().map(|residual| self.loss.root(*residual)).collect();
        Some(MisfitPlace { residuals, roots, exact })
    }

    /// Returns true if a point detaches in another way with these `parameters` than was measured.
    pub fn has_other_kinds(&self, parameters: &[f64]) -> bool {
        let whiskers = self.whiskers(parameters);
        whiskers.is_some_and(|whiskers| self.points.beside_all(&whiskers).of_another_kind() > 0)
    }

    /// Returns the derivative of each point's residual at `place`, which is that of `parameters`, by each scaled parameter: `[parameter][point]`. All are
    /// exact, or all are differences if a point has no exact one, as at first touch. `None` where the scene refuses the parameters on both sides.
    pub fn jacobian(&self, parameters: &[f64], place: &MisfitPlace) -> Option<Vec<Vec<f64>>> {
        let residuals = |x: &[f64]| Some(self.points.residuals(&self.whiskers(x)?, &[])?.values);
        place.exact.clone().or_else(|| differences(residuals, parameters, STEP))
    }
}

/// Residuals of points at a place of a [`Misfit`], predicted less measured angles over their standard deviations.
pub(super) struct MisfitPlace {
    /// Residuals, dimensionless: `[point]`.
    pub residuals: Vec<f64>,
    /// Signed roots of the losses of the residuals: `[point]`.
    roots: Vec<f64>,
    /// Exact derivatives of the residuals by each scaled parameter, `[parameter][point]`; `None` if one does not exist.
    exact: Option<Vec<Vec<f64>>>,
}

impl AsRef<[f64]> for MisfitPlace {
    fn as_ref(&self) -> &[f64] {
        &self.roots
    }
}

/// The residuals of the problem are the signed roots of the losses.
impl BoundedProblem for Misfit<'_> {
    type Place = MisfitPlace;

    fn count(&self) -> usize {
        self.points.points.len()
    }

    fn residuals(&self, x: &[f64]) -> Option<MisfitPlace> {
        self.place(x)
    }

    fn jacobian(&self, x: &[f64], place: &MisfitPlace) -> Option<Vec<Vec<f64>>> {
        let mut columns = Misfit::jacobian(self, x, place)?;
        for column in &mut columns {
            let slopes = column.iter_mut().zip(&place.roots);
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
