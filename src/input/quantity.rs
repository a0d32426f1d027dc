//! Numbers with units, as options of the command line give them.

use super::names::shortened;
use std::f64::consts::PI;

/// Quantity of a number in text, with the unit of a number without one.
///
/// ```
/// use whiskmap::input::Quantity;
///
/// assert_eq!(Quantity::LengthMm.parse("15cm"), Ok(150.0));
/// assert_eq!(Quantity::of("tip_radius_um").parse("2"), Ok(2.0));
/// assert_eq!(Quantity::AngleDeg.parse("30\u{b0}"), Ok(30.0));
/// assert_eq!(Quantity::of("force_un").parse("60mN"), Ok(60e3));
/// assert_eq!(Quantity::TimeS.parse("20ms"), Ok(0.02));
/// assert!(Quantity::LengthMm.parse("30deg").is_err());
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Quantity {
    /// A length; a number without a unit is in millimetres.
    LengthMm,
    /// A length; a number without a unit is in micrometres.
    LengthUm,
    /// An angle; a number without a unit is in degrees.
    AngleDeg,
    /// A force; a number without a unit is in micronewtons.
    ForceUn,
    /// A moment; a number without a unit is in nanonewton metres.
    MomentNnm,
    /// An energy; a number without a unit is in nanojoules.
    EnergyNj,
    /// A time; a number without a unit is in seconds.
    TimeS,
    /// A plain number, which has no unit.
    Number,
}

/// Units of one kind with their sizes. Ratios of sizes are whole numbers except for radians, so that a conversion rounds once.
type Units = &'static [(&'static str, f64)];

const LENGTHS: Units = &[("mm", 1e3), ("cm", 1e4), ("m", 1e6), ("um", 1.0)];
const ANGLES: Units = &[("deg", 1.0), ("\u{b0}", 1.0), ("rad", 180.0 / PI)];
const FORCES: Units = &[("uN", 1e3), ("nN", 1.0), ("mN", 1e6), ("N", 1e9)];
const MOMENTS: Units = &[
    ("nNm", 1.0),
    ("uNm", 1e3),
    ("mNm", 1e6),
    ("Nm", 1e9),
    ("uNmm", 1.0),
    ("mNmm", 1e3),
    ("Nmm", 1e6),
];
const ENERGIES: Units = &[("nJ", 1.0), ("uJ", 1e3), ("mJ", 1e6), ("J", 1e9)];
const TIMES: Units = &[("s", 1e6), ("ms", 1e3), ("us", 1.0)];

impl Quantity {
    /// All quantities that have a unit, one for each kind of unit.
    pub const KINDS: [Self; 6] = [
        Self::LengthMm,
        Self::AngleDeg,
        Self::ForceUn,
        Self::MomentNnm,
        Self::EnergyNj,
        Self::TimeS,
    ];

    /// Returns the quantity of an axis or a channel, by the unit at the end of its name.
    #[must_use]
    pub fn of(name: &str) -> Self {
        match name.rsplit('_').next() {
            _ if name.ends_with("_per_mm") => Self::Number,
            Some("mm") => Self::LengthMm,
            Some("um") => Self::LengthUm,
            Some("deg") => Self::AngleDeg,
            Some("un") => Self::ForceUn,
            Some("nnm") => Self::MomentNnm,
            Some("nj") => Self::EnergyNj,
            Some("s") => Self::TimeS,
            _ => Self::Number,
        }
    }

    /// Unit of the quantity, its kind, and examples of numbers. The unit of a plain number is empty.
    const fn about(self) -> [&'static str; 3] {
        match self {
            Self::LengthMm => ["mm", "a length", "15.66, 15.66mm or 1.5cm"],
            Self::LengthUm => ["um", "a length", "1.5, 1.5um or 0.0015mm"],
            Self::AngleDeg => ["deg", "an angle", "30, 30deg, 30\u{b0} or 0.5rad"],
            Self::ForceUn => ["uN", "a force", "60, 60uN or 0.06mN"],
            Self::MomentNnm => ["nNm", "a moment", "250, 250nNm or 0.25uNm"],
            Self::EnergyNj => ["nJ", "an energy", "40, 40nJ or 0.04uJ"],
            Self::TimeS => ["s", "a time", "0.02, 0.02s or 20ms"],
            Self::Number => ["", "a number", "0.9"],
        }
    }

