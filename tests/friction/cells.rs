//! States and statuses of the cells of maps with friction.

use super::cone;
use crate::compute::compute;
use std::sync::LazyLock;
use whiskmap::Channel;
use whiskmap::Side;
use whiskmap::classify::{Regime, Status};
use whiskmap::engine::Spectral;
use whiskmap::friction::Sliding;
use whiskmap::map::{Panel, Summary};
use whiskmap::scene::Scene;
use whiskmap::trace::Branch;
use whiskmap::{Error, Options, for_each_panel};

fn map(friction: f64) -> (Summary, Panel) {
    let (summary, mut panels) = compute(&cone(0.02, 0.25, friction), None);
    (summary, panels.remove(0))
}

/// The map with friction 0.3, which two tests read.
static ROUGH: LazyLock<(Summary, Panel)> = LazyLock::new(|| map(0.3));

/// A tolerance of angles costs no states: histories of contacts are followed at the fine resolution. Here, rows are at the tip of a perfect cone.
#[test]
fn a_tolerance_leaves_no_contact_without_a_state() {
    let text = "title = \"tip\"\n[whisker]\nlength_mm = 20.0\nyoungs_modulus_gpa = 1.098\nbase_radius_um = 15.697\ntip_radius_um = 0.0\n\
                [whisker.curvature]\nparabola_per_mm = 0.000658\nvertex_mm = -3.023\n[pole]\nradius_mm = 0.25\n\
                [contact]\nfriction = 0.2\n[grid]\ndistance_mm = [6.7296, 17.7612]\n\
                push_angle_deg = { from = -20, to = 40, count = 97 }\n";
    let scene = Scene::parse(text, "tip of a cone").unwrap();
    for tolerance_deg in [Some(1e-3), Some(1e-6), None] {
        let mut options = Options::default();
        options.tolerance_deg = tolerance_deg;
        let (mut contacts, mut without) = (0, 0);
        for_each_panel(&scene, options, |_, panel| {
            let of = |codes: &[u32], code| codes.iter().filter(|found| **found == code).count();
            contacts += of(&panel.regime, Regime::Contact.code());
            without += of(&panel.status, Status::NoState.code());
            Ok::<(), Error>(())
        })
        .unwrap();
        assert!(contacts > 20 && without == 0, "{tolerance_deg:?}: {without} of {contacts}");
    }
}

/// Cells of maps have the states of the branch in all channels, by every engine on the CPU.
#[test]
fn cells_have_the_states_of_their_phase() {
    let scene = cone(0.02, 0.25, 0.3);
    let mut spectral = Spectral::default();
    let (_, by_cpu) = &*ROUGH;
    let by_spectral = compute(&scene, Some(&mut spectral)).1.remove(0);
    let pushes = &scene.grid.push_angle_deg;
    let mut counts = [0; 3];
    for (row, distance) in scene.grid.distance_mm.iter().enumerate().step_by(3) {
        for side in Side::BOTH {
            let Ok(branch) = Branch::new(&scene.whisker, &scene.pole, side, *distance) else {
                continue;
            };
            for (column, push) in pushes.iter().enumerate() {
                let at = row * pushes.len() + column;
                let is_contact = by_cpu.regime[at] == Regime::Contact.code();
                if !is_contact || Side::of_push(*push) != side {
                    continue;
                }
                let state = branch.state(push.to_radians(), true).unwrap();
                let wanted = branch.read(&state);
                for panel in [by_cpu, &by_spectral] {
                    for (channel, wanted) in [
                        (Channel::ArcLength, wanted.arc_length_mm),
                        (Channel::ContactAngle, wanted.contact_angle_deg),
                        (Channel::Force, wanted.force_un),
                        (Channel::BaseForceX, wanted.base_force_x_un),
                        (Channel::BaseForceY, wanted.base_force_y_un),
                        (Channel::BaseMoment, wanted.base_moment_nnm),
                        (Channel::Energy, wanted.energy_nj),
                    ] {
                        let found = f64::from(panel.channel(channel)[at]);
                        let case = format!("{distance} {push} {:?} {channel:?}", state.sliding);
                        // Channels have single precision.
                        assert!(
                            (found - wanted).abs() <= 1e-6 * wanted.abs().max(1e-3),
                            "{case}: {found} {wanted}"
                        );
                    }
                }
                counts[state.sliding.unwrap() as usize] += 1;
            }
        }
    }
    assert!(counts.iter().all(|count| *count > 1), "{counts:?}");
}

