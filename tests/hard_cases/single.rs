//! What the GPU finds in `f32`, before the refinement, against the states in `f64`.

use crate::compute::open;
use crate::named::named;
use crate::states::Shots;
use std::fmt::Write;
use whiskmap::integrate::gpu::Precision;
use whiskmap::integrate::{Engine, Outcome};
use whiskmap::refine::End;
use whiskmap::rod::arclength;
use whiskmap::sheet::Sheet;

/// How far off, in whisker lengths, a pole or a contact may be, and a load in the median. Measured: 3.1e-5 for a cylinder
/// that a stiff tip and friction let coil up, else 1.5e-5; 3.7e-6; 1.5e-5. Next to the fold, where the state goes with the
/// square root of the push angle left, loads are off by up to 1.3e-2.
pub const STABLE: f64 = 1e-4;

#[test]
fn single_precision_is_stable_or_handed_over() {
    let Some(mut gpu) = open(Precision::F32) else {
        return;
    };
    let mut table = format!(
        "What {} finds in f32 before the refinement, against f64.\n\
         WHISKMAP_WRITE_TABLES=1 cargo test --profile checked --test hard_cases single -- --nocapture\n\n\
         handed over: shots that the refinement starts anew from the lattice's guess\n\
         pole: how far from the wanted place the pole is, worst of all others, in whisker lengths\n\
         contact, load: how far they are from those of the state, in whisker lengths and relative to |load| + 1,\n\
         median and worst; next to the fold the worst is the square root of the pole's\n\n\
         {:36} shots handed over    pole        contact               load\n",
        gpu.describe().adapter,
        "case",
    );
    let mut walked = 0;
    for (name, case) in named() {
        let shots = Shots::new(&case.scene());
        if shots.sheets.iter().all(Sheet::is_walked) {
            walked += 1;
            continue;
        }
        let hits = shots.shoot(&mut gpu);
        let misses = shots.misses(&hits);
        let handed_over = hits.len() - misses.len();
        let pole = misses.iter().map(|(_, miss)| *miss).fold(0.0, f64::max);
        let rods = shots.rods();
        let (mut contacts, mut loads) = (Vec::new(), Vec::new());
        let cells = shots.refined(&shots.guesses());
        for ((hit, cell), shot) in hits.iter().zip(&cells).zip(&shots.shots) {
            if hit.outcome == Outcome::Converged && cell.end == End::Solved {
                let rod = &rods[shot.rod as usize];
                contacts.push((arclength(rod, hit.tau) - arclength(rod, cell.state.tau)).abs());
                loads.push((hit.load - cell.state.load).abs() / (cell.state.load.abs() + 1.0));
            }
        }
        let worst = |mut values: Vec<f64>| {
            values.sort_by(f64::total_cmp);
            (values[values.len() / 2], values[values.len() - 1])
        };
        let (contact, load) = (worst(contacts), worst(loads));
        assert!(
            pole < STABLE && contact.1 < STABLE && load.0 < STABLE,
            "{name}"
        );
        let _ = writeln!(
            table,
            "{name:36} {:5} {handed_over:11} {pole:7.1e} {:9.1e} {:9.1e} {:9.1e} {:9.1e}",
            hits.len(),
            contact.0,
            contact.1,
            load.0,
            load.1
        );
    }
    eprintln!("{table}{walked} cases are walked: nothing is shot");
    assert!(walked < 5, "{walked}");
    if std::env::var_os("WHISKMAP_WRITE_TABLES").is_some_and(|x| x == "1") {
        std::fs::write("outputs/f32_stability.txt", &table).unwrap();
    }
}
