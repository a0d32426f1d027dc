//! Whole maps: every shipped scene without a doubtful cell.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::compute;
use crate::shipped;

use compute::{compute, is_contact};
use std::sync::Arc;
use whiskmap::Side;
use whiskmap::classify::Regime;
use whiskmap::engine::{KnownRow, Spectral};
use whiskmap::map::{self, Channels, Panel, STATE_CHANNELS};
use whiskmap::mechanics::shooting::batch::Method;
use whiskmap::plan::Plan;
use whiskmap::refine::TOLERANCE;
use whiskmap::scene::{Parameter, Scene};
use whiskmap::sheet::Sheet;
use whiskmap::{Channel, Error, MapEngine, Options};

#[test]
fn shipped_scenes_have_no_doubtful_cell() {
    let scenes = shipped::scenes();
    assert!(scenes.len() >= 7);
    for scene in scenes {
        let (summary, panels) = compute(&scene, None);
        assert_eq!(summary.disagreements, 0, "{}", scene.title);
        assert_eq!(summary.unresolved(), 0, "{}", scene.title);
        assert!(summary.refined * 4 > summary.cells(), "{}", scene.title);
        assert!(summary.worst_residual <= TOLERANCE, "{}: {}", scene.title, summary.worst_residual);
        for panel in panels {
            for (cell, regime) in panel.regime.iter().enumerate() {
                let contact = is_contact(*regime);
                let complete = panel.state.iter().all(|channel| channel[cell].is_finite())
                    && panel.residual[cell].is_finite()
                    && panel.margin_deg[cell] >= 0.0;
                assert_eq!(contact, complete, "{} cell {cell}", scene.title);
            }
        }
    }
}

/// Whiskers of shipped scenes need no continuation, neither for cells nor for ends alone: it takes up to a hundred times as long as panels. Among
/// them are perfect cones, friction, and measured radii.
#[test]
fn panels_show_the_folds_of_shipped_scenes() {
    for scene in shipped::scenes() {
        for swept in scene.whiskers().flatten() {
            let distances = scene.grid.distance_mm.iter();
            let distances: Vec<f64> = distances.map(|d| d / swept.whisker.length_mm).collect();
            for side in Side::BOTH {
                for sheet in [Sheet::new, Sheet::of_ends] {
                    let sheet = sheet(Method::fine(), &swept.rod(side), side, &distances);
                    assert!(!sheet.is_continued(), "{} {side:?} {swept:?}", scene.title);
                }
            }
        }
    }
}

/// Appends the cells of `more` to `panel`.
fn append(panel: &mut Panel, more: &Panel) {
    panel.regime.extend(&more.regime);
    panel.status.extend(&more.status);
    panel.newton_steps.extend(&more.newton_steps);
    panel.residual.extend(&more.residual);
    panel.margin_deg.extend(&more.margin_deg);
    for (channel, more) in panel.state.iter_mut().zip(&more.state) {
        channel.extend(more);
    }
}

/// Bands of rows hold the cells of the whole panel, also where the memory of a panel is used again.
#[test]
fn bands_are_the_rows_of_a_panel() {
    for (name, is_spectral) in [("cone", false), ("cone", true), ("robot", false)] {
        let mut text = shipped::scene(name).to_toml();
        text += if name == "robot" { "[contact]\nfriction = 0.3\n" } else { "" };
        let scene = Scene::parse(&text, name).unwrap().thinned(64, 1);
        let mut spectral = Spectral::default();
        let (summary, mut whole) = compute(&scene, is_spectral.then_some(&mut spectral as _));
        assert_eq!(summary.toward_base + summary.sticking > 0, name == "robot");
        let mut plan = Plan::new(&scene).unwrap();
        plan.band_rows = 10;
        let mut joined = Panel::unresolved(0, Channels::STANDARD);
        let mut bands = Vec::new();
        let engine = is_spectral.then_some(&mut spectral as _);
        map::run_to_end(&scene, &plan, engine, |panels| {
            for panel in panels {
                append(&mut joined, panel);
                bands.push(panel.regime.len() / scene.grid.push_angle_deg.len());
                // The next band in this memory must overwrite all of it.
                let codes = [&mut panel.regime, &mut panel.status, &mut panel.newton_steps];
                codes.into_iter().for_each(|codes| codes.fill(9));
                let numbers = [&mut panel.residual, &mut panel.margin_deg];
                let numbers = numbers.into_iter().chain(&mut panel.state);
                numbers.for_each(|numbers| numbers.fill(9.0));
            }
        });
        assert_eq!(bands, [10, 10, 10, 10, 10, 10, 4], "{name}");
        compute::assert_identical(&[whole.remove(0)], &[joined]);
    }
}

