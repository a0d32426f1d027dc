//! Bits of whole maps: equal on every machine of one arithmetic class.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::PathBuf;
use whiskmap::map::Panel;
use whiskmap::mechanics::numerics::ArithmeticClass;
use whiskmap::scene::Scene;
use whiskmap::{Error, Options, for_each_panel};

/// FNV-1a of some bytes.
fn fnv(hash: u64, bytes: impl IntoIterator<Item = u8>) -> u64 {
    bytes
        .into_iter()
        .fold(hash, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

/// The hash of every channel of a panel, as a store has it.
fn hashed(hash: u64, panel: &Panel) -> u64 {
    let codes = [&panel.regime, &panel.status, &panel.newton_steps];
    let numbers = panel.state.iter().chain([&panel.residual, &panel.margin_deg]);
    let hash = fnv(hash, codes.into_iter().flatten().flat_map(|code| code.to_le_bytes()));
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
    ("cone", 0x04ab_e8af_c283_8d77),
    ("cylinder", 0xdb46_51a4_9baa_de9b),
    ("euler_spiral", 0x3e0f_f250_6367_6f01),
    ("fig4_hair", 0xebef_1eac_572b_f3ff),
    ("fig4_whisker", 0x28bd_efcb_4443_ad81),
    ("fig5_left", 0x8039_02de_67be_2d60),
    ("fig5_right", 0xffe5_c191_3149_32a5),
    ("follicle", 0xa79b_a5c5_9b3e_3486),
    ("friction", 0x2ed4_82bb_4a3f_4463),
    ("measured", 0x95af_efd1_4d2f_ab24),
    ("morphology", 0x954e_954e_fc79_9196),
    ("pad", 0x2a1f_cf7a_a9c9_38a4),
    ("robot", 0xa009_e27c_84b4_9ddc),
    ("texture_cone", 0x9bef_fb46_9af9_e0be),
    ("texture_hair", 0xe3cf_874f_f688_1690),
    ("traced", 0x99b2_b07a_9f6e_4a6b),
    ("uncertain", 0x2e7b_0326_9571_18b5),
];

/// Hashes without fused arithmetic.
const NO_FMA: [(&str, u64); 17] = [
    ("cone", 0x6656_400c_8d62_7dd5),
    ("cylinder", 0x1de8_33c4_72ed_c112),
    ("euler_spiral", 0x36d9_e14c_a378_4743),
    ("fig4_hair", 0xebef_1eac_572b_f3ff),
    ("fig4_whisker", 0xa63b_eb0c_560d_c3b2),
    ("fig5_left", 0xde54_0a8f_62dc_ceb1),
    ("fig5_right", 0xef49_6bde_d8e4_68e2),
    ("follicle", 0xf6e1_a4ae_df0f_47ee),
    ("friction", 0xb858_eee8_7a3a_05d5),
    ("measured", 0x621e_89db_c762_778f),
    ("morphology", 0x85af_d108_676d_8f8b),
    ("pad", 0x5d09_acb6_503e_0a81),
    ("robot", 0x5333_a1ae_f213_e536),
    ("texture_cone", 0x9bef_fb46_9af9_e0be),
    ("texture_hair", 0x9d47_384c_b417_7799),
    ("traced", 0xd65c_7c9f_a78d_0058),
    ("uncertain", 0xebcc_a6b4_0b5e_bf41),
];
