//! States, branches and detachment curves of one whisker.

use serde_json::{Value, json};
use std::collections::BTreeMap;
use whiskmap::friction::Sliding;
use whiskmap::rod::{Rest, Side};
use whiskmap::scene::{AxisValues, Scene};
use whiskmap::trace::{NoState, StateAtPush, WhiskerPart, WhiskerShape};
use whiskmap::{Channel, Options, Regime, Status};

/// Number of points of a whisker's shape.
const POINTS: usize = 120;

/// Returns the state of the whisker at one push angle and distance: regime, status and margin, and the shapes of the resting whisker and of
/// the stable and the unstable state, or the reasons why there are none. Shapes are `[point][x, y]` in mm, as from `whiskmap shape`.
pub fn state(scene: &Scene, push_deg: f64, distance_mm: f64) -> Result<Value, String> {
    let side = Side::of_push(push_deg);
    let branch = whiskmap::branch(scene, distance_mm, side);
    let part = |stable| {
        let branch = branch.as_ref().map_err(|why| *why)?;
        let state = branch.state(push_deg.to_radians(), stable)?;
        Ok((state, WhiskerShape::new(branch, &state, POINTS)))
    };
    let stable = part(true);
    let verdict = match (&branch, &stable) {
        (Ok(branch), Ok((found, shape))) => json!({
            "regime": Regime::Contact.name(),
            "status": status(shape.state.sliding).name(),
            "values": { "margin_deg": (branch.stable_end_deg() - push_deg).abs(), "residual": shape.residual, "contact_distance_mm": branch.read(found).contact_distance_mm },
        }),
        _ => cell(scene, push_deg, distance_mm)?,
    };
    let whisker = &scene.whisker;
    let rest = Rest::new(&whisker.rod(&scene.pole, side));
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
        "stable": drawn(stable),
        "unstable": drawn(part(false)),
    }))
}

/// Regime, status and values of a cell that no push from first touch reaches.
fn cell(scene: &Scene, push_deg: f64, distance_mm: f64) -> Result<Value, String> {
    let cell = scene.to_builder().push_angle_deg([push_deg]);
    let cell = cell.distance_mm([distance_mm]).build();
    let cell = cell.map_err(|why| why.to_string())?;
    let map = whiskmap::map(&cell, Options::default()).map_err(|why| why.to_string())?;
    let panel = &map.panels[0];
    let mut status = Status::ALL.into_iter();
    let status = status.find(|status| status.code() == panel.status[0]);
    let channels = Channel::ALL.map(|channel| (channel.name(), panel.channel(channel)[0]));
    Ok(json!({
        "regime": map.regime(0, 0, 0).map(Regime::name),
        "status": status.map(Status::name),
        "values": BTreeMap::from(channels),
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

fn drawn(found: Result<(StateAtPush, WhiskerShape), NoState>) -> Value {
    let shape = match found {
        Ok((_, shape)) => shape,
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

/// Returns `count` points of the branch of each side at one distance, as from `whiskmap branch`, or the reason why there is none.
pub fn branches(scene: &Scene, distance_mm: f64, count: usize) -> Value {
    let [cf, cb] = Side::BOTH.map(|side| {
        let branch = whiskmap::branch(scene, distance_mm, side);
        match branch.and_then(|branch| branch.points(count)) {
            Ok(points) => json!({ "points": points }),
            Err(why) => json!({ "none": why.to_string() }),
        }
    });
    json!({ "distance_mm": distance_mm, "cf": cf, "cb": cb })
}

/// Returns the detachments at `count` distances, CF then CB, as from `whiskmap curve`.
pub fn curve(scene: &Scene, [from, to]: [f64; 2], count: usize) -> Result<Value, String> {
    let scene = scene
        .to_builder()
        .distance_mm(AxisValues::linear(from, to, count))
        .build();
    let scene = scene.map_err(|why| why.to_string())?;
    let curve = whiskmap::curve(&scene, Options::default()).map_err(|why| why.to_string())?;
    let rows = curve.into_iter().map(|(_, end)| end);
    Ok(json!({ "rows": rows.collect::<Vec<_>>() }))
}
