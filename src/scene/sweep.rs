//! The axes along which whiskers differ, and what a scene's tables say at one place of them.

use std::ops::Range;

use toml::Spanned;

use super::axis;
use super::error::Fault;
use super::file::{
    ContactTable, CurvatureTable, GradientTable, PoleTable, ProjectionTable, SceneTable,
};
use super::grid::{Grid, Place, SweepAxis};
use super::limits::{Limits, MOST_STRETCH, Number, STIFFEST_TIP, friction_limits};
use super::parameter::Parameter;
use super::shape;

/// The axes, each value within what is allowed whatever the others are.
pub(super) fn axes(table: &SceneTable, lengths_mm: [f64; 2]) -> Result<Vec<SweepAxis>, Fault> {
    let listed = table.grid.get_ref().sweep();
    let read = listed.into_iter().map(|(parameter, axis)| {
        let limits = match parameter {
            Parameter::Taper => Limits::between(0.0, 1.0),
            Parameter::TipRadiusUm => Limits::between(0.0, 1e5),
            Parameter::BaseRadiusUm => Limits::between(1e-3, 1e5),
            Parameter::LengthMm => length_limits(),
            Parameter::ParabolaPerMm => shape::parabola_limits(lengths_mm[1]),
            Parameter::Friction => friction_limits(),
            Parameter::ModulusTipToBase => Limits::between(1.0 / STIFFEST_TIP, STIFFEST_TIP),
            Parameter::ArcStretch => Limits::between(1.0, MOST_STRETCH),
            _ => Limits::between(-1e6, 1e6),
        };
        // The scene's own number is replaced, not forgotten.
        if let Some(own) = table.own(parameter) {
            limits.check(parameter.key(), own)?;
            if parameter == Parameter::ParabolaPerMm {
                let key = parameter.key();
                shape::refuse_faint(&[*own.get_ref()], lengths_mm[0], key, own.span())?;
            }
        }
        let values = axis::values(axis, &key(parameter), &limits)?;
        Ok(SweepAxis { parameter, values })
    });
    let mut axes: Vec<SweepAxis> = read.collect::<Result<_, _>>()?;
    if let [first, _] = &axes[..]
        && first.parameter == Parameter::ParabolaPerMm
    {
        axes.swap(0, 1);
    }
    Ok(axes)
}

/// The key of an axis.
pub(super) fn key(parameter: Parameter) -> String {
    format!("grid.{}", parameter.axis())
}

/// A whisker's length.
pub(super) fn length_limits() -> Limits {
    Limits::between(1e-3, 1e5)
}

/// The least and the greatest length of the whiskers.
pub(super) fn lengths_mm(table: &SceneTable) -> Result<[f64; 2], Fault> {
    let limits = length_limits();
    let own = limits.check("whisker.length_mm", &table.whisker.length_mm)?;
    let Some(axis) = &table.grid.get_ref().length_mm else {
        return Ok([own; 2]);
    };
    let values = axis::values(axis, &key(Parameter::LengthMm), &limits)?;
    Ok([values[0], values[values.len() - 1]])
}

/// An axis takes the place of the scene's own number, not of what stands there instead of one.
pub(super) fn refuse_at_odds(table: &SceneTable) -> Result<(), Fault> {
    let whisker = &table.whisker;
    let curvature = whisker.curvature.as_ref().map(Spanned::get_ref);
    let spiral = curvature.is_some_and(|own| own.euler_spiral.is_some());
    let parabola = curvature.is_some_and(|own| own.parabola_per_mm.is_some());
    let sweep = table.grid.get_ref().sweep();
    let swept = |wanted| sweep.iter().any(|(parameter, _)| *parameter == wanted);
    for (parameter, axis) in &sweep {
        let measured = whisker.profile.is_some();
        let must = match parameter {
            Parameter::Taper | Parameter::TipRadiusUm | Parameter::BaseRadiusUm if measured => {
                "must be left out: the radii are those of whisker.profile"
            }
            Parameter::LengthMm if measured => {
                "must be left out: whisker.profile has the radii of one length"
            }
            Parameter::TipRadiusUm if swept(Parameter::Taper) => {
                "must be left out: grid.taper gives every whisker of the sweep its tip"
            }
            Parameter::ParabolaPerMm | Parameter::VertexMm if spiral => {
                "must be left out: the whisker is an Euler spiral"
            }
            Parameter::VertexMm if !parabola && !swept(Parameter::ParabolaPerMm) => {
                "must be left out: there is no parabola; give parabola_per_mm or grid.curvature_per_mm"
            }
            _ => continue,
        };
        return Err(Fault::new(key(*parameter), axis.span(), must));
    }
    match (&whisker.tip_radius_um, swept(Parameter::Taper)) {
        (Some(tip), true) => {
            let must = "must be left out: grid.taper gives every whisker of the sweep its tip";
            Err(Fault::new("whisker.tip_radius_um", tip.span(), must))
        }
        _ => Ok(()),
    }
}

