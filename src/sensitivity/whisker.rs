//! Derivatives of a whisker's rod, units and push by a variable, in closed form.

use super::{NoDerivative, Variable};
use crate::scene::{Parameter, Pole, Whisker};
use whiskmap_mechanics::numerics::Dual;
use whiskmap_mechanics::rod::{RadiusProfile, RodDerivative, Side};

/// Change of a whisker in front of its pole per unit of a variable.
#[derive(Clone, Debug, Default)]
pub struct WhiskerDerivative {
    /// Derivatives of the dimensionless numbers of the rod by the variable; in `pieces` those of the measured profile.
    pub rod: RodDerivative,
    /// Derivative of the distance at first touch, in mm per unit of the variable.
    pub distance_mm: f64,
    /// Derivative of the push angle, in radians per unit of the variable.
    pub push: f64,
    /// Derivative of the whisker's length, in mm per unit of the variable.
    pub length_mm: f64,
    /// Derivative of the natural logarithm of the unit of force, per unit of the variable.
    pub ln_force: f64,
    /// Derivative of the natural logarithm of the unit of moment and energy, per unit of the variable.
    pub ln_moment: f64,
}

impl WhiskerDerivative {
    /// Returns the derivatives of `whisker` at `pole` on `side` by `variable`.
    ///
    /// # Errors
    /// If the whisker has no such number.
    pub fn new(
        whisker: &Whisker,
        pole: &Pole,
        side: Side,
        variable: Variable,
    ) -> Result<Self, NoDerivative> {
        let refused = || Err(NoDerivative::NotGiven);
        let mut by = Self::default();
        match variable {
            Variable::DistanceMm => by.distance_mm = 1.0,
            Variable::PushAngleDeg => by.push = 1f64.to_radians(),
            Variable::ProfileRadiusUm(row) => {
                let Some(rows) = whisker.profile.as_ref().filter(|rows| row < rows.len()) else {
                    return refused();
                };
                let per_base = whisker.profile_scale / whisker.base_radius_um;
                if row == 0 {
                    by.stiffen(4.0 * per_base);
                }
                by.change_rows(whisker, 0.0, |i| match (i, row) {
                    (0, _) => [0.0; 2],
                    (_, 0) => [0.0, -per_base * rows[i][1]],
                    _ if i == row => [0.0, per_base],
                    _ => [0.0; 2],
                });
            }
            Variable::Parameter(parameter) => {
                let has = Self::has(whisker, parameter);
                if !has {
                    return refused();
                }
                by.change(whisker, pole, side, parameter);
            }
        }
        if let Some(stiffness) = whisker.follicle_stiffness_nnm_per_rad {
            let is_own = variable == Variable::Parameter(Parameter::FollicleStiffness);
            let ln_stiffness = if is_own { 1.0 / stiffness } else { 0.0 };
            by.rod.mount = whisker.units().moment_nnm / stiffness * (by.ln_moment - ln_stiffness);
        }
        Ok(by)
    }

    /// Returns true if `whisker` has the number that `parameter` names.
    fn has(whisker: &Whisker, parameter: Parameter) -> bool {
        let is_measured = whisker.profile.is_some();
        match parameter {
            Parameter::LengthMm
            | Parameter::BaseRadiusUm
            | Parameter::TipRadiusUm
            | Parameter::Taper => !is_measured,
            Parameter::ProfileScale => is_measured,
            Parameter::TipExtensionMm => {
                let rows = whisker.profile.as_deref().unwrap_or_default();
                continues(rows)
            }
            Parameter::ParabolaPerMm | Parameter::VertexMm => {
                whisker.euler_spiral.is_none() && whisker.traced.is_none()
            }
            Parameter::SpiralPerMm | Parameter::SpiralPerMm2 => {
                whisker.curvature.is_none() && whisker.traced.is_none()
            }
            Parameter::YoungsModulusGpa
            | Parameter::ModulusTipToBase
            | Parameter::ArcStretch
            | Parameter::PoleRadiusMm
            | Parameter::Friction => true,
            Parameter::FollicleStiffness => whisker.follicle_stiffness_nnm_per_rad.is_some(),
        }
    }

