//! Names and values in messages: shortened, or with a known name that resembles them.

use crate::terminal::escaped;

/// Least similarity of a suggested name, as in clap.
const SIMILAR: f64 = 0.7;

/// Letters of the longer one of two names for each edit between them. With more edits, one of them must contain the other.
const LETTERS_PER_EDIT: usize = 3;

/// Returns the name among `known` that resembles `name` most, by Jaro's similarity of lower-case names; `None` if none is near in spelling.
pub(crate) fn similar<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let name = name.to_lowercase();
    let known = known.into_iter();
    let scored = known
        .map(|other| (other.to_lowercase(), other))
        .filter(|(lower, _)| are_near(&name, lower))
        .map(|(lower, other)| (strsim::jaro(&name, &lower), other))
        .filter(|(score, _)| *score > SIMILAR);
    let best = scored.max_by(|(one, _), (other, _)| one.total_cmp(other));
    best.map(|(_, other)| other)
}

/// Returns true if few edits lead from one name to the other, with or without their units, or if one contains the other.
fn are_near(name: &str, known: &str) -> bool {
    let few_edits = |name: &str, known: &str| {
        let longest = name.chars().count().max(known.chars().count());
        LETTERS_PER_EDIT * strsim::osa_distance(name, known) <= longest
    };
    let is_part = |part: &str, whole: &str| part.len() >= SHORTEST && whole.contains(part);
    let stem = |name: &str| UnitName::of(name).stem.join("_");
    few_edits(name, known)
        || few_edits(&stem(name), &stem(known))
        || is_part(name, known)
        || is_part(known, name)
}

/// Returns the end of a message about an unknown `name`: a suggestion among the `known` names, or nothing.
///
/// A name in another unit, or of a diameter in place of a radius, is not suggested alone, because its values must be converted.
///
/// ```
/// use whiskmap::input::did_you_mean;
///
/// let known = ["tip_radius_um", "base_radius_um"];
/// assert_eq!(did_you_mean("tip_radius", known), "; did you mean `tip_radius_um`?");
/// let unit = "; values must be in um: convert them, and use the name `tip_radius_um`";
/// assert_eq!(did_you_mean("tip_radius_mm", known), unit);
/// let half = "; values must be radii in um, half the diameters: convert them, and use the name `tip_radius_um`";
/// assert_eq!(did_you_mean("tip_diameter_um", known), half);
/// assert_eq!(did_you_mean("colour", known), "");
/// ```
#[must_use]
pub fn did_you_mean<'a>(
    name: &str,
    known: impl IntoIterator<Item = &'a str, IntoIter: Clone>,
) -> String {
    let known = known.into_iter();
    let radius = radius_for(name);
    let is_radius = |known: &&str| known.contains("radius");
    let converted = match &radius {
        Some(radius) => similar(radius, known.clone().filter(is_radius)),
        None => known.clone().find(|known| is_of_another_unit(name, known)),
    };
    if let Some(expected) = converted {
        let unit = UnitName::of(expected).spelled();
        let [radii, half] = match radius {
            Some(_) => ["radii ", ", half the diameters"],
            None => [""; 2],
        };
        return format!(
            "; values must be {radii}in {unit}{half}: convert them, and use the name `{expected}`"
        );
    }
    let found = similar(name, known);
    found.map_or_else(String::new, |known| format!("; did you mean `{known}`?"))
}

/// Shortest known name of which another name may be a misspelling: `id` is none of `wid`.
const SHORTEST: usize = 4;

/// Returns true if `name` is most likely meant as the `known` name: they differ in one letter, in case, in punctuation, in the unit alone, or in a
/// diameter for a radius, or `name` lacks the unit or a part of it. Names of two axes, such as `force_x` and `force_y`, are two names.
pub(crate) fn is_meant_as(name: &str, known: &str) -> bool {
    let name = radius_for(name).unwrap_or_else(|| name.to_lowercase());
    let known = known.to_lowercase();
    let is_misspelt = known.len() >= SHORTEST && strsim::osa_distance(&name, &known) == 1;
    let [found, meant] = [&name, &known].map(|name| UnitName::of(name));
    is_misspelt && !are_axes(&name, &known) || found.is_stem_of(&meant) && found.fits(&meant)
}

/// Returns true if two names differ in the letter of an axis alone.
fn are_axes(name: &str, other: &str) -> bool {
    let is_axis = |word: &str| ["x", "y", "z"].contains(&word);
    let mut pairs = name.split('_').zip(other.split('_'));
    name.len() == other.len() && pairs.all(|(a, b)| a == b || is_axis(a) && is_axis(b))
}

