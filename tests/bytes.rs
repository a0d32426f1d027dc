//! Bits of whole maps: equal on every machine of one arithmetic class.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::PathBuf;
use whiskmap::map::Panel;
use whiskmap::numerics::ArithmeticClass;
use whiskmap::scene::Scene;
use whiskmap::{Error, Options, for_each_panel};

/// FNV-1a of some bytes.
fn fnv(hash: u64, bytes: impl IntoIterator<Item = u8>) -> u64 {
    bytes.into_iter().fold(hash, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

/// The hash of every channel of a panel, as a store has it.
fn hashed(hash: u64, panel: &Panel) -> u64 {
    let codes = [&panel.regime, &panel.status, &panel.newton_steps];
    let numbers = panel
        .state
        .iter()
        .chain([&panel.residual, &panel.margin_deg]);
    let hash = fnv(
        hash,
        codes
            .into_iter()
            .flatten()
            .flat_map(|code| code.to_le_bytes()),
    );
    fnv(hash, numbers.flatten().flat_map(|x| x.to_le_bytes()))
}

/// The hash of each shipped scene, thinned, by the name of its file.
#[test]
fn maps_of_a_class_have_equal_bits() {
    let mut paths: Vec<PathBuf> = std::fs::read_dir("scenes")
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "toml"))
        .collect();
    paths.sort();
    let hashes = paths.iter().map(|path| {
        let mut hash = 0xcbf2_9ce4_8422_2325;
        let scene = Scene::read(path).unwrap().thinned(12, 2);
        for_each_panel(&scene, Options::default(), |_, panel| {
            hash = hashed(hash, &panel);
            Ok::<(), Error>(())
        })
        .unwrap();
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        (name, hash)
    });
    let expected = match ArithmeticClass::detect() {
        ArithmeticClass::Fma => FMA,
        ArithmeticClass::NoFma => NO_FMA,
    };
    let hashes: Vec<(String, u64)> = hashes.collect();
    let found: Vec<(&str, u64)> = hashes.iter().map(|(name, hash)| (&**name, *hash)).collect();
    assert_eq!(found, expected, "{found:#x?}");
}

/// Hashes with fused arithmetic.
const FMA: [(&str, u64); 11] = [
    ("cone", 0x1010_01d9_822e_a828),
    ("cylinder", 0x2119_e0bd_065c_b7fd),
    ("euler_spiral", 0x109b_e6d1_f27f_e97b),
    ("fig4_hair", 0x4b6e_57de_56f3_774f),
    ("fig4_whisker", 0x3060_a86d_e784_8a9e),
    ("fig5_left", 0x8abe_70bb_f215_33d3),
    ("fig5_right", 0x165e_1422_5a56_708a),
    ("measured", 0xb3b0_77d0_a135_077d),
    ("morphology", 0xe22b_642a_0b5a_4b55),
    ("robot", 0x1f6a_a3d6_b69b_7205),
    ("uncertain", 0x36bb_f778_37e5_e74d),
];

/// Hashes without fused arithmetic.
const NO_FMA: [(&str, u64); 11] = [
    ("cone", 0x451b_402f_68f9_eb07),
    ("cylinder", 0x3c9f_3785_143e_8ca5),
    ("euler_spiral", 0x86ba_bc36_b99c_1827),
    ("fig4_hair", 0x061d_89cf_7dbc_68fc),
    ("fig4_whisker", 0x1f0a_edb1_8fa0_57ab),
    ("fig5_left", 0xb346_0993_ee5e_4183),
    ("fig5_right", 0x165e_1422_5a56_708a),
    ("measured", 0x92be_a56a_aedb_bc37),
    ("morphology", 0xa9b3_6ebe_7f66_da01),
    ("robot", 0xea11_559e_2942_f016),
    ("uncertain", 0x4180_fe4b_6266_26bc),
];