    fn change(&mut self, whisker: &Whisker, pole: &Pole, side: Side, parameter: Parameter) {
        let (length, base) = (whisker.length_mm, whisker.base_radius_um);
        let parabola = whisker.curvature.unwrap_or_default();
        let stretch = whisker.arc_stretch;
        let rod = &mut self.rod;
        match parameter {
            Parameter::LengthMm => self.lengthen(whisker, pole, side),
            Parameter::BaseRadiusUm => {
                rod.taper = stretch * whisker.tip_radius_um / (base * base);
                self.stiffen(4.0 / base);
            }
            Parameter::TipRadiusUm => rod.taper = -stretch / base,
            Parameter::Taper => rod.taper = stretch,
            Parameter::ProfileScale => self.stiffen(4.0 / whisker.profile_scale),
            Parameter::TipExtensionMm => {
                self.lengthen(whisker, pole, side);
                let rows = whisker.profile.as_deref().unwrap_or_default();
                if let [.., [from, before], [end, last], _] = rows {
                    let slope = (last - before) / (end - from);
                    self.change_rows(whisker, 0.0, |i| match rows.len() - 1 - i {
                        0 => [0.0, slope / length],
                        _ => [-rows[i][0] / length, 0.0],
                    });
                }
            }
            Parameter::YoungsModulusGpa => self.stiffen(1.0 / whisker.youngs_modulus_gpa),
            Parameter::ParabolaPerMm => {
                rod.bend = length;
                rod.slope = -2.0 * parabola.vertex_mm;
            }
            Parameter::VertexMm => rod.slope = -2.0 * parabola.parabola_per_mm,
            Parameter::SpiralPerMm => rod.spiral = [length, 0.0],
            Parameter::SpiralPerMm2 => rod.spiral = [0.0, length * length],
            Parameter::ModulusTipToBase => rod.gradient = stretch,
            Parameter::ArcStretch => {
                rod.taper = whisker.taper();
                rod.gradient = whisker.modulus_tip_to_base - 1.0;
                if whisker.profile.is_some() {
                    self.change_rows(whisker, 1.0, |_| [0.0; 2]);
                }
            }
            Parameter::FollicleStiffness => {}
            Parameter::PoleRadiusMm => rod.pole = side.sign() / length,
            Parameter::Friction => rod.friction = side.sign(),
        }
    }

    /// Changes the length of the whisker, in mm, by 1: everything that is divided by it. A traced shape keeps its coefficients, which
    /// have no unit.
    fn lengthen(&mut self, whisker: &Whisker, pole: &Pole, side: Side) {
        let length = whisker.length_mm;
        self.length_mm = 1.0;
        self.ln_force = -2.0 / length;
        self.ln_moment = -1.0 / length;
        self.rod.bend = whisker.curvature.unwrap_or_default().parabola_per_mm;
        self.rod.pole = -side.sign() * pole.radius_mm / (length * length);
        if let Some(spiral) = whisker.euler_spiral {
            self.rod.spiral = [spiral.per_mm, 2.0 * spiral.per_mm2 * length];
        }
    }

    /// Changes the logarithm of the bending stiffness at the base.
    fn stiffen(&mut self, by: f64) {
        self.ln_force = by;
        self.ln_moment = by;
    }

    /// Changes the rows of the profile, in whisker lengths and base radii, and the stretch.
    fn change_rows(
        &mut self,
        whisker: &Whisker,
        by_stretch: f64,
        by_row: impl Fn(usize) -> [f64; 2],
    ) {
        let dual = |value, derivative| Dual { value, derivative };
        let profile = whisker.profile.iter().flatten().enumerate();
        let rows: Vec<[Dual<f64>; 2]> = profile
            .map(|(i, [s, radius])| {
                let [by_s, by_radius] = by_row(i);
                [dual(*s, by_s), dual(*radius, by_radius)]
            })
            .collect();
        let stretch = dual(whisker.arc_stretch, by_stretch);
        let (taper, pieces) = RadiusProfile::derivative(&rows, stretch);
        self.rod.taper = taper;
        self.rod.pieces = Some(pieces);
    }
}

/// Largest difference of the last radius from the cone through the two rows before, over the base radius, with which the last row is its
/// continuation.
const ON_CONE: f64 = 1e-12;

/// Returns true if the last of the `rows` continues the cone through the two rows before, as a tip extension does.
fn continues(rows: &[[f64; 2]]) -> bool {
    match rows {
        [.., [from, before], [end, last], [tip, radius]] => {
            let slope = (last - before) / (end - from);
            ((tip - end).mul_add(slope, *last) - radius).abs() <= ON_CONE
        }
        _ => false,
    }
}
