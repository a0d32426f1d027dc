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
    ("cone", 0x37dc_4c7f_8de3_e7fe),
    ("cylinder", 0x81e9_6bb9_6683_a108),
    ("euler_spiral", 0x639c_2f6b_8bcf_c901),
    ("fig4_hair", 0x236e_152f_6d65_2434),
    ("fig4_whisker", 0x4736_7c1a_c8fb_8faf),
    ("fig5_left", 0xb715_bc53_1bc3_7641),
    ("fig5_right", 0x4102_ef3c_7426_c36a),
    ("measured", 0x4892_12c1_141e_8802),
    ("morphology", 0xb7d5_4d9e_0120_3b8e),
    ("robot", 0x3202_710d_7ca5_e150),
    ("uncertain", 0x2eec_9b3d_9949_7111),
];

/// Hashes without fused arithmetic.
const NO_FMA: [(&str, u64); 11] = [
    ("cone", 0xc87f_86cf_4fe9_e69b),
    ("cylinder", 0x16bc_f886_6b97_ba42),
    ("euler_spiral", 0x9ff5_6ab6_998e_7f98),
    ("fig4_hair", 0xa4d2_7678_c958_e3f8),
    ("fig4_whisker", 0x9590_7869_2056_43c0),
    ("fig5_left", 0xd679_20c9_cec4_484b),
    ("fig5_right", 0xe084_d29b_cfa6_ee76),
    ("measured", 0xac49_5822_f7e7_e6ad),
    ("morphology", 0x8430_b0fd_d69b_6b9c),
    ("robot", 0xc8a6_e25a_f13c_a962),
    ("uncertain", 0xc6c8_e02a_f970_ed4c),
];
