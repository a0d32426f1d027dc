//! Random whiskers with poles and distances, of every rest shape and material.

use crate::random_rods::Random;
use whiskmap::mechanics::rod::{CurvaturePolynomial, Side};
use whiskmap::scene::{Curvature, EulerSpiral, Parameter, Pole, Whisker};
use whiskmap::sensitivity::Variable;

/// A whisker in front of a pole.
#[derive(Clone, Debug)]
pub struct Push {
    pub whisker: Whisker,
    pub pole: Pole,
    pub side: Side,
    pub distance_mm: f64,
}

/// The push with this index: a parabola, a spiral or a straight whisker in turn, every tenth one with measured radii,
/// and every tenth one with a traced shape. Friction, modulus and
/// stretch vary. Every fourth whisker is in a follicle that turns.
pub fn push(index: u64) -> Push {
    let mut random = Random::new(index.wrapping_mul(0x9e37_79b9));
    let mut between = |low: f64, high: f64| random.between(low, high);
    let length_mm = between(8.0, 60.0);
    let base_radius_um = between(20.0, 120.0);
    let shape = match index % 10 {
        9 => 3,
        8 => 4,
        _ => index % 3,
    };
    let measured = shape == 3;
    let taper = between(if measured { 0.5 } else { 0.0 }, 0.98);
    let arc_stretch = between(1.0, 1.02);
    let bend = between(0.02, 0.7) / length_mm;
    let rows = measured.then(|| {
        // No two rows are equal: there the derivative is one of two.
        let row = |i: u32| {
            let s = f64::from(i) / 7.0;
            let rough = if i == 0 { 1.0 } else { between(0.97, 1.03) };
            [s, (1.0 - taper * s) * rough]
        };
        let mut rows: Vec<[f64; 2]> = (0..7).map(row).collect();
        // The cone beyond the last row.
        let ([_, before], [_, last]) = (rows[5], rows[6]);
        rows.push([1.0, last + (last - before).min(-0.02 * last).max(-0.6 * last)]);
        rows
    });
    let tip = rows.as_ref().map_or(1.0 - taper, |rows| rows[7][1]);
    let curvature = (shape == 0 || measured)
        .then(|| Curvature { parabola_per_mm: bend, vertex_mm: between(-0.3, 0.3) * length_mm });
    let euler_spiral = (shape == 1).then(|| EulerSpiral {
        per_mm: between(-0.8, 0.8) / length_mm,
        per_mm2: between(-0.8, 0.8) / (length_mm * length_mm),
    });
    let mut push = Push {
        whisker: Whisker {
            length_mm,
            base_radius_um,
            tip_radius_um: base_radius_um * tip,
            youngs_modulus_gpa: between(1.0, 6.0),
            curvature,
            euler_spiral,
            traced: (shape == 4).then(|| {
                let terms = [0.6, 0.4, 0.2, 0.1, 0.1, 0.05, 0.05];
                CurvaturePolynomial::new(terms.map(|most| between(-most, most)))
            }),
            profile: rows,
            profile_scale: if measured { between(0.5, 2.0) } else { 1.0 },
            modulus_tip_to_base: between(0.3, 3.0),
            arc_stretch,
            follicle_stiffness_nnm_per_rad: None,
            yield_strain: None,
        },
        pole: Pole { radius_mm: between(0.0, 0.03) * length_mm, friction: between(0.0, 0.4) },
        side: if between(0.0, 1.0) < 0.5 { Side::Cb } else { Side::Cf },
        distance_mm: between(0.15, 0.98) * length_mm,
    };
    if index % 4 == 3 {
        let stiffness = push.whisker.units().moment_nnm * between(0.3, 10.0);
        push.whisker.follicle_stiffness_nnm_per_rad = Some(stiffness);
    }
    push
}

impl Push {
    /// Every variable that the whisker has.
    pub fn variables(&self) -> Vec<Variable> {
        use Parameter as P;
        let mut all = vec![
            P::YoungsModulusGpa,
            P::ModulusTipToBase,
            P::ArcStretch,
            P::PoleRadiusMm,
            P::Friction,
        ];
        match &self.whisker.profile {
            Some(_) => all.extend([P::ProfileScale, P::TipExtensionMm]),
            None => all.extend([P::LengthMm, P::BaseRadiusUm, P::TipRadiusUm, P::Taper]),
        }
        let follicle = self.whisker.follicle_stiffness_nnm_per_rad;
        all.extend(follicle.map(|_| P::FollicleStiffness));
        match (&self.whisker.traced, self.whisker.euler_spiral) {
            (Some(_), _) => {}
            (None, Some(_)) => all.extend([P::SpiralPerMm, P::SpiralPerMm2]),
            (None, None) => all.extend([P::ParabolaPerMm, P::VertexMm]),
        }
        let rows = self.whisker.profile.as_ref().map_or(0, Vec::len);
        let all = all.into_iter().map(Variable::Parameter);
        let all = all.chain([Variable::DistanceMm]);
        all.chain((0..rows).map(Variable::ProfileRadiusUm)).collect()
    }

