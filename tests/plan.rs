//! What a plan promises is what a run does.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::collections::VecDeque;
use std::sync::Arc;
use whiskmap::classify::Outcome;
use whiskmap::engine::{Cells, Engine, EngineDescription, EngineError, RowBatch};
use whiskmap::map::{self, EngineCells, Panel, STATE_CHANNELS};
use whiskmap::plan::{MEMORY_LIMIT, Plan, effects};
use whiskmap::scene::Scene;

/// Counts its batches, and certifies no cell.
#[derive(Default)]
struct Counting {
    calls: usize,
    submitted: VecDeque<Arc<RowBatch>>,
}

impl Engine for Counting {
    fn describe(&self) -> EngineDescription {
        EngineDescription::of(None)
    }

    fn residual_bound(&self) -> f64 {
        1e-8
    }

    fn has_device(&self) -> bool {
        true
    }

    fn submit(&mut self, batch: Arc<RowBatch>) -> Result<(), EngineError> {
        self.calls += 1;
        self.submitted.push_back(batch);
        Ok(())
    }

    fn collect(&mut self) -> Result<Cells, EngineError> {
        let batch = self.submitted.pop_front().unwrap();
        Ok(Cells::new(&batch, Outcome::Missed))
    }
}

/// What gives the whisker its tip; a taper axis does that by itself.
fn tip(radius_um: f64, more: &str) -> String {
    match more.contains("taper = ") {
        true => String::new(),
        false => format!("whisker.tip_radius_um = {radius_um}\n"),
    }
}

/// `(groups, calls)` of a plan whose calls and cells are those of its run.
fn kept(push_angles: &str, distances: &str, more: &str) -> (usize, usize) {
    let text = format!(
        "title = \"t\"\n{}whisker.length_mm = 20\nwhisker.base_radius_um = 30\nwhisker.youngs_modulus_gpa = 3\n\
         [grid]\npush_angle_deg = {push_angles}\ndistance_mm = {distances}\n{more}",
        tip(3.0, more)
    );
    let scene = Scene::parse(&text, "scene").unwrap();
    let plan = Plan::in_bands(&scene).unwrap();
    let mut engine = Counting::default();
    let summary = map::run_to_end(&scene, &plan, Some(&mut engine), |_| ());
    // Few cells have no net.
    let is_asked = scene.grid.push_angle_deg.len() > 100;
    assert_eq!(engine.calls, if is_asked { plan.engine_calls } else { 0 });
    assert_eq!(summary.cells(), plan.cells as u64);
    let EngineCells { missed, without_row, .. } = summary.engine_cells;
    let of_cpu = EngineCells { missed, without_row, ..EngineCells::default() };
    assert_eq!(summary.engine_cells, of_cpu);
    let groups = plan.whiskers.div_ceil(plan.panels_at_once);
    (groups, plan.engine_calls)
}

/// A panel takes 4 bytes a channel and cell as computed (the state's, and `regime`, `status`, `residual`, `margin_deg`, `newton_steps`), and
/// 32 bytes a cell as packed. Panels of one group are computed once; those of several groups, twice.
#[test]
fn memory_is_that_of_the_channels_there_are() {
    let bytes = |count: usize, axis: &str| {
        let text = format!(
            "title = \"t\"\n[whisker]\nlength_mm = 20\nbase_radius_um = 30\ntip_radius_um = 3\n\
             youngs_modulus_gpa = 3\n[grid]\npush_angle_deg = {{ from = 0, to = 9, count = {count} }}\n\
             distance_mm = [5, 9]\n{axis}"
        );
        let scene = Scene::parse(&text, "scene").unwrap();
        Plan::new(&scene).unwrap().bytes
    };
    let channels = STATE_CHANNELS.len() as u64 + 5;
    assert_eq!(bytes(300, "") - bytes(100, ""), 400 * (4 * channels + 32));
    let sweep = "friction = [0, 0.1, 0.2]\n";
    assert_eq!(bytes(300, sweep) - bytes(100, sweep), 3 * 400 * (4 * channels + 32));
    let sweep = "friction = { from = 0, to = 1, count = 70 }\n";
    assert_eq!(bytes(300, sweep) - bytes(100, sweep), 400 * (70 * 4 * channels + 64 * 32));
}

