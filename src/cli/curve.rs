//! `whiskmap curve`.

use super::failure::Failure;
use super::outputs::Outputs;
use crate::model::Side;
use crate::render::{Chart, CurveAxis, curves};
use crate::scene::{Morphology, Scene, Whisker};
use crate::store::Table;
use crate::trace::{self, Corner, Detachment};
use clap::Args;
use rayon::prelude::*;
use serde::Serialize;
use std::io;
use std::path::PathBuf;

/// Options of `curve`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  whiskmap curve scenes/cone.toml | head
  whiskmap curve scenes/cone.toml --csv curve.csv --plot curve.svg
  whiskmap curve scenes/cone.toml --corner

One line per side and distance of the scene, CF before CB; angles are positive for CB and negative for CF. Lines
without values are out of reach. A scene with taper or curvature axes gives the curve of every whisker, with the
leading columns taper and curvature_per_mm.")]
pub struct Options {
    /// Scene file; - reads it from standard input
    scene: PathBuf,
    /// Tell only where slip-off turns into pull-off
    #[arg(long, conflicts_with = "plot")]
    corner: bool,
    #[command(flatten)]
    outputs: Outputs,
}

/// Whiskers computed together.
const AT_ONCE: usize = 64;

/// Runs `curve`.
pub fn run(options: &Options) -> Result<(), Failure> {
    let scene = Scene::read(&options.scene)?;
    let whiskers: Vec<(Morphology, Whisker)> = scene.whiskers().collect();
    if options.outputs.has_plot() && whiskers.len() > 1 {
        return Err(Failure::Input(format!(
            "--plot: the scene sweeps {} whiskers over grid.taper and grid.curvature_per_mm; a plot shows one",
            whiskers.len()
        )));
    }
    let mut outputs = options.outputs.open()?;
    let mut drawn = Vec::new();
    for group in whiskers.chunks(AT_ONCE) {
        let sides = || {
            group
                .par_iter()
                .flat_map_iter(|one| Side::BOTH.map(|side| (one, side)))
        };
        if options.corner {
            let rows: Vec<(Morphology, Corner)> = sides()
                .map(|((morphology, whisker), side)| {
                    let corner = trace::corner(whisker, &scene.pole, side);
                    (*morphology, corner)
                })
                .collect();
            write(&scene, outputs.table.as_mut(), &rows)?;
        } else {
            let rows: Vec<(Morphology, Detachment)> = sides()
                .flat_map_iter(|((morphology, whisker), side)| {
                    let distances = &scene.grid.distance_mm;
                    let curve = trace::curve(whisker, &scene.pole, side, distances);
                    curve.into_iter().map(|row| (*morphology, row))
                })
                .collect();
            write(&scene, outputs.table.as_mut(), &rows)?;
            if options.outputs.has_plot() {
                drawn.extend(rows.into_iter().map(|(_, row)| row));
            }
        }
    }
    let chart = Chart {
        title: scene.title.clone(),
        plots: vec![curves("", &drawn, AXES)],
        columns: 1,
    };
    outputs.finish(Some(&chart))
}

/// Writes the rows of some whiskers, with the leading columns only where the scene has an axis for them.
fn write<R: Serialize>(
    scene: &Scene,
    table: Option<&mut Table>,
    rows: &[(Morphology, R)],
) -> io::Result<()> {
    match table {
        None => Ok(()),
        Some(table) if scene.is_sweep() => table.rows(rows),
        Some(table) => table.rows(rows.iter().map(|(_, row)| row)),
    }
}

const AXES: [CurveAxis; 2] = [
    CurveAxis {
        label: "distance at first touch (mm)",
        value: |end| Some(end.distance_mm),
    },
    CurveAxis {
        label: "push angle at detachment (deg)   CF < 0 < CB",
        value: |end| end.push_angle_deg,
    },
];
