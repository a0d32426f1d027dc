//! What of a map is drawn, and how.

/// How to draw a map.
#[derive(Clone, Copy, Debug, Default)]
pub struct MapOptions<'a> {
    /// The channel. Without it, the regimes are drawn, with the detachment boundary over them.
    pub channel: Option<&'a str>,
    /// A logarithmic colour scale. Values that are not positive are blank; without a range, the colour bar starts at the 1st
    /// percentile of the positive values.
    pub log: bool,
    /// The ends of the colour bar, in the channel's unit: values beyond them take the colours of the ends.
    pub range: Option<[f64; 2]>,
    /// Width in pixels; without it, a size in which everything can be read.
    pub width: Option<u32>,
}
