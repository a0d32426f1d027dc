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

/// The C libraries of some systems round twice.
#[test]
fn products_with_sums_are_rounded_once() {
    let [x, y, z] = std::hint::black_box([
        1.788_540_419_251_572_6,
        1.993_620_867_321_968_9_f64,
        -3.565_671_501_868_718,
    ]);
    assert_eq!(x.mul_add(y, z), -2.205_283_176_707_903_2e-16);
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
const FMA: [(&str, u64); 15] = [
    ("cone", 0x4ab1_91f2_4bb1_9e17),
    ("cylinder", 0x3a93_1d49_b7ff_0335),
    ("euler_spiral", 0xdc03_9a13_3246_11e7),
    ("fig4_hair", 0x052a_e090_d4cb_000d),
    ("fig4_whisker", 0xacf4_7ca2_c1ab_603d),
    ("fig5_left", 0x9184_c035_82d8_2bc2),
    ("fig5_right", 0x441e_0702_db59_e3d9),
    ("friction", 0xe9b2_82a4_3dc5_71ac),
    ("measured", 0x2b70_8b80_b7ef_2494),
    ("morphology", 0x7601_9284_ce45_ed12),
    ("robot", 0x049b_0231_5b3b_aeaf),
    ("texture_cone", 0xb866_295e_d2b5_9984),
    ("texture_hair", 0xd5fb_43b1_7924_e36f),
    ("traced", 0x220e_6089_b3ba_0511),
    ("uncertain", 0x5b87_ddd3_209b_1fd4),
];

/// Hashes without fused arithmetic.
const NO_FMA: [(&str, u64); 15] = [
    ("cone", 0x2c1e_0474_562a_dd66),
    ("cylinder", 0xdaca_3456_3cdd_e335),
    ("euler_spiral", 0x7cf6_7426_4602_687d),
    ("fig4_hair", 0xad0a_3906_2d43_8ea7),
    ("fig4_whisker", 0xf5d3_8f45_63de_2096),
    ("fig5_left", 0x5d7f_7a7e_79e8_9665),
    ("fig5_right", 0x0244_1912_be0a_cdd2),
    ("friction", 0x313d_4d84_4559_a5c9),
    ("measured", 0xa361_3e0d_dcc7_a66f),
    ("morphology", 0xb557_743e_9986_dbc5),
    ("robot", 0x502d_a2b3_8a44_e515),
    ("texture_cone", 0x3ee4_68df_2c67_9963),
    ("texture_hair", 0x0274_6520_07cb_3837),
    ("traced", 0x1ac9_9466_9c24_f0bf),
    ("uncertain", 0x6f1a_7d23_d635_ef4e),
];
