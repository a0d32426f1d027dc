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
    ("cone", 0x4ba1_41ef_7dbc_79c8),
    ("cylinder", 0x1c63_d650_5957_c1f1),
    ("euler_spiral", 0x7071_cd03_79c9_5efd),
    ("fig4_hair", 0xebef_1eac_572b_f3ff),
    ("fig4_whisker", 0x6e5b_11ed_c04d_aaf3),
    ("fig5_left", 0x9ad0_2ad5_1b18_2364),
    ("fig5_right", 0xdc62_9b1c_e02c_baaf),
    ("follicle", 0x7d49_97ca_5a75_1c22),
    ("friction", 0x1fba_e093_9d6e_9527),
    ("measured", 0x4c04_4926_08d8_b6c6),
    ("morphology", 0x8138_01c4_0139_3bc0),
    ("pad", 0xdcf6_83a7_4d0a_5a49),
    ("robot", 0x1d2e_3667_ac36_04fb),
    ("texture_cone", 0x43e2_2eb9_e323_1952),
    ("texture_hair", 0x554a_ed4c_a926_dfaf),
    ("traced", 0x78be_44dc_8796_c710),
    ("uncertain", 0x6fd3_0033_31b9_6d9e),
];

/// Hashes without fused arithmetic.
const NO_FMA: [(&str, u64); 17] = [
    ("cone", 0x6135_f5a1_bda5_1ffd),
    ("cylinder", 0xdab0_a13b_08aa_1824),
    ("euler_spiral", 0x52a8_b587_5020_99b6),
    ("fig4_hair", 0x9a54_638b_c4b0_ddd8),
    ("fig4_whisker", 0x4254_0711_7930_e656),
    ("fig5_left", 0x9ad0_2ad5_1b18_2364),
    ("fig5_right", 0x9cac_204d_1f1d_1350),
    ("follicle", 0x7d1d_4107_6f4d_542e),
    ("friction", 0xb6f1_3722_5ad1_9168),
    ("measured", 0x304d_e194_baf8_809c),
    ("morphology", 0x43fb_a7e7_c8ce_a525),
    ("pad", 0x462e_5240_c78b_dec7),
    ("robot", 0x1d2e_3667_ac36_04fb),
    ("texture_cone", 0x2c0f_6dc2_ce86_150e),
    ("texture_hair", 0x554a_ed4c_a926_dfaf),
    ("traced", 0x9793_35cd_69e1_74ab),
    ("uncertain", 0xebcc_a6b4_0b5e_bf41),
];
