//! What a plan promises is what a run does.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use whiskmap::integrate::{Cpu, Description, Engine, EngineError, Hit, Shot};
use whiskmap::map::{self, Observer};
use whiskmap::plan::Plan;
use whiskmap::rod::{Effects, Rod};
use whiskmap::scene::Scene;
use whiskmap::store::{Error, Panel};

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

struct Nothing;

impl Observer for Nothing {
    fn panels(&mut self, _: usize, _: &[Panel]) -> Result<(), Error> {
        Ok(())
    }

    fn settled(&mut self, _: usize) {}
}

/// `(groups, calls)` of a plan whose calls and cells are those of its run.
fn kept(push_angles: &str, distances: &str, more: &str) -> (usize, usize) {
    let text = format!(
        "title = \"t\"\n[whisker]\nlength_mm = 20\nbase_radius_um = 30\ntip_radius_um = 3\nyoungs_modulus_gpa = 3\n\
         [grid]\npush_angle_deg = {push_angles}\ndistance_mm = {distances}\n{more}"
    );
    let scene = Scene::parse(&text, "scene").unwrap();
    let plan = Plan::new(&scene).unwrap();
    let mut engine = Counting(0);
    let summary = map::run(&scene, &plan, &mut engine, &mut Nothing).unwrap();
    assert_eq!(engine.0, plan.engine_calls);
    assert_eq!(summary.cells(), plan.cells as u64);
    let groups = plan.whiskers.len().div_ceil(plan.panels_at_once);
    (groups, plan.engine_calls)
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
