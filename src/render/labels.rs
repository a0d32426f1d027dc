//! Labels of axes, channels and regions in words, with their units.

use crate::rod::Side;
use crate::scene::Parameter;
use whiskmap_plot::Region;

/// Label of the axis of push angles.
pub const PUSH_ANGLE: &str = "push angle (deg)";
/// Label of the axis of distances.
pub const DISTANCE: &str = "distance at first touch (mm)";

/// Returns the names of the regions of negative and positive push angles. A straight whisker has no concave side.
#[must_use]
pub fn regions(is_straight: bool) -> [Region; 2] {
    let names = match is_straight {
        true => [["\u{2212}"; 2], ["+"; 2]],
        false => [
            ["concave forward (CF)", "CF"],
            ["concave backward (CB)", "CB"],
        ],
    };
    names.map(|[name, short]| Region {
        name: name.to_owned(),
        short: short.to_owned(),
    })
}

/// Returns the short name of a side.
pub const fn side(side: Side) -> &'static str {
    match side {
        Side::Cb => "CB",
        Side::Cf => "CF",
    }
}

/// Returns the label of a parameter.
#[must_use]
pub fn parameter(parameter: Parameter) -> String {
    match parameter.unit() {
        "1" => parameter.title().to_owned(),
        unit => format!("{} ({})", parameter.title(), unit.replace("um", "\u{b5}m")),
    }
}

/// Returns the label of a channel of quantities.
#[must_use]
pub fn channel(name: &str) -> String {
    let mut all = Parameter::ALL.into_iter();
    if let Some(own) = all.find(|own| own.push_derivative() == name) {
        let unit = match own.unit() {
            "1" => "deg".to_owned(),
            unit => format!("deg per {unit}"),
        };
        let (title, _) = own.title().split_once(" (").unwrap_or((own.title(), ""));
        return format!("d(push angle at detachment) / d({title}) ({unit})");
    }
    let label = match name {
        "arc_length_mm" => "arc length from base to contact (mm)",
        "contact_angle_deg" => "contact angle (deg)",
        "force_un" => "contact force (\u{b5}N)",
        "base_force_x_un" => "force on the base along the whisker (\u{b5}N)",
        "base_force_y_un" => "force on the base across the whisker (\u{b5}N)",
        "base_moment_nnm" => "bending moment at the base (nN m)",
        "push_chord_deg" => "chord angle (deg)",
        "contact_distance_mm" => "distance from base to contact (mm)",
        "energy_nj" => "bending energy (nJ)",
        "margin_deg" => "push angle left until detachment (deg)",
        "residual" => "residual (whisker lengths)",
        "newton_steps" => "Newton steps",
        other => other,
    };
    label.to_owned()
}

/// Returns true if a channel is a load or an energy: these span decades, as they vanish at first touch.
#[must_use]
pub fn is_load(name: &str) -> bool {
    ["_un", "_nnm", "_nj"]
        .iter()
        .any(|unit| name.ends_with(unit))
}