#[test]
fn engine_calls_and_cells_are_counted_before_they_are_made() {
    assert_eq!(kept("[-5, 5]", "[5, 9]", ""), (1, 1));
    // 43 rows of 3000 cells are in flight together; 30 distances on two sides are 60 rows.
    let many = "{ from = -60, to = 60, count = 3000 }";
    let rows = "{ from = 3, to = 15, count = 30 }";
    assert_eq!(kept(many, rows, ""), (1, 2));
    let one_side = "{ from = 0, to = 60, count = 3000 }";
    assert_eq!(kept(one_side, rows, ""), (1, 1));
    // Bands of 32 and 8 rows on two sides are 64 and 16 rows, of which 14 are in flight together.
    let wider = "{ from = -60, to = 60, count = 9000 }";
    assert_eq!(kept(wider, "{ from = 3, to = 15, count = 40 }", ""), (1, 7));
    // At most 64 whiskers are computed together.
    let sweep = "taper = { from = 0, to = 0.9, count = 70 }";
    assert_eq!(kept("[-5, 5]", "[5, 9]", sweep), (2, 2));
}

/// Every effect as `+name: why` or `-name: why`; `more` are lines after those of a straight cylinder.
fn listed(tip_radius_um: f64, more: &str) -> Vec<String> {
    let text = format!(
        "title = \"t\"\ngrid.push_angle_deg = [1, 2]\ngrid.distance_mm = [5]\n\
         whisker.length_mm = 20\nwhisker.base_radius_um = 30\n{}whisker.youngs_modulus_gpa = 3\n{more}",
        tip(tip_radius_um, more)
    );
    let scene = Scene::parse(&text, "scene").unwrap();
    let plan = Plan::new(&scene).unwrap();
    let sign = |on| if on { '+' } else { '-' };
    effects(&scene, plan.method.effects)
        .iter()
        .map(|e| format!("{}{}: {}", sign(e.on), e.name, e.why))
        .collect()
}

#[test]
fn nothing_is_on_that_no_line_asks_for() {
    let neutral = "whisker.curvature.parabola_per_mm = 0\nwhisker.modulus_gradient.tip_to_base = 1\n\
                   whisker.projection.arc_stretch = 1\npole.radius_mm = 0\ncontact.friction = 0\n";
    for more in ["", neutral] {
        let expected = [
            "-taper: tip_radius_um 30 = base_radius_um 30",
            "-measured radii: no whisker.profile",
            "-curvature: parabola_per_mm is 0 or left out",
            "-euler spiral: euler_spiral is 0 or left out",
            "-traced shape: no whisker.rest",
            "-modulus gradient: tip_to_base is 1 or left out",
            "-pole radius: radius_mm is 0 or left out",
            "-friction: friction is 0 or left out",
            "-elastic follicle: no whisker.follicle: the base is clamped",
            "-projection: arc_stretch is 1 or left out",
        ];
        assert_eq!(listed(30.0, more), expected);
    }
}

#[test]
fn every_line_turns_its_own_effect_on() {
    let lines = [
        ("whisker.curvature.parabola_per_mm = 0.02", 2, "parabola_per_mm 0.02"),
        (
            "whisker.curvature.euler_spiral = { per_mm = 0.02, per_mm2 = -0.001 }",
            3,
            "per_mm 0.02, per_mm2 -0.001",
        ),
        ("whisker.modulus_gradient.tip_to_base = 1.5", 5, "tip_to_base 1.5"),
        (
            "whisker.rest = { degree = 0, points = [[0, 0], [5, 0], [10, 0], [20, 0]] }",
            4,
            "degree 0, rms 0.0e0 mm, 4 points",
        ),
        ("pole.radius_mm = 0.25", 6, "radius_mm 0.25"),
        ("contact.friction = 0.2", 7, "friction 0.2"),
        ("whisker.follicle.stiffness_nnm_per_rad = 5000", 8, "stiffness_nnm_per_rad 5000"),
        ("whisker.projection.arc_stretch = 1.03", 9, "arc_stretch 1.03"),
    ];
    let bare = listed(1.5, "");
    assert_eq!(bare[0], "+taper: tip_radius_um 1.5 < base_radius_um 30");
    for (line, at, why) in lines {
        let mut expected = bare.clone();
        let name = bare[at][1..].split(':').next().unwrap();
        expected[at] = format!("+{name}: {why}");
        assert_eq!(listed(1.5, line), expected);
    }
}

