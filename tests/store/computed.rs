//! Maps that are computed when they are read.

use crate::program::SCENE;
use std::sync::atomic::AtomicBool;
use whiskmap::scene::Scene;
use whiskmap::store::{ChannelValues, ComputedMap, StoreError};
use whiskmap::{Channel, Channels, MapEngine, Options};

/// Cells of a whisker of [`sweep`].
const CELLS: usize = 24 * 24;

/// Sweep of a straight and a curved whisker in front of three poles.
fn sweep() -> Scene {
    let axes = "curvature_per_mm = [0, 0.02]\npole_radius_mm = [0.1, 0.2, 0.4]\n";
    Scene::parse(&format!("{SCENE}{axes}"), "sweep.toml").unwrap()
}

fn options(engine: MapEngine) -> Options {
    let mut options = Options::default();
    options.engine = engine;
    options
}

/// Reads a channel, and counts the cells that are computed for it.
fn read(map: &ComputedMap, name: &str, whiskers: &[usize]) -> (ChannelValues, usize) {
    let mut computed = 0;
    let values = map.read(name, whiskers, &mut |cells| computed += cells, &AtomicBool::new(false));
    (values.unwrap(), computed)
}

#[test]
fn whiskers_are_those_of_the_whole_map_in_any_order() {
    for engine in [MapEngine::Cpu, MapEngine::Spectral] {
        let scene = sweep();
        let mut options = options(engine);
        options.channels = Some(Channels::STANDARD.with("peak_strain"));
        let whole = whiskmap::map(&scene, options.clone()).unwrap();
        let map = whiskmap::lazy_map(&scene, options).unwrap();
        assert_eq!(map.engine, whole.summary.engine);
        for order in [&[4, 1, 4][..], &[0], &[5, 4, 3, 2, 1, 0]] {
            for channel in Channel::ALL {
                let (found, _) = read(&map, channel.name(), order);
                let panels = order.iter().map(|whisker| &whole.panels[*whisker]);
                let wanted = panels.flat_map(|panel| panel.channel(channel));
                let wanted = wanted.map(|value| f64::from(*value).to_bits());
                let found = found.values().map(f64::to_bits);
                assert!(found.eq(wanted), "{channel:?}");
            }
            let (regimes, _) = read(&map, "regime", order);
            let panels = order.iter().map(|whisker| &whole.panels[*whisker]);
            let wanted = panels.flat_map(|panel| panel.regime.iter().copied());
            assert_eq!(regimes, ChannelValues::U32(wanted.collect()));
        }
    }
}

#[test]
fn a_whisker_is_computed_once_with_all_channels() {
    let map = whiskmap::lazy_map(&sweep(), Options::default()).unwrap();
    assert_eq!(read(&map, "force_un", &[3]).1, CELLS);
    assert_eq!(read(&map, "regime", &[3, 3]).1, 0);
    assert_eq!(read(&map, "regime", &[5, 3, 0, 0]).1, 2 * CELLS);
    assert_eq!(read(&map, "margin_deg", &[]).1, 0);
    assert!(map.take_warnings().is_empty());
}

#[test]
fn what_does_not_exist_is_named() {
    let mut options = Options::default();
    options.channels = Some("regime,force_un".parse().unwrap());
    let map = whiskmap::lazy_map(&sweep(), options).unwrap();
    let read = |name: &str, whisker: usize| {
        let found = map.read(name, &[whisker], &mut |_| {}, &AtomicBool::new(true));
        found.unwrap_err()
    };
    assert_eq!(
        read("energy_nj", 0).to_string(),
        "sweep has no channel `energy_nj`; it has regime, force_un"
    );
    let none = "there is no panel 6; the map has 6";
    assert_eq!(read("regime", 6).to_string(), none);
    assert!(matches!(read("regime", 5), StoreError::Cancelled));
    let wrong = map.attribute("colour").unwrap_err();
    assert_eq!(wrong.to_string(), "there is no attribute `colour`");
}