/// Returns what is wrong with a table that has columns with `unknown` names: one of them is most likely meant as a column that the table lacks. `None`
/// without such a name.
pub(crate) fn misnamed<'a>(
    unknown: impl IntoIterator<Item = &'a str>,
    lacking: impl IntoIterator<Item = &'a str, IntoIter: Clone>,
) -> Option<String> {
    let lacking = lacking.into_iter();
    unknown.into_iter().find_map(|name| {
        let meant = lacking.clone().find(|known| is_meant_as(name, known))?;
        let hint = did_you_mean(name, [meant]);
        Some(format!("has the column {}{hint}", shortened(name)))
    })
}

/// Returns the lower-case name of a radius for the `name` of a diameter; `None` for other names.
fn radius_for(name: &str) -> Option<String> {
    let name = name.to_lowercase();
    let mut words = ["diameter", "diam"].into_iter();
    words.find(|word| name.contains(word)).map(|word| name.replace(word, "radius"))
}

/// Returns the values of a list in their order, each once: a name that is given twice counts once.
///
/// ```
/// assert_eq!(whiskmap::input::each_once(&["taper", "length_mm", "taper"]), ["taper", "length_mm"]);
/// ```
#[must_use]
pub fn each_once<T: Clone + PartialEq>(values: &[T]) -> Vec<T> {
    let mut kept: Vec<T> = Vec::new();
    for value in values {
        if !kept.contains(value) {
            kept.push(value.clone());
        }
    }
    kept
}

/// Units at the ends of names, with all units of one quantity in one list. `nm` may be nanometres or newton metres.
const UNITS: [&[&str]; 7] = [
    &["nm", "um", "mm", "cm", "m", "inch"],
    &["nm2", "um2", "mm2", "cm2", "m2"],
    &["deg", "rad", "mrad"],
    &["pa", "kpa", "mpa", "gpa", "tpa"],
    &["s", "ms", "us", "min", "h"],
    FORCES,
    &["nnm", "unm", "mnm", "nm", "nnmm", "unmm", "mnmm", "nmm"],
];

/// Units of forces.
const FORCES: &[&str] = &["un", "nn", "mn", "n"];

/// Units of known names, as they end the names and as messages spell them.
const SPELLED: [(&str, &str); 3] = [("gpa", "GPa"), ("un", "uN"), ("nnm", "nNm")];

/// Word between the units of a ratio.
const PER: &str = "per";

/// Name in lower case, in words, and the words of the unit at its end.
struct UnitName {
    stem: Vec<String>,
    unit: Vec<String>,
}

impl UnitName {
    fn of(name: &str) -> Self {
        let name = name.to_lowercase().replace(['\u{b5}', '\u{3bc}'], "u");
        let words = name.split(|letter: char| !letter.is_alphanumeric());
        let mut stem: Vec<String> = Vec::new();
        for word in words.filter(|word| !word.is_empty()) {
            match stem.last_mut() {
                // `N m`, and `N` with a dot and `m`.
                Some(force) if FORCES.contains(&&**force) && ["m", "mm"].contains(&word) => {
                    force.push_str(word);
                }
                _ => stem.push(word.to_owned()),
            }
        }
        let is_of_unit = |word: &String| word == PER || quantities(word).next().is_some();
        let count = stem.iter().skip(1).rev().take_while(|word| is_of_unit(word)).count();
        let unit = stem.split_off(stem.len() - count);
        Self { stem, unit }
    }

    /// Returns true if this is the `known` name but for units. A ratio of two units is rare enough that a part of the name is enough.
    fn is_stem_of(&self, known: &Self) -> bool {
        let is_ratio = self.unit.len() > 2 && self.unit == known.unit;
        self.stem == known.stem || is_ratio && known.stem.ends_with(&self.stem)
    }

    /// Returns true if all units are units of the quantities of the `known` name.
    fn fits(&self, known: &Self) -> bool {
        self.unit.iter().filter(|word| *word != PER).all(|word| {
            quantities(word).any(|units| known.unit.iter().any(|other| units.contains(&&**other)))
        })
    }

    /// Returns the unit as messages spell it, such as `nNm/rad` or `1/mm`.
    fn spelled(&self) -> String {
        let spelled = |word: &str| {
            let spelled = SPELLED.iter().find(|(end, _)| *end == word);
            spelled.map_or(word, |(_, unit)| unit).to_owned()
        };
        let parts = self.unit.split(|word| word == PER);
        let parts = parts.map(|words| match words {
            [] => "1".to_owned(),
            words => words.iter().map(|word| spelled(word)).collect(),
        });
        parts.collect::<Vec<_>>().join("/")
    }
}

/// Returns the lists of units that contain a word.
fn quantities(word: &str) -> impl Iterator<Item = &'static [&'static str]> {
    UNITS.into_iter().filter(move |units| units.contains(&word))
}

/// Returns true if two names differ only in the units at their ends, and the units belong to the same quantities.
fn is_of_another_unit(name: &str, known: &str) -> bool {
    let [name, known] = [name, known].map(UnitName::of);
    name.stem == known.stem && !name.unit.is_empty() && name.unit != known.unit && name.fits(&known)
}