    /// Returns the unit of the quantity; `None` for a plain number.
    #[must_use]
    pub const fn unit(self) -> Option<&'static str> {
        let [unit, ..] = self.about();
        if unit.is_empty() { None } else { Some(unit) }
    }

    const fn table(self) -> Units {
        match self {
            Self::LengthMm | Self::LengthUm => LENGTHS,
            Self::AngleDeg => ANGLES,
            Self::ForceUn => FORCES,
            Self::MomentNnm => MOMENTS,
            Self::EnergyNj => ENERGIES,
            Self::TimeS => TIMES,
            Self::Number => &[],
        }
    }

    /// Returns the names of the units in which a number of the quantity can be given, its own unit first.
    pub fn units(self) -> impl Iterator<Item = &'static str> {
        let default = self.unit();
        let others = self.table().iter().map(|(name, _)| *name);
        default.into_iter().chain(others.filter(move |name| Some(*name) != default))
    }

    /// Returns the finite number in `text`, in the quantity's own unit.
    ///
    /// # Errors
    /// If there is no such number, or its unit is not one of the quantity.
    pub fn parse(self, text: &str) -> Result<f64, String> {
        self.parse_with_unit(text).map(|(number, _)| number)
    }

    /// Returns the finite number in `text`, in the quantity's own unit, and the unit in which the text gives it. Without a unit in the
    /// text, this is the quantity's own unit, or an empty text for a plain number.
    ///
    /// ```
    /// use whiskmap::input::Quantity;
    ///
    /// assert_eq!(Quantity::MomentNnm.parse_with_unit("20mNm"), Ok((20e6, "mNm")));
    /// assert_eq!(Quantity::MomentNnm.parse_with_unit("20"), Ok((20.0, "nNm")));
    /// ```
    ///
    /// # Errors
    /// Fails as [`Self::parse`] does.
    pub fn parse_with_unit(self, text: &str) -> Result<(f64, &'static str), String> {
        let is_last = |c: char| c.is_ascii_digit() || c == '.';
        let end = text.rfind(is_last).map_or(0, |last| last + 1);
        let (number, unit) = text.split_at(end);
        let parsed: Option<f64> = number.trim_start().parse().ok();
        let finite = parsed.filter(|number| number.is_finite());
        let [_, kind, examples] = self.about();
        let refused = || {
            let point = with_decimal_point(number).map_or_else(String::new, |number| {
                format!("; write a decimal point, not a comma: {number}{unit}")
            });
            format!("must be {kind}, such as {examples}{point}")
        };
        let number = finite.ok_or_else(refused)?;
        let unit = unit.trim();
        if unit.is_empty() {
            return Ok((number, self.unit().unwrap_or_default()));
        }
        let unknown = || format!("unit {}: {}", shortened(unit), self.allowed());
        let (default_size, (name, size)) = self.sizes(unit).ok_or_else(unknown)?;
        let converted = converted(number, size, default_size);
        match converted.is_finite() {
            true => Ok((converted, name)),
            false => Err(refused()),
        }
    }

    /// Converts a number in the quantity's own unit to another `unit`. Returns `None` for a unit of another quantity.
    #[must_use]
    pub fn convert(self, number: f64, unit: &str) -> Option<f64> {
        let (default_size, (_, size)) = self.sizes(unit)?;
        Some(converted(number, default_size, size))
    }

    /// Size of the quantity's own unit, and name and size of the other `unit`. The sign for micro is U+00B5 or U+03BC.
    fn sizes(self, unit: &str) -> Option<(f64, (&'static str, f64))> {
        let unit = unit.replace(['\u{b5}', '\u{3bc}'], "u");
        let units = self.table().iter();
        let named = |name: &str| units.clone().find(|(known, _)| *known == name).copied();
        let (_, default_size) = named(self.unit()?)?;
        Some((default_size, named(&unit)?))
    }

    /// Message that lists the allowed units.
    fn allowed(self) -> String {
        let names: Vec<&str> = self.units().collect();
        match names[..] {
            [default, ref others @ .., last] => {
                let others: String = others.iter().map(|name| format!(", {name}")).collect();
                format!("must be {default} (the default){others} or {last}")
            }
            _ => "must be left out".to_owned(),
        }
    }
}

