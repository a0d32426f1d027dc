//! Option `--data`: measured points beside the curve.

use super::super::data;
use super::super::failure::{Failure, message};
use super::super::files::Files;
use super::super::pole::check_single;
use super::super::uncertainty;
use super::CurveArgs;
use super::plot::{CHORD, CurveColumn, covering, scene_curves};
use std::path::Path;
use whiskmap::measured::{ComparedPoint, MeasuredAngle};
use whiskmap::mechanics::shooting::Resolution;
use whiskmap::render::{bands, error_bars, measured};
use whiskmap::scene::{Scene, SweptWhisker};
use whiskmap::uncertainty::{EndSpread, PointSpread};

/// Compares the measured points of the file at `path` with the curve. With --samples, table and plot have the percentiles, too.
pub fn compare(
    args: &CurveArgs,
    scene: &Scene,
    path: &Path,
    files: &mut Files,
) -> Result<(), Failure> {
    check_single(scene, "curve --data")?;
    let SweptWhisker { whisker, pole, place } = scene.first_whisker();
    let points = data::read(path, &args.columns)?.at(&place)?;
    points.check_reach(&whisker, &pole)?;
    data::note_follicle(scene);
    let measured_mm = points.points.iter().map(|point| point.distance_mm);
    let distances = covering(&scene.grid.distance_mm, measured_mm);
    let scene = &scene.to_builder().distance_mm(distances).build()?;
    let draws = args.sampling.draw(scene)?;
    if draws.is_some() && points.angle == MeasuredAngle::Chord {
        let origin = &points.origin;
        let must = format!(
            "--samples: bands are of push angles, and {origin} has push_chord_deg; give push_angle_deg"
        );
        return Err(Failure::Input(must));
    }
    let mut outputs = args.outputs.open(files)?;
    let comparison = points.beside(&whisker, &pole);
    data::name_left_out(&points, &comparison);
    let rows = &comparison.rows;
    let spread = draws.as_ref().map(|draws| uncertainty::spread(draws, Resolution::FINE));
    match &spread {
        None => outputs.rows(rows)?,
        Some(spread) => outputs.rows(rows.iter().map(|row| (row, at_point(spread, row))))?,
    }
    let spread = spread.unwrap_or_default();
    outputs.finish(scene.title.clone(), || {
        let x = match points.angle {
            MeasuredAngle::Push => CurveColumn::PushAngleDeg.axis(),
            MeasuredAngle::Chord => CHORD,
        };
        let mut plot = scene_curves(scene, Resolution::FINE, x);
        plot.bands = bands(&spread, CurveColumn::PushAngleDeg.percentiles());
        plot.bars = error_bars(rows);
        plot.dots = measured(rows);
        plot
    })?;
    if comparison.count() == 0 {
        return Err(Failure::Unresolved {
            all: rows.len() as u64,
            what: "points",
            see: "the column `predicted_kind`",
        });
    }
    for (name, value) in data::summary(&comparison) {
        message(&format!("{name}: {value}"));
    }
    Ok(())
}

/// Returns the percentiles of the samples on the side and at the distance of a point, which `spread` has.
fn at_point(spread: &[EndSpread], point: &ComparedPoint) -> PointSpread {
    let mut rows = spread.iter();
    let row = rows.find(|row| row.side == point.side && Some(row.distance_mm) == point.distance_mm);
    row.map(EndSpread::of_push_angles).unwrap_or_default()
}