/// The most characters that a message quotes of a text, at its beginning and at its end.
const QUOTED: [usize; 2] = [60, 20];

/// Escapes a value or key for a message, and cuts the middle of a long one.
pub(crate) fn shortened(text: &str) -> String {
    let text = escaped(text);
    let [head, tail] = QUOTED;
    let count = text.chars().count();
    if count <= head + tail {
        return text;
    }
    let part = |from, length| text.chars().skip(from).take(length).collect::<String>();
    format!("{}...{}", part(0, head), part(count - tail, tail))
}

#[cfg(test)]
mod tests {
    use super::{did_you_mean, is_meant_as, shortened};

    #[test]
    fn names_in_other_units_ask_for_a_conversion() {
        for (name, known, unit) in [
            ("arc_length_cm", "arc_length_mm", "mm"),
            ("distance_cm", "distance_mm", "mm"),
            ("Distance_m", "distance_mm", "mm"),
            ("push_angle_rad", "push_angle_deg", "deg"),
            ("tip_radius_mm", "tip_radius_um", "um"),
            ("youngs_modulus_mpa", "youngs_modulus_gpa", "GPa"),
            ("curvature_per_cm", "curvature_per_mm", "1/mm"),
            ("time_ms", "time_s", "s"),
            ("base_force_y_mn", "base_force_y_un", "uN"),
            ("base_moment_unmm", "base_moment_nnm", "nNm"),
            ("base_moment_nm", "base_moment_nnm", "nNm"),
            ("Base moment (N\u{b7}m)", "base_moment_nnm", "nNm"),
            ("follicle_stiffness_nm_per_rad", "follicle_stiffness_nnm_per_rad", "nNm/rad"),
            ("follicle_stiffness_nnm_per_deg", "follicle_stiffness_nnm_per_rad", "nNm/rad"),
            ("follicle_stiffness_per_rad", "follicle_stiffness_nnm_per_rad", "nNm/rad"),
            ("follicle_stiffness_mnm_per_rad", "follicle_stiffness_nnm_per_rad", "nNm/rad"),
        ] {
            let hint = did_you_mean(name, ["side", known]);
            let start = format!("; values must be in {unit}: convert them");
            assert!(hint.starts_with(&start), "{name}: {hint}");
        }
        for (name, known) in [
            ("Distance_MM", "distance_mm"),
            ("Distance (mm)", "distance_mm"),
            ("distance", "distance_mm"),
            ("distance_deg", "distance_mm"),
            ("distnce_cm", "distance_mm"),
        ] {
            let hint = did_you_mean(name, ["side", known]);
            assert_eq!(hint, format!("; did you mean `{known}`?"), "{name}");
        }
    }

    /// Jaro's similarity of each pair is above 0.7.
    #[test]
    fn names_with_many_differences_are_not_suggested() {
        for (name, known) in [("nosuch", "bench"), ("gravity", "grid")] {
            assert!(strsim::jaro(name, known) > super::SIMILAR, "{name}");
            assert_eq!(did_you_mean(name, [known]), "", "{name}");
        }
        for (name, known) in
            [("bnech", "bench"), ("distanze", "distance_mm"), ("radius", "tip_radius_um")]
        {
            let hint = did_you_mean(name, [known]);
            assert_eq!(hint, format!("; did you mean `{known}`?"), "{name}");
        }
    }

    #[test]
    fn names_with_one_difference_are_meant_as_known_ones() {
        for (name, known) in [
            ("length_um", "length_mm"),
            ("Length_mm", "length_mm"),
            ("tip_radius", "tip_radius_um"),
            ("curvature", "curvature_per_mm"),
            ("lenght_mm", "length_mm"),
            ("tapper", "taper"),
            ("length [\u{b5}m]", "length_mm"),
            ("follicle_stiffness", "follicle_stiffness_nnm_per_rad"),
            ("follicle_stiffness_nnm_rad", "follicle_stiffness_nnm_per_rad"),
            ("stiffness_nnm_per_rad", "follicle_stiffness_nnm_per_rad"),
            ("base_diameter_mm", "base_radius_um"),
            ("Base_diam", "base_radius_um"),
        ] {
            assert!(is_meant_as(name, known), "{name}");
        }
        for (name, known) in [
            ("length_sd_mm", "length_mm"),
            ("length_px", "length_mm"),
            ("layer", "taper"),
            ("notes", "name"),
            ("base_diameter_um", "tip_radius_um"),
            ("sd_mm", "sd_deg"),
            ("contact_mm", "contact"),
            ("base_force_z_un", "base_force_x_un"),
            ("id", "wid"),
        ] {
            assert!(!is_meant_as(name, known), "{name}");
        }
    }

    #[test]
    fn control_characters_are_escaped() {
        assert_eq!(shortened("a\u{1b}[31mb\n"), r"a\u{1b}[31mb\n");
    }
}
