//! Bits of whole maps: equal on every machine of one arithmetic class.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::PathBuf;
use whiskmap::map::Panel;
use whiskmap::mechanics::numerics::ArithmeticClass;
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
const FMA: [(&str, u64); 17] = [
    ("cone", 0x4ab1_91f2_4bb1_9e17),
    ("cylinder", 0x3a93_1d49_b7ff_0335),
    ("euler_spiral", 0xdc03_9a13_3246_11e7),
    ("fig4_hair", 0x052a_e090_d4cb_000d),
    ("fig4_whisker", 0xacf4_7ca2_c1ab_603d),
    ("fig5_left", 0x9184_c035_82d8_2bc2),
    ("fig5_right", 0x441e_0702_db59_e3d9),
    ("follicle", 0x3fbb_0545_b692_fba4),
    ("friction", 0xe9b2_82a4_3dc5_71ac),
    ("measured", 0x2b70_8b80_b7ef_2494),
    ("morphology", 0x7601_9284_ce45_ed12),
    ("pad", 0x5745_acf9_c49c_1806),
    ("robot", 0x049b_0231_5b3b_aeaf),
    ("texture_cone", 0xb866_295e_d2b5_9984),
    ("texture_hair", 0xd5fb_43b1_7924_e36f),
    ("traced", 0x220e_6089_b3ba_0511),
    ("uncertain", 0x5b87_ddd3_209b_1fd4),
];

/// Hashes without fused arithmetic.
const NO_FMA: [(&str, u64); 17] = [
    ("cone", 0x3906_ae21_6734_7b63),
    ("cylinder", 0x6e98_06d8_dbbd_040a),
    ("euler_spiral", 0xd6c1_0260_1f62_f147),
    ("fig4_hair", 0xd38e_5f14_eea3_1bc5),
    ("fig4_whisker", 0x0375_43d7_7a0e_e108),
    ("fig5_left", 0x4032_4a9f_bbb7_4cb8),
    ("fig5_right", 0x0654_563e_4f09_0938),
    ("follicle", 0x2b9c_2bac_fa1b_c65e),
    ("friction", 0x0c85_3f40_64d1_fa3d),
    ("measured", 0x996f_b360_c511_b7d0),
    ("morphology", 0xfce9_a54c_e1d0_a6e6),
    ("pad", 0x70cf_6b49_c142_0ec0),
    ("robot", 0x8577_d649_1900_5997),
    ("texture_cone", 0x9806_fb65_4bf7_8ed8),
    ("texture_hair", 0xe6d4_0b6f_e640_9475),
    ("traced", 0x50ba_24c4_432e_94a6),
    ("uncertain", 0x4c32_9c8a_b76e_b9ae),
];
