//! Numbers with units, as options of the command line give them.

use super::names::shortened;

/// Quantity of a number in text: length, angle or plain number, with the unit of a number without one.
///
/// ```
/// use whiskmap::input::Quantity;
///
/// assert_eq!(Quantity::LengthMm.parse("15cm"), Ok(150.0));
/// assert_eq!(Quantity::of("tip_radius_um").parse("2"), Ok(2.0));
/// assert_eq!(Quantity::AngleDeg.parse("30\u{b0}"), Ok(30.0));
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
    /// A plain number, which has no unit.
    Number,
}

/// Units of length, in micrometres. The sign for micro is U+00B5 or U+03BC.
const LENGTHS_UM: [(&str, f64); 6] = [
    ("mm", 1e3),
    ("cm", 1e4),
    ("m", 1e6),
    ("um", 1.0),
    ("\u{b5}m", 1.0),
    ("\u{3bc}m", 1.0),
];

impl Quantity {
    /// Returns the quantity of an axis or a channel, by the unit at the end of its name.
    #[must_use]
    pub fn of(name: &str) -> Self {
        match name.rsplit('_').next() {
            _ if name.ends_with("_per_mm") => Self::Number,
            Some("mm") => Self::LengthMm,
            Some("um") => Self::LengthUm,
            Some("deg") => Self::AngleDeg,
            _ => Self::Number,
        }
    }

    /// Returns the unit of the quantity; `None` for a plain number.
    #[must_use]
    pub const fn unit(self) -> Option<&'static str> {
        match self {
            Self::LengthMm => Some("mm"),
            Self::LengthUm => Some("um"),
            Self::AngleDeg => Some("deg"),
            Self::Number => None,
        }
    }

    /// Returns the finite number in `text`, in the quantity's own unit.
    ///
    /// # Errors
    /// If there is no such number, or its unit is not one of the quantity.
    pub fn parse(self, text: &str) -> Result<f64, String> {
        let is_last = |c: char| c.is_ascii_digit() || c == '.';
        let end = text.rfind(is_last).map_or(0, |last| last + 1);
        let (number, unit) = text.split_at(end);
        let number: Option<f64> = number.trim_start().parse().ok();
        let number = number.filter(|number| number.is_finite());
        let number = number.ok_or_else(|| self.example().to_owned())?;
        let unit = unit.trim();
        let unknown = || format!("unit {}: {}", shortened(unit), self.allowed());
        self.convert(number, unit).ok_or_else(unknown)
    }

    /// Converts a number from this unit to that of the quantity; `None` for a unit of another quantity.
    fn convert(self, number: f64, unit: &str) -> Option<f64> {
        let own_um = match self {
            _ if unit.is_empty() => return Some(number),
            Self::LengthMm => 1e3,
            Self::LengthUm => 1.0,
            Self::AngleDeg => {
                return match unit {
                    "deg" | "\u{b0}" => Some(number),
                    "rad" => Some(number.to_degrees()),
                    _ => None,
                };
            }
            Self::Number => return None,
        };
        let (_, unit_um) = LENGTHS_UM.iter().find(|(name, _)| *name == unit)?;
        // Ratios of units are whole numbers, so that the result is rounded once.
        Some(if *unit_um < own_um {
            number / (own_um / unit_um)
        } else {
            number * (unit_um / own_um)
        })
    }

    /// Message about a text without a number.
    const fn example(self) -> &'static str {
        match self {
            Self::LengthMm => "must be a length, such as 15.66, 15.66mm or 1.5cm",
            Self::LengthUm => "must be a length, such as 1.5, 1.5um or 0.0015mm",
            Self::AngleDeg => "must be an angle, such as 30, 30deg, 30\u{b0} or 0.5rad",
            Self::Number => "must be a number, such as 0.9",
        }
    }

    /// Message that lists the allowed units.
    const fn allowed(self) -> &'static str {
        match self {
            Self::LengthMm => "must be mm (the default), cm, m or um",
            Self::LengthUm => "must be um (the default), mm, cm or m",
            Self::AngleDeg => "must be deg (the default), \u{b0} or rad",
            Self::Number => "must be left out",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Quantity::{self, AngleDeg, LengthMm, LengthUm, Number};

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
            (Number, "-1e-3", -1e-3),
        ] {
            assert_eq!(quantity.parse(text), Ok(value), "{text}");
        }
    }

    #[test]
    fn other_units_and_other_texts_are_refused() {
        for (quantity, text, must) in [
            (
                LengthMm,
                "30deg",
                "unit deg: must be mm (the default), cm, m or um",
            ),
            (LengthMm, "15km", "unit km: must be mm"),
            (
                AngleDeg,
                "15mm",
                "unit mm: must be deg (the default), \u{b0} or rad",
            ),
            (Number, "0.9mm", "unit mm: must be left out"),
            (LengthMm, "far", "must be a length"),
            (LengthMm, "1,5", "must be a length"),
            (AngleDeg, "nan", "must be an angle"),
            (AngleDeg, "1e999", "must be an angle"),
            (Number, "", "must be a number"),
            (
                Number,
                &format!("1{}", "x".repeat(1000)),
                &format!(
                    "unit {}...{}: must be left out",
                    "x".repeat(60),
                    "x".repeat(20)
                ),
            ),
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
            ("force_un", Number),
        ] {
            assert_eq!(Quantity::of(name), quantity, "{name}");
        }
    }
}