    /// The change of a variable that changes the whisker or its push as a whole.
    pub fn size(&self, variable: Variable) -> f64 {
        let Whisker { length_mm, base_radius_um, .. } = self.whisker;
        match variable {
            Variable::ProfileRadiusUm(row) => {
                let rows = self.whisker.profile.as_deref().unwrap_or_default();
                rows[row][1] * base_radius_um / self.whisker.profile_scale
            }
            Variable::Parameter(parameter) => match parameter {
                Parameter::LengthMm | Parameter::TipExtensionMm => length_mm,
                Parameter::VertexMm => length_mm,
                Parameter::PoleRadiusMm => 0.1 * length_mm,
                Parameter::BaseRadiusUm => base_radius_um,
                Parameter::TipRadiusUm => self.whisker.tip_radius_um,
                Parameter::Taper => 1.0 - self.whisker.taper(),
                Parameter::YoungsModulusGpa => self.whisker.youngs_modulus_gpa,
                Parameter::FollicleStiffness => {
                    let stiffness = self.whisker.follicle_stiffness_nnm_per_rad;
                    stiffness.unwrap_or_default()
                }
                Parameter::ParabolaPerMm | Parameter::SpiralPerMm => 1.0 / length_mm,
                Parameter::SpiralPerMm2 => 1.0 / (length_mm * length_mm),
                Parameter::ArcStretch => 1.0 - self.whisker.taper(),
                _ => 1.0,
            },
            _ => self.distance_mm,
        }
    }

    /// The largest step of differences by a variable. At a row of measured radii, the third derivatives of an end jump: steps are short.
    pub fn step(&self, variable: Variable) -> f64 {
        let is_measured = self.whisker.profile.is_some();
        self.size(variable) * if is_measured { 8e-4 } else { 8e-3 }
    }

    /// The push with a variable increased by `h`.
    pub fn moved(&self, variable: Variable, h: f64) -> Self {
        let mut moved = self.clone();
        let whisker = &mut moved.whisker;
        let mut curvature = whisker.curvature.unwrap_or_default();
        match variable {
            Variable::ProfileRadiusUm(row) => {
                let raw = |radius: f64| radius * whisker.base_radius_um / whisker.profile_scale;
                let mut rows = whisker.profile.clone().unwrap_or_default();
                rows.iter_mut().for_each(|row| row[1] = raw(row[1]));
                rows[row][1] += h;
                moved.set_rows(rows);
                return moved;
            }
            Variable::Parameter(parameter) => match parameter {
                Parameter::LengthMm => whisker.length_mm += h,
                Parameter::BaseRadiusUm => whisker.base_radius_um += h,
                Parameter::TipRadiusUm => whisker.tip_radius_um += h,
                Parameter::Taper => whisker.tip_radius_um -= h * whisker.base_radius_um,
                Parameter::ProfileScale => {
                    let factor = 1.0 + h / whisker.profile_scale;
                    whisker.profile_scale *= factor;
                    whisker.base_radius_um *= factor;
                    whisker.tip_radius_um *= factor;
                }
                Parameter::TipExtensionMm => {
                    let mut rows = whisker.profile.clone().unwrap_or_default();
                    let ([from, before], [end, last]) = (rows[5], rows[6]);
                    let length = whisker.length_mm;
                    rows[7][1] += (last - before) / (end - from) * h / length;
                    rows.iter_mut().for_each(|row| row[0] *= length / (length + h));
                    rows[7][0] = 1.0;
                    whisker.length_mm += h;
                    whisker.tip_radius_um = rows[7][1] * whisker.base_radius_um;
                    whisker.profile = Some(rows);
                }
                Parameter::YoungsModulusGpa => whisker.youngs_modulus_gpa += h,
                Parameter::ParabolaPerMm => curvature.parabola_per_mm += h,
                Parameter::VertexMm => curvature.vertex_mm += h,
                Parameter::SpiralPerMm => whisker.euler_spiral.as_mut().unwrap().per_mm += h,
                Parameter::SpiralPerMm2 => whisker.euler_spiral.as_mut().unwrap().per_mm2 += h,
                Parameter::ModulusTipToBase => whisker.modulus_tip_to_base += h,
                Parameter::ArcStretch => whisker.arc_stretch += h,
                Parameter::FollicleStiffness => {
                    let stiffness = whisker.follicle_stiffness_nnm_per_rad.as_mut();
                    *stiffness.unwrap() += h;
                }
                Parameter::PoleRadiusMm => moved.pole.radius_mm += h,
                Parameter::Friction => moved.pole.friction += h,
                _ => panic!("{parameter:?}"),
            },
            _ => moved.distance_mm += h,
        }
        moved.whisker.curvature = moved.whisker.curvature.map(|_| curvature);
        if self.whisker.curvature.is_none() && curvature.parabola_per_mm > 0.0 {
            moved.whisker.curvature = Some(curvature);
        }
        moved
    }

    /// Sets the measured radii, in um before the factor, with their arclengths in whisker lengths.
    fn set_rows(&mut self, rows: Vec<[f64; 2]>) {
        let base = rows[0][1];
        let whisker = &mut self.whisker;
        whisker.base_radius_um = base * whisker.profile_scale;
        whisker.tip_radius_um = rows[rows.len() - 1][1] * whisker.profile_scale;
        whisker.profile = Some(rows.into_iter().map(|[s, radius]| [s, radius / base]).collect());
    }
}