#[test]
fn axes_stand_in_for_the_whiskers_own_values() {
    let axis = |line| listed(1.5, line);
    assert_eq!(axis("grid.taper = [0, 0.5]")[0], "+taper: grid.taper 0 to 0.5");
    assert_eq!(axis("grid.taper = [0]")[0], "-taper: grid.taper 0");
    let curvature = "+curvature: grid.curvature_per_mm 0 to 0.04";
    assert_eq!(axis("grid.curvature_per_mm = [0, 0.01, 0.04]")[2], curvature);
}

#[test]
fn a_projected_cylinder_is_a_cylinder() {
    let projection = "-projection: arc_stretch 1.03 does nothing without taper or modulus gradient";
    assert_eq!(listed(30.0, "whisker.projection.arc_stretch = 1.03")[9], projection);
}

/// A sweep of the shipped scene with so many values on each of its two axes, and so many lines in its panels.
fn sweep(lines: usize, values: usize) -> Scene {
    let text = include_str!("../scenes/morphology.toml")
        .replace("count = 96", &format!("count = {lines}"))
        .replace("count = 16", &format!("count = {values}"));
    Scene::parse(&text, "sweep.toml").unwrap()
}

#[test]
fn a_map_in_memory_is_limited_by_all_its_panels() {
    let large = sweep(500, 20);
    assert!(Plan::new(&large).unwrap().bytes < MEMORY_LIMIT);
    let refused = whiskmap::map(&large, whiskmap::Options::default()).unwrap_err();
    assert_eq!(
        refused.to_string(),
        "grid: 400 panels of 250000 cells take 5342 MiB in memory: must be at most 4096 MiB; \
         take one panel at a time with `for_each_panel`, or lower the counts of the axes"
    );
    let one = Scene::parse(include_str!("../scenes/cone.toml"), "cone.toml").unwrap();
    let [kept, written] = [Plan::in_memory(&one), Plan::new(&one)].map(|plan| plan.unwrap().bytes);
    // Panels in memory are not packed.
    assert!(kept < written);
}

#[test]
fn panels_one_at_a_time_are_those_of_the_map() {
    let scene = sweep(4, 9);
    let plan = Plan::new(&scene).unwrap();
    assert!(plan.groups().count() > 1);
    let map = whiskmap::map(&scene, whiskmap::Options::default()).unwrap();
    // As text, in which NaN equals NaN.
    let text = |whisker: usize, panel: &Panel| format!("{whisker} {panel:?}");
    let mut panels = map.panels.iter().enumerate();
    whiskmap::for_each_panel(&scene, whiskmap::Options::default(), |whisker, panel| {
        let kept = panels.next().map(|(index, kept)| text(index, kept));
        assert_eq!(Some(text(whisker, &panel)), kept);
        Ok::<(), whiskmap::Error>(())
    })
    .unwrap();
    assert!(panels.next().is_none());
}

#[test]
fn an_error_of_the_caller_ends_the_run() {
    let mut seen = 0;
    let stopped =
        whiskmap::for_each_panel(&sweep(4, 9), whiskmap::Options::default(), |whisker, _| {
            seen += 1;
            if whisker == 2 {
                return Err(Box::<dyn std::error::Error + Send + Sync>::from("enough"));
            }
            Ok(())
        });
    assert_eq!((stopped.unwrap_err().to_string().as_str(), seen), ("enough", 3));
}
