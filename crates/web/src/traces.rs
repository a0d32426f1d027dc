//! States, branches and detachment curves of one whisker.

use serde_json::{Value, json};
use std::collections::BTreeMap;
use whiskmap::friction::Sliding;
use whiskmap::mechanics::rod::{Rest, Side};
use whiskmap::scene::{AxisValues, Scene};
use whiskmap::trace::{Detachment, NoState, StableBranch, WhiskerPart, WhiskerShape};
use whiskmap::{Channel, Options, Regime, Status};

/// Number of points of a whisker's shape.
const POINTS: usize = 120;

/// Returns the stable state of the whisker at one push angle and distance: regime, status and margin, and the shapes of the resting whisker
/// and of the state, or the reason why there is none. Shapes are `[point][x, y]` in mm, as from `whiskmap shape`.
pub fn state(scene: &Scene, push_deg: f64, distance_mm: f64) -> Result<Value, String> {
    let side = Side::of_push(push_deg);
    let (whisker, pole) = (&scene.whisker, &scene.pole);
    let branch = StableBranch::new(whisker, pole, side, distance_mm);
    let stable = branch.and_then(|branch| {
        let state = branch.state(push_deg.to_radians())?;
        let shape = branch.shape(&state, POINTS);
        Ok((branch, state, shape))
    });
    let verdict = match &stable {
        Ok((branch, found, shape)) => json!({
            "regime": Regime::Contact.name(),
            "status": status(shape.state.sliding).name(),
            "values": { "margin_deg": (branch.stable_end_deg() - push_deg).abs(), "residual": shape.residual, "contact_distance_mm": branch.read(found).contact_distance_mm },
        }),
        _ => cell(scene, push_deg, distance_mm)?,
    };
    let rest = Rest::new(&whisker.rod(pole, side));
    let at_rest = (0..=POINTS).map(|i| {
        let place = rest.at_arclength(i as f64 / POINTS as f64).0;
        (place * whisker.length_mm).to_array()
    });
    Ok(json!({
        "push_angle_deg": push_deg,
        "distance_mm": distance_mm,
        "side": side,
        "verdict": verdict,
        "rest": at_rest.collect::<Vec<_>>(),
        "stable": drawn(stable.map(|(_, _, shape)| shape)),
    }))
}

/// Regime, status and values of a cell that no push from first touch reaches.
fn cell(scene: &Scene, push_deg: f64, distance_mm: f64) -> Result<Value, String> {
    let builder = scene.to_builder().push_angle_deg([push_deg]).distance_mm([distance_mm]);
    let cell = builder.build().map_err(|why| why.to_string())?;
    let map = whiskmap::map(&cell, Options::default()).map_err(|why| why.to_string())?;
    let panel = &map.panels[0];
    let mut status = Status::ALL.into_iter();
    let status = status.find(|status| status.code() == panel.status[0]);
    let value = |channel: Channel| Some((channel.name(), *panel.channel(channel).first()?));
    let channels = Channel::ALL.into_iter().filter_map(value);
    Ok(json!({
        "regime": map.regime(0, 0, 0).map(Regime::name),
        "status": status.map(Status::name),
        "values": channels.collect::<BTreeMap<_, _>>(),
    }))
}

/// The status of a state with this sliding direction.
const fn status(sliding: Option<Sliding>) -> Status {
    match sliding {
        None | Some(Sliding::Tip) => Status::Solved,
        Some(Sliding::Base) => Status::TowardBase,
        Some(Sliding::Sticks) => Status::Sticking,
    }
}

fn drawn(found: Result<WhiskerShape, NoState>) -> Value {
    let shape = match found {
        Ok(shape) => shape,
        Err(why) => return json!({ "none": why.to_string() }),
    };
    let mut parts = shape.points.iter().map(|point| point.part);
    let points = shape.points.iter().map(|point| [point.x_mm, point.y_mm]);
    json!({
        "points": points.collect::<Vec<_>>(),
        "contact": parts.position(|part| part == WhiskerPart::Contact),
        "pole_mm": shape.pole_mm,
        "pole_radius_mm": shape.pole_radius_mm,
        "state": shape.state,
    })
}

/// Returns `count` points of the branch of each side at one distance, as from `whiskmap branch`. The value also has the shape in the
/// unstable state at a push angle, or the reasons why there is no branch or shape.
pub fn branches(scene: &Scene, distance_mm: f64, push_deg: Option<f64>, count: usize) -> Value {
    let branches = Side::BOTH.map(|side| whiskmap::branch(scene, distance_mm, side));
    let [cf, cb] = branches.each_ref().map(|branch| {
        let points = branch.as_ref().map_err(|why| *why);
        match points.and_then(|branch| branch.points(count)) {
            Ok(points) => json!({ "points": points }),
            Err(why) => json!({ "none": why.to_string() }),
        }
    });
    let unstable = push_deg.map(|push_deg| {
        let mut sides = Side::BOTH.iter().zip(&branches);
        let pushed = sides.find(|(side, _)| **side == Side::of_push(push_deg));
        let shape = pushed.map(|(_, branch)| {
            let branch = branch.as_ref().map_err(|why| *why)?;
            let state = branch.state(push_deg.to_radians(), false)?;
            Ok(branch.shape(&state, POINTS))
        });
        shape.map(drawn)
    });
    json!({ "distance_mm": distance_mm, "push_angle_deg": push_deg, "cf": cf, "cb": cb, "unstable": unstable })
}

/// Returns the detachments at `count` distances, CF then CB, as from `whiskmap curve`, and the names of its columns in their order.
pub fn curve(scene: &Scene, [from, to]: [f64; 2], count: usize) -> Result<Value, String> {
    let scene = scene.to_builder().distance_mm(AxisValues::linear(from, to, count)).build();
    let scene = scene.map_err(|why| why.to_string())?;
    let curve = whiskmap::curve(&scene, Options::default()).map_err(|why| why.to_string())?;
    let rows = curve.into_iter().map(|(_, end)| end);
    let columns = Detachment::COLUMNS.iter().map(|(name, _)| name);
    Ok(json!({ "rows": rows.collect::<Vec<_>>(), "columns": columns.collect::<Vec<_>>() }))
}
