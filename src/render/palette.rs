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

const CONTACT: Rgb = [0x8c, 0xcb, 0xae];
const CONTACT_PALE: Rgb = [0xd9, 0xee, 0xe3];
const SLIP_OFF: Rgb = [0xec, 0xa0, 0x72];
const PULL_OFF: Rgb = [0x5b, 0x8f, 0xc7];
const OUT_OF_REACH: Rgb = [0xe6, 0xe8, 0xea];
const UNRESOLVED: Rgb = [0xd0, 0x00, 0x8f];

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

    /// The colour of a drawn pixel; stripes run from the lower left to the upper right.
    pub(super) const fn at(self, x: usize, y: usize) -> Rgb {
        if (x + y) % 20 < 6 {
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

/// From dark blue at 0 through green to yellow at 1: the polynomial that M. Zucker fitted to matplotlib's viridis
/// (<https://www.shadertoy.com/view/WlfXRN>), at most 4 of 255 away from it.
pub(super) fn sequential(at: f64) -> Rgb {
    const COEFFICIENTS: [[f64; 7]; 3] = [
        [
            0.2777273, 0.1050931, -0.3308618, -4.6342305, 6.2282699, 4.7763850, -5.4354559,
        ],
        [
            0.0054073,
            1.4046135,
            0.2148476,
            -5.7991010,
            14.1799334,
            -13.7451454,
            4.6458526,
        ],
        [
            0.3340998,
            1.3845902,
            0.0950952,
            -19.3324410,
            56.6905526,
            -65.3530326,
            26.3124352,
        ],
    ];
    COEFFICIENTS.map(|coefficients| {
        let value = coefficients
            .iter()
            .rev()
            .fold(0.0, |sum, next| sum * at + next);
        (value.clamp(0.0, 1.0) * 255.0).round() as u8
    })
}

/// From blue at 0 through white to red at 1 (ColorBrewer, RdBu).
pub(super) fn diverging(at: f64) -> Rgb {
    const STOPS: [Rgb; 7] = [
        [0x21, 0x66, 0xac],
        [0x67, 0xa9, 0xcf],
        [0xd1, 0xe5, 0xf0],
        [0xf7, 0xf7, 0xf7],
        [0xfd, 0xdb, 0xc7],
        [0xef, 0x8a, 0x62],
        [0xb2, 0x18, 0x2b],
    ];
    let place = at.clamp(0.0, 1.0) * (STOPS.len() - 1) as f64;
    let stop = (place as usize).min(STOPS.len() - 2);
    let part = place - stop as f64;
    std::array::from_fn(|channel| {
        let [from, to] = [stop, stop + 1].map(|stop| f64::from(STOPS[stop][channel]));
        (from + part * (to - from)).round() as u8
    })
}
