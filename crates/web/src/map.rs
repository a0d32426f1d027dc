//! Maps of one whisker.

use crate::response::{MOST, Response};
use serde::Deserialize;
use serde_json::json;
use whiskmap::engine::{Engine, EngineDescription, Spectral};
use whiskmap::scene::{AxisValues, Scene};
use whiskmap::{Channel, Channels, MapEngine, Options};

/// Task: compute the map of one whisker.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MapTask {
    /// First and last push angle, in degrees.
    push_angle_deg: [f64; 2],
    /// First and last distance, in mm.
    distance_mm: [f64; 2],
    /// Number of push angles, and of distances.
    size: [usize; 2],
    /// Name of a channel whose values are wanted; `None` for the regimes alone.
    channel: Option<String>,
    /// Maximum push-angle error, in degrees; `None` for the finest steps.
    tolerance_deg: Option<f64>,
}

impl MapTask {
    /// Returns the map of the first whisker of `scene`: codes of regimes, codes of statuses, and the values of the channel if one is
    /// wanted, `[array][distance][push_angle]`.
    pub fn respond(&self, scene: &Scene) -> Result<Response, String> {
        let size = self.size.map(|count| count.clamp(1, MOST));
        let axis = |[from, to]: [f64; 2], count| AxisValues::linear(from, to, count);
        let builder = scene
            .to_builder()
            .push_angle_deg(axis(self.push_angle_deg, size[0]))
            .distance_mm(axis(self.distance_mm, size[1]));
        let scene = builder.build().map_err(|why| why.to_string())?;
        let mut options = Options::default();
        options.engine = MapEngine::Spectral;
        options.tolerance_deg = self.tolerance_deg;
        let wanted = self.channel.as_deref();
        let is_wanted = |name: &str| ["regime", "status"].contains(&name) || Some(name) == wanted;
        options.channels = Some(Channels::those(is_wanted));
        let map = whiskmap::map(&scene, options).map_err(|why| why.to_string())?;
        let panel = &map.panels[0];
        let channels = Channel::ALL.into_iter();
        let mut channel =
            channels.filter(|channel| Some(channel.name()) == self.channel.as_deref());
        let codes = [&panel.regime, &panel.status].into_iter().flatten();
        let codes = codes.map(|code| *code as f32);
        let values = channel.next().map_or(&[][..], |channel| panel.channel(channel));
        let spectral = Spectral::default();
        let is_spectral = map.summary.engine_cells.solved > 0;
        let engine = is_spectral.then_some(&spectral as &dyn Engine);
        let engine = EngineDescription::of(engine);
        Ok(Response {
            text: json!({
                "size": size,
                "push_angle_deg": self.push_angle_deg,
                "distance_mm": self.distance_mm,
                "engine": format!("{}, {}", engine.engine, engine.adapter),
                "unresolved": map.summary.unresolved(),
                "worst_residual": map.summary.worst_residual,
            }),
            numbers: codes.chain(values.iter().copied()).collect(),
        })
    }
}
