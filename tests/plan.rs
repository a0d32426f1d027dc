//! What a plan promises is what a run does.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use whiskmap::integrate::{Cpu, Description, Engine, EngineError, Hit, Shot};
use whiskmap::map;
use whiskmap::model::{Effects, Rod};
use whiskmap::plan::Plan;
use whiskmap::scene::Scene;
use whiskmap::store::STATE_CHANNELS;

/// Counts the calls of the CPU engine.
struct Counting(usize);

impl Engine for Counting {
    fn describe(&self) -> Description {
        Cpu.describe()
    }

    fn shoot(
        &mut self,
        on: Effects,
        rods: &[Rod],
        shots: &[Shot],
    ) -> Result<Vec<Hit>, EngineError> {
        self.0 += 1;
        Cpu.shoot(on, rods, shots)
    }
}

/// `(groups, calls)` of a plan whose calls and cells are those of its run.
fn kept(push_angles: &str, distances: &str, more: &str) -> (usize, usize) {
    let text = format!(
        "title = \"t\"\n[whisker]\nlength_mm = 20\nbase_radius_um = 30\ntip_radius_um = 3\nyoungs_modulus_gpa = 3\n\
         [grid]\npush_angle_deg = {push_angles}\ndistance_mm = {distances}\n{more}"
    );
    let scene = Scene::parse(&text, "scene", "scene").unwrap();
    let plan = Plan::new(&scene).unwrap();
    let mut engine = Counting(0);
    let summary = map::run(&scene, &plan, &mut engine, &mut |_| Ok(())).unwrap();
    assert_eq!(engine.0, plan.engine_calls);
    assert_eq!(summary.cells(), plan.cells as u64);
    let groups = plan.whiskers.len().div_ceil(plan.panels_at_once);
    (groups, plan.engine_calls)
}

/// A panel is kept twice, with 4 bytes a channel: the state's, and `regime`, `status`, `residual`, `margin_deg`,
/// `newton_steps`.
#[test]
fn memory_is_that_of_the_channels_there_are() {
    let [small, large] = ["count = 100", "count = 300"].map(|count| {
        let text = format!(
            "title = \"t\"\n[whisker]\nlength_mm = 20\nbase_radius_um = 30\ntip_radius_um = 3\n\
             youngs_modulus_gpa = 3\n[grid]\npush_angle_deg = {{ from = 0, to = 9, {count} }}\ndistance_mm = [5, 9]"
        );
        let scene = Scene::parse(&text, "scene", "scene").unwrap();
        Plan::new(&scene).unwrap().bytes
    });
    let channels = STATE_CHANNELS.len() as u64 + 5;
    assert_eq!(large - small, 400 * 2 * 4 * channels);
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
    // At most 64 whiskers are computed together.
    let sweep = "taper = { from = 0, to = 0.9, count = 70 }";
    assert_eq!(kept("[-5, 5]", "[5, 9]", sweep), (2, 2));
}
