//! Choice of the unit of an axis label: the one in which the numbers read best.

/// Units of length, force, moment and energy, each with its power of ten.
const LADDERS: [&[(&str, i32)]; 4] = [
    &[("\u{b5}m", -6), ("mm", -3), ("m", 0)],
    &[("nN", -9), ("\u{b5}N", -6), ("mN", -3), ("N", 0)],
    &[("nN m", -9), ("\u{b5}N m", -6), ("mN m", -3), ("N m", 0)],
    &[("nJ", -9), ("\u{b5}J", -6), ("mJ", -3), ("J", 0)],
];

/// Converts a `value` in a `unit` such as `µN` to the largest unit that does not exceed its magnitude. Returns the new value, and its unit. A value in
/// an unknown unit stays as it is.
#[must_use]
pub fn readable_value(value: f64, unit: &str) -> (f64, String) {
    let (label, factor) = readable(&format!("({unit})"), value.abs());
    (value / factor, label[1..label.len() - 1].to_owned())
}

/// Replaces the unit in a label such as `force (µN)` by the largest unit that does not exceed `largest`. Returns the label, and the new
/// unit in old units. A label without a known unit stays as it is, and so does the label of numbers that are all 0.
pub fn readable(label: &str, largest: f64) -> (String, f64) {
    let old = LADDERS.iter().find_map(|ladder| {
        let within = |(unit, _): &&(&str, i32)| label.contains(&format!("({unit})"));
        Some((ladder, ladder.iter().find(within)?))
    });
    let Some((ladder, (unit, power))) = old.filter(|_| largest > 0.0) else {
        return (label.to_owned(), 1.0);
    };
    let factor = |new: i32| 10_f64.powi(new - power);
    let reached = |(_, new): &&(&str, i32)| largest >= factor(*new);
    let (new, new_power) = ladder.iter().rev().find(reached).unwrap_or(&ladder[0]);
    let label = label.replace(&format!("({unit})"), &format!("({new})"));
    (label, factor(*new_power))
}
