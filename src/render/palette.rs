//! Colours that people with any colour vision can tell apart.

use crate::classify::Regime;

/// Red, green, blue.
pub(super) type Rgb = [u8; 3];

pub(super) const WHITE: Rgb = [255, 255, 255];
/// Text and lines.
pub(super) const INK: Rgb = [0x22, 0x2b, 0x33];
/// Lines of charts beside [`INK`].
pub(super) const BLUE: Rgb = [0x1c, 0x6c, 0xc4];
pub(super) const GREY: Rgb = [0x9a, 0xa1, 0xa8];
/// Cells without a value, and bodies in charts.
pub(super) const BLANK: Rgb = [0xdc, 0xdd, 0xde];

// Regimes that are found side by side differ by 20 in lightness (CIE L*): 96, 74, 53 and 31. Any two of these, and
// unresolved, stay apart for people who lack one of the three cones; a test of the pictures tells by how much.
const OUT_OF_REACH: Rgb = [0xf2, 0xf3, 0xf4];
const CONTACT: Rgb = [0x83, 0xc4, 0xa4];
const CONTACT_PALE: Rgb = [0xd3, 0xec, 0xdf];
const SLIP_OFF: Rgb = [0xc8, 0x60, 0x2a];
const PULL_OFF: Rgb = [0x22, 0x47, 0x8a];
const UNRESOLVED: Rgb = [0xf0, 0xe4, 0x42];

/// A colour, or stripes of two.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Fill {
    ground: Rgb,
    stripes: Rgb,
}

impl Fill {
    pub(super) const BLANK: Self = Self::plain(BLANK);

    pub(super) const fn plain(ground: Rgb) -> Self {
        Self {
            ground,
            stripes: ground,
        }
    }

    /// The colour at a sum of the coordinates: stripes run from the lower left to the upper right.
    pub(super) fn at(self, sum: f64) -> Rgb {
        if sum % 10.0 < 3.0 {
            self.stripes
        } else {
            self.ground
        }
    }
}

/// The fill of a regime's code; one that this program does not know looks unresolved.
pub(super) fn regime(code: u32) -> Fill {
    let known = Regime::ALL.into_iter().find(|known| known.code() == code);
    match known.unwrap_or(Regime::Unresolved) {
        Regime::OutOfReach => Fill::plain(OUT_OF_REACH),
        Regime::Contact => Fill::plain(CONTACT),
        Regime::SlipOff => Fill::plain(SLIP_OFF),
        Regime::PullOff => Fill::plain(PULL_OFF),
        Regime::Unreachable => Fill {
            ground: CONTACT_PALE,
            stripes: CONTACT,
        },
        Regime::Unresolved => Fill::plain(UNRESOLVED),
    }
}

/// The fill of the `place`-th of some names without an order (Okabe and Ito 2008, Color Universal Design).
pub(super) fn qualitative(place: usize) -> Fill {
    const COLOURS: [Rgb; 8] = [
        [0x56, 0xb4, 0xe9],
        [0xe6, 0x9f, 0x00],
        [0x00, 0x9e, 0x73],
        [0xcc, 0x79, 0xa7],
        [0x00, 0x72, 0xb2],
        [0xd5, 0x5e, 0x00],
        [0xf0, 0xe4, 0x42],
        [0x99, 0x99, 0x99],
    ];
    Fill::plain(COLOURS[place % COLOURS.len()])
}

/// From dark blue at 0 through green to yellow at 1 (viridis by S. van der Walt and N. Smith, every ninth of the way).
pub(super) fn sequential(at: f64) -> Rgb {
    between(
        &[
            0x440154, 0x482878, 0x3e4989, 0x31688e, 0x26828e, 0x1f9e89, 0x35b779, 0x6ece58,
            0xb5de2b, 0xfde725,
        ],
        at,
    )
}

/// From blue at 0 through white to red at 1 (ColorBrewer, RdBu).
pub(super) fn diverging(at: f64) -> Rgb {
    between(
        &[
            0x2166ac, 0x67a9cf, 0xd1e5f0, 0xf7f7f7, 0xfddbc7, 0xef8a62, 0xb2182b,
        ],
        at,
    )
}

/// The colour at a part of the way along equidistant ones.
fn between(stops: &[u32], at: f64) -> Rgb {
    let place = at.clamp(0.0, 1.0) * (stops.len() - 1) as f64;
    let stop = (place as usize).min(stops.len() - 2);
    [16, 8, 0].map(|shift| {
        let [from, to] = [stop, stop + 1].map(|stop| f64::from(stops[stop] >> shift & 0xff));
        (from + (place - stop as f64) * (to - from)).round() as u8
    })
}
