//! Colours that people with any colour vision can tell apart.

use crate::classify::Regime;

/// Red, green, blue.
pub(super) type Rgb = [u8; 3];

/// The colour that a number of six hexadecimal digits stands for.
const fn rgb(number: u32) -> Rgb {
    let [_, red, green, blue] = number.to_be_bytes();
    [red, green, blue]
}

pub(super) const WHITE: Rgb = rgb(0xffffff);
/// Text and lines.
pub(super) const INK: Rgb = rgb(0x222b33);
/// Lines of charts beside [`INK`].
pub(super) const BLUE: Rgb = rgb(0x1c6cc4);
pub(super) const GREY: Rgb = rgb(0x9aa1a8);
/// Areas of charts, the wider and the one inside.
pub(super) const SHADE_LIGHT: Rgb = rgb(0xdbe4ee);
pub(super) const SHADE_DARK: Rgb = rgb(0xa9bdd2);
/// Cells without a value, and bodies in charts.
pub(super) const BLANK: Rgb = rgb(0xdcddde);

// Regimes that are found side by side differ by 20 in lightness (CIE L*): 96, 74, 53 and 31. Any two of these, and
// unresolved, stay apart for people who lack one of the three cones; a test of the pictures tells by how much.
const OUT_OF_REACH: Rgb = rgb(0xf2f3f4);
const CONTACT: Rgb = rgb(0x83c4a4);
const CONTACT_PALE: Rgb = rgb(0xd3ecdf);
const SLIP_OFF: Rgb = rgb(0xc8602a);
const PULL_OFF: Rgb = rgb(0x22478a);
const UNRESOLVED: Rgb = rgb(0xf0e442);

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

    /// The ground with stripes that stand out from it.
    pub(super) fn hatched(self) -> Self {
        let [red, green, blue] = self.ground.map(f64::from);
        // Luma by ITU-R BT.601.
        let is_light = 0.299 * red + 0.587 * green + 0.114 * blue > 127.5;
        Self {
            stripes: if is_light { INK } else { WHITE },
            ..self
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
    const COLOURS: [u32; 9] = [
        0x56b4e9, 0xe69f00, 0x009e73, 0xcc79a7, 0x0072b2, 0xd55e00, 0xf0e442, 0x999999, 0x332288,
    ];
    Fill::plain(rgb(COLOURS[place % COLOURS.len()]))
}

/// From dark blue at 0 through green to yellow at 1 (viridis by S. van der Walt and N. Smith, every ninth of the way).
pub(super) fn sequential(at: f64) -> Rgb {
    const STOPS: [u32; 10] = [
        0x440154, 0x482878, 0x3e4989, 0x31688e, 0x26828e, 0x1f9e89, 0x35b779, 0x6ece58, 0xb5de2b,
        0xfde725,
    ];
    between(&STOPS, at)
}

/// From blue at 0 through white to red at 1 (ColorBrewer, RdBu).
pub(super) fn diverging(at: f64) -> Rgb {
    const STOPS: [u32; 7] = [
        0x2166ac, 0x67a9cf, 0xd1e5f0, 0xf7f7f7, 0xfddbc7, 0xef8a62, 0xb2182b,
    ];
    between(&STOPS, at)
}

/// The colour at a part of the way along equidistant ones.
fn between(stops: &[u32], at: f64) -> Rgb {
    let place = at.clamp(0.0, 1.0) * (stops.len() - 1) as f64;
    let stop = (place as usize).min(stops.len() - 2);
    let [from, to] = [stop, stop + 1].map(|stop| rgb(stops[stop]).map(f64::from));
    std::array::from_fn(|i| (from[i] + (place - stop as f64) * (to[i] - from[i])).round() as u8)
}
