//! Labels of axes, channels and regions in words, with their units.

use crate::plan::channels::CHANNELS;
use crate::scene::{Parameter, SweepVariable};
use whiskmap_plot::Region;

/// Label of the axis of push angles.
pub const PUSH_ANGLE: &str = "push angle (deg)";
/// Label of the axis of times.
pub const TIME: &str = "time (s)";
/// Label of the axis of angles of the base.
pub const BASE_ANGLE: &str = "angle of the base (deg)";
/// Label of the axis of changes of the push angle.
pub const PUSH_CHANGE: &str = "change of the push angle at detachment for +1 % (deg)";
/// Label of the axis of push angles at detachment.
pub const END_PUSH: &str = "push angle at detachment (deg)";
/// Label of the axis of chord angles at detachment.
pub const END_CHORD: &str = "chord angle at detachment (deg)";
/// Label of the axis of forces at detachment.
pub const END_FORCE: &str = "contact force at detachment (\u{b5}N)";
/// Label of the axis of moments at detachment.
pub const END_MOMENT: &str = "bending moment at the base at detachment (nN m)";
/// Label of the axis of distances.
pub const DISTANCE: &str = "distance at first touch (mm)";

/// Returns the names of the regions of negative and positive push angles. A straight whisker has no concave side.
#[must_use]
pub fn regions(is_straight: bool) -> [Region; 2] {
    let names = match is_straight {
        true => [["\u{2212}"; 2], ["+"; 2]],
        false => [["concave forward (CF)", "CF"], ["concave backward (CB)", "CB"]],
    };
    names.map(|[name, short]| Region { name: name.to_owned(), short: short.to_owned() })
}

/// Returns the label of a parameter.
#[must_use]
pub fn parameter(parameter: Parameter) -> String {
    match parameter.unit() {
        "1" => parameter.title().to_owned(),
        unit => format!("{} ({})", parameter.title(), unit.replace("um", "\u{b5}m")),
    }
}

/// Returns the label of a sweep axis.
#[must_use]
pub fn variable(variable: &SweepVariable) -> String {
    let swept = variable.parameter();
    swept.map_or_else(|| variable.title().to_owned(), parameter)
}

/// Returns the label of a channel of quantities.
#[must_use]
pub fn channel(name: &str) -> String {
    let mut all = Parameter::ALL.into_iter();
    if let Some(parameter) = all.find(|parameter| parameter.push_derivative() == name) {
        let unit = match parameter.unit() {
            "1" => "deg".to_owned(),
            unit => format!("deg per {unit}"),
        };
        let (title, _) = parameter.title().split_once(" (").unwrap_or((parameter.title(), ""));
        return format!("d(push angle at detachment) / d({title}) ({unit})");
    }
    column_label(name).unwrap_or(name).to_owned()
}

/// Returns the label of a column of states or a channel without a parameter; `None` for another name.
#[must_use]
pub fn column_label(name: &str) -> Option<&'static str> {
    let label = || CHANNELS.iter().find(|(channel, ..)| *channel == name);
    match name {
        "contact_force_un" => Some("contact force with friction (\u{b5}N)"),
        "peak_strain_mm" => Some("arc length to the largest bending strain (mm)"),
        _ => label().map(|(.., label)| *label),
    }
}

/// Returns the title of the axis that shows a column or a channel of this name, with its unit.
#[must_use]
pub fn axis_title(name: &str) -> String {
    match name {
        "push_angle_deg" => PUSH_ANGLE.to_owned(),
        "distance_mm" => DISTANCE.to_owned(),
        "time_s" => TIME.to_owned(),
        "angle_deg" => BASE_ANGLE.to_owned(),
        "push_of_1_percent_deg" => PUSH_CHANGE.to_owned(),
        name => channel(name),
    }
}

/// Returns the title of the axis that shows a column of this name of detachments, with its unit.
#[must_use]
pub fn end_title(name: &str) -> String {
    match name {
        "push_angle_deg" => END_PUSH.to_owned(),
        "push_chord_deg" => END_CHORD.to_owned(),
        "force_un" => END_FORCE.to_owned(),
        "base_moment_nnm" => END_MOMENT.to_owned(),
        name => axis_title(name),
    }
}

/// Returns true if a channel is a load or an energy: these span decades, as they vanish at first touch.
#[must_use]
pub fn is_load(name: &str) -> bool {
    ["_un", "_nnm", "_nj"].iter().any(|unit| name.ends_with(unit))
}