/// Along a row, push angle and margin add up to the push angle of detachment, up to the rounding of `f32` below 90 degrees.
#[test]
fn push_and_margin_add_up() {
    let scene = shipped::scene("cone").thinned(64, 1);
    let panel = compute(&scene, None).1.remove(0);
    let pushes = &scene.grid.push_angle_deg;
    let rows = panel.regime.chunks(pushes.len());
    let mut compared = 0;
    for (regimes, margins) in rows.zip(panel.margin_deg.chunks(pushes.len())) {
        let cells = pushes.iter().zip(regimes).zip(margins);
        let contacts = cells.filter(|((_, regime), _)| **regime == Regime::Contact.code());
        let ends = contacts
            .map(|((push, _), margin)| (push.is_sign_negative(), push.abs() + f64::from(*margin)));
        let ends: Vec<(bool, f64)> = ends.collect();
        for two in ends.windows(2).filter(|two| two[0].0 == two[1].0) {
            assert!((two[0].1 - two[1].1).abs() < 1e-5, "{two:?}");
            compared += 1;
        }
    }
    assert!(compared > 1000, "{compared}");
}

/// One row of `scene`.
fn row(scene: &Scene, push_angle_deg: &[f64], distance_mm: f64) -> Panel {
    let scene = scene.to_builder().push_angle_deg(push_angle_deg).build().unwrap();
    let scene = scene.to_builder().distance_mm([distance_mm]).build().unwrap();
    compute(&scene, None).1.remove(0)
}

/// One row of the paper's cone at touch 15.66 mm, with these push angles.
fn fig2_row(push_angle_deg: &[f64]) -> Panel {
    let cone = shipped::scene("cone");
    row(&cone, push_angle_deg, 15.660_459_763_365_8)
}

fn channel<'a>(panel: &'a Panel, name: &str) -> &'a [f32] {
    &panel.state[STATE_CHANNELS.iter().position(|channel| *channel == name).unwrap()]
}

/// A hair before slip-off (24.9168 and 15.60793 degrees) the forces are those of the fold to 1 %: states near
/// a fold go with the square root of the angle left.
#[test]
fn forces_have_their_units_and_signs() {
    let panel = fig2_row(&[-24.9168, 15.6079]);
    for (name, cf, cb) in [
        ("force_un", 2.958, 1.2898),
        ("base_moment_nnm", -25.70, 5.55),
        ("arc_length_mm", 16.3284, 17.4303),
    ] {
        let values = channel(&panel, name);
        for (value, wanted) in values.iter().zip([cf, cb]) {
            assert!((value / wanted - 1.0_f32).abs() < 0.01, "{name}: {values:?}");
        }
    }
}

/// Turning the base against the pole stores energy: `dU/dangle` is the moment at the base. Differences over
/// 0.1 degrees leave 1e-4 of curvature and rounding.
#[test]
fn the_base_moment_is_the_slope_of_the_energy() {
    for middle in [-20.0, 12.0] {
        let panel = fig2_row(&[middle - 0.05, middle, middle + 0.05]);
        let energy = channel(&panel, "energy_nj");
        let slope = f64::from(energy[2] - energy[0]) / 0.1_f64.to_radians();
        let moment = f64::from(channel(&panel, "base_moment_nnm")[1]);
        assert!((slope / moment - 1.0).abs() < 1e-3, "{slope} {moment}");
    }
}

/// A strongly curved cone at first touch, where rounding makes a load of 3e-8 out of none, and a straight whisker
/// whose very tip touches: the contact is past the tip by a few roundings only.
#[test]
fn first_touch_and_the_tip_are_decided() {
    let cone = shipped::scene("cone");
    let bend = Parameter::ParabolaPerMm;
    let bent = cone.with(bend, 0.075).unwrap();
    assert_eq!(row(&bent, &[0.0], 18.5).regime, [1]);

    let straight = cone.with(bend, 0.0).unwrap();
    let pointed = straight.with(Parameter::PoleRadiusMm, 0.0).unwrap();
    let pushes = [-1e-3, -1e-5, 0.0, 1e-5, 1e-3];
    assert_eq!(row(&pointed, &pushes, 20.0).regime, [3, 3, 1, 3, 3]);
}