/// The places whose whiskers are valid only if all are. Every limit moves one way along every axis, so these are the
/// corners; next to a curvature of 0 there is the least one that bends.
pub(super) fn corners(grid: &Grid) -> impl Iterator<Item = Place> {
    let mut ends = grid.ends();
    for axis in &mut ends.sweep {
        let all = grid.axis(axis.parameter).unwrap_or_default();
        if axis.parameter == Parameter::ParabolaPerMm && all[0] == 0.0 && all.len() > 2 {
            axis.values.insert(1, all[1]);
        }
    }
    (0..ends.whisker_count()).map(move |index| ends.place(index))
}

impl SceneTable {
    /// Puts the numbers of `place` where the file has the scene's own.
    pub(super) fn put(&mut self, place: &Place) {
        for (parameter, value) in place.values() {
            let span = self.span(parameter);
            let number = Spanned::new(span.clone(), value);
            let whisker = &mut self.whisker;
            match parameter {
                Parameter::LengthMm => whisker.length_mm = number,
                Parameter::BaseRadiusUm => whisker.base_radius_um = Some(number),
                Parameter::TipRadiusUm => whisker.tip_radius_um = Some(number),
                Parameter::ParabolaPerMm | Parameter::VertexMm => {
                    let straight = CurvatureTable {
                        parabola_per_mm: None,
                        vertex_mm: None,
                        euler_spiral: None,
                    };
                    let straight = || Spanned::new(span, straight);
                    let own = whisker.curvature.get_or_insert_with(straight).as_mut();
                    match parameter {
                        Parameter::VertexMm => own.vertex_mm = Some(number),
                        _ => own.parabola_per_mm = Some(number),
                    }
                }
                Parameter::ModulusTipToBase => {
                    let tip_to_base = number;
                    whisker.modulus_gradient = Some(GradientTable { tip_to_base });
                }
                Parameter::ArcStretch => {
                    let arc_stretch = number;
                    whisker.projection = Some(ProjectionTable { arc_stretch });
                }
                Parameter::PoleRadiusMm => self.pole = Some(PoleTable { radius_mm: number }),
                Parameter::Friction => self.contact = Some(ContactTable { friction: number }),
                _ => {}
            }
        }
        // The base that a taper refers to may itself be on an axis.
        if let Some(taper) = place.value(Parameter::Taper) {
            let base = self.whisker.base_radius_um.as_ref();
            let span = self.span(Parameter::Taper);
            self.whisker.tip_radius_um =
                base.map(|base| Spanned::new(span, base.get_ref() * (1.0 - taper)));
        }
    }

    /// The scene's own number, where the file gives it.
    fn own(&self, parameter: Parameter) -> Option<&Number> {
        let whisker = &self.whisker;
        let curvature = whisker.curvature.as_ref().map(Spanned::get_ref);
        match parameter {
            Parameter::LengthMm => Some(&whisker.length_mm),
            Parameter::BaseRadiusUm => whisker.base_radius_um.as_ref(),
            Parameter::TipRadiusUm => whisker.tip_radius_um.as_ref(),
            Parameter::ParabolaPerMm => curvature?.parabola_per_mm.as_ref(),
            Parameter::VertexMm => curvature?.vertex_mm.as_ref(),
            Parameter::ModulusTipToBase => Some(&whisker.modulus_gradient.as_ref()?.tip_to_base),
            Parameter::ArcStretch => Some(&whisker.projection.as_ref()?.arc_stretch),
            Parameter::PoleRadiusMm => Some(&self.pole.as_ref()?.radius_mm),
            Parameter::Friction => Some(&self.contact.as_ref()?.friction),
            _ => None,
        }
    }

    /// Where the file has the axis.
    fn span(&self, parameter: Parameter) -> Range<usize> {
        let mut axes = self.grid.get_ref().sweep().into_iter();
        let axis = axes.find(|(own, _)| *own == parameter);
        axis.map_or(0..0, |(_, axis)| axis.span())
    }
}

/// The first of the faults found at some of so many `corners`: it is that of an axis where one gives the number, and tells
/// the place unless it is the same everywhere.
pub(super) fn located(faults: Vec<(Fault, Place)>, corners: usize) -> Option<Fault> {
    let is_everywhere =
        faults.len() == corners && faults.iter().all(|(fault, _)| *fault == faults[0].0);
    let (fault, place) = faults.into_iter().next()?;
    let mut axes = place.values();
    let own = axes.find(|(parameter, _)| fault.is_about(parameter.key()));
    let fault = match own {
        Some((parameter, _)) => fault.renamed(key(parameter)),
        None => fault,
    };
    if is_everywhere {
        return Some(fault);
    }
    let values = place.values();
    let values = values.map(|(parameter, value)| format!("{} = {value}", parameter.axis()));
    Some(fault.at(&values.collect::<Vec<_>>().join(", ")))
}
