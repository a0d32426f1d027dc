//! Parameters of a scene with one whisker and a few pole distances, in whisker lengths.
#![allow(dead_code, reason = "each test program uses a part of this module")]

use std::f64::consts::FRAC_PI_4;
use std::fmt::Write;
use whiskmap::engine::Engine;
use whiskmap::map::{Panel, Summary};
use whiskmap::scene::Scene;

/// Parameters of a scene; lengths other than `length_mm` in whisker lengths.
#[derive(Clone, Debug)]
pub struct Case {
    pub length_mm: f64,
    pub taper: f64,
    /// Dimensionless curvature `A*`.
    pub bend: f64,
    pub pole: f64,
    pub friction: f64,
    pub tip_to_base: f64,
    pub stretch: f64,
    /// Turn of the base in its follicle under the moment `E I_base/L_w`, in radians; 0 for a clamp.
    pub compliance: f64,
    /// Measured radii that replace the taper, as `[arclength, radius]` over length and base radius; empty for a cone.
    pub rows: Vec<[f64; 2]>,
    pub pushes_deg: Vec<f64>,
    pub distances: Vec<f64>,
}

impl Case {
    /// Text of the scene file, with a modulus of 3 GPa.
    pub fn text(&self) -> String {
        self.text_at(3.0)
    }

    /// Text of the scene file with a Young's modulus of so many `gpa`.
    pub fn text_at(&self, gpa: f64) -> String {
        let length = self.length_mm;
        let base_um = 1.5 * length;
        let tip_um = base_um * (1.0 - self.taper);
        let mut text = format!(
            "title = \"hard\"\n[whisker]\nlength_mm = {length:?}\nyoungs_modulus_gpa = {gpa:?}\n"
        );
        let rows: Vec<[f64; 2]> =
            self.rows.iter().map(|[s, r]| [s * length, r * base_um]).collect();
        let _ = if rows.is_empty() {
            writeln!(text, "base_radius_um = {base_um:?}\ntip_radius_um = {tip_um:?}")
        } else {
            writeln!(text, "[whisker.profile]\nrows = {rows:?}")
        };
        if self.stretch != 1.0 {
            let stretch = self.stretch;
            let _ = writeln!(text, "[whisker.projection]\narc_stretch = {stretch:?}");
        }
        if self.bend > 0.0 {
            let a = self.bend / length;
            let _ = writeln!(text, "[whisker.curvature]\nparabola_per_mm = {a:?}");
        }
        if self.tip_to_base != 1.0 {
            let ratio = self.tip_to_base;
            let _ = writeln!(text, "[whisker.modulus_gradient]\ntip_to_base = {ratio:?}");
        }
        if self.compliance > 0.0 {
            // `E I_base/L_w` in nN m.
            let moment = 1e18 * gpa * FRAC_PI_4 * (1e-6 * base_um).powi(4) / (1e-3 * length);
            let stiffness = moment / self.compliance;
            let _ = writeln!(text, "[whisker.follicle]\nstiffness_nnm_per_rad = {stiffness:?}");
        }
        if self.pole > 0.0 {
            let radius = self.pole * length;
            let _ = writeln!(text, "[pole]\nradius_mm = {radius:?}");
        }
        if self.friction > 0.0 {
            let _ = writeln!(text, "[contact]\nfriction = {:?}", self.friction);
        }
        let distances: Vec<f64> = self.distances.iter().map(|d| d * length).collect();
        let _ = writeln!(
            text,
            "[grid]\npush_angle_deg = {:?}\ndistance_mm = {distances:?}",
            self.pushes_deg
        );
        text
    }

    /// The case with so many rows and cells that a net takes less time, and an engine computes them.
    pub fn dense(mut self) -> Self {
        const PUSHES: i32 = 120;
        const ROWS: i32 = 24;
        let more = (1..=PUSHES).map(|i| 70.0 * (f64::from(i) / f64::from(PUSHES)).powi(2));
        self.pushes_deg.extend(more.flat_map(|push| [-push, push]));
        let distances = self.distances.iter().copied();
        let [nearest, farthest] =
            [distances.clone().fold(1.0, f64::min), distances.fold(0.0, f64::max)];
        let more = (1..ROWS).map(|i| f64::from(i) / f64::from(ROWS));
        let more = more.map(|part| nearest + part * (farthest - nearest));
        self.distances.extend(more);
        for values in [&mut self.pushes_deg, &mut self.distances] {
            values.sort_by(f64::total_cmp);
            values.dedup();
        }
        self
    }

    pub fn scene(&self) -> Scene {
        let text = self.text();
        Scene::parse(&text, "hard").unwrap_or_else(|error| panic!("{text}\n{error}"))
    }
}

/// Summary and panel of a scene without sweep.
pub fn compute(scene: &Scene, engine: Option<&mut dyn Engine>) -> (Summary, Panel) {
    let (summary, mut panels) = super::compute::compute(scene, engine);
    (summary, panels.remove(0))
}
