//! A store has one scene, version, engine, arithmetic and accuracy.

use super::made_up::{SCENE, about, store};
use serde_json::json;
use whiskmap::engine::EngineDescription;
use whiskmap::map::Channels;
use whiskmap::scene::Scene;
use whiskmap::store::{MapDescription, TemporaryFiles, ZarrStore};

fn engine(name: &str) -> EngineDescription {
    EngineDescription { engine: name.to_owned(), adapter: String::new() }
}

#[test]
fn a_store_has_one_scene_version_engine_arithmetic_and_accuracy() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("x.zarr");
    store(&path, SCENE);
    let scene = Scene::parse(SCENE, "scene.toml").unwrap();
    let join = |about: &MapDescription<'_>| {
        let joined = ZarrStore::join(&path, &scene, about, true);
        joined.map(drop).map_err(|why| why.to_string())
    };
    let fma = about(&scene, "fma");
    assert_eq!(join(&fma), Ok(()));
    let why = join(&about(&scene, "no-fma")).unwrap_err();
    assert!(
        why.contains("differs in `arithmetic`: fma there, no-fma here (with and without"),
        "{why}"
    );
    let engine = engine("gpu f32");
    let why = join(&MapDescription { engine: &engine, ..fma }).unwrap_err();
    assert!(why.contains("differs in `engine`: cpu f64 there, gpu f32 here;"), "{why}");
    let tolerances = json!({ "rtol": 1 });
    let why = join(&MapDescription { tolerances: &tolerances, ..fma }).unwrap_err();
    assert!(why.contains("differs in `tolerances`"), "{why}");
    let channels = Channels::STANDARD;
    let why = join(&MapDescription { channels, ..fma }).unwrap_err();
    assert!(why.contains("differs in `channels`"), "{why}");
    let digits = "3".parse().unwrap();
    let why = join(&MapDescription { digits, ..fma }).unwrap_err();
    assert!(why.contains("differs in `digits`"), "{why}");
    let other = Scene::parse(&SCENE.replace("0.25", "0.26"), "scene.toml").unwrap();
    let joined = ZarrStore::join(&path, &other, &about(&other, "fma"), true);
    let why = joined.map(drop).unwrap_err().to_string();
    assert!(why.contains("differs in `scene`"), "{why}");
}

/// Two threads create a store at the same moment with two engines: one succeeds.
#[test]
fn of_two_engines_that_create_a_store_one_succeeds() {
    let folder = tempfile::tempdir().unwrap();
    let scene = Scene::parse(SCENE, "scene.toml").unwrap();
    for race in 0..50 {
        let path = folder.path().join(format!("{race}.zarr"));
        let start = std::sync::Barrier::new(2);
        let create = |name: &str| {
            let engine = engine(name);
            let about = MapDescription { engine: &engine, ..about(&scene, "fma") };
            let store = ZarrStore::join(&path, &scene, &about, true).unwrap();
            start.wait();
            store.begin(&TemporaryFiles::default()).map_err(|why| why.to_string())
        };
        let results = std::thread::scope(|scope| {
            let both = ["cpu f64", "gpu f32"].map(|name| scope.spawn(move || create(name)));
            both.map(|thread| thread.join().unwrap())
        });
        let why = match &results {
            [Ok(_), Err(why)] | [Err(why), Ok(_)] => why,
            _ => panic!("{results:?}"),
        };
        assert!(why.contains("differs in `engine`: "), "{why}");
        assert!(ZarrStore::open(&path).unwrap().metadata_faults().unwrap().is_empty());
    }
}