#[test]
fn first_touch_is_without_a_load() {
    compute::assert_no_load_at_touch(|scene| compute(scene, None).1.remove(0));
}

/// Every cell is announced once, and a map that is cancelled before it starts computes none.
#[test]
fn progress_is_complete_and_cancelling_ends_a_map() {
    use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
    let scene = shipped::scene("morphology");
    let scene = scene.thinned(48, 3);
    let count = Arc::new(AtomicUsize::new(0));
    let mut options = Options::default();
    let seen = Arc::clone(&count);
    options.on_progress = Some(Arc::new(move |done, all| {
        assert!(seen.swap(done, Ordering::Relaxed) < done && done <= all);
    }));
    let map = whiskmap::map(&scene, options.clone()).unwrap();
    let cells = map.panels.len() * map.shape().iter().product::<usize>();
    assert_eq!(count.swap(0, Ordering::Relaxed), cells);
    assert_eq!(map.cells().count(), cells);
    options.cancel = Some(Arc::new(AtomicBool::new(true)));
    let mut kept = 0;
    // Row batches grow with the number of threads; those of one are smaller than the map.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1);
    let cancelled = pool.build().unwrap().install(|| {
        whiskmap::for_each_panel(&scene, options, |_, _| {
            kept += 1;
            Ok::<(), Error>(())
        })
    });
    assert!(matches!(cancelled, Err(Error::Cancelled)) && kept == 0);
    assert_eq!(count.load(Ordering::Relaxed), 0);
}

/// Channels of a map in memory are those of its panels, by name.
#[test]
fn channels_have_the_names_of_files() {
    let names = Channel::ALL.map(Channel::name);
    assert_eq!(names[..STATE_CHANNELS.len()], STATE_CHANNELS);
    assert!(
        names
            .iter()
            .all(|name| { whiskmap::Channels::STANDARD.with("peak_strain").contains(name) })
    );
    let scene = shipped::scene("cone").thinned(8, 1);
    let map = whiskmap::map(&scene, Options::default()).unwrap();
    for (channel, values) in Channel::ALL.into_iter().zip(&map.panels[0].state) {
        let bits = |values: &[f32]| values.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(map.channel(0, channel).unwrap()), bits(values));
    }
    assert!(map.channel(1, Channel::Force).is_none());
}

/// The spectral engine solves most cells of a map in memory, with the regimes of the CPU engine.
#[test]
fn options_select_the_engine() {
    let scene = shipped::scene("cone").thinned(256, 1);
    let mut options = Options::default();
    assert_eq!(options.engine, MapEngine::Cpu);
    let wanted = whiskmap::map(&scene, options.clone()).unwrap();
    options.engine = MapEngine::Spectral;
    let map = whiskmap::map(&scene, options).unwrap();
    assert_eq!(wanted.summary.engine_cells.solved, 0);
    assert!(map.summary.engine_cells.solved * 10 > map.summary.refined * 8);
    assert!(map.panels[0].regimes().eq(wanted.panels[0].regimes()));
}

/// A map without numbers of states has the regimes and margins of the CPU engine. Few of its cells are solved: rows of the net for guesses show
/// that there are states.
#[test]
fn regimes_alone_need_no_states() {
    let mut options = Options::default();
    options.channels = Some("regime,margin_deg".parse().unwrap());
    let (mut known, mut all) = (0, 0);
    for scene in shipped::scenes() {
        let scene = scene.thinned(64, 2);
        let map = |engine| {
            let mut options = options.clone();
            options.engine = engine;
            whiskmap::map(&scene, options).unwrap()
        };
        let [wanted, found] = [MapEngine::Cpu, MapEngine::Spectral].map(map);
        for (wanted, found) in wanted.panels.iter().zip(&found.panels) {
            assert_eq!(wanted.regime, found.regime, "{}", scene.title);
            let bits = |panel: &Panel| panel.margin_deg.iter().map(|x| x.to_bits()).collect();
            let [wanted, found]: [Vec<u32>; 2] = [bits(wanted), bits(found)];
            assert_eq!(wanted, found, "{}", scene.title);
        }
        let summary = &found.summary;
        assert_eq!(summary.audit.differing, 0, "{}", scene.title);
        assert!(summary.worst_residual <= KnownRow::RESIDUAL);
        assert!(summary.engine_cells.solved > 0, "{}", scene.title);
        known += summary.engine_cells.solved;
        all += wanted.summary.refined;
    }
    assert!(known * 10 > all * 8, "{known} of {all}");
}
