//! A design as a plot: the push angle over the parameter, what is asked for, and where it is.

use super::chart::{Dot, Ink, Line, Plot, Stroke};
use crate::design::{Design, End, Target};
use crate::scene::Parameter;
use crate::trace::DetachmentKind;

/// The push angles of a design, with its solutions as dots; in a wide range over the logarithm of the parameter.
#[must_use]
pub fn designs(parameter: Parameter, target: &Target, design: &Design) -> Plot {
    let (x_label, x): (String, fn(f64) -> f64) = match design.is_wide() {
        true => (format!("log10 of {}", parameter.name()), f64::log10),
        false => (parameter.name().to_owned(), |value| value),
    };
    let push = target.push_angle_deg;
    let asked = design.range.map(|end| [x(end), push]).to_vec();
    let name = format!("{push} deg");
    let mut lines = vec![Line::new(asked, Ink::Grey, Stroke::Dashed, name)];
    for piece in design.ends.chunk_by(|a, b| a.kind == b.kind) {
        let Some((ink, name)) = look(piece[0].kind) else {
            continue;
        };
        let place = |end: &End| Some([x(end.value), end.push_angle_deg?]);
        let points = piece.iter().filter_map(place).collect();
        lines.push(Line::new(points, ink, Stroke::Solid, name));
    }
    let ink = look(target.kind).map_or(Ink::Black, |(ink, _)| ink);
    let dots = design.values.iter().map(|value| Dot {
        at: [x(*value), push],
        ink,
        open: false,
        name: Some("solution".to_owned()),
    });
    Plot {
        x_label,
        y_label: "push angle at detachment (deg)".to_owned(),
        lines,
        dots: dots.collect(),
        ..Plot::default()
    }
}

/// How a kind of detachment is drawn and called.
pub(super) const fn look(kind: DetachmentKind) -> Option<(Ink, &'static str)> {
    match kind {
        DetachmentKind::SlipOff => Some((Ink::Black, "slip-off")),
        DetachmentKind::PullOff => Some((Ink::Blue, "pull-off")),
        DetachmentKind::OutOfReach | DetachmentKind::Unresolved => None,
    }
}
