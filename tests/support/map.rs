//! A map made up for tests: it looks like a whisker's and is cheap to make.

use serde_json::{Value, json};
use std::path::Path;
use std::sync::LazyLock;
use whiskmap::classify::Regime;
use whiskmap::engine;
use whiskmap::map::{Audit, Channels, EngineCells, Panel, STATE_CHANNELS};
use whiskmap::scene::{Grid, Parameter, Pole, SceneData, SceneText, SweepAxis, Whisker};
use whiskmap::store::{CellCounts, MapDescription, MapWriter, Output, TemporaryFiles};

/// `count` values from `first` to `last`.
pub fn spread(first: f64, last: f64, count: usize) -> Vec<f64> {
    if count == 1 {
        return vec![first];
    }
    let step = (last - first) / (count - 1) as f64;
    (0..count).map(|i| first + step * i as f64).collect()
}

pub fn scene(
    push_angles: usize,
    distances: usize,
    taper: Option<Vec<f64>>,
    curvature_per_mm: Option<Vec<f64>>,
) -> SceneData {
    SceneData {
        title: "A made-up whisker in front of a pole".to_owned(),
        uncertainty: None,
        surface: None,
        whisker: Whisker::cone(20.0, [33.0, 2.0], 3.0),
        pole: Pole::smooth(0.25),
        grid: Grid {
            push_angle_deg: spread(-60.0, 70.0, push_angles),
            distance_mm: spread(3.0, 20.5, distances),
            sweep: [(Parameter::Taper, taper), (Parameter::ParabolaPerMm, curvature_per_mm)]
                .into_iter()
                .filter_map(|(parameter, values)| {
                    let values = values?;
                    let variable = parameter.into();
                    Some(SweepAxis { variable, values })
                })
                .collect(),
        },
        table: std::sync::Arc::default(),
        name: "made-up".to_owned(),
        text: SceneText::of_source("title = \"A made-up whisker\"\n"),
    }
}

/// Push angle of detachment and whether the whisker slips off there, for a distance in whisker lengths.
fn edge(distance: f64, side: f64, index: usize) -> Option<(f64, bool)> {
    let reach = if side < 0.0 { 1.0 } else { 0.96 };
    let left = reach - distance;
    (left > 0.0).then(|| {
        let slip = 68.0 * (left / reach).powf(0.6) * (0.75 + 0.05 * index as f64);
        let pull = 400.0 * left;
        (slip.min(pull), slip < pull)
    })
}

/// Panel `index` of a map.
pub fn panel(scene: &SceneData, index: usize) -> Panel {
    let grid = &scene.grid;
    let cells = grid.push_angle_deg.len() * grid.distance_mm.len();
    let mut panel = Panel {
        regime: Vec::with_capacity(cells),
        status: Vec::with_capacity(cells),
        state: [const { Vec::new() }; STATE_CHANNELS.len()],
        residual: Vec::with_capacity(cells),
        margin_deg: Vec::with_capacity(cells),
        peak_strain: Vec::new(),
        push_derivatives: Default::default(),
        newton_steps: Vec::with_capacity(cells),
    };
    for distance in &grid.distance_mm {
        for &angle in &grid.push_angle_deg {
            let far = distance / scene.whisker.length_mm;
            let edge = edge(far, angle, index);
            let regime = match edge {
                None => Regime::OutOfReach,
                Some((end, _)) if angle.abs() < end && far > 0.97 => Regime::Unreachable,
                Some((end, _)) if angle.abs() < end => Regime::Contact,
                Some((_, true)) => Regime::SlipOff,
                Some((_, false)) => Regime::PullOff,
            };
            let touching = matches!(regime, Regime::Contact | Regime::Unreachable);
            let f32_or_nan = |value: f64| if touching { value as f32 } else { f32::NAN };
            panel.regime.push(regime.code());
            panel.status.push(u32::from(!touching));
            for (place, values) in panel.state.iter_mut().enumerate() {
                let scale = 10_f64.powi(place as i32 - 3);
                values.push(f32_or_nan(scale * angle / (far * far + 0.01)));
            }
            panel.residual.push(f32_or_nan(1e-9 * far * angle.abs()));
            let margin = edge.map_or(0.0, |(end, _)| end - angle.abs());
            panel.margin_deg.push(f32_or_nan(margin));
            let steps = 2 + (angle.abs() / 20.0) as u32;
            panel.newton_steps.push(if touching { steps } else { 0 });
        }
    }
    panel
}

/// An engine whose adapter is not all ASCII.
static ENGINE: LazyLock<engine::EngineDescription> = LazyLock::new(|| engine::EngineDescription {
    engine: "cpu f64".to_owned(),
    adapter: "a \u{201c}card\u{201d}".to_owned(),
});

pub fn describe<'a>(scene: &'a SceneData, tolerances: &'a Value) -> MapDescription<'a> {
    MapDescription {
        scene,
        engine: &ENGINE,
        tolerances,
        channels: Channels::STANDARD,
        digits: whiskmap::plan::Digits::ALL,
        arithmetic: "fma",
    }
}

/// Writes the whole map.
pub fn write(path: &Path, scene: &SceneData) -> CellCounts {
    let tolerances = json!({"rtol": 0.1 + 0.2});
    let mut writer = MapWriter::create(
        Output::create(path, &TemporaryFiles::default()).unwrap(),
        &describe(scene, &tolerances),
    )
    .unwrap();
    let panels: Vec<Panel> = (0..scene.whisker_count()).map(|index| panel(scene, index)).collect();
    // Not always as many at once.
    let (some, others) = panels.split_at(panels.len() / 3);
    writer.write_panels(some).unwrap();
    writer.write_panels(others).unwrap();
    writer.finish(EngineCells::default(), Audit::default()).unwrap().counts
}