/// Returns the number in a text with a decimal comma, with a decimal point; `None` for other texts.
fn with_decimal_point(text: &str) -> Option<String> {
    let number = text.trim().replacen(',', ".", 1);
    let is_number = text.contains(',') && number.parse::<f64>().is_ok();
    is_number.then_some(number)
}

/// Converts a number between units of these sizes.
fn converted(number: f64, from: f64, to: f64) -> f64 {
    if from < to { number / (to / from) } else { number * (from / to) }
}

#[cfg(test)]
mod tests {
    use super::Quantity::{
        self, AngleDeg, EnergyNj, ForceUn, LengthMm, LengthUm, MomentNnm, Number, TimeS,
    };

    #[test]
    fn units_are_converted_with_one_rounding() {
        for (quantity, text, value) in [
            (LengthMm, "15.66", 15.66),
            (LengthMm, " 15.66 mm ", 15.66),
            (LengthMm, "15cm", 150.0),
            (LengthMm, "0.15m", 150.0),
            (LengthMm, "300um", 0.3),
            (LengthMm, "300\u{b5}m", 0.3),
            (LengthMm, "300\u{3bc}m", 0.3),
            (LengthMm, "1.5e1mm", 15.0),
            (LengthUm, "1.5", 1.5),
            (LengthUm, "0.0015mm", 1.5),
            (AngleDeg, "-30deg", -30.0),
            (AngleDeg, "30 \u{b0}", 30.0),
            (AngleDeg, "0.5rad", 0.5_f64.to_degrees()),
            (ForceUn, "60mN", 60e3),
            (ForceUn, "300 nN", 0.3),
            (MomentNnm, "1.1Nmm", 1.1e6),
            (MomentNnm, "3\u{b5}Nm", 3e3),
            (EnergyNj, "7uJ", 7e3),
            (TimeS, "20ms", 0.02),
            (TimeS, "-1.5 s", -1.5),
            (Number, "-1e-3", -1e-3),
        ] {
            assert_eq!(quantity.parse(text), Ok(value), "{text}");
        }
    }

    #[test]
    fn other_units_and_other_texts_are_refused() {
        let lengths = "unit deg: must be mm (the default), cm, m or um";
        let angles = "unit mm: must be deg (the default), \u{b0} or rad";
        let [first, last] = [60, 20].map(|count| "x".repeat(count));
        let shortened = format!("unit {first}...{last}: must be left out");
        for (quantity, text, must) in [
            (LengthMm, "30deg", lengths),
            (LengthMm, "15km", "unit km: must be mm"),
            (AngleDeg, "15mm", angles),
            (TimeS, "20min", "unit min: must be s (the default), ms or us"),
            (Number, "0.9mm", "unit mm: must be left out"),
            (LengthMm, "far", "must be a length"),
            (
                LengthMm,
                "1,5",
                "must be a length, such as 15.66, 15.66mm or 1.5cm; write a decimal point, not a comma: 1.5",
            ),
            (
                AngleDeg,
                "-1,5 deg",
                "must be an angle, such as 30, 30deg, 30\u{b0} or 0.5rad; write a decimal point, not a comma: -1.5 deg",
            ),
            (AngleDeg, "nan", "must be an angle"),
            (AngleDeg, "1e999", "must be an angle"),
            (LengthMm, "1e308m", "must be a length"),
            (Number, "", "must be a number"),
            (Number, &format!("1{}", "x".repeat(1000)), &shortened),
        ] {
            let why = quantity.parse(text).err().unwrap_or_default();
            assert!(why.starts_with(must), "{text}: {why}");
        }
    }

    #[test]
    fn names_end_in_their_units() {
        for (name, quantity) in [
            ("distance_mm", LengthMm),
            ("base_radius_um", LengthUm),
            ("push_angle_deg", AngleDeg),
            ("curvature_per_mm", Number),
            ("taper", Number),
            ("force_un", ForceUn),
            ("base_moment_nnm", MomentNnm),
            ("energy_nj", EnergyNj),
            ("time_s", TimeS),
        ] {
            assert_eq!(Quantity::of(name), quantity, "{name}");
        }
    }
}