/// On CF the contact first slides toward the base, then sticks. On CB it does neither.
#[test]
fn cells_that_slide_toward_the_base_are_marked() {
    let scene = cone(0.02, 0.25, 0.3);
    let (summary, panel) = &*ROUGH;
    let pushes = &scene.grid.push_angle_deg;
    let mut contacts = [0, 0];
    let mut toward_base = [0, 0];
    let mut sticking = [0, 0];
    for (row, distance) in scene.grid.distance_mm.iter().enumerate() {
        let branches = [Side::Cf, Side::Cb]
            .map(|side| Branch::new(&scene.whisker, &scene.pole, side, *distance));
        for (column, push) in pushes.iter().enumerate() {
            let at = row * pushes.len() + column;
            let status = panel.status[at];
            let is_contact = panel.regime[at] == Regime::Contact.code();
            let slides = status == Status::TowardBase.code();
            let sticks = status == Status::Sticking.code();
            if !is_contact {
                assert!(!slides || panel.regime[at] == Regime::Unreachable.code());
                assert!(!sticks);
                continue;
            }
            let side = Side::of_push(*push);
            let branch = branches[usize::from(side == Side::Cb)].as_ref().unwrap();
            let state = branch.state(push.to_radians(), true).unwrap();
            let sliding = branch.shape(&state, 2).state.sliding;
            assert_eq!(sliding == Some(Sliding::Base), slides, "{distance} {push}");
            assert_eq!(sliding == Some(Sliding::Sticks), sticks, "{distance} {push}");
            contacts[side as usize] += 1;
            toward_base[side as usize] += usize::from(slides);
            sticking[side as usize] += usize::from(sticks);
        }
    }
    let [cb, cf] = [Side::Cb, Side::Cf].map(|side| side as usize);
    let share = toward_base[cf] as f64 / contacts[cf] as f64;
    assert!((0.1..0.3).contains(&share), "{toward_base:?} {contacts:?}");
    assert_eq!([toward_base[cb], sticking[cb]], [0, 0], "{contacts:?}");
    assert!(sticking[cf] > 0, "{contacts:?}");
    assert_eq!(summary.unresolved(), 0);
    let code = Status::TowardBase.code();
    let all = panel.status.iter().filter(|status| **status == code);
    assert_eq!(summary.toward_base, all.count() as u64);
    assert_eq!(summary.sticking, sticking[cf] as u64);
}

/// The status of a cell does not depend on the other push angles of the grid.
#[test]
fn a_status_does_not_depend_on_other_push_angles() {
    let dense = cone(0.02, 0.25, 0.3);
    let few: Vec<f64> = dense.grid.push_angle_deg.iter().copied().step_by(7).collect();
    let sparse = dense.to_builder().push_angle_deg(few).build().unwrap();
    let [dense, sparse] = [&dense, &sparse].map(|scene| {
        let (_, panels) = compute(scene, None);
        (scene.grid.push_angle_deg.len(), panels[0].status.clone())
    });
    let of_dense = dense.1.chunks(dense.0).flat_map(|row| row.iter().step_by(7));
    let of_dense: Vec<u32> = of_dense.copied().collect();
    let sticking = of_dense.iter().filter(|code| **code == Status::Sticking.code());
    assert!(sticking.count() > 2);
    assert_eq!(of_dense, sparse.1);
}

#[test]
fn without_friction_no_cell_has_a_direction() {
    let (summary, panel) = map(0.0);
    assert_eq!(summary.toward_base, 0);
    assert!(!panel.status.contains(&Status::TowardBase.code()));
    let scene = cone(0.02, 0.25, 0.0);
    let branch = Branch::new(&scene.whisker, &scene.pole, Side::Cf, 9.0).unwrap();
    let points = branch.points(20).unwrap();
    assert!(points.iter().all(|point| point.sliding.is_none()));
}
