//! Derivatives as channels of maps.

use crate::shipped;
use whiskmap::Side;
use whiskmap::classify::Regime;
use whiskmap::plan::{Plan, PlanError};
use whiskmap::scene::Parameter;
use whiskmap::sensitivity::{Variable, detachments};
use whiskmap::{MapEngine, Options};

fn options(channels: &str, engine: MapEngine) -> Options {
    let mut options = Options::default();
    options.channels = Some(channels.parse().unwrap());
    options.engine = engine;
    options
}

/// Every cell in contact has the derivative of its row's detachment, on both sides and engines; every other cell has none.
#[test]
fn cells_have_the_derivatives_of_their_detachments() {
    let scene = shipped::scene("cone").thinned(16, 1);
    let parameters = [Parameter::Taper, Parameter::LengthMm];
    let variables = parameters.map(Variable::from);
    for engine in [MapEngine::Cpu, MapEngine::Spectral] {
        let options = options("regime,d_push_d_length_mm,d_push_d_taper", engine);
        let panel = whiskmap::map(&scene, options).unwrap().panels.remove(0);
        let regimes: Vec<Regime> = panel.regimes().collect();
        let pushes = &scene.grid.push_angle_deg;
        let mut contacts = 0;
        for side in Side::BOTH {
            let distances = &scene.grid.distance_mm;
            let ends = detachments(&scene.whisker, &scene.pole, side, distances, &variables);
            for (row, end) in ends.iter().enumerate() {
                for (column, push) in pushes.iter().enumerate() {
                    let cell = row * pushes.len() + column;
                    if Side::of_push(*push) != side {
                        continue;
                    }
                    for (parameter, by) in parameters.into_iter().zip(&end.by) {
                        let found = panel.push_derivatives[parameter as usize][cell];
                        match (regimes[cell], by) {
                            (Regime::Contact, Ok(by)) => {
                                assert_eq!(found, by.push_angle_deg as f32);
                                contacts += 1;
                            }
                            _ => assert!(found.is_nan()),
                        }
                    }
                }
            }
        }
        assert!(contacts > 100, "{contacts}");
        let friction = &panel.push_derivatives[Parameter::Friction as usize];
        assert!(friction.is_empty());
    }
}

/// A derivative by a number that the scene does not give is refused, not empty.
#[test]
fn absent_parameters_are_refused() {
    let scene = shipped::scene("cone");
    let channels = "d_push_d_spiral_per_mm".parse().unwrap();
    let refused = Plan::new(&scene).unwrap().with_channels(channels, &scene);
    let why = refused.unwrap_err();
    assert!(matches!(&why, PlanError::NotGiven { name, given }
        if *name == "d_push_d_spiral_per_mm" && given.contains("taper")));
}

/// Each derivative takes 4 bytes a cell in memory.
#[test]
fn derivatives_take_memory() {
    let scene = shipped::scene("cone");
    let plan = |channels: &str| {
        let plan = Plan::in_memory(&scene).unwrap();
        plan.with_channels(channels.parse().unwrap(), &scene).unwrap()
    };
    let with = plan("regime,d_push_d_taper,d_push_d_length_mm").bytes;
    assert_eq!(with - plan("regime").bytes, 2 * 4 * 512 * 512);
}
